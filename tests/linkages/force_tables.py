"""Equilibrium of every body, pin and of the frame from the printed rows alone.

    force_tables.py SEED COUNT [--program PATH] [--scratch FOLDER] [--inputs FOLDER]

The linkages of random_loads.py, with every load, and with --inputs the rigid linkages of the decks there, their positions at a speed.
Newton's and Euler's law of each link from the rows of reactions.dat at its pins, of the blocks on it and of the drives in drives.dat,
with masses and loads of the deck; of each pin and its block; of the whole from the rows at the ground against frame.dat; forces of
bearings.dat against those of reactions.dat.  Of a four-bar the couples of friction are those of friction.dat.  What is left is at most
1e-10 of the largest force, or moment, of the position.
"""
import argparse
import math
import os
import re
import shutil
import sys
import tempfile

import compare
from compare import Wrong, index, row_of
from decks import Deck
from random_loads import make
from solver import Failure, Model, positions
from tables import run

ALLOWED = 1e-10
NO_FORCE = 1e-9  # N: at rest on springs without weight all forces are rounding
REPORTS = ("kinematics", "pins", "reactions", "drives", "bearings", "frame about=0,0", "friction")
# Cards of other reports, and those that the copy of a deck has of its own.
DROPPED = {"MESH", "MODES", "SOLVER", "GAUGE", "DAMPING", "BALANCE", "MOTOR", "EFFECTS", "REPORT", "END", "INERTIA", "TITLE", "LAW", "TIME",
           "SPEED", "ALPHA"}


class Redundant(Exception):
    """The independent solver has no links more than needed."""


