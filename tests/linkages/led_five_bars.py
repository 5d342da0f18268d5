"""Five-bars led along polygons by two tables of joint angles, against closed forms, Newton and Euler:
`led_five_bars.py FIRST LAST [--program P]`.

For every number a robot at random, its tables by inverse kinematics, and their periodic cubic splines once more here. Compared are places,
velocities and accelerations of the pins, positions, rates and torques of both drives at all instants, and the ratings of the torques with
those of a fine sampling. Vectors of the plane are complex numbers.
"""
import argparse
import bisect
import cmath
import math
import os
import random
import subprocess
import sys
import tempfile

import dense

NEAR = 1e-9   # of the largest value of its kind
RATED = 1e-3  # of the peak: the samples here lie elsewhere, between the kinks of the accelerations


def cross(a, b):
    return a.real*b.imag - a.imag*b.real


class Periodic:
    """A periodic cubic spline by its second derivatives."""

    def __init__(self, x, y):
        n = len(x) - 1
        h, dy = ([b - a for a, b in zip(values, values[1:])] for values in (x, y))
        matrix, right = [[0.0]*n for _ in range(n)], [6*(dy[i]/h[i] - dy[i - 1]/h[i - 1]) for i in range(n)]
        for i in range(n):
            matrix[i][i] += 2*(h[i - 1] + h[i])
            matrix[i][i - 1] += h[i - 1]
            matrix[i][(i + 1) % n] += h[i]
        bend = dense.solve(dense.factor(matrix), right)
        self.x, self.y, self.h, self.bend = x, y, h, bend + bend[:1]

    def __call__(self, t):
        x, y, bend = self.x, self.y, self.bend
        t = x[0] + (t - x[0]) % (x[-1] - x[0])
        i = min(max(bisect.bisect_right(x, t) - 1, 0), len(x) - 2)
        h = self.h[i]
        a, b = (x[i + 1] - t)/h, (t - x[i])/h
        return (a*y[i] + b*y[i + 1] + ((a**3 - a)*bend[i] + (b**3 - b)*bend[i + 1])*h*h/6,
                (y[i + 1] - y[i])/h + ((1 - 3*a*a)*bend[i] + (3*b*b - 1)*bend[i + 1])*h/6, a*bend[i] + b*bend[i + 1])


class Robot:
    """Bodies 0, 1 turn about the motors, 2, 3 meet in the tool; lengths in m, masses in kg."""

    def __init__(self, rng):
        self.upper, self.fore = rng.uniform(0.15, 0.25), rng.uniform(0.25, 0.35)
        self.motor = [0j, complex(rng.uniform(0.08, 0.2), rng.uniform(-0.02, 0.02))]
        self.mass, self.inertia = [rng.uniform(0.2, 1) for _ in range(4)], [rng.uniform(1e-3, 1e-2) for _ in range(4)]
        self.centre = [rng.uniform(0.3, 0.6)*length for length in (self.upper, self.upper, self.fore, self.fore)]
        self.tool, self.gravity = rng.uniform(0, 1), complex(0, -rng.uniform(0, 9.81))
        middle = 0.5*self.motor[1] + 0.75j*math.hypot(self.upper, self.fore)
        self.corners = [middle + complex(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05)) for _ in range(4)]

    def angles(self, place):
        """Joint angles with both elbows outside."""
        found = []
        for motor, side in zip(self.motor, (1, -1)):
            reach, angle = cmath.polar(place - motor)
            found.append(angle + side*math.acos((self.upper**2 + reach**2 - self.fore**2)/(2*self.upper*reach)))
        return found

    def led(self, share):
        """The tool at a share of the cycle: from corner to corner with rests."""
        side = min(int(4*share), 3)
        x = 4*share - side
        return self.corners[side] + (self.corners[(side + 1) % 4] - self.corners[side])*(10*x**3 - 15*x**4 + 6*x**5)

    def solve(self, q, w, e):
        """Places, velocities and accelerations of A, B, P, and both torques."""
        upper = [cmath.rect(self.upper, angle) for angle in q]
        elbow = [self.motor[k] + upper[k] for k in (0, 1)]
        v = [1j*w[k]*upper[k] for k in (0, 1)]
        a = [(1j*e[k] - w[k]**2)*upper[k] for k in (0, 1)]
        way = elbow[1] - elbow[0]
        tool = 0.5*(elbow[0] + elbow[1]) + 1j*way/abs(way)*math.sqrt(self.fore**2 - 0.25*abs(way)**2)
        arm = [tool - place for place in elbow]

        def loop(gap):  # the turns with turn[0]*1j*arm[0] - turn[1]*1j*arm[1] = gap
            return [cross(-1j*gap, arm[1 - k])/cross(arm[0], arm[1]) for k in (0, 1)]

        turn = loop(v[1] - v[0])
        bend = loop(a[1] - a[0] + turn[0]**2*arm[0] - turn[1]**2*arm[1])
        v.append(v[0] + 1j*turn[0]*arm[0])
        a.append(a[0] + (1j*bend[0] - turn[0]**2)*arm[0])
        return elbow + [tool], v, a, self.torques(w, e, upper, arm, a, turn, bend)

    def torques(self, w, e, upper, arm, a, turn, bend):
        """Newton and Euler: forearms about their elbows give the forces at the tool, then upper arms about the motors the torques."""
        def needs(body, along, start, rate, change):  # the force of a body, and its moment about its first pin
            r = self.centre[body]*along/abs(along)
            force = self.mass[body]*(start + (1j*change - rate**2)*r - self.gravity)
            return force, self.inertia[body]*change + cross(r, force)

        fore = [needs(2 + k, arm[k], a[k], turn[k], bend[k]) for k in (0, 1)]
        load = self.tool*(self.gravity - a[2])  # of the tool upon both forearms
        moments = fore[0][1], cross(arm[1], load) - fore[1][1]  # of the force upon the first, about both elbows
        first = (moments[0]*arm[1] - moments[1]*arm[0])/cross(arm[0], arm[1])
        elbow = [first - fore[0][0], load - first - fore[1][0]]
        return [needs(k, upper[k], 0, w[k], e[k])[1] - cross(upper[k], elbow[k]) for k in (0, 1)]

    def deck(self, cards):
        bodies = [("left", "M A", self.upper), ("right", "N B", self.upper), ("one", "A P", self.fore), ("two", "B P", self.fore)]
        return "\n".join(["UNITS m kg s"] + [f"GROUND {name} {place.real} {place.imag}" for name, place in zip("MN", self.motor)] + [
            f"LINK {name} {pins} length={length} mass={self.mass[k]} inertia={self.inertia[k]} center={self.centre[k]},0"
            for k, (name, pins, length) in enumerate(bodies)] + [
            f"PINMASS P {self.tool}", f"GRAVITY {self.gravity.real} {self.gravity.imag}", "BRANCH P left A B"] + cards) + "\n"


