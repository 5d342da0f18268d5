"""The tables of docs/verification.md about linkages of any kind: known ones, and a pendulum of two rods."""

import math
import os
import re
import subprocess
import sys

from numbers_in_text import Number, Word, error, fixed, rough_error, rounding
from runs import Run

SCRIPT = os.path.join("tests", "linkages", "anchors.py")
# Columns of the table of known linkages, and the kinds of differences that belong to each.
COLUMNS = (("position", "angle"), ("velocity", "omega", "rate"), ("acceleration", "alpha"), ("force", "torque"), ("published",))
# Rounding grows over the three seconds of the pendulum, differently on different machines.
SWING_ROUNDING = 1e-11
# Frequencies against 24 digits.
EXACT_ROUNDING = 1e-13
# Likewise the energy over 1,000 turns, and through hundreds of dead points.
FREE_ROUNDING = 1e-11


def answer(*options):
    return subprocess.run([sys.executable, "-B", SCRIPT, *options], capture_output=True, text=True, check=True).stdout


class Tables:
    """Every method without an underscore is the maker of the table of its name."""

    def __init__(self, program):
        self._program = program

    def known_linkages(self):
        """A row for every line of anchors.py but the count; what is compared with what belongs to the document."""
        for line in answer("--program", self._program).splitlines()[:-1]:
            verdict, name, *words = line.replace(":", " ", 1).split()
            if verdict != "passed":
                raise ValueError(line)
            found = {kind: float(value) for kind, value in zip(words[::2], words[1::2])}
            cells = [[found[kind] for kind in kinds if kind in found] for kinds in COLUMNS]
            cells.append([value for kind, value in found.items() if kind.startswith("solver")])
            yield [Word(f"`{name}`"), None] + [error(max(values)) if values else Word("") for values in cells]

    def exact_linkages(self):
        """The largest errors of f1 to f3 and of f4 and f5, which are rounding, and the largest estimate."""
        script = os.path.join("tests", "linkages", "exact_frequencies.py")
        out = subprocess.run([sys.executable, "-B", script, "--program", self._program], capture_output=True, text=True, check=True).stdout
        for line in out.splitlines():
            if line.startswith("ok "):
                name, values = line[3:].split(":")
                *errors, estimate = [float(value) for value in values.split()]
                yield [Word(f"`{name}`"), rounding(max(errors[:3]), EXACT_ROUNDING), rounding(max(errors[3:]), EXACT_ROUNDING),
                       rough_error(estimate)]

    def swinging_rods(self):
        """Angles at every half second, and the largest differences from an integration with decimals."""
        with open(os.path.join("tests", "linkages", "decks", "pendulum.deck"), encoding="utf-8") as file:
            rows = Run(self._program, file.read()).rows("motion")
        expected = [[float(word) for word in line.split()] for line in answer("--pendulum").splitlines() if not line.startswith("#")]
        for (time, one, two, rate, rate2, _), row in zip(expected, rows[1:]):
            angles = row["position1"], row["position1"] + row["position2"]
            rates = row["rate1"], row["rate1"] + row["rate2"]
            yield [Number(time, ".1f"), fixed(angles[0], 10), fixed(angles[1], 10),
                   rounding(math.radians(max(abs(angles[0] - one), abs(angles[1] - two))), SWING_ROUNDING),
                   rounding(max(abs(rates[0] - rate), abs(rates[1] - rate2)), SWING_ROUNDING)]

    def free_motions(self):
        """Turns, dead points passed, steps and the error of the energy of motions without losses."""
        for name in ("engine_free", "watt_free", "lever_free", "triad_free"):
            with open(os.path.join("tests", "linkages", "decks", name + ".deck"), encoding="utf-8") as file:
                run = Run(self._program, file.read())
            rows = run.rows("motion")
            most = max(row["kinetic"] + abs(row["potential"]) for row in rows)
            passed = run.log.count("passes a dead point")
            more = re.search(r"motion: (\d+) more of these", run.log)
            # Steps follow the rounding of many turns: the same on machines of a kind only.
            steps = int(re.search(r"motion: (\d+) steps", run.log)[1])
            yield [Word(f"`{name}`"), Number(math.floor(abs(rows[-1]["position1"] - rows[0]["position1"])/360), ",.0f"),
                   Number(passed + (int(more[1]) if more else 0), ",.0f", 1.01), Number(steps, ",.0f", 1.05),
                   rounding(max(abs(row["energy_error"]) for row in rows)/most, FREE_ROUNDING)]
