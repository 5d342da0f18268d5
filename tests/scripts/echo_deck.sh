#!/bin/sh
# The echo of a deck is a deck: it gives the same tables, and its own echo gives them again.
. tests/scripts/functions.sh

# again DECK: exit status 1 (failed rows) is as good as 0 here.
again() {
  base=$(basename "$1" .deck)
  mkdir -p "$scratch/$base"
  deck=$scratch/$base/$base.deck
  cp "$1" "$deck"
  for number in 1 2; do
    "$program" --quiet --out "$scratch/$base/$number" "$deck" 2>"$scratch/stderr"
    [ $? -le 1 ] || { head -n 5 "$scratch/stderr"; return 1; }
    cp "$scratch/$base/$number/$base/echo.deck" "$deck"
    sed 's/ *!.*//' "$deck" >"$scratch/$base/echo.$number"
  done
  same_tables "$scratch/$base/1" "$scratch/$base/2" && diff "$scratch/$base/echo.1" "$scratch/$base/echo.2"
}

case $program in
*/release/*)
  for deck in $(quick_inputs); do
    check "the echo of $deck" again "$deck"
  done ;;
*) skip "echoes of inputs/" "all decks run in the goldens of this build" ;;
esac

cat >"$scratch/odd.deck" <<'END_OF_DECK'
title    ! # & = all kept, "quoted", Größe
report   shapes points=3 speed=600rpm crank=90deg,0
crank    0 90 0.5rad 100 to 110 &
         step 2.5
units    in slinch s
link     c_4 O4 B  length = 10.5in material=Alu section=t
link     a'  O2 A  length = .1016e0m  material=alu section=r
link     b-2 A  B  section=g  length=11    material=ALU
material alu E=71d3MPa density=2.7g/cm3 nu=+0.33
section  r   rectangle width=1 thickness=4.24mm
section  t   tube outer=8mm inner=6mm
section  g   general A=40mm^2 I=8.6mm4
ground   O4  254mm 0
ground   O2  0 0
drive    A'
branch   crossed
pinmass  b   10g
mesh     *   elements=2
mesh     a'  order=3 elements=1
speed    600 0 rpm alpha=3
inertia  distributed
solver   band
report   kinematics
report   inertia
report   frequencies
end
END_OF_DECK
check "the echo of a deck written oddly" again "$scratch/odd.deck"
