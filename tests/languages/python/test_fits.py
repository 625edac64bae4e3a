"""Fits in Python: data of tests from files and decays, values, uncertainty, profiles, comparison of models, and what is told."""

import os
import struct
import tempfile
import warnings

import numpy as np
import scipy.io

import hbvib.io
from common import check, close, finish, hbvib, raises


def rubbing(kt=1.0, mu=0.3):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.04)
    model.add_contact("jenkins", 0, kt=kt, mu=mu, preload=1)
    model.add_force(0, 1.0)
    return model


def exact(model, omega, force):
    loud = model.clone()
    loud.clear_forces()
    loud.add_force(0, force)
    branch = loud.forced_response((omega[0], omega[-1]), at=omega, harmonics=9)
    return np.array([branch.harmonics(branch.at(i).point[0])[1, 0] for i in range(len(omega))])


random = np.random.default_rng(1)
omega = np.linspace(1.05, 1.5, 12)
model, data = rubbing(), []
for force in (0.05, 0.2, 0.4):
    x = exact(model, omega, force)
    sigma = 0.02 * abs(x)
    noise = sigma / np.sqrt(2) * (random.standard_normal(12) + 1j * random.standard_normal(12))
    data.append(hbvib.Measured("response", omega, x + noise, sigma, force=force))
names = {"kt": 0, "mu": 0, "damping": "factor"}
fit = model.fit(names, data, harmonics=9)
check("the truth is near", (abs(fit.theta - [1, 0.3, 1]) < 4 * fit.sd).all(), fit)
check("chi2 is near its degrees of freedom", 0.6 < fit.chi2 / fit.degrees_of_freedom < 1.5, fit.chi2)
check("residuals are those of values", np.allclose(fit.residuals[1][:, 0], (fit.values[1][:, 0] - data[1].value.real) * np.sqrt(2) / data[1].sigma))
check("sums", abs(sum((r ** 2).sum() for r in fit.residuals) / fit.chi2 - 1) < 1e-12)
check("the model has the values", abs(fit.model.contact(0).constants["kt"] - fit.theta[0]) < 1e-12)
check("the report has all names", all(name in fit.report() for name in ("kt 0", "mu 0", "damping factor", "chi2")))

check("a fit that ends says no more", "ended early" not in fit.report())

# A search that has too few iterations names its own option, in the warning and in the report.
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    short = model.fit(names, data, harmonics=9, max_iterations=1)
check("the status of a search with too few iterations", short.status == hbvib.Status.STOPPED_MAX_POINTS, short.status)
early = [line for line in short.report().splitlines() if "ended early" in line]
check("one line of the report tells it", len(early) == 1 and "max_iterations" in early[0], short.report())
check("so does the warning", len(told) == 1 and "raise max_iterations" in str(told[0].message), [str(w.message) for w in told])

# A profile of a parameter that is known well is a parabola: its interval is that of the covariance.
low, high = fit.profile(1).interval(1.0)
check("the profile agrees with the covariance", abs((high - low) / (2 * fit.sd[1]) - 1) < 0.1, (low, high, fit.sd[1]))

# What is tied to a scanned parameter goes with it: two springs in parallel, the second half of the first; the profile is that of the sum
# alone, seen from either of them. Where the covariance is scaled by chi2 the interval is, too.
pair = hbvib.Model(mass=1, stiffness=1, damping=0.1)
for kt in (0.2, 0.1):
    pair.add_contact("jenkins", 0, kt=kt, mu=1.0, preload=1e6)
