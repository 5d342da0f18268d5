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
note = sprintf("multipliers ρ and their conjugates; filled: beside the unit circle, where the distance ln|ρ| is drawn %s", \
    magnified == 1 ? "as it is" : sprintf("%g times as large", magnified))
mark(k) = int(word("6 8 4 12 10 14 1 2", 1 + (k - 1)%8))
filled(k) = int(word("7 9 5 13 11 15 1 2", 1 + (k - 1)%8))

radius = 1.45
head_height = 135
load plots."polar.gp"
set key at 0, 0 center center Left reverse samplen 1.5 spacing 1.2 maxrows 7 opaque

set object 1 circle at 0, 0 size 1 fs empty border rgb "#606060" lw 2.5 behind
do for [k=1:2] {
    ring = k == 1 ? 0.75 : 1.25
    set object 1 + k circle at 0, 0 size ring fs empty border rgb "#D0D0D0" lw 1.2 behind
    eval sprintf("set label %d '%s' at %.6g, %.6g center noenhanced font ',15' tc rgb '#707070'", 40 + k, \
        minus(sprintf("%+.3g", (ring - 1)/magnified)), (ring + 0.045)*cos(1.15*pi), (ring + 0.045)*sin(1.15*pi))
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
plot for [k=1:modes] for [side=-1:1:2] of_mode(k) using \
        (leaves(field("growth"), field("error")) ? NaN : cos(2*pi*field("turns"))):(side*sin(2*pi*field("turns"))) \
        with points pt mark(k) ps 1.3 lw 2 lc rgb ink_of(k) notitle, \
    for [k=1:modes] for [side=-1:1:2] of_mode(k) using \
        (leaves(field("growth"), field("error")) ? radius(field("growth"))*cos(2*pi*field("turns")) : NaN):(side*radius(field("growth"))*sin(2*pi*field("turns"))) \
        with points pt filled(k) ps 1.5 lc rgb ink_of(k) notitle, \
    for [k=1:modes] keyentry with points pt mark(k) ps 1.5 lw 2 lc rgb ink_of(k) title sprintf("mode %d", k)
