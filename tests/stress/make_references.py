#!/usr/bin/env python3
"""Computes every reference of the stress test anew with the quadruple build.

    make_references.py RELEASE QUADRUPLE [--missing] [--at-once N] [--longest SECONDS] [FAMILY ...]

With --missing only what tests/stress/references/ does not have yet. N decks at once (2). A deck that takes quadruple precision
longer than SECONDS (1800) is named and left out. What the release build refuses, or has only failed rows for, needs no reference.
"""

import argparse
import time
from concurrent.futures import ThreadPoolExecutor

import references
from decks import CONTINUOUS, key
from families import FAMILIES
from program import LONGEST, run_deck, timed_run
from verdicts import FAILED

SCRATCH = "build/stress/references"


class Wanted:
    """A deck whose frequencies are wanted, and the cases that ask for it."""

    def __init__(self, deck):
        self.deck, self.cases = deck, []


def wanted_decks(family):
    decks = {}
    for case in FAMILIES[family]():
        if case.wanted == FAILED:
            continue
        for deck in [case.continuous()] + ([case.on_the_mesh()] if case.same_mesh else []):
            decks.setdefault(key(deck), Wanted(deck)).cases.append(case)
    return decks


def is_answered(release, name, wanted):
    """Whether the release build gives a frequency for any of the cases."""
    return any(not row.failure for case in wanted.cases for row in run_deck(release, case.deck(), SCRATCH, name)[2])


def reference(words, name, wanted):
    """The rows of a deck, None if it took too long, and what is wrong with them if anything is."""
    if not is_answered(words.release, name, wanted):
        return [], ""
    run = timed_run(words.quadruple, wanted.deck, SCRATCH, name, ("--quiet",), words.longest)
    if run.status is None:
        return None, f"left out: not finished after {words.longest} s"
    if run.status not in (0, 1):
        return [], (run.messages.splitlines() or [f"exit status {run.status}"])[0]
    found, fault = [], ""
    for row in run.rows:
        # On a mesh of its own the table tells mostly what the mesh does.
        estimate = max(row.errors, default=0) if CONTINUOUS in wanted.deck else 0
        unfit = row.failure or (f"only exact to {estimate:.1e}" if estimate > references.MOST_ERROR else "")
        found.append([] if unfit else row.frequencies)
        fault = fault or unfit
    return found, fault


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("release")
    parser.add_argument("quadruple")
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("--at-once", type=int, default=2)
    parser.add_argument("--longest", type=float, default=LONGEST)
    parser.add_argument("families", nargs="*")
    words = parser.parse_intermixed_args()
    kept = references.load() if words.missing else {}
    for family in words.families or FAMILIES:
        begun = time.time()
        decks = wanted_decks(family)
        found = {name: kept[name] for name in decks if name in kept}
        missing = [name for name in decks if name not in found]
        with ThreadPoolExecutor(words.at_once) as pool:
            for name, (rows, fault) in zip(missing, pool.map(lambda name: reference(words, name, decks[name]), missing)):
                if fault:
                    case = decks[name].cases[0]
                    print(f"{family} {case.parameter} {case.variant}: {fault}", flush=True)
                if rows is not None:
                    found[name] = rows
        references.save(family, {name: found[name] for name in decks if name in found})
        print(f"{family}: {len(decks)} decks, {len(missing)} of them new, {time.time() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main()
