"""Branches as tables of pandas and xarray, and back; both are imported on first use.

A table has the fields of the curve as columns. What a table has no column for (status, special points, energies) goes along in its
attribute "hbvib", as JSON with the check sum of the fields: a table that was changed since is not taken for the branch that it was.
"""
from __future__ import annotations

import contextlib
import json
import zlib
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from ._c import Field, Status
from ._errors import ArgumentError, UnsupportedError
from ._library import __version__
from ._units import of_field

if TYPE_CHECKING:
    from ._branch import Branch
    from ._storage import SavedBranch

ATTRIBUTE = "hbvib"
FORMAT = 2
# Arrays of a file that xarray holds as variables of their own, where harmonics are asked for.
LARGE = ("harmonics", "model")


def fields(branch: Branch) -> dict[str, np.ndarray]:
    """The fields that a branch has, by name, copied: (points), slip_fraction (points, contacts) and d_amplitude_by_place
    (points, contacts, 2)."""
    found = {}
    for field in Field:
        with contextlib.suppress(ArgumentError):
            found[field.name.lower()] = branch.field(field).copy()
    return found


def attributes(branch: Branch, stored: dict[str, np.ndarray]) -> dict[str, str]:
    """Attributes of the whole branch, from the contents of its file."""
    rest = {name: [values.dtype.str, list(values.shape), _listed(values)] for name, values in stored.items()
            if not name.startswith("field/") and name not in (*LARGE, "about")}
    text = json.dumps(dict(sum=_sum(stored), about=json.loads(str(stored["about"])), arrays=rest))
    return {"status": branch.status.name, "message": branch.message, ATTRIBUTE: text}


def _listed(values: np.ndarray) -> list[Any]:
    """The entries, of complex numbers the parts, in one row."""
    row = np.ascontiguousarray(values).ravel()
    listed: list[Any] = (row.view(float) if row.dtype.kind == "c" else row).tolist()
    return listed


def _array(dtype: str, shape: list[int], values: list[Any]) -> np.ndarray:
    """The array of which `_listed` made the entries."""
    kind = np.dtype(dtype)
    return np.array(values, float if kind.kind == "c" else kind).view(kind).reshape(shape)


def _sum(stored: dict[str, np.ndarray]) -> int:
    """Check sum of the fields."""
    total = 0
    for name in sorted(name for name in stored if name.startswith("field/")):
        values = np.ascontiguousarray(stored[name], float)
        total = zlib.crc32(values.tobytes(), zlib.crc32(f"{name}{values.shape}".encode(), total))
    return total


def dataframe(branch: Branch) -> Any:
    """See Branch.to_dataframe."""
    from ._storage import contents
    try:
        import pandas  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("to_dataframe needs pandas: pip install pandas") from None
    columns: dict[str, np.ndarray] = {}
    for name, values in fields(branch).items():
        if values.ndim == 1:
            columns[name] = values
        elif values.ndim == 2:
            columns.update({f"{name}_{k}": values[:, k] for k in range(values.shape[1])})
        else:
            columns.update({f"{name}_{k}_t{d + 1}": values[:, k, d] for k in range(values.shape[1]) for d in range(2)})
    columns.update({f"response_{r}": found.amplitude for r, found in enumerate(branch.responses)})
    table = pandas.DataFrame(columns)
    table.index.name = "point"
    table.attrs.update(attributes(branch, contents(branch, False)))
    return table


def dataset(branch: Branch, harmonics: bool) -> Any:
    """See Branch.to_xarray."""
    from ._storage import contents
    try:
        import xarray  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("to_xarray needs xarray: pip install xarray") from None
    found = fields(branch)
    coordinate = "log10_amplitude" if branch.is_mode else "omega"
    dims = {1: ("point",), 2: ("point", "contact"), 3: ("point", "contact", "direction")}
    variables: dict[str, Any] = {name: (dims[values.ndim], values) for name, values in found.items() if name != coordinate}
    coords: dict[str, Any] = {coordinate: ("point", found[coordinate])}
    if watched := branch.responses:
        variables["response"] = (("watched", "point"), np.array([found.amplitude for found in watched]))
        variables["response_error"] = (("watched", "point"), np.array([found.error for found in watched]))
    stored = contents(branch, harmonics)
    if harmonics:
        if "harmonics" not in stored:
            raise UnsupportedError("this branch has no harmonics: it comes from a table or a file without", Status.E_UNSUPPORTED)
        x = stored["harmonics"]
        variables["harmonics"] = (("stored", "harmonic", "dof", "part"), np.stack([x.real, x.imag], -1))
        coords["part"] = ("part", ["re", "im"])
        if "model" in stored:
            variables["model"] = (("byte",), stored["model"].view(np.int8))  # NetCDF 3 has no others
    made = xarray.Dataset(variables, coords=coords, attrs=attributes(branch, stored))
    for name in found:
        if unit := of_field(name, branch.units):
            made[name].attrs["units"] = unit
    return made


