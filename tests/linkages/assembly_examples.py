#!/usr/bin/env python3
"""Linkages of which the assembly is easily mistaken, each also turned, mirrored, larger and smaller, and with its cards in another order.

    assembly_examples.py [--program PATH] [--scratch FOLDER]

Change points of parallelograms, kites and trammels, redundant cranks, scissors, folding arms of one length, several ranges of a drive,
cycles of many turns, pins that only lengths place. Right values are closed forms, or positions found here by halving.
A case that fails is a line with the view in which it does; its deck stays in the scratch folder. The last line is `N passed, N failed`.
"""

import math
import os
import sys

import tables

RAMMED = """GROUND O 0 0
GROUND E 300 0
LINK crank O A {extra}
LINK coupler A B
LINK rocker E B
{ram}
PIN A 0 100
PIN B 280 180
DRIVE ram length
CRANK {length}
"""
FIVE_BAR = """GROUND A 0 0
GROUND B 200 0
PIN C 30 0
PIN D 240 0
PIN E 135 150
LINK a A C
LINK b B D
LINK c C E
LINK d D E
DRIVE a
DRIVE b ratio={ratio} phase=0
CRANK {cranks}
"""


def angle_of_ram(along_crank, along_coupler, length):
    """Of the crank of RAMMED where the ram between its crank and its coupler has a length, nearest to the drawing."""
    lengths = 100.0, math.dist((0, 100), (280, 180)), math.dist((300, 0), (280, 180))

    def ram(angle):
        a = 100*math.cos(angle), 100*math.sin(angle)
        d = math.dist(a, (300, 0))
        x = (d*d + lengths[1]**2 - lengths[2]**2)/(2*d)
        y = math.sqrt(lengths[1]**2 - x*x)
        e = (300 - a[0])/d, -a[1]/d
        b = a[0] + x*e[0] - y*e[1], a[1] + x*e[1] + y*e[0]
        q = tuple(a[k] + along_coupler/lengths[1]*(b[k] - a[k]) for k in (0, 1))
        return math.dist((along_crank*math.cos(angle), along_crank*math.sin(angle)), q) - length

    low, high = math.radians(70), math.radians(110)
    assert ram(low)*ram(high) < 0
    for _ in range(60):
        middle = 0.5*(low + high)
        if ram(middle)*ram(low) > 0:
            low = middle
        else:
            high = middle
    return math.degrees(low)


def scissors(stages, to):
    """Arms of length 2, crossed, on a pin and a slider, at 30 degrees, with a ram from the pin to one of the others."""
    w, h = 2*math.cos(math.radians(30)), 1.0
    lines = ["GROUND O 0 0", "GUIDE floor 0 0 angle=0", "SLIDER S floor", "DRIVE ram length", f"LINK ram O {to}", f"PIN S {w!r} 0"]
    for k in range(1, stages + 1):
        below = ("O", "S") if k == 1 else (f"L{k - 1}", f"R{k - 1}")
        lines += [f"LINK a{k} {below[0]} M{k} R{k}", f"LINK b{k} {below[1]} M{k} L{k}", f"PIN M{k} {w/2!r} {(k - 0.5)*h!r}",
                  f"PIN R{k} {w!r} {k*h!r}", f"PIN L{k} 0 {k*h!r}"]
    return "\n".join(lines) + "\n"


