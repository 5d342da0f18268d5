"""Multipliers of a slider-crank with an elastic rod, independent of the program that is tested.

The crank is rigid and turns at constant speed, the rod is an inextensible Euler beam, pinned at both ends, the piston a mass on a
guide through the crank's centre.  The deflection is a sum of sines; the rod's shortening, half the integral of w'^2, is of second
order and brings the axial force in: the virtual work of the inertia of the rigid motion along it (d'Alembert).  What is left is
Hill's equation y'' + (A0/W^2 + A1(theta)) y = 0 in the crank angle, solved by Numerov's method (fourth order).

After R. Badlani and W. Kleinhenz, ASME J. Mech. Design 101 (1979) 149; Z. Zhu and Y. Chen, J. Mech. Trans. Autom. Design 105
(1983) 637; D. Beale and S. Lee, J. Sound Vib. 184 (1995), who have one mode and approximate axial forces.
"""
import cmath
import math

STEPS = 256     # of a turn; as many are solved as long as vibrations are slower than twelve a turn


def gauss(n):
    """Nodes and weights of Gauss's rule on 0 to 1."""
    nodes = []
    for k in range(n):
        x = math.cos(math.pi * (k + 0.75) / (n + 0.5))
        for _ in range(50):
            p, q = 1.0, 0.0
            for j in range(n):
                p, q = ((2 * j + 1) * x * p - j * q) / (j + 1), p
            slope = n * (x * p - q) / (x * x - 1)
            x -= p / slope
        nodes.append(((1 - x) / 2, 1 / ((1 - x * x) * slope**2)))
    return nodes


class Rod:
    """Crank r, rod L, mass of the rod per length mu, bending stiffness EI, piston m; SI units."""

    def __init__(self, r, length, mu, bending, piston, modes=3, steps=STEPS):
        self.modes, self.steps = modes, steps
        self.own = [bending / mu * (k * math.pi / length) ** 4 for k in range(1, modes + 1)]
        nodes = [(s * length, w * length) for s, w in gauss(12)]
        slopes = [[k * math.pi / length * math.cos(k * math.pi * s / length) for s, _ in nodes] for k in range(1, modes + 1)]
        self.geometric = []
        for step in range(steps):
            theta = 2 * math.pi * step / steps
            sine = -r * math.sin(theta) / length
            cosine = math.sqrt(1 - sine * sine)
            rate = -r * math.cos(theta) / (length * cosine)                             # of phi, at unit speed
            second = (r * math.sin(theta) / length + sine * rate**2) / cosine
            crank = (-r * math.cos(theta), -r * math.sin(theta))                        # acceleration of A
            along = crank[0] * cosine + crank[1] * sine
            across = -crank[0] * sine + crank[1] * cosine
            piston_acceleration = crank[0] - length * (cosine * rate**2 + sine * second)
            turning = mu * (across * length**2 / 2 + second * length**3 / 3)
            at_end = -sine / cosine / length * turning + piston * piston_acceleration / cosine
            compression = [at_end + mu * (along * (length - s) - rate**2 * (length**2 - s**2) / 2) for s, _ in nodes]
            matrix = [[-sum(w * c * p * q for (_, w), c, p, q in zip(nodes, compression, slopes[i], slopes[j])) * 2 / (mu * length)
                       - (rate**2 if i == j else 0.0) for j in range(modes)] for i in range(modes)]
            self.geometric.append(matrix)

    def monodromy(self, speed):
        """The columns of (y, y of the next step) after a turn, from unit columns: a matrix with the multipliers of a turn."""
        n, h = self.modes, 2 * math.pi / self.steps
        c = h * h / 12
        stiffness = [[[(self.own[i] / speed**2 if i == j else 0.0) + m[i][j] for j in range(n)] for i in range(n)]
                     for m in self.geometric]
        # w = (1 + c A) y: w'' difference = -h^2 A y
        left = [[[(1.0 if i == j else 0.0) + c * a[i][j] for j in range(n)] for i in range(n)] for a in stiffness]
        solved = [inverse(m) for m in left]
        # h^2 A y = 12 (left - 1) y = 12 (w - y)
        columns = []
        for start in range(2 * n):
            before = [1.0 if i == start else 0.0 for i in range(n)]
            now = [1.0 if n + i == start else 0.0 for i in range(n)]
            for k in range(1, self.steps + 1):
                m = solved[k % self.steps]
                y = [sum(m[i][j] * now[j] for j in range(n)) for i in range(n)]
                before, now = now, [2 * now[i] - before[i] - 12 * (now[i] - y[i]) for i in range(n)]
            columns.append(before + now)
        return [[columns[j][i] for j in range(2 * n)] for i in range(2 * n)]

    def growth(self, speed):
        """The largest growth of any vibration in a turn."""
        return max(0.0, math.log(max(abs(z) for z in multipliers(self.monodromy(speed)))))


def inverse(a):
    """By Gauss and Jordan's elimination."""
    n = len(a)
    rows = [list(row) + [1.0 if i == j else 0.0 for j in range(n)] for i, row in enumerate(a)]
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[p] = rows[p], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k and rows[i][k]:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def multipliers(matrix):
    """Those of a matrix whose eigenvalues are in pairs z, 1/z: roots of a polynomial in s = z + 1/z, smooth where pairs meet."""
    n = len(matrix) // 2
    # Faddeev and Le Verrier: coefficients of the characteristic polynomial.
    coefficients, power = [1.0], [row[:] for row in matrix]
    size = 2 * n
    for k in range(1, n + 1):
        coefficients.append(-sum(power[i][i] for i in range(size)) / k)
        for i in range(size):
            power[i][i] += coefficients[-1]
        power = [[sum(matrix[i][m] * power[m][j] for m in range(size)) for j in range(size)] for i in range(size)]
    # z^n + z^-n in powers of s.
    chebyshev = [[2.0], [0.0, 1.0]]
    for k in range(2, n + 1):
        raised = [0.0] + chebyshev[-1]
        chebyshev.append([x - (chebyshev[-2][i] if i < len(chebyshev[-2]) else 0.0) for i, x in enumerate(raised)])
    polynomial = [0.0] * (n + 1)
    for k in range(n + 1):
        for i, x in enumerate(chebyshev[n - k] if k < n else [1.0]):
            polynomial[i] += coefficients[k] * x
    found = []
    for s in roots(polynomial):
        root = cmath.sqrt(s * s / 4 - 1)
        found += [s / 2 + root, s / 2 - root]
    return found


def roots(polynomial):
    """All roots of a polynomial with ascending coefficients, the last of them 1 (Weierstrass)."""
    n = len(polynomial) - 1
    radius = 1 + max(abs(x) for x in polynomial[:-1])
    found = [min(radius, 4.0) * (0.4 + 0.9j) ** k for k in range(n)]
    for _ in range(500):
        change = 0.0
        for i in range(n):
            value, apart = 0j, 1 + 0j
            for x in reversed(polynomial):
                value = value * found[i] + x
            for j in range(n):
                if j != i:
                    apart *= found[i] - found[j]
            step = value / apart if apart else 1e-8
            found[i] -= step
            change = max(change, abs(step) / (1 + abs(found[i])))
        if change < 1e-14:
            break
    return found
