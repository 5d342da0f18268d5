#!/bin/sh
# The output folder: in the way, not writable, used before.
. tests/scripts/functions.sh

deck=$scratch/four.deck
motion_deck >"$deck"

file_in_the_way() {
  mkdir "$scratch/a"
  echo mine >"$scratch/a/four"
  run 2 --out "$scratch/a" "$deck" && says "a/four: error: this folder cannot be created" && [ "$(cat "$scratch/a/four")" = mine ]
}

file_above_in_the_way() {
  echo mine >"$scratch/b"
  run 2 --out "$scratch/b" "$deck" && says "b/four: error: this folder cannot be created" && [ "$(cat "$scratch/b")" = mine ]
}

folder_for_a_table() {
  mkdir -p "$scratch/c/four/kinematics.dat"
  run 2 --out "$scratch/c" "$deck" && says "kinematics.dat: error:" && [ "$(ls "$scratch/c/four")" = kinematics.dat ]
}

not_writable() {
  run 0 --out "$scratch/d" "$deck" && cp -r "$scratch/d" "$scratch/d_before" && chmod -R a-w "$scratch/d" || return 1
  motion_deck 10 >"$scratch/four.deck"
  run 2 --out "$scratch/d" "$deck" && says "cannot be written" && same "$scratch/d" "$scratch/d_before"
  result=$?
  chmod -R u+w "$scratch/d"
  motion_deck >"$deck"
  return $result
}

tables_of_before() {
  beam_deck "CRANK 0" "REPORT mesh" "REPORT frequencies" "REPORT kinematics" >"$scratch/more.deck"
  run 0 --out "$scratch/e" "$scratch/more.deck" && echo mine >"$scratch/e/more/notes.txt" && motion_deck >"$scratch/more.deck" &&
    run 0 --out "$scratch/e" "$scratch/more.deck" && absent "$scratch/e/more/mesh.dat" "$scratch/e/more/frequencies.dat" &&
    [ "$(cat "$scratch/e/more/notes.txt")" = mine ] && run 0 --out "$scratch/f" "$deck" &&
    cmp "$scratch/e/more/kinematics.dat" "$scratch/f/four/kinematics.dat"
}

refused_deck_leaves_tables() {
  run 0 --out "$scratch/g" "$deck" && cp -r "$scratch/g" "$scratch/g_before" && motion_deck "0 to" >"$scratch/four.deck" &&
    run 2 --out "$scratch/g" "$deck" && same "$scratch/g" "$scratch/g_before" && motion_deck >"$deck"
}

# The folder is named after the deck; these names would mean the folder above it.
names_of_folders() {
  mkdir -p "$scratch/h/inside"
  for name in . ..; do
    cp "$deck" "$scratch/$name.deck"
    run 2 --out "$scratch/h/inside" "$scratch/$name.deck" && says "error:" || return 1
  done
  [ "$(ls -A "$scratch/h")" = inside ] && [ -z "$(ls -A "$scratch/h/inside")" ] || { echo "something was written"; return 1; }
}

check "deck names that give no folder name" names_of_folders
check "a file where the folder should be" file_in_the_way
check "a file where the folder above should be" file_above_in_the_way
check "a folder where a table should be" folder_for_a_table
if [ "$(id -u)" -eq 0 ]; then
  skip "a folder that cannot be written to" "root writes everywhere"
else
  check "a folder that cannot be written to" not_writable
fi
check "earlier tables no longer requested are removed, other files stay" tables_of_before
check "a refused deck leaves earlier tables" refused_deck_leaves_tables
