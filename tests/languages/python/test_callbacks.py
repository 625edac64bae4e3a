"""Callbacks see what happens, stop what they should, and what they raise comes out whole (rows 111, 116)."""

import gc
import signal
import threading
import traceback
import warnings
import weakref

import numpy as np

from common import HZ, bits, check, close, finish, hbvib, oscillator, raises, ring_damper, solve

model = ring_damper()
whole = solve(model)
reference = bits(whole)

# Progress.
seen = []
watched = solve(model, progress=seen.append)
check("watching changes nothing", bits(watched) == reference)
check("each point is told once", [state.point for state in seen] == list(range(1, len(whole) + 1)))
check(
    "with its frequency and amplitude",
    np.array_equal([state.parameter for state in seen], whole.omega)
    and np.array_equal([state.amplitude for state in seen], whole.amplitude),
)
check("the share done ends at 1", seen[-1].fraction_done == 1 and type(seen[0]) is hbvib.Progress)
check(
    "None, True, 0 and texts go on",
    bits(solve(model, progress=lambda state: [None, True, 0, ""][state.point % 4])) == reference,
)


def stopping(state):
    if state.point == 7:
        raise StopIteration


for name, callback in (
    ("False", lambda state: state.point < 7),
    ("numpy's False", lambda state: np.bool_(state.point < 7)),
    ("StopIteration", stopping),
):
    stopped = solve(model, progress=callback)
    check(
        f"{name} stops with the points so far",
        stopped.status is hbvib.Status.STOPPED_BY_CALLER
        and np.array_equal(stopped.omega, whole.omega[:7])
        and len(stopped) < len(whole)
        and not stopped.complete,
    )
    check(f"{name} is not a failure", stopped.message != "")
flag = hbvib.CancelFlag()
cancelled = solve(model, cancel=flag, progress=lambda state: flag.set() if state.point == 7 else None)
check("a cancel flag stops", cancelled.status == 1 and len(cancelled) == 7 and flag.is_set())
flag.clear()
check("a flag not set does nothing", bits(solve(model, cancel=flag)) == reference)


# Exceptions are the same object, with traceback and branch.
class Mine(Exception):
    pass


mine = Mine("mine")


def throw(*_):
    raise mine


def failing(state):
    if state.point == 5:
        raise mine


error = raises("an exception of progress comes out", Mine, solve, model, progress=failing)
check("the same object", error is mine)
check("with its traceback", "failing" in [frame.name for frame in traceback.extract_tb(error.__traceback__)])
check("with the branch so far", np.array_equal(error.branch.omega, whole.omega[:5]))
check("which nothing else holds", error.__context__ is None and error.__cause__ is None)


def lost():
    """Objects that a failure keeps alive once it was dealt with, without the collector's help."""
    try:
        solve(model, progress=lambda state: 1 / 0)
    except ZeroDivisionError as error:
        return weakref.ref(error.branch)


gc.disable()
check("and goes with it", lost()() is None)
gc.enable()
lines = []
check(
    "logging changes nothing",
    bits(solve(model, log=lambda level, text: lines.append((level, text)), log_level="debug")) == reference,
)
check("lines come with their weight", lines and all(type(level) is hbvib.LogLevel and text for level, text in lines))
few = []
solve(model, log=lambda level, text: few.append(level), log_level=hbvib.LogLevel.WARN)
check(
    "the finest wanted is the finest had", all(level == hbvib.LogLevel.WARN for level in few) and len(few) < len(lines)
)
raises("an exception of log comes out", Mine, solve, model, log=throw, log_level="debug")
for kind in (SystemExit, KeyboardInterrupt, GeneratorExit, StopAsyncIteration):

    def progress(state, kind=kind):
        raise kind

    error = raises(f"{kind.__name__} comes out", kind, solve, model, progress=progress)
    check(f"{kind.__name__} has the branch", len(error.branch) == 1)
raises("an exception in time integration", Mine, model.time_response, HZ * 208, progress=throw)
raises("in a nonlinear mode", Mine, model.nonlinear_mode, (-6, -3), progress=throw)
check("and the model solves to the same bits", bits(solve(model)) == reference)
stopped = model.time_response(HZ * 208, progress=lambda state: False)
check("time integration stops likewise", stopped.status is hbvib.Status.STOPPED_BY_CALLER)
whole = solve(model)
raises("an exception in a check", Mine, model.verify, whole, 0, progress=throw)
check(
    "a check stops likewise",
    model.verify(whole, 0, progress=lambda state: False).status is hbvib.Status.STOPPED_BY_CALLER,
)

