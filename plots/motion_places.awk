# Rows of geometry.dat for instants of a motion, with the time in place of the crank.
#   awk -v stride=N -v count=M -f motion_places.awk geometry.dat motion_pins.dat
# geometry.dat has one position. At the first instant of motion_pins.dat and every N, M in all: pins are where this table has them;
# points, and the direction of sliders on links, turn with the two pins of their link that are farthest apart.

/^#/ || NF == 0 { next }

FNR == NR {
    parts++
    link[parts] = $2; part[parts] = $3; place[parts] = $4
    x0[parts] = $5 + 0; y0[parts] = $6 + 0
    if ($3 != "ahead") { at_x[$4] = first_x[$4] = x0[parts]; at_y[$4] = first_y[$4] = y0[parts] }
    if ($3 == "pin" && $2 != "(ground)") pin[$2, ++pins[$2]] = $4
    next
}

$1 "" != time "" { draw(); time = $1; instant++ }

{ at_x[$2] = $3 + 0; at_y[$2] = $4 + 0; moves[$2] = 1 }

END { draw() }

function draw(    k) {
    if (!instant || (instant - 1) % stride || drawn >= count) return
    drawn++
    for (k = 1; k <= parts; k++) {
        if (part[k] == "ahead") {
            turn(link[k], x0[k] - first_x[place[k]], y0[k] - first_y[place[k]])
            row(k, at_x[place[k]] + turned_x, at_y[place[k]] + turned_y)
        } else {
            if (part[k] == "point" && !(place[k] in moves)) {
                turn(link[k], x0[k] - first_x[pin[link[k], 1]], y0[k] - first_y[pin[link[k], 1]])
                at_x[place[k]] = at_x[pin[link[k], 1]] + turned_x
                at_y[place[k]] = at_y[pin[link[k], 1]] + turned_y
            }
            row(k, at_x[place[k]], at_y[place[k]])
        }
    }
}

function row(k, x, y) { print time, link[k], part[k], place[k], sprintf("%.17g %.17g", x, y) }

# A vector that turns with a link; on a guide it stays.
function turn(name, x, y,    a, b, c, s, size) {
    turned_x = x; turned_y = y
    if (!pins[name]) return
    find_far(name)
    a = pin[name, 1]; b = pin[name, far[name]]
    c = cosine(first_x[b] - first_x[a], first_y[b] - first_y[a], at_x[b] - at_x[a], at_y[b] - at_y[a])
    s = cosine(first_x[b] - first_x[a], first_y[b] - first_y[a], at_y[b] - at_y[a], at_x[a] - at_x[b])
    size = sqrt(c*c + s*s)
    if (size == 0) return
    turned_x = (c*x - s*y)/size
    turned_y = (s*x + c*y)/size
}

function cosine(ax, ay, bx, by) { return ax*bx + ay*by }

function find_far(name,    k, way, most) {
    if (name in far) return
    far[name] = 1
    for (k = 2; k <= pins[name]; k++) {
        way = (first_x[pin[name, k]] - first_x[pin[name, 1]])^2 + (first_y[pin[name, k]] - first_y[pin[name, 1]])^2
        if (way > most) { most = way; far[name] = k }
    }
}
