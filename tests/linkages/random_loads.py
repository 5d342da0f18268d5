"""Random linkages with all loads that machines have, against the independent solver with 40 digits.

    random_loads.py SEED COUNT [--program PATH] [--scratch FOLDER] [--keep] [--links N]

The linkages of random_linkages.py with forces at places of links and in their axes, forces and torques by tables over the drive, a
block, the travel of a pin, the angle of a link or a measure of any kind, loads in one direction of the motion, resistances, springs
and dampers of both kinds, springs of one side and stops of any coordinate, whose limits are within its range, friction in pins and of
blocks; of some the efforts are along other coordinates than those of the drives (ACTUATE).  Compares forces in the joints and of the drives, bearings, the force on the frame, coordinates and the terms of Lagrange's
equation; at every position the power of the drives has to be that of all loads and of inertia, to 1e-12 of the sum of absolute terms.
"""
import argparse
import math
import os
import shutil
import sys
import tempfile

import compare
import compare_loads
import dense
import measures
from decks import Deck
from random_linkages import Case as Bare, run
from solver import Failure, Model, positions
from units import FACTORS

REPORTS = ("kinematics", "pins", "reactions", "drives", "bearings", "frame about=0.3,-0.2", "lagrange", "coordinates")


class Case(Bare):
    """A linkage with loads of every kind."""

    def __init__(self, seed, links=None, reports=REPORTS):
        self.kinds = {}                          # kinds of loads: how many
        self.touching = self.reached = 0         # positions of contacts: where they do something, and all
        super().__init__(seed, links, reports)
        self.loaded = True

    def _loads(self):
        """The constant loads of other decks, and these."""
        drawing = self.drawing
        self._draw_measures()
        self.cards_of_tables, lines = [], []
        for kind, most in ((self._force, 3), (self._torque, 2), (self._resistance, 2), (self._spring, 2), (self._coil, 2),
                           (self._friction, 3)):
            for _ in range(int(drawing.uniform(0, most + 1))):
                lines.append(kind())
        cards = super()._loads()
        self.weighs = any(card.startswith("GRAVITY") for card in cards)
        self.applied = [line if self.weighs or "only=" not in line or "contact=" in line else f"{line} contact={self._width(line)}"
                        for line in lines if line]
        return cards + [f"MEASURE {name} {form}" for name, form in self.measures.items()]

    def _width(self, line):
        """Of the contact of a torsional spring, or of one between places."""
        return f"{self._number(0.5, 20)}deg" if "N*m" in line else self._number(0.002, 0.1, self.scale)

    def _draw_measures(self):
        """Coordinates with names: {name: the rest of the card}; some are angles."""
        drawing = self.drawing
        self.measures, self.angular = {}, set()
        kinds = [self._distance, self._angle, self._angle, self._line, self._line, self._travel, self._sum, self._sum]
        for _ in range(1 + int(drawing.uniform(0, 5))):
            form, turns = drawing.pick(kinds)() or self._travel()
            name = f"measure{len(self.measures) + 1}"
            self.measures[name] = form
            if turns:
                self.angular.add(name)

    def _distance(self):
        drawing = self.drawing
        one = drawing.pick(self._ends())
        other = drawing.pick([pin for pin in drawing.places if not self._bodies(pin) & self._bodies(one)] or [None])
        if other is None or other == one:
            return None
        return f"distance {one} {other}" if drawing.chance(0.5) else f"distance {other} {one}", False

    def _angle(self):
        drawing = self.drawing
        link, other = drawing.pick(drawing.links), drawing.pick(drawing.links)
        if drawing.chance(0.4):
            return f"angle {link}", True
        drive, words, _ = drawing.drives[0]
        if words[:1] == ["against"] and drawing.chance(0.7):
            link, other = drive, words[1]
        if link == other or any({link, other} <= set(links) for _, links in drawing.welds):
            return None
        return f"angle {link} against {other}", True

    def _line(self):
        """Where nothing holds the pin in place."""
        drawing = self.drawing
        pin, way = drawing.pick(self._ends()), drawing.pick(("along", "across"))
        line = drawing.pick(list(drawing.links) + list(drawing.guides))
        if line in self._bodies(pin) or way == "across" and any(slider[:2] == [pin, line] for slider in drawing.sliders):
            return None
        return f"{way} {pin} {line}", False

    def _travel(self):
        drawing = self.drawing
        return f"travel {drawing.pick(self._ends())} {self._number(-3, 3)} {self._number(-3, 3)}", False

    def _sum(self):
        drawing = self.drawing
        turns = bool(self.angular) and drawing.chance(0.4)
        terms = [name for name, form in self.measures.items() if (name in self.angular) == turns and not form.startswith("sum")]
        if not turns:
            pins = [slider[0] for slider in drawing.sliders]
            terms += [slider[0] if pins.count(slider[0]) == 1 else f"{slider[0]}:{slider[1]}" for slider in drawing.sliders]
        if not terms:
            return None
        words = [f"{self._number(-2, 2)} {drawing.pick(terms)}" for _ in range(1 + int(drawing.uniform(0, 3)))]
        return "sum " + " ".join(words), turns

    def free_links(self):
        """Those whose length is not driven."""
        return [name for name in self.drawing.links if name != self.drawing.driven_length]

    def _ends(self):
        """Pins and points, moving ones."""
        return [pin for pin in self.drawing.moving_pins()]

    def _table(self, angular, unit):
        """A TABLE card; its name."""
        drawing, scale = self.drawing, self.scale
        name = f"table{len(self.cards_of_tables) + 1}"
        rows = 3 + int(drawing.uniform(0, 7))
        if angular and drawing.chance(0.7):
            first, last, closes = drawing.pick((0, -180, 30)), 0, True
            last = first + drawing.pick((360, 360, 720))
        elif angular:
            first, last, closes = -420, 420, False
        else:
            first, last, closes = -6 * scale, 6 * scale, False
        places = [first + (last - first) * (k + (drawing.uniform(-0.3, 0.3) if 0 < k < rows else 0)) / rows for k in range(rows + 1)]
        values = [round(drawing.uniform(-20, 20), 3) for _ in places]
        if closes:
            values[-1] = values[0]
        length = self.units.split()[0]
        numbers = " ".join(f"{x:.9g} {y!r}" for x, y in zip(places, values))
        self.cards_of_tables.append((name, f"TABLE {name} {'deg' if angular else length} {unit} {numbers}"))
        return name

    def _course(self, own_pin, turns):
        """Keys of a table, or none, and of the direction of motion."""
        drawing, keys, scale = self.drawing, "", self.scale
        has_table = drawing.chance(0.5)
        if has_table:
            unit = "N*m" if turns else "N"
            over = drawing.pick(("drive", "slider", "travel", "angle", "measure", "measure"))
            blocks = [pin for pin, _, _ in drawing.sliders]
            if over == "slider" and blocks:
                keys = f" over={drawing.pick(blocks)} table={self._table(False, unit)}"
            elif over == "travel" and own_pin and own_pin not in blocks:
                keys = f" over={own_pin} table={self._table(False, unit)}"
            elif over == "measure":
                name = drawing.pick(list(self.measures))
                keys = f" over={name} table={self._table(name in self.angular, unit)}"
            elif over == "angle":
                keys = f" over={drawing.pick(self.free_links())} table={self._table(True, unit)}"
            else:
                keys = f" table={self._table(not self.linear, unit)}"
        if drawing.chance(0.4):
            smooth = f"{self._number(0.1, 3)}rad/s" if turns else self._number(0.1, 3, scale)
            keys += f" during={drawing.pick(('with', 'against'))} smooth={smooth}"
        return has_table, keys

    def _place(self):
        return f" at={self._number(-0.3, 1, self.scale)} offset={self._number(-0.5, 0.5, self.scale)}"

    def _force(self):
        drawing = self.drawing
        if drawing.chance(0.5):
            axes = " axes=link" if drawing.chance(0.5) else ""
            has_table, keys = self._course(None, False)
            subject, place = drawing.pick(self.free_links()), self._place() + axes
        else:
            subject, place = drawing.pick(self._ends()), ""
            has_table, keys = self._course(subject, False)
            if not keys:
                return None
        unit = "" if has_table else "N"
        return f"FORCE {subject} {self._number(-30, 30)}{unit} {self._number(-30, 30)}{unit}{place}{keys}"

    def _torque(self):
        has_table, keys = self._course(None, True)
        if not keys:
            return None
        value = "" if has_table else f" {self._number(-5, 5)}N*m"
        return f"TORQUE {self.drawing.pick(self.free_links())}{value}{keys}"

    def _resistance(self):
        drawing, scale = self.drawing, self.scale
        on_link = drawing.chance(0.5)
        subject = drawing.pick(self.free_links() if on_link else self._ends())
        if any(line and line.startswith(f"LOAD {subject} ") for line in self.loads_so_far):
            return None
        keys = ""
        if on_link and drawing.chance(0.4):
            keys += f" torque={self._number(-3, 3)}N*m"
        if drawing.chance(0.5):
            keys += f" damping={self._number(0, 2)}" + ("N*m*s" if on_link else "N*s/m")
        if drawing.chance(0.6) or not keys:
            smooth = f"{self._number(0.1, 3)}rad/s" if on_link else self._number(0.1, 3, scale)
            keys += f" resisting={self._number(0, 10)}" + ("N*m" if on_link else "N") + f" smooth={smooth}"
        line = f"LOAD {subject}{keys}"
        self.loads_so_far.append(line)
        return line

    def _bodies(self, pin):
        """Links with a pin, and those welded to them."""
        bodies = self.drawing.holders(pin)
        for _, links in self.drawing.welds:
            if bodies & set(links):
                bodies = bodies | set(links)
        return bodies

    def _spring(self):
        """Along a line between pins, points or pivots."""
        drawing, scale = self.drawing, self.scale
        one = drawing.pick(self._ends())
        other = drawing.pick([pin for pin in drawing.places if not self._bodies(pin) & self._bodies(one)] or [None])
        if other is None or other == one:
            return None
        if drawing.chance(0.5):
            one, other = other, one
        number = len(self.loads_so_far) + 1
        self.loads_so_far.append("spring")
        if drawing.chance(0.35):
            return f"DAMPER damper{number} {one} {other} damping={self._number(0, 30)}N*s/m"
        draw, stiffness = drawing.random(), drawing.uniform(1, 300)
        if draw > 0.85:
            return f"SPRING spring{number} {one} {other} stiffness=0 force={self._number(-20, 20)}N"
        # Four-bars are not drawn; a free length is not negative.
        rest = f" free_length={self._number(0.1, 1, scale)}"
        if drawing.chance(0.4):
            rest = "" if drawing.chance(0.3) and not self.four_bar else rest
            return f"SPRING spring{number} {one} {other} stiffness={stiffness:.6g}N/m{rest}" + self._one_side("length", stiffness)
        if draw < 0.3 and not self.four_bar:
            most = 0.5 * stiffness * math.dist(drawing.places[one], drawing.places[other]) * scale * float(FACTORS[self.units.split()[0]])
            rest = f" force={self._number(-most, most)}N" if draw < 0.2 else ""
        return f"SPRING spring{number} {one} {other} stiffness={stiffness:.6g}N/m{rest}"

    def _friction(self):
        """Of a pin, or of a block along its line; not where forces of several links or loads cannot be told apart."""
        drawing, scale = self.drawing, self.scale
        pin = drawing.pick(drawing.places)
        blocks = [slider for slider in drawing.sliders if slider[0] == pin]
        links = [name for name in drawing.links if pin in drawing.links[name]]
        if pin in drawing.points or any(pin == where for where, _ in drawing.welds) or pin in self.rubbing:
            return None
        self.rubbing.append(pin)
        values = f" coefficient={self._number(0.02, 0.3)}"
        if blocks and (pin in drawing.grounds or len(blocks) > 1 or drawing.chance(0.6)):
            block = drawing.pick(blocks)
            if block[2]:
                values += f" length={self._number(0.3, 0.8, scale)}"
            if drawing.chance(0.4):
                values += f" viscous={self._number(0, 5)}N*s/m"
            return f"FRICTION {pin} {block[1]}{values} smooth={self._number(0.1, 1, scale)}"
        values += f" radius={self._number(0.005, 0.05, scale)} smooth={self._number(0.1, 2)}rad/s"
        if drawing.chance(0.4):
            values += f" viscous={self._number(0, 0.5)}N*m*s"
        if blocks:
            links = [name for name in links if name != blocks[0][2]]
        elif pin not in drawing.grounds:
            if len(links) < 2:
                return None
            links = links[::-1] if drawing.chance(0.5) else links
            return f"FRICTION {pin} {links[0]} {links[1]}{values}"
        if not links:
            return None
        return f"FRICTION {pin}{values}"

    def _one_side(self, kind, stiffness):
        """Keys of a spring of one side."""
        drawing, keys = self.drawing, f" only={self.drawing.pick(('push', 'pull'))}"
        if drawing.chance(0.5):
            keys += f" gap={self._number(0, 20)}deg" if kind == "angle" else f" gap={self._number(0, 0.1, self.scale)}"
        if drawing.chance(0.5):
            keys += f" damping={stiffness * 10**drawing.uniform(-4, -1):.6g}" + ("N*m*s/rad" if kind == "angle" else "N*s/m")
        if drawing.chance(0.5):
            keys += f" contact={self._number(0.5, 20)}deg" if kind == "angle" else f" contact={self._number(0.002, 0.1, self.scale)}"
        return keys

    def _stops(self, states):
        """STOP cards, most with limits that some of the states are beyond."""
        drawing, model = self.drawing, states[0][0]
        names, cards = measures.names(model.deck), []
        for number in range(int(drawing.uniform(0, 5))):
            name = drawing.pick(list(self.measures) if drawing.chance(0.5) else names)
            along = measures.coordinate(model, name)
            values = [along.value(s) for _, s in states]
            low, high = min(values), max(values)
            if high - low < (1e-3 if along.is_angle else 1e-3 * model.size):
                continue
            part = drawing.uniform(0.1, 0.9) if drawing.chance(0.85) else drawing.uniform(-0.6, 1.6)
            limit, stiffness = low + part * (high - low), 10**(drawing.uniform(-1, 2) if along.is_angle else drawing.uniform(1, 3.5))
            length = float(FACTORS[self.units.split()[0]])
            shown = f"{math.degrees(limit):.12g}" if along.is_angle else f"{limit / length:.12g}"
            card = f"STOP stop{number + 1} {name} limit={shown} stiffness={stiffness:.6g}" + ("N*m/rad" if along.is_angle else "N/m")
            if drawing.chance(0.6):
                card += f" damping={stiffness * 10**drawing.uniform(-4, -1):.6g}" + ("N*m*s/rad" if along.is_angle else "N*s/m")
            if not self.weighs or drawing.chance(0.5):
                width = (high - low) * 10**drawing.uniform(-3, 0)
                card += f" contact={math.degrees(width):.6g}deg" if along.is_angle else f" contact={width / length:.6g}"
            cards.append(card + (" below" if drawing.chance(0.5) else ""))
        return cards

    def _coil(self):
        """A torsional one."""
        drawing = self.drawing
        pin = drawing.pick(drawing.places)
        links = [name for name in drawing.links if pin in drawing.links[name]]
        if pin in drawing.grounds:
            links = [drawing.pick(links)] if links else []
        elif len(links) < 2 or any(pin == where for where, _ in drawing.welds) or any(pin == slider[0] for slider in drawing.sliders):
            return None
        else:
            links = links[:2] if drawing.chance(0.5) else links[1::-1]
        if not links:
            return None
        number = len(self.loads_so_far) + 1
        self.loads_so_far.append("coil")
        words = f"coil{number} {pin} " + " ".join(links)
        if drawing.chance(0.3):
            return f"DAMPER {words} damping={self._number(0, 2)}N*m*s/rad"
        angles = []
        for link in links:
            pins = drawing.links[link]
            start = next((k for k, name in enumerate(pins) if name in drawing.grounds), 0)
            angles.append(math.degrees(drawing.direction(pins[start], pins[(start + 1) % len(pins)])))
        drawn = (angles[-1] - (angles[0] if len(angles) > 1 else 0) + 180) % 360 - 180
        rest = f" free_angle={drawn + drawing.uniform(-60, 60):.6f}"
        if drawing.chance(0.4):
            rest, stiffness = "" if drawing.chance(0.3) and not self.four_bar else rest, drawing.uniform(0.1, 20)
            return f"SPRING {words} stiffness={stiffness:.6g}N*m/rad{rest}" + self._one_side("angle", stiffness)
        if drawing.chance(0.4) and not self.four_bar:
            rest = f" torque={self._number(-5, 5)}N*m" if drawing.chance(0.5) else ""
        return f"SPRING {words} stiffness={self._number(0.1, 20)}N*m/rad{rest}"

    def _cards(self):
        self.loads_so_far, self.applied, self.cards_of_tables, self.rubbing, self.measures = [], [], [], [], {}
        return super()._cards()

    def find_range(self):
        """Of the linkage; then loads that are not computed everywhere in it go."""
        super().find_range()
        found = positions(Deck(self.text(5)))[1]
        for load in self.applied:
            self._add_load(load, found)
        for stop in self._stops(self._states(found)):
            self._add_load(stop, found)
        if not self.four_bar and self.drawing.chance(0.4):
            self._actuate(found)

    def _actuate(self, found):
        """Coordinates that move far enough with all drives everywhere, if there are."""
        drawing, states = self.drawing, self._states(found)
        model = states[0][0]
        rams = [drive["name"] for drive in model.deck.drives if [word.lower() for word in drive["words"]] == ["length"]]
        names, count = [name for name in measures.names(model.deck) if name not in rams], len(model.deck.drives)
        for _ in range(20):
            picked = []
            while len(picked) < count and len(names) > len(picked):
                picked.append(drawing.pick([name for name in names if name not in picked]))
            if len(picked) == count and all(self._holds(model, s, picked) for _, s in states):
                break
        else:
            return
        cards, reports = self.cards, self.reports
        self.cards = cards + ["ACTUATE " + " ".join(picked)]
        self.reports = [report for report in reports if report != "lagrange"]
        if not all(self._settles(*state) for state in self._states(found)):
            self.cards, self.reports = cards, reports
            return
        self.kinds["actuate"] = self.kinds.get("actuate", 0) + 1

    @staticmethod
    def _holds(model, s, names):
        """Whether rates of the coordinates per rates of the drives are far from singular, in radians and sizes of the linkage."""
        along = [measures.coordinate(model, name) for name in names]
        if not all(one.is_fine(s) for one in along):
            return False
        place, columns = 0, []
        for row in model.rows:
            if row[0] == "drive":
                unit = [0.0] * model.count
                unit[place] = model.size if row[1]["linear"] else 1.0
                columns.append(dense.solve(s.factors, unit))
            place += 2 if row[0] == "pin" else 1
        matrix = [[sum(g * v for g, v in zip(model.pushed(s, one), column)) / (1.0 if one.is_angle else model.size) for column in columns]
                  for one in along]
        return all(max(map(abs, row)) > 0.03 for row in matrix) and (len(matrix) == 1 or dense.condition(matrix) < 100)

    def _states(self, found):
        """The positions with the first speed of the deck: (model, state)."""
        deck = Deck(self.text(5))
        model, rate = Model(deck), float(deck.speeds[0] * deck.speed_factor())
        return [(model, model.state(q, float(crank * deck.crank_factor()), rate, float(deck.alpha())))
                for crank, q in zip(deck.cranks, found)]

    def _add_load(self, load, found):
        """If it is computed everywhere."""
        cards = self.cards
        self.cards = cards + [load] + [card for name, card in self.cards_of_tables if f"table={name}" in load.split()]
        states = self._states(found)
        if not all(one.is_fine(state) for model, state in states for one in model.applied) or \
                not all(self._settles(model, state) for model, state in states):
            self.cards = cards
            return
        self._count(load)
        last = states[0][0].applied[-1] if states[0][0].applied else None
        if getattr(last, "contact", None):
            self.touching += sum(last.touches(state) for _, state in states)
            self.reached += len(states)

    def _count(self, load):
        """What kinds of loads there are."""
        words, keys = [word for word in load.split() if "=" not in word], dict(word.split("=") for word in load.split() if "=" in word)
        kinds = [words[0].lower()]
        if words[0] in ("SPRING", "DAMPER") and words[-1] in self.drawing.links:
            kinds = ["torsional_" + kinds[0]]
        if words[0] == "FRICTION":
            kinds = ["friction_of_pin" if "radius" in keys else "friction_of_block"]
        if words[0] == "STOP":
            kinds.append("stop_of_" + self.measures.get(words[2], "spring_ram_or_slider").split()[0])
        if keys.get("over") in self.measures:
            kinds.append("table_over_" + self.measures[keys["over"]].split()[0])
        for kind in kinds + [key for key in ("table", "during", "only") if key in keys]:
            self.kinds[kind] = self.kinds.get(kind, 0) + 1


    @staticmethod
    def _settles(model, state):
        """Whether the forces with friction are found, by iterations that contract."""
        try:
            model.add_forces(state)
            return True
        except Failure:
            return False


