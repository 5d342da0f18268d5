#!/usr/bin/env python3
"""Error columns of REPORT stability and campbell on random four-bars.

    estimates_running.py SEED COUNT --program PATH [--scratch DIR]

Every case is run at a loose accuracy and compared, row by row, with the same linkage at an accuracy finer by 1e4, with one mode
more, rotated, and mirrored with its crank turning the other way. A difference above the sum of both printed errors is a failure;
so are a crash and a number that is none. Failed rows are allowed and counted. The distribution of estimated by true error (against the
finer run, where this is ten times better) is printed before the count.
"""

import argparse
import math
import os
import random
import shutil
import subprocess
import sys


def deck(case, report, accuracy, modes, turn=0.0, mirrored=False):
    """The deck of a case, turned by an angle or mirrored."""
    ground = case["ground"]
    sign = -1.0 if mirrored else 1.0
    c, s = math.cos(turn), math.sin(turn)

    def components(x, y):
        y *= sign
        return f"{c*x - s*y:.15g} {s*x + c*y:.15g}"

    lines = ["UNITS m kg s", f"MATERIAL steel E=2.1e11 density={case['density']}"]
    for i, (thick, width) in enumerate(case["sections"]):
        lines.append(f"SECTION s{i} rectangle thickness={thick} width={width}")
    lines += ["GROUND O2 0 0", "GROUND O4 " + components(ground, 0.0)]
    for i, (name, pins) in enumerate((("crank", "O2 A"), ("coupler", "A B"), ("follower", "O4 B"))):
        lines.append(f"LINK {name} {pins} length={case['lengths'][i]} material=steel section=s{i}")
    lines += ["DRIVE crank", f"BRANCH {'crossed' if case['open'] == mirrored else 'open'}"]
    if case["pin"]:
        lines.append(f"PINMASS B {case['pin']}")
    if case["damping"]:
        lines.append(f"DAMPING * {case['damping']}")
    if case["force"]:
        lines.append("FORCE B " + components(*case["force"]))
    speeds = " ".join(f"{sign*case['sense']*speed:.12g}" for speed in case["speeds"])
    lines += [f"SPEED {speeds}", f"MODES {modes}", f"REPORT {report} accuracy={accuracy:g}", "END"]
    return "\n".join(lines) + "\n"


def random_case(draw, report):
    """A crank-rocker with heavy or light links, damped or not."""
    while True:
        crank = 10**draw.uniform(-1.3, -0.8)
        rest = [crank*draw.uniform(1.3, 4.0) for _ in range(3)]
        if crank + max(rest) < 0.97*(sum(rest) - max(rest)):
            break
    lengths = [float(f"{x:.6g}") for x in (crank, rest[0], rest[1])]
    density = float(f"{10**draw.uniform(3.3, 4.0):.5g}")
    sections = [(float(f"{x*10**draw.uniform(-2.3, -1.3):.5g}"), float(f"{0.1*x:.5g}")) for x in lengths]
    slowest = min((math.pi/x)**2*t/math.sqrt(12)*math.sqrt(2.1e11/density) for x, (t, _) in zip(lengths, sections))
    mass = density*sum(x*t*w for x, (t, w) in zip(lengths, sections))
    speed = slowest/draw.uniform(4.0, 14.0)
    case = {"ground": float(f"{rest[2]:.6g}"), "lengths": lengths, "sections": sections, "density": density,
            "pin": draw.choice((0, float(f"{mass*10**draw.uniform(-1.5, 0):.4g}"))), "open": draw.random() < 0.5,
            "sense": draw.choice((1, -1)),
            "damping": draw.choice(("", f"ratio={10**draw.uniform(-3, -1):.4g}", f"time={10**draw.uniform(-3, -1)/slowest:.4g}")),
            "force": draw.choice((None, (float(f"{mass*20*draw.uniform(-1, 1):.4g}"), float(f"{mass*20*draw.uniform(-1, 1):.4g}")))),
            "speeds": [float(f"{speed:.8g}")] if report == "stability" else [float(f"{speed:.8g}"), float(f"{speed*1.15:.8g}")]}
    return case


