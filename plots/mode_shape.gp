# A mode shape over the undeformed mechanism.
#   gnuplot -c mode_shape.gp shapes.dat OUT MODE CRANK SPEED [FIGURE [REMARK]]
# OUT has no extension (here and in all scripts); FIGURE is a number for the title, REMARK a line at the foot.

load ARG0[1 : strlen(ARG0) - strlen("mode_shape.gp")]."style.gp"
table = ARG1; out = ARG2; mode = ARG3 + 0; crank = ARG4 + 0; speed = ARG5 + 0; figure = argument(6); remark = argument(7)

load plots."drawing.gp"
eval answer(table, "facts")
parts = "1"
load plots."mode_page.gp"
eval mode_frame
eval mode_shape(1)
eval close
