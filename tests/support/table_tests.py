#!/usr/bin/env python3
"""Runs the decks of tests/tables/ and compares their tables with what NAME.expected says of them.

    table_tests.py [NAME ...] [--program PATH] [--scratch FOLDER]
    table_tests.py --self-check     whether wrong expectations are found

A line of NAME.expected says one thing; behind ` ! ` stands where a value comes from, and a line that ends with \\ goes on. Runs:

    run NAME [deck OTHER | like RUN]   begins with the cards of OTHER.deck (deck none: without any), of another run, or of the deck
                                       beside the file, of which is what comes before the first such line
    let NAME = EXPRESSION              for claims, and for {EXPRESSION} in cards, in which `of(RUN, TABLE)` has the functions
                                       below of another run, and `turned(x, y)` is a vector mirrored (side = -1) and turned by angle
    + CARD | CARD                      more cards
    - WORDS | WORDS                    without the cards that begin so
    ~ OLD -> NEW                       other words
    reverse WORDS                      cards that begin so in the other order
    take CARD of RUN TABLE             the cards that the head of a table gives
    status N                           the exit status, else 0
    check N                            the deck is checked only (--check), and the exit status is N
    [no] says TEXT, silent             on standard error; of several `says` all
    [no] log TEXT                      a line of run.log

Lines from `repeat a,b = 1,2 | 3,4` to `end` stand there once for each of the values, which replace <a> and <b>.

Of a table, which `table NAME` or `table RUN NAME` chooses:

    [no] note TEXT                     a line of its head
    failed TEXT | TEXT                 all failed rows
    columns NAMES, units UNITS         the last lines of the head
    rows N                             how many
    shape LETTERS                      r for a row, f for a failed one, 1, 2 … for so many empty lines
    list EXPRESSION = WORDS            a value of every row
    beside NAME = [RUN] TABLE          another table, whose row of the same number is NAME
    with NAME = [RUN] TABLE            another table, of which functions tell
    each [ROWS]: CLAIM; CLAIM within T [of SCALE]
    at ROWS: …, row N: …, whole: …     of one row, the N-th, all together

TEXT may hold `...` for anything. ROWS are `column=value`, or `where EXPRESSION`. A CLAIM is LEFT = RIGHT, or with < <= > >=;
without a tolerance every digit counts. `{a b}` in a claim stands for one claim with each of these words, which `{}` repeats;
`{*}` is all columns of numbers that both tables have. Expressions are Python's, of the columns (`from_`, where Python has the
word), functions of math, `degree`, `number` (of the row), `notes`, `units`, `shape` and:

    column("a"), largest("a", "b"), least("a"), greatest("a"), total("a"), mean("a"), rows()
                                       over the rows, or those with column=value
    value("a", column=value)           in the only row with these values
    near("a", N)                       N rows on; rows without a neighbour are left out
    slope("a", step)                   by four neighbours
"""

import argparse
import keyword
import math
import os
import re
import subprocess
import sys
import tempfile
from glob import glob
from types import SimpleNamespace

import compare_tables

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tables")
OPERATORS = {"=": lambda a, b: a == b, "<": lambda a, b: a < b, "<=": lambda a, b: a <= b, ">": lambda a, b: a > b,
             ">=": lambda a, b: a >= b}
MATHS = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}
MATHS.update((function.__name__, function) for function in (abs, all, any, float, int, range, len, max, min, round, sorted, str, sum, zip))
MATHS["degree"] = math.pi/180


class Fault(Exception):
    """Why an expectation is not met."""


class NoNeighbour(Exception):
    """A row at the end of a table."""


def pattern_of(text):
    """Text in which ... stands for anything."""
    return re.compile(".*".join(re.escape(part) for part in text.split("...")))


def word_of(text):
    value = compare_tables.number(text)
    return text if value is None else value


