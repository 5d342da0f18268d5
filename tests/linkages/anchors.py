"""Linkages with closed forms, in 50 digits, and published numbers, against the tables of the program.

    anchors.py [--program PATH] [--scratch FOLDER] [--pendulum]

Decks are in decks/.  Positions are closed forms of circles and lines here, velocities and accelerations their differences (with
50 digits these are exact to the digits of the tables).  A line for every deck with its largest differences; exit 1 if one is too
large.
--pendulum prints the motion of a two-link pendulum, integrated in decimals, and needs no program.
"""
import argparse
import os
import sys
import tempfile
from decimal import Decimal as D

import compare
from decks import Deck
from fields import Digits
from tables import run

HERE = os.path.dirname(os.path.abspath(__file__))
H = D("1e-11")


# closed forms: points are pairs

def on_circle(center, radius, angle):
    return center[0] + radius * Digits.cos(angle), center[1] + radius * Digits.sin(angle)


def distance(one, other):
    return ((one[0] - other[0])**2 + (one[1] - other[1])**2).sqrt()


def meet(one, radius, other, radius2, left):
    """The intersection of two circles, to the left of the way from one center to the other."""
    length = distance(one, other)
    x = (length**2 + radius**2 - radius2**2) / (2 * length)
    y = (radius**2 - x**2).sqrt() * (1 if left else -1)
    ex, ey = (other[0] - one[0]) / length, (other[1] - one[1]) / length
    return one[0] + x * ex - y * ey, one[1] + x * ey + y * ex


def is_left(point, one, other):
    return (other[0] - one[0]) * (point[1] - one[1]) > (other[1] - one[1]) * (point[0] - one[0])


def direction(one, other):
    return Digits.arctan2(other[1] - one[1], other[0] - one[0])


def derive(function, angle):
    """Value, first and second derivative of a function whose values are tuples."""
    before, here, after = function(angle - H), function(angle), function(angle + H)
    return (here, tuple((a - b) / (2 * H) for a, b in zip(after, before)),
            tuple((a - 2 * h + b) / H**2 for a, h, b in zip(after, here, before)))


class Anchor:
    """Tables of a deck, and the largest differences from what is expected, by kind."""

    def __init__(self, name, options):
        self.name = name
        path = os.path.join(HERE, "decks", name + ".deck")
        with open(path, encoding="utf-8") as file:
            self.deck = Deck(file.read())
        self.tables = compare.long_tables(self.deck, run(options.program, path, options.scratch))
        self.largest, self.wrong = {}, []
        self.rate = self.deck.speeds[0] * self.deck.speed_factor()
        self.units = self.deck.units.results

    def rows(self, table, *names):
        """(crank in radians, {names: row}) for every position of the deck."""
        found = {}
        for row in self.tables[table].rows:
            found.setdefault(f"{row['crank'] + 0.0:.9g}", {})[tuple(row[name] for name in names)] = row
        for crank in self.deck.cranks:
            yield crank * Digits.pi / 180, found[f"{float(crank) + 0.0:.9g}"]

    def add(self, kind, value, expected, scale, tolerance, where):
        difference = float(abs(D(value) - expected) / D(scale))
        self.largest[kind] = max(self.largest.get(kind, 0.0), difference)
        if not difference <= tolerance:
            self.wrong.append(f"{kind}: {where} is {value!r}, not {float(expected)!r} ({difference:.1e})")

    def angle(self, value, expected, tolerance, where, kind="angle"):
        """An angle in degrees of a table, one in radians expected."""
        difference = D(value) * Digits.pi / 180 - expected
        difference -= (difference / (2 * Digits.pi)).to_integral_value() * 2 * Digits.pi
        self.add(kind, difference, D(0), 1, tolerance, where)

    def motion_of_pins(self, functions, size, tolerance=1e-14):
        """Functions from the crank angle [rad] to the place [SI] of a pin, against pins.dat."""
        alpha = self.deck.alpha()
        for crank, rows in self.rows("pins", "pin"):
            for pin, function in functions.items():
                row = rows[(pin,)]
                place, first, second = derive(function, crank)
                speed = max(max(map(abs, first)), D(size)) * abs(self.rate)
                force = max(max(map(abs, second)), D(size)) * self.rate**2 + abs(alpha) * D(size)
                for k, axis in enumerate("xy"):
                    where = f"{axis} of {pin} at {float(crank):.4f}"
                    length = self.units["length"]
                    self.add("position", row[axis], place[k] / length, D(size) / length, tolerance, where)
                    if self.rate:
                        self.add("velocity", row["v" + axis], first[k] * self.rate / self.units["rate"],
                                 speed / self.units["rate"], 5 * tolerance, "v" + where)
                        self.add("acceleration", row["a" + axis], (second[k] * self.rate**2 + first[k] * alpha)
                                 / self.units["acceleration"], force / self.units["acceleration"], 50 * tolerance, "a" + where)

    def motion_of_links(self, functions, tolerance=1e-14):
        """Functions from the crank angle to the angle of a link, in radians, against kinematics.dat."""
        alpha = self.deck.alpha()
        for crank, rows in self.rows("kinematics", "link"):
            for link, function in functions.items():
                row = rows[(link,)]
                (angle,), (first,), (second,) = derive(lambda crank, f=function: (f(crank),), crank)
                self.angle(row["theta"], angle, tolerance, f"angle of {link} at {float(crank):.4f}")
                if self.rate:
                    self.add("omega", row["omega"], first * self.rate / self.units["speed"],
                             abs(self.rate) / self.units["speed"], 5 * tolerance, f"omega of {link} at {float(crank):.4f}")
                    self.add("alpha", row["alpha"], second * self.rate**2 + first * alpha, self.rate**2 + abs(alpha),
                             50 * tolerance, f"alpha of {link} at {float(crank):.4f}")

    def report(self):
        try:
            more = compare.with_solver(self.deck, self.tables, "reactions" in self.tables)
            kinds = [kind for kind in ("force", "power", "energy", "closure") if more.get(kind)]
            self.largest.update({"solver:" + kind: more[kind] for kind in kinds})
        except compare.Wrong as wrong:
            self.wrong.append(f"solver: {wrong}")
        shown = " ".join(f"{name} {value:.1e}" for name, value in sorted(self.largest.items()))
        print(f"{'FAILED' if self.wrong else 'passed'} {self.name}: {shown}")
        for line in self.wrong[:4]:
            print("   ", line)
        return not self.wrong


