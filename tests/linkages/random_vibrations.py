"""Frequencies of random linkages of all kinds by the program, each with its error column, against counts of eigenvalues in 50 digits.

    random_vibrations.py SEED COUNT [--program PATH] [--scratch FOLDER] [--keep] [--jobs N] [--kind KIND] [--skip-refused]

A row that says f with the error e claims that so many eigenvalues lie below f (1 - e) and f (1 + e); dynamic stiffness
(vibrations.py) counts how many there are.  A claim that is wrong is a violation, and its line has the true frequency.  Failed rows
are counted by their reasons, and so are decks that the program refuses.
"""
import argparse
import collections
import math
import multiprocessing
import os
import shutil
import sys
import tempfile
from decimal import Decimal

from decks import Deck
from extremes import MANY, Extreme
from fields import Digits
from growth import Drawing, Retry
from solver import Failure
from tables import run
from vibrations import Structure, assemblies, frequency_to_eigenvalue

ORDERS = (30, 60, 100)                         # of polynomials of the reference: the higher ones where the first sees a violation
KINDS = ("four_bar", "grown", "extreme", "grown", "arm", "grown", "parallel", "guided")
OTHER_KINDS = ("many", "slotted")              # only where they are asked for
WORST_CONDITION = 300.0
ZERO_EIGENVALUE = Decimal("1e-9")              # (rad/s)^2: a frequency that is printed as 0 is within


class Chain(Drawing):
    """Linkages that do not grow: open arms, and those with more cranks or guides than needed."""

    def __init__(self, seed, kind):
        self.kind_of_chain = kind
        super().__init__(seed, 0)

    def build(self, links):
        self.kinds.append(self.kind_of_chain)
        getattr(self, self.kind_of_chain)()

    def arm(self):
        """One to four links in a row; each joint is held or free."""
        self.grounds.append(self.new_pin((0.0, 0.0), "G"))
        last, direction = self.grounds[0], 0.0
        for k in range(int(self.uniform(1, 4.999))):
            turn = round(self.uniform(-150, 150), 3)
            direction += turn
            pin = self._arm(last, direction, self.uniform(0.3, 1.0))
            link = self.new_link(last, pin, keep_order=True)
            free = "free" if self.chance(0.35) else ""
            if k == 0:
                self.angle = turn
                self.drives.append((link, [], free))
            else:
                self.drives.append((link, ["against", f"link{k}"], f"at={turn!r}deg {free}".strip()))
            last = pin

    def parallel(self):
        """A coupler on three or four equal cranks; coordinates are short decimals, so that they fit exactly."""
        dx, dy = round(self.uniform(-0.4, 0.4), 4), round(self.pick((-1, 1)) * self.uniform(0.2, 0.5), 4)
        tops, x = [], 0.0
        for _ in range(int(self.uniform(3, 4.999))):
            foot = (round(x, 4), round(self.uniform(-0.3, 0.3), 4))
            ground = self.new_pin(foot, "G")
            self.grounds.append(ground)
            tops.append(self.new_pin((round(foot[0] + dx, 4), round(foot[1] + dy, 4))))
            self.new_link(ground, tops[-1], keep_order=True)
            x += self.uniform(0.3, 0.8)
        for one, other in zip(tops, tops[1:]):
            if abs(math.sin(self.direction(one, other) - math.atan2(dy, dx))) < 0.25:
                raise Retry                    # a change point is near
        self.angle = math.degrees(math.atan2(dy, dx))
        self.links["coupler"] = tops
        self.drives.append(("link1", [], ""))

    def guided(self):
        """A crank, a rod and a ram of several blocks on one guide."""
        self.grounds.append(self.new_pin((0.0, 0.0), "G"))
        self.angle = round(self.uniform(-180, 180), 3)
        end = self._arm("G1", self.angle, self.uniform(0.15, 0.4))
        self.new_link("G1", end, keep_order=True)
        y = self.places[end][1]
        x = self.places[end][0] + self.uniform(0.7, 1.2)
        row = [self.new_pin((x, 0.0))]
        for _ in range(int(self.uniform(1, 3.999))):
            x += self.uniform(0.2, 0.5)
            row.append(self.new_pin((x, 0.0)))
        if abs(y) > 0.6 * (self.places[row[0]][0] - self.places[end][0]):
            raise Retry
        self.new_link(end, row[0])
        self.links["ram"] = row
        self.guides["guide1"] = (0.0, 0.0, 0.0)
        for pin in row[:1 + int(self.uniform(1, len(row) - 0.001))]:
            self.sliders.append([pin, "guide1", None])
        self.drives.append(("link1", [], ""))


