#!/bin/sh
# The command line and its exit statuses.
. tests/scripts/functions.sh

deck=$scratch/four.deck
out=$scratch/out
motion_deck >"$deck"

help() {
  run 0 --help && silent || return 1
  for option in --check --out --set --threads --format --digits --resume --time-limit --part --join --quiet --stats --json --version --help --help-cards --man --completion; do
    grep -q -e "^ *$option" "$scratch/stdout" || { echo "$option is not explained"; return 1; }
  done
}

version() {
  run 0 --version && silent && grep -qx 'flexmech [0-9.]*' "$scratch/stdout"
}

check_only() {
  run 0 --check --out "$out" "$deck" && silent && absent "$out"
}

check_refuses() {
  motion_deck "0 to 360" >"$scratch/bad.deck"
  run 2 --check "$scratch/bad.deck" && says "bad.deck:8:12: error:"
}

unknown_option() {
  run 2 --thread=2 "$deck" && says "unknown option '--thread" && says "did you mean '--threads'?"
}

value_missing() {
  run 2 "$deck" --out && says "option --out needs a value" &&
    run 2 --out= "$deck" && says "option --out needs a value" &&
    run 2 --out --quiet "$deck" && says "option --out needs a value, and '--quiet' is an option: write --out=--quiet if it is meant"
}

value_twice() {
  run 2 --out "$out" --threads=2 --threads 3 "$deck" && says "option --threads is given twice" && absent "$out" &&
    run 2 --format csv --format csv "$deck" && says "option --format is given twice"
}

format_unknown() {
  run 2 --out "$out" --format cvs "$deck" && says "unknown format 'cvs' (did you mean 'csv'?)" && absent "$out" &&
    run 2 --out "$out" --format=xml "$deck" && says "unknown format 'xml'; --format is plain, csv or csv-only" && absent "$out"
}

threads_refused() {
  for number in 0 -1 two 1e3 99999999999; do
    run 2 --threads "$number" --out "$out" "$deck" && says "--threads needs a number" && absent "$out" || return 1
  done
}

time_refused() {
  for word in 90 0s 3.5h h 3h50 50m3h 3:50 -1h 1w; do
    run 2 --time-limit "$word" --out "$scratch/limited" "$deck" &&
      says "option --time-limit needs a time such as 3h50m, 90m, 45s or 3:50:00, not '$word'" && absent "$scratch/limited" || return 1
  done
}

time_enough() {
  run 0 --time-limit 2h --out "$scratch/timed" "$deck" && silent && run 0 --time-limit=0:30:00 --check "$deck" && silent
}

out_twice() {
  run 0 --out="$out/deep/er" "$deck" && silent && run 0 --out "$out" "$deck" && same "$out/four" "$out/deep/er/four"
}

default_folder() {
  mkdir -p "$scratch/here"
  (cd "$scratch/here" && run 0 "$deck") && same "$scratch/here/outputs/four" "$out/four"
}

after_two_dashes() {
  motion_deck >"$scratch/-x.deck"
  (cd "$scratch" && run 0 --out dashes -- -x.deck) && [ -s "$scratch/dashes/-x/kinematics.dat" ]
}

# told NAME CARD...: the ledger of a deck with beams
told() {
  name=$1
  shift
  beam_deck "$@" >"$scratch/$name.deck"
  run 0 --stats --out "$out" "$scratch/$name.deck"
}

# Motion alone builds no beam.
stats() {
  run 0 --stats --out "$out" "$deck" && says "four: rows 13, positions 12, kinematic solutions 12" &&
    says "four: computing " && says ", writing " && says ", files " || return 1
  ! says "variants" >/dev/null || { echo "it mentions variants"; return 1; }
  ! grep -q -e 'mass matri' -e link -e started "$scratch/stderr" || { echo "it mentions beams"; return 1; }
}

stats_static() {
  told static "CRANK 0 to 360 step 5" "SPEED 20 40" "EFFECTS static" "REPORT frequencies" || return 1
  says "static: rows 73, positions 72, kinematic solutions 72" && says "geometric stiffness matrices 0" &&
    says "mode shapes 0" && says "skipped geometric stiffness" && says "skipped mode shapes" &&
    says "skipped 1 row: computed already"
}