class Place:
    """Sums of forces and moments at one position and speed."""

    def __init__(self, deck, model, state, tables, key):
        self.deck, self.model, self.state, self.tables, self.key = deck, model, state, tables, key
        self.units = {name: float(value) for name, value in deck.units.results.items() if value}
        self.sums, self.force, self.moment = {}, 1e-300, 1e-300
        self.ground = [0.0, 0.0, 0.0]

    def add(self, name, place, fx, fy, moment=0.0):
        """A force at a place on a body, a pin (about itself), or the ground (about the origin)."""
        total = self.sums.setdefault(name, [0.0, 0.0, 0.0])
        x, y = place
        if name[0] != "ground":
            x, y = x - self.about(name)[0], y - self.about(name)[1]
        parts = (fx, fy, x * fy - y * fx + moment)
        for k in range(3):
            total[k] += parts[k]
        self.force = max(self.force, abs(fx), abs(fy))
        self.moment = max(self.moment, abs(moment), abs(x * fy), abs(y * fx))

    def about(self, name):
        if name[0] == "body":
            return self.where(self.model.bodies[name[1]].pins[0])
        return self.where(name[1])

    def where(self, pin):
        if pin in self.model.ground:
            return self.model.ground[pin]
        return self.model.pin_motion(self.state, pin)[0]

    def on_pin(self, pin, fx, fy):
        """What acts on a pin; on a ground pivot nothing is asked, and a POINT that is no pin is of its link."""
        if pin in self.model.ground:
            return
        if pin in self.deck.points and (pin, self.deck.points[pin][0]) not in self.rows:
            self.add(("body", self.deck.points[pin][0]), self.where(pin), fx, fy)
        else:
            self.add(("pin", pin), self.where(pin), fx, fy)

    def joints(self):
        """Rows of reactions.dat: on links and pins, and the opposite on the ground."""
        force, moment = self.units["force"], self.units["torque"]
        guides = self.model.guides
        self.rows = {key[2:]: row for key, row in self.tables["reactions"].items() if key[:2] == self.key}
        for (pin, link), row in self.rows.items():
            # A four-bar has no column of couples: they are in friction.dat.
            fx, fy, m = row["fx"] * force, row["fy"] * force, (row["moment"] or 0.0) * moment
            place = self.where(pin)
            if link in guides:
                self.add(("pin", pin), place, fx, fy, m)
                self.add(("ground",), place, -fx, -fy, -m)
                continue
            self.add(("body", link), place, fx, fy, m)
            if pin in self.model.ground:
                self.add(("ground",), place, -fx, -fy, -m)
            else:
                self.add(("pin", pin), place, -fx, -fy, -m)

    def drives(self):
        """Torques, forces along lines; those of rams are in their pins."""
        for drive in self.deck.drives:
            value = row_of(self.tables["drive"], self.key + (drive["name"],), "drives.dat")["force"]
            words = [word for word in drive["words"] if word.lower() != "free"]
            if not words or words[0].lower() == "against":
                torque = value * self.units["torque"]
                self.add(("body", drive["name"]), self.about(("body", drive["name"])), 0.0, 0.0, torque)
                other = ("body", words[1]) if words else ("ground",)
                self.add(other, (0.0, 0.0) if not words else self.about(other), 0.0, 0.0, -torque)
            elif words[0].lower() != "length":
                value *= self.units["force"]
                if words[0] in self.model.guides:
                    _, _, cosine, sine = self.model.guides[words[0]]
                else:
                    sine, cosine = self.model.trigonometry(self.state.q, self.model.bodies[words[0]])
                fx, fy, place = value * cosine, value * sine, self.where(drive["name"])
                if drive["name"] in self.model.ground:
                    self.add(("ground",), place, fx, fy)
                else:
                    self.add(("pin", drive["name"]), place, fx, fy)
                self.add(("ground",) if words[0] in self.model.guides else ("body", words[0]), place, -fx, -fy)

    def frictions(self):
        """Couples of friction in the pins of a four-bar, whose reactions.dat has forces only."""
        if "friction" not in self.tables or not self.tables["is_four_bar"]:
            return
        for key, row in self.tables["friction"].items():
            if key[:2] != self.key:
                continue
            pin, link = key[2:]
            moment = row["moment"] * self.units["torque"]
            self.add(("body", link), self.about(("body", link)), 0.0, 0.0, moment)
            if pin in self.model.ground:
                self.add(("ground",), (0.0, 0.0), 0.0, 0.0, -moment)
                continue
            other = next(name for name, card in self.deck.links.items() if name != link and pin in card["pins"])
            self.add(("body", other), self.about(("body", other)), 0.0, 0.0, -moment)

    def named(self, place):
        """A place of a body that the tables take for a pin: a POINT with a load."""
        if place[0] == "pin":
            return place
        body, along, offset = place
        for name, (link, x, y) in self.deck.points.items():
            if link == body.name and (name, link) in self.rows and abs(float(x) - along) + abs(float(y) - offset) < 1e-12 * self.model.size:
                return "pin", name
        return place

    def loads(self):
        """Weights, inertia, and the loads of the deck."""
        model, s = self.model, self.state
        gx, gy = model.gravity
        for name, body in model.bodies.items():
            for mass, along, offset, inertia in body.particles:
                (place, _, (ax, ay)), _ = model.point_motion(s, body, along, offset)
                self.add(("body", name), place, mass * (gx - ax), mass * (gy - ay), -inertia * s.a[body.angle])
        for pin in model.moving_pins:
            mass, (fx, fy) = model.loads.get(pin, 0.0), model.forces.get(pin, (0.0, 0.0))
            _, _, (ax, ay) = model.pin_motion(s, pin)
            if mass or fx or fy:
                self.on_pin(pin, fx + mass * (gx - ax), fy + mass * (gy - ay))
        for link, torque in model.torques.items():
            self.add(("body", link), self.about(("body", link)), 0.0, 0.0, torque)
        for slider in self.deck.sliders:
            if slider["inertia"]:
                turned = -float(slider["inertia"]) * s.a[model.bodies[slider["guide"]].angle]
                self.add(("pin", slider["pin"]), self.where(slider["pin"]), 0.0, 0.0, turned)
        for load in model.applied:
            # What acts along a coordinate stands on what it moves against: what bodies do not give each other the ground does.
            inner = load.keyword in ("spring", "damper", "stop")
            for effect in load.effects(s):
                if len(effect) == 2:
                    self.add(("body", effect[0].name), self.about(("body", effect[0].name)), 0.0, 0.0, effect[1])
                    if inner:
                        self.add(("ground",), (0.0, 0.0), 0.0, 0.0, -effect[1])
                    continue
                place, fx, fy = effect
                if place[0] == "pin" and place[1] in model.ground:
                    continue
                if inner:
                    self.add(("ground",), load.where(s, place)[0], -fx, -fy)
                place = self.named(place)
                if place[0] != "pin":
                    self.add(("body", place[0].name), load.where(s, place)[0], fx, fy)
                else:
                    self.on_pin(place[1], fx, fy)

    def check(self):
        """The largest share that is left; raises Wrong."""
        self.joints()
        self.drives()
        self.frictions()
        self.loads()
        row = row_of(self.tables["frame"], self.key, "frame.dat")
        self.add(("ground",), (0.0, 0.0), -row["frame_x"] * self.units["force"], -row["frame_y"] * self.units["force"],
                 -row["frame_moment"] * self.units["torque"])
        if self.force < NO_FORCE:
            return 0.0
        moment = max(self.moment, self.force * self.model.size)
        largest, where = 0.0, ""
        for name, total in self.sums.items():
            for value, scale, axis in zip(total, (self.force, self.force, moment), ("x", "y", "moment")):
                if abs(value) / scale >= largest:
                    largest, where = abs(value) / scale, " ".join(name) + ", " + axis
        for (pin, link), joint in self.rows.items():
            bearing = row_of(self.tables["bearings"], self.key + (pin, link), "bearings.dat")
            for axis in ("fx", "fy"):
                off = abs(joint[axis] - bearing[axis]) * self.units["force"] / self.force
                if off >= largest:
                    largest, where = off, f"{axis} of {link} at {pin} in bearings"
        if not largest <= ALLOWED:
            raise Wrong(f"{largest:.1e} of the largest is left of {where} at {' '.join(self.key)}")
        return largest


