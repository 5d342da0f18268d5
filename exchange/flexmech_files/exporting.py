"""The command flexmech-export."""

import os
import re

from . import command_line, outlines, vector_files
from .command_line import Wrong

USAGE = """
usage: flexmech-export [options] svg|dxf DECK

Writes the linkage of a deck at a position for programs that draw: its links as lines, its pins as circles
with their names, guides and springs; as SVG, or as DXF of release 12. One unit of the drawing is the
deck's unit of length. It goes to standard output.

  --at CRANK       the position, as on a CRANK card without a unit: degrees, or the length of a ram or the
                   place of a slider; of a deck without a CRANK card it may be left out
  --time T         the instant instead, of a deck in which several drives have laws
  -o FILE          write to this file instead
  --force          replace the file if it is there
  --set NAME=VALUE a value for SET or VARY, as of flexmech; may be repeated
  --help, --version

Exit status: 0, or 2 if the deck or the command line is wrong, or the linkage has no such position; then nothing is written.
"""
WRITERS = {"svg": vector_files.svg, "dxf": vector_files.dxf}


def main(arguments):
    return command_line.run("flexmech-export", arguments, USAGE, _work)


def _work(arguments):
    options, words = command_line.read_options(arguments, {"-o": False, "--at": False, "--time": False, "--set": True}, {"--force"})
    if len(words) != 2 or words[0] not in WRITERS:
        raise Wrong("expected svg or dxf, and a DECK; --help tells more")
    form, deck = words
    option = "--time" if "--time" in options else "--at"
    at = options.get(option) or _only_position(deck)
    if not re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", at):
        raise Wrong(f"{option} {at}: expected a number")
    outline = outlines.outline_of(deck, f"{'crank' if option == '--at' else 'time'}={at}", options.get("--set", []))
    title = f"{os.path.basename(deck)} at {at}, in {outline.unit}"
    command_line.write(WRITERS[form](outline, title), options.get("-o"), "--force" in options)


def _only_position(deck):
    """Structures have one."""
    with open(deck, encoding="utf-8", errors="replace") as file:
        if re.search(r"(?im)^\s*(crank|time)\b", file.read()):
            raise Wrong("--at is missing: the position")
    return "0"
