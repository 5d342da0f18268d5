# Any linkage drawn as bodies: from geometry.dat, on standard input, to files in a folder, and facts as gnuplot assignments on
# standard output.
#   awk -v folder=FOLDER -v share=0.014 -f quoted.awk -f springs.awk -f shapes.awk < geometry.dat
# share is half the width of a bar, as a share of the larger side of what the linkage sweeps; bar, in its place, that width itself. Files:
#   FOLDER/pose_1, pose_2 …   the polygons of a position; an index (two empty lines) has those of one colour, in the order in which they
#                             are drawn: layers, layer_fill[k], layer_pale[k]; bodies are the first body_layers, pins the others
#   FOLDER/skeleton_1 …       the same as lines from pin to pin, for labels that keep clear of them
#   FOLDER/paths              a position a line: the crank, then x and y of every moving pin and point
#   FOLDER/guides             rails, and behind two empty lines their hatching; nothing without guides
#   FOLDER/grounds            the triangles of ground pivots, behind two empty lines their ground and its hatching
# Facts: poses, pose_crank[k], pose_found[k], link_names, link_ink[k], grounds, ground_names, ground_x[k], ground_y[k], ground_up[k] (-1: hanging), paths,
# path_names, path_ink[k] (empty for a path of no interest), path_slides[k], those of springs.awk, the block $springs, a position a line, x_min, x_max, y_min, y_max, span, bar, ground_size.

BEGIN { pi = atan2(0, -1); wanted = 1 }

# A position that the linkage cannot take has its number, and nothing to be drawn.
/^# *failed (crank|time)=/ { sub(/^# *failed (crank|time)=/, ""); crank[++poses] = $1; next }

/^#/ || NF == 0 { next }

!(poses in is_found) || $1 != crank[poses] {
    crank[++poses] = $1
    is_found[poses] = 1
    if (!first) first = poses
}

{
    x = $5 + 0
    y = $6 + 0
    if ($3 != "ahead") {
        key = $4 SUBSEP poses
        at_x[key] = x; at_y[key] = y
        include(x, y)
    }
}

$3 == "spring" || $3 == "damper" || $3 == "side" { take_spring(poses, $2, $3, $4, x, y); next }

$3 == "pin" && $2 == "(ground)" { if (poses == first) { ground[++grounds] = $4; fixed[$4] = 1 }; next }

$3 == "pin" || $3 == "point" {
    if (poses > first) next
    if (!($2 in link_number)) { link[++links] = $2; link_number[$2] = links }
    number = link_number[$2]
    place[number, ++places[number]] = $4
    joined[$4]++
    if ($4 in fixed) pivoted[number] = 1
    if (!($4 in known) && !($4 in fixed)) { known[$4] = 1; path[++paths] = $4 }
    if ($3 == "point" && !($4 in pin_known)) is_point[$4] = 1
    if ($3 == "pin") { pin_known[$4] = 1; delete is_point[$4] }
}

$3 == "slider" {
    if (poses > first) next
    slider[++sliders] = $4
    on[sliders] = $2
    slides[$4] = 1
    if (!($4 in known) && !($4 in fixed)) { known[$4] = 1; path[++paths] = $4 }
    next
}

$3 == "ahead" {
    i = ++nth[poses]
    way = sqrt((x - at_x[$4, poses])^2 + (y - at_y[$4, poses])^2)
    cos_of[i, poses] = (x - at_x[$4, poses]) / way
    sin_of[i, poses] = (y - at_y[$4, poses]) / way
}

END {
    if (!first) exit 1
    span = x_max - x_min > y_max - y_min ? x_max - x_min : y_max - y_min
    if (!bar) bar = share * span
    block_length = 3.0 * bar
    block_height = 1.9 * bar
    rim = 0.28 * bar
    ground_size = 3.6 * bar
    for (n = 1; n <= poses; n++) numbers[n] = spring_numbers(n)
    for (n = 1; n <= poses; n++) if (n in is_found) draw_pose(n)
    draw_paths()
    draw_guides()
    draw_grounds()
    print_facts()
}

function include(x, y) {
    if (!extended++) { x_min = x_max = x; y_min = y_max = y }
    if (x < x_min) x_min = x
    if (x > x_max) x_max = x
    if (y < y_min) y_min = y
    if (y > y_max) y_max = y
}

