"""Statistics of mistuned wheels: a far quantile from a few solved wheels, deliberate patterns, patterns from measurements."""

import numpy as np

from common import check, close, finish, hbvib, raises, ring_damper

import hbvib._order_statistics as statistics
from hbvib._wheel_quantile import student

# The interval holds the quantile of the distribution with its confidence, however well the values are foretold: 60 draws of each.
CASES = {  # scatter of the errors of prediction, quantile, values, most that are found
    "good": (0.1, 0.99, 2000, 600),
    "poor": (0.6, 0.95, 1000, 500),
    "useless": (10.0, 0.9, 400, 200),
}
for name, (scatter, p, n, most) in CASES.items():
    truth = np.random.default_rng(0)
    tail = np.quantile(truth.gumbel(size=400_000) + scatter * truth.standard_t(5, 400_000), p)
    inside, found, widths = 0, [], []
    for draw in range(60):
        random = np.random.default_rng(draw)
        predicted = random.gumbel(size=n)
        values = predicted + scatter * random.standard_t(5, n)
        one = statistics.screened(predicted, lambda at, values=values: values[at], p, 0.05, 60, most, random)
        inside += one.lower <= tail <= one.upper
        found.append(np.isfinite(one.known).sum())
        low, high = statistics.ends(n, p, 0.025)
        ordered = np.sort(values)
        widths.append((one.upper - one.lower) / (statistics.at_rank(ordered, high) - statistics.at_rank(ordered, low)))
    check(f"{name}: the confidence is kept", inside >= 54, inside)
    if name == "good":
        check("few values are found", np.mean(found) < 0.2 * n, np.mean(found))
        check("the interval is hardly wider than that of all values", np.mean(widths) < 1.1, np.mean(widths))

# Predictions that scatter more than the values, and tell nothing of them.
tail, inside, told = -np.log(-np.log(0.9)), 0, []
for draw in range(60):
    random = np.random.default_rng(draw)
    values = random.gumbel(size=500)
    one = statistics.screened(10 * random.standard_normal(500), lambda at, values=values: values[at], 0.9, 0.1, 50, 100, random)
    inside += one.lower <= tail <= one.upper
    told.append(one.value)
check("wild: the confidence is kept", inside >= 54, inside)
close("the value is what errors of predictions let expect", np.median(told), tail, 0.2)

# A value that cannot be had may lie anywhere: more of them widen the interval outwards.
random = np.random.default_rng(3)
x = random.gumbel(size=1000)
whole = statistics.screened(x, lambda at: x[at] + 0.0, 0.9, 0.05, 100, 1000, np.random.default_rng(1))
lost = statistics.screened(x, lambda at: np.where(at % 10 == 0, np.nan, x[at]), 0.9, 0.05, 100, 1000, np.random.default_rng(1))
check("lost values widen", lost.lower <= whole.lower and lost.upper >= whole.upper and lost.lower < lost.upper, (whole[:3], lost[:3]))
close("Student's quantiles", [student(5, 0.975), student(1, 0.95), student(30, 0.995)], [2.570582, 6.313752, 2.749996], 1e-5)

# A wheel with friction: the interval of 120 wheels of which some are solved holds the quantile of all, solved one by one.
small = hbvib.Model.cyclic(sectors=6, engine_order=1, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 5.0]],
                           coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
small.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=0.1)
small.add_force(0, 0.02)
span, options = (0.6, 0.95), dict(dofs=[0], harmonics=1, tolerance=0)
patterns = 0.01 * np.random.default_rng(2).standard_normal((120, 6))
few = dict(first=30, most=80)
found = small.wheel_quantile(span, 0.9, patterns, **few, **options)
study = small.wheel_study(span, patterns, **options)
every = study.quantile(0.9)
check("few wheels are solved", len(found.wheels) <= 80 and found.correlation > 0.95, (len(found.wheels), found.correlation))
check("the interval is that of all wheels", found.lower <= every.value <= found.upper, (found, every))
close("it is as narrow", [found.lower, found.upper], every[1:], 5e-3)
close("solved wheels are those of the study", found.largest[found.wheels], study.largest[found.wheels], 1e-9)
close("their predictions too", found.predicted, study.predicted, 1e-12)
mean = study.amplification.mean()
check("mean by control variate", abs(found.mean - mean) < 4 * found.mean_error and found.mean_error < 4e-3, (found.mean, mean))
check("gain by correlation", abs(found.gain * (1 - found.correlation**2) - 1) < 1e-9)

