#!/bin/sh
# --part and --join: a study computed in parts gives the bytes of a run in one piece; parts that are not those of the study are refused.
. tests/scripts/functions.sh

# The first variants do not close at all positions.
study() {
  beam_deck "VARY b $1" "CRANK 0 to 330 step 30" "SPEED 0 20" "REPORT frequencies" "REPORT kinematics" | sed 's/length=279.4/length=$b/'
}
study "100 to 185 step 5" >"$scratch/my.deck"
deck=$scratch/my.deck
for form in plain csv; do
  run 1 --out "$scratch/$form" --format "$form" "$deck"
  cp "$scratch/stdout" "$scratch/$form.stdout"
  cp "$scratch/stderr" "$scratch/$form.stderr"
done

# part OUT PART OPTION...: computes a part; some have failed rows.
part() {
  folder=$1
  which=$2
  shift 2
  "$program" --out "$folder" --part "$which" "$@" "$deck" >"$scratch/stdout" 2>"$scratch/stderr"
  found=$?
  [ $found -le 1 ] || { echo "part $which ended with status $found"; cat "$scratch/stderr"; return 1; }
}

# all_parts OUT COUNT OPTION...
all_parts() {
  where=$1
  count=$2
  shift 2
  for k in $(seq "$count"); do
    part "$where" "$k/$count" "$@" || return 1
  done
}

# joins OUT FORM: to the files of the run in one piece, and what that run said.
joins() {
  run 1 --out "$1" --format "$2" --join "$deck" || return 1
  cmp "$scratch/stderr" "$scratch/$2.stderr" || return 1
  sed "s|$1/my|$scratch/$2/my|g" "$scratch/stdout" | cmp - "$scratch/$2.stdout" || return 1
  diff -rq -x '*.part*of*' "$1/my" "$scratch/$2/my"
}

in_parts() {
  rm -rf "$scratch/out"
  all_parts "$scratch/out" "$1" --threads "$2" || return 1
  joins "$scratch/out" plain && joins "$scratch/out" csv || return 1
  # They stay.
  [ "$(ls "$scratch/out/my" | grep -c 'part.*of')" -eq "$1" ] || { echo "parts are gone"; return 1; }
}
for count in 1 2 3 7 16 18; do
  check "$count parts on one thread" in_parts "$count" 1
done
check "7 parts on two threads" in_parts 7 2

line() {
  rm -rf "$scratch/line"
  part "$scratch/line" 5/16 && [ "$found" -eq 0 ] || { echo "status $found"; return 1; }
  echo "my: part 5 of 16, variant 5, in $scratch/line/my/my.part05of16" | cmp - "$scratch/stdout" || return 1
  [ "$(ls "$scratch/line/my")" = my.part05of16 ] || { ls "$scratch/line/my"; return 1; }
  part "$scratch/line" 1/2 && [ "$found" -eq 1 ] || { echo "status $found"; return 1; }
  echo "my: part 1 of 2, variants 1 to 9, in $scratch/line/my/my.part1of2" | cmp - "$scratch/stdout" || return 1
  says "my.deck: error: b=100, crank 0 deg: out of reach"
}
check "what a part says" line

quiet_part() {
  part "$scratch/line" 2/2 --quiet && silent && [ ! -s "$scratch/stdout" ]
}
check "a part says nothing with --quiet" quiet_part

document() {
  part "$scratch/line" 1/2 --json && python3 -c '
import json, sys
document = json.load(open(sys.argv[1]))
assert document["exit_status"] == 1, document["exit_status"]
assert document["decks"][0]["failures"], "no failures"' "$scratch/stdout"
}
check "--json of a part" document

normal_run() {
  rm -rf "$scratch/beside"
  all_parts "$scratch/beside" 3 || return 1
  touch "$scratch/beside/my/my.part1of9.resume"
  cp -r "$scratch/beside/my" "$scratch/beside/kept"
  run 1 --out "$scratch/beside" "$deck" || return 1
  diff -rq -x '*.part*' "$scratch/beside/my" "$scratch/plain/my" || return 1
  for file in "$scratch"/beside/kept/*; do
    cmp "$file" "$scratch/beside/my/${file##*/}" || return 1
  done
}
check "a run in one piece does not touch parts" normal_run

