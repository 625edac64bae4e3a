"""hbvib for Python: steady-state vibration of structures with friction contacts, by harmonic balance.

    M x'' + C x' + K x + f_contact(x) = f_excitation,      x(t) = Re sum_{h=0..H} X_h exp(i h omega t)

Two objects: a `Model` (matrices, contacts, forces) and the `Branch` of solutions that a solve returns.
Units are any consistent set; angular frequencies are in rad per time unit, amplitudes are peak values.
Degrees of freedom, points, contacts and harmonics count from 0. The mathematics, and what each option
means, is in hbvib.h, whose functions are all reachable, with prototypes, as `hbvib.lib.hbvib_...`.

Errors      Below zero, a status is raised as a subclass of `Error` that is also Python's own (ValueError,
            IndexError, MemoryError ...). Above zero, the branch is returned and `StoppedEarly` is warned of,
            unless the caller stopped the solve. Wrong types are TypeError, wrong shapes ValueError.
Arrays      C- or Fortran-ordered and strided float64 and complex128 matrices are handed over without a
            copy; types that numpy calls safe to cast are converted; scipy.sparse matrices of any format are taken.
            Fields of a branch are read-only arrays in the library's own memory and keep the branch alive.
Threads     Any number of threads may solve one model and read one branch at once: calls release the GIL.
            Changing or freeing an object in use is BusyError.
Callbacks   run on the calling thread. What they raise comes out of the call that led there, the same object;
            an attribute `branch` holds the points found so far, if the solve had begun a branch.
Ctrl-C      stops a solve at its next point, in time integration at the next period: while a solve runs in the
            main thread, the handler of SIGINT is wrapped, as asyncio does, and KeyboardInterrupt carries
            `branch` as well. Other calls end first.
"""
from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import enum
import operator
import os
import signal
import sys
import threading
import warnings
import weakref
from collections import namedtuple
from typing import Any, Callable, Iterator, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike

# ------------------------------------------------------------------------------------------ constants


def _counted(name: str, names: str, start: int = 0) -> Any:
    return enum.IntEnum(name, names, start=start, module=__name__)


Status = enum.IntEnum("Status", dict(
    OK=0, STOPPED_BY_CALLER=1, STOPPED_STEP_TOO_SMALL=2, STOPPED_MAX_POINTS=3, STOPPED_MAX_HARMONICS=4,
    STOPPED_STALLED=5, STOPPED_LEFT_RANGE=6, STOPPED_CALLBACK=7, E_NULL=-1, E_ARGUMENT=-2, E_DIMENSION=-3,
    E_NOT_FINITE=-4, E_NOT_HERMITIAN=-5, E_SINGULAR=-6, E_NO_CONVERGENCE=-7, E_STRUCT_SIZE=-8, E_CALLBACK=-9,
    E_UNSUPPORTED=-10, E_OUT_OF_MEMORY=-11, E_NO_BOUNDED_SOLUTION=-12, E_HANDLE=-13, E_BUSY=-14, E_INDEX=-15,
    E_NOT_POSITIVE_DEFINITE=-16, E_INTERNAL=-99), module=__name__)
Storage = _counted("Storage", "COL_MAJOR ROW_MAJOR CSC")
Scalar = _counted("Scalar", "REAL COMPLEX")
Part = _counted("Part", "FULL LOWER UPPER GENERAL")
MatrixKind = _counted("MatrixKind", "MASS DAMPING STIFFNESS")
ContactKind = _counted("ContactKind", "JENKINS FRICTION_2D FRICTION_3D UNILATERAL CUBIC REGULARISED", 1)
ContactState = _counted("ContactState", "FREE STUCK")
State = _counted("State", "STICK SLIP OPEN")
Tangent = _counted("Tangent", "DF_DU DF_DV DF_DZ DZ_DZ DZ_DU_BEFORE DZ_DU DZ_DV_BEFORE DZ_DV DZ_DOMEGA")
Field = enum.IntEnum("Field", dict(
    OMEGA=0, AMPLITUDE=1, DAMPING_RATIO=2, ENERGY=3, DISSIPATION=4, RESIDUAL=5, NEWTON_ITERATIONS=6,
    ERROR_ESTIMATE=7, HARMONICS_USED=8, SLIP_FRACTION=9, LOG10_AMPLITUDE=10, MODAL_AMPLITUDE=11, STRUCTURAL_LOSS=12,
    MODAL_ASSURANCE=13, SAMPLING_ERROR=14, DAMPING_ERROR_ESTIMATE=15), module=__name__)
DampingForm = _counted("DampingForm", "MASS STIFFNESS")
ModeMultiple = _counted("ModeMultiple", "SINGLE TRAVELLING_WAVE PROJECTED FIRST")
SynthesisFlag = enum.IntFlag("SynthesisFlag", dict(
    VALID=0, ANOTHER_MODE=1, INTERNAL_RESONANCE=2, FALLING=4), module=__name__)
LogLevel = _counted("LogLevel", "NONE WARN INFO DEBUG")
SteadyMethod = _counted("SteadyMethod", "SHOOTING MARCHING")
GROUND = -1  #: The degree of freedom of the ground, which does not move.

# ------------------------------------------------------------------------------------------ C interface

# Structs in the header's order: "type names, array[length] ...; ..." for each. They are filled by their
# _init function, except the two that only the library writes.
_STRUCTS = """
matrix: uint32 struct_size; int32 storage scalar part; int64 rows cols ld; pointer values col_ptr row_idx;
    int32 index_base reserved
contact: uint32 struct_size; int32 kind; int64 dof_a[3] dof_b[3] sector_offset;
    double kt kn mu preload gap cubic velocity normal[3] tangent[3]
force_call: uint32 struct_size; int32 reserved; double omega; int64 samples n states;
    pointer u v z0 f df_du df_dv z dz_dz dz_du_before dz_du dz_dv_before dz_dv dz_domega df_dz
user_force: uint32 struct_size; int32 uses_velocity is_odd reserved; pointer dofs; int64 n states samples;
    force_fn force; pointer user
jacobian_gap: uint32 struct_size; int32 tangent; double gap; int64 sample row column; double given difference
solver_options: uint32 struct_size; int32 num_threads; double tolerance; int64 harmonics max_harmonics samples;
    double step step_min step_max tol_residual; int64 max_newton max_points response_dof;
    int32 keep_even_harmonics estimate_error
forced_options: uint32 struct_size; int32 reserved; double omega_start omega_stop; pointer at; int64 at_len;
    pointer guess; int64 guess_len
progress: uint32 struct_size; int32 newton_iterations; int64 point;
    double parameter amplitude residual step fraction_done
hooks: uint32 struct_size; int32 log_level; pointer user; progress_fn progress; log_fn log; pointer cancel
mode_options: uint32 struct_size; int32 damping_form; double log10_start log10_stop; int64 diameter mode_index;
    double near_omega; pointer shape; int64 shape_len amplitude_contact; pointer at; int64 at_len reference_dof
view: uint32 struct_size; int32 scalar rank reserved; pointer data; int64 shape[3] stride[3]
reduction: uint32 struct_size; int32 reserved; int64 sectors degrees_of_freedom coordinates contacts
    never_slipping inert harmonics_asked harmonics_carried unknowns response_dof;
    int32 mean_carried even_removed; int64 held_by_contacts
energy: uint32 struct_size; int32 reserved; double twice_mean_kinetic kinetic_mean kinetic_peak potential_mean
    potential_peak wheel_kinetic_mean wheel_kinetic_peak wheel_potential_mean wheel_potential_peak
    structural_loss friction_loss
contact_summary: uint32 struct_size; int32 reserved; double work slip_share open_share half_range motion_min
    motion_max load_min load_max; int64 directions; double all_min[3] all_max[3]
mode_point: uint32 struct_size; int32 reserved; double log10_amplitude omega damping_ratio modal_amplitude energy
    fundamental_share friction_loss structural_loss energy_damping_ratio assurance
mode_info: uint32 struct_size; int32 multiple; int64 mode_index multiplicity reference_dof engine_order
    amplitude_contact; double omega linear_up_to
synthesis_options: uint32 struct_size; int32 model_damping; double force_factor damping_ratio
time_options: uint32 struct_size; int32 method; double omega; int64 harmonics samples; double tolerance;
    int64 max_periods; pointer start; int64 start_len
time_info: uint32 struct_size; int32 reserved; double period residual; int64 periods events
verify_options: uint32 struct_size; int32 method; double tolerance; int64 max_periods; double same_within
verification: uint32 struct_size; int32 same_solution marched reserved; int64 harmonic; double response[2]
    response_error motion_error above distance peak peak_error residual; int64 periods events
"""

