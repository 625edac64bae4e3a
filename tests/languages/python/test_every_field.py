"""Every field of every struct that a caller fills, perturbed alone: the result changes, or the call is refused by name, or the header says
that it has no effect there. Solver options: test_every_option.py; contacts, matrices and laws: test_every_constant.py."""

import ctypes
import warnings

import numpy as np

from common import check, finish, hbvib
from options import CHANGES, bits, hold, of_branch, outcome, refused, same

warnings.simplefilter("ignore", hbvib.StoppedEarly)
Branch, call = hbvib.Branch, hbvib._calls._call
new = hbvib._structs._new


def solver(**values):
    return new("hbvib_solver_options", **{"tolerance": 0.0, "harmonics": 5, **values})


def branch_of(function, model, options, **values):
    handle = ctypes.c_void_p()
    call(function, model.handle, solver(**values), options, None, handle)
    return Branch(handle.value, (), "")


def friction():
    model = hbvib.Model(mass=np.eye(3), stiffness=2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1), rayleigh=(0.01, 0.02))
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, 0.3)
    return model


def wheel():
    model = hbvib.Model.cyclic(sectors=6, engine_order=2, mass=np.eye(2), stiffness=[[3.0, -1.0], [-1.0, 2.0]],
                               coupling=dict(stiffness=-0.3 * np.eye(2)), rayleigh=(0.01, 0.02))
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, 0.3)
    return model


def duffing():
    model = hbvib.Model(mass=np.eye(2), stiffness=[[2.0, -1.0], [-1.0, 2.0]], damping=0.02 * np.eye(2))
    model.add_contact("cubic", 0, cubic=0.5)
    model.add_force(0, 0.2)
    return model


plain, blades, folded = friction(), wheel(), duffing()
response = plain.forced_response((0.6, 1.2), harmonics=7, response_dof=0)
peak = int(response.peaks().point[0])
wave = blades.forced_response((1.2, 2.2), harmonics=7, response_dof=0)
crest = int(wave.peaks().point[0])
mode = plain.nonlinear_mode((-1, 1), harmonics=5)
motions = folded.forced_response((0.8, 1.3), harmonics=5, at=[1.15], response_dof=0)
high, low = (motions.harmonics(motions.at(0).point[pick(motions.at(0).amplitude)]) for pick in (np.argmax, np.argmin))
check("two motions at one frequency", abs(high - low).max() > 0.5)


def rows(x):
    return np.ascontiguousarray(x, np.complex128)


def with_entry(x, row, dof, value):
    y = x.copy()
    y[row, dof] = value
    return rows(y)


def forced(**o):
    values = dict(omega_start=0.6, omega_stop=1.2, at=np.array([0.9]), at_len=1)
    branch = branch_of("hbvib_forced_response", plain, new("hbvib_forced_options", **{**values, **o}))
    branch._at = np.array([0.9])
    return of_branch(branch), bits(branch.at(0).amplitude) if o.get("at_len", 1) else b""


def guessed(**o):
    values = dict(omega_start=1.15, omega_stop=1.15, guess=rows(high), guess_len=high.size)
    return of_branch(branch_of("hbvib_forced_response", folded, new("hbvib_forced_options", **{**values, **o})))


def gauges(*measures):
    given = [new("hbvib_response", measure=measure, n=1, dofs=np.array([k])) for k, measure in enumerate(measures)]
    array = (hbvib.structs["hbvib_response"] * len(given))(*given)
    array.kept = given
    return array


def watched(**o):
    options = new("hbvib_forced_options", omega_start=0.6, omega_stop=0.9)
    values = {"responses": gauges(2, 3), "responses_len": 2, **o}
    options.kept = values["responses"]
    options.responses = ctypes.addressof(options.kept) if options.kept is not None else None
    options.responses_len = values["responses_len"]
    branch = branch_of("hbvib_forced_response", plain, options)
    count = call("hbvib_branch_responses", branch.handle)
    return of_branch(branch), tuple(bits(branch._reading(r, hbvib.Reading.VALUE)) for r in range(count))


def norm(**o):
    """Where the norm of two responses is watched, their errors together are told."""
    options = new("hbvib_forced_options", **{"omega_start": 0.8, "omega_stop": 0.8, "together": 0, **o})
    options.kept = gauges(2, 3)
    options.responses, options.responses_len = ctypes.addressof(options.kept), 2
    handle = ctypes.c_void_p()
    call("hbvib_forced_response", plain.handle, new("hbvib_solver_options", tolerance=1e-3), options, None, handle)
    return of_branch(Branch(handle.value, (), ""))


def read(**o):
    values = dict(measure=1, harmonic=3, n=2, dofs=np.array([0, 1]), weights=np.array([1.0, -0.5]))
    value = ctypes.c_double()
    call("hbvib_response_of", new("hbvib_response", **{**values, **o}), 2, 1.15, rows(high), high.size, value, None, None)
    return bits(np.array([value.value]))


def followed(model):
    def run(**o):
        values = dict(log10_start=-1.0, log10_stop=0.5)
        return of_branch(branch_of("hbvib_nonlinear_mode", model, new("hbvib_mode_options", **{**values, **o})))
    return run


def with_choice(**choice):
    return lambda **o: followed(plain)(**{**choice, **o})


def requested_mode(**o):
    return followed(plain)(**{"at": np.array([0.0]), "at_len": 1, **o})


def synthesised(**o):
    options = {name: value for name, value in o.items() if name != "struct_size"}
    if "struct_size" in o:
        count = ctypes.c_int64()
        call("hbvib_branch_synthesis", mode.handle, plain.handle, new("hbvib_synthesis_options", **o), 0, None, None, None, count)
    return bits(*mode.synthesis(plain, **options)), bits(*mode.synthesis_peaks(plain, **options))


def in_time(model, omega=1.0, **given):
    def run(**o):
        options = new("hbvib_time_options", **{"omega": omega, "harmonics": 5, **given, **o})
        x = np.empty((max(options.harmonics, 0) + 1, model.ndof), complex)
        times, info = np.empty((max(options.samples, 0), model.ndof)), new("hbvib_time_info")
        call("hbvib_time_response", model.handle, options, None, x, x.size, times if times.size else None, times.size, info)
        return bits(x, times, info.residual, info.periods, info.period)
    return run


def verified(**given):
    def run(**o):
        options = new("hbvib_verify_options", **{**given, **o})
        x, errors, out = np.empty((8, 3), complex), np.empty(8), new("hbvib_verification")
        call("hbvib_verify", plain.handle, response.handle, peak, options, None, x, x.size, errors, errors.size, out)
        return bits(x, errors, out.distance, out.residual, out.periods, out.same_solution, out.marched)
    return run


