#!/bin/sh
# Several decks in one run.
. tests/scripts/functions.sh

out=$scratch/out
mkdir -p "$scratch/other"
motion_deck >"$scratch/good.deck"
motion_deck >"$scratch/other/good.deck"
motion_deck "0 to 360" >"$scratch/bad.deck"
motion_deck "nowhere" >"$scratch/worse.deck"

two() {
  motion_deck "0 10 20" >"$scratch/second.deck"
  run 0 --out "$out" "$scratch/good.deck" "$scratch/second.deck" && silent &&
    [ -s "$out/good/kinematics.dat" ] && [ -s "$out/second/kinematics.dat" ] && rm -r "$out"
}

all_errors() {
  run 2 --out "$out" "$scratch/bad.deck" "$scratch/good.deck" "$scratch/worse.deck" "$scratch/absent.deck" &&
    says "bad.deck:8:12: error:" && says "worse.deck:8:10: error:" && says "absent.deck: error: no such file" && absent "$out"
}

same_name() {
  run 2 --out "$out" "$scratch/good.deck" "$scratch/other/good.deck" && absent "$out" &&
    says "two decks would write to the same folder 'good': $scratch/good.deck and $scratch/other/good.deck"
}

check "two decks" two
check "the errors of all decks, and nothing computed" all_errors
check "two decks of the same base name" same_name
check "one deck twice" eval 'run 2 --out "$out" "$scratch/good.deck" "$scratch/good.deck" && says "the same folder" && absent "$out"'
