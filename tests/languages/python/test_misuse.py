"""Misuse gives Python's natural errors with the library's words, and changes nothing."""

import pickle
import warnings

import numpy as np

from common import HZ, STIFFNESS, bits, check, close, finish, hbvib, oscillator, raises, ring_damper, solve

model = ring_damper()
branch = solve(model)
reference = bits(branch)
n = len(branch)


def refused(claim, kind, function, *arguments, words="", **options):
    error = raises(claim, kind, function, *arguments, words=words, **options)
    check(f"{claim}: the model solves to the same bits", bits(solve(model)) == reference)
    return error


# Sentence, status and number of the argument.
error = refused("a degree of freedom out of range", IndexError, model.add_force, 4, 1.0, words="dof = 4, needs 0 .. 3")
check("status of an error", error.status is hbvib.Status.E_INDEX and isinstance(error, hbvib.Error))
check("number of the argument", error.argument == 2 and error.sentence == str(error))
again = pickle.loads(pickle.dumps(error))
check(
    "an error crosses processes",
    (str(again), again.status, again.argument) == (str(error), error.status, error.argument),
)
error = refused("options out of range", ValueError, solve, model, harmonics=-1, words="harmonics = -1")
check("argument 2 is the solver options", error.argument == 2 and error.status == hbvib.Status.E_ARGUMENT)
error = refused("an empty range", ValueError, model.nonlinear_mode, (1, 0), words="log10")
check("argument 3 is the mode options", error.argument == 3)

# Python's own.
refused(
    "an unknown option",
    TypeError,
    solve,
    model,
    harmonic=3,
    words="forced_response() got an unexpected keyword argument 'harmonic'",
)
refused("struct_size is no option", TypeError, solve, model, struct_size=3)
refused("an unknown option of a mode", TypeError, model.nonlinear_mode, (-6, -5), reserve=3, words="nonlinear_mode()")
refused("an unknown option in time", TypeError, model.time_response, 1300.0, harmonix=3, words="time_response()")
refused("an unknown option of a check", TypeError, model.verify, branch, 0, near=1, words="verify()")
refused("a length that the array tells", TypeError, model.time_response, 1300.0, start_len=3)
refused("an unknown constant", TypeError, model.add_contact, "jenkins", 0, dof_a=1, words="add_contact()")
refused("an unknown law", ValueError, model.add_contact, "coulomb", 0, words="friction_2d")
refused("a law by a wrong number", ValueError, model.add_contact, 17, 0)
refused("a matrix that is none", ValueError, model.set_matrix, "stiff", STIFFNESS, words="mass, damping, stiffness")
refused("a float as index", TypeError, model.add_force, 1.0, 1.0)
refused("a text as number", TypeError, model.set_rayleigh, "1", 0)
refused("a text as force", TypeError, model.add_force, 0, "5")
refused("a complex range", TypeError, model.forced_response, (1j, 2))
refused("an index beyond 64 bits", OverflowError, model.add_force, 2**64, 1.0)
refused("a number of harmonics beyond 64 bits", OverflowError, solve, model, harmonics=2**63)
refused("a number beyond 32 bits", OverflowError, solve, model, num_threads=2**32 + 1)
refused("three ends of a range", ValueError, model.forced_response, (1, 2, 3))
refused("progress that cannot be called", TypeError, solve, model, progress=1)
refused("a flag that is none", TypeError, solve, model, cancel=True)
refused("a guess of another shape", ValueError, solve, model, guess=np.zeros((10, 3)))
refused("a guess of another type", TypeError, solve, model, guess=np.full((10, 4), None))
refused(
    "directions of another length", ValueError, model.add_contact, "friction_3d", [0, 1, 2], kt=1, kn=1, mu=1,
    normal=[0, 1]
)
refused("more degrees of freedom than a law has", ValueError, model.add_contact, "jenkins", [0, 1], kt=1, mu=1, preload=1)
refused(
    "a law without its constants", TypeError, model.add_contact, "jenkins", 0, kt=1, words="'jenkins' misses mu, preload"
)
refused("a law of several constants", TypeError, hbvib.evaluate_contact, "regularised", [0, 1], mu=1, words="preload, velocity")
refused("a grid as range", ValueError, model.forced_response, np.linspace(1, 2, 50), words="at=")
refused("a grid of amplitudes as range", ValueError, model.nonlinear_mode, np.linspace(-6, -2, 9), words="at=")
refused("a range of one entry", ValueError, model.forced_response, [1.0], words="has 1 entries")
refused("no user force", TypeError, model.add_user_force, [0], None)
refused("infinity", ValueError, model.add_force, 0, complex(1, float("inf")), words="inf")
refused("not a number", ValueError, model.set_preload, 0, float("nan"), words="NaN")
refused("a contact that is not there", IndexError, model.set_preload, 1, 1.0)
refused("more modes than there are", ValueError, model.linear_modes, 5)
refused("tables of two lengths", ValueError, model.add_table, 0, displacement=[0, 1], force=[0])
refused("powers that overflow", ValueError, model.add_polynomial, [0], [0], [1.0], [[2**32 + 1]])
refused("coupling of a plain structure", NotImplementedError, hbvib.Model(1).set_coupling, "stiffness", 1)
raises("a model without size", TypeError, hbvib.Model)
raises("a wheel without sectors", TypeError, hbvib.Model.cyclic, 4, 24)
raises("a model of no size", ValueError, hbvib.Model, 0)
raises("a model of half a degree of freedom", TypeError, hbvib.Model, 1.5)
for point in (-1, 10**6):
    raises(f"point {point}", IndexError, branch.harmonics, point)
    raises(f"energy of point {point}", IndexError, branch.energy, point)
