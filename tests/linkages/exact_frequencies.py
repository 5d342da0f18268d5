"""Frequencies of the decks of tests/exact/linkages against exact values, or these values anew.

    exact_frequencies.py [NAME ...] [--program PATH] [--scratch FOLDER] [--skip-refused]
    exact_frequencies.py [NAME ...] --write

NAME.dat beside NAME.deck has the exact frequencies, 24 digits of each, at every position and speed of the deck.  A frequency fails if
it is farther from its exact value than its error column says, or than the accuracy of the deck.  Prints `ok` or `not ok` for every
deck, and the largest errors in the end.  With --write every value is computed twice, with 50 digits and with 60, and polynomials
of two orders; counts of eigenvalues on both sides prove its number.
"""
import argparse
import os
import re
import sys
import tempfile
from decimal import Decimal, getcontext

from decks import Deck
from solver import Failure
from tables import run
from vibrations import Structure, assemblies

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exact", "linkages")
MODES, DIGITS = 5, 24
WAYS = ((50, 40), (60, 50))                    # digits, order of polynomials


def structures(deck, order):
    """(speed as the deck has it, crank, structure) at every speed and position."""
    found = [(crank, model, q) for crank, model, q in assemblies(deck)]
    for speed in deck.speeds:
        for crank, model, q in found:
            structure = Structure(model, q, order=order)
            if "static" not in deck.effects:
                structure.load(model.state(q, crank * deck.crank_factor(), speed * deck.speed_factor(), deck.alpha()))
            yield speed, crank, structure.prepare()


def exact_rows(deck):
    """[(speed, crank, frequencies)], with 24 digits that both ways agree on."""
    rows = []
    for digits, order in WAYS:
        getcontext().prec = digits
        rows.append([(speed, crank, structure.frequencies(MODES)) for speed, crank, structure in structures(deck, order)])
    getcontext().prec = WAYS[0][0]
    for (_, crank, one), (_, _, other) in zip(*rows):
        if any(abs(a - b) > Decimal(10)**(-DIGITS - 1) * b for a, b in zip(one, other)):
            raise Failure(f"crank {crank}: not the same twice")
    return rows[1]


def write(name):
    """NAME.dat."""
    with open(os.path.join(FOLDER, name + ".deck"), encoding="utf-8") as file:
        text = file.read()
    title = re.search(r"(?m)^TITLE +(.*)$", text)[1]
    deck = Deck(text)
    linear = deck.drives[0]["linear"]
    lines = [f"# {title}: exact frequencies of {name}.deck",
             "# found twice by dynamic stiffness with a Wittrick-Williams count (tests/linkages/exact_frequencies.py --write)"]
    width = DIGITS + 6
    lines.append("#" + f"{'speed':>7}{'crank':>8}" + "".join(f"{'f' + str(k + 1):>{width}}" for k in range(MODES)))
    lines.append("#" + f"{deck.units.names[0] + '/s' if linear else 'rad/s':>7}{deck.units.names[0] if linear else 'deg':>8}"
                 + f"{'Hz':>{width}}" * MODES)
    last = None
    for speed, crank, frequencies in exact_rows(deck):
        if last is not None and speed != last:
            lines += ["", ""]
        last = speed
        values = [str(+round_to(value)) if value else "0" for value in frequencies]
        lines.append(f"{speed!s:>8}{crank!s:>8}" + "".join(f"{value:>{width}}" for value in values))
    with open(os.path.join(FOLDER, name + ".dat"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def round_to(value):
    return value.quantize(Decimal(1).scaleb(value.adjusted() - DIGITS + 1))


def read(name):
    """[(speed, crank, frequencies)] of NAME.dat."""
    with open(os.path.join(FOLDER, name + ".dat"), encoding="utf-8") as file:
        rows = [[Decimal(word) for word in line.split()] for line in file if line.strip() and not line.startswith("#")]
    return [(row[0], row[1], row[2:]) for row in rows]


def is_near(value, exact):
    """But for the rounding of units."""
    return abs(value - float(exact)) <= 1e-14 * abs(float(exact))


def compare(name, program, scratch):
    """(why it fails, number of frequencies, largest error by mode, largest estimate)."""
    path = os.path.join(FOLDER, name + ".deck")
    with open(path, encoding="utf-8") as file:
        accuracy = Decimal(re.search(r"accuracy=(\S+)", file.read())[1])
    table = run(program, path, scratch)["frequencies"]
    wrong, count, largest, most = list(table.failed), 0, [Decimal(0)] * MODES, Decimal(0)
    exact = read(name)
    if len(table.rows) + len(table.failed) != len(exact):
        wrong.append(f"{len(table.rows)} rows, not {len(exact)}")
    for speed, crank, frequencies in exact:
        row = next((row for row in table.rows if is_near(row["speed"], speed) and is_near(row["crank"], crank)), None)
        if row is None:
            wrong.append(f"no row at {speed}, {crank}")
            continue
        for k, frequency in enumerate(frequencies):
            count += 1
            value, estimate = Decimal(row[f"f{k + 1}"]), Decimal(row[f"error{k + 1}"])
            error = abs(value - frequency) / frequency if frequency else abs(value)
            largest[k], most = max(largest[k], error), max(most, estimate)
            if not error <= min(estimate, accuracy):
                wrong.append(f"speed {speed} crank {crank} f{k + 1} {value:.17g}, exact {frequency}: off by {error:.1e}, "
                             f"estimated {estimate:.1e}")
    return wrong, count, largest, most


def check(names, program, scratch, skip_refused):
    """Number of decks that fail."""
    failures, passed, counted, violations, largest = 0, 0, 0, 0, [Decimal(0)] * MODES
    for name in names:
        try:
            wrong, count, errors, most = compare(name, program, scratch)
        except RuntimeError as error:
            if skip_refused and str(error).startswith("exit 2"):
                print(f"ok {name} # skip: {error}")
                continue
            wrong, count, errors, most = [str(error)], 0, largest, Decimal(0)
        failures += bool(wrong)
        passed += not wrong
        violations += len(wrong)
        counted += count
        largest = [max(pair) for pair in zip(largest, errors)]
        print(f"not ok {name}: {wrong[0]}" + (f" (and {len(wrong) - 1} more)" if len(wrong) > 1 else "") if wrong
              else f"ok {name}: " + " ".join(f"{error:.1e}" for error in errors + [most]))
    print(f"# {counted} frequencies, {violations} violations; largest errors of f1 to f{MODES}: " + " ".join(f"{e:.1e}" for e in largest))
    print(f"# {passed} passed, {failures} failed")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--program", default=os.path.join("build", "release", "flexmech"))
    parser.add_argument("--scratch")
    parser.add_argument("--skip-refused", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    names = options.names or sorted(name[:-5] for name in os.listdir(FOLDER) if name.endswith(".deck"))
    if options.write:
        for name in names:
            print(name, flush=True)
            write(name)
        return 0
    if options.scratch:
        return 1 if check(names, options.program, options.scratch, options.skip_refused) else 0
    with tempfile.TemporaryDirectory() as scratch:
        return 1 if check(names, options.program, scratch, options.skip_refused) else 0


if __name__ == "__main__":
    sys.exit(main())
