"""Steady responses of running linkages against running_beams.py: `running_checks.py [--program P] [--scratch DIR]` (needs NumPy).

For every linkage: the largest difference over the rows, relative to the largest value, of displacements and rotations of pins and of
strains; and of the mean power of the drive less what the links take, against what the dampers take.
"""
import argparse
import os
import subprocess
import tempfile

import numpy as np

from running_beams import Link, Running, circle_point

HEAD = """UNITS    mm kg s speed=rad/s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  bar   rectangle thickness=4.24 width=25.4
SECTION  strip rectangle thickness=1.6  width=25.4
INERTIA  distributed
DAMPING  * time=TIME
CRANK    0 to 357.1875 step 2.8125
SPEED    SPEEDS
REPORT   response accuracy=1e-10
REPORT   strains
REPORT   torque
REPORT   peaks
DRIVE    crank
GROUND   O2 0 0
"""
ENGINE = """GUIDE    bore 0 -20 angle=0
LINK     crank O2 A length=100 material=steel section=bar
LINK     rod   A  B length=280 material=steel section=strip
SLIDER   B bore mass=0.05
BRANCH   B forward
GAUGE    g1 rod   at=140
GAUGE    g2 crank at=20
"""
ELBOW = """GROUND   O4 254 0
LINK     crank    O2 A length=100 material=steel section=bar
LINK     coupler  A C B lengths=150,170 turns=-40 material=steel section=bar
LINK     follower O4 B length=266.7 material=steel section=strip
PINMASS  B 0.05
BRANCH   B left A O4
GAUGE    g1 coupler  at=75
GAUGE    g2 follower at=60
"""
FOUR_BAR = """GROUND   O4 254 0
LINK     crank    O2 A length=100   material=steel section=bar
LINK     coupler  A  B length=279.4 material=steel section=strip
LINK     follower O4 B length=266.7 material=steel section=strip
PINMASS  B 0.05
BRANCH   B left A O4
GAUGE    g1 coupler at=139.7
GAUGE    g2 crank   at=20
"""
LEVER = """GROUND   O4 0 -150
GUIDE    bed 0 140 angle=0
LINK     crank O2 A length=60  material=steel section=bar
LINK     lever O4 C length=320 material=steel section=bar
LINK     rod   C  D length=120 material=steel section=strip
SLIDER   A lever mass=0.03OF_BLOCK
SLIDER   D bed   mass=0.2
BRANCH   D forward
GAUGE    g1 lever at=60
GAUGE    g2 lever at=130
GAUGE    g3 lever at=250
GAUGE    g4 crank at=20
"""
#: Two blocks on one lever with a mass: pieces between a pin, the mass, both blocks and the end.
SECOND = """GROUND   O5 0 270
LINK     rocker O5 P length=190 material=steel section=strip
SLIDER   P lever mass=0.02
MASS     lever 0.2 at=40
BRANCH   P backward
GAUGE    g5 rocker at=100
"""
OF_ENGINE = """GROUND   P  150 60
DAMPER   da A P damping=40N*s/m
DAMPER   dt A crank rod damping=0.05N*m*s/rad
DAMPER   db B P damping=20N*s/m
"""
OF_FOUR_BAR = """GROUND   P  150 60
DAMPER   da A P damping=40N*s/m
DAMPER   dt B coupler follower damping=0.05N*m*s/rad
DAMPER   db B O2 damping=20N*s/m
SPRING   s  A O4 stiffness=0 force=15N
"""
BAR, STRIP, BLOCK = 4.24e-3, 1.6e-3, 3e-4


def link(first, last, thick, time, orders):
    area = thick * 25.4e-3
    return Link((first, last), 7800 * area, 200e9 * area, 200e9 * area * thick**2 / 12, *orders, damping=time)


def crank_pin(samples, speed):
    angle = np.copysign(2 * np.pi, speed) * np.arange(samples) / samples
    return 0.1 * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def engine(samples, speed, time, pulls, orders):
    a = crank_pin(samples, speed)
    b = np.stack([a[:, 0] + np.sqrt(0.28**2 - (a[:, 1] + 0.02)**2), np.full(samples, -0.02)], axis=1)
    links = [link("O2", "A", BAR, time, orders), link("A", "B", STRIP, time, orders)]
    return Running(abs(speed), {"A": a, "B": b}, {"O2": (0, 0), "P": (0.15, 0.06)}, links, {(0, 0)}, {"B": np.array([1.0, 0.0])},
                   {"B": 0.05}, pulls)


