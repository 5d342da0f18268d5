"""Published cases: what the program finds for the decks of this folder against the values of values.csv.

    published.py [NAME ...] [--program PATH] [--scratch FOLDER]

A line of values.csv is a value in a table of a deck: `row` names the row by column=value, joined by ;, `column` the column, or
hypot(a b) of two of them; `within` is the largest relative difference, an absolute one where the value is 0.  A value that is also
the exact one of the stated equations has a small one, a published one that of its digits.  `source` says where it comes from.
Prints `ok NAME` or `not ok NAME: why` for every value, and the count.
"""
import argparse
import csv
import math
import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "linkages"))
from tables import run  # noqa: E402


def is_at(row, place):
    """Whether a row has the values that a place names, such as speed=2;mode=1."""
    for part in filter(None, place.split(";")):
        name, value = part.split("=")
        if name not in row:
            return False
        if isinstance(row[name], float):
            if not math.isclose(row[name], float(value), rel_tol=1e-9, abs_tol=1e-9):
                return False
        elif row[name] != value:
            return False
    return True


def value_of(row, column):
    if column.startswith("hypot("):
        return math.hypot(*(row[name] for name in column[6:-1].split()))
    return row[column]


def fault_of(tables, case):
    """Why a value is not what it should be; None: it is."""
    if case["table"] not in tables:
        return f"there is no {case['table']}.dat"
    rows = [row for row in tables[case["table"]].rows if is_at(row, case["row"])]
    if len(rows) != 1:
        return f"{len(rows)} rows at {case['row']}"
    found, expected = value_of(rows[0], case["column"]), float(case["value"])
    if not isinstance(found, float):
        return f"{found}, not {expected}"
    if not abs(found - expected) <= float(case["within"]) * (abs(expected) or 1.0):
        return f"{found:.12g} is not {expected:.12g} within {case['within']}"
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--scratch")
    options = parser.parse_args()
    with open(os.path.join(HERE, "values.csv"), encoding="utf-8", newline="") as file:
        cases = [case for case in csv.DictReader(file) if not options.names or case["deck"] in options.names]
    scratch = options.scratch or tempfile.mkdtemp()
    tables, failed = {}, 0
    for case in cases:
        name = case["deck"]
        if name not in tables:
            try:
                tables[name] = run(options.program, os.path.join(HERE, name + ".deck"), scratch)
            except RuntimeError as fault:
                tables[name] = {}
                print(f"# {name}: {fault}")
        fault = fault_of(tables[name], case)
        failed += fault is not None
        title = " ".join(filter(None, (name, case["table"], case["row"], case["column"])))
        print(f"not ok {title}: {fault}" if fault else f"ok {title}")
    print(f"{len(cases) - failed} passed, {failed} failed")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
