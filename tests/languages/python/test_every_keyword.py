"""Every argument of every call in Python, perturbed alone: the model or the result changes, or the call is refused by name, or the docstring
says that it has no effect. A new argument without a claim fails here; those that are fields of structs are in test_every_field.py."""

import inspect
import warnings

import numpy as np

from common import check, finish, hbvib
from options import CHANGES, bits, hold, outcome, refused, same

warnings.simplefilter("ignore")
NAN, INF = float("nan"), float("inf")
K = 3 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1)
GYROSCOPIC = np.array([[0.0, 0.3, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.0]])


def wheel(**more):
    """Six sectors that turn."""
    model = hbvib.Model.cyclic(sectors=6, engine_order=1, mass=np.diag([1.0, 2.0, 1.5]), stiffness=K,
                               coupling=dict(stiffness=-0.3 * np.eye(3)), **more)
    model.set_matrix("gyroscopic", GYROSCOPIC)
    return model


def described(method, prepare=lambda model: None, make=wheel):
    """The bytes of a model after a setter."""
    def run(**o):
        model = make()
        prepare(model)
        getattr(model, method)(**o)
        return model.to_bytes()
    return run


def jenkins(model):
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)


def planes(model):
    for normal in (-1, 2):
        model.add_contact("friction_3d", [0, 1, normal], kt=1, kn=0 if normal < 0 else 1, mu=0.3, preload=1)


def setter(base, changed, wrong, prepare=lambda model: None, make=wheel):
    """Arguments of a setter, other values of them, and values that are refused with the words that name them."""
    return base, changed, wrong, prepare, make