# Calls within calls have their own failures.
inner = []


def nested(state):
    if state.point == 3:
        inner.append(raises("the inner solve fails for itself", Mine, solve, model, progress=failing))
    if state.point == 4:
        inner.append(raises("an inner refusal", IndexError, model.linear_modes(1).omega.__getitem__, 9))
        inner.append(raises("a model in use is not changed", hbvib.BusyError, model.clear_forces))
        inner.append(raises("nor freed", hbvib.BusyError, model.free))


check("the outer one goes on", bits(solve(model, progress=nested)) == reference and len(inner) == 4)
error = raises(
    "an inner failure that is not caught ends both",
    Mine,
    solve,
    model,
    progress=lambda state: state.point < 3 or solve(model, progress=failing),
)
check("and has the outer branch", len(error.branch) == 3)


# Forces of one's own: the cubic spring, its refusals and failures.
def duffing(own=None, **options):
    made = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    made.add_force(0, 0.2)
    if own is None:
        made.add_contact("cubic", 0, kt=0.3, cubic=0.7)
    else:
        made.add_user_force([0], own, **options)
    return made


def cubic(call):
    call.f[:] = 0.3 * call.u + 0.7 * call.u**3
    call.df_du[:, :, 0] = 0.3 + 2.1 * call.u**2


class Counting:
    calls = 0

    def __call__(self, call):
        self.calls += 1
        shapes.add(
            (call.u.shape, call.f.shape, call.df_du.shape, call.v is None, call.z is None, call.u.flags.writeable)
        )
        cubic(call)


def follow(made, **options):
    return made.forced_response((0.7, 2.0), at=[0.9, 1.3, 1.7], harmonics=7, **options)


shapes = set()
counting = Counting()
own, builtin = duffing(counting, is_odd=True), duffing()
curve, wanted = follow(own), follow(builtin)
for i in range(3):
    mine_at, theirs_at = curve.at(i), wanted.at(i)
    close("a cubic spring of one's own has the built-in one's response", mine_at.amplitude, theirs_at.amplitude, 1e-10)
    for ours, theirs in zip(mine_at.point, theirs_at.point):
        close("and its harmonics", curve.harmonics(ours), wanted.harmonics(theirs), 1e-10)
samples = max(shape[0][0] for shape in shapes)
check(
    "arrays have the shapes promised",
    all(shape == (shape[0], shape[0], (*shape[0], 1), True, True, False) for shape in shapes) and samples >= 64,
    shapes,
)
check("its derivatives are right", own.check_jacobian(0, 1.0, 0.8).gap < 1e-6)
half = duffing(lambda call: (cubic(call), call.df_du.__imul__(0.5)) and None)
gap = half.check_jacobian(0, 1.0, 0.8)
check("wrong ones are found", gap.gap > 0.1 and gap.tangent is hbvib.Tangent.DF_DU)
velocities = duffing(
    lambda call: (cubic(call), call.f.__iadd__(0.01 * call.v), call.df_dv.__iadd__(0.01)) and None, uses_velocity=True
)
more = hbvib.Model(mass=1, stiffness=1, damping=0.06)
more.add_force(0, 0.2)
more.add_contact("cubic", 0, kt=0.3, cubic=0.7)
close("velocities are seen", follow(velocities).at(0).amplitude, follow(more).at(0).amplitude, 1e-10)

alive = weakref.ref(counting)
point = int(curve.at(0).point[0])
force = curve.loop(point, 0).force
copy = own.clone()
own.free()
del own, counting
gc.collect()
check(
    "branches and copies keep a force alive", alive() is not None and np.array_equal(curve.loop(point, 0).force, force)
)
close("a copy solves like its model", follow(copy).amplitude, curve.amplitude, 0)
copy.free()
del copy, curve
gc.collect()
check("with the last of them it goes", alive() is None)

limit = 0.5


def refusing(call):
    cubic(call)
    if np.abs(call.u).max() > limit:
        return False


def raising(call):
    cubic(call)
    if np.abs(call.u).max() > limit:
        raise mine


