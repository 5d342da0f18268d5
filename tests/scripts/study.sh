#!/bin/sh
# REPORT summary: a row a variant, found once more from the full tables; and columns= of other reports.
. tests/scripts/functions.sh

out=$scratch/out

# recomputed FOLDER: every value of summary.dat and summary.csv from the tables beside them.
recomputed() {
  python3 -B - "$1" <<'END_OF_PYTHON'
import csv, math, os, re, sys

folder = sys.argv[1]


def plain(name):
    """Names of columns, rows of texts, and failed rows as (place, reason)."""
    with open(os.path.join(folder, name + ".dat"), encoding="utf-8") as file:
        lines = [line.rstrip("\n") for line in file]
    head = [line for line in lines if line.startswith("#") and not line.startswith("# failed")]
    end = max(i for i, line in enumerate(lines) if line.startswith("#   ") and not line.startswith("# failed"))
    names = lines[end - 1][1:].split()
    assert head, name
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    assert all(len(row) == len(names) for row in rows), name
    failed = []
    for line in lines:
        match = re.match(r"# failed(.*?) : (.*)", line)
        if match:
            failed.append((dict(word.split("=") for word in match[1].split()), match[2]))
    return names, [dict(zip(names, row)) for row in rows], failed


names, rows, failed = plain("summary")
parameters = names[:names.index("rows")]
places = [name[len(names[names.index("failed") + 1]) + 1:] for name in names
          if name.startswith(names[names.index("failed") + 1] + "_")]
quantities = [name[:-len("_mean")] for name in names if name.endswith("_mean")]
assert quantities and places
with open(os.path.join(folder, "summary.csv"), encoding="utf-8", newline="") as file:
    records = list(csv.reader(file, strict=True))
assert [field.split(" [")[0] for field in records[0]] == names + ["failure"]
assert all(len(record) == len(names) + 1 for record in records), "a record is too short or too long"
assert [dict(zip(names, record)) for record in records[1:] if not record[-1]] == rows, "CSV has other numbers"
assert [(record[:len(parameters)], record[-1]) for record in records[1:] if record[-1]] and failed or \
    not failed and not any(record[-1] for record in records[1:]), "CSV has other failures"
four_bar = os.path.exists(os.path.join(folder, "kinematics.dat")) and "theta3" in plain("kinematics")[0]


def size(*columns):
    return lambda group: math.hypot(*(float(group[0][column]) for column in columns))


def one(column):
    return lambda group: float(group[0][column])


def drive(group):
    return float(group[0]["force"])


def recipe(quantity):
    """The table of a quantity, its value from the rows of a place, and its error."""
    if re.fullmatch(r"(f|zeta)\d+", quantity):
        return "frequencies", one(quantity), lambda group: float(group[0]["error" + re.sub(r"\D", "", quantity)])
    worst = lambda group: max(float(row["error"]) for row in group)
    rigid = {"torque": ("reactions", one("torque")), "shaking_force": ("reactions", size("shaking_x", "shaking_y")),
             "shaking_moment": ("reactions", one("shaking_moment"))}
    if not four_bar:
        rigid = {"torque": ("drives", drive), "shaking_force": ("shaking", size("shaking_x", "shaking_y")),
                 "shaking_moment": ("shaking", one("shaking_moment"))}
    if quantity in rigid:
        return *rigid[quantity], None
    return {
        "frame_force": ("frame", size("frame_x", "frame_y"), None),
        "bearing_force": ("bearings", lambda group: max(math.hypot(float(row["fx"]), float(row["fy"])) for row in group), None),
        "transmission_angle": ("kinematics", one("transmission_angle"), None),
        "strain": ("strains", lambda group: max(abs(float(row["axial_strain"]) + float(row["bending_strain"])) for row in group), worst),
        "stress": ("strains", lambda group: max(float(row["stress"]) for row in group), worst),
        "displacement": ("response", lambda group: max(math.hypot(float(row["ux"]), float(row["uy"])) for row in group), worst),
        "elastic_torque": ("torque", one("total"), worst),
    }[quantity]


def near(a, b, scale):
    return abs(a - b) <= 1e-12 * max(scale, abs(b))


seen = 0
kept = {}
for quantity in quantities:
    table, value, error = recipe(quantity)
    columns, found, failures = plain(table)
    # By variant: place, in the order of the table, with its rows.
    variants = {}
    for row in found:
        group = variants.setdefault(tuple(row[name] for name in parameters), {})
        group.setdefault(tuple(row[name] for name in places), []).append(row)
    kept[quantity] = (variants, failures)
    for line in rows:
        group = variants[tuple(line[name] for name in parameters)]
        values = {place: value(several) for place, several in group.items()}
        scale = max(map(abs, values.values()))
        for end, choose in (("least", min), ("greatest", max)):
            told = float(line[f"{quantity}_{end}"])
            assert near(told, choose(values.values()), scale), f"{quantity}_{end} {told} {choose(values.values())}"
            at = tuple(line[f"{quantity}_{end}_{name}"] for name in places)
            assert at in values, f"{quantity}_{end} is at {at}, which is no place"
            assert near(values[at], told, scale), f"{quantity}_{end} is not at {at}"
            earlier = list(values)[:list(values).index(at)]
            assert all(abs(values[place] - told) > 0 for place in earlier) or table != "frequencies", "not the first place"
            seen += 1
        assert near(float(line[f"{quantity}_mean"]), math.fsum(values.values()) / len(values), scale), f"{quantity}_mean"
        if error:
            assert float(line[f"{quantity}_error"]) == max(map(error, group.values())), f"{quantity}_error"
        else:
            assert f"{quantity}_error" not in names
        # With one quantity its rows are those of its table.
        if len(quantities) == 1:
            assert int(line["rows"]) == len(values), "rows"
            mine = [one for one, _ in failures if all(float(one[name]) == float(line[name]) for name in parameters)]
            assert int(line["failed"]) == len(mine), f"failed: {line['failed']}, not {len(mine)}"
assert seen == 2 * len(quantities) * len(rows)
print(seen, "values")
END_OF_PYTHON
}

