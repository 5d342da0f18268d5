#!/bin/sh
# --format csv: the plain tables again, for every program that reads comma-separated values.
. tests/scripts/functions.sh

out=$scratch/out

# same_values FOLDER: every table in both forms: the same columns, units, numbers to the digit, and failed rows.
same_values() {
  python3 -B - "$1" <<'END_OF_PYTHON'
import csv, glob, os, re, sys

tables = sorted(glob.glob(os.path.join(sys.argv[1], "*.dat")))
assert tables, "no tables"
for path in tables:
    name = os.path.basename(path)
    with open(path, encoding="utf-8") as plain:
        lines = [line.rstrip("\n") for line in plain]
    # The head; remarks of later variants stand behind it.
    first = next((i for i, line in enumerate(lines) if not line.startswith("#") or line.startswith("# failed ")), len(lines))
    marked = lines[:first]
    names, units = marked[-2][1:].split(), marked[-1][1:].split()
    head = [n if u == "-" else f"{n} [{u}]" for n, u in zip(names, units)] + ["failure"]
    with open(path[:-4] + ".csv", encoding="utf-8", newline="") as file:
        text = file.read()
    assert "#" not in text and "\r\n\r\n" not in text and text.endswith("\r\n"), f"{name}: form"
    assert text.count("\n") == text.count("\r\n"), f"{name}: line ends"
    rows = list(csv.reader(text.splitlines(), strict=True))
    assert rows[0] == head, f"{name}: columns are {rows[0]}"
    assert all(len(row) == len(head) for row in rows), f"{name}: a row is too short or too long"
    expected = []
    for line in lines:
        failed = re.match(r"# failed (.*?) : (.*)", line)
        if failed:
            expected.append(([place.split("=") for place in failed[1].split()], failed[2]))
        elif line and not line.startswith("#"):
            expected.append((line.split(), ""))
    assert len(expected) == len(rows) - 1 > 0, f"{name}: {len(rows) - 1} rows, not {len(expected)}"
    for (cells, reason), row in zip(expected, rows[1:]):
        assert row[-1] == reason, f"{name}: failure is {row[-1]}"
        if not reason:
            assert row[:-1] == cells, f"{name}: {row} is not {cells}"
            continue
        assert [place[0] for place in cells] == names[:len(cells)], f"{name}: the place of {row}"
        for (_, value), cell in zip(cells, row):
            assert abs(float(value) - float(cell)) <= 1e-11*abs(float(value)), f"{name}: {row} is not at {cells}"
        assert not any(row[len(cells):-1]), f"{name}: numbers in {row}"
END_OF_PYTHON
}

# A parallelogram: at 0 and 180 degrees all links lie on one line, in every table.
failed_deck() {
  cat <<'END_OF_DECK'
TITLE    Parallel, "crank, crank"
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  strip rectangle thickness=1 width=10
GROUND   O2 0 0
GROUND   O4 100 0
LINK     a O2 A length=50  material=steel section=strip
LINK     b A  B length=100 material=steel section=strip
LINK     c O4 B length=50  material=steel section=strip
DRIVE    a
MESH     * elements=2
CRANK    0 30 90 180 200 360
SPEED    0 1 2
INERTIA  lumped
PINMASS  A 1g
REPORT   kinematics
REPORT   frequencies
REPORT   inertia
REPORT   shapes points=3
REPORT   mesh
REPORT   branches
END_OF_DECK
}

failed_rows() {
  failed_deck >"$scratch/failed.deck"
  run 1 --quiet --format csv --out "$out" "$scratch/failed.deck" || return 1
  for table in kinematics frequencies inertia shapes branches; do
    [ "$(grep -c '"change point:.*"' "$out/failed/$table.csv")" -eq 9 ] || { echo "$table.csv lacks failed rows"; return 1; }
  done
  same_values "$out/failed"
}

