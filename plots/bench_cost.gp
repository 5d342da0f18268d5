# What a position costs each solver, against something.
#   gnuplot -c bench_cost.gp TABLE OUT COLUMN COST HEADLINE XLABEL NOTE [REMARK]
# COLUMN is the abscissa; COST the column of seconds that is drawn.

load ARG0[1 : strlen(ARG0) - strlen("bench_cost.gp")]."style.gp"
load plots."bench_style.gp"
table = ARG1; out = ARG2; name = argument(3); cost = argument(4)
headline = argument(5); note = argument(7); remark = argument(8)
eval answer(table, "facts")
deck_title = machine_of(table)
rows_of(solver) = rows_where(table, where_is("solver", solver))
drawn = ""                                          # the solvers that the table has, by number
do for [k=1:words(solvers)] { if (count_where(table, where_is("solver", word(solvers, k))) > 0) { drawn = drawn." ".k } }

lower = foot(lines_of_notes(note, remark))
longest = 0
do for [k in drawn] { longest = larger(longest, text_width(heading_of(k), 20)) }
eval legend_page(1000, words(drawn), longest, 80, 1)
eval heading
set logscale y
set format y "10^{%T}"
set mytics 10
if (value("high_".name) > 8) {
    set logscale x
    set mxtics 10
    set xrange [value("low_".name)/1.3 : value("high_".name)*1.3]
} else {
    set xtics 1
    set xrange [value("low_".name) - 0.3 : value("high_".name) + 0.3]
}
set tmargin at screen down(125)
set bmargin at screen up(lower)
set xlabel argument(6)
eval axis_title("time of a position [µs]", lower, @panel_room - lower)

plot for [k in drawn] rows_of(word(solvers, k + 0)) using (field(name)):(1e6*field(cost)) with linespoints \
    lt line_of(k) lw width_of(k) pt mark_of(k) ps 1.7 title heading_of(k)
eval close
