#!/bin/sh
# Variants that cannot be computed: failed rows with their reasons, never the end of the study. When all fail, nothing is written.
. tests/scripts/functions.sh

out=$scratch/out

# varied CARD...: a deck whose coupler has the length $b.
varied() {
  beam_deck "$@" | sed 's/length=279.4/length=$b/'
}

# Sound, wrong, out of reach, wrong in another way, sound.
varied "VARY b 280 -9 900 0 270" "SPEED 0 2" "CRANK 0 90" "REPORT kinematics" "REPORT frequencies" "REPORT linkage" >"$scratch/some.deck"
varied "VARY b 280 270" "SPEED 0 2" "CRANK 0 90" "REPORT kinematics" "REPORT frequencies" "REPORT linkage" >"$scratch/sound.deck"

# same_rows FOLDER FOLDER: the same rows of numbers, in their order.
same_rows() {
  for table in kinematics frequencies linkage; do
    for folder in "$1" "$2"; do
      grep -v -e '^#' -e '^$' "$folder/$table.dat"
      sed '1d; /"/d' "$folder/$table.csv"
    done >"$scratch/rows"
    lines=$(($(wc -l <"$scratch/rows")/2))
    [ $lines -gt 2 ] && head -n $lines "$scratch/rows" >"$scratch/one" && tail -n $lines "$scratch/rows" | cmp - "$scratch/one" ||
      { echo "rows of $table"; return 1; }
  done
}

