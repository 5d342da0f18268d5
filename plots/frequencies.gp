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
highest = word(range, 2) + 0.0
pick(name) = same(field("speed"), speed) ? field(name) : NaN

positions = rows/words(answer(table, "distinct speed"))
headline = numbered(figure, sprintf("Natural frequencies %s, %s", against_position(unit_crank), at_speed(speed, unit_speed)))
note = lowest < 0 ? divergence : ""

eval page_of_one(modes, text_width(sprintf("mode %d", modes), 20), "natural frequency", unit_f1, lowest, highest)
eval crank_axis(low_crank, high_crank)
plot for [k=1:modes] table using (field("crank")):(pick("f".k)) with lines lt k lw line_width(positions) notitle, \
    for [k=1:modes] table using (field("crank")):(pick("f".k)) with points lt k pt 7 ps dot_size(positions) notitle, \
    for [k=1:modes] table every mark_step(positions)::mark_first(k, modes, positions) using (field("crank")):(pick("f".k)) \
        with points lt k notitle, \
    for [k=1:listed(modes)] keyentry with linespoints lt k title sprintf("mode %d", k), \
    keyentry title unlisted(modes)
eval close