several() {
  motion_deck | sed 's/length=100/length=$a/; $aVARY a 90 to 100 step 2' >"$scratch/other.deck"
  run 0 --out "$scratch/whole" "$scratch/other.deck" || return 1
  rm -rf "$scratch/two"
  for k in 1 2; do
    run $((2 - k)) --out "$scratch/two" --part $k/2 "$deck" "$scratch/other.deck" || return 1
  done
  run 1 --out "$scratch/two" --join "$deck" "$scratch/other.deck" || return 1
  diff -rq -x '*.part*' "$scratch/two/my" "$scratch/plain/my" && diff -rq -x '*.part*' "$scratch/two/other" "$scratch/whole/other"
}
check "parts of several decks" several

# A byte of a part that is another one: its variant is computed again.
changed_byte() {
  cp -r "$scratch/two" "$scratch/changed"
  python3 -B - "$scratch/changed/my/my.part2of2" <<'END_OF_JOB' || return 1
import sys
with open(sys.argv[1], "r+b") as part:
    part.seek(0, 2)
    place = part.tell()*3//4
    part.seek(place)
    byte = part.read(1)
    part.seek(place)
    part.write(bytes([byte[0] ^ 4]))
END_OF_JOB
  run 1 --out "$scratch/changed" --join "$deck" && diff -rq -x '*.part*' "$scratch/changed/my" "$scratch/plain/my"
}
check "a part with a changed byte" changed_byte

set_instead() {
  run 2 --set b=150 --out "$scratch/set" --part 1/1 "$deck" && says "my.deck: error: a deck without VARY has no parts" && absent "$scratch/set"
}
check "--set instead of VARY" set_instead

# The variants of whole parts have wrong values; what heads of tables are made of is in another part.
wrong_values() {
  mkdir -p "$scratch/wrong"
  study 279.4 | sed "s/thickness=1.6/thickness=\$t/; s/^VARY .*/VARY t $1/; s/=\$b/=279.4/" >"$scratch/wrong/my.deck"
  run 1 --out "$scratch/wrong/whole" "$scratch/wrong/my.deck" || return 1
  for k in 1 2 3 4; do
    run "$2" --out "$scratch/wrong/out" --part $k/4 "$scratch/wrong/my.deck" || return 1
    shift
  done
  run 1 --out "$scratch/wrong/out" --join "$scratch/wrong/my.deck" && diff -rq -x '*.part*' "$scratch/wrong/out/my" "$scratch/wrong/whole/my"
}
all_wrong() {
  sed -i 's/^VARY .*/VARY t -2 to -1 step 0.25/' "$scratch/wrong/my.deck"
  run 2 --out "$scratch/none" --part 1/4 "$scratch/wrong/my.deck" && absent "$scratch/none"
}
check "parts with wrong values only" wrong_values "-1.5 to 1.5 step 0.25" 1 1 1 0
check "parts with wrong values only at the end" wrong_values "2.5 1.5 to -1.5 step -0.25" 0 0 1 1
check "a study of wrong values only" all_wrong

# A part is checked for itself.
own_warnings() {
  part "$scratch/line" 1/6 && says "1 position of 12 out of reach" || return 1
  part "$scratch/line" 6/6 || return 1
  ! says "out of reach" >/dev/null || { echo "it does"; return 1; }
}
check "a part does not warn of the variants of others" own_warnings

# From here on: a study that takes some seconds, to be stopped.
mkdir "$scratch/long"
study "185 to 300 step 0.05" >"$scratch/long/my.deck"

