"""Linear modes, and structures large enough for interpolation over the frequency and for sparse factors."""

import numpy as np
import scipy.sparse
from record import case, chain

import hbvib


def plate(n, seed=7):
    """A symmetric positive definite pair with couplings beyond neighbours."""
    made = chain(n, stiffness=4.0)
    extra = np.zeros((n, n))
    for i in range(n):
        j = (i * seed + 3) % n
        if i != j:
            value = 0.05 + 0.01 * ((i * 13 + 5) % 7)
            extra[i, i] += value
            extra[j, j] += value
            extra[i, j] -= value
            extra[j, i] -= value
    made["stiffness"] = made["stiffness"] + extra
    made["damping"] = 0.004 * made["stiffness"]
    return made


@case("linear")
def modes_of_chains(record):
    for n in (1, 2, 12, 40, 90):
        model = hbvib.Model(**plate(n))
        record.write(f"{n}", model.linear_modes(min(n, 8)))
        model.add_contact("jenkins", 0, n - 1 if n > 1 else -1, kt=3.0, mu=0.3, preload=1.0)
        for state in ("free", "stuck"):
            record.write(f"{n}_{state}", model.linear_modes(min(n, 8), contacts=state))
        record.write(f"{n}_all", model.linear_modes(n).omega)


@case("linear")
def modes_of_waves(record):
    ring = hbvib.Model.cyclic(sectors=24, mass=np.diag([1.0, 2.0]), stiffness=[[3.0, -1.0], [-1.0, 2.5]],
                              coupling=dict(stiffness=[[-0.5, 0.1], [0.2, -0.3]], mass=[[0.01, 0], [0, 0.02]]))
    ring.add_contact("jenkins", 0, 1, kt=0.4, mu=0.3, preload=1.0, sector_offset=1)
    for diameter in (0, 1, 5, 12):
        for state in ("free", "stuck"):
            record.write(f"{diameter}_{state}", ring.linear_modes(2, diameter, state))
    massless = hbvib.Model(mass=np.diag([1.0, 0.0, 2.0]), stiffness=chain(3)["stiffness"])
    record.write("massless", massless.linear_modes(2))
    record.write("massless_all", record.attempt("massless_all", massless.linear_modes, 3))
    repeated = hbvib.Model(mass=np.eye(4), stiffness=np.diag([1.0, 1.0, 2.0, 2.0]))
    record.write("repeated", repeated.linear_modes(4))


@case("linear")
def modes_sparse(record):
    for n in (60, 300, 700):
        made = plate(n)
        model = hbvib.Model(**{name: scipy.sparse.csc_matrix(matrix) for name, matrix in made.items()})
        model.add_contact("jenkins", 0, n - 1, kt=3.0, mu=0.3, preload=1.0)
        for state in ("free", "stuck"):
            modes = model.linear_modes(6, contacts=state)
            record.write(f"{n}_{state}_omega", modes.omega)
            record.write(f"{n}_{state}_shapes", modes.shapes[:, ::1 + n // 60])


def _large(n, sparse, contacts, damping=None):
    made = plate(n)
    if damping is not None:
        made["damping"] = damping(made)
    if sparse:
        made = {name: scipy.sparse.csc_matrix(matrix) for name, matrix in made.items()}
    model = hbvib.Model(**made)
    where = np.arange(contacts) * (n // (contacts + 1)) + 2
    model.add_jenkins(where, np.where(where % 2, where + 1, -1), 2.0, 0.3, 0.5 + 0.1 * np.arange(contacts))
    model.add_force(n - 1, 0.5)
    return model


def _general(made):
    turn = np.zeros_like(made["stiffness"])
    turn[0, 1], turn[1, 0] = 0.02, -0.02
    return made["damping"] + turn


@case("large")
def dense(record):
    for n, contacts in ((33, 2), (60, 5), (150, 12)):
        model = _large(n, False, contacts)
        for h in (1, 3):
            record.solve(f"{n}_H{h}", model.forced_response, (0.2, 0.9) if h == 1 else (0.3, 0.5), harmonics=h, points=2,
                         dofs=[0, n // 2, n - 1])
        record.solve(f"{n}_point", model.forced_response, 0.4, harmonics=7, dofs=[0, n - 1])
    model = _large(60, False, 3)
    record.solve("tolerance", model.forced_response, (0.35, 0.45), tolerance=1e-2, points=2, dofs=[0, 59])
    record.solve("mode", model.nonlinear_mode, (-1, 1), harmonics=3, points=2, dofs=[0, 59])
    record.solve("mode_tolerance", _large(34, False, 1).nonlinear_mode, (-1, 0.3), tolerance=1e-2, max_harmonics=15,
                 points=2, dofs=[0, 33])


@case("large")
def general_damping(record):
    made = plate(40)
    model = hbvib.Model(mass=made["mass"], stiffness=made["stiffness"])
    model.set_matrix("damping", _general(made), "general")
    model.add_contact("jenkins", 0, 20, kt=2.0, mu=0.3, preload=0.5)
    model.add_force(39, 0.5)
    record.solve("H3", model.forced_response, (0.2, 0.6), harmonics=3, points=2, dofs=[0, 39])
    loss = hbvib.Model(mass=made["mass"], damping=made["damping"])
    loss.set_matrix("stiffness", made["stiffness"] * (1 + 0.01j), "general")
    loss.add_contact("cubic", 39, kt=0.1, cubic=0.3)
    loss.add_force(39, 0.5)
    record.solve("complex", loss.forced_response, (0.2, 0.6), harmonics=3, points=2, dofs=[0, 39])
    for part in ("lower", "upper"):
        triangle = np.tril(made["stiffness"]) if part == "lower" else np.triu(made["stiffness"])
        half = hbvib.Model(mass=made["mass"], damping=made["damping"])
        half.set_matrix("stiffness", triangle, part)
        half.add_force(0, 1.0)
        half.add_contact("jenkins", 0, kt=2.0, mu=0.3, preload=0.5)
        record.solve(part, half.forced_response, 0.5, harmonics=3, dofs=[0, 39])


@case("large")
def sparse(record):
    for n, contacts in ((220, 3), (400, 6)):
        model = _large(n, True, contacts)
        record.solve(f"{n}_sweep", model.forced_response, (0.3, 0.36), harmonics=3, points=2, dofs=[0, n // 2, n - 1])
        record.solve(f"{n}_point", model.forced_response, 0.4, harmonics=9, dofs=[0, n - 1])
        record.solve(f"{n}_default", model.forced_response, 0.4, tolerance=1e-2, dofs=[0, n - 1])
    model = _large(260, True, 4)
    record.solve("mode", model.nonlinear_mode, (-1, 1), harmonics=3, points=2, dofs=[0, 259])


@case("large")
def many_contacts(record):
    model = _large(80, False, 30)
    record.solve("H5", model.forced_response, 0.4, harmonics=5, dofs=[0, 79])
    record.solve("H9_estimate", model.forced_response, 0.4, harmonics=9, estimate_error=1, dofs=[0, 79])
    record.solve("default", model.forced_response, 0.4, tolerance=1e-3, dofs=[0, 79])
    for dof in range(0, 60, 3):
        model.add_contact("friction_3d", [dof, dof + 1, dof + 2], kt=0.5, kn=0.5, mu=0.4, preload=0.1)
    record.solve("plane", model.forced_response, 0.4, harmonics=3, dofs=[0, 79])
