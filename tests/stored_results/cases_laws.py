"""Every contact law: its force on prescribed motions, and small structures that carry it."""

import numpy as np
from record import case, cases, chain

import hbvib

_MOTIONS = {
    "small": [0.0, 0.1, 0.0, 0.02j],
    "large": [0.3, 1.0 - 0.4j, 0.2j, 0.15, 0.0, -0.1 + 0.05j],
    "mean": [0.7, 0.5j, 0.1],
    "odd": [0.0, 0.9, 0.0, 0.3 + 0.2j, 0.0, 0.0, 0.0, 0.05],
}
_LAWS = {
    "jenkins": ("jenkins", 1, dict(kt=1.0, mu=0.3, preload=1.0)),
    "jenkins_rigid": ("jenkins", 1, dict(kt=1e4, mu=0.3, preload=1.0)),
    "jenkins_endless": ("jenkins", 1, dict(kt=1.0, mu=0.3, preload=np.inf)),
    "jenkins_none": ("jenkins", 1, dict(kt=1.0, mu=0.0, preload=1.0)),
    "friction_2d": ("friction_2d", 2, dict(kt=1.0, kn=1.3, mu=0.4, preload=0.6)),
    "friction_2d_gap": ("friction_2d", 2, dict(kt=1.0, kn=1.3, mu=0.4, gap=0.1)),
    "friction_3d": ("friction_3d", 3, dict(kt=1.0, kn=1.3, mu=0.4, preload=0.6)),
    "friction_3d_constant": ("friction_3d", 2, dict(kt=1.0, mu=0.4, preload=0.6)),
    "unilateral": ("unilateral", 1, dict(kn=3.0, gap=0.2)),
    "unilateral_preload": ("unilateral", 1, dict(kn=3.0, preload=0.4)),
    "cubic": ("cubic", 1, dict(kt=0.3, cubic=0.7)),
    "cubic_soft": ("cubic", 1, dict(kt=1.0, cubic=-0.2)),
    "regularised": ("regularised", 1, dict(mu=0.3, preload=1.0, velocity=0.05)),
}


@cases("law", _LAWS)
def law(record, given):
    kind, directions, constants = given
    for name, motion in _MOTIONS.items():
        moves = np.array([np.array(motion) * factor for factor in (1, 0.7 - 0.5j, -0.8 + 0.3j)[:directions]])
        moves[:, 0] = moves[:, 0].real
        for samples in (0, 64):
            label = f"{name}_{samples}"
            record.write(label, record.attempt(label, hbvib.evaluate_contact, kind, moves[0] if directions == 1 else moves,
                                               omega=1.3, samples=samples, jacobian=True, **constants))
    record.write("refused", record.attempt("refused", hbvib.evaluate_contact, kind, [0, 0.3],
                                           **(constants | dict(kt=-1.0, kn=-1.0))))


def structure(n=3, force=0.4, constant=0.0, harmonic=1):
    """Masses in a row under a force on the last one, and a constant force."""
    model = hbvib.Model(**chain(n))
    model.add_force(n - 1, force, harmonic)
    if constant:
        model.add_force(n - 1, constant, 0)
    return model


def curved(call):
    """f = u + 0.8 u^3 + 0.1 u^2 v."""
    u, v = call.u[:, 0], call.v[:, 0]
    call.f[:, 0] = u + 0.8 * u**3 + 0.1 * u * u * v
    call.df_du[:, 0, 0] = 1 + 2.4 * u * u + 0.2 * u * v
    call.df_dv[:, 0, 0] = 0.1 * u * u


def slider(call):
    """A Jenkins contact with its slider as state, kt = 1, limit 0.3."""
    z, before, rise = call.z0[0], call.u[-1, 0], 0.3
    for j in range(call.samples):
        u = call.u[j, 0]
        free = z + u - before
        slips = abs(free) > rise
        z = float(np.sign(free) * rise) if slips else free
        call.z[j, 0], call.f[j, 0], call.df_dz[j, 0, 0] = z, z, 1.0
        if not slips:
            call.dz_dz[j, 0, 0], call.dz_du[j, 0, 0], call.dz_du_before[j, 0, 0] = 1.0, 1.0, -1.0
        before = u


