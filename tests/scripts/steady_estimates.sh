#!/bin/sh
# Values of the steady response beside their printed errors: constants, both directions of rotation, accuracies.
. tests/scripts/functions.sh

out=$scratch/out

# A straight link turns alone: all is the same over the turn, and found within a minute of a processor.
constant() {
  cat >"$scratch/arm.deck" <<'END_OF_DECK'
UNITS m kg s
MATERIAL steel E=2e11 density=7800
SECTION thin rectangle thickness=0.01 width=0.02
GROUND O 0 0
PIN B 1 0
LINK arm O B material=steel section=thin
DRIVE arm
SPEED 10 rad/s
CRANK 0 90
REPORT response
REPORT peaks
REPORT validity
END_OF_DECK
  (ulimit -t 60; exec "$program" --quiet --out "$out" "$scratch/arm.deck") 2>"$scratch/stderr" || { echo "status $?"; return 1; }
  ! grep -q 'not reached' "$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  # EA u'' = -mu omega^2 (x + u): the tip of a spun bar moves by tan(k L)/k - L, k^2 = mu omega^2/EA.
  python3 -B - "$out/arm" <<'END_OF_PYTHON'
import math, sys
k = math.sqrt(7800 * 100 / 2e11)
wanted = math.tan(k) / k - 1
rows = {}
for name in ("validity", "peaks", "response"):
    with open(f"{sys.argv[1]}/{name}.dat", encoding="utf-8") as file:
        rows[name] = [line.split() for line in file if line.strip() and line[0] != "#"]
assert abs(float(rows["validity"][0][2]) / wanted - 1) < 1e-7, rows["validity"]
assert float(rows["validity"][0][-1]) < 1e-6, rows["validity"]
assert [rows["peaks"][0][i] for i in (4, 7, 10)] == ["-"] * 3, rows["peaks"]
assert len(rows["response"]) == 2 and all(float(row[-1]) < 1e-6 for row in rows["response"])
END_OF_PYTHON
}

# Undamped, a crank that turns the other way has the same validity by time reversal; the values of two accuracies, and of a
# linkage that is turned, differ by no more than their errors.
reversed_and_finer() {
  deck 20 1e-8 254 0 >"$scratch/one.deck"
  deck -20 1e-8 254 0 >"$scratch/back.deck"
  deck 20 1e-11 254 0 >"$scratch/finer.deck"
  deck 20 1e-8 93.5 236.16466712867953 >"$scratch/turned.deck"
  for name in one back finer turned; do
    run 0 --quiet --out "$out" "$scratch/$name.deck" || return 1
  done
  python3 -B - "$out" <<'END_OF_PYTHON'
import sys
def rows(name):
    with open(f"{sys.argv[1]}/{name}/validity.dat", encoding="utf-8") as file:
        return [[float(word) for word in line.split()[2:]] for line in file if line.strip() and line[0] != "#"]
one = rows("one")
assert len(one) == 3 and all(row[-1] < 1e-6 for row in one), one
assert 0.05 < one[0][2] < 0.06 and abs(one[0][4] - 0.8318435) < 1e-6, one
for name in ("back", "finer", "turned"):
    for a, b in zip(one, rows(name)):
        for x, y in zip(a[:-1], b[:-1]):
            assert abs(x - y) <= a[-1] * abs(x) + b[-1] * abs(y) + 1e-9 * abs(x), (name, a, b)
END_OF_PYTHON
}

# Vibrations of which nothing is left after a turn: the multipliers are 0, and are found at once.
faded() {
  deck 20 1e-6 254 0 | sed 's/^SPEED.*/&\nDAMPING * time=3e-3/' >"$scratch/faded.deck"
  (ulimit -t 60; exec "$program" --quiet --out "$out" "$scratch/faded.deck") || return 1
  awk '!/^#/ && NF { rows++; if ($7 != "-" && ($7 - 1)^2 < 1e-18 && $8 < 1e-6) right++ } END { exit !(rows == 3 && right == 3) }' \
    "$out/faded/validity.dat" || { cat "$out/faded/validity.dat"; return 1; }
}

