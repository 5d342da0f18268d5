# A figure of a table.
#   gnuplot -c figure.gp TABLE OUT KIND [ASKED [OTHERS [FIGURE [REMARK]]]]
# OUT has no extension. KIND is that of curves below, or the name of a script beside this one. ASKED is what of the table is drawn:
# a speed, a crank angle, a mode, each if those before it are there; OTHERS are other tables or a name; FIGURE is a number for the title, REMARK a
# line at the foot. Scripts find all this as variables, and may leave the panels of panels.gp to be drawn.

load ARG0[1 : strlen(ARG0) - strlen("figure.gp")]."style.gp"
table = ARG1; out = ARG2; kind = ARG3; asked = argument(4); other = argument(5); figure = argument(6); remark = argument(7)
load plots."drawing.gp"
asked_speed = words(asked) < 1 ? "all" : word(asked, 1)                # with all its digits
speed = words(asked) < 1 ? 0 : word(asked, 1) + 0
crank = words(asked) < 2 ? 0 : word(asked, 2) + 0
mode = words(asked) < 3 ? 0 : word(asked, 3) + 0
other_table(name) = strstrt(" ".other." ", " ".name." ") > 0 ? name : ""

if (table ne "") { eval answer(table, "facts") }
moment = asked eq "" || !exists("unit_speed") ? "" : at_speed(speed, unit_speed)
note = ""
entries = 0                                         # of the legend of a drawing
source_of(k) = table
picked = asked eq "" ? "1" : "same(field('speed'),speed)"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
over(name, title) = sprintf("x = \"field('%s')\"; ", name).\
    sprintf("x_axis = \"eval abscissa(low_%s, high_%s); set xlabel abscissa_title('%s', unit_%s, low_%s, high_%s)\"", name, name, title, name, name, name)

# A panel: the title of its axis and its unit, its curves and their titles. Expressions in fields: of several columns, the size of a
# vector, the same for all that rows_of has found.
declared = 0
array axis_of[99]
array unit_of[99]
array curves_of[99]
array titles_of[99]
panel_of(name, unit, curves, titles) = (declared = declared + 1, axis_of[declared] = name, unit_of[declared] = unit, \
    curves_of[declared] = curves, titles_of[declared] = titles, declared)
fields(names) = fields_from(1, names)
fields_from(k, names) = k > words(names) ? "" : sprintf(" field('%s')", word(names, k)).fields_from(k + 1, names)
size(vector) = sprintf("sqrt(field('%sx')**2+field('%sy')**2)", vector, vector)

# A curve each for what a column names, `eval rows_of("link")`: names, with their beginnings in `shown`.
rows_of(column_and_angle) = "load keep('rows', table, 'rows '.asked_speed.' ".column_and_angle."'); ".\
    "names = names_in(table, '".word(column_and_angle, 1)."'); shown = short_names(names, 1); picked = '1'; ".\
    "source_of(k) = sprintf('$rows%d', k)"
each(expression) = repeated(words(names), expression)

# The frequencies of a table, names and titles: on one high panel, whose axis is that of all rows.
frequencies_of_table = "drawn = ''; shown = ''; lowest = 1e300; highest = -1e300; in_layers = 1; ".\
    "do for [name in columns] { if (is_numbered(name, 'f')) { drawn = drawn.' '.name; shown = shown.' \"mode '.name[2:*].'\"'; ".\
    "lowest = lesser(lowest, value('low_'.name)); highest = larger(highest, value('high_'.name)) } }; legend_entries = words(drawn); ".\
    "height_of(n) = 875 - lower; also_shown(panel) = lowest; also_reached(panel) = highest"

# Energies that are far from zero beside what changes, kinetic ones of a flywheel or potentials, whose zero is a matter of choice, are
# drawn less their least value, as their titles say.
energy_base(low, high) = high - low > 0.25*larger(abs(low), abs(high)) ? 0.0 : low
energy_curve(name) = energy_base(value("low_".name), value("high_".name)) == 0 ? fields(name) \
    : sprintf(" (field('%s')-(%.17g))", name, value("low_".name))
