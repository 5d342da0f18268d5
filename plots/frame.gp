# A page for one drawing: axes of one scale, a page of the drawing's shape, a legend above it. The script sets the ends of the axes
# x0, x1, y0 and y1, length_unit, headline, deck_title, note and remark, and the entries of its legend (legend.gp). Then `pixel` pixels are one
# unit of the axes, and page_x(x), page_y(y) the place on the page, unscaled_x and
# unscaled_y lead back.

pixel = drawing_scale(x0, x1, y0, y1)
box_width = pixel*(x1 - x0)
box_height = pixel*(y1 - y0)
step = nice(((x1 - x0) + (y1 - y0))/17)
power_drawn = power_of(lesser(x0, y0), larger(x1, y1))
tick_room = tick_width(y0, y1, step, power_drawn)
drawing_left = 90 + tick_room
least_width = larger(720, lesser(text_width(deck_title, 18) + 50, 1100))
words_width = lesser(1550, larger(text_width(headline, 23), larger(text_width(note, 16), text_width(remark, 16))) + 60)
frame_width = larger(larger(drawing_left + box_width + 45, least_width), words_width)
box_left = drawing_left + (frame_width - drawing_left - 45 - box_width)/2
box_bottom = foot(lines_of_notes(note, remark))
legend_room = legend_height(frame_width - 60)
eval open_page(frame_width, box_bottom + box_height + 116 + legend_room + 18)
eval heading
eval draw_legend(116)
set lmargin at screen across(box_left)
set rmargin at screen across(box_left + box_width)
set bmargin at screen up(box_bottom)
set tmargin at screen up(box_bottom + box_height)
set xrange [x0:x1]
set yrange [y0:y1]
set size ratio -1
x_step = tick_width(x0, x1, step, power_drawn) + 16 > pixel*step ? 2*step : step
eval "set xtics (".ticks_between(x0, x1, x_step, power_drawn)."); set ytics (".ticks_between(y0, y1, step, power_drawn).")"
axis_unit(name, unit) = name.bracketed(unit_and_power(unit, power_drawn))
set label 905 axis_unit("y", length_unit) at screen across(box_left - tick_room - 56), up(box_bottom + 0.5*box_height) \
    center rotate by 90 noenhanced
set xlabel axis_unit("x", length_unit) noenhanced
unset grid
unset key
page_x(x) = box_left + pixel*(x - x0)
page_y(y) = box_bottom + pixel*(y - y0)
unscaled_x(x) = x0 + (x - box_left)/pixel
unscaled_y(y) = y0 + (y - box_bottom)/pixel