def engine(options):
    """Slider-crank; massless links and two lumps, so that the rod carries forces along itself only."""
    anchor = Anchor("engine", options)
    r, rod, mass_a, mass_b = D("0.045"), D("0.145"), D("0.31"), D("0.42")
    alpha, rate = anchor.deck.alpha(), anchor.rate

    def a(crank):
        return on_circle((0, 0), r, crank)

    def b(crank):
        x, y = a(crank)
        return D(0), y + (rod**2 - x**2).sqrt()

    anchor.motion_of_pins({"A": a, "B": b}, D("0.145"))
    anchor.motion_of_links({"rod": lambda crank: direction(a(crank), b(crank)), "crank": lambda crank: crank})
    drives = dict(anchor.rows("drives", "drive"))
    for crank, rows in anchor.rows("reactions", "pin", "link"):
        acceleration = {pin: tuple(s * rate**2 + f * alpha for f, s in zip(*derive(place, crank)[1:]))
                        for pin, place in (("A", a), ("B", b))}
        (ax, ay), (_, by) = a(crank), b(crank)
        along = mass_b * acceleration["B"][1] * rod / (by - ay)         # of the rod on B
        x, y = -along * ax / rod, along * (by - ay) / rod
        px, py = (-mass_a * acceleration["A"][k] - (x, y)[k] for k in (0, 1))
        forces = {("B", "rod"): (-x, -y), ("A", "rod"): (x, y), ("B", "bore"): (-x, D(0)), ("A", "crank"): (px, py),
                  ("O2", "crank"): (-px, -py)}
        scale = max(abs(value) for force in forces.values() for value in force)
        for key, force in forces.items():
            for axis, value in zip("xy", force):
                where = f"f{axis} on {key[1]} at {key[0]}, {float(crank):.4f}"
                anchor.add("force", rows[key]["f" + axis], value, scale, 1e-13, where)
        torque = drives[crank][("crank",)]["force"]
        anchor.add("torque", torque, ay * px - ax * py, scale * r, 1e-13, f"torque at {float(crank):.4f}")
    return anchor.report()


def quick_return(options):
    """Whitworth: the lever's angle, and the ram by a circle and a line."""
    anchor = Anchor("quick_return", options)
    pivot = (D(0), D("-0.15"))

    def a(crank):
        return on_circle((0, 0), D("0.06"), crank)

    def c(crank):
        return on_circle(pivot, D("0.32"), direction(pivot, a(crank)))

    def d(crank):
        x, y = c(crank)
        return x + (D("0.12")**2 - (D("0.14") - y)**2).sqrt(), D("0.14")

    anchor.motion_of_pins({"A": a, "C": c, "D": d}, D("0.32"))
    anchor.motion_of_links({"lever": lambda crank: direction(pivot, a(crank)), "rod": lambda crank: direction(c(crank), d(crank))})
    return anchor.report()


