"""The tables of docs/verification.md that runs of some seconds give."""

import math
import os
import re

from numbers_in_text import FACTOR, Number, Phrase, Word, count, error, estimate, fixed, rough_error, rounding
from runs import Run, deck, largest

ANGLES = range(0, 360, 30)
TWELVE = (r"^CRANK.*", "CRANK 0 to 330 step 30")
NO_SHAPES = (r"^REPORT +shapes.*\n", "")
FIVE = (r"^MODES.*", "MODES 5")
TURN = 2*math.pi
# Rounding that differs between machines, measured on two kinds: 2.7e-14 and 2.0e-13 of the displacement u, 3e-14 and 5e-13 of the
# torque at 10 rad/s, whose mean is a small part of the torque.
U_ROUNDING = BALANCE_ROUNDING = 1e-12


def exact_values():
    """Speed and crank angle → exact f1 to f5 of the first mechanism."""
    values = {}
    with open(os.path.join("tests", "exact", "mechanism1.dat"), encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                speed, crank, *frequencies = (float(word) for word in line.split())
                values[speed, crank] = frequencies
    return values


def errors_against_exact(rows, modes=5):
    """The largest relative error of each mode over the rows with exact values."""
    exact = exact_values()
    worst = [0.0]*modes
    for row in rows:
        truth = exact.get((row["speed"], row["crank"]))
        if truth:
            worst = [max(old, abs(row[f"f{i + 1}"]/truth[i] - 1)) for i, old in enumerate(worst)]
    return worst


def errors_against(rows, references, modes=5):
    """The largest relative difference of each mode between two runs of the same rows."""
    assert len(rows) == len(references)
    return [max(abs(row[f"f{i}"]/reference[f"f{i}"] - 1) for row, reference in zip(rows, references)) for i in range(1, modes + 1)]


def largest_estimate(rows, modes=5):
    return max(largest(rows, f"error{i}") for i in range(1, modes + 1))


def orders_and_unknowns(log):
    """What run.log says of the orders chosen."""
    found = re.search(r"orders chosen[^:]*: ([\d, ]*\d)\D.*?(\d+) unknowns", log)
    return found[1], int(found[2])


def bending_of_deep_beam(n):
    """Frequency [Hz] of Timoshenko's beam on two pins, n half waves: 10 m of 2 m x 2 m, steel, Cowper's shear coefficient."""
    modulus, density, second_moment = 200e9, 8000, 16/12
    wave, mass = n*math.pi/10, density*4
    stiffness = 13/15.3*modulus/2.6*4
    a = density*second_moment*mass/stiffness
    b = mass + (density*second_moment + modulus*second_moment*mass/stiffness)*wave**2
    return math.sqrt((b - math.sqrt(b**2 - 4*a*modulus*second_moment*wave**4))/(2*a))/TURN


def solved(matrix, right):
    """The solution of linear equations, by elimination with pivots."""
    rows = [row + [value] for row, value in zip(matrix, right)]
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i, k=k: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, len(rows)):
            factor = rows[i][k]/rows[k][k]
            rows[i] = [a - factor*b for a, b in zip(rows[i], rows[k])]
    solution = [0.0]*len(rows)
    for k in reversed(range(len(rows))):
        solution[k] = (rows[k][-1] - sum(rows[k][i]*solution[i] for i in range(k + 1, len(rows))))/rows[k][k]
    return solution


def tip_stiffness(force):
    """Of a clamped massless strip, EI = L = 1, across its tip under a constant axial force."""
    z = math.sqrt(abs(force))
    return force/(1 - math.tanh(z)/z if force > 0 else 1 - math.tan(z)/z)


