"""The lowest frequency of linkages out of their plane over a turn of the crank, by dynamic stiffness and a count of eigenvalues.

    grillages.py DECK ... [--at CRANK] [--program PATH [--scratch FOLDER]]

Prints the lowest frequency and its crank angle; with --at that at a position.  With --program it is compared with `out_of_plane` of
REPORT validity, within the error of the row, and the last line counts.  Beams between pins, blocks and masses vibrate in closed
form, bending and twisting; positions are those of the independent solver (solver.py).  Unknowns are w and its gradient at nodes;
nodes of a rigid body, and a block and its place, share them.  Nothing is shared with the program that is tested.
"""
import argparse
import math
import os
import sys
import tempfile

from decks import Deck
from fields import Doubles
from tables import run
from vibrations import Assembly, bends

SCAN, ROUNDS = 72, 40                          # positions of a turn, steps between them
FACTORIALS = [float(math.factorial(k)) for k in range(80)]


def series(x, first, factor):
    """factor · Σ (−4)^k x^(4k + first)/(4k + first)!, divided by x^first."""
    return factor * sum((-4.0)**k * x**(4 * k) / FACTORIALS[4 * k + first] for k in range(19))


def bending(length, stiffness, density, omega):
    """Dynamic stiffness of w and slope at both ends, and how many modes between clamps lie below."""
    x = length * (density * omega**2 / stiffness)**0.25
    if x > 12:
        raise ValueError("waves too short")
    both, difference = series(x, 1, 2.0), series(x, 3, 4.0)    # sin cosh ± cos sinh
    product = series(x, 2, 2.0)                                # sin sinh
    clamped = -sum((-4.0)**k * x**(4 * k - 4) / FACTORIALS[4 * k] for k in range(1, 19))   # 1 − cos cosh
    fall = 2 * sum(x**(4 * k) / FACTORIALS[4 * k + 2] for k in range(19))                  # cosh − cos
    sines = 2 * sum(x**(4 * k) / FACTORIALS[4 * k + 3] for k in range(19))                 # sinh − sin
    sums = 2 * sum(x**(4 * k) / FACTORIALS[4 * k + 1] for k in range(19))                  # sinh + sin
    a, b, c, d, e, f = (value / clamped for value in (both, product, sums, fall, difference, sines))
    n = length
    rows = [[a, b * n, -c, d * n], [b * n, e * n * n, -d * n, f * n * n], [-c, -d * n, a, -b * n], [d * n, f * n * n, -b * n, e * n * n]]
    i = int(x / math.pi)
    below = i - (1 - (-1)**i * (1 if clamped > 0 else -1)) // 2 if x > 0 else 0
    return [[stiffness / n**3 * value for value in row] for row in rows], below


def torsion(length, stiffness, density, omega):
    """The same of the twist."""
    x = length * omega * math.sqrt(density / stiffness)
    k = stiffness / length
    if x < 1e-9:
        return [[k, -k], [-k, k]], 0
    return [[k * x / math.tan(x), -k * x / math.sin(x)], [-k * x / math.sin(x), k * x / math.tan(x)]], int(x / math.pi)


class GrillageDeck(Deck):
    """With the sections out of the plane: (EI, GJ, mass and polar inertia per length) of a link."""

    def __init__(self, text):
        self.shapes = {}
        super().__init__(text)

    def _section(self, bare, keys):
        super()._section(bare, keys)
        self.shapes[bare[0]] = bare[1]

    def _damper(self, bare, keys):
        """It does nothing out of the plane."""

    _spring = _damper

    def beam(self, card):
        if "material" not in card:
            return (0.0,) * 4
        density, (modulus, ratio) = float(self.materials[card["material"]]), self.moduli[card["material"]]
        area, second = float(self.sections[card["section"]]), float(self.bending[card["section"]][0])
        if self.shapes[card["section"]] == "rectangle":
            depth = math.sqrt(12 * second / area)
            width = area / depth
            across = depth * width**3 / 12
            a, b = max(depth, width), min(depth, width)
            twist = a * b**3 * (1 / 3 - 64 * b / (math.pi**5 * a) * sum(math.tanh(n * math.pi * a / (2 * b)) / n**5
                                                                       for n in range(1, 2001, 2)))
        else:
            across, twist = second, 2 * second
        stiffness = float(modulus)
        torsional = stiffness / (2 * (1 + float(ratio))) * twist if ratio is not None else 0.0
        return stiffness * across, torsional, density * area, density * (second + across)


