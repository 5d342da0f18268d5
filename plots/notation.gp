# How decks describe places, angles and sides, for docs/tutorial.md; no table is drawn.
#   gnuplot -c notation.gp OUT

load ARG0[1 : strlen(ARG0) - strlen("notation.gp")]."style.gp"
out = ARG1
titled = 0
top_cut = 0
I = {0, 1}
points = 0
call plots."bodies.gp" "0.17"
blue = "#6699CC"
yellow = "#FFCC66"
green = "#99CC99"
pink = "#D99AB5"
measure = "lw 2.5 lc rgb '#0060A8' dt solid"
thin = "lw 1.5 lc rgb '#707070' dt (8,6)"
axis_look = "lw 2 lc rgb '#404040' dt solid"
head = "filled size screen 0.009, 18 "
heads = "heads filled size screen 0.008, 18 "
degree = pi/180

marks_set = 0
arrow(p, q, look) = (marks_set = marks_set + 1, sprintf("set arrow %d from %.6g, %.6g to %.6g, %.6g front %s; ", marks_set, \
    real(p), imag(p), real(q), imag(q), look))
text(z, words_of, place) = (marks_set = marks_set + 1, sprintf("set label %d ", marks_set).quoted_twice(words_of).\
    sprintf(" at %.6g, %.6g front noenhanced font ',19' %s; ", real(z), imag(z), place))
blue_text(z, words_of, place) = text(z, words_of, place." tc rgb '#0060A8'")
link(p, q, colour) = capsule(p, q, half_width + rim, dark).capsule(p, q, half_width, colour)
pale_link(p, q) = capsule(p, q, half_width + rim, "#B4B4B4").capsule(p, q, half_width, "#F2F2F2")
pale_pin(z) = disc(z, 0.75*half_width, "#B4B4B4").disc(z, 0.45*half_width, "#FFFFFF")
mass(z) = disc(z, 0.75*half_width, dark)
block(z, d, colour) = box(z, d, 0.62, 0.4, dark).box(z, d, 0.55, 0.33, colour)
box(z, d, long, high, colour) = sprintf("$square using (%.7g + %.7g*$1 - %.7g*$2):(%.7g + %.7g*$1 + %.7g*$2)", real(z), long*real(d), \
    high*imag(d), imag(z), long*imag(d), high*real(d)).filled(colour)
$square << END_OF_BLOCK
1 1
-1 1
-1 -1
1 -1
1 1
END_OF_BLOCK
set print $along
do for [k=0:40] { print k/40.0 }
unset print
arc(z, r, from, to) = sprintf("$along using (%.6g + %.6g*cos(%.9g + %.9g*$1)):(%.6g + %.6g*sin(%.9g + %.9g*$1)) with lines %s notitle, ", \
    real(z), r, from*degree, (to - from)*degree, imag(z), r, from*degree, (to - from)*degree, measure)
arc_head(z, r, to) = arrow(z + r*exp(I*(to - 0.35/r/degree)*degree), z + r*exp(I*to*degree), head.measure)
hatch(p, q, n) = n < 1 ? "" : arrow(p, p - 0.28*(q - p)/abs(q - p)*(1 + I), "nohead lw 1.5 lc rgb ink dt solid").\
    (n < 2 ? "" : hatch(p + (q - p)/n, q, n - 1))
rail(p, q) = arrow(p, q, "nohead lw 3 lc rgb ink dt solid").hatch(p, q, int(abs(q - p)/0.32))
axes(z) = arrow(z, z + 1.3, head.axis_look).arrow(z, z + 1.3*I, head.axis_look).text(z + 1.3, "x", "offset 0.5,-0.8 center").\
    text(z + 1.3*I, "y", "offset -1,0.2 center")
start(column, line, heading) = sprintf("do for [tag=1:60] { unset arrow tag; unset label tag; unset object tag }; marks_set = 0; ").\
    sprintf("set lmargin at screen %.6f; set rmargin at screen %.6f; set tmargin at screen %.6f; set bmargin at screen %.6f; ", \
        (column - 1)/3.0 + 0.005, column/3.0 - 0.005, 1 - (line - 1)/2.0 - 0.085, 1 - line/2.0 + 0.01).\
    sprintf("set label 901 \"%s\" at screen %.6f, %.6f center noenhanced font ',20'", heading, (column - 0.5)/3.0, 1 - (line - 1)/2.0 - 0.045)

eval open_page(1600, 1010)
unset border
unset tics
unset key
unset grid
set size ratio -1
set samples 60
set xrange [0:10]
set yrange [0:8]
set multiplot

