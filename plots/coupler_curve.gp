# The paths of the points of points.dat, and the mechanism at several positions.
#   gnuplot -c coupler_curve.gp points.dat OUT CRANK [balance.dat [FIGURE [REMARK]]]
# The mechanism is drawn as bodies at CRANK; with balance.dat the path of the mass centre is drawn too.

load ARG0[1 : strlen(ARG0) - strlen("coupler_curve.gp")]."style.gp"
table = ARG1; out = ARG2; crank = ARG3 + 0; masses = argument(4); figure = argument(5); remark = argument(6)

eval answer(table, "facts")
low = low_crank
high = high_crank
call plots."linkage.gp" table
set print angles
print sprintf("%.17g", crank)
unset print
load poses_as("there")
eval pivots
shown = $there[1]
turning = turns_fully && high - low >= 240
positions = turning ? 8 : 5
crank_of(k, n) = turning ? crank + 360.0*k/n : low + (high - low)*k/(n - 1.0)

# The paths, with a dot every 10 degrees; the ghosts; the mechanism.
set print angles
do for [k=0:turning ? 360 : 180] { print sprintf("%.17g", turning ? k : low + (high - low)*k/180.0) }
unset print
load poses_as("paths")
dots = turning ? 10 : ceil(10*180/(high - low))
set print angles
do for [k=0:positions - 1] { print sprintf("%.17g", crank_of(k, positions)) }
unset print
load poses_as("ghosts")
centre_of_mass = ""
poses = "$paths"
eval extent
if (masses ne "") {
    eval answer(masses, "facts")
    speed_of_masses = word(answer(masses, "distinct speed"), 1) + 0
    centre_of_mass = ", masses using (same(field('speed'), speed_of_masses) ? field('xG') : NaN):(field('yG')) ".\
        "with lines lw 3 dt (10,5,3,5) lc rgb dark title 'mass centre'"
}
eval answer(table, "facts")
room = 0.08*span
size = 0.05*span
call plots."bodies.gp" sprintf("%g", 0.016*span)

headline = numbered(figure, sprintf("Paths of points, with the mechanism at %s", at_crank(crank)))
note = turning ? sprintf("dots: every %d° of the crank; grey: the mechanism every %g°", dots, 360.0/positions) \
    : "dots: crank angles at equal steps; grey: the mechanism at other positions of its range"
eval frame(x_min - room - 0.4*size, x_max + room, y_min - room - size, y_max + room, lines_of_notes(note, remark))
eval heading
set xlabel "x".unit("x")
set ylabel "y".unit("y")
call plots."ground.gp" O2_x O2_y size 1 "pinned"
call plots."ground.gp" O4_x O4_y size 11 "pinned"

# A ghost is the lines of its links, and of its points to the pins of their links.
line_of(p, q) = sprintf("$corners every ::0::1 using ($1 == 0 ? %.7g : %.7g):($1 == 0 ? %.7g : %.7g) ".\
    "with lines lw 1.5 dt solid lc rgb '#B0B0B0' notitle, ", real(p), real(q), imag(p), imag(q))
rays(p, row) = p > points ? "" : line_of(first_pin(row, point_link[p]), at(row, column_of(p))).\
    line_of(last_pin(row, point_link[p]), at(row, column_of(p))).rays(p + 1, row)
ghost(row) = line_of(O2, at(row, 2)).line_of(at(row, 2), at(row, 4)).line_of(O4, at(row, 4)).rays(1, row)
ghosts = ""
do for [k=1:positions] { if (k > 1 || !turning) { ghosts = ghosts.ghost($ghosts[k]) } }
paths = ""
do for [p=1:points] {
    paths = paths.sprintf("$paths using %d:%d with lines lw 4 dt solid lc rgb '%s' title word(point_names, %d), ", \
        column_of(p), column_of(p) + 1, point_ink(p), p)
    paths = paths.sprintf("$paths every %d using %d:%d with points pt 7 ps 0.9 lc rgb '%s' notitle, ", \
        dots, column_of(p), column_of(p) + 1, point_ink(p))
}
eval "plot ".ghosts.paths.mechanism(shown)."NaN notitle".centre_of_mass
eval close
