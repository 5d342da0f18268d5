# A polar plot of the shaking force of one speed: as given and, from balance.dat, with counterweights; from frame.dat, beside the
# force on the frame.

of_frame = strstrt(" ".columns." ", " frame_x ") > 0
balanced = of_frame || strstrt(" ".columns." ", " balanced_x ") > 0
load keep("given", table, "path ".asked_speed." shaking_x shaking_y")          # columns: see tables.awk
if (balanced) { load keep("balanced", table, "path ".asked_speed.(of_frame ? " frame_x frame_y" : " balanced_x balanced_y")) }
if (!balanced) { set print $balanced; unset print }    # an empty one
stats $given using (sqrt($1**2 + $2**2)) name "given" nooutput
greatest = given_max
if (balanced) {
    stats $balanced using (sqrt($1**2 + $2**2)) name "balanced" nooutput
    greatest = larger(greatest, balanced_max)
}
ring = nice((greatest > 0 ? greatest : 1.0)/5)
radius = ring*ceil((greatest > 0 ? greatest : 1.0)/ring - 0.001)

headline = numbered(figure, sprintf(of_frame ? "Force on the frame, %s" : "Shaking force, %s", moment))
note = (of_frame ? "resultants" : "resultant of the inertia forces").", from the centre to the curve; numbers: ".(of_cycle ? drive_quantity(unit_crank) : "crank angle θ₂")
load plots."legend.gp"
given_style = "lt 1 lw 4 dt solid"
balanced_style = "lw 4 dt (16,7) lc rgb '#0060A8'"
if (balanced) {
    balanced_words = system("grep -c '^# rms over a turn' ".quoted(table)) + 0 ? "balanced" : "with counterweights"
    eval entry_line(of_frame ? "shaking force: of the inertia forces" : "as given", given_style)
    eval entry_line(of_frame ? "force on the frame: with weights and loads" : balanced_words, balanced_style)
}

# The greatest ring fills the page but for its names of axes.
head_height = 155 + legend_height(1070)
load plots."polar.gp"
eval draw_legend(112)
unset key

# Rings and spokes.
rings = int(radius/ring + 0.5)
do for [k=1:rings] {
    set object k circle at 0, 0 size k*ring fs empty border rgb "#C0C0C0" lw 1.5 behind
}
do for [k=0:11] {
    set arrow 20 + k from 0, 0 to radius*cos(k*pi/6), radius*sin(k*pi/6) nohead lw 1 lc rgb "#D0D0D0" back
}
set arrow 40 from -radius, 0 to radius, 0 nohead lw 1.5 lc rgb "#909090" back
set arrow 41 from 0, -radius to 0, radius nohead lw 1.5 lc rgb "#909090" back
set label 60 "x" at radius, 0 left offset 0.8, 0
set label 61 "y" at 0, radius center offset 0, 0.8

# Labels: the forces of the rings, then the crank angle at every 30 degrees, both clear of the curves.
ring_name(k) = k == rings ? amount(k*ring, unit_shaking_x) : amount_in(k*ring, amount_power(radius, unit_shaking_x))
set print places
print sprintf("page %g %g %g %g", 10, page - 10, centre_y - circle - 32, centre_y + circle + 40)
show(row) = words(row) == 4 ? sprintf("curve %.6g %.6g", page_x(word(row, 1) + 0), page_y(word(row, 2) + 0)) : "curve"
do for [k=1:|$given|] { print show($given[k]) }
if (balanced) {
    print "curve"
    do for [k=1:|$balanced|] { print show($balanced[k]) }
}
print sprintf("box %g %g 30 30", centre_x + circle + 15, centre_y)
print sprintf("box %g %g 30 30", centre_x, centre_y + circle + 25)
do for [k=1:rings] {
    print sprintf("spoke %g %g %.6g %.4g %.4g %s", centre_x, centre_y, pixel*k*ring, text_width(ring_name(k), 15), text_height(15), \
        ring_name(k))
}
at_30(angle) = abs(angle/30 - floor(angle/30 + 0.5)) < 1e-9
# A label leans away from the middle of its curve. The second curve, if it is no mere dot, has one at every quarter of a turn.
first_angle = word($given[1], 3) + 0
is_marked(row, step) = words(row) == 4 && word(row, 4) == 1 && at_30(word(row, 3) + 0.0) \
    && abs(word(row, 3)/step - floor(word(row, 3)/step + 0.5)) < 1e-9 && word(row, 3) < first_angle + 360 - 1e-9
print_angle(row) = (text = minus(sprintf("%g°", word(row, 3) + 0)), sprintf("label %.6g %.6g 13 %.4g %.4g %.4g %s", \
    page_x(word(row, 1) + 0), page_y(word(row, 2) + 0), text_width(text, 16), text_height(16), \
    180/pi*arg(word(row, 1) + 0.0 - middle_x + {0, 1}*(word(row, 2) - middle_y)), text))
second_marked = balanced && balanced_max > 0.25*radius
do for [curve=1:1 + second_marked] {
    if (curve == 1) {
        stats $given using 1 name "wide" nooutput
        stats $given using 2 name "tall" nooutput
    } else {
        stats $balanced using 1 name "wide" nooutput
        stats $balanced using 2 name "tall" nooutput
    }
    middle_x = 0.5*(wide_min + wide_max)
    middle_y = 0.5*(tall_min + tall_max)
    do for [k=1:curve == 1 ? |$given| : |$balanced|] {
        row = curve == 1 ? $given[k] : $balanced[k]
        if (is_marked(row, curve == 1 ? 30.0 : 90.0)) { print print_angle(row) }
    }
}
unset print
load labels_as("numbers")

set style textbox opaque margins 0.3, 0.2 fillcolor rgb "white" noborder
computed = 0
stats $given using (computed = computed + ($4 == 1), 0) nooutput
marked(value) = $4 == 1 && at_30($3) ? value : NaN
is_angle(label) = label[strlen(label) : *] eq "°"
balanced_part = !balanced ? "" : ", $balanced using 1:2 with lines ".balanced_style." notitle".\
    (second_marked ? ", $balanced using (marked($1)):2 with points pt 7 ps 1.2 lc rgb '#0060A8' notitle" : "").\
    (balanced_max < 0.02*radius ? ", $balanced using 1:2 every ::0::0 with points pt 7 ps 1.6 lc rgb '#0060A8' notitle" : "")
eval "plot $numbers using (is_angle(strcol(6)) ? NaN : unscaled_x($1)):(unscaled_y($2)):(strcol(6)) ".\
    "with labels boxed noenhanced font point_size(15) tc rgb '#606060' notitle, ".\
    "$given using 1:2 with lines ".given_style." notitle, ".\
    (computed <= 60 ? "$given using ($4 == 1 ? $1 : NaN):2 with points lt 1 pt 7 ps 0.8 notitle, " : "").\
    "$given using (marked($1)):2 with points lt 1 pt 7 ps 1.3 notitle, ".\
    "$numbers using ($5 == 1 ? unscaled_x($3) : NaN):(unscaled_y($4)):(unscaled_x($7) - unscaled_x($3)):(unscaled_y($8) - unscaled_y($4)) ".\
    "with vectors nohead lw 1 dt solid lc rgb '#808080' notitle, ".\
    "$numbers using (is_angle(strcol(6)) ? unscaled_x($1) : NaN):(unscaled_y($2)):(strcol(6)) ".\
    "with labels noenhanced font point_size(16) notitle".balanced_part
