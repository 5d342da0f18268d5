# What shakes the frame, and the driving torque, of one speed against the crank angle: as given, and with counterweights.
#   gnuplot -c balance.gp balance.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("balance.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Shaking force, shaking moment and driving torque, %s", at_speed(speed, unit_speed)))
by_cards = system("grep -c '^# rms over a turn' ".quoted(table)) + 0       # those of the BALANCE cards
note = by_cards ? "balanced: with the counterweights and balance shafts of the BALANCE cards" : \
    "balanced: with the counterweights of balance.dat on crank and follower, which cancel the shaking force"
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
panels = 3
array axis_of[3] = ["shaking force", "shaking moment", "driving torque"]
array unit_of[3] = [unit_shaking_x, unit_shaking_moment, unit_torque]
array curves_of[3] = ["sqrt(field('shaking_x')**2+field('shaking_y')**2) sqrt(field('balanced_x')**2+field('balanced_y')**2)", \
    "field('shaking_moment') field('balanced_moment')", "field('torque') field('balanced_torque')"]
array titles_of[3] = ["given balanced", "given balanced", "given balanced"]
call plots."panels.gp"
eval close
