"""Kinds of numbers for the reference solver: doubles to follow a motion, decimals of 40 digits for what is compared.

A field has number(text or number), sin, cos, sqrt, arctan2 and pi.  Nothing here is used by the program that is tested.
"""
import math
from decimal import Decimal, getcontext

getcontext().prec = 50
_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706798")


class Doubles:
    """The usual numbers."""
    pi = math.pi
    sin = staticmethod(math.sin)
    cos = staticmethod(math.cos)
    sqrt = staticmethod(math.sqrt)
    arctan2 = staticmethod(math.atan2)
    epsilon = 2.0**-52

    @staticmethod
    def number(value):
        return float(value)


def _sine_and_cosine(angle):
    """By series of an angle halved six times."""
    turns = (angle / (2 * _PI)).to_integral_value()
    small = (angle - turns * 2 * _PI) / 64
    square = small * small
    term, sine, order = small, small, 1
    while abs(term) > Decimal("1e-60"):
        term = -term * square / ((order + 1) * (order + 2))
        sine += term
        order += 2
    term, versine, order = square / 2, square / 2, 2       # 1 - cos, which keeps its digits when doubled
    while abs(term) > Decimal("1e-60"):
        term = -term * square / ((order + 1) * (order + 2))
        versine += term
        order += 2
    for _ in range(6):
        sine, versine = 2 * sine * (1 - versine), 2 * versine * (2 - versine)
    return sine, 1 - versine


class Digits:
    """Decimals of 50 digits, some 45 of them right."""
    pi = _PI
    epsilon = Decimal("1e-44")

    @staticmethod
    def number(value):
        return value if isinstance(value, Decimal) else Decimal(value)

    @staticmethod
    def sin(angle):
        return _sine_and_cosine(angle)[0]

    @staticmethod
    def cos(angle):
        return _sine_and_cosine(angle)[1]

    @staticmethod
    def sqrt(value):
        return value.sqrt()

    @staticmethod
    def arctan2(y, x):
        """Newton from the double."""
        radius = (x * x + y * y).sqrt()
        angle = Decimal(math.atan2(float(y / radius), float(x / radius)))
        for _ in range(3):
            sine, cosine = _sine_and_cosine(angle)
            angle += (y * cosine - x * sine) / (x * cosine + y * sine)
        return angle
