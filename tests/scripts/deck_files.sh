#!/bin/sh
# Files that are no deck, or hardly one.
. tests/scripts/functions.sh

out=$scratch/out

# refused TEXT DECK
refused() {
  run 2 --out "$out" "$2" && says "$1" && absent "$out"
}

# What a system tells, the program tells.
unreadable() {
  mkdir "$scratch/closed"
  motion_deck >"$scratch/locked.deck"
  motion_deck >"$scratch/closed/in.deck"
  chmod 000 "$scratch/locked.deck" "$scratch/closed"
  for name in locked.deck closed/in.deck; do
    as_somebody "$program" --out "$out" "$scratch/$name"
    [ $? -eq 2 ] && says "$name: error: Permission denied" && absent "$out" || return 1
  done
  chmod 700 "$scratch/closed"
}

unwritable() {
  mkdir "$scratch/closed_out"
  chmod 555 "$scratch/closed_out"
  motion_deck >"$scratch/four.deck"
  as_somebody "$program" --out "$scratch/closed_out" "$scratch/four.deck"
  [ $? -eq 2 ] && says "closed_out/four: error: this folder cannot be created: Permission denied" || return 1
  mkdir "$scratch/full_out"
  run 0 --out "$scratch/full_out" "$scratch/four.deck" || return 1
  cp -r "$scratch/full_out" "$scratch/full_before"
  chmod 555 "$scratch/full_out/four"
  as_somebody "$program" --out "$scratch/full_out" "$scratch/four.deck"
  [ $? -eq 2 ] && says "full_out/four: error: nothing can be written to this folder: Permission denied" && same "$scratch/full_out" "$scratch/full_before" &&
    chmod 755 "$scratch/full_out/four"
}

name_too_long() {
  motion_deck >"$scratch/four.deck"
  long=$(printf '%300s' '' | tr ' ' a)
  run 2 --out "$out/$long" "$scratch/four.deck" && says "File name too long" && absent "$out" && refused "File name too long" "$scratch/$long.deck"
}

# Words of a million characters, which a reader of quadratic cost reads in the better part of an hour.
long_words() {
  head -c 1000000 /dev/zero | tr '\0' a >"$scratch/word"
  for change in "s/DRIVE.*/DRIVE \$@/" "s/length=100/length=1@/" "s/length=100/length=@/" "s/length=100/@=100/" "s/^DRIVE/@/" "s/O2 A/O2 @/" \
    "s/length=100/length=1@/; s/@/@@@/" "s/^CRANK.*/CRANK @/; s/@/@,@,@/"; do
    motion_deck | sed "$change" | awk -v file="$scratch/word" 'BEGIN { getline word <file } { gsub(/@/, word); print }' >"$scratch/long.deck"
    refused "long.deck:" "$scratch/long.deck" || return 1
  done
  motion_deck "$(head -c 200000 /dev/zero | tr '\0' ,) 1" >"$scratch/long.deck" && refused "a value is missing" "$scratch/long.deck" || return 1
  awk 'BEGIN { printf "0.001"; for (i = 2; i < 100000; i++) printf ",%.9g", i*0.001 }' >"$scratch/list"
  motion_deck "$(cat "$scratch/list")" >"$scratch/long.deck" && run 0 --check "$scratch/long.deck"
}

# Ten megabytes, which only a reader of linear cost reads before the tests' limit of time; the awk here only serves to be quick.
large() {
  { motion_deck; awk 'BEGIN { for (i = 0; i < 130000; i++)
    print "! a comment that says nothing, but takes up its eighty characters like the others" }'; } >"$scratch/large.deck"
  run 0 --out "$out" "$scratch/large.deck" && silent || return 1
  motion_deck >"$scratch/small.deck"
  run 0 --out "$out" "$scratch/small.deck" && same_tables "$out/large" "$out/small" && rm -r "$out"
}

