# What figures and animations of a mode shape share; loaded after drawing.gp and `eval answer(table, "facts")`, with mode, crank,
# speed and parts, those of its swing that are drawn, set.

load plots."mode_size.gp"
load keep("shape", table, sprintf("shapes %.12g 0 %.12g %d", speed, crank, mode))     # columns: see tables.awk
if (|$shape| == 0) {
    print sprintf("%s: no mode %d at crank %.10g, speed %.10g", table, mode, crank, speed)
    exit status 1
}

furthest = 0; begun = 0; crank_angle = 0
stats $shape using (frequency = $6, furthest = sqrt($3**2 + $4**2) > furthest ? sqrt($3**2 + $4**2) : furthest, \
    begun == 1 && ($1 != first_x || $2 != first_y) ? (crank_angle = arg($1 - first_x + {0, 1}*($2 - first_y)), begun = 2) : 0, \
    begun == 0 ? (first_x = $1, first_y = $2, begun = 1) : 0, last_x = $1, last_y = $2, 0) nooutput

longest_side = side_of_modes(sprintf("%.12g", crank))
drawn = share*longest_side
scale = furthest > 0 ? drawn/furthest : 0
size = 0.05*longest_side

headline = numbered(figure, sprintf("%s mode, %#.6g %s, %s", capital(ordinal(mode)), frequency, unit_frequency, \
    at_place(crank, speed, unit_speed)))
note = sprintf("largest displacement drawn as %.3g %s, %g %% of %s", drawn, unit_x, 100*share, compared)

# The frame holds every mode of this position, at all speeds and swinging to both sides, so that figures can be laid side by side.
load keep("reach_of_modes", table, sprintf("reach %.12g %.9g", crank, drawn/high_s))
stats $reach_of_modes using 1 name "across" nooutput
stats $reach_of_modes using 2 name "up" nooutput
if (placed) {
    call plots."mode_linkage.gp" sprintf("%.12g", speed) sprintf("%d", mode) sprintf("%.12g", crank) sprintf("%.9g", drawn) \
        sprintf("%.9g", longest_side) parts
    across_min = lesser(across_min, x_min)
    across_max = larger(across_max, x_max)
    up_min = lesser(up_min, y_min + 1.3*size)
    up_max = larger(up_max, y_max)
}
x0 = across_min - 1.4*size
x1 = across_max + 1.4*size
y0 = up_min - 1.8*size
y1 = up_max + 1.4*size

load plots."legend.gp"
undeformed_style = "lw 4 lc rgb '#9A9A9A' dt (12,6)"
shape_style = "lw 6 lc rgb ink dt solid"
eval entry_line("undeformed", undeformed_style)
eval entry_line("mode shape", shape_style)
if (placed) { if (helds) { eval held_entry } }
mode_grounds = placed ? clamp_walls(1, size, 1) : of_cycle ? "" : \
    "call plots.'ground.gp' sprintf('%.12g', first_x) sprintf('%.12g', first_y) size 1 'clamped' sprintf('%.12g', crank_angle*180/pi); ".\
    "call plots.'ground.gp' sprintf('%.12g', last_x) sprintf('%.12g', last_y) size 11 'pinned'"
mode_frame = "length_unit = unit_x; load plots.'frame.gp'; ".mode_grounds

# The shape after a part of its swing, and pins, which are where links end, but for the clamped root of the first.
pin(value) = $5 == 1 && ($1 != first_x || $2 != first_y) ? value : NaN
swung_x(part) = $1 + part*scale*$3
swung_y(part) = $2 + part*scale*$4
rest_line = "$shape using 1:2 with lines ".undeformed_style." notitle, "
swung_line(part) = sprintf("$shape using (swung_x(%g)):(swung_y(%g)) with lines %s notitle, ", part, part, shape_style)
shape_of_chain(part) = rest_line.swung_line(part).\
    "$shape using (pin($1)):2 with points pt 7 ps 2.4 lc rgb 'white' notitle, ".\
    "$shape using (pin($1)):2 with points pt 6 ps 2.4 lw 2.5 lc rgb faint notitle, ".\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 7 ps 2.4 lc rgb 'white' notitle, ", part, part).\
    sprintf("$shape using (pin(swung_x(%g))):(swung_y(%g)) with points pt 6 ps 2.4 lw 3.5 lc rgb ink notitle", part, part)
shape_of_linkage(part, pose) = fixed_parts.rest_line.arms_of(rest_pose[1], undeformed_style).pale_blocks_of(rest_pose[1]).\
    joints_of(rest_pose[1], 2.4, 2.5, "faint").swung_line(part).arms_of(pose, shape_style).blocks_of(pose).\
    joints_of(pose, 2.4, 3.5, "ink")."NaN notitle"
part_of(k) = real(word(parts, k))
mode_shape(k) = "plot ".(placed ? shape_of_linkage(part_of(k), mode_pose[1] + k - 1) : shape_of_chain(part_of(k)))