def bouc_wen(call):
    """z' = v - |v| z / 0.4 with f = 0.5 z by the implicit midpoint rule: velocities, states and the time step matter."""
    step = 2 * np.pi / (call.omega * call.samples)
    z, last = call.z0[0], call.v[-1, 0]
    for j in range(call.samples):
        v = call.v[j, 0]
        mean = 0.5 * (v + last)
        size, sign = abs(mean), np.sign(mean)
        below = 1 + 0.5 * step * size / 0.4
        above = z * (1 - 0.5 * step * size / 0.4) + step * mean
        new = above / below
        call.z[j, 0], call.f[j, 0], call.df_dz[j, 0, 0] = new, 0.5 * new, 0.5
        call.dz_dz[j, 0, 0] = (1 - 0.5 * step * size / 0.4) / below
        slope = (-0.5 * step * sign / 0.4 * z + step - new * 0.5 * step * sign / 0.4) / below
        call.dz_dv[j, 0, 0] = call.dz_dv_before[j, 0, 0] = 0.5 * slope
        rate = (-0.5 * size / 0.4 * z + mean - new * 0.5 * size / 0.4) / below
        call.dz_domega[j, 0] = -step / call.omega * rate
        z, last = new, v


def _patch(model):
    for kind, constants in (("friction_2d", dict(kt=0.5, kn=0.5, mu=0.3)), ("friction_3d", dict(kt=0.3, kn=0.4, mu=0.5))):
        model.add_patch(kind, [[0, 1, 2]] * 2, None, [0, 0.6, 0.8], [0.25, 0.4], tangent=[1, 0, 0], pressure=[0.2, 0.3],
                        **constants)


_CARRIED = {
    "jenkins": lambda model: model.add_contact("jenkins", 2, 1, kt=1.0, mu=0.3, preload=1.0),
    "two_jenkins": lambda model: model.add_jenkins([2, 1], [1, -1], [1.0, 0.6], 0.3, [1.0, 0.4]),
    "friction_2d": lambda model: model.add_contact("friction_2d", [0, 2], kt=0.5, kn=0.5, mu=0.3, preload=0.2),
    "friction_2d_sides": lambda model: model.add_contact("friction_2d", [1, 2], [0, -1], kt=0.5, kn=0.5, mu=0.3,
                                                         gap=-0.3),
    "friction_3d": lambda model: model.add_contact("friction_3d", [0, 1, 2], kt=0.5, kn=0.5, mu=0.3, preload=0.3),
    "friction_3d_constant": lambda model: model.add_contact("friction_3d", [0, 1], kt=0.5, mu=0.3, preload=0.5),
    "friction_3d_normal": lambda model: model.add_contact("friction_3d", [0, 1, 2], kt=0.5, kn=0.4, mu=0.3, preload=0.3,
                                                          normal=[0.2, 0.3, 0.9]),
    "unilateral": lambda model: model.add_contact("unilateral", -1, 2, kn=2.0, gap=0.2),
    "unilateral_preload": lambda model: model.add_contact("unilateral", 2, -1, kn=2.0, preload=0.2),
    "cubic": lambda model: model.add_contact("cubic", 2, kt=0.3, cubic=0.7),
    "regularised": lambda model: model.add_contact("regularised", 2, mu=0.3, preload=0.5, velocity=0.05),
    "table": lambda model: model.add_table(2, displacement=[-1, -0.4, 0, 0.3, 1.5], force=[-0.9, -0.2, 0, 0.1, 1.2]),
    "polynomial": lambda model: model.add_polynomial([1, 2], [0, 1, 0, 1], [0.4, 0.5, 0.2, 0.1],
                                                     [[3, 0], [0, 3], [1, 2], [2, 0]], [[0, 0], [0, 0], [0, 0], [0, 1]]),
    "even_polynomial": lambda model: model.add_polynomial([2], [0, 0], [0.4, 0.3], [[2], [3]]),
    "spring_damper": lambda model: model.add_spring_damper(2, 1, spring=[0.3, 0, 0.7], damper=[0.01, 0.0, 0.05]),
    "tensors": lambda model: model.add_stiffness_tensors(
        [1, 2], 0.1 * np.arange(8).reshape(2, 2, 2), 0.05 * (1 + np.arange(16)).reshape(2, 2, 2, 2)),
    "iwan": lambda model: model.add_iwan(2, 1, slip_force=0.6, stiffness=1.0, chi=-0.4, beta=0.3, elements=12),
    "user": lambda model: model.add_user_force([2], curved, uses_velocity=True, is_odd=True),
    "user_slider": lambda model: model.add_user_force([2], slider, states=1, samples=96),
    "user_bouc_wen": lambda model: model.add_user_force([2], bouc_wen, states=1, samples=96, uses_velocity=True),
    "patch": _patch,
    "springs": lambda model: model.add_springs([0, 1], [2, -1], [0.3, 0.4]),
    "mixed": lambda model: (model.add_contact("jenkins", 2, kt=1.0, mu=0.3, preload=1.0),
                            model.add_contact("cubic", 1, kt=0.1, cubic=0.4),
                            model.add_contact("unilateral", 0, -1, kn=1.0, gap=0.3),
                            model.add_table(1, displacement=[-1, 1], force=[-0.2, 0.3]),
                            model.add_user_force([0], curved, uses_velocity=True)),
}


