# The paths of the points of points.dat, and the mechanism at one position.
# The mechanism is drawn as bodies at CRANK; with balance.dat the path of the mass centre is drawn too.

low = low_crank
high = high_crank
call plots."linkage.gp" table
eval pose_at("there", crank)
shown_row = $there[1]

# The paths, over a turn or over the range of the table, with small dots, large ones, and angles beside some of these.
turning = turns_fully && high - low >= 240
first = turning ? 0.0 : 1.0*low
last = turning ? 360.0 : 1.0*high
range = last - first
small = range > 150 ? 10.0 : range > 60 ? 5.0 : range > 24 ? 2.0 : nice(range/30)
large = small*(small == 10 || small == 5 ? 3 : 5)
tenth = small/10
first_tenth = int(ceil(first/tenth - 1e-6))
rows_of_path = int(floor(last/tenth + 1e-6)) - first_tenth
row_of(multiple) = int(floor(ceil(first_tenth*tenth/multiple - 1e-6)*multiple/tenth + 0.5)) - first_tenth       # its first one, from 0
set print angles
do for [k=0:rows_of_path] { print sprintf("%.17g", (first_tenth + k)*tenth) }
unset print
load poses_as("paths")
poses = "$there"
eval extent
do for [p=1:points] { stats $paths using (include(column(column_of(p)), column(column_of(p) + 1))) nooutput }
span = larger(x_max - x_min, y_max - y_min)

has_masses = other ne ""
if (has_masses) {
    speed_of_masses = word(answer(other, "distinct speed"), 1)
    load keep("masses", other, "path ".speed_of_masses." xG yG")
    stats $masses using (include($1, $2)) nooutput
    stats $masses using ($4 == 1 && abs($3 - crank) < 1e-6 ? (mass_x = $1, mass_y = $2, 1) : 0) nooutput
    if (!exists("mass_x")) { stats $masses using (mass_x = $1, mass_y = $2, 1) nooutput }
}
room = 0.09*span
size = 0.05*span
call plots."bodies.gp" sprintf("%g", 0.014*span)
x0 = x_min - room - 0.4*size
x1 = x_max + room
y0 = y_min - room - size
y1 = y_max + room

headline = numbered(figure, sprintf("Paths of points, with the mechanism at %s", at_crank(crank)))
note = sprintf("small dots: every %g° of the crank, large ones every %g°; numbers: crank angle θ₂", small, large)
load plots."legend.gp"
path_style(p) = sprintf("lw 4 dt solid lc rgb '%s'", point_ink(p))
mass_style = "lw 2.5 dt solid lc rgb '#333333'"
do for [p=1:points] { eval entry_line(short_name(point_names, p), path_style(p)) }
if (has_masses) { eval entry_line("mass centre of the mechanism", mass_style) }
length_unit = unit_x
load plots."frame.gp"
eval fixed_pivots(size).ground_hooks(size)

# Numbers keep clear of the paths, of pins and of each other. Two dots at one place, on a path that is gone to and fro, have one.
set print places
print sprintf("page %g %g %g %g", box_left + 4, box_left + box_width - 4, box_bottom + 4, box_bottom + box_height - 4)
do for [p=1:points] {
    print "curve"
    do for [k=1:|$paths|:2] {
        print sprintf("curve %.6g %.6g", page_x(word($paths[k], column_of(p)) + 0), page_y(word($paths[k], column_of(p) + 1) + 0))
    }
}
if (has_masses) {
    print "curve"
    do for [k=1:|$masses|:2] {
        if (words($masses[k]) == 4) {
            print sprintf("curve %.6g %.6g", page_x(word($masses[k], 1) + 0), page_y(word($masses[k], 2) + 0))
        }
    }
}
print_way(p, q) = sprintf("curve\ncurve %.6g %.6g\ncurve %.6g %.6g", \
    page_x(real(p)), page_y(imag(p)), page_x(real(q)), page_y(imag(q)))
