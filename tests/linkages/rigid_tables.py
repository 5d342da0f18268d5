"""Tables of rigid linkages against those of the same linkage rotated, mirrored, renamed, in other units, with its cards in another order.

    rigid_tables.py SEED COUNT [--program PATH] [--scratch FOLDER] [--smooth]

Four-bars, slider-cranks and six-bars with loads of many kinds, stops and friction, over full turns; mirrored, a stop above a limit of an
angle is one below.  Values with an error column (sizing, equilibrium) differ by the sum of both errors at most; all others (kinematics,
pins, reactions, bearings, frame, drive, shaking, friction, holding, lagrange, balance, harmonics, linkage, coordinates, ratios) by 1e-10
of the largest of their kind.  Coordinates are compared with the pins and links of the same deck, too, their least and greatest values
(linkage) with those of closed forms at many positions and between.  The last lines have, for every report, how many values there were,
the largest difference, and of estimates the shares with a difference beyond 1, 0.1 and 0.01 of the estimate.  --smooth leaves out
friction, damping and loads against the motion: cases are five times faster, and all have an equilibrium.
"""
import argparse
import math
import os
import random
import shutil
import sys
import tempfile

from tables import run

ALLOWED = 1e-10
VECTORS = [("x", "y"), ("vx", "vy"), ("ax", "ay"), ("fx", "fy"), ("shaking_x", "shaking_y"), ("frame_x", "frame_y"), ("xG", "yG"),
           ("Ax", "Ay"), ("Bx", "By"), ("balanced_x", "balanced_y")] + [(pin + "x", pin + "y") for pin in
                                                                       ("O2", "A2", "A3", "B3", "B4", "O4")]
ANGLES = {"theta", "theta3", "theta4"}
# Mirrored, these have the other sign; so have the forces of angular drives.
ODD = {"omega", "omega3", "omega4", "alpha", "alpha3", "alpha4", "moment", "shaking_moment", "frame_moment", "transverse", "torque", "angle",
       "balanced_moment", "balanced_torque", "V", "gravity", "load", "dM", "rate", "position"}


WAY = (0.6, -0.8)                       # of the measure `lift`
ANGULAR = {"lean", "bend"}              # measures that are angles


class Look:
    """How a deck is written: rotated and mirrored, with other names, units and order of cards."""

    def __init__(self, draw=None):
        self.turn, self.sign, self.millimetres, self.renamed, self.shuffled = 0.0, 1, False, False, None
        if draw:
            self.turn, self.sign = round(draw.uniform(-180, 180), 3), draw.choice((1, -1))
            self.millimetres, self.renamed, self.shuffled = draw.random() < 0.5, draw.random() < 0.5, draw.random()

    def place(self, x, y):
        cosine, sine, y = math.cos(math.radians(self.turn)), math.sin(math.radians(self.turn)), self.sign * y
        return x * cosine - y * sine, x * sine + y * cosine

    def angle(self, value):
        return self.sign * value + self.turn

    def name(self, name):
        return "z_" + name[::-1] + name if self.renamed else name

    def length(self, value):
        return f"{value!r}m"


