"""Decks for fuzz.py: sound ones made up, those of the repository, and what mutations make of both.

All choices come from `Dice`, which uses nothing of Python's generator but random(): its numbers for a seed are promised to
stay the same on any machine and in any later version.
"""

import itertools
import os
import random
import re
from glob import glob

from deck_language import language

NUMBER = re.compile(rb"(?<![A-Za-z_0-9.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")
REFUSED = os.path.join("tests", "decks")
# Cards that only linkages have that are no four-bars.
OTHER_LINKAGE = re.compile(rb"^ *(?:GUIDE|SLIDER|WELD|PIN|DRIVE +\S+ +[a-z]\w*|LINK +\S+(?: +[A-Z]\w*){3}) ", re.MULTILINE)
WORD = re.compile(rb"[A-Za-z][A-Za-z_0-9.'*-]*")
RANGE = re.compile(rb"([-+0-9.eEdD]+)[a-z/]*(\s+to\s+)([-+0-9.eEdD]+)[a-z/]*(\s+step\s+)([-+0-9.eEdD]+)", re.IGNORECASE)

EXTREMES = ["0", "-0", "0.0", "1", "-1", "1e-300", "1e-320", "1e-41", "1e-39", "1e29", "1e30", "1e31", "1e39", "1e308", "1e309",
            "-1e308", "4e-324", "2147483647", "2147483648", "-2147483649", "99999999999999999999", "1e", "1e+", "+", "-", ".", "nan",
            "inf", "0x10", "1,5", "2*3", "1/2", "1d9", "1.2.3", "1e-9", "1e9", "360", "180", "89.99999999999999", "1e-15"]
UNITS = ["m", "mm", "cm", "in", "ft", "kg", "g", "tonne", "lbm", "slug", "slinch", "s", "ms", "N", "kN", "lbf", "Pa", "kPa", "MPa",
         "GPa", "psi", "ksi", "kg/m3", "g/cm^3", "lbm/in3", "mm2", "in4", "mm^4", "deg", "rad", "rad/s", "rpm", "rad/s2", "N/mm2", "m/s2",
         "N*m", "lbf*in", "kg*m2", "kg*mm2", "N*m*s", "N*m*s/rad", "N*m/rpm"]
PIECES = [b"\0", b"\t", b"\r", b"\n", b"\r\n", b"&", b" & \n", b"!", b"#", b"=", b"==", b",", b",,", b"$", b"$x", b'"', b"'", b"\\",
          b"\xc3\xb6", b"\xef\xbb\xbf", b"\xe2\x82\xac", b"\xff\xfe", b"\x80", b"\x1b[31m", b"\x7f", b"\xf0\x9f\x94\xa7", b" "*300,
          b"x"*5000, b"\n"*50, b"\nINCLUDE part.deck\n", b"\nINCLUDE d.deck\n", b"\nSET x 1\n", b"\nVARY x 1 2\n", b"$half", b"\nSET x 2*(3 - $half)**2\n", b"**", b"sqrt(", b"-$half*", b"&\n"*20, b"%s%n", b"{", b"()", b"END\n", b"NaN", b"*****"]
# Reports that a sound deck with beams asks for, and those that need a card of their own or keys; all others fit any deck.
BEAM_REPORTS = ["kinematics", "inertia", "mesh", "frequencies", "shapes", "branches"]
OWN_CARD_REPORTS = ["motion", "transient", "summary", "friction"]
# MEASURE cards, nearly all of them sound, of pins 0 … 3 and links a, b, c of a four-bar.
MEASURES = ["reach distance {0} {2}", "far distance {1} {3}", "turn angle {a}", "lean angle {b}", "bend angle {c} against {b}",
            "place along {2} {a}", "beside across {0} {b}", "lift travel {1} 0 1", "way travel {2} -3 4", "twice sum 2 reach -0.5 lift",
            "both sum 1 turn -1 lean", "mixed sum 1 turn 1 reach", "still distance {0} {3}", "own along {1} {a}"]
# Those of a crank that turns at constant speed, and of a range of speeds.
RESPONSE_REPORTS = ["response", "strains", "peaks", "drive", "torque", "validity", "stability"]
RANGE_REPORTS = ["campbell", "intervals"]
LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}
MASSES = {"kg": 1.0, "g": 1e-3, "tonne": 1e3, "lbm": 0.45359237, "slug": 14.593903, "slinch": 175.126835}
TIMES = {"s": 1.0, "ms": 1e-3}

