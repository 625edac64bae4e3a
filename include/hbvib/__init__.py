"""hbvib for Python: steady-state vibration of structures with friction contacts, by harmonic balance.

    M x'' + C x' + K x + f_contact(x) = f_excitation,      x(t) = Re sum_{h=0..H} X_h exp(i h omega t)

Two objects: a `Model` (matrices, contacts, forces) and the `Branch` of solutions that a solve returns.
Units are any consistent set; angular frequencies are in rad per time unit, amplitudes are peak values.
Degrees of freedom, points, contacts and harmonics count from 0. The mathematics, and what each option
means, is in the docstrings; the functions of hbvib.h are all reachable, with prototypes, as `hbvib.lib.hbvib_...`.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)  # of mass and ground
    >>> model.add_force(0, 0.2)  # 0.2 cos(omega t)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> print("%.4f" % branch.peaks().omega[0])
    1.2320

Errors      Below zero, a status is raised as a subclass of `Error` that is also Python's own (ValueError,
            IndexError, MemoryError ...). Above zero, the branch is returned and `StoppedEarly` is warned of,
            unless the caller stopped the solve. Wrong types are TypeError, wrong shapes ValueError.
Arrays      C- or Fortran-ordered and strided float64 and complex128 matrices are handed over without a
            copy; types that numpy calls safe to cast are converted; scipy.sparse matrices of any format are taken.
            Fields of a branch are read-only arrays in the library's own memory and keep the branch alive.
Threads     Any number of threads may solve one model and read one branch at once: calls release the GIL.
            Changing or freeing an object in use is BusyError.
Callbacks   run on the calling thread. An exception that they raise leaves the call that led there, the same object;
            an attribute `branch` holds the points found so far, if the solve had begun a branch.
Ctrl-C      stops every call that may be long within a fraction of a second: while it runs in the main thread, the
            handler of SIGINT is wrapped, as asyncio does, and KeyboardInterrupt carries `branch` as well where points
            were found. One factorisation of a large sparse matrix ends first.
"""
from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import inspect
import operator
import os
import signal
import sys
import threading
import warnings
import weakref
from typing import (TYPE_CHECKING, Any, Callable, Iterator, Literal, Mapping, Optional, Sequence, TypeVar, Union,
                    cast, overload)

import numpy as np
from numpy.typing import ArrayLike

from . import _c, _results, _types
from ._c import *
from ._c import _CALLBACKS, _FUNCTIONS, _STRUCTS, _VERSION
from ._results import *
from ._types import *

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._c import _Library
    from ._results import ComplexArray, FloatArray

    Hook = Optional[Callable[[Phase, float], Any]]

__all__ = [
    # errors
    "Error", "ArgumentError", "OutOfRangeError", "FreedError", "BusyError", "NumericalError", "UnsupportedError",
    "OutOfMemoryError", "CallbackError", "Stopped", "StoppedEarly",
    # objects
    "Model", "Parameter", "Sensitivities", "Batch", "Branch", "SavedBranch", "CancelFlag", "ForceCall",
    # functions
    "forced_response", "nonlinear_mode", "time_response", "verify", "floquet", "sensitivity", "evaluate_contact", "load",
    "get_include",
    # the C interface
    "lib", "structs",
]
__all__ += _c.__all__
__all__ += _results.__all__
__all__ += _types.__all__

_TYPES: dict[str, Any] = dict(
    int32=ctypes.c_int32, uint32=ctypes.c_uint32, int64=ctypes.c_int64, double=ctypes.c_double, size=ctypes.c_size_t,
    text=ctypes.c_char_p, pointer=ctypes.c_void_p, none=None, i=ctypes.c_int32, l=ctypes.c_int64, d=ctypes.c_double,
    z=ctypes.c_size_t, p=ctypes.c_void_p, h=ctypes.c_void_p)


def _argument(kind: str) -> Any:
    """Type of an argument: structs are passed by reference."""
    return ctypes.POINTER(_TYPES[kind]) if "hbvib_" + kind in structs else _TYPES[kind]


def _field(kind: str) -> Any:
    """Type of a field. The type of a callback is made when the first struct has it."""
    if kind in _CALLBACKS and kind not in _TYPES:
        arguments, _, result = _CALLBACKS[kind].partition(" -> ")
        _TYPES[kind] = ctypes.CFUNCTYPE(_TYPES[result], *map(_argument, arguments.split()))
    return _TYPES[kind]


def _struct(name: str, text: str) -> type:
    fields = []
    for group in text.split(";"):
        kind, *members = group.split()
        for member in members:
            member, _, length = member.rstrip("]").partition("[")
            fields.append((member, _field(kind) * int(length) if length else _field(kind)))
    return type(name, (ctypes.Structure,), {"_fields_": fields, "__module__": __name__})


#: The structs of the header by their C names, as ctypes types: structs["hbvib_contact"].
structs: dict[str, Any] = {}
for _entry in _STRUCTS.replace("\n    ", " ").strip().splitlines():
    _name, _, _text = _entry.partition(":")
    structs["hbvib_" + _name] = _TYPES[_name] = _struct("hbvib_" + _name, _text)

_ARGUMENTS, _RESULTS = {}, {}
for _entry in _FUNCTIONS.replace("\n    ", " ").strip().splitlines():
    _name, _, _text = _entry.partition(":")
    _text, _, _result = _text.partition(" -> ")
    _ARGUMENTS["hbvib_" + _name], _RESULTS["hbvib_" + _name] = _text.split(), _TYPES[_result or "int32"]


def _open(path: str) -> _Library:
    """Loads a library and gives its functions their prototypes. OSError where it is not the right one."""
    library: Any = ctypes.CDLL(path)
    try:
        for name, kinds in _ARGUMENTS.items():
            function = getattr(library, name)
            function.argtypes = [_argument(kind) for kind in kinds]
            function.restype = _RESULTS[name]
            if name == "hbvib_version":
                version = function()
                if (version >> 16, version >> 8 & 255) != _VERSION:
                    found = f"{version >> 16}.{version >> 8 & 255}.{version & 255}"
                    raise OSError(f"is version {found}, needs {_VERSION[0]}.{_VERSION[1]}")
    except AttributeError:
        raise OSError(f"has no function {name}") from None
    return cast("_Library", library)


_HERE = os.path.dirname(os.path.abspath(__file__))
_FOLDERS = [os.path.normpath(os.path.join(_HERE, folder)) for folder in (
    "", "../../target/release", "../../target/debug", "../../../lib", "../../lib")]


def _candidates() -> Iterator[str]:
    """Where the library may be: HBVIB_LIBRARY and nowhere else; or beside this module, in the cargo target folder, in
    the lib folder of an install prefix, then wherever the system's loader finds it."""
    named = os.environ.get("HBVIB_LIBRARY")
    if named is not None:
        yield named if os.path.dirname(named) else os.path.join(os.curdir, named)
        return
    names = dict(win32=["hbvib.dll"], darwin=["libhbvib.dylib"]).get(
        sys.platform, [f"libhbvib.so.{_VERSION[0]}.{_VERSION[1]}", "libhbvib.so"])
    paths = (os.path.join(place, name) for place in _FOLDERS for name in names)
    yield from filter(os.path.exists, paths)
    yield names[0]
    yield from filter(None, [ctypes.util.find_library("hbvib")])


def _load() -> _Library:
    """The first library that is the right one. ImportError says what was tried."""
    tried = []
    for path in _candidates():
        try:
            return _open(path)
        except OSError as error:
            tried.append(f"{path}: {error}")
    if "HBVIB_LIBRARY" in os.environ:
        raise ImportError(f"HBVIB_LIBRARY names no library of hbvib: {tried[0]}")
    raise ImportError("no library of hbvib in " + ", ".join(_FOLDERS)
                      + " or where the system looks; tried " + "; ".join(tried))


#: The library itself, every function of hbvib.h with its prototype: hbvib.lib.hbvib_version().
lib = _load()
__version__ = lib.hbvib_version_string().decode()


def get_include() -> str:
    """The folder of hbvib.h, hbvib.hpp, hbvib.f90 and hbvib_io.h, for compilers.

    >>> import hbvib, os
    >>> os.path.exists(os.path.join(hbvib.get_include(), "hbvib.h"))
    True
    """
    places = [os.path.join(_HERE, folder) for folder in ("include", "..", "../../../include")]
    return os.path.normpath(next(filter(lambda place: os.path.exists(os.path.join(place, "hbvib.h")), places), places[0]))


def __getattr__(name: str) -> Any:
    """hbvib.io: the readers of finite-element files, a module and library of their own, loaded on first use."""
    if name != "io":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import io
    return io


# ------------------------------------------------------------------------------------------ errors


class Error(Exception):
    """An error of the library. `sentence` says what is wrong, where, and what is accepted; `status` is the
    Status; `argument` counts the arguments of the C function from 1, 0 where no single one is to blame."""

    def __init__(self, sentence: str, status: int = Status.E_INTERNAL, argument: int = 0) -> None:
        super().__init__(sentence)
        self.sentence, self.status, self.argument = sentence, status, argument


class ArgumentError(Error, ValueError):
    """A value, count, number, matrix or combination that is not accepted."""


class OutOfRangeError(Error, IndexError):
    """An index lies outside its range."""


class FreedError(Error, ValueError):
    """The object was freed."""


class BusyError(Error, RuntimeError):
    """The object is in use by a running call."""


class NumericalError(Error, ArithmeticError):
    """No solution: singular, not converged, unbounded, a matrix that is not positive definite."""


class UnsupportedError(Error, NotImplementedError):
    """The requested combination is not provided."""


class OutOfMemoryError(Error, MemoryError):
    """Memory could not be had."""


class CallbackError(Error, RuntimeError):
    """A force callback refused, or wrote numbers that are not finite."""


class Stopped(Error):
    """A phase callback or the cancel flag stopped a call that has no points to keep."""


class StoppedEarly(RuntimeWarning):
    """A solve ended before its range did; `status` is the Status. Turned into an error by a warning filter, its
    attribute `branch` holds the branch."""

    def __init__(self, sentence: str, status: int = Status.OK) -> None:
        super().__init__(sentence)
        self.status = status


_ERRORS = {getattr(Status, "E_" + name): kind for kind, names in (
    (ArgumentError, "NULL ARGUMENT DIMENSION NOT_FINITE NOT_HERMITIAN STRUCT_SIZE"), (OutOfRangeError, "INDEX"),
    (FreedError, "HANDLE"), (BusyError, "BUSY"), (UnsupportedError, "UNSUPPORTED"), (CallbackError, "CALLBACK"),
    (NumericalError, "SINGULAR NO_CONVERGENCE NO_BOUNDED_SOLUTION NOT_POSITIVE_DEFINITE"),
    (OutOfMemoryError, "OUT_OF_MEMORY")) for name in names.split()}


def _sentence(status: int) -> str:
    return (lib.hbvib_last_error() or lib.hbvib_status_name(status)).decode(errors="replace")


# ------------------------------------------------------------------------------------------ conversions


def _whole(value: Any, bits: int = 64) -> int:
    """A whole number that fits, which ctypes does not check."""
    number = operator.index(value)
    if not -(1 << bits - 1) <= number < 1 << bits - 1:
        raise OverflowError(f"{number} does not fit into {bits} bits")
    return number


def _real(value: Any) -> float:
    if isinstance(value, (str, bytes)):
        raise TypeError(f"needs a real number, not {value!r}")
    return float(value)


def _pointer(value: Any) -> Any:
    """Address of an array, reference to a ctypes object, None as NULL."""
    if isinstance(value, np.ndarray):
        return value.__array_interface__["data"][0]
    return ctypes.byref(value) if isinstance(value, (ctypes.Structure, ctypes._SimpleCData)) else value


_CONVERT: dict[str, Any] = dict(i=lambda value: _whole(value, 32), l=_whole, d=_real, z=_whole)
_CONVERTERS = {name: [_CONVERT.get(kind, _pointer) for kind in kinds] for name, kinds in _ARGUMENTS.items()}


def _member(kind: Any, value: Any) -> Any:
    """A member of an enumeration, its name in any case, or its number."""
    if not isinstance(value, str):
        return kind(value)
    try:
        return kind[value.upper()]
    except KeyError:
        names = ", ".join(name.lower() for name in kind.__members__)
        raise ValueError(f"{value!r} is no {kind.__name__}: needs one of {names}") from None


def _array(name: str, value: Any, dtype: Any = np.float64, shape: Optional[Sequence[Any]] = None) -> np.ndarray:
    """A packed array of `dtype`; only the lengths of `shape` that are not None are demanded.

    TypeError where numbers would be lost, ValueError for another shape."""
    array = _numbers(name, value, dtype)
    if shape is not None and (array.ndim != len(shape) or any(
            want is not None and want != have for want, have in zip(shape, array.shape))):
        need = ", ".join("any" if want is None else str(want) for want in shape)
        raise ValueError(f"{name} has shape {array.shape}, needs ({need})")
    return np.require(array, dtype, ["C", "A"])


def _numbers(name: str, value: Any, dtype: Any) -> np.ndarray:
    if np.ma.is_masked(value):
        raise TypeError(f"{name} has masked entries")
    array = np.asarray(value)
    if array.size and not np.can_cast(array.dtype, dtype, "safe"):
        raise TypeError(f"{name} holds {array.dtype}, which is not {np.dtype(dtype)} without loss")
    return array


def _counted_array(name: str, value: Any, dtype: Any = np.float64, shape: Sequence[Any] = (None,)) -> dict[str, Any]:
    """An optional array, and its length beside it, as options have them."""
    if value is None:
        return {}
    array = _array(name, [value] if np.ndim(value) == 0 else value, dtype, shape)
    return {name: array, name + "_len": array.size}


def _range(name: str, value: Any, example: str, single: bool = False) -> tuple[Any, Any]:
    """Start and stop of a range; a list of values to solve at is refused with the way to give one."""
    if single and np.ndim(value) == 0:
        return value, value
    if np.ndim(value) == 0 or len(value) != 2:
        entries = "is one number" if np.ndim(value) == 0 else f"has {len(value)} entries"
        raise ValueError(f"{name} {entries}, needs (start, stop){' or one number' if single else ''}: steps within the"
                         f" range are chosen by the library; values to be solved at exactly go to at=, as {example}")
    start, stop = value
    return start, stop


