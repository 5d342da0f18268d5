#!/bin/sh
# Figures and animations: every table of inputs/rigid.deck is drawn, gnuplot has nothing to complain about, and a GIF is whole.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "figures and animations" "they are drawn from tables, which are the same in all builds"; exit ;;
esac

# drawn FOLDER KIND NAME...: without a word, figures or animations with these names and no others.
drawn() {
  folder=$scratch/out/$1
  kind=$2
  shift 2
  option=
  [ "$kind" = figures ] || option=--animate
  timeout "$longest" sh plots/draw_figures.sh $option "$folder" >"$scratch/stdout" 2>"$scratch/stderr" || {
    echo "status $?; it said:"
    cat "$scratch/stderr"
    return 1
  }
  silent || return 1
  for name in "$@"; do echo "$name"; done | sort >"$scratch/expected"
  sed '/^#/d; s/\.[a-z]*$//' "$folder/$kind/drawn.txt" | sort | diff "$scratch/expected" - || return 1
  for file in "$folder/$kind/"*.png; do
    [ ! -e "$file" ] || [ "$(wc -c <"$file")" -gt 8000 ] || { echo "$file is all but empty"; return 1; }
  done
}

# gif FILE PICTURES: it ends where it should, has so many pictures, none like the one before, and plays without end.
gif() {
  python3 - "$scratch/out/$1" "$2" <<'END_OF_PYTHON'
import sys

with open(sys.argv[1], "rb") as file:
    data = file.read()
assert data[:6] == b"GIF89a", "no GIF"
assert len(data) < 1000000, f"{len(data)} bytes"
assert b"NETSCAPE2.0\x03\x01\x00\x00" in data, "it does not play without end"

def blocks(place):
    start = place
    while data[place]:
        place += data[place] + 1
    return place + 1, data[start:place]

place = 13 + (3*2**((data[10] & 7) + 1) if data[10] & 128 else 0)
pictures = []
while data[place] != 0x3B:
    if data[place] == 0x21:
        place, content = blocks(place + 2)
    else:
        assert data[place] == 0x2C, f"an unknown block at byte {place}"
        flags = data[place + 9]
        frame = data[place + 1:place + 9]
        place, content = blocks(place + 11 + (3*2**((flags & 7) + 1) if flags & 128 else 0))
        pictures.append((frame, content))
assert place == len(data) - 1, "bytes behind its end"
assert len(pictures) == int(sys.argv[2]), f"{len(pictures)} pictures"
assert all(a != b for a, b in zip(pictures, pictures[1:])), "a picture that does not move"
END_OF_PYTHON
}

rigid_figures() {
  run 0 --out "$scratch/out" inputs/rigid.deck || return 1
  speeds=$(for name in balance forces harmonics lagrange point_rates reactions shaking_force; do
    echo ${name}_speed_5 ${name}_speed_10
  done)
  drawn rigid figures coupler_curve linkage kinematics_accelerations kinematics_angles kinematics_velocities motion \
    special_positions $speeds
}

rigid_animations() {
  drawn rigid animations forces_speed_5 forces_speed_10 linkage motion && gif rigid/animations/linkage.gif 72 &&
    gif rigid/animations/motion.gif 101 && gif rigid/animations/forces_speed_10.gif 72
}

# One speed is drawn against the crank angle; several, against the speed too, and gauges with a curve for every speed.
response_figures() {
  sed '/^END/d; s/^SPEED.*/SPEED 10 20 rad\/s/; s/^CRANK.*/CRANK 0 to 360 step 15/' inputs/response.deck >"$scratch/several.deck"
  printf '%s\n' 'MODES 2' 'INERTIA distributed' 'REPORT frequencies' END >>"$scratch/several.deck"
  run 0 --quiet --out "$scratch/out" inputs/response.deck "$scratch/several.deck" || return 1
  drawn response figures deformed_linkage deviation displacements pin_displacements strains torque || return 1
  speeds=$(for name in deformed_linkage deviation displacements frequencies pin_displacements strains torque; do
    echo ${name}_speed_10 ${name}_speed_20
  done)
  drawn several figures $speeds frequency_1_by_speed frequency_2_by_speed largest_strain validity strains_mid_coupler_by_speed \
    strains_mid_follower_by_speed
}

# The Campbell diagram needs several speeds; a table of intervals, which says more than verdicts, is drawn where it is there.
campbell_figure() {
  sed 's/^SPEED.*/SPEED 560 to 480 step -40 rpm/; s/^MODES.*/MODES 2/; /^DAMPING/d' inputs/campbell.deck >"$scratch/campbell.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/campbell.deck" && drawn campbell figures campbell || return 1
  cp "$scratch/out/campbell/figures/campbell.png" "$scratch/plain.png"
  printf '%s\n' '# from to' '# rpm rpm' '500 520' >"$scratch/out/campbell/intervals.dat"
  drawn campbell figures campbell && ! cmp -s "$scratch/out/campbell/figures/campbell.png" "$scratch/plain.png"
}

response_animation() {
  drawn response animations deformed_linkage && gif response/animations/deformed_linkage.gif 90
}

