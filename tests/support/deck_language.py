"""The language of the deck as the program itself describes it (`flexmech --help-cards`): cards, keys, words, reports, tables."""

import functools
import os
import re
import subprocess
from collections import namedtuple

PROGRAMS = [os.path.join("build", kind, "flexmech") for kind in ("debug", "release")]

# Lists of texts; `patterns` are the cards as they should be, one for every form; `meanings` says what they are for; `tables` are names of files.
Language = namedtuple("Language", "patterns meanings keywords keys words reports tables")


def parsed(text):
    """The lists that make up the help: each card or report is a line, its meaning the indented line below."""
    patterns, meanings, tables = [], [], []
    for line in text.partition("\n\n")[2].splitlines():
        if line.startswith(" "):
            meanings.append(line.strip())
            tables += re.findall(r"\w+\.dat", line)
        else:
            patterns.append(line)
    keywords = list(dict.fromkeys(pattern.split()[0] for pattern in patterns))
    keys = list(dict.fromkeys(key for pattern in patterns for key in re.findall(r"(\w+)=", pattern)))
    reports = [pattern.split()[1] for pattern in patterns if re.match(r"REPORT [a-z]+( \[?\w+=|$)", pattern)]
    words = list(dict.fromkeys(word for pattern in patterns for word in re.findall(r"\*|[a-z]+\b(?!=)", pattern)))
    return Language(patterns, meanings, keywords, keys, words, reports, tables)


@functools.lru_cache(maxsize=None)
def language(program=None):
    program = program or next(path for path in PROGRAMS if os.path.exists(path))
    return parsed(subprocess.run([program, "--help-cards"], capture_output=True, check=True, text=True).stdout)
