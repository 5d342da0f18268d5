# The paths of points at one speed, with rigid and with elastic links, deviations made larger, and the mechanism at one position.

want_positions = 0
load plots."deformed.gp"
# The position nearest to 60 degrees.
shown_row = $poses[1]
best = 1e9
do for [k=1:positions_drawn] {
    angle = word($moved[k], 1) - 360*floor(word($moved[k], 1)/360.0)
    if (abs(angle - 60) < best - 1e-9) { best = abs(angle - 60); shown_row = $poses[k]; shown_angle = word($moved[k], 1) + 0 }
}

x_min = lesser(O2_x, O4_x); x_max = larger(O2_x, O4_x); y_min = lesser(O2_y, O4_y); y_max = larger(O2_y, O4_y)
do for [k=2:4:2] { place = at(shown_row, k); place = include(real(place), imag(place)) }
do for [k=1:positions_drawn] {
    do for [p=1:points] {
        place = at($poses[k], column_of(p)); place = include(real(place), imag(place))
        place = point_moved($poses[k], $moved[k], p); place = include(real(place), imag(place))
    }
}
span = larger(x_max - x_min, y_max - y_min)
room = 0.07*span
size = 0.05*span
call plots."bodies.gp" sprintf("%g", 0.014*span)
x0 = x_min - room - 0.4*size
x1 = x_max + room
y0 = lesser(y_min, lesser(O2_y, O4_y) - 1.2*size) - room
y1 = y_max + room

# A row for each position: the places of the points.
set print $paths
do for [k=1:positions_drawn + turns_fully] {
    row = k > positions_drawn ? 1 : k
    line = word($moved[row], 1)
    do for [p=1:points] {
        place = point_moved($poses[row], $moved[row], p)
        line = line.sprintf(" %.9g %.9g", real(place), imag(place))
    }
    print line
}
unset print
set print angles
first = turns_fully ? 0.0 : low_crank
last = turns_fully ? 360.0 : high_crank
do for [k=0:360] { print sprintf("%.17g", first + k*(last - first)/360) }
unset print
load poses_as("rigid_paths")

headline = numbered(figure, sprintf("Paths of points of the elastic linkage, %s", moment))
every_stick = int(ceil(positions_drawn/72.0))
note = magnified_text."; thin lines lead there from the places with rigid links"
remark = sprintf("the mechanism: with rigid links, at %s", at_crank(shown_angle)).(remark eq "" ? "" : "; ".remark)
load plots."legend.gp"
rigid_path = "lw 3 dt (10,5) lc rgb '#707070'"
eval entry_line("rigid links", rigid_path)
do for [p=1:points] {
    eval entry_line(short_name(point_names, p).", elastic links", sprintf("lw 3 dt solid lc rgb '%s'", point_ink(p)))
}
length_unit = unit_ux
load plots."frame.gp"
eval fixed_pivots(size)

# The axes of thin lines: from the places with rigid links to those with elastic ones.
set print $sticks
do for [k=1:positions_drawn:every_stick] {
    line = ""
    do for [p=1:points] {
        place = at($poses[k], column_of(p))
        way_there = point_moved($poses[k], $moved[k], p) - place
        line = line.sprintf(" %.9g %.9g %.9g %.9g", real(place), imag(place), real(way_there), imag(way_there))
    }
    print line
}
unset print
parts = ""
do for [p=1:points] {
    parts = parts.sprintf("$rigid_paths using %d:%d with lines %s notitle, ", column_of(p), column_of(p) + 1, rigid_path)
}
do for [p=1:points] {
    parts = parts.sprintf("$sticks using %d:%d:%d:%d with vectors nohead lw 1.5 dt solid lc rgb '%s' notitle, ", \
        4*p - 3, 4*p - 2, 4*p - 1, 4*p, point_ink(p))
    parts = parts.sprintf("$paths using %d:%d with lines lw %g dt solid lc rgb '%s' notitle, ", 2*p, 2*p + 1, \
        line_width(positions_drawn), point_ink(p))
    parts = parts.sprintf("$paths using %d:%d with points pt 7 ps %g lc rgb '%s' notitle, ", 2*p, 2*p + 1, \
        dot_size(positions_drawn), point_ink(p))
}
pale_shape(link) = shape(shown_row, link, half_width + 0.8*rim, "#8C8C8C").shape(shown_row, link, half_width, pale(link))
eval "plot ".pale_shape(4).pale_shape(3).pale_shape(2).parts.mechanism_pins(shown_row)."NaN notitle"
