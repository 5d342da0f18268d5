#!/usr/bin/env python3
"""Tests of flexmech-import and flexmech-export, on the files in tests/exchange.

    exchange_tests.py PROGRAM SCRATCH

A file NAME.* of another program becomes the deck NAME.expected. That deck is run, and places are compared with closed forms
of what the file says. Prints `ok NAME` or `not ok NAME: why`.
"""

import math
import os
import re
import subprocess
import sys
import xml.etree.ElementTree

PROGRAM, SCRATCH = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
FOLDER = os.path.join("tests", "exchange")
NEAR = 1e-6  # of places, in the unit of length: files have six decimals


def command(name, *arguments, given=None, program=PROGRAM):
    return subprocess.run([os.path.join("exchange", name), *arguments], capture_output=True, check=False, text=True, input=given,
                          env={**os.environ, "FLEXMECH": program})


def check(name, test, *arguments):
    try:
        why = test(*arguments)
    except (OSError, ValueError, KeyError, IndexError) as fault:
        why = repr(fault)
    print(f"not ok {name}: {' '.join(str(why).split())}" if why else f"ok {name}", flush=True)


# What becomes of a file.

def same_deck(file):
    """As expected, and again from the file that -o writes."""
    made = command("flexmech-import", os.path.join(FOLDER, file))
    if made.returncode or made.stderr:
        return f"status {made.returncode}: {made.stderr}"
    expected = os.path.join(FOLDER, os.path.splitext(file)[0] + ".expected")
    with open(expected, encoding="utf-8") as text:
        for number, (line, wanted) in enumerate(zip(made.stdout.splitlines(), text.read().splitlines()), 1):
            if line != wanted:
                return f"line {number} is '{line}', not '{wanted}'"
    with open(os.path.join(SCRATCH, os.path.splitext(file)[0] + ".deck"), "w", encoding="utf-8") as deck:
        deck.write(made.stdout)
    return None


def table(name, kind="pins"):
    """Rows of a table of the deck, as dictionaries."""
    with open(os.path.join(SCRATCH, name, kind + ".dat"), encoding="utf-8") as text:
        lines = text.read().splitlines()
    heads = [line[1:].split() for line in lines if line.startswith("#") and not line.startswith("# failed")]
    return [dict(zip(heads[-2], line.split())) for line in lines if line and not line.startswith("#")]


def follows(name, places):
    """Runs a deck; places: what gives the place of a pin at a position, or the value that has to be 0, by the pins of its row."""
    done = subprocess.run([PROGRAM, "--quiet", "--threads=1", "--out", SCRATCH, os.path.join(SCRATCH, name + ".deck")],
                          capture_output=True, check=False, text=True)
    if done.returncode:
        return f"status {done.returncode}: {done.stderr}"
    positions = {}
    for row in table(name):
        key = float(row.get("time", row["crank"]))
        positions.setdefault(key, {})[row["pin"]] = complex(float(row["x"]), float(row["y"]))
    if len(positions) < 10:
        return f"{len(positions)} positions only"
    for key, pins in positions.items():
        for what, off in places(key, pins).items():
            if not abs(off) < NEAR:
                return f"{what} is off by {abs(off)} at {key}"
    return None


def turned(degrees):
    return complex(math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))


def crank_rocker(crank, pins):
    """Lengths in inches, of a drawing in 1/96 of it."""
    tip = pins["tip_of_rocker"]
    return {"P1": pins["P1"] - turned(crank), "the coupler": abs(tip - pins["P1"]) - math.hypot(3, 2),
            "the rocker": abs(tip - 4) - math.hypot(1, 3), "the tracing point": abs(pins["P4"] - pins["P1"]) - math.hypot(1, 2)}


def planet(crank, pins):
    """A wheel half as large rolls around one that stands: it turns three times."""
    center = 30*turned(crank)
    return {"the axis": pins["P1"] - center, "the wheel": pins["P2"] - center - 10*turned(3*crank)}


