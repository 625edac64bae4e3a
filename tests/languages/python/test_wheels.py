"""The whole wheel from Python: matrices, loads and forces of each pattern; what is refused."""

import numpy as np

from common import check, close, finish, hbvib, raises

N = 6
sector = hbvib.Model.cyclic(sectors=N, engine_order=1, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 5.0]],
                            coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
sector.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=0.1)
sector.add_force(0, 0.02)
delta = 0.02 * np.cos(2.1 * np.arange(N)**2)


def mistuned(*given, **more):
    wheel = sector.wheel()
    wheel.mistune(sector, *given, **more)
    return wheel


tuned = sector.wheel()
spring = np.kron(np.diag(delta), [[1.0, -1.0], [-1.0, 1.0]])
stiffness = tuned.matrix("stiffness")
close("stiffness of a blade", mistuned("stiffness", delta, dofs=[0]).matrix("stiffness"), stiffness + spring, 1e-14)
close("a direction", mistuned("stiffness", delta, direction=[[1, -1], [-1, 1]]).matrix("stiffness"), stiffness + spring, 1e-14)
close("mass", mistuned("mass", delta, dofs=[0]).matrix("mass"), tuned.matrix("mass") + np.kron(np.diag(delta), np.diag([1, 0])), 1e-14)
close("damping", mistuned("damping", delta, dofs=[0]).matrix("damping"), 0.01 * spring, 1e-15)
for contact in (-1, 0):
    wheel = mistuned("preload", delta, contact=contact)
    close("preload", np.array([wheel.contact(s).constants["preload"] for s in range(N)]), 0.1 * (1 + delta), 1e-15)
forces = mistuned("force", delta).forces
close("force", forces.force, 0.02 * (1 + delta) * np.exp(-2j * np.pi * np.arange(N) / N), 2e-15)
raises("a kind", ValueError, lambda: mistuned("stiff", delta, dofs=[0]))
raises("a length", hbvib.Error, lambda: mistuned("force", delta[1:]))
raises("a plain model", hbvib.Error, tuned.wheel)
x = tuned.forced_response(0.9, harmonics=3, tolerance=0).harmonics(0)[1]
wave = sector.forced_response(0.9, harmonics=3, tolerance=0).harmonics(0)[1]
close("the wave", x[:2], wave, 1e-12)
# Peaks of all blades: those of the response of the wheel itself; the tuned wheel has equal ones.
span, options = (0.5, 1.0), dict(harmonics=3, tolerance=0)
peaks = tuned.wheel_peaks(sector, span, 0, **options)
close("equal blades", peaks.amplitude, np.full(N, peaks.tuned), 1e-9)
close("no amplification", peaks.amplification, 1.0, 1e-9)
wheel = mistuned("stiffness", delta, dofs=[0])
peaks = wheel.wheel_peaks(sector, span, 0, **options)
branch = wheel.forced_response(span, responses=[2 * s for s in range(N)], **options)
close("peaks", peaks.amplitude, [one.peaks().amplitude.max() for one in branch.responses], 1e-10)
check("largest", peaks.blade == np.argmax(peaks.amplitude) and peaks.amplification > 1)
omega, largest = peaks.envelope()
check("envelope", (largest >= peaks.branch.responses[3].amplitude).all() and len(omega) == len(largest))
sure = wheel.wheel_peaks(sector, span, hbvib.Response(0, "peak"), tolerance=1e-2)
check("each blade has its error", bool((sure.error < 1e-2).all()), sure.error)
raises("another wheel", ValueError, sector.wheel_peaks, sector, span, 0)
check("nothing beyond the range", not peaks.beyond.any())

# A sector of the same size with other matrices is not the one of the wheel; contacts and forces may differ.
softer = hbvib.Model.cyclic(sectors=N, engine_order=1, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 4.9]],
                            coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
softer.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=0.1)
softer.add_force(0, 0.02)
for name, call in (("mistune", lambda: tuned.mistune(softer, "stiffness", delta, dofs=[0])),
                   ("wheel_peaks", lambda: tuned.wheel_peaks(softer, span, 0, **options))):
    error = raises(f"{name} with another sector", ValueError, call)
    check("it names the part", "other matrices" in str(error), error)

# A range that ends below the highest peak: told, never counted. The second peaks of the wheel lie within it.
at = peaks.omega[peaks.blade]
short = wheel.wheel_peaks(sector, (span[0], at * (1 - 1e-3)), 0, **options)
check("a peak beyond", np.isnan(short.amplification) and short.beyond[peaks.blade] and "highest peak lies beyond" in short.branch.message,
      short.branch.message)