def pumping_unit(options):
    """The beam's end: its stroke, and the torque by virtual work."""
    anchor = Anchor("pumping_unit", options)
    inch = D("0.0254")
    shaft, saddle = (D(0), 41 * inch), (64 * inch, 116 * inch)

    def e(crank):
        return meet(on_circle(shaft, 24 * inch, crank), D("74.5") * inch, saddle, 64 * inch, True)

    def w(crank):
        return on_circle(saddle, 72 * inch, direction(e(crank), saddle))

    anchor.motion_of_pins({"E": e, "W": w}, 72 * inch)
    heights = [rows[("W",)]["y"] for _, rows in anchor.rows("pins", "pin")]
    anchor.add("stroke", max(heights) - min(heights), D("54.16"), 54, 1e-4, "rise of W (54 in in the unit's name)")
    for crank, rows in anchor.rows("drives", "drive"):
        lift = derive(w, crank)[1][1] / inch
        anchor.add("torque", rows[("crank",)]["force"], 8000 * lift, 8000 * 24, 1e-13, f"torque at {float(crank):.4f}")
    return anchor.report()


def drawn_places(anchor):
    return {**anchor.deck.grounds, **anchor.deck.pins}


def jansen_drawn(options):
    """Jansen's linkage: five dyads on the sides of the drawing; the foot as Pyslvs has it."""
    anchor = Anchor("jansen_drawn", options)
    at = drawn_places(anchor)
    order = (("P3", "P1", "P2"), ("P4", "P2", "P3"), ("P5", "P1", "P2"), ("P6", "P4", "P5"), ("P7", "P5", "P6"))

    def place(name, crank):
        known = {"P2": at["P2"], "P1": on_circle(at["O"], distance(at["O"], at["P1"]), crank)}
        for pin, one, other in order:
            known[pin] = meet(known[one], distance(at[one], at[pin]), known[other], distance(at[other], at[pin]),
                              is_left(at[pin], at[one], at[other]))
        return known[name]

    anchor.motion_of_pins({pin: lambda crank, pin=pin: place(pin, crank) for pin in ("P1", "P3", "P4", "P5", "P6", "P7")}, 100)
    published = ((D("-43.170055"), D("-91.753226")), (D("-24.406394"), D("-91.789596")))
    for (_, rows), foot in zip(anchor.rows("pins", "pin"), published):
        for axis, value in zip("xy", foot):
            anchor.add("published", rows[("P7",)][axis], value, 1, 6e-7, f"{axis} of the foot")
    return anchor.report()


def crank_slider_drawn(options):
    """A slider, then a dyad, and a point of its body, as Pyslvs has it."""
    anchor = Anchor("crank_slider_drawn", options)
    at = drawn_places(anchor)

    def b(crank):
        x, y = on_circle(at["O"], distance(at["O"], at["P1"]), crank)
        return x + (distance(at["P1"], at["B"])**2 - y**2).sqrt(), D(0)

    def c(crank):
        return meet(b(crank), distance(at["B"], at["C"]), at["G"], distance(at["C"], at["G"]), is_left(at["C"], at["B"], at["G"]))

    def f(crank):
        turn = direction(at["B"], at["F"]) - direction(at["B"], at["C"])
        return on_circle(b(crank), distance(at["B"], at["F"]), direction(b(crank), c(crank)) + turn)

    anchor.motion_of_pins({"B": b, "C": c, "F": f}, 150)
    for _, rows in anchor.rows("pins", "pin"):
        for axis, value in zip("xy", (D("103.801126"), D("78.393173"))):
            anchor.add("published", rows[("F",)][axis], value, 1, 6e-7, f"{axis} of F")
    return anchor.report()