def check(text, program, folder, name, most=7):
    """The largest share that is left at the positions of a deck; the number of bodies."""
    path = os.path.join(folder, f"{name}.deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    found = run(program, path, os.path.join(folder, "tables"))
    deck = Deck(text, folder)
    for table_name, table in found.items():
        if table.failed:
            raise Wrong(f"{table_name}: {table.failed[0]}")
    long = compare.long_tables(deck, found)
    tables = {"reactions": index(long["reactions"], "pin", "link"), "drive": index(long["drives"], "drive"), "frame": index(found["frame"]),
              "bearings": index(found["bearings"], "pin", "link"), "is_four_bar": "theta3" in found["kinematics"].names}
    if "friction" in found:
        tables["friction"] = index(found["friction"], "pin", "link")
    cranks = deck.cranks[::max(1, len(deck.cranks) // most)]
    try:
        model, unknowns = positions(deck, cranks)
    except Failure as failure:
        if "unknowns and" in str(failure):
            raise Redundant from failure
        raise
    largest = 0.0
    for speed in deck.speeds:
        rate = float(speed * deck.speed_factor())
        shown = rate / float(deck.units.results["rate" if deck.drives[0]["linear"] else "speed"])
        for crank, q in zip(cranks, unknowns):
            first = float(crank * deck.crank_factor())
            q = model.newton(q, first)
            state = model.state(q, first, rate, float(deck.alpha()))
            place = Place(deck, model, state, tables, (f"{shown + 0.0:.9g}", f"{float(crank) + 0.0:.9g}"))
            largest = max(largest, place.check())
    return largest


def with_reports(lines):
    """A deck with these reports; friction only where something rubs, and of a four-bar those that it has."""
    drives = [line for line in lines if line.startswith("DRIVE")]
    links = [[word for word in line.split()[2:] if "=" not in word and word.lower() != "rigid"] for line in lines if line.startswith("LINK")]
    points = [line.split()[1] for line in lines if line.startswith("POINT")]
    pins = [line.split()[1] for line in lines if line.startswith(("PINMASS", "FORCE", "LOAD", "PIN "))] + sum(links, [])
    four_bar = len(links) == 3 and all(len(pins) == 2 for pins in links) and len(drives) == 1 and len(drives[0].split()) == 2 \
        and not any(line.startswith("SLIDER") for line in lines) and not any(point in pins for point in points)
    reports = [report for report in REPORTS if (report != "friction" or any(line.startswith("FRICTION") for line in lines))
               and not (four_bar and report == "drives")]
    return "\n".join(lines + ["REPORT " + report for report in reports]) + "\n"


def of_case(case):
    """Without ACTUATE: rows of drives.dat are then those of the DRIVEs."""
    return with_reports([line for line in case.text(5).splitlines() if not line.startswith(("REPORT", "ACTUATE"))])


def spans_of_laws(cards):
    """First and last place of the first piece of every law, and least and greatest of those by tables, which count under both names."""
    spans = {}
    tables = {words[1]: words[5::2] for words in cards if words[0] == "TABLE"}
    for words in cards:
        if words[0] == "LAW" and words[1] not in spans:
            keys = dict(word.split("=") for word in words if "=" in word)
            if "table" in keys:
                places = [float(word) for word in tables[keys["table"]]]
                spans[words[1]] = spans[keys["table"]] = min(places), max(places)
            else:
                spans[words[1]] = float(keys["from"].rstrip("deg")), float(keys["to"].rstrip("deg"))
    return spans


def of_input(program, path, folder):
    """A deck of inputs/ as the program understands it, rigid, with its positions or some of the law of its first drive, the others at
    rest, at a speed; None: a study, or the elastic reports of a structure."""
    run(program, path, folder)
    with open(os.path.join(folder, os.path.splitext(os.path.basename(path))[0], "echo.deck"), encoding="utf-8") as file:
        text = re.sub(r"&[ \t]*(?:[!#].*)?\n", " ", file.read())
    lines, cranks, speeds, linear = [], ["CRANK 20 50 80"], ["SPEED 3 alpha=2"], False
    cards = [words for words in (re.split(r"[!#]", line)[0].split() for line in text.splitlines()) if words]
    spans = spans_of_laws(cards)
    for words in cards:
        keyword = words[0].upper()
        if keyword in ("VARY", "SET"):
            return None
        if keyword == "CRANK":
            cranks = [" ".join(words)]
        elif keyword == "SPEED":
            speeds = [" ".join(words)]
        elif keyword == "TABLE" and words[1] in spans:
            continue
        elif keyword not in DROPPED:
            if keyword == "LINK":
                keys = {word.split("=")[0] for word in words if "=" in word}
                if words[2] in words[3:] and "turns" in keys:
                    return None                                   # its own reader does not close such a frame
                if not keys & {"mass", "material"}:
                    words.append("mass=0.5kg")
                if not keys & {"inertia", "material"}:
                    words.append("inertia=0.001kg*m2")
                if not keys & {"center", "material"} and len([word for word in words if "=" not in word]) > 4:
                    words.append("center=0.01m,0.02m")
            if keyword == "DRIVE":
                law = next((word[4:] for word in words if word.startswith("law=")), None)
                words = [word for word in words if not word.startswith("law=") and word.lower() != "free"]
                is_first = not any(line.startswith("DRIVE") for line in lines)
                if law in spans and is_first:
                    first, last = spans[law]
                    cranks = [f"CRANK {0.9 * first + 0.1 * last!r} {0.5 * first + 0.5 * last!r} {0.1 * first + 0.9 * last!r}"]
                elif law in spans:
                    words.append(f"at={spans[law][0]!r}")
                linear = linear or is_first and len([word for word in words[1:] if "=" not in word]) == 2
            lines.append(" ".join(words))
    if not any(line.startswith("DRIVE") for line in lines):
        return None                                               # a structure
    if linear and speeds == ["SPEED 3 alpha=2"]:
        speeds = ["SPEED 0.02 m/s"]
    return with_reports(lines + cranks + speeds + ["INERTIA distributed"])


def all_cases(options):
    """Name and maker of the text of every deck."""
    for seed in range(options.seed, options.seed + options.count):
        yield f"seed_{seed}", lambda seed=seed: of_case(make(seed))
    if options.inputs:
        for name in sorted(os.listdir(options.inputs)):
            if name.endswith(".deck"):
                path = os.path.join(options.inputs, name)
                yield name[:-5], lambda path=path: of_input(options.program, path, os.path.join(options.scratch, "echo"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_forces"))
    parser.add_argument("--inputs", help="a folder of decks")
    options = parser.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    largest, passed, failed = 0.0, 0, 0
    for name, text_of in all_cases(options):
        folder = os.path.join(options.scratch, name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        try:
            text = text_of()
            if text is None:
                continue
            largest = max(largest, check(text, options.program, folder, name))
        except Redundant:
            continue
        except (Wrong, Failure, RuntimeError, ValueError, KeyError, OSError) as failure:
            failed += 1
            print(f"{name}: {failure!r} ({folder})", flush=True)
            continue
        passed += 1
        shutil.rmtree(folder)
    print(f"at most {largest:.1e} of the largest force or moment is left")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
