# What all figures share: terminal, page, lines, and how a table is asked for its title and units.
# A script loads this file first; the last call of a script is `eval close`.

reset
set encoding utf8
style_name = "style.gp"
plots = ARG0[1 : strlen(ARG0) - strlen(style_name)]

# ---- Terminal -------------------------------------------------------------------------------------------------
# The first of these that this gnuplot was built with. To try another: gnuplot -e "terminals='svg'" -c script.gp …

if (!exists("terminals")) terminals = GPVAL_TERMINALS
has(name) = strstrt(" ".terminals." ", " ".name." ") > 0
terminal_name = has("pngcairo") ? "pngcairo" : has("png") ? "png" : has("svg") ? "svg" : has("pdfcairo") ? "pdfcairo" : ""
extension = terminal_name eq "svg" ? ".svg" : terminal_name eq "pdfcairo" ? ".pdf" : ".png"
if (terminal_name eq "") {
    print "this gnuplot has none of the terminals pngcairo, png, svg, pdfcairo: no figure can be drawn"
    exit status 1
}
if (terminal_name ne "pngcairo" && !exists("fallback_told")) {
    print "this gnuplot has no terminal pngcairo: drawing with ".terminal_name.", files end in ".extension
}
fallback_told = 1

# Pages are planned in pixels; pdfcairo counts in inches. Pictures of an animation are the same pages made smaller.
page_scale = 1
smaller(scale) = sprintf("page_scale = %g; extension = ''", scale)
terminal_options(w, h) = terminal_name eq "pdfcairo" \
    ? sprintf("enhanced size %gin,%gin font 'Sans,16'", w/100.0, h/100.0) \
    : terminal_name eq "pngcairo" \
    ? sprintf("enhanced size %d,%d font 'Sans,20' fontscale %g linewidth %g pointscale %g background rgb 'white'", \
        w*page_scale, h*page_scale, page_scale, page_scale, page_scale) \
    : sprintf("enhanced size %d,%d font 'Sans,%d'", w, h, terminal_name eq "svg" ? 24 : 15)
open_page(w, h) = sprintf("set terminal %s %s; set output out.extension; page_width = %d; page_height = %d", \
    terminal_name, terminal_options(w, h), w, h)
close = "unset output; reset"

across(pixels) = pixels / (1.0 * page_width)       # from the left edge, as a screen coordinate
up(pixels) = pixels / (1.0 * page_height)          # from the lower edge
down(pixels) = 1 - up(pixels)                      # from the upper edge

# ---- Lines: told apart without colour by dashes and marks ------------------------------------------------------

set linetype 1 lw 3 lc rgb "#000000" dt solid          pt 6  ps 1.8
set linetype 2 lw 3 lc rgb "#0060A8" dt (16,7)         pt 8  ps 2.0
set linetype 3 lw 3 lc rgb "#C04000" dt (4,5)          pt 4  ps 1.7
set linetype 4 lw 3 lc rgb "#007A5A" dt (18,6,4,6)     pt 12 ps 2.0
set linetype 5 lw 3 lc rgb "#7A3E9D" dt (26,6)         pt 10 ps 2.0
set linetype 6 lw 3 lc rgb "#6B6B6B" dt (10,5,3,5,3,5) pt 2  ps 1.7
set linetype 7 lw 3 lc rgb "#B8860B" dt (8,8)          pt 1  ps 1.8
set linetype 8 lw 3 lc rgb "#A01850" dt (2,4)          pt 3  ps 1.8
do for [k=1:8] {                                    # the next eight: the same with filled marks
    eval sprintf("set linetype %d lw 3 lc rgb '%s' dt %s pt %d ps 1.7", k + 8, \
        word("#000000 #0060A8 #C04000 #007A5A #7A3E9D #6B6B6B #B8860B #A01850", k), \
        word("solid (16,7) (4,5) (18,6,4,6) (26,6) (10,5,3,5,3,5) (8,8) (2,4)", k), \
        word("7 9 5 13 11 15 14 2", k) + 0)
}
set linetype cycle 16

