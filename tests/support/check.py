#!/usr/bin/env python3
"""Runs the tests on what `make check` has built; the last line printed is the count.

    check.py UNIT_TESTS          the program of unit tests below build/release, funit/… or pfunit/…
    check.py --slow UNIT_TESTS   what `make check` leaves to `make check-all`: slow tests, and all of the debug build

Everything is written below build/check/. Exit status 1 when a test has failed. Seconds are those of processors, of which other work on
the machine changes little.
"""

import contextlib
import filecmp
import io
import multiprocessing
import os
import re
import resource
import shutil
import subprocess
import sys
from glob import glob

import compare_tables
import report_tests
import table_tests

SCRATCH = os.path.join("build", "check")
COUNT = os.path.join("build", "check.count")
LONGEST = 3600  # seconds; a test that takes longer hangs, on a busy machine too
SHARES = 24    # of the unit tests: the program is run so many times, each time with other modules
TABLE_SHARES = 4  # of the decks of tests/tables/

# `make check` is to take eight minutes on two processors, and compiling the program and the tests takes six of them. So it compiles one
# build, as users have it, and what is below, and all of the debug build, wait for `make check-all`.
SLOW_DECKS = ["campbell", "damped_engine", "stability", "strains", "transient"]  # of inputs/
SLOW_GROUPS = ["bench", "failed_variants", "figure_details", "figure_extents", "figures", "flexmech_plot", "interruption", "job_scripts", "memory", "mpi",
               "numbers_of_documents", "package", "parts", "random_linkages", "report", "report_browser", "reports", "resume", "running", "stability", "summary", "threads",
               "vibrations"]  # scripts and procedures below
SLOW_TESTS = [module + " " for module in (
    "test_instability_intervals", "test_damped_eigensolver", "test_transient_responses", "test_path_grids",
    "test_exact_frequencies", "test_steady_responses", "test_campbell_study", "test_deformation_model", "test_order_errors",
    "test_transient_motions", "test_campbell", "test_critical_speeds", "test_response_study", "test_frequency_study", "test_held_ends",
    "test_slow_motions", "test_stability", "test_crank_limits")]  # unit tests that hold one of these
# Seconds of jobs that take more than others: these are begun first, or one processor would wait for another in the end.
SECONDS = {"unit_tests debug": 22, "unit_tests release": 8, "script release figures": 257, "numbers_of_documents": 108, "script release memory": 96,
           "script release parts": 84, "script release interruption": 83, "random_linkages": 80, "script release tables": 78,
           "script release summary": 76, "script release figure_extents": 75, "script release figure_details": 74, "script release flexmech_plot": 73, "script release mpi": 64,
           "script release job_scripts": 54, "script release resume": 51, "script release running": 49, "script release stability": 39,
           "vibrations": 38, "script release failed_variants": 28, "goldens": 28, "assemblies": 26, "script release deck_files": 21,
           "script release options": 19, "script release csv": 16, "script release echo_deck": 13, "script release response": 11}
# The C library has other sin, cos and exp for other processors; without all of these it has those of the oldest.
OLDEST = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX512DQ,-AVX512BW,-AVX512VL,-AVX2,-FMA,-FMA4"}


