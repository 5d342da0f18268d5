"""Steady motion of running linkages of beams, in displacements of nodes, independent of the program that is tested.

Unknowns are global displacements and rotations of the ends of links and amplitudes of bubbles between them, at the samples of a turn;
derivatives are those of trigonometric polynomials.  Every link has its inertia force in its own rotating axes, K_G of the axial
forces of the rigid motion (from a balance of forces link by link), and EI, EA.  Springs, constant tensions and dampers act between
pins, ground points and ends of links.  Nothing is shared with the deformation coordinates of the program but the physics.

Used by running_checks.py.
"""
import numpy as np

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def spectral(n):
    """Matrix of d/dtheta for n (odd) samples of a turn."""
    k = np.arange(n)
    with np.errstate(divide="ignore"):
        d = 0.5 * (-1.0) ** (k[:, None] - k[None, :]) / np.sin(np.pi * (k[:, None] - k[None, :]) / n)
    d[np.diag_indices(n)] = 0.0
    return d


class Shapes:
    """Displacements (u, v) of a link of unit length: ends (u1 v1 f1 u2 v2 f2), then bubbles along and across."""

    def __init__(self, length, along, across):
        self.length, self.along, self.across = length, along, across
        self.size = 6 + along + across
        p, legendre = np.polynomial.Polynomial, np.polynomial.Legendre
        u, v = [p([0])] * self.size, [p([0])] * self.size
        u[0], u[3] = p([1, -1]), p([0, 1])
        v[1], v[2] = p([1, 0, -3, 2]), p([0, 1, -2, 1]) * length
        v[4], v[5] = p([0, 0, 3, -2]), p([0, 0, -1, 1]) * length
        for k in range(along):
            u[6 + k] = p([0, 1, -1]) * legendre.basis(k, domain=[0, 1]).convert(kind=p, domain=[-1, 1])
        for k in range(across):
            v[6 + along + k] = p([0, 0, 1, -2, 1]) * legendre.basis(k, domain=[0, 1]).convert(kind=p, domain=[-1, 1])
        self.polynomials = [u, [q.deriv() for q in u], v, [q.deriv() for q in v], [q.deriv(2) for q in v]]
        x, w = np.polynomial.legendre.leggauss(2 * (across + 6))
        self.x, self.w = (x + 1) / 2 * length, w / 2 * length
        self.fields = [self.at(s) for s in self.x]

    def at(self, x):
        """Rows u, v and derivatives u', v', v'' at x."""
        length, s = self.length, x / self.length
        u, du, v, dv, ddv = (np.array([q(s) for q in row]) for row in self.polynomials)
        return {"u": u, "du": du / length, "v": v, "dv": dv / length, "ddv": ddv / length**2}

    def integral(self, one, other, weight=None):
        weight = np.ones_like(self.x) if weight is None else weight
        return sum(w * f * np.outer(at[one], at[other]) for w, f, at in zip(self.w, weight, self.fields))


class Link:
    def __init__(self, ends, mass, axial, bending, along=6, across=9, damping=0.0):
        self.ends, self.mass, self.axial, self.bending, self.damping = ends, mass, axial, bending, damping
        self.numbers = along, across