with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    refused = follow(duffing(refusing))
check(
    "False is a motion that the force cannot do: the branch ends there",
    caught and len(refused) and refused.status is hbvib.Status.STOPPED_CALLBACK and refused.amplitude.max() <= limit,
)
error = raises("an exception of a force comes out of the solve", Mine, follow, duffing(raising))
check(
    "the same object, with the branch",
    error is mine and 0 < len(error.branch) and error.branch.amplitude.max() <= limit,
)
limit = 0.0
raises("where no point was found, too", Mine, follow, duffing(raising))
raises("and a refusal is CallbackError", hbvib.CallbackError, follow, duffing(refusing))
raises("a force that writes nothing is told so", hbvib.CallbackError, follow, duffing(lambda call: None))
raises("writing to inputs is ValueError", ValueError, follow, duffing(lambda call: call.u.fill(0)))
raises("a name that is none", AttributeError, follow, duffing(lambda call: call.df_dx))
limit = 9.0
given = follow(duffing(raising))
limit = 0.0
raises("results of a branch may call the force, too", Mine, given.loop, 0, 0)
raises("and checks of derivatives", Mine, duffing(raising).check_jacobian, 0, 1.0, 1.0)
limit = 9.0
check("afterwards it answers again", np.isfinite(given.loop(0, 0).force).all())


# An element with a state: f = z, a Jenkins slider by hand, against the law of the library.
def slider(call):
    z, before = call.z0[0], call.u[-1, 0]
    for j, u in enumerate(call.u[:, 0]):
        trial = z + (u - before)
        z, before = min(max(trial, -0.3), 0.3), u
        call.z[j] = call.f[j] = z
        if z == trial:
            call.dz_dz[j], call.dz_du[j], call.dz_du_before[j] = 1, 1, -1
    call.df_dz[:] = 1


law = oscillator()
hand = hbvib.Model(mass=1, stiffness=1, damping=0.02)
hand.add_force(0, 0.2)
hand.add_user_force([0], slider, states=1, is_odd=True, samples=1024)
ours = hand.forced_response((1.1, 1.3), at=[1.25], harmonics=5).at(0)
theirs = law.forced_response((1.1, 1.3), at=[1.25], harmonics=5, samples=1024).at(0)
exact = law.forced_response((1.1, 1.3), at=[1.25], harmonics=5).at(0)
close("a slider with a state is a Jenkins contact up to its samples", ours.amplitude, exact.amplitude, 1e-5)
close("and the library's own with as many samples", ours.amplitude, theirs.amplitude, 1e-5)

# Its loops are marched over all times at once: too many are refused with the number that would do.
called = hand.forced_response(1.2, harmonics=5)
try:
    called.loop(0, 0, n=1 << 24)
    check("a loop of 16 million times of a law with states is refused", False)
except hbvib.OutOfMemoryError as error:
    most = int(str(error).split("n <= ")[1])
    check("the refusal tells the number of times that would do", 1 << 18 < most < 1 << 24)
    raises("one more is refused, too", hbvib.OutOfMemoryError, called.loop, 0, 0, n=most + 1)
check("a loop of few times is given", called.loop(0, 0, n=2048).force.size == 2048)

# Ctrl-C. The signal is sent when the solve has come to a known state, so that no claim depends on the machine's speed.
# A program that a shell starts in the background inherits that the signal is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
handler = signal.getsignal(signal.SIGINT)


def at_point(number):
    """A progress callback that sends the signal at one point."""

    def progress(state):
        if state.point == number:
            signal.raise_signal(signal.SIGINT)

    return progress


def without_callbacks():
    """What Ctrl-C makes of a solve that calls nobody: another thread sends it when the model is in use. Where it came
    before the solve had begun or after its end, or the solve found the model in use by that thread, it is all done
    again."""
    for _ in range(10):
        over = threading.Event()

        def send(over=over):
            while not over.is_set():
                try:
                    model.set_wave(2)
                except hbvib.BusyError:
                    signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
                    return

        sender = threading.Thread(target=send)
        sender.start()
        try:
            try:
                solve(model, harmonics=63, step_max=2e-5, max_points=10**6)
            finally:
                over.set()
                sender.join()
        except hbvib.BusyError:
            continue
        except KeyboardInterrupt as error:
            if hasattr(error, "branch"):
                return error
    return None


error = without_callbacks()
check("Ctrl-C stops a solve without callbacks", isinstance(error, KeyboardInterrupt), type(error))
check("before its end", len(error.branch) == 0 or error.branch.omega[-1] < HZ * 211)
error = raises("and one with progress, within the callback", KeyboardInterrupt, solve, model, progress=at_point(5))
check("at once", len(error.branch) == 5)
calls = 0


