"""Linkages that are extreme in one way, for random_vibrations.py: stiffness over many decades, a block at the end of its guide, corners
that hardly turn, positions beside dead points and change points, and many links of many welded pieces."""
import math
import random

HEAD = """TITLE extreme linkage {seed}: {family}
UNITS m kg s
MATERIAL steel E=200GPa density=7800kg/m3
MATERIAL other E={modulus} density=7800kg/m3
SECTION strip rectangle thickness=0.0016 width=0.0254
SECTION bar rectangle thickness=0.0042 width=0.0254
"""
FOUR = """GROUND O2 0 0
GROUND O4 0.254 0
LINK crank O2 A length=0.1 material=steel section=strip
LINK follower O4 B length=0.2667 material=steel section=strip
DRIVE crank
"""
FAMILIES = ("third_crank", "triangle", "coil", "spring", "guide_end", "corner", "dead_point", "change_point")
MANY = "many_links"                            # by the kind `many` of random_vibrations.py


class Extreme:
    """As a Case of random_vibrations.py: positions() and text(cranks, speed)."""

    linear, loaded, scale = False, False, 1.0

    def __init__(self, seed, family=None):
        self.seed = seed
        self.random = random.Random(seed).random
        self.family = family or FAMILIES[int(self.random() * len(FAMILIES))]
        self.modulus = "200GPa"
        self.crank = round(self.uniform(-180, 180), 2)
        self.cards = getattr(self, "_" + self.family)()

    def uniform(self, low, high):
        return low + (high - low) * self.random()

    def power(self, low, high):
        return f"{10**self.uniform(low, high):.6g}"

    def positions(self):
        return [repr(self.crank)]

    def text(self, cranks, _=None):
        head = HEAD.format(seed=self.seed, family=self.family, modulus=self.modulus)
        return head + self.cards + f"""MESH * accuracy=1e-{3 + int(self.uniform(0, 9.9))}
CRANK {','.join(cranks)}
EFFECTS static
MODES 4
REPORT frequencies
END
"""

    def _parallelogram(self, dx, dy, material):
        self.crank = math.degrees(math.atan2(dy, dx))
        feet = {"A": 0.0, "C": 0.13, "B": 0.25}
        grounds = "".join(f"GROUND O{pin} {x} 0\nPIN {pin} {round(x + dx, 9)!r} {dy!r}\n" for pin, x in feet.items())
        return grounds + f"""LINK crank OA A material=steel section=strip
LINK second OB B material=steel section=strip
LINK third OC C material={material} section=strip
LINK coupler A C B material=steel section=strip
DRIVE crank
"""

    def _third_crank(self):
        """Far stiffer or softer than the others."""
        self.modulus = self.power(2, 19) + "Pa"
        return self._parallelogram(round(self.uniform(-0.08, 0.08), 4), round(self.uniform(0.03, 0.1), 4), "other")

    def _change_point(self):
        """All cranks nearly in line with the coupler."""
        return self._parallelogram(0.1, round(10**self.uniform(-6, -2), 9), "steel")

    def _triangle(self):
        """A welded coupler triangle of another stiffness than the links."""
        self.modulus = self.power(8, 20) + "Pa"
        return FOUR + """PIN A 0.1 0
PIN B 0.2902 0.241
PIN C 0.1403 0.1752
LINK coupler A B C A lengths=0.2794,0.184,0.1844 material=other section=strip
PINMASS C 0.1
"""

    def _coil(self):
        return FOUR + f"""LINK coupler A B length=0.2794 material=steel section=strip
SPRING coil B coupler follower stiffness={self.power(-9, 12)}N*m/rad free_angle={self.crank + 60}
"""

    def _spring(self):
        return FOUR + f"""LINK coupler A B length=0.2794 material=steel section=strip
SPRING main A O4 stiffness={self.power(-6, 12)}N/m free_length=0.2
"""

    def _guide_end(self):
        """A rod that ends in its block on the ground, or little behind it."""
        angle = math.radians(self.crank)
        x, y = 0.08 * math.cos(angle), 0.08 * math.sin(angle)
        way = math.hypot(0.2 - x, y)
        return f"""GROUND O2 0 0
GROUND O4 0.2 0
PIN A {x:.7f} {y:.7f}
PIN E {x + 1.2 * (0.2 - x):.7f} {-0.2 * y:.7f}
LINK crank O2 A length=0.08 material=steel section=bar
LINK rod A E length={way + 10**self.uniform(-8, -1)!r} material=steel section=strip
SLIDER O4 rod inertia=1e-5
DRIVE crank
"""

    def _corner(self):
        """An elbow that is almost straight."""
        return FOUR + f"""LINK coupler A B C lengths=0.2794,0.12 turns={self.power(-6, 1)} material=steel section=strip
PINMASS C 0.1
BRANCH B left A O4
"""

    def _dead_point(self):
        """A crank that stands almost in line with the rod, driven at its block."""
        self.linear = True
        self.crank = round(0.38 - 10**self.uniform(-7, -2), 12)
        return """GROUND O2 0 0
GUIDE bore 0 0 angle=0
LINK crank O2 A length=0.1 material=steel section=bar
LINK rod A B length=0.28 material=steel section=strip
SLIDER B bore mass=0.05
DRIVE B bore
BRANCH A left O2 B
"""

    def _many_links(self):
        """An eight-bar: a crank and three dyads, every link of two or three pieces that are welded, or a closed frame of three."""
        angle = math.radians(self.crank)
        places = {"O2": (0.0, 0.0), "O4": (0.25, 0.0), "A": (0.1 * math.cos(angle), 0.1 * math.sin(angle))}
        lines, links = ["LINK crank O2 A length=0.1 material=steel section=bar"], {"crank": ["A"]}
        for number, pin in enumerate("BCD"):
            first, last = self._bases(number, places, links)
            (x, y), (to_x, to_y) = places[first], places[last]
            rise = self.uniform(0.5, 1.2) * (1 if self.random() < 0.5 else -1)
            places[pin] = ((x + to_x) / 2 - rise * (to_y - y), (y + to_y) / 2 + rise * (to_x - x))
            for side, base in enumerate((first, last)):
                name, way = f"link{2 * number + side}", [base, pin]
                corners = 1 + int(self.random() * 2)
                for k in range(corners):
                    corner = f"{pin}{side}{k}"
                    places[corner] = self._corner_of(places[base], places[pin], (k + 1) / (corners + 1))
                    way.insert(-1, corner)
                    if self.random() < 0.4:
                        lines.append(f"PINMASS {corner} {self.power(-2, 0)}")
                if corners == 1 and self.random() < 0.5:
                    way.append(base)
                links[name] = way
                lines.append(f"LINK {name} {' '.join(way)} material=steel section={'strip' if self.random() < 0.7 else 'bar'}")
        grounds = [f"{'GROUND' if pin[0] == 'O' else 'PIN'} {pin} {x:.9f} {y:.9f}" for pin, (x, y) in places.items()]
        return "\n".join(grounds + lines + ["DRIVE crank"]) + "\n"

    def _bases(self, number, places, links):
        """Two pins of different links, or of one and the ground, not too near to each other; of the first dyad the four-bar's."""
        if number == 0:
            return "A", "O4"
        while True:
            one, other = (sorted(places)[int(self.random() * len(places))] for _ in range(2))
            near = math.dist(places[one], places[other]) < 0.08
            joined = any(one in way and other in way for way in links.values()) or {one, other} <= {"O2", "O4", "A"}
            if not near and not joined:
                return one, other

    def _corner_of(self, base, pin, share):
        """A place beside the way from one pin to another."""
        beside = self.uniform(0.15, 0.4) * (1 if self.random() < 0.5 else -1)
        dx, dy = pin[0] - base[0], pin[1] - base[1]
        return base[0] + share * dx - beside * dy, base[1] + share * dy + beside * dx
