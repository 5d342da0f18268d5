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

# What a user keeps beside the deck, by the names of tables, where the outputs are to be, too.
beside_the_deck() {
  mkdir "$scratch/press"
  cp "$deck" "$scratch/press/press.deck"
  for name in strains.dat points.csv summary.csv notes.txt; do
    echo mine >"$scratch/press/$name"
  done
  for time in 1 2; do
    run 0 --out "$scratch" "$scratch/press/press.deck" || return 1
    for name in strains.dat points.csv summary.csv notes.txt; do
      [ "$(cat "$scratch/press/$name")" = mine ] || { echo "$name is another"; return 1; }
    done
  done
  echo mine >"$scratch/press/linkage.dat"
  { motion_deck && echo "REPORT linkage"; } >"$scratch/press/press.deck"
  run 2 --out "$scratch" "$scratch/press/press.deck" && says "press/linkage.dat: error: a file is to be written there" &&
    [ "$(cat "$scratch/press/linkage.dat")" = mine ]
}

# Neither the deck nor what it includes nor its tables are written over.
inputs_in_the_way() {
  for name in echo.deck summary.json kinematics.dat resume.part; do
    base=$(basename "$name" .deck)
    mkdir -p "$scratch/i/$base" "$scratch/i/four"
    case $name in
      echo.deck) of=$scratch/i/echo/echo.deck && cp "$deck" "$of" ;;
      kinematics.dat)
        of=$scratch/i/four/four.deck
        printf 'units deg N\n0 0\n360 0\n' >"$scratch/i/four/$name"
        { motion_deck && echo "FORCE B 1 0 table=$name"; } >"$of" ;;
      *) of=$scratch/i/four/four.deck && echo "MODES 3" >"$scratch/i/four/$name" && { motion_deck && echo "INCLUDE $name"; } >"$of" ;;
    esac
    cp -r "$scratch/i" "$scratch/i_before"
    run 2 --out "$scratch/i" "$of" && says "$name: error: this file belongs to the deck" && same "$scratch/i" "$scratch/i_before" || return 1
    rm -r "$scratch/i" "$scratch/i_before"
  done
}

# Somebody else holds the lock, is killed, or has left its file.
another_run() {
  mkdir -p "$scratch/j"
  run 0 --out "$scratch/j" "$deck" && cp -r "$scratch/j" "$scratch/j_before" || return 1
  python3 -c 'import fcntl, sys, time
lock = open(sys.argv[1], "a")
fcntl.flock(lock, fcntl.LOCK_EX)
lock.write("process 4711 on elsewhere, 1\n")
lock.flush()
time.sleep(1000)' "$scratch/j/four/.lock" &
  holder=$!
  while [ ! -s "$scratch/j/four/.lock" ]; do sleep 0.1; done
  run 2 --out "$scratch/j" "$deck" && says "j/four: error: another run is writing to this folder (process 4711 on elsewhere)" &&
    same "$scratch/j" "$scratch/j_before" -x .lock
  result=$?
  kill -KILL $holder
  wait $holder 2>/dev/null
  [ $result -eq 0 ] && run 0 --out "$scratch/j" "$deck" && same "$scratch/j" "$scratch/j_before"
}

# `make check-all` has more of both.
pairs_and_kills() {
  python3 -B tests/stress/shared_folder.py --program "$program" --scratch "$scratch/shared" --pairs 10 --kills 40
}

check "files of the user's own stay" beside_the_deck
check "a file of the deck in the place of a table" inputs_in_the_way
check "another run writes to the folder" another_run
check "pairs of runs, and runs that are killed" pairs_and_kills
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
