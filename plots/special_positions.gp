# The special positions of linkage.dat side by side, on both branches.
#   gnuplot -c special_positions.gp linkage.dat OUT [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("special_positions.gp")]."style.gp"
table = ARG1; out = ARG2; figure = argument(3); remark = argument(4)

call plots."linkage.gp" ""
eval answer(table, "facts")
rows_found = answer(table, "distinct branch event =crank transmission_angle")
n = words(rows_found)/4

# Where a limit is the place of the least or the greatest transmission angle too, one drawing is enough.
place_of(k) = word(rows_found, 4*k - 3).sprintf(" %.12g", word(rows_found, 4*k - 1) + 0)
event_of(k) = word(rows_found, 4*k - 2)
places = ""
do for [k=1:n] {
    repeated = 0
    if (event_of(k)[1:12] eq "transmission") {
        do for [m=1:n] { if (event_of(m)[1:12] ne "transmission" && place_of(m) eq place_of(k)) { repeated = 1 } }
    }
    if (!repeated) { do for [m=4*k - 3:4*k] { places = places." ".word(rows_found, m) } }
}
n = words(places)/4
of_place(k, column) = word(places, 4*(k - 1) + column)
set print angles
do for [k=1:n] { print of_place(k, 3)." ".of_place(k, 1) }
unset print
load poses_as("places")
eval pivots
poses = "$places"
eval extent
call plots."bodies.gp" sprintf("%g", 0.022*span)
room = 0.08*span
size = 0.07*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room - 0.5*size; y1 = y_max + room

columns_drawn = n < 4 ? n : 4
lines_drawn = ceil(n/(1.0*columns_drawn))
tile_width = 380
tile_height = tile_width*(y1 - y0)/(x1 - x0)
tile_height = tile_height > 480 ? 480 : tile_height
words_of(event) = strstrt(event, "_") == 0 ? event \
    : words_of(event[1 : strstrt(event, "_") - 1]." ".event[strstrt(event, "_") + 1 : *])
headline = numbered(figure, "Special positions of the linkage")
note = "μ: transmission angle"
page = columns_drawn*tile_width + 60
eval open_page(page > 1180 ? page : 1180, lines_drawn*(tile_height + 90) + 190 + (remark ne "" ? 31 : 0))
left = (page_width - columns_drawn*tile_width)/2.0
eval heading
unset border
unset tics
unset grid
unset key
set xrange [x0:x1]
set yrange [y0:y1]
set size ratio -1
call plots."ground.gp" O2_x O2_y size 1 "pinned"
call plots."ground.gp" O4_x O4_y size 11 "pinned"
set multiplot
do for [k=1:n] {
    if (k == 2) { do for [label=901:904] { unset label label } }
    across_it = left + tile_width*((k - 1)%columns_drawn)
    down_it = 110 + (tile_height + 90)*((k - 1)/columns_drawn)
    set lmargin at screen across(across_it + 10)
    set rmargin at screen across(across_it + tile_width - 10)
    set tmargin at screen down(down_it)
    set bmargin at screen down(down_it + tile_height)
    set label 905 of_place(k, 1).": ".words_of(of_place(k, 2)) at screen across(across_it + tile_width/2.0), \
        down(down_it + tile_height + 18) center noenhanced font ",17"
    set label 906 sprintf("θ₂ = %.4g°,  μ = %.4g°", of_place(k, 3) + 0, of_place(k, 4) + 0) \
        at screen across(across_it + tile_width/2.0), down(down_it + tile_height + 46) center noenhanced font ",17"
    eval "plot ".mechanism($places[k])."NaN"
}
unset multiplot
eval close
