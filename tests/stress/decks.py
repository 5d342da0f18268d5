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

    def __init__(self, ground, lengths, sections=None, materials=None, pins=(0, 0), branch="open", units="mm tonne s", more=()):
        self.ground, self.lengths, self.pins, self.branch, self.units = ground, lengths, pins, branch, units
        self.more = more  # further cards: masses along links, loads
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
        yield from self.more


FIRST = Linkage(254, (100, Decimal("279.4"), Decimal("266.7")))  # the first mechanism of the thesis


class Case:
    """One run: a linkage, where and how it is solved, and what it is drawn against."""

    def __init__(self, family, parameter, variant, linkage, crank, speed=(0,), mesh="MESH * accuracy=1e-10", solver="auto",
                 inertia="distributed", modes=3, same_mesh=False, effects="axial"):
        self.family, self.parameter, self.variant, self.same_mesh = family, parameter, variant, same_mesh
        self.head = list(linkage.lines())
        self.head += [f"CRANK {' '.join(digits(angle) for angle in crank)}", f"SPEED {' '.join(digits(s) for s in speed)}"]
        self.head += [f"MODES {modes}", f"EFFECTS {effects}", "REPORT frequencies"]
        self.mesh, self.solver, self.inertia = mesh, solver, inertia
        self.wanted = None  # the verdict that every row has to have, if there is one

    def deck(self):
        return "\n".join(self.head + [self.mesh, f"INERTIA {self.inertia}", f"SOLVER {self.solver}", "END", ""])

    def asked(self):
        """The accuracy that the deck asks for; more than any error on a mesh of its own."""
        return Decimal(self.mesh.split("accuracy=")[1]) if "accuracy=" in self.mesh else Decimal("inf")

    def continuous(self):
        """The same with continuous links to all digits: what the error columns speak of."""
        return "\n".join(self.head + [CONTINUOUS, "INERTIA distributed", "END", ""])

    def on_the_mesh(self):
        """The same mesh, for the quadruple build."""
        return "\n".join(self.head + [self.mesh, f"INERTIA {self.inertia}", "END", ""])


class WrittenCase(Case):
    """A deck from a file, with its own mesh card or another one."""

    def __init__(self, family, parameter, path, accuracy=None, wanted=None):
        with open(path, encoding="utf-8") as file:
            lines = [" ".join(line.split()) for line in file if line.strip() and line.split()[0] not in ("TITLE", "END")]
        self.head = [line for line in lines if not line.startswith(("MESH", "INERTIA", "SOLVER"))]
        self.mesh = next(line for line in lines if line.startswith("MESH"))
        if accuracy:
            self.mesh = f"MESH * accuracy={accuracy}"
        self.family, self.parameter, self.variant, self.wanted = family, parameter, self.mesh.split("=")[1], wanted
        self.solver, self.inertia, self.same_mesh = "auto", "distributed", False


def key(deck):
    """What a reference is kept under: any change of a deck asks for a new one."""
    return hashlib.sha256(deck.encode()).hexdigest()[:10]
