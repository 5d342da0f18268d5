#!/usr/bin/env python3
"""Computes every reference of the stress test anew with the quadruple build.

    make_references.py PROGRAM [--missing] [FAMILY ...]

With --missing only what tests/stress/references/ does not have yet.
"""

import sys
import time
from concurrent.futures import ThreadPoolExecutor

import references
from decks import key
from families import FAMILIES
from program import run_deck

SCRATCH = "build/stress/references"


def reference(program, deck, name):
    """The rows of a deck, and what is wrong with them if anything is."""
    status, message, rows = run_deck(program, deck, SCRATCH, name)
    bad = [row.failure for row in rows if row.failure]
    if status == 2 or bad:
        return [], (bad or message.splitlines())[0]
    told = max(max(row.errors) for row in rows)
    if told > references.MOST_ERROR:
        return [], f"only exact to {told:.1e}"
    return [row.frequencies for row in rows], ""


def decks_of(family):
    decks = {}
    for case in FAMILIES[family]():
        for deck in [case.continuous()] + ([case.on_the_mesh()] if case.same_mesh else []):
            decks[key(deck)] = (deck, f"{case.family} {case.parameter} {case.variant}")
    return decks


def main(program, words):
    families = [word for word in words if not word.startswith("-")] or list(FAMILIES)
    kept = references.load() if "--missing" in words else {}
    for family in families:
        begun = time.time()
        decks = decks_of(family)
        found = {name: kept[name] for name in decks if name in kept}
        with ThreadPoolExecutor(2) as pool:
            wanted = [name for name in decks if name not in found]
            for name, (rows, fault) in zip(wanted, pool.map(lambda name: reference(program, decks[name][0], name), wanted)):
                if fault:
                    print(f"no reference for {decks[name][1]}: {fault}", flush=True)
                else:
                    found[name] = rows
        references.save(family, {name: found[name] for name in decks if name in found})
        print(f"{family}: {len(found)} of {len(decks)} references, {time.time() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