SETTERS = {
    "add_force": setter(dict(dof=0, force=0.3, harmonic=1), dict(dof=1, force=0.3j, harmonic=0),
                        dict(dof=(9, "dof"), force=(NAN, "NaN"), harmonic=(-1, "harmonic"))),
    "add_unbalance": setter(dict(dof_x=0, dof_y=1, m_e=0.1, phase=0.2), dict(dof_x=2, dof_y=2, m_e=0.2, phase=0.3),
                            dict(dof_x=(9, "dof_x"), dof_y=(0, "dof_y"), m_e=(NAN, "m_e"), phase=(INF, "phase"))),
    "add_springs": setter(dict(a=[0], b=[1], stiffness=[0.5], sector_offset=[0]), dict(a=[2], b=[-1], stiffness=[0.6], sector_offset=[1]),
                          dict(a=([9], "dof_a"), b=([-2], "dof_b"), stiffness=([NAN], "stiffness"),
                               sector_offset=([0.5], "sector_offset"))),
    "add_jenkins": setter(dict(a=[0], b=[1], kt=[1.0], mu=[0.3], preload=[1.0], sector_offset=[0]),
                          dict(a=[2], b=[-1], kt=[2.0], mu=[0.4], preload=[2.0], sector_offset=[1]),
                          dict(a=([9], "dof_a"), b=([-2], "dof_b"), kt=([-1.0], "kt"), mu=([-1.0], "mu"), preload=([NAN], "preload"),
                               sector_offset=([0.5], "sector_offset"))),
    "add_iwan": setter(dict(a=0, b=1, slip_force=1.0, stiffness=1.0, chi=-0.5, beta=0.5, elements=5, sector_offset=0),
                       dict(a=2, b=-1, slip_force=1.1, stiffness=1.1, chi=-0.4, beta=0.6, elements=6, sector_offset=1),
                       dict(a=(9, "dof_a"), b=(-2, "dof_b"), slip_force=(0.0, "slip_force"), stiffness=(-1.0, "stiffness"),
                            chi=(-1.0, "chi"),
                            beta=(-1.0, "beta"), elements=(0, "elements"), sector_offset=(0.5, "sector_offset"))),
    "add_table": setter(dict(a=0, b=1, displacement=[-1.0, 0.0, 1.0], force=[-1.0, 0.0, 0.5], sector_offset=0),
                        dict(a=2, b=-1, displacement=[-2.0, 0.0, 1.0], force=[-1.0, 0.0, 0.6], sector_offset=1),
                        dict(a=(9, "dof_a"), b=(-2, "dof_b"), displacement=([0.0, 0.0, 1.0], "displacement"),
                             force=([0.0, NAN, 1.0], "force"),
                             sector_offset=(0.5, "sector_offset"))),
    "add_spring_damper": setter(dict(a=0, b=1, spring=[1.0], damper=[0.1], sector_offset=0),
                                dict(a=2, b=-1, spring=[2.0], damper=[0.2], sector_offset=1),
                                dict(a=(9, "dof_a"), b=(-2, "dof_b"), spring=([NAN], "spring"), damper=([INF], "damper"),
                                     sector_offset=(0.5, "sector_offset"))),
    "add_polynomial": setter(dict(dofs=[0, 1], direction=[0], coefficient=[0.5], x_powers=[[2, 0]], v_powers=[[0, 1]]),
                             dict(dofs=[0, 2], direction=[1], coefficient=[0.6], x_powers=[[1, 0]], v_powers=[[0, 2]]),
                             dict(dofs=([0, 9], "dofs"), direction=([2], "direction"), coefficient=([NAN], "coefficient"),
                                  x_powers=([[-1, 0]], "x_powers"),
                                  v_powers=([[0, 1, 0]], "v_powers"))),
    "add_stiffness_tensors": setter(dict(dofs=[0], quadratic=[[[0.1]]], cubic=[[[[0.2]]]]),
                                    dict(dofs=[1], quadratic=[[[0.3]]], cubic=[[[[0.4]]]]),
                                    dict(dofs=([9], "dofs"), quadratic=([[[NAN]]], "quadratic"), cubic=([[[[INF]]]], "cubic"))),
    "add_centrifugal": setter(dict(dof=0, mass_radius=0.5), dict(dof=1, mass_radius=0.6), dict(dof=(9, "dof"), mass_radius=(NAN, "NaN"))),
    "set_preload": setter(dict(contact=0, preload=2.0, per_speed2=0.1), dict(preload=3.0, per_speed2=0.2),
                          dict(contact=(1, "id"), preload=(NAN, "preload"), per_speed2=(NAN, "per_speed2")), jenkins),
    "set_slider": setter(dict(contact=0, place=0.2, direction=0), dict(place=0.3, contact=1, direction=1),
                         dict(contact=(2, "id"), place=(NAN, "place"), direction=(2, "direction")), planes),
    "set_sliders": setter(dict(places=[[0.1, 0.2], [0.3, 0.4]]), dict(places=[[0.1, 0.2], [0.3, 0.5]]),
                          dict(places=([[0.1, 0.2]], "places")), planes),
    "set_matrix": setter(dict(which="damping", matrix=0.1 * np.tri(3), part="lower"),
                         dict(which="structural", matrix=0.2 * np.tri(3), part="upper"),
                         dict(which=("stiff", "stiffness"), matrix=(np.eye(2), "damping"), part=("half", "lower"))),
    "fix": setter(dict(dofs=[0]), dict(dofs=[1]), dict(dofs=([9], "dofs"))),
    "set_rayleigh": setter(dict(alpha_mass=0.1, beta_stiffness=0.2), dict(alpha_mass=0.2, beta_stiffness=0.3),
                           dict(alpha_mass=(NAN, "alpha"), beta_stiffness=(NAN, "beta"))),
    "set_loss_factor": setter(dict(loss_factor=0.1), dict(loss_factor=0.2), dict(loss_factor=(NAN, "loss_factor"))),
    "set_modal_damping": setter(dict(ratios=[0.01]), dict(ratios=[0.02]), dict(ratios=([0.1] * 4, "ratios[3]"))),
    "set_speed": setter(dict(speed=0.5), dict(speed=0.6), dict(speed=(NAN, "speed"), per_omega=(0.5, "either"))),
    "set_wave": setter(dict(engine_order=2), dict(engine_order=-2), dict(engine_order=(0.5, "engine_order"))),
    "set_coupling": setter(dict(which="damping", to_next=0.1 * np.eye(3)), dict(which="mass", to_next=0.2 * np.eye(3)),
                           dict(which=("stiff", "stiffness"), to_next=(np.eye(2), "damping"))),
    "set_coupling_previous": setter(dict(which="stiffness", to_previous=0.1 * np.eye(3)),
                                    dict(which="damping", to_previous=0.2 * np.eye(3)),
                                    dict(which=("mass", "mass has a symmetry"), to_previous=(np.eye(2), "stiffness"))),
    "set_diameter": setter(dict(which="damping", diameter=1, matrix=0.1 * np.tri(3), part="lower"),
                           dict(which="structural", diameter=2, matrix=0.2 * np.tri(3), part="upper"),
                           dict(which=("stiff", "stiffness"), diameter=(0.5, "diameter"), matrix=(np.eye(2), "damping"),
                                part=("half", "lower"))),
    "set_aero": setter(dict(dofs=[0], coefficients=[[[0.1]]], offsets=[0], form="displacement"),
                       dict(dofs=[1], coefficients=[[[0.2]]], offsets=[1], form="velocity"),
                       dict(dofs=([9], "dofs"), coefficients=([[[NAN]]], "coefficients"), offsets=([0.5], "offsets"),
                            form=("acceleration", "velocity"))),
}
for method, (base, changed, wrong, prepare, make) in SETTERS.items():
    arguments = set(inspect.signature(getattr(hbvib.Model, method)).parameters) - {"self"}
    check(f"{method}: every argument has a wrong value", arguments == set(wrong), arguments ^ set(wrong))
    check(f"{method}: and a right one", set(base) == set(changed) or method in ("set_preload", "set_speed"), set(base) ^ set(changed))
    run = described(method, prepare, make)
    reference = outcome(run, **base)
    for name, value in changed.items():
        hold(CHANGES, f"{method}({name})", run, reference, **{**base, name: value})
    for name, (value, words) in wrong.items():
        hold(refused(words), f"{method}({name} = {value})", run, reference, **{**base, name: value})
