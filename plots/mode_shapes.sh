#!/bin/sh
# The linkage of echo.deck as it swings in modes of shapes.dat: what stands still, blocks, springs and joints.
#   mode_shapes.sh FOLDER TABLE SPEED MODES CRANKS SIZE BAR PARTS
# MODES and CRANKS are lists with commas; SIZE is the largest displacement drawn, BAR half the width of a bar, PARTS of the swing
# are drawn. Files and gnuplot assignments are those of mode_places.awk and shapes.awk. FLEXMECH is the program, PLOTS the folder
# of the scripts.

set -u
folder=$1 table=$2
rm -rf "$folder"
mkdir "$folder" || exit 1
{
    grep -v '^\(REPORT\|END\)' echo.deck
    awk -v want='distinct =crank' -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$table" | sort -g | awk -v cranks="$5" '
        BEGIN { n = split(cranks, crank, ",") }
        {
            for (i = 1; i <= n; i++) if (($1 - crank[i])^2 <= 1e-18*(1 + crank[i]^2)) break
            if (i <= n) list = list (list == "" ? "" : ",") sprintf("%.15g", $1)
        }
        END { print "REPORT geometry crank=" list }'
} > "$folder/drawn.deck"
"$FLEXMECH" --quiet --out "$folder" "$folder/drawn.deck" 2> "$folder/told" || [ $? -eq 1 ] || {
    cat "$folder/told" >&2
    exit 1
}
awk -v folder="$folder" -v speed="$3" -v modes="$4" -v cranks="$5" -v size="$6" -v parts="$8" -f "$PLOTS/mode_places.awk" \
    "$folder/drawn/geometry.dat" echo.deck "$table" |
    awk -v folder="$folder" -v bar="$7" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/shapes.awk" || exit 1
cat "$folder/modes"