def squeezer(options):
    """Andrews' squeezer: published angles (IVP Test Set, andrews.f) from the first one, at the start and at 0.03 s."""
    anchor = Anchor("squeezer", options)
    half = Digits.pi / 2
    published = (
        ("-0.0617138900142764496", "0", "0.455279819163070380", "0.222668390165885885", "0.487364979543842550",
         "-0.222668390165885885", "1.23054744454982119"),
        ("15.81077119629904", "-15.75637105984298", "0.04082224013073101", "-0.5347301163226948", "0.5244099658805304",
         "0.5347301163226948", "1.048080741042263"))
    for (_, rows), values in zip(anchor.rows("kinematics", "link"), published):
        beta, theta, gamma, phi, delta, omega, epsilon = map(D, values)
        angles = {"K2": beta + theta + 2 * half, "K3": gamma - half, "K4": phi + delta + half, "K5": delta,
                  "K6": omega + epsilon + 2 * half, "K7": epsilon - half}
        for link, angle in angles.items():
            anchor.angle(rows[(link,)]["theta"], angle, 5e-15, f"angle of {link}")
    beta, theta, gamma, phi, delta, omega, epsilon = map(D, (
        "1139.920302151208", "-1424.379294994111", "11.03291221937134", "19.29337464421385", "0.5735699284790808",
        "-19.29337464421385", "0.3231791658026955"))
    rates = {"K2": beta + theta, "K3": gamma, "K4": phi + delta, "K5": delta, "K6": omega + epsilon, "K7": epsilon}
    for link, rate in rates.items():
        anchor.add("rate", rows[(link,)]["omega"], rate, 1424, 1e-10, f"rate of {link} at 0.03 s")
    return anchor.report()


def squeezer_force(options, name, tolerance, force=()):
    """The motor's torque, 0.033 N m, from the published motion of all seven bodies and the spring's force on K3."""
    anchor = Anchor(name, options)
    for _, rows in anchor.rows("drives", "drive"):
        anchor.add("torque", rows[("K1",)]["force"], D("0.033"), D("0.033"), tolerance, "torque of the motor")
    for _, rows in anchor.rows("reactions", "pin", "link"):
        for axis, value in zip("xy", force):
            anchor.add("force", rows[("E", "K3")]["f" + axis], value, 98, tolerance, f"f{axis} on K3 at E")
    return anchor.report()


def squeezer_start(options):
    """Published to 18 digits, with the force in the joint of K2 and K3 (the first two multipliers)."""
    return squeezer_force(options, "squeezer_start", 1e-13, (D("98.5668703962410896"), D("-6.12268834425566265")))


def squeezer_end(options):
    """At 0.03 s; the published angle is right to 7e-11 only, and its acceleration less."""
    return squeezer_force(options, "squeezer_end", 1e-6)


def squeezer_motion(options):
    """Moved by its motor against its spring for 0.03 s; two other integrators in one coordinate agree on these digits."""
    path = os.path.join(HERE, "decks", "squeezer_motion.deck")
    row = run(options.program, path, options.scratch)["motion"].rows[-1]
    beta = float(abs(D(row["position1"]) * Digits.pi / 180 - D("15.8107711951536")))
    rate = float(abs(D(row["rate1"]) - D("1139.9203022591")) / 1424)
    passed = abs(row["time"] - 0.03) < 1e-15 and beta <= 1e-12 and rate <= 1e-12
    print(f"{'passed' if passed else 'FAILED'} squeezer_motion: position {beta:.1e} rate {rate:.1e}")
    return passed


def norton(options):
    """Example 11-3 of Norton, Design of Machinery: angles, a force and the torque to the digits printed there."""
    anchor = Anchor("norton", options)
    printed = (("kinematics", "link", "coupler", "theta", "20.92"), ("kinematics", "link", "rocker", "theta", "104.41"),
               ("bearings", "pin link", "O2 crank", "fx", "-117.65"), ("bearings", "pin link", "O2 crank", "fy", "-107.84"),
               ("drives", "drive", "crank", "force", "243.23"))
    for table, columns, names, column, value in printed:
        for _, rows in anchor.rows(table, *columns.split()):
            anchor.add("published", rows[tuple(names.split())][column], D(value), 1, 0.005, f"{column} of {names}")
    # His shaking force is that on the frame: -(F12 + F14), and its moment -T12 + R14 x F41.
    for _, rows in anchor.rows("bearings", "pin", "link"):
        (force, other), (_, frame) = (rows[("O2", "crank")], rows[("O4", "rocker")]), next(anchor.rows("frame"))
        (_, drive) = next(anchor.rows("drives", "drive"))
        for axis in "xy":
            anchor.add("force", frame[()]["frame_" + axis], -D(force["f" + axis]) - D(other["f" + axis]), 100, 1e-14, "frame_" + axis)
        anchor.add("torque", frame[()]["frame_moment"], -D(drive[("crank",)]["force"]) - 19 * D(other["fy"]), 1000, 1e-14, "frame_moment")
    return anchor.report()


# the two-link pendulum

PENDULUM = {"lengths": (D(1), D("0.8")), "masses": (D(2), D("1.5")), "centers": (D("0.5"), D("0.35")),
            "inertias": (D("0.2"), D("0.1")), "gravity": D("9.81"), "angles": (D(0), D(30))}


