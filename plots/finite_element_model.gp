# The finite element model at one position: nodes, elements (numbers in square boxes), pins and fixed pivots.

load keep("nodes", table, sprintf("nodes %.12g", crank))       # columns: see tables.awk
nodes = "$nodes"
eval measure
headline = numbered(figure, sprintf("Finite element model, at %s", at_crank(crank)))

note = "hatched wall: clamped to the driving shaft; triangle: pinned to the ground"
if (crowded(0.07) > 1) { note = note."; not every number is shown" }

size = 0.05*span
off = 0.048*span
room = 0.11*span
x0 = x_min - room
x1 = x_max + room
y0 = y_min - room
y1 = y_max + room
load plots."legend.gp"
eval entry_point("pin joint", "pt 6 ps 3.0 lw 2.5 lc rgb ink")
eval entry_point("node", "pt 7 ps 1.5 lc rgb ink")
eval entry_point("element", "pt 4 ps 3 lw 2 lc rgb ink")
length_unit = unit_xa
load plots."frame.gp"
call plots."ground.gp" sprintf("%.12g", first_x) sprintf("%.12g", first_y) size 1 "clamped" sprintf("%.12g", first_angle)
call plots."ground.gp" sprintf("%.12g", last_x) sprintf("%.12g", last_y) size 11 "pinned"

set style textbox opaque margins 0.7, 0.7 fillcolor rgb "white" border rgb "black" linewidth 2
shown_element(value) = $8 > 0 && int($6) % every_nth(0.07) == 0 ? value : NaN
plot nodes using 2:3 with lines lw 5 lc rgb "#505050" dt solid notitle, \
    nodes using (is_pin($2)):3 with points pt 7 ps 3.4 lc rgb "white" notitle, \
    nodes using (is_pin($2)):3 with points pt 6 ps 3.4 lw 2.5 lc rgb ink notitle, \
    nodes using 2:3 with points pt 7 ps 1.5 lc rgb ink notitle, \
    nodes using (shown_element($2 + $4*$9/2)):($3 + $5*$9/2):(sprintf(" %d ", $8)) with labels boxed font ",17" notitle, \
    nodes using (shown(0.07, beside_x(off))):(beside_y(off)):(sprintf("%d", $1)) with labels font ",19" notitle
