"""Branches as tables of pandas and xarray, which are imported on first use."""
from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

import numpy as np

from ._c import Field
from ._errors import ArgumentError

if TYPE_CHECKING:
    from ._branch import Branch


def fields(branch: Branch) -> dict[str, np.ndarray]:
    """The fields that a branch has, by name, copied: (points), slip_fraction (points, contacts) and d_amplitude_by_place
    (points, contacts, 2)."""
    found = {}
    for field in Field:
        with contextlib.suppress(ArgumentError):
            found[field.name.lower()] = branch.field(field).copy()
    return found


def attributes(branch: Branch) -> dict[str, str]:
    """Attributes of the whole branch."""
    return dict(status=branch.status.name, message=branch.message)


def dataframe(branch: Branch) -> Any:
    """See Branch.to_dataframe."""
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
    table.attrs.update(attributes(branch))
    return table


def dataset(branch: Branch) -> Any:
    """See Branch.to_xarray."""
    try:
        import xarray  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("to_xarray needs xarray: pip install xarray") from None
    found = fields(branch)
    coordinate = "log10_amplitude" if branch.is_mode else "omega"
    dims = {1: ("point",), 2: ("point", "contact"), 3: ("point", "contact", "direction")}
    variables = {name: (dims[values.ndim], values) for name, values in found.items() if name != coordinate}
    if watched := branch.responses:
        variables["response"] = (("watched", "point"), np.array([found.amplitude for found in watched]))
        variables["response_error"] = (("watched", "point"), np.array([found.error for found in watched]))
    return xarray.Dataset(variables, coords={coordinate: ("point", found[coordinate])}, attrs=attributes(branch))
