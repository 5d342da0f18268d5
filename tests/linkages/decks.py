"""Reads a deck of any linkage (docs/cards.md) into plain records, all numbers as decimals in SI units.

An own reader, for decks without mistakes: it knows the cards that the checks use, and says which it does not know.
"""
import itertools
import os
import re
from decimal import Decimal

from fields import Digits
from units import Units, unit_factor

IGNORED = {"TITLE", "MESH", "INERTIA", "END", "MODES", "SOLVER", "MOTOR", "GAUGE", "DAMPING"}


class Deck:
    """What the cards say.  links, guides and so on are in the order of the deck."""

    def __init__(self, text, folder="."):
        self.folder = folder                                   # of files of tables
        self.grounds, self.guides, self.pins = {}, {}, {}
        self.links, self.sliders, self.welds, self.points = {}, [], [], {}
        self.drives, self.branches = [], []
        self.masses, self.pin_masses, self.forces, self.torques = [], [], {}, {}
        self.applied, self.tables, self.frictions = [], {}, []  # all other loads: (keyword, words, keys)
        self.measures = {}                                     # words of MEASURE cards by their names
        self.actuated = []                                     # names on ACTUATE cards
        self.gravity = (Decimal(0), Decimal(0))
        self.materials, self.sections = {}, {}                 # density, area
        self.moduli, self.bending, self.effects = {}, {}, set()  # (E, nu), (second moment, shear coefficient), words of EFFECTS
        self.cranks, self.speeds, self.alpha_text = [], [Decimal(0)], "0"
        self.start = None                                      # of a motion
        cards = list(_cards(text))
        self.units = Units(next(words[1:] for words in cards if words[0].upper() == "UNITS"))
        for words in cards:
            keyword = words[0].upper()
            if keyword in IGNORED or keyword == "UNITS":
                continue
            bare = [word for word in words[1:] if "=" not in word]
            keys = dict(word.split("=", 1) for word in words[1:] if "=" in word)
            getattr(self, "_" + keyword.lower())(bare, keys)

    def _length(self, text):
        return self.units.value(text, "length")

    def _pair(self, words, quantity):
        return tuple(self.units.value(word, quantity) for word in words)

    def _keys(self, keys, **quantities):
        return {key: self.units.value(keys[key], quantity) for key, quantity in quantities.items() if key in keys}

    def _material(self, bare, keys):
        self.materials[bare[0]] = self._keys(keys, density="density")["density"]
        elastic = self._keys(keys, E="stress", nu="number")
        self.moduli[bare[0]] = (elastic.get("E"), elastic.get("nu"))

    def _section(self, bare, keys):
        """The area, and its second moment about the axis normal to the plane."""
        name, kind = bare
        size = self._keys(keys, thickness="length", width="length", diameter="length", outer="length", inner="length", A="area",
                          I="second_moment", shear_coefficient="number")
        self.sections[name] = {
            "rectangle": lambda: size["thickness"] * size["width"], "circle": lambda: Digits.pi * size["diameter"]**2 / 4,
            "tube": lambda: Digits.pi * (size["outer"]**2 - size["inner"]**2) / 4, "general": lambda: size["A"]}[kind]()
        second = {"rectangle": lambda: size["width"] * size["thickness"]**3 / 12, "circle": lambda: Digits.pi * size["diameter"]**4 / 64,
                  "tube": lambda: Digits.pi * (size["outer"]**4 - size["inner"]**4) / 64, "general": lambda: size["I"]}[kind]()
        self.bending[name] = (second, size.get("shear_coefficient"))

    def _ground(self, bare, _):
        self.grounds[bare[0]] = self._pair(bare[1:3], "length")

    def _pin(self, bare, _):
        self.pins[bare[0]] = self._pair(bare[1:3], "length")

    def _guide(self, bare, keys):
        self.guides[bare[0]] = self._pair(bare[1:3], "length") + (self.units.value(keys["angle"], "angle"),)

    def _link(self, bare, keys):
        link = {"pins": [word for word in bare[1:] if word.lower() != "rigid"], "rigid": len(bare) > 1 and "rigid" in map(str.lower, bare)}
        for key in ("length", "lengths"):
            if key in keys:
                link["lengths"] = self._pair(keys[key].split(","), "length")
        if "turns" in keys:
            link["turns"] = self._pair(keys["turns"].split(","), "angle")
        if "center" in keys:
            link["center"] = self._pair(keys["center"].split(","), "length")
        link.update(self._keys(keys, mass="mass", inertia="inertia"))
        link.update({key: keys[key] for key in ("material", "section") if key in keys})
        self.links[bare[0]] = link

    def _point(self, bare, keys):
        place = self._keys(keys, along="length", offset="length")
        self.points[bare[0]] = (bare[1], place["along"], place.get("offset", Decimal(0)))

    def _weld(self, bare, _):
        self.welds.append((bare[0], bare[1:]))

    def _slider(self, bare, keys):
        loads = self._keys(keys, mass="mass", inertia="inertia")
        self.sliders.append({"pin": bare[0], "guide": bare[1], "link": bare[2] if len(bare) > 2 else None,
                             "mass": loads.get("mass", Decimal(0)), "inertia": loads.get("inertia", Decimal(0))})

    def _drive(self, bare, keys):
        drive = {"name": bare[0], "words": [word for word in bare[1:] if word.lower() != "free"]}
        linear = len(drive["words"]) == 1                      # `DRIVE pin guide` or `DRIVE link length`
        quantity = "length" if linear else "angle"
        drive.update(self._keys(keys, at=quantity, ratio="number", phase=quantity))
        drive["linear"], drive["free"] = linear, "free" in (word.lower() for word in bare[1:])
        self.drives.append(drive)

    def _branch(self, bare, _):
        self.branches.append(bare)

    def _pinmass(self, bare, _):
        self.pin_masses.append((bare[0], self.units.value(bare[1], "mass")))

    def _mass(self, bare, keys):
        place = self._keys(keys, at="length", offset="length", inertia="inertia")
        self.masses.append((bare[0], self.units.value(bare[1], "mass"), place["at"], place.get("offset", Decimal(0)),
                            place.get("inertia", Decimal(0))))

    def _effects(self, bare, keys):
        if not keys:
            self.effects = {word.lower() for word in bare}

    def _gravity(self, bare, _):
        self.gravity = self._pair(bare, "acceleration")

    def _force(self, bare, keys):
        """A constant force on a pin, or any other."""
        if keys:
            self.applied.append(("force", bare, keys))
        else:
            self.forces[bare[0]] = self._pair(bare[1:3], "force")

    def _torque(self, bare, keys):
        if keys:
            self.applied.append(("torque", bare, keys))
        else:
            self.torques[bare[0]] = self.units.value(bare[1], "torque")

    def _load(self, bare, keys):
        self.applied.append(("load", bare, keys))

    def _spring(self, bare, keys):
        self.applied.append(("spring", bare, keys))

    def _damper(self, bare, keys):
        self.applied.append(("damper", bare, keys))

    def _stop(self, bare, keys):
        self.applied.append(("stop", bare, keys))

    def _measure(self, bare, _):
        self.measures[bare[0]] = bare[1:]

    def _actuate(self, bare, _):
        self.actuated += bare

    def _friction(self, bare, keys):
        self.frictions.append((bare, keys))

    def _table(self, bare, _):
        self.tables[bare[0]] = bare[1:]

    def table(self, name):
        """(unit, numbers) of both columns of a TABLE card, or of a file beside the deck."""
        if name in self.tables:
            words = self.tables[name]
        else:
            with open(os.path.join(self.folder, name), encoding="utf-8") as file:
                lines = [re.split("[!#]", line)[0].split() for line in file]
            words = [word for line in lines for word in (line[1:] if line[:1] == ["units"] else line)]
        numbers = [Decimal(word) for word in words[2:]]
        return [(unit, numbers[k::2]) for k, unit in enumerate(words[:2])]

    def _crank(self, bare, _):
        """Positions as numbers of the deck (degrees or lengths)."""
        self.cranks, unit = _ranged(bare)
        if unit == "rad":
            self.cranks = [crank * 180 / Digits.pi for crank in self.cranks]

    def _report(self, bare, keys):
        if bare == ["motion"] and re.fullmatch(r"[-+.\de]+", keys["crank"]):
            self.start = Decimal(keys["crank"])

    def _speed(self, bare, keys):
        self.speeds, unit = _ranged(bare)
        self.speed_unit = unit
        if unit in ("rpm", "rad/s") and not self.units.has_speed:
            self.units.results["speed"] = unit_factor(unit)
        self.alpha_text = keys.get("alpha", "0")

    def alpha(self):
        """The acceleration of the first drive, in SI."""
        return self.units.value(self.alpha_text, "acceleration" if self.drives[0]["linear"] else "alpha")

    def crank_factor(self):
        """From a number on CRANK to SI."""
        return self.units.factor("length") if self.drives[0]["linear"] else self.units.factor("angle")

    def speed_factor(self):
        """From a number on SPEED to SI."""
        unit = getattr(self, "speed_unit", None)
        if unit:
            return unit_factor(unit)
        return self.units.factor("rate") if self.drives[0]["linear"] else Decimal(1)


def _cards(text):
    """Words of every card, `key=value` joined, comments gone."""
    text = re.sub(r"&[ \t]*(?:[!#].*)?\n", " ", text)
    for line in text.splitlines():
        line = re.split(r"[!#]", line)[0]
        line = re.sub(r"\s*=\s*", "=", line)
        if not line.lstrip().upper().startswith("TITLE"):
            line = re.sub(r"\s*,\s*", ",", line)
        words = line.split()
        if words:
            yield words


def _ranged(words):
    """Numbers of CRANK or SPEED and their unit."""
    unit = None
    if re.fullmatch(r"[A-Za-z/]+", words[-1]):
        unit = words[-1]
        words = words[:-1]
    words = list(itertools.chain.from_iterable(word.split(",") for word in words))
    values, i = [], 0
    while i < len(words):
        if len(words) > i + 4 and words[i + 1] == "to":
            first, last, step = Decimal(words[i]), Decimal(words[i + 2]), Decimal(words[i + 4])
            values += [first + k * step for k in range(int((last - first) / step + Decimal("1e-9")) + 1)]
            i += 5
        else:
            values.append(Decimal(words[i]))
            i += 1
    return values, unit