# Drawn links begin and end at their pins, displaced as in the table times the factor that the figure states, and turned likewise.
bent_links() {
  cat >"$scratch/bent.gp" <<'END_OF_SCRIPT'
figure_format = 'svg'
call ARG1.'/figure.gp' 'response.dat' ARG2 'deformed_linkage' '20'
step = 1e-5
do for [k=1:positions_drawn] {
    do for [link=2:4] {
        do for [last=0:1] {
            moved = bent($poses[k], $moved[k], link, last) - (last ? last_pin($poses[k], link) : first_pin($poses[k], link))
            way_on = (bent($poses[k], $moved[k], link, last + step) - bent($poses[k], $moved[k], link, last - step))/(2*step)
            turned = 180/pi*imag(way_on/(last_pin($poses[k], link) - first_pin($poses[k], link)))
            print sprintf('%.10g %s %.10g %.10g %.10g %.10g', word($moved[k], 1) + 0, word(link_ends, 2*link - 3 + last), magnified, \
                real(moved), imag(moved), turned)
        }
    }
}
END_OF_SCRIPT
  (cd "$scratch/out/response" && FLEXMECH=$program PLOTS=$root/plots LC_ALL=C.UTF-8 gnuplot -c "$scratch/bent.gp" "$root/plots" \
    "$scratch/bent") >"$scratch/stdout" 2>&1
  grep -q 'displacements drawn 10 times as large' "$scratch/bent.svg" || { echo "it does not state 10 times"; return 1; }
  python3 - "$scratch/stdout" "$scratch/out/response/response.dat" <<'END_OF_PYTHON'
import sys

with open(sys.argv[2], encoding="utf-8") as file:
    rows = [line.split() for line in file if line.strip() and not line.startswith("#")]
table = {(float(row[1]), row[2]): [float(word) for word in row[3:6]] for row in rows}
with open(sys.argv[1], encoding="utf-8") as file:
    lines = [line.split() for line in file]
assert len(lines) == 8*6, f"{len(lines)} ends of links: {lines[:1]}"
for crank, end, factor, *drawn in lines:
    assert float(factor) == 10, factor
    # A pivot without a row is not displaced; the crank is held there, the follower free to turn.
    known = (float(crank), end) in table
    wanted = table.get((float(crank), end), [0, 0, 0] if end == "O2:crank" else [0, 0])
    assert known or end.startswith("O"), end
    for value, found in zip(wanted, map(float, drawn)):
        assert abs(10*value - found) < 2e-4, (crank, end, value, found)
END_OF_PYTHON
}

# Harmonics of the speed meet a mode where they should, in any unit of speed; a table of less than a turn has no mean.
critical_speeds() {
  for unit in rad/s:6.283185307 rpm:60 deg/s:360; do
    {
      printf '# title\n# speed crank f1 f2\n# %s deg Hz Hz\n' "${unit%:*}"
      for speed in 10 1000; do
        for crank in 0 90 180 270 360; do
          echo $speed $crank "$((10 + crank % 360 / 90)) $((30 + 2 * (speed / 1000)))"
        done
      done
    } >"$scratch/critical.dat"
    awk -v want='critical 10 1000' -f plots/quoted.awk -f plots/tables.awk <"$scratch/critical.dat" >"$scratch/found"
    python3 - "$scratch/found" "${unit#*:}" <<'END_OF_PYTHON' || return 1
import sys

turns = float(sys.argv[2])
with open(sys.argv[1], encoding="utf-8") as file:
    found = [tuple(map(float, line.split())) for line in file]
# f1 is 11.5 Hz on average; f2 30 to 32 Hz, linear in the speed: n w/turns = 30 + 2 (w - 10)/990.
wanted = [(1, n, 11.5*turns/n) for n in range(1, 21)]
wanted += [(2, n, (30 - 20/990)/(n/turns - 2/990)) for n in range(1, 21)]
wanted = [row for row in wanted if 10 <= row[2] <= 1000]
assert len(found) == len(wanted), (len(found), len(wanted))
assert all(a[:2] == b[:2] and abs(a[2] - b[2]) < 1e-6*b[2] for a, b in zip(found, wanted)), (found, wanted)
END_OF_PYTHON
  done
  sed '/ 360 /d; / 270 /d' "$scratch/critical.dat" >"$scratch/part.dat"
  [ -z "$(awk -v want='critical 10 1000' -f plots/quoted.awk -f plots/tables.awk <"$scratch/part.dat")" ] || { echo "a part of a turn has a mean"; return 1; }
}

# Speeds of which one is the beginning of the other, failed rows, a single position, a name with an apostrophe.
odd_tables() {
  cat >"$scratch/dead.deck" <<'END_OF_DECK'
TITLE A parallelogram's "dead" points, $1
UNITS mm kg s
GROUND O2 0 0
GROUND O4 200 0
LINK a O2 A length=100 mass=1 inertia=1000
LINK b A B length=200 mass=1 inertia=1000
LINK c O4 B length=100 mass=1 inertia=1000
DRIVE a
POINT p' b along=100 offset=60
CRANK 0 to 360 step 30
SPEED 0 0.5
INERTIA distributed
REPORT kinematics
REPORT points
REPORT reactions
REPORT lagrange
END_OF_DECK
  sed 's/^CRANK.*/CRANK 90/; /REPORT points/d' "$scratch/dead.deck" >"$scratch/one.deck"
  run 1 --quiet --out "$scratch/out" "$scratch/dead.deck" "$scratch/one.deck" || return 1
  # At speed 0 there is no velocity and no force to draw.
  speeds="lagrange_speed_0 lagrange_speed_0.5 forces_speed_0.5 reactions_speed_0.5 shaking_force_speed_0.5"
  angles="kinematics_accelerations kinematics_angles kinematics_velocities"
  drawn dead figures coupler_curve linkage $angles point_rates_speed_0.5 $speeds || return 1
  # Of one position there is no curve.
  drawn one figures forces_speed_0.5
}

