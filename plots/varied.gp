# Natural frequencies against a varied parameter: for every mode a band between the least and the greatest over the positions.
# Other parameters and the speed are those of the first row.

load plots."parameter.gp"
eval frequencies_of_table
headline = "Natural frequencies against ".meant
note = "bands: least to greatest over the computed crank angles;  ".at_speed(word(answer(table, "distinct speed"), 1) + 0, unit_speed).fixed
if (lowest < 0 && remark eq "") { remark = divergence }
load keep("bands", table, "band ".other)
source_of(k) = "$bands"
x = "$1"
modes = words(drawn)
edges(k) = k > 2*modes ? "" : sprintf(" column(%d)", k > modes ? 2*(k - modes) + 1 : 2*k).edges(k + 1)
added = panel_of("natural frequency", value("unit_".word(drawn, 1)), edges(1), shown)
pen_of(k) = int(word(drawn, (k - 1)%modes + 1)[2:*])
marks_of(k) = "NaN"
band_of(k) = k > modes ? "" : sprintf("$bands using 1:(column(%d)):(column(%d)) with filledcurves lt %d notitle, ", 2*k, 2*k + 1, pen_of(k)).band_of(k + 1)
parts_below(panel) = band_of(1)
least_entries = 1000
keys_of(panel) = key_of(1).(modes > listed(modes) ? ", keyentry title unlisted(modes)" : "")
key_of(k) = k > listed(modes) ? "" : sprintf(", keyentry with lines lt %d title word(shown, %d)", pen_of(k), k).key_of(k + 1)
