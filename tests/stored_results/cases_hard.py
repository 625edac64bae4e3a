"""The hard cases of tests/data/hardcases.json whose structure a few words describe."""

import json
import os

import numpy as np
from cases_blisk import B2, D, HZ, R, blisk
from record import case, cases

import hbvib

_FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../data")


def _read(name):
    with open(os.path.join(_FOLDER, name), encoding="utf-8") as file:
        return json.load(file)


_CASES = {entry["id"]: entry["params"] for entry in _read("hardcases.json")}
_SET = {
    "HC01": dict(), "HC02": dict(), "HC03": dict(), "HC04a": dict(), "HC04b": dict(),
    "HC05": dict(fc=lambda p: abs(p["F"] / (p["k"] + p["kt"] - p["w"] ** 2 + 1j * p["c"] * p["w"])) * (1 - 1e-6)),
    "HC06": dict(), "HC07": dict(), "HC21": dict(constant="F0"), "HC20": dict(constant=1.0, F=0.0, w=1.25),
    "HC29": dict(F3=True), "HC32": dict(),
}


@cases("hard", _SET)
def one_mass(record, change):
    p = dict(_CASES[record.label.split("/")[1]])
    for key, value in change.items():
        p[key] = value(p) if callable(value) else value
    model = hbvib.Model(mass=p["m"], stiffness=p["k"], damping=p["c"])
    if p["kt"] > 0:
        model.add_contact("jenkins", 0, kt=p["kt"], mu=1, preload=float(p["fc"]))
    if "F3" in change:
        model.add_force(0, _CASES["HC29"]["F3"], 3)
    elif p["F"]:
        model.add_force(0, p["F"])
    if "constant" in change:
        model.add_force(0, p[p["constant"]] if isinstance(p["constant"], str) else p["constant"], 0)
    w = p["w"]
    for h in (1, 2, 7, 31):
        record.solve(f"H{h}", model.forced_response, w, harmonics=h)
    record.solve("default", model.forced_response, w)
    record.solve("sweep", model.forced_response, (0.7 * w, 1.5 * w), harmonics=7, points=3)
    if p.get("F") and w > 1e-3:
        record.write("time", record.attempt("time", model.time_response, w, harmonics=5, max_periods=300))


@case("hard")
def HC08_scales(record):
    for s in _CASES["HC08"]["scales"]:
        model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        model.add_contact("jenkins", 0, kt=1, mu=1, preload=0.3 * s)
        model.add_force(0, 0.2 * s)
        record.solve(f"{s:g}", model.forced_response, 1.25, harmonics=7)
        record.solve(f"{s:g}_default", model.forced_response, 1.25)


_BLISKS = {"HC09": dict(), "HC10": dict(ring_mass=0.0), "HC10_light": dict(ring_mass=1e-9), "HC11": dict(engine_order=24),
           "HC12_22": dict(engine_order=22), "HC12_26": dict(engine_order=26), "HC12_46": dict(engine_order=46),
           "HC14": dict(engine_order=3), "HC40": dict()}


@cases("hard", _BLISKS)
def tips(record, change):
    p = _CASES[record.label.split("/")[1].split("_")[0]]
    model = blisk(0, contact=False, beta=p["beta"], **change)
    model.add_force(B2, p["F"])
    model.add_contact("jenkins", D, R, kt=p["kt"], mu=1, preload=float(p["fc"]))
    for f in np.atleast_1d(p["f_Hz"]):
        for name, options in dict(H7=dict(harmonics=7), H15=dict(harmonics=15), default=dict(),
                                  even=dict(harmonics=7, keep_even_harmonics=1)).items():
            record.solve(f"{f}_{name}", model.forced_response, HZ * float(f), points=1, **options)


_STOPS = {"HC16": dict(), "HC17": dict(), "HC18": dict(sweep=(0.9, 1.5))}


