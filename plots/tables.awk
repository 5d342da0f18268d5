# Answers a question about one of the program's tables, read from standard input:
#   want=facts                     title, the note that names links 3 and 4, number of rows, and of every column its
#                                  place, unit, least and greatest value, as gnuplot assignments
#   want="distinct crank speed"    the distinct values of these columns, a line each, in the table's order; =crank with all digits, pin:link
#                                  as A:crank
#   want="moving speed torque O2x" those of this column, at which some of the columns behind it is not zero throughout
#   want="rows 20 link theta"      the rows at speed 20, or at `all`, a datablock for every link in the table's order, name1, name2 …; an empty line where rows have failed; angles theta and others behind it go on beyond
#                                  180 degrees, of coordinates those that are angles
#   want="range f1 f2"             the least and the greatest value found in these columns
#   want="positive error1 error2"  the same of values above zero; nothing if there are none
#   want="change f1 0"             speed, crank and f1's change in percent against the rows of speed 0
#   want="nodes 60"                the nodes of mesh.dat at crank 60, an empty line between links: number, x, y, unit
#                                  vector along the link, index in the link, index of its last, element that begins here
#                                  and its length, unit vector to a place free for a label
#   want="masses 60 20"            the same of the lumped masses of inertia.dat at crank 60, speed 20; elements are 0
#   want="shapes 20 0.15 60 1"     mode 1 of shapes.dat at speed 20, crank 60, or all without these, drawn finer, an index a mode at a crank
#                                  angle: x, y, ux, uy, 1 at a link's ends, frequency, mode, crank; displacements are made so large that the
#                                  largest of a mode is that share of the longest link (0: as they are)
#   want="reach 60 0.15"           the least and the greatest x and y, two lines, of all these modes at crank 60, at any speed,
#                                  with their displacements and with the opposite ones; without a crank, at all
#   want="arrows 60 20"            the inertia forces of inertia.dat there, those of masses at one place as one: x, y, Fx, Fy
#                                  (a third number is the share of the drawing's larger side that the longest arrow takes:
#                                  arrows on one line that would cover each other are drawn beside each other)
#   want="path 20 xG yG"           these columns at speed 20 as a path that is smooth where rows are no farther apart than 15
#                                  degrees of the crank: x, y, crank, 1 at a row of the table
#   want="path 20 axial transverse A crank"     the same of the rows of pin A and link crank
#   want="critical 5 60"           from frequencies.dat over a whole turn: mode, harmonic up to the twentieth, and speed, at which this
#                                  multiple of the crank's speed is the mode's mean frequency; speeds in this range, from the highest down
#   want="positions 20 8 O2x O2y"  at speed 20, at eight positions at most (six, if these divide a turn better), or all (0): the crank angle with
#                                  all digits, then these columns, or of points, A:crank, ux, uy and the rotation in radians
#   want="branches 20"             the branches of branches.dat at speed 20, a datablock a branch, named by its number, an empty line where
#                                  rows have failed: crank, frequency, 1 where a mark is drawn
#   want="joints 20 O Q"           of reactions.dat with a row a pin and link at speed 20, a line a joint with a force: its number among them
#                                  and its name, A, or A:crank where the links feel different forces; one for the two opposite ones of two links; of
#                                  pins of one link only the ground pivots, named behind the speed
#   want="coordinates 20"          of coordinates.dat or ratios.dat at speed 20, or at `all`, a line a coordinate in the table's order: length or angle, its units of
#                                  value (or ratio), rate and effort, whether its effort is not zero throughout
#   want="reference"               the coordinate to which the ratios of ratios.dat refer
#   want="limits"                  of linkage.dat of a linkage that is no four-bar: a line a range of the first drive (1), a link that swings
#                                  (2), a slider (3), a further drive or coordinate that is an angle (4) or a length (5), a transmission angle (6) and
#                                  a pressure angle (7): that number, the name, the least and the greatest value, where the drive is then, swing,
#                                  stroke or span and time ratio (0: none), what stops the drive at its greatest value, the number of the range
#                                  (0: there is one)
#   want="turning"                 of the same table: the links that turn fully
#   want="wrong"                   what is no number in a column of numbers, or no name in one of names, once a column: the column, or - where
#                                  every figure needs it, then the line and what is wrong there
#   want="varied"                  the columns of varied parameters: those before the table's own
#   want="poses"                   the positions of geometry.dat, a line each: the crank angle, then for every
#                                  pin of a link the link's number (0 the ground), its name, x and y, for every point the
#                                  same with the number below 0; for springs and dampers the same with their part, | and name for it
#   want="rows_by L"               the rows where the other parameters are those of the first row, as they are, with an empty line
#                                  where such a variant has failed
#   want="unit L"                  the unit of this column
#   want="band L"                  where the other parameters and the speed are those of the first row: L, then the least and the
#                                  greatest value over all positions of every frequency of the table
#   want="events 20"               what happens to them: 1 crossing, 2 veering, 3 ambiguous; crank; the lower and the higher
#                                  frequency (a crossing lies between two rows; one that comes with the speed is left out)
# With datablock=name the answer is a gnuplot datablock of that name.
# Rows are picked by their values, never by block: two failed rows in a row look like the end of a block.