def four_bar(samples, speed, time, pulls, orders):
    a = crank_pin(samples, speed)
    b = circle_point(a, np.tile([0.254, 0.0], (samples, 1)), 0.2794, 0.2667, 1)
    links = [link("O2", "A", BAR, time, orders), link("A", "B", STRIP, time, orders), link("O4", "B", STRIP, time, orders)]
    return Running(abs(speed), {"A": a, "B": b}, {"O2": (0, 0), "O4": (0.254, 0), "P": (0.15, 0.06)}, links, {(0, 0)}, {},
                   {"B": 0.05}, pulls)


def elbow(samples, speed, time, pulls, orders):
    a = crank_pin(samples, speed)
    bend = np.radians(-40)
    corner, end = np.array([0.15, 0.0]), np.array([0.15 + 0.17 * np.cos(bend), 0.17 * np.sin(bend)])
    whole = np.linalg.norm(end)
    b = circle_point(a, np.tile([0.254, 0.0], (samples, 1)), whole, 0.2667, 1)
    # Axes of the coupler, from the direction of A to B.
    e, own = (b - a) / whole, end / whole
    x = np.stack([e[:, 0] * own[0] + e[:, 1] * own[1], e[:, 1] * own[0] - e[:, 0] * own[1]], axis=1)
    c = a + corner[0] * x
    links = [link("O2", "A", BAR, time, orders), link("A", "C", BAR, time, orders), link("C", "B", BAR, time, orders),
             link("O4", "B", STRIP, time, orders)]
    return Running(abs(speed), {"A": a, "C": c, "B": b}, {"O2": (0, 0), "O4": (0.254, 0), "P": (0.15, 0.06)}, links, {(0, 0)}, {},
                   {"B": 0.05}, pulls, welds=[((1, 1), (2, 0))])


def slotted_lever(samples, speed, time, elements, second=False):
    """The lever in nodal elements that keep their places; the block passes from one to the next. Undamped, it has a moment of inertia."""
    a = 0.6 * crank_pin(samples, speed)
    foot = np.array([0.0, -0.15])
    way = a - foot
    e = way / np.linalg.norm(way, axis=1)[:, None]
    pins = {"A": a}
    names = ["O4"] + [f"L{k}" for k in range(1, elements)] + ["C"]
    for k in range(1, elements + 1):
        pins[names[k]] = foot + 0.32 * k / elements * e
    c = pins["C"]
    pins["D"] = np.stack([c[:, 0] + np.sqrt(0.12**2 - (0.14 - c[:, 1])**2), np.full(samples, 0.14)], axis=1)
    links = [link("O2", "A", BAR, time, (2, 3))]
    links += [link(names[k], names[k + 1], BAR, time, (0, 0)) for k in range(elements)]
    links.append(link("C", "D", STRIP, time, (2, 3)))
    grounds, masses = {"O2": (0, 0), "O4": foot}, {"A": 0.03, "D": 0.2}
    blocks = [{"pin": "A", "on": list(range(1, elements + 1)), "inertia": 0.0 if time > 0 else BLOCK}]
    if second:
        grounds["O5"] = (0, 0.27)
        way = np.array(grounds["O5"]) - foot
        pins["P"] = foot + (e @ way - np.sqrt(0.19**2 - way @ way + (e @ way)**2))[:, None] * e
        links.append(link("O5", "P", STRIP, time, (2, 3)))
        masses.update({"P": 0.02, f"L{elements // 8}": 0.2})
        blocks.append(dict(blocks[0], pin="P", inertia=0.0))
    return Running(abs(speed), pins, grounds, links, {(0, 0)}, {"D": np.array([1.0, 0.0])}, masses,
                   welds=[((k, 1), (k + 1, 0)) for k in range(1, elements)], blocks=blocks)


