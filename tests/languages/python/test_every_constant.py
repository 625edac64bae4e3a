"""Every field of the structs that describe a model, perturbed alone, for every kind of contact and layout of a matrix: what is read back
or the response changes, or the call is refused by name, or the header says that it has no effect there."""

import ctypes
import warnings

import numpy as np

from common import check, finish, hbvib
from options import CHANGES, HEADER, bits, hold, outcome, refused, same

warnings.simplefilter("ignore", hbvib.StoppedEarly)
call, new = hbvib._calls._call, hbvib._structs._new
K = 2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1)


def motion(model, omega=0.9):
    return model.forced_response(omega, harmonics=7, response_dof=0).harmonics(0).tobytes()


# Contacts: kind, constants that it has, and the places t1, t2, n at which it acts.
KINDS = {
    "jenkins": (dict(kt=1.0, mu=0.3, preload=1.0), (0,)),
    "friction_2d": (dict(kt=1.0, kn=2.0, mu=0.3, preload=1.0, gap=0.1), (0, 2)),
    "friction_3d": (dict(kt=1.0, kn=2.0, mu=0.3, preload=1.0, gap=0.1), (0, 1, 2)),
    "friction_3d under a constant load": (dict(kt=1.0, mu=0.3, preload=1.0), (0, 1)),
    "unilateral": (dict(kn=2.0, preload=0.1, gap=0.1), (2,)),
    "cubic": (dict(cubic=0.5, kt=0.5), (0,)),
    "regularised": (dict(mu=0.3, preload=0.5, velocity=0.2), (0,)),
}
CONSTANTS = ("kt", "kn", "mu", "preload", "gap", "cubic", "velocity")
AXES = dict(normal=[0.0, 0.6, 0.8], tangent=[1.0, 0.0, 0.0])


def contact(kind, changed, cyclic=False):
    constants, places = KINDS[kind]
    law = new("hbvib_contact", kind=int(hbvib.ContactKind[kind.split()[0].upper()]), **constants)
    for place in places:
        law.dof_a[place] = place
    for name, value in changed.items():
        if isinstance(value, tuple):
            getattr(law, name)[value[0]] = value[1]
        elif isinstance(value, list):
            getattr(law, name)[:] = value
        else:
            setattr(law, name, value)
    model = (hbvib.Model.cyclic(sectors=5, engine_order=1, mass=np.eye(3), stiffness=K, rayleigh=(0.05, 0.05)) if cyclic
             else hbvib.Model(mass=np.eye(3), stiffness=K, rayleigh=(0.05, 0.05)))
    call("hbvib_model_add_contact", model.handle, law, ctypes.c_int64())
    for dof in range(3):
        model.add_force(dof, 0.3 + 0.1j * dof)
    return motion(model)


FIELDS = {name for name, _ in hbvib.structs["hbvib_contact"]._fields_}
check("every field of a contact is examined", FIELDS == {"struct_size", "kind", "dof_a", "dof_b", "sector_offset", "normal", "tangent",
    "rotation", "arm", "turn", *CONSTANTS})
