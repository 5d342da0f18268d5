# The multipliers of a turn at all speeds of stability.dat, on and beside the unit circle.
# A multiplier e^(growth + 2 pi i turns) is drawn with its conjugate, its distance from the circle ten times as large; without
# damping those that leave the circle have their inverses. What fades or grows too far is drawn at the rim.

modes = int(high_mode)
farthest = larger(abs(low_growth), abs(high_growth))
magnified = farthest < 0.07 ? 10 : farthest < 0.7 ? 1 : 0.2
least = 0.25
most = 1.75
radius(growth) = larger(least, lesser(most, 1 + magnified*growth))
number_of_speeds = words(answer(table, "distinct speed"))
headline = numbered(figure, number_of_speeds == 1 ? sprintf("Multipliers of a turn, %s", at_speed(low_speed, unit_speed)) \
    : sprintf("Multipliers of a turn, ω₂ = %.6g to %.6g %s", low_speed, high_speed, typeset(unit_speed)))
note = sprintf("multipliers ρ and their conjugates; open: |ρ| = 1, filled: off the unit circle, at a distance of ln|ρ|, scale %g", magnified)
mark(k) = int(word("6 8 4 12 10 14 1 2", 1 + (k - 1)%8))
filled(k) = int(word("7 9 5 13 11 15 1 2", 1 + (k - 1)%8))
# Of several speeds colours tell them apart, marks the modes.
of_speeds = number_of_speeds > 1
tint(k) = of_speeds ? "lc palette" : "lc rgb '".ink_of(k)."'"
load plots."legend.gp"
do for [k=1:modes] {
    eval entry_point(sprintf("mode %d", k), sprintf("pt %d ps 1.6 lw 2 lc rgb '%s'", mark(k), of_speeds ? ink_of(1) : ink_of(k)))
}
radius = 1.45
head_height = 135 + legend_height(1070)
load plots."polar.gp"
eval draw_legend(112)
unset key
if (of_speeds) {
    set palette defined (0 "#0B2A6B", 0.5 "#B04878", 1 "#E8A000")
    set cbrange [low_speed:high_speed]
    set colorbox user vertical origin screen across(page - 130), screen up(centre_y - 0.5*circle) size screen across(22.0) - across(0), screen up(circle) - up(0)
    set cbtics scale 0.5 font ",15"
    set label 70 bracketed(typeset(unit_speed))[2:*] at screen across(page - 119), screen up(centre_y + 0.5*circle + 22) center font ",15"
}
set object 1 circle at 0, 0 size 1 fs empty border rgb "#606060" lw 2.5 behind
do for [k=1:2] {
    ring = k == 1 ? 0.75 : 1.25
    set object 1 + k circle at 0, 0 size ring fs empty border rgb "#D0D0D0" lw 1.2 behind
    eval sprintf("set label %d '%s' at %.6g, %.6g center noenhanced font ',15' tc rgb '#707070'", 40 + k, \
        "ln|ρ| = ".minus(sprintf("%+.3g", (ring - 1)/magnified)), (ring + 0.045)*cos(1.15*pi), (ring + 0.045)*sin(1.15*pi))
}
do for [k=0:11] {
    set arrow 20 + k from 0.7*cos(k*pi/6), 0.7*sin(k*pi/6) to 1.35*cos(k*pi/6), 1.35*sin(k*pi/6) nohead lw 1 lc rgb "#D0D0D0" back
}
set arrow 60 from -1.45, 0 to 1.45, 0 nohead lw 1.2 lc rgb "#909090" back
set arrow 61 from 0, -1.45 to 0, 1.45 nohead lw 1.2 lc rgb "#909090" back
set label 62 "1: fold" at 1.42, 0.09 right noenhanced font ",16"
set label 63 "−1: flip" at -1.42, 0.09 left noenhanced font ",16"
set label 64 "turns 1/4" at 0.03, 1.42 left noenhanced font ",16"
of_mode(k) = rows_if(table, is_at("mode", sprintf("%d", k)))
leaves(growth, error) = abs(growth) > error
shade = of_speeds ? ":(field('speed'))" : ""
of_side(k, side, condition, size, look) = sprintf("of_mode(%d) using (%s ? %s*cos(2*pi*field('turns')) : NaN):(%d*%s*sin(2*pi*field('turns')))%s with points %s %s notitle, ", \
    k, condition, size, side, size, shade, look, tint(k))
of_sides(k, side) = of_side(k, side, "!leaves(field('growth'), field('error'))", "1", sprintf("pt %d ps 1.3 lw 2", mark(k))).\
    of_side(k, side, "leaves(field('growth'), field('error'))", "radius(field('growth'))", sprintf("pt %d ps 1.5", filled(k)))
points_from(k) = k > modes ? "" : of_sides(k, -1).of_sides(k, 1).points_from(k + 1)
eval "plot ".points_from(1)."NaN notitle"
