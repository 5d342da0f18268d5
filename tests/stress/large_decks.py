"""Large decks: of many masses, forces, pins, cards, rows of a table, speeds, positions, variants, links.

Each is made of a number: its cards, and the lines of its table t.dat.
"""

KINDS = {}


def kind(small, large):
    """How large a deck of this kind is in `make check` and in `make check-all`."""
    def named(function):
        KINDS[function.__name__.replace("_", " ")] = function, small, large
        return function
    return named


BEAM = "material=steel section=strip"
BODY = "mass=1e-3 inertia=1"


def four_bar(link):
    cards = ["UNITS mm tonne s", "GROUND O2 0 0", "GROUND O4 254 0", f"LINK crank O2 A length=100 {link}",
             f"LINK coupler A B length=279.4 {link}", f"LINK follower O4 B length=266.7 {link}", "DRIVE crank", "INERTIA distributed"]
    return cards + (beams() if link == BEAM else [])


def beams():
    return ["MATERIAL steel E=200000 density=7.8e-9", "SECTION strip rectangle thickness=1.6 width=25.4"]


def parallelograms(number, link):
    """A row of them, two links each: cranks that stand upright on pivots of different heights."""
    cards = ["UNITS mm tonne s", "GROUND O 0 0", "PIN A0 0 100", f"LINK crank O A0 {link}", "DRIVE crank", "INERTIA distributed"]
    for i in range(number//2):
        x, y = 254*(i + 1), 3*(i % 7)
        cards += [f"GROUND Q{i} {x} {y}", f"PIN A{i + 1} {x} {100 + y}", f"LINK c{i} A{i} A{i + 1} {link}", f"LINK f{i} Q{i} A{i + 1} {link}"]
    return cards + (beams() if link == BEAM else [])


@kind(30, 200)
def masses(number):
    return four_bar(BEAM) + ["CRANK 90", "REPORT frequencies"] + [f"MASS coupler at={279.4*(i + 1)/(number + 1):.6f} 1e-6" for i in range(number)], []


@kind(300, 10000)
def forces(number):
    return four_bar(BODY) + ["CRANK 0 to 360 step 90", "SPEED 5", "REPORT reactions"] + [
        f"FORCE coupler 0 -1 at={279.4*(i + 1)/(number + 1):.6f}" for i in range(number)], []


@kind(250, 2000)
def pins(number):
    cards = [card.replace("A B length=279.4", "A B " + " ".join(f"P{i}" for i in range(number))) for card in four_bar(BODY)]
    return cards + ["PIN A 0 100", "PIN B 270 170", "CRANK 60 to 120 step 30", "SPEED 5", "REPORT reactions"] + [
        card for i in range(number) for card in (f"PIN P{i} {10 + i*0.5} {200 + i % 7}", f"PINMASS P{i} 1e-4")], []


@kind(2000, 10000)
def points(number):
    return four_bar(BODY) + ["CRANK 0 to 360 step 30", "REPORT points"] + [f"POINT p{i} coupler along={279.4*i/number:.6f}" for i in range(number)], []


@kind(20001, 200001)
def speeds(number):
    return four_bar(BEAM) + ["CRANK 90", f"SPEED 0 to 10 step {10/(number - 1):.12g}", "MODES 1", "REPORT inertia"], []


@kind(2001, 20001)
def speeds_of_frequencies(number):
    return four_bar(BEAM) + ["CRANK 90", f"SPEED 0 to 10 step {10/(number - 1):.12g}", "MODES 1", "MESH * elements=2", "REPORT frequencies"], []


@kind(20000, 100000)
def positions(number):
    return four_bar(BODY) + [f"CRANK 0 to 360 step {360/number:.9g}", "REPORT kinematics"], []


@kind(500, 10000)
def variants(number):
    return [card.replace("279.4", "$b") for card in four_bar(BODY)] + ["CRANK 0 to 360 step 30", "REPORT kinematics",
                                                                       f"VARY b 270 to 280 step {10/number:.9g}"], []


@kind(200, 1000)
def rigid_links(number):
    return parallelograms(number, BODY) + ["CRANK 60 to 120 step 20", "SPEED 3", "REPORT reactions", "REPORT kinematics"], []


@kind(20, 60)
def links_that_bend(number):
    return parallelograms(number, BEAM) + ["CRANK 60 to 120 step 60", "SPEED 1", "MODES 3", "REPORT frequencies"], []


@kind(8, 20)
def modes(number):
    return four_bar(BEAM) + ["CRANK 90", "SPEED 1", f"MODES {number}", "MESH * accuracy=1e-13", "REPORT frequencies"], []


def rows_of(number, units):
    last = number - 1
    return [f"units {units}"] + [f"{360*i/last:.6f} {(0, 1, 2, 3, 2, 1)[i % 6] if 0 < i < last else 0}" for i in range(number)]


@kind(20000, 150000)
def rows_of_a_force(number):
    return four_bar(BODY) + ["CRANK 0 to 360 step 30", "SPEED 5", "REPORT reactions", "FORCE B 1 0 table=t.dat"], rows_of(number, "deg N")


@kind(20000, 150000)
def rows_of_a_torque(number):
    return four_bar(BODY) + ["CRANK 0 to 360 step 30", "SPEED 5", "REPORT reactions", "TORQUE follower table=t.dat"], rows_of(number, "deg N*m")


@kind(20000, 150000)
def rows_of_a_law(number):
    cards = [card.replace("DRIVE crank", "DRIVE crank law=feed") for card in four_bar(BODY)]
    return cards + ["LAW feed table=t.dat", "TIME 0 to 1 step 0.1", "REPORT reactions"], ["units s deg"] + [
        f"{i/(number - 1):.9f} {360*i/(number - 1):.9f}" for i in range(number)]
