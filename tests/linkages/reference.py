"""Writes the tables of a deck as the program does, from the independent solver: for tests of the checks themselves.

    reference.py DECK --out FOLDER [--doubles]

With --doubles everything is computed in doubles: how far off is rounding?
"""
import os
import sys
from decimal import Decimal

from decks import Deck
from solver import Failure, exact_state, positions


def wrapped(degrees):
    """In (-180, 180]."""
    return degrees - 360 * ((degrees - 180) / 360).to_integral_value(rounding="ROUND_CEILING")


def _number(value):
    return f"{float(value): .16E}"


def tables_of(deck, in_doubles=False):
    """{table: (columns, rows)} in the units of results."""
    units = deck.units.results
    model, found = positions(deck)
    exact, tables = None, {
        "kinematics": ("speed crank link theta omega alpha", []), "pins": ("speed crank pin x y vx vy ax ay", []),
        "reactions": ("speed crank pin link fx fy moment", []), "drive": ("speed crank drive position rate force", [])}
    for speed in deck.speeds:
        rate = speed * deck.speed_factor()
        shown = rate / (units["rate"] if deck.drives[0]["linear"] else units["speed"])
        for crank, q in zip(deck.cranks, found):
            if in_doubles:
                state = model.state(q, float(crank * deck.crank_factor()), float(rate), float(deck.alpha()))
                model.add_forces(state)
            else:
                exact, state = exact_state(deck, q, crank * deck.crank_factor(), rate, deck.alpha(), exact)
            for table, row in rows_of(model if in_doubles else exact, state, units):
                tables[table][1].append([_number(shown), _number(crank)] + row)
    return tables


def rows_of(model, state, units):
    """Rows without speed and crank, numbers as texts of 17 digits."""
    for name, body in model.bodies.items():
        if body.name:
            angle, rate, second = model.link_motion(state, name)
            degrees = wrapped(Decimal(angle) / units["angle"])
            yield "kinematics", [name, _number(degrees), _number(Decimal(rate) / units["speed"]), _number(second)]
    for pin in model.moving_pins:
        yield "pins", [pin] + [_number(Decimal(value) / units[kind]) for pair, kind in
                               zip(model.pin_motion(state, pin), ("length", "rate", "acceleration")) for value in pair]
    for (pin, link), (fx, fy, moment) in state.forces.items():
        values = zip((fx, fy, moment), ("force", "force", "moment"))
        yield "reactions", [pin, link] + [_number(Decimal(value) / units[kind]) for value, kind in values]
    for row, force in zip((row for row in model.rows if row[0] == "drive"), state.drives):
        drive = row[1]
        place, rate = model.drive_value(drive, state.first), model.drive_ratio(drive) * state.rate
        kinds = ("length", "rate", "force") if drive["linear"] else ("angle", "speed", "torque")
        yield "drive", [drive["name"]] + [_number(Decimal(value) / units[kind]) for value, kind in zip((place, rate, force), kinds)]


def main():
    words = [word for word in sys.argv[1:] if word != "--doubles"]
    path, folder = words[0], words[words.index("--out") + 1]
    try:
        with open(path, encoding="utf-8") as file:
            tables = tables_of(Deck(file.read()), "--doubles" in sys.argv)
    except Failure as failure:
        print(f"{path}: {failure}", file=sys.stderr)
        return 2
    folder = os.path.join(folder, os.path.splitext(os.path.basename(path))[0])
    os.makedirs(folder, exist_ok=True)
    for name, (columns, rows) in tables.items():
        with open(os.path.join(folder, name + ".dat"), "w", encoding="utf-8") as file:
            print("# the reference\n# " + columns + "\n# " + " ".join("-" for _ in columns.split()), file=file)
            for row in rows:
                print(*row, file=file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
