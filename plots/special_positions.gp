# The special positions of linkage.dat side by side, those of a branch in lines of their own.

call plots."linkage.gp" ""
rows_found = answer(table, "distinct branch event =crank transmission_angle")
n = words(rows_found)/4

# Where a limit is the place of the least or the greatest transmission angle too, one drawing is enough.
place_of(k) = word(rows_found, 4*k - 3).sprintf(" %.12g", word(rows_found, 4*k - 1) + 0)
event_of(k) = word(rows_found, 4*k - 2)
drawn_places = ""
do for [k=1:n] {
    repeated = 0
    if (event_of(k)[1:12] eq "transmission") {
        do for [m=1:n] { if (event_of(m)[1:12] ne "transmission" && place_of(m) eq place_of(k)) { repeated = 1 } }
    }
    if (!repeated) { do for [m=4*k - 3:4*k] { drawn_places = drawn_places." ".word(rows_found, m) } }
}
n = words(drawn_places)/4
of_place(k, column) = word(drawn_places, 4*(k - 1) + column)
set print angles
do for [k=1:n] { print of_place(k, 3)." ".of_place(k, 1) }
unset print
load poses_as("places")
poses = "$places"
eval extent
call plots."bodies.gp" sprintf("%g", 0.022*span)
room = 0.06*span
size = 0.07*span
x0 = x_min - room - 0.6*size
x1 = x_max + room + 0.6*size

# A branch begins a line; places that it leaves empty have the number 0.
tile_columns = 4
array place_at[4*n + 4]
tiles = 0
do for [k=1:n] {
    if (k > 1 && of_place(k, 1) ne of_place(k - 1, 1)) {
        while (tiles%tile_columns != 0) { tiles = tiles + 1; place_at[tiles] = 0 }
    }
    tiles = tiles + 1
    place_at[tiles] = k
}
array line_y0[n + 1]
array line_y1[n + 1]
do for [k=1:tiles] {
    if (place_at[k] > 0) {
        line = (k - 1)/tile_columns + 1
        if ((k - 1)%tile_columns == 0) { line_y0[line] = lesser(O2_y, O4_y) - 1.6*size; line_y1[line] = larger(O2_y, O4_y) + room }
        do for [m=3:5:2] {
            line_y0[line] = lesser(line_y0[line], word($places[place_at[k]], m) - room)
            line_y1[line] = larger(line_y1[line], word($places[place_at[k]], m) + room)
        }
    }
}

# As an engineer would call them.
event_name(event) = event eq "transmission_smallest" ? "smallest transmission angle" \
    : event eq "transmission_largest" ? "largest transmission angle" \
    : event eq "follower_limit_stretched" ? "follower limit, crank and coupler stretched" \
    : event eq "follower_limit_folded" ? "follower limit, crank and coupler folded" \
    : event eq "crank_limit_stretched" ? "crank limit, coupler and follower stretched" \
    : event eq "crank_limit_folded" ? "crank limit, coupler and follower folded" \
    : event eq "change_point" ? "change point, all links in line" : spaced(event)
spaced(text) = strstrt(text, "_") == 0 ? text : spaced(text[1 : strstrt(text, "_") - 1]." ".text[strstrt(text, "_") + 1 : *])
first_part(name) = strstrt(name, ", ") == 0 ? name : name[1 : strstrt(name, ", ")]
second_part(name) = strstrt(name, ", ") == 0 ? "" : name[strstrt(name, ", ") + 2 : *]

headline = numbered(figure, "Special positions of the linkage")
note = "μ: transmission angle, between coupler and follower"
load plots."legend.gp"
caption_lines = 3
lead_room = 45
head_of_columns = 10
tile_least = 345
load plots."tiles.gp"
eval fixed_pivots(size).ground_hooks(size)
eval begin_panels
do for [k=1:tiles] {
    if (place_at[k] == 0) { continue }
    if (k > 1) { eval clear_page }
    place = place_at[k]
    name = event_name(of_place(place, 2))
    eval tile(k)
    if ((k - 1)%tile_columns == 0) { eval line_title(k, of_place(place, 1)." branch") } else { unset label 949 }
    eval caption(1, k, first_part(name))
    angles_there = sprintf("θ₂ = %.4g°,  μ = %.4g°", of_place(place, 3) + 0, of_place(place, 4) + 0)
    eval caption(2, k, second_part(name) eq "" ? angles_there : second_part(name))
    eval caption(3, k, second_part(name) eq "" ? "" : angles_there)
    eval "plot ".mechanism($places[place])."NaN notitle"
}
eval end_panels