# Deck without what it reports, and what is expected: (table, row, column, kind, value, tolerance). Kinds: an angle; a length; a number;
# places of a pin; ends of a range of angles, or of lengths. Rows at a crank have it as their first word.
CASES = {
    "parallelogram": ("GROUND O2 0 0\nGROUND O4 4 0\nLINK crank O2 A length=2\nLINK coupler A B length=4\nLINK rocker O4 B length=2\n"
                      "DRIVE crank\nPIN A 1.9923893961834911 0.17431148549531633\nPIN B 5.9923893961834911 0.17431148549531633\nCRANK 5 to 355 step 10\n",
                      [("kinematics", {"crank": c}, "theta3", "angle", 0.0, 1e-9) for c in (5, 175, 185, 225, 355)]),
    "three cranks": ("GROUND O1 0 0\nGROUND O2 1500 0\nGROUND O3 700 500\nLINK c1 O1 A1\nLINK c2 O2 A2\nLINK c3 O3 A3\nLINK plate A1 A2 A3\n"
                     "PIN A1 259.807621 150\nPIN A2 1759.807621 150\nPIN A3 959.807621 650\nDRIVE c1\nCRANK 5 to 355 step 10\n",
                     [("kinematics", {"crank": c, "link": "plate"}, "theta", "angle", 0.0, 1e-7) for c in (105, 185, 325)]
                     + [("kinematics", {"crank": c, "link": "c2"}, "theta", "angle", c, 1e-7) for c in (105, 225, 325)]),
    # A plate on three cranks of one length, two of its change points 11 degrees apart, drawn with ten digits.
    "plate on a deltoid": ("GROUND Q 2513.4384035933726 1102.8747667578173\nGROUND T 1387.9361006936799 953.70154727859631\n"
                           "GROUND S 1777.5449278006345 634.4080828914241\nGROUND O 1194.1241 1722.4880000000001\n"
                           "LINK b B A length=705.87929999999994\nLINK plate B D E lengths=872.3532779826603,503.72944579408824 turns=-71.816071606116267\n"
                           "LINK second S D length=1457.5701665700001\nLINK crank A O length=705.87929999999994\nLINK c B Q length=1457.5701665700001\n"
                           "LINK third E T length=1457.5701665700001\nDRIVE crank\nPIN A 536.10963135774057 1466.9835084035997\n"
                           "PIN B 1059.9514302458017 993.84995864601785\nPIN D 324.05795445306342 525.38327477962468\n"
                           "PIN E -65.55087265389129 844.67673916679689\nCRANK 155 to 285 step 5\n",
                           [("linkage", None, None, "absent range", None, 0)] + [("kinematics", {"crank": c, "link": "plate"}, "theta", "angle", math.degrees(
                               math.atan2(634.4080828914241 - 1102.8747667578173, 1777.5449278006345 - 2513.4384035933726)), 1e-6) for c in (160, 275, 285)]),
    # One of Dixon's: the crank, the arm beside it and their base fold within half a degree.
    "narrow fold": ("GROUND P0 0.78854489999999999 1.2094141\nGROUND Q0 1.8533355479340521 1.0085687903220251\nLINK P3Q0 Q0 P3 length=1.3283705782780684\n"
                    "LINK P1Q0 Q0 P1 length=1.0835672394214675\nLINK P2Q1 P2 Q1 length=1.2183708924376886\nLINK P2Q2 Q2 P2 length=1.0943460025098324\n"
                    "LINK P1Q1 Q1 P1 length=1.2086986475865769\nLINK P0Q2 Q2 P0 length=1.0835672394214675\nLINK P2Q0 Q0 P2 length=1.0943460025098324\n"
                    "LINK crank Q1 P0 length=1.2086986475865769\nLINK P1Q2 P1 Q2 length=1.0835672394214675\nLINK P3Q1 P3 Q1 length=1.4322719195617046\n"
                    "LINK P3Q2 Q2 P3 length=1.3283705782780684\nDRIVE crank change_points=through\nPIN Q1 1.9918793002043784 1.0956655089652578\n"
                    "PIN P1 1.5727711065990744 -0.038045540081420033\nPIN P2 1.5811606135344163 -0.051390632624817703\n"
                    "PIN P3 1.7472313479930244 -0.31555744685843512\nPIN Q2 0.50798045866502228 0.16279976959655484\nCRANK 0\n",
                    [("linkage", None, None, "absent range", None, 0)] + [("linkage", {"part": part, "quantity": "turns"}, "value", "turns", turns, 1e-9)
                                                                          for part, turns in (("P0Q2", 2), ("P1Q0", 2), ("P1Q1", 1))]),
    "one stage": (scissors(1, "L1") + "CRANK 1.2\n", [("linkage", None, None, "lengths", (0.0, 2.0), 1e-12),
                                                       ("linkage", {"part": "a1", "quantity": "swing"}, "value", "number", 90.0, 1e-8)]),
    "two stages": (scissors(2, "R2") + "CRANK 2.4\n", [("linkage", None, None, "lengths", (2.0, 4.0), 1e-12)]),
    "four stages": (scissors(4, "M4") + "CRANK 3.5\n", [("linkage", None, None, "lengths", (1.0, 7.0), 1e-12)]),
    "five stages": (scissors(5, "M5") + "CRANK 4.5825756950\n", [
        ("kinematics", {"crank": 4.5825756950, "link": "a1"}, "theta", "angle", 30.0, 1e-7), ("linkage", None, None, "lengths", (1.0, 9.0), 1e-12)]),
    "six-bar": ("GROUND A -3.74 -2.41\nGROUND G 7.32 -3.51\nLINK AB A B\nLINK CBD B D C\nLINK DE D E\nLINK FE F E\nLINK CFG F G C\n"
                "PIN B -2.72 0.91\nPIN C 1.58 0.43\nPIN D -0.24 4.01\nPIN E 5.08 5.31\nPIN F 8.14 3.35\nDRIVE AB\nCRANK 0 to 360 step 5\n",
                [("linkage", None, None, "range", (67.2836352712264, 78.25414875334133), 1e-7)]),
    "double rocker": ("GROUND O1 0 0\nGROUND O2 800 0\nLINK crank O1 A\nLINK coupler A B C\nLINK rocker O2 B\nPIN A 706.9200738885869 329.64224415774555\n"
                      "PIN B 898.2976037589596 387.7339050112159\nPIN C 700 500\nDRIVE crank\nCRANK 0 to 360 step 5\n",
                      [("linkage", None, None, "range", tuple(math.degrees(math.acos((780**2 + 800**2 - s**2)/(2*780*800))) for s in (200, 600)), 1e-7)]),
    "ram between points": (RAMMED.format(extra="", length=165, ram="POINT p crank along=60\nPOINT q coupler along=150\nLINK ram p q"),
                           [("kinematics", {"link": "crank"}, "theta", "angle", angle_of_ram(60, 150, 165), 1e-9)]),
    "ram on an extension": (RAMMED.format(extra="p lengths=100,40 turns=0", length=282, ram="LINK ram p B"),
                            [("kinematics", {"link": "crank"}, "theta", "angle", angle_of_ram(140, math.dist((0, 100), (280, 180)), 282), 1e-9)]),
    "trammel": ("GROUND O 0 -170\nPIN P 0 -82.6\nPIN A 0 -302\nPIN B 0 47\nPIN E 0 428\nLINK bar P B E\nLINK crank O A\nLINK arm P A\n"
                "GUIDE y 0 -132 angle=90\nGUIDE x -141 47 angle=0\nSLIDER P y\nSLIDER B x\nDRIVE crank\nCRANK -88 to 268 step 7\n",
                [("linkage", {"part": "B", "quantity": "stroke"}, "value", "length", 2*129.6, 1e-6)]),
    "lift of two stages": ("GROUND O 0 0\nGUIDE floor 0 0 angle=0\nPIN B 160 0\nPIN A 80 20\nPIN C 160 40\nPIN D 0 40\nPIN E 80 60\nPIN F 160 80\n"
                           "PIN H 0 80\nLINK ram O B\nLINK up1 O A C\nLINK down1 B A D\nLINK up2 D E F\nLINK down2 C E H\nSLIDER B floor\n"
                           "DRIVE ram length\nCRANK 40 to 160 step 20\n",
                           [("linkage", {"part": part, "quantity": "swing"}, "value", "number", 90.0, 1e-6) for part in ("up1", "down1", "up2", "down2")]),
    "equal legs": ("GROUND O 0 0\nGUIDE floor 0 0 angle=0\nPIN A 80 20\nPIN B 160 0\nLINK left O A length=100\nLINK right B A length=100\nSLIDER B floor\n"
                   "DRIVE B floor\nBRANCH A left O B\nCRANK 20 to 180 step 20\n",
                   [("linkage", {"part": part, "quantity": "swing"}, "value", "number", 90.0, 1e-8) for part in ("left", "right")]),
    "ten turns": (FIVE_BAR.format(ratio=0.1, cranks="0 360 7300 9000"), [
        ("linkage", None, None, "absent range", None, 0), ("linkage", {"part": "b", "quantity": "turns"}, "value", "turns", 1.0, 1e-9),
        ("pins", {"crank": 7300, "pin": "E"}, None, "place", (129.5839245801198, 153.4625420860638), 1e-9),
        ("pins", {"crank": 9000, "pin": "E"}, None, "place", (95.0, 171.1724276862369), 1e-9)]),
    "half speed": (FIVE_BAR.format(ratio=0.5, cranks="0 to 720 step 10"),
                   [("linkage", {"part": "b", "quantity": "turns"}, "value", "turns", 1.0, 1e-9)]),
}
VIEWS = [("as it is", 0.0, 1, 1.0, False), ("turned", 30.0, 1, 1.0, False), ("mirrored", 0.0, -1, 1.0, False), ("turned and mirrored", -110.0, -1, 1.0, True),
         ("a thousand times as large", 0.0, 1, 1e3, False), ("a thousandth", 45.0, 1, 1e-3, True), ("in another order", 0.0, 1, 1.0, True)]


