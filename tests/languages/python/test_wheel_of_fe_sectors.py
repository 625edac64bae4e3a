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

    # The library's own reduction of the blade alone, whose modes are found by iteration: the disk stays as it is.
    sector, pattern = example.Sector((8, 2, 3), (2, 2, 12)), np.array([2.0, -1.0, 3.0, 0.0, -2.0, 1.0]) / 100
    full, whole, tip = example.full_wheel(sector, pattern)
    place = {dof: number for number, dof in enumerate(np.setdiff1d(np.arange(sector.n), sector.right))}
    blade = whole.on_blade_modes([place[dof] for dof in sector.blade], 10, points=list(tip))
    reduced = blade.model.wheel()
    reduced.mistune(blade.model, "frequency", pattern, dofs=blade.modes)
    exact = whole.linear_modes(1, 3).omega[0]
    error = blade.model.linear_modes(1, 3).omega[0] / exact - 1
    check("its frequencies err as told", 0 < error < 1.2 * blade.left_out and blade.left_out < 1e-4, (error, blade.left_out))
    watched = blade.response(next(iter(tip)))
    omega = exact * np.array([0.99, 1.0, 1.01])
    known = example.tips(full, whole, tip, omega)
    found = example.tips(reduced, blade.model, dict(zip(watched.dofs.tolist(), watched.weights.tolist())), omega)
    check("its blades move as in full", abs(found - known).max() < 1e-3 * known.max(), abs(found - known).max() / known.max())
finish(5)
