# One frequency, of the mode that is the other argument, against the crank angle for every speed, and below it the change in percent against the
# reference speed: 0 if the table has it, else its first one.

mode = other + 0
name = "f".other
all_names = answer(table, "distinct speed")
reference = word(all_names, 1) + 0
do for [one in all_names] { if (one + 0 == 0) { reference = 0 } }
# Eight of them at most, from the first to the last.
drawn_speeds = int(lesser(8, words(all_names)))
chosen(k) = 1 + (drawn_speeds < 2 ? 0 : int((k - 1)*(words(all_names) - 1)/(drawn_speeds - 1.0) + 0.5))
names = ""
do for [k=1:drawn_speeds] { names = names." ".word(all_names, chosen(k)) }
shown = ""
do for [one in names] {
    shown = shown.sprintf(" '%.5g %s'", one + 0, typeset(unit_speed))
}
headline = capital(ordinal(mode))." natural frequency ".against_position(unit_crank)
note = value("low_".name) < 0 ? divergence."; it has no change in percent" : ""
if (drawn_speeds < words(all_names)) { remark = sprintf("%d of %d speeds", drawn_speeds, words(all_names)).(remark eq "" ? "" : "; ".remark) }
load keep("rows", table, "rows all speed")
load keep("changes", table, sprintf("change %s %.12g", name, reference))
source_of(k) = panel == 1 ? sprintf("$rows%d", chosen(k)) : "$changes"
x = "(panel == 1 ? field('crank') : $2)"
changed(k) = same(column(1), word(names, k) + 0) && column(1) != reference ? column(3) : NaN
changes_from(k) = k > words(names) ? "" : sprintf(" changed(%d)", k).changes_from(k + 1)
added = panel_of(sprintf("natural frequency f%d", mode), value("unit_".name), each(fields(name)[2:*]), shown)
added = panel_of(sprintf("change against %.5g %s", reference, typeset(unit_speed)), "%", changes_from(1), shown)
also_shown(panel) = panel == 2 ? 0 : NaN
also_reached(panel) = panel == 2 ? 0 : NaN
before_panel(panel) = panel == 2 ? zero_line : ""
share_of(panel) = panel == 1 ? 1.28 : 0.72
height_of(n) = 0.5*(995 - lower)
planned_height(panel) = panel == 1 ? 500 : 280
panel_gap = 30.0
in_layers = 1
zeros_kept = 1
legend_once = 1
legend_title = speed_name
legend_entries = words(names) + 1
