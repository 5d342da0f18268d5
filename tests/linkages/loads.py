"""Loads beside weights, constant forces on pins and constant torques, for the independent solver: FORCE and TORQUE cards with keys,
LOAD, SPRING, DAMPER and their tables.

Every load is an object with effects(s): what it puts on the linkage in a state, a list of (where, fx, fy) and (body, torque), and
potential(s).  A spring is told by its length or angle x and the gradient of x; a table by the slopes of its spline at the knots.
"""
import dense


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


class Load:
    """What all loads have: a name for messages, the model, and the places of points."""

    potential_of = None

    def __init__(self, model, keyword, words, keys):
        self.model, self.keyword, self.words, self.keys = model, keyword, words, keys
        self.zero = model.zero

    def value(self, key, quantity, default="0"):
        return self.model.field.number(self.model.deck.units.value(self.keys.get(key, default), quantity))

    def place(self, name):
        """("pin", name), or (body, along, offset) of a POINT that is no pin."""
        if name in self.model.deck.points and name not in self.model.pins_by_name:
            link, along, offset = self.model.deck.points[name]
            return self.model.bodies[link], self.model.field.number(along), self.model.field.number(offset)
        return "pin", name

    def where(self, s, place):
        """(x, y) and (vx, vy) of a place."""
        if place[0] == "pin":
            return self.model.pin_motion(s, place[1])[:2]
        return self.model.point_motion(s, *place)[0][:2]

    def angle(self, s, link):
        """In (-pi, pi], as tables have it, and its rate."""
        angle, rate, _ = self.model.link_motion(s, link)
        return self.half_turn(angle + self.turn(link)), rate

    def turn(self, link):
        """Of a four-bar the angle of the coupler is that from A to B, whatever its card says."""
        model = self.model
        if not model.is_four_bar():
            return model.zero
        a, b, _ = model.four_bar_pins()
        return model.field.pi if model.bodies[link].pins[:2] == [b, a] else model.zero

    def half_turn(self, angle):
        pi = self.model.field.pi
        turns = int(angle / (2 * pi))
        angle -= 2 * pi * turns
        if angle > pi:
            angle -= 2 * pi
        elif angle <= -pi:
            angle += 2 * pi
        return angle

    def potential(self, s):
        return self.zero

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
        else:
            self.over, angular = ("angle", name), True
        (unit_x, x), (unit_y, y) = deck.table(keys["table"])
        period = None
        if angular:
            turns = (x[-1] - x[0]) * (1 if unit_x == "deg" else 180 / field.number(field.pi)) / 360
            if round(float(turns)) > 0 and abs(float(turns) - round(float(turns))) < 1e-9:
                period = 2 * field.pi * round(float(turns))
        x = [field.number(deck.units.value(f"{value}{unit_x}", "number")) for value in x]
        y = [field.number(deck.units.value(f"{value}{unit_y}", "number")) for value in y]
        self.curve = Curve(field, x, y, period)

    def coordinate(self, s):
        """Of the table."""
        model, (kind, what) = self.model, self.over
        if kind == "drive":
            return s.first
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
        if self.curve is None or self.curve.period is not None:
            return True
        first, last = self.curve.ends()
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


class Spring(Load):
    """SPRING and DAMPER cards: a pull with x, the length of a line or an angle between links."""

    def __init__(self, model, keyword, words, keys):
        super().__init__(model, keyword, words, keys)
        self.turns = words[-1] in model.bodies and words[-1] != words[1]
        if self.turns:
            self.links = words[2:]
            self.on_crank = len(self.links) == 1 and self.links[0] == model.deck.drives[0]["name"] \
                and not model.deck.drives[0]["words"]
        else:
            self.places = [self.place(name) for name in words[1:3]]
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

    def _drawn(self):
        model = self.model
        if not self.turns:
            (x0, y0), (x1, y1) = (model.drawn[name] for name in self.words[1:3])
            return model.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
        angles = []
        for link in self.links:
            pins = model.bodies[link].pins
            start = next((k for k, pin in enumerate(pins) if pin in model.ground), 0)
            (x0, y0), (x1, y1) = model.drawn[pins[start]], model.drawn[pins[(start + 1) % len(pins)]]
            angles.append(model.field.arctan2(y1 - y0, x1 - x0) + self.turn(link))
        if self.on_crank:
            return self._among_positions(angles[0])
        return angles[-1] - (angles[0] if len(angles) > 1 else 0)

    def _among_positions(self, angle):
        """The drawn angle of a crank with the turns that bring it among the positions, at first, or nearest to them."""
        field, deck = self.model.field, self.model.deck
        places = [field.number(place) * field.pi / 180 for place in deck.cranks or [deck.start]]
        turned = [angle + 2 * field.pi * turn for turn in range(-6, 7)]
        outside = [max(min(places) - place, place - max(places), self.zero) for place in turned]
        return turned[outside.index(min(outside))]

    def stretch(self, s):
        """x less its value without load, and the rate of x."""
        if not self.turns:
            (x0, y0), (vx0, vy0) = self.where(s, self.places[0])
            (x1, y1), (vx1, vy1) = self.where(s, self.places[1])
            square = (x1 - x0)**2 + (y1 - y0)**2
            length = self.model.field.sqrt(square)
            return length - self.rest, ((x1 - x0) * (vx1 - vx0) + (y1 - y0) * (vy1 - vy0)) / length
        angle, rate = self.angle(s, self.links[-1])
        if self.on_crank:
            return s.first - self.rest, rate
        if len(self.links) > 1:
            first, first_rate = self.angle(s, self.links[0])
            angle, rate = angle - first, rate - first_rate
        return self.half_turn(angle - self.rest), rate

    def is_fine(self, s):
        if not self.turns:
            return self.rest >= 0 and self.stretch(s)[0] + self.rest > 0.02 * self.model.size
        return self.stiffness == 0 or self.on_crank or abs(self.stretch(s)[0]) < 2.9

    def pull(self, s):
        stretch, rate = self.stretch(s)
        return self.tension + self.stiffness * stretch + self.damping * rate

    def effects(self, s):
        pull = self.pull(s)
        if self.turns:
            bodies = [self.model.bodies[link] for link in self.links]
            return [(bodies[-1], -pull)] + ([(bodies[0], pull)] if len(bodies) > 1 else [])
        (x0, y0), _ = self.where(s, self.places[0])
        (x1, y1), _ = self.where(s, self.places[1])
        length = self.model.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
        fx, fy = pull * (x1 - x0) / length, pull * (y1 - y0) / length
        return [(self.places[0], fx, fy), (self.places[1], -fx, -fy)]

    def potential(self, s):
        if self.keyword == "damper":
            return self.zero
        stretch, _ = self.stretch(s)
        return self.tension * stretch + self.stiffness * stretch**2 / 2

    def has_potential(self):
        return self.keyword == "spring"

    def is_moving(self):
        return self.keyword == "damper"


def loads_of(model):
    """All loads of the cards that have keys."""
    return [(Spring if keyword in ("spring", "damper") else Process)(model, keyword, words, keys)
            for keyword, words, keys in model.deck.applied]


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
