# The harmonics of shaking force, shaking moment and driving torque of one speed, as given and with counterweights.
#   gnuplot -c harmonics.gp harmonics.dat OUT SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("harmonics.gp")]."style.gp"
table = ARG1; out = ARG2; speed = ARG3 + 0; figure = argument(4); remark = argument(5)

eval answer(table, "facts")
quantities = answer(table, "distinct quantity")
linkages = answer(table, "distinct linkage")
panels = words(quantities)
harmonics = 0
do for [name in columns] { if (name eq sprintf("h%d", harmonics + 1)) { harmonics = harmonics + 1 } }
named(name) = name eq "shaking_x" ? "shaking force x" : name eq "shaking_y" ? "shaking force y" \
    : name eq "shaking_force" ? "shaking force" : name eq "shaking_moment" ? "shaking moment" \
    : name eq "torque" ? "driving torque" : name

# A block of rows: harmonic, then its amplitude for each of the linkages; a panel each.
array most[panels]
set print $bars
do for [panel=1:panels] {
    most[panel] = 0
    do for [k=1:harmonics] {
        line = sprintf("%d", k)
        do for [linkage in linkages] {
            amplitude = 0.0
            of_this(value) = same(field("speed"), speed) && strcol(col_quantity) eq word(quantities, panel) \
                && strcol(col_linkage) eq linkage ? (amplitude = value, value) : NaN
            stats table using (of_this(field(sprintf("h%d", k)))) name "h" nooutput
            most[panel] = amplitude > most[panel] ? amplitude : most[panel]
            line = line.sprintf(" %.9g", amplitude)
        }
        print line
    }
    print ""
    print ""
}
unset print

headline = numbered(figure, sprintf("Harmonics over a turn of the crank, %s", at_speed(speed, unit_speed)))
in_units = system("sed -n 's/^# \\(forces in .*\\), phases in .*/\\1/p' ".quoted(table))
note = "amplitudes of cos(k θ₂ + phase), without the mean".(in_units eq "" ? "" : ";  ".typeset(in_units))
panel_height = 235
gap = 35
lower = foot(lines_of_notes(note, remark))
eval legend_page(125 + lower + panels*(panel_height + gap) - gap, 1)
eval heading
set style fill solid 1 border rgb ink
set boxwidth 0.36
set grid noxtics
set xrange [0.4:harmonics + 0.6]
set xtics 1
set multiplot
do for [panel=1:panels] {
    base = lower + (panels - panel)*(panel_height + gap)
    set bmargin at screen up(base)
    set tmargin at screen up(base + panel_height)
    set key at screen across(1305), up(base + panel_height)
    if (panel > 1) { do for [label=901:904] { unset label label }; unset key }
    if (panel < panels) { set format x "" } else { set format x "%h"; set xlabel "harmonic k" }
    top = most[panel] > 0 ? 1.1*most[panel] : 1.0
    set yrange [0:top]
    set ytics nice(top/5)
    set ylabel named(word(quantities, panel)) noenhanced
    plot $bars index panel - 1 using ($1 - 0.19):2 with boxes lt 1 lw 1 fc rgb "#303030" title word(linkages, 1), \
        $bars index panel - 1 using ($1 + 0.19):3 with boxes lt 1 lw 1 fc rgb "#8FB8DE" title word(linkages, 2)
}
unset multiplot
eval close
