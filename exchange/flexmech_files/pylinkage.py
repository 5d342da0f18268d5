"""Files of pylinkage (JSON).

Drivers have an angular velocity in radians a step, and no time. A prismatic joint is a pin on a fixed line; a tracker is a point at a
distance and an angle from a line of two joints. Lengths have no unit.
"""

import math

from .drawing import FRAME, Body, Drawing, Drive, Slider
from .json_places import Part, parse, parts, place_of

KINDS = ("ground", "revolute", "prismatic", "tracker")
BARS = ("ground", "driver", "arc_driver", "link")


def is_one(text):
    return text.lstrip().startswith("{") and '"joints"' in text and '"links"' in text and '"position"' in text


def read(text, name):
    data = parse(text)
    joints = parts(data, "joints", text, "joint")
    links = parts(data, "links", text, "link")
    if not joints or not links:
        raise Part(data, "the file", place_of(text, "joints")).error("it has no joints, or no links")
    drawing = Drawing(data.get("name") or name)
    drawing.note("the file has no unit of length: mm are taken")
    for key, joint in joints.items():
        _add_joint(drawing, str(key), joint)
    trackers = [(str(key), joint) for key, joint in joints.items() if joint.data.get("type") == "tracker"]
    for key, link in links.items():
        _add_link(drawing, str(key), link)
    for key, joint in trackers:
        _add_tracker(drawing, key, joint)
    return drawing


def _add_joint(drawing, key, joint):
    kind = joint.data.get("type", "revolute")
    if kind not in KINDS:
        raise joint.error(f"expected a type of {', '.join(KINDS)}, not '{kind}'")
    drawing.places[key] = joint.pair("position")
    if kind == "ground":
        drawing.ground().append(key)
    elif kind == "prismatic":
        dx, dy = joint.pair("axis", [1.0, 0.0])
        if dx == 0 and dy == 0:
            raise joint.error("\"axis\" has no direction")
        drawing.sliders.append(Slider(key, line=(*joint.pair("line_point", [0.0, 0.0]), math.degrees(math.atan2(dy, dx)))))


def _add_link(drawing, key, link):
    kind, pins = link.data.get("type", "link"), link.names("joints")
    if kind not in BARS:
        raise link.error(f"expected a type of {', '.join(BARS)}, not '{kind}'")
    for pin in pins:
        if pin not in drawing.places:
            raise link.error(f"joint '{pin}' is not in this file")
    if kind == "ground":
        drawing.ground().extend(pin for pin in pins if pin not in drawing.ground())
        return
    drawing.bodies[key] = Body(list(pins))
    if kind in ("driver", "arc_driver"):
        motor = link.data.get("motor_joint")
        if motor in pins and motor not in drawing.ground():
            drawing.ground().append(motor)
        stroke = None
        if kind == "arc_driver":
            stroke = _arc(drawing, link, pins)
        step = math.degrees(link.number("angular_velocity", math.tau/360))
        drawing.note(f"link '{key}' turns by {step:.6g} deg a step; steps have no time: SPEED is missing")
        drawing.drives.append(Drive(key, stroke=stroke))


def _arc(drawing, link, pins):
    """From and to, counted from the drawing."""
    grounds = [pin for pin in pins if pin in drawing.ground()]
    others = [pin for pin in pins if pin not in grounds]
    if not grounds or not others:
        raise link.error("an arc_driver needs a ground joint and another one")
    drawn = drawing.angle(grounds[0], others[0])
    low, high = sorted(math.degrees(link.number(word, default)) for word, default in (("arc_start", 0.0), ("arc_end", math.pi)))
    turns = 360*round((drawn - (low + high)/2)/360)
    return low + turns - drawn, high + turns - drawn


def _add_tracker(drawing, key, joint):
    """A tracker belongs to the link of both joints; where none has both it is none of a body."""
    ends = {joint.text("ref_joint1_id"), joint.text("ref_joint2_id")}
    if not ends <= set(drawing.places):
        raise joint.error("it refers to joints that are not in this file")
    body = next((body for name, body in drawing.bodies.items() if name != FRAME and ends <= set(body.pins)), None)
    if body is None:
        drawing.note(f"the tracker '{key}': its joints are on no common link")
        del drawing.places[key]
    elif key not in body.pins:
        body.pins.append(key)
