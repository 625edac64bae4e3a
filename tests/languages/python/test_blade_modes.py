"""A sector on the cantilever modes of its blade from Python, and the limit of one family of tuned modes (subset of nominal modes)."""

import numpy as np

from common import check, close, finish, hbvib, raises

SECTORS, MASSES = 8, 9
# A stiff disk and a chain of masses as blade, whose first family is that of the clamped blade.
chain = np.zeros((MASSES, MASSES))
for i in range(1, MASSES):
    chain[np.ix_([i - 1, i], [i - 1, i])] += 20.0 * np.array([[1, -1], [-1, 1]])
chain[0, 0] += 400.0
mass = np.diag([20.0] + [0.5] * (MASSES - 1))
sector = hbvib.Model.cyclic(sectors=SECTORS, engine_order=3, mass=mass, stiffness=chain, rayleigh=(0, 2e-3),
                            coupling=dict(stiffness=np.diag([-100.0] + [0.0] * (MASSES - 1))))
sector.add_contact("jenkins", 0, kt=5, mu=0.3, preload=0.02)
sector.add_force(MASSES - 1, 0.1)
dofs, tip = np.arange(1, MASSES), MASSES - 1
delta = 0.03 * np.cos(2.1 * np.arange(SECTORS) ** 2)

blade = sector.on_blade_modes(dofs, 3, points=[tip, 0])
check("order", blade.model.ndof == 4 and blade.modes.tolist() == [1, 2, 3] and blade.numbers.tolist() == [0] + [-1] * 8)
close("the disk is one of its points", blade.weights[1], [1, 0, 0, 0], 0)
close("cantilever modes", np.sqrt(np.diag(np.asarray(blade.model.matrix("stiffness")))[1:]), sector.blade_frequencies(dofs, 3), 1e-12)
error = (blade.model.linear_modes(1, diameter=3).omega / sector.linear_modes(1, diameter=3).omega)[0] - 1
check("the error is told", 0 < error < 1.5 * blade.left_out and blade.left_out < 1e-4, (error, blade.left_out))


def largest(model, kind_dofs, response):
    wheel = model.wheel()
    wheel.mistune(model, "frequency", delta, dofs=kind_dofs)
    return wheel.wheel_peaks(model, (0.9 * alone, 1.1 * alone), response, harmonics=3, tolerance=0)


alone = float(sector.linear_modes(1, diameter=3).omega[0])
full, reduced = largest(sector, dofs, tip), largest(blade.model, blade.modes, blade.response(tip))
close("peaks of all blades", reduced.amplitude, full.amplitude, 1e-3 * full.amplitude.max())
check("the same blade", reduced.blade == full.blade and not full.beyond.any())
close("their amplification", reduced.amplification, full.amplification, 1e-4)
raises("no such point", ValueError, blade.response, 5)
raises("the disk", hbvib.ArgumentError, sector.on_blade_modes, np.arange(MASSES), 3, words="couples the blade to another sector")
raises("too many modes", hbvib.ArgumentError, sector.on_blade_modes, dofs, 8, words="modes = 8")

# One family of tuned modes as basis of the wheel: with the pattern dK the others add terms of second order, |v' dK w|^2 / (difference of
# squares). So frequencies err by the square of the size of the pattern: halved, a quarter; and little, where blades differ alone.
wheel = sector.wheel()
tuned = np.real(wheel.linear_modes(SECTORS, contacts="free").shapes).T
errors = []
for size in (1.0, 0.5, 0.25):
    other = sector.wheel()
    other.mistune(sector, "stiffness", size * delta, dofs=dofs)
    exact = other.linear_modes(SECTORS, contacts="free").omega
    of_family = np.sqrt(np.linalg.eigvalsh(tuned.T @ np.asarray(other.matrix("stiffness")) @ tuned))
    errors.append(np.abs(of_family / exact - 1).max())
for larger, smaller in zip(errors, errors[1:]):
    check("the error falls as the square of the pattern", 3.5 < larger / smaller < 4.6, errors)
check("it is small beside the pattern", errors[0] < 1e-3, errors)

finish(13)
