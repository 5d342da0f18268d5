"""Frequencies of planar linkages whose links bend, by dynamic stiffness in decimals and the count of Wittrick and Williams.

A linkage is frozen at a position of the independent solver (solver.py).  Unknowns are the displacements of its pins and the rotations
of its cross-sections there; rigid links, blocks on guides, welds and drives are linear equations between these, which are eliminated
exactly.  Between them lie straight uniform beams (beams.py), slender ones at rest in closed form.  Nothing is shared with the program
that is tested: neither formulas of its deformation coordinates nor numbers.
"""
from decimal import Decimal

import dense
from beams import ONE, ZERO, Polynomials, bending_at_rest, stretching
from fields import Digits, Doubles
from solver import Failure, Model

ORDER = 40                                     # of polynomials, where there is no closed form
TINY = Decimal("1e-32")                        # relative: what is left of an equation that follows from others


def bends(card):
    return "material" in card and not card["rigid"] and not {"mass", "inertia", "center"} & set(card)


class Assembly(Model):
    """A linkage with more equations than unknowns too: those that follow from others, at the drawing, are left out (and checked)."""

    kept = None

    def _compare_counts(self, equations):
        if equations < self.count:
            raise Failure(f"{self.count} unknowns and {equations} equations")
        self.total = equations

    def equations(self, q, first, need_jacobian=True):
        residuals, jacobian = super().equations(q, first, need_jacobian)
        if self.kept is None and self.total > self.count:
            self.kept = self._independent(jacobian)
        self.left_out = [residuals[k] for k in range(self.total) if self.kept and k not in self.kept]
        return self._some(residuals), self._some(jacobian)

    def _some(self, items):
        return items if self.kept is None else [items[k] for k in self.kept]

    def quadratic(self, q, v):
        return self._some(super().quadratic(q, v))

    def drive_rates(self, rate):
        return self._some(super().drive_rates(rate))

    def _independent(self, jacobian):
        """The first rows that are independent of those before; drives before all."""
        drives = [k for k, row in enumerate(self._row_of_equation()) if row[0] == "drive"]
        order = drives + [k for k in range(len(jacobian)) if k not in drives]
        basis, kept = [], []
        for k in order:
            row = [float(x) for x in jacobian[k]]
            size = max(map(abs, row))
            for pivot, other in basis:
                if row[pivot]:
                    factor = row[pivot] / other[pivot]
                    row = [x - factor * y for x, y in zip(row, other)]
            pivot = max(range(len(row)), key=lambda j: abs(row[j]))
            if abs(row[pivot]) > 1e-6 * size:
                basis.append((pivot, row))
                kept.append(k)
        if len(kept) != self.count:
            raise Failure(f"{self.count} unknowns and {len(kept)} independent equations")
        return sorted(kept)

    def _row_of_equation(self):
        return [row for row in self.rows for _ in range(2 if row[0] == "pin" else 1)]


def assemblies(deck):
    """(exact model, unknowns in decimals) at every position of a deck."""
    model, exact = Assembly(deck), None
    q = model.assemble()
    factor = float(deck.crank_factor())
    place = float(deck.cranks[0])
    for crank in deck.cranks:
        q = model.follow(q, place * factor, float(crank) * factor)
        place = float(crank)
        if exact is None:
            exact = Assembly(deck, Digits)
            exact.kept = model.kept
        first = crank * deck.crank_factor()
        digits = exact.newton([Digits.number(value) for value in q], first)
        exact.equations(digits, first)
        if any(abs(residual) > Decimal("1e-35") * Decimal(exact.size + 1) for residual in exact.left_out):
            raise Failure("redundant links that do not fit")
        yield crank, exact, digits


def add_form(into, form, factor=ONE):
    for k, value in form.items():
        into[k] = into.get(k, ZERO) + factor * value
    return into