# A run should end soon: so many positions and elements at most, where the mutations leave the text readable.
MOST_STEPS, MOST_ELEMENTS, MOST_POINTS, MOST_MODES, MOST_ROWS = 24, 120, 60, 12, 200


class Dice:
    """Random choices that are the same everywhere."""

    def __init__(self, seed):
        self.random = random.Random(seed).random

    def below(self, number):
        return int(self.random()*number)

    def choice(self, values):
        return values[self.below(len(values))]

    def chance(self, probability):
        return self.random() < probability

    def between(self, low, high):
        return low + (high - low)*self.random()

    def factor(self, decades):
        """Anything from 10^-decades to 10^decades."""
        return 10.0**self.between(-decades, decades)

    def shuffle(self, values):
        for i in range(len(values) - 1, 0, -1):
            j = self.below(i + 1)
            values[i], values[j] = values[j], values[i]


def number(dice, value):
    return dice.choice(["{:.6g}", "{:.12g}", "{:.4e}", "{:.3f}" if abs(value) > 1 else "{:.9g}"]).format(value)


def quantity(dice, value, bare, units):
    """A number in SI, written in the deck's unit or in one of its own."""
    if not units or dice.chance(0.6):
        return number(dice, value/bare)
    unit = dice.choice(sorted(units))
    return number(dice, value/units[unit]) + unit


def link_lengths(dice):
    """Crank, coupler and follower for a ground of length 1: crank-rockers for the most part, then anything, then special forms."""
    kind = dice.random()
    if kind < 0.7:
        return [dice.between(0.15, 0.45), dice.between(0.8, 1.2), dice.between(0.8, 1.2)]
    if kind < 0.9:
        return [dice.between(0.05, 2.0), dice.between(0.2, 2.5), dice.between(0.2, 2.5)]
    return dice.choice([[1.0, 1.0, 1.0], [0.5, 1.0, 0.5], [0.4, 1.0, 0.4], [0.5, 0.5, 1.0], [0.25, 1.0, 0.25], [2.0, 2.0, 1.0],
                        [0.3, 0.3, 0.4], [0.5, 1.5, 1.0], [0.4, 0.8, 0.6]])


def meshes(dice, names):
    kind = dice.random()
    if kind < 0.4:
        return [f"MESH * accuracy={dice.choice(['1e-2', '1e-4', '1e-8', '1e-10', '1e-12', '1e-13'])}"]
    elements = dice.choice([1, 1, 2, 2, 3, 4, 6, 8, 12, 45 if dice.chance(0.15) else 2])
    cards = [f"MESH * elements={elements}"]
    if dice.chance(0.4) and elements < 10:
        cards[0] += f" order={dice.choice([3, 4, 5, 7, 12, 30 if elements < 3 else 6])}"
    if dice.chance(0.4):
        cards.append(f"MESH {dice.choice(names)} elements={dice.choice([1, 2, 4])}")
    return cards


