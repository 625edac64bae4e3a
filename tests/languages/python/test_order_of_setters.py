"""The order in which a model is described does not matter: each of 3,000 random orders of the setters of random models gives the same
response, or a refusal that names what has to come first; never another response."""

import warnings
from collections import Counter

import numpy as np

from common import check, finish, hbvib, raises

warnings.simplefilter("ignore", hbvib.StoppedEarly)
rng = np.random.default_rng(42)


def definite(n):
    a = rng.normal(size=(n, n))
    return np.eye(n) + 0.3 * (a @ a.T) / n


def symmetric(n):
    a = rng.normal(size=(n, n))
    return 0.5 * (a + a.T)


def skew(n):
    a = rng.normal(size=(n, n))
    return 0.1 * (a - a.T)


def setter(name, *arguments, **keywords):
    return lambda model, _: getattr(model, name)(*arguments, **keywords)


def slider(number, dof, offset=0):
    """A contact that notes its number, by which another setter finds it."""
    mu, preload, kt = 0.2 + 0.2 * rng.random(), 0.5 + rng.random(), 0.5 + rng.random()
    other = dof if offset else -1

    def add(model, numbers):
        numbers[number] = model.add_contact("jenkins", dof, other, kt=kt, mu=mu, preload=preload, sector_offset=offset)

    return add


def load_of(number, preload, per_speed2):
    """The preload of that contact: a number that does not exist where it was not added yet."""
    return lambda model, numbers: model.set_preload(numbers.get(number, model.contacts + 7), preload, per_speed2)


def common_setters(n, offsets):
    """Damping, springs, contacts and forces: (name, setter) pairs, each present or not."""
    dof, other = int(rng.integers(n)), int(rng.integers(n))
    offset = int(rng.choice(offsets))
    far = int((other + 1) % n) if offset == 0 else other
    always = [("slider", slider("slider", dof)), ("force", setter("add_force", other, 0.3 + 0.1j))]
    sometimes = [
        ("rayleigh", setter("set_rayleigh", 0.02, 0.03)),
        ("loss factor", setter("set_loss_factor", 0.03)),
        ("damping", setter("set_matrix", "damping", 0.03 * definite(n))),
        ("structural", setter("set_matrix", "structural", 0.03 * definite(n))),
        ("spring", setter("add_springs", [dof], [-1], [0.7])),
        ("soft springs", setter("add_springs", [other, dof], [far, -1], [0.3, 0.1], [offset, 0])),
        ("second slider", slider("second slider", other, offset)),
        ("cubic spring", setter("add_contact", "cubic", dof, cubic=0.1, kt=0.1)),
        ("stop", setter("add_contact", "unilateral", other, kn=0.3, gap=0.2)),
        ("table", setter("add_table", other, displacement=[-1.0, 0.0, 1.0], force=[-0.2, 0.0, 0.1])),
        ("polynomial", setter("add_spring_damper", dof, spring=[0.1, 0.0, 0.05], damper=[0.05])),
        ("second force", setter("add_force", dof, 0.2)),
        ("force of harmonic 3", setter("add_force", dof, 0.05j, harmonic=3)),
        ("constant force", setter("add_force", other, 0.1, harmonic=0)),
        ("load", load_of("slider", 0.8, 0.2)),
        ("fix", setter("fix", [int((dof + 1) % n)])),
        ("modal damping", setter("set_modal_damping", [0.01, 0.02])),
    ]
    gone = {"fix": 0.3, "modal damping": 0.5, "load": 0.3}
    return always + [pair for pair in sometimes if rng.random() < gone.get(pair[0], 0.4)]


def turning(n):
    """A speed and what it acts on."""
    found = []
    if rng.random() < 0.5:
        found.append(("gyroscopic", setter("set_matrix", "gyroscopic", skew(n))))
    if rng.random() < 0.5:
        found.append(("stiffness at speed", setter("set_matrix", "stiffness_speed2", 0.1 * definite(n))))
    if rng.random() < 0.5:
        found.append(("speed", setter("set_speed", 0.6)))
    elif rng.random() < 0.7:
        found.append(("speed with the frequency", setter("set_speed", per_omega=0.5)))
        found.append(("unbalance", setter("add_unbalance", 0, 1, 0.1, 0.3)))
    return found


