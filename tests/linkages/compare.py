"""Compares tables of the program with the independent solver, and checks what has to hold between tables alone.

Differences are relative to the largest value of their kind at the position.  What is allowed grows with the condition of the
Jacobian, as rounding does: TOLERANCE[kind] times the condition.
"""
import math

from fields import Digits
from reference import wrapped
from solver import exact_state, positions

TOLERANCE = {"position": 1e-14, "angle": 1e-14, "velocity": 3e-14, "acceleration": 1e-13, "force": 1e-13, "torque": 1e-13,
             "closure": 1e-14, "power": 1e-13, "energy": 1e-13, "steps": 1e-14, "drive": 1e-14}
MOST = 3e-11                    # whatever the condition
COMPARED = 13                   # positions of a deck that are compared with 40 digits


class Wrong(Exception):
    """A difference that is too large, or a row that is missing."""


def merge(largest, more):
    for name, value in more.items():
        largest[name] = max(largest.get(name, 0.0), value)


def index(table, *names):
    """Rows by speed, crank and the names in text columns."""
    return {(f"{row['speed'] + 0.0:.9g}", f"{row['crank'] + 0.0:.9g}") + tuple(row[name] for name in names): row
            for row in table.rows}


class Differences:
    """The largest differences by kind, and whether they are allowed."""

    def __init__(self):
        self.largest = {}

    def add(self, kind, value, expected, scale, condition, where):
        difference = abs(value - expected) / scale if scale else abs(value - expected)
        if not difference <= min(MOST, TOLERANCE[kind] * max(10.0, condition)):
            raise Wrong(f"{kind} differs by {difference:.1e} at {where}: {value!r}, not {expected!r} (condition {condition:.0f})")
        self.largest[kind] = max(self.largest.get(kind, 0.0), difference)


def row_of(rows, key, table):
    if key not in rows:
        raise Wrong(f"{table}: no row for {' '.join(map(str, key))}")
    return rows[key]


