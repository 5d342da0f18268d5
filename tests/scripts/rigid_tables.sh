#!/bin/sh
# Tables of rigid linkages: friction in the forces of joints, what rests and what runs, what counterweights leave.
. tests/scripts/functions.sh

# value TABLE ROW COLUMN: of the first row that has these words.
value() {
  awk -v words="$2" -v column="$3" '/^#/ { next }
    { line = " "; for (i = 1; i <= NF; i++) line = line $i " " }
    index(line, " " words " ") { print $column; exit }' "$1"
}

# near VALUE EXPECTED: to 1e-11.
near() {
  awk -v a="$1" -v b="$2" 'BEGIN { d = a - b; exit !(a != "" && (d < 0 ? -d : d) <= 1e-11 * (b < 0 ? -b : b)) }' ||
    { echo "$1, not $2"; return 1; }
}

# A block that rubs on its guide: with t = tan(rod), N (1 - mu t) = F and the friction mu N against the sliding.
block() {
  cat >"$scratch/block.deck" <<'END_OF_DECK'
UNITS    m kg s
GROUND   A 0 0
GUIDE    bed 0 0 angle=0
LINK     crank A B length=1 mass=0 inertia=0
LINK     rod B C length=3 mass=0 inertia=0
SLIDER   C bed
BRANCH   C forward
DRIVE    crank
FORCE    C 0 -100N
FRICTION C bed coefficient=0.2
CRANK    60
SPEED    1
REPORT   reactions
REPORT   bearings
REPORT   drives
END_OF_DECK
  run 0 --quiet --out "$scratch/out" "$scratch/block.deck" || return 1
  near "$(value "$scratch/out/block/reactions.dat" "C bed" 5)" 18.862545696950583 &&
    near "$(value "$scratch/out/block/reactions.dat" "C bed" 6)" 94.31272848475291 &&
    near "$(value "$scratch/out/block/bearings.dat" "C bed" 9)" 96.18048858478663 &&
    near "$(value "$scratch/out/block/drives.dat" "crank" 6)" 19.179079511227595
}

# A lever that torques of 5 turn on in the sense in which it turns: it runs in both, and so does its mirror image. Its weight
# rubs with 0.1 N m, which alone holds it.
both_ways() {
  for torques in "5 -5 runs" "-5 5 runs" "0.05 -0.05 holds" "5 -0.05 runs_forward" "0.05 -5 runs_backward"; do
    set -- $torques
    cat >"$scratch/lever.deck" <<END_OF_DECK
UNITS    m kg s
GROUND   O 0 0
LINK     lever O A length=1 mass=2 inertia=0.5 center=0,0
DRIVE    lever
GRAVITY  0 -10
TORQUE   lever ${1}N*m during=with
TORQUE   lever ${2}N*m during=with
FRICTION O radius=0.05 coefficient=0.1
CRANK    0 90
SPEED    1
REPORT   friction
END_OF_DECK
    run 0 --quiet --out "$scratch/out" "$scratch/lever.deck" || return 1
    [ "$(awk '/^#/ || !NF { next } { print $4 }' "$scratch/out/lever/holding.dat" | sort -u)" = "$3" ] ||
      { echo "torques $1 and $2: $(awk '!/^#/ { print $4 }' "$scratch/out/lever/holding.dat" | tr '\n' ' '), not $3"; return 1; }
  done
}

# The counterweight of the crank does nothing for the shaking moment about its pivot.
nothing_helps() {
  cat >"$scratch/moment.deck" <<'END_OF_DECK'
UNITS    m kg s
GROUND   O2 0 0
GROUND   O4 0.5 0
LINK     crank O2 A length=0.11 mass=0.05
LINK     coupler A B length=0.305 mass=0.5
LINK     follower O4 B length=0.326 mass=1.2
DRIVE    crank
BALANCE  crank minimise=moment radius=0.18
CRANK    0 10
SPEED    10
REPORT   balance
END_OF_DECK
  run 0 --quiet --out "$scratch/out" "$scratch/moment.deck" || return 1
  grep -q "^# sum 1 by counterweights" "$scratch/out/moment/balance.dat" || { grep "^# sum" "$scratch/out/moment/balance.dat"; return 1; }
}

check "friction of a block is in the rows of its joint" block
check "what runs in either sense does so in the mirror too" both_ways
check "counterweights that do nothing leave all" nothing_helps