pair.add_force(0, 1.0)
w = np.linspace(0.8, 1.6, 12)
noisy = hbvib.Measured("response", w, 1 / (1.4 - w * w + 0.1j * w) + 0.05 * np.cos(40 * w), 0.02)
tied = [hbvib.Unknown(hbvib.Parameter("kt", 0), 0.2), hbvib.Unknown(hbvib.Parameter("kt", 1), 0.1, tied_to=0)]
for scaled in (False, True):
    fitted = pair.fit(tied, noisy, harmonics=1, scale_covariance=scaled)
    for number in (0, 1):
        profile = fitted.profile(number)
        check("no profile is below the fit", profile.chi2.min() > profile.best * (1 - 1e-9), profile)
        low, high = profile.interval(1.0)
        close("the interval of a tied pair is its deviation", (high - low) / (2 * fitted.sd[number]), 1.0, 0.05)

# The predicted peak against that of the fitted model itself.
peak = fit.predict("peak", 1.25, force=0.3, omega=(0.95, 1.6))
louder = fit.model.clone()
louder.clear_forces()
louder.add_force(0, 0.3)
own = louder.forced_response((0.95, 1.6), harmonics=9).peaks()
check("a predicted peak", abs(peak.value[0] / own.amplitude[0] - 1) < 1e-8 and abs(peak.second[0] / own.omega[0] - 1) < 1e-8)
check("its deviation and second order", 0 < peak.sigma[0] < 0.1 * peak.value[0] and abs(peak.shift[0]) < 0.3 * peak.sigma[0])
at = fit.predict("response", [1.2], force=0.2)
check("a predicted response is complex", at.value.dtype == complex and at.sigma.real[0] > 0 and at.sigma.imag[0] > 0)

# Criteria prefer the law behind the data.
stiff = hbvib.Model(mass=1, stiffness=2, damping=0.04)
stiff.add_force(0, 1.0)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    linear = stiff.fit({"stiffness": "factor", "damping": "factor"}, data, harmonics=9)
check("criteria prefer friction", linear.info.aic > fit.info.aic + 100 and linear.info.bic > fit.info.bic + 100)

# Data on the upper branch of a folded curve, up to its fold, from starts with which the fold lies elsewhere.
spring = hbvib.Model(mass=1, stiffness=1, damping=0.05)
spring.add_spring_damper(0, spring=[0, 0, 0.5])
spring.add_force(0, 0.12)
fold = spring.forced_response((0.8, 1.8), harmonics=5).folds().omega.max()
upper = np.linspace(0.9, fold - 0.01, 14)
branch = spring.forced_response((0.8, 1.8), at=upper, harmonics=5)
high = [branch.at(i).point[int(np.argmax(branch.at(i).amplitude))] for i in range(14)]
x = np.array([branch.harmonics(point)[1, 0] for point in high])
seen = hbvib.Measured("response", upper, x, 0.01 * abs(x), omega=(0.7, 1.9))
for first in (0.9, 1.1):
    start = [hbvib.Unknown(hbvib.Parameter("stiffness", scaling="factor"), first),
             hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), 1.5)]
    found = spring.fit(start, seen, harmonics=5)
    check(f"a folded curve from {first}", (abs(found.theta - 1) < 1e-5).all(), found)

# Data on all three parts between the folds, told apart by their phase, also from starts whose folds lie elsewhere: there the solution
# nearest to a datum is on another part, until a robust search has moved the fold.
ends = np.sort(spring.forced_response((0.7, 1.9), harmonics=5).folds().omega)
between = np.linspace(ends[0] + 0.01, ends[-1] - 0.01, 6)
branch = spring.forced_response((0.7, 1.9), at=between, harmonics=5)
parts = []
for rank in range(3):
    points = [branch.at(i).point[int(np.argsort(branch.at(i).amplitude)[rank])] for i in range(6)]
    x = np.array([branch.harmonics(point)[1, 0] for point in points])
    parts.append(hbvib.Measured("response", between, x, 0.01 * abs(x), omega=(0.7, 1.9)))
for name, sets in (("upper", parts[2:]), ("unstable", parts[1:2]), ("lower", parts[:1]), ("all", parts)):
    for first, damping in ((0.95, 1.3), (1.05, 0.8)):
        start = [hbvib.Unknown(hbvib.Parameter("stiffness", scaling="factor"), first),
                 hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), damping)]
        found = spring.fit(start, sets, harmonics=5)
        check(f"the {name} part from {first}", (abs(found.theta - 1) < 1e-6).all(), found)

