"""Every report of random machines against the same machine described otherwise (alike_decks.py): what is printed is the same.

    metamorphic.py SEED COUNT [--program PATH] [--scratch FOLDER] [--family NAME] [--kind NAME] [--keep]

A case is a machine with the reports of a family.  Its deck and another one that shows the same machine turned, mirrored, in other
units, with other names, in another order, with links named from the other end, cut by a POINT that carries nothing or divided into
welded halves are both run (without --family all but floquet and transient, which take a minute each); the second tables are taken
back, and numbers are compared: to the sum of the printed errors, and where a table has none to 1e-10 of the largest of its kind (of a
motion beside four times what the last digits of the deck change).  Rows, failed ones too, and words are the same.  A case that fails
is a line with the ways of showing that alone are enough; its decks stay in the scratch folder.  The last line is `N passed, N failed`.
"""
import argparse
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

from alike_decks import ALONE, FAMILIES, HALF, Machine, View, turned
from tables import Table
from units import unit_factor

ROUNDING = 1e-10                                   # of the largest, where a table has no errors
DECK = 2e-14                                       # relative: what the numbers of a deck are rounded to, and what follows
SHAPES = 1e-2                                      # of the root of the accuracy of frequencies
EXTREME = 1e-6                                     # ends of ranges and extremes are searched for
SEVERAL = 4.0                                      # lengths, places and speeds are rounded in two decks
NOT_A_NUMBER = ("-", "none")

# Columns by table: what a quantity is.  s: a number; p: its sign turns in the mirror; r: it turns with the order of the pins of the
# link; v: the first of two components; P: of a place; a: an angle; w: a word.
KINDS = {
    "links": {"omega": "p", "alpha": "p"},
    "pins": {"x": "P", "vx": "v", "ax": "v"}, "points": {"x": "P", "vx": "v", "ax": "v"},
    "reactions": {"fx": "v", "moment": "p"}, "bearings": {"fx": "v", "axial": "r", "transverse": "rp", "magnitude": "s"},
    "frame": {"shaking_x": "v", "shaking_moment": "p", "frame_x": "v", "frame_moment": "p"},
    "shaking": {"shaking_x": "v", "shaking_moment": "p"},
    "drives": {"position": "a", "rate": "p", "force": "p"}, "transmission": {"transmission_angle": "s"},
    "lagrange": {"M": "s", "dM": "p", "V": "p", "gravity": "p", "load": "p", "torque": "p", "kinetic": "s", "potential": "s"},
    "inertia": {"Fx": "v", "m": "s"},
    "friction": {"force": "s", "moment": "p", "lost": "s"},
    "equilibrium": {"verdict": "w", "potential": "s", "stiffness": "s", "frequency": "s"},
    "balance": {"xG": "P", "shaking_x": "v", "shaking_moment": "p", "torque": "p", "balanced_x": "v", "balanced_moment": "p",
                "balanced_torque": "p"},
    "linkage": {"value": "s"},
    "frequencies": {}, "shapes": {"x": "P", "ux": "v", "rotation": "p"}, "branches": {"branch": "w", "event": "w", "frequency": "s"},
    "response": {"ux": "v", "rotation": "p"}, "transient": {"ux": "v", "rotation": "p"},
    "strains": {"axial_strain": "s", "bending_strain": "s", "moment": "rp", "axial_force": "s", "shear_force": "p", "stress": "s"},
    "gauges": {"axial_strain": "s", "bending_strain": "s", "moment": "rp", "axial_force": "s", "stress": "s"},
    "peaks": {"strain": "s", "stress": "s", "deflection": "s", "power": "s"},
    "torque": {"rigid": "p", "linear": "p", "quadratic": "p", "total": "p", "power": "s"},
    "validity": {"deflection": "s", "load": "s", "out_of_plane": "s", "distance": "s"},
    "stability": {"turns": "s", "growth": "s", "signature": "w", "verdict": "w"},
    "campbell": {"least": "s", "mean": "s", "greatest": "s", "growth": "s", "verdict": "w"},
    "critical": {"excitation": "s", "amplitude": "s", "growth": "s"},
    "motion": {"crank": "a", "omega2": "p", "torque": "p", "kinetic": "s", "potential": "s", "work": "s"},
    "sizing": {"value": "s"}, "harmonics": {"largest": "s", "rms": "s", **{f"h{k}": "s" for k in range(1, 11)}},
}
KEYS = ("speed", "crank", "time", "pin", "link", "point", "gauge", "mode", "part", "quantity", "drive", "line", "linkage")
SWAPPED = {"runs_forward": "runs_backward", "locks_forward": "locks_backward"}
SWAPPED.update({value: key for key, value in SWAPPED.items()})
EXTREMES = ("swing", "turns", "stroke", "span", "time_ratio", "least_transmission", "greatest_transmission", "greatest_pressure")


