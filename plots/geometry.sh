#!/bin/sh
# Where the linkage of echo.deck is at some crank angles, as the program places it: gnuplot assignments and a datablock.
#   geometry.sh BLOCK ANGLES [points.dat or response.dat]
# ANGLES is a file, a position a line: the crank angle in degrees, then the branch, open or crossed, if it is not the deck's.
# Sets the pivots O2 and O4, turns_fully, and link_ends, as response.dat names them: O2:crank A:crank A:coupler B:coupler
# O4:follower B:follower; for the points of the table, in its order, point_link[k]: 2 the crank's link, 3 the coupler, 4 the
# follower. A row of $BLOCK is a line of ANGLES: 1 the angle, 2 3 pin A, 4 5 pin B, then x and y of every
# point, or of the middle of the coupler where there is no points.dat, then the numbers of springs and dampers (see springs.awk, which
# sets more facts); hooks are the GROUND pins that only these use, at hook_x[k] hook_y[k], turned by hook_turn[k]. FLEXMECH is the program, PLOTS the folder of tables.awk.

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
    awk -v want=poses -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" | sed "s/^/$branch /" >> "$work/poses"
    awk -v want='distinct link' -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" > "$work/links"
    turns=0
    grep -q '^# limit positions of the crank: none$' "$work/drawn/geometry.dat" && turns=1
    # Where two pins meet the linkage has no place of its own: it is drawn as it tends to be.
    sed -n 's/^# *failed crank=\([^ ]*\) .*/\1/p' "$work/drawn/geometry.dat" > "$work/failed"
    [ -s "$work/failed" ] || continue
    place "$(awk '{ printf "%s%.17g", (NR > 1 ? "," : ""), $1 + 1e-6 }' "$work/failed")" || exit 1
    awk -v want=poses -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$work/drawn/geometry.dat" | sed 's/^[^ ]* //' | paste -d' ' "$work/failed" - |
        awk -v branch=$branch 'NF > 1 { $1 = sprintf("%.17g", $1); print branch, $0 }' >> "$work/poses"
done
[ -z "$points" ] || awk -v want='distinct point' -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$points" | grep -v : > "$work/points"
[ -n "$points" ] || : > "$work/points"

echo "turns_fully = $turns"
awk -v block="$block" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/geometry.awk" \
    "$work/links" "$work/points" "$work/places" "$work/poses" "$work/asked"
