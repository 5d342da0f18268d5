# The branches of one speed: frequencies followed by their shapes, against the crank angle, with their crossings and veerings.
# A branch has the same line at every speed.

load keep("curves", table, "branches ".asked_speed)                # columns: see tables.awk
load keep("events", table, "events ".asked_speed)
crossings = 0; veerings = 0; ambiguous = 0
if (|$events| > 0) {
    stats $events using (crossings = crossings + ($1 == 1), veerings = veerings + ($1 == 2), \
        ambiguous = ambiguous + ($1 == 3), 0) nooutput
}

# Least and greatest frequency and number of the branches, in the order of the least.
order = system(rows_if(table, is_at("speed", asked_speed))[3:*]." | awk ".quoted(sprintf("NF { b = $%d; f = $%d; ", col_branch, col_frequency).\
    "if (!(b in least) || f < least[b]) least[b] = f; if (!(b in most) || f > most[b]) most[b] = f } ".\
    "END { for (b in least) print least[b], most[b], b }")." | sort -g -k1,1 -k3,3")
n = words(order)/3
least(i) = word(order, 3*i - 2) + 0.0
greatest(i) = word(order, 3*i - 1) + 0.0
branch(i) = word(order, 3*i)
highest(first, last) = first == last ? greatest(last) : larger(greatest(first), highest(first + 1, last))
low = least(1)
high = highest(1, n)

headline = sprintf("Branches of natural frequencies %s, %s", against_position(unit_crank), moment)
note = low < 0 ? divergence : ""
explained = (veerings > 0 ? "; veering: two branches approach, then part with their shapes exchanged" : "").\
    (ambiguous > 0 ? "; ambiguous: shapes do not decide which branch continues, a new one begins" : "")
if (remark eq "") { remark = explained[3 : *] }

# Branches that lie far apart have panels of their own, three at most: the widest gaps that are a tenth of the whole or more
# divide them. The lowest frequencies are in the lowest panel.
gap_above(i) = least(i + 1) - highest(1, i)
widest_gap = 0; second_gap = 0
do for [i=1:n - 1] {
    if (gap_above(i) > widest_gap) { second_gap = widest_gap; widest_gap = gap_above(i) } else { second_gap = larger(second_gap, gap_above(i)) }
}
divided = larger(0.1*(high - low), second_gap)
lasts = ""                                          # of the panels, from below
do for [i=1:n - 1] { if (words(lasts) < 2 && gap_above(i) >= divided && high > low) { lasts = lasts." ".i } }
lasts = lasts." ".n
last_of(panel) = int(word(lasts, words(lasts) + 1 - panel))
first_of(panel) = panel == words(lasts) ? 1 : last_of(panel + 1) + 1
from_zero = words(lasts) == 1

# Beyond the lines there are, a figure begins anew with the first. In a panel branches stand by their numbers.
in_order(panel) = system("printf '%s\\n' ".branches_of(first_of(panel), last_of(panel))." | sort -n")
branches_of(first, last) = first > last ? "" : branch(first)." ".branches_of(first + 1, last)
numbered_title(k, panel) = k > words(members[panel]) ? "" : sprintf(" 'branch %s'", word(members[panel], k)).numbered_title(k + 1, panel)
array members[3]
do for [panel=1:words(lasts)] {
    members[panel] = in_order(panel)
    added = panel_of("natural frequency", unit_frequency, repeated(words(members[panel]), "$2"), numbered_title(1, panel))
    legend_entries = larger(legend_entries, words(members[panel]) + 3)
}
x = "$1"
picked = "1"
source_of(k) = "$curves".word(members[panel], k)
pen_of(k) = high_branch <= 16 ? int(word(members[panel], k)) : place_of(word(members[panel], k))
place_of(number) = sum [k_of=1:n] (branch(k_of) + 0 <= number + 0)
marks_of(k) = sprintf("source_of(%d) using 1:($3 == 1 ? $2 : NaN)", k)
height_of(n) = n == 1 ? 750 : n == 2 ? 420 : 330
least_entries = 1
least_rows = words(answer(table, "distinct crank"))

# A veering is a triangle above its gap and one below, for which there must be room; a crossing is an open circle.
room_for(panel) = veerings > 0 ? 0.07*(highest(first_of(panel), last_of(panel)) - least(first_of(panel))) : 0
from_nothing(panel) = from_zero && low >= 0 && low < 0.2*high
also_shown(panel) = from_nothing(panel) ? high + room_for(panel) : least(first_of(panel)) - room_for(panel)
also_reached(panel) = highest(first_of(panel), last_of(panel)) + room_for(panel)
off = "17.0*(value_top(low_of[panel], high_of[panel]) - value_bottom(low_of[panel], high_of[panel]))/panel_height"
shown(kind, low, high, value) = $1 == kind && low >= low_of[panel] && high <= high_of[panel] ? value : NaN
event_part(count, kind, height, look) = count == 0 ? "" : sprintf("$events using 2:(shown(%d, $3, $4, %s)) with points %s lc rgb ink notitle, ", kind, height, look)
parts_above(panel) = event_part(veerings, 2, "$4 + ".off, "pt 11 ps 1.8").event_part(veerings, 2, "$3 - ".off, "pt 9 ps 1.8").\
    event_part(crossings, 1, "$3", "pt 6 ps 3 lw 2").event_part(ambiguous, 3, "$3", "pt 2 ps 2 lw 2.5")
event_key(count, look, name) = count == 0 ? "" : ", keyentry with points ".look." lc rgb ink title '".name."'"
keys_of(panel) = panel > 1 ? "" : event_key(veerings, "pt 11 ps 1.8", "veering").event_key(crossings, "pt 6 ps 3 lw 2", "crossing").\
    event_key(ambiguous, "pt 2 ps 2 lw 2.5", "ambiguous")