def _columns(**columns: tuple[Any, ...]) -> list[Any]:
    """Packed one-dimensional arrays of one length from numbers and arrays, given as (value, dtype)."""
    arrays = [_numbers(name, *given) for name, given in columns.items()]
    try:
        (length,) = np.broadcast_shapes((1,), *(array.shape for array in arrays))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(columns, arrays))
        raise ValueError(f"arrays of different shapes: {shapes}") from None
    return [np.require(np.broadcast_to(array, length), dtype, ["C", "A"])
            for array, (_, dtype) in zip(arrays, columns.values())]


def _new(name: str, **values: Any) -> Any:
    """A struct filled by its _init function, then with `values`; it keeps the arrays that it points to."""
    struct = structs[name]()
    getattr(lib, name + "_init")(struct, ctypes.sizeof(struct))
    kinds = dict(struct._fields_)
    for key, value in values.items():
        kind = kinds[key]
        if hasattr(kind, "_length_"):
            value = kind(*_array(key, value, shape=[kind._length_]))
        elif kind is ctypes.c_void_p and value is not None:
            struct.__dict__.setdefault("arrays", []).append(value)
            value = _pointer(value)
        elif kind is ctypes.c_double:
            value = _real(value)
        elif kind in (ctypes.c_int32, ctypes.c_int64):
            value = _whole(value, 8 * ctypes.sizeof(kind))
        setattr(struct, key, value)
    return struct


def _options(caller: str, name: str, given: Mapping[str, Any], hidden: str = "", **more: Any) -> Any:
    """A struct from the user's keyword arguments and `more`: TypeError for one that is no field or hidden."""
    fields = {field for field, _ in structs[name]._fields_} - {"struct_size", "reserved", *hidden.split()}
    for key in given:
        if key not in fields:
            raise TypeError(f"{caller}() got an unexpected keyword argument {key!r}; options are "
                            + ", ".join(sorted(fields)))
    return _new(name, **given, **more)


_Function = TypeVar("_Function", bound="Callable[..., Any]")


def _with_options(struct: str, options: type) -> Callable[[_Function], _Function]:
    """Gives a function with **options the signature and the text of its options, with the defaults of the library."""

    def decorated(function: _Function) -> _Function:
        defaults = _new(struct)
        signature = inspect.signature(function)
        known = [parameter for parameter in signature.parameters.values() if parameter.kind != parameter.VAR_KEYWORD]
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=getattr(defaults, name),
                                  annotation=getattr(kind, "__forward_arg__", kind))
                for name, kind in options.__annotations__.items()]
        function.__signature__ = signature.replace(parameters=known + more)  # type: ignore[attr-defined]
        if function.__doc__ and options.__doc__:
            listed = options.__doc__.partition("\n\n")[2].strip("\n").replace("\n", "\n    ")
            function.__doc__ = function.__doc__.replace("{options}", listed.strip())
        return function

    return decorated


def _matrix(value: Any, part: Any) -> Any:
    """Description of a matrix: dense without a copy where its strides allow, sparse of any scipy format."""
    part = _member(Part, part)
    if hasattr(value, "tocsc"):
        sparse = value.tocsc()
        numbers = _numbers("matrix", sparse.data, np.complex128)
        number: Any = np.complex128 if numbers.dtype.kind == "c" else np.float64
        rows, cols = sparse.shape
        starts = _array("indptr", sparse.indptr, np.int64, [cols + 1])
        places = _array("indices", sparse.indices, np.int64, [None])
        if starts[-1] > min(len(places), len(numbers)):  # all that the library cannot check itself
            raise ValueError(
                f"matrix: indptr ends at {starts[-1]}, beyond {len(places)} indices and {len(numbers)} numbers")
        return _new("hbvib_matrix", storage=Storage.CSC, scalar=int(number is np.complex128), part=part, rows=rows,
                    cols=cols, values=_array("matrix", numbers, number), col_ptr=starts, row_idx=places)
    dense = _numbers("matrix", value, np.complex128)
    if dense.ndim == 0:
        dense = dense.reshape(1, 1)
    if dense.ndim != 2:
        raise ValueError(f"matrix has shape {dense.shape}, needs two dimensions")
    kind: Any = np.complex128 if dense.dtype.kind == "c" else np.float64
    dtype = np.dtype(kind)
    if not np.can_cast(dense.dtype, dtype, "safe"):
        raise TypeError(f"matrix holds {dense.dtype}, which is not {dtype} without loss")
    dense = np.require(dense, dtype, "A")  # native and aligned; no copy of what is
    (rows, cols), (down, right), size = dense.shape, dense.strides, dtype.itemsize
    if (right == size or cols == 1) and down % size == 0 and down >= cols * size:
        storage, distance = Storage.ROW_MAJOR, down // size
    elif (down == size or rows == 1) and right % size == 0 and right >= rows * size:
        storage, distance = Storage.COL_MAJOR, right // size
    else:
        dense = np.ascontiguousarray(dense)
        storage, distance = Storage.ROW_MAJOR, 0
    return _new("hbvib_matrix", storage=storage, scalar=int(dtype.kind == "c"), part=part, rows=rows, cols=cols,
                ld=distance, values=dense)


# Structs of results by their classes, and what enumerations and truth values in them are made of.
_RECORDS: dict[type, tuple[str, dict[str, Callable[..., Any]]]] = {
    Energy: ("hbvib_energy", {}),
    ContactSummary: ("hbvib_contact_summary", {}),
    ModePoint: ("hbvib_mode_point", {}),
    ModeInfo: ("hbvib_mode_info", dict(multiple=ModeMultiple)),
    Reduction: ("hbvib_reduction", dict(mean_carried=bool, even_removed=bool)),
    JacobianGap: ("hbvib_jacobian_gap", dict(tangent=Tangent)),
    TimeInfo: ("hbvib_time_info", {}),
    VerificationInfo: ("hbvib_verification", dict(same_solution=bool, marched=bool,
                                                  response=lambda pair: complex(*pair))),
}
_Record = TypeVar("_Record", bound="tuple[Any, ...]")


def _record(kind: type[_Record], filled: Any) -> _Record:
    """A named tuple of the fields of a struct that the library has filled."""
    makers = _RECORDS[kind][1]
    values = {name: getattr(filled, name) for name in kind._fields}  # type: ignore[attr-defined]
    whole = {name: tuple(value) if isinstance(value, ctypes.Array) else value for name, value in values.items()}
    return kind(**{name: makers[name](value) if name in makers else value for name, value in whole.items()})


# ------------------------------------------------------------------------------------------ calls

_running = threading.local()  # .guard: the guard of the innermost call of this thread


