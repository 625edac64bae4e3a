"""Harmonics that the caller gives: those of a guess decide what is carried, its shape tells how many there are, and the response is
watched in the harmonic that the forces excite. Truth: harmonic balance in numpy, with a Jacobian by differences."""

import warnings

import numpy as np

from common import check, close, finish, hbvib, oscillator, raises

H, TIMES = 25, 256
NUMBERS = np.arange(H + 1)
TAU = 2 * np.pi * np.arange(TIMES) / TIMES
warnings.simplefilter("error")
warnings.simplefilter("ignore", hbvib.StoppedEarly)  # checked by the status


def signal(x):
    """Motions over a period, one a row."""
    return np.fft.irfft(x * np.where(NUMBERS == 0, TIMES, TIMES / 2), TIMES)


def balanced(start, omega, linear, law, forces):
    """Harmonics of m x'' + d x' + k x + law(x, x') = forces by Newton's method, from the first harmonics of a start."""
    mass, damping, stiffness = linear
    dynamic = stiffness - mass * (NUMBERS * omega) ** 2 + 1j * NUMBERS * omega * damping
    load = np.zeros(H + 1, complex)
    load[list(forces)] = list(forces.values())

    def harmonics(z):
        return z[..., : H + 1] + 1j * np.pad(z[..., H + 1 :], [(0, 0)] * (z.ndim - 1) + [(1, 0)])

    def residual(z):
        x = harmonics(z)
        force = np.fft.rfft(law(signal(x), signal(1j * NUMBERS * omega * x)))[..., : H + 1]
        balance = dynamic * x + force / np.where(NUMBERS == 0, TIMES, TIMES / 2) - load
        return np.concatenate([balance.real, balance.imag[..., 1:]], axis=-1)

    z = np.zeros(2 * H + 1)
    for number, value in enumerate(start):
        z[number] = np.real(value)
        if number:
            z[H + number] = np.imag(value)
    steps = 1e-6 * np.eye(2 * H + 1)
    for _ in range(40):
        step = np.linalg.solve((residual(z + steps) - residual(z - steps)).T / 2e-6, residual(z))
        z = z - step
        if abs(step).max() < 1e-12 * abs(z).max():
            break
    assert abs(residual(z)).max() < 1e-10
    return harmonics(z)


def rows(*values, length=4):
    guess = np.zeros((length, 1), complex)
    guess[: len(values), 0] = values
    return guess


# Subharmonic of order 1/3 of a Duffing oscillator with cubic damping: the force in harmonic 3, the guess in harmonic 1 as well.
model = hbvib.Model(mass=1, stiffness=1, damping=0.01)
model.add_spring_damper(0, spring=[0, 0, 0.4], damper=[0, 0, 0.002])
model.add_force(0, 8.0, harmonic=3)
omega, start = 1.2, [0, 1.1, 0, -0.67]
truth = balanced(start, omega, (1, 0.01, 1), lambda x, v: 0.4 * x**3 + 0.002 * v**3, {3: 8.0})
close("the truth of the subharmonic", abs(truth[[1, 3]]), [1.10973, 0.71062], 1e-5)
main = model.forced_response(omega, harmonics=9).harmonics(0)[:, 0]
check("without a guess there is none", abs(main[1]) == 0 and abs(main[3]) > 0.5, abs(main[:4]))
for name, guess, options in (
    ("as many harmonics", rows(*truth[:26], length=28), dict(harmonics=27)),
    ("as many harmonics, from far", rows(*start, length=28), dict(harmonics=27)),
    ("a tolerance", rows(*truth[:16], length=16), dict(tolerance=1e-5)),
    ("a tolerance, from far", rows(*start), dict(tolerance=1e-5)),
    ("a tolerance and a number", rows(*truth[:16], length=16), dict(tolerance=1e-5, harmonics=15)),
    ("a tolerance and even harmonics", rows(*truth[:16], length=16), dict(tolerance=1e-5, keep_even_harmonics=1)),
):
    branch = model.forced_response(omega, guess=guess, response_dof=0, **options)
    x = branch.harmonics(0)[:, 0]
    check(f"complete, {name}", branch.complete, branch.status)
    close(f"subharmonic, {name}", abs(x[[1, 3]]), abs(truth[[1, 3]]), 2e-5)
    close(f"motion of the subharmonic, {name}", x[:4], truth[:4], 1e-4)
    check(f"which integration in time agrees with, {name}", model.verify(branch, 0).info.same_solution)
    check(f"and stable, {name}", model.floquet(branch, 0).radius < 1)
