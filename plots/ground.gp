# A fixed pivot at x y: call "ground.gp" x y size first_tag kind [angle], with kind `pinned` or `clamped`.
# pinned: the usual triangle on hatched ground, which the angle turns from upright. clamped: a hatched wall at a right angle to the link, whose angle in degrees is
# given: it turns with the link.

pivot = ARG1 + {0, 1}*ARG2
gs = ARG3 + 0
tag = ARG4 + 0
clamped = ARG5 eq "clamped"
up_from = (clamped ? 1 : {0, 1})*exp({0, 1}*(argument(6) eq "" ? 0 : argument(6) + 0)*pi/180)      # out of the ground
beside = -{0, 1}*up_from
foot_of = clamped ? pivot : pivot - gs*up_from
reach = clamped ? 0.9*gs : 0.8*gs
ground_point(a, b) = sprintf("%.12g, %.12g", real(foot_of + a*gs*up_from + b*reach*beside), imag(foot_of + a*gs*up_from + b*reach*beside))
if (clamped) {
    eval sprintf("set object tag polygon from %s to %s to %s to %s to %s fs solid 1 noborder fc rgb '#DDDDDD' behind", \
        ground_point(0, -1), ground_point(0, 1), ground_point(-0.4, 1), ground_point(-0.4, -1), ground_point(0, -1))
} else {
    eval sprintf("set object tag polygon from %s to %s to %s to %s fs solid 1 border rgb ink fc rgb 'white' lw 2 behind", \
        ground_point(1, 0), ground_point(0, -0.65), ground_point(0, 0.65), ground_point(1, 0))
}
eval sprintf("set arrow tag from %s to %s nohead lw 3 lc rgb ink back", ground_point(0, -1), ground_point(0, 1))
do for [i=0:5] {
    eval sprintf("set arrow tag + 1 + %d from %s to %s nohead lw 1.5 lc rgb ink back", i, \
        ground_point(0, -0.8 + 0.36*i), ground_point(-0.4, -1.2 + 0.36*i))
}