# A second speed adds no kinematics and no matrices but geometric ones: none for it alone either.
stats_speeds() {
  told speeds "CRANK 0 to 355 step 5" "SPEED 20" "REPORT frequencies" || return 1
  one=$(sed -n 's/.*\(positions [0-9]*\), \(kinematic solutions [0-9]*\)$/\1 \2/p; s/.*\(link models .*\)/\1/p' "$scratch/stderr")
  told speeds "CRANK 0 to 355 step 5" "SPEED 20 25" "REPORT frequencies" && says "of 1 more speed" || return 1
  two=$(sed -n 's/.*\(positions [0-9]*\), \(kinematic solutions [0-9]*\)$/\1 \2/p; s/.*\(link models .*\)/\1/p' "$scratch/stderr")
  [ -n "$one" ] && [ "$one" = "$two" ] || { echo "$one; with two speeds $two"; return 1; }
}

stats_shapes() {
  told shapes "CRANK 0 to 355 step 5" "MODES 4" "REPORT shapes crank=0,90" && says "mode shapes 8" || return 1
  ! grep -q "skipped mode shapes" "$scratch/stderr" || { echo "it mentions skipped shapes"; return 1; }
}

# By hand, four positions away from dead points: each with a mass matrix for the continuous links and one for the mesh, and
# orders are tried at one position, then at all four. One geometric matrix with each: the one unit load of a constant speed.
stats_counted() {
  told counted "CRANK 10 70 130 190" "SPEED 2 4" "REPORT frequencies" || return 1
  says "counted: rows 4, positions 4, kinematic solutions 4" &&
    says "mass matrices 13, stiffness matrices 0, geometric stiffness matrices 13" && says "no mode is missing 26,"
}

# near_dead_point NAME CARD...: a double rocker whose crank turns back at 107.75 degrees
near_dead_point() {
  name=$1
  shift
  beam_deck "$@" | sed 's/=279.4/=150/; s/=266.7/=150/; s/^MESH.*/MESH * accuracy=1e-6/; s/lumped/distributed/' >"$scratch/$name.deck"
  run 0 --stats --out "$out" "$scratch/$name.deck"
}

# By hand: a position away from the limit and one beside it, there once more with the lengths as they are and with each of the
# three changed; orders are tried at one position, then at both, and that is enough.
stats_near_dead_point() {
  near_dead_point rest "CRANK 90 107.5" "REPORT frequencies" || return 1
  says "rest: rows 2, positions 2, kinematic solutions 6" &&
    says "mass matrices 9, stiffness matrices 0, geometric stiffness matrices 0" && says "no mode is missing 5," || return 1
  # Changed lengths for each of two speeds: 1 + 2*4. Two eigenproblems for each mass matrix but these eight.
  near_dead_point moving "CRANK 107.5" "SPEED 0.001 0.002" "REPORT frequencies" || return 1
  says "moving: rows 1, positions 1, kinematic solutions 9" || return 1
  mass=$(sed -n 's/.*mass matrices \([0-9]*\),.*/\1/p' "$scratch/stderr")
  proofs=$(sed -n 's/.*is missing \([0-9]*\),.*/\1/p' "$scratch/stderr")
  [ $((2*(mass - 8))) -eq "$proofs" ] || { echo "$mass mass matrices, $proofs proofs"; return 1; }
}

# By hand: 12 positions, 5 drawings, and the start of a motion.
stats_studies() {
  motion_deck >"$scratch/studies.deck"
  cat >>"$scratch/studies.deck" <<END_OF_CARDS
REPORT geometry crank=10,20,30,40,50
REPORT motion crank=60 speed=5 end=1 step=0.5
PINMASS A 1kg
PINMASS B 1kg
INERTIA distributed
END_OF_CARDS
  sed 's/length=[0-9.]*/& mass=1kg inertia=1kg*mm2/' "$scratch/studies.deck" >"$scratch/studied.deck"
  run 0 --stats --out "$out" "$scratch/studied.deck" && says "studied: rows 13, positions 12, kinematic solutions 18"
}

threads() {
  beam_deck "CRANK 0 to 360 step 5" "SPEED 0 10 20" "REPORT frequencies" "REPORT shapes" "REPORT inertia" >"$scratch/beam.deck"
  for number in 1 3 8; do
    # Status 1: some rows of inputs/study.deck cannot be computed.
    run 1 --quiet --threads $number --out "$out/$number" "$scratch/beam.deck" $(quick_inputs) && same "$out/1" "$out/$number" || return 1
  done
}

