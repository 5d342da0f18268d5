"""Tables of what `compare_accuracies.py` found."""

import math
import re

QUANTILES = (0, 1, 10, 50, 90, 99, 100)


class Ratios:
    """The estimated error of a frequency over the true one, by kind of deck and by decade of the error."""

    def __init__(self):
        self.by_kind, self.by_decade = {}, {}

    def add(self, kind, estimate, true):
        ratio = float(estimate/true)
        self.by_kind.setdefault(kind, []).append(ratio)
        self.by_decade.setdefault(math.floor(math.log10(float(true))), []).append(ratio)

    def lines(self):
        yield "# estimated/true error of the frequencies whose true error clearly exceeds the estimate of the reference"
        yield f"{'# of':<12}{'number':>8}" + "".join(f"{f'{q}%':>9}" for q in QUANTILES)
        everything = [ratio for ratios in self.by_kind.values() for ratio in ratios]
        groups = [("all", everything)] + list(self.by_kind.items())
        groups += [(f"1e{decade}", self.by_decade[decade]) for decade in sorted(self.by_decade, reverse=True)]
        for name, ratios in groups:
            ratios = sorted(ratios)
            yield f"{name:<12}{len(ratios):>8}" + "".join(f"{quantile(ratios, q):>9.3g}" for q in QUANTILES)


def quantile(ordered, percent):
    return ordered[round(percent/100*(len(ordered) - 1))] if ordered else math.nan


def without_numbers(message):
    """So that messages that differ in their numbers and places only are counted as one."""
    message = re.sub(r"'[^']*'", "'…'", message)
    message = re.sub(r"\s+", " ", re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "…", message))
    return re.sub(r"\brow\b", "rows", re.sub(r"…((, | to )…)+", "…", message)).strip()


class Reasons:
    """Decks by the reason that the program gave, numbers left out."""

    def __init__(self, heading):
        self.heading, self.decks = heading, {}

    def add(self, reason, deck, group=""):
        self.decks.setdefault(group + without_numbers(reason), []).append(deck)

    def lines(self, most=6):
        yield f"# {self.heading}: {sum(map(len, self.decks.values()))}"
        for reason, decks in sorted(self.decks.items(), key=lambda item: -len(item[1])):
            names = list(dict.fromkeys(decks))
            more = f" and {len(names) - most} more" if len(names) > most else ""
            yield f"{len(decks):>6}  {reason}  ({', '.join(names[:most])}{more})"


class Times:
    """Processor time a row, of the slowest decks and of every kind."""

    def __init__(self):
        self.rows = []

    def add(self, deck, accuracy, rows, seconds):
        if rows:
            self.rows.append((1000*seconds/rows, deck.name, deck.kind, accuracy, rows, deck.modes))

    def lines(self, most=20):
        yield "# processor time per row [ms], by kind: median and largest"
        for kind in dict.fromkeys(row[2] for row in self.rows):
            times = sorted(row[0] for row in self.rows if row[2] == kind)
            yield f"{kind:<12}{quantile(times, 50):>10.3g}{times[-1]:>10.3g}"
        yield "# the slowest decks: ms per row, deck, accuracy, rows, modes"
        for time, name, _, accuracy, rows, modes in sorted(self.rows, reverse=True)[:most]:
            yield f"{time:>10.3g}  {name:<18}{accuracy:<8}{rows:>5}{modes:>5}"
