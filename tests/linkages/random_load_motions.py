"""Random linkages with all loads that machines have, moving by themselves: energies and what loads and motor take and give.

    random_load_motions.py SEED COUNT [--program PATH] [--scratch FOLDER]

At every instant of motion.dat the kinetic and the potential energy are those of the independent solver at the places of
motion_pins.dat, and the work is the integral of its powers of all loads without a potential and of the motor (Romberg's method over
windows of equal steps, which tells its own error).  Some loads have a table over the time, with rows where windows end.  Both energies
have to balance with it to 1e-9 of the energies, in every window in which the powers are smooth enough for that.  Motions are compared
up to the first dead point, and are without FRICTION cards.
"""
import argparse
import math
import os
import random
import subprocess
import sys
import tempfile

from compare import index
from decks import Deck
from random_loads import make
from solver import Failure, Model
from tables import Table

WORST = 1e-9
STEPS, WINDOW = 256, 32          # of a motion, and of an integral


def deck(case, seed):
    """The linkage with the middle of its range as the start, and a motor; (text, motor)."""
    lines = [line for line in case.text(5).splitlines() if not line.startswith(("CRANK", "SPEED", "REPORT", "FRICTION", "ACTUATE"))]
    draw = random.Random(seed)
    start = case.first + case.span * case.unit / 2
    speed = draw.choice((0, 0.4 * case.scale, -0.3 * case.scale) if case.linear else (0, 2, -3))
    motor = None
    if draw.random() < 0.5 and not case.linear:
        motor = (draw.choice((-6, 4, 12)), draw.choice((-15, 20, 30)))
        if motor[0] * motor[1] < 0:
            motor = (motor[0], -motor[1])
        lines.append(f"MOTOR stall={motor[0]}N*m noload={motor[1]}rad/s")
    end = 0.25
    for number in range(draw.choice((0, 1, 1, 2))):
        lines += over_time(case, draw, f"course{number}", end)
    lines.append(f"REPORT motion crank={start} speed={speed} end={end} step={end / STEPS!r} pins=yes")
    return "\n".join(lines) + "\n", motor


