#!/bin/sh
# The linkage of echo.deck as bodies at instants of its motion: at the first row of motion.dat and every STRIDE rows, COUNT in all.
#   motion_shapes.sh FOLDER STRIDE COUNT SHARE
# Files and gnuplot assignments are those of shapes.awk, with the time in place of the crank. What is fixed to a link moves with
# its pins, whose places are those of motion_pins.dat, or, without that table, of the motion computed once more. FLEXMECH is the
# program, PLOTS the folder of the scripts.

set -u
folder=$1
rm -rf "$folder"
mkdir "$folder" || exit 1
again=
[ -f motion_pins.dat ] || again=yes
card=$(grep -i '^REPORT *motion' echo.deck)
{
    grep -v '^\(REPORT\|END\)' echo.deck
    echo "REPORT geometry $(printf '%s\n' "$card" | grep -io 'crank=[^ ]*' | head -n 1)"
    [ -z "$again" ] || printf '%s\n' "$card" | sed 's/ *pins=no//I; s/^REPORT *motion/& pins=yes/I'
} > "$folder/drawn.deck"
"$FLEXMECH" --quiet --out "$folder" "$folder/drawn.deck" 2> "$folder/told" || [ $? -eq 1 ] || {
    cat "$folder/told" >&2
    exit 1
}
pins=motion_pins.dat
[ -z "$again" ] || pins=$folder/drawn/motion_pins.dat
awk -v stride="$2" -v count="$3" -f "$PLOTS/motion_places.awk" "$folder/drawn/geometry.dat" "$pins" |
    awk -v folder="$folder" -v share="$4" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/shapes.awk"
