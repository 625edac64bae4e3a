"""Natural frequencies of CalculiX's own test decks, from the matrices that it stores, against those that it prints.

usage: python calculix_suite.py DECKS WORK HBVIB [NAMES]

Needs ccx, numpy and scipy. DECKS is the folder of the decks (Debian: `apt-get download calculix-ccx-test`, `dpkg -x`), WORK takes the
files of the runs, HBVIB is the command. Each deck with *FREQUENCY runs twice up to the end of its first step with natural frequencies: as
it is, and with SOLVER=MATRIXSTORAGE and without cyclic symmetry. A table of Markdown tells what became of each.
It ends with 1 where a frequency differs from CalculiX by more than its seven digits allow and scipy does not find ours in the same matrices.
"""

import gzip
import os
import re
import subprocess
import sys

import numpy as np
import scipy.linalg
import scipy.sparse.linalg

import hbvib
import hbvib.io

PRINTED = 1e-6  # seven digits
SECONDS = "120"  # of each run

decks, work, command = (os.path.abspath(path) for path in sys.argv[1:4])
os.makedirs(work, exist_ok=True)
environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")


def cards(text):
    """Keyword lines with their data lines."""
    found = []
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*") or not found:
            found.append([line])
        else:
            found[-1].append(line)
    return found


def keyword(card):
    return re.sub(r"\s+", " ", card[0].split(",")[0].upper().strip())


def option(card, name):
    found = re.search(rf",\s*{name}\s*=\s*([^,\s]+)", card[0], re.I)
    return found and found.group(1)


def first_step(deck):
    """All up to the first step with natural frequencies."""
    kept, seen = [], False
    for card in deck:
        kept.append(card)
        seen |= keyword(card) == "*FREQUENCY"
        if seen and keyword(card) == "*END STEP":
            break
    return kept


def is_cyclic_tie(card):
    return keyword(card) == "*TIE" and "CYCLIC" in card[0].upper()


def stored(deck):
    """The deck that stores its matrices, without cyclic symmetry."""
    kept = []
    for card in deck:
        if keyword(card) == "*FREQUENCY":
            count = card[1].split(",")[0] if len(card) > 1 else "1"
            kept.append(["*FREQUENCY, SOLVER=MATRIXSTORAGE", count])
        elif keyword(card) not in ("*CYCLIC SYMMETRY MODEL", "*SELECT CYCLIC SYMMETRY MODES") and not is_cyclic_tie(card):
            kept.append(card)
    return kept


def turned(point, axis, at, angle):
    """A point, turned about an axis through another point."""
    n, x = np.array(axis) / np.linalg.norm(axis), np.array(point) - at
    return at + x * np.cos(angle) + np.cross(n, x) * np.sin(angle) + n * (n @ x) * (1 - np.cos(angle))


def faces(deck):
    """Sets of nodes of the ties of cyclic symmetry: left and right."""
    sides = {"left": [], "right": []}
    surfaces = {option(card, "NAME").upper(): card for card in deck if keyword(card) == "*SURFACE"}
    for tie in filter(is_cyclic_tie, deck):
        for side, surface in zip(sides, tie[1].split(",")):
            card = surfaces[surface.strip().upper()]
            # Surfaces of faces of elements have the nodes of another surface in this suite.
            card = card if (option(card, "TYPE") or "").upper() == "NODE" else surfaces[side.upper()]
            sides[side].append(card[1].strip(" ,"))
    return sides


def wheel_of(deck):
    """Numbers of sectors, and both points of the axis."""
    symmetry = [card for card in deck if keyword(card) == "*CYCLIC SYMMETRY MODEL"]
    point = np.array([float(word) for word in symmetry[0][1].replace(",", " ").split()])
    return sorted({int(option(card, "N")) for card in symmetry}), point[:3], point[3:6]


