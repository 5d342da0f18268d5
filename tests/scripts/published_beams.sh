#!/bin/sh
# The published beams of docs/verification.md: what is written there is what the program finds, and that is what was published.
. tests/scripts/functions.sh

out=$scratch/out

# table HEADING: the rows of the table below this heading line, cells separated by blanks; empty cells are -
table() {
  awk -v heading="$1" 'index($0, heading) == 1 { on = 1; getline; next } on && !/^\|/ { exit }
    on { n = split($0, cell, "|"); line = ""
      for (i = 2; i < n; i++) {
        gsub(/^ +| +$/, "", cell[i])
        gsub(/ /, "_", cell[i])
        line = line (cell[i] == "" ? "-" : cell[i]) " "
      }
      print line }' docs/verification.md
}

# At both crank angles: the rest of the linkage does not matter.
rotating() {
  run 0 --out "$out" inputs/rotating.deck && silent || return 1
  table '| η | ω1 published' >"$scratch/rotating"
  [ "$(wc -l <"$scratch/rotating")" -eq 6 ] || { echo "the table of docs/verification.md has other rows"; return 1; }
  awk 'function off(a, b) { return a > b ? a - b : b - a }
    NR == FNR { for (i = 2; i <= 5; i++) written[$1 + 0, i] = $i; next }
    /^ / { rows++
      for (i = 3; i <= 5; i++) {
        if (!(($1, i) in first)) first[$1, i] = $i
        if (off($i, first[$1, i]) > 1e-12*$i) print "speed", $1, "column", i, "depends on the crank angle"
      }
      for (i = 1; i <= 3; i++) {
        omega = 6.283185307179586*$(i + 2)
        if (off(omega, written[$1 + 0, i + 2]) > 0.51e-6) print "speed", $1, "mode", i, omega, "is not", written[$1 + 0, i + 2]
      }
      if (off(6.283185307179586*$3, written[$1 + 0, 2]) > 0.51e-4) print "speed", $1, "is not", written[$1 + 0, 2], "as published" }
    END { if (rows != 12) print rows, "rows" }' "$scratch/rotating" "$out/rotating/frequencies.dat" >"$scratch/differences"
  [ ! -s "$scratch/differences" ] || { cat "$scratch/differences"; return 1; }
}

# The roots of the determinant of a beam on two pins, and of a rod held at one end.
deep_beam() {
  run 0 --out "$out" inputs/deep_beam.deck && silent || return 1
  table '| mode | closed form' >"$scratch/deep_beam"
  awk 'function off(a, b) { return a > b ? a - b : b - a }
    function bending(n,    k, G, q, mass, turning, shear, a, b) {
      k = 13/15.3; G = 200e9/2.6; q = n*atan2(0, -1)/10; mass = 8000*4; turning = 8000*16/12; shear = k*G*4
      a = turning*mass/shear; b = mass + (turning + 200e9*16/12*mass/shear)*q^2
      return sqrt((b - sqrt(b^2 - 4*a*200e9*16/12*q^4))/(2*a))/(2*atan2(0, -1)) }
    NR == FNR { row++; closed[row] = $2; old[row] = $3; new[row] = $4; written[row] = $5; next }
    /^ / { rows++
      exact[1] = bending(1); exact[2] = 125; exact[3] = bending(2); exact[4] = bending(3); exact[5] = 375
      for (i = 1; i <= 5; i++) {
        f = $(i + 2)
        if (off(f, exact[i]) > 1e-12*f) printf "f%d = %.12g is not %.12g\n", i, f, exact[i]
        if (off(f, closed[i]) > 0.51e-6 || off(f, written[i]) > 0.51e-6) print "f" i, f, "is not", closed[i], written[i]
        if (old[i] != "-" && off(f, old[i]) > 0.0052) print "f" i, f, "is not", old[i], "as published"
        if (new[i] != "-" && off(f, new[i]) > 4e-3*f) print "f" i, f, "is not near", new[i] } }
    END { if (row != 5 || rows != 1) print row, "rows of the document,", rows, "of the table" }' \
    "$scratch/deep_beam" "$out/deep_beam/frequencies.dat" >"$scratch/differences"
  [ ! -s "$scratch/differences" ] || { cat "$scratch/differences"; return 1; }
}

check "the rotating cantilever of Wright and others" rotating
check "the deep beam FV5 of NAFEMS" deep_beam
