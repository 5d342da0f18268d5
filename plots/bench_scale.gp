# What a position costs against the number of four-bars in a chain: the program, and sparse finite elements.
#   gnuplot -c bench_scale.gp scale.dat OUT

load ARG0[1 : strlen(ARG0) - strlen("bench_scale.gp")]."style.gp"
load plots."bench_style.gp"
table = ARG1; out = ARG2
eval answer(table, "facts")
deck_title = machine_of(table)
headline = "Time of a position against the number of four-bars in a chain (3 modes)"

# Solvers of the table, from the slowest of the largest chain on.
names = "elements_16 program_loaded program elements_4"
entry_of(k) = word("'16 elements per stretch, at rest' 'accuracy=1e-8, at 10 rad/s' 'accuracy=1e-8, at rest' '4 elements per stretch, at rest'", k)
pen_of(k) = int(word("3 2 1 4", k))
width_of(k) = k == 3 ? 5 : 3
mark_of(k) = int(word("4 9 7 12", k))
rows_of(k) = rows_where(table, where_is("solver", word(names, k)))

# Least and largest error of a solver, as 3e-8 to 9e-6.
errors_of(name) = system("awk ".quoted(sprintf("!/^#/ && $%d == \"%s\" { e = $%d + 0; if (!n++ || e < low) low = e; if (e > high) high = e } ", \
    value("col_solver"), name, value("col_error"))."END { text = sprintf(\"%.0e to %.0e\", low, high); gsub(/e-0/, \"e-\", text); print text }")." ".quoted(table))
note = "a stretch: between two pins of a link;  36 positions, with what is done once;  every solver starts from the positions before"
remark = "errors of f1 to f3: accuracy=1e-8 ".errors_of("program").", estimated;  4 elements ".errors_of("elements_4").", 16 elements ".errors_of("elements_16")

longest = 0
do for [k=1:words(names)] { longest = larger(longest, text_width(entry_of(k), 20)) }
low = 1e3*value("low_minimum")
high = 1e3*value("high_minimum")
lower = foot(lines_of_notes(note, remark))
eval legend_page(1000, words(names), longest, 80, 1)
eval heading
set tmargin at screen down(125)
set bmargin at screen up(lower)
set logscale xy
set xrange [value("low_stages")/1.3 : value("high_stages")*1.3]
set yrange [0.3*low : 2*high]
set xtics ()
do for [stages in answer(table, "distinct stages")] { set xtics add (stages stages + 0) }
set ytics 10
set mytics 10
set xlabel "four-bars in the chain"
eval axis_title("time of a position [ms]", lower, @panel_room - lower)

# Slopes, below the curves: those of the largest chains.
last = value("high_stages")
first = last/4.0
from = 0.5*low
slope(x, power) = x >= first && x <= last ? from*(x/first)**power : NaN
set samples 500
set label 910 "~ n" at last, slope(last, 1) right offset 0, -0.9 noenhanced font ",18" tc rgb "#606060"
set label 911 "~ n³" at last, slope(last, 3) right offset -2, -0.2 noenhanced font ",18" tc rgb "#606060"
plot for [power in "1 3"] slope(x, power + 0) with lines lt 1 lw 1.5 dt solid lc rgb faint notitle, \
    for [k=1:words(names)] rows_of(k) using (field("stages")):(1e3*field("minimum")) with linespoints \
        lt pen_of(k) lw width_of(k) pt mark_of(k) ps 1.7 title entry_of(k)
eval close