# ---- Positions ----

function draw_pose(n,    i, k, p, file) {
    file = folder "/pose_" n
    layer = 0
    for (i = 1; i <= links; i++) {
        begin_layer(file, "#333333", "#B4B4B4")
        draw_link(file, i, n, bar + rim)
        begin_layer(file, ink_of(i), pale_of(i))
        draw_link(file, i, n, bar)
        draw_skeleton(i, n)
    }
    for (i = 1; i <= sliders; i++) {
        print "" > (folder "/skeleton_" n)
        for (k = -1; k <= 1; k++) printf "%.7g %.7g\n%.7g %.7g\n\n", \
            at_x[slider[i], n] + block_length * cos_of[i, n] - k * block_height * sin_of[i, n], \
            at_y[slider[i], n] + block_length * sin_of[i, n] + k * block_height * cos_of[i, n], \
            at_x[slider[i], n] - block_length * cos_of[i, n] - k * block_height * sin_of[i, n], \
            at_y[slider[i], n] - block_length * sin_of[i, n] + k * block_height * cos_of[i, n] > (folder "/skeleton_" n)
        begin_layer(file, "#333333", "#B4B4B4")
        draw_block(file, i, n, block_length + rim, block_height + rim)
        begin_layer(file, "#D9D9D9", "#F2F2F2")
        draw_block(file, i, n, block_length, block_height)
    }
    draw_spring_skeletons(n)
    close(folder "/skeleton_" n)
    body_layers = layer
    begin_layer(file, "#333333", "#B4B4B4")
    for (p in pin_known) disc(file, at_x[p, n], at_y[p, n], 0.75 * bar)
    for (p in slides) disc(file, at_x[p, n], at_y[p, n], 0.75 * bar)
    for (p in fixed) if (!(p in pin_known)) disc(file, at_x[p, n], at_y[p, n], 0.75 * bar)
    begin_layer(file, "#FFFFFF", "#FFFFFF")
    for (p in pin_known) disc(file, at_x[p, n], at_y[p, n], 0.45 * bar)
    for (p in slides) disc(file, at_x[p, n], at_y[p, n], 0.45 * bar)
    for (p in fixed) if (!(p in pin_known)) disc(file, at_x[p, n], at_y[p, n], 0.45 * bar)
    for (k = 1; k <= paths; k++) {
        if (!(path[k] in is_point)) continue
        begin_layer(file, "#333333", "#B4B4B4")
        disc(file, at_x[path[k], n], at_y[path[k], n], 0.75 * bar)
        begin_layer(file, path_ink(k), "#FFFFFF")
        disc(file, at_x[path[k], n], at_y[path[k], n], 0.5 * bar)
    }
    close(file)
}

function begin_layer(file, fill, pale) {
    if (layer++) printf "\n\n" > file
    layer_fill[layer] = fill
    layer_pale[layer] = pale
    polygons = 0
}

function corner(file, x, y) { printf "%.7g %.7g\n", x, y > file }

function begin_polygon(file) { if (polygons++) print "" > file }

function disc(file, x, y, r,    k) {
    begin_polygon(file)
    for (k = 0; k <= 24; k++) corner(file, x + r * cos(k * pi / 12), y + r * sin(k * pi / 12))
}

function capsule(file, x1, y1, x2, y2, r,    k, angle) {
    begin_polygon(file)
    angle = atan2(y2 - y1, x2 - x1)
    for (k = 0; k <= 12; k++) corner(file, x2 + r * cos(angle - pi / 2 + k * pi / 12), y2 + r * sin(angle - pi / 2 + k * pi / 12))
    for (k = 0; k <= 12; k++) corner(file, x1 + r * cos(angle + pi / 2 + k * pi / 12), y1 + r * sin(angle + pi / 2 + k * pi / 12))
    corner(file, x2 + r * cos(angle - pi / 2), y2 + r * sin(angle - pi / 2))
}