# stopped SIGNAL: part 2 of 3 is sent a signal once its file has grown, and leaves only what --resume goes on from.
stopped() {
  rm -rf "$scratch/killed"
  awaited=$scratch/killed/my/my.part2of3.resume
  export awaited
  interrupted "$1" "$scratch/killed" "$scratch/long/my.deck" --part 2/3 --threads 2 || return 1
  unset awaited
  [ "$(ls "$scratch/killed/my")" = my.part2of3.resume ] || { ls "$scratch/killed/my"; return 1; }
}
resumed_part() {
  run 0 --out "$scratch/killed" --part 2/3 --resume "$scratch/long/my.deck" || return 1
  says "my.deck: resumed with " && says " from an earlier run" || return 1
  [ "$(ls "$scratch/killed/my")" = my.part2of3 ] || { ls "$scratch/killed/my"; return 1; }
}
killed_part() {
  stopped KILL && { printf 'torn' >>"$scratch/killed/my/my.part2of3.resume"; resumed_part; }
}
told_part() {
  stopped TERM && says "my.deck: interrupted; its earlier results are untouched; --resume continues from what it has computed" &&
    resumed_part
}
# A limit that strikes again and again, until the part is complete: then its status is not 130. A busy machine takes longer than a second
# to check the deck, and is given more time.
limited_part() {
  rm -rf "$scratch/killed"
  times=0
  seconds=1
  while :; do
    "$program" --out "$scratch/killed" --part 2/3 --resume --time-limit ${seconds}s "$scratch/long/my.deck" >"$scratch/stdout" 2>"$scratch/stderr"
    found=$?
    [ $found -eq 130 ] || break
    if says "flexmech: stopped at its time limit of ${seconds}s: reading and checking took" >/dev/null; then
      seconds=$((2*seconds))
    else
      says "my.deck: stopped at its time limit of ${seconds}s; its earlier results are untouched" || return 1
    fi
    times=$((times + 1))
    [ $times -lt 300 ] || return 1
  done
  [ $found -eq 0 ] || { cat "$scratch/stderr"; return 1; }
}
join_long() {
  cp "$scratch/others/my/my.part1of3" "$scratch/others/my/my.part3of3" "$scratch/killed/my"
  run 0 --out "$scratch/killed" --join "$scratch/long/my.deck" && diff -rq -x '*.part*' "$scratch/killed/my" "$scratch/longest/my"
}
run 0 --out "$scratch/others" --part 1/3 --threads 2 "$scratch/long/my.deck"
run 0 --out "$scratch/others" --part 3/3 --threads 2 "$scratch/long/my.deck"
run 0 --out "$scratch/longest" --threads 2 "$scratch/long/my.deck"
check "a killed part goes on" eval 'killed_part && join_long'
check "a part that was sent SIGTERM goes on" eval 'told_part && join_long'
check "a part with a time limit goes on" eval 'limited_part && join_long'

again() {
  cp "$scratch/killed/my/my.part2of3" "$scratch/complete"
  run 0 --out "$scratch/killed" --part 2/3 --resume "$scratch/long/my.deck" || return 1
  says "my.deck: resumed with " && cmp "$scratch/complete" "$scratch/killed/my/my.part2of3"
}
check "a complete part is not computed again with --resume" again

# refused WORDS ARGUMENT...: status 2, nothing written.
refused() {
  words=$1
  shift
  before=$(cd "$scratch/out/my" && ls -l --time-style=full-iso)
  run 2 --out "$scratch/out" "$@" || return 1
  says "$words" || return 1
  [ "$before" = "$(cd "$scratch/out/my" && ls -l --time-style=full-iso)" ] || { echo "something was written"; return 1; }
}
bad_words() {
  for word in 0/16 17/16 3 a/b 3/ /16 -1/4 1/0 3/16/2; do
    refused "option --part needs the number of a part and that of all parts, as in --part 3/16, not '$word'" --part "$word" "$deck" ||
      return 1
  done
}
contradictions() {
  refused "options --part and --join exclude each other" --part 1/2 --join "$deck" &&
    refused "option --resume has no meaning with --join" --join --resume "$deck" &&
    refused "option --format has no meaning with --part" --part 1/2 --format csv "$deck" &&
    refused "option --part is given twice" --part 1/2 --part 2/2 "$deck"
}
check "what is no part" bad_words
check "options that contradict each other" contradictions

rm -rf "$scratch/out"
mkdir -p "$scratch/out/my"
no_part() {
  refused "my.deck: error: there is no part of it in $scratch/out/my; flexmech --part 1/16 $deck computes the first of 16" --join "$deck"
}
check "no part at all" no_part

