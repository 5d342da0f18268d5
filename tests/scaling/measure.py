#!/usr/bin/env python3
"""Measures how a study scales: what its tasks take, several ranks on this machine, a farm of sleeping ranks and its model.

    measure.py [--pairs N] [--write]     --write puts the tables into docs/scaling.md, behind their lines `<!-- measured: NAME -->`

Runs from the root of the checkout, on what `make scaling` has built; everything else goes to outputs/scaling/. Times here are wall
time, of runs that take turns, and their ratios are of neighbours.
"""

import argparse
import filecmp
import os
import re
import statistics
import subprocess
import time

import farm

OUT = os.path.join("outputs", "scaling")
DOCUMENT = os.path.join("docs", "scaling.md")
ALONE = os.path.join("build", "release", "flexmech")
RANKS = os.path.join("build", "mpi", "flexmech")
RECORD = os.path.join("build", "scaling", "record_tasks")
SLEEPING = os.path.join("build", "scaling", "sleeping_ranks")
VARIANTS = 10001
SLOWER = 5  # times as long a sleeping rank sleeps: sleeps are not exact
# Root may, and ranks may be more than processors (Open MPI).
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1")
STUDIES = (("frequencies", "REPORT   frequencies"), ("summary", "REPORT   summary of=f1,f2,f3"))


def deck_of(name, report):
    """The thousand lengths of tests/bench/variants.deck, ten times as many, with another report."""
    with open(os.path.join("tests", "bench", "variants.deck"), encoding="utf-8") as deck:
        text = deck.read()
    text = re.sub(r"^VARY .*", f"VARY     L 270 to 280 step {10/(VARIANTS - 1):g}", text, flags=re.MULTILINE)
    text = re.sub(r"^REPORT .*", report, text, flags=re.MULTILINE)
    path = os.path.join(OUT, name + ".deck")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(text)
    return path


def timed(command):
    start = time.perf_counter()
    subprocess.run(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL, check=True)
    return time.perf_counter() - start


def run(deck, ranks=None, threads=1):
    out = os.path.join(OUT, "run" if ranks is None and threads == 1 else "other")
    command = [ALONE] if ranks is None else ["mpirun", "-n", str(ranks), RANKS]
    took = timed(command + ["--quiet", "--threads", str(threads), "--out", out, deck])
    return took, os.path.join(out, os.path.splitext(os.path.basename(deck))[0])


def processes(pairs):
    """Several ranks, and threads, against one process; in turn."""
    yield "study", "processes", "time [s]", "times as fast", "efficiency per core"
    cores = os.cpu_count()
    for name, report in STUDIES:
        deck = deck_of(name, report)
        ways = (("one process, 2 threads", None, 2), ("1 rank", 1, 1), ("2 ranks", 2, 1), ("4 ranks", 4, 1))
        took, ratio, ones = {way[0]: [] for way in ways}, {way[0]: [] for way in ways}, []
        for _ in range(pairs):
            for label, ranks, threads in ways:
                one, folder = run(deck)
                ones.append(one)
                other, folder_of_other = run(deck, ranks, threads)
                _, different, missing = filecmp.cmpfiles(folder, folder_of_other, os.listdir(folder), shallow=False)
                if different or missing:
                    raise SystemExit(f"not the same bytes: {different + missing}")
                took[label].append(other)
                ratio[label].append(one/other)
        yield name, "one process", f"{statistics.median(ones):.2f}", "1", "1"
        for label, ranks, threads in ways:
            speed = statistics.median(ratio[label])
            yield name, label, f"{statistics.median(took[label]):.2f}", f"{speed:.2f}", f"{speed/min(cores, (ranks or 1)*threads):.2f}"


def records():
    """What the tasks of a study take."""
    yield "study", "computing a variant", "bytes", "writing it", "ranks that the leader can serve"
    for name, report in STUDIES:
        deck = deck_of(name, report)
        subprocess.run([RECORD, deck, os.path.join(OUT, "recorded"), record_of(name)], check=True)
        computing, size, writing = farm.read_record(record_of(name))
        mean = [sum(values)/len(values) for values in (computing, size, writing)]
        yield (name, f"{mean[0]*1e3:.2f} ms", f"{mean[1]:.0f}", f"{mean[2]*1e6:.1f} µs",
               f"{mean[0]/(mean[2] + mean[1]/1e10):.0f}")


def record_of(name):
    return os.path.join(OUT, name + ".record")


def sleepers():
    """The model against ranks that sleep as long as tasks take, with the scheduler as it is."""
    yield "ranks", "time [s], sleeping ranks", "time [s], model"
    tasks = farm.read_record(record_of("frequencies"))
    for ranks in (1, 2, 4, 8, 16, 32):
        said = subprocess.run(["mpirun", "-n", str(ranks), SLEEPING, record_of("frequencies"), str(SLOWER)], env=ENVIRONMENT,
                              stdout=subprocess.PIPE, text=True, check=True).stdout.split()
        model, _ = farm.farm(tasks, ranks, 2e-6, 1e10, len(tasks[0]))
        yield str(ranks), f"{float(said[1]):.3f}", f"{model:.3f}"


def model():
    """Speed of a farm by the model: a hundred times the variants of the record."""
    yield ("ranks",) + tuple(f"{name}: {what}" for name, _ in STUDIES for what in ("times as fast", "efficiency", "leader serves"))
    tasks = [[part*10 for part in farm.read_record(record_of(name))] for name, _ in STUDIES]
    one = [None]*len(tasks)
    for ranks in (1, 2, 4, 16, 64, 128, 256, 512, 1000):
        row = [str(ranks)]
        for i, task in enumerate(tasks):
            took, serving = farm.farm(task, ranks, 2e-6, 1e10)
            one[i] = one[i] or took
            row += [f"{one[i]/took:.1f}", f"{one[i]/took/ranks:.2f}", f"{100*serving/took:.0f} %"]
        yield tuple(row)


def table(rows):
    rows = list(rows)
    lines = ["| " + " | ".join(rows[0]) + " |", "|" + "---|"*len(rows[0])]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows[1:]])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    os.makedirs(OUT, exist_ok=True)
    tables = {"records": table(records()), "processes": table(processes(options.pairs)), "sleepers": table(sleepers()),
              "model": table(model())}
    for name, text in tables.items():
        print(f"{name}\n{text}\n", flush=True)
    if not options.write:
        return
    with open(DOCUMENT, encoding="utf-8") as document:
        text = document.read()
    for name, new in tables.items():
        text = re.sub(rf"(<!-- measured: {name} -->\n\n?)(?:\|.*\n)*", lambda found, new=new: found[1] + new + "\n", text)
    with open(DOCUMENT, "w", encoding="utf-8") as document:
        document.write(text)


if __name__ == "__main__":
    main()