def slots(crank, pins):
    """The drawing is at crank 0."""
    block = pins["P4"]/turned(crank)
    return {"the lever": abs(block*turned(crank) - (10 + 5j)) - 40, "the block beside its slot": block.real - 20,
            "the arc": abs(pins["P7"] - (53 + 5j)) - 25, "the rod": abs(pins["P7"] - pins["P8"]) - math.hypot(23, 20)}


def rams(time, pins):
    """A crank to and fro over 40 degrees three turns a minute, a ram over 10 mm six times a minute."""
    length = math.hypot(50, 50) + 5*(1 - math.cos(2*math.pi*time/10))
    return {"the crank": pins["P4"] - 150 - 30*turned(90 + 20*(1 - math.cos(2*math.pi*time/(80/18)))),
            "the ram": abs(pins["P1"] - (50 - 50j)) - length}


def quick_return(crank, pins):
    block = 60*turned(crank)
    way = (block + 150j)/abs(block + 150j)
    drawn = (60 + 150j)/abs(60 + 150j)
    lever = -150j + (130 + 325j)/drawn*way
    return {"the lever": pins["D"] - lever, "the height of the ram": pins["E"].imag - 140,
            "the rod": abs(pins["E"] - pins["D"]) - math.hypot(100, 35)}


def slider_crank(radius, rod, guide):
    def places(crank, pins):
        end = radius*turned(crank)
        return {"crank": pins["B"] - end, "block": pins["C"] - (end.real + math.sqrt(rod**2 - (end.imag - guide)**2)) - 1j*guide}
    return places


def cylinder(length, pins):
    """The block is as far from the link's pivot as the drive says, and the rod does not turn on it."""
    way = (pins["P"] - 6)/abs(pins["P"] - 6)
    square = (pins["C"] - pins["P"])/way
    return {"the length": abs(pins["P"] - 6) - length, "the end": abs(pins["C"]) - 8,
            "the rod's length": abs(square) - 6, "the rod's angle": square.imag}


def moving_input(angle, pins):
    crank, coupler = pins["B"], pins["C"] - pins["B"]
    turn = math.degrees(math.atan2((coupler/crank).imag, (coupler/crank).real))
    return {"the angle": (turn - angle + 180) % 360 - 180, "the crank": abs(crank) - 4, "the coupler": abs(coupler) - math.hypot(9, 2)}


def tracker(crank, pins):
    """The tracker belongs to the coupler, as drawn."""
    return {"the tracker": (pins["T"] - pins["A"])/(pins["B"] - pins["A"]) - (1.5 + 1.5j)/(3 + 1j), "A": pins["A"] - turned(crank),
            "the guide": pins["S"].imag}


def assembled(crank, pins):
    """Of lengths only."""
    return {"crank": pins["B"] - 0.01*turned(crank), "coupler": abs(pins["C"] - pins["B"]) - 0.04,
            "rocker": abs(pins["C"] - 0.038) - 0.03, "its point": (pins["P"] - pins["B"])/(pins["C"] - pins["B"]) - (0.5 + 0.25j)}


def formula(time, pins):
    end = 0.01*turned(90*math.sin(3*time))
    return {"crank": pins["B"] - end, "block": pins["C"].imag - 0.01, "rod": abs(pins["C"] - end) - 0.04}


def arc(crank, pins):
    return {"crank": pins["A"] - turned(crank), "rocker": abs(pins["B"] - 3) - 2, "range": max(0.0, math.degrees(1.2) - 1e-5 - crank)}


FILES = {
    "crank_rocker.linkage2": crank_rocker, "planet.linkage2": planet, "slots.linkage2": slots, "rams.linkage2": rams,
    "quick_return.txt": quick_return, "slider_crank.pmks": slider_crank(50, math.hypot(150, 40), 0),
    "crank_slider.url": slider_crank(5, math.hypot(15, 4), 0), "cylinder.url": cylinder, "moving_input.url": moving_input,
    "pylinkage.json": tracker, "arc.json": arc, "linkage_sim.json": assembled, "formula.json": formula}


