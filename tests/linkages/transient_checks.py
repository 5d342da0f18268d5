"""Motions in time of a turning arm against an own integration: `transient_checks.py --program P --scratch DIR`; a line a test.

A uniform arm, clamped to the crank's shaft, with a mass at its tip. Its deflection v is taken in powers of the place, x^2 to x^7, without
elongation: with the acceleration a and the speed w of the shaft

    int mu p_i p_k q_k'' + c K q' + (K + w^2 (int N p_i' p_k' - int mu p_i p_k)) q = -a int mu x p_i,

N being the tension of the arm that turns. Runge and Kutta's method of order 4 goes from instant to instant. What elongation would do is of the
order (thickness/length)^2.
"""
import argparse
import math
import os
import subprocess

LENGTH, THICK, WIDE, MASS, TIME = 0.4, 0.004, 0.02, 0.05, 1e-4
DENSITY, YOUNG = 7800.0, 2e11
POWERS = range(2, 8)
STEP = 3e-5

HEAD = f"""UNITS    m kg s speed=rad/s
MATERIAL steel E={YOUNG} density={DENSITY}
SECTION  strip general A={THICK * WIDE} I={THICK**3 * WIDE / 12}
GROUND   O 0 0
DAMPING  * time={TIME}
"""
ARMS = {"one part": f"LINK arm O A length={LENGTH} material=steel section=strip\nPINMASS A {MASS}\n",
        "two parts": f"LINK arm O C A lengths=0.15,{LENGTH - 0.15} turns=0 material=steel section=strip\nPINMASS A {MASS}\n"}


def solved(rows, right):
    """Solves a small system by elimination."""
    n = len(rows)
    a = [row[:] + [b] for row, b in zip(rows, right)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(a[k][i]))
        a[i], a[p] = a[p], a[i]
        for k in range(i + 1, n):
            f = a[k][i] / a[i][i]
            for j in range(i, n + 1):
                a[k][j] -= f * a[i][j]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (a[i][n] - sum(a[i][j] * x[j] for j in range(i + 1, n))) / a[i][i]
    return x


def arm():
    """Mass, stiffness, stiffness of the tension per w^2, load per acceleration; lengths are those of the arm."""
    mu, bend = DENSITY * THICK * WIDE * LENGTH, YOUNG * WIDE * THICK**3 / 12 / LENGTH**3
    mass, stiff, tension = ([[0.0] * len(POWERS) for _ in POWERS] for _ in range(3))
    for i, m in enumerate(POWERS):
        for k, n in enumerate(POWERS):
            mass[i][k] = mu / (m + n + 1) + MASS
            stiff[i][k] = bend * m * (m - 1) * n * (n - 1) / (m + n - 3)
            # N = w^2 (mu (1 - x^2)/2 + MASS)
            tension[i][k] = m * n * (mu / 2 * (1 / (m + n - 1) - 1 / (m + n + 1)) + MASS / (m + n - 1))
    load = [LENGTH * (mu / (m + 2) + MASS) for m in POWERS]
    return mass, stiff, tension, load


class Arm:
    """Powers are made modes of the arm at rest, since these do not mix rounding."""

    def __init__(self):
        mass, stiff, tension, load = arm()
        shapes = self.modes(mass, stiff)
        n = len(shapes)

        def turned(matrix):
            return [[sum(shapes[i][a] * matrix[a][b] * shapes[k][b] for a in range(n) for b in range(n)) for k in range(n)] for i in range(n)]

        self.squares = [turned(stiff)[i][i] for i in range(n)]
        self.tension = turned(tension)
        self.load = [sum(s * b for s, b in zip(shape, load)) for shape in shapes]
        self.tip = [sum(shape) for shape in shapes]

    @staticmethod
    def modes(mass, stiff):
        """Inverse iteration, one mode after another, each with mass 1."""
        n = len(mass)
        found = []
        for start in range(n):
            x = [1.0 if k == start else 0.1 for k in range(n)]
            for _ in range(200):
                b = [sum(mass[i][k] * x[k] for k in range(n)) for i in range(n)]
                x = solved(stiff, b)
                for _ in range(2):
                    for mode in found:
                        part = sum(mode[i] * mass[i][k] * x[k] for i in range(n) for k in range(n))
                        x = [a - part * b for a, b in zip(x, mode)]
                size = math.sqrt(sum(x[i] * mass[i][k] * x[k] for i in range(n) for k in range(n)))
                x = [a / size for a in x]
            found.append(x)
        return found

    def rates(self, q, v, speed, acceleration):
        """Accelerations of the modes."""
        s2 = speed * speed
        return [-acceleration * self.load[i] - TIME * self.squares[i] * v[i] - (self.squares[i] - s2) * q[i]
                - s2 * sum(t * x for t, x in zip(self.tension[i], q)) for i in range(len(q))]

    def go(self, motion, times, q, v, breaks=(), jumps=()):
        """Displacement of the tip at the times; `motion` gives speed and acceleration at a time, from the side of the second time."""
        n = len(q)
        tips, now = [], times[0]
        for goal in times:
            for to in [b for b in breaks if now < b < goal] + [goal]:
                steps = max(1, math.ceil((to - now) / STEP - 1e-9)) if to > now else 0
                h = (to - now) / max(steps, 1)
                middle = 0.5 * (to + now)
                for k in range(steps):
                    t = now + k * h
                    first, half, last = motion(t, middle), motion(t + h / 2, middle), motion(t + h, middle)
                    a1 = self.rates(q, v, *first)
                    v2 = [v[i] + h / 2 * a1[i] for i in range(n)]
                    a2 = self.rates([q[i] + h / 2 * v[i] for i in range(n)], v2, *half)
                    v3 = [v[i] + h / 2 * a2[i] for i in range(n)]
                    a3 = self.rates([q[i] + h / 2 * v2[i] for i in range(n)], v3, *half)
                    v4 = [v[i] + h * a3[i] for i in range(n)]
                    a4 = self.rates([q[i] + h * v3[i] for i in range(n)], v4, *last)
                    q = [q[i] + h / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + v4[i]) for i in range(n)]
                    v = [v[i] + h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]) for i in range(n)]
                now = to
                for when, change in jumps:
                    if abs(when - to) < 1e-12 and steps:
                        v = [x - change * b for x, b in zip(v, self.load)]
            tips.append(sum(a * b for a, b in zip(self.tip, q)))
        return tips


