#!/bin/sh
# Files that are no deck, or hardly one.
. tests/scripts/functions.sh

out=$scratch/out

# refused TEXT DECK
refused() {
  run 2 --out "$out" "$2" && says "$1" && absent "$out"
}

unreadable() {
  motion_deck >"$scratch/locked.deck"
  chmod 000 "$scratch/locked.deck"
  refused "locked.deck: error: the deck cannot be read" "$scratch/locked.deck"
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

standard_input_refused() {
  motion_deck "0 to 360" | "$program" --check - 2>"$scratch/stderr"
  [ $? -eq 2 ] && says "<standard input>:8:12: error:"
}

# Line ends of other systems, and the mark that some editors put first.
line_ends() {
  motion_deck >"$scratch/four.deck"
  { printf '\357\273\277'; awk '{ printf "%s\r\n", $0 }' "$scratch/four.deck"; } >"$scratch/dos.deck"
  printf '%s' "$(cat "$scratch/four.deck")" >"$scratch/no_end.deck"
  run 0 --out "$out" "$scratch/four.deck" "$scratch/dos.deck" "$scratch/no_end.deck" && silent &&
    same_but_names "$out/four" "$out/dos" && same_but_names "$out/four" "$out/no_end"
}

: >"$scratch/empty.deck"
check "an empty deck" refused "empty.deck:1:1: error: there is no UNITS card" "$scratch/empty.deck"
check "a missing deck" refused "absent.deck: error: no such file" "$scratch/absent.deck"
check "a folder" refused ": error: this is a folder, not a deck" "$scratch"
check "a folder with a slash" refused ": error: this is a folder, not a deck" "$scratch/"
if [ "$(id -u)" -eq 0 ]; then
  skip "an unreadable deck" "root reads everything"
else
  check "an unreadable deck" unreadable
fi
check "a binary file" binary
check "a byte that no text has" zeros
check "ten megabytes of a deck" large
check "ten megabytes of garbage" garbage
check "standard input" standard_input
check "an error in standard input" standard_input_refused
check "line ends of other systems" line_ends
