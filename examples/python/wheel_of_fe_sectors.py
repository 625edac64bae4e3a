"""A wheel of finite-element sectors whose blades have ten cantilever modes each, beside a smaller wheel that is solved in full.

A sector is a piece of a disk with a blade on it, of bricks with eight nodes; the wheel is unrolled, so that all sectors have the axes of
the first one. Craig and Bampton's basis keeps the left face of the disk, the root of the blade and the contacts; the modes of the blade
with a fixed root are its cantilever modes, which span a pattern of blade frequencies. The mistuned wheel then differs from the tuned one
by N times ten low-rank terms, whatever the size of the mesh.

    python examples/python/wheel_of_fe_sectors.py            # 1,300 degrees of freedom a sector, reduced and in full
    python examples/python/wheel_of_fe_sectors.py --large    # 20,000 degrees of freedom a sector, with 10 and 20 modes
    python examples/python/wheel_of_fe_sectors.py --contacts # 24 sectors with 60 contacts each, see examples/data/fe

Prints amplitudes and CPU seconds. Needs scipy and examples/data. Amplitudes in um.
"""
from __future__ import annotations

import argparse
import csv
import gzip
import importlib
import pathlib
import resource
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import hbvib
import numpy as np
from numpy.typing import NDArray

sp = importlib.import_module("scipy.sparse")
linalg = importlib.import_module("scipy.sparse.linalg")

Floats = NDArray[np.float64]
Box = tuple[int, int, int]
Wheel = tuple[hbvib.Model, hbvib.Model, dict[int, float]]

DATA = pathlib.Path(__file__).resolve().parents[1] / "data" / "fe"


def cpu() -> float:
    """CPU seconds of this process."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def brick(size: Floats, young: float = 2.0e11, poisson: float = 0.3, density: float = 7800.0) -> tuple[Floats, Floats]:
    """Stiffness and mass of a brick with edges `size`, three degrees of freedom a node, x fastest."""
    corners = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    shear = young / (2 * (1 + poisson))
    elastic = np.zeros((6, 6))
    elastic[:3, :3] = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    elastic += np.diag([2 * shear] * 3 + [shear] * 3)
    k, m = np.zeros((24, 24)), np.zeros((24, 24))
    volume = np.prod(size) / 8
    for at in np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3):
        factors = (1 + corners * at) / 2
        shape = factors.prod(axis=1)
        slope = np.array([corners[:, d] / 2 * np.delete(factors, d, axis=1).prod(axis=1) * 2 / size[d] for d in range(3)])
        strain = np.zeros((6, 24))
        for d in range(3):
            strain[d, d::3] = slope[d]
        for row, (i, j) in enumerate([(0, 1), (1, 2), (0, 2)], 3):
            strain[row, i::3], strain[row, j::3] = slope[j], slope[i]
        k += volume * strain.T @ elastic @ strain
        spread = np.kron(shape, np.eye(3))
        m += volume * density * spread.T @ spread
    return k, m


class Sector:
    """Stiffness and mass of one sector with both faces, and the numbers of its parts."""

    def __init__(self, disk: Box, blade: Box) -> None:
        boxes = [((0, 0, 0), disk, (0.08 / disk[0], 0.02 / disk[1], 0.02 / disk[2])),
                 (((disk[0] - blade[0]) // 2, (disk[1] - blade[1]) // 2, disk[2]), blade,
                  (0.08 / disk[0], 0.02 / disk[1], 0.12 / blade[2]))]
        elements = []
        for origin, count, size in boxes:
            matrices = brick(np.array(size))
            for cell in np.ndindex(count[::-1]):
                corner = np.array(origin) + cell[::-1]
                elements.append(([tuple(corner + (x, y, z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)], matrices))
        # The bottom of the disk is clamped.
        nodes = sorted({node for corners, _ in elements for node in corners if node[2] > 0})
        first = {node: 3 * number for number, node in enumerate(nodes)}
        self.n = 3 * len(nodes)
        parts: tuple[list[Any], ...] = ([], [], [], [])
        for corners, matrices in elements:
            numbers = np.array([first[node] + d if node in first else -1 for node in corners for d in range(3)])
            rows, columns = np.meshgrid(numbers, numbers, indexing="ij")
            moves = (rows >= 0) & (columns >= 0)
            for part, values in zip(parts, (rows, columns, *matrices)):
                part.append(values[moves])
        rows, columns, *values = (np.concatenate(part) for part in parts)
        self.stiffness, self.mass = (sp.csc_matrix((v, (rows, columns)), shape=(self.n, self.n)) for v in values)

        def dofs(chosen: Callable[..., bool], directions: Iterable[int] = range(3)) -> list[int]:
            return [first[node] + d for node in nodes if chosen(*node) for d in directions]

        (low, width), top = (boxes[1][0][0], blade[0]), disk[2]
        across, along = range(low, low + width + 1), range(boxes[1][0][1], boxes[1][0][1] + blade[1] + 1)
        self.left = dofs(lambda x, y, z: x == 0 and z <= top)
        self.right = dofs(lambda x, y, z: x == disk[0] and z <= top)
        self.root = dofs(lambda x, y, z: z == top and x in across and y in along)
        self.blade = dofs(lambda x, y, z: z > top)
        self.tip = dofs(lambda x, y, z: z == top + blade[2], [1])[0]
        # Friction against a damper that is held, under the platform beside the root, across and along the axis.
        self.contacts = dofs(lambda x, y, z: z == top and x == 1, [0, 1])


def blocks(matrix: Any, left: Sequence[int], right: Sequence[int]) -> tuple[Any, Any]:
    """A matrix with both faces as that of a sector and its coupling to the next one, whose left face is the right one of this."""
    own = np.setdiff1d(np.arange(matrix.shape[0]), right)
    place = {dof: number for number, dof in enumerate(own)}
    moved = sp.csc_matrix((np.ones(len(left)), (range(len(right)), [place[dof] for dof in left])), shape=(len(right), len(own)))
    matrix = sp.csc_matrix(matrix)
    coupling = matrix[own][:, right] @ moved
    return matrix[own][:, own] + moved.T @ matrix[right][:, right] @ moved, coupling


def reduced(sector: Sector, modes: int, disk_modes: int) -> tuple[Floats, dict[int, int]]:
    """Craig and Bampton's basis: static motions of the kept degrees of freedom, cantilever modes of the blade, modes of the disk."""
    kept = sorted({*sector.left, *sector.right, *sector.root, *sector.contacts})
    blade = np.array(sector.blade)
    inner = np.setdiff1d(np.arange(sector.n), [*kept, *blade])
    basis = np.zeros((sector.n, len(kept) + modes + disk_modes))
    basis[kept, np.arange(len(kept))] = 1.0
    first = len(kept)
    for dofs, count in [(blade, modes), (inner, disk_modes)]:
        k, m = (a[dofs][:, dofs].tocsc() for a in (sector.stiffness, sector.mass))
        static = linalg.splu(k).solve(sector.stiffness[dofs][:, kept].toarray())
        basis[np.ix_(dofs, np.arange(len(kept)))] = -static
        _, shapes = linalg.eigsh(k, count, m, sigma=0.0, v0=np.ones(len(dofs)))
        basis[dofs, first:first + count] = shapes
        first += count
    return basis, {dof: number for number, dof in enumerate(kept)}


