"""Python's numbers, sequences and arrays as the numbers and packed arrays of C."""
from __future__ import annotations

import ctypes
import operator
from typing import Any, Optional, Sequence

import numpy as np

from ._c import DIAMETER_OF_ENGINE_ORDER
from ._library import _ARGUMENTS


def _whole(value: Any, bits: int = 64, name: str = "") -> int:
    """A whole number that fits, which ctypes does not check. TypeError and OverflowError tell its name, where it has one."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name or 'an index or a count'} = {value!r}, needs a whole number") from None
    if not -(1 << bits - 1) <= number < 1 << bits - 1:
        raise OverflowError(f"{name}{' = ' * bool(name)}{number} does not fit into {bits} bits")
    return number


def _diameter(value: Optional[int]) -> int:
    """A nodal diameter, that of the engine order for None."""
    return DIAMETER_OF_ENGINE_ORDER if value is None else _whole(value, name="diameter")


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
    # Tensors of other packages that know this protocol alone; without a copy.
    if hasattr(value, "__dlpack__") and not hasattr(value, "__array__") and hasattr(np, "from_dlpack"):
        value = np.from_dlpack(value)
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
