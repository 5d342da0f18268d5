"""Files of Linkage (.linkage2): XML.

Lengths are units of 1/96 inch, whatever `units` says, y upwards. A positive `rpm` is clockwise. What is in layer 1 is a drawing
beside the mechanism.
"""

import math
import re
import xml.parsers.expat
from dataclasses import dataclass, field

from .drawing import FRAME, Body, Drawing, Drive, Slider
from .errors import FileError, number_of
from .names import unique

UNITS = {"Inches": ("in lbm s", 96.0), "Millimeters": ("mm kg s", 96.0/25.4)}
DRAWN_LAYER = 1


def is_one(text):
    return "<linkage2" in text[:2000]


def read(text, name):
    return _Reader(_tree(text), name).drawing


@dataclass
class _Element:
    tag: str
    attributes: dict
    line: int
    column: int
    children: list = field(default_factory=list)

    def all(self, *tags):
        return [child for child in self.children if child.tag.lower() in tags]

    def text(self, key, default=""):
        return self.attributes.get(key, default)

    def true(self, key):
        return self.text(key).lower() == "true"

    def number(self, key, default=None):
        if key not in self.attributes and default is not None:
            return default
        if key not in self.attributes:
            raise self.error(f"<{self.tag}> has no {key}=")
        return number_of(self.text(key), f"{key}= of <{self.tag}>", self.line, self.column)

    def error(self, message):
        return FileError(message, self.line, self.column)

    @property
    def drawn_only(self):
        return self.text("layer", "16") == str(DRAWN_LAYER)


