"""Five-bars led along polygons by two tables of joint angles, against closed forms, Newton and Euler:
`led_five_bars.py FIRST LAST [--program P]` (needs NumPy).

For every number a robot at random, its tables by inverse kinematics, and their periodic cubic splines once more here. Compared are places,
velocities and accelerations of the pins, positions, rates and torques of both drives at all instants, and the ratings of the torques with
those of a fine sampling.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np

ACROSS = np.array([[0.0, -1.0], [1.0, 0.0]])
NEAR = 1e-9   # of the largest value of its kind
RATED = 1e-3  # of the peak: the samples here lie elsewhere, between the kinks of the accelerations


def unit(angle):
    return np.array([np.cos(angle), np.sin(angle)])


class Periodic:
    """A periodic cubic spline by its second derivatives."""

    def __init__(self, x, y):
        h, dy, n = np.diff(x), np.diff(y), len(x) - 1
        matrix, right = np.zeros((n, n)), np.zeros(n)
        for i in range(n):
            matrix[i, i] += 2*(h[i - 1] + h[i])
            matrix[i, (i - 1) % n] += h[i - 1]
            matrix[i, (i + 1) % n] += h[i]
            right[i] = 6*(dy[i]/h[i] - dy[i - 1]/h[i - 1])
        bend = np.linalg.solve(matrix, right)
        self.x, self.y, self.h, self.bend = x, y, h, np.append(bend, bend[0])

    def __call__(self, t):
        x, y, bend = self.x, self.y, self.bend
        t = x[0] + (t - x[0]) % (x[-1] - x[0])
        i = min(max(int(np.searchsorted(x, t, side="right")) - 1, 0), len(x) - 2)
        h = self.h[i]
        a, b = (x[i + 1] - t)/h, (t - x[i])/h
        return (a*y[i] + b*y[i + 1] + ((a**3 - a)*bend[i] + (b**3 - b)*bend[i + 1])*h*h/6,
                (y[i + 1] - y[i])/h + ((1 - 3*a*a)*bend[i] + (3*b*b - 1)*bend[i + 1])*h/6, a*bend[i] + b*bend[i + 1])


class Robot:
    """Bodies 0, 1 turn about the motors, 2, 3 meet in the tool; lengths in m, masses in kg."""

    def __init__(self, random):
        self.upper, self.fore = random.uniform(0.15, 0.25), random.uniform(0.25, 0.35)
        self.motor = np.array([[0.0, 0.0], [random.uniform(0.08, 0.2), random.uniform(-0.02, 0.02)]])
        self.mass, self.inertia = random.uniform(0.2, 1, 4), random.uniform(1e-3, 1e-2, 4)
        self.centre = np.append(random.uniform(0.3, 0.6, 2)*self.upper, random.uniform(0.3, 0.6, 2)*self.fore)
        self.tool, self.gravity = random.uniform(0, 1), np.array([0.0, -random.uniform(0, 9.81)])
        middle = 0.5*self.motor.sum(axis=0) + [0, 0.75*np.hypot(self.upper, self.fore)]
        self.corners = [middle + random.uniform(-0.05, 0.05, 2) for _ in range(4)]

    def angles(self, place):
        """Joint angles with both elbows outside."""
        found = []
        for k, side in ((0, 1), (1, -1)):
            way = place - self.motor[k]
            reach = np.hypot(*way)
            found.append(np.arctan2(way[1], way[0]) + side*np.arccos((self.upper**2 + reach**2 - self.fore**2)/(2*self.upper*reach)))
        return found

    def led(self, share):
        """The tool at a share of the cycle: from corner to corner with rests."""
        side = min(int(4*share), 3)
        x = 4*share - side
        return self.corners[side] + (self.corners[(side + 1) % 4] - self.corners[side])*(10*x**3 - 15*x**4 + 6*x**5)

    def solve(self, q, w, e):
        """Places, velocities and accelerations of A, B, P, and both torques."""
        elbow = [self.motor[k] + self.upper*unit(q[k]) for k in (0, 1)]
        v = [self.upper*w[k]*ACROSS @ unit(q[k]) for k in (0, 1)]
        a = [self.upper*(e[k]*ACROSS @ unit(q[k]) - w[k]**2*unit(q[k])) for k in (0, 1)]
        way = elbow[1] - elbow[0]
        length = np.hypot(*way)
        tool = 0.5*(elbow[0] + elbow[1]) + ACROSS @ way/length*np.sqrt(self.fore**2 - 0.25*length**2)
        arm = [tool - elbow[k] for k in (0, 1)]
        loop = np.column_stack([ACROSS @ arm[0], -ACROSS @ arm[1]])
        turn = np.linalg.solve(loop, v[1] - v[0])
        bend = np.linalg.solve(loop, a[1] - a[0] + turn[0]**2*arm[0] - turn[1]**2*arm[1])
        v.append(v[0] + turn[0]*ACROSS @ arm[0])
        a.append(a[0] + bend[0]*ACROSS @ arm[0] - turn[0]**2*arm[0])
        return elbow + [tool], v, a, self.torques(q, w, e, arm, a, turn, bend)

    def torques(self, q, w, e, arm, a, turn, bend):
        """Newton and Euler for all bodies: forces at motors, elbows and tool, then both torques are unknown."""
        matrix, right, row = np.zeros((14, 14)), np.zeros(14), 0
        moment = lambda r: np.array([-r[1], r[0]])
        for k in (0, 1):
            motor, elbow, tool = (slice(2*k + n, 2*k + n + 2) for n in (0, 4, 8))
            along = unit(q[k])
            r = self.centre[k]*along
            matrix[row:row + 2, motor] = matrix[row:row + 2, elbow] = np.eye(2)
            right[row:row + 2] = self.mass[k]*(e[k]*ACROSS @ r - w[k]**2*r - self.gravity)
            matrix[row + 2, motor], matrix[row + 2, elbow], matrix[row + 2, 12 + k] = moment(-r), moment(self.upper*along - r), 1
            right[row + 2] = self.inertia[k]*e[k]
            r = self.centre[2 + k]*arm[k]/self.fore
            matrix[row + 3:row + 5, elbow], matrix[row + 3:row + 5, tool] = -np.eye(2), np.eye(2)
            right[row + 3:row + 5] = self.mass[2 + k]*(a[k] + bend[k]*ACROSS @ r - turn[k]**2*r - self.gravity)
            matrix[row + 5, elbow], matrix[row + 5, tool] = -moment(-r), moment(arm[k] - r)
            right[row + 5] = self.inertia[2 + k]*bend[k]
            row += 6
        matrix[row:, 8:10] = matrix[row:, 10:12] = -np.eye(2)
        right[row:] = self.tool*(a[2] - self.gravity)
        return np.linalg.solve(matrix, right)[12:]

    def deck(self, cards):
        m = self.motor
        bodies = [("left", "M A", self.upper), ("right", "N B", self.upper), ("one", "A P", self.fore), ("two", "B P", self.fore)]
        return "\n".join(["UNITS m kg s", f"GROUND M {m[0, 0]} {m[0, 1]}", f"GROUND N {m[1, 0]} {m[1, 1]}"] + [
            f"LINK {name} {pins} length={length} mass={self.mass[k]} inertia={self.inertia[k]} center={self.centre[k]},0"
            for k, (name, pins, length) in enumerate(bodies)] + [
            f"PINMASS P {self.tool}", f"GRAVITY {self.gravity[0]} {self.gravity[1]}", "BRANCH P left A B"] + cards) + "\n"


def rows_of(path):
    with open(path) as table:
        return [line.split() for line in table if line.strip() and not line.startswith("#")]


def check(number, program, folder):
    """Largest differences, as shares of the largest values; of ratings of the peak."""
    random = np.random.default_rng(number)
    robot, period, count = Robot(random), random.uniform(0.8, 3), 40
    times = np.round(np.linspace(0, period, count + 1), 9)
    period = times[-1]
    angles = np.round(np.degrees([robot.angles(robot.led(t/period)) for t in times]), 9)
    angles[-1] = angles[0]
    tables = [" ".join(f"{t:.9f} {q:.9f}" for t, q in zip(times, angles[:, k])) for k in (0, 1)]
    path = os.path.join(folder, f"robot{number}.deck")
    with open(path, "w") as deck:
        deck.write(robot.deck(["DRIVE left law=l", "DRIVE right law=r", "LAW l table=lt ends=periodic", "LAW r table=rt ends=periodic"] + [
            f"TABLE {name} s deg " + table for name, table in zip(("lt", "rt"), tables)] + [
            f"TIME 0 to {1.5*period} step {period/37}", "REPORT pins", "REPORT drives", "REPORT sizing"]))
    subprocess.run([program, "--quiet", "--out", folder, path], check=True)
    splines = [Periodic(times, np.radians(angles[:, k])) for k in (0, 1)]
    motion = lambda t: [np.array(values) for values in zip(*(spline(t) for spline in splines))]
    differences, scales = {}, {}

    def compare(kind, found, exact):
        found, exact = np.asarray(found, float), np.asarray(exact, float)
        differences[kind] = max(differences.get(kind, 0), np.max(np.abs(found - exact)))
        scales[kind] = max(scales.get(kind, 0), np.max(np.abs(exact)))

    out = os.path.join(folder, f"robot{number}")
    for row in rows_of(os.path.join(out, "pins.dat")):
        exact = robot.solve(*motion(float(row[0])))
        for kind, values in zip(("place", "velocity", "acceleration"), exact):
            n = ("place", "velocity", "acceleration").index(kind)
            if row[3] in "ABP":
                compare(kind, [float(x) for x in row[4 + 2*n:6 + 2*n]], values["ABP".index(row[3])])
    for row in rows_of(os.path.join(out, "drives.dat")):
        now, k = motion(float(row[0])), ("left", "right").index(row[3])
        compare("angle", float(row[4]), np.degrees(now[0][k]))
        compare("rate", float(row[5]), now[1][k])
        compare("torque", float(row[6]), robot.solve(*now)[3][k])
    torque = np.array([robot.solve(*motion(t))[3] for t in np.arange(40*count)*period/(40*count)])
    for row in rows_of(os.path.join(out, "sizing.dat")):
        if row[1] != "-" or not row[2].endswith("_torque"):
            continue
        values, peak = torque[:, ("left", "right").index(row[0])], np.max(np.abs(torque))
        exact = {"peak": np.max(np.abs(values)), "rms": np.sqrt(np.mean(values**2)), "mean": np.mean(values)}[row[2][:-7]]
        differences["rating"] = max(differences.get("rating", 0), abs((abs(float(row[3])) if row[2][0] == "p" else float(row[3])) - exact))
        scales["rating"] = peak
    return {kind: differences[kind]/scales[kind] for kind in differences}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(":")[0])
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
