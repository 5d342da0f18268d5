"""Of pages by flexmech-report: that they are sound HTML and complete.

    report_pages.py PAGE FOLDER     complains of tags that are not closed, ids that are not unique, links that lead nowhere or into the
                                    network, figures that flexmech-plot draws and the page lacks, values that are not those of the tables
    report_pages.py browse PAGE... WIDTH    of what a browser makes of them at this width: what sticks out of the page or of its figure,
                                    and blocks that overlap
"""

import html
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import urllib.parse
from html.parser import HTMLParser
from pathlib import Path

VOID = {"meta", "img", "br", "link", "input", "hr"}


class Page(HTMLParser):
    """Its faults; texts of headings, captions and cells of tables, in their order."""

    def __init__(self, text):
        super().__init__()
        self.faults, self.open, self.ids, self.links = [], [], [], []
        self.texts, self.cells = {"h1": [], "h3": [], "figcaption": []}, {}
        self.feed(text)
        self.close()
        self.faults += [f"<{tag}> is not closed" for tag in self.open]

    def handle_startendtag(self, tag, attrs):
        self.take(tag, dict(attrs))

    def handle_starttag(self, tag, attrs):
        self.take(tag, dict(attrs))
        if tag not in VOID:
            self.open.append(tag)
        if tag in self.texts:
            self.texts[tag].append("")
        if tag == "tr":
            self.cells.setdefault(self.texts["h3"][-1] if self.texts["h3"] else "", []).append([])
        if tag in ("td", "th"):
            self.row().append([""])

    def row(self):
        return list(self.cells.values())[-1][-1]

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes nothing, line {self.getpos()[0]}")

    def handle_data(self, data):
        if self.open and self.open[-1] in self.texts:
            self.texts[self.open[-1]][-1] += data
        elif self.open and self.open[-1] in ("td", "th"):
            self.row()[-1][0] += data
        elif self.open and self.open[-1] == "small" and self.open[-2] in ("td", "th"):
            self.row()[-1].append(data)

    def take(self, tag, attrs):
        if tag in ("script", "link", "iframe") or any(name.startswith("on") for name in attrs):
            self.faults.append(f"a <{tag}> with a script, or of another file")
        if "id" in attrs:
            self.ids.append(attrs["id"])
        self.links += [attrs[name] for name in ("href", "xlink:href", "src") if name in attrs]
        self.links += ["#" + found for value in attrs.values() for found in re.findall(r"url\(['\"]?#([^'\")]*)", value or "")]


def rows_of(path):
    """Names and rows of a table, plain or comma-separated."""
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    if path.endswith(".csv"):
        rows = [line.split(",") for line in lines[1:] if line.endswith(",")]
        return [name.split(" [")[0] for name in lines[0].split(",")][:-1], [row[:-1] for row in rows]
    head = list(itertools.takewhile(lambda line: line.startswith("#") and not re.match("# *failed ", line), lines))
    return head[-2][1:].split(), [line.split() for line in lines if line.strip() and not line.startswith("#")]


def written(cell):
    return f"{float(cell):.6g}" if re.fullmatch(r"-?\d+(\.\d+)?(e[-+]\d+)?", cell) and re.search("[.e]", cell) else cell


def faults_of_table(path, cells):
    names, rows = rows_of(path)
    found = [[cell[0] for cell in line] for line in cells[1:]]
    if len(rows) <= 8 or "quantity" in names and "unit" in names:
        wanted = [[written(cell) for cell in row] for row in rows[:40]]
        if len(names) > 8:
            wanted = [[name] + [row[i] for row in wanted] for i, name in enumerate(names)]
        if rows and found != wanted:
            yield f"{found[:2]}, not {wanted[:2]}"
        return
    for line, name, column in zip(cells[1:], names, zip(*rows)):
        values = {cell: float(cell) for cell in column if re.fullmatch(r"-?\d+(\.\d+)?(e[-+]\d+)?", cell)}
        words = any(cell != "-" and cell not in values for cell in column)
        extremes = ["", ""] if words or len(set(column)) == 1 else [f"{value:.6g}" for value in (min(values.values()), max(values.values()))]
        wanted = [name, written(column[0]), written(column[-1])] + extremes
        if [cell[0] for cell in line] != wanted:
            yield f"{[cell[0] for cell in line]}, not {wanted}"
        for place, extreme in zip(line[3:], (min, max)):
            if len(place) > 1:
                shown = dict(part.split(" ", 1) for part in place[1].split(", "))
                there = [row for row in rows if all(written(row[names.index(key)]) == value for key, value in shown.items())]
                if not any(written(row[names.index(name)]) == f"{extreme(values.values()):.6g}" for row in there):
                    yield f"{name} is not {extreme(values.values()):.6g} at {place[1]}"


