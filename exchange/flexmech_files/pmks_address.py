"""Addresses of PMKS+: all of the linkage stands behind the `?`.

Groups are joined by `.`: settings in four groups, joints, an empty group, links, an empty group, forces, an empty group, and what is
selected. Numbers are thousandths to the base 64, with a leading 0 where they are negative; so all places are rounded.
"""

import math
import re
import urllib.parse

from .drawing import Body, Drawing, Drive, Force, Slider
from .errors import FileError
from .names import unique

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"
LENGTHS = {"0": "in lbm s", "1": "cm kg s", "2": "m kg s"}
FORCES = {"0": "lbf", "1": "N"}
# Bits of the settings, of joints and of forces.
CLOCKWISE, GRAVITY_OFF = 1, 256
PRISMATIC, INPUT, GROUND, WELDED, CYLINDER = 1, 2, 4, 8, 32
TURNS, OUTWARD = 1, 2
# First letters of links; those of others are parts of welded links, which stand there as a whole, too.
WHOLE = "YAMG0123"
EARTH = 9.81


def is_one(text):
    return bool(re.match(r"\s*(?:https?://\S*\?|\?)?[0-9A-Za-z_-]{1,2}\.[^\s.]+\.[^\s.]+\.\d{3,4}\.", text))


def read(text, name):
    line = text.strip()
    return _Reader(line, text.index(line), name).drawing


class _Group:
    """The items of a group, with the column where it begins."""

    def __init__(self, text, column):
        self.items = text.split(",")
        self.column = column

    def error(self, message):
        return FileError(message, 1, self.column)

    def item(self, index, default=""):
        return self.items[index] if index < len(self.items) else default

    def number(self, index, default=None):
        text = self.item(index)
        if text == "" and default is not None:
            return default
        if not text or any(digit not in DIGITS for digit in text):
            raise self.error(f"expected a number as item {index + 1} of '{','.join(self.items)}'")
        return _whole(text)/1000


def _whole(text):
    value = 0
    for digit in text:
        value = value*64 + DIGITS.index(digit)
    return -value if text[0] == "0" else value


