#!/bin/sh
# Drawings of mechanisms: arrows as many as forces, labels that keep clear of each other, what an engineer would call a fault.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "drawings of mechanisms" "they are drawn from tables, which are the same in all builds"; exit ;;
esac

FLEXMECH=$program
export FLEXMECH

# A press with loads, in the units that are given; speed and angles are those of an ordinary deck.
press_deck() {
  cat <<END_OF_DECK
TITLE    A press for drawings
UNITS    $1
MATERIAL steel  E=200GPa density=7850kg/m3
SECTION  bar    rectangle thickness=8mm width=20mm
GROUND   O2  0 0
GROUND   O4  300mm 0
LINK     crank    O2 A  length=80mm   material=steel section=bar
LINK     coupler  A  B  length=280mm  material=steel section=bar
LINK     follower O4 B  length=220mm  material=steel section=bar
DRIVE    crank
POINT    tool_at_the_far_end_of_the_coupler coupler along=330mm offset=60mm
FORCE    B  -120N 40N
MESH     * elements=2
CRANK    0 to 360 step 15
SPEED    30 rad/s
INERTIA  lumped
EFFECTS  axial
MODES    2
REPORT   inertia
REPORT   mesh
REPORT   shapes crank=30,120,240
REPORT   points
REPORT   reactions
REPORT   linkage
END_OF_DECK
}

# draw DECK [OPTION...]: its figures as SVG.
draw() {
  drawn_deck=$1
  shift
  run 0 --quiet --out "$scratch/out" "$scratch/$drawn_deck.deck" || return 1
  timeout "$longest" sh plots/draw_figures.sh --format svg "$@" "$scratch/out/$drawn_deck" >"$scratch/stdout" 2>"$scratch/stderr" ||
    { echo "status $?; it said:"; cat "$scratch/stderr"; return 1; }
  silent
}

# shows CHECK FIGURE [ARGUMENT...]: see drawings.py.
shows() {
  check_name=$1
  figure=$2
  shift 2
  python3 tests/support/drawings.py "$check_name" "$scratch/out/press/figures/$figure.svg" "$@"
}

drawn() {
  press_deck "m kg s" >"$scratch/press.deck"
  draw press
}

# As large, as small, in other units: nothing is cut.
whole_in_units() {
  for units in "mm kg s" "mm tonne s" "in lbm s"; do
    press_deck "$units" >"$scratch/press.deck"
    draw press || return 1
    for file in "$scratch/out/press/figures/"*.svg; do
      case $file in
      *kinematics* | *reactions* | *harmonics* | *point_rates* | *frequenc*) continue ;;
      esac
      python3 tests/support/drawings.py whole "$file" || return 1
    done
  done
}

# Twenty labels for points close to each other: none over another, none over the curve, all inside the page.
labels_keep_clear() {
  awk 'BEGIN {
      print "page 0 400 0 400"
      for (k = 0; k <= 36; k++) print "curve", 200 + 60*cos(k*0.1745), 200 + 60*sin(k*0.1745)
      for (k = 0; k < 20; k++) print "label", 200 + 60*cos(k*0.314), 200 + 60*sin(k*0.314), 10, 40, 16, 45, k "°"
    }' | awk -f plots/labels.awk >"$scratch/labels"
  awk '
    { x[NR] = $1; y[NR] = $2 }
    $1 < 20 || $1 > 380 || $2 < 8 || $2 > 392 { print "outside: " $0 }
    END {
      if (NR != 20) print NR " labels"
      for (i = 1; i <= NR; i++) for (j = 1; j < i; j++)
        if ((x[i] - x[j])^2 < 1600 && (y[i] - y[j])^2 < 256) print i " and " j " overlap"
    }' "$scratch/labels" | head -n 3 | grep . && return 1
  return 0
}

check "drawings are drawn" drawn
check "the shaking force has angles, forces and smooth curves" shows shaking_force shaking_force 25
check "arrows of forces: pins times poses" shows forces forces 8
check "the wall turns with the crank" shows mode_shape mode_1_crank_30_speed_30 30 "A press for drawings"
check "the wall turns with the crank, on the left" shows mode_shape mode_2_crank_240_speed_30 240 "A press for drawings"
check "one arrow at one place" shows mechanism mechanism 5
check "paths lie above the bodies" shows coupler_curve coupler_curve
check "all modes on one page" shows modes modes 2 3
check "special positions in an engineer's words" shows special_positions special_positions
check "labels keep clear of each other" labels_keep_clear
check "drawings in three systems of units" whole_in_units
