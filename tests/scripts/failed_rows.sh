#!/bin/sh
# Positions that cannot be computed: status 1, the rest is written, and the tables keep their blocks.
. tests/scripts/functions.sh

deck=$scratch/change.deck
out=$scratch/out/change
# A parallelogram: at 0 and 180 degrees all links lie on one line.
cat >"$deck" <<'END_OF_DECK'
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  strip rectangle thickness=1 width=10
GROUND   O2 0 0
GROUND   O4 100 0
LINK     a O2 A length=50  material=steel section=strip
LINK     b A  B length=100 material=steel section=strip
LINK     c O4 B length=50  material=steel section=strip
DRIVE    a
MESH     * elements=2
CRANK    0 360 720 30 90 180 540 200 -180
SPEED    0 1 2
INERTIA  lumped
REPORT   kinematics
REPORT   frequencies
REPORT   inertia
REPORT   shapes points=3
REPORT   mesh
END_OF_DECK

# status: every failed angle is told, the log lists them, nothing else is missing.
status() {
  run 1 --out "$scratch/out" "$deck" || return 1
  for angles in "0 to 720 deg, 3 positions" "180 to 540 deg, 2 positions" "-180 deg"; do
    says "change.deck: error: crank $angles: change point" && grep -q "^crank $angles: change point" "$out/run.log" || return 1
  done
  for table in kinematics frequencies; do
    for angle in 0 360 720 180 540 -180; do
      [ "$(grep -c "^# failed speed=1 crank=$angle : change point" "$out/$table.dat")" -eq 1 ] || { echo "$table.dat reports no failed row"; return 1; }
    done
    [ "$(grep -vc -e '^#' -e '^$' "$out/$table.dat")" -eq 9 ] || { echo "$table.dat: wrong number of rows"; return 1; }
  done
}

# blocks TABLE: as gnuplot reads it, to which comments are nothing: two empty lines begin a block, a block a speed.
# Neither failed rows in a run nor those at an end of a block make one more. To the eye it is never more than two lines.
blocks() {
  awk '/^#/ { lines = 0; next }
    /^$/ { empty++; if (++lines > 2) { print "three empty lines, line", NR; failed = 1 }; next }
    { if (rows++ && empty >= 2) blocks++; empty = lines = 0 }
    END { if (blocks != 2) { print blocks + 1, "blocks"; failed = 1 }; if (lines == 2) { print "empty lines at the end"; failed = 1 }
      exit failed }' "$out/$1.dat"
}

check "failed rows are reported and the rest is written" status
for table in kinematics frequencies inertia; do
  check "blocks of $table.dat with failed rows" blocks $table
done
check "--quiet still reports failed rows" eval 'run 1 --quiet --out "$scratch/out" "$deck" && says "crank 0 to 720 deg, 3 positions: change point"'

# A follower two kilometres thick: of the mass matrix nothing but rounding is left at many a position.
sed -e 's/circle *diameter=[0-9.]*/circle diameter=2019543.21/' -e 's/step 15/step 30/' inputs/thick.deck >"$scratch/absurd.deck"
absurd() {
  run 1 --out "$scratch/out" "$scratch/absurd.deck" && says "error: speed 0 rad/s, crank" || return 1
  ! grep -qi "nan\|inf" "$scratch/out/absurd/frequencies.dat" || { echo "not a number in the table"; return 1; }
}
check "masses lost to rounding give failed rows" absurd

# A force beyond all mechanics: waves so short that their number is too large for an integer.
cat >"$scratch/force.deck" <<'END_OF_DECK'
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  bar rectangle thickness=3 width=25.4
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank    O2 A length=100   material=steel section=bar
LINK     coupler  A  B length=279.4 material=steel section=bar
LINK     follower O4 B length=266.7 material=steel section=bar
DRIVE    crank
FORCE    B 1e20 1e20
MESH     * elements=3
CRANK    0
SPEED    0
INERTIA  distributed
MODES    3
REPORT   frequencies
END_OF_DECK
crushed() {
  run 1 --out "$scratch/out" "$scratch/force.deck" && says "error: speed 0 rad/s, crank 0 deg"
}
check "a force that crushes all links gives failed rows" crushed

# Bars soft in shear, pressed down at B: at 30 and 60 degrees by more than the follower's kGA.
crushed_deck() {
  cat <<END_OF_DECK
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3 nu=0.3
SECTION  soft rectangle thickness=20 width=20 shear_coefficient=0.01
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank    O2 A length=100   material=steel section=soft
LINK     coupler  A  B length=279.4 material=steel section=soft
LINK     follower O4 B length=266.7 material=steel section=soft
DRIVE    crank
FORCE    B 0 -300000
EFFECTS  axial rotary shear
MESH     * $1
CRANK    0 30 60 90
INERTIA  distributed
SOLVER   $2
REPORT   frequencies
REPORT   shapes points=2
END_OF_DECK
}
above_shear_stiffness() {
  crushed_deck "$1" "$2" >"$scratch/crushed.deck"
  run 1 --out "$scratch/out" "$scratch/crushed.deck" || return 1
  why=": link 'follower': the compression, 309749 N, exceeds the shear stiffness kGA, 307692 N: no lowest frequency exists"
  says "crushed.deck: error: speed 0 rad/s, crank 60 deg$why" && says "crank 30 deg: link 'follower': " || return 1
  for table in frequencies shapes; do
    grep -q "^# failed speed=0 crank=60 $why" "$scratch/out/crushed/$table.dat" || { echo "$table.dat does not say why"; return 1; }
  done
  [ "$(grep -vc -e '^#' -e '^$' "$scratch/out/crushed/frequencies.dat")" -eq 2 ] || { echo "wrong number of rows"; return 1; }
}
check "a compression above kGA gives a failed row" above_shear_stiffness accuracy=1e-8 auto
check "a compression above kGA on a mesh" above_shear_stiffness elements=2 auto
check "a compression above kGA on band matrices" above_shear_stiffness elements=50 auto
check "a compression above kGA by a nodal solver" above_shear_stiffness elements=2 dense

# A block that leaves its link: told before the run with the interval, in failed rows, where the crank's range ends, and in a motion.
leaving_block() {
  printf '%s\n' "UNITS mm kg s" "GROUND O2 0 0" "GROUND O4 0 -150" "LINK crank O2 A length=60 mass=1 inertia=500" \
    "LINK lever O4 C length=200 mass=1 inertia=5000" "SLIDER A lever mass=0.1" "DRIVE crank" "INERTIA distributed" \
    "CRANK 0 to 360 step 5" "SPEED 10" "REPORT drives" "REPORT linkage" "REPORT geometry crank=0,90" \
    "REPORT motion crank=0 speed=10 end=1 step=0.05" >"$scratch/slot.deck"
  run 1 --out "$scratch/out" "$scratch/slot.deck" && says "slot.deck:6:10: warning: the block at A leaves 'lever' between crank 50.554 and 129.45" &&
    says "crank 55 to 125 deg, 15 positions: the block at A leaves 'lever'" && says "crank 50.5538644124 deg: the block at A leaves 'lever'" || return 1
  [ "$(grep -c "^# failed .*: the block at A leaves 'lever'" "$scratch/out/slot/drives.dat")" -eq 15 ] || { echo "not 15 failed rows"; return 1; }
  grep -q "^# failed crank=90 : the block at A leaves 'lever'" "$scratch/out/slot/geometry.dat" || { echo "the drawing does not tell"; return 1; }
  grep -q "^ *A  *range_from  *129.44" "$scratch/out/slot/linkage.dat" || { echo "the range does not end"; return 1; }
  echo "POINT tip lever along=210" >>"$scratch/slot.deck"
  run 0 --out "$scratch/out" "$scratch/slot.deck" && silent
}
check "a block that leaves its link" leaving_block

# Positions of a slider or a ram are lengths, a motion that cannot begin is at its start.
lengths() {
  printf '%s\n' "UNITS mm kg s" "GROUND O 0 0" "GUIDE g 0 0 angle=0" "LINK crank O A length=30 mass=1 inertia=10" \
    "LINK rod A B length=100 mass=1 inertia=10" "SLIDER B g" "BRANCH A left O B" "DRIVE B g" \
    "CRANK 120 150" "REPORT pins" "REPORT geometry crank=150" \
    "REPORT motion crank=160 end=1 step=0.1" >"$scratch/pump.deck"
  run 1 --out "$scratch/out" "$scratch/pump.deck" && says "position 150 mm: out of reach: 'rod' and 'crank' together are 20 mm too short" &&
    says "motion, time 0 s, position 160 mm: out of reach: 'rod' and 'crank' together are 30 mm too short" || return 1
  grep -q "^# failed crank=150 : out of reach" "$scratch/out/pump/geometry.dat" || { echo "the drawing has another unit"; return 1; }
}
check "positions of a slider are lengths" lengths