BEGIN {
    OFMT = CONVFMT = "%.11e"       # gnuplot takes the text 5e-05 for the number 5 and something behind it
    n_asked = split(want, asked, " ")
    header = 1
    if (datablock && asked[1] !~ /^(rows|branches)$/) print "$" datablock " << EOD"
}

# The header: title, notes, names, units. A failed row is a comment too, but no part of it.
header && /^#/ && (NR == 1 || !/^# *failed /) {
    sub(/^# */, "")
    if (NR == 1) title = $0 == "(no title)" ? "" : $0
    if (/^(link +)?[23][: ]/) link_note = $0
    head[++heads] = $0
    name_line = unit_line
    unit_line = $0
    next
}

header {
    header = 0
    name_columns()
}

# A variant without a row: the other parameters are compared with those of the first row, or kept for it.
asked[1] == "rows_by" && /^# *failed / {
    if (!rows) next
    kept = 1
    for (i = 3; i <= NF && $i != ":"; i++) {
        split($i, pair, "=")
        if (pair[1] != asked[2] && pair[1] in at && !same(pair[2], first_row[at[pair[1]]])) kept = 0
    }
    if (kept) print ""
    next
}

/^#/ || NF == 0 {
    if (!gap[rows + 1]) gaps++
    gap[rows + 1] = path_broken = 1
    next
}

{ rows++ }

asked[1] == "distinct" {
    line = ""
    for (i = 2; i <= n_asked; i++) line = line (i > 2 ? " " : "") cell(asked[i])
    if (!(line in seen)) print line
    seen[line] = 1
}

asked[1] == "facts" {
    for (i = 1; i <= n_columns; i++) {
        number = $i + 0
        if (!(number > -1e308 && number < 1e308)) continue       # what is no number has neither place
        if (low[i] == "" || number < low[i]) low[i] = number
        if (high[i] == "" || number > high[i]) high[i] = number
    }
}

asked[1] == "wrong" {
    if (NF != n_columns) tell_wrong("-", NF " values in " n_columns " columns")
    for (i = 1; i <= n_columns; i++) {
        if (!is_name(name[i])) tell_wrong("-", "no name of a column: " name[i])
        if (name[i] == "unit") fits = $i ~ /^[A-Za-z0-9_.*\/%-]+$/
        else fits = has_names(name[i]) ? is_name($i) : is_number($i) || $i == "-" && may_lack(name[i])
        if (!fits) tell_wrong(has_names(name[i]) || i <= at["speed"] || name[i] ~ /^(crank|time)$/ ? "-" : name[i], name[i] " is " $i)
    }
}

asked[1] == "moving" && !($at[asked[2]] in seen) {
    for (i = 3; i <= n_asked; i++) if (asked[i] in at && ($at[asked[i]] + 0 != 0 || !is_number($at[asked[i]]))) seen[$at[asked[2]]] = 1
    if ($at[asked[2]] in seen) print cell(asked[2])
}

asked[1] == "rows" {
    key = cell(asked[3]) ""
    if (!(key in place)) { place[key] = ++places; rows_of[places] = "" }
    if (asked[2] == "all" || same($at["speed"], asked[2])) {
        if (gaps != gaps_before[key] && rows_of[place[key]] != "") rows_of[place[key]] = rows_of[place[key]] "\n"
        for (i = 4; i <= n_asked && (asked[3] != "coordinate" || is_angle(key)); i++) {
            if ((key, i) in before) $at[asked[i]] = turned_on($at[asked[i]], before[key, i])
            before[key, i] = $at[asked[i]]
        }
        gaps_before[key] = gaps
        rows_of[place[key]] = rows_of[place[key]] $0 "\n"
    }
}

asked[1] ~ /^(range|positive)$/ {
    for (i = 2; i <= n_asked; i++) {
        number = $at[asked[i]] + 0
        if (asked[1] == "positive" && number <= 0) continue
        if (least == "" || number < least) least = number
        if (greatest == "" || number > greatest) greatest = number
    }
}

asked[1] == "change" {
    speed[rows] = $at["speed"]
    crank[rows] = $at["crank"]
    value[rows] = $at[asked[2]] + 0
    if (same($at["speed"], asked[3])) reference[$at["crank"] + 0] = value[rows]
}

(asked[1] == "branches" || asked[1] == "events") && same($at["speed"], asked[2]) {
    points++
    crank[points] = $at["crank"] + 0
    value[points] = $at["frequency"] + 0
    branch[points] = $at["branch"] + 0
    event[points] = $at["event"]
    broken[points] = gap[rows]
    row_of[branch[points], crank[points]] = points
    if (branch[points] != branch[points - 1]) branches++
    if (!(crank[points] in place)) place[crank[points]] = ++places
}

asked[1] == "poses" {
    # Names that look like numbers are names.
    if ($at["link"] == "(ground)" && link_drawn != "(ground)") {
        if (pose) print pose
        pose = sprintf("%.17g", $at["crank"])
        links = 0
    } else if ($at["link"] "" != link_drawn "") links++
    link_drawn = $at["link"] ""
    if ($at["part"] ~ /^(spring|damper|side)$/) place_number = $at["part"] "|" $at["link"]
    else place_number = $at["part"] == "point" ? -links : links
    pose = pose " " place_number " " $at["place"] " " $at["x"] " " $at["y"]
}

