# The motion of motion.dat in real time, or slowed down if it lasts less than a second or two; of a long one, the first six seconds.

eval smaller(0.65)

call plots."linkage.gp" other
eval middle_of_coupler

call plots."motion_pictures.gp"

shown = (pictures - 1)*every_row + 1
array crank[shown]
array branch[shown]
array seconds[shown]
array rates[shown]
keep_pose(n) = n > shown ? NaN : (seconds[n] = field("time"), rates[n] = field("omega2"), crank[n] = field("crank"), \
    branch[n] = strcol(col_branch), n)
stats table using (keep_pose(int(column(0)) + 1)) nooutput
set print angles
do for [k=1:shown] { print sprintf("%.17g %s", crank[k], branch[k]) }
unset print
load poses_as("poses")

note = slower == 1 ? "" : sprintf("slowed down %g times", slower)
caption(n) = sprintf("t = %.2f %s,  ω₂ = %.1f %s", seconds[n], unit_time, rates[n], unit_omega2)
tail = 6
call plots."animate_poses.gp" delay pictures every_row
