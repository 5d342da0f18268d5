# A page of several drawings of one scale, tile beside tile. The script sets their ends x0, x1, y0 and y1 (those in y may be other
# ones in each line: line_y0[line], line_y1[line]), tiles and tile_columns, caption_lines below each tile, lead_room, the pixels to
# the left of the tiles, headline, deck_title, note and remark, and the entries of its legend (legend.gp). The page then is
# open, `pixel` pixels are one unit of the axes, and for each tile
#   eval tile(k)        sets the plot's place and its ends, beginning with 1
#   tile_x(k), tile_foot(k)     the middle of a tile across the page, and its lower edge below the upper one, in pixels

tile_lines = int(ceil(tiles/(1.0*tile_columns)))
if (tile_columns > tiles) { tile_columns = tiles }
highest = 0
do for [line=1:tile_lines] { highest = larger(highest, line_y1[line] - line_y0[line]) }
tile_width = lesser(tile_limit, (1540.0 - lead_room)/tile_columns - 20)
pixel = lesser(tile_width/(x1 - x0), 1.25*tile_limit/highest)
tile_width = larger(pixel*(x1 - x0), tile_least)
tile_gap = 20
caption_height = 30*caption_lines + 18
array line_top[tile_lines + 1]
words_width = lesser(1550, larger(text_width(headline, 23), larger(text_width(note, 15), text_width(remark, 15))) + 60)
page_across = larger(larger(lead_room + tile_columns*(tile_width + tile_gap) + 40, words_width), \
    larger(820, lesser(text_width(deck_title, 18), 1050) + 60))
line_top[1] = 116 + legend_height(page_across - 60) + 12 + head_of_columns
do for [line=1:tile_lines] {
    line_top[line + 1] = line_top[line] + pixel*(line_y1[line] - line_y0[line]) + caption_height
}
eval open_page(page_across, line_top[tile_lines + 1] + 25 + 31*lines_of_notes(note, remark))
eval heading
eval draw_legend(116)
tiles_left = (page_across - lead_room - tile_columns*(tile_width + tile_gap))/2 + lead_room
line_of(k) = int((k - 1)/tile_columns) + 1
tile_x(k) = tiles_left + (tile_width + tile_gap)*((k - 1)%tile_columns + 0.5)
tile_foot(k) = line_top[line_of(k)] + pixel*(line_y1[line_of(k)] - line_y0[line_of(k)])
unset border
unset tics
unset grid
unset key
set size ratio -1
half_tile = 0.5*pixel*(x1 - x0)
tile(k) = sprintf("set lmargin at screen %.6f; set rmargin at screen %.6f; set tmargin at screen %.6f; set bmargin at screen %.6f; ", \
    across(tile_x(k) - half_tile), across(tile_x(k) + half_tile), down(line_top[line_of(k)]), down(tile_foot(k))).\
    sprintf("set xrange [%.12g:%.12g]; set yrange [%.12g:%.12g]", x0, x1, line_y0[line_of(k)], line_y1[line_of(k)])
# As small, and at last as short, as a tile has room for.
within_tile(text, size) = inside(text, int(lesser(strlen(text), strlen(text)*(tile_width + 10)/larger(1, text_width(text, size)))))
caption(line, k, text) = sprintf("set label %d ", 950 + line).quoted_twice(within_tile(text, fit_size(text, tile_width + 10, 16, 12))).\
    sprintf(" at screen %.6f, %.6f center noenhanced font point_size(%g)", across(tile_x(k)), down(tile_foot(k) + 30*line - 8), \
        fit_size(text, tile_width + 10, 16, 12))
# To the left of a line, and above the first.
line_title(k, text) = "set label 949 ".quoted_twice(text).sprintf(" at screen %.6f, %.6f center rotate by 90 noenhanced font point_size(18)", \
    across(tiles_left - lead_room + 20), down(0.5*(line_top[line_of(k)] + tile_foot(k))))
column_title(k, text) = "set label 948 ".quoted_twice(text).sprintf(" at screen %.6f, %.6f center noenhanced font point_size(18)", \
    across(tile_x(k)), down(line_top[1] - 22))
# What belongs to the page and not to a tile is drawn once, with the first.
clear_page = "do for [tag_of_page=700:904] { unset label tag_of_page; unset arrow tag_of_page }"