pair = np.stack([np.zeros(N), -0.4 * np.ones(N)])
narrow = (tuned.wheel_peaks(sector, span, 0, **options).omega[0] * 0.99, span[1])
study = sector.wheel_study(narrow, pair, dofs=[0], **options)
check("a wheel beyond has no result", np.isnan(study.largest[1]) and study.status[1] == hbvib.Status.STOPPED_NO_PEAK, study.largest)
check("it is counted", study.beyond == 1 and study.status[0] == 0 and "1 of them with the highest peak beyond" in repr(study), repr(study))
raises("no distribution of it", ValueError, study.weibull)
check("its quantile may lie anywhere", study.quantile(0.9).upper == np.inf, study.quantile(0.9))
error = raises("a tuned wheel beyond", ValueError, lambda: sector.wheel_study((narrow[0] * 1.02, span[1]), pair, dofs=[0], **options))
check("it names the range", f"{narrow[0] * 1.02}" in str(error) and "widen" in str(error), error)
raises("no worst pattern beyond", ValueError, lambda: sector.worst_pattern((span[0], at * 0.97), 0.02, dofs=[0], starts=1, **options))

# Searches that cannot be are refused.
for name, given, words in (("one frequency", dict(branches=1), "single frequency"), ("depth", dict(branch_depth=2), "branch_depth = 2"),
                           ("most", dict(most_branches=5), "most_branches = 5"),
                           ("a plain model", dict(stability="wheel"), "stability = wheel, needs a cyclic model")):
    error = raises(name, ValueError, lambda given=given: tuned.forced_response((0.8, 0.8), harmonics=3, **given))
    check("it says so", words in str(error), error)

# A study of many wheels has the same peaks, on any number of threads; its order and quantiles.
patterns = 0.02 * np.random.default_rng(5).standard_normal((12, N))
patterns[0] = delta
for kind in ("stiffness", "frequency", "mass", "damping"):
    study = sector.wheel_study(span, patterns[:3], kind=kind, dofs=[0], **options)
    one = mistuned(kind, patterns[2], dofs=[0]).wheel_peaks(sector, span, 0, **options)
    close(f"{kind}: the last wheel", study.largest[2], one.amplitude[one.blade], 1e-9)
    check(f"{kind}: its blade", study.blade[2] == one.blade)
first, second = (sector.wheel_study(span, patterns, dofs=[0], threads=threads, **options) for threads in (1, 2))
check("threads change no bit", first.largest.tobytes() == second.largest.tobytes() and first.omega.tobytes() == second.omega.tobytes())
check("the tuned wheel foretells", first.correlation > 0.9, first.correlation)
moved = sector.wheel_study(span, np.roll(patterns, 2, axis=1), dofs=[0], **options)
close("shifted patterns", moved.largest, first.largest, 1e-9)
check("shift their blade", ((moved.blade - first.blade) % N == 2).all())

# Quantiles: the interval of the median of 100 values by the binomial distribution, P(39 < X <= 60); a bound that too few wheels have.
hundred = hbvib.WheelStudy(np.arange(1, 101), np.zeros(100), np.zeros(100), np.zeros(100), 1.0, np.zeros(100))
check("interval of a median", hundred.quantile(0.5)[1:] == (40.0, 61.0), hundred.quantile(0.5))
check("no bound of a far quantile", hundred.quantile(0.999).upper == np.inf)
raises("no probability", ValueError, hundred.quantile, 1.0)
inside = 0
generator = np.random.default_rng(11)
for _ in range(400):
    sample = hbvib.WheelStudy(generator.random(60), *np.zeros((3, 60)), 1.0, np.zeros(60))
    found = sample.quantile(0.8, 0.9)
    inside += found.lower <= 0.8 <= found.upper
check("the interval has its confidence", 0.87 * 400 <= inside, inside)
law = hbvib.WheelWeibull(1.4, 0.3, 2.5)
drawn = hbvib.WheelStudy([law.quantile(u) for u in (np.arange(4000) + 0.5) / 4000], *np.zeros((3, 4000)), 1.0, np.zeros(4000))
close("a Weibull distribution is found again", drawn.weibull(), law, 0.02)

# The worst pattern: all starts end at it, no other corner of the box near it is worse, and its gradient is that of differences.
worst = sector.worst_pattern(span, 0.02, dofs=[0], starts=3, **options)
close("starts agree", worst.found, np.full(3, worst.amplitude), 1e-6)
check("stationary", worst.kkt < 1e-6, worst.kkt)