# Functions that return a status; the _init functions follow from the structs. Letters of the arguments: i int32,
# l int64, d double, z size_t, p a pointer to numbers, text or a handle, h a handle; or the name of a struct.
_FUNCTIONS = """
model_new lp; cyclic_new llp; model_set_matrix hi matrix; model_set_rayleigh hdd; cyclic_set_coupling hi matrix;
cyclic_set_coupling_previous hi matrix; cyclic_set_diameter hil matrix; cyclic_set_wave hl; model_clone hp;
model_free h; model_add_force hlldd; model_clear_forces h; linear_modes hlilpp; model_add_contact h contact p;
model_set_preload hld; contact_evaluate contact lldplplpl; model_add_jenkins hlppppppp; model_add_springs hlpppp;
model_add_iwan hlllddddlp; model_add_user_force h user_force p; check_jacobian hldpl jacobian_gap;
model_add_table hllllppp; model_add_spring_damper hllllplpp; model_add_polynomial hpllppppp;
model_add_stiffness_tensors hplppp; model_add_patch h contact lpppppppp;
forced_response h solver_options forced_options hooks p; nonlinear_mode h solver_options mode_options hooks p;
branch_free h; branch_status h; branch_field hi view; branch_harmonics hlllpl; branch_slip_fraction hlpl;
branch_reduction h reduction; branch_peaks hlpppp; branch_folds hlpppp; branch_at hllppp; branch_energy hl energy;
branch_time_history hlllp; branch_contact_loop hllllppp; branch_contact_summary hll contact_summary;
branch_mode_point hl mode_point; branch_mode_info h mode_info; branch_synthesis hh synthesis_options lpppp;
branch_synthesis_peaks hh synthesis_options lppppppp; forced_residual h solver_options dplplplpl;
time_response h time_options hooks plpl time_info; verify hhl verify_options hooks plpl verification;
index_from_one pllp
"""

_TYPES: dict = dict(
    int32=ctypes.c_int32, uint32=ctypes.c_uint32, int64=ctypes.c_int64, double=ctypes.c_double,
    pointer=ctypes.c_void_p, i=ctypes.c_int32, l=ctypes.c_int64, d=ctypes.c_double, z=ctypes.c_size_t,
    p=ctypes.c_void_p, h=ctypes.c_void_p,
    log_fn=ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int32, ctypes.c_char_p))


def _struct(name: str, text: str) -> type:
    fields = []
    for group in text.split(";"):
        kind, *members = group.split()
        for member in members:
            member, _, length = member.rstrip("]").partition("[")
            fields.append((member, _TYPES[kind] * int(length) if length else _TYPES[kind]))
    return type(name, (ctypes.Structure,), {"_fields_": fields, "__module__": __name__})


#: The structs of the header by their C names, as ctypes types: structs["hbvib_contact"].
structs: dict = {}
for _entry in _STRUCTS.replace("\n    ", " ").strip().splitlines():
    _name, _, _text = _entry.partition(":")
    structs["hbvib_" + _name] = _TYPES[_name] = _struct("hbvib_" + _name, _text)
    if _name in ("force_call", "progress"):  # the callbacks that are handed them
        _TYPES[_name.replace("_call", "") + "_fn"] = ctypes.CFUNCTYPE(
            ctypes.c_int32, ctypes.c_void_p, ctypes.POINTER(_TYPES[_name]))


def _letters(text: str) -> list:
    """Arguments of a prototype: struct names whole, all else letter by letter."""
    return [kind for word in text.split() for kind in ([word] if word in _TYPES else word)]


_ARGUMENTS = {"hbvib_" + name: _letters(kinds)
              for name, _, kinds in (entry.strip().partition(" ") for entry in _FUNCTIONS.split(";"))}
_ARGUMENTS.update({name + "_init": [name[6:], "z"] for name in structs
                   if name not in ("hbvib_force_call", "hbvib_progress")})
_OTHERS = dict(  # functions that return no status, and their results
    hbvib_version=("", ctypes.c_uint32), hbvib_version_string=("", ctypes.c_char_p),
    hbvib_status_name=("i", ctypes.c_char_p), hbvib_last_error=("", ctypes.c_char_p),
    hbvib_last_error_argument=("", ctypes.c_int32), hbvib_last_error_copy=("pz", ctypes.c_size_t),
    hbvib_branch_points=("h", ctypes.c_int64), hbvib_branch_stored=("h", ctypes.c_int64), hbvib_model_dofs=("h", ctypes.c_int64),
    hbvib_model_sectors=("h", ctypes.c_int64), hbvib_model_contacts=("h", ctypes.c_int64))
_ARGUMENTS.update({name: list(letters) for name, (letters, _) in _OTHERS.items()})
_VERSION = (0, 1)


def _open(path: str) -> ctypes.CDLL:
    """Loads a library and gives its functions their prototypes. OSError where it is not the right one."""
    library = ctypes.CDLL(path)
    try:
        for name, kinds in _ARGUMENTS.items():
            function = getattr(library, name)
            function.argtypes = [ctypes.POINTER(_TYPES[kind]) if len(kind) > 1 else _TYPES[kind] for kind in kinds]
            function.restype = _OTHERS[name][1] if name in _OTHERS else ctypes.c_int32
            if name == "hbvib_version":
                version = function()
                if (version >> 16, version >> 8 & 255) != _VERSION:
                    found = f"{version >> 16}.{version >> 8 & 255}.{version & 255}"
                    raise OSError(f"is version {found}, needs {_VERSION[0]}.{_VERSION[1]}")
    except AttributeError:
        raise OSError(f"has no function {name}") from None
    return library