class Grillage:
    """At a position."""

    def __init__(self, model, q):
        self.model, self.q, self.deck = model, q, model.deck
        self.places, self.above, self.held = {}, {}, set()
        self.beams, self.masses = [], []       # (nodes, direction, length, beam), (node, arm, mass, inertia, direction)
        for name, card in self.deck.links.items():
            self._add_link(name, card)
        for slider in self.deck.sliders:
            pin = self._node(("pin", slider["pin"]), model.pin_place(q, slider["pin"])[:2])
            if slider["guide"] in model.guides:
                self.held.add(pin)
            self.masses.append((pin, (0, 0), float(slider["mass"]), 0.0, (1, 0)))
        for pin, mass in self.deck.pin_masses:
            self.masses.append((("pin", pin), (0, 0), float(mass), 0.0, (1, 0)))
        self.held |= {("pin", pin) for pin in self.deck.grounds}
        held = {self._root(node) for node in self.held if node in self.above}
        roots = sorted({self._root(node) for node in self.above} - held, key=str)
        self.first = {root: 3 * k for k, root in enumerate(roots)}
        self.size = 3 * len(roots)

    def _node(self, name, place):
        self.places.setdefault(name, tuple(map(float, place)))
        self.above.setdefault(name, name)
        return name

    def _root(self, node):
        while self.above[node] != node:
            node = self.above[node]
        return node

    def _join(self, one, other):
        self.above[self._root(other)] = self._root(one)

    def _add_link(self, name, card):
        body = self.model.bodies[name]
        sine, cosine = map(float, self.model.trigonometry(self.q, body))
        start = [float(self.q[body.first + k]) for k in (0, 1)]

        def direction(along, offset):
            return along * cosine - offset * sine, along * sine + offset * cosine

        def place(along, offset):
            return tuple(a + b for a, b in zip(start, direction(float(along), float(offset))))

        route = list(card["pins"])
        nodes = {pin: self._node(("pin", pin), place(*body.places[pin])) for pin in body.places if pin in self.model.pins_by_name}
        blocks = []
        for number, slider in enumerate(self.deck.sliders):
            if slider["guide"] == name:
                at = tuple(map(float, self.model.pin_place(self.q, slider["pin"])[:2]))
                under = self._node(("under", number), at)
                self._join(under, self._node(("pin", slider["pin"]), at))
                blocks.append(under)
                self.masses.append((under, (0, 0), 0.0, float(slider["inertia"]), (cosine, sine)))
        stiffness = self.deck.beam(card)
        if not bends(card):
            for node in list(nodes.values())[1:] + blocks:
                self._join(nodes[route[0]], node)
            base = nodes[route[0]]
            if {"mass", "inertia", "center"} & set(card):
                self._attach(base, place, body.particles[0], (cosine, sine))
            else:
                for one, other in zip(route, route[1:]):
                    (x0, y0), (x1, y1) = self.places[nodes[one]], self.places[nodes[other]]
                    n = math.hypot(x1 - x0, y1 - y0)
                    along = ((x1 - x0) / n, (y1 - y0) / n)
                    arm = ((x0 + x1) / 2 - self.places[base][0], (y0 + y1) / 2 - self.places[base][1])
                    self.masses.append((base, arm, stiffness[2] * n, stiffness[2] * n**3 / 12, along))
                    self.masses.append((base, arm, 0.0, stiffness[3] * n, (-along[1], along[0])))
            for particle in body.particles[1:]:
                self._attach(base, place, particle, (cosine, sine))
            return
        segments = list(zip(route, route[1:]))
        at_mass = {}
        for k, particle in enumerate(body.particles[1:]):
            at = place(*particle[1:3])
            near = min(range(len(segments)), key=lambda i: self._foot(*(self.places[nodes[pin]] for pin in segments[i]), at)[1])
            at_mass.setdefault(near, []).append((k, particle, at))
        for i, (one, other) in enumerate(segments):
            ends = [self.places[nodes[pin]] for pin in (one, other)]
            n = math.dist(*ends)
            along = tuple((b - a) / n for a, b in zip(*ends))
            stops = [(0.0, nodes[one]), (n, nodes[other])]
            for node in blocks + [nodes[pin] for pin in nodes if pin not in route]:
                foot, beside = self._foot(*ends, self.places[node])
                if beside < 1e-9 * n and 1e-9 * n < foot < (1 - 1e-9) * n:
                    stops.append((foot, node))
            for k, particle, at in at_mass.get(i, []):
                foot = min(max(self._foot(*ends, at)[0], 0.0), n)
                point = tuple(a + foot * b for a, b in zip(ends[0], along))
                node = next((node for stop, node in stops if abs(stop - foot) < 1e-12 * n), None) or self._node((name, k), point)
                stops.append((foot, node))
                self.masses.append((node, tuple(a - b for a, b in zip(at, point)), float(particle[0]), float(particle[3]), along))
            stops.sort(key=lambda stop: stop[0])
            for (x, a), (y, b) in zip(stops, stops[1:]):
                if a != b:
                    self.beams.append((a, b, along, y - x, stiffness))

    def _foot(self, start, end, at):
        """(along, distance) of a place from a segment, along not limited to it."""
        n = math.dist(start, end)
        e = [(b - a) / n for a, b in zip(start, end)]
        along = sum(u * (p - a) for u, p, a in zip(e, at, start))
        near = min(max(along, 0.0), n)
        return along, math.dist(at, [a + near * u for a, u in zip(start, e)])

    def _attach(self, base, place, particle, direction):
        at = place(*particle[1:3])
        self.masses.append((base, tuple(a - b for a, b in zip(at, self.places[base])), float(particle[0]), float(particle[3]), direction))

    def forms(self, node, arm=(0.0, 0.0)):
        """w and its gradient at the end of an arm, as forms in the unknowns."""
        root = self._root(node)
        if root not in self.first:
            return {}, {}, {}
        k = self.first[root]
        x, y = (a - b + c for a, b, c in zip(self.places[node], self.places[root], arm))
        return {k: 1.0, k + 1: x, k + 2: y}, {k + 1: 1.0}, {k + 2: 1.0}

    def count_below(self, omega):
        """Frequencies below one, by the sign of the pivots."""
        matrix = [[0.0] * self.size for _ in range(self.size)]
        count = 0

        def add(forms, values):
            for one, row in zip(forms, values):
                for i, p in one.items():
                    for other, value in zip(forms, row):
                        for j, r in other.items():
                            matrix[i][j] += p * value * r

        def along(gradient, e):
            form = {}
            for part, factor in zip(gradient, e):
                for k, value in part.items():
                    form[k] = form.get(k, 0.0) + factor * value
            return form

        for a, b, e, length, (bend, twist, density, polar) in self.beams:
            ends = [self.forms(node) for node in (a, b)]
            values, below = bending(length, bend, density, omega)
            add([form for w, *gradient in ends for form in (w, along(gradient, e))], values)
            count += below
            values, below = torsion(length, twist, polar, omega)
            add([along(gradient, (-e[1], e[0])) for _, *gradient in ends], values)
            count += below
        for node, arm, mass, inertia, e in self.masses:
            w, *gradient = self.forms(node, arm)
            add([w, along(gradient, e)], [[-omega**2 * mass, 0.0], [0.0, -omega**2 * inertia]])
        for i in range(self.size):
            pivot = matrix[i][i]
            count += pivot < 0
            for j in range(i + 1, self.size):
                factor = matrix[j][i] / pivot
                if factor:
                    for k in range(j, self.size):
                        matrix[j][k] -= factor * matrix[i][k]
                    for k in range(j + 1, self.size):
                        matrix[k][j] = matrix[j][k]
        return count

    def lowest(self, guess=100.0):
        """The lowest frequency in Hz."""
        low, high = 0.0, 2 * math.pi * guess
        while not self.count_below(high):
            low, high = high, 1.1 * high
        if not low:
            low = high / 1.1
            while self.count_below(low):
                low, high = low / 1.1, low
        while high - low > 4e-15 * high:
            middle = (low + high) / 2
            if middle in (low, high):
                break
            low, high = (low, middle) if self.count_below(middle) else (middle, high)
        return high / (2 * math.pi)


