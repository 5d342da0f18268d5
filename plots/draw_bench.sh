#!/bin/sh
# Draws the figures of `make bench` beside its tables.
#   draw_bench.sh outputs/bench

set -u
[ $# -eq 1 ] && [ -d "$1" ] || { echo 'usage: draw_bench.sh FOLDER   (with the tables of make bench)' >&2; exit 2; }
command -v gnuplot > /dev/null || { echo 'draw_bench.sh: gnuplot is not installed' >&2; exit 1; }
LC_ALL=C.UTF-8
export LC_ALL
plots=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 1
CDPATH='' cd -- "$1" || exit 1

# draw SCRIPT TABLE FIGURE ARGUMENT...: of tables that are there, for a part may have been timed alone
draw() {
    script=$1 table=$2 figure=$3
    shift 3
    [ -f "$table.dat" ] || return 0
    gnuplot -c "$plots/$script" "$table.dat" "$figure" "$@" || exit 1
    printf '%s\n' "$figure.png"
}

for load in static axial; do
    draw bench_work_precision.gp work_precision "work_precision_$load" $load
done
draw bench_cost.gp cost_elements cost_elements elements each \
    'Time of a position against the elements of a link (order 3, at 20 rad/s, 3 modes)' 'elements on every link' \
    'without what is done once per run; a curve ends where its solver is refused or takes too long'
draw bench_cost.gp cost_positions cost_positions positions per_position \
    'Time of a position against their number in a turn (3 modes at 20 rad/s, 1e-8)' 'positions in a turn' \
    'including what is done once per run; dsygv, dsygvx and band on the elements that the program chose'
draw bench_cost.gp cost_modes cost_modes modes each \
    'Time of a position against the number of modes (at 20 rad/s, 1e-8)' 'modes' \
    'without what is done once per run; dsygv, dsygvx and band on the elements that the program chose'
draw bench_cost.gp cost_threads cost_threads threads per_position \
    'Time of a position against threads (3 modes at 20 rad/s, 1e-8)' 'threads' \
    'including what is done once per run; ARPACK serves one thread at a time'
draw bench_scale.gp scale scale
