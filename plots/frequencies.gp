# All frequencies of one speed against the crank angle.
#   gnuplot -c frequencies.gp frequencies.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("frequencies.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
numbers = ""                                        # of the modes that the table has
names = ""
do for [name in columns] { if (is_numbered(name, "f")) { numbers = numbers." ".name[2:*]; names = names." ".name } }
modes = words(numbers)
mode(k) = int(word(numbers, k))
range = answer(table, "range".names)
lowest = word(range, 1) + 0.0
highest = word(range, 2) + 0.0
pick(name) = same(field("speed"), speed) ? field(name) : NaN

positions = rows/words(answer(table, "distinct speed"))
headline = numbered(figure, sprintf("Natural frequencies %s, %s", against_position(unit_crank), at_speed(speed, unit_speed)))
note = lowest < 0 ? divergence : ""

eval page_of_one(modes, text_width(sprintf("mode %d", mode(modes)), 20), "natural frequency", value("unit_f".mode(1)), lowest, highest)
eval crank_axis(low_crank, high_crank)
plot for [k=1:modes] table using (field("crank")):(pick("f".mode(k))) with lines lt mode(k) lw line_width(positions) notitle, \
    for [k=1:modes] table using (field("crank")):(pick("f".mode(k))) with points lt mode(k) pt 7 ps dot_size(positions) notitle, \
    for [k=1:modes] table every mark_step(positions)::mark_first(k, modes, positions) using (field("crank")):(pick("f".mode(k))) \
        with points lt mode(k) notitle, \
    for [k=1:listed(modes)] keyentry with linespoints lt mode(k) title sprintf("mode %d", mode(k)), \
    keyentry title unlisted(modes)
eval close
