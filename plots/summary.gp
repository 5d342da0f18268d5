# What summary.dat has of every variant against a varied parameter (figure.gp): bands from the least to the greatest value with the mean
# between. Frequencies share a panel, damping ratios too, every other quantity has its own. Other parameters are those of the first row.

load plots."parameter.gp"
note = "bands: least to greatest over the computed positions and speeds, lines: mean".(fixed eq "" ? "" : "; ".fixed[2:*])

# The quantities of every panel: their names in the columns.
is_mean(name) = strlen(name) > 5 && name[strlen(name) - 4 : *] eq "_mean"
frequencies = ""
ratios = ""
others = ""
do for [name in columns] {
    if (is_mean(name)) {
        quantity = name[1 : strlen(name) - 5]
        if (is_numbered(quantity, "f")) { frequencies = frequencies." ".quantity } else {
            if (is_numbered(quantity, "zeta")) { ratios = ratios." ".quantity } else { others = others." ".quantity }
        }
    }
}
array quantities_of[99]
with_blanks(text) = strstrt(text, "_") == 0 ? text : text[1 : strstrt(text, "_") - 1]." ".with_blanks(text[strstrt(text, "_") + 1 : *])
mean_of(k, quantities) = k > words(quantities) ? "" : " ".word(quantities, k)."_mean".mean_of(k + 1, quantities)
panel_of_means(name, quantities, titles) = panel_of(name, value("unit_".word(quantities, 1)."_mean"), fields(mean_of(1, quantities)), titles)
if (words(frequencies) > 0) { quantities_of[declared + 1] = frequencies; added = panel_of_means("natural frequency", frequencies, frequencies) }
if (words(ratios) > 0) { quantities_of[declared + 1] = ratios; added = panel_of_means("damping ratio", ratios, ratios) }
do for [name in others] { quantities_of[declared + 1] = name; added = panel_of_means(with_blanks(name), name, "mean") }

told = (words(frequencies) > 0 ? " 'natural frequency'" : "").(words(ratios) > 0 ? " 'damping ratio'" : "")
do for [name in others] { told = told." '".with_blanks(name)."'" }
enumerated(list, k) = word(list, k).(k == words(list) ? "" : k == words(list) - 1 ? " and " : ", ").(k < words(list) ? enumerated(list, k + 1) : "")
headline = capital(enumerated(told, 1))." against ".meant
source_of(k) = "< awk -v want=".quoted("rows_by ".other)." -f ".quoted(plots."quoted.awk")." -f ".quoted(plots."tables.awk")." < ".quoted(table)

least_of(panel) = (found_least = 1e300, sum [k_of=1:words(quantities_of[panel])] \
    (found_least = lesser(found_least, value("low_".word(quantities_of[panel], k_of)."_least")), 0), found_least)
greatest_of(panel) = (found_greatest = -1e300, sum [k_of=1:words(quantities_of[panel])] \
    (found_greatest = larger(found_greatest, value("high_".word(quantities_of[panel], k_of)."_greatest")), 0), found_greatest)
also_shown(panel) = least_of(panel)
also_reached(panel) = greatest_of(panel)
edge(panel, k, end) = sprintf("source_of(1) using (%s):(field('%s_%s')) with lines lt %d lw 1 notitle, source_of(1) using (%s):(field('%s_%s')) with points lt %d pt 7 ps %g notitle, ", \
    x, word(quantities_of[panel], k), end, k, x, word(quantities_of[panel], k), end, k, dot_size(drawn_rows))
one_band(panel, k) = sprintf("source_of(1) using (%s):(field('%s_least')):(field('%s_greatest')) with filledcurves lt %d notitle, ", \
    x, word(quantities_of[panel], k), word(quantities_of[panel], k), k).edge(panel, k, "least").edge(panel, k, "greatest")
bands(panel, k) = k > words(quantities_of[panel]) ? "" : one_band(panel, k).bands(panel, k + 1)
parts_below(panel) = bands(panel, 1)
