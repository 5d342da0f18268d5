# One frequency against the crank angle for every speed, and below it the change in percent against the reference speed.
#   gnuplot -c frequency_by_speed.gp frequencies.dat OUT MODE [FIGURE [REMARK]]
# The reference is speed 0 if the table has it, else its first speed.

load ARG0[1 : strlen(ARG0) - strlen("frequency_by_speed.gp")]."style.gp"
table = ARG1; out = ARG2; mode = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
speeds = answer(table, "distinct speed")
n = words(speeds)
reference = word(speeds, 1) + 0
do for [k=1:n] { if (word(speeds, k) + 0 == 0) { reference = 0 } }
name = "f".mode
pick(k, value) = same(field("speed"), word(speeds, k) + 0) ? value : NaN

lowest = value("low_".name)
positions = rows/n
headline = numbered(figure, sprintf("%s natural frequency against crank angle", capital(ordinal(mode))))
note = lowest < 0 ? divergence."; it has no change in percent" : ""
lower = foot(lines_of_notes(note, remark))

eval curve_page(1150)
eval heading
eval crank_axis(low_crank, high_crank)
eval value_axis(lowest, value("high_".name))
set offsets graph 0, 0, 0.04, 0.04
set key title "crank speed ω₂" left
set multiplot

set tmargin at screen down(125)
set bmargin at screen up(lower + 345)
set format x ""
set ylabel sprintf("natural frequency %s%s", name, unit(name)) noenhanced
if (lowest < 0) { eval zero_line }
plot for [k=1:n] table using (field("crank")):(pick(k, field(name))) with lines lt k notitle, \
    for [k=1:n] table using (field("crank")):(pick(k, field(name))) with points lt k pt 7 ps 0.4 notitle, \
    for [k=1:n] table every mark_step(positions)::mark_first(k, n, positions) using (field("crank")):(pick(k, field(name))) \
        with points lt k notitle, \
    for [k=1:n] keyentry with linespoints lt k title sprintf("%.5g %s", word(speeds, k) + 0, unit_speed)

unset label
set tmargin at screen up(lower + 315)
set bmargin at screen up(lower)
set format x "%h"
set xlabel "crank angle θ₂".unit("crank")
set ylabel sprintf("change against\n%.5g %s [%%]", reference, unit_speed)
eval zero_line
unset key
load keep("changes", table, sprintf("change %s %.12g", name, reference))
changed(k) = same(column(1), word(speeds, k) + 0) && column(1) != reference ? column(3) : NaN
highest = 0; lowest = 0
stats $changes using (highest = $3 > highest ? $3 : highest, lowest = $3 < lowest ? $3 : lowest, 0) nooutput
if (highest == lowest) { highest = 1; lowest = -1 }
set yrange [lowest - 0.07*(highest - lowest):highest + 0.07*(highest - lowest)]
set ytics nice((highest - lowest)/5)
set offsets 0, 0, 0, 0
plot for [k=1:n] $changes using 2:(changed(k)) with lines lt k, \
    for [k=1:n] $changes using 2:(changed(k)) with points lt k pt 7 ps 0.4, \
    for [k=1:n] $changes every mark_step(positions)::mark_first(k, n, positions) using 2:(changed(k)) with points lt k
unset multiplot
eval close