def bodies(dice, links, pins, scale, mass, speed, bare):
    """Rigid links, bodies, masses, points, loads and motors, in proportion to a link's length and mass and to a speed [SI].

    `links` are LINK cards by name, and are changed; `bare` are the deck's units of length, mass and time.
    """
    length, inertia = (bare[0], LENGTHS), (bare[1]*bare[0]**2, {"kg*m2": 1.0, "kg*mm2": 1e-6})
    force, moment = (bare[1]*bare[0]/bare[2]**2, {"N": 1.0}), (bare[1]*bare[0]**2/bare[2]**2, {"N*m": 1.0})
    damping = (bare[1]*bare[0]**2/bare[2], {"N*m*s": 1.0, "N*m*s/rad": 1.0})
    names = list(links)

    def some(value, unit, signed=True):
        return quantity(dice, value*dice.factor(1)*(dice.choice([1.0, -1.0]) if signed else 1.0), *unit)

    rigid = [name for name in names if dice.chance(0.3)]
    if len(rigid) == len(names) and dice.chance(0.9):
        rigid = rigid[1:]
    for name in rigid:
        if dice.chance(0.5):
            links[name] += f" mass={some(mass, (bare[1], MASSES), False)} inertia={some(mass*scale**2, inertia, False)}"
        if dice.chance(0.3):
            links[name] += f" center={some(scale/3, (bare[0], {}))},{some(scale/9, (bare[0], {}))}"
        if "mass=" in links[name] and dice.chance(0.5):
            links[name] = links[name].replace(" material=steel section=s", "")
        links[name] += " rigid"
    cards = []
    for _ in range(dice.below(3)):
        name = dice.choice(names)
        beside = f" offset={some(scale/5, length)}" if name in rigid and dice.chance(0.7) else ""
        cards.append(f"MASS {name} {some(mass, (bare[1], MASSES), False)} at={quantity(dice, scale*dice.between(0, 0.1), *length)}{beside}")
    for probability, card in (
            (0.5, f"POINT P {dice.choice(names)} along={some(scale, length)} offset={some(scale, length)}"),
            (0.2, f"POINT Q {dice.choice(names)} along={some(scale, length)}"),
            (0.4, f"GRAVITY 0 {quantity(dice, -9.81, bare[0]/bare[2]**2, {'m/s2': 1.0})}"),
            (0.3, f"FORCE {dice.choice(pins[1:3])} {some(mass*speed**2*scale, force)} {some(mass*speed**2*scale, force)}"),
            (0.3, f"TORQUE {dice.choice(names)} {some(mass*speed**2*scale**2, moment)}")):
        if dice.chance(probability):
            cards.append(card)
    measured = measures(dice, names, pins) if dice.chance(0.4) else []
    cards += measured
    if dice.chance(0.6):
        turn = some(mass*speed**2*scale**2, moment, False)
        cards += dice.choice([[], [f"MOTOR torque={turn}"], [f"MOTOR stall={turn} noload={speed:.4g}rad/s"]])
        if dice.chance(0.4):
            cards.append(f"LOAD {dice.choice(names)} torque={some(mass*speed**2*scale**2/9, moment)} "
                         f"damping={some(mass*speed*scale**2/9, damping, False)}")
        end = min(2.0, dice.between(0.5, 9.0)/speed)
        in_time = " coordinates=yes" if measured and dice.chance(0.6) else ""
        cards.append(f"REPORT motion crank={dice.choice([0, 30, 45, 90, 200])} speed={speed*dice.between(-1, 1):.4g}rad/s "
                     f"end={quantity(dice, end, bare[2], TIMES)} step={number(dice, end/dice.choice([1, 7, 40])/bare[2]*0.999)}{in_time}")
    kinds = [kind for kind in dict.fromkeys(language().reports) if kind not in BEAM_REPORTS + OWN_CARD_REPORTS + RESPONSE_REPORTS + RANGE_REPORTS
             and dice.chance(0.3)]
    if not any(card.startswith("POINT") for card in cards) and dice.chance(0.9):
        kinds = [kind for kind in kinds if kind != "points"]
    if not measured and dice.chance(0.9):
        kinds = [kind for kind in kinds if kind != "coordinates"]
    elif measured and dice.chance(0.7):
        name = dice.choice(measured).split()[1]
        kinds = [kind for kind in kinds if kind != "coordinates"]
        kinds.append("coordinates" + dice.choice(["", f" ratio_to={name}", f" ratio_to={name}", " columns=power,rate"]))
        if dice.chance(0.1):
            kinds.append(f"summary of=value:{name},ratio:{dice.choice(measured).split()[1]} ratio_to={name}")
    return cards + ["REPORT " + kind + " crank=30,200"*(kind == "geometry") for kind in kinds], bool(rigid)


def measures(dice, names, pins):
    """Some MEASURE cards, with what sums add."""
    chosen = [form for form in MEASURES[:-3] if dice.chance(0.5)]
    for total in [form for form in chosen if " sum " in form]:
        chosen += [form for form in MEASURES if form.split()[0] in total.split()[3::2] and form not in chosen]
    if not chosen or dice.chance(0.1):
        chosen.append(dice.choice(MEASURES))
    return ["MEASURE " + form.format(*pins, **dict(zip("abc", names))) for form in chosen]


