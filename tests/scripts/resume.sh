#!/bin/sh
# --resume: a run that was killed goes on, and ends with the bytes of an undisturbed one.
. tests/scripts/functions.sh

# killed SIGNAL OUT DECK OPTION...: a run that is sent a signal when its journal has grown for a while. Where the run ended before the
# signal came, it is begun anew and sent the signal sooner.
killed() {
  rm -rf "$scratch/begun"
  [ ! -e "$2" ] || cp -r "$2" "$scratch/begun"
  for growth in 0.4 0.2 0.1 0.05 0.02; do
    killed_after "$growth" "$@" && return 0
    [ "$found" -eq 0 ] || break
    rm -rf "$2"
    [ ! -e "$scratch/begun" ] || cp -r "$scratch/begun" "$2"
  done
  echo "status $found, not $wanted"
  return 1
}

# killed_after SECONDS SIGNAL OUT DECK OPTION...: likewise, the seconds after the first bytes that the run adds to the journal.
killed_after() {
  cat >"$scratch/kill.sh" <<'END_OF_JOB'
signal=$1
journal=$2
told=$3
growth=$4
shift 4
bytes() {
  wc -c 2>/dev/null <"$journal" || echo 0
}
before=$(bytes)
python3 -c "$hearing" "$@" 2>"$told" &
# One that goes on from a journal cuts a torn end off first, and adds to it later.
while [ "$(bytes)" -le "$before" ] && kill -0 $!; do
  sleep 0.02
done
sleep "$growth"
kill -s "$signal" $!
wait $!
END_OF_JOB
  growth=$1
  signal=$2
  folder=$3
  deck=$4
  shift 4
  name=${deck##*/}
  sh "$scratch/kill.sh" "$signal" "$folder/${name%.deck}/resume.part" "$scratch/stderr" "$growth" "$program" "$@" --out "$folder" \
    "$deck" 2>"$scratch/kill.told"
  found=$?
  [ "$signal" = KILL ] && wanted=137 || wanted=130
  [ "$found" -eq "$wanted" ]
}

sweep_deck() {
  beam_deck "CRANK 0 to 360 step $1" "SPEED 0 20" "REPORT frequencies" "REPORT shapes crank=0" "REPORT branches"
}

vary_deck() {
  beam_deck "VARY b 270 to 290 step $1" "CRANK 0 to 350 step 10" "SPEED 0 20" "REPORT frequencies" "REPORT kinematics" |
    sed 's/length=279.4/length=$b/'
}

# long_deck NAME STEP: a deck that takes five seconds of a processor. What takes the same time for any step is no longer much the second
# time.
long_deck() {
  step=$2
  for attempt in 1 2; do
    "$1_deck" "$step" >"$scratch/probe.deck"
    spend
    begun=$spent
    run 0 --out "$scratch/probe" --threads 1 "$scratch/probe.deck"
    spend
    step=$(awk -v step="$step" -v took=$((spent - begun)) 'BEGIN {
      step *= (took < 1 ? 1 : took)/5000
      printf "%.6f\n", step < 0.0004 ? 0.0004 : step
    }')
  done
  "$1_deck" "$step" >"$scratch/$1.deck"
  run 0 --out "$scratch/whole" --format csv "$scratch/$1.deck"
}

long_deck sweep 0.25
long_deck vary 0.5

# complete OUT NAME: the files of a run that nobody disturbed, and no journal.
complete() {
  same "$1/$2" "$scratch/whole/$2"
}

# resumed NAME OUT OPTION...
resumed() {
  name=$1
  folder=$2
  shift 2
  run 0 --out "$folder" --format csv --resume "$@" "$scratch/$name.deck" || return 1
  says "$name.deck: resumed with " && says " from an earlier run" && complete "$folder" "$name"
}

killed_and_resumed() {
  killed KILL "$scratch/killed" "$scratch/$1.deck" --format csv "$2" "$3" || return 1
  rm -rf "$scratch/again"
  cp -r "$scratch/killed" "$scratch/again"
  resumed "$1" "$scratch/again" "$4" "$5"
}
check "a killed sweep continues" killed_and_resumed sweep --threads 1 --threads 2
check "killed variants continue" killed_and_resumed vary --threads 2 --threads 1

# from_journal NAME COMMAND...: goes on with what a command makes of the journal of the killed run.
from_journal() {
  name=$1
  shift
  rm -rf "$scratch/again"
  cp -r "$scratch/killed" "$scratch/again"
  "$@" "$scratch/again/$name/resume.part"
  resumed "$name" "$scratch/again"
}
torn() {
  truncate -s -7 "$1"
}
garbage() {
  head -c 5000 "$program" >>"$1"
}
check "a journal that was cut off" from_journal sweep torn
check "a journal with bytes after its end" from_journal vary garbage

# More than 100,000 rows: positions come in blocks, each of many blocks of the journal.
in_blocks() {
  beam_deck "CRANK 0 to 360 step 0.0035" "REPORT frequencies" >"$scratch/blocks.deck"
  run 0 --out "$scratch/whole" --format csv "$scratch/blocks.deck" || return 1
  killed KILL "$scratch/killed" "$scratch/blocks.deck" --format csv || return 1
  resumed blocks "$scratch/killed" --threads 2
}
check "positions in blocks continue" in_blocks

blocks_told() {
  sed -n 's/.*resumed with \([0-9]*\) .*/\1/p' "$scratch/stderr"
}
interrupted_and_resumed() {
  killed INT "$scratch/interrupted" "$scratch/vary.deck" --format csv --threads 2 && says "; --resume continues from what it has computed" || return 1
  resumed vary "$scratch/interrupted" && [ "$(blocks_told)" -gt 0 ]
}
check "an interrupted run continues" interrupted_and_resumed

# Killed, killed again while it goes on, and done at the third time, which knows at least the blocks that the second one did.
twice() {
  rm -rf "$scratch/again"
  cp -r "$scratch/killed" "$scratch/again"
  first=$(wc -c <"$scratch/again/sweep/resume.part")
  killed INT "$scratch/again" "$scratch/sweep.deck" --format csv --threads 2 --resume || return 1
  [ "$(wc -c <"$scratch/again/sweep/resume.part")" -ge "$first" ] || { echo "the journal has become shorter"; return 1; }
  resumed sweep "$scratch/again"
}
check "interrupted twice" twice

changed() {
  rm -rf "$scratch/again"
  cp -r "$scratch/killed" "$scratch/again"
  beam_deck "CRANK 0" "REPORT frequencies" >"$scratch/changed/sweep.deck"
  run 0 --out "$scratch/again" --resume "$scratch/changed/sweep.deck" || return 1
  says "sweep.deck: the earlier run was of another deck or by another program; this one started afresh" || return 1
  absent "$scratch/again/sweep/resume.part"
}
mkdir "$scratch/changed"
check "the journal of another deck is not used" changed

no_journal() {
  run 0 --out "$scratch/fresh" --resume "$scratch/changed/sweep.deck" || return 1
  says "sweep.deck: no earlier run left anything to resume; this one started afresh" || return 1
  absent "$scratch/fresh/sweep/resume.part"
}
check "no journal to resume from" no_journal

not_asked() {
  rm -rf "$scratch/again"
  cp -r "$scratch/killed" "$scratch/again"
  run 0 --out "$scratch/again" "$scratch/changed/sweep.deck" && silent && absent "$scratch/again/sweep/resume.part"
}
check "without --resume the journal is removed" not_asked

# The long studies keep what they find at each speed, meeting or critical speed.
damped="DAMPING * time=2e-5"
study_deck() {
  case $1 in
    response) beam_deck "DAMPING * time=1e-4" "CRANK 0 to 350 step 10" "SPEED 10 to 20 step 1" "REPORT response accuracy=1e-6" "REPORT strains" "REPORT peaks" "REPORT validity" ;;
    stability) beam_deck "SPEED 20 to 60 step 2" "REPORT stability" ;;
    intervals) beam_deck "SPEED 40 to 56 step 4" "MODES 2" "REPORT intervals accuracy=1e-4" ;;
    campbell) beam_deck "$damped" "SPEED 50 to 60 step 2" "REPORT campbell accuracy=1e-4" ;;
    transient) beam_deck "$damped" "SPEED 10 20 rad/s ramp=0.1" "REPORT transient turns=1 instants=48 accuracy=1e-5" ;;
  esac | grep -v -e '^MESH' -e '^INERTIA'
}