class Slotted(Drawing):
    """A lever that slides over a crank pin, with further blocks on it, and pins between its ends."""

    def build(self, links):
        self.crank()
        while not self.attempt("lever"):
            pass
        wanted = 1 + int(self.uniform(1, 2.999))
        for _ in range(100):
            if len(self.kinds) > wanted:
                return
            self.attempt(self.pick(("rod", "rod", "pair", "inner")))
        raise Retry

    def lever(self):
        block = self.moving_pins()[0]
        pivot = self.new_ground(self.places[block])
        reach = math.dist(self.places[pivot], self.places[block])
        end = self.new_pin(self.between(pivot, block, self.uniform(1.4, 2.2)))
        if reach < 0.4:
            raise Retry
        self.slot = self.new_link(pivot, end, keep_order=self.chance(0.6))
        self.sliders.append([block, self.slot, None])

    def rod(self):
        self.rrp_on_link(self.slot)

    def pair(self):
        self.prp(self.slot)

    def inner(self):
        """A pin of the lever between its ends, which carries a dyad: a block may pass it."""
        first, second = self.links[self.slot]
        length = math.dist(self.places[first], self.places[second])
        along = round(self.uniform(0.2, 0.9) * length, 6)
        if any(abs(along - other) < 0.05 for _, other, _ in self.points.values()):
            raise Retry
        pin = self.new_pin(self.between(first, second, along / length))
        self.points[pin] = (self.slot, along, 0.0)
        self._dyad_on(pin, self.new_ground(self.places[pin]))


def drawing_of(seed, kind):
    """A linkage of a kind."""
    if kind == "slotted":
        for trial in range(100):
            try:
                return Slotted(seed + 1000003 * trial, 0)
            except Retry:
                continue
        raise Failure("no such drawing")
    if kind == "grown":
        return Drawing(seed, 4 + seed % 5)
    for trial in range(1000 if kind == "four_bar" else 0):
        drawing = Drawing(seed + 1000003 * trial, 4)
        if drawing.kinds == ["crank", "rrr"] and len(drawing.grounds) == 2 and not drawing.points \
                and all(len(pins) == 2 for pins in drawing.links.values()):
            return drawing
    for trial in range(100):
        try:
            return Chain(seed + 1000003 * trial, kind)
        except Retry:
            continue
    raise Failure("no such drawing")


