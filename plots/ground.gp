# A fixed pivot at x y: call "ground.gp" x y size first_tag kind, with kind `pinned` or `clamped`.
# pinned: the usual triangle. clamped: a block that holds the shaft. Both stand on hatched ground.

gx = ARG1 + 0; gy = ARG2 + 0; gs = ARG3 + 0; tag = ARG4 + 0
half = 0.55*gs
if (ARG5 eq "clamped") {
    set object tag rectangle from gx - 0.6*half, gy - gs to gx + 0.6*half, gy + 0.6*half \
        fs solid 1 border rgb ink fc rgb "#C8C8C8" lw 2 behind
} else {
    set object tag polygon from gx, gy to gx - half, gy - gs to gx + half, gy - gs to gx, gy \
        fs solid 1 border rgb ink fc rgb "white" lw 2 behind
}
set arrow tag from gx - 1.5*half, gy - gs to gx + 1.5*half, gy - gs nohead lw 3 lc rgb ink
do for [i=0:5] {
    right = gx - 1.5*half + 0.6*half*i
    set arrow tag + 1 + i from right, gy - gs to right - 0.35*gs, gy - 1.35*gs nohead lw 1.5 lc rgb ink
}
