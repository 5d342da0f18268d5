# The contact sheet of mode shapes at one speed: a line a mode, a column a crank angle.
# Eight crank angles at most, evenly chosen, and twelve modes.

load plots."mode_size.gp"
longest_side = side_of_modes("all")
share_drawn = share*longest_side/high_s             # of the longest link
shapes_file = out.".shapes"
system(ask(table, sprintf("shapes %s %.9g", asked_speed, share_drawn))." > ".quoted(shapes_file))
# Of every index its number, mode and crank.
load "< awk ".quoted("BEGIN { print \"$found << EOD\" } NF && $7 \" \" $8 != last { print n++, $7, $8; last = $7 \" \" $8 } END { print \"EOD\" }").\
    " ".quoted(shapes_file)
load keep("reach_of_modes", table, sprintf("reach all %.9g", share_drawn))
stats $reach_of_modes using 1 name "across" nooutput
stats $reach_of_modes using 2 name "up" nooutput

# The modes and the crank angles that there are, and which of them are drawn.
all_modes = ""
all_cranks = ""
do for [k=1:|$found|] {
    if (strstrt(" ".all_modes." ", " ".word($found[k], 2)." ") == 0) { all_modes = all_modes." ".word($found[k], 2) }
    if (strstrt(" ".all_cranks." ", " ".word($found[k], 3)." ") == 0) { all_cranks = all_cranks." ".word($found[k], 3) }
}
drawn_modes = lesser(words(all_modes), 12)
drawn_cranks = lesser(words(all_cranks), 8)
last_crank = words(all_cranks)
if (last_crank > 8 && abs(word(all_cranks, last_crank) - word(all_cranks, 1) - 360) < 1e-6) { last_crank = last_crank - 1 }
crank_at(column) = word(all_cranks, last_crank <= 8 ? column : 1 + int((column - 1)*last_crank/8.0 + 0.5))
mode_at(line) = word(all_modes, line)
index_of(mode, crank) = sum [k_of=1:|$found|] (word($found[k_of], 2) eq mode && word($found[k_of], 3) eq crank ? word($found[k_of], 1) + 1 : 0)

# A sheet of one crank angle, or of one mode, is not one column or one line: its tiles have both in their captions.
gridded = drawn_modes > 1 && drawn_cranks > 1
tiles = drawn_modes*drawn_cranks
tile_columns = gridded ? drawn_cranks : tiles <= 4 ? tiles : tiles <= 6 ? 3 : 4
mode_of(k) = mode_at(gridded ? (k - 1)/tile_columns + 1 : drawn_cranks > 1 ? 1 : k)
crank_of(k) = crank_at(gridded ? (k - 1)%tile_columns + 1 : drawn_cranks > 1 ? k : 1)

# Which are drawn, as lists; drawn_before counts them up to one, in the order of the table.
mode_list = ""
crank_list = ""
do for [line=1:drawn_modes] { mode_list = mode_list.(line > 1 ? "," : "").mode_at(line) }
do for [column=1:drawn_cranks] { crank_list = crank_list.(column > 1 ? "," : "").crank_at(column) }
is_listed(list, one) = strstrt(",".list.",", ",".one.",") > 0
drawn_before(number) = sum [k_of=1:number + 1] (is_listed(mode_list, word($found[k_of], 2)) && is_listed(crank_list, word($found[k_of], 3)))

size = 0.06*longest_side
if (placed) {
    call plots."mode_linkage.gp" sprintf("%.12g", speed) mode_list crank_list sprintf("%.9g", share*longest_side) sprintf("%.9g", longest_side) "1"
    across_min = lesser(across_min, x_min)
    across_max = larger(across_max, x_max)
    up_min = lesser(up_min, y_min + 1.3*size)
    up_max = larger(up_max, y_max)
}
x0 = across_min - 1.6*size
x1 = across_max + 1.6*size
array line_y0[tiles]
array line_y1[tiles]
do for [line=1:tiles] { line_y0[line] = up_min - 1.8*size; line_y1[line] = up_max + 0.6*size }
tile_limit = 300.0
caption_lines = gridded ? 1 : 2
lead_room = gridded ? 50 : 0
head_of_columns = gridded ? 40 : 10

