#!/bin/sh
# Stability, Campbell diagram and elastic motion in time through the whole program: threads, VARY, the same mechanism otherwise
# described, speeds that fail.
. tests/scripts/functions.sh

out=$scratch/out

# first NAME SCRIPT CARD...: inputs/stability.deck without its requests, changed by a script of sed, and with these cards.
first() {
  name=$1
  script=$2
  shift 2
  sed -e '/^SPEED\|^MODES\|^REPORT\|^END/d' -e "$script" inputs/stability.deck >"$scratch/$name.deck"
  printf '%s\n' "$@" >>"$scratch/$name.deck"
}

# Speeds, meetings and bands are shared out to threads.
threads() {
  first threads "" "SPEED 50 to 53 step 1.5" "REPORT stability accuracy=1e-4" "REPORT intervals accuracy=1e-3" "REPORT campbell accuracy=1e-3" \
    "REPORT transient turns=0.5 start=steady perturb=1,0.1 accuracy=1e-2"
  run 0 --quiet --out "$out/one" "$scratch/threads.deck" && run 0 --quiet --threads 3 --out "$out/three" "$scratch/threads.deck" &&
    same_tables "$out/one/threads" "$out/three/threads"
}

# A variant has the rows of the plain deck after its value.
variants() {
  first plain "s/thickness=1.6/thickness=1.5/" "SPEED 50 51" "REPORT stability accuracy=1e-4"
  first varied "s/thickness=1.6/thickness=\$t/" "VARY t 1.5 1.6" "SPEED 50 51" "REPORT stability accuracy=1e-4"
  run 0 --quiet --out "$out" "$scratch/plain.deck" "$scratch/varied.deck" || return 1
  grep -v '^#' "$out/varied/stability.dat" | grep '^ *1\.5 ' | cut -c 27- | sed 's/^ *//' >"$scratch/rows"
  grep -v '^#' "$out/plain/stability.dat" | grep . | sed 's/^ *//' >"$scratch/wanted"
  [ "$(grep -c . "$scratch/wanted")" -eq 6 ] && cmp "$scratch/rows" "$scratch/wanted"
}

# The first mechanism in other units, turned, mirrored with its crank turning the other way, its links in another order.
otherwise() {
  set -- "SPEED 50 52.95 rad/s" "MODES 3" "REPORT stability accuracy=1e-9"
  first plain "" "$@"
  first units "s/^UNITS.*/UNITS m kg s/; s/E=200000 density=7.8e-9/E=2e11 density=7800/; s/=1.6 /=1.6mm /; s/=25.4/=25.4mm/
    s/O4  254 0/O4  0.254 0/; s/\(length=[0-9.]*\)/\1mm/" "$@"
  first turned "s/O4  254 0/O4  152.4 203.2/" "$@"
  first mirrored "" "BRANCH crossed" "SPEED -50 -52.95 rad/s" "MODES 3" "REPORT stability accuracy=1e-9"
  first order "/^LINK *follower/d; s/^LINK *crank/LINK     follower O4 B length=266.7 material=steel section=strip\n&/" "$@"
  for name in plain units turned mirrored order; do
    run 0 --quiet --out "$out" "$scratch/$name.deck" || return 1
  done
  python3 -B - "$out" <<'END_OF_PYTHON'
import sys

def rows(name):
    with open(f"{sys.argv[1]}/{name}/stability.dat", encoding="utf-8") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]

plain = rows("plain")
assert len(plain) == 6 and any(row[-1].startswith("unstable") for row in plain), plain
for name in ("units", "turned", "mirrored", "order"):
    for row, other in zip(plain, rows(name), strict=True):
        assert [row[1]] + row[5:6] + row[7:] == [other[1]] + other[5:6] + other[7:], (name, row, other)
        for column in (2, 3):
            assert abs(float(row[column]) - float(other[column])) <= float(row[6]) + float(other[6]) <= 1e-8, (name, row, other)
END_OF_PYTHON
}