def processor_seconds():
    """Of this process and of those that it has waited for."""
    used = [resource.getrusage(which) for which in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


class Group:
    """The results of one kind of test: failures at once, one line in the end."""

    ended = []  # groups of this process

    def __init__(self, title, shares=1):
        self.title, self.shares, self.passed, self.failed, self.skipped = title, shares, 0, 0, 0
        self.seconds = processor_seconds()

    def result(self, name, why=None):
        """One test: passed, unless there is a reason why not."""
        if why is None:
            self.passed += 1
        else:
            self.failed += 1
            print(f"not ok {name}: {why}")

    def lines(self, run):
        """The results of a program that prints `ok NAME` and `not ok NAME: why` itself."""
        last = "before its first test"
        before = self.failed
        for line in run.stdout.splitlines():
            if line.startswith("ok ") and "# skip" in line.lower():
                self.skipped += 1
                print(line)
            elif line.startswith("ok "):
                self.passed += 1
                last = "after " + line[3:]
            elif line.startswith("not ok "):
                self.failed += 1
                print(line)
            elif line.startswith("# "):
                last = "in " + line[2:]
        if run.returncode != 0 and (self.failed == before or run.returncode < 0):
            self.result(os.path.relpath(run.args[0]), f"ended with status {run.returncode} {last}\n{run.stderr.strip()}")
        elif self.passed + self.failed + self.skipped == 0:
            self.result(os.path.relpath(run.args[0]), "ran no test")

    def end(self):
        self.seconds = processor_seconds() - self.seconds
        Group.ended.append(self)

    def add(self, other):
        """Another share of the same tests."""
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.seconds += other.seconds
        self.shares -= 1

    def line(self):
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        return f"{self.title:<32}{self.passed:5d} passed, {self.failed:3d} failed, {self.seconds:5.0f} s{skipped}"


def execute(command, folder=".", environment=None):
    """Run without input, and with a limit of time."""
    try:
        return subprocess.run(command, cwd=folder, env=dict(os.environ, **environment or {}), stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                              timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, -1, "", f"still running after {LONGEST} s")


def fresh(*names):
    """An empty folder, its absolute path."""
    folder = os.path.abspath(os.path.join(SCRATCH, *names))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    return folder


def program(build):
    return os.path.abspath(os.path.join("build", build, "flexmech"))


def base_name(path):
    return os.path.splitext(os.path.basename(path))[0]


def unit_test_jobs(build, path, only_slow=False):
    """The unit tests in shares, a process each: in the release build without the slow ones, or only these. pFUnit's are one process."""
    if not path.startswith("funit"):
        return [] if only_slow else [(unit_tests, build, path, 0, 1, [])]
    modules = [base_name(file) + " " for file in sorted(glob(os.path.join("tests", "unit", "**", "test_*.pf"), recursive=True))]
    if only_slow:
        shares = [[test] for test in SLOW_TESTS]
    elif build == "release":
        quick = [module for module in modules if module not in SLOW_TESTS]
        shares = [quick[share::SHARES] + ["-" + test for test in SLOW_TESTS] for share in range(SHARES)]
    else:
        shares = [modules[share::SHARES] for share in range(SHARES)]
    return [(unit_tests, build, path, number, len(shares), words) for number, words in enumerate(shares)]


def unit_tests(build, path, share, shares, words):
    """Tests that hold one of the words, but none behind a minus; without any, all."""
    group = Group(f"unit tests, {build}", shares)
    # They write files beside themselves, and know the library from the checkout.
    folder = fresh("unit", build, str(share))
    os.symlink(os.path.abspath("library"), os.path.join(folder, "library"))
    run = execute([os.path.abspath(os.path.join("build", build, path))] + words, folder)
    if path.startswith("funit"):
        group.lines(run)
        for word in words:
            if run.returncode >= 0 and word[0] != "-" and "\n# " + word not in "\n" + run.stdout:
                group.result(word.strip(), "no test of it was run")
    else:
        ok = re.search(r"^ *OK\s+\((\d+) tests?", run.stdout, re.MULTILINE)
        bad = re.search(r"Tests run: (\d+), Failures: (\d+), Errors: (\d+)", run.stdout)
        if ok and run.returncode == 0:
            group.passed = int(ok[1])
        else:
            print(run.stdout.strip(), run.stderr.strip(), sep="\n")
            group.failed = max(1, int(bad[2]) + int(bad[3]) if bad else 1)
            group.passed = int(bad[1]) - group.failed if bad else 0
    group.end()


def assertions(build, path):
    """The assertions fail when they must, and say what they must."""
    group = Group(f"assertions, {build}")
    run = execute([os.path.join("build", build, os.path.dirname(path), "must_fail")])
    if path.startswith("funit"):
        with open(os.path.join("tests", "support", "test_must_fail.expected"), encoding="utf-8") as kept:
            expected = kept.read().splitlines()
        found = [line for line in run.stdout.splitlines() if not line.startswith("# ")]
        for i, line in enumerate(expected):
            text = found[i] if i < len(found) else "nothing"
            group.result(line.split(":")[0], None if text == line else f"expected\n  {line}\nbut it printed\n  {text}")
        group.result("test_must_fail ends with status 2", None if run.returncode == 2 else f"status {run.returncode}")
    else:
        count = re.search(r"Tests run: (\d+), Failures: (\d+)", run.stdout)
        group.result("all of test_must_fail fail", None if count and count[1] == count[2] else run.stdout)
    group.end()


def layers():
    group = Group("layers")
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "support", "check_layers.py")]))
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "support", "check_threads.py"), os.path.join("build", "release")]))
    group.end()


