"""The page of a run, HTML in one piece: what is in doubt, what was understood, errors, figures, tables, the deck."""

import os
import re
import time
import urllib.parse
from collections import Counter
from html import escape

from tables import KEPT, shown

MARK = '<meta name="generator" content="flexmech-report'  # of a page that may be overwritten
SHORT = 8        # rows at most of a table that stands in the page as it is
NARROW = 8       # columns at most, or rows become columns
FAILURES = 10    # lines
MANY = 3         # tables


def page_of(run, figures, target):
    """The page that is to be the file `target`, to which its links are relative."""
    with open(os.path.join(os.path.dirname(os.path.realpath(__file__)), "style.css"), encoding="utf-8") as file:
        style = file.read()

    def link(name):
        path = os.path.relpath(os.path.join(run.folder, name), os.path.dirname(os.path.abspath(target)))
        return f'<a href="{escape(urllib.parse.quote(os.fsencode(path)))}">{escape(name)}</a>'

    sections = [
        ("doubts", "Warnings and failures", doubts(run, link)),
        ("understood", "What was understood", understood(run, link)),
        ("errors", "Estimated errors", errors(run)),
        ("figures", "Figures", drawn(figures)),
        ("tables", "Tables", all_tables(run, link)),
        ("deck", "The deck", deck(run, link)),
    ]
    sections = [section for section in sections if section[2]]
    menu = " ".join(f'<a href="#{name}">{title}</a>' for name, title, _ in sections)
    body = "\n".join(f'<section id="{name}">\n<h2>{title}</h2>\n{content}\n</section>' for name, title, content in sections)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{MARK} {escape(run.version)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(run.title)}</title>
