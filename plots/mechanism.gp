# The mechanism at one position with its numbered lumped masses and their inertia forces.
# With distributed inertia the table knows the links' mass centres only; their ends are then taken from mesh.dat or, without it,
# the linkage is placed by the program.

share = 0.25        # longest arrow drawn, as a share of the mechanism's larger side

load keep("masses", table, sprintf("masses %.12g %.12g", crank, speed))      # columns: see tables.awk
load keep("arrows", table, sprintf("arrows %.12g %.12g %g", crank, speed, share))
distributed = strstrt(" ".columns." ", " moment ") > 0
nodes = distributed ? "$nodes" : "$masses"
if (other ne "") { load keep("nodes", other, sprintf("nodes %.12g", crank)) }
if (distributed && other eq "") {
    call plots."linkage.gp" ""
    eval pose_at("there", crank)
    set print $nodes
    do for [k=1:3] {
        print sprintf("0 %.12g %.12g 0 0 0 1 0 0 0 0", k == 1 ? real(O2) : word($there[1], 2*k - 2) + 0, \
            k == 1 ? imag(O2) : word($there[1], 2*k - 1) + 0)
    }
    print sprintf("0 %.12g %.12g 0 0 1 1 0 0 0 0", real(O4), imag(O4))
    unset print
}
eval measure
pick(value) = same(field("crank"), crank) && same(field("speed"), speed) ? value : NaN

# The frame takes in the arrows' heads and all masses.
pinmass(value) = strcol(col_link)[1:4] eq "pin:" ? pick(value) : NaN
stats $arrows using (sqrt($3**2 + $4**2)) name "longest" nooutput
has_pinmass = strstrt(answer(table, "distinct link"), "pin:") > 0
scale = longest_max > 0 ? share*span/longest_max : 0
stats $arrows using ($1 + scale*$3):($2 + scale*$4) name "head" nooutput
stats $arrows using 1:2 name "tail" nooutput
room = 0.09*span
size = 0.05*span
x0 = lesser(lesser(x_min, tail_min_x), head_min_x) - room
x1 = larger(larger(x_max, tail_max_x), head_max_x) + room
y0 = lesser(lesser(y_min - size, tail_min_y), head_min_y) - room
y1 = larger(larger(y_max, tail_max_y), head_max_y) + room

headline = numbered(figure, sprintf("Mechanism with %s, at %s", distributed ? "mass centres" : "lumped masses", at_crank(crank)))
note = longest_max == 0 ? "" : sprintf("arrows: inertia forces −m a at %s; at one place, their sum", moment)
moments = ""
if (distributed && longest_max > 0) {
    stats table using (abs(pick(field("moment")))) name "moment" nooutput
    power_of_moment = amount_power(moment_max, unit_moment)
    stats table using (pick(0) == 0 && strcol(col_link)[1:4] ne "pin:" && field("moment") != 0 \
        ? (moments = moments.", ".strcol(col_link)." ".amount_in(field("moment"), power_of_moment), 0) : 0) nooutput
    if (moments ne "") {
        remark = "inertia moments −I α: ".moments[3 : *].amount_unit(unit_moment, power_of_moment).(remark eq "" ? "" : "; ").remark
    }
}
load plots."legend.gp"
eval entry_point("pin joint", "pt 6 ps 3.0 lw 2.5 lc rgb ink")
eval entry_point(distributed ? "mass centre" : "lumped mass", "pt 7 ps 1.9 lc rgb ink")
if (has_pinmass) { eval entry_point("pin mass", "pt 4 ps 3.6 lw 3 lc rgb '#C04000'") }
pixel = drawing_scale(x0, x1, y0, y1)
arrow_value = longest_max > 0 ? nice(longest_max/3) : 0
if (longest_max > 0) { eval entry_arrow(amount(arrow_value, unit_Fx), "filled size screen 0.012, 20 lw 3 lc rgb force_ink", \
    pixel*scale*arrow_value) }
length_unit = unit_x
load plots."frame.gp"
call plots."ground.gp" sprintf("%.12g", first_x) sprintf("%.12g", first_y) size 1 "pinned"
call plots."ground.gp" sprintf("%.12g", last_x) sprintf("%.12g", last_y) size 11 "pinned"
pinmass_part = has_pinmass ? "table using (pinmass(field('x'))):(field('y')) ".\
    "with points pt 4 ps 4.6 lw 3 lc rgb '#C04000' notitle," : ""

# The numbers of the masses keep clear of links and arrows.
set print places
print sprintf("page %g %g %g %g", box_left + 4, box_left + box_width - 4, box_bottom + 4, box_bottom + box_height - 4)
print sprintf("box %.6g %.6g %.6g %.6g", page_x(first_x), page_y(first_y - 0.7*size), pixel*1.7*size, pixel*1.3*size)
print sprintf("box %.6g %.6g %.6g %.6g", page_x(last_x), page_y(last_y - 0.7*size), pixel*1.7*size, pixel*1.3*size)
number_in(row, k) = word(row, k) + 0.0
is_end(row) = words(row) > 1 && (number_in(row, 6) == 0 || number_in(row, 6) == number_in(row, 7))
do for [k=1:|@nodes|] {
    row = @nodes[k]
    print words(row) < 2 ? "curve" : sprintf("curve %.6g %.6g", page_x(number_in(row, 2)), page_y(number_in(row, 3)))
    if (is_end(row)) { print sprintf("box %.6g %.6g 34 34", page_x(number_in(row, 2)), page_y(number_in(row, 3))) }
}
do for [k=1:|$arrows|] {
    row = $arrows[k]
    print sprintf("curve\ncurve %.6g %.6g\ncurve %.6g %.6g", page_x(number_in(row, 1)), page_y(number_in(row, 2)), \
        page_x(number_in(row, 1) + scale*number_in(row, 3)), page_y(number_in(row, 2) + scale*number_in(row, 4)))
}
do for [k=1:|$masses|] {
    row = $masses[k]
    if (words(row) > 1 && row_shown(row, 0.09)) {
        print sprintf("label %.6g %.6g 18 %.6g %.6g %.4g m%s", page_x(number_in(row, 2)), page_y(number_in(row, 3)), \
            text_width("m", 19) + text_width(word(row, 1), 15), text_height(19), \
            180/pi*arg(number_in(row, 10) + {0, 1}*number_in(row, 11)), lowered(word(row, 1)))
    }
}
unset print
load labels_as("numbers")

plot nodes using 2:3 with lines lw 5 lc rgb "#707070" dt solid notitle, \
    $arrows using 1:2:(scale*$3):(scale*$4) \
        with vectors filled size screen 0.012, 20 lw 3 lc rgb force_ink dt solid notitle, \
    nodes using ($6 == 0 || $6 == $7 ? $2 : NaN):3 with points pt 7 ps 3.4 lc rgb "white" notitle, \
    nodes using ($6 == 0 || $6 == $7 ? $2 : NaN):3 with points pt 6 ps 3.4 lw 2.5 lc rgb ink notitle, \
    $masses using 2:3 with points pt 7 ps 1.9 lc rgb ink notitle, \
    @pinmass_part \
    $numbers using (unscaled_x($1)):(unscaled_y($2)):(strcol(6)) with labels font point_size(19) notitle
