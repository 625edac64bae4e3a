"""A wheel of finite-element sectors on ten cantilever modes a blade, against the wheel solved in full: the example on a small mesh."""

import importlib.util
import pathlib

import numpy as np

from common import check, finish, hbvib

try:
    import scipy.sparse.linalg as found
except ImportError:
    found = None
if found:
    path = pathlib.Path(__file__).resolve().parents[3] / "examples" / "python" / "wheel_of_fe_sectors.py"
    spec = importlib.util.spec_from_file_location("wheel_of_fe_sectors", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    # The motions that ten modes a blade lack under the force on its tip: fewer modes lack more.
    error = example.small((6, 1, 2), (2, 1, 6), 6)
    check("ten modes a blade are near to the wheel in full", error < 3e-4, error)
    wheel, model, weights = example.reduced_wheel(example.Sector((6, 1, 2), (2, 1, 6)), 10, np.array([2.0, -1.0, 3.0, 0.0, -2.0, 1.0]) / 100)
    omega = model.linear_modes(1, 3).omega[0]
    branch = wheel.forced_response((0.97 * omega, 1.0 * omega), harmonics=1, tolerance=0, response_dof=next(iter(weights)))
    way = branch.reduction.flexibility_way
    check("the reduced wheel is solved as a tuned one", way == hbvib.FlexibilityWay.TUNED_WHEEL, way)
    slip = max(branch.slip(point).max() for point in range(len(branch.omega)))
    check("some contact slips", slip > 0.0, slip)
finish(3)
