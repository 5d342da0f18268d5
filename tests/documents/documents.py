#!/usr/bin/env python3
"""Writes, or checks, the numbers of the documents that runs of the program give.

    documents.py PROGRAM            prints `ok WHAT` or `not ok WHAT: why`; exit status 1 if a number is stale
    documents.py PROGRAM --write    writes the numbers anew
    documents.py PROGRAM --stress   those that `make stress` has left in outputs/stress/; also with --write

Which numbers: tables below a line `<!-- computed: NAME -->`, and the sentences of sentences.py, also in comments of inputs/*.deck.
Words, heads of tables and what others have published belong to the documents. Decks, messages and
commands that the documents show are tried (examples.py).
"""

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from glob import glob

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))

import deck_tables
import examples
import linkage_tables
import sentences
import stress_tables
from markdown import Sentence, tables


class Report:
    """Prints what is right and what is not."""

    wrong = False

    def tell(self, what, faults):
        faults = list(faults)
        self.wrong = self.wrong or bool(faults)
        for why in faults:
            print(f"not ok {what}: {why}")
        if not faults:
            print(f"ok {what}")


def makers(sources):
    """The maker of every table and of every sentence's numbers."""
    return {name: getattr(source, name) for source in sources for name in dir(source)
            if not name.startswith("_") and callable(getattr(source, name))}


def computed(jobs):
    """Name → what its maker gives; two at a time. An exception is what it gives as well."""
    def run(job):
        try:
            return list(job())
        except Exception as failure:  # a run that fails is a finding about its document
            return failure
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(jobs, pool.map(run, jobs.values())))


def read_documents():
    """Path → text; the comments of the decks that come along are documents as well."""
    texts = {}
    for path in ["README.md"] + sorted(glob(os.path.join("docs", "*.md")) + glob(os.path.join("inputs", "*.deck"))):
        with open(path, encoding="utf-8") as file:
            texts[path] = file.read()
    return texts


def check(texts, known, phrases, origin, write, report):
    """Compares, or writes anew, the tables of this origin and these sentences. Returns the texts."""
    marked = {path: [table.name for table in tables(text.split("\n"), origin)] for path, text in texts.items()}
    wanted = [name for names in marked.values() for name in names] + [name for _, _, name in phrases]
    values = computed({name: known[name] for name in wanted if name in known})
    written = {}
    for path, text in texts.items():
        lines = text.split("\n")
        for name in marked[path]:
            table = next(one for one in tables(lines, origin) if one.name == name)
            value = values.get(name, ValueError("nothing computes this table"))
            if isinstance(value, Exception):
                report.tell(f"{path}, table {name}", [f"{type(value).__name__}: {value}"])
                continue
            if write:
                table.write(value)
            report.tell(f"{path}, table {name}", table.faults(value))
        text = "\n".join(lines)
        for words, name in ((words, name) for place, words, name in phrases if place == path):
            if isinstance(values[name], Exception):
                report.tell(f"{path}, {name}", [f"{type(values[name]).__name__}: {values[name]}"])
                continue
            if write:
                text = Sentence(words).rewritten(text, values[name])
            report.tell(f"{path}, {name}", Sentence(words).faults(text, values[name]))
        written[path] = text
    report.tell("every computed table stands in a document", [f"{name} does not" for name in sorted(set(known) - set(wanted))])
    return written


def main(program, options):
    report, texts, write = Report(), read_documents(), "--write" in options
    if "--stress" in options:
        new = check(texts, makers([stress_tables.Tables(program)]), stress_tables.SENTENCES, "stress", write, report)
    else:
        sources = [deck_tables.Tables(program), linkage_tables.Tables(program), sentences.Numbers(program)]
        new = check(texts, makers(sources), sentences.SENTENCES, None, write, report)
        for example in examples.CHECKS:
            report.tell(example.__name__.replace("_", " "), example(program, new))
    for path, text in new.items():
        if write and text != texts[path]:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
    return 1 if report.wrong else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1]), sys.argv[2:]))
