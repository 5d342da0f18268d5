#!/bin/sh
# Figures of small and large values, in several units, with long names, and of several sizes: no word leaves its page, and
# on a page of curves none lies on another. Asserted from SVGs, which say where every text is.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "extents of figures" "they are drawn from tables, which are the same in all builds"; exit ;;
esac

long=a_name_of_more_than_sixty_letters_as_drawing_offices_give_them
title="A title that goes on and on, with the number of the drawing, its date, the customer, the machine, the station in the \
machine, the name of who drew it, the name of who checked it, and what was changed since the last time it was issued"

# rigid_deck UNITS...: all reports of rigid dynamics.
rigid_deck() {
  sed "s/^TITLE .*/TITLE $title/; s/^UNITS .*/UNITS $*/; s/^GRAVITY .*/GRAVITY 0 -9.81m\/s2/; s/^CRANK .*/CRANK 0 to 360 step 10/
    s/^SPEED .*/SPEED 0 31.4159265359 rad\/s/; s/pusher/${long}_1/; s/eye/${long}_2/; s/\brocker\b/${long}_r/; /^END/d" inputs/rigid.deck
}

# beams_deck UNITS...: all reports of vibration.
beams_deck() {
  beam_deck "CRANK 0 to 360 step 15" "SPEED 0 10 20" "MODES 5" "REPORT frequencies" "REPORT branches" "REPORT mesh" \
    "REPORT inertia" "REPORT kinematics" "REPORT shapes crank=60 speed=20" |
    sed "s/UNITS .*/UNITS $*/; s/E=200000 density=7.8e-9/E=200GPa density=7800kg\/m3/; s/ 254 0/ 254mm 0/
      s/\(length\|thickness\|width\)=\([0-9.]*\)/&mm/"
}

# varied_deck UNITS...
varied_deck() {
  beams_deck "$@" | sed "/^REPORT/d; s/^SPEED.*/SPEED 10/; s/^MODES.*/MODES 3/; s/length=279.4mm/length=\$$long/"
  echo "VARY $long 270 to 290 step 5 mm"
  echo "VARY b 250 260 mm"
  echo "REPORT frequencies"
} 

# response_deck UNITS...: all reports of the elastic response.
response_deck() {
  sed "s/^TITLE .*/TITLE $title/; s/^UNITS .*/UNITS $*/; s/E=200000 density=7.8e-9/E=200GPa density=7800kg\/m3/; s/ 254 0/ 254mm 0/
      s/\(length\|thickness\|width\|at\|along\|offset\)=\([0-9.]*\)/&mm/g; s/^CRANK .*/CRANK 0 to 360 step 15/; s/^SPEED.*/SPEED 95 190 rpm/
      s/mid_coupler/${long}_g/; s/^POINT    P /POINT ${long}_p /; s/ accuracy=1e-8//; /^END/d" inputs/response.deck
  printf '%s\n' 'MODES 2' 'INERTIA distributed' 'REPORT frequencies'
}

# whole FOLDER OPTION...: its figures are drawn, and nothing is cut.
whole() {
  folder=$1
  shift
  sh plots/draw_figures.sh --format svg "$@" "$folder" >"$scratch/drawn" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  silent && python3 -B tests/support/figure_extents.py check "$folder"/figures/*.svg
}

# Sets of units, every value as it is.
in_units() {
  name=$1
  shift
  mkdir -p "$scratch/$name"
  rigid_deck "$@" >"$scratch/$name/rigid.deck"
  beams_deck "$@" >"$scratch/$name/beams.deck"
  response_deck "$@" >"$scratch/$name/response.deck"
  varied_deck "$@" | sed "s/length=266.7mm/length=\$b/" >"$scratch/$name/varied.deck"
  run 0 --quiet --out "$scratch/$name" "$scratch/$name/rigid.deck" "$scratch/$name/beams.deck" "$scratch/$name/varied.deck" \
    "$scratch/$name/response.deck" || return 1
  for deck in rigid beams varied response; do
    whole "$scratch/$name/$deck" --errors || return 1
  done
}

# Placed by the program, a linkage has its own size: drawings of it are left out.
multiplied() {
  for deck in rigid beams varied response; do
    rm -rf "$scratch/times"
    python3 -B tests/support/figure_extents.py scale "$1" "$scratch/mm_kg_s/$deck" "$scratch/times" || return 1
    rm -f "$scratch/times/points.dat" "$scratch/times/linkage.dat"
    whole "$scratch/times" || return 1
  done
}

sized() {
  for deck in rigid beams varied response; do
    whole "$scratch/mm_kg_s/$deck" --size "$@" || return 1
  done
}

# Names of many links beside panels that are low; mode shapes of several positions, blocks and guides.
other_linkages() {
  run 0 --quiet --out "$scratch/others" inputs/jansen.deck inputs/toggle_press.deck inputs/squeezer.deck \
    inputs/bending_quick_return.deck || return 1
  for deck in jansen toggle_press squeezer bending_quick_return; do
    whole "$scratch/others/$deck" && whole "$scratch/others/$deck" --size 90x60mm || return 1
  done
}

# The check sees what it is for.
seen() {
  svg='<svg viewBox="0 0 200 100" xmlns="http://www.w3.org/2000/svg">'
  place='<g transform="translate(50,50)" font-size="20" text-anchor="middle"><text>seven</text></g>'
  for other in "$(echo "$place" | sed 's/(50/(20/')" "$(echo "$place" | sed 's/middle/end/')" "$place" \
    "$(echo "$place" | sed 's/50,50)/100,20) rotate(-90)/')" "$(echo "$place" | sed 's/50,50/100,99/; s/seven/2e+05/')"; do
    printf '%s\n' "$svg$place$other</svg>" >"$scratch/seen.svg"
    python3 -B tests/support/figure_extents.py check "$scratch/seen.svg" >"$scratch/stdout" && { echo "it sees no fault in $other"; return 1; }
  done
  printf '%s\n' "$svg$place</svg>" >"$scratch/seen.svg"
  python3 -B tests/support/figure_extents.py check "$scratch/seen.svg"
}

check "extents of figures are measured" seen
check "extents of figures in mm kg s" in_units mm_kg_s mm kg s
check "extents of figures in m kg s" in_units m_kg_s m kg s
check "extents of figures in in lbm s" in_units in_lbm_s in lbm s
check "extents of figures of millionths" multiplied 1e-6
check "extents of figures of millions" multiplied 1e6
check "extents of small figures" sized 90x60mm
check "extents of wide figures" sized 1600x500
check "extents of figures of other linkages" other_linkages
check "extents of bare figures" sized 600x600 --no-titles