def multipliers(model, branch, point, **given):
    def run(**o):
        options, out = new("hbvib_floquet_options", **{**given, **o}), new("hbvib_floquet_info")
        most = model.sectors * (2 * model.ndof + model.contacts)
        mu, classes = np.empty(most, complex), np.empty(most, np.int64)
        call("hbvib_floquet", model.handle, branch.handle, point, options, None, mu, mu.size, classes, classes.size, out)
        return bits(mu[: out.count], classes[: out.count], out.radius, out.residual, out.modes)
    return run


def described(**values):
    """A parameter as C describes it."""
    return new("hbvib_parameter", **{"kind": int(hbvib.ParameterKind.PRELOAD), "contact": -1, **values})


MATRIX = hbvib._structs._matrix(np.eye(3), hbvib.Part.GENERAL)
WRONG_MATRIX = hbvib._structs._matrix(np.eye(2), hbvib.Part.GENERAL)


def derivative(**given):
    def run(**o):
        o = dict(o)
        parameter = described(**{**given, **o})
        values, reasons, onset = np.empty(1), np.empty(1, np.int64), ctypes.c_int64()
        call("hbvib_sensitivity", plain.handle, response.handle, peak, 0, (hbvib.structs["hbvib_parameter"] * 1)(parameter), 1, values, 1,
             reasons, onset, None)
        return bits(values, reasons)
    return run


def over(follow, **given):
    def run(**o):
        values = dict(start=0.9, stop=1.1, omega=0.85, follow=int(follow), at=np.array([1.0]), at_len=1)
        parameter = described()
        values["parameter"] = np.frombuffer(parameter, np.uint8)
        return of_branch(branch_of("hbvib_parameter_response", plain, new("hbvib_parameter_options", **{**values, **given, **o})))
    return run


def wedge():
    """A damper between a platform, where it sticks and keeps any force, and a blade, where it slips."""
    model = hbvib.Model(mass=np.diag([1, 0.01, 0.01]), damping=np.diag([0.04, 0.004, 0.004]), stiffness=np.diag([1, 1e-3, 1e-3]))
    model.add_contact("friction_2d", [1, 2, -1], [-1, -1, -1], kt=1, kn=1.5, mu=0.6, normal=(1, -1, 0), tangent=(1, 1, 0))
    model.add_contact("friction_2d", [1, 2, -1], [0, -1, -1], kt=1, kn=1.5, mu=0.15, normal=(-1, -1, 0), tangent=(-1, 1, 0))
    model.add_force(2, 1, harmonic=0)
    model.add_force(0, 0.02)
    return model


damper = wedge()
damped = damper.forced_response((1.23, 1.27), harmonics=3)


def banded(model, branch, point):
    def run(**o):
        options, info = new("hbvib_band_options", **o), new("hbvib_band_info")
        call("hbvib_band", model.handle, branch.handle, point, None, options, None, info, 0, None, None, None, None, 0, None, None, None)
        return bits(info.lower, info.upper, info.sliders)
    return run


MU = described(kind=int(hbvib.ParameterKind.MU))


ONE = new("hbvib_response", measure=3, n=1, dofs=np.array([1]))


OTHER = new("hbvib_response", measure=2, n=1, dofs=np.array([0]))


def batched(keep=0, **given):
    def run(**o):
        options = new("hbvib_batch_options", **{"omega_start": 0.6, "omega_stop": 1.2, "keep": keep, **given, **o})
        handle, values = ctypes.c_void_p(), np.array([[0.8], [1.0]])
        call("hbvib_batch_solve", plain.handle, solver(), options, None, (hbvib.structs["hbvib_parameter"] * 1)(described()), 1, 2,
             values, handle)
        batch = hbvib.Batch._of(handle.value, 2, ())
        kept = [outcome(batch.branch, design=design) for design in range(2)]
        return bits(batch.peak_amplitude, batch.peak_omega, batch.status,
                    batch.points), [isinstance(b, Branch) and of_branch(b) for b in kept]
    return run


def hooked(**o):
    """The lines and calls that hooks receive, and the points that are kept."""
    heard = []
    hooks = new("hbvib_hooks")
    made = {
        "progress": hbvib._calls._TYPES["progress_fn"](lambda user, state: heard.append(("progress", user)) or 0),
        "log": hbvib._calls._TYPES["log_fn"](lambda user, level, text: heard.append(("log", level, user))),
        "phase": hbvib._calls._TYPES["phase_fn"](lambda user, state: heard.append(("phase", user)) or 0),
    }
    for name, function in made.items():
        if o.get(name, True):
            setattr(hooks, name, function)
    hooks.log_level = o.get("log_level", int(hbvib.LogLevel.INFO))
    flag = ctypes.c_int32(o.get("cancel", 0))
    hooks.cancel = ctypes.addressof(flag)
    hooks.user = o.get("user", 1)
    if "struct_size" in o:
        hooks.struct_size = o["struct_size"]
    handle = ctypes.c_void_p()
    call("hbvib_forced_response", plain.handle, solver(), new("hbvib_forced_options", omega_start=0.6, omega_stop=0.9), hooks, handle)
    branch = Branch(handle.value, (), "")
    return heard, of_branch(branch)


NAN, NONE = float("nan"), None
crest_of_damper = int(damped.peaks().point[0])


def with_damper(changed_face, **changed):
    """A response with a damper between the platform of a blade and a fixed one."""
    model = hbvib.Model(mass=np.eye(2), stiffness=[[1.0, -0.1], [-0.1, 1.2]], damping=0.04 * np.eye(2))
    common = dict(kt=1.0, kn=1.5, points_across=2, points_along=2, width=0.2)
    faces = [new("hbvib_damper_face", **{**common, "angle": -0.8, "mu": 0.6, "centre": [-0.1, 0.1, 0.0]}),
             new("hbvib_damper_face", **{**common, "dofs": [0, -1, -1], "angle": 0.8, "mu": 0.15, "centre": [0.1, 0.1, 0.0], **changed_face})]
    array = (hbvib.structs["hbvib_damper_face"] * 2)(*faces)
    described = new("hbvib_damper", **{**dict(mass=0.01, inertia=[1e-3] * 3, orbit=100.0, length=0.2, support=[1e-3, 1e-3],
                                              support_damping=[4e-3, 1e-4]), **changed})
    described.faces = changed["faces"].ctypes.data if isinstance(changed.get("faces"), np.ndarray) else ctypes.addressof(array)
    if "faces" in changed and changed["faces"] is None:
        described.faces = None
    described.faces_len = changed.get("faces_len", 2)
    call("hbvib_model_add_damper", model.handle, described, None, None)
    model.set_speed(1.0)
    model.add_force(0, 0.1)
    return of_branch(model.forced_response(1.1, harmonics=3, tolerance=0, response_dof=0))


def on_platform(**o):
    return with_damper(o)


def on_line(**o):
    return with_damper(o, radius=0.15)


