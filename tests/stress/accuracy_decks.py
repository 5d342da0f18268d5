"""Random decks for what an accuracy= promises: every number and seed make the same deck, whatever was made before."""

import hashlib
import math

from random_linkages import Generator, sine_at

LINKS = ("crank", "coupler", "follower")
ENDS = ("O2 A", "A B", "O4 B")

# What a kind has beside a linkage at several crank angles and speeds, and the modes it may ask for.
KINDS = {
    "masses": ({"masses"}, (1, 3, 5, 10, 20)),
    "modes": (set(), (20, 30, 40)),
    "shear": ({"shear"}, (1, 3, 5, 10, 20)),
    "bodies": ({"rigid", "offsets", "pins"}, (1, 3, 5, 10, 20)),
    "loads": ({"forces", "gravity", "torque", "pins"}, (1, 3, 5, 10, 20, 40)),
    "compressed": ({"pressed"}, (1, 3, 5, 10)),
    "diverged": ({"fast", "pins"}, (1, 3, 5, 10, 20)),
    "mixed": (None, (1, 2, 3, 5, 8, 20)),
}
ALL = {"masses", "shear", "rigid", "offsets", "pins", "forces", "gravity", "torque", "pressed", "fast"}


class RandomDeck:
    """A deck without its accuracy, and without its crank angles, which a run may take fewer of."""

    def __init__(self, number, kind, lines, cranks, speeds, modes):
        self.number, self.kind, self.lines, self.cranks, self.speeds, self.modes = number, kind, lines, cranks, speeds, modes
        self.name = f"{kind}_{number}"

    def text(self, accuracy, cranks=None):
        return "\n".join([f"TITLE {self.name}", *self.lines, f"CRANK {' '.join(map(str, cranks or self.cranks))}",
                          f"MESH * accuracy={accuracy}", "REPORT frequencies", "END", ""])

    def frequencies(self):
        return len(self.cranks)*len(self.speeds)*self.modes


class Link:
    """One link in the making [SI]."""

    def __init__(self, length, section, area, inertia, modulus, density, ratio):
        self.length, self.section, self.area, self.inertia = length, section, area, inertia
        self.modulus, self.density, self.ratio, self.rigid = modulus, density, ratio, False
        self.material = f"E={modulus:g} density={density:g} nu={ratio:g}"

    def mass(self):
        return self.density*self.area*self.length

    def euler(self):
        return math.pi**2*self.modulus*self.inertia/self.length**2

    def shear_stiffness(self):
        return 0.4*self.modulus/(2*(1 + self.ratio))*self.area

    def natural(self):
        """Of the hinged beam without its masses [rad/s]."""
        return math.sqrt(self.euler()*math.pi**2/(self.mass()*self.length))


def few_digits(value):
    return float(f"{value:.6g}")


def draw_geometry(draw):
    """Ground and lengths [m], with crank angles at which they close."""
    while True:
        size = draw.power(-1.5, 0.8)
        ground, *lengths = (few_digits(size*draw.power(-0.5, 0.5)) for _ in range(4))
        least = draw.choice(0.3, 0.3, 0.1, 0.03, 0.003)
        cranks = []
        wanted = draw.choice(2, 4, 8)
        for _ in range(400):
            crank = round(draw.uniform(0, 360), draw.choice(0, 1, 3, 9))
            sine = sine_at(ground, lengths, crank)
            if sine is not None and sine > least and crank not in cranks:
                cranks.append(crank)
            if len(cranks) == wanted:
                return ground, lengths, cranks, min(sine_at(ground, lengths, crank) for crank in cranks)


def draw_link(draw, length, stout):
    thick = few_digits(length*(draw.power(-1.0, -0.4) if stout else draw.power(-2.5, -1.0)))
    modulus, density, ratio = draw.choice((2e11, 7800, 0.3), (7e10, 2700, 0.33), (2.1e9, 1200, 0.4), (4e10, 1600, 0.1),
                                          (draw.power(8, 12), draw.power(2, 4.2), 0))
    kind = draw.choice("rectangle", "circle", "tube", "general")
    if kind == "rectangle":
        width = few_digits(thick*draw.power(-0.5, 1))
        return Link(length, f"rectangle thickness={thick} width={width}", thick*width, width*thick**3/12, modulus, density, ratio)
    if kind == "general":
        area, inertia = few_digits(0.5*thick**2), few_digits(0.04*thick**4)
        return Link(length, f"general A={area} I={inertia} shear_coefficient={draw.choice(0.4, 0.7, 1)}", area, inertia, modulus,
                    density, ratio)
    inner = few_digits(draw.uniform(0.3, 0.95)*thick) if kind == "tube" else 0
    section = f"tube outer={thick} inner={inner}" if inner else f"circle diameter={thick}"
    return Link(length, section, math.pi*(thick**2 - inner**2)/4, math.pi*(thick**4 - inner**4)/64, modulus, density, ratio)


