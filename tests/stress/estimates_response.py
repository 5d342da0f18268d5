#!/usr/bin/env python3
"""Errors that the reports on the steady elastic response print, against the same machine described otherwise.

    estimates_response.py SEED COUNT [--program PATH] [--scratch DIR] [--validity] [--all] [--seconds S]

Random four-bars and slider-cranks, with and without damping, each at its accuracy against one finer by 1e4 that is also, in turn,
as it is, turned, mirrored with the crank the other way round, in other units, or, undamped, backwards (time reversal); with --all
against each of these at the same accuracy, too. A difference above the sum of both printed errors, each times the largest value of
the quantity over the crank angles, is a violation. Rows that fail, or decks that are refused, are counted. --validity asks for that
report only; after --seconds no case is begun. The last lines have the distribution of true by estimated errors, and `N passed, N failed`.
"""
import argparse
import collections
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

FINER = 1e-4
CRANK = tuple(range(0, 360, 5))
ROUNDING = 2e-11                               # of input angles and places that are turned, beside the printed errors
REPORTS = ("response", "strains", "peaks", "torque")


def draw(seed):
    """A machine as plain numbers [m, kg, s]."""
    rng = random.Random(seed)
    machine = {"slider": rng.random() < 0.4, "crank": rng.uniform(0.05, 0.12), "accuracy": 10 ** rng.uniform(-5, -2),
               "thick": [rng.uniform(0.002, 0.01) for _ in range(3)], "wide": rng.uniform(0.01, 0.03),
               "speed": rng.uniform(4, 30), "crossed": rng.random() < 0.5, "gravity": rng.choice((0.0, 9.81)),
               "damping": rng.choice(("", "", "", "time=%.4e" % 10 ** rng.uniform(-5, -3), "ratio=%.4f" % rng.uniform(0.01, 0.2))),
               "rigid": rng.random() < 0.3, "tip": rng.choice((0.0, rng.uniform(0.05, 0.5)))}
    if machine["slider"]:
        machine["rod"], machine["offset"] = machine["crank"] * rng.uniform(2.2, 4), machine["crank"] * rng.uniform(-0.3, 0.3)
    else:
        others = sorted(rng.uniform(0.15, 0.35) for _ in range(3))
        while others[2] > 0.9 * (others[0] + others[1]):
            others = sorted(rng.uniform(0.15, 0.35) for _ in range(3))
        while machine["crank"] + others[2] > 0.97 * (others[0] + others[1]) or machine["crank"] > 0.9 * others[0]:
            machine["crank"] *= 0.8
        rng.shuffle(others)
        machine["ground"], machine["rod"], machine["follower"] = others
    return machine


def deck(machine, reports, *, turned=0.0, mirrored=False, backwards=False, accuracy=1.0, millimetres=False):
    """The deck of a machine; `turned` by an angle [deg], mirrored in its x axis before that."""
    length, mass = (1e3, 1e-3) if millimetres else (1.0, 1.0)
    side = -1.0 if mirrored else 1.0
    cosine, sine = math.cos(math.radians(turned)), math.sin(math.radians(turned))

    def place(x, y):
        return "%.17g %.17g" % (length * (cosine * x - sine * side * y), length * (sine * x + cosine * side * y))

    # E [Pa] and density [kg/m3] in the units of the deck.
    stress, density = mass / length, mass / length ** 3
    lines = ["UNITS mm tonne s" if millimetres else "UNITS m kg s",
             "MATERIAL steel E=%.17g density=%.17g nu=0.3" % (2e11 * stress, 7800 * density), "GROUND O2 0 0"]
    for k in range(3):
        lines.append("SECTION s%d rectangle thickness=%.17g width=%.17g" % (k, machine["thick"][k] * length, machine["wide"] * length))
    made = "material=steel section=s%d"
    crank = "length=%.17g %s" % (machine["crank"] * length, "rigid mass=%.17g" % (0.3 * mass) if machine["rigid"] else made % 0)
    lines.append("LINK crank O2 A " + crank)
    lines.append("LINK rod A B length=%.17g %s" % (machine["rod"] * length, made % 1))
    if machine["slider"]:
        lines.append("GUIDE bore %s angle=%.17g" % (place(0.0, machine["offset"]), turned))
        lines.append("SLIDER B bore mass=%.17g" % (max(machine["tip"], 0.05) * mass))
        lines.append("BRANCH B forward")
    else:
        lines.append("GROUND O4 " + place(machine["ground"], 0.0))
        lines.append("LINK follower O4 B length=%.17g %s" % (machine["follower"] * length, made % 2))
        lines.append("BRANCH " + ("crossed" if machine["crossed"] != mirrored else "open"))
        if machine["tip"] > 0.0:
            lines.append("PINMASS B %.17g" % (machine["tip"] * mass))
    if machine["gravity"] > 0.0:
        lines.append("GRAVITY " + place(0.0, -machine["gravity"]))
    if machine["damping"]:
        lines.append("DAMPING * " + machine["damping"])
    sense = -1.0 if mirrored != backwards else 1.0
    lines += ["DRIVE crank", "INERTIA distributed", "SPEED %.17g rad/s" % (sense * machine["speed"]),
              "CRANK " + " ".join("%.17g" % (side * angle + turned) for angle in CRANK)]
    return "\n".join(lines + ["REPORT %s accuracy=%.3e" % (report, max(machine["accuracy"] * accuracy, 1e-12))
                              for report in reports]) + "\n"


