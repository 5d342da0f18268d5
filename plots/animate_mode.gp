# The mechanism as it swings in a mode, once to and fro.
#   gnuplot -c animate_mode.gp shapes.dat OUT MODE CRANK SPEED [FIGURE [REMARK]]

load ARG0[1 : strlen(ARG0) - strlen("animate_mode.gp")]."style.gp"
table = ARG1; out = ARG2; mode = ARG3 + 0; crank = ARG4 + 0; speed = ARG5 + 0; figure = argument(6); remark = argument(7)
eval smaller(0.6)
load plots."drawing.gp"

eval answer(table, "facts")
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
eval close