@cases("carried", _CARRIED)
def carried(record, add):
    slow = "user_" in record.label  # states are marched in Python
    for name, constant in (("free", 0.0), ("loaded", 0.15)):
        model = structure(constant=constant)
        add(model)
        record.write(f"{name}_contacts", model.contacts)
        record.solve(f"{name}_H1", model.forced_response, (0.2, 1.2), harmonics=1, points=3, at=[0.6])
        record.solve(f"{name}_H4", model.forced_response, (0.2, 0.9) if slow else (0.2, 2.6), harmonics=4, points=3,
                     at=[0.6])
        if slow:
            continue
        record.solve(f"{name}_sampled", model.forced_response, 0.7, harmonics=5, samples=80)
        record.solve(f"{name}_down", model.forced_response, (1.6, 0.3), harmonics=3, points=2)
        record.solve(f"{name}_tolerance", model.forced_response, (0.3, 0.8), tolerance=1e-2, points=2, max_harmonics=63)
        record.solve(f"{name}_estimate", model.forced_response, 0.7, harmonics=5, estimate_error=1)
    model = structure(force=0.0)
    add(model)
    for state in ("free", "stuck"):
        record.write(f"modes_{state}", record.attempt(f"modes_{state}", model.linear_modes, 3, contacts=state))
    record.solve("mode_H3", model.nonlinear_mode, (-2, 0.5), harmonics=3, points=3, at=[-0.5])
    if slow:
        return
    record.solve("mode_stiffness", model.nonlinear_mode, (-2, 0.5), harmonics=4, points=2, damping_form="stiffness")
    record.solve("mode_tolerance", model.nonlinear_mode, (-1.5, 0), tolerance=1e-2, points=2, max_harmonics=63)


@case("carried")
def derivatives_of_user_forces(record):
    for name, dofs, function, options in (
            ("curved", [2], curved, dict(uses_velocity=True)), ("slider", [2], slider, dict(states=1)),
            ("bouc_wen", [2], bouc_wen, dict(states=1, uses_velocity=True))):
        model = structure()
        model.add_user_force(dofs, function, **options)
        record.write(name, record.attempt(name, model.check_jacobian, 0, 1.3, [0.8]))


@case("carried")
def refusals_of_user_forces(record):
    def refuses(call):
        if np.abs(call.u).max() > 0.5:
            return False
        return curved(call)

    def not_finite(call):
        curved(call)
        if np.abs(call.u).max() > 0.5:
            call.f[0, 0] = np.nan

    for name, function in dict(refuses=refuses, not_finite=not_finite).items():
        model = structure()
        model.add_user_force([2], function, uses_velocity=True, is_odd=True)
        record.solve(name, model.forced_response, (0.2, 0.8), harmonics=3, points=2, loops=False)


@case("carried")
def preload_changed(record):
    model = structure()
    first = model.add_contact("jenkins", 2, kt=1.0, mu=0.3, preload=1.0)
    for preload in (0.0, 0.3, 3.0, np.inf):
        model.set_preload(first, preload)
        record.solve(f"preload_{preload}", model.forced_response, (0.2, 1.2), harmonics=5, points=2)
    record.attempt("negative", model.set_preload, first, -1.0)
    copy = model.clone()
    copy.clear_forces()
    copy.add_force(1, 0.3 + 0.1j, 3)
    record.solve("third_harmonic", copy.forced_response, (0.1, 0.5), harmonics=9, points=2)


_DUFFING = {
    "hardening": (0.0, 1.0, dict(harmonics=7)),
    "H1": (0.0, 1.0, dict(harmonics=1)),
    "H3_down": (0.0, 1.0, dict(harmonics=3, omega=(2.2, 0.4))),
    "H15_even": (0.0, 1.0, dict(harmonics=8, keep_even_harmonics=1)),
    "softening": (0.0, -0.05, dict(harmonics=7)),
    "tolerance_3": (0.0, 1.0, dict()),
    "tolerance_2": (0.0, 1.0, dict(tolerance=1e-2)),
    "tolerance_down": (0.0, 1.0, dict(omega=(2.2, 0.4))),
    "superharmonic": (0.0, 1.0, dict(tolerance=1e-3, omega=(0.15, 0.6))),
    "narrow": (0.0, 0.02, dict(harmonics=7, omega=(0.9, 1.3))),
}


