"""Backbones of decays against the closed form of a damped oscillator: frequency and damping ratio are those of modes; refusals."""

import numpy as np

from common import check, finish, hbvib, raises

# x = exp(-zeta omega0 t) cos(omega0 (1 - zeta^2)^1/2 t), its velocity and its acceleration.
for zeta in (0.01, 0.1, 0.3):
    root = 2 * complex(-zeta, np.sqrt(1 - zeta**2))
    time = np.arange(0, 14 / zeta, 0.002) if zeta > 0.05 else np.arange(0, 60, 0.005)
    for component in (0, 1, 2):
        signal = (root**component * np.exp(root * time + 0.3j)).real
        found = hbvib.decay_backbone(time, signal, cycles=2, component=component)
        first = slice(0, max(len(found.omega) // 2, 1))
        told = f"zeta = {zeta}, component {component}: {found.omega[first]} {found.damping[first]}"
        check("the frequency of the mode", (abs(found.omega[first] / 2 - 1) < 2e-5).all(), told)
        check("the damping ratio of the mode", (abs(found.damping[first] / zeta - 1) < 2e-4).all(), told)

# The linear mode of the same oscillator.
model = hbvib.Model(mass=1, stiffness=4, damping=2 * 0.3 * 2)
mode = model.damped_modes(1)
check("a mode has these numbers", abs(abs(mode.eigenvalue[0]) / 2 - 1) < 1e-9, mode.eigenvalue)

# The standard deviations of strong damping are those of noise.
random = np.random.default_rng(3)
time, root = np.arange(0, 12, 0.01), 2 * complex(-0.15, np.sqrt(1 - 0.15**2))
off = []
for _ in range(60):
    noisy = np.exp(root * time + 1j * random.uniform(0, 6)).real + 1e-3 * random.standard_normal(len(time))
    found = hbvib.decay_backbone(time, noisy, cycles=2)
    off.append([(found.omega[0] - 2) / found.sigma[0], (found.damping[0] - 0.15) / found.damping_sigma[0]])
off = np.median(abs(np.array(off)), axis=0)
check("their error bars", (0.3 < off).all() and (off < 1.6).all(), off)

# Signals that are refused, each by name.
t = np.arange(0, 60, 0.01)
x = np.exp(-0.02 * t) * np.cos(2 * t)
for name, place, value in (("signal", 7, np.nan), ("signal", 20, np.inf), ("time", 9, np.nan)):
    one = dict(time=t.copy(), signal=x.copy())
    one[name][place] = value
    raises("not finite", ValueError, hbvib.decay_backbone, one["time"], one["signal"], words=f"{name}[{place}] = {value}, needs finite")
gap = t.copy()
gap[5:] += 0.004
raises("a gap", ValueError, hbvib.decay_backbone, gap, x, words="time[5] - time[4] = 0.014 after steps of 0.01, needs equal distances")
raises("backwards", ValueError, hbvib.decay_backbone, t[::-1], x, words="needs equal distances that rise")
raises("at one time", ValueError, hbvib.decay_backbone, 0 * t, x, words="needs equal distances that rise")
rounded = hbvib.decay_backbone(np.round(t + 1e-6 * np.sin(7 * t), 6), x)
check("rounded times are taken", abs(rounded.omega[0] - 2.0001) < 1e-4, rounded.omega)
finish(25)
