# What a linkage that is no four-bar can do: ranges of its drive, swings of links, strokes of sliders, coordinates, transmission and
# pressure angles, as bars with their least and greatest values, beside them the positions of the drive there.

load keep("limits", table, "limits")
n_rows = |$limits|
length_unit = answer(table, "distinct unit")." "
is_length(name) = strstrt(" deg 1 ", " ".name." ") == 0
length_of_list = ""
do for [k=1:words(length_unit)] { if (is_length(word(length_unit, k))) { length_of_list = word(length_unit, k) } }

# A panel for each of: ranges, angles, places, coordinates that are angles, those that are lengths, and transmission with pressure.
panel_of(row) = lesser(6, int(word(row, 1)))
array in_panel[6]
array first_of[6]
array low_of[6]
array high_of[6]
do for [k=1:6] { in_panel[k] = 0; low_of[k] = 1e300; high_of[k] = -1e300 }
do for [k=1:n_rows] {
    p = panel_of($limits[k])
    in_panel[p] = in_panel[p] + 1
    if (in_panel[p] == 1) { first_of[p] = k }
    low_of[p] = lesser(low_of[p], word($limits[k], 3) + 0.0)
    high_of[p] = larger(high_of[p], word($limits[k], 4) + 0.0)
    if (word($limits[k], 1) eq "6") { low_of[p] = lesser(low_of[p], 90); high_of[p] = larger(high_of[p], 90) }
}
unit_of(p) = p == 1 ? unit_crank : p == 3 || p == 5 ? length_of_list : "deg"
numbered_range(row) = word(row, 10) + 0 == 0 ? "" : sprintf(" (%s)", word(row, 10))
row_name(k) = (word($limits[k], 1) eq "1" ? drive_subject : inside(word($limits[k], 2), name_length)).numbered_range($limits[k])
title_of(p) = p == 1 ? drive_quantity(unit_crank) : p == 2 ? "angle of the link" : p == 3 ? "place on the line" \
    : p == 4 ? "angle" : p == 5 ? "length" : only_of(6) ? "transmission angle, best at 90°" : only_of(7) ? "pressure angle, best at 0" : "transmission angle, best at 90°; pressure angle, best at 0"
only_of(kind) = (others = 0, sum [i_of=1:n_rows] (others = others + (panel_of($limits[i_of]) == 6 && word($limits[i_of], 1) + 0 != kind), 0), others == 0)

# What is only rounding beside a length is zero.
rounded(value, size) = minus(sprintf("%.4g", abs(value) < 1e-6*size ? 0 : value))
with_unit(text, unit) = unit eq "deg" ? text."°" : text." ".unit
end_text(row, which) = which == 3 && (word(row, 1) eq "7" || is_constant(row)) ? "" : rounded(word(row, which) + 0.0, larger(abs(word(row, 3)), abs(word(row, 4)))).\
    (unit_of(panel_of(row)) eq "deg" ? "°" : "")
is_constant(row) = constant(word(row, 3) + 0.0, word(row, 4) + 0.0)
amount_text(row) = with_unit(rounded(word(row, 7) + 0.0, 0), unit_of(panel_of(row)))
beside(row) = word(row, 1) eq "1" ? sprintf("stopped by %s and %s", word(row, 2), word(row, 9)) \
    : word(row, 1) > 5 ? (only_of(6) || only_of(7) ? "" : word("transmission pressure", word(row, 1) - 5)) \
    : word("- 'swings by' stroke span span", int(word(row, 1)))." ".amount_text(row).\
        (word(row, 8) + 0 == 0 ? "" : sprintf(", time ratio %.3f", word(row, 8) + 0.0))
drive_size = larger(abs(low_crank), abs(high_crank))
drive_place(row, which) = rounded(word(row, which) + 0.0, drive_size)
below(row) = word(row, 1) eq "1" ? "" : is_constant(row) ? "constant" : sprintf("at %s", word(row, 1) eq "7" ? with_unit(drive_place(row, 6), unit_crank) \
    : drive_place(row, 5)." and ".with_unit(drive_place(row, 6), unit_crank))
bar_ink(kind) = word("#B4B4B4 #6699CC #99CC99 #9FC2E3 #C3E0C3 #FFCC66 #E39E6E", kind)

