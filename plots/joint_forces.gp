# The sizes of the forces in the joints of one speed, of a linkage that is no four-bar.
#   gnuplot -c joint_forces.gp reactions.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("joint_forces.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load keep("joints", table, sprintf("joints %.17g", speed))
joint_names = words_in(table, sprintf("joint_names %.17g", speed))
n_joints = words(joint_names)
headline = numbered(figure, "Forces in the joints, ".at_speed(speed, unit_speed))
note = strstrt(joint_names, ":") > 0 ? "A:link: force on that link, or of that guide, at pin A; A: the same on both" : ""
source_of(k) = "$joints"
picked = "1"
x = "$1"
x_axis = "eval crank_axis(low_crank, high_crank)"

# Six in a panel at most, as many in all.
panels = int(ceil(n_joints/6.0))
in_panel = int(ceil(n_joints/(1.0*panels)))
last_of(panel) = lesser(n_joints, panel*in_panel)
columns_from(k, last) = k > last ? "" : sprintf(" column(%d)", k + 1).columns_from(k + 1, last)
short_from(k, last) = k > last ? "" : " \"".short_name(joint_names, k)."\"".short_from(k + 1, last)
array axis_of[panels]
array unit_of[panels]
array curves_of[panels]
array titles_of[panels]
do for [panel=1:panels] {
    axis_of[panel] = "force"
    unit_of[panel] = unit_fx
    curves_of[panel] = columns_from((panel - 1)*in_panel + 1, last_of(panel))
    titles_of[panel] = short_from((panel - 1)*in_panel + 1, last_of(panel))
}
call plots."panels.gp"
eval close
