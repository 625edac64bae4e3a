"""Cyclic structures: blocks, matrices by diameter, contacts to the next sector, and the finite-element sector."""

import gzip
import os

import numpy as np
import scipy.sparse
from record import case

import hbvib

_FE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../examples/data/fe")
_OWN = np.array([[3.0, -1.0, 0.0], [-1.0, 2.5, -0.5], [0.0, -0.5, 2.0]])
_NEXT = np.array([[-0.5, 0.1, 0.0], [0.2, -0.3, 0.0], [0.0, 0.05, -0.2]])


def sector(order, sectors=12, previous=False, contact="jenkins"):
    model = hbvib.Model.cyclic(sectors=sectors, engine_order=order, mass=np.diag([1.0, 0.7, 0.5]), stiffness=_OWN,
                               coupling=dict(stiffness=_NEXT), rayleigh=(0.01, 0.004))
    if previous:
        model.set_coupling("damping", 0.01 * _NEXT)
        model.set_coupling_previous("damping", 0.013 * _NEXT)
    if contact == "jenkins":
        model.add_contact("jenkins", 0, 2, kt=0.6, mu=0.3, preload=0.5)
        model.add_contact("jenkins", 1, 1, kt=0.4, mu=0.3, preload=0.4, sector_offset=1)
    elif contact == "friction_3d":
        model.add_contact("friction_3d", [0, 1, 2], [2, 0, 1], kt=0.4, kn=0.5, mu=0.3, preload=0.3, sector_offset=1)
    elif contact == "unilateral":
        model.add_contact("unilateral", 2, 2, kn=0.6, gap=0.1, sector_offset=1)
        model.add_table(0, 1, displacement=[-1, 0, 1], force=[-0.3, 0, 0.5], sector_offset=2)
    else:
        model.add_contact("cubic", 0, 0, kt=0.1, cubic=0.5, sector_offset=1)
        model.add_polynomial([0, 1], [0, 1], [0.2, 0.3], [[3, 0], [1, 2]])
    model.add_force(0, 0.3)
    model.add_force(1, 0.1j)
    return model


@case("sector")
def blocks(record):
    for order in (0, 1, 3, 6, 11, 13, -2):
        for contact in ("jenkins", "friction_3d", "unilateral", "cubic"):
            model = sector(order, contact=contact)
            record.solve(f"{order}_{contact}", model.forced_response, (0.9, 1.7), harmonics=4, points=2, at=[1.3])
    record.solve("tolerance", sector(3).forced_response, (1.0, 1.6), tolerance=1e-2, points=2)
    record.solve("tolerance_default", sector(1).forced_response, 1.3)
    record.solve("previous", sector(3, previous=True).forced_response, (0.9, 1.7), harmonics=3, points=2)
    record.solve("harmonic_2", _second().forced_response, (0.5, 0.9), harmonics=6, points=2)


def _second():
    model = sector(2)
    model.clear_forces()
    model.add_force(0, 0.3, 2)
    model.add_force(2, 0.05, 0)
    return model


@case("sector")
def modes(record):
    for order in (0, 1, 6):
        for contact in ("jenkins", "cubic"):
            record.solve(f"{order}_{contact}", sector(order, contact=contact).nonlinear_mode, (-1.5, 0.5), harmonics=3,
                         points=2)
    record.solve("tolerance", sector(2).nonlinear_mode, (-1, 0.3), tolerance=1e-2, points=2)
    record.solve("diameter", sector(2).nonlinear_mode, (-1, 0.3), harmonics=3, points=2, diameter=4, mode_index=2)


