#!/usr/bin/env python3
"""Checks what the compiler does not: the layers of src/, and the habits that can be read off a file.

    check_layers.py [FOLDER]     the folder that holds src/, tests/ and docs/, by default the current one

The layers and what each may use are those of the table in docs/architecture.md. One file of every folder, its vocabulary,
begins with a heading `! src/FOLDER/ - …`, which says what the folder is for; what it names has to be there.

Prints `ok FILE` or `not ok FILE:LINE: why`; exit status 1 when anything is wrong.
"""

import os
import re
import sys
from glob import glob

MOST_COLUMNS = 100
MOST_FILES = 20  # of a folder
MOST_LINES = 10  # of its heading
INTRINSIC = {"iso_fortran_env", "iso_c_binding", "ieee_arithmetic", "ieee_exceptions", "ieee_features", "omp_lib"}
FOREIGN = {"mpi_f08": "ranks_mpi"}  # a module of a library, and the one file that may use it


def statements(path, directives=False):
    """Line number and text of each statement: continued lines joined, comments and the insides of strings taken out.
    OpenMP's directives are statements if they are asked for."""
    text, first, quote = "", 0, None
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            line = line.rstrip("\n")
            if directives and re.match(r"\s*!\$omp\b", line):
                line = line.replace("!$omp", " " if text else "\0$omp", 1)
            if text:
                line = re.sub(r"^\s*&", "", line)
            kept = ""
            for c in line:
                if quote:
                    if c == quote:
                        quote = None
                    elif c != "&":
                        continue
                elif c in "'\"":
                    quote = c
                elif c == "!":
                    break
                kept += c
            first = first if text else number
            text += kept.rstrip()
            if text.endswith("&"):
                text = text[:-1] + " "
                continue
            quote = None
            for part in text.split(";"):
                if part.strip():
                    yield first, part.strip().lower().replace("\0", "!")
            text = ""


def read_layers(path):
    """The table of the layers: folder of src/ → the folders that it may use besides itself."""
    layers = {}
    with open(path, encoding="utf-8") as document:
        for line in document:
            cells = [cell.strip() for cell in line.split("|")]
            if len(cells) == 5 and re.match(r"`[a-z_/.]+`$", cells[1]):
                layers[cells[1].strip("`")] = re.findall(r"`([a-z_/]+)`", cells[3])
    return layers


def layer_of(path, layers):
    """The row of the table that a file of src/ belongs to: that of its folder, else that of a folder above."""
    folder = os.path.relpath(os.path.dirname(path), "src")
    while folder and folder not in layers:
        folder = os.path.dirname(folder)
    return folder


def faults(path, layer_of_module, layers, layer):
    """What is wrong with one file. `layer` is its row in the table, "tests" for a module of the tests."""
    name = os.path.splitext(os.path.basename(path))[0]
    modules, implicit_none = 0, False
    for number, text in statements(path):
        begun = re.match(r"(?:module|submodule\s*\([\w\s:]+\))\s+(?!procedure\b|subroutine\b|function\b)(\w+)$", text)
        if begun:
            modules += 1
            if modules > 1:
                yield number, "a second module in the same file"
            elif begun[1] != name:
                yield number, f"module {begun[1]} stands in a file of another name"
        implicit_none = implicit_none or re.match(r"implicit\s+none\s*\(\s*type\s*,\s*external\s*\)$", text)
        if name != "main" and re.search(r"(^|\)\s*)(error\s+)?stop\b(?!\s*[=(%])", text):
            yield number, "only main stops the program"

        use = re.match(r"use\b\s*(,\s*(?:non_)?intrinsic\s*)?(?:::)?\s*(\w+)\s*(.*)$", text)
        if not use or use[3].startswith("="):
            continue
        module, only = use[2], re.match(r",\s*only\s*:", use[3])
        if not only and not (module == "funit" and layer == "tests"):
            yield number, f"use {module} without only"
        if module in INTRINSIC:
            if not use[1] and module != "omp_lib":
                yield number, f"use, intrinsic :: {module} says that this is the compiler's"
        elif layer == "tests" or FOREIGN.get(module) == name:
            continue
        elif module not in layer_of_module:
            yield number, f"there is no module {module} in src/"
        elif layer_of_module[module] not in [layer] + layers[layer]:
            yield number, f"{layer}/ may not use {layer_of_module[module]}/ ({module})"
    if name != "main" and not modules:
        yield 1, "no module in this file"
    if layer != "tests" and not implicit_none:
        yield 1, "implicit none (type, external) is missing"


