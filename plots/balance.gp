# What shakes the frame, and the driving torque, of one speed against the crank angle: as given, and with counterweights.
#   gnuplot -c balance.gp balance.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("balance.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Shaking force, shaking moment and driving torque, %s", at_speed(speed, unit_speed)))
note = "balanced: with the counterweights of balance.dat on crank and follower, which cancel the shaking force"
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = crank_axis(low_crank, high_crank)."; set xlabel 'crank angle θ₂'.unit('crank')"
panels = 3
array axis_of[3] = ["shaking force".unit("shaking_x"), "shaking moment".unit("shaking_moment"), "driving torque".unit("torque")]
array curves_of[3] = ["sqrt(field('shaking_x')**2+field('shaking_y')**2) sqrt(field('balanced_x')**2+field('balanced_y')**2)", \
    "field('shaking_moment') field('balanced_moment')", "field('torque') field('balanced_torque')"]
array titles_of[3] = ["given balanced", "given balanced", "given balanced"]
call plots."panels.gp"
eval close