def document():
    """The deck in docs/import.md is that of the file there."""
    with open(os.path.join("docs", "import.md"), encoding="utf-8") as text:
        shown = [re.sub(r"(?m)^    ", "", block) for block in re.findall(r"(?m)^    (?:<linkage2>|TITLE )(?:.*\n(?:    |\n(?=    )))*.*\n", text.read())]
    path = os.path.join(SCRATCH, "press.linkage2")
    with open(path, "w", encoding="utf-8") as file:
        file.write(shown[0])
    made = command("flexmech-import", path)
    return None if made.stdout.replace(path, "press.linkage2") == shown[1] else f"it has\n{shown[1]}\nand not\n{made.stdout}{made.stderr}"


# What is wrong with a file.

def refused(text, told):
    """Exit status 2, the message, and nothing written."""
    path = os.path.join(SCRATCH, "wrong.file")
    deck = os.path.join(SCRATCH, "wrong.deck")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    made = command("flexmech-import", path, "-o", deck)
    wanted = f"{path}{told}\n"
    if made.returncode != 2 or made.stdout or os.path.exists(deck):
        return f"status {made.returncode}; it wrote {made.stdout or deck}"
    return None if made.stderr == wanted else f"'{made.stderr}' in place of '{wanted}'"


LINKAGE = '<linkage2>\n<connector id="0" anchor="true" x="0" y="0"/>\n{}\n</linkage2>\n'
BODIES = ('{"schema_version": "1.0.0",\n"bodies": {"ground": {"attachment_points": {"O": [0, 0], "Q": [9, 0]}},\n'
          '"a": {"attachment_points": {"O": [0, 0], "A": [1, 0]}}, "b": {"attachment_points": {"A": [0, 0], "Q": [1, 0]}}},\n')
