"""Bodies that joints and drivers hold together are put in place: files without a drawing say only what fits.

Places are complex numbers, z + exp(i θ) p for the point p of a body. Residuals are made small by the method of Levenberg and
Marquardt, from one start after another until one of them comes down.
"""

import cmath
import random
from dataclasses import dataclass

STARTS = 60
STEPS = 200
CLOSED = 1e-13


@dataclass
class Joint:
    kind: str           # pin, weld, line or angle
    one: str
    other: str
    point: complex = 0  # of each, in the body's own axes
    other_point: complex = 0
    axis: complex = 1   # of a line, in the axes of the first
    angle: float = 0.0  # of the other less that of the first


def assemble(bodies, fixed, joints):
    """body -> (place, angle) of all bodies, or None where they do not fit together."""
    movable = [body for body in bodies if body != fixed]
    size = max([abs(point) for joint in joints for point in (joint.point, joint.other_point)] + [1e-9])
    chance = random.Random(1)
    for start in range(STARTS):
        turn = (lambda: 0.0) if start == 0 else (lambda: chance.uniform(-3.1416, 3.1416))
        shift = (lambda: 0.0) if start == 0 else (lambda: chance.uniform(-size, size))
        unknowns = [value for _ in movable for value in (shift()/size, shift()/size, turn())]
        found = _come_down(unknowns, movable, fixed, joints, size)
        if found:
            return _places(found, movable, fixed, size)
    return None


def _places(unknowns, movable, fixed, size):
    places = {fixed: (0j, 0.0)}
    for index, body in enumerate(movable):
        x, y, angle = unknowns[3*index:3*index + 3]
        places[body] = (complex(x, y)*size, angle)
    return places


def _come_down(unknowns, movable, fixed, joints, size):
    columns = {body: 3*index for index, body in enumerate(movable)}
    damping = 1e-3
    rows = _rows(unknowns, columns, fixed, joints, size)
    error = sum(value**2 for value, _ in rows)
    for _ in range(STEPS):
        if error < CLOSED**2*len(rows):
            return unknowns
        step = _step(rows, len(unknowns), damping)
        tried = [value - change for value, change in zip(unknowns, step)]
        tried_rows = _rows(tried, columns, fixed, joints, size)
        tried_error = sum(value**2 for value, _ in tried_rows)
        if tried_error < error:
            unknowns, rows, error, damping = tried, tried_rows, tried_error, max(damping/10, 1e-15)
        else:
            damping *= 10
            if damping > 1e10:
                break
    # Round-off may hold it a little above.
    return unknowns if error < (100*CLOSED)**2*len(rows) else None


def _rows(unknowns, columns, fixed, joints, size):
    """Residuals, each with its derivatives: column -> value."""
    places = _places(unknowns, list(columns), fixed, size)
    rows = []
    for joint in joints:
        (z1, angle1), (z2, angle2) = places[joint.one], places[joint.other]
        u1, u2 = cmath.exp(1j*angle1), cmath.exp(1j*angle2)
        arm1, arm2 = u1*joint.point, u2*joint.other_point
        gap = z2 + arm2 - z1 - arm1

        def row(value, by1, by2, turn1, turn2):
            terms = {}
            for body, by, turn in ((joint.one, by1, turn1), (joint.other, by2, turn2)):
                if body in columns:
                    for offset, derivative in enumerate((by.real*size, by.imag*size, turn)):
                        column = columns[body] + offset
                        terms[column] = terms.get(column, 0.0) + derivative
            rows.append((value, terms))

        if joint.kind in ("pin", "weld"):
            for way in (1, 1j):
                row(_dot(way, gap)/size, -way/size, way/size, -_dot(way, 1j*arm1)/size, _dot(way, 1j*arm2)/size)
        if joint.kind == "line":
            normal = 1j*u1*joint.axis/abs(joint.axis)
            row(_dot(normal, gap)/size, -normal/size, normal/size,
                (_dot(1j*normal, gap) - _dot(normal, 1j*arm1))/size, _dot(normal, 1j*arm2)/size)
        if joint.kind in ("weld", "line", "angle"):
            row(angle2 - angle1 - joint.angle, 0j, 0j, -1.0, 1.0)
    return rows


def _dot(one, other):
    return (complex(one).conjugate()*other).real


def _step(rows, count, damping):
    """(JᵀJ + damping) step = Jᵀ residual, by elimination with pivots."""
    matrix = [[0.0]*(count + 1) for _ in range(count)]
    for value, terms in rows:
        for one, first in terms.items():
            matrix[one][count] += first*value
            for other, second in terms.items():
                matrix[one][other] += first*second
    for index in range(count):
        matrix[index][index] += damping
    for index in range(count):
        pivot = max(range(index, count), key=lambda line: abs(matrix[line][index]))
        matrix[index], matrix[pivot] = matrix[pivot], matrix[index]
        for line in range(index + 1, count):
            factor = matrix[line][index]/matrix[index][index]
            if factor:
                for column in range(index, count + 1):
                    matrix[line][column] -= factor*matrix[index][column]
    step = [0.0]*count
    for index in reversed(range(count)):
        rest = sum(matrix[index][column]*step[column] for column in range(index + 1, count))
        step[index] = (matrix[index][count] - rest)/matrix[index][index]
    return step