asked[1] == "rows_by" {
    kept = 1
    for (i = 1; i < at["rows"]; i++) {
        if (rows == 1) first_row[i] = $i
        if (name[i] != asked[2] && $i != first_row[i]) kept = 0
    }
    if (kept) print
}

asked[1] == "band" {
    if (rows == 1) for (i = 1; i <= at["speed"]; i++) first_row[i] = $i
    kept = 1
    for (i = 1; i <= at["speed"]; i++) if (name[i] != asked[2] && $i != first_row[i]) kept = 0
    if (kept) band($at[asked[2]])
}

# Twice through a table would be slower than to keep what has been read.
asked[1] == "reach" || asked[1] == "shapes" && same($at["speed"], asked[2]) && \
    (n_asked < 5 || same($at["crank"], asked[4]) && same($at["mode"], asked[5])) {
    key = $at["mode"] " " short($at["crank"]) " " ($at["speed"] + 0)
    if (key != key_of[shapes]) key_of[++shapes] = key
    kept++
    of_shape[kept] = shapes
    link_at[kept] = $at["link"]
    frequency_at[kept] = $at["frequency"]
    for (i = 1; i <= 4; i++) value[i, kept] = $at[i == 1 ? "x" : i == 2 ? "y" : i == 3 ? "ux" : "uy"]
    moved = sqrt($at["ux"]^2 + $at["uy"]^2)
    if (moved > most_moved[shapes]) most_moved[shapes] = moved
    if ($at["s"] + 0 > longest) longest = $at["s"] + 0
}

asked[1] == "positions" && same($at["speed"], asked[2]) {
    if (!positions || $at["crank"] != crank[positions]) crank[++positions] = $at["crank"]
    for (i = 4; i <= n_asked; i++) {
        if (asked[i] in at) value[positions, i] = $at[asked[i]]
        else if ($at["point"] == asked[i]) value[positions, i] = $at["ux"] " " $at["uy"] " " \
            $at["rotation"] * (unit[at["rotation"]] == "deg" ? 3.14159265358979 / 180 : 1)
    }
}

# A crank angle that closes the turn is the first one again.
asked[1] == "critical" {
    if (rows == 1 || !same($at["speed"], speed[speeds])) {
        speed[++speeds] = $at["speed"] + 0
        first_crank = $at["crank"] + 0
    }
    last_crank[speeds] = $at["crank"] - first_crank
    if (!same(last_crank[speeds], 360)) {
        counted[speeds]++
        for (i = 1; ("f" i) in at; i++) {
            total[speeds, i] += $at["f" i]
            if ($at["f" i] + 0 <= 0) diverged[speeds, i] = 1
        }
    }
}

asked[1] == "path" && same($at["speed"], asked[2]) && (n_asked < 6 || $at["pin"] == asked[5] && $at["link"] == asked[6]) {
    path_gap[++path_rows] = path_broken
    path_broken = 0
    path_crank[path_rows] = $at["crank"] + 0
    path[1, path_rows] = $at[asked[3]] + 0
    path[2, path_rows] = $at[asked[4]] + 0
}

asked[1] == "arrows" && same($at["crank"], asked[2]) && same($at["speed"], asked[3]) {
    for (i = 1; i <= arrows; i++) if (same($at["x"], arrow[1, i]) && same($at["y"], arrow[2, i])) break
    if (i > arrows) { arrows++; arrow[1, i] = $at["x"] + 0; arrow[2, i] = $at["y"] + 0 }
    arrow[3, i] += $at["Fx"]
    arrow[4, i] += $at["Fy"]
}

asked[1] == "nodes" && same($at["crank"], asked[2]) {
    node($at["node_a"], $at["xa"], $at["ya"], $at["link"], $at["element"])
    node($at["node_b"], $at["xb"], $at["yb"], $at["link"], 0)
}

asked[1] == "masses" && same($at["crank"], asked[2]) && same($at["speed"], asked[3]) && $at["link"] !~ /^pin:/ {
    node($at["mass"], $at["x"], $at["y"], $at["link"], 0)
    Fx[nodes] = $at["Fx"]
    Fy[nodes] = $at["Fy"]
}

asked[1] == "turning" && $at["quantity"] == "turns" { print $at["part"] }

asked[1] == "limits" && $at["quantity"] ~ /_(from|angle|place|transmission|pressure|value)$/ {
    kind = $at["quantity"] ~ /^range/ ? 1 : $at["quantity"] ~ /angle$/ ? 2 : $at["quantity"] ~ /place$/ ? 3 : $at["quantity"] ~ /mission$/ ? 6 \
        : $at["quantity"] ~ /(value|from)$/ ? ($at["unit"] == "deg" ? 4 : 5) : 7
    is_least = $at["quantity"] !~ /^greatest/
    if (is_least || kind == 7) {
        key_of[++shapes] = kind; link_at[shapes] = $at["part"] ""
        range_of[shapes] = ranges += kind == 1
        value[1, shapes] = value[2, shapes] = is_least ? $at["value"] : 0
        value[3, shapes] = value[4, shapes] = $at["crank"]
    }
    if (!is_least) { value[2, shapes] = $at["value"]; value[4, shapes] = $at["crank"] }
}

