# Angles, angular velocities or angular accelerations against the crank angle.
#   gnuplot -c kinematics.gp kinematics.dat OUT angles|velocities|accelerations [FIGURE [REMARK]]
# The angles do not depend on the speed and share one panel; the others have a panel a link and a curve a speed.

load ARG0[1 : strlen(ARG0) - strlen("kinematics.gp")]."style.gp"
table = ARG1; out = ARG2; kind = ARG3; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
stem = kind eq "angles" ? "theta" : kind eq "velocities" ? "omega" : "alpha"
letter = kind eq "angles" ? "θ" : kind eq "velocities" ? "ω" : "α"
subject = kind eq "angles" ? "Link angles and transmission angle μ" \
    : kind eq "velocities" ? "Angular velocities" : "Angular accelerations"
drawn = ""
do for [name in columns] { if (name[1 : strlen(stem)] eq stem) { drawn = drawn." ".name } }
number(name) = int(name[strlen(stem) + 1 : *])
symbol(name) = letter.(number(name) < 10 ? word("₁ ₂ ₃ ₄ ₅ ₆ ₇ ₈ ₉", number(name)) : sprintf("%d", number(name)))

speeds = answer(table, "distinct speed")
n = words(speeds)
positions = rows/n
headline = numbered(figure, subject." against crank angle")
note = cut(link_note, 110)
lower = foot(lines_of_notes(note, remark))
pick(k, name) = same(field("speed"), word(speeds, k) + 0) ? field(name) : NaN

# A link that turns on past 180° jumps to −180° in the table; its curve goes on.
curve = ""
turn(step) = step > 180 ? -1 : step < -180 ? 1 : 0
unwrapped(id, angle) = (turns = curve eq id ? turns + turn(angle - previous) : 0, \
    curve = id, previous = angle, angle + 360*turns)
angle(pass, name) = same(field("speed"), word(speeds, 1) + 0) ? unwrapped(pass.name, field(name)) : NaN

if (kind eq "angles") {
    drawn = drawn." transmission_angle"
    m = words(drawn)
    eval curve_page(1000)
    eval heading
    eval crank_axis(low_crank, high_crank)
    set tmargin at screen down(125)
    set bmargin at screen up(lower)
    set offsets graph 0, 0, 0.03, 0.03
    set ytics 30
    set xlabel "crank angle θ₂".unit("crank")
    set ylabel "angle".unit("theta3")
    plot for [j=1:m] table using (field("crank")):(angle("line", word(drawn, j))) \
            with linespoints lt j pointinterval mark_step(positions) notitle, \
        for [j=1:m] table using (field("crank")):(angle("dot", word(drawn, j))) with points lt j pt 7 ps 0.4 notitle, \
        for [j=1:m] keyentry with linespoints lt j title j < m ? symbol(word(drawn, j)) : "μ"
} else {
    m = words(drawn)
    panel = 365
    gap = 35
    eval curve_page(125 + lower + m*(panel + gap) - gap)
    eval heading
    eval crank_axis(low_crank, high_crank)
    set offsets graph 0, 0, 0.05, 0.05
    set key title "crank speed ω₂" left
    eval zero_line
    set multiplot
    do for [j=1:m] {
        name = word(drawn, j)
        set bmargin at screen up(lower + (m - j)*(panel + gap))
        set tmargin at screen up(lower + (m - j)*(panel + gap) + panel)
        if (j < m) { set format x "" } else { set format x "%h"; set xlabel "crank angle θ₂".unit("crank") }
        if (j > 1) { unset label; unset key }
        eval value_axis(value("low_".name), value("high_".name))
        set ylabel symbol(name).unit(name)
        plot for [k=1:n] table using (field("crank")):(pick(k, name)) with lines lt k notitle, \
            for [k=1:n] table using (field("crank")):(pick(k, name)) with points lt k pt 7 ps 0.4 notitle, \
            for [k=1:n] table every mark_step(positions)::mark_first(k, n, positions) using (field("crank")):(pick(k, name)) \
                with points lt k notitle, \
            for [k=1:n] keyentry with linespoints lt k title sprintf("%.5g %s", word(speeds, k) + 0, unit_speed)
    }
    unset multiplot
}
eval close
