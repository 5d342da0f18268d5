#!/bin/sh
# flexmech-plot and make install: options and what is wrong with them, formats and sizes, bare figures, figures on request; panels
# and figures of nothing but zeros; other terminals; figures of the stress test and of make bench.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "flexmech-plot" "it draws from tables, which are the same in all builds"; exit ;;
esac

# plot STATUS ARGUMENT...: what it says is kept as that of a run.
plot() {
  wanted=$1
  shift
  timeout "$longest" plots/flexmech-plot "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  found=$?
  [ $found -eq "$wanted" ] && return
  echo "flexmech-plot $*: status $found, not $wanted; it said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# shows TEXT FILE.svg, and the other way round
shows() {
  grep -qF -e "$1" "$2" || { echo "${2##*/} has no '$1'"; return 1; }
}

shows_not() {
  ! grep -qF -e "$1" "$2" || { echo "${2##*/} has '$1'"; return 1; }
}

tables() {
  motion_deck "0 to 360 step 15" >"$scratch/moves.deck"
  beam_deck "CRANK 0 to 350 step 10" "MODES 2" "REPORT frequencies" >"$scratch/swings.deck"
  run 0 --quiet --out "$scratch" "$scratch/moves.deck" "$scratch/swings.deck"
}

# refused TEXT ARGUMENT...
refused() {
  text=$1
  shift
  plot 2 "$@" && says "$text" && [ ! -s "$scratch/stdout" ] && absent "$scratch/moves/figures"
}

wrong_options() {
  refused "unknown option --formt" --formt svg "$scratch/moves" &&
    refused "--format gif: png, svg or pdf" --format gif "$scratch/moves" &&
    refused "--format takes a value" --format &&
    refused "--size 1200: WIDTHxHEIGHT of 150 to 10000 pixels or 40 to 2000 mm each" --size 1200 "$scratch/moves" &&
    refused "--size 12x8:" --size 12x8 "$scratch/moves" &&
    refused "--size 1200x800in:" --size 1200x800in "$scratch/moves" &&
    refused "--size takes a value" --size= "$scratch/moves" &&
    refused "--format takes a value" --format "" "$scratch/moves" &&
    refused "--size 1200x800" --size "$(printf '1200x800\n900')" "$scratch/moves" &&
    refused "--errors takes no value: --errors=1" --errors=1 "$scratch/moves" &&
    refused "--help takes no value" --help= "$scratch/moves" &&
    refused "unknown option --formt=svg" --formt=svg "$scratch/moves" &&
    refused "--animate takes no --format, --size, --errors, --each, --only or --overlay" --animate --format svg "$scratch/moves" &&
    refused "--format png,gif: png, svg or pdf" --format png,gif "$scratch/moves" &&
    refused "--format png,: png, svg or pdf" --format png, "$scratch/moves" &&
    refused "--only camp: expected one of balance bearings branches campbell" --only motion,camp "$scratch/moves" &&
    refused "--style $scratch/nowhere: no such file; expected one with commands of gnuplot" --style "$scratch/nowhere" "$scratch/moves" &&
    refused "--overlay points.csv:1: expected FILE:X:Y" --overlay points.csv:1 "$scratch/moves" &&
    refused "no file $scratch/nowhere; expected FILE:X:Y" --overlay "$scratch/nowhere:1:2" "$scratch/moves" &&
    refused "options stand before the folder: --errors" "$scratch/moves" --errors &&
    refused "options stand before the folder: --size=3" "$scratch/moves" --size=3 &&
    refused "no folder " "" &&
    refused "the folder with the tables of a deck is missing" --errors &&
    refused "no folder $scratch/nowhere" "$scratch/nowhere" &&
    refused "moves.deck is a file: name the folder" "$scratch/moves.deck"
}

help_and_version() {
  plot 0 --help && silent || return 1
  for option in --animate --each --errors --format --only --overlay --size --style --no-titles --help --version; do
    grep -q -e "$option" "$scratch/stdout" || { echo "the help has no $option"; return 1; }
  done
  plot 0 --version && [ "$(cat "$scratch/stdout")" = "flexmech-plot $("$program" --version | sed 's/flexmech //')" ] || cat "$scratch/stdout"
}

values_behind_equal_signs() {
  plot 0 --format=svg --size=900x700 --no-titles "$scratch/swings" && silent && shows 'width="900" height="700"' "$scratch/swings/figures/frequencies.svg" &&
    shows_not "Natural frequencies" "$scratch/swings/figures/frequencies.svg" || return 1
  plot 0 --format=pdf "$scratch/swings" "$scratch/swings" && [ "$(grep -c 'frequencies\.pdf$' "$scratch/stdout")" -eq 2 ]
}

# Whatever the name of a folder, or of that of the scripts, means to the shell, to awk or to gnuplot.
odd_folders() {
  odd=$(printf 'it'\''s "a" `touch run` $(touch run) $x; \\n\\ %%s &|*?[\303\251] @x #\nb')
  mkdir "$scratch/odd" "$scratch/odd/$odd" && cp -R plots "$scratch/odd/$odd" || return 1
  for name in "$odd" -dash - --errors --size=3; do
    mkdir -p "$scratch/odd/$name" && cp "$scratch/swings/"*.dat "$scratch/odd/$name" || return 1
  done
  (cd "$scratch/odd" && CDPATH=$scratch FLEXMECH=$program sh "./$odd/plots/flexmech-plot" --format svg -- "$odd" -dash - --errors --size=3) \
    >"$scratch/stdout" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  for name in "$odd" -dash - --errors --size=3; do
    grep -qxF -e "$(printf '%s' "$name" | tail -n 1)/figures/frequencies.svg" "$scratch/stdout" && [ -s "$scratch/odd/$name/figures/frequencies.svg" ] ||
      { echo "no figures of $name"; return 1; }
  done
  absent "$scratch/odd/run" "$scratch/odd/$odd/run" run
}

several_folders() {
  plot 0 "$scratch/moves" "$scratch/swings" && silent && [ "$(wc -l <"$scratch/stdout")" -eq 2 ] || { cat "$scratch/stdout"; return 1; }
  plot 1 "$scratch/moves" "$scratch/nowhere" "$scratch/swings" && says "no folder" && [ "$(wc -l <"$scratch/stdout")" -eq 2 ]
}

# A figure has the size that was asked for, whatever its format; those of another format stay.
formats() {
  folder=$scratch/swings/figures
  rm -rf "$folder"
  there=drawn.txt
  for format in png svg pdf; do
    for size in 900x700 160x100mm; do
      plot 0 --format $format --size $size "$scratch/swings" && silent || return 1
      case $there in *.$format*) ;; *) there="$there frequencies.$format" ;; esac
      [ "$(ls "$folder")" = "$(printf '%s\n' $there | LC_ALL=C sort)" ] || { ls "$folder"; return 1; }
      python3 - "$folder/frequencies.$format" $size <<'END_OF_PYTHON' || return 1
import re
import struct
import sys
import zlib

path, size = sys.argv[1:]
with open(path, "rb") as file:
    data = file.read()
width, height = map(int, size.replace("mm", "").split("x"))
mm = size.endswith("mm")
if path.endswith("png"):
    found = struct.unpack(">II", data[16:24])
    wanted = [length*300/25.4 if mm else length for length in (width, height)]
elif path.endswith("svg"):
    found = re.search(rb'width="(\d+)(mm)?" height="(\d+)(mm)?"', data).groups()
    assert (found[1] == b"mm") == mm, found
    found, wanted = [int(found[0]), int(found[2])], [width, height]
else:
    parts = data + b"".join(zlib.decompressobj().decompress(stream) for stream in re.findall(rb"stream\r?\n(x.*?)endstream", data, re.DOTALL))
    found = [float(number) for number in re.search(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)", parts).groups()]
    wanted = [length*72/(25.4 if mm else 96) for length in (width, height)]
assert all(abs(a - b) <= 1 for a, b in zip(found, wanted)), f"{path} of {size}: {found}, not {wanted}"
END_OF_PYTHON
    done
  done
}

bare() {
  plot 0 --format svg "$scratch/moves" && shows "Link angles" "$scratch/moves/figures/kinematics_angles.svg" &&
    shows "3: link coupler" "$scratch/moves/figures/kinematics_angles.svg" || return 1
  plot 0 --format svg --no-titles "$scratch/moves" && shows_not "Link angles" "$scratch/moves/figures/kinematics_angles.svg" &&
    shows_not "3: link coupler" "$scratch/moves/figures/kinematics_angles.svg" &&
    shows "crank angle" "$scratch/moves/figures/kinematics_angles.svg"
}

errors_on_request() {
  plot 0 "$scratch/swings" && absent "$scratch/swings/figures/errors.png" || return 1
  plot 0 --errors --format svg "$scratch/swings" && shows "estimated relative error" "$scratch/swings/figures/errors.svg"
}

# At rest there are no forces to draw, without a motor no torque of it, and every axis says its unit.
zeros() {
  sed '/^MOTOR/d; /^GRAVITY/d; /^FORCE/d; s/^SPEED.*/SPEED 0 5/; s/end=4/end=1 speed=5/' inputs/rigid.deck >"$scratch/still.deck"
  run 0 --quiet --out "$scratch" "$scratch/still.deck" || return 1
  plot 0 --format svg "$scratch/still" && silent || return 1
  folder=$scratch/still/figures
  for name in reactions shaking_force balance harmonics point_rates; do
    [ -s "$folder/${name}_speed_5.svg" ] && absent "$folder/${name}_speed_0.svg" || { echo "$name"; return 1; }
  done
  shows "reduced inertia" "$folder/lagrange_speed_0.svg" && shows_not "torque [" "$folder/lagrange_speed_0.svg" &&
    shows "angular velocity" "$folder/motion.svg" && shows_not "motor torque" "$folder/motion.svg" &&
    shows "force x [N]" "$folder/harmonics_speed_5.svg" && shows "torque [N·m]" "$folder/harmonics_speed_5.svg"
}

# What a parameter is, is on the page.
parameters() {
  beam_deck "CRANK 0 90" "REPORT frequencies" "SPEED 2" "VARY L.1 90 100 mm" | sed 's/length=100 /length=$l.1 /' >"$scratch/varied.deck"
  run 0 --quiet --out "$scratch" "$scratch/varied.deck" && plot 0 --format svg "$scratch/varied" && silent || return 1
  shows "against the length of link crank" "$scratch/varied/figures/frequencies_by_L.1.svg" &&
    shows "length of link crank, L.1 [mm]" "$scratch/varied/figures/frequencies_by_L.1.svg" &&
    shows "ω₂ = 2 rad/s" "$scratch/varied/figures/frequencies_by_L.1.svg" || return 1
  for card in 'length=$L2' 'length=[$L]' 'length=$L.' 'at=$L'; do
    [ -z "$(printf 'LINK crank O2 A %s\n' "$card" | awk -v name=L -f plots/meaning.awk)" ] || { echo "$card is not \$L"; return 1; }
  done
  [ "$(printf 'SECTION s I=$i ! $i\n' | awk -v name=I -f plots/meaning.awk)" = "second moment of area of section s" ]
}

# A gnuplot without the terminal pngcairo draws all figures with another.
other_terminals() {
  mkdir -p "$scratch/bin"
  for terminal in png svg pdfcairo; do
    printf '#!/bin/sh\nexec %s -e "terminals = '\''%s'\''" "$@"\n' "$(command -v gnuplot)" $terminal >"$scratch/bin/gnuplot"
    chmod +x "$scratch/bin/gnuplot"
    case $terminal in pdfcairo) ending=pdf ;; *) ending=$terminal ;; esac
    for folder in moves swings still varied; do
      rm -rf "$scratch/$folder/figures"
      PATH=$scratch/bin:$PATH plot 0 --errors "$scratch/$folder" && says "drawing with $terminal" || return 1
      [ "$(wc -l <"$scratch/stderr")" -eq 1 ] || { cat "$scratch/stderr"; return 1; }
      for file in $(sed '/^#/d; /gif$/d' "$scratch/$folder/figures/drawn.txt"); do
        case $file in *.$ending) ;; *) echo "$file was drawn with $terminal"; return 1 ;; esac
      done
    done
  done
  # Asked for a format, it does not take another.
  printf '#!/bin/sh\nexec %s -e "terminals = '\''png'\''; GPVAL_TERMINALS = '\''png'\''" "$@"\n' "$(command -v gnuplot)" >"$scratch/bin/gnuplot"
  PATH=$scratch/bin:$PATH plot 1 --format pdf "$scratch/swings" && says "pdf"
}