# The second level: the quantile with three harmonics from wheels that were solved with one.
truth = small.wheel_study(span, patterns, dofs=[0], harmonics=3, tolerance=0).quantile(0.9)
fine = small.wheel_quantile(span, 0.9, patterns, fine=dict(harmonics=3), corrected=10, threads=2, **few, **options)
known = np.isfinite(found.largest) & np.isfinite(fine.largest)
check("threads change no bit", known.sum() > 60 and found.largest[known].tobytes() == fine.largest[known].tobytes())
check("harmonics matter", abs(every.value / truth.value - 1) > 3e-3, (every, truth))
check("the corrected interval holds the true quantile", fine.lower <= truth.value <= fine.upper, (fine, truth))
close("its value is near", fine.value, truth.value, 2e-2)
check("the interval covers the scatter of the ratio", fine.upper - fine.lower > fine.coarse.upper - fine.coarse.lower + fine.spread, fine)
check("level before it is told", fine.coarse.lower <= every.value <= fine.coarse.upper and len(fine.corrected) == 10)
raises("a probability", ValueError, small.wheel_quantile, span, 1.5, patterns, dofs=[0])
raises("first", ValueError, small.wheel_quantile, span, 0.9, patterns, dofs=[0], first=500, words="first = 500")
raises("corrected", ValueError, small.wheel_quantile, span, 0.9, patterns, dofs=[0], first=30, corrected=1, words="corrected = 1")

# Deliberate patterns of a weakly coupled wheel: one has a better worst case than equal blades, and no random pattern is worse.
linear = hbvib.Model.cyclic(1, sectors=6, engine_order=2, mass=1, stiffness=3, damping=0.01, coupling=dict(stiffness=-0.005))
linear.add_force(0, 0.1)
wide, box = (1.5, 2.0), 0.02
search = linear.intentional_pattern(wide, (-0.1, 0.1), box, dofs=[0], longest=3, tries=2, starts=3, harmonics=1)
best, equal = search.best, search.equal
check("a deliberate pattern lowers the worst case", best.amplification < equal.amplification - 0.02, (best, equal))
worst = linear.worst_pattern(wide, box, dofs=[0], starts=3, harmonics=1)
close("equal blades have the worst pattern, but for ends of ascents", equal.amplification, worst.amplification, 1e-2)
check("all words once", sorted(case.word for case in search.cases) == ["AAB", "AB", "ABB"], search.cases)
check("the best comes first", search.cases[0] == best and search.cases[0].amplification <= search.cases[1].amplification)
check("stationary", best.kkt < 1e-6 and abs(best.addition).max() <= box * (1 + 1e-12), best)
tuned = linear.wheel().wheel_peaks(linear, wide, 0, harmonics=1).tuned


def largest(pattern):
    wheel = linear.wheel()
    wheel.mistune(linear, "stiffness", pattern, dofs=[0])
    return wheel.wheel_peaks(linear, wide, 0, harmonics=1).amplitude.max() / tuned


close("its worst case is a wheel", largest(best.pattern + best.addition), best.amplification, 1e-9)
close("and so is the pattern alone", largest(best.pattern), best.nominal, 1e-9)
random = np.random.default_rng(4)
for case in search.cases[:2]:
    tried = max(largest(case.pattern + box * np.sign(random.standard_normal(6))) for _ in range(10))
    check("no corner is worse", tried <= case.amplification * (1 + 1e-9), (case.word, tried, case.amplification))
raises("no period", ValueError, linear.intentional_pattern, wide, (-0.1, 0.1), box, dofs=[0], longest=1, words="longest = 1")
raises("levels", ValueError, linear.intentional_pattern, wide, 0.1, box, dofs=[0])
raises("no peak", hbvib.ArgumentError, linear.intentional_pattern, (0.5, 0.6), (-0.1, 0.1), box, dofs=[0], harmonics=1)

# Patterns from measurements on a bladed disk with its ring: single blades in closed form, modes of the wheel with the noise that is told.
sector = ring_damper(1.0)
close("clamped blade", sector.blade_frequencies([0, 1], 2)**2,
      np.linalg.eigvalsh(np.array([[2e6 / 0.2, -2e6 / 0.06**0.5], [-2e6 / 0.06**0.5, 3e6 / 0.3]])), 1e-12)
