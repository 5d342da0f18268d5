"""The program itself, for what only it knows."""

import os
import re
import shutil
import subprocess
import tempfile

LONGEST = 60  # seconds for a question


def find():
    """Its path: what FLEXMECH says, else beside these scripts, built in their checkout, or on the way of commands; or None."""
    here = os.path.dirname(os.path.abspath(__file__))
    places = [os.path.join(here, "..", "..", "build", "release", "flexmech"),
              os.path.join(here, "..", "..", "..", "..", "bin", "flexmech")]
    wish = os.environ.get("FLEXMECH")
    for place in [wish] if wish else places:
        if os.access(place, os.X_OK) and os.path.isfile(place):
            return os.path.abspath(place)
    return None if wish else shutil.which("flexmech")


def version():
    """Its version, which is that of these scripts."""
    path = find()
    told = subprocess.run([path, "--version"], capture_output=True, check=False, text=True).stdout if path else ""
    return told.replace("flexmech ", "").strip() or "without the program"


def ranges(deck):
    """Of the text of a deck: where its first drive can be, as pairs; none without the program, or where it goes everywhere."""
    path = find()
    if path is None:
        return []
    text = re.sub(r"(?m)^REPORT .*\n", "", deck).replace("\nEND\n", "\nREPORT linkage format=linkage\nEND\n")
    with tempfile.TemporaryDirectory() as folder:
        command = [path, "--quiet", "--threads=1", "--out", folder, "-"]
        try:
            subprocess.run(command, input=text.encode("utf-8", errors="replace"), capture_output=True, check=False, cwd=folder, timeout=LONGEST)
        except subprocess.TimeoutExpired:
            return []
        table = next((os.path.join(place, "linkage.dat") for place, _, files in os.walk(folder) if "linkage.dat" in files), None)
        if table is None:
            return []
        with open(table, encoding="utf-8") as file:
            ends = re.findall(r"(?m)^ *\S+ +range_(from|to) +(\S+)", file.read())
    return [(float(low), float(high)) for (one, low), (other, high) in zip(ends, ends[1:]) if (one, other) == ("from", "to")]
