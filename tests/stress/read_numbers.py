#!/usr/bin/env python3
"""The reader of numbers against Python's, bit by bit: random doubles, halves of two neighbours, long words, odd exponents.

    read_numbers.py PROGRAM [SEED [COUNT]]     PROGRAM is build/release/stress/read_words; 1,000,000 words of seed 1 by default

The same seed makes the same words. The last line is the count; exit status 1 when a word was misread.
"""

import math
import random
import re
import struct
import subprocess
import sys
from decimal import Decimal, getcontext

getcontext().prec = 1200
TINY = sys.float_info.min
MANTISSAS = ["0", "00.0", ".0", "1", "9.99", "2.2250738585072014", "1.7976931348623157", "1.7976931348623158", "2.225073858507201"]
EXPONENTS = ["0", "307", "308", "309", "310", "324", "4294967296", "4294967298", "18446744073709551616", "99999", "2147483648", "0" * 30 + "5"]


def double(bits):
    return struct.unpack("<d", struct.pack("<Q", bits))[0]


def digits(dice, count):
    return "".join(dice.choices("0123456789", k=count))


def exponent(dice, text):
    return dice.choice("eEdD") + dice.choice(["", "+", "-"]) + text


def word_of(dice):
    kind = dice.random()
    if kind < 0.35:
        value = double(dice.getrandbits(64))
        if not math.isfinite(value):
            return "1"
        return repr(value) if dice.random() < 0.5 else f"{value:.{dice.choice([14, 15, 16, 17, 18, 20, 30, 60])}e}"
    if kind < 0.55:
        value = double(dice.getrandbits(62))
        if not 1e-300 < value < 1e300:
            value = dice.random()
        number, _, power = str((Decimal(value) + Decimal(math.nextafter(value, math.inf))) / 2).partition("E")
        more = "0" * dice.choice([0, 1, 100, 900]) + dice.choice("0123")
        return number + ("" if "." in number else ".") + more + (f"e{power}" if power else "")
    if kind < 0.8:
        word = digits(dice, dice.choice([0, 1, 2, 5, 20, 300])) + dice.choice(["", "."]) + digits(dice, dice.choice([1, 2, 5, 20, 320]))
        return word if dice.random() < 0.3 else word + exponent(dice, digits(dice, dice.choice([1, 2, 3, 3, 3, 4, 10, 12, 21])))
    return dice.choice(["", "+", "-"]) + dice.choice(MANTISSAS) + exponent(dice, dice.choice(EXPONENTS))


def expected(word):
    word = word.lower().replace("d", "e")
    value = float(word)
    if math.isinf(value):
        return "is too large for a number"
    if abs(value) < TINY:
        return "is too small for a number" if re.search("[1-9]", word.partition("e")[0]) else "0" * 16
    return struct.pack(">d", value).hex().upper()


def main(program, seed="1", count="1000000"):
    dice = random.Random(int(seed))
    words = [word_of(dice) for _ in range(int(count))]
    printed = subprocess.run([program], input="\n".join(words) + "\n", capture_output=True, text=True, check=True).stdout.split("\n")[:-1]
    # Zero has no sign.
    wrong = [(word, found) for word, found in zip(words, printed, strict=True) if (found if found != "8" + "0" * 15 else "0" * 16) != expected(word)]
    for word, found in wrong[:20]:
        print(f"not ok {word}: {found}, not {expected(word)}")
    print(f"{len(words) - len(wrong)} passed, {len(wrong)} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