class _Guard:
    """Surrounds one call of the library that may run callbacks: holds what they raise and raises it, whole, when
    the call is over. The handler of SIGINT must not raise where a callback is entered, outside of any try, where
    ctypes would drop the exception: there it is run by the guard."""

    def __init__(self) -> None:
        self.held: Optional[BaseException] = None
        self.branch: Optional[Branch] = None
        self.batch: Optional[Batch] = None
        self.inside = False  # a callback is running
        self.ended: Optional[Callable[[], Any]] = None  # run at the end
        self.wrapped = False  # the handler of SIGINT is this one

    def __enter__(self) -> _Guard:
        self.before: Any = signal.getsignal(signal.SIGINT)
        outer = getattr(self.before, "__self__", None)
        self.handler: Any = outer.handler if isinstance(outer, _Guard) else self.before
        if callable(self.handler):
            with contextlib.suppress(ValueError):  # not the main thread, which alone handles signals
                signal.signal(signal.SIGINT, self.interrupted)
                self.wrapped = True
        self.outer, _running.guard = getattr(_running, "guard", None), self
        return self

    def __exit__(self, *_: Any) -> None:
        _running.guard = self.outer
        if self.ended is not None:
            self.ended()
        if self.wrapped and signal.getsignal(signal.SIGINT) == self.interrupted:  # else a callback set its own
            signal.signal(signal.SIGINT, self.before)
        held, self.held = self.held, None
        if held is not None:
            if self.branch is not None:
                with contextlib.suppress(AttributeError, TypeError):  # an exception without room for it
                    held.branch = self.branch  # type: ignore[attr-defined]
            if self.batch is not None:
                with contextlib.suppress(AttributeError, TypeError):
                    held.batch = self.batch  # type: ignore[attr-defined]
            try:
                raise held
            finally:
                del held  # else it would hold this frame, and this frame it

    def interrupted(self, number: int, frame: Any) -> None:
        if self.inside:
            self.handler(number, frame)
        else:
            self.run(self.handler, number, frame)

    def run(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Result of a callback, None where it raised."""
        try:
            self.inside = True
            result = function(*arguments)
            self.inside = False
            return result
        except BaseException as error:  # goes through C and is raised on the other side
            self.inside = False
            self.held = error if self.held is None else self.held
            return None


def _call(name: str, *arguments: Any, guard: Optional[_Guard] = None) -> int:
    """Calls a function of the library with Python's numbers and arrays. Raises Error below zero, unless a guard
    holds what a callback raised, which comes first."""
    status: int = getattr(lib, name)(*[convert(value) for convert, value in zip(_CONVERTERS[name], arguments)])
    if status < 0 and (guard is None or guard.held is None):
        known = Status(status) if status in Status.__members__.values() else status
        raise _ERRORS.get(known, Error)(_sentence(status), known, lib.hbvib_last_error_argument())
    return status


class CancelFlag:
    """Stops a call from another thread: `set()` is looked at in every long loop. Hand it in as cancel=.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> cancel = hbvib.CancelFlag()
    >>> cancel.set()  # another thread would do it
    >>> branch = model.forced_response((0.8, 1.6), cancel=cancel)
    >>> branch.status
    <Status.STOPPED_BY_CALLER: 1>
    """

    def __init__(self) -> None:
        self.value = ctypes.c_int32(0)

    def set(self) -> None:
        self.value.value = 1

    def clear(self) -> None:
        self.value.value = 0

    def is_set(self) -> bool:
        return self.value.value != 0


def _refused(answer: Any) -> bool:
    return isinstance(answer, (bool, np.bool_)) and not answer


def _progress_bar(guard: _Guard) -> Callable[..., Any]:
    """A callback that shows a bar, which ends with the call."""
    from ._progress import Bar
    bar = Bar()
    guard.ended = bar.close
    return bar


def _hooks(guard: _Guard, progress: Any, log: Any, log_level: Any, cancel: Optional[CancelFlag],
           phase: Any = None) -> Any:
    """The hooks of one call. Ctrl-C and failures of `log` need the callback of phases, too."""
    if progress is True or progress is False:
        progress = _progress_bar(guard) if progress else None
    for name, function in (("progress", progress), ("log", log), ("phase", phase)):
        if function is not None and not callable(function):
            raise TypeError(f"{name} is not callable")
    if cancel is not None and not isinstance(cancel, CancelFlag):
        raise TypeError("cancel needs a CancelFlag")

    def stops(state: Any) -> bool:
        try:
            return _refused(progress(Progress(*(getattr(state, name) for name in Progress._fields))))
        except StopIteration:
            return True

    def on_progress(_: Any, state: Any) -> int:
        stop = progress is not None and guard.held is None and guard.run(stops, state.contents)
        return int(stop or guard.held is not None)

    def refuses(report: Any) -> bool:
        known = Phase(report.phase) if report.phase in Phase.__members__.values() else report.phase
        try:
            return _refused(phase(known, report.share))
        except StopIteration:
            return True

    def on_phase(_: Any, report: Any) -> int:
        stop = phase is not None and guard.held is None and guard.run(refuses, report.contents)
        return int(stop or guard.held is not None)

    def on_log(_: Any, level: int, text: bytes) -> None:
        guard.run(log, LogLevel(level), text.decode(errors="replace"))

    hooks = _new("hbvib_hooks")
    if progress is not None or phase is not None or log is not None or guard.wrapped:
        hooks.progress = _TYPES["progress_fn"](on_progress)
        hooks.phase = _TYPES["phase_fn"](on_phase)
    if log is not None:
        hooks.log, hooks.log_level = _TYPES["log_fn"](on_log), _member(LogLevel, log_level)
    if cancel is not None:
        hooks.cancel = ctypes.addressof(cancel.value)
    return hooks


def _stoppable(name: str, *arguments: Any, phase: Optional[Callable[..., Any]] = None,
               cancel: Optional[CancelFlag] = None) -> int:
    """Calls a function that has no points to keep by its variant with hooks, so that Ctrl-C stops it as well."""
    with _Guard() as guard:
        hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
        status = _call(name + "_with_hooks", *arguments, hooks, guard=guard)
    if status == Status.STOPPED_BY_CALLER:
        raise Stopped(_sentence(status), Status(status), 0)
    return status


class ForceCall:
    """One period for which a user force is computed, in the names of hbvib_force_call: omega, samples N, n, states s,
    and arrays in the library's own memory, valid during the callback only (copy what you keep):

    in   u (N, n), v (N, n), z0 (s);                                       read-only
    out  f (N, n), df_du and df_dv (N, n, n), z (N, s), dz_dz (N, s, s), dz_du_before, dz_du, dz_dv_before and
         dz_dv (N, s, n), dz_domega (N, s), df_dz (N, n, s).

    v, df_dv, dz_dv and dz_dv_before are None unless uses_velocity, all with a z unless there are states.

    >>> import hbvib
    >>> def damper(call: hbvib.ForceCall) -> None:
    ...     call.f[:] = 0.1 * call.v
    ...     call.df_dv[:, 0, 0] = 0.1
    ...
    >>> model = hbvib.Model(mass=1, stiffness=1)
    >>> model.add_user_force([0], damper, uses_velocity=True, is_odd=True)
    0
    """

    omega: float
    samples: int
    n: int
    states: int
    u: FloatArray
    v: FloatArray
    z0: FloatArray
    f: FloatArray
    df_du: FloatArray
    df_dv: FloatArray
    z: FloatArray
    dz_dz: FloatArray
    dz_du_before: FloatArray
    dz_du: FloatArray
    dz_dv_before: FloatArray
    dz_dv: FloatArray
    dz_domega: FloatArray
    df_dz: FloatArray

    _SHAPES = dict(u="Nn", v="Nn", z0="s", f="Nn", df_du="Nnn", df_dv="Nnn", z="Ns", dz_dz="Nss", dz_du_before="Nsn",
                   dz_du="Nsn", dz_dv_before="Nsn", dz_dv="Nsn", dz_domega="Ns", df_dz="Nns")

    def __init__(self, call: Any) -> None:
        self._call = call
        self.omega, self.samples, self.n, self.states = call.omega, call.samples, call.n, call.states

    def __getattr__(self, name: str) -> Optional[np.ndarray]:
        if name not in self._SHAPES:  # each array is made at its first use
            raise AttributeError(name)
        address, lengths, array = getattr(self._call, name), dict(N=self.samples, n=self.n, s=self.states), None
        if address:
            shape = [lengths[letter] for letter in self._SHAPES[name]]
            count = int(np.prod(shape))
            array = np.frombuffer((ctypes.c_double * count).from_address(address)).reshape(shape)  # type: ignore[call-overload]
            array.flags.writeable = name not in ("u", "v", "z0")
        setattr(self, name, array)
        return array


class _Owner:
    """Owns a handle of the library, and the callables that the library may call on its behalf."""

    _handle: Optional[int] = None
    _kept: Any = ()

    @property
    def handle(self) -> int:
        """The handle, for functions of `hbvib.lib`. FreedError once the object was freed."""
        if self._handle is None:
            raise FreedError(f"this {type(self).__name__} was freed", Status.E_HANDLE, 1)
        return self._handle

    def _call(self, name: str, *arguments: Any) -> int:
        """Calls a function whose first argument is the handle."""
        if not self._kept:
            return _call(name, self.handle, *arguments)
        with _Guard() as guard:
            return _call(name, self.handle, *arguments, guard=guard)

    def _listed(self, name: str, arguments: tuple[Any, ...], dtypes: Sequence[Any],
                stop: Optional[dict[str, Any]] = None) -> list[Any]:
        """Arrays as long as the library says: a first call gets the count, a second one the numbers."""

        def run(*more: Any) -> int:
            if stop is None:
                return self._call(name, *arguments, *more)
            return _stoppable(name, self.handle, *arguments, *more, **stop)

        count = ctypes.c_int64()
        run(0, *[None] * len(dtypes), count)
        arrays = [np.empty(count.value, dtype) for dtype in dtypes]
        run(count.value, *arrays, count)
        return arrays

    def __enter__(self) -> Any:
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        """Frees the object, unless that was done inside."""
        try:
            if self._handle is not None:
                self.free()
        except (BufferError, BusyError):
            if kind is None:  # else another exception is on its way, whose traceback may hold the arrays
                raise

    @property
    def is_freed(self) -> bool:
        """Whether `free` was called."""
        return self._handle is None

    def free(self) -> None:
        raise NotImplementedError


# ------------------------------------------------------------------------------------------ model

# Places of the directions t1, t2, n in which a law acts.
_PLACES = {ContactKind.FRICTION_2D: (0, 2), ContactKind.FRICTION_3D: (0, 1, 2), ContactKind.UNILATERAL: (2,)}


def _side(kind: Any, dofs: Any) -> list[Any]:
    """The three places of one side: given as three, or as the directions of the law in their order."""
    given = [_whole(dof) for dof in ([dofs] if np.ndim(dofs) == 0 else dofs)]
    if len(given) == 3:
        return given
    places = _PLACES.get(kind, (0,))
    if not 0 < len(given) <= len(places):
        raise ValueError(f"{len(given)} degrees of freedom on a side, {kind.name} has {len(places)} or three places")
    side = [GROUND] * 3
    for place, dof in zip(places, given):
        side[place] = dof
    return side


# Constants without which a law has no force, or another one than its name says.
_REQUIRED = {
    ContactKind.JENKINS: ("kt", "mu", "preload"), ContactKind.FRICTION_2D: ("kt", "kn", "mu"),
    ContactKind.FRICTION_3D: ("kt", "mu"), ContactKind.UNILATERAL: ("kn",), ContactKind.CUBIC: ("cubic",),
    ContactKind.REGULARISED: ("mu", "preload", "velocity")}


def _law(caller: str, kind: Any, constants: Mapping[str, Any]) -> Any:
    law = _member(ContactKind, kind)
    missing = [name for name in _REQUIRED.get(law, ()) if name not in constants]
    if missing:
        raise TypeError(f"{caller}() of {law.name.lower()!r} misses {', '.join(missing)}")
    return _options(caller, "hbvib_contact", constants, "kind dof_a dof_b", kind=law)


class Parameter:
    """A parameter of a model, by which results are differentiated.

    kind       "force": a factor on all forces; "preload", "mu", "kt", "kn", "gap": a constant of a contact; "mass",
               "damping", "stiffness"; "speed": the fixed speed of rotation; or a ParameterKind.
    contact    number of the contact; -1: the constant of all contacts that have it, changed together.
    direction  of mass, damping and stiffness, ndof x ndof: the parameter is the coefficient, 0 at present, of this
               matrix, which is added; in a cyclic model to the block of the sector itself.
    scaling    "additive", or "factor": a factor, 1 at present, on the whole matrix with its couplings.

    >>> import hbvib
    >>> hbvib.Parameter("kt", contact=0)
    hbvib.Parameter('kt', contact=0)
    """

    def __init__(self, kind: Any, contact: int = -1, direction: Any = None, scaling: Any = "additive") -> None:
        self.kind, self.contact = _member(ParameterKind, kind), contact
        self.direction, self.scaling = direction, _member(Scaling, scaling)

    def __repr__(self) -> str:
        text = f"hbvib.Parameter({self.kind.name.lower()!r}"
        if self.contact != -1:
            text += f", contact={self.contact}"
        if self.direction is not None:
            text += ", direction=..."
        return text + (", scaling='factor')" if self.scaling == Scaling.FACTOR else ")")

    def _description(self) -> Any:
        described = _new("hbvib_parameter", kind=self.kind, contact=self.contact, scaling=self.scaling)
        if self.direction is not None:
            described.matrix = _matrix(self.direction, Part.GENERAL)  # kept as long as the struct
            described.direction = ctypes.addressof(described.matrix)
        return described


class Sensitivities(np.ndarray):
    """Derivatives of a result by parameters, an array in their order; `reasons` has for each the reason why it is NaN,
    or an empty text."""
    reasons: tuple[str, ...]

    def __array_finalize__(self, other: Any) -> None:
        self.reasons = getattr(other, "reasons", ())


class Model(_Owner):
    """A structure with its contacts and forces; `Model.cyclic` makes one of equal sectors, `Model.sector` one of a
    sector with both faces.

    ndof       degrees of freedom; may be left out where a matrix is given.
    mass, damping, stiffness   ndof x ndof matrices, symmetric or Hermitian: arrays, scipy.sparse, or a number for
               one degree of freedom; zero where left out. See `set_matrix` for others.
    rayleigh   (alpha, beta): adds alpha M + beta K to the damping.

    Freed by `free`, at the end of a `with` block, or with the last reference. `copy.copy` and `clone` copy it.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> model
    <hbvib.Model: 1 degree of freedom, 1 contact>
    """

    def __init__(self, ndof: Optional[int] = None, *, mass: Any = None, damping: Any = None, stiffness: Any = None,
                 rayleigh: Optional[Sequence[float]] = None) -> None:
        self._create(None, ndof, dict(mass=mass, damping=damping, stiffness=stiffness), {}, rayleigh)

    @classmethod
    def cyclic(cls, ndof: Optional[int] = None, *, sectors: int, engine_order: int = 0, mass: Any = None,
               damping: Any = None, stiffness: Any = None, coupling: Optional[dict[str, Any]] = None,
               rayleigh: Optional[Sequence[float]] = None) -> Model:
        """A wheel of equal sectors under an engine order; ndof and matrices are those of one sector.

        coupling   matrices of a sector (rows) to the next one (columns): dict(stiffness=..., mass=...).
        engine_order   sector s + 1 lags behind s by 2 pi engine_order / sectors per harmonic; any sign and size.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model
        <hbvib.Model: 1 degree of freedom, 8 sectors, engine order 2, 0 contacts>
        >>> model.linear_modes(1, diameter=2).omega.round(12)
        array([1.73205081])
        """
        model = cls.__new__(cls)
        model._create(sectors, ndof, dict(mass=mass, damping=damping, stiffness=stiffness), coupling or {}, rayleigh)
        model.set_wave(engine_order)
        return model

    @classmethod
    def sector(cls, *, stiffness: Any, mass: Any, damping: Any = None, sectors: int, engine_order: int,
               left: ArrayLike, right: ArrayLike, fixed: ArrayLike = (), frame: Any = "cartesian",
               axis: ArrayLike = (0, 0, 1), direction: int = 1, coordinates: Any = None) -> Model:
        """A wheel from one sector with both faces, as a finite-element program writes it. The numbering of the sector
        is kept for matrices, contacts, forces and results; its couplings follow from its matrices.

        stiffness, mass, damping   matrices of the sector, with the degrees of freedom of both faces.
        left, right   degrees of freedom of both faces, of equal shape: (pairs, 3) x, y, z, or (pairs, 6) with
                      rotations, in a Cartesian frame, any shape in a cylindrical one; -1 where a component is missing.
        fixed         degrees of freedom that do not move.
        frame         "cartesian": the axes of both faces are equal; "cylindrical": any frame that turns with the
                      sector, as r, theta, z at each node.
        axis          of the wheel, through the origin.
        direction     1 or -1: sense about the axis in which sector s + 1 follows s. The wave has its sense from the
                      sign of engine_order.
        coordinates   (left, right), Cartesian positions of the nodes, (pairs, 3) each, which are then checked.

        >>> import hbvib
        >>> import numpy as np
        >>> k = np.array([[1, -1], [-1, 1]])  # a spring from the left face to the right one
        >>> model = hbvib.Model.sector(stiffness=k, mass=np.eye(2) / 2, sectors=8, engine_order=2, left=[0], right=[1],
        ...                            frame="cylindrical")
        >>> model.linear_modes(1, diameter=2).omega.round(12)  # sqrt(2 - 2 cos(2 pi 2 / 8))
        array([1.41421356])
        """
        faces = [_array(name, face, np.int64) for name, face in (("left", left), ("right", right))]
        for name, face in zip(("left", "right"), faces):
            if face.ndim not in (1, 2):
                raise ValueError(f"{name} has shape {face.shape}, needs (pairs, components)")
        if faces[0].ndim == faces[1].ndim == 2 and faces[0].shape[1] != faces[1].shape[1]:
            raise ValueError(f"left has shape {faces[0].shape}, right {faces[1].shape}: needs equal shapes")
        components = faces[0].shape[1] if faces[0].ndim == 2 else 1
        places = dict.fromkeys(("left_coordinates", "right_coordinates"))
        if coordinates is not None:
            for name, face, positions in zip(places, faces, coordinates):
                places[name] = _array(name, positions, np.float64, [len(face), 3])
        still = _array("fixed", fixed if np.size(fixed) else np.empty(0, np.int64), np.int64).ravel()
        ndof = (*np.shape(stiffness), 1)[0]
        description = _new("hbvib_sector", frame=_member(SectorFrame, frame), ndof=ndof, sectors=sectors,
                           engine_order=engine_order, components=components, left=faces[0], left_len=faces[0].size,
                           right=faces[1], right_len=faces[1].size, fixed=still, fixed_len=still.size, axis=axis,
                           direction=direction, **places)
        model, handle = cls.__new__(cls), ctypes.c_void_p()
        model._handle = None
        _call("hbvib_cyclic_from_sector", description, handle)
        model._handle, model._kept = handle.value, []
        for kind, value in (("stiffness", stiffness), ("mass", mass), ("damping", damping)):
            if value is not None:
                model.set_matrix(kind, value)
        return model

    def _create(self, sectors: Any, ndof: Any, matrices: dict[str, Any], coupling: dict[str, Any],
                rayleigh: Any) -> None:
        given = [(kind, value) for kind, value in matrices.items() if value is not None]
        if ndof is None:
            if not given:
                raise TypeError("needs ndof or a matrix")
            ndof = (*np.shape(given[0][1]), 1)[0]
        handle = ctypes.c_void_p()
        if sectors is None:
            _call("hbvib_model_new", ndof, handle)
        else:
            _call("hbvib_cyclic_new", ndof, sectors, handle)
        self._handle, self._kept = handle.value, []
        for kind, value in given:
            self.set_matrix(kind, value)
        for kind, value in coupling.items():
            self.set_coupling(kind, value)
        if rayleigh is not None:
            self.set_rayleigh(*rayleigh)

    def __repr__(self) -> str:
        if self._handle is None:
            return "<hbvib.Model, freed>"
        from ._summary import model_line
        return model_line(self)

    def _repr_html_(self) -> str:
        from ._summary import model_table
        return model_table(self)

    def __del__(self, free: Any = lib.hbvib_model_free) -> None:
        if self._handle is not None:
            free(self._handle)

    def free(self) -> None:
        """Frees the model; branches solved from it stay. FreedError if it was freed, BusyError while in use.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.free()
        >>> model
        <hbvib.Model, freed>
        """
        _call("hbvib_model_free", self.handle)
        self._handle, self._kept = None, []

    def clone(self) -> Model:
        """A copy with the same matrices, contacts, forces and user forces.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> copy = model.clone()
        >>> copy.add_force(0, 0.2)
        >>> len(copy.forces.dof), len(model.forces.dof)
        (1, 0)
        """
        handle, kept = ctypes.c_void_p(), self._kept
        self._call("hbvib_model_clone", handle)
        copy = type(self).__new__(type(self))
        copy._handle, copy._kept = handle.value, list(kept)
        return copy

    __copy__ = clone

    def __deepcopy__(self, _: dict[str, Any]) -> Model:
        return self.clone()

    def to_bytes(self) -> bytes:
        """The model as bytes of a versioned format with a checksum: from_bytes makes it again, in any process, and it
        solves to the same bits. pickle uses it. UnsupportedError for a model with a user force.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> data = model.to_bytes()
        >>> hbvib.Model.from_bytes(data)
        <hbvib.Model: 1 degree of freedom, 1 contact>
        """
        size = ctypes.c_int64()
        self._call("hbvib_model_save", 0, None, size)
        room = np.empty(size.value, np.uint8)
        self._call("hbvib_model_save", room.size, room, size)
        return room.tobytes()

    @classmethod
    def from_bytes(cls, data: Any) -> Model:
        """The model that to_bytes saved. ArgumentError for bytes that are no such model, incomplete or damaged,
        UnsupportedError for those of a newer format.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> hbvib.Model.from_bytes(model.to_bytes()).forces.force
        array([0.2+0.j])
        """
        given = np.frombuffer(data, np.uint8)
        model, handle = cls.__new__(cls), ctypes.c_void_p()
        model._handle = None
        _call("hbvib_model_load", given.size, given, handle)
        model._handle, model._kept = handle.value, []
        return model

    def save(self, path: Any) -> None:
        """Writes the bytes of the model to a file.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "model.hbvib")
        >>> model.save(path)
        >>> hbvib.Model.load(path)
        <hbvib.Model: 1 degree of freedom, 1 contact>
        """
        data = self.to_bytes()
        with open(path, "wb") as file:
            file.write(data)

    @classmethod
    def load(cls, path: Any) -> Model:
        """The model of a file that save wrote.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "model.hbvib")
        >>> model.save(path)
        >>> hbvib.Model.load(path).contacts
        1
        """
        with open(path, "rb") as file:
            return cls.from_bytes(file.read())

    def __reduce__(self) -> Any:
        """A pickle holds the bytes of the model."""
        return type(self).from_bytes, (self.to_bytes(),)

    @property
    def ndof(self) -> int:
        """Degrees of freedom, of one sector.

        >>> import hbvib
        >>> hbvib.Model(3).ndof
        3
        """
        return _call("hbvib_model_dofs", self.handle)

    @property
    def sectors(self) -> int:
        """Sectors; 1 for a plain structure.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.sectors
        8
        """
        return _call("hbvib_model_sectors", self.handle)

    @property
    def contacts(self) -> int:
        """Number of contacts, user forces included.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.contacts
        1
        """
        return _call("hbvib_model_contacts", self.handle)

    @property
    def engine_order(self) -> int:
        """Engine order of the excitation; 0 for a plain structure.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.engine_order
        2
        """
        order = ctypes.c_int64()
        self._call("hbvib_model_wave", order)
        return order.value

    def contact(self, number: int) -> Contact:
        """A contact, read back: its kind, sides and constants. OutOfRangeError (an IndexError) for a number that no
        contact has.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.contact(0).kind.name, model.contact(0).a, model.contact(0).constants
        ('JENKINS', (0, -1, -1), {'kt': 1.0, 'mu': 0.3, 'preload': 1.0})
        """
        law, per_speed2 = _new("hbvib_contact"), ctypes.c_double()
        self._call("hbvib_model_contact", number, law, per_speed2)
        names = [name for name in ContactConstants.__annotations__ if name != "sector_offset"]
        values = {name: getattr(law, name) for name in names}
        given = {name: tuple(value) if isinstance(value, ctypes.Array) else value for name, value in values.items()}
        kind = ContactKind(law.kind)
        needed = _REQUIRED.get(kind, ())
        constants = {name: value for name, value in given.items()
                          if name in needed or (any(value) if isinstance(value, tuple) else value)}
        return Contact(kind, tuple(law.dof_a), tuple(law.dof_b), law.sector_offset, constants, per_speed2.value)

    @property
    def forces(self) -> Forces:
        """The forces, read back in the order in which they were added.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.forces.force
        array([0.2+0.j])
        """
        kinds = [np.int64, np.int64, complex, np.int64]
        dof, harmonic, force, unbalance = self._listed("hbvib_model_forces", (), kinds)
        return Forces(dof, harmonic, force, unbalance != 0)

    @property
    def springs(self) -> Springs:
        """The linear springs of `add_springs`, read back.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_springs(0, hbvib.GROUND, 2.5)
        >>> model.springs.stiffness
        array([2.5])
        """
        return Springs(*self._listed("hbvib_model_springs", (), [np.int64] * 3 + [float]))

    def matrix(self, which: Any, block: Any = "own", *, sparse: bool = False) -> Any:
        """A matrix, read back: (ndof, ndof), real where it has no imaginary part; without Rayleigh damping, springs and
        contacts. UnsupportedError where it was given per nodal diameter.

        which    as in set_matrix.
        block    of a cyclic model: "own", "next" (columns of the next sector) or "previous" (where it was given; else it
                 is the transpose of "next").
        sparse   True: a scipy matrix in compressed columns, for large models.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.matrix("stiffness")
        array([[ 2., -1.],
               [-1.,  2.]])
        """
        row, column, value = self._listed("hbvib_model_matrix", (_member(MatrixKind, which), _member(Block, block)),
                                          [np.int64, np.int64, complex])
        if not value.imag.any():
            value = value.real.copy()
        if sparse:
            from scipy.sparse import csc_matrix  # type: ignore[import-untyped, unused-ignore]
            return csc_matrix((value, (row, column)), shape=(self.ndof, self.ndof))
        dense = np.zeros((self.ndof, self.ndof), value.dtype)
        dense[row, column] = value
        return dense

    def set_matrix(self, which: Any, matrix: Any, part: Any = Part.FULL) -> None:
        """Sets a matrix: which is "mass", "damping", "stiffness", "structural" (D of the structural damping i D in
        harmonics above 0), "gyroscopic" (G, skew-symmetric), "stiffness_speed2" (K1 of K + Omega^2 K1) or a
        MatrixKind; matrix is ndof x ndof.

        part   "full": symmetric or Hermitian, which is checked; "lower", "upper": that triangle of such a one, the
               rest is not read; "general": any but the mass; "symmetric", "symmetric_lower", "symmetric_upper": the
               same for A = A^T, where A may be complex.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_matrix("damping", [[0.1, 0], [9, 0.1]], "upper")  # the 9 is not read
        >>> model.matrix("damping")
        array([[0.1, 0. ],
               [0. , 0.1]])
        """
        self._call("hbvib_model_set_matrix", _member(MatrixKind, which), _matrix(matrix, part))

    def fix(self, dofs: ArrayLike) -> None:
        """Fixes degrees of freedom: they do not move, whatever matrices, contacts and forces say. Numbers stay as
        they are; pairs on the faces of a sector are fixed together.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.fix([1])
        >>> model.linear_modes(1).omega.round(12)  # sqrt(2)
        array([1.41421356])
        """
        still = _array("dofs", dofs if np.size(dofs) else np.empty(0, np.int64), np.int64).ravel()
        self._call("hbvib_model_fix", still.size, still)

    def set_rayleigh(self, alpha_mass: float, beta_stiffness: float) -> None:
        """Adds alpha_mass M + beta_stiffness K to the damping (1 / time, time); replaces an earlier call.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_rayleigh(0, 0.02)
        >>> model.damped_modes(2).damping_ratio.round(12)  # 0.01 omega
        array([0.01      , 0.01732051])
        """
        self._call("hbvib_model_set_rayleigh", alpha_mass, beta_stiffness)

    def set_loss_factor(self, loss_factor: float) -> None:
        """Structural damping i loss_factor K of the structure's own stiffness in harmonics above 0; replaces an
        earlier call.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_loss_factor(0.01)
        >>> model.add_force(0, 1)
        >>> model.forced_response((0.5, 2)).peaks().amplitude.round(2)
        array([50.  , 16.67])
        """
        self._call("hbvib_model_set_loss_factor", loss_factor)

    def set_modal_damping(self, ratios: ArrayLike) -> None:
        """Damping ratios of the lowest natural modes without contacts, in the order of rising frequency, of each
        nodal diameter; call it when matrices, springs and fixed degrees of freedom are complete. []: none.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_modal_damping([0.01, 0.02])
        >>> model.damped_modes(2).damping_ratio.round(12)
        array([0.01, 0.02])
        """
        given = _array("ratios", ratios, np.float64).ravel()
        self._call("hbvib_model_set_modal_damping", given.size, given)

    def set_speed(self, speed: Optional[float] = None, *, per_omega: Optional[float] = None) -> None:
        """Speed of rotation: fixed, or tied to the frequency of the response, Omega = per_omega omega (1 / EO for an
        excitation of engine order EO).

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])  # a disk, x and y
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> model.set_speed(1.0)
        >>> model.damped_modes(2).omega.round(6)
        array([0.904988, 1.104988])
        """
        if (speed is None) == (per_omega is None):
            raise TypeError("set_speed needs either a speed or per_omega")
        if per_omega is None:
            self._call("hbvib_model_set_speed", speed)
        else:
            self._call("hbvib_model_set_speed_per_omega", per_omega)

    def set_coupling(self, which: Any, to_next: Any) -> None:
        """Coupling of a sector (rows) to the next (columns), ndof x ndof; its transpose couples to the previous.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3)
        >>> model.set_coupling("stiffness", -1)
        >>> model.matrix("stiffness", "next")
        array([[-1.]])
        """
        self._call("hbvib_cyclic_set_coupling", _member(MatrixKind, which), _matrix(to_next, Part.GENERAL))

    def set_coupling_previous(self, which: Any, to_previous: Any) -> None:
        """Coupling to the previous sector where it is not the transpose: damping and stiffness only.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, mass=1, stiffness=3)
        >>> model.set_coupling("damping", 0.1)
        >>> model.set_coupling_previous("damping", -0.1)  # without symmetry
        >>> model.matrix("damping", "previous")
        array([[-0.1]])
        """
        self._call("hbvib_cyclic_set_coupling_previous", _member(MatrixKind, which), _matrix(to_previous, Part.GENERAL))

    def set_diameter(self, which: Any, diameter: int, matrix: Any, part: Any = Part.FULL) -> None:
        """The complex matrix of the wave of a nodal diameter 0 .. sectors / 2, instead of sector blocks.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=4, engine_order=1)
        >>> for diameter in range(3):
        ...     model.set_diameter("mass", diameter, 1)
        ...     model.set_diameter("stiffness", diameter, 1 + diameter)
        ...
        >>> model.linear_modes(1, diameter=2).omega.round(12)  # sqrt(3)
        array([1.73205081])
        """
        self._call("hbvib_cyclic_set_diameter", _member(MatrixKind, which), diameter, _matrix(matrix, part))

    def set_wave(self, engine_order: int) -> None:
        """Engine order of the excitation, of any sign and size.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.set_wave(3)
        >>> model.engine_order
        3
        """
        self._call("hbvib_cyclic_set_wave", engine_order)

    def add_force(self, dof: int, force: complex, harmonic: int = 1) -> None:
        """Adds Re(force exp(i harmonic omega t)) on a degree of freedom, a peak value; harmonic 0 is constant.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_force(0, 0.2)       # 0.2 cos(omega t)
        >>> model.add_force(0, -0.1j, 3)  # 0.1 sin(3 omega t)
        >>> model.forces.harmonic
        array([1, 3])
        """
        if isinstance(force, (str, bytes)):
            raise TypeError(f"force needs a number, not {force!r}")
        force = complex(force)
        self._call("hbvib_model_add_force", dof, harmonic, force.real, force.imag)

    def add_unbalance(self, dof_x: int, dof_y: int, m_e: float, phase: float = 0.0) -> None:
        """Adds m_e omega^2 cos(omega t + phase) on dof_x and m_e omega^2 sin(omega t + phase) on dof_y, omega the
        frequency of the response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]], rayleigh=(0.1, 0))
        >>> model.add_unbalance(0, 1, m_e=1e-3)
        >>> branch = model.forced_response((0.5, 1.5), response_dof=0)
        >>> branch.peaks().amplitude.round(4)  # 1e-3 / 0.1
        array([0.01])
        """
        self._call("hbvib_model_add_unbalance", dof_x, dof_y, m_e, phase)

    def clear_forces(self) -> None:
        """Removes all forces, unbalances included.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.clear_forces()
        >>> len(model.forces.dof)
        0
        """
        self._call("hbvib_model_clear_forces")

    def _identified(self, name: str, *arguments: Any) -> int:
        """Calls a function that adds contacts and returns the number of the first."""
        first = ctypes.c_int64()
        self._call(name, *arguments, first)
        return first.value

    @overload
    def add_contact(self, kind: Literal["jenkins", ContactKind.JENKINS], a: ArrayLike, b: ArrayLike = GROUND, *,
                    kt: float, mu: float, preload: float, sector_offset: int = 0, normal: ArrayLike = (0, 0, 0),
                    tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: Literal["friction_2d", ContactKind.FRICTION_2D], a: ArrayLike, b: ArrayLike = GROUND,
                    *, kt: float, kn: float, mu: float, preload: float = 0, gap: float = 0, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: Literal["friction_3d", ContactKind.FRICTION_3D], a: ArrayLike, b: ArrayLike = GROUND,
                    *, kt: float, mu: float, kn: float = 0, preload: float = 0, gap: float = 0,
                    sector_offset: int = 0, normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: Literal["unilateral", ContactKind.UNILATERAL], a: ArrayLike, b: ArrayLike = GROUND, *,
                    kn: float, preload: float = 0, gap: float = 0, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: Literal["cubic", ContactKind.CUBIC], a: ArrayLike, b: ArrayLike = GROUND, *,
                    cubic: float, kt: float = 0, sector_offset: int = 0, normal: ArrayLike = (0, 0, 0),
                    tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: Literal["regularised", ContactKind.REGULARISED], a: ArrayLike, b: ArrayLike = GROUND,
                    *, mu: float, preload: float, velocity: float, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0)) -> int: ...

    @overload
    def add_contact(self, kind: ContactKind, a: ArrayLike, b: ArrayLike = GROUND,
                    **constants: Unpack[ContactConstants]) -> int: ...

    def add_contact(self, kind: Any, a: Any, b: Any = GROUND, **constants: Any) -> int:
        """Adds a contact and returns its number.

        kind   a ContactKind or its name: "jenkins", "friction_2d", "friction_3d", "unilateral", "cubic", "regularised".
        a, b   degree of freedom of each side, or a sequence of them in the directions in which the law acts (t1 and n
               of friction_2d; t1, t2 and n, or t1 and t2 under a constant load, of friction_3d), or all three places.
        Constants of the kinds, those in brackets may be left out; TypeError where another one is:
        jenkins       kt, mu, preload            force kt y of a spring in series with a slider of limit mu preload
        friction_2d   kt, kn, mu, [preload, gap]   the same, limit mu N, N = max(preload + kn (x_b - x_a - gap), 0) along n
        friction_3d   kt, mu, [kn, preload, gap]   the same in the plane of t1 and t2; without kn under the preload
        unilateral    kn, [preload, gap]         N alone
        cubic         cubic, [kt]                kt y + cubic y^3
        regularised   mu, preload, velocity      mu preload tanh(y' / velocity)
        kt and kn are forces per length, preload a force, gap a length, velocity a length per time, y = x_a - x_b.
        normal, tangent   directions in the axes of three degrees of freedom a side.
        sector_offset     side b lies in sector s + sector_offset of a cyclic model.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.add_contact("jenkins", 0, 1, kt=1, mu=0.3, preload=1)  # between degrees of freedom 0 and 1
        0
        >>> model.add_contact("unilateral", 1, kn=2, gap=0.1)  # between degree of freedom 1 and the ground
        1
        >>> model.add_contact("friction_2d", [0, 1], kt=1, kn=2, mu=0.3, preload=1)  # along 0 under a load along 1
        2
        """
        law = _law("add_contact", kind, constants)
        law.dof_a[:], law.dof_b[:] = (_side(ContactKind(law.kind), side) for side in (a, b))
        return self._identified("hbvib_model_add_contact", law)

    def set_preload(self, contact: int, preload: float, per_speed2: float = 0.0) -> None:
        """Changes the normal load of a contact: preload + per_speed2 Omega^2 at the speed of rotation Omega; m R for a
        ring of mass m at the radius R.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.set_preload(0, 2.5)
        >>> model.contact(0).constants["preload"]
        2.5
        """
        self._call("hbvib_model_set_preload_at_speed", contact, preload, per_speed2)

    def add_jenkins(self, a: ArrayLike, b: ArrayLike, kt: ArrayLike, mu: ArrayLike, preload: ArrayLike,
                    sector_offset: ArrayLike = 0) -> range:
        """Adds many Jenkins contacts from arrays of one length, or numbers for all; returns their numbers.

        >>> import hbvib
        >>> model = hbvib.Model(3)
        >>> model.add_jenkins([0, 1, 2], hbvib.GROUND, kt=1, mu=0.3, preload=[1, 2, 3])
        range(0, 3)
        """
        sides = _columns(a=(a, np.int64), b=(b, np.int64), kt=(kt, float), mu=(mu, float), preload=(preload, float),
                         sector_offset=(sector_offset, np.int64))
        n, (dof_a, dof_b, *constants, offset) = len(sides[0]), sides
        first = self._identified("hbvib_model_add_jenkins", n, dof_a, dof_b, offset, *constants)
        return range(first, first + n)

    def add_springs(self, a: ArrayLike, b: ArrayLike, stiffness: ArrayLike, sector_offset: ArrayLike = 0) -> None:
        """Adds linear springs from arrays of one length, or numbers for all.

        >>> import hbvib
        >>> model = hbvib.Model(3)
        >>> model.add_springs([0, 1], [1, 2], 2.5)
        >>> model.springs.stiffness
        array([2.5, 2.5])
        """
        dof_a, dof_b, numbers, offset = _columns(a=(a, np.int64), b=(b, np.int64), stiffness=(stiffness, float),
                                                 sector_offset=(sector_offset, np.int64))
        self._call("hbvib_model_add_springs", len(dof_a), dof_a, dof_b, offset, numbers)

    def add_iwan(self, a: int, b: int = GROUND, *, slip_force: float, stiffness: float, chi: float, beta: float,
                 elements: int = 100, sector_offset: int = 0) -> range:
        """Adds an Iwan joint as that many Jenkins contacts; returns their numbers.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_iwan(0, slip_force=1, stiffness=1, chi=-0.5, beta=1, elements=20)
        range(0, 20)
        """
        first = self._identified("hbvib_model_add_iwan", a, b, sector_offset,
                                 slip_force, stiffness, chi, beta, elements)
        return range(first, first + elements)

    def add_table(self, a: int, b: int = GROUND, *, displacement: ArrayLike, force: ArrayLike,
                  sector_offset: int = 0) -> int:
        """Adds a spring whose force is a table: straight between its points, displacement ascending.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_table(0, displacement=[-1, 0, 1], force=[-1, 0, 3])  # stiffer in one direction
        0
        """
        y = _array("displacement", displacement, shape=[None])
        f = _array("force", force, shape=[len(y)])
        return self._identified("hbvib_model_add_table", a, b, sector_offset, len(y), y, f)

    def add_spring_damper(self, a: int, b: int = GROUND, *, spring: ArrayLike = (), damper: ArrayLike = (),
                          sector_offset: int = 0) -> int:
        """Adds f = sum spring[k] y^(k+1) + sum damper[k] v^(k+1), y the motion of a over b and v = y'.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_spring_damper(0, spring=[0, 0, 0.5], damper=[0, 0.1])  # 0.5 y^3 + 0.1 v^2
        0
        """
        spring, damper = _array("spring", spring, shape=[None]), _array("damper", damper, shape=[None])
        return self._identified("hbvib_model_add_spring_damper", a, b, sector_offset, len(spring), spring, len(damper),
                                damper)

    def add_polynomial(self, dofs: ArrayLike, direction: ArrayLike, coefficient: ArrayLike,
                       x_powers: Optional[ArrayLike] = None, v_powers: Optional[ArrayLike] = None) -> int:
        """Adds terms coefficient[t] prod x_j^x_powers[t, j] prod v_j^v_powers[t, j] to the force on
        dofs[direction[t]]; powers are terms x dofs, None: all 0.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.add_polynomial([0, 1], direction=[0], coefficient=[2.0], x_powers=[[1, 2]])  # 2 x_0 x_1^2 on 0
        0
        """
        dofs, direction = _array("dofs", dofs, np.int64, [None]), _array("direction", direction, np.int64, [None])
        coefficient = _array("coefficient", coefficient, shape=[len(direction)])
        powers = []
        for name, given in (("x_powers", x_powers), ("v_powers", v_powers)):
            if given is not None:
                wide = _array(name, given, np.int64, [len(direction), len(dofs)])
                given = wide.clip(-1, 2**31 - 1).astype(np.int32)  # out of range stays so
            powers.append(given)
        return self._identified("hbvib_model_add_polynomial", dofs, len(dofs), len(direction), direction, coefficient,
                                *powers)

    def add_stiffness_tensors(self, dofs: ArrayLike, quadratic: Optional[ArrayLike] = None,
                              cubic: Optional[ArrayLike] = None) -> int:
        """Adds f_i = sum quadratic[i, j, k] x_j x_k + sum cubic[i, j, k, l] x_j x_k x_l on dofs[i].

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> import numpy as np
        >>> cubic = np.zeros((2, 2, 2, 2))
        >>> cubic[0, 0, 0, 0] = 0.5
        >>> model.add_stiffness_tensors([0, 1], cubic=cubic)  # 0.5 x_0^3 on degree of freedom 0
        0
        """
        dofs = _array("dofs", dofs, np.int64, [None])
        n = len(dofs)
        quadratic = None if quadratic is None else _array("quadratic", quadratic, shape=[n] * 3)
        cubic = None if cubic is None else _array("cubic", cubic, shape=[n] * 4)
        return self._identified("hbvib_model_add_stiffness_tensors", dofs, n, quadratic, cubic)

    def add_patch(self, kind: Any, a: ArrayLike, b: Optional[ArrayLike], normal: ArrayLike, area: ArrayLike, *,
                  tangent: Optional[ArrayLike] = None, pressure: Optional[ArrayLike] = None,
                  gap: Optional[ArrayLike] = None, **constants: Any) -> range:
        """Adds a contact patch of n node pairs, each with an area; returns the numbers of the contacts.

        a, b      degrees of freedom along three axes, n x 3; b None: the ground.
        normal, tangent   directions, n x 3, or one for all.
        area, pressure, gap   n numbers, or one for all.
        kt, kn, mu, preload ...   constants of the kind per unit of area, sector_offset, as in add_contact.

        >>> import hbvib
        >>> model = hbvib.Model(6)
        >>> model.add_patch("friction_3d", [[0, 1, 2], [3, 4, 5]], None, normal=(0, 0, 1), area=[0.5, 0.25], pressure=10,
        ...                 kt=1, kn=2, mu=0.3)
        range(0, 2)
        >>> model.contact(1).constants["preload"]  # 0.25 * 10
        2.5
        """
        a = _array("a", a, np.int64, [None, 3])
        n = len(a)

        def each(name: str, value: Any, *shape: int) -> Any:
            if value is None:
                return None
            numbers = _numbers(name, value, np.float64)
            if numbers.shape == shape[1:]:
                numbers = np.broadcast_to(numbers, shape)
            return _array(name, numbers, shape=shape)

        b = None if b is None else _array("b", b, np.int64, [n, 3])
        first = self._identified(
            "hbvib_model_add_patch", _law("add_patch", kind, constants), n, a, b, each("normal", normal, n, 3),
            each("tangent", tangent, n, 3), each("area", area, n), each("pressure", pressure, n), each("gap", gap, n))
        return range(first, first + n)

    def add_user_force(self, dofs: ArrayLike, function: Callable[[ForceCall], Any], *, states: int = 0,
                       samples: int = 0, uses_velocity: bool = False, is_odd: bool = False) -> int:
        """Adds a force of your own on some degrees of freedom, each over the ground; returns its number.

        function(call) writes call.f and the derivatives that are not zero, see ForceCall. It returns nothing, or False
        where it cannot at this motion: shorter steps are tried. An exception ends the solve and leaves it.
        The model, its copies and all branches keep it alive, because results call it again.

        >>> import hbvib
        >>> def cubic(call):
        ...     call.f[:] = 0.5 * call.u**3
        ...     call.df_du[:, 0, 0] = 1.5 * call.u[:, 0]**2
        ...
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_user_force([0], cubic, is_odd=True)
        0
        """
        if not callable(function):
            raise TypeError("function is not callable")

        def trampoline(_: Any, call: Any) -> int:
            guard = getattr(_running, "guard", None) or _Guard()
            answer = guard.run(function, ForceCall(call.contents)) if guard.held is None else None
            return -1 if guard.held is not None else int(_refused(answer))

        dofs = _array("dofs", dofs, np.int64, [None])
        callback = _TYPES["force_fn"](trampoline)
        force = _new("hbvib_user_force", dofs=dofs, n=len(dofs), states=states, samples=samples, force=callback,
                     uses_velocity=uses_velocity, is_odd=is_odd)
        kept = self._kept
        kept.append(callback)  # before another thread can solve with it
        try:
            return self._identified("hbvib_model_add_user_force", force)
        except BaseException:
            kept.remove(callback)
            raise

    def check_jacobian(self, contact: int, omega: float, amplitude: ArrayLike) -> JacobianGap:
        """The derivative of a user force that lies farthest from its difference quotient; `gap` below 1e-6 is right.

        amplitude   about the largest motion of each degree of freedom of the force, n numbers.

        >>> import hbvib
        >>> def cubic(call):
        ...     call.f[:] = 0.5 * call.u**3
        ...     call.df_du[:, 0, 0] = 1.5 * call.u[:, 0]**2
        ...
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> number = model.add_user_force([0], cubic, is_odd=True)
        >>> model.check_jacobian(number, omega=1, amplitude=0.3).gap < 1e-6
        True
        """
        amplitude = _array("amplitude", np.atleast_1d(amplitude), shape=[None])
        gap = _new("hbvib_jacobian_gap")
        self._call("hbvib_check_jacobian", contact, omega, amplitude, len(amplitude), gap)
        return _record(JacobianGap, gap)

    def linear_modes(self, count: int, diameter: int = 0, contacts: Any = ContactState.STUCK, *,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> Modes:
        """Undamped natural modes: omega (count), ascending, and shapes (count, ndof), complex, phi^H M phi = 1.

        diameter   nodal diameter of the wave, 0 .. sectors / 2.    contacts   "stuck", "free" or "static".
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> modes = model.linear_modes(2)
        >>> modes.omega.round(12), modes.shapes.shape
        (array([1.        , 1.73205081]), (2, 2))
        """
        omega, shapes = np.empty(count), np.empty((count, self.ndof), complex)
        _stoppable("hbvib_linear_modes", self.handle, diameter, _member(ContactState, contacts), count, omega, shapes,
                   phase=phase, cancel=cancel)
        return Modes(omega, shapes)

    def damped_modes(self, count: int, diameter: int = 0, contacts: Any = ContactState.STUCK) -> DampedModes:
        """Damped natural modes at the speed of the model, by rising frequency: eigenvalue (upper half plane), omega
        (its imaginary part), damping_ratio (minus its real part over its modulus; negative: the motion grows), shape
        (count, ndof), phi^H M phi = 1, and direction: 1 forward, -1 backward, 0 undefined, the sign of the change of
        omega with the speed at fixed K1. Motions that do not oscillate are not counted.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_rayleigh(0.02, 0)
        >>> model.damped_modes(2).damping_ratio.round(6)
        array([0.01    , 0.005774])
        """
        eigenvalue, shape = np.empty(count, complex), np.empty((count, self.ndof), complex)
        direction = np.empty(count, np.int64)
        self._call("hbvib_damped_modes", diameter, _member(ContactState, contacts), count, eigenvalue, shape, direction,
                   None)
        ratio = -eigenvalue.real / np.abs(eigenvalue)
        return DampedModes(eigenvalue, eigenvalue.imag.copy(), ratio, shape, direction)

    def campbell(self, speeds: ArrayLike, count: int, engine_orders: Sequence[int] = (1,), diameter: int = 0,
                 contacts: Any = ContactState.STUCK) -> Campbell:
        """Campbell diagram: omega, damping_ratio and direction (speeds, count) of the damped modes at rising speeds, NaN
        where fewer motions oscillate, and the crossings with engine orders, omega = engine_order Omega.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> model.campbell([0.0, 0.5, 1.0, 1.5], 2).crossings.speed.round(4)  # critical speeds
        array([0.9129, 1.118 ])
        """
        speeds, state = _array("speeds", speeds, np.float64).ravel(), _member(ContactState, contacts)
        omega, ratio = np.empty((speeds.size, count)), np.empty((speeds.size, count))
        direction = np.empty((speeds.size, count), np.int64)
        self._call("hbvib_campbell", speeds.size, speeds, diameter, state, count, omega, ratio, direction, None)
        room, found, rows = speeds.size * count, ctypes.c_int64(), []
        at, frequency, sense = np.empty(room), np.empty(room), np.empty(room, np.int64)
        for order in engine_orders:
            self._call("hbvib_campbell_crossings", speeds.size, speeds, diameter, state, count, order, room, at,
                       frequency, sense, found, None)
            rows += [(int(order), *row) for row in zip(at[:found.value], frequency, sense)]
        orders, critical, frequencies, senses = zip(*rows) if rows else ((), (), (), ())
        crossings = Crossings(np.array(orders, np.int64), np.array(critical, float), np.array(frequencies, float),
                              np.array(senses, np.int64))
        return Campbell(speeds, omega, ratio, direction, crossings)

    def plot_campbell(self, speeds: ArrayLike, count: int, engine_orders: Sequence[int] = (1,), diameter: int = 0,
                      contacts: Any = ContactState.STUCK, *, ax: Any = None, hertz: bool = False, **line: Any) -> Any:
        """Draws the Campbell diagram with matplotlib: natural frequencies over the speed of rotation, lines of engine
        orders, crossings as dots. Returns the axes. ImportError without matplotlib.

        speeds, count, engine_orders, diameter, contacts   as in campbell, in rad per time unit.
        ax      axes to draw into; None: new ones.    hertz   True: axes in 1 / time unit.    line   options of ax.plot.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> axes = model.plot_campbell([0.0, 0.5, 1.0, 1.5], 2, engine_orders=(1, 2))
        >>> axes.get_ylabel()
        'angular frequency omega'
        """
        from . import _plots
        diagram = self.campbell(speeds, count, engine_orders, diameter, contacts)
        return _plots.campbell(diagram, engine_orders, ax, hertz, line)

    def _solve(self, name: str, solver: Any, options: Any, hooks: tuple[Any, ...]) -> Branch:
        if "harmonics" in solver:
            solver.setdefault("tolerance", 0.0)  # so many and no other, unless a tolerance is named as well
        if "flexibility" in solver:
            solver = dict(solver, flexibility=_member(Flexibility, solver["flexibility"]))
        if "stability" in solver:
            solver = dict(solver, stability=_member(Stability, solver["stability"]))
        settings = _options(name[6:], "hbvib_solver_options", solver)
        handle, kept = ctypes.c_void_p(), self._kept
        with _Guard() as guard:
            status = _call(name, self.handle, settings, options, _hooks(guard, *hooks), handle, guard=guard)
            if handle.value:
                guard.branch = branch = Branch(handle.value, tuple(kept), _sentence(status) if status else "")
        if status > Status.STOPPED_BY_CALLER:
            try:
                warnings.warn(StoppedEarly(branch.message, branch.status), stacklevel=3)
            except StoppedEarly as warning:
                warning.branch = branch  # type: ignore[attr-defined]
                raise
        return branch

    @_with_options("hbvib_solver_options", SolverOptions)
    def forced_response(self, omega: Any, *, at: Optional[ArrayLike] = None, guess: Optional[ArrayLike] = None,
                        progress: Union[bool, Callable[[Progress], Any], None] = None,
                        log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                        cancel: Optional[CancelFlag] = None,
                        phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows the periodic response over a range of frequency.

        omega     (start, stop) in rad per time unit, downward where stop is the lower; or one frequency.
        at        frequencies within the range at which every solution is computed exactly: Branch.at.
        guess     start values, (H + 1, ndof) complex, such as Branch.harmonics gives.
        progress  progress(Progress) after each point: False, or raising StopIteration, stops and keeps the points. True
                  shows a bar of tqdm, or a line on stderr where that is not installed.
        log       log(LogLevel, text), lines up to log_level.
        phase     phase(Phase, share) in all phases from the set-up on: False, or raising StopIteration, stops.
        cancel    a CancelFlag.
        Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        Warns of StoppedEarly where the range was not covered. NumericalError where no solution was found, ArgumentError
        or OutOfRangeError for wrong options. `Branch.reduction` has the size of the problem that was solved.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6), at=[1.0])
        >>> print("%.4f" % branch.amplitude.max(), branch.at(0).amplitude.round(4))
        0.5836 [0.2]
        """
        start, stop = _range("omega", omega, "forced_response((0.8, 1.6), at=omega)", single=True)
        options = _new("hbvib_forced_options", omega_start=start, omega_stop=stop, **_counted_array("at", at),
                       **_counted_array("guess", guess, np.complex128, [None, self.ndof]))
        return self._solve("hbvib_forced_response", solver, options, (progress, log, log_level, cancel, phase))

    @_with_options("hbvib_solver_options", SolverOptions)
    def parameter_response(self, parameter: Parameter, values: Sequence[float], *, omega: float,
                           follow: Any = Follow.OMEGA, at: Optional[ArrayLike] = None,
                           progress: Union[bool, Callable[[Progress], Any], None] = None,
                           log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                           cancel: Optional[CancelFlag] = None,
                           phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows the amplitude of the forced response over a parameter: Branch.parameter_values, .amplitude,
        .d_amplitude, .optima.

        values    (start, stop), downward where stop is the lower: of a constant or of the speed the value itself, of a
                  factor 1 as at present, of a direction its coefficient.
        omega     the frequency held, or one within a tenth of which the peak next to it is sought at the start.
        follow    "omega": the response at this frequency; "peak": the peak.
        at        values within the range at which every solution is computed exactly: Branch.at.
        The rest as in forced_response. All points have the same `harmonics`, which must be given: without a
        tolerance. Options of the solver:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("preload"), (0.3, 2), omega=1.0, follow="peak", harmonics=9)
        >>> optima = found.optima()
        >>> optima.kind.tolist()
        ['minimum']
        """
        start, stop = _range("values", values, "parameter_response(parameter, (1, 2), at=values)")
        described = parameter._description()
        options = _new("hbvib_parameter_options", start=start, stop=stop, omega=omega, follow=_member(Follow, follow),
                       **_counted_array("at", at))
        options.described = described  # kept as long as the struct
        options.parameter = ctypes.addressof(described)
        return self._solve("hbvib_parameter_response", solver, options, (progress, log, log_level, cancel, phase))

    @_with_options("hbvib_solver_options", SolverOptions)
    def nonlinear_mode(self, log10_amplitude: Sequence[float], *, at: Optional[ArrayLike] = None,
                       shape: Optional[ArrayLike] = None, damping_form: Any = DampingForm.MASS, diameter: int = -1,
                       mode_index: int = 0, near_omega: float = 0, amplitude_contact: int = -1, reference_dof: int = -1,
                       progress: Union[bool, Callable[[Progress], Any], None] = None,
                       log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                       cancel: Optional[CancelFlag] = None,
                       phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows a nonlinear mode over a range of amplitude: frequency and damping ratio against it.

        log10_amplitude   (start, stop), rising: of sqrt(X_1^H M X_1), or with amplitude_contact of |Y_1| of a contact.
        at                log10 of amplitudes at which every solution is computed exactly.
        mode_index, near_omega, shape   the linear mode to start from: by number, frequency or likeness (ndof complex).
        damping_form      "mass" or "stiffness".     diameter, reference_dof   -1: chosen by the library.
        progress, log, log_level, cancel, phase   as in forced_response.
        Options of the solver, as there:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> print("%.4f %.4f" % (mode.omega[0], mode.omega[-1]))  # stuck: sqrt(2), free: 1
        1.4142 1.0043
        """
        start, stop = _range("log10_amplitude", log10_amplitude, "nonlinear_mode((-6, -2), at=log10_amplitude)")
        options = _new("hbvib_mode_options", log10_start=start, log10_stop=stop, diameter=diameter,
                       damping_form=_member(DampingForm, damping_form), mode_index=mode_index, near_omega=near_omega,
                       amplitude_contact=amplitude_contact, reference_dof=reference_dof, **_counted_array("at", at),
                       **_counted_array("shape", shape, np.complex128, [self.ndof]))
        return self._solve("hbvib_nonlinear_mode", solver, options, (progress, log, log_level, cancel, phase))

    @_with_options("hbvib_time_options", TimeOptions)
    def time_response(self, omega: float, *, harmonics: int = 9, samples: int = 0, method: Any = SteadyMethod.SHOOTING,
                      start: Optional[ArrayLike] = None, progress: Union[bool, Callable[[Progress], Any], None] = None,
                      log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                      cancel: Optional[CancelFlag] = None,
                      phase: Hook = None, **options: Unpack[TimeOptions]) -> TimeResponse:
        """The periodic response at one frequency by integration in time: a check of any point of a branch.

        start      (H + 1, ndof) complex motion to start from, such as Branch.harmonics gives; None: rest.
        method     "shooting" or "marching".
        harmonics, samples   highest harmonic of the result; equidistant times a period at which the motion is returned.
        {options}
        progress   after each period; log, log_level, cancel and phase as in forced_response.
        Returns harmonics (harmonics + 1, ndof) complex, samples (samples, ndof) at equidistant times, info, and status:
        STOPPED_BY_CALLER where the results are those of the last period, not steady, or NaN after cancel.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> found = model.time_response(1.0)
        >>> print("%.4f" % abs(found.harmonics[1, 0]))
        0.2000
        """
        settings = _options(
            "time_response", "hbvib_time_options", options, "start start_len", omega=omega, harmonics=harmonics,
            samples=samples, method=_member(SteadyMethod, method),
            **_counted_array("start", start, np.complex128, [None, self.ndof]))
        shapes = (max(settings.harmonics, -1) + 1, self.ndof), (max(settings.samples, 0), self.ndof)
        x, times, info = np.empty(shapes[0], complex), np.empty(shapes[1]), _new("hbvib_time_info")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_time_response", self.handle, settings, hooks, x, x.size,
                           times if times.size else None, times.size, info, guard=guard)
        return TimeResponse(x, times, _record(TimeInfo, info), Status(status))

    @_with_options("hbvib_verify_options", VerifyOptions)
    def verify(self, branch: Branch, point: int, *, method: Any = SteadyMethod.SHOOTING,
               progress: Union[bool, Callable[[Progress], Any], None] = None,
               log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
               cancel: Optional[CancelFlag] = None,
               phase: Hook = None, **options: Unpack[VerifyOptions]) -> Verification:
        """How far a point of a forced response of this model is from the motion that integration in time finds from it.

        method     "shooting" or "marching".
        {options}
        progress   after each period; the rest as in forced_response.
        Returns harmonics (H + 1, ndof) complex in time, errors (H + 1), info, whose response_error is that of the
        response and whose same_solution is False where the integration ended far from the point, and status:
        STOPPED_BY_CALLER where all of it compares with the last period, not steady, or is NaN after cancel.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> peak = branch.peaks().point[0]
        >>> found = model.verify(branch, peak)
        >>> found.info.same_solution, found.info.response_error < 1e-3
        (True, True)
        """
        settings = _options("verify", "hbvib_verify_options", options, method=_member(SteadyMethod, method))
        rows = branch.reduction.harmonics_asked + 1
        x, errors, info = np.empty((rows, self.ndof), complex), np.empty(rows), _new("hbvib_verification")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_verify", self.handle, branch.handle, point, settings, hooks, x, x.size, errors,
                           errors.size, info, guard=guard)
        return Verification(x, errors, _record(VerificationInfo, info), Status(status))

    @_with_options("hbvib_floquet_options", FloquetOptions)
    def floquet(self, branch: Branch, point: int, *, waves: Any = Waves.WAVE, refine: bool = True,
                progress: Union[bool, Callable[[Progress], Any], None] = None,
                log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                cancel: Optional[CancelFlag] = None,
                phase: Hook = None, **options: Unpack[FloquetOptions]) -> Floquet:
        """The Floquet multipliers of a point of this model: the motion is unstable where radius > 1.

        waves      "wave": perturbations of the kind of the wave itself; "wheel": all of the wheel.
        refine     move the point to the periodic motion in time first.
        {options}
        progress   after each period of shooting; the rest as in forced_response.
        A point of a nonlinear mode must be a limit cycle, damping ratio zero.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> found = model.floquet(branch, branch.peaks().point[0])
        >>> found.radius < 1  # stable
        True
        """
        settings = _options("floquet", "hbvib_floquet_options", options, waves=_member(Waves, waves), refine=int(refine))
        most = self.sectors * (2 * self.ndof + self.contacts)
        mu, classes, info = np.empty(most, complex), np.empty(most, np.int64), _new("hbvib_floquet_info")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_floquet", self.handle, branch.handle, point, settings, hooks, mu, mu.size, classes,
                           classes.size, info, guard=guard)
        names = np.array([MultiplierClass(number).name.lower() for number in classes[:info.count]], dtype="U13")
        reasons = {Grazing.NONE: "", Grazing.SLIP_LIMIT: "the force of contact {} touches its slip limit",
                   Grazing.LANDING: "contact {} closes without normal speed"}
        reason = reasons[Grazing(info.grazing)].format(info.grazing_contact)
        return Floquet(mu[:info.count], names, info.radius, info.unstable, info.neutral, info.orbit_change, info.omega,
                       info.residual, reason, Status(status))

    def sensitivity(self, branch: Branch, point: int, parameters: Union[Parameter, Sequence[Parameter]],
                    of: Any = "amplitude", *, phase: Hook = None,
                    cancel: Optional[CancelFlag] = None) -> Sensitivities:
        """Exact derivatives of a result at a point of this model by parameters, from one adjoint solution for all.

        of      "amplitude": of a forced response at fixed frequency; "peak_amplitude", "peak_omega": of a peak, which
                moves; "mode_omega", "mode_damping": of a nonlinear mode at fixed amplitude; or a Quantity.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.
        NaN where a derivative does not exist, as at the onset of slip: `reasons` tells why.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> by_preload, by_force = model.sensitivity(
        ...     branch, branch.peaks().point[0], [hbvib.Parameter("preload"), hbvib.Parameter("force")], "peak_amplitude")
        >>> bool(abs(by_preload + by_force - branch.peaks().amplitude[0]) < 1e-8)  # both together scale the motion
        True
        """
        listed = [parameters] if isinstance(parameters, Parameter) else parameters
        given = [parameter._description() for parameter in listed]
        array = (structs["hbvib_parameter"] * len(given))(*given)
        values, reasons, onset = np.empty(len(given)), np.empty(len(given), np.int64), ctypes.c_int64()
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_sensitivity", self.handle, branch.handle, point, _member(Quantity, of), array,
                           len(given), values, values.size, reasons, onset, hooks, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        texts = {Derivative.EXISTS: "", Derivative.ONSET_OF_SLIP: f"contact {onset.value} is at the onset of slip",
                 Derivative.ONE_SIDED: "the constant is 0, and a derivative exists on one side only",
                 Derivative.FOLD: "the point is a fold"}
        found = values.view(Sensitivities)
        found.reasons = tuple(texts[Derivative(int(reason))] for reason in reasons)
        return found

    @_with_options("hbvib_solver_options", SolverOptions)
    def batch(self, omega: Any, parameters: Union[Parameter, Sequence[Parameter]], values: ArrayLike, *,
              threads: int = 1, keep: bool = False,
              progress: Union[bool, Callable[[Progress], Any], None] = None, phase: Hook = None,
              cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> Batch:
        """The highest peak of each of many designs: this model with other values of parameters.

        omega       (start, stop) of each response.
        values      designs x parameters: constants of contacts and the speed are set, factors multiply, directions are
                    added times the value; one dimension where there is one parameter.
        threads     of this call, which releases the GIL; their number changes no bit of a result.
        keep        whether Batch.branch(i) gives the branch of a design.
        progress    progress(Progress) after designs of the calling thread: `point` counts the designs done. True shows a
                    bar.
        phase, cancel, progress   stop as in forced_response: designs that were not solved have STOPPED_BY_CALLER.
        A design that fails has a status of its own. Options of the solver; harmonics without tolerance means
        tolerance = 0:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> batch = model.batch((0.8, 1.6), hbvib.Parameter("preload"), [0.5, 1.0, 1.5], harmonics=9)
        >>> batch.peak_amplitude.round(4)
        array([1.3914, 0.5836, 0.6641])
        """
        listed = [parameters] if isinstance(parameters, Parameter) else list(parameters)
        given = [parameter._description() for parameter in listed]
        array = (structs["hbvib_parameter"] * len(given))(*given)
        table = _array("values", values)
        if table.ndim == 1 and len(given) == 1:
            table = table.reshape(-1, 1)
        if table.ndim != 2 or table.shape[1] != len(given):
            raise ValueError(f"values has shape {table.shape}, needs (designs, {len(given)})")
        start, stop = _range("omega", omega, "batch((0.8, 1.6), parameters, values)")
        options = _new("hbvib_batch_options", threads=threads, omega_start=start, omega_stop=stop, keep=int(bool(keep)))
        more: dict[str, Any] = dict(solver)
        if "harmonics" in more:
            more.setdefault("tolerance", 0.0)
        if "flexibility" in more:
            more["flexibility"] = _member(Flexibility, more["flexibility"])
        chosen = _options("batch", "hbvib_solver_options", more)
        handle, found = ctypes.c_void_p(), None
        with _Guard() as guard:
            hooks = _hooks(guard, progress, None, LogLevel.INFO, cancel, phase)
            _call("hbvib_batch_solve", self.handle, chosen, options, hooks, array, len(given), len(table), table, handle,
                  guard=guard)
            if handle.value is not None:
                found = guard.batch = Batch._of(handle.value, len(table), tuple(self._kept))
        assert found is not None
        return found

    def forced_residual(self, omega: float, x: ArrayLike, *, jacobian: bool = False, d_omega: bool = False,
                        samples: int = 0, phase: Hook = None,
                        cancel: Optional[CancelFlag] = None) -> Residual:
        """Residual of harmonic balance at x, (H + 1, ndof) complex: an array like x; with jacobian the real matrix
        d R / d X over the pairs (re, im), of order 2 x.size; with d_omega an array like x; else None.

        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import numpy as np
        >>> x = np.zeros((2, 1), complex)  # harmonics 0 and 1 of one degree of freedom, at rest
        >>> model.forced_residual(1.0, x).residual[1]
        array([-0.2+0.j])
        """
        x = _array("x", x, np.complex128, [None, self.ndof])
        solver = _new("hbvib_solver_options", harmonics=len(x) - 1, samples=samples)
        residual = np.empty_like(x)
        matrix = np.empty((2 * x.size,) * 2, order="F") if jacobian else None
        slope = np.empty_like(x) if d_omega else None
        _stoppable("hbvib_forced_residual", self.handle, solver, omega, x, x.size, residual, x.size, matrix,
                   0 if matrix is None else matrix.size, slope, x.size if d_omega else 0, phase=phase, cancel=cancel)
        return Residual(residual, matrix, slope)


class Batch:
    """The highest peaks of many designs, read-only arrays in the order of their values; made by Model.batch.

    peak_amplitude, peak_omega   NaN where the amplitude has no maximum within the range, or the design failed.
    status                       numbers of Status: OK, STOPPED_NO_PEAK, or why the design has no result or a part of one.
    points                       points of each curve.
    Batches are pickled without their branches."""

    peak_amplitude: np.ndarray[Any, np.dtype[np.float64]]
    peak_omega: np.ndarray[Any, np.dtype[np.float64]]
    status: np.ndarray[Any, np.dtype[np.int64]]
    points: np.ndarray[Any, np.dtype[np.int64]]

    def __init__(self, peak_amplitude: ArrayLike, peak_omega: ArrayLike, status: ArrayLike, points: ArrayLike,
                 reasons: Optional[Mapping[int, str]] = None) -> None:
        self.peak_amplitude, self.peak_omega = np.array(peak_amplitude, float), np.array(peak_omega, float)
        self.status, self.points = np.array(status, np.int64), np.array(points, np.int64)
        for array in (self.peak_amplitude, self.peak_omega, self.status, self.points):
            array.flags.writeable = False
        self._reasons = dict(reasons or {})
        self._branches: dict[int, Branch] = {}
        self._owner: Optional[_BatchHandle] = None
        self._kept: tuple[Any, ...] = ()

    @classmethod
    def _of(cls, handle: int, designs: int, kept: tuple[Any, ...]) -> Batch:
        owner = _BatchHandle(handle)
        amplitude, omega = np.empty(designs), np.empty(designs)
        status, points = np.empty(designs, np.int64), np.empty(designs, np.int64)
        _call("hbvib_batch_peaks", handle, designs, amplitude, omega, status, points)
        reasons = {}
        for i in np.flatnonzero(status):
            lib.hbvib_batch_status(handle, int(i))
            reasons[int(i)] = _sentence(int(status[i]))
        batch = cls(amplitude, omega, status, points, reasons)
        batch._owner, batch._kept = owner, kept
        return batch

    def __len__(self) -> int:
        """Number of designs."""
        return len(self.status)

    def __repr__(self) -> str:
        return f"<hbvib.Batch: {len(self)} designs, {np.count_nonzero(self.status)} without a complete result>"

    def reason(self, design: int) -> str:
        """The sentence of a status other than OK; empty for OK."""
        return self._reasons.get(range(len(self))[design], "")

    def branch(self, design: int) -> Branch:
        """The branch of a design, where keep was set. ArgumentError where there is none."""
        design = range(len(self))[design]
        if design not in self._branches:
            if self._owner is None:
                raise ArgumentError(f"design {design} has no branch: this batch was made elsewhere", Status.E_ARGUMENT, 2)
            handle = ctypes.c_void_p()
            _call("hbvib_batch_branch", self._owner.value, design, handle)
            assert handle.value is not None
            self._branches[design] = Branch(handle.value, self._kept, self.reason(design))
        return self._branches[design]

    @staticmethod
    def concatenate(batches: Sequence[Batch]) -> Batch:
        """One batch of the designs of several, without their branches."""
        reasons: dict[int, str] = {}
        first = 0
        for batch in batches:
            reasons.update({first + i: text for i, text in batch._reasons.items()})
            first += len(batch)
        names = ("peak_amplitude", "peak_omega", "status", "points")
        amplitude, omega, status, points = (np.concatenate([getattr(batch, name) for batch in batches]) for name in names)
        return Batch(amplitude, omega, status, points, reasons)

    def __reduce__(self) -> Any:
        """A pickle holds the peaks, not the branches."""
        return Batch, (self.peak_amplitude, self.peak_omega, self.status, self.points, self._reasons)


class _BatchHandle:
    """Owns the handle of a batch."""

    def __init__(self, value: int) -> None:
        self.value = value

    def __del__(self, free: Any = lib.hbvib_batch_free) -> None:
        free(self.value)


forced_response = Model.forced_response
nonlinear_mode = Model.nonlinear_mode
time_response = Model.time_response
verify = Model.verify
floquet = Model.floquet
sensitivity = Model.sensitivity


@overload
def evaluate_contact(kind: Literal["jenkins", ContactKind.JENKINS], motion: ArrayLike, *, kt: float, mu: float,
                     preload: float, omega: float = 1, samples: int = 0, jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["friction_2d", ContactKind.FRICTION_2D], motion: ArrayLike, *, kt: float,
                     kn: float, mu: float, preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["friction_3d", ContactKind.FRICTION_3D], motion: ArrayLike, *, kt: float,
                     mu: float, kn: float = 0, preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["unilateral", ContactKind.UNILATERAL], motion: ArrayLike, *, kn: float,
                     preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None, cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["cubic", ContactKind.CUBIC], motion: ArrayLike, *, cubic: float, kt: float = 0,
                     omega: float = 1, samples: int = 0, jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["regularised", ContactKind.REGULARISED], motion: ArrayLike, *, mu: float,
                     preload: float, velocity: float, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None, cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: ContactKind, motion: ArrayLike, *, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                     **constants: Unpack[ContactConstants]) -> ContactForce: ...


def evaluate_contact(kind: Any, motion: ArrayLike, *, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None,
                     **constants: Any) -> ContactForce:
    """Force of one contact law on prescribed harmonics of its motions, (H + 1) or (d, H + 1) complex: an array like
    it, and with jacobian the real d F / d Y over the pairs (re, im), of order 2 d (H + 1), else None.

    phase, cancel   as in forced_response; Stopped is raised where they stop it.

    >>> import hbvib
    >>> import numpy as np
    >>> force = hbvib.evaluate_contact("cubic", [0, 1], kt=1, cubic=0.5).force
    >>> force.real.round(6)  # 1 + 0.5 * 3 / 4
    array([0.   , 1.375])
    """
    law = _law("evaluate_contact", kind, constants)
    motion = _array("motion", motion, np.complex128, [None] * (2 if np.ndim(motion) == 2 else 1))
    force = np.empty_like(motion)
    matrix = np.empty((2 * motion.size,) * 2, order="F") if jacobian else None
    _stoppable("hbvib_contact_evaluate", law, motion.shape[-1] - 1, samples, omega, motion, motion.size, force,
               force.size, matrix, 0 if matrix is None else matrix.size, phase=phase, cancel=cancel)
    return ContactForce(force, matrix)


# ------------------------------------------------------------------------------------------ branch


class _Lease:
    """Owner of a borrowed array (its `base`): keeps the branch, and its memory with it."""

    __slots__ = ("branch", "__array_interface__", "__weakref__")

    def __init__(self, branch: Branch) -> None:
        self.branch = branch


def _field_property(field: Any, text: str) -> property:
    return property(lambda self: self.field(field), doc=text)


class Branch(_Owner):
    """Solutions along a curve, from a forced response or a nonlinear mode; made by the solves.

    Fields (`omega`, `amplitude`, ...) are read-only arrays over the points of the curve without a copy: each keeps the
    branch's memory, and `free` is refused with BufferError while one lives. All else is copied out. Points are numbers
    0 .. len(branch) - 1 on the curve; `peaks`, `folds` and `at` have the numbers of the points beside it.

    message   the library's sentence where the solve stopped early, else empty.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> branch
    <hbvib.Branch: 44 points, omega 0.8 to 1.6, peak 0.583649 at omega = 1.23202, OK>
    """

    def __init__(self, handle: int, kept: tuple[Any, ...], message: str) -> None:
        self._handle, self._kept, self.message = handle, kept, message
        self._leases: Any = weakref.WeakSet()

    def __repr__(self) -> str:
        from ._summary import branch_line
        return branch_line(self)

    def _repr_html_(self) -> str:
        from ._summary import branch_table
        return branch_table(self)

    def __del__(self, free: Any = lib.hbvib_branch_free) -> None:
        if self._handle is not None:
            free(self._handle)

    def free(self) -> None:
        """Frees the branch. BufferError while arrays look into its memory, BusyError while a call uses it, FreedError
        if it was freed.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.free()
        >>> branch
        <hbvib.Branch, freed>
        """
        handle, self._handle = self.handle, None  # first, so that no thread borrows an array from here on
        try:
            if len(self._leases):
                raise BufferError(
                    f"{len(self._leases)} arrays look into the memory of this branch: delete or copy them")
            _call("hbvib_branch_free", handle)
        except (BufferError, BusyError):
            self._handle = handle
            raise
        self._kept = ()

    def __len__(self) -> int:
        """Number of points on the curve."""
        return _call("hbvib_branch_points", self.handle)

    @property
    def stored(self) -> int:
        """Number of all stored points: the curve, then peaks, folds and requested solutions.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.stored - len(branch)  # peaks, folds and requested solutions
        1
        """
        return _call("hbvib_branch_stored", self.handle)

    @property
    def status(self) -> Status:
        """Status of the solve: OK, or why it stopped early.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.status
        <Status.OK: 0>
        """
        return Status(_call("hbvib_branch_status", self.handle))

    @property
    def complete(self) -> bool:
        """Whether the whole range was covered.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.complete
        True
        """
        return self.status == Status.OK

    @property
    def is_mode(self) -> bool:
        """Whether the branch is a nonlinear mode.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.is_mode
        False
        """
        try:
            self.field(Field.DAMPING_RATIO)
        except ArgumentError:
            return False
        return True

    def __reduce__(self) -> tuple[Callable[..., Branch], tuple[Any, ...]]:
        """A pickle holds what a file holds, see save."""
        return SavedBranch, (_storage.contents(self),)

    def __copy__(self) -> Branch:
        """The branch itself, which never changes."""
        return self

    def __deepcopy__(self, _: dict[str, Any]) -> Branch:
        return self

    def save(self, path: Any, *, harmonics: bool = True) -> None:
        """Writes the branch to one file in numpy's NPZ format: fields, special points, energies and slip fractions of all
        stored points, to the last bit. `hbvib.load` reads it; np.load(path) too, in any version of numpy.

        harmonics   with those of all degrees of freedom at all points, most of the file.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "branch.npz")
        >>> branch.save(path)
        >>> hbvib.load(path)
        <hbvib.SavedBranch: 44 points, omega 0.8 to 1.6, peak 0.583649 at omega = 1.23202, OK>
        """
        _storage.save(self, path, harmonics)

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame, a row for each point of the curve: columns named as the fields, slip_fraction_0 and so on for
        contacts; `attrs` has status and message. ImportError without pandas.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.to_dataframe()[["omega", "amplitude"]].shape == (len(branch), 2)
        True
        """
        from . import _tables
        return _tables.dataframe(self)

    def to_xarray(self) -> Any:
        """An xarray.Dataset of the fields over point and contact, with omega (in a mode log10_amplitude) as coordinate.
        ImportError without xarray.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> dict(branch.to_xarray().sizes)["contact"]
        1
        """
        from . import _tables
        return _tables.dataset(self)

    def plot(self, ax: Any = None, *, hertz: bool = False, **line: Any) -> Any:
        """Draws the branch with matplotlib: amplitude over angular frequency, peaks as dots; of a nonlinear mode
        frequency and damping ratio over the modal amplitude. Returns the axes, of a mode two. ImportError without
        matplotlib.

        ax      axes to draw into, of a mode a pair; None: new ones.
        hertz   True: frequencies omega / (2 pi).    line   options of ax.plot, such as label or color.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> axes = branch.plot(label="0.2 N")
        >>> axes.get_xlabel()
        'angular frequency omega'
        """
        from . import _plots
        return _plots.plot(self, ax, hertz, line)

    def plot_loop(self, point: int, contact: int, direction: int = 0, n: int = 256, *, ax: Any = None,
                  **line: Any) -> Any:
        """Draws the hysteresis loop of a contact at a point with matplotlib: force over relative motion. Returns the
        axes. ImportError without matplotlib. Arguments as in `loop` and `plot`.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> axes = branch.plot_loop(branch.peaks().point[0], 0)
        >>> axes.get_ylabel()
        'force of contact 0'
        """
        from . import _plots
        return _plots.loop(self, point, contact, direction, n, ax, line)

    def field(self, field: Any) -> np.ndarray:
        """A field, by Field or name, in the library's memory: (points), slip_fraction (points, contacts).

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> bool((branch.field("omega") == branch.omega).all())
        True
        """
        lease = _Lease(self)
        self._leases.add(lease)  # before the handle is read: free looks for leases after it has taken the handle
        view = _new("hbvib_view")
        try:
            _call("hbvib_branch_field", self.handle, _member(Field, field), view)
        except BaseException:
            self._leases.discard(lease)  # the traceback holds it, and no array was made
            raise
        dtype = np.dtype(np.complex128 if view.scalar == Scalar.COMPLEX else np.float64)
        shape = tuple(view.shape[:view.rank])
        if not view.data or 0 in shape:
            empty = np.empty(shape, dtype)
            empty.flags.writeable = False
            return empty
        lease.__array_interface__ = dict(  # type: ignore[attr-defined]
            version=3, typestr=dtype.str, shape=shape, data=(view.data, True),
            strides=tuple(dtype.itemsize * distance for distance in view.stride[:view.rank]))
        return np.asarray(lease)

    omega = _field_property(Field.OMEGA, "Angular frequency.")
    amplitude = _field_property(Field.AMPLITUDE, "Peak amplitude of the fundamental of the response dof.")
    residual = _field_property(Field.RESIDUAL, "Relative residual.")
    newton_iterations = _field_property(Field.NEWTON_ITERATIONS, "Newton iterations, as float64.")
    harmonics_used = _field_property(Field.HARMONICS_USED, "Highest harmonic number carried, as float64.")
    slip_fraction = _field_property(Field.SLIP_FRACTION, "Share of the period that each contact slips.")
    sampling_error = _field_property(Field.SAMPLING_ERROR, "Relative change of forces with half the samples; NaN where a law"
                                     " failed at the other samples.")
    error_estimate = _field_property(Field.ERROR_ESTIMATE, "Relative error of the response (modes: of the frequency) by"
                                     " harmonics left out; NaN where unknown, or with a fixed number unless estimate_error.")
    floquet_radius = _field_property(Field.FLOQUET_RADIUS, "With `stability`: largest modulus of the ordinary Floquet"
                                     " multipliers; NaN where unknown.")
    unstable_directions = _field_property(Field.UNSTABLE_DIRECTIONS, "With `stability`: number of those outside the unit"
                                          " circle, as float64; 0 for a stable motion.")
    damping_error_estimate = _field_property(Field.DAMPING_ERROR_ESTIMATE, "Modes: error of D, NaN as error_estimate.")
    damping_ratio = _field_property(Field.DAMPING_RATIO, "Modes: damping ratio D.")
    mode_energy = _field_property(Field.ENERGY, "Modes: twice the mean kinetic energy of a sector.")
    dissipation = _field_property(Field.DISSIPATION, "Modes: work of friction per cycle and sector.")
    structural_loss = _field_property(Field.STRUCTURAL_LOSS, "Modes: work of the structure's damping per cycle.")
    log10_amplitude = _field_property(Field.LOG10_AMPLITUDE, "Modes: log10 of the amplitude, the parameter.")
    modal_amplitude = _field_property(Field.MODAL_AMPLITUDE, "Modes: sqrt(X_1^H M X_1).")
    parameter_values = _field_property(Field.PARAMETER_VALUE, """Parameter responses: value of the parameter.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, harmonics=1)
        >>> float(found.parameter_values[-1])
        3.0
        """)
    d_amplitude = _field_property(Field.D_AMPLITUDE, "Parameter responses: total derivative of the amplitude by the"
                                  " parameter; NaN where there is none.")
    modal_assurance = _field_property(Field.MODAL_ASSURANCE, "Modes: likeness to the point before, 0 to 1.")

    def _filled(self, record: type[_Record], *arguments: Any, name: str) -> _Record:
        """The record that a function of the branch fills."""
        struct = _new("hbvib_" + name)
        self._call("hbvib_branch_" + name, *arguments, struct)
        return _record(record, struct)

    @property
    def reduction(self) -> Reduction:
        """Size of the problem that was solved, and the parts that were removed from it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.reduction.unknowns > 0, branch.reduction.contacts
        (True, 1)
        """
        return self._filled(Reduction, name="reduction")

    @property
    def mode_info(self) -> ModeInfo:
        """Where a nonlinear mode started. UnsupportedError for a forced response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> print("%.4f" % model.nonlinear_mode((-2, 1)).mode_info.omega)  # sqrt(2)
        1.4142
        """
        return self._filled(ModeInfo, name="mode_info")

    def mode_point(self, point: int) -> ModePoint:
        """Numbers of a point of a nonlinear mode.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> peak = mode.peaks().point[0]
        >>> print("%.3f" % mode.mode_point(peak).damping_ratio)
        0.120
        """
        return self._filled(ModePoint, point, name="mode_point")

    def energy(self, point: int, *, phase: Hook = None,
               cancel: Optional[CancelFlag] = None) -> Energy:
        """Energies and losses of a point.

        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> energy = branch.energy(branch.peaks().point[0])
        >>> print("%.3f" % energy.friction_loss)
        0.340
        """
        energy = _new("hbvib_energy")
        _stoppable("hbvib_branch_energy", self.handle, point, energy, phase=phase, cancel=cancel)
        return _record(Energy, energy)

    def summary(self, point: int, contact: int, *, phase: Hook = None,
                cancel: Optional[CancelFlag] = None) -> ContactSummary:
        """Work, shares of the period, ranges and loads of a contact at a point. phase, cancel: as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> summary = branch.summary(branch.peaks().point[0], 0)
        >>> print("%.3f %.3f" % (summary.work, summary.slip_share))
        0.340 0.501
        """
        summary = _new("hbvib_contact_summary")
        _stoppable("hbvib_branch_contact_summary", self.handle, point, contact, summary, phase=phase, cancel=cancel)
        return _record(ContactSummary, summary)

    def harmonics(self, point: int, first_dof: int = 0, n_dof: Optional[int] = None, *,
                  phase: Hook = None,
                  cancel: Optional[CancelFlag] = None) -> np.ndarray:
        """Harmonics 0 .. H at a point, (H + 1, n_dof) complex, a copy; n_dof None: all from first_dof on.

        phase, cancel   as in forced_response; Stopped is raised where they stop it. So in the methods below.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> x = branch.harmonics(branch.peaks().point[0])
        >>> print("%.4f" % abs(x[1, 0]))
        0.5836
        """
        reduction = self.reduction
        if n_dof is None:
            n_dof = max(reduction.degrees_of_freedom - _whole(first_dof), 1)
        x = np.empty((reduction.harmonics_asked + 1, n_dof), complex)
        _stoppable("hbvib_branch_harmonics", self.handle, point, first_dof, n_dof, x, x.size, phase=phase,
                   cancel=cancel)
        return x

    def slip(self, point: int) -> np.ndarray:
        """Shares of the period that each contact slips at any stored point, (contacts).

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.slip(branch.peaks().point[0]).round(3)
        array([0.501])
        """
        shares = np.empty(self.reduction.contacts)
        self._call("hbvib_branch_slip_fraction", point, shares, shares.size)
        return shares

    def time_history(self, point: int, dof: int, n: int = 256, *,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> np.ndarray:
        """Motion of a degree of freedom over one period at a point, n equidistant times.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.time_history(branch.peaks().point[0], 0, 4).round(3)
        array([ 0.01 ,  0.584, -0.01 , -0.584])
        """
        x = np.empty(n)
        _stoppable("hbvib_branch_time_history", self.handle, point, dof, n, x, phase=phase, cancel=cancel)
        return x

    def loop(self, point: int, contact: int, direction: int = 0, n: int = 256, *,
             phase: Hook = None,
             cancel: Optional[CancelFlag] = None) -> Loop:
        """Hysteresis loop of a contact over one period at a point: motion, force and state (State), n each.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> loop = branch.loop(branch.peaks().point[0], 0)
        >>> print("%.2f" % loop.force.max())  # mu preload
        0.30
        """
        motion, force, state = np.empty(n), np.empty(n), np.empty(n, np.int32)
        _stoppable("hbvib_branch_contact_loop", self.handle, point, contact, direction, n, motion, force, state,
                   phase=phase, cancel=cancel)
        return Loop(motion, force, state)

    def peaks(self) -> Points:
        """Maxima of the amplitude, in a nonlinear mode of the damping ratio: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.peaks().omega.round(4)
        array([1.232])
        """
        return Points(*self._listed("hbvib_branch_peaks", (), [float, float, np.int64]))

    def folds(self) -> Points:
        """Turning points in frequency, in a nonlinear mode in amplitude: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> len(branch.folds().omega)
        0
        """
        return Points(*self._listed("hbvib_branch_folds", (), [float, float, np.int64]))

    def bifurcations(self) -> Bifurcations:
        """Folds of a forced response and, with its option `stability`, the other points where a multiplier passes the
        unit circle: omega, amplitude, kind ("fold", "period_doubling", "neimark_sacker" or "branch_point"), point
        number, numbers of unstable directions before and after it along the branch, -1 where unknown.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> contact = model.add_spring_damper(0, spring=[0, 0, 0.1])
        >>> model.add_force(0, 0.18)
        >>> branch = model.forced_response((0.9, 1.3), stability="wave")
        >>> branch.bifurcations().kind.tolist(), branch.bifurcations().unstable_after.tolist()
        (['fold', 'fold'], [1, 0])
        """
        omega, amplitude, kind, *rest = self._listed("hbvib_branch_bifurcations", (),
                                                     [float, float, np.int64, np.int64, np.int64, np.int64])
        names = np.array([Bifurcation(k).name.lower() for k in kind], dtype="U15")
        return Bifurcations(omega, amplitude, names, *rest)

    def optima(self) -> Optima:
        """Minima and maxima of the amplitude over the parameter of a parameter response: value of the parameter,
        amplitude, kind ("minimum" or "maximum"), point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, harmonics=1)
        >>> found.optima().kind.tolist()  # the amplitude only rises
        []
        """
        found = self._listed("hbvib_branch_optima", (), [float, float, np.int64, np.int64])
        return Optima(found[0], found[1], np.where(found[2] == 1, "maximum", "minimum"), found[3])

    def limit_cycles(self) -> LimitCycles:
        """Points of a nonlinear mode where its damping ratio is zero, motions of the model without forces: omega, log10
        of the amplitude, slope of the damping ratio by it, point number for Model.floquet and others.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=-0.02)  # grows by itself
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> len(mode.limit_cycles().omega)  # where friction takes what negative damping gives
        1
        """
        return LimitCycles(*self._listed("hbvib_branch_limit_cycles", (), [float, float, float, np.int64]))

    def at(self, wanted: int) -> Wanted:
        """Every solution at one entry of the solve's `at`: amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6), at=[1.0, 1.2])
        >>> branch.at(1).amplitude.round(4)
        array([0.56])
        """
        return Wanted(*self._listed("hbvib_branch_at", (wanted,), [float, np.int64]))

    @_with_options("hbvib_synthesis_options", SynthesisOptions)
    def synthesis(self, model: Model, *, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                  **options: Unpack[SynthesisOptions]) -> Synthesis:
        """The response to the forces of a model, from this nonlinear mode: omega, response (complex fundamental of
        the response degree of freedom), modal_amplitude.

        {options}
        phase, cancel   as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> found = mode.synthesis(model, model_damping=1)
        >>> print("%.3f" % abs(found.response).max())
        0.455
        """
        stop = dict(phase=phase, cancel=cancel)
        return Synthesis(*self._synthesis("synthesis", model, options, [float, complex, float], stop))

    @_with_options("hbvib_synthesis_options", SynthesisOptions)
    def synthesis_peaks(self, model: Model, *, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                        **options: Unpack[SynthesisOptions]) -> SynthesisPeaks:
        """The resonances of a synthesised response; `flags` are sums of SynthesisFlag, other_mode the distance of the
        nearest other mode over the half-power bandwidth, error the amplitude over that of the computed resonance next
        to it, minus 1.

        {options}
        phase, cancel   as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> mode.synthesis_peaks(model, model_damping=1).omega.round(3)
        array([1.231])
        """
        stop = dict(phase=phase, cancel=cancel)
        return SynthesisPeaks(*self._synthesis("synthesis_peaks", model, options, [float] * 6 + [np.int32], stop))

    def _synthesis(self, name: str, model: Model, options: Mapping[str, Any], dtypes: Sequence[Any],
                   stop: dict[str, Any]) -> list[Any]:
        settings = _options(name, "hbvib_synthesis_options", options)
        return self._listed("hbvib_branch_" + name, (model.handle, settings), dtypes, stop)


from . import _storage
from ._storage import SavedBranch, load
