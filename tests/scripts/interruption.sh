#!/bin/sh
# A run that is interrupted leaves the earlier results, byte for byte, and nothing half done.
. tests/scripts/functions.sh

out=$scratch/out
deck=$scratch/beam.deck
beam_deck "CRANK 0" "REPORT frequencies" "REPORT kinematics" >"$deck"
run 0 --out "$out" "$deck"
cp -r "$out" "$scratch/before"
# Long enough to be interrupted on any machine.
beam_deck "CRANK 0 to 360 step 0.002" "MODES 8" "SPEED 0 to 20 step 1" "REPORT frequencies" "REPORT mesh" >"$deck"

# interrupted SIGNAL OUT: a shell without job control starts its background jobs deaf to SIGINT, so one with it does.
interrupted() {
  cat >"$scratch/job.sh" <<'END_OF_JOB'
set -m
"$1" --format csv --out "$2" "$3" 2>"$4" &
sleep 1
kill -s "$5" $!
wait $!
END_OF_JOB
  sh "$scratch/job.sh" "$program" "$2" "$deck" "$scratch/stderr" "$1"
  found=$?
  [ $found -eq 130 ] || { echo "status $found, not 130"; return 1; }
  says "beam.deck: interrupted; its earlier results are untouched"
}

check "Ctrl-C leaves the earlier results" eval 'interrupted INT "$out" && same "$out" "$scratch/before"'
check "a request to end likewise" eval 'interrupted TERM "$out" && same "$out" "$scratch/before"'
check "no new folder is left" eval 'interrupted INT "$scratch/new" && absent "$scratch/new"'
