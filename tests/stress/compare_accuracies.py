#!/usr/bin/env python3
"""Checks what accuracy= promises: random decks at several accuracies, every frequency against the same at the finest.

    compare_accuracies.py PROGRAM [--frequencies N] [--seed S] [--kinds KIND,…] [--decks NUMBER,…] [--accuracies A,…]
                          [--quad PROGRAM] [--every N] [--at-once N] [--longest SECONDS] [--out FOLDER]

A frequency is a defect if it is farther from its reference than both tell together. Decks are made until N different frequencies
(100000) have been compared. With --quad the reference is the quadruple build at accuracy=1e-21, for one deck in --every (9), at its
first two crank angles. --decks takes numbers of decks, as in their names. Tables come into outputs/accuracies/, with the decks of
defects; the last line printed is the count; exit status 1 on a defect.
"""

import argparse
import os
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal

from accuracy_decks import KINDS, random_deck
from accuracy_tables import Ratios, Reasons, Times
from program import timed_run
from verdicts import relative_error

ACCURACIES = "1e-2,1e-5,1e-8,1e-11,1e-13"
QUADRUPLE = "1e-21"
CLEARLY = 10  # times the estimated error of the reference: from there on the difference is the true error


class Comparison:
    """All that comes of all decks."""

    def __init__(self, folder):
        self.folder = folder
        self.decks = self.frequencies = self.comparisons = self.defects = 0
        self.ratios, self.times = Ratios(), Times()
        self.missed = Reasons("decks that miss their accuracy=")
        self.refused = Reasons("refused decks")
        self.failed = Reasons("failed rows")
        self.slow = Reasons("runs that were stopped")

    def defect(self, deck, texts, line):
        """Keeps both decks, so that they can be run again."""
        self.defects += 1
        print(f"defect: {deck.name} {line}", flush=True)
        os.makedirs(os.path.join(self.folder, "defects"), exist_ok=True)
        for accuracy, text in texts:
            with open(os.path.join(self.folder, "defects", f"{deck.name}_{accuracy}.deck"), "w", encoding="utf-8") as file:
                file.write(text)
        with open(os.path.join(self.folder, "defects.dat"), "a", encoding="utf-8") as file:
            file.write(f"{deck.name} {line}\n")

    def lines(self):
        for table in (self.ratios, self.missed, self.failed, self.refused, self.slow, self.times):
            yield from table.lines()
            yield ""


def place_of(row):
    return tuple(f"{float(value):.9g}" for value in row.place)


def one_deck(words, folder, deck):
    """The runs of a deck, the reference last: accuracy, deck, run."""
    accuracies = words.accuracies.split(",")
    decks = [(words.program, accuracy, deck.text(accuracy, deck.cranks[:2] if words.quad else None)) for accuracy in accuracies]
    if words.quad:
        decks.append((words.quad, QUADRUPLE, deck.text(QUADRUPLE, deck.cranks[:2])))
    return deck, [(accuracy, text, timed_run(program, text, folder, f"{deck.name}_{accuracy}", (), words.longest))
                  for program, accuracy, text in decks]


def judge_deck(found, deck, runs):
    """Adds a deck to all that was found."""
    found.decks += 1
    reference = runs[-1]
    for accuracy, text, run in runs:
        judge_run(found, deck, accuracy, text, run, accuracy == QUADRUPLE)
    exact = {place_of(row): row for row in reference[2].rows if not row.failure}
    found.frequencies += sum(len(row.frequencies) for row in exact.values())
    for accuracy, text, run in runs[:-1]:
        for row in run.rows:
            if not row.failure and place_of(row) in exact:
                judge_row(found, deck, [(accuracy, text), reference[:2]], row, exact[place_of(row)])