for kind, (constants, places) in KINDS.items():
    def run(**changed):
        return contact(kind, changed)

    def turning(**changed):
        return contact(kind, {"dof_b": [1, 1, 1], "dof_a": [0, 0, 0], **changed}, cyclic=True)

    reference = outcome(run)
    hold(refused("struct_size"), f"{kind}: struct_size", run, reference, struct_size=8)
    hold(refused("kind"), f"{kind}: a kind that is none", run, reference, kind=77)
    hold(refused("kind"), f"{kind}: a kind that is read back only", run, reference, kind=int(hbvib.ContactKind.TABLE))
    for name in CONSTANTS:
        if name in constants:
            hold(CHANGES, f"{kind}: {name}", run, reference, **{name: 1.7 * constants[name]})
            hold(refused(name), f"{kind}: {name} = NaN", run, reference, **{name: float("nan")})
        elif kind == "friction_3d under a constant load" and name == "kn":
            hold(refused("kn"), f"{kind}: {name}", run, reference, kn=0.7)
        else:
            hold(refused(name), f"{kind}: {name}", run, reference, **{name: 0.7})
    for place in range(3):
        if place in places:
            hold(CHANGES, f"{kind}: other side at place {place}", run, reference, dof_b=(place, (place + 1) % 3))
            hold(refused("dof_b"), f"{kind}: a side beyond the structure", run, reference, dof_b=(place, 3))
            hold(refused("dof_a"), f"{kind}: a side below the ground", run, reference, dof_a=(place, -2))
        elif not (kind == "friction_3d under a constant load" and place == 2):
            hold(refused("dof_a"), f"{kind}: a place that is unused", run, reference, dof_a=(place, place))
            hold(refused("dof_b"), f"{kind}: the other side of it", run, reference, dof_b=(place, place))
    hold(refused("sector_offset"), f"{kind}: sector_offset of a plain structure", run, reference, sector_offset=1)

    def oriented(**changed):
        return contact(kind, {"dof_a": [0, 1, 2], **AXES, **changed})

    if kind == "friction_3d under a constant load":  # with directions its load varies
        hold(refused("kn"), f"{kind}: normal and tangent", run, reference, dof_a=[0, 1, 2], **AXES)
        continue
    along = outcome(oriented)
    if kind in ("unilateral", "friction_2d", "friction_3d"):
        hold(CHANGES, f"{kind}: normal", oriented, along, normal=[0.0, 1.0, 0.0])
    hold(same("of any length"), f"{kind}: length of the normal", oriented, along, normal=[0.0, 1.2, 1.6])
    hold(same("of any length"), f"{kind}: length of the tangent", oriented, along, tangent=[2.0, 0.0, 0.0])
    hold(refused("tangent"), f"{kind}: a tangent along the normal", oriented, along, tangent=[0.0, 0.6, 0.8])
    hold(refused("normal"), f"{kind}: no normal", oriented, along, normal=[0.0, 0.0, 0.0])
    body = {"dof_a": [-1, 1, 2], "rotation": [-1, -1, 0], "arm": [0.5, 0.2, 0.3]}
    if kind in ("friction_2d", "friction_3d"):
        turned = outcome(oriented, **body)
        hold(CHANGES, f"{kind}: rotation", oriented, turned, **{**body, "rotation": [-1, 0, -1]})
        hold(CHANGES, f"{kind}: arm", oriented, turned, **{**body, "arm": [0.5, 0.3, 0.3]})
        hold(CHANGES, f"{kind}: turn", lambda **o: oriented(**{**body, "dof_b": [0, -1, -1], "turn": 0.1, **o}),
             outcome(oriented, **body, dof_b=[0, -1, -1]))
    hold(refused("rotation"), f"{kind}: a rotation beyond the structure", oriented, along, rotation=[3, -1, -1])
    hold(refused("named twice"), f"{kind}: a rotation that is a translation", oriented, along, rotation=[0, -1, -1])
    hold(refused("arm or turn"), f"{kind}: turn = NaN", oriented, along, turn=float("nan"))
    hold(refused("without directions"), f"{kind}: turn without a normal", run, reference, turn=0.1)
    if kind not in ("unilateral", "friction_3d"):
        hold(CHANGES, f"{kind}: tangent", oriented, along, tangent=[0.5, 0.8, -0.6])
        hold(refused("tangent"), f"{kind}: no tangent", oriented, along, tangent=[0.0, 0.0, 0.0])

# Sides in other sectors count in a wheel.
def offset(**changed):
    law = new("hbvib_contact", kind=1, **{**KINDS["jenkins"][0], **changed})
    law.dof_a[0], law.dof_b[0] = 0, 1
    model = hbvib.Model.cyclic(sectors=5, engine_order=1, mass=np.eye(3), stiffness=K, rayleigh=(0.05, 0.05))
    call("hbvib_model_add_contact", model.handle, law, ctypes.c_int64())
    model.add_force(0, 0.3)
    return motion(model)


hold(CHANGES, "sector_offset of a wheel", offset, outcome(offset), sector_offset=1)