no_vary() {
  motion_deck >"$scratch/one.deck"
  refused "one.deck: error: a deck without VARY has no parts" --part 1/2 "$scratch/one.deck" &&
    refused "one.deck: error: a deck without VARY has no parts" --join "$scratch/one.deck" &&
    refused "one.deck: error: a deck without VARY has no parts" --check --part 1/2 "$scratch/one.deck"
}
check "a deck without VARY" no_vary

too_many() {
  refused "my.deck: error: there are 19 parts and only 18 variants" --part 1/19 "$deck"
}
check "more parts than variants" too_many

# Nothing of any deck is begun when one of them cannot be computed.
one_of_two() {
  refused "one.deck: error: a deck without VARY has no parts" --part 1/2 "$deck" "$scratch/one.deck"
}
check "one of two decks" one_of_two

all_parts "$scratch/out" 16
gaps() {
  mv "$scratch/out/my/my.part05of16" "$scratch/out/my/my.part07of16" "$scratch"
  refused "my.deck: error: parts 5 and 7 of 16 are missing: run flexmech --part 5/16 $deck, flexmech --part 7/16 $deck" --join "$deck" ||
    return 1
  mv "$scratch/my.part05of16" "$scratch/out/my"
  touch "$scratch/out/my/my.part07of16.resume"
  refused "my.deck: error: part 7 of 16 is missing: run flexmech --resume --part 7/16 $deck" --join "$deck" || return 1
  rm "$scratch/out/my/my.part07of16.resume"
  mkdir "$scratch/aside"
  mv "$scratch"/out/my/my.part0[1-6]of16 "$scratch/out/my/my.part12of16" "$scratch/aside"
  refused "my.deck: error: parts 1 to 7 and 12 of 16 are missing: run flexmech --part 1/16 $deck, " --join "$deck" || return 1
  mv "$scratch"/aside/* "$scratch/my.part07of16" "$scratch/out/my"
}
check "missing parts" gaps

mixture() {
  part "$scratch/out" 2/8 && part "$scratch/out" 7/8 || return 1
  refused "my.deck: error: beside all 16 parts of one division there are others: remove my.part2of8, my.part7of8 from" --join "$deck" || return 1
  mv "$scratch/out/my/my.part05of16" "$scratch"
  refused "there are parts of several divisions in $scratch/out/my, 15 of 16, 2 of 8: remove those that are not to be joined" --join \
    "$deck" || return 1
  mv "$scratch/my.part05of16" "$scratch/out/my"
  rm "$scratch"/out/my/my.part?of8
}
check "parts of two divisions" mixture

# instead COMMAND...: in the place of part 3, which is put back.
instead() {
  cp "$scratch/out/my/my.part03of16" "$scratch/kept.part"
  words=$1
  shift
  "$@" "$scratch/out/my/my.part03of16"
  refused "$scratch/out/my/my.part03of16: error: $words" --join "$deck"
  outcome=$?
  cp "$scratch/kept.part" "$scratch/out/my/my.part03of16"
  return $outcome
}
of_another_deck() {
  mkdir -p "$scratch/changed"
  study "100 to 185 step 5" | sed 's/thickness=1.6/thickness=1.7/' >"$scratch/changed/my.deck"
  "$program" --out "$scratch/changed" --part 3/16 "$scratch/changed/my.deck" >"$scratch/stdout" 2>&1
  cp "$scratch/changed/my/my.part03of16" "$1"
}
of_other_version() {
  # The version is at the start, after the length of the title.
  printf '9' | dd of="$1" bs=1 seek=4 conv=notrunc 2>"$scratch/dd.told"
}
cut_off() {
  truncate -s -5 "$1"
}
cut_to() {
  truncate -s 10 "$1"
}
longer() {
  printf 'x' >>"$1"
}
no_journal() {
  head -c 3000 "$program" >"$1"
}
other_part() {
  cp "$scratch/out/my/my.part04of16" "$1"
}
# All blocks but the last: what is there is whole.
last_block_gone() {
  python3 - "$1" <<'END_OF_PROGRAM'
import struct, sys
data = open(sys.argv[1], "rb").read()
at = ends = 4 + struct.unpack("i", data[:4])[0]
while at < len(data):
    ends, at = at, at + 32 + struct.unpack("4i", data[at:at + 16])[2]
open(sys.argv[1], "wb").write(data[:ends])
END_OF_PROGRAM
}
check "a part of another deck" instead "this part is of another deck than $deck, or of other values of --set" of_another_deck
check "a part of another version" instead "this part was computed by another version of the program: " of_other_version
check "a part that was cut off" instead "this part is damaged: it ends before its last variant does; compute it again" cut_off
check "a part that was cut off at a block" instead "this part has no variant 3: it is damaged" last_block_gone
check "a part with something behind it" instead "this part is damaged" longer
check "a part without a start" instead "this is no part of a study, or its start is damaged" cut_to
check "a file of something else" instead "this is no part of a study, or its start is damaged" no_journal
check "a part under another part's name" instead "this part has no variant 3: it is damaged, or another part has been given its name" other_part

other_values() {
  mkdir -p "$scratch/values"
  study "100 to 185 step 5" | sed 's/thickness=1.6/thickness=$t/; 1aSET t 1.6' >"$scratch/values/my.deck"
  for k in 1 2; do
    "$program" --out "$scratch/values/out" --set "t=1.$k" --part $k/2 "$scratch/values/my.deck" >"$scratch/stdout" 2>&1
  done
  run 2 --out "$scratch/values/out" --set t=1.1 --join "$scratch/values/my.deck" &&
    says "my.part2of2: error: this part is of another deck than $scratch/values/my.deck, or of other values of --set" || return 1
  "$program" --out "$scratch/values/out" --set t=1.1 --part 2/2 "$scratch/values/my.deck" >"$scratch/stdout" 2>&1
  run 1 --out "$scratch/values/out" --set t=1.1 --join "$scratch/values/my.deck" || return 1
  run 1 --out "$scratch/values/whole" --set t=1.1 "$scratch/values/my.deck" || return 1
  diff -rq -x '*.part*' "$scratch/values/out/my" "$scratch/values/whole/my"
}
check "other values of --set" other_values

check "and the parts are still joined" joins "$scratch/out" plain

in_the_way() {
  mkdir -p "$scratch/way/my/my.part1of2.resume"
  run 2 --out "$scratch/way" --part 1/2 "$deck" && says "my.part1of2.resume: error: this is a folder, and a file is to be written there" || return 1
  mv "$scratch/way/my/my.part1of2.resume" "$scratch/way/my/my.part1of2"
  run 2 --out "$scratch/way" --part 1/2 "$deck" && says "my.part1of2: error: this is a folder, and a file is to be written there" || return 1
  rmdir "$scratch/way/my/my.part1of2" "$scratch/way/my"
}
check "a folder in the place of a part" in_the_way

# No time for a single variant; on a busy machine for the check of the deck neither.
no_time() {
  for limit in 1s 10s 100s; do
    run 130 --out "$scratch/soon" --part 1/1 --time-limit $limit "$scratch/endless/my.deck" && absent "$scratch/soon/my/my.part1of1" || return 1
    says "and nothing was computed" >/dev/null || break
  done
  says "my.deck: stopped at its time limit of $limit; its earlier results are untouched"
}
mkdir "$scratch/endless"
study "185 to 300 step 5" | sed 's/^CRANK .*/CRANK 0 to 360 step 0.001/' >"$scratch/endless/my.deck"
check "a part without time" no_time

# The disk is a small tmpfs.
full_disk() {
  run 2 --out "$scratch/disk" --part 1/1 "$deck" || return 1
  says "my.part1of1: error: the file could not be written completely: No space left on device" && absent "$scratch/disk/my/my.part1of1"
}
mkdir "$scratch/disk"
if mount -t tmpfs -o size=64k tmpfs "$scratch/disk" 2>/dev/null; then
  trap 'umount "$scratch/disk"' EXIT
  check "a part that cannot be written completely" full_disk
else
  skip "a part that cannot be written completely" "no file system can be mounted here"
fi
