"""The decks, messages and commands that the documents show: the program takes them, and says what is shown."""

import os
import re
import subprocess
import tempfile
from glob import glob

from deck_language import language
from runs import Run


def blocks(text):
    """The indented blocks of a document, without their indentation."""
    found, block = [], []
    for line in text.split("\n") + ["end"]:
        if line.startswith("    "):
            block.append(line[4:])
        elif line.strip() or not block:
            if block:
                found.append("\n".join(block).rstrip())
            block = []
        else:
            block.append("")
    return found


def block_with(text, words):
    return next(block for block in blocks(text) if words in block)


def said(program, files, deck):
    """What the program says of a deck, in a folder with these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        return subprocess.run([program, "--check", deck], cwd=folder, capture_output=True, text=True, check=False).stderr


def deck_of_readme(program, texts):
    deck = block_with(texts["README.md"], "TITLE ")
    run = Run(program, deck)
    if run.status != 0 or len(run.rows("frequencies")) != 73:
        yield f"it ends with status {run.status}: {run.errors}"
    message = block_with(texts["README.md"], "error:")
    number, line = re.search(r"^ *(\d+) \| (.*)$", message, re.MULTILINE).groups()
    lines = deck.split("\n")
    if line.replace("steal", "steel").split() != lines[int(number) - 1].split():
        yield f"line {number} is not the one that its message shows"
    lines[int(number) - 1] = line
    found = said(program, {"my.deck": "\n".join(lines)}, "my.deck")
    if not found.startswith(message):
        yield f"the message is now\n{found}"


def worked_deck(program, texts):
    text = texts["docs/cards.md"]
    run = Run(program, block_with(text, "TITLE "))
    if run.status != 0:
        yield f"it ends with status {run.status}: {run.errors}"
        return
    rows = {name: run.rows(name) for name in ("frequencies", "shapes")}
    counts = (len({row["speed"] for row in rows["frequencies"]}), len(rows["frequencies"])/3,
              *(len({row[name] for row in rows["shapes"]}) for name in ("mode", "crank", "speed")))
    if counts != (3, 73, 3, 3, 3):
        yield f"speeds, rows of each, modes, positions and speeds of shapes are {counts}"
    written = re.findall(r"`(\w+\.(?:dat|deck|log|json))`", text.partition("`flexmech my.deck` writes")[2].partition("\n\n")[0])
    if not written:
        yield "nothing is said of its files"
    yield from (f"there is no {name}" for name in written if name not in run.files)


def cards_of_documents(program, texts):
    """The cards that documents show by themselves: names in them may be unknown, but no card, key, word or unit."""
    tongue = language(program)
    for path in ("docs/cards.md", "docs/reports.md"):
        for block in blocks(texts[path]):
            if any(" ".join(block.split()).startswith(pattern) for pattern in tongue.patterns):
                continue
            for card in re.sub(r"&\n\s*", " ", block).split("\n"):
                if (card.split() or [""])[0] not in tongue.keywords:
                    continue
                found = said(program, {"my.deck": f"{card}\nUNITS mm kg s\n"}, "my.deck")
                for message in re.findall(r"my\.deck:1:\d+: error: (.*)", found):
                    if re.match(r"unexpected|unknown (card|key|unit|word|report)|'.*' is (not a|no) number", message):
                        yield f"{path}: {card.strip()}: {message}"


def message_of_included_file(program, texts):
    message = block_with(texts["docs/cards.md"], "included from")
    path, number = re.match(r"(\S+?):(\d+):", message).groups()
    line = re.search(r" \| (.*)$", message, re.MULTILINE)[1]
    deck, place = re.search(r"included from (\S+):(\d+)", message).groups()
    found = said(program, {path: "\n"*(int(number) - 1) + line, deck: "\n"*(int(place) - 1) + f"INCLUDE {path}\nUNITS mm tonne s\n"}, deck)
    if message not in found:
        yield f"it is now\n{found}"


def message_of_memory(program, texts):
    text = " ".join(texts["docs/running.md"].split())
    with open(os.path.join("inputs", "exact.deck"), encoding="utf-8") as file:
        deck = file.read()
    message = re.search(r"`(dense matrices of (\d+) unknowns.*?)`", text)
    deck = re.sub(r"(?m)^MESH.*", f"MESH * elements={int(message[2])//9}", deck).replace("\nEND", "\nSOLVER dense\nEND")
    found = said(program, {"big.deck": deck}, "big.deck")
    machine = re.compile(r"this machine has .*? free")
    if machine.sub("", message[1]) not in machine.sub("", found):
        yield f"it is now\n{found}"


def commands_with_decks(program, texts):
    """Decks changed by sed, as the documents show it, are decks still."""
    for path, text in texts.items():
        for command in re.findall(r"^    +((?:sed|\(links|\(rocker) .*?)(?: \| build/release/flexmech.*| > \w+\.deck)$", text, re.MULTILINE):
            if command.startswith("("):
                continue
            command = command.replace('"s/^MODES.*/SOLVER $s/"', "'s/^MODES.*/SOLVER dense/'")
            done = subprocess.run(f"{command} | {program} --check -", shell=True, capture_output=True, text=True, check=False)
            if done.returncode:
                yield f"{path}: {command}: {done.stderr.strip()}"


def commands_on_tables(program, texts):
    """What awk and grep print of tables: lines that begin with a number."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in texts.items():
            for command in re.findall(r"^    .*?((?:awk|grep) [^\n]* outputs/\w+/\w+\.dat)$", text, re.MULTILINE):
                name = re.search(r"outputs/(\w+)/", command)[1]
                deck = os.path.join("inputs", name + ".deck")
                if not os.path.exists(deck):
                    continue
                subprocess.run([program, "--quiet", "--out", os.path.join(folder, "outputs"), deck], capture_output=True, check=False)
                done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True, check=False)
                lines = done.stdout.split("\n")
                odd = [line for line in lines if line.strip() and not re.match(r" *-?\d", line)]
                if done.returncode or odd or not done.stdout.strip():
                    yield f"{path}: {command} prints {(odd or lines)[0]!r} {done.stderr}"


