#!/bin/sh
# INCLUDE, SET and --set on the program: decks in pieces give the tables of the whole, and so do their echoes.
. tests/scripts/functions.sh

out=$scratch/out
mkdir -p "$scratch/parts/deep er"

# whole NAME: the deck that those below are pieces of
whole() {
  beam_deck "CRANK 0 to 360 step 30" "SPEED 0 15" "MODES 2" "REPORT frequencies" "REPORT shapes crank=0,90 points=3" >"$scratch/$1.deck"
}

pieces() {
  cat >"$scratch/pieces.deck" <<'END_OF_DECK'
INCLUDE  parts/links.part
UNITS    mm tonne s
SET      thick 1.6
SECTION  strip  rectangle thickness=$thick width=25.4
INCLUDE  'parts/deep er/metals.part'
DRIVE    $driven
SET      driven crank
MESH     *  elements=$n
INERTIA  lumped
SET      n 2
SET      turn 360
CRANK    0 to $turn step $step
SET      step 30
SPEED    0 $speed rad/s
SET      speed $same
SET      same 15
MODES    $n
REPORT   frequencies
REPORT   $what crank=0,$right points=3
SET      what shapes
SET      right 90
END_OF_DECK
  cat >"$scratch/parts/links.part" <<'END_OF_DECK'
GROUND   O2  0 0
GROUND   O4  $base 0
SET      base 254
INCLUDE  ../moving.part
END_OF_DECK
  cat >"$scratch/moving.part" <<'END_OF_DECK'
LINK     crank    O2 A  length=$L     material=$metal section=strip
SET      L 100
LINK     coupler  A  B  length=279.4  material=$metal section=strip
LINK     follower O4 B  length=266.7  material=$metal section=strip
SET      metal Steel
END_OF_DECK
  cat >"$scratch/parts/deep er/metals.part" <<'END_OF_DECK'
MATERIAL steel  E=200000 density=7.8e-9
END_OF_DECK
}

same_as_the_whole() {
  whole whole && pieces
  run 0 --out "$out" "$scratch/whole.deck" "$scratch/pieces.deck" && silent && same_tables "$out/whole" "$out/pieces"
}

# It needs no other file, and no option.
echo_stands_alone() {
  mkdir -p "$scratch/alone"
  cp "$out/pieces/echo.deck" "$scratch/alone/pieces.deck"
  ! grep -q INCLUDE "$scratch/alone/pieces.deck" || { echo "it includes"; return 1; }
  grep -q '^LINK crank O2 A length=\$L material=\$metal section=strip  *! parts/../moving.part:1$' "$scratch/alone/pieces.deck" &&
    grep -q '^GROUND O4 \$base 0  *! parts/links.part:2$' "$scratch/alone/pieces.deck" &&
    grep -q '^MATERIAL steel E=200000 density=7.8e-9  *! parts/deep er/metals.part:1$' "$scratch/alone/pieces.deck" &&
    grep -q '^MODES \$n  *! line 17$' "$scratch/alone/pieces.deck" || { cat "$scratch/alone/pieces.deck"; return 1; }
  run 0 --out "$scratch/alone/out" "$scratch/alone/pieces.deck" && silent && same_tables "$out/pieces" "$scratch/alone/out/pieces"
}

overridden() {
  whole other
  sed -i 's/length=100 /length=105 /; s/MODES 2/MODES 3/; s/elements=2/elements=3/' "$scratch/other.deck"
  pieces
  run 0 --out "$out" --set L=105mm --set=N=3 "$scratch/pieces.deck" && silent && run 0 --out "$out" "$scratch/other.deck" &&
    same_tables "$out/other" "$out/pieces" || return 1
  grep -q '^SET L 105mm  *! --set on the command line; parts/../moving.part:2 has 100$' "$out/pieces/echo.deck" &&
    grep -q '^SET n 3  *! --set on the command line; line 10 has 2$' "$out/pieces/echo.deck" || { cat "$out/pieces/echo.deck"; return 1; }
}