class Table:
    def __init__(self, path):
        if not os.path.exists(path):
            raise Fault(f"there is no {os.path.basename(path)}")
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")[:-1]
        self.failed = [line[len("# failed "):] for line in lines if line.startswith("# failed ")]
        self.notes = [line[2:] for line in lines if line.startswith("#") and not line.startswith("# failed ")]
        end = next((i for i, line in enumerate(lines) if not line.startswith("#") or line.startswith("# failed ")), len(lines))
        self.names, self.units = compare_tables.column_names(lines[:end]), lines[end - 1][1:].split()
        self.rows, self.shape, empty = [], "", 0
        for line in lines[end:]:
            if not line:
                empty += 1
                continue
            self.shape += (str(empty) if empty else "")
            self.shape += "r" if line[0] != "#" else "f" if line.startswith("# failed ") else "n"
            empty = 0
            if line[0] != "#":
                words = line.split()
                if len(words) != len(self.names) or len(line) != len(lines[end - 1]):
                    raise Fault(f"a row is not as its head: '{line}'")
                if re.search(r"(?i)(?<!\S)[-+]?(n0?an|inf|infinity)(?!\S)", line):
                    raise Fault(f"no numbers: '{line}'")
                self.rows.append({name + "_"*keyword.iskeyword(name): word_of(word) for name, word in zip(self.names, words)})
        self.shape += str(empty) if empty else ""


class Run:
    """A deck and what the program makes of it; it is run when a table or a message is asked for."""

    def __init__(self, name, deck, folder, program):
        self.name, self.deck, self.folder, self.program, self.names = name, deck, folder, program, {}
        self.status, self.options, self.done, self.tables = 0, ["--quiet", "--threads", "1", "--out", "out"], None, {}

    def change(self, sign, text):
        if sign == "+":
            self.deck += text.split(" | ")
        elif sign == "-":
            for words in text.split(" | "):
                left = [card for card in self.deck if not card.startswith(words)]
                if len(left) == len(self.deck):
                    raise Fault(f"no card begins with '{words}'")
                self.deck = left
        else:
            old, new = text.split("->")
            changed = [card.replace(old.strip(), new.strip()) for card in self.deck]
            if changed == self.deck:
                raise Fault(f"no card has '{old.strip()}'")
            self.deck = changed

    def make(self):
        """The finished process; the deck is run once."""
        if self.done is None:
            with open(os.path.join(self.folder, self.name + ".deck"), "w", encoding="utf-8") as file:
                file.write("".join(re.sub(r"\{([^}]+)\}", self.value, card) + "\n" for card in self.deck))
            self.done = subprocess.run([self.program, *self.options, self.name + ".deck"], cwd=self.folder,
                                       stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                                       timeout=3600, check=False)
        if self.done.returncode != self.status:
            raise Fault(f"status {self.done.returncode}, not {self.status}: {self.done.stderr.strip()}")
        return self.done

    def value(self, found):
        value = evaluate(found[1], {**MATHS, "turned": self.turned, **self.names})
        return value if isinstance(value, str) else repr(value)

    def turned(self, x, y, unit=""):
        angle, y = math.radians(self.names["angle"]), self.names["side"]*y
        return f"{x*math.cos(angle) - y*math.sin(angle)!r}{unit} {x*math.sin(angle) + y*math.cos(angle)!r}{unit}"

    def path(self, name):
        self.make()
        return os.path.join(self.folder, "out", self.name, name)

    def table(self, name):
        if name not in self.tables:
            self.tables[name] = Table(self.path(name + ".dat"))
        return self.tables[name]


