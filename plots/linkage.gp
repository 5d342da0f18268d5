# The linkage at any position, and the points of points.dat or response.dat on its links, as the program places them. After style.gp:
#   call "linkage.gp" [points.dat or response.dat]
# Then blocks of poses are asked for: angles are printed to the file `angles`, a position a line (see places.sh), and
#   load poses_as("block")
# sets the block, the pivots O2 and O4, in parts O2_x to O4_y, whether the crank turns fully, and the links of the points.

table_of_poses = ARG1
angles = out.".angles"
I = {0, 1}
poses_as(block) = sprintf("< sh %s four_bar %s %s %s %s", quoted(plots."places.sh"), quoted(angles.".d"), block, quoted(angles), \
    table_of_poses eq "" ? "" : quoted(table_of_poses))
pose_at(block, crank) = sprintf("set print angles; print '%.17g'; unset print; load poses_as('%s')", crank, block)     # of one, to be evaluated

point_names = table_of_poses eq "" ? "" : words_of(ask(table_of_poses, "distinct point")." | grep -v :")
points = words(point_names)
array point_link[points + 1]
column_of(p) = 4 + 2*p                              # in a row of poses, of the x of a point; its y is in the next
spring_column = 6 + 2*larger(points, 1)             # where the numbers of springs begin

# The extent of a block of poses, with the pivots: x_min, x_max, y_min, y_max and span.
extent = "x_min = real(O2); x_max = x_min; y_min = imag(O2); y_max = y_min; ".\
    "include(x, y) = (x_min = x < x_min ? x : x_min, x_max = x > x_max ? x : x_max, ".\
    "y_min = y < y_min ? y : y_min, y_max = y > y_max ? y : y_max, 0); extent_corner = include(real(O4), imag(O4)); ".\
    "do for [k=1:hooks] { extent_corner = include(hook_x[k], hook_y[k]) }; ".\
    "do for [k=2:(4 + 2*points):2] { stats poses using (include(column(k), column(k + 1))) nooutput }; ".\
    "span = x_max - x_min > y_max - y_min ? x_max - x_min : y_max - y_min"

# The pivots O2 and O4, and where springs are hooked into the ground: to be evaluated.
fixed_pivots(size) = sprintf("call plots.'ground.gp' '%.12g' '%.12g' '%g' '1' 'pinned'; ", O2_x, O2_y, size).\
    sprintf("call plots.'ground.gp' '%.12g' '%.12g' '%g' '11' 'pinned'; ", O4_x, O4_y, size)
ground_hooks(size) = sprintf("do for [hook=1:hooks] { call plots.'ground.gp' sprintf('%%.12g', hook_x[hook]) ".\
    "sprintf('%%.12g', hook_y[hook]) '%.9g' sprintf('%%d', 400 + 10*hook) 'pinned' sprintf('%%d', hook_turn[hook]) }", size)

# Where there are no points, the middle of the coupler is one.
middle_of_coupler = "if (points == 0) { points = 1; array point_link[1]; point_link[1] = 3 }"
