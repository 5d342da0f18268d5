"""Numbers of decks with their units, in SI, and the units of results."""
import re
from decimal import Decimal

from fields import Digits

_POUND, _INCH, _GRAVITY = Decimal("0.45359237"), Decimal("0.0254"), Decimal("9.80665")
_LBF = _POUND * _GRAVITY
FACTORS = {
    "m": 1, "mm": Decimal("1e-3"), "cm": Decimal("1e-2"), "in": _INCH, "ft": 12 * _INCH,
    "kg": 1, "g": Decimal("1e-3"), "tonne": 1000, "lbm": _POUND, "slinch": _LBF / _INCH, "slug": _LBF / (12 * _INCH),
    "s": 1, "ms": Decimal("1e-3"), "N": 1, "kN": 1000, "lbf": _LBF, "Pa": 1, "kPa": 1000, "MPa": Decimal("1e6"),
    "GPa": Decimal("1e9"), "psi": _LBF / _INCH**2, "deg": Digits.pi / 180, "rad": 1, "rpm": Digits.pi / 30, "J": 1,
}
# exponents of length, mass, time; angles count in degrees and speeds in rad/s whatever the UNITS
DIMENSIONS = {
    "number": (0, 0, 0), "length": (1, 0, 0), "mass": (0, 1, 0), "time": (0, 0, 1), "inertia": (2, 1, 0), "force": (1, 1, -2),
    "torque": (2, 1, -2), "speed": (0, 0, 0), "rate": (1, 0, -1), "alpha": (0, 0, 0), "acceleration": (1, 0, -2),
    "stiffness": (0, 1, -2), "damping": (0, 1, -1), "turning_stiffness": (2, 1, -2), "turning_damping": (2, 1, -1),
    "density": (-3, 1, 0), "area": (2, 0, 0), "second_moment": (4, 0, 0), "stress": (-1, 1, -2), "angle": (0, 0, 0),
}
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD](?=[+-]?\d)[+-]?\d+)?")


def unit_factor(text):
    """The factor of a product of units such as kg*mm2 or rad/s2."""
    factor = Decimal(1)
    for sign, name, power in re.findall(r"([*/]?)([A-Za-z]+)\^?(\d*)", text):
        one = Decimal(FACTORS[name]) ** int(power or 1)
        factor = factor / one if sign == "/" else factor * one
    return factor


class Units:
    """The UNITS card: what bare numbers mean, and the units of results."""

    def __init__(self, words):
        self.names = [word for word in words if "=" not in word]
        self.base = [Decimal(FACTORS[name]) for name in self.names]
        keys = dict(word.split("=") for word in words if "=" in word)
        english = self.names[0] in ("in", "ft")
        bare = self.factor("force")
        named = [name for name in ("N", "kN", "lbf") if abs(FACTORS[name] / bare - 1) < Decimal("1e-30")]
        length = self.base[0]
        self.results = {
            "length": length, "rate": length / self.base[2], "acceleration": length / self.base[2]**2,
            "force": unit_factor(keys["force"]) if "force" in keys else bare if named else _LBF if english else Decimal(1),
            "torque": unit_factor(keys["torque"]) if "torque" in keys else
                      self.factor("torque") if named else _LBF * _INCH if english else Decimal(1),
            "angle": Digits.pi / 180, "speed": unit_factor(keys["speed"]) if "speed" in keys else Decimal(1),
            "alpha": Decimal(1), "moment": None,
        }
        self.results["moment"] = self.results["torque"]
        self.results["mass"] = self.base[1]
        self.results["energy"] = unit_factor(keys["energy"]) if "energy" in keys else self.results["torque"] if english else Decimal(1)
        self.has_speed = "speed" in keys

    def factor(self, quantity):
        if quantity == "angle":
            return Digits.pi / 180
        result = Decimal(1)
        for base, power in zip(self.base, DIMENSIONS[quantity]):
            result *= base**power
        return result

    def value(self, text, quantity):
        """A number with or without a unit, in SI (decimal)."""
        found = _NUMBER.match(text)
        if not found:
            raise ValueError(f"no number: {text}")
        number = Decimal(found.group().replace("d", "e").replace("D", "e"))
        rest = text[found.end():]
        return number * (unit_factor(rest) if rest else self.factor(quantity))
