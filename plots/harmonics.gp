# The harmonics of shaking force, shaking moment and driving torque of one speed, as given and with counterweights, as bars.

linkages = answer(table, "distinct linkage")
harmonics = 0
do for [name in columns] { if (name eq sprintf("h%d", harmonics + 1)) { harmonics = harmonics + 1 } }
named(name) = name eq "shaking_x" ? "shaking force x" : name eq "shaking_y" ? "shaking force y" \
    : name eq "shaking_force" ? "shaking force" : name eq "shaking_moment" ? "shaking moment" \
    : name eq "torque" ? "driving torque" : name
is_force(name) = strstrt(name, "force") > 0 || name eq "shaking_x" || name eq "shaking_y"
unit_in_notes(what) = system(sprintf("sed -n 's/^# *forces in \\(.*\\), moments and torques in \\(.*\\), phases in .*/\\%d/p' ", what).quoted(table))

# Loads by tables may repeat after several turns only.
turns = system("sed -n 's/^# *over a cycle of \\([0-9]*\\) turns of the crank.*/\\1/p' ".quoted(table))
turns = turns eq "" ? "1" : turns
headline = sprintf("Harmonics over %s%s, %s", turns eq "1" ? "a turn" : turns." turns", of_cycle ? "" : " of the crank", moment)
note = (of_cycle ? "amplitudes of harmonics k of the ".(turns eq "1" ? "turn" : "cycle") : "amplitudes of cos(k θ₂".(turns eq "1" ? "" : "/".turns)." + phase)").\
    "; the mean is not shown"

# Of every quantity a block of rows: harmonic, then its amplitude for each of the linkages.
amplitudes(quantity) = "< awk ".quoted(sprintf("$%d == \"%s\" && ($%d - %s)^2 <= 1e-18*(1 + $%d^2) ", col_quantity, quantity, col_speed, asked_speed, col_speed).\
    sprintf("{ for (i = 1; i <= %d; i++) amplitude[$%d, i] = $(%d + i) } ", harmonics, col_linkage, col_h1 - 1).\
    sprintf("END { for (i = 1; i <= %d; i++) printf \"%%d %%.17g %%.17g\\n\", i, amplitude[\"%s\", i], amplitude[\"%s\", i] }", \
        harmonics, word(linkages, 1), word(linkages, words(linkages))))." ".quoted(table)
# The magnitude of the shaking force is no harmonic motion of anything: its components are drawn.
quantities = ""
do for [name in answer(table, "distinct quantity")] { if (name ne "shaking_force") { quantities = quantities." ".name } }
source_of(k) = amplitudes(word(quantities, panel))
picked = "1"
x = "$1"
do for [name in quantities] {
    added = panel_of(named(name), unit_in_notes(is_force(name) ? 1 : 2), words(linkages) == 1 ? "$2" : "$2 $3", linkages)
}
height_of(n) = 235
has_curves = 0
least_entries = 99
also_shown(panel) = 0
bar(k, away, shade) = sprintf("source_of(%d) using ($1 + %g):%d with boxes lt 1 lw 1 fc rgb '%s'", k, away, k + 1, shade)
parts_above(panel) = (words(linkages) == 1 ? bar(1, 0, "#303030")." notitle, " \
    : bar(1, -0.19, "#303030")." notitle, ".bar(2, 0.19, "#8FB8DE")." notitle, ")
key_entry(k, shade) = sprintf(", keyentry with boxes lt 1 lw 1 fc rgb '%s' title word(linkages, %d)", shade, k)
keys_of(panel) = words(linkages) == 1 || panel > int(word(kept, 1)) ? "" : key_entry(1, "#303030").key_entry(2, "#8FB8DE")
x_axis = "set xrange [0.4:harmonics + 0.6]; set xtics 1; set xlabel 'harmonic k'"
set style fill solid 1 border rgb ink
set boxwidth 0.36
set grid noxtics
