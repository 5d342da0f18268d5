# The moment of inertia reduced to the crank and the terms of its equation of motion, of one speed, against the crank angle.
#   gnuplot -c lagrange.gp lagrange.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("lagrange.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
headline = numbered(figure, sprintf("Lagrange's equation of the %s, %s", \
    of_cycle ? "drive" : by_law ? "crank" : "crank against its angle", at_speed(speed, unit_speed)))
note = of_cycle ? "torque = M α + V + gravity + load,  V = ½ M′ ω², with α and ω of the drive" \
    : "torque = M α₂ + V + gravity + load,  V = ½ M′ ω₂²"
source_of(k) = table
picked = "same(field('speed'),speed)"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"

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
array axis_of[3] = ["reduced inertia M", "torque", "energy"]
array unit_of[3] = [unit_M, unit_torque, unit_kinetic]
array curves_of[3] = ["field('M')", terms, energy_curve("kinetic", low_kinetic, high_kinetic)." ".\
    energy_curve("potential", low_potential, high_potential)]
array titles_of[3] = ["M", titles, energy_title("kinetic", low_kinetic, high_kinetic, unit_kinetic)." ".\
    energy_title("potential", low_potential, high_potential, unit_potential)]
call plots."panels.gp"
eval close
