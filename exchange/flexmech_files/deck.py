"""A drawing as a deck."""

import math
import re

from .drawing import FRAME
from .names import Names


def number(value, digits=11):
    """Eleven digits: more than change points need, which lengths may miss by 1e-9."""
    return f"{value + 0.0:.{digits}g}"


def _line(text):
    """In one line, without letters that no deck takes."""
    return " ".join(re.sub(r"[\x00-\x08\x0e-\x1f\x7f]", " ", str(text)).split())


def write(drawing, source, ranges_of=None):
    """The text of the deck; `source` says of which file, `ranges_of` gives of the text of a deck where its drive can be."""
    drawing.settle()
    writer = _Writer(drawing, source)
    text = writer.text()
    writer.ranges = ranges_of(text) if ranges_of else []
    return writer.text() if writer.ranges else text


class _Writer:
    def __init__(self, drawing, source):
        self.drawing = drawing
        self.source = source
        self.ranges = []
        self.length_unit = drawing.units.split()[0]
        self.places = drawing.places
        self.least = 1e-12*drawing.size()
        self.links = Names("L")
        self.pins = Names("P")
        for name in drawing.moving():
            self.links.give(name)
        for pin in drawing.places:
            self.pins.give(pin)
        self.width = max(map(len, [*self.links.given.values(), *self.pins.given.values(), " "*8]))
        self.guides = {}        # line -> (name, point, angle)
        self.tracks = {}        # slider -> (name of guide or link, point, angle)
        self.orders = {name: self._order(name) for name in drawing.moving()}
        self.helpers = []       # (name, pin, copy of another pin, link)
        for slider in drawing.sliders:
            self.tracks[id(slider)] = self._track(slider)

    # The order of pins: a driven link begins with its pivot, and blocks slide between the first two.

    def _pivot(self, name):
        driven = any(drive.body == name and drive.slider is None and drive.against is None for drive in self.drawing.drives)
        pivots = [pin for pin in self.drawing.bodies[name].pins if pin in self.drawing.ground()]
        return pivots[0] if driven and pivots and not self.drawing.bodies[name].ram else None

    def _order(self, name):
        pins = list(self.drawing.bodies[name].pins)
        pivot = self._pivot(name)
        ends = [slider.ends for slider in self.drawing.sliders if slider.carrier == name]
        if pivot:
            ends = [pair for pair in ends if pivot in pair]
        first = [pivot] if pivot else []
        first += [pin for pin in (ends[0] if ends else ()) if pin not in first]
        return first + [pin for pin in pins if pin not in first]

    def _track(self, slider):
        """What a slider slides on, with the point from which its place counts, and the direction."""
        if slider.carrier == FRAME:
            x, y, angle = slider.line or (*self.places[slider.ends[0]], self.drawing.angle(*slider.ends))
            key = (round(angle, 9) % 180, round(x*math.sin(math.radians(angle)) - y*math.cos(math.radians(angle)), 9))
            if key not in self.guides:
                self.guides[key] = (self.links.give(("guide", len(self.guides)), f"guide{len(self.guides) + 1}"), (x, y), angle)
            return self.guides[key]
        order = self.orders[slider.carrier]
        if set(order[:2]) == set(slider.ends):
            return self.links[slider.carrier], self.places[order[0]], self.drawing.angle(order[0], order[1])
        for name, ends, _, carrier in self.helpers:
            if carrier == slider.carrier and set(ends) == set(slider.ends):
                return name, self.places[ends[0]], self.drawing.angle(*ends)
        name = self.links.give((slider.carrier, slider.ends), self.links[slider.carrier] + ".slot")
        copy = self.pins.give((slider.ends[1], name), self.pins[slider.ends[1]] + ".end")
        self.helpers.append((name, slider.ends, copy, slider.carrier))
        return name, self.places[slider.ends[0]], self.drawing.angle(*slider.ends)

    def _length(self, value):
        """Without what rounding has left of 0."""
        return number(value if abs(value) > self.least else 0.0)

    # Cards.

    def text(self):
        # Drives come first: they may ask for MEASURE cards.
        drives, positions, laws = self._drives()
        blocks = [
            [f"TITLE    {_line(self.drawing.title) or 'A linkage'}"],
            [f"! {_line(line)}" for line in [f"From {self.source}, by flexmech-import."] + self._notes()],
            [f"UNITS    {self.drawing.units}"],
            self._ground() + self._guides(),
            self._links(),
            self._moving_pins(),
            self._welds() + self._sliders() + drives,
            self._loads(),
            positions,
            self._reports(laws),
        ]
        return "\n\n".join("\n".join(line.rstrip() for line in block) for block in blocks if block) + "\nEND\n"

    def _notes(self):
        notes = self.drawing.notes
        return ["Not as in the file:"] + [f"- {note}" for note in notes] if notes else []

    def _place(self, pin):
        x, y = self.places[pin]
        return f"{self._length(x):>14} {self._length(y):>14}"

    def _used(self):
        used = {slider.pin for slider in self.drawing.sliders}
        used.update(pin for element in self.drawing.elements for pin in element.pins)
        for body in self.drawing.moving().values():
            used.update(body.pins)
        return used

    def _ground(self):
        used = self._used()
        return [f"GROUND   {self.pins[pin]:{self.width}} {self._place(pin)}" for pin in dict.fromkeys(self.drawing.ground()) if pin in used]

    def _guides(self):
        return [f"GUIDE    {name:{self.width}} {self._length(x):>14} {self._length(y):>14} angle={number(angle)}"
                for name, (x, y), angle in self.guides.values()]

    def _links(self):
        cards = []
        for name, body in self.drawing.moving().items():
            pins = " ".join(self.pins[pin] for pin in self.orders[name])
            cards.append(f"LINK     {self.links[name]:{self.width}} {pins}{self._mass(name, body)}")
        massive = any(body.mass is not None for body in self.drawing.moving().values())
        for name, ends, copy, _ in self.helpers:
            cards.append(f"LINK     {name:{self.width}} {self.pins[ends[0]]} {copy}{' mass=0 inertia=0' if massive else ''}")
        return cards

    def _mass(self, name, body):
        if body.mass is None:
            return ""
        words = f" mass={number(body.mass)}"
        if body.inertia is not None:
            words += f" inertia={number(body.inertia)}"
        if body.center is not None:
            words += " center=" + ",".join(self._length(value) for value in self._on_link(name, body.center))
        return words

    def _on_link(self, name, place):
        """Along a link from its first pin to its second, and to the left."""
        first, second = self.orders[name][:2]
        return self._turned(tuple(a - b for a, b in zip(place, self.places[first])), -self.drawing.angle(first, second))

    @staticmethod
    def _turned(vector, angle):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        return c*vector[0] - s*vector[1], s*vector[0] + c*vector[1]

    def _moving_pins(self):
        used = self._used() - set(self.drawing.ground())
        cards = [f"PIN      {self.pins[pin]:{self.width}} {self._place(pin)}" for pin in self.places if pin in used]
        return cards + [f"PIN      {copy:{self.width}} {self._place(ends[1])}" for _, ends, copy, _ in self.helpers]

    def _welds(self):
        return [f"WELD     {self.pins[ends[0]]} {self.links[carrier]} {name}" for name, ends, _, carrier in self.helpers]

    def _sliders(self):
        cards = []
        for slider in self.drawing.sliders:
            fixed = f" {self.links[slider.fixed]}" if slider.fixed else ""
            mass = f" mass={number(slider.mass)}" if slider.mass else ""
            cards.append(f"SLIDER   {self.pins[slider.pin]} {self.tracks[id(slider)][0]}{fixed}{mass}")
        return cards

    # Drives: the first has the positions, others follow it by a ratio or, where they go their own way, all have laws.

    def _drive(self, drive):
        """The words of a DRIVE card, its position in the drawing, whether this is an angle, and a card before it."""
        if drive.slider:
            track, point, angle = self.tracks[id(drive.slider)]
            way = self._turned(tuple(a - b for a, b in zip(self.places[drive.slider.pin], point)), -angle)
            return f"{self.pins[drive.slider.pin]} {track}", way[0], False, []
        name = self.links[drive.body]
        first, second = self.orders[drive.body][:2]
        if self.drawing.bodies[drive.body].ram:
            return f"{name} length", self.drawing.distance(first, second), False, []
        angle = self.drawing.angle(first, second)
        if drive.against:
            angle -= self.drawing.angle(*self.orders[drive.against][:2])
            return f"{name} against {self.links[drive.against]}", angle % 360, True, []
        if not self._pivot(drive.body):
            measure = self.links.give(("angle", drive.body), name + ".angle")
            return measure, angle % 360, True, [f"MEASURE  {measure} angle {name}"]
        return name, angle % 360, True, []

    def _drives(self):
        drives = [(drive, *self._drive(drive)) for drive in self.drawing.drives]
        if not drives:
            return [], [], False
        # What turns, then what has a speed, goes first.
        drives.sort(key=lambda item: (not item[0].rate and not item[0].formula, not item[3]))
        if any(drive.formula for drive, *_ in drives) or len({drive.cycles for drive, *_ in drives if drive.rate}) > 1:
            return self._lawful(drives)
        first, words, start, turning, cards = drives[0]
        cards = cards + [f"DRIVE    {words}"]
        for drive, other, place, _, before in drives[1:]:
            if first.rate and drive.rate:
                ratio = drive.rate/first.rate
                cards += before + [f"DRIVE    {other} ratio={number(ratio)} phase={number(place - ratio*start)}"]
            else:
                cards += before + [f"DRIVE    {other} at={number(place)}"]
        return cards, self._positions(first, start, turning), False

    def _positions(self, drive, start, turning):
        low, high = self._reach(drive, start, turning)
        if low < high:
            step = 10**math.floor(math.log10((high - low)/40))
            step *= next(factor for factor in (5, 2, 1) if (high - low)/(factor*step) >= 40)
            if (low, high) != self._stroke(drive, start):
                # The ends of a range are dead points.
                low, high = step*math.ceil(low/step + 0.01), step*math.floor(high/step - 0.01)
            cards = [f"CRANK    {number(low, 8)} to {number(high, 8)} step {number(step)}"]
        else:
            cards = ["CRANK    0 to 360 step 5"]
        if drive.rate:
            speed = f"{number(drive.rate/6)} rpm" if turning else f"{number(drive.rate)}{self.length_unit}/s"
            often = f"   ! to and fro, {number(drive.cycles)} times a minute" if drive.cycles else ""
            cards.append(f"SPEED    {speed}{often}")
        return cards

    @staticmethod
    def _stroke(drive, start):
        return tuple(sorted(start + way for way in drive.stroke)) if drive.stroke else (0.0, 0.0)

    def _reach(self, drive, start, turning):
        """Where the drive goes: over its stroke, as far as the linkage closes in the range of the drawing; (0, 0) is everywhere."""
        stroke = self._stroke(drive, start)
        for low, high in self.ranges:
            turn = 360*math.ceil((low - start)/360) if turning else 0
            if low <= start + turn <= high:
                if drive.stroke and not drive.guessed:
                    low, high = max(low, stroke[0] + turn), min(high, stroke[1] + turn)
                return low, high
        return stroke

    def _lawful(self, drives):
        cards, laws, periods = [], [], []
        for index, (drive, words, start, turning, before) in enumerate(drives, 1):
            unit = "deg" if turning else self.length_unit
            law = f"way{index}"
            if drive.formula:
                drawn, formula = drive.formula
                cards += before + [f"DRIVE    {words} law={law}"]
                laws.append(f"LAW      {law} formula={number(round(start - drawn, 9))}deg{formula}")
                periods.append(10)
                continue
            if not drive.rate:
                cards += before + [f"DRIVE    {words} at={number(start)}"]
                continue
            cards += before + [f"DRIVE    {words} law={law}"]
            if drive.cycles:
                period = 60/drive.cycles
                half = (drive.stroke[1] + drive.stroke[0])/2
                laws.append(f"LAW      {law} formula={number(start)}{unit}{half:+.11g}{unit}*(1-cos(2*pi*t/{number(period)}s))")
            else:
                period = 360/abs(drive.rate)
                laws.append(f"LAW      {law} formula={number(start)}{unit}{drive.rate:+.11g}{unit}/s*t")
            periods.append(period)
        longest = max(periods)
        return cards, laws + [f"TIME     0 to {number(longest)} step {number(longest/72)}"], True

    def _loads(self):
        cards = []
        if self.drawing.gravity:
            cards.append("GRAVITY  " + " ".join(f"{number(value)}m/s2" if value else "0" for value in self.drawing.gravity))
        for force in self.drawing.forces:
            along, offset = self._on_link(force.body, force.place)
            components = force.components
            if force.turns:
                components = self._turned(components, -self.drawing.angle(*self.orders[force.body][:2]))
            words = " ".join(f"{number(value)}{self.drawing.force_unit}" for value in components)
            axes = " axes=link" if force.turns else ""
            cards.append(f"FORCE    {self.links[force.body]} {words} at={self._length(along)} offset={self._length(offset)}{axes}")
        for element in self.drawing.elements:
            words = [element.name] if element.name else []
            words += [self.pins[pin] for pin in element.pins] + [self.links[link] for link in element.links]
            words += [(f"{key}=" if key else "") + f"{number(value)}{unit}" for key, (value, unit) in element.values.items()]
            cards.append(f"{element.card:8} {' '.join(words)}")
        return cards

    def _reports(self, laws):
        reports = ["kinematics", "pins"] + ([] if laws else ["linkage"])
        cards = []
        if self.drawing.forces or self.drawing.gravity or self.drawing.elements:
            cards.append("INERTIA  distributed")
            reports += ["reactions", "drives"]
        return cards + [f"REPORT   {report}" for report in reports]
