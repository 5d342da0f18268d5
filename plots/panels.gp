# Panels below one another with one abscissa, each with curves and a legend of its own: call "panels.gp"
# The script sets headline, note and remark; x, the abscissa, and x_axis, its settings, as text; picked, what is true on the rows
# to be drawn; panels, their number, and of each panel axis_of[k] and unit_of[k], its title and unit, curves_of[k], expressions
# without blanks in the columns of a row, and titles_of[k], their titles, each one word or in quotes; source_of(k), the table of
# curve k of every panel. Panels of nothing but zeros are left out, unless all are; those with a logarithmic axis, on which zero and
# what is below have no place (is_logarithmic of style.gp), are left out if nothing is above zero.

# Names by which measured points find their axes: columns, and the title of the panel.
x_names = strstrt(x, "field('") > 0 ? "|".until(behind(x, "field('"), "'")."|" : strstrt(x, "column(") > 0 ? "|".other."|" : "|"
x_unit = x_names eq "|" || !exists("unit_".x_names[2:strlen(x_names) - 1]) ? "" : value("unit_".x_names[2:strlen(x_names) - 1])
columns_in(list, k) = k > words(list) ? "" : (word(list, k)[1:7] eq "field('" ? word(list, k)[8:strlen(word(list, k)) - 2]."|" : "").columns_in(list, k + 1)
y_names(panel) = "|".axis_of[panel]."|".columns_in(curves_of[panel], 1)
measured_in(panel) = measured(1, x_names, x_unit, y_names(panel), unit_of[panel])
array low_of[panels]
array high_of[panels]
kept = ""
longest = 0
drawn_rows = least_rows
do for [panel=1:panels] {
    low = 1e300
    high = -1e300
    do for [k=1:words(curves_of[panel])] {
        expression = sprintf("(%s ? %s : NaN)", picked, word(curves_of[panel], k))
        if (is_logarithmic(panel)) { expression = sprintf("(one = %s, one > 0 ? one : NaN)", expression) }
        found = 0
        eval "stats source_of(k) using (value = ".expression.", low = value < low ? value : low, ".\
            "high = value > high ? value : high, found = found + (value == value), 0) nooutput"
        if (found > drawn_rows) { drawn_rows = found }
    }
    do for [k=1:overlays] {
        if (is_overlaid(k, x_names, x_unit, y_names(panel), unit_of[panel])) {
            stats value(sprintf("overlay_%d", k)) using 2 name "measured" nooutput
            if (low <= high) { low = lesser(low, measured_min); high = larger(high, measured_max) }
        }
    }
    if (low > high) { low = 0; high = 0 }
    if (low != 0 || high != 0) {
        if (also_shown(panel) > high) { high = also_shown(panel) }
        if (also_shown(panel) < low) { low = also_shown(panel) }
        if (also_reached(panel) > high) { high = also_reached(panel) }
        if (shown_low(panel) > low) { low = shown_low(panel) }
        if (shown_high(panel) < high) { high = shown_high(panel) }
    }
    low_of[panel] = low
    high_of[panel] = high
    if (low != 0 || high != 0 || zeros_kept) { kept = kept." ".panel; longest = larger(longest, widest(titles_of[panel], 20)) }
}
if (kept eq "") { do for [panel=1:panels] { kept = kept." ".panel; longest = larger(longest, widest(titles_of[panel], 20)) } }
n_kept = words(kept)
is_drawn(panel) = strstrt(kept." ", sprintf(" %d ", panel)) > 0
eval when_planned
headline = numbered(figure, headline)
lower = foot(lines_of_notes(note, remark))
has_measured(panel) = (sum [k_of=1:overlays] is_overlaid(k_of, x_names, x_unit, y_names(panel), unit_of[panel])) > 0
has_legend(panel) = legend_once || words(curves_of[panel]) >= least_entries || keys_of(panel) ne "" || has_measured(panel)
longest = larger(larger(longest, key_longest), text_width(legend_title, 20) - 80)
do for [panel in kept] { if (has_measured(int(panel))) { longest = larger(longest, measured_width(1, 20)) } }
if ((sum [k_of=1:n_kept] has_legend(int(word(kept, k_of)))) == 0) { legend_entries = 0 }
title_of(panel) = is_logarithmic(panel) ? axis_of[panel].bracketed(typeset(unit_of[panel])) \
    : value_title(axis_of[panel], unit_of[panel], low_of[panel], high_of[panel])