REFUSED = {
    "of no format": ("a b c\n", ":1:1: error: expected a file of Linkage (<linkage2>), PMKS (joints, a line each, or .pmks), pylinkage or "
                     "linkage_sim (JSON), or an address of PMKS+"),
    "empty": ("", ":1:1: error: expected a file of Linkage (<linkage2>), PMKS (joints, a line each, or .pmks), pylinkage or "
              "linkage_sim (JSON), or an address of PMKS+"),
    "XML that ends early": ('<linkage2>\n<connector id="0" x="1" y="2"/>\n', ":3:1: error: not the XML of Linkage: no element found"),
    "a place that is no number": (LINKAGE.format('<connector id="1" x="1,5" y="2"/>'),
                                  ":3:1: error: expected a number for x= of <connector>, not '1,5'"),
    "a connector without a place": (LINKAGE.format('<connector id="1" x="1"/>'), ":3:1: error: <connector> has no y="),
    "a connector that is not there": (LINKAGE.format('<Link id="0"><connector id="0"/><connector id="7"/></Link>'),
                                      ":3:1: error: link 0 has the connector 7, which is not in this file"),
    "a connector twice": (LINKAGE.format('<connector id="0" x="1" y="1"/>'), ":3:1: error: connector 0 is there twice"),
    "a slot with one end": (LINKAGE.format('<connector id="1" x="1" y="1" slider="true"><slidelimit id="0"/></connector>'),
                            ":3:1: error: slider 1 needs two <slidelimit> with the ids of connectors"),
    "a ratio of what is no wheel": (LINKAGE.format('<ratios><ratio type="gears"><link id="4" size="1"/><link id="5" size="2"/></ratio></ratios>'),
                                    ":3:29: error: <ratio> names link 4, which is no gear of this file"),
    "an address that ends early": ("?2P.Ay,1E8.K,0.1011.6A,A,0,0,0.0B,B,ku,0,0", ":1:32: error: the address ends among its joints: "
                                   "expected an empty group behind them"),
    "an address with a number that is none": ("?2P.Ay.K.1011.6A,A,0,$,0..YRAB,AB,0,0,0,0,c,A,,..", ":1:15: error: expected a number as item 4 of '6A,A,0,$,0'"),
    "an address with a joint that is not there": ("?2P.Ay.K.1011.6A,A,0,0,0..YRAB,AB,0,0,0,0,c,A,Z,,..",
                                                  ":1:27: error: link AB has the joint Z, which is not in this address"),
    "a joint without a place": ("ground,crank,R,0,0,0\ncrank,rod,R,1\n", ":2:11: error: the place of the joint is missing: expected x and y behind 'R'"),
    "a joint without a type": ("ground,crank,R,0,0,0\ncrank,rod,1,2\n",
                               ":2:1: error: expected links, a type (R, P, RP, G), x and y, not 'crank,rod,1,2'"),
    "JSON that is none": ('{"bodies": {},\n "joints": [}', ":2:13: error: not JSON: Expecting value"),
    "a position that is none": ('{"joints": [\n{"id": "A", "type": "ground", "position": [0, null]}],\n"links": [{"id": "a", "joints": ["A"]}]}',
                                ":2:8: error: joint A: expected a number for \"position\", not null"),
    "a joint of an unknown type": ('{"joints": [\n{"id": "A", "type": "spherical", "position": [0, 1]}],\n"links": [{"id": "a", "joints": ["A"]}]}',
                                   ":2:8: error: joint A: expected a type of ground, revolute, prismatic, tracker, not 'spherical'"),
    "a name that is none": ('{"joints": [\n{"id": [1], "type": "ground", "position": [0, 1]}],\n"links": [{"id": "a", "joints": ["A"]}]}',
                            ":1:2: error: joint: expected a text or a number for \"id\", not [1]"),
    "a link of a joint that is not there": ('{"joints": [\n{"id": "A", "position": [0, 1]}],\n"links": [{"id": "a", "joints": ["B"]}]}',
                                            ":3:18: error: link a: joint 'B' is not in this file"),
    "a later version": ('{"schema_version": "2.0.0",\n"bodies": {}, "joints": {}}', ":1:2: error: expected a schema_version of 1, not '2.0.0'"),
    "a joint of a body that is not there": (BODIES + '"joints": {"J": {"type": "revolute", "body_i": "ground", "body_j": "c", "point_i": "O", "point_j": "O"}}}',
                                            ":4:12: error: joint J: body 'c' is not in this file"),
    "a cam": (BODIES + '"joints": {"J": {"type": "cam_follower"}}}', ":4:12: error: joint J: there is no card for a joint of the type 'cam_follower'"),
    "bodies too short to meet": (
        BODIES + '"joints": {"J": {"type": "revolute", "body_i": "ground", "body_j": "a", "point_i": "O", "point_j": "O"},\n'
        '"K": {"type": "revolute", "body_i": "a", "body_j": "b", "point_i": "A", "point_j": "A"},\n'
        '"L": {"type": "revolute", "body_i": "b", "body_j": "ground", "point_i": "Q", "point_j": "Q"}}}',
        ":2:1: error: the bodies do not fit together where the drivers begin"),
    "a formula that is none": (BODIES + '"joints": {}, "drivers": {"D": {"type": "expression", "body_i": "ground", "body_j": "a", "expr": "open(t)"}}}',
                               ":4:27: error: driver D: \"expr\" is no formula of t with + - * / ^ and sin, cos, tan, asin, acos, atan, sqrt: open(t)"),
}


def no_overwriting():
    """A deck that is there stays, but with --force."""
    path = os.path.join(SCRATCH, "kept.deck")
    source = os.path.join(FOLDER, "crank_rocker.linkage2")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write("mine\n")
    made = command("flexmech-import", "-o", path, source)
    with open(path, encoding="utf-8") as deck:
        kept = deck.read()
    if made.returncode != 2 or kept != "mine\n" or made.stderr != f"flexmech-import: {path} is there already; --force replaces it\n":
        return f"status {made.returncode}: {made.stderr}"
    made = command("flexmech-import", "-o", path, "--force", source)
    with open(path, encoding="utf-8") as deck:
        return None if made.returncode == 0 and deck.read().startswith("TITLE    crank_rocker\n") else made.stderr or "not replaced"