def documents():
    group = Group("documents")
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "support", "check_documents.py")]))
    group.end()


def numbers_of_documents():
    """The numbers that `make documents` writes."""
    group = Group("numbers of documents")
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "documents", "documents.py"), program("release")]))
    group.end()


def refused_decks(build):
    group = Group(f"refused decks, {build}")
    folder = os.path.join("tests", "decks")
    for expected_file in sorted(glob(os.path.join(folder, "*.expected"))):
        name = base_name(expected_file)
        out = os.path.join(fresh("decks", build), name)  # must not come into being
        run = execute([program(build), "--out", out, name + ".deck"], folder)
        with open(expected_file, encoding="utf-8") as kept:
            expected = kept.read()
        why = None
        if run.returncode != 2:
            why = f"exit status {run.returncode}, not 2"
        elif run.stderr != expected:
            why = f"expected\n{expected}but it printed\n{run.stderr}"
        elif os.path.lexists(out):
            why = "something was written"
        group.result(f"{folder}/{name}.deck ({build})", why)
    for deck in sorted(glob(os.path.join(folder, "*.deck"))):
        if not os.path.exists(deck[:-len("deck")] + "expected"):
            group.result(deck, "there is no .expected beside it")
    group.end()


def expected_tables(build, share):
    """The decks of tests/tables/ have the tables and messages that are expected."""
    group = Group(f"expected tables, {build}", TABLE_SHARES)
    if share == 0:
        group.result("table_tests.py --self-check", "\n".join(table_tests.self_check()) or None)
        group.result("tests/tables", "\n".join(table_tests.unused_decks()) or None)
    for name in table_tests.names_of_tests()[share::TABLE_SHARES]:
        for place, why in table_tests.results(name, program(build), fresh("expected", build, name)):
            group.result(place, why)
    group.end()


def reports(build):
    """All tables that --help-cards promises."""
    group = Group(f"reports, {build}")
    for name, why in report_tests.results(program(build), fresh("reports", build)):
        group.result(name, why)
    group.end()


def random_linkages():
    """Random linkages against independent solvers, and against themselves described otherwise; `make check-all` compares more."""
    group = Group("random linkages, release")
    for script, count in (("random_loads.py", 36), ("random_load_motions.py", 12), ("force_tables.py", 3), ("welded_sections.py", 2), ("massless.py", 9),
                          ("metamorphic.py", 6), ("measured_drives.py", 6)):
        run = execute([sys.executable, "-B", os.path.join("tests", "linkages", script), "1", str(count), "--program",
                       program("release"), "--scratch", fresh("linkages", base_name(script))])
        said = run.stdout.strip() + run.stderr.strip()
        group.result(f"tests/linkages/{script} 1 {count}", None if run.returncode == 0 else said)
    group.end()


def vibrations():
    """Exact frequencies, and a few random linkages; `make vibrations` compares more."""
    group = Group("vibrations, release")
    folder = os.path.join("tests", "linkages")
    common = ["--program", program("release"), "--skip-refused", "--scratch"]
    group.lines(execute([sys.executable, "-B", os.path.join(folder, "vibration_checks.py")]))
    group.lines(execute([sys.executable, "-B", os.path.join(folder, "exact_frequencies.py")] + common
                        + [fresh("vibrations", "exact")]))
    run = execute([sys.executable, "-B", os.path.join(folder, "random_vibrations.py"), "1", "48", "--jobs", "1"] + common
                  + [fresh("vibrations", "random")])
    said = run.stdout.strip() + run.stderr.strip()
    group.result(f"{folder}/random_vibrations.py 1 48", None if run.returncode == 0 else said)
    run = execute([sys.executable, "-B", os.path.join(folder, "random_vibrations.py"), "1", "12", "--kind", "slotted", "--jobs", "1"] + common
                  + [fresh("vibrations", "slotted")])
    said = run.stdout.strip() + run.stderr.strip()
    group.result(f"{folder}/random_vibrations.py 1 12 --kind slotted", None if run.returncode == 0 else said)
    group.end()


