"""An independent model of planar linkages: absolute coordinates of every link, Newton on all equations together.

Unknowns are x, y and the angle of each link (at its first pin, in the direction of its second), the length of a ram, and x, y of
pins that no link has.  Rows are: coincidence of pins, a pin on a fixed guide, a pin on the line of a link, equal turning of two
links (welds, blocks that do not turn), and the drives.  Velocities, accelerations and the multipliers (all forces) are solved from
the same square Jacobian.  Numbers are of a field (fields.py), so that all of it can be repeated with 40 digits.
"""
import math
import random

import dense
from fields import Digits, Doubles
from loads import frictions_of, loads_of
from measures import coordinate


class Failure(Exception):
    """The linkage does not assemble, or has a dead point."""


class Body:
    """A link, or a pin without any (angle None); places are (along, offset) from its first pin."""

    def __init__(self, name, first, turns):
        self.name, self.first, self.places, self.pins = name, first, {}, []
        self.angle = first + 2 if turns else None
        self.ram = None                         # the unknown length
        self.far = None                         # the pin at the end of the ram
        self.particles = []                     # (mass, along, offset, inertia)


class State:
    """Unknowns and their rates at a position, with all forces."""


class Model:
    """A linkage of a deck (decks.Deck) in the numbers of a field."""

    def __init__(self, deck, field=Doubles):
        self.deck, self.field = deck, field
        self._angles = {}                       # sines and cosines computed last
        number = field.number
        self.ground = {pin: tuple(map(number, place)) for pin, place in deck.grounds.items()}
        self.drawn = {pin: tuple(map(number, place)) for pin, place in deck.pins.items()}
        self.drawn.update(self.ground)
        self.gravity = tuple(map(number, deck.gravity))
        self.guides = {}
        for name, (x, y, angle) in deck.guides.items():
            self.guides[name] = (number(x), number(y), field.cos(number(angle)), field.sin(number(angle)))
        self.bodies, self.count = {}, 0
        for name, (link, along, offset) in deck.points.items():
            self._draw_point(name, link, number(along), number(offset))
        rams = {drive["name"] for drive in deck.drives if [word.lower() for word in drive["words"]] == ["length"]}
        for name, card in deck.links.items():
            self._add_link(name, card, name in rams)
        for name, (link, along, offset) in deck.points.items():
            self.bodies[link].places[name] = (number(along), number(offset))
        for link, mass, at, offset, inertia in deck.masses:
            self.bodies[link].particles.append(tuple(map(number, (mass, at, offset, inertia))))
        for slider in deck.sliders:
            if slider["pin"] not in self.ground and not self.holders(slider["pin"]):
                body = Body(None, self.count, False)
                body.pins, body.places = [slider["pin"]], {slider["pin"]: (number(0), number(0))}
                self.bodies["pin " + slider["pin"]] = body
                self.count += 2
        self.loads = {}                         # masses that move with pins
        for pin, mass in deck.pin_masses + [(slider["pin"], slider["mass"]) for slider in deck.sliders]:
            self.loads[pin] = self.loads.get(pin, number(0)) + number(mass)
        self.forces = {pin: tuple(map(number, force)) for pin, force in deck.forces.items()}
        self.torques = {link: number(torque) for link, torque in deck.torques.items()}
        self._add_rows()
        self._find_size()
        self.pins_by_name = self._named_pins()
        self.applied = loads_of(self)
        self.rubs = frictions_of(self)
        self.actuators = [coordinate(self, name) for name in deck.actuated]

    # construction

    def _named_pins(self):
        """Pins, and POINTs that other cards take for pins."""
        deck = self.deck
        names = {pin for card in deck.links.values() for pin in card["pins"]} | set(deck.pins) | set(deck.grounds)
        names |= {slider["pin"] for slider in deck.sliders} | {pin for pin, _ in deck.welds + deck.pin_masses}
        names |= set(deck.forces) | {words[0] for keyword, words, keys in deck.applied if keyword == "force" and "at" not in keys}
        return names

    def _add_link(self, name, card, is_ram):
        body = Body(name, self.count, True)
        self.count += 3
        pins = card["pins"]
        closed = len(pins) > 2 and pins[0] == pins[-1]
        body.pins = pins[:-1] if closed else pins
        body.places = self._shape(card, body.pins, closed)
        if is_ram:
            body.ram, body.far = self.count, body.pins[1]
            self.count += 1
        self.bodies[name] = body
        self._add_mass(body, card, closed)

    def _draw_point(self, name, link, along, offset):
        """A POINT is where the drawing of its link puts it."""
        ends = self.deck.links[link]["pins"][:2]
        if name not in self.drawn and all(pin in self.drawn for pin in ends):
            (x0, y0), (x1, y1) = (self.drawn[pin] for pin in ends)
            length = self.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
            cosine, sine = (x1 - x0) / length, (y1 - y0) / length
            self.drawn[name] = (x0 + along * cosine - offset * sine, y0 + along * sine + offset * cosine)

    def _shape(self, card, pins, closed):
        """Places of the pins of a link from its lengths and turns, or from the drawing."""
        field, number = self.field, self.field.number
        zero = number(0)
        if "lengths" not in card:
            (x0, y0), (x1, y1) = self.drawn[pins[0]], self.drawn[pins[1]]
            length = field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
            cosine, sine = (x1 - x0) / length, (y1 - y0) / length
            places = {}
            for pin in pins:
                x, y = self.drawn[pin][0] - x0, self.drawn[pin][1] - y0
                places[pin] = (x * cosine + y * sine, y * cosine - x * sine)
            places[pins[1]] = (length, zero)
            return places
        lengths = [number(length) for length in card["lengths"]]
        if closed and "turns" not in card:
            if len(lengths) != 3:
                raise ValueError("a closed frame of more than three sides needs turns=")
            base, right, left = lengths
            along = (base**2 + left**2 - right**2) / (2 * base)
            offset = field.sqrt(left**2 - along**2)
            (ax, ay), (bx, by), (cx, cy) = (self.drawn[pin] for pin in pins)
            if (bx - ax) * (cy - ay) < (by - ay) * (cx - ax):
                offset = -offset
            return {pins[0]: (zero, zero), pins[1]: (base, zero), pins[2]: (along, offset)}
        turns = [zero] + [number(turn) for turn in card.get("turns", ())]
        x, y, direction, places = zero, zero, zero, {pins[0]: (zero, zero)}
        for pin, length, turn in zip(pins[1:], lengths, turns):
            direction += turn
            x, y = x + length * field.cos(direction), y + length * field.sin(direction)
            places[pin] = (x, y)
        return places

    def _add_mass(self, body, card, closed):
        """Mass, centre and inertia: of uniform segments, each replaced by what the card says."""
        number, zero = self.field.number, self.field.number(0)
        route = [body.places[pin] for pin in body.pins] + ([body.places[body.pins[0]]] if closed else [])
        line = number(self.deck.materials[card["material"]] * self.deck.sections[card["section"]]) if "material" in card else zero
        parts = []
        for (x0, y0), (x1, y1) in zip(route, route[1:]):
            length = self.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
            parts.append((line * length, (x0 + x1) / 2, (y0 + y1) / 2, line * length**3 / 12, length))
        mass, total = sum(part[0] for part in parts), sum(part[4] for part in parts)
        x, y = (sum(part[4] * part[k] for part in parts) / total for k in (1, 2))
        inertia = sum(part[3] + part[0] * ((part[1] - x)**2 + (part[2] - y)**2) for part in parts)
        if "center" in card:
            x, y = map(number, card["center"])
        body.particles.append((number(card["mass"]) if "mass" in card else mass, x, y,
                               number(card["inertia"]) if "inertia" in card else inertia))

    def holders(self, pin):
        """Bodies with a pin."""
        return [body for body in self.bodies.values() if pin in body.places]

    def _drawn_angle(self, body):
        (x0, y0), (x1, y1) = self.drawn[body.pins[0]], self.drawn[body.pins[1]]
        return self.field.arctan2(y1 - y0, x1 - x0)

    def angle_offset(self, body):
        """What is added to the unknown for the angle of the tables: from the ground pivot, else the first pin, to the next one."""
        pins = body.pins
        start = next((k for k, pin in enumerate(pins) if pin in self.ground), 0)
        (x0, y0), (x1, y1) = body.places[pins[start]], body.places[pins[(start + 1) % len(pins)]]
        return self.field.arctan2(y1 - y0, x1 - x0)

    def _add_rows(self):
        rows, number = [], self.field.number
        self.moving_pins = []
        for body in self.bodies.values():
            for pin in body.places:
                if pin not in self.moving_pins and pin not in self.ground:
                    self.moving_pins.append(pin)
        for pin in self.ground:
            rows += [("pin", pin, body, None) for body in self.holders(pin)]
        for pin in self.moving_pins:
            first, *others = self.holders(pin)
            rows += [("pin", pin, first, body) for body in others]
        for slider in self.deck.sliders:
            guide = slider["guide"]
            rows.append(("guide" if guide in self.guides else "line", slider))
            if slider["link"]:
                body, other = self.bodies[slider["link"]], self.bodies.get(guide) if guide not in self.guides else None
                rows.append(("turn", body, other, self._drawn_angle(body) - (self._drawn_angle(other) if other else 0), slider))
        for pin, links in self.deck.welds:
            first, *others = (self.bodies[link] for link in links)
            rows += [("turn", first, body, self._drawn_angle(first) - self._drawn_angle(body), pin) for body in others]
        for drive in self.deck.drives:
            words = [word.lower() for word in drive["words"]]
            if not words:
                kind, data = "angle", (self.bodies[drive["name"]], None)
            elif words[0] == "against":
                kind, data = "angle", (self.bodies[drive["name"]], self.bodies[drive["words"][1]])
            elif words[0] == "length":
                kind, data = "ram", (self.bodies[drive["name"]], None)
            else:
                kind, data = "place", (drive["words"][0], None)
            rows.append(("drive", drive, kind, data))
        self.rows = rows
        self._compare_counts(sum(2 if row[0] == "pin" else 1 for row in rows))
        self.offsets = {name: self.angle_offset(body) for name, body in self.bodies.items() if body.name}
        self.zero = number(0)

    def _compare_counts(self, equations):
        """Nothing here is redundant."""
        if equations != self.count:
            raise Failure(f"{self.count} unknowns and {equations} equations")

    def _find_size(self):
        """The largest distance between pins of a link."""
        self.size = max(abs(float(value)) for body in self.bodies.values() for place in body.places.values() for value in place)

    # positions of points

    def locate(self, q, body, along, offset, is_far=False):
        """x, y, and the gradients of both: a list of (unknown, by x, by y)."""
        first = body.first
        if body.angle is None:
            return q[first], q[first + 1], [(first, 1, 0), (first + 1, 0, 1)]
        sine, cosine = self.trigonometry(q, body)
        if is_far:
            along = q[body.ram]
        x, y = along * cosine - offset * sine, along * sine + offset * cosine
        gradients = [(first, 1, 0), (first + 1, 0, 1), (body.angle, -y, x)]
        if is_far:
            gradients.append((body.ram, cosine, sine))
        return q[first] + x, q[first + 1] + y, gradients

    def trigonometry(self, q, body):
        angle = q[body.angle]
        known = self._angles.get(body.angle)
        if known is None or known[0] != angle:
            known = self._angles[body.angle] = (angle, self.field.sin(angle), self.field.cos(angle))
        return known[1:]

    def pin_place(self, q, pin, body=None):
        """Of the pin on a body, by default the first that has it."""
        if pin in self.ground:
            if body is None:
                return self.ground[pin] + ([],)
        body = body or self.holders(pin)[0]
        return self.locate(q, body, *body.places[pin], pin == body.far)

    def point_quadratic(self, q, v, body, along, offset, is_far=False):
        """The part of an acceleration that has no accelerations of unknowns."""
        if body is None or body.angle is None:
            return self.zero, self.zero
        sine, cosine = self.trigonometry(q, body)
        rate = v[body.angle]
        if is_far:
            along = q[body.ram]
        x, y = -rate**2 * (along * cosine - offset * sine), -rate**2 * (along * sine + offset * cosine)
        if is_far:
            x, y = x - 2 * rate * v[body.ram] * sine, y + 2 * rate * v[body.ram] * cosine
        return x, y

    def pin_quadratic(self, q, v, pin, body=None):
        if body is None and pin in self.ground:
            return self.zero, self.zero
        body = body or self.holders(pin)[0]
        return self.point_quadratic(q, v, body, *body.places[pin], pin == body.far)

    # equations

    def drive_value(self, drive, first):
        """Position of a drive for a position of the first one."""
        number = self.field.number
        if "at" in drive:
            return number(drive["at"])
        return first * number(drive.get("ratio", 1)) + number(drive.get("phase", 0))

    def drive_ratio(self, drive):
        return self.field.number(0 if "at" in drive else drive.get("ratio", 1))

    def equations(self, q, first, need_jacobian=True):
        """Residuals and rows of the Jacobian, with the first drive at a position."""
        residuals, jacobian = [], []

        def add(residual, *gradients):
            row = [self.zero] * self.count
            for unknown, value in gradients:
                row[unknown] += value
            residuals.append(residual)
            jacobian.append(row)

        for row in self.rows:
            if row[0] == "pin":
                _, pin, one, other = row
                x, y, gradients = self.pin_place(q, pin, one)
                x0, y0, gradients0 = self.pin_place(q, pin, other)
                add(x - x0, *[(k, gx) for k, gx, _ in gradients], *[(k, -gx) for k, gx, _ in gradients0])
                add(y - y0, *[(k, gy) for k, _, gy in gradients], *[(k, -gy) for k, _, gy in gradients0])
            elif row[0] == "guide":
                slider = row[1]
                x, y, gradients = self.pin_place(q, slider["pin"])
                x0, y0, cosine, sine = self.guides[slider["guide"]]
                add((y - y0) * cosine - (x - x0) * sine, *[(k, gy * cosine - gx * sine) for k, gx, gy in gradients])
            elif row[0] == "line":
                slider = row[1]
                body = self.bodies[slider["guide"]]
                sine, cosine = self.trigonometry(q, body)
                x, y, gradients = self.pin_place(q, slider["pin"])
                x, y = x - q[body.first], y - q[body.first + 1]
                add(y * cosine - x * sine, *[(k, gy * cosine - gx * sine) for k, gx, gy in gradients],
                    (body.first, sine), (body.first + 1, -cosine), (body.angle, -(x * cosine + y * sine)))
            elif row[0] == "turn":
                _, one, other, angle, _ = row
                if other:
                    add(self._reduced(q[one.angle] - q[other.angle] - angle), (one.angle, 1), (other.angle, -1))
                else:
                    add(self._reduced(q[one.angle] - angle), (one.angle, 1))
            else:
                add(*self._drive_row(q, row, first))
        return residuals, jacobian

    def drive_place(self, q, row):
        """Position of a drive, and its gradient."""
        _, drive, kind, (one, other) = row
        if kind == "angle":
            value, gradient = q[one.angle] + self.offsets[one.name], [(one.angle, 1)]
            if other:
                value, gradient = value - q[other.angle] - self.offsets[other.name], gradient + [(other.angle, -1)]
            return value, gradient
        if kind == "ram":
            return q[one.ram], [(one.ram, 1)]
        x, y, gradients = self.pin_place(q, drive["name"])
        x0, y0, cosine, sine = self.guides[one]
        return (x - x0) * cosine + (y - y0) * sine, [(k, gx * cosine + gy * sine) for k, gx, gy in gradients]

    def _drive_row(self, q, row, first):
        value, gradient = self.drive_place(q, row)
        difference = value - self.drive_value(row[1], first)
        return [self._reduced(difference) if row[2] == "angle" else difference] + gradient

    def _reduced(self, angle):
        """Without whole turns."""
        turns = round(float(angle) / (2 * math.pi))
        return angle - turns * 2 * self.field.pi if turns else angle

    def quadratic(self, q, v):
        """The part of the second derivatives of the residuals without accelerations of unknowns (drives standing)."""
        result = []
        for row in self.rows:
            if row[0] == "pin":
                one, other = (self.pin_quadratic(q, v, row[1], body) for body in row[2:])
                result += [one[0] - other[0], one[1] - other[1]]
            elif row[0] == "guide":
                _, _, cosine, sine = self.guides[row[1]["guide"]]
                x, y = self.pin_quadratic(q, v, row[1]["pin"])
                result.append(y * cosine - x * sine)
            elif row[0] == "line":
                pin, body = row[1]["pin"], self.bodies[row[1]["guide"]]
                sine, cosine = self.trigonometry(q, body)
                rate = v[body.angle]
                x, y = self.pin_quadratic(q, v, pin)
                px, py, gradients = self.pin_place(q, pin)
                px, py = px - q[body.first], py - q[body.first + 1]
                vx = sum(gx * v[k] for k, gx, _ in gradients) - v[body.first]
                vy = sum(gy * v[k] for k, _, gy in gradients) - v[body.first + 1]
                result.append(y * cosine - x * sine - 2 * rate * (vx * cosine + vy * sine) - rate**2 * (py * cosine - px * sine))
            elif row[0] == "drive" and row[2] == "place":
                _, _, cosine, sine = self.guides[row[3][0]]
                x, y = self.pin_quadratic(q, v, row[1]["name"])
                result.append(x * cosine + y * sine)
            else:
                result.append(self.zero)
        return result

    def drive_rates(self, rate):
        """The right side for velocities (or of accelerations): what the drives add."""
        result = []
        for row in self.rows:
            result += [self.zero] * 2 if row[0] == "pin" else \
                      [self.drive_ratio(row[1]) * rate if row[0] == "drive" else self.zero]
        return result

    # solution

    def newton(self, q, first, most=30):
        """Unknowns near a guess; the linkage has to contract to rounding."""
        q, last, small = list(q), None, float(self.field.epsilon) * 64
        weights = self._weights()
        for _ in range(most):
            residuals, jacobian = self.equations(q, first)
            try:
                step = dense.solve(dense.factor(jacobian), [-residual for residual in residuals])
            except (dense.Singular, ZeroDivisionError):
                raise Failure("singular") from None
            q = [value + change for value, change in zip(q, step)]
            largest = max(abs(float(change)) / weight for change, weight in zip(step, weights))
            if largest > 1e6:
                raise Failure("far away")
            if largest < small or (last is not None and largest < small * 1e4 and largest >= last / 2):
                return q
            last = largest
        raise Failure("Newton does not converge")

    def _weights(self):
        """Sizes of unknowns: lengths, and radians."""
        weights = [self.size] * self.count
        for body in self.bodies.values():
            if body.angle is not None:
                weights[body.angle] = 1.0
        return weights

    def condition(self, q):
        """Of the Jacobian with lengths in units of the size."""
        _, jacobian = self.equations(q, self.zero)
        weights = self._weights()
        scales = []
        for row in self.rows:
            angular = row[0] == "turn" or (row[0] == "drive" and row[2] == "angle")
            scales += [self.size] * 2 if row[0] == "pin" else [1.0 if angular else self.size]
        return dense.condition([[float(value) * weight / scale for value, weight in zip(row, weights)]
                                for row, scale in zip(jacobian, scales)])

    def velocities(self, q, rate, factors=None):
        factors = factors or dense.factor(self.equations(q, self.zero)[1])
        return dense.solve(factors, self.drive_rates(rate))

    def accelerations(self, q, v, second, factors=None):
        factors = factors or dense.factor(self.equations(q, self.zero)[1])
        return dense.solve(factors, [drive - term for drive, term in zip(self.drive_rates(second), self.quadratic(q, v))])

    def step(self, q, start, end):
        """Unknowns at a near position, predicted by a quadratic; the correction has to be small against the step."""
        factors = dense.factor(self.equations(q, start)[1])
        one = self.field.number(1)
        v = self.velocities(q, one, factors)
        a = self.accelerations(q, v, self.zero, factors)
        h = end - start
        guess = [q[i] + h * v[i] + h * h / 2 * a[i] for i in range(self.count)]
        try:
            result = self.newton(guess, end, 8)
        except Failure:
            result = None
        if result:
            weights = self._weights()
            moved = max(abs(result[i] - q[i]) / weights[i] for i in range(self.count))
            corrected = max(abs(result[i] - guess[i]) / weights[i] for i in range(self.count))
            if corrected <= 0.1 * moved + 1e-12 and moved <= 0.2:
                return result
        if abs(h) < 1e-9 * (1 + abs(start)):
            raise Failure("dead point")
        middle = start + h / 2
        return self.step(self.step(q, start, middle), middle, end)

    def longest_step(self):
        """A quarter of a degree, or as much of the size."""
        quarter = self.field.pi / 720
        return quarter * self.size if self.deck.drives[0]["linear"] else quarter

    def follow(self, q, start, end):
        """Along the motion in steps of at most a quarter of a degree."""
        count = max(1, int(abs(end - start) / self.longest_step() + 0.999))
        for k in range(count):
            q = self.step(q, start + (end - start) * k / count, start + (end - start) * (k + 1) / count)
        return q

    def drawing(self, generator=None):
        """Unknowns of the drawing; pins that are not drawn are put anywhere by a generator."""
        drawn = dict(self.drawn)
        for body in self.bodies.values():
            for pin in body.places:
                if pin not in drawn:
                    if generator is None:
                        raise Failure(f"pin {pin} is not drawn")
                    near = list(self.ground.values()) or [(0.0, 0.0)]
                    x, y = near[generator.randrange(len(near))]
                    drawn[pin] = (x + generator.uniform(-1.5, 1.5) * self.size, y + generator.uniform(-1.5, 1.5) * self.size)
        q = [self.zero] * self.count
        for body in self.bodies.values():
            q[body.first], q[body.first + 1] = drawn[body.pins[0]]
            if body.angle is not None:
                (x0, y0), (x1, y1) = drawn[body.pins[0]], drawn[body.pins[1]]
                q[body.angle] = self.field.arctan2(y1 - y0, x1 - x0)
                if body.ram is not None:
                    q[body.ram] = self.field.sqrt((x1 - x0)**2 + (y1 - y0)**2)
        return q

    def is_drawn(self):
        return all(pin in self.drawn for body in self.bodies.values() for pin in body.pins)

    def assemble(self):
        """The linkage at the first position of the deck, on the branch of its drawing or of its BRANCH cards."""
        crank = self.field.number(self.deck.cranks[0] * self.deck.crank_factor())
        if self.is_drawn():
            q = self.drawing()
            row = next(row for row in self.rows if row[0] == "drive")
            start = self.drive_place(q, row)[0]
            if not self.deck.drives[0]["linear"]:
                turn = 2 * self.field.pi
                start += turn * round(float((crank - start) / turn))
            return self.follow(self.newton(q, start), start, crank)
        generator, found = random.Random(1), []
        for _ in range(400):
            try:
                q = self.newton(self.drawing(generator), crank)
            except Failure:
                continue
            if self.is_on_branch(q):
                found.append((sum((self.pin_place(q, pin)[k] - self.drawn[pin][k])**2
                                  for pin in self.deck.pins for k in (0, 1) if self.holders(pin)), q))
                if not self.deck.pins or len(found) > 40:
                    break
        if not found:
            raise Failure("no assembly on this branch")
        return min(found, key=lambda item: item[0])[1]

    def is_on_branch(self, q):
        """Whether an assembly is as the BRANCH cards say."""
        def place(pin):
            return self.pin_place(q, pin)[:2]

        for words in self.deck.branches or ([["open"]] if self.is_four_bar() else []):
            if len(words) == 1:
                joint = self.four_bar_pins()
                words = [joint[1], "left" if words[0] == "open" else "right", joint[0], joint[2]]
            pin, side = words[:2]
            x, y = place(pin)
            if side in ("left", "right"):
                (ax, ay), (bx, by) = place(words[2]), place(words[3])
                if ((bx - ax) * (y - ay) > (by - ay) * (x - ax)) != (side == "left"):
                    return False
            else:
                guide = next(slider["guide"] for slider in self.deck.sliders if slider["pin"] == pin)
                _, _, cosine, sine = self.guides[guide]
                body = self.holders(pin)[0]
                ax, ay = place(next(other for other in body.pins if other != pin))
                if ((x - ax) * cosine + (y - ay) * sine > 0) != (side == "forward"):
                    return False
        return True

    def is_four_bar(self):
        return len(self.deck.links) == 3 and not self.deck.sliders and len(self.ground) == 2

    def four_bar_pins(self):
        """A, B and the follower's ground pivot."""
        crank = self.deck.drives[0]["name"]
        a = next(pin for pin in self.bodies[crank].pins if pin not in self.ground)
        follower = next(body for name, body in self.bodies.items()
                        if name != crank and any(pin in self.ground for pin in body.pins))
        b = next(pin for pin in follower.pins if pin not in self.ground)
        return a, b, next(pin for pin in follower.pins if pin in self.ground)

    # motion and forces

    def state(self, q, first, rate, second):
        """All of the motion at an assembled position."""
        s = State()
        s.q, s.first, s.rate, s.second = q, first, rate, second
        s.jacobian = self.equations(q, first)[1]
        s.factors = dense.factor(s.jacobian)
        s.v = self.velocities(q, rate, s.factors)
        s.a = self.accelerations(q, s.v, second, s.factors)
        return s

    def pin_motion(self, s, pin, body=None):
        """(x, y), (vx, vy), (ax, ay) of a pin."""
        x, y, gradients = self.pin_place(s.q, pin, body)
        return self._motion(s, x, y, gradients, self.pin_quadratic(s.q, s.v, pin, body))

    def _motion(self, s, x, y, gradients, quadratic):
        velocity = [sum((g[k] * s.v[g[0]] for g in gradients), self.zero) for k in (1, 2)]
        acceleration = [sum((g[k] * s.a[g[0]] for g in gradients), quadratic[k - 1]) for k in (1, 2)]
        return (x, y), tuple(velocity), tuple(acceleration)

    def point_motion(self, s, body, along, offset):
        x, y, gradients = self.locate(s.q, body, along, offset)
        return self._motion(s, x, y, gradients, self.point_quadratic(s.q, s.v, body, along, offset)), gradients

    def link_motion(self, s, name):
        """Angle, angular velocity and acceleration as tables have them (the angle in radians, not reduced)."""
        k = self.bodies[name].angle
        return s.q[k] + self.offsets[name], s.v[k], s.a[k]

    def add_forces(self, s):
        """Multipliers, forces on links at pins and guides, and forces of the drives."""
        loads = [self.zero] * self.count
        gx, gy = self.gravity
        for body in self.bodies.values():
            for mass, along, offset, inertia in body.particles:
                if mass == 0 and inertia == 0:
                    continue
                (_, _, (ax, ay)), gradients = self.point_motion(s, body, along, offset)
                for k, px, py in gradients:
                    loads[k] += mass * ((gx - ax) * px + (gy - ay) * py)
                loads[body.angle] -= inertia * s.a[body.angle]
        pin_loads = {}
        for pin in self.moving_pins:
            _, _, (ax, ay) = self.pin_motion(s, pin)
            mass, (fx, fy) = self.loads.get(pin, self.zero), self.forces.get(pin, (self.zero, self.zero))
            pin_loads[pin] = [fx + mass * (gx - ax), fy + mass * (gy - ay)]
        for load in self.applied:
            self._apply(s, load.effects(s), loads, pin_loads)
        for link, torque in self.torques.items():
            loads[self.bodies[link].angle] += torque
        for slider in self.deck.sliders:
            if slider["inertia"]:
                k = self.bodies[slider["guide"]].angle
                loads[k] -= self.field.number(slider["inertia"]) * s.a[k]
        self._balance(s, loads, pin_loads)
        if self.rubs:
            self._rub(s, loads, pin_loads)

    def _balance(self, s, loads, pin_loads):
        """Multipliers that balance loads, and the forces in the joints."""
        for pin, (fx, fy) in pin_loads.items():
            for k, px, py in self.pin_place(s.q, pin)[2]:
                loads[k] += fx * px + fy * py
        s.multipliers = dense.solve_transposed(s.factors, [-load for load in loads])
        s.loads = loads
        if self.actuators:
            pin_loads = self._actuate(s, loads, pin_loads)
        self._share_forces(s, pin_loads)
        if self.actuators:
            s.drives = s.efforts

    def pushed(self, s, along):
        """The generalised force of an effort of 1 along a coordinate: its gradient."""
        row, pins = [self.zero] * self.count, {pin: [self.zero, self.zero] for pin in self.moving_pins}
        self._apply(s, along.effects(s, self.field.number(1)), row, pins)
        for pin, (fx, fy) in pins.items():
            for k, px, py in self.pin_place(s.q, pin)[2]:
                row[k] += fx * px + fy * py
        return row

    def _actuate(self, s, loads, pin_loads):
        """Multipliers with the gradients of the actuated coordinates in the rows of the drives; loads on pins with the efforts."""
        matrix, places, place = list(s.jacobian), [], 0
        for row in self.rows:
            if row[0] == "drive":
                places.append(place)
            place += 2 if row[0] == "pin" else 1
        for place, along in zip(places, self.actuators):
            matrix[place] = self.pushed(s, along)
        s.multipliers = dense.solve_transposed(dense.factor(matrix), [-load for load in loads])
        s.efforts = [s.multipliers[place] for place in places]
        pins = {pin: list(force) for pin, force in pin_loads.items()}
        for place, along, effort in zip(places, self.actuators, s.efforts):
            s.multipliers[place] = self.zero
            self._apply(s, along.effects(s, effort), [self.zero] * self.count, pins)
        return pins

    def _rub(self, s, loads, pin_loads):
        """Friction by what presses in the joints, again and again."""
        inertia = [load - sum((fx * px + fy * py for pin, (fx, fy) in pin_loads.items()
                               for k, px, py in self.pin_place(s.q, pin)[2] if k == number), self.zero)
                   for number, load in enumerate(loads)]
        s.pressing = {rub: rub.presses(s) for rub in self.rubs}
        small = self.field.number("1e-10" if self.field is Doubles else "1e-30")
        for _ in range(2000):
            here, pins = list(inertia), {pin: list(force) for pin, force in pin_loads.items()}
            for rub in self.rubs:
                self._apply(s, rub.effects(s), here, pins)
            self._balance(s, here, pins)
            after = {rub: rub.presses(s) for rub in self.rubs}
            change = max(abs(after[rub] - s.pressing[rub]) for rub in self.rubs)
            s.pressing = after
            if change <= small * max(after.values()):
                for rub in self.rubs:
                    rub.add_to_joints(s)
                return
        raise Failure("friction does not settle")

    def _apply(self, s, effects, loads, pin_loads):
        """Adds forces at places, and torques."""
        for effect in effects:
            if len(effect) == 2:
                body, torque = effect
                loads[body.angle] += torque
                continue
            place, fx, fy = effect
            if place[0] == "pin":
                if place[1] in pin_loads:
                    pin_loads[place[1]][0] += fx
                    pin_loads[place[1]][1] += fy
                continue
            for k, px, py in self.locate(s.q, *place)[2]:
                loads[k] += fx * px + fy * py

    def power_of_effects(self, s, effects):
        """Terms of the power of forces at places, and of torques."""
        terms = []
        for effect in effects:
            if len(effect) == 2:
                terms.append(effect[1] * s.v[effect[0].angle])
                continue
            place, fx, fy = effect
            if place[0] == "pin":
                _, (vx, vy), _ = self.pin_motion(s, place[1])
            else:
                (_, (vx, vy), _), _ = self.point_motion(s, *place)
            terms += [fx * vx, fy * vy]
        return terms

    def _share_forces(self, s, pin_loads):
        """From multipliers: forces[pin, link or guide] = [fx, fy, moment], drives = [force]."""
        forces, z = {}, self.zero

        def on(pin, name):
            return forces.setdefault((pin, name), [z, z, z])

        for pin, load in pin_loads.items():
            owner = self.holders(pin)[0]
            if owner.name and pin in self.pins_by_name:
                force = on(pin, owner.name)
                force[0], force[1] = load
        s.drives, place, s.contacts = [], 0, {}
        for row in self.rows:
            if row[0] in ("guide", "line"):
                s.contacts[row[1]["pin"], row[1]["guide"]] = [z, z]
        for row in self.rows:
            value = s.multipliers[place]
            if row[0] == "pin":
                _, pin, one, other = row
                x, y = s.multipliers[place:place + 2]
                place += 2
                self._add(on, pin, one, x, y)
                self._add(on, pin, other, -x, -y)
                continue
            place += 1
            if row[0] == "drive":
                s.drives.append(value)
                if row[2] == "place":
                    _, _, cosine, sine = self.guides[row[3][0]]
                    pin = row[1]["name"]
                    self._add(on, pin, self.holders(pin)[0], value * cosine, value * sine)
            elif row[0] == "turn":
                _, one, other, _, where = row
                if isinstance(where, dict):
                    s.contacts[where["pin"], where["guide"]][1] = value
                    on(where["pin"], one.name)[2] += value
                    on(where["pin"], where["guide"])[2] += -value if other else value
                else:
                    on(where, one.name)[2] += value
                    on(where, other.name)[2] -= value
            else:
                self._add_contact(s, on, row, value)
        s.forces = forces

    @staticmethod
    def _add(on, pin, body, x, y):
        if body is not None and body.name:
            force = on(pin, body.name)
            force[0] += x
            force[1] += y

    def _add_contact(self, s, on, row, value):
        """The force of a guide on the pin, or of the block on the link along which it slides."""
        slider = row[1]
        pin, guide = slider["pin"], slider["guide"]
        s.contacts[pin, guide][0] = value
        if row[0] == "guide":
            _, _, cosine, sine = self.guides[guide]
            force = on(pin, guide)
            sign = 1
        else:
            sine, cosine = self.trigonometry(s.q, self.bodies[guide])
            force = on(pin, guide)
            force[2] -= self.field.number(slider["inertia"]) * s.a[self.bodies[guide].angle]
            sign = -1
        x, y = -value * sine, value * cosine
        force[0] += sign * x
        force[1] += sign * y
        if pin not in self.ground:
            self._add(on, pin, self.holders(pin)[0], x, y)

    def energy(self, s):
        """Kinetic and potential energy (of weights, springs, and constant forces at places of links)."""
        kinetic = potential = self.zero
        gx, gy = self.gravity
        for body in self.bodies.values():
            for mass, along, offset, inertia in body.particles:
                if mass == 0 and inertia == 0:
                    continue
                (((x, y), (vx, vy), _), _) = self.point_motion(s, body, along, offset)
                kinetic += mass * (vx * vx + vy * vy) / 2 + inertia * s.v[body.angle]**2 / 2
                potential -= mass * (gx * x + gy * y)
        for pin, mass in self.loads.items():
            if mass and pin not in self.ground:
                (x, y), (vx, vy), _ = self.pin_motion(s, pin)
                kinetic += mass * (vx * vx + vy * vy) / 2
                potential -= mass * (gx * x + gy * y)
        for slider in self.deck.sliders:
            if slider["inertia"]:
                kinetic += self.field.number(slider["inertia"]) * s.v[self.bodies[slider["guide"]].angle]**2 / 2
        return kinetic, potential + sum((load.potential(s) for load in self.applied), self.zero)

    def power_of_loads(self, s):
        """Of forces and torques from outside that have no potential here."""
        power = self.zero
        for pin, (fx, fy) in self.forces.items():
            _, (vx, vy), _ = self.pin_motion(s, pin)
            power += fx * vx + fy * vy
        for load in self.applied + (self.rubs if hasattr(s, "pressing") else []):
            power += sum(self.power_of_effects(s, load.lost(s)), self.zero)
        return power + sum((torque * s.v[self.bodies[link].angle] for link, torque in self.torques.items()), self.zero)

    def power_of_drives(self, s):
        if self.actuators:
            return sum((effort * along.rate(s) for effort, along in zip(s.drives, self.actuators)), self.zero)
        return sum((force * self.drive_ratio(row[1]) * s.rate
                    for force, row in zip(s.drives, (row for row in self.rows if row[0] == "drive"))), self.zero)

    def neighbour(self, s, time):
        """The state a short time later or earlier, with the second derivative of the first drive constant."""
        first = s.first + s.rate * time + s.second * time**2 / 2
        guess = [s.q[i] + s.v[i] * time + s.a[i] * time**2 / 2 for i in range(self.count)]
        return self.state(self.newton(guess, first), first, s.rate + s.second * time, s.second)


def exact_state(deck, q, first, rate, second, model=None):
    """The state at a position in decimals, from unknowns in doubles; (model, state) with forces."""
    model = model or Model(deck, Digits)
    start = [Digits.number(value) for value in q]
    state = model.state(model.newton(start, first), first, rate, second)
    model.add_forces(state)
    return model, state


def positions(deck, cranks=None):
    """Unknowns in doubles at positions of a deck (numbers of its CRANK card), followed in small steps."""
    model = Model(deck)
    q = model.assemble()
    factor = float(deck.crank_factor())
    place, found = float(deck.cranks[0]), []
    for crank in cranks or deck.cranks:
        q = model.follow(q, place * factor, float(crank) * factor)
        place = float(crank)
        found.append(q)
    return model, found