class Wrong(Exception):
    """Two decks of one machine do not agree."""


class Tables:
    """What a deck prints, taken back to the machine: {table: {key: {quantity: (value, allowed error)}}}."""

    def __init__(self, view, folder):
        self.view, self.machine = view, view.machine
        self.names = {new.lower(): old for old, new in view.name_of.items()}
        self.rows, self.failed = {}, []
        tables = {name[:-4]: Table(os.path.join(folder, name)) for name in sorted(os.listdir(folder)) if name.endswith(".dat")}
        for name, table in tables.items():
            self.units = {column: self.factor(unit) for column, unit in table.units.items()}
            self.failed += [(name, self.reason(line)) for line in table.failed]
            self.take(name, table)

    @staticmethod
    def factor(unit):
        unit = "1" if unit == 1.0 else unit
        if unit in ("-", "see_unit", "1", "%", "deg"):
            return 1.0
        try:
            return float(unit_factor(unit.replace(".", "*").replace("W", "N*m/s").replace("Hz", "rad")))
        except (KeyError, ValueError):
            return None

    def reason(self, line):
        """Why a row failed, without numbers and names."""
        return " ".join(word for word in line.split(":", 1)[-1].split() if not any(c.isdigit() for c in word) and "'" not in word)

    def old_name(self, word):
        parts = [self.names.get(part.lower(), part) for part in str(word).split(":")]
        if parts[-1].endswith(HALF):
            parts[-1] = self.names.get(parts[-1][:-len(HALF)].lower(), parts[-1][:-len(HALF)])
        return ":".join(parts)

    def is_new(self, names):
        """Whether a row is about a pin that the machine does not have."""
        return any(part.startswith(("idle", "weld")) for name in names for part in name.split(":"))

    def angle(self, degrees):
        return (degrees - self.view.turn) * self.view.mirror

    def place_of_crank(self, degrees):
        return round(self.angle(degrees), 5) % 360

    def back(self, x, y):
        x, y = turned(x, y, -self.view.turn)
        return x, self.view.mirror * y

    def key(self, row):
        result, names = [], []
        for column in KEYS:
            if column not in row:
                continue
            value = row[column]
            if column == "speed":
                value = round(self.view.mirror * value * self.units[column], 6)
            elif column == "crank":
                value = self.place_of_crank(value)
                value = 0.0 if value > 359.99999 else value
            elif column == "time":
                value = round(value * self.units[column], 9)
            elif isinstance(value, str) and column not in ("quantity", "linkage"):
                value = self.old_name(value)
                names.append(value)
            result.append(value)
        return tuple(result), names

    def take(self, name, table):
        rows = table.rows
        special = getattr(self, "take_" + name, None)
        if special:
            special(name, table)
            return
        if name not in KINDS:
            return
        self.take_rows(name, rows)

    def take_rows(self, name, rows, kinds=None):
        kinds = kinds or KINDS[name]
        for row in rows:
            key, names = self.key(row)
            if self.is_new(names):
                continue
            found = {}
            for column, kind in kinds.items():
                if column in row:
                    self.take_value(found, row, column, kind)
            self.put(name, key, found)

    def put(self, name, key, found):
        rows = self.rows.setdefault(name, {})
        while key in rows:
            key = key + ("again",)
        rows[key] = found

    def take_value(self, found, row, column, kind):
        value = row[column]
        if kind == "w" or isinstance(value, str):
            found[column] = ("w", value, 0.0)
            return
        if self.units[column] is None:
            raise Wrong(f"unit of {column} unknown")
        value *= self.units[column]
        if kind in ("v", "P"):
            second = column.replace("x", "y")
            x, y = self.back(value, row[second] * self.units[second])
            found[column], found[second] = ("v", x, self.units_of(column)), ("v", y, self.units_of(column))
            return
        if kind == "a":
            found[column] = ("a", self.angle(value), "deg")
            return
        sign = self.view.mirror if "p" in kind else 1
        if "r" in kind:
            link = self.link_of(row)
            sign *= -1 if link in self.view.reversed else 1
        found[column] = ("s", sign * value, self.units_of(column))

    def units_of(self, column):
        return self.dimension.get(column, column)

    dimension = {"fx": "force", "shaking_x": "force", "frame_x": "force", "balanced_x": "force", "axial": "force", "transverse": "force",
                 "magnitude": "force", "Fx": "force", "moment": "moment", "shaking_moment": "moment", "frame_moment": "moment",
                 "balanced_moment": "moment", "V": "moment", "gravity": "moment", "load": "moment", "torque": "moment",
                 "balanced_torque": "moment", "rigid": "torque", "linear": "torque", "quadratic": "torque", "total": "torque",
                 "kinetic": "energy", "potential": "energy", "work": "energy", "x": "place", "xG": "place", "force": "force"}

    def link_of(self, row):
        if "gauge" in row:
            return self.machine.gauges[self.old_name(row["gauge"])][0]
        return self.old_name(row["link"])

    # four-bars, in the rows of other linkages

    def take_kinematics(self, name, table):
        if "link" in table.names:
            first = {}
            for row in table.rows:
                key, names = self.key(row)
                link = names[-1]
                start = first.setdefault((row["speed"], row["link"]), row["theta"])
                found = {"theta": ("a", self.view.mirror * (row["theta"] - start), "deg")}
                for column in ("omega", "alpha"):
                    self.take_value(found, row, column, "p")
                if self.is_one_of_four(link) and (key[:2] + (link,)) not in self.rows.get("links", {}):
                    self.put("links", key[:2] + (link,), found)
            return
        first = {}
        for row in table.rows:
            key, _ = self.key(row)
            for number, link in (("3", "coupler"), ("4", "follower")):
                start = first.setdefault((row["speed"], link), row["theta" + number])
                found = {"theta": ("a", self.view.mirror * (row["theta" + number] - start), "deg")}
                for column in ("omega", "alpha"):
                    found[column] = ("s", self.view.mirror * row[column + number] * self.units[column + number], column)
                self.put("links", key + (link,), found)
        self.take_rows("transmission", table.rows)

    def is_one_of_four(self, link):
        """Of a four-bar the program has no rows of the crank."""
        return self.machine.kind != "four_bar" or link != "crank"

    def take_reactions(self, name, table):
        if "link" in table.names:
            rows = [row for row in table.rows if self.old_name(row["link"]) in (*self.machine.links, *self.machine.guides)]
            self.take_rows(name, rows)
            return
        links = {"2": "crank", "3": "coupler", "4": "follower"}
        for row in table.rows:
            key, _ = self.key(row)
            for column in ("O2x", "A2x", "A3x", "B3x", "B4x", "O4x"):
                pin, link = (column[:2], links[column[1]]) if column[0] == "O" else (column[0], links[column[1]])
                x, y = self.back(row[column] * self.units[column], row[column[:-1] + "y"] * self.units[column])
                self.put(name, key + (pin, link), {"fx": ("v", x, "force"), "fy": ("v", y, "force")})
            self.put("drives", key + ("crank",), {"force": ("s", self.view.mirror * row["torque"] * self.units["torque"], "moment")})
        self.take_rows("shaking", table.rows)

    def take_drives(self, name, table):
        if "drive" in table.names:
            self.units["force"] = self.units["force"] or 1.0
            kinds = {"force": "p"}
            for row in table.rows:
                key, names = self.key(row)
                found = {}
                self.take_value(found, row, "force", "p")
                found["force"] = found["force"][:2] + ("moment",)
                self.put(name, key, found)

    def take_inertia(self, name, table):
        """Sums, which no division changes."""
        sums = {}
        for row in table.rows:
            x, y = self.back(row["Fx"] * self.units["Fx"], row["Fy"] * self.units["Fy"])
            total = sums.setdefault(self.key({k: row[k] for k in ("speed", "crank")})[0], [0.0, 0.0, 0.0])
            for k, value in enumerate((x, y, row["m"] * self.units["m"])):
                total[k] += value
        for key, (x, y, m) in sums.items():
            self.put(name, key, {"Fx": ("v", x, "force"), "Fy": ("v", y, "force"), "m": ("s", m, "mass")})

    def take_bearings(self, name, table):
        rows = []
        for row in table.rows:
            link = self.old_name(row["link"])
            if link in self.machine.guides:
                rows.append(row)
            elif link in self.machine.links:
                plain = len(self.machine.links[link]["pins"]) == 2
                rows.append(row if plain else {k: v for k, v in row.items() if k not in ("axial", "transverse")})
        self.take_rows(name, rows)

    def take_friction(self, name, table):
        self.take_rows(name, table.rows)

    def take_holding(self, name, table):
        for row in table.rows:
            forward, backward = (row[c] * self.units[c] for c in ("forward", "backward"))
            verdict = row["verdict"]
            if self.view.mirror < 0:
                forward, backward, verdict = -backward, -forward, SWAPPED.get(verdict, verdict)
            self.put(name, self.key({"crank": row["crank"]})[0], {"forward": ("s", forward, "moment"),
                     "backward": ("s", backward, "moment"), "verdict": ("w", verdict, 0.0)})

    def take_linkage(self, name, table):
        if "part" not in table.names:
            return
        for row in table.rows:
            if row["quantity"] in EXTREMES and not self.is_new(self.key(row)[1]):
                row = dict(row, part=":".join(sorted(self.old_name(row["part"]).split(":"))))
                value = row["value"] * (self.factor(row["unit"]) or 1.0)
                self.put(name, (row["part"], row["quantity"]), {row["quantity"]: ("s", value, EXTREME * max(abs(value), 1e-9))})

    def take_equilibrium(self, name, table):
        for row in table.rows:
            found = {"verdict": ("w", row["verdict"], 0.0),
                     "potential": ("s", row["potential"] * self.units["potential"], "energy"),
                     "frequency": ("s", row["frequency"], 1e-14 + abs(row["frequency"]) * row["error"])}
            self.put(name, (round(self.place_of_crank(row["crank"]), 3) % 360,), found)

    def take_harmonics(self, name, table):
        words = re.search(r"forces in (\S+), moments and torques in ([^\s,]+)", " ".join(table.notes))
        force, moment = (self.factor(unit) or 1.0 for unit in words.groups())
        for row in table.rows:
            # Components turn, and counterweights of four-bars are others than those of what has pins more.
            if row["quantity"] not in ("shaking_x", "shaking_y") and row["linkage"] == "given":
                found = {}
                for column in KINDS[name]:
                    found[column] = ("s", abs(row[column]) * (force if row["quantity"] == "shaking_force" else moment), row["quantity"])
                self.put(name, (round(self.view.mirror * row["speed"], 6), row["linkage"], row["quantity"]), found)

    def take_sizing(self, name, table):
        peaks = {}
        for row in table.rows:
            place = (row["speed"], row["part"], row["pin"], row["unit"])
            peaks[place] = max(peaks.get(place, 0.0), abs(row["value"]))
        for row in table.rows:
            key, names = self.key({k: row[k] for k in ("speed", "pin", "part", "quantity")})
            if row["quantity"] == "angle_at_peak" or self.is_new(names):
                continue
            factor = self.factor(row["unit"].replace(".", "*")) or 1.0
            sign = self.view.mirror if row["quantity"] in ("peak_torque", "mean_torque", "rate", "greatest_rate", "least_rate") else 1
            peak = peaks[row["speed"], row["part"], row["pin"], row["unit"]]
            self.put(name, key, {row["quantity"]: ("s", sign * row["value"] * factor, (row["error"] + ROUNDING) * peak * factor)})

    # elastic links

    def take_frequencies(self, name, table):
        for row in table.rows:
            key, _ = self.key(row)
            found = {}
            for column in row:
                if column[0] == "f" and column[1:].isdigit() or column.startswith("zeta"):
                    error = row["error" + column.lstrip("fzeta")] + DECK
                    found[column] = ("s", row[column], error * (abs(row[column]) if column[0] == "f" else 1.0))
            # Frequencies near zero have the digits of those of the linkage without loads.
            for column in found:
                if column[0] == "f":
                    kind, value, allowed = found[column]
                    found[column] = (kind, value, allowed + 1e-7 * max(abs(v[1]) for v in found.values()) * (abs(value) < 1e-6))
            self.put(name, key, found)

    def take_shapes(self, name, table):
        """Rows lie where the other deck has them; the shape of a mirrored linkage is the opposite of the mirrored shape."""
        self.shape_share = SHAPES * math.sqrt(float(self.machine.keys["mesh"]))
        near, largest, root = {}, {}, self.view.mirror / math.sqrt(self.view.mass)
        for row in table.rows:
            near.setdefault((row["speed"], row["crank"]), {})[row["mode"]] = row["frequency"]
            mode = row["speed"], row["crank"], row["mode"]
            largest[mode] = max(largest.get(mode, 0.0), math.hypot(row["ux"], row["uy"]) * abs(root))
        for row in table.rows:
            key, names = self.key(row)
            place = [round(c / self.machine.size, 5) + 0.0 for c in self.back(row["x"] * self.units["x"], row["y"] * self.units["y"])]
            all_modes = near[row["speed"], row["crank"]]
            # Errors of shapes go with the root of those of frequencies, and turn modes into their neighbours; the one above the
            # highest is not there.
            gap = min([abs(f / row["frequency"] - 1) for mode, f in all_modes.items() if mode != row["mode"] and row["frequency"]] +
                      [0.01 if row["mode"] == max(all_modes) else 1.0])
            allowed = largest[row["speed"], row["crank"], row["mode"]] * self.shape_share * (1 + 1 / max(gap, 1e-9))
            ux, uy = (root * u for u in self.back(row["ux"], row["uy"]))
            self.put(name, (*key, *place), {"ux": ("v", ux, allowed), "uy": ("v", uy, allowed)})

    def take_branches(self, name, table):
        if self.view.mirror < 0:
            return
        for row in table.rows:
            self.put(name, self.key({k: row[k] for k in ("speed", "crank", "mode")})[0],
                     {"branch": ("w", row["branch"], 0.0), "event": ("w", row["event"], 0.0)})

    def relative(self, name, table, column_of_place):
        """Rows whose error is relative to the largest value of a quantity at its place."""
        kinds, largest = KINDS[name], {}
        for row in table.rows:
            place = (row["speed"], row.get(column_of_place))
            for column, kind in kinds.items():
                if isinstance(row[column], float):
                    columns = (column, column.replace("x", "y")) if kind == "v" else (column,)
                    for c in columns:
                        largest[place, column] = max(largest.get((place, column), 0.0), abs(row[c] * self.units[c]))
        for row in table.rows:
            key, names = self.key(row)
            if self.is_new(names):
                continue
            found = {}
            for column, kind in kinds.items():
                self.take_value(found, row, column, kind)
            for column, (kind, value, _) in found.items():
                first = column.replace("y", "x") if column.replace("y", "x") in kinds else column
                share = row["error"] if name != "validity" or column == "distance" else 1e-6
                allowed = 0.0 if kind == "w" else share * largest.get(((row["speed"], row.get(column_of_place)), first), 0.0)
                found[column] = (kind, value, allowed)
            self.put(name, key, found)

    def take_response(self, name, table):
        self.relative(name, table, "point")

    def take_transient(self, name, table):
        self.relative(name, table, "point")

    def take_strains(self, name, table):
        self.relative(name, table, "gauge")

    def take_gauges(self, name, table):
        if self.machine.gauges:
            self.relative(name, table, "gauge")

    def take_peaks(self, name, table):
        self.relative(name, table, "link")

    def take_torque(self, name, table):
        if any(load[0] in ("SPRING", "COIL", "DAMPER") for load in self.machine.loads):
            # Which deformations are the unknowns divides what elasticity adds.
            for row in table.rows:
                row["linear"] = row["quadratic"] = "-"
        self.relative(name, table, "none")

    def take_validity(self, name, table):
        self.relative(name, table, "link")

    def take_stability(self, name, table):
        for row in table.rows:
            e = row["error"]
            found = {"turns": ("s", row["turns"], e / (2 * math.pi)), "growth": ("s", row["growth"], e)}
            if row["verdict"] != "undecided":
                found["verdict"] = ("w", row["verdict"], 0.0)
            self.put(name, self.key(row)[0], found)

    def take_campbell(self, name, table):
        for row in table.rows:
            found = {c: ("s", row[c], row["band_error"] * row[c]) for c in ("least", "mean", "greatest")}
            found["growth"] = ("s", row["growth"], row["error"])
            self.put(name, self.key(row)[0], found)

    def take_critical(self, name, table):
        for row in table.rows:
            speed = self.view.mirror * row["speed"]
            self.put(name, (row["line"], round(speed, 3)), {"speed": ("s", speed, abs(speed) * row["speed_error"]),
                     "excitation": ("s", row["excitation"] * self.units["excitation"],
                                    row["error"] * row["excitation"] * self.units["excitation"])})

    def take_motion(self, name, table):
        other = "rate1" in table.names
        for row in table.rows:
            found = {"crank": ("a", self.angle(row["position1" if other else "theta2" if "theta2" in row else "crank"]), 1e-7),
                     "omega": ("s", self.view.mirror * row["rate1" if other else "omega2"] *
                               self.units["rate1" if other else "omega2"], "omega")}
            for column in ("kinetic", "potential", "work"):
                self.take_value(found, row, column, "s")
            self.put(name, self.key({"time": row["time"]})[0], found)