headline = numbered(figure, sprintf("Mode shapes, %s", moment))
note = sprintf("largest displacement of a mode drawn as %g %% of %s", 100*share, compared)
if (drawn_modes < words(all_modes) || drawn_cranks < words(all_cranks)) {
    note = note.sprintf("; %d of %d modes, %d of %d crank angles", drawn_modes, words(all_modes), drawn_cranks, words(all_cranks))
}
load plots."legend.gp"
eval entry_line("undeformed", "lw 2.5 lc rgb '#9A9A9A' dt (12,6)")
eval entry_line("mode shape", "lw 4 lc rgb ink dt solid")
if (placed) { if (helds) { eval held_entry } }
load plots."tiles.gp"

position(crank) = of_cycle ? at_crank(crank) : sprintf("θ₂ = %.5g°", crank)

eval begin_panels
do for [k=1:tiles] {
    if (k > 1) { eval clear_page }
    eval tile(k)
    if (gridded && (k - 1)%tile_columns == 0) { eval line_title(k, "mode ".mode_of(k)) } else { unset label 949 }
    if (gridded && line_of(k) == 1) { eval column_title(k, position(crank_of(k) + 0)) } else { unset label 948 }
    if (!gridded) { eval caption(1, k, sprintf(stands ? "mode %s" : "mode %s, %s", mode_of(k), position(crank_of(k) + 0))) }
    number = index_of(mode_of(k), crank_of(k)) - 1
    if (number < 0) {
        eval caption(caption_lines, k, "could not be computed")
        plot NaN notitle
        continue
    }
    begun = 0
    crank_angle = 0
    stats shapes_file index number using (frequency = $6, \
        begun == 1 && ($1 != first_x || $2 != first_y) ? (crank_angle = arg($1 - first_x + {0, 1}*($2 - first_y)), begun = 2) : 0, \
        begun == 0 ? (first_x = $1, first_y = $2, begun = 1) : 0, last_x = $1, last_y = $2, 0) nooutput
    eval caption(caption_lines, k, five_digits(frequency)." ".unit_frequency)
    if (placed) {
        now = drawn_before(number)
        eval clamp_walls(now, size, 1)
        rest = rest_pose[now]
        bent = mode_pose[now]
        eval "plot ".fixed_parts."shapes_file index number using 1:2 with lines lw 2.5 lc rgb faint dt (12,6) notitle, ".\
            arms_of(rest, "lw 2.5 lc rgb faint dt (12,6)").pale_blocks_of(rest).\
            "shapes_file index number using ($1 + $3):($2 + $4) with lines lw 4 lc rgb ink dt solid notitle, ".\
            arms_of(bent, "lw 4 lc rgb ink dt solid").blocks_of(bent).joints_of(bent, 1.3, 2, "ink")."NaN notitle"
        continue
    }
    if (!of_cycle) {
        call plots."ground.gp" sprintf("%.12g", first_x) sprintf("%.12g", first_y) size 1 "clamped" sprintf("%.12g", crank_angle*180/pi)
        call plots."ground.gp" sprintf("%.12g", last_x) sprintf("%.12g", last_y) size 11 "pinned"
    }
    pin(value) = $5 == 1 && ($1 != first_x || $2 != first_y) ? value : NaN
    plot shapes_file index number using 1:2 with lines lw 2.5 lc rgb faint dt (12,6) notitle, \
        shapes_file index number using ($1 + $3):($2 + $4) with lines lw 4 lc rgb ink dt solid notitle, \
        shapes_file index number using (pin($1 + $3)):($2 + $4) with points pt 7 ps 1.3 lc rgb "white" notitle, \
        shapes_file index number using (pin($1 + $3)):($2 + $4) with points pt 6 ps 1.3 lw 2 lc rgb ink notitle
}
eval end_panels