ink = 0x000000
faint = 0x9A9A9A
force_ink = 0x0060A8

zero_line = "set xzeroaxis lt 1 lw 2 dt solid"
set border lw 1.5
set grid lt 1 lw 1 lc rgb "#D0D0D0" dt solid
set key noenhanced
set tics out nomirror
set xtics format "%h"
set ytics format "%h"

# ---- Tables ---------------------------------------------------------------------------------------------------

quoted(text) = strstrt(text, "'") == 0 ? "'".text."'" : \
    "'".text[1 : strstrt(text, "'") - 1]."'\\'".quoted(text[strstrt(text, "'") + 1 : *])
ask(table, want) = "awk -v want=".quoted(want)." -f ".quoted(plots."tables.awk")." < ".quoted(table)
answer(table, want) = system(ask(table, want))
keep(block, table, want) = "< awk -v datablock=".block.ask(table, want)[4 : *]     # to be loaded: the answer as $block
same(a, b) = abs(a - b) <= 1e-9 * (1 + abs(b))
argument(k) = exists("ARG".k) ? value("ARG".k) : ""     # of the script; one not given is empty
field(name) = column(value("col_".name))            # this row's value in a column, after `eval answer(table, "facts")`
unit(name) = " [".typeset(value("unit_".name))."]"
typeset(text) = squared(strstrt(text, ".") == 0 ? text : text[1 : strstrt(text, ".") - 1]."·".text[strstrt(text, ".") + 1 : *])
squared(text) = text[strlen(text) : *] eq "2" ? text[1 : strlen(text) - 1]."²" : text

# ---- Words ----------------------------------------------------------------------------------------------------

ordinal(n) = n <= 10 ? word("first second third fourth fifth sixth seventh eighth ninth tenth", n) : sprintf("%dth", n)
capital(text) = substr("ABCDEFGHIJKLMNOPQRSTUVWXYZ", strstrt("abcdefghijklmnopqrstuvwxyz", text[1:1]), \
    strstrt("abcdefghijklmnopqrstuvwxyz", text[1:1])).text[2:*]
at_crank(crank) = sprintf("θ₂ = %.10g°", crank)
at_speed(speed, unit) = sprintf("ω₂ = %.10g %s", speed, unit)
numbered(figure, text) = figure eq "" ? text : "Figure ".figure.".  ".text
divergence = "below zero: −√(−ω²)/2π of a mode that has diverged (static instability)"
cut(text, n) = strlen(text) <= n ? text : text[1 : n - 1]."…"
nice(x) = (power = 10.0**floor(log10(x)), x/power > 5 ? 10*power : x/power > 2 ? 5*power : x/power > 1 ? 2*power : power)

# Title, deck and notes at the foot: the script sets headline, deck_title, note and remark (empty: none).
lines_of_notes(note, remark) = (note ne "") + (remark ne "")
foot(lines) = lines > 0 ? 134 + 31*lines : 118     # pixels below the lowest axis
heading = "set label 901 headline at screen 0.5, down(38) center noenhanced font ',23'; ".\
    "set label 902 cut(deck_title, page_width/14) at screen 0.5, down(82) center noenhanced font ',18' tc rgb '#505050'; ".\
    "set label 903 note at screen 0.5, up(remark eq '' ? 30 : 61) center noenhanced font ',17' tc rgb '#303030'; ".\
    "set label 904 remark at screen 0.5, up(30) center noenhanced font ',17' tc rgb '#303030'"

# ---- Curves against the crank angle ---------------------------------------------------------------------------
# The legend stands in columns of its own at the right, so it never meets a curve; what is beyond three columns is counted.

legend_rows = 14
listed(n) = n > 3*legend_rows ? 3*legend_rows - 1 : n
columns_of(entries) = entries > 2*legend_rows ? 3 : entries > legend_rows ? 2 : 1
unlisted(n) = n > listed(n) ? sprintf("… +%d", n - listed(n)) : ""
legend_page(h, entries) = open_page(1600 + 310*(columns_of(entries) - 1), h).\
    "; set lmargin at screen across(165); set rmargin at screen across(1290); ".\
    "set key at screen across(1305), down(125) left top Left reverse vertical samplen 3.2 spacing 1.35 maxrows ".legend_rows