asked[1] == "limits" && $at["quantity"] ~ /_to$/ {
    value[2, shapes] = $at["value"]; value[4, shapes] = $at["crank"]; value[5, shapes] = value[2, shapes] - value[1, shapes]
    stops[shapes] = $at["part"]
}

asked[1] == "limits" && $at["part"] "" == link_at[shapes] && $at["quantity"] ~ /^(swing|stroke|span|time_ratio)$/ { value[$at["quantity"] == "time_ratio" ? 6 : 5, shapes] = $at["value"] }

asked[1] == "joints" && same($at["speed"], asked[2]) {
    if (!(($at["pin"], $at["link"]) in place)) {
        place[$at["pin"], $at["link"]] = ++places
        pin[places] = $at["pin"] ""
        link_of[places] = $at["link"]
        links_at[pin[places]]++
    }
    number = sqrt($at["fx"]^2 + $at["fy"]^2)
    k = place[$at["pin"], $at["link"]]
    if (number > high[k]) high[k] = number
    if (number > greatest) greatest = number
    if (crank[pin[k]] == $at["crank"] "" && absolute(number - value[pin[k]]) > apart[pin[k]]) apart[pin[k]] = absolute(number - value[pin[k]])
    crank[pin[k]] = $at["crank"] ""
    value[pin[k]] = number
}

asked[1] == "coordinates" && (asked[2] == "all" || same($at["speed"], asked[2])) {
    key = $at["coordinate"] ""
    if (!(key in place)) { place[key] = ++places; met_name[places] = key }
    if (("effort" in at) && $at["effort"] + 0 != 0) moving[key] = 1
}

END {
    if (header) name_columns()
    if (asked[1] == "coordinates") print_coordinates()
    if (asked[1] == "reference") print_reference()
    if (asked[1] == "rows") for (i = 1; i <= places; i++) printf "$%s%d << EOD\n%s%s", datablock, i, rows_of[i] == "" ? nothing() : rows_of[i], i < places ? "EOD\n" : ""
    if (asked[1] == "joints") print_joints()
    if (asked[1] == "facts") print_facts()
    if (asked[1] == "limits") print_limits()
    if (asked[1] == "unit") print unit[at[asked[2]]]
    if (asked[1] ~ /^(range|positive)$/ && least != "") print pointed(sprintf("%.12g", least)), pointed(sprintf("%.12g", greatest))
    if (asked[1] == "branches") print_branches()
    if (asked[1] == "events") print_events()
    if (asked[1] == "shapes") print_shapes()
    if (asked[1] == "reach") print_reach()
    if (asked[1] == "path") print_path()
    if (asked[1] == "arrows") print_arrows()
    if (asked[1] == "change") print_change()
    if (asked[1] == "critical") print_critical()
    if (asked[1] == "positions") print_positions()
    if (asked[1] == "varied") {
        for (i = 1; i <= n_columns && name[i] !~ /^(speed|crank|time|branch|from|part)$/; i++) {
            if (name[i] == "rows" && name[i + 1] == "failed") break
            print name[i]
        }
    }
    if (asked[1] == "poses" && pose) print pose
    if (asked[1] == "band") print_bands()
    if (asked[1] == "nodes" || asked[1] == "masses") print_nodes()
    if (datablock) print "EOD"
}

# Too large a number is none.
function is_number(text) {
    return text ~ /^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$/ && text + 0 > -1e308 && text + 0 < 1e308
}

# Names of decks, and what the program makes of them: A:crank, (ground), 1+2.
function is_name(text) { return text ~ /^[A-Za-z0-9_.\047:()+-]+$/ }

# Where the program has no value it may write a dash.
# Where columns have no unit of their own the head has those of every coordinate.
function print_coordinates(    i, k, told, units, names) {
    split(("ratio" in at) ? "ratio" : "value rate acceleration effort", names, " ")
    for (i = 1; i <= places; i++) {
        for (k = 1; k in names; k++) units[k] = (names[k] in at) ? unit[at[names[k]]] : "-"
        for (k = 1; k <= heads; k++) {
            if (index(head[k], met_name[i] ": ") != 1) continue
            told = substr(head[k], length(met_name[i]) + 3)
            if (told ~ /^[^ ,]+(, [^ ,]+, [^ ,]+, [^ ,]+)?$/) split(told, units, ", ")
        }
        print (units[1] == "deg" || units[2] ~ /^(rad\/s|rpm)$/ ? "angle" : "length"), units[1], (2 in names) ? units[2] : "-", \
            (4 in names) ? units[4] : "-", (met_name[i] in moving) ? 1 : 0
    }
}

# Whether the values of a coordinate are angles, as the column says, or the head.
function is_angle(key,    k) {
    if (!(key in angle)) {
        angle[key] = unit[at["value"]] == "deg"
        for (k = 1; k <= heads; k++) if (index(head[k], key ": deg, ") == 1) angle[key] = unit[at["value"]] == "see_head"
    }
    return angle[key]
}

function print_reference(    k) {
    for (k = 1; k <= heads; k++) {
        if (!sub(/^ratio: change of the coordinate per change of /, "", head[k])) continue
        sub(/;.*/, "", head[k])
        print head[k]
        return
    }
}

function may_lack(column) {
    return column ~ /^(least|mean|greatest|band_error|[a-z]*_crank|quadratic|out_of_plane|distance|error)$/
}