class Beam:
    """A straight uniform part of a link: unknowns of its ends, length, direction and stiffness."""

    def __init__(self, link, ends, turns, places, direction, length, card, deck):
        self.link, self.ends, self.turns, self.places, self.direction, self.length = link, ends, turns, places, direction, length
        elastic, poisson = deck.moduli[card["material"]]
        second, coefficient = deck.bending[card["section"]]
        area, density = deck.sections[card["section"]], deck.materials[card["material"]]
        self.axial, self.stiffness, self.mass = elastic * area, elastic * second, density * area
        self.rotary = density * second if "rotary" in deck.effects else ZERO
        self.shear = elastic / (2 * (1 + poisson)) * coefficient * area if "shear" in deck.effects else None
        self.tension = None                    # N0, N1, N2
        self.polynomials = self.still = None
        self.is_slender = not (self.rotary or self.shear)

    def prepare(self, order):
        """Polynomials, where there is no closed form."""
        if not self.is_slender or self.tension:
            self.polynomials = Polynomials(order, self.length, self.stiffness, self.mass, self.rotary, self.shear, self.tension)

    def bending(self, c, order):
        if self.polynomials is None and c <= 0:
            self.polynomials = Polynomials(order, self.length, self.stiffness, self.mass, self.rotary, self.shear, self.tension)
        if c > 0 and self.is_slender and not self.tension:
            return bending_at_rest(c, self.length, self.stiffness, self.mass)
        return self.polynomials.condensed(c)


