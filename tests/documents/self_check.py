#!/usr/bin/env python3
"""Checks that the check of the documents finds a wrong digit, and puts the right one in.

Prints nothing if all is well; an assertion that fails ends it with status 1.
"""

from markdown import Sentence, tables
from numbers_in_text import Leading, Number, Phrase, Word, count, error, estimate, fixed, rough_error, rounding

LINES = """A page.

<!-- computed: frequencies -->
| crank | f1 | error | orders | words |
|---|---|---|---|---|
| 0° | 23.366918 | 1.2e-5 | 3.99, 4.00 | own |
| 30° | 41.957155 | 6.7e-16 | 1.00, 2.00 | 3 |

<!-- computed: others by make stress -->
| a |
|---|
| 1 |
""".split("\n")

ROWS = [[Word("0°"), fixed(23.36691845, 6), error(1.2049e-5), Phrase("{}, {}", [fixed(3.994, 2), fixed(3.996, 2)]), None],
        [Word("30°"), fixed(41.9571550001, 6), error(5.6e-16), Phrase("{}, {}", [fixed(1, 2), fixed(2, 2)]), None]]


def numbers():
    assert fixed(23.3669184, 6).agrees("23.366918") and not fixed(23.3669184, 6).agrees("23.366919")
    assert not fixed(23.3669184, 6).agrees("") and not fixed(23.3669184, 6).agrees("about 23")
    assert not fixed(float("nan"), 6).agrees("nan")
    assert fixed(-2.2, 0).agrees("−2") and not fixed(-2.2, 0).agrees("2")
    assert count(30000).agrees("30,000") and str(count(30000)) == "30,000"
    assert str(error(2.04e-5)) == "2.0e-5" and error(2.04e-5).agrees("2.0e-5") and not error(2.04e-5).agrees("2.3e-5")
    # Of another processor: an estimate, and a value within its error.
    assert estimate(7.8e-7).agrees("7.9e-7") and not estimate(7.8e-7).agrees("2.4e-6") and not estimate(7.8e-7).agrees("2.5e-7")
    assert Number(52.700051, ".5f", off=7.9e-7).agrees("52.70005") and Number(52.7000554, ".5f", off=7.9e-7).agrees("52.70005")
    assert not Number(52.700057, ".5f", off=7.9e-7).agrees("52.70005")
    # Rounding: a factor of three, or both next to nothing.
    assert error(2e-13).agrees("5.9e-13") and not error(2e-13).agrees("6.1e-13") and not error(2e-13).agrees("6.0e-14")
    assert error(6.7e-16).agrees("2.9e-15") and error(0).agrees("6.7e-16") and not error(6.7e-16).agrees("4.0e-15")
    assert error(2e-11, 1e-10).agrees("5.9e-11") and not error(2e-11).agrees("2.3e-11")
    assert rough_error(9e-16).agrees("3e-15") and not rough_error(9e-16).agrees("4e-15")
    assert rough_error(9e-12).agrees("1e-11") and not rough_error(9e-12).agrees("1e-10")
    assert rounding(-9e-13, 1e-12).agrees("< 1e-12") and not rounding(9e-13, 1e-12).agrees("9.0e-13")
    assert rounding(2e-12, 1e-12).agrees("2.0e-12") and not rounding(2e-12, 1e-12).agrees("< 1e-12")
    assert Leading(error(9.9e-2)).agrees("9.9e-2 (one element)") and not Leading(error(9.9e-2)).agrees("8.8e-2 (one element)")
    assert Leading(error(9.9e-2)).instead_of("2.0e-1 (one element)") == "9.9e-2 (one element)"


def whole_tables():
    lines = list(LINES)
    table, = tables(lines, None)
    assert table.name == "frequencies" and not list(table.faults(ROWS)), list(table.faults(ROWS))
    table.write(ROWS)
    assert lines == LINES
    for wrong, right in (("23.366918", "23.366919"), ("1.2e-5", "1.4e-5"), ("4.00 |", "4.01 |"), ("| 30°", "| 31°")):
        lines = [line.replace(wrong, right) for line in LINES]
        table, = tables(lines, None)
        assert len(list(table.faults(ROWS))) == 1, wrong
        table.write(ROWS)
        assert [line for line in lines if "6.7e-16" not in line and "5.6e-16" not in line] == \
            [line for line in LINES if "6.7e-16" not in line], wrong
        assert not list(table.faults(ROWS))
    table, = tables([line for line in LINES if "30°" not in line], None)
    assert list(table.faults(ROWS)) == ["1 rows are written, 2 are computed"]
    table, = tables(LINES, "stress")
    assert table.rows() == [["1"]]


def sentences():
    text = "The largest errors are 2.0e-4\nand 5.9e-3. More text, from −2 to +3 %."
    sentence = Sentence("errors are {} and {}.")
    assert not list(sentence.faults(text, [error(2e-4), error(5.9e-3)]))
    assert len(list(sentence.faults(text, [error(2e-4), error(4.8e-3)]))) == 1
    assert sentence.rewritten(text, [error(3.1e-4), error(4.8e-3)]).startswith("The largest errors are 3.1e-4\nand 4.8e-3. More")
    assert list(Sentence("errors were {}.").faults(text, [error(1)])) == ["'errors were {}.' stands there 0 times"]
    assert not list(Sentence("from {} to {} %").faults(text, [fixed(-2.1, 0), fixed(3.2, 0)]))


if __name__ == "__main__":
    numbers()
    whole_tables()
    sentences()
