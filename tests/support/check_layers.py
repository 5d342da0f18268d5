#!/usr/bin/env python3
"""Checks what the compiler does not: the layers of src/, and the habits that can be read off a file.

    check_layers.py [FOLDER]     the folder that holds src/ and tests/, by default the current one

Prints `ok FILE` or `not ok FILE:LINE: why`; exit status 1 when anything is wrong.
"""

import os
import re
import sys
from glob import glob

# Folder of src/: the folders it may use besides its own. main.f90 may use all.
LAYERS = {
    "base": [],
    "deck": ["base"],
    "model": ["base", "deck"],
    "linkage": ["base"],
    "beam": ["base", "linkage"],
    "eigen": ["base"],
    "report": ["base", "model"],
    "analysis": ["base", "deck", "model", "linkage", "beam", "eigen", "report"],
}
INTRINSIC = {"iso_fortran_env", "iso_c_binding", "ieee_arithmetic", "ieee_exceptions", "ieee_features", "omp_lib"}


def statements(path):
    """Line number and text of each statement: continued lines joined, comments and the insides of strings taken out."""
    text, first, quote = "", 0, None
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            line = line.rstrip("\n")
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
                    yield first, part.strip().lower()
            text = ""


def faults(path, folder_of, layer):
    """What is wrong with one file. `layer` is its folder in src/, None for main.f90, "tests" for a module of the tests."""
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
        if layer and re.search(r"(^|\)\s*)(error\s+)?stop\b(?!\s*[=(%])", text):
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
        elif layer == "tests":
            continue
        elif module not in folder_of:
            yield number, f"there is no module {module} in src/"
        elif layer and folder_of[module] not in [layer] + LAYERS[layer]:
            yield number, f"{layer}/ may not use {folder_of[module]}/ ({module})"
    if layer and not modules:
        yield 1, "no module in this file"
    if layer != "tests" and not implicit_none:
        yield 1, "implicit none (type, external) is missing"


def main(root):
    os.chdir(root)
    sources = sorted(glob("src/*/*.f90"))
    folder_of = {os.path.splitext(os.path.basename(path))[0]: path.split(os.sep)[1] for path in sources}
    wrong = False
    modules_of_tests = set(glob("tests/unit/*.pf") + glob("tests/bench/*.f90")) - {os.path.join("tests", "bench", "bench.f90")}
    for path in sources + sorted(glob("src/*.f90")) + sorted(modules_of_tests):
        layer = "tests" if path in modules_of_tests else path.split(os.sep)[1]
        if path == os.path.join("src", "main.f90"):
            layer = None
        elif layer not in LAYERS and layer != "tests":
            print(f"not ok {path}: a source stands in one of the folders {', '.join(LAYERS)}")
            wrong = True
            continue
        found = list(faults(path, folder_of, layer))
        for number, why in found:
            print(f"not ok {path}:{number}: {why}")
        if not found:
            print(f"ok {path}")
        wrong = wrong or bool(found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "."))