def link_cards(draw, links, things):
    """Materials, sections and links; which pin comes first is a matter of chance. Returns for each link whether it is turned."""
    lines = []
    if "rigid" in things:
        for link in links:
            link.rigid = draw.uniform() < 0.4
        if all(link.rigid for link in links):
            links[int(draw.uniform(0, 3))].rigid = False
    for i, link in enumerate(links):
        lines += [f"MATERIAL m{i + 1} {link.material}", f"SECTION s{i + 1} {link.section}"]
        ends = ENDS[i] if draw.uniform() < 0.6 else " ".join(reversed(ENDS[i].split()))
        card = f"LINK {LINKS[i]} {ends} length={link.length} material=m{i + 1} section=s{i + 1}"
        if link.rigid:
            card += " rigid"
            if draw.uniform() < 0.6:
                mass = few_digits(link.mass()*draw.power(-1, 1))
                card += f" mass={mass} inertia={few_digits(mass*link.length**2*draw.power(-2, 0))}"
                along, beside = link.length*draw.uniform(-0.3, 1.3), link.length*draw.uniform(-0.5, 0.5)
                card += f" center={few_digits(along)},{few_digits(beside)}"
        lines.append(card)
    return lines


def mass_cards(draw, links, things):
    """Masses along links that bend and beside those that do not, and what they weigh in all, of the lightest link."""
    lines, heaviest = [], 0
    if "masses" in things:
        largest = draw.choice(0, 1, 2, 3, 6)
        for name, link in zip(LINKS, links):
            for _ in range(draw.choice(0, 1, 1, 2, 3)):
                if link.rigid:
                    continue
                mass = few_digits(link.mass()*draw.power(-2, largest))
                lines.append(f"MASS {name} {mass} at={few_digits(link.length*draw.uniform(0.02, 0.98))}")
                heaviest = max(heaviest, mass)
    if "offsets" in things:
        for name, link in zip(LINKS, links):
            for _ in range(draw.choice(0, 1, 2) if link.rigid else 0):
                mass = few_digits(link.mass()*draw.power(-1, 2))
                lines.append(f"MASS {name} {mass} at={few_digits(link.length*draw.uniform(-0.5, 1.5))} "
                             f"offset={few_digits(link.length*draw.uniform(-0.5, 0.5))}")
                heaviest = max(heaviest, mass)
    if "pins" in things:
        for pin in "AB":
            if draw.uniform() < 0.6:
                mass = few_digits(max(link.mass() for link in links)*draw.power(-2, 3))
                lines.append(f"PINMASS {pin} {mass}")
                heaviest = max(heaviest, mass)
    return lines, heaviest


def load_cards(draw, links, things, sine, heaviest):
    """Forces in units of what buckles the weakest link, a thousand times that at the most."""
    bending = [link for link in links if not link.rigid]
    weakest = min(link.euler() for link in bending)
    most = 0.1*min(link.shear_stiffness() for link in bending) if "shear" in things else math.inf
    lines = []
    if "forces" in things or "pressed" in things:
        times = draw.power(0, 3) if "pressed" in things else draw.power(-3, 0.5)
        force = min(times*weakest*sine, most*sine)
        for pin in draw.choice("A", "B", "B", "AB"):
            angle = draw.uniform(0, 2*math.pi)
            lines.append(f"FORCE {pin} {few_digits(force*math.cos(angle))} {few_digits(force*math.sin(angle))}")
    if "torque" in things:
        torque = min(draw.power(-2, 0.5)*weakest, most)*sine*min(link.length for link in links)
        lines.append(f"TORQUE {draw.choice(*LINKS)} {draw.choice(-1, 1)*few_digits(torque)}")
    if "gravity" in things:
        pull = min(9.81, 3*weakest*sine/(heaviest + sum(link.mass() for link in links)))
        lines.append(f"GRAVITY {draw.choice(0, few_digits(-0.5*pull))} {few_digits(-pull)}")
    return lines


def draw_speeds(draw, links, things, sine, heaviest):
    """So that inertia compresses links less than what buckles them, or more where that is wanted."""
    if not things & {"fast", "forces", "masses", "offsets", "shear"} and draw.uniform() < 0.4:
        return [0]
    bending = [link for link in links if not link.rigid]
    natural = min(link.natural() for link in bending)*sine**1.5/math.sqrt(1 + heaviest/min(link.mass() for link in bending))
    speed = few_digits(natural*(draw.power(-0.3, 0.7) if "fast" in things else draw.power(-2, -0.3)))
    return draw.choice([speed], [0, speed])


def random_deck(seed, number):
    draw = Generator(int.from_bytes(hashlib.sha256(f"{seed} {number}".encode()).digest()[:8], "big") | 1)
    draw.uniform()
    kind = list(KINDS)[number % len(KINDS)]
    things, modes = KINDS[kind]
    if things is None:
        things = {thing for thing in sorted(ALL) if draw.uniform() < 0.4}
    ground, lengths, cranks, sine = draw_geometry(draw)
    links = [draw_link(draw, length, "shear" in things) for length in lengths]
    lines = ["UNITS m kg s", "GROUND O2 0 0", f"GROUND O4 {ground} 0", *link_cards(draw, links, things), "DRIVE crank",
             f"BRANCH {draw.choice('open', 'crossed')}"]
    masses, heaviest = mass_cards(draw, links, things)
    lines += masses + load_cards(draw, links, things, sine, heaviest)
    speeds = draw_speeds(draw, links, things, sine, heaviest)
    wanted = draw.choice(*modes)
    lines += [f"SPEED {' '.join(map(str, speeds))}", "INERTIA distributed", f"MODES {wanted}"]
    effects = draw.choice("rotary shear", "rotary shear", "rotary", "shear") if "shear" in things else draw.choice("", "", "rotary")
    lines.append(f"EFFECTS axial {effects}".rstrip())
    return RandomDeck(number, kind, lines, cranks, speeds, wanted)
