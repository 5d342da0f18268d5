"""Tables and sentences of a markdown file whose numbers are computed.

A table is computed if the line above it is `<!-- computed: NAME -->`, or `<!-- computed: NAME by make stress -->` where it takes
minutes. A sentence is found by its words, with {} for the numbers in
it; line ends between words do not matter.
"""

import re

MARK = re.compile(r"<!-- computed: (\w+)(?: by make (\w+))? -->$")


class Table:
    """A table of a document: `first` is the line of its first row below the head."""

    def __init__(self, name, lines, first):
        self.name, self.lines, self.first = name, lines, first
        self.last = first
        while self.last < len(lines) and lines[self.last].startswith("|"):
            self.last += 1

    def rows(self):
        return [[cell.strip() for cell in line.strip().strip("|").split("|")] if line.strip("| ") else []
                for line in self.lines[self.first:self.last]]

    def faults(self, computed):
        """What differs from the rows computed; a cell that is None belongs to the document."""
        written = self.rows()
        if len(written) != len(computed):
            yield f"{len(written)} rows are written, {len(computed)} are computed"
        for number, (row, cells) in enumerate(zip(written, computed), 1):
            if len(row) != len(cells):
                yield f"row {number} has {len(row)} cells, computed are {len(cells)}"
            for text, cell in zip(row, cells):
                if cell is not None and not cell.agrees(text):
                    yield f"row {number} ({row[0]}): '{text}' is written, computed is '{cell}'"

    def write(self, computed):
        """Put in what is computed, unless all of it agrees."""
        if not any(self.faults(computed)):
            return
        written = self.rows()
        lines = []
        for i, cells in enumerate(computed):
            row = written[i] if i < len(written) and len(written[i]) == len(cells) else [""]*len(cells)
            texts = [text if cell is None else cell.instead_of(text) for text, cell in zip(row, cells)]
            lines.append("|" + "|".join(f" {text} " if text else " " for text in texts) + "|")
        self.lines[self.first:self.last] = lines
        self.last = self.first + len(lines)


def tables(lines, origin):
    """The computed tables of a document: those that runs of seconds give if `origin` is None, else those of `make origin`."""
    for number, line in enumerate(lines):
        mark = MARK.match(line)
        if mark and mark[2] == origin:
            yield Table(mark[1], lines, number + 3)


class Sentence:
    """Words of a document with numbers in them."""

    def __init__(self, words):
        self.words = words
        pattern = re.escape(words).replace(r"\ ", " ").replace(r"\{\}", r"([-+−0-9.,e]*[0-9])")
        self.pattern = re.compile(re.sub(r" +", r"\\s+", pattern))

    def faults(self, text, numbers):
        found = self.pattern.findall(text)
        if len(found) != 1:
            yield f"'{self.words}' stands there {len(found)} times"
            return
        written = found[0] if isinstance(found[0], tuple) else (found[0],)
        if len(written) != len(numbers):
            yield f"'{self.words}' has {len(written)} numbers, computed are {len(numbers)}"
        for one, number in zip(written, numbers):
            if not number.agrees(one):
                yield f"'{self.words}': {one} is written, computed is {number}"

    def rewritten(self, text, numbers):
        found = self.pattern.search(text)
        if not found:
            return text
        for i in reversed(range(len(numbers))):
            if not numbers[i].agrees(found[i + 1]):
                text = text[:found.start(i + 1)] + str(numbers[i]) + text[found.end(i + 1):]
        return text
