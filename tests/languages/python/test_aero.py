"""Aerodynamic influence: responses, modes and limit cycles of a ring against closed forms, read-back, and what is refused."""

import warnings

import numpy as np

from common import check, close, finish, hbvib, raises

SECTORS, OMEGA = 5, 0.8
COEFFICIENTS = np.array([[[-0.1 - 0.05j, 0.02], [-0.03 + 0.01j, -0.2]], [[0.07, 0.04j], [0.05, -0.02 + 0.03j]]])
OFFSETS = [0, -2]


def ring(engine_order):
    return hbvib.Model.cyclic(2, sectors=SECTORS, engine_order=engine_order, mass=np.eye(2), stiffness=3 * np.eye(2))


for engine_order in (1, -1, 7):
    model = ring(engine_order)
    model.set_aero([0, 1], COEFFICIENTS, OFFSETS)
    model.set_aero([0, 1], -0.02 * np.eye(2)[None], [0], "velocity")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        branch = model.forced_response((OMEGA, OMEGA), harmonics=1, tolerance=0)
    check("and the reason is told", len(caught) == 1 and "no force acts" in str(caught[0].message), caught)
    check("flutter is no forced response", branch.status == hbvib.Status.STOPPED_NO_FORCE)
    model.add_force(0, 1.0)
    x = model.forced_response((OMEGA, OMEGA), harmonics=1, tolerance=0).harmonics(0)[1]
    lag = np.exp(-2j * np.pi * engine_order / SECTORS * np.array(OFFSETS))
    z = (3 - OMEGA**2 + 0.02j * OMEGA) * np.eye(2) - np.tensordot(lag, COEFFICIENTS, 1)
    close("the force balances", z @ x, [1, 0], 1e-12)
    check("the other form stays", model.aero("velocity").coefficient.tolist() == [-0.02, 0, 0, -0.02])
    entries = model.aero()
    check("coefficients come in their order", (entries.coefficient == COEFFICIENTS.ravel()).all())
    check("rows are forces", entries.dof_force.tolist() == [0, 0, 1, 1] * 2 and entries.dof_motion.tolist() == [0, 1] * 4)
    check("offsets are the given ones", entries.offset.tolist() == [0] * 4 + [-2] * 4)
    again = hbvib.Model.from_bytes(model.to_bytes())
    check("a saved model has them", (again.aero().coefficient == entries.coefficient).all())
    raises("complex coefficients in time", NotImplementedError, model.time_response, OMEGA, words="complex")
    model.set_aero([], [], [])
    check("they are removed", model.aero().coefficient.size == 0)

# Friction limits the flutter of one wave.
single = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, damping=0.01)
single.set_aero(0, [-0.05, 0.05], [1, -1])  # A(d) = 0.1 i sin(2 pi d / 8) feeds the wave of diameter 2
single.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
mode = single.nonlinear_mode((-2, 2), diameter=2, harmonics=31, tolerance=0)
cycles = mode.limit_cycles()
check("friction limits the flutter", cycles.omega.size >= 1, cycles)
if cycles.omega.size:
    stable = single.floquet(mode, int(cycles.point[0]))
    trivial = [k for k in stable.classes if "trivial" in str(k).lower()]
    check("a limit cycle has one trivial multiplier", len(trivial) == 1, stable)

model = ring(1)
raises("a dof that is none", IndexError, model.set_aero, 2, [1.0], [0], words="dofs[0] = 2")
raises("a shape", ValueError, model.set_aero, [0, 1], [1.0, 2.0], [0, 1], words="shape")
raises("a form", ValueError, model.set_aero, 0, [1.0], [0], "acceleration", words="displacement")
raises("a sector twice", ValueError, model.set_aero, 0, [1.0, 2.0], [1, -4], words="offsets[0] and offsets[1]")
raises("not finite", ValueError, model.set_aero, 0, [np.nan], [0], words="coefficients[0]")
raises("a plain structure", NotImplementedError, hbvib.Model(mass=1, stiffness=1).set_aero, 0, [1.0], [0], words="plain")

finish(30)
