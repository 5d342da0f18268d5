#!/bin/sh
# Where a position is out of reach, the message holds a CRANK card that can be put into the deck.
. tests/scripts/functions.sh

# Where some positions are in reach the others are failed rows; where none is, the deck is refused.
out_of_reach() {
  { run 1 --out "$scratch/out" "$scratch/$1.deck" >/dev/null || run 2 --out "$scratch/out" "$scratch/$1.deck"; } &&
    { says "out of reach" || says "closes at none of these positions"; }
}

# reach NAME GROUND2 GROUND4 R2 R3 R4 CRANK
reach() {
  deck() {
    cat <<END_OF_DECK
UNITS    mm tonne s
GROUND   O2 $2
GROUND   O4 $3
LINK     crank    O2 A length=$4
LINK     coupler  A  B length=$5
LINK     follower O4 B length=$6
DRIVE    crank
$7
REPORT   kinematics
END_OF_DECK
  }
  deck "$@" >"$scratch/out_of_reach.deck"
  out_of_reach out_of_reach || return 1
  card=$(sed -n 's/.*: \(CRANK .*\)/\1/p' "$scratch/stderr" | head -n 1)
  deck "$1" "$2" "$3" "$4" "$5" "$6" "$card" >"$scratch/in_reach.deck"
  run 0 --out "$scratch/out" "$scratch/in_reach.deck" && silent
}

all="CRANK 0 to 360 step 5"
check "a card about 0 degrees" reach a "0 0" "100 0" 80 90 75 "$all"
check "a card about 180 degrees" reach b "0 0" "100 0" 90 150 60 "$all"
check "a card of two intervals" reach c "0 0" "100 0" 90 120 60 "CRANK 0 90 180"
check "a card for a rotated ground" reach d "50 20" "50 120" 80 90 75 "$all"
check "a card for a ground turned to the left" reach e "50 20" "-50 20" 90 120 60 "$all"
check "a card with the user's step" eval 'reach f "0 0" "100 0" 80 90 75 "CRANK 90 to 180 step 0.25" && echo "$card" | grep -q "step 0.25$"'
check "a card for angles far from a turn" reach g "0 0" "100 0" 80 90 75 "CRANK 3690 to 3700 step 1 180"
check "a card for a narrow interval" reach h "0 0" "100 0" 80 10.001 10 "CRANK 0 to 350 step 10"
check "a card for a descending range" reach i "0 0" "100 0" 80 90 75 "CRANK 180 to -180 step -20"

# The ends of the card keep off the dead points, where beams have no frequencies.
beams() {
  beam_deck "CRANK 0 180" "REPORT frequencies" |
    sed 's/254 0/300 0/; s/length=100/length=240/; s/length=279.4/length=270/; s/length=266.7/length=225/' >"$scratch/beams.deck"
  out_of_reach beams || return 1
  card=$(sed -n 's/.*: \(CRANK .*\)/\1/p' "$scratch/stderr" | head -n 1)
  sed "s/^CRANK.*/$card/" "$scratch/beams.deck" >"$scratch/beams_in_reach.deck"
  run 0 --out "$scratch/out" "$scratch/beams_in_reach.deck" && silent
}

check "a card for beams" beams
