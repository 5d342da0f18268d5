"""Loads beside weights, constant forces on pins and constant torques, for the independent solver: FORCE and TORQUE cards with keys,
LOAD, SPRING, DAMPER, STOP and their tables.

Every load is an object with effects(s): what it puts on the linkage in a state, a list of (where, fx, fy) and (body, torque), and
potential(s).  A spring and a stop are told by a coordinate (measures.py); a table by the slopes of its spline at the knots.
"""
import dense
from measures import Angle, Places, coordinate, of_spring


def tanh(field, x):
    """Of decimals by the exponential; both signs to the same digits."""
    if isinstance(x, float):
        import math
        return math.tanh(x)
    if abs(x) > 60:
        return field.number(1 if x > 0 else -1)
    square = (2 * abs(x)).exp()
    value = (square - 1) / (square + 1)
    return value if x > 0 else -value


class Curve:
    """A cubic spline with not-a-knot ends, or periodic, from its slopes d at the knots: continuous second derivatives, with
    one cubic over the first two intervals and over the last two, or both derivatives those of the other end."""

    def __init__(self, field, x, y, period):
        self.x, self.y, self.period, count = x, y, period, len(x)
        zero = field.number(0)
        h = [b - a for a, b in zip(x, x[1:])]
        slope = [(b - a) / step for a, b, step in zip(y, y[1:], h)]
        rows, right = [], []
        for i in range(count if count > 2 else 0):
            row = [zero] * count
            if 0 < i < count - 1:
                # 2 (d_i-1 + 2 d_i - 3 s_i-1)/h_i-1 = 2 (3 s_i - 2 d_i - d_i+1)/h_i
                row[i - 1], row[i], row[i + 1] = 1 / h[i - 1], 2 / h[i - 1] + 2 / h[i], 1 / h[i]
                right.append(3 * slope[i - 1] / h[i - 1] + 3 * slope[i] / h[i])
            elif period is not None and i == 0:
                row[0], row[1], row[-2], row[-1] = 2 / h[0], 1 / h[0], zero, zero
                row[-2] += 1 / h[-1]
                row[-1] += 2 / h[-1]
                right.append(3 * slope[0] / h[0] + 3 * slope[-1] / h[-1])
            elif period is not None:
                row[0], row[-1] = zero + 1, zero - 1
                right.append(zero)
            elif count == 3:
                # Three points: a parabola, whose slopes at both ends of an interval are twice that of the chord together.
                one, other = (0, 1) if i == 0 else (1, 2)
                row[one], row[other] = zero + 1, zero + 1
                right.append(2 * slope[one])
            else:
                # The third derivatives 6 (d_i + d_i+1 - 2 s_i)/h_i^2 of both intervals are one.
                one = 0 if i == 0 else count - 3
                first, second = 1 / h[one]**2, 1 / h[one + 1]**2
                row[one], row[one + 1], row[one + 2] = first, first - second, -second
                right.append(2 * slope[one] * first - 2 * slope[one + 1] * second)
            rows.append(row)
        if count > 2:
            self.d = dense.solve(dense.factor(rows), right)
        else:
            self.d = [slope[0]] * 2

    def ends(self):
        return self.x[0], self.x[-1]

    def value(self, at):
        """Hermite's cubic of the interval."""
        if self.period is not None:
            turns = (at - self.x[0]) / self.period
            whole = int(turns) - (1 if turns < 0 else 0)
            at = at - whole * self.period
        i = 0
        while i < len(self.x) - 2 and at > self.x[i + 1]:
            i += 1
        h = self.x[i + 1] - self.x[i]
        t = (at - self.x[i]) / h
        return ((1 + 2 * t) * (1 - t)**2 * self.y[i] + t**2 * (3 - 2 * t) * self.y[i + 1]
                + h * t * (1 - t) * ((1 - t) * self.d[i] - t * self.d[i + 1]))


