#!/bin/sh
# VARY: one table of all variants, whose rows are those of plain decks with the values in place.
. tests/scripts/functions.sh

out=$scratch/out

# varied CARD...: a deck whose coupler and follower lengths are $b and $c.
varied() {
  beam_deck "$@" | sed 's/length=279.4/length=$b/; s/length=266.7/length=$c/'
}

all_reports() {
  printf '%s\n' "CRANK 0 to 360 step 90" "SPEED 0 12" "REPORT kinematics" "REPORT inertia" "REPORT mesh" "REPORT frequencies" \
    "REPORT shapes crank=0,90 points=3" "REPORT branches"
}

{ varied "VARY b 270 280.5" "VARY c 260 to 280 step 10" && all_reports; } >"$scratch/grid.deck"
mkdir "$scratch/plain"
for b in 270 280.5; do
  for c in 260 270 280; do
    { varied "SET b $b" "SET c $c" && all_reports; } >"$scratch/plain/${b}_$c.deck"
  done
done
run 0 --out "$out" --threads 2 --format csv "$scratch/grid.deck"
run 0 --out "$scratch/plain" --format csv "$scratch"/plain/*.deck

# composed: the tables of the grid are the header with two more columns, and the rows of the plain tables after their values;
# two empty lines between variants. Likewise in CSV.
composed() {
  python3 -B - "$out/grid" "$scratch/plain" <<'END_OF_PYTHON'
import glob, os, sys

grid, plain = sys.argv[1:]
variants = [(b, c) for b in ("270", "280.5") for c in ("260", "270", "280")]  # the last varies fastest
tables = sorted(os.path.basename(path) for path in glob.glob(os.path.join(grid, "*.dat")))
assert len(tables) == 7, tables

def read(*path):
    with open(os.path.join(*path), encoding="utf-8", newline="") as file:
        return file.read()

def cell(word):
    return f"{float(word):25g}"

for table in tables:
    # Remarks of the variants (angles, limits) may differ: the rows are compared, and the names and units.
    def parts(text):
        lines = text.split("\n")
        head = max(i for i in range(len(lines)) if lines[i].startswith("#") and all(l.startswith("#") for l in lines[:i]))
        return lines[head - 1:head + 1], lines[head + 1:-1]
    expected = []
    for b, c in variants:
        names, rows = parts(read(plain, f"{b}_{c}", table))
        if expected:
            expected += ["", ""]
        expected += [cell(b) + cell(c) + row if row and not row.startswith("#") else row for row in rows]
    found_names, found = parts(read(grid, table))
    found = [row for row in found if not row.startswith("# ") or row.startswith("# failed")]
    assert found_names[0].split() == ["#", "b", "c"] + names[0][1:].split(), f"{table}: {found_names[0]}"
    assert found_names[1].split() == ["#", "-", "-"] + names[1][1:].split(), f"{table}: {found_names[1]}"
    assert len(found) == len(expected), f"{table}: {len(found)} rows, not {len(expected)}"
    for line, (a, b) in enumerate(zip(found, expected)):
        assert a == b, f"{table}, row {line}: '{a}' is not '{b}'"
    csv = table[:-4] + ".csv"
    expected = []
    for b, c in variants:
        head, *rows = read(plain, f"{b}_{c}", csv).split("\r\n")[:-1]
        expected = expected or ["b,c," + head]
        expected += [f"{cell(b).strip()},{cell(c).strip()},{row}" for row in rows]
    assert read(grid, csv).split("\r\n")[:-1] == expected, csv
END_OF_PYTHON
}
check "every variant has the rows of a plain deck, in all tables and in CSV" composed

threads_change_nothing() {
  for threads in 1 7; do
    run 0 --out "$scratch/threads" --threads $threads --format csv "$scratch/grid.deck" && silent || return 1
    same "$out/grid" "$scratch/threads/grid" || return 1
  done
}
check "threads change nothing" threads_change_nothing

# echo_again FOLDER NAME: the echo of a deck gives its tables.
echo_again() {
  cp "$1/echo.deck" "$scratch/$2.deck"
  run 0 --out "$scratch/again" --format csv "$scratch/$2.deck" && same_tables "$1" "$scratch/again/$2"
}
check "the echo gives the same tables" echo_again "$out/grid" grid

set_one() {
  run 0 --out "$scratch/set" --format csv --set b=280.5 --set c=270 "$scratch/grid.deck" && silent &&
    same_tables "$scratch/plain/280.5_270" "$scratch/set/grid"
}
check "--set of all varied values makes a plain deck" set_one
set_half() {
  run 0 --out "$scratch/half" --set c=270 "$scratch/grid.deck" && silent || return 1
  grep -q '^# *b  *speed  *crank  *f1' "$scratch/half/grid/frequencies.dat" || { echo "columns"; return 1; }
  [ "$(grep -cv -e '^#' -e '^$' "$scratch/half/grid/frequencies.dat")" -eq 20 ]
}
check "--set of one varied value leaves the other" set_half

summary_counts() {
  python3 -B - "$out/grid/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    summary = json.load(file)
assert summary["counts"]["variants"] == 6, summary["counts"]
assert summary["counts"]["positions"] == 30 and summary["counts"]["speeds"] == 2, summary["counts"]
assert [column["name"] for column in summary["tables"][0]["columns"][:3]] == ["b", "c", "speed"]
END_OF_PYTHON
}
check "the summary counts variants" summary_counts
check "the log names the first variant and the last" \
  eval 'grep -q "^first of 6 variants, b=270 c=260:$" "$out/grid/run.log" && grep -q "the last one with b=280.5 c=280:$" "$out/grid/run.log"'

# A parallelogram has dead points at 0 and 180 degrees: one variant of three.
varied "SET b 254" "VARY c 105 100 110" "CRANK 0 90" "REPORT frequencies" >"$scratch/dead.deck"
failed_rows() {
  run 1 --out "$out" --format csv "$scratch/dead.deck" || return 1
  says "dead.deck: error: c=100, crank 0 deg" || return 1
  grep -q '^# failed c=100 speed=0 crank=0 : ' "$out/dead/frequencies.dat" || { echo "no failed row"; return 1; }
  python3 -B - "$out/dead/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    summary = json.load(file)
failure, = summary["failures"]
assert failure["parameters"] == {"c": 100}, failure
assert failure["crank"] == 0 and summary["exit_status"] == 1, failure
END_OF_PYTHON
}
check "failed rows name the varied values" failed_rows

# Modes are columns of one table: the deck is refused, not some of its variants.
refused() {
  varied "SET c 266.7" "SET b 280" "VARY n 2 3 1" "MODES \$n" "CRANK 0 90" "REPORT frequencies" >"$scratch/refused.deck"
  run 2 --out "$scratch/nothing" "$scratch/refused.deck" && says "error: with n=3: all variants must have as many modes" &&
    [ "$(grep -c error: "$scratch/stderr")" -eq 1 ] && absent "$scratch/nothing" &&
    run 2 --check --out "$scratch/nothing" "$scratch/refused.deck" && says "error: with n=3: all variants must have as many modes"
}
check "variants that cannot be in one table: nothing is written" refused

# A coupler of 900 mm fits nowhere, one of 100 at 0 degrees only; the others are computed.
varied "SET c 266.7" "VARY b 280 900 270 100" "SPEED 0 2" "CRANK 0 90" "REPORT kinematics" "REPORT frequencies" "REPORT linkage" \
  >"$scratch/unreachable.deck"
unreachable() {
  run 1 --out "$out" --threads 1 --format csv "$scratch/unreachable.deck" || return 1
  says "unreachable.deck: error: b=900: the linkage closes at no crank angle" && says "error: b=100, crank 0 deg: out of reach: 'follower' is" &&
    says "in 1 of 4 variants, b=900: rows will be marked as failed" || return 1
  for table in kinematics frequencies; do
    for speed in 0 2; do
      for crank in 0 90; do
        grep -q "^# failed b=900 speed=$speed crank=$crank : the linkage closes at no" "$out/unreachable/$table.dat" ||
          { echo "$table has no failed row"; return 1; }
      done
    done
    # Each of three variants has two positions and two speeds; of the last one a position is missing.
    [ "$(grep -cv -e '^#' -e '^$' "$out/unreachable/$table.dat")" -eq $((4 + 4 + 2)) ] || { echo "rows of $table"; return 1; }
    [ "$(grep -c '^9.*,the linkage\|^9.*,"the linkage' "$out/unreachable/$table.csv")" -eq 4 ] || { echo "csv of $table"; return 1; }
  done
  grep -q "^# failed b=900 : the linkage closes at no" "$out/unreachable/linkage.dat" || { echo "linkage"; return 1; }
  python3 -B - "$out/unreachable/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    summary = json.load(file)
assert summary["exit_status"] == 1 and summary["counts"]["variants"] == 4, summary["counts"]
assert summary["counts"]["failed_rows"] == 2*(4 + 2) + 1 and summary["counts"]["failures"] == 2, summary["counts"]
found = [(f["parameters"]["b"], f["stage"], f["crank"]) for f in summary["failures"]]
assert found == [(900, "variant", None), (100, "position", 0)], found
END_OF_PYTHON
}
check "variants out of reach are failed rows, the others are computed" unreachable

# The same rows as a deck without the variant that fails, and the same bytes on any number of threads.
unreachable_rows() {
  run 1 --quiet --out "$scratch/threads" --threads 5 --format csv "$scratch/unreachable.deck" &&
    same "$out/unreachable" "$scratch/threads/unreachable" || return 1
  sed 's/^VARY.*/VARY b 280 270/' "$scratch/unreachable.deck" >"$scratch/reachable.deck"
  run 0 --quiet --out "$out" "$scratch/reachable.deck" || return 1
  for table in kinematics frequencies; do
    for deck in reachable unreachable; do
      grep -e '^ *2\.8' -e '^ *2\.7' "$out/$deck/$table.dat" >"$scratch/$deck.rows"
    done
    cmp "$scratch/reachable.rows" "$scratch/unreachable.rows" || return 1
  done
}
check "whatever fails, and for any number of threads" unreachable_rows