def in_space(**o):
    return with_damper(o, motions=6)


def wedge(**o):
    return with_damper({}, **o)


def in_space_by_damper(**o):
    return with_damper({}, **{"motions": 6, **o})


of_damper = banded(damper, damped, crest_of_damper)


def chosen(**o):
    return banded(damper, damped, crest_of_damper)(**{"contacts": np.array([0]), "contacts_len": 1, **o})


worn = hbvib.Model(mass=np.eye(2), stiffness=np.array([[2.0, -1.0], [-1.0, 1.0]]), rayleigh=(0, 0.05))
for place in (0, 1):
    worn.add_contact("jenkins", place, kt=1, mu=0.3, preload=0.5)
worn.add_force(1, 0.3)


reached = []


def lived(**o):
    given = dict(contacts=np.array([0, 1]), contacts_len=2, rates=np.array([0.05, 0.02]), duty_omega=np.array([0.8, 1.1]), duties_len=2,
                 stiffness=np.array([2.0, 0.0, 0.0, 2.0]), tolerance=1e-7, omega_start=0.5, omega_stop=1.2)
    options, cycles, loads, amplitude = new("hbvib_life_options", **{**given, **o}), np.array([0.0, 3.0]), np.empty(4), np.empty(2)
    solver, info = new("hbvib_solver_options", harmonics=3, tolerance=0.0), new("hbvib_life_info")
    events = ctypes.c_int64()
    call("hbvib_life", worn.handle, solver, options, None, 2, cycles, None, loads, None, amplitude, None, 0, None, None, None, events, info)
    reached.append(amplitude)
    return bits(*loads, *amplitude, events.value, info.steps, info.points)


def peaked(**o):
    return lived(**{"follow": 1, **o})


moded = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
moded.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
moded.add_force(0, 0.1)
mode_of_moded = moded.nonlinear_mode((-2, 0.8), harmonics=3, tolerance=0)


def run_through(**o):
    options, info = new("hbvib_run_up_options", **{**dict(omega_start=0.8, omega_stop=1.3, rate=5e-3), **o}), new("hbvib_run_up_info")
    call("hbvib_branch_run_up", mode_of_moded.handle, moded.handle, options, None, 0, None, None, None, None, None, info)
    return bits(info.largest, info.largest_omega, info.error, info.slow_flow)


def pictured(**o):
    options, rows = new("hbvib_campbell_options", **{**dict(engine_order=2.0, acceleration=1e-3), **o}), np.zeros((6, 2))
    call("hbvib_campbell_response", mode_of_moded.handle, moded.handle, options, None, 2, np.array([0.5, 1.0]), *rows)
    return bits(*rows.ravel())


def flown(**o):
    given = dict(times=np.array([0.0, 1e3, 2e3]), speeds=np.array([0.8, 1.3, 1.1]), points_len=3, edges=np.array([0.5, 0.8]), edges_len=2,
                 stresses=np.array([80.0, 70.0]), stresses_len=2, woehler_stress=50.0, woehler_cycles=1e6, woehler_slope=5.0)
    options, amplitude, cycles, damage = new("hbvib_mission_options", **{**given, **o}), np.zeros(3), np.zeros(3), np.zeros(2)
    call("hbvib_branch_mission", mode_of_moded.handle, moded.handle, options, None, amplitude, cycles, damage, 0, None, None, None)
    return bits(*amplitude, *cycles, *damage)


def swept(**o):
    options, info = new("hbvib_sweep_options", **{**dict(omega_start=0.8, omega_stop=1.1, rate=1e-2), **o}), new("hbvib_sweep_info")
    call("hbvib_time_sweep", worn.handle, options, None, 0, None, None, None, None, info)
    return bits(info.largest, info.largest_omega, info.events)


STEADY = worn.time_response(0.8, harmonics=15).harmonics


def kicked_off(**o):
    """From near the first periodic motion, in fewer periods than rest takes."""
    return swept(**{"start": rows(STEADY), "start_len": STEADY.size, "max_periods": 8, **o})


lived()


AT = np.array([0.7, 0.8, 0.9, 1.0])
SEEN = plain.forced_response((0.7, 1.0), at=AT, harmonics=5, response_dof=0)
HEARD = np.array([SEEN.harmonics(SEEN.at(i).point[0])[1, 0] for i in range(4)]) * [1.02, 1.0, 0.98, 1.01]
BODIES = dict(n=4, x=AT, value=HEARD, sigma=np.full(4, 0.01))
MODAL = dict(kind=4, n=1, mode=1, x=np.zeros(1), value=np.array([1.6 + 0.02j]), sigma=np.array([1e-3]))
CREST = response.peaks()
NEAR = dict(kind=2, n=1, x=CREST.omega[:1].copy(), value=1.02 * CREST.amplitude[:1] + 1.001j * CREST.omega[:1], sigma=np.array([0.01]))


def fitted(given=BODIES, unknown=None, options=None, kinds=(2,)):
    """A fit of friction, or of friction and stiffness of the contact, with one struct of it perturbed."""
    def run(**o):
        values = dict(data={**given}, unknown=dict(unknown or {}), options=dict(options or {}))
        values[run.of].update(o)
        p = len(kinds)
        parameters = [described(kind=kind, contact=0) for kind in kinds]
        unknowns = [new("hbvib_unknown", **values["unknown"])] + [new("hbvib_unknown") for _ in kinds[1:]]
        info, theta, covariance = new("hbvib_fit_info"), np.zeros(p), np.zeros((p, p))
        call("hbvib_fit", plain.handle, solver(response_dof=0), new("hbvib_fit_options", **values["options"]), None,
             (hbvib.structs["hbvib_parameter"] * p)(*parameters), p, (hbvib.structs["hbvib_unknown"] * p)(*unknowns[:p]),
             new("hbvib_data", **values["data"]), 1, info, theta, covariance, 0, None, None, None)
        return bits(theta, covariance, info.chi2, info.loss, info.iterations, info.starts)
    run.of = "data"
    return run


def of(struct, **given):
    run = fitted(**given)
    run.of = struct
    return run


def tied(**o):
    """Two unknowns, the second with a field."""
    kinds = (2, 3)
    parameters = [described(kind=kind, contact=0) for kind in kinds]
    unknowns = [new("hbvib_unknown"), new("hbvib_unknown", **o)]
    info, theta, covariance = new("hbvib_fit_info"), np.zeros(2), np.zeros((2, 2))
    call("hbvib_fit", plain.handle, solver(response_dof=0), None, None, (hbvib.structs["hbvib_parameter"] * 2)(*parameters), 2,
         (hbvib.structs["hbvib_unknown"] * 2)(*unknowns), new("hbvib_data", **BODIES), 1, info, theta, covariance, 0, None, None, None)
    return bits(theta, covariance)


