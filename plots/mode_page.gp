# What figures and animations of a mode shape share; loaded after drawing.gp and `eval answer(table, "facts")`, with mode, crank
# and speed set.

share = 0.15        # largest displacement drawn, as a share of the longest link
load keep("shape", table, sprintf("shape %d %.12g %.12g", mode, crank, speed))     # columns: see tables.awk
if (|$shape| == 0) {
    print sprintf("%s: no mode %d at crank %.10g, speed %.10g", table, mode, crank, speed)
    exit status 1
}

furthest = 0; begun = 0; crank_angle = 0
stats $shape using (frequency = $6, furthest = sqrt($3**2 + $4**2) > furthest ? sqrt($3**2 + $4**2) : furthest, \
    begun == 1 && ($1 != first_x || $2 != first_y) ? (crank_angle = arg($1 - first_x + {0, 1}*($2 - first_y)), begun = 2) : 0, \
    begun == 0 ? (first_x = $1, first_y = $2, begun = 1) : 0, last_x = $1, last_y = $2, 0) nooutput

drawn = share*high_s
scale = furthest > 0 ? drawn/furthest : 0
size = 0.05*high_s

headline = numbered(figure, sprintf("%s mode, %#.6g %s, at %s, %s", capital(ordinal(mode)), frequency, unit_frequency, \
    at_crank(crank), at_speed(speed, unit_speed)))
note = sprintf("largest displacement drawn as %.3g %s, %g %% of the longest link", drawn, unit_x, 100*share)

# The frame holds every mode of this position, at all speeds and swinging to both sides, so that figures can be laid side by side.
load keep("reach_of_modes", table, sprintf("reach %.12g %g", crank, share))
stats $reach_of_modes using 1 name "across" nooutput
stats $reach_of_modes using 2 name "up" nooutput
x0 = across_min - 1.4*size
x1 = across_max + 1.4*size
y0 = up_min - 1.8*size
y1 = up_max + 1.4*size

load plots."legend.gp"
undeformed_style = "lw 4 lc rgb '#9A9A9A' dt (12,6)"
shape_style = "lw 6 lc rgb ink dt solid"
eval entry_line("undeformed", undeformed_style)
eval entry_line("mode shape", shape_style)
mode_frame = "length_unit = unit_x; load plots.'frame.gp'; ".\
    "call plots.'ground.gp' sprintf('%.12g', first_x) sprintf('%.12g', first_y) size 1 'clamped' sprintf('%.12g', crank_angle*180/pi); ".\
    "call plots.'ground.gp' sprintf('%.12g', last_x) sprintf('%.12g', last_y) size 11 'pinned'"

# The shape after a part of its swing, and pins, which are where links end, but for the clamped root of the first.
pin(value) = $5 == 1 && ($1 != first_x || $2 != first_y) ? value : NaN
swung_x(part) = $1 + part*scale*$3
swung_y(part) = $2 + part*scale*$4
mode_shape(part) = "plot $shape using 1:2 with lines ".undeformed_style." notitle, ".\
    sprintf("$shape using (swung_x(%g)):(swung_y(%g)) with lines %s notitle, ", part, part, shape_style).\
    "$shape using (pin($1)):2 with points pt 7 ps 2.4 lc rgb 'white' notitle, ".\
    "$shape using (pin($1)):2 with points pt 6 ps 2.4 lw 2.5 lc rgb faint notitle, ".\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 7 ps 2.4 lc rgb 'white' notitle, ", part, part).\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 6 ps 2.4 lw 3.5 lc rgb ink notitle", part, part)