some_fail() {
  run 1 --out "$out" --format csv "$scratch/some.deck" || return 1
  says "some.deck: error: b=-9: 'length=' must be greater than 0, not -9" && says "some.deck: error: b=0: " &&
    says "some.deck:7:32: warning: in 2 of 5 variants, the first with b=-9: rows will be marked as failed: 'length=' must be" &&
    says "note: '\$b' is set here" || return 1
  [ "$(grep -c warning: "$scratch/stderr")" -eq 2 ] || { echo "$(grep -c warning: "$scratch/stderr") warnings"; return 1; }
  for table in kinematics frequencies linkage; do
    [ "$(grep -c "^# failed b=-9 : 'length=' must be greater than 0, not -9$" "$out/some/$table.dat")" -eq 1 ] || { echo "$table.dat"; return 1; }
    [ "$(grep -c '^-9,,,.*"'"'length=' must be" "$out/some/$table.csv")" -eq 1 ] || { echo "$table.csv"; return 1; }
  done
  python3 -B - "$out/some/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    summary = json.load(file)
assert summary["exit_status"] == 1 and summary["counts"]["variants"] == 5, summary["counts"]
found = [(f["parameters"]["b"], f["stage"], f["speed"], f["crank"]) for f in summary["failures"]]
assert found == [(-9, "variant", None, None), (900, "variant", None, None), (0, "variant", None, None)], found
assert summary["failures"][2]["reason"] == "'length=' must be greater than 0, not 0" and summary["more_failures"] == 0
assert [w["variants"] for w in summary["warnings"]] == [2, 1], summary["warnings"]
END_OF_PYTHON
}
check "variants with wrong values are failed rows" some_fail

sound_rows() {
  run 0 --quiet --out "$scratch/plain" --format csv "$scratch/sound.deck" && same_rows "$out/some" "$scratch/plain/sound"
}
check "the others have the rows that they have alone" sound_rows

threads_change_nothing() {
  for threads in 1 2 3; do
    run 1 --quiet --out "$scratch/threads" --threads $threads --format csv "$scratch/some.deck" && same "$out/some" "$scratch/threads/some" || return 1
  done
}
check "for any number of threads" threads_change_nothing

# Heads of tables and log are those of the first that is computed, and so are the files of --format csv-only.
first_fail() {
  sed 's/^VARY.*/VARY b -9 0 280 900 270/' "$scratch/some.deck" >"$scratch/first.deck"
  for threads in 1 2; do
    run 1 --out "$scratch/first$threads" --threads $threads --format csv "$scratch/first.deck" || return 1
  done
  same "$scratch/first1" "$scratch/first2" && same_rows "$scratch/first1/first" "$scratch/plain/sound" || return 1
  for table in kinematics frequencies linkage; do
    [ "$(grep -n '^# failed' "$scratch/first1/first/$table.dat" | head -n 1 | sed 's/.*failed //; s/ :.*//')" = "b=-9" ] || { echo "$table"; return 1; }
    sed '/^# failed/,$d' "$scratch/first1/first/$table.dat" >"$scratch/head"
    sed '/^ /,$d' "$scratch/plain/sound/$table.dat" | cmp - "$scratch/head" || return 1
  done
  grep -q "^first computed of 5 variants, b=280:$" "$scratch/first1/first/run.log" || { echo "the log"; return 1; }
  run 1 --quiet --out "$scratch/only" --format csv-only "$scratch/first.deck" &&
    cmp "$scratch/only/first/frequencies.csv" "$scratch/first1/first/frequencies.csv" && absent "$scratch/only/first/frequencies.dat"
}
check "the first variants fail" first_fail

echo_again() {
  cp "$scratch/first1/first/echo.deck" "$scratch/first.deck"
  run 1 --out "$scratch/again" --format csv "$scratch/first.deck" && same_tables "$scratch/first1/first" "$scratch/again/first"
}
check "the echo gives the same tables, failed rows too" echo_again

# Long variants are computed one after the other, each by all threads.
long_variants() {
  { beam_deck | sed '/^MESH/d; s/length=100 /length=$a /'; echo "CRANK 0 to 359.9 step 0.1"; echo "SPEED 0 to 30 step 1"
    echo "VARY a -1 100 0"; echo "REPORT kinematics"; } | sed '/^INERTIA/d' >"$scratch/long.deck"
  run 1 --out "$scratch/long" --threads 2 --format csv-only "$scratch/long.deck" && says "error: a=-1: " && says "error: a=0: " || return 1
  [ "$(cut -d , -f 1 "$scratch/long/long/kinematics.csv" | uniq -c | awk '{ print $1 }' | tr '\n' ' ')" = "1 1 111600 1 " ] ||
    { echo "rows of long variants"; return 1; }
  grep -q "^first computed of 3 variants, a=100:$" "$scratch/long/long/run.log" || { echo "the log"; return 1; }
}
check "long variants that fail" long_variants

all_are_wrong() {
  sed 's/^VARY.*/VARY b -9 -10 0/' "$scratch/some.deck" >"$scratch/wrong.deck"
  run 2 --out "$scratch/nothing" "$scratch/wrong.deck" && says "wrong.deck:7:32: error: 'length=' must be greater than 0, not -9" &&
    absent "$scratch/nothing" || return 1
  says "error: 3 of 3 variants are refused, the first one with b=-9" || return 1
  [ "$(grep -c error: "$scratch/stderr")" -eq 2 ] || { echo "more than the first error and their number"; return 1; }
}
check "all variants are wrong: the deck is refused" all_are_wrong

# A misspelt name is told at once, however many variants there are.
misspelt() {
  sed 's/^VARY.*/VARY b 1 to 1000000 step 1/; s/material=steel/material=stele/' "$scratch/some.deck" >"$scratch/many.deck"
  run 2 --out "$scratch/nothing" "$scratch/many.deck" && says "unknown material 'stele'" && absent "$scratch/nothing" || return 1
  [ "$(grep -c error: "$scratch/stderr")" -eq 3 ] || { echo "not three errors"; return 1; }
}
check "what is wrong in all variants is told at once" misspelt

# A parallelogram has no forces at 180 degrees, of whatever length: no check knows, and all variants fail at all positions.
all_fail_at_run_time() {
  motion_deck 180 | sed 's/length=279.4/length=254/; s/length=100$/length=$a/; s/length=266.7/length=$a/; s/^LINK .*/& mass=1 inertia=1/; s/^REPORT .*/REPORT reactions/' >"$scratch/dead.deck"
  echo "VARY a 90 100 110" >>"$scratch/dead.deck"
  run 0 --quiet --check "$scratch/dead.deck" && run 2 --out "$scratch/nothing" "$scratch/dead.deck" &&
    says "dead.deck: error: none of the 3 variants could be computed; a=90, crank 180 deg: change point" && absent "$scratch/nothing" || return 1
  run 2 --json --quiet --out "$scratch/nothing" "$scratch/dead.deck"
  python3 -B - "$scratch/stdout" <<'END_OF_PYTHON' || return 1
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    document = json.load(file)
assert document["exit_status"] == document["decks"][0]["exit_status"] == 2, document
assert "none of the 3 variants" in document["decks"][0]["errors"][0]["message"], document
END_OF_PYTHON
  # Results of before stay as they were.
  sed 's/^CRANK.*/CRANK 90 180/' "$scratch/dead.deck" >"$scratch/alive.deck"
  mkdir -p "$scratch/kept" && cp "$scratch/alive.deck" "$scratch/kept/dead.deck" && run 1 --quiet --out "$scratch/kept/out" "$scratch/kept/dead.deck" &&
    cp -r "$scratch/kept/out" "$scratch/kept/before" && run 2 --quiet --out "$scratch/kept/out" "$scratch/dead.deck" &&
    same "$scratch/kept/before" "$scratch/kept/out"
}
check "all variants fail when they are computed: nothing is written" all_fail_at_run_time

# Killed among variants that fail and some that do not; the rest is computed on another number of threads.
resumed() {
  varied "VARY b -400 to 300 step 0.2" "CRANK 0 to 350 step 10" "REPORT frequencies" | sed '/^MESH/d' >"$scratch/resumed.deck"
  awaited="$scratch/killed/resumed/resume.part" interrupted KILL "$scratch/killed" "$scratch/resumed.deck" --quiet || return 1
  run 1 --resume --threads 2 --out "$scratch/killed" "$scratch/resumed.deck" && says "resumed with" &&
    run 1 --quiet --out "$scratch/whole" "$scratch/resumed.deck" && same "$scratch/whole" "$scratch/killed"
}
check "a killed run with variants that fail is resumed" resumed

# no_growth NAME STATUS: 5,700 variants more of the decks NAME300 and NAME6000; with 350 bytes of each they would take 2 MB.
no_growth() {
  python3 -B - "$program" "$scratch" "$@" <<'END_OF_PYTHON'
import os, subprocess, sys
program, scratch, name, expected = sys.argv[1:]
peaks = []
for count in 300, 6000:
    child = subprocess.Popen([program, "--quiet", "--out", os.path.join(scratch, "out"), os.path.join(scratch, f"{name}{count}.deck")],
                             stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    assert os.waitstatus_to_exitcode(status) == int(expected)
    peaks.append(usage.ru_maxrss)
assert peaks[1] - peaks[0] < 2000, f"memory of 300 and 6000 variants: {peaks} kB"
END_OF_PYTHON
}

# Failures are kept up to a thousand, and memory does not grow with them.
many_fail() {
  for count in 300 6000; do
    motion_deck 0 | sed 's/length=279.4/length=$b/; s/REPORT.*/REPORT linkage/' >"$scratch/many$count.deck"
    echo "VARY b -$count to 300 step 1" >>"$scratch/many$count.deck"
  done
  run 1 --json --out "$out" "$scratch/many6000.deck" && says "5981 more failures; run.log lists the first 1000, the tables mark all" || return 1
  python3 -B - "$scratch" <<'END_OF_PYTHON' || return 1
import json, os, sys
scratch, = sys.argv[1:]
folder = os.path.join(scratch, "out", "many6000")
with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
    summary = json.load(file)
failures = summary["counts"]["failures"]
assert failures > 6000 and len(summary["failures"]) == 1000 and summary["more_failures"] == failures - 1000, failures
with open(os.path.join(scratch, "stdout"), encoding="utf-8") as file:
    deck, = json.load(file)["decks"]
assert len(deck["failures"]) == 1000 and deck["more_failures"] == failures - 1000
with open(os.path.join(folder, "run.log"), encoding="utf-8") as file:
    log = file.read()
assert log.endswith(f"… and {failures - 1000} more: they are marked in the tables\n"), log[-200:]
with open(os.path.join(folder, "linkage.dat"), encoding="utf-8") as file:
    assert sum(line.startswith("# failed ") for line in file) == failures
END_OF_PYTHON
  no_growth many 1
}
check "failures beyond the first thousand are counted" many_fail

many_sound() {
  for count in 300 6000; do
    motion_deck 0 90 | sed 's/length=279.4/length=$b/; s/REPORT.*/REPORT kinematics/' >"$scratch/sound$count.deck"
    echo "VARY b 270 to 27$((count/1000)).$((count/100%10)) step 0.001" >>"$scratch/sound$count.deck"
  done
  no_growth sound 0
}
check "memory does not grow with variants" many_sound
