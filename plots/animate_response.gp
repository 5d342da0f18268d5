# The linkage as it bends over a turn in the elastic response at one speed, displacements made larger.

eval smaller(0.65)

want_positions = 90
load plots."deformed.gp"
eval include_moved(1, positions_drawn)
size = 0.055*span
room = 0.05*span
x0 = x_min - room
x1 = x_max + room
y0 = lesser(y_min, lesser(O2_y, O4_y) - size) - room
y1 = y_max + room
pixel = lesser(1080/(x1 - x0), 770/(y1 - y0))

note = ""
load plots."legend.gp"
eval entry_line("rigid links", rigid_look)
eval entry_line(sprintf("elastic links, %s", magnified_text), bent_look)
pictures = positions_drawn
delay = floor(600.0/pictures + 0.5)
on_page = fixed_pivots(size)
caption_of(picture) = sprintf("θ₂ = %.4g°,  %s", word($moved[picture], 1) + 0, moment)
before_picture(picture) = ""
parts_of(picture) = deformed_linkage($poses[picture], $moved[picture])
load plots."animation.gp"