modes_swing() {
  beam_deck "CRANK 60" "MODES 1" "REPORT shapes" >"$scratch/mode.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/mode.deck" || return 1
  drawn mode animations mode_1_crank_60_speed_0 && gif mode/animations/mode_1_crank_60_speed_0.gif 40
}

# swung DECK CRANK PARTS: in the first mode at speed 0, as the figures of its shape draw it; facts to the file told.
swung() {
  (cd "$scratch/out/$1" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" modes "$scratch/$1.linkage" shapes.dat 0 1 "$2" 40 4 "$3") \
    >"$scratch/told" && grep -q "$4" "$scratch/told" || { cat "$scratch/told"; return 1; }
}

# joints DECK: of every pose, x, y and kind of its joints, in tenths.
joints() { awk 'NF { printf "%s%.1f,%.1f,%d", (n++ ? " " : ""), $1, $2, $3 } !NF && n { print ""; n = 0 } END { if (n) print "" }' "$scratch/$1.linkage/joints"; }

# Where a linkage that is no four-bar is clamped, and turns: the pivot is O4 and not where the last link ends. A corner where no other
# link is joined has no pin (P5), nor the end of an arm; what a drive holds is no pin, and a drive that is free clamps nothing.
modes_of_linkages() {
  sed '/^DRIVE/s/ *\(!.*\)*$/ free/; s/^CRANK.*/CRANK 0/' inputs/two_link_arm.deck >"$scratch/loose_arm.deck"
  run 0 --quiet --out "$scratch/out" inputs/watt_elbows.deck inputs/jansen_frames.deck inputs/bending_quick_return.deck \
    inputs/two_link_arm.deck "$scratch/loose_arm.deck" inputs/sprung_four_bar.deck || return 1
  swung watt_elbows 60 "1" '^joints = 6; arms = 0; clamps = 1; helds = 0' && grep -qx '0 0 60' "$scratch/told" &&
    grep -q "ground_names = ' \"O4\"'" "$scratch/told" || return 1
  swung jansen_frames 0 "1" '^joints = 6; arms = 0; clamps = 1; helds = 0' && grep -qx '38 7.8 0' "$scratch/told" &&
    grep -q "ground_names = ' \"B\"'" "$scratch/told" || return 1
  swung two_link_arm 0 "1" '^joints = 1; arms = 0; clamps = 1; helds = 1' && [ "$(joints two_link_arm | head -n 1)" = 0.5,0.0,2 ] || return 1
  swung loose_arm 0 "1" '^joints = 2; arms = 0; clamps = 0; helds = 0' && [ "$(joints loose_arm | head -n 1)" = "0.0,0.0,1 0.5,0.0,1" ] || return 1
  swung sprung_four_bar 60 "0 1" '^springs = 2; spring_kinds = "coil spring"' || return 1
  # To and fro: the ram stays on its guide, and its pin moves by what its row of the table says; the largest displacement is 40 mm.
  swung bending_quick_return 90 "1 -1" '^joints = 4; arms = 0; clamps = 1; helds = 0' || return 1
  awk '!/^#/ && $1 == 0 && $2 == 90 && $3 == 1 {
      moved = sqrt($9^2 + $10^2)
      if (moved > most) most = moved
      if ($5 == "rod") { x = $7; y = $8; u = $9; v = $10 }
    }
    END { for (k = 0; k < 3; k++) { part = k == 2 ? -1 : k; printf "%.1f,%.1f,1\n", x + part*u*40/most, y + part*v*40/most } }' \
    "$scratch/out/bending_quick_return/shapes.dat" >"$scratch/expected"
  joints bending_quick_return | awk '{ print $NF }' | diff - "$scratch/expected" && grep -q ',140.0,1$' "$scratch/expected" || return 1
  sed '/crank=0,90,270/s/crank=0,90,270/crank=90/; s/^CRANK.*/CRANK 90/; s/^INERTIA.*/&\nMODES 1/' inputs/bending_quick_return.deck \
    >"$scratch/ram.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/ram.deck" || return 1
  drawn ram animations mode_1_crank_90_speed_0 && gif ram/animations/mode_1_crank_90_speed_0.gif 40
}

