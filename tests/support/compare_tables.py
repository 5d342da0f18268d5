#!/usr/bin/env python3
"""Compares a table of the program with the one kept for it.

    compare_tables.py KEPT NEW

Lines that start with # and the places of empty lines must agree exactly, NaN and infinity are never right, and the
columns agree within the tolerances below (numdiff does the arithmetic). Prints why not, and then exits with status 1.
"""

import math
import os
import re
import subprocess
import sys

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
    # Errors: two digits of them are enough, and none of what is rounding alone (see ROUNDING).
    (r"error\d*|(band|speed|growth|f\d+)_error", 1e-2, 0.0),
    # Elastic response: iterations end at their tolerance, well below the estimated errors, and bending takes digits.
    (r"(axial|bending)_strain|(axial|shear)_force|strain|stress|deflection|power|linear|quadratic|total|distance", 1e-8, 1e-9),
    # Where a largest value lies: it is flat there.
    (r"\w+_(at|crank)", 1e-5, 1e-6),
    # All others: closed formulas and small linear systems. Whole numbers are the same or they are not.
    (r".*", 1e-9, 1e-12),
]

# Columns by name: absolute tolerance in their own unit. Bounds of rounding may differ by a factor.
# What is left of a shaking force that counterweights cancel, of an energy that is kept and of a loop that is closed is nothing
# but rounding too: of forces of some 100 N, energies of some 10 N m, lengths of some 0.1 m, and of the angular velocity of a coupler
# that does not turn, of some rad/s.
ROUNDING = {r"error\d+|f\d+_error": 2e-13, r"error": 1e-11, r"balanced_[xy]": 1e-10, r"energy_error": 1e-11, r"closure": 1e-14,
            r"omega\d": 1e-14}

# Errors of the elastic response also hold what its iterations leave, up to this share of the accuracy asked for: rounding decides
# after which of them that is reached, and so how far below.
LEFT_BY_ITERATIONS = 1e-3

# Exponents of the turn end at a change of them, and their errors are what two solutions differ by: of these tables all numbers are
# compared to this share of the accuracy asked for, errors absolutely. Frozen frequencies are as all others.
OF_EXPONENTS = ("stability", "intervals", "campbell", "critical")
EXPONENTS_SHARE = 0.1
# Where several multipliers are near each other rounding decides by which steps the edges of an interval are found: what a row gives
# holds within its errors, and these agree to a factor.
OWN_ERROR = {"intervals": {"from": "error", "to": "error", "at": "error", "largest_growth": "growth_error"}}
ERROR_FACTOR = 10.0
CLOSURE_FACTOR = 2.0
EXACT = r"speed|mode|line|signature|least|mean|greatest|kind|modes|verdict"


def number(word):
    try:
        return float(word)
    except ValueError:
        return None


def column_names(lines):
    """They stand in the last but one # line of the header; the last holds the units."""
    header = []
    for line in lines:
        if not line.startswith("#"):
            break
        header.append(line)
    return header[-2][1:].split() if len(header) >= 2 else []


def difference(kept_path, new_path):
    """Why the tables differ, or None."""
    with open(kept_path, encoding="utf-8") as kept, open(new_path, encoding="utf-8") as new:
        kept_lines, new_lines = kept.read().split("\n"), new.read().split("\n")
    names = column_names(kept_lines)
    largest = {}

    for i, (old, line) in enumerate(zip(kept_lines, new_lines), 1):
        if old.startswith("#") or line.startswith("#") or not old.strip() or not line.strip():
            if old != line:
                return f"line {i}: kept '{old}', now '{line}'"
            continue
        old_words, words = old.split(), line.split()
        if len(words) != len(names) or len(old_words) != len(names):
            return f"line {i}: {len(old_words)} columns kept, {len(words)} now, {len(names)} named in the header"
        for name, old_word, word in zip(names, old_words, words):
            value = number(old_word)
            for text in (old_word, word):
                if number(text) is not None and not math.isfinite(number(text)):
                    return f"line {i}, {name}: {text} is not a number"
            if value is not None:
                largest[name] = max(largest.get(name, 0.0), abs(value))
    if len(kept_lines) != len(new_lines):
        return f"{len(kept_lines) - 1} lines kept, {len(new_lines) - 1} now"

    table = os.path.splitext(os.path.basename(kept_path))[0]
    own = OWN_ERROR.get(table, {})
    for i, (old, line) in enumerate(zip(kept_lines, new_lines), 1):
        if old.startswith("#") or not old.strip():
            continue
        old_cells, cells = (dict(zip(names, text.split())) for text in (old, line))
        for name, error in own.items():
            if abs(float(old_cells[name]) - float(cells[name])) > max(float(old_cells[error]), float(cells[error])):
                return f"line {i}, {name}: kept {old_cells[name]}, now {cells[name]}, farther apart than their errors"

    asked = next((float(found[1]) for line in kept_lines if (found := re.match(r"# .*accuracy asked for: (\S+)$", line))), 0.0)
    command = ["numdiff", "-V"]
    for field, name in enumerate(names, 1):
        relative, absolute = next((r, a) for pattern, r, a in TOLERANCES if re.fullmatch(pattern, name))
        rounding = next((a for pattern, a in ROUNDING.items() if re.fullmatch(pattern, name)), 0.0)
        if name == "closure":                      # in mm there is more of it: a factor of the greatest
            rounding = max(rounding, CLOSURE_FACTOR * largest.get(name, 0.0))
        if name == "error":
            rounding = max(rounding, LEFT_BY_ITERATIONS * asked)
        if name in own:
            relative = 1.0
        elif name in own.values():
            relative = ERROR_FACTOR - 1.0
        elif table in OF_EXPONENTS and not re.fullmatch(EXACT, name) or (table, name) == ("critical", "speed"):
            relative, rounding = EXPONENTS_SHARE * asked, EXPONENTS_SHARE * asked if "error" in name else rounding
        command += ["-r", f"{relative:.0e}:{field}", "-a", f"{max(rounding, absolute * largest.get(name, 0.0)):.3e}:{field}"]
    run = subprocess.run(command + [kept_path, new_path], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return None
    if run.returncode != 1:
        return "numdiff: " + (run.stderr or run.stdout).strip()
    marks = re.search(r"##(\d+)\s+#:(\d+)\s+<==\s*(\S*)\s+##\d+\s+#:\d+\s+==>\s*(\S*)", run.stdout)
    if not marks:
        return "numdiff: " + run.stdout.strip()[:300]
    return f"line {marks[1]}, {names[int(marks[2]) - 1]}: kept {marks[3]}, now {marks[4]}"


if __name__ == "__main__":
    why = difference(sys.argv[1], sys.argv[2])
    if why:
        sys.exit(why)
