"""The families of the stress test: every function yields its cases."""

import glob
import os
from decimal import Decimal

from decks import FIRST, RADIAN, Case, Linkage, WrittenCase, digits
from random_linkages import random_cases
from verdicts import BOUNDED, FAILED

TEN = Decimal(10)
SOLVERS = ("deformation", "dense", "band")
STRIP_AREA, STRIP_INERTIA = Decimal("40.64"), Decimal("8.6698666666666666667")  # 1.6 × 25.4 mm
LINKS = ("crank", "coupler", "follower")
TIMOSHENKO = "axial rotary shear"
LINK_MASS = Decimal("7.8e-9") * STRIP_AREA * Decimal("279.4")

# Of the decks in bounds/: one has no lowest frequency, one is near a dead point but far enough; one takes long.
BOUNDS_WANTED = {17: FAILED, 18: BOUNDED}
BOUNDS_ALONE = (16,)

# Crank speed at which the lowest eigenvalue of the first mechanism at 60 degrees is zero [rad/s].
CRITICAL_SPEED = Decimal("197.81054170615117302248815671116894")


def ladder(first, last, step=1):
    """Powers of ten."""
    return [TEN**k for k in range(first, last + (1 if step > 0 else -1), step)]


def elements():
    """Cubic elements a link, at rest and at 20 rad/s."""
    for n in (1, 2, 3, 5, 8, 10, 20, 30, 50, 100, 200, 300):
        for solver in SOLVERS:
            few = solver == "dense" and n > 50
            yield Case("elements", n, solver, FIRST, (60,) if few else (0, 60, 240), (0, 20), f"MESH * elements={n}", solver,
                       same_mesh=True)
    for n in (1, 3, 10, 30, 100, 300):
        yield Case("elements", n, "lumped", FIRST, (60,), (20,), f"MESH * elements={n}", "deformation", "lumped", same_mesh=True)


def orders():
    """One element per link, and four, of orders 3 to 16."""
    for order in range(3, 17):
        for n in (1, 4):
            for solver in SOLVERS:
                yield Case("orders", order, f"{solver}-{n}", FIRST, (0, 60, 240), (0, 20), f"MESH * elements={n} order={order}",
                           solver, modes=5, same_mesh=True)


def accuracy():
    """The orders that the program chooses for an accuracy."""
    for k in range(2, 14):
        yield Case("accuracy", TEN**-k, "auto", FIRST, (0, 60, 240), (0, 20), f"MESH * accuracy=1e-{k}", modes=5)


def ways(elements=4, order=3):
    """Label, mesh and solver of the usual four ways."""
    yield "accuracy", "MESH * accuracy=1e-10", "auto"
    for solver in SOLVERS:
        yield solver, f"MESH * elements={elements} order={order}", solver