def over_time(case, draw, name, end):
    """Cards of a load with a table over the time."""
    times = [0] + sorted(draw.sample(range(1, STEPS // WINDOW), draw.randint(1, 6))) + [STEPS // WINDOW + draw.choice((0, 3))]
    on_link = draw.random() < 0.5
    unit, most = ("N*m", 5) if on_link else ("N", 30)
    values = [draw.choice((0, draw.uniform(-most, most), draw.uniform(-most, most))) for _ in times]
    table = f"TABLE {name} s {unit} " + " ".join(f"{k * end * WINDOW / STEPS!r} {value:.6g}" for k, value in zip(times, values))
    if on_link:
        return [table, f"TORQUE {draw.choice(case.free_links())} table={name} over=time"]
    x, y = (f"{draw.uniform(-2, 2):.6g}" for _ in range(2))
    pin = draw.choice(case.drawing.moving_pins())
    if pin in case.drawing.points:
        return [table, f"FORCE {draw.choice(case.free_links())} {x} {y} at={draw.uniform(-0.3, 1) * case.scale:.6g} table={name} over=time"]
    return [table, f"FORCE {pin} {x} {y} table={name} over=time"]


def run(program, path, folder):
    """motion.dat and the places of the pins."""
    done = subprocess.run([program, "--quiet", "--out", folder, path], capture_output=True, text=True, timeout=600, check=False)
    if done.returncode not in (0, 1):
        raise ValueError(done.stderr.strip().splitlines()[0])
    tables = os.path.join(folder, os.path.splitext(os.path.basename(path))[0])
    return [Table(os.path.join(tables, name + ".dat")) for name in ("motion", "motion_pins")]


def romberg(values, step):
    """The integral of equally spaced values, 2^n + 1 of them, and an estimate of its error."""
    count, rows = len(values) - 1, []
    stride = count
    while stride >= 1:
        chosen = values[::stride]
        row = [step * stride * (math.fsum(chosen) - (chosen[0] + chosen[-1]) / 2)]
        for k, before in enumerate(rows[-1] if rows else []):
            row.append(row[k] + (row[k] - before) / (4.0**(k + 1) - 1))
        rows.append(row)
        stride //= 2
    # High orders are of no use where a load changes within a step: the best one tells its error by its neighbours.
    errors = [(abs(rows[-1][k] - rows[-2][k]), rows[-1][k]) for k in range(len(rows) - 1)]
    error, value = min(errors)
    return value, error


def state_of(model, deck_, row, places):
    """The solver's state at an instant."""
    linear = deck_.drives[0]["linear"]
    length = float(deck_.units.results["length"])
    q = [0.0] * model.count
    where = {pin: tuple(map(float, place)) for pin, place in model.ground.items()}
    where.update({pin: (x * length, y * length) for pin, (x, y) in places.items()})
    for body in model.bodies.values():
        x, y = where[body.pins[0]]
        q[body.first], q[body.first + 1] = x, y
        if body.angle is not None:
            other = where[body.pins[1]]
            q[body.angle] = math.atan2(other[1] - y, other[0] - x)
            if body.ram is not None:
                q[body.ram] = math.dist((x, y), other)
    first = row["position1"] * length if linear else math.radians(row["crank" if "crank" in row else "position1"])
    rate = row["rate1"] * length if linear else row["omega2" if "omega2" in row else "rate1"] * float(deck_.units.results["speed"])
    if model.condition(q) > 1e4:
        raise Failure("near a dead point")
    s = model.state(q, first, rate, 0.0)
    s.time = row["time"]
    return s


def compare(case, text, motor, tables, folder):
    """The largest difference from the solver relative to the energies; windows that were compared, and those too rough for it."""
    deck_ = Deck(text, folder)
    model = Model(deck_)
    motion, pins = tables
    units = {name: float(value) for name, value in deck_.units.results.items() if value}
    by_time = {}
    for row in pins.rows:
        by_time.setdefault(row["time"], {})[row["pin"]] = (row["x"], row["y"])
    kinetic, potential, power, scale, taken, touching = [], [], [], [], [], 0
    for row in motion.rows:
        try:
            s = state_of(model, deck_, row, by_time[row["time"]])
        except Failure:
            break
        if not all(load.is_fine(s) for load in model.applied):
            break
        touching += any(load.touches(s) for load in model.applied if getattr(load, "contact", None))
        t, u = model.energy(s)
        for pin, force in model.forces.items():
            u -= sum(f * x for f, x in zip(force, model.pin_motion(s, pin)[0]))
        terms = [torque * s.v[model.bodies[link].angle] for link, torque in model.torques.items()]
        for load in model.applied:
            terms += model.power_of_effects(s, load.lost(s))
        if motor:
            terms.append(motor[0] * (1 - s.rate / motor[1]) * s.rate)
        kinetic.append(t)
        potential.append(u)
        power.append(math.fsum(terms))
        taken.append(abs(power[-1]))
        scale.append(abs(t) + abs(u) + sum(abs(load.potential(s)) for load in model.applied))
    if len(kinetic) <= WINDOW:
        return 0.0, 0, 0, 0, 0
    step = motion.rows[1]["time"] - motion.rows[0]["time"]
    size = max(scale) + sum(taken) * step
    for row, t, u in zip(motion.rows, kinetic, potential):
        for name, value in (("kinetic", t), ("potential", u)):
            error = abs(row[name] * units["energy"] - value) / size
            if error > WORST:
                raise ValueError(f"{name} energy differs by {error:.1e} at {row['time']} s")
    error = max(abs(row["energy_error"]) * units["energy"] for row in motion.rows) / size
    if error > WORST:
        raise ValueError(f"energy_error is {error:.1e} of the energies")
    largest, windows, rough = 0.0, 0, 0
    for first in range(0, len(kinetic) - WINDOW, WINDOW):
        last = first + WINDOW
        work, doubt = romberg(power[first:last + 1], step)
        if doubt > 0.1 * WORST * size:
            rough += 1
            continue
        balance = abs(kinetic[last] + potential[last] - kinetic[first] - potential[first] - work) / size
        told = abs((motion.rows[last]["work"] - motion.rows[first]["work"]) * units["energy"] - work) / size
        if max(balance, told) > WORST:
            raise ValueError(f"energies change by other than the work of the loads: {balance:.1e}, in the table {told:.1e}, "
                             f"from {motion.rows[first]['time']} s")
        largest, windows = max(largest, balance, told), windows + 1
    return largest, windows, rough, touching, len(kinetic)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_load_motions"))
    options = parser.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    done = failures = windows = rough = touching = instants = 0
    largest = 0.0
    for seed in range(options.seed, options.seed + options.count):
        case = make(seed)
        done += 1
        path = os.path.join(options.scratch, f"motion_{seed}.deck")
        text, motor = deck(case, seed)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        try:
            found = compare(case, text, motor, run(options.program, path, options.scratch), options.scratch)
        except (ValueError, KeyError, OSError, subprocess.TimeoutExpired) as failure:
            failures += 1
            print(f"seed {seed}: {failure} ({' '.join(case.drawing.kinds)}; {path})", flush=True)
            continue
        os.remove(path)
        largest, windows, rough = max(largest, found[0]), windows + found[1], rough + found[2]
        touching, instants = touching + found[3], instants + found[4]
    print(f"{done} motions, {failures} failed; {windows} windows of {WINDOW} steps, {rough} more too rough to integrate; "
          f"contacts act at {touching} of {instants} instants; largest error of the energies {largest:.1e}")
    print(f"{done - failures} passed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
