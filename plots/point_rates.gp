# Speed and acceleration of the points of points.dat, for one speed of the crank, against the crank angle.
#   gnuplot -c point_rates.gp points.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("point_rates.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
names = names_in(table, "point")
headline = numbered(figure, sprintf("Speed and acceleration of %s".(of_cycle ? "" : " ".against).", %s", \
    words(names) == 1 ? "point ".short_name(names, 1) : "points", at_speed(speed, unit_speed)))
note = ""
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
picked = "same(field('speed'),speed)"

# Every point is a table of its own, with an empty line where rows have failed.
source_of(k) = rows_if(table, is_named("point", word(names, k)))
panels = 2
array axis_of[2] = ["speed", "acceleration"]
array unit_of[2] = [unit_vx, unit_ax]
array curves_of[2] = [repeated(words(names), "sqrt(field('vx')**2+field('vy')**2)"), \
    repeated(words(names), "sqrt(field('ax')**2+field('ay')**2)")]
shown_names = short_names(names, 1)
array titles_of[2] = [shown_names, shown_names]
call plots."panels.gp"
eval close
