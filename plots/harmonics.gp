# The harmonics of shaking force, shaking moment and driving torque of one speed, as given and with counterweights.

quantities = answer(table, "distinct quantity")
linkages = answer(table, "distinct linkage")
harmonics = 0
do for [name in columns] { if (name eq sprintf("h%d", harmonics + 1)) { harmonics = harmonics + 1 } }
named(name) = name eq "shaking_x" ? "shaking force x" : name eq "shaking_y" ? "shaking force y" \
    : name eq "shaking_force" ? "shaking force" : name eq "shaking_moment" ? "shaking moment" \
    : name eq "torque" ? "driving torque" : name

# A block of rows: harmonic, then its amplitude for each of the linkages; a panel each.
in_units(what) = system(sprintf("sed -n 's/^# *forces in \\(.*\\), moments and torques in \\(.*\\), phases in .*/\\%d/p' ", what).quoted(table))
force_unit = in_units(1)
moment_unit = in_units(2)
unit_for(name) = strstrt(name, "force") > 0 || name eq "shaking_x" || name eq "shaking_y" ? force_unit : moment_unit

# A block of rows: harmonic, then its amplitude for each of the linkages; a panel each, but for those without any.
array most[words(quantities)]
array title_of[words(quantities)]
kept = ""
tick_room = 0
lines = 1
full_height = 235
set print $bars
do for [k=1:words(quantities)] {
    most[k] = 0.0
    do for [h=1:harmonics] {
        line = sprintf("%d", h)
        do for [linkage in linkages] {
            amplitude = 0.0
            of_this(value) = same(field("speed"), speed) && strcol(col_quantity) eq word(quantities, k) \
                && strcol(col_linkage) eq linkage ? (amplitude = value, value) : NaN
            stats table using (of_this(field(sprintf("h%d", h)))) name "h" nooutput
            most[k] = larger(most[k], amplitude)
            line = line.sprintf(" %.9g", amplitude)
        }
        print line
    }
    print ""
    print ""
    if (most[k] > 0) { kept = kept." ".k }
}
unset print
if (kept eq "") { kept = "1" }
panels = words(kept)
do for [k in kept] {
    title_of[k + 0] = value_title(named(word(quantities, k + 0)), unit_for(word(quantities, k + 0)), 0, most[k + 0])
    tick_room = larger(tick_room, value_width(0, most[k + 0], full_height))
    lines = larger(lines, planned_lines(title_of[k + 0], full_height))
}

# Loads by tables may repeat after several turns only.
turns = system("sed -n 's/^# *over a cycle of \\([0-9]*\\) turns of the crank.*/\\1/p' ".quoted(table))
turns = turns eq "" ? "1" : turns
headline = numbered(figure, sprintf("Harmonics over %s%s, %s", turns eq "1" ? "a turn" : turns." turns", of_cycle ? "" : " of the crank", \
    moment))
note = (of_cycle ? "amplitudes of harmonics k of the ".(turns eq "1" ? "turn" : "cycle") : "amplitudes of cos(k θ₂".(turns eq "1" ? "" : "/".turns)." + phase)").\
    "; the mean is not shown"
gap = 35
lower = foot(lines_of_notes(note, remark))
eval legend_page(125 + lower + panels*(full_height + gap) - gap, 1, widest(linkages, 20), tick_room, lines)
panel_height = (@panel_room - lower + gap)/panels - gap
eval heading
set style fill solid 1 border rgb ink
set boxwidth 0.36
set grid noxtics
set xrange [0.4:harmonics + 0.6]
set xtics 1
set multiplot
do for [place=1:panels] {
    panel = word(kept, place) + 0
    base = lower + (panels - place)*(panel_height + gap)
    set bmargin at screen up(base)
    set tmargin at screen up(base + panel_height)
    set key at screen across(key_left), up(base + panel_height)
    if (place > 1) { do for [label=901:904] { unset label label }; unset key }
    if (place < panels) { set format x "" } else { set format x "%h"; set xlabel "harmonic k" }
    eval value_axis(0, most[panel], panel_height)
    eval axis_title(title_of[panel], base, panel_height)
    if (words(linkages) == 1) {
        plot $bars index panel - 1 using 1:2 with boxes lt 1 lw 1 fc rgb "#303030" notitle
    } else {
        plot $bars index panel - 1 using ($1 - 0.19):2 with boxes lt 1 lw 1 fc rgb "#303030" title word(linkages, 1), \
            $bars index panel - 1 using ($1 + 0.19):3 with boxes lt 1 lw 1 fc rgb "#8FB8DE" title word(linkages, 2)
    }
}
unset multiplot
