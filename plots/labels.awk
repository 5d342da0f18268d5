# Finds places for labels, so that they keep clear of curves, of each other and of the edges. All lengths are pixels; a line is
#   page LEFT RIGHT LOW HIGH              where labels may be
#   curve X Y                             a curve goes on to this point, from the one before; a line `curve` begins another
#   box X Y WIDTH HEIGHT                  taken: a box about this point
#   spoke X Y RADIUS WIDTH HEIGHT TEXT    the label of a ring: all rings have theirs on one spoke, where least is in their way
#   label X Y DISTANCE WIDTH HEIGHT DIRECTION TEXT      a label near this point, rather in that direction, in degrees
# The answer has a line a label: x, y, the point that it belongs to, 1 if a line should lead there, TEXT, and where that line begins. A label that finds no
# place is left out. With datablock=name it is a gnuplot datablock of that name.

BEGIN { turn = 8 * atan2(1, 1) }

$1 == "page" { left = $2; right = $3; low = $4; high = $5 }

$1 == "curve" && NF == 1 { begun = 0 }

# A curve is kept as points four pixels apart.
$1 == "curve" && NF > 1 {
    steps = begun ? int(sqrt(($2 - x)^2 + ($3 - y)^2) / 4) + 1 : 1
    for (i = 1; i <= steps; i++) { n_points++; point_x[n_points] = begun ? x + (($2 - x) * i) / steps : $2; \
        point_y[n_points] = begun ? y + (($3 - y) * i) / steps : $3 }
    x = $2; y = $3; begun = 1
}

$1 == "box" { take($2, $3, $4, $5) }

$1 == "spoke" { spokes++; ring_x[spokes] = $2; ring_y[spokes] = $3; radius[spokes] = $4; ring_width[spokes] = $5; \
    ring_height[spokes] = $6; ring_text[spokes] = rest(7) }

$1 == "label" { labels++; at_x[labels] = $2; at_y[labels] = $3; distance[labels] = $4; width[labels] = $5; \
    height[labels] = $6; lean[labels] = $7 * turn / 360; text[labels] = rest(8) }

END {
    if (datablock) print "$" datablock " << EOD"
    if (spokes) place_spokes()
    for (k = 1; k <= labels; k++) place_label(k)
    if (datablock) print "EOD"
}

function place_spokes(    k, i, angle, cost, best, best_angle) {
    for (i = 0; i < 12; i++) {
        angle = (i + 1.5) * turn / 12
        cost = 0
        for (k = 1; k <= spokes; k++) cost += cost_of(ring_x[k] + radius[k] * cos(angle), ring_y[k] + radius[k] * sin(angle), \
            ring_width[k] + 8, ring_height[k] + 4)
        if (i == 0 || cost < best) { best = cost; best_angle = angle }
    }
    for (k = 1; k <= spokes; k++) {
        x = ring_x[k] + radius[k] * cos(best_angle)
        y = ring_y[k] + radius[k] * sin(best_angle)
        take(x, y, ring_width[k], ring_height[k])
        answer(x, y, x, y, 0, ring_text[k])
    }
}

# Near first; farther off a line leads to it.
function place_label(k,    far, i, angle, x, y, cost, best, best_x, best_y, best_far) {
    best = 1e9
    for (far = 0; far < 6 && best > 40; far++) {
        for (i = 0; i < 24; i++) {
            angle = i * turn / 24
            x = at_x[k] + cos(angle) * (distance[k] * (1 + 0.8 * far) + width[k] / 2)
            y = at_y[k] + sin(angle) * (distance[k] * (1 + 0.8 * far) + height[k] / 2)
            cost = cost_of(x, y, width[k] + 14, height[k] + 2) + 12 * far - 4 * cos(angle - lean[k])
            if (cost < best) { best = cost; best_x = x; best_y = y; best_far = far }
        }
    }
    if (best >= 1000) return
    take(best_x, best_y, width[k], height[k])
    answer(best_x, best_y, at_x[k], at_y[k], best_far > 1 || nearer_to_another(k, best_x, best_y), text[k], width[k], height[k])
}

# Another point that has a label is nearer than its own.
function nearer_to_another(k, x, y,    m) {
    for (m = 1; m <= labels; m++)
        if ((at_x[m] - x)^2 + (at_y[m] - y)^2 < 0.9 * ((at_x[k] - x)^2 + (at_y[k] - y)^2)) return 1
    return 0
}

# 1000 for every box in the way and for the edges of the page, 10 for every point of a curve.
function cost_of(x, y, w, h,    k, cost) {
    cost = 0
    if (x - w / 2 < left || x + w / 2 > right || y - h / 2 < low || y + h / 2 > high) cost += 1000
    for (k = 1; k <= boxes; k++)
        if (absolute(x - box_x[k]) < (w + box_width[k]) / 2 && absolute(y - box_y[k]) < (h + box_height[k]) / 2) cost += 1000
    for (k = 1; k <= n_points; k++)
        if (absolute(x - point_x[k]) < w / 2 && absolute(y - point_y[k]) < h / 2) cost += 10
    return cost
}

function take(x, y, w, h) { boxes++; box_x[boxes] = x; box_y[boxes] = y; box_width[boxes] = w; box_height[boxes] = h }

function answer(x, y, to_x, to_y, led, text, w, h) {
    printf "%.6g %.6g %.6g %.6g %d \"%s\" %.6g %.6g\n", x, y, to_x, to_y, led, text, \
        x + within(to_x - x, w / 2), y + within(to_y - y, h / 2)
}

function within(a, reach) { return a > reach ? reach : a < -reach ? -reach : a }

function rest(first,    k, line) {
    for (k = first; k <= NF; k++) line = line (k > first ? " " : "") $k
    return line
}

function absolute(a) { return a < 0 ? -a : a }