class Rows:
    """What expressions may name, of the rows of a table and of those beside it."""

    def __init__(self, table, beside, others, given=()):
        self.beside, self.tables, self.given = {"": table, **beside}, {"": table, **beside, **others}, dict(given)
        self.here = 0
        for name, other in beside.items():
            if len(other.rows) != len(table.rows):
                raise Fault(f"{len(table.rows)} rows, and {len(other.rows)} in {name}")
        self.functions = {name: getattr(self, name) for name in
                          ("column", "largest", "least", "greatest", "total", "mean", "rows", "value", "near", "slope")}

    def column(self, name, /, **wanted):
        table, _, column = name.rpartition(".")
        return [row[column] for row in self.tables[table].rows if fits(row, wanted)]

    def largest(self, *names, **wanted):
        return max(abs(value) for name in names for value in self.column(name, **wanted))

    def least(self, name, /, **wanted):
        return min(self.column(name, **wanted))

    def greatest(self, name, /, **wanted):
        return max(self.column(name, **wanted))

    def total(self, name, /, **wanted):
        return math.fsum(self.column(name, **wanted))

    def mean(self, name, /, **wanted):
        column = self.column(name, **wanted)
        return math.fsum(column)/len(column)

    def rows(self, table="", /, **wanted):
        return sum(fits(row, wanted) for row in self.tables[table].rows)

    def value(self, name, /, **wanted):
        found = self.column(name, **wanted)
        if len(found) != 1:
            raise Fault(f"{len(found)} rows with {wanted}")
        return found[0]

    def near(self, name, count):
        column = self.column(name)
        if not 0 <= self.here + count < len(column):
            raise NoNeighbour
        return column[self.here + count]

    def slope(self, name, step):
        a, b, c, d = (self.near(name, k) for k in (-2, -1, 1, 2))
        return (8*(c - b) - (d - a))/(12*step)

    def names_at(self, index):
        table = self.tables[""]
        names = {**MATHS, **self.given, **self.functions, "notes": table.notes, "units": table.units, "shape": table.shape}
        if index is not None:
            self.here = index
            for name, table in self.beside.items():
                names.update(table.rows[index] if not name else {name: SimpleNamespace(**table.rows[index])})
            names["number"] = index + 1
        return names


def fits(row, wanted):
    """Whether a row has these values, numbers about."""
    return all(row[name] == value or isinstance(row[name], float) and not isinstance(value, str)
               and math.isclose(row[name], value, rel_tol=1e-9, abs_tol=1e-9) for name, value in wanted.items())


def evaluate(text, names):
    try:
        return eval(text, {"__builtins__": {}, **names})  # of the files of this repository
    except (NameError, AttributeError, IndexError, KeyError, SyntaxError, TypeError, ValueError, ZeroDivisionError) as error:
        raise Fault(f"'{text.strip()}': {error!r}") from error


def chosen(rows, kind, where):
    """Numbers of the rows that a line is about; None: all together."""
    if kind == "whole":
        return [None]
    count = len(rows.tables[""].rows)
    if kind == "row":
        return [int(where) - 1]
    if where.startswith("where "):
        numbers = [i for i in range(count) if evaluate(where[len("where "):], rows.names_at(i))]
    else:
        wanted = {name: word_of(value) for name, value in (part.split("=") for part in where.split())}
        numbers = [i for i, row in enumerate(rows.tables[""].rows) if fits(row, wanted)]
    if kind == "at" and len(numbers) != 1 or not numbers:
        raise Fault(f"{len(numbers)} rows with {where}")
    return numbers


def expanded(text, scale, rows):
    """Claims and the scales of their tolerances; one with braces for each word in them."""
    for claim in text.split("; "):
        braces = re.search(r"\{([^}]+)\}", claim)
        words = braces[1].split() if braces else [""]
        if words == ["*"]:
            words = [name for name, value in rows.tables[""].rows[0].items() if isinstance(value, float) and
                     all(name in table.rows[0] for table in rows.beside.values())]
        for word in words:
            yield (claim.replace(braces[0], word) if braces else claim).replace("{}", word), (scale or "1").replace("{}", word)