# The hull of the pins and points of a link, with round edges.
function draw_link(file, i, n, r,    k) {
    find_hull(i, n)
    if (hull < 2) disc(file, hull_x[1], hull_y[1], r)
    for (k = 1; k < hull + (hull > 2); k++)
        capsule(file, hull_x[k], hull_y[k], hull_x[k % hull + 1], hull_y[k % hull + 1], r)
    if (hull < 3) return
    begin_polygon(file)
    for (k = 1; k <= hull + 1; k++) corner(file, hull_x[(k - 1) % hull + 1], hull_y[(k - 1) % hull + 1])
}

# Three lines a bar: its middle and both edges.
function draw_skeleton(i, n,    k, m, x, y, way) {
    for (k = 1; k < hull + (hull > 2); k++) {
        x = hull_x[k % hull + 1] - hull_x[k]
        y = hull_y[k % hull + 1] - hull_y[k]
        way = sqrt(x * x + y * y)
        for (m = -1; m <= 1; m++) printf "%.7g %.7g\n%.7g %.7g\n\n", hull_x[k] - m * bar * y / way, hull_y[k] + m * bar * x / way, \
            hull_x[k] + x - m * bar * y / way, hull_y[k] + y + m * bar * x / way > (folder "/skeleton_" n)
    }
}

# Three lines a spring or damper, as of a bar.
function draw_spring_skeletons(n,    s, m, x, y, way) {
    for (s = 1; s <= springs; s++) {
        if (spring_turns(s)) continue
        x = end_x[n, s, 2] - end_x[n, s, 1]
        y = end_y[n, s, 2] - end_y[n, s, 1]
        way = sqrt(x * x + y * y)
        for (m = -1; m <= 1 && way > 0; m++) printf "%.7g %.7g\n%.7g %.7g\n\n", end_x[n, s, 1] - m * bar * y / way, \
            end_y[n, s, 1] + m * bar * x / way, end_x[n, s, 2] - m * bar * y / way, end_y[n, s, 2] + m * bar * x / way > (folder "/skeleton_" n)
    }
}

# Counter-clockwise, from the lowest corner; places on an edge are left out.
function find_hull(i, n,    k, start, here, next_one, x, y, side, far) {
    for (k = 1; k <= places[i]; k++) { px[k] = at_x[place[i, k], n]; py[k] = at_y[place[i, k], n] }
    start = 1
    for (k = 2; k <= places[i]; k++)
        if (py[k] < py[start] - 1e-9 * span || py[k] < py[start] + 1e-9 * span && px[k] < px[start]) start = k
    hull = 0
    here = start
    do {
        hull++
        hull_x[hull] = px[here]
        hull_y[hull] = py[here]
        next_one = 0
        for (k = 1; k <= places[i]; k++) {
            if (distance(k, here) < 1e-9 * span) continue
            if (!next_one) { next_one = k; continue }
            side = (px[next_one] - px[here]) * (py[k] - py[here]) - (py[next_one] - py[here]) * (px[k] - px[here])
            far = distance(k, here) - distance(next_one, here)
            if (side < -1e-9 * span * span || side <= 1e-9 * span * span && far > 0 && same_way(here, next_one, k)) next_one = k
        }
        here = next_one
    } while (here && distance(here, start) > 1e-9 * span && hull < places[i])
}

function same_way(a, b, c) { return (px[b] - px[a]) * (px[c] - px[a]) + (py[b] - py[a]) * (py[c] - py[a]) > 0 }

function distance(a, b) { return sqrt((px[a] - px[b])^2 + (py[a] - py[b])^2) }

function draw_block(file, i, n, long, high,    k, x, y, c, s) {
    begin_polygon(file)
    x = at_x[slider[i], n]; y = at_y[slider[i], n]
    c = cos_of[i, n]; s = sin_of[i, n]
    for (k = 0; k <= 4; k++) corner(file, x + (k % 4 == 0 || k == 3 ? long : -long) * c - (k % 4 < 2 ? high : -high) * s, \
        y + (k % 4 == 0 || k == 3 ? long : -long) * s + (k % 4 < 2 ? high : -high) * c)
}

# ---- Paths and guides ----

function draw_paths(    n, k) {
    for (n = 1; n <= poses; n++) {
        printf "%.10g", crank[n] > (folder "/paths")
        for (k = 1; k <= paths; k++) printf " %s %s", coordinate(at_x, path[k], n), coordinate(at_y, path[k], n) > (folder "/paths")
        printf "\n" > (folder "/paths")
    }
    close(folder "/paths")
}

