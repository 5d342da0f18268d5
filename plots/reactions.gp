# The forces at the pins and the driving torque of one speed against the crank angle.
#   gnuplot -c reactions.gp reactions.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("reactions.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Forces at the pins and driving torque %s, %s", against, \
    at_speed(speed, unit_speed)))
note = link_note
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
magnitude(pin) = sprintf("sqrt(field('%sx')**2+field('%sy')**2)", pin, pin)

# At a pin with a mass or a load of its own the two links feel two forces.
unlike(one, other) = (one_force = magnitude(one), sprintf("%s ? abs(%s-%s)/(1e-300+%s) : NaN", picked, one_force, \
    magnitude(other), one_force))
array forces[2] = ["", ""]                          # at the pins of the crank, and at those of the follower
array titles[2] = ["", ""]
do for [pair in "O2: A2:A3 B3:B4 O4:"] {
    one = pair[1:2]
    other = pair[4:5]
    k = one eq "O2" || one eq "A2" ? 1 : 2
    if (other eq "") {
        forces[k] = forces[k]." ".magnitude(one)
        titles[k] = titles[k].sprintf(" '%s'", one)
    } else {
        eval "stats table using (".unlike(one, other).") name 'pin' nooutput"
        forces[k] = forces[k]." ".magnitude(one).(pin_max > 1e-9 ? " ".magnitude(other) : "")
        titles[k] = titles[k].(pin_max > 1e-9 ? sprintf(" '%s on link %s' '%s on link %s'", one[1:1], one[2:2], other[1:1], other[2:2]) \
            : sprintf(" '%s'", one[1:1]))
    }
}
panels = 3
array axis_of[3] = ["force at O2, A", "force at B, O4", "driving torque"]
array unit_of[3] = [unit_O2x, unit_O2x, unit_torque]
array curves_of[3] = [forces[1], forces[2], "field('torque')"]
array titles_of[3] = [titles[1], titles[2], "torque"]
call plots."panels.gp"
eval close
