"""A linkage at a position: lines, circles and names, from the table of REPORT geometry."""

import os
import re
import subprocess
import tempfile
from dataclasses import dataclass, field

from . import program
from .command_line import Wrong


@dataclass
class Outline:
    unit: str
    links: dict = field(default_factory=dict)   # name -> places of its pins, in order
    springs: dict = field(default_factory=dict)  # name -> both ends
    guides: list = field(default_factory=list)  # both ends of a short line through a slider
    pins: dict = field(default_factory=dict)    # name -> place
    ground: set = field(default_factory=set)    # names of pins that stand still
    blocks: set = field(default_factory=set)    # names of pins that slide

    def corners(self):
        places = list(self.pins.values()) + [place for way in self.links.values() for place in way]
        xs, ys = zip(*places)
        return min(xs), min(ys), max(xs), max(ys)

    def size(self):
        x1, y1, x2, y2 = self.corners()
        return max(x2 - x1, y2 - y1) or 1.0


def outline_of(deck, where, settings):
    """Of a deck, by the program; where: `crank=` or `time=` with a number."""
    path = program.find()
    if path is None:
        raise Wrong("the program flexmech is not here: build or install it, or say where it is with FLEXMECH=PATH")
    with open(deck, encoding="utf-8", errors="surrogateescape") as file:
        text = _with_geometry(file.read(), where)
    with tempfile.TemporaryDirectory() as folder:
        # The deck comes from standard input: files that it includes are found beside it.
        command = [path, "--quiet", "--threads=1", "--out", folder] + [f"--set={setting}" for setting in settings] + ["-"]
        done = subprocess.run(command, input=text, capture_output=True, check=False, encoding="utf-8",
                              errors="surrogateescape", cwd=os.path.dirname(os.path.abspath(deck)))
        table = next((os.path.join(place, "geometry.dat") for place, _, files in os.walk(folder) if "geometry.dat" in files), None)
        if table is None:
            told = done.stderr.replace("<standard input>:", f"{deck}:") or f"{deck}: error: the program gave no geometry\n"
            raise Wrong(told.rstrip("\n"))
        with open(table, encoding="utf-8", errors="surrogateescape") as file:
            return _outline(file.read(), deck)


def _with_geometry(text, where):
    """The deck with one report. Lines keep their numbers."""
    lines, continued = [], False
    for line in text.splitlines():
        drop = continued or re.match(r"\s*(report|end)\b", line, re.IGNORECASE)
        continued = bool(drop) and re.sub(r"[!#].*", "", line).rstrip().endswith("&")
        lines.append("" if drop else line)
    return "\n".join(lines) + f"\nREPORT geometry {where}\n"


def _outline(table, deck):
    heads = [line[1:].split() for line in table.splitlines() if re.match(r"#(?! failed)", line)]
    names, units = heads[-2], heads[-1]
    if names[0] not in ("crank", "time"):
        raise Wrong(f"{deck}: error: it has VARY: choose a variant, --set {names[0]}=VALUE")
    failed = re.search(r"(?m)^# failed .*$", table)
    rows = [line.split() for line in table.splitlines() if line and not line.startswith("#")]
    if failed or not rows:
        raise Wrong(f"{deck}: error: {failed[0][2:] if failed else 'the linkage has no place there'}")
    outline = Outline(units[names.index("x")])
    sliders = {}
    for row in rows:
        link, part, name, *numbers = row[names.index("link"):]
        place = tuple(float(value) for value in numbers)
        if part == "pin":
            outline.pins[name] = place
            if link == "(ground)":
                outline.ground.add(name)
            else:
                outline.links.setdefault(link, []).append(place)
        elif part == "point":
            outline.pins[name] = place
        elif part == "slider":
            outline.pins.setdefault(name, place)
            outline.blocks.add(name)
            sliders[link, name] = place
        elif part == "ahead":
            outline.guides.append((link, sliders[link, name], place))
        else:
            outline.springs.setdefault(link, []).append(place)
    outline.guides = [_piece(start, ahead, outline.size()/8) for link, start, ahead in outline.guides if link not in outline.links]
    return outline


def _piece(place, ahead, half):
    """A piece of a guide to both sides of its block."""
    way = [b - a for a, b in zip(place, ahead)]
    length = (way[0]**2 + way[1]**2)**0.5 or 1.0
    step = [half*component/length for component in way]
    return tuple(a - b for a, b in zip(place, step)), tuple(a + b for a, b in zip(place, step))