def places_to_write():
    """Devices stay, links too, with what is behind them replaced; a folder that is not there is told by the name of the file."""
    source = os.path.join(FOLDER, "crank_rocker.linkage2")
    link, behind = os.path.join(SCRATCH, "link.deck"), os.path.join(SCRATCH, "behind.deck")
    pipe = os.path.join(SCRATCH, "pipe")
    for path in (link, behind, pipe):
        if os.path.lexists(path):
            os.unlink(path)
    os.symlink("behind.deck", link)
    made = command("flexmech-import", "-o", link, "--force", source)
    if made.returncode or not os.path.islink(link) or not os.path.isfile(behind):
        return made.stderr or "the link was replaced"
    os.mkfifo(pipe)
    with subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE, text=True) as reader:
        made = command("flexmech-import", "-o", pipe, "--force", source)
        if os.path.isfile(pipe):
            reader.kill()
            return "a pipe was replaced by a file"
        if made.returncode or not reader.communicate()[0].startswith("TITLE    crank_rocker\n"):
            return made.stderr or "nothing came through the pipe"
    path = os.path.join(SCRATCH, "nowhere", "a.deck")
    made = command("flexmech-import", "-o", path, source)
    return None if made.returncode == 2 and made.stderr == f"flexmech-import: {path}: No such file or directory\n" else made.stderr