function has_names(column) {
    return column ~ /^(branch|coordinate|drive|event|gauge|joint|kind|link|linkage|modes|part|pin|place|point|quantity|unit|verdict)$/
}

# Once for every column; what is odd is shown as far as a terminal should see it.
function tell_wrong(column, what) {
    if (column in told_wrong) return
    told_wrong[column] = 1
    gsub(/[^ -~]/, "?", what)
    print column, "line " NR ": " substr(what, 1, 60)
}

function name_columns(    i) {
    n_columns = split(name_line, name, " ")
    split(unit_line, unit, " ")
    for (i = 1; i <= n_columns; i++) {
        at[name[i]] = i
        if (name[i] ~ /^f[1-9][0-9]*$/) mode_column[++n_modes] = i
    }
}

function print_facts(    i) {
    printf "deck_title = %s; link_note = %s; columns = %s; rows = %d", \
        quoted(title), quoted(link_note), quoted(name_line), rows
    for (i = 1; i <= n_columns; i++) {
        if (name[i] ~ /^[A-Za-z_][A-Za-z_0-9]*$/ && length(name[i]) <= 40) {
            printf "; col_%s = %d; unit_%s = %s; low_%s = %.15g; high_%s = %.15g", \
                name[i], i, name[i], quoted(unit[i]), name[i], low[i], name[i], high[i]
        }
    }
    print ""
}

# A row of which no column has a value.
function nothing(    i, text) {
    for (i = 1; i <= n_columns; i++) text = text "NaN "
    return text "\n"
}

function turned_on(angle, before) { return angle + 360 * int((before - angle) / 360 + (before > angle ? 0.5 : -0.5)) }

# Two links at a pin feel opposite forces, unless a mass or a load takes some of it. The free end of a link feels none.
# A pin or point that a link has for itself is no joint, unless it is a ground pivot, though a load may act there.
function print_joints(    k, alike, is_ground) {
    for (k = 3; k <= n_asked; k++) is_ground[asked[k]] = 1
    for (k = 1; k <= places; k++) {
        if (links_at[pin[k]] == 1 && n_asked > 2 && !(pin[k] in is_ground)) continue
        alike = links_at[pin[k]] == 2 && apart[pin[k]] <= 1e-9 * greatest
        if (alike && met[pin[k]]++ || links_at[pin[k]] == 1 && greatest > 0 && high[k] <= 1e-12 * greatest) continue
        print k, alike || links_at[pin[k]] == 1 ? pin[k] : pin[k] ":" link_of[k]
    }
}

function print_limits(    kind, i, k, line) {
    for (kind = 1; kind <= 7; kind++)
        for (i = 1; i <= shapes; i++) {
            # A link that keeps its angle swings by what rounding makes of it; what is constant has no bar.
            if (key_of[i] != kind || kind == 2 && value[5, i] < 1e-5 || (kind == 4 || kind == 5) && value[5, i] + 0 == 0) continue
            line = kind " " link_at[i]
            for (k = 1; k <= 6; k++) line = line " " pointed(sprintf("%.12g", value[k, i]))
            print line, (kind == 1 ? stops[i] : "-"), (ranges > 1 ? range_of[i] : 0)
        }
}

function band(value,    k) {
    if (!(value in least_of)) { place[++places] = value; least_of[value] = 1 }
    for (k = 1; k <= n_modes; k++) {
        if (!((value, k) in low) || $mode_column[k] + 0 < low[value, k]) low[value, k] = $mode_column[k] + 0
        if (!((value, k) in high) || $mode_column[k] + 0 > high[value, k]) high[value, k] = $mode_column[k] + 0
    }
}

function print_bands(    i, k, line) {
    for (i = 1; i <= places; i++) {
        line = place[i] + 0
        for (k = 1; k <= n_modes; k++) line = line " " low[place[i], k] " " high[place[i], k]
        print line
    }
}

# A change between two frequencies of which one has diverged has no percentage.
function print_change(    i, base) {
    for (i = 1; i <= rows; i++) {
        if (gap[i]) print ""
        base = reference[crank[i] + 0] + 0
        print speed[i], crank[i], (base > 0 && value[i] > 0) ? 100 * (value[i] / base - 1) : "NaN"
    }
}

# Marks stand on some rows, shifted from branch to branch, and on a row alone between failed ones; a branch that has none
# gets one in its middle.
function print_branches(    i, first, last, step, number, marked, mark) {
    step = places > 24 ? int(places / 12) : 1
    for (first = 1; first <= points; first = last + 1) {
        for (last = first; branch[last + 1] == branch[first]; ) last++
        printf "%s$%s%s << EOD\n", number++ ? "EOD\n" : "", datablock, branch[first]
        marked = 0
        broken[first] = broken[last + 1] = 1
        for (i = first; i <= last; i++) {
            mark[i] = (place[crank[i]] - 1) % step == int((number - 1) * step / branches) || (broken[i] && broken[i + 1])
            marked += mark[i]
        }
        if (!marked) mark[int((first + last) / 2)] = 1
        for (i = first; i <= last; i++) {
            if (broken[i] && i > first) print ""
            print crank[i], value[i], mark[i]
        }
    }
}

