#!/usr/bin/env python3
"""Compares a table of the program with the one kept for it.

    compare_tables.py KEPT NEW
    compare_tables.py --self-check     whether it finds what is wrong, and nothing else

Texts and the places of empty lines must agree exactly, and NaN and infinity are never right. Numbers are compared by what they
mean, for processors and libraries differ in the last digits of sin, cos and exp, and what rounding decides differs with them:

- an estimated error is right within a factor, or where both are rounding;
- a value with an error is right within both errors and the last digit of a double;
- what is left of something that cancels is rounding: it is right within a bound, a share of what cancels;
- other numbers agree in the digits that their computation keeps.

Numbers in lines that start with # may differ by a unit of the last digit. Prints why not, and then exits with status 1.
"""

import math
import os
import re
import sys
import tempfile

# Columns by name: relative tolerance, and absolute tolerance as a fraction of the largest magnitude in the column,
# which is there for values that would be zero but for rounding; a value within either is right. The first row that fits
# counts. Builds, whose operations are ordered otherwise, agree to 1e-15 in all of them.
TOLERANCES = [
    # Frequencies: in deformation coordinates an eigenvalue keeps its digits; its last ones differ between libraries and
    # processors.
    (r"f\d+(_least|_mean|_greatest)?|frequency", 1e-12, 1e-13),
    # Mode shapes: eigenvectors are less accurate than eigenvalues, and small where they do not move.
    (r"ux|uy|rotation", 0.0, 1e-10),
    # Likeness of shapes: touchy where two modes exchange theirs.
    (r"mac", 1e-6, 0.0),
    # Elastic response: iterations end at their tolerance, well below the estimated errors, and bending takes digits.
    (r"(axial|bending)_strain|(axial|shear)_force|strain|stress|deflection|power|linear|quadratic|total|distance", 1e-8, 1e-9),
    # Where a largest value lies: it is flat there.
    (r"\w+_(at|crank)", 1e-5, 1e-6),
    # All others: closed formulas and small linear systems. Whole numbers are the same or they are not.
    (r".*", 1e-9, 1e-12),
]

# Estimated errors: columns, the factor within which they agree, and the size below which they are rounding. Where several
# multipliers are near each other rounding decides by which steps the edges of an interval are found.
ESTIMATES = re.compile(r"error\d*|(band|speed|growth|f\d+)_error")
FACTOR = {"intervals": 10.0}
USUAL_FACTOR = 3.0
ROUNDING_OF_ERRORS = {r"error\d+|f\d+_error": 2e-13, r".*": 1e-11}
# Errors of the elastic response also hold what its iterations leave, up to this share of the accuracy asked for: rounding decides
# after which of them that is reached, and so how far below.
LEFT_BY_ITERATIONS = 1e-3

# What cancels but for rounding: columns, the share of the largest values of other columns that it may be, and these columns. A
# share of the columns themselves is how much more rounding another processor may leave.
CANCELS = [
    (r"energy_error", 1e-13, r"kinetic|potential|work"),
    (r"kinetic|potential|work", 1e-12, r"kinetic|potential|work"),
    (r"energy_error|closure", 2.0, None),
    (r"closure", 1e-14, "1"),
    (r"balanced_[xy]", 1e-12, r"shaking_[xy]"),
    (r"balanced_[xy]", 1e-10, "1"),
    (r"omega\d", 1e-14, "1"),
    (r"(frame|shaking)_[xy]", 1e-12, r"(frame|shaking)_[xy]"),
]

# Values by the errors in their rows: tables, columns, the column of the error, and of what it is a share: "value", "largest" of the
# rows alike (of a speed and a point), "one" (it is absolute).
LARGEST_OF_RESPONSE = r"(ux|uy|rotation|(axial|bending)_strain|moment|(axial|shear)_force|stress|rigid|linear|quadratic|total|power)"
ERRORS = [
    (r"frequencies", r"f(\d+)", r"error\1", "value"),
    (r"summary", r"f(\d+)_(least|mean|greatest)", r"f\1_error", "value"),
    (r"response|strains|transient|gauges|drive|torque", LARGEST_OF_RESPONSE, "error", "largest"),
    (r"peaks|validity", r"strain|stress|deflection|power|load|quadratic|out_of_plane|distance", "error", "value"),
    (r"sizing", r"value", "error", "value"),
    (r"equilibrium", r"frequency", "error", "value"),
    (r"stability|campbell", r"growth|turns", "error", "one"),
    (r"stability", r"frequency", "error", "value"),
    (r"campbell", r"floquet", "error", "value"),
    (r"campbell", r"least|mean|greatest", "band_error", "value"),
    (r"critical", r"speed", "speed_error", "value"),
    (r"critical", r"frequency|excitation|amplitude|growth", "error", "value"),
    (r"intervals", r"from|to|at", "error", "one"),
    (r"intervals", r"largest_growth", "growth_error", "one"),
]
ALIKE = ("speed", "point", "gauge")


def number(word):
    try:
        return float(word)
    except ValueError:
        return None


