# The moment of inertia that the crank feels and the terms of its equation of motion, of one speed, against the crank angle.
#   gnuplot -c lagrange.gp lagrange.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("lagrange.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Lagrange's equation of the crank against its angle, %s", at_speed(speed, unit_speed)))
note = "torque = M α₂ + V + gravity + load,  V = ½ M′ ω₂²"
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = crank_axis(low_crank, high_crank)."; set xlabel 'crank angle θ₂'.unit('crank')"

# Terms that are zero throughout are left out.
terms = ""
titles = ""
do for [name in "torque V gravity load"] {
    if (name eq "torque" || value("low_".name) != 0 || value("high_".name) != 0) {
        terms = terms.sprintf(" field('%s')", name)
        titles = titles.sprintf(" '%s'", name)
    }
}
panels = 3
array axis_of[3] = ["inertia M".unit("M"), "torque".unit("torque"), "energy [".typeset(unit_kinetic)."]"]
array curves_of[3] = ["field('M')", terms, "field('kinetic') field('potential')"]
array titles_of[3] = ["M", titles, "kinetic potential"]
call plots."panels.gp"
eval close