energy_title(name) = energy_base(value("low_".name), value("high_".name)) == 0 ? " ".name : sprintf(" '%s %s %s %s'", name, \
    value("low_".name) > 0 ? "less" : "plus", energy_text(abs(value("low_".name))), typeset(value("unit_".name)))
energy_text(size) = size < 1e4 || size > 1e9 ? sprintf("%.4g", size) : sprintf("%.0f", size)

# Many curves take higher panels, where the page has room.
height_for(list, n) = words(list) < 5 || sized ? (n == 1 ? 700 : n == 2 ? 400 : 330) : 500
if (kind eq "link_motion" || kind eq "pin_motion") { height_of(n) = height_for(names, n) }
if (kind eq "link_motion") {
    headline = "Motion of the links, ".moment
    eval rows_of("link theta")
    added = panel_of("angle θ", unit_theta, each("field('theta')"), shown)
    added = panel_of("velocity ω", unit_omega, each("field('omega')"), shown)
    added = panel_of("acceleration α", unit_alpha, each("field('alpha')"), shown)
    legend_once = 1
}
if (kind eq "pin_motion") {
    headline = "Motion of the pins, ".moment
    note = "speed and acceleration: sizes of the vectors"
    eval rows_of("pin")
    added = panel_of("x", unit_x, each("field('x')"), shown)
    added = panel_of("y", unit_y, each("field('y')"), shown)
    added = panel_of("speed", unit_vx, each(size("v")), shown)
    added = panel_of("acceleration", unit_ax, each(size("a")), shown)
    legend_once = 1
}
if (kind eq "point_rates") {
    eval rows_of("point")
    headline = sprintf("Speed and acceleration of %s".(of_cycle ? "" : " ".against).", %s", \
        words(names) == 1 ? "point ".word(shown, 1) : "points", moment)
    added = panel_of("speed", unit_vx, each(size("v")), shown)
    added = panel_of("acceleration", unit_ax, each(size("a")), shown)
}

# At a pin with a mass or a load of its own the two links feel two forces.
if (kind eq "reactions") {
    headline = sprintf("Forces at the pins and driving torque %s, %s", against, moment)
    note = link_note
    array forces[2] = ["", ""]                      # at the pins of the crank, and at those of the follower
    array titles[2] = ["", ""]
    do for [pair in "O2: A2:A3 B3:B4 O4:"] {
        one = pair[1:2]
        another = pair[4:5]
        k = one eq "O2" || one eq "A2" ? 1 : 2
        unlike = 0
        if (another ne "") {
            eval sprintf("stats table using (%s ? abs(%s - %s)/(1e-300 + %s) : NaN) name 'pin' nooutput", picked, size(one), size(another), size(one))
            unlike = pin_max > 1e-9
        }
        forces[k] = forces[k]." ".size(one).(unlike ? " ".size(another) : "")
        titles[k] = titles[k].(unlike ? sprintf(" \"%s on link %s\" \"%s on link %s\"", \
                pin_named(one[1:1]), one[2:2], pin_named(another[1:1]), another[2:2]) : sprintf(" \"%s\"", pin_named(another eq "" ? one : one[1:1])))
    }
    added = panel_of("force at ".pin_named("O2").", ".pin_named("A"), unit_O2x, forces[1], titles[1])
    added = panel_of("force at ".pin_named("B").", ".pin_named("O4"), unit_O2x, forces[2], titles[2])
    added = panel_of("driving torque", unit_torque, fields("torque"), "torque")
}

# Joints without a force of their own are left out; six in a panel at most, as many in all.
if (kind eq "joint_forces") {
    eval rows_of("pin:link")
    joints_found = words_in(table, "joints ".asked_speed.system("sed -n 's/^GROUND *\\([^ ]*\\).*/ \\1/p' echo.deck 2> /dev/null | tr -d '\n'"))
    names = ""
    do for [joint in joints_found] { names = names." ".quoted_twice(word(joint, 2)) }
    headline = "Forces in the joints, ".moment
    note = strstrt(names, ":") > 0 ? "A:link: force on that link, or of that guide, at pin A; A: the same on both" : ""
    divided = int(ceil(words(names)/6.0))
    in_panel = int(ceil(words(names)/(1.0*divided)))
    source_of(k) = "$rows".word(word(joints_found, (panel - 1)*in_panel + k), 1)
    short_from(k, last) = k > last ? "" : " \"".short_name(names, k)."\"".short_from(k + 1, last)
    do for [k=1:divided] {
        last_joint = lesser(words(names), k*in_panel)
        added = panel_of("force", unit_fx, repeated(last_joint - (k - 1)*in_panel, size("f")), short_from((k - 1)*in_panel + 1, last_joint))
    }
}