OTHER_DOF = new("hbvib_response", n=1, dofs=np.array([1]))
FOLLOW = hbvib.Follow
KIND = hbvib.ParameterKind
# Structs, their fields, and claims about each field with a call and a value.
TABLE = {
    "hbvib_forced_options": {
        "struct_size": [(refused("struct_size"), forced, 8)],
        "together": [(CHANGES, norm, 1), (refused("together"), forced, 2)],
        "omega_start": [(CHANGES, forced, 0.7), (refused("omega_start"), forced, 0.0), (refused("omega_start"), forced, NAN)],
        "omega_stop": [(CHANGES, forced, 1.1), (CHANGES, guessed, 1.6), (refused("omega_stop"), forced, -1.0)],
        "at": [(CHANGES, forced, np.array([0.8])), (refused("at"), forced, np.array([1.3])), (refused("at"), forced, NONE)],
        "at_len": [(refused("at_len"), forced, -1), (CHANGES, forced, 0)],
        "guess": [
            (CHANGES, guessed, rows(low)), (refused("guess"), guessed, with_entry(high, 1, 0, NAN)), (refused("guess"), guessed, NONE),
            (same("The motion at the contacts counts"), guessed, with_entry(high, 1, 1, 50.0)),
            (same("The motion at the contacts counts"), guessed, with_entry(high, 1, 1, 1e9)),
            (same("the imaginary part of the mean has no effect"), guessed, with_entry(high, 0, 0, 50.0j)),
        ],
        "guess_len": [(refused("guess_len"), guessed, -1), (refused("guess_len"), guessed, 3), (CHANGES, guessed, 4)],
        "responses": [(CHANGES, watched, gauges(4, 3)), (refused("responses"), watched, NONE)],
        "responses_len": [(CHANGES, watched, 1), (refused("responses_len"), watched, -1)],
        "branches": [(refused("branches"), forced, 5), (refused("branches"), forced, -1)],
        "branch_depth": [(refused("branch_depth"), forced, 9), (refused("branch_depth"), forced, -1)],
        "most_branches": [(refused("most_branches"), forced, 10001), (refused("most_branches"), forced, -1)],
    },
    "hbvib_response": {
        "struct_size": [(refused("struct_size"), read, 8)],
        "measure": [(CHANGES, read, 2), (CHANGES, read, 3), (CHANGES, read, 4), (CHANGES, read, 0), (refused("measure"), read, 5)],
        "harmonic": [(CHANGES, read, 1), (refused("harmonic"), read, -1)],
        "n": [(CHANGES, read, 1), (refused("n"), read, -1)],
        "dofs": [(CHANGES, read, np.array([1, 0])), (refused("dofs"), read, np.array([0, 2])), (refused("dofs"), read, NONE)],
        "weights": [(CHANGES, read, NONE), (refused("weights"), read, np.array([0.0, NAN]))],
        "sector": [(refused("sector"), read, 1), (refused("sector"), read, -1)],
        "component": [(CHANGES, read, 1), (CHANGES, read, 2), (refused("component"), read, 3)],
        "reserved": [(refused("reserved"), read, 1)],
    },
    "hbvib_mode_options": {
        "struct_size": [(refused("struct_size"), followed(plain), 8)],
        "damping_form": [(CHANGES, followed(plain), 1), (refused("damping_form"), followed(plain), 2)],
        "log10_start": [(CHANGES, followed(plain), -0.5), (refused("log10_start"), followed(plain), 1.0)],
        "log10_stop": [(CHANGES, followed(plain), 0.4), (refused("log10"), followed(plain), NAN)],
        "diameter": [
            (CHANGES, followed(blades), 1), (refused("diameter"), followed(plain), 1),
            (same("(default): the wave of the model's engine order."), followed(plain), 0),
        ],
        "mode_index": [
            (CHANGES, followed(plain), 1), (refused("mode_index"), followed(plain), 3), (refused("mode_index"), followed(plain), -1),
            (refused("mode_index"), with_choice(near_omega=1.5), 1),
            (refused("mode_index"), with_choice(shape=rows([1, 0, -1]), shape_len=3), 1),
        ],
        "near_omega": [(CHANGES, followed(plain), 1.5), (refused("near_omega"), followed(plain), -1.0),
                       (refused("near_omega"), with_choice(shape=rows([1, 0, -1]), shape_len=3), 1.5)],
        "shape": [(CHANGES, with_choice(shape=rows([1, 1, 1]), shape_len=3), rows([1, 0, -1])),
                  (refused("shape"), with_choice(shape=rows([1, 1, 1]), shape_len=3), NONE),
                  (refused("shape"), with_choice(shape=rows([1, 1, 1]), shape_len=3), rows([0, 0, 0]))],
        "shape_len": [(refused("shape_len"), with_choice(shape=rows([1, 1, 1]), shape_len=3), 2),
                      (refused("shape"), with_choice(shape=rows([1, 1, 1]), shape_len=3), 0)],
        "amplitude_contact": [(CHANGES, followed(plain), 0), (refused("amplitude_contact"), followed(plain), 1),
                              (refused("amplitude_contact"), followed(plain), -2)],
        "at": [(CHANGES, requested_mode, np.array([0.2])), (refused("at"), requested_mode, np.array([2.0])),
               (refused("at"), requested_mode, NONE)],
        "at_len": [(CHANGES, requested_mode, 0), (refused("at_len"), requested_mode, -1)],
        "reference_dof": [(CHANGES, followed(plain), 0), (refused("reference_dof"), followed(plain), 3)],
    },
    "hbvib_synthesis_options": {
        "struct_size": [(refused("struct_size"), synthesised, 8)],
        "model_damping": [(CHANGES, synthesised, 1), (refused("model_damping"), synthesised, 2)],
        "force_factor": [(CHANGES, synthesised, 2.0), (refused("force_factor"), synthesised, 0.0)],
        "damping_ratio": [(CHANGES, synthesised, 0.01), (refused("damping_ratio"), synthesised, 1.0)],
    },
    "hbvib_time_options": {
        "struct_size": [(refused("struct_size"), in_time(plain), 8)],
        "method": [(CHANGES, in_time(plain), 1), (refused("method"), in_time(plain), 2)],
        "omega": [(CHANGES, in_time(plain), 1.1), (refused("omega"), in_time(plain), 0.0)],
        "harmonics": [(CHANGES, in_time(plain), 3), (refused("harmonics"), in_time(plain), -1)],
        "samples": [(CHANGES, in_time(plain), 16), (refused("samples"), in_time(plain), -1)],
        "tolerance": [(CHANGES, in_time(plain, method=1), 1e-4), (CHANGES, in_time(folded, 0.5), 1e-6),
                      (refused("tolerance"), in_time(plain), 0.0)],
        "max_periods": [(refused("max_periods"), in_time(plain), 1), (refused("max_periods"), in_time(plain), 0)],
        "places": [(refused("places"), in_time(plain, places=np.zeros(1), places_len=1), NONE)],
        "places_len": [(refused("number of contacts"), in_time(plain, places=np.zeros(2), places_len=1), 2)],
        "start": [
            (CHANGES, in_time(folded, 1.15, start=rows(high), start_len=high.size), rows(low)),
            (same("the imaginary part of the mean has no effect"), in_time(folded, 1.15, start=rows(high), start_len=high.size),
             with_entry(high, 0, 0, 50j)),
            (refused("start"), in_time(folded, 1.15, start=rows(high), start_len=high.size), NONE),
        ],
        "start_len": [(refused("start has 3 numbers"), in_time(folded, 1.15, start=rows(high), start_len=high.size), 3),
                      (refused("start_len"), in_time(folded, 1.15, start=rows(high), start_len=high.size), -1)],
    },
    "hbvib_verify_options": {
        "struct_size": [(refused("struct_size"), verified(), 8)],
        "method": [(CHANGES, verified(), 1), (refused("method"), verified(), 2)],
        "tolerance": [(CHANGES, verified(method=1), 1e-5), (refused("tolerance"), verified(), 0.0)],
        "max_periods": [(refused("max_periods"), verified(), 1), (refused("max_periods"), verified(), 0)],
        "same_within": [(CHANGES, verified(), 1e-9), (refused("same_within"), verified(), 0.0)],
    },
    "hbvib_floquet_options": {
        "struct_size": [(refused("struct_size"), multipliers(plain, response, peak), 8)],
        "waves": [
            (CHANGES, multipliers(blades, wave, crest), 1), (refused("waves"), multipliers(plain, response, peak), 2),
            (same("which have the same effect on a plain structure"), multipliers(plain, response, peak), 1),
        ],
        "refine": [(CHANGES, multipliers(plain, response, peak), 0), (refused("refine"), multipliers(plain, response, peak), 2)],
        "modes": [(CHANGES, multipliers(plain, response, peak), 1), (refused("modes"), multipliers(plain, response, peak), -2)],
        "tolerance": [
            (CHANGES, multipliers(folded, motions, 3), 1e-5), (refused("tolerance"), multipliers(plain, response, peak), 0.0),
            (same("With refine = 0 it has no effect, as tolerance."), multipliers(plain, response, peak, refine=0), 1e-4),
        ],
        "max_periods": [
            (refused("max_periods"), multipliers(plain, response, peak), 1),
            (refused("max_periods"), multipliers(plain, response, peak), 0),
            (same("With refine = 0 it has no effect, as tolerance."), multipliers(plain, response, peak, refine=0), 1),
        ],
    },
    "hbvib_parameter": {
        "struct_size": [(refused("struct_size"), derivative(), 8)],
        "kind": [(CHANGES, derivative(), int(KIND.MU)), (refused("kind"), derivative(), 99),
                 (refused("gap"), derivative(), int(KIND.GAP))],
        "contact": [
            (same("or -1: the constant of all contacts that have it"), derivative(), 0), (refused("contact"), derivative(), 1),
            (refused("contact"), derivative(), -2),
            (refused("contact"), derivative(kind=int(KIND.FORCE)), 0), (refused("contact"), derivative(kind=int(KIND.SPEED)), 0),
            (refused("contact"), derivative(kind=int(KIND.MASS), scaling=1), 0),
        ],
        "direction": [
            (CHANGES, derivative(kind=int(KIND.MASS), direction=np.frombuffer(MATRIX, np.uint8)),
             np.frombuffer(hbvib._structs._matrix(2 * np.eye(3), hbvib.Part.GENERAL), np.uint8)),
            (refused("direction"), derivative(), np.frombuffer(MATRIX, np.uint8)),
            (refused("direction"), derivative(kind=int(KIND.FORCE)), np.frombuffer(MATRIX, np.uint8)),
            (refused("direction"), derivative(kind=int(KIND.MASS), scaling=1), np.frombuffer(MATRIX, np.uint8)),
            (refused("direction"), derivative(kind=int(KIND.MASS), direction=np.frombuffer(MATRIX, np.uint8)), NONE),
            (refused("direction"), derivative(kind=int(KIND.MASS), direction=np.frombuffer(MATRIX, np.uint8)),
             np.frombuffer(WRONG_MATRIX, np.uint8)),
        ],
        "scaling": [(refused("scaling"), derivative(), 1), (refused("scaling"), derivative(kind=int(KIND.FORCE)), 1),
                    (refused("scaling"), derivative(kind=int(KIND.MASS), scaling=1), 2)],
        "reserved": [(refused("reserved"), derivative(), 1)],
    },
    "hbvib_data": {
        "struct_size": [(refused("struct_size"), fitted(), 8)],
        "kind": [(CHANGES, fitted({**BODIES, "value": abs(HEARD) + 0j}), 1), (refused("kind"), fitted(), 5)],
        "force_factor": [(CHANGES, fitted(), 1.1), (refused("force_factor"), fitted(), NAN)],
        "response": [(CHANGES, fitted(), np.frombuffer(OTHER_DOF, np.uint8))],
        "mode": [(refused("no point depends on it"), fitted(MODAL, kinds=(3,)), 0), (refused("mode"), fitted(MODAL, kinds=(3,)), -1)],
        "omega_start": [(refused("no solution"), fitted({**NEAR, "omega_start": 0.5, "omega_stop": 1.2}), 1.1), (refused("range"), fitted(), 1.0)],
        "omega_stop": [(refused("range"), fitted({**NEAR, "omega_start": 0.5, "omega_stop": 1.2}), 0.4)],
        "n": [(CHANGES, fitted(), 3), (refused("n = 0"), fitted(), 0), (refused("n"), fitted(), -1)],
        "x": [(CHANGES, fitted(), 1.01 * AT), (refused("x"), fitted(), NONE), (refused("x[0]"), fitted(), -AT)],
        "value": [(CHANGES, fitted(), 1.01 * HEARD), (refused("value"), fitted(), NONE)],
        "sigma": [(CHANGES, fitted(), np.full(4, 0.02)), (refused("sigma"), fitted(), NONE), (refused("sigma[0]"), fitted(), np.zeros(4))],
        "second_sigma": [(CHANGES, fitted(NEAR), np.array([1e-2])), (refused("second_sigma"), fitted(NEAR), np.array([-1.0]))],
    },
    "hbvib_unknown": {
        "struct_size": [(refused("struct_size"), of("unknown"), 8)],
        "scale": [(CHANGES, of("unknown", unknown=dict(has_start=1, start=0.4)), 1), (refused("scale"), of("unknown"), 3)],
        "start": [(CHANGES, of("unknown", unknown=dict(has_start=1, start=0.4)), 0.35),
                  (refused("start"), of("unknown", unknown=dict(has_start=1, start=0.4)), NAN),
                  (same("if has_start is 1; otherwise that of the model"), of("unknown"), 0.4)],
        "lower": [(CHANGES, of("unknown", unknown=dict(has_lower=1, lower=0.1)), 0.3),
                  (refused("start"), of("unknown", unknown=dict(has_lower=1, lower=0.1)), 0.5)],
        "upper": [(CHANGES, of("unknown", unknown=dict(has_start=1, start=0.2, has_upper=1, upper=0.9)), 0.21),
                  (refused("start"), of("unknown", unknown=dict(has_upper=1, upper=0.9)), 0.1)],
        "prior_mean": [(CHANGES, of("unknown", unknown=dict(prior_mean=0.3, prior_sigma=0.01)), 0.35),
                       (refused("prior"), of("unknown", unknown=dict(prior_mean=0.3, prior_sigma=0.01)), NAN)],
        "prior_sigma": [(CHANGES, of("unknown", unknown=dict(prior_mean=0.35, prior_sigma=0.01)), 0.02),
                        (refused("prior_sigma"), of("unknown"), -1.0)],
        "tied_to": [(CHANGES, tied, 0), (refused("tied_to"), tied, 1), (refused("tied_to"), tied, -2)],
        "has_start": [(CHANGES, of("unknown", unknown=dict(start=0.4)), 1), (refused("has_start"), of("unknown"), 2)],
        "has_lower": [(refused("start"), of("unknown", unknown=dict(lower=0.5)), 1), (refused("has_lower"), of("unknown"), 2)],
        "has_upper": [(refused("start"), of("unknown", unknown=dict(upper=0.1)), 1), (refused("has_upper"), of("unknown"), 2)],
        "reserved": [(refused("reserved"), of("unknown"), 1)],
        "data_set": [(refused("data_set = 1"), of("unknown"), 1), (refused("data_set"), of("unknown"), -2)],
    },
    "hbvib_fit_options": {
        "struct_size": [(refused("struct_size"), of("options"), 8)],
        "scale_covariance": [(CHANGES, of("options"), 1), (refused("scale_covariance"), of("options"), 2)],
        "huber": [(CHANGES, of("options"), 0.5), (refused("huber"), of("options"), -1.0)],
        "starts": [(CHANGES, of("options"), 3), (refused("starts"), of("options"), 0), (refused("starts"), of("options"), -1)],
        "max_iterations": [(CHANGES, of("options", unknown=dict(has_start=1, start=0.4)), 1), (refused("max_iterations"), of("options"), 0)],
        "step": [(CHANGES, of("options", unknown=dict(has_start=1, start=0.4)), 0.5), (refused("step"), of("options"), 0.0)],
    },
    "hbvib_parameter_options": {
        "struct_size": [(refused("struct_size"), over(FOLLOW.OMEGA), 8)],
        "follow": [(CHANGES, over(FOLLOW.OMEGA), int(FOLLOW.PEAK)), (refused("follow"), over(FOLLOW.OMEGA), 9)],
        "parameter": [(CHANGES, over(FOLLOW.OMEGA), np.frombuffer(MU, np.uint8)), (refused("parameter"), over(FOLLOW.OMEGA), NONE)],
        "start": [(CHANGES, over(FOLLOW.OMEGA), 0.8), (refused("start"), over(FOLLOW.OMEGA), NAN),
                  (refused("preload"), over(FOLLOW.OMEGA), -1.0)],
        "stop": [(CHANGES, over(FOLLOW.OMEGA), 1.2), (refused("stop"), over(FOLLOW.OMEGA), NAN)],
        "omega": [(CHANGES, over(FOLLOW.OMEGA), 0.9), (refused("omega"), over(FOLLOW.OMEGA), 0.0)],
        "at": [(CHANGES, over(FOLLOW.OMEGA), np.array([1.05])), (refused("at"), over(FOLLOW.OMEGA), np.array([3.0])),
               (refused("at"), over(FOLLOW.OMEGA), NONE)],
        "at_len": [(CHANGES, over(FOLLOW.OMEGA), 0), (refused("at_len"), over(FOLLOW.OMEGA), -1)],
        "log10_start": [(CHANGES, over(FOLLOW.MODE_MAX_DAMPING, omega=1.0, log10_start=-0.5, log10_stop=1.5), -0.4),
                        (refused("log10_start"), over(FOLLOW.OMEGA), 1.0),
                        (refused("log10_start"), over(FOLLOW.PEAK), 1.0)],
        "log10_stop": [(CHANGES, over(FOLLOW.MODE_MAX_DAMPING, omega=1.0, log10_start=-0.5, log10_stop=1.5), 1.0),
                       (refused("log10_stop"), over(FOLLOW.OMEGA), 1.0),
                       (refused("log10_stop"), over(FOLLOW.PEAK), 1.0)],
        "response": [(CHANGES, over(FOLLOW.OMEGA), np.frombuffer(ONE, np.uint8)),
                     (refused("response"), over(FOLLOW.MODE_MAX_DAMPING), np.frombuffer(ONE, np.uint8))],
    },
    "hbvib_batch_options": {
        "struct_size": [(refused("struct_size"), batched(), 8)],
        "threads": [(same("Their number changes no bit of a result"), batched(), 2),
                    (same("Their number changes no bit of a result"), batched(1), 2),
                    (refused("threads"), batched(), 0)],
        "omega_start": [(CHANGES, batched(), 0.7), (refused("omega_start"), batched(), 0.0)],
        "omega_stop": [(CHANGES, batched(), 1.1), (refused("omega_stop"), batched(), 0.0)],
        "keep": [(CHANGES, batched(), 1), (refused("keep"), batched(), 2)],
        "reserved": [(refused("reserved"), batched(), 1)],
        "responses": [(CHANGES, batched(responses=np.frombuffer(ONE, np.uint8), responses_len=1), np.frombuffer(OTHER, np.uint8)),
                      (refused("responses"), batched(responses=np.frombuffer(ONE, np.uint8), responses_len=1), NONE)],
        "responses_len": [(refused("responses_len"), batched(responses=np.frombuffer(ONE, np.uint8)), -1),
                          (CHANGES, batched(responses=np.frombuffer(ONE, np.uint8)), 1)],
    },
    "hbvib_band_options": {
        "struct_size": [(refused("struct_size"), of_damper, 8)],
        "of": [(CHANGES, of_damper, 1), (CHANGES, of_damper, 2), (refused("of = 3"), of_damper, 3)],
        "contacts": [(CHANGES, chosen, np.array([1])), (refused("contacts"), chosen, np.array([2])), (refused("contacts"), chosen, NONE)],
        "contacts_len": [(refused("contacts_len"), chosen, -1),
                         (CHANGES, lambda **o: chosen(**{"contacts": np.array([1]), **o}), 0)],
        "starts": [(same("With one it has no effect"), of_damper, 1), (refused("starts"), of_damper, 0)],
    },
    "hbvib_life_options": {
        "struct_size": [(refused("struct_size"), lived, 8)],
        "follow": [(CHANGES, lived, 1), (refused("follow"), lived, 2)],
        "contacts": [(CHANGES, lived, np.array([1, 0])), (refused("contact"), lived, np.array([0, 9])), (refused("contacts"), lived, NONE)],
        "rates": [(CHANGES, lived, np.array([0.05, 0.03])), (refused("rate"), lived, np.array([NAN, 0.1])), (refused("rates"), lived, NONE)],
        "areas": [(CHANGES, lived, np.array([2.0, 1.0])), (refused("area"), lived, np.array([0.0, 1.0]))],
        "contacts_len": [(refused("contacts_len"), lived, -1), (refused("0 contacts"), lived, 0)],
        "stiffness": [(CHANGES, lived, np.array([1.0, 0.1, 0.1, 1.0])), (refused("stiffness"), lived, np.array([NAN, 0, 0, 1]))],
        "worn": [(CHANGES, lived, np.array([0.01, 0.0])), (refused("worn"), lived, np.array([-1.0, 0.0]))],
        "duty_omega": [(CHANGES, lived, np.array([0.8, 1.2])), (refused("omega"), lived, np.array([0.8, 0.0])), (refused("duty_omega"), lived, NONE)],
        "duty_force": [(CHANGES, lived, np.array([1.0, 2.0])), (refused("force"), lived, np.array([1.0, -1.0]))],
        "duty_share": [(CHANGES, lived, np.array([1.0, 2.0])), (refused("share"), lived, np.array([1.0, -1.0]))],
        "duties_len": [(CHANGES, lived, 1), (refused("duties_len"), lived, -1)],
        "omega_start": [(CHANGES, peaked, 0.8), (refused("omega_start"), peaked, 0.0)],
        "omega_stop": [(CHANGES, peaked, 3.0), (refused("omega_stop"), peaked, NAN)],
        "tolerance": [(CHANGES, lived, 1e-9), (refused("tolerance"), lived, 1.0)],
        "limit": [(CHANGES, lived, float(reached[0].mean())), (refused("limit"), lived, -1.0)],
        "most_steps": [(CHANGES, lived, 1), (refused("most_steps"), lived, 0)],
    },
    "hbvib_sweep_options": {
        "struct_size": [(refused("struct_size"), swept, 8)],
        "reserved": [(refused("reserved"), swept, 1)],
        "omega_start": [(CHANGES, swept, 0.85), (refused("omega_start"), swept, 0.0)],
        "omega_stop": [(CHANGES, swept, 0.85), (refused("omega_stop"), swept, NAN)],
        "rate": [(CHANGES, swept, 2e-2), (refused("rate"), swept, 0.0)],
        "dof": [(CHANGES, swept, 1), (refused("dof"), swept, 9)],
        "tolerance": [(same("the steps of smooth laws"), swept, 1e-10), (refused("tolerance"), swept, 1.0)],
        "max_periods": [(refused("max_periods"), swept, 0), (refused("max_periods = 1"), swept, 1)],
        "start": [(refused("max_periods = 8"), kicked_off, NONE), (refused("start"), kicked_off, np.full(2 * STEADY.size, NAN))],
        "start_len": [(refused("start_len"), kicked_off, -1), (refused("start"), kicked_off, 3)],
    },
    "hbvib_run_up_options": {
        "struct_size": [(refused("struct_size"), run_through, 8)],
        "model_damping": [(CHANGES, run_through, 1), (refused("model_damping"), run_through, 2)],
        "omega_start": [(CHANGES, run_through, 0.9), (refused("omega_start"), run_through, 0.0)],
        "omega_stop": [(CHANGES, run_through, 0.9), (refused("omega_stop"), run_through, NAN)],
        "rate": [(CHANGES, run_through, 2e-2), (refused("rate"), run_through, 0.0)],
        "dof": [(same("one degree of freedom"), run_through, 0), (refused("dof"), run_through, 9)],
        "force_factor": [(CHANGES, run_through, 1.1), (refused("force_factor"), run_through, 0.0)],
        "damping_ratio": [(CHANGES, run_through, 0.01), (refused("damping_ratio"), run_through, 1.0)],
        "integrated_turns": [(CHANGES, run_through, 0), (refused("integrated_turns"), run_through, -1)],
    },
    "hbvib_campbell_options": {
        "struct_size": [(refused("struct_size"), pictured, 8)],
        "model_damping": [(CHANGES, pictured, 1), (refused("model_damping"), pictured, 2)],
        "engine_order": [(CHANGES, pictured, 3.0), (refused("engine_order"), pictured, 0.0)],
        "acceleration": [(CHANGES, pictured, -1e-3), (refused("acceleration"), pictured, NAN)],
        "damping_ratio": [(CHANGES, pictured, 0.01), (refused("damping_ratio"), pictured, 1.0)],
    },
    "hbvib_mission_options": {
        "struct_size": [(refused("struct_size"), flown, 8)],
        "model_damping": [(CHANGES, flown, 1), (refused("model_damping"), flown, 2)],
        "times": [(CHANGES, flown, np.array([0.0, 5e2, 2e3])), (refused("times"), flown, np.array([0.0, 0.0, 1.0]))],
        "speeds": [(CHANGES, flown, np.array([0.8, 1.2, 1.1])), (refused("speeds"), flown, np.array([0.8, 0.0, 1.1]))],
        "points_len": [(CHANGES, flown, 2), (refused("points_len"), flown, -1)],
        "engine_order": [(CHANGES, flown, 1.1), (refused("engine_order"), flown, 0.0)],
        "dof": [(same("one degree of freedom"), flown, 0), (refused("dof"), flown, 9)],
        "edges": [(CHANGES, flown, np.array([0.1, 0.8])), (refused("edges"), flown, np.array([0.5, 0.5]))],
        "edges_len": [(CHANGES, flown, 1), (refused("edges_len"), flown, -1)],
        "stresses": [(CHANGES, flown, np.array([90.0, 40.0])), (refused("stresses"), flown, np.array([-1.0, 40.0]))],
        "stresses_len": [(CHANGES, flown, 1), (refused("stresses_len"), flown, -1)],
        "woehler_stress": [(CHANGES, flown, 60.0), (refused("woehler_stress"), flown, 0.0)],
        "woehler_cycles": [(CHANGES, flown, 2e6), (refused("woehler_cycles"), flown, -1.0)],
        "woehler_slope": [(CHANGES, flown, 6.0), (refused("woehler_slope"), flown, NAN)],
        "woehler_slope_below": [(CHANGES, flown, 9.0), (refused("woehler_slope_below"), flown, -1.0)],
        "force_factor": [(CHANGES, flown, 1.1), (refused("force_factor"), flown, 0.0)],
        "damping_ratio": [(CHANGES, flown, 0.01), (refused("damping_ratio"), flown, 1.0)],
    },
    "hbvib_damper_face": {
        "struct_size": [(refused("struct_size"), on_platform, 8)],
        "reserved": [(refused("reserved"), on_platform, 1)],
        "dofs": [(CHANGES, on_platform, [1, -1, -1]), (refused("dofs"), on_platform, [9, -1, -1])],
        "sector_offset": [(refused("sector_offset"), on_platform, 1)],
        "angle": [(CHANGES, on_platform, 0.6), (refused("angle"), on_platform, NAN)],
        "turn": [(CHANGES, on_platform, 0.2), (refused("turn"), on_platform, NAN)],
        "centre": [(CHANGES, on_platform, [0.1, 0.2, 0.0]), (same("without effect on a cylinder"), on_line, [0.1, 0.2, 0.0])],
        "width": [(CHANGES, on_platform, 0.3), (same("without effect on a cylinder"), on_line, 0.3), (refused("width"), on_platform, NAN)],
        "points_across": [(CHANGES, on_platform, 3), (same("one on a cylinder"), on_line, 3), (refused("points"), on_platform, 0)],
        "points_along": [(same("one with 3 motions"), on_platform, 3), (CHANGES, in_space, 3), (refused("points"), in_space, 0)],
        "kt": [(CHANGES, on_platform, 0.7), (refused("kt"), on_platform, -1.0)],
        "kn": [(CHANGES, on_platform, 0.9), (refused("kn"), on_platform, 0.0)],
        "mu": [(CHANGES, on_platform, 0.05), (refused("mu"), on_platform, -1.0)],
        "gap": [(CHANGES, on_platform, 0.1), (refused("gap"), on_platform, NAN)],
    },
    "hbvib_damper": {
        "struct_size": [(refused("struct_size"), wedge, 8)],
        "motions": [(CHANGES, wedge, 6), (refused("motions"), wedge, 4)],
        "mass": [(CHANGES, wedge, 0.02), (refused("mass"), wedge, 0.0)],
        "inertia": [(CHANGES, wedge, [0.0, 0.0, 0.1]), (refused("inertia"), wedge, [0.0, 0.0, 0.0]), (refused("inertia"), wedge, [-1.0, 1.0, 1.0])],
        "radius": [(CHANGES, wedge, 0.1), (refused("radius"), wedge, -1.0)],
        "length": [(CHANGES, in_space_by_damper, 0.4), (refused("length"), wedge, NAN)],
        "orbit": [(CHANGES, wedge, 30.0), (refused("orbit"), wedge, NAN)],
        "support": [(CHANGES, wedge, [2e-3, 0.0]), (refused("support"), wedge, [-1.0, 0.0])],
        "support_damping": [(CHANGES, wedge, [5e-3, 0.0]), (refused("support_damping"), wedge, [0.0, NAN])],
        "faces": [(refused("faces"), wedge, NONE)],
        "faces_len": [(refused("faces_len"), wedge, -1), (refused("without faces"), wedge, 0)],
    },
    "hbvib_hooks": {
        "struct_size": [(refused("struct_size"), hooked, 8)],
        "log_level": [(CHANGES, hooked, int(hbvib.LogLevel.WARN)), (CHANGES, hooked, 0), (refused("log_level"), hooked, 9)],
        "user": [(CHANGES, hooked, 2)],
        "progress": [(CHANGES, hooked, False)],
        "log": [(CHANGES, hooked, False)],
        "cancel": [(CHANGES, hooked, 1)],
        "phase": [(CHANGES, hooked, False)],
    },
}