def rows_of(path):
    with open(path, encoding="utf-8") as table:
        return [line.split() for line in table if line.strip() and not line.startswith("#")]


def check(number, program, folder):
    """Largest differences, as shares of the largest values; of ratings of the peak."""
    rng = random.Random(number)
    robot, period, count = Robot(rng), rng.uniform(0.8, 3), 40
    times = [round(period*n/count, 9) for n in range(count + 1)]
    period = times[-1]
    angles = [[round(math.degrees(angle), 9) for angle in robot.angles(robot.led(t/period))] for t in times]
    angles[-1] = angles[0]
    tables = [" ".join(f"{t:.9f} {q[k]:.9f}" for t, q in zip(times, angles)) for k in (0, 1)]
    path = os.path.join(folder, f"robot{number}.deck")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(robot.deck(["DRIVE left law=l", "DRIVE right law=r", "LAW l table=lt ends=periodic", "LAW r table=rt ends=periodic"] + [
            f"TABLE {name} s deg " + table for name, table in zip(("lt", "rt"), tables)] + [
            f"TIME 0 to {1.5*period} step {period/37}", "REPORT pins", "REPORT drives", "REPORT sizing"]))
    subprocess.run([program, "--quiet", "--out", folder, path], check=True)
    splines = [Periodic(times, [math.radians(q[k]) for q in angles]) for k in (0, 1)]
    motion = lambda t: list(zip(*(spline(t) for spline in splines)))
    differences, scales = {}, {}

    def compare(kind, found, exact, scale=0):
        difference = min(math.inf, abs(float(found) - exact))  # NaN is infinite
        differences[kind] = max(differences.get(kind, 0), difference)
        scales[kind] = max(scales.get(kind, 0), scale or abs(exact))

    out = os.path.join(folder, f"robot{number}")
    for row in rows_of(os.path.join(out, "pins.dat")):
        exact = robot.solve(*motion(float(row[0])))
        for n, kind in enumerate(("place", "velocity", "acceleration")):
            if row[3] in "ABP":
                value = exact[n]["ABP".index(row[3])]
                compare(kind, row[4 + 2*n], value.real)
                compare(kind, row[5 + 2*n], value.imag)
    for row in rows_of(os.path.join(out, "drives.dat")):
        now, k = motion(float(row[0])), ("left", "right").index(row[3])
        compare("angle", row[4], math.degrees(now[0][k]))
        compare("rate", row[5], now[1][k])
        compare("torque", row[6], robot.solve(*now)[3][k])
    torques = list(zip(*(robot.solve(*motion(n*period/(40*count)))[3] for n in range(40*count))))
    peaks = [max(map(abs, values)) for values in torques]
    for row in rows_of(os.path.join(out, "sizing.dat")):
        if row[1] != "-" or not row[2].endswith("_torque"):
            continue
        k, kind = ("left", "right").index(row[0]), row[2][:-7]
        values = torques[k]
        exact = {"peak": peaks[k], "rms": math.hypot(*values)/math.sqrt(len(values)), "mean": math.fsum(values)/len(values)}[kind]
        compare("rating", abs(float(row[3])) if kind == "peak" else row[3], exact, max(peaks))
    return {kind: differences[kind]/scales[kind] for kind in differences}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(":", maxsplit=1)[0])
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--program", default="build/release/flexmech")
    options = parser.parse_args()
    passed, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.first, options.last + 1):
            found = check(number, options.program, folder)
            wrong = {kind: share for kind, share in found.items() if not share <= (RATED if kind == "rating" else NEAR)}
            passed, failed = passed + (not wrong), failed + bool(wrong)
            if wrong:
                print(f"not ok {number}: {wrong}")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