def odd_letters():
    """Half letters and control characters of names and files do no harm; nor does a terminal of another encoding."""
    with open(os.path.join(FOLDER, "crank_rocker.linkage2"), "rb") as file:
        text = file.read()
    for name in (b"l\xe9vier.linkage2", b"a\nEND\n.linkage2"):
        path = os.path.join(os.fsencode(SCRATCH), name)
        with open(path, "wb") as file:
            file.write(text)
        made = command("flexmech-import", path)
        if made.returncode or not re.match(r"TITLE    [^\n]*\n\n! From [^\n]*, by flexmech-import\.\n", made.stdout):
            return made.stderr or made.stdout
    with open(os.path.join(FOLDER, "pylinkage.json"), encoding="utf-8") as file:
        text = file.read()
    for title in ('"\\ud800 four\\u0000bar"', "4.5"):
        path = os.path.join(SCRATCH, "odd.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace('"four bar"', title, 1))
        made = command("flexmech-import", path)
        if made.returncode or not made.stdout.startswith(("TITLE    ? four bar\n", "TITLE    4.5\n")):
            return made.stderr or made.stdout
    made = subprocess.run([os.path.join("exchange", "flexmech-import"), "-"], capture_output=True, check=False, input=text.replace("four bar", "bière").encode(),
                          env={**os.environ, "FLEXMECH": PROGRAM, "PYTHONIOENCODING": "ascii"})
    return None if made.stdout.startswith("TITLE    bière\n".encode()) else made.stderr.decode() or made.stdout.decode()


def wrong_words():
    for words, told in ((["-x", "a"], "unknown option -x; --help lists them"), ([], "the file is missing; --help tells more"),
                        (["a", "b"], "expected one FILE; --help tells more"), (["-o"], "-o takes a value"),
                        (["--force=1", "a"], "--force takes no value: --force=1")):
        made = command("flexmech-import", *words)
        if made.returncode != 2 or made.stderr != f"flexmech-import: {told}\n":
            return f"{words}: status {made.returncode}: {made.stderr}"
    made = command("flexmech-import", "nowhere.linkage2")
    return None if made.returncode == 2 and made.stderr == "flexmech-import: nowhere.linkage2: No such file or directory\n" else made.stderr


def address_in_place():
    """Of a file, or through standard input, or in other encodings."""
    with open(os.path.join(FOLDER, "moving_input.url"), encoding="utf-8") as file:
        address = file.read().strip()
    wanted = command("flexmech-import", os.path.join(FOLDER, "moving_input.url")).stdout.partition("UNITS")[2]
    for made in (command("flexmech-import", address), command("flexmech-import", "-", given=address)):
        if made.returncode or made.stdout.partition("UNITS")[2] != wanted:
            return made.stderr or "another deck"
    with open(os.path.join(FOLDER, "crank_rocker.linkage2"), encoding="utf-8") as file:
        text = file.read()
    for encoding in ("utf-16", "utf-8-sig", "cp1252"):
        path = os.path.join(SCRATCH, "crank_rocker.linkage2")
        with open(path, "w", encoding=encoding) as file:
            file.write(text.replace("tip of rocker", "tip of rôcker"))
        made = command("flexmech-import", path)
        if made.returncode or not re.search(r"(?m)^LINK +L2 +tip_of_rocker P3 P5$", made.stdout):
            return f"{encoding}: {made.stderr or made.stdout}"
    return None


def positions():
    """Where the linkage closes, as the program knows; without it all around. A crank of 4 under a coupler of 3 and a follower of 2."""
    joints = "ground,a,R,0,0\na,b,R,0,4\nb,c,R,3,4\nc,ground,R,3,2\n"
    low, high = (math.degrees(math.atan2(2, 3) + math.acos((13 + 16 - far**2)/(2*math.sqrt(13)*4))) for far in (3 - 2, 3 + 2))
    for program, ends in ((PROGRAM, None), ("nowhere", ("0", "360", "5"))):
        made = command("flexmech-import", "-", given=joints, program=program)
        found = re.search(r"(?m)^CRANK +(\S+) to (\S+) step (\S+)$", made.stdout)
        if made.returncode or not found or ends and found.groups() != ends:
            return made.stderr or f"{program}: {found}"
        least, greatest, step = map(float, found.groups())
        if not ends and not (low < least < low + 2*step and high - 2*step < greatest < high):
            return f"{found[0]} in place of {low} to {high}"
    return None


# Export.

def exported(*arguments):
    made = command("flexmech-export", *arguments)
    if made.returncode:
        raise ValueError(f"status {made.returncode}: {made.stderr}")
    return made.stdout


def groups(text):
    """DXF: codes and values, each in a line of its own."""
    lines = text.splitlines()
    return [(int(code), value) for code, value in zip(lines[::2], lines[1::2])]


def dxf_lines():
    """Lines and circles are where the pins are, in the deck's unit; names stand beside them."""
    pairs = groups(exported("dxf", "--at", "60", os.path.join("inputs", "quick_return.deck")))
    entities, open_one = [], {}
    for code, value in pairs:
        if code == 0:
            open_one = {"kind": value}
            entities.append(open_one)
        else:
            open_one[code] = value
    lines = {tuple(round(float(one[code]), 6) for code in (10, 20, 11, 21)) for one in entities if one["kind"] == "LINE" and one[8] == "LINKS"}
    block = 60*turned(60)
    tip = -150j + 320*(block + 150j)/abs(block + 150j)
    ram = complex(tip.real + math.sqrt(120**2 - (140 - tip.imag)**2), 140)
    wanted = {tuple(round(value, 6) for value in (a.real, a.imag, b.real, b.imag)) for a, b in ((0j, block), (-150j, tip), (tip, ram))}
    if lines != wanted:
        return f"lines {lines}, not {wanted}"
    names = {one[1] for one in entities if one["kind"] == "TEXT"}
    if names != {"O2", "O4", "A", "C", "D"} or (1, "AC1009") not in pairs or pairs[-1] != (0, "EOF"):
        return f"names {names}"
    kinds = [one["kind"] for one in entities if one["kind"] in ("SECTION", "ENDSEC", "TABLE", "ENDTAB")]
    return None if kinds == ["SECTION", "ENDSEC", "SECTION", "TABLE", "ENDTAB", "ENDSEC", "SECTION", "ENDSEC"] else str(kinds)


def svg_size():
    """Well-formed, true to scale: 1 inch of the deck is 25.4 mm."""
    deck = os.path.join(SCRATCH, "inches.deck")
    with open(deck, "w", encoding="utf-8") as file:
        file.write("UNITS in lbm s\nGROUND O 0 0\nGROUND C 4 0\nLINK a O A length=1\nLINK b A B length=3.5\nLINK c C B length=2\nDRIVE a\n"
                   "BRANCH open\nCRANK 0 to 360 step 30\nREPORT kinematics &\n   columns=derivatives\nEND\n")
    root = xml.etree.ElementTree.fromstring(exported("svg", "--at=90", deck))
    width, view = float(root.get("width").removesuffix("mm")), [float(word) for word in root.get("viewBox").split()]
    if abs(width - 25.4*view[2]) > 1e-6*width:
        return f"{width} mm for {view[2]} in"
    lines = [[float(one.get(key)) for key in ("x1", "y1", "x2", "y2")] for one in root.iter("{http://www.w3.org/2000/svg}line")]
    return None if len(lines) == 3 and abs(lines[0][2]) < 1e-9 and abs(lines[0][3] + 1) < 1e-9 else str(lines)


def export_refused():
    deck = os.path.join("inputs", "quick_return.deck")
    for words, told in ((["pdf", deck], "flexmech-export: expected svg or dxf, and a DECK; --help tells more"),
                        (["svg", deck], "flexmech-export: --at is missing: the position"),
                        (["svg", "--at", "x", deck], "flexmech-export: --at x: expected a number"),
                        (["svg", "--at", "0", "nowhere.deck"], "flexmech-export: nowhere.deck: No such file or directory"),
                        (["svg", "--at", "0", os.path.join("inputs", "varied.deck")],
                         "inputs/varied.deck: error: it has VARY: choose a variant, --set crank_length=VALUE")):
        made = command("flexmech-export", *words)
        if made.returncode != 2 or made.stderr != told + "\n" or made.stdout:
            return f"{words}: status {made.returncode}: {made.stderr}"
    made = command("flexmech-export", "svg", "--at", "0", os.path.join(FOLDER, "planet.linkage2"))
    return None if made.returncode == 2 and made.stderr.startswith(f"{FOLDER}/planet.linkage2:1:1: error:") else made.stderr


def export_laws_and_structures():
    """By the instant, or without a position."""
    if "<circle" not in exported("svg", "--time", "0.1", os.path.join("inputs", "scara.deck")):
        return "no pins of the arm"
    if "<circle" not in exported("svg", os.path.join("inputs", "portal.deck")):
        return "no pins of the portal"
    return None if "<circle" in exported("svg", "--at", "30", "--set", "crank_length=100", os.path.join("inputs", "varied.deck")) else "no pins"


def options_of_help():
    for name in ("flexmech-import", "flexmech-export"):
        made = command(name, "--help")
        for option in ("-o", "--force", "--help", "--version"):
            if made.returncode or not re.search(rf"(?m)^  (.*, )?{option}\b", made.stdout):
                return f"the help of {name} has no {option}"
        version = subprocess.run([PROGRAM, "--version"], capture_output=True, check=True, text=True).stdout
        if command(name, "--version").stdout != version.replace("flexmech", name, 1):
            return "another version"
    return None


def main():
    for file, places in FILES.items():
        name = os.path.splitext(file)[0]
        check(f"import of {file}", same_deck, file)
        check(f"motion of {file}", follows, name, places)
    for name, (text, told) in REFUSED.items():
        check(f"refused: {name}", refused, text, told)
    for test in (document, no_overwriting, places_to_write, odd_letters, wrong_words, address_in_place, positions, dxf_lines, svg_size, export_refused, export_laws_and_structures, options_of_help):
        check(test.__name__.replace("_", " "), test)


if __name__ == "__main__":
    main()
