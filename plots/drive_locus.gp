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
headline = "Torque against speed of the drives over the cycle"
note = timed ? "curve: at the instants of drives.dat; lines: peak, rms (with both signs) and mean over the cycle" : \
    "curve: at the positions of drives.dat; bars: peak, rms (with both signs) and mean over the whole cycle"

# Rate and torque of a drive at all positions, an empty line between speeds; then a value of every speed as a bar across, with both
# signs as two.
drive_rows(k) = "< ".rows_told(sprintf("!/^#/ && $%d == \"%s\" { if (%d && NR > 1 && $1 != last) print \"\"; last = $1; print $%d, $%d }", \
    3 + d, word(drive_names, k), !d, 5 + d, 6 + d), other)
value_rows(k, quantity, both) = "< ".rows_told(sprintf("!/^#/ && $%d == \"%s\" && $%d == \"-\" { at = %s; ", b + 1, word(drive_names, k), \
        b + 2, timed ? sprintf("%.9g", 0.5*(low_rate + high_rate)) : sprintf("$%d", b + 4)).\
    sprintf("if ($%d == \"%s\") value = $%d; if ($%d == \"%s\") for (sign = 1; sign >= (%d ? -1 : 1); sign -= 2) ", b + 3, quantity, \
        b + 4, b + 3, rate_word, both).\
    sprintf("{ if (made++) print \"\"; for (i = 0; i < %d; i++) print at + %.9g*(2*i/%d - 1), sign*value } }", \
        most_rows, bar, larger(1, most_rows - 1)), table)
# A bar has as many points as the curve, whose marks panels.gp counts.
bar = 0.0
most_rows = 2
source_of(k) = k == 1 ? drive_rows(panel) : value_rows(panel, word("- peak_ rms_ mean_", k).sized(panel), k == 3)
x = "$1"
low_rate = 0.0
high_rate = 0.0
do for [k=1:n_drives] {
    panel = panel_of((n_drives > 1 ? sized(k)." of ".inside(word(drive_names, k), 14) : is_force(k) ? "driving force" : "driving torque").\
        gear_words(k), \
        unit_in(k, "peak_".sized(k)), "$2 $2 $2 $2", "'over the cycle' peak rms mean")
    stats source_of(1) using 1 name "rates" nooutput
    low_rate = lesser(low_rate, 1.2*rates_min)
    high_rate = larger(high_rate, 1.2*rates_max)
    most_rows = larger(most_rows, rates_records)
}
bar = (timed ? 0.5 : 0.02)*(high_rate - low_rate)
rate_unit = unit_in(1, rate_word)
same_units = 1
do for [k=2:declared] { if (unit_in(k, rate_word) ne rate_unit) { same_units = 0 } }
x_axis = "set xrange [low_rate:high_rate]; set xtics autofreq; set format x '%h'; set xlabel 'speed of the drive'.(same_units ? bracketed(typeset(rate_unit)) : '')"
