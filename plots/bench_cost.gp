# What a position costs each solver, against something: curves, or bars where it has three values or fewer.
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
values = answer(table, "distinct ".name)
bars = words(values) <= 3
longest = widest(values, 20) + text_width(argument(6).": ", 20)
do for [k in drawn] { longest = larger(longest, text_width(heading_of(k), 20)) }
low = 1e6*value("low_".cost)
high = 1e6*value("high_".cost)
lower = foot(lines_of_notes(note, remark))
eval legend_page(1000, bars ? words(values) : words(drawn), longest, bars ? value_width(0, high, 700) : 80, 1)
eval heading
set tmargin at screen down(125)
set bmargin at screen up(lower)

if (bars) {
    # A block of rows: solver, then its time for each value.
    set print $bars
    do for [k in drawn] {
        line = k
        do for [v in values] {
            time = NaN
            stats table using (strcol(col_solver) eq word(solvers, k + 0) && same(field(name), v + 0) \
                ? (time = 1e6*field(cost), 0) : 0) nooutput
            line = line.sprintf(" %.9g", time)
        }
        print line
    }
    unset print
    eval value_axis(0, high, @panel_room - lower)
    eval axis_title(value_title("time of a position", "µs", 0, high), lower, @panel_room - lower)
    set style fill solid 1 border rgb ink
    width = 0.8/words(values)
    set boxwidth 0.92*width
    set grid noxtics
    set xrange [-0.6:words(drawn) - 0.4]
    set xtics () scale 0
    do for [k=1:words(drawn)] { set xtics add (heading_of(word(drawn, k)) k - 1) }
    shade(v) = word("#303030 #8FB8DE #C9C9C9", v)
    plot for [v=1:words(values)] $bars using (column(0) + (v - 0.5*(words(values) + 1))*width):(column(v + 1)) \
        with boxes lt 1 lw 1 fc rgb shade(v) title argument(6).": ".word(values, v)
} else {
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
    set xlabel argument(6)
    eval axis_title("time of a position [µs]", lower, @panel_room - lower)
    plot for [k in drawn] rows_of(word(solvers, k + 0)) using (field(name)):(1e6*field(cost)) with linespoints \
        lt line_of(k) lw width_of(k) pt mark_of(k) ps 1.7 title heading_of(k)
}
eval close
