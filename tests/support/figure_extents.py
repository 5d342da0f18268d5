"""Of figures: that no word is cut off and none lies on another.

    figure_extents.py scale FACTOR FOLDER TARGET    the tables of FOLDER with their values multiplied, in TARGET
    figure_extents.py check FILE.svg...             complains of every text that leaves its page or meets another

Widths are those of DejaVu Sans, which is as wide as such fonts are; a letter that is not in the list is as wide as it is high.
"""

import os
import re
import shutil
import sys
import xml.etree.ElementTree as tree

# Advances in thousandths of the size.
ADVANCES = {
    278: "ijl'", 318: " ,.·IJİ", 337: "/:;\\|", 361: "f-", 401: "()[]t!²³°₀₁₂₃₄₅₆₇₈₉⁰¹⁴⁵⁶⁷⁸⁹", 411: "r", 525: "szş_*⁻?`\"", 550: "cçL",
    592: "kvxyF", 615: "oθeaTYPπ", 637: "bdghnpqug$0123456789{}μµES√", 685: "AVXZBKα", 698: "RC", 752: "UNH", 787: "DGO&Q",
    838: "w#+<=>^~×−ω", 863: "M", 974: "m%½",
}
WIDTH = {letter: advance/1000 for advance, letters in ADVANCES.items() for letter in letters}
ASCENT, DESCENT = 0.76, 0.24
# Drawings of which a word may lie on a number.
DRAWINGS = re.compile("mechanism|finite|mode|special|coupler|deformed_linkage|linkage_speed|fig3_0[1-24-9]|fig3_1|fig3_2")
# gnuplot writes a text in a box twice.
BOXED = re.compile("linkage_positions|shaking|frame_force")


class Text:
    """A line of words: where it is on its page."""

    def __init__(self, words, place, angle, anchor, size):
        self.words = words
        width = size*sum(WIDTH.get(letter, 1) for letter in words)
        left = {"start": 0, "middle": -width/2, "end": -width}[anchor]
        x, y = place
        if angle == -90:
            self.box = (x - ASCENT*size, y - left - width, x + DESCENT*size, y - left)
        else:
            self.box = (x + left, y - ASCENT*size, x + left + width, y + DESCENT*size)
        self.slack = 0.12*size

    def leaves(self, width, height):
        left, top, right, bottom = self.box
        return left < 0 or top < 0 or right > width or bottom > height

    def meets(self, other):
        slack = min(self.slack, other.slack)
        return (self.box[0] + slack < other.box[2] - slack and other.box[0] + slack < self.box[2] - slack
                and self.box[1] + slack < other.box[3] - slack and other.box[1] + slack < self.box[3] - slack)


def texts_of(page):
    for group in page.iter("{http://www.w3.org/2000/svg}g"):
        place = re.fullmatch(r"translate\(([-\d.]+),([-\d.]+)\)( rotate\(([-\d.]+)\))?", group.get("transform", ""))
        for text in group.findall("{http://www.w3.org/2000/svg}text"):
            words = "".join(text.itertext())
            if place and words.strip():
                yield Text(words, (float(place[1]), float(place[2])), float(place[4] or 0), group.get("text-anchor"),
                           float(group.get("font-size")))


def faults_of(path):
    page = tree.parse(path).getroot()
    width, height = map(float, page.get("viewBox").split()[2:])
    texts = list(texts_of(page))
    if not texts:
        yield "no text at all"
    for text in texts:
        if text.leaves(width, height):
            yield f"'{text.words}' leaves the page: {[round(edge) for edge in text.box]} of {width:g} x {height:g}"
        if re.fullmatch(r"[-+−]?[\d.]+([eE][-+−]?|×10[-−]?)\d+", text.words):
            yield f"'{text.words}' brings its own power of ten"
    if not DRAWINGS.search(os.path.basename(path)):
        boxed = BOXED.search(os.path.basename(path))
        for i, text in enumerate(texts):
            for other in texts[:i]:
                if text.meets(other) and not (boxed and (text.words, text.box) == (other.words, other.box)):
                    yield f"'{text.words}' lies on '{other.words}'"


def check(paths):
    faults = [f"{os.path.basename(path)}: {fault}" for path in paths for fault in faults_of(path)]
    print("\n".join(faults[:10]))
    return 1 if faults else 0


def scaled(lines, factor):
    """Values but for angles, speeds and ratios; what is varied is multiplied too."""
    names = units = None
    header = []
    for line in lines:
        words = line.split()
        if line.startswith("#") or not words:
            if line.startswith("#"):
                header.append(words[1:] if words[0] == "#" else [words[0][1:]] + words[1:])
            yield line
            continue
        if names is None:
            names, units = header[-2:]
        for i, word in enumerate(words):
            if re.fullmatch(r"-?\d+(\.\d+)?(e[-+]\d+)?", word) and names[i] not in ("speed", "crank") and units[i] not in ("deg", "-"):
                words[i] = f"{float(word)*factor:.16E}"
        yield " ".join(words) + "\n"


def scale(factor, folder, target):
    os.makedirs(target)
    for name in os.listdir(folder):
        path = os.path.join(folder, name)
        if name.endswith(".dat"):
            with open(path, encoding="utf-8") as table, open(os.path.join(target, name), "w", encoding="utf-8") as copy:
                copy.writelines(scaled(table, float(factor)))
        elif name == "echo.deck":
            shutil.copy(path, target)
    return 0


if __name__ == "__main__":
    sys.exit({"scale": scale, "check": lambda *paths: check(paths)}[sys.argv[1]](*sys.argv[2:]))
