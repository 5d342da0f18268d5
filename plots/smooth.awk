# A curve through samples, from standard input: lines of a block, t and one or more values; a line that is no number, and another block, break it.
# The answer has t and the values, with seven points put between each two where the curve is smooth, and an empty line where it is broken.
# Between two samples it is smooth where the polynomials through the nearest four and the nearest six samples meet half way, and
# do so in the two intervals beside it: a jump, a corner, and waves too short for their samples stay straight lines. Steps are even
# within a part, but that its last one may be shorter.

$2 + 0 != $2 || NF < 3 { draw(); next }
n && ($1 != block || n > 1 && !even()) {
    same_block = $1 == block
    draw(same_block)
}
{
    block = $1
    n++
    for (i = 2; i <= NF; i++) sample[i, n] = $i + 0
    columns = NF
}
END { draw() }

function even(    step) {
    step = sample[2, 2] - sample[2, 1]
    return absolute($2 - sample[2, n] - step) <= 1e-6 * absolute(step)
}

# on: the next sample goes on from the last one, with another step.
function draw(on,    j, k, m, i, t) {
    for (i = 3; i <= columns; i++) {
        low = high = sample[i, 1]
        for (j = 2; j <= n; j++) {
            if (sample[i, j] < low) low = sample[i, j]
            if (sample[i, j] > high) high = sample[i, j]
        }
        range[i] = high - low
    }
    for (j = 1; j < n; j++) meets[j] = n >= 6 && halves_meet(j)
    meets[0] = meets[1]
    meets[n] = meets[n - 1]
    for (j = 1; j <= n - on; j++) {
        m = j < n && meets[j - 1] && meets[j] && meets[j + 1] ? 8 : 1
        for (k = 0; k < m; k++) {
            t = j + k / m
            line = sprintf("%.10g", sample[2, j] + (k ? k / m * (sample[2, j + 1] - sample[2, j]) : 0))
            for (i = 3; i <= columns; i++) line = line sprintf(" %.10g", k ? between(i, t, 6) : sample[i, j])
            print line
        }
    }
    if (on) {
        for (i = 2; i <= columns; i++) sample[i, 1] = sample[i, n]
        n = 1
    } else {
        if (n) print ""
        n = 0
    }
}

function halves_meet(j,    i) {
    for (i = 3; i <= columns; i++)
        if (absolute(between(i, j + 0.5, 4) - between(i, j + 0.5, 6)) > 0.015 * range[i]) return 0
    return 1
}

# By Lagrange, of the samples nearest to place t.
function between(i, t, count,    first, a, b, term, sum) {
    first = int(t) - count / 2 + 1
    if (first > n - count + 1) first = n - count + 1
    if (first < 1) first = 1
    for (a = first; a < first + count; a++) {
        term = sample[i, a]
        for (b = first; b < first + count; b++) if (b != a) term *= (t - b) / (a - b)
        sum += term
    }
    return sum
}

function absolute(a) { return a < 0 ? -a : a }