class _Reader:
    def __init__(self, line, begin, name):
        start = line.find("?") + 1
        groups, column = [], begin + start + 1
        for text in line[start:].split("."):
            groups.append(_Group(urllib.parse.unquote(text), column))
            column += len(text) + 1
        self.settings, rest = groups[:4], groups[4:]
        parts = []
        for what in ("joints", "links", "forces"):
            end = next((index for index, group in enumerate(rest) if group.items == [""]), None)
            if end is None and what != "forces":
                raise groups[-1].error(f"the address ends among its {what}: expected an empty group behind them")
            parts.append(rest[:end])
            rest = rest[end + 1:] if end is not None else []
        # is_one has seen that there are three enumerations.
        enums = self.settings[3].item(0)
        self.drawing = Drawing(name, LENGTHS.get(enums[0], LENGTHS["1"]), FORCES.get(enums[2], "N"))
        self.switches = abs(_whole(self.settings[0].item(0)))
        self.joints = {}    # id -> (bits, group, name)
        self.links = {}     # id -> name
        self.pistons = {}   # id of a pin -> [(id of a prismatic joint, mass)]
        self._read_joints(parts[0])
        self._read_links(parts[1])
        self._read_welds()
        self.sliders = {}   # id of a prismatic joint -> Slider
        self._read_sliders()
        self._read_drives()
        self._read_forces(parts[2])

    def _read_joints(self, groups):
        for group in groups:
            flag, number = group.item(0)[:1], group.item(0)[1:]
            if not number or flag not in DIGITS:
                raise group.error(f"expected a joint, not '{','.join(group.items)}'")
            if number in self.joints:
                raise group.error(f"joint {number} is there twice")
            bits = DIGITS.index(flag)
            name = unique(group.item(1).strip() or number, self.drawing.places)
            self.joints[number] = (bits, group, name)
            self.drawing.places[name] = (group.number(2), group.number(3))
            if bits & GROUND and not bits & PRISMATIC:
                self.drawing.ground().append(name)

    def _read_links(self, groups):
        for group in groups:
            letter, kind, number = group.item(0)[:1], group.item(0)[1:2], group.item(0)[2:]
            if kind not in ("R", "P") or not number:
                raise group.error(f"expected a link, not '{','.join(group.items)}'")
            joints = group.items[7:]
            joints = joints[:joints.index("")] if "" in joints else joints
            for joint in joints:
                if joint not in self.joints:
                    raise group.error(f"link {number} has the joint {joint}, which is not in this address")
            if kind == "P":
                self._read_block(joints, group)
            elif letter in WHOLE:
                name = unique(group.item(1).strip() or number, self.drawing.bodies)
                self.links[number] = name
                self.drawing.bodies[name] = Body(
                    [self.joints[joint][2] for joint in joints], mass=group.number(2, 0.0), inertia=group.number(3, 0.0),
                    center=(group.number(4, 0.0), group.number(5, 0.0)))

    def _read_block(self, joints, group):
        """A block joins pins and a prismatic joint at one place."""
        slides = [joint for joint in joints if self.joints[joint][0] & PRISMATIC]
        for joint in joints:
            if joint not in slides:
                for slide in slides:
                    self.pistons.setdefault(joint, []).append((slide, group.number(2, 0.0)))

    def _at(self, pin):
        return [name for name, body in self.drawing.moving().items() if pin in body.pins]

    def _read_welds(self):
        for bits, _, pin in self.joints.values():
            if bits & WELDED and not bits & PRISMATIC:
                whole, *others = self._at(pin) or [None]
                for other in others:
                    self.drawing.join(whole, other)
                    self.links = {key: whole if name == other else name for key, name in self.links.items()}

    def _read_sliders(self):
        for joint, blocks in self.pistons.items():
            for slide, mass in blocks:
                bits, _, pin = self.joints[joint]
                fixed = (self._at(pin) or [None])[0] if bits & WELDED else None
                self._add_slider(slide, pin, fixed, mass)
                self._forget(self.joints[slide][2])
        for joint, (bits, _, pin) in self.joints.items():
            if bits & PRISMATIC and joint not in self.sliders:
                # Without a block: the link itself slides, if the joint is one of it.
                if self._at(pin):
                    self._add_slider(joint, pin, self._at(pin)[0] if bits & WELDED else None, 0.0)
                else:
                    self._forget(pin)

    def _forget(self, pin):
        """Of a prismatic joint nothing is left but its slider, if no link has it for a pin."""
        if not self._at(pin):
            self.drawing.places.pop(pin, None)

    def _add_slider(self, slide, pin, fixed, mass):
        bits, group, _ = self.joints[slide]
        ends = group.items[6:8] if group.item(5) else None
        if ends and (len(set(ends)) != 2 or any(end not in self.joints or self.joints[end][0] & PRISMATIC for end in ends)):
            raise group.error(f"the slot of joint {slide} needs two pins, not '{','.join(ends)}'")
        if ends:
            slider = Slider(pin, tuple(self.joints[end][2] for end in ends), fixed=fixed, mass=mass)
        elif bits & GROUND:
            slider = Slider(pin, line=(group.number(2), group.number(3), math.degrees(group.number(4))), fixed=fixed, mass=mass)
        else:
            self.drawing.note(f"the slider at '{pin}': it has neither ground nor a link to slide on")
            return
        self.sliders[slide] = slider
        self.drawing.sliders.append(slider)
        if bits & CYLINDER:
            self.drawing.note(f"the cylinder at '{pin}': its block slides from one pin of its link to the other")

    def _read_drives(self):
        turn = -1 if self.switches & CLOCKWISE else 1
        speed = 1000*self.settings[2].number(0, 0.001)
        slide_speed = self.settings[1].number(1, 0.0)
        for joint, (bits, group, pin) in self.joints.items():
            if not bits & INPUT:
                continue
            own = group.number(8, 0.0)
            if bits & PRISMATIC:
                if joint in self.sliders:
                    self._drive_slider(self.sliders[joint], own or slide_speed)
                continue
            links = self._at(pin)
            if pin in self.drawing.ground() and links:
                self.drawing.drives.append(Drive(links[0], rate=6*turn*(own or speed)))
            elif len(links) > 1:
                self.drawing.drives.append(Drive(links[1], links[0], rate=6*turn*(own or speed)))
            else:
                self.drawing.note(f"the input at '{pin}': no link to drive")

    def _drive_slider(self, slider, rate):
        if slider.ends:
            length = self.drawing.distance(*slider.ends)
            place = self.drawing.distance(slider.ends[0], slider.pin)
            stroke = (0.01*length - place, 0.99*length - place)
        else:
            stroke = (-self.drawing.size()/4, self.drawing.size()/4)
        self.drawing.drives.append(Drive(slider=slider, rate=rate or None, stroke=stroke, guessed=True))

    def _read_forces(self, groups):
        for group in groups:
            link = self.links.get(group.item(1))
            if link is None:
                self.drawing.note(f"the force {group.item(2) or group.item(0)[1:]}: it acts on no link of its own")
                continue
            flag = group.item(0)[:1]
            if not flag or flag not in DIGITS:
                raise group.error(f"expected a force, not '{','.join(group.items)}'")
            bits = DIGITS.index(flag)
            tail, head = (group.number(3), group.number(4)), (group.number(5), group.number(6))
            way = math.dist(tail, head)
            if way == 0:
                raise group.error(f"the force {group.item(2)} has no direction: its ends are at one place")
            size = group.number(7)*(1 if bits & OUTWARD else -1)/way
            components = tuple(size*(b - a) for a, b in zip(tail, head))
            self.drawing.forces.append(Force(link, tail, components, bool(bits & TURNS)))
        if self.drawing.forces and not self.switches & GRAVITY_OFF:
            self.drawing.gravity = (0.0, -EARTH)
