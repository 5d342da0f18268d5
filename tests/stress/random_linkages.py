"""Random linkages from a fixed seed. The generator is our own, so that every Python gives the same ones."""

import math

from decks import Case, Linkage

NUMBER = 1003
SKIPPED = (465, 523, 766)  # pulled so hard that quadruple precision takes hours


class Generator:
    """xorshift64* (Vigna, ACM Trans. Math. Softw. 42 (2016) 30)."""

    def __init__(self, seed):
        self.state = seed

    def uniform(self, low=0.0, high=1.0):
        x = self.state
        x ^= x >> 12
        x ^= x << 25 & 0xFFFFFFFFFFFFFFFF
        x ^= x >> 27
        self.state = x
        return low + (high - low)*((x*0x2545F4914F6CDD1D & 0xFFFFFFFFFFFFFFFF) >> 11)/2**53

    def power(self, low, high):
        """Evenly distributed logarithm; few digits, so that the deck shows all of them."""
        return float(f"{10**self.uniform(low, high):.5g}")

    def choice(self, *items):
        return items[int(self.uniform(0, len(items)))]


def sine_at(ground, lengths, crank):
    """|sin(θ4 − θ3)|, or none where the linkage does not close."""
    x = ground - lengths[0]*math.cos(math.radians(crank))
    y = lengths[0]*math.sin(math.radians(crank))
    cosine = (lengths[1]**2 + lengths[2]**2 - x*x - y*y)/(2*lengths[1]*lengths[2])
    return math.sqrt(1 - cosine**2) if abs(cosine) < 1 else None


def random_section(draw, length):
    """A section of a link of 5 to 300 thicknesses, with its radius of gyration [m, in mm as the deck has it]."""
    thick = draw.power(-2.5, -0.7)*length
    kind = draw.choice("rectangle", "circle", "tube", "general")
    if kind == "rectangle":
        return f"rectangle thickness={thick:.6g} width={draw.power(0, 2):.6g}", thick/math.sqrt(12)
    if kind == "circle":
        return f"circle diameter={thick:.6g}", thick/4
    if kind == "tube":
        inner = draw.uniform(0.3, 0.95)*thick
        return f"tube outer={thick:.6g} inner={inner:.6g}", math.hypot(thick, inner)/4
    area, radius = draw.power(0, 3), thick/4
    return f"general A={area:.6g} I={area*radius**2:.6g}", radius


def random_case(draw, number):
    while True:
        ground, lengths = draw.power(1.5, 2.8), [draw.power(1.5, 2.8) for _ in range(3)]
        crank = round(draw.uniform(0, 360), 3)
        sine = sine_at(ground, lengths, crank)
        if sine is not None and sine > 0.01:
            break
    sections, materials, natural = [], [], []
    for length in lengths:
        section, radius = random_section(draw, length)
        modulus, density = draw.power(3, 5.6), draw.power(-9.3, -7.7)
        sections.append(section)
        materials.append(f"E={modulus:.6g} density={density:.6g}")
        natural.append((math.pi/length)**2*radius*math.sqrt(modulus/density))
    mass = 7.8e-9*100*sum(lengths)/3
    pins = [draw.choice(0, mass*draw.power(-2, 2)) for _ in range(2)]
    pins = [float(f"{pin:.6g}") for pin in pins]
    linkage = Linkage(ground, lengths, sections, materials, pins, draw.choice("open", "crossed"))
    # Loads grow like 1/sin⁴ towards a dead point.
    speed = float(f"{min(natural)*sine**2*draw.power(-2.5, -0.5):.5g}")
    solver, inertia = "auto", "distributed"
    way = draw.choice("accuracy", "accuracy", "deformation", "dense", "band")
    if way == "accuracy":
        mesh = f"MESH * accuracy=1e-{draw.choice(*range(3, 13))}"
    else:
        solver, inertia = way, draw.choice("distributed", "lumped")
        mesh = "\n".join(f"MESH {link} elements={int(draw.power(0.3, 1.3))} order={draw.choice(3, 3, 3, 4, 6, 9)}"
                         for link in ("crank", "coupler", "follower"))
    return Case("random", number, way, linkage, (crank,), (0, speed), mesh, solver, inertia)


def random_cases():
    """Lengths within a factor of 20 of each other, sections, materials, pin masses, speeds, branches, meshes and solvers."""
    draw = Generator(20101107)
    for number in range(1, NUMBER + 1):
        case = random_case(draw, number)
        if number not in SKIPPED:
            yield case
