"""Integration in time: events, friction, smooth laws, waves; and checks of points of a branch."""

import numpy as np
from cases_blisk import HZ, blisk
from cases_laws import _CARRIED, curved, structure
from cases_sectors import sector
from record import case, cases

import hbvib


def _time(record, name, model, omega, **options):
    found = record.attempt(name, model.time_response, omega, **options)
    if found is not None:
        record.write(f"{name}_status", int(found.status))
        for part in ("harmonics", "samples", "info"):
            record.write(f"{name}_{part}", getattr(found, part))


@case("time")
def linear(record):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    model.add_force(0, 0.2 + 0.1j)
    model.add_force(0, 0.1, 3)
    model.add_force(0, 0.3, 0)
    for method in ("shooting", "marching"):
        _time(record, method, model, 1.1, harmonics=3, samples=16, method=method, max_periods=2000)


#: Without forces of the caller, which Python answers too slowly for an integration.
_IN_TIME = {name: add for name, add in _CARRIED.items() if name != "mixed" and not name.startswith("user")}
_IN_TIME["mixed"] = lambda model: (model.add_contact("jenkins", 2, kt=1.0, mu=0.3, preload=1.0),
                                   model.add_contact("unilateral", 0, -1, kn=1.0, gap=0.3),
                                   model.add_table(1, displacement=[-1, 1], force=[-0.2, 0.3]))


@cases("time", _IN_TIME)
def laws(record, add):
    for name, constant in (("free", 0.0), ("loaded", 0.15)):
        model = structure(constant=constant)
        add(model)
        for omega in (0.35, 0.7):
            _time(record, f"{name}_{omega}", model, omega, harmonics=7, samples=16, max_periods=400)
    _time(record, "marching", model, 0.7, harmonics=3, method="marching", max_periods=300, tolerance=1e-6)
    branch = model.forced_response(0.7, harmonics=9)
    started = branch.harmonics(0)
    _time(record, "started", model, 0.7, harmonics=5, start=started, max_periods=300)
    for name, options in dict(shooting=dict(max_periods=300), marching=dict(method="marching", tolerance=1e-6, max_periods=300)).items():
        found = record.attempt(f"verify_{name}", model.verify, branch, 0, **options)
        if found is not None:
            for part in ("harmonics", "errors", "info"):
                record.write(f"verify_{name}_{part}", getattr(found, part))


@case("time")
def user(record):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    model.add_force(0, 0.3)
    model.add_user_force([0], curved, uses_velocity=True)
    _time(record, "curved", model, 0.8, harmonics=5, samples=8, tolerance=1e-7, max_periods=60)


@case("time")
def wave(record):
    model = blisk(20)
    branch = model.forced_response((HZ * 208, HZ * 209.5), harmonics=31, at=[HZ * 208.9], response_dof=0)
    for point in (0, len(branch) // 2, int(branch.at(0).point[0])):
        found = record.attempt(f"verify{point}", model.verify, branch, point)
        if found is not None:
            for part in ("harmonics", "errors", "info"):
                record.write(f"verify{point}_{part}", getattr(found, part))
    _time(record, "blisk", model, HZ * 208.9, harmonics=5, start=branch.harmonics(int(branch.at(0).point[0])))
    for contact in ("jenkins", "unilateral", "cubic", "friction_3d"):
        model = sector(3, contact=contact)
        _time(record, contact, model, 1.3, harmonics=4, samples=8, max_periods=300)


@case("time")
def folds(record):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    model.add_contact("unilateral", -1, 0, kn=3, gap=0.2)
    model.add_force(0, 0.02)
    branch = model.forced_response((0.9, 1.5), harmonics=15, at=[1.15])
    for solution in branch.at(0).point:
        found = record.attempt(f"verify{solution}", model.verify, branch, int(solution))
        if found is not None:
            for part in ("harmonics", "errors", "info"):
                record.write(f"verify{solution}_{part}", getattr(found, part))


@case("time")
def refused(record):
    massless = hbvib.Model(mass=np.diag([1.0, 0.0]), stiffness=[[2.0, -1.0], [-1.0, 2.0]])
    massless.add_force(0, 1.0)
    _time(record, "massless", massless, 1.0)
    undamped = hbvib.Model(mass=1, stiffness=1)
    undamped.add_force(0, 1.0)
    _time(record, "resonance", undamped, 1.0, max_periods=50)
    _time(record, "tolerance", undamped, 0.5, tolerance=-1.0)
