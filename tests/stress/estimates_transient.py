"""Error columns of REPORT transient against finer runs: `estimates_transient.py SEED COUNT [--program P] [--scratch DIR]`.

Random four-bars, slider-cranks, welded and open chains, with ramps, starts at rest, with the velocity of a mode, and laws, at
accuracies from 1e-2 to 1e-6: each against the same finer by up to 1e4, rotated with its ground, and mirrored, which turns the crank the
other way. A violation is a difference above the sum of both printed errors. The last lines have the distribution of estimate/true.
"""
import argparse
import math
import os
import random
import signal
import subprocess
import sys

GAUGE_SCALE = 1e-3


def number(x):
    return f"{x:.16g}"


class Linkage:
    """Cards of a linkage: pins by places, from which rotated and mirrored decks are made."""

    follow = 2.0  #: turns of the second link of a chain to one of the first

    def __init__(self, rng):
        self.rng = rng
        self.kind = rng.choice(["four-bar", "four-bar", "slider", "arm", "chain", "damped"])
        self.acc = rng.choice([1e-2, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
        self.start = rng.choice(["ramp", "ramp", "rest", "velocity", "law", "steady"])
        if self.acc < 1e-3 and self.start in ("rest", "velocity"):
            self.start = "ramp"
        if self.kind in ("arm", "chain") and self.start == "steady":
            self.start = "law"
        self.speed = rng.uniform(3, 15) * rng.choice([1, -1])
        self.ratio = rng.choice([0.0, 0.0, 0.01, 0.05]) if self.start != "steady" else 0.03
        self.turns = rng.choice([0.1, 0.25, 0.4])
        self.first = rng.uniform(0, 360)
        self.thick = [rng.uniform(3, 8) for _ in range(3)]
        self.crank = rng.uniform(60, 100)
        self.long = rng.uniform(220, 300)
        self.other = rng.uniform(200, 280)
        self.ground = rng.uniform(220, 280)
        self.law = rng.choice(["cycloidal", "modified_sine", "polynomial_345", "parabolic", "harmonic", "modified_trapezoid"])
        self.mass = rng.uniform(0.02, 0.3)
        self.gravity = rng.random() < 0.5
        self.joint = rng.uniform(0.005, 0.05)
        self.turn = [rng.uniform(-60, 60), rng.uniform(-60, 60)]

    def deck(self, accuracy, rotate=0.0, mirror=False):
        sense = -1 if mirror else 1
        c, s = math.cos(math.radians(rotate)), math.sin(math.radians(rotate))

        def place(x, y):
            y *= sense
            return f"{number(c * x - s * y)} {number(s * x + c * y)}"

        def angle(a):
            return sense * a + rotate

        lines = ["UNITS    mm kg s speed=rad/s", "MATERIAL steel E=200GPa density=7800kg/m3"]
        lines += [f"SECTION  s{k} rectangle thickness={number(t)} width=20" for k, t in enumerate(self.thick)]
        if self.gravity:
            lines.append(f"GRAVITY  {number(9.81 * math.cos(math.radians(rotate - 90 * sense)))}m/s2 "
                         f"{number(9.81 * math.sin(math.radians(rotate - 90 * sense)))}m/s2")
        lines.append("GROUND   O2 " + place(0, 0))
        lines.append("DRIVE crank" + (" law=go" if self.start == "law" else ""))
        if self.kind in ("four-bar", "damped"):
            lines += ["GROUND   O4 " + place(self.ground, 0), f"LINK crank O2 A length={number(self.crank)} material=steel section=s0",
                      f"LINK rod A B length={number(self.long)} material=steel section=s1",
                      f"LINK follower O4 B length={number(self.other)} material=steel section=s2",
                      f"BRANCH B {'right' if mirror else 'left'} A O4", f"PINMASS B {number(self.mass)}", "GAUGE g rod at=100"]
            if self.kind == "damped":
                lines.append(f"DAMPER d B rod follower damping={number(self.joint)}N*m*s/rad")
        elif self.kind == "slider":
            lines += ["GUIDE bed " + place(0, -10) + f" angle={number(rotate)}",
                      f"LINK crank O2 A length={number(self.crank)} material=steel section=s0",
                      f"LINK rod A B length={number(self.long)} material=steel section=s1",
                      f"SLIDER B bed mass={number(self.mass)}", "BRANCH B forward", "GAUGE g rod at=100"]
        elif self.kind == "arm":
            lines += [f"LINK crank O2 A B lengths={number(self.crank)},{number(self.long)} turns={number(sense * self.turn[0])} "
                      "material=steel section=s0", f"PINMASS B {number(self.mass)}", "GAUGE g crank at=30"]
        else:
            lines += [f"LINK crank O2 A length={number(self.crank)} material=steel section=s0",
                      f"LINK rod A B C lengths={number(self.long / 2)},{number(self.long / 3)} turns={number(sense * self.turn[1])} "
                      "material=steel section=s1",
                      f"DRIVE rod against crank ratio={number(self.follow)} phase={number(sense * self.turn[0] - self.follow * rotate)}",
                      f"PINMASS C {number(self.mass)}", "GAUGE g rod at=30"]
        if self.ratio:
            lines.append(f"DAMPING * ratio={number(self.ratio)}")
        period = 2 * math.pi / abs(self.speed)
        report = f"REPORT transient accuracy={accuracy:g}"
        if self.start == "law":
            stop = period * max(self.turns, 0.3)
            way = math.copysign(360 * self.turns, self.speed)
            lines += [f"LAW go {self.law} from={number(angle(self.first))}deg to={number(angle(self.first + way))}deg "
                      f"start={number(0.1 * stop)}s stop={number(stop)}s", f"TIME 0 to {number(1.2 * stop)} step {number(1.2 * stop / 25)}"]
        else:
            ramp = f" ramp={number(0.2 * period)}" if self.start == "ramp" else ""
            lines.append(f"SPEED {number(sense * self.speed)}{ramp}")
            report += f" turns={self.turns} crank={number(angle(self.first))} instants=40"
            if self.start == "velocity":
                report += f" perturb=1,0,{number(sense * 0.2)}m/s"
            if self.start == "steady":
                report += " start=steady"
        return "\n".join(lines + [report, "END", ""])


def run(options, name, text):
    path = os.path.join(options.scratch, name + ".deck")
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
    done = subprocess.run([options.program, "--quiet", "--threads", "1", "--out", options.scratch, path], capture_output=True, text=True,
                          check=False, timeout=options.seconds)
    if done.returncode not in (0, 1):
        raise ValueError(f"exit status {done.returncode}: {done.stderr.strip().splitlines()[:1]}")
    tables = {}
    for table in ("transient", "gauges"):
        tables[table] = {}
        with open(os.path.join(options.scratch, name, table + ".dat"), encoding="ascii") as file:
            for line in file:
                if not line.startswith("#") and line.strip():
                    words = line.split()
                    tables[table].setdefault(words[3], []).append([float(w) for w in words[4:]])
    return tables


def turned(rows, rotate, mirror):
    """Displacements in the axes of the first deck."""
    c, s = math.cos(math.radians(rotate)), math.sin(math.radians(rotate))
    sense = -1 if mirror else 1
    return [[c * x + s * y, sense * (c * y - s * x), sense * turn, error] for x, y, turn, error in rows]


def differences(one, other, table, section):
    """(difference, sum of errors) of every quantity, relative to its largest value."""
    found = []
    for name in one:
        if name not in other or len(one[name]) != len(other[name]):
            raise ValueError("other rows")
        a, b = one[name], other[name]
        errors = (a[0][-1], b[0][-1])
        if table == "transient":
            size = max(math.hypot(r[0], r[1]) for r in b)
            if size > 0:
                found.append((max(math.hypot(p[0] - q[0], p[1] - q[1]) for p, q in zip(a, b)) / size, errors))
            continue
        total = max(abs(r[0]) for r in b) + max(abs(r[1]) for r in b)
        for k, parts in ((0, 0), (1, 1), (2, 1), (3, 0), (4, None)):
            size = max(abs(r[k]) for r in b)
            if parts is not None:
                own = max(abs(r[parts]) for r in b)
                if own <= 0:
                    continue
                size *= max(1.0, GAUGE_SCALE * total / own)
            if size > 0:
                found.append((max(abs(p[k] - q[k]) for p, q in zip(a, b)) / size, errors))
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join("build", "estimates_transient"))
    parser.add_argument("--seconds", type=float, default=120.0, help="a run may take; longer ones are left out")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.makedirs(options.scratch, exist_ok=True)
    passed = failed = 0
    shares, compared, refused = [], 0, 0
    for number_of_case in range(options.count):
        rng = random.Random(f"{options.seed}/{number_of_case}")
        case = Linkage(rng)
        rotate = rng.uniform(0, 360)
        label = f"case {number_of_case} ({case.kind}, {case.start}, {case.acc:g})"
        try:
            base = run(options, "base", case.deck(case.acc))
            for what, angle, mirror, fine in (("finer", 0, False, 1e-4), ("rotated", rotate, False, 1), ("mirrored", rotate, True, 1)):
                accuracy = case.acc * fine
                other = {"transient": {}, "gauges": {}}
                while not (other["transient"] or other["gauges"]) and accuracy < 10 * case.acc:
                    other = run(options, "other", case.deck(max(accuracy, 1e-7), angle, mirror))
                    accuracy *= 100
                for table in ("transient", "gauges"):
                    if not base[table] or not other[table]:
                        refused += 1
                        continue
                    if table == "transient":
                        other[table] = {n: turned(r, angle, mirror) for n, r in other[table].items()}
                    elif mirror:
                        other[table] = {n: [[r[0], -r[1], -r[2], *r[3:]] for r in rows] for n, rows in other[table].items()}
                    for difference, errors in differences(base[table], other[table], table, case):
                        compared += 1
                        if what == "finer" and difference > 0:
                            shares.append(errors[0] / difference)
                        if difference > sum(errors):
                            raise ValueError(f"{what}: {table} differ by {difference:.2e}, errors {errors[0]:.1e} and {errors[1]:.1e}")
            passed += 1
        except KeyboardInterrupt:
            break  # what is done counts
        except subprocess.TimeoutExpired:
            refused += 1
        except (ValueError, OSError) as problem:
            failed += 1
            print(f"not ok {label}: {problem}")
    shares.sort()
    if shares:
        at = [shares[min(int(q * len(shares)), len(shares) - 1)] for q in (0, 0.01, 0.1, 0.5, 0.9)]
        print(f"{compared} quantities compared, {refused} tables without rows; estimate/true of {len(shares)}: least, 1 %, 10 %, median, "
              "90 %: " + ", ".join(f"{x:.2g}" for x in at))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
