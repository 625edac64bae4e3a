"""Every figure of the book is drawn by the program and the function that its page names: some of them with each change, all in
tests/deep.sh."""

import glob
import os
import re
import sys
import tempfile

os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np
from matplotlib import image

from common import THOROUGH, check, finish

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
sys.path.append(os.path.join(ROOT, "examples/python"))

import gallery

STORED = {os.path.basename(path)[:-4]: image.imread(path) for path in glob.glob(os.path.join(ROOT, "docs/figures/*.png"))}
check("stored figures are those of the program", STORED.keys() == gallery.FIGURES.keys(), STORED.keys())


def difference(one, other):
    """Mean difference of two pictures from 0 to 1; 1 where their sizes differ."""
    return float(np.abs(one - other).mean()) if one.shape == other.shape else 1.0


with tempfile.TemporaryDirectory() as folder:
    names = list(gallery.FIGURES)[:: 1 if THOROUGH else 4]
    gallery.main([folder, *names])
    drawn = {name: image.imread(os.path.join(folder, name + ".png")) for name in names}
# Versions of matplotlib place and smooth lines differently; other figures differ by more than twice as much.
for name, figure in drawn.items():
    found = difference(figure, STORED[name])
    check(f"{name}.png is the figure that {name}() draws", found < 0.01, f"(difference {found:.4f})")
    for other, stored in STORED.items():
        if other != name:
            check(f"{name} is told from {other}", difference(figure, stored) > 0.02, difference(figure, stored))

shown = set()
for page in glob.glob(os.path.join(ROOT, "docs/**/*.md"), recursive=True):
    with open(page, encoding="utf-8") as file:
        text = file.read()
    for name in re.findall(r"!\[[^\]]*\]\([./]*figures/(\w+)\.png\)", text):
        shown.add(name)
        check(f"{os.path.basename(page)} names {name}()", f"`{name}()`" in text and "examples/python/gallery.py" in text)
check("every figure is shown on a page", shown == STORED.keys(), shown ^ STORED.keys())

finish(40 if THOROUGH else 25)
