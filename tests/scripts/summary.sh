#!/bin/sh
# summary.json and --json: warnings, failures and tables for other programs.
. tests/scripts/functions.sh

out=$scratch/out

# tells FILE EXPRESSION: what python3 finds true of the document d
tells() {
  python3 -B - "$1" "$2" <<'END_OF_PYTHON'
import json, sys

def no_constant(text):
    raise ValueError(text + " is no JSON")

with open(sys.argv[1], encoding="utf-8") as file:
    d = json.load(file, parse_constant=no_constant)
if not eval("(" + sys.argv[2] + ")"):
    print("not", sys.argv[2], "of", str(d)[:1000])
    sys.exit(1)
END_OF_PYTHON
}

# The tables as the summary tells them are the tables as they are.
true_summary() {
  python3 -B - "$1" <<'END_OF_PYTHON'
import glob, json, os, sys

folder = sys.argv[1]
with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
    summary = json.load(file)
assert list(summary) == ["program", "version", "deck", "exit_status", "counts", "warnings", "failures", "more_failures", "tables"], list(summary)
assert summary["program"] == "flexmech" and summary["deck"] == os.path.basename(folder)
files = sorted(table["file"] for table in summary["tables"])
assert files == sorted(os.path.basename(path) for path in glob.glob(os.path.join(folder, "*.dat"))), files
total = failed_total = 0
for table in summary["tables"]:
    with open(os.path.join(folder, table["file"]), encoding="utf-8") as file:
        lines = file.read().splitlines()
    rows = sum(1 for line in lines if line and not line.startswith("#"))
    failed = sum(1 for line in lines if line.startswith("# failed "))
    assert (table["rows"], table["failed_rows"]) == (rows, failed), table["file"]
    # The head; remarks of later variants stand behind it.
    first = next((i for i, line in enumerate(lines) if not line.startswith("#") or line.startswith("# failed ")), len(lines))
    names, units = (line[1:].split() for line in lines[first - 2:first])
    assert [column["name"] for column in table["columns"]] == names, table["file"]
    assert [column["unit"] or "-" for column in table["columns"]] == units, table["file"]
    total += rows
    failed_total += failed
counts = summary["counts"]
assert (counts["rows"], counts["failed_rows"], counts["failures"]) == (total, failed_total, len(summary["failures"]) + summary["more_failures"]), counts
END_OF_PYTHON
}

inputs() {
  # Those that take seconds take minutes in the debug build, whose goldens they are, too.
  case $program in
  */release/*) decks=$(ls inputs/*.deck) ;;
  *) decks=$(quick_inputs) ;;
  esac
  "$program" --quiet --out "$out" $decks 2>/dev/null
  for deck in $decks; do
    true_summary "$out/$(basename "$deck" .deck)" || return 1
  done
}

parallelogram() {
  { motion_deck "0 90 180 $1" | sed 's/279.4/254/; s/266.7/100/; s/^LINK .*/& mass=1 inertia=1/; s/^REPORT .*/REPORT reactions/'; echo "SPEED 1 2"; } >"$scratch/par.deck"
}

failures() {
  parallelogram
  run 1 --out "$out" "$scratch/par.deck" && true_summary "$out/par" && tells "$out/par/summary.json" \
    'd["exit_status"] == 1 and d["counts"]["positions"] == 3 and d["counts"]["speeds"] == 2 and d["counts"]["modes"] == 0 and
     [(f["stage"], f["speed"], f["crank"]) for f in d["failures"]] == [("position", None, 0), ("position", None, 180)] and
     d["failures"][0]["reason"].startswith("change point")'
}

# Of the deck with its place, of the run without.
warnings() {
  beam_deck "CRANK 0 to 350 step 10" "SPEED 0 40" "REPORT frequencies" "PINMASS o4 1kg" >"$scratch/warned.deck"
  run 0 --quiet --json --out "$out" "$scratch/warned.deck" || return 1
  tells "$out/warned/summary.json" 'd["exit_status"] == 0 and d["failures"] == [] and len(d["warnings"]) == 2 and
    [d["warnings"][0][k] for k in ("file", "line", "column", "length")] == ["warned.deck", 15, 9, 2] and
    "no effect" in d["warnings"][0]["message"] and d["warnings"][1]["line"] is None and
    d["warnings"][1]["message"].startswith("the inertia loads at speed 40 rad/s, crank 10 deg deflect")' || return 1
  tells "$scratch/stdout" "d['decks'][0]['warnings'][0]['file'] == '$scratch/warned.deck' and len(d['decks'][0]['warnings']) == 2"
}

