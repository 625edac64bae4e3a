"""Fits against a minimiser of scipy with differences, of models that begin elsewhere: squares, logarithms, priors, bounds, ties, outliers."""

import os

import numpy as np
import scipy.optimize

from common import check, finish, hbvib


def rubbing(kt=1.0, mu=0.3, damping=0.04):
    model = hbvib.Model(mass=1, stiffness=1, damping=damping)
    model.add_contact("jenkins", 0, kt=kt, mu=mu, preload=1)
    model.add_force(0, 1.0)
    return model


def exact(model, omega, force):
    loud = model.clone()
    loud.clear_forces()
    loud.add_force(0, force)
    branch = loud.forced_response((omega[0], omega[-1]), at=omega, harmonics=5)
    return np.array([branch.harmonics(branch.at(i).point[0])[1, 0] for i in range(len(omega))])


def compared(name, number, unknowns, sets, of, **options):
    """A fit against scipy.optimize.least_squares in the free values, with differences."""
    rubbing_one, free = of
    found = rubbing_one.fit(unknowns, sets, harmonics=5, end_step=1e-7, max_iterations=200, **options)
    limit = options.get("huber", 0)

    def residuals(z):
        theta = free(z)
        other = rubbing(theta[0], theta[1], 0.04 * theta[2])
        rows = []
        for one in sets:
            gap = np.sqrt(2) * (exact(other, one.x, one.force) - one.value) / one.sigma
            rows += [gap.real, gap.imag]
        rows = np.concatenate(rows)
        if limit:  # the square root of the loss
            size = abs(rows)
            rows = np.where(size > limit, np.sign(rows) * np.sqrt(np.maximum(2 * limit * size - limit ** 2, 0)), rows)
        known = [(theta[k] - one.prior[0]) / one.prior[1] for k, one in enumerate(unknowns) if one.prior is not None]
        return np.append(rows, known)

    start = [one.start for one in unknowns if one.tied_to < 0 and (one.lower is None or one.lower != one.upper)]
    low = [one.lower if one.lower is not None else 1e-6 for one in unknowns if one.tied_to < 0]
    high = [one.upper if one.upper is not None else np.inf for one in unknowns if one.tied_to < 0]
    own = scipy.optimize.least_squares(residuals, start, bounds=(low, high), x_scale=start, xtol=1e-10, ftol=1e-12, gtol=1e-12)
    loss = 2 * own.cost
    check(f"{name} {number}: the loss", found.info.loss < loss * (1 + 1e-6) + 1e-9, (found.info.loss, loss, found.theta, own.x))
    sd = np.where(found.sd > 0, found.sd, 1e-3)
    check(f"{name} {number}: the values", (abs(found.theta - free(own.x)) < 0.02 * sd).all(), (found.theta, free(own.x), sd))
    return found


random = np.random.default_rng(7)
parameters = [hbvib.Parameter("kt", 0), hbvib.Parameter("mu", 0), hbvib.Parameter("damping", scaling="factor")]
for number in range(3 if "HBVIB_THOROUGH" in os.environ else 1):
    kt, mu = random.uniform(0.6, 1.4), random.uniform(0.2, 0.4)
    one, at = rubbing(kt, mu), np.linspace(1.02, 1.5, 9)
    sets = []
    for force in (0.1, 0.4):
        x = exact(one, at, force)
        sigma = 0.03 * abs(x)
        x = x + sigma / np.sqrt(2) * (random.standard_normal(9) + 1j * random.standard_normal(9))
        sets.append(hbvib.Measured("response", at, x, sigma, force=force))
    start = [1.1 * kt, 0.9 * mu, 1.1]
    unknowns = [hbvib.Unknown(parameter, value) for parameter, value in zip(parameters, start)]
    whole = (one, lambda z: np.array(z))
    found = compared("squares", number, unknowns, sets, whole)
    compared("a logarithm", number, [u._replace(scale="log") for u in unknowns], sets, whole)
    compared("a line", number, [u._replace(scale="linear") for u in unknowns], sets, whole)
    compared("a prior", number, [unknowns[0]._replace(prior=(1.2 * kt, 0.02)), *unknowns[1:]], sets, whole)
    bound = compared("a bound", number, [unknowns[0], unknowns[1]._replace(upper=0.97 * found.theta[1], start=0.9 * found.theta[1]),
                                         unknowns[2]], sets, whole)
    check("the bound is told", bound.info.at_bound == 1 and bound.sd[1] == 0)
    tied = [unknowns[0], unknowns[1], unknowns[2]._replace(tied_to=0)]
    compared("a tie", number, tied, sets, (one, lambda z: np.array([z[0], z[1], start[2] / start[0] * z[0]])))
    for place in ((0, 1), (1, 3), (1, 6)):
        sets[place[0]].value[place[1]] += 15 * sets[place[0]].sigma[place[1]] * np.exp(1j * random.uniform(0, 6))
    robust, square = compared("outliers", number, unknowns, sets, whole, huber=1.345), one.fit(unknowns, sets, harmonics=5)
    shift = [(abs(other.theta - found.theta) / found.sd).max() for other in (robust, square)]
    check("three outliers", shift[0] < 0.6 * shift[1], shift)

finish(15)
