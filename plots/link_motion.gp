# Angles, angular velocities and angular accelerations of the links of one speed, of a linkage that is no four-bar.
#   gnuplot -c link_motion.gp kinematics.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("link_motion.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load keep("links", table, sprintf("wide %.17g link theta omega alpha", speed))
link_names = names_in(table, "link")
n_links = words(link_names)
headline = numbered(figure, "Motion of the links, ".at_speed(speed, unit_speed))
note = ""
source_of(k) = "$links"
picked = "1"
x = "$1"
x_axis = "eval crank_axis(low_crank, high_crank)"
legend_once = 1
columns_from(k, first) = k > n_links ? "" : sprintf(" column(%d)", first + 3*(k - 1)).columns_from(k + 1, first)
panels = 3
array axis_of[3] = ["angle θ", "velocity ω", "acceleration α"]
array unit_of[3] = [unit_theta, unit_omega, unit_alpha]
array curves_of[3] = [columns_from(1, 2), columns_from(1, 3), columns_from(1, 4)]
array titles_of[3]
do for [k=1:3] { titles_of[k] = short_names(link_names, 1) }
call plots."panels.gp"
eval close