ENGINE_PULLS = [{"damping": 40.0, "ends": ("A", "P")}, {"damping": 0.05, "turning": ((1, 0), (0, 1))}, {"damping": 20.0, "ends": ("B", "P")}]
FOUR_BAR_PULLS = [{"damping": 40.0, "ends": ("A", "P")}, {"damping": 0.05, "turning": ((2, 1), (1, 1))},
                  {"damping": 20.0, "ends": ("B", "O2")}, {"tension": 15.0, "ends": ("A", "O4")}]

#: name, cards, builder, pulls, speed, damping time, names of ends in the table, gauges (link, place, half of its depth)
CASES = [
    ("engine", ENGINE, engine, [], 12.0, 2e-3, {"A:crank": (0, 1), "A:rod": (1, 0), "B:rod": (1, 1)}, [(1, 0.14, STRIP), (0, 0.02, BAR)]),
    ("engine with dampers", ENGINE + OF_ENGINE, engine, ENGINE_PULLS, 20.0, 0.0,
     {"A:crank": (0, 1), "A:rod": (1, 0), "B:rod": (1, 1)}, [(1, 0.14, STRIP), (0, 0.02, BAR)]),
    ("the same, clockwise", ENGINE + OF_ENGINE, engine, ENGINE_PULLS, -20.0, 0.0,
     {"A:crank": (0, 1), "A:rod": (1, 0), "B:rod": (1, 1)}, [(1, 0.14, STRIP), (0, 0.02, BAR)]),
    ("four-bar, dampers, tension", FOUR_BAR + OF_FOUR_BAR, four_bar, FOUR_BAR_PULLS, 12.0, 5e-4,
     {"A:crank": (0, 1), "A:coupler": (1, 0), "B:coupler": (1, 1), "B:follower": (2, 1)}, [(1, 0.1397, STRIP), (0, 0.02, BAR)]),
    ("elbow with a damper", ELBOW + "GROUND   P 150 60\nDAMPER da A P damping=40N*s/m\n", elbow, ENGINE_PULLS[:1], 15.0, 1e-3,
     {"A:crank": (0, 1), "A:coupler": (1, 0), "B:coupler": (2, 1), "B:follower": (3, 1)}, [(1, 0.075, BAR), (3, 0.06, STRIP)]),
]


def run(program, folder, cards, speeds, time):
    text = (HEAD + cards).replace("SPEEDS", " ".join(f"{s:g}" for s in speeds))
    text = text.replace("TIME", f"{time:g}") if time else text.replace("DAMPING  * time=TIME\n", "")
    path = os.path.join(folder, "running.deck")
    with open(path, "w", encoding="ascii") as file:
        file.write(text + "END\n")
    subprocess.run([program, "--quiet", "--out", folder, path], check=True)
    return os.path.join(folder, "running")


def table(folder, name):
    with open(os.path.join(folder, name), encoding="ascii") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]


def at(series, degrees, speed):
    """Values of a trigonometric polynomial, given at samples."""
    n = len(series)
    c = np.fft.rfft(series) / n
    wave = np.exp(1j * np.copysign(1, speed) * np.radians(degrees) * np.arange(len(c)))
    return float((c[0] + 2 * np.sum(c[1:] * wave[1:])).real)


def compare(case, program, folder, samples, orders):
    name, cards, build, pulls, speed, time, ends, gauges = case
    model = build(samples, speed, time, pulls, orders)
    model.solve()
    tables = run(program, folder, cards, [speed], time)
    rows = {(float(r[1]), r[2]): [float(v) for v in r[3:6]] for r in table(tables, "response.dat")}
    degrees = sorted({d for d, _ in rows})
    worst = {"displacements": 0.0, "rotations": 0.0, "axial strains": 0.0, "strains of bending": 0.0}

    def note(what, found, series, unit):
        known = [at(series, d, speed) * unit for d in degrees]
        scale = np.abs(series).max() * unit
        worst[what] = max(worst[what], np.abs(np.array(found) - known).max() / scale)

    for end, (i, which) in ends.items():
        here = np.array([rows[d, end] for d in degrees])
        moved = model.displacement(model.links[i].ends[which])
        scale = np.linalg.norm(moved, axis=1).max()
        for k in range(2):
            known = np.array([at(moved[:, k], d, speed) for d in degrees])
            worst["displacements"] = max(worst["displacements"], np.abs(here[:, k] / 1e3 - known).max() / scale)
        note("rotations", here[:, 2], model.rotation(i, which), 180 / np.pi)
    strains = {(float(r[1]), r[2]): [float(v) for v in r[3:5]] for r in table(tables, "strains.dat")}
    for g, (i, place, depth) in zip(("g1", "g2"), gauges):
        axial, curvature = model.strains(i, place)
        note("axial strains", [strains[d, g][0] for d in degrees], axial, 1.0)
        note("strains of bending", [strains[d, g][1] for d in degrees], curvature, depth / 2)
    rows = table(tables, "torque.dat")
    mean = sum(float(r[5]) for r in rows) / len(rows)
    return name, model, worst, tables, model.lost_power()[0], mean