first_unreachable() {
  sed 's/^VARY.*/VARY b 900 280/' "$scratch/unreachable.deck" >"$scratch/first.deck"
  run 1 --out "$out" "$scratch/first.deck" && says "b=900: the linkage closes at no crank angle" && echo_again_failing first &&
    grep -q "^first of 2 variants, b=900:$" "$out/first/run.log"
}
echo_again_failing() {
  cp "$out/$1/echo.deck" "$scratch/$1.deck"
  run 1 --out "$scratch/again" "$scratch/$1.deck" && same_tables "$out/$1" "$scratch/again/$1"
}
check "the first variant out of reach" first_unreachable

none_reachable() {
  sed 's/^VARY.*/VARY b 900 950/' "$scratch/unreachable.deck" >"$scratch/none.deck"
  run 2 --out "$scratch/nothing" "$scratch/none.deck" && says "error: with b=900: the linkage closes at no crank angle" &&
    says "2 of 2 variants are refused" && absent "$scratch/nothing"
}
check "no variant reaches any position: the deck is refused" none_reachable

reach_is_checked() {
  run 0 --check --out "$scratch/nothing" "$scratch/unreachable.deck" && says "rows will be marked as failed" && absent "$scratch/nothing"
}
check "--check warns of variants out of reach" reach_is_checked