@case("sector")
def diameters(record):
    sectors, order = 12, 5
    model = hbvib.Model.cyclic(3, sectors=sectors, engine_order=order, rayleigh=(0.01, 0.004))
    for diameter in range(sectors // 2 + 1):
        turn = np.exp(-2j * np.pi * diameter / sectors)
        wave = _OWN + turn * _NEXT + np.conj(turn) * _NEXT.T
        if diameter in (0, sectors // 2):
            wave = wave.real
        model.set_diameter("stiffness", diameter, 0.5 * (wave + wave.conj().T))
        model.set_diameter("mass", diameter, np.diag([1.0, 0.7, 0.5]))
    model.add_contact("jenkins", 0, 2, kt=0.6, mu=0.3, preload=0.5)
    model.add_force(0, 0.3)
    record.solve("H5", model.forced_response, (0.9, 2.2), harmonics=5, points=2)
    record.solve("mode", model.nonlinear_mode, (-1.5, 0.5), harmonics=3, points=2)
    some = hbvib.Model.cyclic(3, sectors=sectors, engine_order=order)
    some.set_diameter("stiffness", order, _OWN)
    some.set_diameter("mass", order, np.eye(3))
    some.add_contact("jenkins", 0, 2, kt=0.6, mu=0.3, preload=0.5)
    some.add_force(0, 0.3)
    record.solve("some_H1", some.forced_response, (0.9, 2.2), harmonics=1, points=2)
    record.solve("some_H5", some.forced_response, 1.3, harmonics=5)


def _matrix(name):
    """A matrix in MatrixMarket's format, coordinates or an array."""
    with gzip.open(os.path.join(_FE, f"{name}.mtx.gz"), "rt") as file:
        head = file.readline().split()
        line = file.readline()
        while line.startswith("%"):
            line = file.readline()
        sizes = [int(n) for n in line.split()]
        numbers = np.array(file.read().split(), float)
    assert head[3] == "real", head
    if head[2] == "array":
        assert head[4] == "general", head
        return numbers.reshape(sizes[1], sizes[0]).T
    rows, columns, values = numbers.reshape(sizes[2], 3).T
    rows, columns = rows.astype(int) - 1, columns.astype(int) - 1
    matrix = scipy.sparse.coo_matrix((values, (rows, columns)), sizes[:2]).tocsc()
    if head[4] == "symmetric":
        matrix = matrix + scipy.sparse.tril(matrix, -1).T
    return matrix.tocsc()


def fe_sector(size, force):
    """The sector of a bladed disk with a ring that rubs under its rim; `size` is "rom" or "coarse"."""
    parts = {name: _matrix(f"{size}_{name}") for name in ("K0", "K1", "M0", "M1")}
    model = hbvib.Model.cyclic(sectors=24, engine_order=3, mass=parts["M0"], stiffness=parts["K0"],
                               coupling=dict(stiffness=parts["K1"], mass=parts["M1"]), rayleigh=(0, 5e-7))
    with open(os.path.join(_FE, "contacts.csv"), encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        rows = [dict(zip(names, line.strip().split(","))) for line in file if line.strip()]
    prefix = "rom" if size == "rom" else "full"
    for row in rows:
        a, b = ([int(row[f"{prefix}_{side}_{axis}"]) for axis in ("r", "theta", "z")] for side in ("rim", "ring"))
        model.add_springs(a[0], b[0], float(row["kn_N_per_m"]))
        for axis in (1, 2):
            model.add_contact("jenkins", a[axis], b[axis], kt=float(row["kt_N_per_m"]), mu=float(row["mu"]),
                              preload=float(row["N0_uniform_N"]))
    tip = 181 if size == "rom" else 16
    if force:
        model.add_force(tip, force)
    return model, tip


@case("fe")
def reduced(record):
    model, tip = fe_sector("rom", 30.0)
    for state in ("free", "stuck"):
        modes = model.linear_modes(4, 3, state)
        record.write(f"omega_{state}", modes.omega)
        record.write(f"shape_{state}", modes.shapes[:, ::29])
    first = modes.omega[0]
    for h in (1, 3):
        for factor in (0.97, 0.999):
            record.solve(f"H{h}_{factor}", model.forced_response, factor * first, harmonics=h, dofs=[0, tip],
                         response_dof=tip)
    record.solve("sweep_H1", model.forced_response, (0.99 * first, 1.002 * first), harmonics=1, points=3, dofs=[tip],
                 response_dof=tip)


@case("fe")
def reduced_mode(record):
    model, tip = fe_sector("rom", 0.0)
    record.solve("H1", model.nonlinear_mode, (-5, -4), harmonics=1, points=2, dofs=[tip], near_omega=0, mode_index=0)


@case("fe")
def coarse_modes(record):
    model, tip = fe_sector("coarse", 30.0)
    modes = model.linear_modes(3, 3, "stuck")
    record.write("omega", modes.omega)
    record.write("shape", modes.shapes[:, ::311])
    record.solve("H1", model.forced_response, 0.97 * modes.omega[0], harmonics=1, dofs=[0, tip], response_dof=tip)