def lever(time):
    """Its cards; undamped, the block has a moment of inertia."""
    return LEVER.replace("OF_BLOCK", "" if time > 0 else f" inertia={BLOCK:g}kg*m2")


def block_on_lever(program, folder, speed, time, meshes, samples, second=False):
    """A block on a lever that bends, at the samples themselves: with more nodes the differences fall."""
    cards = HEAD.replace("0 to 357.1875 step 2.8125", " ".join(f"{360 * k / samples:.16g}" for k in range(samples))) + lever(time)
    cards = (cards + SECOND if second else cards).replace("TIME", f"{time:g}").replace("SPEEDS", f"{speed:g}")
    path = os.path.join(folder, "lever.deck")
    with open(path, "w", encoding="ascii") as file:
        file.write(cards + "END\n")
    subprocess.run([program, "--quiet", "--out", folder, path], check=True)
    tables = os.path.join(folder, "lever")
    rows, strains = table(tables, "response.dat"), table(tables, "strains.dat")
    for elements in meshes:
        model = slotted_lever(samples, speed, time, elements, second)
        model.solve()
        said = []
        ends = {"A:crank": (0, 1), "C:lever": (elements, 1), "C:rod": (elements + 1, 0), "D:rod": (elements + 1, 1)}
        if second:
            ends["P:rocker"] = (elements + 2, 1)
        for end, (i, which) in ends.items():
            here = np.array([[float(v) for v in r[3:6]] for r in rows if r[2] == end])
            moved, turned = model.displacement(model.links[i].ends[which]), model.rotation(i, which) * 180 / np.pi
            said.append(f"{end} {np.abs(here[:, :2] / 1e3 - moved).max() / np.linalg.norm(moved, axis=1).max():.1e} "
                        f"{np.abs(here[:, 2] - turned).max() / np.abs(turned).max():.1e}")
        for g, place in (("g1", 0.06), ("g2", 0.13), ("g3", 0.25)):
            here = np.array([[float(v) for v in r[3:5]] for r in strains if r[2] == g])
            which = min(int(place / 0.32 * elements), elements - 1)
            axial, curvature = model.strains(1 + which, place - 0.32 * which / elements)
            bent = curvature * BAR / 2
            said.append(f"{g} {np.abs(here[:, 0] - axial).max() / np.abs(axial).max():.1e} "
                        f"{np.abs(here[:, 1] - bent).max() / np.abs(bent).max():.1e}")
        print(f"{'two blocks and a mass' if second else 'block'} on a lever, {speed:g} rad/s, c = {time:g} s, {elements} elements, {samples} samples: " + ", ".join(said), flush=True)


def slow_lever(program, folder, samples, elements):
    """The lever at falling speeds, per square of the speed, less the deflection of the frozen linkage."""
    model = slotted_lever(samples, 1e-3, 0.0, elements)
    model.solve(at_rest=True)
    known = model.rotation(elements, 1) * 1e6 * 180 / np.pi
    speeds = [8.0, 4.0, 2.0]
    cranks = " ".join(f"{360 * k / samples:.16g}" for k in range(samples))
    text = HEAD.replace("0 to 357.1875 step 2.8125", cranks) + lever(0.0)
    path = os.path.join(folder, "slow.deck")
    with open(path, "w", encoding="ascii") as file:
        file.write(text.replace("TIME", "0").replace("SPEEDS", " ".join(f"{s:g}" for s in speeds)) + "END\n")
    subprocess.run([program, "--quiet", "--out", folder, path], check=True)
    rows = table(os.path.join(folder, "slow"), "response.dat")
    said = []
    for speed in speeds:
        found = np.array([float(r[5]) for r in rows if float(r[0]) == speed and r[2] == "C:lever"]) / speed**2
        said.append(f"{speed:g} rad/s {np.abs(found - known).max() / np.abs(known).max():.2e}")
    print("block on a lever: rotations of its end at " + ", ".join(said), flush=True)


