"""A linkage as drawn: what formats have in common, before it becomes a deck.

Places are those of the drawing, in the deck's unit of length, angles in degrees. The frame is a body like others, so that
one rule serves it and all bars: bodies that share two pins are one.
"""

import math
from dataclasses import dataclass, field

FRAME = "(frame)"


@dataclass
class Body:
    """A link: its pins in the order of the file; mass, moment of inertia and mass centre, where the file has them."""

    pins: list
    ram: bool = False  # of two pins, whose distance is given
    mass: float = None
    inertia: float = None
    center: tuple = None


@dataclass
class Slider:
    """A pin on the line between two others, both of one body; or on a line of the frame by a point and an angle."""

    pin: str
    ends: tuple = None
    line: tuple = None      # x, y, angle
    fixed: str = None       # a body that cannot turn on the block
    mass: float = 0.0
    carrier: str = FRAME    # the body with the ends, found by settle


@dataclass
class Drive:
    """What is given: of `body`, or of it against another, the angle; of a ram the length; of a slider the place."""

    body: str = None
    against: str = None
    slider: Slider = None
    rate: float = None      # degrees or lengths per second
    stroke: tuple = None    # from and to, counted from the drawing, where the drive does not turn fully
    guessed: bool = False   # of the stroke: the file does not say it
    cycles: float = None    # to and fro, a minute
    formula: tuple = None   # of the time: its value in the drawing in degrees, and its text


@dataclass
class Force:
    body: str
    place: tuple
    components: tuple
    turns: bool = False     # with its body


@dataclass
class Element:
    """A card about pins or links with numbers: a spring, a damper, a torque."""

    card: str
    name: str = None
    pins: tuple = ()
    links: tuple = ()
    values: dict = field(default_factory=dict)  # key, or none -> (number, unit)


