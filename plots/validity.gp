# What limits the elastic response of every link, against the speed: its deflection, its compression, terms that are left out.
#   gnuplot -c validity.gp validity.dat OUT [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("validity.gp")]."style.gp"
table = ARG1; out = ARG2; figure = argument(3); remark = argument(4)

eval answer(table, "facts")
links = names_in(table, "link")
n = words(links)
shown_links = short_names(links, 1)
headline = numbered(figure, "Limits of the elastic response against the speed of the crank")
note = "deflection: largest over a turn, linear equations become unreliable beyond 1 %;  buckling: of the link as pinned at both ends"
if (remark eq "") { remark = "distance from resonance: least |1 − ρ| of the multipliers ρ of a turn" }
source_of(k) = rows_if(table, is_named("link", word(links, k)))
picked = "1"
x = "field('speed')"
x_axis = "eval abscissa(low_speed, high_speed); set xlabel abscissa_title('crank speed ω₂', unit_speed, low_speed, high_speed)"
panels = 4
is_logarithmic(panel) = panel < 4
also_shown(panel) = panel == 1 ? 1.0 : NaN
before_panel(panel) = panel != 1 ? "unset arrow 999" \
    : "set arrow 999 from graph 0, first 1 to graph 1, first 1 nohead front lw 2.5 lc rgb '#A01850' dt solid"
array axis_of[4] = ["deflection / length", "load / buckling load", "quadratic terms", "distance |1 − ρ|"]
array unit_of[4] = ["%", "%", "%", ""]
array curves_of[4] = [repeated(n, "100*field('deflection')"), repeated(n, "100*field('load')"), \
    repeated(n, "(strcol(col_quadratic)eq'-'?0:100*abs(field('quadratic')))"), "field('distance')"]
array titles_of[4] = [shown_links, shown_links, shown_links, "distance"]
call plots."panels.gp"
eval close