class Running:
    """A linkage at samples of a turn: places of its pins, links between them; pins without an entry in `free` do not move.

    pins:    name -> (samples, 2) places of the rigid motion
    slides:  name -> unit vector along which the pin may move (a block on a line of the ground)
    clamped: (link, end) with no rotation;  masses: pin -> mass;  welds: pairs of (link, end) that turn together
    pulls:   dicts with stiffness, rest, tension, damping and ends=(pin or place, pin or place),
             or turning=((link, end), (link, end) or None) for couples
    blocks:  dicts with the pin of a block on a straight chain of links, `on` (their numbers, in order) and its moment of inertia,
             which turns with the chain: the place under it passes from link to link, and a multiplier at every sample keeps the
             block on the chain
    """

    def __init__(self, speed, pins, grounds, links, clamped, slides=None, masses=None, pulls=(), welds=(), blocks=()):
        self.blocks = list(blocks)
        self.speed, self.pins, self.grounds, self.links = speed, dict(pins), grounds, links
        self.slides, self.masses, self.pulls = slides or {}, masses or {}, list(pulls)
        self.welds = list(welds)
        turns_with = {second: first for first, second in self.welds}
        self.n = len(next(iter(pins.values())))
        self.d = spectral(self.n)
        for name, place in grounds.items():
            self.pins[name] = np.tile(np.asarray(place, float), (self.n, 1))
        self.velocity = {k: self.d @ p for k, p in self.pins.items()}
        self.acceleration = {k: self.d @ v for k, v in self.velocity.items()}
        self.count = 0
        self.at = {}
        for name in pins:
            wide = 1 if name in self.slides else 2
            self.at[name] = range(self.count, self.count + wide)
            self.count += wide
        for i, link in enumerate(links):
            way = self.pins[link.ends[1]] - self.pins[link.ends[0]]
            link.length = np.linalg.norm(way[0])
            link.e = way / link.length
            link.shape = Shapes(link.length, *link.numbers)
            link.h = np.einsum("ki,ki->k", link.e @ TURN.T, self.d @ link.e)
            link.slope = self.d @ link.h
            for end in range(2):
                if (i, end) in turns_with:
                    self.at[i, end] = self.at[turns_with[i, end]]
                elif (i, end) not in clamped:
                    self.at[i, end] = range(self.count, self.count + 1)
                    self.count += 1
            self.at[i] = range(self.count, self.count + link.shape.size - 6)
            self.count += link.shape.size - 6

    # --- rows: what unknowns do, (samples, values, unknowns)

    def pin_rows(self, name):
        rows = np.zeros((self.n, 2, self.count))
        if name in self.at:
            if name in self.slides:
                rows[:, :, self.at[name][0]] = self.slides[name]
            else:
                rows[:, 0, self.at[name][0]] = rows[:, 1, self.at[name][1]] = 1.0
        return rows

    def turn_row(self, i, end):
        row = np.zeros((self.n, self.count))
        if (i, end) in self.at:
            row[:, self.at[i, end][0]] = 1.0
        return row

    def local_rows(self, i):
        link = self.links[i]
        rows = np.zeros((self.n, link.shape.size, self.count))
        normal = link.e @ TURN.T
        for end in range(2):
            move = self.pin_rows(link.ends[end])
            rows[:, 3 * end] = np.einsum("ka,kaj->kj", link.e, move)
            rows[:, 3 * end + 1] = np.einsum("ka,kaj->kj", normal, move)
            rows[:, 3 * end + 2] = self.turn_row(i, end)
        for k, j in enumerate(self.at[i]):
            rows[:, 6 + k, j] = 1.0
        return rows

    def block_rows(self, block):
        """Of a block and the chain under it: number of the link, place along it, rows of the distance of both across the chain,
        of how far the block is ahead, and of the rotation of the chain there."""
        chain = [self.links[i] for i in block["on"]]
        ends = np.cumsum([0.0] + [link.length for link in chain])
        e, place = chain[0].e, self.pins[block["pin"]]
        along = np.einsum("ka,ka->k", e, place - self.pins[chain[0].ends[0]])
        which = np.clip(np.searchsorted(ends, along) - 1, 0, len(chain) - 1)
        pin, normal = self.pin_rows(block["pin"]), e @ TURN.T
        across, ahead = (np.einsum("ka,kaj->kj", way, pin) for way in (normal, e))
        turn = np.zeros_like(across)
        for at, i in enumerate(block["on"]):
            rows = self.local_rows(i)
            for k in np.nonzero(which == at)[0]:
                here = self.links[i].shape.at(along[k] - ends[at])
                across[k] -= here["v"] @ rows[k]
                ahead[k] -= here["u"] @ rows[k]
                turn[k] = here["dv"] @ rows[k]
        return np.array(block["on"])[which], along - ends[which], across, ahead, turn

    def pull_rows(self, pull):
        """Length (or angle), its rate, row of the stretch, row across, direction."""
        if "turning" in pull:
            (i, end), other = pull["turning"]
            row, rate = self.turn_row(i, end), self.links[i].h
            if other:
                row, rate = row - self.turn_row(*other), rate - self.links[other[0]].h
            return None, rate, row, None, None
        place = [self.pins[p] for p in pull["ends"]]
        way = place[1] - place[0]
        length = np.linalg.norm(way, axis=1)
        a = way / length[:, None]
        move = self.pin_rows(pull["ends"][1]) - self.pin_rows(pull["ends"][0])
        rate = np.einsum("ka,ka->k", a, self.velocity[pull["ends"][1]] - self.velocity[pull["ends"][0]])
        return length, rate, np.einsum("ka,kaj->kj", a, move), np.einsum("ka,kaj->kj", a @ TURN.T, move), a

    def force_of(self, pull, unit=False):
        """What it pulls in the rigid motion."""
        length, rate, *_ = self.pull_rows(pull)
        if unit:
            return np.ones(self.n)
        force = self.speed * pull.get("damping", 0.0) * rate + pull.get("tension", 0.0)
        if pull.get("stiffness"):
            force = force + pull["stiffness"] * (length - pull["rest"])
        return force

    # --- statics of the rigid motion

    def axial(self, loads, inertia):
        """N at the stations of every link, under forces of pulls [(pull, force)], with or without inertia loads."""
        n, links = self.n, self.links
        names = [p for p in self.pins if p in self.at or p in {e for l in links for e in l.ends}]
        unknown, index = 0, {}
        for i, link in enumerate(links):
            for end in range(2):
                index[i, end] = unknown           # force of the pin on the link
                unknown += 2
        guides = {p: unknown + k for k, p in enumerate(self.slides)}
        unknown += len(guides)
        index["torque"] = unknown
        unknown += 1 + len(self.welds)
        under = [self.block_rows(block) for block in self.blocks]
        index["blocks"] = unknown
        unknown += len(self.blocks)
        matrix, right, row = np.zeros((n, unknown, unknown)), np.zeros((n, unknown)), 0
        couples = np.zeros((n, len(links)))
        forces = {p: np.zeros((n, 2)) for p in self.pins}
        for pull, force in loads:
            if "turning" in pull:
                (i, _), other = pull["turning"]
                couples[:, i] -= force
                if other:
                    couples[:, other[0]] += force
            else:
                a = self.pull_rows(pull)[4]
                forces[pull["ends"][0]] += force[:, None] * a
                forces[pull["ends"][1]] -= force[:, None] * a
        field = {}
        for i, link in enumerate(links):
            a0, a1 = (self.speed**2 * self.acceleration[e] if inertia else np.zeros((n, 2)) for e in link.ends)
            field[i] = [-link.mass * ((1 - x / link.length) * a0 + x / link.length * a1) for x in link.shape.x]
            total = sum(w * f for w, f in zip(link.shape.w, field[i]))
            moment = sum(w * x * (link.e[:, 0] * f[:, 1] - link.e[:, 1] * f[:, 0])
                         for w, x, f in zip(link.shape.w, link.shape.x, field[i]))
            for a in range(2):
                matrix[:, row + a, index[i, 0] + a] = matrix[:, row + a, index[i, 1] + a] = 1.0
                right[:, row + a] = -total[:, a]
            matrix[:, row + 2, index[i, 1]] = -link.length * link.e[:, 1]
            matrix[:, row + 2, index[i, 1] + 1] = link.length * link.e[:, 0]
            right[:, row + 2] = -moment - couples[:, i]
            if i == 0:
                matrix[:, row + 2, index["torque"]] = 1.0
            for k, (block, rows) in enumerate(zip(self.blocks, under)):
                # The chain is pressed by -R across it, and turns the block.
                here = rows[0] == i
                matrix[here, row:row + 2, index["blocks"] + k] = -(link.e @ TURN.T)[here]
                matrix[here, row + 2, index["blocks"] + k] = -rows[1][here]
                if inertia:
                    right[here, row + 2] += block["inertia"] * self.speed**2 * link.slope[here]
            for k, ((first, _), (second, _)) in enumerate(self.welds):
                matrix[:, row + 2, index["torque"] + 1 + k] = (i == first) * 1.0 - (i == second) * 1.0
            row += 3
        for p in names:
            if p not in self.at:
                continue
            for a in range(2):
                for i, link in enumerate(links):
                    for end in range(2):
                        if link.ends[end] == p:
                            matrix[:, row + a, index[i, end] + a] = -1.0
                if p in guides:
                    matrix[:, row + a, guides[p]] = (TURN @ self.slides[p])[a]
                for k, block in enumerate(self.blocks):
                    if p == block["pin"]:
                        matrix[:, row + a, index["blocks"] + k] = (self.links[block["on"][0]].e @ TURN.T)[:, a]
                right[:, row + a] = -forces[p][:, a]
                if inertia:
                    right[:, row + a] += self.masses.get(p, 0.0) * self.speed**2 * self.acceleration[p][:, a]
            row += 2
        found = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        result = []
        for i, link in enumerate(links):
            end = np.einsum("ka,ka->k", link.e, found[:, index[i, 1]:index[i, 1] + 2])
            # The field is linear along the link: its integral beyond x is exact in closed form.
            f0, f1 = (np.einsum("ka,ka->k", link.e, -link.mass * (self.speed**2 * self.acceleration[e] if inertia else np.zeros((n, 2))))
                      for e in link.ends)
            result.append([end + f0 * (link.length - x - (link.length**2 - x**2) / (2 * link.length)) +
                           f1 * (link.length**2 - x**2) / (2 * link.length) for x in link.shape.x])
        self.press = found[:, index["blocks"]:]
        return result, found[:, index["torque"]]

    def geometric(self, axial, pulls):
        """K_G (samples, unknowns, unknowns) of axial forces and of what pulls along lines."""
        total = np.zeros((self.n, self.count, self.count))
        for i, link in enumerate(self.links):
            local = sum(w * f[:, None, None] * np.outer(at["dv"], at["dv"])
                        for w, f, at in zip(link.shape.w, axial[i], link.shape.fields))
            rows = self.local_rows(i)
            total += rows.transpose(0, 2, 1) @ local @ rows
        for pull, force in pulls:
            length, _, _, across, _ = self.pull_rows(pull)
            if across is not None:
                total += (force / length)[:, None, None] * across[:, :, None] * across[:, None, :]
        return total

    # --- the equation of motion

    def solve(self, at_rest=False):
        """The periodic motion; at rest, the deflection under the same loads as if the linkage were frozen."""
        n, m, d, speed = self.n, self.count, self.d, self.speed
        d2 = d @ d
        moves = 0.0 if at_rest else 1.0
        forces = [(p, self.force_of(p)) for p in self.pulls]
        axial, self.rigid_torque = self.axial(forces, True)
        stiffness = self.geometric(axial, forces)
        matrix = np.zeros((n, m, n, m))
        load = np.zeros((n, m))
        apart = []
        for j, block in enumerate(self.blocks):
            _, _, across, ahead, turn = self.block_rows(block)
            apart.append(across)
            product = self.press[:, j, None, None] * ahead[:, :, None] * turn[:, None, :]
            stiffness += product + product.transpose(0, 2, 1)
            if block["inertia"]:
                matrix += moves * block["inertia"] * speed**2 * np.einsum("ki,kl,lj->kilj", turn, d2, turn, optimize=True)
                load -= block["inertia"] * speed**2 * self.links[block["on"][0]].slope[:, None] * turn
        for i, link in enumerate(self.links):
            shape, rows = link.shape, self.local_rows(i)
            mass = link.mass * (shape.integral("u", "u") + shape.integral("v", "v"))
            swing = link.mass * (shape.integral("v", "u") - shape.integral("u", "v"))
            elastic = link.axial * shape.integral("du", "du") + link.bending * shape.integral("ddv", "ddv")
            stiffness += rows.transpose(0, 2, 1) @ elastic @ rows
            # R^T (R N q)'' = N q'' + 2 h E N q' + (h' E - h^2) N q
            outer = rows.transpose(0, 2, 1)
            q2 = d2[:, None, :, None] * rows.transpose(1, 0, 2)[None]
            q1 = d[:, None, :, None] * rows.transpose(1, 0, 2)[None]
            term = link.damping / speed * np.einsum("ab,kblj->kalj", elastic, q1)
            term += np.einsum("ab,kblj->kalj", mass, q2) + 2 * link.h[:, None, None, None] * np.einsum("ab,kblj->kalj", swing, q1)
            matrix += moves * speed**2 * np.einsum("kia,kalj->kilj", outer, term, optimize=True)
            here = link.slope[:, None, None] * swing - link.h[:, None, None]**2 * mass
            stiffness += moves * speed**2 * outer @ here @ rows
            a0, a1 = (speed**2 * self.acceleration[e] for e in link.ends)
            normal = link.e @ TURN.T
            for w, x, at in zip(shape.w, shape.x, shape.fields):
                a = (1 - x / link.length) * a0 + x / link.length * a1
                local = np.einsum("ka,ka->k", link.e, a)[:, None] * at["u"] + np.einsum("ka,ka->k", normal, a)[:, None] * at["v"]
                load -= w * link.mass * np.einsum("ka,kaj->kj", local, rows)
        for pin, heavy in self.masses.items():
            rows = self.pin_rows(pin)
            matrix += moves * heavy * speed**2 * np.einsum("kai,kl,laj->kilj", rows, d2, rows, optimize=True)
            load -= heavy * speed**2 * np.einsum("ka,kaj->kj", self.acceleration[pin], rows)
        for pull, force in forces:
            _, _, row, _, _ = self.pull_rows(pull)
            load -= force[:, None] * row
            if pull.get("stiffness"):
                stiffness += pull["stiffness"] * row[:, :, None] * row[:, None, :]
            if pull.get("damping"):
                matrix += moves * pull["damping"] * speed * np.einsum("ki,kl,lj->kilj", row, d, row, optimize=True)
        for k in range(n):
            matrix[k, :, k, :] += stiffness[k]
        if self.blocks:
            self.y = held(matrix.reshape(n * m, n * m), load.reshape(n * m), np.array(apart).swapaxes(0, 1))
        else:
            self.y = np.linalg.solve(matrix.reshape(n * m, n * m), load.reshape(n * m)).reshape(n, m)
        return self.y

    def matrices(self):
        """(M, D, K) and load at the samples of the turn: M U'' + D U' + K U = f, ' = d/dt."""
        n, m, d, speed = self.n, self.count, self.d, self.speed
        mass, rates, stiffness = (np.zeros((n, m, m)) for _ in range(3))
        load = np.zeros((n, m))
        forces = [(p, self.force_of(p)) for p in self.pulls]
        stiffness += self.geometric(self.axial(forces, True)[0], forces)
        for i, link in enumerate(self.links):
            shape, rows = link.shape, self.local_rows(i)
            first, outer = np.einsum("kl,laj->kaj", d, rows), rows.transpose(0, 2, 1)
            second = np.einsum("kl,laj->kaj", d, first)
            of_mass = link.mass * (shape.integral("u", "u") + shape.integral("v", "v"))
            swing = link.mass * (shape.integral("v", "u") - shape.integral("u", "v"))
            elastic = link.axial * shape.integral("du", "du") + link.bending * shape.integral("ddv", "ddv")
            h, slope = link.h[:, None, None], link.slope[:, None, None]
            mass += outer @ of_mass @ rows
            rates += outer @ (speed * (2 * of_mass @ first + 2 * h * swing @ rows) + link.damping * elastic @ rows)
            stiffness += outer @ (elastic @ rows + speed * link.damping * elastic @ first)
            stiffness += speed**2 * outer @ (of_mass @ second + 2 * h * swing @ first + (slope * swing - h**2 * of_mass) @ rows)
            normal = link.e @ TURN.T
            for w, x, at in zip(shape.w, shape.x, shape.fields):
                a = sum(share * speed**2 * self.acceleration[e] for share, e in zip((1 - x / link.length, x / link.length), link.ends))
                local = np.einsum("ka,ka->k", link.e, a)[:, None] * at["u"] + np.einsum("ka,ka->k", normal, a)[:, None] * at["v"]
                load -= w * link.mass * np.einsum("ka,kaj->kj", local, rows)
        for pin, heavy in self.masses.items():
            rows = self.pin_rows(pin)
            mass += heavy * rows.transpose(0, 2, 1) @ rows
            load -= heavy * speed**2 * np.einsum("ka,kaj->kj", self.acceleration[pin], rows)
        for pull, force in forces:
            row = self.pull_rows(pull)[2]
            load -= force[:, None] * row
            stiffness += pull.get("stiffness", 0.0) * row[:, :, None] * row[:, None, :]
            rates += pull.get("damping", 0.0) * row[:, :, None] * row[:, None, :]
            stiffness += speed * pull.get("damping", 0.0) * row[:, :, None] * (d @ row)[:, None, :]
        return mass, rates, stiffness, load

    def integrate(self, instants, steps):
        """Displacements of a turn from rest, undeformed, at the instants: Radau's method of three stages, order 5."""
        n, m = self.n, self.count
        terms = np.concatenate([a.reshape(n, -1) for a in self.matrices()], axis=1)
        waves = np.fft.rfft(terms, axis=0) / n
        waves[1:] *= 2
        root = np.sqrt(6)
        node = np.array([(4 - root) / 10, (4 + root) / 10, 1.0])
        rule = np.array([[(88 - 7 * root) / 360, (296 - 169 * root) / 1800, (-2 + 3 * root) / 225],
                         [(296 + 169 * root) / 1800, (88 + 7 * root) / 360, (-2 - 3 * root) / 225],
                         [(16 - root) / 36, (16 + root) / 36, 1 / 9]])
        length = 2 * np.pi / (self.speed * instants * steps)
        u, v, found = np.zeros(m), np.zeros(m), [np.zeros(m)]
        for k in range(instants * steps):
            left, right = np.zeros((3 * m, 3 * m)), np.zeros(3 * m)
            for i in range(3):
                angle = self.speed * length * (k + node[i])
                now = (np.exp(1j * angle * np.arange(len(waves))) @ waves).real
                mass, rates, stiffness = (now[j * m * m:(j + 1) * m * m].reshape(m, m) for j in range(3))
                # Unknowns are accelerations at the stages.
                here = slice(i * m, (i + 1) * m)
                left[here, here] += mass
                for j in range(3):
                    there = slice(j * m, (j + 1) * m)
                    left[here, there] += length * rule[i, j] * rates + length**2 * (rule @ rule)[i, j] * stiffness
                right[here] = now[3 * m * m:] - rates @ v - stiffness @ (u + length * node[i] * v)
            a = np.linalg.solve(left, right).reshape(3, m)
            u = u + length * v + length**2 * (rule[2] @ (rule @ a))
            v = v + length * rule[2] @ a
            if (k + 1) % steps == 0:
                found.append(u)
        return np.array(found)

    def displacement(self, pin):
        return np.einsum("kaj,kj->ka", self.pin_rows(pin), self.y)

    def rotation(self, i, end):
        return np.einsum("kj,kj->k", self.turn_row(i, end), self.y)

    def strains(self, i, x):
        """Axial strain and curvature."""
        at = self.links[i].shape.at(x)
        q = np.einsum("kaj,kj->ka", self.local_rows(i), self.y)
        return q @ at["du"], q @ at["ddv"]

    def lost_power(self):
        """Mean of c (rate of a damper)^2 up to the second order of the deformations, and of the rigid motion alone."""
        whole = rigid = 0.0
        for pull in self.pulls:
            if not pull.get("damping"):
                continue
            _, rate, row, _, _ = self.pull_rows(pull)
            unit = self.force_of(pull, unit=True)
            form = self.geometric(self.axial([(pull, unit)], False)[0], [(pull, unit)])
            w = self.d @ np.einsum("kj,kj->k", row, self.y)
            energy = self.d @ np.einsum("ki,kij,kj->k", self.y, form, self.y)
            scale = pull["damping"] * self.speed**2
            whole += scale * np.mean(rate**2 + 2 * rate * w + w**2 + rate * energy)
            rigid += scale * np.mean(rate**2)
        return whole, rigid


def held(matrix, load, apart):
    """Unknowns at the samples of which some sums, `apart`, are zero at each: in a basis of those for which they are."""
    n, constraints, m = apart.shape
    # The last rows of an orthogonal matrix: they are across all sums.
    rest = np.array([np.linalg.svd(sums)[2][constraints:].T for sums in apart])
    matrix, right = matrix.reshape(n, m, n, m), np.einsum("ki,kia->ka", load.reshape(n, m), rest)
    left = m - constraints
    whole = np.einsum("kia,kilj,ljb->kalb", rest, matrix, rest, optimize=True)
    z = np.linalg.solve(whole.reshape(n * left, n * left), right.reshape(n * left)).reshape(n, left)
    return np.einsum("kia,ka->ki", rest, z)


def circle_point(first, second, a, b, side):
    """Pin at distances a, b from two others, to the left (1) or right (-1) of the way from the first to the second."""
    way = second - first
    apart = np.linalg.norm(way, axis=1)
    along = (apart**2 + a**2 - b**2) / (2 * apart)
    across = np.sqrt(a**2 - along**2)
    e = way / apart[:, None]
    return first + along[:, None] * e + side * across[:, None] * (e @ TURN.T)
