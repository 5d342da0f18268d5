#!/bin/sh
# Several processes: the bytes of one, whatever their number; faults; the program that `make MPI=yes` builds.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "several processes" "they are of the release build"; exit ;;
esac
parallel=${program%/release/*}/mpi/flexmech
if ! command -v mpirun >/dev/null || [ ! -x "$parallel" ]; then
  skip "several processes" "there is no MPI here; make setup MPI=yes installs one"
  exit
fi

# What Open MPI wants to be told: that root may, and that processes may be more than processors.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
# It tells on standard error that a program ended with a status, too; these lines are not the program's.
said_by_program() {
  awk '/^---------/ { inside = !inside; next } !inside' "$1"
}

# ranks NUMBER STATUS ARGUMENT...: the program in so many processes.
ranks() {
  number=$1
  wanted=$2
  shift 2
  timeout "$longest" mpirun -n "$number" "$parallel" "$@" >"$scratch/stdout" 2>"$scratch/told" </dev/null
  found=$?
  said_by_program "$scratch/told" >"$scratch/stderr"
  [ $found -eq "$wanted" ] && return
  echo "$number processes: status $found, not $wanted; they said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# Five links' lengths by forty of another one; a variant that does not close.
study_deck() {
  beam_deck "VARY b 270 272 275 280 900" "VARY c 255 to 275 step $1" "CRANK 0 to 350 step 10" "SPEED 0 20" "REPORT frequencies" \
    "REPORT reactions" "SET d \$c + (\$b - \$b)/2" | sed 's/length=279.4/length=$b/; s/length=266.7/length=$d/'
}
sweep_deck() {
  beam_deck "CRANK 0 to 360 step $1" "SPEED 0 20" "REPORT frequencies" "REPORT shapes crank=0,90" "REPORT branches"
}
# Each variant alone would keep all threads busy.
long_deck() {
  beam_deck "VARY b table=long" "TABLE long mm 280 270 275" "CRANK 0 to 360 step 0.2" "REPORT frequencies" | sed 's/length=279.4/length=$b/'
}
# More than 100,000 rows: positions come in blocks.
blocks_deck() {
  beam_deck "CRANK 0 to 360 step 0.0035" "REPORT frequencies"
}

# Beside the limits of the crank 95 positions are solved again with higher orders. The text is longer than any message about tasks.
steep_deck() {
  beam_deck "CRANK -111 to 111 step 0.05" "SPEED 20" "REPORT frequencies" |
    sed 's/length=100/length=400/; s/elements=2/accuracy=1e-8/; s/lumped/distributed/'
  awk 'BEGIN { for (i = 0; i < 2000; i++) print "! what is sent with an announcement only" }'
}

study_deck 0.5 >"$scratch/study.deck"
sweep_deck 0.1 >"$scratch/sweep.deck"
long_deck >"$scratch/long.deck"
blocks_deck >"$scratch/blocks.deck"
steep_deck >"$scratch/steep.deck"
run 1 --format csv --out "$scratch/whole" "$scratch/study.deck"
cp "$scratch/stderr" "$scratch/study.told"
run 0 --format csv --out "$scratch/whole" "$scratch/sweep.deck" "$scratch/long.deck" "$scratch/blocks.deck" "$scratch/steep.deck"

# of_ranks NAME STATUS RANKS THREADS
of_ranks() {
  rm -rf "$scratch/many"
  ranks "$3" "$2" --format csv --threads "$4" --out "$scratch/many" "$scratch/$1.deck" && same "$scratch/many/$1" "$scratch/whole/$1"
}
for count in 1 2 3 7; do
  for threads in 1 2; do
    check "a study by $count ranks of $threads" of_ranks study 1 $count $threads
    check "a sweep by $count ranks of $threads" of_ranks sweep 0 $count $threads
  done
done
check "long variants by 3 ranks of 2" of_ranks long 0 3 2
check "positions in blocks by 3 ranks" of_ranks blocks 0 3 1
check "positions solved again by 2 ranks" of_ranks steep 0 2 1
check "positions solved again by 3 ranks of 2" of_ranks steep 0 3 2

# Open MPI tells how many messages there were of so many bytes; announcements are those of 2^16 and more.
announced_twice() {
  OMPI_MCA_pml_monitoring_enable=1 OMPI_MCA_pml_monitoring_enable_output=3 OMPI_MCA_pml_monitoring_filename="$scratch/sent" \
    ranks 2 0 --out "$scratch/many" "$scratch/steep.deck" || return 1
  announced=$(awk -F '[\t,]' '/^E/ { for (i = 6 + 17; i <= NF; i++) sum += $i } END { print sum }' "$scratch/sent.0.prof")
  [ "$announced" -eq 2 ] || { echo "$announced jobs were announced"; return 1; }
}
if ompi_info 2>/dev/null | grep -q "pml: monitoring"; then
  check "other ranks solve positions again" announced_twice
else
  skip "other ranks solve positions again" "this MPI does not count its messages"
fi

# One rank speaks.
once() {
  rm -rf "$scratch/many"
  ranks 3 1 --out "$scratch/many" "$scratch/study.deck" || return 1
  cmp "$scratch/stderr" "$scratch/study.told" || return 1
  [ "$(wc -l <"$scratch/stdout")" -eq 2 ] || { echo "it printed:"; cat "$scratch/stdout"; return 1; }
}
check "one rank speaks" once

several() {
  rm -rf "$scratch/many"
  ranks 3 1 --format csv --out "$scratch/many" "$scratch/sweep.deck" "$scratch/study.deck" "$scratch/long.deck" \
    "$scratch/blocks.deck" "$scratch/steep.deck" &&
    same "$scratch/many" "$scratch/whole"
}
check "several decks" several

from_input() {
  rm -rf "$scratch/many"
  mpirun -n 3 "$parallel" --quiet --out "$scratch/many" --set b=280 - <"$scratch/study.deck" 2>"$scratch/stderr" || return 1
  run 0 --quiet --out "$scratch/one" --set b=280 "$scratch/study.deck" || return 1
  same_but_names "$scratch/many/stdin" "$scratch/one/study"
}
check "a deck from standard input, and a setting" from_input

# refused MESSAGE ARGUMENT...: told once, and nothing written.
refused() {
  message=$1
  shift
  rm -rf "$scratch/none"
  ranks 3 2 --out "$scratch/none" "$@" || return 1
  [ "$(grep -cF "$message" "$scratch/stderr")" -eq 1 ] || { echo "it said:"; cat "$scratch/stderr"; return 1; }
  absent "$scratch/none"
}
sed 's/length=100/length=-100/' "$scratch/sweep.deck" >"$scratch/wrong.deck"
check "a bad deck" refused "wrong.deck:" "$scratch/wrong.deck"
check "a bad option" refused "unknown option '--rank'" --rank "$scratch/sweep.deck"
helped() {
  ranks 3 0 --help && [ "$(grep -c '^usage' "$scratch/stdout")" -eq 1 ]
}
check "help is printed once" helped

# The journal of a run that was killed serves any number of ranks. KILLS times a run goes on, with another number, and is killed when
# its journal has grown: one rank at random, the leader or another, with a signal at random, or mpirun. One that was done before it
# was killed is compared, and another one begins.
chain_deck() {
  beam_deck "VARY b 270 to 290 step $1" "CRANK 0 to 350 step 10" "SPEED 0 20" "REPORT frequencies" "REPORT kinematics" |
    sed 's/length=279.4/length=$b/'
}
cat >"$scratch/victim.sh" <<'END_OF_JOB'
# victim.sh RANKS VICTIM SIGNAL DELAY JOURNAL COMMAND...: the victim is a rank, or `mpirun`; status 0: it was killed
ranks=$1
victim=$2
signal=$3
delay=$4
journal=$5
shift 5
bytes() {
  wc -c 2>/dev/null <"$journal" || echo 0
}
before=$(bytes)
rm -f "$told".*
mpirun -n "$ranks" sh -c 'echo $$ >"$0.${OMPI_COMM_WORLD_RANK:-$PMI_RANK}"; exec "$@"' "$told" "$@" >/dev/null 2>&1 &
started=$!
while kill -0 $started && [ "$(bytes)" -le "$before" ]; do
  sleep 0.02
done
sleep "$delay"
if [ "$victim" = mpirun ]; then
  kill -s "$signal" $started
else
  kill -s "$signal" "$(cat "$told.$victim")"
fi
killed=$?
wait $started
exit $killed
END_OF_JOB
kills_wanted=${KILLS:-8}
killed_many_times() {
  step=0.02
  chain_deck $step >"$scratch/chain.deck"
  spend
  begun=$spent
  run 0 --out "$scratch/whole" --threads 2 "$scratch/chain.deck" || return 1
  spend
  took=$((spent - begun))
  # As many variants as take eight seconds of a processor.
  step=$(awk -v step=$step -v took=$took 'BEGIN { step *= took/8000; printf "%.6f\n", step < 0.0004 ? 0.0004 : step }')
  chain_deck "$step" >"$scratch/chain.deck"
  run 0 --out "$scratch/whole" --threads 2 "$scratch/chain.deck" || return 1
  rm -rf "$scratch/killed"
  awk 'BEGIN { srand(7)
    for (i = 0; i < 200; i++) {
      n = 1 + int(4*rand()); v = int((n + 1)*rand())
      print n, (v == n ? "mpirun" : v), (rand() < 0.5 || v == n ? "TERM" : "KILL"), 0.1*rand()
    } }' >"$scratch/kills"
  kills=0
  while read -r number victim signal delay; do
    [ $kills -lt "$kills_wanted" ] || break
    told="$scratch/pid" sh "$scratch/victim.sh" "$number" "$victim" "$signal" "$delay" "$scratch/killed/chain/resume.part" \
      "$parallel" --resume --threads $((1 + kills%2)) --out "$scratch/killed" "$scratch/chain.deck" 2>/dev/null </dev/null &&
      kills=$((kills + 1))
    [ -e "$scratch/killed/chain/frequencies.dat" ] || continue
    same "$scratch/killed/chain" "$scratch/whole/chain" || return 1
    rm -rf "$scratch/killed"
  done <"$scratch/kills"
  [ $kills -eq "$kills_wanted" ] || { echo "only $kills were killed"; return 1; }
  ranks 3 0 --resume --out "$scratch/killed" "$scratch/chain.deck" && same "$scratch/killed/chain" "$scratch/whole/chain"
}
check "killed and resumed $kills_wanted times" killed_many_times