def make(seed, links=None, reports=REPORTS):
    """The first linkage of a seed and its successors that has a range."""
    for attempt in range(100):
        case = Case(seed + 1000003 * attempt, links or 4 + seed % 7, reports)
        case.seed = seed
        if not case.applied:
            continue
        try:
            case.find_range()
            return case
        except (Failure, ZeroDivisionError, OverflowError):
            continue
    raise Failure(f"seed {seed}: no linkage")


def check(case, program, folder):
    """Runs and compares; the largest differences.  Raises compare.Wrong with a reason."""
    path = os.path.join(folder, f"loads_{case.seed}.deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(case.text(5))
    tables = run(program, path, os.path.join(folder, "tables"))
    deck = Deck(case.text(5), folder)
    return compare_loads.with_solver(deck, tables)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_loads"))
    parser.add_argument("--keep", action="store_true", help="keep the decks of all linkages")
    parser.add_argument("--links", type=int, help="number of links, the ground among them")
    options = parser.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    largest, failures, kinds, done, touching, reached = {}, 0, {}, 0, 0, 0
    for seed in range(options.seed, options.seed + options.count):
        case = make(seed, options.links)
        done, touching, reached = done + 1, touching + case.touching, reached + case.reached
        folder = os.path.join(options.scratch, f"seed_{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for kind, number in case.kinds.items():
            kinds[kind] = kinds.get(kind, 0) + number
        try:
            compare.merge(largest, check(case, options.program, folder))
        except (compare.Wrong, Failure, RuntimeError, ValueError, KeyError, OSError) as failure:
            failures += 1
            print(f"seed {seed}: {failure or repr(failure)} ({' '.join(case.drawing.kinds)}; {folder})", flush=True)
            continue
        if not options.keep:
            shutil.rmtree(folder)
    shown = " ".join(f"{name} {value:.1e}" for name, value in sorted(largest.items()))
    print(f"{done} linkages, {failures} failed; " + " ".join(f"{kind}:{number}" for kind, number in sorted(kinds.items())))
    print(f"contacts act in {touching} of {reached} positions")
    print(f"largest differences: {shown}")
    print(f"{done - failures} passed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
