#!/usr/bin/env python3
"""Runs the program on thousands of odd decks, tables and command lines, and looks at how it ends and at what it leaves behind.

    fuzz.py [--release] [COUNT [SEED]]     10,000 decks of seed 1 by default, with the debug build

Time, memory and the stack of every run are limited, the stack of the release build to 256 kB, also in its threads.
The same seed makes the same decks on any machine. A deck that fails is kept in build/fuzz/ with the reason beside it.
Exit status 1 when one has failed.
"""

import csv
import functools
import io
import itertools
import json
import multiprocessing
import os
import re
import resource
import shutil
import subprocess
import sys
from collections import Counter

import fuzz_decks
from deck_language import language
from fuzz_decks import Dice, LENGTHS

FAILED = os.path.join("build", "fuzz")
PROGRAMS = {kind: os.path.join("build", kind, "flexmech") for kind in ("debug", "release")}
MOST_STACK = {"debug": 2**20, "release": 2**18}
MOST_SECONDS = 100            # of processor time; a deck takes 20 ms as a rule, and the machine may be slow
SHORT_SECONDS = 10            # of one with a motion, which may run away: as many steps as it has turns are no fault; and of many decks
MOST_MEMORY = 4*2**30         # of a run; more is a request that the program should have refused
ECHO_EVERY = 12               # decks that come through: run the echo, and with two threads, of one in so many

# The command line. Each entry: its words, and whether a sound deck is still run to its tables; DECK is the deck's path.
OPTIONS = [
    (["--quiet", "DECK"], True), (["--stats", "DECK"], True), (["--threads", "2", "DECK"], True), (["--threads=3", "DECK"], True),
    (["DECK", "--quiet", "--stats"], True), (["--", "DECK"], True), (["--check", "DECK"], False), (["--help", "DECK"], False),
    (["--version"], False), (["DECK", "DECK"], False), (["DECK", "missing.deck"], False), (["--threads", "0", "DECK"], False),
    (["--threads", "DECK"], False), (["--threads=1e99", "DECK"], False), (["--theads", "2", "DECK"], False), (["--out"], False),
    (["--out=", "DECK"], False), ([], False), ([""], False), (["."], False), (["-", "-"], False), (["--quiet=1", "DECK"], False),
    (["--format", "csv", "DECK"], True), (["--format=csv", "--json", "DECK"], True), (["--format", "cvs", "DECK"], False),
    (["--resume", "DECK"], True), (["--json", "DECK"], True), (["--set", "nobody=1", "DECK"], False), (["--set", "=", "DECK"], False),
]

RUN_TIME = re.compile(r"Fortran runtime|Backtrace|SIG[A-Z]{3}|At line \d+ of file|Sanitizer|free\(\)|malloc|double free|stack smash")
# A response of a whole turn fails at a speed, without a position; intervals of stability in a range of speeds; a variant whole.
FAILURE = re.compile(r"^d\.deck: error: (.*(crank (\S+ to )?\S+ (deg|" + "|".join(LENGTHS) + r")(, \d+ positions)?|, speeds? (\S+ to )?\S+ (rad/s|rpm))|\S+=\S+( \S+=\S+)*): .",
                     re.MULTILINE)
NOT_A_NUMBER = re.compile(r"\b(?:NaN|[-+]?Inf(?:inity)?)\b|\*{4,}|is not a number$")
NUMBER = re.compile(r"-?(0|[1-9]\d*)(\.\d+)?(e[-+]\d{2,3})?$")
PLACE = re.compile(r"(?P<deck>.*?):(?P<line>\d+):(?P<column>\d+): (?:error|warning|note): .")
# Columns of words; and `branch`, but for branches.dat.
WORDS = {"link", "event", "point", "gauge", "linkage", "quantity", "kind", "modes", "verdict", "pin", "drive", "part", "unit", "joint", "coordinate",
         "place"}
GAPS = {"quadratic", "out_of_plane", "distance"}  # of validity.dat: - where nothing is estimated
OTHERS = {"echo.deck", "run.log", "summary.json"}
# What a deck may include.
EARLIER = '{"program": "flexmech", "deck": "d", "tables": [{"file": "mesh.dat"}]}\n'
PART = b"MATERIAL brass E=100e9Pa density=8500kg/m3 nu=0.35\nSET half 0.5\n"


def limits(seconds, stack):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_STACK, (stack, stack))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def execute(program, words, folder, seconds=MOST_SECONDS):
    stack = MOST_STACK[os.path.basename(os.path.dirname(program))]
    return subprocess.run([program] + words, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False,
                          preexec_fn=functools.partial(limits, seconds, stack))


def tree(folder):
    """Everything below a folder, with the contents of the files."""
    found = {}
    for path, folders, files in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(path, name), folder)] = None
        for name in files:
            with open(os.path.join(path, name), "rb") as file:
                found[os.path.relpath(os.path.join(path, name), folder)] = file.read()
    return found


