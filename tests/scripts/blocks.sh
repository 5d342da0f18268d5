#!/bin/sh
# Long lists of positions come in blocks: the same bytes as in one piece, and memory does not grow with the rows.
. tests/scripts/functions.sh

# deck NAME STEP REPORT...: a rocker that is out of reach beyond 90 degrees.
deck() {
  path=$scratch/$1.deck
  cat >"$path" <<END_OF_DECK
UNITS mm kg s
GROUND O2 0 0
GROUND O4 30 0
LINK a O2 A length=40 mass=1 inertia=20 center=10,1
LINK b A B length=20 mass=1 inertia=20 center=10,1
LINK c O4 B length=30 mass=1 inertia=20 center=10,1
DRIVE a
INERTIA distributed
SPEED 10 20
CRANK -85 to 95 step $2
END_OF_DECK
  shift 2
  for report in "$@"; do
    echo "REPORT $report"
  done >>"$path"
}

# With REPORT linkage, which looks back, the same deck is one piece.
pieces() {
  deck long 0.0036 kinematics "reactions columns=speed,crank,torque"
  mkdir -p "$scratch/one" && cp "$scratch/long.deck" "$scratch/one/long.deck" && echo "REPORT linkage" >>"$scratch/one/long.deck"
  run 1 --quiet --threads 2 --format csv --out "$scratch/a" "$scratch/long.deck" || return 1
  run 1 --quiet --format csv --out "$scratch/b" "$scratch/one/long.deck" || return 1
  for name in kinematics.dat kinematics.csv reactions.dat reactions.csv run.log; do
    cmp "$scratch/a/long/$name" "$scratch/b/long/$name" || return 1
  done
  [ "$(ls "$scratch/a/long" | wc -l)" -eq 7 ] && return
  ls "$scratch/a/long"
  return 1
}
check "blocks and one piece have the same bytes" pieces

# 50,000 positions more, which would take 50 MB.
growth() {
  for step in 0.0036 0.0018; do
    deck "long$step" $step "kinematics columns=crank"
  done
  python3 -B - "$program" "$scratch" <<'END_OF_PYTHON'
import os, subprocess, sys
program, scratch = sys.argv[1:]
peaks = []
for step in "0.0036", "0.0018":
    child = subprocess.Popen([program, "--quiet", "--out", os.path.join(scratch, "out"), os.path.join(scratch, f"long{step}.deck")],
                             stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    assert os.waitstatus_to_exitcode(status) == 1
    peaks.append(usage.ru_maxrss)
assert peaks[1] - peaks[0] < 15000, f"memory of 50,001 and 100,001 positions: {peaks} kB"
END_OF_PYTHON
}
check "memory does not grow with rows" growth