def slow(program, folder, samples, orders):
    """The response to the inertia loads at falling speeds, per square of the speed, less the deflection of the frozen linkage."""
    for name, cards, build, ends in (("engine", ENGINE, engine, {"A:crank": (0, 1), "A:rod": (1, 0), "B:rod": (1, 1)}),
                                     ("elbow", ELBOW, elbow, {"B:coupler": (2, 1), "B:follower": (3, 1)})):
        model = build(samples, 1e-3, 0.0, [], orders)
        model.solve(at_rest=True)
        speeds = [8.0, 4.0, 2.0]
        tables = run(program, folder, cards, speeds, 1e-6)
        found = {s: 0.0 for s in speeds}
        for r in table(tables, "response.dat"):
            if r[2] not in ends:
                continue
            series = model.rotation(*ends[r[2]]) * 1e6 * 180 / np.pi
            speed = float(r[0])
            found[speed] = max(found[speed], abs(float(r[5]) / speed**2 - at(series, float(r[1]), 1.0)) / np.abs(series).max())
        print(f"{name}: rotations at " + ", ".join(f"{s:g} rad/s {found[s]:.3e}" for s in speeds))


def in_time(program, folder, samples, orders):
    """A turn from rest, undeformed, of the engine with dampers: pins A and B at 36 instants."""
    model = engine(samples, 12.0, 1e-3, ENGINE_PULLS, orders)
    cards = ENGINE + OF_ENGINE + "REPORT   transient turns=1 instants=36 accuracy=1e-8\n"
    tables = run(program, folder, cards, [12.0], 1e-3)
    rows = [r for r in table(tables, "transient.dat")]
    for steps in (10, 20):
        moved = model.integrate(36, steps)
        said = []
        for end, pin in (("A:rod", "A"), ("B:rod", "B")):
            here = np.array([[float(v) for v in r[4:6]] for r in rows if r[3] == end]) / 1e3
            known = moved @ model.pin_rows(pin)[0].T
            said.append(f"{pin} {np.abs(here - known).max() / np.abs(known).max():.1e}")
        print(f"engine with dampers from rest, {36 * steps} steps: " + ", ".join(said))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch")
    parser.add_argument("--samples", type=int, default=129)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.scratch or scratch
        os.makedirs(folder, exist_ok=True)
        for case in CASES:
            name, model, worst, tables, lost, mean = compare(case, options.program, folder, options.samples, (6, 9))
            tail = np.abs(np.fft.rfft(model.y, axis=0))
            of_links = sum(float(r[11]) for r in table(tables, "peaks.dat"))
            power = mean * case[4]
            said = ", ".join(f"{what} {value:.1e}" for what, value in worst.items())
            print(f"{name}, {case[4]:g} rad/s: {said}; power of the drive {power:.10g} W, of links and dampers "
                  f"{of_links + lost:.10g} W; highest harmonics {tail[-4:].max() / tail.max():.0e}")
        block_on_lever(options.program, folder, 8.0, 1e-3, (4, 8, 16), 65)
        block_on_lever(options.program, folder, 25.0, 1e-3, (8, 16), 65)
        block_on_lever(options.program, folder, 40.0, 0.0, (8, 16), 97)
        block_on_lever(options.program, folder, 8.0, 1e-3, (8, 16), 65, second=True)
        block_on_lever(options.program, folder, 15.0, 0.0, (8, 16), 65, second=True)
        slow_lever(options.program, folder, 65, 12)
        in_time(options.program, folder, options.samples, (6, 9))
        slow(options.program, folder, 97, (6, 9))


if __name__ == "__main__":
    main()
