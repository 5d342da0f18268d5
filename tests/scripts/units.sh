#!/bin/sh
# Units of results: the unit of speeds that the deck uses, N, N m and J where the deck's own units have no name, or what UNITS says.
. tests/scripts/functions.sh

out=$scratch/out

# loaded CARD...: a four-bar of rigid bodies under loads.
loaded() {
  motion_deck "0 to 360 step 30" |
    sed 's/^UNITS.*//; s/length=\([0-9.]*\)/length=\1mm mass=0.5kg inertia=200kg*mm2/; s/ 254 / 254mm /'
  printf '%s\n' "FORCE B 3N 1N" "REPORT reactions" "REPORT lagrange" "REPORT balance" "REPORT inertia" "INERTIA distributed" "$@"
}

# columns TABLE: the units of its columns.
columns() {
  head -n 1 "$out/$1.csv" | tr ',' '\n' | sed -n 's/.*\[\(.*\)\].*/\1/p' | sort -u | tr '\n' ' '
}

speeds() {
  loaded "UNITS mm kg s" "SPEED 0 to 300.3 step 100.1 rpm" >"$scratch/rpm.deck"
  run 0 --format csv --out "$out" "$scratch/rpm.deck" && silent || return 1
  python3 -B - "$out/rpm" <<'END_OF_PYTHON'
import csv, os, sys
for table in ("kinematics", "reactions", "lagrange", "balance", "inertia"):
    head, *rows = csv.reader(open(os.path.join(sys.argv[1], table + ".csv"), encoding="utf-8", newline=""))
    assert head[0] == "speed [rpm]", f"{table}: {head[0]}"
    assert sorted({float(row[0]) for row in rows}) == [0, 100.1, 200.2, 300.3], f"{table}: {rows[-1][0]}"
END_OF_PYTHON
}
check "tables have the speeds of the deck, to the last digit" speeds

units_of_tables() {
  for expected in "rpm/reactions:N N.m deg rpm" "rpm/lagrange:J N.m deg kg.mm2 rpm" "rpm/inertia:N N.m deg kg mm mm/s2 rpm"; do
    found=$(columns "${expected%%:*}")
    [ "$found" = "${expected#*:} " ] || { echo "${expected%%:*} has $found"; return 1; }
  done
  grep -q '^force at pin B: 3, 1 N$' "$out/rpm/run.log" || { echo "run.log"; return 1; }
  grep -q '^# external loads: force 3 1 N at pin B$' "$out/rpm/reactions.dat" || { echo "remark"; return 1; }
}
check "forces, torques and energies in customary units" units_of_tables

# The same deck with all units of its results chosen: the same quantities, to 12 digits.
chosen() {
  loaded "UNITS mm kg s force=lbf torque=lbf*in energy=kJ speed=deg/s" "SPEED 0 to 300.3 step 100.1 rpm" >"$scratch/chosen.deck"
  run 0 --format csv --out "$out" "$scratch/chosen.deck" && silent || return 1
  python3 -B - "$out/rpm" "$out/chosen" <<'END_OF_PYTHON'
import csv, os, sys
lbf = 0.45359237*9.80665
factors = {"N": ("lbf", 1/lbf), "N.m": ("lbf.in", 1/(lbf*0.0254)), "J": ("kJ", 1e-3), "rpm": ("deg/s", 6)}
for table in ("kinematics", "reactions", "lagrange", "balance", "inertia"):
    one, other = (list(csv.reader(open(os.path.join(folder, table + ".csv"), encoding="utf-8", newline="")))
                  for folder in sys.argv[1:])
    assert len(one) == len(other) > 40, table
    for column, head in enumerate(one[0]):
        unit = head[head.find("[") + 1:-1] if "[" in head else "-"
        name, factor = factors.get(unit, (unit, None))
        assert other[0][column] == head.replace(f"[{unit}]", f"[{name}]"), other[0][column]
        for a, b in zip(one[1:], other[1:]):
            if factor is None:
                assert a[column] == b[column], f"{table}: {head}"
            else:
                assert abs(float(a[column])*factor - float(b[column])) <= 1e-13*abs(float(b[column])), f"{table}: {head}: {b}"
END_OF_PYTHON
}
check "UNITS chooses the units of results, and nothing else" chosen

# A parallelogram with a dead point, and strips that its speed bends: failed rows, messages and the log name the speed as the deck
# does.
failed_speeds() {
  beam_deck "CRANK 0 90" "SPEED 3000 rpm" "REPORT frequencies" | sed 's/279.4/254/; s/266.7/100/' >"$scratch/failed.deck"
  run 1 --out "$out" "$scratch/failed.deck" && says "at speed 3000 rpm, crank 90 deg" || return 1
  grep -q 'at speed 3000 rpm, crank 90 deg' "$out/failed/run.log" || { echo "run.log"; return 1; }
  grep -q '^# failed speed=3000 crank=0 : ' "$out/failed/frequencies.dat" || { echo "no failed row at 3000"; return 1; }
}
check "failed rows and warnings have the speed of the deck" failed_speeds

motion() {
  loaded "UNITS mm kg s" "MOTOR torque=1N*m" "REPORT motion crank=30 speed=90rpm end=0.03 step=0.001" >"$scratch/motion.deck"
  run 0 --format csv --out "$out" "$scratch/motion.deck" && silent || return 1
  [ "$(columns motion/motion)" = "J N.m deg mm rpm s " ] || { echo "units $(columns motion/motion)"; return 1; }
  [ "$(columns motion/kinematics)" = "deg mm rad/s2 rpm " ] || { echo "units $(columns motion/kinematics)"; return 1; }
  python3 -B - "$out/motion/motion.csv" <<'END_OF_PYTHON'
import csv, sys
rows = list(csv.reader(open(sys.argv[1], encoding="utf-8", newline="")))[1:]
assert [float(row[0]) for row in rows] == [float(f"{i}e-3") for i in range(31)], "times are not those of a person"
assert float(rows[0][1]) == 30 and float(rows[0][4]) == 90, rows[0]
END_OF_PYTHON
}
check "a motion has the unit of its own speed" motion

# What bare numbers mean does not change, and a warning tells so.
bare() {
  loaded "UNITS mm kg s" "SPEED 100 rpm" "TORQUE follower 20000" >"$scratch/bare.deck"
  run 0 --out "$out" "$scratch/bare.deck" &&
    says "warning: bare torques are in kg.mm2/s2 (1e-6 N.m), and results in N.m; did you mean '20000N*m'?" || return 1
  sed 's/ 20000$/ 0.02N*m/' "$scratch/bare.deck" >"$scratch/named.deck"
  run 0 --out "$out" "$scratch/named.deck" && silent && same_tables "$out/bare" "$out/named"
}
check "bare numbers mean what they meant" bare
