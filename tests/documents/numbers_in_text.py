"""Numbers as documents print them, and whether a printed one is the one computed.

A value is compared in the form in which it is printed: what is written has to be the value rounded to the digits written, or within
the error that the program gives. Last digits depend on compiler and processor, and what rounding decides with them: of errors the
written one has to be within a factor, OF_ERRORS if they are differences from known values, FACTOR if they are estimates or, below
SMALL, come out of rounding; or both at most NOTHING.
"""

import math
import re

SMALL, FACTOR, OF_ERRORS, NOTHING = 1e-11, 3, 1.1, 3e-15


class Cell:
    """What a cell of a table has to hold; `written` is the text that stands there."""

    def agrees(self, written):
        return str(self) == written

    def instead_of(self, _written):
        return str(self)


class Number(Cell):
    """One number: `form` is that of Python's format(), `rough` a factor within which the written one may differ, `off` by how much."""

    def __init__(self, value, form, rough=None, off=0.0):
        self.value, self.form, self.rough, self.off = value, form, rough, off

    def __str__(self):
        return re.sub(r"e([+-])0*(\d)", lambda found: "e" + found[1].replace("+", "") + found[2], format(self.value, self.form))

    def agrees(self, written):
        text = written.replace(",", "").replace("−", "-")
        try:
            number = float(text)
        except ValueError:
            return False
        if self.rough is None:
            # Half a unit of the last digit, and a little for values that lie just between two.
            mantissa, _, exponent = str(self).replace(",", "").partition("e")
            return abs(number - self.value) <= self.off + 0.501*10.0**(int(exponent or 0) - len(mantissa.partition(".")[2]))
        if number <= 0 or self.value <= 0 or max(number, self.value) <= NOTHING:
            return abs(number - self.value) < NOTHING
        return abs(math.log(number/self.value)) <= math.log(self.rough)


class Phrase(Cell):
    """Several numbers in one cell, between fixed words: Phrase("{}, {}", numbers)."""

    def __init__(self, words, numbers):
        self.words, self.numbers = words, numbers

    def __str__(self):
        return self.words.format(*self.numbers)

    def agrees(self, written):
        found = re.fullmatch(re.escape(self.words).replace(r"\{\}", r"(\S+?)"), written)
        return bool(found) and all(number.agrees(text) for number, text in zip(self.numbers, found.groups()))


class Word(Cell):
    """No number, or one that has to have just these digits."""

    def __init__(self, text):
        self.text = str(text)

    def __str__(self):
        return self.text


def fixed(value, digits):
    return Number(value, f".{digits}f")


def count(value):
    return Number(value, ",.0f")


def error(value, small=SMALL):
    """A difference from a known value, in two digits; below `small` it comes out of rounding."""
    return Number(value, ".1e", FACTOR if abs(value) < small else OF_ERRORS)


def estimate(value):
    """An error that the program estimates, in two digits."""
    return Number(value, ".1e", FACTOR)


def rough_error(value):
    """An error of rounding, in one digit."""
    return Number(value, ".0e", FACTOR)


def rounding(value, bound):
    """A difference that is all rounding, which machines do differently: `< 1e-12` where it is below this bound."""
    return Word("< " + re.sub("e-0*", "e-", f"{bound:.0e}")) if abs(value) < bound else error(value)


class Leading(Cell):
    """A number, with words of the document behind it."""

    def __init__(self, number):
        self.number = number

    def __str__(self):
        return str(self.number)

    def agrees(self, written):
        return self.number.agrees(written.partition(" ")[0])

    def instead_of(self, written):
        return " ".join([str(self), *written.split(" ")[1:]])