hold(CHANGES, "set_speed(per_omega)", described("set_speed"), outcome(described("set_speed"), speed=0.5), per_omega=0.5)

# Analyses whose arguments are not fields of structs.
damper = hbvib.Model(mass=np.diag([1, 0.01, 0.01]), damping=np.diag([0.04, 0.004, 0.004]), stiffness=np.diag([1, 1e-3, 1e-3]))
damper.add_contact("friction_2d", [1, 2, -1], [-1, -1, -1], kt=1, kn=1.5, mu=0.6, normal=(1, -1, 0), tangent=(1, 1, 0))
damper.add_contact("friction_2d", [1, 2, -1], [0, -1, -1], kt=1, kn=1.5, mu=0.15, normal=(-1, -1, 0), tangent=(-1, 1, 0))
damper.add_force(2, 1, harmonic=0)
damper.add_force(0, 0.02)
damped, free_damped = (damper.forced_response(omega, harmonics=3) for omega in ((1.23, 1.27), (1.235, 1.265)))
top = int(damped.peaks().point[0])
swinging = damper.nonlinear_mode((-0.6, -0.5), harmonics=5, tolerance=0)

spring = hbvib.Model(mass=1, stiffness=1, damping=0.1)
spring.add_spring_damper(0, spring=[0, 0.05, 0.1])
spring.add_force(0, 0.18)
bent = spring.forced_response((0.9, 1.3), harmonics=5, tolerance=0, at=[1.1017664364])
_, between, low = (int(number) for number in bent.at(0).point)

pressed = hbvib.Model(mass=1, stiffness=1)
pressed.add_contact("jenkins", 0, kt=1, mu=0.5, preload=0.1)
pressed.set_preload(0, 0.1, per_speed2=0.1)
pressed.set_speed(1.0)
pressed.add_force(0, 1.0, harmonic=0)

worn = hbvib.Model(mass=1, stiffness=1, damping=0.05)
worn.add_contact("jenkins", 0, kt=1, mu=0.3, preload=0.6)
worn.add_force(0, 0.3)


def lived(life):
    return life.loads, life.events.cycles, life.steps


def ends_of(**o):
    found = damper.band(**o)
    return np.array([found.lower.value, found.upper.value])