# One warning a kind, with the number of variants and the worst, everywhere.
one_warning() {
  varied "SET b 279.4" "SET c 266.7" "VARY L 90 to 110 step 2" "CRANK 0" "SPEED 0 20 40" "REPORT frequencies" |
    sed 's/length=100/length=$L/' >"$scratch/warned.deck"
  run 0 --out "$out" --threads 2 "$scratch/warned.deck" || return 1
  text="in 11 of 11 variants, the worst with L=110: the inertia loads at speed 40 rad/s"
  says "warned.deck: warning: $text" || return 1
  [ "$(grep -c 'warning: ' "$scratch/stderr")" -eq 1 ] || { echo "$(grep -c 'warning: ' "$scratch/stderr") warnings"; return 1; }
  grep -q "^warning: $text" "$out/warned/run.log" && [ "$(grep -c '^warning: ' "$out/warned/run.log")" -eq 1 ] || { echo "the log"; return 1; }
  run 0 --json --out "$out" "$scratch/warned.deck" || return 1
  python3 -B - "$out/warned/summary.json" "$scratch/stdout" "$text" <<'END_OF_PYTHON'
import json, sys
summary, document = (json.load(open(path, encoding="utf-8")) for path in sys.argv[1:3])
for warnings in summary["warnings"], document["decks"][0]["warnings"]:
    warning, = warnings
    assert warning["message"].startswith(sys.argv[3]) and warning["variants"] == 11 and warning["grade"] == "doubt", warning
END_OF_PYTHON
}
check "one warning per kind, with the number of variants" one_warning

