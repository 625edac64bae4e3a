"""Fit of five parameters of a finite-element sector with 60 contacts from 200 points (HBVIB_THOROUGH): the truth, within a minute of one
processor. Without it five points at one force, and two parameters."""

import os
import sys
import time

import numpy as np

from common import check, finish, hbvib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../stored_results"))
from cases_sectors import fe_sector  # noqa: E402

THOROUGH = "HBVIB_THOROUGH" in os.environ
points, forces, harmonics = (50, (0.2, 1.0, 2.0, 4.0), 3) if THOROUGH else (5, (2.0,), 1)
model, tip = fe_sector("rom", 1.0)
kt = [model.contact(i).constants["kt"] for i in range(60)]
first = model.linear_modes(1, 3, "stuck").omega[0]
omega, random = np.linspace(0.996 * first, 1.003 * first, points), np.random.default_rng(2)
data = []
for force in forces:
    loud = model.clone()
    loud.clear_forces()
    loud.add_force(tip, force)
    branch = loud.forced_response((omega[0], omega[-1]), at=omega, harmonics=harmonics, response_dof=tip)
    x = np.array([branch.harmonics(branch.at(i).point[0])[1, tip] for i in range(points)])
    sigma = 0.02 * abs(x)
    x = x + sigma / np.sqrt(2) * (random.standard_normal(points) + 1j * random.standard_normal(points))
    data.append(hbvib.Measured("response", omega, x, sigma, force=force))
# One factor on all contact stiffnesses, which differ by the areas of the nodes.
unknowns = [hbvib.Unknown(hbvib.Parameter("kt", i), kt[i] / 1.2, tied_to=0 if i else -1) for i in range(60)]
unknowns += [hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), 1.3), hbvib.Unknown(hbvib.Parameter("stiffness", scaling="factor"), 1.002),
             hbvib.Unknown(hbvib.Parameter("mu"), 0.36), hbvib.Unknown(hbvib.Parameter("force"), 0.97)]
truth = np.array([*kt, 1, 1, 0.3, 1])
if not THOROUGH:
    unknowns = unknowns[60:62]
    truth = truth[60:62]
begin = time.process_time()
fit = model.fit(unknowns, data, harmonics=harmonics, response_dof=tip)
spent = time.process_time() - begin
check("the truth is near", (abs(fit.theta - truth) < 4 * np.maximum(fit.sd, 1e-12)).all(), fit)
check("chi2 is near its degrees of freedom", 0.3 < fit.chi2 / fit.degrees_of_freedom < 2.2, fit.chi2)
if THOROUGH:
    print(f"200 points: {spent:.1f} s of processor time, {fit.info.iterations} iterations on all points")
    check("in a minute", spent < 60, spent)

finish(2)
