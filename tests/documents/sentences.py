"""Sentences of the documents with numbers that runs of some seconds give."""

import verification_tables as verification
from numbers_in_text import Number, error, fixed, rough_error
from runs import deck

VERIFICATION = "docs/verification.md"

# Document, words with {} for the numbers, and what computes them.
SENTENCES = (
    (VERIFICATION, "the largest errors of f1, f2, f3 and f5 are {}, {}, {} and {}.", "thesis_errors"),
    (VERIFICATION, "the first two frequencies change by {} to {} % over the cycle and the third by less than {} %", "speed_changes"),
    (VERIFICATION, "the estimate is at most {} times the error, and at most {} times where the error is below 1e-5",
     "largest_overestimates"),
    (VERIFICATION, "With four cubic elements a link SOLVER dense and band agree with deformation coordinates to {}, with thirty, "
     "where these run along the links, to {}", "nodal_thick_links"),
    (VERIFICATION, "The nodal solvers agree with each other to {} and with deformation coordinates to {}", "solvers"),
    ("docs/theory.md", "One element of order 14 in each link gives the first five frequencies to about {}.", "order_14"),
    ("inputs/thick.deck", "their frequencies ! at 0 degrees are {} to {} % higher.", "slender_excess"),
    ("inputs/kitis.deck", "{} {} {} rad/s, that is {} {} {} Hz.", "kitis_frequencies"),
)


def with_solver(name, solver, *changes):
    return deck(name, *changes).replace("\nEND", f"\nSOLVER {solver}\nEND")


class Numbers(verification.Tables):
    """Every method defined here is the maker of a sentence's numbers; tables are those of the class above."""

    def thesis_errors(self):
        worst = verification.errors_against_exact(self._frequencies(deck("mechanism1", verification.FIVE)))
        return [error(worst[i]) for i in (0, 1, 2, 4)]

    def speed_changes(self):
        rows = self._frequencies(deck("mechanism2"))
        rest, moving = ([row for row in rows if abs(row["speed"] - speed) < 1e-9] for speed in (0, 20))
        changes = [[100*(b[f"f{i}"]/a[f"f{i}"] - 1) for a, b in zip(rest, moving)] for i in (1, 2, 3)]
        lower, upper = min(changes[0] + changes[1]), max(changes[0] + changes[1])
        # Less than this, in steps of a half.
        bound = 0.5*int(2*max(map(abs, changes[2])) + 1)
        return [Number(lower, ".0f"), Number(upper, "+.0f"), fixed(bound, 1)]

    def largest_overestimates(self):
        """Estimate by error, row by row, where the error is above 1e-13."""
        exact = verification.exact_values()
        found = []
        for accuracy in ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"):
            for row in self._frequencies(deck("exact", verification.NO_SHAPES, (r"accuracy=\S+", f"accuracy={accuracy}"))):
                for i, true in enumerate(exact.get((row["speed"], row["crank"]), []), 1):
                    off = abs(row[f"f{i}"]/true - 1)
                    assert off <= row[f"error{i}"], row
                    if off > 1e-13:
                        found.append((off, row[f"error{i}"]/off))
        return [fixed(max(ratio for _, ratio in found), 0), fixed(max(ratio for off, ratio in found if off < 1e-5), 1)]

    def nodal_thick_links(self):
        found = []
        for elements in (4, 30):
            changes = (verification.NO_SHAPES, (r"^REPORT +inertia.*\n", ""), (r"accuracy=\S+", f"elements={elements}"))
            best = self._frequencies(deck("thick", *changes))
            found.append(max(max(verification.errors_against(self._frequencies(with_solver("thick", solver, *changes)), best))
                             for solver in ("dense", "band")))
        return [rough_error(value) for value in found]

    def solvers(self):
        solved = {solver: self._frequencies(with_solver("mechanism1", solver))
                  for solver in ("deformation", "dense", "band")}
        nodal = max(verification.errors_against(solved["dense"], solved["band"], 3))
        others = max(verification.errors_against(solved["dense"], solved["deformation"], 3))
        return [rough_error(nodal), rough_error(others)]

    def order_14(self):
        rows = self._frequencies(deck("exact", verification.NO_SHAPES, (r"^MESH.*", "MESH * elements=1 order=14")))
        return [Number(max(verification.errors_against_exact(rows)), ".0e", 10)]

    def slender_excess(self):
        """By how much the lowest frequencies rise if the links are taken as slender; at rest and moving."""
        slender, stout = (self._frequencies(deck("thick", verification.NO_SHAPES, (r"^CRANK.*", "CRANK 0"), (r"^EFFECTS.*", f"EFFECTS {words}")))
                          for words in ("axial", "axial rotary shear"))
        rises = [100*(a[f"f{i}"]/b[f"f{i}"] - 1) for a, b in zip(slender, stout) for i in range(1, 6)]
        return [fixed(min(rises), 1), fixed(max(rises), 1)]

    def kitis_frequencies(self):
        row = self._frequencies(deck("kitis"))[0]
        # The published ones were read off a plot to 0.002 rad/s.
        return [Number(verification.TURN*row[f"f{i}"], ".3f", 1 + 1e-5) for i in (1, 2, 3)] + [fixed(row[f"f{i}"], 4) for i in (1, 2, 3)]
