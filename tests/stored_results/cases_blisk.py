"""The bladed disk with its ring damper: forced responses and nonlinear modes."""

import json
import os

import numpy as np
from record import case, cases

import hbvib

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../data/model.json"), encoding="utf-8") as _file:
    _DATA = json.load(_file)
B2, B1, D, R = range(4)
HZ = 2 * np.pi
RANGE = (HZ * 207, HZ * 211)
RADIUS = 0.165


def blisk(force=5.0, ring_mass=0.03, rpm=3000, engine_order=2, contact=True, beta=1.5e-6, sectors=24):
    """One sector under an engine order, forced at both masses of the blade."""
    k, m = _DATA["stiffness_N_per_m"], _DATA["masses_kg"]
    own = np.array([[k["Kb2"], -k["Kb2"], 0, 0], [-k["Kb2"], k["Kb2"] + k["Kb1"], -k["Kb1"], 0],
                    [0, -k["Kb1"], k["Kb1"] + k["KG"] + 2 * k["Kd"], 0], [0, 0, 0, 2 * k["Kr"]]], float)
    model = hbvib.Model.cyclic(
        sectors=sectors, engine_order=engine_order, mass=np.diag([m["Mb2"], m["Mb1"], m["Md"], ring_mass]),
        stiffness=own, coupling=dict(stiffness=np.diag([0.0, 0.0, -k["Kd"], -k["Kr"]])), rayleigh=(0, beta))
    if contact:
        spin = rpm * HZ / 60
        model.add_contact("jenkins", D, R, kt=k["kt"], mu=_DATA["mu"], preload=ring_mass * RADIUS * spin * spin)
    for dof in (B2, B1):
        if force:
            model.add_force(dof, force)
    return model


_AT = HZ * np.array([207.5, 208.85, 210.0])
_SWEEPS = {
    "H1_5N": (5, dict(harmonics=1)),
    "H3_5N": (5, dict(harmonics=3)),
    "H9_1N": (1, dict(harmonics=9)),
    "H9_5N": (5, dict(harmonics=9)),
    "H9_20N": (20, dict(harmonics=9)),
    "H9_down": (5, dict(harmonics=9, omega=RANGE[::-1])),
    "H31_5N": (5, dict(harmonics=31)),
    "H63_20N": (20, dict(harmonics=63)),
    "H5_even_kept": (5, dict(harmonics=5, keep_even_harmonics=1)),
    "H5_sampled": (5, dict(harmonics=5, samples=64)),
    "H9_sampled": (20, dict(harmonics=9, samples=256)),
    "H7_estimate": (5, dict(harmonics=7, estimate_error=1)),
    "tolerance_2": (5, dict(tolerance=1e-2, response_dof=B2)),
    "tolerance_3": (5, dict(response_dof=B2)),
    "tolerance_3_20N": (20, dict(response_dof=B2)),
    "tolerance_3_50N": (50, dict(response_dof=B2)),
    "tolerance_3_down": (20, dict(response_dof=B2, omega=RANGE[::-1])),
    "tolerance_4": (5, dict(tolerance=1e-4, response_dof=B1)),
    "tolerance_3_sampled": (5, dict(tolerance=1e-2, samples=128)),
    "tolerance_capped": (20, dict(tolerance=1e-5, max_harmonics=15)),
    "tight_steps": (5, dict(harmonics=3, step=1e-3, step_max=0.05)),
    "few_points": (5, dict(harmonics=3, max_points=7)),
    "few_iterations": (5, dict(harmonics=3, max_newton=3)),
    "too_few_samples": (5, dict(harmonics=9, samples=18)),
}


@cases("blisk", _SWEEPS)
def sweep(record, given):
    force, options = given
    options = dict(options)
    omega = options.pop("omega", RANGE)
    record.solve("sweep", blisk(force).forced_response, omega, at=_AT, log=True, **options)


@case("blisk")
def single_points(record):
    model = blisk(5)
    for f in (208.0, 208.85, 210.5):
        for h in (1, 9, 31):
            record.solve(f"{f}_H{h}", model.forced_response, HZ * f, harmonics=h)
        record.solve(f"{f}_default", model.forced_response, HZ * f)
    first = model.forced_response(HZ * 208.85, harmonics=9)
    record.solve("guess", model.forced_response, HZ * 208.86, harmonics=9, guess=first.harmonics(0))


@case("blisk")
def other_speeds_and_orders(record):
    for rpm, order in ((1000, 2), (6000, 2), (3000, 0), (3000, 5), (3000, 12), (3000, 22)):
        record.solve(f"{rpm}_{order}", blisk(5, rpm=rpm, engine_order=order).forced_response, (HZ * 190, HZ * 240),
                     harmonics=5, points=2)


