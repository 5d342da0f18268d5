# The forces at the pins and the shaking force as the linkage moves, at one speed: a turn of the crank, or to and fro.

eval smaller(0.65)

shown = 72
load plots."force_arrows.gp"
size = 0.055*span
call plots."bodies.gp" sprintf("%g", 0.018*span)
eval scale_of_forces
room = 0.05*span
x0 = x_min - room
x1 = x_max + room
y0 = y_min - room - 0.6*size
y1 = y_max + room
pixel = lesser(1080/(x1 - x0), 770/(y1 - y0))
rows_drawn = |$forces|
turning = high_crank - low_crank > 300
pictures = turning ? rows_drawn : 2*rows_drawn - 2
row_of(picture) = picture <= rows_drawn ? picture : 2*rows_drawn - picture

note = ""
load plots."legend.gp"
eval entries_of_forces
on_page = fixed_pivots(size).ground_hooks(size)
caption_of(picture) = sprintf("θ₂ = %.4g°,  %s", word($forces[row_of(picture)], 1) + 0, moment)
before_picture(picture) = arrows_of($places[row_of(picture)], $forces[row_of(picture)])
parts_of(picture) = pale_mechanism($places[row_of(picture)])
delay = turning ? floor(300.0/pictures + 0.5) : 5
load plots."animation.gp"
