"""The command flexmech-import."""

import os
import sys

from . import command_line, deck, formats, program
from .command_line import Wrong
from .errors import FileError

USAGE = """
usage: flexmech-import [options] FILE

Makes a deck of a linkage that was drawn in another program, and writes it to standard output. FILE is of
Linkage (.linkage2), PMKS (text or .pmks), pylinkage or linkage_sim (JSON), or has an address of PMKS+;
such an address may stand in its place, in quotes, and - is standard input. What a deck has no card for
stands in its first comment.

  -o DECK          write to this file instead
  --force          replace the file if it is there
  --help, --version

Exit status: 0, or 2 if the file or the command line is wrong; then nothing is written.
"""
LARGEST = 20_000_000  # bytes of a file; linkages have some thousand


def main(arguments):
    return command_line.run("flexmech-import", arguments, USAGE, _work)


def _work(arguments):
    options, words = command_line.read_options(arguments, {"-o": False}, {"--force"})
    if len(words) != 1:
        raise Wrong("expected one FILE; --help tells more" if words else "the file is missing; --help tells more")
    text, source, name = _read(words[0])
    try:
        drawing = formats.read(text, name)
        if not drawing.places:
            raise FileError("there is no linkage in this file")
        made = deck.write(drawing, source, program.ranges)
    except FileError as fault:
        raise Wrong(fault.told(source)) from None
    command_line.write(made, options.get("-o"), "--force" in options)


def _read(word):
    """The text of a file or address, what to call it, and a title."""
    if not os.path.exists(word) and ("://" in word or word.startswith("?")):
        return word, "an address of PMKS+", "A linkage of PMKS+"
    if word == "-":
        data, source = sys.stdin.buffer.read(LARGEST + 1), "standard input"
    else:
        with open(word, "rb") as file:
            data, source = file.read(LARGEST + 1), word
    if len(data) > LARGEST:
        raise Wrong(f"{source}: error: this is no file of a linkage: it has more than {LARGEST//1_000_000} MB")
    name = os.path.splitext(os.path.basename(word))[0] if word != "-" else "A linkage"
    return _decoded(data), source, name


def _decoded(data):
    """UTF-8, UTF-16 with its mark, or what Windows wrote before."""
    for mark in (b"\xff\xfe", b"\xfe\xff"):
        if data.startswith(mark):
            return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")