# The command, installed: it finds its scripts and the program, from anywhere.
installed() {
  make --no-print-directory -s install PREFIX="$scratch/prefix" >"$scratch/stdout" 2>&1 || { cat "$scratch/stdout"; return 1; }
  rm -rf "$scratch/moves/figures"
  (cd "$scratch" && PATH=/usr/bin:/bin sh prefix/bin/flexmech-plot moves) >"$scratch/stdout" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
  silent && [ -s "$scratch/moves/figures/kinematics_angles.png" ] || return 1
  ln -s prefix/bin/flexmech-plot "$scratch/link"
  [ "$(sh "$scratch/link" --version)" = "flexmech-plot $("$program" --version | sed 's/flexmech //')" ] || { sh "$scratch/link" --version; return 1; }
  cp "$scratch/prefix/bin/flexmech-plot" "$scratch/alone"
  sh "$scratch/alone" moves 2>"$scratch/stderr"
  [ $? -eq 1 ] && says "make install"
}

# made STATUS ARGUMENT...: make in a folder like this one, which builds nothing.
made() {
  wanted=$1
  shift
  make --no-print-directory -s -C "$tree" -o all "$@" >"$scratch/stdout" 2>"$scratch/stderr"
  found=$?
  [ $found -eq "$wanted" ] || { echo "make $*: status $found, not $wanted"; head -n 5 "$scratch/stderr"; return 1; }
}