def check_claims(rows, kind, where, text):
    text, _, within = text.partition(" within ")
    tolerance, _, scale = within.partition(" of ")
    compared = 0
    numbers = chosen(rows, kind, where)
    for claim, size in expanded(text, scale, rows):
        found = re.fullmatch(r"(.+?) (=|<|<=|>|>=) (.+)", claim.strip())
        if not found:
            raise Fault(f"'{claim}' is no claim")
        for i in numbers:
            names = rows.names_at(i)
            try:
                left, right = evaluate(found[1], names), evaluate(found[3], names)
                bound = evaluate(tolerance, names)*abs(evaluate(size, names)) if within else 0.0
            except NoNeighbour:
                continue
            compared += 1
            if isinstance(left, str) != isinstance(right, str):
                raise Fault(f"{found[1]} is {left!r}, and {found[3]} is {right!r}")
            if within and found[2] == "=" and not isinstance(left, str):
                met = abs(left - right) <= bound
            else:
                met = OPERATORS[found[2]](left, right)
            if not met:
                raise Fault(f"{'' if i is None else f'row {i + 1}: '}{found[1]} is {left}, and {found[3]} is {right}"
                            + (f", within {bound:.3g}" if within else ""))
    if not compared:
        raise Fault("nothing was compared")


class Expectations:
    """The lines of a file, one after the other."""

    def __init__(self, name, program, folder):
        self.name, self.program, self.folder = name, program, folder
        self.runs = {name: Run(name, self.deck(name), folder, program)}
        self.run, self.chosen, self.beside, self.others = self.runs[name], None, {}, {}

    @staticmethod
    def deck(name):
        path = os.path.join(FOLDER, name + ".deck")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8") as file:
            return [line for line in file.read().splitlines() if line and not line.startswith("!")]

    def begin_run(self, rest):
        words = rest.split()
        options = dict(zip(words[1::2], words[2::2]))
        base = options.get("deck", self.name)
        if base != "none" and "like" not in options and not os.path.exists(os.path.join(FOLDER, base + ".deck")):
            raise Fault(f"there is no {base}.deck")
        base = self.run_named(options["like"]).deck if "like" in options else self.deck(base)
        self.run = self.runs[words[0]] = Run(words[0], list(base), self.folder, self.program)
        self.run.names = dict(self.run_named(options["like"]).names) if "like" in options else {"of": self.functions_of}
        self.chosen, self.beside, self.others = None, {}, {}

    def follow(self, line):
        """One line; raises a Fault. True: it was a test."""
        line = re.split(r"\s+!\s", line)[0].strip()
        if not line or line.startswith("!"):
            return False
        word, _, rest = line.partition(" ")
        rest = rest.strip()
        if word == "run":
            self.begin_run(rest)
        elif word in "+-~":
            self.run.change(word, rest)
        elif word == "let":
            name, _, expression = rest.partition(" = ")
            self.run.names[name] = evaluate(expression, {**MATHS, **self.run.names})
        elif word == "reverse":
            places = [i for i, card in enumerate(self.run.deck) if card.startswith(rest)]
            for i, card in zip(places, [self.run.deck[i] for i in reversed(places)]):
                self.run.deck[i] = card
            if len(places) < 2:
                raise Fault("nothing to reverse")
        elif word == "take":
            card, run, table = re.fullmatch(r"(\S+) of (\S+) (\S+)", rest).groups()
            cards = [note for note in self.run_named(run).table(table).notes if note.startswith(card + " ")]
            if not cards:
                raise Fault(f"{table} gives no {card}")
            self.run.deck += cards
        elif word in ("check", "status"):
            self.run.status = int(rest)
            if word == "check":
                self.run.options = ["--check"]
            self.run.make()
            return True
        elif word == "table":
            run, _, self.chosen = rest.rpartition(" ")
            self.beside, self.others = {}, {}
            if run:
                self.run = self.run_named(run)
            self.run.table(self.chosen)
        elif word in ("beside", "with"):
            name, other = (part.strip() for part in rest.split("="))
            run, _, table = other.rpartition(" ")
            (self.beside if word == "beside" else self.others)[name] = (self.run_named(run) if run else self.run).table(table)
        else:
            self.expect(word, rest)
            return True
        return False

    def run_named(self, name):
        if name not in self.runs:
            raise Fault(f"there is no run {name}")
        return self.runs[name]

    def functions_of(self, run, table):
        return SimpleNamespace(**Rows(self.run_named(run).table(table), {}, {}).functions)

    def expect(self, word, rest):
        without = word == "no"
        if without:
            word, _, rest = rest.partition(" ")
        if word in ("says", "silent", "log"):
            self.expect_of_run(word, rest, without)
            return
        if not self.chosen:
            raise Fault("there is no line `table`, or the word means nothing")
        table = self.run.table(self.chosen)
        if word == "note":
            found = any(pattern_of(rest).fullmatch(note) for note in table.notes)
            if found == without:
                raise Fault(f"{'it is' if found else 'not'} among\n  " + "\n  ".join(table.notes))
        elif word == "failed":
            named = rest.split(" | ")
            alike = [pattern_of(text).fullmatch(row) for text, row in zip(named, table.failed)]
            if len(named) != len(table.failed) or not all(alike):
                raise Fault("failed are\n  " + "\n  ".join(table.failed))
        elif word == "columns" and rest.split() != table.names:
            raise Fault(f"columns {' '.join(table.names)}")
        elif word == "units" and rest.split() != table.units:
            raise Fault(f"units {' '.join(table.units)}")
        elif word == "rows" and int(rest) != len(table.rows):
            raise Fault(f"{len(table.rows)} rows")
        elif word == "shape" and rest != table.shape:
            raise Fault(f"shape {table.shape}")
        elif word == "list":
            self.expect_list(table, rest)
        elif word in ("each:", "each", "at", "row", "whole:"):
            where, _, claims = (": " + rest if word[-1] == ":" else rest).partition(": ")
            check_claims(Rows(table, self.beside, self.others, self.run.names), word.rstrip(":"), where.strip(), claims.strip())
        elif word not in ("columns", "units", "rows", "shape"):
            raise Fault(f"'{word}' means nothing")

    def expect_list(self, table, rest):
        expression, _, wanted = rest.partition(" = ")
        rows = Rows(table, self.beside, self.others, self.run.names)
        expression, _, part = expression.partition(" of ")
        found = [evaluate(expression, rows.names_at(i)) for i in range(len(table.rows))]
        if part:
            found = found[slice(*(int(word) if word else None for word in part.split(":")))]
        if found != [word_of(word) for word in wanted.split()]:
            raise Fault(f"{expression} is {' '.join(str(value) for value in found)}")

    def expect_of_run(self, word, rest, without):
        done = self.run.make()
        if word == "silent":
            if done.stderr:
                raise Fault(f"it said:\n{done.stderr}")
        elif word == "says":
            found = re.search(pattern_of(rest), done.stderr)
            if bool(found) == without:
                raise Fault(f"it said:\n{done.stderr}")
        else:
            with open(self.run.path("run.log"), encoding="utf-8") as file:
                text = file.read()
            if any(pattern_of(rest).fullmatch(line) for line in text.splitlines()) == without:
                raise Fault(f"the log says:\n{text}")

    def results(self, text):
        """Of every line that tests something its place and why it is not met, or None."""
        lost = False
        for number, line in repeated(numbered_lines(text)):
            word = line.split(" ")[0]
            lost = lost and word != "run"
            if lost:
                continue
            try:
                if self.follow(line):
                    yield f"tests/tables/{self.name}.expected:{number}", None
            except Fault as fault:
                yield f"tests/tables/{self.name}.expected:{number}", f"{line}\n  {fault}"
                # Without the deck or the table nothing that follows makes sense.
                lost = word in ("run", "let", "+", "-", "~", "reverse", "take", "check", "status", "table", "beside", "with")


