#!/usr/bin/env python3
"""Runs that are killed, and pairs of runs at a time, in one output folder: whoever reads finds the tables of one run, whole.

    shared_folder.py [--program PROGRAM] [--scratch FOLDER] [--pairs N] [--kills N] [--resumes N] [--seed S]

Pairs are two decks of one name with other tables at the same moment; kills are SIGKILL after a random time; resumes are kills until
`--resume` comes to the end, with the bytes of a run that nobody disturbed. After each of them a folder holds the files that
`summary.json` lists, of one of the two decks, or no `summary.json`. The last line is the count; exit status 1 when one was wrong.
"""

import argparse
import filecmp
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

LINKAGE = """UNITS    mm tonne s
MATERIAL steel E=200000 density=7.8e-9
SECTION  strip rectangle thickness=1.6 width=25.4
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank    O2 A length=100   material=steel section=strip
LINK     coupler  A  B length={coupler} material=steel section=strip
LINK     follower O4 B length=266.7 material=steel section=strip
DRIVE    crank
INERTIA  distributed
SPEED    10 rad/s
"""
DECKS = [
    "CRANK 0 to 360 step 2\nREPORT kinematics\nREPORT inertia\nREPORT reactions\nREPORT linkage\nREPORT balance\nREPORT frame\n",
    "CRANK 0 to 360 step 5\nREPORT kinematics\nREPORT inertia\nREPORT lagrange\nREPORT mesh\nMESH * elements=2\n",
]
# Long enough for a journal: resume.part begins after a quarter of a second.
LONG = "VARY L 270 to 290 step 0.1\nMESH * accuracy=1e-9\nCRANK 0 to 350 step 5\nREPORT frequencies\nREPORT kinematics\n"
EXTRA = {"echo.deck", "run.log", "summary.json"}


def write_decks(scratch):
    """Two decks of one name, and a long one; their paths."""
    paths = []
    texts = [LINKAGE.format(coupler="279.4") + text for text in DECKS] + [LINKAGE.format(coupler="$L") + LONG]
    for i, text in enumerate(texts):
        os.makedirs(os.path.join(scratch, f"decks{i}"), exist_ok=True)
        paths.append(os.path.join(scratch, f"decks{i}", "s.deck"))
        with open(paths[-1], "w", encoding="utf-8") as deck:
            deck.write(text)
    return paths


def start(program, out, deck, *options):
    return subprocess.Popen([program, "--quiet", "--out", out, *options, deck], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True)


def listed(folder):
    """The files that the summary of a folder names; None without one."""
    try:
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    except FileNotFoundError:
        return None
    return {table[form] for table in summary["tables"] for form in ("file", "csv") if table[form]} | EXTRA


def fault(folder, references):
    """What is wrong with what a reader finds; None if nothing is."""
    names = listed(folder)
    if names is None:
        return None
    for reference in references:
        if names == listed(reference):
            if not all(filecmp.cmp(os.path.join(folder, name), os.path.join(reference, name), shallow=False) for name in names):
                continue
            more = {name for name in os.listdir(folder) if not name.startswith(".") and name != "resume.part"} - names
            return f"beside them there are {sorted(more)}" if more else None
    return "tables of neither deck, or of both"


def pair(program, scratch, decks, references, dice):
    out = os.path.join(scratch, "o")
    runs = [start(program, out, deck) for deck in dice.sample(decks[:2], 2)]
    said = [run.communicate()[1] for run in runs]
    status = [run.returncode for run in runs]
    if 0 not in status or any(one not in (0, 2) for one in status):
        return f"exit statuses {status}: {said}"
    if 2 in status and "another run is writing to this folder (" not in "".join(said):
        return f"it said {said}"
    if listed(os.path.join(out, "s")) is None:
        return "no summary.json"
    return fault(os.path.join(out, "s"), references)


def kill(program, scratch, decks, references, dice):
    out = os.path.join(scratch, "o")
    run = start(program, out, dice.choice(decks[:2]))
    time.sleep(dice.uniform(0, kill.longest))
    run.send_signal(signal.SIGKILL)
    run.communicate()
    return fault(os.path.join(out, "s"), references)


def resume(program, scratch, decks, references, dice):
    out = os.path.join(scratch, "r")
    shutil.rmtree(out, ignore_errors=True)
    for _ in range(1000):
        run = start(program, out, decks[2], "--resume")
        try:
            run.communicate(timeout=dice.uniform(0.2, resume.longest))
        except subprocess.TimeoutExpired:
            run.send_signal(signal.SIGKILL)
            run.communicate()
            resume.longest *= 1.05  # a slow machine comes to an end, too
            continue
        if run.returncode != 0:
            return f"exit status {run.returncode}"
        return fault(os.path.join(out, "s"), references) or (None if listed(os.path.join(out, "s")) else "no summary.json")
    return "it comes to no end"


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--program", default="build/release/flexmech")
    options.add_argument("--scratch", default="build/shared_folder")
    for name in ("pairs", "kills", "resumes"):
        options.add_argument("--" + name, type=int, default=0)
    options.add_argument("--seed", type=int, default=1)
    options = options.parse_args()
    program, scratch = os.path.abspath(options.program), os.path.abspath(options.scratch)
    shutil.rmtree(scratch, ignore_errors=True)
    decks = write_decks(scratch)
    references = []
    for i, deck in enumerate(decks):
        begun = time.time()
        if start(program, os.path.join(scratch, f"alone{i}"), deck).wait() != 0:
            sys.exit("a run alone fails")
        if i < 2:
            kill.longest = 1.3 * (time.time() - begun)
        else:
            resume.longest = time.time() - begun
        references.append(os.path.join(scratch, f"alone{i}", "s"))
    dice = random.Random(options.seed)
    faults = 0
    tries = [(test, i) for test, count in ((pair, options.pairs), (kill, options.kills), (resume, options.resumes)) for i in range(count)]
    for test, number in tries:
        why = test(program, scratch, decks, references, dice)
        if why:
            faults += 1
            print(f"not ok {test.__name__} {number + 1}: {why}", flush=True)
            shutil.rmtree(os.path.join(scratch, "o"), ignore_errors=True)
    print(f"{len(tries) - faults} passed, {faults} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