# A curve drawn through rows of the table meets its corners, each of which is there twice, and does not swing out beside them.
square_corners() {
  awk -v want="shapes 0 0 0 3" -f plots/quoted.awk -f plots/tables.awk <"$scratch/out/jansen_frames/shapes.dat" >"$scratch/curves"
  awk '!/^#/ && $1 == 0 && $2 == 0 && $3 == 3 && $5 == "shank" { if (rows++ && $6 == s) printf "%.9g %.9g %.9g %.9g\n", $7, $8, $9, $10; s = $6 }' \
    "$scratch/out/jansen_frames/shapes.dat" >"$scratch/corners"
  [ "$(wc -l <"$scratch/corners")" -eq 2 ] || { cat "$scratch/corners"; return 1; }
  while read -r x y u v; do
    awk -v x="$x" -v y="$y" -v u="$u" -v v="$v" '
      NF && ($1 - x)^2 + ($2 - y)^2 < 1e-12 && ($3 - u)^2 + ($4 - v)^2 < 1e-12 { if (NR == last + 1) twice = 1; last = NR }
      END { exit !twice }' "$scratch/curves" || { echo "the curve does not meet $x $y twice"; return 1; }
  done <"$scratch/corners"
  # At rest a link is straight between its corners, and a corner stops the curve.
  awk '
    !NF { n = 0; next }
    {
      n++; x[n] = $1; y[n] = $2
      if (n < 3) next
      a = x[n - 1] - x[n - 2]; b = y[n - 1] - y[n - 2]; c = x[n] - x[n - 1]; d = y[n] - y[n - 1]
      if ((a*d - b*c)^2 > 1e-8*(a*a + b*b)*(c*c + d*d)) { print "it bends at", x[n - 1], y[n - 1]; exit 1 }
    }' "$scratch/curves"
}

nothing_to_animate() {
  beam_deck "CRANK 60" "REPORT frequencies" >"$scratch/still.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/still.deck" || return 1
  sh plots/draw_figures.sh --animate "$scratch/out/still" >"$scratch/stdout" 2>"$scratch/stderr" && echo "status 0" && return 1
  says "has nothing to animate" && absent "$scratch/out/still/animations"
}

