"""Runs one deck as a user would, and reads its table of frequencies."""

import os
import shutil
import subprocess
from decimal import Decimal

LONGEST = 1800  # seconds


class Row:
    """One speed and crank angle: frequencies with the errors told of them, or the reason why there are none."""

    def __init__(self, place, frequencies=(), errors=(), failure=""):
        self.place, self.frequencies, self.errors, self.failure = place, frequencies, errors, failure


def run_deck(program, deck, folder, name):
    """Exit status, the error messages, and the rows of the table."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name + ".deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(deck)
    run = subprocess.run([program, "--quiet", "--out", folder, path], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                         timeout=LONGEST, check=False)
    table = os.path.join(folder, name, "frequencies.dat")
    rows = read_table(table) if run.returncode in (0, 1) else []
    if run.returncode in (0, 1):
        shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
    os.remove(path)
    return run.returncode, run.stderr, rows


def read_table(path):
    rows = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("# failed "):
                place, failure = line[len("# failed "):].rstrip().split(" : ", 1)
                rows.append(Row(tuple(word.split("=")[1] for word in place.split()), failure=failure))
            elif line.strip() and not line.startswith("#"):
                numbers = [Decimal(word) for word in line.split()]
                modes = (len(numbers) - 2)//2
                rows.append(Row(tuple(numbers[:2]), numbers[2:2 + modes], numbers[2 + modes:]))
    return rows
