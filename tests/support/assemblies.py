#!/usr/bin/env python3
"""Random linkages with change points and redundant members, against a continuation of their equations with 50 digits.

    assemblies.py [COUNT [SEED]] [--program PATH] [--scratch FOLDER] [--only KIND] [--keep]     2,000 linkages of seed 1 by default

COUNT linkages of change points, and COUNT/20 scissors with a ram. Compares places, velocities and accelerations of all pins, angles and
their rates of all links, ranges, swings and change points. The reference follows the curve of the exact linkage by its arc length, polishes
every position by Newton's method on all equations, and takes the polynomial through 24 places on both sides where the equations depend on
each other; closed forms where there are some check it. Misfits below 1e-9 of the size have to be accepted, those above to be told.
A linkage that fails is a line with its deck, which stays in the scratch folder; the last lines have the largest differences by kind.
"""

import copy
import math
import os
import random
import re
import shutil
import subprocess
import sys
from collections import defaultdict
from decimal import Decimal, getcontext

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "linkages"))
from tables import Table, new_parser, read_options  # noqa: E402  pylint: disable=wrong-import-position

D = Decimal
getcontext().prec = 50
PI = D("3.14159265358979323846264338327950288419716939937510582097494459")
DEGREE = PI / 180
# Largest differences: [ordinary, near a change point], places by the size, rates by size*(rate)**n; and by how much a misfit counts.
TOLERANCE = {"place": (1e-13, 1e-10), "velocity": (1e-11, 1e-9), "acceleration": (1e-9, 1e-7)}
OF_MISFIT = {"place": 1e3, "velocity": 1e5, "acceleration": 1e7}
NEAR = 5.0            # a position is near a change point [deg]
TOLD = 9e-9           # misfits above have to be told, others (1e-10 at most are made) to be accepted, as shares of the size
GRID = D("0.2513")    # places on both sides of a change point are so far apart [deg]
SIDES = 12            # so many on each side
MOST_SECONDS = 120    # of a run; it takes 50 ms


# plane vectors, of floats or of decimals

def add(a, b):
    return a[0] + b[0], a[1] + b[1]


def sub(a, b):
    return a[0] - b[0], a[1] - b[1]


def times(s, a):
    return s*a[0], s*a[1]


def dot(a, b):
    return a[0]*b[0] + a[1]*b[1]


def cross(a, b):
    return a[0]*b[1] - a[1]*b[0]


def left(a):
    return -a[1], a[0]


def size_of(a):
    return dot(a, a)**D("0.5") if isinstance(a[0], D) else math.hypot(*a)


def turn_of(angle):
    """An angle without whole turns, from 0 [deg]."""
    return angle - 360*math.floor(angle/360)


_trig = {}