turning = wheel(rayleigh=(0.02, 0.02))
jenkins(turning)
turning.add_contact("unilateral", 1, kn=0.5, gap=0.1)
turning.add_force(0, 0.3)
turning.add_force(1, -1.5, harmonic=0)
turning.set_speed(0.7)
still = turning.clone()
still.set_speed(0.0)
branch = still.forced_response((1.0, 1.8), harmonics=5, at=[1.3, 1.5], response_dof=0)
seen = still.forced_response((1.0, 1.8), harmonics=5, responses=[hbvib.Response(0), hbvib.Response(1, "rms")])
sure = still.forced_response(1.3, responses=[0, 1], tolerance=1e-2)
crest = int(np.argmax(branch.amplitude))  # where contacts slip
X = branch.harmonics(3)[:4]
friction = dict(kt=1.0, kn=1.0, mu=0.3, preload=0.5)
Y = np.array([[0.0, 1.0, 0.1], [-0.2, 0.5j, 0.2]])


def whole(result):
    return [bits(*[np.asarray(part) for part in ([result] if isinstance(result, np.ndarray) else result) if part is not None])]


def analysis(function, **base):
    return function, (lambda **o: whole(function(**{**base, **o}))), set(base)


ANALYSES = {
    "linear_modes": (*analysis(still.linear_modes, count=2, diameter=1, contacts="stuck"), {
        "count": [(CHANGES, 3), (refused("count"), 99), (refused("count"), 1.5)], "diameter": [(CHANGES, 2), (refused("diameter"), 0.5)],
        "contacts": [(CHANGES, "free"), (CHANGES, "static"), (refused("stuck"), "loose")]}),
    "damped_modes": (*analysis(turning.damped_modes, count=2, diameter=1, contacts="stuck"), {
        "count": [(CHANGES, 3), (refused("count"), 99)], "diameter": [(CHANGES, 2), (refused("diameter"), 0.5)],
        "contacts": [(CHANGES, "free"), (CHANGES, "static"), (refused("stuck"), "loose")]}),
    "campbell": (*analysis(lambda **o: (lambda d: [d.omega, d.damping_ratio, d.direction, *d.crossings])(turning.campbell(**o)),
                           speeds=[0.0, 1.0, 2.0], count=3, engine_orders=(1, 2), diameter=1, contacts="stuck"), {
        "speeds": [(CHANGES, [0.0, 1.0, 2.5]), (refused("speeds"), [0.0, NAN])], "count": [(CHANGES, 2), (refused("count"), 99)],
        "engine_orders": [(CHANGES, (3, 2)), (refused("engine_order"), (0.5,))], "diameter": [(CHANGES, 2), (refused("diameter"), 0.5)],
        "contacts": [(CHANGES, "free"), (refused("stuck"), "loose")]}),
    "interference": (*analysis(lambda **o: (lambda d: [d.diameters, d.omega, d.damping_ratio, d.direction])(turning.interference(**o)),
                               count=3, contacts="stuck"), {
        "count": [(CHANGES, 2), (refused("count"), 99)], "contacts": [(CHANGES, "free"), (refused("stuck"), "loose")]}),
    "forced_residual": (*analysis(still.forced_residual, omega=1.3, x=X, jacobian=False, d_omega=False, samples=0), {
        "omega": [(CHANGES, 1.4), (refused("omega"), -1.0), (refused("omega"), NAN)], "x": [(CHANGES, 1.1 * X), (refused("x"), X[:, :2])],
        "jacobian": [(CHANGES, True)],
        "d_omega": [(CHANGES, True)], "samples": [(CHANGES, 64), (refused("samples"), 3)]}),
    "evaluate_contact": (*analysis(hbvib.evaluate_contact, kind="friction_2d", motion=Y, omega=1.0, samples=0, jacobian=False,
                                   **friction), {
        "kind": [(refused("kn"), "jenkins"), (refused("jenkins"), "glue")], "motion": [(CHANGES, 1.2 * Y), (refused("motion"), Y[:1])],
        "omega": [(same("it has an effect on laws that depend on velocities alone"), 2.0), (refused("omega"), -1.0)],
        "samples": [(same("No effect on friction_2d, friction_3d and cubic, which are always exact."), 64), (refused("samples"), 3)],
        "jacobian": [(CHANGES, True)], "kt": [(CHANGES, 2.0)], "kn": [(CHANGES, 2.0)], "mu": [(CHANGES, 0.4)],
        "preload": [(CHANGES, 0.6)]}),
    "sensitivity": (*analysis(still.sensitivity, branch=seen, point=crest, parameters=[hbvib.Parameter("mu")], of="amplitude",
                              response=0), {
        "branch": [], "point": [(CHANGES, crest + 1), (refused("point"), 10**6)], "parameters": [(CHANGES, [hbvib.Parameter("kt")])],
        "of": [(refused("peak"), "peak_omega"), (refused("amplitude"), "speed")],
        "response": [(CHANGES, 1), (refused("response 7"), 7)]}),
    "response_sensitivity": (*analysis(still.response_sensitivity, branch=seen, point=crest, parameters=[hbvib.Parameter("mu")], response=0), {
        "branch": [], "point": [(CHANGES, crest + 1), (refused("point"), 10**6)], "parameters": [(CHANGES, [hbvib.Parameter("kt")])],
        "response": [(CHANGES, 1), (refused("dofs"), 9)]}),
    "smallest_kick": (*analysis(lambda **o: np.array([spring.smallest_kick(**o).impulse]), branch=bent, point=low, saddle=between,
                                saddle_branch=bent, dof=0, phases=2), {
        "branch": [(refused("model"), branch)], "point": [(refused("point"), 10**6)], "saddle": [(refused("saddle"), 10**6)],
        "saddle_branch": [(refused("model"), branch)], "dof": [(refused("dof"), 9)],
        "phases": [(CHANGES, 3), (refused("phases"), 0)]}),
    "harmonics": (*analysis(branch.harmonics, point=3, first_dof=0, n_dof=2), {
        "point": [(CHANGES, 4), (refused("point"), -1)], "first_dof": [(CHANGES, 1), (refused("first_dof"), 9)],
        "n_dof": [(CHANGES, 3), (refused("n_dof"), 9)]}),
    "time_history": (*analysis(branch.time_history, point=3, dof=0, n=16), {
        "point": [(CHANGES, 4), (refused("point"), -1)], "dof": [(CHANGES, 1), (refused("dof"), 9)],
        "n": [(CHANGES, 17), (refused("n = 0"), 0)]}),
    "loop": (*analysis(branch.loop, point=3, contact=0, direction=0, n=16), {
        "point": [(CHANGES, 4), (refused("point"), -1)], "contact": [(CHANGES, 1), (refused("contact"), 9)],
        "direction": [(refused("direction"), 1)], "n": [(CHANGES, 17), (refused("n = 0"), 0)]}),
    "summary": (*analysis(branch.summary, point=3, contact=0),
                {"point": [(CHANGES, 4), (refused("point"), -1)], "contact": [(CHANGES, 1), (refused("contact"), 9)]}),
    "freedom": (*analysis(lambda **o: np.array([one.place for one in damper.freedom(**o)]), branch=damped, point=0), {
        "branch": [(CHANGES, free_damped), (refused("model"), branch)], "point": [(CHANGES, 1), (refused("point"), -1)]}),
    "band": (*analysis(ends_of, branch=damped, point=top, of="amplitude", contacts=[0], starts=1), {
        "branch": [(CHANGES, free_damped), (refused("model"), branch)], "point": [(CHANGES, 1), (refused("point"), -1)],
        "of": [(CHANGES, "peak_omega"), (refused("peak_omega"), "mean")], "contacts": [(CHANGES, [1]), (refused("contacts"), [2])],
        "starts": [(same("one it has no effect"), 2), (refused("starts"), 0)]}),
    "band_curve": (*analysis(lambda **o: np.array(damper.band_curve(**o)[:3]), branch=damped, points=[0], contacts=[0], starts=1), {
        "branch": [(CHANGES, free_damped), (refused("model"), branch)], "points": [(CHANGES, [1]), (refused("point"), [-1])],
        "contacts": [(CHANGES, [1]), (refused("contacts"), [2])], "starts": [(refused("starts"), 0)]}),
    "mode_band": (*analysis(lambda **o: np.array([damper.mode_band(**o).lower.value]), branch=swinging, point=0, of="damping", contacts=[0],
                            diameter=None), {
        "branch": [(refused("nonlinear mode"), damped)], "point": [(refused("point"), -1)],
        "of": [(CHANGES, "omega"), (refused("omega"), "mean")], "contacts": [(CHANGES, [1]), (refused("contacts"), [2])],
        "diameter": [(refused("diameter"), 3)]}),
    "static_history": (*analysis(lambda **o: pressed.static_history(**o).forces, factors=[1.0, 1.0], speeds=[1.0, 0.5]), {
        "factors": [(CHANGES, [1.0, 0.5]), (refused("factors"), [NAN, 1.0])],
        "speeds": [(CHANGES, [1.0, 0.7]), (refused("speeds"), [NAN, 1.0])]}),
    "life": (*analysis(lambda **o: np.concatenate([np.ravel(x) for x in lived(worn.life(**o))]), contacts=[0], rates=0.05,
                       cycles=[4.0], omega=[1.1, 1.2], force=[1.0, 0.5], share=[1.0, 1.0], areas=1.0, stiffness=1.0, worn=[0.01],
                       accuracy=1e-4, limit=0.0, most_steps=100, harmonics=3), {
        "contacts": [(refused("contact"), [9])], "rates": [(CHANGES, 0.06), (refused("rate"), -1.0)],
        "cycles": [(CHANGES, [5.0]), (refused("cycles"), [-1.0])], "omega": [(CHANGES, [1.1, 1.3]), (refused("omega"), [0.0, 1.0])],
        "force": [(CHANGES, [1.0, 0.6]), (refused("force"), [1.0, -1.0])], "share": [(CHANGES, [1.0, 2.0]), (refused("share"), [-1.0, 1.0])],
        "areas": [(CHANGES, 2.0), (refused("area"), 0.0)], "stiffness": [(CHANGES, 2.0), (refused("stiffness"), NAN)],
        "worn": [(CHANGES, [0.02]), (refused("worn"), [-1.0])], "accuracy": [(CHANGES, 1e-9), (refused("tolerance"), 1.0)],
        "limit": [(CHANGES, 1.23), (refused("limit"), -1.0)], "most_steps": [(CHANGES, 1), (refused("most_steps"), 0)],
        "peak": [(refused("either"), (0.8, 1.6))]}),
    "best_load_for_life": (*analysis(lambda **o: np.array([worn.best_load_for_life(**o).factor]), contacts=[0], rates=0.05, cycles=2.0,
                                     factors=(0.5, 3.0), peak=(0.8, 1.8), areas=1.0, stiffness=1.0, worn=[0.01], accuracy=1e-4,
                                     most_steps=100, harmonics=1), {
        "contacts": [(refused("contact"), [9])], "rates": [(CHANGES, 0.06), (refused("rate"), -1.0)],
        "cycles": [(CHANGES, 3.0), (refused("cycles"), -1.0)], "factors": [(refused("factor_low"), (0.0, 1.0))],
        "omega": [(refused("either"), [1.1])], "force": [(refused("omega"), [1.0])], "share": [(refused("omega"), [1.0])],
        "peak": [(refused("omega"), (0.0, 1.0)), (refused("no peak"), (9.0, 10.0))],
        "areas": [(CHANGES, 2.0), (refused("area"), 0.0)], "stiffness": [(CHANGES, 2.0), (refused("stiffness"), NAN)],
        "worn": [(CHANGES, [0.02]), (refused("worn"), [-1.0])], "accuracy": [(CHANGES, 1e-8), (refused("tolerance"), 1.0)],
        "most_steps": [(refused("most_steps"), 0)]}),
    "time_sweep": (*analysis(lambda **o: (lambda found: [found.amplitude, found.largest])(worn.time_sweep(**o)), omega=(0.8, 1.2), rate=1e-2,
                             dof=0, tolerance=1e-11, max_periods=10_000, start=[[0.0], [0.1]]), {
        "omega": [(CHANGES, (0.8, 1.1)), (refused("omega_start"), (0.0, 1.0))], "rate": [(CHANGES, 2e-2), (refused("rate"), -1.0)],
        "dof": [(refused("dof"), 3)], "tolerance": [(refused("tolerance"), 0.0)], "max_periods": [(refused("max_periods"), 0)],
        "start": [(refused("start"), [[NAN], [0.1]])]}),
    "energy": (*analysis(branch.energy, point=3), {"point": [(CHANGES, 4), (refused("point"), -1)]}),
    "slip": (*analysis(branch.slip, point=crest), {"point": [(CHANGES, 0), (refused("point"), -1)]}),
    "leading_response": (*analysis(lambda **o: np.array([sure.leading_response(**o)]), point=0), {
        "point": [(refused("point"), -1)]}),
    "read": (*analysis(lambda **o: [one.stored for one in branch.read(**o)], responses=[0]), {
        "responses": [(CHANGES, [1]), (refused("dofs"), [9])]}),
    "at": (*analysis(branch.at, wanted=0), {"wanted": [(CHANGES, 1), (refused("wanted"), 2)]}),
    "field": (*analysis(branch.field, field="omega"), {"field": [(CHANGES, "amplitude"), (refused("omega"), "speed")]}),
}
OF_LIVES = {"life", "best_load_for_life"}
HOOKS = {"progress", "log", "log_level", "cancel", "phase"}
for name, (function, run, base, claims) in ANALYSES.items():
    method = getattr(hbvib.Model, name, None) or getattr(hbvib.Branch, name, None) or getattr(hbvib, name)
    arguments = set(inspect.signature(method).parameters) - {"self", "constants"} - HOOKS
    if name in OF_LIVES:  # options of the solver have their claims where it has them: test_every_field.py
        arguments -= {field for field, _ in hbvib.structs["hbvib_solver_options"]._fields_}
        base = set(claims)
    check(f"{name}: every argument has a claim", arguments <= set(claims) and base == set(claims), arguments ^ set(claims))
    reference = outcome(run)
    for argument, listed in claims.items():
        for claim, value in listed:
            shown = value if isinstance(value, (int, float, str)) else "another one"
            hold(claim, f"{name}({argument} = {shown})", run, reference, inspect.getdoc(method), **{argument: value})