# Terms that are zero throughout are left out.
if (kind eq "lagrange") {
    headline = sprintf("Lagrange's equation of the %s, %s", of_cycle ? "drive" : by_law ? "crank" : "crank against its angle", moment)
    note = of_cycle ? "torque = M α + V + gravity + load,  V = ½ M′ ω², with α and ω of the drive" \
        : "torque = M α₂ + V + gravity + load,  V = ½ M′ ω₂²"
    terms = "torque"
    do for [name in "V gravity load"] { if (value("low_".name) != 0 || value("high_".name) != 0) { terms = terms." ".name } }
    added = panel_of("reduced inertia M", unit_M, fields("M"), "M")
    shown = ""
    do for [name in terms] { shown = shown.(name eq "V" ? " 'V, by speed'" : " ".name) }
    added = panel_of("torque", unit_torque, fields(terms), shown)
    added = panel_of("energy", unit_kinetic, energy_curve("kinetic").energy_curve("potential"), energy_title("kinetic").energy_title("potential"))
}
if (kind eq "balance") {
    headline = sprintf("Shaking force, shaking moment and driving torque, %s", moment)
    note = is_by_cards(table) ? "balanced: with the counterweights and balance shafts of the BALANCE cards" : \
        "balanced: with the counterweights of balance.dat on crank and follower, which cancel the shaking force"
    added = panel_of("shaking force", unit_shaking_x, size("shaking_")." ".size("balanced_"), "given balanced")
    added = panel_of("shaking moment", unit_shaking_moment, fields("shaking_moment balanced_moment"), "given balanced")
    added = panel_of("driving torque", unit_torque, fields("torque balanced_torque"), "given balanced")
}

# Torques or forces of the drives, and from another table the shaking force and its moment.
if (kind eq "drive_forces") {
    is_length = strstrt(unit_position." ", "deg") != 1
    eval rows_of("drive")
    added = panel_of(unit_force eq "see_head" ? "torque or force" : is_length ? "driving force" : "driving torque", \
        unit_force eq "see_head" ? "" : unit_force, each("field('force')"), shown)
    when_planned = "headline = (is_length ? 'Driving force' : 'Driving torque').(declared > 1 && is_drawn(2) ? ' and shaking force' : '').', '.moment; ".\
        "note = declared > 1 && is_drawn(2) ? 'shaking force: resultant of −m a of all links' : ''"
    if (other ne "") {
        eval answer(other, "facts")
        source_of(k) = panel == 1 ? sprintf("$rows%d", k) : other
        picked = "same(field('speed'),speed)"
        added = panel_of("shaking force", unit_shaking_x, fields("shaking_x shaking_y"), "'across, x' 'up, y'")
        added = panel_of("shaking moment", unit_shaking_moment, fields("shaking_moment"), "moment")
    }
}

