# Springs and dampers in drawings of linkages: parts of a plot command, each with a comma behind it. Once what springs.awk prints is
# there:
#   call "springs.gp" SIZE
# SIZE is half the width of a coil, in the unit of the axes. spring_at(k, numbers) draws spring k, whose four numbers are a text.
# Pale ones are drawn in pale_spring_ink. Coils are as many at every length; a damper is longer by the way of its piston.

spring_size = ARG1 + 0
if (!exists("springs")) { springs = 0; spring_kinds = "" }
if (!exists("hooks")) { hooks = 0 }
if (!exists("spring_column")) { spring_column = 1 }
set print $steps
do for [k=0:120] { print k }
unset print

# Which length along a damper, and how far across; a stroke ends at an empty line.
set print $dashpot
print "0 0\n1 0\n\n2 1\n1 1\n1 -1\n2 -1\n\n3 0.7\n3 -0.7\n\n3 0\n4 0"
unset print

coils(k) = larger(6, lesser(20, 2*int(spring_high[k]/(2.4*spring_size) + 0.5)))
coil_along(j, n) = j == 0 ? 0 : j == 1 ? 0.13 : j <= n + 1 ? 0.13 + 0.74*(j - 1.5)/n : j == n + 2 ? 0.87 : 1
coil_across(j, n) = j < 2 || j > n + 1 ? 0 : int(j)%2 == 0 ? spring_size : -spring_size

damper_long(k) = lesser(0.55*spring_low[k], larger(5*spring_size, 1.6*(spring_high[k] - spring_low[k])))
damper_share(k, long) = spring_high[k] - spring_low[k] > 1e-6*spring_high[k] \
    ? 0.2 + 0.6*(long - spring_low[k])/(spring_high[k] - spring_low[k]) : 0.5
damper_along(j, from, case, share, long) = j == 0 ? 0 : j == 1 ? from : j == 2 ? from + case : j == 3 ? from + share*case : long

# From x1 y1 towards x2 y2: a length along, as a share, and one across.
line_x(along, across, x1, y1, x2, y2) = x1 + along*(x2 - x1) - across*(y2 - y1)/sqrt((x2 - x1)**2 + (y2 - y1)**2)
line_y(along, across, x1, y1, x2, y2) = y1 + along*(y2 - y1) + across*(x2 - x1)/sqrt((x2 - x1)**2 + (y2 - y1)**2)

number_of(numbers, i) = real(word(numbers, i))
length_of(numbers) = sqrt((number_of(numbers, 3) - number_of(numbers, 1))**2 + (number_of(numbers, 4) - number_of(numbers, 2))**2)
listed(numbers) = sprintf("%s, %s, %s, %s", word(numbers, 1), word(numbers, 2), word(numbers, 3), word(numbers, 4))
on_line(source, along, across, numbers) = sprintf("%s using (line_x(%s, %s, %s)):(line_y(%s, %s, %s))", source, along, across, \
    listed(numbers), along, across, listed(numbers))
zigzag(n, numbers) = on_line(sprintf("$steps every ::0::%d", n + 3), sprintf("coil_along($1, %d)", n), \
    sprintf("coil_across($1, %d)", n), numbers)
dashpot(k, numbers) = on_line("$dashpot", sprintf("damper_along($1, %.6g, %.6g, %.6g, %.6g)/%.6g", \
    0.5*(spring_low[k] - damper_long(k)), damper_long(k), damper_share(k, length_of(numbers)), length_of(numbers), \
    length_of(numbers)), "spring_size*$2", numbers)

# Round a pin: radius and angle of a step.
round_pin(steps, radius, angle, numbers) = sprintf("$steps every ::0::%d using (%s + %s*cos(%s)):(%s + %s*sin(%s))", \
    steps, word(numbers, 1), radius, angle, word(numbers, 2), radius, angle)
spiral(numbers) = round_pin(120, "spring_size*(1 + $1/54.0)", \
    sprintf("(%.7g + %.7g*$1/120)", number_of(numbers, 3), number_of(numbers, 4) - number_of(numbers, 3) + 4*pi), numbers)
paddle(numbers) = round_pin(1, "2.2*spring_size*(1 - 2*$1)", sprintf("(%.7g)", number_of(numbers, 4) + 0.5*pi), numbers)
drum(numbers) = round_pin(60, "2.7*spring_size", "($1*pi/30)", numbers)
drum_foot(numbers) = round_pin(1, "spring_size*(2.7 + 1.2*$1)", sprintf("(%.7g)", number_of(numbers, 3)), numbers)

looks(part) = sprintf("%s with lines lw 6 dt solid lc rgb 'white' notitle, %s with lines lw 2.5 dt solid lc rgb '#333333' notitle, ", part, part)
pale_looks(part) = sprintf("%s with lines lw 2 dt solid lc rgb '%s' notitle, ", part, pale_spring_ink)
is_there(kind, numbers) = words(numbers) == 4 && strstrt(numbers, "NaN") == 0 && \
    ((kind ne "spring" && kind ne "damper") || length_of(numbers) > 0)
spring_at(k, numbers) = !is_there(word(spring_kinds, k), numbers) ? "" : word(spring_kinds, k) eq "spring" ? looks(zigzag(coils(k), numbers)) \
    : word(spring_kinds, k) eq "damper" ? looks(dashpot(k, numbers)) : word(spring_kinds, k) eq "coil" ? looks(spiral(numbers)) \
    : looks(paddle(numbers)).looks(drum(numbers)).looks(drum_foot(numbers))
pale_spring_at(k, numbers) = !is_there(word(spring_kinds, k), numbers) ? "" : word(spring_kinds, k) eq "spring" \
    ? pale_looks(zigzag(coils(k), numbers)) : word(spring_kinds, k) eq "damper" ? pale_looks(dashpot(k, numbers)) : ""

# All springs of a row whose numbers begin at a word.
numbers_at(row, at) = sprintf("%s %s %s %s", word(row, at), word(row, at + 1), word(row, at + 2), word(row, at + 3))
springs_from(k, row, at) = k > springs ? "" : spring_at(k, numbers_at(row, at)).springs_from(k + 1, row, at + 4)
pale_springs_from(k, row, at) = k > springs ? "" : pale_spring_at(k, numbers_at(row, at)).pale_springs_from(k + 1, row, at + 4)
