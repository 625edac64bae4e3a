"""A model that changed since its branch was solved is refused, with the part that changed; the contents of the model count, so
that a change that was undone, a clone and a model from a pickle give the same numbers as before."""

import pickle

import numpy as np

from common import check, finish, hbvib, raises

K = np.array([[2.0, -1.0], [-1.0, 2.0]])
TURNING = np.array([[0.0, 1.0], [-1.0, 0.0]])


def filled(model):
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, 0.3)
    model.add_force(1, 0.1j)
    return model


def plain():
    return filled(hbvib.Model(mass=np.eye(2), stiffness=K, rayleigh=(0.01, 0.02)))


def rotating():
    model = plain()
    model.set_matrix("gyroscopic", 0.1 * TURNING)
    model.set_matrix("stiffness_speed2", 0.1 * np.eye(2))
    model.set_speed(0.4)
    return model


def wheel():
    model = hbvib.Model.cyclic(
        sectors=6, engine_order=2, mass=np.eye(2), stiffness=K + np.eye(2), coupling=dict(stiffness=-0.3 * np.eye(2)),
        rayleigh=(0.01, 0.02)
    )
    return filled(model)


def growing():
    """Grows by itself until friction holds it."""
    return filled(hbvib.Model(mass=np.eye(2), stiffness=K, damping=-0.02 * np.eye(2)))


def add_forces(model, factor=1.0):
    model.clear_forces()
    for dof, force in ((1, 0.1j), (0, 0.3)):  # in another order than at first
        model.add_force(dof, factor * force)


def add_constant_force(model):
    model.add_force(0, 0.05, harmonic=0)


# A change, how it is undone (None where nothing undoes it), and the part that the refusal names.
CHANGES = {
    "a force more": (lambda m: m.add_force(0, 0.3), add_forces, "forces"),
    "other forces": (lambda m: add_forces(m, 1.0 + 1e-15), add_forces, "forces"),
    "a force in harmonic 3": (lambda m: m.add_force(0, 0.3, harmonic=3), add_forces, "forces"),
    "no forces": (lambda m: m.clear_forces(), add_forces, "forces"),
    "an unbalance": (lambda m: m.add_unbalance(0, 1, 0.1), add_forces, "forces"),
    "a constant force": (add_constant_force, add_forces, "constant forces"),
    "preload": (lambda m: m.set_preload(0, 1.5), lambda m: m.set_preload(0, 1.0), "contacts"),
    "preload with the speed": (lambda m: m.set_preload(0, 1.0, 0.1), lambda m: m.set_preload(0, 1.0), "contacts"),
    "a contact more": (lambda m: m.add_contact("cubic", 1, cubic=1.0), None, "contacts"),
    "springs": (lambda m: m.add_springs([1], [-1], [0.5]), None, "springs"),
    "mass": (lambda m: m.set_matrix("mass", 2 * np.eye(2)), lambda m: m.set_matrix("mass", np.eye(2)), "matrices"),
    "stiffness": (lambda m: m.set_matrix("stiffness", 1.5 * K), lambda m: m.set_matrix("stiffness", K), "matrices"),
    "Rayleigh damping": (lambda m: m.set_rayleigh(0.02, 0.02), lambda m: m.set_rayleigh(0.01, 0.02), "damping"),
    "loss factor": (lambda m: m.set_loss_factor(0.01), lambda m: m.set_loss_factor(0.0), "damping"),
    "damping": (lambda m: m.set_matrix("damping", 0.1 * K), lambda m: m.set_matrix("damping", 0 * K), "damping"),
    "structural damping": (lambda m: m.set_matrix("structural", 0.1 * K), lambda m: m.set_matrix("structural", 0 * K), "damping"),
    "modal damping": (lambda m: m.set_modal_damping([0.01]), lambda m: m.set_modal_damping([]), "damping"),
    "fixed degree of freedom": (lambda m: m.fix([1]), None, "degrees of freedom"),
    "speed": (lambda m: m.set_speed(0.5), lambda m: m.set_speed(0.0), "speed"),
    "speed with the frequency": (lambda m: m.set_speed(per_omega=0.5), lambda m: m.set_speed(0.0), "speed"),
    "gyroscopic matrix": (lambda m: m.set_matrix("gyroscopic", TURNING), lambda m: m.set_matrix("gyroscopic", 0 * TURNING), "matrices"),
    "stiffness at speed": (lambda m: m.set_matrix("stiffness_speed2", K), lambda m: m.set_matrix("stiffness_speed2", 0 * K), "matrices"),
}
OF_ROTATION = {
    "speed": (lambda m: m.set_speed(0.5), lambda m: m.set_speed(0.4), "speed"),
    "no speed": (lambda m: m.set_speed(0.0), lambda m: m.set_speed(0.4), "speed"),
    "stiffness at speed": (
        lambda m: m.set_matrix("stiffness_speed2", K), lambda m: m.set_matrix("stiffness_speed2", 0.1 * np.eye(2)), "matrices"),
}
NEXT = -0.3 * np.eye(2)
OF_WHEELS = {
    "wave": (lambda m: m.set_wave(1), lambda m: m.set_wave(2), "wave"),
    "the other sense of the wave": (lambda m: m.set_wave(-2), lambda m: m.set_wave(2), "wave"),
    "coupling": (lambda m: m.set_coupling("stiffness", 1.1 * NEXT), lambda m: m.set_coupling("stiffness", NEXT), "matrices"),
    "coupling to the previous": (lambda m: m.set_coupling_previous("stiffness", 1.1 * NEXT), None, "matrices"),
    "aerodynamic forces": (lambda m: m.set_aero([0], [[[0.01]]], [1]), lambda m: m.set_aero([], np.zeros((0, 0, 0)), []), "damping"),
}
# What counts for nothing in the motion of a mode, and in a synthesis, which has forces and damping of its own.
OF_FORCES = {name for name, (_, _, part) in CHANGES.items() if part == "forces"}
OF_DAMPING = {name for name, (_, _, part) in {**CHANGES, **OF_WHEELS}.items() if part == "damping"}


