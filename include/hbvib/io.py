"""Matrices of finite-element programs as scipy matrices: hbvib.io.read(path) and hbvib.io.write(path, ...).

Matrix Market (also gzipped), Abaqus *MATRIX GENERATE (.mtx), CalculiX (.sti, .mas, .dof), superelements of both (*USER
ELEMENT), Harwell-Boeing text, Nastran OP4 (text and binary) and DMIG, NumPy and scipy (.npz, .npy), MATLAB (.mat),
Ansys .full. Needs scipy, and the library libhbvib_io: the wheel brings it; in the checkout, cargo build --release -p hbvib-io
builds it, and HBVIB_IO_LIBRARY names one elsewhere."""

from __future__ import annotations

import ctypes
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np

try:
    from ._test_files import TestFunction, read_uff
    from ._test_modes import TestMode, read_uff_modes
    from ._test_tables import coherence_sigma, read_columns
except ImportError:  # this file alone, without the package: it reads and writes matrices
    pass

if TYPE_CHECKING:
    from ._results import IntArray

__all__ = ["Matrices", "ReadError", "SuspiciousMatrices", "TestFunction", "TestMode", "WriteError", "coherence_sigma", "read", "read_columns",
           "read_uff", "read_uff_modes", "write", "write_universal"]

_HERE = os.path.dirname(os.path.abspath(__file__))
_FOLDERS = ("", "../../target/release", "../../target/debug", "../../../lib", "../../lib")


class _Contents(NamedTuple):
    stiffness: Any
    mass: Any
    damping: Any
    dofs: Optional[IntArray]


class Matrices(_Contents):
    """Contents of files: stiffness, mass, damping, sparse matrices or None, and dofs, an array (n, 2) of node and direction
    (0: not named), or None. Besides these four: structural, D of structural damping iD, or None; facts, lines with sizes, mass
    along each direction and supports; and warnings, values that the matrices of a structure do not have.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "k.mtx")
    >>> with open(path, "w") as file:
    ...     print("%%MatrixMarket matrix coordinate real symmetric\\n1 1 1\\n1 1 2", file=file)
    ...
    >>> found = hbvib.io.read(path)
    >>> found.stiffness.shape, found.mass is None, found.warnings
    ((1, 1), True, [])
    >>> found.facts
    ['stiffness: 1 x 1, 1 entries, one triangle']
    """
    structural: Any
    facts: list[str]
    warnings: list[str]


class SuspiciousMatrices(UserWarning):
    """Matrices with values that those of a structure do not have; warnings.simplefilter("error", SuspiciousMatrices) refuses
    them.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile, warnings
    >>> path = os.path.join(tempfile.mkdtemp(), "k.mtx")
    >>> with open(path, "w") as file:
    ...     print("%%MatrixMarket matrix coordinate real symmetric\\n2 2 2\\n1 1 2\\n2 2 -1", file=file)
    ...
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", hbvib.io.SuspiciousMatrices)
    ...     try:
    ...         hbvib.io.read(path)
    ...     except hbvib.io.SuspiciousMatrices as warning:
    ...         print(str(warning).split(": ", 1)[1])
    negative numbers on the diagonal of the stiffness: 1, first -1.000000e0 at row 1
    """


class ReadError(ValueError):
    """A file that is not understood; the sentence names file, line and reason.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "k.mtx")
    >>> with open(path, "w") as file:
    ...     print("%%MatrixMarket matrix coordinate real symmetric\\n1 1 1\\n1 2 2", file=file)
    ...
    >>> try:
    ...     hbvib.io.read(path)
    ... except hbvib.io.ReadError as error:
    ...     print("k.mtx" in str(error), "line 3" in str(error) or str(error))
    True True
    """


class WriteError(ValueError):
    """Matrices or results that a file cannot hold; the sentence names the file and the reason.

    >>> import hbvib, hbvib.io
    >>> try:
    ...     hbvib.io.write("k.xyz", stiffness=[[2.0]])
    ... except hbvib.io.WriteError as error:
    ...     print("one of op4" in str(error))
    True
    """


