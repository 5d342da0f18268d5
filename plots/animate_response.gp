# The linkage as it bends over a turn in the elastic response at one speed, displacements made larger.

eval smaller(0.65)

call plots."linkage.gp" table
share = 0.125
want_positions = 90
call plots."bodies.gp" "1"
load plots."deformed.gp"
eval include_moved(1, positions_drawn)
size = 0.055*span
room = 0.05*span
x0 = x_min - room
x1 = x_max + room
y0 = lesser(y_min, lesser(O2_y, O4_y) - size) - room
y1 = y_max + room
pixel = lesser(1080/(x1 - x0), 770/(y1 - y0))

headline = cut(deck_title, 60)
deck_title = ""
note = ""
remark = ""
load plots."legend.gp"
eval entry_line("rigid links", rigid_look)
eval entry_line(sprintf("elastic links, %s", magnified_text), bent_look)
high = pixel*(y1 - y0)
wide = larger(pixel*(x1 - x0) + 40, 800)
do for [picture=1:positions_drawn] {
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
    }
    set output sprintf("%s_%03d", out, picture)
    set label 905 sprintf("θ₂ = %.4g°,  %s", word($moved[picture], 1) + 0, moment) at screen 0.5, up(30) \
        center noenhanced font ",20"
    eval "plot ".deformed_linkage($poses[picture], $moved[picture])."NaN notitle"
}
unset output
delay = floor(600.0/positions_drawn + 0.5)
call plots."gif.gp" out positions_drawn delay
