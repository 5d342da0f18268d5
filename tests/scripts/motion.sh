#!/bin/sh
# REPORT motion, from deck to table: the rows, the turning points in the log, motions that end too soon, variants, interruption.
. tests/scripts/functions.sh

out=$scratch/out

# swinging CARD...: a double rocker of rigid links that swings through its limit positions, and more cards.
swinging() {
  cat <<END_OF_DECK
UNITS    m kg s
GROUND   O2 0 0
GROUND   O4 2 0.3
LINK     crank    O2 A length=1.7 mass=5 inertia=1
LINK     coupler  A  B length=0.8 mass=3 inertia=0.2 center=0.3,0.1
LINK     follower O4 B length=1.9 mass=2 inertia=0.6
DRIVE    crank
GRAVITY  0 -9.81
END_OF_DECK
  for card in "$@"; do
    echo "$card"
  done
}

# parallelogram CARD...: comes to lie in one line.
parallelogram() {
  swinging "$@" | sed -e 's/O4 2 0.3/O4 2 0/' -e 's/length=1.7/length=1/' -e 's/length=0.8/length=2/' -e 's/length=1.9/length=1/'
}

# column NAME FILE: its numbers. Remarks before the names of the columns may have the word too.
column() {
  awk -v name="$1" '/^#/ && !begun { for (i = 1; i <= NF; i++) if ($i == name) n = i - ($1 == "#"); next }
    /^[^#]/ && n { begun = 1; print $n }' "$2"
}

# Rows at 0, 0.1, ..., 1; energy and closure as the columns tell; a branch as in the log.
swinging "REPORT motion crank=60 speed=7 end=1 step=0.1" >"$scratch/swing.deck"
swing() {
  run 0 --out "$out" "$scratch/swing.deck" && silent || return 1
  table=$out/swing/motion.dat
  [ "$(column time "$table" | wc -l)" -eq 11 ] || { echo "not 11 rows"; return 1; }
  [ "$(column time "$table" | tail -n 1)" = 1 ] || { echo "the last row is not at the end"; return 1; }
  awk '/^ / { if ($12 < 0) $12 = -$12; if ($12 > 1e-11 || $13 > 1e-14 || $12 + 0 != $12) { print "energy or closure:", $12, $13; exit 1 }
    rows[$NF]++ } END { if (!rows["open"] || !rows["crossed"]) { print "one branch only"; exit 1 } }' "$table" || return 1
  grep -q "^motion: at t=0.13351155153[0-9]* s the crank turns back at 101.114756547 deg; the linkage changes from open to crossed$" \
    "$out/swing/run.log" || { echo "no turning point in the log"; grep motion "$out/swing/run.log"; return 1; }
  [ "$(grep -c 'the crank turns back' "$out/swing/run.log")" -eq 5 ] || { echo "not 5 turning points"; return 1; }
}
check "a double rocker swings through its limit positions" swing
same_again() {
  run 0 --out "$scratch/again" --threads 2 "$scratch/swing.deck" && same "$out/swing" "$scratch/again/swing" || return 1
  cp "$out/swing/echo.deck" "$scratch/echoed.deck" && run 0 --out "$scratch/again" "$scratch/echoed.deck" &&
    same_tables "$out/swing" "$scratch/again/echoed"
}
check "the same from its echo and with two threads" same_again

# In another deck the units and the way links are described differ, not the motion.
sed -e 's/m kg s/mm tonne ms/' -e 's/O4 2 0.3/O4 2000 300/' -e 's/length=\([0-9.]*\)/length=\1m/' -e 's/mass=\([0-9.]*\)/mass=\1kg/' \
  -e 's/inertia=\([0-9.]*\)/inertia=\1e3/' -e 's/center=0.3,0.1/center=300,100/' -e 's/-9.81/-0.00981/' -e 's/end=1 step=0.1/end=1s step=100/' \
  "$scratch/swing.deck" >"$scratch/other.deck"
other_units() {
  run 0 --out "$out" "$scratch/other.deck" || return 1
  for name in crank theta3 theta4 omega2; do
    column $name "$out/swing/motion.dat" >"$scratch/a"
    column $name "$out/other/motion.dat" >"$scratch/b"
    paste "$scratch/a" "$scratch/b" | awk -v name=$name '{ d = $1 - $2; if (d < 0) d = -d; if (d > 1e-8) { print name, $1, $2; exit 1 } }
      END { if (NR != 11) exit 1 }' || { echo "$name differs"; return 1; }
  done
}
check "other units, the same motion" other_units

# Where the pins are: links keep their lengths; a crank angle is that of its pin. Without pins=yes there is no such table.
pins() {
  sed 's/end=1 step=0.1/& pins=yes/' "$scratch/swing.deck" >"$scratch/placed.deck"
  run 0 --out "$out" "$scratch/placed.deck" && silent && cmp "$out/swing/motion.dat" "$out/placed/motion.dat" || return 1
  [ ! -e "$out/swing/motion_pins.dat" ] || { echo "a table that was not asked for"; return 1; }
  column x "$out/placed/motion_pins.dat" >"$scratch/a"
  column y "$out/placed/motion_pins.dat" >"$scratch/b"
  column crank "$out/swing/motion.dat" | awk '{ print; print }' | paste "$scratch/a" "$scratch/b" - | awk '
    function off(a, b) { return a - b > 1e-13 || b - a > 1e-13 }
    NR % 2 { x = $1; y = $2; t = atan2(0, -1)*$3/180; if (off(x, 1.7*cos(t)) || off(y, 1.7*sin(t))) { print "A is off at row", NR; exit 1 } }
    NR % 2 == 0 && (off(sqrt(($1 - x)^2 + ($2 - y)^2), 0.8) || off(sqrt(($1 - 2)^2 + ($2 - 0.3)^2), 1.9)) { print "B is off at row", NR; exit 1 }
    END { if (NR != 22) { print NR, "rows"; exit 1 } }' || return 1
  sed 's/step=0.1/& pins=maybe/' "$scratch/swing.deck" >"$scratch/maybe.deck"
  run 1 --out "$out" "$scratch/maybe.deck"; says "maybe"
}
check "the places of the pins" pins

