"""Matrices of finite-element programs as scipy matrices: hbvib.io.read(path).

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

if TYPE_CHECKING:
    from ._results import IntArray

__all__ = ["Matrices", "ReadError", "SuspiciousMatrices", "read"]

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