inputs() {
  "$program" --quiet --format csv --out "$out/csv" $(quick_inputs) 2>/dev/null
  "$program" --quiet --format plain --out "$out/plain" $(quick_inputs) 2>/dev/null
  for deck in $(quick_inputs); do
    base=$(basename "$deck" .deck)
    same_values "$out/csv/$base" && diff -rq -x '*.csv' -x summary.json "$out/csv/$base" "$out/plain/$base" || return 1
    for table in "$out/plain/$base"/*.csv; do
      [ ! -e "$table" ] || { echo "there is $table without --format csv"; return 1; }
    done
  done
}

# CSV of before goes with its table, and when it is no longer asked for.
no_longer() {
  beam_deck "CRANK 0" "REPORT mesh" "REPORT frequencies" >"$scratch/again.deck"
  run 0 --format csv --out "$out" "$scratch/again.deck" && [ -s "$out/again/mesh.csv" ] && [ -s "$out/again/frequencies.csv" ] || return 1
  beam_deck "CRANK 0" "REPORT frequencies" >"$scratch/again.deck"
  run 0 --format csv --out "$out" "$scratch/again.deck" && absent "$out/again/mesh.csv" && [ -s "$out/again/frequencies.csv" ] || return 1
  run 0 --out "$out" "$scratch/again.deck" && absent "$out/again/frequencies.csv" && [ -s "$out/again/frequencies.dat" ]
}

# CSV alone: the same bytes; plain tables of before go, and come back when they are asked for again.
alone() {
  beam_deck "CRANK 0 90" "SPEED 0 10" "REPORT mesh" "REPORT frequencies" >"$scratch/alone.deck"
  run 0 --quiet --format csv --out "$out" "$scratch/alone.deck" && mv "$out/alone" "$scratch/both" && cp -r "$scratch/both" "$out/alone" &&
    run 0 --quiet --format csv-only --out "$out" "$scratch/alone.deck" || return 1
  for name in mesh frequencies; do
    absent "$out/alone/$name.dat" "$out/alone/$name.dat.part" && cmp "$scratch/both/$name.csv" "$out/alone/$name.csv" || return 1
    grep -q "\"file\": \"$name.csv\", \"csv\": \"$name.csv\"" "$out/alone/summary.json" || { echo "summary of $name"; return 1; }
    grep -q "\"file\": \"$name.dat\", \"csv\": \"$name.csv\"" "$scratch/both/summary.json" || { echo "summary of both"; return 1; }
  done
  run 0 --quiet --out "$out" "$scratch/alone.deck" && cmp "$scratch/both/mesh.dat" "$out/alone/mesh.dat" && absent "$out/alone/mesh.csv"
}

# Variants, and a run that failed rows: as beside the plain tables.
alone_of_variants() {
  beam_deck "VARY r 1 2 3" "POINT p coupler along=\$r" "CRANK 0 90" "REPORT points" "REPORT frequencies" >"$scratch/variants.deck"
  failed_deck >"$scratch/failed.deck"
  run 1 --quiet --format csv --out "$scratch/both" "$scratch/variants.deck" "$scratch/failed.deck" || return 1
  run 1 --quiet --format csv-only --threads 3 --out "$out" "$scratch/variants.deck" "$scratch/failed.deck" || return 1
  for table in "$scratch/both"/variants/*.csv "$scratch/both"/failed/*.csv; do
    cmp "$table" "$out/${table#"$scratch/both/"}" || return 1
  done
  absent "$out"/variants/*.dat "$out"/failed/*.dat
}

threads() {
  beam_deck "CRANK 0 to 360 step 5" "SPEED 0 10 20" "REPORT frequencies" "REPORT shapes" >"$scratch/threads.deck"
  run 0 --quiet --format csv --out "$out/one" "$scratch/threads.deck" &&
    run 0 --quiet --format csv --threads 3 --out "$out/three" "$scratch/threads.deck" && same "$out/one" "$out/three"
}

check "CSV with failed rows" failed_rows
case $program in
*/release/*) check "CSV of the decks in inputs/" inputs ;;
*) skip "CSV of the decks in inputs/" "their tables are those of the release build" ;;
esac
check "CSV no longer requested is removed" no_longer
check "the same CSV for any number of threads" threads
check "CSV alone" alone
check "CSV alone, of variants and with failed rows" alone_of_variants
