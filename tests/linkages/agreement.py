#!/usr/bin/env python3
"""Does a linkage that moves freely stay in the assembly that the tables of its positions have?

    agreement.py [SEED [COUNT]] [--inputs FOLDER] [--program PATH] [--scratch FOLDER]     300 random linkages of seed 1, and all of inputs/

Each linkage is given masses and let run on, by `REPORT motion`, through its change points and up to its limits. At the positions where
it is then, its places have to be those of `REPORT pins`, and of `REPORT geometry`, which figures and animations draw; and these positions
have to be in one range of `REPORT linkage`, that of the drawing. Motions are integrated and positions are solved for: they share no stepping.
Random linkages are those of `assemblies.py`, with change points and redundant links; of inputs/ those that have a mobility of one.
"""

import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import assemblies  # noqa: E402  pylint: disable=wrong-import-position
import tables  # noqa: E402  pylint: disable=wrong-import-position

TURNED = 378         # degrees in 6.6 s at 1 rad/s
MOST = 1e-6          # places by the size: the motion is integrated to 1e-10, and by a limit places are the roots of that
LEAST_OF_INPUTS = 20
DROPPED = {"REPORT", "CRANK", "SPEED", "LAW", "TIME", "VARY", "FRICTION", "SPRING", "FORCE", "TORQUE", "MOTOR", "DAMPER", "GRAVITY", "MESH",
           "MODES", "END", "DAMPING", "SHAFT", "PEAKS", "GAUGE", "EFFECTS", "INERTIA", "BALANCE", "OUTPUT", "LOAD", "SIZING"}


class Unfit(Exception):
    """A deck that is not compared, and why."""


def cards_of(text):
    """Cards of a deck without what acts on the linkage and without what is asked for; continued lines are joined."""
    lines = [re.sub(r"\s*!.*", "", line) for line in re.sub(r"&\s*(!.*)?\n\s*&?", " ", text).splitlines()]
    return [line for line in lines if line.split() and line.split()[0].upper() not in DROPPED]


def with_masses(cards):
    """Every link has a mass, and that of the drive the most, so that it does not come to rest beside a limit."""
    out, heavy = [], {name.lower() for line in cards if line.split()[0].upper() == "DRIVE" for name in line.split()[1:2]}
    for line in cards:
        words = line.split()
        if words[0].upper() == "LINK":
            words = [word for word in words if not re.match(r"(mass|inertia|center|section|material)=", word, re.IGNORECASE)]
            heavier = words[1].lower() in heavy
            words += [f"mass={1 if heavier else 1e-4}", f"inertia={1 if heavier else 1e-4}", "center=0,0"]
        elif words[0].upper() == "PIN" and any(word.lower().startswith("mass=") for word in words):
            words = [word for word in words if not word.lower().startswith("mass=")]
            if len(words) < 4:
                continue
        out.append(" ".join(words))
    return out


def run(program, name, cards, scratch):
    path = os.path.join(scratch, name + ".deck")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write("\n".join(cards) + "\n")
    try:
        return tables.run(program, path, scratch)
    except RuntimeError as reason:
        raise Unfit(str(reason)[:600]) from reason