class _Matrix(ctypes.Structure):
    _fields_ = [(name, ctypes.c_int64) for name in ("rows", "columns", "entries")] + [
        (name, ctypes.c_int32) for name in ("is_complex", "symmetry")] + [
        (name, ctypes.c_void_p) for name in ("row", "column", "values")]


def _load() -> ctypes.CDLL:
    name = dict(win32="hbvib_io.dll", darwin="libhbvib_io.dylib").get(sys.platform, "libhbvib_io.so")
    named = os.environ.get("HBVIB_IO_LIBRARY")
    places = [named] if named else [os.path.normpath(os.path.join(_HERE, folder, name)) for folder in _FOLDERS]
    if not named and os.path.dirname(os.environ.get("HBVIB_LIBRARY", "")):
        places.insert(0, os.path.join(os.path.dirname(os.environ["HBVIB_LIBRARY"]), name))
    for place in places:
        if os.path.exists(place):
            lib = ctypes.CDLL(place)
            break
    else:
        raise ImportError(f"no {name} in " + ", ".join(os.path.dirname(place) for place in places)
                          + "; build it by `cargo build --release -p hbvib-io`, or name it by HBVIB_IO_LIBRARY")
    pointer = ctypes.POINTER(ctypes.c_void_p)
    lib.hbvib_io_read_files.argtypes = [ctypes.c_char_p] * 5 + [pointer]
    lib.hbvib_io_report_line.argtypes = [ctypes.c_void_p, ctypes.c_int32, ctypes.c_int64]
    lib.hbvib_io_report_line.restype = ctypes.c_char_p
    lib.hbvib_io_matrix_of.argtypes = [ctypes.c_void_p, ctypes.c_int32, ctypes.POINTER(_Matrix)]
    lib.hbvib_io_dofs.argtypes, lib.hbvib_io_dofs.restype = [ctypes.c_void_p], ctypes.c_int64
    lib.hbvib_io_dof_table.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    lib.hbvib_io_free.argtypes, lib.hbvib_io_free.restype = [ctypes.c_void_p], None
    lib.hbvib_io_new.argtypes = lib.hbvib_io_results_free.argtypes = [ctypes.c_void_p]
    lib.hbvib_io_set_matrix.argtypes = [ctypes.c_void_p, ctypes.c_int32, ctypes.POINTER(_Matrix)]
    lib.hbvib_io_set_dofs.argtypes = [ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p]
    lib.hbvib_io_write.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p]
    lib.hbvib_io_results_new.argtypes = [ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    lib.hbvib_io_results_add_shape.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double, ctypes.c_int64,
                                               ctypes.c_void_p, ctypes.c_void_p]
    lib.hbvib_io_results_add_function.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64,
                                                  ctypes.c_void_p, ctypes.c_void_p]
    lib.hbvib_io_results_write.argtypes = [ctypes.c_void_p, ctypes.c_char_p]
    lib.hbvib_io_results_free.restype = None
    lib.hbvib_io_last_error.restype = ctypes.c_char_p
    return lib


_lib = _load()


def _array(address: int, count: int, kind: Any) -> np.ndarray:
    """A copy of numbers of the library."""
    if count == 0:
        return np.empty(0, kind)
    size = count * np.dtype(kind).itemsize
    return np.frombuffer((ctypes.c_char * size).from_address(address), kind).copy()


def _sparse(matrix: _Matrix) -> Any:
    try:
        from scipy import sparse  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("matrices from files need scipy: pip install scipy") from None
    row, column = (_array(address, matrix.entries, np.uint32).astype(np.int64) for address in (matrix.row, matrix.column))
    kind = np.complex128 if matrix.is_complex else np.float64
    values = _array(matrix.values, matrix.entries, kind)
    if matrix.symmetry:
        off = row != column
        mirror = values[off]
        mirror = {1: mirror, 2: mirror.conj(), 3: -mirror}[matrix.symmetry]
        row, column = np.concatenate([row, column[off]]), np.concatenate([column, row[off]])
        values = np.concatenate([values, mirror])
    return sparse.csc_matrix((values, (row, column)), shape=(matrix.rows, matrix.columns))