def last_unit(word):
    """A unit of the last digit of a number in a remark."""
    mantissa, _, exponent = word.lower().partition("e")
    return 10.0**(int(exponent or 0) - len(mantissa.partition(".")[2]))


def column_names(lines):
    """They stand in the last but one # line of the header; the last holds the units."""
    header = []
    for line in lines:
        if not line.startswith("#"):
            break
        header.append(line)
    return header[-2][1:].split() if len(header) >= 2 else []


def same_remark(old, line):
    """Whether two lines of text agree but for the last digits of numbers with a point or an exponent."""
    pattern = re.compile(r"(?<![\w.])-?\d+(?:\.\d+(?:[eE][-+]?\d+)?|[eE][-+]?\d+)")
    if pattern.sub("0", old) != pattern.sub("0", line):
        return False
    return all(a == b or abs(float(a) - float(b)) <= 1.01*max(last_unit(a), last_unit(b))
               for a, b in zip(pattern.findall(old), pattern.findall(line)))


class Table:
    """Two tables of the same form, and how far numbers may be apart."""

    def __init__(self, name, names, rows, asked):
        self.name, self.names, self.asked = name, names, asked
        self.largest, self.of_alike = {}, {}
        for cells in rows:
            for column, word in zip(names, cells):
                value = number(word)
                if value is not None:
                    self.largest[column] = max(self.largest.get(column, 0.0), abs(value))
                    key = self.key(dict(zip(names, cells)), column)
                    self.of_alike[key] = max(self.of_alike.get(key, 0.0), abs(value))
        self.rules = {column: self.rule(column) for column in names}

    @staticmethod
    def key(row, column):
        return (column, *(row.get(name) for name in ALIKE))

    def rule(self, column):
        """What holds for a column: tolerances, the column of its error and of what it is a share."""
        relative, absolute = next((r, a*self.largest.get(column, 0.0)) for pattern, r, a in TOLERANCES if re.fullmatch(pattern, column))
        for pattern, share, of in CANCELS:
            if re.fullmatch(pattern, column):
                of = column if of is None else of
                scale = 1.0 if of == "1" else max((self.largest.get(one, 0.0) for one in self.names if re.fullmatch(of, one)), default=0.0)
                absolute = max(absolute, share*scale)
        for table, pattern, error, share in ERRORS:
            found = re.fullmatch(pattern, column)
            if found and re.fullmatch(table, self.name) and found.expand(error) in self.names:
                return relative, absolute, found.expand(error), share
        return relative, absolute, None, None

    def estimates_agree(self, column, old, new):
        rounding = next(bound for pattern, bound in ROUNDING_OF_ERRORS.items() if re.fullmatch(pattern, column))
        if column == "error":
            rounding = max(rounding, LEFT_BY_ITERATIONS*self.asked)
        small, large = sorted((abs(old), abs(new)))
        return abs(old - new) <= rounding or old*new > 0.0 and large <= FACTOR.get(self.name, USUAL_FACTOR)*small

    def agree(self, column, old_row, new_row):
        """Whether the cells of a column are right, beside each other."""
        old_word, new_word = old_row[column], new_row[column]
        old, new = number(old_word), number(new_word)
        if old is None or new is None:
            return old_word == new_word
        if ESTIMATES.fullmatch(column):
            return self.estimates_agree(column, old, new)
        relative, absolute, error, share = self.rules[column]
        if error:
            scale = {"value": max(abs(old), abs(new)), "largest": self.of_alike[self.key(old_row, column)], "one": 1.0}[share]
            both = sum(abs(number(row[error]) or 0.0) for row in (old_row, new_row))
            absolute = max(absolute, both*scale + 1e-16*max(abs(old), abs(new)))
        return abs(old - new) <= max(relative*abs(old), absolute)


def difference(kept_path, new_path):
    """Why the tables differ, or None."""
    with open(kept_path, encoding="utf-8") as kept, open(new_path, encoding="utf-8") as new:
        kept_lines, new_lines = kept.read().split("\n"), new.read().split("\n")
    if kept_lines == new_lines and not re.search(r"(?i)\b(nan|inf|infinity)\b", "\n".join(kept_lines)):
        return None
    names = column_names(kept_lines)
    rows = []
    for i, (old, line) in enumerate(zip(kept_lines, new_lines), 1):
        if old.startswith("#") or line.startswith("#") or not old.strip() or not line.strip():
            if not same_remark(old, line):
                return f"line {i}: kept '{old}', now '{line}'"
            continue
        old_words, words = old.split(), line.split()
        if len(words) != len(names) or len(old_words) != len(names):
            return f"line {i}: {len(old_words)} columns kept, {len(words)} now, {len(names)} named in the header"
        for name, *texts in zip(names, old_words, words):
            for text in texts:
                if number(text) is not None and not math.isfinite(number(text)):
                    return f"line {i}, {name}: {text} is not a number"
        rows.append((i, old_words, words))
    if len(kept_lines) != len(new_lines):
        return f"{len(kept_lines) - 1} lines kept, {len(new_lines) - 1} now"

    asked = next((float(found[1]) for line in kept_lines if (found := re.match(r"# .*accuracy asked for: (\S+)$", line))), 0.0)
    table = Table(os.path.splitext(os.path.basename(kept_path))[0], names, [old for _, old, _ in rows], asked)
    for i, old_words, words in rows:
        if old_words == words:
            continue
        old_row, row = dict(zip(names, old_words)), dict(zip(names, words))
        for name in names:
            if not table.agree(name, old_row, row):
                return f"line {i}, {name}: kept {old_row[name]}, now {row[name]}"
    return None


