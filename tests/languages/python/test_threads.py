"""Threads solve one model at once, bit for bit as one alone, while others run Python."""

import concurrent.futures
import gc
import sys
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


# The GIL is free during a call: this thread counts while another solves, without callbacks.
def long_solve():
    begin = time.perf_counter()
    solve(model, harmonics=63, step_max=2e-4, max_points=10**6, max_newton=20)
    times.append(time.perf_counter() - begin)


times = []
worker = threading.Thread(target=long_solve)
ticks, pause, last = 0, 0.0, time.perf_counter()
worker.start()
while worker.is_alive():
    now = time.perf_counter()
    ticks, pause, last = ticks + 1, max(pause, now - last), now
check("the solve is long enough to tell", times and times[0] > 20 * sys.getswitchinterval(), times)
check("Python runs on during a solve", times and pause < times[0] / 2 and ticks > 100, (times, pause, ticks))


# In use: refused, not crashed.
ready, go_on = threading.Event(), threading.Event()


def waiting(state):
    ready.set()
    go_on.wait(10)


worker = threading.Thread(target=lambda: results.append(bits(solve(model, progress=waiting))))
results = []
worker.start()
ready.wait()
raises("a model in use is not changed", hbvib.BusyError, model.add_force, 0, 1.0)
raises("nor freed", hbvib.BusyError, model.free)
check("but solved and copied", bits(solve(model.clone())) == serial[0])
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


omega = branch.omega.tobytes()
with concurrent.futures.ThreadPoolExecutor(8) as pool:
    jobs = []
    for _ in range(100):
        shared = solve(model, harmonics=9)
        jobs += [pool.submit(borrow if i % 3 else give_back, shared) for i in range(9)]
check("no view outlives its memory", all(job.result() for job in jobs))
gc.collect()
check("all is as before", bits(solve(model)) == serial[0] and np.isfinite(branch.omega).all())

# A flag set from elsewhere.
flag = hbvib.CancelFlag()
timer = threading.Timer(0.1, flag.set)
timer.start()
stopped = solve(model, harmonics=63, step_max=2e-5, max_points=10**6, cancel=flag)
check(
    "another thread's flag stops a solve",
    stopped.status is hbvib.Status.STOPPED_BY_CALLER and stopped.omega[-1] < HZ * 211,
)

finish(16)