# Repeats that scatter: the resonance of a joint depends on where its sticking slider was left. With one state for each test the limit of
# friction comes out right, without them it does not, and chi2 tells it.


def joint(mu=0.15, place=None):
    one = hbvib.Model(mass=np.diag([1, 0.01, 0.01]), damping=np.diag([0.04, 0.004, 0.004]), stiffness=np.diag([1, 1e-3, 1e-3]))
    one.add_contact("friction_2d", [1, 2, -1], [-1, -1, -1], kt=1, kn=1.5, mu=0.6, normal=(1, -1, 0), tangent=(1, 1, 0))
    one.add_contact("friction_2d", [1, 2, -1], [0, -1, -1], kt=1, kn=1.5, mu=mu, normal=(-1, -1, 0), tangent=(-1, 1, 0))
    one.add_force(2, 1, harmonic=0)
    one.add_force(0, 0.02)
    if place is not None:
        one.set_slider(0, place)
    return one


at, repeats = np.linspace(1.14, 1.3, 8), []
for number, place in enumerate((0.22, 0.26, 0.3)):
    branch = joint(0.15, place).forced_response((at[0], at[-1]), at=at, harmonics=5, response_dof=0)
    x = np.array([branch.harmonics(branch.at(i).point[0])[1, 0] for i in range(8)])
    noise = 0.005 * abs(x) / np.sqrt(2) * (random.standard_normal(8) + 1j * random.standard_normal(8))
    repeats.append(hbvib.Measured("response", at, x + noise, 0.005 * abs(x), response=0))
friction = [hbvib.Unknown(hbvib.Parameter("mu", 1), 0.14), hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), 1.1)]
states = [hbvib.Unknown(hbvib.Parameter("slider_t1", 0), 0.25, data_set=number) for number in range(3)]
one_state = joint(0.15, 0.25).fit(friction, repeats, harmonics=5, response_dof=0)
own_states = joint(0.15, 0.25).fit(friction + states, repeats, harmonics=5, response_dof=0)
check("one state for all tests explains nothing", one_state.chi2 > 3 * one_state.degrees_of_freedom, one_state)
check("a state for each test explains the repeats", 0.4 < own_states.chi2 / own_states.degrees_of_freedom < 1.7, own_states)
check("with the truth", (abs(own_states.theta - [0.15, 1, 0.22, 0.26, 0.3]) < 4 * own_states.sd).all(), own_states)
check("states have names", own_states.names[2:] == [f"slider_t1 0 set {k}" for k in range(3)], own_states.names)
again = own_states.predict("response", at[:2], response=0, data_set=1)
check("a prediction with the state of a test", abs(again.value - own_states.values[1][:2] @ [1, 1j]).max() < 1e-8, again)
raises("a state of no test", hbvib.ArgumentError, joint().fit, friction + [states[0]._replace(data_set=3)], repeats, words="data_set = 3")
raises("a state twice", hbvib.ArgumentError, joint().fit, states[:1] + states[:1], repeats, words="that of unknown 0 already")

# Words.
quiet = hbvib.Measured("response", omega, exact(model, omega, 1e-3), 1e-5, force=1e-3)
raises("all stick", hbvib.NumericalError, model.fit, {"kt": 0, "mu": 0}, quiet, harmonics=9, words="only kt is seen")
with warnings.catch_warnings(record=True) as heard:
    warnings.simplefilter("always")
    big = [hbvib.Measured("response", one.x, 1e3 * one.value, 1e3 * one.sigma, force=one.force) for one in data]
    try:
        model.fit(names, big, harmonics=9, max_iterations=2)
        told = any(issubclass(w.category, hbvib.SuspiciousUnits) and "1000" in str(w.message) for w in heard)
    except hbvib.NumericalError as error:
        told = "1e3" in str(error)
