#!/bin/sh
# The library of materials and strips: what is in it, and where decks find it.
. tests/scripts/functions.sh

out=$scratch/out
root=$(pwd)

# library_deck MATERIAL SECTION CARD...
library_deck() {
  material=$1
  section=$2
  shift 2
  cat <<END_OF_DECK
UNITS    in lbm s
INCLUDE  library/materials.inc
INCLUDE  library/strips_mm.inc
INCLUDE  library/strips_in.inc
GROUND   O2  0 0
GROUND   O4  10 0
LINK     crank    O2 A  length=4     material=$material section=$section
LINK     coupler  A  B  length=11    material=$material section=$section
LINK     follower O4 B  length=10.5  material=$material section=$section
DRIVE    crank
EFFECTS  rotary shear
CRANK    0 to 300 step 60
REPORT   frequencies
END_OF_DECK
  for card in "$@"; do
    echo "$card"
  done
}

# A warning would be about units; nothing is told of what no link uses.
from_elsewhere() {
  library_deck steel strip_1-16x1in >"$scratch/far.deck"
  (cd "$scratch" && "$program" --out "$out" far.deck 2>"$scratch/stderr" </dev/null) || { cat "$scratch/stderr"; return 1; }
  silent
}

# Its echo needs no library, and does not say where it is.
echo_alone() {
  mkdir -p "$scratch/alone"
  cp "$out/far/echo.deck" "$scratch/alone/far.deck"
  ! grep -q "INCLUDE\|$root" "$scratch/alone/far.deck" || { echo "it includes, or names a folder"; return 1; }
  grep -q '! library/materials.inc:[0-9]*$' "$scratch/alone/far.deck" || { echo "it does not say where cards are from"; return 1; }
  [ "$(grep -c '^! derived: section' "$scratch/alone/far.deck")" -eq 1 ] || { echo "it has sections that are not used"; return 1; }
  mkdir -p "$scratch/alone/bin"
  cp "$program" "$scratch/alone/bin/flexmech"
  "$scratch/alone/bin/flexmech" --out "$scratch/alone/out" "$scratch/alone/far.deck" </dev/null 2>"$scratch/stderr" && silent &&
    same_tables "$out/far" "$scratch/alone/out/far"
}

# Two elements of steel by hand: 1/16 in by 1 in.
by_hand() {
  library_deck steel strip_1-16x1in | sed '/INCLUDE/d; $a MATERIAL steel E=210GPa density=7850kg/m3 nu=0.3
$a SECTION strip_1-16x1in rectangle thickness=0.0625 width=1' >"$scratch/hand.deck"
  run 0 --out "$out" "$scratch/hand.deck" && silent && same_tables "$out/far" "$out/hand"
}

# A program that is installed, and a file of the user's, which goes before.
installed() {
  mkdir -p "$scratch/usr/bin" "$scratch/usr/share/flexmech"
  cp "$program" "$scratch/usr/bin/flexmech"
  cp -R library "$scratch/usr/share/flexmech/"
  "$scratch/usr/bin/flexmech" --out "$scratch/usr/out" "$scratch/far.deck" </dev/null 2>"$scratch/stderr" && silent &&
    same_tables "$out/far" "$scratch/usr/out/far"
}

own_file_first() {
  mkdir -p "$scratch/own/library"
  sed 's/^MATERIAL steel .*/MATERIAL steel E=1GPa density=7850kg\/m3 nu=0.3/' library/materials.inc >"$scratch/own/library/materials.inc"
  cp "$scratch/far.deck" "$scratch/own/far.deck"
  run 0 --out "$scratch/own/out" "$scratch/own/far.deck" && silent || return 1
  grep -q '^MATERIAL steel E=1GPa' "$scratch/own/out/far/echo.deck" || { echo "the other file was taken"; return 1; }
}

# Where it was looked for is said.
not_there() {
  library_deck steel strip_1-16x1in "INCLUDE library/wood.inc" "INCLUDE other/materials.inc" >"$scratch/absent.deck"
  run 2 --check "$scratch/absent.deck" &&
    says "absent.deck:14:9: error: 'library/wood.inc' cannot be included: no such file in '$scratch', nor in '$root/library'" &&
    says "absent.deck:15:9: error: '$scratch/other/materials.inc' cannot be included: no such file" || return 1
  ! "$scratch/alone/bin/flexmech" --check "$scratch/absent.deck" </dev/null 2>"$scratch/stderr" || { echo "it was taken"; return 1; }
  says "absent.deck:2:10: error: 'library/materials.inc' cannot be included: no such file in '$scratch', and this program has no library"
}

# Every material is taken without a word about its units, and has what EFFECTS shear needs.
materials() {
  for material in $(awk '$1 == "MATERIAL" { print $2 }' library/materials.inc); do
    library_deck "$material" strip_1x25mm >"$scratch/material.deck"
    run 0 --check "$scratch/material.deck" && silent || { echo "with $material"; return 1; }
  done
  [ -n "$material" ]
}

# The name of a strip says what it is: strip_1.5x20mm, strip_1-16x1-1-2in.
strips() {
  cat library/strips_mm.inc library/strips_in.inc | awk '
    function inches(text, part, n) {
      n = split(text, part, "-")
      return n == 1 ? part[1] : n == 2 ? part[1]/part[2] : part[1] + part[2]/part[3]
    }
    $1 == "SECTION" {
      unit = $2 ~ /mm$/ ? "mm" : "in"
      size = $2
      gsub(/^strip_|mm$|in$/, "", size)
      split(size, side, "x")
      for (i = 1; i <= 2; i++) if (unit == "in") side[i] = inches(side[i])
      if ($3 != "rectangle" || $4 != "thickness=" side[1] unit || $5 != "width=" side[2] unit) { print $0; exit 1 }
      count++
    }
    END { if (!count) exit 1 }'
}

check "a deck finds the library from elsewhere" from_elsewhere
check "the echo of such a deck stands alone" echo_alone
check "a strip of the library by hand" by_hand
check "an installed program finds its library" installed
check "a file of the user overrides the library" own_file_first
check "a file not in the library" not_there
check "materials of the library" materials
check "strips are what their names say" strips
