#!/bin/sh
# Strong intervals of instability of a slider-crank with an elastic rod, against Hill's equation; vibrations that change numbers.
. tests/scripts/functions.sh

# Outside the interval another vibration is between the two that meet: with MODES 2 they are found as with MODES 3.
renumbered() {
  run 0 --quiet --out "$scratch/renumbered" tests/intervals/renumbered.deck || return 1
  awk '!/^#/ && NF {printf "%.5f %.5f %s %s %.5f ", $1, $2, $3, $4, $5}' "$scratch/renumbered/renumbered/intervals.dat" >"$scratch/rows"
  [ "$(cat "$scratch/rows")" = "-1.45367 -1.45322 combination 1+2 0.01616 " ] || { cat "$scratch/rows"; return 1; }
}

check "two vibrations that are modes 1 and 2 only where they meet are found" renumbered
python3 -B tests/intervals/rod.py "$program" "$scratch"
