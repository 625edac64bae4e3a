"""The decay of a disturbance of the reduced finite-element sector with its 60 contacts, by an integration in time of its own.

usage: python sector_in_time.py [FORCE] [STEPS] [PERIODS]

Needs numpy. The force in N at 530 Hz (2), steps a period (500) and periods (40). All degrees of freedom of half a wave, four sectors whose
successors move opposite to them, are integrated by Newmark's method from the harmonic motion, and once more with a start that is disturbed
by a thousandth in the lowest modes. Moduli of the multipliers follow from the differences at the ends of periods, by dynamic mode
decomposition; the largest is to be compared with the radius that the library tells, which is printed first.
"""

import csv
import gzip
import os
import sys

import numpy as np

import hbvib

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "data", "fe")
ENGINE_ORDER, SECTORS, HALF, DAMPING, TIP = 3, 24, 4, 5e-7, 181
force = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
steps = int(sys.argv[2]) if len(sys.argv) > 2 else 500
periods = int(sys.argv[3]) if len(sys.argv) > 3 else 40
omega = 2 * np.pi * 530


def read(name):
    """A matrix in the format of Matrix Market."""
    with gzip.open(os.path.join(FOLDER, f"rom_{name}.mtx.gz"), "rt") as lines:
        symmetric = "symmetric" in next(lines)
        rows, columns, _ = map(int, next(line for line in lines if not line.startswith("%")).split())
        matrix = np.zeros((rows, columns))
        for line in lines:
            i, j, value = line.split()
            matrix[int(i) - 1, int(j) - 1] = float(value)
            if symmetric:
                matrix[int(j) - 1, int(i) - 1] = float(value)
    return matrix


k0, k1, m0, m1 = (read(name) for name in ("K0", "K1", "M0", "M1"))
n = len(k0)
pairs, kt, limit, springs = [], [], [], []
with open(os.path.join(FOLDER, "contacts.csv"), encoding="utf-8") as table:
    for row in csv.DictReader(table):
        for direction in ("theta", "z"):
            pairs.append((int(row[f"rom_rim_{direction}"]), int(row[f"rom_ring_{direction}"])))
            kt.append(float(row["kt_N_per_m"]))
            limit.append(float(row["mu"]) * float(row["N0_uniform_N"]))
        springs.append((int(row["rom_rim_r"]), int(row["rom_ring_r"]), float(row["kn_N_per_m"])))

model = hbvib.Model.cyclic(n, sectors=SECTORS, mass=m0, stiffness=k0, damping=DAMPING * k0,
                           coupling={"mass": m1, "stiffness": k1, "damping": DAMPING * k1})
model.set_wave(ENGINE_ORDER)
model.add_springs(*zip(*springs))
for (a, b), stiffness, load in zip(pairs, kt, limit):
    model.add_jenkins(a, b, kt=stiffness, mu=1, preload=load)
model.add_force(TIP, force)
branch = model.forced_response((omega, omega), harmonics=9, tolerance=0)
found = model.floquet(branch, 0)
print(f"library: radius {found.radius:.6f} on {found.modes} modes")
motion = branch.harmonics(0)


def ring(own, following):
    """The matrix of half a wave."""
    whole = np.zeros((HALF * n, HALF * n))
    for s in range(HALF):
        t, sign = (s + 1) % HALF, 1 if s + 1 < HALF else -1
        here, there = slice(s * n, s * n + n), slice(t * n, t * n + n)
        whole[here, here] += own
        whole[here, there] += sign * following
        whole[there, here] += sign * following.T
    return whole


def phase(h):
    """Factors of harmonic h in the sectors."""
    return np.exp(-2j * np.pi * ENGINE_ORDER * h * np.arange(HALF) / SECTORS)


stiffness, mass = ring(k0, k1), ring(m0, m1)
damping = DAMPING * stiffness
relative = np.zeros((HALF * len(pairs), HALF * n))
for s in range(HALF):
    for a, b, k in springs:
        both = np.ix_([s * n + a, s * n + b], [s * n + a, s * n + b])
        stiffness[both] += k * np.array([[1, -1], [-1, 1]])
    for c, (a, b) in enumerate(pairs):
        relative[s * len(pairs) + c, [s * n + a, s * n + b]] = 1, -1
kt_all = np.tile(kt, HALF)
play = (np.tile(limit, HALF) / kt_all)[:, None]
stuck = stiffness + relative.T @ (kt_all[:, None] * relative)
step = 2 * np.pi / omega / steps
inverse = np.linalg.inv(mass + step / 2 * damping + step**2 / 4 * stuck)
pull = relative.T * kt_all
load = np.zeros(HALF * n, complex)
load[np.arange(HALF) * n + TIP] = force * phase(1)


def at(t):
    """Displacements and velocities of the harmonic motion."""
    z = [np.kron(phase(h), x) * np.exp(1j * h * omega * t) for h, x in enumerate(motion)]
    return sum(x.real for x in z), sum(-h * omega * x.imag for h, x in enumerate(z))


place = np.zeros(len(play))
for t in np.linspace(0, 4 * np.pi / omega, 1281):
    r = relative @ at(t)[0]
    place = np.clip(place, r - play[:, 0], r + play[:, 0])
factor = np.linalg.inv(np.linalg.cholesky(mass))
shapes = factor.T @ np.linalg.eigh(factor @ stuck @ factor.T)[1]
x, v = at(0)
disturbed = shapes[:, :4] @ np.random.default_rng(1).standard_normal(4)
disturbed *= 1e-3 * np.abs(x).max() / np.abs(disturbed).max()
x = np.stack([x, x + disturbed], 1)
v = np.stack([v, v], 1)
w = np.clip(np.stack([place, place], 1), relative @ x - play, relative @ x + play)
a = np.linalg.solve(mass, pull @ w - stuck @ x - damping @ v + load.real[:, None])
coupling = relative @ inverse @ pull * (step**2 / 4)
project = shapes[:, :40].T @ mass
differences = []
for period in range(periods):
    for k in range(steps):
        turn = np.exp(2j * np.pi * (k + 1) / steps)
        x_free, v_free = x + step * v + step**2 / 4 * a, v + step / 2 * a
        a_free = inverse @ ((load * turn).real[:, None] - damping @ v_free - stuck @ x_free)
        r_free, new = relative @ (x_free + step**2 / 4 * a_free), w
        for _ in range(500):
            r = r_free + coupling @ new
            before, new = new, np.clip(w, r - play, r + play)
            if np.abs(new - before).max() <= 1e-13 * np.abs(r).max():
                break
        w = new
        a = a_free + inverse @ (pull @ w)
        x, v = x_free + step**2 / 4 * a, v_free + step / 2 * a
    differences.append(project @ np.concatenate([x[:, 1] - x[:, 0], (v[:, 1] - v[:, 0]) / omega]).reshape(2, -1).T)
    if period >= 15 and period % 5 == 4:
        for rank in (4, 6):
            z = np.array([d.ravel() for d in differences[5:]]).T
            u, size, right = np.linalg.svd(z[:, :-1], full_matrices=False)
            small = u[:, :rank].T @ z[:, 1:] @ right[:rank].T / size[:rank]
            moduli = np.sort(np.abs(np.linalg.eigvals(small)))[::-1]
            print(f"{period + 1} periods, rank {rank}:", *(f"{m:.6f}" for m in moduli), flush=True)
