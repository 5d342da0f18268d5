# A linkage that is no four-bar as it moves: a turn, or to and fro, with the paths of its pins and points.
#   gnuplot -c animate_cycle.gp TABLE OUT [FIGURE [REMARK]]
# TABLE has the columns speed and crank; the positions are between its first and its last.

load ARG0[1 : strlen(ARG0) - strlen("animate_cycle.gp")]."style.gp"
table = ARG1; out = ARG2; figure = argument(3); remark = argument(4)
eval smaller(0.65)

eval answer(table, "facts")
call plots."driven.gp"
call plots."shapes.gp" (turning ? 216 : 240) 0.018

# Evenly over a turn, or slower towards both ends of the way.
pictures = turning ? 72 : 60
pose_of(picture) = turning ? 1 + 3*(picture - 1) : 1 + int(120.5 - 120*cos(2*pi*(picture - 1)/pictures))
caption(position) = drive_subject." at ".(turning ? sprintf("%d°", int(floor(position + 0.5) + 3600)%360) \
    : minus(sprintf("%.4g", position)).(is_angle ? "°" : " ".unit_crank))
tail = 24
room = 0.05*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room; y1 = y_max + room
pixel = (x1 - x0)/(y1 - y0) > 1.4 ? 1080/(x1 - x0) : 770/(y1 - y0)
headline = cut(deck_title, 60)
deck_title = ""
note = ""
remark = ""
wide = pixel*(x1 - x0) > 760 ? pixel*(x1 - x0) + 40 : 800
foot_height = 60

# A tail that grows thinner: of the last rows before this position.
tails(n, k) = k > paths ? "" : (path_ink[k] eq "" ? "" : tail_part(n, k, 1).tail_part(n, k, 2).tail_part(n, k, 3)).tails(n, k + 1)
tail_from(n, part) = n - tail*(4 - part) < 1 ? 1 : n - tail*(4 - part)
tail_part(n, k, part) = sprintf("'%s/paths' every ::%d::%d using %d:%d with lines lw %d dt solid lc rgb '%s' notitle, ", \
    shapes, tail_from(n, part) - 1, n - 1, 2*k, 2*k + 1, 1 + 3*part, path_ink[k])
all_paths = ""
do for [k=1:paths] {
    all_paths = all_paths.path_columns(k).sprintf(" with lines lw %g dt solid lc rgb '%s' notitle, ", path_ink[k] eq "" ? 1.5 : 3, \
        path_ink[k] eq "" ? "#C8C8C8" : "#AAAAAA")
}
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
    }
    now = pose_of(picture)
    set output sprintf("%s_%03d", out, picture)
    set label 905 caption(pose_crank[now]) at screen 0.5, up(foot_height - 30) center noenhanced font ",20"
    eval "plot ".fixed_parts.all_paths.bodies(now).(turning || picture <= pictures/2 ? tails(now, 1) : "").pins_of(now)."NaN notitle"
}
unset output
call plots."gif.gp" out pictures 4
eval close