def compare(program, name, text, scratch):
    """Faults of a deck, and its largest difference."""
    cards = [line.replace(" change_points=branch", "") for line in cards_of(text)]
    start = next((line.split()[1].rstrip(",") for line in text.splitlines() if line.upper().startswith("CRANK")), "60")
    drive = next((line.split() for line in cards if line.upper().startswith("DRIVE")), None)
    if drive is None:
        raise Unfit("nothing drives it")
    if sum(line.upper().startswith("DRIVE") and " free" in line.lower() for line in cards) > 1:
        raise Unfit("several drives are free")
    if "stop" in " ".join(drive):
        raise Unfit("it stops at change points")
    is_length = len(drive) > 2 and "=" not in drive[2] and drive[2].lower() not in ("free", "against")
    if is_length:
        raise Unfit("a slider or a ram drives it")
    # In which turn of the drive a linkage is drawn depends on the CRANK card: both decks have about the same.
    moving = with_masses(cards) + ["INERTIA distributed", f"CRANK {start} to {float(start) + TURNED} step {TURNED}", f"REPORT motion crank={start} speed=1rad/s end=6.6 step=0.11 pins=yes"]
    found = run(program, name + "_m", moving, scratch)
    # Through a limit of its drive a motion goes on to the other side of it, and tables do not.
    with open(os.path.join(scratch, name + "_m", "run.log"), encoding="utf-8") as log:
        turns = re.findall(r"^motion: at t=(\S+) s.*(?:on its other branch|turns back)", log.read(), re.MULTILINE)
    last = float(turns[0]) if turns else 1e99
    motion = [row for row in found["motion"].rows if row["time"] <= last]
    if len(motion) < 3:
        raise Unfit("it does not move")
    column = "crank" if "crank" in motion[0] else found["motion"].names[1]
    cranks = [row[column] for row in motion]
    at = run(program, name + "_p", cards + ["CRANK " + " ".join(f"{c:.17g}" for c in cranks), "SPEED 1 rad/s", "REPORT pins", "REPORT linkage",
                                       "REPORT geometry crank=" + ",".join(f"{c:.17g}" for c in cranks)], scratch)
    places = {}
    for row in at["pins"].rows:
        places.setdefault(row["pin"], []).append((row["crank"], row["x"], row["y"]))
    size = max(max(p[k] for rows in places.values() for p in rows) - min(p[k] for rows in places.values() for p in rows) for k in (1, 2))
    worst, faults = 0.0, []
    time_of = {row["time"]: row[column] for row in motion}
    moved = [(time_of[row["time"]], row["pin"], row) for row in found["motion_pins"].rows if row["time"] <= last]
    drawn = [(row["crank"], row["place"], row) for row in at["geometry"].rows if row["part"] == "pin" and row["place"] in places]
    if not drawn:
        faults.append("nothing is drawn")
    for crank, pin, row in moved + drawn:
        gaps = [max(abs(row["x"] - x), abs(row["y"] - y)) for c, x, y in places.get(pin, []) if abs(c - crank) <= 1e-9*max(1, abs(crank))]
        if not gaps:
            faults.append(f"no row of {pin} at {crank}")
        elif min(gaps) > MOST*size:
            faults.append(f"{pin} is {min(gaps)/size:.1e} of the size off at {crank}")
        worst = max([worst] + [min(gaps)/size] if gaps else [worst])
    return faults + range_faults(at, cranks), worst


def range_faults(at, cranks):
    """Whether all positions are in one range."""
    if "linkage" not in at or "quantity" not in at["linkage"].names:
        return []
    ranges, ends = [], {}
    for row in at["linkage"].rows:
        if row["quantity"] in ("range_from", "range_to"):
            ends[row["quantity"]] = row["value"]
            if row["quantity"] == "range_to":
                ranges.append((ends.pop("range_from", -1e99), row["value"]))
    if "range_from" in ends:
        ranges.append((ends["range_from"], 1e99))
    slack = 1e-4
    if not ranges or any(low - slack <= min(cranks) + turn and max(cranks) + turn <= high + slack
                         for low, high in ranges for turn in range(-3600, 3601, 360)):
        return []
    return [f"positions {min(cranks)} to {max(cranks)} are in none of {ranges}"]


def main():
    parser = tables.new_parser(__doc__, "flexmech_agreement")
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("count", nargs="?", type=int, default=300)
    parser.add_argument("--inputs", default="inputs")
    options = tables.read_options(parser)
    decks = []
    for name in sorted(os.listdir(options.inputs)):
        if name.endswith(".deck"):
            with open(os.path.join(options.inputs, name), encoding="utf-8") as deck:
                decks.append((name[:-5], deck.read()))
    inputs = len(decks)
    number = 0
    while len(decks) < inputs + options.count:
        number += 1
        try:
            case = assemblies.Case(number, options.seed, None)
        except assemblies.Undecided:
            continue
        if case.linkage.is_angle and not case.missing:
            decks.append((f"assembly_{options.seed}_{number}", case.text))
    passed = failed = of_inputs = 0
    worst, unfit = 0.0, {}
    for i, (name, text) in enumerate(decks):
        try:
            faults, gap = compare(options.program, name, text, options.scratch)
        except Unfit as reason:
            unfit.setdefault(re.sub(r".*error: |'[^']*'|[-0-9.]+", "", str(reason))[:60], []).append(name)
            continue
        of_inputs += i < inputs
        worst = max(worst, 0.0 if faults else gap)
        if faults:
            failed += 1
            print(f"not ok {name}: " + "; ".join(faults[:3]), flush=True)
        else:
            passed += 1
    for reason, names in sorted(unfit.items()):
        print(f"not compared: {len(names)}: {reason} ({', '.join(names[:3])})")
    if of_inputs < LEAST_OF_INPUTS:
        failed += 1
        print(f"not ok only {of_inputs} of {options.inputs} were compared")
    print(f"{of_inputs} of {inputs} decks of {options.inputs}; largest difference {worst:.1e} of the size")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
