# One frequency against the crank angle for every speed, and below it the change in percent against the reference speed.
# The reference is speed 0 if the table has it, else its first speed.

mode = other + 0
speeds = answer(table, "distinct speed")
n = words(speeds)
reference = word(speeds, 1) + 0
do for [k=1:n] { if (word(speeds, k) + 0 == 0) { reference = 0 } }
name = "f".mode
pick(k, value) = same(field("speed"), word(speeds, k) + 0) ? value : NaN

lowest = value("low_".name)
highest = value("high_".name)
positions = rows/n
headline = numbered(figure, capital(ordinal(mode))." natural frequency ".against_position(unit_crank))
note = lowest < 0 ? divergence."; it has no change in percent" : ""
lower = foot(lines_of_notes(note, remark))
speed_text(k) = sprintf("%.5g %s", word(speeds, k) + 0, typeset(unit_speed))

load keep("changes", table, sprintf("change %s %.12g", name, reference))
changed(k) = same(column(1), word(speeds, k) + 0) && column(1) != reference ? column(3) : NaN
most = 0.0; least = 0.0
stats $changes using (most = $3 > most ? $3 : most, least = $3 < least ? $3 : least, 0) nooutput

longest = 0
do for [k=1:n] { longest = larger(longest, text_width(speed_text(k), 20)) }
title_above = value_title(sprintf("natural frequency f%d", mode), value("unit_".name), lowest, highest)
title_below = sprintf("change against %.5g %s [%s]", reference, typeset(unit_speed), unit_and_power("%", value_power(least, most)))
eval legend_page(1150, n + 1, longest, larger(value_width(lowest, highest, 500), value_width(least, most, 280)), \
    larger(planned_lines(title_above, 500), planned_lines(title_below, 280)))
eval heading
bare = 1
eval crank_axis(low_crank, high_crank)
bare = 0
set key title speed_name left
gap = 30
below = 0.36*(@panel_room - lower - gap)            # the height of the lower panel
above = @panel_room - lower - gap - below
set multiplot

set tmargin at screen up(lower + below + gap + above)
set bmargin at screen up(lower + below + gap)
set format x ""
set xlabel ""
eval value_axis(lowest, highest, above)
eval axis_title(title_above, lower + below + gap, above)
plot for [k=1:n] table using (field("crank")):(pick(k, field(name))) with lines lt k lw line_width(positions) notitle, \
    for [k=1:n] table using (field("crank")):(pick(k, field(name))) with points lt k pt 7 ps dot_size(positions) notitle, \
    for [k=1:n] table every mark_step(positions)::mark_first(k, n, positions) using (field("crank")):(pick(k, field(name))) \
        with points lt k notitle, \
    for [k=1:n] keyentry with linespoints lt k title speed_text(k)

unset label
set tmargin at screen up(lower + below)
set bmargin at screen up(lower)
set format x "%h"
unset key
eval crank_axis(low_crank, high_crank)
eval value_axis(least, most, below)
eval zero_line
eval axis_title(title_below, lower, below)
plot for [k=1:n] $changes using 2:(changed(k)) with lines lt k lw line_width(positions), \
    for [k=1:n] $changes using 2:(changed(k)) with points lt k pt 7 ps dot_size(positions), \
    for [k=1:n] $changes every mark_step(positions)::mark_first(k, n, positions) using 2:(changed(k)) with points lt k
unset multiplot