def targets(_, texts):
    """Every `make TARGET` is there."""
    known = set()
    for path in ["Makefile"] + glob(os.path.join("make", "*.mk")):
        with open(path, encoding="utf-8") as file:
            known.update(re.findall(r"^([a-z-]+):", file.read(), re.MULTILINE))
    for path, text in texts.items():
        shown = "\n".join(re.findall(r"`(make [^`]*)`", text) + blocks(text))
        for target in set(re.findall(r"\bmake ((?:[A-Z]+=\S+ )*[a-z][a-z-]+)", shown)):
            if target.split()[-1] not in known:
                yield f"{path}: there is no make {target}"


def faults_of_tutorial(program, text):
    """Its deck with what it gets wrong, and its commands one after the other, with what they print."""
    deck, name = block_with(text, "TITLE "), re.search(r"Save the deck as `(\S+)`", text)[1]
    for words, old, message in re.findall(r"(With(?:out)? `[^`]+`)(?: in place of `([^`]+)`)?[^`]*:\n\n((?:    .*\n)+)", text):
        new, card = ("", words[9:-1] + "\n") if words.startswith("Without") else (words[6:-1], old)
        message = "\n".join(line[4:] for line in message.rstrip("\n").split("\n"))
        found = said(program, {name: deck.replace(card, new) + "\n"}, name)
        if deck.count(card) != 1 or not found.startswith(message):
            yield f"with {card!r} changed the message is now\n{found}"
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(os.path.abspath("inputs"), os.path.join(folder, "inputs"))
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(deck + "\n")
        for block in blocks(text):
            if not re.match(r"make |flexmech |awk |grep |paste |\(sed ", block):
                continue
            command, _, printed = block.partition("\n\n")
            runs = re.sub(r"(?m)^make (?:figures|run) DECK=(\S+).*|^flexmech (\S+)$", rf"{program} --quiet \1\2", command)
            done = subprocess.run(runs, shell=True, cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode or done.stdout.rstrip() != printed.rstrip():
                yield f"{command}\nprints\n{done.stdout}{done.stderr}"


def tutorials(program, texts):
    for path, text in texts.items():
        if os.path.basename(path).startswith("tutorial"):
            yield from (f"{path}: {why}" for why in faults_of_tutorial(program, text))


def block_of_linkage(program, texts):
    """The second deck of the README."""
    run = Run(program, next(block for block in blocks(texts["README.md"]) if "GUIDE " in block))
    if run.status != 0 or len(run.rows("kinematics")) != 3*73:
        yield f"it ends with status {run.status}: {run.errors}"


CHECKS = (tutorials, block_of_linkage, deck_of_readme, worked_deck, cards_of_documents, message_of_included_file, message_of_memory, commands_with_decks, commands_on_tables, targets)
