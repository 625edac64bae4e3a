"""Cases whose answers must not depend on a tuned number: curves of the stored results, and every example of the Python interface.

A case returns the words and numbers of its answer: peaks, folds, solutions at requested frequencies, never the number of points or
iterations. Beside each is the tolerance of the numbers: that of the solve, or of the location of special points."""

import doctest
import importlib
import io
import os
import pkgutil
import re
import sys
import warnings
from contextlib import redirect_stdout

import numpy as np
import scipy.sparse

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "../../include"))
sys.path.append(os.path.join(HERE, "../stored_results"))

import hbvib  # noqa: E402
import hbvib.testing  # noqa: E402
from cases_blisk import B2, RANGE, blisk  # noqa: E402
from cases_laws import _CARRIED, structure  # noqa: E402
from cases_linear import plate  # noqa: E402
from cases_sectors import sector  # noqa: E402

warnings.simplefilter("ignore")

#: With fixed harmonics answers are solutions, and special points are located to about this.
EXACT = 1e-5
#: With a tolerance of 1e-3 two runs differ by twice that at most.
TOLERANT = 2e-3

#: Functions by name, with the tolerance of their numbers.
CASES = {}


def curve(branch):
    """Status, highest peak and folds of a curve. Low peaks next to a fold are found or not as its steps fall."""
    peaks, folds = branch.peaks(), branch.folds()
    found = [branch.status.name, len(folds.omega), *folds.omega, *folds.amplitude]
    if len(peaks.omega):
        highest = int(np.argmax(peaks.amplitude))
        found += [peaks.omega[highest], peaks.amplitude[highest]]
    return found


def at(branch, count):
    """The solutions at requested places."""
    return [x for i in range(count) for x in branch.at(i).amplitude]


def case(tolerance):
    def register(function):
        CASES[function.__name__] = (function, tolerance)
        return function
    return register


def _add(name, tolerance, function):
    CASES[name] = (function, tolerance)


def _law(add, options):
    model = structure(constant=0.15)
    add(model)
    branch = model.forced_response((0.28, 1.0), at=[0.5, 0.8], **options)
    # Small peaks may come and go within a tolerance.
    return (curve(branch) if options else [branch.status.name]) + at(branch, 2)


for _name, _adds in _CARRIED.items():
    if not _name.startswith(("user", "mixed", "refusals", "derivatives", "preload")):
        _add(f"law_{_name}", EXACT, lambda add=_adds: _law(add, dict(harmonics=5)))
        _add(f"law_{_name}_tolerance", TOLERANT, lambda add=_adds: _law(add, {}))


@case(EXACT)
def duffing():
    branch = hbvib.testing.duffing_oscillator().forced_response((0.3, 2.2), at=[1.5], harmonics=7)
    return curve(branch) + at(branch, 1)


@case(EXACT)
def duffing_stability():
    branch = hbvib.testing.duffing_oscillator(1.0).forced_response((0.3, 3.0), harmonics=7, stability=1)
    return curve(branch) + [len(branch.bifurcations().omega), *branch.bifurcations().omega]


@case(TOLERANT)
def stick_and_slip():
    branch = hbvib.testing.friction_oscillator().forced_response((0.2, 1.6), at=[0.41, 1.2])
    return curve(branch) + at(branch, 2)


@case(EXACT)
def ring_damper():
    branch = blisk(5).forced_response(RANGE, harmonics=9, at=[2 * np.pi * 208.85])
    return curve(branch) + at(branch, 1)


@case(TOLERANT)
def ring_damper_tolerance():
    branch = blisk(20).forced_response(RANGE, response_dof=B2, at=[2 * np.pi * 208.85])
    return curve(branch) + at(branch, 1)


@case(2e-4)
def ring_damper_tight():
    return curve(blisk(5).forced_response(RANGE, response_dof=B2, tolerance=1e-4))


@case(TOLERANT)
def ring_damper_mode():
    branch = blisk(0).nonlinear_mode((-4, -2), at=[-3.0, -2.5], tolerance=1e-3)
    points = [branch.mode_point(branch.at(i).point[0]) for i in range(2)]
    return [branch.status.name] + [x for point in points for x in (point.omega, point.damping_ratio)]


@case(EXACT)
def sector_friction():
    branch = sector(3, contact="friction_3d").forced_response((0.9, 1.7), harmonics=4, at=[1.3])
    return curve(branch) + at(branch, 1)


@case(EXACT)
def sector_impact():
    branch = sector(3, contact="unilateral").forced_response((0.9, 1.7), harmonics=4, at=[1.3])
    return curve(branch) + at(branch, 1)