class Case:
    """A linkage with sections, masses, springs and loads; text(...) is its deck."""

    def __init__(self, seed, kind=None):
        self.seed, self.kind = seed, kind or KINDS[seed % len(KINDS)]
        self.drawing = drawing = drawing_of(seed, self.kind)
        self.scale = drawing.pick((1.0, 1.0, 1000.0))
        self.units = "m kg s" if self.scale == 1.0 else "mm kg s"
        first = drawing.drives[0][1]
        self.linear = first not in ([],) and first[0] != "against"
        self.loaded = drawing.chance(0.5)
        self.thick = drawing.pick(("", "", "", "rotary", "shear", "rotary shear"))
        self.cards = self._cards()

    def number(self, low, high, factor=1.0):
        return f"{self.drawing.uniform(low, high) * factor:.6g}"

    def power(self, low, high, factor=1.0):
        return f"{10**self.drawing.uniform(low, high) * factor:.6g}"

    def _length(self, pins):
        places = self.drawing.places
        return min(math.dist(places[one], places[other]) for one, other in zip(pins, pins[1:]))

    def _cards(self):
        """All cards but PIN, CRANK, SPEED and REPORT."""
        drawing, scale = self.drawing, self.scale
        lines = [f"TITLE random linkage {self.seed}: " + " ".join(drawing.kinds), "UNITS " + self.units,
                 "MATERIAL metal E=200GPa density=7850kg/m3 nu=0.3", "MATERIAL plastic E=3GPa density=1200kg/m3 nu=0.35"]
        for pin in drawing.grounds:
            x, y = drawing.places[pin]
            lines.append(f"GROUND {pin} {round(x * scale, 9)!r} {round(y * scale, 9)!r}")
        for name, (x, y, angle) in drawing.guides.items():
            lines.append(f"GUIDE {name} {x * scale!r} {y * scale!r} angle={angle!r}")
        self.bending, self.contacts = set(), {slider[1] for slider in drawing.sliders if slider[2]}
        links = list(drawing.links)
        certain = drawing.pick(name for name in links if name != drawing.driven_length)
        for name in links:
            lines += self._link(name, drawing.links[name], name == certain)
        for name, (link, along, offset) in drawing.points.items():
            lines.append(f"POINT {name} {link} along={along * scale!r} offset={offset * scale!r}")
        for pin, guide, link in drawing.sliders:
            mass = f" mass={self.power(-2, 1)}kg" if drawing.chance(0.6) and pin not in drawing.grounds else ""
            if guide in drawing.links and drawing.chance(0.4):
                mass += f" inertia={self.power(-5, -2)}kg*m2"
            lines.append(" ".join(["SLIDER", pin, guide] + ([link] if link else [])) + mass)
        for pin, welded in drawing.welds:
            lines.append(f"WELD {pin} " + " ".join(welded))
        for name, words, keys in drawing.drives:
            lines.append(" ".join(["DRIVE", name] + words + ([keys] if keys else [])))
        for pin in drawing.moving_pins():
            if drawing.chance(0.3):
                lines.append(f"PINMASS {pin} {self.power(-2, 1)}kg")
            if self.loaded and drawing.chance(0.1):
                lines.append(f"FORCE {pin} {self.number(-20, 20)}N {self.number(-20, 20)}N")
        lines += self._masses() + self._springs()
        if self.loaded and drawing.chance(0.4):
            lines.append(f"GRAVITY {self.number(-3, 3)}m/s2 {self.number(-10, -8)}m/s2")
        lines.append(f"MESH * accuracy=1e-{3 + int(drawing.uniform(0, 9.999))}")
        lines.append(f"EFFECTS {'axial' if self.loaded else 'static'} {self.thick}".rstrip())
        return lines + ["MODES " + str(3 + int(drawing.uniform(0, 3.999))), "INERTIA distributed"]

    def _link(self, name, pins, certain):
        """SECTION and LINK cards."""
        drawing, scale = self.drawing, self.scale
        beside = any(link == name and offset for link, _, offset in drawing.points.values())
        section = f"section_{name}"
        thick = self._length(pins) * 10**drawing.uniform(-2.3, -1.0 if self.thick else -1.4) * scale
        width = thick * drawing.uniform(0.5, 5)
        kinds = ["general"] if "shear" in self.thick else ["rectangle", "circle", "tube", "general"]
        kind = drawing.pick(kinds)
        sizes = {"rectangle": f"thickness={thick:.6g} width={width:.6g}", "circle": f"diameter={thick:.6g}",
                 "tube": f"outer={thick:.6g} inner={thick * drawing.uniform(0.4, 0.95):.6g}",
                 "general": f"A={thick * width:.6g} I={thick**3 * width / 12:.6g} shear_coefficient={drawing.uniform(0.4, 0.9):.4g}"}
        lines = [f"SECTION {section} {kind} {sizes[kind]}"]
        if name == drawing.driven_length:      # its mass goes with the pin that is placed first
            pins = sorted(pins, key=lambda pin: pin not in drawing.grounds)
        words = " ".join(pins)
        material = f" material={drawing.pick(('metal', 'metal', 'plastic'))} section={section}"
        body = f" mass={self.power(-1.5, 1)}kg inertia={self.power(-4, -1)}kg*m2"
        if len(pins) > 2 or drawing.chance(0.5) or name == drawing.driven_length:
            body += f" center={self.number(-0.2, 0.8, scale)},{self.number(-0.3, 0.3, scale)}"
        certain = certain or (self.kind == "slotted" and name == drawing.slot)
        must_be_rigid = beside or name == drawing.driven_length or (self.loaded and name in self.contacts)
        if must_be_rigid or (not certain and drawing.chance(0.25)):
            if name == drawing.driven_length:
                return [f"LINK {name} {words} rigid" + body]
            return lines + [f"LINK {name} {words} rigid" + (material if drawing.chance(0.4) else body)]
        self.bending.add(name)
        if len(pins) > 2 and drawing.chance(0.35) and self.kind not in ("parallel", "guided"):
            words += " " + pins[0]
        return lines + [f"LINK {name} {words}{material}"]

    def _masses(self):
        drawing, lines = self.drawing, []
        if self.kind == "slotted":
            for _ in range(int(drawing.uniform(0, 3.999))):
                lines += self._fixed(drawing.slot)
        for name, pins in drawing.links.items():
            if name == drawing.driven_length or not drawing.chance(0.15):
                continue
            if name in self.bending:
                reach = math.dist(drawing.places[pins[0]], drawing.places[pins[1]])
                at = reach * drawing.uniform(0.2, 0.8)
                beside = drawing.chance(0.5) and ("shear" not in self.thick or "rotary" in self.thick)
            else:
                at, beside = drawing.uniform(-0.3, 0.8), True
            line = f"MASS {name} {self.power(-2, 0.5)}kg at={at * self.scale:.6g}"
            if beside:
                line += f" offset={self.number(-0.1, 0.1, self.scale)} inertia={self.power(-5, -2)}kg*m2"
            lines.append(line)
        return lines

    def _fixed(self, slot):
        """A mass or a force on a lever under blocks, near one of them or anywhere."""
        drawing = self.drawing
        pins = drawing.links[slot]
        reach = math.dist(drawing.places[pins[0]], drawing.places[pins[1]])
        at = reach * drawing.uniform(0.02, 0.98)
        if drawing.chance(0.5):
            block = drawing.pick(slider[0] for slider in drawing.sliders if slider[1] == slot)
            at = math.dist(drawing.places[pins[0]], drawing.places[block]) + 10**drawing.uniform(-9, -1) * drawing.pick((-1, 1))
        if not 0 < at < reach:
            return []
        beside = drawing.chance(0.5) and ("shear" not in self.thick or "rotary" in self.thick)
        place = f"at={at * self.scale:.10g}" + (f" offset={self.number(-0.1, 0.1, self.scale)}" if beside else "")
        if self.loaded and drawing.chance(0.4):
            return [f"FORCE {slot} {self.number(-20, 20)}N {self.number(-20, 20)}N {place}"]
        return [f"MASS {slot} {self.power(-2, 0.5)}kg {place}" + (f" inertia={self.power(-5, -2)}kg*m2" if beside else "")]

    def _bodies(self, pin):
        """Links that have a pin, and those welded to them."""
        found = self.drawing.holders(pin)
        for _, welded in self.drawing.welds:
            if found & set(welded):
                found = found | set(welded)
        return found

    def _springs(self):
        """Over many decades at rest; softer ones where they load the linkage."""
        drawing, lines = self.drawing, []
        while drawing.chance(0.4) and len(lines) < 4:
            name = f"spring{len(lines)}"
            if drawing.chance(0.5):
                places = list(drawing.places)
                one, other = drawing.pick(places), drawing.pick(places)
                near = math.dist(drawing.places[one], drawing.places[other]) < 0.15
                if near or self._bodies(one) & self._bodies(other) or {one, other} <= set(drawing.grounds):
                    continue
                stiffness = self.power(-1, 3) if self.loaded else self.power(-6, 12)
                most = min(20.0, 0.5 * float(stiffness) * math.dist(drawing.places[one], drawing.places[other]))
                tension = f"force={self.number(-most, most)}N" if self.loaded and drawing.chance(0.7) else ""
                lines.append(f"SPRING {name} {one} {other} stiffness={stiffness}N/m {tension}".rstrip())
            else:
                pin = drawing.pick(drawing.places)
                links = [link for link, pins in drawing.links.items() if pin in pins and link != drawing.driven_length]
                if any(pin == welded for welded, _ in drawing.welds):
                    continue
                if pin in drawing.grounds and links:
                    at = drawing.pick(links)
                elif len(links) > 1:
                    at = " ".join(links[:2])
                else:
                    continue
                torque = f"torque={self.number(-2, 2)}N*m" if self.loaded and drawing.chance(0.7) else ""
                stiffness = self.power(-3, 1) if self.loaded else self.power(-9, 9)
                lines.append(f"SPRING {name} {pin} {at} stiffness={stiffness}N*m/rad {torque}".rstrip())
        return lines

    def text(self, cranks, speed=None):
        """The deck at positions, with a speed besides rest."""
        drawing, scale = self.drawing, self.scale
        def shown(value):
            return repr(value if scale == 1.0 else round(value * scale, 9))

        pins = [f"PIN {pin} {shown(x)} {shown(y)}" for pin, (x, y) in drawing.places.items() if pin not in drawing.grounds]
        lines = self.cards + pins + ["CRANK " + ",".join(cranks)]
        if speed:
            lines.append(f"SPEED 0,{speed}")
        return "\n".join(lines + ["REPORT frequencies", "END"]) + "\n"

    def positions(self):
        """Near the drawing."""
        first = self.drawing.angle * (self.scale if self.linear else 1.0)
        return [repr(first)] + [f"{first + step * (0.004 * self.scale if self.linear else 1.0):.6g}" for step in (3, 8)]


