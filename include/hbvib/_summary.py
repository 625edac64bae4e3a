"""Models and branches in one line, and as a table in a notebook."""
from __future__ import annotations

import html
from typing import Any

import numpy as np

from ._branch import Branch
from ._c import Status
from ._errors import UnsupportedError
from ._model import Model
from ._units import after


def counted(number: int, one: str) -> str:
    """1 point, 2 points, 1 degree of freedom, 2 degrees of freedom."""
    first, _, rest = one.partition(" ")
    return f"{number} {first}{'s' * (number != 1)}{' ' * bool(rest)}{rest}"


def model_rows(model: Model) -> list[tuple[str, str]]:
    """The numbers of a model."""
    rows = [("degrees of freedom", str(model.ndof))]
    if model.sectors > 1:
        rows += [("sectors", str(model.sectors)), ("engine order", str(model.engine_order))]
    rows += [("contacts", str(model.contacts)), ("forces", str(len(model.forces.dof)))]
    names = [f"{kind} {name}" for kind, name in model.units._asdict().items() if name]
    return rows + [("units", ", ".join(names))] * bool(names)


def line(shown: Any) -> str:
    """A model or a branch in one line."""
    name = "hbvib." + type(shown).__name__
    if shown.is_freed:
        return f"<{name}, freed>"
    parts = model_parts(shown) if isinstance(shown, Model) else branch_parts(shown)
    return f"<{name}: {', '.join(parts)}>"


def table(shown: Any) -> str:
    """A model or a branch as HTML."""
    rows = [("freed", "")]
    if not shown.is_freed:
        rows = model_rows(shown) if isinstance(shown, Model) else branch_rows(shown)
    lines = "".join(f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>"
                    f"{html.escape(value)}</td></tr>" for name, value in rows)
    return f"<table><caption>hbvib.{type(shown).__name__}</caption>{lines}</table>"


def model_parts(model: Model) -> list[str]:
    """The numbers of a model, in words."""
    parts = [counted(model.ndof, "degree of freedom")]
    if model.sectors > 1:
        parts += [counted(model.sectors, "sector"), f"engine order {model.engine_order}"]
    parts.append(counted(model.contacts, "contact"))
    names = [name for name in model.units if name]
    return parts + ["units " + " ".join(names)] * bool(names)


def branch_rows(branch: Branch) -> list[tuple[str, str]]:
    """Status, range and peak of a branch."""
    status = branch.status.name if branch.status == Status.OK else f"{branch.status.name}: {branch.message}"
    rows = [("points", str(len(branch))), ("status", status)]
    if len(branch) == 0:
        return rows
    parameter, name = branch.omega, "omega"
    if branch.is_mode:
        parameter, name = branch.log10_amplitude, "log10_amplitude"
    units = branch.units
    rows.append((name, after(f"{parameter[0]:.6g} to {parameter[-1]:.6g}", "" if branch.is_mode else units.speed)))
    try:
        peaks = branch.peaks()
    except UnsupportedError:  # a table with fields alone
        return rows
    if len(peaks.point) and branch.is_mode:
        ratios = [branch.mode_point(int(point)).damping_ratio for point in peaks.point]
        best = int(np.argmax(ratios))
        rows.append(("largest damping ratio", f"{ratios[best]:.4g} at omega = {after(f'{peaks.omega[best]:.6g}', units.speed)}"))
    elif len(peaks.point):
        best = int(np.argmax(peaks.amplitude))
        height = after(f"{peaks.amplitude[best]:.6g}", units.length)
        rows.append(("peak", f"{height} at omega = {after(f'{peaks.omega[best]:.6g}', units.speed)}"))
    return rows


def branch_parts(branch: Branch) -> list[str]:
    """Range, peak and status of a branch, in words."""
    _, (_, status), *rows = branch_rows(branch)
    return [counted(len(branch), "point"), *(f"{name} {value}" for name, value in rows), status]
