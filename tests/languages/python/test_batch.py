"""Batches of designs: peaks, threads, failing designs, stops, pickling."""

import copy
import pickle

import numpy as np

from common import HZ, check, close, finish, hbvib, oscillator, raises, ring_damper

model = ring_damper()
parameters = [
    hbvib.Parameter("kt", contact=0),
    hbvib.Parameter("preload"),
    hbvib.Parameter("mass", direction=np.diag([0, 0, 0, 1.0])),
]
random = np.random.default_rng(3)
n = 12
values = np.column_stack([random.uniform(2e7, 1e8, n), random.uniform(10, 150, n), random.uniform(-0.02, 0.02, n)])
values[4, 0], values[7, 1] = -1, np.nan
options = dict(harmonics=9, response_dof=0)


def solve(**more):
    return model.batch((HZ * 205, HZ * 213), parameters, values, **options, **more)


batch = solve()
check("all designs but two have a peak", np.array_equal(np.flatnonzero(batch.status), [4, 7]) and len(batch) == n)
check("their peaks are NaN", np.isnan(batch.peak_amplitude[[4, 7]]).all() and np.isnan(batch.peak_omega[[4, 7]]).all())
check("and their reasons are told", "kt = -1" in batch.reason(4) and "NaN" in batch.reason(7) and batch.reason(0) == "")
check("statuses are those of errors", batch.status[4] == hbvib.Status.E_ARGUMENT)
names = ("peak_amplitude", "peak_omega", "status", "points")
for threads in (2, 4):
    other = solve(threads=threads)
    check(f"{threads} threads change no bit", all(getattr(other, k).tobytes() == getattr(batch, k).tobytes() for k in names))

changed = model.clone()
kt, preload, mass = values[2]
changed.set_matrix("mass", np.diag([0.2, 0.3, 1.2, 0.03 + mass]))
single = changed.batch((HZ * 205, HZ * 213), parameters[:2], values[2:3, :2], **options)
close("a design is the changed model", single.peak_amplitude, batch.peak_amplitude[2:3], 1e-9)
close("its frequency, too", single.peak_omega, batch.peak_omega[2:3], 1e-9)

kept = solve(keep=True, threads=2)
branch = kept.branch(2)
check("a kept branch has the peak", kept.peak_amplitude[2] in branch.peaks().amplitude and kept.branch(2) is branch)
raises("a design that failed has no branch", ValueError, kept.branch, 4, words="design 4 has no branch")
raises("branches that were not kept", ValueError, batch.branch, 0, words="not kept")
raises("a design that is not there", IndexError, batch.branch, n)
del kept
check("a branch outlives its batch", len(branch) > 5)

for claim, other in (("pickle", pickle.loads(pickle.dumps(batch))), ("copy", copy.copy(batch))):
    check(f"a batch crosses processes: {claim}", all(np.array_equal(getattr(other, k), getattr(batch, k), equal_nan=True) for k in names))
    check(f"with its reasons: {claim}", other.reason(7) == batch.reason(7))
both = hbvib.Batch.concatenate([batch, batch])
check("batches are joined", len(both) == 2 * n and both.reason(n + 4) == batch.reason(4))
raises("results are read-only", ValueError, batch.peak_amplitude.__setitem__, 0, 1.0)

seen = []
stopped = solve(progress=lambda progress: seen.append(progress.point) or len(seen) < 3)
check("a stop keeps designs", seen == [1, 2, 3] and (stopped.status[3:] == hbvib.Status.STOPPED_BY_CALLER).all())
check("that were solved", stopped.peak_amplitude[0] == batch.peak_amplitude[0])


def fail(_):
    raise KeyError("mine")


error = raises("an exception of a callback", KeyError, solve, progress=fail, words="mine")
check("has the batch so far", error.batch.status[0] == 0 and error.batch.status[1] == hbvib.Status.STOPPED_BY_CALLER)
flag = hbvib.CancelFlag()
flag.set()
check("a flag that is set", (solve(cancel=flag).status == hbvib.Status.STOPPED_BY_CALLER).all())

one = model.batch((HZ * 205, HZ * 213), hbvib.Parameter("force"), [1.0, 2.0], **options)
check("one parameter takes a vector", len(one) == 2 and one.peak_amplitude[1] > one.peak_amplitude[0])
none = model.batch((HZ * 200, HZ * 204), parameters[:1], [[5e7]], **options)
check("a range without maximum", none.status[0] == hbvib.Status.STOPPED_NO_PEAK and "no maximum" in none.reason(0))
check("no designs", len(model.batch((HZ * 205, HZ * 213), parameters, np.empty((0, 3)), **options)) == 0)
raises("values of another width", ValueError, model.batch, (1, 2), parameters, np.ones((2, 2)), words="needs (designs, 3)")
raises("no parameter", ValueError, model.batch, (1, 2), [], np.ones((2, 0)))
raises("an unknown option", TypeError, solve, threats=2, words="batch()")
raises("no threads", ValueError, solve, threads=0, words="threads = 0")
raises("a constant that the law lacks", NotImplementedError, model.batch, (1, 2), hbvib.Parameter("gap"), [1.0])
forced = oscillator()


def spring(call):
    call.f[:], call.df_du[:, 0, 0] = 0.1 * call.u, 0.1


forced.add_user_force([0], spring)
raises("a user force on threads", NotImplementedError, forced.batch, (1, 2), hbvib.Parameter("force"), [1.0], threads=2)
check("a user force on its own thread", forced.batch((0.8, 2), hbvib.Parameter("force"), [1.0]).status[0] == 0)

finish(34)