# Coordinates by their units: lengths and angles have panels of their own, efforts and powers those that are not zero throughout.
if (kind eq "coordinates" || kind eq "ratios") {
    has_column(name) = strstrt(" ".columns." ", " ".name." ") > 0
    in_time = has_column("time")
    least_entries = 1
    eval rows_of("coordinate".(has_column("value") ? " value" : ""))
    kinds = words_in(table, "coordinates ".(asked eq "" || in_time ? "all" : asked_speed))
    unit_at(k, place) = word(word(kinds, k), place)
    array members_of[99]
    source_of(k) = "$rows".word(members_of[panel], k)
    pen_of(k) = 1 + (int(word(members_of[panel], k)) - 1)%16
    shown_from(k, list) = k > words(list) ? "" : sprintf(" \"%s\"", word(shown, int(word(list, k)))).shown_from(k + 1, list)
    reference = kind eq "ratios" ? inside(answer(table, "reference"), name_length) : ""
    headline = kind eq "ratios" ? "Changes of coordinates per change of ".reference : \
        in_time ? "Coordinates of the linkage in motion" : "Coordinates of the linkage, ".moment
    if (in_time) { eval over("time", "time") }
    note = kind eq "ratios" ? "a force along a coordinate is balanced by its ratio times this force along ".reference : ""
    # Column, title, place of the unit in `kinds`, kind, whether there has to be an effort. Six in a panel; the others follow in the next.
    plans = kind eq "ratios" ? "'ratio ratio 2 - 0'" : "'value length 2 length 0' 'value angle 2 angle 0' 'rate rate 3 length 0' 'rate rate 3 angle 0' ".\
        "'effort force 4 length 1' 'effort moment 4 angle 1' 'power power 0 - 1'"
    do for [plan in plans] {
        column_drawn = word(plan, 1)
        left = ""
        do for [k=1:words(names)] {
            fits = (word(plan, 4) eq "-" || unit_at(k, 1) eq word(plan, 4)) && (word(plan, 5) + 0 == 0 || unit_at(k, 5) + 0 == 1)
            if (fits) { left = left." ".k }
        }
        if (!has_column(column_drawn)) { left = "" }
        while (words(left) > 0) {
            unit_of_plan(k) = word(plan, 3) + 0 == 0 ? value("unit_".column_drawn) : unit_at(k, word(plan, 3) + 0)
            unit_drawn = unit_of_plan(int(word(left, 1)))
            taken = ""
            rest = ""
            do for [k in left] {
                fits = words(taken) < 6 && unit_of_plan(int(k)) eq unit_drawn
                if (fits) { taken = taken." ".k } else { rest = rest." ".k }
            }
            left = rest
            added = panel_of(word(plan, 2), unit_drawn eq "-" ? "" : unit_drawn, \
                repeated(words(taken), sprintf("field('%s')", column_drawn)), shown_from(1, taken))
            members_of[declared] = taken
            if (word(plan, 5) + 0 == 1) { note = "force, moment: of springs, dampers and drives, positive where they make the coordinate grow; ".\
                "power: what they give to the linkage" }
        }
    }
}

# The power lost in every joint that rubs, the force in it, and from another table what starts the linkage from rest.
if (kind eq "friction") {
    headline = "Friction in the joints, ".moment
    eval rows_of("pin:link")
    added = panel_of("power lost", unit_lost, each("field('lost')"), shown)
    added = panel_of("force", unit_force, each("field('force')"), shown)
    if (other ne "") {
        note = "forward, backward: what starts the linkage from rest; between them, where they have opposite signs, it holds itself"
        x = sprintf("(panel < 3 ? column(%d) : field('crank'))", col_crank)
        eval answer(other, "facts")
        source_of(k) = panel < 3 ? sprintf("$rows%d", k) : other
        added = panel_of("drive at the start", unit_forward, fields("forward backward"), "forward backward")
    }
}

# How far pins and points of the elastic linkage are from where rigid links would hold them, and how far the links are turned at the points,
# over a turn or in time. A pin has a row for each of its links, A:crank and A:coupler, of one displacement; links turn as much as
# their points do, pins have two rotations. Points stand first.
if (kind eq "displacements" || kind eq "transient") {
    headline = kind eq "transient" ? "Elastic motion in time, ".up_to.moment : "Displacements of the elastic linkage against crank angle, ".moment
    if (kind eq "transient") { eval over("time", "time") }
    note = "elastic less rigid linkage, in global axes"
    points = displaced_points(table)
    pins = displaced_pins(table)
    shown_points = points eq "" ? "" : short_names(points, 1)
    shown = shown_points
    do for [name in pins] { shown = shown." ".quoted_twice(inside(pin_of(name), name_length)) }
    names = points." ".pins
    source_of(k) = rows_if(table, is_named("point", word(names, k)))
    added = panel_of("displacement x", unit_ux, each("field('ux')"), shown)
    added = panel_of("displacement y", unit_uy, each("field('uy')"), shown)
    if (words(points) > 0) {
        note = note."; rotation: of the link at its point"
        added = panel_of("rotation", unit_rotation, repeated(words(points), "field('rotation')"), shown_points)
    }
}