curve_page(h) = legend_page(h, 1)
crank_axis(lowest, highest) = lowest == highest \
    ? sprintf("set xrange [%g:%g]; set xtics 10; set mxtics 2", lowest - 30, highest + 30) \
    : highest - lowest > 150 \
    ? sprintf("set xrange [%d:%d]; set xtics 30; set mxtics 3", 30*floor(lowest/30.0), 30*ceil(highest/30.0)) \
    : sprintf("set xrange [%.12g:%.12g]; set xtics %s; set mxtics 3", lowest, highest, highest - lowest > 60 ? "15" : "auto")

# Room for values that are all one, which gnuplot would warn of.
value_axis(low, high) = low == high ? sprintf("set yrange [%g:%g]", low - 1, high + 1) : "set yrange [*:*]"

# A curve is a line, a dot at every computed position (so that one alone shows), and marks on some of them,
# shifted from curve to curve so that curves lying on one another can still be told apart.
mark_step(n) = n > 24 ? n/12 : 1
mark_first(curve, curves, n) = n > 24 ? ((curve - 1)*mark_step(n))/curves : 0

# ---- Drawings of mechanisms -----------------------------------------------------------------------------------
# Equal axes: the page takes the shape of the mechanism, with room for headline, legend and note.

frame(x0, x1, y0, y1, notes) = \
    sprintf("x0 = %.12g; x1 = %.12g; y0 = %.12g; y1 = %.12g; bottom = foot(%d); ", x0, x1, y0, y1, notes).\
    "pixel = (x1 - x0)/(y1 - y0) > 1.75 ? 1400/(x1 - x0) : 800/(y1 - y0); ".\
    "box_width = pixel*(x1 - x0); box_height = pixel*(y1 - y0); ".\
    "box_left = box_width > 950 ? 150 : (1180 - box_width)/2; ".\
    "eval open_page(box_width > 950 ? box_width + 300 : 1180, bottom + box_height + 165); ".\
    "set lmargin at screen across(box_left); set rmargin at screen across(box_left + box_width); ".\
    "set bmargin at screen up(bottom); set tmargin at screen up(bottom + box_height); ".\
    "set xrange [x0:x1]; set yrange [y0:y1]; set size ratio -1; step = nice(((x1 - x0) + (y1 - y0))/17); ".\
    "set xtics step; set ytics step; unset grid; ".\
    "set key at screen 0.5, down(115) center center vertical maxrows 1 Left reverse samplen 2.5 width 2"

# Extent, both ends and the shortest element of the chain of links; the script sets nodes, the name of the block.
measure = "stats nodes using 2:3 name 'all' nooutput; ".\
    "x_min = all_min_x; x_max = all_max_x; y_min = all_min_y; y_max = all_max_y; ".\
    "span = x_max - x_min > y_max - y_min ? x_max - x_min : y_max - y_min; begun = 0; nearest = span; ".\
    "stats nodes using (begun == 0 ? (first_x = $2, first_y = $3, begun = 1) : 0, last_x = $2, last_y = $3, ".\
    "nearest = $9 > 0 && $9 < nearest ? $9 : nearest, 0) nooutput"

# Of those nodes: pins (where a link begins, but for the clamped root of the first, and the end of the last).
is_pin(value) = ($6 == 0 && ($2 != first_x || $3 != first_y)) || ($2 == last_x && $3 == last_y) ? value : NaN

# Places for their numbers. Where a number needs more room (a share of the span) than there is, every nth is shown.
crowded(share) = ceil(share*span/nearest)
every_nth(share) = $9 > 0 ? ceil(share*span/$9) : 1
shown(share, value) = $6 == 0 || $6 == $7 || (int($6) % every_nth(share) == 0 && $7 - $6 >= every_nth(share)) ? value : NaN
beside_x(room) = $2 + $10*room
beside_y(room) = $3 + $11*room