# Tables, a line each of kept and new cells, and whether they agree.
CASES = [
    ("frequencies", "speed crank f1 error1", "0 30 23.366918 1.0E-005", "0 30 23.367380 1.0E-005", True),
    ("frequencies", "speed crank f1 error1", "0 30 23.366918 1.0E-005", "0 30 23.367390 1.0E-005", False),
    ("frequencies", "speed crank f1 error1", "0 30 23.366918 1.0E-005", "0 30 23.366918 2.9E-005", True),
    ("frequencies", "speed crank f1 error1", "0 30 23.366918 1.0E-005", "0 30 23.366918 3.1E-005", False),
    ("frequencies", "speed crank f1 error1", "0 30 23.366918 1.0E-014", "0 30 23.366918 2.0E-013", True),
    ("frequencies", "speed crank f1 error1", "0 30 23.366918000000 1.0E-014", "0 30 23.366918000100 1.0E-014", False),
    ("shapes", "speed frequency ux", "0 23.366918000000 1.0", "0 23.366918000100 1.0", False),
    ("torque", "speed rigid linear error", "1 2.0 1.0E-003 1.00E-006", "1 2.0 1.0E-003 1.01E-006", True),
    ("torque", "speed rigid linear error", "1 2.0 1.00000000E-003 1.0E-006", "1 2.0 1.00000300E-003 1.0E-006", False),
    ("response", "speed point ux error", "1 A 1.0000000 1.0E-006", "1 A 1.0000020 1.0E-006", True),
    ("response", "speed point ux error", "1 A 1.0000000 1.0E-006", "1 A 1.0000030 1.0E-006", False),
    ("stability", "speed growth error verdict", "1 -1.000000 1.0E-006 stable", "1 -1.0000019 1.0E-006 stable", True),
    ("stability", "speed growth error verdict", "1 -1.000000 1.0E-006 stable", "1 -1.000003 1.0E-006 stable", False),
    ("stability", "speed growth error verdict", "1 -1.000000 1.0E-006 stable", "1 -1.000000 1.0E-006 undecided", False),
    ("motion", "time kinetic potential work energy_error", "0 17483.3 0.1 600.0 0.0", "0 17483.3 0.1 600.0 -1.1E-011", True),
    ("motion", "time kinetic potential work energy_error", "0 17483.3 0.1 600.0 0.0", "0 17483.3 0.1 600.0 -1.0E-008", False),
    ("motion", "time kinetic potential work energy_error", "0 17483.3 0.1 600.0 0.0", "0 17483.30003 0.1 600.0 0.0", False),
    ("frame", "crank frame_x frame_y", "0 -2.7E-015 108.0", "0 -6.4E-015 108.0", True),
    ("frame", "crank frame_x frame_y", "0 -2.7E-015 108.0", "0 -6.4E-010 108.0", False),
    ("balance", "crank shaking_x balanced_x", "0 100.0 1.0E-014", "0 100.0 -5.0E-011", True),
    ("balance", "crank shaking_x balanced_x", "0 100.0 1.0E-014", "0 100.0 5.0E-010", False),
    ("points", "crank x", "0 0.5", "0 NaN", False),
]
REMARKS = [("# initial energy: 17483.3 J", "# initial energy: 17483.4 J", True), ("# initial energy: 17483.3 J", "# initial energy: 17483.5 J", False),
           ("# order 8, 72 samples", "# order 9, 72 samples", False), ("# at 1.2e-5", "# at 1.3e-5", True), ("# link A2.5", "# link A2.6", False),
           ("", "1", False)]


def self_check():
    """What is wrong with the comparison itself."""
    with tempfile.TemporaryDirectory() as folder:
        for table, names, kept, new, agree in CASES:
            paths = []
            for which, text in (("kept", kept), ("new", new)):
                os.makedirs(os.path.join(folder, which), exist_ok=True)
                paths.append(os.path.join(folder, which, table + ".dat"))
                with open(paths[-1], "w", encoding="utf-8") as file:
                    file.write(f"# {names}\n# -\n{text}\n")
            why = difference(*paths)
            if (why is None) != agree:
                yield f"{table}: '{kept}' and '{new}' {'agree' if agree else 'differ'}, it says: {why}"
    for old, line, agree in REMARKS:
        if same_remark(old, line) != agree:
            yield f"'{old}' and '{line}' {'agree' if agree else 'differ'}"


if __name__ == "__main__":
    if sys.argv[1] == "--self-check":
        sys.exit("\n".join(self_check()) or 0)
    sys.exit(difference(sys.argv[1], sys.argv[2]) or 0)