sweep = model.forced_response((omega, 1.25 * omega), guess=rows(*truth[:16], length=16), harmonics=15, at=[omega], response_dof=0)
at = sweep.at(0).point
motions = np.array([abs(sweep.harmonics(point)[[1, 3], 0]) for point in at])
check("a sweep has it at its first frequency", abs(motions - [1.10973, 0.71062]).max(axis=1).min() < 1e-4, motions)
check("and keeps to it", all(abs(sweep.harmonics(point)[1, 0]) > 0.01 for point in range(len(sweep) // 2)))

# A degree of freedom without a contact has no part in it, however it moves in the guess; nor has the imaginary part of the mean.
beside = hbvib.Model(mass=np.eye(2), stiffness=np.diag([1.0, 50.0]), damping=0.01 * np.eye(2))
beside.add_spring_damper(0, spring=[0, 0, 0.4], damper=[0, 0, 0.002])
beside.add_force(0, 8.0, harmonic=3)
guess = np.zeros((16, 2), complex)
guess[:, 0] = truth[:16]
wanted = beside.forced_response(omega, guess=guess, harmonics=15)
close("subharmonic beside a free mass", abs(wanted.harmonics(0)[[1, 3], 0]), abs(truth[[1, 3]]), 2e-5)
for name, place in (("fundamental", (1, 1)), ("second harmonic", (2, 1)), ("mean", (0, 1)), ("imaginary mean", (0, 0))):
    changed = guess.copy()
    changed[place] = 1e8j
    found = beside.forced_response(omega, guess=changed, harmonics=15)
    check(f"{name} of no effect in a guess", found.harmonics(0).tobytes() == wanted.harmonics(0).tobytes(),
          abs(found.harmonics(0)[:4, 0]))

# A mean and even harmonics: a mass in one of two wells.
model = hbvib.Model(mass=1, stiffness=-1, damping=0.2)
model.add_contact("cubic", 0, cubic=1.0)
model.add_force(0, 0.1)
truth = balanced([1.0, 0.1], 0.8, (1, 0.2, -1), lambda x, v: x**3, {1: 0.1})
for side in (1, -1):  # from the other well: the same motion half a period later, upside down
    wanted = truth if side == 1 else -truth * (-1.0) ** NUMBERS
    for name, options in (("a number", dict(harmonics=9)), ("a tolerance", dict(tolerance=1e-5))):
        branch = model.forced_response(0.8, guess=rows(side, 0.05, length=10), **options)
        check(f"well {side} with {name} is complete", branch.complete, branch.status)
        close(f"well {side} with {name}", branch.harmonics(0)[:3, 0], wanted[:3], 1e-5)
    for name, options in (("a number", dict(harmonics=9)), ("a tolerance", dict(tolerance=1e-5))):
        swept = model.forced_response((0.8, 1.0), guess=rows(side, 0.05, length=10), at=[0.9], **options)
        there = balanced([side, 0.1], 0.9, (1, 0.2, -1), lambda x, v: x**3, {1: 0.1})
        check(f"a sweep in well {side} with {name} is complete", swept.complete, swept.status)
        close(f"a sweep in well {side} with {name}", swept.harmonics(swept.at(0).point[0])[:3, 0], there[:3], 1e-5)
second = model.forced_response(0.8, guess=rows(0.9, 0.1, 0.02j, length=10), harmonics=9).harmonics(0)[:10, 0]
close("even harmonics come with the mean", second[:4], truth[:4], 1e-5)
raises("harmonics of the guess beyond those asked for", hbvib.Error, model.forced_response, 0.8,
       guess=rows(0, 0.1, 0, 0, 0, 0.2, length=6), harmonics=3, words="guess")

# A guess is any point of another branch, whatever its H.
model = oscillator(0.25)
branch = model.forced_response((0.8, 1.2))
exact = model.forced_response(1.2, harmonics=101).amplitude[0]
for point in (0, len(branch) // 2, len(branch) - 1):
    x = branch.harmonics(point)
    x = x[: int(branch.field("harmonics_used")[point]) + 1]
    for name, options in (
        ("no options", {}),
        ("a tolerance", dict(tolerance=1e-4)),
        ("as many harmonics", dict(harmonics=len(x) - 1)),
        ("as many harmonics and a tolerance", dict(harmonics=len(x) - 1, tolerance=1e-3)),
    ):
        go_on = model.forced_response((branch.omega[point], 1.6), guess=x, **options)
        claim = f"from point {point} with H = {len(x) - 1} and {name}"
        check(f"{claim}: from there to the end", go_on.complete and go_on.omega[[0, -1]].tolist() == [branch.omega[point], 1.6])
        close(f"{claim}: from the motion given", go_on.amplitude[0], branch.amplitude[point], 3e-3)
upper = hbvib.Model(mass=1, stiffness=1, damping=0.02)
upper.add_contact("cubic", 0, cubic=0.5)
upper.add_force(0, 0.2)
folded = upper.forced_response((0.8, 3.0), at=[1.5], harmonics=9)
amplitudes = folded.at(0).amplitude
check("three motions at one frequency", len(amplitudes) == 3)
for length in (4, 8, 10, 16):
    for point, amplitude in zip(folded.at(0).point, amplitudes):
        x = np.zeros((length, 1), complex)
        x[: min(length, 10)] = folded.harmonics(point)[:length]
        for options in ({}, dict(tolerance=1e-6), dict(harmonics=length - 1)):
            found = upper.forced_response(1.5, guess=x, **options).amplitude[0]
            close(f"a guess of {length} rows of the motion of {amplitude:.3f} with {options}", found, amplitude, 3e-3)
for text, guess in (("no rows", np.zeros((0, 1))), ("another structure", np.zeros((4, 2))), ("not a number", np.full((4, 1), np.nan))):
    raises(f"a guess of {text}", (ValueError, hbvib.Error), upper.forced_response, 1.5, guess=guess, words="guess")

# Base frequency is the speed of a rotor, the force its third engine order: the same problem as with the force in harmonic 1.


def driven(order, force=0.25):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, force, harmonic=order)
    return model


ranges = (0.8, 1.6)
for order in (2, 3, 5):
    for name, options, allowed in (("harmonics", dict(harmonics=9), 1e-8), ("a tolerance", dict(tolerance=1e-4), 1e-3)):
        one = driven(1).forced_response(ranges, **options)
        many = {**options, "harmonics": 9 * order} if "harmonics" in options else options
        other = driven(order).forced_response(tuple(end / order for end in ranges), **many)
        claim = f"order {order}, {name}"
        check(f"{claim}: complete", other.complete and len(other) < 3 * len(one) + 50, (other.status, len(one), len(other)))
        check(f"{claim}: as many peaks", len(other.peaks().omega) == len(one.peaks().omega) == 1, other.peaks())
        close(f"{claim}: at the same frequency", order * other.peaks().omega, one.peaks().omega, allowed)
        close(f"{claim}: as high", other.peaks().amplitude, one.peaks().amplitude, allowed)
        motion = np.array([abs(other.harmonics(point)[order, 0]) for point in range(len(other))])
        close(f"{claim}: the amplitude is that of the forced harmonic", other.amplitude, motion, 1e-12)
        peak = int(other.peaks().point[0])
        close(f"{claim}: at the peak, too", other.peaks().amplitude[0], abs(other.harmonics(peak)[order, 0]), 1e-12)
    # What follows from a response watches the same harmonic.
    options = dict(harmonics=9 * order)
    one = driven(1).forced_response(1.2, harmonics=9)
    other = driven(order).forced_response(1.2 / order, **options)
    close(f"order {order}: one frequency", other.amplitude, one.amplitude, 1e-8)
    given = [hbvib.Parameter("force"), hbvib.Parameter("mu"), hbvib.Parameter("kt"), hbvib.Parameter("damping", scaling="factor")]
    close(f"order {order}: derivatives", driven(order).sensitivity(other, 0, given), driven(1).sensitivity(one, 0, given), 1e-6)
    values = [0.8, 1.3]
    both = [driven(k).batch(tuple(end / k for end in ranges), hbvib.Parameter("preload"), values, harmonics=9 * k) for k in (1, order)]
    close(f"order {order}: peaks of designs", both[1].peak_amplitude, both[0].peak_amplitude, 1e-7)
    close(f"order {order}: at their frequencies", order * both[1].peak_omega, both[0].peak_omega, 1e-7)
    over = [driven(k).parameter_response(hbvib.Parameter("preload"), (0.8, 1.3), omega=1.2 / k, at=[1.1], harmonics=9 * k) for k in (1,
        order)]
    close(f"order {order}: over a parameter", over[1].at(0).amplitude, over[0].at(0).amplitude, 1e-7)

# Two forced harmonics, the fundamental at rest: the RMS is watched, and no rounding is a peak.
model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
model.add_force(0, 0.2, harmonic=2)
model.add_force(0, 0.1, harmonic=3)
branch = model.forced_response((0.2, 0.8), harmonics=3)
motion = np.array([abs(branch.harmonics(point)[:, 0]) for point in range(len(branch))])
close("the RMS of both", branch.amplitude, np.sqrt((motion[:, 2]**2 + motion[:, 3]**2) / 2), 1e-12)
resonances = np.sqrt(1 - 0.02**2 / 2) / np.array([3, 2])
check("both are peaks, with few points", len(branch.peaks().omega) == 2 and len(branch) < 1000, (len(branch), branch.peaks()))
close("where they are resonant, beside the other one", branch.peaks().omega, resonances, 1e-4)
alone = model.forced_response((0.2, 0.8), harmonics=3, responses=[hbvib.Response(0, "harmonic", harmonic=h) for h in (2, 3)])
for found, resonance in zip(alone.responses, resonances[::-1]):
    close("each alone has its own", found.peaks().omega, [resonance], 1e-9)
only_mean = hbvib.Model(mass=1, stiffness=1, damping=0.02)
only_mean.add_force(0, 0.1, harmonic=0)
check("a constant force has no peak", len(only_mean.forced_response((0.5, 1.5), harmonics=3).peaks().omega) == 0)

# Parametric excitation by a law of the caller: x'' + g x' + (1 - 0.03 cos 2 tau) x + x^3 + 0.3 x^2 x' = 0 has a motion without a force.


def pump(call):
    k = -0.03 * np.cos(4 * np.pi * np.arange(len(call.u)) / len(call.u))
    call.f[:, 0], call.df_du[:, 0, 0] = k * call.u[:, 0], k


def swing(x, v):
    return -0.03 * np.cos(2 * TAU) * x + x**3 + 0.3 * x**2 * v


model = hbvib.Model(mass=1, stiffness=1, damping=0.005)
model.add_user_force([0], pump)
model.add_spring_damper(0, spring=[0, 0, 1.0])
model.add_polynomial([0], direction=[0], coefficient=[0.3], x_powers=[[2]], v_powers=[[1]])
truths = [balanced([0, 0.1 * np.exp(1j * phase)], 1.0, (1, 0.005, 1), swing, {}) for phase in (0.0, 0.8, 1.6, 2.4)]
truth = max(truths, key=lambda x: abs(x[1]))
check("the truth moves", abs(truth[1]) > 0.05, abs(truth[1]))
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    branch = model.forced_response(1.0, guess=truth[:10].reshape(-1, 1), harmonics=9)
close("motion of the parametric excitation", branch.harmonics(0)[:4, 0], truth[:4], 1e-6)
texts = [str(warning.message) for warning in said if issubclass(warning.category, hbvib.StoppedEarly)]
check("it is not told that its response is zero", not any("its response is zero" in text for text in texts), texts)
check("but that a law of the caller may excite it", all("law of the caller" in text for text in texts), texts)
check("it has an amplitude", abs(branch.amplitude[0] - abs(truth[1])) < 1e-6 * abs(truth[1]), branch.amplitude)

finish(150)
