# Undeformed and deformed links with their axes, for docs/theory.md: the linkage, and one of its links. After figures 2.3 and 2.4 of
# the thesis (Ulker 2010, after Yu and Xi 2003); no table is drawn.
#   gnuplot -c link_axes.gp OUT

load ARG0[1 : strlen(ARG0) - strlen("link_axes.gp")]."style.gp"
out = ARG1
titled = 0
top_cut = 0
I = {0, 1}
rigid_look = "lw 3 lc rgb '#9A9A9A' dt (12,6)"
bent_look = "lw 5 lc rgb ink dt solid"
thin = "lw 2 lc rgb '#0060A8' dt solid"
axis_look = "lw 2 lc rgb '#404040' dt solid"

# The axis of a link from p to q whose ends are displaced by a and b and turned by angles: a cubic.
across_of(p, q, d) = imag(d*(real(q - p) - I*imag(q - p)))/abs(q - p)
along_of(p, q, d) = real(d*(real(q - p) - I*imag(q - p)))/abs(q - p)
hermite(s, v, m, w, n) = v*(1 - s)**2*(1 + 2*s) + m*s*(1 - s)**2 + w*s**2*(3 - 2*s) - n*s**2*(1 - s)
bent(s, p, q, a, b, turned_p, turned_q) = p + s*(q - p) + (q - p)/abs(q - p)*((1 - s)*along_of(p, q, a) + s*along_of(p, q, b) \
    + I*hermite(s, across_of(p, q, a), abs(q - p)*turned_p, across_of(p, q, b), abs(q - p)*turned_q))

marks_set = 0
arrow(p, q, look) = (marks_set = marks_set + 1, sprintf("set arrow %d from %.6g, %.6g to %.6g, %.6g %s; ", marks_set, real(p), imag(p), real(q), imag(q), look))
head = "filled size screen 0.011, 18 "
text(z, words_of, place, look) = (marks_set = marks_set + 1, sprintf("set label %d \"%s\" at %.6g, %.6g %s %s; ", marks_set, words_of, real(z), imag(z), place, look))
dot(z, look) = (marks_set = marks_set + 1, sprintf("set label %d '' at %.6g, %.6g front point %s; ", marks_set, real(z), imag(z), look))
joint(z, colour) = dot(z, "pt 7 ps 2.4 lc rgb 'white'").dot(z, "pt 6 ps 2.4 lw 2.5 lc rgb '".colour."'")

# ---- The linkage ----
O2 = 0.0
O4 = 2.54
A = 1.0*exp(I*62*pi/180)
to_O4 = O4 - A
B = A + 2.794*exp(I*(arg(to_O4) + acos((2.794**2 + abs(to_O4)**2 - 2.667**2)/(2*2.794*abs(to_O4)))))
by_A = 0.24*I*A/abs(A)
# B stays at the lengths of coupler and follower: its displacement along each of them.
on_3 = real(by_A*(real(B - A) - I*imag(B - A)))/abs(B - A)
u3 = (B - A)/abs(B - A)
u4 = (B - O4)/abs(B - O4)
by_B = I*u4*on_3/real(I*u4*(real(u3) - I*imag(u3)))
turn_3 = across_of(A, B, by_B - by_A)/abs(B - A)
turn_4 = across_of(O4, B, by_B)/abs(B - O4)
bow_3 = 0.24
bow_4 = -0.22
set samples 101
set parametric
set trange [0:1]
eval open_page(1500, 660)
unset border
unset tics
unset key
unset grid
set size ratio -1
set multiplot
set lmargin at screen 0.01
set rmargin at screen 0.45
set bmargin at screen 0.01
set tmargin at screen 0.99
set xrange [-0.75:3.15]
set yrange [-0.5:2.95]
call plots."ground.gp" "0" "0" 0.2 201 "pinned"
call plots."ground.gp" "2.54" "0" 0.2 211 "pinned"
eval arrow(O2, 0.75, head.axis_look).arrow(O2, 0.75*I, head.axis_look)
eval text(0.75, "X", "offset 0.2,-0.9", "center").text(0.75*I, "Y", "offset -1.2,0", "center")
eval text(O2, "O_2", "offset -2.4,-0.3", "right").text(O4, "O_4", "offset 1.8,-0.3", "left")
eval text(A, "A", "offset 1.3,-0.7", "left").text(A + by_A, "A′", "offset -1.3,0.6", "right")
eval text(B, "B", "offset 1.3,-0.3", "left").text(B + by_B, "B′", "offset -0.4,1", "center")
eval text(0.5*A, "2", "offset 1.8,-0.1", "center").text(A + 0.5*(B - A), "3", "offset 0.9,-1", "center").\
    text(O4 + 0.5*(B - O4), "4", "offset -1.2,0", "center")
