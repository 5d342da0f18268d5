# Pictures of a linkage of any kind at positions that shapes.awk has written, put together: call "animate_shapes.gp"
# The script sets pictures, their number, and pose_of(picture), the position of each; caption(position), its text, delay, in
# hundredths of a second, note, and tail, a third of the length of the tails of paths, in positions; they are drawn where tail_shown(picture).

room = 0.05*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room; y1 = y_max + room
pixel = (x1 - x0)/(y1 - y0) > 1.4 ? 1080/(x1 - x0) : 770/(y1 - y0)

# A tail that grows thinner: of the last rows before this position.
tails(n, k) = k > paths ? "" : (path_ink[k] eq "" ? "" : tail_part(n, k, 1).tail_part(n, k, 2).tail_part(n, k, 3)).tails(n, k + 1)
tail_from(n, part) = n - tail*(4 - part) < 1 ? 1 : n - tail*(4 - part)
tail_part(n, k, part) = sprintf("'%s/paths' every ::%d::%d using %d:%d with lines lw %d dt solid lc rgb '%s' notitle, ", \
    shapes, tail_from(n, part) - 1, n - 1, 2*k, 2*k + 1, 1 + 3*part, path_ink[k])
all_paths = ""
do for [k=1:paths] {
    all_paths = all_paths.path_columns(k).sprintf(" with lines lw %g dt solid lc rgb '%s' notitle, ", path_ink[k] eq "" ? 1.5 : 3, \
        path_ink[k] eq "" ? "#C8C8C8" : "#AAAAAA")
}
on_page = ""
caption_of(picture) = caption(pose_of(picture))
before_picture(picture) = ""
parts_of(picture) = fixed_parts.all_paths.bodies(pose_of(picture)).(tail_shown(picture) ? tails(pose_of(picture), 1) : "").\
    pins_of(pose_of(picture))
load plots."animation.gp"
