# All frequencies of one speed against the crank angle.
#   gnuplot -c frequencies.gp frequencies.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("frequencies.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
modes = 0
names = ""
do for [name in columns] { if (name eq sprintf("f%d", modes + 1)) { modes = modes + 1; names = names." ".name } }
range = answer(table, "range".names)
lowest = word(range, 1) + 0.0
pick(name) = same(field("speed"), speed) ? field(name) : NaN

positions = rows/words(answer(table, "distinct speed"))
headline = numbered(figure, sprintf("Natural frequencies against crank angle, %s", at_speed(speed, unit_speed)))
note = lowest < 0 ? divergence : ""

eval legend_page(1000, modes)
eval heading
eval crank_axis(low_crank, high_crank)
eval value_axis(lowest, word(range, 2) + 0.0)
set tmargin at screen down(125)
set bmargin at screen up(foot(lines_of_notes(note, remark)))
set offsets graph 0, 0, 0.03, 0.03
if (lowest < 0) { eval zero_line }
set xlabel "crank angle θ₂".unit("crank")
set ylabel "natural frequency".unit("f1")

plot for [k=1:modes] table using (field("crank")):(pick("f".k)) with lines lt k notitle, \
    for [k=1:modes] table using (field("crank")):(pick("f".k)) with points lt k pt 7 ps 0.4 notitle, \
    for [k=1:modes] table every mark_step(positions)::mark_first(k, modes, positions) using (field("crank")):(pick("f".k)) \
        with points lt k notitle, \
    for [k=1:listed(modes)] keyentry with linespoints lt k title sprintf("mode %d", k), \
    keyentry title unlisted(modes)
eval close
