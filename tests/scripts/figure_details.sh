#!/bin/sh
# What a person sees in figures: names as they are written, titles that promise no more than there is, numbers and labels that say something,
# curves between samples; and what flexmech-plot can be asked for: some figures, a style, measured points, a page of several speeds.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "details of figures" "they are drawn from tables, which are the same in all builds"; exit ;;
esac

# plot STATUS ARGUMENT...: what it says is kept as that of a run.
plot() {
  wanted=$1
  shift
  FLEXMECH=$program timeout "$longest" sh plots/flexmech-plot "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  found=$?
  [ $found -eq "$wanted" ] && return
  echo "flexmech-plot $*: status $found, not $wanted; it said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# shows FIGURE TEXT...: an SVG of the folder that was drawn last has these texts; with a ! before, it has not.
shows() {
  words=$(sed 's/<title>[^<]*<.title>//g; s/<[^>]*>/\n/g' "$folder/figures/$1.svg") || return 1
  figure=$1
  shift
  for text in "$@"; do
    case $text in
      !*) ! printf '%s\n' "$words" | grep -qF -e "${text#!}" || { echo "$figure has '${text#!}'"; return 1; } ;;
      *) printf '%s\n' "$words" | grep -qF -e "$text" || { echo "$figure has no '$text'"; return 1; } ;;
    esac
  done
}

