#!/usr/bin/env python3
"""Checks that the documents know what the program knows, and that what they point at is there.

    check_documents.py

docs/cards.md has to have every card that the program lists, each in a section of its own with its pattern, docs/reports.md every report
likewise, and all tables, docs/running.md the program's options, docs/figures.md and docs/import.md those of the commands beside it, and
all figures of plots/figures.txt; paths and links in README.md and docs/ have to lead somewhere, a file has to have the procedures that are
said to be in it, and src/ those that docs/architecture.md calls. The program, CHANGELOG.md and CITATION.cff have to have the same version
and date of release, README.md and CITATION.cff the same address.

Prints `ok WHAT` or `not ok WHAT: why`; exit status 1 when anything is wrong.
"""

import os
import re
import subprocess
import sys
from glob import glob

from deck_language import PROGRAMS, language

FOLDERS = "src|tests|docs|inputs|plots|exchange|library|make"


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def tongue():
    return language(next(path for path in PROGRAMS if os.path.exists(path)))


def sections(text):
    """Every heading with the text below it, up to the next heading of its level or above."""
    found = {}
    headings = list(re.finditer(r"^(#+) (.*)$", text, re.MULTILINE))
    for number, heading in enumerate(headings):
        behind = (other.start() for other in headings[number + 1:] if len(other[1]) <= len(heading[1]))
        found.setdefault(heading[2], text[heading.end():next(behind, len(text))])
    return found


def has_pattern(section, pattern):
    """Whether the form of a card stands there, in code; in tables its bars have a stroke before them."""
    code = re.findall(r"^    .*(?:\n    .*)*|`[^`\n]*`", section.replace("\\|", "|"), re.MULTILINE)
    return any(" ".join(pattern.split()) in " ".join(one.split()) for one in code)


# What a document must have: what it is, and whether it is there. A card or report has a section of its own.


def known_of_cards(text):
    parts = sections(text)
    for keyword in tongue().keywords:
        yield f"card {keyword}", keyword in parts
    for pattern in tongue().patterns:
        if not re.match(r"REPORT [a-z]+( \[?\w+=|$)", pattern):
            yield pattern, has_pattern(parts.get(pattern.split()[0], ""), pattern)


def known_of_reports(text):
    parts = sections(text)
    for report in tongue().reports:
        yield f"report {report}", report in parts
    for pattern in tongue().patterns:
        if re.match(r"REPORT [a-z]+( \[?\w+=|$)", pattern):
            yield pattern, has_pattern(parts.get(pattern.split()[1], ""), pattern)
    for table in tongue().tables:
        yield f"table {table}", f"`{table}`" in text


def known_of_running(text):
    program = next(path for path in PROGRAMS if os.path.exists(path))
    help_text = subprocess.run([program, "--help"], capture_output=True, check=True, text=True).stdout
    for option in re.findall(r"^  (--[\w-]+)", help_text, re.MULTILINE):
        yield f"option {option}", re.search(rf"`{option}\b", text)


def known_of_figures(text):
    for command in ("flexmech-plot", "flexmech-report"):
        help_text = subprocess.run([os.path.join("plots", command), "--help"], capture_output=True, check=True, text=True).stdout
        for option in re.findall(r"^  (--?[\w-]+)", help_text, re.MULTILINE):
            yield f"option {option} of {command}", re.search(rf"`{command}[^`\n]* {option}\b|`{option}\b", text)
    for figure in re.findall(r"^(?:figures|animations) +(\w+)", read(os.path.join("plots", "figures.txt")), re.MULTILINE):
        yield f"figure {figure}", f"`{figure}`" in text


def known_of_import(text):
    for command in ("flexmech-import", "flexmech-export"):
        help_text = subprocess.run([os.path.join("exchange", command), "--help"], capture_output=True, check=True, text=True).stdout
        for option in re.findall(r"(?<=[ ,])(--?[a-z][\w-]*)", "\n".join(re.findall(r"^  -.*", help_text, re.MULTILINE))):
            yield f"option {option} of {command}", re.search(rf"`{option}\b", text)


