"""Models and branches in one line, and as a table in a notebook."""
from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np

from ._c import Status

if TYPE_CHECKING:
    from . import Branch, Model


def counted(number: int, one: str) -> str:
    """1 point, 2 points, 1 degree of freedom, 2 degrees of freedom."""
    first, _, rest = one.partition(" ")
    return f"{number} {first}{'s' * (number != 1)}{' ' * bool(rest)}{rest}"


def model_rows(model: Model) -> list[tuple[str, str]]:
    """The numbers of a model."""
    rows = [("degrees of freedom", str(model.ndof))]
    if model.sectors > 1:
        rows += [("sectors", str(model.sectors)), ("engine order", str(model.engine_order))]
    return rows + [("contacts", str(model.contacts)), ("forces", str(len(model.forces.dof)))]


def model_line(model: Model) -> str:
    """A model in one line."""
    parts = [counted(model.ndof, "degree of freedom")]
    if model.sectors > 1:
        parts += [counted(model.sectors, "sector"), f"engine order {model.engine_order}"]
    return f"<hbvib.Model: {', '.join([*parts, counted(model.contacts, 'contact')])}>"


def model_table(model: Model) -> str:
    """A model as HTML."""
    return _table("hbvib.Model", [] if model.is_freed else model_rows(model))


def branch_rows(branch: Branch) -> list[tuple[str, str]]:
    """Status, range and peak of a branch."""
    status = branch.status.name if branch.status == Status.OK else f"{branch.status.name}: {branch.message}"
    rows = [("points", str(len(branch))), ("status", status)]
    if len(branch) == 0:
        return rows
    parameter, name = branch.omega, "omega"
    if branch.is_mode:
        parameter, name = branch.log10_amplitude, "log10_amplitude"
    rows.append((name, f"{parameter[0]:.6g} to {parameter[-1]:.6g}"))
    peaks = branch.peaks()
    if len(peaks.point) and branch.is_mode:
        ratios = [branch.mode_point(int(point)).damping_ratio for point in peaks.point]
        best = int(np.argmax(ratios))
        rows.append(("largest damping ratio", f"{ratios[best]:.4g} at omega = {peaks.omega[best]:.6g}"))
    elif len(peaks.point):
        best = int(np.argmax(peaks.amplitude))
        rows.append(("peak", f"{peaks.amplitude[best]:.6g} at omega = {peaks.omega[best]:.6g}"))
    return rows


def branch_line(branch: Branch) -> str:
    """A branch in one line."""
    if branch.is_freed:
        return "<hbvib.Branch, freed>"
    points, (_, status), *rows = branch_rows(branch)
    parts = [counted(len(branch), "point"), *(f"{name} {value}" for name, value in rows), status]
    return f"<hbvib.{type(branch).__name__}: {', '.join(parts)}>"


def branch_table(branch: Branch) -> str:
    """A branch as HTML."""
    return _table("hbvib." + type(branch).__name__, [] if branch.is_freed else branch_rows(branch))


def _table(title: str, rows: list[tuple[str, str]]) -> str:
    lines = "".join(f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>"
                    f"{html.escape(value)}</td></tr>" for name, value in rows or [("freed", "")])
    return f"<table><caption>{html.escape(title)}</caption>{lines}</table>"
