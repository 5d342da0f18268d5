#!/bin/sh
# Ways to write the same deck: the tables are the same.
. tests/scripts/functions.sh

out=$scratch/out
motion_deck >"$scratch/plain.deck"
run 0 --out "$out" "$scratch/plain.deck"

# accepted NAME: the deck on standard input gives the tables of the plain one.
accepted() {
  cat >"$scratch/$1.deck"
  run 0 --out "$out" "$scratch/$1.deck" && silent && same_tables "$out/plain" "$out/$1"
}

written_as() {
  sed "$2" "$scratch/plain.deck" | accepted "$1"
}

title() {
  { echo "TITLE   a ! b # c = d & e"; cat "$scratch/plain.deck"; } >"$scratch/title.deck"
  run 0 --out "$out" "$scratch/title.deck" && silent || return 1
  head -n 1 "$out/title/kinematics.dat" | grep -qxF "# a ! b # c = d & e" || { echo "the table's title is another"; return 1; }
  grep -qxF "TITLE a ! b # c = d & e" "$out/title/echo.deck" || { echo "the echo's title is another"; return 1; }
}

check "blanks about the equals sign" written_as blanks 's/=/  =	/'
check "keywords and keys in any case" written_as case 's/LINK/liNK/; s/length/LENGTH/; s/DRIVE/drive/; s/step/STEP/'
check "names in any case" written_as names 's/^DRIVE.*/DRIVE CRANK/; s/^GROUND   O/GROUND o/'
check "tabs" written_as tabs 's/  */	/g'
check "comments" written_as comments 's/$/ ! & # =/; s/^U/# LINK\n\n!!\nU/'
check "continued lines" written_as continued 's/ length/ \&  # more below\n   length/; s/ to / \&\n\n  to /'
check "units of their own" written_as units 's/279.4/11in/; s/254/ 25.4cm/; s/step 30/step 30 deg/; s/=100/=0.1m/'
check "commas between positions" eval 'sed "s/^CRANK.*/CRANK 0, 30 to 330 step 30, 360/" "$scratch/plain.deck" | accepted commas'
check "degree signs, raised powers and blanks of web pages" written_as signs 's/step 30/step 30°/; s/LINK  /LINK\xc2\xa0/; $a MATERIAL steel E=200000N/mm² density=7850kg/m³'
check "other digits" written_as digits 's/=100/=+1.d2/; s/254/ .254E+3/; s/279.4/2794e-1/'
check "other order" eval 'sort -r "$scratch/plain.deck" | sed "/LINK/d; /GROUND/d" | cat - "$scratch/plain.deck" |
  awk "/LINK|GROUND/ || !seen[\$1]++" | accepted order'
check "an END" eval '{ cat "$scratch/plain.deck"; echo end; echo "! nothing"; } | accepted end'
check "names of figures and marks" eval 'sed "s/crank/2_a.b-c/; s/O2/0/; s/ A/ A\x27/g" "$scratch/plain.deck" >"$scratch/n.deck" &&
  run 0 --out "$out" "$scratch/n.deck" && silent'
check "TITLE keeps its whole line" title
