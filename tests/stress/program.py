"""Runs one deck as a user would, and reads its table of frequencies."""

import os
import shutil
import subprocess
import threading
from decimal import Decimal

LONGEST = 1800  # seconds


class Row:
    """One speed and crank angle: frequencies with their estimated errors, or the reason why there are none."""

    def __init__(self, place, frequencies=(), errors=(), failure=""):
        self.place, self.frequencies, self.errors, self.failure = place, frequencies, errors, failure


class Run:
    """What came of a deck: exit status (none if it took too long), all messages, rows, processor time [s]."""

    def __init__(self, status, messages, rows, seconds):
        self.status, self.messages, self.rows, self.seconds = status, messages, rows, seconds


def run_deck(program, deck, folder, name):
    """Exit status, the error messages, and the rows of the table."""
    run = timed_run(program, deck, folder, name, ("--quiet",))
    if run.status is None:
        raise TimeoutError(f"{name}: no end after {LONGEST} s")
    return run.status, run.messages, run.rows


def timed_run(program, deck, folder, name, options=(), longest=None):
    """The same, with the processor time of the run; one that exceeds the time limit has no exit status."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path + ".deck", "w", encoding="utf-8") as file:
        file.write(deck)
    with open(path + ".messages", "w", encoding="utf-8") as messages:
        process = subprocess.Popen([program, *options, "--out", folder, path + ".deck"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=messages)
        stopped = threading.Event()
        alarm = threading.Timer(longest or LONGEST, lambda: (stopped.set(), process.kill()))
        alarm.start()
        # The usage of this one child; that of all would mix what runs at a time.
        _, status, usage = os.wait4(process.pid, 0)
        alarm.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    status = None if stopped.is_set() else process.returncode
    with open(path + ".messages", encoding="utf-8", errors="replace") as file:
        messages = file.read()
    rows = read_table(os.path.join(path, "frequencies.dat")) if status in (0, 1) else []
    shutil.rmtree(path, ignore_errors=True)
    os.remove(path + ".messages")
    os.remove(path + ".deck")
    return Run(status, messages, rows, usage.ru_utime + usage.ru_stime)


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
