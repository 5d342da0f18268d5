# Pictures, put together to a GIF. The script sets pictures, their number, delay, in hundredths of a second, x0, x1, y0 and y1, the ends of
# the axes, pixel, of how many pixels one unit of them is, note, and the entries of its legend, if there is one (legend.gp); caption_of(picture), the text
# of a picture, parts_of(picture), the parts of its plot command, a comma behind each; on_page and before_picture(picture), what is done once
# and before each picture, as text.

headline = cut(deck_title, 60)
deck_title = ""
remark = ""
wide = larger(pixel*(x1 - x0) + 40, 800)
high = pixel*(y1 - y0)
foot_height = note eq "" ? 60 : 100
do for [picture=1:pictures] {
    eval open_page(wide, high + foot_height + (entries > 0 ? 130 : 90))
    if (picture == 1) {
        eval heading
        if (entries > 0) { legend_room = legend_height(wide - 40); eval draw_legend(66) }
        unset border
        unset tics
        unset grid
        unset key
        set size ratio -1
        set xrange [x0:x1]
        set yrange [y0:y1]
        set tmargin at screen entries > 0 ? up(foot_height + high) : down(80)
        set bmargin at screen up(foot_height)
        set lmargin at screen 0.5 - across(0.5*pixel*(x1 - x0))
        set rmargin at screen 0.5 + across(0.5*pixel*(x1 - x0))
        eval on_page
    }
    set output sprintf("%s_%03d", out, picture)
    set label 905 caption_of(picture) at screen 0.5, up(foot_height - 30) center noenhanced font ",20"
    eval before_picture(picture)
    eval "plot ".parts_of(picture)."NaN notitle"
}
unset output
call plots."gif.gp" out pictures delay