def requests(dice, by_accuracy, own_speed, rigid):
    """What is asked for; nearly always what goes together. Speeds are told apart by the links' own first vibration [rad/s]."""
    cards = [dice.choice([f"CRANK 0 to 360 step {dice.choice([30, 45, 72, 90])}", "CRANK 0 120 240", f"CRANK {dice.between(-400, 400):.6g}",
                          f"CRANK {dice.between(-180, 180):.4f} to {dice.between(200, 300):.3f} step 37.5", "CRANK 0 180",
                          "CRANK 0 0.001 0.01 0.1 1", "CRANK 1rad 2rad 180deg", "CRANK 90 to -90 step -15"])]
    if dice.chance(0.6):
        speed = own_speed*10**dice.between(-2.5, -0.3 if dice.chance(0.95) else 1.0)
        cards.append("SPEED " + dice.choice([f"0 {speed:.4g} rad/s", f"{speed:.5g}rad/s", f"{9.5*speed:.4f}rpm", f"{-speed:.3g} rad/s",
                                             f"0 to {speed:.6g} step {speed/2:.6g} rad/s", "0"]))
        if dice.chance(0.3):
            cards[-1] += f" alpha={dice.choice([0.0, 1.0, -10.0])*speed**2:.3g}rad/s2"
    careless = dice.chance(0.1)
    if dice.chance(0.9):
        cards.append("INERTIA " + ("distributed" if by_accuracy and not careless else dice.choice(["lumped", "distributed"])))
    for probability, card in ((0.5, "EFFECTS " + dice.choice(["static", "axial", "rotary", "shear", "rotary shear", "shear axial rotary"])), (0.3, "BRANCH " + dice.choice(["open", "crossed"])),
                              (0.5, f"MODES {dice.choice([1, 2, 3, 4, 6, 10])}")):
        if dice.chance(probability):
            cards.append(card)
    if dice.chance(0.5):
        cards.append("SOLVER " + dice.choice(["auto", "deformation"] if (by_accuracy or rigid) and not careless else ["dense", "band"]))
    for kind in [kind for kind in BEAM_REPORTS if dice.chance(0.4)] or ["frequencies"]:
        if kind == "inertia" and not any(card.startswith("INERTIA") for card in cards) and not careless:
            continue
        more = f" points={dice.choice([2, 3, 7, 40])}" if kind == "shapes" and dice.chance(0.3) else ""
        cards.append(f"REPORT {kind}{more}")
    if dice.chance(0.1):
        cards.append(f"REPORT summary of={dice.choice(['f1', 'f1,transmission_angle', 'f2,f1', 'torque', 'shaking_force,f1,bearing_force'])}")
    if not any(card.startswith("REPORT") for card in cards):
        cards.append("REPORT kinematics")
    return cards


def responses(dice, cards, names, lengths, own_speed):
    """The elastic response, in place of speeds of 0 and accelerations; `lengths` are those of the links as the deck writes them."""
    speed = own_speed*10**dice.between(-2.5, -0.3)
    cards[:] = [card for card in cards if not card.startswith("SPEED")]
    cards.append("SPEED " + dice.choice([f"{speed:.5g}rad/s", f"{-speed:.3g} rad/s", f"{speed:.4g} {1.1*speed:.4g} rad/s"]))
    time, ratio = f"time={dice.choice([0.0, 1e-4, 1e-2])/own_speed:.3g}s", f"ratio={dice.choice(['0', '0.01', '0.3'])}"
    cards += dice.choice([[], [f"DAMPING * {time}"], [f"DAMPING * {ratio}"], [f"DAMPING {names[1]} {ratio}", f"DAMPING * {time}"]])
    for name in ("g-1", "g_2"):
        if dice.chance(0.3):
            link = dice.below(3)
            cards.append(f"GAUGE {name} {names[link]} at={dice.choice(['0', lengths[link]])}{dice.choice(['', ' side=left', ' side=right'])}")
    if dice.chance(0.3):
        cards.append("EFFECTS response without=" + dice.choice(["coriolis", "centripetal,tangential", "axial,quadratic"]))
    more = dice.choice(["", "", " accuracy=1e-4", " accuracy=1e-9"])
    kinds = [kind for kind in RESPONSE_REPORTS if dice.chance(0.5)] or ["response"]
    if dice.chance(0.1):
        kinds, more = [dice.choice(RANGE_REPORTS)], dice.choice(["", " accuracy=1e-3"])
        cards[:] = [card for card in cards if not card.startswith("SPEED")]
        cards.append(f"SPEED {speed:.4g} {dice.choice([1.05, -1.0, 1.0])*speed:.4g} rad/s")
    elif dice.chance(0.1):
        kinds = []
        start = dice.choice(["", "", " start=steady", " perturb=1,0.001"])
        cards.append(f"REPORT transient turns={dice.choice([0.01, 0.1, 1.5])} crank={dice.choice([0, 90])}{start}")
    cards += [f"REPORT {kind}{more}" for kind in kinds]