def bits(*numbers):
    return tuple(np.asarray(number).tobytes() for number in numbers)


def verified(model, branch, point):
    found = model.verify(branch, point)
    return bits(found.harmonics, found.errors, found.info.distance, found.info.same_solution)


def multipliers(model, branch, point):
    found = model.floquet(branch, point)
    return bits(found.multipliers, found.radius)


MU, FORCE, MASS = hbvib.Parameter("mu"), hbvib.Parameter("force"), hbvib.Parameter("mass", scaling="factor")


def derivatives(of, *parameters):
    return lambda model, branch, point: bits(model.sensitivity(branch, point, parameters, of))


def synthesis(model, branch, _):
    return bits(*branch.synthesis(model))


def synthesised_peaks(model, branch, _):
    return bits(*branch.synthesis_peaks(model))


RESPONSE = dict(verify=verified, floquet=multipliers, sensitivity=derivatives("amplitude", MU, FORCE, MASS))
MODE = dict(sensitivity=derivatives("mode_damping", MU, MASS), synthesis=synthesis, synthesis_peaks=synthesised_peaks)


def answer(function, *arguments):
    """The bits of an answer, or the sentence of a refusal."""
    try:
        return function(*arguments)
    except hbvib.Error as error:
        return str(error)


def examine(title, made, branch, point, calls, changes, free=lambda call, change: False):
    """Every call with a branch of `made()`: the same model in three ways, and after each change."""
    for call, function in calls.items():
        model = made()
        wanted = function(model, branch, point)
        for way, same in (("a clone", model.clone()), ("a pickled model", pickle.loads(pickle.dumps(model)))):
            found = answer(function, same, branch, point)
            check(f"{title}: {call} takes {way}", found == wanted, found)
        for name, (change, undo, part) in changes.items():
            other = model.clone()
            change(other)
            claim = f"{title}: {call} after another {name}"
            if free(call, name):
                found = answer(function, other, branch, point)
                if not call.startswith("synthesis") or name not in OF_FORCES:
                    check(f"{claim} answers as before", found == wanted, found)
                elif name == "no forces":
                    check(f"{claim} is refused", found == "the model has no force in the fundamental", found)
                else:
                    check(f"{claim} is that of these forces", not isinstance(found, str), found)
            else:
                words = f"other {part} of the model" if call.startswith("synthesis") and part == "degrees of freedom" else f"other {part} than"
                raises(f"{claim} is refused", hbvib.ArgumentError, function, other, branch, point, words=words)
            if undo is not None:
                undo(other)
                found = answer(function, other, branch, point)
                check(f"{claim} that was undone", found == wanted, found)
        check(f"{title}: {call} takes the model whose clones changed", function(model, branch, point) == wanted)


