"""The frequencies in quadruple precision that are kept: one line a row of a deck, 22 digits; without any if there are none."""

import glob
import os
from decimal import Decimal

FOLDER = os.path.join("tests", "stress", "references")
MOST_ERROR = Decimal("1e-16")  # largest estimate accepted from the quadruple build, near dead points; 1e-19 and less elsewhere


def load():
    """Frequencies by key of the deck: a list of rows."""
    kept = {}
    for path in sorted(glob.glob(os.path.join(FOLDER, "*.dat"))):
        with open(path, encoding="utf-8") as file:
            for line in file:
                words = line.split()
                if not line.startswith("#"):
                    kept.setdefault(words[0], []).append([Decimal(word) for word in words[1:]])
    return kept


def save(family, entries):
    """The references of a family, in the order of its cases."""
    os.makedirs(FOLDER, exist_ok=True)
    with open(os.path.join(FOLDER, family + ".dat"), "w", encoding="utf-8") as file:
        file.write("# Frequencies [Hz] in quadruple precision, by `make references`: key of the deck, f1, f2 …; one line per row\n")
        for key, rows in entries.items():
            for row in rows or [[]]:
                file.write(" ".join([key] + [f"{value:.21e}" for value in row]) + "\n")