class Monotone(Curve):
    """Steffen's cubics of 1990, which have their extremes at knots only: the slope there is that of the parabola through three points, but
    at most twice that of either chord, and 0 where chords rise and fall; at the ends it is that of the parabola, within the same."""

    def __init__(self, x, y):
        self.x, self.y, self.period = x, y, None
        chord = [(y[k + 1] - y[k]) / (x[k + 1] - x[k]) for k in range(len(x) - 1)]
        self.d = [chord[0], chord[-1]]
        if len(x) > 2:
            parabola = [(y[k + 1] - y[k]) / (x[k + 1] - x[k]) + (y[k] - y[k - 1]) / (x[k] - x[k - 1])
                        - (y[k + 1] - y[k - 1]) / (x[k + 1] - x[k - 1]) for k in range(1, len(x) - 1)]
            inner = [self.within(p, one, other) for p, one, other in zip(parabola, chord, chord[1:])]
            self.d = [self.within(2 * chord[0] - parabola[0], chord[0])] + inner + [self.within(2 * chord[-1] - parabola[-1], chord[-1])]

    @staticmethod
    def within(slope, *chords):
        """Between 0 and twice the flattest chord."""
        if min(chords) <= 0 <= max(chords):
            return 0 * slope
        most = 2 * min(chords, key=abs)
        return max(min(slope, most), 0 * slope) if most > 0 else min(max(slope, most), 0 * slope)


class Load(Places):
    """What all loads have: a name for messages, the model, and the places of points."""

    potential_of = None

    def __init__(self, model, keyword, words, keys):
        super().__init__(model)
        self.keyword, self.words, self.keys = keyword, words, keys

    def value(self, key, quantity, default="0"):
        return self.model.field.number(self.model.deck.units.value(self.keys.get(key, default), quantity))

    def potential(self, s):
        return self.zero

    def has_potential(self):
        return False

    def lost(self, s):
        """What of the effects is no change of the potential."""
        return [] if self.has_potential() else self.effects(s)

    def is_fine(self, s):
        """Whether the program computes it there."""
        return True


