"""Random linkages left to themselves for three seconds, from rest or with a speed: their energy must balance.

    random_motions.py SEED COUNT [--program PATH] [--scratch FOLDER]

Many pass dead points of their drives.  A motion that ends early, other than where a block leaves its link, or whose energy_error is
above 1e-9 of the energies, is a line with its seed and reason, and its deck stays in the scratch folder.  The last line has the counts and the largest error.
"""
import argparse
import os
import random
import re
import subprocess
import sys
import tempfile

from random_linkages import make

WORST = 1e-9


def deck(case, seed):
    """The linkage with the middle of its range as the start."""
    lines = [line for line in case.text(5).splitlines() if not line.startswith(("CRANK", "SPEED", "REPORT"))]
    start = case.first + case.span * case.unit / 2
    speed = random.Random(seed).choice((0, 0.4 * case.scale) if case.linear else (0, 3, -5))
    return "\n".join(lines + [f"REPORT motion crank={start} speed={speed} end=3 step=0.25"]) + "\n"


def follow(program, path, folder):
    """The largest error of the energy, relative to the energies, and the number of dead points passed."""
    done = subprocess.run([program, "--quiet", "--out", folder, path], capture_output=True, text=True, timeout=600, check=False)
    if done.returncode != 0 and not re.search(r": the block at \S+ leaves '", done.stderr):
        raise ValueError(done.stderr.strip().splitlines()[0])
    tables = os.path.join(folder, os.path.splitext(os.path.basename(path))[0])
    with open(os.path.join(tables, "motion.dat"), encoding="utf-8") as file:
        rows = [[float(word) for word in line.split()] for line in file if line.strip() and not line.startswith("#")]
    energies = max((abs(row[-4]) + abs(row[-3]) + abs(row[-2]) for row in rows), default=0)
    error = max((abs(row[-1]) for row in rows), default=0)
    with open(os.path.join(tables, "run.log"), encoding="utf-8") as file:
        return error / energies if energies > 0 else error, file.read().count("passes a dead point")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_motions"))
    options = parser.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    done = failures = passing = 0
    largest = 0.0
    for seed in range(options.seed, options.seed + options.count):
        case = make(seed)
        # Without masses nothing moves by itself; four-bars have a table of their own.
        if case.four_bar or not case.loaded:
            continue
        done += 1
        path = os.path.join(options.scratch, f"motion_{seed}.deck")
        with open(path, "w", encoding="utf-8") as file:
            file.write(deck(case, seed))
        try:
            error, passed = follow(options.program, path, options.scratch)
            if not error <= WORST:
                raise ValueError(f"energy off by {error:.1e}")
        except (ValueError, OSError, subprocess.TimeoutExpired) as failure:
            failures += 1
            print(f"seed {seed}: {failure} ({' '.join(case.drawing.kinds)}; {path})", flush=True)
            continue
        os.remove(path)
        largest = max(largest, error)
        passing += passed > 0
    print(f"{done} motions, {failures} failed, {passing} through dead points; largest error of the energy {largest:.1e}")
    print(f"{done - failures} passed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
