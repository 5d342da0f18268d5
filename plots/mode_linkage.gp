# Of figures of mode shapes, what is placed by the program: ground pivots, clamps, guides, blocks, springs, joints, and pins beside
# the axes of links. After `eval answer(table, "facts")`:
#   call "mode_linkage.gp" SPEED MODES CRANKS SIZE SPAN PARTS
# MODES and CRANKS are lists with commas, SIZE is the largest displacement drawn, SPAN the larger side of the drawing; PARTS of the swing are drawn. Then
# x_min to y_max is the extent of what stands still and of places of links, rest_pose[k] and mode_pose[k] are the poses of mode k
# (see mode_places.awk), and parts of a plot command, each with a comma behind it: fixed_parts; arms_of(pose, style), pale_blocks_of(pose),
# blocks_of(pose), which includes springs, and joints_of(pose, points, ink). clamp_walls(k, size, tag), to be evaluated, draws the walls of mode k.

shapes = out.".linkage"
load "< sh ".quoted(plots."places.sh")." modes ".quoted(shapes)." ".quoted(table)." ".ARG1." ".ARG2." ".ARG3." ".ARG4.\
    sprintf(" %.9g ", 0.011*ARG5).quoted(ARG6)
load plots."shape_parts.gp"

block_layers(n, k, last, pale) = k > last ? "" : polygons(n, k, pale ? layer_pale[k] : k%2 == 0 && block_held[k/2 - drawn_links] \
    ? "#333333" : layer_fill[k]).block_layers(n, k + 1, last, pale)
blocks_of(n) = block_layers(n, 2*drawn_links + 1, body_layers, 0).springs_from(1, $springs[n], 1)
pale_blocks_of(n) = block_layers(n, 2*drawn_links + 1, body_layers, 1)
arms_of(n, style) = arms == 0 ? "" : sprintf("'%s/arms' index %d using 1:2 with lines %s notitle, ", shapes, n - 1, style)
joint_points(n, kind, style) = sprintf("'%s/joints' index %d using ($3 == %d ? $1 : NaN):2 with points %s notitle, ", shapes, n - 1, kind, style)
joints_of(n, size, width, colour) = joints == 0 ? "" : joint_points(n, 1, sprintf("pt 7 ps %g lc rgb 'white'", size)).\
    joint_points(n, 1, sprintf("pt 6 ps %g lw %g lc rgb %s", size, width, colour)).\
    joint_points(n, 2, sprintf("pt 7 ps %g lc rgb %s", size, colour))
clamp_walls(k, size, tag) = sprintf("do for [clamp=1:clamps] { call plots.'ground.gp' word($clamps[%d], 3*clamp - 2) ".\
    "word($clamps[%d], 3*clamp - 1) '%.9g' sprintf('%%d', %d + 10*clamp) 'clamped' word($clamps[%d], 3*clamp) }", k, k, size, tag, k)
held_entry = "eval entry_point('held by its drive', 'pt 7 ps 2.4 lc rgb ink')"