# Either of the two branches tells of a crossing or a veering; it is printed once.
function print_events(    i, other, kind, partner) {
    for (i = 1; i <= points; i++) {
        split(event[i], partner, ":")
        kind = partner[1] == "crossing" ? 1 : partner[1] == "veering" ? 2 : partner[1] == "ambiguous" ? 3 : 0
        if (kind == 3) print kind, crank[i], value[i], value[i]
        other = row_of[partner[2] + 0, crank[i]]
        if (kind == 0 || kind == 3 || !other || told[other, i]) continue
        told[i, other] = 1
        if (kind == 1) print_crossing(i, other)
        if (kind == 2) print kind, crank[i], smaller(value[i], value[other]), -smaller(-value[i], -value[other])
    }
}

# Where the straight lines from the rows before meet.
function print_crossing(i, j,    before, now, t, height) {
    if (branch[i - 1] != branch[i] || branch[j - 1] != branch[j] || crank[i - 1] != crank[j - 1]) return
    before = value[i - 1] - value[j - 1]
    now = value[i] - value[j]
    t = before * now < 0 ? before / (before - now) : 1
    height = value[i - 1] + t * (value[i] - value[i - 1])
    print 1, crank[i - 1] + t * (crank[i] - crank[i - 1]), height, height
}

# The rows of one link, with three points put between each two by the cubic through the four nearest rows: a high mode
# then stays a smooth curve, and every row is still met. A corner stands twice, and is no place of such a curve.
function print_link(    first, last) {
    for (first = 1; first <= points; first = last + 1) {
        for (last = first; last < points && !is_corner(last); ) last++
        print_part(first, last)
    }
    if (points) print ""
    points = 0
}

function is_corner(j) { return same(shape[1, j], shape[1, j + 1]) && same(shape[2, j], shape[2, j + 1]) }

function print_part(from, to,    i, k, j, first, t) {
    for (j = from; j <= to; j++) {
        first = j - 1 < from ? from : j - 1
        if (first > to - 3) first = to - 3
        for (k = 0; k < (j < to && to - from > 2 ? 4 : 1); k++) {
            t = j + k / 4 - first
            for (i = 1; i <= 4; i++) printf "%.9g ", k == 0 ? shape[i, j] : cubic(i, first, t)
            print k == 0 && (j == 1 || j == points), frequency, tail
        }
    }
}

function cubic(i, j, t) {
    return -shape[i, j] * (t - 1) * (t - 2) * (t - 3) / 6 + shape[i, j + 1] * t * (t - 2) * (t - 3) / 2 \
        - shape[i, j + 2] * t * (t - 1) * (t - 3) / 2 + shape[i, j + 3] * t * (t - 1) * (t - 2) / 6
}

function print_arrows(    i, j, k, low, high, span, longest, size, along, across, drawn, same_way, aside) {
    for (i = 1; i <= arrows; i++) {
        arrow[5, i] = sqrt(arrow[3, i]^2 + arrow[4, i]^2)
        if (arrow[5, i] > longest) longest = arrow[5, i]
        for (k = 1; k <= 2; k++) {
            if (i == 1 || arrow[k, i] < low[k]) low[k] = arrow[k, i]
            if (i == 1 || arrow[k, i] > high[k]) high[k] = arrow[k, i]
        }
    }
    span = -smaller(low[1] - high[1], low[2] - high[2])
    for (i = 1; i <= arrows; i++) {
        aside = 0
        for (j = 1; j < i; j++) {
            size = arrow[5, i] * arrow[5, j]
            if (size == 0 || absolute(arrow[3, i] * arrow[4, j] - arrow[4, i] * arrow[3, j]) > 0.1 * size) continue
            along = ((arrow[1, i] - arrow[1, j]) * arrow[3, j] + (arrow[2, i] - arrow[2, j]) * arrow[4, j]) / arrow[5, j]
            across = ((arrow[1, i] - arrow[1, j]) * arrow[4, j] - (arrow[2, i] - arrow[2, j]) * arrow[3, j]) / arrow[5, j]
            drawn = asked[4] * span / longest
            same_way = arrow[3, i] * arrow[3, j] + arrow[4, i] * arrow[4, j] > 0
            if (absolute(across) > 0.03 * span) continue
            if (along < drawn * arrow[5, j] && along > -drawn * arrow[5, i] * same_way) aside++
        }
        size = arrow[5, i] > 0 ? 0.02 * span * aside / arrow[5, i] : 0
        print arrow[1, i] - size * arrow[4, i], arrow[2, i] + size * arrow[3, i], arrow[3, i] + 0, arrow[4, i] + 0
    }
}

function print_positions(    n, i, m, line) {
    n = chosen(positions, asked[3])
    for (m = 1; m <= n; m++) {
        line = sprintf("%.17g", crank[choice[m]])
        for (i = 4; i <= n_asked; i++) line = line " " ((choice[m], i) in value ? value[choice[m], i] : "NaN NaN NaN")
        print line
    }
}

# Turns in a second of a crank of speed 1 in the unit of the table; 0 if that is none of these.
function turns_of(unit) {
    return unit == "rad/s" ? 1 / 6.28318530717959 : unit == "rpm" ? 1 / 60 : unit == "deg/s" ? 1 / 360 : \
        unit == "rad/ms" ? 1000 / 6.28318530717959 : unit == "deg/ms" ? 1000 / 360 : 0
}