class Process(Load):
    """FORCE, TORQUE and LOAD cards."""

    def __init__(self, model, keyword, words, keys):
        super().__init__(model, keyword, words, keys)
        deck, field = model.deck, model.field
        self.on_link = keyword == "torque" or "at" in keys or (keyword == "load" and words[0] in model.bodies)
        turns = keyword == "torque" or (keyword == "load" and self.on_link)
        self.turns = turns
        self.smooth = field.number(deck.units.value(keys.get("smooth", "0.01rad/s" if turns else "1mm/s"),
                                                    "speed" if turns else "rate"))
        if turns:
            self.body = model.bodies[words[0]]
        elif self.on_link:
            self.at = (model.bodies[words[0]], self.value("at", "length"), self.value("offset", "length"))
        else:
            self.at = self.place(words[0])
        self.curve = self.over = None
        if "table" in keys:
            self._read_table(keys)
        self.sign = {None: 0, "with": 1, "against": -1}[keys.get("during")]

    def _read_table(self, keys):
        model, field = self.model, self.model.field
        deck, name = model.deck, keys.get("over")
        slider = next((slider for slider in deck.sliders if slider["pin"] == name), None)
        if name is None:
            self.over, angular = ("drive", None), not deck.drives[0]["linear"]
        elif slider:
            self.over, angular = ("slider", slider), False
        elif name == self.words[0] and not self.on_link:
            self.over, angular = ("travel", None), False
        elif name in model.bodies:
            self.over, angular = ("angle", name), True
        elif name == "time":
            self.over, angular = ("time", None), False
        else:
            self.over = ("coordinate", coordinate(model, name))
            angular = self.over[1].is_angle
        (unit_x, x), (unit_y, y) = deck.table(keys["table"])
        period = None
        if angular:
            turns = (x[-1] - x[0]) * (1 if unit_x == "deg" else 180 / field.number(field.pi)) / 360
            if round(float(turns)) > 0 and abs(float(turns) - round(float(turns))) < 1e-9:
                period = 2 * field.pi * round(float(turns))
        x = [field.number(deck.units.value(f"{value}{unit_x}", "number")) for value in x]
        y = [field.number(deck.units.value(f"{value}{unit_y}", "number")) for value in y]
        self.curve = Monotone(x, y) if name == "time" else Curve(field, x, y, period)

    def coordinate(self, s):
        """Of the table."""
        model, (kind, what) = self.model, self.over
        if kind == "drive":
            return s.first
        if kind == "time":
            return s.time
        if kind == "coordinate":
            return what.value(s)
        if kind == "angle":
            return self.angle(s, what)[0]
        if kind == "travel":
            (x, y), _ = self.where(s, self.at)
            fx, fy = self._numbers()
            return (fx * x + fy * y) / model.field.sqrt(fx**2 + fy**2)
        (x, y), _, _ = model.pin_motion(s, what["pin"])
        if what["guide"] in model.guides:
            x0, y0, cosine, sine = model.guides[what["guide"]]
        else:
            body = model.bodies[what["guide"]]
            x0, y0 = s.q[body.first], s.q[body.first + 1]
            sine, cosine = model.trigonometry(s.q, body)
        return (x - x0) * cosine + (y - y0) * sine

    def is_fine(self, s):
        if self.over and self.over[0] == "coordinate" and not self.over[1].is_angle and not self.over[1].is_fine(s):
            return False
        if self.curve is None or self.curve.period is not None:
            return True
        first, last = self.curve.ends()
        if self.over[0] == "time":
            return first <= s.time <= last
        return first < self.coordinate(s) < last

    def _numbers(self):
        """The two numbers of FORCE, a direction if there is a table."""
        quantity = "number" if self.curve else "force"
        return [self.model.field.number(self.model.deck.units.value(word, quantity)) for word in self.words[1:3]]

    def share(self, along):
        """Of a load in one direction of the motion; along: the velocity in the direction of the load."""
        if not self.sign:
            return 1
        return (1 + self.sign * tanh(self.model.field, along / self.smooth)) / 2

    def effects(self, s):
        if self.turns:
            return [(self.body, self._torque(s))]
        fx, fy = self._force(s)
        return [(self.at, fx, fy)]

    def _torque(self, s):
        rate = s.v[self.body.angle]
        if self.keyword == "load":
            resisting = self.value("resisting", "torque")
            return -self.value("torque", "torque") - self.value("damping", "turning_damping") * rate \
                - resisting * tanh(self.model.field, rate / self.smooth)
        if self.curve:
            return self.curve.value(self.coordinate(s)) * self.share(rate)
        torque = self.model.field.number(self.model.deck.units.value(self.words[1], "torque"))
        return torque * self.share(rate if torque > 0 else -rate)

    def _force(self, s):
        field = self.model.field
        _, (vx, vy) = self.where(s, self.at)
        if self.keyword == "load":
            speed = field.sqrt(vx**2 + vy**2)
            damping, resisting = self.value("damping", "damping"), self.value("resisting", "force")
            factor = -damping
            if speed > 0:
                factor -= resisting * tanh(field, speed / self.smooth) / speed
            return factor * vx, factor * vy
        fx, fy = self._numbers()
        size = field.sqrt(fx**2 + fy**2)
        if self.keys.get("axes") == "link":
            sine, cosine = self.model.trigonometry(s.q, self.at[0])
            fx, fy = fx * cosine - fy * sine, fx * sine + fy * cosine
        along = (fx * vx + fy * vy) / size
        factor = self.share(along) * (self.curve.value(self.coordinate(s)) / size if self.curve else 1)
        return fx * factor, fy * factor

    def has_potential(self):
        return self.keyword == "force" and not self.curve and not self.sign and self.keys.get("axes", "global") == "global"

    def potential(self, s):
        if not self.has_potential():
            return self.zero
        (x, y), _ = self.where(s, self.at)
        fx, fy = self._numbers()
        return -fx * x - fy * y

    def is_moving(self):
        return bool(self.sign) or (self.keyword == "load" and ("damping" in self.keys or "resisting" in self.keys))