# Pins and angles.
eval start(1, 1, "GROUND, LINK, DRIVE and CRANK")
O2 = 1.6 + 2.2*I
A = O2 + 2.3*exp(I*55*degree)
O4 = 7.6 + 2.2*I
B = 7.0 + 6.2*I
call plots."ground.gp" "1.6" "2.2" 0.55 101 "pinned"
call plots."ground.gp" "7.6" "2.2" 0.55 121 "pinned"
eval arrow(O2, O2 + 2.6, "nohead ".thin).arc_head(O2, 1.3, 55).text(O2 + 2.15*exp(I*24*degree), "CRANK", "center tc rgb '#0060A8'")
eval text(O2, "O2", "offset -2.2,0.2 center").text(O4, "O4", "offset 2.4,0.2 center").text(A, "A", "offset -1.3,0.8 center").\
    text(B, "B", "offset 0.6,1.1 center")
eval text(0.45*O2 + 0.55*A, "crank", "offset -3.4,0.6 center").text(0.5*(A + B), "coupler", "offset -1.5,1.2 center").\
    text(0.5*(B + O4), "rocker", "offset 3.8,0 center")
eval axes(3.7 + 0.35*I)
eval text(0.5*(O2 + O4), "ground pivots", "offset 5,-1.9 center tc rgb '#707070'")
eval "plot ".arc(O2, 1.3, 0, 53).link(O4, B, green).link(A, B, yellow).link(O2, A, blue).pin(O2).pin(A).pin(B).pin(O4)."NaN"
do for [tag=101:140] { unset arrow tag; unset object tag }

# Places on a link.
eval start(2, 1, "LINK rod A B: along, offset, center")
A = 1.3 + 1.6*I
way = exp(I*27*degree)
B = A + 7.6*way
P = A + 4.9*way + 2.3*I*way
C = A + 3.9*way - 1.0*I*way
eval arrow(A + 2.9*I*way, A + 4.9*way + 2.9*I*way, heads.measure).blue_text(A + 1.6*way + 2.9*I*way, "along", "offset -1.2,0.9 center")
eval arrow(A + 0.3*I*way, A + 3.1*I*way, "nohead ".thin).arrow(P, P + 0.8*I*way, "nohead ".thin)
eval arrow(A + 4.9*way, P, heads.measure).blue_text(A + 4.9*way + 1.4*I*way, "offset", "offset 3.4,0.2 center")
eval arrow(A, A + 3.4, "nohead ".thin).arc_head(A, 2.5, 27).blue_text(A + 3.1*exp(I*6*degree), "θ", "offset 0,0.2 center")
eval text(A, "A, first pin", "offset 0.5,-1.7 center").text(B, "B", "offset 1.4,0.8 center").text(P, "POINT P rod", "offset 1.6,0.6 left")
eval text(C, "mass centre:", "offset 1.6,-0.2 left").text(C, "an offset below 0", "offset 1.6,-1.4 left")
eval arrow(A + 3.9*way, C, "nohead ".thin)
eval "plot ".arc(A, 2.5, 0, 25).link(A, B, yellow).capsule(A + 4.9*way, P, 0.02, "#909090").pin(A).pin(B).\
    disc(P, 0.75*half_width, dark).disc(P, 0.5*half_width, "#CC3333").mass(C)."NaN"

# More pins.
eval start(3, 1, "LINK elbow A B C lengths=… turns=…")
A = 1.3 + 1.6*I
B = A + 3.9*exp(I*12*degree)
C = B + 4.1*exp(I*72*degree)
beyond = B + 3.0*exp(I*12*degree)
side = I*exp(I*12*degree)
side_2 = I*exp(I*72*degree)
eval arrow(B, beyond, "nohead ".thin).arc_head(B, 1.7, 72).blue_text(B + 2.2*exp(I*42*degree), "turn", "offset 1.2,0 center")
eval arrow(A - 0.75*side, B - 0.75*side, heads.measure).blue_text(0.5*(A + B) - 0.75*side, "1st length", "offset 1,-1.2 center")
eval arrow(B + 0.75*side_2, C + 0.75*side_2, heads.measure).blue_text(0.5*(B + C) + 0.75*side_2, "2nd length", "offset -4.6,0.4 center")
eval text(A, "A", "offset -1.4,0.6 center").text(B, "B", "offset -0.9,1.2 center").text(C, "C", "offset 2,0.3 center")
eval text(5.0 + 7.6*I, "turns to the left are positive", "center tc rgb '#707070'")
eval "plot ".arc(B, 1.7, 12, 70).capsule(A, B, half_width + rim, dark).capsule(B, C, half_width + rim, dark).\
    capsule(A, B, half_width, green).capsule(B, C, half_width, green).pin(A).pin(B).pin(C)."NaN"