def published_cases():
    """Decks of tests/published/ against published and exact values."""
    group = Group("published cases, release")
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "published", "published.py"), "--program", program("release"),
                         "--scratch", fresh("published")]))
    group.end()


def assemblies():
    """Linkages of which the assembly is easily mistaken, in seven views each."""
    group = Group("assemblies, release")
    group.lines(execute([sys.executable, "-B", os.path.join("tests", "linkages", "assembly_examples.py"), "--program", program("release"),
                         "--scratch", fresh("assemblies")]))
    group.end()


def run_deck(group, build, deck, out, options=(), environment=None):
    """Run a deck; status 1 (some rows could not be computed) is no failure here, for the tables tell."""
    run = execute([program(build), *options, "--out", out, deck], environment=environment)
    if run.returncode in (0, 1):
        return True
    group.result(f"{deck} ({build})", f"ended with status {run.returncode}\n{run.stderr.strip()}")
    return False


def goldens(build, decks, environment=None):
    """The tables of inputs/ are those kept, on this processor or on another one, and the same bytes on one thread and on three."""
    where = ", oldest processor" if environment else ""
    group = Group(f"goldens, {build}{where}, {decks} decks")
    repeated = Group("the same bytes, 1 and 3 threads")
    group.result("compare_tables.py --self-check", "\n".join(compare_tables.self_check()) or None)
    for deck in sorted(glob(os.path.join("inputs", "*.deck"))):
        if decks != "all" and (base_name(deck) in SLOW_DECKS) != (decks == "slow"):
            continue
        case = base_name(deck)
        kept = os.path.join("tests", "golden", case)
        out = fresh("oldest" if environment else "golden", build, decks)
        if not os.path.isdir(kept):
            group.result(deck, f"no {kept}/; say: make golden CASE={case}")
        elif run_deck(group, build, deck, out, ["--threads", "3"], environment=environment):
            old, new = ({os.path.basename(table) for table in glob(os.path.join(folder, "*.dat"))}
                        for folder in (kept, os.path.join(out, case)))
            for table in sorted(old | new):
                name = f"{kept}/{table} ({build}{where})"
                if table not in new:
                    group.result(name, "the program does not write it any more")
                elif table not in old:
                    group.result(name, f"a new table; say: make golden CASE={case}")
                else:
                    group.result(name, compare_tables.difference(os.path.join(kept, table), os.path.join(out, case, table)))
            if build == "release" and not environment:
                same_bytes(repeated, deck, os.path.join(out, case))
    for kept in sorted(glob(os.path.join("tests", "golden", "*", ""))):
        case = os.path.basename(os.path.dirname(kept))
        if not os.path.exists(os.path.join("inputs", case + ".deck")):
            group.result(kept, f"there is no inputs/{case}.deck")
    group.end()
    if repeated.passed + repeated.failed > 0:
        repeated.end()


def same_bytes(group, deck, folder):
    """The tables of a deck on three threads are the bytes of those on one."""
    alone = fresh("alone")
    if not run_deck(group, "release", deck, alone, ["--threads", "1"]):
        return
    folders = [os.path.join(alone, base_name(deck)), folder]
    names = [sorted(os.listdir(folder)) for folder in folders]
    if names[0] != names[1]:
        group.result(deck, f"files {names[0]}, then {names[1]}")
        return
    different = filecmp.cmpfiles(*folders, names[0], shallow=False)
    group.result(deck, f"not the same: {' '.join(different[1] + different[2])}" if different[1] + different[2] else None)


