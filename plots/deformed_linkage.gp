# The linkage as it bends in the elastic response at one speed: several positions of a turn, displacements made larger.

want_positions = 8
load plots."deformed.gp"
eval include_moved(1, positions_drawn)
room = 0.05*span
size = 0.06*span
x0 = x_min - room - 0.5*size
x1 = x_max + room

tiles = positions_drawn
tile_columns = tiles <= 3 ? tiles : int((tiles + 1)/2)
array line_y0[2]
array line_y1[2]
do for [line=1:(tiles - 1)/tile_columns + 1] {
    y_min = lesser(O2_y, O4_y)
    y_max = larger(O2_y, O4_y)
    eval include_moved(tile_columns*(line - 1) + 1, lesser(tiles, tile_columns*line))
    line_y0[line] = lesser(y_min, lesser(O2_y, O4_y) - 1.2*size) - room
    line_y1[line] = y_max + room
}
headline = numbered(figure, sprintf("Elastic linkage over a turn, %s", moment))
note = magnified_text."; links drawn as cubics between the displacements and rotations of their ends"
load plots."legend.gp"
eval entry_line("rigid links", rigid_look)
eval entry_line("elastic links", bent_look)
do for [p=1:points] { eval entry_point(short_name(point_names, p), sprintf("pt 7 ps 2 lc rgb '%s'", point_ink(p))) }
load plots."tiles.gp"
eval fixed_pivots(size)
eval begin_panels
do for [k=1:tiles] {
    if (k > 1) { eval clear_page }
    eval tile(k)
    eval caption(1, k, sprintf("θ₂ = %.5g°", word($moved[k], 1) + 0))
    eval "plot ".deformed_linkage($poses[k], $moved[k])."NaN notitle"
}
eval end_panels
