"""Straight uniform beams that vibrate, condensed to what their ends do, in decimals.

For a parameter c = omega^2 (negative below a divergence) a beam is a symmetric matrix of its end displacements: forces at the ends
that vibrate with c.  With it goes the number of its own modes with both ends clamped whose square is below c, and a function of c
that vanishes at these and has no poles.  By Wittrick and Williams (1971) both give the number of modes of all beams together.
"""
import functools
from decimal import Decimal

from fields import Digits

ZERO, ONE = Decimal(0), Decimal(1)


# what stretches: EA u'' + mu c u = 0, whatever the axial force

def stretching(c, length, axial, mass):
    """Entries of [[a, b], [b, a]] for both ends along, number below c, function."""
    if c == 0:
        return axial / length, -axial / length, 0, ONE
    wave = (abs(c) * mass / axial).sqrt()
    x, scale = wave * length, axial * wave
    if c < 0:
        e = x.exp()
        sine, cosine = (e - 1 / e) / 2, (e + 1 / e) / 2
        return scale * cosine / sine, -scale / sine, 0, sine / x
    sine, cosine = Digits.sin(x), Digits.cos(x)
    return scale * cosine / sine, -scale / sine, int(x / Digits.pi), sine / x


# what bends, slender and at rest: EI v'''' = mu c v in closed form

def bending_at_rest(c, length, stiffness, mass):
    """4x4 matrix of (v, slope) at both ends, number below c > 0, function."""
    wave = (c * mass / stiffness).sqrt().sqrt()
    x = wave * length
    e = x.exp()
    sinh, cosh, sin, cos = (e - 1 / e) / 2, (e + 1 / e) / 2, Digits.sin(x), Digits.cos(x)
    clamped = 1 - cos * cosh                     # vanishes at the modes of the clamped beam
    shear, turning = stiffness * wave**3 / clamped, stiffness * wave / clamped
    both = stiffness * wave**2 / clamped
    a, b = shear * (sin * cosh + cos * sinh), both * sin * sinh
    d, f = turning * (sin * cosh - cos * sinh), -shear * (sin + sinh)
    g, h = both * (cosh - cos), turning * (sinh - sin)
    # Mode k of the clamped beam lies in (pi k, pi (k + 1)), and 1 - cos cosh changes its sign there, first to negative.
    k = int(x / Digits.pi)
    below = 0 if k == 0 else k if (clamped > 0) == (k % 2 == 0) else k - 1
    return [[a, b, f, g], [b, d, -g, h], [f, -g, a, -b], [g, h, -b, d]], below, clamped / x**4


# everything else: polynomials, whose modes come from above

class Series:
    """Sum of a_j P_j(2 s - 1) on 0..1 with Legendre's polynomials, in decimals."""

    def __init__(self, terms):
        self.terms = {j: Decimal(a) for j, a in terms.items() if a != 0}

    def __add__(self, other):
        terms = dict(self.terms)
        for j, a in other.terms.items():
            terms[j] = terms.get(j, ZERO) + a
        return Series(terms)

    def integral(self, start=ZERO):
        """From 0 to s, and a value at 0."""
        terms = {0: Decimal(start)}
        for j, a in self.terms.items():
            if j == 0:
                terms[0] += a / 2
                terms[1] = terms.get(1, ZERO) + a / 2
            else:
                part = a / (2 * (2 * j + 1))
                terms[j + 1] = terms.get(j + 1, ZERO) + part
                terms[j - 1] = terms.get(j - 1, ZERO) - part
        return Series(terms)

    def times_s(self):
        terms = {}
        for j, a in self.terms.items():
            for k, share in ((j + 1, Decimal(j + 1) / (2 * j + 1)), (j - 1, Decimal(j) / (2 * j + 1)), (j, ONE)):
                if k >= 0:
                    terms[k] = terms.get(k, ZERO) + a * share / 2
        return Series(terms)

    def product(self, other):
        """Integral of the product over 0..1."""
        return sum((a * other.terms[j] / (2 * j + 1) for j, a in self.terms.items() if j in other.terms), ZERO)


@functools.lru_cache(maxsize=None)
def slender_shapes(order):
    """Displacement and slope of the shapes of degree up to `order`: four of the ends (slopes in units of the length), then bubbles."""
    ends = [({1: 6}, 0, 1), ({0: -1, 1: 3}, 1, 0), ({1: -6}, 0, 0), ({0: 1, 1: 3}, 0, 0)]
    shapes = []
    for second, slope, value in ends + [({j: 1}, 0, 0) for j in range(2, order - 1)]:
        curvature = Series(second)
        first = curvature.integral(slope)
        shapes.append((first.integral(value), first, curvature))
    return shapes


@functools.lru_cache(maxsize=None)
def slender_tables(order):
    """Integrals of v v, v' v', s v' v', s^2 v' v', v'' v'', and of v, s v, v'."""
    shapes = slender_shapes(order)
    slopes = [[shape[1]] for shape in shapes]
    for shape in slopes:
        shape.append(shape[0].times_s())
        shape.append(shape[1].times_s())

    def table(one, other):
        return [[a.product(b) for b in other] for a in one]

    values = [shape[0] for shape in shapes]
    unit, ramp = Series({0: 1}), Series({0: 1}).times_s()
    return {"mass": table(values, values), "tension": [table([s[k] for s in slopes], [s[0] for s in slopes]) for k in range(3)],
            "curvature": table([s[2] for s in shapes], [s[2] for s in shapes]),
            "force": [[v.product(unit), v.product(ramp)] for v in values], "couple": [s[0].product(unit) for s in slopes]}


