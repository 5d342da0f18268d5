#!/usr/bin/env python3
"""Runs the slow families of tests, `make check-all`: a line each, the count at the end.

    check_all.py UNIT_TESTS [WORD ...]     only those with one of the words in their titles; UNIT_TESTS as check.py has it

What a family prints is in build/check-all/TITLE.log. Its last line of the form `N passed, N failed` counts; a family that has none,
or ends with another status than 0 without a failure, has failed. Exit status 1 when anything has.
"""

import os
import re
import subprocess
import sys
import time

PROGRAM = "build/release/flexmech"
SCRATCH = os.path.join("build", "check-all")
PYTHON = [sys.executable, "-B"]
LONGEST = 7200  # seconds

# Title and command; {program} is the release build, {threads} the number of processors.
FAMILIES = [
    ("the rest of make check", "tests/support/check.py --slow {unit_tests}"),
    ("threads", "tests/stress/run_threads.py --runs 200 --seconds 5 --program {program}"),
    ("fuzz", "tests/support/fuzz.py 3000 1"),
    ("fuzz, 256 kB of stack", "tests/support/fuzz.py --release 20000 2"),
    ("large decks, 256 kB of stack", "tests/stress/small_stack.py --program {program}"),
    ("numbers", "tests/stress/read_numbers.py build/release/stress/read_words"),
    ("one folder for several runs", "tests/stress/shared_folder.py --pairs 500 --kills 2000 --resumes 200 --program {program}"),
    ("memory", "tests/support/check_memory.py"),
    ("linkages, known", "tests/linkages/anchors.py --program {program}"),
    ("linkages, random", "tests/linkages/random_linkages.py 1 300 --program {program}"),
    ("linkages in motion", "tests/linkages/random_motions.py 1 300 --program {program}"),
    ("assemblies", "tests/support/assemblies.py 300 1 --program {program}"),
    ("agreement of motions and tables", "tests/linkages/agreement.py 1 300 --program {program}"),
    ("loads", "tests/linkages/random_loads.py 1 400 --program {program}"),
    ("loads in motion", "tests/linkages/random_load_motions.py 1 200 --program {program}"),
    ("vibrations, exact", "tests/linkages/exact_frequencies.py --program {program}"),
    ("vibrations, random", "tests/linkages/random_vibrations.py 1 300 --program {program}"),
    ("vibrations out of the plane", "tests/linkages/grillages.py inputs/response.deck --program {program}"),
    ("vibrations, many links", "tests/linkages/random_vibrations.py 1 16 --kind many --program {program}"),
    ("vibrations, slotted", "tests/linkages/random_vibrations.py 1 60 --kind slotted --program {program}"),
    ("described otherwise", "tests/linkages/metamorphic.py 1 300 --program {program}"),
    ("links without mass", "tests/linkages/massless.py 1 300 --program {program}"),
    ("welded sections", "tests/linkages/welded_sections.py 1 30 --program {program}"),
    ("bodies in equilibrium", "tests/linkages/force_tables.py 1 300 --inputs inputs --program {program}"),
    ("rigid tables", "tests/linkages/rigid_tables.py 1 300 --program {program}"),
    ("drives of measures", "tests/linkages/measured_drives.py 1 150 --program {program}"),
    ("five-bars with two laws", "tests/linkages/led_five_bars.py 1 40 --program {program}"),
    ("estimates of responses", "tests/stress/estimates_response.py 1 300 --program {program}"),
    ("estimates of validity", "tests/stress/estimates_response.py 1 200 --validity --program {program}"),
    ("estimates of transients", "tests/stress/estimates_transient.py 1 60 --program {program}"),
    ("estimates of running linkages", "tests/stress/estimates_running.py 1 400 --program {program}"),
    ("accuracies", "tests/stress/compare_accuracies.py {program} --frequencies 20000 --seed 1"),
    ("reports together", "tests/stress/report_sets.py 1 150 --program build/debug/flexmech"),
    ("stress", "tests/stress/run_stress.py {program} --every 4 --no-figures"),
    ("stress of responses", "build/release/stress/responses 420 {threads} build/check-all/responses.dat 1"),
    ("intervals of instability", "tests/intervals/random_intervals.py 1 200 --program {program}"),
    ("stress of stability", "build/release/stress/stability 10 25 {threads} 1"),
]


def run(title, command, unit_tests):
    """Passed and failed cases of a family."""
    words = command.format(program=PROGRAM, threads=os.cpu_count(), unit_tests=unit_tests).split()
    log = os.path.join(SCRATCH, re.sub(r"\W+", "_", title) + ".log")
    begun = time.time()
    with open(log, "w", encoding="utf-8") as file:
        try:
            status = subprocess.run((PYTHON if words[0].endswith(".py") else []) + words, stdin=subprocess.DEVNULL, stdout=file,
                                    stderr=subprocess.STDOUT, timeout=LONGEST, check=False).returncode
        except (OSError, subprocess.TimeoutExpired) as failure:
            status = -1
            file.write(f"{failure}\n")
    with open(log, encoding="utf-8", errors="replace") as file:
        counts = re.findall(r"(\d+) passed, +(\d+) failed", file.read())
    passed, failed = (int(number) for number in counts[-1]) if counts else (0, 0)
    wrong = status != 0 and failed == 0 or not counts
    failed += wrong
    print(f"{title:<32}{passed:7d} passed, {failed:3d} failed {time.time() - begun:7.0f} s"
          + (f"   status {status}, see {log}" if wrong else f"   see {log}" if failed else ""), flush=True)
    return passed, failed


def main(unit_tests, *words):
    os.makedirs(SCRATCH, exist_ok=True)
    counts = [run(title, command, unit_tests) for title, command in FAMILIES if not words or any(word in title for word in words)]
    passed, failed = (sum(one[i] for one in counts) for i in (0, 1))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
