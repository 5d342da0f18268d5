"""Random linkages that assemble by construction: a drawing that grows by a drive, dyads, triads, yokes and welded links."""
import math
import random


class Retry(Exception):
    """This choice does not fit; another one will."""


class Drawing:
    """Pins, links and cards of a linkage; lengths are of the order of 1."""

    def __init__(self, seed, links):
        self.random = random.Random(seed).random          # the only function of Random that is the same in every version
        self.places, self.grounds, self.guides = {}, [], {}
        self.links, self.points = {}, {}                  # name: pins; point: (link, along, offset)
        self.sliders, self.welds, self.drives = [], [], []
        self.driven_length = None                         # the ram
        self.kinds = []
        self.angle = None                                 # of the first drive in the drawing, degrees, or its length
        self.build(links)

    # draws

    def uniform(self, low, high):
        return low + (high - low) * self.random()

    def chance(self, probability):
        return self.random() < probability

    def pick(self, items):
        items = list(items)
        if not items:
            raise Retry
        return items[int(self.random() * len(items))]

    # parts

    def new_pin(self, place, prefix="P"):
        name = f"{prefix}{len(self.places) + 1}"
        self.places[name] = place
        return name

    def new_ground(self, near=(0.0, 0.0)):
        angle, distance = self.uniform(0, 2 * math.pi), self.uniform(0.5, 1.3)
        pin = self.new_pin((near[0] + distance * math.cos(angle), near[1] + distance * math.sin(angle)), "G")
        self.grounds.append(pin)
        return pin

    def new_link(self, *pins, keep_order=False):
        name = f"link{len(self.links) + 1}"
        pins = list(pins)
        if not keep_order and self.chance(0.4):
            pins.reverse()
        if math.dist(self.places[pins[0]], self.places[pins[1]]) < 0.12:
            raise Retry
        self.links[name] = pins
        return name

    def new_guide(self, place, angle):
        name = f"guide{len(self.guides) + 1}"
        shift = self.uniform(-0.5, 0.5)
        self.guides[name] = (place[0] + shift * math.cos(angle), place[1] + shift * math.sin(angle), math.degrees(angle))
        return name

    def holders(self, pin):
        """Bodies that a pin belongs to; `ground` for a fixed one."""
        found = {name for name, pins in self.links.items() if pin in pins}
        if pin in self.points:
            found.add(self.points[pin][0])
        if pin in self.grounds:
            found.add("ground")
        return found

    def moving_pins(self):
        return [pin for pin in self.places if pin not in self.grounds]

    def direction(self, one, other):
        (x0, y0), (x1, y1) = self.places[one], self.places[other]
        return math.atan2(y1 - y0, x1 - x0)

    def between(self, one, other, part):
        (x0, y0), (x1, y1) = self.places[one], self.places[other]
        return x0 + part * (x1 - x0), y0 + part * (y1 - y0)

    def point_on(self, link):
        """A further pin of a rigid link, or a POINT of a link, as a pin."""
        first, second = self.links[link][:2]
        along, offset = self.uniform(-0.4, 1.4), self.uniform(-0.7, 0.7)
        if abs(offset) < 0.1:
            raise Retry
        (x0, y0), (x1, y1) = self.places[first], self.places[second]
        dx, dy = x1 - x0, y1 - y0
        pin = self.new_pin((x0 + along * dx - offset * dy, y0 + along * dy + offset * dx))
        length = math.hypot(dx, dy)
        if link == self.driven_length or self.chance(0.3):
            if link == self.driven_length:
                raise Retry
            self.points[pin] = (link, along * length, offset * length)
        else:
            self.links[link].append(pin)
        return pin

    def known(self, moving=None):
        """A pin that is placed already, or a new one on a link, or a new ground pivot."""
        draw = self.random()
        if moving is None:
            moving = draw < 0.75
        if not moving:
            return self.new_ground(self.places[self.pick(self.moving_pins())])
        if self.links and self.chance(0.3):
            return self.point_on(self.pick(self.links))
        return self.pick(self.moving_pins())

    def two_known(self):
        """Pins of two bodies, one of them moving."""
        one = self.known(True)
        other = self.known()
        if one == other or self.holders(one) & self.holders(other):
            raise Retry
        return one, other

    # kinds of drives

    def crank(self):
        ground = self.new_pin((0.0, 0.0), "G")
        self.grounds.append(ground)
        self.angle = round(self.uniform(-180, 180), 3)
        pin = self._arm(ground, self.angle, self.uniform(0.15, 0.4))
        link = self.new_link(ground, pin)
        self.drives.append((link, [], ""))

    def _arm(self, ground, degrees, length):
        x, y = self.places[ground]
        return self.new_pin((x + length * math.cos(math.radians(degrees)), y + length * math.sin(math.radians(degrees))))

    def two_cranks(self):
        self.crank()
        second = self.new_ground((0.0, 0.0))
        angle = round(self.uniform(-180, 180), 3)
        pin = self._arm(second, angle, self.uniform(0.15, 0.4))
        link = self.new_link(second, pin)
        if self.chance(0.3):
            self.drives.append((link, [], f"at={angle!r}deg"))
        else:
            ratio = self.pick((1, -1, 2, -0.5))
            self.drives.append((link, [], f"ratio={ratio} phase={round(angle - ratio * self.angle, 6)!r}deg"))
        if self.chance(0.5):
            self._dyad_on("P2", pin)

    def slider(self):
        pin = self.new_pin((0.0, 0.0))
        angle = round(self.uniform(-180, 180), 3)
        x, y = self.places[pin]
        self.angle = round(self.uniform(0.2, 0.6), 3)
        name = "guide1"
        radians = math.radians(angle)
        self.guides[name] = (x - self.angle * math.cos(radians), y - self.angle * math.sin(radians), angle)
        self.sliders.append([pin, name, None])
        self.drives.append((pin, [name], ""))
        self._dyad_on(pin, self.new_ground())

    def against(self):
        ground = self.new_pin((0.0, 0.0), "G")
        self.grounds.append(ground)
        base = self._arm(ground, self.uniform(-180, 180), self.uniform(0.4, 1.0))
        end = self._arm(base, self.uniform(-180, 180), self.uniform(0.4, 1.0))
        other = self.new_ground(self.places[end])
        one = self.new_link(ground, base, keep_order=True)
        two = self.new_link(base, end, keep_order=True)
        self.new_link(other, end)
        self.angle = math.degrees(self.direction(base, end) - self.direction(ground, base))
        self.drives.append((two, ["against", one], ""))

    def ram(self):
        ground = self.new_pin((0.0, 0.0), "G")
        self.grounds.append(ground)
        end = self._arm(ground, self.uniform(-180, 180), self.uniform(0.4, 1.0))
        other = self.new_ground(self.places[end])
        self.new_link(ground, end)
        ram = self.new_link(other, end)
        if abs(math.sin(self.direction(ground, end) - self.direction(other, end))) < 0.3:
            raise Retry
        self.driven_length = ram
        self.angle = math.dist(self.places[other], self.places[end])
        self.drives.append((ram, ["length"], ""))

    # what is added

    def _dyad_on(self, one, other):
        """RRR: a new pin held by two new links."""
        x, y = self.between(one, other, 0.5)
        angle, distance = self.uniform(0, 2 * math.pi), self.uniform(0.3, 0.9)
        pin = self.new_pin((x + distance * math.cos(angle), y + distance * math.sin(angle)))
        if abs(math.sin(self.direction(pin, one) - self.direction(pin, other))) < 0.45:
            raise Retry
        self.new_link(one, pin)
        self.new_link(other, pin)
        return pin

    def rrr(self):
        self._dyad_on(*self.two_known())

    def _new_end(self, pin):
        angle, distance = self.uniform(0, 2 * math.pi), self.uniform(0.4, 1.2)
        x, y = self.places[pin]
        return self.new_pin((x + distance * math.cos(angle), y + distance * math.sin(angle))), angle

    def rrp(self):
        """A link whose end slides on a fixed guide."""
        pin = self.known(True)
        end, angle = self._new_end(pin)
        guide = self.new_guide(self.places[end], angle + self.uniform(-1.1, 1.1) + self.pick((0, math.pi)))
        self.new_link(pin, end)
        self.sliders.append([end, guide, None])

    def rrp_on_link(self, link=None):
        """A link whose end slides along another link."""
        link = link or self.pick(name for name in self.links if name != self.driven_length)
        first, second = self.links[link][:2]
        end = self.new_pin(self.between(first, second, self.uniform(0.3, 0.7)))
        pin = self.known()
        if link in self.holders(pin) or ("ground" in self.holders(pin) and "ground" in self.holders(first)):
            raise Retry
        if abs(math.cos(self.direction(pin, end) - self.direction(first, second))) < 0.45:
            raise Retry
        self.new_link(pin, end)
        self.sliders.append([end, link, None])

    def rpr(self):
        """A lever on one pin, which slides over a block at another."""
        pivot, block = self.two_known()
        if self.chance(0.5):
            pivot, block = block, pivot
        if not 0.3 < math.dist(self.places[pivot], self.places[block]) < 1.5:
            raise Retry
        end = self.new_pin(self.between(pivot, block, self.uniform(1.5, 2.2)))
        lever = self.new_link(pivot, end, keep_order=self.chance(0.6))
        self.sliders.append([block, lever, None])

    def cylinder(self):
        """A rod that does not turn in a cylinder, between two pins."""
        one, other = self.two_known()
        angle, length = self.uniform(0, 2 * math.pi), self.uniform(0.7, 1.2)
        x, y = self.places[one]
        end = self.new_pin((x + length * math.cos(angle), y + length * math.sin(angle)))
        block = self.new_pin(self.between(one, end, self.uniform(0.35, 0.65)))
        cylinder = self.new_link(one, end, keep_order=True)
        rod = self.new_link(block, other, keep_order=self.chance(0.5))
        self.sliders.append([block, cylinder, rod])

    def yoke(self):
        """A link that slides without turning on a guide, and is moved by a pin in its slot."""
        pin = self.known(True)
        angle = self.uniform(0, 2 * math.pi)
        x, y = self.places[pin]
        near, far = self.uniform(0.4, 0.8), self.uniform(0.4, 0.8)
        first = self.new_pin((x - near * math.cos(angle), y - near * math.sin(angle)))
        second = self.new_pin((x + far * math.cos(angle), y + far * math.sin(angle)))
        link = self.new_link(first, second, keep_order=True)
        guide = self.new_guide(self.places[first], angle + self.uniform(0.6, 2.5))
        self.sliders += [[first, guide, link], [pin, link, None]]

    def prp(self, link=None):
        """Two blocks joined by a pin, on a fixed guide and on a link; a dyad hangs on the pin."""
        link = link or self.pick(name for name in self.links if name != self.driven_length)
        first, second = self.links[link][:2]
        pin = self.new_pin(self.between(first, second, self.uniform(0.35, 0.65)))
        guide = self.new_guide(self.places[pin], self.direction(first, second) + self.uniform(0.7, 2.4))
        self.sliders += [[pin, guide, None], [pin, link, None]]
        self._dyad_on(pin, self.new_ground(self.places[pin]))

    def weld(self):
        """A link welded to another one at a joint with a third."""
        link = self.pick(name for name in self.links if name != self.driven_length)
        pin = self.pick(self.links[link])
        if pin in self.grounds or len(self.holders(pin)) < 2 or any(pin == welded for welded, _ in self.welds):
            raise Retry
        end, _ = self._new_end(pin)
        self.welds.append((pin, [link, self.new_link(pin, end)]))

    def triad(self):
        """A platform on three legs."""
        x, y = self.places[self.known(True)]
        angle, feet = self.uniform(0, 2 * math.pi), []
        x, y = x + self.uniform(-0.8, 0.8), y + self.uniform(-0.8, 0.8)
        for k in range(3):
            turn = angle + k * 2.1 + self.uniform(-0.5, 0.5)
            radius = self.uniform(0.25, 0.6)
            feet.append(self.new_pin((x + radius * math.cos(turn), y + radius * math.sin(turn))))
        earlier = [pin for pin in self.moving_pins() if pin not in feet]
        roots = [self.pick(earlier), self.new_ground((x, y)), self.new_ground((x, y))]
        self.new_link(*feet, keep_order=True)
        for root, foot in zip(roots, feet):
            self.new_link(root, foot)

    # growth

    SIZES = {"rrr": 2, "rrp": 1, "rrp_on_link": 1, "rpr": 1, "cylinder": 2, "yoke": 1, "prp": 2, "weld": 1, "triad": 4}
    WEIGHTS = {"rrr": 20, "rrp": 3, "rrp_on_link": 4, "rpr": 4, "cylinder": 3, "yoke": 1, "prp": 1, "weld": 1, "triad": 5}

    def attempt(self, kind):
        """Adds a kind, or leaves everything as it was."""
        before = (dict(self.places), list(self.grounds), dict(self.guides), {name: list(pins) for name, pins in self.links.items()},
                  dict(self.points), [list(slider) for slider in self.sliders], list(self.welds), list(self.drives),
                  self.driven_length)
        try:
            getattr(self, kind)()
        except Retry:
            (self.places, self.grounds, self.guides, self.links, self.points, self.sliders, self.welds, self.drives,
             self.driven_length) = before
            return False
        self.kinds.append(kind)
        return True

    def build(self, links):
        """Grows until there are so many links, the ground among them."""
        drives = ["crank"] * 13 + ["two_cranks"] * 2 + ["slider"] * 2 + ["against", "ram"]
        while not self.attempt(self.pick(drives)):
            pass
        for _ in range(200):
            room = links - 1 - len(self.links)
            if room <= 0:
                break
            self.attempt(self.pick(kind for kind, size in self.SIZES.items() if size <= room for _ in range(self.WEIGHTS[kind])))
