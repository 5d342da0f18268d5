"""Checks of the reference of vibrations.py itself, without the program: closed forms, two kinds of beams, links that get stiffer.

    vibration_checks.py

Prints `ok` or `not ok` for every check.
"""
import sys
from decimal import Decimal

from beams import Polynomials, bending_at_rest
from decks import Deck
from fields import Digits
from vibrations import Structure, assemblies

ARM = """UNITS m kg s
MATERIAL steel E=200GPa density=8000kg/m3 nu=0.3
SECTION bar {section}
GROUND O 0 0
LINK arm O A length=0.5 material=steel section=bar
DRIVE arm {free}
CRANK {crank}
EFFECTS {effects}
GRAVITY 0 -9.81m/s2
"""
QUICK_RETURN = """UNITS m kg s
MATERIAL steel E=200GPa density=7800kg/m3 nu=0.3
MATERIAL hard E={modulus} density=7800kg/m3 nu=0.3
SECTION strip general A=4e-5 I=8e-12 shear_coefficient=0.8
GROUND O2 0 0
GROUND O4 0 -0.15
GUIDE bed 0 0.14 angle=0
LINK crank O2 A length=0.06 material=steel section=strip
LINK lever O4 C length=0.32 {rigid} material=hard section=strip
LINK rod C D length=0.12 material=steel section=strip
MASS lever 0.02 at=0.1 offset=0.03 inertia=1e-5
FORCE lever 3 -8 at=0.25 offset=-0.02
SLIDER A lever mass=0.03 inertia=1e-5
SLIDER D bed mass=0.2
GRAVITY 1 -9.8
DRIVE crank
BRANCH D forward
CRANK 100
SPEED 30 rad/s alpha=50
EFFECTS axial {words}
"""
COUPLER = """UNITS m kg s
MATERIAL steel E=200GPa density=7800kg/m3 nu=0.3
MATERIAL hard E={modulus} density=7800kg/m3 nu=0.3
SECTION strip general A=4e-5 I=8e-12 shear_coefficient=0.8
GROUND O2 0 0
GROUND O4 0.254 0
PIN A 0.1 0
PIN B 0.29 0.24
PIN C 0.14 0.18
LINK crank O2 A length=0.1 material=steel section=strip
LINK coupler A B C A lengths=0.2794,0.18,0.15 {rigid} material=hard section=strip
LINK follower O4 B length=0.2667 material=steel section=strip
PINMASS C 0.1
MASS coupler 0.05 at=0.1 offset=0.02 inertia=1e-5
FORCE C 2 -1
SPRING main A O4 stiffness=200 free_length=0.1
GRAVITY 0 -9.8
DRIVE crank
CRANK 75
SPEED 20 rad/s alpha=30
EFFECTS axial {words}
"""


def lowest(text, modes=3):
    """Frequencies at the only position and speed of a deck."""
    deck = Deck(text)
    crank, model, q = next(assemblies(deck))
    structure = Structure(model, q)
    if "static" not in deck.effects:
        structure.load(model.state(q, crank * deck.crank_factor(), deck.speeds[0] * deck.speed_factor(), deck.alpha()))
    return structure.prepare().frequencies(modes)


def root(function, low, high):
    low, high = Decimal(low), Decimal(high)
    while high - low > Decimal("1e-40"):
        middle = (low + high) / 2
        low, high = (middle, high) if (function(low) > 0) == (function(middle) > 0) else (low, middle)
    return low


def cosh(x):
    return (x.exp() + (-x).exp()) / 2


def sinh(x):
    return (x.exp() - (-x).exp()) / 2


def cantilever():
    """cos x cosh x = -1."""
    found = lowest(ARM.format(section="rectangle thickness=0.002 width=0.02", free="", crank=20, effects="static"))
    x = root(lambda x: 1 + Digits.cos(x) * cosh(x), 4, 5)
    exact = x * x / (2 * Digits.pi) / Decimal("0.25") * (Decimal("2e11") * Decimal("0.002")**2 / 12 / 8000).sqrt()
    return found[1] / exact - 1, Decimal("1e-26")


def free_arm():
    """tan x = tanh x, and one free motion."""
    found = lowest(ARM.format(section="rectangle thickness=0.002 width=0.02", free="free", crank=20, effects="static"))
    x = root(lambda x: Digits.sin(x) * cosh(x) - Digits.cos(x) * sinh(x), "3.5", "4.5")
    exact = x * x / (2 * Digits.pi) / Decimal("0.25") * (Decimal("2e11") * Decimal("0.002")**2 / 12 / 8000).sqrt()
    return abs(found[1] / exact - 1) + found[0], Decimal("1e-26")


def pendulum():
    """A bar that hangs: omega^2 = 3 g/(2 L), but for how far it bends."""
    found = lowest(ARM.format(section="general A=1e-4 I=1", free="free", crank=-90, effects="axial"), 1)
    return (2 * Digits.pi * found[0])**2 / (Decimal("1.5") * Decimal("9.81") / Decimal("0.5")) - 1, Decimal("1e-10")


def two_kinds_of_beams():
    """Polynomials of order 40 against the closed form."""
    length, stiffness, mass = Decimal("0.3"), Decimal(2), Decimal("0.4")
    polynomials, worst = Polynomials(40, length, stiffness, mass), Decimal(0)
    for rate in (1, 100, 500, 1500, 6000):
        (one, below, _), (other, count, _) = (beam(Decimal(rate)**2) for beam in (
            lambda c: bending_at_rest(c, length, stiffness, mass), polynomials.condensed))
        worst = max([worst, abs(Decimal(below - count))] + [abs(a / b - 1) for x, y in zip(one, other) for a, b in zip(x, y)])
    return worst, Decimal("1e-30")


def thick_and_slender():
    """Shear that is hardly there."""
    length, stiffness, mass = Decimal("0.3"), Decimal(2), Decimal("0.4")
    one = bending_at_rest(Decimal(500)**2, length, stiffness, mass)[0]
    other = Polynomials(24, length, stiffness, mass, shear=Decimal("1e20")).condensed(Decimal(500)**2)[0]
    return max(abs(a / b - 1) for x, y in zip(one, other) for a, b in zip(x, y)), Decimal("1e-15")


def getting_stiffer(text, words):
    """A link a billion times as stiff as steel against a rigid one, in motion: blocks and forces that turn, masses and forces beside the axis."""
    rigid = lowest(text.format(modulus="2e11", rigid="rigid", words=words))
    stiff = lowest(text.format(modulus="2e20", rigid="", words=words))
    return max(abs(a / b - 1) for a, b in zip(rigid, stiff)), Decimal("1e-8")


def main():
    checks = [("cantilever", cantilever), ("arm_with_free_joint", free_arm), ("pendulum", pendulum),
              ("polynomials_and_closed_form", two_kinds_of_beams), ("shear_that_vanishes", thick_and_slender)]
    for name, text in (("quick_return", QUICK_RETURN), ("coupler", COUPLER)):
        for words in ("", "rotary", "rotary shear"):
            checks.append(("_".join(["rigid", name] + words.split()), lambda text=text, words=words: getting_stiffer(text, words)))
    failures = 0
    for name, check in checks:
        difference, allowed = check()
        failures += abs(difference) > allowed
        print(f"ok {name}" if abs(difference) <= allowed else f"not ok {name}: off by {difference:.1e}, more than {allowed:.0e}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