# study STATUS NAME: runs a deck of standard input, and finds its summary once more.
study() {
  cat >"$scratch/$2.deck"
  run "$1" --quiet --out "$out" --format csv "$scratch/$2.deck" && recomputed "$out/$2"
}

four_bar() {
  cat <<'END_OF_DECK'
UNITS    mm tonne s
MATERIAL steel E=200GPa density=7800kg/m3
SECTION  strip rectangle thickness=$t width=25.4
GROUND   O2 0 0
GROUND   O4 254 0
LINK     crank    O2 A length=100   material=steel section=strip
LINK     coupler  A  B length=$L    material=steel section=strip
LINK     follower O4 B length=266.7 material=steel section=strip
DRIVE    crank
CRANK    0 to 330 step 30
INERTIA  distributed
END_OF_DECK
}
full='REPORT frequencies
REPORT reactions
REPORT frame
REPORT bearings'
elastic='REPORT strains accuracy=1e-4
REPORT response accuracy=1e-4
REPORT torque accuracy=1e-4'

of_four_bars() {
  { four_bar; echo "$full"; echo "$elastic"; cat <<'END_OF_CARDS'; } | study 0 four_bar
VARY     L 250mm to 290mm step 20mm
VARY     t 1.6mm 3mm
SPEED    100 200 rpm
DAMPING  * ratio=0.02
REPORT   kinematics
REPORT   summary of=f1,f3,torque,shaking_force,shaking_moment,frame_force,bearing_force,transmission_angle,strain,stress,displacement,elastic_torque accuracy=1e-4
END_OF_CARDS
}
check "least, mean and greatest of a four-bar" of_four_bars

# Springs and dampers, a slider that hangs on them, speeds in rpm.
of_others() {
  sed -e '/^ *REPORT/d' -e '/^END/d' -e 's/^SPEED.*/SPEED 150 200 rpm/' -e 's/step 5/step 45/' inputs/damped_engine.deck |
    { cat; echo "$full"; echo "$elastic"; cat <<'END_OF_CARDS'; } | study 0 damped
REPORT   drives
REPORT   summary of=f1,f2,zeta1,zeta2,torque,shaking_force,shaking_moment,frame_force,bearing_force,strain,stress,displacement,elastic_torque accuracy=1e-4
END_OF_CARDS
}
check "least, mean and greatest of a slider-crank with dampers" of_others

