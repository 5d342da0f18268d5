#!/bin/sh
# Branches of frequencies: every row has all of them, each once, with the frequencies of frequencies.dat.
. tests/scripts/functions.sh

# whole NAME MODES: at every speed and position as many rows as modes, no branch and no mode twice, likeness from 0 to 1, and the
# frequency that frequencies.dat has for the mode.
whole() {
  awk -v modes="$2" '/^#/ || !NF { next }
    FNR == NR { for (i = 1; i <= modes; i++) frequency[$1, $2, i] = $(2 + i); rows++; next }
    { if (seen["b", $1, $2, $3]++) { print "branch " $3 " twice at speed " $1 ", crank " $2; exit 1 }
      if (seen["m", $1, $2, $4]++) { print "mode " $4 " twice at speed " $1 ", crank " $2; exit 1 }
      if ($5 != frequency[$1, $2, $4]) { print "another frequency at speed " $1 ", crank " $2; exit 1 }
      if ($6 < 0 || $6 > 1) { print "mac " $6; exit 1 }
      found++ }
    END { if (found != modes*rows) { print found " rows for " modes " modes at " rows " positions"; exit 1 } }' \
    "$scratch/out/$1/frequencies.dat" "$scratch/out/$1/branches.dat"
}

# marks NAME: speed, crank, branch and event of every row with one, but for the starts
marks() {
  awk '!/^#/ && NF && $7 != "-" && $7 != "start" { printf "%g %g %d %s\n", $1, $2, $3, $7 }' "$scratch/out/$1/branches.dat"
}

# Veerings stand where shapes are exchanged, and nowhere else; no branch is lost on the way round.
veerings() {
  run 0 --quiet --out "$scratch/out" inputs/branches.deck && whole branches 6 || return 1
  marks branches >"$scratch/marks"
  printf '%s\n' "0 72 3 veering:4" "0 302 3 veering:4" "0 72 4 veering:3" "0 302 4 veering:3" "20 72 3 veering:4" \
    "20 302 3 veering:4" "20 72 4 veering:3" "20 302 4 veering:3" | diff - "$scratch/marks"
}

# From 0 to 360 degrees in steps of 90 and over three speeds: steps are cut until shapes are recognised.
long_steps() {
  sed 's/^CRANK.*/CRANK 0 to 360 step 90/; s/^SPEED.*/SPEED 0 40 100/' inputs/branches.deck >"$scratch/steps.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/steps.deck" && whole steps 6
}

# Near a dead point some rows need higher orders than others: their modes are recognised all the same.
several_orders() {
  { beam_deck "CRANK 0 to 360 step 5" "SPEED 30" "REPORT frequencies" "REPORT branches" |
    sed 's/length=100 /length=50 /; s/length=279.4/length=200/; s/length=266.7/length=104.001/; s/elements=2/accuracy=1e-3/; s/lumped/distributed/'
  } >"$scratch/orders.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/orders.deck" && whole orders 3
}

one_position() {
  beam_deck "CRANK 77" "MODES 1" "REPORT frequencies" "REPORT branches" >"$scratch/one.deck"
  run 0 --out "$scratch/out" "$scratch/one.deck" && silent && whole one 1
}

# Rows are followed in the order of their angles, however the deck lists them.
there_and_back() {
  sed 's/^CRANK.*/CRANK 40 to 100 step 2/; s/^SPEED.*/SPEED 0/' inputs/branches.deck >"$scratch/there.deck"
  sed 's/^CRANK.*/CRANK 100 to 40 step -2/; s/^SPEED.*/SPEED 0/' inputs/branches.deck >"$scratch/back.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/there.deck" "$scratch/back.deck" || return 1
  grep -v '^#' "$scratch/out/there/branches.dat" >"$scratch/there" && grep -v '^#' "$scratch/out/back/branches.dat" >"$scratch/back"
  diff "$scratch/there" "$scratch/back"
}

# A dead point is told where it is, and nobody says which branch goes on beyond it.
dead_point() {
  beam_deck "CRANK 30 170 180 190" "MODES 2" "REPORT frequencies" "REPORT branches" |
    sed 's/254 0/250 0/; s/length=279.4/length=250/; s/length=266.7/length=100/' >"$scratch/dead.deck"
  run 1 --quiet --out "$scratch/out" "$scratch/dead.deck" && whole dead 2 || return 1
  [ "$(grep -c '^# failed speed=0 crank=180' "$scratch/out/dead/branches.dat")" -eq 1 ] || { echo "the failed row is not reported once"; return 1; }
  awk '!/^#/ && NF && $2 == 190 { print $3, $7 }' "$scratch/out/dead/branches.dat" >"$scratch/beyond"
  printf '3 start\n4 start\n' | diff - "$scratch/beyond"
}

check "veerings of the second mechanism" veerings
check "branches over long steps" long_steps
check "branches through rows of several orders" several_orders
check "branches of one position" one_position
check "branches do not depend on the order of the deck's list" there_and_back
check "branches beyond a dead point" dead_point