check("millimetres are suspected", told)
raises("a kind", ValueError, hbvib.Measured, "loudness", [1], [1], 1)
raises("complex amplitudes", TypeError, hbvib.Measured, "amplitude", [1], [1j], 1)
raises("a stranger", hbvib.UnsupportedError, model.fit, {"kn": 0}, data, words="kn")
count = []
stopped = model.fit(names, data, harmonics=9, progress=lambda state: count.append(state.parameter) or len(count) < 2)
check("progress stops a fit and keeps it", stopped.status == hbvib.Status.STOPPED_BY_CALLER and count[1] < count[0])

# So does a profile; a flag ends it without a result. A fit that is stopped on a share of the data has no numbers of the others.
asked = []
part = fit.profile(1, progress=lambda state: asked.append(state.point) or len(asked) < 12)
check("progress stops a profile and keeps it", np.isnan(part.chi2).any() and np.isfinite(part.best), part)
flag = hbvib.CancelFlag()
flag.set()
raises("a flag ends a profile", hbvib.Stopped, fit.profile, 1, cancel=flag)
raises("a parameter that is none", IndexError, fit.profile, 4, words="number = 4")
thrice = model.fit(names, [one for one in data for _ in range(4)], harmonics=9, progress=lambda state: state.point < 2)
check("a share that was stopped", thrice.status == hbvib.Status.STOPPED_BY_CALLER and np.isnan(thrice.residuals[0]).any())
check("has a report", "nan" not in thrice.report().splitlines()[-1], thrice.report())

# A decay, integrated in time, gives the backbone of the nonlinear mode, and with it the parameters.
t, dt = np.arange(0, 150, 0.01), 0.01
state, z, path = np.array([1.5, 0.0]), 0.0, np.empty(len(t))
kt, mu = 1.0, 0.3


def slope(v, w):
    return np.array([v[1], -v[0] - 0.04 * v[1] - w])


z = mu  # force of the slider
for i in range(len(t)):
    path[i] = state[0]
    moved = state + 0.5 * dt * slope(state, z)
    force = np.clip(z + kt * (moved[0] - state[0]), -mu, mu)
    new = state + dt * slope(moved, force)
    z = np.clip(z + kt * (new[0] - state[0]), -mu, mu)
    state = new
decay = hbvib.decay_backbone(t, path, cycles=2)
mode = model.nonlinear_mode((np.log10(decay.amplitude.min()) - 0.1, 0.3), harmonics=9, at=np.log10(decay.amplitude))
at = [mode.mode_point(mode.at(i).point[0]).damping_ratio for i in range(len(decay.amplitude))]
omegas = np.array([mode.at(i).omega[0] for i in range(len(decay.amplitude))])
check("a decay has the frequency of the mode", (abs(decay.omega / omegas - 1) < 0.05).all(), decay.omega / omegas)
small = decay.amplitude < 0.25
check("and its damping where all stick", small.any() and (abs(decay.damping[small] / np.array(at)[small] - 1) < 0.1).all())
raises("a short signal", ValueError, hbvib.decay_backbone, t[:20], path[:20], words="zero crossings")
stuck = hbvib.Decay(*[part[small] for part in decay]).measured()
one = model.fit([hbvib.Unknown(hbvib.Parameter("kt", 0), 0.7)], stuck, harmonics=5)
check("the stuck end has kt", abs(one.theta[0] - 1) < 0.02, one)

# Universal files: text and binary, even and uneven.
folder = tempfile.mkdtemp()
numbers = np.array([1 + 2j, -0.5 + 0.25j, 3e-4 - 1j])
HEAD = ["a", "b", "c", "d", "e", "    4         1    0         0       NONE        12  -3       NONE         7   1"]
AXES = ["        18    0    0    0", "         8    0    0    0", "        13    0    0    0", "         0    0    0    0"]