def sound_deck(dice):
    """A deck that says something sensible, nearly always: other lengths, units, beams, speeds, orders, solvers, reports."""
    length, mass, time = (dice.choice(sorted(units)) for units in (LENGTHS, MASSES, TIMES))
    if dice.chance(0.5):
        length, mass, time = dice.choice([("mm", "tonne", "s"), ("m", "kg", "s"), ("in", "slinch", "s")])
    bare_length, bare_mass, bare_time = LENGTHS[length], MASSES[mass], TIMES[time]
    stress = bare_mass/(bare_length*bare_time**2)
    scale = 0.3*dice.factor(3 if dice.chance(0.2) else 0.5)
    names = dice.choice([["crank", "coupler", "follower"], ["a", "b", "c"], ["L-1", "L'2", "l_3.x"]])
    pins = dice.choice([["O2", "A", "B", "O4"], ["1", "2", "3", "4"]])
    turn = dice.choice([(1.0, 0.0), (1.0, 0.0), (0.6, 0.8), (-1.0, 0.0)])
    cards = [f"UNITS {length} {mass} {time}", f"GROUND {pins[0]} 0 0",
             f"GROUND {pins[3]} {quantity(dice, scale*turn[0], bare_length, LENGTHS)} {quantity(dice, scale*turn[1], bare_length, LENGTHS)}"]
    if dice.chance(0.7):
        cards.append("TITLE " + dice.choice(["A four-bar", "! # & = \"all\"", "Grösse ½ µm", "x"*200, "*** NaN Infinity"]))
    density = dice.between(500, 9000)*dice.factor(4 if dice.chance(0.1) else 0.1)
    modulus = 10**dice.between(9, 11.5)*dice.factor(6 if dice.chance(0.1) else 0.1)
    cards.append(f"MATERIAL steel E={quantity(dice, modulus, stress, {'GPa': 1e9, 'MPa': 1e6, 'psi': 6894.757})} "
                 f"density={quantity(dice, density, bare_mass/bare_length**3, {'kg/m3': 1.0, 'g/cm3': 1e3})} nu=0.3")
    depth = scale*10**dice.between(-3.5, -1.0)
    side = [quantity(dice, depth*ratio, bare_length, LENGTHS) for ratio in (1.0, dice.between(0.5, 9.0), 0.7)]
    cards.append("SECTION s " + dice.choice([f"rectangle thickness={side[0]} width={side[1]}", f"circle diameter={side[0]}",
                                             f"tube outer={side[0]} inner={number(dice, 0.7*depth/bare_length)}",
                                             f"box thickness={side[0]} width={side[1]} wall={number(dice, 0.1*depth/bare_length)}",
                                             f"{dice.choice(['I', 'channel'])} depth={side[0]} width={side[1]} "
                                             f"web={number(dice, 0.1*depth/bare_length)} flange={number(dice, 0.2*depth/bare_length)} "
                                             f"plane={dice.choice(['web', 'flanges'])}",
                                             f"general A={number(dice, depth**2/bare_length**2)} "
                                             f"I={number(dice, depth**4/(12*bare_length**4))} depth={side[2]} shear_coefficient=0.8"]))
    ends = [pins[:2], pins[1:3], [pins[3], pins[2]]]
    links = {}
    for name, end, value in zip(names, ends, link_lengths(dice)):
        if dice.chance(0.3):
            end = end[::-1]
        links[name] = f"LINK {name} {end[0]} {end[1]} length={quantity(dice, scale*value, bare_length, LENGTHS)} material=steel section=s"
    own_speed = 3.0*(modulus/density)**0.5*depth/scale**2
    carried, rigid = [], False
    if dice.chance(0.4):
        carried, rigid = bodies(dice, links, pins, scale, density*depth**2*scale, own_speed*dice.factor(0.5)/10,
                                (bare_length, bare_mass, bare_time))
    cards += list(links.values()) + carried
    cards.append(f"DRIVE {names[0]}")
    if dice.chance(0.2):
        cards.append(f"PINMASS {dice.choice(pins)} {quantity(dice, density*depth**2*scale*dice.factor(3), bare_mass, MASSES)}")
    mesh = meshes(dice, [name for name in names if "rigid" not in links[name]] or names) if dice.chance(0.95) else []
    cards += mesh + requests(dice, not mesh or "accuracy" in mesh[0], own_speed, rigid)
    if dice.chance(0.15):
        responses(dice, cards, names, [re.search(r"length=(\S+)", links[name])[1] for name in names], own_speed)
    if dice.chance(0.3):
        with_names(dice, cards)
    if dice.chance(0.5):
        dice.shuffle(cards)
    if dice.chance(0.2):
        cards.append("END")
    return ("\n".join(cards) + "\n").encode()