function coordinate(at, p, n) { return n in is_found ? sprintf("%.8g", at[p, n]) : "NaN" }

# A rail beside the blocks, on the right of its direction, as long as they slide; all blocks of a guide have one.
function draw_guides(    i, n, k, along, c, s, x, y, low, high, file, hatches, side) {
    file = folder "/guides"
    printf "" > file
    for (i = 1; i <= sliders; i++) {
        if (on[i] in link_number) continue
        c = cos_of[i, first]; s = sin_of[i, first]
        x = at_x[slider[i], first]; y = at_y[slider[i], first]
        if (!(on[i] in rail)) {
            rail[on[i]] = ++rails
            rail_c[rails] = c; rail_s[rails] = s
            rail_x[rails] = x; rail_y[rails] = y
        }
        k = rail[on[i]]
        for (n = 1; n <= poses; n++) {
            if (!(n in is_found)) continue
            along = (at_x[slider[i], n] - rail_x[k]) * c + (at_y[slider[i], n] - rail_y[k]) * s
            if (!(k in rail_low) || along < rail_low[k]) rail_low[k] = along
            if (!(k in rail_high) || along > rail_high[k]) rail_high[k] = along
        }
    }
    for (k = 1; k <= rails; k++) {
        low = rail_low[k] - 1.5 * block_length
        high = rail_high[k] + 1.5 * block_length
        rail_point(file, k, low, 0)
        rail_point(file, k, high, 0)
        print "" > file
    }
    printf "\n" > file
    for (k = 1; k <= rails; k++) {
        low = rail_low[k] - 1.5 * block_length
        high = rail_high[k] + 1.5 * block_length
        hatches = int((high - low) / (1.1 * bar) + 0.5)
        for (n = 0; n <= hatches; n++) {
            rail_point(file, k, low + (high - low) * n / hatches, 0)
            rail_point(file, k, low + (high - low) * n / hatches - 1.1 * bar, 1.1 * bar)
            print "" > file
        }
    }
    close(file)
}

function rail_point(file, k, along, below,    off, x, y) {
    off = block_height + rim + 0.3 * bar + below
    x = rail_x[k] + along * rail_c[k] + off * rail_s[k]
    y = rail_y[k] + along * rail_s[k] - off * rail_c[k]
    include(x, y)
    printf "%.7g %.7g\n", x, y > file
}

# The usual triangle on hatched ground.
function draw_grounds(    i, k, file, x, y, up) {
    file = folder "/grounds"
    printf "" > file
    for (i = 1; i <= grounds; i++) {
        ground_up[i] = hangs(ground[i]) ? -1 : 1
        for (k = 0; k < 4; k++) ground_point(file, i, k % 3 == 0 ? 0 : k == 1 ? -0.52 : 0.52, k % 3 == 0 ? 0 : -1)
        print "" > file
    }
    printf "\n" > file
    for (i = 1; i <= grounds; i++) {
        ground_point(file, i, -0.8, -1)
        ground_point(file, i, 0.8, -1)
        print "" > file
        for (k = 0; k <= 5; k++) {
            ground_point(file, i, -0.64 + 0.288 * k, -1)
            ground_point(file, i, -0.96 + 0.288 * k, -1.4)
            print "" > file
        }
    }
    close(file)
}

function ground_point(file, i, across, above,    x, y) {
    x = at_x[ground[i], first] + ground_size * across
    y = at_y[ground[i], first] + ground_size * above * ground_up[i]
    include(x, y)
    printf "%.7g %.7g\n", x, y > file
}

# ---- Facts ----

# The ends of links and points are what a linkage is for; where there are none, pins of links that no ground pivot holds.
function path_ink(k,    i, n, p, count) {
    if (!inks_known++) {
        for (i = 1; i <= links; i++)
            for (n = 1; n <= places[i]; n++) {
                p = place[i, n]
                if (joined[p] == 1 && !(p in slides) && !(p in fixed)) { ends++; is_end[p] = 1 }
                if (pivoted[i]) bound[p] = 1
            }
        for (i = 1; i <= sliders; i++) if (!(on[i] in link_number)) bound[slider[i]] = 1
        for (i = 1; i <= paths; i++)
            if (ends ? path[i] in is_end : !(path[i] in bound))
                ink_of_path[i] = word_of("#CC3333 #336699 #339966 #996699 #CC9933", count++ % 5 + 1)
    }
    return ink_of_path[k]
}