class View:
    """How a linkage is shown."""

    def __init__(self, name, angle, sense, scale, reverses):
        self.name, self.angle, self.sense, self.scale, self.reverses = name, angle, sense, scale, reverses

    def place(self, x, y):
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        y *= self.sense
        return self.scale*(x*c - y*s), self.scale*(x*s + y*c)

    def turn(self, angle):
        return self.sense*angle + self.angle

    def crank(self, c, is_length):
        return self.scale*c if is_length else self.turn(c)

    def step(self, c, is_length):
        return self.scale*c if is_length else self.sense*c

    def deck(self, text):
        lines = text.splitlines()
        is_length = any(line.startswith("DRIVE") and len(line.split()) == 3 and "=" not in line for line in lines)
        shown = [self.card(line.split(), is_length) for line in lines]
        # The order of pins at one place, and the first drive, stay.
        drives = [line for line in shown if line.startswith("DRIVE")]
        others = [line for line in shown if not line.startswith("DRIVE")]
        return (others[::-1] if self.reverses else others) + drives, is_length

    def card(self, words, is_length):
        keyword = words[0]
        if keyword in ("GROUND", "PIN", "GUIDE"):
            words[2:4] = map(repr, self.place(float(words[2]), float(words[3])))
        if keyword == "CRANK":
            words = [word if i == 0 or word in ("to", "step") else repr(self.step(float(word), is_length)) if words[i - 1] == "step" else
                     repr(self.crank(float(word), is_length)) for i, word in enumerate(words)]
        if keyword == "BRANCH" and self.sense < 0:
            words[2] = {"left": "right", "right": "left"}.get(words[2], words[2])
        out = []
        for word in words:
            key, _, value = word.partition("=")
            if not value:
                pass
            elif key == "angle":
                word = f"angle={self.turn(float(value))!r}"
            elif key in ("length", "along"):
                word = f"{key}={self.scale*float(value)!r}"
            elif key == "lengths":
                word = "lengths=" + ",".join(repr(self.scale*float(x)) for x in value.split(","))
            elif key == "turns":
                word = "turns=" + ",".join(repr(self.sense*float(x)) for x in value.split(","))
            elif key == "phase":
                ratio = float(words[2].partition("=")[2])
                word = f"phase={self.angle*(1 - ratio)!r}"
            out.append(word)
        return " ".join(out)


