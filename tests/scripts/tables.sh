#!/bin/sh
# The form of the tables, for every deck in inputs/.
. tests/scripts/functions.sh

# form TABLE: the last lines of the head are names and units, every row has as many columns, and no number is none.
form() {
  awk 'function fail(why) { print FILENAME ":" FNR ": " why; failed = 1; exit 1 }
    /^# failed / { if (!columns) columns = words; next }
    /^#/ && !rows { names = units; words = last; units = $0; last = NF - 1; next }
    /^$/ || /^#/ { next }  # Behind the head: remarks of later variants.
    { if (!rows++ && words != last) fail("the columns have not as many units as names")
      if (NF != last) fail(NF " columns, not " last)
      if (tolower($0) ~ /nan|inf|\*/) fail("no number") }
    END { if (!failed && !rows) { print FILENAME ": no rows"; exit 1 } }' "$1"
}

# Where 0 and 360 degrees, or a longer period, are both there: computed once, so their rows differ in nothing but the angle, which is
# the position of a drive too.
full_turn() {
  awk -v period="${2:-360}" '/^#/ { for (i = 2; i <= NF; i++) if ($i == "position") position = i - 1 }
    /^#/ || !NF { next }
    { angle = $2; first = $1; $1 = $2 = ""; if (position) $position = ""; rest = $0 }
    angle == 0 { row[first] = row[first] rest "\n"; zeros++ }
    angle == period { again[first] = again[first] rest "\n"; turns++ }
    END { if (!turns) exit 0
      if (zeros != turns) { print zeros " rows at 0, " turns " at " period; exit 1 }
      for (first in row) if (row[first] != again[first]) { print "the rows at 0 and " period " degrees differ"; exit 1 } }' "$1"
}

case $program in
*/release/*)
  for deck in $(quick_inputs); do
    base=$(basename "$deck" .deck)
    # The program may say that some rows failed; that is not what is looked at here.
    "$program" --quiet --out "$scratch" "$deck" 2>/dev/null
    for table in "$scratch/$base"/*.dat; do
      name=$base/$(basename "$table")
      check "form of $name" form "$table"
      case $name in
        */mesh.dat | */branches.dat) ;; # in branches a row depends on the one before
        gas_engine/*) check "0 and 720 degrees in $name" full_turn "$table" 720 ;;
        *) check "0 and 360 degrees in $name" full_turn "$table" ;;
      esac
    done
  done ;;
*) skip "tables of inputs/" "they are compared with those kept in this build" ;;
esac

# head_of REPORT COLUMNS [TABLE]: of its first table, or of another one.
head_of() {
  table=$scratch/$1/${3:-$1}.dat
  beam_deck "CRANK 0 to 360 step 60" "SPEED 0 10" "MODES 4" "REPORT $1" >"$scratch/$1.deck"
  run 0 --out "$scratch" "$scratch/$1.deck" && form "$table" || return 1
  found=$(grep '^#' "$table" | tail -n 2 | head -n 1 | sed 's/^# *//; s/  */ /g')
  [ "$found" = "$2" ] || { echo "columns are $found"; return 1; }
}

check "columns of kinematics.dat" head_of kinematics \
  "speed crank theta3 theta4 omega3 omega4 alpha3 alpha4 Ax Ay Bx By transmission_angle"
check "columns of inertia.dat" head_of inertia "speed crank mass link x y ax ay Fx Fy m"
check "columns of mesh.dat" head_of mesh "crank link element node_a node_b xa ya xb yb mass_a mass_b"
check "columns of frequencies.dat" head_of frequencies "speed crank f1 f2 f3 f4 error1 error2 error3 error4"
check "columns of shapes.dat" head_of shapes "speed crank mode frequency link s x y ux uy rotation"
check "columns of linkage.dat" head_of linkage "branch event crank theta3 theta4 transmission_angle"
check "columns of balance.dat" head_of balance "speed crank xG yG shaking_x shaking_y shaking_moment torque \
balanced_x balanced_y balanced_moment balanced_torque"
check "columns of harmonics.dat" head_of balance "speed linkage quantity largest rms mean h1 h2 h3 h4 h5 h6 h7 h8 h9 h10 \
phase1 phase2 phase3 phase4 phase5 phase6 phase7 phase8 phase9 phase10" harmonics

# What a linkage can do at all takes no positions, masses or speeds; with VARY a linkage after the other.
without_positions() {
  printf '%s\n' "UNITS mm kg s" "VARY r 90 to 110 step 10" "GROUND O2 0 0" "GROUND O4 254 0" 'LINK crank O2 A length=$r' \
    "LINK coupler A B length=279.4" "LINK follower O4 B length=266.7" "DRIVE crank" "REPORT linkage" >"$scratch/linkage_only.deck"
  run 0 --out "$scratch" "$scratch/linkage_only.deck" || return 1
  rows=$(grep -c '^ ' "$scratch/linkage_only/linkage.dat")
  [ "$rows" -eq 24 ] || { echo "$rows rows, not 24"; return 1; }
  [ "$(grep -c '^# open branch: link crank turns fully' "$scratch/linkage_only/linkage.dat")" -eq 3 ] ||
    echo "the ranges of every variant should be there"
}
check "linkage.dat of variants without positions" without_positions