# What is typed at make is a text, whatever it means to make or to the shell.
typed_at_make() {
  tree=$scratch/tree
  text='it'\''s "a" `touch run` $(touch run) $$x$ $(shell touch run); touch run; \n %s &|*?[é] #'
  mkdir "$tree" && cp -R Makefile ./*.md CITATION.cff LICENSE make plots library exchange docs inputs "$tree" && ln -s "$(pwd)/build" "$tree/build" || return 1
  for name in -dash "$text"; do
    motion_deck >"$tree/$name.deck"
    made 0 figures DECK="$name.deck" && [ -s "$tree/outputs/$name/figures/kinematics_angles.png" ] || { echo "no figures of $name"; return 1; }
    (export DECK="$name.deck" && made 0 run) || return 1
  done
  for name in FORMAT SIZE TITLES ERRORS STYLE OVERLAY; do
    made 2 figures DECK=-dash.deck "$name=$text" && says "make: $name=$text: " || return 1
  done
  made 2 figures DECK=-dash.deck ONLY="$text" && says "make: ONLY=it's: expected one of " || return 1
  printf 'crank,angle\n0,0\n' >"$tree/$text.csv" && printf 'set border 3\n' >"$tree/$text.gp" && rm -r "$tree/outputs/-dash/figures" &&
    made 0 figures DECK=-dash.deck ONLY=kinematics_angles STYLE="$text.gp" OVERLAY="$text.csv:1:2" || return 1
  [ "$(ls "$tree/outputs/-dash/figures")" = "$(printf 'drawn.txt\nkinematics_angles.png')" ] || { ls "$tree/outputs/-dash/figures"; return 1; }
  made 2 animate DECK="$text" && says "there is no file $text;" && made 2 run && says "DECK is missing" &&
    made 2 golden CASE="$text" && says "there is no inputs/$text.deck" || return 1
  made 0 install PREFIX="/$text" DESTDIR="$text" && [ -x "$tree/$text/$text/bin/flexmech-plot" ] && made 0 install PREFIX=-dash &&
    [ -x "$tree/-dash/bin/flexmech" ] || { echo "nothing is installed"; return 1; }
  made 0 -n accuracies linkages loads vibrations SEED="$text" LOADS="$text" FREQUENCIES="$text" LINKAGES="$text" VIBRATIONS="$text" &&
    ! grep -F "touch run" "$scratch/stdout" && absent "$tree/run"
}

# spoil TABLE COLUMN VALUE [ROW]: of a folder, in all rows or in one.
spoil() {
  [ -f "$1.whole" ] || cp "$1" "$1.whole" || return 1
  value=$3 awk -v column="$2" -v row="${4-0}" '
    /^#/ { if (!rows) { units = names; names = last; last = $0 } print; next }
    NF && !rows++ { n = split(names, name, " "); for (i = 2; i <= n; i++) if (name[i] == column) at = i - 1 }
    NF && (!row || row == rows) { $at = ENVIRON["value"] }
    { print }' "$1.whole" >"$1"
}

# costs TEXT FIGURE...: the text is told of the tables of the deck `spoiled`; these figures are drawn, and no others.
costs() {
  rm -rf "$scratch/spoiled/figures"
  plot 1 --format svg "$scratch/spoiled" && says "$1" || return 1
  shift
  [ "$(sed -n 's/^.*figures.\(.*\).svg$/\1/p' "$scratch/stdout" | tr '\n' ' ')" = "$* " ] || { echo "not $*:"; cat "$scratch/stdout"; return 1; }
}

# What is no number, or no name, costs the figures that need it.
not_numbers() {
  { motion_deck && printf 'SPEED 2\nPOINT p coupler along=10\nREPORT points\nREPORT pins\n'; } >"$scratch/spoiled.deck"
  run 0 --quiet --out "$scratch" "$scratch/spoiled.deck" || return 1
  table=$scratch/spoiled/kinematics.dat
  others="coupler_curve kinematics_angles kinematics_velocities pin_motion point_rates"
  for value in NaN -nan Inf -Infinity 1e999 '****' 1,5 "$(printf '1\033[7m')"; do
    for row in 0 3; do
      spoil "$table" alpha3 "$value" $row && costs "kinematics.dat, line" $others && says ": alpha3 is " && says "; not drawn: kinematics_accelerations" || return 1
    done
  done
  spoil "$table" crank inf 2 && costs "crank is inf; not drawn: kinematics_angles kinematics_velocities kinematics_accelerations" coupler_curve pin_motion point_rates || return 1
  spoil "$table" By "" 5 && costs "12 values in 13 columns" coupler_curve pin_motion point_rates && mv "$table.whole" "$table" || return 1
  others="coupler_curve kinematics_accelerations kinematics_angles kinematics_velocities"
  for name in 'A"||system("touch<run")||"' 'A`touch<run`' '../A' "A\\"; do
    spoil "$scratch/spoiled/pins.dat" pin "$name" 1 && costs "pins.dat, line" $others point_rates && says ": pin is " || return 1
  done
  spoil "$scratch/spoiled/points.dat" vx NaN && costs "points.dat, line" $others && absent run "$scratch/spoiled/run" || return 1
  for table in tests/golden/*/*.dat; do
    awk -v want=wrong -f plots/quoted.awk -f plots/tables.awk <"$table" | grep . && { echo "in $table"; return 1; }
  done
  return 0
}

