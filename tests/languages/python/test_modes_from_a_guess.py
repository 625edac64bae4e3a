"""Nonlinear modes from a guess: the curve above an internal resonance, which no continuation from small amplitudes reaches, against
harmonic balance by cosine series; and the sentence on modes of an unsymmetric stiffness, whose damped modes are right."""

import numpy as np

from common import check, close, finish, hbvib, raises

# Two masses, the first on a cubic spring: in-phase motions at a modal amplitude of 100 lie above the 3:1 tongue. Newton's method in
# cosine coefficients of odd harmonics, with a tangent by differences.
NUMBERS = np.arange(1, 22, 2)
TAU = np.linspace(0, 2 * np.pi, 256, endpoint=False)
COSINES = np.cos(np.outer(TAU, NUMBERS))


def second(first, omega):
    return first / (2 - (NUMBERS * omega) ** 2)


def balance(u, amplitude):
    first, omega = u[:-1], u[-1]
    cubic = 2 / len(TAU) * COSINES.T @ (0.5 * (COSINES @ first) ** 3)
    other = second(first, omega)
    size = (first[0] ** 2 + other[0] ** 2 - amplitude**2) / amplitude
    return np.append((2 - (NUMBERS * omega) ** 2) * first - other + cubic, size)


def solved(u, amplitude):
    for _ in range(60):
        r = balance(u, amplitude)
        steps = 1e-7 * np.maximum(1, abs(u))
        tangent = np.array([(balance(u + h * e, amplitude) - r) / h for h, e in zip(steps, np.eye(len(u)))]).T
        step = np.linalg.solve(tangent, -r)
        u = u + step
        if abs(step).max() < 1e-12 * abs(u).max():
            break
    return u


def start(random, amplitude):
    u = np.zeros(len(NUMBERS) + 1)
    u[-1] = random.uniform(1.38, 1.40)
    u[0] = amplitude * (2 - u[-1] ** 2)
    u[1] = random.uniform(-6, 6)
    u[2:5] = random.uniform(-1, 1, 3)
    return u


random, amplitude = np.random.default_rng(0), 100.0
truth = None
for _ in range(400):
    try:
        found = solved(start(random, amplitude), amplitude)
    except np.linalg.LinAlgError:
        continue
    if abs(balance(found, amplitude)).max() < 1e-8 and abs(found[-1] - 1.39156) < 1e-4:
        truth = found
        break
check("the cosine series has the motion above the tongue", truth is not None)
if truth is not None:
    motion = np.zeros((NUMBERS[-1] + 1, 2), complex)
    motion[NUMBERS, 0], motion[NUMBERS, 1] = truth[:-1], second(truth[:-1], truth[-1])
    model = hbvib.Model(mass=np.eye(2), stiffness=[[2, -1], [-1, 2]])
    model.add_contact("cubic", 0, cubic=0.5)
    # Of another size and phase: both are made those of the first point.
    turned = 0.9 * motion * np.exp(0.7j * np.arange(len(motion)))[:, None]
    mode = model.nonlinear_mode((2.0, 2.3), guess=turned, guess_omega=truth[-1], harmonics=21, tolerance=0)
    close("frequency above the tongue", mode.omega[0], truth[-1], 1e-9)
    close("and its motion", abs(mode.harmonics(0)), abs(motion), 1e-6)
    check("it was found from the guess", mode.reduction.guess_used == 1, mode.reduction.guess_used)
    chosen = model.nonlinear_mode((2.0, 2.3), guess=turned, guess_omega=truth[-1], tolerance=1e-4)
    close("with a tolerance", chosen.omega[0], truth[-1], 1e-4)
    # A point of one mode begins another.
    below = model.nonlinear_mode((1.9, 2.0), guess=mode.harmonics(0), guess_omega=mode.omega[0])
    check("a point of a mode begins another", below.reduction.guess_used == 1 and below.complete, below.status)
    close("which ends where the first began", below.omega[-1], mode.omega[0], 1e-3)
    raises("a guess without its frequency", hbvib.Error, model.nonlinear_mode, (2.0, 2.3), guess=turned, words="guess_omega")
    raises("a frequency without a guess", hbvib.Error, model.nonlinear_mode, (2.0, 2.3), guess_omega=1.0, words="guess_omega")

# Coulomb friction couples two modes (brake squeal): damped modes tell growth, natural and nonlinear modes name the stiffness.
brake = hbvib.Model(2)
stiffness = np.array([[1.9, -0.3], [0.7, 1.7]])
brake.set_matrix("mass", np.eye(2))
brake.set_matrix("stiffness", stiffness, part="general")
brake.set_matrix("damping", 0.02 * np.eye(2))
brake.add_contact("cubic", 0, cubic=1.0)
system = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -0.02 * np.eye(2)]])
wanted = np.linalg.eigvals(system)
wanted = np.sort_complex(wanted[wanted.imag > 0])
found = np.sort_complex(brake.damped_modes(2).eigenvalue)
close("damped modes of an unsymmetric stiffness", found, wanted, 1e-10)
raises("its nonlinear modes", hbvib.Error, brake.nonlinear_mode, (-1, 0), words="stiffness[1,0] and its mirror")

finish(11)