# A patch takes its sides, normals and tangents from its arrays.
def patch(**changed):
    law = new("hbvib_contact", kind=int(hbvib.ContactKind.FRICTION_3D), kt=1.0, kn=2.0, mu=0.3, sector_offset=0)
    for name, value in changed.items():
        if isinstance(value, list):
            getattr(law, name)[: len(value)] = value
        else:
            setattr(law, name, value)
    model = hbvib.Model(mass=np.eye(3), stiffness=K, rayleigh=(0.05, 0.05))
    a, normal = np.array([0, 1, 2]), np.array([0.0, 0.0, 1.0])
    call("hbvib_model_add_patch", model.handle, law, 1, a, None, normal, None, np.array([1.0]), np.array([0.5]), None, ctypes.c_int64())
    model.add_force(0, 0.3)
    return motion(model)


reference = outcome(patch)
for name, value in (("dof_a", [0]), ("dof_b", [1]), ("normal", [0.0, 1.0]), ("tangent", [1.0])):
    hold(same("degrees of freedom, normal and tangent are ignored"), f"patch: {name} of its law", patch, reference, **{name: value})
hold(refused("struct_size"), "patch: struct_size of its law", patch, reference, struct_size=8)
hold(CHANGES, "patch: a constant of its law", patch, reference, kt=2.0)

# Matrices: every layout, and what each does not have.
VALUES = {"dense": np.array([2.0, 0.5, 0.5, 3.0]), "sparse": np.array([2.0, 0.5, 0.5, 3.0])}


def matrix(layout, **base):
    def run(**changed):
        sparse = dict(storage=2, col_ptr=np.array([0, 2, 4]), row_idx=np.array([0, 1, 0, 1])) if layout == "sparse" else {}
        given = {"rows": 2, "cols": 2, "values": VALUES[layout], **sparse, **base, **changed}
        model = hbvib.Model(2)
        call("hbvib_model_set_matrix", model.handle, int(hbvib.MatrixKind.STIFFNESS), new("hbvib_matrix", **given))
        return bits(model.matrix("stiffness"))
    return run


dense, sparse = matrix("dense"), matrix("sparse")
wide = matrix("dense", values=np.arange(1.0, 9.0), part=3, ld=2)
general = matrix("dense", values=np.array([2.0, 0.5, 0.6, 3.0]), part=3)
MATRIX = {
    "struct_size": [(refused("struct_size"), dense, 8)],
    "storage": [(CHANGES, general, 1), (refused("storage"), dense, 3)],
    "scalar": [(CHANGES, matrix("dense", values=np.array([2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0]), part=3), 1),
               (refused("scalar"), dense, 2)],
    "part": [(CHANGES, general, 1), (CHANGES, general, 2), (refused("stiffness[1,0] and stiffness[0,1] differ"), general, 0),
             (refused("part"), dense, 9)],
    "rows": [(refused("stiffness"), dense, 3), (refused("stiffness"), sparse, 1)],
    "cols": [(refused("stiffness"), dense, 3), (refused("stiffness"), sparse, 1)],
    "ld": [(CHANGES, wide, 4), (refused("ld"), dense, 1), (refused("ld"), dense, -1), (same("Dense: distance of columns"), sparse, 9)],
    "values": [(CHANGES, dense, np.array([3.0, 0.5, 0.5, 3.0])), (refused("values"), dense, None),
               (refused("stiffness"), dense, np.array([2.0, np.nan, np.nan, 3.0]))],
    "col_ptr": [(refused("col_ptr"), sparse, None), (refused("col_ptr"), sparse, np.array([0, 3, 2])),
                (same("Sparse only: cols + 1 offsets"), dense, np.array([0, 2, 4]))],
    "row_idx": [(refused("row_idx"), sparse, None), (refused("row"), sparse, np.array([0, 2, 0, 1])),
                (same("Sparse only: row of each number"), dense, np.array([0, 1, 0, 1]))],
    "index_base": [
        (refused("col_ptr"), matrix("sparse", col_ptr=np.array([1, 3, 5]), row_idx=np.array([1, 2, 1, 2]), index_base=1), 0),
        (refused("index_base"), dense, 7), (same("and of the indices in error sentences"), dense, 1),
    ],
    "reserved": [(refused("reserved"), dense, 3)],
}
check("every field of a matrix is examined", {name for name, _ in hbvib.structs["hbvib_matrix"]._fields_} == set(MATRIX))
for field, claims in MATRIX.items():
    for number, (claim, function, value) in enumerate(claims):
        hold(claim, f"matrix: {field}, claim {number}", function, outcome(function), **{field: value})

