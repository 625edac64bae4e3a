"""The response of the wheel through a Craig-Bampton model of the caller's, made by scipy, against that of all degrees of freedom.

usage: python own_craig_bampton.py [MODES [FROM_HZ TO_HZ [HARMONICS]]]      as 700 1060 1095 3

It is run after mesh.py and hbvib init, which leave wheel.inp and wheel_matrices.sti, and needs scipy and hbvib.

Nodes of the faces and of the contact, and the excited degree of freedom, stay physical.
"""

import re
import sys
import time

import numpy as np
import scipy.sparse.linalg as sl

import hbvib
import hbvib.io

count = int(sys.argv[1]) if len(sys.argv) > 1 else 700
harmonics = int(sys.argv[4]) if len(sys.argv) > 4 else 1
SECTORS, PRELOAD = 24, 40.0
ANGLE = 2 * np.pi / SECTORS
TURN = np.array([[np.cos(ANGLE), -np.sin(ANGLE), 0], [np.sin(ANGLE), np.cos(ANGLE), 0], [0, 0, 1]])

stiffness, mass, _, dofs = hbvib.io.read("wheel_matrices.sti")
stiffness, mass = stiffness.tocsc(), mass.tocsc()
text = open("wheel.inp").read()
parts = re.findall(r"\*NSET,\s*NSET=(\w+)\n([^*]*)", text)
sets = {name: {int(number) for number in re.findall(r"\d+", numbers)} for name, numbers in parts}
lines = re.search(r"\*NODE\n([^*]*)", text).group(1).splitlines()
at = {int(words[0]): np.array(words[1:], float) for words in (line.split(",") for line in lines)}
row = {(int(node), int(direction)): i for i, (node, direction) in enumerate(dofs)}
moving = {node for node, _ in row}


def pairs(of, among, image):
    """Each node with the one at its image."""
    among = sorted(among & moving)
    places = np.array([at[node] for node in among])
    for node in sorted(of & moving):
        apart = np.linalg.norm(places - image(at[node]), axis=1)
        assert apart.min() < 1e-6, (node, apart.min())
        yield node, among[int(apart.argmin())]


faces = list(pairs(sets["LEFT"], sets["RIGHT"], lambda x: TURN @ x))
contacts = list(pairs(sets["RING_RIM"] - sets["RIGHT"], sets["DISK_RIM"], lambda x: x - [0, 0, 2e-4]))
tip = row[max(moving, key=lambda node: at[node][0] + at[node][1] + at[node][2]), 3]


def model_of(stiffness, mass, number, **more):
    """The sector with its contacts, force and damping; number: from rows of the file to those of the matrices."""
    of = lambda node: [number[row[node, direction]] for direction in (1, 2, 3)]
    model = hbvib.Model.sector(stiffness=stiffness, mass=mass, sectors=SECTORS, engine_order=3, left=[of(left) for left, _ in faces],
                               right=[of(right) for _, right in faces], axis=[0, 0, 1])
    model.set_rayleigh(0, 5e-7)
    for a, b in contacts:
        model.add_contact("friction_3d", of(a), of(b), kt=1.8e7, kn=1.8e6, mu=0.3, preload=PRELOAD, normal=(0, 0, 1), tangent=(1, 0, 0))
        # Constant forces hold the preload at rest.
        model.add_force(of(a)[2], -PRELOAD, harmonic=0)
        model.add_force(of(b)[2], PRELOAD, harmonic=0)
    model.add_force(number[tip], 1.0)
    return model


whole = model_of(stiffness, mass, np.arange(len(dofs)))
if len(sys.argv) > 3:
    hertz = np.linspace(float(sys.argv[2]), float(sys.argv[3]), 3)
else:
    lowest = whole.linear_modes(1, diameter=3).omega[0] / (2 * np.pi)
    hertz = lowest * np.linspace(0.99, 1.01, 3)

clock = time.process_time()
kept = sorted({row[node, d] for pair in faces + contacts for node in pair for d in (1, 2, 3)} | {tip})
inner = np.setdiff1d(np.arange(len(dofs)), kept)
k_inner, m_inner = stiffness[inner][:, inner].tocsc(), mass[inner][:, inner].tocsc()
factor = sl.splu(k_inner, permc_spec="MMD_AT_PLUS_A", options=dict(SymmetricMode=True), diag_pivot_thresh=0.0)
static = -factor.solve(stiffness[inner][:, kept].toarray())
solve = sl.LinearOperator(factor.shape, factor.solve)
squares, modes = sl.eigsh(k_inner, count, m_inner, sigma=0, OPinv=solve)
n, order = len(kept), len(kept) + count
reduced_k, reduced_m = np.zeros((order, order)), np.eye(order)
reduced_k[:n, :n] = stiffness[kept][:, kept].toarray() + stiffness[kept][:, inner] @ static
reduced_k[n:, n:] = np.diag(squares)
coupled = mass[kept][:, inner] @ static
reduced_m[:n, :n] = mass[kept][:, kept].toarray() + coupled + coupled.T + static.T @ (m_inner @ static)
reduced_m[n:, :n] = modes.T @ (m_inner @ static + mass[inner][:, kept].toarray())
reduced_m[:n, n:] = reduced_m[n:, :n].T
reduced_k = (reduced_k + reduced_k.T) / 2
print(f"Craig-Bampton: {order} of {len(dofs)}, {count} modes to {np.sqrt(squares.max()) / 2 / np.pi:.0f} Hz, "
      f"{time.process_time() - clock:.1f} s of processor time")
number = np.full(len(dofs), -1)
number[kept] = np.arange(n)
reduced = model_of(reduced_k, reduced_m, number)

clock = time.process_time()
ends = 2 * np.pi * np.array([hertz[0], hertz[-1]])
branch = whole.forced_response(tuple(ends), harmonics=harmonics, response_dof=tip, at=2 * np.pi * hertz)
print(f"all degrees of freedom: {len(branch)} points, {time.process_time() - clock:.1f} s of processor time")
clock, worst = time.process_time(), 0.0
for i, frequency in enumerate(hertz):
    point = branch.at(i).point[0]
    # The reduced model is dense: it is solved at these frequencies alone, from the motion of the kept degrees of freedom.
    guess = np.zeros((harmonics + 1, order), complex)
    guess[:, :n] = branch.harmonics(point)[:, kept]
    found = reduced.forced_response(2 * np.pi * frequency, harmonics=harmonics, response_dof=int(number[tip]), guess=guess)
    a, b = branch.at(i).amplitude[0], found.amplitude[0]
    worst = max(worst, abs(b / a - 1))
    print(f"{frequency:.4f} Hz: {a:.9e}, Craig-Bampton {b:.9e}, slip fraction up to {found.slip_fraction.max():.2f}")
print(f"Craig-Bampton: {time.process_time() - clock:.1f} s of processor time; largest difference {worst:.1e}")
