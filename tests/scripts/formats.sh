#!/bin/sh
# format=four_bar|linkage: the same numbers in the columns of four-bars and in those of any linkage; what each of them takes.
. tests/scripts/functions.sh

out=$scratch/out

# four_bar UNITS-KEY CARD...: a four-bar with masses, and cards.
four_bar() {
  cat <<END_OF_DECK
UNITS mm tonne s $1
GROUND O2 0 0
GROUND O4 254 20
LINK crank O2 A length=100 mass=1e-4 inertia=1
LINK coupler A B length=279.4 mass=2e-4 inertia=3 center=120,15
LINK follower O4 B length=266.7 mass=1e-4 inertia=2
DRIVE crank
POINT P coupler along=120 offset=-80
CRANK 0 to 330 step 30
SPEED -20 40
GRAVITY 0 -9810
END_OF_DECK
  shift
  printf '%s\n' "$@"
}
reports="REPORT kinematics
REPORT reactions
REPORT inertia
REPORT balance
REPORT drives
REPORT motion crank=40 speed=1 end=0.2 step=0.05 columns=accelerations,forces,power"

both() {
  four_bar format=four_bar "$reports" "REPORT linkage" >"$scratch/one.deck"
  four_bar format=linkage "$reports" "REPORT linkage" >"$scratch/other.deck"
  four_bar "" "$reports" "REPORT linkage" >"$scratch/plain.deck"
  run 0 --quiet --out "$out" "$scratch/one.deck" "$scratch/other.deck" "$scratch/plain.deck" || return 1
  for table in kinematics reactions inertia balance harmonics drives shaking motion linkage; do
    cmp "$out/one/$table.dat" "$out/plain/$table.dat" || return 1
  done
  python3 -B - "$out" <<'END_OF_PYTHON'
import os, sys
sys.path.insert(0, "tests/support")

def table(deck, name):
    lines = open(os.path.join(sys.argv[1], deck, name + ".dat"), encoding="utf-8").read().split("\n")
    heads = [line[1:].split() for line in lines if line.startswith("#")]
    names = next(head for head in reversed(heads[:-1]) if head[0] in ("speed", "time"))
    return [dict(zip(names, line.split())) for line in lines if line and not line.startswith("#")]

def same(a, b, scale, what):
    assert abs(float(a) - float(b)) <= 1e-12 * scale, (what, a, b)

def by_place(rows, *names):
    return {(float(row["speed"]), float(row["crank"])) + tuple(row[name] for name in names): row for row in rows}

links = by_place(table("other", "kinematics"), "link")
joints = by_place(table("other", "reactions"), "pin", "link")
drives = by_place(table("other", "drives"), "drive")
shaking = by_place(table("other", "shaking"))
for row in table("one", "kinematics"):
    place = float(row["speed"]), float(row["crank"])
    for number, name in (("3", "coupler"), ("4", "follower")):
        link = links[place + (name,)]
        for one, other, scale in (("theta", "theta", 360), ("omega", "omega", 100), ("alpha", "alpha", 1e4)):
            same(row[one + number], link[other], scale, (place, one + number))
rows = table("one", "reactions")
assert len(rows) == 24 and len(joints) == 6 * 24
for row in rows:
    place = float(row["speed"]), float(row["crank"])
    for column, pin, link in (("O2", "O2", "crank"), ("A2", "A", "crank"), ("A3", "A", "coupler"), ("B3", "B", "coupler"),
                              ("B4", "B", "follower"), ("O4", "O4", "follower")):
        for axis in "xy":
            same(row[column + axis], joints[place + (pin, link)]["f" + axis], 100, (place, column + axis))
    same(row["torque"], drives[place + ("crank",)]["force"], 1e4, (place, "torque"))
    for column in ("shaking_x", "shaking_y", "shaking_moment"):
        same(row[column], shaking[place][column], 1e4, (place, column))
one, other = table("one", "motion"), table("other", "motion")
assert len(one) == len(other) == 5
for a, b in zip(one, other):
    for column, general in (("crank", "position1"), ("omega2", "rate1"), ("torque", "torque"), ("kinetic", "kinetic"),
                            ("potential", "potential"), ("alpha2", "acceleration1"), ("load_power", "load_power")):
        same(a[column], b[general], 1e3, column)
one, other = by_place(table("one", "balance")), by_place(table("other", "balance"))
assert one == other and len(one) == 24
END_OF_PYTHON
}
check "both formats have the same numbers" both

