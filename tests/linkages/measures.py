"""Coordinates with names, for the independent solver: of MEASURE cards, springs and dampers, links whose length is driven, and blocks.

A coordinate is told by value(s) and rate(s) in a state, and by effects(s, effort): forces at places and torques whose power is the effort
times the rate.  What acts along a line that turns with a link acts on the place of the link at the pin.
"""


class Places:
    """Where pins, points and links are in a state."""

    def __init__(self, model):
        self.model, self.zero = model, model.zero

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


class Coordinate(Places):
    """What all have: is_angle, the drive that gives the value, and what rounding cannot decide."""

    is_angle, drive = False, None

    def is_fine(self, s):
        """Whether value and rate are continuous there."""
        return True


class Distance(Coordinate):
    """Between two places."""

    def __init__(self, model, one, other):
        super().__init__(model)
        self.ends = self.place(one), self.place(other)

    def way(self, s):
        """From one to the other: its length, its direction, and the relative velocity."""
        (x0, y0), (vx0, vy0) = self.where(s, self.ends[0])
        (x1, y1), (vx1, vy1) = self.where(s, self.ends[1])
        length = self.model.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
        return length, ((x1 - x0) / length, (y1 - y0) / length), (vx1 - vx0, vy1 - vy0)

    def value(self, s):
        return self.way(s)[0]

    def rate(self, s):
        _, (ex, ey), (vx, vy) = self.way(s)
        return ex * vx + ey * vy

    def effects(self, s, effort):
        _, (ex, ey), _ = self.way(s)
        return [(self.ends[0], -effort * ex, -effort * ey), (self.ends[1], effort * ex, effort * ey)]

    def is_fine(self, s):
        return self.value(s) > 0.02 * self.model.size


class Angle(Coordinate):
    """Of a link, or what it is more than that of another one: in (-pi, pi], or as a drive counts it."""

    is_angle = True

    def __init__(self, model, link, against=None):
        super().__init__(model)
        self.link, self.against = link, against
        for number, drive in enumerate(model.deck.drives):
            words = drive["words"]
            other = words[1] if words and words[0].lower() == "against" else None
            if drive["name"] == link and other == against and len(words) != 1 and not (number and drive["free"]):
                self.drive = drive

    def value(self, s):
        if self.drive:
            return self.model.drive_value(self.drive, s.first)
        angle = self.angle(s, self.link)[0]
        return self.half_turn(angle - self.angle(s, self.against)[0]) if self.against else angle

    def rate(self, s):
        rate = self.angle(s, self.link)[1]
        return rate - self.angle(s, self.against)[1] if self.against else rate

    def effects(self, s, effort):
        bodies = self.model.bodies
        return [(bodies[self.link], effort)] + ([(bodies[self.against], -effort)] if self.against else [])

    def is_fine(self, s):
        return self.drive is not None or abs(self.value(s)) < 2.9


class Line(Coordinate):
    """The place of a pin along a guide or link, or across it to the left."""

    def __init__(self, model, pin, line, across=False):
        super().__init__(model)
        self.at, self.across = self.place(pin), across
        self.guide, self.body = model.guides.get(line), model.bodies.get(line)

    def axes(self, s):
        """The first point of the line with its velocity, and the direction in which the place counts."""
        if self.guide:
            x, y, cosine, sine = self.guide
            return (x, y), (-sine, cosine) if self.across else (cosine, sine)
        first = self.body.first
        sine, cosine = self.model.trigonometry(s.q, self.body)
        return (s.q[first], s.q[first + 1]), (-sine, cosine) if self.across else (cosine, sine)

    def beside(self, s):
        """The place of the link where the pin is."""
        (x, y), _ = self.where(s, self.at)
        sine, cosine = self.model.trigonometry(s.q, self.body)
        x, y = x - s.q[self.body.first], y - s.q[self.body.first + 1]
        return self.body, x * cosine + y * sine, y * cosine - x * sine

    def value(self, s):
        (x, y), _ = self.where(s, self.at)
        (x0, y0), (ex, ey) = self.axes(s)
        return (x - x0) * ex + (y - y0) * ey

    def rate(self, s):
        _, (vx, vy) = self.where(s, self.at)
        if not self.guide:
            _, (wx, wy) = self.where(s, self.beside(s))
            vx, vy = vx - wx, vy - wy
        ex, ey = self.axes(s)[1]
        return vx * ex + vy * ey

    def effects(self, s, effort):
        ex, ey = self.axes(s)[1]
        effects = [(self.at, effort * ex, effort * ey)]
        return effects if self.guide else effects + [(self.beside(s), -effort * ex, -effort * ey)]