# A drive with a law: the place of a value has its time.
of_a_law() {
  sed -e '/^ *REPORT/d' -e '/^END/d' inputs/indexing.deck | { cat; cat <<'END_OF_CARDS'; } | study 0 law || return 1
REPORT   drives
REPORT   bearings
REPORT   frame
REPORT   summary of=torque,shaking_force,shaking_moment,bearing_force,frame_force
END_OF_CARDS
  grep -q '^#.* torque_least_time  *torque_least_speed  *torque_least_crank ' "$out/law/summary.dat" || { echo "no time"; return 1; }
}
check "a summary over time" of_a_law

# A ram turns an arm: its positions and speeds are lengths, and what drives it is a force.
ram() {
  cat <<'END_OF_DECK'
UNITS    mm kg s force=N
GROUND   O 0 0
GROUND   Q 120 0
LINK     arm O A C lengths=80,$L turns=0 mass=2 inertia=6000kg*mm2 rigid
LINK     ram Q A mass=1 inertia=2000kg*mm2
PIN      A 0 80
PIN      C 0 200
DRIVE    ram length
CRANK    90 to 150 step 10
SPEED    -20 30
GRAVITY  0 -9810
VARY     L 100 140
END_OF_DECK
}
of_lengths() {
  { ram; cat <<'END_OF_CARDS'; } | study 0 ram || return 1
REPORT   drives
REPORT   bearings
REPORT   summary of=torque,shaking_force,bearing_force
END_OF_CARDS
  python3 -B - "$out/ram/summary.json" <<'END_OF_PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    table, = [one for one in json.load(file)["tables"] if one["file"] == "summary.dat"]
units = {column["name"]: column["unit"] for column in table["columns"]}
wanted = {"L": None, "rows": None, "failed": None, "torque_least": "N", "torque_least_crank": "mm", "torque_least_speed": "mm/s", "torque_mean": "N"}
assert {name: units[name] for name in wanted} == wanted, units
assert table["rows"] == 2 and table["failed_rows"] == 0
END_OF_PYTHON
}
check "a summary of a ram in its units" of_lengths

# Positions out of reach are in no mean, but are counted, and the exit status is 1; a variant that closes nowhere is a failed row.
out_of_reach() {
  { four_bar; cat <<'END_OF_CARDS'; } | study 1 reach || return 1
SET      t 1.6mm
VARY     L 3mm 100mm 279.4mm 700mm
REPORT   frequencies
REPORT   summary of=f2
END_OF_CARDS
  # Of 700 mm the linkage is open, of 3 mm it closes between the positions.
  for length in 3 700; do
    grep -q "^# failed L=$length : " "$out/reach/summary.dat" || { echo "no failed row of $length"; return 1; }
  done
  [ "$(grep -c '^ ' "$out/reach/summary.dat")" -eq 2 ] || { echo "not two rows"; return 1; }
  awk '/^ / && $3 > 0 { n++ } END { exit n != 1 }' "$out/reach/summary.dat" || { echo "failed positions are not counted"; return 1; }
}
check "positions that failed are counted and in no mean" out_of_reach

# Without VARY and with nothing to tell, the failed row has no place; its CSV record has as many fields as the others.
nothing() {
  cat >"$scratch/nothing.deck" <<'END_OF_DECK'
UNITS    mm kg s
GROUND   O2 0 0
GROUND   O4 100 0
LINK     a O2 A length=50  mass=1 inertia=100kg*mm2
LINK     b A  B length=100 mass=1 inertia=100kg*mm2
LINK     c O4 B length=50  mass=1 inertia=100kg*mm2
DRIVE    a
CRANK    0 180
SPEED    2
REPORT   summary of=torque
END_OF_DECK
  run 1 --quiet --out "$out" --format csv "$scratch/nothing.deck" || return 1
  grep -q '^# failed : change point' "$out/nothing/summary.dat" || { echo "no failed row"; return 1; }
  python3 -B -c 'import csv, sys; rows = list(csv.reader(open(sys.argv[1], newline=""))); assert len(rows) == 2 and len(rows[0]) == len(rows[1]) and rows[1][-1].startswith("change point") and not any(rows[1][:-1]), rows' \
    "$out/nothing/summary.csv"
}
check "a deck without a row has a failed one" nothing

