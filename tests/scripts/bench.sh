#!/bin/sh
# A short run of `make bench`: tables complete, errors as they must be. Times are not asserted.
. tests/scripts/functions.sh

bench=${program%/*}/bench/bench
out=$scratch/bench
precision=$out/work_precision.dat

short_run() {
  timeout "$longest" "$bench" "$program" "$out" reference short >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  found=$?
  [ $found -eq 0 ] || { echo "status $found; it said:"; head -n 5 "$scratch/stderr"; return 1; }
}

# Rows of as many columns as there are names, without NaN, infinity or stars, none failed.
complete() {
  for table in work_precision cost_elements cost_positions cost_modes cost_threads processes ratios response response_parts scale; do
    [ -s "$out/$table.dat" ] || { echo "no $table.dat"; return 1; }
    awk -v table="$table" '
      /^# failed .*no run came below that error/ { next }
      /^# failed/ { print table ":", $0; exit }
      /^#/ { names = NF - ($1 == "#"); next }
      NF == 0 { next }
      NF != names || /[nN]a[nN]|[iI]nf|\*/ { print table ": " NF " columns, not " names ": " $0; exit }
      { rows++ }
      END { if (!rows) print table ": no rows" }' "$out/$table.dat" | grep . && return 1
  done
  return 0
}

# error LOAD SOLVER MESH ORDER: of a row
error() {
  awk -v load="$1" -v solver="$2" -v mesh="$3" -v order="$4" '
    $1 == load && $2 == solver && $4 == mesh && $5 == order { print $19 }' "$precision"
}

# between LEAST MOST VALUE NAME
between() {
  awk -v least="$1" -v most="$2" -v value="$3" 'BEGIN { exit !(value != "" && value + 0 >= least && value + 0 <= most) }' ||
    { echo "$4: '$3' is not between $1 and $2"; return 1; }
}

# Every solver sees the same mesh: 1.2e-3 with that of the thesis at rest, and 2⁴ less when elements are halved.
errors_of_meshes() {
  for solver in dsygv dsygvx band deformation sweep; do
    between 1.15e-3 1.25e-3 "$(error static $solver 1/4/4 3/3/3)" "$solver" || return 1
    for load in static axial; do
      ratio=$(awk -v a="$(error $load $solver 8/8/8 3/3/3)" -v b="$(error $load $solver 16/16/16 3/3/3)" 'BEGIN { print a/b }')
      between 14 17 "$ratio" "$load $solver" || return 1
      between 0 2e-12 "$(error $load $solver 1/1/1 12/12/12)" "$load $solver order 12" || return 1
    done
  done
  for load in static axial; do
    between 0 1e-14 "$(error $load sweep 1/1/1 12/12/12)" "$load order 12 in deformation coordinates" || return 1
  done
}

# accuracy= keeps its word.
errors_asked_for() {
  [ "$(awk '$3 == "accuracy" && !/^#/' "$precision" | wc -l)" -eq 6 ] || { echo "not six accuracies"; return 1; }
  awk '$3 == "accuracy" && !($19 <= $6) { print }' "$precision" | grep . && return 1
  return 0
}

# Estimated errors of the elastic response are above the true ones and below those asked for; collocation of all unknowns agrees.
errors_of_responses() {
  table=$out/response.dat
  [ "$(awk '$1 == "accuracy"' "$table" | wc -l)" -eq 5 ] || { echo "not five runs"; return 1; }
  awk '$1 == "accuracy" && !($14 <= $2 && $15 <= $14 + 3e-11) { print }' "$table" | grep . && return 1
  between 0 1e-6 "$(awk '$1 == "collocation" { print $15 }' "$table")" collocation
}

# Chains of many links: estimates below the accuracy, and finite elements whose errors are known.
errors_of_chains() {
  table=$out/scale.dat
  [ "$(awk '$1 ~ /^program/' "$table" | wc -l)" -eq 6 ] || { echo "not three chains at rest and moving"; return 1; }
  awk '$1 ~ /^program/ && !($10 > 0 && $10 <= 1e-8) { print }' "$table" | grep . && return 1
  between 2.5e-4 2.6e-4 "$(awk '$1 == "elements_4" && $2 == 4 { print $10 }' "$table")" "4 elements" || return 1
  between 1.0e-6 1.04e-6 "$(awk '$1 == "elements_16" && $2 == 4 { print $10 }' "$table")" "16 elements"
}

wrong_use() {
  "$bench" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  [ $? -eq 2 ] && says "usage: bench PROGRAM FOLDER LIBRARIES [short|corners|linkages|response|scale]"
}

check "make bench: a short run" short_run
check "make bench: all tables are complete" complete
check "make bench: errors of meshes and orders" errors_of_meshes
check "make bench: accuracy= is kept" errors_asked_for
check "make bench: errors of elastic responses" errors_of_responses
check "make bench: errors of chains of many links" errors_of_chains
check "make bench: wrong use" wrong_use