# Strains and stresses at the gauges over a turn or in time, and at one of them for every speed.
if (kind eq "strains" || kind eq "transient_strains" || kind eq "gauge") {
    note = "strains of the axis and, by bending alone, of the face of the gauge; stress: the largest of the cross-section"
    if (kind eq "gauge") {
        headline = sprintf("Strains and stress at %s against crank angle", inside(other, name_length))
        names = answer(table, "distinct speed")
        shown = ""
        do for [name in names] { shown = shown.sprintf(" '%.5g %s'", name + 0, typeset(unit_speed)) }
        source_of(k) = rows_if(table, is_named("gauge", other)." && ".is_at("speed", word(names, k)))
    } else {
        eval rows_of("gauge")
        at_gauges = words(names) == 1 ? "at ".word(shown, 1)." " : kind eq "strains" ? "" : "at gauges "
        headline = kind eq "strains" ? sprintf("Strains and stress %sagainst crank angle, %s", at_gauges, moment) \
            : "Strains and stress in time ".at_gauges[1:strlen(at_gauges) - 1].", ".up_to.moment
    }
    if (kind eq "transient_strains") { eval over("time", "time") }
    added = panel_of("bending strain", "µε", each("1e6*field('bending_strain')"), shown)
    added = panel_of("axial strain", "µε", each("1e6*field('axial_strain')"), shown)
    added = panel_of("stress", unit_stress, each("field('stress')"), shown)
}
if (kind eq "drive") {
    headline = "Driving torque and power of the elastic linkage against crank angle, ".moment
    note = "total = rigid (of rigid links) + linear + quadratic (in the elastic response);  power = total torque × ω₂"
    added = panel_of("driving torque", unit_total, fields("total rigid"), "total rigid")
    added = panel_of("elastic torque", unit_linear, fields("linear quadratic"), "linear quadratic")
    added = panel_of("power", unit_power, fields("power"), "power")
}

# What limits the elastic response of every link: its deflection, its compression, terms that are left out.
if (kind eq "validity") {
    headline = "Limits of the elastic response against the speed of the crank"
    note = "deflection: largest over a turn, linear equations become unreliable beyond 1 %;  buckling: of the link as pinned at both ends"
    if (remark eq "") { remark = "distance from resonance: least |1 − ρ| of the multipliers ρ of a turn" }
    eval rows_of("link")
    eval over("speed", "crank speed ω₂")
    is_logarithmic(panel) = panel < 4
    also_shown(panel) = panel == 1 ? 1.0 : NaN
    before_panel(panel) = panel != 1 ? "unset arrow 999" \
        : "set arrow 999 from graph 0, first 1 to graph 1, first 1 nohead front lw 2.5 lc rgb '#A01850' dt solid"
    added = panel_of("deflection / length", "%", each("100*field('deflection')"), shown)
    added = panel_of("load / buckling load", "%", each("100*field('load')"), shown)
    added = panel_of("quadratic terms", "%", each("(strcol(col_quadratic)eq'-'?0:100*abs(field('quadratic')))"), shown)
    added = panel_of("distance |1 − ρ|", "", fields("distance"), "distance")
    # The same links in three panels, whose legend is beside the first, with the line; the distance is not between its speeds what it is at them.
    least_entries = 99
    pen_of(k) = panel == 4 ? 6 : k
    line_of(panel) = panel == 4 ? "dots" : "lines"
    legend_from(k) = k > words(names) ? "" : sprintf(", keyentry with linespoints lt %d title word(shown, %d)", k, k).legend_from(k + 1)
    key_longest = text_width("1 %, a limit", 20)
    keys_of(panel) = panel > 1 ? "" : legend_from(1).", keyentry with lines lw 2.5 lc rgb '#A01850' dt solid title '1 %, a limit'"
}

