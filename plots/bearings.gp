# The locus of the force in every joint at one speed: in the axes of the link on which it acts, and in global ones.

joints = words_in(table, "distinct pin link")
tiles = words(joints)
pin_of(k) = word(word(joints, k), 1)
link_of(k) = word(word(joints, k), 2)
headline = numbered(figure, "Loci of the forces in the joints, ".moment)
note = "force on the link at the pin, of a guide on the pin, from the centre to the curve; dot: at the first position"
load plots."legend.gp"
own_style = "lw 3.5 dt solid lc rgb 'black'"
ground_style = "lw 2.5 dt (12,6) lc rgb '#0060A8'"
eval entry_line("in axes that turn with the link, which points to the right", own_style)
eval entry_line("in fixed axes", ground_style)

# A joint has a scale of its own: the outer ring is drawn with radius 1.
array ring_of[tiles]
do for [k=1:tiles] {
    load keep(sprintf("own_%d", k), table, "path ".asked_speed." axial transverse ".word(joints, k))
    load keep(sprintf("ground_%d", k), table, "path ".asked_speed." fx fy ".word(joints, k))
    eval sprintf("stats $own_%d using (sqrt($1**2 + $2**2)) name 'found' nooutput", k)
    ring_of[k] = found_max > 0 ? found_max : 1.0
    ring = nice(ring_of[k]/4)
    ring_of[k] = ring*ceil(ring_of[k]/ring - 0.001)
}

# All in one unit; a pin and its link in two lines, where one is too long.
largest_ring = 0
caption_lines = 2
tile_limit = tiles <= 6 ? 420.0 : 330.0
do for [k=1:tiles] {
    largest_ring = larger(largest_ring, ring_of[k])
    if (text_width(pin_of(k)." on ".link_of(k), 13) > tile_limit) { caption_lines = 3 }
}
ring_power = amount_power(largest_ring, unit_fx)
x0 = -1.12
x1 = 1.12
tile_columns = tiles <= 4 ? tiles : tiles <= 6 ? 3 : tiles <= 12 ? 4 : 5
tile_lines = int(ceil(tiles/(1.0*tile_columns)))
array line_y0[tile_lines]
array line_y1[tile_lines]
do for [line=1:tile_lines] { line_y0[line] = x0; line_y1[line] = x1 }
load plots."tiles.gp"

eval begin_panels
do for [k=1:tiles] {
    if (k > 1) { eval clear_page }
    eval tile(k)
    do for [line=1:caption_lines - 1] { eval caption(line, k, caption_lines == 2 ? pin_of(k)." on ".link_of(k) : line == 1 ? pin_of(k) : "on ".link_of(k)) }
    eval caption(caption_lines, k, "outer ring ".amount_in(ring_of[k], ring_power).amount_unit(unit_fx, ring_power))
    do for [ring=1:2] { set object ring circle at 0, 0 size ring/2.0 fs empty border rgb "#C0C0C0" lw 1.5 behind }
    do for [spoke=1:3] {
        set arrow spoke from -cos(spoke*pi/4), -sin(spoke*pi/4) to cos(spoke*pi/4), sin(spoke*pi/4) nohead lw 1 lc rgb "#D8D8D8" back
    }
    set arrow 2 from 0, -1 to 0, 1 nohead lw 1.5 lc rgb "#909090" back
    set arrow 4 from -1, 0 to 1, 0 nohead lw 1.5 lc rgb "#909090" back
    scaled = sprintf("using ($1/%.17g):($2/%.17g)", ring_of[k], ring_of[k])
    eval sprintf("plot $ground_%d %s with lines %s notitle, $own_%d %s with lines %s notitle, ", k, scaled, ground_style, k, scaled, own_style).\
        sprintf("$ground_%d %s every ::0::0 with points pt 7 ps 1.3 lc rgb '#0060A8' notitle, ", k, scaled).\
        sprintf("$own_%d %s every ::0::0 with points pt 7 ps 1.5 lc rgb 'black' notitle", k, scaled)
}
eval end_panels