def with_exact_faces(deck):
    """The deck with nodes of the right faces at the images of those of the left, where they lie within 1e-4 of the size of the mesh.

    Decks have five or six digits, and CalculiX takes the sense of a sector at each node from its position."""
    sectors, at, end = wheel_of(deck)
    points, sets = {}, {}
    for card in deck:
        rows = [line.split(",") for line in card[1:]]
        if keyword(card) == "*NODE":
            points.update((int(row[0]), np.array(row[1:4], float)) for row in rows)
        elif keyword(card) == "*NSET" and "GENERATE" not in card[0].upper():
            numbers = {int(word) for row in rows for word in row if word.strip().isdigit()}
            sets.setdefault(option(card, "NSET").upper(), set()).update(numbers)
    near = 1e-4 * max(np.linalg.norm(point - at) for point in points.values())
    moved = {}
    for left, right in zip(*faces(deck).values()):
        right = np.array(sorted(sets[right.upper()]))
        places = np.array([points[node] for node in right])
        for node in sets[left.upper()]:
            images = [turned(points[node], end - at, at, sense * 2 * np.pi / sectors[0]) for sense in (1, -1)]
            apart = [np.linalg.norm(places - image, axis=1) for image in images]
            side = int(apart[1].min() < apart[0].min())
            if apart[side].min() <= near and right[apart[side].argmin()] != node:
                moved[right[apart[side].argmin()]] = images[side]
    changed = []
    for card in deck:
        if keyword(card) == "*NODE":
            rows = [int(line.split(",")[0]) for line in card[1:]]
            lines = [", ".join([str(node)] + ["%.12g" % x for x in moved.get(node, points[node])]) for node in rows]
            card = [card[0], *lines]
        changed.append(card)
    return changed


def write(name, deck):
    with open(os.path.join(work, name + ".inp"), "w") as file:
        file.writelines(line + "\n" for card in deck for line in card)


def ccx(name):
    """What it says of an error, or nothing."""
    for ending in ("dat", "sti", "mas", "dof"):
        path = os.path.join(work, f"{name}.{ending}")
        if os.path.exists(path):
            os.remove(path)
    done = subprocess.run(["timeout", SECONDS, "ccx", name], cwd=work, env=environment, capture_output=True, errors="replace", text=True)
    if done.returncode == 124:
        return f"takes more than {SECONDS} s"
    said = re.search(r"\*ERROR[^\n]*(\n\s+[^\n]+)?", done.stdout)
    return re.sub(r"\s+", " ", said.group(0)).strip(" *") if said else f"exit code {done.returncode}" if done.returncode else ""


def printed(name):
    """Diameters (none without cyclic symmetry) with their frequencies in Hz, those of unstable modes below zero."""
    found = {}
    path = os.path.join(work, name + ".dat")
    for line in open(path, errors="replace") if os.path.exists(path) else ():
        words = line.split()
        if len(words) in (5, 6) and all(word.isdigit() for word in words[: len(words) - 4]):
            diameter = int(words[0]) if len(words) == 6 else None
            square, hertz = float(words[-4]), float(words[-2])
            found.setdefault(diameter, []).append(hertz if square >= 0 else -abs(square) ** 0.5 / (2 * np.pi))
    return found


def sentence(text):
    """The first line of an error, without the folder."""
    return text.strip().splitlines()[-1].replace(work + os.sep, "")[:220] if text.strip() else "no sentence"


def difference(theirs, own):
    """The largest relative distance of their frequencies from the nearest of ours."""
    # Below this the square of a frequency is rounding of larger ones: a rigid motion, and near zero in ours as well.
    zero = 1e-4 * np.max(np.abs(theirs))
    gaps = [np.min(np.abs(own - hertz)) / abs(hertz) for hertz in theirs if abs(hertz) > zero]
    rigid = sum(abs(theirs) <= zero) == 0 or sum(abs(own) <= zero) > 0
    return max(gaps, default=0.0) if rigid else 1.0


def plain(name, theirs):
    read = hbvib.io.read(os.path.join(work, name + "_stored.sti"))
    model = hbvib.Model(stiffness=read.stiffness, mass=read.mass)
    theirs = np.array(theirs[None][:10])
    own = model.linear_modes(min(len(theirs) + 2, read.stiffness.shape[0]), contacts="free").omega / (2 * np.pi)
    rows, gap = read.stiffness.shape[0], difference(theirs, own)
    if gap > PRINTED:
        # A judge. The inverse problem takes masses that are zero.
        if rows <= 2500:
            inverse = scipy.linalg.eigvalsh(read.mass.toarray(), read.stiffness.toarray())
            squares = 1 / inverse[inverse > 0][::-1]
        else:
            squares = scipy.sparse.linalg.eigsh(read.stiffness.tocsc(), 12, read.mass.tocsc(), sigma=1.0, return_eigenvectors=False)
            squares = np.sort(squares[squares > 0])
        judge = np.sqrt(squares[: np.sum(own > 0)]) / (2 * np.pi)
        ours = difference(judge[: np.sum(theirs > 0)], own)
        if ours <= PRINTED:
            return rows, "equal to scipy, %.1e; CalculiX is %.1e from both" % (ours, difference(theirs[theirs > 0], judge))
    return rows, gap


