"""Compares tables on forces with the independent solver under all loads, and balances powers."""
import math

from compare import COMPARED, Differences, Place, Wrong, index, long_tables, row_of
from fields import Digits
from measures import Angle, Line, Sum, coordinate, names
from solver import exact_state, positions

POWER = 1e-12                   # of the sum of absolute terms


def with_solver(deck, tables):
    """Compares all tables with the solver; the largest differences."""
    for name, table in tables.items():
        if table.failed:
            raise Wrong(f"{name}: {table.failed[0]}")
    cranks = deck.cranks[::max(1, len(deck.cranks) // COMPARED)]
    _, found = positions(deck, cranks)
    differences, model = Differences(), None
    long = {**tables, **long_tables(deck, tables)}
    for speed in deck.speeds:
        rate = speed * deck.speed_factor()
        shown = rate / deck.units.results["rate" if deck.drives[0]["linear"] else "speed"]
        for number, (crank, q) in enumerate(zip(cranks, found)):
            model, state = exact_state(deck, q, crank * deck.crank_factor(), rate, deck.alpha(), model)
            place = LoadedPlace(deck, model, state, long, differences, (f"{float(shown) + 0.0:.9g}", f"{float(crank) + 0.0:.9g}"))
            place.forces()
            place.bearings(index(tables["bearings"], "pin", "link"))
            place.frame(index(tables["frame"]))
            if "lagrange" in tables:
                place.lagrange(index(tables["lagrange"]))
            place.coordinates(index(tables["coordinates"], "coordinate"))
            place.virtual_work()
            if number % 6 == 0:
                place.energies()
    return differences.largest


class LoadedPlace(Place):
    """One position of the tables."""

    def scales(self):
        """Of forces and of moments."""
        forces = self.state.forces.values()
        force = max([abs(float(value)) for triple in forces for value in triple[:2]] + [1e-300])
        return force, max([abs(float(triple[2])) for triple in forces] + [force * self.model.size])

    def bearings(self, rows):
        """Forces in the axes of the links and guides."""
        model, unit, (scale, _) = self.model, self.units["force"], self.scales()
        for (pin, link), (fx, fy, _) in self.state.forces.items():
            row = row_of(rows, self.key + (pin, link), "bearings.dat")
            if link in model.guides:
                _, _, cosine, sine = model.guides[link]
            else:
                sine, cosine = model.trigonometry(self.state.q, model.bodies[link])
            size = model.field.sqrt(fx**2 + fy**2)
            values = {"fx": fx, "fy": fy, "axial": fx * cosine + fy * sine, "transverse": fy * cosine - fx * sine, "magnitude": size}
            for name, value in values.items():
                self.add("force", row[name], value / unit, scale / float(unit), f"{name} of {link} at {pin}")
            if size > scale * 1e-9:
                angle = math.degrees(math.atan2(float(values["transverse"]), float(values["axial"])))
                turn = math.radians((row["angle"] - angle + 180) % 360 - 180)
                self.add("force", turn * float(size), 0, scale, f"angle of {link} at {pin}")

    def frame(self, rows):
        """Shaking force, and force on the frame as what all of the linkage needs: nothing of the forces in the joints."""
        model, s = self.model, self.state
        about = [Digits.number(value) * self.units["length"] for value in ("0.3", "-0.2")]
        shaking, whole = [model.zero] * 3, [model.zero] * 3
        gx, gy = model.gravity

        def add(sums, place, fx, fy):
            sums[0] += fx
            sums[1] += fy
            sums[2] += (place[0] - about[0]) * fy - (place[1] - about[1]) * fx

        def particle(mass, place, acceleration):
            add(shaking, place, -mass * acceleration[0], -mass * acceleration[1])
            add(whole, place, mass * (gx - acceleration[0]), mass * (gy - acceleration[1]))

        def couple(value):
            shaking[2] += value
            whole[2] += value

        for body in model.bodies.values():
            for mass, along, offset, inertia in body.particles:
                if mass == 0 and inertia == 0:
                    continue
                (place, _, acceleration), _ = model.point_motion(s, body, along, offset)
                particle(mass, place, acceleration)
                couple(-inertia * s.a[body.angle])
        for pin, mass in model.loads.items():
            if pin not in model.ground:
                place, _, acceleration = model.pin_motion(s, pin)
                particle(mass, place, acceleration)
        for slider in self.deck.sliders:
            if slider["inertia"]:
                couple(-Digits.number(slider["inertia"]) * s.a[model.bodies[slider["guide"]].angle])
        for pin, (fx, fy) in model.forces.items():
            add(whole, model.pin_motion(s, pin)[0], fx, fy)
        for torque in model.torques.values():
            whole[2] += torque
        for load in model.applied:
            if load.keyword in ("spring", "damper", "stop"):
                continue                                  # between links and ground: within what is asked for
            for effect in load.effects(s):
                if len(effect) == 2:
                    whole[2] += effect[1]
                else:
                    add(whole, load.where(s, effect[0])[0], *effect[1:])
        row = row_of(rows, self.key, "frame.dat")
        force, moment = self.scales()
        for name, sums in (("shaking", shaking), ("frame", whole)):
            for k, axis in enumerate(("x", "y", "moment")):
                unit = self.units["moment" if k == 2 else "force"]
                scale = max(moment, force * float(max(abs(value) for value in about))) if k == 2 else force
                self.add("force", row[f"{name}_{axis}"], sums[k] / unit, scale / float(unit), f"{name}_{axis}")

    def coordinates(self, rows):
        """Values and rates of what has a name, and what acts along it."""
        model, s, units = self.model, self.state, self.units
        moves = [model.pin_motion(s, pin)[1] for pin in model.moving_pins]
        speed = max([abs(v) for pair in moves for v in pair] + [abs(s.v[body.angle]) * Digits.number(model.size)
                                                                for body in model.bodies.values() if body.name])
        force, moment = self.scales()
        drives = {row[1]["name"]: (row[1], value) for row, value in zip((row for row in model.rows if row[0] == "drive"), s.drives)}
        for name in names(self.deck):
            along, row = coordinate(model, name), row_of(rows, self.key + (name,), "coordinates.dat")
            size, kinds = Digits.number(1 if along.is_angle else model.size), ("angle", "speed", "torque") if along.is_angle else \
                ("length", "rate", "force")
            weight = sum(abs(term[0]) for term in along.terms) if isinstance(along, Sum) else 1
            difference = Digits.number(row["value"]) * units[kinds[0]] - along.value(s)
            if isinstance(along, Angle):
                difference = along.half_turn(difference)
            self.add("position", float(difference), 0, size * weight, f"value of {name}")
            self.add("velocity", row["rate"] * float(units[kinds[1]]), along.rate(s), speed / Digits.number(model.size) * size * weight,
                     f"rate of {name}")
            effort = sum((load.effort(s) for load in model.applied if load.keyword in ("spring", "damper") and load.words[0] == name
                          or load.keyword == "stop" and load.words[1] == name), model.zero)
            drive, value = drives.get(name.split(":")[0], (None, None))
            if model.actuators:
                drive = None
                effort += dict(zip(self.deck.actuated, s.drives)).get(name, model.zero)
            if drive and drive["linear"] and (drive["words"][0].lower() == "length" or isinstance(along, Line)
                                              and along.guide is model.guides.get(drive["words"][0])):
                effort += value
            self.add("force", row["effort"], effort / units[kinds[2]], (moment if along.is_angle else force) / float(units[kinds[2]]),
                     f"effort of {name}")

    def terms(self, s):
        """Powers of all loads, weights and inertia, with the solver's motion: (of inertia, of weights, of loads)."""
        model = self.model
        gx, gy = model.gravity
        inertia, weights, loads = [], [], []

        def particle(mass, velocity, acceleration):
            inertia.extend(-mass * a * v for a, v in zip(acceleration, velocity))
            weights.extend(mass * g * v for g, v in zip((gx, gy), velocity))

        for body in model.bodies.values():
            for mass, along, offset, moment in body.particles:
                if mass == 0 and moment == 0:
                    continue
                (_, velocity, acceleration), _ = model.point_motion(s, body, along, offset)
                particle(mass, velocity, acceleration)
                inertia.append(-moment * s.a[body.angle] * s.v[body.angle])
        for pin, mass in model.loads.items():
            if pin not in model.ground:
                _, velocity, acceleration = model.pin_motion(s, pin)
                particle(mass, velocity, acceleration)
        for slider in self.deck.sliders:
            if slider["inertia"]:
                k = model.bodies[slider["guide"]].angle
                inertia.append(-Digits.number(slider["inertia"]) * s.a[k] * s.v[k])
        for pin, (fx, fy) in model.forces.items():
            _, (vx, vy), _ = model.pin_motion(s, pin)
            loads += [fx * vx, fy * vy]
        loads += [torque * s.v[model.bodies[link].angle] for link, torque in model.torques.items()]
        for load in model.applied + (model.rubs if hasattr(s, "pressing") else []):
            loads += model.power_of_effects(s, load.effects(s))
        return inertia, weights, loads

    def virtual_work(self):
        """The power of the drives in the tables is that of nothing else."""
        terms = [term for part in self.terms(self.state) for term in part]
        whole = float(sum(abs(term) for term in terms))
        power, rows = [], [row for row in self.model.rows if row[0] == "drive"]
        for name, along in zip(self.deck.actuated, self.model.actuators):
            unit = self.units["torque" if along.is_angle else "force"]
            power.append(Digits.number(self.drives[self.key + (name,)]["force"]) * unit * along.rate(self.state))
        for row in [] if power else rows:
            table = self.drives[self.key + (row[1]["name"],)]
            unit = self.units["force" if row[1]["linear"] else "torque"]
            rate = self.model.drive_ratio(row[1]) * self.state.rate
            power.append(Digits.number(table["force"]) * unit * rate)
        whole += float(sum(abs(value) for value in power))
        difference = abs(float(sum(power) + sum(terms)))
        if whole and not difference <= POWER * whole:
            raise Wrong(f"virtual work is off by {difference / whole:.1e} of the terms at crank {self.key[1]}")
        if whole:
            self.differences.largest["work"] = max(self.differences.largest.get("work", 0.0), difference / whole)

    def lagrange(self, rows):
        """Terms per rate of the first drive."""
        model, s, units = self.model, self.state, self.units
        row = row_of(rows, self.key, "lagrange.dat")
        if s.rate == 0:
            return
        linear = self.deck.drives[0]["linear"]
        effort = units["force" if linear else "torque"]
        slow = model.state(s.q, s.first, Digits.number(1), Digits.number(0))
        velocity = -sum(self.terms(slow)[0], model.zero)
        _, weights, loads = self.terms(s)
        kinetic = model.energy(s)[0]
        potential = model.energy(s)[1] - sum((f * x for pin, force in model.forces.items()
                                              for f, x in zip(force, model.pin_motion(s, pin)[0])), model.zero)
        inertia = 2 * kinetic / s.rate**2
        gravity, load = -sum(weights, model.zero) / s.rate, -sum(loads, model.zero) / s.rate
        torque = inertia * s.second + velocity * s.rate**2 + gravity + load
        force, moment = self.scales()
        parts = [float(abs(term) / abs(s.rate)) for part in self.terms(s) for term in part]
        scale = max([force if linear else moment] + parts) / float(effort)
        for name, value in (("V", velocity * s.rate**2), ("gravity", gravity), ("load", load), ("torque", torque)):
            self.add("torque", row[name], value / effort, scale, name)
        unit = units["energy"]
        mass = units["mass"] if linear else units["mass"] * units["length"]**2
        self.add("energy", row["M"], inertia / mass, inertia / mass, "M")
        self.add("energy", row["kinetic"], kinetic / unit, kinetic / unit, "kinetic")
        largest = max([abs(load.potential(s)) for load in model.applied] + [abs(potential), kinetic, Digits.number(force * model.size)])
        self.add("energy", row["potential"], potential / unit, largest / unit, "potential")