# No path and no time: the same deck in another folder gives the same bytes.
same_bytes() {
  mkdir -p "$scratch/elsewhere" && beam_deck "CRANK 0 to 350 step 10" "SPEED 0 40" "REPORT frequencies" >"$scratch/bytes.deck" &&
    cp "$scratch/bytes.deck" "$scratch/elsewhere/" && run 0 --quiet --out "$out" "$scratch/bytes.deck" &&
    run 0 --quiet --threads 3 --out "$out/b" "$scratch/elsewhere/bytes.deck" &&
    cmp "$out/bytes/summary.json" "$out/b/bytes/summary.json"
}

# All decks in one document: refused ones with their errors, a sound one that was not run.
refused() {
  motion_deck >"$scratch/good.deck"
  { motion_deck "0 to 360"; printf 'MATERIAL st\303\251"\\\377 E=1 density=1\nGROUND O2 1 1\n'; } >"$scratch/bad.deck"
  printf 'UNITS mm\001\n' >"$scratch/binary.deck"
  run 2 --json --out "$out/refused" "$scratch/bad.deck" "$scratch/good.deck" "$scratch/binary.deck" "$scratch/absent.deck" &&
    says "bad.deck:8:12: error:" && absent "$out/refused" || return 1
  tells "$scratch/stdout" 'd["exit_status"] == 2 and d["errors"] == [] and [deck["exit_status"] for deck in d["decks"]] == [2, None, 2, 2] and
    (8, 12) in [(e["line"], e["column"]) for e in d["decks"][0]["errors"]] and
    any("st\u00c3\u00a9\"\\\u00ff" in e["message"] for e in d["decks"][0]["errors"]) and
    any(e["second_place"] and e["second_place"]["line"] == 2 and e["second_place"]["column"] == 10 for e in d["decks"][0]["errors"]) and
    d["decks"][1]["errors"] == [] and [(e["line"], e["column"]) for e in d["decks"][2]["errors"]] == [(1, 9)] and
    [(e["line"], e["message"]) for e in d["decks"][3]["errors"]] == [(None, "no such file")]' || return 1
  tells "$scratch/stdout" "d['decks'][3]['deck'] == '$scratch/absent.deck' == d['decks'][3]['errors'][0]['file']"
}

run_decks() {
  parallelogram
  run 1 --json --out "$out" "$scratch/par.deck" "$scratch/good.deck" && tells "$scratch/stdout" \
    'd["exit_status"] == 1 and [deck["exit_status"] for deck in d["decks"]] == [1, 0] and len(d["decks"][0]["failures"]) == 2'
}

only_checked() {
  run 0 --json --check "$scratch/good.deck" && tells "$scratch/stdout" 'd["decks"][0]["exit_status"] == 0'
}

# Standard output is the document and nothing else, or nothing at all.
no_json() {
  run 0 --quiet --out "$out" "$scratch/good.deck" && [ ! -s "$scratch/stdout" ] || { echo "there is something on standard output"; return 1; }
}

bad_command_line() {
  run 2 --nonsense --json "$scratch/good.deck" && says "unknown option '--nonsense'" && tells "$scratch/stdout" \
    'd["exit_status"] == 2 and d["decks"] == [] and "--nonsense" in d["errors"][0]["message"]' &&
    run 2 --nonsense "$scratch/good.deck" && [ ! -s "$scratch/stdout" ]
}

no_folder() {
  run 2 --json --out "$scratch/good.deck" "$scratch/good.deck" && tells "$scratch/stdout" \
    'd["decks"][0]["exit_status"] == 2 and "this folder cannot be created" in d["decks"][0]["errors"][0]["message"]' &&
    run 2 --json --out "$out" "$scratch/good.deck" "$scratch/good.deck" && tells "$scratch/stdout" \
    '[deck["exit_status"] for deck in d["decks"]] == [None, 2] and "the same folder" in d["decks"][1]["errors"][0]["message"]'
}

check "summary.json of every deck in inputs/" inputs
check "failures in summary.json" failures
check "warnings in summary.json" warnings
check "the same summary for any folder and number of threads" same_bytes
check "--json of refused decks" refused
check "--json of decks that are run" run_decks
check "--json with --check" only_checked
check "nothing on standard output with --quiet" no_json
check "--json and a bad command line" bad_command_line
check "--json and a folder that cannot be created" no_folder