class Contact:
    """What pushes a depth back with a stiffness, a damping and a width within which it begins."""

    def __init__(self, stiffness, damping, width):
        self.stiffness, self.damping, self.width = stiffness, damping, width

    def ramp(self, depth):
        """By how much it is pressed: 0, width (x^3 - x^4/2) with x = depth/width, or depth - width/2."""
        if depth <= 0:
            return 0 * depth
        if depth > self.width:
            return depth - self.width / 2
        return depth**3 * (2 * self.width - depth) / (2 * self.width**3)

    def push(self, depth, rate=0):
        """The effort against the depth."""
        if depth <= 0:
            return 0 * depth
        part = min(depth / self.width, 1) if self.width else 1
        return self.stiffness * self.ramp(depth + self.damping / self.stiffness * rate * part**2 * (3 - 2 * part))

    def energy(self, depth):
        """The integral of the effort without damping: of a contact within the width, and of a straight line from there on."""
        if depth <= 0:
            return 0 * depth
        inner = min(depth, self.width)
        part = inner / self.width if self.width else 0 * depth
        begun = self.width**2 * part**4 * (5 - 2 * part) / 20
        return self.stiffness * (begun + (depth - inner) * (depth + inner - self.width) / 2)


class Along(Load):
    """What acts along a coordinate: SPRING, DAMPER and STOP cards have one, and a value of it from which they count."""

    def deflection(self, s):
        """The coordinate less that value; an angle in (-pi, pi], but with all turns if a drive counts it."""
        value = self.along.value(s) - self.rest
        return self.half_turn(value) if isinstance(self.along, Angle) and not self.along.drive else value

    def effects(self, s):
        return self.along.effects(s, self.effort(s))

    def default_width(self, stiffness, turns):
        """A hundredth of the depth that the weight of all would press; of an angle at the length of the longest link."""
        model = self.model
        gx, gy = model.gravity
        mass = sum((mass for body in model.bodies.values() for mass, *_ in body.particles), model.zero) \
            + sum(model.loads.values(), model.zero)
        length = max(model.field.sqrt(sum(x**2 for x in body.places[body.pins[1]])) for body in model.bodies.values() if body.name)
        return mass * model.field.sqrt(gx**2 + gy**2) / 100 / stiffness * (length if turns else 1)

    def read_contact(self, side, turns):
        """By the keys; it acts on one side of the value."""
        kind = "turning_" if turns else ""
        stiffness = self.value("stiffness", kind + "stiffness")
        width = self.value("contact", "angle" if turns else "length") if "contact" in self.keys else \
            self.default_width(stiffness, turns)
        self.side, self.contact = side, Contact(stiffness, self.value("damping", kind + "damping"), width)

    def pushes(self, s, is_still=False):
        """The effort of a contact along the coordinate."""
        rate = self.zero if is_still else self.side * self.along.rate(s)
        return -self.side * self.contact.push(self.side * self.deflection(s), rate)

    def touches(self, s):
        """Whether a contact does something."""
        return self.side * self.deflection(s) > 0

    def is_continuous(self, s):
        """Whether the effort does not jump nearby."""
        if isinstance(self.along, Angle):
            return self.along.drive is not None or abs(self.deflection(s)) < 2.9
        return self.along.is_fine(s)