# Calls whose arguments are fields of structs, under the same or another name.
OF_STRUCTS = {
    "forced_response": ("forced_options solver_options", "omega"), "nonlinear_mode": ("mode_options solver_options", "log10_amplitude"),
    "parameter_response": ("parameter_options solver_options", "values log10_amplitude"),
    "batch": ("batch_options solver_options", "omega parameters values"), "time_response": ("time_options", ""),
    "verify": ("verify_options", "branch point"), "floquet": ("floquet_options", "branch point"),
    "synthesis": ("synthesis_options", "model"), "run_up": ("run_up_options", "model omega"),
    "mission": ("mission_options", "model time speed woehler"),
    "synthesis_peaks": ("synthesis_options", "model"), "add_user_force": ("user_force", "function"),
    "sector": ("sector", "stiffness mass damping coordinates on_axis"),
}
for name, (structs, others) in OF_STRUCTS.items():
    fields = {field for struct in structs.split() for field, _ in hbvib.structs["hbvib_" + struct]._fields_}
    method = getattr(hbvib.Model, name, None) or getattr(hbvib.Branch, name)
    arguments = set(inspect.signature(method).parameters) - {"self"} - HOOKS - set(others.split())
    check(f"{name}: every argument is a field", arguments <= fields, arguments - fields)

