"""The oscillators of docs/coming-from.md in pyHarm and here: the same responses, point for point.

Needs pyharm-os; tests/deep.sh runs it. The program of pyHarm is that of the page."""

import logging
import os
import re
import sys
import tempfile

import numpy as np

import hbvib

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
with open(os.path.join(ROOT, "docs/coming-from.md"), encoding="utf-8") as file:
    PAGE = file.read()
(PROGRAM,) = re.findall(r"(?ms)^```pyharm\n(import numpy.*?)^```", PAGE)
(JENKINS,) = re.findall(r"`(\{\"type\": \"Jenkins\".*?\})`", PAGE)


def peer(program):
    """Frequencies and amplitudes of harmonic 1 of every accepted point of pyHarm."""
    logging.disable(logging.CRITICAL)
    os.chdir(tempfile.mkdtemp())  # pyHarm writes files where it runs
    scope = {}
    exec(program, scope)
    study = scope["study"]
    (response,) = study.nls.values() if isinstance(study.nls, dict) else study.nls
    degrees = study.system.expl_dofs
    one = [int(np.flatnonzero((degrees["harm"] == 1) & (degrees["cs"] == kind))[0]) for kind in "cs"]
    points = [s for s in response.SolList if s.flag_accepted]
    return np.array([s.x[-1] for s in points]), np.array([np.hypot(*s.x[one]) for s in points])


def compare(title, program, model, harmonics, allowed, **options):
    omega, amplitude = peer(program)
    inside = (omega > 0.31) & (omega < (2.19 if title == "Duffing" else 1.59))
    omega, amplitude = omega[inside], amplitude[inside]
    branch = model.forced_response(
        (0.3, 2.2) if title == "Duffing" else (0.3, 1.6), harmonics=harmonics, at=omega, tol_residual=1e-12, **options
    )
    errors = [np.min(np.abs(branch.at(k).amplitude / a - 1)) for k, a in enumerate(amplitude)]
    print(f"{title}: {len(omega)} points of pyHarm, largest difference {max(errors):.1e}, allowed {allowed:.0e}")
    if len(omega) < 40 or not max(errors) < allowed:
        sys.exit(f"{title}: the responses differ")


model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
model.add_contact("cubic", 0, cubic=1)
model.add_force(0, 0.3)
compare("Duffing", PROGRAM, model, 7, 1e-6)

model = hbvib.Model(mass=1, damping=0.02, stiffness=1)
model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
model.add_force(0, 0.2)
jenkins = PROGRAM.replace('{"type": "CubicSpring", "connect": {"mass": [0]}, "dirs": [0], "k": 1.0}', JENKINS)
assert jenkins != PROGRAM
jenkins = jenkins.replace('"C": 0.1 * one', '"C": 0.02 * one').replace('"amp": 0.3', '"amp": 0.2')
jenkins = jenkins.replace('"puls_sup": 2.2', '"puls_sup": 1.6').replace('"nti": 256', '"nti": 2048')
# pyHarm samples the slider 2048 times a period; here its events are exact.
compare("Jenkins", jenkins, model, 7, 1e-4)
