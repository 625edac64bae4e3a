"""The program of the known cases of solutions that a sweep does not show, with few chains; a figure has children in colours."""

import os
import sys

os.environ.setdefault("MPLBACKEND", "Agg")

from common import check, finish, hbvib

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
sys.path.append(os.path.join(ROOT, "examples/python"))

import all_solutions

all_solutions.main(["--chains", "2"])
check("known cases are met", not all_solutions.FAILED, all_solutions.FAILED)

coupling = 0.1
model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1 + coupling, -coupling], [-coupling, 1 + coupling]])
for dof in (0, 1):
    model.add_contact("cubic", dof, cubic=1)
mode = model.nonlinear_mode((-1, 0.5), harmonics=3, mode_index=1, branches=1)
above, below = mode.plot(label="mode")
check("a line for the mode and each child", len(above.lines) == len(below.lines) == 3)
check("in colours", len({line.get_color() for line in above.lines}) == 3)
check("the label is that of the mode", [line.get_label() == "mode" for line in above.lines] == [True, False, False])
check("children of a mode have its model", all(child.descent.periods == 1 for child in mode.children))

finish(5)
