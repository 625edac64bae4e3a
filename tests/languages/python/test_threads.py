"""Threads solve one model at once, bit for bit as one alone, while others run Python."""

import concurrent.futures
import contextlib
import gc
import threading
import time

import numpy as np

from common import HZ, bits, check, finish, hbvib, raises, ring_damper, solve

model = ring_damper()
FORCES = [{}, dict(harmonics=3), dict(harmonics=15), dict(harmonics=31), dict(progress=lambda state: None)]
serial = [bits(solve(model, **options)) for options in FORCES]
modes = model.nonlinear_mode((-6, -3)).omega.tobytes()
branch = solve(model)
point = bits(branch)

with concurrent.futures.ThreadPoolExecutor(8) as pool:
    together = [pool.submit(lambda options: bits(solve(model, **options)), options) for options in FORCES * 8]
    others = [pool.submit(lambda: model.nonlinear_mode((-6, -3)).omega.tobytes()) for _ in range(8)]
    copies = [pool.submit(lambda: bits(solve(model.clone()))) for _ in range(8)]
    readers = [pool.submit(bits, branch) for _ in range(32)]
check("solves of one model agree with the serial run", [job.result() for job in together] == serial * 8)
check("nonlinear modes among them", all(job.result() == modes for job in others))
check("copies made meanwhile solve alike", all(job.result() == serial[0] for job in copies))
check("one branch is read by many", all(job.result() == point for job in readers))


# Errors and exceptions stay in their thread.
def failing(number):
    def progress(state):
        if state.point == 2 + number % 5:
            raise LookupError(number)

    try:
        solve(model, progress=progress)
    except LookupError as error:
        return error.args[0], len(error.branch)


with concurrent.futures.ThreadPoolExecutor(8) as pool:
    got = list(pool.map(failing, range(40)))
check("each call raises its own callback's exception", got == [(number, 2 + number % 5) for number in range(40)], got)


def refused(dof):
    try:
        model.clone().add_force(dof, 1.0)
    except IndexError as error:
        return str(error)


with concurrent.futures.ThreadPoolExecutor(8) as pool:
    sentences = list(pool.map(refused, range(4, 204)))
check("sentences are each thread's own", all(f"dof = {dof}," in text for dof, text in zip(range(4, 204), sentences)))


# A user force is called in all of them.
def cubic(call):
    call.f[:] = 0.7 * call.u**3
    call.df_du[:, :, 0] = 2.1 * call.u**2


own = hbvib.Model(mass=1, stiffness=1, damping=0.05)
own.add_force(0, 0.2)
own.add_user_force([0], cubic)
alone = own.forced_response((0.7, 2)).amplitude.tobytes()
with concurrent.futures.ThreadPoolExecutor(4) as pool:
    jobs = [pool.submit(lambda: own.forced_response((0.7, 2)).amplitude.tobytes()) for _ in range(8)]
check("forces of one's own in many threads", all(job.result() == alone for job in jobs))


# The GIL is free during a call without callbacks: this thread is refused the model many times while the other solves,
# then stops it. Where the refusals were too few for the first point to be found meanwhile, more of them are waited for.
def endless_solve():
    while not flag.is_set():
        with contextlib.suppress(hbvib.BusyError):  # this thread has just asked for the model
            stopped.append(solve(model, harmonics=63, step_max=2e-5, max_points=10**6, cancel=flag))
            return


flag, stopped = hbvib.CancelFlag(), []
for wanted in (10**3, 10**4, 10**5, 10**6):
    flag.clear()
    worker = threading.Thread(target=endless_solve)
    worker.start()
    refusals = 0
    while worker.is_alive() and refusals < wanted:
        try:
            model.set_wave(2)
        except hbvib.BusyError:
            refusals += 1
    flag.set()
    worker.join()
    if refusals < wanted or (stopped and len(stopped[-1]) > 0):
        break
check("Python runs on during a solve", refusals == wanted, (refusals, wanted))
check(
    "and its flag stops the solve",
    stopped and stopped[-1].status is hbvib.Status.STOPPED_BY_CALLER and 0 < stopped[-1].omega[-1] < HZ * 211,
)
flag.clear()


# In use: refused, not crashed. The solve waits in its callback until all was tried.
ready, go_on = threading.Event(), threading.Event()
results = []


def waiting(state):
    ready.set()
    go_on.wait()


def solve_and_wait():
    try:
        results.append(bits(solve(model, progress=waiting)))
    finally:
        ready.set()


worker = threading.Thread(target=solve_and_wait)
worker.start()
try:
    ready.wait()
    raises("a model in use is not changed", hbvib.BusyError, model.add_force, 0, 1.0)
    raises("nor freed", hbvib.BusyError, model.free)
    check("but solved and copied", bits(solve(model.clone())) == serial[0])
finally:
    go_on.set()
    worker.join()
check("and the running solve knows nothing of it", results == [serial[0]])


# Freeing against borrowing: either a view that holds, or an error.
def borrow(shared):
    try:
        view = shared.omega
        time.sleep(0)
        return view.tobytes() == omega
    except (hbvib.FreedError, hbvib.BusyError):
        return True


def give_back(shared):
    try:
        shared.free()
    except (BufferError, hbvib.FreedError, hbvib.BusyError):
        pass
    return True


omega = solve(model, harmonics=9).omega.tobytes()
with concurrent.futures.ThreadPoolExecutor(8) as pool:
    jobs = []
    for _ in range(100):
        shared = solve(model, harmonics=9)
        jobs += [pool.submit(borrow if i % 3 else give_back, shared) for i in range(9)]
check("no view outlives its memory", all(job.result() for job in jobs))
gc.collect()
check("all is as before", bits(solve(model)) == serial[0] and np.isfinite(branch.omega).all())

# A flag set from elsewhere is seen before the next point.
third, told = threading.Event(), threading.Event()


def setting():
    third.wait()
    flag.set()
    told.set()


def progress(state):
    if state.point == 3:
        third.set()
        told.wait()


setter = threading.Thread(target=setting)
setter.start()
try:
    early = solve(model, progress=progress, cancel=flag)
finally:
    third.set()
    setter.join()
check("another thread's flag stops a solve", early.status is hbvib.Status.STOPPED_BY_CALLER and len(early) == 3)

finish(16)
