# Links drawn as bodies of some width: a capsule from pin to pin, and plates to the points on the link. After linkage.gp:
#   call "bodies.gp" HALF_WIDTH
# Each function gives parts of a plot command, every one with a comma behind it. The width is in the unit of the axes.

half_width = ARG1 + 0
rim = 0.28*half_width                               # the dark edge of a body
link_fill(link) = word("- #6699CC #FFCC66 #99CC99", link)
point_ink(p) = word("#CC3333 #336699 #339966 #996699 #CC9933", (p - 1)%5 + 1)
dark = "#333333"

# The edge of a capsule: its end (0 or 1), and the way from there in the axes of the link, as a unit vector.
set print $capsule
do for [k=0:25] {
    angle = pi*((k < 13 ? k : k - 1)/12.0 - 0.5)
    print sprintf("%d %.7g %.7g", k < 13 ? 1 : 0, cos(angle), sin(angle))
}
unset print
set print $corners
do for [k=0:2] { print k }
unset print

filled(colour) = sprintf(" with filledcurves closed fc rgb '%s' fs solid 1 noborder notitle, ", colour)
along_link(p, q) = abs(q - p) > 0 ? (q - p)/abs(q - p) : 1
capsule(p, q, h, colour) = (u = h*along_link(p, q), \
    sprintf("$capsule using (%.7g + %.7g*$1 + %.7g*$2 - %.7g*$3):(%.7g + %.7g*$1 + %.7g*$2 + %.7g*$3)", \
        real(p), real(q - p), real(u), imag(u), imag(p), imag(q - p), imag(u), real(u)).filled(colour))
disc(p, h, colour) = capsule(p, p, h, colour)
triangle(p, q, r, colour) = sprintf("$corners using ($1 == 0 ? %.7g : $1 == 1 ? %.7g : %.7g)".\
    ":($1 == 0 ? %.7g : $1 == 1 ? %.7g : %.7g)", \
    real(p), real(q), real(r), imag(p), imag(q), imag(r)).filled(colour)

call plots."springs.gp" sprintf("%g", 1.1*half_width)
pale_spring_ink = "#707070"
springs_of(row) = springs_from(1, row, spring_column)

# Where pins and points are in a row of a block of poses.
at(row, k) = word(row, k) + I*word(row, k + 1)
first_pin(row, link) = link == 2 ? O2 : link == 3 ? at(row, 2) : O4
last_pin(row, link) = link == 2 ? at(row, 2) : at(row, 4)
plates(p, row, link, h, colour) = p > points ? "" : (point_link[p] != link ? "" : \
    capsule(first_pin(row, link), at(row, column_of(p)), h, colour).\
    capsule(last_pin(row, link), at(row, column_of(p)), h, colour).\
    triangle(first_pin(row, link), last_pin(row, link), at(row, column_of(p)), colour)).plates(p + 1, row, link, h, colour)
shape(row, link, h, colour) = capsule(first_pin(row, link), last_pin(row, link), h, colour).plates(1, row, link, h, colour)
body(row, link) = shape(row, link, half_width + rim, dark).shape(row, link, half_width, link_fill(link))
pin(z) = disc(z, 0.75*half_width, dark).disc(z, 0.45*half_width, "#FFFFFF")
marks(p, row) = p > points ? "" : \
    disc(at(row, column_of(p)), 0.75*half_width, dark).disc(at(row, column_of(p)), 0.5*half_width, point_ink(p)).marks(p + 1, row)
mechanism_below(row) = body(row, 4).body(row, 3).body(row, 2)
hooks_from(k) = k > hooks ? "" : pin(hook_x[k] + I*hook_y[k]).hooks_from(k + 1)
mechanism_pins(row) = hooks_from(1).pin(O2).pin(O4).pin(at(row, 2)).pin(at(row, 4)).marks(1, row)
mechanism(row) = mechanism_below(row).springs_of(row).mechanism_pins(row)

# So pale that arrows stand out.
pale(link) = word("- #C9DAEC #FFEBC4 #D7EBD7", link)
pale_body(row, link) = capsule(first_pin(row, link), last_pin(row, link), half_width + 0.8*rim, "#8C8C8C").\
    capsule(first_pin(row, link), last_pin(row, link), half_width, pale(link))
pale_mechanism(row) = pale_body(row, 4).pale_body(row, 3).pale_body(row, 2).\
    pale_springs_from(1, row, spring_column).hooks_from(1).pin(O2).pin(O4).pin(at(row, 2)).pin(at(row, 4))
