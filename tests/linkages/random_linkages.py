"""Random linkages of 4 to 10 links: what the program computes against an independent solver with 40 digits.

    random_linkages.py SEED COUNT [--program PATH] [--scratch FOLDER] [--keep] [--links N] [--only KIND] [--reports LIST]

Compares positions, velocities, accelerations, forces and torques; closes loops and balances powers from the tables alone; asks for
the same positions in steps of 1, 2 and 5.  A failing linkage is a line with its seed and reason, and its deck stays in the scratch
folder.  The last line has the largest differences, relative to the largest value of their kind at the position.
"""
import argparse
import math
import os
import shutil
import sys
import tempfile
from decimal import Decimal

import compare
from decks import Deck
from growth import Drawing
from solver import Failure, Model
from tables import run

SMALLEST, LARGEST = 4, 10
WORST_CONDITION = 300.0
REPORTS = ("kinematics", "pins", "reactions", "drives")
KINEMATIC = ("kinematics", "pins")


class Case:
    """A linkage with loads, and its range; text(step) is its deck."""

    def __init__(self, seed, links=None, reports=REPORTS):
        self.seed, self.reports = seed, reports
        self.drawing = drawing = Drawing(seed, links or SMALLEST + seed % (LARGEST - SMALLEST + 1))
        self.scale = drawing.pick((1.0, 1.0, 0.1, 250.0))
        self.units = "mm kg s" if self.scale == 250.0 else "m kg s"
        self.linear = drawing.drives[0][1] not in ([],) and drawing.drives[0][1][0] != "against"
        self.loaded = drawing.chance(0.8)
        # the program's own case: without a drawing, and with its tables
        self.four_bar = drawing.kinds == ["crank", "rrr"] and not drawing.points and len(drawing.grounds) == 2 \
            and all(len(pins) == 2 for pins in drawing.links.values())
        self.cards = self._cards()
        self.unit = Decimal("0.005") * Decimal(str(self.scale)) if self.linear else Decimal(1)
        self.pins = {pin: (x * self.scale, y * self.scale) for pin, (x, y) in drawing.places.items()}

    def _number(self, low, high, factor=1.0):
        return f"{self.drawing.uniform(low, high) * factor:.6g}"

    def _cards(self):
        """All cards but PIN, CRANK and REPORT."""
        drawing, scale = self.drawing, self.scale
        lines = [f"TITLE random linkage {self.seed}: " + " ".join(drawing.kinds), "UNITS " + self.units,
                 "MATERIAL stuff E=200GPa density=7850kg/m3"]
        lines += [f"SECTION bar rectangle thickness={0.05 * scale!r} width={0.02 * scale!r}"]
        for pin in drawing.grounds:
            x, y = drawing.places[pin]
            lines.append(f"GROUND {pin} {x * scale!r} {y * scale!r}")
        for name, (x, y, angle) in drawing.guides.items():
            lines.append(f"GUIDE {name} {x * scale!r} {y * scale!r} angle={angle!r}")
        for name, pins in drawing.links.items():
            length = f" length={math.dist(*(drawing.places[pin] for pin in pins)) * scale!r}" if self.four_bar else ""
            lines.append(f"LINK {name} " + " ".join(pins) + length + self._body(name, pins))
        for name, (link, along, offset) in drawing.points.items():
            lines.append(f"POINT {name} {link} along={along * scale!r} offset={offset * scale!r}")
        for pin, guide, link in drawing.sliders:
            mass = f" mass={self._number(0.1, 1)}" if self.loaded and drawing.chance(0.5) and pin not in drawing.grounds else ""
            if mass and guide in drawing.links and drawing.chance(0.4):
                mass += f" inertia={self._number(0.001, 0.01, scale**2)}"
            lines.append(" ".join(["SLIDER", pin, guide] + ([link] if link else [])) + mass)
        for pin, links in drawing.welds:
            lines.append(f"WELD {pin} " + " ".join(links))
        for name, words, keys in drawing.drives:
            lines.append(" ".join(["DRIVE", name] + words + ([keys] if keys else [])))
        speed = self._number(0.5, 20) if not self.linear else self._number(0.1, 3, scale)
        lines.append(f"SPEED {speed}" + (f" alpha={self._number(-30, 30)}" if not self.linear and drawing.chance(0.5) else ""))
        return lines + (self._loads() if self.loaded else [])

    def _body(self, name, pins):
        """Mass of a link: its own, or that of a uniform bar."""
        drawing = self.drawing
        rigid = " rigid" if len(pins) > 2 else ""
        if not self.loaded:
            return rigid
        if name == drawing.driven_length:
            return rigid + " mass=0 inertia=0"
        if drawing.chance(0.4):
            return rigid + " material=stuff section=bar"
        body = f" mass={self._number(0.2, 3)} inertia={self._number(0.002, 0.1, self.scale**2)}"
        if len(pins) > 2 or drawing.chance(0.5):
            body += f" center={self._number(-0.2, 0.8, self.scale)},{self._number(-0.3, 0.3, self.scale)}"
        return rigid + body

    def _branch(self):
        """Open, if B is to the left of the line from A to O4."""
        places, crank = self.drawing.places, self.drawing.links[self.drawing.drives[0][0]]
        second = next(pin for pin in self.drawing.grounds if pin not in crank)
        (ax, ay), (ox, oy) = places[next(pin for pin in crank if pin not in self.drawing.grounds)], places[second]
        bx, by = places[next(pin for pin in self.drawing.moving_pins() if pin not in crank)]
        return "open" if (ox - ax) * (by - ay) > (oy - ay) * (bx - ax) else "crossed"

    def _loads(self):
        drawing, scale, lines = self.drawing, self.scale, ["INERTIA distributed"]
        pins = [pin for pin in drawing.moving_pins() if pin not in drawing.points]
        links = [name for name in drawing.links if name != drawing.driven_length]
        if drawing.chance(0.7):
            lines.append(f"GRAVITY {self._number(-3, 3)}m/s2 {self._number(-10, -8)}m/s2")
        for pin in pins:
            if drawing.chance(0.2):
                lines.append(f"FORCE {pin} {self._number(-50, 50)}N {self._number(-50, 50)}N")
            if drawing.chance(0.2):
                lines.append(f"PINMASS {pin} {self._number(0.1, 1)}")
        for name in links:
            if drawing.chance(0.2):
                lines.append(f"TORQUE {name} {self._number(-5, 5)}N*m")
            if drawing.chance(0.15):
                lines.append(f"MASS {name} {self._number(0.1, 1)} at={self._number(0, 0.12, scale)}"
                             f" offset={self._number(-0.2, 0.2, scale)} inertia={self._number(0, 0.01, scale**2)}")
        return lines

    def find_range(self):
        """Follows the motion both ways while it is far from dead points; sets the pins at the first position."""
        first = Decimal(repr(self.drawing.angle)) * (Decimal(str(self.scale)) if self.linear else 1)
        deck = Deck(self._deck(first, 0, 1, True))
        model = Model(deck)
        factor = float(deck.crank_factor())
        q = model.newton(model.drawing(), float(first) * factor)
        if not self._is_good(model, q):
            raise Failure("badly conditioned")
        wide = 5 * int(self.drawing.uniform(4, 20))
        ends = []
        for sign in (-1, 1):
            ends.append((0, q))
            for place in range(5, wide + 1, 5):
                start = first + sign * (place - 5) * self.unit
                try:
                    end = model.follow(ends[-1][1], float(start) * factor, float(start + sign * 5 * self.unit) * factor)
                except Failure:
                    break
                if not self._is_good(model, end):
                    break
                ends[-1] = (place, end)
        self.span = ends[0][0] + ends[1][0]
        if self.span < 10:
            raise Failure("short range")
        self.first = first - ends[0][0] * self.unit
        length = float(deck.units.factor("length"))
        for pin in model.moving_pins:
            x, y, _ = model.pin_place(ends[0][1], pin)
            self.pins[pin] = (x / length, y / length)

    def _is_good(self, model, q):
        """Far from dead points, and with all blocks between the pins of their links."""
        if model.condition(q) > WORST_CONDITION:
            return False
        for slider in model.deck.sliders:
            body = model.bodies.get(slider["guide"])
            if body:
                x, y, _ = model.pin_place(q, slider["pin"])
                sine, cosine = model.trigonometry(q, body)
                part = ((x - q[body.first]) * cosine + (y - q[body.first + 1]) * sine) / body.places[body.pins[1]][0]
                if not 0.03 < part < 0.97:
                    return False
        for body in model.bodies.values():
            if body.ram is not None and q[body.ram] < 0.1 * model.size:
                return False
        return True

    def _deck(self, first, span, step, drawn=False):
        lines = list(self.cards)
        for pin, (x, y) in self.pins.items():
            if pin not in self.drawing.grounds and (drawn or not self.four_bar):
                lines.append(f"PIN {pin} {x!r} {y!r}")
        last = first + span * self.unit
        lines.append(f"CRANK {first:f} to {last:f} step {step * self.unit:f}" if span else f"CRANK {first:f}")
        if self.four_bar:
            lines.append("BRANCH " + self._branch())
        lines += ["REPORT " + report for report in self.reports
                  if (self.loaded or report in KINEMATIC) and not (self.four_bar and report in ("pins", "drives"))]
        return "\n".join(lines) + "\n"

    def text(self, step):
        span = self.span - self.span % 10 if step == 2 else self.span
        return self._deck(self.first, span, step)


