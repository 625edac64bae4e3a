"""Structs of the library: options from keyword arguments, matrices without a copy, results as named tuples."""
from __future__ import annotations

import ctypes
import inspect
from typing import Any, Callable, Mapping, TypeVar

import numpy as np

from ._c import FlexibilityWay, ModeMultiple, Part, Storage, Tangent
from ._convert import _array, _member, _numbers, _pointer, _real, _whole
from ._library import lib, structs
from ._types import (BestLoad, ContactSummary, Descent, Energy, JacobianGap, Kick, ModeInfo, ModePoint, Reduction, Searched, TimeInfo,
                     VerificationInfo)


def _new(name: str, **values: Any) -> Any:
    """A struct filled by its _init function, then with `values`; it keeps the arrays that it points to."""
    struct = structs[name]()
    getattr(lib, name + "_init")(struct, ctypes.sizeof(struct))
    kinds = dict(struct._fields_)
    for key, value in values.items():
        kind = kinds[key]
        if hasattr(kind, "_length_"):
            number: Any = np.int64 if kind._type_ is ctypes.c_int64 else np.float64
            value = kind(*_array(key, value, number, [kind._length_]).tolist())
        elif kind is ctypes.c_void_p and value is not None:
            struct.__dict__.setdefault("arrays", []).append(value)
            value = _pointer(value)
        elif kind is ctypes.c_double:
            value = _real(value)
        elif kind in (ctypes.c_int32, ctypes.c_int64):
            value = _whole(value, 8 * ctypes.sizeof(kind), key)
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
            listed = options.__doc__.partition("\n\n")[2].partition("\n\n")[0].strip("\n").replace("\n", "\n    ")
            function.__doc__ = function.__doc__.replace("{options}", listed.strip())
        return function

    return decorated


def _matrix(value: Any, part: Any, name: str = "matrix") -> Any:
    """Description of a matrix: dense without a copy where its strides allow, sparse of any scipy format."""
    part = _member(Part, part)
    if hasattr(value, "tocsc"):
        sparse = value.tocsc()
        numbers = _numbers(name, sparse.data, np.complex128)
        number: Any = np.complex128 if numbers.dtype.kind == "c" else np.float64
        rows, cols = sparse.shape
        starts = _array("indptr", sparse.indptr, np.int64, [cols + 1])
        places = _array("indices", sparse.indices, np.int64, [None])
        if starts[-1] > min(len(places), len(numbers)):  # all that the library cannot check itself
            raise ValueError(
                f"{name}: indptr ends at {starts[-1]}, beyond {len(places)} indices and {len(numbers)} numbers")
        return _new("hbvib_matrix", storage=Storage.CSC, scalar=int(number is np.complex128), part=part, rows=rows,
                    cols=cols, values=_array(name, numbers, number), col_ptr=starts, row_idx=places)
    dense = _numbers(name, value, np.complex128)
    if dense.ndim == 0:
        dense = dense.reshape(1, 1)
    if dense.ndim != 2:
        raise ValueError(f"{name} has shape {dense.shape}, needs two dimensions")
    kind: Any = np.complex128 if dense.dtype.kind == "c" else np.float64
    dtype = np.dtype(kind)
    if not np.can_cast(dense.dtype, dtype, "safe"):
        raise TypeError(f"{name} holds {dense.dtype}, which is not {dtype} without loss")
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
    Reduction: ("hbvib_reduction", dict(mean_carried=bool, even_removed=bool, flexibility_way=FlexibilityWay)),
    JacobianGap: ("hbvib_jacobian_gap", dict(tangent=Tangent)),
    Descent: ("hbvib_descent", {}),
    Searched: ("hbvib_searched", {}),
    Kick: ("hbvib_kick", dict(verified=bool)),
    BestLoad: ("hbvib_best_load", {}),
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
