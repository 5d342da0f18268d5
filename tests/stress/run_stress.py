#!/usr/bin/env python3
"""The stress test: runs every case, compares it with its reference, and writes a table a family.

    run_stress.py PROGRAM [--out FOLDER] [--every N] [--no-figures] [FAMILY ...]

Tables and figures go to outputs/stress/ by default; --every N takes one case in N. The last line printed is the
count; exit status 1 if any row is neither bounded by what the program tells of its error, nor refused, nor a named failed row.
"""

import argparse
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import references
from decks import key
from families import FAMILIES
from program import run_deck
from verdicts import BOUNDED, COLUMNS, DEFECT, FAILED, MISSED, REFUSED, judge


def run_case(program, case, kept, folder, name):
    status, message, rows = run_deck(program, case.deck(), folder, name)
    on_mesh = kept.get(key(case.on_the_mesh())) if case.same_mesh else None
    return judge(case, status, message, rows, kept.get(key(case.continuous())), on_mesh)


def run_family(program, cases, kept, folder):
    """Two cases at a time, in the order in which they are listed."""
    with ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(run_case, program, case, kept, folder, f"case{i}") for i, case in enumerate(cases)]
        return [result for job in jobs for result in job.result()]


def write_table(path, family, results):
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"# {family}: {FAMILIES[family].__doc__}\n")
        file.write("# a row is a position and speed: its mode with the largest error; ratio: largest error/estimate of its modes\n")
        file.write("# " + " ".join(COLUMNS) + "\n")
        for result in results:
            file.write(result.line() + "\n")


def summary(family, results):
    """Worst error and estimate, and what the error is of the estimate at most."""
    count = {verdict: sum(result.verdict == verdict for result in results) for verdict in (BOUNDED, REFUSED, FAILED, DEFECT)}
    bounded = [result for result in results if result.verdict == BOUNDED]
    worst = max((result.error for result in bounded), default=0)
    estimate = max((result.estimate for result in bounded), default=0)
    ratio = max((result.ratio for result in bounded), default=0)
    return count, f"{family:<12}" + "".join(f"{count[verdict]:8d}" for verdict in count) + \
        f"  {worst:9.1e} {estimate:9.1e} {ratio:7.2f}"


# What a family is drawn against.
AXES = {
    "elements": "elements per link", "orders": "order of an element", "accuracy": "accuracy= of the deck",
    "thickness": "thickness of the links / length of the crank", "stiffness": "axial stiffness, relative",
    "lengths": "length of short links / length of the others", "pin_masses": "mass at each moving pin / mass of the coupler",
    "dead_points": "distance of the crank from a dead point [rad]", "speeds": "crank speed [rad/s]",
    "divergence": "relative distance of the speed from divergence",
    "near_equal": "mass of a link / mass at a pin, or difference in stiffness",
    "units": "size of the unit, relative", "random": "number of the linkage",
    "link_masses": "masses along each link / mass of the link",
    "offset_masses": "masses beside each link / mass of the link, or offset / length", "many_modes": "number of modes",
    "thick_links": "length of the links / thickness", "compression": "force / buckling load of the follower",
    "promises": "accuracy= of the deck", "bounds": "number of the deck in tests/stress/bounds/",
}


def draw(folder, families):
    for family in families:
        call = ["gnuplot", "-c", os.path.join("plots", "stress.gp"), os.path.join(folder, family + ".dat"),
                os.path.join(folder, "stress_" + family), AXES[family], "Stress test: " + family.replace("_", " ")]
        subprocess.run(call, check=True, env={**os.environ, "LC_ALL": "C.UTF-8"})


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--out", default=os.path.join("outputs", "stress"))
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--no-figures", action="store_true")
    parser.add_argument("families", nargs="*")
    words = parser.parse_intermixed_args()
    shutil.rmtree(words.out, ignore_errors=True)
    os.makedirs(words.out)
    kept = references.load()
    drawable, missed = [], 0
    total = dict.fromkeys((BOUNDED, REFUSED, FAILED, DEFECT), 0)
    print(f"{'family':<12}{'bounded':>8}{'refused':>8}{'failed':>8}{'defects':>8}  {'error':>9} {'estimate':>9} {'ratio':>7}")
    for family in words.families or FAMILIES:
        cases = list(FAMILIES[family]())[::words.every]
        results = run_family(words.program, cases, kept, os.path.join(words.out, "runs"))
        write_table(os.path.join(words.out, family + ".dat"), family, results)
        count, line = summary(family, results)
        print(line, flush=True)
        for result in results:
            if result.verdict == DEFECT:
                print(f"defect: {family} {result.line()}", flush=True)
        missed += sum(result.reason == MISSED for result in results)
        if count[BOUNDED]:
            drawable.append(family)
        total = {verdict: total[verdict] + count[verdict] for verdict in total}
    shutil.rmtree(os.path.join(words.out, "runs"), ignore_errors=True)
    if not words.no_figures:
        draw(words.out, drawable)
    if missed:
        print(f"{missed} of the bounded rows say that their accuracy= is not reached")
    print(f"{total[BOUNDED]} bounded, {total[REFUSED]} refused, {total[FAILED]} failed rows with a reason, {total[DEFECT]} defects")
    print(f"{sum(total.values()) - total[DEFECT]} passed, {total[DEFECT]} failed")
    return 1 if total[DEFECT] else 0


if __name__ == "__main__":
    sys.exit(main())
