# The pictures OUT_001, OUT_002 … become OUT.gif, which plays them over and over.
#   call "gif.gp" OUT PICTURES DELAY        (in hundredths of a second)
# Pictures by cairo have smooth edges; what draws GIF has not, so it only puts them together. A GIF has 256 colours for all
# its pictures: 6 levels of red, green and blue each, and greys; they are shown once, below the first picture, to be kept.

width = int(page_width*page_scale)
height = int(page_height*page_scale)
eval sprintf("set terminal gif animate delay %d loop 0 optimize size %d,%d", ARG3 + 0, width, height)
set output ARG1.".gif"
reset
unset border
unset tics
unset key
unset colorbox
set lmargin at screen 0
set rmargin at screen 1
set bmargin at screen 0
set tmargin at screen 1
set xrange [-0.5:width - 0.5]
set yrange [-0.5:height - 0.5]
set print $colours
do for [k=0:215] { print sprintf("%d %d %d %d %d", k%18, k/18, k%6*51, k/6%6*51, k/36*51) }
do for [k=0:17] { print sprintf("%d %d %d %d %d", k, 12, 14*k + 7, 14*k + 7, 14*k + 7) }
unset print
do for [k=1:ARG2 + 0] {
    plot $colours using 1:2:3:4:5 with rgbimage, sprintf("%s_%03d", ARG1, k) binary filetype=png with rgbimage
}
unset output