def numbered_lines(text):
    """Lines with their numbers, those that go on put together."""
    number, waiting = 0, ""
    for n, part in enumerate(text.splitlines(), 1):
        number = number if waiting else n
        waiting += part.strip()
        if waiting.endswith("\\"):
            waiting = waiting[:-1].rstrip() + " "
        else:
            yield number, waiting
            waiting = ""


def repeated(lines):
    """Lines, those from `repeat` to `end` once for each of its values."""
    lines = iter(lines)
    for number, line in lines:
        if not line.startswith("repeat "):
            yield number, line
            continue
        names, _, values = line[len("repeat "):].partition(" = ")
        block, depth = [], 1
        for inner in lines:
            depth += inner[1].startswith("repeat ") - (inner[1] == "end")
            if depth == 0:
                break
            block.append(inner)
        for value in values.split(" | "):
            pairs = list(zip(names.split(","), value.split(",")))
            changed = []
            for n, text in block:
                for name, word in pairs:
                    text = text.replace(f"<{name.strip()}>", word.strip())
                changed.append((n, text))
            yield from repeated(changed)


def results(name, program, folder):
    with open(os.path.join(FOLDER, name + ".expected"), encoding="utf-8") as file:
        yield from Expectations(name, program, folder).results(file.read())


def names_of_tests():
    return sorted(os.path.splitext(os.path.basename(path))[0] for path in glob(os.path.join(FOLDER, "*.expected")))


