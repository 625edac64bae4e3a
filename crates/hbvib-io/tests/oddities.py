"""Files as other programs write them, and right matrices for each: heads, names, labels and banners of public threads.

OP4 of external superelements: pyNastran #746. OP4 binary and heads of 16 columns: pyNastran #695, #293, pyyeti #5, #7. Abaqus
labels below zero: zxding.me. Harwell-Boeing and Matrix Market: MatrixMarket.jl #4, #37, scipy #8797, #18123, #9426, #24082,
fast_matrix_market #10. Formats that are not read: pyNastran #699, #274, pymapdl-reader."""
import importlib.util
import os
import struct
import sys
import tempfile
import zipfile

import numpy as np

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


def op4_binary(order, name, a, kind, sparse=False, large=False):
    """One matrix of real numbers, single (1) or double (2) precision, as Fortran records."""
    number, words = ("f", 1) if kind == 1 else ("d", 2)
    a = np.asarray(a, float)
    rows, columns = a.shape
    out = record(order, struct.pack(order + "iiii8s", columns, -rows if large else rows, 6, kind, name.ljust(8).encode()))
    for j in range(columns):
        used = np.flatnonzero(a[:, j])
        if not sparse:
            values = a[used[0]:used[-1] + 1, j]
            body = struct.pack(order + "%d%s" % (len(values), number), *values)
            out += record(order, struct.pack(order + "iii", j + 1, used[0] + 1, words * len(values)) + body)
            continue
        body = b""
        for i in used:
            body += struct.pack(order + "ii", words + 1, i + 1) if large else struct.pack(order + "i",
                                                                                          (words + 1) * 65536 + i + 1)
            body += struct.pack(order + number, a[i, j])
        out += record(order, struct.pack(order + "iii", j + 1, 0, len(body) // 4) + body)
    return out + record(order, struct.pack(order + "iii", columns + 1, 1, words) + struct.pack(order + number, 1.0))


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
    refused("two.op4", pair + op4("KAA", k), "KXX and KAA")


def op4_kinds():
    a = [[2.0, -1.0], [-1.0, 2.0]]
    for order in "<>":
        for kind in (1, 2):
            for sparse, large in ((False, False), (True, False), (True, True)):
                label = f"binary{order}{kind}{sparse}{large}"
                same(label, io.read(write("b.op4", op4_binary(order, "KAA", a, kind, sparse, large))).stiffness, a)
                same(label, io.read(write("b.dat", op4_binary(order, "kaa", a, kind, sparse, large))).stiffness, a)
    data = op4_binary("<", "KAA", a, 2)
    for cut in range(35, len(data) - 1, 7):
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
    dmig = "DMIG    KAAX    0       6       2       0\nDMIG*   KAAX                           1               1\n"
    refused("run.pch", dmig, "DMIG")
    refused("run.pch", "$ punched\n" + dmig, "OUTPUT4")
    refused("file.full", struct.pack("<60i", *range(60)), "HBMAT")
    refused("job.sim", b"\x00\x01\x02" * 40, "*MATRIX OUTPUT")
    refused("job.op2", b"\x04\x00\x00\x00" * 40, "OUTPUT4")
    with zipfile.ZipFile(os.path.join(folder, "k.zip"), "w") as file:
        file.writestr("k.npy", b"0")
    with open(os.path.join(folder, "k.zip"), "rb") as file:
        refused("k.npz", file.read(), "numpy.load")
    np.save(os.path.join(folder, "k.npy"), np.eye(2))
    with open(os.path.join(folder, "k.npy"), "rb") as file:
        refused("l.npy", file.read(), "numpy.load")
    refused("k.mat", b"MATLAB 5.0 MAT-file, Platform: posix" + b"\x00\x01IM" * 30, "loadmat")
    refused("k.h5", b"\x89HDF\r\n\x1a\n" + b"\x00" * 60, "HDF5")
    for path, words in ((folder, "is a folder"), (os.path.join(folder, "nothing.mtx"), "cannot be read")):
        try:
            io.read(path)
        except io.ReadError as error:
            assert words in str(error), error
        else:
            raise AssertionError(path)


for case in (superelements, op4_kinds, abaqus_labels, harwell_boeing, matrix_market, other_formats):
    case()
sys.stdout.write("ok\n")