class Travel(Coordinate):
    """The place of a pin in a direction."""

    def __init__(self, model, pin, dx, dy):
        super().__init__(model)
        number, at = model.field.number, self.place(pin)
        dx, dy = (number(model.deck.units.value(word, "number")) for word in (dx, dy))
        size = model.field.sqrt(dx**2 + dy**2)
        self.at, self.way = at, (dx / size, dy / size)

    def value(self, s):
        return sum(e * x for e, x in zip(self.way, self.where(s, self.at)[0]))

    def rate(self, s):
        return sum(e * v for e, v in zip(self.way, self.where(s, self.at)[1]))

    def effects(self, s, effort):
        return [(self.at, effort * self.way[0], effort * self.way[1])]


class Sum(Coordinate):
    """Of others, each times a number."""

    def __init__(self, model, words):
        super().__init__(model)
        number, value = model.field.number, model.deck.units.value
        self.terms = [(number(value(weight, "number")), coordinate(model, name)) for weight, name in zip(words[::2], words[1::2])]
        self.is_angle = self.terms[0][1].is_angle

    def value(self, s):
        return sum(weight * term.value(s) for weight, term in self.terms)

    def rate(self, s):
        return sum(weight * term.rate(s) for weight, term in self.terms)

    def effects(self, s, effort):
        return [effect for weight, term in self.terms for effect in term.effects(s, weight * effort)]

    def is_fine(self, s):
        return all(term.is_fine(s) for _, term in self.terms)


def of_spring(model, words):
    """Of a SPRING or DAMPER card: the distance of two places, or the angle of its last link less that of the one before."""
    if words[-1] in model.bodies and words[-1] != words[1]:
        return Angle(model, words[-1], words[-2] if len(words) > 3 else None)
    return Distance(model, *words[1:3])


def coordinate(model, name):
    """The coordinate of a name."""
    deck = model.deck
    if name in deck.measures:
        kind, *words = deck.measures[name]
        kind = kind.lower()
        if kind == "sum":
            return Sum(model, words)
        if kind == "angle":
            return Angle(model, words[0], words[2] if len(words) > 1 else None)
        if kind in ("along", "across"):
            return Line(model, *words, across=kind == "across")
        return {"distance": Distance, "travel": Travel}[kind](model, *words)
    for keyword, words, _ in deck.applied:
        if keyword in ("spring", "damper") and words[0] == name:
            return of_spring(model, words)
    for drive in deck.drives:
        if drive["name"] == name and [word.lower() for word in drive["words"]] == ["length"]:
            return Distance(model, *model.bodies[name].pins[:2])
    pin, _, line = name.partition(":")
    slider = next(slider for slider in deck.sliders if slider["pin"] == pin and line in ("", slider["guide"]))
    return Line(model, pin, slider["guide"])


def names(deck):
    """Of all coordinates, in the order of the program."""
    springs = [words[0] for keyword, words, _ in deck.applied if keyword in ("spring", "damper")]
    rams = [drive["name"] for drive in deck.drives if [word.lower() for word in drive["words"]] == ["length"]]
    pins = [slider["pin"] for slider in deck.sliders]
    sliders = [f"{slider['pin']}:{slider['guide']}" if pins.count(slider["pin"]) > 1 else slider["pin"] for slider in deck.sliders]
    return springs + rams + sliders + list(deck.measures)
