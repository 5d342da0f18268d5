# A family of the stress test: true and told errors of every way of solving it, against the parameter.
#   gnuplot -c stress.gp TABLE OUT LABEL HEADLINE [FIGURE [REMARK]]
# A column of points belongs to one case: several positions, speeds and modes. A true error of zero lies on the lower edge.

load ARG0[1 : strlen(ARG0) - strlen("stress.gp")]."style.gp"
table = ARG1; out = ARG2; axis = ARG3; headline = ARG4; figure = argument(5); remark = argument(6)

deck_title = ""
note = "filled: true error against quadruple precision; hollow: the error that the table tells"
variants = system("awk '!/^#/ && $10 == \"bounded\" && !seen[$2]++ { print $2 }' ".table)
n = words(variants)
bottom = 1e-17
of(k) = strcol(2) eq word(variants, k) && strcol(10) eq "bounded"
side(k) = abs(column(1))*(1 + 0.035*(k - 0.5*(n + 1)))     # side by side where points would hide each other

hollow(k) = word("6 8 4 12 10", (k - 1) % 5 + 1) + 0
filled(k) = hollow(k) + 1

eval legend_page(1000, n > 6 ? 2*legend_rows : n)
eval heading
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
# Cases that are only numbered lie side by side.
if (strstrt(axis, "number") == 1) { unset logscale x; set format x "%h"; side(k) = column(1) }
set yrange [bottom:*]
set ytics 100
set mytics 1
set tmargin at screen down(125)
set bmargin at screen up(foot(lines_of_notes(note, remark)))
set xlabel axis
set ylabel "relative error of a frequency"

plot for [k=1:n] table using (of(k) ? side(k) : NaN):(column(7)) with points lt k pt hollow(k) ps 1.4 lw 1.5 notitle, \
    for [k=1:n] table using (of(k) ? side(k) : NaN):(column(6) > bottom ? column(6) : bottom) \
        with points lt k pt filled(k) ps 0.8 notitle, \
    for [k=1:n] keyentry with points lt k pt filled(k) ps 1.3 title word(variants, k)
eval close