class Linkage:
    """Numbers of a linkage; text(look) is its deck."""

    def __init__(self, seed, smooth=False):
        draw = self.draw = random.Random(seed)
        self.smooth = smooth
        self.kind = draw.choice(("four_bar", "slider_crank", "slider_crank", "six_bar"))
        while True:
            self.a, self.b, self.c, self.d = (draw.uniform(0.1, 1) for _ in range(4))
            sizes = sorted((self.a, self.b, self.c, self.d))
            if self.a == sizes[0] and sizes[0] + sizes[3] < 0.97 * (sizes[1] + sizes[2]) and self.a < 0.9 * sizes[1]:
                break
        self.offset = draw.uniform(-0.3, 0.3) * self.a
        self.rod = (self.a + abs(self.offset)) * draw.uniform(1.3, 4)
        self.bodies = [[draw.uniform(0.2, 3), draw.uniform(0.005, 0.1), draw.uniform(-0.2, 0.6), draw.uniform(-0.2, 0.2)] for _ in range(5)]
        self.gravity = (draw.uniform(-5, 5), draw.uniform(-10, 10)) if draw.random() < 0.6 else None
        self.speed, self.alpha = draw.choice((1, -1)) * draw.uniform(2, 60), draw.choice((0, draw.uniform(-50, 50)))
        self.cranks = [draw.uniform(-180, 180) for _ in range(3)]
        self.rubs = draw.random() < 0.5
        self.force = (draw.uniform(-50, 50), draw.uniform(-50, 50)) if draw.random() < 0.5 else None
        self.torque = draw.uniform(-20, 20) if draw.random() < 0.6 else None
        self.during = draw.choice((None, "with", "against"))
        self.damping = draw.uniform(0, 1) if draw.random() < 0.4 else None
        self.resisting = draw.uniform(0, 5) if draw.random() < 0.3 else None
        self.spring = (draw.uniform(20, 400), draw.uniform(0.1, 1), draw.uniform(-2, 2), draw.uniform(1.5, 3)) if draw.random() < 0.5 else None
        self.pin_mass = draw.uniform(0.1, 1) if draw.random() < 0.4 else None
        self.coefficients = [draw.uniform(0.01, 0.12) for _ in range(4)]
        self.stops = self.draw_stops(draw)
        self.one_sided = self.course = None
        if draw.random() < 0.4:
            self.one_sided = (draw.choice(("push", "pull")), draw.uniform(0, 0.1), draw.uniform(0, 20), draw.uniform(0.01, 0.3))
        if draw.random() < 0.4:
            self.course = (draw.choice(("far", "lift", "bend", "aside")), [draw.uniform(-10, 10) for _ in range(6)])
        if smooth:
            self.stops = [stop[:4] + (0.0,) + stop[5:] for stop in self.stops]
            self.rubs, self.during, self.damping, self.resisting = False, None, None, None

    def coordinates(self, crank):
        """The measures of `measures`, in metres and radians, where the crank has an angle."""
        turn = math.radians(crank)
        a = self.a * math.cos(turn), self.a * math.sin(turn)
        if self.kind == "slider_crank":
            x, y = a[0] + math.sqrt(self.rod**2 - (a[1] - self.offset)**2), self.offset
            lean = math.atan2(y - a[1], x - a[0])
        else:
            # B is to the left of the way from A to Q.
            way = math.dist(a, (self.d, 0.0))
            along = (way**2 + self.b**2 - self.c**2) / (2 * way)
            left = math.sqrt(self.b**2 - along**2)
            cosine, sine = (self.d - a[0]) / way, -a[1] / way
            x, y = a[0] + along * cosine - left * sine, a[1] + along * sine + left * cosine
            lean = math.atan2(y, x - self.d)
            if self.kind == "six_bar":
                x, y = x + math.sqrt((3.5 * self.c)**2 - (y - 1.5 * self.c)**2), 1.5 * self.c
        values = {"far": math.hypot(x, y), "lift": WAY[0] * x + WAY[1] * y, "lean": lean,
                  "bend": (lean - turn + math.pi) % (2 * math.pi) - math.pi,
                  "ahead": x * math.cos(turn) + y * math.sin(turn), "aside": y * math.cos(turn) - x * math.sin(turn)}
        return {**values, "total": 2 * values["far"] - 0.5 * values["lift"]}

    def draw_stops(self, draw):
        """(measure, limit, is below, stiffness, damping, width), SI, for the linkage that is neither rotated nor mirrored."""
        stops, found = [], [self.coordinates(5 * k) for k in range(72)]
        for _ in range(draw.choice((0, 1, 1, 2, 3))):
            name = draw.choice(("far", "lift", "total", "ahead", "aside", "lean"))
            low, high = (end(place[name] for place in found) for end in (min, max))
            if high - low > (3.0 if name == "lean" else math.inf) or high - low < 1e-3:
                continue
            stiffness = 10**(draw.uniform(0, 2) if name == "lean" else draw.uniform(1, 3.5))
            stops.append((name, low + draw.uniform(0.1, 0.9) * (high - low), draw.random() < 0.5, stiffness,
                          draw.choice((0.0, stiffness * 10**draw.uniform(-4, -2))), (high - low) * 10**draw.uniform(-2, -0.3)))
        return stops

    def stop_cards(self, look):
        """Mirrored, `aside` and `lean` have the other sign."""
        for number, (name, limit, is_below, stiffness, damping, width) in enumerate(self.stops):
            sign = look.sign if name in ("aside", "lean") else 1
            below = " below" if is_below == (sign > 0) else ""
            if name == "lean":
                limit = f"{look.angle(math.degrees(limit))!r}deg"
                keys = f"stiffness={stiffness!r}N*m/rad damping={damping!r}N*m*s/rad contact={width!r}rad"
            else:
                limit = look.length(sign * limit)
                keys = f"stiffness={stiffness!r}N/m damping={damping!r}N*s/m contact={look.length(width)}"
            yield f"STOP {look.name(f'stop{number}')} {look.name(name)} limit={limit} {keys}{below}"

    def course_cards(self, look, out):
        """A torque by a table over a measure."""
        name, values = self.course
        found = [self.coordinates(5 * k)[name] for k in range(72)]
        low, high = min(found), max(found)
        low, high = (-math.pi, math.pi) if name == "bend" else (low - 0.2 * (high - low), high + 0.2 * (high - low))
        places = [low + k * (high - low) / 5 for k in range(6)]
        sign = look.sign if name in ("aside", "bend") else 1
        if name == "bend":
            places, values = [math.degrees(place) for place in places], values[:5] + values[:1]
        rows = sorted((sign * place, look.sign * value) for place, value in zip(places, values))
        factor = 1000 if look.millimetres and name != "bend" else 1
        unit = "deg" if name == "bend" else "mm" if look.millimetres else "m"
        yield f"TABLE {look.name('course')} {unit} N*m " + " ".join(f"{place * factor!r} {value!r}" for place, value in rows)
        yield f"TORQUE {look.name(out)} table={look.name('course')} over={look.name(name)}"

    def measures(self, look, out, last):
        """MEASURE cards, of lengths but for two."""
        forms = [f"far distance O {last}", f"ahead along {last} crank", f"aside across {last} crank", f"lean angle {out}",
                 f"bend angle {out} against crank"]
        words = {"distance", "along", "across", "angle", "against"}
        for form in forms:
            yield "MEASURE " + " ".join(word if word in words else look.name(word) for word in form.split())
        yield "MEASURE {} travel {} {!r} {!r}".format(look.name("lift"), look.name(last), *look.place(*WAY))
        yield f"MEASURE {look.name('total')} sum 2 {look.name('far')} -0.5 {look.name('lift')}"

    def reports(self):
        """Those that a deck may have."""
        reports = ["kinematics", "pins", "reactions", "bearings", "frame about=0,0", "lagrange", "linkage format=linkage", "balance",
                   "sizing fluctuation=0.05"]
        if self.kind == "four_bar":
            reports.remove("pins")
        else:
            reports.append("drive")
        if self.rubs:
            reports.append("friction")
        elif not (self.during and self.torque) and not self.resisting and not self.damping:
            reports.append("equilibrium")
        return reports

    def text(self, look):
        name, length = look.name, look.length
        cards = []

        def pivot(pin, x, y):
            x, y = look.place(x, y)
            cards.append(f"GROUND {name(pin)} {length(x)} {length(y)}")

        def link(number, card, *pins, size):
            mass, inertia, along, offset = self.bodies[number]
            cards.append(f"LINK {name(card)} {name(pins[0])} {name(pins[1])} length={length(size)} mass={mass!r}kg inertia={inertia!r}kg*m2"
                         f" center={length(along)},{length(look.sign * offset)}")

        pivot("O", 0.0, 0.0)
        link(0, "crank", "O", "A", size=self.a)
        last, out = "B", "rocker"
        if self.kind == "slider_crank":
            x, y = look.place(0.0, self.offset)
            cards.append(f"GUIDE {name('bed')} {length(x)} {length(y)} angle={look.turn!r}deg")
            link(1, "rod", "A", "B", size=self.rod)
            cards += [f"SLIDER {name('B')} {name('bed')} mass=0.7kg", f"BRANCH {name('B')} forward"]
            out = "rod"
        else:
            pivot("Q", self.d, 0.0)
            link(1, "coupler", "A", "B", size=self.b)
            link(2, "rocker", "Q", "B", size=self.c)
            if self.kind == "four_bar":
                cards.append("BRANCH " + ("open" if look.sign > 0 else "crossed"))
            else:
                cards.append(f"BRANCH {name('B')} {'left' if look.sign > 0 else 'right'} {name('A')} {name('Q')}")
                x, y = look.place(0.0, 1.5 * self.c)
                cards.append(f"GUIDE {name('bed')} {length(x)} {length(y)} angle={look.turn!r}deg")
                link(3, "rod", "B", "E", size=3.5 * self.c)
                cards += [f"SLIDER {name('E')} {name('bed')} mass=0.7kg", f"BRANCH {name('E')} forward"]
                last = "E"
        cards.append(f"DRIVE {name('crank')}")
        if self.gravity:
            cards.append("GRAVITY {!r}m/s2 {!r}m/s2".format(*look.place(*self.gravity)))
        if self.force:
            cards.append("FORCE {} {!r}N {!r}N".format(name(last), *look.place(*self.force)))
        if self.pin_mass and self.kind != "four_bar":
            cards.append(f"PINMASS {name(last)} {self.pin_mass!r}kg")
        if self.torque:
            cards.append(f"TORQUE {name(out)} {look.sign * self.torque!r}N*m" + (f" during={self.during} smooth=0.5rad/s" if self.during else ""))
        if self.damping or self.resisting:
            cards.append(f"LOAD {name(out)} damping={self.damping or 0.0!r}N*m*s resisting={self.resisting or 0.0!r}N*m smooth=0.5rad/s")
        if self.spring:
            stiffness, free, x, y = self.spring
            pivot("S", x, y)
            cards.append(f"SPRING {name('coil')} {name('S')} {name(last)} stiffness={stiffness!r}N/m free_length={length(free)}")
            if self.one_sided:
                side, gap, damping, width = self.one_sided
                cards[-1] += f" only={side} gap={length(gap)} damping={0.0 if self.smooth else damping!r}N*s/m contact={length(width)}"
        cards += self.measures(look, out, last)
        cards += self.stop_cards(look)
        if self.course and not self.torque:
            cards += self.course_cards(look, out)
        if self.rubs:
            cards.append(f"FRICTION {name('O')} radius=0.02m coefficient={self.coefficients[0]!r} smooth=0.5rad/s")
            if self.kind != "four_bar":
                cards.append(f"FRICTION {name(last)} {name('bed')} coefficient={self.coefficients[1]!r} smooth=0.05m/s")
            second = "rod" if self.kind == "slider_crank" else "coupler"
            cards.append(f"FRICTION {name('A')} {name(second)} {name('crank')} radius=0.01m coefficient={self.coefficients[2]!r} smooth=0.5rad/s")
        if look.shuffled is not None:
            pinned = [card for card in cards if not card.startswith("FRICTION")]
            random.Random(look.shuffled).shuffle(pinned)
            cards = pinned + [card for card in cards if card.startswith("FRICTION")]
        units = "mm kg s" if look.millimetres else "m kg s"
        cards = [f"UNITS {units} force=N torque=N*m energy=J"] + cards
        cards.append("CRANK " + " ".join(repr(look.angle(crank)) for crank in self.cranks))
        cards.append(f"SPEED {look.sign * self.speed!r} alpha={look.sign * self.alpha!r}")
        cards.append("INERTIA distributed")
        reports = self.reports() + [f"coordinates ratio_to={name('far')}"]
        return "\n".join(cards + ["REPORT " + report for report in reports]) + "\n"


