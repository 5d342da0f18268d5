# Strains and stresses at the gauges, of one speed, against the crank angle.
#   gnuplot -c strains.gp strains.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("strains.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load plots."strain_panels.gp"
names = names_in(table, "gauge")
headline = numbered(figure, sprintf("Strains and stress %sagainst crank angle, %s", \
    words(names) == 1 ? "at ".short_name(names, 1)." " : "", at_speed(speed, unit_speed)))
curves = words(names)
titles = short_names(names, 1)
source_of(k) = rows_if(table, is_named("gauge", word(names, k)))
picked = "same(field('speed'),speed)"
eval strain_panels
call plots."panels.gp"
eval close
