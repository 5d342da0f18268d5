# How far pins and points of the elastic linkage are from where rigid links would hold them, of one speed against time.
#   gnuplot -c displacement_history.gp transient.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("displacement_history.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Elastic motion in time, up to %s", at_speed(speed, unit_speed)))
load plots."displaced_points.gp"
x = "field('time')"
x_axis = "eval abscissa(low_time, high_time); set xlabel abscissa_title('time', unit_time, low_time, high_time)"
call plots."panels.gp"
eval close
