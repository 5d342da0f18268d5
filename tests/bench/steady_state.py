"""The periodic elastic motion by integrators of SciPy, for `make bench`.

    steady_state.py METHOD MATRICES SHAPES MOTION SAMPLES SPEED

MATRICES: samples over the turn of M, D, B, F of `M y'' + D y' + B y = F` (tests/bench/whole_turn.f90). SHAPES: of the slow
coordinates (samples, unknowns, number). METHOD: radau or lsoda, all unknowns, from the quasi-static motion turn after turn until it
repeats itself to 1e-6; bvp, solve_bvp on the slow coordinates, the rest following quasi-statically.
MOTION gets seconds by the clock and of the processor, turns, steps, then y at SAMPLES crank angles, all as doubles.
"""
import sys
import time

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp

REPEATS_TO = 1e-6       # change over a turn, relative
MOST_TURNS = 40
FINE = 1024             # samples between which is interpolated
POINTS = 8              # of the interpolating polynomial


def resampled(samples, number):
    """Trigonometric interpolation along the first axis."""
    before = samples.shape[0]
    c = np.fft.rfft(samples, axis=0)
    out = np.zeros((number // 2 + 1,) + c.shape[1:], complex)
    kept = min(before, number) // 2
    out[:kept] = c[:kept]
    return np.fft.irfft(out, number, axis=0) * (number / before)


def derivative(samples):
    n = samples.shape[0]
    wave = 1j * np.arange(n // 2 + 1)
    wave[n // 2] = 0
    return np.fft.irfft(np.fft.rfft(samples, axis=0) * wave.reshape((-1,) + (1,) * (samples.ndim - 1)), n, axis=0)


class Interpolated:
    """A periodic function by a polynomial through the POINTS nearest samples."""

    def __init__(self, samples):
        n = samples.shape[0]
        self.n, self.shape = n, samples.shape[1:]
        flat = samples.reshape(n, -1)
        self.table = np.concatenate([flat[n - POINTS:], flat, flat[:POINTS]])
        nodes = np.arange(POINTS)
        self.nodes = nodes
        self.weight = np.array([1 / np.prod([a - b for b in nodes if b != a]) for a in nodes])

    def __call__(self, theta):
        x = theta / (2 * np.pi) % 1.0 * self.n
        first = int(x) - POINTS // 2 + 1
        distance = x - first - self.nodes
        if np.any(distance == 0):
            return self.table[first + POINTS + int(np.argmin(abs(distance)))].reshape(self.shape)
        share = self.weight / distance
        return ((share / share.sum()) @ self.table[first + POINTS:first + 2 * POINTS]).reshape(self.shape)


def first_order(mass, velocity, position, load):
    """`M y'' + D y' + B y = F` as rates of (y, y'): lower half of the matrix, with the load as last column."""
    return np.linalg.solve(mass, np.concatenate([-position, -velocity, load[:, :, None]], axis=2))


def integrate(method, mass, velocity, position, load, samples):
    n = load.shape[1]
    lower = Interpolated(resampled(first_order(mass, velocity, position, load), FINE))
    start = np.linalg.solve(position, load[:, :, None])[:, :, 0]
    state = np.concatenate([start[0], derivative(start)[0]])
    upper = np.hstack([np.zeros((n, n)), np.eye(n)])

    def rates(theta, z):
        a = lower(theta)
        return np.concatenate([z[n:], a[:, :2 * n] @ z + a[:, 2 * n]])

    def jacobian(theta, z):
        return np.vstack([upper, lower(theta)[:, :2 * n]])

    # Absolute tolerances beside the largest of each half of the state, which the quasi-static motion estimates.
    atol = 1e-7 * np.concatenate([np.full(n, np.abs(start).max()), np.full(n, np.abs(derivative(start)).max())])
    at = 2 * np.pi * np.arange(samples) / samples
    steps = 0
    for turn in range(1, MOST_TURNS + 1):
        found = solve_ivp(rates, (0, 2 * np.pi), state, method, t_eval=np.append(at, 2 * np.pi), rtol=1e-7, atol=atol, jac=jacobian)
        if not found.success:
            sys.exit(found.message)
        steps += found.nfev
        y = found.y[:n, :-1].T
        change = np.linalg.norm(found.y[:n, -1] - state[:n]) / np.abs(y).max()
        state = found.y[:, -1]
        if change < REPEATS_TO:
            return y, turn, steps
    sys.exit("no steady state after %d turns" % MOST_TURNS)


def boundary_values(mass, velocity, position, load, shape, speed, samples):
    number = shape.shape[2]
    turned, twice = derivative(shape), derivative(derivative(shape))
    project = lambda a: np.swapaxes(shape, 1, 2) @ a
    reduced = first_order(project(mass @ shape), project(velocity @ shape + 2 * mass @ turned),
                          project(position @ shape + velocity @ turned + mass @ twice), project(load[:, :, None])[:, :, 0])
    c = np.fft.rfft(reduced, axis=0) / reduced.shape[0]
    c[1:] *= 2
    waves = np.arange(c.shape[0])

    def at_angles(theta):
        return np.einsum("tk,kij->tij", np.exp(1j * np.outer(theta, waves)), c, optimize=True).real

    def rates(theta, z):
        a = at_angles(theta)
        return np.concatenate([z[number:], np.einsum("tij,jt->it", a[:, :, :-1], z) + a[:, :, -1].T])

    def jacobian(theta, z):
        top = np.hstack([np.zeros((number, number)), np.eye(number)])
        return np.concatenate([np.repeat(top[:, :, None], theta.size, 2), np.moveaxis(at_angles(theta)[:, :, :-1], 0, 2)])

    same = np.eye(2 * number)
    mesh = np.linspace(0, 2 * np.pi, 401)
    found = solve_bvp(rates, lambda a, b: b - a, mesh, np.zeros((2 * number, mesh.size)), fun_jac=jacobian,
                      bc_jac=lambda a, b: (-same, same), tol=1e-6, max_nodes=100000)
    if not found.success:
        sys.exit(found.message)
    at = 2 * np.pi * np.arange(samples) / samples
    z = found.sol(at)[:number].T
    y = np.einsum("tij,tj->ti", resampled(shape, samples), z)
    # What is left of the equation acts on the rest as on springs of stiffness 1.
    y1 = derivative(y)
    full = [resampled(a, samples) for a in (mass, velocity, position, load)]
    rest = full[3] - np.einsum("tij,tj->ti", full[0], derivative(y1)) - np.einsum("tij,tj->ti", full[1], y1) - \
        np.einsum("tij,tj->ti", full[2], y)
    return y + speed**2 * rest, 1, found.x.size - 1


def main(method, matrices, shapes, motion, samples, speed):
    samples, speed = int(samples), float(speed)
    data = np.fromfile(matrices)
    count, n = int(data[0]), int(data[1])
    parts = np.split(data[2:], [count * n * n, 2 * count * n * n, 3 * count * n * n])
    mass, velocity, position = (np.moveaxis(p.reshape(n, n, count), (2, 1, 0), (0, 1, 2)).copy() for p in parts[:3])
    load = parts[3].reshape(n, count).T.copy()
    shape = np.fromfile(shapes)
    shape = np.moveaxis(shape.reshape(-1, n, count), (2, 1, 0), (0, 1, 2)).copy()
    wall, processor = time.perf_counter(), time.process_time()
    if method == "bvp":
        y, turns, steps = boundary_values(mass, velocity, position, load, shape, speed, samples)
    else:
        y, turns, steps = integrate({"radau": "Radau", "lsoda": "LSODA"}[method], mass, velocity, position, load, samples)
    header = [time.perf_counter() - wall, time.process_time() - processor, turns, steps]
    np.concatenate([header, y.T.ravel()]).tofile(motion)


if __name__ == "__main__":
    main(*sys.argv[1:])
