#!/bin/sh
# The lines of docs/running.md by which pandas reads a plain table. Without pandas, a stand-in reads the rows.
. tests/scripts/functions.sh

out=$scratch/out

# read_all FOLDER: every plain table, against the columns and the numbers of rows of the summary.
read_all() {
  python3 -B - "$1" <<'END_OF_PYTHON'
import json, os, re, sys, types

try:
    import pandas
except ImportError:
    def read_csv(path, sep, comment, names):
        assert sep == r"\s+"
        rows = [line.split(comment)[0].split() for line in open(path, encoding="utf-8")]
        rows = [row for row in rows if row]
        assert all(len(row) == len(names) for row in rows), path
        return {name: [row[i] for row in rows] for i, name in enumerate(names)}
    pandas = types.ModuleType("pandas")
    pandas.read_csv = read_csv
    sys.modules["pandas"] = pandas

with open("docs/running.md", encoding="utf-8") as document:
    text = document.read()
recipe, = re.findall(r"(?:^    .*\n)*^    table = pandas\.read_csv.*\n", text, re.MULTILINE)
recipe = "\n".join(line[4:] for line in recipe.splitlines() if not line.startswith("    path ="))
assert "head =" in recipe, recipe

with open(os.path.join(sys.argv[1], "summary.json"), encoding="utf-8") as file:
    tables = json.load(file)["tables"]
for entry in tables:
    found = {"path": os.path.join(sys.argv[1], entry["file"])}
    exec(recipe, found)
    table = found["table"]
    names = [column["name"] for column in entry["columns"]]
    assert list(table.keys()) == names, f"{entry['file']}: {list(table.keys())}"
    assert len(table[names[0]]) == entry["rows"], f"{entry['file']}: {len(table[names[0]])} rows, not {entry['rows']}"
    if entry["rows"] and names[0] == "speed":
        assert float(list(table["speed"])[-1]) == 10, entry["file"]
END_OF_PYTHON
}

# The first rows of a parallelogram fail: they stand right below the head.
beam_deck "TITLE failed at first" "CRANK 0 30 180 200" "SPEED 0 10" "REPORT kinematics" "REPORT frequencies" \
  "REPORT shapes points=3" "REPORT branches" "REPORT reactions" "REPORT balance" "REPORT linkage" "REPORT mesh" |
  sed 's/279.4/254/; s/266.7/100/' >"$scratch/failed.deck"
failed() {
  run 1 --quiet --out "$out" "$scratch/failed.deck" && read_all "$out/failed"
}
check "pandas reads tables whose first rows failed" failed

# Later variants have remarks of their own between their rows.
variants() {
  beam_deck "VARY a_parameter_with_a_long_name 1 2 3" "POINT p coupler along=\$a_parameter_with_a_long_name" "CRANK 0 90" \
    "REPORT points" "REPORT frequencies" >"$scratch/variants.deck"
  run 0 --quiet --out "$out" "$scratch/variants.deck" && grep -q '^[^#]' "$out/variants/points.dat" && read_all "$out/variants"
}
check "pandas reads tables of variants" variants

inputs() {
  "$program" --quiet --out "$out" inputs/rigid.deck || return 1
  read_all "$out/rigid"
}
check "pandas reads every kind of table of a rigid machine" inputs
