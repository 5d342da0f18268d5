#!/bin/sh
# Numbers in tables: in as few digits as they need, those of the deck as it has them, on request rounded.
. tests/scripts/functions.sh

out=$scratch/out

# values TABLE COLUMN: of the rows.
values() {
  awk -v wanted="$2" '/^#/ { for (i = 2; i <= NF; i++) if ($i == wanted) column = i - 1; next } NF { print $column }' "$1"
}

# column TABLE COLUMN VALUE...: these are its values, letter by letter.
column() {
  table=$1
  name=$2
  shift 2
  found=$(values "$table" "$name" | tr '\n' ' ')
  [ "$found" = "$* " ] || { echo "$name of $(basename "$table"): $found"; return 1; }
}

# The first columns stand as the deck has them, in every unit.
as_written() {
  motion_deck "0 to 1 step 0.1" >"$scratch/angles.deck"
  run 0 --out "$out" "$scratch/angles.deck" &&
    column "$out/angles/kinematics.dat" crank 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1 || return 1
  cat >"$scratch/lengths.deck" <<END_OF_DECK
UNITS  mm kg s
GROUND O 0 0
GUIDE  bed 0 0 angle=0
LINK   rod B A length=9000
LINK   arm O A length=300
SLIDER B bed
DRIVE  B bed
BRANCH A left O B
CRANK  9191.7 to 9192.1 step 0.1
SPEED  0.3 mm/s
REPORT kinematics
END_OF_DECK
  run 0 --out "$out" "$scratch/lengths.deck" || return 1
  values "$out/lengths/kinematics.dat" crank | uniq >"$scratch/found"
  printf '%s\n' 9191.7 9191.8 9191.9 9192 9192.1 | cmp -s - "$scratch/found" || { echo "lengths: $(cat "$scratch/found")"; return 1; }
  [ "$(values "$out/lengths/kinematics.dat" speed | uniq)" = 0.3 ]
}

# What the deck gives comes back: the rate of the drive in rpm, its angle.
of_the_drive() {
  { motion_deck "0 to 330 step 30" | sed 's/^REPORT .*//'; echo "SPEED 100 rpm"; echo "REPORT drives"; } >"$scratch/drive.deck"
  sed -i 's/LINK .*/& mass=0 inertia=0/' "$scratch/drive.deck"
  run 0 --out "$out" "$scratch/drive.deck" || return 1
  [ "$(values "$out/drive/drives.dat" rate | uniq)" = 100 ] || { echo "$(values "$out/drive/drives.dat" rate)"; return 1; }
}

# rounded FULL ROUNDED DIGITS: the same tables, of which numbers have so many digits at most.
rounded() {
  python3 -B - "$@" <<'END_OF_PYTHON'
import csv, glob, os, re, sys

full, narrow, digits = sys.argv[1], sys.argv[2], int(sys.argv[3])
files = sorted(glob.glob(os.path.join(full, "*.dat")) + glob.glob(os.path.join(full, "*.csv")))
assert files, "no tables"
seen = 0
for path in files:
    with open(path, encoding="utf-8", newline="") as kept, open(os.path.join(narrow, os.path.basename(path)), encoding="utf-8", newline="") as new:
        kept, new = kept.read().splitlines(), new.read().splitlines()
    assert len(kept) == len(new), path
    head = next(k for k, line in enumerate(kept + ["."]) if path.endswith(".csv") or not line.startswith("#"))
    names = kept[0].split(",") if path.endswith(".csv") else kept[head - 2][1:].split()
    width = len(new[head - 1])
    for old, line in zip(kept, new):
        if old.startswith("#") or not old:
            assert old.split() == line.split(), line
            continue
        old, words = (next(csv.reader([text])) if path.endswith(".csv") else text.split() for text in (old, line))
        assert path.endswith(".csv") or len(line) == width, line
        for name, a, b in zip(names, old, words):
            if a == b:
                continue
            name = name.split(" ")[0]
            kept_digits = 12 if name in ("speed", "crank", "time", "L") else max(3, digits) if "error" in name else digits
            assert re.fullmatch(r"-?\d+(\.\d+)?(e[-+]\d+)?", b) and float(b) == float(f"{float(a):.{kept_digits - 1}e}"), f"{name}: {b} of {a}"
            seen += 1
assert seen > 100, seen
END_OF_PYTHON
}

beam_deck "VARY L 100 100.125" "CRANK 0 to 350 step 12.625" "SPEED 0 10" "MODES 3" "REPORT kinematics" "REPORT frequencies" "REPORT inertia" |
  sed 's/length=100/length=$L/' >"$scratch/full.deck"
of_option() {
  run 0 --out "$out" --format csv "$scratch/full.deck" && run 0 --out "$out/6" --format csv --digits 6 "$scratch/full.deck" &&
    rounded "$out/full" "$out/6/full" 6 && run 0 --out "$out/1" --format csv --digits=1 "$scratch/full.deck" && rounded "$out/full" "$out/1/full" 1
}

of_card() {
  sed 's/^UNITS.*/& digits=6/' "$scratch/full.deck" >"$scratch/card.deck"
  run 0 --out "$out" --format csv "$scratch/card.deck" && same_tables "$out/6/full" "$out/card" &&
    run 0 --out "$out/all" --format csv --digits 17 "$scratch/card.deck" && same_tables "$out/full" "$out/all/card"
}

# Parts keep all digits, and are joined with as many as the join asks for.
of_parts() {
  run 0 --out "$out/parts" --part 1/2 "$scratch/full.deck" && run 0 --out "$out/parts" --part 2/2 "$scratch/full.deck" &&
    run 0 --out "$out/parts" --join --format csv --digits 6 "$scratch/full.deck" && rm "$out"/parts/full/*.part* &&
    same_tables "$out/6/full" "$out/parts/full" &&
    run 2 --out "$out/parts" --part 1/2 --digits 6 "$scratch/full.deck" && says "option --digits has no meaning with --part"
}

threads() {
  run 0 --out "$out/3" --format csv --digits 6 --threads 3 "$scratch/full.deck" && same "$out/6" "$out/3"
}

refused() {
  for number in 0 -1 18 six 1e1; do
    run 2 --digits "$number" --out "$out/none" "$scratch/full.deck" && says "option --digits needs a number from 1 to 17, not '$number'" &&
      absent "$out/none" || return 1
  done
}

check "the first columns are those of the deck" as_written
check "and so is the rate of a drive" of_the_drive
check "--digits" of_option
check "UNITS digits=" of_card
check "parts that are joined with --digits" of_parts
check "--digits on three threads" threads
check "digits that there are not" refused
