# The mechanism as it swings in a mode, once to and fro.

eval smaller(0.6)

pictures = 40
parts = ""
do for [picture=1:pictures] { parts = parts.sprintf(" %.17g", sin(2*pi*(picture - 1)/pictures)) }
load plots."mode_page.gp"
do for [picture=1:pictures] {
    if (picture == 1) { eval mode_frame } else { eval open_page(page_width, page_height) }
    set output sprintf("%s_%03d", out, picture)
    eval mode_shape(picture)
}
unset output
call plots."gif.gp" out pictures 5