# Nothing else is written, and no more is computed than the quantities need.
alone() {
  { four_bar; cat <<'END_OF_CARDS'; } >"$scratch/alone.deck"
SET      t 1.6mm
VARY     L 250mm to 290mm step 10mm
SPEED    10
REPORT   summary of=torque
END_OF_CARDS
  run 0 --out "$out" --stats "$scratch/alone.deck" || return 1
  [ "$(cd "$out/alone" && echo *)" = 'echo.deck run.log summary.dat summary.json' ] || { echo "files: $(ls "$out/alone")"; return 1; }
  ! says "frequenc" || { echo "frequencies were computed"; return 1; }
  # One row directly below the other: variants are no blocks here.
  [ "$(grep -c '^ ' "$out/alone/summary.dat")" -eq 5 ] && ! grep -q '^$' "$out/alone/summary.dat" || { echo "rows are not together"; return 1; }
}
check "a summary alone writes no other table" alone

# echo.deck is a deck, threads and --resume do not show, and summaries of variants are those of the variants alone.
same() {
  run 0 --quiet --out "$scratch/again" "$out/four_bar/echo.deck" &&
    cmp "$out/four_bar/summary.dat" "$scratch/again/echo/summary.dat" &&
    run 0 --quiet --threads 3 --out "$scratch/threads" "$scratch/four_bar.deck" &&
    cmp "$out/four_bar/summary.dat" "$scratch/threads/four_bar/summary.dat" &&
    run 0 --quiet --out "$scratch/single" --set L=270mm --set t=3mm "$scratch/four_bar.deck" || return 1
  awk '/^ / { for (i = names; i <= NF; i++) printf "%s ", $i; print "" }' names=1 "$scratch/single/four_bar/summary.dat" >"$scratch/one"
  awk '/^ / && $1 == 270 && $2 == 3 { for (i = 3; i <= NF; i++) printf "%s ", $i; print "" }' "$out/four_bar/summary.dat" >"$scratch/other"
  [ -s "$scratch/one" ] && cmp "$scratch/one" "$scratch/other"
}
check "the same summary from the echo, on threads, and of a single variant" same

# columns REPORTS NAME: runs a deck of two variants, of which one does not reach all positions.
columns() {
  { four_bar; echo "$1"; } | sed -e 's/\$t/1.6/' >"$scratch/$2.deck"
  cat >>"$scratch/$2.deck" <<'END_OF_CARDS'
VARY     L 100mm 279.4mm
SPEED    10 20
END_OF_CARDS
  run 1 --quiet --out "$out" --format csv "$scratch/$2.deck"
}
few() {
  columns 'REPORT frequencies
REPORT kinematics
REPORT reactions
REPORT bearings
REPORT pins' all || return 1
  columns 'REPORT frequencies columns=f3,ERROR1,f1
REPORT kinematics columns=transmission_angle,crank
REPORT reactions columns=torque,O2x
REPORT bearings columns=magnitude
REPORT pins columns=y' few || return 1
  python3 -B - "$out/all" "$out/few" <<'END_OF_PYTHON'
import csv, json, os, re, sys

wanted = {"frequencies": "L speed crank f3 error1 f1", "kinematics": "L speed crank transmission_angle", "reactions": "L speed crank torque O2x",
          "bearings": "L speed crank pin link magnitude", "pins": "L speed crank pin y"}


def table(folder, name):
    with open(os.path.join(folder, name + ".dat"), encoding="utf-8") as file:
        lines = file.read().split("\n")
    end = max(i for i, line in enumerate(lines) if line.startswith("#   ") and not line.startswith("# failed"))
    names, units = lines[end - 1][1:].split(), lines[end][1:].split()
    assert len(names) == len(units)
    body = [line if not line or line.startswith("#") else dict(zip(names, line.split())) for line in lines[end + 1:]]
    return names, dict(zip(names, units)), body


with open(os.path.join(sys.argv[2], "summary.json"), encoding="utf-8") as file:
    listed = {entry["file"]: [column["name"] for column in entry["columns"]] for entry in json.load(file)["tables"]}
for name, columns in wanted.items():
    columns = columns.split()
    all_names, all_units, full = table(sys.argv[1], name)
    names, units, body = table(sys.argv[2], name)
    assert names == columns == listed[name + ".dat"], f"{name}: {names}"
    assert units == {column: all_units[column] for column in columns}, name
    picked = [line if isinstance(line, str) else {column: line[column] for column in columns} for line in full]
    assert picked == body, f"{name} has other rows"
    assert any(isinstance(line, str) and line.startswith("# failed") for line in body), "a failed row is to be there"
    with open(os.path.join(sys.argv[2], name + ".csv"), encoding="utf-8", newline="") as file:
        records = list(csv.reader(file, strict=True))
    assert [field.split(" [")[0] for field in records[0]] == columns + ["failure"]
    assert all(len(record) == len(columns) + 1 for record in records), name
    assert [dict(zip(columns, record)) for record in records[1:] if not record[-1]] == [line for line in body if not isinstance(line, str)]
END_OF_PYTHON
}
check "columns that are asked for, in plain and CSV" few

