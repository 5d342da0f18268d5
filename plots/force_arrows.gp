# The forces at the pins and the shaking force as arrows, and the linkage where they are: `shown` positions, rows of $forces and $places.

# Of the ground on the crank at O2, of the crank and of the follower on the coupler at A and B, of the ground on the follower at O4:
# numbers of columns of $forces, the colours of the arrows, and where they begin.
call plots."linkage.gp" ""
load keep("forces", table, sprintf("positions %s %d O2x O2y A3x A3y B3x B3y O4x O4y shaking_x shaking_y", asked_speed, shown))
set print angles
do for [k=1:|$forces|] { print word($forces[k], 1) }
unset print
load poses_as("places")
poses = "$places"
eval extent
pin_ink = "#0060A8"
shaking_ink = "#C04000"
force_at(row, k) = word(row, 2*k) + {0, 1}*word(row, 2*k + 1)
tail_at(place, k) = k == 1 ? O2 : k == 4 ? O4 : k == 5 ? 0.5*(O2 + O4) : word(place, 2*k - 2) + {0, 1}*word(place, 2*k - 1)
pin_drawn_as(k) = pin_named(word("O2 A B O4", k)) eq word("O2 A B O4", k) ? word("O₂ A B O₄", k) : pin_named(word("O2 A B O4", k))
note = sprintf("forces on the crank at %s, on the coupler at %s and %s, on the follower at %s", \
    pin_named("O2"), pin_named("A"), pin_named("B"), pin_named("O4"))
greatest_shaking = 0
do for [row_drawn=1:|$forces|] { greatest_shaking = larger(greatest_shaking, abs(force_at($forces[row_drawn], 5))) }
if (greatest_shaking > 0) { remark = "shaking force: resultant of the inertia forces, drawn midway between ".pin_named("O2")." and ".pin_named("O4").(remark eq "" ? "" : "; ".remark) }

# The longest arrow takes half of the drawing's larger side; arrows of nearly nothing are left out. The extent takes in all.
arrow_share = 0.5
greatest_force = 0
do for [row_drawn=1:|$forces|] {
    do for [k=1:5] { greatest_force = larger(greatest_force, abs(force_at($forces[row_drawn], k))) }
}
scale_of_forces = "scale = greatest_force > 0 ? arrow_share*span/greatest_force : 0; ".\
    "do for [row_drawn=1:|$forces|] { do for [k=1:5] { ".\
    "head = tail_at(@poses[row_drawn], k) + scale*force_at($forces[row_drawn], k); ".\
    "include_head = include(real(head), imag(head)) } }; span = larger(x_max - x_min, y_max - y_min)"
arrow_amount = greatest_force > 0 ? nice(greatest_force/3) : 0
arrow_look(ink_of) = sprintf("size screen 0.008, 20 filled lw 3 lc rgb '%s'", ink_of)
entries_of_forces = "eval entry_line('force at a pin', sprintf(\"lw 3 lc rgb '%s'\", pin_ink)); ".\
    "if (greatest_shaking > 0) { eval entry_line('shaking force', sprintf(\"lw 3 lc rgb '%s'\", shaking_ink)) }; ".\
    "eval entry_arrow(amount(arrow_amount, unit_O2x), arrow_look('#000000'), pixel*scale*arrow_amount)"
arrow_of(tag, tail, force, ink_of) = abs(force) < 5e-3*greatest_force ? sprintf("unset arrow %d; ", tag) \
    : sprintf("set arrow %d from %.9g, %.9g to %.9g, %.9g %s front; ", tag, real(tail), imag(tail), \
        real(tail + scale*force), imag(tail + scale*force), arrow_look(ink_of))
arrows_of(place, row) = arrows_from(1, place, row)
arrows_from(k, place, row) = k > 5 ? "" : arrow_of(100 + k, tail_at(place, k), force_at(row, k), k == 5 ? shaking_ink : pin_ink).\
    arrows_from(k + 1, place, row)
# The names of the pins of a position, in places of the drawing that links and arrows leave free: `eval name_pins(place, row)`,
# then $names is a block for labels.awk's answer in pixels from the lower left corner.
print_way(p, q) = sprintf("curve\ncurve %.6g %.6g\ncurve %.6g %.6g\n", pixel*real(p), pixel*imag(p), pixel*real(q), pixel*imag(q))
print_ways(k, place, row) = k > 5 ? "" : print_way(tail_at(place, k), tail_at(place, k) + scale*force_at(row, k)).\
    print_ways(k + 1, place, row)
print_name(k, place) = sprintf("label %.6g %.6g 16 %.4g %.4g %d %s\n", pixel*real(tail_at(place, k)), pixel*imag(tail_at(place, k)), \
    text_width(pin_drawn_as(k), 15), text_height(15), word("135 90 90 45", k) + 0, pin_drawn_as(k))
print_ground(z) = sprintf("box %.6g %.6g %.6g %.6g\n", pixel*real(z), pixel*(imag(z) - 0.7*size), pixel*1.6*size, pixel*1.3*size)
print_hooks(k) = k > hooks ? "" : sprintf("box %.6g %.6g %.6g %.6g\n", pixel*hook_x[k], pixel*hook_y[k], pixel*1.6*size, pixel*2.4*size).\
    print_hooks(k + 1)
pins_to_name(place, row) = sprintf("page %.6g %.6g %.6g %.6g\n", pixel*x0, pixel*x1, pixel*line_y0[1], pixel*line_y1[1]).print_way(O2, tail_at(place, 2)).\
    print_way(tail_at(place, 2), tail_at(place, 3)).print_way(tail_at(place, 3), O4).print_ways(1, place, row).\
    print_ground(O2).print_ground(O4).print_hooks(1).print_name(1, place).print_name(2, place).print_name(3, place).print_name(4, place)
