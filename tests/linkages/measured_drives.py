"""Linkages that are driven by a MEASURE against the same ones driven by their crank.

    measured_drives.py SEED COUNT [--program PATH] [--scratch FOLDER]

The random four-bars, slider-cranks and six-bars of rigid_tables.py, without friction in joints.  At the value, rate and acceleration that
a measure has at a crank angle, the deck that drives this measure, its places drawn near there, has the same places, velocities,
accelerations, load on the frame and, by the power that flows, the same force; where the angle of the crank is actuated beside, it has the
torque and the forces in the joints that the crank had as the drive.  Every measure of the deck is driven in turn, but where it moves little.
"""
import math
import os
import random
import re
import shutil
import sys

from rigid_tables import Linkage, Look
from tables import new_parser, read_options, run

ALLOWED = 1e-9
LEAST = 0.05                            # rate of a measure per rate of the crank, as a share of the linkage, or of angles


def deck_of(linkage, drive, crank, speed, alpha, drawn, actuated=False):
    """The deck with another drive at one position, without branches and with a drawing where there is one."""
    cards = []
    for card in linkage.text(Look()).splitlines():
        if card.split()[0] in ("REPORT", "CRANK", "SPEED", "DRIVE") or (drawn and card.startswith("BRANCH")):
            continue
        cards.append(card + " format=linkage" if card.startswith("UNITS") else card)
    cards += [f"PIN {pin} {x!r} {y!r}" for pin, (x, y) in drawn.items()]
    cards += [f"DRIVE {drive}", f"CRANK {crank!r}", f"SPEED {speed!r} alpha={alpha!r}"]
    if actuated:
        cards += ["MEASURE swing angle crank", "ACTUATE swing"]
    reports = ("pins", "kinematics", "drives", "reactions", "frame about=0,0", "coordinates")
    return "\n".join(cards + [f"REPORT {report}" for report in reports]) + "\n"


def differences(base, driven, scale, force):
    """Largest differences of tables, as shares of the largest of their kind."""
    found = {}
    for table, key, columns in (("pins", "pin", "x y vx vy ax ay"), ("kinematics", "link", "omega alpha"),
                                ("frame", None, "frame_x frame_y frame_moment")):
        others = {row.get(key): row for row in driven[table].rows}
        for column in columns.split():
            size = max([abs(row[column]) for row in base[table].rows] + [1e-3 * scale])
            for row in base[table].rows:
                found[column] = max(found.get(column, 0.0), abs(row[column] - others[row.get(key)][column]) / size)
    (one,), (other,) = base["drives"].rows, driven["drives"].rows
    powers = one["force"] * one["rate"], other["force"] * other["rate"]
    found["power"] = abs(powers[0] - powers[1]) / max(abs(powers[0]), force * abs(one["rate"]))
    return found


def tables_of(program, folder, name, text):
    """Tables of a deck that is written to a folder."""
    path = os.path.join(folder, name + ".deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return run(program, path, folder)


def of_actuator(base, actuated, force):
    """The same of forces in the joints and the torque on the crank."""
    size = max(abs(row[column]) for row in base["reactions"].rows for column in ("fx", "fy"))
    others = {(row["pin"], row["link"]): row for row in actuated["reactions"].rows}
    found = {"forces": max(abs(row[column] - others[row["pin"], row["link"]][column]) for row in base["reactions"].rows
                           for column in ("fx", "fy")) / size}
    (one,), (other,) = base["drives"].rows, actuated["drives"].rows
    found["torque"] = abs(one["force"] - other["force"]) / max(abs(one["force"]), force)
    return found


def examine(seed, program, scratch):
    """Largest difference of a case, and how many measures it had."""
    draw = random.Random(seed)
    linkage = Linkage(seed)
    linkage.rubs = False
    crank, speed, alpha = round(draw.uniform(-180, 180), 3), round(draw.uniform(1, 30), 3), round(draw.uniform(-100, 100), 3)
    folder = os.path.join(scratch, str(seed))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    base = tables_of(program, folder, "crank", deck_of(linkage, "crank", crank, speed, alpha, {}))
    grounds = set(re.findall(r"(?m)^GROUND (\S+)", linkage.text(Look())))
    size = max(abs(row[column]) for row in base["pins"].rows for column in ("x", "y"))
    scale = size * speed**2
    force = max(abs(row[column]) for row in base["frame"].rows for column in ("frame_x", "frame_y")) * size
    drawn = {row["pin"]: (round(row["x"], 4), round(row["y"], 4)) for row in base["pins"].rows if row["pin"] not in grounds}
    largest, count = 0.0, 0
    for row in base["coordinates"].rows:
        name = row["coordinate"]
        if not re.search(rf"(?m)^MEASURE {name} ", linkage.text(Look())):
            continue
        if abs(row["rate"]) < LEAST * speed * (1 if name in ("lean", "bend") else size):
            continue
        driven = tables_of(program, folder, name, deck_of(linkage, name, row["value"], row["rate"], row["acceleration"], drawn))
        found = differences(base, driven, scale, force)
        actuated = tables_of(program, folder, name + "_by_crank", deck_of(linkage, name, row["value"], row["rate"], row["acceleration"],
                                                                           drawn, actuated=True))
        for what, difference in (*found.items(), *of_actuator(base, actuated, force).items()):
            if not difference <= ALLOWED:
                raise ValueError(f"{name}: {what} differs by {difference:.1e}")
            largest = max(largest, difference)
        count += 1
    return largest, count


def main():
    options = new_parser(__doc__, "measured_drives")
    options.add_argument("seed", type=int)
    options.add_argument("count", type=int)
    options = read_options(options)
    failed, largest, count = 0, 0.0, 0
    for seed in range(options.seed, options.seed + options.count):
        try:
            found, measures = examine(seed, options.program, options.scratch)
            largest, count = max(largest, found), count + measures
        except (ValueError, KeyError, RuntimeError) as failure:
            failed += 1
            print(f"seed {seed}: {failure}", flush=True)
    print(f"{count} drives of measures, largest difference {largest:.1e} of the largest of its kind, {ALLOWED} allowed")
    print(f"{options.count - failed} passed, {failed} failed")
    return 1 if failed or not math.isfinite(largest) or not count else 0


if __name__ == "__main__":
    sys.exit(main())