def good_positions(case):
    """Those that the linkage reaches well conditioned: [(crank as text, model, q)]."""
    found = []
    for crank in case.positions():
        deck = Deck(case.text([case.positions()[0], crank]))
        try:
            items = list(assemblies(deck))
            _, model, q = items[-1]
            if model.kept is None and isinstance(case, Case):
                if model.condition(q) > WORST_CONDITION:
                    continue
        except (Failure, ZeroDivisionError):
            continue
        found.append((crank, model, q))
    return found


def claims_of(row, structure):
    """Reasons why a row is wrong: a list of texts."""
    wrong, number = [], 0
    while f"f{number + 1}" in row:
        number += 1
        value, estimate = Decimal(row[f"f{number}"]), Decimal(row[f"error{number}"])
        margin = abs(value) * estimate
        if value == 0:
            low, high = -ZERO_EIGENVALUE, ZERO_EIGENVALUE
        else:
            low, high = frequency_to_eigenvalue(value - margin), frequency_to_eigenvalue(value + margin)
        try:
            below, above = structure.count_below(low)[0], structure.count_below(high)[0]
        except ZeroDivisionError:
            continue
        if not below < number <= above:
            wrong.append(f"f{number} = {value:.17g} with error {estimate:.1e}: {below} below, {above} up to it"
                         + true_value(structure, number, value))
    return wrong, number