many() {
  varied "SET c 266.7" "VARY b 270 to 280 step 0.01" "CRANK 0 90" "REPORT frequencies" >"$scratch/many.deck"
  run 0 --out "$out" --threads 1 "$scratch/many.deck" && run 0 --out "$scratch/again" --threads 3 "$scratch/many.deck" &&
    same "$out/many" "$scratch/again/many" || return 1
  [ "$(grep -cv -e '^#' -e '^$' "$out/many/frequencies.dat")" -eq 2002 ]
}
check "a thousand variants in their order" many

# In doubles, 270 + 17 × 0.05 and 3 × 0.1 are not 270.85 and 0.3; a person who writes these numbers expects them in the tables,
# and the rows of the deck with the number in its place. Here in a unit that is not the deck's.
decimals() {
  varied "SET c 266.7" "VARY b 270mm to 271mm step 0.05mm" "CRANK 0 to 1 step 0.1" "SPEED 0 to 30.2 step 15.1 rpm" \
    "REPORT points" "POINT p coupler along=1" | sed 's/^UNITS.*/UNITS in lbm s/; s/=100 /=100mm /; s/ 254 / 254mm /' |
    sed 's/^SET c 266.7/SET c 266.7mm/' >"$scratch/decimals.deck"
  run 0 --quiet --format csv --out "$out" "$scratch/decimals.deck" || return 1
  sed 's/^VARY.*/SET b 270.85mm/; s/^CRANK.*/CRANK 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1/; s/^SPEED.*/SPEED 0 15.1 30.2 rpm/' \
    "$scratch/decimals.deck" >"$scratch/decimal.deck"
  run 0 --quiet --format csv --out "$out" "$scratch/decimal.deck" || return 1
  python3 -B - "$out/decimals/points.csv" "$out/decimal/points.csv" <<'END_OF_PYTHON'
import csv, sys
with open(sys.argv[1], encoding="utf-8", newline="") as file:
    varied = list(csv.reader(file))[1:]
with open(sys.argv[2], encoding="utf-8", newline="") as file:
    plain = list(csv.reader(file))[1:]
values = [float(row[0]) for row in varied[::33]]
wanted = [float(f"{270 + i/20:.2f}") for i in range(21)]
assert values == wanted, f"{values}"
assert [float(row[1]) for row in plain[:11]] == [float(f"0.{i}") for i in range(10)] + [1.0]
assert [row[1:] for row in varied if float(row[0]) == 270.85] == plain, "rows differ"
END_OF_PYTHON
}
check "ranges have the decimals as written by hand" decimals

