"""A link in two pieces of equal section, welded at a pin where nothing else is, against the undivided link: every report.

  welded_sections.py SEED COUNT --program PATH [--scratch DIR]

Random slider-cranks; crank or rod is divided.  Values differ by no more than what is printed as their errors, those without an error
column by rounding.
"""
import argparse
import math
import pathlib
import random
import subprocess
import sys
import tempfile

# Table: key columns, columns of names that are followed, values, and the error column (empty: rounding).  Largest values of a
# quantity at a name are what errors are relative to, but for those of a number by itself.
TABLES = {
    "kinematics": (["crank"], ["link"], ["theta", "omega", "alpha"], ""),
    "pins": (["crank"], ["pin"], ["x", "y", "vx", "vy", "ax", "ay"], ""),
    "reactions": (["speed", "crank"], ["pin", "link"], ["fx", "fy"], ""),
    "bearings": (["speed", "crank"], ["pin", "link"], ["fx", "fy", "magnitude"], ""),
    "drives": (["speed", "crank"], ["drive"], ["force", "torque"], ""),
    "frame": (["speed", "crank"], [], ["shaking_x", "shaking_y", "shaking_moment", "frame_x", "frame_y", "frame_moment"], ""),
    "lagrange": (["speed", "crank"], [], ["M", "dM", "V", "gravity", "torque", "kinetic"], ""),
    "sizing": (["speed", "quantity"], ["part", "pin"], ["value"], "error"),
    "response": (["speed", "crank"], ["point"], ["ux", "uy", "rotation"], "error"),
    "strains": (["speed", "crank"], ["gauge"], ["axial_strain", "bending_strain", "moment", "axial_force", "shear_force"], "error"),
    "torque": (["speed", "crank"], [], ["rigid", "linear", "quadratic", "total"], "error"),
    "transient": (["speed", "time"], ["point"], ["ux", "uy"], "error"),
}
NUMBERS = {"frequencies": (["speed", "crank"], [(f"f{k}", f"error{k}") for k in (1, 2, 3)])}
REPORTS = sorted(set(TABLES) | set(NUMBERS) | {"peaks", "shapes", "branches", "linkage", "balance", "equilibrium"})


def deck(rng):
    """Both decks, and the names of the pieces of the divided link at its two pins."""
    crank, rod, offset = rng.uniform(0.05, 0.1), rng.uniform(0.25, 0.5), rng.uniform(-0.03, 0.03)
    start = math.radians(rng.uniform(0, 360))
    a = (crank*math.cos(start), crank*math.sin(start))
    b = (a[0] + math.sqrt(rod**2 - (offset - a[1])**2), offset)
    name, first, last, length, ends = rng.choice([("rod", "A", "B", rod, (a, b)), ("crank", "O", "A", crank, ((0, 0), a))])
    part, gauge = rng.uniform(0.2, 0.8), rng.uniform(0.05, 0.95)
    middle = [p + part*(q - p) for p, q in zip(*ends)]
    beam = "material=steel section=strip"
    head = f"""UNITS m kg s force=N torque=N*m
MATERIAL steel E=2.1e11 density=7850 nu=0.3
SECTION strip rectangle thickness={rng.uniform(0.006, 0.01):.3g} width=0.02
GROUND O 0 0
GUIDE bore 0 {offset!r} angle=0
SLIDER B bore mass={rng.uniform(0.05, 0.3):.3g}
DRIVE crank
SPEED {rng.choice([1, -1])*rng.uniform(8, 20):.4g}
MODES 3
EFFECTS axial{rng.choice(['', ' rotary', ' rotary shear'])}
INERTIA distributed
DAMPING * time=2e-4
CRANK 0 to 360 step 45
PIN A {a[0]!r} {a[1]!r}
PIN B {b[0]!r} {b[1]!r}
"""
    whole, halves = head, head
    for link, start_pin, end_pin, long in (("crank", "O", "A", crank), ("rod", "A", "B", rod)):
        whole += f"LINK {link} {start_pin} {end_pin} length={long!r} {beam}\n"
        if link != name:
            halves += f"LINK {link} {start_pin} {end_pin} length={long!r} {beam}\n"
    halves += f"PIN M {middle[0]!r} {middle[1]!r}\n"
    # The first half of the crank is that which is driven.
    second = "half"
    halves += f"LINK {name} {first} M length={part*length!r} {beam}\nLINK {second} M {last} length={(1 - part)*length!r} {beam}\n"
    halves += f"WELD M {name} {second}\n"
    whole += f"GAUGE g {name} at={gauge*length!r}\n"
    where = f"{name} at={gauge*length!r}" if gauge < part else f"{second} at={(gauge - part)*length!r}"
    halves += f"GAUGE g {where}\n"
    for report in REPORTS:
        line = f"REPORT {report}" + {"transient": " turns=0.3", "shapes": " crank=90"}.get(report, "") + "\n"
        whole += line
        halves += line
    return whole, halves, name, last


