"""Responses of a forced response: gauges and measures, their peaks, errors, derivatives, files, tables and refusals."""

import copy
import os
import pickle
import tempfile

import numpy as np
from common import check, finish, hbvib, raises

Response = hbvib.Response


def duffing():
    model = hbvib.Model(mass=1, damping=0.06, stiffness=1)
    model.add_spring_damper(0, spring=[0, 0, 0.3])
    model.add_force(0, 0.6)
    return model


def chain(n=5, limit=0.3):
    stiffness = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    model = hbvib.Model(mass=np.eye(n), stiffness=stiffness, rayleigh=(0, 0.02))
    model.add_contact("jenkins", 1, kt=1.5, mu=limit, preload=1)
    model.add_force(0, 1)
    return model


def gauge_in_time(branch, point, response, n=100000):
    """The gauge over a period from the harmonics of the branch, at n times."""
    x = branch.harmonics(point)
    weights = np.ones(len(response.dofs)) if response.weights is None else response.weights
    numbers = np.arange(len(x))
    signal = (x[:, response.dofs] @ weights) * (1j * numbers * branch.point(point).omega) ** int(response.component)
    return np.real(np.exp(2j * np.pi * np.outer(np.arange(n), numbers) / n) @ signal)


MEASURES = dict(
    fundamental=lambda x: 2 * abs(np.mean(x * np.exp(-2j * np.pi * np.arange(len(x)) / len(x)))),
    peak=lambda x: abs(x).max(),
    rms=lambda x: np.sqrt(np.mean(x**2)),
    range=np.ptp,
)

