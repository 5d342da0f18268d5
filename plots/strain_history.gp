# Strains and stresses at the gauges of a motion in time, of one speed.
#   gnuplot -c strain_history.gp gauges.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("strain_history.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load plots."strain_panels.gp"
names = names_in(table, "gauge")
headline = numbered(figure, sprintf("Strains and stress in time %s, up to %s", \
    words(names) == 1 ? "at ".short_name(names, 1) : "at gauges", at_speed(speed, unit_speed)))
curves = words(names)
titles = short_names(names, 1)
source_of(k) = rows_if(table, is_named("gauge", word(names, k)))
picked = "same(field('speed'),speed)"
eval strain_panels
x = "field('time')"
x_axis = "eval abscissa(low_time, high_time); set xlabel abscissa_title('time', unit_time, low_time, high_time)"
call plots."panels.gp"
eval close