def largest_of(one, other, name):
    """The largest value of every kind in a table of both."""
    largest = {}
    for tables in (one, other):
        for row in tables.rows.get(name, {}).values():
            for kind, value, scale in row.values():
                if isinstance(scale, str) and kind in ("s", "v"):
                    largest[scale] = max(largest.get(scale, 0.0), abs(value))
    return largest


def compare(one, other, by_rounding=None):
    """Number of comparisons, and the largest difference by what is allowed, beside what rounding of the deck explains; raises Wrong."""
    count, worst = 0, (0.0, "")
    wrong = []
    if sorted(set(one.failed)) != sorted(set(other.failed)):
        wrong.append(f"failed rows: {sorted(set(one.failed))[:3]} and {sorted(set(other.failed))[:3]}")
    for name in sorted(set(one.rows) & set(other.rows)):
        rows, others = one.rows[name], other.rows[name]
        if name == "shapes":
            common = set(rows) & set(others)
            missing = [] if common else list(rows)[:1]
        else:
            common = set(rows) & set(others)
            missing = sorted(map(str, set(rows) ^ set(others)))
        if missing:
            wrong.append(f"{name}: rows of one deck only: {missing[:3]}")
            continue
        largest = largest_of(one, other, name)
        force, size = largest.get("force", 0.0), one.machine.size
        if "moment" in largest:                    # where all moments are round-off of forces
            largest["moment"] = max(largest["moment"], 0.1 * force * size)
        if name == "drives":
            largest["moment"] = max([largest.get("moment", 0.0)] + [0.1 * size * largest_of(one, other, t).get("force", 0.0)
                                                                    for t in ("reactions", "bearings", "frame")])
        for key in common:
            for column, (kind, value, scale) in rows[key].items():
                if column not in others[key]:
                    continue
                kind2, value2, scale2 = others[key][column]
                if "w" in (kind, kind2):
                    if value != value2 and not {value, value2} & set(NOT_A_NUMBER):
                        wrong.append(f"{name} {key} {column}: {value} and {value2}")
                    count += 1
                    continue
                difference = value - value2
                if kind == "a":
                    difference = (difference + 180) % 360 - 180
                    allowed = 360 * ROUNDING if isinstance(scale, str) else scale + scale2
                elif isinstance(scale, str):
                    allowed = ROUNDING * largest[scale]
                else:
                    allowed = scale + scale2 + DECK * max(abs(value), abs(value2))
                count += 1
                allowed += (by_rounding or {}).get((name, key, column), 0.0)
                share = abs(difference) / allowed if allowed > 0 else (math.inf if difference else 0.0)
                worst = max(worst, (share, name))
                if not share <= 1:
                    wrong.append(f"{name} {key} {column}: {value!r} and {value2!r}, {share:.3g} times what is allowed")
    if wrong:
        # The worst first, one line a table.
        raise Wrong(" | ".join({text.split(" ")[0]: text for text in reversed(wrong)}.values()) + f" ({len(wrong)} in all)")
    return count, worst