def written(name, form, values, first="    58"):
    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        file.write("\n".join(["    -1", "   151", "text", "    -1", "    -1", first] + HEAD + [form] + AXES).encode() + b"\n" + values
                   + b"\n    -1\n")
    return hbvib.io.read_uff(path)


even = "         6         3         1  1.00000e+01  5.00000e-01  0.00000e+00"
text = " ".join(f"{z.real:.17e} {z.imag:.17e}" for z in numbers).encode()
found = written("text.uff", even, text)
check("text", len(found) == 1 and (found[0].values == numbers).all() and (found[0].x == [10, 10.5, 11]).all())
check("node, direction, quantity", found[0][2:7] == (12, -3, 7, 1, "displacement") and found[0].text[0] == "a")
packed = numbers.view(float).astype(">f8").tobytes()
binary = f"    58b{2:6d}{2:6d}{11:12d}{len(packed):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
found = written("binary.uff", even, packed, binary)
check("binary", (found[0].values == numbers).all())
uneven = even.replace("         1  1.0", "         0  0.0")
packed = b"".join(struct.pack("<fdd", x, z.real, z.imag) for x, z in zip((1, 2, 4), numbers))
binary = f"    58b{1:6d}{2:6d}{11:12d}{len(packed):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
found = written("uneven.uff", uneven, packed, binary)
check("uneven", (found[0].x == [1, 2, 4]).all() and (found[0].values == numbers).all())
turned = found[0]._replace(direction=3)
check("a direction against the axis", (found[0].response(2.0) == -turned.response(2.0)).all())
check("both against it", (found[0]._replace(reference_direction=-1).response() == turned.response()).all())
raises("too few", ValueError, written, "short.uff", even, b"1.0 2.0", words="needs 6")

# Error bars of a decay: what is found lies off the truth as often as they say, with a few degrees of freedom in each window.
random = np.random.default_rng(0)
t = np.arange(0, 120, 0.02)
off = []
for _ in range(40):
    noisy = np.exp(-0.02 * t) * np.cos(2 * t + random.uniform(0, 6)) + 2e-3 * random.standard_normal(len(t))
    found = hbvib.decay_backbone(t, noisy)
    off.append([(found.omega - 2) / found.sigma, (found.damping - 0.01) / found.damping_sigma])
off = np.sqrt((np.array(off) ** 2).mean(axis=(0, 2)))
check("error bars of a decay", (0.8 < off).all() and (off < 1.5).all(), off)

# Coherence: the scatter of averaged frequency responses of random force and noise is that of its formula.
n, lines = 20, 4000
gap, told = [], []
true = 1.5 - 0.7j
for _ in range(3):
    force = random.standard_normal((n, lines)) + 1j * random.standard_normal((n, lines))
    noise = 0.8 * (random.standard_normal((n, lines)) + 1j * random.standard_normal((n, lines)))
    seen = true * force + noise
    cross, power, total = (np.conj(force) * seen).mean(0), (abs(force) ** 2).mean(0), (abs(seen) ** 2).mean(0)
    h, coherence = cross / power, abs(cross) ** 2 / (power * total)
    gap.append(abs(h - true) ** 2)
    told.append(hbvib.io.coherence_sigma(h, coherence, n) ** 2)
close("deviations of coherence", np.mean(gap) / np.mean(told), 1.0, 0.1)
for bad, words in ((1.0, "deviation would be 0"), (1.2, "outside 0 .. 1")):
    raises("coherence", ValueError, hbvib.io.coherence_sigma, [1j], [bad], 10, words=words)
raises("averages", ValueError, hbvib.io.coherence_sigma, [1j], [0.5], 1, words="averages = 1")