# VARY with the table of a file: a row is a variant, in the order of the rows, whose rows are those of the plain decks above.
cases_deck() {
  mkdir -p "$scratch/cases"
  printf 'units mm mm  ! of b and c\n280.5 260\n\n270 280mm\n270 $least ! from the deck\n' >"$scratch/cases/cases.dat"
  { varied "VARY b c table=cases/cases.dat" "SET least 250mm + 10mm" && all_reports; } >"$scratch/cases.deck"
}

# rows_of FOLDER COLUMNS DECK...: every table has, behind so many columns, the rows of the plain decks, one after the other.
rows_of() {
  python3 -B - "$@" <<'END_OF_PYTHON'
import csv, glob, os, sys
folder, columns, decks = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
tables = sorted(os.path.basename(path) for path in glob.glob(os.path.join(folder, "*.csv")))
assert len(tables) == 7, tables
def rows(*path):
    with open(os.path.join(*path), encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]
for table in tables:
    wanted = [row for deck in decks for row in rows(deck, table)]
    assert [row[columns:] for row in rows(folder, table)] == wanted, table
END_OF_PYTHON
}

cases() {
  cases_deck
  run 0 --check "$scratch/cases.deck" && silent && run 0 --out "$out" --threads 2 --format csv "$scratch/cases.deck" &&
    rows_of "$out/cases" 2 "$scratch/plain/280.5_260" "$scratch/plain/270_280" "$scratch/plain/270_260" || return 1
  mkdir -p "$scratch/alone" && cp "$out/cases/echo.deck" "$scratch/alone/cases.deck" &&
    run 0 --out "$scratch/alone/out" --format csv "$scratch/alone/cases.deck" && same_tables "$out/cases" "$scratch/alone/out/cases"
}
check "variants from the table of a file" cases

cases_in_parts() {
  cases_deck
  for part in 1 2 3; do
    run 0 --out "$scratch/parts" --part "$part/3" "$scratch/cases.deck" || return 1
  done
  run 0 --out "$scratch/parts" --format csv --join "$scratch/cases.deck" && same_tables_but_parts "$out/cases" "$scratch/parts/cases"
}
same_tables_but_parts() {
  diff -rq -x run.log -x echo.deck -x summary.json -x '*.part*of*' "$1" "$2"
}
check "variants from a table in parts" cases_in_parts

# The others go on as the table has them; the echo has a dash in place of the name.
cases_overridden() {
  cases_deck
  run 0 --out "$scratch/set" --format csv --set c=260mm "$scratch/cases.deck" && silent &&
    rows_of "$scratch/set/cases" 1 "$scratch/plain/280.5_260" "$scratch/plain/270_260" "$scratch/plain/270_260" || return 1
  grep -q '^VARY b - table=cases/cases.dat  *! line ' "$scratch/set/cases/echo.deck" &&
    grep -q '^SET c 260mm  *! --set on the command line' "$scratch/set/cases/echo.deck" || { cat "$scratch/set/cases/echo.deck"; return 1; }
  mkdir -p "$scratch/alone" && cp "$scratch/set/cases/echo.deck" "$scratch/alone/cases.deck" &&
    run 0 --out "$scratch/alone/set" --format csv "$scratch/alone/cases.deck" && silent &&
    same_tables "$scratch/set/cases" "$scratch/alone/set/cases" || return 1
  run 0 --out "$scratch/set" --format csv --set c=260mm --set b=270 "$scratch/cases.deck" && silent &&
    rows_of "$scratch/set/cases" 0 "$scratch/plain/270_260" || return 1
  cp "$scratch/set/cases/echo.deck" "$scratch/alone/cases.deck" && run 0 --out "$scratch/alone/set" --format csv "$scratch/alone/cases.deck" &&
    silent && same_tables "$scratch/set/cases" "$scratch/alone/set/cases"
}
check "--set of names that a table varies" cases_overridden
