"""The command flexmech-report: what it is asked for, what it reads and writes."""

import getopt
import json
import os
import signal
import subprocess
import sys
import tempfile
import webbrowser
from pathlib import Path

import page
import tables
from figures import PLOTS, Figures

HELP = """usage: flexmech-report [options] FOLDER...

Makes one page of what flexmech has computed, with its figures, to read, print or send: FOLDER/report.html;
FOLDER is what flexmech has written, such as outputs/mechanism1. The page needs no network and no script;
its links lead to the full tables.

  -o FILE          write the page there, of one FOLDER
  --open           show it in the browser
  --help, --version

Exit status: 0, 1 if something could not be drawn or shown, 2 if the command line is wrong.
"""


class Misuse(Exception):
    """What is wrong with the command line."""


def remark(text):
    print(f"flexmech-report: {text}", file=sys.stderr)


class Run:
    """What a folder holds of a run."""

    def __init__(self, folder):
        self.folder = folder
        if not os.path.isdir(folder):
            raise Misuse(f"{folder} is a file: name the folder with the tables of a deck, such as outputs/mechanism1"
                         if os.path.exists(folder) else f"no folder {folder}")
        path = os.path.join(folder, "summary.json")
        try:
            with open(path, encoding="utf-8") as file:
                summary = json.load(file)
            self.computed = os.path.getmtime(path)
            self.deck, self.version, self.counts, self.warnings = (summary[key] for key in ("deck", "version", "counts", "warnings"))
            files = [table["file"] for table in summary["tables"]]
        except (OSError, ValueError, TypeError, KeyError) as fault:
            raise Misuse(f"{folder} is no output folder of flexmech, such as outputs/mechanism1: it has no sound summary.json") from fault
        self.files = [os.path.join(folder, file) for file in files if os.path.isfile(os.path.join(folder, file))]
        if not self.files:
            raise Misuse(f"{folder} has no tables: they are what a page is made of")

    def read(self):
        self.tables = [(tables.read_csv if path.endswith(".csv") else tables.read_plain)(path) for path in self.files]
        self.echo = self.lines("echo.deck")
        self.title = next((line[6:].strip() for line in self.echo if line.upper().startswith("TITLE ")), self.deck)
        log = self.lines("run.log")
        end = next((i for i, line in enumerate(log) if line.startswith(("warning: ", "failures: "))), len(log))
        self.log = [line for line in log[:end] if line != self.title]
        begin = next((i for i, line in enumerate(log) if line.startswith("failures: ")), len(log))
        self.failures = log[begin + 1:]

    def lines(self, name):
        try:
            with open(os.path.join(self.folder, name), encoding="utf-8", errors="replace") as file:
                return [line.rstrip("\n") for line in file]
        except FileNotFoundError:
            return []


def check_target(path):
    """A page replaces an earlier page, and no other file."""
    if not path or os.path.isdir(path):
        raise Misuse(f"'{path}' is no name of a file, such as my.html")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise Misuse(f"no folder {os.path.dirname(path)}")
    if os.path.lexists(path):
        with open(path, encoding="utf-8", errors="replace") as file:
            if page.MARK not in file.read(1000):
                raise Misuse(f"{path} is no page of flexmech-report, and is left as it was: name another file with -o")


def write(path, text):
    """Whole or not at all."""
    handle, part = tempfile.mkstemp(dir=os.path.dirname(path) or ".", prefix=".report-")
    try:
        with open(handle, "w", encoding="utf-8") as file:
            file.write(text)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, path)
    except BaseException:
        os.unlink(part)
        raise


def report(run, target, shows):
    """Exit status."""
    run.read()
    figures = Figures(run.folder)
    for line in figures.told:
        remark(line)
    write(target, page.page_of(run, figures, target))
    print(target)
    status = int(figures.failed)
    if shows and not webbrowser.open(Path(target).absolute().as_uri()):
        remark(f"no browser is found that shows {target}")
        status = 1
    return status


def main(words):
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    sys.stdout.reconfigure(errors="surrogateescape")
    try:
        options, folders = getopt.gnu_getopt(words, "o:", ["open", "help", "version"])
        options = dict(options)
        if "--help" in options:
            print(HELP, end="")
            return 0
        if "--version" in options:
            return subprocess.run(["sh", os.path.join(PLOTS, "draw_figures.sh"), "--version"],
                                  env={**os.environ, "FLEXMECH_PLOT": "flexmech-report"}, check=False).returncode
        if not folders:
            raise Misuse("the folder with the tables of a deck is missing")
        if "-o" in options and len(folders) > 1:
            raise Misuse("-o takes one folder: each has a page of its own")
        runs = [Run(folder) for folder in folders]
        targets = [options.get("-o", os.path.join(folder, "report.html")) for folder in folders]
        for target in targets:
            check_target(target)
        return max([report(run, target, "--open" in options) for run, target in zip(runs, targets)])
    except (getopt.GetoptError, Misuse) as fault:
        remark(fault)
        print("'flexmech-report --help' lists the options", file=sys.stderr)
        return 2
    except OSError as fault:
        remark(f"{fault.filename}: {fault.strerror}")
        return 1
    except KeyboardInterrupt:
        return 130