eval joint(A, "#9A9A9A").joint(B, "#9A9A9A").joint(A + by_A, "#000000").joint(B + by_B, "#000000").joint(O4, "#000000")
straight(p, q) = sprintf("real(%s + t*(%s - %s)), imag(%s + t*(%s - %s)) with lines ", p, q, p, p, q, p).rigid_look
curved(arguments) = sprintf("real(bent(t, %s)), imag(bent(t, %s)) with lines ", arguments, arguments).bent_look
eval "plot ".straight("O2", "A").", ".straight("A", "B").", ".straight("O4", "B").", ".\
    curved("O2, A, 0.0, by_A, 0.0, 1.5*0.24").", ".\
    curved("A, B, by_A, by_B, turn_3 + bow_3, turn_3 - bow_3").", ".\
    curved("O4, B, 0.0, by_B, turn_4 + bow_4, turn_4 - bow_4")

# ---- One of its links ----
do for [k=1:marks_set] { unset arrow k; unset label k }
do for [k=201:225] { unset arrow k; unset object k }
set lmargin at screen 0.46
set rmargin at screen 0.99
set xrange [-0.45:6.15]
set yrange [-0.55:4.35]
o = 1.35 + 0.95*I
direction = exp(I*24*pi/180)
end = o + 4*direction
by_o = (0.36 + 0.5*I)*direction
by_end = (0.4 + 0.75*I)*direction
x_P = 0.56
P = o + x_P*(end - o)
P_bent = bent(x_P, o, end, by_o, by_end, 0.5, -0.45)
corner = P + real((P_bent - P)/direction)*direction
eval arrow(0.0, 0.9, head.axis_look).arrow(0.0, 0.9*I, head.axis_look)
eval text(0.9, "X", "offset 0.2,-0.9", "center").text(0.9*I, "Y", "offset -1.2,0", "center").text(0.0, "O", "offset -0.9,-0.7", "center")
eval arrow(o, o + 4.75*direction, head.axis_look).text(o + 4.75*direction, "x", "offset 0.6,-0.8", "center")
eval arrow(o, o + 1.7*I*direction, head.axis_look).text(o + 1.7*I*direction, "y", "offset -1.1,0.2", "center")
eval arrow(0.0, o, head.thin).text(0.5*o, "R_0", "offset 1.6,-0.4", "center")
eval arrow(0.0, P_bent, head.thin).text(0.3*P_bent, "R", "offset -1,0.8", "center")
eval arrow(P, corner, head."lw 3 lc rgb '#C04000' dt solid").text(0.5*(P + corner), "u", "offset 0.3,-0.9", "center")
eval arrow(corner, P_bent, head."lw 3 lc rgb '#C04000' dt solid").text(0.5*(corner + P_bent), "v", "offset 1.1,0.2", "center")
eval arrow(o - 0.72*I*direction, P - 0.72*I*direction, "heads filled size screen 0.009, 18 ".axis_look)
eval arrow(o - 0.1*I*direction, o - 0.8*I*direction, "nohead lw 1.5 lc rgb '#707070' dt solid")
eval arrow(P - 0.1*I*direction, P - 0.8*I*direction, "nohead lw 1.5 lc rgb '#707070' dt solid")
eval text(o + 0.28*(end - o) - 0.72*I*direction, "x", "offset 0.6,-0.9", "center")
eval arrow(o, o + 1.25, "nohead lw 1.5 lc rgb '#707070' dt solid")
eval text(o + 1.0*exp(I*11*pi/180), "θ_i", "offset 0.8,0", "center")
eval text(o, "o", "offset 1.6,-0.8", "center").text(P, "P", "offset -0.8,0.9", "center").text(P_bent, "P′", "offset 0,1", "center")
eval dot(P, "pt 7 ps 1.6 lc rgb '#707070' ").dot(P_bent, "pt 7 ps 1.8 lc rgb ink")
eval joint(o, "#9A9A9A").joint(end, "#9A9A9A").joint(o + by_o, "#000000").joint(end + by_end, "#000000")
eval "plot ".straight("o", "end").", ".curved("o, end, by_o, by_end, 0.5, -0.45").\
    ", real(o + 0.85*exp(I*t*24*pi/180)), imag(o + 0.85*exp(I*t*24*pi/180)) with lines lw 1.5 lc rgb '#707070' dt solid"
unset multiplot
eval close
