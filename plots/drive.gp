# The driving torque of the elastic linkage with its parts, and its power, of one speed against the crank angle.
#   gnuplot -c drive.gp drive.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("drive.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Driving torque and power of the elastic linkage against crank angle, %s", \
    at_speed(speed, unit_speed)))
note = "total = rigid (of rigid links) + linear + quadratic (in the elastic response);  power = total torque × ω₂"
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
panels = 3
array axis_of[3] = ["driving torque", "elastic torque", "power"]
array unit_of[3] = [unit_total, unit_linear, unit_power]
array curves_of[3] = ["field('total') field('rigid')", "field('linear') field('quadratic')", "field('power')"]
array titles_of[3] = ["total rigid", "linear quadratic", "power"]
call plots."panels.gp"
eval close