_HERE = os.path.dirname(os.path.abspath(__file__))
_FOLDERS = [os.path.normpath(os.path.join(_HERE, folder)) for folder in (
    "", "../target/release", "../target/debug", "../../lib", "../lib")]


def _candidates() -> Iterator[str]:
    """Where the library may be: HBVIB_LIBRARY and nowhere else; or beside this module, in the cargo target folder, in
    the lib folder of an install prefix, then wherever the system's loader finds it."""
    wanted = os.environ.get("HBVIB_LIBRARY")
    if wanted is not None:
        yield wanted if os.path.dirname(wanted) else os.path.join(os.curdir, wanted)
        return
    names = dict(win32=["hbvib.dll"], darwin=["libhbvib.dylib"]).get(
        sys.platform, [f"libhbvib.so.{_VERSION[0]}.{_VERSION[1]}", "libhbvib.so"])
    paths = (os.path.join(place, name) for place in _FOLDERS for name in names)
    yield from filter(os.path.exists, paths)
    yield names[0]
    yield from filter(None, [ctypes.util.find_library("hbvib")])


def _load() -> ctypes.CDLL:
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

# ------------------------------------------------------------------------------------------ errors


class Error(Exception):
    """What the library refused. `sentence` says what is wrong, where, and what is accepted; `status` is the
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
    """The combination asked for is not provided."""


class OutOfMemoryError(Error, MemoryError):
    """Memory could not be had."""


class CallbackError(Error, RuntimeError):
    """A force callback refused, or wrote numbers that are not finite."""


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


_CONVERT: dict = dict(i=lambda value: _whole(value, 32), l=_whole, d=_real, z=_whole)
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


def _array(name: str, value: Any, dtype: Any = np.float64, shape: Optional[Sequence] = None) -> np.ndarray:
    """A packed array of `dtype`; only the lengths of `shape` that are not None are demanded.

    TypeError where numbers would be lost, ValueError for another shape."""
    array = _numbers(name, value, dtype)
    if shape is not None and (array.ndim != len(shape) or any(
            want is not None and want != have for want, have in zip(shape, array.shape))):
        need = ", ".join("any" if want is None else str(want) for want in shape)
        raise ValueError(f"{name} has shape {array.shape}, needs ({need})")
    return np.require(array, dtype, "CA")


def _numbers(name: str, value: Any, dtype: Any) -> np.ndarray:
    if np.ma.is_masked(value):
        raise TypeError(f"{name} has masked entries")
    array = np.asarray(value)
    if array.size and not np.can_cast(array.dtype, dtype, "safe"):
        raise TypeError(f"{name} holds {array.dtype}, which is not {np.dtype(dtype)} without loss")
    return array


def _counted_array(name: str, value: Any, dtype: Any = np.float64, shape: Sequence = (None,)) -> dict:
    """An optional array, and its length beside it, as options have them."""
    if value is None:
        return {}
    array = _array(name, [value] if np.ndim(value) == 0 else value, dtype, shape)
    return {name: array, name + "_len": array.size}


def _columns(**columns: tuple) -> list:
    """Packed one-dimensional arrays of one length from numbers and arrays, given as (value, dtype)."""
    arrays = [_numbers(name, *given) for name, given in columns.items()]
    try:
        (length,) = np.broadcast_shapes((1,), *(array.shape for array in arrays))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(columns, arrays))
        raise ValueError(f"arrays of different shapes: {shapes}") from None
    return [np.require(np.broadcast_to(array, length), dtype, "CA")
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


def _options(caller: str, name: str, given: dict, hidden: str = "", **more: Any) -> Any:
    """A struct from the user's keyword arguments and `more`: TypeError for one that is no field or hidden."""
    fields = {field for field, _ in structs[name]._fields_} - {"struct_size", "reserved", *hidden.split()}
    for key in given:
        if key not in fields:
            raise TypeError(f"{caller}() got an unexpected keyword argument {key!r}; options are "
                            + ", ".join(sorted(fields)))
    return _new(name, **given, **more)


def _matrix(value: Any, part: Any) -> Any:
    """Description of a matrix: dense without a copy where its strides allow, sparse of any scipy format."""
    part = _member(Part, part)
    if hasattr(value, "tocsc"):
        sparse = value.tocsc()
        numbers = _numbers("matrix", sparse.data, np.complex128)
        dtype = np.complex128 if numbers.dtype.kind == "c" else np.float64
        rows, cols = sparse.shape
        starts = _array("indptr", sparse.indptr, np.int64, [cols + 1])
        places = _array("indices", sparse.indices, np.int64, [None])
        if starts[-1] > min(len(places), len(numbers)):  # all that the library cannot check itself
            raise ValueError(
                f"matrix: indptr ends at {starts[-1]}, beyond {len(places)} indices and {len(numbers)} numbers")
        return _new("hbvib_matrix", storage=Storage.CSC, scalar=int(dtype is np.complex128), part=part, rows=rows,
                    cols=cols, values=_array("matrix", numbers, dtype), col_ptr=starts, row_idx=places)
    dense = _numbers("matrix", value, np.complex128)
    if dense.ndim == 0:
        dense = dense.reshape(1, 1)
    if dense.ndim != 2:
        raise ValueError(f"matrix has shape {dense.shape}, needs two dimensions")
    dtype = np.dtype(np.complex128 if dense.dtype.kind == "c" else np.float64)
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


def _record(title: str, struct: str, **enums: Any) -> type:
    """A named tuple with the fields of a struct; `of` makes one, with enumerations in place of numbers."""
    names = [name for name, _ in structs[struct]._fields_ if name not in ("struct_size", "reserved")]
    kind = namedtuple(title, names, module=__name__)  # type: ignore[misc]
    kind.__doc__ = f"Fields of {struct}, see hbvib.h: {', '.join(names)}."

    def of(filled: Any) -> tuple:
        values = (getattr(filled, name) for name in names)
        whole = (tuple(value) if isinstance(value, ctypes.Array) else value for value in values)
        return kind(*(enums[name](value) if name in enums else value for name, value in zip(names, whole)))

    kind.of = staticmethod(of)  # type: ignore[attr-defined]
    return kind


Energy = _record("Energy", "hbvib_energy")
ContactSummary = _record("ContactSummary", "hbvib_contact_summary")
ModePoint = _record("ModePoint", "hbvib_mode_point")
ModeInfo = _record("ModeInfo", "hbvib_mode_info", multiple=ModeMultiple)
Reduction = _record("Reduction", "hbvib_reduction", mean_carried=bool, even_removed=bool)
JacobianGap = _record("JacobianGap", "hbvib_jacobian_gap", tangent=Tangent)
TimeInfo = _record("TimeInfo", "hbvib_time_info")
VerificationInfo = _record("VerificationInfo", "hbvib_verification", same_solution=bool, marched=bool,
                           response=lambda pair: complex(*pair))


