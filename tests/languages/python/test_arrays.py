"""Arrays cross without copies where they can, are converted where that loses nothing, and are refused else."""

import copy
import gc
import weakref

import numpy as np

from common import COUPLING, MASS, STIFFNESS, bits, check, close, finish, hbvib, oscillator, raises, ring_damper, solve

model = ring_damper()
branch = solve(model)
reference = bits(branch)

# Views: the address of the library, read-only, alive as long as anyone looks.
for field in hbvib.Field:
    try:
        array = branch.field(field)
    except hbvib.ArgumentError:
        check(
            f"{field.name} is missing from a forced response only if it is of modes, stability, freedom or a parameter response",
            field in (2, 3, 4, 10, 11, 12, 13, 15, 16, 17, 18, 19, 20, 21, 22),
            field,
        )
        continue
    view = hbvib._structs._new("hbvib_view")
    hbvib.lib.hbvib_branch_field(branch.handle, field, view)
    check(f"{field.name} is the library's memory", array.ctypes.data == view.data)
    check(f"two views of {field.name} are one memory", np.shares_memory(array, branch.field(field.name.lower())))
    check(f"{field.name} covers the curve", array.shape[0] == len(branch) and not array.flags.owndata)
    raises(f"{field.name} cannot be written", ValueError, array.__setitem__, 0, 1.0)
    raises(f"{field.name} cannot be made writable", ValueError, array.setflags, write=True)
check("a field is numpy's own array", type(branch.omega) is np.ndarray and branch.omega.dtype == np.float64)
check("fields compute", np.all(np.diff(branch.omega[[0, -1]]) > 0) and branch.slip_fraction.shape == (len(branch), 1))

del array
gc.collect()
try:
    branch.damping_ratio
except hbvib.Error as error:
    refusal = error  # its traceback reaches the frame that asked for the field
fresh = solve(model)
try:
    fresh.damping_ratio
except hbvib.Error as error:
    refusal = error
fresh.free()
check("a field that was refused keeps no memory", fresh is not None and refusal is not None)
omega = branch.omega[::2]
raises("free with a live view is BufferError, as of a memoryview", BufferError, branch.free)
check("and the branch is as before", bits(branch) == reference)
kept = omega.copy()
alive = weakref.ref(branch)
del branch
gc.collect()
check("a slice of a view keeps the branch", alive() is not None and np.array_equal(kept, omega))
base = omega
while isinstance(base, np.ndarray):
    base = base.base
check("its base leads to the owner", base.branch is alive())
del omega, base
gc.collect()
check("with the last view the branch goes", alive() is None)

with solve(model) as branch:
    peak = branch.amplitude.max()
raises("a with block frees", hbvib.FreedError, lambda: branch.omega)
raises("free again is ValueError", ValueError, branch.free)
check("numbers copied out remain", peak > 0)


def leave(error):
    with solve(model) as branch:
        omega = branch.omega
        if error:
            raise error
    return omega


raises("an exception leaves a with block before the arrays do", ZeroDivisionError, leave, ZeroDivisionError())
raises("else arrays still in use are told", BufferError, leave, None)
unchanged = solve(model)
check("a copy of a branch, which never changes, is the branch", copy.copy(unchanged) is copy.deepcopy(unchanged) is unchanged)


# Matrices: every layout and type gives the same bits.
def with_stiffness(matrix, **options):
    other = ring_damper()
    other.set_matrix("stiffness", matrix, **options)
    return bits(solve(other))


def address(matrix):
    return hbvib._structs._matrix(matrix, "full").values


wide = np.full((6, 9), np.nan)
wide[1:5, 2:6] = STIFFNESS
tall = np.asfortranarray(wide)
every_other = np.full((8, 8), np.nan)
every_other[::2, ::2] = STIFFNESS
layouts = dict(
    c=STIFFNESS,
    fortran=np.asfortranarray(STIFFNESS),
    rows_of_wider=wide[1:5, 2:6],
    columns_of_taller=tall[1:5, 2:6],
    transposed=wide[1:5, 2:6].T,
    every_other_row=np.repeat(STIFFNESS, 2, 0)[::2],
)
for name, matrix in layouts.items():
    check(f"{name}: no copy", address(matrix) == matrix.ctypes.data)
    check(f"{name}: same bits", with_stiffness(matrix) == reference)
check("strides that fit no layout are copied", with_stiffness(every_other[::2, ::2]) == reference)
check("negative strides are copied", with_stiffness(STIFFNESS[::-1, ::-1].copy()[::-1, ::-1]) == reference)
check("lists are arrays", with_stiffness(STIFFNESS.tolist()) == reference)
for dtype in (np.int64, np.int32, np.float32, ">f8"):
    check(f"{dtype} loses nothing", with_stiffness(STIFFNESS.astype(dtype)) == reference)
check(
    "complex64 loses nothing",
    with_stiffness(STIFFNESS.astype(np.complex64)) == with_stiffness(STIFFNESS.astype(complex)),
)
check("lower triangles", with_stiffness(np.tril(STIFFNESS), part="lower") == reference)
check("upper triangles", with_stiffness(np.triu(STIFFNESS), part=hbvib.Part.UPPER) == reference)
unaligned = np.zeros(129, np.uint8)[1:].view(np.float64).reshape(4, 4)
unaligned[:] = STIFFNESS
check("numbers off their alignment are copied", with_stiffness(unaligned) == reference)