# A block that turns back in 40 ns, at 8,000 rpm, where its guide's force passes zero 4 us before: rows elsewhere, the same motion.
cat >"$scratch/sharp.deck" <<'END_OF_DECK'
UNITS    m kg s
MATERIAL steel E=2e11 density=7800
SECTION  strip rectangle thickness=0.0024 width=0.006
GROUND   O2 0 0
PIN      A 0.0353 -0.0214
PIN      B 0.134 0
GUIDE    bed 0 0 angle=0
LINK     crank O2 A length=0.04125 material=steel section=strip rigid
LINK     rod A B length=0.10092 material=steel section=strip
SLIDER   B bed
DRIVE    crank
GRAVITY  0 -9.81
MASS     crank 0.04816434754658318 at=0.01426370005603591
FORCE    crank 1.168687532692961 3.100269113365176 at=0.02487356465221194
FRICTION O2 radius=0.0075073827493734825 coefficient=0.16475199353900477
FRICTION B bed coefficient=0.16791552439033886
MOTOR    torque=0.923442080643138
INERTIA  distributed
REPORT   motion crank=202.33 speed=14.29 end=0.05 step=0.001
END_OF_DECK
sharp() {
  sed 's/step=0.001/step=0.0005/' "$scratch/sharp.deck" >"$scratch/closer.deck"
  run 0 --out "$out" "$scratch/sharp.deck" "$scratch/closer.deck" || return 1
  for name in sharp closer; do column rate1 "$out/$name/motion.dat" | tail -n 1; done | awk '
    { rate[NR] = $1 }
    END { if (NR != 2 || rate[1]/rate[2] - 1 > 1e-11 || rate[2]/rate[1] - 1 > 1e-11) { print rate[1], "and", rate[2]; exit 1 } }'
}
check "friction that turns over in no time" sharp

# A motion that ends too soon is a failed row; what comes before it is written, and other tables are.
parallelogram "CRANK 10 20" "REPORT kinematics" "REPORT motion crank=60 speed=7 end=1 step=0.05 change_points=stop" >"$scratch/line.deck"
line() {
  run 1 --out "$out" "$scratch/line.deck" || return 1
  says "line.deck: error: motion, time 0.29178574" && says "change point: all links lie in one line" || return 1
  grep -q '^# failed time=0.29178574[0-9]* : change point: all links lie in one line' "$out/line/motion.dat" || { echo "no failed row"; return 1; }
  [ "$(column time "$out/line/motion.dat" | wc -l)" -eq 6 ] || { echo "not 6 rows"; return 1; }
  grep -q '^motion, time 0.29178574.*change point' "$out/line/run.log" || { echo "the log does not tell"; return 1; }
  [ "$(grep -vc -e '^#' -e '^$' "$out/line/kinematics.dat")" -eq 2 ] || { echo "kinematics.dat is not complete"; return 1; }
  run 1 --json --out "$out" "$scratch/line.deck" || return 1
  for file in "$scratch/stdout" "$out/line/summary.json"; do
    grep -q '"stage": "motion", "speed": null, "crank": 179.9999[0-9]*, "time": 0.29178574[0-9]*, "reason": "change point' "$file" ||
      { echo "not reported as JSON"; return 1; }
  done
}
check "a change point ends a motion by name" line
dead() {
  parallelogram "REPORT motion crank=0 speed=7 end=1 step=0.05" >"$scratch/dead.deck"
  run 1 --out "$out" "$scratch/dead.deck" && says "motion, time 0 s, crank 0 deg: change point" || return 1
  grep -q '^# failed time=0 : change point' "$out/dead/motion.dat" || { echo "no failed row"; return 1; }
}
check "a motion that cannot begin" dead

# Variants, on one thread and on two: a block each.
swinging "VARY start 3 to 6 step 0.25 rad/s" 'REPORT motion crank=60 speed=$start end=2 step=0.5' >"$scratch/varied.deck"
varied() {
  run 0 --out "$out" --threads 1 "$scratch/varied.deck" && run 0 --out "$scratch/again" --threads 2 "$scratch/varied.deck" || return 1
  same "$out/varied" "$scratch/again/varied" || return 1
  [ "$(column start "$out/varied/motion.dat" | wc -l)" -eq 65 ] || { echo "not 13 times 5 rows"; return 1; }
}
check "motions of variants, for any number of threads" varied

swinging "REPORT motion crank=60 speed=7 end=100000 step=1" >"$scratch/long.deck"
long() {
  interrupted INT "$scratch/new" "$scratch/long.deck" || return 1
  says "long.deck: interrupted; its earlier results are untouched" && absent "$scratch/new"
}
check "a long motion can be interrupted" long

# A busy machine does not get to it in two seconds.
lost() {
  for limit in 2s 20s 200s; do
    run 130 --out "$scratch/new" --time-limit $limit "$scratch/long.deck" || return 1
    says "; nothing is kept of 'motion'" >/dev/null && break
  done
  says "its earlier results are untouched; nothing is kept of 'motion'"
}
check "what an interruption leaves nothing of is named" lost
