"""Random machines, and decks that describe the same machine otherwise: turned, mirrored, in other units, with other names and another
order of cards, links named from the other end, cut by a POINT that carries nothing, or divided into two welded halves.

A Machine has numbers in SI and degrees, and everything at its place in the drawing.  A View says how a deck shows it.
"""
import math
import random

UNITS = {("m", "kg", "s"): (1.0, 1.0, 1.0), ("mm", "kg", "s"): (1e-3, 1.0, 1.0), ("mm", "tonne", "s"): (1e-3, 1e3, 1.0),
         ("in", "slinch", "s"): (0.0254, 0.45359237 * 9.80665 / 0.0254, 1.0), ("cm", "g", "s"): (1e-2, 1e-3, 1.0),
         ("m", "tonne", "ms"): (1.0, 1e3, 1e-3)}
ALONE = ("turned", "mirrored", "units", "names", "order", "lengths", "reversed", "idle", "halves")
HALF = "half"                                      # ends the name of the second half of a link


def turned(x, y, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return c * x - s * y, s * x + c * y


def crossing(a, ra, b, rb, side):
    """Where circles about two places meet, to the left (1) or right (-1) of the way from a to b; None: nowhere."""
    d = math.dist(a, b)
    x = (d * d + ra * ra - rb * rb) / (2 * d)
    if ra * ra - x * x < 0.0:
        return None
    y = side * math.sqrt(ra * ra - x * x)
    ex, ey = (b[0] - a[0]) / d, (b[1] - a[1]) / d
    return a[0] + x * ex - y * ey, a[1] + x * ey + y * ex


def between(p, q, share):
    return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])