# What makes another linkage of a deck leaves columns and words as they are.
stays() {
  four_bar format=four_bar "BRANCH crossed" "FORCE P 3 -4" "$reports" "REPORT linkage" "REPORT summary of=torque,transmission_angle" >"$scratch/forced.deck"
  four_bar format=four_bar "BRANCH crossed" "TORQUE coupler 5" "$reports" "REPORT linkage" "REPORT summary of=torque,transmission_angle" >"$scratch/plain.deck"
  four_bar format=four_bar "BRANCH crossed" "PIN A 70 70" "PIN Q 60 110" "PIN B 310 -260" "WELD A crank tail" "LINK tail A Q length=48 mass=1e-4 inertia=1" \
    "REPORT kinematics" "REPORT linkage" >"$scratch/welded.deck"
  run 0 --quiet --out "$out" "$scratch/forced.deck" "$scratch/plain.deck" "$scratch/welded.deck" || return 1
  for table in kinematics reactions inertia balance motion linkage summary; do
    grep '^#' "$out/plain/$table.dat" | tail -n 2 >"$scratch/head"
    grep '^#' "$out/forced/$table.dat" | tail -n 2 | cmp - "$scratch/head" || return 1
  done
  for table in kinematics linkage; do
    for deck in forced welded; do
      grep -v '^#' "$out/plain/$table.dat" >"$scratch/one"
      grep -v '^#' "$out/$deck/$table.dat" | cmp - "$scratch/one" || return 1
    done
  done
  grep -q '^branch: crossed$' "$out/forced/run.log" || { echo "no branch in the log"; return 1; }
  # What is written back is the same deck.
  cp "$out/forced/echo.deck" "$scratch/echoed.deck"
  run 0 --quiet --out "$out" "$scratch/echoed.deck" && cmp "$out/echoed/motion.dat" "$out/forced/motion.dat"
}
check "a force at a point and a welded link leave the columns" stays

# The gap of the motion's loop with a pin beside it is that of closed forms; the force at the pin does work.
pushed() {
  four_bar "" "FORCE P 30 -40" "REPORT motion crank=40 speed=1 end=0.2 step=0.05 format=four_bar" >"$scratch/pushed.deck"
  run 0 --quiet --out "$out" "$scratch/pushed.deck" || return 1
  grep -q '^# .*closure' "$out/pushed/motion.dat" && ! grep -v '^#' "$out/pushed/motion.dat" | awk '$12^2 > 1e-24 || ($11 - 0)^2 > 1e-20 { print; bad = 1 } END { exit bad }' |
    grep . && return 0
  echo "no closed loop"; return 1
}
check "a motion in the format of four-bars with a third pin" pushed

refused() {
  sed 's/^\(UNITS.*\)/\1 format=four_bar/' inputs/engine.deck >"$scratch/engine.deck"
  run 2 --out "$scratch/nothing" "$scratch/engine.deck" && says "format=four_bar" && says "error: this linkage is no four-bar: no driven link, coupler and follower alone" &&
    says "expected linkage, or no format=" || return 1
  [ "$(grep -c 'error:' "$scratch/stderr")" -eq 1 ] || { echo "more than one error"; return 1; }
  four_bar format=fourbar "REPORT kinematics" >"$scratch/wrong.deck"
  run 2 --out "$scratch/nothing" "$scratch/wrong.deck" && says "wrong.deck:1:25: error: unknown word 'fourbar' (did you mean 'four_bar'?); expected one of: four_bar, linkage" || return 1
  four_bar format=four_bar "PINMASS P 1e-4" "REPORT balance" >"$scratch/heavy.deck"
  run 2 --out "$scratch/nothing" "$scratch/heavy.deck" && says "REPORT balance as of a four-bar knows three links without masses at further pins; expected REPORT balance format=linkage" || return 1
  # A mesh is one of links with two pins, whatever the format.
  four_bar format=four_bar "MATERIAL steel E=200000 density=7.8e-9" "SECTION strip rectangle thickness=1.6 width=25.4" "FORCE P 1 1" "REPORT mesh" |
    sed 's/^\(LINK [a-z]* [A-Z0-9]* [A-Z0-9]* length=[0-9.]*\).*/\1 material=steel section=strip/' >"$scratch/mesh.deck"
  run 2 --out "$scratch/nothing" "$scratch/mesh.deck" && says "error: REPORT mesh is made for four-bars only, so far" || return 1
  four_bar "" "REPORT drives format=linkage" >"$scratch/key.deck"
  run 2 --out "$scratch/nothing" "$scratch/key.deck" && says "unknown key 'format'" && absent "$scratch/nothing"
}
check "what is no four-bar is refused by name" refused

older() {
  four_bar format=linkage "REPORT drive" >"$scratch/older.deck"
  sed 's/format=linkage//; s/drive$/drives/' "$scratch/older.deck" >"$scratch/newer.deck"
  { cat inputs/engine.deck | sed '/^ *REPORT/d; /^END/d'; echo "REPORT drive"; } >"$scratch/engine.deck"
  { cat inputs/engine.deck | sed '/^ *REPORT/d; /^END/d'; echo "REPORT drives"; } >"$scratch/engines.deck"
  run 0 --out "$out" "$scratch/engine.deck" && says "warning: REPORT drive is an older name; expected REPORT drives, which has the same columns" || return 1
  run 0 --quiet --out "$out" "$scratch/engines.deck" && cmp "$out/engine/drive.dat" "$out/engines/drives.dat" && cmp "$out/engine/shaking.dat" "$out/engines/shaking.dat" || return 1
  { cat "$scratch/engine.deck"; echo "REPORT drives"; } >"$scratch/twice.deck"
  run 2 --out "$scratch/nothing" "$scratch/twice.deck" && says "error: REPORT drive is the older name of REPORT drives" || return 1
  # Of a four-bar it is the torque of links that bend, which these have no sections for.
  run 2 --out "$scratch/nothing" "$scratch/older.deck" && says "expected REPORT torque" && absent "$scratch/nothing" && run 0 --quiet --out "$out" "$scratch/newer.deck"
}
check "REPORT drive means what it has meant" older