def in_metres(table, column, value):
    """Of units with the millimetre."""
    unit = table.units.get(column, "")
    if unit == "mm" or unit.startswith("mm/"):
        return value * 1e-3
    return value * 1e-6 if "mm2" in unit or "mm^2" in unit else value


class Comparison:
    """Differences by report."""

    def __init__(self):
        self.largest, self.number, self.shares, self.wrong = {}, {}, {}, []

    def plain(self, report, where, one, other, scale):
        difference = abs(one - other) / scale if scale else abs(one - other)
        self.number[report] = self.number.get(report, 0) + 1
        self.largest[report] = max(self.largest.get(report, 0.0), difference)
        if not difference <= ALLOWED:
            self.wrong.append(f"{report}: {where}: {one!r}, {other!r}, {difference:.1e} of the largest")

    def estimated(self, report, where, one, other, error):
        share = abs(one - other) / error if error else (0.0 if one == other else math.inf)
        self.shares.setdefault(report, []).append(share)
        if not share <= 1:
            self.wrong.append(f"{report}: {where}: {one!r}, {other!r} differ by {share:.3g} errors")


def turned_back(look, row, name):
    """A row as of the linkage that is neither rotated nor mirrored."""
    row = dict(row)
    for x, y in VECTORS:
        if x in row and y in row and not (name == "linkage" or isinstance(row[x], str)):
            cosine, sine = math.cos(math.radians(look.turn)), math.sin(math.radians(look.turn))
            u, v = row[x] * cosine + row[y] * sine, row[y] * cosine - row[x] * sine
            row[x], row[y] = u, look.sign * v
    for column in row:
        if column in ANGLES:
            row[column] = look.sign * (row[column] - look.turn)
        elif column in ODD:
            row[column] = look.sign * row[column]
    if name == "drive":
        row["force"] *= look.sign                         # all are torques
    if name == "friction" and row["moment"] != 0:
        row["sliding"] *= look.sign
    return row


