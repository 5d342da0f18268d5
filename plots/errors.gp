# The estimated relative errors of all frequencies of one speed against the crank angle.
# All speeds share one axis.

numbers = ""                                        # of the modes that the table has
names = ""
do for [name in columns] { if (is_numbered(name, "error")) { numbers = numbers." ".name[6:*]; names = names." ".name } }
modes = words(numbers)
mode(k) = int(word(numbers, k))
range = answer(table, "range".names)
zeros = word(range, 1) + 0.0 <= 0
positive = answer(table, "positive".names)          # empty: all are zero
least = positive eq "" ? 1e-16 : word(positive, 1) + 0.0
greatest = positive eq "" ? 1e-16 : word(positive, 2) + 0.0

# Whole decades, two at least; zero, which has no place on such an axis, lies on its lower edge.
bottom = floor(log10(least)) - zeros
top = ceil(log10(greatest))
if (top - bottom < 2) { top = bottom + 2 }
pick(name) = same(field("speed"), speed) ? (field(name) > 0 ? field(name) : 10.0**bottom) : NaN

positions = rows/words(answer(table, "distinct speed"))
headline = numbered(figure, sprintf("Estimated errors of the natural frequencies %s, %s", against_position(unit_crank), moment))
note = zeros ? "on the lower edge: no error" : ""

lower = foot(lines_of_notes(note, remark))
eval legend_page(1000, modes, text_width(sprintf("mode %d", mode(modes)), 20), 80, 1)
eval heading
eval crank_axis(low_crank, high_crank)
set logscale y
set yrange [10.0**bottom:10.0**top]
set format y "10^{%T}"
set ytics 10.0**ceil((top - bottom)/12.0)
set mytics top - bottom <= 12 ? 10 : 1
set tmargin at screen down(125)
set bmargin at screen up(lower)
eval axis_title("estimated relative error", lower, @panel_room - lower)

plot for [k=1:modes] table using (field("crank")):(pick("error".mode(k))) with lines lt mode(k) lw line_width(positions) notitle, \
    for [k=1:modes] table using (field("crank")):(pick("error".mode(k))) with points lt mode(k) pt 7 ps dot_size(positions) notitle, \
    for [k=1:modes] table every mark_step(positions)::mark_first(k, modes, positions) \
        using (field("crank")):(pick("error".mode(k))) with points lt mode(k) notitle, \
    for [k=1:listed(modes)] keyentry with linespoints lt mode(k) title sprintf("mode %d", mode(k)), \
    keyentry title unlisted(modes)
