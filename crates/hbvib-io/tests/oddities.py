"""Files as other programs write them, and right matrices for each: heads, names, labels and banners of public threads.

OP4 of external superelements: pyNastran #746. OP4 binary and heads of 16 columns: pyNastran #695, #293, pyyeti #5, #7; words of
eight bytes as pyYeti reads them. Abaqus
labels below zero: zxding.me. Harwell-Boeing and Matrix Market: MatrixMarket.jl #4, #37, scipy #8797, #18123, #9426, #24082,
fast_matrix_market #10. DMIG and formats that are not read: pyNastran #699, #274,
pymapdl-reader."""
import importlib.util
import os
import struct
import sys
import tempfile

import numpy as np
import scipy.io
import scipy.sparse as sp

place = importlib.util.spec_from_file_location("hbvib_io", os.path.join(os.environ["HBVIB_INCLUDE"], "hbvib/io.py"))
io = importlib.util.module_from_spec(place)
place.loader.exec_module(io)
folder = tempfile.mkdtemp()


def write(name, data):
    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())
    return path


def same(label, found, expected):
    assert found is not None, label
    assert found.shape == np.shape(expected) and np.array_equal(found.toarray(), np.array(expected, float)), label


def op4(name, a, wide=False):
    """Dense columns of one matrix, as text."""
    a = np.atleast_2d(np.asarray(a, float))
    size = "%16d%16d" if wide else "%8d%8d"
    column = "%16d%16d%16d" if wide else "%8d%8d%8d"
    out = [(size + "%8d%8d%-8s1P,3E23.16%s") % (a.shape[1], a.shape[0], 6, 2, name, "|I16" if wide else "")]
    for j in range(a.shape[1]):
        if a[:, j].any():
            first, last = np.flatnonzero(a[:, j])[[0, -1]]
            values = a[first:last + 1, j]
            out.append(column % (j + 1, first + 1, 2 * len(values)))
            out += ["".join("%23.16E" % x for x in values[i:i + 3]) for i in range(0, len(values), 3)]
    return "\n".join(out + [column % (a.shape[1] + 1, 1, 1), "%23.16E" % 1.0]) + "\n"


def record(order, data):
    return struct.pack(order + "i", len(data)) + data + struct.pack(order + "i", len(data))


