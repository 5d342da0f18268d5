"""Files of PMKS: text, a line a joint, and .pmks, which is the same as JSON.

A joint names its links, then its type, its place, an angle and what is shown: `input,coupler,R,350,100,0,tfff`. P and RP slide along
a line of the first link, to the second of which they belong; a P does not turn.
"""

import math
import re
from dataclasses import dataclass

from .drawing import FRAME, Body, Drawing, Drive, Slider
from .errors import FileError, number_of
from .json_places import Part, parse, place_of

TYPES = ("R", "P", "RP", "G")
FRAMES = re.compile(r"0|gnd|grnd|grond|gound|groud|ground.*", re.IGNORECASE)


@dataclass
class _Joint:
    links: list
    kind: str
    place: tuple
    angle: float    # degrees
    line: int = None


def is_one(text):
    return text.lstrip().startswith("{") and '"TypeOfJoint"' in text or bool(re.search(r"(?mi)^[^{<\n]*[,\s](R|P|RP|G)[,\s]+[-+.\d]", text))


def read(text, name):
    return _read_json(text, name) if text.lstrip().startswith("{") else _read_lines(text, name)


def _read_lines(text, name):
    joints, speed, driver = [], None, None
    for number, line in enumerate(text.splitlines(), 1):
        for sentence in line.split("|"):
            key, equals, rest = sentence.partition("=")
            key, rest = key.strip().lower(), rest.strip()
            if equals and key == "name":
                name = rest or name
            elif equals and key == "s":
                speed = number_of(rest, "the speed", number)
            elif equals and key == "d":
                driver = int(number_of(rest, "the number of the driven joint", number))
            elif not equals or key == "mech":
                words = re.split(r"[,\s]+", (rest if equals else sentence).strip(" ,\t"))
                if words != [""]:
                    joint, shown = _joint_of(words, number, line)
                    if shown[3:4] in ("t", "+") and driver is None:
                        driver = len(joints)
                    joints.append(joint)
    return _drawing(joints, name, driver, speed)


def _joint_of(words, number, line):
    where = [index for index, word in enumerate(words) if word.upper() in TYPES]
    if not where or where[-1] == 0:
        raise FileError(f"expected links, a type ({', '.join(TYPES)}), x and y, not '{line.strip()}'", number, 1)
    kind, links = words[where[-1]].upper(), words[:where[-1]]
    rest = words[where[-1] + 1:]
    if len(rest) < 2:
        raise FileError(f"the place of the joint is missing: expected x and y behind '{kind}'", number, line.rindex(words[where[-1]]) + 1)
    column = line.find(rest[0]) + 1
    place = (number_of(rest[0], "x", number, column), number_of(rest[1], "y", number, column))
    angle, shown = 0.0, ""
    if len(rest) > 2 and re.match(r"[-+.]?\d", rest[2]):
        angle = number_of(rest[2], "the angle", number, column)
        rest = rest[:2] + rest[3:]
    if len(rest) > 2:
        shown = rest[2] if len(rest) == 3 else "".join(word[:1].lower() for word in rest[2:])
    return _Joint([FRAME if FRAMES.fullmatch(link) else link for link in links], kind, place, angle, number), shown


def _read_json(text, name):
    data = parse(text)
    if not isinstance(data.get("Joints"), list):
        raise FileError('expected a list of "Joints"', *place_of(text, "Joints"))
    joints = []
    for number, item in enumerate(data["Joints"]):
        part = Part(item if isinstance(item, dict) else {}, f"joint {number + 1}", place_of(text, "TypeOfJoint", number))
        kind, links = part.text("TypeOfJoint"), part.names("Links")
        if kind not in TYPES or not links:
            raise part.error(f"expected Links and a TypeOfJoint of {', '.join(TYPES)}")
        place = (part.number("X"), part.number("Y"))
        # Here the angle is in radians, and of a line of a moving link it is the angle from that link.
        angle = part.data.get("Angle")
        angle = math.degrees(part.number("Angle")) if isinstance(angle, (int, float)) else 0.0
        joints.append(_Joint([FRAME if FRAMES.fullmatch(link) else link for link in links], kind, place, angle, part.place[0]))
    whole = Part(data, "the file", (None, None))
    driver = int(whole.number("DrivingIndex")) if "DrivingIndex" in data else None
    speed = whole.number("InputSpeed") if "InputSpeed" in data else None
    return _drawing(joints, data.get("Name") or name, driver, speed)


def _drawing(joints, name, driver, speed):
    if not joints:
        raise FileError("there are no joints in this file")
    if driver is None:
        driver = next((index for index, joint in enumerate(joints) if len(joint.links) > 1 and joint.kind in ("R", "P")), 0)
    if not 0 <= driver < len(joints):
        raise FileError(f"the driven joint is number {driver}, and there are {len(joints)}, counted from 0")
    drawing = Drawing(name)
    drawing.note("the file has no unit of length: mm are taken")
    for joint in joints:
        for link in joint.links:
            drawing.bodies.setdefault(link, Body([]))
    pins = [_pin(index) for index in range(len(joints))]
    for joint, pin in zip(joints, pins):
        drawing.places[pin] = joint.place
    far = drawing.size()
    sliders = {}
    for index, (joint, pin) in enumerate(zip(joints, pins)):
        if joint.kind == "R" or joint.kind == "P" and len(joint.links) == 1:
            for link in joint.links:
                drawing.bodies[link].pins.append(pin)
        elif joint.kind == "G" or len(joint.links) != 2:
            drawing.note(f"joint {index + 1}, {', '.join(joint.links)}: no card for a joint of type {joint.kind}")
        else:
            sliders[index] = _slide(drawing, joint, pin, far)
    _drive(drawing, joints[driver], pins[driver], sliders.get(driver), speed)
    return drawing


def _pin(index):
    """A, B, …, Z, A1, B1, …"""
    return chr(ord("A") + index % 26) + (str(index//26) if index >= 26 else "")


def _slide(drawing, joint, pin, far):
    carrier, slides = joint.links
    if joint.kind == "P" and slides == FRAME:
        # Neither turns: the line may be of either.
        carrier, slides = slides, carrier
    drawing.bodies[slides].pins.append(pin)
    fixed = slides if joint.kind == "P" else None
    if carrier == FRAME:
        slider = Slider(pin, line=(*joint.place, joint.angle), fixed=fixed)
    else:
        x, y = joint.place
        c, s = (far*function(math.radians(joint.angle)) for function in (math.cos, math.sin))
        ends = (f"{pin}.from", f"{pin}.to")
        drawing.places[ends[0]], drawing.places[ends[1]] = (x - c, y - s), (x + c, y + s)
        drawing.bodies[carrier].pins += ends
        slider = Slider(pin, ends, fixed=fixed)
        drawing.note(f"the slot of '{carrier}' at '{pin}' has no ends there: '{ends[0]}' and '{ends[1]}' are far away")
    drawing.sliders.append(slider)
    return slider


def _drive(drawing, joint, pin, slider, speed):
    if slider:
        drawing.drives.append(Drive(slider=slider, rate=speed, stroke=(-drawing.size()/4, drawing.size()/4), guessed=True))
        return
    moving = [link for link in joint.links if link != FRAME]
    rate = None if speed is None else math.degrees(speed)
    if FRAME in joint.links and moving:
        drawing.drives.append(Drive(moving[0], rate=rate))
    elif len(moving) > 1:
        drawing.drives.append(Drive(moving[1], moving[0], rate=rate))
    else:
        raise FileError(f"the driven joint {pin} joins nothing to the ground", joint.line)