class Progress(NamedTuple):
    """State of a solve at an accepted point, as a progress callback gets it. `parameter` is the angular
    frequency, in a nonlinear mode log10 of the amplitude; `fraction_done` runs from 0 to 1."""
    point: int
    parameter: float
    amplitude: float
    residual: float
    step: float
    newton_iterations: int
    fraction_done: float


Modes = namedtuple("Modes", "omega shapes")
Points = namedtuple("Points", "omega amplitude point")
Wanted = namedtuple("Wanted", "amplitude point")
Loop = namedtuple("Loop", "motion force state")
Synthesis = namedtuple("Synthesis", "omega response modal_amplitude")
SynthesisPeaks = namedtuple("SynthesisPeaks", "omega amplitude log10_amplitude damping_ratio other_mode flags")
Residual = namedtuple("Residual", "residual jacobian d_omega")
ContactForce = namedtuple("ContactForce", "force jacobian")
TimeResponse = namedtuple("TimeResponse", "harmonics samples info status")
Verification = namedtuple("Verification", "harmonics errors info status")

# ------------------------------------------------------------------------------------------ calls

_running = threading.local()  # .guard: the guard of the innermost call of this thread


class _Guard:
    """Surrounds one call of the library that may run callbacks: holds what they raise and raises it, whole, when
    the call is over. The handler of SIGINT must not raise where a callback is entered, outside of any try, where
    ctypes would drop the exception: there it is run by the guard."""

    def __init__(self) -> None:
        self.held: Optional[BaseException] = None
        self.branch: Optional[Branch] = None
        self.inside = False  # the host's own code is running
        self.wrapped = False  # the handler of SIGINT is this one

    def __enter__(self) -> _Guard:
        self.before = signal.getsignal(signal.SIGINT)
        outer = getattr(self.before, "__self__", None)
        self.handler = outer.handler if isinstance(outer, _Guard) else self.before
        if callable(self.handler):
            with contextlib.suppress(ValueError):  # not the main thread, which alone handles signals
                signal.signal(signal.SIGINT, self.interrupted)
                self.wrapped = True
        self.outer, _running.guard = getattr(_running, "guard", None), self
        return self

    def __exit__(self, *_: Any) -> None:
        _running.guard = self.outer
        if self.wrapped and signal.getsignal(signal.SIGINT) == self.interrupted:  # else a callback set its own
            signal.signal(signal.SIGINT, self.before)
        held, self.held = self.held, None
        if held is not None:
            if self.branch is not None:
                with contextlib.suppress(AttributeError, TypeError):  # an exception without room for it
                    held.branch = self.branch  # type: ignore[attr-defined]
            try:
                raise held
            finally:
                del held  # else it would hold this frame, and this frame it

    def interrupted(self, number: int, frame: Any) -> None:
        if self.inside:
            self.handler(number, frame)
        else:
            self.run(self.handler, number, frame)

    def run(self, function: Callable, *arguments: Any) -> Any:
        """Result of the host's code, None where it raised."""
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
    status = getattr(lib, name)(*[convert(value) for convert, value in zip(_CONVERTERS[name], arguments)])
    if status < 0 and (guard is None or guard.held is None):
        known = Status(status) if status in Status.__members__.values() else status
        raise _ERRORS.get(known, Error)(_sentence(status), known, lib.hbvib_last_error_argument())
    return status


class CancelFlag:
    """Stops a solve from another thread: `set()` is looked at in every Newton iteration. Hand it in as cancel=."""

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


def _hooks(guard: _Guard, progress: Optional[Callable], log: Optional[Callable], log_level: Any,
           cancel: Optional[CancelFlag]) -> Any:
    """The hooks of one solve. Ctrl-C and failures of `log` need progress, too."""
    for name, function in (("progress", progress), ("log", log)):
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

    def on_log(_: Any, level: int, text: bytes) -> None:
        guard.run(log, LogLevel(level), text.decode(errors="replace"))

    hooks = _new("hbvib_hooks")
    if progress is not None or log is not None or guard.wrapped:
        hooks.progress = _TYPES["progress_fn"](on_progress)
    if log is not None:
        hooks.log, hooks.log_level = _TYPES["log_fn"](on_log), _member(LogLevel, log_level)
    if cancel is not None:
        hooks.cancel = ctypes.addressof(cancel.value)
    return hooks


class ForceCall:
    """One period that a user force is asked about, in the names of hbvib_force_call: omega, samples N, n, states s,
    and arrays in the library's own memory, valid during the callback only (copy what you keep):

    in   u (N, n), v (N, n), z0 (s);                                       read-only
    out  f (N, n), df_du and df_dv (N, n, n), z (N, s), dz_dz (N, s, s), dz_du_before, dz_du, dz_dv_before and
         dz_dv (N, s, n), dz_domega (N, s), df_dz (N, n, s).

    v, df_dv, dz_dv and dz_dv_before are None unless uses_velocity, all with a z unless there are states."""

    _SHAPES = dict(u="Nn", v="Nn", z0="s", f="Nn", df_du="Nnn", df_dv="Nnn", z="Ns", dz_dz="Nss", dz_du_before="Nsn",
                   dz_du="Nsn", dz_dv_before="Nsn", dz_dv="Nsn", dz_domega="Ns", df_dz="Nns")

    def __init__(self, call: Any) -> None:
        self._call = call
        self.omega, self.samples, self.n, self.states = call.omega, call.samples, call.n, call.states

    def __getattr__(self, name: str) -> Optional[np.ndarray]:
        if name not in self._SHAPES:  # each array is made when it is first asked for
            raise AttributeError(name)
        address, lengths, array = getattr(self._call, name), dict(N=self.samples, n=self.n, s=self.states), None
        if address:
            shape = [lengths[letter] for letter in self._SHAPES[name]]
            count = int(np.prod(shape))
            array = np.frombuffer((ctypes.c_double * count).from_address(address)).reshape(shape)
            array.flags.writeable = name not in ("u", "v", "z0")
        setattr(self, name, array)
        return array


class _Owner:
    """Owns a handle of the library, and the callables that the library may call on its behalf."""

    _handle: Optional[int] = None
    _kept: Sequence = ()

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

    def __reduce__(self) -> Any:
        raise TypeError(f"a {type(self).__name__} cannot be pickled")

    def free(self) -> None:
        raise NotImplementedError


# ------------------------------------------------------------------------------------------ model

# Places of the directions t1, t2, n in which a law acts.
_PLACES = {ContactKind.FRICTION_2D: (0, 2), ContactKind.FRICTION_3D: (0, 1, 2), ContactKind.UNILATERAL: (2,)}


def _side(kind: Any, dofs: Any) -> list:
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


