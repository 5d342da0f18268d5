# The branches of one speed: frequencies followed by their shapes, against the crank angle, with their crossings and veerings.
# A branch has the same line at every speed.

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

positions = words(answer(table, "distinct crank"))

# Beyond the lines there are, a figure begins anew with the first.
line(k) = high_branch <= 16 ? int(word(branches, k)) : k
event(kind, value) = $1 == kind ? value : NaN

headline = numbered(figure, sprintf("Branches of natural frequencies %s, %s", against_position(unit_crank), moment))
note = low < 0 ? divergence : ""
explained = (veerings > 0 ? "; veering: two branches approach, then part with their shapes exchanged" : "").\
    (ambiguous > 0 ? "; ambiguous: shapes do not decide which branch continues, a new one begins" : "")
if (remark eq "") { remark = explained[3 : *] }

# Branches that lie far apart have panels of their own, three at most: the widest gaps that are a tenth of the whole or more
# divide them. Branches in the order of their least frequencies; band: what those up to one of them cover.
array least[n]
array greatest[n]
do for [k=1:n] {
    l = 1e300; g = -1e300
    stats $curves index k-1 using (l = $2 < l ? $2 : l, g = $2 > g ? $2 : g, 0) nooutput
    least[k] = l; greatest[k] = g
}
array rank[n]
do for [k=1:n] {
    place = 1
    do for [m=1:n] { if (least[m] < least[k] || (least[m] == least[k] && m < k)) { place = place + 1 } }
    rank[place] = k
}
array gap_above[n]
covered = least[rank[1]]
do for [i=1:n] {
    covered = larger(covered, greatest[rank[i]])
    gap_above[i] = i < n ? least[rank[i + 1]] - covered : 0
}
widest_gap = 0; second_gap = 0
do for [i=1:n] {
    if (gap_above[i] > widest_gap) { second_gap = widest_gap; widest_gap = gap_above[i] } \
    else { if (gap_above[i] > second_gap) { second_gap = gap_above[i] } }
}
divided = larger(0.1*(high - low), second_gap)
array panel_of[n]
panel = 1
do for [i=1:n] {
    panel_of[rank[i]] = panel
    if (panel < 3 && i < n && gap_above[i] >= divided && high > low) { panel = panel + 1 }
}
panels = panel
from_zero = panels == 1

array low_of[panels]
array high_of[panels]
array entries_of[panels]
most_entries = 0
do for [panel=1:panels] {
    low_of[panel] = 1e300; high_of[panel] = -1e300; entries_of[panel] = 0
    do for [k=1:n] {
        if (panel_of[k] == panel) {
            low_of[panel] = lesser(low_of[panel], least[k])
            high_of[panel] = larger(high_of[panel], greatest[k])
            entries_of[panel] = entries_of[panel] + 1
        }
    }
    most_entries = larger(most_entries, entries_of[panel] + 3)
}

# A veering is a triangle above its gap and one below, for which there must be room; a crossing is an open circle.
roomy(low, high) = veerings > 0 ? 0.07*(high - low) : 0
full_height = panels == 1 ? 750 : panels == 2 ? 420 : 330
gap = 35
lower = foot(lines_of_notes(note, remark))
tick_room = 0
lines = 1
title_of(panel) = value_title("natural frequency", unit_frequency, low_of[panel], high_of[panel])
do for [panel=1:panels] {
    extra = roomy(low_of[panel], high_of[panel])
    if (from_zero && low_of[panel] >= 0 && low_of[panel] < 0.2*high_of[panel]) { high_of[panel] = high_of[panel] + extra } \
    else { low_of[panel] = low_of[panel] - extra; high_of[panel] = high_of[panel] + extra }
    tick_room = larger(tick_room, value_width(low_of[panel], high_of[panel], full_height))
    lines = larger(lines, planned_lines(title_of(panel), full_height))
}
eval legend_page(125 + lower + panels*(full_height + gap) - gap, most_entries, text_width("branch 888", 20), tick_room, lines)
panel_height = (@panel_room - lower + gap)/panels - gap
eval heading
set multiplot
do for [place=1:panels] {
    panel = panels + 1 - place                      # the lowest frequencies are in the lowest panel
    base = lower + (panel - 1)*(panel_height + gap)
    set bmargin at screen up(base)
    set tmargin at screen up(base + panel_height)
    set key at screen across(key_left), up(base + panel_height)
    if (place > 1) { do for [label=901:904] { unset label label } }
    bare = place < panels
    eval crank_axis(low_crank, high_crank)
    bare = 0
    if (place < panels) { set format x ""; set xlabel "" } else { set format x "%h" }
    eval value_axis(low_of[panel], high_of[panel], panel_height)
    eval axis_title(title_of(panel), base, panel_height)

    named = listed(entries_of[panel] + 3) - 3       # three places are for the marks
    named = named < entries_of[panel] ? named : entries_of[panel]
    off = 17.0*(value_top(low_of[panel], high_of[panel]) - value_bottom(low_of[panel], high_of[panel]))/panel_height
    parts = ""
    keys = ""
    count = 0
    do for [k=1:n] {
        if (panel_of[k] == panel) {
            count = count + 1
            parts = parts.sprintf("$curves index %d using 1:2 with lines lt %d lw %g notitle, ", k - 1, line(k), line_width(positions)).\
                sprintf("$curves index %d using 1:2 with points lt %d pt 7 ps %g notitle, ", k - 1, line(k), dot_size(positions)).\
                sprintf("$curves index %d using 1:($5 == 1 ? $2 : NaN) with points lt %d notitle, ", k - 1, line(k))
            if (count <= named) { keys = keys.sprintf(", keyentry with linespoints lt %d title 'branch %s'", line(k), word(branches, k)) }
        }
    }
    if (entries_of[panel] > named) { keys = keys.sprintf(", keyentry title '… +%d'", entries_of[panel] - named) }
    shown(kind, low, high, value) = $1 == kind && low >= low_of[panel] && high <= high_of[panel] ? value : NaN
    if (veerings > 0) {
        parts = parts."$events using 2:(shown(2, $3, $4, $4 + off)) with points pt 11 ps 1.8 lc rgb ink notitle, ".\
            "$events using 2:(shown(2, $3, $4, $3 - off)) with points pt 9 ps 1.8 lc rgb ink notitle, "
        if (place == 1) { keys = keys.", keyentry with points pt 11 ps 1.8 lc rgb ink title 'veering'" }
    }
    if (crossings > 0) {
        parts = parts."$events using 2:(shown(1, $3, $4, $3)) with points pt 6 ps 3 lw 2 lc rgb ink notitle, "
        if (place == 1) { keys = keys.", keyentry with points pt 6 ps 3 lw 2 lc rgb ink title 'crossing'" }
    }
    if (ambiguous > 0) {
        parts = parts."$events using 2:(shown(3, $3, $4, $3)) with points pt 2 ps 2 lw 2.5 lc rgb ink notitle, "
        if (place == 1) { keys = keys.", keyentry with points pt 2 ps 2 lw 2.5 lc rgb ink title 'ambiguous'" }
    }
    eval "plot ".parts."NaN notitle".keys
}
unset multiplot