def _lines(handle: Any, kind: int) -> list[str]:
    """Lines of the report."""
    lines = iter(range(sys.maxsize))
    found = iter(lambda: _lib.hbvib_io_report_line(handle, kind, next(lines)), None)
    return [line.decode(errors="replace") for line in found]


def read(path: Any = None, *, stiffness: Any = None, mass: Any = None, damping: Any = None,
         structural: Any = None) -> Matrices:
    """(stiffness, mass, damping, dofs) of a file, or of the files of one model; None for those that they do not hold.

    path    a file that may hold several matrices. Any file of a CalculiX job reads all of them. A format that does not say
            what it holds, as Matrix Market and Harwell-Boeing, has its matrix as stiffness.
    stiffness, mass, damping, structural   files with this matrix alone. Rows are brought to one order by node and direction
            where the files name them; rows that one of them lacks are zero there.

    A stiffness K(1 + i eta) is complex symmetric: Model takes it by set_matrix("stiffness", k, part="symmetric").

    dofs is an array (n, 2) of node and direction. The result has the attributes structural, facts and warnings as well; each
    warning is given as SuspiciousMatrices. ReadError names file, line and reason.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "k.mtx")
    >>> with open(path, "w") as file:
    ...     print("%%MatrixMarket matrix coordinate real symmetric\\n2 2 3\\n1 1 2\\n2 1 -1\\n2 2 2", file=file)
    ...
    >>> found = hbvib.io.read(path)
    >>> found.stiffness.toarray()
    array([[ 2., -1.],
           [-1.,  2.]])
    >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=found.stiffness)  # in any format of scipy
    """
    named = [path, stiffness, mass, damping, structural]
    paths = [None if one is None else os.fsencode(os.fspath(one)) for one in named]
    if not any(paths):
        raise TypeError("read() needs a file")
    handle = ctypes.c_void_p()
    if _lib.hbvib_io_read_files(*paths, ctypes.byref(handle)) != 0:
        raise ReadError(_lib.hbvib_io_last_error().decode(errors="replace"))
    try:
        found = {}
        for which, name in enumerate(("mass", "damping", "stiffness", "structural")):
            matrix = _Matrix()
            absent = _lib.hbvib_io_matrix_of(handle, which, ctypes.byref(matrix))
            found[name] = None if absent else _sparse(matrix)
        count = _lib.hbvib_io_dofs(handle)
        table = np.empty((count, 2), np.int64)
        _lib.hbvib_io_dof_table(handle, table.ctypes.data)
        of_loss = found.pop("structural")
        contents = Matrices(dofs=table if count else None, **found)
        contents.structural, contents.facts, contents.warnings = of_loss, _lines(handle, 0), _lines(handle, 1)
    finally:
        _lib.hbvib_io_free(handle)
    files = ", ".join(os.fspath(one) for one in named if one is not None)
    for line in contents.warnings:
        warnings.warn(f"{files}: {line}", SuspiciousMatrices, stacklevel=2)
    return contents


def _checked(status: int) -> None:
    if status != 0:
        raise WriteError(_lib.hbvib_io_last_error().decode(errors="replace"))