def direction(angle):
    """(cos, sin) of an angle in degrees, to all digits."""
    angle = turn_of(D(angle))
    if angle not in _trig:
        quarter = int((angle + 45) // 90)
        x = (angle - 90*quarter)*DEGREE
        term, c, s, k = D(1), D(1), D(0), 0
        while abs(term) > D("1e-55"):
            k += 1
            term = term*x/k
            if k % 2:
                s += term if k % 4 == 1 else -term
            else:
                c += term if k % 4 == 0 else -term
            if term == 0:
                break
        if len(_trig) > 20000:
            _trig.clear()
        _trig[angle] = ((c, s), (-s, c), (-c, -s), (s, -c))[quarter % 4]
    return _trig[angle]


def turned(a, e):
    return a[0]*e[0] - a[1]*e[1], a[0]*e[1] + a[1]*e[0]


def mirrored_in(p, a, b):
    """The image of p in the line from a to b."""
    d, w = sub(b, a), sub(p, a)
    return add(a, sub(times(2*dot(d, w)/dot(d, d), d), w))


# linear equations

def reduce(rows, columns, rounding=0):
    """Gauss and Jordan with complete pivoting on the first columns; the column of every pivot, the pivots and the rows.

    Pivots below a share of the first are none."""
    rows = [list(row) for row in rows]
    free, where, pivots = list(range(columns)), [], []
    for k in range(min(columns, len(rows))):
        best, r, c = 0, k, None
        for i in range(k, len(rows)):
            row = rows[i]
            for j in free:
                if abs(row[j]) > best:
                    best, r, c = abs(row[j]), i, j
        if c is None or best < rounding*(pivots[0] if pivots else best):
            break
        rows[k], rows[r] = rows[r], rows[k]
        pivot = rows[k]
        factor = 1/pivot[c]
        rows[k] = pivot = [x*factor if x else x for x in pivot]
        used = [j for j, x in enumerate(pivot) if x]
        for i, row in enumerate(rows):
            f = row[c]
            if i != k and f:
                for j in used:
                    row[j] -= f*pivot[j]
        free.remove(c)
        where.append(c)
        pivots.append(best)
    return where, pivots, rows, free


class Linkage:
    """Pins that are given by the drive, pins that are sought, and what holds them: a curve in the space of the pins, and in c.

    The coordinate c of the drive is in degrees here, its derivatives are per radian; or a length along a guide.
    """

    def __init__(self):
        self.ground, self.given, self.pins, self.rows = {}, {}, [], []   # rows: (kind, pins, numbers)
        self.is_angle = True
        self.links, self.guides, self.sliders = {}, {}, []                # of the deck: pins of links; place and angle; (pin, guide)
        self.points = []
        self.start, self.c0 = {}, None                                    # an assembly
        self.closed = {}                                                  # pin: place as a function of c
        self.changes = set()                                              # where dyads may have change points, modulo 360 [deg]
        self.spare = []                                                   # links that may be redundant
        self.has_more = False                                             # other change points than `changes`
        self.crank = None

    # building
    def turn(self, pin, pivot, radius, phase=0):
        self.given[pin] = ("turn", pivot, D(radius), D(phase))

    def bar(self, a, b, length):
        self.rows.append(("bar", (a, b), (D(length)**2,)))

    def fixed_to(self, pin, a, b, along, across=0):
        """A pin of the link from a to b."""
        self.rows.append(("fixed", (pin, a, b), (D(along), D(across))))

    def guide(self, pin, place, angle):
        self.rows.append(("guide", (pin,), (place, left(direction(angle)))))

    def through(self, a, b, pin):
        """The line from a to b passes a pin."""
        self.rows.append(("through", (a, b, pin), ()))

    def place_of_given(self, pin, c, exact):
        kind, base, number, phase = self.given[pin]
        if kind == "turn":
            if exact:
                e = direction(c + phase)
            else:
                angle = math.radians(c + float(phase))
                e, number = (math.cos(angle), math.sin(angle)), float(number)
            o = self.ground[base] if exact else tuple(map(float, self.ground[base]))
            w = times(number, e)
            return add(o, w), left(w), times(-1, w)
        e = direction(number)
        zero = D(0) if exact else 0.0
        if not exact:
            base, e = tuple(map(float, base)), tuple(map(float, e))
        return add(base, times(c, e)), e, (zero, zero)

    def closed_place(self, pin, c):
        return self.place_of_given(pin, c, True)[0] if pin in self.given else self.closed[pin](c)

    def prepare(self):
        self.column = {pin: 2*k for k, pin in enumerate(self.pins)}
        self.n = 2*len(self.pins)
        self.float_ground = {pin: tuple(map(float, place)) for pin, place in self.ground.items()}
        self.float_rows = [(kind, pins, tuple(tuple(map(float, x)) if isinstance(x, tuple) else float(x) for x in numbers))
                           for kind, pins, numbers in self.rows]

    # equations
    def places(self, z, c, exact):
        """All pins, and the derivatives of those that are given."""
        at = dict(self.ground if exact else self.float_ground)
        rate, second = {}, {}
        for pin in self.given:
            at[pin], rate[pin], second[pin] = self.place_of_given(pin, c, exact)
        for pin, k in self.column.items():
            at[pin] = z[k], z[k + 1]
        return at, rate, second

    def equations(self, at, exact):
        """(value, [(pin, gradient)]) of every equation."""
        out = []
        one = D(1) if exact else 1.0
        for kind, pins, numbers in self.rows if exact else self.float_rows:
            if kind == "bar":
                d = sub(at[pins[1]], at[pins[0]])
                out.append(((dot(d, d) - numbers[0])/2, [(pins[0], times(-1, d)), (pins[1], d)]))
            elif kind == "fixed":
                k, a, b = pins
                along, across = numbers
                d, w = sub(at[b], at[a]), sub(at[k], at[a])
                out.append((w[0] - along*d[0] + across*d[1],
                            [(k, (one, 0*one)), (a, (along - 1, -across)), (b, (-along, across))]))
                out.append((w[1] - along*d[1] - across*d[0],
                            [(k, (0*one, one)), (a, (across, along - 1)), (b, (-across, -along))]))
            elif kind == "guide":
                out.append((dot(numbers[1], sub(at[pins[0]], numbers[0])), [(pins[0], numbers[1])]))
            else:
                a, b, p = pins
                d, w = sub(at[b], at[a]), sub(at[p], at[a])
                out.append((cross(d, w), [(b, (w[1], -w[0])), (p, left(d)), (a, sub(times(-1, left(d)), (w[1], -w[0])))]))
        return out

    def curvature(self, v):
        """Second derivatives of the equations along velocities, without accelerations."""
        out = []
        for kind, pins, _ in self.rows:
            if kind == "bar":
                d = sub(v[pins[1]], v[pins[0]])
                out.append(dot(d, d))
            elif kind == "through":
                out.append(2*cross(sub(v[pins[1]], v[pins[0]]), sub(v[pins[2]], v[pins[0]])))
            else:
                out += [D(0)]*(2 if kind == "fixed" else 1)
        return out

    def matrix(self, z, c, exact):
        at, rate, second = self.places(z, c, exact)
        zero = D(0) if exact else 0.0
        rows, gaps, drive, drive2 = [], [], [], []
        for value, gradients in self.equations(at, exact):
            row, first, then = [zero]*self.n, zero, zero
            for pin, g in gradients:
                if pin in self.column:
                    k = self.column[pin]
                    row[k] += g[0]
                    row[k + 1] += g[1]
                elif pin in rate:
                    first += dot(g, rate[pin])
                    then += dot(g, second[pin])
            rows.append(row)
            gaps.append(value)
            drive.append(first)
            drive2.append(then)
        return rows, gaps, drive, drive2, at, rate, second

    def polish(self, z, c):
        """Newton's method from floats; the place to all digits, its derivatives and the least pivot."""
        for _ in range(3):
            rows, gaps = self.matrix(z, float(c), False)[:2]
            where, pivots, reduced, _ = reduce([row + [-gap] for row, gap in zip(rows, gaps)], self.n)
            if len(where) < self.n or min(pivots) < 1e-9:
                break
            z = list(z)
            for k, j in enumerate(where):
                z[j] += reduced[k][-1]
        z = [D(x) for x in z]
        last = None
        for _ in range(8):
            rows, gaps = self.matrix(z, c, True)[:2]
            where, pivots, reduced, _ = reduce([row + [-gap] for row, gap in zip(rows, gaps)], self.n)
            if len(where) < self.n:
                return None
            most = max(abs(reduced[k][-1]) for k in range(self.n))
            for k, j in enumerate(where):
                z[j] += reduced[k][-1]
            if most < D("1e-22"):
                break
            if last is not None and most > last:
                return None
            last = most
        else:
            return None
        if max(map(abs, self.matrix(z, c, True)[1])) > D("1e-38"):
            return None
        return z, min(pivots)/max(pivots)

    def derivatives(self, z, c):
        rows, _, drive, drive2, _, rate, second = self.matrix(z, c, True)
        zero = D(0)
        where, pivots, reduced, _ = reduce([row + [-x] for row, x in zip(rows, drive)], self.n)
        z1 = [zero]*self.n
        for k, j in enumerate(where):
            z1[j] = reduced[k][-1]
        v = {pin: (zero, zero) for pin in self.ground}
        v.update(rate)
        v.update({pin: (z1[k], z1[k + 1]) for pin, k in self.column.items()})
        where, pivots, reduced, _ = reduce([row + [-x - y] for row, x, y in zip(rows, drive2, self.curvature(v))], self.n)
        z2 = [zero]*self.n
        for k, j in enumerate(where):
            z2[j] = reduced[k][-1]
        return z1, z2

    # the curve
    def unit(self):
        return math.pi/180 if self.is_angle else 1.0

    def tangent(self, x, before=None):
        rows, _, drive = self.matrix(x[:-1], x[-1]/self.unit(), False)[:3]
        where, pivots, reduced, free = reduce([row + [first] for row, first in zip(rows, drive)], self.n + 1, 1e-7)
        if len(where) != self.n:
            return None, 0.0
        t = [0.0]*(self.n + 1)
        t[free[0]] = 1.0
        for k in range(self.n):
            t[where[k]] = -reduced[k][free[0]]
        length = math.sqrt(sum(y*y for y in t))
        t = [y/length for y in t]
        if before and sum(a*b for a, b in zip(t, before)) < 0:
            t = [-y for y in t]
        return t, pivots[self.n - 1]/pivots[0]

    def correct(self, x, t):
        """Back to the curve, across the tangent."""
        for _ in range(8):
            rows, gaps, drive = self.matrix(x[:-1], x[-1]/self.unit(), False)[:3]
            system = [row + [first, -gap] for row, first, gap in zip(rows, drive, gaps)] + [list(t) + [0.0]]
            where, pivots, reduced, _ = reduce(system, self.n + 1)
            if len(where) <= self.n:
                return None
            step = 0.0
            x = list(x)
            for k, j in enumerate(where):
                if pivots[k] > 1e-10*pivots[0]:
                    x[j] += reduced[k][-1]
                    step = max(step, abs(reduced[k][-1]))
            if step > 1.0 or step != step:
                return None
            if step < 1e-9:
                break
        return x if step < 1e-8 else None

    def march(self, sense, goal, most_step=0.08):
        """Stations (x, tangent by c, pivot) from the start until c is beyond the goal, or turns back: then the place where."""
        x = [float(y) for pin in self.pins for y in self.start[pin]] + [float(self.c0)*self.unit()]
        t, pivot = self.tangent(x)
        if t is None or pivot < 1e-6 or abs(t[-1]) < 1e-9:
            raise Undecided("the start is a change point")
        if t[-1]*sense < 0:
            t = [-y for y in t]
        stations, h, tries = [(x, t, pivot)], most_step, 0
        goal = goal*self.unit()
        while sense*(x[-1] - goal) < 0:
            new = self.correct([a + h*b for a, b in zip(x, t)], t)
            good = new is not None and math.dist(new, [a + h*b for a, b in zip(x, t)]) < 0.1*h
            if good:
                t2, pivot = self.tangent(new, t)
                good = t2 is not None and sum(a*b for a, b in zip(t, t2)) > 0.985
            if not good:
                tries += 1
                h = h*0.5 if tries < 8 else most_step*(0.6 + 0.13*(tries - 8)) if tries < 20 else 0.0
                if h == 0.0:
                    raise Undecided("the curve cannot be followed")
                continue
            tries = 0
            h = min(most_step, 1.6*h)
            if t2[-1]*sense <= 0:
                return stations, self.fold(x, t, math.dist(new, x))
            x, t = new, t2
            stations.append((x, t, pivot))
            if len(stations) > 6000:
                raise Undecided("the curve is too long")
        return stations, None

    def fold(self, x, t, h):
        """Where c turns back between x and h along the tangent [deg or length]."""
        low, high = 0.0, 1.2*h
        c = None
        for _ in range(60):
            middle = (low + high)/2
            new = self.correct([a + middle*b for a, b in zip(x, t)], t)
            if new is None:
                raise Undecided("the end of the range")
            t2, _ = self.tangent(new, t)
            if t2 is None:
                raise Undecided("the end of the range")
            if t2[-1]*t[-1] > 0:
                low = middle
            else:
                high = middle
            c = new[-1]
        return c/self.unit()

    def follow(self, lowest, highest):
        """The curve over a range of c; ends where it turns back."""
        if (lowest, highest) == getattr(self, "followed", None):
            return
        self.followed = lowest, highest
        beyond = 2*SIDES*float(self.step_of_grid())
        up, self.to = self.march(1, highest + beyond)
        down, self.fr = self.march(-1, lowest - beyond)
        stations = [(x, [-y for y in t], p) for x, t, p in down[:0:-1]] + up
        self.track = [s for s in stations if s[2] > 2e-3 and abs(s[1][-1]) > 1e-6]
        self.track_c = [s[0][-1] for s in self.track]
        self.cache = {}
        self.stations = stations

    def step_of_grid(self):
        return GRID if self.is_angle else GRID/60*D(round(self.extent, 3))

    def guess(self, c):
        """The cubic between two stations."""
        u = float(c)*self.unit()
        low, high = 0, len(self.track) - 1
        while high - low > 1:
            middle = (low + high)//2
            if self.track_c[middle] <= u:
                low = middle
            else:
                high = middle
        (x, t, _), (y, s, _) = self.track[low], self.track[high]
        h = y[-1] - x[-1]
        w = (u - x[-1])/h
        if not -0.5 < w < 1.5:
            raise Undecided("beyond the curve")
        a, b, p, q = 2*w**3 - 3*w**2 + 1, 3*w**2 - 2*w**3, w**3 - 2*w**2 + w, w**3 - w**2
        return [a*x[k] + b*y[k] + p*h*t[k]/t[-1] + q*h*s[k]/s[-1] for k in range(self.n)]

    def solved(self, c):
        if c not in self.cache:
            self.cache[c] = self.polish(self.guess(c), c)
        return self.cache[c]

    def at(self, c):
        """Place, velocity and acceleration per radian of the drive, to all digits; whether the equations are near to depend on each other."""
        found = self.solved(c)
        if found and found[1] > D("0.01"):
            return (found[0],) + self.derivatives(found[0], c) + (False,)
        step = self.step_of_grid()
        middle = int(c/step)
        nodes, k = [[], []], 0
        while min(map(len, nodes)) < SIDES:
            for side, sign in ((0, -1), (1, 1)):
                node = step*(middle + sign*k) + step/3
                if len(nodes[side]) < SIDES and sign*(node - c) > step/10:
                    place = self.solved(node) if self.is_inside(node) else None
                    if place and place[1] > D("1e-3"):
                        nodes[side].append((node, place[0]))
            k += 1
            if k > 4*SIDES:
                raise Undecided("a change point next to a limit")
        nodes = nodes[0] + nodes[1]
        values = polynomial([x for x, _ in nodes], c, [z for _, z in nodes])
        fewer = nodes[1:SIDES - 1] + nodes[SIDES:-2]
        fewer += [nodes[SIDES - 1]]
        again = polynomial([x for x, _ in fewer], c, [z for _, z in fewer])
        unit = DEGREE if self.is_angle else D(1)
        for order, most in ((0, D("1e-17")), (1, D("1e-15")), (2, D("1e-12"))):
            if max(abs(a - b)/unit**order for a, b in zip(values[order], again[order])) > most*D(1 + self.extent):
                raise Undecided("the polynomial is not exact")
        return values[0], [x/unit for x in values[1]], [x/unit**2 for x in values[2]], True

    def is_inside(self, c):
        c = float(c)
        margin = 0.3 if self.is_angle else 0.0
        return (self.fr is None or c > self.fr + margin) and (self.to is None or c < self.to - margin)


def polynomial(nodes, x, values):
    """Value and two derivatives at x of the polynomial through places at nodes, by Newton's divided differences."""
    n, m = len(nodes), len(values[0])
    table = [list(v) for v in values]
    for j in range(1, n):
        for i in range(n - 1, j - 1, -1):
            w = 1/(nodes[i] - nodes[i - j])
            table[i] = [(a - b)*w for a, b in zip(table[i], table[i - 1])]
    p, p1, p2 = list(table[-1]), [D(0)]*m, [D(0)]*m
    for i in range(n - 2, -1, -1):
        w = x - nodes[i]
        p2 = [w*a + 2*b for a, b in zip(p2, p1)]
        p1 = [w*a + b for a, b in zip(p1, p)]
        p = [w*a + b for a, b in zip(p, table[i])]
    return p, p1, p2


class Undecided(Exception):
    """The reference has no answer."""


# families of linkages. A module is hung on a turning pin A of radius r about O; its ground direction is at an angle.

class Dice(random.Random):
    def number(self, low, high, digits=4):
        return D(f"{self.uniform(low, high):.{digits}f}")

    def chance(self, share):
        return self.random() < share


def hang(linkage, dice, name, base, pin, radius, phase, kind, angle):
    """Adds a module to a pin that turns about `base` at `phase` more than c; names end in `name`."""
    b, q, link = "B" + name, "Q" + name, "c" + name
    o, r = linkage.ground[base], radius

    def a(c):
        return add(o, times(r, direction(c + phase)))

    e = direction(angle)
    changes = {turn_of(D(angle) - phase), turn_of(D(angle) - phase + 180)}
    if kind in ("parallelogram", "antiparallelogram"):
        d = r*dice.number(0.4, 0.85) if dice.chance(0.5) else r*dice.number(1.2, 3)
        linkage.ground[q] = add(o, times(d, e))
        lengths = d, r
        if kind == "parallelogram":
            linkage.closed[b] = lambda c: add(a(c), times(d, e))
        else:
            linkage.closed[b] = lambda c: mirrored_in(add(a(c), times(d, e)), a(c), linkage.ground[q])
    elif kind in ("kite", "rhombus"):
        l = r if kind == "rhombus" else r*dice.number(1.1, 2.5) if dice.chance(0.75) else r*dice.number(0.6, 0.9)
        linkage.ground[q] = add(o, times(r, e))
        lengths = l, l
        sign = dice.choice((1, -1))

        def kite(c, half=None):
            half = (c + phase - D(angle))/2
            cosine, sine = direction(half)
            w = l*l - r*r*sine*sine
            root = r*cosine if l == r else w.sqrt() if w > 0 else D(0)
            return add(o, times(r*cosine + sign*root, direction(half + D(angle))))

        linkage.closed[b] = kite
        if l < r:
            changes = {turn_of(D(angle) - phase)}
        elif l > r:
            changes = {turn_of(D(angle) - phase)}
    elif kind == "deltoid":
        d = r*dice.number(0.4, 0.85) if dice.chance(0.5) else r*dice.number(1.2, 3)
        linkage.ground[q] = add(o, times(d, e))
        lengths = r, d
        linkage.closed[b] = lambda c: mirrored_in(o, a(c), linkage.ground[q])
    elif kind == "slider":
        linkage.pins.append(b)
        linkage.bar(pin, b, r)
        linkage.guide(b, o, angle)
        linkage.links["b" + name] = [pin, b]
        linkage.guides["g" + name] = (o, D(angle))
        linkage.sliders.append((b, "g" + name))
        linkage.closed[b] = lambda c: add(o, times(2*r*direction(c + phase - D(angle))[0], e))
        linkage.changes |= {turn_of(x + 90) for x in changes}
        linkage.spare.append(("b" + name, "trammel", (pin, b, o, D(angle))))
        return b, None, None
    linkage.pins.append(b)
    linkage.bar(pin, b, lengths[0])
    linkage.bar(q, b, lengths[1])
    linkage.links["b" + name] = [pin, b]
    linkage.links[link] = [q, b]
    linkage.changes |= changes
    linkage.spare.append(("b" + name, kind, (base, pin, b, q, r)))
    return b, q, lengths[1]


MODULES = ("parallelogram", "antiparallelogram", "kite", "deltoid", "slider", "rhombus")


def new_crank(linkage, dice):
    linkage.ground["O"] = (D(0), D(0))
    r = dice.number(0.4, 1.5)
    linkage.turn("A", "O", r)
    linkage.links["crank"] = ["O", "A"]
    linkage.crank = "crank"
    return r


def start_at(linkage, c):
    linkage.c0 = D(c)
    linkage.start = {pin: linkage.closed[pin](linkage.c0) for pin in linkage.pins}


def redundant(linkage, dice, number):
    """Adds redundant members that fit; names of links whose length may miss."""
    added = []
    for k in range(number):
        link, kind, numbers = dice.choice(linkage.spare)
        if kind == "parallelogram" and dice.chance(0.8):
            base, pin, b, q, r = numbers
            along = dice.number(0.2, 0.8) if dice.chance(0.5) else dice.number(-0.7, 1.8)
            if min(abs(along), abs(along - 1)) < D("0.1"):
                along = D("0.4")
            across = D(0) if dice.chance(0.4) else dice.number(0.2, 1)*dice.choice((1, -1))
            third, pivot, name = f"C{link}{k}", f"S{link}{k}", f"third{link}{k}"
            d = sub(linkage.ground[q], linkage.ground[base])
            linkage.ground[pivot] = add(linkage.ground[base], add(times(along, d), times(across, left(d))))
            linkage.pins.append(third)
            linkage.fixed_to(third, pin, b, along, across)
            linkage.bar(pivot, third, r)
            linkage.links[link].append(third)
            linkage.links[name] = [pivot, third]
            place = linkage.closed[b]
            linkage.closed[third] = lambda c, pin=pin, place=place, along=along, across=across: (
                lambda a, w: add(a, add(times(along, w), times(across, left(w)))))(
                    linkage.closed_place(pin, c), sub(place(c), linkage.closed_place(pin, c)))
            added.append(name)
        elif kind == "trammel":
            pin, b, o, angle = numbers
            if f"C{link}" in linkage.closed:
                continue
            linkage.changes |= {turn_of(x + 90) for x in linkage.changes}
            third, guide = f"C{link}", f"h{link}"
            linkage.pins.append(third)
            linkage.fixed_to(third, pin, b, -1)
            linkage.guide(third, o, angle + 90)
            linkage.links[link].append(third)
            linkage.guides[guide] = (o, angle + 90)
            linkage.sliders.append((third, guide))
            place = linkage.closed[b]
            linkage.closed[third] = lambda c, pin=pin, place=place: sub(times(2, linkage.closed_place(pin, c)), place(c))
        elif kind not in ("trammel", "parallelogram"):
            # A parallel rocker, and a third one between them.
            _, _, b, q, _ = numbers
            rocker, one, two, pivot, pivot2 = "c" + link[1:], f"B{link}{k}", f"C{link}{k}", f"S{link}{k}", f"T{link}{k}"
            way, along = (dice.number(0.3, 1)*dice.choice((1, -1)), dice.number(0.3, 1)*dice.choice((1, -1))), dice.number(0.3, 1.6)
            if abs(along - 1) < D("0.1"):
                along = D("0.5")
            across = D(0) if dice.chance(0.4) else dice.number(0.2, 1)*dice.choice((1, -1))
            arm = add(times(along, way), times(across, left(way)))
            length = [numbers[1] for kind, pins, numbers in [(r[0], r[1], (0, r[2][0].sqrt())) for r in linkage.rows if r[0] == "bar"]
                      if pins == (q, b)][0]
            linkage.ground[pivot], linkage.ground[pivot2] = add(linkage.ground[q], way), add(linkage.ground[q], arm)
            linkage.pins += [one, two]
            linkage.bar(b, one, size_of(way))
            linkage.bar(pivot, one, length)
            linkage.fixed_to(two, b, one, along, across)
            linkage.bar(pivot2, two, length)
            linkage.links[f"rod{link}{k}"] = [b, one, two]
            linkage.links[f"second{link}{k}"] = [pivot, one]
            linkage.links[f"third{link}{k}"] = [pivot2, two]
            place = linkage.closed[b]
            linkage.closed[one] = lambda c, place=place, way=way: add(place(c), way)
            linkage.closed[two] = lambda c, place=place, arm=arm: add(place(c), arm)
            linkage.has_more = True
            added.append(f"third{link}{k}")
    return added


def simple(dice, kind):
    linkage = Linkage()
    r = new_crank(linkage, dice)
    hang(linkage, dice, "1", "O", "A", r, D(0), kind, D(0))
    return linkage


def compound(dice):
    """Two or three modules on one crank with pins at different radii, or on the rocker of the first."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    hang(linkage, dice, "1", "O", "A", r, D(0), dice.choice(MODULES[:5]), D(0))
    for name in ("2", "3")[:dice.choice((1, 1, 2))]:
        r2, phase = dice.number(0.4, 1.5), dice.choice((D(0), D(90), dice.number(10, 350, 1)))
        pin = "A" + name
        linkage.turn(pin, "O", r2, phase)
        linkage.links["crank"].append(pin)
        hang(linkage, dice, name, "O", pin, r2, phase, dice.choice(MODULES[:5]), dice.choice((D(0), D(90), dice.number(0, 359, 1))))
    return linkage


def series(dice):
    """A parallelogram whose rocker is the crank of another module."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    b, q, rocker = hang(linkage, dice, "1", "O", "A", r, D(0), "parallelogram", D(0))
    hang(linkage, dice, "2", q, b, rocker, D(0), dice.choice(MODULES[:5]), dice.choice((D(0), dice.number(0, 359, 1))))
    return linkage


def chain(dice):
    """A module whose crank is the rocker of another one that does not turn as the crank does."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    kind = dice.choice(MODULES[1:4])
    b, q, rocker = hang(linkage, dice, "1", "O", "A", r, D(0), kind, D(0))
    changes, first = set(linkage.changes), linkage.closed[b]
    for _ in range(100):
        c0 = dice.number(0, 359, 2)
        trial = copy.deepcopy(linkage)
        phase = exact_angle((D(1), D(0)), sub(first(c0), linkage.ground[q])) - c0
        hang(trial, dice, "2", q, b, rocker, phase, dice.choice(MODULES[:5]), dice.choice((D(0), dice.number(0, 359, 1))))
        start_at(trial, c0)
        trial.prepare()
        if fits(trial) and min(abs(turn_of(c0 - x + 180) - 180) for x in changes) > 5:
            break
    else:
        raise Undecided("no place for a drawing")
    trial.closed, trial.changes, trial.has_more, trial.spare = {b: first}, changes, True, []
    return trial


def locomotive(dice):
    """Two cranks, coupled on both sides with pins a right angle apart: the second rod is redundant."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    b, q, _ = hang(linkage, dice, "1", "O", "A", r, D(0), "parallelogram", D(0))
    phase = dice.choice((D(90), dice.number(20, 160, 1)))
    e = direction(phase)
    linkage.turn("A2", "O", r, phase)
    linkage.links["crank"].append("A2")
    linkage.pins.append("B2")
    linkage.fixed_to("B2", q, b, e[0], e[1])
    linkage.links["c1"].append("B2")
    d = sub(linkage.ground[q], linkage.ground["O"])
    linkage.bar("A2", "B2", size_of(d))
    linkage.links["other"] = ["A2", "B2"]
    linkage.closed["B2"] = lambda c: add(linkage.place_of_given("A2", c, True)[0], d)
    linkage.spare = linkage.spare[:1]
    return linkage


def inverted(dice):
    """A block on the crank slides along a lever whose pivot is as far from the crank's as its pin."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    linkage.ground["Q"] = (r, D(0))
    l = r*dice.number(2.2, 3)
    linkage.pins.append("T")
    linkage.bar("Q", "T", l)
    linkage.through("Q", "T", "A")
    linkage.links["lever"] = ["Q", "T"]
    linkage.points.append(("R", "lever", -l))
    linkage.sliders.append(("A", "lever"))
    sign = dice.choice((1, -1))
    linkage.closed["T"] = lambda c: add((r, D(0)), times(sign*l, direction(c/2 + 90)))
    linkage.changes = {D(0)}
    return linkage


def dixon(dice):
    """Dixon's first mechanism: all of one group joined to all of another, on lines that are perpendicular."""
    linkage = Linkage()
    m, n = dice.choice(((2, 2), (2, 3), (3, 2), (3, 3), (3, 3), (3, 4), (4, 3)))
    p = [dice.number(0.5, 2)*dice.choice((1, -1)) for _ in range(m)]
    q = [dice.number(0.5, 2)*dice.choice((1, -1)) for _ in range(n)]
    if dice.chance(0.5):
        p[1] = -p[0]
    if dice.chance(0.5):
        q[dice.randrange(1, n)] = -q[0]
    for line in (p, q):
        if len({round(x, 3) for x in line}) < len(line):
            raise Undecided("pins in one place")
    at = {f"P{k}": (x, D(0)) for k, x in enumerate(p)}
    at.update({f"Q{k}": (D(0), y) for k, y in enumerate(q)})
    o, crank = "P0", "Q1"
    linkage.ground = {"P0": at["P0"], "Q0": at["Q0"]}
    way = sub(at[crank], at[o])
    # c counts from the x axis: the start is turned to a round angle.
    c0 = dice.number(0, 359, 1)
    e = direction(c0)
    turn = turned(e, (way[0]/size_of(way), -way[1]/size_of(way)))
    at = {pin: turned(sub(place, at[o]), turn) for pin, place in at.items()}
    linkage.ground = {pin: at[pin] for pin in ("P0", "Q0")}
    linkage.turn(crank, o, size_of(way))
    linkage.links["crank"], linkage.crank = [o, crank], "crank"
    names = [f"P{k}" for k in range(1, m)] + [f"Q{k}" for k in range(2, n)]
    linkage.pins = names
    bars = []
    for i in range(m):
        for j in range(n):
            a, b = f"P{i}", f"Q{j}"
            if (i, j) in ((0, 0), (0, 1)):
                continue
            linkage.bar(a, b, size_of(sub(at[a], at[b])))
            linkage.links[f"{a}{b}"] = [a, b] if a == "P0" or dice.chance(0.5) else [b, a]
            bars.append(f"{a}{b}")
    linkage.start, linkage.c0 = {pin: at[pin] for pin in names}, c0
    linkage.spare = []
    linkage.excess = (m - 2)*(n - 2)
    linkage.bars = bars
    linkage.changes = None
    return linkage


def burmester(dice):
    """Burmester's focal mechanism of a parallelogram: a pin joined to a pin on each side, by rods along the sides."""
    linkage = Linkage()
    r = new_crank(linkage, dice)
    b, q, _ = hang(linkage, dice, "1", "O", "A", r, D(0), "parallelogram", D(0))
    s, u = dice.number(0.25, 0.75), dice.number(0.25, 0.75)
    d = linkage.ground[q]
    linkage.turn("S", "O", r*u)
    linkage.links["crank"].append("S")
    linkage.ground["P"] = times(s, d)
    places = {"R": (("A", b), s), "T": ((q, b), u)}
    for pin, ((x, y), along) in places.items():
        linkage.pins.append(pin)
        linkage.fixed_to(pin, x, y, along)
    linkage.links["b1"].append("R")
    linkage.links["c1"].append("T")
    linkage.pins.append("F")
    linkage.closed["R"] = lambda c: add(times(r, direction(c)), times(s, d))
    linkage.closed["T"] = lambda c: add(times(r*u, direction(c)), d)
    linkage.closed["F"] = lambda c: add(times(r*u, direction(c)), times(s, d))
    rods = [("P", r*u), ("S", s*size_of(d)), ("R", r*(1 - u)), ("T", (1 - s)*size_of(d))]
    first, last = [dice.choice((0, 2)), dice.choice((1, 3))], []
    last = [k for k in range(4) if k not in first][:dice.choice((1, 2, 2))]
    dice.shuffle(first)
    rods = [rods[k] for k in first + last]
    for pin, length in rods:
        linkage.bar(pin, "F", length)
        linkage.links["rod" + pin] = [pin, "F"]
    linkage.spare = []
    # A rod across two in one line may be longer by a root of what these may miss.
    names = [pin for pin, _ in rods]
    linkage.bars = ["rod" + pin for pin in names if len(rods) == 4 or {"P": "R", "R": "P", "S": "T", "T": "S"}[pin] in names]
    linkage.excess = len(rods) - 2
    return linkage


def focal_point(quadrilateral, share, guess):
    """Burmester's focal point of a quadrilateral for points at this share of its sides, from the first corner and from the last but one:
    there the rods to two neighbouring sides make angles with these that add up to 180 deg, and so do the others; None if it is none.
    """
    a, b, c, d = quadrilateral

    def between(x, y):
        return add(x, times(share, sub(y, x)))

    p, q, r, s = between(a, b), between(b, c), between(d, c), between(a, d)

    def times_complex(x, y):
        return x[0]*y[0] - x[1]*y[1], x[0]*y[1] + x[1]*y[0]

    def gaps(f):
        one = times_complex(times_complex(sub(f, p), sub(f, q)), conjugate(times_complex(sub(b, a), sub(c, b))))
        two = times_complex(times_complex(sub(f, r), sub(f, s)), conjugate(times_complex(sub(d, c), sub(a, d))))
        return one[1], two[1]

    f, h = guess, D("1e-22")
    for _ in range(60):
        g = gaps(f)
        x, y = (times(1/h, sub(gaps(add(f, e)), g)) for e in ((h, D(0)), (D(0), h)))
        if abs(cross(x, y)) < D("1e-12"):
            return None
        step = (-cross(g, y)/cross(x, y), -cross(x, g)/cross(x, y))
        f = add(f, step)
        if size_of(step) < D("1e-30"):
            break
    else:
        return None
    g, (x, y) = gaps(f), (times(1/h, sub(gaps(add(f, e)), gaps(f))) for e in ((h, D(0)), (D(0), h)))
    return add(f, (-cross(g, y)/cross(x, y), -cross(x, g)/cross(x, y))), (p, q, r, s)


def conjugate(a):
    return a[0], -a[1]


def focal(dice):
    """Burmester's focal mechanism: a pin joined to a pin on each side of a quadrilateral."""
    for _ in range(40):
        linkage = Linkage()
        r, c0 = new_crank(linkage, dice), dice.number(0, 359, 2)
        if dice.chance(0.6):
            b, q, _ = hang(linkage, dice, "1", "O", "A", r, D(0), dice.choice(("antiparallelogram", "deltoid", "kite")), D(0))
            try:
                start_at(linkage, c0)
            except ArithmeticError:
                continue
            if min(abs(turn_of(c0 - x + 180) - 180) for x in linkage.changes) < 5:
                continue
        else:
            b, q = "B1", "Q1"
            linkage.ground[q], linkage.changes = (r*dice.number(1.2, 2.5), D(0)), None
            place = (linkage.ground[q][0] + dice.number(-0.5, 0.8), r*dice.number(0.7, 1.8))
            a = times(r, direction(c0))
            linkage.pins.append(b)
            linkage.bar("A", b, size_of(sub(place, a)))
            linkage.bar(q, b, size_of(sub(place, linkage.ground[q])))
            linkage.links["b1"], linkage.links["c1"] = ["A", b], [q, b]
            linkage.c0, linkage.start = c0, {b: place}
        share = dice.number(0.3, 0.7)
        corners = (D(0), D(0)), linkage.ground[q], linkage.start[b], times(r, direction(c0))
        extent = max(size_of(corner) for corner in corners)
        for _ in range(10):
            guess = times(extent, (dice.number(-0.3, 1.2), dice.number(-0.6, 0.8)))
            found = focal_point(corners, share, guess)
            if found and attach(copy.deepcopy(linkage), b, q, share, found, list("PQRS")):
                rods = [dice.choice("PR"), dice.choice("QS")]
                rods += [rod for rod in "PQRS" if rod not in rods][:dice.choice((1, 2, 2))]
                dice.shuffle(rods)
                return attach(linkage, b, q, share, found, rods)
    raise Undecided("no focal point")


def attach(linkage, b, q, share, found, rods):
    """Joins the focal point; None if it does not stay."""
    f, (p, on_rocker, on_coupler, on_crank) = found
    linkage.ground["P"] = p
    linkage.turn("S", "O", size_of(on_crank))
    for pin, place, x, y in (("R", on_coupler, "A", b), ("Q", on_rocker, q, b)):
        linkage.pins.append(pin)
        linkage.fixed_to(pin, x, y, share)
        linkage.start[pin] = place
    linkage.links["crank"].append("S")
    linkage.links["b1"].append("R")
    linkage.links["c1"].append("Q")
    linkage.pins.append("F")
    linkage.start["F"] = f
    at = dict(zip("PQRS", found[1]))
    for pin in rods:
        linkage.bar(pin, "F", size_of(sub(f, at[pin])))
        linkage.links["rod" + pin] = [pin, "F"]
    linkage.spare, linkage.bars, linkage.excess, linkage.has_more = [], ["rod" + pin for pin in rods], len(rods) - 2, True
    linkage.prepare()
    z = [x for pin in linkage.pins for x in linkage.start[pin]]
    rows, gaps, *_ = linkage.matrix(z, linkage.c0, True)
    where, pivots, *_ = reduce([[float(x) for x in row] for row in rows], linkage.n)
    if max(map(abs, gaps)) > D("1e-30") or len(where) < linkage.n or min(pivots) < 0.02*max(pivots):
        return None
    linkage.extent = 1.0
    try:
        linkage.follow(float(linkage.c0) - 3, float(linkage.c0) + 3)
        found = linkage.polish(linkage.guess(linkage.c0 + 2), linkage.c0 + 2)
    except Undecided:
        return None
    return linkage if found else None


def driven_slider(dice):
    """The isosceles slider-crank, driven by its slider."""
    linkage = Linkage()
    linkage.is_angle = False
    linkage.ground["O"] = (D(0), D(0))
    r = dice.number(0.4, 1.5)
    linkage.given["B"] = ("slide", (D(0), D(0)), D(0), None)
    linkage.pins.append("A")
    linkage.bar("O", "A", r)
    linkage.bar("A", "B", r)
    linkage.links["arm"], linkage.links["rod"] = ["O", "A"], ["A", "B"]
    linkage.guides["g"] = ((D(0), D(0)), D(0))
    linkage.sliders.append(("B", "g"))
    sign = dice.choice((1, -1))
    linkage.closed["A"] = lambda c: (c/2, sign*(r*r - c*c/4).sqrt())
    linkage.changes = {D(0)}
    linkage.reach = r
    return linkage


KINDS = {"parallelogram": 5, "antiparallelogram": 5, "kite": 4, "deltoid": 4, "slider": 4, "rhombus": 1, "compound": 5, "series": 3, "chain": 3,
         "locomotive": 3, "inverted": 2, "dixon": 4, "burmester": 2, "focal": 3, "driven_slider": 2}


def made(dice, only=None):
    """A linkage of a random kind, with its redundant members: kind, linkage, number of redundant conditions, links whose length may miss."""
    kind = only or dice.choices(list(KINDS), list(KINDS.values()))[0]
    if kind in MODULES:
        linkage = simple(dice, kind)
    else:
        linkage = {"compound": compound, "series": series, "chain": chain, "locomotive": locomotive, "inverted": inverted, "dixon": dixon,
                   "burmester": burmester, "focal": focal, "driven_slider": driven_slider}[kind](dice)
    if kind in ("dixon", "burmester", "focal"):
        return kind, linkage, linkage.excess, linkage.bars
    number = dice.choice((0, 0, 1, 1, 2)) if linkage.spare else 0
    links = redundant(linkage, dice, number)
    number = len(links) + sum(pin.startswith("Cb") and guide.startswith("h") for pin, guide in linkage.sliders) + (kind == "locomotive")
    if kind == "locomotive":
        links.append("other")
    return kind, linkage, number, links


def length_of(linkage, at, link):
    pins = linkage.links[link]
    return size_of(sub(at[pins[1]], at[pins[0]]))


def text17(x):
    return f"{float(x):.17g}"


class Case:
    """A linkage somewhere, its deck and what is known of it."""

    def __init__(self, number, seed, only):
        self.dice = dice = Dice(seed*1000003 + number)
        self.kind, self.linkage, self.excess, self.may_miss = made(dice, only)
        linkage = self.linkage
        linkage.prepare()
        self.scale = D(10)**dice.choice((-3, -2, -1, 0, 0, 0, 1, 2, 3))*dice.number(0.5, 2)
        self.sense = dice.choice((1, 1, -1))
        self.angle = dice.number(-180, 180, dice.choice((0, 1, 3)))
        self.moved = (D(0), D(0)) if dice.chance(0.3) else (dice.number(-3, 3), dice.number(-3, 3))
        self.pick_range()
        at = linkage.places([x for pin in linkage.pins for x in linkage.start[pin]], linkage.c0, True)[0]
        self.extent = max(max(at[p][k] for p in at) - min(at[p][k] for p in at) for k in (0, 1))
        linkage.extent = float(self.extent)
        self.clip()
        self.miss, self.missing = D(0), None
        if dice.chance(0.3):
            names = self.may_miss or [name for name in linkage.links if name != linkage.crank and len(linkage.links[name]) == 2]
            if names:
                self.missing = dice.choice(names)
                level = D(dice.choice(("1e-12", "1e-11", "1e-10", "3e-8", "1e-6", "1e-4", "1e-3")))
                self.miss = level*dice.choice((1, -1))*self.extent
        self.rule = "stop" if self.kind in MODULES and not (self.excess or self.missing) and dice.chance(0.15) else "through"
        self.speed, self.alpha = dice.choice((1, 10, 100)), dice.choice((0, 0, 3))
        self.text = self.deck(at)

    def pick_range(self):
        """Local coordinates of the rows, from the smallest; where the drawing is."""
        dice, linkage = self.dice, self.linkage
        if not linkage.is_angle:
            r = linkage.reach
            at_zero = dice.chance(0.7)
            self.step = D("0.02")*r if at_zero else D("0.0187")*r
            self.rows = [self.step*k for k in range(-70, 71, dice.choice((3, 7, 10)))]
            if at_zero and D(0) not in self.rows:
                self.rows = sorted(self.rows + [D(0)])
            linkage.c0 = D("0.7")*r*dice.choice((1, -1))
            linkage.start = {"A": linkage.closed["A"](linkage.c0)}
            return
        self.step = D(dice.choice((1, 2, 7)))
        span = {1: 130, 2: 372, 7: dice.choice((385, 735))}[int(self.step)]
        changes = sorted(linkage.changes) if linkage.changes else [D(0)]
        change = dice.choice(changes)
        beside = dice.choice((D(0), D(0), D(0), D("0.5")*self.step, D("0.001"), D("-0.00001"), D("1e-7"), D("1e-10"), dice.number(0, 360, 2)))
        if linkage.changes is None:
            first = linkage.c0 - self.step*dice.randrange(0, 20)
            span = min(span, 130)
        else:
            first = change + beside - self.step*dice.choice((0, 0, dice.randrange(0, 40)))
        if linkage.c0 is not None and linkage.changes is not None:
            first += 360*math.floor((linkage.c0 - first)/360)
            if linkage.c0 - first > span:
                span = int(linkage.c0 - first) + 20
        count = int(span/self.step)
        self.rows = [first + self.step*k for k in range(count + 1)]
        if linkage.changes is not None and linkage.c0 is None:
            # The drawing: away from change points, in the first turn of the rows.
            for _ in range(200):
                c0 = first + dice.number(0, min(span, 359), 3)
                if min(abs(turn_of(c0 - x + 180) - 180) for x in changes) < 3:
                    continue
                try:
                    start_at(linkage, c0)
                except ArithmeticError:
                    continue
                if fits(linkage):
                    break
            else:
                raise Undecided("no place for a drawing")

    def clip(self):
        """Leaves out what is beyond the range of the drive, as a rule."""
        linkage = self.linkage
        if not linkage.is_angle or self.dice.chance(0.05):
            return
        linkage.follow(float(self.rows[0]), float(self.rows[-1]))
        rows = [c for c in self.rows if linkage.is_inside(c)]
        if len(rows) < 2:
            raise Undecided("no range of the drive")
        self.rows = rows

    # global axes
    def place(self, p):
        return add(times(self.scale, turned((p[0], self.sense*p[1]), direction(self.angle))), self.moved_by())

    def moved_by(self):
        return times(self.scale, self.moved)

    def vector(self, v):
        return times(self.scale, turned((v[0], self.sense*v[1]), direction(self.angle)))

    def crank(self, c):
        """Global coordinate of the drive."""
        return self.angle + self.sense*c + self.shift if self.linkage.is_angle else self.scale*c

    def deck(self, at):
        dice, linkage = self.dice, self.linkage
        lines = [f"TITLE assembly of kind {self.kind}", "UNITS m kg s"]
        grounds = list(linkage.ground)
        dice.shuffle(grounds)
        for pin in grounds:
            lines.append(f"GROUND {pin} " + " ".join(map(text17, self.place(linkage.ground[pin]))))
        for name, (place, angle) in linkage.guides.items():
            lines.append(f"GUIDE {name} " + " ".join(map(text17, self.place(place))) + f" angle={turn_of(self.angle + self.sense*angle)}")
        links = list(linkage.links)
        dice.shuffle(links)
        if self.kind == "burmester":
            # Opposite rods are in one line everywhere: a pin between these is not placed by them.
            links.sort(key=lambda name: list(linkage.links).index(name) if name.startswith("rod") else -1)
        for name in links:
            lines.append(self.link(name, at))
        for point, link, along in linkage.points:
            far = self.pins_of[link][0] != linkage.links[link][0]
            lines.append(f"POINT {point} {link} along={text17((-2*along if far else along)*self.scale)}")
        for pin, guide in linkage.sliders:
            lines.append(f"SLIDER {pin} {guide}")
        drive = f"DRIVE {linkage.crank}" if linkage.is_angle else "DRIVE B g"
        lines.append(drive + (" change_points=stop" if self.rule == "stop" else dice.choice((" change_points=through", ""))))
        digits = dice.choice((17, 17, 6))
        for pin in list(linkage.given) + linkage.pins:
            lines.append(f"PIN {pin} " + " ".join(f"{float(x):.{digits}g}" for x in self.place(at[pin])))
        self.shift = D(0)
        if linkage.is_angle:
            self.shift_to_rows()
        cranks = [self.crank(c) for c in self.rows]
        if linkage.is_angle:
            ends = (cranks[0], cranks[-1])
            lines.append(f"CRANK {ends[0]} to {ends[1]} step {self.step*self.sense if self.sense > 0 else -self.step}")
        else:
            lines.append("CRANK " + " ".join(text17(x) for x in cranks) + " m")
        rate = f"SPEED {self.speed} rad/s" if linkage.is_angle else f"SPEED {text17(self.speed*self.scale)} m/s"
        lines.append(rate + (f" alpha={self.alpha if linkage.is_angle else text17(self.alpha*self.scale)}" if self.alpha else ""))
        lines += ["REPORT pins", "REPORT kinematics", "REPORT linkage"]
        return "\n".join(lines) + "\n"

    def shift_to_rows(self):
        """Whole turns of the deck's coordinate: the drawing, whose angle is known up to these, is counted as the program does."""
        cranks = [self.crank(c) for c in self.rows]
        low, high = min(cranks), max(cranks)
        drawn = self.crank(self.linkage.c0)
        near = turn_of(drawn + 180) - 180
        if near < low:
            near += 360*math.floor((low - near)/360 + D("0.5"))
            if near < low and near + 360 <= high:
                near += 360
        if near > high:
            near -= 360*math.floor((near - high)/360 + D("0.5"))
            if near > high and near - 360 >= low:
                near -= 360
        # The reference counts the drawing as c0.
        self.lap = near - drawn

    def link(self, name, at):
        dice, linkage = self.dice, self.linkage
        pins = list(linkage.links[name])
        if name == linkage.crank and len(pins) > 2:
            pass  # its angle is that of its first pin
        elif len(pins) > 2 and dice.chance(0.3):
            pins.reverse()
        elif len(pins) == 2 and dice.chance(0.5):
            pins.reverse()
        lengths, turns = [], []
        for a, b in zip(pins, pins[1:]):
            length = size_of(sub(at[b], at[a]))*self.scale
            if name == self.missing and not lengths:
                length += self.miss*self.scale
            lengths.append(text17(length))
        for a, b, c in zip(pins, pins[1:], pins[2:]):
            u, v = sub(at[b], at[a]), sub(at[c], at[b])
            turn = exact_angle(u, v)*self.sense
            turns.append(text17(turn))
        self.pins_of = getattr(self, "pins_of", {})
        self.pins_of[name] = pins
        if len(pins) == 2:
            return f"LINK {name} {pins[0]} {pins[1]} length={lengths[0]}"
        return f"LINK {name} {' '.join(pins)} lengths={','.join(lengths)} turns={','.join(turns)}"


def fits(linkage):
    """Whether closed forms close the linkage where it starts."""
    z = [x for pin in linkage.pins for x in linkage.start[pin]]
    rows, gaps, *_ = linkage.matrix(z, linkage.c0, True)
    if max(map(abs, gaps)) > D("1e-30"):
        return False
    where, pivots, *_ = reduce([[float(x) for x in row] for row in rows], linkage.n)
    return len(where) == linkage.n and min(pivots) > 0.02*max(pivots)


def exact_angle(u, v):
    """From u to v [deg]: the arctangent of floats, and a step of Newton's method in decimals."""
    angle = D(math.degrees(math.atan2(float(cross(u, v)), float(dot(u, v)))))
    for _ in range(3):
        e = direction(angle)
        w = turned(u, e)
        angle += cross(w, v)/dot(w, v)/DEGREE
    return D(0) if abs(angle) < D("1e-30") else angle


# what the program says

def run(program, deck, folder):
    try:
        result = subprocess.run([program, deck, "--out", folder], capture_output=True, text=True, timeout=MOST_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return -1, f"not done after {MOST_SECONDS} s", {}, None
    place = os.path.join(folder, os.path.splitext(os.path.basename(deck))[0])
    tables = {}
    if result.returncode in (0, 1) and os.path.isdir(place):
        tables = {name[:-4]: Table(os.path.join(place, name)) for name in os.listdir(place) if name.endswith(".dat")}
    return result.returncode, result.stderr, tables, place


def heads_of(path):
    """Of links: from which pin to which their angle is."""
    ways = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.replace(",", "").replace(";", "").split()
            if not line.startswith("#"):
                break
            if line.startswith("# angle of link"):
                ways[words[4].rstrip(":")] = (words[6], words[8])
    return ways


class Outcome:
    """Faults of a case, and its largest differences."""

    def __init__(self):
        self.faults, self.worst, self.undecided, self.compared, self.near = [], defaultdict(float), [], 0, 0

    def fault(self, text):
        if len(self.faults) < 4:
            self.faults.append(text)

    def compare(self, what, near, difference, misfit, where):
        key = (what, near)
        self.worst[key] = max(self.worst[key], difference)
        most = TOLERANCE[what][near] + OF_MISFIT[what]*misfit
        if not difference <= most:
            self.fault(f"{what} differs by {difference:.1e} at {where}" + (" (near a change point)" if near else ""))


def check(case, program, folder, deck_path):
    """Runs a case; an Outcome."""
    out = Outcome()
    linkage = case.linkage
    with open(deck_path, "w", encoding="utf-8") as deck:
        deck.write(case.text)
    status, stderr, tables, place = run(program, deck_path, folder)
    said = " | ".join(line.strip() for line in stderr.splitlines() if "error" in line)[:300]
    miss = float(abs(case.miss)/case.extent)
    if status not in (0, 1, 2):
        out.fault(f"status {status}: {stderr[-200:]}")
        return out
    if miss > TOLD:
        # Of two modules, one behind the other, the rod of the first has no part in what is redundant in the second.
        counts = case.missing in case.may_miss if case.kind == "compound" else (case.kind, case.missing) != ("series", "b1")
        if case.excess and counts:
            if status != 2 or not said:
                out.fault(f"a misfit of {miss:.0e} of link {case.missing} is not refused (status {status}) {said}")
        else:
            check_closure(case, status, said, tables, out)
        return out
    rows = case.rows
    linkage.follow(float(rows[0]), float(rows[-1]))
    if case.rule == "stop":
        check_stop(case, status, said, tables, out)
        return out
    if status == 2:
        check_refusal(case, said, miss, out)
        return out
    check_closed(case, out)
    check_rows(case, tables, place, miss, out)
    check_linkage(case, tables, miss, out)
    return out


def check_refusal(case, said, miss, out):
    """A deck whose positions are beyond the range of the drive is refused, and the range told."""
    linkage = case.linkage
    linkage.follow(float(linkage.c0) - 365, float(linkage.c0) + 365)
    told = re.search(r"closes between (\S+) and (\S+) deg", said)
    beyond = not all(linkage.is_inside(c - D(case.sense)*case.lap) for c in case.rows)
    if beyond and case.excess and "does not fit" in said:
        return
    if not told or not beyond:
        out.fault(f"refused with a misfit of {miss:.0e}: {said}")
        return
    for c, end in zip(sorted((linkage.fr, linkage.to), key=lambda c: case.crank(D(c or 0))), told.groups()):
        if c is None or abs((float(case.crank(D(c))) - float(end) + 180) % 360 - 180) > 1e-3:
            out.fault(f"the range is {linkage.fr} to {linkage.to} of the reference, told {told.groups()}: {said}")


def check_closure(case, status, said, tables, out):
    """Where lengths of dyads miss by more than rounding, rows are failed ones, or close, and links stay on their sides."""
    if status == 2:
        if not said:
            out.fault("refused without a word")
        return
    at = {}
    grounds = {pin: tuple(map(float, case.place(p))) for pin, p in case.linkage.ground.items()}
    for row in tables["pins"].rows:
        at.setdefault(row["crank"], dict(grounds))[row["pin"]] = (row["x"], row["y"])
    extent = float(case.extent*case.scale)
    ideal = case.linkage.places([x for pin in case.linkage.pins for x in case.linkage.start[pin]], case.linkage.c0, True)[0]
    for crank, pins in at.items():
        for name, ends in case.linkage.links.items():
            length = float(length_of(case.linkage, ideal, name)*case.scale)
            length += float(case.miss*case.scale)*(name == case.missing)
            got = math.dist(pins[ends[0]], pins[ends[1]])
            if abs(got - length) > 1e-11*extent:
                out.fault(f"link {name} is longer by {(got - length)/extent:.1e} of the size at {crank}")
        if case.kind in MODULES and case.linkage.links.get("c1") and not case.excess:
            drawn = side_of([tuple(map(float, ideal[pin])) for pin in ("A", "B1", "Q1")])*case.sense
            side = side_of([pins[pin] for pin in ("A", "B1", "Q1")])
            if abs(side) > 1e-3 and side*drawn < 0:
                out.fault(f"B1 is on its other side at {crank}, with a misfit of {float(case.miss/case.extent):.0e}")


def side_of(pins):
    """On which side of the way from the first to the last the second is: the sine of the dyad."""
    u, v = sub(pins[0], pins[1]), sub(pins[2], pins[1])
    return cross(u, v)/(math.hypot(*u)*math.hypot(*v))


def check_stop(case, status, said, tables, out):
    """Rows from one change point to the next, around the drawing, and no others."""
    linkage = case.linkage
    ahead = [turn_of(change - linkage.c0) for change in linkage.changes]
    low, high = linkage.c0 + max(ahead) - 360, linkage.c0 + min(ahead)
    beside = D("0.002")  # nearer is a dead point
    if status == 2:
        if all(low + beside < c < high - beside for c in case.rows) or "out of reach" not in said:
            out.fault(f"refused with change_points=stop: {said}")
        return
    by_crank = defaultdict(dict)
    for row in tables["pins"].rows:
        by_crank[row["crank"]][row["pin"]] = row
    linkage.follow(float(low), float(high))
    for c in case.rows:
        # Whole turns do not matter within one.
        local = low + turn_of(c - low)
        found = nearest(sorted(by_crank), float(case.crank(c)), 1e-9)
        if local < low + beside or local > low + 360 - beside or abs(local - high) < beside:
            continue
        if local < high and not linkage.is_inside(local):
            continue
        if (found is not None) != (local < high):
            out.fault(f"change_points=stop: {'no' if found is None else 'a'} row at {case.crank(c)}")
        elif found is not None:
            try:
                z, z1, z2, _ = linkage.at(local)
            except Undecided as reason:
                out.undecided.append(str(reason))
                continue
            out.compared += 1
            compare_row(case, by_crank[found], {}, local, (z, z1, z2), case.speed, 0.0, out, case.crank(c))


def check_closed(case, out):
    """The reference against closed forms."""
    linkage = case.linkage
    if not linkage.closed:
        return
    for c in case.dice.sample(case.rows, min(4, len(case.rows))):
        if not linkage.is_inside(c):
            continue
        try:
            z = linkage.at(c)[0]
        except Undecided:
            continue
        for pin, k in linkage.column.items():
            if pin not in linkage.closed:
                continue
            try:
                w = linkage.closed[pin](c)
            except ArithmeticError:
                continue
            if abs(w[0] - z[k]) + abs(w[1] - z[k + 1]) > D("1e-18"):
                out.fault(f"REFERENCE: {pin} at {c} differs from its closed form by {float(abs(w[0] - z[k]) + abs(w[1] - z[k + 1])):.1e}")


def check_rows(case, tables, place, miss, out):
    linkage, dice = case.linkage, case.dice
    lap = D(case.sense)*case.lap if linkage.is_angle else D(0)
    by_crank = defaultdict(dict)
    for row in tables["pins"].rows:
        by_crank[row["crank"]][row["pin"]] = row
    cranks = sorted(by_crank)
    links = defaultdict(dict)
    four_bar = "link" not in tables["kinematics"].names
    ways = heads_of(os.path.join(place, "kinematics.dat"))
    for row in tables["kinematics"].rows:
        if four_bar:
            links[row["crank"]] = {"b1": (row["theta3"], row["omega3"], row["alpha3"], ("A", "B1")),
                                   "c1": (row["theta4"], row["omega4"], row["alpha4"], ("Q1", "B1"))} if "B1" in linkage.pins else {}
        else:
            links[row["crank"]][row["link"]] = (row["theta"], row["omega"], row["alpha"], ways.get(row["link"]))
    chosen = case.rows
    if len(chosen) > 70:
        near = [c for c in chosen if distance_to(linkage, c) < NEAR]
        near = near if len(near) < 40 else dice.sample(near, 40)
        chosen = sorted(set(near) | set(dice.sample(chosen, 40)))
    rate = case.speed
    lows, highs = ([row["value"] for row in tables["linkage"].rows if row.get("quantity") == x] for x in ("range_from", "range_to"))
    ranges = list(zip(lows, highs))
    for c in chosen:
        crank = case.crank(c)
        # The program counts whole turns of the drawing in its own way.
        local = c - lap if linkage.is_angle else c
        found = nearest(cranks, float(crank), 1e-9 if linkage.is_angle else 1e-12*float(case.scale))
        if not linkage.is_inside(local):
            beyond = linkage.fr is not None and float(local) < linkage.fr - 1e-3 or linkage.to is not None and float(local) > linkage.to + 1e-3
            full = linkage.is_angle and (linkage.fr is None or linkage.to is None or linkage.to - linkage.fr >= 360)
            if beyond and found is not None and not full and not wraps(linkage, local) and not any(
                    turn_of(found - low) < high - low + 1e-6 for low, high in ranges):
                out.fault(f"a row beyond all ranges of the drive, at {crank}")
            continue
        if found is None:
            out.fault(f"no row at {crank}")
            continue
        try:
            z, z1, z2, _ = linkage.at(local)
        except Undecided as reason:
            out.undecided.append(str(reason))
            continue
        out.compared += 1
        compare_row(case, by_crank[found], links.get(found, {}), local, (z, z1, z2), rate, miss, out, crank)


def wraps(linkage, c):
    """Whether an angle beyond the range is one in it, but for whole turns."""
    return any(linkage.is_inside(c + 360*k) for k in (-3, -2, -1, 1, 2, 3)) if linkage.is_angle else False


def compare_row(case, pins, links, c, exact, rate, miss, out, crank):
    linkage = case.linkage
    z, z1, z2 = exact
    near = distance_to(linkage, c) < NEAR
    out.near += near
    at, first, second = linkage.places(z, c, True)
    for pin, k in linkage.column.items():
        first[pin], second[pin] = (z1[k], z1[k + 1]), (z2[k], z2[k + 1])
    sense = case.sense if linkage.is_angle else 1
    extent = float(case.extent*case.scale)
    v = {pin: times(D(rate*sense), case.vector(x)) for pin, x in first.items()}
    a = {pin: add(times(D(rate)**2, case.vector(x)), times(D(case.alpha*sense), case.vector(first[pin]))) for pin, x in second.items()}
    big_v = max(float(size_of(x)) for x in v.values()) + extent*rate
    big_a = max(float(size_of(x)) for x in a.values()) + extent*(rate**2 + case.alpha)
    for pin in first:
        if pin not in pins:
            out.fault(f"no row of pin {pin}")
            return
        row, p = pins[pin], case.place(at[pin])
        where = f"{crank}, pin {pin}"
        out.compare("place", near, float(max(abs(D(row["x"]) - p[0]), abs(D(row["y"]) - p[1])))/extent, miss, where)
        out.compare("velocity", near, float(max(abs(D(row["vx"]) - v[pin][0]), abs(D(row["vy"]) - v[pin][1])))/big_v, miss, where)
        out.compare("acceleration", near, float(max(abs(D(row["ax"]) - a[pin][0]), abs(D(row["ay"]) - a[pin][1])))/big_a, miss, where)
    zero = (D(0), D(0))
    for name, (theta, omega, alpha, way) in links.items():
        if way is None or way[0] not in at or way[1] not in at:
            continue
        d = case.vector(sub(at[way[1]], at[way[0]]))
        dv = sub(v.get(way[1], zero), v.get(way[0], zero))
        da = sub(a.get(way[1], zero), a.get(way[0], zero))
        length = float(size_of(d))
        e = math.cos(math.radians(theta)), math.sin(math.radians(theta))
        where = f"{crank}, link {name}"
        out.compare("place", near, abs(cross(tuple(map(float, d)), e))/extent + (0 if dot(tuple(map(float, d)), e) > 0 else 1), miss, where)
        out.compare("velocity", near, abs(float(cross(d, dv)/dot(d, d)) - omega)*length/big_v, miss, where)
        out.compare("acceleration", near, abs(float(cross(d, da)/dot(d, d)) - alpha)*length/big_a, miss, where)


def distance_to(linkage, c):
    """From the nearest change point of a dyad [deg]."""
    if linkage.changes is None or linkage.has_more:
        return 0.0
    if not linkage.is_angle:
        return abs(float(c))*60
    return min(abs((float(c - x) + 180) % 360 - 180) for x in linkage.changes)


def nearest(cranks, crank, most):
    best = min(cranks, key=lambda x: abs(x - crank), default=None)
    return best if best is not None and abs(best - crank) <= most*(1 + abs(crank)) else None


def check_linkage(case, tables, miss, out):
    """Ranges, turns and swings, change points of linkage.dat."""
    linkage = case.linkage
    table = tables["linkage"]
    if "quantity" not in table.names:
        check_four_bar(case, table, out)
        return
    if miss > 1e-11:
        return
    rows = table.rows
    lows, highs = ([row["value"] for row in rows if row["quantity"] == x] for x in ("range_from", "range_to"))
    pairs = list(zip(lows, highs))
    ends = dict(zip(("range_from", "range_to"), pairs[0])) if pairs else {}
    if linkage.is_angle:
        expected = {}
        # from the curve over a turn, or two, of the drive
        try:
            linkage.follow(float(linkage.c0) - 365, float(linkage.c0) + 365)
        except Undecided as reason:
            out.undecided.append(str(reason))
            return
        if linkage.fr is not None and linkage.to is not None:
            pair = [float(case.crank(D(linkage.fr))), float(case.crank(D(linkage.to)))]
            expected = dict(zip(("range_from", "range_to"), sorted(pair)))
            pairs.sort(key=lambda x: abs((x[0] - min(pair) + 180) % 360 - 180))
            ends = dict(zip(("range_from", "range_to"), pairs[0])) if pairs else {}
        elif linkage.fr is not None or linkage.to is not None:
            return
        if set(ends) != set(expected):
            out.fault(f"linkage.dat has {ends or 'no range'}, the range is {expected or 'a whole turn'}")
        for name, value in expected.items():
            if name in ends:
                gap = abs((ends[name] - value + 180) % 360 - 180)
                out.worst["range", False] = max(out.worst["range", False], gap)
                if gap > 1e-7:
                    out.fault(f"{name} is {ends[name]!r}, and should be {value!r}")
        check_change_points(case, rows, bool(expected), out)
        if not expected:
            check_swings(case, rows, out)
    else:
        reach = float(2*linkage.reach*case.scale)
        for name, value in (("range_from", -reach), ("range_to", reach)):
            gap = abs(ends.get(name, 1e9) - value)/reach
            out.worst["range", False] = max(out.worst["range", False], gap)
            if gap > 1e-12 + 2*miss:
                out.fault(f"{name} is {ends.get(name)}, and should be {value}")


def check_four_bar(case, table, out):
    if case.missing or case.linkage.changes is None:
        return
    told = sorted(row["crank"] for row in table.rows if row["event"] == "change_point" and row["branch"] == "open")
    for change in case.linkage.changes:
        crank = float(case.crank(change))
        if not any(abs((x - crank + 180) % 360 - 180) < 1e-6 for x in told):
            out.fault(f"linkage.dat has no change point at {crank}: {told}")


def check_change_points(case, rows, is_limited, out):
    linkage = case.linkage
    told = [row["value"] for row in rows if row["quantity"] in ("change_point",)]
    if linkage.changes is None or case.excess:
        return
    for x in told:
        gaps = [abs((x - float(case.crank(change)) + 180) % 360 - 180) for change in linkage.changes]
        if not linkage.has_more:
            out.worst["change point", False] = max(out.worst["change point", False], min(gaps))
        if min(gaps) > 1e-6 and not linkage.has_more:
            out.fault(f"linkage.dat has a change point at {x!r}, {min(gaps):.1e} deg from the nearest")
    if is_limited:
        return
    for change in linkage.changes:
        crank = float(case.crank(change))
        if not any(abs((x - crank + 180) % 360 - 180) < 1e-6 for x in told):
            out.fault(f"linkage.dat lacks the change point at {crank % 360}: it has {told}")


def check_swings(case, rows, out):
    """Links that turn do, others swing as far as the curve says; over one turn of the drive, if that is the period."""
    linkage = case.linkage
    x = [s[0] for s in linkage.stations]
    first = min(range(len(x)), key=lambda k: abs(x[k][-1] - float(linkage.c0)*linkage.unit()))
    told = {(row["part"], row["quantity"]): row["value"] for row in rows}
    turn = [k for k in range(first, len(x)) if x[k][-1] <= x[first][-1] + 2*math.pi + 1e-9]
    last = linkage.guess(float(linkage.c0) + 360)
    once = max(abs(a - b) for a, b in zip(last, x[first][:-1])) < 1e-4
    if not once:
        return
    for name, pins in linkage.links.items():
        if name == linkage.crank:
            continue
        angles, total = [], 0.0
        for k in turn:
            at = linkage.places(x[k][:-1], x[k][-1]/linkage.unit(), False)[0]
            d = sub(at[pins[1]], at[pins[0]])
            angle = math.atan2(d[1], d[0])
            if angles:
                angle = angles[-1] + (angle - angles[-1] + math.pi) % (2*math.pi) - math.pi
            angles.append(angle)
        total = round((angles[-1] - angles[0])/(2*math.pi))
        if total:
            if abs(told.get((name, "turns"), 0)) != abs(total):
                out.fault(f"link {name} turns {total} times, linkage.dat has {told.get((name, 'turns'))}")
        else:
            swing = math.degrees(greatest(angles, [x[k][-1] for k in turn]) + greatest([-a for a in angles], [x[k][-1] for k in turn]))
            if abs(told.get((name, "swing"), 1e9) - swing) > 0.3:
                out.fault(f"link {name} swings by {swing:.3f} deg, linkage.dat has {told.get((name, 'swing'))}")


def greatest(values, at):
    """The greatest of values, by the parabola through three where it is inside."""
    k = max(range(len(values)), key=values.__getitem__)
    if not 0 < k < len(values) - 1:
        return values[k]
    (a, b, c), (u, v, w) = values[k - 1:k + 2], at[k - 1:k + 2]
    first, second = (b - a)/(v - u), (c - b)/(w - v)
    bend = (second - first)/(w - u)
    slope = first + bend*(v - u)
    return b - slope*slope/(4*bend) if bend < 0 else b


# scissors

def scissors(dice):
    """Stages on a pin and a slider, and a ram between two of their pins: its deck, the range of its length, and places at lengths."""
    n = dice.randrange(1, 13)
    places = {"O": (D(0), D(0)), "S": (D(1), D(0))}
    links = {}
    for k in range(1, n + 1):
        places[f"M{k}"] = (D("0.5"), k - D("0.5"))
        places[f"R{k}"], places[f"L{k}"] = (D(1), D(k)), (D(0), D(k))
        links[f"a{k}"] = ["O" if k == 1 else f"L{k - 1}", f"M{k}", f"R{k}"]
        links[f"b{k}"] = ["S" if k == 1 else f"R{k - 1}", f"M{k}", f"L{k}"]
    while True:
        a, b = dice.sample(sorted(places), 2)
        if any(a in pins and b in pins for pins in links.values()):
            continue
        u, w = abs(places[a][0] - places[b][0]), abs(places[a][1] - places[b][1])
        # One stage has no such pair: its rams lie along a side.
        if u != w and (n == 1 or (u > 0 and w > 0)):
            break
    scale, angle = D(10)**dice.choice((-3, -1, 0, 0, 1, 3))*dice.number(0.5, 2), dice.number(-180, 180, 1)
    sense = dice.choice((1, -1))
    c0 = dice.number(20, 70, 2)

    def all_places(cosine, sine):
        return {pin: times(2*scale, turned((x*cosine, sense*y*sine), direction(angle))) for pin, (x, y) in places.items()}

    at = all_places(*direction(c0))
    lines = ["TITLE scissors", "UNITS m kg s", "GROUND O 0 0", f"GUIDE floor 0 0 angle={angle}"]
    for name, pins in links.items():
        half = text17(scale)
        lines.append(f"LINK {name} {' '.join(pins)} lengths={half},{half} turns=0")
    lines += [f"LINK ram {a} {b}", "SLIDER S floor", "DRIVE ram length"]
    lines += [f"PIN {pin} " + " ".join(map(text17, place)) for pin, place in at.items() if pin != "O"]
    angles = set()
    while len(angles) < 4:
        angles.add(dice.number(8, 82, 1))
    cosines = [direction(x) for x in sorted(angles)]
    lengths = [2*scale*((u*c)**2 + (w*s)**2).sqrt() for c, s in cosines]
    lines += ["CRANK " + " ".join(map(text17, lengths)) + " m", f"SPEED {text17(scale)} m/s", "REPORT linkage", "REPORT pins"]
    exact = [(all_places(c, s), length, (c, s)) for (c, s), length in zip(cosines, lengths)]
    return "\n".join(lines) + "\n", n, sorted((2*scale*u, 2*scale*w)), exact, scale


def check_scissors(dice, program, folder, path):
    out = Outcome()
    text, n, ends, exact, scale = scissors(dice)
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(text)
    status, stderr, tables, _ = run(program, path, folder)
    if status:
        out.fault(f"{n} stages: status {status}: {stderr[-300:]}")
        if not tables:
            return out, n
    found = {row["quantity"]: row["value"] for row in tables["linkage"].rows}
    size = float(2*n*scale)
    for name, value in zip(("range_from", "range_to"), ends):
        gap = abs(found.get(name, 1e9) - float(value))/size
        out.worst["range", False] = max(out.worst["range", False], gap)
        if not gap <= 1e-12:
            out.fault(f"{n} stages: {name} is {found.get(name)!r}, and should be {float(value)!r} ({gap:.1e} of the size)")
    rows = tables["pins"].rows
    for at, length, _ in exact:
        for row in rows:
            if row["pin"] in at and abs(row["crank"] - float(length)) < 1e-13*size:
                gap = max(abs(row[x] - float(at[row["pin"]][k])) for k, x in enumerate("xy"))/size
                out.compare("place", False, gap, 0.0, f"{float(length)}, pin {row['pin']}, {n} stages")
    return out, n


# all

def main():
    parser = new_parser(__doc__, "flexmech_assemblies")
    parser.add_argument("count", nargs="?", type=int, default=2000)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("--only", help="one kind, or scissors")
    parser.add_argument("--first", type=int, default=1, help="number of the first linkage")
    parser.add_argument("--keep", action="store_true")
    options = read_options(parser)
    program = options.program
    worst, counts, undecided = defaultdict(float), defaultdict(lambda: [0, 0, 0, 0, 0]), defaultdict(int)
    levels = defaultdict(lambda: [0, 0])
    passed = failed = 0
    jobs = [] if options.only == "scissors" else [(number, False) for number in range(options.first, options.first + options.count)]
    if options.only in (None, "scissors"):
        jobs += [(number, True) for number in range(1, 1 + max(12, options.count//20))]
    for number, is_scissors in jobs:
        name = f"{'scissors' if is_scissors else 'assembly'}_{options.seed}_{number}"
        path, folder = os.path.join(options.scratch, name + ".deck"), os.path.join(options.scratch, "out")
        kind = "scissors"
        try:
            if is_scissors:
                out, _ = check_scissors(Dice(options.seed*1000003 + number), program, folder, path)
            else:
                kind = "?"
                case = Case(number, options.seed, options.only)
                kind = case.kind
                out = check(case, program, folder, path)
        except Undecided as reason:
            undecided[kind, str(reason)] += 1
            counts[kind][2] += 1
            if not options.keep and os.path.exists(path):
                os.remove(path)
            continue
        for reason in out.undecided:
            undecided[kind + ", rows", reason] += 1
        for (what, near), value in out.worst.items() if not out.faults or is_scissors else ():
            if not (not is_scissors and case.missing):
                worst[kind, what, near] = max(worst[kind, what, near], value)
            else:
                miss = float(abs(case.miss)/case.extent)
                worst["miss", what, near] = max(worst["miss", what, near], value/miss)
        counts[kind][3] += out.compared
        counts[kind][4] += out.near
        if not is_scissors and case.missing:
            levels[f"{float(abs(case.miss)/case.extent):.0e}"][bool(out.faults)] += 1
        if out.faults:
            failed += 1
            counts[kind][1] += 1
            print(f"not ok {path} ({kind}): " + "; ".join(out.faults), flush=True)
        else:
            passed += 1
            counts[kind][0] += 1
            if not options.keep:
                os.remove(path)
        shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
    names = ("place", "velocity", "acceleration")
    print(f"{'kind':<18}{'passed':>7}{'failed':>7}{'open':>6}{'rows':>8}{'near':>7}  largest differences: " + ", ".join(names)
          + "; near; range; change point")
    for kind in sorted(counts):
        cells = [f"{worst[kind, what, near]:.1e}" for near in (False, True) for what in names]
        cells += [f"{worst[kind, what, False]:.1e}" for what in ("range", "change point")]
        print(f"{kind:<18}{counts[kind][0]:7d}{counts[kind][1]:7d}{counts[kind][2]:6d}{counts[kind][3]:8d}{counts[kind][4]:7d}  " + " ".join(cells))
    print("misfits, passed and failed: " + ", ".join(f"{level} {a} {b}" for level, (a, b) in sorted(levels.items(), key=lambda x: float(x[0]))))
    print("with a misfit, by this: " + " ".join(f"{worst['miss', what, near]:.1e}" for near in (False, True) for what in names))
    for (kind, reason), number in sorted(undecided.items()):
        print(f"undecided: {kind}: {reason}: {number}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
