#!/usr/bin/env python3
"""The strong flips of rod.deck against Hill's equation: `ok NAME` or `not ok NAME: why` for each crank.

    rod.py PROGRAM SCRATCH
"""
import os
import subprocess
import sys

from hill import Rod

HERE = os.path.dirname(os.path.abspath(__file__))
TOLERANCE = 2e-5    # of edges, relative: the rod of the program is extensible
CRANKS = ((0.03, 204.35, 208.91, 206.6), (0.06, 183.22, 201.12, 192.3))  # r, edges and peak, about


def edge(rod, inside, outside):
    """Where growth begins, by bisection."""
    for _ in range(22):
        middle = 0.5 * (inside + outside)
        if rod.growth(middle) > 1e-7:
            inside = middle
        else:
            outside = middle
    return 0.5 * (inside + outside)


def main():
    program, scratch = sys.argv[1:3]
    done = subprocess.run([program, "--quiet", "--out", scratch, os.path.join(HERE, "rod.deck")], capture_output=True, text=True,
                          check=False)
    with open(os.path.join(scratch, "rod", "intervals.dat"), encoding="utf-8") as file:
        rows = [line.split() for line in file if line.strip() and not line.startswith("#")]
    failed = 0
    for r, low, high, peak in CRANKS:
        why = [] if done.returncode == 0 else [f"exit status {done.returncode}: {done.stderr.strip()}"]
        mine = [row for row in rows if abs(float(row[0]) - r) < 1e-9]
        if len(mine) != 1 or mine[0][3:5] != ["flip", "1"]:
            why.append(f"not one flip of mode 1: {mine}")
        else:
            rod = Rod(r, 0.3, 7800 * 0.002 * 0.02, 2e11 * 0.02 * 0.002**3 / 12, 0.1)
            for value, expected in zip(map(float, mine[0][1:3]), (edge(rod, peak, low - 1.0), edge(rod, peak, high + 1.0))):
                if abs(value - expected) > TOLERANCE * expected:
                    why.append(f"edge {value}, by Hill {expected}")
            growth = rod.growth(float(mine[0][7]))
            if abs(float(mine[0][5]) - growth) > 5e-4 * growth:
                why.append(f"growth {mine[0][5]}, by Hill {growth}")
        failed += bool(why)
        print(f"not ok strong flip of a rod, crank {r} m: {'; '.join(why)}" if why else f"ok strong flip of a rod, crank {r} m")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
