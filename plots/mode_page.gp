# What figures and animations of a mode shape share; loaded after `eval answer(table, "facts")`, with mode, crank and speed set.

share = 0.15        # largest displacement drawn, as a share of the longest link
load keep("shape", table, sprintf("shape %d %.12g %.12g", mode, crank, speed))     # columns: see tables.awk
if (|$shape| == 0) {
    print sprintf("%s: no mode %d at crank %.10g, speed %.10g", table, mode, crank, speed)
    exit status 1
}

largest = 0; begun = 0
stats $shape using (frequency = $6, largest = sqrt($3**2 + $4**2) > largest ? sqrt($3**2 + $4**2) : largest, \
    begun == 0 ? (first_x = $1, first_y = $2, begun = 1) : 0, last_x = $1, last_y = $2, 0) nooutput

drawn = share*high_s
scale = largest > 0 ? drawn/largest : 0
size = 0.05*high_s
room = drawn + 0.5*size

headline = numbered(figure, sprintf("%s mode, %#.6g %s, at %s, %s", capital(ordinal(mode)), frequency, unit_frequency, \
    at_crank(crank), at_speed(speed, unit_speed)))
note = sprintf("largest displacement drawn as %.3g %s, %g %% of the longest link", drawn, unit_x, 100*share)
# The frame holds every position in the table, so that its figures can be laid side by side.
mode_page = "eval frame(low_x - room, high_x + room, low_y - room, high_y + room, lines_of_notes(note, remark)); ".\
    "eval heading; set xlabel 'x'.unit('x'); set ylabel 'y'.unit('y'); ".\
    "call plots.'ground.gp' first_x first_y size 1 'clamped'; call plots.'ground.gp' last_x last_y size 11 'pinned'"

# The shape after a part of its swing, and pins, which are where links end, but for the clamped root of the first.
pin(value) = $5 == 1 && ($1 != first_x || $2 != first_y) ? value : NaN
swung_x(part) = $1 + part*scale*$3
swung_y(part) = $2 + part*scale*$4
mode_shape(part) = "plot $shape using 1:2 with lines lw 4 lc rgb faint dt (12,6) title 'undeformed', ".\
    sprintf("$shape using (swung_x(%g)):(swung_y(%g)) with lines lw 6 lc rgb ink dt solid title 'mode shape', ", part, part).\
    "$shape using (pin($1)):2 with points pt 7 ps 2.4 lc rgb 'white' notitle, ".\
    "$shape using (pin($1)):2 with points pt 6 ps 2.4 lw 2.5 lc rgb faint notitle, ".\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 7 ps 2.4 lc rgb 'white' notitle, ", part, part).\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 6 ps 2.4 lw 3.5 lc rgb ink notitle", part, part)