function ink_of(i) { return word_of("#6699CC #FFCC66 #99CC99 #D99AB5 #E39E6E #8FCBCB #C2B280 #A9A3D6 #B8D36A #D0B6A0", (i - 1) % 10 + 1) }

function pale_of(i) { return word_of("#DCE8F4 #FFF3DC #E6F3E6 #F7E7ED #F9E8DD #E4F3F3 #F1EDE1 #EBE9F6 #EFF5DD #F4EEE8", (i - 1) % 10 + 1) }

# A pivot stands on its ground, or hangs from it where its links hang.
function hangs(p,    i, k, n, m, found, total) {
    for (n = 1; n <= poses; n++)
        for (i = 1; i <= links && n in is_found; i++) {
            found = 0
            for (k = 1; k <= places[i]; k++) if (place[i, k] == p) found = 1
            if (!found) continue
            for (k = 1; k <= places[i]; k++) {
                m = sqrt((at_x[place[i, k], n] - at_x[p, n])^2 + (at_y[place[i, k], n] - at_y[p, n])^2)
                if (m > 0) { total += (at_y[place[i, k], n] - at_y[p, n]) / m; count_of[p]++ }
            }
        }
    # What only holds springs is on the side that they do not pull to.
    if (!count_of[p])
        for (i = 1; i <= springs; i++)
            for (k = 1; k <= 2; k++) {
                if (spring_turns(i) || end_name[i, k] != p) continue
                total += end_y[first, i, 3 - k] - end_y[first, i, k]
            }
    return total < -0.4 * count_of[p]
}

function print_facts(    i, k, text) {
    printf "poses = %d; bar = %.9g; ground_size = %.9g; layers = %d; body_layers = %d; ", poses, bar, ground_size, layer, body_layers
    printf "paths = %d; grounds = %d; drawn_links = %d\n", paths, grounds, links
    printf "x_min = %.9g; x_max = %.9g; y_min = %.9g; y_max = %.9g; span = %.9g\n", x_min, x_max, y_min, y_max, span
    printf "array pose_crank[%d]; array pose_found[%d]; ", poses, poses
    printf "array layer_fill[%d]; array layer_pale[%d]; array path_ink[%d]; array path_slides[%d]; array link_ink[%d]\n", \
        layer, layer, paths + 1, paths + 1, links
    printf "array ground_x[%d]; array ground_y[%d]; array ground_up[%d]\n", grounds + 1, grounds + 1, grounds + 1
    for (i = 1; i <= poses; i++) printf "pose_crank[%d] = %.12g; pose_found[%d] = %d\n", i, crank[i], i, i in is_found
    for (i = 1; i <= layer; i++) printf "layer_fill[%d] = '%s'; layer_pale[%d] = '%s'\n", i, layer_fill[i], i, layer_pale[i]
    for (i = 1; i <= paths; i++) { printf "path_ink[%d] = '%s'; path_slides[%d] = %d\n", i, path_ink(i), i, path[i] in slides; text = text " \"" path[i] "\"" }
    printf "path_names = %s\n", quoted(text)
    text = ""
    for (i = 1; i <= links; i++) { printf "link_ink[%d] = '%s'\n", i, ink_of(i); text = text " \"" link[i] "\"" }
    printf "link_names = %s\n", quoted(text)
    text = ""
    for (i = 1; i <= grounds; i++) {
        printf "ground_x[%d] = %.9g; ground_y[%d] = %.9g; ground_up[%d] = %d\n", i, at_x[ground[i], first], i, at_y[ground[i], first], i, ground_up[i]
        text = text " \"" ground[i] "\""
    }
    printf "ground_names = %s\n", quoted(text)
    print_springs()
    print "$springs << EOD"
    for (i = 1; i <= poses; i++) print substr(numbers[i], 2)
    print "EOD"
}

function word_of(list, i,    part) { split(list, part, " "); return part[i] }
