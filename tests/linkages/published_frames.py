"""Frames, beams and shafts with published or closed values: the decks of tests/exact/frames.

  published_frames.py --program PATH [--scratch DIR]

A line `! expect [NAME=VALUE] f = … within …` of a deck has the frequencies (or damping ratios zeta) of its row, and their tolerances:
one for all or one each, shares of the values, of a value 0 in Hz.
"""
import argparse
import glob
import os
import subprocess
import sys
import tempfile

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exact", "frames")


def expectations(path):
    for line in open(path, encoding="utf-8"):
        if line.startswith("! expect "):
            head, values = line[9:].split(" = ")
            values, tolerances = values.split(" within ")
            *place, quantity = head.split()
            values, tolerances = [float(x) for x in values.split()], [float(x) for x in tolerances.split()]
            yield place, quantity, values, tolerances * len(values) if len(tolerances) == 1 else tolerances


def rows(path):
    lines = open(path, encoding="utf-8").read().splitlines()
    first = next(k for k, line in enumerate(lines) if line and not line.startswith("#"))
    names = lines[first - 2].lstrip("#").split()
    return [dict(zip(names, map(float, line.split()))) for line in lines if line.strip() and not line.startswith("#")]


def check(program, deck, scratch):
    name = os.path.basename(deck)[:-5]
    run = subprocess.run([program, "--quiet", "--out", scratch, deck], capture_output=True, text=True, check=False)
    if run.returncode:
        return [run.stderr]
    table, said, compared = rows(os.path.join(scratch, name, "frequencies.dat")), [], 0
    for place, quantity, values, tolerances in expectations(deck):
        found = [row for row in table if all(abs(row[part.split("=")[0]] - float(part.split("=")[1])) < 1e-9 for part in place)]
        if len(found) != 1:
            said.append(f"{len(found)} rows for {place}")
            continue
        for k, (value, tolerance) in enumerate(zip(values, tolerances), 1):
            compared += 1
            off = abs(found[0][f"{quantity}{k}"] - value)
            if not off <= tolerance * (abs(value) or 1):
                said.append(f"{place} {quantity}{k}: {found[0][f'{quantity}{k}']:.12g}, not {value:.12g}")
    return said if compared else ["nothing to compare"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--scratch")
    given = parser.parse_args()
    failed = 0
    decks = sorted(glob.glob(os.path.join(FOLDER, "*.deck")))
    with tempfile.TemporaryDirectory(dir=given.scratch) as scratch:
        for deck in decks:
            said = check(given.program, deck, scratch)
            failed += bool(said)
            print(f"{'not ok' if said else 'ok'} {os.path.basename(deck)[:-5]}", *said, sep="\n  " if said else "")
    print(f"{len(decks) - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
