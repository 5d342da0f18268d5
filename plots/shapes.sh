#!/bin/sh
# Any linkage drawn as bodies: the linkage of echo.deck at COUNT + 1 positions from LOW to HIGH, evenly, as the program places it.
#   shapes.sh FOLDER LOW HIGH COUNT SHARE
# Files and gnuplot assignments are those of shapes.awk. FLEXMECH is the program, PLOTS the folder of shapes.awk.

set -u
folder=$1
rm -rf "$folder"
mkdir "$folder" || exit 1
{
    grep -v '^\(REPORT\|END\)' echo.deck
    awk -v low="$2" -v high="$3" -v count="$4" 'BEGIN {
        printf "REPORT geometry crank="
        for (k = 0; k <= count; k++) printf "%s%.15g", (k ? "," : ""), low + (high - low)*k/count
        print ""
    }'
} > "$folder/drawn.deck"
"$FLEXMECH" --quiet --out "$folder" "$folder/drawn.deck" 2> "$folder/told" || [ $? -eq 1 ] || {
    cat "$folder/told" >&2
    exit 1
}
awk -v folder="$folder" -v share="$5" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/shapes.awk" < "$folder/drawn/geometry.dat"