def _tree(text):
    # Some versions of Linkage write attributes without a blank between them.
    text = re.sub(r'(=\s*"[^"<]*")(?=\w)', r"\1 ", text)
    parser = xml.parsers.expat.ParserCreate()
    root = _Element("", {}, 1, 1)
    open_elements = [root]

    def begin(tag, attributes):
        element = _Element(tag, attributes, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        open_elements[-1].children.append(element)
        open_elements.append(element)

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda tag: open_elements.pop()
    try:
        parser.Parse(text, True)
    except xml.parsers.expat.ExpatError as fault:
        raise FileError(f"not the XML of Linkage: {xml.parsers.expat.ErrorString(fault.code)}", fault.lineno, fault.offset + 1) from None
    if root.children[0].tag != "linkage2":
        raise root.children[0].error(f"expected <linkage2>, not <{root.children[0].tag}>")
    return root.children[0]


class _Reader:
    def __init__(self, root, name):
        program = (root.all("program") or [_Element("program", {}, 1, 1)])[0]
        units, self.scale = UNITS.get(program.text("units", "Millimeters"), UNITS["Millimeters"])
        self.drawing = Drawing(name, units)
        scale = program.number("scalefactor", 1.0)
        if scale != 1:
            self.drawing.note(f"the scale {scale:g} of the view: lengths are those of the drawing")
        self.connectors = {}    # id -> element
        self.pins = {}          # id -> pin
        self.links = []         # (element, key)
        self.wheels = {}        # id of a link with gear="true" -> (key, connector of its axis)
        self._read_connectors(root)
        self._read_links(root)
        self._fasten()
        self._read_sliders()
        self._read_drives()
        self._read_ratios(root)

    @staticmethod
    def _key(element, letter, taken):
        return unique(element.text("name").strip() or letter + element.text("id"), taken)

    def _coordinate(self, element, key, default=None):
        """In the deck's unit: of all numbers that the file may mean by its six decimals the shortest, 20 for 75.590551/3.7795276."""
        value = element.number(key, default)/self.scale
        if not re.search(r"\.\d{6}$", element.text(key)) or element.text(key).endswith("000"):
            return value
        near = 0.5e-6/self.scale
        return next((short for short in (round(value, digits) for digits in range(9)) if abs(short - value) <= near), value)

    def _read_connectors(self, root):
        for element in root.all("connector"):
            if element.drawn_only:
                continue
            number = element.text("id")
            if number in self.connectors:
                raise element.error(f"connector {number} is there twice")
            place = (self._coordinate(element, "x"), self._coordinate(element, "y"))
            pin = self._key(element, "P", self.drawing.places)
            self.connectors[number], self.pins[number] = element, pin
            self.drawing.places[pin] = place
            if element.true("anchor"):
                self.drawing.ground().append(pin)
        if not self.connectors:
            raise root.error("no <connector> of a mechanism in this file")

    def _read_links(self, root):
        for element in root.all("link"):
            if element.drawn_only or element.true("measurementelement"):
                continue
            # Pictures are fastened to links, and so may be connectors of the mechanism.
            ids = [child.text("id") for child in element.all("connector", "fastenconnector")]
            missing = [number for number in ids if number not in self.connectors
                       and number in (child.text("id") for child in element.all("connector"))]
            if missing:
                raise element.error(f"link {element.text('id')} has the connector {missing[0]}, which is not in this file")
            pins = [self.pins[number] for number in ids if number in self.pins]
            key = self._key(element, "L", self.drawing.bodies)
            self.drawing.bodies[key] = Body(pins, ram=element.true("actuator"))
            self.links.append((element, key))
            if element.true("gear"):
                self.wheels[element.text("id")] = (key, pins[0] if pins else None)
            if element.true("actuator"):
                self._read_actuator(element, key)

    def _read_actuator(self, element, key):
        if len(self.drawing.bodies[key].pins) != 2:
            raise element.error(f"actuator {element.text('id')} has {len(self.drawing.bodies[key].pins)} connectors, and needs 2")
        cycles = element.number("cpm", 0.0)
        throw = self._coordinate(element, "throw", 0.0)*(-1 if cycles < 0 else 1)
        stroke = (0.0, throw) if throw else None
        self.drawing.drives.append(Drive(key, rate=2*throw*abs(cycles)/60, stroke=stroke, cycles=abs(cycles) or None))

    def _link(self, number):
        """Ids of links are not always unique: the one that holds most connectors is meant."""
        keys = [key for element, key in self.links if element.text("id") == number and key in self.drawing.bodies]
        return max(keys, key=lambda key: len(self.drawing.bodies[key].pins), default=None)

    def _fasten(self):
        joined = {}     # key that is gone -> key of what it is part of
        for element, key in self.links:
            number = element.text("fastenlink")
            to_frame = element.text("fastenconnector") in self.connectors \
                and self.connectors[element.text("fastenconnector")].true("anchor")
            other = FRAME if to_frame else self._link(number) if number else None
            while other in joined:
                other = joined[other]
            if other and other != key and key in self.drawing.bodies:
                self.drawing.join(other, key)
                joined[key] = other
        self.joined = joined

    def _body(self, key):
        while key in self.joined:
            key = self.joined[key]
        return key

    def _read_sliders(self):
        for number, element in self.connectors.items():
            if not element.true("slider"):
                continue
            limits = [child.text("id") for child in element.all("slidelimit")]
            if len(limits) != 2 or not set(limits) <= set(self.pins):
                raise element.error(f"slider {number} needs two <slidelimit> with the ids of connectors")
            ends = tuple(self.pins[limit] for limit in limits)
            radius = abs(self._coordinate(element, "slideradius", 0.0))
            if radius:
                self._read_arc(element, self.pins[number], ends, radius)
            else:
                self.drawing.sliders.append(Slider(self.pins[number], ends))

    def _read_arc(self, element, pin, ends, radius):
        """A pin on an arc is a pin of a link from its centre."""
        carrier = next((body for body in self.drawing.bodies.values() if set(ends) <= set(body.pins)), None)
        if carrier is None:
            self.drawing.note(f"the slider at '{pin}': its ends '{ends[0]}' and '{ends[1]}' are on no common link")
            return
        (x1, y1), (x2, y2) = (self.drawing.places[end] for end in ends)
        chord = math.hypot(x2 - x1, y2 - y1)
        height = math.sqrt(max(radius**2 - chord**2/4, 0.0))
        centers = [((x1 + x2)/2 + side*height*(y1 - y2)/chord, (y1 + y2)/2 + side*height*(x2 - x1)/chord) for side in (1, -1)]
        place = self.drawing.places[pin]
        # The slider lies on the arc about one of them.
        center = min(centers, key=lambda point: abs(math.dist(point, place) - radius))
        # Whatever turns about a centre that is there already has a pin there.
        near = 1e-4*radius
        middle = next((other for other in carrier.pins if math.dist(self.drawing.places[other], center) <= near), None)
        if middle is None:
            middle = pin + ".center"
            self.drawing.places[middle] = center
            carrier.pins.append(middle)
        self.drawing.bodies[pin + ".arc"] = Body([middle, pin])
        self.drawing.note(f"the slot of '{pin}' is an arc: a link from its centre, without the ends of the slot")

    def _read_drives(self):
        for number, element in self.connectors.items():
            if not element.true("input"):
                continue
            pin = self.pins[number]
            driven = [key for key, body in self.drawing.moving().items() if pin in body.pins and not body.ram
                      and len(set(body.pins) & set(self.drawing.ground())) == 1]
            rate = -6*element.number("rpm", 0.0)
            limit = element.number("limitangle", 0.0)
            stroke = (0.0, math.copysign(limit, rate)) if limit else None
            cycles = abs(rate)/(2*limit)*60 if limit and rate else None
            for key in driven:
                self.drawing.drives.append(Drive(key, rate=rate or None, stroke=stroke, cycles=cycles))
            if not driven:
                self.drawing.note(f"the input at '{pin}': no moving link is there")
            if element.number("startoffset", 0.0):
                self.drawing.note(f"startoffset= of the input at '{pin}': the motion begins as drawn")
            if element.true("alwaysmanual"):
                self.drawing.note(f"the input at '{pin}' is moved by hand there")

    # Trains: angular velocities of wheels and carriers are multiples of those of inputs.

    def _read_ratios(self, root):
        rates = {FRAME: 0.0}
        for drive in self.drawing.drives:
            if not self.drawing.bodies[drive.body].ram and drive.rate and not drive.cycles:
                rates[drive.body] = drive.rate
        pairs = [self._pair(element) for ratios in root.all("ratios") for element in ratios.all("ratio")]
        pairs = [pair for pair in pairs if pair]
        found = True
        while found:
            found = any(self._solve(pair, rates) for pair in pairs)
        for one, other, *_ in pairs:
            for key in (one, other):
                if key not in rates:
                    self.drawing.note(f"the wheel '{key}': its speed is no multiple of an input's, and there is no card for such wheels")

    def _pair(self, element):
        links = element.all("link")
        if len(links) != 2 or any(link.number("size") <= 0 for link in links):
            raise element.error("<ratio> needs two <link> with an id= and a size= above 0")
        for link in links:
            if link.text("id") not in self.wheels:
                raise link.error(f"<ratio> names link {link.text('id')}, which is no gear of this file")
        (one, axis), (other, other_axis) = (self.wheels[link.text("id")] for link in links)
        sign = 1 if element.text("type") == "chain" else -1
        value = sign*links[0].number("size")/links[1].number("size")
        carrier = next((key for key, body in self.drawing.bodies.items() if axis in body.pins and other_axis in body.pins), None)
        if carrier is None:
            self.drawing.note(f"the wheels '{one}' and '{other}': no link carries both axes")
            return None
        sizes = [link.number("size") for link in links]
        far = self.drawing.distance(axis, other_axis)
        for key, center, size in ((one, axis, sizes[0]), (other, other_axis, sizes[1])):
            self._add_rim(key, center, far*size/sum(sizes))
        return self._body(one), self._body(other), carrier, value

    def _add_rim(self, key, center, radius):
        """A wheel alone on its axis gets a pin on its rim, for a link has two."""
        body = self.drawing.bodies.get(key)
        if body and body.pins == [center] and radius > 0:
            x, y = self.drawing.places[center]
            self.drawing.places[key + ".rim"] = (x + radius, y)
            body.pins.append(key + ".rim")

    def _solve(self, pair, rates):
        """A train gives the one of its three angular velocities that is not known."""
        one, other, carrier, value = pair
        unknown = [key for key in dict.fromkeys((one, other, carrier)) if key not in rates]
        if len(unknown) != 1:
            return False
        key = unknown[0]
        if key == carrier:
            if value == 1:
                return False
            rates[key] = (rates[other] - value*rates[one])/(1 - value)
        elif key == other:
            rates[key] = rates[carrier] + value*(rates[one] - rates[carrier])
        else:
            rates[key] = rates[carrier] + (rates[other] - rates[carrier])/value
        against = None if FRAME in (key, carrier) or key == carrier else carrier
        self.drawing.drives.append(Drive(key, against, rate=(rates[key] - rates.get(against, 0.0)) or None))
        return True
