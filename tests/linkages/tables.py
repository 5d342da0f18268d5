"""Runs the program and reads its tables."""
import argparse
import os
import shutil
import subprocess
import tempfile


class Table:
    """Rows as dictionaries; text columns stay texts, failed rows are in `failed`, comments in `notes`."""

    def __init__(self, path):
        self.rows, head = [], []
        with open(path, encoding="utf-8") as file:
            lines = [line.rstrip("\n") for line in file]
        self.failed = [line for line in lines if line.startswith("# failed")]
        self.notes = [line[1:].strip() for line in lines if line.startswith("#")]
        for line in lines:  # the head; later variants have notes of their own
            if line.startswith("# failed"):
                continue
            if line.startswith("#"):
                head.append(line[1:].split())
            elif line.strip():
                break
        names, units = (head[-2], head[-1]) if len(head) > 1 and len(head[-2]) == len(head[-1]) else (head[-1], [])
        self.names, self.units = names, dict(zip(names, units))
        for line in lines:
            words = line.split()
            if words and not line.startswith("#"):
                if len(words) != len(names):
                    raise ValueError(f"{path}: {len(words)} columns, {len(names)} names")
                self.rows.append({name: _value(word) for name, word in zip(names, words)})


def _value(word):
    try:
        return float(word)
    except ValueError:
        return word


def new_parser(description, scratch):
    """Options of a test script: the program, and a folder below that of temporary files."""
    options = argparse.ArgumentParser(description=description.split("\n", maxsplit=1)[0])
    options.add_argument("--program", default="build/release/flexmech")
    options.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), scratch))
    return options


def read_options(options):
    """The options given, with the program's absolute path; their folder is new and empty."""
    given = options.parse_args()
    given.program = os.path.abspath(given.program)
    shutil.rmtree(given.scratch, ignore_errors=True)
    os.makedirs(given.scratch)
    return given


def run(program, deck, folder):
    """Tables of a deck by their names; raises RuntimeError with what the program says if there are none."""
    command = [program] if isinstance(program, str) else list(program)
    result = subprocess.run(command + [deck, "--out", folder], capture_output=True, text=True, timeout=600)
    place = os.path.join(folder, os.path.splitext(os.path.basename(deck))[0])
    if result.returncode not in (0, 1) or not os.path.isdir(place):
        message = (result.stderr or result.stdout).strip().splitlines()
        raise RuntimeError(f"exit {result.returncode}: " + (" | ".join(message[:3]) if message else "nothing said"))
    return {name[:-4]: Table(os.path.join(place, name)) for name in sorted(os.listdir(place)) if name.endswith(".dat")}
