#!/usr/bin/env python3
"""Intervals of instability of random linkages by the program: none is missed, none invented.

    random_intervals.py SEED COUNT [--program PATH] [--scratch FOLDER] [--keep]

Three of four decks are slider-cranks with a rigid crank and an elastic rod: REPORT intervals against Hill's equation (hill.py), which
knows nothing of the program, at 40 speeds and in every interval.  The fourth is a four-bar or slider-crank whose links all bend,
against REPORT stability at 40 speeds.  A speed at which vibrations grow by more than is asked for must be in an interval or in a
failed row; in every interval they must grow by as much as it says.  The share of the range in failed rows is reported, and fails the
campaign where it is more than a tenth.  Weak and strong ones alternate.
"""
import argparse
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

from hill import Rod

SPEEDS = 40
LEAST = 2e-3            # growth= of the decks
CERTAIN = 1.5           # growths by Hill's equation above this times LEAST are growths of the elastic rod, too: it is extensible
NEAR = 1.5e-3           # edges by both differ by no more than this share of the speed
BESIDE = 3e-4           # speeds beside one by this share of it
MOST_FAILED = 0.1       # of all ranges together


def table(path):
    """Rows of a table, and from and to of its failed rows."""
    rows, failed = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("# failed from="):
                words = line.split()
                failed.append((float(words[2][5:]), float(words[3][3:])))
            elif line.strip() and not line.startswith("#"):
                rows.append(line.split())
    return rows, failed