# A column on a shaft that turns slowly, with a force across and one along it: H/P (tan kL/k - L), k^2 = P/EI, by second-order
# theory; its tip turns by H/P (1/cos kL - 1).
column() {
  cat >"$scratch/column.deck" <<'END_OF_DECK'
UNITS m kg s
MATERIAL light E=2e11 density=0.5
SECTION heavy general A=0.009 I=2e-4
GROUND O 0 0
PIN T 8 0
LINK column O T length=8 material=light section=heavy
FORCE T 5000 -900000
DRIVE column
CRANK 90
SPEED 0.5 rad/s
REPORT response accuracy=1e-8
END_OF_DECK
  run 0 --quiet --out "$out" "$scratch/column.deck" || return 1
  python3 -B - "$out/column/response.dat" <<'END_OF_PYTHON'
import math, sys
with open(sys.argv[1], encoding="utf-8") as file:
    row = [line.split() for line in file if line.strip() and line[0] != "#"][0]
across, along, length = 5000.0, 9e5, 8.0
k = math.sqrt(along / (2e11 * 2e-4))
assert abs(float(row[3]) / (across / along * (math.tan(k * length) / k - length)) - 1) < 1e-6, row
assert abs(math.radians(-float(row[5])) / (across / along * (1 / math.cos(k * length) - 1)) - 1) < 1e-6, row
END_OF_PYTHON
}

# The flexible slider-crank of Simeon ("crank" of the IVP test set) at 150 rad/s, in steady motion: the middle of the rod, and the
# piston, whose displacement is small beside that.
simeon() {
  cat >"$scratch/simeon.deck" <<'END_OF_DECK'
UNITS mm kg s
MATERIAL steel E=2e5MPa density=7.87e-6
SECTION square rectangle thickness=8 width=8
GROUND bearing 0 0
LINK wheel bearing P length=150 rigid mass=0.36
LINK rod P piston length=300 material=steel section=square
GUIDE liner 0 0 angle=0
SLIDER piston liner mass=0.075552
BRANCH piston forward
POINT middle rod along=150
DRIVE wheel
SPEED 150 rad/s
CRANK 139.43669269623547
REPORT response
END_OF_DECK
  run 0 --quiet --out "$out" "$scratch/simeon.deck" || return 1
  python3 -B - "$out/simeon/response.dat" <<'END_OF_PYTHON'
import math, sys
with open(sys.argv[1], encoding="utf-8") as file:
    rows = {line.split()[2]: [float(word) for word in line.split()[3:]] for line in file if line.strip() and line[0] != "#"}
assert abs(math.hypot(*rows["middle"][:2]) / 0.21791 - 1) < 1e-3, rows
assert abs(rows["piston:rod"][0] / -8.84384747873771e-3 - 1) < 3e-2, rows
END_OF_PYTHON
}

# deck SPEED ACCURACY X Y: the first mechanism with the pivot of its follower there.
deck() {
  cat <<END_OF_DECK
UNITS mm tonne s
MATERIAL steel E=200000 density=7.8e-9 nu=0.3
SECTION strip rectangle thickness=1.6 width=25.4
GROUND O2 0 0
GROUND O4 $3 $4
LINK crank O2 A length=100 material=steel section=strip
LINK coupler A B length=279.4 material=steel section=strip
LINK follower O4 B length=266.7 material=steel section=strip
DRIVE crank
SPEED $1 rad/s
REPORT validity accuracy=$2
END_OF_DECK
}

check "the response of an arm that turns alone is constant, and its tables say so" constant
check "validity stands backwards, turned and at a finer accuracy" reversed_and_finer
check "vibrations that fade within a turn are as far from resonance as can be" faded
check "a column bends as by second-order theory" column
check "the slider-crank of Simeon moves as published" simeon