class Machine:
    """One linkage with its loads and the reports of a family; None of its parts depends on a View."""

    def __init__(self, seed, family, kind=None):
        self.random = r = random.Random(f"{seed} {family}")
        self.seed, self.family = seed, family
        self.places, self.grounds, self.links, self.points, self.guides = {}, [], {}, {}, {}
        self.sliders, self.loads, self.gauges, self.keys = [], [], {}, {}
        self.angle = 0.0
        self.kind = kind or r.choice(KINDS[family])
        while not self.build():
            self.places, self.grounds, self.links, self.points, self.guides, self.sliders = {}, [], {}, {}, {}, []
        FAMILIES[family](self)

    # geometry

    def build(self):
        r, size = self.random, self.random.choice((1.0, 0.3))
        self.angle = round(r.uniform(0, 360), 2)
        self.size = size
        crank = size * round(r.uniform(0.08, 0.14), 4)
        self.ground("O2", 0.0, 0.0)
        self.crank_length = crank
        self.place("A", *turned(crank, 0.0, self.angle))
        self.link("crank", "O2 A")
        return getattr(self, "build_" + self.kind)(crank, size)

    def build_four_bar(self, crank, size):
        r = self.random
        d, l3, l4 = (size * round(r.uniform(0.2, 0.36), 4) for _ in range(3))
        lengths = sorted((d, l3, l4))
        if crank + lengths[2] > 0.93 * (lengths[0] + lengths[1]):
            return False
        side = r.choice((1, -1))
        o4 = turned(d, 0.0, r.choice((0.0, round(r.uniform(-40, 40), 3))))
        for k in range(360):
            a = turned(crank, 0.0, k)
            b = crossing(a, l3, o4, l4, side)
            if b is None:
                return False
            cross = (b[0] - a[0]) * (b[1] - o4[1]) - (b[1] - a[1]) * (b[0] - o4[0])
            if abs(cross) < 0.35 * l3 * l4:
                return False
        self.ground("O4", *o4)
        self.place("B", *crossing(self.places["A"], l3, o4, l4, side))
        self.link("coupler", "A B")
        self.link("follower", "O4 B")
        return True

    def build_elbow(self, crank, size):
        """A four-bar whose coupler goes on past B, or turns before it."""
        if not self.build_four_bar(crank, size):
            return False
        r, a, b = self.random, self.places["A"], self.places["B"]
        c = between(a, b, r.uniform(0.6, 1.3))
        off = turned(b[0] - a[0], b[1] - a[1], 90 * r.choice((1, -1)))
        h = r.choice((0.0, r.uniform(0.3, 0.6))) if c != b else 0.4
        self.place("C", c[0] + h * off[0], c[1] + h * off[1])
        self.links["coupler"]["pins"] = r.choice((["A", "B", "C"], ["A", "C", "B"], ["A", "B", "C", "A"] if h else ["A", "B", "C"]))
        if h == 0.0 and math.dist(a, c) < math.dist(a, b):
            self.links["coupler"]["pins"] = ["A", "C", "B"]
        elif h == 0.0:
            self.links["coupler"]["pins"] = ["A", "B", "C"]
        return True

    def build_six_bar(self, crank, size):
        """A rod from a pin of the coupler to a block on a guide."""
        if not self.build_elbow(crank, size):
            return False
        r, c = self.random, self.places["C"]
        direction = r.uniform(0, 360)
        far = turned(0.9 * size, 0.2 * size, direction)
        foot = (c[0] + far[0], c[1] + far[1])
        guide = round(direction + r.uniform(-15, 15), 2)
        self.guides["bed"] = (foot[0], foot[1], guide)
        e = turned(1.0, 0.0, guide)
        dx, dy = foot[0] - c[0], foot[1] - c[1]
        h = e[0] * dy - e[1] * dx
        length = 0.8 * size
        if abs(h) > 0.6 * length:
            return False
        along = -(e[0] * dx + e[1] * dy) + math.sqrt(length**2 - h * h)
        self.place("D", foot[0] + along * e[0], foot[1] + along * e[1])
        self.link("rod", "C D")
        self.slider("D", "bed")
        return True

    def build_slider_crank(self, crank, size):
        r = self.random
        rod, offset = size * round(r.uniform(0.3, 0.5), 4), size * r.choice((0.0, round(r.uniform(-0.05, 0.05), 4)))
        guide = r.choice((0.0, 90.0, round(r.uniform(-180, 180), 2)))
        normal = turned(0.0, offset, guide)
        self.guides["bed"] = (normal[0], normal[1], guide)
        a, e = self.places["A"], turned(1.0, 0.0, guide)
        dx, dy = normal[0] - a[0], normal[1] - a[1]
        h = e[0] * dy - e[1] * dx
        along = -(e[0] * dx + e[1] * dy) + r.choice((1, -1)) * math.sqrt(rod**2 - h * h)
        self.place("B", normal[0] + along * e[0], normal[1] + along * e[1])
        self.link("rod", "A B")
        self.slider("B", "bed")
        return True

    def build_quick_return(self, crank, size):
        """The crank's pin on a block that slides along a lever, whose end moves a rod and a block."""
        r = self.random
        o4 = (0.0, -size * round(r.uniform(0.18, 0.3), 4))
        self.ground("O4", *o4)
        a = self.places["A"]
        direction = math.degrees(math.atan2(a[1] - o4[1], a[0] - o4[0]))
        reach = turned(1.25 * (crank - o4[1]), 0.0, direction)
        self.place("C", o4[0] + reach[0], o4[1] + reach[1])
        self.link("lever", "O4 C")
        self.slider("A", "lever", mass=r.choice((0.0, 0.02)))
        if r.random() < 0.6:
            y = o4[1] + 1.3 * (crank - o4[1])
            self.guides["bed"] = (0.0, y, 0.0)
            c = self.places["C"]
            rod = 0.5 * size
            self.place("D", c[0] + math.sqrt(rod**2 - (y - c[1])**2), y)
            self.link("rod", "C D")
            self.slider("D", "bed")
        return True

    def ground(self, name, x, y):
        self.places[name] = (x, y)
        self.grounds.append(name)

    def place(self, name, x, y):
        self.places[name] = (x, y)

    def link(self, name, pins):
        self.links[name] = {"pins": pins.split(), "rigid": False, "body": None}

    def slider(self, pin, guide, mass=None):
        self.sliders.append({"pin": pin, "guide": guide, "mass": self.random.choice((0.0, 0.3)) if mass is None else mass})

    # loads

    def on_axis(self, name, share):
        """A place on a link, at a share of its first straight way."""
        pins = self.links[name]["pins"]
        return between(self.places[pins[0]], self.places[pins[1]], share)

    def add(self, *load):
        self.loads.append(load)

    def moving(self):
        return [pin for pin in self.places if pin not in self.grounds]

    def common_loads(self, share=0.35):
        """What all families take: weights, forces, torques, masses."""
        r = self.random
        if r.random() < 0.5:
            self.add("GRAVITY", *(turned(9.81, 0.0, r.choice((-90.0, r.uniform(0, 360))))))
        for pin in self.moving():
            if r.random() < share:
                self.add("FORCE", pin, r.uniform(-5, 5), r.uniform(-5, 5))
            if r.random() < share:
                self.add("PINMASS", pin, r.uniform(0.01, 0.1))
        for name in self.links:
            if r.random() < share and name != "crank":
                self.add("TORQUE", name, r.uniform(-0.5, 0.5))

    def add_masses(self):
        r = self.random
        for name in self.links:
            if r.random() < 0.25 and not self.slotted(name):
                x, y = self.on_axis(name, r.uniform(0.2, 0.8))
                e = 0.0 if r.random() < 0.5 else r.uniform(-0.02, 0.02) * self.size
                pins = self.links[name]["pins"]
                p, q = self.places[pins[0]], self.places[pins[1]]
                d = math.dist(p, q)
                self.add("MASS", name, r.uniform(0.01, 0.1), x - e * (q[1] - p[1]) / d, y + e * (q[0] - p[0]) / d,
                         r.choice((0.0, 1e-5)))

    def slotted(self, name):
        return any(slider["guide"] == name for slider in self.sliders)

    def bends(self, name):
        return not self.links[name]["rigid"] and self.links[name]["body"] is None

    def make_rigid(self, chance):
        """Some links rigid, some of these bodies; one bends at least."""
        r, left = self.random, list(self.links)
        for name in list(self.links):
            if r.random() < chance and len(left) > 1 and len(set(self.links[name]["pins"])) == len(self.links[name]["pins"]):
                left.remove(name)
                self.links[name]["rigid"] = True
                if r.random() < 0.5:
                    x, y = self.on_axis(name, r.uniform(0.1, 0.9))
                    self.links[name]["body"] = (r.uniform(0.05, 0.5), r.uniform(1e-4, 1e-3), x + r.uniform(-0.03, 0.03),
                                                y + r.uniform(-0.03, 0.03))

    def add_springs(self, dampers):
        r = self.random
        for number in range(r.choice((1, 1, 2))):
            h = f"H{number}"
            self.ground(h, *turned(0.5 * self.size, 0.0, r.uniform(0, 360)))
            name = r.choice([n for n in self.links if not self.slotted(n)])
            if r.random() < 0.6 and len(self.links[name]["pins"]) == 2:
                end = f"P{number}"
                self.points[end] = (name, *self.on_axis(name, r.uniform(0.2, 0.8)))
            else:
                end = r.choice(self.moving())
            where = self.points[end][1:] if end in self.points else self.places[end]
            free = math.dist(where, self.places[h]) * r.uniform(0.6, 1.2)
            self.add("SPRING", f"s{number}", end, h, r.uniform(20, 400), free)
            if dampers and r.random() < 0.6:
                self.add("DAMPER", f"d{number}", end, h, r.uniform(0.5, 5))
        if r.random() < 0.5 and "follower" in self.links:
            self.add("COIL", "coil", "O4", "follower", r.uniform(0.5, 5), r.uniform(-0.5, 0.5))

    def add_stops(self, turns):
        """Stops of measures, with limits near the drawing; and springs of one side in place of some others."""
        r, size = self.random, self.size
        for number in range(r.choice((0, 1, 1, 2))):
            pin, name, way = r.choice(self.moving()), f"measure{number}", turned(1.0, 0.0, r.uniform(0, 360))
            x, y = self.places[pin]
            travel = x * way[0] + y * way[1]
            kind = r.choice(("distance", "travel", "sum", "angle") if turns else ("distance", "travel", "sum"))
            if kind == "angle":
                self.add("STOP", name, ("angle",), math.radians(self.keys["start"] + r.uniform(-90, 90)), r.random() < 0.5,
                         10**r.uniform(-1, 1), r.choice((0.0, 10**r.uniform(-3, -1))), 10**r.uniform(-3, -1))
                continue
            limit = travel
            form = ("travel", pin, *way)
            if kind != "travel":
                h = f"K{number}"
                self.ground(h, *turned(0.5 * size, 0.0, r.uniform(0, 360)))
                limit, form = math.dist((x, y), self.places[h]), ("distance", pin, h)
                if kind == "sum":
                    limit, form = 1.5 * limit - 0.5 * travel, ("sum", pin, h, *way)
            self.add("STOP", name, form, limit + r.uniform(-0.1, 0.1) * size, r.random() < 0.5, 10**r.uniform(1, 3),
                     r.choice((0.0, 10**r.uniform(-1, 1))), size * 10**r.uniform(-3, -1))
        for k, load in enumerate(self.loads):
            if load[0] == "SPRING" and r.random() < 0.5:
                side = (r.choice(("push", "pull")), r.choice((0.0, 0.05 * size)), r.choice((0.0, 2.0)), size * 10**r.uniform(-3, -1))
                self.loads[k] = load + (side,)

    def turn_of_cranks(self, count):
        start = round(self.random.uniform(0, 360 / count), 3)
        self.keys["cranks"] = [start + 360.0 / count * k for k in range(count)]

    # families of reports

    def frequencies(self):
        r = self.random
        self.make_rigid(0.25)
        self.common_loads()
        if self.kind != "quick_return" or r.random() < 0.5:
            self.add_masses()
        if r.random() < 0.5:
            self.add_springs(r.random() < 0.3)
        damped = any(load[0] == "DAMPER" for load in self.loads)
        self.keys.update(cranks=[round(r.uniform(0, 360), 2) for _ in range(3)], speeds=sorted({0.0, round(r.uniform(1, 25), 2)}),
                         alpha=r.choice((0.0, round(r.uniform(-50, 50), 2))), inertia="distributed", modes=r.choice((2, 3, 5)),
                         effects=r.choice(("axial", "axial", "static", "axial rotary", "axial rotary shear", "axial shear")),
                         mesh=r.choice(("1e-10", "1e-12")))
        self.keys["reports"] = ["frequencies"] + ([] if damped else ["shapes points=5", "branches"])

    def elastic(self, springs=0.4):
        r = self.random
        self.make_rigid(0.2)
        self.common_loads(0.25)
        if self.kind != "quick_return":
            self.add_masses()
            if r.random() < springs:
                self.add_springs(r.random() < 0.5)
        self.turn_of_cranks(24)
        self.keys.update(speeds=[round(r.uniform(2, 14), 2)], damping=r.choice(("time=2e-4", "time=1e-3", None)), modes=2,
                         effects=r.choice(("axial", "axial", "axial rotary", "axial rotary shear")), accuracy=r.choice(("1e-4", "1e-6", "1e-6")))
        if self.kind == "quick_return" and self.bends("lever"):
            self.keys["effects"] = "axial"
        elif r.random() < 0.3 and self.keys["damping"]:
            self.keys["damping"] = "ratio=0.02"
        if r.random() < 0.2:
            self.keys["without"] = r.choice(("coriolis", "axial", "quadratic", "centripetal,axial"))
        for k, name in enumerate(n for n in self.links if self.bends(n) and len(self.links[n]["pins"]) == 2):
            self.gauges[f"g{k}"] = (name, r.uniform(0.2, 0.8), r.choice(("left", "right")))
        a = self.keys["accuracy"]
        self.keys["reports"] = [f"{name} accuracy={a}" for name in ("response", "strains", "peaks", "torque", "validity")]
        if r.random() < 0.7:
            del self.keys["reports"][4]
        if not self.gauges:
            del self.keys["reports"][1]

    def floquet(self):
        self.elastic()
        self.gauges.clear()
        first = self.keys["speeds"][0]
        self.keys["speeds"] = [first, round(first * 1.04, 2)]
        self.keys["reports"] = self.random.choice((["stability"], ["stability", "campbell"]))
        del self.keys["cranks"]

    def transient(self):
        self.elastic(springs=0.0)
        self.keys["damping"] = "time=1e-3"
        self.keys.pop("without", None)
        self.keys["speeds"] = [-s if self.random.random() < 0.5 else s for s in self.keys["speeds"]]
        self.keys["reports"] = ["transient turns=0.3 instants=24 accuracy=1e-4"]
        self.keys["start"] = round(self.random.uniform(0, 360), 2)
        self.keys["ramp"] = True
        del self.keys["cranks"]

    def rigid(self):
        r = self.random
        self.make_rigid(0.5)
        self.common_loads()
        self.add_masses()
        for pin in self.moving():
            if r.random() < 0.2:
                self.add("PINLOAD", pin, r.uniform(0.1, 2), r.uniform(0.1, 2))
        for name in self.links:
            if r.random() < 0.25:
                self.add("LOAD", name, r.uniform(-0.3, 0.3), r.uniform(0.001, 0.01), r.uniform(0.01, 0.1))
            if r.random() < 0.25 and not self.slotted(name):
                self.add("FORCE_AT", name, r.uniform(-5, 5), r.uniform(-5, 5), *self.on_axis(name, r.uniform(0.2, 0.8)),
                         r.choice(("", " during=with", " during=against", " axes=link")))
        if r.random() < 0.4:
            self.add("TABLED", r.choice(self.moving()), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(1, 5))
        if r.random() < 0.5:
            self.add_springs(r.random() < 0.5)
        if self.family == "rigid":
            self.add_stops(False)
        if r.random() < 0.5:
            for pin in self.places:
                on = [name for name, link in self.links.items() if pin in link["pins"]]
                if pin in ("O2", "O4") or pin == "B" and len(on) == 2 and not any(
                        load[0] in ("PINMASS", "FORCE", "PINLOAD", "TABLED") and load[1] == pin for load in self.loads):
                    if on:
                        self.add("FRICTION", pin, on if pin == "B" else [], r.uniform(0.005, 0.02), r.uniform(0.05, 0.2))
            for slider in self.sliders:
                if slider["guide"] in self.guides:
                    self.add("RUBBING", slider["pin"], slider["guide"], r.uniform(0.05, 0.2))
        for k, name in enumerate(self.links):
            if r.random() < 0.4 and not self.slotted(name):
                x, y = self.on_axis(name, r.uniform(0.1, 1.4))
                self.points[f"X{k}"] = (name, x + r.uniform(-0.1, 0.1) * self.size, y + r.uniform(-0.1, 0.1) * self.size)
        self.turn_of_cranks(8)
        rubs = any(load[0] in ("FRICTION", "RUBBING") for load in self.loads)
        self.keys.update(speeds=sorted({round(r.uniform(1, 25), 2), round(-r.uniform(1, 25), 2)} if r.random() < 0.3 else
                                       {round(r.uniform(1, 25), 2)}), alpha=r.choice((0.0, round(r.uniform(-50, 50), 2))),
                         inertia="distributed", effects=r.choice(("", "", "rotary")))
        self.keys["reports"] = ["kinematics", "reactions", "bearings", "frame", "lagrange", "inertia", "linkage", "pins"] + \
            (["points"] if self.points else [])
        self.keys["drives"] = True
        if r.random() < 0.3:
            self.keys["reports"] += ["balance"]
            # A damped contact begins within a few of the samples of harmonics, which then differ by some 1e-9.
            self.loads = [load[:6] + (0.0,) + load[7:] if load[0] == "STOP" else
                          load[:6] + ((*load[6][:2], 0.0, load[6][3]),) if load[0] == "SPRING" and len(load) > 6 else load
                          for load in self.loads]
        if r.random() < 0.3 and not self.keys["alpha"]:
            self.keys["reports"] += ["sizing"]
        if rubs:
            self.keys["reports"] += ["friction"]
        elif r.random() < 0.4 and any(load[0] != "STOP" for load in self.loads if load[0] not in ("PINMASS", "MASS")):
            # With nothing but stops it rests anywhere between them.
            self.keys["reports"] += ["equilibrium"]

    def motion(self):
        r = self.random
        self.rigid()
        self.loads = [load for load in self.loads if load[0] not in ("TABLED",)]
        self.add("MOTOR", r.uniform(-1, 1))
        self.keys["reports"] = ["motion end=0.2 step=0.05"]
        self.keys["start"] = round(r.uniform(0, 360), 2)
        self.add_stops(True)
        self.keys["start_speed"] = self.keys["speeds"][0]
        del self.keys["cranks"]


