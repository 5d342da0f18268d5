#!/usr/bin/env python3
"""Checks that nothing that threads run is in static storage, which they would share.

    check_threads.py [FOLDER ...]     with the object files of a build in these folders

gfortran keeps the length that a function with a result of `character(len=:)` returns in one place for all calls of a
statement, so threads must not run such a statement at the same time: what parallel regions and jobs reach may call such
functions in sections `!$omp critical (one_at_a_time)` only. This follows the calls through the sources. Whatever else is
static, saved locals and variables of modules, stands in the object files.

Prints `ok WHAT` or `not ok FILE:LINE: why`; exit status 1 when anything is wrong.
"""

import os
import re
import subprocess
import sys
from glob import glob

from check_layers import statements

LOCK = "one_at_a_time"
# Written by the handler of signals, and what `main` has.
ALLOWED = {"interruption": {"last_signal", "last_tick"}, "main": {"command", "options", "watch"}}
# What compilers put there: lengths of results, types, tables of jumps, messages.
COMPILERS = re.compile(r"slen\.|jumptable\.|A\.\d|\.LC|__?\w+_MOD___(vtab|def_init|final|copy)\w*|__(vtab|def_init)_|\.gomp_critical")

BEGIN = re.compile(r"(?!end\b)[\w\s()=*]*?\b(?:subroutine|function)\s+(\w+)\s*(?:\(|$)")
WORDS = re.compile(r"(?:\b([a-z]\w*)\s*=\s*)?(%\s*)?\b([a-z]\w*)\b")


class Procedure:
    """A procedure, or (without a name) what a module has before them: what it calls outside the lock, by line."""

    def __init__(self, module, name, host):
        self.module, self.name, self.host = module, name, host
        self.result, self.returns_text = name, False
        self.calls, self.in_threads = [], []  # (line, whether of a type, name, keyword or name on the left of an =)


class Module:
    """What names mean in a module."""

    def __init__(self, path):
        self.path, self.uses, self.generic, self.bound, self.pointers = path, {}, {}, {}, set()
        self.procedures = {}
        self._read()

    def _read(self):
        stack, interface, region, locked, typed = [], None, False, False, False
        for line, text in statements(self.path, directives=True):
            here = stack[-1] if stack else None
            if text.startswith("!$omp"):
                words = text[len("!$omp"):].split()
                if words[0] == "parallel" or words[:2] == ["end", "parallel"]:
                    region = words[0] == "parallel"
                    self._calls(here, line, " ".join(words), region, locked)
                elif "critical" in words[:2] and LOCK in text:
                    locked = words[0] == "critical"
                continue
            if re.match(r"(abstract\s+)?interface\b", text):
                interface = text.partition("interface")[2].strip()
                continue
            if text.startswith("end interface") or text == "endinterface":
                interface = None
                continue
            if interface is not None:
                names = re.match(r"(?:module\s+)?procedure\s*(?:::)?\s*(.*)", text)
                if names and interface:
                    self.generic.setdefault(interface, []).extend(re.findall(r"\w+", names[1]))
                continue
            use = re.match(r"use\b.*?(\w+)\s*,\s*only\s*:\s*(.*)$", text)
            if use:
                for name in re.findall(r"(?:(\w+)\s*=>\s*)?(\w+)", use[2]):
                    self.uses[name[0] or name[1]] = (use[1], name[1])
                continue
            if re.match(r"type\b(?!\s*\()", text):
                typed = True
            elif re.match(r"end\s*type", text):
                typed = False
            elif typed and (bound := re.match(r"procedure\b[^:]*::\s*(.*)$", text)):
                if re.match(r"procedure\b[^:]*\bpointer\b", text):
                    self.pointers.update(re.findall(r"(\w+)\s*(?:=>[^,]*)?", bound[1])[:1])
                    continue
                for name in bound[1].split(","):
                    own, _, real = name.partition("=>")
                    self.bound.setdefault(own.strip(), set()).add((real or own).strip())
            elif re.match(r"end\s*(subroutine|function|procedure)\b", text) and stack:
                stack.pop()
            elif (begun := BEGIN.match(text)) and not text.startswith("end"):
                here = Procedure(self, begun[1], stack[-1] if stack else None)
                result = re.search(r"result\s*\(\s*(\w+)", text)
                here.result = result[1] if result else begun[1]
                self.procedures[begun[1]] = here
                stack.append(here)
            elif here:
                declared = re.match(r"character\s*\(\s*(?:len\s*=\s*)?:\s*\)\s*,.*::(.*)$", text)
                if declared and re.search(rf"\b{here.result}\b", declared[1]) and here.result != "":
                    here.returns_text = True
                self._calls(here, line, text, region, locked)

    @staticmethod
    def _calls(here, line, text, region, locked):
        if here and not locked:
            found = [(line, mark != "", name, keyword) for keyword, mark, name in WORDS.findall(text)]
            here.calls += found
            if region:
                here.in_threads += found