@case(TOLERANT)
def sector_tolerance():
    branch = sector(3).forced_response((0.9, 1.7), at=[1.3])
    return curve(branch) + at(branch, 1)


def _plate(n, sparse, damping=None, **options):
    made = plate(n)
    if damping == "general":
        made["damping"] = 0.004 * made["stiffness"]
        made["damping"][0, 0] += 0.05
        made["damping"][n // 2, n // 2] += 0.03
    if sparse:
        made = {name: scipy.sparse.csc_matrix(matrix) for name, matrix in made.items()}
    model = hbvib.Model(**made)
    model.add_contact("jenkins", 0, n - 1, kt=3.0, mu=0.3, preload=1.0)
    model.add_contact("unilateral", n // 3, -1, kn=1.0, gap=0.2)
    model.add_force(n - 1, 0.5)
    branch = model.forced_response((0.3, 0.6), at=[0.4, 0.5], **options)
    return [branch.status.name] + at(branch, 2)


_add("plate_60", EXACT, lambda: _plate(60, False, harmonics=5))
_add("plate_60_tolerance", 2e-2, lambda: _plate(60, False, tolerance=1e-2))
_add("plate_60_damped", EXACT, lambda: _plate(60, False, "general", harmonics=5))
_add("plate_300", EXACT, lambda: _plate(300, True, harmonics=3))
_add("plate_300_tolerance", 2e-2, lambda: _plate(300, True, tolerance=1e-2))
_add("plate_300_damped", EXACT, lambda: _plate(300, True, "general", harmonics=3))


@case(1e-7)
def modes_of_a_plate():
    model = hbvib.Model(**{name: scipy.sparse.csc_matrix(matrix) for name, matrix in plate(700).items()})
    return list(model.linear_modes(6).omega) + list(np.abs(model.damped_modes(4).eigenvalue))


def _time(name, omega):
    model = structure(constant=0.15)
    _CARRIED[name](model)
    found = model.time_response(omega, harmonics=7, samples=16, max_periods=400)
    return list(np.abs(found.harmonics[:3]).ravel())


for _name in ("jenkins", "friction_2d", "unilateral", "cubic", "iwan", "table", "regularised"):
    _add(f"time_{_name}", 1e-6, lambda name=_name: _time(name, 0.7))


@case(1e-5)
def floquet():
    model = sector(3)
    branch = model.forced_response(1.3, harmonics=15)
    return sorted(np.abs(model.floquet(branch, 0).multipliers))


#: Examples that print points of a curve, which lie where its steps lead.
_PLACES = ("BranchPoints.point", "BranchPoints.synthesis", "HasUnits.units", "_Analyses.forced_response", "_tables.from_dataframe")

_NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:e[+-]?\d+)?")


def _tokens(text):
    """Words and numbers of what an example prints; a number has at least half a unit of its last digit as tolerance."""
    found = []
    for piece in re.split(r"(-?\d+(?:\.\d*)?(?:e[+-]?\d+)?)", text):
        if _NUMBER.fullmatch(piece):
            digits = piece.lower().split("e")[0]
            decimals = len(digits.split(".")[1]) if "." in digits else 0
            power = int(piece.lower().split("e")[1]) if "e" in piece.lower() else 0
            found.append((float(piece), 1.01 * 10.0 ** (power - decimals)))
        elif piece.strip():
            found.append(" ".join(piece.split()))
    return found


def _example(test):
    """Runs an example of the interface and returns what it prints."""
    printed = io.StringIO()

    class Runner(doctest.DocTestRunner):
        def report_failure(self, out, test, example, got):
            printed.write(got)

        def report_success(self, out, test, example, got):
            printed.write(got)

        def report_unexpected_exception(self, out, test, example, exc_info):
            raise exc_info[1]

    copy = doctest.DocTest(test.examples, dict(test.globs), test.name, test.filename, test.lineno, test.docstring)
    with redirect_stdout(io.StringIO()):
        Runner(verbose=False, optionflags=doctest.ELLIPSIS).run(copy, out=lambda text: None)
    return _tokens(printed.getvalue())


def _examples():
    seen = set()
    for module in pkgutil.iter_modules(hbvib.__path__):
        if module.name == "__main__":
            continue
        for test in doctest.DocTestFinder(exclude_empty=True).find(importlib.import_module(f"hbvib.{module.name}")):
            if test.examples and test.name not in seen and not test.name.endswith(_PLACES):
                seen.add(test.name)
                _add(f"example {test.name.split('hbvib.')[1]}", TOLERANT, lambda test=test: _example(test))


_examples()
