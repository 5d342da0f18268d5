# A linkage that is no four-bar at several positions of its cycle, one of them in full, with the paths of its pins and points.
# TABLE has the columns speed and crank; the positions are between its first and its last.

call plots."driven.gp"
samples = turning && cycle > 360 ? 360*int(lesser(8, cycle/360)) : 360
call plots."shapes.gp" samples 0.013

# In full: near 60 degrees, or after a third of the way. The others evenly.
shown = 1 + (turning ? int(floor((60.5 - pose_low)*samples/cycle) + 2*samples)%samples : samples/3)
do for [k=1:samples] { if (pose_found[shown] == 0) { shown = 1 + shown%(samples + 1) } }
others = turning ? 5 : 3
apart = samples/6
first_of = (shown - 1)%apart
other(k) = turning ? 1 + first_of + apart*(first_of + apart*(k - 1) < shown - 1 ? k - 1 : k) \
    : k == 1 ? 1 : k == 2 ? 2*samples/3 + 1 : samples + 1
room = 0.06*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room; y1 = y_max + room

headline = numbered(figure, "The linkage over its cycle")
pale_positions = ""
do for [k=1:others] {
    if (pose_found[other(k)]) {
        pale_positions = pale_positions.(pale_positions eq "" ? "" : ", ").minus(sprintf("%.5g", pose_crank[other(k)]))
    }
}
note = "in full: ".at_drive(pose_crank[shown]).(pale_positions eq "" ? "" \
    : sprintf("; pale: %s %s%s", drive_at, pale_positions, is_angle ? "°" : " ".unit_crank))
load plots."legend.gp"
do for [k=1:drawn_links] { eval entry_line(short_name(link_names, k), sprintf("lw 11 dt solid lc rgb '%s'", link_ink[k])) }
do for [k=1:paths] {
    if (path_ink[k] ne "") { eval entry_line("path of ".short_name(path_names, k), sprintf("lw 4 dt solid lc rgb '%s'", path_ink[k])) }
}
length_unit = system("awk ".quoted("!/^#/ { exit } { line = $0 } END { split(line, unit, \" \"); print unit[6] }")." ".\
    quoted(shapes."/drawn/geometry.dat"))
load plots."frame.gp"

# Names of pins keep clear of what is in full, of grounds and of each other.
set print places
print sprintf("page %g %g %g %g", box_left + 4, box_left + box_width - 4, box_bottom + 4, box_bottom + box_height - 4)
do for [k=1:grounds] {
    print sprintf("box %.6g %.6g %.6g %.6g", page_x(ground_x[k]), page_y(ground_y[k] - 0.8*ground_size*ground_up[k]), \
        pixel*1.9*ground_size, pixel*1.3*ground_size)
}
unset print
system(sprintf("awk -v left=%.9g -v low=%.9g -v scale=%.9g -v x0=%.12g -v y0=%.12g ", box_left, box_bottom, pixel, x0, y0).\
    quoted("NF == 0 { print \"curve\"; next } { print \"curve\", left + scale*($1 - x0), low + scale*($2 - y0) }").\
    " ".quoted(sprintf("%s/skeleton_%d", shapes, shown))." ".quoted(shapes."/guides")." >> ".quoted(places))
set print places append
row = system(sprintf("sed -n %dp ", shown).quoted(shapes."/paths"))
print_name(x, y, away, name) = sprintf("label %.6g %.6g %.4g %.4g %.4g 45 %s", page_x(x), page_y(y), away*pixel*bar + 4, \
    text_width(name, 17), text_height(17), name)
print_pin(x, y) = sprintf("box %.6g %.6g %.4g %.4g", page_x(x), page_y(y), 2.4*pixel*bar, 2.4*pixel*bar)
do for [k=1:paths] { print print_pin(word(row, 2*k) + 0, word(row, 2*k + 1) + 0) }
do for [k=1:grounds] { print print_pin(ground_x[k], ground_y[k]) }
do for [k=1:paths] { print print_name(word(row, 2*k) + 0, word(row, 2*k + 1) + 0, path_slides[k] ? 3.3 : 0.8, word(path_names, k)) }
do for [k=1:grounds] { print print_name(ground_x[k], ground_y[k], 0.8, word(ground_names, k)) }
do for [k=1:springs] {
    numbers = numbers_at($springs[shown], 4*k - 3)
    turns = word(spring_kinds, k) eq "coil" || word(spring_kinds, k) eq "drag"
    print turns ? print_name(number_of(numbers, 1), number_of(numbers, 2), 3.2, word(spring_names, k)) \
        : print_name(0.5*(number_of(numbers, 1) + number_of(numbers, 3)), 0.5*(number_of(numbers, 2) + number_of(numbers, 4)), 1.4, \
            word(spring_names, k))
}
unset print
load labels_as("names")

# Names stand out from pale links.
set style textbox opaque margins 0.15, 0.15 fillcolor rgb "#60FFFFFF" noborder

# A line to a name begins at the rim of its pin.
rim_share(x, y, to_x, to_y) = lesser(1, 0.75*bar*pixel/larger(0.01, sqrt((to_x - x)**2 + (to_y - y)**2)))
parts = ""
do for [k=1:others] { parts = parts.pale_body(other(k)) }
parts = parts.fixed_parts.thin_paths(1).bodies(shown).drawn_paths(1).pins_of(shown)
eval "plot ".parts."$names using (rim = rim_share($3, $4, $7, $8), $5 == 1 ? unscaled_x($3 + rim*($7 - $3)) : NaN):(unscaled_y($4 + rim*($8 - $4))):".\
    "((1 - rim)*($7 - $3)/pixel):((1 - rim)*($8 - $4)/pixel) ".\
    "with vectors nohead lw 1 dt solid lc rgb '#808080' notitle, ".\
    "$names using (unscaled_x($1)):(unscaled_y($2)):(strcol(6)) with labels boxed font point_size(17) notitle"
