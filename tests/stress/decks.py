"""Decks of four-bar linkages as text, for the families of the stress test."""

import hashlib
from decimal import Decimal, getcontext

getcontext().prec = 50

RADIAN = Decimal("57.295779513082320876798154814105170332405472466564")  # in degrees
CONTINUOUS = "MESH * accuracy=1e-21"  # the quadruple build takes it; the release refuses it


def digits(value):
    """A number as a deck takes it, with all digits of a Decimal and the shortest ones of a float."""
    return format(value, "f") if isinstance(value, Decimal) and -20 < value.adjusted() < 12 else repr(value) \
        if isinstance(value, float) else str(value)


class Linkage:
    """Three links from O2 over A and B to O4. Each link: length, section, material, as the deck writes them."""

    def __init__(self, ground, lengths, sections=None, materials=None, pins=(0, 0), branch="open", units="mm tonne s"):
        self.ground, self.lengths, self.pins, self.branch, self.units = ground, lengths, pins, branch, units
        self.sections = sections or ["rectangle thickness=1.6 width=25.4"] * 3
        self.materials = materials or ["E=200000 density=7.8e-9"] * 3

    def lines(self):
        yield f"UNITS {self.units}"
        for i, (section, material) in enumerate(zip(self.sections, self.materials), 1):
            yield f"MATERIAL m{i} {material}"
            yield f"SECTION s{i} {section}"
        yield "GROUND O2 0 0"
        yield f"GROUND O4 {digits(self.ground)} 0"
        for i, (name, ends) in enumerate((("crank", "O2 A"), ("coupler", "A B"), ("follower", "O4 B"))):
            yield f"LINK {name} {ends} length={digits(self.lengths[i])} material=m{i + 1} section=s{i + 1}"
        yield "DRIVE crank"
        yield f"BRANCH {self.branch}"
        for pin, mass in zip("AB", self.pins):
            if mass:
                yield f"PINMASS {pin} {digits(mass)}"


FIRST = Linkage(254, (100, Decimal("279.4"), Decimal("266.7")))  # the first mechanism of the thesis


class Case:
    """One run: a linkage, where and how it is solved, and what it is drawn against."""

    def __init__(self, family, parameter, variant, linkage, crank, speed=(0,), mesh="MESH * accuracy=1e-10", solver="auto",
                 inertia="distributed", modes=3, same_mesh=False):
        self.family, self.parameter, self.variant, self.same_mesh = family, parameter, variant, same_mesh
        self.head = list(linkage.lines())
        self.head += [f"CRANK {' '.join(digits(angle) for angle in crank)}", f"SPEED {' '.join(digits(s) for s in speed)}"]
        self.head += [f"MODES {modes}", "EFFECTS axial", "REPORT frequencies"]
        self.mesh, self.solver, self.inertia = mesh, solver, inertia

    def deck(self):
        return "\n".join(self.head + [self.mesh, f"INERTIA {self.inertia}", f"SOLVER {self.solver}", "END", ""])

    def continuous(self):
        """The same with continuous links to all digits: what the error columns speak of."""
        return "\n".join(self.head + [CONTINUOUS, "INERTIA distributed", "END", ""])

    def on_the_mesh(self):
        """The same mesh, for the quadruple build."""
        return "\n".join(self.head + [self.mesh, f"INERTIA {self.inertia}", "END", ""])


def key(deck):
    """What a reference is kept under: any change of a deck asks for a new one."""
    return hashlib.sha256(deck.encode()).hexdigest()[:10]
