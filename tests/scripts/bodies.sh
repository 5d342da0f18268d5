#!/bin/sh
# Cards of bodies, loads and motors as the language has them: values by name, variants, the echo, no crank angles.
. tests/scripts/functions.sh

out=$scratch/out

# bodies CARD...: every such card, and all reports of rigid dynamics.
bodies() {
  cat <<'END_OF_DECK'
UNITS    mm tonne s
MATERIAL steel  E=200000 density=7.8e-9
SECTION  strip  rectangle thickness=1.6 width=25.4
GROUND   O2  0 0
GROUND   O4  254 0
LINK     crank    A O2  length=100    mass=$w inertia=$i center=$c,-3
LINK     coupler  A  B  rigid length=279.4  material=steel section=strip
LINK     follower O4 B  length=266.7  material=steel section=strip center=90,$c
DRIVE    crank
MASS     coupler $w at=$a offset=$o
POINT    P coupler along=$a offset=$o
GRAVITY  0 $g
FORCE    B $f -3
TORQUE   follower $t
MOTOR    stall=$t noload=$n
LOAD     follower torque=$t damping=$d
INERTIA  distributed
SPEED    0 12 alpha=3
REPORT   linkage
REPORT   motion crank=$b speed=$u end=$e step=0.05
END_OF_DECK
  for card in "$@"; do
    echo "$card"
  done
}

positions() {
  printf '%s\n' "CRANK 0 to 360 step 45" "REPORT points" "REPORT reactions" "REPORT lagrange" "REPORT inertia" "REPORT balance"
}

# values NAME: SET cards of all but one.
values() {
  while read -r name value; do
    [ "$name" = "$1" ] || echo "SET $name $value"
  done <<'END_OF_VALUES'
w 0.2kg
i 300kg*mm2
c 11
a 60
o -25mm
g -9.81m/s2
f 12
t 200
n 300rpm
d 0.3N*m*s/rad
b 30
u 5
e 0.5
END_OF_VALUES
}

# varied NAME VALUE VALUE: the rows of a variant are those of the value given by the command line.
varied() {
  { bodies "VARY $1 $2 $3" && values "$1" && positions; } >"$scratch/$1.deck"
  run 0 --out "$out" --threads 2 "$scratch/$1.deck" || return 1
  for value in "$2" "$3"; do
    run 0 --out "$scratch/$value" --set "$1=$value" "$scratch/$1.deck" || return 1
    python3 -B - "$out/$1" "$scratch/$value/$1" "$value" <<'END_OF_PYTHON' || return 1
import glob, os, re, sys

varied, plain, value = sys.argv[1:]
number = float(re.match(r"[-+.\de]*\d", value)[0])
tables = sorted(os.path.basename(path) for path in glob.glob(os.path.join(plain, "*.dat")))
assert len(tables) == 8, tables

def rows(folder, table):
    with open(os.path.join(folder, table), encoding="utf-8") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]

for table in tables:
    mine = [row[1:] for row in rows(varied, table) if float(row[0]) == number]
    assert mine and mine == rows(plain, table), f"{table}: the rows of {value} differ"
END_OF_PYTHON
  done
}

check "a mass that varies" varied w 0.2kg 0.35kg
check "a moment of inertia that varies" varied i 300kg*mm2 0kg*mm2
check "a mass centre that varies" varied c 11 -4
check "a place on a link that varies" varied a 60 -10
check "an offset that varies" varied o -25mm 4mm
check "gravity that varies" varied g -9.81m/s2 0m/s2
check "a force that varies" varied f 12 -5
check "torques that vary" varied t 200 90
check "a speed without load that varies" varied n 300rpm 200rpm
check "damping that varies" varied d 0.3N*m*s/rad 0N*m*s/rad
check "a start that varies" varied b 30 200
check "an initial speed that varies" varied u 5 -2
check "an end that varies" varied e 0.5 0.25

echoed() {
  { bodies && values none && positions; } >"$scratch/echoed.deck"
  run 0 --out "$out" "$scratch/echoed.deck" || return 1
  mkdir -p "$scratch/second"
  cp "$out/echoed/echo.deck" "$scratch/second/echoed.deck"
  run 0 --out "$scratch/again" "$scratch/second/echoed.deck" && same_tables "$out/echoed" "$scratch/again/echoed"
}
check "the echo of bodies, loads and motors" echoed

# Without CRANK there is no position, and all else goes on.
crankless() {
  { bodies && values none; } >"$scratch/crankless.deck"
  run 0 --out "$out" --stats --threads 3 --format csv "$scratch/crankless.deck" && says "positions 0" || return 1
  run 0 --json --out "$scratch/again" "$scratch/crankless.deck" && silent || return 1
  python3 -B - "$out/crankless/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    summary = json.load(file)
assert summary["exit_status"] == 0 and summary["counts"]["positions"] == 0, summary
assert [table["file"] for table in summary["tables"]] == ["linkage.dat", "motion.dat"], summary
assert all(table["rows"] > 0 and table["columns"] for table in summary["tables"]), summary
END_OF_PYTHON
}
check "a deck without crank angles" crankless

crankless_variants() {
  { bodies "VARY w 0.2kg 0.3kg 0.4kg" && values w; } >"$scratch/varied.deck"
  run 0 --out "$out" --threads 2 "$scratch/varied.deck" && run 0 --out "$scratch/again" "$scratch/varied.deck" &&
    same "$out/varied" "$scratch/again/varied"
}
check "variants without crank angles" crankless_variants