def wheel(name, deck, theirs):
    """Frequencies of each diameter by the command, with the sets of nodes of the ties."""
    sectors, at, end = wheel_of(deck)
    if len(sectors) > 1:
        return None, "cannot: two wheels of %s sectors, of which a model has one" % " and ".join(map(str, sectors))
    names = {side: str(found).replace("'", '"') for side, found in faces(deck).items()}
    refused = []
    for direction, matching in ((1, "nodes"), (-1, "nodes"), (1, "projected"), (-1, "projected")):
        job = f'[model]\nmatrices = "{name}_stored.sti"\nmesh = "{name}_stored.inp"\nsectors = {sectors[0]}\nengine_order = 1\n'
        job += f'absent = "fixed"\n[model.faces]\nleft = {names["left"]}\nright = {names["right"]}\naxis = {(end - at).tolist()}\n'
        with open(os.path.join(work, name + ".toml"), "w") as file:
            file.write(job + f'direction = {direction}\nmatching = "{matching}"\n')
        run = [command, "modes", name + ".toml"]
        done = subprocess.run(run, cwd=work, env=environment, capture_output=True, text=True, timeout=300)
        if done.returncode == 0:
            break
        refused.append(sentence(done.stderr))
    else:
        return None, "refused: " + refused[0]
    own = {}
    for row in done.stdout.splitlines()[1:]:
        words = row.split(",")
        own.setdefault(int(words[0]), []).append(float(words[2]))
    rows = sum(1 for _ in open(os.path.join(work, name + "_stored.dof")))
    # CalculiX prints each frequency twice; without a choice of diameters once, those of 0.
    theirs = {nd or 0: np.array(hertz[: 2 * len(own[nd or 0])]) for nd, hertz in theirs.items()}
    if matching == "projected":
        # CalculiX interpolates as well, but its rigid motions meet forces: no frequency of it is exact.
        zero = {nd: 1e-4 * hertz.max() for nd, hertz in theirs.items()}
        rigid = [sum(np.sum(np.array(all_of[nd]) < zero[nd]) for nd in theirs) for all_of in (own, theirs)]
        above = max(difference(hertz[hertz > 0.1 * hertz.max()], np.array(own[nd])) for nd, hertz in theirs.items())
        return rows, f"cannot: faces do not match; {rigid[0]} rigid motions, 2 x {rigid[1] / 2:g} in CalculiX; others differ by {above:.1e}"
    gap = max(difference(hertz, np.array(own[nd])) for nd, hertz in theirs.items())
    if gap > PRINTED and any(keyword(card) == "*STATIC" for card in deck):
        return rows, f"cannot: without cyclic symmetry and its contacts the static step has other stresses (differs by {gap:.1e})"
    return rows, gap


def told(name):
    text = open_deck(name)
    deck = first_step(cards(text))
    is_wheel = any(map(is_cyclic_tie, deck))
    if is_wheel:
        deck = with_exact_faces(deck)
    write(name, deck)
    write(name + "_stored", stored(deck))
    error = ccx(name)
    theirs = printed(name)
    error_stored = ccx(name + "_stored")
    matrices = os.path.join(work, name + "_stored.sti")
    if not os.path.exists(matrices) or not os.path.getsize(matrices):
        return "", f"cannot: CalculiX stores no matrices ({error_stored or 'nothing said'})"
    if not theirs:
        return "", f"cannot: CalculiX prints no frequencies ({error or 'nothing said'})"
    try:
        rows, gap = wheel(name, deck, theirs) if is_wheel else plain(name, theirs)
    except (hbvib.Error, ValueError) as error:
        return "", "refused: " + sentence(str(error))
    if isinstance(gap, str):
        return rows or "", gap
    return rows, ("equal, %.1e" if gap <= PRINTED else "**differs** by %.1e") % gap


def open_deck(name):
    path = os.path.join(decks, name + ".inp")
    with open(path, errors="replace") if os.path.exists(path) else gzip.open(path + ".gz", "rt", errors="replace") as file:
        return file.read()


names = sorted({file.split(".inp")[0] for file in os.listdir(decks) if ".inp" in file})
names = [name for name in sys.argv[4:] or names if re.search(r"(?im)^\*FREQUENCY", open_deck(name))]
print("| deck | rows | frequencies |\n|---|---|---|")
results = []
for name in names:
    rows, result = told(name)
    results.append(result)
    print(f"| {name} | {rows} | {result} |", flush=True)
for word in ("equal", "refused", "cannot", "**differs"):
    print(word.strip("*"), sum(result.startswith(word) for result in results), "of", len(results))
sys.exit(any(result.startswith("**differs") for result in results))
