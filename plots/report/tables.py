"""A table of flexmech, plain or comma-separated. It may be longer than memory: of its rows those are kept that a page shows."""

import csv
import os
import re

KEPT = 40  # rows, from the first one
# Of the columns that say where a row is, those of numbers, beside what the deck varies, which comes first.
PLACES = ("time", "speed", "crank", "mode", "mass", "element")
FIRST_OWN = ("speed", "crank", "time", "branch", "from", "part", "rows")


# As this program and earlier ones write them: a name may be 007 or inf.
REAL = re.compile(r"-?(?:0|[1-9]\d*)(?=[.eE])(?:\.\d+)?(?:[eE][-+]\d+)?")
NUMBER = re.compile(rf"{REAL.pattern}|-?(?:0|[1-9]\d*)")


def shown(cell):
    """A number with six digits; anything else as it is."""
    return f"{float(cell):.6g}" if REAL.fullmatch(cell) else cell


class Table:
    """What a page tells of a table."""

    def __init__(self, file, names, units, notes=()):
        self.file, self.names, self.units, self.notes = file, names, units, notes
        self.rows, self.last, self.count, self.failed = [], None, 0, 0
        self.least, self.greatest = [None]*len(names), [None]*len(names)  # number and row
        self.has_words, self.varies = [False]*len(names), [False]*len(names)

    def take(self, row):
        self.count += 1
        self.last = row
        if len(self.rows) < KEPT:
            self.rows.append(row)
        for i, cell in enumerate(row):
            self.varies[i] = self.varies[i] or cell != self.rows[0][i]
            if not NUMBER.fullmatch(cell):
                self.has_words[i] = self.has_words[i] or cell not in ("", "-")
                continue
            number = float(cell)
            if self.least[i] is None or number < self.least[i][0]:
                self.least[i] = number, row
            if self.greatest[i] is None or number > self.greatest[i][0]:
                self.greatest[i] = number, row

    def mixes_units(self):
        """The unit of a row stands in a column: rows of such a table have nothing in common."""
        return "see_unit" in self.units

    def places(self):
        """Columns that say where a row is."""
        count = next((i for i, name in enumerate(self.names) if name in FIRST_OWN), 0)
        while count < len(self.names) and (self.has_words[count] or self.names[count] in PLACES):
            count += 1
        return range(count)

    def place_of(self, row):
        """Speed and position follow from a time before them."""
        return ", ".join(f"{name} {shown(row[i])}" for i, name in enumerate(self.names[:len(self.places())])
                         if self.varies[i] and not (name in ("speed", "crank") and "time" in self.names[:i]))


def read_plain(path):
    """The head, a title, notes, names and units, ends at the first row; a failed one is a comment, too."""
    head, table = [], None
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            failed = bool(head) and re.match("# *failed ", line) is not None
            if table is None and line.startswith("#") and not failed:
                head.append(line[1:].strip())
                continue
            table = table or headed(path, head)
            row = line.split()
            if failed:
                table.failed += 1
            elif row and not line.startswith("#") and len(row) == len(table.names):
                table.take(row)
    return table or headed(path, head)


def headed(path, head):
    names, units = [line.split() for line in head[-2:]] if len(head) > 2 else ([], [])
    return Table(os.path.basename(path), names, units, head[1:-2])


def read_csv(path):
    """The last column says why a row failed."""
    with open(path, encoding="utf-8", errors="replace", newline="") as lines:
        rows = csv.reader(lines)
        heads = [re.fullmatch(r"(.*?)(?: \[(.*)\])?", head) for head in next(rows, [])[:-1]]
        table = Table(os.path.basename(path), [head[1] for head in heads], [head[2] or "-" for head in heads])
        for row in rows:
            if row[-1]:
                table.failed += 1
            else:
                table.take(row[:-1])
    return table
