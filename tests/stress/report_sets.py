"""Random sets of reports of the decks in inputs/, at rest or turning: results, failed rows or a refusal, and never a crash.

  report_sets.py SEED COUNT --program PATH [--scratch DIR]

A run that takes longer than half a minute counts as neither.
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys
import tempfile

REPORTS = ["kinematics", "pins", "inertia", "mesh", "frequencies", "shapes crank=30", "branches", "reactions", "bearings", "frame",
           "friction", "sizing", "points", "lagrange", "equilibrium", "linkage", "balance", "geometry crank=10", "response", "strains",
           "peaks", "drive", "torque", "validity", "stability", "intervals", "campbell", "transient turns=1",
           "motion crank=0 end=0.01 step=0.01", "summary of=torque", "summary of=f1", "summary of=elastic_torque"]
CRASHES = re.compile(r"runtime error|Backtrace|SIGSEGV|SIGFPE|Sanitizer", re.I)
LONGEST = 30  # seconds
TRIES = 8


def deck_of(rng, path):
    """The deck with other reports, and few positions."""
    lines = []
    for line in path.read_text().splitlines():
        if re.match(r"\s*(REPORT|SPEED|END)\b", line, re.I):
            continue
        line = re.sub(r"^\s*CRANK\s.*\bstep\b.*", "CRANK 10 50 77", line, flags=re.I)
        line = re.sub(r"(table=|^\s*INCLUDE\s+)(\S+\.\w+)", lambda m: m[1] + str(path.parent.resolve() / m[2]), line)
        lines.append(line)
    if not any(re.match(r"\s*LAW\b", line, re.I) for line in lines):
        lines.append(f"SPEED {rng.choice([0, 0, 5, -20])}")
    return "\n".join(lines + [f"REPORT {report}" for report in rng.sample(REPORTS, rng.choice([1, 2, 2, 3]))]) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scratch")
    given = parser.parse_args()
    decks = sorted(pathlib.Path("inputs").glob("*.deck"))
    failed = refused = slow = 0
    with tempfile.TemporaryDirectory(dir=given.scratch) as scratch:
        for case in range(given.count):
            rng = random.Random(f"{given.seed}/{case}")
            path = rng.choice(decks)
            file = pathlib.Path(scratch) / f"{path.stem}.deck"
            try:
                for _ in range(TRIES):                # sets that are refused cost little, and tell little
                    file.write_text(deck_of(rng, path))
                    run = subprocess.run([given.program, "--quiet", "--out", scratch + "/out", str(file)], capture_output=True,
                                         text=True, errors="replace", timeout=LONGEST, check=False)
                    if run.returncode != 2 or CRASHES.search(run.stderr):
                        break
            except subprocess.TimeoutExpired:
                slow += 1
                continue
            refused += run.returncode == 2
            if run.returncode not in (0, 1, 2) or CRASHES.search(run.stderr):
                failed += 1
                print(f"case {case}, {path}: status {run.returncode}", *[line for line in file.read_text().splitlines()
                      if line.startswith(("REPORT", "SPEED"))], run.stderr[:300], sep="\n  ")
    print(f"{given.count} sets, {refused} refused, {slow} too slow")
    print(f"{given.count - slow - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