def plain_model():
    n = int(rng.integers(2, 5))
    stiffness = definite(n)
    part = "full"
    if rng.random() < 0.2:
        stiffness, part = stiffness * (1 + 0.02j), "symmetric"
    setters = [("mass", setter("set_matrix", "mass", definite(n))), ("stiffness", setter("set_matrix", "stiffness", stiffness, part))]
    return (lambda: hbvib.Model(n)), setters + common_setters(n, [0]) + turning(n)


def wheel():
    n, sectors = int(rng.integers(2, 4)), int(rng.integers(3, 9))
    setters = [
        ("mass", setter("set_matrix", "mass", definite(n))),
        ("stiffness", setter("set_matrix", "stiffness", definite(n) + 0.5 * np.eye(n))),
        ("coupling", setter("set_coupling", "stiffness", -0.2 * np.eye(n) + 0.05 * rng.normal(size=(n, n)))),
        ("wave", setter("set_wave", int(rng.integers(-3, 4)))),
    ]
    sometimes = [
        ("coupling to the previous", setter("set_coupling_previous", "stiffness", -0.2 * np.eye(n) + 0.05 * rng.normal(size=(n, n)))),
        ("coupling of the mass", setter("set_coupling", "mass", 0.05 * symmetric(n))),
        ("coupling of the damping", setter("set_coupling", "damping", 0.01 * rng.normal(size=(n, n)))),
        ("damping to the previous", setter("set_coupling_previous", "damping", 0.01 * rng.normal(size=(n, n)))),
        ("gyroscopic coupling", setter("set_coupling", "gyroscopic", 0.05 * rng.normal(size=(n, n)))),
        ("aerodynamic forces", setter("set_aero", [0, 1], 0.02 * rng.normal(size=(2, 2, 2)), [0, 1])),
        ("aerodynamic damping", setter("set_aero", [0], 0.02 * rng.normal(size=(1, 1, 1)), [-1], "velocity")),
    ]
    setters += [pair for pair in sometimes if rng.random() < 0.4]
    return (lambda: hbvib.Model.cyclic(n, sectors=sectors)), setters + common_setters(n, [0, 1]) + turning(n)


