# The mechanism at one position with its numbered lumped masses and their inertia forces.
#   gnuplot -c mechanism.gp inertia.dat OUT CRANK SPEED [mesh.dat [FIGURE [REMARK]]]
# With distributed inertia the table knows the links' mass centres only; their ends are then taken from mesh.dat.

load ARG0[1 : strlen(ARG0) - strlen("mechanism.gp")]."style.gp"
table = ARG1; out = ARG2; crank = ARG3 + 0; speed = ARG4 + 0; mesh = argument(5); figure = argument(6); remark = argument(7)
share = 0.25        # longest arrow drawn, as a share of the mechanism's larger side

eval answer(table, "facts")
load keep("masses", table, sprintf("masses %.12g %.12g", crank, speed))      # columns: see tables.awk
distributed = strstrt(" ".columns." ", " moment ") > 0
if (mesh ne "") { load keep("nodes", mesh, sprintf("nodes %.12g", crank)) }
nodes = mesh eq "" ? "$masses" : "$nodes"
eval measure
pick(value) = same(field("crank"), crank) && same(field("speed"), speed) ? value : NaN

# The frame takes in the arrows' heads.
pinmass(value) = strcol(col_link)[1:4] eq "pin:" ? pick(value) : NaN
stats table using (pick(sqrt(field("Fx")**2 + field("Fy")**2))) name "longest" nooutput
has_pinmass = strstrt(answer(table, "distinct link"), "pin:") > 0
scale = longest_max > 0 ? share*span/longest_max : 0
stats table using (pick(field("x") + scale*field("Fx"))):(field("y") + scale*field("Fy")) name "head" nooutput
least(a, b) = a < b ? a : b
most(a, b) = a > b ? a : b
room = 0.09*span
off = 0.06*span
size = 0.05*span

what = distributed ? "mass centres" : "lumped masses"
headline = numbered(figure, sprintf("Mechanism with %s, at %s", what, at_crank(crank)))
note = longest_max == 0 ? "" : sprintf("arrows: inertia forces −m a at %s; the longest is %.4g %s", \
    at_speed(speed, unit_speed), longest_max, unit_Fx)
moments = ""
if (distributed && longest_max > 0) {
    stats table using (pick(0) == 0 && strcol(col_link)[1:4] ne "pin:" \
        ? (moments = moments.sprintf(", %s %.4g", strcol(col_link), field("moment") + 0.0), 0) : 0) nooutput
    remark = "inertia moments −I α: ".moments[3 : *]." ".unit_moment.(remark eq "" ? "" : "; ").remark
}
eval frame(least(x_min, head_min_x) - room, most(x_max, head_max_x) + room, \
    least(y_min - size, head_min_y) - room, most(y_max, head_max_y) + room, lines_of_notes(note, remark))
eval heading
set xlabel "x".unit("x")
set ylabel "y".unit("y")
call plots."ground.gp" first_x first_y size 1 "pinned"
call plots."ground.gp" last_x last_y size 11 "pinned"

# A part of the plot that is there only when there are such masses: an empty entry would push the legend aside.
pinmass_part = has_pinmass ? "table using (pinmass(field('x'))):(field('y')) ".\
    "with points pt 4 ps 4.6 lw 3 lc rgb '#C04000' title 'pin mass'," : ""

plot nodes using 2:3 with lines lw 5 lc rgb "#707070" dt solid notitle, \
    table using (pick(field("x"))):(field("y")):(scale*field("Fx")):(scale*field("Fy")) \
        with vectors filled size screen 0.012, 20 lw 3 lc rgb force_ink dt solid notitle, \
    nodes using ($6 == 0 || $6 == $7 ? $2 : NaN):3 with points pt 7 ps 3.4 lc rgb "white" notitle, \
    nodes using ($6 == 0 || $6 == $7 ? $2 : NaN):3 with points pt 6 ps 3.4 lw 2.5 lc rgb ink title "pin joint", \
    $masses using 2:3 with points pt 7 ps 1.9 lc rgb ink title distributed ? "mass centre" : "lumped mass", \
    @pinmass_part \
    $masses using (shown(0.09, beside_x(off))):(beside_y(off)):(sprintf("m_{%d}", $1)) with labels font ",19" notitle
eval close