@cases("duffing", _DUFFING)
def duffing(record, given):
    kt, cubic, options = given
    options = dict(options)
    model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    model.add_contact("cubic", 0, kt=kt, cubic=cubic)
    model.add_force(0, 0.3 if cubic > 0 else 0.1)
    record.solve("response", model.forced_response, options.pop("omega", (0.4, 2.2)), at=[1.3, 0.95][:1 + (cubic < 0)]
                 if "omega" not in given[2] else [], **options)
    free = hbvib.Model(mass=1, stiffness=1)
    free.add_contact("cubic", 0, kt=kt, cubic=cubic)
    record.solve("mode", free.nonlinear_mode, (-2, 0.3), points=3, **options)


@case("errors")
def refused(record):
    model = structure()
    bad = [
        ("dof", model.add_contact, ("jenkins", 7), dict(kt=1.0, mu=0.3, preload=1.0)),
        ("same", model.add_contact, ("jenkins", 1, 1), dict(kt=1.0, mu=0.3, preload=1.0)),
        ("kt", model.add_contact, ("jenkins", 1), dict(kt=-1.0, mu=0.3, preload=1.0)),
        ("nan", model.add_contact, ("cubic", 1), dict(kt=np.nan, cubic=0.3)),
        ("kn", model.add_contact, ("friction_2d", [0, 1]), dict(kt=1.0, mu=0.3, preload=1.0)),
        ("offset", model.add_contact, ("jenkins", 0, 1), dict(kt=1.0, mu=0.3, preload=1.0, sector_offset=1)),
        ("normal", model.add_contact, ("unilateral", [0, 1, 2]), dict(kn=1.0, normal=[0, 0, 1], tangent=[0, 0, 1])),
        ("velocity", model.add_contact, ("regularised", 1), dict(mu=0.3, preload=1.0)),
        ("iwan", model.add_iwan, (0,), dict(slip_force=1.0, stiffness=1.0, chi=-1.5, beta=0.1)),
        ("table", model.add_table, (0,), dict(displacement=[0, 0], force=[0, 1])),
        ("polynomial", model.add_polynomial, ([0], [3], [1.0], [[2]]), dict()),
        ("force", model.add_force, (9, 1.0), dict()),
        ("harmonic", model.add_force, (0, 1.0, -1), dict()),
        ("hermitian", model.set_matrix, ("stiffness", [[1, 2, 0], [0, 1, 0], [0, 0, 1]]), dict()),
        ("size", model.set_matrix, ("stiffness", np.eye(2)), dict()),
        ("negative_mass", model.set_matrix, ("mass", -np.eye(3)), dict()),
        ("modes", model.linear_modes, (5,), dict()),
        ("omega", model.forced_response, (-1.0,), dict(harmonics=3)),
        ("harmonics", model.forced_response, (1.0,), dict(harmonics=-1)),
        ("at", model.forced_response, ((1.0, 2.0),), dict(harmonics=3, at=[3.0])),
        ("dof_of_response", model.forced_response, (1.0,), dict(harmonics=3, response_dof=4)),
        ("range_of_mode", model.nonlinear_mode, ((0, -1),), dict(harmonics=3)),
        ("wave", model.nonlinear_mode, ((-1, 0),), dict(harmonics=3, diameter=2)),
        ("coupling", model.set_coupling, ("stiffness", np.eye(3)), dict()),
        ("tolerance", model.forced_response, (1.0,), dict(tolerance=-1.0)),
    ]
    for name, function, arguments, options in bad:
        result = record.attempt(name, function, *arguments, **options)
        record.write(f"{name}_result", int(result is not None))
    undamped = hbvib.Model(mass=1, stiffness=1)
    undamped.add_force(0, 1.0)
    record.solve("resonance", undamped.forced_response, 1.0, harmonics=3)
    record.solve("through_resonance", undamped.forced_response, (0.5, 1.5), harmonics=3)
    loose = hbvib.Model(mass=1)
    loose.add_force(0, 1.0, 0)
    record.solve("loose", loose.forced_response, 1.0, harmonics=3)
    slip = hbvib.Model(mass=1, stiffness=1)
    slip.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    slip.add_force(0, 0.4)
    record.solve("above_capacity", slip.forced_response, (0.8, 1.2), harmonics=3, points=2)