# Figures of a study against each parameter; of tables without columns that a figure draws it is told which.
drawn() {
  FLEXMECH=$program sh plots/draw_figures.sh --format svg "$1" >"$scratch/drawn" 2>"$scratch/stderr" || { cat "$scratch/stderr"; return 1; }
}
figures() {
  drawn "$out/four_bar" || return 1
  for name in L t; do
    grep -q "/figures/summary_by_$name.svg$" "$scratch/drawn" && grep -q "/figures/frequencies_by_$name.svg$" "$scratch/drawn" || { echo "no figure of $name"; return 1; }
    # A panel for f1 and f3, ten others; long titles are in two lines.
    tr '\n' ' ' <"$out/four_bar/figures/summary_by_$name.svg" | sed 's/<[^>]*>/ /g; s/[[:blank:]][[:blank:]]*/ /g' >"$scratch/words"
    for title in 'natural frequency [' 'torque [' 'transmission angle [' 'elastic torque ['; do
      grep -qF " $title" "$scratch/words" || { echo "no panel of $title"; return 1; }
    done
  done
  # Another parameter than the one that varies is that of the first row.
  grep -q 't = 1.6 mm' "$out/four_bar/figures/summary_by_L.svg" || { echo "the thickness is not told"; return 1; }
}
lacking() {
  { four_bar; cat <<'END_OF_CARDS'; } | sed -e 's/\$t/1.6/' -e 's/\$L/279.4/' >"$scratch/lacking.deck"
REPORT frequencies columns=f1,f3
REPORT kinematics columns=transmission_angle,theta3,theta4
REPORT reactions columns=torque
REPORT pins columns=x,y
SPEED 10
END_OF_CARDS
  run 0 --quiet --out "$out" "$scratch/lacking.deck" && drawn "$out/lacking" || return 1
  says "pin_motion is not drawn: $out/lacking/pins.dat has no column vx vy ax ay (columns= of its REPORT card)" || return 1
  says "reactions is not drawn" && says "kinematics_velocities is not drawn" && says "shaking_force is not drawn" || return 1
  grep -q '/kinematics_angles.svg$' "$scratch/drawn" && grep -q '/frequencies.svg$' "$scratch/drawn" || { echo "figures are missing"; return 1; }
  grep -q '>mode 3<' "$out/lacking/figures/frequencies.svg" && ! grep -q '>mode 2<' "$out/lacking/figures/frequencies.svg" || { echo "other modes are drawn"; return 1; }
}
if command -v gnuplot >/dev/null; then
  check "figures of a study" figures
  check "figures that lack columns are left out with a word" lacking
else
  skip "figures of a study" "there is no gnuplot"
fi