def run(program, view, folder, name, change=lambda text: text):
    """Tables of a deck; None with the message where it is refused."""
    path = os.path.join(folder, name + ".deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(change(view.text()))
    result = subprocess.run([program, "--quiet", "--out", folder, path], capture_output=True, text=True, timeout=300, check=False)
    if result.returncode == 2:
        return None, result.stderr.strip().splitlines()[0].split("error:")[-1]
    if result.returncode not in (0, 1):
        raise Wrong(f"{name}.deck: exit {result.returncode}")
    return Tables(view, os.path.join(folder, name)), ""


def differences_by_rounding(program, machine, folder, one):
    """What a motion changes when the numbers of its deck are the next ones, three times; fast links turn hundreds of times."""
    changes = {}
    for seed in range(3):
        r = random.Random(seed)
        other, _ = run(program, View(machine), folder, "rounded", lambda text: re.sub(
            r"(?<![\w.])-?\d+\.\d{5,}(e-?\d+)?", lambda found: repr(math.nextafter(float(found[0]), r.choice((-1, 1)) * math.inf)), text))
        for name, rows in one.rows.items():
            for key in set(rows) & set(other.rows.get(name, {})):
                for column, (kind, value, _) in rows[key].items():
                    if kind != "w":
                        place = name, key, column
                        changes[place] = max(changes.get(place, 0.0), SEVERAL * abs(value - other.rows[name][key][column][1]))
    return changes


def check(program, machine, seed, folder, only=ALONE):
    one, why = run(program, View(machine), folder, "plain")
    other, why2 = run(program, View(machine, seed, only), folder, "shown")
    if other is None and "leaves no joint" in why2:
        return 0, (0.0, "refused")
    if (one is None) != (other is None):
        raise Wrong(f"only one deck is refused: {why or why2}")
    if not one:
        return 0, (0.0, "refused")
    try:
        return compare(one, other)
    except Wrong:
        if machine.family != "motion":
            raise
        return compare(one, other, differences_by_rounding(program, machine, folder, one))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join(tempfile.gettempdir(), "flexmech_metamorphic"))
    parser.add_argument("--family", choices=list(FAMILIES))
    parser.add_argument("--kind")
    parser.add_argument("--keep", action="store_true", help="keep all decks")
    options = parser.parse_args()
    families = [options.family] if options.family else ["frequencies", "rigid", "elastic", "frequencies", "motion"]
    passed, failed, compared, refused, worst = 0, 0, 0, 0, {}
    for seed in range(options.seed, options.seed + options.count):
        family = families[seed % len(families)]
        machine = Machine(seed, family, options.kind)
        folder = os.path.join(options.scratch, f"{family}_{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        try:
            count, share = check(options.program, machine, seed, folder)
            passed += 1
            compared += count
            refused += count == 0
            worst[share[1]] = max(worst.get(share[1], 0.0), share[0])
        except (Wrong, subprocess.TimeoutExpired) as wrong:
            failed += 1
            enough = []
            for name in ALONE:
                try:
                    check(options.program, machine, seed, folder, (name,))
                except (Wrong, subprocess.TimeoutExpired):
                    enough.append(name)
            check_again(options.program, machine, seed, folder)
            print(f"not ok {family} {seed} {machine.kind}, by {', '.join(enough) or 'all together'}: {wrong}", flush=True)
            continue
        if not options.keep:
            shutil.rmtree(folder)
    print(f"{compared} comparisons, {refused} refused; largest shares of what is allowed: " +
          " ".join(f"{name} {share:.2g}" for name, share in sorted(worst.items())))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


def check_again(program, machine, seed, folder):
    """Leaves the decks of the whole view."""
    for view, name in ((View(machine), "plain"), (View(machine, seed), "shown")):
        try:
            run(program, view, folder, name)
        except (Wrong, subprocess.TimeoutExpired):
            pass


if __name__ == "__main__":
    sys.exit(main())