def with_solver(deck, tables, loaded):
    """Compares all tables with the solver; the largest differences."""
    for name, table in tables.items():
        if table.failed:
            raise Wrong(f"{name}: {table.failed[0]}")
    stride = max(1, len(deck.cranks) // COMPARED)
    cranks = deck.cranks[::stride]
    _, found = positions(deck, cranks)
    differences, model = Differences(), None
    for speed in deck.speeds:
        rate = speed * deck.speed_factor()
        shown = rate / deck.units.results["rate" if deck.drives[0]["linear"] else "speed"]
        for number, (crank, q) in enumerate(zip(cranks, found)):
            model, state = exact_state(deck, q, crank * deck.crank_factor(), rate, deck.alpha(), model)
            place = Place(deck, model, state, tables, differences, (f"{float(shown) + 0.0:.9g}", f"{float(crank) + 0.0:.9g}"))
            place.kinematics()
            if loaded:
                place.forces()
                if not place.drives:
                    continue
                place.balance_powers()
                if number % 6 == 0:
                    place.energies()
    return differences.largest


class Rows:
    """Rows as a table has them."""

    def __init__(self, rows, failed):
        self.rows, self.failed = rows, failed


def long_tables(deck, tables):
    """The tables of a four-bar as those of other linkages, as far as they go; others as they are."""
    if "theta3" not in tables["kinematics"].names:
        return tables
    crank = deck.drives[0]["name"]
    links = {name: card["pins"] for name, card in deck.links.items()}
    a = next(pin for pin in links[crank] if pin not in deck.grounds)
    coupler = next(name for name, pins in links.items() if name != crank and a in pins)
    follower = next(name for name in links if name not in (crank, coupler))
    b = next(pin for pin in links[coupler] if pin != a)
    turn = 0.0 if links[coupler][0] == a else 180.0
    kinematics, pins, reactions, drives = [], [], [], []
    for row in tables["kinematics"].rows:
        place = {"speed": row["speed"], "crank": row["crank"]}
        for name, number, more in ((coupler, "3", turn), (follower, "4", 0.0)):
            theta = row["theta" + number] + more
            kinematics.append({**place, "link": name, "theta": theta - 360 if theta > 180 else theta,
                               "omega": row["omega" + number], "alpha": row["alpha" + number]})
        pins += [{**place, "pin": pin, "x": row[name + "x"], "y": row[name + "y"]} for pin, name in ((a, "A"), (b, "B"))]
    failed = tables["kinematics"].failed
    result = {"kinematics": Rows(kinematics, failed), "pins": Rows(pins, failed)}
    if "reactions" in tables:
        ends = {"O2": (next(pin for pin in links[crank] if pin != a), crank), "A2": (a, crank), "A3": (a, coupler),
                "B3": (b, coupler), "B4": (b, follower), "O4": (next(pin for pin in links[follower] if pin != b), follower)}
        for row in tables["reactions"].rows:
            place = {"speed": row["speed"], "crank": row["crank"]}
            reactions += [{**place, "pin": pin, "link": link, "fx": row[name + "x"], "fy": row[name + "y"], "moment": None}
                          for name, (pin, link) in ends.items()]
            drives.append({**place, "drive": crank, "position": row["crank"], "rate": row["speed"], "force": row["torque"]})
        result.update(reactions=Rows(reactions, tables["reactions"].failed), drives=Rows(drives, []))
    return result


class Place:
    """One position of the tables."""

    def __init__(self, deck, model, state, tables, differences, key):
        self.deck, self.model, self.state, self.differences, self.key = deck, model, state, differences, key
        self.links = index(tables["kinematics"], "link")
        self.pins = index(tables["pins"], "pin")
        self.reactions = index(tables["reactions"], "pin", "link") if "reactions" in tables else {}
        self.drives = index(tables["drives"], "drive") if "drives" in tables else {}
        self.units = deck.units.results
        self.condition = model.condition(state.q)
        self.size = model.size / float(self.units["length"])

    def add(self, kind, value, expected, scale, where):
        self.differences.add(kind, value, float(expected), float(scale), self.condition, f"crank {self.key[1]}, {where}")

    def kinematics(self):
        model, state, units = self.model, self.state, self.units
        motions = {pin: model.pin_motion(state, pin) for pin in model.moving_pins}
        links = {name: model.link_motion(state, name) for name, body in model.bodies.items() if body.name}
        length = float(units["length"])
        velocity = max([abs(float(v)) for _, pair, _ in motions.values() for v in pair]
                       + [abs(float(link[1])) * model.size for link in links.values()])
        acceleration = max([abs(float(v)) for _, _, pair in motions.values() for v in pair]
                           + [abs(float(link[2])) * model.size for link in links.values()])
        per_second = float(units["rate"])
        for pin, (place, rate, second) in motions.items():
            row = row_of(self.pins, self.key + (pin,), "pins.dat")
            for k, axis in enumerate("xy"):
                self.add("position", row[axis], place[k] / units["length"], self.size, f"{axis} of {pin}")
                if "vx" not in row:
                    continue
                self.add("velocity", row["v" + axis], rate[k] / units["rate"], velocity / per_second, f"v{axis} of {pin}")
                self.add("acceleration", row["a" + axis], second[k] / units["acceleration"],
                         acceleration / float(units["acceleration"]), f"a{axis} of {pin}")
        for link, (angle, rate, second) in links.items():
            key = self.key + (link,)
            if key not in self.links and link == self.deck.drives[0]["name"]:
                continue
            row = row_of(self.links, key, "kinematics.dat")
            expected = float(wrapped(angle / units["angle"]))
            turn = (row["theta"] - expected + 180) % 360 - 180
            self.add("angle", math.radians(turn), 0, 1, f"angle of {link}")
            if not -180 < row["theta"] <= 180:
                raise Wrong(f"angle of {link} is {row['theta']!r}")
            scale = velocity / model.size / float(units["speed"])
            self.add("velocity", row["omega"], rate / units["speed"], scale, f"omega of {link}")
            self.add("acceleration", row["alpha"], second, acceleration / model.size, f"alpha of {link}")
        self.close(model, length)

    def close(self, model, length):
        """Distances between pins of a link, and pins on their lines, from the table alone."""
        def place(pin):
            if pin in model.ground:
                return tuple(float(value) / length for value in model.ground[pin])
            row = self.pins[self.key + (pin,)]
            return row["x"], row["y"]

        for body in model.bodies.values():
            names = [pin for pin in body.places if pin != body.far]
            for k, one in enumerate(names):
                for other in names[:k]:
                    (u, v), (u0, v0) = body.places[one], body.places[other]
                    expected = math.hypot(float(u - u0), float(v - v0)) / length
                    value = math.dist(place(one), place(other))
                    self.add("closure", value, expected, self.size, f"{one} to {other} of {body.name}")
        for slider in self.deck.sliders:
            x, y = place(slider["pin"])
            if slider["guide"] in model.guides:
                x0, y0, cosine, sine = map(float, model.guides[slider["guide"]])
                distance = (y - y0 / length) * cosine - (x - x0 / length) * sine
            else:
                first, second = model.bodies[slider["guide"]].pins[:2]
                (x0, y0), (x1, y1) = place(first), place(second)
                distance = ((y - y0) * (x1 - x0) - (x - x0) * (y1 - y0)) / math.hypot(x1 - x0, y1 - y0)
            self.add("closure", distance, 0, self.size, f"{slider['pin']} on {slider['guide']}")

    def forces(self):
        model, state, units = self.model, self.state, self.units
        force = max([abs(float(value)) for triple in state.forces.values() for value in triple[:2]] + [1e-300])
        moment = max([abs(float(triple[2])) for triple in state.forces.values()] + [force * model.size])
        for (pin, link), triple in state.forces.items():
            row = row_of(self.reactions, self.key + (pin, link), "reactions.dat")
            for column, value, scale in zip(("fx", "fy", "moment"), triple, (force, force, moment)):
                if row[column] is None:  # tables of four-bars have none
                    continue
                unit = units["moment" if column == "moment" else "force"]
                self.add("force", row[column], value / unit, scale / float(unit), f"{column} on {link} at {pin}")
        for name, along, value in zip(self.deck.actuated, model.actuators, state.drives):
            table = row_of(self.drives, self.key + (name,), "drives.dat")
            unit = units["torque" if along.is_angle else "force"]
            self.add("torque", table["force"], value / unit, max(moment if along.is_angle else force, abs(float(value))) / float(unit),
                     f"effort of {name}")
        for row, value in zip((row for row in model.rows if row[0] == "drive"), state.drives):
            if not self.drives or model.actuators:
                break
            drive = row[1]
            table = row_of(self.drives, self.key + (drive["name"],), "drives.dat")
            kinds = ("length", "rate", "force") if drive["linear"] else ("angle", "speed", "torque")
            place = model.drive_value(drive, state.first) / units[kinds[0]]
            if drive["linear"]:
                self.add("drive", table["position"], place, self.size, f"position of {drive['name']}")
            else:
                self.add("drive", (table["position"] - float(place) + 180) % 360 - 180, 0, 180, f"position of {drive['name']}")
            self.add("drive", table["rate"], model.drive_ratio(drive) * state.rate / units[kinds[1]],
                     abs(state.rate / units[kinds[1]]), f"rate of {drive['name']}")
            scale = (force if drive["linear"] else moment) / float(units[kinds[2]])
            self.add("torque", table["force"], value / units[kinds[2]], scale, f"force of drive {drive['name']}")

    def balance_powers(self):
        """Powers of drives, loads, weights and inertia, from the tables with the masses of the deck: their sum is zero."""
        model, units = self.model, {name: float(value) for name, value in self.units.items() if value}
        terms = []
        gx, gy = map(float, model.gravity)

        def motion(pin):
            if pin in model.ground:
                return [(0.0, 0.0)] * 2
            row = self.pins[self.key + (pin,)]
            return [(row["vx"] * units["rate"], row["vy"] * units["rate"]),
                    (row["ax"] * units["acceleration"], row["ay"] * units["acceleration"])]

        def particle(mass, velocity, acceleration):
            terms.extend(mass * (g - a) * v for g, a, v in zip((gx, gy), acceleration, velocity))

        for name, body in model.bodies.items():
            if not body.name:
                continue
            key = self.key + (name,)
            if key not in self.links or "vx" not in next(iter(self.pins.values())):
                return                                     # a four-bar: its tables do not have the crank, nor velocities of pins
            row = self.links[key]
            rate, second = row["omega"] * units["speed"], row["alpha"]
            angle = math.radians(row["theta"]) - float(model.offsets[name])
            velocity, acceleration = motion(body.pins[0])
            for mass, along, offset, inertia in (map(float, part) for part in body.particles):
                x = along * math.cos(angle) - offset * math.sin(angle)
                y = along * math.sin(angle) + offset * math.cos(angle)
                particle(mass, (velocity[0] - rate * y, velocity[1] + rate * x),
                         (acceleration[0] - second * y - rate**2 * x, acceleration[1] + second * x - rate**2 * y))
                terms.append(-inertia * second * rate)
            terms.append(float(model.torques.get(name, 0)) * rate)
            for slider in self.deck.sliders:
                if slider["guide"] == name:
                    terms.append(-float(slider["inertia"]) * second * rate)
        for pin, mass in model.loads.items():
            particle(float(mass), *motion(pin))
        for pin, force in model.forces.items():
            velocity, _ = motion(pin)
            terms += [float(f) * v for f, v in zip(force, velocity)]
        terms += self.powers()
        largest = max(abs(term) for term in terms)
        if largest:
            self.add("power", math.fsum(terms), 0, largest, "sum of powers")

    def powers(self):
        """Of the drives, or of the actuators in their place, from the table."""
        sources = [(name, not along.is_angle) for name, along in zip(self.deck.actuated, self.model.actuators)] or \
            [(drive["name"], drive["linear"]) for drive in self.deck.drives]
        kinds = {True: ("rate", "force"), False: ("speed", "torque")}
        rows = [(self.drives[self.key + (name,)], [float(self.units[kind]) for kind in kinds[linear]]) for name, linear in sources]
        return [row["rate"] * rate * row["force"] * force for row, (rate, force) in rows]

    def check_solver(self, later, earlier, time):
        """Velocities and accelerations of the solver are the differences of its positions."""
        s = self.state
        rates, seconds = max(map(abs, s.v)), max(map(abs, s.a)) + max(map(abs, s.v)) * abs(s.rate)
        for k in range(self.model.count):
            rate = (later.q[k] - earlier.q[k]) / (2 * time) - s.v[k]
            second = (later.q[k] - 2 * s.q[k] + earlier.q[k]) / time**2 - s.a[k]
            if abs(rate) > Digits.number("1e-20") * rates or abs(second) > Digits.number("1e-10") * seconds:
                raise Wrong(f"the solver itself: unknown {k} at crank {self.key[1]}: {rate:.1e} {second:.1e}")

    def energies(self):
        """The power of the drives from the change of energy (of the solver) against the table's forces."""
        model, state = self.model, self.state
        if state.rate == 0:
            return
        time = Digits.number("1e-13") / abs(state.rate) * (Digits.number(model.size) if self.deck.drives[0]["linear"] else 1)
        later, earlier = model.neighbour(state, time), model.neighbour(state, -time)
        self.check_solver(later, earlier, time)
        expected = (sum(model.energy(later)) - sum(model.energy(earlier))) / (2 * time) - model.power_of_loads(state)
        power = sum(self.powers())
        force = max([abs(float(value)) for triple in state.forces.values() for value in triple[:2]] + [1e-300])
        speed = max(abs(float(v)) for pin in model.moving_pins for v in model.pin_motion(state, pin)[1])
        scale = max(abs(float(expected)), force * speed)
        self.add("energy", power, expected, scale, "power of the drives")


def same_positions(one, other, largest):
    """The same rows for the same positions, whatever the step."""
    differences = Differences()
    for name, texts in (("pins", ["pin"]), ("kinematics", ["link"])):
        rows = index(other[name], *texts)
        common = [(row, rows[key]) for key, row in index(one[name], *texts).items() if key in rows]
        if not common:
            raise Wrong(f"{name}: no common positions of two steps")
        columns = ("x", "y") if name == "pins" else ("theta",)
        scale = max(abs(row[column]) for row, _ in common for column in columns)
        for row, same in common:
            for column in columns:
                value = same[column]
                if column == "theta" and abs(value - row[column]) > 180:
                    value -= math.copysign(360, value - row[column])
                differences.add("steps", value, row[column], scale, 300, f"crank {row['crank']}, {column} of {row[texts[0]]}")
    if other["pins"].failed or other["kinematics"].failed:
        raise Wrong((other["pins"].failed + other["kinematics"].failed)[0])
    merge(largest, differences.largest)