def faults_of_versions(program):
    """Program, changelog and citation have one version, and no tag is newer."""
    version = subprocess.run([program, "--version"], capture_output=True, check=True, text=True).stdout.split()[-1]
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        yield f"{version} is not X.Y.Z"
        return
    for path, pattern in (("CHANGELOG.md", r"^## (\S+)"), ("CITATION.cff", r"^version: (\S+)")):
        found = re.search(pattern, read(path), re.MULTILINE)
        if not found or found[1] != version:
            yield f"{path} has {found[1] if found else 'none'}, the program {version}"
    sections = re.findall(r"^## (\d+)\.(\d+)\.(\d+)$", read("CHANGELOG.md"), re.MULTILINE)
    numbers = [tuple(map(int, section)) for section in sections]
    if numbers != sorted(set(numbers), reverse=True):
        yield "the versions of CHANGELOG.md do not fall"
    dates = [re.search(pattern, read(path), re.MULTILINE) for path, pattern in
             (("CHANGELOG.md", r"\A(?:(?!^## ).*\n)*## .*\n\nReleased (\S+)\.$"), ("CITATION.cff", r"^date-released: (\S+)$"))]
    told = [date[1] if date else "none" for date in dates]
    if told[0] != told[1]:
        yield f"CHANGELOG.md was released {told[0]}, CITATION.cff {told[1]}"
    tags = subprocess.run(["git", "tag", "--list", "v*"], capture_output=True, check=False, text=True).stdout.split()
    for tag in tags:
        found = re.fullmatch(r"v(\d+)\.(\d+)\.(\d+)", tag)
        if not found or tuple(map(int, found.groups())) > numbers[0]:
            yield f"the tag {tag} is no version up to {version}"
    if f"v{version}" in tags and told[0] == "none":
        yield f"the tag v{version} is there, and CHANGELOG.md has no line 'Released ...'"


def faults_of_address():
    """CITATION.cff has the address from which the sources come, once there is one."""
    found = re.search(r"^repository-code: *(\S+)", read("CITATION.cff"), re.MULTILINE)
    address = found[1] if found else "ADDRESS"
    if not re.search(rf"^ +git clone {re.escape(address)} flexmech\b", read("README.md"), re.MULTILINE):
        yield f"README.md does not clone {address}"


# What the Citation File Format 1.2.0 requires of a file, and of what is cited in it.
CITATION_KEYS = ("cff-version", "message", "title", "authors")
REFERENCE_KEYS = ("authors", "title", "type")


def faults_of_citation(text):
    keys = re.findall(r"^([a-z-]+):", text, re.MULTILINE)
    yield from (f"{key} is missing" for key in CITATION_KEYS if key not in keys)
    yield from (f"{key} stands there twice" for key in sorted(set(keys)) if keys.count(key) > 1)
    if "\t" in text or not re.search(r"^cff-version: 1\.2\.0$", text, re.MULTILINE):
        yield "it is not of version 1.2.0"
    for reference in re.split(r"^  - ", text.partition("references:\n")[2], flags=re.MULTILINE)[1:]:
        yield from (f"a reference has no {key}" for key in REFERENCE_KEYS if not re.search(rf"(?m)^(?:    )?{key}:", reference))


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

    for name, known in (("cards.md", known_of_cards), ("reports.md", known_of_reports), ("running.md", known_of_running),
                        ("figures.md", known_of_figures), ("import.md", known_of_import)):
        for what, is_there in known(read(os.path.join("docs", name))):
            tell(f"docs/{name}, {what}", None if is_there else "is not there")
    found = list(faults_of_versions(next(path for path in PROGRAMS if os.path.exists(path)))) + \
        list(faults_of_citation(read("CITATION.cff"))) + list(faults_of_address())
    for why in found or [None]:
        tell("version and citation", why)
    sources = "".join(read(path) for path in glob("src/**/*.f90", recursive=True))
    for path in ["README.md", "CHANGELOG.md"] + sorted(glob(os.path.join("docs", "*.md"))):
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
