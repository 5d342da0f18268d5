# Panels below one another with one abscissa, each with curves and a legend of its own: call "panels.gp"
# The script sets source_of(k), the table of curve k, headline, note, remark; picked, an expression that is true on the rows to be drawn; x, the abscissa,
# and x_axis, its settings; panels, their number; axis_of[k], the label of panel k; curves_of[k], expressions without blanks
# in the columns of a row; titles_of[k], their titles in quotes.

panel_height = 330
panel_gap = 35
lower = foot(lines_of_notes(note, remark))
eval legend_page(125 + lower + panels*(panel_height + panel_gap) - panel_gap, 1)
eval heading
set offsets graph 0, 0, 0.06, 0.06
set multiplot
do for [panel=1:panels] {
    base = lower + (panels - panel)*(panel_height + panel_gap)
    set bmargin at screen up(base)
    set tmargin at screen up(base + panel_height)
    set key at screen across(1305), up(base + panel_height)
    if (panel > 1) { do for [label=901:904] { unset label label } }
    set ylabel axis_of[panel]

    n = words(curves_of[panel])
    set xrange [*:*]                                # stats would leave out what lies beyond
    set yrange [*:*]
    low = 1e300
    high = -1e300
    drawn_rows = 0
    parts = ""
    keys = ""
    do for [k=1:n] {
        expression = sprintf("(%s ? %s : NaN)", picked, word(curves_of[panel], k))
        eval "stats source_of(k) using (value = ".expression.", low = value < low ? value : low, high = value > high ? value : high, ".\
            "value) name 'curve' nooutput"
        drawn_rows = curve_records
        of_curve = sprintf("source_of(%d) using (%s):%s", k, x, expression)
        parts = parts.sprintf("%s with lines lt %d notitle, %s with points lt %d pt 7 ps %g notitle, ", of_curve, k, of_curve, k, \
            drawn_rows <= 150 ? 0.4 : 0.1)
        parts = parts.sprintf("source_of(%d) every %d::%d using (%s):%s with points lt %d notitle, ", \
            k, mark_step(drawn_rows), mark_first(k, n, drawn_rows), x, expression, k)
        keys = keys.sprintf(", keyentry with linespoints lt %d title \"%s\"", k, word(titles_of[panel], k))
    }
    eval x_axis
    if (panel < panels) { set format x ""; set xlabel "" } else { set format x "%h" }
    eval value_axis(low, high)
    if (low >= 0 && low < 0.5*high) { set yrange [0:*] }
    if (low < 0 && high > 0) { eval zero_line } else { unset xzeroaxis }
    eval "plot ".parts."NaN notitle".keys
}
unset multiplot
