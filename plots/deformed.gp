# Links as they bend in the elastic response, and the displacements of their points, by response.dat. The script has set want_positions: 8 (six,
# if these divide a turn better) or so, or 0 for all. Then $moved has a row a position: crank angle, then ux, uy and the rotation of
# both ends of crank, coupler and follower, and of the points of the table; $poses has the linkage with rigid links there; and `magnified` is
# the round factor of displacements, the largest of which is drawn as `share` of the mechanism's larger side.

share = 0.125
call plots."linkage.gp" table
call plots."bodies.gp" "1"
listed_names(k) = k > points ? "" : " ".word(point_names, k).listed_names(k + 1)
set print angles
do for [angle in answer(table, sprintf("positions %.12g %d", speed, want_positions))] { print angle }
unset print
load poses_as("poses")
load keep("moved", table, sprintf("positions %.12g %d %s", speed, want_positions, link_ends.listed_names(1)))
positions_drawn = |$moved|
poses = "$poses"
eval extent

# Ends of links 2 to 4 are 1 to 6; then come the points. A fixed pivot without a row is not displaced; there the crank is held, and
# the follower is free of moment.
end_of(link, last) = 2*link - 3 + last
known(row, k) = word(row, 3*k - 1) ne "NaN"
moved_by(row, k) = known(row, k) ? word(row, 3*k - 1) + I*word(row, 3*k) : 0.0
turned_by(row, k) = word(row, 3*k + 1) + 0.0
largest_displacement = 0.0
do for [row_drawn=1:positions_drawn] {
    do for [k=1:6 + points] {
        largest_displacement = larger(largest_displacement, abs(moved_by($moved[row_drawn], k)))
    }
}
round_down(x) = (power = 10.0**floor(log10(x) + 1e-9), x/power >= 5 ? 5*power : x/power >= 2 ? 2*power : power)
magnified = largest_displacement > 0 ? larger(1.0, round_down(share*span/largest_displacement)) : 1.0
magnified_text = magnified == 1 ? "displacements drawn to the scale of the linkage" : sprintf("displacements drawn %.0f times as large", magnified)
if (magnified > 999999) { magnified_text = "displacements drawn 10".raised(sprintf("%.0f", log10(magnified)))." times as large" }

# The axis of a link is a cubic through the displacements and rotations of its ends: its coefficients, for 0 to 1 along the link.
way(pose, link) = last_pin(pose, link) - first_pin(pose, link)
along(pose, row, link, last) = moved_by(row, end_of(link, last))*conj(way(pose, link))/abs(way(pose, link))
conj(z) = real(z) - I*imag(z)
across_link(pose, row, link, last) = imag(along(pose, row, link, last))
slope(pose, row, link, last) = known(row, end_of(link, last)) ? abs(way(pose, link))*turned_by(row, end_of(link, last)) \
    : link == 2 ? 0.0 : free_slope(pose, row, link, last)
free_slope(pose, row, link, last) = 1.5*(across_link(pose, row, link, 1) - across_link(pose, row, link, 0)) \
    - 0.5*abs(way(pose, link))*turned_by(row, end_of(link, 1 - last))
unit_of_link(pose, link) = way(pose, link)/abs(way(pose, link))
cubic_0(pose, row, link) = first_pin(pose, link) + magnified*moved_by(row, end_of(link, 0))
cubic_1(pose, row, link) = way(pose, link) + magnified*unit_of_link(pose, link)*( \
    real(along(pose, row, link, 1)) - real(along(pose, row, link, 0)) + I*slope(pose, row, link, 0))
cubic_2(pose, row, link) = magnified*I*unit_of_link(pose, link)*(3*(across_link(pose, row, link, 1) - across_link(pose, row, link, 0)) \
    - 2*slope(pose, row, link, 0) - slope(pose, row, link, 1))
cubic_3(pose, row, link) = magnified*I*unit_of_link(pose, link)*(2*(across_link(pose, row, link, 0) - across_link(pose, row, link, 1)) \
    + slope(pose, row, link, 0) + slope(pose, row, link, 1))