# Arithmetic in SET that gives the value, to a rounding, or nothing that a card takes.
SUMS = ["2*{value}/2", "{value}*0.5/0.5", "3*{value} - 2*{value}", "sqrt({value}*{value})", "{value}*(sin(30deg) + 0.5)", "-(-{value})",
        "hypot(3, 4)/5*{value}", "max({value}, {value})", "{number}*1{unit}", "{value}/0", "{value} + 1", "1/{value}", "{value}**2", "2*pi*{value}"]


def with_names(dice, cards):
    """Puts `$name`s in place of values, with SET and VARY cards that give them."""
    places = [i for i, card in enumerate(cards) if "=" in card and not card.startswith("TITLE")]
    for name in ("v", "L-2", "w_3")[:1 + dice.below(3)]:
        i = dice.choice(places)
        entries = re.findall(r"(?<==)[^ $]+", cards[i])
        if not entries:
            continue
        value = dice.choice(entries)
        cards[i] = re.sub("=" + re.escape(value) + r"(?!\S)", "=$" + name, cards[i], count=1)
        found = re.match(NUMBER.pattern.decode(), value)
        if found and dice.chance(0.4):
            unit = value[found.end():]
            numbers = [f"{float(found[0])*factor:.9g}" for factor in (1.0, 1.01, 0.98)[:1 + dice.below(3)]]
            if dice.chance(0.3):
                cards.append(f"VARY {name} table=of_{name}")
                cards.append(f"TABLE of_{name} {unit or '-'} " + " ".join(numbers))
            else:
                cards.append(f"VARY {name} " + " ".join(number + unit for number in numbers))
        elif found and dice.chance(0.5):
            unit = value[found.end():]
            cards.append(f"SET {name} " + dice.choice(SUMS).format(value=value, number=found[0], unit=unit))
        else:
            cards.append(f"SET {name} {value}")


def change_number(dice, text):
    places = list(NUMBER.finditer(text))
    if not places:
        return text
    place = dice.choice(places)
    new = dice.choice(EXTREMES)
    try:
        value = float(place[0].replace(b"d", b"e").replace(b"D", b"E"))
        new = dice.choice([new, f"{value*dice.factor(0.3):.9g}", f"{value*dice.factor(0.3):.9g}", f"{value*dice.factor(9):.9g}",
                           f"{-value:.9g}", f"{int(min(abs(value), 1e9)) + 1}", f"{value:.17e}"])
    except ValueError:
        pass
    return text[:place.start()] + new.encode() + text[place.end():]


def change_unit(dice, text):
    places = [m for m in re.finditer(rb"(?<=[0-9. ])[A-Za-z/]+[234]?(?![\w=.'-])", text) if m[0].decode() in UNITS]
    if not places:
        return text
    place = dice.choice(places)
    return text[:place.start()] + dice.choice(UNITS).encode() + text[place.end():]


def change_word(dice, text):
    """Another word in place of one: of this deck, of the language, or nearly the same."""
    places = list(WORD.finditer(text))
    if not places:
        return text
    place = dice.choice(places)
    old = place[0].decode("latin-1")
    new = dice.choice([dice.choice(places)[0].decode("latin-1"), dice.choice(language().keywords), dice.choice(language().keys),
                       dice.choice(language().words), old.swapcase(), old[1:], old + old[-1], old[::-1], ""])
    return text[:place.start()] + new.encode("latin-1") + text[place.end():]


def change_lines(dice, text, other):
    """Deletes, doubles, swaps, joins, splits or brings in lines."""
    lines, others = text.split(b"\n"), other.split(b"\n")
    i, j = dice.below(len(lines)), dice.below(len(lines))
    kind = dice.below(8)
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(j, lines[i])
    elif kind == 2:
        lines[i], lines[j] = lines[j], lines[i]
    elif kind == 3:
        lines[i:i + 2] = [b" ".join(lines[i:i + 2])]
    elif kind == 4:
        lines.insert(i, dice.choice(others))
    elif kind == 5:
        dice.shuffle(lines)
    elif kind == 6:
        lines[i] = lines[i].replace(b" ", dice.choice([b" &\n", b"\t", b" & ! more\n", b"   "]), 1 + dice.below(3))
    else:
        lines = lines[:i] + others[dice.below(len(others)):]
    return b"\n".join(lines)


