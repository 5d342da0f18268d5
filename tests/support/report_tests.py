#!/usr/bin/env python3
"""Every report that `flexmech --help-cards` lists has the tables that it promises, in the form of tables.

    report_tests.py [--program PATH] [--scratch FOLDER]

Each report is asked for on the linkages below, with the keys that its pattern demands: a new report needs no line here. Every
table has remarks, rows as its head has columns, a block for each speed, and on a linkage at a dead point a failed row instead of a
row.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile

from table_tests import Fault, Table

# Keys of reports, and what they are given here; others have no value, or the one that the pattern names.
VALUES = {"accuracy": "1e-2", "coordinates": "yes", "crank": "40,50", "end": "0.02", "fluctuation": "2%", "pins": "yes", "points": "3",
          "ratio_to": "lift", "start": "steady", "step": "0.01", "turns": "0.02"}
# Of the report that has a list of them: the first that a linkage has.
QUANTITIES = [f"{of_all},ratio:{name}" for of_all in ("f2,torque,stress", "f2,torque", "torque") for name in ("reach", "lean")]
ONE_VALUE = ["motion", "transient"]  # reports that begin at one angle
NOT_OF_POSITIONS = ["branches", "equilibrium", "linkage"]  # reports whose rows are no positions, and which so have no dead points
# Nothing grows in these linkages, and no speed is critical.
MAY_BE_EMPTY = ["intervals", "critical"]

STEEL = """UNITS mm tonne s
MATERIAL steel E=200000 density=7.8e-9
SECTION strip rectangle thickness=1.6 width=25.4
GROUND O2 0 0
DRIVE crank
INERTIA distributed
CRANK 40 50
"""
LINKAGES = {
    "four_bar": STEEL + """GROUND O4 254 0
LINK crank O2 A length=100 material=steel section=strip
LINK coupler A B length=279.4 material=steel section=strip
LINK follower O4 B length=266.7 material=steel section=strip
MESH * elements=2
POINT P coupler along=120 offset=-80
MEASURE lift travel P 0 1
MEASURE reach distance O2 P
MODES 2
SPEED 40 41
DAMPING * ratio=0.05
""",
    "rigid": STEEL + """GUIDE bore 0 0 angle=90
LINK crank O2 A length=45 mass=1kg inertia=1kg*cm2
LINK rod A B length=145 mass=1kg inertia=1kg*cm2
SLIDER B bore mass=1kg
BRANCH B forward
POINT P rod along=70 offset=5
MEASURE lift travel P 0 1
MEASURE lean angle rod
FRICTION B bore coefficient=0.1
SPEED 40 41
""",
    "elastic": STEEL + """GUIDE bore 0 0 angle=90