def op4_binary(order, name, a, kind, sparse=False, large=False, wide=False):
    """One matrix of real numbers, single (1) or double (2) precision, as Fortran records; wide: of words of eight bytes."""
    number, words = ("f", 1) if kind == 1 and not wide else ("d", 1 if wide else 2)
    word, size, head = ("q", 8, "qqqq16s") if wide else ("i", 4, "iiii8s")
    a = np.asarray(a, float)
    rows, columns = a.shape
    out = record(order, struct.pack(order + head, columns, -rows if large else rows, 6, kind, name.ljust(2 * size).encode()))
    for j in range(columns):
        used = np.flatnonzero(a[:, j])
        if not sparse:
            values = a[used[0]:used[-1] + 1, j]
            body = struct.pack(order + "%d%s" % (len(values), number), *values)
            out += record(order, struct.pack(order + 3 * word, j + 1, used[0] + 1, words * len(values)) + body)
            continue
        body = b""
        for i in used:
            body += struct.pack(order + 2 * word, words + 1, i + 1) if large else struct.pack(order + word,
                                                                                              (words + 1) * 65536 + i + 1)
            body += struct.pack(order + number, a[i, j])
        out += record(order, struct.pack(order + 3 * word, j + 1, 0, len(body) // size) + body)
    return out + record(order, struct.pack(order + 3 * word, columns + 1, 1, words) + struct.pack(order + number, 1.0))


def superelements():
    k = np.array([[3e6, -1e6, 0], [-1e6, 2e6, -1e6], [0, -1e6, 1e6]])
    m = np.diag([2.0, 1.0, 0.5])
    zero = [[0.0]]
    pair = op4("KXX", k) + op4("MXX", m)
    recovery = op4("VA", np.ones((3, 1))) + op4("MUG1", np.ones((5, 3))) + op4("MES1", zero)
    others = "".join(op4(name, zero) for name in ("PX1", "GPXX", "GDXX", "RVAX"))
    for label, text in {"pair": pair, "null": pair + op4("BXX1", zero), "k4": pair + op4("K4XX1", zero), "mug": pair + recovery,
                        "whole": pair + op4("BXX1", zero) + op4("K4XX1", zero) + others + recovery}.items():
        found = io.read(write(label + ".op4", text))
        same(label, found.stiffness, k)
        same(label, found.mass, m)
        assert found.damping is None and found.structural is None, label
    assert any("MUG1" in line and "GPXX" in line for line in found.facts), found.facts
    found = io.read(write("loss.op4", pair + op4("K4XX", 0.02 * k)))
    same("K4XX", found.structural, 0.02 * k)
    same("K4XX beside", found.stiffness, k)
    # Those of EXTSEOUT go before those without the boundary; two of one kind otherwise are refused.
    both = io.read(write("two.op4", pair + op4("KAA", 2 * k) + op4("MAA", 3 * m) + op4("BGG", m)))
    same("KAA beside KXX", both.stiffness, 2 * k)
    same("MAA beside MXX", both.mass, 3 * m)
    assert both.damping is None and any("BGG" in line and "KXX" in line for line in both.facts), both.facts
    refused("two.op4", op4("KGG", k) + op4("KFF", k), "KGG and KFF")


def op4_kinds():
    a = [[2.0, -1.0], [-1.0, 2.0]]
    for order in "<>":
        for kind in (1, 2):
            for sparse, large in ((False, False), (True, False), (True, True)):
                label = f"binary{order}{kind}{sparse}{large}"
                same(label, io.read(write("b.op4", op4_binary(order, "KAA", a, kind, sparse, large))).stiffness, a)
                same(label, io.read(write("b.dat", op4_binary(order, "kaa", a, kind, sparse, large))).stiffness, a)
                same(label, io.read(write("w.op4", op4_binary(order, "KAA", a, kind, sparse, large, wide=True))).stiffness, a)
    data = op4_binary("<", "KAA", a, 2)
    for cut in range(35, len(data) - 1, 7):
        refused("cut.op4", data[:cut], "OP4 binary: ")
    data = op4_binary(">", "KAA", a, 2, wide=True)
    for cut in range(60, len(data) - 1, 7):
        refused("cut.op4", data[:cut], "OP4 binary: ")
    refused("short.op4", data[:20], "FORMATTED")
    refused("nan.op4", op4_binary("<", "KAA", [[1, np.nan], [np.nan, 1]], 2), "is not finite")
    same("wide", io.read(write("w.op4", op4("KGG", a, wide=True))).stiffness, a)
    large = "%16d%16d%8d%8d%-8s1P,3E23.16|I16\n" % (2, -2, 6, 2, "KGG")
    for column in (1, 2):
        large += "%16d%16d%16d\n%16d%16d\n%23.16E%23.16E\n" % (column, 0, 6, 5, 1, a[column - 1][0], a[column - 1][1])
    large += "%16d%16d%16d\n%23.16E\n" % (3, 1, 1, 1)
    same("wide strings", io.read(write("s.op4", large)).stiffness, a)
    text = op4("KAA", a)
    for label, other in {"lower": text.replace("KAA", "kaa"), "D": text.replace("E+", "D+"),
                         "crlf": text.replace("\n", "\r\n")}.items():
        same(label, io.read(write("t.op4", other)).stiffness, a)


def abaqus_labels():
    labels = [-2, -1, 1, 2, 3]
    rng = np.random.default_rng(3)
    a = rng.standard_normal((5, 5))
    k = a @ a.T + 5 * np.eye(5)
    for form in ("%d,1, %d,1, %.17g\n", "%d  %d  %.17g\n"):
        for whole in (False, True):
            pairs = [(i, j) for i in range(5) for j in range(5 if whole else i + 1)]
            rng.shuffle(pairs)
            found = io.read(write("job_STIF2.mtx", "".join(form % (labels[i], labels[j], k[i, j]) for i, j in pairs)))
            same(form, found.stiffness, np.tril(k) + np.tril(k, -1).T if not whole else k)
            assert found.dofs[:, 0].tolist() == labels, found.dofs
    refused("job_STIF3.mtx", "0 1 2.5\n", "row = 0")


WANT = np.array([[4.0, -1, 0, 0.5], [-1, 4, -1, 0], [0, -1, 4, -1], [0.5, 0, -1, 4]])


def boeing(formats, item, value, per, lead="", kind="RSA", right=False, count=True):
    """A Harwell-Boeing file of WANT."""
    whole = kind[1].upper() == "U"
    columns = [[i for i in range(0 if whole else j, 4) if WANT[i, j]] for j in range(4)]
    pointers = np.cumsum([1] + [len(c) for c in columns])
    rows = [i + 1 for c in columns for i in c]
    values = [WANT[i, j] for j, c in enumerate(columns) for i in c]

    def lines(numbers, form, per, lead=""):
        return [lead + "".join(form(x) for x in numbers[i:i + per]) for i in range(0, len(numbers), per)]

    parts = [lines(pointers, item, per[0], lead), lines(rows, item, per[0], lead), lines(values, value, per[1])]
    extra = lines([1.0, 2, 3, 4], value, per[1]) if right else []
    counts = "".join("%14d" % len(part) for part in parts) + ("%14d" % len(extra) if count else "")
    head = ["%-72s%-8s" % ("A stiffness matrix", "KEY"), "%14d" % (sum(map(len, parts)) + len(extra)) + counts,
            "%-14s%14d%14d%14d%14d" % (kind, 4, 4, len(rows), 0), "%-16s%-16s%-20s%-20s" % (formats[0], *formats, formats[1])]
    head += ["%-14s%14d%14d" % ("F", 1, 0)] if right else []
    return "\n".join(head + sum(parts, []) + extra) + "\n"


def harwell_boeing():
    def fixed(width):
        return lambda i: "%*d" % (width, i)

    def real(width, digits):
        return lambda x: "%*.*E" % (width, digits, x)

    def letter_d(x):
        return real(20, 12)(x).replace("E", "D")

    def three(x):
        return "%24s" % real(20, 15)(x).replace("E+", "E+0").replace("E-", "E-0")

    cases = [(("(1X,8I9)", "(3(1P,E24.16))"), fixed(9), real(24, 16), (8, 3), dict(lead=" ")),
             (("(8I10)", "(1P,4E20.12)"), fixed(10), real(20, 12), (8, 4), dict(right=True)),
             (("(10I8)", "(4D20.12)"), fixed(8), letter_d, (10, 4), {}),
             (("(1I10)", "(1E25.15)"), fixed(10), real(25, 15), (1, 1), dict(right=True)),
             (("(13I6)", "(3E26.18)"), fixed(6), real(26, 18), (13, 3), dict(kind="RUA")),
             (("(13I6)", "(3E26.18)"), fixed(6), real(26, 18), (13, 3), dict(kind="rsa")),
             (("(13I6)", "(3E26.18)"), fixed(6), real(26, 18), (13, 3), dict(count=False)),
             (("(8I10)", "(1P4E20.12)"), fixed(10), real(20, 12), (8, 4), {}),
             (("(8I10)", "(1PE20.12)"), fixed(10), real(20, 12), (8, 1), {}),
             (("(8I10)", "(3E24.15E3)"), fixed(10), three, (8, 3), {})]
    for formats, item, value, per, more in cases:
        same(formats, io.read(write("m.dat", boeing(formats, item, value, per, **more))).stiffness, WANT)


def matrix_market():
    banner = "%%MatrixMarket matrix coordinate real symmetric\n"
    entries = [(i + 1, j + 1, WANT[i, j]) for j in range(4) for i in range(j, 4) if WANT[i, j]]
    body = f"4 4 {len(entries)}\n" + "".join("%d %d %.17g\n" % one for one in entries)
    upper = f"4 4 {len(entries)}\n" + "".join("%d %d %.17g\n" % (j, i, v) for i, j, v in entries)
    for text in (banner + body, "  " + banner + body, banner + "   % by a solver\n" + body,
                 banner + "\n%\n\n" + body.replace("\n", "\n\n"), banner[1:] + body, banner + upper,
                 banner + body.replace("0.5", "5.0D-1"), (banner + body).replace("\n", "\r\n"), "\ufeff" + banner + body,
                 banner.upper() + body, banner.lower() + body):
        same(text, io.read(write("m.mtx", text)).stiffness, WANT)
    refused("m.mtx", banner + body.replace("2 1 -1", "1 2 -1"), "both sides of the diagonal")
    # Sizes without the banner, with numbers that have a point and with whole ones.
    refused("m.mtx", body, "banner")
    refused("m.mtx", body.replace("0.5", "1"), "banner")
    skew = "%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n1 2 3\n"
    same("skew", io.read(write("m.mtx", skew)).stiffness, [[0, 3], [-3, 0]])


def refused(name, data, words):
    try:
        io.read(write(name, data))
    except io.ReadError as error:
        assert words in str(error) and name in str(error), error
    else:
        raise AssertionError(f"{name} was read, needs a sentence with {words!r}")


def other_formats():
    refused("file.full", struct.pack("<60i", *range(60)), "HBMAT")
    refused("job.sim", b"\x00\x01\x02" * 40, "*MATRIX OUTPUT")
    refused("job.op2", b"\x04\x00\x00\x00" * 40, "OUTPUT4")
    refused("k73.mat", b"MATLAB 7.3 MAT-file, Platform: GLNXA64" + b" " * 88 + b"\x00\x02IM" + b"\x00" * 400 + b"\x89HDF", "save -v7")
    refused("old.mat", struct.pack("<5i", 0, 2, 2, 0, 2) + b"k\x00" + struct.pack("<4d", 1, 2, 3, 4), "save -v7")
    refused("k.mat", b"MATLAB 5.0 MAT-file, Platform: posix" + b"\x00\x01IM" * 30, "MATLAB file")
    refused("k.h5", b"\x89HDF\r\n\x1a\n" + b"\x00" * 60, "HDF5")
    for path, words in ((folder, "is a folder"), (os.path.join(folder, "nothing.mtx"), "cannot be read")):
        try:
            io.read(path)
        except io.ReadError as error:
            assert words in str(error), error
        else:
            raise AssertionError(path)


def dmig():
    k = np.array([[3e6, -1e6, 0.5], [-1e6, 2e6, -1e6], [0.5, -1e6, 1e6]])
    dofs = [[5, 1], [5, 3], [12, 0]]
    head = "$ punched\nBEGIN SUPER=1\nGRID*                  5               0 1.000000000E+00 2.000000000E+00\n*       0.000000000E+00\n"
    small, large, free = (head + "DMIG    KAAX    0       6       2       0\n" for _ in range(3))
    for j in range(3):
        small += "DMIG    KAAX    %8d%8d        " % tuple(dofs[j])
        large += "DMIG*   KAAX            %16d%16d\n" % tuple(dofs[j])
        free += "dmig,kaax,%d,%d,,%d,%d,%.1f\n" % (*dofs[j], *dofs[j], k[j, j])
        for place, i in enumerate(range(j, 3)):
            # Two rows a line of eight fields.
            small += ("\n+       " if place == 1 else "") + "%8d%8d%8s        " % (*dofs[i], "%.1E" % k[i, j])
            large += "*       %16d%16d%16s\n" % (*dofs[i], ("%.9E" % k[i, j]).replace("E", "D"))
            free += "" if i == j else ",%d,%d,%.1f,\n" % (*dofs[i], k[i, j])
        small += "\n"
    for label, text in {"small": small, "large": large, "free": free}.items():
        for name in ("run.pch", "run.bdf", "run"):
            found = io.read(write(name, text))
            same(label, found.stiffness, k)
            assert found.dofs.tolist() == dofs and found.mass is None, label
    # The exponent without a letter, both triangles, a rectangular matrix of loads, real and complex numbers.
    text = ("DMIG    MAAX    0       6       1       0\nDMIG    MAAX    5       1               5       1       1.5+3\n"
            "DMIG    PAX     0       9       2       0                       1\nDMIG*   PAX                            1               0\n"
            "*                      9               1 1.000000000D+00\n"
            "DMIG    K4AAX   0       1       3       0\nDMIG    K4AAX   5       1               5       3       1.      2.\n")
    found = io.read(write("run.pch", text))
    same("mass", found.mass, [[1500.0, 0], [0, 0]])
    assert found.structural.toarray()[1, 0] == 1 + 2j and "PAX" in found.facts[-1] + found.facts[2], found.facts
    polar = text.replace("DMIG    K4AAX   0       1       3       0", "DMIG    K4AAX   0       1       3       0       1")
    found = io.read(write("run.pch", polar)).structural.toarray()[1, 0]
    assert abs(found - np.exp(1j * np.radians(2))) < 1e-15, found
    refused("run.pch", "GRID,1,,0.,0.,0.\n", "EXTSEOUT(DMIGPCH)")
    refused("run.pch", "DMIG,KAAX,1,1,,1,1,2.\n", "before its first entry")
    refused("run.pch", "DMIG,KAAX,0,6,7\n", "type = 7")
    refused("run.pch", "DMIG,KAAX,0,6,2\nDMIG,KAAX,1,9,,1,1,2.\n", "line 2")
    refused("run.pch", "DMIG,PX,0,9,2\nDMIG,PX,1,0,,1,1,2.\n", "PX")


def elements():
    # As *SUBSTRUCTURE MATRIX OUTPUT of CalculiX: a node for each row, a triangle row by row.
    k = np.array([[4.0, -1, 0.5], [-1, 3, 0.25], [0.5, 0.25, 2]])
    text = ("**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT,NODES=          3,LINEAR\n** ELEMENT NODES\n"
            "**        11,        11,        20,\n         1\n         2,         3\n         3,         2\n"
            "*MATRIX,TYPE=STIFFNESS\n 0.4000000000000E+01,\n-0.1000000000000E+01, 0.3000000000000E+01,\n"
            " 0.5000000000000E+00, 0.2500000000000E+00, 0.2000000000000E+01,\n")
    found = io.read(write("sub.mtx", text))
    same("CalculiX", found.stiffness, k)
    assert found.dofs.tolist() == [[11, 1], [11, 3], [20, 2]] and found.mass is None
    # As *ELEMENT MATRIX OUTPUT of Abaqus, of a square of side 1 in plane stress; a page on the web shows these numbers.
    text = ("**\n** ELEMENT NUMBER 11 STEP NUMBER 2 INCREMENT NUMBER 1\n** ELEMENT TYPE CPS4\n*USER ELEMENT, NODES= 2, LINEAR\n"
            "** ELEMENT NODES\n** 101, 102\n1, 2\n*MATRIX,TYPE=STIFFNESS\n98.9 ,\n35.7 , 98.9\n-60.4 , 2.74 , 98.9\n"
            "-2.74 , 10.9 , -35.7 , 98.9\n*MATRIX,TYPE=MASS\n2.,\n0., 2.,\n1., 0., 2.,\n0., 1., 0., 2.\n")
    found = io.read(write("elem.mtx", text))
    assert found.stiffness.toarray()[2].tolist() == [-60.4, 2.74, 98.9, -35.7] and found.dofs.tolist()[2] == [102, 1]
    same("mass", found.mass, np.kron([[2, 1], [1, 2]], np.eye(2)))
    bare = "*MATRIX, TYPE=STIFFNESS\n1.,\n2., 3.,\n"
    found = io.read(write("bare.mtx", bare))
    same("without nodes", found.stiffness, [[1, 2], [2, 3]])
    whole = text.replace("LINEAR", "LINEAR, UNSYMM").split("*MATRIX,TYPE=MASS")[0].split("98.9 ,")[0]
    whole += "".join("%d., %d., %d., %d.\n" % tuple(4 * j + i for i in range(4)) for j in range(4))
    same("columns", io.read(write("u.inp", whole)).stiffness, np.arange(16.0).reshape(4, 4).T)
    refused("short.mtx", text.replace("-2.74 , ", ""), "9 numbers, needs 10 for 4 degrees of freedom")
    refused("two.mtx", text + text, "a second *USER ELEMENT")
    refused("none.mtx", text.split("*MATRIX")[0], "without *MATRIX")
    refused("bare.mtx", bare.replace("3.,", "3., 4."), "no triangle")


def numpy_files():
    rng = np.random.default_rng(5)
    k = sp.random(6, 6, 0.4, random_state=rng).toarray() + np.eye(6)
    m = np.diag(rng.uniform(1, 2, 6))
    path = os.path.join(folder, "k.npz")
    for form in (sp.csr_matrix, sp.csc_matrix, sp.coo_matrix, sp.csr_array):
        for compressed in (False, True):
            for kind in (float, complex, np.float32):
                sp.save_npz(path, form(k.astype(kind)), compressed=compressed)
                same(form.__name__, io.read(path).stiffness, k.astype(kind).astype(float))
    for form in ("bsr", "dia"):
        sp.save_npz(path, sp.csr_matrix(k).asformat(form))
        with open(path, "rb") as file:
            refused("other.npz", file.read(), ".tocsc()")
    for save in (np.savez, np.savez_compressed):
        for order in "CF":
            save(path, stiffness=np.asarray(k, order=order), M=m.astype(">f8"), area=np.ones(3), damping_matrix=np.asarray(0.1 * k, order=order))
            found = io.read(path)
            same("plain", found.stiffness, k)
            same("plain", found.mass, m)
            same("plain", found.damping, 0.1 * k)
            assert any("area" in line for line in found.facts)
    sparse = sp.csr_matrix(k)
    np.savez(path, K_data=sparse.data, K_indices=sparse.indices, K_indptr=sparse.indptr, K_shape=sparse.shape, K_format="csr",
             M=m.astype(int), dofs=[[1, 1], [1, 2], [1, 3], [2, 1], [2, 2], [2, 3]])
    found = io.read(path)
    same("prefixed", found.stiffness, k)
    same("whole numbers", found.mass, m.astype(int))
    assert found.dofs.tolist()[4] == [2, 2]
    np.savez(path, one=k)
    same("one", io.read(path).stiffness, k)
    np.save(os.path.join(folder, "k.npy"), np.asfortranarray(k))
    same("npy", io.read(os.path.join(folder, "k.npy")).stiffness, k)

    def bad(words, **arrays):
        np.savez(path, **arrays)
        with open(path, "rb") as file:
            refused("bad.npz", file.read(), words)

    bad("none has a name that is known", a=k, b1=m)
    bad("two matrices of stiffness", K=k, stiffness=k)
    bad("no matrix", area=np.ones(3))
    bad("no matrix", K=np.array([{}, 1], dtype=object))
    bad("not finite", K=np.where(k > 0.9, np.nan, k))
    bad("needs a whole number 0 .. 5", data=[1.0], indices=[6], indptr=[0, 1, 1, 1, 1, 1, 1], shape=[6, 6], format="csc")
    bad("run from 0 to 1", data=[1.0], indices=[5], indptr=[0, 0, 0, 0, 0, 0, 0], shape=[6, 6], format="csc")
    bad("is less than", data=[1.0, 2], indices=[5, 5], indptr=[0, 2, 1, 1, 1, 1, 2], shape=[6, 6], format="csc")
    bad("in a file of", data=[1.0], indices=[5], indptr=[0, 1], shape=[6, 1 << 40], format="csc")
    bad("is missing", data=[1.0], shape=[6, 6], format="csc")


def matlab_files():
    rng = np.random.default_rng(6)
    k = sp.random(6, 6, 0.4, random_state=rng).toarray() + np.eye(6)
    m = np.diag(np.arange(1.0, 7))
    path = os.path.join(folder, "k.mat")
    dofs = [[node, d] for node in (4, 9) for d in (1, 2, 3)]
    for compressed in (False, True):
        for form in (np.asarray, sp.csc_matrix):
            for kind in (float, complex):
                scipy.io.savemat(path, dict(K=form(k.astype(kind)), M=form(m), area=np.ones(3), title="wheel", part=dict(a=1),
                                            dofs=np.array(dofs)), do_compression=compressed)
                found = io.read(path)
                same("MATLAB", found.stiffness, k)
                same("MATLAB", found.mass, m)
                assert found.dofs.tolist() == dofs and any("title" in line and "part" in line for line in found.facts)
    both = k + 1j * k.T
    scipy.io.savemat(path, dict(D=sp.csc_matrix(both), k=both.astype(np.complex64)))
    found = io.read(path)
    assert np.array_equal(found.structural.toarray(), both) and np.array_equal(found.stiffness.toarray(), both.astype(np.complex64))
    scipy.io.savemat(path, dict(anything=m.astype(np.int8)))
    same("whole numbers", io.read(path).stiffness, m)
    # The other byte order: a variable by hand.
    def part(kind, data):
        return struct.pack(">ii", kind, len(data)) + data + b"\x00" * (-len(data) % 8)
    body = (part(6, struct.pack(">II", 6, 0)) + part(5, struct.pack(">ii", 2, 2)) + struct.pack(">hh4s", 1, 1, b"K")
            + part(9, struct.pack(">4d", 2, -1, -1, 3)))
    head = b"MATLAB 5.0 MAT-file, by hand".ljust(124) + b"\x01\x00MI"
    same("high byte first", io.read(write("big.mat", head + part(14, body))).stiffness, [[2, -1], [-1, 3]])
    refused("cut.mat", head + part(14, body)[:-9], "byte 128")
    refused("type.mat", head + part(3, body), "type 3 at byte 128")
    refused("nan.mat", head + part(14, body).replace(struct.pack(">d", 2), struct.pack(">d", np.inf)), "K(1, 1) is not finite")
    refused("none.mat", head, "no matrix")


def ansys_full():
    """The layout that pymapdl-reader documents; a real file of Ansys 16.2 gave the matrices of that reader to the last bit."""
    k = np.array([[9.0, 1, 2, 3], [1, 7, -1, 0], [2, -1, 6, 0.5], [3, 0, 0.5, 5]])
    m = np.diag([4.0, 3, 2, 1]) + 0.25
    # Nodes 8 and 3 with two degrees of freedom each; the first one is held.
    for order in "<>":
        def words(numbers, kind="i", flags=0x80000000):
            data = struct.pack(order + "%d%s" % (len(numbers), kind), *numbers)
            return struct.pack(order + "iI", len(data) // 4, flags) + data + struct.pack(order + "i", len(data) // 4)

        def file(change=None):
            first, second = [0] * 100, [0] * 100
            first[0], second[0:2], second[7] = 4, [-4, 4], 2
            after = words([1, 2]) + words([8, 3])
            node_dofs = words([2, 2]) + words([-1, 1, 2, 3])

            def rows(a):
                return b"".join(words([i + 1 for i in range(j, 4)]) + words([a[i, j] for i in range(j, 4)], "d", 0) for j in range(4))
            start = 2 * 103 + len(after) // 4
            at = np.cumsum([start, len(node_dofs) // 4, len(rows(k)) // 4])
            second[8], second[33] = 10, 10
            second[35], second[18], second[26] = at
            for place, value in (change or {}).items():
                second[place] = value
            return words(first) + words(second) + after + node_dofs + rows(k) + rows(m)

        found = io.read(write("model.full", file()))
        assert found.dofs.tolist() == [[3, 1], [3, 2], [8, 2]], found.dofs
        picked = np.ix_([2, 3, 1], [2, 3, 1])
        same("full", found.stiffness, k[picked])
        same("full", found.mass, m[picked])
        refused("model.full", file({0: 4}), "frontal")
        refused("model.full", file({13: 1}), "unsymmetric")
        refused("model.full", file({20: 1}), "constraint equations")
        refused("model.full", file({1: 5}), "5 equations")
        refused("model.full", file({18: 100000}), "cut off or damaged at byte 400000")
        refused("model.full", file()[:-6], "cut off")
        refused("model.sub", file().replace(struct.pack(order + "ii", 4, 0), struct.pack(order + "ii", 8, 0), 1), "superelement (.sub)")


for case in (superelements, op4_kinds, abaqus_labels, harwell_boeing, matrix_market, dmig, elements, numpy_files, matlab_files, ansys_full,
             other_formats):
    case()
sys.stdout.write("ok\n")