delta = 0.01 * np.cos(2.1 * np.arange(24) ** 2)
alone = sector.blade_frequencies([0, 1])[0]
close("pattern of frequencies", sector.pattern_of_blades(alone * (1 + delta), [0, 1]), delta, 1e-12)
close("pattern of stiffnesses", sector.pattern_of_blades(alone * np.sqrt(1 + delta), [0, 1], kind="stiffness"), delta, 1e-12)
close("pattern of masses", sector.pattern_of_blades(alone / np.sqrt(1 + delta), [0, 1], kind="mass"), delta, 1e-12)
raises("no such pattern", ValueError, lambda: sector.pattern_of_blades(alone * (1 + delta), [0, 1], kind="preload"))
wheel = sector.wheel()
wheel.mistune(sector, "frequency", delta, dofs=[0, 1])
modes = wheel.linear_modes(24)
tips = modes.shapes[:, ::4]
known = dict(sigma_omega=1e-4 * modes.omega, sigma_shape=0.01 * abs(tips).max(axis=1), kind="frequency", dofs=[0, 1])
exact = sector.identify_pattern(modes.omega, tips, families=4, **known)
check("modes have the pattern", abs(exact.delta - delta).max() < 1e-9 and exact.chi2 < 1e-9, abs(exact.delta - delta).max())
narrow = sector.identify_pattern(modes.omega, tips, families=1, **known)
left = abs(narrow.delta - delta).max()
check("a basis of one family tells what it leaves out", 0.3 * left < narrow.left_out < 3 * left and left > 1e-5, (left, narrow.left_out))
random = np.random.default_rng(8)
z, chi2 = [], []
for _ in range(10):
    noisy = tips + known["sigma_shape"][:, None] * (random.standard_normal(tips.shape) + 1j * random.standard_normal(tips.shape))
    one = sector.identify_pattern(modes.omega * (1 + 1e-4 * random.standard_normal(24)), noisy, families=3, **known)
    z.append((one.delta - delta) / one.sd)
    chi2.append(one.chi2 / one.degrees)
check("errors are those of the covariance", 0.9 < np.std(z) < 1.15, np.std(z))
check("residuals are noise", abs(np.mean(chi2) - 1) < 0.1, np.mean(chi2))
two = sector.identify_pattern(modes.omega, modes.shapes.reshape(24, 24, 4)[:, :, :2], points=[0, 1], families=4, **known)
check("more points tell more", (two.sd < exact.sd * (1 + 1e-6)).all() and abs(two.delta - delta).max() < 1e-9)
raises("shapes", ValueError, lambda: sector.identify_pattern(modes.omega, tips[:, :5], **known))
raises("a stop is told", hbvib.Stopped, lambda: sector.identify_pattern(modes.omega, tips, phase=lambda *_: False, **known))

# A per cent taken for a share, and wheels without a result, are told.
small = hbvib.Model.cyclic(1, sectors=5, engine_order=1, mass=1, stiffness=3, coupling=dict(stiffness=-0.1), damping=0.05)
small.add_force(0, 0.1)
study = dict(kind="mass", dofs=[0], harmonics=1)
per_cent = np.array([[0.01, 0, 0, 0, 0], [0, 0, -2.0, 0, 0]])
raises("per cent", hbvib.ArgumentError, lambda: small.wheel_study((1.3, 2.1), per_cent, **study), words="patterns[1, 2] = -2.0, needs at least -1")
raises("NaN", hbvib.ArgumentError, lambda: small.wheel_study((1.3, 2.1), np.full((1, 5), np.nan), **study), words="patterns[0, 0] = nan")
many = np.zeros((60, 5))
many[7, 3] = -1.5
raises("per cent of many", hbvib.ArgumentError, lambda: small.wheel_quantile((1.3, 2.1), 0.9, many, **study), words="patterns[7, 3]")
raises("box", ValueError, lambda: small.worst_pattern((1.3, 2.1), 2.0, **study), words="not a per cent")
raises("levels", ValueError, lambda: small.intentional_pattern((1.3, 2.1), (-0.95, 0.1), 0.1, longest=2, **study), words="not per cent")
values = np.r_[np.linspace(1, 2, 100), np.full(100, np.nan)]
half = hbvib.WheelStudy(values, np.zeros(200), np.ones(200), np.zeros(200), 1.0, np.ones(200))
check("wheels without result may lie anywhere", half.quantile(0.5).lower == -np.inf and half.quantile(0.5).upper == np.inf)
check("and are told", "100 without result" in repr(half), repr(half))
few = hbvib.WheelStudy(np.linspace(1, 2, 60), np.zeros(60), np.ones(60), np.zeros(60), 1.0, np.ones(60))
check("a value lies in its interval", few.quantile(0.9999).lower <= few.quantile(0.9999).value, few.quantile(0.9999))

# Rigid sliders have no exact derivatives: differences foretell their wheels.
rigid = hbvib.Model.cyclic(2, sectors=5, engine_order=1, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 5.2]],
                           coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
rigid.add_contact("jenkins", 1, kt=np.inf, mu=0.3, preload=0.1)
rigid.add_force(0, 0.05)
shifts = 1e-3 * np.random.default_rng(1).standard_normal((3, 5))
foretold = rigid.wheel_study((0.7, 0.98), shifts, kind="frequency", dofs=[0], harmonics=5)
close("rigid sliders are foretold", foretold.predicted / foretold.tuned, foretold.amplification, 5e-3)
raises("levels", ValueError, lambda: small.intentional_pattern((1.3, 2.1), (np.nan, 0.1), 0.1, longest=2, **study), words="finite")

finish(55)
