"""Dense linear equations in any kind of numbers: LU with partial pivoting, transposed solution, an estimate of the condition."""


class Singular(Exception):
    """A pivot is zero."""


def factor(matrix):
    """LU of a square matrix (a list of rows, kept): (rows, order of the rows)."""
    rows = [list(row) for row in matrix]
    count = len(rows)
    order = list(range(count))
    for k in range(count):
        best = max(range(k, count), key=lambda i: abs(rows[i][k]))
        if rows[best][k] == 0:
            raise Singular(f"column {k}")
        rows[k], rows[best] = rows[best], rows[k]
        order[k], order[best] = order[best], order[k]
        pivot = rows[k]
        filled = [j for j in range(k + 1, count) if pivot[j] != 0]
        for i in range(k + 1, count):
            row = rows[i]
            if row[k] != 0:
                row[k] = multiple = row[k] / pivot[k]
                for j in filled:
                    row[j] -= multiple * pivot[j]
    return rows, order


def solve(factors, right):
    """x with A x = right."""
    rows, order = factors
    count = len(rows)
    x = [right[i] for i in order]
    for i in range(count):
        row = rows[i]
        x[i] -= sum(row[j] * x[j] for j in range(i) if row[j] != 0)
    for i in reversed(range(count)):
        row = rows[i]
        x[i] = (x[i] - sum(row[j] * x[j] for j in range(i + 1, count) if row[j] != 0)) / row[i]
    return x


def solve_transposed(factors, right):
    """x with A^T x = right."""
    rows, order = factors
    count = len(rows)
    x = list(right)
    for i in range(count):
        x[i] /= rows[i][i]
        for j in range(i + 1, count):
            if rows[i][j] != 0:
                x[j] -= rows[i][j] * x[i]
    for i in reversed(range(count)):
        for j in range(i):
            if rows[i][j] != 0:
                x[j] -= rows[i][j] * x[i]
    result = [None] * count
    for place, row in enumerate(order):
        result[row] = x[place]
    return result


def condition(matrix):
    """An estimate (from below) of the condition in the 1-norm, after Hager; infinite for a singular matrix."""
    count = len(matrix)
    norm = max(sum(abs(row[j]) for row in matrix) for j in range(count))
    try:
        factors = factor(matrix)
    except Singular:
        return float("inf")
    x = [1.0 / count] * count
    largest = 0.0
    for _ in range(5):
        y = solve(factors, x)
        size = sum(abs(value) for value in y)
        if size <= largest:
            break
        largest = size
        z = solve_transposed(factors, [1.0 if value >= 0 else -1.0 for value in y])
        j = max(range(count), key=lambda k: abs(z[k]))
        if abs(z[j]) <= sum(z[k] * x[k] for k in range(count)):
            break
        x = [0.0] * count
        x[j] = 1.0
    return norm * largest