def fault_of_message(names_deck, stderr):
    """What is wrong with what a refusal says."""
    if not stderr.strip():
        return "refused without a word"
    lines = stderr.split("\n")
    for i, line in enumerate(lines):
        place = PLACE.match(line)
        if not place or "does not belong in a text" in line:
            continue
        missing = i + 1 == len(lines) or " | " not in lines[i + 1]
        # Something missing from the deck has no word to point at.
        if missing and place["column"] != "1":
            return f"no text of the deck below: {line}"
        if not missing and not re.match(r" *\| *\^+$", lines[i + 2] if i + 2 < len(lines) else ""):
            return f"no caret below: {line}"
    if not any(re.match(r"flexmech: error: .", line) or re.match(r".*: error: .", line) for line in lines):
        return f"no error is reported: {stderr[:200]}"
    if names_deck and not re.search(r"^(?:d\.deck|part\.deck|missing\.deck|t\.dat|<command line>|flexmech):", stderr, re.MULTILINE):
        return "the deck is not named"
    return None


def fault_of_table(name, text):
    """Rows of as many cells as there are columns, every number a number."""
    lines = text.split("\n")
    head = list(itertools.takewhile(lambda line: line.startswith("#") and not line.startswith("# failed"), lines))
    names, units = head[-2][1:].split(), head[-1][1:].split()
    if len(names) != len(units):
        return f"{name}: {len(names)} columns and {len(units)} units"
    for line in lines:
        if line.startswith("# failed") and NOT_A_NUMBER.search(line):
            return f"{name}: {line}"
        if line.startswith("#") or not line:
            continue
        cells = line.split()
        if len(cells) != len(names):
            return f"{name}: {len(names)} columns, and a row of {len(cells)}: {line}"
        for column, cell in zip(names, cells):
            if column in WORDS or (column == "branch" and cell in ("open", "crossed")):
                continue
            if column in GAPS and cell == "-":
                continue
            if not NUMBER.match(cell):
                return f"{name}: {column} is {cell}"
    return None


def fault_of_files(files, deck):
    """What is wrong with the files of a run that came through."""
    lacking = OTHERS - set(files)
    if lacking:
        return f"there is no {' '.join(sorted(lacking))}"
    as_csv = {name[:-4] + ".dat" for name in files if name.endswith(".csv")}
    tables = set(language().tables)
    strange = {name for name in set(files) - tables - OTHERS if not name.endswith(".csv")}
    if strange or not tables & set(files) or as_csv - set(files):
        return f"the files are {' '.join(sorted(files))}"
    for name, content in files.items():
        text = content.decode("utf-8", "replace")
        if name in language().tables:
            fault = fault_of_table(name, text)
            if fault:
                return fault
        elif name == "summary.json":
            json.loads(text, parse_constant=int)  # NaN and Infinity are no integers either
        elif name.endswith(".csv"):
            rows = list(csv.reader(io.StringIO(text, newline="")))
            if any(len(row) != len(rows[0]) for row in rows):
                return f"{name}: rows of different lengths"
        else:
            for line in text.split("\n"):
                odd = NOT_A_NUMBER.search(line)
                if odd and odd[0] not in deck:
                    return f"{name}: {line}"
    return None


def fault_of_run(names_deck, run, deck):
    """What is wrong with how a run ended. `names_deck`: a refusal has to."""
    stderr = run.stderr.decode("utf-8", "replace")
    if run.returncode not in (0, 1, 2):
        return f"ended with status {run.returncode}: {stderr[-400:]}"
    told = "\n".join(line for line in stderr.split("\n") if " | " not in line)
    trouble = RUN_TIME.search(told)
    if trouble and trouble[0] not in deck:
        return f"a runtime error: {stderr[-400:]}"
    if run.returncode == 2:
        return fault_of_message(names_deck, stderr)
    if run.returncode == 1 and not FAILURE.search(stderr):
        return f"status 1, but no failure is reported: {stderr[-400:]}"
    return None


def fault_of_again(program, folder, status, files):
    """The echo of a deck, and two threads, give the same tables."""
    with open(os.path.join(folder, "echo.deck"), "wb") as echo:
        echo.write(files["echo.deck"])
    for words, out in ((["--quiet", "--out", "echoed", "echo.deck"], "echoed/echo"),
                       (["--quiet", "--threads", "2", "--out", "threads", "d.deck"], "threads/d")):
        run = execute(program, words, folder)
        if run.returncode != status:
            return f"{' '.join(words)} ended with status {run.returncode}, not {status}: {run.stderr[-400:].decode('utf-8', 'replace')}"
        again = tree(os.path.join(folder, out))
        for name in sorted(set(files) | set(again)):
            if name in language().tables and files.get(name) != again.get(name):
                return f"{' '.join(words)} gives another {name}"
    return None


