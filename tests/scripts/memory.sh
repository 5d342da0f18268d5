#!/bin/sh
# A run that cannot fit in memory is refused before it begins, with the numbers; the same run with a little more room is not.
. tests/scripts/functions.sh

if ! grep -q "Max address space" /proc/self/limits 2>/dev/null; then
  skip "too little memory" "the system does not tell how much there is"
  exit
fi

# within KB STATUS ARGUMENT...: as run, with so much address space; the numbers of memory are left out of what it says.
within() (
  ulimit -v "$1" || return 1
  shift
  run "$@"
  result=$?
  sed -i 's/[0-9.]* [MG]B/SOME/g' "$scratch/stderr"
  return $result
)

leaves="and the limit of address space (ulimit -v) leaves SOME"

# refused CARD MESSAGE: nothing is written, and the caret stands below the card. fits: the same deck with room.
refused() {
  rm -rf "$scratch/out"
  within 100000 2 --out "$scratch/out" "$deck" && says "$2" && says "| $1" && absent "$scratch/out"
}

fits() {
  within "$1" 0 --check "$deck"
}

deck=$scratch/beam.deck

dense_deck() {
  beam_deck "CRANK 0 120 240" "SOLVER dense" "REPORT frequencies" | sed 's/elements=2/elements=250/' >"$deck"
  refused "SOLVER dense" "beam.deck:13:8: error: dense matrices of 2250 unknowns (3 of them a thread) need SOME, $leaves"
}

# The refusal for memory comes first; with room the same deck hears what else is wrong with it.
dense_deck_with_room() {
  within 400000 2 --check "$deck" && says "this mesh is too fine for double precision"
}

# Shapes look back; without them the positions come in blocks.
results_deck() {
  beam_deck "CRANK 0 to 359 step 0.001" "REPORT frequencies" >"$deck"
  within 100000 0 --check "$deck" || return 1
  echo "REPORT shapes crank=0" >>"$deck"
  refused "CRANK 0 to 359" "beam.deck:12:7: error: the results at 359001 positions and 1 speed need SOME, $leaves"
}

band_deck() {
  beam_deck "CRANK 0" "REPORT frequencies" | sed 's/elements=2/elements=20000/' >"$deck"
  refused "MESH" "beam.deck:10:1: error: band matrices of 180000 unknowns need SOME of SOME in all, $leaves"
}

# The estimate and the run itself need some 150 MB.
just_fits() {
  beam_deck "CRANK 0 to 359 step 0.006" "REPORT frequencies" >"$deck"
  within 170000 0 --quiet --out "$scratch/fits" "$deck"
}

shapes_deck() {
  beam_deck "CRANK 0 to 359 step 1" "REPORT shapes points=2000" >"$deck"
  refused "REPORT shapes" "beam.deck:13:1: error: the shapes of 3 modes at 360 positions and speeds need SOME, $leaves"
}

threads_count() {
  beam_deck "CRANK 0" "SOLVER dense" "REPORT frequencies" | sed 's/elements=2/elements=90/' >"$deck"
  within 200000 0 --check "$deck" && silent && within 200000 0 --check --threads 12 "$deck" &&
    says "flexmech: warning: the limit of address space (ulimit -v) has room for"
}

# Whatever the limit, a run ends with its results or says why not.
any_limit() {
  { beam_deck "CRANK 0 to 360 step 10" "VARY L 260 to 300 step 0.5" "REPORT frequencies" "REPORT kinematics"; } | sed 's/length=279.4/length=$L/' >"$deck"
  for limit in 20000 40000 60000 80000 100000 150000 200000 300000 400000; do
    (ulimit -v $limit && exec "$program" --threads 8 --quiet --out "$scratch/out" "$deck") >"$scratch/stdout" 2>"$scratch/stderr"
    case $? in
      0) continue ;;
      1 | 2) grep -q "error: " "$scratch/stderr" && continue ;;
      127) grep -q "shared libraries\|cannot allocate\|Cannot allocate" "$scratch/stderr" && continue ;; # not even the libraries have room
    esac
    echo "ulimit -v $limit:"
    head -n 3 "$scratch/stderr"
    return 1
  done
}

small_stack() {
  python3 -B tests/stress/small_stack.py --small --program "$program" --scratch "$scratch/stack" >"$scratch/decks" && return
  grep "^not ok" "$scratch/decks"
  return 1
}

check "dense matrices that do not fit" dense_deck
check "dense matrices that do fit" dense_deck_with_room
check "results that do not fit" results_deck
check "band matrices that do not fit" band_deck
check "results that just fit" just_fits
check "shapes that do not fit" shapes_deck
check "memory is needed for every thread" threads_count
check "any limit of memory" any_limit
check "a stack of 256 kB" small_stack