bent(pose, row, link, s) = cubic_0(pose, row, link) + s*(cubic_1(pose, row, link) + s*(cubic_2(pose, row, link) \
    + s*cubic_3(pose, row, link)))
set print $along
do for [k=0:40] { print sprintf("%.4g", k/40.0) }
unset print
cubic_text(c0, c1, c2, c3) = sprintf("(%.9g + $1*(%.9g + $1*(%.9g + $1*%.9g)))", c0, c1, c2, c3)
bent_link(pose, row, link, style) = sprintf("$along using %s:%s with lines %s notitle, ", \
    cubic_text(real(cubic_0(pose, row, link)), real(cubic_1(pose, row, link)), real(cubic_2(pose, row, link)), real(cubic_3(pose, row, link))), \
    cubic_text(imag(cubic_0(pose, row, link)), imag(cubic_1(pose, row, link)), imag(cubic_2(pose, row, link)), imag(cubic_3(pose, row, link))), style)

# Pins and points, and the way from a link to a point beside it.
pin_moved(pose, row, pin_drawn) = at(pose, 2*pin_drawn) + magnified*moved_by(row, pin_drawn == 1 ? 2 : 4)
point_moved(pose, row, p) = at(pose, column_of(p)) + magnified*moved_by(row, 6 + p)
foot_on_link(pose, p) = lesser(1.0, larger(0.0, real((at(pose, column_of(p)) - first_pin(pose, point_link[p]))/way(pose, point_link[p]))))
segment(p, q, style) = sprintf("'+' using ($0 == 0 ? %.9g : %.9g):($0 == 0 ? %.9g : %.9g) every ::0::1 with lines %s notitle, ", \
    real(p), real(q), imag(p), imag(q), style)
spot(z, style) = sprintf("'+' using (%.9g):(%.9g) every ::0::0 with points %s notitle, ", real(z), imag(z), style)
points_drawn(pose, row, k) = k > points ? "" : segment(bent(pose, row, point_link[k], foot_on_link(pose, k)), point_moved(pose, row, k), \
    "lw 2 dt solid lc rgb '".point_ink(k)."'").spot(point_moved(pose, row, k), "pt 7 ps 2 lc rgb '".point_ink(k)."'").\
    points_drawn(pose, row, k + 1)
rigid_look = "lw 3 lc rgb '#9A9A9A' dt (12,6)"
bent_look = "lw 5 lc rgb ink dt solid"
joint(z, ink_of) = spot(z, "pt 7 ps 2 lc rgb 'white'").spot(z, "pt 6 ps 2 lw 2.5 lc rgb ".ink_of)
straight(pose) = segment(O2, at(pose, 2), rigid_look).segment(at(pose, 2), at(pose, 4), rigid_look).segment(O4, at(pose, 4), rigid_look)
deformed_linkage(pose, row) = straight(pose).bent_link(pose, row, 2, bent_look).bent_link(pose, row, 3, bent_look).\
    bent_link(pose, row, 4, bent_look).points_drawn(pose, row, 1).\
    joint(O4, "ink").joint(pin_moved(pose, row, 1), "ink").joint(pin_moved(pose, row, 2), "ink")
# The extent of the positions from one row to another, with what is displaced: include_moved(first, last), to be evaluated.
include_moved(first, last) = sprintf("do for [row_drawn=%d:%d] { ", first, last).\
    "do for [k=1:2] { place_found = pin_moved(@poses[row_drawn], $moved[row_drawn], k); ".\
    "place_found = include(real(place_found), imag(place_found)); ".\
    "place_found = include(real(at(@poses[row_drawn], 2*k)), imag(at(@poses[row_drawn], 2*k))) }; ".\
    "do for [k=1:points] { place_found = point_moved(@poses[row_drawn], $moved[row_drawn], k); ".\
    "place_found = include(real(place_found), imag(place_found)) }; ".\
    "do for [k=2:4] { place_found = bent(@poses[row_drawn], $moved[row_drawn], k, 0.5); ".\
    "place_found = include(real(place_found), imag(place_found)) } }; span = larger(x_max - x_min, y_max - y_min)"