def from_dataframe(table: Any) -> SavedBranch:
    """The branch of a table that `Branch.to_dataframe` made: as `hbvib.load` gives it of a file without harmonics. Of a table that was
    changed since, or came through a format without attributes such as CSV, the branch has fields alone: peaks, energies and other
    things beside the curve are refused with UnsupportedError.

    ValueError for a table without the columns omega and amplitude.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> table = model.forced_response((0.8, 1.6)).to_dataframe()
    >>> hbvib.from_dataframe(table)
    <hbvib.SavedBranch: 45 points, omega 0.8 to 1.6, peak 0.583649 at omega = 1.23202, OK>
    >>> hbvib.from_dataframe(table[table.omega > 1.2])
    <hbvib.SavedBranch: 15 points, omega 1.21443 to 1.6, OK>
    """
    known = {field.name.lower() for field in Field}
    columns = {str(name): np.asarray(table[name]) for name in table.columns}
    found: dict[str, Any] = {name: values for name, values in columns.items() if name in known}
    for name in known - found.keys():
        per_contact, contact = [], 0
        while (one := _of_contact(columns, f"{name}_{contact}")) is not None:
            per_contact.append(one)
            contact += 1
        if per_contact:
            found[name] = np.stack(per_contact, 1)
    return _branch("table", found, dict(table.attrs), {})


def _of_contact(columns: dict[str, np.ndarray], name: str) -> Optional[np.ndarray]:
    """The column of one contact, or both of a field with two directions."""
    if name in columns:
        return columns[name]
    both = [f"{name}_t1", f"{name}_t2"]
    return np.stack([columns[one] for one in both], 1) if all(one in columns for one in both) else None


def from_xarray(dataset: Any) -> SavedBranch:
    """The branch of a dataset that `Branch.to_xarray` made, also after a way through NetCDF or Zarr: as `hbvib.load` gives it, with
    harmonics and model where to_xarray(harmonics=True) put them in. Of a dataset that was changed since, or has no attribute "hbvib",
    the branch has fields alone, see `from_dataframe`.

    ValueError for a dataset without omega and amplitude.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> back = hbvib.from_xarray(branch.to_xarray(harmonics=True))
    >>> peak = back.peaks().point[0]
    >>> bool((back.harmonics(peak) == branch.harmonics(peak)).all())
    True
    """
    found = {field.name.lower(): np.asarray(dataset[field.name.lower()]) for field in Field if field.name.lower() in dataset}
    large: dict[str, np.ndarray] = {}
    if "harmonics" in dataset and dataset["harmonics"].dims[-1] == "part":
        parts = np.ascontiguousarray(dataset["harmonics"], float)
        large["harmonics"] = parts.view(complex)[..., 0]
        if "model" in dataset:
            large["model"] = np.asarray(dataset["model"]).astype(np.int8).view(np.uint8)
    return _branch("dataset", found, dict(dataset.attrs), large)


def _branch(kind: str, found: dict[str, Any], attrs: dict[str, Any], large: dict[str, np.ndarray]) -> SavedBranch:
    """A branch from fields, the attributes of a table, and harmonics."""
    from ._storage import SavedBranch
    for name in ("omega", "amplitude"):
        if name not in found:
            raise ValueError(f"this {kind} has no {name}, needs the names of Branch.to_dataframe and to_xarray: {sorted(found)} were found")
    stored = {"field/" + name: np.array(values, float) for name, values in found.items()}
    with contextlib.suppress(KeyError, TypeError, ValueError):
        along = json.loads(attrs[ATTRIBUTE])
        if along["about"]["format"] == FORMAT and along["sum"] == _sum(stored):
            arrays = {name: _array(*given) for name, given in along["arrays"].items()}
            return SavedBranch({**stored, **arrays, **large, "about": np.array(json.dumps(along["about"]))})
    points = len(stored["field/omega"])
    name = attrs.get("status", "OK")
    status = Status[name] if name in Status.__members__ else Status.OK
    about = dict(format=FORMAT, version=__version__, status=int(status), message=str(attrs.get("message", "")), points=points,
                 stored=points, is_mode="damping_ratio" in found, at=0, no_model=f"it comes from a {kind}")
    return SavedBranch({**stored, "about": np.array(json.dumps(about)), "at_values": np.empty(0)})
