"""The table of docs/reports.md that the program's own answers give."""

import re
import subprocess

from deck_language import language
from numbers_in_text import Word

NEEDED, UNUSED = "yes", "–"

# A deck with every card that a report may need; a report's own keys are those of its pattern.
CARDS = {
    "UNITS": "UNITS mm kg s",
    "MATERIAL": "MATERIAL steel E=200GPa density=7800kg/m3",
    "SECTION": "SECTION strip rectangle thickness=1.6 width=25.4",
    "GROUND": "GROUND O2 0 0\nGROUND O4 254 0",
    "LINK": "LINK crank O2 A length=100{0}\nLINK coupler A B length=279.4{0}\nLINK follower O4 B length=266.7{0}",
    "DRIVE": "DRIVE crank",
    "MESH": "MESH * elements=2",
    "CRANK": "CRANK 30 60",
    "SPEED": "SPEED 20 30",
    "POINT": "POINT tip coupler along=100",
}
BEAMS, BODIES = " material=steel section=strip", " mass=1"
# Frequencies and the elastic response refuse friction; coordinates are of a MEASURE or the like.
FURTHER = {"friction": ["FRICTION O2 radius=5 coefficient=0.1"], "coordinates": ["MEASURE height travel A 0 1"]}
KEYS = {"motion": " crank=30 end=1 step=0.1", "geometry": " crank=30", "transient": " turns=1", "summary": " of=transmission_angle"}


class Tables:
    """Every method without an underscore is the maker of the table of its name."""

    def __init__(self, program):
        self._program = program

    def _accepts(self, report, without=(), links=BEAMS, **others):
        """Whether the program would run the deck with this report, without some cards and with others changed."""
        cards = {keyword: text for keyword, text in {**CARDS, **others}.items() if keyword not in without}
        text = "\n".join([*cards.values(), *FURTHER.get(report, []), f"REPORT {report}{KEYS.get(report, '')}"]).replace("{0}", links)
        return subprocess.run([self._program, "--check", "-"], input=text, capture_output=True, text=True,
                              check=False).returncode == 0

    def _links(self, report):
        if self._accepts(report, links=""):
            return UNUSED
        if not self._accepts(report, links=BODIES, without=["MESH"]):
            return NEEDED
        return "yes, or `mass=`" + ("; at rest –" if self._accepts(report, links="", without=["SPEED"]) else "")

    def _mesh(self, report):
        if self._accepts(report, links="", without=["MESH"]) or self._accepts(report, links=BODIES, without=["MESH"]):
            lumped = self._accepts(report, without=["MESH"], INERTIA="INERTIA lumped")
            return UNUSED if lumped else "with `INERTIA lumped`"
        if self._accepts(report, without=["MESH"], SOLVER="SOLVER dense"):  # which the default mesh does not allow
            return UNUSED
        return "or the default" if self._accepts(report, without=["MESH"]) else NEEDED

    @staticmethod
    def _text(words):
        """As a cell of a table."""
        return Word(words.replace("*", r"\*").replace("|", " or "))

    def reports(self):
        """One row a report: what it is about, the tables of all its forms, and the cards that it needs."""
        tongue = language(self._program)
        for report in dict.fromkeys(tongue.reports):
            if not self._accepts(report):
                raise ValueError(f"the deck of all cards is refused with REPORT {report}")
            meanings = [meaning.split(" (default")[0] for pattern, meaning in zip(tongue.patterns, tongue.meanings)
                        if re.match(rf"REPORT {report}\b", pattern)]
            tables = dict.fromkeys(re.findall(r"\w+\.dat", " ".join(meanings)))
            needs = [UNUSED if self._accepts(report, without=["CRANK"]) else NEEDED, self._links(report), self._mesh(report)]
            if report == "summary":
                needs[1:] = ["as the reports of its quantities"]*2
            yield [Word(f"[{report}](#{report})"), self._text("; ".join(meaning.rpartition(": ")[0] for meaning in meanings)),
                   Word(", ".join(f"`{table}`" for table in tables)), *map(Word, needs)]
