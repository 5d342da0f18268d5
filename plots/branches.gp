# The branches of one speed: frequencies followed by their shapes, against the crank angle, with what befalls them.
#   gnuplot -c branches.gp branches.dat OUT SPEED [FIGURE [REMARK]]
# A branch has the same line at every speed.

load ARG0[1 : strlen(ARG0) - strlen("branches.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load keep("curves", table, sprintf("branches %.12g", speed))       # columns: see tables.awk
load keep("events", table, sprintf("events %.12g", speed))
branches = ""
low = 1e300; high = -1e300
stats $curves using (branches = $4 == 1 ? sprintf("%s %d", branches, $3) : branches, \
    low = $2 < low ? $2 : low, high = $2 > high ? $2 : high, 0) nooutput
n = words(branches)
crossings = 0; veerings = 0; ambiguous = 0
if (|$events| > 0) {
    stats $events using (crossings = crossings + ($1 == 1), veerings = veerings + ($1 == 2), \
        ambiguous = ambiguous + ($1 == 3), 0) nooutput
}

# Dots at the computed positions, unless so near each other that they hide the dashes.
positions = words(answer(table, "distinct crank"))
dotted = positions <= 100

# Beyond the lines there are, a figure begins anew with the first.
line(k) = high_branch <= 16 ? int(word(branches, k)) : k
event(kind, value) = $1 == kind ? value : NaN

headline = numbered(figure, sprintf("Branches of natural frequencies against crank angle, %s", at_speed(speed, unit_speed)))
note = low < 0 ? divergence : ""
told = (veerings > 0 ? "; veering: two branches come near and exchange their shapes" : "").\
    (ambiguous > 0 ? "; ambiguous: shapes do not tell which branch goes on, a new one begins" : "")
if (remark eq "") { remark = told[3 : *] }

named = listed(n + 3) - 3 < n ? listed(n + 3) - 3 : n   # three places are for the marks
eval legend_page(1000, n + (crossings > 0) + (veerings > 0) + (ambiguous > 0))
eval heading
eval crank_axis(low_crank, high_crank)
eval value_axis(low, high)
set tmargin at screen down(125)
set bmargin at screen up(foot(lines_of_notes(note, remark)))
set offsets graph 0, 0, 0.03, 0.03
if (low < 0) { eval zero_line }
set xlabel "crank angle θ₂".unit("crank")
set ylabel "natural frequency".unit("frequency")

# A veering is one mark between its branches; where these stay apart, a bar reaches from the mark to both.
half = 0.026*(high - low)                           # of the mark, in the unit of the frequency
apart(value) = $1 == 2 && $4 - $3 > 2*half ? value : NaN

# Parts of the plot that are there only when there are such events (an empty loop would still bring a warning).
crossing_part = crossings == 0 ? "" : ", $events using 2:(event(1, $3)) with points pt 6 ps 4 lw 4 lc rgb ink title 'crossing'"
veering_part = veerings == 0 ? "" : ", $events using 2:(apart($3)):(0):(($4 - $3)/2 - half) with vectors nohead lw 3 lc rgb ink "\
    ."dt solid notitle, $events using 2:(apart($4)):(0):(half - ($4 - $3)/2) with vectors nohead lw 3 lc rgb ink dt solid "\
    ."notitle, $events using 2:(event(2, ($3 + $4)/2)) with points pt 12 ps 4.5 lw 4 lc rgb ink title 'veering'"
ambiguous_part = ambiguous == 0 ? "" : ", $events using 2:(event(3, $3)) with points pt 2 ps 3 lw 5 lc rgb ink title 'ambiguous'"

plot for [k=1:n] $curves index k-1 using 1:2 with lines lt line(k) notitle, \
    for [k=1:n] $curves index k-1 using 1:(dotted ? $2 : NaN) with points lt line(k) pt 7 ps 0.4 notitle, \
    for [k=1:n] $curves index k-1 using 1:($5 == 1 ? $2 : NaN) with points lt line(k) notitle, \
    for [k=1:named] keyentry with linespoints lt line(k) title "branch ".word(branches, k), \
    keyentry title n > named ? sprintf("… +%d", n - named) : "" \
    @crossing_part @veering_part @ambiguous_part
eval close