do for [link=2:4] { print print_way(first_pin(shown_row, link), last_pin(shown_row, link)) }
do for [p=1:points] {
    print print_way(first_pin(shown_row, point_link[p]), at(shown_row, column_of(p)))
    print print_way(last_pin(shown_row, point_link[p]), at(shown_row, column_of(p)))
}
box_at(z) = sprintf("box %.6g %.6g 40 40", page_x(real(z)), page_y(imag(z)))
print box_at(O2)
print box_at(O4)
print box_at(at(shown_row, 2))
print box_at(at(shown_row, 4))
do for [p=1:points] { print box_at(at(shown_row, column_of(p))) }
do for [k=1:hooks] { print box_at(hook_x[k] + I*hook_y[k]) }
do for [p=1:points] {
    do for [k=row_of(2*large):turning ? rows_of_path - 1 : rows_of_path:int(2*large/tenth + 0.5)] {
        angle = word($paths[k + 1], 1) + 0
        z = at($paths[k + 1], column_of(p))
        text = minus(sprintf("%.4g°", angle))
        print sprintf("label %.6g %.6g 12 %.4g %.4g 45 %s", page_x(real(z)), page_y(imag(z)), text_width(text, 15), text_height(15), \
            sprintf("%d %s", p, text))
    }
}
unset print
load labels_as("numbers")

# A path that is short on the page has large dots only.
steps_apart(p) = sum [k=1:rows_of_path] pixel*abs(at($paths[k + 1], column_of(p)) - at($paths[k], column_of(p)))*10/rows_of_path
halos = ""
paths = ""
if (has_masses) {
    halos = "$masses using 1:2 with lines lw 6 dt solid lc rgb 'white' notitle, "
    paths = "$masses using 1:2 with lines ".mass_style." notitle, ".\
        sprintf("'+' using (%.9g):(%.9g) every ::0::0 with points pt 7 ps 2.2 lc rgb 'white' notitle, ", mass_x, mass_y).\
        sprintf("'+' using (%.9g):(%.9g) every ::0::0 with points pt 6 ps 2.2 lw 2.5 lc rgb '#333333' notitle, ", mass_x, mass_y).\
        sprintf("'+' using (%.9g):(%.9g) every ::0::0 with points pt 1 ps 2.2 lw 2.5 lc rgb '#333333' notitle, ", mass_x, mass_y)
}
do for [p=1:points] {
    columns_of_path = sprintf("%d:%d", column_of(p), column_of(p) + 1)
    halos = halos."$paths using ".columns_of_path." with lines lw 9 dt solid lc rgb 'white' notitle, "
    paths = paths."$paths using ".columns_of_path." with lines ".path_style(p)." notitle, ".\
        (steps_apart(p) < 14 ? "" : sprintf("$paths every 10::%d using %s with points pt 7 ps 0.8 lc rgb '%s' notitle, ", \
            row_of(small), columns_of_path, point_ink(p))).\
        sprintf("$paths every %d::%d using %s with points pt 7 ps 1.5 lc rgb '%s' notitle, ", int(large/tenth + 0.5), row_of(large), \
            columns_of_path, point_ink(p))
}
# A label begins with the number of its point.
text_behind(label) = label[strstrt(label, " ") + 1 : *]
ink_before(label) = int("0x".point_ink(int(label))[2:*])
eval "plot ".mechanism_below(shown_row).springs_of(shown_row).halos.paths.mechanism_pins(shown_row).\
    "$numbers using ($5 == 1 ? unscaled_x($3) : NaN):(unscaled_y($4)):".\
    "(unscaled_x($7) - unscaled_x($3)):(unscaled_y($8) - unscaled_y($4)) ".\
    "with vectors nohead lw 1 dt solid lc rgb '#808080' notitle, ".\
    "$numbers using (unscaled_x($1)):(unscaled_y($2)):(text_behind(strcol(6))):(ink_before(strcol(6))) ".\
    "with labels tc rgb variable noenhanced font point_size(15) notitle"