class Spring(Along):
    """SPRING and DAMPER cards: a pull with x, the length of a line or an angle between links; or of one side only."""

    def __init__(self, model, keyword, words, keys):
        super().__init__(model, keyword, words, keys)
        self.along = of_spring(model, words)
        self.turns, self.contact = self.along.is_angle, None
        kind = "turning_" if self.turns else ""
        self.stiffness = self.value("stiffness", kind + "stiffness")
        self.damping = self.value("damping", kind + "damping")
        self.tension = self.value("torque" if self.turns else "force", "torque" if self.turns else "force")
        rest = "free_angle" if self.turns else "free_length"
        if keyword == "damper" or self.stiffness == 0:
            self.rest = self.zero
        elif rest in keys:
            self.rest, self.tension = self.value(rest, "angle" if self.turns else "length"), self.zero
        else:
            self.rest, self.tension = self._drawn() - self.tension / self.stiffness, self.zero
        if "only" in keys:
            self.read_contact(1 if keys["only"] == "pull" else -1, self.turns)
            self.rest += self.side * self.value("gap", "angle" if self.turns else "length")

    def _drawn(self):
        model = self.model
        if not self.turns:
            (x0, y0), (x1, y1) = (model.drawn[name] for name in self.words[1:3])
            return model.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
        angles = []
        for link in self.words[2:]:
            pins = model.bodies[link].pins
            start = next((k for k, pin in enumerate(pins) if pin in model.ground), 0)
            (x0, y0), (x1, y1) = model.drawn[pins[start]], model.drawn[pins[(start + 1) % len(pins)]]
            angles.append(model.field.arctan2(y1 - y0, x1 - x0) + self.turn(link))
        drawn = angles[-1] - (angles[0] if len(angles) > 1 else 0)
        return self._among_positions(drawn) if self.along.drive else drawn

    def _among_positions(self, angle):
        """The drawn angle of a drive with the turns that bring it among its positions, at first, or nearest to them."""
        field, model = self.model.field, self.model
        places = [model.drive_value(self.along.drive, field.number(place * model.deck.crank_factor()))
                  for place in model.deck.cranks or [model.deck.start]]
        turned = [angle + 2 * field.pi * turn for turn in range(-6, 7)]
        outside = [max(min(places) - place, place - max(places), self.zero) for place in turned]
        return turned[outside.index(min(outside))]

    def is_fine(self, s):
        if not self.turns and not (self.rest >= 0 and self.along.is_fine(s)):
            return False
        return self.stiffness == 0 or self.is_continuous(s)

    def effort(self, s):
        if self.contact:
            return self.pushes(s)
        return -(self.tension + self.stiffness * self.deflection(s) + self.damping * self.along.rate(s))

    def potential(self, s):
        if self.keyword == "damper":
            return self.zero
        x = self.deflection(s)
        return self.contact.energy(self.side * x) if self.contact else self.tension * x + self.stiffness * x**2 / 2

    def has_potential(self):
        return self.keyword == "spring" and not (self.contact and self.damping > 0)

    def lost(self, s):
        if self.contact:
            return self.along.effects(s, self.pushes(s) - self.pushes(s, is_still=True))
        return super().lost(s)

    def is_moving(self):
        return self.keyword == "damper"


class Stop(Along):
    """STOP cards: what pushes a coordinate back."""

    def __init__(self, model, keyword, words, keys):
        super().__init__(model, keyword, words, keys)
        self.along = coordinate(model, words[1])
        self.rest = self.value("limit", "angle" if self.along.is_angle else "length")
        self.read_contact(-1 if words[2:] else 1, self.along.is_angle)

    def is_fine(self, s):
        return self.is_continuous(s)

    def effort(self, s):
        return self.pushes(s)

    def potential(self, s):
        return self.contact.energy(self.side * self.deflection(s))

    def has_potential(self):
        return self.contact.damping == 0

    def lost(self, s):
        return self.along.effects(s, self.pushes(s) - self.pushes(s, is_still=True))


def loads_of(model):
    """All loads of the cards that have keys."""
    kinds = {"spring": Spring, "damper": Spring, "stop": Stop}
    return [kinds.get(keyword, Process)(model, keyword, words, keys) for keyword, words, keys in model.deck.applied]


