"""Nodes of a sector on the axis of the wheel, against the whole wheel that is joined node by node; modal coordinates of a response."""

import numpy as np

from common import check, close, finish, hbvib, raises

SECTORS = 6
ANGLE = 2 * np.pi / SECTORS
TURN = np.array([[np.cos(ANGLE), -np.sin(ANGLE), 0], [np.sin(ANGLE), np.cos(ANGLE), 0], [0, 0, 1]])
ON_AXIS, LEFT, RIGHT = [[0, 1, 2]], [[3, 4, 5]], [[9, 10, 11]]
A = np.random.default_rng(0).standard_normal((12, 12))
# A sector of a node on the axis, one on each face and one inside.
STIFFNESS, MASS = A @ A.T + np.eye(12), np.diag(np.linspace(1, 2, 12))


def whole(of):
    """The matrix of the wheel: the node on the axis, then left and inner node of each sector in its own frame."""
    size = 3 + 6 * SECTORS
    full = np.zeros((size, size))
    for s in range(SECTORS):
        join = np.zeros((12, size))
        join[:3, :3] = np.linalg.matrix_power(TURN, s).T
        join[3:9, 3 + 6 * s : 9 + 6 * s] = np.eye(6)
        after = 3 + 6 * ((s + 1) % SECTORS)
        join[9:, after : after + 3] = TURN
        full += join.T @ of @ join
    return full


def sector(stiffness, mass, engine_order=1, left=LEFT, right=RIGHT, **more):
    return hbvib.Model.sector(stiffness=stiffness, mass=mass, sectors=SECTORS, engine_order=engine_order, left=left, right=right, **more)


def frequencies(model):
    return np.sort(np.concatenate([model.linear_modes(6, diameter=d).omega for d in (0, 1, -1, 2, -2, 3)]))


right = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(whole(MASS), whole(STIFFNESS))).real))
model = sector(STIFFNESS, MASS, on_axis=ON_AXIS)
check("three rows more", model.ndof == 15, model.ndof)
found = frequencies(model)
close("frequencies of the wheel", found[:30], right[:30], 1e-5)
alone = frequencies(sector(STIFFNESS, MASS))
check("which a node of its own in each sector does not have", np.abs(alone[:12] / right[:12] - 1).max() > 1e-3, alone[:12])
try:
    from scipy import sparse

    close("sparse matrices", frequencies(sector(sparse.csr_matrix(STIFFNESS), sparse.csc_matrix(MASS), on_axis=ON_AXIS)), found, 1e-10)
except ImportError:
    check("scipy is not there", True)

# The way of C and Fortran: springs to the node itself in the next sector.
model = sector(STIFFNESS, MASS)
model.add_springs([0, 1, 2], [0, 1, 2], 1e6 * STIFFNESS.diagonal()[:3].max(), sector_offset=1)
close("springs of the caller", frequencies(model)[:30], found[:30], 1e-8)

positions = np.array([[1.0, 0.2, 0.3]])
for engine_order, moving in ((0, [2]), (1, [0, 1]), (2, [])):
    model = sector(STIFFNESS, MASS, engine_order, damping=0.01 * STIFFNESS, on_axis=ON_AXIS, coordinates=(positions, positions @ TURN.T))
    model.add_force(6, 1.0)
    x = model.forced_response(0.5, harmonics=1, response_dof=6).harmonics(0)[1]
    still = [d for d in range(3) if d not in moving]
    check(f"order {engine_order}: still", np.abs(x[still]).max(initial=0.0) < 1e-5 * np.abs(x).max(), x[:3])
    check(f"order {engine_order}: moving", not moving or np.abs(x[moving]).min() > 1e-3 * np.abs(x).max(), x[:3])
    force = np.zeros(3 + 6 * SECTORS, complex)
    for s in range(SECTORS):
        force[3 + 6 * s + 3] = np.exp(-1j * ANGLE * engine_order * s)
    solution = np.linalg.solve(whole(STIFFNESS) * (1 + 0.5j * 0.01) - 0.25 * whole(MASS), force)
    close(f"order {engine_order}: the response of the wheel", x[:9], solution[:9], 1e-5)

for more, words in (
    ({"on_axis": [0, 1, 2]}, "needs (nodes, 3)"),
    ({"on_axis": [[0, 1, 12]]}, "needs 0 .. 11"),
    ({"on_axis": ON_AXIS, "frame": "cylindrical"}, "cartesian"),
):
    raises(f"refused: {words}", ValueError, sector, STIFFNESS, MASS, words=words, **more)

# A plain structure that slips: its motion in modes of a finite-element program.
n = 8
k = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
m = np.diag(np.linspace(1, 2, n)) + 0.1 * np.eye(n, k=1) + 0.1 * np.eye(n, k=-1)
model = hbvib.Model(mass=m, stiffness=k, rayleigh=(0, 0.02))
model.add_contact("jenkins", 3, kt=1, mu=0.3, preload=1)
model.add_force(0, 0.2)
branch = model.forced_response((0.3, 0.6), harmonics=5)
point = int(branch.peaks().point[0])
x = branch.harmonics(point)
stress = np.diff(np.eye(n), axis=0)  # of the springs
modes = model.linear_modes(n, contacts="free").shapes
q, lacking = branch.modal_coordinates(point, modes, m, stiffness=k)
close("stresses from all modes", q @ (modes @ stress.T), x @ stress.T, 1e-12)
check("nothing is lacking", lacking.max() < 1e-10, lacking)
few = modes[:3] * np.array([[1], [2j], [-3]]) + modes[3]
q, lacking = branch.modal_coordinates(point, few, m, stiffness=k)
root = np.linalg.cholesky(m).T
own = np.linalg.lstsq(root @ few.T, root @ x.T, rcond=None)[0]
close("least squares in the mass", q, own.T, 1e-12)
rest = x.T - few.T @ own
for measure, told in zip((m, k), lacking):
    shares = [np.sqrt((r.conj() @ measure @ r).real / max((z.conj() @ measure @ z).real, 1e-300)) for r, z in zip(rest.T, x)]
    close("the share that modes lack", told[1:], shares[1:], 1e-10)
raises("a mode twice", ValueError, branch.modal_coordinates, point, modes[[0, 1, 0]], m, words="sums of others")
raises("another size", ValueError, branch.modal_coordinates, point, modes[:, 1:], m, words="needs ndof = 8")
raises("a mode without mass", ValueError, branch.modal_coordinates, point, 0 * modes[:2], m, words="does not move a mass")
finish(23)