@dataclass
class Drawing:
    title: str
    units: str = "mm kg s"
    force_unit: str = "N"
    places: dict = field(default_factory=dict)  # pin -> (x, y)
    bodies: dict = field(default_factory=dict)  # name -> Body
    sliders: list = field(default_factory=list)
    drives: list = field(default_factory=list)
    forces: list = field(default_factory=list)
    elements: list = field(default_factory=list)
    gravity: tuple = None                       # in m/s2
    notes: list = field(default_factory=list)   # what has no card

    def __post_init__(self):
        self.bodies[FRAME] = Body([])

    def note(self, text):
        if text not in self.notes:
            self.notes.append(text)

    def moving(self):
        return {name: body for name, body in self.bodies.items() if name != FRAME}

    def ground(self):
        return self.bodies[FRAME].pins

    def distance(self, one, other):
        return math.dist(self.places[one], self.places[other])

    def angle(self, one, other):
        (x1, y1), (x2, y2) = self.places[one], self.places[other]
        return math.degrees(math.atan2(y2 - y1, x2 - x1))

    def size(self):
        xs, ys = zip(*(list(self.places.values()) or [(0.0, 0.0)]))
        return max(max(xs) - min(xs), max(ys) - min(ys), 1e-9)

    # What is drawn twice, or for nothing, is put in order before a deck is written.

    def settle(self):
        for body in self.bodies.values():
            body.pins = list(dict.fromkeys(body.pins))
        while self._join_pins() or self._join_bodies():
            pass
        self._find_carriers()
        while self._drop_loose():
            pass
        if not self.drives:
            self._drive_some()

    def _join_pins(self):
        """Pins of one body at one place are one pin."""
        near = 1e-9 * self.size()
        for body in self.bodies.values():
            for index, pin in enumerate(body.pins):
                for other in body.pins[index + 1:]:
                    if self.distance(pin, other) <= near and not body.ram:
                        self._rename_pin(other, pin)
                        return True
        return False

    def _rename_pin(self, old, new):
        del self.places[old]
        for body in self.bodies.values():
            body.pins = list(dict.fromkeys(new if pin == old else pin for pin in body.pins))
        for slider in self.sliders:
            slider.pin = new if slider.pin == old else slider.pin
            slider.ends = slider.ends and tuple(new if pin == old else pin for pin in slider.ends)
        for element in self.elements:
            element.pins = tuple(new if pin == old else pin for pin in element.pins)

    def _join_bodies(self):
        """Bodies that share two pins cannot move against each other."""
        names = list(self.bodies)
        for index, one in enumerate(names):
            for other in names[index + 1:]:
                shared = [pin for pin in self.bodies[one].pins if pin in self.bodies[other].pins]
                if len(shared) >= 2 and not self.bodies[one].ram and not self.bodies[other].ram:
                    self.note(f"'{other}' is drawn between ground pivots: part of the frame" if one == FRAME else
                              f"'{other}' and '{one}' share {len(shared)} pins: they are one link")
                    self.join(one, other)
                    return True
        return False

    def join(self, one, other):
        """The second becomes part of the first."""
        gone = self.bodies.pop(other)
        kept = self.bodies[one]
        kept.pins += [pin for pin in gone.pins if pin not in kept.pins]
        if one != FRAME and gone.mass is not None:
            self._join_masses(kept, gone)
        renamed = lambda name: one if name == other else name
        for slider in self.sliders:
            slider.fixed = renamed(slider.fixed)
        for drive in self.drives:
            drive.body, drive.against = renamed(drive.body), renamed(drive.against)
        for force in self.forces:
            force.body = renamed(force.body)
        for element in self.elements:
            element.links = tuple(renamed(link) for link in element.links)
        if one == FRAME:
            self.forces = [force for force in self.forces if force.body != FRAME]
            self.elements = [element for element in self.elements if FRAME not in element.links]

    @staticmethod
    def _join_masses(kept, gone):
        if kept.mass is None:
            kept.mass, kept.inertia, kept.center = gone.mass, gone.inertia, gone.center
            return
        mass = kept.mass + gone.mass
        if mass > 0 and None not in (kept.inertia, gone.inertia, kept.center, gone.center):
            arm = math.dist(kept.center, gone.center)
            kept.inertia += gone.inertia + kept.mass*gone.mass/mass*arm**2
            kept.center = tuple((kept.mass*a + gone.mass*b)/mass for a, b in zip(kept.center, gone.center))
        else:
            kept.inertia = kept.center = None
        kept.mass = mass

    def _find_carriers(self):
        """The bodies that sliders slide on; those that do not slide at all, and drives of what stands still, go."""
        for slider in self.sliders:
            if slider.ends:
                slider.carrier = next((name for name, body in self.bodies.items() if set(slider.ends) <= set(body.pins)), None)
        for slider in list(self.sliders):
            why = None
            if slider.carrier is None:
                why = f"its ends '{slider.ends[0]}' and '{slider.ends[1]}' are on no common link"
            elif slider.pin in self.bodies[slider.carrier].pins:
                why = "it belongs to what it slides on"
            elif slider.fixed == slider.carrier:
                slider.fixed = None
            if why:
                self.sliders.remove(slider)
                self.drives = [drive for drive in self.drives if drive.slider is not slider]
                self.note(f"the slider at '{slider.pin}': {why}")
        for drive in list(self.drives):
            if drive.body == FRAME:
                drive.body, drive.against = drive.against, FRAME
            if drive.against == FRAME:
                drive.against = None
            if drive.slider is None and drive.body in (None, FRAME):
                self.drives.remove(drive)
                self.note("a drive of what stands still")

    def _drop_loose(self):
        """A link that only hangs on one pin, or on none, moves nothing; nor does a block on no link."""
        for slider in self.sliders:
            if not any(slider.pin in body.pins for body in self.bodies.values()):
                self.sliders.remove(slider)
                self.drives = [drive for drive in self.drives if drive.slider is not slider]
                self.note(f"the slider at '{slider.pin}': no link is there")
                return True
        busy = {name for drive in self.drives for name in (drive.body, drive.against)}
        busy.update(force.body for force in self.forces)
        busy.update(link for element in self.elements for link in element.links)
        busy.update(name for slider in self.sliders for name in (slider.carrier, slider.fixed))
        for name, body in self.moving().items():
            elsewhere = {pin for key, other in self.bodies.items() if key != name for pin in other.pins}
            elsewhere.update(slider.pin for slider in self.sliders)
            elsewhere.update(pin for element in self.elements for pin in element.pins)
            held = elsewhere & set(body.pins)
            if len(body.pins) < 2 or len(held) < 2 and name not in busy:
                block = any(body.pins == [slider.pin] for slider in self.sliders)
                self._drop(name, None if block else "has one pin" if len(body.pins) == 1 else "hangs on one pin" if held else
                           "is joined to nothing")
                return True
        return False

    def _drop(self, name, why):
        del self.bodies[name]
        if why:
            self.note(f"link '{name}' {why}")
        self.drives = [drive for drive in self.drives if name not in (drive.body, drive.against)]
        self.forces = [force for force in self.forces if force.body != name]
        self.elements = [element for element in self.elements if name not in element.links]
        for slider in self.sliders:
            slider.fixed = None if slider.fixed == name else slider.fixed

    def _drive_some(self):
        """Without an input in the file: the first link that turns about a pivot."""
        name = next((name for name, body in self.moving().items() if not body.ram and set(body.pins) & set(self.ground())), None)
        if name:
            self.drives.append(Drive(name))
            self.note(f"there is no input in the file: '{name}' is driven")