class Rub(Load):
    """What rubs in a joint: a link on another one or on the ground, or a block on its line; told by the magnitudes of the forces
    that press (of a block with a fixed link one at each of its ends)."""

    def __init__(self, model, words, keys, slider=None, body=None, against=None):
        super().__init__(model, "friction", words, keys)
        self.pin, self.slider, self.body, self.against = words[0], slider, body, against
        kind = "" if slider else "turning_"
        self.coefficient, self.viscous = self.value("coefficient", "number"), self.value("viscous", kind + "damping")
        self.smooth = self.value("smooth", "rate" if slider else "speed", "1mm/s" if slider else "0.01rad/s")
        self.radius, self.length = self.value("radius", "length"), self.value("length", "length")

    def line(self, s):
        """Sine and cosine of the line of a block."""
        if self.slider["guide"] in self.model.guides:
            return self.model.guides[self.slider["guide"]][:1:-1]
        return self.model.trigonometry(s.q, self.model.bodies[self.slider["guide"]])

    def rate(self, s):
        if not self.slider:
            return s.v[self.body.angle] - (s.v[self.against.angle] if self.against else 0)
        sine, cosine = self.line(s)
        _, (vx, vy), _ = self.model.pin_motion(s, self.pin)
        if self.slider["guide"] not in self.model.guides:
            first = self.model.bodies[self.slider["guide"]].first
            vx, vy = vx - s.v[first], vy - s.v[first + 1]
        return vx * cosine + vy * sine

    def presses(self, s):
        """Sum of the magnitudes that press."""
        if not self.slider:
            fx, fy, _ = s.forces[self.pin, self.body.name]
            return self.model.field.sqrt(fx**2 + fy**2)
        across, moment = s.contacts[self.slider["pin"], self.slider["guide"]]
        if self.slider["link"] and self.length > 0:
            return abs(across / 2 + moment / self.length) + abs(across / 2 - moment / self.length)
        return abs(across)

    def effort(self, s, pressing):
        rate = self.rate(s)
        coulomb = self.coefficient * pressing * tanh(self.model.field, rate / self.smooth)
        return -(coulomb if self.slider else coulomb * self.radius) - self.viscous * rate

    def effects(self, s):
        effort = self.effort(s, s.pressing[self])
        if not self.slider:
            return [(self.body, effort)] + ([(self.against, -effort)] if self.against else [])
        sine, cosine = self.line(s)
        fx, fy = effort * cosine, effort * sine
        effects = [(("pin", self.pin), fx, fy)]
        if self.slider["guide"] not in self.model.guides:
            body = self.model.bodies[self.slider["guide"]]
            x, y, _ = self.model.pin_place(s.q, self.pin)
            along = (x - s.q[body.first]) * cosine + (y - s.q[body.first + 1]) * sine
            effects.append(((body, along, self.zero), -fx, -fy))
        return effects

    def add_to_joints(self, s):
        """The forces on links and pins of reactions.dat have friction along a line, and its couple in a pin."""
        effort = self.effort(s, s.pressing[self])
        if self.slider:
            sine, cosine = self.line(s)
            force = s.forces[self.pin, self.slider["guide"]]
            if self.slider["guide"] not in self.model.guides:
                effort = -effort
            force[0] += effort * cosine
            force[1] += effort * sine
            return
        s.forces[self.pin, self.body.name][2] += effort
        here = next((slider for slider in self.model.deck.sliders if slider["pin"] == self.pin), None)
        if self.against:
            s.forces[self.pin, self.against.name][2] -= effort
        elif here:
            s.forces[self.pin, here["guide"]][2] += effort

    def has_potential(self):
        return False


def frictions_of(model):
    """What rubs by the FRICTION cards."""
    found, deck = [], model.deck
    for words, keys in deck.frictions:
        pin, names = words[0], words[1:]
        here = [slider for slider in deck.sliders if slider["pin"] == pin]
        block = next((slider for slider in here if names and slider["guide"] == names[0]), None)
        if block:
            found.append(Rub(model, words, keys, slider=block))
            continue
        there = [body for body in model.holders(pin) if body.name]
        if pin in model.ground or here:
            bearer = None
            if here:
                bearer = model.bodies.get(here[0]["link"] or here[0]["guide"])
                there = [body for body in there if body is not bearer]
            turning = [body for body in there if not names or body.name == names[0]]
        else:
            bearer = model.bodies[names[1]] if len(names) > 1 else next(body for body in there[::-1] if body.name not in names)
            turning = [model.bodies[names[0]]] if names else [body for body in there if body is not bearer]
        found += [Rub(model, words, keys, body=body, against=bearer) for body in turning]
    return found
