# Torques or forces of the drives of one speed, the shaking force and its moment, of a linkage that is no four-bar.
#   gnuplot -c drive_forces.gp drive.dat OUT SPEED [shaking.dat [FIGURE [REMARK]]]

load ARG0[1 : strlen(ARG0) - strlen("drive_forces.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; table_of_shaking = argument(4); figure = argument(5); remark = argument(6)

eval answer(table, "facts")
load keep("drives", table, sprintf("wide %.17g drive force", speed))
drive_names = names_in(table, "drive")
n_drives = words(drive_names)
is_length = strstrt(unit_position." ", "deg") != 1
named_force = unit_force eq "see_head" ? "torque or force" : is_length ? "driving force" : "driving torque"
unit_of_force = unit_force eq "see_head" ? "" : unit_force
if (table_of_shaking ne "") { eval answer(table_of_shaking, "facts") }
headline = numbered(figure, (is_length ? "Driving force" : "Driving torque").\
    (table_of_shaking ne "" ? " and shaking force" : "").", ".at_speed(speed, unit_speed))
note = table_of_shaking eq "" ? "" : "shaking force: resultant of −m a of all links"
source_of(k) = panel == 1 ? "$drives" : table_of_shaking
columns_from(k) = k > n_drives ? "" : sprintf(" column(%d)", k + 1).columns_from(k + 1)
x = "(panel == 1 ? $1 : field('crank'))"
picked = "(panel == 1 || same(field('speed'),speed))"
x_axis = "eval crank_axis(low_crank, high_crank)"
panels = table_of_shaking eq "" ? 1 : 3
array axis_of[3] = [named_force, "shaking force", "shaking moment"]
array unit_of[3]
unit_of[1] = unit_of_force
array curves_of[3] = [columns_from(1), "field('shaking_x') field('shaking_y')", "field('shaking_moment')"]
array titles_of[3]
titles_of[1] = short_names(drive_names, 1)
titles_of[2] = "'across, x' 'up, y'"
titles_of[3] = "moment"
if (panels == 3) {
    unit_of[2] = unit_shaking_x
    unit_of[3] = unit_shaking_moment
}
call plots."panels.gp"
eval close
