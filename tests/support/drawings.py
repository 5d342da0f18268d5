"""What an SVG of gnuplot's shows: drawings.py CHECK FILE.svg [ARGUMENT...]. Says nothing if the check holds, else why not."""

import itertools
import math
import re
import sys
import xml.etree.ElementTree as tree


def numbers(text):
    return [float(word) for word in re.findall(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?", text)]


def name_of(element):
    return element.tag.rsplit("}", 1)[-1]


class Picture:
    """Texts (words, x of the left end and of the right one, y of the lower edge and of the upper one), polygons (colour, points)
    and paths (colour, width, points), in the order in which they are drawn; lengths are pixels, y grows downwards."""

    def __init__(self, file):
        self.texts, self.polygons, self.paths, self.order = [], [], [], []
        root = tree.parse(file).getroot()
        self.width, self.height = numbers(root.get("viewBox"))[2:]
        self.walk(root, {})

    def walk(self, element, given):
        given = {**given, **{key: value for key, value in element.attrib.items() if key != "transform"}}
        if element.get("transform") and name_of(element) == "g":
            given["transform"] = element.get("transform")
        kind = name_of(element)
        if kind == "text":
            self.add_text("".join(element.itertext()).strip(), given)
        if kind == "polygon":
            points = numbers(given["points"])
            self.polygons.append((tuple(map(int, numbers(given["fill"]))), list(zip(points[::2], points[1::2]))))
            self.order.append(("polygon", self.polygons[-1]))
        if kind == "path" and "defs" not in given:
            self.add_paths(given)
        for child in element:
            if name_of(child) != "defs":
                self.walk(child, given)

    def add_text(self, words, given):
        place = numbers(given.get("transform", "0 0"))
        size = float(given["font-size"])
        long = 0.56*size*len(words)
        anchor = given.get("text-anchor", "start")
        left = place[0] - {"start": 0, "middle": 0.5, "end": 1}[anchor]*long
        if words and "rotate" not in given.get("transform", ""):
            self.texts.append((words, left, left + long, place[1], place[1] - 0.72*size))

    def add_paths(self, given):
        colour = numbers(given.get("stroke", ""))
        width = float(given.get("stroke-width", "1"))
        for part in given["d"].split("M")[1:]:
            points = numbers(part)
            found = (tuple(map(int, colour)), width, list(zip(points[::2], points[1::2])))
            self.paths.append(found)
            self.order.append(("path", found))

    def y_of(self, words):
        found = [text for text in self.texts if text[0] == words]
        assert found, f"no text '{words}' in {[text[0] for text in self.texts]}"
        return found[0][3]


def apart(one, other):
    return one[2] <= other[1] or other[2] <= one[1] or one[3] <= other[4] or other[3] <= one[4]


def nothing_overlaps(picture, pattern):
    places = {(text[0], round(text[1]), round(text[3])): text for text in picture.texts if re.fullmatch(pattern, text[0])}
    texts = list(places.values())
    # A text in a box is there twice.
    for one, other in itertools.combinations(texts, 2):
        assert apart(one, other), f"'{one[0]}' and '{other[0]}' overlap"
    return texts


def inside(picture):
    for words, left, right, low, high in picture.texts:
        assert left > -3 and right < picture.width + 3 and high > -3 and low < picture.height + 3, f"'{words}' is cut"


def shaking_force(picture, positions):
    """Angles with their degree signs at every 30 degrees, forces at all rings, none over another; a smooth curve."""
    inside(picture)
    angles = {text[0] for text in nothing_overlaps(picture, r"[−0-9.]+°|[0-9.]+( [a-zA-Z]+)?")}
    assert {f"{30*k}°" for k in range(12)} <= angles, f"angles: {sorted(angles)}"
    circles = [[x for x, _ in points] for _, _, points in picture.paths if is_circle(points)]
    rings = {round(max(circle) - min(circle)) for circle in circles}
    forces = [name for name in angles if not name.endswith("°")]
    assert len(forces) >= 2 and (not rings or len(rings) == len(forces)), f"{len(rings)} rings, forces: {forces}"
    assert sum(" " in name for name in forces) == 1, f"one ring has the unit: {forces}"
    curve = max((points for colour, width, points in picture.paths if width >= 3), key=len)
    assert len(curve) >= 8*int(positions), f"{len(curve)} points for {positions} positions"
    turns = [turn(*points) for points in zip(curve, curve[1:], curve[2:])]
    assert max(turns) < 20, f"the curve has a corner of {max(turns):.3g} degrees"


def is_circle(points):
    if len(points) < 24 or math.dist(points[0], points[-1]) > 1:
        return False
    centre = [sum(point[k] for point in points[:-1])/(len(points) - 1) for k in (0, 1)]
    radii = [math.dist(centre, point) for point in points]
    return max(radii) < 1.01*min(radii)


def turn(one, two, three):
    first = math.atan2(two[1] - one[1], two[0] - one[0])
    second = math.atan2(three[1] - two[1], three[0] - two[0])
    if math.dist(one, two) < 0.5 or math.dist(two, three) < 0.5:
        return 0
    return abs(math.degrees(math.remainder(second - first, 2*math.pi)))


def forces(picture, poses):
    """Four arrows and one of the shaking force in every pose, and an arrow with the scale."""
    inside(picture)
    blue = [points for colour, points in picture.polygons if colour == (0, 96, 168)]
    red = [points for colour, points in picture.polygons if colour == (192, 64, 0)]
    black = [points for colour, points in picture.polygons if colour == (0, 0, 0)]
    assert len(blue) == 4*int(poses), f"{len(blue)} arrows at pins"
    assert len(red) == int(poses), f"{len(red)} arrows of the shaking force"
    assert len(black) == 1, f"{len(black)} arrows with a scale"
    assert sum(text[0].startswith("θ₂ = ") for text in picture.texts) == int(poses)
    assert any(re.fullmatch(r"[0-9.]+ [a-zA-Z]+", text[0]) for text in picture.texts), "the scale has no unit"


def mode_shape(picture, crank, deck_title):
    """The wall that clamps the crank stands at a right angle to it, and the legend clear of the title."""
    inside(picture)
    walls = [points for colour, points in picture.polygons if colour == (221, 221, 221)]
    assert len(walls) == 1, f"{len(walls)} walls"
    one, other = max(zip(walls[0], walls[0][1:]), key=lambda side: math.dist(*side))
    along = math.degrees(math.atan2(one[1] - other[1], other[0] - one[0]))
    off = math.remainder(along - float(crank) - 90, 180)
    assert abs(off) < 1, f"the wall is {off:.3g} degrees off"
    gap = picture.y_of("undeformed") - picture.y_of(deck_title)
    assert gap > 40, f"the legend is {gap:.3g} pixels below the title"
    frame = max((points for _, _, points in picture.paths if len(points) >= 4 and len({round(x) for x, _ in points}) == 2),
                key=lambda points: max(x for x, _ in points) - min(x for x, _ in points))
    height = max(y for _, y in frame) - min(y for _, y in frame)
    width = max(x for x, _ in frame) - min(x for x, _ in frame)
    shape = [point for colour, line, points in picture.paths if line >= 6 for point in points]
    used = [max(point[k] for point in shape) - min(point[k] for point in shape) for k in (0, 1)]
    assert used[0] > 0.6*width and used[1] > 0.6*height, f"a shape of {used} in a frame of {width} by {height}"
    assert width*height > 0.5*picture.width*picture.height, "the frame is less than half of the page"


def mechanism(picture, arrows):
    """No two arrows begin at one place."""
    inside(picture)
    heads = [points for colour, points in picture.polygons if colour == (0, 96, 168)]
    begins = [points[0] for colour, _, points in picture.paths if colour == (0, 96, 168) and len(points) == 2]
    assert len(heads) == int(arrows) + 1, f"{len(heads)} heads of arrows, the one of the scale among them"
    for one, other in itertools.combinations(begins, 2):
        assert math.dist(one, other) > 2, f"two arrows begin at {one}"
    nothing_overlaps(picture, r"m\d+")


def coupler_curve(picture):
    """The bodies are below the paths, nothing is drawn in grey behind them, and angles stand beside the paths."""
    inside(picture)
    bodies = [k for k, (kind, item) in enumerate(picture.order) if kind == "polygon" and item[0] in
              {(255, 204, 102), (102, 153, 204), (153, 204, 153)}]
    paths = [k for k, (kind, item) in enumerate(picture.order)
             if kind == "path" and item[0] == (204, 51, 51) and len(item[2]) > 100]
    assert bodies and paths, f"{len(bodies)} bodies, {len(paths)} paths"
    assert max(bodies) < min(paths), "a body hides the path"
    assert not any(colour == (176, 176, 176) for colour, _, _ in picture.paths), "other poses are drawn too"
    angles = nothing_overlaps(picture, r"\d+°")
    assert {text[0] for text in angles} >= {"0°", "60°", "120°", "180°", "240°", "300°"}, f"{[text[0] for text in angles]}"


def modes(picture, modes_drawn, cranks):
    inside(picture)
    frequencies = nothing_overlaps(picture, r"[0-9.]+ Hz")
    assert len(frequencies) == int(modes_drawn)*int(cranks), f"{len(frequencies)} frequencies"
    assert sum(bool(re.fullmatch(r"θ₂ = \d+°", text[0])) for text in picture.texts) == int(cranks)


def special_positions(picture):
    inside(picture)
    words = " ".join(text[0] for text in picture.texts)
    assert "largest transmission angle" in words and "smallest transmission angle" in words, words
    assert "transmission most" not in words and "transmission least" not in words and "_" not in words, words


def whole(picture):
    inside(picture)


if __name__ == "__main__":
    try:
        globals()[sys.argv[1]](Picture(sys.argv[2]), *sys.argv[3:])
    except AssertionError as why:
        print(f"{sys.argv[2].rsplit('/', 1)[-1]}: {why}")
        sys.exit(1)
