#!/bin/sh
# Exponents and critical speeds of running linkages that once were wrong without a word, with values known otherwise.
. tests/scripts/functions.sh

out=$scratch/out

# rows TABLE: the rows of a table.
rows() { grep -v '^#' "$out/$1" | grep .; }

# deck NAME: a deck from standard input, run.
deck() {
  cat >"$scratch/$1.deck" && run 0 --quiet --out "$out" "$scratch/$1.deck"
}

# Growth of a fold by 2080 in a turn: the same to 1e-8 with 2, 4 and 6 modes, accuracies to 1e-8. It was 7.640926 +- 3e-5.
growth() {
  deck fold <<'DECK' || return 1
UNITS    m kg s
MATERIAL steel E=210000000000.0 density=7850 nu=0.3
MATERIAL al    E=70000000000.0 density=2700 nu=0.33
SECTION  s0 circle diameter=0.003381413415689528
SECTION  s1 circle diameter=0.002844788906893993
SECTION  s2 rectangle thickness=0.00448138538960976 width=0.010524388992080039
GROUND   O2 0 0
GROUND   O4 0.03798913924708631 0
LINK     crank O2 A length=0.02727252257052847 material=steel section=s0
LINK     coupler A B length=0.030741603193726243 material=al section=s1
LINK     follower O4 B length=0.039287996843574396 material=al section=s2
DRIVE    crank
BRANCH   open
PINMASS  B 0.00038806077944293724
MASS     crank 5.490552039019413e-05 at=0.019748556168369024 offset=0.004515667776698129 inertia=4.577258517757015e-10
MASS     follower 4.5091280736274965e-05 at=0.015487157518885323 inertia=2.0359832694978153e-10
DAMPING  * ratio=0.007426630220203165
SPEED    -1395.7027518026994
EFFECTS  axial rotary
MODES    2
REPORT   stability accuracy=1e-3
DECK
  rows fold/stability.dat | awk '
    $2 == 2 { found = 1; if ($8 != "unstable:fold" || $4 - 7.64033965 > $7 || 7.64033965 - $4 > $7 || $7 > 1e-3) { print; exit 1 } }
    END { if (!found) exit 1 }'
}

# The most excited critical speed of a strongly damped four-bar: the middle of the speeds 0.54829 and 0.56130 between which its
# multiplier is real. It was left out.
critical() {
  deck middle <<'DECK' || return 1
UNITS    m kg s
MATERIAL steel E=210GPa density=7850
SECTION  s0 rectangle thickness=0.024007 width=0.174851
SECTION  s1 rectangle thickness=0.043008 width=0.216777
SECTION  s2 rectangle thickness=0.0388735 width=0.0235026
GROUND   O2 0 0
GROUND   O4 4.4116255 0
LINK     crank    O2 A length=2.9459958 material=steel section=s0
LINK     coupler  A  B length=4.7265451 material=steel section=s1
LINK     follower O4 B length=4.7388163 material=steel section=s2
DRIVE    crank
DAMPING  * time=0.03036
FORCE    B 1252.8 -520.55
SPEED    0.54 0.57
MODES    1
REPORT   campbell accuracy=1e-4
DECK
  rows middle/critical.dat | awk '
    { n += 1; if ($1 < 0.554791 || $1 > 0.554801 || $3 != 8) { print; bad = 1 } }
    END { exit !(n == 1 && !bad) }'
}

# Frozen with its crank at some angles, the rod buckles under the forces of 200 rad/s; moving, it vibrates three times in two turns.
buckled() {
  deck rod <<'DECK' || return 1
UNITS    m kg s
MATERIAL steel E=2e11 density=7800
SECTION  strip rectangle thickness=0.002 width=0.02
GROUND   O 0 0
LINK     crank O A length=0.06 rigid mass=0
LINK     rod   A B length=0.3 material=steel section=strip
GUIDE    bore 0 0 angle=0
SLIDER   B bore mass=0.1
BRANCH   B forward
DRIVE    crank
MODES    1
SPEED    190 200
REPORT   campbell
DECK
  rows rod/campbell.dat | awk '
    NR == 1 && $3 == "-" { print; bad = 1 }
    NR == 2 && ($3 $4 $5 $6 != "----" || $7 < 47.746482 || $7 > 47.746483) { print; bad = 1 }
    END { exit bad || NR != 2 }'
}

