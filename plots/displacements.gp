# How far pins and points of the elastic linkage are from where rigid links would hold them, and how far the links are turned at
# the points, of one speed against the crank angle.
#   gnuplot -c displacements.gp response.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("displacements.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Displacements of the elastic linkage against crank angle, %s", at_speed(speed, unit_speed)))

load plots."displaced_points.gp"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
call plots."panels.gp"
eval close
