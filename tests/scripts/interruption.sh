#!/bin/sh
# A run that is interrupted leaves the earlier results, byte for byte, and nothing half done but what --resume goes on from.
. tests/scripts/functions.sh

out=$scratch/out
deck=$scratch/beam.deck
beam_deck "CRANK 0" "REPORT frequencies" "REPORT kinematics" >"$deck"
run 0 --out "$out" "$deck"
cp -r "$out" "$scratch/before"
# Long enough to be interrupted on any machine.
beam_deck "CRANK 0 to 360 step 0.002" "MODES 8" "SPEED 0 to 20 step 1" "REPORT frequencies" "REPORT mesh" >"$deck"

# stopped SIGNAL OUT: the message names what was kept for --resume.
stopped() {
  awaited=$2/beam/resume.part
  export awaited
  interrupted "$1" "$2" "$deck" --format csv || return 1
  unset awaited
  says "beam.deck: interrupted; its earlier results are untouched; --resume continues from what it has computed" || return 1
  [ -s "$2/beam/resume.part" ] || { echo "no resume.part"; return 1; }
  rm "$2/beam/resume.part"
}

check "Ctrl-C leaves the earlier results" eval 'stopped INT "$out" && same "$out" "$scratch/before"'
for signal in TERM HUP XCPU; do
  check "SIG$signal likewise" eval 'stopped $signal "$out" && same "$out" "$scratch/before"'
done
# A busy machine computes nothing in two seconds.
limited() {
  for limit in 2s 20s 200s; do
    run 130 --out "$out" --format csv --time-limit $limit "$deck" || return 1
    says "beam.deck: stopped at its time limit of $limit; its earlier results are untouched" || return 1
    [ ! -s "$out/beam/resume.part" ] || break
  done
  says "; --resume continues from what it has computed" && rm "$out/beam/resume.part"
}
check "a time limit likewise" eval 'limited && same "$out" "$scratch/before"'
check "a new folder holds nothing else" eval 'stopped INT "$scratch/new" && rmdir "$scratch/new/beam" "$scratch/new"'

# Nothing is kept of a run without frequencies: motion is found in no time, and only its tables take long.
{
  motion_deck "0 to 360 step 0.0004"
  printf '%s\n' "INERTIA distributed" "SPEED 0 to 20 step 1"
} >"$scratch/motion.deck"
long_motion() {
  interrupted INT "$scratch/new" "$scratch/motion.deck" || return 1
  # On a busy machine a second is over before the run has begun: then there is no word on earlier results.
  says "motion.deck: interrupted" || return 1
  ! says "--resume" >/dev/null || { echo "it speaks of --resume"; return 1; }
  absent "$scratch/new"
}
check "no new folder is left by a short run" long_motion

# stops_soon SIGNAL NAME: a run of minutes ends when it is told to, and leaves nothing but what --resume continues from.
stops_soon() {
  spend
  begun=$spent
  interrupted "$1" "$scratch/new" "$scratch/$2.deck" || return 1
  spend
  [ $((spent - begun)) -lt 30000 ] || { echo "it went on"; return 1; }
  says "$2.deck: interrupted; its earlier results are untouched" || return 1
  [ ! -f "$scratch/new/$2/resume.part" ] || { rm "$scratch/new/$2/resume.part" && rmdir "$scratch/new/$2" "$scratch/new"; } || return 1
  absent "$scratch/new"
}

# --check looks at all variants.
while_reading() {
  { motion_deck && echo "VARY b 270 to 290 step 0.0001"; } | sed 's/length=279.4/length=$b/' >"$scratch/many.deck"
  for signal in INT TERM HUP; do
    interrupted $signal "$scratch/new" "$scratch/many.deck" --check || return 1
    says "many.deck: interrupted" && absent "$scratch/new" || return 1
  done
}

# A pipe that nobody writes to would be waited for.
pipes() {
  mkfifo "$scratch/pipe.deck"
  for signal in INT TERM HUP; do
    interrupted $signal "$scratch/new" "$scratch/pipe.deck" || return 1
    says "pipe.deck: interrupted" && absent "$scratch/new" || return 1
  done
  mkdir -p "$scratch/pipes/beam"
  mkfifo "$scratch/pipes/beam/resume.part"
  run 2 --out "$scratch/pipes" --resume "$deck" && says "resume.part: error: this is a pipe or a device, and a file is to be written there"
}

# A limit that is over before a variant is found to be sound: a loop of runs with --resume would never end.
no_time() {
  { motion_deck && echo "VARY b -9 to 280 step 0.001"; } | sed 's/length=279.4/length=$b/' >"$scratch/many.deck"
  run 130 --resume --time-limit 1s --out "$scratch/new" "$scratch/many.deck" && absent "$scratch/new" &&
    says "flexmech: stopped at its time limit of 1s: reading and checking took" && says "and nothing was computed; expected a longer --time-limit"
}

# `nohup` and the shell's `&` let a program ignore a signal; it keeps to that.
deaf() {
  trap '' INT HUP
  "$program" --quiet --out "$scratch/deaf" "$scratch/some.deck" &
  trap - INT HUP
  for signal in INT HUP; do
    sleep 0.2
    kill -s $signal $!
  done
  wait $!
  found=$?
  [ $found -eq 0 ] && [ -s "$scratch/deaf/some/frequencies.dat" ] || echo "status $found"
}
beam_deck "CRANK 0 to 360 step 0.02" "SPEED 0 to 20 step 1" "REPORT frequencies" >"$scratch/some.deck"
check "an ignored signal stays ignored" deaf

# The deck before is done, the one behind it is not begun.
several_decks() {
  motion_deck >"$scratch/short.deck"
  for limit in 5s 50s 500s; do
    run 130 --out "$scratch/several" --time-limit $limit "$scratch/short.deck" "$deck" "$scratch/motion.deck" || return 1
    [ "$(ls "$scratch/several/beam")" != resume.part ] || break
  done
  says "beam.deck: stopped at its time limit of $limit" && [ -s "$scratch/several/short/kinematics.dat" ] || return 1
  [ "$(ls "$scratch/several/beam")" = resume.part ] && absent "$scratch/several/motion"
}
check "of several decks those done stay done" several_decks

# Next to a dead point a turn needs so many samples that the harmonics of many speeds take minutes.
cat >"$scratch/balance.deck" <<'END_OF_DECK'
UNITS    m kg s
GROUND   O2 0 0
GROUND   O4 2 0
LINK     crank    O2 A length=1 mass=1 inertia=0.01
LINK     coupler  A  B length=2 mass=1 inertia=0.01 center=1,0.2
LINK     follower O4 B length=1.0000001 mass=1 inertia=0.01
DRIVE    crank
CRANK    10
SPEED    1 to 3000 step 1
INERTIA  distributed
REPORT   balance
END_OF_DECK
check "while a deck is read" while_reading
check "a pipe in the place of a file" pipes
check "a time limit shorter than the check" no_time
check "harmonics stop likewise" stops_soon INT balance

# Minutes between two speeds.
sed 's/^SPEED .*/SPEED 15 60/' inputs/campbell.deck >"$scratch/critical.deck"
check "critical speeds stop likewise" stops_soon TERM critical