# Sides.
eval start(1, 2, "BRANCH E left C D")
C = 1.6 + 3.1*I
D = 7.9 + 4.3*I
ahead = (D - C)/abs(D - C)
E = C + 3.3*ahead + 2.7*I*ahead
F = C + 3.3*ahead - 2.7*I*ahead
eval arrow(C + 0.35*ahead, D - 0.35*ahead, head.measure).blue_text(0.5*(C + D), "the way C D", "offset -0.6,-1.5 center")
eval text(C, "C", "offset -1.8,0 center").text(D, "D", "offset 1.8,0 center").text(E, "E: left", "offset 0,1.2 center").\
    text(F, "E: right", "offset 0,-1.4 center tc rgb '#707070'")
eval "plot ".pale_link(C, F).pale_link(D, F).pale_pin(F).link(C, E, yellow).link(D, E, pink).pin(C).pin(D).pin(E)."NaN"

# Guides.
eval start(2, 2, "GUIDE bed, SLIDER B bed, BRANCH B")
G = 1.2 + 1.2*I
ahead = exp(I*14*degree)
A = G + 4.3*ahead + 3.0*I*ahead
fw = G + (4.3 + 3.0)*ahead
bw = G + (4.3 - 3.0)*ahead
eval rail(G - 0.7*ahead - 0.5*I*ahead, G + 8.5*ahead - 0.5*I*ahead)
eval arrow(G + 7.9*ahead + 0.05*I*ahead, G + 8.9*ahead + 0.05*I*ahead, head.axis_look).text(G + 8.3*ahead, "its angle", "offset 0.2,1.3 center")
eval arrow(G, G + 2.2, "nohead ".thin)
eval arrow(G - 1.35*I*ahead, fw - 1.35*I*ahead, heads.measure).blue_text(0.5*(G + fw) - 1.35*I*ahead, "place of B", "offset 3.5,-0.9 center")
eval arrow(G - 0.2*I*ahead, G - 1.55*I*ahead, "nohead ".thin).arrow(fw - 0.5*I*ahead, fw - 1.55*I*ahead, "nohead ".thin)
eval text(G, "its point", "offset -1.5,5.2 left tc rgb '#707070'").arrow(G + 2.1*I, G + 0.16*I, "nohead lw 1 lc rgb '#707070' dt solid")
eval text(A, "A", "offset 0,1.2 center").text(fw, "B: forward", "offset -1.2,4.2 left").text(bw, "backward", "offset 2.8,1.4 left tc rgb '#707070'")
eval "plot ".pale_link(A, bw).box(bw, ahead, 0.62, 0.4, "#B4B4B4").box(bw, ahead, 0.55, 0.33, "#F7F7F7").pale_pin(bw).link(A, fw, yellow).\
    block(fw, ahead, "#D9D9D9").pin(A).pin(fw).disc(G, 0.12, "#0060A8")."NaN"

# A block on a link.
eval start(3, 2, "SLIDER A lever: a block on a link")
O4 = 2.4 + 1.4*I
ahead = exp(I*58*degree)
C = O4 + 6.7*ahead
A = O4 + 3.9*ahead
O2 = 6.9 + 3.1*I
call plots."ground.gp" "2.4" "1.4" 0.5 101 "pinned"
call plots."ground.gp" "6.9" "3.1" 0.5 121 "pinned"
eval arrow(O4 + 0.85*I*ahead, A + 0.85*I*ahead, heads.measure).blue_text(0.5*(O4 + A) + 0.85*I*ahead, "place", "offset -2.6,0.4 center")
eval arrow(O4 + 0.2*I*ahead, O4 + 1.0*I*ahead, "nohead ".thin).arrow(A + 0.45*I*ahead, A + 1.0*I*ahead, "nohead ".thin)
eval text(O4, "first pin", "offset 4.4,0.2 center").text(C, "C", "offset 1.3,0.7 center").text(A, "A", "offset 3.4,1.4 center").\
    text(O2, "O2", "offset 2.2,0.2 center").text(0.6*A + 0.4*C, "lever", "offset -3.2,1 center").text(0.5*(A + O2), "crank", "offset 2.2,1 center")
eval "plot ".link(O4, C, green).link(O2, A, blue).block(A, ahead, "#D9D9D9").pin(O4).pin(C).pin(A).pin(O2)."NaN"
unset multiplot
eval close