# Angles of a four-bar do not depend on the speed; their rates have a panel a link and a curve a speed.
if (kind eq "kinematics") {
    rate = other eq "angles" ? 1 : other eq "velocities" ? 2 : 3
    stem = word("theta omega alpha", rate)
    drawn = ""
    do for [name in columns] { if (name[1:5] eq stem) { drawn = drawn." ".name } }
    number(name) = int(name[6:*])
    symbol(name) = name[1:5] ne stem ? "μ" : word("θ ω α", rate).\
        (number(name) < 10 ? word("₁ ₂ ₃ ₄ ₅ ₆ ₇ ₈ ₉", number(name)) : sprintf("%d", number(name)))
    names = answer(table, "distinct speed")
    note = link_note
    in_layers = 1
    picked = "1"
    if (other eq "angles") {
        headline = "Link angles and transmission angle μ ".against.(by_law ? ", ".at_speed(0, "") : "")
        drawn = drawn." transmission_angle"
        load keep("rows", table, "rows ".word(names, 1)." speed".drawn)
        source_of(k) = "$rows1"
        shown = ""
        do for [name in drawn] { shown = shown." ".symbol(name) }
        added = panel_of("angle", unit_theta3, fields(drawn), shown)
        height_of(n) = 875 - lower
        marks_shifted = 0
        least_entries = 1
        before_panel(panel) = high_of[1] - low_of[1] > 100 ? sprintf("set ytics auto; set ytics %d", high_of[1] - low_of[1] > 600 ? 90 : 30) : ""
    } else {
        headline = (other eq "velocities" ? "Angular velocities " : "Angular accelerations ").against
        load keep("rows", table, "rows all speed")
        source_of(k) = sprintf("$rows%d", k)
        shown = ""
        do for [name in names] { shown = shown.sprintf(" '%s'", by_law ? at_speed(0, "") : sprintf("%.5g %s", name + 0, typeset(unit_speed))) }
        do for [name in drawn] { added = panel_of(symbol(name), value("unit_".name), each(fields(name)[2:*]), shown) }
        height_of(n) = 365
        zeros_kept = 1
        legend_once = 1
        legend_title = by_law ? "" : "crank speed ω₂"
        legend_entries = words(names) + 1
    }
}

# All frequencies of one speed; all speeds share one axis.
if (kind eq "frequencies") {
    headline = sprintf("Natural frequencies %s, %s", against_position(unit_crank), moment)
    eval frequencies_of_table
    note = lowest < 0 ? divergence : ""
    added = panel_of("natural frequency", value("unit_".word(drawn, 1)), fields(drawn), shown)
    pen_of(k) = int(word(drawn, k)[2:*])
    least_entries = 1
}
# The estimated relative errors of all frequencies of one speed; all speeds share one axis, of whole decades, two at least. Zero, which has no
# place on such an axis, lies on its lower edge.
if (kind eq "errors") {
    headline = sprintf("Estimated errors of the natural frequencies %s, %s", against_position(unit_crank), moment)
    drawn = ""
    shown = ""
    do for [name in columns] { if (is_numbered(name, "error")) { drawn = drawn." ".name; shown = shown." 'mode ".name[6:*]."'" } }
    zeros = word(answer(table, "range".drawn), 1) + 0.0 <= 0
    note = zeros ? "on the lower edge: no error" : ""
    positive = answer(table, "positive".drawn)      # empty: all are zero
    bottom = floor(log10(positive eq "" ? 1e-16 : word(positive, 1) + 0.0)) - zeros
    top = larger(bottom + 2, ceil(log10(positive eq "" ? 1e-16 : word(positive, 2) + 0.0)))
    above_zero(value) = value > 0 ? value : 10.0**bottom
    errors_from(k) = k > words(drawn) ? "" : sprintf(" above_zero(field('%s'))", word(drawn, k)).errors_from(k + 1)
    added = panel_of("estimated relative error", "", errors_from(1), shown)
    is_logarithmic(panel) = 1
    before_panel(panel) = sprintf("set yrange [%g:%g]; set ytics (%s)", 10.0**bottom, 10.0**top, \
        log_ticks(1.3*10.0**bottom, 10.0**top/1.3, panel_height))
    tick_room_of(panel) = 80
    height_of(n) = 875 - lower
    pen_of(k) = int(word(drawn, k)[6:*])
    in_layers = 1
    least_entries = 1
    legend_entries = words(drawn)
}
if (declared == 0) { load plots.kind.".gp" }
if (declared > 0) {
    panels = declared
    call plots."panels.gp"
}
eval close
