"""Fits to data on curves that turn back: data of one set that change between the parts of a fold from one frequency to the next, two
folded resonances, and amplitudes without a phase."""
from common import check, finish, hbvib

import numpy as np


def solutions(model, omega, stretch):
    """Complex amplitudes of all solutions at each frequency, ordered by magnitude."""
    branch = model.forced_response(stretch, at=omega, harmonics=3)
    found = []
    for i in range(len(omega)):
        x = np.array([branch.harmonics(point)[1, 0] for point in branch.at(i).point])
        found.append(x[np.argsort(abs(x))])
    return found


def started(stiffness, damping):
    return [hbvib.Unknown(hbvib.Parameter("stiffness", scaling="factor"), stiffness),
            hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), damping)]


# One hardening spring: the parts lower, unstable, upper in turn, so that neighbours in frequency lie on other parts.
spring = hbvib.Model(mass=1, stiffness=1, damping=0.05)
spring.add_spring_damper(0, spring=[0, 0, 0.5])
spring.add_force(0, 0.12)
stretch = (0.7, 1.9)
ends = np.sort(spring.forced_response(stretch, harmonics=3).folds().omega)
omega = np.linspace(ends[0] + 0.01, ends[-1] - 0.01, 12)
everything = solutions(spring, omega, stretch)
check("three solutions at each frequency", all(len(x) == 3 for x in everything))
value = np.array([everything[i][i % 3] for i in range(12)])
mixed = hbvib.Measured("response", omega, value, 0.01 * abs(value), omega=stretch)
loudness = hbvib.Measured("amplitude", omega, abs(value), 0.01 * abs(value), omega=stretch)
for name, data in (("with phase", mixed), ("amplitudes alone", loudness)):
    for first, damping in ((0.95, 1.3), (1.05, 0.8)):
        found = spring.fit(started(first, damping), data, harmonics=3)
        check(f"parts in turn, {name}, from {first}", (abs(found.theta - 1) < 1e-6).all(), found)

# With noise of 2 %, the truth lies within its deviations and chi2 is as large as it should be: no datum is on a wrong part.
random = np.random.default_rng(5)
noisy = value + 0.02 * abs(value) / np.sqrt(2) * (random.standard_normal(12) + 1j * random.standard_normal(12))
data = hbvib.Measured("response", omega, noisy, 0.02 * abs(value), omega=stretch)
found = spring.fit(started(0.95, 1.3), data, harmonics=3)
check("noise", 0.3 < found.chi2 / found.degrees_of_freedom < 2.0 and (abs(found.theta - 1) < 3.5 * found.sd).all(), found)

# Two masses with a hardening spring each: both resonances fold.
pair = hbvib.Model(mass=np.eye(2), stiffness=np.array([[1.4, -0.4], [-0.4, 1.4]]), damping=0.04 * np.eye(2))
for dof in range(2):
    pair.add_spring_damper(dof, spring=[0, 0, 0.5])
pair.add_force(0, 0.14)
stretch = (0.8, 2.3)
folds = np.sort(pair.forced_response(stretch, harmonics=3).folds().omega)
omega = np.concatenate([np.linspace(low + 0.005, high - 0.005, 6) for low, high in zip(folds[0::2], folds[1::2])])
everything = solutions(pair, omega, stretch)
print("folds at", folds.round(3), "solutions", [len(x) for x in everything])
value = np.array([x[i % len(x)] for i, x in enumerate(everything)])
both = hbvib.Measured("response", omega, value, 0.01 * abs(value), response=0, omega=stretch)
heard = hbvib.Measured("amplitude", omega, abs(value), 0.01 * abs(value), response=0, omega=stretch)
for name, data in (("with phase", both), ("amplitudes alone", heard)):
    for first, damping in ((0.98, 1.2), (1.02, 0.85)):
        found = pair.fit(started(first, damping), data, harmonics=3, response_dof=0)
        check(f"two folds, {name}, from {first}", (abs(found.theta - 1) < 1e-6).all(), found)

finish(5)