def fault_of_deck(program, folder, words, sound_words, text, table, again):
    """Runs one deck in an empty folder; its status and what is wrong. `sound_words`: None if nobody knows."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name, content in (("d.deck", text), ("part.deck", PART), ("t.dat", table)):
        with open(os.path.join(folder, name), "wb") as deck:
            deck.write(content)
    if len(text) % 2:  # results of an earlier run
        os.makedirs(os.path.join(folder, "outputs", "d"))
        for name, content in (("mesh.dat", "old\n"), ("notes.txt", "mine\n"), ("summary.json", EARLIER)):
            with open(os.path.join(folder, "outputs", "d", name), "w", encoding="ascii") as earlier:
                earlier.write(content)
    before = tree(folder)
    deck = text.decode("utf-8", "replace")
    short = "motion" in deck.lower() or "release" in program
    run = execute(program, [word.replace("DECK", "d.deck") for word in words], folder, SHORT_SECONDS if short else MOST_SECONDS)
    if short and run.returncode == 130 and b"interrupted" in run.stderr:  # at the limit of time
        return run.returncode, None
    fault = fault_of_run("DECK" in words and sound_words is not None, run, deck)
    after = tree(folder)
    if not fault and (run.returncode == 2 or sound_words is False) and after != before:
        fault = f"nothing was to be written, but now there are {' '.join(sorted(set(after) - set(before)))} (or changes)"
    elif not fault and sound_words and run.returncode < 2:
        if after.pop(os.path.join("outputs", "d", "notes.txt"), b"mine\n") != b"mine\n":
            fault = "a file of somebody else was changed"
        folder_of = os.path.join("outputs", "d") + os.sep
        files = {name[len(folder_of):]: content for name, content in after.items() if name.startswith(folder_of)}
        fault = fault or fault_of_files(files, deck)
        if not fault and again:
            fault = fault_of_again(program, folder, run.returncode, files)
    return run.returncode, fault


def one(number, seed, program, decks, scratch):
    """Makes and runs deck number so and so."""
    dice = Dice(seed*1000003 + number)
    kind, text = fuzz_decks.made_deck(dice, decks)
    table = fuzz_decks.table(dice)
    words, sound_words = ["DECK"], True
    if dice.chance(0.12):
        words, sound_words = dice.choice(OPTIONS)
    elif dice.chance(0.12):
        words, sound_words = fuzz_decks.words_of_command(dice), None
    folder = os.path.join(scratch, str(os.getpid()))
    status, fault = fault_of_deck(program, folder, words, sound_words, text, table, number % ECHO_EVERY == 0)
    if fault:
        name = f"seed_{seed}_{number}"
        os.makedirs(FAILED, exist_ok=True)
        with open(os.path.join(FAILED, name + ".deck"), "wb") as deck:
            deck.write(text)
        with open(os.path.join(FAILED, name + ".dat"), "wb") as file:
            file.write(table)
        fault = f"{FAILED}/{name}.deck ({kind}; flexmech {' '.join(words)}): {fault}"
        with open(os.path.join(FAILED, name + ".txt"), "w", encoding="utf-8") as reason:
            reason.write(fault + "\n")
    return kind, status, fault


def fuzz(kind, count, seed, told):
    """Runs so many decks; `told` hears of every fault. The number of decks by kind and exit status."""
    shutil.rmtree(FAILED, ignore_errors=True)
    scratch = os.path.abspath(os.path.join(FAILED, "scratch"))
    os.makedirs(scratch)
    work = functools.partial(one, seed=seed, program=os.path.abspath(PROGRAMS[kind]), decks=fuzz_decks.sources(), scratch=scratch)
    counts = Counter()
    with multiprocessing.Pool() as pool:
        for kind, status, fault in pool.imap_unordered(work, range(1, count + 1), chunksize=8):
            counts[kind, status] += 1
            if fault:
                told(fault)
    shutil.rmtree(scratch)
    return counts


def main(words):
    kind = "release" if "--release" in words else "debug"
    words = [word for word in words if word != "--release"]
    count, seed = (int(word) for word in (words + ["10000", "1"][len(words):])[:2])
    faults = []

    def told(fault):
        faults.append(fault)
        print(f"not ok {fault}", flush=True)

    counts = fuzz(kind, count, seed, told)
    kinds = sorted({kind for kind, _ in counts})
    print(f"{'decks of seed ' + str(seed):<20}{'done':>8}{'rows failed':>13}{'refused':>9}")
    for kind in kinds + ["all"]:
        of_kind = [sum(number for (its, status), number in counts.items() if status == wanted and kind in (its, "all"))
                   for wanted in (0, 1, 2)]
        print(f"{kind:<20}{of_kind[0]:8d}{of_kind[1]:13d}{of_kind[2]:9d}")
    print(f"{count - len(faults)} passed, {len(faults)} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