class Turn:
    """Positions of a linkage by the angle of its first drive."""

    def __init__(self, deck):
        self.model = Assembly(deck, Doubles)
        self.place = float(deck.cranks[0] * deck.crank_factor())
        self.q = self.model.assemble()
        self.guess = 100.0

    def at(self, degrees):
        angle = math.radians(degrees)
        self.q = self.model.newton(self.model.follow(self.q, self.place, angle), angle)
        self.place = angle
        self.guess = Grillage(self.model, self.q).lowest(self.guess)
        return self.guess

    def lowest(self):
        """(frequency, crank angle in degrees)"""
        step = 360.0 / SCAN
        found = [(self.at(k * step), k * step) for k in range(SCAN)]
        best = (math.inf, 0.0)
        for frequency, angle in sorted(found)[:3]:
            low, high, ratio = angle - step, angle + step, (math.sqrt(5) - 1) / 2
            one, other = high - ratio * (high - low), low + ratio * (high - low)
            values = [self.at(one), self.at(other)]
            for _ in range(ROUNDS):
                if values[0] < values[1]:
                    high, other = other, one
                    one = high - ratio * (high - low)
                    values = [self.at(one), values[0]]
                else:
                    low, one = one, other
                    other = low + ratio * (high - low)
                    values = [values[1], self.at(other)]
            best = min(best, (values[0], one), (frequency, angle))
        return best


def compare(name, frequency, program, scratch):
    """Whether the rows of validity.dat have a frequency, within their errors."""
    rows = run(program, name, scratch)["validity"].rows
    worst = max(abs(float(row["out_of_plane"]) / frequency - 1) / float(row["error"]) for row in rows)
    print("ok" if worst <= 1 else "not ok", name, f"{worst:.2g} of its error")
    return worst <= 1


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("decks", nargs="+")
    parser.add_argument("--at", type=float)
    parser.add_argument("--program")
    parser.add_argument("--scratch")
    options = parser.parse_args()
    passed = failed = 0
    for name in options.decks:
        with open(name, encoding="utf-8") as file:
            text = file.read()
        turn = Turn(GrillageDeck(text))
        if options.at is not None:
            print(os.path.basename(name), f"{turn.at(options.at):.14g} Hz at {options.at} degrees")
            continue
        frequency, angle = turn.lowest()
        print(os.path.basename(name), f"{frequency:.14g} Hz at {angle % 360:.6g} degrees")
        if options.program:
            with tempfile.TemporaryDirectory(dir=options.scratch) as scratch:
                good = compare(name, frequency, options.program, scratch)
            passed, failed = passed + good, failed + (not good)
    if options.program:
        print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