# Forced responses: all of the model counts. A contact more is told by the number of contacts.
COUNTED = {"a contact more": "1 contacts, the model 2, 1 and 2"}
for title, made, changes in (
    ("plain", plain, {k: v for k, v in CHANGES.items() if k not in COUNTED}),
    ("rotating", rotating, OF_ROTATION),
    ("wheel", wheel, {**OF_WHEELS, "preload": CHANGES["preload"], "springs": CHANGES["springs"], "no forces": CHANGES["no forces"]}),
):
    branch = made().forced_response((0.8, 1.6), harmonics=5, response_dof=0)
    examine(title, made, branch, int(np.argmax(branch.amplitude)), RESPONSE, changes)

branch = plain().forced_response((0.8, 1.6), harmonics=5)
for call, function in RESPONSE.items():
    other = plain()
    other.add_contact("cubic", 1, cubic=1.0)
    raises(f"{call} after a contact more", hbvib.ArgumentError, function, other, branch, 0, words="1 contacts, the model 2, 1 and 2")
    other = plain()
    other.set_preload(0, float("inf"))
    raises(f"{call} after an infinite preload", hbvib.ArgumentError, function, other, branch, 0, words="other contacts than")
    raises(f"{call} of a wheel", hbvib.ArgumentError, function, wheel(), branch, 0, words="6 and 1: it is another one")
    larger = filled(hbvib.Model(mass=np.eye(3), stiffness=np.eye(3)))
    words = "length = 18" if call == "verify" else "2 degrees of freedom"  # the arrays of verify do not fit
    raises(f"{call} of more degrees of freedom", hbvib.ArgumentError, function, larger, branch, 0, words=words)

# Modes: vibrating forces count for nothing, and the wave only where the mode has that of the model.
mode_changes = {k: v for k, v in CHANGES.items() if k not in COUNTED}
for title, made, options, changes in (
    ("mode", plain, {}, mode_changes),
    ("wave of the model", wheel, {}, OF_WHEELS),
    ("wave of its own", wheel, dict(diameter=2), OF_WHEELS),
):
    branch = made().nonlinear_mode((-1, 1), harmonics=5, **options)
    calls = dict(MODE) if title == "mode" else dict(sensitivity=MODE["sensitivity"])

    def free(call, change, own=bool(options)):
        in_synthesis = call.startswith("synthesis")
        return change in OF_FORCES or (in_synthesis and change in OF_DAMPING) or (own and CHANGES.get(change,
            OF_WHEELS.get(change))[2] == "wave")

    examine(title, made, branch, len(branch) // 2, calls, changes, free)

# Limit cycles: multipliers of a mode.
branch = growing().nonlinear_mode((-1, 1), harmonics=5, mode_index=0)
cycle = int(branch.limit_cycles().point[0])
some = {k: CHANGES[k] for k in ("a force more", "a constant force", "preload", "springs", "mass", "modal damping", "speed")}
examine("limit cycle", growing, branch, cycle, dict(floquet=multipliers), some, lambda _, change: change in OF_FORCES)

# A damping that the synthesis was asked for counts.
branch = plain().nonlinear_mode((-1, 1), harmonics=5)
other = plain()
other.set_rayleigh(0.05, 0.02)
check("the damping of a model counts where it is asked for",
      bits(*branch.synthesis(other, model_damping=1)) != bits(*branch.synthesis(plain(), model_damping=1)))


# Laws of the caller: the same callable is the same law.
def cubic(call):
    call.f[:] = 0.5 * call.u**3
    call.df_du[:, 0, 0] = 1.5 * call.u[:, 0] ** 2


def twin(call):
    cubic(call)


own = hbvib.Model(mass=1, stiffness=1, damping=0.1)
clone_before = own.clone()
own.add_user_force([0], cubic, is_odd=True)
own.add_force(0, 0.2)
branch = own.forced_response((0.8, 1.2), harmonics=3)
wanted = derivatives("amplitude", FORCE)(own, branch, 0)
check("a clone has the law of the caller", derivatives("amplitude", FORCE)(own.clone(), branch, 0) == wanted)
clone_before.add_user_force([0], twin, is_odd=True)
clone_before.add_force(0, 0.2)
raises("another law of the caller is another contact", hbvib.ArgumentError, derivatives("amplitude", FORCE), clone_before, branch, 0,
       words="other contacts than")

# Responses over a parameter are of no one model.
branch = plain().parameter_response(hbvib.Parameter("preload"), (0.5, 1.0), omega=1.2, harmonics=5)
raises("a response over a parameter", hbvib.Error, verified, plain(), branch, 0)

finish(300)