class Structure:
    """The linkage at a position: beams, masses, springs, and equations between displacements.

    model, q    an Assembly in decimals and its unknowns
    held        free drives too are held (for static solutions)
    """

    def __init__(self, model, q, held=False, order=ORDER):
        self.model, self.q, self.deck, self.held, self.order = model, q, model.deck, held, order
        self.count, self.names = 0, {}
        self.beams, self.masses, self.inertias, self.rows, self.springs = [], [], [], [], []
        self.bodies, self.contacts, self.blocks, self.second_order = [], [], [], []
        self.pushes = []                       # (displacement of a place, force that acts there)
        self.turn_at = {}                      # (link, pin): rotation
        self.contact_of = {}                   # index of a slider: node on its guide
        for pin in self.deck.grounds:
            self.names["pin", pin] = ({}, {})
        for number, slider in enumerate(self.deck.sliders):
            if slider["guide"] in model.bodies:
                self.contact_of.setdefault(slider["guide"], []).append(number)
        for name, card in self.deck.links.items():
            (self._add_bending if bends(card) else self._add_body)(name, card)
        for number, slider in enumerate(self.deck.sliders):
            self._add_slider(number, slider)
        for pin, mass in self.deck.pin_masses:
            self.masses.append((self.node(pin), mass, ("pin", pin)))
        for pin, links in self.deck.welds:
            for link in links[1:]:
                self._equal(self.turn(links[0], pin), self.turn(link, pin))
        for drive in self.deck.drives:
            self._hold(drive)
        for load in model.applied:
            if load.keyword == "spring":
                self._add_spring(load)
        self._eliminate()

    # unknowns

    def unknown(self):
        self.count += 1
        return {self.count - 1: ONE}

    def node(self, pin):
        """Displacement of a pin: forms in x and y."""
        if ("pin", pin) not in self.names:
            self.names["pin", pin] = (self.unknown(), self.unknown())
        return self.names["pin", pin]

    def turn(self, link, pin):
        return self.turn_at[link, pin]

    def _equal(self, one, other):
        self.rows.append(add_form(dict(one), other, -ONE))

    # parts

    def _axes(self, body):
        sine, cosine = self.model.trigonometry(self.q, body)
        return cosine, sine

    def _place(self, body, pin):
        along, offset = body.places[pin]
        return (self.q[body.ram] if pin == body.far else along), offset

    def _contact_places(self, link, body):
        """Where blocks are along a link: (index, along)."""
        cosine, sine = self._axes(body)
        for number in self.contact_of.get(link, []):
            x, y, _ = self.model.pin_place(self.q, self.deck.sliders[number]["pin"])
            yield number, (x - self.q[body.first]) * cosine + (y - self.q[body.first + 1]) * sine

    def _add_bending(self, name, card):
        body = self.model.bodies[name]
        cosine, sine = self._axes(body)
        pins = card["pins"]
        closed = len(pins) > 2 and pins[0] == pins[-1]
        corners = [self._place(body, pin) for pin in (pins[:-1] if closed else pins)]
        route = corners + ([corners[0]] if closed else [])
        names = list(pins)
        first_turn = self.unknown()
        self.turn_at[name, names[0]] = last_turn = first_turn
        extra = [(point, *body.places[point], "pin") for point in body.places if point not in pins and point in self.deck.points]
        extra += [(number, along, ZERO, "contact") for number, along in self._contact_places(name, body)]
        extra += [(number, particle[1], particle[2], "mass") for number, particle in enumerate(body.particles) if number]
        extra += [(load, *load.at[1:], "force") for load in self._forces_on(body)]
        nearest = {item: self._nearest_part(route, x, y) for item, x, y, kind in extra if kind in ("mass", "force")}
        placed = []
        for k in range(len(route) - 1):
            (x0, y0), (x1, y1) = route[k], route[k + 1]
            length = ((x1 - x0)**2 + (y1 - y0)**2).sqrt()
            ex, ey = (x1 - x0) / length, (y1 - y0) / length
            stops = []
            for item, x, y, kind in extra:
                at = (x - x0) * ex + (y - y0) * ey
                if kind in ("mass", "force"):
                    is_here = nearest[item] == k
                else:
                    is_here = abs((y - y0) * ex - (x - x0) * ey) < TINY
                if is_here and 0 < at < length:
                    stops.append((at, kind, item))
                    placed.append(item)
            stops.sort(key=lambda stop: stop[0])
            direction = (ex * cosine - ey * sine, ex * sine + ey * cosine)
            last, last_node = ZERO, self.node(names[k])
            for at, kind, item in stops + [(length, "end", names[k + 1])]:
                if at - last > TINY * length:
                    if kind in ("pin", "end"):
                        node = self.node(item)
                    else:
                        node = (self.unknown(), self.unknown())
                    turn = first_turn if kind == "end" and closed and k == len(route) - 2 else self.unknown()
                    self.beams.append(Beam(name, (last_node, node), (last_turn, turn), [(x0 + s * ex, y0 + s * ey) for s in (last, at)],
                                           direction, at - last, card, self.deck))
                    last, last_node, last_turn = at, node, turn
                elif kind in ("pin", "end"):
                    raise Failure("two pins at one place")
                if kind == "contact":
                    self.contacts.append(self._contact(item, name, last_node, last_turn, at))
                elif kind == "mass":
                    particle = body.particles[item]
                    beside = (particle[2] - y0) * ex - (particle[1] - x0) * ey
                    self._attach(name, last_node, last_turn, particle, (-beside * direction[1], beside * direction[0]))
                elif kind == "force":
                    beside = (item.at[2] - y0) * ex - (item.at[1] - x0) * ey
                    self._push(name, last_node, last_turn, item, (-beside * direction[1], beside * direction[0]))
                else:
                    self.turn_at[name, item] = last_turn
        if len(placed) != len(extra):
            raise Failure("a place beyond the ends of a link, or on a corner")

    @staticmethod
    def _nearest_part(route, x, y):
        """Of a link with corners, the straight part to which a mass is fixed."""
        distances = []
        for (x0, y0), (x1, y1) in zip(route, route[1:]):
            length = ((x1 - x0)**2 + (y1 - y0)**2).sqrt()
            at = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length**2
            at = min(max(at, ZERO), ONE)
            distances.append((x - x0 - at * (x1 - x0))**2 + (y - y0 - at * (y1 - y0))**2)
        return distances.index(min(distances))

    def _attach(self, link, node, turn, particle, arm):
        """A mass of a link that bends, fixed to its cross-section, with its arm from the axis."""
        mass, along, offset, inertia = particle
        place = self._rigid(node, turn, arm)
        self.masses.append((place, mass, ("body", link, along, offset)))
        self.inertias.append((turn, inertia, link))
        self.bodies.append({"link": link, "turn": turn, "pins": [], "loads": [(arm, mass, (link, along, offset))], "inertia": inertia})

    def _forces_on(self, body):
        """That act at places of a link."""
        return [load for load in self.model.applied if load.keyword == "force" and load.on_link and load.at[0] is body]

    def _push(self, link, node, turn, load, arm):
        """A force at a place of a link that bends, fixed to its cross-section, with its arm from the axis."""
        self.pushes.append((self._rigid(node, turn, arm), load))
        self.bodies.append({"link": link, "turn": turn, "pins": [], "loads": [], "inertia": ZERO, "forces": [(arm, load)]})

    def _rigid(self, node, turn, arm):
        x, y = dict(node[0]), dict(node[1])
        return add_form(x, turn, -arm[1]), add_form(y, turn, arm[0])

    def _add_body(self, name, card):
        body = self.model.bodies[name]
        cosine, sine = self._axes(body)
        base, turn = (self.unknown(), self.unknown()), self.unknown()
        record = {"link": name, "turn": turn, "pins": [], "loads": [], "inertia": ZERO}

        def arm_of(along, offset):
            return along * cosine - offset * sine, along * sine + offset * cosine

        for pin in body.places:
            arm = arm_of(*self._place(body, pin))
            place = self._rigid(base, turn, arm)
            node = self.node(pin)
            record["pins"].append((arm, len(self.rows)))
            for one, other in zip(node, place):
                self._equal(one, other)
            self.turn_at[name, pin] = turn
        for number, along in self._contact_places(name, body):
            arm = arm_of(along, ZERO)
            node = self._rigid(base, turn, arm)
            contact = self._contact(number, name, node, turn, along)
            contact["arm"] = arm
            self.contacts.append(contact)
            record.setdefault("contacts", []).append(contact)
        for k, (mass, along, offset, inertia) in enumerate(body.particles):
            arm = arm_of(along, offset)
            self.masses.append((self._rigid(base, turn, arm), mass, ("body", name, along, offset)))
            rotary = ZERO
            if k == 0 and "rotary" in self.deck.effects and "material" in card and not {"mass", "inertia", "center"} & set(card):
                rotary = self._rotary(card, body)
            self.inertias.append((turn, inertia + rotary, name))
            record["loads"].append((arm, mass, (name, along, offset)))
            record["inertia"] += inertia
        for load in self._forces_on(body):
            arm = arm_of(*load.at[1:])
            self.pushes.append((self._rigid(base, turn, arm), load))
            record.setdefault("forces", []).append((arm, load))
        self.bodies.append(record)

    def _rotary(self, card, body):
        pins = card["pins"]
        places = [self._place(body, pin) for pin in pins]
        total = sum((((x1 - x0)**2 + (y1 - y0)**2).sqrt() for (x0, y0), (x1, y1) in zip(places, places[1:])), ZERO)
        return self.deck.materials[card["material"]] * self.deck.bending[card["section"]][0] * total

    def _contact(self, number, link, node, turn, along):
        return {"slider": number, "link": link, "node": node, "turn": turn, "along": along,
                "direction": self._axes(self.model.bodies[link])}

    def _line(self, slider, number):
        """Direction of a slider's line, displacement and rotation of the guide there."""
        if slider["guide"] in self.model.guides:
            _, _, cosine, sine = self.model.guides[slider["guide"]]
            return (cosine, sine), ({}, {}), {}
        contact = next(contact for contact in self.contacts if contact["slider"] == number)
        return contact["direction"], contact["node"], contact["turn"]

    def _add_slider(self, number, slider):
        pin = slider["pin"]
        (cosine, sine), node, turn = self._line(slider, number)
        row, place = {}, self.node(pin)
        for form, other, factor in zip(place, node, (-sine, cosine)):
            add_form(row, form, factor)
            add_form(row, other, -factor)
        for contact in self.contacts:
            if contact["slider"] == number:
                contact["row"], contact["pin"] = len(self.rows), place
        self.rows.append(row)
        if slider["link"]:
            self._equal(self.turn(slider["link"], pin), turn)
        if slider["mass"]:
            self.masses.append((place, slider["mass"], ("pin", pin)))
        if slider["inertia"]:
            self.inertias.append((turn, slider["inertia"], slider["guide"]))
            self.blocks.append((turn, slider["inertia"], slider["guide"]))

    def _hold(self, drive):
        if drive["free"] and not self.held:
            return
        words = [word.lower() for word in drive["words"]]
        grounds, links = self.deck.grounds, self.deck.links
        if not words:
            pin = next(pin for pin in links[drive["name"]]["pins"] if pin in grounds)
            self.rows.append(dict(self.turn(drive["name"], pin)))
        elif words[0] == "against":
            other = drive["words"][1]
            pin = next(pin for pin in links[drive["name"]]["pins"] if pin in links[other]["pins"])
            self._equal(self.turn(drive["name"], pin), self.turn(other, pin))
        elif words[0] == "length":
            pass                               # the ram has a length
        else:
            number = next(k for k, slider in enumerate(self.deck.sliders)
                          if slider["pin"] == drive["name"] and slider["guide"] == drive["words"][0])
            (cosine, sine), node, _ = self._line(self.deck.sliders[number], number)
            row = {}
            for form, other, factor in zip(self.node(drive["name"]), node, (cosine, sine)):
                add_form(row, form, factor)
                add_form(row, other, -factor)
            self.rows.append(row)

    def _add_spring(self, load):
        words = load.words
        if load.turns:
            one = self.turn(words[2], words[1])
            other = self.turn(words[3], words[1]) if len(words) > 3 else {}
            form = add_form(dict(other), one, -ONE) if other else one
            self.springs.append((form, load.stiffness, load, None))
            return
        places = [self.model.pin_place(self.q, end)[:2] for end in words[1:3]]
        dx, dy = places[1][0] - places[0][0], places[1][1] - places[0][1]
        length = (dx * dx + dy * dy).sqrt()
        forms = []
        for factors in ((dx / length, dy / length), (-dy / length, dx / length)):
            form = {}
            for one, other, factor in zip(self.node(words[1]), self.node(words[2]), factors):
                add_form(form, other, factor)
                add_form(form, one, -factor)
            forms.append(form)
        self.springs.append((forms[0], load.stiffness, load, (forms[1], length)))

    # equations

    def _eliminate(self):
        """Every unknown as a form in those that stay free."""
        solved, self.follow = {}, []           # unknown: form in others; rows that follow from others
        for number, row in enumerate(self.rows):
            reduced = {}
            for k, value in row.items():
                add_form(reduced, solved[k], value) if k in solved else add_form(reduced, {k: value})
            size = max(abs(value) for value in reduced.values()) if reduced else ZERO
            if size < TINY:
                self.follow.append(number)
                continue
            pivot = max(reduced, key=lambda k: abs(reduced[k]))
            factor = reduced.pop(pivot)
            form = {k: -value / factor for k, value in reduced.items() if abs(value) > TINY * size}
            for other in solved.values():
                if pivot in other:
                    add_form(other, form, other.pop(pivot))
            solved[pivot] = form
        free = [k for k in range(self.count) if k not in solved]
        self.place_of = {k: i for i, k in enumerate(free)}
        self.forms = [solved.get(k, {k: ONE}) for k in range(self.count)]
        self.size = len(free)

    def free(self, form):
        """A form in the free unknowns, by their places."""
        result = {}
        for k, value in form.items():
            add_form(result, self.forms[k], value)
        return {self.place_of[k]: value for k, value in result.items() if value}

    def _end_forms(self, beam):
        ex, ey = beam.direction
        forms = []
        for node, turn in zip(beam.ends, beam.turns):
            forms.append(add_form({k: v * ex for k, v in node[0].items()}, node[1], ey))
            forms.append(add_form({k: -v * ey for k, v in node[0].items()}, node[1], ex))
            forms.append(dict(turn))
        return forms

    # matrices

    def prepare(self):
        """What does not depend on c; after axial forces are known, again."""
        add, free = self._add_to, self.free
        self.k0 = [[ZERO] * (i + 1) for i in range(self.size)]
        self.m0 = [[ZERO] * (i + 1) for i in range(self.size)]
        for beam in self.beams:
            beam.prepare(self.order)
            beam.forms = [free(form) for form in self._end_forms(beam)]
        for place, mass, _ in self.masses:
            if mass:
                for form in place:
                    form = free(form)
                    add(self.m0, form, form, mass)
        for turn, inertia, _ in self.inertias:
            if inertia:
                form = free(turn)
                add(self.m0, form, form, inertia)
        for form, stiffness, _, _ in self.springs:
            form = free(form)
            add(self.k0, form, form, stiffness)
        for one, other, value in self.second_order:
            one, other = free(one), free(other)
            add(self.k0, one, other, value)
            add(self.k0, other, one, value)
        return self

    @staticmethod
    def _add_to(matrix, one, other, value):
        """value * one other^T, lower half."""
        for i, a in one.items():
            a *= value
            row = matrix[i]
            for j, b in other.items():
                if j <= i:
                    row[j] += a * b

    def matrix(self, c):
        """Dynamic stiffness (lower half), the number of modes of beams with held ends below c, and the function without poles."""
        rows = [[k - c * m if m else k for k, m in zip(*pair)] for pair in zip(self.k0, self.m0)]
        below, function = 0, ONE
        for beam in self.beams:
            a, b, count, part = stretching(c, beam.length, beam.axial, beam.mass)
            bent, more, other = beam.bending(c, self.order)
            below += count + more
            function *= part * other
            one, _, _, two, _, _ = beam.forms
            self._add_to(rows, one, one, a)
            self._add_to(rows, two, two, a)
            self._add_to(rows, one, two, b)
            self._add_to(rows, two, one, b)
            across = [beam.forms[k] for k in (1, 2, 4, 5)]
            for i in range(4):
                for j in range(4):
                    self._add_to(rows, across[i], across[j], bent[i][j])
        return rows, below, function

    def count_below(self, c):
        """(number of eigenvalues below c, a function of c that vanishes at eigenvalues only)."""
        if not self.size:
            raise Failure("nothing that bends can move")
        rows, below, function = self.matrix(c)
        best = None
        for shift in range(min(4, self.size)):
            found = self._eliminate_symmetric(rows, shift)
            if best is None or found[2] > best[2]:
                best = found
            if best[2] > Decimal("1e-12"):
                break
        negative, product, _ = best
        if product == 0:
            raise ZeroDivisionError("at an eigenvalue")
        return below + negative, function * product

    def _eliminate_symmetric(self, lower, shift):
        """Number of negative pivots, their product, and the least of them, relative to its row: a part of the linkage may have the
        frequency of the whole, and then another order of the unknowns keeps the digits."""
        count = self.size
        if shift == 0:
            rows = [list(row) for row in lower]
        else:
            order = [(k * (count - 1) + shift) % count if shift % 2 else (k + shift) % count for k in range(count)]
            rows = [[lower[max(i, j)][min(i, j)] for j in order[:place + 1]] for place, i in enumerate(order)]
        sizes = [max(map(abs, row)) or ONE for row in rows]
        negative, product, least = 0, ONE, ONE
        for p in range(count - 1, -1, -1):
            row = rows.pop()
            pivot = row[p]
            if pivot == 0:
                return 0, ZERO, ZERO if p else least
            if p:                              # the last one may vanish
                least = min(least, abs(pivot) / sizes[p])
            negative += pivot < 0
            product *= pivot
            filled = [(j, row[j]) for j in range(p) if row[j]]
            for place, (i, value) in enumerate(filled):
                factor = value / pivot
                into = rows[i]
                for j, other in filled[:place + 1]:
                    into[j] -= factor * other
        return negative, product, least

    # loads

    def load(self, state):
        """Axial forces and terms of second order under the loads of a motion; `state` of the model, whose numbers are decimals.

        Rigid links move, the elastic linkage carries their inertia forces, weights, forces on pins and springs: a static solution
        with all drives held.
        """
        held = self if all(not drive["free"] for drive in self.deck.drives) else Structure(self.model, self.q, True, self.order)
        forces, loads = held._loads(state)
        if not any(forces) and not any(any(load) for load in loads):
            return self
        displacements = held._static(forces, loads)
        residual, tensions = held._residual(displacements, forces, loads)
        for beam, tension in zip(self.beams, tensions):
            beam.tension = tension if any(tension) else None
        self.second_order = self._second_order(state, held._multipliers(residual), displacements)
        return self

    def _loads(self, state):
        """Work of the loads on all unknowns but those of the beams, and on each beam (p0, p1 along, q0, q1 across, couple) a length."""
        model, forces = self.model, [ZERO] * self.count
        gx, gy = model.gravity

        def work(form, value):
            for k, factor in form.items():
                forces[k] += factor * value

        loads = []
        for beam in self.beams:
            body = model.bodies[beam.link]
            if body.ram is not None:
                raise Failure("a ram that bends under loads")
            ex, ey = beam.direction
            parts = []
            for along, offset in beam.places:
                (_, _, (ax, ay)), _ = model.point_motion(state, body, along, offset)
                parts.append((beam.mass * ((gx - ax) * ex + (gy - ay) * ey), beam.mass * ((gy - ay) * ex - (gx - ax) * ey)))
            loads.append((parts[0][0], parts[1][0], parts[0][1], parts[1][1], -beam.rotary * state.a[body.angle]))
        for place, mass, where in self.masses:
            ax, ay = self._acceleration(state, where)
            work(place[0], mass * (gx - ax))
            work(place[1], mass * (gy - ay))
        for turn, inertia, link in self.inertias:
            work(turn, -inertia * state.a[model.bodies[link].angle])
        for pin, force in model.forces.items():
            for form, value in zip(self.node(pin), force):
                work(form, value)
        for place, load in self.pushes:
            for form, value in zip(place, self._force(load, state)):
                work(form, value)
        for form, _, load, _ in self.springs:
            work(form, -self._pull(load, state))
        return forces, loads

    def _acceleration(self, state, where):
        if where[0] == "pin":
            return self.model.pin_motion(state, where[1])[2]
        return self.model.point_motion(state, self.model.bodies[where[1]], *where[2:])[0][2]

    @staticmethod
    def _force(load, state):
        """At a place of a link."""
        if load.sign or load.keys.get("axes", "global") != "global":
            raise Failure("a force without a potential")
        return load.effects(state)[0][1:]

    @staticmethod
    def _pull(load, state):
        """Tension or torque of a spring."""
        return load.tension + load.stiffness * load.deflection(state)

    @staticmethod
    def _end_loads(beam, load):
        """Work of loads along a beam on its ends, all else in equilibrium: along, across, turning at both."""
        p0, p1, q0, q1, couple = load
        if beam.still is None:
            beam.still = Polynomials(12, beam.length, beam.stiffness, beam.mass, beam.rotary, beam.shear)
        across = beam.still.condensed(ZERO, beam.still.loads(q0, q1, couple))[2]
        return [beam.length * (2 * p0 + p1) / 6, across[0], across[1], beam.length * (p0 + 2 * p1) / 6, across[2], across[3]]

    def _static(self, forces, loads):
        """Displacements of all unknowns."""
        self.prepare()
        rows, _, _ = self.matrix(ZERO)
        full = [[rows[max(i, j)][min(i, j)] for j in range(self.size)] for i in range(self.size)]
        right = [ZERO] * self.size

        def work(form, value):
            for k, factor in self.free(form).items():
                right[k] += factor * value

        for k, value in enumerate(forces):
            if value:
                work({k: ONE}, value)
        for beam, load in zip(self.beams, loads):
            for form, value in zip(self._end_forms(beam), self._end_loads(beam, load)):
                work(form, value)
        solution = dense.solve(dense.factor(full), right)
        return [sum((value * solution[self.place_of[j]] for j, value in form.items()), ZERO) for form in self.forms]

    def _residual(self, displacements, forces, loads):
        """What equations carry on every unknown, and the axial forces N0, N1, N2 of beams."""
        residual, tensions = [-force for force in forces], []

        def value(form):
            return sum((factor * displacements[k] for k, factor in form.items()), ZERO)

        for form, stiffness, _, _ in self.springs:
            pull = stiffness * value(form)
            for k, factor in form.items():
                residual[k] += factor * pull
        for beam, load in zip(self.beams, loads):
            forms = self._end_forms(beam)
            ends = [value(form) for form in forms]
            a = beam.axial / beam.length
            bent = beam.still.condensed(ZERO)[0]
            across = [ends[k] for k in (1, 2, 4, 5)]
            reaction = [a * (ends[0] - ends[3]), ZERO, ZERO, a * (ends[3] - ends[0]), ZERO, ZERO]
            for i, row in zip((1, 2, 4, 5), bent):
                reaction[i] = sum(factor * end for factor, end in zip(row, across))
            reaction = [one - other for one, other in zip(reaction, self._end_loads(beam, load))]
            for form, force in zip(forms, reaction):
                for k, factor in form.items():
                    residual[k] += factor * force
            p0, p1 = load[:2]
            tension = (-reaction[0], -beam.length * p0, -beam.length * (p1 - p0) / 2)
            if abs(sum(tension) - reaction[3]) > Decimal("1e-25") * (abs(reaction[0]) + abs(reaction[3]) + Decimal("1e-9")):
                raise Failure("axial forces out of balance")
            tensions.append(tension)
        return residual, tensions

    def _multipliers(self, residual):
        """Of the equations; those that follow from others have none."""
        numbers = [k for k in range(len(self.rows)) if k not in self.follow]
        rows = [self.rows[k] for k in numbers]
        products = [[sum((value * other[k] for k, value in row.items() if k in other), ZERO) for other in rows] for row in rows]
        right = [sum((value * residual[k] for k, value in row.items()), ZERO) for row in rows]
        found = dense.solve(dense.factor(products), right) if rows else []
        return dict(zip(numbers, found))

    def _second_order(self, state, multipliers, displacements):
        """(form, form, value): value times the product, both ways, is added to the stiffness."""
        terms, (gx, gy) = [], self.model.gravity

        def force_of(row):
            if row not in multipliers:
                raise Failure("forces that only elasticity of rigid links could tell")
            return multipliers[row]

        for contact in self.contacts:
            if self.deck.sliders[contact["slider"]]["link"] and "arm" not in contact:
                raise Failure("a block that does not turn on a guide that bends")
            cosine, sine = contact["direction"]
            slip = {}
            for form, other, factor in zip(contact["pin"], contact["node"], (cosine, sine)):
                add_form(slip, form, factor)
                add_form(slip, other, -factor)
            terms.append((slip, contact["turn"], force_of(contact["row"])))
        for record in self.bodies:
            total = record["inertia"] * state.v[self.model.bodies[record["link"]].angle]**2
            for (rx, ry), row in record["pins"]:
                total -= force_of(row) * rx + force_of(row + 1) * ry
            for contact in record.get("contacts", ()):
                cosine, sine = contact["direction"]
                force = force_of(contact["row"])
                total -= force * (cosine * contact["arm"][1] - sine * contact["arm"][0])
            for (rx, ry), mass, (link, along, offset) in record["loads"]:
                ax, ay = self._acceleration(state, ("body", link, along, offset))
                total += mass * ((gx - ax) * rx + (gy - ay) * ry)
            for (rx, ry), load in record.get("forces", ()):
                fx, fy = self._force(load, state)
                total += fx * rx + fy * ry
            terms.append((record["turn"], record["turn"], total / 2))
        for turn, inertia, link in self.blocks:    # centrifugal forces of a block's own parts turn with it
            terms.append((turn, turn, inertia * state.v[self.model.bodies[link].angle]**2 / 2))
        for form, stiffness, load, line in self.springs:
            if line:
                yields = sum((factor * displacements[k] for k, factor in form.items()), ZERO)
                terms.append((line[0], line[0], (self._pull(load, state) + stiffness * yields) / (2 * line[1])))
        return [term for term in terms if term[2]]

    # eigenvalues

    def eigenvalue(self, number, start, relative=Decimal("1e-27")):
        """The `number`-th positive eigenvalue and above, counted from 1 (all that are below count), proven by counts on both sides.

        start   a positive guess of the size
        """
        low = high = start
        while self.count_below(low)[0] >= number:
            high = low
            low /= 16
            if low < start * Decimal("1e-80"):
                raise Failure("an eigenvalue that is not positive")
        while self.count_below(high)[0] < number:
            low = high
            high *= 16
        while True:
            counts = self.count_below(low), self.count_below(high)
            if (counts[0][0], counts[1][0]) == (number - 1, number) and high / low - 1 < Decimal("1e-3"):
                break
            if high / low - 1 < relative:
                return (low + high) / 2        # of several at one place
            middle = (low * high).sqrt()
            if self.count_below(middle)[0] >= number:
                high = middle
            else:
                low = middle
        a, b, (fa, fb) = low, high, (counts[0][1], counts[1][1])
        for _ in range(60):
            c = b - fb * (b - a) / (fb - fa) if fb != fa else b
            if abs(c - b) < b * relative / 1000:
                break
            if not low < c < high:
                c = (low + high) / 2
            try:
                below, fc = self.count_below(c)
            except ZeroDivisionError:
                b = c                          # the eigenvalue itself
                break
            if below >= number:
                high = c
            else:
                low = c
            a, fa, b, fb = b, fb, c, fc
        if self.count_below(b * (1 - relative))[0] != number - 1 or self.count_below(b * (1 + relative))[0] != number:
            raise Failure("an eigenvalue whose count is not proven")
        return b

    def frequencies(self, modes, guess=None):
        """The lowest in Hz; free motions are 0."""
        free = self.free_motions()
        if self.count_below(Decimal("-1e-20"))[0]:
            raise Failure("negative eigenvalues")
        result, start = [ZERO] * min(free, modes), Decimal(guess or 10000)
        for number in range(len(result) + 1, modes + 1):
            start = self.eigenvalue(number, start * Decimal("1.0001"))
            result.append(start.sqrt() / (2 * Digits.pi))
        return result

    def free_motions(self):
        """Motions without elastic energy."""
        return self.count_below(Decimal("1e-20"))[0]


def frequency_to_eigenvalue(frequency):
    """Negative frequencies stand for negative eigenvalues."""
    value = (2 * Digits.pi * frequency)**2
    return value if frequency >= 0 else -value