class Csc:
    """Enough of a sparse matrix."""

    def __init__(self, matrix):
        filled = [np.flatnonzero(column) for column in matrix.T]
        self.shape = matrix.shape
        self.indices = np.concatenate(filled).astype(np.int32)
        self.indptr = np.cumsum([0] + [len(rows) for rows in filled]).astype(np.int32)
        self.data = np.concatenate([column[rows] for column, rows in zip(matrix.T, filled)])

    def tocsc(self):
        return self


torn = Csc(STIFFNESS)
torn.indices = torn.indices[:-1]
raises("a sparse matrix that is torn", ValueError, model.set_matrix, "stiffness", torn, words="indptr ends at")
torn.indptr = torn.indptr[:-1]
raises("a sparse matrix without its last column", ValueError, model.set_matrix, "stiffness", torn)
check("anything with tocsc is a sparse matrix", with_stiffness(Csc(STIFFNESS)) == reference)
try:
    import scipy.sparse
except ImportError:
    scipy = None
if scipy:
    for kind in "csc csr coo lil dok dia bsr".split():
        matrix = scipy.sparse.csr_matrix(STIFFNESS).asformat(kind)
        check(f"scipy's {kind} matrix", with_stiffness(matrix) == reference)
    check("scipy's sparse arrays", with_stiffness(scipy.sparse.csr_array(STIFFNESS)) == reference)

for matrix, kind in (
    (STIFFNESS.astype(object), TypeError),
    (STIFFNESS.astype(str), TypeError),
    (np.ma.masked_equal(STIFFNESS, 0), TypeError),
    (STIFFNESS[0], ValueError),
    (STIFFNESS[:3], ValueError),
    (STIFFNESS[:, :3], ValueError),
    (STIFFNESS[None], ValueError),
    (STIFFNESS[:0], ValueError),
    ([[1, 2], [3]], ValueError),
    (None, (TypeError, ValueError)),
    (STIFFNESS.astype(np.longdouble), TypeError),
    (np.triu(STIFFNESS), ValueError),
    (np.where(STIFFNESS, STIFFNESS, np.nan), ValueError),
):
    raises(f"a bad matrix is refused: {matrix!r}", kind, model.set_matrix, "stiffness", matrix)
    check("and the model solves to the same bits", bits(solve(model)) == reference)

# Vectors.
twins = hbvib.Model(2, mass=np.eye(2), stiffness=np.eye(2))
raises("complex where real is wanted", TypeError, twins.add_springs, 0, 1, 1j)
raises("fractions are no degrees of freedom", TypeError, twins.add_springs, [0.0], [1], [1.0])
raises("lengths that do not fit", ValueError, twins.add_springs, [0, 1, 0], [1, 0], 1.0)
raises("uint64 may be too large for an index", TypeError, twins.add_springs, np.uint64([0]), 1, 1.0)
twins.add_springs([0, 1], hbvib.GROUND, [3, np.float32(8)])
close("numbers serve all entries", twins.linear_modes(2).omega, [2, 3], 1e-14)
check("ids are a range", list(twins.add_jenkins([0, 1], -1, 1, 0.3, [1, 2])) == [0, 1] and twins.contacts == 2)
check("a copy has the same contacts", copy.copy(twins).contacts == copy.deepcopy(twins).contacts == 2)
check("engine orders and blocks are those given", (model.ndof, model.sectors, model.contacts) == (4, 24, 1))
check("the inputs were not touched", np.isfinite(STIFFNESS).all() and MASS.flags.writeable and COUPLING.flags.writeable)
close(
    "a slope array and its residual",
    oscillator().forced_residual(1.2, [[0], [0.1 + 0.05j]], d_omega=True).d_omega[1],
    [-2 * 1.2 * (0.1 + 0.05j) + 1j * 0.02 * (0.1 + 0.05j)],
    1e-14,
)

# Other packages: DLPack and the protocol of buffers, both ways and without a copy.


class Tensor:
    """A tensor that is known by DLPack alone."""

    def __init__(self, array):
        self.array, self.asked = array, 0

    def __dlpack__(self, **request):
        self.asked += 1
        return self.array.__dlpack__(**request)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


tensor = Tensor(np.ascontiguousarray(STIFFNESS))
model.set_matrix("stiffness", tensor)
check("a tensor is taken by DLPack", tensor.asked == 1 and bits(solve(model)) == reference)
if hasattr(np, "from_dlpack"):
    wide = Tensor(np.zeros((2, 2), np.int64))
    check("its memory is not copied", np.shares_memory(hbvib._convert._numbers("matrix", wide, np.float64), wide.array))
model.set_matrix("stiffness", memoryview(np.ascontiguousarray(STIFFNESS)))
check("a buffer is taken", bits(solve(model)) == reference)
shown = solve(model)
view = memoryview(shown.omega)
check("a field is a buffer, read-only", view.readonly and view.format == "d" and np.shares_memory(np.asarray(view), shown.omega))
del view
if np.lib.NumpyVersion(np.__version__) >= "2.1.0":  # those before cannot tell that an array is read-only
    given = np.from_dlpack(shown.omega)
    check("a field goes out by DLPack without a copy", np.shares_memory(given, shown.omega) and not given.flags.writeable)
    raises("and keeps the memory of its branch", BufferError, shown.free)
    del given
    shown.free()
    check("until it is gone", shown.is_freed)

finish(122)  # 8 more with scipy