LINK crank O2 A length=45 material=steel section=strip
LINK rod A B C lengths=145,40 turns=20 material=steel section=strip
SLIDER B bore mass=1e-4
BRANCH B forward
POINT P rod along=70 offset=5
MEASURE lift travel P 0 1
MEASURE lean angle rod
MODES 2
SPEED 100 101
DAMPING * ratio=0.05
"""}
# A parallelogram that is stretched.
DEAD = """UNITS m kg s
MATERIAL steel E=200GPa density=7800
SECTION strip circle diameter=0.01
GROUND O2 0 0
GROUND O4 4 0
LINK a O2 A length=1 material=steel section=strip
LINK b A B length=4 material=steel section=strip
LINK c O4 B length=1 material=steel section=strip
DRIVE a change_points=branch
MESH * elements=1
INERTIA distributed
POINT P b along=2
MEASURE lift travel P 0 1
MEASURE reach distance O2 P
CRANK 180
SPEED 2
"""


def reports_of(program):
    """Of every report on the list its name, pattern and files; an older name is not asked for beside its successor."""
    text = subprocess.run([program, "--help-cards"], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^REPORT ([a-z]\w*)(.*)\n    (.*): (\w+\.dat(?:, \w+\.dat)*)", text, re.MULTILINE)
    return [(name, pattern, files.replace(".dat", "").split(", ")) for name, pattern, words, files in found if "older name" not in words]


def cards_of(name, pattern):
    """REPORT cards to try, the richest first."""
    words = [name]
    for key, value in re.findall(r"(\w+)=(?:([a-z]+(?:,[a-z]+)+)(?=[\s\]]|$))?", re.sub(r"=[^\s\]]*(\|)[^\s\]]*", "=", pattern)):
        if key in VALUES:
            words.append(f"{key}={VALUES[key].split(',')[0] if name in ONE_VALUE else VALUES[key]}")
        elif value:
            words.append(f"{key}={value}")
        elif re.search(rf"(?<!\[){key}=", pattern) and key != "of":
            words.append(f"{key}=")  # refused: VALUES has to know it
    card = "REPORT " + " ".join(words)
    return [f"{card} of={quantities}" for quantities in QUANTITIES] if " of=" in pattern else [card]


class Trial:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, name, text, *options):
        path = os.path.join(self.folder, name + ".deck")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return subprocess.run([self.program, *options, "--quiet", "--out", "out", name + ".deck"], cwd=self.folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)

    def accepted(self, deck, name, pattern):
        """The REPORT card that a deck takes, or None."""
        return next((card for card in cards_of(name, pattern)
                     if self.run("try", deck + card + "\n", "--check").returncode == 0), None)

    def table(self, deck, name):
        return Table(os.path.join(self.folder, "out", deck, name + ".dat"))


def check_form(table, name):
    """Table() itself has compared rows with the head."""
    if not all(note.strip() for note in table.notes) or len(table.notes) < 4:
        raise Fault("there are no remarks")
    if not table.rows and name not in MAY_BE_EMPTY:
        raise Fault("there are no rows")
    if table.failed:
        raise Fault(f"failed: {table.failed}")
    if table.names[:2] == ["speed", "crank"]:
        # A block belongs to a speed, and goes through the positions.
        blocks = table.shape.replace("1", "").split("2")
        speeds, first = [], 0
        for block in blocks:
            rows = table.rows[first:first + len(block)]
            first += len(block)
            if len({row["speed"] for row in rows}) != 1:
                raise Fault("a block of several speeds")
            if name != "branches" and [row["crank"] for row in rows] != sorted(row["crank"] for row in rows):
                raise Fault("angles out of their order")
            speeds.append(rows[0]["speed"])
        if speeds != sorted(speeds) or len(set(speeds)) != 2 or {row["crank"] for row in table.rows} != {40.0, 50.0}:
            raise Fault(f"speeds {speeds}")


def results(program, folder):
    """Of every test its name and why it has failed, or None."""
    trial = Trial(program, folder)
    reports = reports_of(program)
    left = {}
    for name, pattern, files in reports:
        left.setdefault(name, []).append((pattern, files))
    cards = {linkage: {} for linkage in LINKAGES}
    for name, patterns in left.items():
        for linkage, deck in LINKAGES.items():
            # Where there are two, the first is of four-bars.
            pattern, files = patterns[-1 if linkage != "four_bar" else 0]
            card = trial.accepted(deck, name, pattern)
            if card:
                cards[linkage][name] = card, files
        takers = [linkage for linkage in LINKAGES if name in cards[linkage]]
        why = None if takers and (len(patterns) == 1 or len(takers) > 1) else f"it is taken by {takers} only"
        yield f"REPORT {name}", why
    for linkage, deck in LINKAGES.items():
        done = trial.run(linkage, deck + "\n".join(card for card, _ in cards[linkage].values()) + "\n")
        promised = sorted(file for _, files in cards[linkage].values() for file in files)
        found = sorted(file[:-4] for file in os.listdir(os.path.join(folder, "out", linkage)) if file.endswith(".dat"))
        right = done.returncode == 0 and found == promised
        yield f"tables of {linkage}", None if right else f"{found}, not {promised}\n{done.stderr}"
        for file in found:
            try:
                check_form(trial.table(linkage, file), file)
                yield f"{file}.dat of {linkage}", None
            except Fault as fault:
                yield f"{file}.dat of {linkage}", fault
    # Of a dead point there is no row in any table of positions, but its place in the first columns and the reason.
    for name, (card, files) in cards["four_bar"].items():
        table = trial.table("four_bar", files[0])
        if "[crank=" in left[name][0][0]:
            card = re.sub(r" crank=\S+", "", card)
        if "crank" not in table.names[:2] or name in NOT_OF_POSITIONS or "accuracy=" in card or "crank=" in card:
            continue
        done = trial.run(name, DEAD + card + "\n")
        why = None
        if done.returncode == 1:
            try:
                table = trial.table(name, files[0])
                if table.rows or not re.match(r"(speed=2 )?crank=180 : dead point", table.failed[0]):
                    why = f"rows {table.rows}, failed {table.failed}"
            except Fault as fault:
                why = fault
        else:
            why = f"status {done.returncode}: {done.stderr}"
        yield f"{name} at a dead point", why


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--scratch")
    options = parser.parse_args()
    failed = passed = 0
    for name, why in results(os.path.abspath(options.program), options.scratch or tempfile.mkdtemp()):
        print(f"not ok {name}: {why}" if why else f"ok {name}")
        failed += why is not None
        passed += why is None
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