def true_value(structure, number, value):
    """For the message."""
    try:
        exact = structure.eigenvalue(number, frequency_to_eigenvalue(abs(value)) or Decimal(1), Decimal("1e-20")).sqrt() / (2 * Digits.pi)
    except (Failure, ZeroDivisionError):
        return ""
    return f"; it is {exact:.20g}, off by {abs(value / exact - 1):.1e}"


class Result:
    """Of a case: what to print, and counts."""

    def __init__(self, seed, kind):
        self.seed, self.kind = seed, kind
        self.lines, self.reasons = [], collections.Counter()
        self.frequencies = self.rows = self.failed = self.violations = 0
        self.refused = self.skipped = None


def examine(job):
    """One linkage."""
    seed, kind, program, scratch = job
    result = Result(seed, kind or KINDS[seed % len(KINDS)])
    try:
        if result.kind in ("extreme", "many"):
            case = Extreme(seed, MANY if result.kind == "many" else None)
        else:
            case = Case(seed, kind)
        positions = good_positions(case)
        if not positions:
            raise Failure("no position is well conditioned")
        at_rest = Structure(positions[0][1], positions[0][2], order=ORDERS[0]).prepare()
        speed = None
        if case.loaded:
            first = at_rest.eigenvalue(at_rest.free_motions() + 1, Decimal(10000), Decimal("1e-6")).sqrt()
            size = 1 if not case.linear else Decimal(repr(case.scale)) / 5
            speed = f"{float(first * size) * 10**case.drawing.uniform(-2, -0.5):.4g}"
    except (Failure, Retry, ZeroDivisionError, RecursionError, StopIteration) as failure:
        result.skipped = str(failure)
        return result
    path = os.path.join(scratch, f"linkage{seed}.deck")
    text = case.text([crank for crank, _, _ in positions], speed)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    try:
        table = run(program, path, os.path.join(scratch, f"out{seed}"))["frequencies"]
    except RuntimeError as error:
        result.refused = str(error)
        return result
    except Exception as error:                 # a table that cannot be read
        result.violations += 1
        result.lines.append(f"{seed}: {error!r}")
        return result
    shutil.rmtree(os.path.join(scratch, f"out{seed}"), ignore_errors=True)
    compare(result, table, Deck(text), positions)
    if not result.lines:
        os.remove(path)
    return result