# Files of columns: the same numbers from MATLAB, NumPy and text lead to the same fit.
folder = tempfile.mkdtemp()
columns = {"hz": data[1].x / (2 * np.pi), "response": data[1].value, "sigma": data[1].sigma}
scipy.io.savemat(os.path.join(folder, "test.mat"), {**columns, "text": "a shaker", "table": np.ones((2, 3))})
np.savez(os.path.join(folder, "test.npz"), **columns)
with open(os.path.join(folder, "test.csv"), "w", encoding="utf-8") as file:
    print("# by hand\nhz, re, im, sigma", file=file)
    for f, z, sd in zip(columns["hz"], columns["response"], columns["sigma"]):
        print(f"{f!r}, {z.real!r}, {z.imag!r}, {sd!r}".replace("np.float64(", "").replace(")", ""), file=file)
fits = []
for end in ("mat", "npz", "csv"):
    found = hbvib.io.read_columns(os.path.join(folder, "test." + end))
    value = found["re"] + 1j * found["im"] if end == "csv" else found["response"]
    fits.append(model.fit(names, hbvib.Measured("response", 2 * np.pi * found["hz"], value, found["sigma"], force=0.2), harmonics=9).theta)
    check(f"no tables of {end}", "table" not in found and "text" not in found)
check("files of columns", np.allclose(fits[0], fits[1], rtol=1e-9) and np.allclose(fits[0], fits[2], rtol=1e-9), fits)
with open(os.path.join(folder, "bad.csv"), "w", encoding="utf-8") as file:
    print("hz, re\n1, x", file=file)
with open(os.path.join(folder, "table.csv"), "w", encoding="utf-8-sig") as file:
    print('# from a spreadsheet\n"hz","re"\n"1",-2', file=file)
table = hbvib.io.read_columns(os.path.join(folder, "table.csv"))
check("a mark of encoding and quotes are no part of names", list(table) == ["hz", "re"] and table["re"][0] == -2, table)
raises("a word", ValueError, hbvib.io.read_columns, os.path.join(folder, "bad.csv"), words="needs 2 numbers")

# Modes of universal files: a normal and a complex one, numbers that touch, a data set between; the frequency fits a stiffness.
normal = ["    -1", "    55", "bending", "NONE", "NONE", "NONE", "NONE", "         1         2         3         8         2         3",
          "         2         4         1         2", "%13.5E%13.5E%13.5E%13.5E" % (np.sqrt(1.1) / (2 * np.pi), 1, 0.02, 0), "         7",
          "-1.23456E+000-2.00000E+000 3.00000E+000", "    -1"]
turning = ["    -1", "    55", "whirl", "NONE", "NONE", "NONE", "NONE", "         1         3         3         8         5         3",
           "         2         6         1         4", "  -3.00000e-02  2.99985e+00  1.0  0.0  1.0  0.0", "         8",
           "  1.0 2.0 0.0 1.0 -1.0 0.5", "    -1"]
with open(os.path.join(folder, "modes.uff"), "w", encoding="utf-8") as file:
    print("\n".join(normal + ["    -1", "   151", "text", "    -1"] + turning), file=file)
first, second = hbvib.io.read_uff_modes(os.path.join(folder, "modes.uff"))
check("a normal mode", first.number == 2 and first.damping == 0.02 and (first.shape == [[-1.23456, -2, 3]]).all() and first.nodes[0] == 7)
close("a complex mode", second.damping, 0.01, 1e-4)
close("its frequency", second.frequency, 3 / (2 * np.pi), 1e-4)
check("its shape", (second.shape == [[1 + 2j, 1j, -1 + 0.5j]]).all() and second.text[0] == "whirl")
plain = hbvib.Model(mass=1, stiffness=1, damping=0.02)
plain.add_contact("jenkins", 0, kt=0.2, mu=0.3, preload=1)
of_mode = plain.fit({"stiffness": "factor"}, first.measured(1e-4), harmonics=1)
close("a mode fits a stiffness", of_mode.theta[0], 0.9, 1e-4)
with open(os.path.join(folder, "short.uff"), "w", encoding="utf-8") as file:
    print("\n".join(normal[:9] + ["    -1"]), file=file)
raises("a short mode", ValueError, hbvib.io.read_uff_modes, os.path.join(folder, "short.uff"), words="data set 55")

finish(60)
