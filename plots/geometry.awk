# Poses of the linkage, as places.sh asks for them, as gnuplot assignments and a datablock:
#   awk -v block=BLOCK -f quoted.awk -f springs.awk -f geometry.awk links points places poses asked
# A line of poses is branch, angle, then for every pin and point the number of its link (0 the ground, below 0 for points), its
# name and its place; for springs and dampers likewise, see `poses` of tables.awk.

FILENAME ~ /links$/ { if ($1 != "(ground)") link_name[++links] = $1; next }
FILENAME ~ /points$/ { wanted[++n_points] = $1; next }
FILENAME ~ /places$/ { place[$1, $2] = $3; next }
FILENAME ~ /poses$/ {
    grounds = 0
    row = ""
    key = $1 SUBSEP $2
    for (i = 3; i <= NF; i += 4) {
        if (split($i, spring, "|") > 1) {
            take_spring(key, spring[2], spring[1], $(i + 1), $(i + 2) + 0, $(i + 3) + 0)
            find_hook($(i + 1), $(i + 2), $(i + 3))
            continue
        }
        x[$(i + 1)] = $(i + 2); y[$(i + 1)] = $(i + 3)
        if ($i == 0) { ground[++grounds] = $(i + 1); known[$(i + 1)] = 1 }
        else if ($i < 0) link_of[$(i + 1)] = -$i
        else if (!($(i + 1) in known)) { known[$(i + 1)] = 1; pin[++pins] = $(i + 1) }
    }
    if (!poses++) {
        printf "O2 = {%.12g, %.12g}; O4 = {%.12g, %.12g}\n", x[ground[1]], y[ground[1]], x[ground[2]], y[ground[2]]
        printf "link_ends = \"%s:%s %s:%s %s:%s %s:%s %s:%s %s:%s\"\n", ground[1], link_name[1], pin[1], link_name[1], \
            pin[1], link_name[2], pin[2], link_name[2], ground[2], link_name[3], pin[2], link_name[3]
        for (k = 1; k <= n_points; k++) printf "point_link[%d] = %d\n", k, link_of[wanted[k]] + 1
    }
    for (k = 1; k <= 2; k++) row = row sprintf(" %.7g %.7g", x[pin[k]], y[pin[k]])
    for (k = 1; k <= n_points; k++) row = row sprintf(" %.7g %.7g", x[wanted[k]], y[wanted[k]])
    if (!n_points) row = row sprintf(" %.7g %.7g", (x[pin[1]] + x[pin[2]])/2, (y[pin[1]] + y[pin[2]])/2)
    pose[key] = row spring_numbers(key)
    next
}

!begun++ {
    print_springs()
    print "O2_x = real(O2); O2_y = imag(O2); O4_x = real(O4); O4_y = imag(O4)"
    printf "hooks = %d; array hook_x[%d]; array hook_y[%d]; array hook_turn[%d]\n", hooks, hooks + 1, hooks + 1, hooks + 1
    for (k = 1; k <= hooks; k++)
        printf "hook_x[%d] = %.9g; hook_y[%d] = %.9g; hook_turn[%d] = %d\n", k, hook_x[k], k, hook_y[k], k, hook_turn(k)
    print "$" block " << EOD"
}

{ key = $2 SUBSEP place[$2, $1]; printf "%.10g%s\n", $1, key in pose ? pose[key] : nowhere() }

END { print "EOD" }

# A place that is neither a pin nor a point stands still.
function find_hook(name, x_there, y_there) {
    if (name in x || name in is_hook) return
    is_hook[name] = 1
    hook_x[++hooks] = x_there
    hook_y[hooks] = y_there
    hook_name[hooks] = name ""
    hook_pose[hooks] = key
}

# Upright if its springs pull upwards, else turned by quarters.
function hook_turn(k,    s, e, pull_x, pull_y) {
    for (s = 1; s <= springs; s++)
        for (e = 1; e <= 2; e++) {
            if (spring_turns(s) || end_name[s, e] != hook_name[k]) continue
            pull_x += end_x[hook_pose[k], s, 3 - e] - hook_x[k]
            pull_y += end_y[hook_pose[k], s, 3 - e] - hook_y[k]
        }
    if (4 * pull_y * pull_y >= pull_x * pull_x) return pull_y < 0 ? 180 : 0
    return pull_x < 0 ? 90 : -90
}

function nowhere(    k, text) {
    for (k = 1; k <= 4 + 2 * (n_points ? n_points : 1) + 4 * springs; k++) text = text " NaN"
    return text
}