# Calls that need no claim: without arguments that could be dropped, drawings, files, those of test_every_constant.py, and wheels of
# test_wheels.py and test_wheel_statistics.py, fits of test_fits.py, add_damper, whose arguments are fields of test_every_field.py, modal coordinates of
# test_axis_nodes.py.
PLAIN = {
    "add_contact", "add_damper", "add_patch", "check_jacobian", "aero", "clear_forces", "clone", "longer_period", "contact", "cyclic",
    "free", "from_bytes", "load", "matrix", "mistune", "on_blade_modes", "save", "to_bytes", "wheel", "wheel_peaks", "wheel_study", "worst_pattern",
    "wheel_quantile", "intentional_pattern", "identify_pattern", "blade_frequencies", "pattern_of_blades",
    "fit", "plot", "plot_campbell", "plot_interference", "plot_loop", "bifurcations", "folds", "peaks", "optima", "turns", "higher_peaks",
    "limit_cycles",
    "modal_coordinates", "mode_point", "point",
    "to_dataframe", "to_xarray",
}
public = {name for kind in (hbvib.Model, hbvib.Branch) for name,
          member in inspect.getmembers(kind) if not name.startswith("_") and inspect.isroutine(member)}
listed = PLAIN | set(SETTERS) | set(ANALYSES) | set(OF_STRUCTS)
check("every call is examined", public <= listed, public - listed)

finish(290)