# The mean frequency between two speeds is on a straight line, and beyond the last one as it is there.
function print_critical(    i, k, n, turns, low, high, rate) {
    turns = turns_of(unit[at["speed"]])
    low = asked[2] < asked[3] ? asked[2] + 0 : asked[3] + 0
    high = asked[2] < asked[3] ? asked[3] + 0 : asked[2] + 0
    if (!turns) return
    for (k = 1; k <= speeds; k++) if (last_crank[k] < 300) return
    for (i = 1; ("f" i) in at; i++) {
        for (n = 1; n <= 20; n++) {
            for (k = 0; k <= speeds; k++) {
                rate = critical_between(i, k, n * turns)
                if (rate >= low && rate <= high) print i, n, rate
            }
        }
    }
}

# Between speeds k and k + 1 of the table; before the first and beyond the last one too.
function critical_between(i, k, turns,    below, above, from, to) {
    if (k > 0 && diverged[k, i] || k < speeds && diverged[k + 1, i]) return -1
    if (k == 0 || k == speeds) {
        from = k == 0 ? 1 : k
        below = total[from, i] / counted[from] / turns
        return k == 0 && below < speed[1] || k == speeds && below >= speed[speeds] ? below : -1
    }
    below = total[k, i] / counted[k] - turns * speed[k]
    above = total[k + 1, i] / counted[k + 1] - turns * speed[k + 1]
    if (below < 0 || above >= 0) return -1
    return speed[k] + below / (below - above) * (speed[k + 1] - speed[k])
}

# The last row of a whole turn is the first again; a turn is divided by 8 or by 6, so that the angles are even.
function chosen(found, wanted,    n, i, turn) {
    n = wanted + 0 == 0 || wanted + 0 > found ? found : wanted + 0
    if (found > 1 && same(crank[found], crank[1] + 360) && (n < found || wanted != "")) {
        found--
        if (n > found) n = found
    }
    turn = found > 1 && same(crank[found] - crank[1] + crank[2] - crank[1], 360)
    if (turn && n == 8 && found % 8 && found % 6 == 0) n = 6
    for (i = 0; i < n; i++) choice[i + 1] = n == found ? i + 1 : int(1.5 + i * (turn ? found / n : (found - 1) / (n - 1)))
    return n
}

function scale_of(shape) { return most_moved[shape] > 0 ? asked[3] * longest / most_moved[shape] : 0 }

function print_shapes(    k, i) {
    for (k = 1; k <= kept; k++) {
        if (k > 1 && (of_shape[k] != of_shape[k - 1] || link_at[k] != link_at[k - 1])) end_link(k - 1)
        if (k > 1 && of_shape[k] != of_shape[k - 1]) print ""
        points++
        frequency = frequency_at[k]
        for (i = 1; i <= 4; i++) shape[i, points] = (i > 2 && asked[3] > 0 ? scale_of(of_shape[k]) : 1) * value[i, k]
    }
    end_link(kept)
}

function end_link(k,    part) {
    split(key_of[of_shape[k]], part, " ")
    tail = part[1] " " part[2]
    print_link()
}

function print_reach(    part, k, i, side, place, low, high, begun, scale) {
    for (k = 1; k <= kept; k++) {
        split(key_of[of_shape[k]], part, " ")
        if (asked[2] != "all" && !same(part[2], asked[2])) continue
        scale = scale_of(of_shape[k])
        for (side = -1; side <= 1; side++) {
            for (i = 1; i <= 2; i++) {
                place = value[i, k] + side * scale * value[i + 2, k]
                if (begun < i || place < low[i]) low[i] = place
                if (begun < i || place > high[i]) high[i] = place
                if (begun < i) begun = i
            }
        }
    }
    print low[1], low[2]
    print high[1], high[2]
}

# Between two rows a cubic, of the velocities of the parabola through a row and its neighbours, but no faster than 1.5 times the
# slower of the ways to these: then a curve does not swing out beside a corner. Round a whole turn the first row follows the
# last.
function print_path(    i, j, first, last, round, parts) {
    for (first = 1; first <= path_rows; first = last + 1) {
        for (last = first; last < path_rows && !path_gap[last + 1]; ) last++
        round = same(path_crank[last], path_crank[first] + 360)
        for (i = first; i <= last; i++) set_slopes(i, first, last, round)
        if (first > 1) print ""
        for (i = first; i < last; i++) {
            parts = path_crank[i + 1] - path_crank[i]
            parts = parts > 15.000001 || last - first < 3 ? 1 : int(parts / 0.5 + 0.999)
            if (parts < 4 && parts > 1) parts = 4
            for (j = 0; j < parts; j++) print between(1, i, j / parts), between(2, i, j / parts), \
                path_crank[i] + j / parts * (path_crank[i + 1] - path_crank[i]), j == 0
        }
        print path[1, last], path[2, last], path_crank[last], 1
    }
}