def thickness():
    """All links thinner and thinner; speeds in step, so that the loads bend them alike."""
    for k in range(2, 13):
        ratio = TEN**-(k // 2) * (1 if k % 2 == 0 else Decimal("0.3"))
        section = f"rectangle thickness={100*ratio:f} width=25.4"
        linkage = Linkage(254, FIRST.lengths, [section] * 3)
        speed = (20*100*ratio/Decimal("1.6")).normalize()
        for label, mesh, solver in ways(1, 12):
            yield Case("thickness", ratio, label, linkage, (0, 60, 240), (0, speed), mesh, solver)


def stiffness():
    """Axial stiffness alone: A times k, the density divided by it, I kept."""
    for k in ladder(0, 6):
        linkage = Linkage(254, FIRST.lengths, [f"general A={STRIP_AREA*k:f} I={STRIP_INERTIA}"] * 3,
                          [f"E=200000 density={Decimal('7.8e-9')/k}"] * 3)
        for label, mesh, solver in ways(1, 12):
            yield Case("stiffness", k, label, linkage, (0, 60, 240), (0, 20), mesh, solver)


def lengths():
    """Links a thousand times as long as others: which are short is the variant. Thickness a hundredth of the length of each."""
    shapes = {
        "crank": lambda s: (254, 279*s, 290, 280),
        "ground": lambda s: (254*s, 280, 290, 285),
        "coupler": lambda s: (254, 254, 290*s, 254),
        "crank+follower": lambda s: (280, 200*s, 280, 250*s),
        "ground+follower": lambda s: (280*s, 260, 260, 250*s),
        "coupler+follower": lambda s: (254, 254, 200*s, 250*s),
    }
    angles = {"coupler": lambda s: 60, "coupler+follower": lambda s: 30*s, "ground+follower": lambda s: 90}
    for k in range(0, 7):
        s = TEN**-(k // 2) * (1 if k % 2 == 0 else Decimal("0.3"))
        for name, shape in shapes.items():
            ground, *links = shape(s)
            crank = angles.get(name, lambda s: Decimal(70))(s)
            for alike in (False, True):
                sections = [f"rectangle thickness={Decimal('1.6') if alike else Decimal(l)/100:f} width=25.4" for l in links]
                linkage = Linkage(ground, links, sections)
                yield Case("lengths", s, f"{name}{'-strip' if alike else ''}", linkage, (crank,), (0, 10))


def pin_masses():
    """Masses at both moving pins, in units of the mass of the coupler."""
    for ratio in [Decimal(0)] + ladder(-2, 6):
        mass = ratio*LINK_MASS
        speed = round(2/max(Decimal(1), ratio).sqrt(), 20)  # so that the loads stay what they are
        linkage = Linkage(254, FIRST.lengths, pins=(mass, mass))
        for label, mesh, solver in ways(1, 12):
            yield Case("pin_masses", ratio, label, linkage, (0, 60, 240), (0, speed), mesh, solver)
        yield Case("pin_masses", ratio, "long", linkage, (0, 60, 240), (0, speed), "MESH * elements=100", "deformation")
        yield Case("pin_masses", ratio, "20modes", linkage, (0, 60, 240), (0, speed), modes=20)


def dead_points():
    """Ever nearer to a dead point that lies at exactly 90 or 0 degrees: dyad stretched, folded, and a change point."""
    linkages = {
        "stretched": (Linkage(120, (160, 110, 90)), 90, -1),
        "folded": (Linkage(120, (160, 350, 150)), 90, 1),
        "change": (Linkage(250, (100, 250, 100)), 0, 1),
    }
    for k in range(2, 17):
        offset = TEN**-(k // 2) * (1 if k % 2 == 0 else Decimal("0.3"))
        for name, (linkage, angle, sense) in linkages.items():
            crank = round(angle + sense*offset*RADIAN, 30)
            yield Case("dead_points", offset, f"{name}-rest", linkage, (crank,))
            # At one speed the loads grow without bound towards a dead point; in step with the offset they do not.
            if offset >= Decimal("1e-3") or offset <= Decimal("1e-7"):
                yield Case("dead_points", offset, f"{name}-load", linkage, (crank,), (2,))
            yield Case("dead_points", offset, f"{name}-step", linkage, (crank,), (20*offset,))
        linkage = linkages["stretched"][0]
        crank = round(90 - offset*RADIAN, 30)
        for speed in (0, 20*offset):
            for solver in ("deformation", "dense"):
                yield Case("dead_points", offset, f"{solver}-{'step' if speed else 'rest'}", linkage, (crank,), (speed,),
                           "MESH * elements=8", solver)


def speeds():
    """The first mechanism up to its divergence and far past it."""
    for speed in (1, 3, 10, 20, 50, 100, 150, 200, 300, 500, 700, 1000, 1500, 2000, 3000, 5000):
        crank = (0, 60, 240) if speed <= 300 else (60,)
        for label, mesh, solver in ways(8):
            yield Case("speeds", speed, label, FIRST, crank, (speed,), mesh, solver)
        yield Case("speeds", speed, "long", FIRST, crank, (speed,), "MESH * elements=100", "deformation")


def divergence():
    """Ever nearer to the speed at which the lowest frequency is zero."""
    for k in range(1, 14):
        for side in (-1, 1):
            speed = round(CRITICAL_SPEED*(1 + side*TEN**-k), 30)
            for label, mesh, solver in ways(1, 12):
                yield Case("divergence", side*TEN**-k, label, FIRST, (60,), (speed,), mesh, solver)


def near_equal():
    """Coupler and follower alike, held by pins so heavy that their vibrations come in pairs, ever more nearly equal."""
    for k in range(0, 11):
        linkage = Linkage(300, (100, 250, 250), pins=[LINK_MASS*TEN**k]*2)
        for label, mesh, solver in ways(1, 12):
            yield Case("near_equal", TEN**-k, label, linkage, (60,), (0,), mesh, solver, modes=8)
    for k in range(1, 13):
        sections = [f"general A={STRIP_AREA} I={STRIP_INERTIA*factor}" for factor in (1, 1, 1 + TEN**-k)]
        linkage = Linkage(300, (100, 250, 250), sections, pins=[LINK_MASS*10**6]*2)
        for label, mesh, solver in ways(1, 12):
            yield Case("near_equal", TEN**-k, f"{label}-I", linkage, (60,), (0,), mesh, solver, modes=8)


def units():
    """The first mechanism in a world where lengths, masses or times are 10**k times as large."""
    for k in (-9, -6, -3, 0, 3, 6, 9):
        for name, (l, m, t) in {"length": (k, 0, 0), "mass": (0, k, 0), "time": (0, 0, k), "all": (k, k, k)}.items():
            area, inertia = STRIP_AREA*TEN**(2*l), STRIP_INERTIA*TEN**(4*l)
            linkage = Linkage(254*TEN**l, [length*TEN**l for length in FIRST.lengths], [f"general A={area:e} I={inertia:e}"] * 3,
                              [f"E={200000*TEN**(m - l - 2*t):e} density={Decimal('7.8e-9')*TEN**(m - 3*l):e}"] * 3)
            for label, mesh, solver in ways():
                yield Case("units", TEN**k, f"{name}-{label}", linkage, (0, 60, 240), (0, 20*TEN**-t), mesh, solver)


def masses_on(ratio, number, thickness=Decimal("1.6")):
    """Cards of masses spread along every link of the first mechanism, together so many times the mass of their link."""
    for link, length in zip(LINKS, FIRST.lengths):
        mass = ratio*Decimal("7.8e-9")*Decimal("25.4")*thickness*length/number
        for i in range(number):
            # Not evenly, so that no two pieces of a link are alike.
            at = Decimal(length)*(2*i + 1)/(2*number)*(1 - Decimal(i % 2)/20)
            yield f"MASS {link} {mass.normalize():e} at={round(at, 10).normalize():f}"


def link_masses():
    """Masses along links, in units of the mass of their link."""
    for ratio in ladder(-2, 6):
        speed = round(2/max(Decimal(1), ratio).sqrt(), 20)  # so that the loads stay what they are
        for number, modes in ((1, 3), (1, 20), (3, 3), (3, 10), (3, 20)):
            linkage = Linkage(254, FIRST.lengths, more=tuple(masses_on(ratio, number)))
            yield Case("link_masses", ratio, f"{number}-{modes}modes", linkage, (40,), (0, speed), modes=modes)
        linkage = Linkage(254, FIRST.lengths, more=tuple(masses_on(ratio, 1)))
        for label, mesh, solver in list(ways(2, 8))[1:]:
            yield Case("link_masses", ratio, label, linkage, (40,), (0, speed), mesh, solver)


def masses_beside(ratio, number, arm, own):
    """Cards of masses at alternate sides of every link of the first mechanism, so many lengths of the link away, together so many
    times its mass, with so many mass × length² of moment of inertia."""
    for link, length in zip(LINKS, FIRST.lengths):
        mass = ratio*LINK_MASS/number
        for i in range(number):
            at = Decimal(length)*(2*i + 1)/(2*number)*(1 - Decimal(i % 2)/20)
            card = f"MASS {link} {mass:e} at={round(at, 10).normalize():f} offset={digits((-1)**i*arm*length)}"
            yield card + (f" inertia={own*mass*length**2:e}" if own else "")


def offset_masses():
    """Masses beside links, with moments of inertia of their own, in units of the mass of a link, and ever farther away."""
    own = Decimal("0.01")
    for ratio in ladder(-2, 6, 2):
        speed = round(2/max(Decimal(1), ratio).sqrt(), 20)  # so that the loads stay what they are
        for number, inertia, modes, effects in ((1, 0, 3, "axial"), (1, own, 10, "axial"), (3, own, 10, "axial"),
                                                (1, own, 5, TIMOSHENKO), (3, 0, 5, "axial shear")):
            more = tuple(masses_beside(ratio, number, Decimal("0.1"), inertia))
            linkage = Linkage(254, FIRST.lengths, materials=["E=200000 density=7.8e-9 nu=0.3"]*3, more=more)
            yield Case("offset_masses", ratio, f"{number}-{modes}modes-{effects.replace(' ', '-')}", linkage, (40,), (0, speed),
                       modes=modes, effects=effects)
        linkage = Linkage(254, FIRST.lengths, more=tuple(masses_beside(ratio, 1, Decimal("0.1"), own)))
        for label, mesh, solver in list(ways(2, 8))[1:]:
            yield Case("offset_masses", ratio, label, linkage, (40,), (0, speed), mesh, solver)
    for arm in ladder(-4, 1):
        # Their weight presses or pulls, whatever their side; on a mesh they are within elements.
        more = ("GRAVITY 1000 -9810", *masses_beside(Decimal("0.1"), 3, arm, 0))
        linkage = Linkage(254, FIRST.lengths, more=more)
        for label, mesh, solver in ways(4, 6):
            yield Case("offset_masses", arm, f"arm-{label}", linkage, (60, 240), (0, 2), mesh, solver, modes=5)


def many_modes():
    """Ever more modes of slender links."""
    for modes in (3, 5, 10, 20, 30, 40, 60, 80, 100):
        yield Case("many_modes", modes, "accuracy", FIRST, (60,), (0, 20), modes=modes)
        yield Case("many_modes", modes, "loose", FIRST, (60,), (0, 20), "MESH * accuracy=1e-4", modes=modes)
        for solver in SOLVERS:
            yield Case("many_modes", modes, solver, FIRST, (60,), (0, 20), "MESH * elements=40", solver, modes=modes)


def stout(ratio):
    """The first mechanism with links so many thicknesses long."""
    sections = [f"rectangle thickness={round(length/ratio, 12).normalize():f} width=25.4" for length in map(Decimal, FIRST.lengths)]
    return Linkage(254, FIRST.lengths, sections, ["E=200000 density=7.8e-9 nu=0.3"]*3)


def thick_links():
    """Stout links with rotary inertia and shear; speeds in step with the stiffness."""
    for ratio in (Decimal("2.5"), Decimal("3.5"), Decimal(5), Decimal(7), Decimal(10)):
        speed = round(2000/ratio, 10)
        for modes in (5, 10, 20, 40):
            yield Case("thick_links", ratio, f"{modes}modes", stout(ratio), (60,), (0, speed), modes=modes, effects=TIMOSHENKO)
        for label, mesh, solver in list(ways(3, 6))[1:]:
            yield Case("thick_links", ratio, label, stout(ratio), (60,), (0, speed), mesh, solver, modes=5, effects=TIMOSHENKO)


def compression():
    """A force on pin B that compresses the links there, up to a thousand times what buckles the follower."""
    for times in (Decimal(k)*TEN**e for e in range(-1, 3) for k in (1, 2, 5)):
        yield from compressed(times)
    yield from compressed(Decimal(1000))


def compressed(times):
    for label, linkage, effects in (("strip", Linkage(254, FIRST.lengths), "axial"), ("thick", stout(Decimal(100)), TIMOSHENKO)):
        thickness = Decimal(linkage.sections[2].split("thickness=")[1].split()[0])
        euler = Decimal("9.8696044010893586188")*200000*Decimal("25.4")*thickness**3/12/Decimal("266.7")**2
        linkage.more = (f"FORCE B 0 {round(-times*euler, 12).normalize():f}",)
        for modes in (3, 10):
            yield Case("compression", times, f"{label}-{modes}modes", linkage, (60,), modes=modes, effects=effects)
        yield Case("compression", times, f"{label}-mesh", linkage, (60,), (0,), "MESH * elements=6 order=8", "deformation",
                   effects=effects)


def promises():
    """The orders chosen for an accuracy where links carry masses, are stout, compressed, or have many modes."""
    for k in range(2, 13):
        mesh = f"MESH * accuracy=1e-{k}"
        loaded = Linkage(254, FIRST.lengths, more=tuple(masses_on(TEN**2, 3)))
        yield Case("promises", TEN**-k, "masses", loaded, (40,), (0, Decimal("0.2")), mesh, modes=10)
        yield Case("promises", TEN**-k, "slender", FIRST, (60,), (0, 20), mesh, modes=40)
        yield Case("promises", TEN**-k, "stout", stout(Decimal(5)), (60,), (0, 400), mesh, modes=10, effects=TIMOSHENKO)
        for times in (10, 100):
            case = next(case for case in compressed(Decimal(times)) if case.variant == "strip-3modes")
            case.family, case.parameter, case.variant, case.mesh = "promises", TEN**-k, f"compressed-{times}", mesh
            yield case


def bounds():
    """Decks whose errors once exceeded their estimates or accuracy=; at the accuracies of then and others."""
    for path in sorted(glob.glob(os.path.join("tests", "stress", "bounds", "*.deck"))):
        name = os.path.basename(path)
        number = int(name.split("_")[0])
        wanted = BOUNDS_WANTED.get(number)
        own = WrittenCase("bounds", number, path, wanted=wanted)
        yield own
        if number not in BOUNDS_ALONE:
            for accuracy in ("1e-2", "1e-5", "1e-8", "1e-10", "1e-13"):
                if accuracy != own.variant:
                    yield WrittenCase("bounds", number, path, accuracy, wanted)


FAMILIES = {function.__name__: function for function in (
    elements, orders, accuracy, thickness, stiffness, lengths, pin_masses, dead_points, speeds, divergence, near_equal, units,
    link_masses, offset_masses, many_modes, thick_links, compression, promises, bounds)}
FAMILIES["random"] = random_cases
