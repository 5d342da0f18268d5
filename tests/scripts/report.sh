#!/bin/sh
# flexmech-report: pages are sound HTML without a network, with every figure and with the values of the tables; names that mean something
# in HTML; studies, failed rows, comma-separated tables; what is refused; the command installed.
. tests/scripts/functions.sh

case $program in
*/release/*) ;;
*) skip "flexmech-report" "it reads tables, which are the same in all builds"; exit ;;
esac

# report STATUS ARGUMENT...: what it says is kept as that of a run.
report() {
  wanted=$1
  shift
  timeout "$longest" plots/flexmech-report "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  found=$?
  [ $found -eq "$wanted" ] && return
  echo "flexmech-report $*: status $found, not $wanted; it said:"
  head -n 5 "$scratch/stderr"
  return 1
}

# sound PAGE FOLDER
sound() { python3 -B tests/support/report_pages.py "$@"; }

has() {
  grep -qF -e "$1" "$2" || { echo "${2##*/} has no '$1'"; return 1; }
}

# paged NAME STATUS: the page of a run is whole, and its folder has nothing else that was not there.
paged() {
  folder=$scratch/$1
  ls -A "$folder" >"$scratch/before"
  report "$2" "$folder" && [ "$(cat "$scratch/stdout")" = "$folder/report.html" ] || return 1
  ls -A "$folder" | grep -vx report.html | cmp - "$scratch/before" || return 1
  plots/flexmech-plot --format svg "$folder" >"$scratch/stdout" 2>&1
  sound "$folder/report.html" "$folder" && rm -r "$folder/figures"
}

# A four-bar, one that bends, laws, mixed units; a study whose variants fail, and one of a single table.
pages() {
  run 0 --quiet --out "$scratch" inputs/response.deck inputs/excavator.deck inputs/bending_quick_return.deck inputs/varied.deck &&
    run 1 --quiet --out "$scratch" inputs/study.deck || return 1
  for deck in response excavator bending_quick_return varied study; do
    paged $deck 0 && silent || return 1
  done
  has "9 failures" "$scratch/study/report.html" && has "12.7 mm too long" "$scratch/study/report.html" &&
    has "<h1>First mechanism of Ulker (2010) as it runs" "$scratch/response/report.html"
}

# What means something in HTML, in a link, to the shell.
odd_names() {
  name="it's a&b <i> \"q\" 100% #1 ?x=\$y ü"
  { echo "TITLE Größe <b>&amp; 'x' \"y\" </title> ω₂" && motion_deck "0 30 500 720"; } >"$scratch/$name.deck"
  run 0 --quiet --out "$scratch" "$scratch/$name.deck" || return 1
  paged "$name" 0 || return 1
  has "<h1>Größe &lt;b&gt;&amp;amp; &#x27;x&#x27; &quot;y&quot; &lt;/title&gt; ω₂</h1>" "$folder/report.html"
}

# Rows that failed are counted with their table.
failed_rows() {
  motion_deck "0 to 360 step 45" | sed 's/length=100/length=150/; s/length=279.4/length=130/' >"$scratch/short.deck"
  run 1 --quiet --out "$scratch" "$scratch/short.deck" || return 1
  paged short 0 && has " failed. All of it" "$scratch/short/report.html" && has 'class="failed"' "$scratch/short/report.html"
}

# Only comma-separated tables, and no gnuplot: pages without figures, which say why.
without_figures() {
  run 0 --quiet --format csv-only --out "$scratch/csv" inputs/varied.deck && report 1 "$scratch/csv/varied" &&
    says "comma-separated" && has "comma-separated" "$scratch/csv/varied/report.html" &&
    sound "$scratch/csv/varied/report.html" "$scratch/csv/varied" || return 1
  mkdir -p "$scratch/bin"
  for tool in sh awk grep sed dirname readlink env timeout head python3; do
    ln -sf "$(python3 -c 'import shutil, sys; print(sys.executable if sys.argv[1] == "python3" else shutil.which(sys.argv[1]))' $tool)" "$scratch/bin/$tool"
  done
  PATH=$scratch/bin report 1 "$scratch/varied" && says "gnuplot is not installed" &&
    has "gnuplot is not installed" "$scratch/varied/report.html" && sound "$scratch/varied/report.html" "$scratch/varied"
}

# A figure larger than allowed is a picture.
large_figures() {
  python3 -B -c 'import sys
sys.path.insert(0, "plots/report")
import figures
figures.LARGEST = 1000
[(_, picture)] = figures.Figures(sys.argv[1]).pictures
assert picture.startswith("<img ") and "data:image/png;base64,iVBOR" in picture, picture[:100]' "$scratch/varied"
}

# refused TEXT ARGUMENT...
refused() {
  text=$1
  shift
  report 2 "$@" && says "$text" && [ ! -s "$scratch/stdout" ] && absent "$scratch/varied/report.html"
}