# slow_plot SIGNAL FOLDER...: sent a signal while gnuplot, which takes two seconds for nothing, is at work.
slow_plot() {
  rm -f "$scratch/begun"
  signal=$1
  shift
  PATH=$scratch/slow:$PATH python3 -c "$hearing" sh plots/flexmech-plot "$@" >"$scratch/stdout" 2>"$scratch/stderr" &
  while [ ! -e "$scratch/begun" ] && kill -0 $!; do sleep 0.1; done
  kill -s "$signal" $!
  wait $!
}

# Of a run that a signal ends nothing stays, nor does it go on. One that is killed leaves a folder, which goes with the next run.
signals() {
  mkdir -p "$scratch/slow"
  printf '#!/bin/sh\ncase $* in *GPVAL*) exec %s "$@" ;; esac\n: >"%s/begun"\nsleep 2\n: >"%s/lived"\n' "$(command -v gnuplot)" "$scratch" "$scratch" \
    >"$scratch/slow/gnuplot"
  chmod +x "$scratch/slow/gnuplot"
  for wanted in INT:130 TERM:143 HUP:143; do
    for folders in "$scratch/moves" "$scratch/moves $scratch/swings"; do
      slow_plot ${wanted%:*} $folders
      found=$?
      [ $found -eq ${wanted#*:} ] && absent "$scratch/moves/.figures."* || { echo "$wanted: status $found"; return 1; }
    done
  done
  sleep 2
  absent "$scratch/lived" || return 1
  slow_plot KILL "$scratch/moves"
  sleep 100 &
  mkdir "$scratch/moves/.figures.$!" "$scratch/moves/.figures.1-b" && plot 0 "$scratch/moves" && rmdir "$scratch/moves/.figures.$!" "$scratch/moves/.figures.1-b"
  found=$?
  kill $!
  [ $found -eq 0 ] && absent "$scratch/moves/.figures."*
}

# Several runs at once, which take long to move their figures: the folder has all of each, and knows them.
at_once() {
  rm -rf "$scratch/spoiled"
  mkdir -p "$scratch/moving"
  printf '#!/bin/sh\nsleep 0.2\nexec %s "$@"\n' "$(command -v mv)" >"$scratch/moving/mv"
  chmod +x "$scratch/moving/mv"
  run 0 --quiet --out "$scratch" "$scratch/spoiled.deck" || return 1
  for format in svg pdf png; do
    PATH=$scratch/moving:$PATH sh plots/flexmech-plot --format $format "$scratch/spoiled" >"$scratch/drawn.$format" 2>&1 &
  done
  wait
  ls "$scratch/spoiled/figures" | grep -v drawn.txt | LC_ALL=C sort >"$scratch/names"
  [ "$(wc -l <"$scratch/names")" -eq 19 ] || { cat "$scratch/names"; return 1; }
  sed '/^#/d' "$scratch/spoiled/figures/drawn.txt" | LC_ALL=C sort | cmp - "$scratch/names" &&
    sed 's/.*figures.//' "$scratch/drawn.svg" "$scratch/drawn.pdf" "$scratch/drawn.png" | LC_ALL=C sort | cmp - "$scratch/names" &&
    absent "$scratch/spoiled/.figures."*
}

# whole FIGURE SCRIPT ARGUMENT...: drawn as an SVG without a complaint, no word cut.
whole() {
  figure=$scratch/$1
  script=$2
  table=$3
  shift 3
  LC_ALL=C.UTF-8 gnuplot -e "figure_format = 'svg'" -c "plots/$script" "$table" "$figure" "$@" 2>"$scratch/stderr" && silent || return 1
  python3 -B tests/support/figure_extents.py check "$figure.svg"
}

# Sixteen variants are four panels of four marks, and numbered cases have their two errors for axes.
stress_figures() {
  for case in mass time length all; do
    for way in accuracy deformation dense band; do
      for k in 1e-9 1e0 1e9; do
        echo "$k $case-$way 20 60 1 1e-14 2e-13 0.05 - bounded -"
      done
    done
  done >"$scratch/units.dat"
  whole units stress.gp "$scratch/units.dat" "size of the unit, relative" "Stress test: units" || return 1
  for text in accuracy= deformation dense band mass time length all; do
    shows ">$text<" "$scratch/units.svg" || return 1
  done
  shows_not "mass-" "$scratch/units.svg" || return 1
  whole random stress.gp "$scratch/units.dat" "number of the linkage" "Stress test: random" &&
    shows "true relative error" "$scratch/random.svg" && shows "estimated relative error" "$scratch/random.svg"
}

# Two numbers of threads are bars, many are a curve.
bench_figures() {
  { printf '# run times\n# solver threads per_position\n# - - s\n'
    for solver in dsygv band accuracy; do
      printf '%s 1 2e-5\n%s 2 1.1e-5\n' $solver $solver
    done; } >"$scratch/threads.dat"
  whole threads bench_cost.gp "$scratch/threads.dat" threads per_position "Time of a position against threads" threads "" &&
    shows ">threads: 2<" "$scratch/threads.svg" || return 1
  printf 'accuracy 4 7e-6\naccuracy 8 5e-6\n' >>"$scratch/threads.dat"
  whole more bench_cost.gp "$scratch/threads.dat" threads per_position "Time of a position against threads" threads "" &&
    shows_not "threads: 2" "$scratch/more.svg"
}

check "flexmech-plot: tables to draw" tables
check "flexmech-plot: wrong options" wrong_options
check "flexmech-plot: help and version" help_and_version
check "flexmech-plot: several folders" several_folders
check "flexmech-plot: values behind =" values_behind_equal_signs
check "flexmech-plot: folders with odd names" odd_folders
check "flexmech-plot: formats and sizes" formats
check "flexmech-plot: bare figures" bare
check "flexmech-plot: errors on request" errors_on_request
check "figures without panels of zeros, with units" zeros
check "figures against a parameter" parameters
check "figures with other terminals" other_terminals
check "flexmech-plot: installed" installed
check "what is typed at make is a text" typed_at_make
check "tables with what is no number or no name" not_numbers
check "flexmech-plot: signals" signals
check "flexmech-plot: several runs at once" at_once
check "figures of the stress test" stress_figures
check "figures of make bench" bench_figures