garbage() {
  awk 'BEGIN { for (i = 0; i < 130000; i++)
    print "Lorem ipsum dolor sit amet, consectetur = adipiscing elit, sed do eiusmod " i }' >"$scratch/garbage.deck"
  refused "garbage.deck:1:1: error: unknown card 'Lorem'" "$scratch/garbage.deck" && says "more errors" || return 1
  [ "$(wc -l <"$scratch/stderr")" -le 1000 ] || { echo "too many lines"; return 1; }
}

binary() {
  cp "$program" "$scratch/binary.deck"
  refused "does not belong in a text; is this a deck?" "$scratch/binary.deck"
}

zeros() {
  { motion_deck; printf 'a\0b\n'; } >"$scratch/zero.deck"
  refused "zero.deck:10:2: error: byte 0x00" "$scratch/zero.deck"
}

standard_input() {
  motion_deck >"$scratch/four.deck"
  "$program" --out "$out" - <"$scratch/four.deck" >"$scratch/stdout" 2>"$scratch/stderr" && silent &&
    run 0 --out "$out" "$scratch/four.deck" && same_but_names "$out/stdin" "$out/four"
}

# $1 on standard input; the message is $2.
nothing_to_read() {
  eval '"$program" --out "$out" - '"$1" >"$scratch/stdout" 2>"$scratch/stderr"
  [ $? -eq 2 ] && says "<standard input>: error: $2" && absent "$scratch/none"
}

standard_input_refused() {
  motion_deck "0 to 360" | "$program" --check - 2>"$scratch/stderr"
  [ $? -eq 2 ] && says "<standard input>:8:12: error:"
}

# Line ends of other systems, and the mark that some editors put first.
line_ends() {
  motion_deck >"$scratch/four.deck"
  { printf '\357\273\277'; awk '{ printf "%s\r\n", $0 }' "$scratch/four.deck"; } >"$scratch/dos.deck"
  printf '%s' "$(cat "$scratch/four.deck")" >"$scratch/no_end.deck"
  tr '\n' '\r' <"$scratch/four.deck" >"$scratch/mac.deck"
  run 0 --out "$out" "$scratch/four.deck" "$scratch/dos.deck" "$scratch/no_end.deck" "$scratch/mac.deck" && silent || return 1
  for name in dos no_end mac; do
    same_but_names "$out/four" "$out/$name" || return 1
  done
  rm -r "$out"
}

# Umlauts as older editors write them: in tables they are UTF-8.
latin1() {
  { printf 'TITLE F\374r Sch\374ler \200\n'; motion_deck; } >"$scratch/latin1.deck"
  run 0 --out "$out" "$scratch/latin1.deck" && silent && grep -q "^# Für Schüler €$" "$out/latin1/kinematics.dat" || return 1
  rm -r "$out"
}

: >"$scratch/empty.deck"
check "an empty deck" refused "empty.deck:1:1: error: there is no UNITS card" "$scratch/empty.deck"
check "a missing deck" refused "absent.deck: error: no such file" "$scratch/absent.deck"
check "a folder" refused ": error: this is a folder, not a deck" "$scratch"
check "a folder with a slash" refused ": error: this is a folder, not a deck" "$scratch/"
chmod 755 "$scratch"
if as_somebody "$program" --version; then
  check "a deck that may not be read" unreadable
  check "a folder that may not be written to" unwritable
else
  skip "a deck that may not be read" "only root can run the program"
fi
check "a name too long" name_too_long
check "words of a million characters" long_words
check "a binary file" binary
check "a byte that no text has" zeros
check "ten megabytes of a deck" large
check "ten megabytes of garbage" garbage
check "standard input" standard_input
check "an error in standard input" standard_input_refused
check "nothing on standard input" nothing_to_read "</dev/null" "there is nothing on it; expected a deck"
check "no standard input" nothing_to_read "<&-" "Bad file descriptor"
check "a folder on standard input" nothing_to_read '<"$scratch"' "Is a directory"
check "line ends of other systems" line_ends
check "a deck in Latin-1" latin1
