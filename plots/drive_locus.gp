# Torque against speed of every drive over the cycle (figure.gp), from the other table, with the peak, root mean square and mean by which a
# motor is chosen.

eval answer(other, "facts")
drive_names = names_in(other, "drive")
n_drives = words(drive_names)
rows_told(program, path) = "awk ".quoted(program)." ".quoted(path)
is_force(k) = system(rows_told(sprintf("!/^#/ && $2 == \"%s\" && $4 == \"peak_force\" && $3 == \"-\" { print 1; exit }", word(drive_names, k)), table)) eq "1"
unit_in(k, quantity) = system(rows_told(sprintf("!/^#/ && $2 == \"%s\" && $3 == \"-\" && $4 == \"%s\" { print $6; exit }", \
    word(drive_names, k), quantity), table))
sized(k) = is_force(k) ? "force" : "torque"
# The first drive of a deck whose motor has a gear, which has rows of its own.
geared = system(rows_told("!/^#/ && $2 == \"motor\" && $3 == \"-\" { print 1; exit }", table)) eq "1"
gear_words(k) = geared && k == 1 ? " behind gear" : ""
headline = "Torque against speed of the drives over the cycle"
note = "curve: at the positions of drives.dat; bars: peak, rms (with both signs) and mean over the whole cycle"

# Rate and torque of a drive at all positions, an empty line between speeds; then a value of every speed as a bar across, with both
# signs as two.
drive_rows(k) = "< ".rows_told(sprintf("!/^#/ && $3 == \"%s\" { if (NR > 1 && $1 != last) print \"\"; last = $1; print $5, $6 }", \
    word(drive_names, k)), other)
value_rows(k, quantity, both) = "< ".rows_told(sprintf("!/^#/ && $2 == \"%s\" && $3 == \"-\" { ", word(drive_names, k)).\
    sprintf("if ($4 == \"%s\") value = $5; if ($4 == \"rate\") for (sign = 1; sign >= (%d ? -1 : 1); sign -= 2) ", quantity, both).\
    sprintf("{ if (made++) print \"\"; for (i = 0; i < %d; i++) print $5 + %.9g*(2*i/%d - 1), sign*value } }", \
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
bar = 0.02*(high_rate - low_rate)
rate_unit = unit_in(1, "rate")
same_units = 1
do for [k=2:declared] { if (unit_in(k, "rate") ne rate_unit) { same_units = 0 } }
x_axis = "set xrange [low_rate:high_rate]; set xtics autofreq; set format x '%h'; set xlabel 'speed of the drive'.(same_units ? bracketed(typeset(rate_unit)) : '')"