@cases("hard", _STOPS)
def stops(record, change):
    p = _CASES[record.label.split("/")[1]]
    model = hbvib.Model(mass=p["m"], stiffness=p["k"], damping=p["c"])
    model.add_contact("unilateral", -1, 0, kn=p["kn"], gap=p["gap"])
    model.add_force(0, p["F"])
    for h in (1, 2, 7, 31):
        record.solve(f"H{h}", model.forced_response, p["w"], harmonics=h)
    record.solve("default", model.forced_response, p["w"])
    if "sweep" in change:
        for name, omega in (("up", change["sweep"]), ("down", change["sweep"][::-1])):
            record.solve(name, model.forced_response, omega, harmonics=15, at=[p["w"]])
            record.solve(f"{name}_default", model.forced_response, omega, at=[p["w"]], points=3)


@case("hard")
def several(record):
    stiff = np.array([[2.0, -1.0], [-1.0, 1.0]])
    for light in (1e-14, 0.0):
        model = hbvib.Model(mass=np.diag([1, light]), stiffness=stiff, damping=0.02 * stiff)
        model.add_contact("jenkins", 0, kt=1, mu=1, preload=0.3)
        model.add_force(0, 0.2)
        record.solve(f"HC25_{light}", model.forced_response, 1.25, harmonics=31)
        record.solve(f"HC25_{light}_default", model.forced_response, 1.25)
    many = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    many.add_jenkins(np.zeros(100, int), -1, 0.01, 1, 0.003)
    many.add_force(0, 0.5)
    record.solve("HC26", many.forced_response, 1.25, harmonics=3)
    near = hbvib.Model(mass=np.eye(2), stiffness=np.diag([1, 1 + 1e-10]), damping=0.02 * np.eye(2))
    for dof in range(2):
        near.add_contact("jenkins", dof, kt=1, mu=1, preload=0.3)
        near.add_force(dof, 0.2)
    record.solve("HC27", near.forced_response, 1.25, harmonics=7)
    tied = hbvib.Model(mass=np.eye(2), stiffness=np.array([[2, -1], [-1, 1 + 1e30]]), damping=0.02 * np.eye(2))
    tied.add_contact("jenkins", 1, kt=1, mu=1, preload=0.3)
    tied.add_force(0, 0.2)
    record.solve("HC39_tied", tied.forced_response, 1.1, harmonics=9)
    alike = hbvib.Model(mass=np.eye(2), stiffness=np.eye(2), damping=0.02 * np.eye(2))
    alike.add_contact("jenkins", 0, 1, kt=1, mu=1, preload=0.3)
    for dof in range(2):
        alike.add_force(dof, 0.2)
    record.solve("HC39_alike", alike.forced_response, 1.1, harmonics=9)


@case("hard")
def laws_on_motions(record):
    def pairs(ab, sign=1.0):
        return [sign * ab[0]] + [sign * complex(a, -b) for a, b in zip(ab[1::2], ab[2::2])]

    p = _CASES["HC19"]
    for samples in (0, *p["N"]):
        record.write(f"HC19_{samples}", hbvib.evaluate_contact("jenkins", pairs(p["motion"]), kt=p["k"], mu=1,
                                                               preload=p["fc"], samples=samples, jacobian=True))
    for name in ("HC35", "HC35b"):
        p = _CASES[name]
        record.write(name, hbvib.evaluate_contact("friction_2d", [pairs(p["X"]), pairs(p["Y"], -1.0)], kt=p["kt"],
                                                  kn=p["kn"], mu=p["mu"], preload=p["n0"], jacobian=True))


@case("hard")
def HC38_mode(record):
    p = _CASES["HC38"]
    model = blisk(0, contact=False, beta=0)
    model.add_contact("jenkins", D, R, kt=p["kt"], mu=1, preload=p["fc"])
    for h in p["H"]:
        record.solve(f"H{h}", model.nonlinear_mode, (p["log10_a"] - 1.5, p["log10_a"] + 0.5), harmonics=h,
                     at=[p["log10_a"]])
    record.solve("default", model.nonlinear_mode, (p["log10_a"] - 1.5, p["log10_a"] + 0.5), at=[p["log10_a"]])