def rows_of(look, table, name):
    """Rows by position and names, in the terms of the plain deck, in metres."""
    found = {}
    for row in table.rows:
        row = {column: in_metres(table, column, value) if isinstance(value, float) else value for column, value in row.items()}
        row = turned_back(look, row, name)
        crank = ""
        if "crank" in row:
            crank = round((look.sign * (row["crank"] - look.turn)) % 360, 6) % 360
        key = (crank,) + tuple(value for column, value in row.items() if isinstance(value, str) and column != "verdict")
        found[key] = row
    return found


def compare_plain(comparison, name, look, one, other):
    """Tables without an error column."""
    first, second = rows_of(Look(), one, name), rows_of(look, other, name)
    second = {tuple(plain_name(look, part) if isinstance(part, str) else part for part in key): row for key, row in second.items()}
    if set(first) != set(second):
        comparison.wrong.append(f"{name}: rows {sorted(map(str, set(first) ^ set(second)))[:2]}")
        return
    scales = {}
    for row in list(first.values()):
        for column, value in row.items():
            if isinstance(value, float):
                kind = one.units.get(column, column)
                scales[kind] = max(scales.get(kind, 0.0), abs(value))
    for key, row in first.items():
        for column, value in row.items():
            if column in ("crank", "speed") or (name == "drive" and column == "position") or not isinstance(value, float):
                if column == "verdict" and value != second[key][column]:
                    comparison.wrong.append(f"{name}: {key} verdict {value} {second[key][column]}")
                continue
            got = second[key][column]
            if column in ANGLES or column == "angle":
                comparison.plain(name, f"{key} {column}", (value - got + 180) % 360 - 180, 0.0, 180)
            else:
                comparison.plain(name, f"{key} {column}", value, got, scales[one.units.get(column, column)])