def _law(caller: str, kind: Any, constants: dict) -> Any:
    return _options(caller, "hbvib_contact", constants, "kind dof_a dof_b", kind=_member(ContactKind, kind))


class Model(_Owner):
    """A structure with its contacts and forces; `Model.cyclic` makes one of equal sectors.

    ndof       degrees of freedom; may be left out where a matrix is given.
    mass, damping, stiffness   ndof x ndof matrices, symmetric or Hermitian: arrays, scipy.sparse, or a number for
               one degree of freedom; zero where left out. See `set_matrix` for others.
    rayleigh   (alpha, beta): adds alpha M + beta K to the damping.

    Freed by `free`, at the end of a `with` block, or with the last reference. `copy.copy` and `clone` copy it."""

    def __init__(self, ndof: Optional[int] = None, *, mass: Any = None, damping: Any = None, stiffness: Any = None,
                 rayleigh: Optional[Sequence[float]] = None) -> None:
        self._create(None, ndof, dict(mass=mass, damping=damping, stiffness=stiffness), {}, rayleigh)

    @classmethod
    def cyclic(cls, ndof: Optional[int] = None, *, sectors: int, engine_order: int = 0, mass: Any = None,
               damping: Any = None, stiffness: Any = None, coupling: Optional[dict] = None,
               rayleigh: Optional[Sequence[float]] = None) -> Model:
        """A wheel of equal sectors under an engine order; ndof and matrices are those of one sector.

        coupling   matrices of a sector (rows) to the next one (columns): dict(stiffness=..., mass=...).
        engine_order   sector s + 1 lags behind s by 2 pi engine_order / sectors per harmonic; any sign and size."""
        model = cls.__new__(cls)
        model._create(sectors, ndof, dict(mass=mass, damping=damping, stiffness=stiffness), coupling or {}, rayleigh)
        model.set_wave(engine_order)
        return model

    def _create(self, sectors: Any, ndof: Any, matrices: dict, coupling: dict, rayleigh: Any) -> None:
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
        return f"<hbvib.Model: {self.ndof} degrees of freedom, {self.sectors} sectors, {self.contacts} contacts>"

    def __del__(self, free: Any = lib.hbvib_model_free) -> None:
        if self._handle is not None:
            free(self._handle)

    def free(self) -> None:
        """Frees the model; branches solved from it stay. FreedError if it was freed, BusyError while in use."""
        _call("hbvib_model_free", self.handle)
        self._handle, self._kept = None, []

    def clone(self) -> Model:
        """A copy with the same matrices, contacts, forces and user forces."""
        handle, kept = ctypes.c_void_p(), self._kept
        self._call("hbvib_model_clone", handle)
        copy = type(self).__new__(type(self))
        copy._handle, copy._kept = handle.value, list(kept)
        return copy

    __copy__ = clone

    def __deepcopy__(self, _: dict) -> Model:
        return self.clone()

    @property
    def ndof(self) -> int:
        """Degrees of freedom, of one sector."""
        return _call("hbvib_model_dofs", self.handle)

    @property
    def sectors(self) -> int:
        """Sectors; 1 for a plain structure."""
        return _call("hbvib_model_sectors", self.handle)

    @property
    def contacts(self) -> int:
        """Number of contacts, user forces included."""
        return _call("hbvib_model_contacts", self.handle)

    def set_matrix(self, which: Any, matrix: Any, part: Any = Part.FULL) -> None:
        """Sets M, C or K: which is "mass", "damping", "stiffness" or a MatrixKind; matrix is ndof x ndof.

        part   "full": symmetric or Hermitian, which is checked; "lower", "upper": that triangle of such a one, the
               rest is not read; "general": any, for damping and stiffness."""
        self._call("hbvib_model_set_matrix", _member(MatrixKind, which), _matrix(matrix, part))

    def set_rayleigh(self, alpha_mass: float, beta_stiffness: float) -> None:
        """Adds alpha_mass M + beta_stiffness K to the damping (1 / time, time); replaces an earlier call."""
        self._call("hbvib_model_set_rayleigh", alpha_mass, beta_stiffness)

    def set_coupling(self, which: Any, to_next: Any) -> None:
        """Coupling of a sector (rows) to the next (columns), ndof x ndof; its transpose couples to the previous."""
        self._call("hbvib_cyclic_set_coupling", _member(MatrixKind, which), _matrix(to_next, Part.GENERAL))

    def set_coupling_previous(self, which: Any, to_previous: Any) -> None:
        """Coupling to the previous sector where it is not the transpose: damping and stiffness only."""
        self._call("hbvib_cyclic_set_coupling_previous", _member(MatrixKind, which), _matrix(to_previous, Part.GENERAL))

    def set_diameter(self, which: Any, diameter: int, matrix: Any, part: Any = Part.FULL) -> None:
        """The complex matrix of the wave of a nodal diameter 0 .. sectors / 2, instead of sector blocks."""
        self._call("hbvib_cyclic_set_diameter", _member(MatrixKind, which), diameter, _matrix(matrix, part))

    def set_wave(self, engine_order: int) -> None:
        """Engine order of the excitation, of any sign and size."""
        self._call("hbvib_cyclic_set_wave", engine_order)

    def add_force(self, dof: int, force: complex, harmonic: int = 1) -> None:
        """Adds Re(force exp(i harmonic omega t)) on a degree of freedom, a peak value; harmonic 0 is constant."""
        if isinstance(force, (str, bytes)):
            raise TypeError(f"force needs a number, not {force!r}")
        force = complex(force)
        self._call("hbvib_model_add_force", dof, harmonic, force.real, force.imag)

    def clear_forces(self) -> None:
        """Removes all forces."""
        self._call("hbvib_model_clear_forces")

    def _identified(self, name: str, *arguments: Any) -> int:
        """Calls a function that adds contacts and tells the number of the first."""
        first = ctypes.c_int64()
        self._call(name, *arguments, first)
        return first.value

    def add_contact(self, kind: Any, a: Any, b: Any = GROUND, **constants: Any) -> int:
        """Adds a contact and returns its number.

        kind   a ContactKind or its name: "jenkins", "friction_2d", "friction_3d", "unilateral", "cubic", "regularised".
        a, b   degree of freedom of each side, or a sequence of them in the directions in which the law acts (t1 and n
               of friction_2d; t1, t2 and n, or t1 and t2 under a constant load, of friction_3d), or all three places.
        kt, kn, mu, preload, gap, cubic, velocity   the constants of the kind.
        normal, tangent   directions in the axes of three degrees of freedom a side.
        sector_offset   side b lies in sector s + sector_offset."""
        law = _law("add_contact", kind, constants)
        law.dof_a[:], law.dof_b[:] = (_side(ContactKind(law.kind), side) for side in (a, b))
        return self._identified("hbvib_model_add_contact", law)

    def set_preload(self, contact: int, preload: float) -> None:
        """Changes the normal load of a contact."""
        self._call("hbvib_model_set_preload", contact, preload)

    def add_jenkins(self, a: ArrayLike, b: ArrayLike, kt: ArrayLike, mu: ArrayLike, preload: ArrayLike,
                    sector_offset: ArrayLike = 0) -> range:
        """Adds many Jenkins contacts from arrays of one length, or numbers for all; returns their numbers."""
        a, b, kt, mu, preload, offset = _columns(
            a=(a, np.int64), b=(b, np.int64), kt=(kt, float), mu=(mu, float), preload=(preload, float),
            sector_offset=(sector_offset, np.int64))
        first = self._identified("hbvib_model_add_jenkins", len(a), a, b, offset, kt, mu, preload)
        return range(first, first + len(a))

    def add_springs(self, a: ArrayLike, b: ArrayLike, stiffness: ArrayLike, sector_offset: ArrayLike = 0) -> None:
        """Adds linear springs from arrays of one length, or numbers for all."""
        a, b, stiffness, offset = _columns(a=(a, np.int64), b=(b, np.int64), stiffness=(stiffness, float),
                                           sector_offset=(sector_offset, np.int64))
        self._call("hbvib_model_add_springs", len(a), a, b, offset, stiffness)

    def add_iwan(self, a: int, b: int = GROUND, *, slip_force: float, stiffness: float, chi: float, beta: float,
                 elements: int = 100, sector_offset: int = 0) -> range:
        """Adds an Iwan joint as that many Jenkins contacts; returns their numbers."""
        first = self._identified("hbvib_model_add_iwan", a, b, sector_offset,
                                 slip_force, stiffness, chi, beta, elements)
        return range(first, first + elements)

    def add_table(self, a: int, b: int = GROUND, *, displacement: ArrayLike, force: ArrayLike,
                  sector_offset: int = 0) -> int:
        """Adds a spring whose force is a table: straight between its points, displacement ascending."""
        y = _array("displacement", displacement, shape=[None])
        f = _array("force", force, shape=[len(y)])
        return self._identified("hbvib_model_add_table", a, b, sector_offset, len(y), y, f)

    def add_spring_damper(self, a: int, b: int = GROUND, *, spring: ArrayLike = (), damper: ArrayLike = (),
                          sector_offset: int = 0) -> int:
        """Adds f = sum spring[k] y^(k+1) + sum damper[k] v^(k+1), y the motion of a over b and v = y'."""
        spring, damper = _array("spring", spring, shape=[None]), _array("damper", damper, shape=[None])
        return self._identified("hbvib_model_add_spring_damper", a, b, sector_offset, len(spring), spring, len(damper),
                                damper)

    def add_polynomial(self, dofs: ArrayLike, direction: ArrayLike, coefficient: ArrayLike,
                       x_powers: Optional[ArrayLike] = None, v_powers: Optional[ArrayLike] = None) -> int:
        """Adds terms coefficient[t] prod x_j^x_powers[t, j] prod v_j^v_powers[t, j] to the force on
        dofs[direction[t]]; powers are terms x dofs, None: all 0."""
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
        """Adds f_i = sum quadratic[i, j, k] x_j x_k + sum cubic[i, j, k, l] x_j x_k x_l on dofs[i]."""
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
        kt, kn, mu, preload ...   constants of the kind per unit of area, sector_offset, as in add_contact."""
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
        where it cannot at this motion: shorter steps are tried. What it raises ends the solve and comes out of it.
        The model, its copies and all branches keep it alive, because results call it again."""
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

        amplitude   about the largest motion of each degree of freedom of the force, n numbers."""
        amplitude = _array("amplitude", np.atleast_1d(amplitude), shape=[None])
        gap = _new("hbvib_jacobian_gap")
        self._call("hbvib_check_jacobian", contact, omega, amplitude, len(amplitude), gap)
        return JacobianGap.of(gap)

    def linear_modes(self, count: int, diameter: int = 0, contacts: Any = ContactState.STUCK) -> Modes:
        """Undamped natural modes: omega (count), ascending, and shapes (count, ndof), complex, phi^H M phi = 1.

        diameter   nodal diameter of the wave, 0 .. sectors / 2.    contacts   "stuck" or "free"."""
        omega, shapes = np.empty(count), np.empty((count, self.ndof), complex)
        self._call("hbvib_linear_modes", diameter, _member(ContactState, contacts), count, omega, shapes)
        return Modes(omega, shapes)

    def _solve(self, name: str, solver: dict, options: Any, hooks: tuple) -> Branch:
        if "harmonics" in solver:
            solver.setdefault("tolerance", 0.0)  # so many and no other, unless a tolerance is named as well
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

    def forced_response(self, omega: Any, *, at: Optional[ArrayLike] = None, guess: Optional[ArrayLike] = None,
                        progress: Optional[Callable[[Progress], Any]] = None,
                        log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                        cancel: Optional[CancelFlag] = None, **solver: Any) -> Branch:
        """Follows the periodic response over a range of frequency.

        omega     (start, stop) in rad per time unit, downward where stop is the lower; or one frequency.
        at        frequencies within the range at which every solution is wanted: Branch.at.
        guess     start values, (H + 1, ndof) complex, such as Branch.harmonics gives.
        progress  progress(Progress) after each point: False, or raising StopIteration, stops and keeps the points.
        log       log(LogLevel, text), lines up to log_level.
        cancel    a CancelFlag.
        Others are the solver options of hbvib.h: tolerance, or harmonics for exactly so many, samples, response_dof, step, step_min, step_max,
        tol_residual, max_newton, max_points, keep_even_harmonics, estimate_error, num_threads, max_harmonics."""
        start, stop = (omega, omega) if np.ndim(omega) == 0 else omega
        options = _new("hbvib_forced_options", omega_start=start, omega_stop=stop, **_counted_array("at", at),
                       **_counted_array("guess", guess, np.complex128, [None, self.ndof]))
        return self._solve("hbvib_forced_response", solver, options, (progress, log, log_level, cancel))

    def nonlinear_mode(self, log10_amplitude: Sequence[float], *, at: Optional[ArrayLike] = None,
                       shape: Optional[ArrayLike] = None, damping_form: Any = DampingForm.MASS, diameter: int = -1,
                       mode_index: int = 0, near_omega: float = 0, amplitude_contact: int = -1, reference_dof: int = -1,
                       progress: Optional[Callable[[Progress], Any]] = None,
                       log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                       cancel: Optional[CancelFlag] = None, **solver: Any) -> Branch:
        """Follows a nonlinear mode over a range of amplitude: frequency and damping ratio against it.

        log10_amplitude   (start, stop), rising: of sqrt(X_1^H M X_1), or with amplitude_contact of |Y_1| of a contact.
        at                log10 of amplitudes at which every solution is wanted.
        mode_index, near_omega, shape   the linear mode to start from: by number, frequency or likeness (ndof complex).
        damping_form      "mass" or "stiffness".     diameter, reference_dof   -1: chosen by the library.
        The rest as in forced_response."""
        start, stop = log10_amplitude
        options = _new("hbvib_mode_options", log10_start=start, log10_stop=stop, diameter=diameter,
                       damping_form=_member(DampingForm, damping_form), mode_index=mode_index, near_omega=near_omega,
                       amplitude_contact=amplitude_contact, reference_dof=reference_dof, **_counted_array("at", at),
                       **_counted_array("shape", shape, np.complex128, [self.ndof]))
        return self._solve("hbvib_nonlinear_mode", solver, options, (progress, log, log_level, cancel))

    def time_response(self, omega: float, *, harmonics: int = 9, samples: int = 0, method: Any = SteadyMethod.SHOOTING,
                      start: Optional[ArrayLike] = None, progress: Optional[Callable[[Progress], Any]] = None,
                      log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
                      cancel: Optional[CancelFlag] = None, **options: Any) -> TimeResponse:
        """The periodic response at one frequency by integration in time: a check of any point of a branch.

        start      (H + 1, ndof) complex motion to start from, such as Branch.harmonics gives; None: rest.
        method     "shooting" or "marching".    tolerance, max_periods   see hbvib.h.
        progress   after each period; the rest as in forced_response.
        Returns harmonics (harmonics + 1, ndof) complex, samples (samples, ndof) at equidistant times, info, and status:
        STOPPED_BY_CALLER where the results are those of the last period, not steady."""
        settings = _options(
            "time_response", "hbvib_time_options", options, "start start_len", omega=omega, harmonics=harmonics,
            samples=samples, method=_member(SteadyMethod, method),
            **_counted_array("start", start, np.complex128, [None, self.ndof]))
        shapes = (max(settings.harmonics, -1) + 1, self.ndof), (max(settings.samples, 0), self.ndof)
        x, times, info = np.empty(shapes[0], complex), np.empty(shapes[1]), _new("hbvib_time_info")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel)
            status = _call("hbvib_time_response", self.handle, settings, hooks, x, x.size,
                           times if times.size else None, times.size, info, guard=guard)
        return TimeResponse(x, times, TimeInfo.of(info), Status(status))

    def verify(self, branch: Branch, point: int, *, method: Any = SteadyMethod.SHOOTING,
               progress: Optional[Callable[[Progress], Any]] = None,
               log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: Any = LogLevel.INFO,
               cancel: Optional[CancelFlag] = None, **options: Any) -> Verification:
        """How far a point of a forced response of this model is from the motion that integration in time finds from it.

        method     "shooting" or "marching".    tolerance, max_periods, same_within   see hbvib.h.
        progress   after each period; the rest as in forced_response.
        Returns harmonics (H + 1, ndof) complex in time, errors (H + 1), info, whose response_error is that of the
        response and whose same_solution is False where the integration ended far from the point, and status:
        STOPPED_BY_CALLER where all of it compares with the last period, not steady."""
        settings = _options("verify", "hbvib_verify_options", options, method=_member(SteadyMethod, method))
        rows = branch.reduction.harmonics_asked + 1
        x, errors, info = np.empty((rows, self.ndof), complex), np.empty(rows), _new("hbvib_verification")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel)
            status = _call("hbvib_verify", self.handle, branch.handle, point, settings, hooks, x, x.size, errors,
                           errors.size, info, guard=guard)
        return Verification(x, errors, VerificationInfo.of(info), Status(status))

    def forced_residual(self, omega: float, x: ArrayLike, *, jacobian: bool = False, d_omega: bool = False,
                        samples: int = 0) -> Residual:
        """Residual of harmonic balance at x, (H + 1, ndof) complex: an array like x; with jacobian the real matrix
        d R / d X over the pairs (re, im), of order 2 x.size; with d_omega an array like x; else None."""
        x = _array("x", x, np.complex128, [None, self.ndof])
        solver = _new("hbvib_solver_options", harmonics=len(x) - 1, samples=samples)
        residual = np.empty_like(x)
        matrix = np.empty((2 * x.size,) * 2, order="F") if jacobian else None
        slope = np.empty_like(x) if d_omega else None
        self._call("hbvib_forced_residual", solver, omega, x, x.size, residual, x.size, matrix,
                   matrix.size if jacobian else 0, slope, x.size if d_omega else 0)
        return Residual(residual, matrix, slope)


forced_response = Model.forced_response
nonlinear_mode = Model.nonlinear_mode
time_response = Model.time_response
verify = Model.verify


def evaluate_contact(kind: Any, motion: ArrayLike, *, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     **constants: Any) -> ContactForce:
    """Force of one contact law on prescribed harmonics of its motions, (H + 1) or (d, H + 1) complex: an array like
    it, and with jacobian the real d F / d Y over the pairs (re, im), of order 2 d (H + 1), else None."""
    law = _law("evaluate_contact", kind, constants)
    motion = _array("motion", motion, np.complex128, [None] * (2 if np.ndim(motion) == 2 else 1))
    force = np.empty_like(motion)
    matrix = np.empty((2 * motion.size,) * 2, order="F") if jacobian else None
    _call("hbvib_contact_evaluate", law, motion.shape[-1] - 1, samples, omega, motion, motion.size, force, force.size,
          matrix, matrix.size if jacobian else 0)
    return ContactForce(force, matrix)


# ------------------------------------------------------------------------------------------ branch


class _Lease:
    """What a borrowed array leans on (its `base`): keeps the branch, and its memory with it."""

    __slots__ = ("branch", "__array_interface__", "__weakref__")

    def __init__(self, branch: Branch) -> None:
        self.branch = branch


def _field_property(field: Any, text: str) -> property:
    return property(lambda self: self.field(field), doc=text)


class Branch(_Owner):
    """Solutions along a curve, from a forced response or a nonlinear mode; made by the solves.

    Fields (`omega`, `amplitude`, ...) are read-only arrays over the points of the curve without a copy: each keeps the
    branch's memory, and `free` is refused with BufferError while one lives. All else is copied out. Points are numbers
    0 .. len(branch) - 1 on the curve; `peaks`, `folds` and `at` tell the numbers of the points beside it.

    message   the library's sentence where the solve stopped early, else empty."""

    def __init__(self, handle: int, kept: tuple, message: str) -> None:
        self._handle, self._kept, self.message = handle, kept, message
        self._leases: Any = weakref.WeakSet()

    def __repr__(self) -> str:
        return "<hbvib.Branch, freed>" if self._handle is None else f"<hbvib.Branch: {len(self)} points>"

    def __del__(self, free: Any = lib.hbvib_branch_free) -> None:
        if self._handle is not None:
            free(self._handle)

    def free(self) -> None:
        """Frees the branch. BufferError while arrays look into its memory, BusyError while a call uses it, FreedError
        if it was freed."""
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
        """Number of all stored points: the curve, then peaks, folds and the solutions wanted."""
        return _call("hbvib_branch_stored", self.handle)

    @property
    def status(self) -> Status:
        """Status of the solve: OK, or why it stopped early."""
        return Status(_call("hbvib_branch_status", self.handle))

    @property
    def complete(self) -> bool:
        """Whether the whole range was covered."""
        return self.status == Status.OK

    def field(self, field: Any) -> np.ndarray:
        """A field, by Field or name, in the library's memory: (points), slip_fraction (points, contacts)."""
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
        lease.__array_interface__ = dict(
            version=3, typestr=dtype.str, shape=shape, data=(view.data, True),
            strides=tuple(dtype.itemsize * distance for distance in view.stride[:view.rank]))
        return np.asarray(lease)

    omega = _field_property(Field.OMEGA, "Angular frequency.")
    amplitude = _field_property(Field.AMPLITUDE, "Peak amplitude of the fundamental of the response dof.")
    residual = _field_property(Field.RESIDUAL, "Relative residual.")
    newton_iterations = _field_property(Field.NEWTON_ITERATIONS, "Newton iterations, as float64.")
    harmonics_used = _field_property(Field.HARMONICS_USED, "Highest harmonic number carried, as float64.")
    slip_fraction = _field_property(Field.SLIP_FRACTION, "Share of the period that each contact slips.")
    sampling_error = _field_property(Field.SAMPLING_ERROR, "Relative change of forces with half the samples.")
    error_estimate = _field_property(Field.ERROR_ESTIMATE, "Relative error of the response (modes: of the frequency) by"
                                     " harmonics left out; NaN where unknown, or with a fixed number unless estimate_error.")
    damping_error_estimate = _field_property(Field.DAMPING_ERROR_ESTIMATE, "Modes: error of D, as error_estimate.")
    damping_ratio = _field_property(Field.DAMPING_RATIO, "Modes: damping ratio D.")
    mode_energy = _field_property(Field.ENERGY, "Modes: twice the mean kinetic energy of a sector.")
    dissipation = _field_property(Field.DISSIPATION, "Modes: work of friction per cycle and sector.")
    structural_loss = _field_property(Field.STRUCTURAL_LOSS, "Modes: work of the structure's damping per cycle.")
    log10_amplitude = _field_property(Field.LOG10_AMPLITUDE, "Modes: log10 of the amplitude, the parameter.")
    modal_amplitude = _field_property(Field.MODAL_AMPLITUDE, "Modes: sqrt(X_1^H M X_1).")
    modal_assurance = _field_property(Field.MODAL_ASSURANCE, "Modes: likeness to the point before, 0 to 1.")

    def _filled(self, record: Any, *arguments: Any, name: str) -> Any:
        """The record that a function of the branch fills."""
        struct = _new("hbvib_" + name.replace("branch_", ""))
        self._call("hbvib_branch_" + name.replace("branch_", ""), *arguments, struct)
        return record.of(struct)

    @property
    def reduction(self) -> Reduction:
        """What was removed from the problem before it was solved."""
        return self._filled(Reduction, name="reduction")

    @property
    def mode_info(self) -> ModeInfo:
        """Where a nonlinear mode started. UnsupportedError for a forced response."""
        return self._filled(ModeInfo, name="mode_info")

    def mode_point(self, point: int) -> ModePoint:
        """Numbers of a point of a nonlinear mode."""
        return self._filled(ModePoint, point, name="mode_point")

    def energy(self, point: int) -> Energy:
        """Energies and losses of a point."""
        return self._filled(Energy, point, name="energy")

    def summary(self, point: int, contact: int) -> ContactSummary:
        """Work, shares of the period, ranges and loads of a contact at a point."""
        return self._filled(ContactSummary, point, contact, name="contact_summary")

    def harmonics(self, point: int, first_dof: int = 0, n_dof: Optional[int] = None) -> np.ndarray:
        """Harmonics 0 .. H at a point, (H + 1, n_dof) complex, a copy; n_dof None: all from first_dof on."""
        reduction = self.reduction
        if n_dof is None:
            n_dof = max(reduction.degrees_of_freedom - _whole(first_dof), 1)
        x = np.empty((reduction.harmonics_asked + 1, n_dof), complex)
        self._call("hbvib_branch_harmonics", point, first_dof, n_dof, x, x.size)
        return x

    def slip(self, point: int) -> np.ndarray:
        """Shares of the period that each contact slips at any stored point, (contacts)."""
        shares = np.empty(self.reduction.contacts)
        self._call("hbvib_branch_slip_fraction", point, shares, shares.size)
        return shares

    def time_history(self, point: int, dof: int, n: int = 256) -> np.ndarray:
        """Motion of a degree of freedom over one period at a point, n equidistant times."""
        x = np.empty(n)
        self._call("hbvib_branch_time_history", point, dof, n, x)
        return x

    def loop(self, point: int, contact: int, direction: int = 0, n: int = 256) -> Loop:
        """Hysteresis loop of a contact over one period at a point: motion, force and state (State), n each."""
        motion, force, state = np.empty(n), np.empty(n), np.empty(n, np.int32)
        self._call("hbvib_branch_contact_loop", point, contact, direction, n, motion, force, state)
        return Loop(motion, force, state)

    def _listed(self, name: str, arguments: tuple, dtypes: Sequence) -> list:
        """Arrays as long as the library says: asked for the count first, then for the numbers."""
        count = ctypes.c_int64()
        self._call(name, *arguments, 0, *[None] * len(dtypes), count)
        arrays = [np.empty(count.value, dtype) for dtype in dtypes]
        self._call(name, *arguments, count.value, *arrays, count)
        return arrays

    def peaks(self) -> Points:
        """Maxima of the amplitude, in a nonlinear mode of the damping ratio: omega, amplitude, point number."""
        return Points(*self._listed("hbvib_branch_peaks", (), [float, float, np.int64]))

    def folds(self) -> Points:
        """Turning points in frequency, in a nonlinear mode in amplitude: omega, amplitude, point number."""
        return Points(*self._listed("hbvib_branch_folds", (), [float, float, np.int64]))

    def at(self, wanted: int) -> Wanted:
        """Every solution at one entry of the solve's `at`: amplitude, point number."""
        return Wanted(*self._listed("hbvib_branch_at", (wanted,), [float, np.int64]))

    def synthesis(self, model: Model, **options: Any) -> Synthesis:
        """The response to the forces of a model, from this nonlinear mode: omega, response (complex fundamental of
        the response degree of freedom), modal_amplitude. Options: force_factor, damping_ratio, model_damping."""
        return Synthesis(*self._synthesis("synthesis", model, options, [float, complex, float]))

    def synthesis_peaks(self, model: Model, **options: Any) -> SynthesisPeaks:
        """The resonances of a synthesised response; `flags` are sums of SynthesisFlag, other_mode the distance of the
        nearest other mode over the half-power bandwidth. Options as for synthesis."""
        return SynthesisPeaks(*self._synthesis("synthesis_peaks", model, options, [float] * 5 + [np.int32]))

    def _synthesis(self, name: str, model: Model, options: dict, dtypes: Sequence) -> list:
        settings = _options(name, "hbvib_synthesis_options", options)
        return self._listed("hbvib_branch_" + name, (model.handle, settings), dtypes)
