# Read in by the scripts of this folder, which check.py runs as: script PROGRAM SCRATCH, in the repository's root.
program=$1
scratch=${2:?a folder for files}

# Seconds; a command that takes longer hangs, on a busy machine too.
longest=3000

# check NAME COMMAND...: one test; the command is silent when all is well, and else prints why not.
check() {
  test_name=$1
  shift
  if why=$("$@" 2>&1); then
    echo "ok $test_name"
  else
    echo "not ok $test_name:" $why
  fi
}

skip() {
  echo "ok $1 # skip $2"
}

# run STATUS ARGUMENT...: the program; what it says is kept in $scratch/stdout and stderr.
run() {
  wanted=$1
  shift
  timeout "$longest" "$program" "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  found=$?
  [ $found -eq "$wanted" ] && return
  echo "status $found, not $wanted; it said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# spend: $spent becomes the milliseconds of processors that commands have taken so far, of which other work changes little.
spend() {
  times >"$scratch/times"
  spent=$(awk -F '[ms ]+' 'NR == 2 { print int(1000*(60*($1 + $3) + $2 + $4)) }' "$scratch/times")
}

# says TEXT: on standard error, in the last run.
says() {
  grep -qF -e "$1" "$scratch/stderr" && return
  echo "it did not say '$1' but:"
  head -n 5 "$scratch/stderr"
  return 1
}

silent() {
  [ ! -s "$scratch/stderr" ] && return
  echo "it said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# absent PATH...
absent() {
  for path in "$@"; do
    [ -e "$path" ] && echo "${path##*/} is there" && return 1
  done
  return 0
}

# as_somebody COMMAND...: not as root, who may read and write everything; what it says is kept like that of `run`.
as_somebody() {
  if [ "$(id -u)" -eq 0 ]; then
    set -- setpriv --reuid=65534 --regid=65534 --clear-groups "$@"
  fi
  "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
}

# python3 -c "$hearing" COMMAND...: a command that hears signals. Shells start their background jobs deaf to SIGINT, nohup to SIGHUP.
hearing='import os, signal, sys
for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM, signal.SIGXCPU):
    signal.signal(number, signal.SIG_DFL)
os.execvp(sys.argv[1], sys.argv[1:])'
export hearing

# eval "$listening" waits until the program that was begun last has set what it does at a signal (HUP, INT, TERM, XCPU), or has ended: on
# a busy machine that takes longer than any sleep.
listening='while kill -0 $! && [ -e /proc/$!/status ] && ! {
  [ "$(cat /proc/$!/comm)" = "${program##*/}" ] &&
    [ $((0x$(sed -n "s/^SigCgt:[[:space:]]*//p" /proc/$!/status) & 0x804003)) -eq $((0x804003)) ]
}; do
  sleep 0.02
done'
export listening program

# interrupted SIGNAL OUT DECK OPTION...: a run that is sent a signal a second after it listens, and is told to have taken it.
interrupted() {
  cat >"$scratch/job.sh" <<'END_OF_JOB'
signal=$1
told=$2
shift 2
python3 -c "$hearing" "$@" 2>"$told" &
eval "$listening"
sleep 1
# Where the run is to leave a journal, not before there is one.
while [ -n "$awaited" ] && [ ! -s "$awaited" ] && kill -0 $!; do
  sleep 0.1
done
kill -s "$signal" $!
wait $!
END_OF_JOB
  signal=$1
  out_folder=$2
  interrupted_deck=$3
  shift 3
  sh "$scratch/job.sh" "$signal" "$scratch/stderr" "$program" "$@" --out "$out_folder" "$interrupted_deck" 2>"$scratch/job.told"
  found=$?
  [ "$signal" = KILL ] && wanted=137 || wanted=130
  [ $found -eq $wanted ] || { echo "status $found, not $wanted"; return 1; }
}

# same FOLDER FOLDER [OPTION...]: the same files with the same bytes.
same() {
  diff -rq "$@"
}

# same_but_names FOLDER FOLDER: likewise, but for the summary, which names its deck.
same_but_names() {
  diff -rq -x summary.json "$1" "$2"
}

# quick_inputs: the decks of inputs/ but for those that take seconds, which check.py names (`make check-all`: none).
quick_inputs() {
  ls inputs/*.deck | grep -vE "/(${SLOW_DECKS:-none})\.deck"
}

# same_tables FOLDER FOLDER: likewise, but for the log and the echo, which name lines of their deck.
same_tables() {
  diff -rq -x run.log -x echo.deck -x summary.json "$1" "$2"
}

# A four-bar for what needs no beams.
motion_deck() {
  cat <<END_OF_DECK
UNITS    mm tonne s
GROUND   O2  0 0
GROUND   O4  254 0
LINK     crank    O2 A  length=100
LINK     coupler  A  B  length=279.4
LINK     follower O4 B  length=266.7
DRIVE    crank
CRANK    ${1:-0 to 360 step 30}
REPORT   kinematics
END_OF_DECK
}

# One with beams and all reports; the arguments are more cards.
beam_deck() {
  cat <<END_OF_DECK
UNITS    mm tonne s
MATERIAL steel  E=200000 density=7.8e-9
SECTION  strip  rectangle thickness=1.6 width=25.4
GROUND   O2  0 0
GROUND   O4  254 0
LINK     crank    O2 A  length=100    material=steel section=strip
LINK     coupler  A  B  length=279.4  material=steel section=strip
LINK     follower O4 B  length=266.7  material=steel section=strip
DRIVE    crank
MESH     *  elements=2
INERTIA  lumped
END_OF_DECK
  for card in "$@"; do
    echo "$card"
  done
}