# A vibration that grows beside the multiplier of a faster one is not mistaken for it.
crowded() {
  sed -e '/^SPEED\|^MODES\|^REPORT\|^END\|^CRANK/d' inputs/kitis.deck >"$scratch/crowded.deck"
  printf '%s\n' "SPEED 50.34 50.36 50.42 rad/s" "MODES 4" "REPORT stability" >>"$scratch/crowded.deck"
  run 0 --quiet --out "$out" "$scratch/crowded.deck" || return 1
  grep -v '^#' "$out/crowded/stability.dat" | awk '/unstable/ {printf "%d %s %.4f ", $2, $8, $4}' >"$scratch/found"
  [ "$(cat "$scratch/found")" = "2 unstable:fold 0.1065 2 unstable:fold 0.1095 3 unstable:fold 0.1042 " ] || { cat "$scratch/found"; return 1; }
}

# Modes 3 and 4 meet at 57.8 rad/s, where a fold of mode 3 stops for a while: the intervals on both sides are found. A crank too slow
# for the samples is named.
gaps() {
  first passed "" "SPEED 57.7 58" "REPORT intervals"
  run 0 --quiet --out "$out" "$scratch/passed.deck" || return 1
  awk '!/^#/ && NF {printf "%.3f %.3f %s %s %.4f ", $1, $2, $3, $4, $5}' "$out/passed/intervals.dat" >"$scratch/rows"
  [ "$(cat "$scratch/rows")" = "57.765 57.799 fold 3 0.0282 57.833 57.964 fold 3 0.0510 " ] || { cat "$scratch/rows"; return 1; }
  first gap "" "SPEED 0.1 0.2" "REPORT intervals"
  run 1 --json --out "$out" "$scratch/gap.deck" && says "intervals, speeds 0.1 to 0.2 rad/s: too many vibrations" || return 1
  [ "$(grep -c '^# failed from=0.1 to=0.2 : too many vibrations' "$out/gap/intervals.dat")" = 1 ] || { echo "no row in intervals.dat"; return 1; }
  grep -q '"stage": *"intervals"' "$scratch/stdout" || { echo "no failure in the summary"; return 1; }
}

# Damping so high that multipliers are lost in rounding; a crank too slow for the samples; both for single speeds.
lost() {
  first damped "" "DAMPING * time=1" "SPEED 20" "REPORT stability"
  run 1 --quiet --out "$out" "$scratch/damped.deck" && says "stability, speed 20 rad/s: " && says "fade" || return 1
  first slow "" "SPEED 0.01" "REPORT stability"
  run 1 --quiet --out "$out" "$scratch/slow.deck" && says "stability, speed 0.01 rad/s: the crank turns too slowly" || return 1
  grep -q '^# failed speed=0.01 : the crank turns too slowly' "$out/slow/stability.dat"
}

# Of two cranks one does not turn: failed rows of every table.
rocker() {
  first rocker 's/length=100 /length=$L /' "VARY L 100 250" "SPEED 50 50.5" "REPORT stability accuracy=1e-3" \
    "REPORT intervals accuracy=1e-3" "REPORT campbell accuracy=1e-3"
  run 1 --quiet --out "$out" "$scratch/rocker.deck" && says "L=250, stability, speed 50 rad/s: the crank does not turn fully" || return 1
  for table in stability intervals campbell; do
    grep -q '^# failed L=250 .*the crank does not turn fully' "$out/rocker/$table.dat" || { echo "failures of $table.dat"; return 1; }
    grep -q '^ *100 ' "$out/rocker/$table.dat" || { echo "no rows in $table.dat"; return 1; }
  done
}

# The echo is a deck with the same tables.
echo_deck() {
  run 0 --quiet --out "$scratch/again" "$out/one/threads/echo.deck" && same_tables "$out/one/threads" "$scratch/again/echo"
}

check "exponents, intervals and motions are the same for any number of threads" threads
check "variants have the exponents of plain decks" variants
check "a mechanism described otherwise has the same exponents" otherwise
check "a vibration that grows beside a faster one is found" crowded
check "intervals that others pass through are found, speeds that cannot be followed named" gaps
check "speeds whose exponents are lost are named" lost
check "a crank that does not turn has no exponents" rocker
check "an echo of a deck with reports on stability is the same deck" echo_deck