def run(options, name, text):
    path = os.path.join(options.scratch, name + ".deck")
    with open(path, "w", encoding="ascii") as file:
        file.write(text + "END\n")
    subprocess.run([options.program, "--quiet", "--out", options.scratch, path], check=True)
    rows = []
    with open(os.path.join(options.scratch, name, "transient.dat"), encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words and words[0] != "#" and words[3].startswith("A"):
                speed, time, crank = (float(w) for w in words[:3])
                ux, uy, _, error = (float(w) for w in words[4:])
                angle = math.radians(crank)
                rows.append((speed, time, crank, uy * math.cos(angle) - ux * math.sin(angle), error))
    return rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default="build/release/flexmech")
    parser.add_argument("--scratch", default=os.path.join("build", "transient_checks"))
    options = parser.parse_args()
    os.makedirs(options.scratch, exist_ok=True)
    beam = Arm()
    zero = [0.0] * len(beam.tip)
    solved_before = {}

    def check(name, deck, motion, q, v, breaks=(), jumps=(), end=None):
        rows = run(options, name.replace(" ", "_"), HEAD + deck)
        what = name.split(",")[0]
        if what not in solved_before:
            solved_before[what] = beam.go(motion, [r[1] for r in rows], q, v, breaks, jumps)
        known = solved_before[what]
        size = max(abs(x) for x in known)
        worst = max(abs(r[3] - x) for r, x in zip(rows, known)) / size
        # Elongation: (THICK/LENGTH)^2 = 1e-4.
        fine = worst < 1e-4 + rows[0][4] and (end is None or abs(rows[-1][1] - end) < 1e-12)
        print(f"ok {name}" if fine else f"not ok {name}: {worst:.1e} off, ends at {rows[-1][1]}")

    speed, ramp = 9.0, 0.11
    for parts, cards in ARMS.items():
        deck = cards + f"DRIVE arm\nSPEED {speed} ramp={ramp}\nREPORT transient turns=0.12 instants=40 accuracy=1e-5\n"
        check(f"a ramp, {parts}", deck, lambda t, side: (speed * t / ramp, speed / ramp) if side < ramp else (speed, 0.0), zero, zero,
              (ramp,), end=0.12 * 2 * math.pi / speed + ramp / 2)
        start, stop, way = 0.02, 0.12, math.radians(50)

        def cycloidal(t, side):
            if not start < side < stop:
                return 0.0, 0.0
            x, long = (t - start) / (stop - start), stop - start
            return way / long * (1 - math.cos(2 * math.pi * x)), way / long**2 * 2 * math.pi * math.sin(2 * math.pi * x)

        law = cards + "DRIVE arm law=go\nTIME 0 to 0.14 step 0.007\nREPORT transient accuracy=1e-5\n"
        check(f"a law, {parts}", law + f"LAW go cycloidal from=10deg to=60deg start={start} stop={stop}\n", cycloidal, zero, zero,
              (start, stop), end=0.14)

        def even(t, side):
            return (way / (stop - start) if start < side < stop else 0.0, 0.0)

        rate = way / (stop - start)
        check(f"jumps of the speed, {parts}", law.replace("1e-5", "1e-3") +
              f"LAW go ramp from=10deg to=60deg start={start} stop={stop}\n", even, zero, zero, (start, stop),
              ((start, rate), (stop, -rate)), end=0.14)
        velocity, sense = 0.3, math.copysign(1, beam.tip[0])
        deck = cards + "DRIVE arm\nSPEED 4\nREPORT transient turns=0.04 instants=200 accuracy=1e-4 perturb=1,"
        unit = [sense / abs(beam.tip[0])] + zero[1:]
        check(f"velocities of a mode, {parts}", deck + f"0,{velocity}\n", lambda t, side: (4.0, 0.0), zero, [velocity * x for x in unit])
        check(f"shape and velocities, {parts}", deck + f"0.001,{-velocity}\n", lambda t, side: (4.0, 0.0), [0.001 * x for x in unit],
              [-velocity * x for x in unit])


if __name__ == "__main__":
    main()