def near(a, b, tolerance):
    return abs(a - b) <= tolerance


def same_angle(a, b, tolerance):
    return abs((a - b + 180) % 360 - 180) <= tolerance


def fault_of(found, view, is_length, expected):
    """Why a value is not as expected; else None."""
    table, row, column, kind, value, tolerance = expected
    rows = found[table].rows
    if row is None:
        ends = {name: [r["value"] for r in rows if r["quantity"] == name] for name in ("range_from", "range_to")} if "quantity" in found[table].names else {}
        if kind == "absent range":
            return f"ranges {ends}" if any(ends.values()) else None
        if kind == "lengths":
            wanted = [view.scale*x for x in value]
            good = any(all(near(x, y, tolerance*view.scale*value[1]) for x, y in zip(pair, wanted)) for pair in zip(ends["range_from"], ends["range_to"]))
        else:
            wanted = sorted(map(view.turn, value))
            good = any(all(same_angle(x, y, tolerance) for x, y in zip(pair, wanted)) for pair in zip(ends["range_from"], ends["range_to"]))
        return None if good else f"ranges are {ends}, without {wanted}"
    wanted = dict(row)
    if "crank" in wanted:
        wanted["crank"] = view.crank(wanted["crank"], is_length)
    hits = [r for r in rows if all(r[name] == x if isinstance(x, str) else near(r[name], x, 1e-9*max(1.0, abs(x))) for name, x in wanted.items())]
    if not hits:
        return f"no row {wanted} in {table}.dat"
    for hit in hits:
        if kind == "place":
            x, y = view.place(*value)
            good, got = near(hit["x"], x, tolerance*view.scale) and near(hit["y"], y, tolerance*view.scale), (hit["x"], hit["y"])
        else:
            got = hit[column]
            good = (same_angle(got, view.turn(value), tolerance) if kind == "angle" else
                    near(got, view.scale*value, tolerance*view.scale) if kind == "length" else
                    near(abs(got), value, tolerance) if kind == "turns" else near(got, value, tolerance))
        if not good:
            return f"{wanted}: {column or 'place'} is {got}, and should be {value} (before the view)"
    return None


def main():
    options = tables.read_options(tables.new_parser(__doc__, "flexmech_examples"))
    passed = failed = 0
    for name, (text, expected) in CASES.items():
        for number, entry in enumerate(VIEWS):
            view = View(*entry)
            cards, is_length = view.deck(text)
            path = os.path.join(options.scratch, f"{name.replace(' ', '_')}_{number}.deck")
            reports = sorted({e[0] for e in expected} | {"linkage"})
            positions = any(card.startswith("CRANK") for card in cards)
            with open(path, "w", encoding="utf-8") as deck:
                deck.write("\n".join(["UNITS m kg s"] + cards + [f"REPORT {report}" for report in reports]) + ("\nSPEED 1\n" if positions else "\n"))
            try:
                found = tables.run(options.program, path, options.scratch)
                faults = [fault for fault in (fault_of(found, view, is_length, e) for e in expected) if fault]
            except (RuntimeError, KeyError) as reason:
                faults = [f"{type(reason).__name__} {reason}"]
            if faults:
                failed += 1
                print(f"not ok {path} ({view.name}): {'; '.join(faults)}")
            else:
                passed += 1
                print(f"ok {name} ({view.name})")
                os.remove(path)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
