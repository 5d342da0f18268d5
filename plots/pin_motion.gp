# Places, speeds and accelerations of the pins of one speed, of a linkage that is no four-bar.
#   gnuplot -c pin_motion.gp pins.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("pin_motion.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load keep("pins", table, sprintf("wide %.17g pin x y vx vy ax ay", speed))
pin_names = names_in(table, "pin")
n_pins = words(pin_names)
headline = numbered(figure, "Motion of the pins, ".at_speed(speed, unit_speed))
note = "speed and acceleration: sizes of the vectors"
source_of(k) = "$pins"
picked = "1"
x = "$1"
x_axis = "eval crank_axis(low_crank, high_crank)"
legend_once = 1
columns_from(k, first) = k > n_pins ? "" : sprintf(" column(%d)", first + 6*(k - 1)).columns_from(k + 1, first)
sizes_from(k, first) = k > n_pins ? "" : sprintf(" sqrt(column(%d)**2+column(%d)**2)", first + 6*(k - 1), first + 1 + 6*(k - 1)).\
    sizes_from(k + 1, first)
panels = 4
array axis_of[4] = ["x", "y", "speed", "acceleration"]
array unit_of[4] = [unit_x, unit_y, unit_vx, unit_ax]
array curves_of[4] = [columns_from(1, 2), columns_from(1, 3), sizes_from(1, 4), sizes_from(1, 6)]
array titles_of[4]
do for [k=1:4] { titles_of[k] = short_names(pin_names, 1) }
call plots."panels.gp"
eval close
