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
headline = numbered(figure, subject." ".against.(by_law && kind eq "angles" ? ", ".at_speed(0, "") : ""))
note = link_note
lower = foot(lines_of_notes(note, remark))
pick(k, name) = same(field("speed"), word(speeds, k) + 0) ? field(name) : NaN

# A link that turns on past 180° jumps to −180° in the table; its curve goes on.
curve = ""
turn(step) = step > 180 ? -1 : step < -180 ? 1 : 0
unwrapped(id, angle) = (turns = curve eq id ? turns + turn(angle - previous) : 0, \
    curve = id, previous = angle, angle + 360*turns)
angle(pass, name) = same(field("speed"), word(speeds, 1) + 0) ? unwrapped(pass.name, field(name)) : NaN

speed_text(k) = by_law ? at_speed(0, "") : sprintf("%.5g %s", word(speeds, k) + 0, typeset(unit_speed))

if (kind eq "angles") {
    drawn = drawn." transmission_angle"
    m = words(drawn)
    low = 0.0; high = 0.0; begun = 0
    do for [j=1:m] {
        stats table using (a = angle("extent", word(drawn, j)), low = !begun || a < low ? a : low, \
            high = !begun || a > high ? a : high, begun = a == a ? 1 : begun, a) name "extent" nooutput
    }
    eval page_of_one(m, 60, "angle", unit_theta3, low, high)
    eval crank_axis(low_crank, high_crank)
    if (high - low > 100) { set ytics auto; set ytics high - low > 600 ? 90 : 30 }
    plot for [j=1:m] table using (field("crank")):(angle("line", word(drawn, j))) \
            with linespoints lt j lw line_width(positions) pointinterval mark_step(positions) notitle, \
        for [j=1:m] table using (field("crank")):(angle("dot", word(drawn, j))) with points lt j pt 7 ps dot_size(positions) notitle, \
        for [j=1:m] keyentry with linespoints lt j title j < m ? symbol(word(drawn, j)) : "μ"
} else {
    m = words(drawn)
    panel = 365
    gap = 35
    ticks_room = 0
    do for [name in drawn] { ticks_room = larger(ticks_room, value_width(value("low_".name), value("high_".name), panel)) }
    longest = 0
    do for [k=1:n] { longest = larger(longest, text_width(speed_text(k), 20)) }
    eval legend_page(125 + lower + m*(panel + gap) - gap, n + 1, longest, ticks_room, 1)
    panel = (@panel_room - lower + gap)/m - gap
    eval heading
    set key title by_law ? "" : "crank speed ω₂" left
    set multiplot
    do for [j=1:m] {
        name = word(drawn, j)
        base = lower + (m - j)*(panel + gap)
        set bmargin at screen up(base)
        set tmargin at screen up(base + panel)
        bare = j < m
        eval crank_axis(low_crank, high_crank)
        bare = 0
        if (j < m) { set format x ""; set xlabel "" } else { set format x "%h" }
        if (j > 1) { unset label; unset key }
        eval value_axis(value("low_".name), value("high_".name), panel)
        eval axis_title(value_title(symbol(name), value("unit_".name), value("low_".name), value("high_".name)), base, panel)
        plot for [k=1:n] table using (field("crank")):(pick(k, name)) with lines lt k lw line_width(positions) notitle, \
            for [k=1:n] table using (field("crank")):(pick(k, name)) with points lt k pt 7 ps dot_size(positions) notitle, \
            for [k=1:n] table every mark_step(positions)::mark_first(k, n, positions) using (field("crank")):(pick(k, name)) \
                with points lt k notitle, \
            for [k=1:n] keyentry with linespoints lt k title speed_text(k)
    }
    unset multiplot
}
eval close
