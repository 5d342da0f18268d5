# Run time against error of every solver: elements of order 3 at the left, one element of high order a link at the right.
#   gnuplot -c bench_work_precision.gp work_precision.dat OUT LOAD     (static or axial)

load ARG0[1 : strlen(ARG0) - strlen("bench_work_precision.gp")]."style.gp"
load plots."bench_style.gp"
table = ARG1; out = ARG2; loads = argument(3)
eval answer(table, "facts")
deck_title = machine_of(table)
headline = sprintf("Run time of a turn of %d positions against error: %s", high_positions, \
    loads eq "static" ? "at rest" : "with the axial forces at 20 rad/s")
note = "down and to the left is better;  error: largest of f1 to f3 against exact values;  the time is that of a whole run"
remark = "deformation, sweep and accuracy= also estimate the error of every frequency and prove that none is missing"
rows_of(solver, family) = rows_where(table, where_is("load", loads)." && ".where_is("solver", solver)." && ".where_is("family", family))

eval open_page(1800, 1080)
eval heading
set multiplot

# The legend: a plot of its own, as wide as the page.
set tmargin at screen down(110)
set bmargin at screen down(170)
set lmargin at screen across(100)
set rmargin at screen across(1775)
unset border
unset tics
unset grid
set xrange [0:1]
set yrange [0:1]
set key at screen 0.5, down(128) center center horizontal maxrows 1 Left reverse samplen 3 font ",18"
plot NaN notitle, for [k=1:6] keyentry with linespoints lt line_of(k) lw width_of(k) pt mark_of(k) ps 1.7 title heading_of(k)

do for [label=901:904] { unset label label }
unset key
set border 31 lw 1.5
set grid lt 1 lw 1 lc rgb "#D0D0D0" dt solid
set logscale xy
set xrange [2e-16:1e-1]
set yrange [1e-3:1e2]
set xtics out nomirror format "10^{%T}" 100
set ytics out nomirror format "10^{%T}" 10
set mxtics 10
set mytics 10
set xlabel "relative error"
set tmargin at screen down(165)
set bmargin at screen up(foot(2))
do for [panel=1:2] {
    family = panel == 1 ? "meshes" : "orders"
    set lmargin at screen across(panel == 1 ? 150 : 990)
    set rmargin at screen across(panel == 1 ? 930 : 1770)
    set label 910 panel == 1 ? "order 3: 1/4/4 elements (the thesis), then 4, 8 … 64 per link" : "one element per link: order 4, 5 … 16" \
        at graph 0.02, 0.955 noenhanced font ",19"
    if (panel == 1) { set ylabel "run time [s]" } else { unset ylabel; set ytics format "" }
    plot for [k=1:5] rows_of(word(solvers, k), family) using (field("error")):(field("median")) with linespoints \
            lt line_of(k) lw width_of(k) pt mark_of(k) ps 1.7, \
        rows_of("accuracy", "accuracy") using (field("error")):(field("median")) with linespoints \
            lt line_of(6) lw width_of(6) pt mark_of(6) ps 1.6
}
unset multiplot
eval close