# A law of the caller.
FORCE = hbvib._calls._TYPES["force_fn"]


def spring(_, pointer):
    """0.5 u + 0.3 u^2 + 0.1 v, which is not odd."""
    at = pointer.contents
    count = at.samples * at.n
    u, v, f, df_du, df_dv = (
        (ctypes.c_double * count).from_address(address) if address else None for address in (at.u, at.v, at.f, at.df_du, at.df_dv))
    for i in range(count):
        velocity = v[i] if v else 0.0
        f[i] = 0.5 * u[i] + 0.3 * u[i] ** 2 + 0.1 * velocity
        df_du[i] = 0.5 + 0.6 * u[i]
        if df_dv:
            df_dv[i] = 0.1
    return 0


def odd(_, pointer):
    at = pointer.contents
    count = at.samples * at.n
    u, f, df_du = ((ctypes.c_double * count).from_address(address) for address in (at.u, at.f, at.df_du))
    for i in range(count):
        f[i], df_du[i] = 0.5 * u[i] + 0.3 * u[i] ** 3, 0.5 + 0.9 * u[i] ** 2
    return 0


SPRING, ODD = FORCE(spring), FORCE(odd)


def law(function=ODD, **base):
    def run(**changed):
        model = hbvib.Model(mass=np.eye(3), stiffness=K, rayleigh=(0.05, 0.05))
        model.add_force(0, 0.3)
        given = {"dofs": np.array([0]), "n": 1, **base, **changed}
        force = given.pop("force", function)
        described = new("hbvib_user_force", **given)
        if force is not None:
            described.force = force
        call("hbvib_model_add_user_force", model.handle, described, ctypes.c_int64())
        branch = model.forced_response(0.9, harmonics=7, response_dof=0)
        return branch.harmonics(0).tobytes(), str(branch.reduction)
    return run


USER_FORCE = {
    "struct_size": [(refused("struct_size"), law(), 8)],
    "uses_velocity": [(CHANGES, law(SPRING), 1), (refused("uses_velocity"), law(), 2)],
    "is_odd": [(CHANGES, law(), 1), (refused("is_odd"), law(SPRING), 1), (refused("is_odd"), law(), 2)],
    "reserved": [(refused("reserved"), law(), 1)],
    "dofs": [(CHANGES, law(), np.array([1])), (refused("dof"), law(), np.array([3])), (refused("dofs"), law(), None)],
    "n": [(refused("n = 0"), law(), 0), (refused("n = -1"), law(), -1)],
    "states": [(refused("states"), law(), -1)],
    "samples": [(CHANGES, law(), 32), (refused("samples"), law(), -1), (refused("samples"), law(), 3)],
    "force": [(CHANGES, law(), SPRING), (refused("force"), law(), None)],
    "user": [(same("Passed to the callback."), law(), np.zeros(1))],
}
check("every field of a law of the caller is examined",
      {name for name, _ in hbvib.structs["hbvib_user_force"]._fields_} == set(USER_FORCE))
for field, claims in USER_FORCE.items():
    for number, (claim, function, value) in enumerate(claims):
        hold(claim, f"law of the caller: {field}, claim {number}", function, outcome(function), **{field: value})

# A sector with faces.
ENDS = np.array([[2.0, -1.0, 0.0], [-1.0, 3.0, -1.0], [0.0, -1.0, 1.5]])


