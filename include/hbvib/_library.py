"""The shared library: where it is found, its structs and functions as ctypes types."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import sys
from typing import TYPE_CHECKING, Any, Iterator, cast

from ._c import _CALLBACKS, _FUNCTIONS, _STRUCTS, _VERSION

if TYPE_CHECKING:
    from ._c import _Library


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
    return type(name, (ctypes.Structure,), {"_fields_": fields, "__module__": "hbvib"})


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
