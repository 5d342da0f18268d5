# Draws the legend of legend.gp: call "draw_legend.gp" HEIGHT, its upper edge in pixels below that of the page.

legend_row = 0
do for [k=1:entries] {
    if (entry_row[k] != legend_row) {
        legend_row = entry_row[k]
        legend_x = (page_width - row_width[legend_row])/2.0
        legend_y = down(ARG1 + legend_line*(legend_row - 0.5))
    }
    if (entry_kind[k] eq "point") {
        eval sprintf("set label %d '' at screen %.6f, %.6f point %s", 700 + k, \
            across(legend_x + entry_long[k]/2), legend_y, entry_style[k])
    } else {
        eval sprintf("set arrow %d from screen %.6f, %.6f to screen %.6f, %.6f %s %s", 700 + k, across(legend_x), legend_y, \
            across(legend_x + entry_long[k]), legend_y, entry_kind[k] eq "line" ? "nohead" : "", entry_style[k])
    }
    set label 800 + k entry_text[k] at screen across(legend_x + entry_long[k] + 14), legend_y left noenhanced font ",18"
    legend_x = legend_x + entry_width(k)
}
