"""Links that bend without mass (density=0), which carry masses, against closed forms.

  massless.py SEED COUNT --program PATH [--scratch DIR]

Random cantilevers with a mass at the tip or a rigid block, beams on two supports with a mass along them, and four-bars with a mass
between coupler and follower: springs as of textbooks, a mass matrix of rigid bodies, roots of a quadratic.  There are as many
frequencies as freedoms, each within its printed error, and no more: one more is refused by name.
"""
import argparse
import math
import pathlib
import random
import subprocess
import sys
import tempfile


def roots(k, m):
    """Frequencies [Hz] of a system with two freedoms: det(K - w2 M) = 0."""
    a = m[0][0]*m[1][1] - m[0][1]**2
    b = k[0][0]*m[1][1] + k[1][1]*m[0][0] - 2*k[0][1]*m[0][1]
    c = k[0][0]*k[1][1] - k[0][1]**2
    large = (b + math.sqrt(b*b - 4*a*c))/(2*a)
    return [math.sqrt(c/a/large)/(2*math.pi), math.sqrt(large)/(2*math.pi)]


def spring(stiffness, mass):
    return math.sqrt(stiffness/mass)/(2*math.pi)


def cantilever(rng, e, i, area, beam):
    long, turn, mass = rng.uniform(0.2, 2), rng.uniform(0, 2*math.pi), rng.uniform(0.5, 5)
    tip = long*math.cos(turn), long*math.sin(turn)
    cards = f"GROUND O 0 0\nLINK a O A {beam}\nPIN A {tip[0]!r} {tip[1]!r}\nCLAMP O\n"
    if rng.random() < 0.5:
        return cards + f"PINMASS A {mass!r}\n", [spring(3*e*i/long**3, mass), spring(e*area/long, mass)]
    far, inertia = rng.uniform(0.1, 0.5)*long, mass*rng.uniform(0.01, 0.1)*long**2
    end = tip[0] + 2*far*math.cos(turn), tip[1] + 2*far*math.sin(turn)
    cards += f"PIN B {end[0]!r} {end[1]!r}\nLINK block A B rigid mass={mass!r} center={far!r},0 inertia={inertia!r}\nWELD A a block\n"
    stiff = [[12*e*i/long**3, -6*e*i/long**2], [-6*e*i/long**2, 4*e*i/long]]
    return cards, roots(stiff, [[mass, mass*far], [mass*far, inertia + mass*far**2]]) + [spring(e*area/long, mass)]


def supported(rng, e, i, area, beam):
    long, mass = rng.uniform(0.2, 2), rng.uniform(0.5, 5)
    a = rng.uniform(0.2, 0.8)*long
    b = long - a
    cards = f"GROUND O 0 0\nGROUND Q {long!r} 0\nLINK a O Q {beam}\nMASS a {mass!r} at={a!r}\n"
    return cards, [spring(3*e*i*long/(a*b)**2, mass), spring(e*area*(1/a + 1/b), mass)]


def four_bar(rng, e, i, area, beam):
    """Mass at B: the follower is a rod, and crank (clamped) and coupler are a chain to A and on to B."""
    crank, mass = rng.uniform(0.1, 0.3), rng.uniform(0.5, 5)
    turn = math.radians(rng.uniform(0, 360))
    a, b = (crank*math.cos(turn), crank*math.sin(turn)), (rng.uniform(0.3, 0.8), rng.uniform(0.5, 0.9))
    ground = rng.uniform(0.8, 1.2)
    lengths = crank, math.dist(a, b), math.dist((ground, 0), b)
    along = (b[0] - a[0])/lengths[1], (b[1] - a[1])/lengths[1]
    down = (b[0] - ground)/lengths[2], b[1]/lengths[2]
    axis, across = (math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))
    bent, pulled = 3*e*i/crank**3, e*area/crank
    dot = [axis[0]*along[0] + axis[1]*along[1], across[0]*along[0] + across[1]*along[1]]
    chain = 1/(lengths[1]/(e*area) + dot[0]**2/pulled + dot[1]**2/bent)
    rod = e*area/lengths[2]
    stiff = [[chain*along[r]*along[s] + rod*down[r]*down[s] for s in (0, 1)] for r in (0, 1)]
    cross = down[0]*along[1] - down[1]*along[0]
    cards = (f"GROUND O 0 0\nGROUND Q {ground!r} 0\n" + "".join(
        f"LINK {name} {pins} length={length!r} {beam}\n" for name, pins, length in zip(("a", "b", "c"), ("O A", "A B", "Q B"), lengths))
        + f"PINMASS B {mass!r}\nDRIVE a\nCRANK {math.degrees(turn)!r}\nBRANCH {'open' if cross < 0 else 'crossed'}\n")
    return cards, roots(stiff, [[mass, 0], [0, mass]])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("seed", type=int)
    parser.add_argument("count", type=int)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scratch")
    given = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory(dir=given.scratch) as scratch:
        place = pathlib.Path(scratch)

        def run(text, name):
            (place / f"{name}.deck").write_text(text)
            return subprocess.run([given.program, "--quiet", "--out", str(place / "out"), str(place / f"{name}.deck")],
                                  capture_output=True, text=True, check=False)

        for case in range(given.count):
            rng = random.Random(f"{given.seed}/{case}")
            e, thick, wide = 10**rng.uniform(9.5, 11.5), rng.uniform(0.005, 0.02), rng.uniform(0.01, 0.05)
            kind = (cantilever, supported, four_bar)[case % 3]
            cards, right = kind(rng, e, wide*thick**3/12, wide*thick, "material=light section=bar")
            text = (f"UNITS m kg s\nMATERIAL light E={e!r} density=0\nSECTION bar rectangle thickness={thick!r} width={wide!r}\n"
                    f"{cards}REPORT frequencies\n")
            done = run(text + f"MODES {len(right)}\n", "all")
            said = [done.stderr] if done.returncode else []
            if not said:
                row = [line for line in (place / "out/all/frequencies.dat").read_text().splitlines() if line and line[0] != "#"][0].split()
                n = len(right)
                for f, found, error in zip(sorted(right), map(float, row[2:2 + n]), map(float, row[2 + n:])):
                    if abs(found/f - 1) > error + 1e-12:
                        said.append(f"{found} for {f}, error {error}")
            # By the deck's own count, or else by the rank of M at the position.
            more = run(text + f"MODES {len(right) + 1}\n", "more")
            if more.returncode not in (1, 2) or f"expected MODES {len(right)}\n" not in more.stderr:
                said.append(f"one mode more: {more.returncode} {more.stderr}")
            if said:
                failed += 1
                print(f"case {case} ({kind.__name__}):", *said[:3], sep="\n  ")
    print(f"{given.count - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
