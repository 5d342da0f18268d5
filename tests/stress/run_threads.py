#!/usr/bin/env python3
"""Runs decks on several threads, again and again: their files must be the same bytes as on one.

    run_threads.py [DECK ...] --program PATH [--runs N] [--seconds S] [--scratch DIR]

Without decks all of inputs/, and all of them once more with a length of a link that varies, in fewer steps where a run is slow. A deck is
run `--runs` times at most, on 2, 3 and 7 threads in turn, until that has taken `--seconds`, but once on each at least. Prints `not ok DECK: why`, and in the end
`N passed, N failed`, of runs.
"""

import argparse
import filecmp
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from glob import glob

THREADS = (2, 3, 7)
ANYWHERE = {"run.log", "summary.json"}  # these have times


def varied(text, steps):
    """A deck with VARY instead of the first length of a link that is a bare number, in steps up to a hundredth; None if it has none,
    or varies already."""
    found = re.search(r"(?m)^LINK\b.*?\blength=([\d.]+)(?=\s|$)", text)
    if not found or re.search(r"(?m)^VARY\b", text):
        return None
    length = float(found[1])
    text = text[:found.start(1)] + "$threads_length" + text[found.end(1):]
    values = " ".join(f"{length*(1 + 0.01*i/steps):.9g}" for i in range(steps + 1))
    return re.sub(r"(?m)^(UNITS\b.*)$", rf"\1\nVARY threads_length {values}", text, count=1)


def execute(program, deck, threads, out):
    """Status of a run, and the folder of its tables."""
    shutil.rmtree(out, ignore_errors=True)
    status = subprocess.run([program, "--quiet", "--threads", str(threads), "--out", out, deck], stdin=subprocess.DEVNULL,
                            capture_output=True, timeout=1200, check=False).returncode
    # A hidden deck has a hidden folder.
    found = os.listdir(out) if os.path.isdir(out) else []
    return status, os.path.join(out, found[0]) if found else out


def difference(first, second):
    """What differs between the files of two runs."""
    if first[0] != second[0]:
        return f"status {second[0]}, not {first[0]}"
    names = [{name for name in os.listdir(folder)} - ANYWHERE if os.path.isdir(folder) else set() for _, folder in (first, second)]
    if names[0] != names[1]:
        return f"files {sorted(names[1])}, not {sorted(names[0])}"
    _, wrong, lost = filecmp.cmpfiles(first[1], second[1], names[0], shallow=False)
    return f"other bytes in {' '.join(sorted(wrong + lost))}" if wrong or lost else None


def examine(options, deck, name):
    """Numbers of right and of wrong runs of a deck, and the seconds that one thread takes."""
    begun = time.time()
    alone = execute(options.program, deck, 1, os.path.join(options.scratch, "alone"))
    took = time.time() - begun
    counts, reasons = [0, 0], set()
    for i in range(max(options.runs, len(THREADS))):
        if i >= len(THREADS) and time.time() - begun > options.seconds:
            break
        threads = THREADS[i % len(THREADS)]
        why = difference(alone, execute(options.program, deck, threads, os.path.join(options.scratch, "together")))
        counts[why is not None] += 1
        if why and why not in reasons:
            reasons.add(why)
            print(f"not ok {name}: {why} with {threads} threads", flush=True)
    return counts, took


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--scratch")
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    options.scratch = os.path.abspath(options.scratch or tempfile.mkdtemp(prefix="threads"))
    total = [0, 0]
    for deck in options.decks or sorted(glob(os.path.join("inputs", "*.deck")) + glob(os.path.join("tests", "threads", "*.deck"))):
        counts, took = examine(options, deck, deck)
        total = [a + b for a, b in zip(total, counts)]
        with open(deck, encoding="utf-8") as file:
            text = varied(file.read(), max(2, min(24, int(options.seconds/took))))
        if not text or options.decks:
            continue
        # Tables of parts and files included are beside the deck.
        of_variants = os.path.join(os.path.dirname(deck), f".threads_{os.getpid()}.deck")
        try:
            with open(of_variants, "w", encoding="utf-8") as file:
                file.write(text)
            counts, _ = examine(options, of_variants, f"{deck} with VARY")
            total = [a + b for a, b in zip(total, counts)]
        finally:
            os.remove(of_variants)
    shutil.rmtree(options.scratch, ignore_errors=True)
    print(f"{total[0]} passed, {total[1]} failed")
    return 1 if total[1] else 0


if __name__ == "__main__":
    sys.exit(main())
