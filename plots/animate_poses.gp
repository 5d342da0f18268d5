# Pictures of the last rows of the block $poses, put together: call "animate_poses.gp" DELAY PICTURES ROWS
# with so many rows from one picture to the next. Rows before that of the first picture are for the tails of the points.
# The script sets caption(n), the text of the picture of row n, tail, the length of the tails in pictures, and note.

delay = ARG1 + 0
pictures = ARG2 + 0
fine = ARG3 + 0
before = |$poses| - fine*(pictures - 1) - 1         # rows before that of the first picture
poses = "$poses"
eval extent
size = 0.055*span
call plots."bodies.gp" sprintf("%g", 0.02*span)
room = 0.07*span
x0 = x_min - room; x1 = x_max + room; y0 = y_min - room - 0.5*size; y1 = y_max + room
pixel = (x1 - x0)/(y1 - y0) > 1.4 ? 1080/(x1 - x0) : 770/(y1 - y0)

on_page = fixed_pivots(size).ground_hooks(size)
row_at(picture) = before + fine*(picture - 1) + 1
caption_of(picture) = caption(row_at(picture))
before_picture(picture) = ""

# Paths, and of each a tail that grows thinner.
path_part(p, rows, look) = sprintf("$poses %s using %d:%d with lines %s, ", rows, column_of(p), column_of(p) + 1, look)
paths_from(p) = p > points ? "" : path_part(p, "", "lw 3 dt solid lc rgb '#AAAAAA'").paths_from(p + 1)
tail_from(now, part) = now - 1 - fine*tail*(4 - part)/3 > 0 ? now - 1 - fine*tail*(4 - part)/3 : 0
tail_part(now, p, part) = path_part(p, sprintf("every ::%d::%d", tail_from(now, part), now - 1), sprintf("lw %d dt solid lc rgb '%s'", 1 + 3*part, point_ink(p)))
tails_from(now, p) = p > points ? "" : tail_part(now, p, 1).tail_part(now, p, 2).tail_part(now, p, 3).tails_from(now, p + 1)
parts_of(picture) = paths_from(1).tails_from(row_at(picture), 1).mechanism($poses[row_at(picture)])
load plots."animation.gp"