overridden_vary() {
  { whole vary; } && sed -i 's/length=100 /length=$L/; s/^MODES.*/MODES 2\nVARY L 90mm to 110mm step 1mm/' "$scratch/vary.deck"
  run 0 --check "$scratch/vary.deck" && silent && whole fixed && run 0 --out "$out" "$scratch/fixed.deck" &&
    run 0 --out "$out" --set l=100 "$scratch/vary.deck" && silent && same_tables "$out/fixed" "$out/vary" &&
    grep -q '^SET L 100  *! --set on the command line; line 15 has VARY L 90mm to 110mm step 1mm$' "$out/vary/echo.deck"
}

# For every deck of the command line.
set_for_all() {
  pieces && whole plain && rm -rf "$out"
  run 2 --out "$out" --set L=105 "$scratch/pieces.deck" "$scratch/plain.deck" && absent "$out" &&
    says "<command line>:1:7: error: $scratch/plain.deck has no SET or VARY 'L'" || return 1
  cp "$scratch/pieces.deck" "$scratch/pieces2.deck"
  run 0 --out "$out" --set L=105 "$scratch/pieces.deck" "$scratch/pieces2.deck" && same_tables "$out/pieces" "$out/pieces2"
}

set_unknown() {
  pieces && rm -rf "$out"
  run 2 --out "$out" --set thik=2 "$scratch/pieces.deck" && absent "$out" && says "did you mean 'thick'?" && says "1 | --set thik=2"
}

# The value may be an expression, which the echo keeps.
set_expression() {
  pieces && sed -i 's/^SET      speed \$same/SET      speed $same*$one\nSET      one 2 - 1/' "$scratch/pieces.deck"
  run 0 --out "$out" --set 'L=$thick*50 + 5*5' --set "one=1" "$scratch/pieces.deck" && silent &&
    sed 's/length=100 /length=105 /' "$scratch/whole.deck" >"$scratch/other.deck" && run 0 --out "$out" "$scratch/other.deck" &&
    same_tables "$out/other" "$out/pieces" || return 1
  grep -q '^SET L \$thick\*50 + 5\*5  *! --set on the command line; parts/../moving.part:2 has 100$' "$out/pieces/echo.deck" &&
    grep -q '^SET one 1  *! --set on the command line; line 16 has 2 - 1$' "$out/pieces/echo.deck" &&
    grep -q '^SET speed \$same\*\$one  *! line 15$' "$out/pieces/echo.deck" || { cat "$out/pieces/echo.deck"; return 1; }
  mkdir -p "$scratch/again" && cp "$out/pieces/echo.deck" "$scratch/again/pieces.deck" &&
    run 0 --out "$scratch/again/out" "$scratch/again/pieces.deck" && silent && same_tables "$out/pieces" "$scratch/again/out/pieces" &&
    run 2 --check --set 'L=2 3' "$scratch/pieces.deck" && says "<command line>:1:11: error: unexpected '3'"
}

set_wrong_value() {
  pieces && run 2 --check --set n=2.5 "$scratch/pieces.deck" && says "pieces.deck:17:10: error: '2.5' is not a whole number" &&
    says "<command line>:1:9: note: '\$n' is set here"
}

# refused MESSAGE ARGUMENT...
refused() {
  message=$1
  shift
  pieces && rm -rf "$out"
  run 2 --out "$out" "$@" "$scratch/pieces.deck" && says "flexmech: error: $message" && absent "$out"
}

malformed() {
  for word in L =3 L= ""; do
    refused "option --set needs" --set "$word" || return 1
  done
  refused "option --set: 'a b' is not a name" --set "a b=3" &&
    for value in " 3" " " "3!" "3#" "a=b" "3&"; do
      refused "option --set: '$value' is not one value" --set "L=$value" || return 1
    done
}

