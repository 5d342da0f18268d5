# Pictures of the last rows of the block $poses, put together: call "animate_poses.gp" DELAY PICTURES ROWS
# with so many rows from one picture to the next. Rows before that of the first picture are for the tails of the points.
# The script sets caption(row), the text of a picture, tail, the length of the tails in pictures, and note.

delay = ARG1 + 0
pictures = ARG2 + 0
fine = ARG3 + 0
before = |$poses| - fine*(pictures - 1) - 1         # rows before that of the first picture
poses = "$poses"
eval extent
size = 0.055*span
call plots."bodies.gp" sprintf("%g", 0.02*span)
room = 0.07*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room - 0.5*size; y1 = y_max + room
pixel = (x1 - x0)/(y1 - y0) > 1.4 ? 1080/(x1 - x0) : 770/(y1 - y0)
headline = cut(deck_title, 60)
deck_title = ""
remark = ""
wide = pixel*(x1 - x0) > 760 ? pixel*(x1 - x0) + 40 : 800
foot_height = note eq "" ? 60 : 100

do for [picture=1:pictures] {
    eval open_page(wide, pixel*(y1 - y0) + 90 + foot_height)
    if (picture == 1) {
        eval heading
        unset border
        unset tics
        unset grid
        unset key
        set size ratio -1
        set xrange [x0:x1]
        set yrange [y0:y1]
        set tmargin at screen down(80)
        set bmargin at screen up(foot_height)
        set lmargin at screen 0.5 - across(0.5*pixel*(x1 - x0))
        set rmargin at screen 0.5 + across(0.5*pixel*(x1 - x0))
        call plots."ground.gp" O2_x O2_y size 1 "pinned"
        call plots."ground.gp" O4_x O4_y size 11 "pinned"
        eval ground_hooks(size)
    }
    now = before + fine*(picture - 1) + 1
    row = $poses[now]
    set output sprintf("%s_%03d", out, picture)
    set label 905 caption(row) at screen 0.5, up(foot_height - 30) center noenhanced font ",20"
    paths = ""
    do for [p=1:points] {
        paths = paths.sprintf("$poses using %d:%d with lines lw 3 dt solid lc rgb '#AAAAAA', ", column_of(p), column_of(p) + 1)
    }
    do for [p=1:points] {
        do for [part=1:3] {                          # a tail that grows thinner
            first = now - 1 - fine*tail*(4 - part)/3 > 0 ? now - 1 - fine*tail*(4 - part)/3 : 0
            paths = paths.sprintf("$poses every ::%d::%d using %d:%d with lines lw %d dt solid lc rgb '%s', ", \
                first, now - 1, column_of(p), column_of(p) + 1, 1 + 3*part, point_ink(p))
        }
    }
    eval "plot ".paths.mechanism(row)."NaN"
}
unset output
call plots."gif.gp" out pictures delay
