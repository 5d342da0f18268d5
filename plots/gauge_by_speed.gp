# Strains and stress at one gauge against the crank angle, a curve for every speed.
#   gnuplot -c gauge_by_speed.gp strains.dat OUT GAUGE [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("gauge_by_speed.gp")]."style.gp"
table = ARG1; out = ARG2; gauge = ARG3; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
load plots."strain_panels.gp"
speeds = answer(table, "distinct speed")
headline = numbered(figure, sprintf("Strains and stress at %s against crank angle", inside(gauge, name_length)))
curves = words(speeds)
titles = ""
do for [k=1:curves] { titles = titles.sprintf(" '%.5g %s'", word(speeds, k) + 0, typeset(unit_speed)) }
source_of(k) = rows_if(table, is_named("gauge", gauge)." && ".is_at("speed", word(speeds, k)))
picked = "1"
eval strain_panels
call plots."panels.gp"
eval close
