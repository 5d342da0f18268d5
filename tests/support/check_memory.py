#!/usr/bin/env python3
"""Runs every deck of inputs/ under the sanitizers (`make memory` builds the program with them): zero reports are wanted.

With one thread and with three; and some refused decks, which end elsewhere. Exit status 1 when there is a report.
"""

import os
import shutil
import subprocess
import sys
from glob import glob

PROGRAM = os.path.join("build", "sanitize", "flexmech")
SCRATCH = os.path.join("build", "memory")
REPORT_STATUS = 99
MOST_SECONDS = 3600


def reports_of(words):
    """What the sanitizers say of a run; empty if nothing."""
    environment = dict(os.environ, ASAN_OPTIONS=f"exitcode={REPORT_STATUS}:detect_stack_use_after_return=1",
                       LSAN_OPTIONS=f"exitcode={REPORT_STATUS}", UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1")
    run = subprocess.run([PROGRAM, "--out", SCRATCH] + words, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                         errors="replace", timeout=MOST_SECONDS, env=environment, check=False)
    if run.returncode in (0, 1, 2) and "Sanitizer" not in run.stderr and "runtime error" not in run.stderr:
        return ""
    return f"status {run.returncode}\n{run.stderr.strip()}"


def main():
    shutil.rmtree(SCRATCH, ignore_errors=True)
    decks = sorted(glob(os.path.join("inputs", "*.deck")))
    runs = [["--quiet", deck] for deck in decks] + [["--stats", "--threads", "3", deck] for deck in decks]
    runs += [decks, ["--check"] + decks] + [[deck] for deck in sorted(glob(os.path.join("tests", "decks", "*.deck")))]
    failed = 0
    for words in runs:
        reports = reports_of(words)
        if reports:
            failed += 1
            print(f"not ok {PROGRAM} {' '.join(words)}: {reports}", flush=True)
    print(f"{len(runs) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