def of_blade_0(pattern):
    return mistuned("stiffness", pattern, dofs=[0]).wheel_peaks(sector, span, 0, **options).amplitude[0]


close("its peak", of_blade_0(worst.pattern), worst.amplitude, 1e-9)
for s in range(N):
    turned = worst.pattern.copy()
    turned[s] *= 0.9
    check("no neighbour is worse", of_blade_0(turned) <= worst.amplitude * (1 + 1e-9))
    step = np.eye(N)[s] * 1e-5
    slope = (of_blade_0(worst.pattern + step) - of_blade_0(worst.pattern - step)) / 2e-5
    check("gradient", abs(slope - worst.gradient[s]) < 1e-5 * abs(worst.gradient).max(), (slope, worst.gradient[s]))
check("random wheels are better", first.largest.max() < worst.amplitude * 1.5 and worst.amplification > 1)

# A bladed disk of 24 with a friction ring: the worst pattern in 2 % by another harmonic balance, whichever pattern it begins with.
from common import HZ, THOROUGH, ring_damper

disk = ring_damper(1.0)
found = disk.worst_pattern((HZ * 208.5, HZ * 211.5), 0.02, dofs=[0], starts=13 if THOROUGH else 1, **options)
close("the worst pattern of another program", found.amplitude, 9.300110031e-4, 1e-9)
close("all starts end there", found.found, np.full(len(found.found), 9.300110031e-4), 1e-6)
check("no derivative points into the box", found.kkt < 1e-9 and (abs(found.pattern) == 0.02).all(), found.kkt)
close("its frequency", found.omega, HZ * 210.0641499550685, 1e-8)
blocks = np.array([-1, 1, 1, 1, -1, -1] + 3 * [1, 1, 1, 1, -1, -1])
check("blocks of four and two blades", (np.sign(found.pattern) == blocks).all(), found.pattern)
raises("no box", ValueError, sector.worst_pattern, span, 0.0)
raises("a box in words", ValueError, sector.worst_pattern, span, "a")
check("a study of no wheels has a name", "0 wheels" in repr(hbvib.WheelStudy([], [], [], [], 1.0, [])))

# The worst pattern of a linear wheel lies within some of the bounds: ascents end there, within a few dozen sweeps.
linear = hbvib.Model.cyclic(1, sectors=9, engine_order=2, mass=1, stiffness=3, damping=0.01, coupling=dict(stiffness=-0.05))
linear.add_force(0, 0.1)
inner = linear.worst_pattern((1.5, 2.0), 0.03, kind="stiffness", dofs=[0], starts=2, harmonics=1)
check("it is no corner", (abs(inner.pattern) < 0.03 * 0.999).any(), inner.pattern)
check("it ends", inner.sweeps < 200 and inner.kkt < 1e-6, (inner.sweeps, inner.kkt))
for s in range(9):
    for step in (-1e-3, 1e-3):
        turned = np.clip(inner.pattern + step * np.eye(9)[s], -0.03, 0.03)
        other = linear.wheel()
        other.mistune(linear, "stiffness", turned, dofs=[0])
        reached = other.wheel_peaks(linear, (1.5, 2.0), 0, harmonics=1).amplitude[0]
        check("no neighbour of it is worse", reached <= inner.amplitude * (1 + 1e-9), (s, step))
raises("a stop is told", hbvib.Stopped, lambda: linear.worst_pattern((1.5, 2.0), 0.03, dofs=[0], harmonics=1, phase=lambda *_: False))

# Where a peak lies at the onset of slip it has no derivative by the equations: its own differences are taken.
import hbvib._wheel_studies as studies

exact = studies._WheelStudies._peak_of_blade
studies._WheelStudies._peak_of_blade = lambda self, wheel, parameters, *rest: (
    lambda value, gradient, at: (value, gradient * np.nan, at))(*exact(self, wheel, parameters, *rest))
study = sector.wheel_study(span, patterns[:2], dofs=[0], **options)
by_differences = sector.worst_pattern(span, 0.02, dofs=[0], starts=1, **options)
studies._WheelStudies._peak_of_blade = exact
close("predictions by differences", study.predicted, sector.wheel_study(span, patterns[:2], dofs=[0], **options).predicted, 1e-6)
close("the worst pattern by differences", by_differences.amplitude, worst.amplitude, 1e-6)
raises("a kind without direction", ValueError, lambda: sector.wheel_study(span, patterns, kind="force"))

finish(46)
