# The forces at the pins and the shaking force as the linkage moves, at one speed: a turn of the crank, or to and fro.

eval smaller(0.65)

call plots."linkage.gp" ""
load keep("forces", table, sprintf("forces %s 72", asked_speed))          # columns: see tables.awk
load plots."force_arrows.gp"
set print angles
do for [k=1:|$forces|] { print word($forces[k], 1) }
unset print
load poses_as("places")
eval pivots
poses = "$places"
eval extent
size = 0.055*span
call plots."bodies.gp" sprintf("%g", 0.018*span)
eval scale_of_forces
room = 0.05*span
x0 = x_min - room
x1 = x_max + room
y0 = y_min - room - 0.6*size
y1 = y_max + room
pixel = lesser(1080/(x1 - x0), 770/(y1 - y0))
rows_drawn = |$forces|
turning = high_crank - low_crank > 300
pictures = turning ? rows_drawn : 2*rows_drawn - 2
row_of(picture) = picture <= rows_drawn ? picture : 2*rows_drawn - picture

headline = cut(deck_title, 60)
deck_title = ""
note = ""
remark = ""
load plots."legend.gp"
eval entries_of_forces
wide = larger(pixel*(x1 - x0) + 40, 800)
high = pixel*(y1 - y0)
do for [picture=1:pictures] {
    eval open_page(wide, high + 190)
    if (picture == 1) {
        eval heading
        legend_room = legend_height(wide - 40)
        eval draw_legend(66)
        unset border
        unset tics
        unset grid
        unset key
        set size ratio -1
        set xrange [x0:x1]
        set yrange [y0:y1]
        set tmargin at screen up(60 + high)
        set bmargin at screen up(60)
        set lmargin at screen 0.5 - across(0.5*pixel*(x1 - x0))
        set rmargin at screen 0.5 + across(0.5*pixel*(x1 - x0))
        call plots."ground.gp" sprintf("%.12g", O2_x) sprintf("%.12g", O2_y) size 1 "pinned"
        call plots."ground.gp" sprintf("%.12g", O4_x) sprintf("%.12g", O4_y) size 11 "pinned"
        eval ground_hooks(size)
    }
    now = row_of(picture)
    set output sprintf("%s_%03d", out, picture)
    set label 905 sprintf("θ₂ = %.4g°,  %s", word($forces[now], 1) + 0, moment) at screen 0.5, up(30) \
        center noenhanced font ",20"
    eval arrows_of($places[now], $forces[now])
    eval "plot ".pale_mechanism($places[now])."NaN notitle"
}
unset output
call plots."gif.gp" out pictures turning ? floor(300.0/pictures + 0.5) : 5
