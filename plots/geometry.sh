#!/bin/sh
# Where the linkage of echo.deck is at some crank angles, as the program places it: gnuplot assignments and a datablock.
#   geometry.sh BLOCK ANGLES [points.dat or response.dat]
# ANGLES is a file, a position a line: the crank angle in degrees, then the branch, open or crossed, if it is not the deck's.
# Sets the pivots O2 and O4, turns_fully, and link_ends, as response.dat names them: O2:crank A:crank A:coupler B:coupler
# O4:follower B:follower; for the points of the table, in its order, point_link[k]: 2 the crank's link, 3 the coupler, 4 the
# follower. A row of $BLOCK is a line of ANGLES: 1 the angle, 2 3 pin A, 4 5 pin B, then x and y of every
# point, or of the middle of the coupler where there is no points.dat. FLEXMECH is the program, PLOTS the folder of tables.awk.

set -u
block=$1 angles=$2 points=${3-}
work=$angles.d
mkdir "$work" || exit 1

# The program takes an angle once: nearer to each other than it tells apart, they are one position.
awk '{ printf "%.17g %s\n", $1 + 0, $2 == "" ? "-" : $2 }' "$angles" > "$work/asked"
# place CRANK,…: the deck's linkage, or that of $branch, at these angles, in the order in which they are given.
place() {
    {
        if [ $branch = - ]; then
            grep -v '^\(REPORT\|END\)' echo.deck
        else
            grep -v '^\(REPORT\|END\|BRANCH\)' echo.deck
            echo "BRANCH $branch"
        fi
        echo "REPORT geometry crank=$1"
    } > "$work/drawn.deck"
    "$FLEXMECH" --quiet --out "$work" "$work/drawn.deck" 2> "$work/told" || [ $? -eq 1 ] || {
        cat "$work/told" >&2
        return 1
    }
}

for branch in - open crossed; do
    awk -v branch=$branch '$2 == branch { print $1 }' "$work/asked" | sort -g |
        awk '{ apart = ($1 < 0 ? -$1 : $1) + 1 } NR == 1 || $1 - kept > 2e-12*apart { kept = $1 } { print $1, kept }' \
        > "$work/kept"
    [ -s "$work/kept" ] || continue
    place "$(cut -d' ' -f2 "$work/kept" | uniq | paste -s -d, -)" || exit 1
    sed "s/^/$branch /" "$work/kept" >> "$work/places"
    awk -v want=poses -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" | sed "s/^/$branch /" >> "$work/poses"
    awk -v want='names link' -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" > "$work/links"
    turns=0
    grep -q '^# limit positions of the crank: none$' "$work/drawn/geometry.dat" && turns=1
    # Where two pins meet the linkage has no place of its own: it is drawn as it tends to be.
    sed -n 's/^# *failed crank=\([^ ]*\) .*/\1/p' "$work/drawn/geometry.dat" > "$work/failed"
    [ -s "$work/failed" ] || continue
    place "$(awk '{ printf "%s%.17g", (NR > 1 ? "," : ""), $1 + 1e-6 }' "$work/failed")" || exit 1
    awk -v want=poses -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" | sed 's/^[^ ]* //' | paste -d' ' "$work/failed" - |
        awk -v branch=$branch 'NF > 1 { $1 = sprintf("%.17g", $1); print branch, $0 }' >> "$work/poses"
done
[ -z "$points" ] || awk -v want=points -f "$PLOTS/tables.awk" < "$points" > "$work/points"
[ -n "$points" ] || : > "$work/points"

# A line of poses is branch, angle, then for every pin and point the number of its link (0 the ground, below 0 for points), its
# name and its place.
echo "turns_fully = $turns"
awk -v block="$block" '
    FILENAME ~ /links$/ { if ($1 != "(ground)") link_name[++links] = $1; next }
    FILENAME ~ /points$/ { wanted[++n_points] = $1; next }
    FILENAME ~ /places$/ { place[$1, $2] = $3; next }
    FILENAME ~ /poses$/ {
        grounds = 0
        row = ""
        for (i = 3; i <= NF; i += 4) {
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
        pose[$1, $2] = row
        next
    }
    !begun++ { print "$" block " << EOD" }
    { key = $2 SUBSEP place[$2, $1]; printf "%.10g%s\n", $1, key in pose ? pose[key] : " NaN NaN NaN NaN NaN NaN" }
    END { print "EOD" }' "$work/links" "$work/points" "$work/places" "$work/poses" "$work/asked"
