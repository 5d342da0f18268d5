#!/bin/sh
# The elastic response through the whole program: threads, VARY, speeds that fail, warnings, CSV and JSON.
. tests/scripts/functions.sh

out=$scratch/out

# elastic NAME CARD...: a deck with all reports on the response.
elastic() {
  name=$1
  shift
  beam_deck "$@" "CRANK 0 90 200" "REPORT response accuracy=1e-3" "REPORT strains" "REPORT peaks" "REPORT torque" "REPORT validity" |
    sed '/^MESH/d; /^INERTIA/d; s/accuracy=1e-3//; s/^REPORT.*/& accuracy=1e-3/' >"$scratch/$name.deck"
}

# Speeds are shared out to threads, and so are variants.
threads() {
  elastic threads "DAMPING * ratio=0.05" "SPEED 8 9 10 12"
  run 0 --quiet --format csv --out "$out/one" "$scratch/threads.deck" &&
    run 0 --quiet --format csv --threads 3 --out "$out/three" "$scratch/threads.deck" && same "$out/one" "$out/three" || return 1
  elastic varied "VARY z 0.04 0.0625 0.08" "DAMPING * ratio=\$z" "SPEED 8 10"
  run 0 --quiet --format csv --out "$out/one" "$scratch/varied.deck" &&
    run 0 --quiet --format csv --threads 3 --out "$out/three" "$scratch/varied.deck" && same "$out/one" "$out/three"
}

# A variant has the rows of the plain deck after its value.
variants() {
  elastic plain "SET z 0.0625" "DAMPING * ratio=\$z" "SPEED 8 10"
  run 0 --quiet --out "$out" "$scratch/plain.deck" || return 1
  for table in response strains peaks torque validity; do
    grep -v '^#' "$out/one/varied/$table.dat" | grep '^ *0\.0625 ' | cut -c 27- >"$scratch/rows"
    grep -v '^#' "$out/plain/$table.dat" | grep . | sed 's/^ *//' >"$scratch/wanted"
    sed 's/^ *//' "$scratch/rows" | cmp -s - "$scratch/wanted" || { echo "$table.dat differs"; return 1; }
    [ -s "$scratch/wanted" ] || { echo "$table.dat is empty"; return 1; }
  done
}

# Of two cranks one does not turn: each of its speeds is a failed row of every table, and a member of the JSON document.
rocker() {
  elastic rocker "VARY L 100 250" "DAMPING * ratio=0.05" "SPEED 8 10"
  sed -i 's/length=100/length=$L/' "$scratch/rocker.deck"
  sed -i 's/CRANK 0 90 200/CRANK 90/' "$scratch/rocker.deck"
  run 1 --format csv --out "$out" "$scratch/rocker.deck" && says "L=250, response, speed 8 rad/s: the crank does not turn fully" || return 1
  for table in response strains peaks torque validity; do
    [ "$(grep -c '^# failed L=250 speed=[18]0* : the crank does not turn fully' "$out/rocker/$table.dat")" -eq 2 ] ||
      { echo "failures of $table.dat"; return 1; }
    grep -q '^ *100 ' "$out/rocker/$table.dat" || { echo "no rows in $table.dat"; return 1; }
    [ "$(grep -c 'does not turn fully' "$out/rocker/$table.csv")" -eq 2 ] || { echo "failures of $table.csv"; return 1; }
  done
  run 1 --json --out "$out" "$scratch/rocker.deck" || return 1
  python3 -B - "$scratch/stdout" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    failures = json.load(file)["decks"][0]["failures"]
assert [(f["stage"], f["speed"], f["crank"], f["parameters"]["L"]) for f in failures] == \
    [("response", 8, None, 250), ("response", 10, None, 250)], failures
END_OF_PYTHON
}

# A deck without VARY whose crank does not turn is refused.
refused() {
  elastic refused "DAMPING * ratio=0.05" "SPEED 8 10"
  sed -i 's/length=100/length=250/; s/CRANK 0 90 200/CRANK 90/' "$scratch/refused.deck"
  run 2 --out "$out" "$scratch/refused.deck" && says "the crank turns only"
}

warnings() {
  elastic undamped "SPEED 4"
  run 0 --out "$out" "$scratch/undamped.deck" && says "no link has DAMPING" || return 1
  elastic fast "DAMPING * ratio=0.05" "SPEED 20"
  run 0 --out "$out" "$scratch/fast.deck" && says "above 1 % the linear equations become unreliable" || return 1
  grep -q '^response: orders ' "$out/fast/run.log" || { echo "no orders in the log"; return 1; }
  grep -q '; largest strain 0.000[0-9]*, displacement [0-9.]* mm' "$scratch/stdout" || { cat "$scratch/stdout"; return 1; }
  elastic calm "DAMPING * ratio=0.05" "SPEED 4"
  run 0 --out "$out" "$scratch/calm.deck" && silent
}

# The echo is a deck with the same tables.
echo_deck() {
  run 0 --quiet --out "$scratch/again" "$out/calm/echo.deck" && same_tables "$out/calm" "$scratch/again/echo"
}

# Links of a stiff section, slow and strongly damped: nothing is left of a vibration after a turn, and zero has no logarithm.
gone_after_a_turn() {
  cat >"$scratch/gone.deck" <<'END_OF_DECK'
UNITS    m kg s
VARY     depth 0.0252228 0.025475028
GROUND   O2 0 0
GROUND   O4 0.89435 0
MATERIAL soft E=9551.047MPa density=3708.1491344 nu=0.3
SECTION  high channel depth=$depth width=71.0012566mm web=0.00252228063 flange=0.00504456 plane=flanges
LINK     crank    O2 A length=0.185437 material=soft section=high
LINK     coupler  A  B length=0.75829 material=soft section=high
LINK     follower B O4 length=0.773454 material=soft section=high
DRIVE    crank
CRANK    90 to -90 step -15
EFFECTS  axial shear rotary
SPEED    0.63302 rad/s
DAMPING  * ratio=0.3
REPORT   response
END_OF_DECK
  run 0 --quiet --out "$out" "$scratch/gone.deck"
}

check "vibrations that are gone after a turn" gone_after_a_turn
check "the response is the same for any number of threads" threads
check "variants have the rows of plain decks" variants
check "a crank that does not turn fails all speeds of its variant" rocker
check "a deck with a crank that does not turn is refused" refused
check "warnings, log and line after a run of the response" warnings
check "an echo of a deck with a response is the same deck" echo_deck