def wheel_of(matrices: Sequence[Any], faces: tuple[Sequence[int], Sequence[int]], contacts: Iterable[int], force: Floats,
             blade: Iterable[int], pattern: Floats) -> tuple[hbvib.Model, hbvib.Model, dict[int, int]]:
    """A mistuned wheel with friction, its sector, and the numbers of degrees of freedom within a sector."""
    left, right = faces
    (k0, k1), (m0, m1) = (blocks(a, left, right) for a in matrices)
    place = {dof: number for number, dof in enumerate(np.setdiff1d(np.arange(matrices[0].shape[0]), right))}
    model = hbvib.Model.cyclic(sectors=len(pattern), engine_order=3, mass=m0, stiffness=k0, coupling=dict(stiffness=k1, mass=m1),
                               rayleigh=(0, 2e-7))
    for dof in contacts:
        model.add_contact("jenkins", place[dof], kt=2e7, mu=0.3, preload=4.0)
    for dof, value in enumerate(force):
        if value != 0.0:
            model.add_force(place[dof], float(value))
    wheel = model.wheel()
    wheel.mistune(model, "frequency", pattern, dofs=[place[dof] for dof in blade])
    return wheel, model, place


def reduced_wheel(sector: Sector, modes: int, pattern: Floats, disk_modes: int = 12, force: float = 30.0) -> Wheel:
    """The wheel on the basis, and the weights that make the motion of a blade's tip."""
    basis, kept = reduced(sector, modes, disk_modes)
    matrices = [basis.T @ (a @ basis) for a in (sector.stiffness, sector.mass)]
    # Blade and kept degrees of freedom are orthogonal by the stiffness, but for rounding.
    blade = range(len(kept), len(kept) + modes)
    for k in blade:
        own = matrices[0][k, k]
        matrices[0][k, :], matrices[0][:, k] = 0.0, 0.0
        matrices[0][k, k] = own
    faces = ([kept[dof] for dof in sector.left], [kept[dof] for dof in sector.right])
    contacts = [kept[dof] for dof in sector.contacts]
    tip = np.where(abs(basis[sector.tip]) > 1e-14, basis[sector.tip], 0.0)
    wheel, model, place = wheel_of(matrices, faces, contacts, force * tip, blade, pattern)
    weights = {place[dof]: weight for dof, weight in enumerate(tip) if weight != 0.0}
    return wheel, model, weights


def full_wheel(sector: Sector, pattern: Floats, force: float = 30.0) -> Wheel:
    """The wheel of all degrees of freedom."""
    load = np.zeros(sector.n)
    load[sector.tip] = force
    faces = (sector.left, sector.right)
    wheel, model, place = wheel_of((sector.stiffness, sector.mass), faces, sector.contacts, load, sector.blade, pattern)
    return wheel, model, {place[sector.tip]: 1.0}


