# A linkage as it swings in modes, as rows of geometry.dat: every position at rest, then displaced in its modes, with the number of the pose in
# the place of the crank.
#   awk -v folder=FOLDER -v speed=S -v modes=M,… -v cranks=C,… -v size=L -v parts="P …" -f mode_places.awk geometry.dat shape_pins.dat shapes.dat
# size is the largest displacement drawn; every mode is drawn at these parts of its swing.
# Behind them two poses are for the guides of a position alone, whose blocks are on either side by that size. Files:
#   FOLDER/modes    gnuplot assignments: of every mode, in the order of the table, rest_pose[k] and mode_pose[k], the pose at rest and
#                   the first displaced one; joints and arms, their numbers in a pose; helds, that of joints and blocks which drives hold, block_held[k] of
#                   every slider; and the block $clamps, a line a mode: x, y and direction in degrees of every link that is clamped to the ground
#   FOLDER/joints   an index a pose: x, y, and 1 for a pin, 2 for one that a drive holds
#   FOLDER/arms     an index a pose: lines from the axis of a link to pins beside it
# A ground pin where a link is clamped is none of the rows: no pivot is drawn there.

BEGIN {
    n_parts = split(parts, part, " ")
    n_cranks = split(cranks, wanted_crank, ",")
    printf "" > (folder "/joints")
    printf "" > (folder "/arms")
}