# first_blocks JOURNAL COUNT: cut off behind so many blocks; fewer are none.
first_blocks() {
  python3 - "$1" "$2" <<'END_OF_SCRIPT'
import struct, sys
path, count = sys.argv[1], int(sys.argv[2])
with open(path, "rb") as file:
    data = file.read()
at = 4 + struct.unpack_from("i", data)[0]
for block in range(count):
    at += 32 + struct.unpack_from("4i", data, at)[2]
assert at <= len(data), f"{path} has fewer blocks"
with open(path, "wb") as file:
    file.write(data[:at])
END_OF_SCRIPT
}

# study_continues NAME: interrupted when there is something to go on from, with all of that and with the first block alone.
study_continues() {
  study_deck "$1" >"$scratch/$1.deck"
  run 0 --quiet --out "$scratch/whole" --format csv "$scratch/$1.deck" || return 1
  rm -rf "$scratch/studies"
  killed INT "$scratch/studies" "$scratch/$1.deck" --quiet --format csv --threads 2 || return 1
  says "; --resume continues from what it has computed" || return 1
  for count in all 1; do
    rm -rf "$scratch/again"
    cp -r "$scratch/studies" "$scratch/again"
    [ $count = all ] || first_blocks "$scratch/again/$1/resume.part" $count || return 1
    resumed "$1" "$scratch/again" --threads 1 || return 1
    [ $count = all ] || [ "$(blocks_told)" -eq $count ] || { echo "$(blocks_told) blocks, not $count"; return 1; }
  done
}
for study in response stability intervals campbell transient; do
  check "$study continues" study_continues $study
done
