# Curves of the displacements of pins and points, which response.dat and transient.dat share; after `eval answer(table, "facts")`.
# Sets what panels.gp needs besides x and x_axis.

# A pin has a row for each of its links, A:crank and A:coupler, of one displacement; links turn as much as their points do, pins
# have two rotations. Points stand first.
is_pin(name) = strstrt(name, ":") > 0
pin_of(name) = name[1 : strstrt(name, ":") - 1]
points = ""
pins = ""
met = " "
do for [name in words_in(table, "displaced")] {
    if (!is_pin(name)) { points = points." ".quoted_twice(name) }
    if (is_pin(name) && strstrt(met, " ".pin_of(name)." ") == 0) { pins = pins." ".quoted_twice(name); met = met.pin_of(name)." " }
}
curves = points.pins
titles_of_points = points eq "" ? "" : short_names(points, 1)
titles = titles_of_points
do for [name in pins] { titles = titles." ".quoted_twice(inside(pin_of(name), name_length)) }

source_of(k) = rows_if(table, is_named("point", word(curves, k)))
picked = "same(field('speed'),speed)"
note = "elastic less rigid linkage, in global axes".(words(points) > 0 ? "; rotation: of the link at its point" : "")
panels = words(points) > 0 ? 3 : 2
array axis_of[3] = ["displacement x", "displacement y", "rotation"]
array unit_of[3] = [unit_ux, unit_uy, unit_rotation]
array curves_of[3] = [repeated(words(curves), "field('ux')"), repeated(words(curves), "field('uy')"), \
    repeated(words(points), "field('rotation')")]
array titles_of[3] = [titles, titles, titles_of_points]
