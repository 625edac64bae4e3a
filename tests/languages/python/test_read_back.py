"""Models are read back as they were given: a model made again from what was read has the same results to the bit."""

import numpy as np
from scipy import sparse

from common import bits, check, close, finish, hbvib, raises, ring_damper, solve

# Every law, with sides, constants, directions and offsets.
GIVEN = [
    ("jenkins", 0, 1, dict(kt=2.0, mu=0.3, preload=1.5)),
    ("friction_2d", [0, 2], [1, 3], dict(kt=2.0, kn=3.0, mu=0.3, gap=-0.25)),
    ("friction_3d", [0, 1, 2], [3, 4, 5], dict(kt=2.0, kn=3.0, mu=0.3, preload=1.0, normal=(0.0, 0.6, 0.8))),
    ("friction_3d", [0, 1], hbvib.GROUND, dict(kt=2.0, mu=0.0, preload=1.0)),
    ("unilateral", 2, hbvib.GROUND, dict(kn=3.0, gap=0.125)),
    ("cubic", 4, 5, dict(kt=0.5, cubic=-2.0)),
    ("regularised", 5, hbvib.GROUND, dict(mu=0.25, preload=2.0, velocity=1e-3)),
]
model = hbvib.Model.cyclic(6, sectors=5, engine_order=-2, mass=np.eye(6), stiffness=4 * np.eye(6))
check("the engine order is the given one", model.engine_order == -2)
for number, (kind, a, b, constants) in enumerate(GIVEN):
    offset = number % 2
    check(f"{kind} has the next number", model.add_contact(kind, a, b, sector_offset=offset, **constants) == number)
    found = model.contact(number)
    check(f"{kind} has its kind", found.kind.name == kind.upper() and found.sector_offset == offset, found)
    for name, value in constants.items():
        close(f"{name} of {kind}", found.constants[name], value, 1e-15) if np.any(value) else check(
            f"{name} of {kind} is zero", found.constants[name] == 0
        )
    more = set(found.constants) - set(constants)
    check(f"{kind} has no other constant", more <= {"tangent"}, more)
check("sides have the ground in unused places", model.contact(1).a == (0, -1, 2) and model.contact(3).b == (-1, -1, -1))
model.add_table(0, displacement=[-1, 0, 1], force=[-1, 0, 2])
model.add_spring_damper(0, damper=[1.0])
model.add_user_force([0], lambda call: None)
for number, name in zip(range(7, 10), ("TABLE", "POLYNOMIAL", "CALLER_LAW")):
    check(f"a {name} is told as such", model.contact(number).kind.name == name and not model.contact(number).constants)
raises("a contact that is not there", IndexError, model.contact, 10, words="0 .. 9")
raises("kinds read back only are not given", ValueError, model.add_contact, hbvib.ContactKind.TABLE, 0, words="needs 1 .. 6")

# Normal loads at speed stay as they were given.
model.set_preload(1, 0.5, 0.25)
model.set_speed(2.0)
found = model.contact(1)
check("load and gap are those at rest", (found.constants["preload"], found.per_speed2) == (0.5, 0.25), found)
check("the gap is the given one", found.constants["gap"] == -0.25, found)

# Forces and springs.
model.add_force(3, 1 - 2j, 4)
model.add_unbalance(0, 1, 0.5, np.pi / 2)
forces = model.forces
check("forces come in their order", forces.dof.tolist() == [3, 0, 1] and forces.harmonic.tolist() == [4, 1, 1])
close("values are complex", forces.force, [1 - 2j, 0.5j, 0.5], 1e-15)
check("unbalance is marked", forces.unbalance.tolist() == [False, True, True])
model.add_springs([0, 1], [hbvib.GROUND, 2], [1.0, -2.0], sector_offset=[0, -1])
springs = model.springs
check(
    "springs come in their order",
    [column.tolist() for column in springs] == [[0, 1], [-1, 2], [0, -1], [1.0, -2.0]],
    springs,
)

# Matrices: of every storage, with fixed degrees of freedom, in blocks.
rng = np.random.default_rng(7)
a = rng.standard_normal((6, 6))
hermitian = a + a.T + 1j * (a - a.T)
for name, part in (("stiffness", "full"), ("damping", "lower")):
    model.set_matrix(name, hermitian, part)
    check(f"{name} is read back to the bit", (model.matrix(name) == hermitian).all())
check("a real matrix is real", model.matrix("mass").dtype == float and (model.matrix("mass") == np.eye(6)).all())
check("a matrix that was not given is zero", not model.matrix("gyroscopic").any())
thin = model.matrix("mass", sparse=True)
check("a sparse one is sparse", sparse.issparse(thin) and thin.nnz == 6)
model.set_coupling("stiffness", a)
check("couplings are blocks", (model.matrix("stiffness", "next") == a).all())
check("one that was not given is not there", not model.matrix("stiffness", hbvib.Block.PREVIOUS).any())
plain = hbvib.Model(mass=np.eye(3), stiffness=[[2, -1, 0], [-1, 2, -1], [0, -1, 2]])
plain.fix([1])
check("rows of fixed degrees of freedom are empty", (plain.matrix("stiffness") == np.diag([2, 0, 2])).all())
raises("no such block", ValueError, plain.matrix, "mass", "above", words="own, next, previous")
waves = hbvib.Model.cyclic(1, sectors=4, engine_order=1)
waves.set_diameter("mass", 1, 1)
raises("matrices of diameters have no blocks", NotImplementedError, waves.matrix, "mass", words="per nodal diameter")

# A sector with faces: its blocks are those of a model that is given by blocks.
k = np.array([[1.0, -1.0], [-1.0, 1.0]])
faces = hbvib.Model.sector(
    stiffness=k, mass=np.eye(2) / 2, sectors=8, engine_order=2, left=[0], right=[1], frame="cylindrical"
)
check("own block of a sector", (faces.matrix("stiffness") == [[2, 0], [0, 0]]).all(), faces.matrix("stiffness"))
check("coupling of a sector", (faces.matrix("stiffness", "next") == [[-1, 0], [0, 0]]).all())

# The same bits from a model made of what was read.
first = ring_damper()
again = hbvib.Model.cyclic(
    sectors=first.sectors,
    engine_order=first.engine_order,
    mass=first.matrix("mass"),
    stiffness=first.matrix("stiffness"),
    coupling=dict(stiffness=first.matrix("stiffness", "next")),
    rayleigh=(0, 1.5e-6),
)
for number in range(first.contacts):
    kind, side_a, side_b, offset, constants, _ = first.contact(number)
    again.add_contact(kind, side_a, side_b, sector_offset=offset, **constants)
for dof, harmonic, force, _ in zip(*first.forces):
    again.add_force(dof, force, harmonic)
check("a model of what was read has the same results to the bit", bits(solve(first)) == bits(solve(again)))

finish(60)