# One line on standard output after a run; none with --quiet, --json and --check.
success() {
  motion_deck >"$scratch/told.deck"
  (cd "$scratch" && run 0 told.deck) && silent || return 1
  [ "$(cat "$scratch/stdout")" = "told: 1 table in outputs/told" ] || { echo "it said: $(cat "$scratch/stdout")"; return 1; }
  run 0 --out "$out" "$scratch/told.deck" && grep -qxF "told: 1 table in $out/told; figures: plots/flexmech-plot $out/told" \
    "$scratch/stdout" || [ "$(wc -l <"$scratch/stdout")" -eq 2 ] || { echo "it said: $(cat "$scratch/stdout")"; return 1; }
  for option in --quiet --check; do
    run 0 $option --out "$out" "$scratch/told.deck" && silent && [ ! -s "$scratch/stdout" ] || { echo "not silent with $option"; return 1; }
  done
  run 0 --json --out "$out" "$scratch/told.deck" && ! grep -q "^told: " "$scratch/stdout" || { echo "it is printed with --json"; return 1; }
}

success_of_frequencies() {
  beam_deck "CRANK 0 90" "REPORT frequencies" | sed 's/^MESH.*/MESH * accuracy=1e-8/; s/lumped/distributed/' >"$scratch/f.deck"
  (cd "$scratch" && run 0 f.deck) || return 1
  grep -qE '^f: 1 table in outputs/f; f1 [0-9.]+ to [0-9.]+ Hz, f3 up to [0-9.]+ Hz, estimated relative error at most [0-9.]+e-[0-9]+$' \
    "$scratch/stdout" || { echo "it said: $(cat "$scratch/stdout")"; return 1; }
  for number in 1 4; do
    run 0 --threads $number --out "$out" "$scratch/f.deck" && cp "$scratch/stdout" "$scratch/told.$number" || return 1
  done
  cmp "$scratch/told.1" "$scratch/told.4"
}

# Installed beside flexmech-plot, it names that; called by its name, as the user would call the other.
success_installed() {
  mkdir -p "$scratch/bin dir"
  cp "$program" "$scratch/bin dir/flexmech"
  : >"$scratch/bin dir/flexmech-plot"
  (cd "$scratch" && "$scratch/bin dir/flexmech" four.deck >stdout && PATH="$scratch/bin dir:$PATH" flexmech four.deck >>stdout)
  printf "%s\n" "four: 1 table in outputs/four; figures: '$scratch/bin dir/flexmech-plot' outputs/four" \
    "four: 1 table in outputs/four; figures: flexmech-plot outputs/four" >"$scratch/expected"
  tr '\n' ' ' <"$scratch/stdout" | sed 's/ four: figures/; figures/g' >"$scratch/found"
  tr '\n' ' ' <"$scratch/expected" | cmp - "$scratch/found"
}

nobody_listens() {
  (cd "$scratch" && "$program" --out "$out/deaf" four.deck >&-) && [ -s "$out/deaf/four/kinematics.dat" ]
}

# A device that is always full stands for the disk.
full_output() {
  for option in --help --help-cards --version --man "--completion bash" "--json $deck" "--check --json $deck" "$deck"; do
    "$program" --out "$out/full" $option >/dev/full 2>"$scratch/stderr"
    [ $? -eq 2 ] && says "flexmech: error: standard output cannot be written: No space left on device" || { echo "$option"; return 1; }
  done
}

check "--help explains every option" help
check "--version" version
check "--check of a good deck writes nothing" check_only
check "--check of a bad deck" check_refuses
check "an unknown option" unknown_option
check "no deck" eval 'run 2 && says "no deck given" && run 2 --check && says "no deck given"'
check "an option without its value" value_missing
check "an option with two values" value_twice
check "an unknown format" format_unknown
check "--threads with no number" threads_refused
check "--out and --out=, folders that are not there" out_twice
check "outputs/ is the default" default_folder
check "a deck after --" after_two_dashes
check "--stats: motion alone" stats
check "--stats: static frequencies" stats_static
check "--stats: more speeds" stats_speeds
check "--stats: shapes" stats_shapes
check "--stats: work counted by hand" stats_counted
check "--stats: poses with changed lengths" stats_near_dead_point
check "--stats: poses of studies" stats_studies
check "a time limit that is none" time_refused
check "a time limit that is far" time_enough
check "the same bytes for any number of threads" threads
check "the line after a run" success
check "the line after a run with frequencies" success_of_frequencies
check "the command for figures that is installed" success_installed
check "standard output that is closed" nobody_listens
check "standard output on a full disk" full_output