class Program:
    """All modules, and what their procedures reach."""

    def __init__(self, paths):
        self.modules = {os.path.splitext(os.path.basename(path))[0]: Module(path) for path in paths}
        self.bound = {}  # name in a type → the procedures that it may be
        for module in self.modules.values():
            for name, reals in module.bound.items():
                self.bound.setdefault(name, []).extend(one for real in reals for one in self.named(module, real))
        # A component that points at procedures may be any of those that it is given.
        self.pointers = set().union(*(module.pointers for module in self.modules.values()))
        for module in self.modules.values():
            for procedure in module.procedures.values():
                for _, of_type, name, keyword in procedure.calls:
                    if keyword in self.pointers and not of_type:
                        self.bound.setdefault(keyword, []).extend(self.named(module, name))

    def named(self, module, name):
        """The procedures that a name may mean in a module."""
        if name in module.procedures:
            return [module.procedures[name]]
        if name in module.generic:
            return [one for real in module.generic[name] if real != name for one in self.named(module, real)]
        if name in module.uses:
            other, real = module.uses[name]
            if other in self.modules and self.modules[other] is not module:
                return self.named(self.modules[other], real)
        return []

    def meant(self, module, calls):
        for line, of_type, name, keyword in calls:
            if keyword in self.pointers and not of_type:
                continue  # it is given, not called
            for one in self.bound.get(name, ()) if of_type else self.named(module, name):
                yield line, one

    def faults(self):
        """(path, line, why) of every call of such a function that threads reach."""
        reached, waiting = {}, []
        for module in self.modules.values():
            for procedure in module.procedures.values():
                waiting += [(procedure, procedure.in_threads)] if procedure.in_threads else []
            for name, interface in module.generic.items():  # operators and assignments are called without their names
                if "(" in name:
                    for real in interface:
                        for one in self.named(module, real):
                            reached[one] = None
                            waiting.append((one, one.calls))
        while waiting:
            procedure, calls = waiting.pop()
            for line, one in self.meant(procedure.module, calls):
                if one.returns_text and one is not procedure:
                    yield procedure.module.path, line, f"{one.name} makes a text in threads; reached by {self.way(procedure, reached)}"
                if one not in reached:
                    reached[one] = procedure
                    waiting.append((one, one.calls))

    @staticmethod
    def way(procedure, reached):
        names = []
        while procedure and procedure.name not in names:
            names.append(procedure.name)
            procedure = reached.get(procedure)
        return " from ".join(names)


def static_faults(folder):
    """(object, why) of every variable in static storage that is not allowed."""
    objects = sorted(glob(os.path.join(folder, "*.o")))
    listed = subprocess.run(["nm", "-A", *objects], capture_output=True, text=True, check=True).stdout
    for line in listed.splitlines():
        path, _, rest = line.partition(":")
        kind, symbol = rest.split()[-2:]
        name = os.path.splitext(os.path.basename(path))[0]
        plain = re.sub(r"(\.\d+)+$", "", symbol).rpartition("_MOD_")[2]
        if kind in "bBdDC" and not COMPILERS.match(symbol) and plain not in ALLOWED.get(name, ()):
            yield path, f"{plain} is in static storage, which threads share"


def main(folders):
    faults = sorted(set((f"{path}:{line}", why) for path, line, why in Program(glob("src/**/*.f90", recursive=True)).faults()))
    for where, why in faults:
        print(f"not ok {where}: {why}")
    if not faults:
        print("ok no text is made in threads but one at a time")
    for folder in folders:
        found = list(static_faults(folder))
        for where, why in found:
            print(f"not ok {where}: {why}")
        if not found:
            print(f"ok no static storage in {folder}")
        faults += found
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