@functools.lru_cache(maxsize=None)
def thick_tables(order):
    """The same of beams with shear: v_i, turn_i, v_j, turn_j, then bubbles of v and of the rotation in turn."""
    steps = [Series({0: -1}), Series({0: 1})]
    bubbles = [Series({j: 1}) for j in range(1, order)]
    none = Series({})
    # (v', rotation') of each shape
    rates = [(steps[0], none), (none, steps[0]), (steps[1], none), (none, steps[1])]
    rates += [rate for b in bubbles for rate in ((b, none), (none, b))][:-1]
    starts = [(1, 0), (0, 1)] + [(0, 0)] * (len(rates) - 2)
    v = [rate[0].integral(start[0]) for rate, start in zip(rates, starts)]
    turn = [rate[1].integral(start[1]) for rate, start in zip(rates, starts)]
    slope, curve = [rate[0] for rate in rates], [rate[1] for rate in rates]
    weighted = [slope, [s.times_s() for s in slope]]
    weighted.append([s.times_s() for s in weighted[1]])

    def table(one, other):
        return [[a.product(b) for b in other] for a in one]

    unit, ramp = Series({0: 1}), Series({0: 1}).times_s()
    return {"mass": table(v, v), "tension": [table(weighted[k], slope) for k in range(3)], "curvature": table(curve, curve),
            "turn": table(turn, turn), "slope": table(slope, slope), "mixed": table(slope, turn),
            "force": [[a.product(unit), a.product(ramp)] for a in v], "couple": [t.product(unit) for t in turn]}


class Polynomials:
    """A beam of an order under the axial force N0 + N1 s + N2 s^2, with rotary inertia (density times second moment) and with
    shear stiffness kGA, or without: matrices K and M with ends first, and end rotations in radians."""

    def __init__(self, order, length, stiffness, mass, rotary=ZERO, shear=None, tension=None):
        self.length = length
        tables = thick_tables(order) if shear else slender_tables(order)
        count = len(tables["mass"])
        if shear:
            scale = [ONE] * count
            self.force_couple = (tables["force"], [length * c for c in tables["couple"]])
        else:
            scale = [ONE, length, ONE, length] + [ONE] * (count - 4)
            self.force_couple = ([[f * s for f in row] for row, s in zip(tables["force"], scale)],
                                 [c * s for c, s in zip(tables["couple"], scale)])
        self.k, self.m = [], []
        for i in range(count):
            k_row, m_row = [], []
            for j in range(i + 1):
                m = mass * length * tables["mass"][i][j]
                if shear:
                    k = stiffness / length * tables["curvature"][i][j] + shear * (
                        tables["slope"][i][j] / length - tables["mixed"][i][j] - tables["mixed"][j][i] + length * tables["turn"][i][j])
                    m += rotary * length * tables["turn"][i][j]
                else:
                    k = stiffness / length**3 * tables["curvature"][i][j]
                    m += rotary / length * tables["tension"][0][i][j]
                if tension:
                    k += sum(n * table[i][j] for n, table in zip(tension, tables["tension"])) / length
                k_row.append(k * scale[i] * scale[j])
                m_row.append(m * scale[i] * scale[j])
            self.k.append(k_row)
            self.m.append(m_row)
        self.entries = [[(j, k, m) for j, (k, m) in enumerate(zip(*pair)) if k or m] for pair in zip(self.k, self.m)]
        self.norms = [abs(self.k[i][i]) or ONE for i in range(count)]

    def condensed(self, c, forces=None):
        """4x4 matrix for c, number of clamped modes below c, function; with forces on all shapes those at the ends in place of it."""
        count = len(self.k)
        rows = []
        for i, entries in enumerate(self.entries):
            rows.append([ZERO] * (i + 1))
            for j, k, m in entries:
                rows[i][j] = k - c * m if m else k
        forces = list(forces) if forces else None
        below, function = 0, ONE
        for p in range(count - 1, 3, -1):
            row = rows.pop()
            pivot = row[p]
            below += pivot < 0
            function *= pivot / self.norms[p]
            filled = [(j, row[j]) for j in range(p) if row[j]]
            for place, (i, value) in enumerate(filled):
                factor = value / pivot
                into = rows[i]
                for j, other in filled[:place + 1]:
                    into[j] -= factor * other
                if forces:
                    forces[i] -= factor * forces[p]
        full = [[rows[max(i, j)][min(i, j)] for j in range(4)] for i in range(4)]
        return full, below, forces[:4] if forces else function

    def loads(self, first, last, couple=ZERO):
        """Work on all shapes of a transverse load from first to last per length, and of a couple per length."""
        forces, couples = self.force_couple
        return [self.length * (first * f[0] + (last - first) * f[1]) + couple * t for f, t in zip(forces, couples)]
