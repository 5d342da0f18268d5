"""Files of linkage_sim (JSON, `schema_version` 1): bodies with points in their own axes, joints, drivers, forces; all in SI.

There is no drawing in such a file; the bodies are put together as they fit (`assembly`).
"""

import ast
import cmath
import math
import operator
import re

from . import assembly
from .drawing import FRAME, Body, Drawing, Drive, Element, Force, Slider
from .errors import FileError
from .json_places import Part, parse, parts, place_of
from .names import unique

GROUND = "ground"
# What an expression of a driver may hold, and a LAW may too.
FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "sqrt")}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}


def is_one(text):
    return text.lstrip().startswith("{") and '"bodies"' in text and '"joints"' in text


def read(text, name):
    return _Reader(text, name).drawing


class _Reader:
    def __init__(self, text, name):
        self.text = text
        data = parse(text)
        version = str(data.get("schema_version", ""))
        if version.split(".")[0] != "1":
            raise FileError(f"expected a schema_version of 1, not '{version}'", *place_of(text, "schema_version"))
        self.drawing = Drawing(data.get("name") or name, "m kg s")
        self.bodies = parts(data, "bodies", text, "body")
        self.joints = parts(data, "joints", text, "joint")
        self.drivers = parts(data, "drivers", text, "driver")
        self.bodies.setdefault(GROUND, Part({}, "the ground", (None, None)))
        self.starts = {key: self._start(driver) for key, driver in self.drivers.items()}
        self.places = self._assemble()
        self.pins = {}      # (body, point) -> pin
        self._make_pins()
        self._make_bodies()
        self._make_sliders()
        self._weld()
        self._make_drives()
        for number, item in enumerate(data.get("forces") or [], 1):
            place = place_of(text, item.get("type") if isinstance(item, dict) else "forces")
            self._make_force(Part(item if isinstance(item, dict) else {}, f"force {number}", place), number)
        self._take_blocks()
        for case in data.get("load_cases") or []:
            self.drawing.note(f"the load case '{case.get('name', '') if isinstance(case, dict) else case}'")

    # What is where.

    def _body_of(self, part, key):
        body = part.text(key)
        if body not in self.bodies:
            raise part.error(f"body '{body}' is not in this file")
        return body

    def _point(self, body, point, part):
        for kind in ("attachment_points", "mount_points", "coupler_points"):
            points = self.bodies[body].data.get(kind, {})
            if isinstance(points, dict) and point in points:
                return complex(*Part(points, self.bodies[body].what, self.bodies[body].place).pair(point))
        raise part.error(f"body '{body}' has no point '{point}'")

    def _ends(self, joint):
        one, other = self._body_of(joint, "body_i"), self._body_of(joint, "body_j")
        return (one, joint.text("point_i")), (other, joint.text("point_j"))

    def _assemble(self):
        held = []
        for joint in self.joints.values():
            kind = joint.text("type")
            if kind in ("revolute", "fixed", "prismatic"):
                (one, point), (other, other_point) = self._ends(joint)
                held.append(assembly.Joint(
                    {"revolute": "pin", "fixed": "weld", "prismatic": "line"}[kind], one, other, self._point(one, point, joint),
                    self._point(other, other_point, joint), complex(*joint.pair("axis_local_i", [1.0, 0.0])),
                    joint.number("delta_theta_0", 0.0)))
            elif kind != "revolute_driver":
                raise joint.error(f"there is no card for a joint of the type '{kind}'")
        for key, driver in self.drivers.items():
            held.append(assembly.Joint("angle", self._body_of(driver, "body_i"), self._body_of(driver, "body_j"), angle=self.starts[key]))
        found = assembly.assemble(list(self.bodies), GROUND, held)
        if found is None:
            raise FileError("the bodies do not fit together where the drivers begin", *place_of(self.text, "bodies"))
        self.drawing.note("the file has no drawing: the bodies are put together as they fit, which may be another branch")
        return found

    def _place(self, body, point):
        z, angle = self.places[body]
        place = z + cmath.exp(1j*angle)*point
        return place.real, place.imag

    def _make_pins(self):
        """Points that a revolute or fixed joint joins are one pin, named as the frame names it, or the first body."""
        for joint in self.joints.values():
            if joint.text("type") in ("revolute", "fixed"):
                one, other = self._ends(joint)
                pin = self._pin(one, joint)
                old = self.pins.get(other)
                if old not in (None, pin):
                    self.pins = {key: pin if name == old else name for key, name in self.pins.items()}
                    self.drawing.places.pop(old)
                self.pins[other] = pin
        for joint in self.joints.values():
            if joint.text("type") == "prismatic":
                for end in self._ends(joint):
                    self._pin(end, joint)

    def _pin(self, end, part):
        if end not in self.pins:
            self.pins[end] = self._new_pin(end[1], self._place(end[0], self._point(*end, part)))
        return self.pins[end]

    def _new_pin(self, wish, place):
        name = unique(wish, self.drawing.places)
        self.drawing.places[name] = place
        return name

    def _make_bodies(self):
        for key, body in self.bodies.items():
            if key == GROUND:
                self.drawing.bodies[FRAME].pins += [pin for (name, _), pin in self.pins.items() if name == GROUND]
                continue
            for kind in ("attachment_points", "coupler_points"):
                for point in body.data.get(kind) or {}:
                    self._pin((key, point), body)
            center = self._place(key, complex(*body.pair("cg_local", [0.0, 0.0])))
            pins = [pin for (name, _), pin in self.pins.items() if name == key]
            self.drawing.bodies[key] = Body(list(dict.fromkeys(pins)), mass=body.number("mass", 0.0),
                                            inertia=body.number("izz_cg", body.data.get("Izz_cg", 0.0)), center=center)
            if body.data.get("point_masses"):
                self.drawing.note(f"the point masses of '{key}'")

    def _name(self, body):
        return FRAME if body == GROUND else body

    def _make_sliders(self):
        far = self.drawing.size()
        for joint in self.joints.values():
            if joint.text("type") != "prismatic":
                continue
            one, other = self._ends(joint)
            angle = self.places[one[0]][1] + cmath.phase(complex(*joint.pair("axis_local_i", [1.0, 0.0])))
            if other[0] == GROUND:
                # Neither turns against the other: the line may be of either.
                one, other = other, one
            pin, through = self._pin(other, joint), self._place(one[0], self._point(*one, joint))
            if one[0] == GROUND:
                slider = Slider(pin, line=(*through, math.degrees(angle)), fixed=other[0])
            else:
                way = (far*math.cos(angle), far*math.sin(angle))
                ends = tuple(self._new_pin(f"{pin}.{word}", tuple(a + sign*b for a, b in zip(through, way)))
                             for word, sign in (("from", -1), ("to", 1)))
                self.drawing.bodies[one[0]].pins += ends
                slider = Slider(pin, ends, fixed=other[0])
                self.drawing.note(f"the slot of '{one[0]}' at '{pin}' has no ends there: '{ends[0]}' and '{ends[1]}' are far away")
            self.drawing.sliders.append(slider)

    def _weld(self):
        for joint in self.joints.values():
            if joint.text("type") == "fixed":
                one, other = (self._name(end[0]) for end in self._ends(joint))
                if other == FRAME:
                    one, other = other, one
                if other in self.drawing.bodies and one in self.drawing.bodies:
                    self.drawing.join(one, other)
                else:
                    self.drawing.note("a fixed joint between bodies that are one already")

    def _take_blocks(self):
        """A body of one pin that slides is the block itself."""
        for slider in self.drawing.sliders:
            body = self.drawing.bodies.get(slider.fixed)
            if body and slider.fixed != FRAME and len(body.pins) < 2:
                slider.mass, name = body.mass or 0.0, slider.fixed
                slider.fixed = None
                self.drawing.forces = [force for force in self.drawing.forces if force.body != name or self.drawing.note(
                    f"a force on the block '{name}'")]
                del self.drawing.bodies[name]

    # Drivers.

    def _start(self, driver):
        kind = driver.text("type")
        if kind == "constant_speed":
            return driver.number("theta_0", 0.0)
        if kind == "expression":
            return _value(driver, driver.text("expr"), 0.0)
        raise driver.error(f"expected a type constant_speed or expression, not '{kind}'")

    def _make_drives(self):
        for key, driver in self.drivers.items():
            one, other = self._name(driver.text("body_i")), self._name(driver.text("body_j"))
            sign = 1
            if other == FRAME:
                one, other, sign = other, one, -1
            drive = Drive(other, None if one == FRAME else one)
            if driver.text("type") == "constant_speed":
                drive.rate = sign*math.degrees(driver.number("omega")) or None
            else:
                # In a LAW the time has its unit.
                formula = re.sub(r"\bt\b", "(t/1s)", driver.text("expr").replace(" ", "").replace("^", "**"))
                drive.formula = (sign*math.degrees(self.starts[key]), f"{'+' if sign > 0 else '-'}({formula})*1rad")
            self.drawing.drives.append(drive)
        for joint in self.joints.values():
            if joint.text("type") == "revolute_driver" and not self.drivers:
                self.drawing.note("the driver has no motion there: SPEED is missing")
                self.drawing.drives.append(Drive(self._name(joint.text("body_j")), self._name(joint.text("body_i"))))

    # Forces.

    def _end(self, part, letter):
        """The pin at an end of a spring or the like."""
        body = self._body_of(part, f"body_{letter}")
        point = complex(*part.pair(f"point_{letter}"))
        place = self._place(body, point)
        kept = self.drawing.bodies.get(self._name(body)) or self.drawing.bodies[FRAME]
        near = 1e-9*self.drawing.size()
        pin = next((pin for pin in kept.pins if math.dist(self.drawing.places[pin], place) <= near), None)
        if pin is None:
            pin = self._new_pin(f"{body}.{part.what.split()[-1]}", place)
            kept.pins.append(pin)
        return pin

    def _make_force(self, part, number):
        kind = part.text("type")
        name = f"{kind.lower()}{number}"
        modulation = part.data.get("modulation")
        if isinstance(modulation, dict) and str(modulation.get("modulation_type", "Constant")).lower() not in ("constant", "none"):
            self.drawing.note(f"{part.what}, {kind}: it changes in time")
        elif kind == "Gravity":
            self.drawing.gravity = part.pair("g_vector", [0.0, -9.81])
        elif kind == "LinearSpring":
            self._two_ended("SPRING", f"spring{number}", part, stiffness=(part.number("stiffness"), "N/m"),
                            free_length=(part.number("free_length"), "m"))
        elif kind == "LinearDamper":
            self._two_ended("DAMPER", f"damper{number}", part, damping=(part.number("damping"), "N*s/m"))
        elif kind == "LinearActuator":
            self._two_ended("SPRING", f"actuator{number}", part, stiffness=(0.0, "N/m"), force=(-part.number("force"), "N"))
        elif kind == "TorsionSpring":
            self._at_joint("SPRING", f"coil{number}", part, part.number("stiffness"), part.number("free_angle"))
        elif kind == "RotaryDamper":
            self._at_joint("DAMPER", f"damper{number}", part, part.number("damping"))
        elif kind == "ExternalForce":
            body = self._body_of(part, "body_id")
            if body != GROUND:
                place = self._place(body, complex(*part.pair("local_point")))
                self.drawing.forces.append(Force(body, place, part.pair("force")))
        elif kind == "ExternalTorque":
            body = self._body_of(part, "body_id")
            if body != GROUND:
                self.drawing.elements.append(Element("TORQUE", None, links=(body,), values={"": (part.number("torque"), "N*m")}))
        else:
            self.drawing.note(f"{part.what}, {name}: there is no card for it, or not one alone")

    def _two_ended(self, card, name, part, **values):
        self.drawing.elements.append(Element(card, name, (self._end(part, "a"), self._end(part, "b")), values=values))


    def _at_joint(self, card, name, part, value, free=0.0):
        """Between bodies that share a pin; a spring by the torque that it has in the drawing."""
        one, other = self._body_of(part, "body_i"), self._body_of(part, "body_j")
        angle = self.places[other][1] - self.places[one][1] - free
        if other == GROUND:
            one, other, angle = other, one, -angle
        pins = [self.drawing.bodies.get(self._name(body), Body([])).pins for body in (one, other)]
        shared = [pin for pin in pins[0] if pin in pins[1]]
        if not shared or other == GROUND:
            self.drawing.note(f"{part.what}, {name}: its bodies share no pin")
            return
        values = {"stiffness": (value, "N*m/rad"), "torque": (value*angle, "N*m")} if card == "SPRING" else {"damping": (value, "N*m*s/rad")}
        links = tuple(body for body in (one, other) if body != GROUND)
        self.drawing.elements.append(Element(card, name, (shared[0],), links, values))


def _value(driver, expression, time):
    """The value of an expression of the time."""
    def of(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return float(node.value)
        if isinstance(node, ast.Name) and node.id in ("t", "pi"):
            return {"t": time, "pi": math.pi}[node.id]
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](of(node.left), of(node.right))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            return of(node.operand)*(-1 if isinstance(node.op, ast.USub) else 1)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS and len(node.args) == 1:
            return FUNCTIONS[node.func.id](of(node.args[0]))
        raise ValueError
    try:
        return of(ast.parse(expression.strip().replace("^", "**"), mode="eval").body)
    except (SyntaxError, ValueError, ArithmeticError, RecursionError):
        raise driver.error(f"\"expr\" is no formula of t with + - * / ^ and {', '.join(FUNCTIONS)}: {expression}") from None
