"""Numbers of the Python module for check.m, as JSON: the same library has to give the same bits to both."""
import json
import struct
import sys

import numpy as np

import hbvib


def pairs(x):
    x = np.asarray(x, complex)
    return [np.real(x).ravel().tolist(), np.imag(x).ravel().tolist()]


out = {}
# README: a mass on a spring rubs against the ground.
model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
model.add_force(0, 0.2)
branch = model.forced_response((0.8, 1.6), at=[1.0, 1.2])
peak = branch.peaks()
out["readme"] = dict(
    omega=branch.omega.tolist(), amplitude=branch.amplitude.tolist(), peak=peak.omega.tolist(), point=peak.point.tolist(),
    motion=pairs(branch.harmonics(peak.point[0])), slip=branch.slip(peak.point[0]).tolist(), at=branch.at(1).amplitude.tolist(),
    work=branch.summary(peak.point[0], 0).work, loss=branch.energy(peak.point[0]).structural_loss,
    error=model.verify(branch, peak.point[0]).info.response_error,
    time=pairs(model.time_response(1.0).harmonics))
# A nonlinear mode of three masses with two contacts, and the resonances that it predicts.
mass, stiffness = np.diag([1.0, 1.0, 0.5]), np.array([[2000.0, -1000, 0], [-1000, 2000, -1000], [0, -1000, 1000]])
model = hbvib.Model(mass=mass, stiffness=stiffness, rayleigh=(0, 2e-4))
model.add_contact("jenkins", 1, kt=500, mu=0.3, preload=10)
model.add_contact("jenkins", 2, 1, kt=300, mu=0.3, preload=5)
model.add_force(0, 2.0)
mode = model.nonlinear_mode((-3, 0), mode_index=0)
predicted = mode.synthesis_peaks(model)
out["mode"] = dict(
    omega=mode.omega.tolist(), damping=mode.damping_ratio.tolist(), log10_amplitude=mode.log10_amplitude.tolist(),
    predicted=predicted.omega.tolist(), free=model.linear_modes(3, contacts="free").omega.tolist())
# A sector with both faces and friction on its left face.
chain = np.array([[2.0, -1, 0], [-1, 2, -1], [0, -1, 1]]) + np.diag([0.0, 1, 0])
sector = hbvib.Model.sector(stiffness=chain, mass=np.diag([0.5, 1, 0.5]), sectors=8, engine_order=2, left=[0], right=[2],
                            frame="cylindrical")
sector.set_rayleigh(0, 0.01)
sector.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=1)
sector.add_force(1, 0.1 + 0.05j)
response = sector.forced_response((0.8, 2.2), response_dof=1)
out["sector"] = dict(
    omega=response.omega.tolist(), amplitude=response.amplitude.tolist(),
    modes=sector.linear_modes(2, diameter=2).omega.tolist(), motion=pairs(response.harmonics(response.peaks().point[0])))
# A wheel by coupling matrices, with a sparse matrix and friction with varying normal load.
wheel = hbvib.Model.cyclic(sectors=6, engine_order=1, mass=np.eye(2), stiffness=np.array([[3.0, -1], [-1, 2]]),
                           coupling=dict(stiffness=np.array([[-0.5, 0], [0, 0]])), rayleigh=(0, 0.01))
wheel.add_contact("friction_2d", [0, 1], kt=1, kn=2, mu=0.3, preload=0.2)
wheel.add_force(0, 0.1)
turned = wheel.forced_response((0.9, 2.0), harmonics=5)
out["wheel"] = dict(omega=turned.omega.tolist(), amplitude=turned.amplitude.tolist())

# A wedge between two inclined planes, of which one sticks: free sliders and their band.
wedge = hbvib.Model(mass=np.diag([1, 0.01, 0.01]), damping=np.diag([0.04, 0.004, 0.004]), stiffness=np.diag([1, 1e-3, 1e-3]))
wedge.add_contact("friction_2d", [1, 2, -1], [-1, -1, -1], kt=1, kn=1.5, mu=0.6, normal=(1, -1, 0), tangent=(1, 1, 0))
wedge.add_contact("friction_2d", [1, 2, -1], [0, -1, -1], kt=1, kn=1.5, mu=0.15, normal=(-1, -1, 0), tangent=(-1, 1, 0))
wedge.add_force(2, 1, harmonic=0)
wedge.add_force(0, 0.02)
sweep = wedge.forced_response((1.2, 1.3), harmonics=7)
point = int(sweep.peaks().point[0])
sliders, band = wedge.freedom(sweep, point), wedge.band(sweep, point)
out["wedge"] = dict(
    contact=[float(one.contact) for one in sliders], place=[one.place for one in sliders],
    derivative=[one.derivative for one in sliders], ends=[band.lower.value, band.upper.value],
    lower=np.asarray(band.lower.places, float).tolist(), low=band.lower.branch.amplitude.tolist() if band.lower.branch else [])


# Laws of the caller: a damper with the square of the velocity, and a play with an internal state.
def damper(call):
    call.f[:] = 0.5 * call.v * abs(call.v)
    call.df_dv[:, 0, 0] = abs(call.v[:, 0])


def two(call):  # a cubic spring between two degrees of freedom
    d = call.u[:, 0] - call.u[:, 1]
    call.f[:, 0], call.f[:, 1] = d**3, -(d**3)
    for i, k, sign in ((0, 0, 1), (0, 1, -1), (1, 0, -1), (1, 1, 1)):
        call.df_du[:, i, k] = sign * 3 * d * d


own = hbvib.Model(mass=np.eye(2), stiffness=np.array([[2.0, -1], [-1, 2]]), rayleigh=(0, 0.02))
own.add_user_force([0], damper, uses_velocity=True, is_odd=True)
own.add_user_force([0, 1], two, is_odd=True)
own.add_force(0, 0.2)
solved = own.forced_response((0.8, 1.2), harmonics=5)
out["own"] = dict(omega=solved.omega.tolist(), amplitude=solved.amplitude.tolist(),
                  work=solved.summary(solved.peaks().point[0], 0).work)

# A detached curve beside a sweep, and a stop with motions of the double period.
isolated = hbvib.Model(mass=1, stiffness=1, damping=0.05)
isolated.add_spring_damper(0, damper=[0, 0, -0.05, 0, 0.012])
isolated.add_force(0, 0.015)
sweep = isolated.forced_response((0.9, 1.1), harmonics=3, branches=2)
child, = sweep.children
stop = hbvib.Model(mass=1, stiffness=1, damping=0.05)
stop.add_contact("unilateral", 0, kn=10)
stop.add_force(0, 1)
above = stop.forced_response((2.3, 2.5), harmonics=10, branches=1, at=[2.38])
doubled, = above.children
found, point = above.bifurcations(), int(doubled.at(0).point[0])
out["children"] = dict(
    omega=child.omega.tolist(), amplitude=child.amplitude.tolist(),
    forces=[child.descent.born_at_force, child.descent.merges_at_force], modes=float(sweep.searched.modes),
    bifurcations=found.omega.tolist(), points=found.point.tolist(), before=np.asarray(found.unstable_before, float).tolist(),
    doubled=doubled.omega.tolist(), motion=pairs(doubled.harmonics(point)),
    error=stop.longer_period(2).verify(doubled, point).info.response_error)


def bits(value):
    """Numbers as the hexadecimal digits of their bits, which no reader rounds."""
    if isinstance(value, dict):
        return {name: bits(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [bits(entry) for entry in value]
    return struct.pack(">d", value).hex()


json.dump(bits(out), sys.stdout)
