"""The figures of a run, drawn anew as flexmech-plot draws them, and made ready to stand in one page."""

import base64
import os
import re
import subprocess
import tempfile
from itertools import groupby
from pathlib import Path

PLOTS = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
SIZE = "120x90mm"       # letters are large enough on a telephone
LARGEST = 1_000_000     # bytes of an SVG; a larger figure stands in the page as a PNG
# These come first: they show what the others are about.
DRAWINGS = ("linkage_positions", "mechanism", "coupler_curve", "special_positions")
# A filled circle of gnuplot.
DOT = r"<use xlink:href='#gpPt6' transform='translate\(([^)]*)\) scale\(([\d.]+)\)' color='([^']*)'/>"


class Figures:
    """Names and pictures, HTML each; what was told meanwhile; whether anything could not be drawn."""

    def __init__(self, folder):
        drawn, told, status = draw(folder, "svg")
        pictures = {name: slim(text.decode("utf-8")) for name, text in drawn.items()}
        if any(len(text) > LARGEST for text in pictures.values()):
            images = draw(folder, "png")[0]
            for name, text in pictures.items():
                if len(text) > LARGEST and name in images:
                    pictures[name] = image(images[name], name)
        self.told, self.failed = told, status != 0
        names = sorted(pictures, key=order)
        self.pictures = [(name, alone(pictures[name], f"f{i + 1}-", name)) for i, name in enumerate(names)]


def order(name):
    """Drawings first; speeds and numbers of modes by their values."""
    return name not in DRAWINGS, [(part.isdigit(), int(part) if part.isdigit() else part) for part in re.split(r"(\d+)", name) if part]


def draw(folder, form):
    """Files by name, what was told, exit status. Nothing is touched in the folder: the figures go into one with links to its files."""
    with tempfile.TemporaryDirectory(prefix="flexmech-report-") as scratch:
        copy = os.path.join(scratch, os.path.basename(os.path.abspath(folder)))
        os.mkdir(copy)
        for entry in os.scandir(folder):
            if entry.is_file():
                os.symlink(os.path.realpath(entry.path), os.path.join(copy, entry.name))
        run = subprocess.run(["sh", os.path.join(PLOTS, "draw_figures.sh"), "--format", form, "--size", SIZE, "--", copy],
                             env={**os.environ, "FLEXMECH_PLOT": "flexmech-report"}, stdin=subprocess.DEVNULL, capture_output=True,
                             encoding="utf-8", errors="replace", check=False)
        drawn = {path.stem: path.read_bytes() for path in Path(copy, "figures").glob("*." + form)}
        told = run.stderr.replace(copy + "/", "").replace(copy, folder).replace("flexmech-report: ", "")
        return drawn, told.splitlines(), run.returncode


def slim(text):
    """An SVG without what draws nothing: its declaration, groups and words without content, titles that gnuplot gives to plots without
    one, numbers of plots, digits below a tenth of its unit, 0.09 mm, and fonts."""
    text = text[text.index("<svg"):]
    text = re.sub(r"<(title|desc)>(Gnuplot|Produced by .*?|gnuplot_plot_\w+)</\1>", "", text)
    text = re.sub(r"""( d='| points ?= ?['"]|translate\()([^'")]*)""", lambda found: found[1] + rounded(found[2]), text)
    text = re.sub(r"rgb\( *(\d+), *(\d+), *(\d+)\)", lambda found: "#" + "".join(f"{int(number):02x}" for number in found.groups()), text)
    text = re.sub(r' (font-family|id)="[^"]*"', "", text)
    text = re.sub(rf"(?:{DOT}\s*)+", joined_dots, text)
    count = 1
    while count:
        text, count = re.subn(r"<g [^>]*>\s*</g>|<(text|tspan)[^>]*></\1>", "", text)
    return re.sub(r"\s*\n\s*", "\n", text)


def rounded(numbers):
    return re.sub(r"(\.\d)\d+", r"\1", re.sub(r"\.0\d*", "", numbers.strip()))


def joined_dots(found):
    """The dots of a curve, which are most of an SVG, as one path."""
    paths = []
    for (scale, color), dots in groupby(re.findall(DOT, found[0]), key=lambda dot: dot[1:]):
        way = "".join(f"M{place}h0" for place, *_ in dots)
        paths.append(f"<path fill='none' stroke='{color}' stroke-width='{2*float(scale):g}' stroke-linecap='round' d='{way}'/>")
    return "\n".join(paths)


def image(data, name):
    return f'<img alt="{name}" src="data:image/png;base64,{base64.b64encode(data).decode("ascii")}">'


def alone(text, prefix, name):
    """An SVG as wide as the page has room for, whose ids are those of no other figure."""
    text = re.sub(r"""(\sid=["']|href=["']#|url\(["']?#)""", rf"\1{prefix}", text)
    return re.sub(r'\swidth="[^"]*"\s+height="[^"]*"', f' role="img" aria-label="{name}"', text, count=1)