def unused_decks():
    """Decks that no file of expectations is about."""
    texts = []
    for path in glob(os.path.join(FOLDER, "*.expected")):
        with open(path, encoding="utf-8") as file:
            texts.append(file.read())
    used = set(names_of_tests()) | set(re.findall(r"^run \S+ deck (\S+)", "\n".join(texts), re.MULTILINE))
    return sorted({os.path.splitext(os.path.basename(path))[0] for path in glob(os.path.join(FOLDER, "*.deck"))} - used)


SAMPLE = "# a note\n# x name y from\n# mm  - mm s\n# failed x=9 : lost\n 1.0 A 2.0 0\n\n 2.0 B 4.0 1\n 3.0 C 6.0 0\n"
RIGHT = ["note a note", "note a ...", "no note b", "columns x name y from", "units mm - mm s", "rows 3", "shape fr1rr",
         "failed x=9 : lost", "list name = A B C", "list from_ of ::2 = 0 0", "each: y = 2*x", "at name=B: y = 4; x = 2",
         "at name=B: y = 4.1 within 0.11", "row 3: y = 6.3 within 0.06 of 6", 'whole: total("y") = 12; largest("x", "y") = 6',
         "each where x > 1: y > 3", "each from_=0: {x y} >= 1", 'each: near("x", 1) = x + 1', 'row 1: value("y", name="C") = 6',
         'whole: rows(from_=0) = 2; mean("x") = 2 within 1e-15']
WRONG = ["note b", "note a", "no note a ...", "columns x name y", "units mm - mm m", "rows 2", "shape frrr", "failed x=8 : lost",
         "list name = A B", "list name = A B D", "each: y = 2.1*x", "at name=B: y = 4; x = 3", "at name=D: y = 4",
         "at from_=0: y = 2",
         "at name=B: y = 4.1 within 0.09", "row 3: y = 6.3 within 0.04 of 6", 'whole: total("y") = 11', "each where x > 3: y > 3",
         "each from_=0: {x y} >= 2", 'each: near("x", 1) = x', 'each: near("x", 3) = x', "each: z = 1", "each: y", "what is this",
         'row 1: value("y", from_=0) = 6', 'each: slope("x", 1) = 1', "each: y < 6", "each: x <= 2.5"]


def self_check():
    """What is wrong with this script itself."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sample.dat")
        with open(path, "w", encoding="utf-8") as file:
            file.write(SAMPLE)
        for lines, met in ((RIGHT, True), (WRONG, False)):
            for line in lines:
                test = Expectations("", "", folder)
                test.run.tables["sample"], test.chosen = Table(path), "sample"
                why = [why for _, why in test.results(line)]
                if len(why) != 1 or (why[0] is None) != met:
                    yield f"'{line}' is {'met' if met else 'not met'}, but it says: {why}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--scratch")
    parser.add_argument("--self-check", action="store_true")
    options = parser.parse_args()
    if options.self_check:
        return "\n".join(self_check()) or 0
    passed = failed = 0
    for name in options.names or names_of_tests():
        folder = os.path.join(options.scratch or tempfile.mkdtemp(), name)
        os.makedirs(folder, exist_ok=True)
        for place, why in results(name, os.path.abspath(options.program), folder):
            passed += why is None
            failed += why is not None
            if why:
                print(f"not ok {place}: {why}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
