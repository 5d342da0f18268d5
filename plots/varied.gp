# Natural frequencies against a varied parameter: for every mode a band between the least and the greatest over the positions.
#   gnuplot -c varied.gp frequencies.dat OUT PARAMETER [FIGURE [REMARK]]
# Other parameters and the speed are those of the first row.

load ARG0[1 : strlen(ARG0) - strlen("varied.gp")]."style.gp"
table = ARG1; out = ARG2; parameter = ARG3; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
modes = 0
names = ""
do for [name in columns] { if (name eq sprintf("f%d", modes + 1)) { modes = modes + 1; names = names." ".name } }
range = answer(table, "range".names)
lowest = word(range, 1) + 0.0
others = ""
do for [name in answer(table, "varied")." speed"] {
    if (name ne parameter) { others = others.(others eq "" ? "" : ", ").sprintf("%s = %s", name, word(answer(table, "distinct ".name), 1)) }
}
load keep("bands", table, "band ".parameter)

headline = numbered(figure, sprintf("Natural frequencies against %s, over all crank angles; %s", parameter, others))
note = lowest < 0 ? divergence : ""

eval legend_page(1000, modes)
eval heading
eval value_axis(lowest, word(range, 2) + 0.0)
set tmargin at screen down(125)
set bmargin at screen up(foot(lines_of_notes(note, remark)))
set offsets graph 0, 0, 0.03, 0.03
set style fill transparent solid 0.25 noborder
if (lowest < 0) { eval zero_line }
set xlabel parameter.(value("unit_".parameter) eq "-" ? "" : unit(parameter)) noenhanced
x = value("low_".parameter)
# A single value has a band without width: its ends are drawn as points.
if (value("high_".parameter) == x) { set xrange [x - (x == 0 ? 1 : 0.01*abs(x)) : x + (x == 0 ? 1 : 0.01*abs(x))] }
set ylabel "natural frequency".unit("f1")

plot for [k=1:modes] $bands using 1:(column(2*k)):(column(2*k + 1)) with filledcurves lt k notitle, \
    for [k=1:modes] $bands using 1:(column(2*k)) with linespoints lt k pt 7 ps 0.4 notitle, \
    for [k=1:modes] $bands using 1:(column(2*k + 1)) with linespoints lt k pt 7 ps 0.4 notitle, \
    for [k=1:listed(modes)] keyentry with lines lt k title sprintf("mode %d", k), \
    keyentry title unlisted(modes)
eval close
