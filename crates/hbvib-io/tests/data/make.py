"""Wrote the files of this folder that come from scipy and pyNastran; `values.json` holds their matrices.

The others: sector.sti, sector.mas, sector.dof are those of CalculiX 2.20 (Debian calculix-ccx) for sector.inp, a clamped
sector of two C3D8 elements with SOLVER=MATRIXSTORAGE. wheel_STIF1.mtx and wheel_coordinate.mtx are written here in the
layout of Abaqus' *MATRIX OUTPUT, FORMAT=MATRIX INPUT and COORDINATE: no Abaqus was at hand."""

import gzip
import json
import shutil

import numpy as np
import scipy.io
import scipy.sparse as sp
from pyNastran.op4.op4 import OP4

rng = np.random.default_rng(18)
n = 7
a = sp.random(n, n, 0.4, random_state=rng).toarray() * np.exp(rng.normal(0, 5, (n, n)))
symmetric = a + a.T + np.diag(rng.uniform(1, 2, n)) * 1e3
complex_ = a + 1j * np.where(a != 0, rng.normal(size=(n, n)), 0)
hermitian = complex_ + complex_.conj().T
rectangular = sp.random(5, 3, 0.5, random_state=rng).toarray()
values = {}


def keep(name, matrix):
    matrix = np.asarray(matrix)
    values[name] = dict(re=matrix.real.tolist(), im=matrix.imag.tolist())


for name, matrix, options in (
    ("general.mtx", sp.coo_matrix(a), dict(symmetry="general")),
    ("symmetric.mtx", sp.coo_matrix(symmetric), dict(symmetry="symmetric")),
    ("hermitian.mtx", sp.coo_matrix(hermitian), dict(symmetry="hermitian")),
    ("complex.mtx", sp.coo_matrix(complex_), dict(symmetry="general")),
    ("skew.mtx", sp.coo_matrix(a - a.T), dict(symmetry="skew-symmetric")),
    ("rectangular.mtx", sp.coo_matrix(rectangular), {}),
    ("array.mtx", symmetric, dict(symmetry="symmetric")),
):
    with open(name, "wb") as file:
        scipy.io.mmwrite(file, matrix, precision=17, **options)
    keep(name, matrix.toarray() if sp.issparse(matrix) else matrix)
with open("symmetric.mtx", "rb") as plain, gzip.GzipFile("symmetric.mtx.gz", "wb", mtime=0) as packed:
    shutil.copyfileobj(plain, packed)
keep("symmetric.mtx.gz", symmetric)
scipy.io.hb_write("general.rua", sp.csc_matrix(a))
keep("general.rua", a)
# scipy writes the type RUA alone: the lower triangle, with the type of a symmetric matrix as HBMAT of Ansys has it.
scipy.io.hb_write("symmetric.rsa", sp.csc_matrix(np.tril(symmetric)))
text = open("symmetric.rsa").read()
open("symmetric.rsa", "w").write(text.replace("RUA", "RSA", 1))
keep("symmetric.rsa", symmetric)
# pyNastran 1.4 writes wrong lengths where a sparse column has several strings: bands have one a column.
band = np.triu(np.tril(symmetric + 0.25, 1), -1)
for name, store, k, c in (("dense.op4", np.asarray, symmetric, a), ("sparse.op4", sp.coo_matrix, band, np.tril(band))):
    matrices = {"KAA": (6, store(k)), "MAA": (6, store(np.diag(np.arange(1.0, n + 1)))), "BAA": (1, store(c))}
    OP4().write_op4(name, matrices, is_binary=False, precision="double")
    keep(name, k)
    keep(name + " damping", c)
values["mass"] = np.arange(1.0, n + 1).tolist()
lower = np.tril(symmetric)
with open("wheel_STIF1.mtx", "w") as file:
    file.write("** Assembled nodal stiffness\n")
    for i, j in zip(*np.nonzero(lower)):
        file.write(f"{10 + i // 3},{i % 3 + 1}, {10 + j // 3},{j % 3 + 1}, {lower[i, j]:.15e}\n")
keep("wheel_STIF1.mtx", symmetric)
with open("wheel_coordinate.mtx", "w") as file:
    for i, j in zip(*np.nonzero(symmetric)):
        file.write(f"{i + 1:8d} {j + 1:8d} {symmetric[i, j]:.15e}\n")
keep("wheel_coordinate.mtx", symmetric)
json.dump(values, open("values.json", "w"), indent=0)