@case("blisk")
def residuals(record):
    model = blisk(5)
    x = model.forced_response(HZ * 208.85, harmonics=5).harmonics(0)
    for factor in (1.0, 0.1, 3.0):
        for samples in (0, 64):
            found = record.attempt("residual", model.forced_residual, HZ * 209, factor * x, jacobian=True, d_omega=True,
                                   samples=samples)
            record.write(f"residual_{factor}_{samples}", found)


_MODES = {
    "H1": dict(harmonics=1),
    "H3": dict(harmonics=3),
    "H9": dict(harmonics=9),
    "H31": dict(harmonics=31),
    "even_kept": dict(harmonics=5, keep_even_harmonics=1),
    "sampled": dict(harmonics=5, samples=128),
    "estimate": dict(harmonics=5, estimate_error=1),
    "stiffness_form": dict(harmonics=9, damping_form="stiffness"),
    "tolerance_2": dict(tolerance=1e-2),
    "tolerance_3": dict(),
    "tolerance_stiffness_form": dict(tolerance=1e-2, damping_form="stiffness"),
    "second": dict(harmonics=5, mode_index=1),
    "near": dict(harmonics=5, near_omega=HZ * 800),
    "diameter_3": dict(harmonics=5, diameter=3),
    "diameter_0": dict(harmonics=3, diameter=0),
    "diameter_12": dict(harmonics=3, diameter=12),
    "reference": dict(harmonics=5, reference_dof=R, response_dof=B1),
    "no_such_mode": dict(harmonics=5, mode_index=9),
}


@cases("blisk_mode", _MODES)
def mode(record, options):
    model = blisk(0)
    record.solve("mode", model.nonlinear_mode, (-5.5, -2.5), at=[-4.2, -3.5], log=True, **options)


@case("blisk_mode")
def amplitude_of_contact(record):
    for name, options in dict(fixed=dict(harmonics=9), free=dict(), stiff=dict(harmonics=3, damping_form="stiffness"),
                              capped=dict(tolerance=1e-5, max_harmonics=15)).items():
        record.solve(name, blisk(0).nonlinear_mode, (-8, -5), amplitude_contact=0, at=[-6.5], **options)


@case("blisk_mode")
def shape(record):
    record.solve("shape", blisk(0).nonlinear_mode, (-5, -4), shape=[1, 0.5, 0.01j, 0], harmonics=3)


@case("blisk_mode")
def synthesis(record):
    model = blisk(20)
    for name, options in dict(fixed=dict(harmonics=9), free=dict(), undamped=dict(harmonics=5)).items():
        base = blisk(20, beta=0) if name == "undamped" else model
        mode = base.nonlinear_mode((-6, -1), response_dof=B2, **options)
        for factor in (0.05, 0.25, 1.0):
            for extra in (dict(), dict(damping_ratio=1e-3), dict(model_damping=1)):
                label = f"{name}_{factor}_{'_'.join(extra)}"
                record.write(label, record.attempt(label, mode.synthesis, model, force_factor=factor, **extra))
                label += "_peaks"
                record.write(label, record.attempt(label, mode.synthesis_peaks, model, force_factor=factor, **extra))
    record.write("no_force", record.attempt("no_force", mode.synthesis, blisk(0)))


@case("blisk")
def full_wheel(record):
    """Some sectors in one plain structure: many coordinates, and waves that contacts may couple."""
    n, sectors = 4, 6
    k, m = _DATA["stiffness_N_per_m"], _DATA["masses_kg"]
    mass, stiff = np.zeros((n * sectors,) * 2), np.zeros((n * sectors,) * 2)
    own = np.array([[k["Kb2"], -k["Kb2"], 0, 0], [-k["Kb2"], k["Kb2"] + k["Kb1"], -k["Kb1"], 0],
                    [0, -k["Kb1"], k["Kb1"] + k["KG"] + 2 * k["Kd"], 0], [0, 0, 0, 2 * k["Kr"]]], float)
    coupling = np.diag([0.0, 0.0, -k["Kd"], -k["Kr"]])
    for s in range(sectors):
        here, after = slice(n * s, n * s + n), slice(n * ((s + 1) % sectors), n * ((s + 1) % sectors) + n)
        mass[here, here] = np.diag([m["Mb2"], m["Mb1"], m["Md"], 0.03])
        stiff[here, here] += own
        stiff[here, after] += coupling
        stiff[after, here] += coupling.T
    model = hbvib.Model(mass=mass, stiffness=stiff, rayleigh=(0, 1.5e-6))
    for s in range(sectors):
        model.add_contact("jenkins", n * s + D, n * s + R, kt=k["kt"], mu=0.3, preload=400 + 20 * s)
        lag = np.exp(-2j * np.pi * 2 * s / sectors)
        model.add_force(n * s + B2, 20 * lag)
    record.solve("H3", model.forced_response, RANGE, harmonics=3, points=2)
    record.solve("H7", model.forced_response, HZ * 209, harmonics=7)
    record.solve("default", model.forced_response, HZ * 209, tolerance=1e-2)
    record.solve("mode", model.nonlinear_mode, (-5, -4), harmonics=3, points=2)
