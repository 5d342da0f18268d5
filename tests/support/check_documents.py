#!/usr/bin/env python3
"""Checks that the documents know what the program knows, and that what they point at is there.

    check_documents.py

docs/deck.md has to name every card, key, report, table and option that the program lists; paths and links in README.md and
docs/ have to lead somewhere, a file has to have the procedures that are said to be in it, and src/ those that
docs/architecture.md calls.

Prints `ok WHAT` or `not ok WHAT: why`; exit status 1 when anything is wrong.
"""

import os
import re
import subprocess
import sys
from glob import glob

from deck_language import PROGRAMS, language

FOLDERS = "src|tests|docs|inputs|plots"


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def known_of_deck():
    """What docs/deck.md must have, with the place where it must stand: in code, so that it can be found."""
    program = next(path for path in PROGRAMS if os.path.exists(path))
    tongue = language(program)
    for keyword in tongue.keywords:
        yield f"card {keyword}", rf"`{keyword}\b"
    for pattern in tongue.patterns:
        keyword = pattern.split()[0]
        for key in re.findall(r"(\w+)=", pattern):
            yield f"{keyword} {key}=", rf"`[^`\n]*\b{key}="
    for report in tongue.reports:
        yield f"report {report}", rf"`(?:REPORT )?{report}\b"
    for table in tongue.tables:
        yield f"table {table}", rf"`{re.escape(table)}`"
    text = subprocess.run([program, "--help"], capture_output=True, check=True, text=True).stdout
    for option in re.findall(r"^  (--[\w-]+)", text, re.MULTILINE):
        yield f"option {option}", rf"`{option}\b"


def anchors(text):
    """The anchors of a document's headings, as they are made out of them."""
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


def faults_of_contents(text):
    """A document with contents has every section there."""
    contents = re.search(r"(?:^- \[.*\n(?:  .*\n)*)+", text.partition("\n## ")[0] + "\n", re.MULTILINE)
    if contents:
        listed = re.findall(r"\]\(#([\w-]+)\)", contents[0])
        yield from (f"its contents lack #{anchor}" for anchor in sorted(anchors(re.sub(r"(?m)^# .*$", "", text)) - set(listed)))


def faults_of_links(path, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"\w+:", target):
            continue
        file, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
        if not os.path.exists(file):
            yield f"there is no {file}"
        elif anchor and anchor not in anchors(read(file)):
            yield f"{file} has no heading #{anchor}"


def faults_of_paths(text):
    """Paths have to lead somewhere, but for those with a NAME that is yet to be chosen."""
    for place in sorted(set(re.findall(rf"`((?:{FOLDERS})/[\w./*{{}},-]*)`", text))):
        if "NAME" in place:
            continue
        alternatives = [place]
        if "{" in place:
            head, _, rest = place.partition("{")
            inner, _, tail = rest.partition("}")
            alternatives = [head + part + tail for part in inner.split(",")]
        for one in alternatives:
            if not glob(one):
                yield f"there is no {one}"


def faults_of_procedures(text):
    """`one`, `two` in `src/file.f90`: the file has to have them."""
    for names, path in re.findall(r"((?:`\w+`(?:, | and )?)+) in\s`(src/[\w/]+\.f90)`", text):
        if os.path.exists(path):
            words = set(re.findall(r"\w+", read(path)))
            yield from (f"{path} has no {name}" for name in re.findall(r"`(\w+)`", names) if name not in words)


def faults_of_calls(text, sources):
    """`several_words` are procedures or the like: some source has to have them."""
    for name in sorted(set(re.findall(r"`(\w+_\w+)`", text))):
        if not re.search(rf"\b{name}\b", sources):
            yield f"src/ has no {name}"


def main():
    wrong = False

    def tell(what, why=None):
        nonlocal wrong
        wrong = wrong or why is not None
        print(f"ok {what}" if why is None else f"not ok {what}: {why}")

    deck = read(os.path.join("docs", "deck.md"))
    for what, pattern in known_of_deck():
        tell(f"docs/deck.md, {what}", None if re.search(pattern, deck) else f"nothing matches {pattern}")
    sources = "".join(read(path) for path in glob("src/**/*.f90", recursive=True))
    for path in ["README.md"] + sorted(glob(os.path.join("docs", "*.md"))):
        text = read(path)
        found = list(faults_of_links(path, text)) + list(faults_of_paths(text)) + list(faults_of_procedures(text))
        found += faults_of_contents(text)
        if path.endswith("architecture.md"):
            found += faults_of_calls(text, sources)
        for why in found:
            tell(path, why)
        if not found:
            tell(path)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
