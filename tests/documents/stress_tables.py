"""The table and the counts of docs/stability.md that `make stress` gives: from its tables in outputs/stress/."""

import os
from glob import glob

from numbers_in_text import Leading, Word, count, error

FOLDER = os.path.join("outputs", "stress")

SENTENCES = (
    ("docs/stability.md", "{} rows: {} bounded, {} refused, {} failed rows with a reason, no defect", "stress_counts"),
)


def verdicts():
    """Family → verdict → error and estimate of every row."""
    found = {}
    for path in sorted(glob(os.path.join(FOLDER, "*.dat"))):
        rows = found.setdefault(os.path.splitext(os.path.basename(path))[0], {})
        with open(path, encoding="utf-8") as file:
            for line in file:
                if not line.startswith("#"):
                    words = line.split()
                    rows.setdefault(words[9], []).append(words[5:7])
    if not found:
        raise ValueError("nothing was run yet; say: make stress")
    return found


class Tables:
    """Every method without an underscore is the maker of the table or sentence of its name."""

    def __init__(self, _):
        pass

    def stress_families(self):
        with open(os.path.join("docs", "stability.md"), encoding="utf-8") as file:
            document = file.read()
        # In the order of the document.
        for family, rows in sorted(verdicts().items(), key=lambda item: document.find(f"| `{item[0]}`")):
            numbers = [len(rows.get(verdict, [])) for verdict in ("bounded", "refused", "failed-row")]
            worst = [max(float(row[i]) for row in rows["bounded"]) for i in (0, 1)]
            yield [Word(f"`{family}`"), None] + [Word(number or "–") for number in numbers] + [Leading(error(value)) for value in worst]

    def stress_counts(self):
        rows = verdicts().values()
        numbers = [sum(len(of.get(verdict, [])) for of in rows) for verdict in ("bounded", "refused", "failed-row")]
        return [count(number) for number in [sum(numbers)] + numbers]