warnings_name_their_file() {
  pieces
  echo "SET spare 3" >>"$scratch/moving.part"
  run 0 --out "$out" "$scratch/pieces.deck" && says "parts/../moving.part:6:5: warning: 'spare' is set and not used" &&
    says "included from $scratch/parts/links.part:4" && says "included from $scratch/pieces.deck:1" &&
    grep -qxF "warning: parts/../moving.part:6: 'spare' is set and not used" "$out/pieces/run.log"
}

# Relative to the current folder.
standard_input() {
  pieces
  case $program in /*) absolute=$program ;; *) absolute=$PWD/$program ;; esac
  (cd "$scratch" && "$absolute" --out "$out" - <pieces.deck) && run 0 --out "$out" "$scratch/pieces.deck" && same_tables "$out/pieces" "$out/stdin"
}

# chain N: a deck by way of N files, one in another
chain() {
  number=$1
  echo "REPORT kinematics" >"$scratch/chain$number.part"
  while [ "$number" -gt 1 ]; do
    echo "INCLUDE chain$number.part" >"$scratch/chain$((number - 1)).part"
    number=$((number - 1))
  done
  { motion_deck | grep -v REPORT; echo "INCLUDE chain1.part"; } >"$scratch/chain.deck"
}

nesting() {
  chain 50 && run 0 --check "$scratch/chain.deck" && silent && chain 51 && run 2 --check "$scratch/chain.deck" &&
    says "chain50.part:1:9: error: files include each other more than 50 levels deep" && says "included from $scratch/chain.deck:9"
}

# Each file includes the next one twice: a thousand million files at thirty levels.
many_files() {
  number=30
  : >"$scratch/twice$number.part"
  while [ "$number" -gt 1 ]; do
    printf 'INCLUDE twice%s.part\nINCLUDE twice%s.part\n' $number $number >"$scratch/twice$((number - 1)).part"
    number=$((number - 1))
  done
  { motion_deck; echo "INCLUDE twice1.part"; } >"$scratch/twice.deck"
  run 2 --check "$scratch/twice.deck" && says "more than 1000 files are included"
}

# By a link the path is another one, the file the same.
loop_by_link() {
  ln -s "$scratch" "$scratch/parts/up"
  { motion_deck; echo "INCLUDE parts/up/parts/up/linked.deck"; } >"$scratch/linked.deck"
  run 2 --check "$scratch/linked.deck" && says "error: this file includes itself: $scratch/linked.deck -> $scratch/parts/up/parts/up/linked.deck"
}

unreadable() {
  echo "REPORT mesh" >"$scratch/locked.part"
  chmod 000 "$scratch/locked.part"
  { motion_deck; echo "INCLUDE locked.part"; } >"$scratch/locked.deck"
  run 2 --check "$scratch/locked.deck" && says "locked.deck:10:9: error: '$scratch/locked.part' cannot be included: "
}

check "a deck in pieces gives the tables of the whole" same_as_the_whole
check "the echo of a deck in pieces stands alone" echo_stands_alone
check "--set overrides SET" overridden
check "--set overrides VARY" overridden_vary
check "--set applies to all decks" set_for_all
check "--set of an unknown name" set_unknown
check "--set of a wrong value" set_wrong_value
check "--set of an expression" set_expression
check "--set malformed" malformed
check "--set twice" refused "option --set gives 'l' twice: L=1 and l=2" --set L=1 --set l=2
check "--set without its value" eval 'run 2 --set && says "option --set needs a value"'
check "warnings name the file that is included" warnings_name_their_file
check "INCLUDE in standard input" standard_input
check "50 levels of files, not 51" nesting
check "includes without end" many_files
check "a loop through a symbolic link" loop_by_link
if [ "$(id -u)" -eq 0 ]; then
  skip "a file that cannot be read" "root reads everything"
else
  check "a file that cannot be read" unreadable
fi