ALL = ("four_bar", "four_bar", "elbow", "six_bar", "slider_crank", "quick_return")
KINDS = {"frequencies": ALL, "elastic": ALL, "floquet": ALL[:5], "transient": ALL[:5], "rigid": ALL, "motion": ALL}
FAMILIES = {"frequencies": Machine.frequencies, "elastic": Machine.elastic, "floquet": Machine.floquet,
            "transient": Machine.transient, "rigid": Machine.rigid, "motion": Machine.motion}


class View:
    """How a deck shows a machine."""

    def __init__(self, machine, seed=None, only=ALONE):
        self.machine = machine
        r = random.Random(f"view {machine.seed} {machine.family} {seed}")
        self.turn, self.mirror, self.units, self.shuffle, self.lengths = 0.0, 1, ("m", "kg", "s"), None, True
        self.reversed, self.idle, self.halves, self.name_of = set(), [], {}, {}
        for name in ALONE:                          # the same draws whatever is wanted
            draw, chance = r.random(), r.random()
            if seed is None or name not in only:
                continue
            if name == "turned" and chance < 0.7:
                self.turn = round(-180 + 360 * draw, 3)
            elif name == "mirrored" and chance < 0.5:
                self.mirror = -1
            elif name == "units":
                self.units = list(UNITS)[int(draw * len(UNITS))]
            elif name == "names" and chance < 0.7:
                self._rename(random.Random(draw))
            elif name == "order" and chance < 0.6:
                self.shuffle = draw
            elif name == "lengths":
                self.lengths = chance < 0.5
            elif name == "reversed":
                q = random.Random(draw)
                self.reversed = {link for link in machine.links if q.random() < 0.6}
            elif name == "idle" and chance < 0.6 and "ratio" not in str(machine.keys.get("damping")):
                # ratios of damping are those of the parts between pins
                self._cut(random.Random(draw))
            elif name == "halves" and chance < 0.35 and "ratio" not in str(machine.keys.get("damping")):
                self._halve(random.Random(draw))
        self.length, self.mass, self.time = UNITS[self.units]

    def _rename(self, r):
        m = self.machine
        names = list(m.links) + [g for g in m.guides] + list(m.points) + list(m.gauges)
        names += [load[1] for load in m.loads if load[0] in ("SPRING", "DAMPER", "COIL")]
        pins = list(m.places)
        fresh = [f"{c}{d}" for c in "kqbzw" for d in "abcdefghi"]
        r.shuffle(fresh)
        self.name_of = dict(zip(names + pins, fresh))

    def _free_of_names(self, link):
        """Whether nothing is on a link as a whole or by its name that halves would have to share."""
        named = [load for load in self.machine.loads if load[0] in ("LOAD", "COIL", "FRICTION", "MASS", "FORCE_AT") and
                 (link in load[1:4] or any(isinstance(word, list) and link in word for word in load))]
        return not named and not self.machine.slotted(link) and link != "crank" and self.machine.links[link]["body"] is None

    def _cut(self, r):
        m = self.machine
        links = [n for n in m.links if len(m.links[n]["pins"]) == 2 and not (m.slotted(n) and m.family == "elastic")]
        for number in range(r.choice((1, 1, 2))):
            if links:
                self.idle.append((f"idle{number}", r.choice(links), r.uniform(0.05, 0.95), r.choice(("PINMASS", "FORCE"))))

    def _halve(self, r):
        m = self.machine
        links = [n for n in m.links if len(m.links[n]["pins"]) == 2 and self._free_of_names(n) and m.family not in ("motion", "rigid") and not m.links[n]["rigid"]
                 and not any(on == n for _, on, _, _ in self.idle) and not any(p[0] == n for p in m.points.values())
                 and not any(g[0] == n for g in m.gauges.values())]
        if links:
            self.halves[r.choice(links)] = r.uniform(0.2, 0.8)

    # emission

    def name(self, name):
        return self.name_of.get(name, name)

    def number(self, value, l=0, m=0, t=0):
        return repr(value / (self.length**l * self.mass**m * self.time**t))

    def vector(self, x, y, l=1, m=0, t=0):
        x, y = turned(x, self.mirror * y, self.turn)
        return f"{self.number(x, l, m, t)} {self.number(y, l, m, t)}"

    def pseudo(self, value, l=2, m=1, t=-2):
        return self.number(self.mirror * value, l, m, t)

    def direction(self, degrees):
        return repr(self.mirror * degrees + self.turn)

    def pins(self, link):
        pins = self.machine.links[link]["pins"]
        return pins[::-1] if link in self.reversed else pins

    def local(self, link, x, y):
        """Place along a link and to its left, as its card names its pins."""
        p, q = (self.machine.places[pin] for pin in self.pins(link)[:2])
        d = math.dist(p, q)
        ex, ey = (q[0] - p[0]) / d, (q[1] - p[1]) / d
        e = self.mirror * (ex * (y - p[1]) - ey * (x - p[0]))
        return ex * (x - p[0]) + ey * (y - p[1]), 0.0 if abs(e) < 1e-12 * d else e

    def along(self, link, x, y):
        """Components along a link, as the machine names its pins, along its first section as its card does."""
        (p, q), (r, s) = ([complex(*self.machine.places[pin]) for pin in pins[:2]] for pins in (self.machine.links[link]["pins"], self.pins(link)))
        turn = (q - p) / (s - r)
        there = complex(x, y) * turn / abs(turn)
        return there.real, there.imag

    def at(self, link, x, y):
        along, offset = self.local(link, x, y)
        return f"{self.number(along, 1)}" + (f" offset={self.number(offset, 1)}" if offset else "")

    def link_card(self, name, pins, body):
        m, n = self.machine, self.name
        places = [m.places.get(pin) or self.weld_place(name) for pin in pins]
        lengths = [math.dist(p, q) for p, q in zip(places, places[1:])]
        words = " ".join(n(pin) for pin in pins)
        if len(pins) == 2 and (self.lengths or self._is_four_bar()):
            words += f" length={self.number(lengths[0], 1)}"
        elif self.lengths and len(pins) > 2:
            turns = []
            for p, q, s in zip(places, places[1:], places[2:]):
                one, two = (q[0] - p[0], q[1] - p[1]), (s[0] - q[0], s[1] - q[1])
                turns.append(self.mirror * math.degrees(math.atan2(one[0] * two[1] - one[1] * two[0], one[0] * two[0] + one[1] * two[1])))
            words += " lengths=" + ",".join(self.number(x, 1) for x in lengths) + " turns=" + ",".join(map(repr, turns))
        if body:
            return f"LINK {n(name)} {words} rigid mass={self.number(body[0], 0, 1)} inertia={self.number(body[1], 2, 1)} center=" + \
                "{},{}".format(*(self.number(x, 1) for x in self.local(name, *body[2:])))
        return f"LINK {n(name)} {words} material=steel section=strip" + (" rigid" if m.links[name]["rigid"] else "")

    def _is_four_bar(self):
        return self.machine.kind == "four_bar"

    def weld_place(self, name):
        return self.machine.on_axis(name, self.halves[name])

    def text(self):
        m, n = self.machine, self.name
        keys, thick = m.keys, 0.02 * m.size
        cards = [f"MATERIAL steel E={self.number(2e11, -1, 1, -2)} density={self.number(7800.0, -3, 1)} nu=0.3",
                 f"SECTION strip rectangle thickness={self.number(thick * 0.4, 1)} width={self.number(thick, 1)}"]
        for pin, place in m.places.items():
            cards.append(f"{'GROUND' if pin in m.grounds else 'PIN'} {n(pin)} {self.vector(*place)}")
        for name, (x, y, angle) in m.guides.items():
            cards.append(f"GUIDE {n(name)} {self.vector(x, y)} angle={self.direction(angle)}")
        for name, link in m.links.items():
            if name in self.halves:
                pins, weld = self.pins(name), "weld" + name
                cards += [self.link_card(name, [pins[0], weld], None),
                          self.link_card(name, [weld, pins[1]], None).replace(f"LINK {n(name)} ", f"LINK {n(name)}{HALF} ", 1),
                          f"PIN {weld} {self.vector(*self.weld_place(name))}", f"WELD {weld} {n(name)} {n(name)}{HALF}"]
            else:
                cards.append(self.link_card(name, self.pins(name), link["body"]))
        for name, (link, x, y) in m.points.items():
            cards.append(f"POINT {n(name)} {n(link)} along={self.at(link, x, y)}")
        for name, link, share, how in self.idle:
            cards.append(f"POINT {name} {n(link)} along={self.at(link, *m.on_axis(link, share))}")
            cards.append(f"PINMASS {name} 1e-25kg" if how == "PINMASS" else f"FORCE {name} 1e-22N 0N")
        for s in m.sliders:
            cards.append(f"SLIDER {n(s['pin'])} {n(s['guide'])}" + (f" mass={self.number(s['mass'], 0, 1)}" if s["mass"] else ""))
        for name, (link, share, side) in m.gauges.items():
            x, y = m.on_axis(link, share)
            other = {"left": "right", "right": "left"}
            for changes in (self.mirror < 0, link in self.reversed):
                side = other[side] if changes else side
            cards.append(f"GAUGE {n(name)} {n(link)} at={self.number(self.local(link, x, y)[0], 1)} side={side}")
        cards.append(f"DRIVE {n('crank')}")
        for load in m.loads:
            cards += self.load_cards(*load)
        cards += self.request_cards()
        if self.shuffle is not None:
            random.Random(self.shuffle).shuffle(cards)
        return "\n".join([f"TITLE {m.family} {m.kind} {m.seed}", "UNITS " + " ".join(self.units)] + cards) + "\n"

    def load_cards(self, kind, *words):
        n = self.name
        if kind == "GRAVITY":
            return [f"GRAVITY {self.vector(*words, 1, 0, -2)}"]
        name, rest = words[0], words[1:]
        if kind == "FORCE":
            return [f"FORCE {n(name)} {self.vector(*rest, 1, 1, -2)}"]
        if kind == "PINMASS":
            return [f"PINMASS {n(name)} {self.number(rest[0], 0, 1)}"]
        if kind == "TORQUE":
            if name in self.halves and self.machine.bends(name):
                # as the first of its pins comes first, so do the shares
                return [f"TORQUE {n(name)}{end} {self.pseudo(rest[0] * share)}"
                        for end, share in (("", self._first_share(name)), (HALF, 1 - self._first_share(name)))]
            return [f"TORQUE {n(name)} {self.pseudo(rest[0])}"]
        if kind == "MASS":
            mass, x, y, inertia = rest
            return [f"MASS {n(name)} {self.number(mass, 0, 1)} at={self.at(name, x, y)}" +
                    (f" inertia={self.number(inertia, 2, 1)}" if inertia else "")]
        if kind == "FORCE_AT":
            fx, fy, x, y, more = rest
            if "axes=link" in more:                # components along the link, and to its left, as its card goes
                fx, fy = self.along(name, fx, fy)
                force = f"{self.number(fx, 1, 1, -2)} {self.number(self.mirror * fy, 1, 1, -2)}"
            else:
                force = self.vector(fx, fy, 1, 1, -2)
            return [f"FORCE {n(name)} {force} at={self.at(name, x, y)}{more}"]
        if kind == "TABLED":
            x, y, size = rest
            values = [size * (1 + 0.7 * math.sin(1 + math.radians(k)) + 0.2 * math.cos(math.radians(3 * k))) for k in range(0, 360, 15)]
            rows = sorted((self.mirror * 15 * k + self.turn, value) for k, value in enumerate(values))
            rows.append((rows[0][0] + 360.0, rows[0][1]))
            table = "  ".join(f"{angle!r} {value!r}" for angle, value in rows)
            return [f"FORCE {n(name)} {self.vector(x, y)} table=tab", f"TABLE tab deg N {table}"]
        if kind == "LOAD":
            return [f"LOAD {n(name)} torque={self.pseudo(rest[0])} damping={self.number(rest[1], 2, 1, -1)} "
                    f"resisting={self.number(rest[2], 2, 1, -2)}"]
        if kind == "PINLOAD":
            return [f"LOAD {n(name)} damping={self.number(rest[0], 0, 1, -1)} resisting={self.number(rest[1], 1, 1, -2)}"]
        if kind == "SPRING":
            card = f"SPRING {n(name)} {n(rest[0])} {n(rest[1])} stiffness={self.number(rest[2], 0, 1, -2)} " \
                f"free_length={self.number(rest[3], 1)}"
            if len(rest) > 4:
                side, gap, damping, width = rest[4]
                card += f" only={side} gap={self.number(gap, 1)} damping={self.number(damping, 0, 1, -1)} contact={self.number(width, 1)}"
            return [card]
        if kind == "STOP":
            return self.stop_cards(name, *rest)
        if kind == "DAMPER":
            return [f"DAMPER {n(name)} {n(rest[0])} {n(rest[1])} damping={self.number(rest[2], 0, 1, -1)}"]
        if kind == "COIL":
            return [f"SPRING {n(name)} {n(rest[0])} {n(rest[1])} stiffness={self.number(rest[2], 2, 1, -2)} "
                    f"torque={self.pseudo(rest[3])}"]
        if kind == "FRICTION":
            return [f"FRICTION {n(name)} " + " ".join(n(link) for link in rest[0]) +
                    f" radius={self.number(rest[1], 1)} coefficient={rest[2]!r}"]
        if kind == "RUBBING":
            return [f"FRICTION {n(name)} {n(rest[0])} coefficient={rest[1]!r}"]
        if kind == "MOTOR":
            return [f"MOTOR torque={self.pseudo(name)}"]
        raise ValueError(kind)

    def stop_cards(self, name, form, limit, is_below, stiffness, damping, width):
        """With its measure; mirrored, an angle has its limit on the other side."""
        n, (kind, *words) = self.name, form
        if kind == "angle":
            below = " below" if is_below == (self.mirror > 0) else ""
            return [f"MEASURE {name} angle {n('crank')}",
                    f"STOP stop{name} {name} limit={self.direction(math.degrees(limit))} stiffness={self.number(stiffness, 2, 1, -2)} "
                    f"damping={self.number(damping, 2, 1, -1)} contact={math.degrees(width)!r}{below}"]
        cards = []
        if kind != "distance":
            x, y = turned(words[-2], self.mirror * words[-1], self.turn)
            cards.append(f"MEASURE {name if kind == 'travel' else 'way' + name} travel {n(words[0])} {x!r} {y!r}")
        if kind != "travel":
            cards.append(f"MEASURE {name if kind == 'distance' else 'far' + name} distance {n(words[0])} {n(words[1])}")
        if kind == "sum":
            cards.append(f"MEASURE {name} sum 1.5 far{name} -0.5 way{name}")
        return cards + [f"STOP stop{name} {name} limit={self.number(limit, 1)} stiffness={self.number(stiffness, 0, 1, -2)} "
                        f"damping={self.number(damping, 0, 1, -1)} contact={self.number(width, 1)}" + (" below" if is_below else "")]

    def _first_share(self, name):
        share = self.halves[name]
        return 1 - share if name in self.reversed else share

    def request_cards(self):
        keys, cards = self.machine.keys, []
        if "cranks" in keys:
            cards.append("CRANK " + ", ".join(self.direction(angle) for angle in keys["cranks"]))
        ramp = f" ramp={self.number(0.1, 0, 0, 1)}" if keys.get("ramp") else ""
        alpha = f" alpha={self.mirror * keys['alpha']!r}" if keys.get("alpha") else ""
        cards.append("SPEED " + ", ".join(repr(self.mirror * s) for s in keys["speeds"]) + alpha + ramp)
        for key, card in (("inertia", "INERTIA"), ("modes", "MODES")):
            if key in keys:
                cards.append(f"{card} {keys[key]}")
        if keys.get("effects"):
            cards.append("EFFECTS " + keys["effects"])
        if keys.get("without"):
            cards.append("EFFECTS response without=" + keys["without"])
        if keys.get("mesh"):
            cards.append("MESH * accuracy=" + keys["mesh"])
        if keys.get("damping"):
            key, value = keys["damping"].split("=")
            cards.append(f"DAMPING * {key}=" + (self.number(float(value), 0, 0, 1) if key == "time" else value))
        for report in self.reports():
            if report.startswith("transient"):
                report += f" crank={self.direction(keys['start'])}"
            if report.startswith("motion"):
                report = f"motion crank={self.direction(keys['start'])} speed={self.mirror * keys['start_speed']!r} " \
                    f"end={self.number(0.2, 0, 0, 1)} step={self.number(0.05, 0, 0, 1)}"
            cards.append("REPORT " + report)
        return cards

    def reports(self):
        reports = list(self.machine.keys["reports"])
        if self.is_other() and self.machine.family == "rigid":
            reports.append("drives")
        return reports

    def is_other(self):
        """Whether the program takes the deck for more than a four-bar of binary links."""
        m = self.machine
        cut = any(True for _ in self.idle) or bool(self.halves)
        return m.kind != "four_bar" or cut