def rows(path):
    """The rows of a table, as dictionaries, and the units."""
    lines = path.read_text().splitlines()
    data = next(k for k, line in enumerate(lines) if line and not line.startswith("#"))
    names = lines[data - 2].lstrip("#").split()
    found = []
    for line in lines[data:]:
        if line.startswith("# failed"):
            raise ValueError(f"{path.name}: {line}")
        if line.strip():
            found.append(dict(zip(names, line.split())))
    return found


def key_of(row, keys, names, name, last, divided):
    """What tells a row: numbers with ten digits, and names as those of the undivided link."""
    parts = [row[k] if k in ("quantity",) else f"{float(row[k]):.9e}" for k in keys]
    for column in names:
        word = row.get(column, "")
        if divided and column == "point" and word == f"{last}:half":
            word = f"{last}:{name}"
        if divided and column in ("link", "part") and word == "half":
            if row.get("pin", "") != last:
                return None
            word = name
        elif divided and column in ("link", "part") and word == name and row.get("pin", "-") == "M":
            return None
        if column in ("pin",) and word == "M" or column == "point" and word.startswith("M:"):
            return None
        parts.append(word)
    return tuple(parts)


def compare(folders, name, last):
    """What differs, in words."""
    said = []
    for table, (keys, names, values, error) in TABLES.items():
        both = []
        for folder, divided in zip(folders, (False, True)):
            found = {}
            for row in rows(folder / f"{table}.dat"):
                if row.get("quantity") == "angle_at_peak":
                    continue                            # as exact as the place of the peak
                key = key_of(row, keys, names, name, last, divided)
                if key is not None:
                    found[key] = row
            both.append(found)
        if set(both[0]) != set(both[1]):
            said.append(f"{table}: other rows: {sorted(set(both[0]) ^ set(both[1]))[:2]}")
            continue
        largest = {}
        for key, row in both[0].items():
            group = key[len(keys):] if error else "all"
            for value in values:
                if value in row and row[value] != "-":
                    at = group, value if error else value[0]
                    largest[at] = max(largest.get(at, 0.0), abs(float(row[value])))
        for key, row in both[0].items():
            other = both[1][key]
            group = key[len(keys):] if error else "all"
            for value in values:
                if value not in row or row[value] == "-":
                    continue
                bound = 1e-10 + (float(row[error]) + float(other[error]) if error else 0.0)
                size = largest[group, value if error else value[0]]
                # What is not there at all is rounding.
                rounding = 1e-15*max(v for (_, q), v in largest.items() if q[0] == value[0])
                off = abs(float(row[value]) - float(other[value]))
                if value == "theta":
                    off = min(off, abs(off - 360))
                if off > bound*size + rounding:
                    said.append(f"{table} {key} {value}: {row[value]} {other[value]}, off by {off/size:.2e}, errors {bound:.2e}")
    for table, (keys, values) in NUMBERS.items():
        for row, other in zip(*(rows(folder / f"{table}.dat") for folder in folders)):
            for value, error in values:
                off = abs(float(row[value])/float(other[value]) - 1)
                if off > 1e-13 + float(row[error]) + float(other[error]):
                    said.append(f"{table} {[row[k] for k in keys]} {value}: {row[value]} {other[value]}, off by {off:.2e}")
    whole, halves = ({row["link"]: row for row in rows(folder / "peaks.dat")} for folder in folders)
    for value in ("strain", "stress", "deflection"):
        a, b = float(whole[name][value]), max(float(halves[k][value]) for k in (name, "half"))
        bound = sum(float(row["error"]) for row in (whole[name], halves[name], halves["half"]))
        if abs(a - b) > bound*a:
            said.append(f"peaks {value}: {a} {b}, errors {bound:.2e}")
    return said


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scratch")
    given = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory(dir=given.scratch) as scratch:
        scratch = pathlib.Path(scratch)
        for k in range(given.count):
            whole, halves, name, last = deck(random.Random(f"{given.seed}/{k}"))
            for word, text in (("whole", whole), ("halves", halves)):
                (scratch / f"{word}.deck").write_text(text)
            run = subprocess.run([given.program, "--quiet", "--out", str(scratch / "out"), str(scratch / "whole.deck"),
                                  str(scratch / "halves.deck")], capture_output=True, text=True, check=False)
            try:
                said = [run.stderr] if run.returncode else compare([scratch / "out" / "whole", scratch / "out" / "halves"], name, last)
            except (ValueError, KeyError, StopIteration, OSError) as error:
                said = [f"{type(error).__name__}: {error}"]
            if said:
                failed += 1
                print(f"case {k} ({name}):", *said[:4], sep="\n  ")
                if given.scratch:
                    (pathlib.Path(given.scratch) / f"welded_{k}.deck").write_text(halves)
                    (pathlib.Path(given.scratch) / f"whole_{k}.deck").write_text(whole)
    print(f"{given.count - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