function set_slopes(i, first, last, round,    here, there, before, after, k, share, size, fast) {
    slope[1, i] = slope[2, i] = 0
    if (last == first) return
    here = i == first && round ? last : i           # the same row, where the one before is
    there = i == last && round ? first : i          # and where the one after is
    before = here > first ? here - 1 : here
    after = there < last ? there + 1 : there
    if (before == here || after == there) {
        for (k = 1; k <= 2; k++) slope[k, i] = path_way(k, before, after)
        return
    }
    share = (path_crank[here] - path_crank[before]) / (path_crank[here] - path_crank[before] + path_crank[after] - path_crank[there])
    for (k = 1; k <= 2; k++) slope[k, i] = (1 - share) * path_way(k, before, here) + share * path_way(k, there, after)
    fast = 1.5 * smaller(speed_of(before, here), speed_of(there, after))
    size = sqrt(slope[1, i]^2 + slope[2, i]^2)
    if (size > fast) for (k = 1; k <= 2; k++) slope[k, i] *= fast / size
}

function speed_of(i, j) { return sqrt(path_way(1, i, j)^2 + path_way(2, i, j)^2) }

function path_way(k, i, j) { return (path[k, j] - path[k, i]) / (path_crank[j] - path_crank[i]) }

function between(k, i, t,    long) {
    long = path_crank[i + 1] - path_crank[i]
    return path[k, i] * (1 + 2 * t) * (1 - t)^2 + path[k, i + 1] * t^2 * (3 - 2 * t) \
        + long * t * (1 - t) * (slope[k, i] * (1 - t) - slope[k, i + 1] * t)
}

# Elements bring their inner nodes twice.
function node(number, x, y, link, element) {
    if (number != number_of[nodes] || link != link_of[nodes]) {
        nodes++
        index_of[nodes] = link == link_of[nodes - 1] ? index_of[nodes - 1] + 1 : 0
    }
    number_of[nodes] = number; x_of[nodes] = x; y_of[nodes] = y; link_of[nodes] = link; element_of[nodes] = element
    last_of[link] = index_of[nodes]
}

# The last node of a link looks along it as the one before does; a link with one node looks nowhere.
function print_nodes(    i, dx, dy) {
    for (i = 1; i <= nodes; i++) {
        if (index_of[i] < last_of[link_of[i]]) {
            dx = x_of[i + 1] - x_of[i]
            dy = y_of[i + 1] - y_of[i]
            length_of[i] = sqrt(dx * dx + dy * dy)
            along_x[i] = dx / length_of[i]
            along_y[i] = dy / length_of[i]
        } else if (index_of[i] > 0) {
            along_x[i] = along_x[i - 1]
            along_y[i] = along_y[i - 1]
        }
    }
    for (i = 1; i <= nodes; i++) {
        place_label(i)
        if (index_of[i] == 0 && i > 1) print ""
        print number_of[i], x_of[i], y_of[i], along_x[i] + 0, along_y[i] + 0, index_of[i], last_of[link_of[i]], \
            element_of[i], length_of[i] + 0, cos(label[i]), sin(label[i])
    }
}

# A label keeps 60 degrees, or what there is, from links, the force, the other node's label at a pin and the triangle under
# a fixed pivot; then it leans towards its own link and to the left of it.
function place_label(i,    angle, score, best, k, back) {
    obstacles = 0
    block_links(i)
    if (i > 1 && index_of[i] == 0) { block_links(i - 1); block(cos(label[i - 1]), sin(label[i - 1])) }
    if (i < nodes && index_of[i] == last_of[link_of[i]]) block_links(i + 1)
    if (i == 1 || i == nodes) block(0, -1)
    block(Fx[i], Fy[i])
    back = index_of[i] == 0 ? 1 : index_of[i] == last_of[link_of[i]] ? -1 : 0
    for (k = 0; k < 48; k++) {
        angle = k * 3.14159265358979 / 24
        score = 0.25 * back * (cos(angle) * along_x[i] + sin(angle) * along_y[i]) \
            + 0.1 * (sin(angle) * along_x[i] - cos(angle) * along_y[i]) + clearance(angle)
        if (k == 0 || score > best) { best = score; label[i] = angle }
    }
}

function block_links(i) {
    if (index_of[i] > 0) block(-along_x[i], -along_y[i])
    if (index_of[i] < last_of[link_of[i]]) block(along_x[i], along_y[i])
}

function block(x, y) {
    if (x == 0 && y == 0) return
    obstacle[++obstacles] = atan2(y, x)
}

function clearance(angle,    k, least) {
    least = 3.14159265358979 / 3
    for (k = 1; k <= obstacles; k++) least = smaller(least, absolute(turned(angle - obstacle[k])))
    return least
}

function turned(angle) { return atan2(sin(angle), cos(angle)) }

function smaller(a, b) { return a < b ? a : b }

# Names that look like numbers are names.
function cell(column) { return column == "pin:link" ? $at["pin"] ":" $at["link"] : column ~ /^=/ ? $at[substr(column, 2)] : has_names(column) ? $at[column] : short($at[column]) }

function short(text) { return text ~ /^[-+.]*[0-9]/ ? pointed(sprintf("%.12g", text)) : text }

# With a point in every number that has an exponent, as above.
function pointed(text) {
    if (text ~ /^-?[0-9]+e/) sub(/e/, ".0e", text)
    return text
}

function absolute(a) { return a < 0 ? -a : a }

function same(a, b) { return absolute(a - b) <= 1e-9 * (1 + absolute(b)) }