model = chain()
watched = [
    Response(dofs, measure, weights=weights, component=component)
    for measure in MEASURES
    for dofs, weights in ((3, None), ([0, 2, 4], [1, -2, 0.5]))
    for component in ("displacement", "velocity", "acceleration")
]
branch = model.forced_response((0.3, 1.2), harmonics=7, responses=watched)
check("all responses are told", len(branch.responses) == len(watched))
for found, response in zip(branch.responses, watched):
    check(f"{response!r} is that asked for", found.response is response)
    check("it has a value at all stored points", found.stored.shape == (branch.stored,))
    check("and on the curve", found.amplitude.shape == found.error.shape == found.instant.shape == (len(branch),))
    for point in (0, len(branch) // 2, branch.stored - 1):
        expected = MEASURES[response.measure.name.lower()](gauge_in_time(branch, point, response))
        check(f"{response!r} at {point}", abs(found.stored[point] - expected) < 1e-6 * found.stored.max(), expected)
    peaks = found.peaks()
    check("peaks are stored points", (found.stored[peaks.point] == peaks.amplitude).all())
    check("none is below its neighbours", found.amplitude.max() <= max(peaks.amplitude.max(), found.amplitude[[0, -1]].max()))
check("the first response leads", (branch.amplitude == branch.responses[0].amplitude).all())

# A superharmonic resonance is a peak of the measures that feel it.
soft = duffing().forced_response((0.3, 0.6), harmonics=7, responses=[0, Response(0, "harmonic", harmonic=3)])
third = soft.responses[1].peaks()
fine = duffing().forced_response((0.3, 0.6), harmonics=7, step_max=2e-3, responses=[Response(0, "harmonic", harmonic=3)])
check("a peak of the third harmonic", len(third.omega) == 1 and abs(third.omega[0] - 0.362) < 1e-3, third)
check("a dense sweep has the same", abs(fine.peaks().omega / third.omega - 1).max() < 1e-9, fine.peaks())
check("a degree of freedom is its fundamental", soft.responses[0].response.measure == hbvib.Measure.FUNDAMENTAL)
check("complex amplitudes belong to harmonics", np.isfinite(soft.responses[1].complex).all())
peak = duffing().forced_response((0.3, 0.6), harmonics=7, responses=[Response(0, "peak")]).responses[0]
check("a peak has an instant and no complex amplitude", np.isfinite(peak.instant).all() and np.isnan(peak.complex).all())

# The tolerance holds for each.
sure = model.forced_response((0.5, 0.9), tolerance=1e-3, responses=[Response(dof, "peak") for dof in range(5)])
errors = np.array([found.error for found in sure.responses])
check("errors are told and meet the tolerance", np.nanmax(errors) <= 1e-3 and np.isfinite(errors).all())
check("the largest is that of the branch", np.allclose(errors.max(axis=0), sure.error_estimate, rtol=1e-9, atol=0))

# Derivatives.
single = model.forced_response(0.7, harmonics=7, responses=watched)
for r, response in enumerate(watched):
    exact = model.sensitivity(single, 0, hbvib.Parameter("mu"), response=r)[0]
    up, down = (chain(limit=0.3 + step).forced_response(0.7, harmonics=7, responses=[response]).amplitude[0] for step in (1e-5, -1e-5))
    check(f"derivative of {response!r}", abs(exact - (up - down) / 2e-5) < 1e-5 * (1 + abs(exact)), exact)
place = branch.responses[1].peaks().point[0]
moved = model.sensitivity(branch, place, hbvib.Parameter("force"), "peak_omega", response=1)
check("the frequency of a peak of a response has a derivative", np.isfinite(moved).all(), moved)
raises("a response that was not asked for", hbvib.ArgumentError, lambda: model.sensitivity(
    single, 0, hbvib.Parameter("mu"), response=99))

# Any motion.
for response, found in zip(watched, branch.responses):
    value = response.of(branch.harmonics(3), branch.omega[3])
    check(f"{response!r} of harmonics", abs(value - found.amplitude[3]) < 1e-12 * (1 + value))
mode = model.nonlinear_mode((-2, 0), harmonics=5)
point = len(mode) // 2
in_time = mode.time_history(point, 2, 100000)
check("a response of a nonlinear mode", abs(Response(2, "range").of(mode.harmonics(point)) / np.ptp(in_time) - 1) < 1e-8)
steady = model.time_response(0.7, harmonics=15)
check("and of an integration in time", Response([1], "rms").of(steady.harmonics, 0.7) > 0)

# Files and tables.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "branch.npz")
    branch.save(path)
    loaded = hbvib.load(path)
for saved in (loaded, pickle.loads(pickle.dumps(branch))):
    check("responses are saved", len(saved.responses) == len(watched))
    for a, b in zip(saved.responses, branch.responses):
        check("to the last bit", (a.stored == b.stored).all() and repr(a) == repr(b))
        check("with their peaks", all((x == y).all() for x, y in zip(a.peaks(), b.peaks())))
check("a copy has them", copy.copy(branch).responses[2].amplitude[0] == branch.responses[2].amplitude[0])
check("a table has a column each", (branch.to_dataframe()["response_2"] == branch.responses[2].amplitude).all())
check("a dataset has them", branch.to_xarray()["response"].shape == (len(watched), len(branch)))

# Forces in several harmonics, none in the first.
both = chain()
both.clear_forces()
both.add_force(0, 0.5, harmonic=2)
both.add_force(0, 0.4, harmonic=3)
found = both.forced_response((0.2, 0.6), harmonics=9)
check("the response is RMS then", [one.response.measure for one in found.responses] == [hbvib.Measure.RMS])
check("and nothing is rounding", found.amplitude.min() > 1e-3 * found.amplitude.max(), found.amplitude.min())

# Refusals.
for given, kind in (
    ([9], hbvib.OutOfRangeError),
    ([Response(0, sector=1)], hbvib.OutOfRangeError),
    ([Response(0, "harmonic", harmonic=-1)], hbvib.ArgumentError),
    ([Response(0, "harmonic", harmonic=0, component="velocity")], hbvib.ArgumentError),
):
    raises(f"responses={given}", kind, lambda given=given: model.forced_response((0.5, 0.6), responses=given))
raises("an unknown measure", ValueError, lambda: Response(0, "loudest"))
raises("weights for other dofs", ValueError, lambda: Response([0, 1], weights=[1]))
raises("a list of names", TypeError, lambda: model.forced_response((0.5, 0.6), responses=["tip"]))

# Two forced harmonics: another instant takes the lead.
two = chain(limit=0.3)
two.add_force(1, 0.3 + 0.9j, harmonic=2)
branch = two.forced_response((0.4, 1.2), harmonics=5, responses=[Response(2, "peak")])
kinks = branch.responses[0].kinks()
check("kinks are found", len(kinks.omega) >= 2, kinks)
check("both sides are next to each other", (kinks.after == kinks.before + 1).all())
stored = branch.responses[0].stored
check("with one value", abs(stored[kinks.before] / stored[kinks.after] - 1).max() < 1e-6)
sides = [[two.sensitivity(branch, int(p), hbvib.Parameter("force"), response=0)[0] for p in points] for points in kinks[2:]]
check("and two derivatives", (abs(np.subtract(*sides)) > 1e-3).all(), sides)
kept = pickle.loads(pickle.dumps(branch)).responses[0].kinks()
check("a file has them", (kept.before == kinks.before).all() and (kept.omega == kinks.omega).all())

# The same responses beside forced responses.
mode = chain().nonlinear_mode((-1.5, 0.5), harmonics=5)
rms, third = mode.read([Response(2, "rms", component="velocity"), Response([0, 1], "harmonic", harmonic=3)])
check("read has all points", rms.stored.shape == (mode.stored,) and rms.amplitude.shape == (len(mode),))
for point in (0, len(mode) - 1):
    expected = Response(2, "rms", component="velocity").of(mode.harmonics(point), mode.omega[point])
    check("read is that of the harmonics", abs(rms.amplitude[point] / expected - 1) < 1e-9, rms.amplitude[point])
    check("with complex amplitudes", abs(abs(third.complex[point]) - third.amplitude[point]) <= 1e-12 * third.amplitude[point])
again = pickle.loads(pickle.dumps(mode)).read([Response(2, "rms", component="velocity")])[0]
check("a saved branch is read as well", abs(again.stored / rms.stored - 1).max() < 1e-12)
check("read has neither peaks nor errors", not len(rms.peaks().omega) and np.isnan(rms.error).all())
raises("a dof that is not there", hbvib.OutOfRangeError, mode.read, [Response(9, "rms")], words="dofs")

gauge = Response(4, "range", component="velocity")
over = model.parameter_response(hbvib.Parameter("kt"), (1.2, 1.5), omega=0.6, response=gauge, harmonics=3)
end = chain().forced_response(0.6, responses=[gauge], harmonics=3)
check("a response is followed", abs(over.amplitude[-1] / end.amplitude[0] - 1) < 1e-9, over.amplitude[-1])

batch = chain().batch((0.3, 0.9), hbvib.Parameter("kt"), [1.5, 1.7], responses=[gauge, 0], harmonics=3)
alone = chain().forced_response((0.3, 0.9), responses=[gauge, 0], harmonics=3)
for found, response in zip(batch.responses, alone.responses):
    check("a batch has the peaks of each", abs(found.amplitude[0] / response.peaks().amplitude.max() - 1) < 1e-9)
twice = hbvib.Batch.concatenate([batch, pickle.loads(pickle.dumps(batch))])
check("and keeps them", twice.responses[0].amplitude.tolist() == 2 * batch.responses[0].amplitude.tolist())

joint = chain().forced_response(0.6, responses=[gauge, 0], tolerance=1e-2, together=True)
check("one norm", joint.error_estimate[0] <= 1e-2 and joint.leading_response(0) in (0, 1))
checked = chain().verify(joint, 0)
check("verified", checked.info.worst_response in (0, 1) and checked.info.worst_response_error < 0.05, checked.info)
raises("no error", hbvib.ArgumentError, end.leading_response, 0, words="no error")

finish(300)