wrong_commands() {
  rm -f "$scratch/varied/report.html"
  mkdir -p "$scratch/empty" "$scratch/gone" && cp "$scratch/varied/summary.json" "$scratch/gone" && echo mine >"$scratch/mine.html"
  refused "the folder with the tables of a deck is missing" && refused "option --formt not recognized" --formt "$scratch/varied" &&
    refused "no folder $scratch/nowhere" "$scratch/varied" "$scratch/nowhere" &&
    refused "varied.deck is a file: name the folder" inputs/varied.deck &&
    refused "is no output folder of flexmech" "$scratch/empty" && refused "has no tables" "$scratch/gone" &&
    refused "option -o requires argument" "$scratch/varied" -o && refused "is no name of a file" -o "$scratch/empty" "$scratch/varied" &&
    refused "no folder $scratch/nowhere" -o "$scratch/nowhere/page.html" "$scratch/varied" &&
    refused "-o takes one folder" -o "$scratch/page.html" "$scratch/varied" "$scratch/study" &&
    refused "mine.html is no page of flexmech-report" -o "$scratch/mine.html" "$scratch/varied" &&
    refused "frequencies.dat is no page of flexmech-report" -o "$scratch/varied/frequencies.dat" "$scratch/varied" || return 1
  [ "$(cat "$scratch/mine.html")" = mine ] || return 1
  cp "$scratch/mine.html" "$scratch/varied/report.html"
  report 2 "$scratch/varied" && says "report.html is no page of flexmech-report" && rm "$scratch/varied/report.html"
}

# Elsewhere links lead from there; an earlier page is replaced.
elsewhere() {
  mkdir -p "$scratch/pages"
  for _ in first again; do
    report 0 -o "$scratch/pages/my page.html" "$scratch/varied" && absent "$scratch/varied/report.html" || return 1
  done
  has 'href="../varied/frequencies.dat"' "$scratch/pages/my page.html" && [ "$(ls -A "$scratch/pages")" = "my page.html" ]
}

shown() {
  printf '#!/bin/sh\nprintf "%%s\\n" "$1" >"%s/shown"\n' "$scratch" >"$scratch/browser" && chmod +x "$scratch/browser"
  BROWSER=$scratch/browser report 0 --open "$scratch/varied" && [ "$(cat "$scratch/shown")" = "file://$(realpath "$scratch/varied")/report.html" ] ||
    { cat "$scratch/shown"; return 1; }
}

installed() {
  make --no-print-directory -s install PREFIX="$scratch/prefix" >"$scratch/stdout" 2>&1 || { cat "$scratch/stdout"; return 1; }
  ln -sf prefix/bin/flexmech-report "$scratch/link"
  [ "$("$scratch/link" --version)" = "flexmech-report $("$program" --version | sed 's/flexmech //')" ] || return 1
  (cd "$scratch" && ./link varied) >"$scratch/stdout" 2>"$scratch/stderr" && silent && grep -q "<svg" "$scratch/varied/report.html" || return 1
  [ -z "$(find "$scratch/prefix" -name '__pycache__')" ] || { echo "Python left compiled files"; return 1; }
  cp "$scratch/prefix/bin/flexmech-report" "$scratch/alone"
  "$scratch/alone" "$scratch/varied" 2>"$scratch/stderr"
  [ $? -eq 1 ] && says "make install" && grep -q 'FLEXMECH-REPORT 1' "$scratch/prefix/share/man/man1/flexmech-report.1" &&
    grep -q '^complete -F _flexmech_report flexmech-report' "$scratch/prefix/share/bash-completion/completions/flexmech-report"
}

# The check sees what it is for.
seen() {
  for fault in 's/<\/h1>//' 's/href="[^"#]*dat"/href="gone.dat"/' 's/ id="table1"//' 's/href="#f1-[^"]*"/&/; s/ id="f1-gpPt5"/ id="f1-gpPt6"/' \
    's/<td>4[0-9]*\./<td>5./' 's/Figure 1: /Figure 1: my_/' 's/<svg/<img src="http:\/\/a.b\/c.png"><svg/'; do
    sed "$fault; s/ id='f1-gpPt5'/ id='f1-gpPt6'/" "$scratch/varied/report.html" >"$scratch/varied/wrong.html"
    sound "$scratch/varied/wrong.html" "$scratch/varied" >"$scratch/stdout" && { echo "it sees no fault by $fault"; return 1; }
  done
  return 0
}

check "pages of several decks" pages
check "names that mean something" odd_names
check "pages of failed rows" failed_rows
check "pages without figures" without_figures
check "large figures of a page" large_figures
check "wrong commands of flexmech-report" wrong_commands
check "a page elsewhere" elsewhere
check "a page in the browser" shown
check "flexmech-report installed" installed
check "faults of pages are seen" seen
