#!/bin/sh
# Motions in time: open chains, warnings, strains where they are asked for, the row at the end, laws.
. tests/scripts/functions.sh

# arm SECTION CARD...: a clamped arm of two parts
arm() {
  section=$1
  shift
  printf '%s\n' "UNITS m kg s" "MATERIAL steel E=2e11 density=7800" "SECTION thin $section" "GROUND O 0 0" \
    "LINK arm O A B lengths=1,1 turns=45 material=steel section=thin" "DAMPING * time=1e-4" "$@" END >"$scratch/arm.deck"
}

# rows: of transient.dat
rows() {
  grep -v '^#' "$scratch/out/arm/transient.dat"
}

# Slopes of what is constant along an open chain are rounding, not harmonics of a dead point; nobody asked for strains.
open_chain() {
  arm "rectangle thickness=0.01 width=0.02" "DRIVE arm" "SPEED 10 rad/s ramp=0.3" "REPORT transient turns=1"
  run 0 --out "$scratch/out" "$scratch/arm.deck" && says "link 'arm' deflects by" || return 1
  [ "$(rows | wc -l)" -gt 100 ] || { echo "no rows"; return 1; }
  absent "$scratch/out/arm/gauges.dat"
}

# A drive between two links that stands still welds them: the same motion as of one link.
driven_chain() {
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm" "SPEED 4 rad/s ramp=0.3" "REPORT transient turns=0.2 accuracy=1e-5"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  rows | awk '$4 ~ /^B/ {print $5, $6}' >"$scratch/welded"
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm" "DRIVE fore against arm at=45deg" "SPEED 4 rad/s ramp=0.3" \
    "LINK fore A B length=1 material=steel section=thin" "REPORT transient turns=0.2 accuracy=1e-5"
  sed -i 's/^LINK arm .*/LINK arm O A length=1 material=steel section=thin/' "$scratch/arm.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  rows | awk '$4 ~ /^B/ {print $5, $6}' | paste - "$scratch/welded" |
    awk '{d = ($1 - $3)^2 + ($2 - $4)^2; if (d > most) most = d; s = $3^2 + $4^2; if (s > size) size = s}
      END {print "apart by", sqrt(most/size); exit !(NR > 10 && size > 0 && most <= 4e-10*size)}' >"$scratch/apart" || { cat "$scratch/apart"; return 1; }
}

# 0.63 m of a beam of 10 m.
large_deflection() {
  arm "rectangle thickness=0.08 width=0.02" "DRIVE arm" "SPEED 1 rad/s ramp=0.3" "REPORT transient turns=0.1"
  sed -i 's/lengths=1,1/lengths=5,5/' "$scratch/arm.deck"
  run 0 --out "$scratch/out" "$scratch/arm.deck" && says "in the motion in time at speed 1 rad/s link 'arm' deflects by" &&
    says "above 1 % the linear equations become unreliable"
}

# Depths are for strains, and of the links that have gauges.
depths() {
  arm "general A=2e-4 I=1.67e-9" "DRIVE arm" "SPEED 1 rad/s ramp=0.3" "REPORT transient turns=0.1"
  run 0 --out "$scratch/out" "$scratch/arm.deck" && absent "$scratch/out/arm/gauges.dat" || return 1
  sed -i 's/^DRIVE/GAUGE g arm at=0.5\n&/' "$scratch/arm.deck"
  run 2 --out "$scratch/out" "$scratch/arm.deck" && says "section 'thin' has no depth" || return 1
  sed -i 's/^SECTION .*/& depth=0.01/' "$scratch/arm.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" && [ -s "$scratch/out/arm/gauges.dat" ]
}

# The last row is at the end: 0.1 turns take 0.15 + 0.2 pi s at 1 rad/s after a ramp of 0.3 s.
last_row() {
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm" "SPEED 1 rad/s ramp=0.3" "REPORT transient turns=0.1"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  rows | tail -n 1 | awk '{d = $2 - 0.15 - 0.2*3.141592653589793; exit !(d < 1e-12 && d > -1e-12 && $3 > 36 - 1e-9 && $3 < 36 + 1e-9)}' ||
    { echo "it ends at $(rows | tail -n 1 | cut -c1-80)"; return 1; }
}

# The first half of a parabola is a ramp of constant acceleration.
law_as_ramp() {
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm" "SPEED 2 rad/s ramp=0.4" "REPORT transient turns=0.0636619772367581 instants=314 accuracy=1e-7"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  rows | awk '$4 ~ /^B/ {print $2, $5, $6, $8}' | tail -n 1 >"$scratch/ramp"
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm law=go" "LAW go parabolic from=0 to=0.8rad start=0 stop=0.8s" \
    "TIME 0 to 0.4 step 0.01" "REPORT transient accuracy=1e-7"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  rows | awk '$4 ~ /^B/ {print $2, $5, $6, $8}' | tail -n 1 | cat "$scratch/ramp" - |
    awk '{t[NR] = $1; x[NR] = $2; y[NR] = $3; e += $4}
      END {d = sqrt((x[1] - x[2])^2 + (y[1] - y[2])^2)/sqrt(x[1]^2 + y[1]^2); print "times", t[1], t[2], "differ by", d, "errors", e
        exit !(d < 2*e && e < 1e-6 && t[1] - t[2] < 1e-9 && t[2] - t[1] < 1e-9)}' >"$scratch/difference" || { cat "$scratch/difference"; return 1; }
}

# Gravity strikes an arm along its axis, which vibrates at 3 kHz for ever. Steps for the bending let that fade: an axial strain of
# -1.3557e-7, as at rest, with an error of 9e-5.
axial_vibration() {
  cat >"$scratch/arm.deck" <<DECK
UNITS    mm kg s speed=rad/s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  thin rectangle thickness=7.6 width=20
GRAVITY  -9.81m/s2 0.5m/s2
GROUND   O2 0 0
LINK     crank O2 A length=300 material=steel section=thin
PINMASS  A 0.1
DRIVE    crank law=go
GAUGE    g crank at=30
LAW      go polynomial_345 from=0deg to=30deg start=0.2s stop=0.5s
TIME     0 to 0.5 step 0.02
REPORT   transient accuracy=1e-2
DECK
  run 1 --quiet --out "$scratch/out" "$scratch/arm.deck" && says "the accuracy asked for, 0.01, is not reached: the error of strains"
}

# The speed of the crank changes from row to row: it is one motion all the same.
one_figure() {
  command -v gnuplot >/dev/null || return 0
  arm "rectangle thickness=0.02 width=0.02" "DRIVE arm law=go" "LAW go parabolic from=0 to=0.8rad start=0 stop=0.8s" \
    "TIME 0 to 0.4 step 0.05" "REPORT transient"
  run 0 --quiet --out "$scratch/out" "$scratch/arm.deck" || return 1
  plots/flexmech-plot "$scratch/out/arm" >"$scratch/drawn" 2>&1 || { cat "$scratch/drawn"; return 1; }
  [ "$(ls "$scratch/out/arm/figures" | grep -c 'transient.*png')" -eq 1 ] || { ls "$scratch/out/arm/figures"; return 1; }
}

check "an axial vibration" axial_vibration
check "a motion of an open chain" open_chain
check "a motion of a chain of driven links" driven_chain
check "a motion with large deflections" large_deflection
check "depths of sections where strains are asked for" depths
check "the row at the end of a motion" last_row
check "a motion by a law" law_as_ramp
check "one figure of a motion by a law" one_figure
python3 -B tests/linkages/transient_checks.py --program "$program" --scratch "$scratch" 2>&1