def unused_imports(path):
    """Names that a file imports and does not use."""
    uses, others = [], []
    for number, text in statements(path, directives=True):
        (uses if re.match(r"use\b", text) else others).append((number, text))
    body = "\n".join(text for _, text in others).lower()
    for number, text in uses:
        for item in re.sub(r"^.*?only\s*:", "", text).split(",") if re.search(r"only\s*:", text) else []:
            name = item.split("=>")[0].strip().lower()
            # A kind stands behind an underscore.
            if re.fullmatch(r"\w+", name) and not re.search(rf"(\b|_){name}\b", body):
                yield number, f"{name} is not used"


def width_faults(path):
    """Lines wider than the sources are."""
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            if len(line.rstrip("\n")) > MOST_COLUMNS:
                yield number, f"wider than {MOST_COLUMNS} columns"


def heading_of(path):
    """The lines before the first empty one, if they are about a folder."""
    with open(path, encoding="utf-8") as source:
        text = source.read()
    return text.partition("\n\n")[0].splitlines() if text.startswith("! src/") else []


def public_names(path):
    """The module of a file, and what it makes public."""
    with open(path, encoding="utf-8") as source:
        lists = re.findall(r"\bpublic\s*::((?:.*&\s*\n)*.*)", source.read())
    return set(re.findall(r"\w+", " ".join(lists))) | {os.path.splitext(os.path.basename(path))[0]}


def heading_faults(path, heading, public):
    """What is wrong with the heading of a folder. `public`: the public names of every file."""
    folder = os.path.dirname(path)
    if not re.match(rf"! {folder}/ - \S", heading[0]):
        yield 1, f"the heading of this folder begins with ! {folder}/ - "
    if not all(line.startswith("! ") for line in heading):
        yield len(heading), "a heading is a plain comment, with an empty line behind it"
    elif len(heading) > MOST_LINES:
        yield len(heading), f"a heading has at most {MOST_LINES} lines"
    for number, line in enumerate(heading, 1):
        for name in re.findall(r"`([^`]*)`", line):
            if not (any(name in names for names in public.values()) or os.path.exists(name)
                    or os.path.exists(os.path.join(folder, name))):
                yield number, f"{name} is neither a public name nor a file"
    text = " ".join(line[2:] for line in heading)
    for names, file in re.findall(r"((?:`\w+`(?:, | and )?)+) (?:here|in `([\w/]+\.f90)`)", text):
        place = file if "/" in file else os.path.join(folder, file) if file else path
        for name in re.findall(r"`(\w+)`", names):
            if name not in public.get(place, ()):
                yield 1, f"{name} is not public in {place}"


def main(root):
    os.chdir(root)
    layers = read_layers(os.path.join("docs", "architecture.md"))
    sources = sorted(glob("src/**/*.f90", recursive=True))
    layer_of_module = {os.path.splitext(os.path.basename(path))[0]: layer_of(path, layers) for path in sources}
    headings = {path: heading_of(path) for path in sources}
    public = {path: public_names(path) for path in sources}
    wrong = False
    modules_of_tests = set(glob("tests/unit/**/*.pf", recursive=True) + glob("tests/bench/*.f90")) - \
        {os.path.join("tests", "bench", "bench.f90")}
    for path in sources + sorted(modules_of_tests):
        layer = "tests" if path in modules_of_tests else layer_of(path, layers)
        if not layer:
            print(f"not ok {path}: its folder is not in the table of docs/architecture.md")
            wrong = True
            continue
        found = list(faults(path, layer_of_module, layers, layer))
        if layer != "tests":
            found += list(width_faults(path)) + list(unused_imports(path))
            if headings[path]:
                found += heading_faults(path, headings[path], public)
        for number, why in found:
            print(f"not ok {path}:{number}: {why}")
        if not found:
            print(f"ok {path}")
        wrong = wrong or bool(found)
    for folder in sorted({os.path.dirname(path) for path in sources}):
        count = sum(os.path.dirname(path) == folder for path in sources)
        if count > MOST_FILES:
            print(f"not ok {folder}: {count} files, and a folder has at most {MOST_FILES}")
            wrong = True
        count = sum(os.path.dirname(path) == folder and bool(headings[path]) for path in sources)
        if count != (0 if folder == "src" else 1):
            print(f"not ok {folder}: {count} files begin with ! {folder}/ - …, where one has to (in src/ itself none)")
            wrong = True
    for layer, uses in layers.items():
        for folder in [layer] + uses:
            if not os.path.isdir(os.path.join("src", folder)):
                print(f"not ok docs/architecture.md: there is no folder src/{folder}")
                wrong = True
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "."))
