# The forces at the pins and the shaking force over a turn, at one speed: the linkage at several positions, arrows to one scale.

shown = 8
load plots."force_arrows.gp"
eval scale_of_forces
room = 0.05*span
size = 0.06*span
x0 = x_min - room - 0.5*size
x1 = x_max + room
call plots."bodies.gp" sprintf("%g", 0.016*span)

tiles = |$forces|
tile_columns = tiles <= 3 ? tiles : int((tiles + 1)/2)
array line_y0[2]
array line_y1[2]
do for [k=1:tiles] {
    line = (k - 1)/tile_columns + 1
    if ((k - 1)%tile_columns == 0) { line_y0[line] = lesser(O2_y, O4_y) - 1.6*size; line_y1[line] = larger(O2_y, O4_y) + room }
    do for [pin_drawn=1:5] {
        head = tail_at($places[k], pin_drawn) + scale*force_at($forces[k], pin_drawn)
        tail = tail_at($places[k], pin_drawn)
        line_y0[line] = lesser(line_y0[line], lesser(imag(head), imag(tail)) - room)
        line_y1[line] = larger(line_y1[line], larger(imag(head), imag(tail)) + room)
    }
}
headline = numbered(figure, sprintf("Forces at the pins, %s", moment))
load plots."legend.gp"
tallest = larger(line_y1[1] - line_y0[1], tile_columns < tiles ? line_y1[2] - line_y0[2] : 0)
pixel = lesser(lesser(tile_limit, (1540.0 - lead_room)/tile_columns - 20)/(x1 - x0), 1.25*tile_limit/tallest)
eval entries_of_forces
load plots."tiles.gp"
eval fixed_pivots(size).ground_hooks(size)
set print places
print pins_to_name($places[1], $forces[1])
unset print
load labels_as("names")
eval begin_panels
do for [k=1:tiles] {
    if (k > 1) { eval clear_page }
    eval tile(k)
    eval caption(1, k, "θ₂ = ".minus(sprintf("%.5g°", word($forces[k], 1) + 0)))
    eval arrows_of($places[k], $forces[k])
    names_part = k > 1 ? "" : "$names using ($1/pixel):($2/pixel):(strcol(6)) with labels noenhanced font point_size(15) notitle, "
    eval "plot ".pale_mechanism($places[k]).names_part."NaN notitle"
}
eval end_panels