def run(program, folder, name, text, table):
    """Exit status and rows of a table as lists of words, those of its head left out."""
    path = os.path.join(folder, name + ".deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    try:
        status = subprocess.run([program, "--quiet", "--threads", "1", "--out", folder, path], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, timeout=10, check=False).returncode
    except subprocess.TimeoutExpired:
        return None, []
    try:
        with open(os.path.join(folder, name, table), encoding="utf-8") as file:
            return status, [line.split() for line in file if line.strip() and not line.startswith("#")]
    except FileNotFoundError:
        return status, []


def wrapped(x):
    """Turns are known but for sense and whole turns."""
    x = abs(x - round(x))
    return x


def stability_differences(one, other):
    """(name, difference, error, other error) of rows with the same mode."""
    them = {row[1]: row for row in other}
    for row in one:
        match = them.get(row[1])
        if match is None:
            continue
        error, other_error = float(row[6]), float(match[6])
        if max(error, other_error) > 0.1:  # no digits, the verdict says so
            continue
        yield "growth", abs(float(row[3]) - float(match[3])), error, other_error
        yield "turns", 2*math.pi*wrapped(float(row[2]) - float(match[2])), error, other_error


def critical_differences(one, other, case):
    """The same of critical speeds, as pairs that are near each other: of one line and mode, or where vibrations mix, and rows may name
    either, within the errors. None may be missing inside."""
    damped = bool(case["damping"])
    largest = max([float(row[5]) for row in one + other], default=0.0)
    low, high = sorted(abs(x) for x in (case["speeds"][0], case["speeds"][-1]))
    left = list(other)
    for row in one:
        speed, error = abs(float(row[0])), float(row[1])

        def apart(match):
            return abs(abs(float(match[0])) - speed)/speed

        found = [match for match in left if apart(match) <= (0.02 if match[2] == row[2] else error + float(match[1]))]
        if not found:
            inside = low*(1 + 2*error + 1e-6) < speed < high*(1 - 2*error - 1e-6)
            if inside and float(row[5]) > 0.05*largest:
                yield f"missing {speed:.6g}", 1.0, 0.0, 0.0
            continue
        match = min(found, key=apart)
        left.remove(match)
        yield "speed", apart(match), error, float(match[1])
        if apart(match) > 1e-3:  # they are those at the speeds written
            continue
        for column, name in ((5, "excitation"), (6, "amplitude"))[:2 if damped else 1]:
            a, b = float(row[column]), float(match[column])
            yield name, abs(a - b), abs(a)*float(row[-1]), abs(b)*float(match[-1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scratch", default="outputs/estimates_running")
    parser.add_argument("--report", choices=("stability", "campbell", "both"), default="both")
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    passed = failed = rows = fails = 0
    ratios = {}
    for number in range(arguments.count):
        report = arguments.report if arguments.report != "both" else ("stability", "campbell")[number % 2]
        draw = random.Random(f"{arguments.seed} {number} {report}")
        case = random_case(draw, report)
        folder = os.path.join(arguments.scratch, f"{report}_{number}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        table = "stability.dat" if report == "stability" else "critical.dat"
        modes = draw.choice((1, 2, 3)) if report == "stability" else 1
        accuracy = 10.0**draw.choice((-2, -3))
        runs = {"plain": deck(case, report, accuracy, modes), "finer": deck(case, report, accuracy*1e-4, modes),
                "more_modes": deck(case, report, accuracy, modes + 1), "rotated": deck(case, report, accuracy, modes, turn=1.1),
                "mirrored": deck(case, report, accuracy, modes, mirrored=True)}
        reasons = []
        found = {}
        for name, text in runs.items():
            status, found[name] = run(arguments.program, folder, name, text, table)
            if status is not None and status not in (0, 1):
                reasons.append(f"{name}: exit status {status}")
            fails += status != 0
            if any(word.lower() in ("nan", "infinity") for row in found[name] for word in row):
                reasons.append(f"{name}: no number")
        plain = found["plain"]
        rows += len(plain)
        for name in list(runs)[1:]:
            other = found[name]
            if report == "campbell" and name == "more_modes":
                lists = critical_differences(plain, other, case) if other else []
                lists = [item for item in lists if not item[0].startswith("missing")]
            elif report == "campbell":
                lists = critical_differences(plain, other, case) if other or plain else []
                if found[name] == [] or plain == []:
                    lists = []
            else:
                lists = stability_differences(plain, other)
            for what, difference, error, other_error in lists:
                if difference > (error + other_error)*(1 + 1e-9):
                    reasons.append(f"{name}: {what} differs by {difference:.2e}, errors {error:.1e} and {other_error:.1e}")
                if name == "finer" and difference > 10*other_error and difference > 0:
                    ratios.setdefault(f"{report} {what.split()[0]}", []).append(error/difference)
        if reasons:
            failed += 1
            print(f"not ok {report} {number}: " + "; ".join(reasons[:4]), flush=True)
        else:
            passed += 1
        if not (reasons or arguments.keep):
            shutil.rmtree(folder)
    print(f"{rows} rows, {fails} runs with failed rows or no end")
    for name, values in sorted(ratios.items()):
        values.sort()
        print(f"estimated/true, {name}: {len(values)}, least {values[0]:.3g}, 10 % below {values[len(values)//10]:.3g}, "
              f"half below {values[len(values)//2]:.3g}, 90 % below {values[9*len(values)//10]:.3g}")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
