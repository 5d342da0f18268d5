# The forces at the pins and the driving torque of one speed against the crank angle.
#   gnuplot -c reactions.gp reactions.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("reactions.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Forces at the pins and driving torque against crank angle, %s", at_speed(speed, unit_speed)))
note = cut(link_note, 110)
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = crank_axis(low_crank, high_crank)."; set xlabel 'crank angle θ₂'.unit('crank')"
magnitude(pin) = sprintf("sqrt(field('%sx')**2+field('%sy')**2)", pin, pin)

# At a pin with a mass or a load of its own the two links feel two forces.
unlike(one, other) = (one_force = magnitude(one), sprintf("%s ? abs(%s-%s)/(1e-300+%s) : NaN", picked, one_force, \
    magnitude(other), one_force))
forces = ""
titles = ""
do for [pair in "O2: A2:A3 B3:B4 O4:"] {
    one = pair[1:2]
    other = pair[4:5]
    if (other eq "") {
        forces = forces." ".magnitude(one)
        titles = titles.sprintf(" '%s'", one)
    } else {
        eval "stats table using (".unlike(one, other).") name 'pin' nooutput"
        forces = forces." ".magnitude(one).(pin_max > 1e-9 ? " ".magnitude(other) : "")
        titles = titles.(pin_max > 1e-9 ? sprintf(" '%s on link %s' '%s on link %s'", one[1:1], one[2:2], other[1:1], other[2:2]) \
            : sprintf(" '%s'", one[1:1]))
    }
}
panels = 2
array axis_of[2] = ["force".unit("O2x"), "driving torque".unit("torque")]
array curves_of[2] = [forces, "field('torque')"]
array titles_of[2] = [titles, "'torque'"]
call plots."panels.gp"
eval close