# Yoo and Shin (J. Sound Vib. 212, 1998): a cantilever of slenderness 70 on a hub as large as it is long, turning at 2 and 10 times
# sqrt(EI/(rho A L^4)): first frequencies 4.397801 and 13.048159 of these. Its loads are constant: no speed is critical.
hub() {
  deck hub <<'DECK' || return 1
UNITS    m kg s
MATERIAL unit  E=4900 density=1
SECTION  s     general A=1 I=2.0408163265306123e-4
GROUND   O 0 0
PIN      H 1 0
PIN      B 2 0
LINK     hub   O H rigid mass=0 inertia=0
LINK     blade H B material=unit section=s
WELD     H hub blade
DRIVE    hub
MODES    1
SPEED    2 10 rad/s
REPORT   stability
REPORT   campbell accuracy=1e-4
DECK
  rows hub/stability.dat | awk '
    $2 == 1 { f = 2*3.14159265358979*$5; w = $1 < 5 ? 4.397801 : 13.048159; if (f - w > 1e-6 || w - f > 1e-6) { print f; bad = 1 } }
    END { exit bad || NR != 2 }' || return 1
  [ "$(rows hub/critical.dat | grep -c .)" -eq 0 ] || { rows hub/critical.dat; return 1; }
}

# Where a multiplier is real from 92.10 to 93.41 rad/s: one critical speed in the middle, its excitation the same for all accuracies.
middle() {
  for accuracy in 1e-2 1e-4 1e-6; do
    deck middle <<DECK || return 1
UNITS    m kg s
MATERIAL steel E=2.1e11 density=2277.2
SECTION  s0 rectangle thickness=0.0029314 width=0.012226
SECTION  s1 rectangle thickness=0.0024615 width=0.036118
SECTION  s2 rectangle thickness=0.0095043 width=0.027179
GROUND   O2 0 0
GROUND   O4 0.313571 0
LINK     crank O2 A length=0.122257 material=steel section=s0
LINK     coupler A B length=0.361179 material=steel section=s1
LINK     follower O4 B length=0.271786 material=steel section=s2
DRIVE    crank
BRANCH   open
FORCE    B -2.102 3.901
SPEED    90 96
MODES    1
REPORT   campbell accuracy=$accuracy
DECK
    rows middle/critical.dat | awk '{ d = $6/0.0749785 - 1; if (d > $8 || -d > $8 || $8 > 0.03 || $1*(1 - $2) > 92.3 || $1*(1 + $2) < 93.3) { print; bad = 1 } }
      END { exit bad || NR != 1 }' || return 1
  done
}

# A fold where the multiplier is real from 44.4 to 47.4 rad/s: the same middle, 45.86, for all ranges that have it, none for those
# that have only another part of the fold.
fold() {
  for range in "44.194 50.823 1" "43 51 2" "45 48 1" "45.5 46.5 2" "46 48 1"; do
    deck fold <<DECK || return 1
UNITS    m kg s
MATERIAL steel E=2.1e11 density=3175.5
SECTION  s0 rectangle thickness=0.0010056 width=0.01068
SECTION  s1 rectangle thickness=0.0022962 width=0.029756
SECTION  s2 rectangle thickness=0.0023411 width=0.024425
GROUND   O2 0 0
GROUND   O4 0.418674 0
LINK     crank O2 A length=0.106798 material=steel section=s0
LINK     coupler A B length=0.297555 material=steel section=s1
LINK     follower O4 B length=0.244252 material=steel section=s2
DRIVE    crank
BRANCH   crossed
PINMASS  B 0.04847
FORCE    B -0.5726 -1.34
SPEED    ${range% *}
MODES    ${range##* }
REPORT   campbell accuracy=1e-2
DECK
    rows fold/critical.dat | awk -v range="$range" 'BEGIN { split(range, end, " ") }
      $4 == 1 { count++; d = $1/45.86346 - 1; e = $6/0.1793993 - 1; if (d > 1e-3 || -d > 1e-3 || e > $8 || -e > $8 || $2 < 0.03 || $2 > 0.04) { print; bad = 1 } }
      END { if (count + 0 != (end[1] < 45.86 && end[2] > 45.87)) { print range ": " count + 0 " critical speeds"; bad = 1 } exit bad }' || return 1
  done
}

# Two that grow together are named alike in both rows, also where two shapes pass each other and numbers are not certain.
partners() {
  deck partners <<'DECK' || return 1
UNITS    m kg s
MATERIAL steel E=2e11 density=7800
SECTION  strip rectangle thickness=0.001055 width=0.00844
GROUND   O2 0 0
GROUND   O4 0.1988 0
LINK     crank O2 A length=0.0688 material=steel section=strip
LINK     coupler A B length=0.1915 material=steel section=strip
LINK     follower O4 B length=0.1994 material=steel section=strip
PINMASS  B 0.012713
DRIVE    crank
MODES    3
SPEED    73.833
REPORT   stability
DECK
  rows partners/stability.dat | awk '
    $8 ~ /[+]/ { split($8, word, /[:+]/); if (word[2] == word[3] || $2 != word[2] && $2 != word[3]) { print; bad = 1 } count++ }
    END { exit bad || !count }'
}

check "growth in a turn has an honest error" growth
check "the most excited critical speed is there" critical
check "Floquet frequencies remain where the frozen linkage buckles" buckled
check "a rotating beam on a hub has Yoo and Shin's frequencies and no critical speed" hub
check "a critical speed in an interval of real multipliers" middle
check "a critical speed in a wide fold" fold
check "two that grow together name each other" partners