def sector(components=1, **base):
    n = 3 * components
    turned = np.kron(ENDS, np.eye(components)) + 0.1 * np.ones((n, n))

    def run(**changed):
        left, right = np.arange(components), np.arange(2 * components, n)
        given = {"ndof": n, "sectors": 6, "engine_order": 1, "components": components, "left": left, "left_len": components,
                 "right": right,
                 "right_len": components, "frame": 0 if components == 3 else 1, **base, **changed}
        handle = ctypes.c_void_p()
        call("hbvib_cyclic_from_sector", new("hbvib_sector", **given), handle)
        model = hbvib.Model.__new__(hbvib.Model)
        model._handle, model._kept = handle.value, []
        model.set_matrix("stiffness", turned)
        model.set_matrix("mass", np.eye(n))
        model.set_rayleigh(0.02, 0.02)
        model.add_force(components, 1.0)
        return motion(model, 0.8), model.engine_order, model.sectors
    return run


angle = np.pi / 3
POINTS = np.array([[1.0, 0.0, 0.0]]), np.array([[np.cos(angle), np.sin(angle), 0.0]])
cylinder, cartesian = sector(), sector(3)
placed = sector(3, left_coordinates=POINTS[0], right_coordinates=POINTS[1])
NO_FRAME = "It decides about the axes of a Cartesian frame and about the check of coordinates, not about the wave."
SECTOR = {
    "struct_size": [(refused("struct_size"), cylinder, 8)],
    "frame": [(CHANGES, cartesian, 1), (refused("frame"), cylinder, 2), (refused("components"), cylinder, 0)],
    "ndof": [(refused("ndof"), cylinder, 0), (refused("right"), cylinder, 2), (refused("stiffness"), cylinder, 4)],
    "sectors": [(CHANGES, cylinder, 8), (refused("sectors"), cylinder, 1)],
    "engine_order": [(CHANGES, cylinder, 2), (CHANGES, cylinder, -1)],
    "components": [(refused("components"), cylinder, 0), (refused("components"), cylinder, 2), (refused("components"), cartesian, 6)],
    "left": [(CHANGES, cylinder, np.array([1])), (refused("left"), cylinder, np.array([3])), (refused("left"), cylinder, None)],
    "left_len": [(refused("left"), cylinder, 0), (refused("left"), cylinder, -1), (refused("left"), cartesian, 2)],
    "right": [(CHANGES, cylinder, np.array([1])), (refused("right"), cylinder, np.array([0])), (refused("right"), cylinder, None)],
    "right_len": [(refused("right"), cylinder, 0), (refused("right"), cylinder, -1), (refused("right"), cartesian, 2)],
    "fixed": [(CHANGES, sector(3, fixed=np.array([4]), fixed_len=1), np.array([5])),
              (refused("fixed"), sector(3, fixed=np.array([4]), fixed_len=1), np.array([19]))],
    "fixed_len": [(CHANGES, sector(3, fixed=np.array([4, 5]), fixed_len=1), 2), (refused("fixed_len"), cylinder, -1),
                  (refused("fixed"), cylinder, 1)],
    "axis": [(CHANGES, cartesian, [1.0, 0.0, 0.0]), (same("of any length"), cartesian, [0.0, 0.0, 2.0]),
             (refused("axis"), cartesian, [0.0, 0.0, 0.0]),
             (same("The axis has no effect in a cylindrical frame without coordinates."), cylinder, [1.0, 0.0, 0.0])],
    "direction": [(CHANGES, cartesian, -1), (refused("direction"), cylinder, 2), (same(NO_FRAME), cylinder, -1)],
    "reserved": [(refused("reserved"), cylinder, 1)],
    "left_coordinates": [(refused("pair 0: its nodes"), placed, np.array([[1.1, 0.0, 0.0]])), (refused("coordinates"), placed, None)],
    "right_coordinates": [(refused("pair 0: its right node"), placed, POINTS[0]), (refused("coordinates"), cylinder, POINTS[1])],
}
check("every field of a sector is examined", {name for name, _ in hbvib.structs["hbvib_sector"]._fields_} == set(SECTOR))
for field, claims in SECTOR.items():
    for number, (claim, function, value) in enumerate(claims):
        hold(claim, f"sector: {field}, claim {number}", function, outcome(function), **{field: value})

finish(250)