def judge_run(found, deck, accuracy, text, run, is_reference):
    """Exit status, time, failed rows, and whether the accuracy was kept."""
    if run.status is None:
        found.slow.add(deck.kind, deck.name, f"{accuracy}: ")
    elif run.status == 2 and run.messages.strip():
        refusal = next((line for line in run.messages.splitlines() if "error: " in line), run.messages)
        found.refused.add(refusal.split("error: ", 1)[-1], deck.name)
    elif run.status not in (0, 1) or (run.status == 1) != any(row.failure for row in run.rows):
        last = (run.messages.splitlines() or [""])[-1]
        found.defect(deck, [(accuracy, text)], f"accuracy={accuracy} exit status {run.status}, {len(run.rows)} rows: {last}")
    if is_reference:
        return
    found.times.add(deck, accuracy, len(run.rows), run.seconds)
    for row in run.rows:
        if row.failure:
            found.failed.add(row.failure, deck.name)
    if any(error > Decimal(accuracy) for row in run.rows for error in row.errors):
        # The words after the places are the reason.
        reasons = [line.split("warning: ", 1)[1] for line in run.messages.splitlines()
                   if "warning: " in line and "accuracy" in line and "not reached" in line]
        reason = reasons[0] if reasons else "the program does not say so"
        found.missed.add(reason, deck.name, f"{accuracy}: ")
        if not reasons:
            found.defect(deck, [(accuracy, text)], f"accuracy={accuracy} is not kept, and no warning says so")


def judge_row(found, deck, texts, row, exact):
    for mode, (value, estimate) in enumerate(zip(row.frequencies, row.errors)):
        right, right_estimate = exact.frequencies[mode], exact.errors[mode]
        true = relative_error(value, right)
        found.comparisons += 1
        if true > estimate + right_estimate:
            found.defect(deck, texts, f"accuracy={texts[0][0]} speed={place_of(row)[0]} crank={place_of(row)[1]} mode {mode + 1}: "
                         f"{value} against {right}, off by {true:.2e}, estimated {estimate:.2e} and {right_estimate:.2e}")
        if true > CLEARLY*right_estimate and true > 0:
            found.ratios.add(deck.kind, estimate, true)


def wanted_decks(words):
    """All decks in their order, without end, or those that were named."""
    if words.decks:
        yield from (random_deck(words.seed, int(number)) for number in words.decks.split(","))
        return
    kinds = words.kinds.split(",") if words.kinds else list(KINDS)
    number = 0
    while True:
        number += words.every if words.quad else 1
        deck = random_deck(words.seed, number)
        if deck.kind in kinds:
            yield deck


def compare_all(words, found):
    """As many decks at once as wanted; one that is done makes room for the next, and they are judged in their order."""
    folder = os.path.join(words.out, "runs")
    decks, running, printed = wanted_decks(words), [], 0
    with ThreadPoolExecutor(words.at_once) as pool:
        while True:
            while len(running) < 4*words.at_once and (deck := next(decks, None)):
                running.append(pool.submit(one_deck, words, folder, deck))
            if not running:
                return
            judge_deck(found, *running.pop(0).result())
            if found.frequencies >= printed + words.frequencies/20:
                printed = found.frequencies
                print(f"{found.decks} decks, {found.frequencies} frequencies, {found.defects} defects", flush=True)
            if found.frequencies >= words.frequencies:
                for job in running:
                    job.cancel()
                return


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--frequencies", type=int, default=100000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default="")
    parser.add_argument("--decks", default="")
    parser.add_argument("--accuracies", default=ACCURACIES)
    parser.add_argument("--quad", default="")
    parser.add_argument("--every", type=int, default=9)
    parser.add_argument("--at-once", type=int, default=2)
    parser.add_argument("--longest", type=float, default=120)
    parser.add_argument("--out", default=os.path.join("outputs", "accuracies"))
    words = parser.parse_args()
    if set(filter(None, words.kinds.split(","))) - set(KINDS):
        parser.error(f"kinds are {', '.join(KINDS)}")
    return words


def main():
    words = arguments()
    shutil.rmtree(words.out, ignore_errors=True)
    os.makedirs(words.out)
    found = Comparison(words.out)
    compare_all(words, found)
    shutil.rmtree(os.path.join(words.out, "runs"), ignore_errors=True)
    tables = "\n".join(found.lines())
    with open(os.path.join(words.out, "tables.dat"), "w", encoding="utf-8") as file:
        file.write(tables)
    print(tables)
    print(f"{found.frequencies} frequencies of {found.decks} decks, {found.comparisons} comparisons (seed {words.seed}): "
          f"{found.defects} defects")
    print(f"{found.comparisons - found.defects} passed, {found.defects} failed")
    return 1 if found.defects else 0


if __name__ == "__main__":
    sys.exit(main())