<style>
{style}</style>
</head>
<body>
<header>
<h1>{escape(run.title)}</h1>
<p class="small">{escape(run.deck)}: {extent(run)}; computed by flexmech {escape(run.version)} on {time.strftime("%Y-%m-%d", time.localtime(run.computed))}</p>
</header>
<nav>{menu}</nav>
<main>
{body}
</main>
</body>
</html>
"""


def counted(count, word):
    return f"{count:,} {word}" + ("" if count == 1 else "s")


def extent(run):
    names = [name for name in ("variants", "positions", "speeds", "modes") if run.counts[name] > (name == "variants")]
    return ", ".join(counted(run.counts[name], name[:-1]) for name in names) or "no positions"


def lines_of(lines, form, kind=""):
    return f'<div class="lines{kind}">\n' + "\n".join(f"<p>{form(line)}</p>" for line in lines) + "\n</div>"


def doubts(run, link):
    parts = []
    for warning in run.warnings:
        place = f"line {warning['line']}: " if warning["line"] else ""
        parts.append(f'<p class="{warning["grade"]}">{escape(place + warning["message"])}</p>')
    if run.failures:
        more = len(run.failures) - FAILURES
        parts.append(f'<p class="failed">{counted(run.counts["failures"], "failure")}: rows without a result</p>')
        parts.append(lines_of(run.failures[:FAILURES], escape))
        if more > 0:
            parts.append(f"<p>and {counted(more, 'more line')} in {link('run.log')}</p>")
    return "\n".join(parts) or "<p>None: all that the deck asks for was computed.</p>"


def understood(run, link):
    """Lines of the log but for warnings and failures; what they are about is bold."""
    def line_of(line):
        return re.sub(r"^([^:]+:)(?= |$)", r"<b>\1</b>", escape(line, quote=False))
    return run.log and lines_of(run.log, line_of) + f'\n<p class="small">from {link("run.log")}</p>'


def deck(run, link):
    def line_of(line):
        card, comment, words = line.partition("!")
        return escape(card.rstrip()) + (f" <span>! {escape(words.strip())}</span>" if comment else "")
    return run.echo and lines_of(run.echo, line_of, " deck") + f'\n<p class="small">from {link("echo.deck")}, with every default</p>'


def errors(run):
    """The largest value of every column that holds estimated errors."""
    rows = []
    for i, table in enumerate(run.tables):
        for name, unit, least, greatest in zip(table.names, table.units, table.least, table.greatest):
            if re.search(r"(^|_)error\d*$", name) and greatest is not None:
                largest = max(abs(least[0]), abs(greatest[0]))
                rows.append([f'<a href="#table{i + 1}">{escape(table.file)}</a>', escape(name), f"{largest:.2g}", unit_of(unit)])
    if not rows:
        return ""
    return ("<p>The largest of every column; the notes below a table say what its errors are relative to.</p>\n"
            + grid(["table", "column", "largest", "unit"], rows))


def drawn(figures):
    parts = [f'<p class="doubt">{escape(line)}</p>' for line in figures.told]
    if not figures.pictures:
        parts.append("<p>No figures.</p>")
    return "\n".join(parts + ['<div class="figures">'] + [
        f"<figure>\n{picture}\n<figcaption>Figure {i + 1}: {escape(name)}</figcaption>\n</figure>"
        for i, (name, picture) in enumerate(figures.pictures)] + ["</div>"])


def grid(head, rows, kind=""):
    """A table of cells that are HTML."""
    return (f'<div class="wide"><table{kind}>\n<thead><tr>' + "".join(f"<th>{cell}</th>" for cell in head) + "</tr></thead>\n<tbody>\n"
            + "\n".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows) + "\n</tbody></table></div>")


def all_tables(run, link):
    """Notes that many tables have, once; then every table with its own."""
    times = Counter(note for table in run.tables for note in table.notes)
    common = [note for note in times if times[note] >= MANY and note not in run.log]
    parts = ["<p>Of several tables:</p>", listed(common)] if common else []
    for i, table in enumerate(run.tables):
        parts.append(table_section(i, table, [note for note in table.notes if note not in common + run.log], link))
    return "\n".join(parts)


def listed(notes):
    return '<ul class="notes">' + "".join(f"<li>{escape(note)}</li>" for note in notes) + "</ul>" if notes else ""


def table_section(i, table, notes, link):
    count = counted(table.count, "row") + (f", {table.failed:,} failed" if table.failed else "")
    if table.count <= SHORT or table.mixes_units():
        content = rows_of(table)
        if table.count > len(table.rows):
            count += f"; the first {KEPT}"
    else:
        content = extremes_of(table)
        count += "; the first, the last, and where each column is least and greatest"
    return "\n".join([f'<h3 id="table{i + 1}">{escape(table.file)}</h3>', f'<p class="small">{count}. All of it: {link(table.file)}</p>',
                      content, listed(notes)])


def unit_of(unit):
    return "" if unit in ("-", "see_unit") else escape(unit)


def names_of(table):
    return [escape(name) + (f"<small>{unit_of(unit)}</small>" if unit_of(unit) else "") for name, unit in zip(table.names, table.units)]


def cell_of(cell):
    return escape(shown(cell))


def rows_of(table):
    names = names_of(table)
    if len(names) <= NARROW:
        return grid(names, [[cell_of(cell) for cell in row] for row in table.rows]) if table.rows else ""
    return grid(["column"] + [f"row {i + 1}" for i in range(len(table.rows))],
                [[name] + [cell_of(row[i]) for row in table.rows] for i, name in enumerate(names)])


def extremes_of(table):
    """A line a column: its first and last value, its least and greatest with their places."""
    rows = []
    for i, name in enumerate(names_of(table)):
        row = [name, cell_of(table.rows[0][i]), cell_of(table.last[i])]
        for extreme in (table.least[i], table.greatest[i]):
            cell = ""
            if extreme is not None and table.varies[i] and not table.has_words[i]:
                place = "" if i in table.places() else table.place_of(extreme[1])
                cell = cell_of(extreme[1][i]) + (f"<small>{escape(place)}</small>" if place else "")
            row.append(cell)
        rows.append(row)
    return grid(["column", "first", "last", "least", "greatest"], rows, ' class="extremes"')