def tips(wheel: hbvib.Model, model: hbvib.Model, weights: dict[int, float], omega: Floats) -> Floats:
    """Amplitudes of all blade tips at frequencies, one row each."""
    n = model.ndof
    blades = [hbvib.Response([s * n + dof for dof in weights], weights=list(weights.values())) for s in range(wheel.ndof // n)]
    rows = []
    for at in omega:
        branch = wheel.forced_response((at, at), harmonics=1, tolerance=0, responses=blades)
        rows.append([found.amplitude[0] for found in branch.responses])
    return np.array(rows)


def small(disk: Box = (8, 2, 3), blade: Box = (2, 2, 12), sectors: int = 12) -> float:
    """Largest difference of the blades of a wheel on ten modes a blade from those of the wheel solved in full, over the largest."""
    sector = Sector(disk, blade)
    pattern = 0.02 * np.random.default_rng(7).standard_normal(sectors)
    used = cpu()
    wheel, model, weights = reduced_wheel(sector, 10, pattern)
    tuned = model.linear_modes(1, 3).omega[0]
    omega = tuned * np.array([0.99, 1.0, 1.01])
    found = tips(wheel, model, weights, omega)
    print(f"{sector.n} degrees of freedom with both faces, on {model.ndof}: {cpu() - used:.1f} s, tips in um\n{found * 1e6}")
    used = cpu()
    known = tips(*full_wheel(sector, pattern), omega)
    print(f"in full, {sectors} sectors: {cpu() - used:.1f} s\n{known * 1e6}")
    error = abs(found - known).max() / known.max()
    print(f"largest difference of a blade {error:.1e} of the largest amplitude")
    return float(error)


def large(sectors: int = 24) -> None:
    """A wheel of sectors with 20,000 degrees of freedom on 10 modes a blade, and on 20 of each."""
    sector = Sector((10, 4, 6), (6, 4, 190))
    print(f"{sector.n} degrees of freedom a sector with both faces")
    pattern = 0.02 * np.random.default_rng(7).standard_normal(sectors)
    rows: list[Floats] = []
    omega = np.zeros(0)
    for modes, disk_modes in [(10, 12), (20, 24)]:
        used = cpu()
        wheel, model, weights = reduced_wheel(sector, modes, pattern, disk_modes)
        built = cpu() - used
        if not rows:
            omega = model.linear_modes(1, 3).omega[0] * np.array([0.99, 1.0, 1.01])
        used = cpu()
        rows.append(tips(wheel, model, weights, omega))
        print(f"{modes} modes a blade: {model.ndof} a sector, basis {built:.1f} s, three frequencies {cpu() - used:.1f} s, "
              f"largest tip {rows[-1].max() * 1e6:.6f} um")
    print(f"largest difference of a blade {abs(rows[0] - rows[1]).max() / rows[1].max():.1e} of the largest amplitude")


def contacts(force: float = 2.0) -> None:
    """The sector of examples/data/fe: 24 x 60 contacts, ten cantilever modes differ, harmonic 1, a sweep over the peak."""

    def matrix(name: str) -> Floats:
        with gzip.open(DATA / f"rom_{name}.mtx.gz") as file:
            return np.asarray(sp.csc_matrix(importlib.import_module("scipy.io").mmread(file)).todense())

    sector = hbvib.Model.cyclic(sectors=24, engine_order=3, mass=matrix("M0"), stiffness=matrix("K0"),
                                coupling=dict(stiffness=matrix("K1"), mass=matrix("M1")), rayleigh=(0, 5e-7))
    with open(DATA / "contacts.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            sector.add_springs(int(row["rom_rim_r"]), int(row["rom_ring_r"]), float(row["kn_N_per_m"]))
            for direction in ("theta", "z"):
                sector.add_contact("jenkins", int(row[f"rom_rim_{direction}"]), int(row[f"rom_ring_{direction}"]),
                                   kt=float(row["kt_N_per_m"]), mu=float(row["mu"]), preload=float(row["N0_uniform_N"]))
    sector.add_force(181, force)
    used = cpu()
    wheel = sector.wheel()
    wheel.mistune(sector, "frequency", 0.01 * np.random.default_rng(5).standard_normal(24), dofs=range(183, 193))
    blades = [hbvib.Response(293 * s + 181) for s in range(24)]
    branch = wheel.forced_response((2 * np.pi * 510, 2 * np.pi * 560), harmonics=1, tolerance=0, response_dof=181, responses=blades)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    peaks = [found.peaks().amplitude.max() for found in branch.responses]
    print(f"{len(branch.omega)} points, {cpu() - used:.0f} CPU s, {memory:.1f} GB, {branch.reduction.flexibility_way!s}\n"
          f"blade {np.argmax(peaks)} has the largest peak, {max(peaks) * 1e6:.4f} um")


if __name__ == "__main__":
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--large", action="store_true")
    arguments.add_argument("--contacts", action="store_true")
    chosen = arguments.parse_args()
    if chosen.large:
        large()
    elif chosen.contacts:
        contacts()
    else:
        small()
