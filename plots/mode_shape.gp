# A mode shape over the undeformed mechanism.
#   gnuplot -c mode_shape.gp shapes.dat OUT MODE CRANK SPEED [FIGURE [REMARK]]
# OUT has no extension (here and in all scripts); FIGURE is a number for the title, REMARK a line at the foot.

load ARG0[1 : strlen(ARG0) - strlen("mode_shape.gp")]."style.gp"
table = ARG1; out = ARG2; mode = ARG3 + 0; crank = ARG4 + 0; speed = ARG5 + 0; figure = argument(6); remark = argument(7)
share = 0.15        # largest displacement drawn, as a share of the longest link

eval answer(table, "facts")
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
eval frame(low_x - room, high_x + room, low_y - room, high_y + room, lines_of_notes(note, remark))
eval heading
set xlabel "x".unit("x")
set ylabel "y".unit("y")

call plots."ground.gp" first_x first_y size 1 "clamped"
call plots."ground.gp" last_x last_y size 11 "pinned"

# Pins are where links end, but for the clamped root of the first.
pin(value) = $5 == 1 && ($1 != first_x || $2 != first_y) ? value : NaN
plot $shape using 1:2 with lines lw 4 lc rgb faint dt (12,6) title "undeformed", \
    $shape using ($1 + scale*$3):($2 + scale*$4) with lines lw 6 lc rgb ink dt solid title "mode shape", \
    $shape using (pin($1)):2 with points pt 7 ps 2.4 lc rgb "white" notitle, \
    $shape using (pin($1)):2 with points pt 6 ps 2.4 lw 2.5 lc rgb faint notitle, \
    $shape using (pin($1 + scale*$3)):($2 + scale*$4) with points pt 7 ps 2.4 lc rgb "white" notitle, \
    $shape using (pin($1 + scale*$3)):($2 + scale*$4) with points pt 6 ps 2.4 lw 3.5 lc rgb ink notitle
eval close