def write(path: Any, *, stiffness: Any = None, mass: Any = None, damping: Any = None, structural: Any = None,
          dofs: Any = None, format: Optional[str] = None) -> None:
    """Writes matrices of one model, as a superelement for other programs; read() has them back.

    stiffness, mass, damping, structural   arrays or matrices of scipy; symmetric ones are written as a triangle.
    dofs    node and direction of each row, shape (n, 2), which DMIG and user elements have as names.
    format  "op4", "op4-binary", "dmig", "user-element", "npz" or "matrix-market"; that of the name unless given: .op4,
            .pch, .inp, .npz, .mtx.

    WriteError names the file and the reason.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "model.op4")
    >>> hbvib.io.write(path, stiffness=[[2, -1], [-1, 2]], mass=[[1, 0], [0, 1]])
    >>> hbvib.io.read(path).stiffness.toarray()
    array([[ 2., -1.],
           [-1.,  2.]])
    """
    from scipy import sparse  # type: ignore[import-untyped, unused-ignore]
    handle = ctypes.c_void_p()
    _checked(_lib.hbvib_io_new(ctypes.byref(handle)))
    try:
        for which, given in enumerate((mass, damping, stiffness, structural)):
            if given is None:
                continue
            a = sparse.coo_matrix(given)
            a.sum_duplicates()
            kind = np.complex128 if np.iscomplexobj(a.data) else np.float64
            symmetric = a.shape[0] == a.shape[1] and abs(a - a.T).nnz == 0
            if symmetric:
                a = sparse.tril(a).tocoo()
            row, column = (np.ascontiguousarray(index, np.uint32) for index in (a.row, a.col))
            values = np.ascontiguousarray(a.data, kind)
            view = _Matrix(a.shape[0], a.shape[1], len(values), kind is np.complex128, symmetric,
                           row.ctypes.data, column.ctypes.data, values.ctypes.data)
            _checked(_lib.hbvib_io_set_matrix(handle, which, ctypes.byref(view)))
        if dofs is not None:
            table = np.ascontiguousarray(dofs, np.int64)
            if table.ndim != 2 or table.shape[1] != 2:
                raise WriteError(f"dofs has the shape {table.shape}, needs (n, 2)")
            _checked(_lib.hbvib_io_set_dofs(handle, len(table), table.ctypes.data))
        named = None if format is None else format.encode()
        _checked(_lib.hbvib_io_write(handle, os.fsencode(os.fspath(path)), named))
    finally:
        _lib.hbvib_io_free(handle)


def write_universal(path: Any, *, nodes: Any = None, positions: Any = None, shapes: Any = (), functions: Any = ()) -> None:
    """Writes results of nodes as a universal file (UFF), which test programs read.

    nodes, positions   numbers of the nodes, and x, y, z of each, shape (n, 3).
    shapes      (text, frequency, nodes, motion) each: complex motion of nodes along x, y, z, shape (n, 3); data set 55.
    functions   (text, node, direction, frequencies, values) each: complex values over frequency, directions from 1; data set 58.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "shape.uff")
    >>> hbvib.io.write_universal(path, nodes=[7], positions=[[0, 0, 1]], shapes=[("first", 12.5, [7], [[0, 1j, 0.5]])],
    ...                          functions=[("response", 7, 3, [10, 20], [1, 2j])])
    >>> open(path).read().count("    -1")
    6
    """
    numbers = np.ascontiguousarray([] if nodes is None else nodes, np.int64)
    at = np.ascontiguousarray([] if positions is None else positions, np.float64)
    if at.size not in (0, 3 * numbers.size):
        raise WriteError(f"positions has {at.size} numbers, needs {3 * numbers.size}")
    handle = ctypes.c_void_p()
    _checked(_lib.hbvib_io_results_new(numbers.size, numbers.ctypes.data, at.ctypes.data if at.size else None,
                                       ctypes.byref(handle)))
    try:
        for text, frequency, of, motion in shapes:
            own, values = np.ascontiguousarray(of, np.int64), np.ascontiguousarray(motion, np.complex128)
            if values.size != 3 * own.size:
                raise WriteError(f"the shape {text!r} has {values.size} values, needs {3 * own.size}")
            _checked(_lib.hbvib_io_results_add_shape(handle, str(text).encode(), float(frequency), own.size, own.ctypes.data,
                                                     values.ctypes.data))
        for text, node, direction, frequencies, values in functions:
            x, y = np.ascontiguousarray(frequencies, np.float64), np.ascontiguousarray(values, np.complex128)
            if x.size != y.size:
                raise WriteError(f"the function {text!r} has {y.size} values, needs {x.size}")
            _checked(_lib.hbvib_io_results_add_function(handle, str(text).encode(), int(node), int(direction), x.size,
                                                        x.ctypes.data, y.ctypes.data))
        _checked(_lib.hbvib_io_results_write(handle, os.fsencode(os.fspath(path))))
    finally:
        _lib.hbvib_io_results_free(handle)