def plain_name(look, text):
    if look.renamed and text.startswith("z_"):
        body = text[2:]
        return body[len(body) // 2:]
    return text


def coordinates_of(look, table):
    """Rows of coordinates.dat or ratios.dat by position and name, in the terms of the plain deck, in metres."""
    found = {}
    for row in table.rows:
        name = plain_name(look, row["coordinate"])
        length = 1e-3 if look.millimetres else 1.0
        if name in ANGULAR:
            sign, factor = look.sign, {"ratio": 1/length}
        else:
            sign, factor = look.sign if name == "aside" else 1, {"value": length, "rate": length, "acceleration": length}
        values = {column: sign*value*factor.get(column, 1.0) for column, value in row.items() if column not in ("speed", "crank", "coordinate")}
        if name == "lean" and "value" in values:
            values["value"] -= look.sign*look.turn
        if name in ANGULAR and "value" in values:
            values["value"] = (values["value"] + 180) % 360 - 180
        if "power" in values:
            values["power"] *= sign
        found[round((look.sign*(row["crank"] - look.turn)) % 360, 6) % 360, name] = values
    return found


def compare_coordinates(comparison, name, look, one, other):
    """Those of both decks."""
    first, second = coordinates_of(Look(), one), coordinates_of(look, other)
    if set(first) != set(second):
        comparison.wrong.append(f"{name}: rows {sorted(map(str, set(first) ^ set(second)))[:2]}")
        return
    scales = {}
    for (_, coordinate), row in first.items():
        for column, value in row.items():
            kind = coordinate in ANGULAR, column
            scales[kind] = max(scales.get(kind, 0.0), abs(value))
    for key, row in first.items():
        for column, value in row.items():
            got, kind = second[key][column], (key[1] in ANGULAR, column)
            if kind == (True, "value"):
                comparison.plain(name, f"{key} {column}", (value - got + 180) % 360 - 180, 0.0, 180)
            else:
                comparison.plain(name, f"{key} {column}", value, got, scales[kind])


def compare_with_pins(comparison, linkage, tables):
    """The coordinates of a plain deck with its pins and links."""
    rows, last = coordinates_of(Look(), tables["coordinates"]), "B" if linkage.kind == "slider_crank" else "E"
    pins, links = ({(round(row["crank"] % 360, 6) % 360, row[what]): row for row in tables[table].rows}
                   for table, what in (("pins", "pin"), ("kinematics", "link")))
    fields = "value", "rate", "acceleration"
    expected = {}
    for crank in {key[0] for key in rows}:
        x, v, a = ([pins[crank, last][column + axis] for axis in "xy"] for column in ("", "v", "a"))
        crank_link, out = links[crank, "crank"], links[crank, "rod" if linkage.kind == "slider_crank" else "rocker"]
        expected[crank, "far"] = distance_of(x, v, a)
        expected[crank, "lift"] = [WAY[0]*u[0] + WAY[1]*u[1] for u in (x, v, a)]
        expected[crank, "total"] = [2*far - 0.5*lift for far, lift in zip(expected[crank, "far"], expected[crank, "lift"])]
        expected[crank, "lean"] = [out["theta"], out["omega"], out["alpha"]]
        expected[crank, "bend"] = [out[column] - crank_link[column] for column in ("theta", "omega", "alpha")]
        expected[crank, "ahead"], expected[crank, "aside"] = turning_axes(x, v, a, crank_link)
        if linkage.spring:
            stiffness, free, *end = linkage.spring
            expected[crank, "coil"] = distance_of([x[0] - end[0], x[1] - end[1]], v, a)
            if not linkage.one_sided:
                comparison.plain("coordinates by pins", f"{crank} coil effort", rows[crank, "coil"]["effort"],
                                 -stiffness*(expected[crank, "coil"][0] - free), stiffness)
    scales = [max(abs(values[k]) for values in expected.values()) for k in range(3)]
    for key, values in expected.items():
        for k, field in enumerate(fields):
            difference = rows[key][field] - values[k]
            if key[1] in ANGULAR and k == 0:
                difference = (difference + 180) % 360 - 180
            comparison.plain("coordinates by pins", f"{key} {field}", difference, 0.0, scales[k])


def coordinate_functions(linkage):
    """The coordinates of a plain deck as functions of the crank in degrees, in closed form, angles in degrees."""
    def meeting(one, r, other, s):
        """Where circles meet, to the left of the way from one centre to the other."""
        size = math.dist(one, other)
        x = (size**2 + r**2 - s**2)/(2*size)
        y, u, v = math.sqrt(r**2 - x**2), (other[0] - one[0])/size, (other[1] - one[1])/size
        return one[0] + x*u - y*v, one[1] + x*v + y*u

    def on_line(point, rod, height):
        return point[0] + math.sqrt(rod**2 - (height - point[1])**2), height

    def places(crank):
        """The last pin, and the ends of the link whose angle is measured."""
        point = linkage.a*math.cos(math.radians(crank)), linkage.a*math.sin(math.radians(crank))
        if linkage.kind == "slider_crank":
            block = on_line(point, linkage.rod, linkage.offset)
            return block, point, block
        joint = meeting(point, linkage.b, (linkage.d, 0.0), linkage.c)
        last = joint if linkage.kind == "four_bar" else on_line(joint, 3.5*linkage.c, 1.5*linkage.c)
        return last, (linkage.d, 0.0), joint

    def lean(crank):
        _, one, other = places(crank)
        return math.degrees(math.atan2(other[1] - one[1], other[0] - one[0]))

    def of_last(function):
        return lambda crank: function(*places(crank)[0], math.radians(crank))

    functions = {"far": of_last(lambda x, y, _: math.hypot(x, y)), "lift": of_last(lambda x, y, _: WAY[0]*x + WAY[1]*y),
                 "total": of_last(lambda x, y, _: 2*math.hypot(x, y) - 0.5*(WAY[0]*x + WAY[1]*y)),
                 "ahead": of_last(lambda x, y, t: x*math.cos(t) + y*math.sin(t)),
                 "aside": of_last(lambda x, y, t: y*math.cos(t) - x*math.sin(t)), "lean": lean, "bend": lambda crank: lean(crank) - crank}
    if linkage.spring:
        functions["coil"] = of_last(lambda x, y, _: math.dist((x, y), linkage.spring[2:]))
    return functions


def extremes_of(function, is_angle):
    """The least and the greatest value over a turn, and how much it has changed by then: by golden sections about the samples."""
    steps, golden = 1000, (math.sqrt(5) - 1)/2
    near = function(0.0)

    def followed(crank):
        value = function(crank)
        return value - 360*round((value - near)/360) if is_angle else value

    values = []
    for i in range(steps + 1):
        values.append(followed(360*i/steps))
        near = values[-1]
    found = []
    for sign in (1, -1):
        i = min(range(steps + 1), key=lambda k: sign*values[k])
        near, low, high = values[i], 360*(i - 1)/steps, 360*(i + 1)/steps
        while high - low > 1e-7:
            one, other = high - golden*(high - low), low + golden*(high - low)
            low, high = (low, other) if sign*followed(one) < sign*followed(other) else (one, high)
        found.append(followed((low + high)/2))
    return found[0], found[1], values[-1] - values[0]


def compare_extremes(comparison, linkage, look, one, other):
    """Least and greatest values of coordinates, of the plain deck against closed forms, and of both."""
    rows, others = ({(plain_name(how, row["part"]), row["quantity"]): row for row in table.rows}
                    for how, table in ((Look(), one), (look, other)))
    number = 0
    for name, function in coordinate_functions(linkage).items():
        is_angle = name in ANGULAR
        least, greatest, turned = extremes_of(function, is_angle)
        scale = 180.0 if is_angle else max(abs(least), abs(greatest))
        if is_angle and abs(turned) > 180:
            for given in (rows, others):
                comparison.plain("linkage", f"{name} gain", given[name, "gain"]["value"], turned, 360)
            continue
        number += 1
        for quantity, value in (("least_value", least), ("greatest_value", greatest), ("span", greatest - least)):
            row, again = rows[name, quantity], others[name, quantity]
            difference = row["value"] - value
            if is_angle and quantity != "span":
                difference = (difference + 180) % 360 - 180
            comparison.plain("linkage", f"{name} {quantity}", difference, 0.0, scale)
            if quantity == "span":
                comparison.plain("linkage", f"{name} {quantity}", value, again["value"]*(1e-3 if again["unit"] == "mm" else 1), scale)
                continue
            difference = function(row["crank"]) - row["value"]
            comparison.plain("linkage", f"{name} at {quantity}", (difference + 180) % 360 - 180 if is_angle else difference, 0.0, scale)
    if sum(quantity == "span" for _, quantity in rows) != number:
        comparison.wrong.append("linkage: rows of coordinates")


def distance_of(x, v, a):
    """The distance from the origin, its rate and acceleration."""
    size = math.hypot(*x)
    rate = (x[0]*v[0] + x[1]*v[1])/size
    return [size, rate, (x[0]*a[0] + x[1]*a[1] + v[0]**2 + v[1]**2 - rate**2)/size]


def turning_axes(x, v, a, link):
    """A place, velocity and acceleration along a link from the origin, and to the left of it, as seen from the link."""
    cosine, sine = math.cos(math.radians(link["theta"])), math.sin(math.radians(link["theta"]))
    along, left = ([u[0]*cosine + u[1]*sine for u in (x, v, a)], [u[1]*cosine - u[0]*sine for u in (x, v, a)])
    w, h = link["omega"], link["alpha"]
    seen = [along[1] + w*left[0], left[1] - w*along[0]]
    return ([along[0], seen[0], along[2] + h*left[0] + 2*w*seen[1] + w**2*along[0]],
            [left[0], seen[1], left[2] - h*along[0] - 2*w*seen[0] + w**2*left[0]])


def compare_sizing(comparison, look, one, other):
    """Errors are shares of the peak of the part; of a flywheel of the value."""
    first, second = ({(plain_name(how, row["part"]), plain_name(how, row["pin"]), row["quantity"]): row for row in table.rows}
                     for how, table in ((Look(), one), (look, other)))
    if set(first) != set(second):
        comparison.wrong.append(f"sizing: rows {sorted(set(first) ^ set(second))[:2]}")
        return
    peaks = {key[:2]: abs(row["value"]) for key, row in first.items() if key[2].startswith("peak_") and key[2] != "peak_power"}
    drive = next(value for key, value in peaks.items() if key[1] == "-")
    largest = max([value for key, value in peaks.items() if key[1] != "-"])
    for key, row in first.items():
        part, _, quantity = key
        value, got, other_row = row["value"], second[key]["value"], second[key]
        if quantity in ("peak_torque", "mean_torque", "rate", "angle_at_peak"):
            got *= look.sign
        if quantity == "rate":
            continue
        if other_row["unit"] == "kg.mm2":
            got *= 1e-6
        error = row["error"] + other_row["error"]
        if quantity == "angle_at_peak":
            comparison.estimated("sizing angle", f"{key}", (value - got + 180) % 360 - 180, 0.0, error)
            continue
        if part == "flywheel":
            scale, rounding = (drive if quantity == "mean_torque" else abs(value)), 0.0
            report = "sizing flywheel"
        else:
            scale, rounding, report = peaks[key[:2]], 1e-13 * max(largest, drive), "sizing"
            if "power" in quantity:
                scale, rounding = scale * abs(first[key[:2] + ("rate",)]["value"]), rounding * abs(first[key[:2] + ("rate",)]["value"])
        comparison.estimated(report, f"{key}", value, got, error * scale + rounding)


def compare_equilibrium(comparison, look, one, other):
    """Rests by their places; frequencies by their relative errors."""
    first, second = rows_of(Look(), one, "equilibrium"), rows_of(look, other, "equilibrium")
    if len(first) != len(second):
        comparison.wrong.append(f"equilibrium: {len(first)} and {len(second)} rests")
        return
    for key, row in first.items():
        match = min(second, key=lambda there: abs((there[0] - key[0] + 180) % 360 - 180))
        got = second[match]
        if got["verdict"] != row["verdict"]:
            comparison.wrong.append(f"equilibrium: {key}: {row['verdict']}, {got['verdict']}")
        comparison.estimated("equilibrium", f"{key} frequency", row["frequency"], got["frequency"],
                             (row["error"] + got["error"]) * row["frequency"])


def check(linkage, seed, program, folder, comparison):
    """A linkage and another look of it."""
    look, tables = Look(random.Random(f"look {seed}")), []
    for number, how in enumerate((Look(), look)):
        path = os.path.join(folder, f"rigid_{number}.deck")
        with open(path, "w", encoding="utf-8") as file:
            file.write(linkage.text(how))
        tables.append(run(program, path, os.path.join(folder, f"out_{number}")))
    if set(tables[0]) != set(tables[1]):
        raise RuntimeError("other tables")
    for name, table in tables[0].items():
        other = tables[1][name]
        if table.failed or other.failed:
            if bool(table.failed) != bool(other.failed):
                comparison.wrong.append(f"{name}: {(table.failed + other.failed)[0]}")
        elif name == "sizing":
            compare_sizing(comparison, look, table, other)
        elif name == "equilibrium":
            compare_equilibrium(comparison, look, table, other)
        elif name in ("coordinates", "ratios"):
            compare_coordinates(comparison, name, look, table, other)
        elif name in ("kinematics", "pins", "reactions", "bearings", "frame", "drive", "shaking", "friction", "lagrange", "balance"):
            compare_plain(comparison, name, look, table, other)
    compare_extremes(comparison, linkage, look, tables[0]["linkage"], tables[1]["linkage"])
    if linkage.kind != "four_bar" and not tables[0]["coordinates"].failed:
        compare_with_pins(comparison, linkage, tables[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_rigid"))
    parser.add_argument("--smooth", action="store_true")
    options = parser.parse_args()
    comparison, passed, failed = Comparison(), 0, 0
    for seed in range(options.seed, options.seed + options.count):
        folder = os.path.join(options.scratch, f"seed_{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        comparison.wrong = []
        try:
            check(Linkage(seed, options.smooth), seed, options.program, folder, comparison)
        except (RuntimeError, ValueError, KeyError, OSError, StopIteration) as failure:
            comparison.wrong.append(repr(failure))
        if comparison.wrong:
            failed += 1
            print(f"seed {seed}: {comparison.wrong[0]}" + (f" and {len(comparison.wrong) - 1} more: " + "; ".join(comparison.wrong[1:4]) if comparison.wrong[1:] else "")
                  + f" ({folder})", flush=True)
            continue
        passed += 1
        shutil.rmtree(folder)
    for report in sorted(comparison.number):
        print(f"{report}: {comparison.number[report]} values, at most {comparison.largest[report]:.1e} of the largest")
    for report, shares in sorted(comparison.shares.items()):
        beyond = [sum(share > limit for share in shares) / len(shares) for limit in (1, 0.1, 0.01)]
        print(f"{report}: {len(shares)} values; beyond 1, 0.1, 0.01 of the estimate: " + ", ".join(f"{share:.2%}" for share in beyond))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