def check(case, program, folder):
    """Runs and compares; the largest differences.  Raises compare.Wrong with a reason."""
    results = {}
    for step in (5, 1, 2):
        path = os.path.join(folder, f"linkage_{case.seed}_step_{step}.deck")
        with open(path, "w", encoding="utf-8") as file:
            file.write(case.text(step))
        results[step] = run(program, path, os.path.join(folder, "tables"))
    deck = Deck(case.text(5))
    for step in results:
        results[step] = compare.long_tables(deck, results[step])
    largest = compare.with_solver(deck, results[5], case.loaded)
    for step in (1, 2):
        compare.same_positions(results[5], results[step], largest)
    return largest


def make(seed, links=None, reports=REPORTS):
    """The first linkage of a seed and its successors that has a range."""
    for attempt in range(100):
        case = Case(seed + 1000003 * attempt, links or SMALLEST + seed % (LARGEST - SMALLEST + 1), reports)
        case.seed = seed
        try:
            case.find_range()
            return case
        except (Failure, ZeroDivisionError, OverflowError):
            continue
    raise Failure(f"seed {seed}: no linkage")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_linkages"))
    parser.add_argument("--keep", action="store_true", help="keep the decks of all linkages")
    parser.add_argument("--links", type=int, help="number of links, the ground among them")
    parser.add_argument("--only", help="linkages with this kind of part only")
    parser.add_argument("--reports", default=",".join(REPORTS), help="the reports that decks ask for")
    options = parser.parse_args()
    program = options.program.split()              # `reference.py --doubles` measures rounding
    if program[0].endswith(".py"):
        program = [sys.executable, "-B"] + program
    os.makedirs(options.scratch, exist_ok=True)
    largest, failures, kinds, done = {}, 0, {}, 0
    for seed in range(options.seed, options.seed + options.count):
        case = make(seed, options.links, options.reports.split(","))
        if options.only and options.only not in case.drawing.kinds:
            continue
        done += 1
        folder = os.path.join(options.scratch, f"seed_{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for kind in set(case.drawing.kinds):
            kinds[kind] = kinds.get(kind, 0) + 1
        try:
            compare.merge(largest, check(case, program, folder))
        except (compare.Wrong, Failure, RuntimeError, ValueError, KeyError, OSError) as failure:
            failures += 1
            print(f"seed {seed}: {failure or repr(failure)} ({' '.join(case.drawing.kinds)}; {folder})", flush=True)
            continue
        if not options.keep:
            shutil.rmtree(folder)
    shown = " ".join(f"{name} {value:.1e}" for name, value in sorted(largest.items()))
    print(f"{done} linkages, {failures} failed; " + " ".join(f"{kind}:{number}" for kind, number in sorted(kinds.items())))
    print(f"largest differences: {shown}")
    print(f"{done - failures} passed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