FILENAME ~ /geometry\.dat$/ {
    if (/^#/ || NF == 0) next
    if (!positions || $1 "" != text_of[positions]) { text_of[++positions] = $1 ""; crank_of[positions] = $1 + 0 }
    k = ++rows[positions]
    x0[positions, k] = $5 + 0; y0[positions, k] = $6 + 0
    if (positions > 1) next
    link[k] = $2 ""; what[k] = $3; place[k] = $4 ""
    if ($3 == "slider") { slider[++sliders] = $4; on[sliders] = $2; is_block[$4, $2] = 1 }
    if ($3 == "spring" || $3 == "damper") is_joint[$4] = 1
    if ($3 == "pin" && $2 != "(ground)") is_link[$2] = 1
    next
}

# Names of columns stand above their units, the last line of the head but one.
/^#/ { for (i = 2; i <= NF; i++) if ($i == "ux") for (k = 2; k <= NF; k++) at[$k] = k - 1; next }
NF == 0 || !same($at["speed"], speed) || index("," modes ",", "," ($at["mode"] + 0) ",") == 0 || !is_wanted($at["crank"]) { next }
{ key = $at["mode"] " " $at["crank"] }

FILENAME ~ /shape_pins\.dat$/ {
    p = $at["pin"] ""
    name = $at["link"] ""
    u[key, p] = $at["ux"] + 0; v[key, p] = $at["uy"] + 0; turn[key, p, name] = $at["rotation"] + 0
    if ($at["joint"] == "pinned") is_joint[p] = 1
    if ($at["joint"] == "clamped" && !(p in clamped)) { clamped[p] = name; clamp_at[++clamps] = p }
    if ($at["joint"] == "driven" && (p, name) in is_block) held_block[p, name] = 1
    else if ($at["joint"] == "driven") is_joint[p] = held[p] = 1
    next
}

{
    if (key != shape) take_shape()
    shape = key
    shape_crank = $at["crank"] + 0
    n = ++stations
    on_link = $at["link"] ""
    if (!(on_link in from)) from[on_link] = n
    to[on_link] = n
    sx[n] = $at["x"] + 0; sy[n] = $at["y"] + 0; su[n] = $at["ux"] + 0; sv[n] = $at["uy"] + 0
    moved = sqrt(su[n]^2 + sv[n]^2)
    if (moved > most) most = moved
}

END {
    take_shape()
    if (n_cranks == 1 && shapes) { limits(-size); limits(size) }
    write_facts()
}

function is_wanted(crank,    i) {
    for (i = 1; i <= n_cranks; i++) if (same(crank, wanted_crank[i])) return 1
    return 0
}

# ---- Modes ----

function take_shape(    position, k, scale) {
    if (!stations) return
    for (position = 1; position <= positions; position++) if (same(crank_of[position], shape_crank)) break
    if (position <= positions) {
        if (!(position in rest)) rest[position] = draw(position, 0)
        rest_of[++shapes] = rest[position]
        scale = most > 0 ? size / most : 0
        for (k = 1; k <= n_parts; k++) {
            if (k == 1) mode_of[shapes] = poses + 1
            draw(position, part[k] * scale)
        }
        clamp_line[shapes] = clamps_of(position)
    }
    stations = most = 0
    split("", from)
    split("", to)
}

# ---- Poses ----

function draw(position, scale,    k, x, y) {
    poses++
    if (poses > 1) { printf "\n\n" > (folder "/joints"); printf "\n\n" > (folder "/arms") }
    split("", is_marked)
    joints = arms = 0
    for (k = 1; k <= rows[position]; k++) {
        x = x0[position, k] + scale * u[shape, place[k]]
        y = y0[position, k] + scale * v[shape, place[k]]
        if (what[k] == "ahead") {
            x -= scale * turn[shape, place[k], link[k]] * (y0[position, k] - y0[position, k - 1])
            y += scale * turn[shape, place[k], link[k]] * (x0[position, k] - x0[position, k - 1])
        }
        row(k, x, y)
        if (what[k] == "ahead" || what[k] == "side") continue
        if (place[k] in is_joint && !is_marked[place[k]]++) {
            joints++
            printf "%.9g %.9g %d\n", x, y, place[k] in held ? 2 : 1 > (folder "/joints")
        }
        if ((what[k] == "pin" || what[k] == "point" && place[k] in is_joint) && is_beside(link[k], x0[position, k], y0[position, k])) {
            arm(x, y, from[link[k]], scale)
            arm(x, y, to[link[k]], scale)
        }
    }
    return poses
}

function row(k, x, y) {
    if (link[k] == "(ground)" && place[k] in clamped) return
    print poses, link[k], what[k], place[k], sprintf("%.12g %.12g", x, y)
}

function is_beside(name, x, y,    i, dx, dy, t, away, least) {
    least = -1
    for (i = from[name]; name in to && i < to[name]; i++) {
        dx = sx[i + 1] - sx[i]; dy = sy[i + 1] - sy[i]
        if (dx * dx + dy * dy < (1e-9 * size)^2) continue
        t = ((x - sx[i]) * dx + (y - sy[i]) * dy) / (dx * dx + dy * dy)
        t = t < 0 ? 0 : t > 1 ? 1 : t
        away = (x - sx[i] - t * dx)^2 + (y - sy[i] - t * dy)^2
        if (least < 0 || away < least) least = away
    }
    return least > (1e-6 * size)^2
}

function arm(x, y, i, scale) {
    arms++
    printf "%.9g %.9g\n%.9g %.9g\n\n", x, y, sx[i] + scale * su[i], sy[i] + scale * sv[i] > (folder "/arms")
}

# Blocks on guides, farther along them.
function limits(shift,    k, there, way) {
    poses++
    for (k = 1; k <= rows[1]; k++) {
        there = link[k] in is_link ? 0 : what[k] == "slider" ? k + 1 : what[k] == "ahead" ? k : 0
        way = there ? sqrt((x0[1, there] - x0[1, there - 1])^2 + (y0[1, there] - y0[1, there - 1])^2) : 1
        row(k, x0[1, k] + (there ? shift * (x0[1, there] - x0[1, there - 1]) / way : 0), \
            y0[1, k] + (there ? shift * (y0[1, there] - y0[1, there - 1]) / way : 0))
    }
}

# A wall is at a right angle to the way into its link, at a corner to that between both parts.
function clamps_of(position,    n, i, k, p, text) {
    for (n = 1; n <= clamps; n++) {
        p = clamp_at[n]
        for (k = 1; place[k] != p; k++) { }
        ways_x = ways_y = last_x = 0
        last_y = 1
        for (i = from[clamped[p]]; i <= to[clamped[p]] && clamped[p] in from; i++) {
            if (sqrt((sx[i] - x0[position, k])^2 + (sy[i] - y0[position, k])^2) > 1e-9 * size) continue
            if (i > from[clamped[p]]) toward(i, i - 1)
            if (i < to[clamped[p]]) toward(i, i + 1)
        }
        if (ways_x^2 + ways_y^2 < 0.01) { ways_x = -last_y; ways_y = last_x }
        text = text sprintf(" %.9g %.9g %.9g", x0[position, k], y0[position, k], atan2(ways_y, ways_x) * 180 / atan2(0, -1))
    }
    return text
}

function toward(i, k,    long) {
    long = sqrt((sx[k] - sx[i])^2 + (sy[k] - sy[i])^2)
    if (long < 1e-9 * size) return
    last_x = (sx[k] - sx[i]) / long
    last_y = (sy[k] - sy[i]) / long
    ways_x += last_x
    ways_y += last_y
}

function write_facts(    file, k, helds) {
    file = folder "/modes"
    for (k in held) helds++
    for (k = 1; k <= sliders; k++) helds += (slider[k], on[k]) in held_block
    printf "joints = %d; arms = %d; clamps = %d; helds = %d; array block_held[%d]; array rest_pose[%d]; array mode_pose[%d]\n", \
        joints, arms, clamps, helds, sliders + 1, shapes + 1, shapes + 1 > file
    for (k = 1; k <= sliders; k++) printf "block_held[%d] = %d\n", k, (slider[k], on[k]) in held_block > file
    for (k = 1; k <= shapes; k++) printf "rest_pose[%d] = %d; mode_pose[%d] = %d\n", k, rest_of[k], k, mode_of[k] > file
    print "$clamps << EOD" > file
    for (k = 1; k <= shapes; k++) print (clamps ? substr(clamp_line[k], 2) : "-") > file
    print "EOD" > file
    close(file)
}

function same(a, b) { return (a - b)^2 <= 1e-18 * (1 + b * b) }