def faults_of(path, folder):
    text = Path(path).read_text(encoding="utf-8")
    page = Page(text)
    yield from page.faults
    yield from (f"the id {name} is there {page.ids.count(name)} times" for name in sorted(set(page.ids)) if page.ids.count(name) > 1)
    for link in page.links:
        if link.startswith("#"):
            if link[1:] not in page.ids:
                yield f"nothing has the id {link[1:]}"
        elif not link.startswith("data:image/png;base64,") and not os.path.isfile(
                os.path.join(os.path.dirname(path), urllib.parse.unquote(link))):
            yield f"the link {link} leads nowhere"
    if re.search(r"(?<!xmlns=\")(?<!xlink=\")https?:|@import|url\((?!['\"]?#)", text):
        yield "it needs the network"
    drawn = {figure.stem for figure in Path(folder, "figures").glob("*.svg")}
    captions = {re.sub(r"^Figure \d+: ", "", caption) for caption in page.texts["figcaption"]}
    if drawn != captions:
        yield f"figures {sorted(captions)}, not {sorted(drawn)}"
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    files = [table["file"] for table in summary["tables"]]
    if page.texts["h3"] != files:
        yield f"tables {page.texts['h3']}, not {files}"
    for table in summary["tables"]:
        if f"{table['rows']:,} row" not in text.split(f">{table['file']}</h3>")[-1][:100]:
            yield f"{table['file']} has {table['rows']} rows"
        yield from (f"{table['file']}: {fault}" for fault in faults_of_table(os.path.join(folder, table["file"]), page.cells.get(table["file"], [[]])))
    for warning in summary["warnings"]:
        if html.escape(warning["message"]) not in text:
            yield f"no warning {warning['message']}"


# Asked of a browser: what sticks out to the right, letters outside of their figure, blocks on each other.
MEASURE = """
const view = document.querySelector('iframe').contentDocument, width = WIDTH, told = [];
const box = element => element.getBoundingClientRect();
if (view.documentElement.scrollWidth > width) told.push('the page is ' + view.documentElement.scrollWidth + ' wide');
for (const element of view.querySelectorAll('h1, h2, h3, p, li, figure, svg, nav a, .extremes td'))
  if (box(element).right > width + 1) told.push(element.tagName + ' sticks out: ' + element.textContent.slice(0, 40));
for (const svg of view.querySelectorAll('svg'))
  for (const text of svg.querySelectorAll('text'))
    if (text.textContent.trim() && (box(text).left < box(svg).left - 1 || box(text).right > box(svg).right + 1))
      told.push('cut off: ' + text.textContent);
const blocks = [...view.querySelectorAll('h1, h2, h3, section p, figure, .wide, ul')].map(box).filter(one => one.height > 0);
blocks.forEach((one, i) => blocks.slice(0, i).forEach(other => {
  if (one.left < other.right - 1 && other.left < one.right - 1 && one.top < other.bottom - 1 && other.top < one.bottom - 1)
    told.push('blocks overlap at ' + Math.round(one.top));
}));
document.body.textContent = 'told: ' + told.slice(0, 5).join('; ') + ' end of it';
"""


def browse(path, width):
    with tempfile.TemporaryDirectory() as scratch:
        frame = Path(scratch, "frame.html")
        source = html.escape(Path(path).absolute().as_uri())
        frame.write_text(f'<meta charset="utf-8"><body style="margin:0"><iframe src="{source}" style="border:0;width:{width}px;height:900px">'
                         f'</iframe><script>window.onload = () => {{{MEASURE.replace("WIDTH", width)}}}</script>', encoding="utf-8")
        told = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
                               f"--user-data-dir={scratch}/profile", "--window-size=1500,1000", "--virtual-time-budget=20000", "--dump-dom",
                               frame.as_uri()], capture_output=True, encoding="utf-8", check=False).stdout
        found = re.search(r"told: (.*) end of it", told)
        return found[1] if found else "the browser measured nothing"


def main(words):
    if words[0] == "browse":
        faults = [f"{page} at {words[-1]}: {fault}" for page in words[1:-1] for fault in [browse(page, words[-1])] if fault]
    else:
        faults = list(faults_of(*words))
    print("\n".join(faults[:10]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