def compare(result, table, deck, positions):
    """The rows of a table with counts."""
    place = {float(crank): (Decimal(crank), model, q) for crank, model, q in positions}
    for line in table.failed:
        result.failed += 1
        reason = line.split(" : ", 1)[1]
        result.reasons[" ".join(word for word in reason.split() if not any(letter.isdigit() for letter in word))] += 1
    expected = len(positions) * (len(deck.speeds) if "static" not in deck.effects else 1)
    if len(table.rows) + len(table.failed) != expected:
        result.violations += 1
        result.lines.append(f"{result.seed}: {len(table.rows)} rows and {len(table.failed)} failed, not {expected}")
    for row in table.rows:
        result.rows += 1
        here = next((here for crank, here in place.items() if abs(row["crank"] - crank) <= 1e-14 * abs(crank)), None)
        if here is None:
            result.violations += 1
            result.lines.append(f"{result.seed} ({result.kind}): a row at crank {row['crank']!r}, not asked for")
            continue
        for order in ORDERS:
            try:
                wrong, count = claims_of(row, structure_at(deck, *here, Decimal(repr(row["speed"])), order))
            except (Failure, ZeroDivisionError) as failure:
                result.reasons[f"no reference: {failure}"] += 1
                wrong, count = [], 0
            if not wrong:
                break
        result.frequencies += count
        result.violations += len(wrong)
        result.lines += [f"{result.seed} ({result.kind}): speed {row['speed']:g} crank {row['crank']:g}: {reason}" for reason in wrong]


def structure_at(deck, crank, model, q, speed, order):
    """Ready to count; the speed is in the units of results."""
    structure = Structure(model, q, order=order)
    if "static" not in deck.effects:
        speed *= deck.units.results["rate" if deck.drives[0]["linear"] else "speed"]
        structure.load(model.state(q, crank * deck.crank_factor(), speed, deck.alpha()))
    return structure.prepare()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--scratch")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--kind", choices=sorted({*KINDS, *OTHER_KINDS}))
    parser.add_argument("--skip-refused", action="store_true")
    options = parser.parse_args()
    scratch = options.scratch or tempfile.mkdtemp(prefix="vibrations")
    os.makedirs(scratch, exist_ok=True)
    jobs = [(seed, options.kind, options.program, scratch) for seed in range(options.seed, options.seed + options.count)]
    total, reasons, refusals, skips = (collections.Counter() for _ in range(4))
    unlike = 0
    examples = {}
    with multiprocessing.Pool(max(1, options.jobs)) as pool:
        for result in pool.imap(examine, jobs):
            for line in result.lines:
                print(line, flush=True)
            total.update({name: getattr(result, name) for name in ("frequencies", "rows", "failed", "violations")})
            reasons += result.reasons
            refusal = result.refused and result.refused.split("error: ")[-1].split(" | ")[0]
            refusals[refusal] += 1
            skips[result.skipped] += 1
            unlike += bool(result.violations or result.refused and not options.skip_refused)
            for reason in list(result.reasons) + [refusal, result.skipped]:
                examples.setdefault(reason, result.seed)
    refused, skipped = sum(refusals.values()) - refusals.pop(None, 0), sum(skips.values()) - skips.pop(None, 0)
    for title, counts in (("failed rows", reasons), ("refused", refusals), ("not drawn", skips)):
        for reason, count in counts.most_common(12):
            print(f"# {count:5d} {title}: {reason} (the first is linkage {examples[reason]})")
    wrong = total["violations"] + (0 if options.skip_refused else refused)
    print(f"{options.count} linkages, {skipped} not drawn, {refused} refused; {total['rows']} rows and {total['failed']} failed; "
          f"{total['frequencies']} frequencies, {total['violations']} violations")
    if not options.scratch and not options.keep and not wrong:
        shutil.rmtree(scratch)
    elif wrong:
        print(f"decks are in {scratch}")
    print(f"{options.count - unlike} passed, {unlike} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