def run(program, folder, name, text):
    """Tables by name, as rows of words; None if the deck was refused or a row failed."""
    path = os.path.join(folder, name + ".deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    done = subprocess.run([program, "--quiet", "--out", folder, path], capture_output=True, text=True, timeout=300, check=False)
    if done.returncode != 0:
        return None, [line for line in done.stderr.splitlines() if "error:" in line][:1]
    tables = {}
    for file_name in os.listdir(os.path.join(folder, name)):
        if file_name.endswith(".dat"):
            with open(os.path.join(folder, name, file_name), encoding="utf-8") as file:
                tables[file_name[:-4]] = [line.split() for line in file if line.strip() and line[0] != "#"]
    return tables, None


def quantities(tables, *, turned=0.0, mirrored=False, millimetres=False):
    """(report, quantity) to (values over the crank angles, relative error), in the axes and units of the plain deck."""
    side = -1.0 if mirrored else 1.0
    length = 1e-3 if millimetres else 1.0
    moment, stress, force = (1e-3, 1e6, 1.0) if millimetres else (1.0, 1.0, 1.0)
    cosine, sine = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    found = {}

    def put(key, value, error):
        values = found.setdefault(key, ([], error))[0]
        values.append(value)

    for row in tables.get("response", ()):
        u = [float(word) * length for word in row[3:5]]
        put(("response", row[2], "u"), (cosine * u[0] + sine * u[1], side * (cosine * u[1] - sine * u[0])), float(row[6]))
        put(("response", row[2], "rotation"), side * float(row[5]), float(row[6]))
    for row in tables.get("strains", ()):
        scales = (1.0, side, side * moment, force, side * force, stress)
        for name, word, scale in zip(("axial", "bending", "moment", "force", "shear", "stress"), row[3:9], scales):
            put(("strains", row[2], name), float(word) * scale, float(row[9]))
    for row in tables.get("torque", ()):
        for name, word in zip(("rigid", "linear", "quadratic", "total"), row[2:6]):
            put(("torque", name), side * float(word) * moment, float(row[7]))
    for row in tables.get("peaks", ()):
        for name, word, scale in (("strain", row[2], 1.0), ("stress", row[5], stress), ("deflection", row[8], length)):
            put(("peaks", row[1], name), float(word) * scale, float(row[12]))
    for row in tables.get("validity", ()):
        for name, word in zip(("deflection", "load", "quadratic", "out_of_plane", "distance"), row[2:7]):
            if word != "-":
                put(("validity", row[1], name), float(word), float(row[7]))
    return found


def size(value):
    return math.hypot(*value) if isinstance(value, tuple) else abs(value)


def difference(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1]) if isinstance(a, tuple) else abs(a - b)