def wheel_of_waves():
    """Matrices of each nodal diameter, some of them with blocks of sectors as well, which no order may take."""
    n, sectors = 2, int(rng.integers(3, 7))
    setters = [("wave", setter("set_wave", int(rng.integers(0, 4))))]
    for diameter in range(sectors // 2 + 1):
        setters.append((f"mass {diameter}", setter("set_diameter", "mass", diameter, definite(n))))
        setters.append((f"stiffness {diameter}", setter("set_diameter", "stiffness", diameter, definite(n) + diameter * np.eye(n))))
    both = rng.random()
    if both < 0.2:
        setters.append(("coupling to the previous", setter("set_coupling_previous", "stiffness", -0.2 * np.eye(n))))
    elif both < 0.3:
        setters.append(("coupling", setter("set_coupling", "stiffness", -0.2 * np.eye(n))))
    elif both < 0.4:
        setters.append(("stiffness", setter("set_matrix", "stiffness", definite(n))))
    kept = [pair for pair in common_setters(n, [0, 1]) if pair[0] not in ("damping", "structural")]
    return (lambda: hbvib.Model.cyclic(n, sectors=sectors)), setters + kept


# Setters that may be refused, by the words of the refusal: what comes first is named in it.
MAY_REFUSE = {
    "load": ("id = ",),
    "modal damping": ("mass matrix", "no matrices were set", "stiffness", "has no mode"),
    "mass": ("modal damping", "nodal diameter"),
    "stiffness": ("modal damping", "nodal diameter"),
    "coupling": ("modal damping", "nodal diameter"),
    "coupling to the previous": ("modal damping", "nodal diameter"),
    "coupling of the mass": ("modal damping",),
    "spring": ("modal damping", "fixed"),
    "soft springs": ("modal damping", "fixed"),
    "fix": ("modal damping", "fixed"),
    "slider": ("fixed",),
    "second slider": ("fixed",),
    "cubic spring": ("fixed",),
    "stop": ("fixed",),
    "table": ("fixed",),
    "polynomial": ("fixed",),
    **{f"{kind} {diameter}": ("modal damping", "sector block") for kind in ("mass", "stiffness") for diameter in range(4)},
}
OMEGA = 0.8


def described(make, setters, order):
    """The model, or the setter that was refused with its sentence."""
    model, numbers = make(), {}
    for i in order:
        name, function = setters[i]
        try:
            function(model, numbers)
        except hbvib.Error as error:
            return None, (name, str(error))
    return model, None


def response(model):
    """The motion at one frequency, or the refusal of the solution."""
    try:
        return model.forced_response(OMEGA, harmonics=3, response_dof=0, tol_residual=1e-13).harmonics(0)
    except hbvib.Error as error:
        return str(error)


def same(a, b):
    if isinstance(a, str) or isinstance(b, str):
        return a == b
    return np.abs(a - b).max() <= 1e-12 * np.abs(b).max()


told, refused, solved = Counter(), 0, 0
for kind, make_one, count in (("structure", plain_model, 150), ("wheel", wheel, 100), ("wheel of waves", wheel_of_waves, 50)):
    for number in range(count):
        make, setters = make_one()
        names = [name for name, _ in setters]
        never = kind == "wheel of waves" and {"stiffness", "coupling", "coupling to the previous"} & set(names)
        orderly = sorted(range(len(setters)), key=lambda i: (names[i] in ("fix", "load"), names[i] == "modal damping"))
        model, refusal = described(make, setters, orderly)
        reference = None if model is None else response(model)
        if not never:
            check(f"{kind} {number} can be described", model is not None or refusal[0] in ("fix", "modal damping"), refusal)
        for _ in range(10):
            order = rng.permutation(len(setters))
            model, refusal = described(make, setters, order)
            if model is None:
                name, sentence = refusal
                told[name] += 1
                refused += 1
                check(f"{name} is refused by name", any(words in sentence for words in MAY_REFUSE.get(name, ())), sentence)
                continue
            solved += not isinstance(reference, str)
            check(f"{kind} {number} is refused in every order", not never, [names[i] for i in order])
            found = response(model)
            reference = found if reference is None else reference  # where the orderly one is refused
            check(f"{kind} {number}: the same response", same(found, reference), [names[i] for i in order])
check("a third of the orders gives a response", solved > 1000, solved)
check("each refusal is met", {"load", "modal damping", "fix", "spring", "coupling to the previous", "stiffness 1"} <= set(told),
      told)

# The orders of two setters that exclude each other.
for first, second in (("previous", "diameter"), ("diameter", "previous"), ("next", "diameter"), ("diameter", "next"), ("own", "diameter"),
                      ("diameter", "own")):
    model = hbvib.Model.cyclic(1, sectors=4)
    calls = dict(
        previous=lambda: model.set_coupling_previous("stiffness", [[-0.3]]), next=lambda: model.set_coupling("stiffness", [[-0.3]]),
        own=lambda: model.set_matrix("stiffness", [[2.0]]), diameter=lambda: model.set_diameter("stiffness", 1, [[3.0]]))
    calls[first]()
    raises(f"{second} after {first}", hbvib.ArgumentError, calls[second], words="stiffness was given")

# Springs after the modal damping: the ratio that was asked, or a refusal; set_matrix and fix likewise.
for name, change in (
    ("springs", lambda m: m.add_springs([0], [-1], [5.0])),
    ("stiffness", lambda m: m.set_matrix("stiffness", 4 * np.eye(2))),
    ("mass", lambda m: m.set_matrix("mass", 2 * np.eye(2))),
    ("degrees of freedom are fixed", lambda m: m.fix([0])),
):
    model = hbvib.Model(mass=np.eye(2), stiffness=np.diag([1.0, 4.0]))
    model.set_modal_damping([0.01])
    raises(f"{name} after the modal damping", hbvib.ArgumentError, change, model, words="after the modal damping was set")
    check("which stays", abs(model.damped_modes(1).damping_ratio[0] - 0.01) < 1e-12)
    model.set_modal_damping([])
    change(model)
    check(f"{name} once it was removed", abs(model.damped_modes(1).damping_ratio[0]) < 1e-12)
model = hbvib.Model(mass=1, stiffness=1)
model.add_springs([0], [-1], [5.0])
model.set_modal_damping([0.01])
check("springs first", abs(model.damped_modes(1).damping_ratio[0] - 0.01) < 1e-12)

finish(1000)
