#!/usr/bin/env python3
"""Turns unit tests written for pFUnit 4 (tests/unit/test_*.pf) into Fortran for the bundled module `funit`.

    translate_tests.py FOLDER PROGRAM test_x.pf ...

writes into the folder a test_x.F90 for each, the module and one with its list of tests behind it, and PROGRAM.f90, which runs the tests
of all; only what has changed is written. Line marks keep the compiler's messages, and the assertions' own, pointing at the .pf file.
"""

import os
import re
import sys

RELATIONS = {"assert" + name.lower(): "assert" + name for name in (
    "Equal", "NotEqual", "RelativelyEqual", "LessThan", "LessThanOrEqual", "GreaterThan", "GreaterThanOrEqual")}
TRUTHS = {"asserttrue": "assertTrue", "assertfalse": "assertFalse"}
SUBROUTINE = re.compile(r"\s*subroutine\s+(\w+)", re.IGNORECASE)
# Variables of derived types. A test runs once, so they may be kept: their release would be half of the compilation.
OF_TYPE = re.compile(r"(\s*type\(\w+\))(\s*::[\w\s,]+)$", re.IGNORECASE)


class Refused(Exception):
    """What is written here would not work, or not mean the same, in pFUnit."""


def split_arguments(text):
    """The arguments between commas that stand in no bracket and no string."""
    arguments, depth, quote, start = [], 0, None, 0
    for i, c in enumerate(text):
        if quote:
            quote = None if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c in "([":
            depth += 1
        elif c in ")]":
            depth -= 1
            if depth < 0:
                raise Refused("a bracket closes that was not opened")
        elif c == "," and depth == 0:
            arguments.append(text[start:i].strip())
            start = i + 1
    if quote or depth:
        raise Refused("an assertion stands on one line and ends with its bracket")
    return arguments + [text[start:].strip()]


def assertion(name, text, location):
    """The call that an assertion stands for."""
    arguments = split_arguments(text)
    options = [a for a in arguments if re.match(r"(tolerance|message)\s*=[^=]", a, re.IGNORECASE)]
    operands = [a for a in arguments if a not in options]
    keyword = name.lower()
    if keyword in RELATIONS:
        name, procedure, count = RELATIONS[keyword], "assert_relation", 2
    elif keyword in TRUTHS:
        name, procedure, count = TRUTHS[keyword], "assert_truth", 1
    elif keyword == "assertisfinite":
        name, procedure, count = "assertIsFinite", "assert_finite", 1
    else:
        raise Refused(f"@{name} is not among the assertions of tests/support/funit.f90")
    if len(operands) != count:
        raise Refused(f"@{name} takes {count} value{'s' * (count > 1)}, then only tolerance= and message=")
    if keyword == "assertrelativelyequal" and not any(o.lower().startswith("tolerance") for o in options):
        raise Refused(f"@{name} needs a tolerance=")
    return f'call {procedure}("{name}", {", ".join(operands + [location] + options)}); if (anyExceptions()) return'


def translate(path):
    module = os.path.splitext(os.path.basename(path))[0]
    lines, tests, before, after, expected, in_test = [f'#line 1 "{path}"'], [], None, None, None, False
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            try:
                line = line.rstrip("\n")
                word = re.match(r"\s*@(\w+)\s*(.*)$", line)
                named = re.match(r"\s*module\s+(?!procedure\b)(\w+)\s*$", line, re.IGNORECASE)
                begun = SUBROUTINE.match(line)
                if named and named[1].lower() != module.lower():
                    raise Refused(f"module {named[1]} stands in a file of another name")
                if word and word[1].lower() in ("test", "before", "after"):
                    if word[2]:
                        raise Refused(f"@{word[1]} stands alone on its line here")
                    expected, line = word[1].lower(), ""
                elif word:
                    arguments = re.match(r"\((.*)\)\s*$", word[2])
                    if not arguments:
                        raise Refused("an assertion stands on one line and ends with its bracket")
                    line = assertion(word[1], arguments[1], f'"{path}", {number}')
                elif begun and expected:
                    in_test = expected == "test"
                    if in_test:
                        tests.append(begun[1])
                    elif expected == "before":
                        before = begun[1]
                    else:
                        after = begun[1]
                    expected = None
                elif re.match(r"\s*(contains|end\s*subroutine)\b", line, re.IGNORECASE):
                    in_test = False
                elif in_test:
                    line = OF_TYPE.sub(r"\1, save\2", line)
            except Refused as reason:
                sys.exit(f"{path}:{number}: error: {reason}")
            lines.append(line)

    fixture = "".join(f", {word}={name}" for word, name in (("before", before), ("after", after)) if name)
    lines += [
        f"module {module}_list",
        "  use funit, only: funit_run => run_test",
        f"  use {module}",
        "  implicit none (type, external)",
        "  private",
        f"  public :: {module}_suite",
        "contains",
        f"  subroutine {module}_suite()",
        *[f'    call funit_run("{module}", "{test}", {test}{fixture})' for test in tests],
        f"  end subroutine {module}_suite",
        f"end module {module}_list",
    ]
    return lines


def driver(modules):
    return [
        "program unit_tests",
        "  use funit, only: finish",
        *[f"  use {module}_list, only: {module}_suite" for module in modules],
        "  implicit none (type, external)",
        *[f"  call {module}_suite()" for module in modules],
        "  call finish()",
        "end program unit_tests",
    ]


def keep(path, lines):
    """Write a file, unless it is there with these lines: what is compiled from it stays up to date."""
    text = "\n".join(lines) + "\n"
    if os.path.exists(path):
        with open(path, encoding="utf-8") as earlier:
            if earlier.read() == text:
                return
    with open(path, "w", encoding="utf-8") as target:
        target.write(text)


def main(folder, name, *paths):
    modules = [os.path.splitext(os.path.basename(path))[0] for path in paths]
    for module, path in zip(modules, paths):
        keep(os.path.join(folder, module + ".F90"), translate(path))
    keep(os.path.join(folder, name + ".f90"), driver(modules))


if __name__ == "__main__":
    main(*sys.argv[1:])