def compare(one, other):
    """Pairs of (key, difference by largest value, sum of errors)."""
    lengths = {}
    for key, (values, _) in one.items():
        if key not in other or len(other[key][0]) != len(values):
            yield key, math.inf, 0.0
            continue
        largest = max(map(size, values))
        # What is zero by its nature is measured against what goes with it (docs/theory.md).
        with_it = lengths.setdefault(key[:-1], max((max(map(size, v)) for k, (v, _) in one.items()
                                                    if k[:-1] == key[:-1] and key[0] == "torque"), default=0.0))
        largest = max(largest, 1e-3 * with_it)
        if key[-1] in ("rotation", "axial", "bending", "moment", "force", "shear") and largest <= 0.0:
            continue
        apart = max(map(difference, values, other[key][0]))
        yield key, apart / max(largest, 1e-300), one[key][1] + other[key][1]


def is_small(key, one):
    """Whether a quantity is next to nothing beside what goes with it, so that its error is not relative to itself."""
    values = one[key][0]
    if key[-1] == "rotation":
        beside = max(map(size, one[(*key[:-1], "u")][0])) * 57.3 * 3.0
    elif key[0] == "strains":
        beside = max(map(size, one[(*key[:-1], "axial")][0])) + max(map(size, one[(*key[:-1], "bending")][0]))
        if key[-1] == "shear":
            beside = max(map(size, one[(*key[:-1], "force")][0]))
        elif key[-1] not in ("axial", "bending"):
            return False
    else:
        return False
    return max(map(size, values)) < 1e-2 * beside


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch")
    parser.add_argument("--validity", action="store_true")
    parser.add_argument("--all", action="store_true", help="all ways of showing a machine, at the same accuracy too")
    parser.add_argument("--seconds", type=float, default=math.inf)
    options = parser.parse_args()
    begun = time.time()
    folder = options.scratch or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    counts = collections.Counter()
    ratios = collections.defaultdict(list)
    for number in range(options.seed, options.seed + options.count):
        if time.time() - begun > options.seconds:
            break
        machine = draw(number)
        reports = ("validity",) if options.validity else REPORTS
        turned = random.Random(-number - 1).uniform(-170, 170)
        ways = {"finer": {}, "turned": {"turned": turned}, "mirrored": {"mirrored": True}, "units": {"millimetres": True}}
        if not machine["damping"]:
            ways["backwards"] = {"backwards": True}
        way = list(ways)[number % len(ways)]
        ways[way] = {**ways[way], "accuracy": FINER}
        if not options.all:
            ways = {way: ways[way]}
        plain, why = run(options.program, folder, "case", deck(machine, reports))
        if plain is None:
            counts["refused or failed"] += 1
            print(f"# {number}: {why}")
            continue
        one = quantities(plain)
        bad = []
        for way, changes in ways.items():
            tables, why = run(options.program, folder, "case", deck(machine, reports, **changes))
            if tables is None:
                counts["failed: " + way] += 1
                print(f"# {number} {way}: {why}")
                continue
            shown = {key: value for key, value in changes.items() if key in ("turned", "mirrored", "millimetres")}
            for key, apart, allowed in compare(one, quantities(tables, **shown)):
                if is_small(key, one):
                    continue
                if "accuracy" in changes and allowed > 0.0:
                    ratios[key[0]].append(apart / allowed)
                if apart > allowed + ROUNDING:
                    bad.append(f"{way} {'.'.join(key)}: {apart:.2e} > {allowed:.2e}")
        counts["failed" if bad else "passed"] += 1
        for line in bad[:4]:
            print(f"not ok {number}: {line}")
    if not options.scratch:
        shutil.rmtree(folder)
    for report, values in sorted(ratios.items()):
        values.sort()
        print(f"# {report}: true/estimated error: median {values[len(values) // 2]:.2g}, 99 % {values[-1 - len(values) // 100]:.2g}, "
              f"largest {values[-1]:.2g}; {len(values)} values")
    for name, number in sorted(counts.items()):
        if name not in ("passed", "failed"):
            print(f"# {name}: {number}")
    print(f"{counts['passed']} passed, {counts['failed']} failed")
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
