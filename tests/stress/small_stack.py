#!/usr/bin/env python3
"""Runs the decks of inputs/ and large ones under a stack of 256 kB, with two threads, and prints what each costs.

    small_stack.py [--small] [--program PROGRAM] [--scratch FOLDER]

--small: what `make check` has time for. A run passes that comes to its end with a word for everything that it leaves out.
"""

import argparse
import glob
import os
import resource
import shutil
import subprocess
import sys
import time

from large_decks import KINDS

STACK = 256*1024
LONGEST = 3000  # seconds


def limit():
    resource.setrlimit(resource.RLIMIT_STACK, (STACK, STACK))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(program, deck, scratch, title, size):
    """Runs a deck; whether it came to its end."""
    begun = time.time()
    with open(os.path.join(scratch, "messages"), "w+", encoding="utf-8") as messages:
        process = subprocess.Popen([program, "--quiet", "--threads", "2", "--out", os.path.join(scratch, "out"), deck], preexec_fn=limit,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=messages)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        messages.seek(0)
        said = messages.read()
    good = process.returncode == 0 or process.returncode == 1 and "error: " in said
    print(f"{'ok' if good else 'not ok'} {title:<24}{size:>8}{usage.ru_utime + usage.ru_stime:9.1f} s{usage.ru_maxrss/1024:8.0f} MB"
          + ("" if good else f": status {process.returncode} after {time.time() - begun:.0f} s: {said[:300]}"), flush=True)
    shutil.rmtree(os.path.join(scratch, "out"), ignore_errors=True)
    return good


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--small", action="store_true")
    options.add_argument("--program", default="build/release/flexmech")
    options.add_argument("--scratch", default="build/small_stack")
    options = options.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    good = []
    for title, (make, small, large) in KINDS.items():
        size = small if options.small else large
        cards, rows = make(size)
        for name, lines in (("large.deck", cards), ("t.dat", rows)):
            with open(os.path.join(options.scratch, name), "w", encoding="utf-8") as file:
                file.write("\n".join(lines + [""]))
        good.append(run(options.program, os.path.join(options.scratch, "large.deck"), options.scratch, title, size))
    slow = os.environ.get("SLOW_DECKS", "").split("|") if options.small else []
    for deck in sorted(glob.glob("inputs/*.deck")):
        name = os.path.basename(deck)[:-len(".deck")]
        if name not in slow:
            good.append(run(options.program, deck, options.scratch, f"inputs/{name}", ""))
    if not options.small:
        print(f"{sum(good)} passed, {len(good) - sum(good)} failed")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