headline = numbered(figure, "What the linkage can do")
turning = system(ask(table, "turning")." | paste -s -d, - | sed 's/,/, /g'")
ends_told = 0
do for [k=1:n_rows] { if (word($limits[k], 1) ne "1") { ends_told = 1 } }
note = (ends_told ? "at: ".drive_quantity(unit_crank)." at the least and at the greatest value" : "").\
    (n_rows > 0 && word($limits[1], 10) + 0 > 0 ? ", in its ranges (1), (2), …" : "").\
    (turning eq "" ? "" : (ends_told ? ";  " : "")."turning fully: ".turning)

# Rows of one height; every panel has its axis and title below.
row_height = 46
axis_height = 112
name_room = 40
text_room = 30
do for [k=1:n_rows] {
    name_room = larger(name_room, text_width(row_name(k), 18) + 40)
    text_room = larger(text_room, larger(text_width(beside($limits[k]), 16), text_width(below($limits[k]), 13)) + 40)
}
plot_width = 820
height = 125
do for [p=1:6] { if (in_panel[p] > 0) { height = height + row_height*(in_panel[p] + 0.6) + axis_height } }
foot_room = 31*lines_of_notes(note, remark) + (lines_of_notes(note, remark) > 0 ? 40 : 10)
eval open_page(larger(name_room + plot_width + text_room, larger(text_width(headline, 23), text_width(note, 17)) + 60), height + foot_room)
eval heading
eval begin_panels
unset key
unset grid
unset ytics
set border 15 lw 1.5
set lmargin at screen across(name_room)
set rmargin at screen across(name_room + plot_width)
top = 125
do for [p=1:6] {
    if (in_panel[p] > 0) {
        panel_height = row_height*(in_panel[p] + 0.6)
        set tmargin at screen down(top)
        set bmargin at screen down(top + panel_height)
        # Room for the numbers at the ends.
        share = 0.16
        way = high_of[p] > low_of[p] ? high_of[p] - low_of[p] : larger(1e-9, abs(high_of[p]))
        a = low_of[p] - (only_of(7) && p == 6 ? 0.03 : share)*way
        b = high_of[p] + share*way
        if (unit_of(p) eq "deg") { eval abscissa_between(a, b, degree_step(b - a)) } else { eval abscissa(a, b) }
        set xlabel abscissa_title(title_of(p), unit_of(p), a, b) noenhanced offset 0, 0.4
        set yrange [0:in_panel[p] + 0.6]
        set grid xtics lt 1 lw 1 lc rgb "#D0D0D0" dt solid
        do for [k=first_of[p]:first_of[p] + in_panel[p] - 1] {
            row = $limits[k]
            y = in_panel[p] + 0.3 - (k - first_of[p] + 0.5)
            kind = int(word(row, 1))
            low = word(row, 3) + 0.0
            high = word(row, 4) + 0.0
            tag = 3*(k - first_of[p]) + 1
            set object tag rectangle from low, y - 0.2 to high, y + 0.2 fc rgb bar_ink(kind) fs solid 1 border rgb "#333333" lw 1.5 front
            set label tag row_name(k) at screen across(name_room - 16), first y right noenhanced font point_size(18)
            set label tag + 1 end_text(row, 3) at first low, y right offset -0.6, 0 noenhanced font point_size(14) tc rgb "#404040" front
            set label tag + 2 end_text(row, 4) at first high, y left offset 0.6, 0 noenhanced font point_size(14) tc rgb "#404040" front
            set label 400 + tag beside(row) at screen across(name_room + plot_width + 16), first y + 0.2*(below(row) ne "" && beside(row) ne "") \
                left font point_size(16)
            set label 600 + tag below(row) at screen across(name_room + plot_width + 16), first y - 0.26*(beside(row) ne "") left \
                font point_size(13) tc rgb "#404040"
        }
        if (p == 6 && !only_of(7)) { set arrow 1 from first 90, graph 0 to first 90, graph 1 nohead lw 2 dt (10,6) lc rgb "#404040" back }
        plot [a:b] NaN notitle
        unset object
        unset arrow
        unset label
        top = top + panel_height + axis_height
    }
}
eval end_panels
