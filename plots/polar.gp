# A page for a polar plot, about the middle of a circle of 400 pixels. The script sets radius, its radius in the axes, head_height, the pixels
# above the drawing, headline, deck_title, note and remark. Then `pixel` pixels are one unit of the axes, page_x(x), page_y(y) the
# place on the page, and unscaled_x and unscaled_y lead back.

circle = 400.0
pixel = circle/radius
page = 1130
centre_x = page/2.0
centre_y = (lines_of_notes(note, remark) > 0 ? 50 + 31*lines_of_notes(note, remark) : 10) + circle + 30
eval open_page(page, centre_y + circle + head_height)
eval heading
page_x(x) = centre_x + pixel*x
page_y(y) = centre_y + pixel*y
unscaled_x(x) = (x - centre_x)/pixel
unscaled_y(y) = (y - centre_y)/pixel
unset border
unset tics
unset grid
set lmargin at screen across(centre_x - circle - 60)
set rmargin at screen across(centre_x + circle + 60)
set bmargin at screen up(centre_y - circle - 30)
set tmargin at screen up(centre_y + circle + 30)
set xrange [-(circle + 60)/pixel:(circle + 60)/pixel]
set yrange [-(circle + 30)/pixel:(circle + 30)/pixel]