def universal():
    """shapes.uff: as pyuff 2.5.8 writes data sets 151, 15, 2411, 82, 55, and 58 as text and binary. It announces half the bytes of the
    binary one."""
    import pyuff

    file = pyuff.UFF("shapes.uff")
    numbers = np.random.default_rng(2)
    common = dict(def_cs=[0, 0], disp_cs=[0, 0], color=[1, 1], return_full_dict=True)
    date = dict(db_app="x", date_db_created="26-Nov-26", time_db_created="18:30:00", version_db1=0, version_db2=0, file_type=0,
                date_db_saved="26-Nov-26", time_db_saved="18:30:00", program="p", date_db_written="26-Nov-26",
                time_db_written="18:30:00", return_full_dict=True)
    shape = {f"r{k + 1}": numbers.normal(size=2) for k in range(6)}
    for _ in range(6):
        numbers.normal(size=4)
    y = numbers.normal(size=5) + 1j * numbers.normal(size=5)
    function = dict(type=58, abscissa_spec_data_type=18, ordinate_spec_data_type=12, orddenom_spec_data_type=13,
                    z_axis_spec_data_type=0, rsp_node=7, rsp_dir=3, ref_node=1, ref_dir=-2, id1="u")
    for one in [
        pyuff.prepare_151(model_name="wheel", description="two nodes", **date),
        pyuff.prepare_15(node_nums=[1, 7], x=[0.0, 1.5], y=[-2.0, 0.25], z=[3e-3, -1.0], **common),
        pyuff.prepare_2411(node_nums=[12, 13], x=[1 / 3, -1 / 3], y=[-2 / 7, 2 / 7], z=[1e-10 / 3, 0], **common),
        pyuff.prepare_82(trace_num=1, n_nodes=4, color=1, id="line", nodes=np.array([1, 7, 0, 12]), return_full_dict=True),
        pyuff.prepare_55(model_type=1, id1="a", id2="b", id3="c", id4="d", id5="e", analysis_type=2, data_ch=2, spec_data_type=8,
                         data_type=2, n_data_per_node=6, node_nums=[1, 7], load_case=1, mode_n=4, freq=123.45, modal_m=2.0,
                         modal_damp_vis=0.01, modal_damp_his=0.0, return_full_dict=True, **shape),
        dict(function, binary=0, func_type=4, data=y, x=np.arange(5) * 0.5, abscissa_spacing=1, ord_data_type=6, abscissa_inc=0.5),
        dict(function, binary=1, func_type=4, data=y, x=np.arange(5) * 0.5, abscissa_spacing=1, ord_data_type=6, abscissa_inc=0.5),
        dict(function, binary=0, func_type=1, data=y.real, x=np.array([0, 0.1, 0.3, 0.7, 2.0]), abscissa_spacing=0, ord_data_type=4),
    ]:
        file._write_set(one, "add")


def small():
    """Small files for mutations: small.mat, packed.mat and packed.npz of scipy and NumPy; small.full in the layout of Ansys' files, wide.op4
    in words of eight bytes."""
    import struct

    k = np.array([[4.0, -1, 0], [-1, 4, -1], [0, -1, 4]])
    m = np.diag([1.0, 2, 3])
    both = dict(K=sp.csc_matrix(k), M=m, dofs=np.array([[1, 1], [1, 2], [2, 1]]))
    scipy.io.savemat("small.mat", both)
    scipy.io.savemat("packed.mat", both, do_compression=True)
    np.savez_compressed("packed.npz", K=k, M=m)

    def words(numbers, kind="i", flags=0x80000000):
        data = struct.pack("<%d%s" % (len(numbers), kind), *numbers)
        return struct.pack("<iI", len(data) // 4, flags) + data + struct.pack("<i", len(data) // 4)

    def rows(a):
        return b"".join(words(range(j + 1, 4)) + words(a[j:, j].tolist(), "d", 0) for j in range(3))

    first, second = [0] * 100, [0] * 100
    first[0], second[0:2], second[7] = 4, [-4, 3], 1
    after = words([1]) + words([2, 3, 1])
    node_dofs = words([1, 1, 1]) + words([0, -1, 0])
    at = np.cumsum([206 + len(after) // 4, len(node_dofs) // 4, len(rows(k)) // 4])
    second[8] = second[33] = 6
    second[35], second[18], second[26] = at.tolist()
    with open("small.full", "wb") as file:
        file.write(words(first) + words(second) + after + node_dofs + rows(k) + rows(m))

    def record(data):
        return struct.pack("<i", len(data)) + data + struct.pack("<i", len(data))

    with open("wide.op4", "wb") as file:
        file.write(record(struct.pack("<4q16s", 3, -3, 6, 2, b"KAA")))
        for j in range(3):
            file.write(record(struct.pack("<5q3d", j + 1, 0, 5, 4, 1, *k[:, j])))
        file.write(record(struct.pack("<3qd", 4, 1, 1, 1.0)))


def hdf5():
    """version73.mat and packed73.mat in the layout of MATLAB's save -v7.3, by h5py: no MATLAB was at hand."""
    import h5py

    k = np.array([[4.0, -1, 0.5], [-1, 4, -1], [0.25, -1, 4]])
    d = np.array([[0, 1 - 2j, 0], [0, 0, 0], [3j, 0, 0.5]])
    for name, packed in (("version73.mat", {}), ("packed73.mat", dict(compression=3, shuffle=True, chunks=True))):
        with h5py.File(name, "w", userblock_size=512, libver="earliest") as file:
            def put(place, key, array, of, **more):
                one = place.create_dataset(key, data=array, **more)
                one.attrs["MATLAB_class"] = np.bytes_(of)
                return one
            # MATLAB has columns one after another.
            put(file, "K", k.T.copy(), "double", **packed)
            put(file, "C", (0.5 * k).T.astype("f4"), "single", **packed)
            put(file, "dofs", np.array([[1, 1], [1, 2], [2, 1]]).T.astype("i4"), "int32", **packed)
            put(file, "title", np.array([[87], [104]], "u2"), "char")
            put(file, "dt", np.array([[1.0, 2.0, 3.0]]), "double")
            for key, a in (("M", sp.csc_matrix(np.diag([1.0, 2, 3]))), ("D", sp.csc_matrix(d))):
                group = file.create_group(key)
                group.attrs["MATLAB_class"] = np.bytes_("double")
                group.attrs["MATLAB_sparse"] = np.uint64(3)
                pair = np.dtype([("real", "f8"), ("imag", "f8")])
                values = np.array([(z.real, z.imag) for z in a.data], pair) if np.iscomplexobj(a.data) else a.data
                group.create_dataset("data", data=values)
                group.create_dataset("ir", data=a.indices.astype("u8"))
                group.create_dataset("jc", data=a.indptr.astype("u8"))
            file.create_group("settings").create_dataset("step", data=np.array([[1.0]]))
        head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, by h5py".ljust(116) + b"\0" * 8 + b"\x00\x02IM"
        with open(name, "r+b") as file:
            file.write(head)


if __name__ == "__main__":
    universal()
    hdf5()
    small()