# A mode that begins from a motion.
near = len(mode) // 2
start = rows(mode.harmonics(near))
begun = with_choice(guess=start, guess_len=start.size, guess_omega=mode.omega[near], guess_damping=mode.damping_ratio[near])
TABLE["hbvib_mode_options"].update({
    "guess": [(refused("guess"), begun, with_entry(start, 1, 0, NAN)), (refused("guess"), begun, NONE),
              (refused("guess"), begun, rows(0 * start))],
    "guess_len": [(refused("guess"), begun, -1), (refused("guess"), begun, 4), (refused("guess"), begun, 0)],
    "guess_omega": [(CHANGES, begun, 1.01 * mode.omega[near]), (refused("guess_omega"), begun, 0.0),
                    (refused("guess_omega"), begun, NAN),
                    (refused("guess_omega"), followed(plain), 1.0)],
    "guess_damping": [(CHANGES, begun, 0.9 * mode.damping_ratio[near]), (refused("guess_damping"), begun, NAN),
                      (refused("guess_damping"), followed(plain), 0.1)],
    "branches": [(refused("branches"), begun, 2), (refused("branches"), begun, -1)],
    "branch_depth": [(refused("branch_depth"), begun, 9), (refused("branch_depth"), begun, -1)],
    "most_branches": [(refused("most_branches"), begun, 10001), (refused("most_branches"), begun, -1)],
})