def threads():
    """Variants on threads; `make check-all` runs all decks, more often."""
    group = Group("threads, release")
    run = execute([sys.executable, "-B", os.path.join("tests", "stress", "run_threads.py"), os.path.join("tests", "threads", "limits.deck"),
                   os.path.join("tests", "threads", "sizing.deck"), "--program", program("release"), "--runs", "40", "--seconds", "2",
                   "--scratch", fresh("threads")])
    said = run.stdout.strip() + run.stderr.strip()
    group.result("tests/stress/run_threads.py", None if run.returncode == 0 else said)
    group.end()


def script(build, name, whole=False):
    """A script, without slow decks and tests, or whole."""
    group = Group(f"{name}.sh, {build}" + (", whole" if whole else ""))
    path = os.path.join("tests", "scripts", name + ".sh")
    if os.access(path, os.X_OK):
        group.lines(execute([os.path.abspath(path), program(build), fresh("scripts", build, name)],
                            environment={} if whole else {"SLOW_DECKS": "|".join(SLOW_DECKS)}))
    else:
        group.result(path, "is not executable")
    group.end()


def perform(job):
    """Makes a job in a process of its own: what it prints, and its groups."""
    test, *arguments = job
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        test(*arguments)
    ended, Group.ended = Group.ended, []
    return printed.getvalue(), ended


def seconds_of(job):
    """How long a job takes, about."""
    words = [job[0].__name__] + [word for word in job[1:] if isinstance(word, str)]
    return max(SECONDS.get(" ".join(words[:n]), 0) for n in range(1, len(words) + 1))


def jobs_of_release(tests):
    """Tests of the release build but for scripts."""
    jobs = unit_test_jobs("release", tests) + [(assertions, "release", tests), (refused_decks, "release"), (goldens, "release", "quick")]
    jobs += [(expected_tables, "release", share) for share in range(TABLE_SHARES)] + [(reports, "release")]
    return jobs + [(test,) for test in (layers, documents, numbers_of_documents, threads, random_linkages, vibrations, published_cases, assemblies)]


def main(tests, slow):
    names = sorted(base_name(path) for path in glob(os.path.join("tests", "scripts", "*.sh")))
    names.remove("functions")  # a part that others read in
    jobs = jobs_of_release(tests)
    unknown = set(SLOW_GROUPS) - set(names) - {job[0].__name__ for job in jobs}
    if unknown:
        sys.exit(f"check.py: there is no {', '.join(sorted(unknown))}")
    jobs = [job for job in jobs if (job[0].__name__ in SLOW_GROUPS) == slow]
    if slow:
        jobs += unit_test_jobs("release", tests, only_slow=True) + unit_test_jobs("debug", tests)
        # The last two run the decks of inputs/.
        jobs += [(script, "release", name, True) for name in names if name in SLOW_GROUPS + ["echo_deck", "tables"]]
        jobs += [(script, "debug", name) for name in names]
        # pFUnit's own comparison of a NaN raises the exception that the debug build traps.
        jobs += [(assertions, "debug", tests)] if tests.startswith("funit") else []
        jobs += [(expected_tables, "debug", share) for share in range(TABLE_SHARES)] + [(reports, "debug")]
        jobs += [(refused_decks, "debug"), (goldens, "release", "slow"), (goldens, "release", "all", OLDEST), (goldens, "debug", "all")]
    else:
        jobs += [(script, "release", name) for name in names if name not in SLOW_GROUPS]
    jobs.sort(key=seconds_of, reverse=True)
    total = Group("all")
    shared = {}
    with multiprocessing.Pool() as pool:
        for printed, groups in pool.imap_unordered(perform, jobs):
            print(printed, end="", flush=True)
            for group in groups:
                if group.title in shared:
                    shared[group.title].add(group)
                else:
                    shared[group.title] = group
                if shared[group.title].shares == 1:
                    print(shared[group.title].line(), flush=True)
    for group in shared.values():
        total.add(group)

    line = f"{total.passed} passed, {total.failed} failed"
    with open(COUNT, "w", encoding="utf-8") as count:
        count.write(line + "\n")
    print(line, flush=True)
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], "--slow" in sys.argv))
