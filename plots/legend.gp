# The legend of a drawing, in as many lines as it needs. Its script says what stands in it, before the page is opened:
#   load plots."legend.gp"              begins an empty one; then for each entry one of
#   eval entry_line(text, style)        a line: `lw 3 lc rgb 'red' dt solid`
#   eval entry_point(text, style)       a mark: `pt 7 ps 2`
#   eval entry_arrow(text, style, pixels, direction)     an arrow of some length
# arrange(width) then gives the lines of the legend, and `eval draw_legend(height)` draws it, its upper edge so far below that of
# the page.

entries = 0
array entry_text[60]
array entry_style[60]
array entry_kind[60]
array entry_long[60]
legend_font = 18
add_entry(kind, text, style, pixels) = sprintf("entries = entries + 1; entry_kind[entries] = '%s'; entry_long[entries] = %g; ", \
    kind, pixels)."entry_text[entries] = ".quoted_twice(text)."; entry_style[entries] = ".quoted_twice(style)
entry_line(text, style) = add_entry("line", text, style, 60)
entry_point(text, style) = add_entry("point", text, style, 24)
entry_arrow(text, style, pixels) = add_entry("arrow", text, style, pixels)

legend_gap = 55
legend_line = 42
entry_width(k) = entry_long[k] + 14 + text_width(entry_text[k], legend_font) + legend_gap
array entry_row[60]
array row_width[60]
arrange(width) = (rows_of_legend = entries > 0 ? 1 : 0, row_width[1] = -legend_gap, \
    arranged = arrange_from(1, width), rows_of_legend)
arrange_from(k, width) = k > entries ? 0 : ( \
    row_width[rows_of_legend] > 0 && row_width[rows_of_legend] + entry_width(k) > width \
        ? (rows_of_legend = rows_of_legend + 1, row_width[rows_of_legend] = -legend_gap) : 0, \
    entry_row[k] = rows_of_legend, row_width[rows_of_legend] = row_width[rows_of_legend] + entry_width(k), \
    arrange_from(k + 1, width))
legend_height(width) = arrange(width)*legend_line

draw_legend(height) = sprintf("call plots.'draw_legend.gp' '%g'", height)