references = {}
for struct, fields in TABLE.items():
    known = [name for name, _ in hbvib.structs[struct]._fields_]
    check(f"the table has every field of {struct}, and no other", set(known) == set(fields), set(known) ^ set(fields))
    for field, claims in fields.items():
        for number, (claim, function, value) in enumerate(claims):
            if function not in references:
                references[function] = outcome(function)
            shown = value if isinstance(value, (int, float, type(None))) else f"array {number}"
            hold(claim, f"{struct}.{field} = {shown}", function, references[function], **{field: value})

# Every struct of the interface is in a table, or filled by the library.
ELSEWHERE = {"hbvib_solver_options", "hbvib_contact", "hbvib_matrix", "hbvib_user_force", "hbvib_sector"}
FILLED = {
    "hbvib_force_call", "hbvib_jacobian_gap", "hbvib_progress", "hbvib_phase_report", "hbvib_view", "hbvib_reduction", "hbvib_energy",
    "hbvib_contact_summary", "hbvib_mode_point", "hbvib_mode_info", "hbvib_time_info", "hbvib_verification", "hbvib_floquet_info",
    "hbvib_band_info", "hbvib_wheel_info",
    "hbvib_descent", "hbvib_searched", "hbvib_kick", "hbvib_life_info", "hbvib_best_load", "hbvib_sweep_info", "hbvib_run_up_info",
    "hbvib_band_info", "hbvib_fit_info", "hbvib_fit_profile_info", "hbvib_wheel_info",
    "hbvib_descent", "hbvib_searched", "hbvib_kick",
}
listed = set(TABLE) | ELSEWHERE | FILLED
check("every struct is in a table or filled by the library", listed == set(hbvib.structs), listed ^ set(hbvib.structs))

finish(150)
