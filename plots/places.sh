#!/bin/sh
# Where the linkage of echo.deck is, as the program places it, for drawings: files below FOLDER and gnuplot assignments.
#   places.sh range FOLDER LOW HIGH COUNT SHARE
#       as bodies at COUNT + 1 positions, evenly: see shapes.awk
#   places.sh motion FOLDER STRIDE COUNT SHARE
#       as bodies at instants of its motion, the first row of motion.dat and every STRIDE rows, COUNT in all, with the time in place of the
#       crank: places are those of motion_places.dat, or, without that table, of the motion computed once more
#   places.sh modes FOLDER TABLE SPEED MODES CRANKS SIZE BAR PARTS
#       as it swings in modes of shapes.dat and shape_pins.dat, what stands still, blocks, springs and joints: see mode_places.awk. MODES and CRANKS are lists
#       with commas; SIZE is the largest displacement drawn, BAR half the width of a bar, PARTS of the swing are drawn
#   places.sh four_bar FOLDER BLOCK ANGLES [points.dat or response.dat]
#       as rows of pins and points at some angles: see geometry.awk. ANGLES is a file, a position a line: the crank angle in degrees, then
#       the branch, open or crossed, if it is not the deck's
# FLEXMECH is the program, PLOTS the folder of the scripts.

set -u
kind=$1 folder=$2
shift 2
rm -rf "$folder"
mkdir "$folder" || exit 1

# place CARD…: the deck with these cards in place of its reports, and with a branch in place of its own.
place() {
    case $1 in BRANCH*) replaced='REPORT\|END\|BRANCH' ;; *) replaced='REPORT\|END' ;; esac
    { grep -v "^\($replaced\)" echo.deck; printf '%s\n' "$@"; } > "$folder/drawn.deck"
    "$FLEXMECH" --quiet --out "$folder" "$folder/drawn.deck" 2> "$folder/told" || [ $? -eq 1 ] || {
        cat "$folder/told" >&2
        exit 1
    }
}

ask() { awk -v want="$1" -f "$PLOTS/quoted.awk" -f "$PLOTS/tables.awk" < "$2"; }

bodies() { awk -v folder="$folder" "$@" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/shapes.awk"; }

geometry=$folder/drawn/geometry.dat
case $kind in
    range)
        # Of several drives with laws positions are instants.
        positions=crank
        [ "$(grep -ci '^DRIVE .* law=' echo.deck)" -lt 2 ] || positions=time
        place "$(awk -v low="$1" -v high="$2" -v count="$3" -v positions=$positions 'BEGIN {
            printf "REPORT geometry %s=", positions
            for (k = 0; k <= count; k++) printf "%s%.15g", (k ? "," : ""), low + (high - low)*k/count
        }')"
        bodies -v share="$4" < "$geometry" ;;
    motion)
        places=motion_places.dat
        if [ ! -f $places ]; then
            card=$(grep -i '^REPORT *motion' echo.deck)
            place "$card" "REPORT geometry $(printf '%s\n' "$card" | grep -io 'crank=[^ ]*' | head -n 1)"
            places=$folder/drawn/$places
        fi
        awk -v stride="$1" -v count="$2" '
            /^#/ || NF == 0 { next }
            $1 "" != time { time = $1 ""; instant++ }
            (instant - 1) % stride == 0 && instant <= stride * (count - 1) + 1' "$places" | bodies -v share="$3" ;;
    modes)
        place "$(ask 'distinct =crank' "$1" | sort -g | awk -v cranks="$4" '
            BEGIN { n = split(cranks, crank, ",") }
            {
                for (i = 1; i <= n; i++) if (($1 - crank[i])^2 <= 1e-18*(1 + crank[i]^2)) break
                if (i <= n) list = list (list == "" ? "" : ",") sprintf("%.15g", $1)
            }
            END { print "REPORT geometry crank=" list }')"
        awk -v folder="$folder" -v speed="$2" -v modes="$3" -v cranks="$4" -v size="$5" -v parts="$7" -f "$PLOTS/mode_places.awk" \
            "$geometry" "${1%shapes.dat}shape_pins.dat" "$1" | bodies -v bar="$6" || exit 1
        cat "$folder/modes" ;;
    four_bar)
        # The program takes an angle once: nearer to each other than it tells apart, they are one position.
        awk '{ printf "%.17g %s\n", $1 + 0, $2 == "" ? "-" : $2 }' "$2" > "$folder/asked"
        for branch in - open crossed; do
            awk -v branch=$branch '$2 == branch { print $1 }' "$folder/asked" | sort -g |
                awk '{ apart = ($1 < 0 ? -$1 : $1) + 1 } NR == 1 || $1 - kept > 2e-12*apart { kept = $1 } { print $1, kept }' \
                > "$folder/kept"
            [ -s "$folder/kept" ] || continue
            card="BRANCH $branch"
            [ $branch != - ] || card=
            place "$card" "REPORT geometry crank=$(cut -d' ' -f2 "$folder/kept" | uniq | paste -s -d, -)"
            sed "s/^/$branch /" "$folder/kept" >> "$folder/places"
            ask poses "$geometry" | sed "s/^/$branch /" >> "$folder/poses"
            ask 'distinct link' "$geometry" > "$folder/links"
            turns=0
            grep -q '^# limit positions of the crank: none$' "$geometry" && turns=1
            # Where two pins meet the linkage has no place of its own: it is drawn as it tends to be.
            sed -n 's/^# *failed crank=\([^ ]*\) .*/\1/p' "$geometry" > "$folder/failed"
            [ -s "$folder/failed" ] || continue
            place "$card" "REPORT geometry crank=$(awk '{ printf "%s%.17g", (NR > 1 ? "," : ""), $1 + 1e-6 }' "$folder/failed")"
            ask poses "$geometry" | sed 's/^[^ ]* //' | paste -d' ' "$folder/failed" - |
                awk -v branch=$branch 'NF > 1 { $1 = sprintf("%.17g", $1); print branch, $0 }' >> "$folder/poses"
        done
        [ -z "${3-}" ] || ask 'distinct point' "$3" | grep -v : > "$folder/points"
        [ -n "${3-}" ] || : > "$folder/points"
        echo "turns_fully = $turns"
        awk -v block="$1" -f "$PLOTS/quoted.awk" -f "$PLOTS/springs.awk" -f "$PLOTS/geometry.awk" \
            "$folder/links" "$folder/points" "$folder/places" "$folder/poses" "$folder/asked" ;;
esac