def pendulum_rates(state):
    """Of angles from the horizontal x axis and their rates."""
    p = PENDULUM
    (length, _), (mass, mass2), (c1, c2), (i1, i2), g = p["lengths"], p["masses"], p["centers"], p["inertias"], p["gravity"]
    one, two, rate, rate2 = state
    m11, m22 = i1 + mass * c1**2 + mass2 * length**2, i2 + mass2 * c2**2
    coupled = mass2 * length * c2
    m12, sine = coupled * Digits.cos(one - two), Digits.sin(one - two)
    f1 = -coupled * sine * rate2**2 - g * (mass * c1 + mass2 * length) * Digits.cos(one)
    f2 = coupled * sine * rate**2 - g * mass2 * c2 * Digits.cos(two)
    det = m11 * m22 - m12**2
    return rate, rate2, (m22 * f1 - m12 * f2) / det, (m11 * f2 - m12 * f1) / det


def pendulum_energy(state):
    p = PENDULUM
    (length, _), (mass, mass2), (c1, c2), (i1, i2), g = p["lengths"], p["masses"], p["centers"], p["inertias"], p["gravity"]
    one, two, rate, rate2 = state
    kinetic = ((i1 + mass * c1**2 + mass2 * length**2) * rate**2 + (i2 + mass2 * c2**2) * rate2**2) / 2 \
        + mass2 * length * c2 * Digits.cos(one - two) * rate * rate2
    return kinetic + g * (mass * c1 + mass2 * length) * Digits.sin(one) + g * mass2 * c2 * Digits.sin(two)


def extrapolated_step(state, step, columns):
    """A step of the midpoint rule, extrapolated (Gragg, Bulirsch, Stoer): order 2 columns."""
    table = []
    for k in range(1, columns + 1):
        count = 2 * k
        small = step / count
        before, here = state, tuple(x + small * v for x, v in zip(state, pendulum_rates(state)))
        for _ in range(count - 1):
            before, here = here, tuple(x + 2 * small * v for x, v in zip(before, pendulum_rates(here)))
        row = [tuple((x + y + small * v) / 2 for x, y, v in zip(here, before, pendulum_rates(here)))]
        for j in range(1, k):
            ratio = (D(count) / (2 * (k - j)))**2 - 1
            row.append(tuple(x + (x - y) / ratio for x, y in zip(row[j - 1], table[-1][j - 1])))
        table.append(row)
    return table[-1][-1]


def pendulum():
    """Angles [deg] and rates [rad/s] at some instants, by two step sizes; the change of energy."""
    results = []
    for steps, columns in ((20, 10), (25, 11)):
        state = tuple(angle * Digits.pi / 180 for angle in PENDULUM["angles"]) + (D(0), D(0))
        energy, found = pendulum_energy(state), []
        for half_second in range(1, 7):
            for _ in range(steps):
                state = extrapolated_step(state, D("0.5") / steps, columns)
            found.append((half_second / 2, state))
        results.append(found)
        change = abs(pendulum_energy(state) - energy)
        print(f"# {steps} steps in half a second, {columns} columns: energy changes by {change:.1e} J")
    print("# rods 1 m, 2 kg, centre 0.5 m, 0.2 kg m2 and 0.8 m, 1.5 kg, centre 0.35 m, 0.1 kg m2; gravity -9.81 m/s2 along y")
    print("# from rest with the first at 0, the second at 30 deg from the x axis; last column: the two integrations differ by")
    print("# time angle1 [deg] angle2 [deg] rate1 [rad/s] rate2 [rad/s]")
    for (time, state), (_, other) in zip(results[1], results[0]):
        degrees = [value * 180 / Digits.pi for value in state[:2]] + list(state[2:])
        print(f"{time:3}", *(f"{value:.17f}" for value in degrees), f"{max(abs(x - y) for x, y in zip(state, other)):.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_anchors"))
    parser.add_argument("--pendulum", action="store_true", help="integrate a two-link pendulum and nothing else")
    options = parser.parse_args()
    if options.pendulum:
        pendulum()
        return 0
    options.program = options.program.split()
    if options.program[0].endswith(".py"):
        options.program = [sys.executable, "-B"] + options.program
    anchors, wrong = 0, 0
    for anchor in (engine, quick_return, pumping_unit, jansen_drawn, crank_slider_drawn, squeezer,
                   squeezer_start, squeezer_end, squeezer_motion, norton):
        anchors += 1
        try:
            wrong += not anchor(options)
        except (RuntimeError, ValueError, KeyError, OSError) as failure:
            print(f"FAILED {anchor.__name__}: {failure!r}")
            wrong += 1
    print(f"{anchors - wrong} passed, {wrong} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