raises("a contact out of range", IndexError, branch.loop, 0, 1)
raises("a direction out of range", IndexError, branch.loop, 0, 0, 1)
raises("a wanted frequency that was not asked for", IndexError, branch.at, 0)
raises("degrees of freedom out of range", (IndexError, ValueError), branch.harmonics, 0, 3, 2)
raises("a field that is none", ValueError, branch.field, "speed")
raises("a field of modes", ValueError, lambda: branch.damping_ratio)
raises("mode data of a forced response", NotImplementedError, branch.mode_point, 0)
raises("a singular structure", (ArithmeticError, ValueError), hbvib.Model(1, stiffness=1).linear_modes, 1)
check("after all that the branch is as it was", bits(branch) == reference and len(branch) == n)

# Freed objects.
copy = model.clone()
other = solve(copy)
copy.free()
raises("a freed model", ValueError, copy.add_force, 0, 1.0, words="freed")
raises("a freed model is not solved", hbvib.FreedError, solve, copy)
raises("a freed model is not freed again", hbvib.FreedError, copy.free)
raises("synthesis from a freed model", ValueError, branch.synthesis, copy)
check("branches outlive their model", bits(other) == reference)
other.free()
raises("a freed branch", ValueError, lambda: len(other), words="freed")
check("freed objects still print", "freed" in repr(copy) and "freed" in repr(other))
raises(
    "a raw call on a stale handle is the library's own refusal",
    hbvib.FreedError,
    hbvib._calls._call,
    "hbvib_model_clear_forces",
    12345,
)
with hbvib.Model(1) as short:
    pass
raises("a with block frees a model", hbvib.FreedError, lambda: short.ndof)
with hbvib.Model(1) as short:
    short.free()
check("a model freed within its block is no error", True)

# Stopping early warns, once, with the reason; the points are there.
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    short = model.forced_response((HZ * 207, HZ * 211), response_dof=0, max_points=5)
check("an early stop warns", [type(warning.message) for warning in caught] == [hbvib.StoppedEarly])
check("the warning points here", caught[0].filename == __file__, caught[0].filename)
check(
    "with the reason",
    caught[0].message.status is hbvib.Status.STOPPED_MAX_POINTS and "max_points" in str(caught[0].message),
)
check(
    "the branch tells it, too", short.status is hbvib.Status.STOPPED_MAX_POINTS and not short.complete and short.message
)
check("and has its points", len(short) == 5 and np.array_equal(short.omega, branch.omega[:5]))
check("a whole branch says so", branch.complete and branch.status == 0 and branch.message == "")
with warnings.catch_warnings():
    warnings.simplefilter("error")
    error = raises("warnings may be errors", hbvib.StoppedEarly, solve, model, max_points=5)
check("which carry the branch", len(error.branch) == 5)
single = model.forced_response(HZ * 208, response_dof=0, at=HZ * 208)
close("a single frequency", single.omega, [HZ * 208], 1e-15)
close("wanted solutions are those of the curve", single.at(0).amplitude, single.amplitude, 1e-12)
check(
    "a small law by names and numbers alike",
    oscillator().add_contact(hbvib.ContactKind.CUBIC, [0], cubic=1)
    == oscillator().add_contact("CUBIC", 0, cubic=1)
    == 1,
)

# Run-ups, missions and Campbell diagrams say which of their arguments is no model or no mode.
slider = hbvib.Model(mass=1, stiffness=1, damping=0.02)
slider.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
slider.add_force(0, 0.12)
mode = slider.nonlinear_mode((-2, 0.8), harmonics=1)
raises("a run-up of nothing", TypeError, mode.run_up, None, (0.8, 1.3), 1e-3, words="model is of type NoneType, needs a Model")
raises("a mission of nothing", TypeError, mode.mission, None, [0, 1], [1, 2], words="needs a Model")
raises("a pair", ValueError, hbvib.campbell_response, [(mode, slider)], words="resonances[0] is not (mode, model, engine order)")
raises("a swapped pair", TypeError, hbvib.campbell_response, [(slider, mode, 2)], words="resonances[0][0] is of type Model, needs a Branch")
raises("no list", TypeError, hbvib.campbell_response, 5, words="needs a list")
raises("a standing run-up", hbvib.ArgumentError, mode.run_up, slider, (0.8, 0.8), 1e-3, words="omega_start = omega_stop = 0.8")
check("a number is one step of a history", slider.static_history(factors=5).motion.shape == (1, 1))

finish(119)
