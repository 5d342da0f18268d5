# Parts of a plot command that draw positions of a linkage of any kind, each with a comma behind it. Loaded once shapes.awk has
# written them into the folder `shapes` and told its facts: bodies(n), pins_of(n) and pale_body(n) draw position n, bodies and pale
# ones with their springs; fixed_parts what stands still.

call plots."springs.gp" sprintf("%g", 1.1*bar)
pale_spring_ink = "#B4B4B4"

polygons(n, k, colour) = sprintf("'%s' index %d with filledcurves closed fc rgb '%s' fs solid 1 noborder notitle, ", \
    shapes."/pose_".n, k - 1, colour)
layers_from(n, k, last) = k > last ? "" : polygons(n, k, layer_fill[k]).layers_from(n, k + 1, last)
pale_from(n, k) = k > layers ? "" : polygons(n, k, layer_pale[k]).pale_from(n, k + 1)
# The first link, often the crank, lies on top of the others, which are longer; blocks lie on links.
links_down_from(n, k) = k < 1 ? "" : layers_from(n, 2*k - 1, 2*k).links_down_from(n, k - 1)
bodies(n) = pose_found[n] == 0 ? "" : links_down_from(n, drawn_links).layers_from(n, 2*drawn_links + 1, body_layers).springs_from(1, $springs[n], 1)
pins_of(n) = pose_found[n] == 0 ? "" : layers_from(n, body_layers + 1, layers)
pale_body(n) = pose_found[n] == 0 ? "" : pale_from(n, 1).pale_springs_from(1, $springs[n], 1)
grounds_part = grounds == 0 ? "" : \
    sprintf("'%s/grounds' index 0 with filledcurves closed fc rgb 'white' fs solid 1 noborder notitle, ", shapes).\
    sprintf("'%s/grounds' index 0 with lines lw 2 dt solid lc rgb ink notitle, ", shapes).\
    sprintf("'%s/grounds' index 1 with lines lw 1.5 dt solid lc rgb ink notitle, ", shapes)
fixed_parts = grounds_part.(system("wc -c < ".quoted(shapes."/guides")) < 3 ? "" : \
    sprintf("'%s/guides' index 0 with lines lw 3 dt solid lc rgb ink notitle, ", shapes).\
    sprintf("'%s/guides' index 1 with lines lw 1.5 dt solid lc rgb ink notitle, ", shapes))

# Paths: of interest in colour, others thin.
path_columns(k) = sprintf("'%s/paths' using %d:%d", shapes, 2*k, 2*k + 1)
thin_paths(k) = k > paths ? "" : (path_ink[k] ne "" ? "" : \
    path_columns(k)." with lines lw 1.5 dt solid lc rgb '#A8A8A8' notitle, ").thin_paths(k + 1)
drawn_paths(k) = k > paths ? "" : (path_ink[k] eq "" ? "" : path_columns(k)." with lines lw 7 dt solid lc rgb 'white' notitle, ".\
    path_columns(k).sprintf(" with lines lw 4 dt solid lc rgb '%s' notitle, ", path_ink[k])).drawn_paths(k + 1)