# svg DECK ARGUMENT...: it is run, and drawn as SVG without a word; no text is cut, none lies on another.
svg() {
  folder=$scratch/out/$1
  [ -d "$folder" ] || { timeout "$longest" "$program" --quiet --out "$scratch/out" "$scratch/$1.deck" >"$scratch/stdout" 2>&1; [ $? -le 1 ]; } ||
    { head -n 3 "$scratch/stdout"; return 1; }
  shift
  rm -rf "$folder/figures"
  plot 0 --format svg "$@" "$folder" && silent && python3 -B tests/support/figure_extents.py check "$folder"/figures/*.svg
}

# slider_crank CARD...: with names that mean something to gnuplot.
slider_crank() {
  printf '%s\n' 'TITLE Names' 'UNITS mm kg s force=N torque=N*m' 'GROUND O_left 0 0' 'GUIDE bore 0 0 angle=0' 'LINK crank O_left pin_of_crank length=50 mass=1' \
    'LINK rod pin_of_crank pin_of_piston length=150 mass=1' 'SLIDER pin_of_piston bore mass=1' 'BRANCH pin_of_piston forward' 'DRIVE crank' "$@"
}

names_are_written() {
  slider_crank 'CRANK 0 to 360 step 30' 'REPORT pins' 'REPORT bearings' 'SPEED 100 rpm' >"$scratch/names.deck"
  svg names && shows linkage_positions pin_of_crank O_left "in full: crank at" && shows bearings "pin_of_crank on rod" || return 1
  sed 's/pin_of_crank/the_bearing_between_crank_and_connecting_rod/; s/\brod\b/a_connecting_rod_with_a_long_name/' "$scratch/names.deck" |
    sed 's/pin_of_crank/the_bearing_between_crank_and_connecting_rod/' >"$scratch/long.deck"
  svg long && svg long --size 85x60mm
}

# A clamp that has two ranges; a constant, and rounding, are no ranges.
ranges() {
  cat >"$scratch/clamp.deck" <<'END_OF_DECK'
TITLE An over-centre toggle clamp
UNITS mm kg s
GROUND O 0 0
GROUND P 40 0
GROUND W 110 20
PIN A 5 35
PIN B 45 30
LINK strap O A mass=0
LINK handle A B mass=0
LINK arm P B mass=0
POINT grip handle along=-100 offset=20
POINT tip arm along=20 offset=-60
SPRING rubber tip W stiffness=200N/mm
DRIVE strap
FORCE grip -100N -50N
CRANK 15 to 90 step 5
REPORT linkage
REPORT drives
REPORT equilibrium
END_OF_DECK
  svg clamp || return 1
  grep -q ' range_from ' "$folder/linkage.dat" && [ "$(grep -c ' range_from ' "$folder/linkage.dat")" -eq 2 ] || { echo "it has not two ranges"; return 1; }
  shows limits "strap (1)" "strap (2)" "stopped by B and B" "at: angle of strap at the least and at the greatest value" "!e-" || return 1
  # Without masses there are no frequencies, at rest no shaking force, and one curve has no legend.
  shows equilibrium "stable: " "!with the frequency" && shows drive_forces "Driving torque, strap at" "!shaking force" || return 1
  # What a drive of its own reaches is a length of its own, and a link that only rounding turns does not swing.
  cat >"$scratch/ram.deck" <<'END_OF_DECK'
TITLE A boom on a ram beside a crank
UNITS mm kg s
GROUND O 0 0
GROUND Q 300 0
GROUND R 200 0
LINK crank O A length=60
LINK rod A B length=240
LINK rocker Q B length=180
BRANCH B left A Q
LINK boom O D length=400
PIN D 0 400
LINK ram R D
DRIVE crank
DRIVE ram length at=450
CRANK 0 to 360 step 15
REPORT linkage
END_OF_DECK
  svg ram && shows limits "span 400 mm" "!pressure" "200" "600"
}

# At one speed the torque is over the cycle, and a start that needs much does not flatten the rest.
torques() {
  slider_crank 'CRANK 0 to 360 step 10' 'SPEED 100 rpm' 'REPORT drives' 'REPORT sizing' 'REPORT balance' 'BALANCE shaft order=1' \
    'REPORT reactions' 'POINT load rod along=70 offset=10' 'FORCE load 20N 0N' >"$scratch/one.deck"
  svg one && shows drive_locus "crank angle [deg]" peak rms "Torque of the drives over the cycle" "!speed of the drive" || return 1
  shows joint_forces pin_of_crank "!load" && shows harmonics "force x [N]" "!>shaking force [N]<"
  ! sed 's/<[^>]*>/\n/g' "$folder/figures/harmonics.svg" | grep -x 'shaking force \[N\]' || { echo "harmonics of a magnitude"; return 1; }
  run 0 --quiet --out "$scratch/out" inputs/antiparallelogram.deck && svg antiparallelogram && shows motion "at the start: " "beyond the axis"
}

# Of all pages without a size letters are alike: they are as wide as each other.
widths() {
  run 0 --quiet --out "$scratch/out" inputs/rigid.deck && svg rigid || return 1
  [ "$(sed -n 's/.*viewBox="0 0 \([0-9]*\) .*/\1/p'  "$folder"/figures/*.svg | sort -u)" = 1600 ] ||
    { sed -n 's/.*viewBox="0 0 \([0-9]*\) .*/\1/p' "$folder"/figures/*.svg | sort | uniq -c; return 1; }
  grep -q '<title>Motion of the linkage' "$folder/figures/motion.svg" && ! grep -q 'title>[Gg]nuplot' "$folder/figures/motion.svg"
}

# Between samples a curve is smooth, and a jump stays one: of a sine at every 20 degrees, and of a step.
smooth_curves() {
  awk 'BEGIN { for (k = 0; k <= 18; k++) printf "0 %d %.12g %d\n", 20*k, sin(20*k*3.14159265358979/180), (k > 9) }' >"$scratch/samples"
  cut -d' ' -f1-3 "$scratch/samples" | awk -f plots/smooth.awk |
    awk 'NF { n++; e = $2 - sin($1*3.14159265358979/180); if (e*e > 1e-6) { print "at", $1, "by", e; bad = 1 } } END { if (n != 145) { print n, "points"; bad = 1 }; exit bad }' || return 1
  cut -d' ' -f1,2,4 "$scratch/samples" | awk -f plots/smooth.awk |
    awk 'NF && ($2 < 0 || $2 > 1 || $1 > 180 && $1 < 200) { print "at", $1, ":", $2; exit 1 }' || return 1
  # Neither across a failed row, nor where samples are few or uneven.
  { sed 5q "$scratch/samples"; echo nan; sed 1,6d "$scratch/samples"; } | cut -d' ' -f1-3 | awk -f plots/smooth.awk | awk '$1 > 80 && $1 < 120 { exit 1 }' || return 1
  printf '0 %d %d\n' 0 0 1 1 3 9 7 0 9 1 20 0 30 1 | awk -f plots/smooth.awk | awk 'NF { n++ } END { exit n != 7 }'
}

only_some() {
  run 0 --quiet --out "$scratch/out" inputs/rigid.deck && folder=$scratch/out/rigid && rm -rf "$folder/figures" || return 1
  plot 0 --format svg --only motion,harmonics --only coupler_curve "$folder" && silent &&
    [ "$(ls "$folder/figures" | tr '\n' ' ')" = "coupler_curve.svg drawn.txt harmonics_speed_10.svg harmonics_speed_5.svg motion.svg " ] ||
    { ls "$folder/figures"; return 1; }
  # What was drawn before stays, in other formats too; several formats are side by side.
  plot 0 --format pdf,png --only motion "$folder" && [ "$(ls "$folder/figures" | grep -c motion)" -eq 3 ] && [ "$(ls "$folder/figures" | wc -l)" -eq 7 ] ||
    { ls "$folder/figures"; return 1; }
  plot 1 --only campbell "$folder" && says "has no table that a figure can be drawn from of campbell"
}

own_style() {
  folder=$scratch/out/rigid
  printf '%s\n' "font_name = 'Serif'" "set linetype 1 lc rgb '#123456'" >"$scratch/style.gp"
  printf '%s\n' "set lintype 1" >"$scratch/wrong.gp"
  plot 0 --format svg --only motion --style "$scratch/style.gp" "$folder" && silent && grep -q 'font-family="Serif"' "$folder/figures/motion.svg" &&
    grep -q '18, *52, *86' "$folder/figures/motion.svg" || return 1
  rm -rf "$folder/figures"
  plot 2 --style "$scratch/wrong.gp" "$folder" && says "--style $scratch/wrong.gp: gnuplot says: " && absent "$folder/figures"
}

measured_points() {
  folder=$scratch/out/rigid
  printf '%s\n' '# of a test' 'crank [deg];torque [N.m];other' '0;1.5;1' '90;8;1' '180;-55;2' >"$scratch/bench.csv"
  plot 0 --format svg --only lagrange,reactions,motion --overlay "$scratch/bench.csv:crank:2" "$folder" && silent || return 1
  shows lagrange_speed_5 bench "−40" && shows reactions_speed_10 bench && shows motion !bench || return 1
  rm -rf "$folder/figures"
  plot 2 --overlay "$scratch/bench.csv:1:4" "$folder" && says "no column 4; expected a number from 1 to 3 or one of: crank [deg], torque [N.m], other" || return 1
  plot 2 --format svg,png --overlay "$scratch/bench.csv:1:other" "$folder" && says "no figure of $folder has these axes" || return 1
  printf '%s\n' 'crank [rad],torque [N.m]' '0,1' >"$scratch/radians.csv"
  plot 2 --overlay "$scratch/radians.csv:1:2" "$folder" && says "has these axes" && absent "$folder/figures"
}

# More than four speeds are cells of one page.
many_speeds() {
  slider_crank 'CRANK 0 to 360 step 30' 'SPEED 0 to 500 step 100 rpm' 'REPORT drives' 'REPORT bearings' >"$scratch/speeds.deck"
  svg speeds && [ "$(ls "$folder/figures" | tr '\n' ' ')" = "bearings.svg drawn.txt drive_forces.svg linkage_positions.svg shaking_force.svg " ] ||
    { ls "$folder/figures"; return 1; }
  shows drive_forces "crank at 100 rpm" "crank at 500 rpm" && shows bearings "crank at 300 rpm" || return 1
  svg speeds --size 160x100mm && grep -q 'width="160mm" height="100mm"' "$folder/figures/bearings.svg" || return 1
  plot 0 --each --only drive_forces "$folder" && [ "$(grep -c drive_forces_speed_ "$scratch/stdout")" -ge 5 ]
}

check "figures: names are as they are written" names_are_written
check "figures: ranges" ranges
check "figures: torques of drives and motors" torques
check "figures: pages of one width, with a title" widths
check "figures: curves between samples" smooth_curves
check "flexmech-plot: some figures, several formats" only_some
check "flexmech-plot: a style of one's own" own_style
check "flexmech-plot: measured points" measured_points
check "flexmech-plot: a page of several speeds" many_speeds
