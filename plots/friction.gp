# The power lost in every joint that rubs at one speed, the force in it, and what starts the linkage from rest.
#   gnuplot -c friction.gp friction.dat OUT SPEED [holding.dat [FIGURE [REMARK]]]

load ARG0[1 : strlen(ARG0) - strlen("friction.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; table_of_starts = argument(4); figure = argument(5); remark = argument(6)

if (table_of_starts ne "") { eval answer(table_of_starts, "facts"); unit_of_start = unit_forward }
eval answer(table, "facts")
load keep("lost", table, sprintf("wide %.17g joint lost", speed))
load keep("forces", table, sprintf("wide %.17g joint force", speed))
pairs = words_in(table, "distinct pin link")
n_joints = words(pairs)
joint(k) = word(word(pairs, k), 1).":".word(word(pairs, k), 2)
joint_names = ""
do for [k=1:n_joints] { joint_names = joint_names.(k > 1 ? " " : "").joint(k) }
headline = numbered(figure, "Friction in the joints, ".at_speed(speed, unit_speed))
note = table_of_starts eq "" ? "" : "forward, backward: what starts the linkage from rest; between them, where they have opposite signs, it holds itself"
source_of(k) = panel == 1 ? "$lost" : panel == 2 ? "$forces" : table_of_starts
columns_from(k) = k > n_joints ? "" : sprintf(" column(%d)", k + 1).columns_from(k + 1)
x = "(panel < 3 ? $1 : field('crank'))"
picked = "1"
x_axis = "eval crank_axis(low_crank, high_crank)"
panels = table_of_starts eq "" ? 2 : 3
array axis_of[3] = ["power lost", "force", "drive at the start"]
array unit_of[3]
array curves_of[3] = [columns_from(1), columns_from(1), "field('forward') field('backward')"]
array titles_of[3]
unit_of[1] = unit_lost
unit_of[2] = unit_force
titles_of[1] = short_names(joint_names, 1)
titles_of[2] = titles_of[1]
titles_of[3] = "forward backward"
if (panels == 3) { unit_of[3] = unit_of_start; eval answer(table_of_starts, "facts") }
call plots."panels.gp"
eval close