# What the program says of the linkage of inputs/kinematics.deck, which has no pivot at the origin, and where it is: the lengths of
# its links, whatever the order of angles and however near to each other; another branch mirrors it in the line of its pivots.
placed() {
  run 0 --quiet --out "$scratch/out" inputs/kinematics.deck || return 1
  printf '%s\n' 0 350 10 10.00000000000001 '10 open' '10 crossed' >"$scratch/angles"
  (cd "$scratch/out/kinematics" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" four_bar "$scratch/angles.d" placed "$scratch/angles") \
    >"$scratch/stdout" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  silent || return 1
  python3 - "$scratch/stdout" <<'END_OF_PYTHON'
import math
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    lines = file.read().splitlines()
assert lines[0] == "turns_fully = 1", lines[0]
assert lines[1] == "O2 = {0.1, 0.05}; O4 = {0.5, 0.2}", lines[1]
assert lines[2] == 'link_ends = "O2:crank A:crank A:coupler B:coupler O4:rocker B:rocker"', lines[2]
assert lines[4] == "springs = 0; spring_kinds = \"\"; spring_names = ''", lines[4]
begin = lines.index("$placed << EOD")
assert lines[-1] == "EOD", lines[-1]
rows = [[float(word) for word in line.split()] for line in lines[begin + 1:-1]]
assert [row[0] for row in rows] == [0, 350, 10, 10, 10, 10], rows
ground, other = (0.1, 0.05), (0.5, 0.2)
for _, ax, ay, bx, by, *middle in rows:
    lengths = math.dist(ground, (ax, ay)), math.dist((ax, ay), (bx, by)), math.dist(other, (bx, by))
    assert all(abs(a - b) < 1e-6 for a, b in zip(lengths, (0.15, 0.4, 0.35))), lengths
    assert all(abs(a - b) < 1e-6 for a, b in zip(middle, ((ax + bx)/2, (ay + by)/2))), middle

def side(row):
    ax, ay, bx, by = row[1:5]
    return (other[0] - ax)*(by - ay) - (other[1] - ay)*(bx - ax)

assert rows[2][1:] == rows[3][1:], "angles nearer than the program tells apart are one"
assert side(rows[2]) < 0 < side(rows[4]) and rows[2][1:] == rows[5][1:], "the deck says crossed"
END_OF_PYTHON
}

# At a dead point, where a linkage has no velocities, it has its place: there it is drawn.
dead_point() {
  { sed '/^REPORT/d' "$scratch/dead.deck" && echo "REPORT geometry crank=0,90"; } >"$scratch/drawn.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/drawn.deck" || return 1
  awk -v want=poses -f plots/quoted.awk -f plots/tables.awk <"$scratch/out/drawn/geometry.dat" >"$scratch/poses"
  [ "$(cut -d' ' -f1 "$scratch/poses" | paste -s -d' ' -)" = '0 90' ] || { cat "$scratch/poses"; return 1; }
}

# Without the program what needs no linkage is drawn, and why the rest is missing is said.
without_program() {
  rm -rf "$scratch/share"
  cp -R plots "$scratch/share" || return 1
  run 0 --quiet --out "$scratch/out" inputs/rigid.deck || return 1
  FLEXMECH= timeout "$longest" sh "$scratch/share/draw_figures.sh" "$scratch/out/rigid" >"$scratch/stdout" 2>"$scratch/stderr" ||
    { cat "$scratch/stderr"; return 1; }
  says "drawing a linkage needs echo.deck and the program flexmech" && grep -q /motion.png "$scratch/stdout" || return 1
  ! grep -q -e special_positions -e coupler_curve "$scratch/stdout" || { echo "it has drawn a linkage"; return 1; }
  for other in /nowhere /tmp /bin/true; do
    FLEXMECH=$other sh plots/draw_figures.sh "$scratch/out/rigid" >"$scratch/stdout" 2>"$scratch/stderr"
    [ $? -eq 2 ] && says "FLEXMECH=$other is not the program" || return 1
  done
}

# Links that are called 1, 1e0 and 1.0, or like the ground in no table.
odd_names() {
  { motion_deck && echo "POINT p coupler along=100 offset=50" && echo "REPORT points"; } >"$scratch/plain.deck"
  sed 's/\bcrank\b/1/; s/\bcoupler\b/1e0/; s/\bfollower\b/1.0/' "$scratch/plain.deck" >"$scratch/numbers.deck"
  sed 's/\bcrank\b/-/' "$scratch/plain.deck" >"$scratch/dash.deck"
  for deck in plain numbers dash; do
    run 0 --quiet --out "$scratch/out" "$scratch/$deck.deck" || return 1
    printf '%s\n' 10 200 >"$scratch/angles.$deck"
      (cd "$scratch/out/$deck" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" four_bar "$scratch/angles.$deck.d" placed "$scratch/angles.$deck" points.dat) \
      >"$scratch/told" || return 1
    sed -n 's/^link_ends = //p' "$scratch/told" >>"$scratch/link_ends"
    grep -v ^link_ends "$scratch/told" >"$scratch/placed.$deck"
    cmp "$scratch/placed.plain" "$scratch/placed.$deck" || return 1
  done
  diff - "$scratch/link_ends" <<'END_OF_ENDS'
"O2:crank A:crank A:coupler B:coupler O4:follower B:follower"
"O2:1 A:1 A:1e0 B:1e0 O4:1.0 B:1.0"
"O2:- A:- A:coupler B:coupler O4:follower B:follower"
END_OF_ENDS
}

# Where A stands on O4 the linkage has no place of its own; it is drawn as it tends to be there.
meeting_pins() {
  cat >"$scratch/meeting.deck" <<'END_OF_DECK'
UNITS mm tonne s
GROUND O2 0 0
GROUND O4 254 0
LINK crank O2 A length=254
LINK coupler A B length=279.4
LINK follower O4 B length=279.4
DRIVE crank
CRANK 10 to 350 step 20
REPORT linkage
REPORT kinematics
END_OF_DECK
  run 0 --quiet --out "$scratch/out" "$scratch/meeting.deck" || return 1
  drawn meeting figures kinematics_angles special_positions || return 1
  { sed '/^REPORT/d; s/^DRIVE crank/& change_points=branch/' "$scratch/meeting.deck" && echo "REPORT geometry crank=0,10"; } >"$scratch/drawn.deck"
  run 1 --quiet --out "$scratch/out" "$scratch/drawn.deck" && says "crank 0 deg" && grep -q '^# *failed crank=0 ' "$scratch/out/drawn/geometry.dat"
}

# A four-bar on a spring to a GROUND pin of its own, with a torsional damper: where it rests, and what is drawn of them.
spring_of_a_four_bar() {
  run 0 --quiet --out "$scratch/out" inputs/desk_lamp.deck || return 1
  drawn desk_lamp figures coupler_curve equilibrium forces kinematics_angles lagrange linkage motion pin_motion reactions || return 1
  drawn desk_lamp animations forces linkage motion && gif desk_lamp/animations/linkage.gif 60 || return 1
  printf '%s\n' 0 60 >"$scratch/angles.lamp"
  (cd "$scratch/out/desk_lamp" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" four_bar "$scratch/angles.lamp.d" placed "$scratch/angles.lamp" points.dat) \
    >"$scratch/told" || return 1
  python3 - "$scratch/told" <<'END_OF_PYTHON'
import math
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    lines = file.read().splitlines()
text = "\n".join(lines)
assert 'springs = 2; spring_kinds = "spring drag"; spring_names = \' "s" "d"\'' in text, text
assert "hook_x[1] = 0; hook_y[1] = 70; hook_turn[1] = 180" in text and "hooks = 1;" in text, text
rows = [[float(word) for word in line.split()] for line in lines[lines.index("$placed << EOD") + 1:-1]]
lengths = []
for angle, row in zip((0, 60), rows):
    turn = math.radians(angle)
    # Behind the angle, two pins and two points: both ends of s, then the pin of d, downwards and along the arm.
    wanted = [0, 70, 90*math.cos(turn), 90*math.sin(turn), 0, 0, -math.pi/2, turn]
    assert len(row) == 9 + len(wanted) and all(abs(a - b) < 1e-4 for a, b in zip(row[9:], wanted)), (row[9:], wanted)
    lengths.append(math.dist(wanted[:2], wanted[2:4]))
low, high = (float(text.split(f"spring_{word}[1] = ")[1].split(";")[0].split()[0]) for word in ("low", "high"))
assert abs(low - min(lengths)) < 1e-4 and abs(high - max(lengths)) < 1e-4, (low, high, lengths)
END_OF_PYTHON
}

# Springs and dampers of both kinds on a slider-crank: a torsional one is wound on from turn to turn.
springs_of_other_linkages() {
  cat >"$scratch/sprung.deck" <<'END_OF_DECK'
TITLE Springs on a slider-crank
UNITS mm kg s force=N torque=N*m
GROUND O 0 0
GROUND H 150 90
GROUND W 260 0
GUIDE bore 0 0 angle=0
LINK crank O A length=45 mass=1
LINK rod A B length=145 mass=1
POINT p rod along=70 offset=25
SLIDER B bore mass=1
SPRING s W B stiffness=1N/mm free_length=90
DAMPER d H p damping=2N*s/m
SPRING t O crank stiffness=1N*m/rad free_angle=30
DAMPER e A crank rod damping=0.1N*m*s
DRIVE crank
BRANCH B forward
CRANK 0 to 360 step 30
REPORT pins
REPORT equilibrium
REPORT motion crank=60 end=1 step=0.02
END_OF_DECK
  run 0 --quiet --out "$scratch/out" "$scratch/sprung.deck" || return 1
  drawn sprung figures equilibrium linkage linkage_positions motion pin_motion && drawn sprung animations linkage motion || return 1
  (cd "$scratch/out/sprung" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" range "$scratch/sprung.shapes" 0 720 8 0.014) \
    >"$scratch/told" || return 1
  grep -q "springs = 4; spring_kinds = \"spring damper coil drag\"; spring_names = ' \"s\" \"d\" \"t\" \"e\"'" "$scratch/told" || return 1
  python3 - "$scratch/told" <<'END_OF_PYTHON'
import math
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    lines = file.read().splitlines()
rows = [[float(word) for word in line.split()] for line in lines[lines.index("$springs << EOD") + 1:-1]]
assert len(rows) == 9, rows
for k, row in enumerate(rows):
    turn = math.pi/2*k
    slide = 45*math.cos(turn) + math.sqrt(145**2 - (45*math.sin(turn))**2)
    wanted = [260, 0, slide, 0]
    assert all(abs(a - b) < 1e-3 for a, b in zip(row, wanted)), (row, wanted)
    assert [row[4], row[5], row[8], row[9]] == [150, 90, 0, 0], row
    assert abs(row[10] + math.pi/2) < 1e-6 and abs(row[11] - turn) < 1e-5, (row, turn)
    assert abs(math.cos(row[14] - turn) + 1) < 1e-5, "from A the crank goes back to O"
END_OF_PYTHON
}

# A copy of the scripts, called through a link.
installed_plots() {
  rm -rf "$scratch/share" "$scratch/draw"
  cp -R plots "$scratch/share" && ln -s share/draw_figures.sh "$scratch/draw" || return 1
  FLEXMECH=$program timeout "$longest" sh "$scratch/draw" "$scratch/out/kinematics" >"$scratch/stdout" 2>"$scratch/stderr" ||
    { cat "$scratch/stderr"; return 1; }
  silent && [ "$(wc -l <"$scratch/stdout")" -eq 3 ]
}

# Coordinates over positions, of lengths and angles, at several speeds, and in a motion; of a table with chosen columns what it has.
coordinate_figures() {
  run 0 --quiet --out "$scratch/out" inputs/suspension.deck || return 1
  drawn suspension figures coordinates equilibrium linkage linkage_positions motion motion_coordinates point_rates ratios || return 1
  cat >"$scratch/vane.deck" <<'END_OF_DECK'
UNITS mm kg s
GROUND O 0 0
GROUND H 60 90
GUIDE bore 0 -20 angle=10
LINK crank O A length=45
LINK rod A B length=145
SLIDER B bore
DRIVE crank
BRANCH B forward
SPRING main H A stiffness=3N/mm free_length=75
DAMPER vane O crank damping=0.3N*m*s
MEASURE bend angle rod against crank
CRANK 0 to 360 step 15
SPEED 10 20
REPORT coordinates ratio_to=vane
END_OF_DECK
  sed 's/ratio_to=vane/columns=rate/' "$scratch/vane.deck" >"$scratch/rates.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/vane.deck" "$scratch/rates.deck" || return 1
  both="coordinates_speed_10 coordinates_speed_20 linkage linkage_positions"
  drawn vane figures $both ratios && drawn rates figures $both || return 1
  # Of variants the summary, of one of them all else.
  run 0 --quiet --out "$scratch/out" inputs/ackermann.deck || return 1
  drawn ackermann figures summary_by_meet || return 1
  run 0 --quiet --set meet=0.7 --out "$scratch/one" inputs/ackermann.deck || return 1
  drawn ../one/ackermann figures coordinates limits linkage linkage_positions
}

# Linkages that are no four-bars: a slider on a link and one on a guide; a driven slider, which goes to and fro; a row that fails.
other_linkages() {
  run 0 --quiet --out "$scratch/out" inputs/quick_return.deck inputs/toggle_press.deck inputs/klann.deck || return 1
  all="drive_forces joint_forces link_motion linkage linkage_positions pin_motion"
  drawn quick_return figures ${all%%link_motion*} limits ${all#*joint_forces } shaking_force && gif quick_return/figures/linkage.gif 72 || return 1
  drawn toggle_press figures $all && gif toggle_press/figures/linkage.gif 60 || return 1
  run 0 --quiet --out "$scratch/out" inputs/norton.deck || return 1
  drawn norton figures bearings drive_forces frame_force link_motion linkage linkage_positions shaking_force || return 1
  drawn klann figures link_motion linkage linkage_positions pin_motion && drawn klann animations linkage || return 1
  sed 's/^LINK     rod .*/LINK rod A B length=30 mass=1 inertia=1/; /^POINT/d; /^REPORT   points/d; /^REPORT   balance/d' inputs/engine.deck >"$scratch/short.deck"
  run 1 --quiet --out "$scratch/out" "$scratch/short.deck" && drawn short figures $all lagrange shaking_force
}

# A motion alone, of one coordinate and of angles and lengths; ranges alone; pins of a four-bar beside its other tables.
moving_linkages() {
  { sed '/^FORCE/d; /^REPORT/d; /^END/d; /^CRANK/d' inputs/quick_return.deck && echo 'POINT p lever along=100 offset=40' &&
    echo 'MOTOR torque=20N*m' && echo 'REPORT motion crank=30 end=0.3 step=0.01'; } >"$scratch/driven.deck"
  cat >"$scratch/falling.deck" <<'END_OF_DECK'
TITLE A load that slides down a swinging arm
UNITS m kg s
GROUND O 0 0
LINK arm O A length=2 mass=3 inertia=1
LINK load B C length=0.3 mass=2 inertia=0.05
SLIDER B arm
DRIVE arm
DRIVE B arm free ratio=0 phase=0.5
DRIVE load against arm free ratio=0 phase=90
GRAVITY 0 -9.81
REPORT motion crank=-30 end=0.5 step=0.02 pins=yes
END_OF_DECK
  { sed '/^REPORT/d; /^END/d' inputs/toggle_press.deck && echo 'REPORT linkage'; } >"$scratch/ranges.deck"
  { sed '/^END/d' inputs/kinematics.deck && echo 'REPORT pins'; } >"$scratch/pins.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/driven.deck" "$scratch/falling.deck" "$scratch/ranges.deck" "$scratch/pins.deck" || return 1
  drawn driven figures motion && drawn driven animations motion && gif driven/animations/motion.gif 31 || return 1
  drawn falling figures motion && drawn falling animations motion && gif falling/animations/motion.gif 26 || return 1
  drawn ranges figures limits || return 1
  sed 's/^REPORT *motion.*/REPORT motion crank=20 end=0.1 step=0.01 columns=motor\nREPORT drives\nCRANK 0 to 360 step 30/' inputs/geared_motor.deck \
    >"$scratch/geared.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/geared.deck" || return 1
  drawn geared figures drive_forces drive_locus linkage linkage_positions motion shaking_force || return 1
  drawn pins figures kinematics_accelerations kinematics_angles kinematics_velocities pin_motion
}

# What moves in an animation of a motion is where the program places it at the same position of the crank, at every instant asked for.
moving_places() {
  { cat "$scratch/driven.deck" && echo "REPORT geometry crank=30"; } >"$scratch/paced.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/paced.deck" || return 1
  cranks=$(awk '!/^#/ && rows++ % 10 == 0 { printf "%s%.17g", (n++ ? "," : ""), $2 }' "$scratch/out/paced/motion.dat")
  { sed '/^REPORT/d' "$scratch/driven.deck" && echo "REPORT geometry crank=$cranks"; } >"$scratch/there.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/there.deck" || return 1
  awk '!/^#/ && NF { if ($1 "" != time) { time = $1 ""; n++ } if (n % 10 == 1) print }' "$scratch/out/paced/motion_places.dat" >"$scratch/moved"
  grep -v -e '^#' -e '^ *$' "$scratch/out/there/geometry.dat" | paste -d' ' "$scratch/moved" - | awk '
    $2 != $8 || $3 != $9 || $4 != $10 || ($5 - $11)^2 > 1e-12 || ($6 - $12)^2 > 1e-12 { print; exit 1 }
    END { if (NR != 4*13) { print NR, "places"; exit 1 } }' || return 1
  (cd "$scratch/out/driven" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" motion "$scratch/driven.shapes" 10 3 0.018) \
    >"$scratch/told" && grep -q '^poses = 3;' "$scratch/told" && grep -q '^pose_crank\[3\] = 0.2;' "$scratch/told" || return 1
  # Where the table is there, nothing is computed again.
  (cd "$scratch/out/paced" && FLEXMECH=false PLOTS=$root/plots sh "$root/plots/places.sh" motion "$scratch/paced.shapes" 10 3 0.018) |
    cmp - "$scratch/told" && cmp "$scratch/paced.shapes/pose_3" "$scratch/driven.shapes/pose_3"
}

# Shapes of a position: two colours a link and a slider, two for pins; a plate has its corners' hull.
drawn_shapes() {
  (cd "$scratch/out/klann" && FLEXMECH=$program PLOTS=$root/plots sh "$root/plots/places.sh" range "$scratch/klann.shapes" 0 360 4 0.014) \
    >"$scratch/told" || return 1
  grep -q 'layers = 12; body_layers = 10; paths = 5; grounds = 3; drawn_links = 5' "$scratch/told" &&
    grep -q "path_names = ' \"P29\" \"P27\" \"P35\" \"P37\" \"P33\"'" "$scratch/told" &&
    [ "$(grep -c "^path_ink.*'#" "$scratch/told")" -eq 1 ] && [ "$(wc -l <"$scratch/klann.shapes/paths")" -eq 5 ] ||
    { cat "$scratch/told"; return 1; }
}

# Titles with all that means something to gnuplot, awk or the shell are written as they are, in headings and as names of springs.
quoted_titles() {
  cat >"$scratch/titles" <<'END_OF_TITLES'
'Slider' of 1920
it''s "two"
''
a\slash \n \\
`date` @x %s %d
{a_b}^c @d ~e{f}
it's `date` @x "q" \n
ends with '
END_OF_TITLES
  number=0
  while IFS= read -r title; do
    number=$((number + 1))
    { printf 'TITLE    %s\n' "$title" && sed '/^TITLE/d; /^REPORT/d; /^END/d' inputs/kinematics.deck && echo "REPORT kinematics"; } \
      >"$scratch/title$number.deck"
    run 0 --quiet --out "$scratch/out" "$scratch/title$number.deck" || return 1
    timeout "$longest" sh plots/draw_figures.sh --format svg "$scratch/out/title$number" >"$scratch/stdout" 2>"$scratch/stderr" ||
      { echo "$title:"; head -c 300 "$scratch/stderr"; return 1; }
    sed 's/<[^>]*>//g' "$scratch/out/title$number/figures/kinematics_angles.svg" | sed 's/^[ 	]*//' | grep -qxF -e "$title" ||
      { echo "no heading '$title'"; return 1; }
  done <"$scratch/titles"
}

# One that gnuplot cannot draw leaves the others, and is named.
one_fails() {
  rm -rf "$scratch/share"
  { sed '/^END/d' inputs/kinematics.deck && echo "REPORT pins"; } >"$scratch/partly.deck"
  cp -R plots "$scratch/share" && run 0 --quiet --out "$scratch/out" "$scratch/partly.deck" || return 1
  for kind in kinematics pin_motion; do
    sed "/^if (kind eq \"$kind\")/a plot no_such_thing" plots/figure.gp >"$scratch/share/figure.gp"
    FLEXMECH=$program timeout "$longest" sh "$scratch/share/draw_figures.sh" "$scratch/out/partly" >"$scratch/stdout" 2>"$scratch/stderr"
    [ $? -eq 1 ] || { echo "status is not 1"; return 1; }
    says "not drawn" && says "/figures/$kind" && ! grep -q "/$kind" "$scratch/stdout" || return 1
    case $kind in
      kinematics) grep -q /pin_motion.png "$scratch/stdout" ;;
      *) [ "$(grep -c /kinematics_ "$scratch/stdout")" -eq 3 ] ;;
    esac || { echo "the others are not drawn:"; cat "$scratch/stdout"; return 1; }
  done
}

# Several speeds and no interval: exponents alone, none of which grows.
growth_without_intervals() {
  sed 's/^SPEED.*/SPEED 10 11/; s/^MODES.*/MODES 1/; /^REPORT   intervals/d' inputs/stability.deck >"$scratch/calm.deck"
  run 0 --quiet --out "$scratch/out" "$scratch/calm.deck" && drawn calm figures growth multipliers
}

# A structure has modes, and neither a crank nor figures over its positions.
structure_figures() {
  "$program" --quiet --out "$scratch/out" inputs/portal.deck || return 1
  drawn portal figures modes mode_1_crank_0_speed_0 mode_2_crank_0_speed_0 mode_3_crank_0_speed_0 mode_4_crank_0_speed_0 || return 1
  sh plots/flexmech-plot --format svg "$scratch/out/portal" >"$scratch/stdout" || return 1
  grep -q 'at rest' "$scratch/out/portal/figures/modes.svg" || { echo "modes.svg does not say: at rest"; return 1; }
  ! grep -l '>[^<]*crank' "$scratch/out/portal/figures/"*.svg || { echo "a structure has no crank"; return 1; }
}

root=$(pwd)

check "figures of inputs/rigid.deck" rigid_figures
check "animations of inputs/rigid.deck" rigid_animations
check "figures of the elastic response" response_figures
check "the Campbell diagram" campbell_figure
check "the elastic response is animated" response_animation
check "links bend as in the table" bent_links
check "critical speeds of modes" critical_speeds
check "figures of failed rows, of one position, of names with apostrophes" odd_tables
check "titles are written as they are" quoted_titles
check "a figure that fails leaves the others" one_fails
check "growth at speeds without an interval" growth_without_intervals
check "a mode is animated" modes_swing
check "modes of other linkages are drawn where they are held" modes_of_linkages
check "corners of mode shapes" square_corners
check "nothing to animate" nothing_to_animate
check "a linkage is placed by the program" placed
check "a linkage at its dead point" dead_point
check "no drawing of a linkage without the program" without_program
check "links with odd names are placed" odd_names
check "pins that meet" meeting_pins
check "figures of other linkages than four-bars" other_linkages
check "figures of coordinates" coordinate_figures
check "figures and animations of motions, ranges and pins" moving_linkages
check "what is fixed to a link moves with it" moving_places
check "shapes of other linkages" drawn_shapes
check "figures of structures" structure_figures
check "springs of a four-bar are drawn" spring_of_a_four_bar
check "springs of other linkages are drawn" springs_of_other_linkages
check "installed scripts" installed_plots
