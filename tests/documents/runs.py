"""Runs of the program, and their tables by the names of the columns."""

import csv
import json
import os
import re
import subprocess
import tempfile

# Factors to the units in which documents print; the program writes those of the deck.
UNITS = {"rad/s": 1, "rpm": 0.10471975511965978, "deg": 1, "Hz": 1, "": 1, "s": 1, "ms": 1e-3, "mm": 1, "m": 1000}


class Run:
    """One run of a deck, which may end with status 1 if its rows may fail."""

    def __init__(self, program, deck, options=()):
        with tempfile.TemporaryDirectory() as folder:
            self.status, self.errors = self._call([program, "--out", folder, "--format", "csv", *options, "-"], deck)
            found = os.path.join(folder, "stdin")
            self.files = {name: self._read(os.path.join(found, name)) for name in os.listdir(found)} if os.path.isdir(found) else {}

    def _call(self, command, deck):
        done = subprocess.run(command, input=deck, capture_output=True, text=True, timeout=300, check=False)
        return done.returncode, done.stderr

    @staticmethod
    def _read(path):
        with open(path, encoding="utf-8", newline="") as file:
            return file.read()

    @property
    def log(self):
        return self.files["run.log"]

    @property
    def summary(self):
        return json.loads(self.files["summary.json"])

    def rows(self, table):
        """The rows of a table that did not fail, each a dictionary of values in the units above; texts stay texts."""
        if f"{table}.csv" not in self.files:
            raise RuntimeError(f"there is no {table}.csv; the program said: {self.errors.strip()}")
        lines = list(csv.reader(self.files[f"{table}.csv"].splitlines()))
        names, factors = [], []
        for head in lines[0]:
            name, _, unit = head.partition(" [")
            names.append(name)
            factors.append(UNITS.get(unit.rstrip("]"), None))
        rows = []
        for line in lines[1:]:
            row = dict(zip(names, line))
            if row.get("failure"):
                continue
            for name, factor in zip(names, factors):
                try:
                    row[name] = float(row[name])*(1 if factor is None else factor)
                except ValueError:
                    pass
            rows.append(row)
        return rows


def deck(name, *changes):
    """A deck of inputs/ with changes, each (pattern, replacement) of a regular expression for lines, as sed would do them."""
    with open(os.path.join("inputs", name + ".deck"), encoding="utf-8") as file:
        text = file.read()
    for pattern, replacement in changes:
        text, number = re.subn(pattern, replacement, text, flags=re.MULTILINE)
        if not number:
            raise ValueError(f"inputs/{name}.deck has no {pattern}")
    return text


def largest(rows, column):
    return max(abs(row[column]) for row in rows)