def interrupted(call):
    global calls
    calls += 1
    cubic(call)
    if calls == last:
        signal.raise_signal(signal.SIGINT)


last = 0
complete = follow(duffing(interrupted))
calls, last = 0, calls // 2
error = raises("and one with a force of one's own", KeyboardInterrupt, follow, duffing(interrupted))
check("with its points as well", 0 < len(error.branch) < len(complete) and calls == last)
error = raises(
    "and a solve within a solve",
    KeyboardInterrupt,
    solve,
    model,
    progress=lambda state: solve(model, progress=at_point(3)) and None,
)
check("whose outer branch it has", len(error.branch) == 1)
check("the handler of signals is what it was", signal.getsignal(signal.SIGINT) is handler)
own_handler = []
signal.signal(signal.SIGINT, lambda number, frame: own_handler.append(number))
check(
    "a handler of one's own is called and the solve goes on",
    bits(solve(model, progress=at_point(2))) == reference and own_handler == [signal.SIGINT],
)




# In every function that may be long. The signal is sent in a phase, so that it comes while the function works.
def in_phase(number):
    """A callback of phases that sends the signal at one of them."""
    reports = []

    def phase(which, share):
        check("a phase has its share", type(which) is hbvib.Phase and 0 <= share <= 1)
        reports.append(which)
        if len(reports) == number:
            signal.raise_signal(signal.SIGINT)

    return phase


signal.signal(signal.SIGINT, handler)
point = model.forced_response(HZ * 208, harmonics=5)
mode = model.nonlinear_mode((-6, -4), harmonics=3)
motion = point.harmonics(0)
functions = {
    "a solve, in its set-up": lambda **stop: solve(model, **stop),
    "a nonlinear mode": lambda **stop: model.nonlinear_mode((-6, -3), **stop),
    "time integration": lambda **stop: model.time_response(HZ * 208, **stop),
    "a check in time": lambda **stop: model.verify(point, 0, **stop),
    "linear modes": lambda **stop: model.linear_modes(3, 2, **stop),
    "a residual": lambda **stop: model.forced_residual(HZ * 208, motion, jacobian=True, **stop),
    "harmonics of a point": lambda **stop: point.harmonics(0, **stop),
    "a time history": lambda **stop: point.time_history(0, 0, **stop),
    "energies": lambda **stop: point.energy(0, **stop),
    "a synthesis": lambda **stop: mode.synthesis(model, **stop),
    "its peaks": lambda **stop: mode.synthesis_peaks(model, **stop),
}
for name, function in functions.items():
    raises(f"Ctrl-C stops {name}", KeyboardInterrupt, function, phase=in_phase(1))
    raises(f"an exception of phase leaves {name}", Mine, function, phase=throw)
    check(f"the handler is back after {name}", signal.getsignal(signal.SIGINT) is handler)
    function(phase=lambda which, share: None)
for name in list(functions)[4:]:
    flag = hbvib.CancelFlag()
    flag.set()
    error = raises(f"a flag stops {name}", hbvib.Stopped, functions[name], cancel=flag)
    check("which has its status", error.status is hbvib.Status.STOPPED_BY_CALLER)
    raises(f"False stops {name}", hbvib.Stopped, functions[name], phase=lambda which, share: False)
flag = hbvib.CancelFlag()
flag.set()
raises("a flag stops a law", hbvib.Stopped, hbvib.evaluate_contact, "jenkins", [0, 1], kt=1, mu=1, preload=0.5, cancel=flag)
error = raises("Ctrl-C in the set-up of a solve", KeyboardInterrupt, solve, model, phase=in_phase(1))
check("has a branch without points", len(error.branch) == 0)
stopped = model.time_response(HZ * 208, cancel=flag)
check("a motion that was not recorded is NaN", stopped.status == 1 and np.isnan(stopped.harmonics).all())


def sets_its_own(progress):
    signal.signal(signal.SIGINT, signal.SIG_IGN)


signal.signal(signal.SIGINT, handler)
solve(model, progress=sets_its_own)
check("a handler that a callback sets stays", signal.getsignal(signal.SIGINT) is signal.SIG_IGN)
signal.signal(signal.SIGINT, handler)

finish(150)