def mass_on_strip(speed, gravity, stiffness, samples=64):
    """Crank angle [deg] → displacements along and across a turning massless strip at its tip, with a mass there, and the
    curvature at its root: EI = L = m = 1, EA = stiffness. Hill's equations for both, at evenly spaced angles of a turn."""
    angles = [TURN*k/samples for k in range(samples)]

    def derivative(i, j):
        return 0 if i == j else 0.5*(-1)**(i - j)/math.tan(0.5*(angles[i] - angles[j]))

    def second(i, j):
        return -(samples**2 + 2)/12 if i == j else -0.5*(-1)**(i - j)/math.sin(0.5*(angles[i] - angles[j]))**2

    force = [speed**2 - gravity*math.sin(angle) for angle in angles]
    across = [tip_stiffness(value) for value in force]
    matrix, right = [], []
    for i, angle in enumerate(angles):
        matrix.append([speed**2*(second(i, j) - (i == j)) + stiffness*(i == j) for j in range(samples)] +
                      [-2*speed**2*derivative(i, j) for j in range(samples)])
        right.append(force[i])
    for i, angle in enumerate(angles):
        matrix.append([2*speed**2*derivative(i, j) for j in range(samples)] +
                      [speed**2*(second(i, j) - (i == j)) + across[i]*(i == j) for j in range(samples)])
        right.append(-gravity*math.cos(angle))
    found = solved(matrix, right)
    return {round(math.degrees(angle)): (found[i], found[samples + i], (across[i] - force[i])*found[samples + i])
            for i, angle in enumerate(angles) if i % (samples//4) == 0}


class Tables:
    """Every method without an underscore is the maker of the table of its name."""

    def __init__(self, program):
        self.program = program
        self.kept = {}

    def _run(self, text, *options):
        if (text, options) not in self.kept:
            self.kept[text, options] = Run(self.program, text, options)
        return self.kept[text, options]

    def _frequencies(self, text):
        return self._run(text).rows("frequencies")

    def thesis_mesh(self):
        exact = exact_values()
        for row in self._frequencies(deck("mechanism1")):
            if row["crank"] in ANGLES:
                truth = exact[0, row["crank"]]
                yield [Word(f"{row['crank']:.0f}°")] + [fixed(value, 6) for pair in zip((row["f1"], row["f2"], row["f3"]), truth)
                                                        for value in pair]

    def _converging(self, modes, *changes):
        for n in (4, 8, 16, 32):
            rows = self._frequencies(deck("mechanism1", FIVE, TWELVE, NO_SHAPES, (r"elements=[14]", f"elements={n}"), *changes))
            yield n, errors_against_exact(rows, modes)

    def convergence(self):
        before = None
        for n, errors in self._converging(5):
            orders = [fixed(math.log2(old/new), 2) for old, new in zip(before or [], errors)]
            yield [Word(n)] + [error(value) for value in errors] + [Phrase(", ".join(["{}"]*len(orders)), orders)]
            before = errors

    def convergence_moving(self):
        kinds = [list(self._converging(3, (r"static", "axial"), (r"lumped", kind))) for kind in ("distributed", "lumped")]
        for (n, distributed), (_, lumped) in zip(*kinds):
            yield [Word(n)] + [error(value) for value in distributed + lumped]

    def kitis(self):
        row = self._frequencies(deck("kitis"))[0]
        yield [Word("published"), Word("270.380"), Word("306.864"), Word("384.395")]
        yield [Word("here")] + [fixed(TURN*row[f"f{i}"], 4) for i in (1, 2, 3)]

    def second_mechanism(self):
        for row in self._frequencies(deck("mechanism2")):
            if row["crank"] == 0:
                yield [Word(f"{row['speed']:.0f} rad/s")] + [fixed(row[f"f{i}"], 5) for i in (1, 2, 3)]

    def accuracies(self):
        for accuracy in ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"):
            run = self._run(deck("exact", NO_SHAPES, (r"accuracy=\S+", f"accuracy={accuracy}")))
            rows = run.rows("frequencies")
            orders, unknowns = orders_and_unknowns(run.log)
            yield [Word(accuracy), Word(orders), count(unknowns)] + [error(value) for value in errors_against_exact(rows)] + \
                [estimate(largest_estimate(rows))]

    def thick_links(self):
        def thick(accuracy):
            return self._run(deck("thick", NO_SHAPES, (r"^REPORT +inertia.*\n", ""), (r"accuracy=\S+", f"accuracy={accuracy}")))
        best = thick("1e-13").rows("frequencies")
        for accuracy in ("1e-2", "1e-6", "1e-10", "1e-12"):
            run = thick(accuracy)
            rows = run.rows("frequencies")
            yield [Word(f"accuracy={accuracy}"), count(orders_and_unknowns(run.log)[1])] + \
                [error(value) for value in errors_against(rows, best)] + [estimate(largest_estimate(rows))]

    def effects_of_thickness(self):
        def thinner(n, words):
            text = deck("thick", NO_SHAPES, (r"^REPORT +inertia.*\n", ""), (r"^PINMASS.*\n", ""), (r"^SPEED.*\n", ""),
                        (r"accuracy=\S+", "accuracy=1e-13"), (r"^EFFECTS.*", f"EFFECTS static {words}"))
            return re.sub(r"\b(thickness|outer|inner|diameter)=(\d+)", lambda found: f"{found[1]}={int(found[2])/n!r}", text)
        for n in (1, 10, 100, 1000):
            slender = self._frequencies(thinner(n, ""))
            cells = [Word(n)]
            for words in ("rotary", "shear", "rotary shear"):
                fall = errors_against(self._frequencies(thinner(n, words)), slender)
                cells += [error(fall[0]), error(fall[4])]
            yield cells

    def rotating_beam(self):
        published = {0: "3.5160", 2: "4.1373", 4: "5.5850", 6: "7.3604", 8: "9.2568", 10: "11.2023"}
        for row in self._frequencies(deck("rotating")):
            if row["crank"] == 0:
                speed = round(row["speed"])
                yield [Word(speed), Word(published[speed])] + [fixed(TURN*row[f"f{i}"], 6) for i in (1, 2, 3)]

    def deep_beam(self):
        closed = (bending_of_deep_beam(1), 125, bending_of_deep_beam(2), bending_of_deep_beam(3), 375)
        row = self._frequencies(deck("deep_beam"))[0]
        for i in range(1, 6):
            yield [None, fixed(closed[i - 1], 6), None, None, fixed(row[f"f{i}"], 6)]

    def forward_dynamics(self):
        links = "".join(line + "\n" for line in deck("mechanism1").splitlines()
                        if re.match(r"(UNITS|MATERIAL|SECTION|GROUND|LINK|DRIVE)\b", line)) + "INERTIA distributed\n"
        rocker = links.replace("length=279.4", "length=80").replace("length=100 ", "length=200 ")
        motion = "REPORT motion crank=60 speed=20 end={} step={}\n"
        for name, crank, text in (("crank-rocker, free", 100, links + motion.format(420, 0.42)),
                                  ("double rocker, free", 200, rocker + motion.format(100, 0.1)),
                                  ("double rocker under gravity", 200, rocker + "GRAVITY 0 -9810\n" + motion.format(100, 0.1))):
            run = self._run(text, "--stats")
            rows = run.rows("motion")
            start = rows[0]["kinetic"] + rows[0]["potential"]
            # Steps follow the rounding of many turns: the same on machines of a kind only.
            steps = int(re.search(r"steps of forward motion (\d+)", run.errors)[1])
            yield [Word(name), Number(steps, ",.0f", 1.01), rough_error(largest(rows, "energy_error")/start),
                   Number(largest(rows, "closure")/crank, ".1e", FACTOR)]

    def exact_response(self):
        closed = mass_on_strip(1, 2, 1e4)
        with open(os.path.join("tests", "documents", "mass_on_strip.deck"), encoding="utf-8") as file:
            run = self._run(file.read())
        here = {}
        for row in run.rows("response"):
            if row["point"] == "A:strip":
                angle = math.radians(row["crank"])
                here[round(row["crank"])] = (math.cos(angle)*row["ux"]/1000 + math.sin(angle)*row["uy"]/1000,
                                             math.cos(angle)*row["uy"]/1000 - math.sin(angle)*row["ux"]/1000, row["error"])
        bent = {round(row["crank"]): (row["bending_strain"], row["error"]) for row in run.rows("strains")}
        u, v = ([(closed[angle][i], here[angle][i], here[angle][2]) for angle in closed] for i in (0, 1))
        scale = max(math.hypot(*values[:2]) for values in closed.values())
        yield self._exact("u at 90°", scale, u, 1, U_ROUNDING)
        yield self._exact("u at 270°", scale, u, 3, U_ROUNDING)
        yield self._exact("v at 0°", scale, v)
        kappa = [(closed[angle][2], *bent[angle]) for angle in closed]
        yield self._exact("κ at the root, 0°", max(abs(values[2]) for values in closed.values()), kappa)

    @staticmethod
    def _exact(what, scale, values, shown=0, bound=0):
        """A row of the table: one of the values, and the largest error of all of them, which is rounding below a bound."""
        return [Word(what), Number(values[shown][0], ".12f"), Number(values[shown][1], ".12f", off=values[0][2]*abs(scale)),
                rounding(max(abs(here - closed) for closed, here, _ in values)/abs(scale), bound), estimate(values[0][2])]

    def critical_speed(self):
        """Hill's equations of the mass on a strip under hardly any gravity have constant coefficients: D(w) x = f."""
        gravity, stiffness, low, high = 1e-6, 1e4, 1.5, 2.5
        for _ in range(100):
            speed = 0.5*(low + high)
            left = (tip_stiffness(speed**2) - 2*speed**2)*(stiffness - 2*speed**2) - 4*speed**4
            low, high = (speed, high) if left > 0 else (low, speed)
        z = (2j*speed**2, stiffness - 2*speed**2)
        work = abs(z[0].conjugate()*1j*gravity - z[1]*gravity)
        slope = abs(-2*speed*(abs(z[0])**2 + z[1]**2) + 2*(z[0].conjugate()*-2j*speed*z[1]).real)
        growth = TURN/speed*z[1]*work/slope
        with open(os.path.join("tests", "documents", "mass_on_strip.deck"), encoding="utf-8") as file:
            text = file.read()
        for old, new in ((r"density=1e-25", "density=1e-12"), (r"GRAVITY  0 -2", f"GRAVITY  0 -{gravity}"), (r"GAUGE.*\n", ""),
                         (r"CRANK.*", "MODES    1"),
                         (r"SPEED .*", "SPEED    1.5 2.5"), (r"REPORT   response.*", "REPORT   campbell accuracy=1e-9"),
                         (r"REPORT   strains\n", "")):
            text = re.sub(old, new, text)
        row, = self._run(text).rows("critical")
        yield [Word("critical speed"), Number(speed, ".12f"), Number(row["speed"], ".12f", off=row["speed_error"]*speed), error(abs(row["speed"]/speed - 1), 1e-9),
               estimate(row["speed_error"])]
        yield [Word("excitation"), Number(growth, ".8e"), Number(row["excitation"]/1000, ".8e", off=row["error"]*growth),
               error(abs(row["excitation"]/1000/growth - 1), 1e-9), estimate(row["error"])]

    def _stability(self, *changes):
        return self._run(deck("stability", *changes))

    def exponents(self):
        """The slowest exponents at 20 rad/s, without and with damping."""
        one_speed = ((r"^SPEED .*", "SPEED 20"), (r"^REPORT +intervals.*", ""), (r"^REPORT +stability.*", "REPORT stability accuracy=1e-8"))
        undamped = self._stability(*one_speed).rows("stability")
        damped = self._stability(*one_speed, (r"^MODES.*", "MODES 3\nDAMPING * time=1e-4")).rows("stability")
        for one, other in zip(undamped, damped):
            yield [Word(f"{one['mode']:.0f}"), Number(one["turns"], ".11f", off=one["error"]/TURN), estimate(one["error"]),
                   Number(other["turns"], ".11f", off=other["error"]/TURN), Number(other["growth"], ".8f", off=other["error"]),
                   estimate(other["error"])]

    def intervals(self):
        for row in self._stability((r"^SPEED .*", "SPEED 52.5 53.1"), (r"^REPORT +stability.*", "")).rows("intervals"):
            modes = row["modes"]
            yield [Word(modes if isinstance(modes, str) else f"{modes:.0f}"), Word(row["kind"]), *(Number(row[end], ".5f", off=row["error"]) for end in ("from", "to")), estimate(row["error"]),
                   Number(row["largest_growth"], ".5e", off=row["growth_error"]), estimate(row["growth_error"])]

    def _response(self, accuracy, *changes):
        return self._run(deck("response", (r"^(REPORT +\w+).*", rf"\1 accuracy={accuracy}"), *changes))

    def first_mechanism_response(self):
        run = self._response("1e-8")
        strain = {(row["gauge"], row["crank"]): row for row in run.rows("strains")}
        place = {(row["point"], row["crank"]): row for row in run.rows("response")}
        for what, value, off in (
                *((f"bending strain, {gauge.replace('_', '-')}, 60°",
                   strain[gauge, 60]["bending_strain"], strain[gauge, 60]["error"]) for gauge in ("mid_coupler", "mid_follower")),
                ("B, x, 0° [m]", place["B:coupler", 0]["ux"]/1000, place["B:coupler", 0]["error"]),
                ("B, y, 0° [m]", place["B:coupler", 0]["uy"]/1000, place["B:coupler", 0]["error"])):
            yield [Word(what), Number(value, ".10e", off=off*abs(value)), None, estimate(off)]

    def response_accuracies(self):
        """Largest error and estimate of each table: of every quantity by its largest value over the turn."""
        tables = {"strains": ("gauge", [("axial_strain",), ("bending_strain",), ("shear_force",)]),
                  "response": ("point", [("ux", "uy"), ("rotation",)]),
                  "torque": ("speed", [("rigid",), ("linear",), ("quadratic",), ("total",)])}

        def error_of(rows, references, columns):
            def length(values):
                return math.hypot(*values)
            largest_value = max(length([row[name] for name in columns]) for row in references)
            return max(length([row[name] - other[name] for name in columns]) for row, other in zip(rows, references))/largest_value

        best = self._response("1e-10")
        for accuracy in ("1e-2", "1e-4", "1e-6", "1e-8"):
            run, cells = self._response(accuracy), []
            for table, (key, quantities) in tables.items():
                rows, references = run.rows(table), best.rows(table)
                errors = [error_of(*([row for row in some if row[key] == one] for some in (rows, references)), columns)
                          for one in {row[key] for row in rows} for columns in quantities]
                cells += [error(max(errors)), estimate(largest(rows, "error"))]
            order, samples = re.search(r"polynomials of order (\d+).*?(\d+) crank angles", run.files["torque.dat"]).groups()
            yield [Word(accuracy), Word(order), Word(samples)] + cells

    def torque_balance(self):
        run = self._response("1e-10", (r"^UNITS.*", "UNITS mm tonne s torque=N*m"), (r"^CRANK.*", "CRANK 0 to 359 step 1"),
                             (r"^SPEED.*", "SPEED 10 20 30 40 rad/s"))
        drive, peaks = run.rows("torque"), run.rows("peaks")
        for speed in (10, 20, 30, 40):
            rows = [row for row in drive if row["speed"] == speed]
            linear, quadratic = (sum(row[part] for row in rows)/len(rows) for part in ("linear", "quadratic"))
            lost = sum(row["power"] for row in peaks if row["speed"] == speed)
            difference = abs((linear + quadratic)*speed/lost - 1)
            yield [Word(speed), Number(linear, ".6e"), Number(quadratic, ".6e"), Number(lost/speed, ".6e"),
                   rounding(difference, BALANCE_ROUNDING) if speed == 10 else rough_error(difference)]

    def validity_by_speed(self):
        rows = self._response("1e-6", (r"^SPEED.*", "SPEED 5 10 20 30 rad/s")).rows("validity")
        for speed in (5, 10, 20, 30):
            here = [row for row in rows if row["speed"] == speed]
            yield [Word(speed), *(Number(largest(here, name), ".1e") for name in ("deflection", "load", "quadratic")),
                   fixed(here[0]["out_of_plane"], 1)]

    def omitted_terms(self):
        """Largest change of the strain in mid-link over the turn, by the largest value."""
        def strains(*changes):
            rows = self._response("1e-6", (r"^SPEED.*", "SPEED 20 50 rad/s"), *changes).rows("strains")
            return {(row["speed"], row["gauge"], row["crank"]): row["bending_strain"] for row in rows}
        whole = strains()
        for term in ("coriolis", "centripetal", "axial"):
            less = strains((r"^DRIVE.*", f"\\g<0>\nEFFECTS response without={term}"))
            yield [Word(f"`{term}`")] + [
                Number(max(abs(less[key] - whole[key]) for key in whole if key[:2] == place)/
                       max(abs(value) for key, value in whole.items() if key[:2] == place), ".1e")
                for place in ((20, "mid_coupler"), (20, "mid_follower"), (50, "mid_coupler"), (50, "mid_follower"))]
