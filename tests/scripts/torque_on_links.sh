#!/bin/sh
# A TORQUE on a link that bends acts alike whichever pin its card names first, and whatever POINT cuts it that carries nothing.
. tests/scripts/functions.sh

# machine FIRST SECOND CARD...: a four-bar of steel strip whose follower has a point P
machine() {
  cat <<END
UNITS    mm tonne s
MATERIAL steel E=200000 density=7.8e-9
SECTION  strip rectangle thickness=1.6 width=25.4
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank O2 A length=100 material=steel section=strip
LINK     coupler A B length=279.4 material=steel section=strip
LINK     follower $1 $2 length=266.7 material=steel section=strip
DRIVE    crank
BRANCH   B left A O4
INERTIA  distributed
END
  shift 2
  printf '%s\n' "$@"
}

# agree SHARE FILE FILE: rows and words are the same, numbers to this share of the largest in their column
agree() {
  awk -v share="$1" '/^#/ || !NF { next }
    FNR == NR { n++; for (i = 1; i <= NF; i++) { first[n, i] = $i; size = $i < 0 ? -$i : $i + 0; if (size > large[i]) large[i] = size }; next }
    { m++; for (i = 1; i <= NF; i++) { d = $i - first[m, i]; if (d < 0) d = -d
        if ($i ~ /^[A-Za-z]/ ? $i != first[m, i] : d > share*large[i]) { print "row " m ", column " i ": " first[m, i] " and " $i; exit 1 } } }
    END { if (n != m || !n) { print n " rows and " m; exit 1 } }' "$2" "$3"
}

order_of_pins() {
  set -- "GROUND H -100 300" "TORQUE follower -5000" "SPRING s P H stiffness=0.05 free_length=300" "EFFECTS axial" "CRANK 60" \
    "MESH * accuracy=1e-12" "REPORT frequencies columns=f1,f2,f3"
  machine O4 B "POINT P follower along=50" "$@" >"$scratch/there.deck"
  machine B O4 "POINT P follower along=216.7" "$@" >"$scratch/back.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/there.deck" "$scratch/back.deck" || return 1
  agree 1e-12 "$scratch/out/there/frequencies.dat" "$scratch/out/back/frequencies.dat"
}

# The torque works on what a straight link turns from end to end, as of a link without points.
idle_point() {
  set -- "TORQUE follower 500" "DAMPING * time=1e-4" "CRANK 0 90" "SPEED 20" "REPORT response columns=ux,uy,rotation accuracy=1e-8"
  machine O4 B "$@" >"$scratch/whole.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/whole.deck" || return 1
  for along in 10 100 250; do
    machine O4 B "POINT P follower along=$along" "PINMASS P 1e-25" "$@" >"$scratch/cut.deck"
    run 0 --quiet --out "$scratch/out" "$scratch/cut.deck" || return 1
    grep -v ' P' "$scratch/out/cut/response.dat" >"$scratch/cut.dat"
    agree 1e-7 "$scratch/out/whole/response.dat" "$scratch/cut.dat" || return 1
  done
}

check "a torque on a link named from either end" order_of_pins
check "a torque on a link with an idle point" idle_point