full_height = height_of(n_kept)
tick_room = 0
lines = 1
do for [k=1:n_kept] {
    panel = int(word(kept, k))
    tick_room = larger(tick_room, tick_room_of(panel))
    lines = larger(lines, planned_lines(title_of(panel), planned_height(panel)))
}
eval legend_page(125 + lower + n_kept*(full_height + panel_gap) - panel_gap, legend_entries, longest, tick_room, lines)
even_height = (@panel_room - lower + panel_gap)/n_kept - panel_gap
all_height = n_kept*(even_height + panel_gap) - panel_gap
do for [panel in kept] {
    title_most = lesser(title_most, title_size(title_of(int(panel)), share_of(int(panel))*even_height))
}
eval heading
entry_of(k, panel) = sprintf(", keyentry with linespoints lt %d title word(titles_of[%d], %d)", pen_of(k), panel, k)
entries_from(k, n, panel) = k > listed(n) ? (n > listed(n) ? ", keyentry title unlisted(".n.")" : "") : entry_of(k, panel).entries_from(k + 1, n, panel)
eval begin_panels
if (legend_once) {                                   # beside all panels, which has room for more words than one of them
    panel = int(word(kept, 1))
    if (legend_title ne "") { set key title legend_title left }
    set bmargin at screen up(lower)
    set tmargin at screen up(lower + all_height)
    set key at screen across(key_left), up(lower + all_height)
    unset border
    unset tics
    eval "plot [0:1][0:1] NaN notitle".entries_from(1, words(curves_of[panel]), panel)
    unset key
    set border 31 lw 1.5
    set xtics out nomirror
    set ytics out nomirror
}
is_sampled = drawn_rows >= 6 && drawn_rows <= 180 && (strstrt(x, "'crank'") > 0 || strstrt(x, "'time'") > 0)
drawn_curve(panel, k) = "< awk -f ".quoted(plots."smooth.awk")." ".quoted(out.sprintf(".curve_%d_%d", panel, k))
base = lower + all_height + panel_gap
do for [place=1:n_kept] {
    panel = int(word(kept, place))
    panel_height = share_of(panel)*even_height
    base = base - panel_gap - panel_height
    set bmargin at screen up(base)
    set tmargin at screen up(base + panel_height)
    if (!legend_once) { set key at screen across(key_left), up(base + panel_height) }
    if (place > 1 || legend_once) { do for [label=901:904] { unset label label } }
    n = words(curves_of[panel])
    is_marked = n > 1 || n >= least_entries || legend_once             # a curve alone needs no marks
    parts = ""
    dots = ""
    marks = ""
    do for [k=1:n*has_curves] {
        of_curve = sprintf("source_of(%d) using (%s):(%s ? %s : NaN)", k, x, picked, word(curves_of[panel], k))
        # Between few positions, or instants, the curve is that of smooth.awk.
        if (is_sampled) {
            set table out.sprintf(".curve_%d_%d", panel, k)
            eval sprintf("plot source_of(%d) using (sprintf('%%d %%.12g %%.12g', column(-1), %s, %s ? %s : NaN)) with table", k, x, picked, word(curves_of[panel], k))
            unset table
        }
        on_curve = is_sampled ? sprintf("drawn_curve(%d, %d) using 1:2", panel, k) : of_curve
        parts = parts.sprintf("%s with %s lt %d lw %g notitle, ", on_curve, line_of(panel), pen_of(k), line_width(drawn_rows))
        dots = dots.sprintf("%s with points lt %d pt 7 ps %g notitle, ", of_curve, pen_of(k), \
            !is_marked && few(drawn_rows) ? 0.9 : dot_size(drawn_rows))
        marks = is_marked ? marks.marks_of(k).sprintf(" with points lt %d notitle, ", pen_of(k)) : ""
        if (!in_layers || k == n) { parts = parts.dots.marks; dots = ""; marks = "" }
    }
    bare = place < n_kept
    eval x_axis
    if (bare) { set format x ""; set xlabel "" } else { set format x "%h" }
    bare = 0
    if (is_logarithmic(panel) && low_of[panel] > 0) { eval log_axis(low_of[panel], high_of[panel], panel_height) } else {
        unset logscale y
        eval value_axis(low_of[panel], high_of[panel], panel_height)
    }
    eval before_panel(panel)
    eval axis_title(title_of(panel), base, panel_height)
    eval "plot ".parts_below(panel).parts.parts_above(panel)."NaN notitle".(legend_once || n < least_entries ? "" : entries_from(1, n, panel)).keys_of(panel).measured_in(panel)
}
eval end_panels
