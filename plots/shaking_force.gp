# The shaking force of one speed as an arrow's head sees it go round: as given and, from balance.dat, with counterweights.
#   gnuplot -c shaking_force.gp balance.dat|reactions.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("shaking_force.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
balanced = strstrt(" ".columns." ", " balanced_x ") > 0
pick(value) = same(field("speed"), speed) ? value : NaN
greatest = 0
stats table using (value = pick(sqrt(field("shaking_x")**2 + field("shaking_y")**2)), \
    greatest = value > greatest ? value : greatest, value) name "force" nooutput
if (balanced) {
    stats table using (value = pick(sqrt(field("balanced_x")**2 + field("balanced_y")**2)), \
        greatest = value > greatest ? value : greatest, value) name "rest" nooutput
}
ring = nice((greatest > 0 ? greatest : 1)/5)
radius = ring*ceil((greatest > 0 ? greatest : 1)/ring - 0.001)

stats table using (pick(field("shaking_x"))):(field("shaking_y")) name "middle" nooutput

headline = numbered(figure, sprintf("Shaking force, %s", at_speed(speed, unit_speed)))
note = "the force on the frame points from the centre to the curve; numbers: crank angle in degrees"
extent = 1.13*radius
eval open_page(1180, 1150 + (remark ne "" ? 31 : 0))
eval heading
unset border
unset tics
unset grid
set lmargin at screen across(130)
set rmargin at screen across(1050)
set tmargin at screen down(140)
set bmargin at screen down(1060)
set xrange [-extent:extent]
set yrange [-extent:extent]
set size ratio -1
set key at screen 0.5, down(115) center center vertical maxrows 1 Left reverse samplen 2.5 width 2

# Rings and spokes.
do for [k=1:int(radius/ring + 0.5)] {
    set object k circle at 0, 0 size k*ring fs empty border rgb "#C0C0C0" lw 1.5 behind
    set label k sprintf("%g%s", k*ring, k*ring >= radius - 0.5*ring ? " ".typeset(unit_shaking_x) : "") \
        at k*ring*cos(1.309), k*ring*sin(1.309) left offset 0.3, 0.5 font ",16" tc rgb "#606060"
}
do for [k=0:11] {
    set arrow 20 + k from 0, 0 to radius*cos(k*pi/6), radius*sin(k*pi/6) nohead lw 1 lc rgb "#D0D0D0" back
}
set arrow 40 from -radius, 0 to radius, 0 nohead lw 1.5 lc rgb "#909090" back
set arrow 41 from 0, -radius to 0, radius nohead lw 1.5 lc rgb "#909090" back
set label 60 "x" at 1.03*radius, 0 left
set label 61 "y" at 0, 1.03*radius center offset 0, 0.4

# A mark and its crank angle every 30 degrees, the angle outside of the curve and not where another stands.
last_x = 100*radius; last_y = 100*radius; begun = 0; before_x = 0; before_y = 0; off_x = 0; off_y = 0
every_30 = "abs(field('crank')/30 - floor(field('crank')/30 + 0.5)) < 1e-9 && field('crank') < low_crank + 360"
marked(value) = (@every_30) ? pick(value) : NaN
# It stands off at a right angle to the curve.
normal(x, y) = (tx = x - before_x, ty = y - before_y, before_x = x, before_y = y, \
    begun == 0 || (tx == 0 && ty == 0) ? (begun = 1, ty = middle_mean_x - x, tx = y - middle_mean_y) : 0, t = sqrt(tx**2 + ty**2), t = t > 0 ? t : 1, \
    t = ty*(x - middle_mean_x) - tx*(y - middle_mean_y) < 0 ? -t : t, off_x = 0.06*radius*ty/t, off_y = -0.06*radius*tx/t, 0)
far(x, y) = (apart = sqrt((x - last_x)**2 + (y - last_y)**2) > 0.12*radius, \
    last_x = apart ? x : last_x, last_y = apart ? y : last_y, apart)
labelled(x, y) = pick(0) == 0 ? (normal(x, y), @every_30 ? (far(x, y) ? x + off_x : NaN) : NaN) : NaN

balanced_part = !balanced ? "" : ", table using (pick(field('balanced_x'))):(field('balanced_y')) with lines lt 2 notitle, ".\
    "table using (pick(field('balanced_x'))):(field('balanced_y')) every 12 with points lt 2 notitle, ".\
    "keyentry with linespoints lt 2 title 'balanced'"
plot table using (pick(field("shaking_x"))):(field("shaking_y")) with lines lt 1 lw 4 notitle, \
    table using (marked(field("shaking_x"))):(field("shaking_y")) with points lt 1 pt 7 ps 1.2 notitle, \
    table using (labelled(field("shaking_x"), field("shaking_y"))):(field("shaking_y") + off_y): \
        (sprintf("%g", field("crank"))) with labels font ",16" notitle, \
    keyentry with lines lt 1 lw 4 title balanced ? "as given" : "shaking force" @balanced_part
eval close