def change_bytes(dice, text):
    at = dice.below(len(text) + 1)
    kind = dice.below(8)
    if kind == 0:
        return text[:at]
    if kind == 1:
        return text[:at] + bytes([dice.below(256)]) + text[at + 1:]
    if kind == 2:
        return text[:at] + text[at + 1 + dice.below(4):]
    if kind == 3:
        return text.replace(b"\n", b"\r\n")
    if kind == 4:
        return text.replace(b" ", b"\t")
    if kind == 5:
        return dice.choice([text.upper(), text.lower(), b"\xef\xbb\xbf" + text, text.rstrip(b"\n"), text + text, b""])
    return text[:at] + dice.choice(PIECES) + text[at:]


def mutated(dice, text, other):
    """Some changes of a text; `other` is another deck to take lines from."""
    for _ in range(dice.choice([1, 1, 1, 2, 2, 3, 6])):
        text = dice.choice([lambda: change_number(dice, text), lambda: change_number(dice, text), lambda: change_unit(dice, text),
                            lambda: change_word(dice, text), lambda: change_lines(dice, text, other),
                            lambda: change_bytes(dice, text)])()
    return text


def tame(text):
    """The same with fewer positions, elements, points and modes where there are many: a fuzzed deck should end soon."""
    def fewer(match):
        try:
            first, last, step = (float(part.lower().replace(b"d", b"e")) for part in match.group(1, 3, 5))
        except ValueError:
            return match[0]
        if step == 0 or not MOST_STEPS < (last - first)/step < 900000:  # beyond: refused at once
            return match[0]
        return match[0][:match.start(5) - match.start()] + f"{(last - first)/MOST_STEPS:.6g}".encode()

    def at_most(limit):
        return lambda match: match[1] + (str(limit).encode() if limit < int(match[2]) < 500000 else match[2])

    def shorter(match):
        try:
            end, step = (float(NUMBER.match(part)[0].lower().replace(b"d", b"e")) for part in match.group(2, 4))
        except (TypeError, ValueError):
            return match[0]
        if step <= 0 or not MOST_ROWS < end/step <= 1e6:
            return match[0]
        return match[1] + f"{end:.6g}".encode() + match[3] + f"{end/MOST_ROWS:.6g}".encode()

    text = RANGE.sub(fewer, text)
    text = re.sub(rb"(?i)(\bend=)([-+.\w/]+)(\s+step=)([-+.\w/]+)", shorter, text)
    # Full matrices, and elements with many unknowns, cost more.
    costly = re.search(rb"(?i)dense|order\s*=\s*\d\d", text)
    text = re.sub(rb"(?i)(elements\s*=\s*)(\d+)(?![.\d])", at_most(MOST_ELEMENTS//(8 if costly else 1)), text)
    text = re.sub(rb"(?i)(points\s*=\s*)(\d+)(?![.\d])", at_most(MOST_POINTS), text)
    return re.sub(rb"(?i)(modes\s+)(\d+)(?![.\d])", at_most(MOST_MODES), text)


def with_cards(dice, text):
    """The deck with some cards more, of any pattern: keys with a value that may be one, or with none; names of the deck."""
    names = sorted({name for line in re.findall(r"^LINK (.+?)(?: \S+=.*| rigid.*)?$", text.decode(), re.MULTILINE) for name in line.split()})
    values = names + EXTREMES[:16] + ["10", "0.5", "90deg", "3N", "1,2", "0,1,2", "t.dat", "table", "$half", ""]

    def word(token):
        if token.endswith("="):
            return token + dice.choice(values)
        choices = [token] + token.split("=")[:1] if re.match(r"[a-z]\w*=", token) else token.split("|")
        return dice.choice(choices + [dice.choice(names or choices), dice.choice(values)])

    cards = []
    for _ in range(1 + dice.below(3)):
        form = re.sub(r"[][,]|\.\.\.", " ", dice.choice(dice.choice(language().patterns).split(" or ")))
        tokens = [token for token in form.split() if token != "|"]
        card = tokens[:1] + [word(token) for token in tokens[1:] if not dice.chance(0.3)]
        card += [dice.choice(language().keys) + "=" + dice.choice(values) for _ in range(dice.choice([0, 0, 0, 1, 2]))]
        cards.append(" ".join(card))
    return re.sub(rb"END\n$", b"", text) + "\n".join(cards + [""]).encode("utf-8")


def table(dice):
    """What t.dat holds: a force or a torque over a turn, sound or not."""
    count, unit = dice.choice([2, 3, 5, 9, 200]), dice.choice(["N", "N*m", "deg"])
    rows = [f"{360.0*i/(count - 1):.9g} {dice.between(-2.0, 2.0):.6g}" for i in range(count - 1)] + ["360 0"]
    rows[0] = "0 0"
    text = "\n".join([f"units {dice.choice(['deg', 'deg', 's'])} {unit}"] + rows + [""]).encode()
    return mutated(dice, text, text) if dice.chance(0.6) else text


def with_table(dice, text):
    """The deck with cards that name t.dat."""
    link = re.search(rb"^DRIVE (\S+)", text, re.MULTILINE)
    name = link[1].decode() if link else "crank"
    cards = [dice.choice([f"TORQUE {name} table=t.dat", f"TORQUE {name} table=t.dat over={name}", f"FORCE {name} 1 0 at=0 table=t.dat",
                          "LAW feed table=t.dat", f"MOTOR table=t.dat line={dice.below(3)}"]), "REPORT reactions"]
    return re.sub(rb"END\n$", b"", text) + "\n".join(cards + [""]).encode()


def words_of_command(dice):
    """A command line: options, whole or not, in any order; DECK stands for the deck's path."""
    options = ["--quiet", "--stats", "--check", "--help", "--help-cards", "--version", "--json", "--resume", "--threads", "--out", "--set", "--format",
               "--part", "--join", "--time-limit", "--format-only", "--man", "--completion", "--", "-", "-q", "-h"]
    values = ["DECK", "1", "2", "0", "-1", "1e99", "1/2", "3/2", "csv", "csv-only", "dat", "bash", "x=1", "half=2", "=", "", ".", "/dev/null", "o", "1s", "1h", "0s",
              "\xe4", "a b", "$(x)", "*"]
    words = []
    for _ in range(dice.choice([1, 2, 2, 3, 4, 6])):
        option = dice.choice(options)
        words += dice.choice([[option], [option, dice.choice(values)], [option + "=" + dice.choice(values)], [option[:-1]], [dice.choice(values)]])
    return words + (["DECK"] if dice.chance(0.7) else [])


def sources():
    """The decks of the repository, in the order of their names."""
    found = []
    folders = ("inputs", REFUSED, os.path.join("tests", "linkages", "decks"))
    for path in itertools.chain(*(sorted(glob(os.path.join(folder, "*.deck"))) for folder in folders)):
        with open(path, "rb") as deck:
            found.append((os.path.dirname(path), deck.read()))
    return found


def made_deck(dice, decks):
    """One deck and what kind it is: sound, or with cards or a table besides, or a mutation of a sound one, of one in inputs/, of a linkage
    that is no four-bar, of one that is refused."""
    inputs = [text for folder, text in decks if folder == "inputs"]
    refused = [text for folder, text in decks if folder == REFUSED]
    linkages = [text for folder, text in decks if OTHER_LINKAGE.search(text) and folder != REFUSED]
    kind, share = "sound", dice.random()
    if share < 0.2:
        text = sound_deck(dice)
    elif share < 0.32:
        kind, text = "sound, other cards", with_cards(dice, sound_deck(dice))
    elif share < 0.4:
        kind, text = "sound, a table", with_table(dice, sound_deck(dice))
    elif share < 0.7:
        kind, text = "sound, mutated", mutated(dice, sound_deck(dice), dice.choice(inputs))
    elif share < 0.8:
        kind, text = "inputs, mutated", mutated(dice, dice.choice(inputs), sound_deck(dice))
    elif share < 0.9:
        # Cards of another linkage are nearer to sense than those of a four-bar.
        kind, text = "linkages, mutated", mutated(dice, dice.choice(linkages), dice.choice(linkages))
    else:
        kind, text = "refused, mutated", mutated(dice, dice.choice(refused), dice.choice(inputs))
    return kind, tame(text)
