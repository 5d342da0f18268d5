# Springs and dampers of geometry.dat, for drawings: functions for the scripts that read it, with -f quoted.awk -f springs.awk before their own.
#   take_spring(pose, name, part, place, x, y)   a row of part spring, damper or side
#   spring_numbers(pose)                         behind a blank each, four numbers for every spring, in their order: both ends, or of a
#                                                torsional one its pin and the angles of its two links from there, in radians, the second
#                                                going on from pose to pose beyond a half turn; on the ground it is held below
#   print_springs()                              gnuplot assignments: springs, spring_kinds (spring and damper; torsional: coil and drag),
#                                                spring_names, spring_low[k] and spring_high[k], the least and the greatest length

function take_spring(pose, name, part, place, x, y,    k) {
    if (part == "side") {
        k = ++side_rows[pose, spring_taken]
        side_x[pose, spring_taken, k] = x
        side_y[pose, spring_taken, k] = y
        return
    }
    if (!((part, name) in spring_of)) {
        spring_of[part, name] = ++springs
        spring_part[springs] = part
        spring_name[springs] = name ""
    }
    spring_taken = spring_of[part, name]
    k = ++end_rows[pose, spring_taken]
    end_name[spring_taken, k] = place ""
    end_x[pose, spring_taken, k] = x
    end_y[pose, spring_taken, k] = y
}

function spring_turns(s) { return !((s, 2) in end_name) }

function spring_kind(s) { return !spring_turns(s) ? spring_part[s] : spring_part[s] == "spring" ? "coil" : "drag" }

function spring_numbers(pose,    s, text) {
    for (s = 1; s <= springs; s++) text = text (!((pose, s) in end_rows) ? " NaN NaN NaN NaN" : spring_turns(s) ? angles_of(pose, s) : ends_of(pose, s))
    return text
}

function ends_of(pose, s,    long) {
    long = sqrt((end_x[pose, s, 2] - end_x[pose, s, 1])^2 + (end_y[pose, s, 2] - end_y[pose, s, 1])^2)
    if (!(s in spring_low) || long < spring_low[s]) spring_low[s] = long
    if (!(s in spring_high) || long > spring_high[s]) spring_high[s] = long
    return sprintf(" %.7g %.7g %.7g %.7g", end_x[pose, s, 1], end_y[pose, s, 1], end_x[pose, s, 2], end_y[pose, s, 2])
}

function angles_of(pose, s,    half_turn, first, turn, sides) {
    half_turn = atan2(0, -1)
    sides = side_rows[pose, s]
    first = sides == 2 ? side_angle(pose, s, 1) : -half_turn / 2
    turn = side_angle(pose, s, sides) - first
    while (turn - spring_turn[s] > half_turn) turn -= 2 * half_turn
    while (turn - spring_turn[s] < -half_turn) turn += 2 * half_turn
    spring_turn[s] = turn
    return sprintf(" %.7g %.7g %.7g %.7g", end_x[pose, s, 1], end_y[pose, s, 1], first, first + turn)
}

function side_angle(pose, s, k) { return atan2(side_y[pose, s, k] - end_y[pose, s, 1], side_x[pose, s, k] - end_x[pose, s, 1]) }

function print_springs(    s, kinds, names) {
    printf "array spring_low[%d]; array spring_high[%d]\n", springs + 1, springs + 1
    for (s = 1; s <= springs; s++) {
        printf "spring_low[%d] = %.9g; spring_high[%d] = %.9g\n", s, spring_low[s] + 0, s, spring_high[s] + 0
        kinds = kinds " " spring_kind(s)
        names = names " \"" spring_name[s] "\""
    }
    printf "springs = %d; spring_kinds = \"%s\"; spring_names = %s\n", springs, substr(kinds, 2), quoted(names)
}
