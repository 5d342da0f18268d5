# Where a linkage rests without its drive (figure.gp): its potential over the ranges of the drive with the rests of the other table, and
# what a drive would have to give.

# Crank, verdict, potential, stiffness, frequency.
load "< awk ".quoted("BEGIN { print \"$rests << EOD\" } !/^#/ && NF { print $1, $2, $3, $4, $5 } END { print \"EOD\" }")." ".quoted(other)
headline = "Where the linkage rests without its drive"

# A few are told in the notes, stable ones with their frequencies.
verdicts = ""
of_kind(k, kind) = k > |$rests| ? "" : (word($rests[k], 2) ne kind ? "" : ", ".place_of(k)).of_kind(k + 1, kind)
place_of(k) = minus(sprintf("%.4g", word($rests[k], 1) + 0)).(unit_crank eq "deg" ? "°" : " ".unit_crank).\
    (word($rests[k], 5) + 0 > 0 ? sprintf(" with %.3g Hz", word($rests[k], 5) + 0) : "")
do for [k=1:|$rests|] { verdicts = verdicts." ".word($rests[k], 2) }
listed_as(kind, text) = strstrt(verdicts, " ".kind) == 0 ? "" : text.of_kind(1, kind)[3:*]
note = |$rests| == 0 ? "it rests nowhere" : words(verdicts) > 10 ? "frequencies of small oscillations about stable rests: equilibrium.dat" \
    : listed_as("stable", strstrt(of_kind(1, "stable"), " with ") > 0 ? "stable, with the frequency of small oscillations: " : "stable: ")
if (words(verdicts) <= 10 && strstrt(verdicts, " unstable") > 0) {
    remark = listed_as("unstable", "unstable: ").(remark eq "" ? "" : "; ".remark)
}
# Wells that are shallow beside the whole range fill a panel of their own.
rest_low = 1e300
rest_high = -1e300
do for [k=1:|$rests|] { rest_low = lesser(rest_low, word($rests[k], 3) + 0.0); rest_high = larger(rest_high, word($rests[k], 3) + 0.0) }
depth = larger(rest_high - rest_low, low_potential <= rest_low ? rest_low - low_potential : 0)
shallow = |$rests| > 1 && depth > 0 && depth < 0.02*(high_potential - low_potential)
shown_low(panel) = shallow && panel == 3 ? rest_low - 0.5*depth : NaN
shown_high(panel) = shallow && panel == 3 ? rest_high + 2*depth : NaN
# What is only rounding is nothing.
nothing = larger(abs(low_torque), abs(high_torque)) < 1e-12*larger(abs(low_potential), abs(high_potential))
added = panel_of("potential", unit_potential, fields("potential"), "'it rests everywhere'")
added = panel_of(unit_crank eq "deg" ? "torque to hold it" : "force to hold it", unit_torque, nothing ? "0" : fields("torque"), "torque")

if (shallow) { added = panel_of("potential near the rests", unit_potential, fields("potential"), "potential") }

# Between two rows of this word it rests everywhere.
height(panel) = panel == 2 ? "(0)" : "3"
is_rest(word_of) = sprintf("(strcol(2) eq '%s' ? $1 : NaN)", word_of)
rests_with(word_of, panel, look) = sprintf("$rests using %s:%s with %s notitle, ", is_rest(word_of), height(panel), look)
stable_look = "points pt 7 ps 2.6 lc rgb '#007A5A'"
unstable_look = "points pt 6 ps 2.6 lw 3 lc rgb '#C04000'"
everywhere_look = "lines lw 9 dt solid lc rgb '#9FD3C3'"
has_rest(word_of) = strstrt(verdicts, " ".word_of) > 0
parts_below(panel) = |$rests| == 0 ? "" : rests_with("indifferent", panel, everywhere_look)
parts_above(panel) = |$rests| == 0 ? "" : rests_with("unstable", panel, "points pt 7 ps 2.6 lc rgb 'white'").\
    rests_with("unstable", panel, unstable_look).rests_with("stable", panel, stable_look)
keys_of(panel) = panel > 1 ? "" : (has_rest("stable") ? ", keyentry with ".stable_look." title 'stable rest'" : "").\
    (has_rest("unstable") ? ", keyentry with ".unstable_look." title 'unstable rest'" : "").\
    (has_rest("indifferent") ? ", keyentry with ".everywhere_look." title 'it rests everywhere'" : "")
