# Torque against speed of every drive over the cycle (figure.gp), from the other table, with the peak, root mean square and mean by which a
# motor is chosen.

eval answer(other, "facts")
drive_names = names_in(other, "drive")
n_drives = words(drive_names)
rows_told(program, path) = "awk ".quoted(program)." ".quoted(path)
# Of laws there is no speed before the part, and the rate is no constant.
timed = system(rows_told("/^#/ { head = last; last = $0 } !/^#/ { exit } END { print head ~ /^# *part / }", table)) + 0
b = timed ? 0 : 1
# The other table has the time first, or is a copy that draw_figures.sh makes, with the time for the position.
d = system(rows_told("/^#/ { head = last; last = $0 } !/^#/ { exit } END { print head ~ /^# *time / }", other)) + 0
is_force(k) = system(rows_told(sprintf("!/^#/ && $%d == \"%s\" && $%d == \"peak_force\" && $%d == \"-\" { print 1; exit }", \
    b + 1, word(drive_names, k), b + 3, b + 2), table)) eq "1"
unit_in(k, quantity) = system(rows_told(sprintf("!/^#/ && $%d == \"%s\" && $%d == \"-\" && $%d == \"%s\" { print $%d; exit }", \
    b + 1, word(drive_names, k), b + 2, b + 3, quantity, b + 5), table))
rate_word = timed ? "peak_rate" : "rate"
sized(k) = is_force(k) ? "force" : "torque"
# The first drive of a deck whose motor has a gear, which has rows of its own.
geared = system(rows_told("!/^#/ && $2 == \"motor\" && $3 == \"-\" { print 1; exit }", table)) eq "1"
gear_words(k) = geared && k == 1 ? " behind gear" : ""
# One constant speed is no abscissa: then the curve is over the positions of the cycle.
rate_range(k) = system(rows_told(sprintf("!/^#/ && $%d == \"%s\" { if (!n++ || $%d < a) a = $%d; if (n == 1 || $%d > b) b = $%d } END { print a + 0, b + 0 }", \
    3 + d, word(drive_names, k), 5 + d, 5 + d, 5 + d, 5 + d), other))
constant_rates = 1
low_rate = 0.0
high_rate = 0.0
do for [k=1:n_drives] {
    low = word(rate_range(k), 1) + 0.0
    high = word(rate_range(k), 2) + 0.0
    if (!same(low/larger(1e-300, abs(high)), high/larger(1e-300, abs(high)))) { constant_rates = 0 }
    low_rate = lesser(low_rate, 1.2*low)
    high_rate = larger(high_rate, 1.2*high)
}
over_cycle = constant_rates && !timed
left_end = over_cycle ? low_crank : low_rate
right_end = over_cycle ? high_crank : high_rate
whole = over_cycle || timed
headline = over_cycle ? "Torque of the drives over the cycle, ".at_speed(low_speed, unit_speed) : "Torque against speed of the drives over the cycle"
note = "curve: at the ".(timed ? "instants" : "positions")." of drives.dat; lines: peak, rms (with both signs) and mean over the cycle"

# Rate, or position, and torque of a drive at all positions, an empty line between speeds; then the ends of a line at a value of every speed, with both
# signs two.
drive_rows(k) = "< ".rows_told(sprintf("!/^#/ && $%d == \"%s\" { if (%d && NR > 1 && $1 != last) print \"\"; last = $1; print $%d, $%d }", \
    3 + d, word(drive_names, k), !d, over_cycle ? 2 + d : 5 + d, 6 + d), other)
value_rows(k, quantity, both) = "< ".rows_told(sprintf("!/^#/ && $%d == \"%s\" && $%d == \"-\" { at = %s; ", b + 1, word(drive_names, k), \
        b + 2, whole ? sprintf("%.9g", 0.5*(left_end + right_end)) : sprintf("$%d", b + 4)).\
    sprintf("if ($%d == \"%s\") value = $%d; if ($%d == \"%s\") for (sign = 1; sign >= (%d ? -1 : 1); sign -= 2) ", b + 3, quantity, \
        b + 4, b + 3, rate_word, both).\
    sprintf("{ if (made++) print \"\"; for (end = -1; end < 2; end += 2) print at + end*%.9g, sign*value } }", \
        (whole ? 0.5 : 0.03)*(right_end - left_end)), table)
source_of(k) = drive_rows(panel)
x = "$1"
do for [k=1:n_drives] {
    added = panel_of((n_drives > 1 ? sized(k)." of ".inside(word(drive_names, k), 14) : is_force(k) ? "driving force" : "driving torque").\
        gear_words(k), unit_in(k, "peak_".sized(k)), "$2", "'over the cycle'")
}
value_of(panel, j) = value_rows(panel, word("peak_ rms_ mean_", j).sized(panel), j == 2)
value_ends(panel, j) = system(value_of(panel, j)[3:*]." | awk ".quoted("NF { if (!n++ || $2 < a) a = $2; if (n == 1 || $2 > b) b = $2 } END { print a + 0, b + 0 }"))
also_shown(panel) = lesser(0, lesser(word(value_ends(panel, 1), 1) + 0, word(value_ends(panel, 2), 1) + 0))
also_reached(panel) = larger(word(value_ends(panel, 1), 2) + 0, word(value_ends(panel, 2), 2) + 0)
value_line(j) = sprintf("lines lt %d lw 4", j + 1)
parts_above(panel) = sprintf("value_of(%d, 1) using 1:2 with %s notitle, value_of(%d, 2) using 1:2 with %s notitle, value_of(%d, 3) using 1:2 with %s notitle, ", \
    panel, value_line(1), panel, value_line(2), panel, value_line(3))
keys_of(panel) = sprintf(", keyentry with %s title 'peak', keyentry with %s title 'rms', keyentry with %s title 'mean'", value_line(1), value_line(2), value_line(3))
least_entries = 1
rate_unit = unit_in(1, rate_word)
same_units = 1
do for [k=2:declared] { if (unit_in(k, rate_word) ne rate_unit) { same_units = 0 } }
if (!over_cycle) {
    x_axis = "set xrange [low_rate:high_rate]; set xtics autofreq; set format x '%h'; set xlabel 'speed of the drive'.(same_units ? bracketed(typeset(rate_unit)) : '')"
}
