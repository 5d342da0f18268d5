#!/bin/sh
# REPORT reactions, points and lagrange, from deck to tables.
. tests/scripts/functions.sh

deck=$scratch/rigid.deck
out=$scratch/out/rigid
cat >"$deck" <<'END_OF_DECK'
TITLE    A crank-rocker with a coupler of its own shape
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  bar rectangle thickness=10 width=25.4
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank    O2 A length=100 material=steel section=bar
LINK     coupler  A  B rigid length=279.4 mass=0.5kg inertia=3000kg*mm2 center=100,40
LINK     follower O4 B length=266.7 material=steel section=bar
DRIVE    crank
PINMASS  A 42g
MASS     follower at=100 offset=-10 0.1kg
POINT    P coupler along=120 offset=-80
POINT    A2 crank along=100
GRAVITY  0 -9810
FORCE    B 10 -5
TORQUE   follower 200
CRANK    0 to 360 step 15
SPEED    0 12 alpha=20
INERTIA  distributed
REPORT   kinematics
REPORT   inertia
REPORT   reactions
REPORT   points
REPORT   lagrange
END_OF_DECK

# columns TABLE COLUMN...: of all rows.
columns() {
  table=$1
  shift
  awk -v list="$*" 'BEGIN { n = split(list, c, " ") } /^#/ || !NF { next } { for (i = 1; i <= n; i++) printf "%s ", $c[i]; print "" }' "$table"
}

files() {
  run 0 --quiet --out "$scratch/out" "$deck" || return 1
  for table in kinematics inertia reactions points lagrange; do
    [ -s "$out/$table.dat" ] || { echo "no $table.dat"; return 1; }
  done
  [ "$(columns "$out/reactions.dat" 1 | wc -l)" -eq 50 ] && [ "$(columns "$out/lagrange.dat" 1 | wc -l)" -eq 50 ] &&
    [ "$(columns "$out/points.dat" 1 | wc -l)" -eq 100 ] || { echo "wrong number of rows"; return 1; }
}

# torques: those of the forces and of the energies, to 1e-12 of the largest term.
torques() {
  columns "$out/reactions.dat" 1 2 15 >"$scratch/forces"
  columns "$out/lagrange.dat" 1 2 8 5 6 7 >"$scratch/energies"
  paste -d " " "$scratch/forces" "$scratch/energies" | awk '
    function size(x) { return x < 0 ? -x : x }
    { if ($1 != $4 || $2 != $5) { print "rows of other places"; exit failed = 1 }
      if (size($3 - $6) > worst) worst = size($3 - $6)
      for (i = 6; i <= 9; i++) if (size($i) > most) most = size($i) }
    END { if (!failed && !(most > 100 && worst <= 1e-12 * most)) { print worst " of " most; failed = 1 }; exit failed }'
}

# shaking: the sum of the forces in inertia.dat, position by position.
shaking() {
  columns "$out/inertia.dat" 1 2 9 10 | awk '
    { place = $1 " " $2; if (place != last) { n++; last = place }; x[n] += $3; y[n] += $4 }
    END { for (i = 1; i <= n; i++) printf "%.17g %.17g\n", x[i], y[i] }' >"$scratch/sums"
  columns "$out/reactions.dat" 16 17 | paste -d " " - "$scratch/sums" | awk '
    { d = ($1 - $3)^2 + ($2 - $4)^2; if (d > worst) worst = d; m = $1^2 + $2^2; if (m > most) most = m; n++ }
    END { if (n != 50 || !(most > 0.01 && worst <= 1e-24 * most)) { print n " rows, " sqrt(worst) " of " sqrt(most); exit 1 } }'
}

# points: A2 lies where kinematics.dat has pin A.
points() {
  awk '$3 == "A2" { print $1, $2, $4, $5 }' "$out/points.dat" >"$scratch/points"
  columns "$out/kinematics.dat" 1 2 9 10 | paste -d " " - "$scratch/points" | awk '
    { if ($1 != $5 || $2 != $6 || ($3 - $7)^2 + ($4 - $8)^2 > 1e-22) { print "row " NR ": " $0; failed = 1; exit 1 } }
    END { if (!failed && NR != 50) { print NR " rows"; exit 1 } }'
}

# again: the echo gives the same tables.
again() {
  mkdir -p "$scratch/echo" && cp "$out/echo.deck" "$scratch/echo/rigid.deck"
  run 0 --quiet --out "$scratch/echo/out" "$scratch/echo/rigid.deck" || return 1
  for table in inertia reactions points lagrange; do
    cmp "$out/$table.dat" "$scratch/echo/out/rigid/$table.dat" || return 1
  done
}

# varied: tables of a deck with VARY have a column for what varies, and the loads of each variant in remarks.
varied() {
  sed -e 's/^GRAVITY.*/VARY g 0 9810\nGRAVITY 0 $g/' -e 's/step 15/step 90/' "$deck" >"$scratch/varied.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/varied.deck" || return 1
  grep -q '^# gravity: none' "$scratch/out/varied/reactions.dat" && grep -q '^# gravity: 0 9810 mm/s2' "$scratch/out/varied/lagrange.dat" ||
    { echo "no remark on gravity"; return 1; }
  [ "$(columns "$scratch/out/varied/reactions.dat" 19 | wc -l)" -eq 20 ] || { echo "wrong number of rows"; return 1; }
}

check "reports reactions, points and lagrange are written" files
check "torque of forces and of energies" torques
check "shaking force is the sum of inertia forces" shaking
check "a point at a pin moves with it" points
check "the echo gives the same forces and energies" again
check "forces and energies of variants" varied
