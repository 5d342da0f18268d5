#!/usr/bin/env python3
"""Computes every reference of the stress test anew with the quadruple build.

    make_references.py RELEASE QUADRUPLE [--missing] [FAMILY ...]

With --missing only what tests/stress/references/ does not have yet. What the release build refuses, or has only failed rows
for, needs no reference.
"""

import argparse
import time
from concurrent.futures import ThreadPoolExecutor

import references
from decks import CONTINUOUS, key
from families import FAMILIES
from program import run_deck

SCRATCH = "build/stress/references"


class Wanted:
    """A deck whose frequencies are wanted, and the cases that ask for it."""

    def __init__(self, deck):
        self.deck, self.cases = deck, []


def wanted_decks(family):
    decks = {}
    for case in FAMILIES[family]():
        for deck in [case.continuous()] + ([case.on_the_mesh()] if case.same_mesh else []):
            decks.setdefault(key(deck), Wanted(deck)).cases.append(case)
    return decks


def is_answered(release, name, wanted):
    """Whether the release build gives a frequency for any of the cases."""
    return any(not row.failure for case in wanted.cases for row in run_deck(release, case.deck(), SCRATCH, name)[2])


def reference(words, name, wanted):
    """The rows of a deck, and what is wrong with them if anything is."""
    if not is_answered(words.release, name, wanted):
        return [], ""
    status, message, rows = run_deck(words.quadruple, wanted.deck, SCRATCH, name)
    if status not in (0, 1):
        return [], (message.splitlines() or [f"exit status {status}"])[0]
    found, fault = [], ""
    for row in rows:
        # On a mesh of its own the table tells mostly what the mesh does.
        told = max(row.errors, default=0) if CONTINUOUS in wanted.deck else 0
        if row.failure or told > references.MOST_ERROR:
            fault = row.failure or f"only exact to {told:.1e}"
        found.append([] if fault else row.frequencies)
    return found, fault


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("release")
    parser.add_argument("quadruple")
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("families", nargs="*")
    words = parser.parse_intermixed_args()
    kept = references.load() if words.missing else {}
    for family in words.families or FAMILIES:
        begun = time.time()
        decks = wanted_decks(family)
        found = {name: kept[name] for name in decks if name in kept}
        missing = [name for name in decks if name not in found]
        with ThreadPoolExecutor(2) as pool:
            for name, (rows, fault) in zip(missing, pool.map(lambda name: reference(words, name, decks[name]), missing)):
                if fault:
                    case = decks[name].cases[0]
                    print(f"{family} {case.parameter} {case.variant}: {fault}", flush=True)
                found[name] = rows
        references.save(family, {name: found[name] for name in decks if name in found})
        print(f"{family}: {len(decks)} decks, {len(missing)} of them new, {time.time() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main()