class Case:
    def __init__(self, seed, program, scratch):
        self.random = random.Random(seed)
        self.program, self.scratch, self.name = program, scratch, f"case{seed}"
        self.strong = seed % 2 == 0
        self.why = []
        if seed % 4 == 3:
            self.with_links()
        else:
            self.with_rod()

    def uniform(self, a, b):
        return self.random.uniform(a, b)

    def run(self, name, lines):
        path = os.path.join(self.scratch, f"{name}.deck")
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        done = subprocess.run([self.program, "--quiet", "--out", self.scratch, path], capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            self.why.append(f"exit status {done.returncode}: {done.stderr.strip()[:200]}")
        return os.path.join(self.scratch, name)

    def report(self, lines, report, speeds):
        name = f"{self.name}_{report}"
        cards = lines + [f"SPEED {speeds}", f"REPORT {report}" + (f" growth={LEAST}" if report == "intervals" else "")]
        return table(os.path.join(self.run(name, cards), f"{report}.dat"))

    def find(self, lines, low, high):
        """The intervals and failed rows of a range."""
        self.low, self.high = low, high
        rows, self.failed = self.report(lines, "intervals", f"{low!r} {high!r}")
        self.intervals = [(float(r[0]), float(r[1]), float(r[4]), float(r[6]), float(r[7]), r[2], r[3]) for r in rows]

    def share_failed(self):
        """The share of the range in failed rows."""
        if not hasattr(self, "failed"):
            return 0.0
        edges = sorted((max(a, self.low), min(b, self.high)) for a, b in self.failed)
        total, reached = 0.0, self.low
        for a, b in edges:
            total += max(0.0, b - max(a, reached))
            reached = max(reached, b)
        return total / (self.high - self.low)

    def is_known(self, speed, near):
        return any(i[0] - near * speed - i[4] <= speed <= i[1] + near * speed + i[4] for i in self.intervals) or any(
            a - near * speed <= speed <= b + near * speed for a, b in self.failed)

    def grid(self):
        step = (self.high - self.low) / SPEEDS
        return [self.low + step * (k + self.uniform(0.05, 0.95)) for k in range(SPEEDS)]

    def with_rod(self):
        """A slider-crank with a rigid crank."""
        length = round(self.uniform(0.2, 0.6), 4)
        ratio = self.uniform(0.1, 0.3) if self.strong else 10 ** self.uniform(-2, -1)
        r = round(length * ratio, 5)
        thickness = round(length * self.uniform(0.004, 0.012), 6)
        width = round(thickness * self.uniform(2, 10), 6)
        elasticity, density = 2e11, 7800.0
        mu, bending = density * thickness * width, elasticity * width * thickness**3 / 12
        piston = round(mu * length * 10 ** self.uniform(-1, 0.5), 6)
        modes = self.random.choice([1, 2])
        own = math.sqrt(bending / mu) * (math.pi / length) ** 2
        low = own / self.uniform(1.2, 4.0)
        high = low * self.uniform(1.1, 1.4)
        lines = [
            f"TITLE {self.name}", "UNITS m kg s", f"MATERIAL steel E={elasticity!r} density={density!r}",
            f"SECTION strip rectangle thickness={thickness!r} width={width!r}", "GROUND O 0 0",
            f"LINK crank O A length={r!r} rigid mass=0", f"LINK rod A B length={length!r} material=steel section=strip",
            "GUIDE bore 0 0 angle=0", f"SLIDER B bore mass={piston!r}", "BRANCH B forward", "DRIVE crank", f"MODES {modes}"]
        rod = Rod(r, length, mu, bending, piston, modes=modes + 1)
        self.find(lines, low, high)
        for speed in self.grid():
            growth = rod.growth(speed)
            # Of one mode more than wanted: those of the modes wanted only where these alone grow, too.
            if growth > CERTAIN * LEAST and not self.is_known(speed, NEAR):
                fewer = Rod(r, length, mu, bending, piston, modes=modes).growth(speed)
                if fewer > CERTAIN * LEAST:
                    self.why.append(f"missed: growth {growth:.4g} at {speed:.6g} rad/s")
        for i in self.intervals:
            around = [i[3] * (1 + NEAR * k / 10) for k in range(-10, 11)] if i[1] - i[0] < 4 * NEAR * i[3] else [i[3]]
            growth = max(rod.growth(s) for s in around)
            if growth < 0.7 * i[2] - LEAST:
                self.why.append(f"invented: {i[5]} {i[6]} {i[0]:.6g} to {i[1]:.6g} rad/s, growth {i[2]:.4g}, by Hill {growth:.4g}")

    def with_links(self):
        """A linkage whose links all bend."""
        crank = round(self.uniform(0.06, 0.12), 4)
        coupler = round(crank * self.uniform(2.5, 4), 4)
        modes = self.random.choice([1, 2, 3])
        thickness = round(coupler * self.uniform(0.005, 0.01), 6)
        lines = [
            f"TITLE {self.name}", "UNITS m kg s", "MATERIAL steel E=2e11 density=7800",
            f"SECTION strip rectangle thickness={thickness!r} width={round(8 * thickness, 6)!r}", "GROUND O 0 0",
            f"LINK crank O A length={crank!r} material=steel section=strip",
            f"LINK coupler A B length={coupler!r} material=steel section=strip"]
        own = math.sqrt(2e11 * thickness**2 / 12 / 7800) * (math.pi / coupler) ** 2
        mass = round(7800 * 8 * thickness**2 * coupler * 10 ** self.uniform(-1, 0.3), 6)
        if self.random.random() < 0.5:
            lines += ["GUIDE bore 0 0 angle=0", f"SLIDER B bore mass={mass!r}", "BRANCH B forward"]
        else:
            follower = round(coupler * self.uniform(0.9, 1.1), 4)
            base = round(coupler * self.uniform(0.95, 1.05), 4)
            lines += [f"GROUND O4 {base!r} 0", f"LINK follower O4 B length={follower!r} material=steel section=strip",
                      f"PINMASS B {mass!r}"]
        lines += ["DRIVE crank", f"MODES {modes}"]
        low = own / (self.uniform(1.5, 4) if self.strong else self.uniform(3, 7))
        self.find(lines, low, low * self.uniform(1.1, 1.3))
        for row in self.missed(self.exponents(lines, self.grid()), modes):
            # Where two shapes pass each other numbers are others for a moment.
            speed = float(row[0])
            beside = self.exponents(lines, [speed * (1 - BESIDE), speed * (1 + BESIDE)])
            if len({r[0] for r in self.missed(beside, modes)}) == 2:
                self.why.append(f"missed: mode {row[1]} grows by {float(row[3]):.4g} at {speed:.6g} rad/s, {row[7]}")
        places = [i[3] for i in self.intervals]
        if not places:
            return
        # Those of other numbers grow, too.
        lines[-1] = f"MODES {modes + 2}"
        rows = self.exponents(lines, places)
        for i in self.intervals:
            here = [r for r in rows if abs(float(r[0]) - i[3]) <= 1e-12 * i[3]]
            if not any(abs(abs(float(r[3])) - i[2]) <= 1e-3 * i[2] + 1e-4 for r in here):
                self.why.append(f"invented: {i[5]} {i[6]} {i[0]:.6g} to {i[1]:.6g} rad/s, growth {i[2]:.4g}")

    def exponents(self, lines, speeds):
        """Rows of REPORT stability."""
        return self.report(lines, "stability", " ".join(repr(s) for s in speeds))[0]

    def missed(self, rows, modes):
        """Rows of modes wanted that grow where no interval is."""
        for row in rows:
            speed, growth, error, verdict = float(row[0]), float(row[3]), float(row[6]), row[7]
            partner = int(verdict.split("+")[1]) if "+" in verdict else 0
            if growth > error + LEAST and partner <= modes and not self.is_known(speed, 0.0):
                yield row


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch")
    parser.add_argument("--keep", action="store_true", help="keep decks and tables")
    arguments = parser.parse_args()
    if arguments.scratch:
        os.makedirs(arguments.scratch, exist_ok=True)
    scratch = tempfile.mkdtemp(prefix="intervals", dir=arguments.scratch)
    program = os.path.abspath(arguments.program)
    passed = found = strong = with_failed = 0
    share = 0.0
    for k in range(arguments.count):
        case = Case(arguments.seed + k, program, scratch)
        found += len(case.intervals)
        strong += sum(1 for i in case.intervals if i[2] > 0.1)
        share += case.share_failed() / arguments.count
        with_failed += 1 if case.failed else 0
        if case.why:
            for why in case.why:
                print(f"not ok {case.name}: {why}", flush=True)
        else:
            passed += 1
    print(f"{found} intervals, {strong} of them strong; failed rows in {with_failed} of {arguments.count}, {100 * share:.2f} % of the ranges")
    failed = arguments.count - passed
    if share > MOST_FAILED:
        print(f"not ok failed rows: more than {100 * MOST_FAILED:.0f} % of the ranges")
        failed += 1
    if arguments.keep:
        print(scratch)
    else:
        shutil.rmtree(scratch)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
