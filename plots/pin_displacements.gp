# The displacements of pins at one speed, one component against the other, over a turn.

pins = displaced_pins(table)
n = words(pins)
moved_of(k) = rows_if(table, is_named("point", word(pins, k))." && ".is_at("speed", asked_speed))
x_min = 0.0; x_max = 0.0; y_min = 0.0; y_max = 0.0
do for [k=1:n] {
    stats moved_of(k) using (x_min = lesser(x_min, field("ux")), x_max = larger(x_max, field("ux")), \
        y_min = lesser(y_min, field("uy")), y_max = larger(y_max, field("uy")), 0) nooutput
}
span = larger(x_max - x_min, y_max - y_min)
room = 0.07*span
x0 = x_min - room
x1 = x_max + room
y0 = y_min - room
y1 = y_max + room
headline = numbered(figure, sprintf("Displacements of pins of the elastic linkage, %s", moment))
note = "elastic less rigid linkage, in global axes, over a turn of the crank; circle: at the first crank angle of the table"
load plots."legend.gp"
do for [k=1:n] { eval entry_line(inside(pin_of(word(pins, k)), name_length), sprintf("lt %d", k)) }
length_unit = unit_ux
load plots."frame.gp"
set grid lt 1 lw 1 lc rgb "#D0D0D0" dt solid
eval zero_line
set yzeroaxis lt 1 lw 2 dt solid
set label 905 axis_unit("displacement y", unit_uy)
set xlabel axis_unit("displacement x", unit_ux) noenhanced
positions = rows/words(answer(table, "distinct speed"))/words(names_in(table, "point"))
path_of(k) = moved_of(k)." | awk ".quoted(sprintf("{ if (NF == 0) block++; else print block + 0, $%d, $%d, $%d }", col_crank, col_ux, col_uy)).\
    " | awk -f ".quoted(plots."smooth.awk")
plot for [k=1:n] path_of(k) using 2:3 with lines lt k lw line_width(positions), \
    for [k=1:n] moved_of(k) using (field("ux")):(field("uy")) with points lt k pt 7 ps dot_size(positions), \
    for [k=1:n] moved_of(k) using (field("ux")):(field("uy")) every ::0::0 with points lt k pt 6 ps 2.5 lw 3
