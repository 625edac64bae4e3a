"""Names of the units of a model, for what is shown; no number is converted."""
from __future__ import annotations

from typing import NamedTuple, Sequence

from ._calls import _Owner

__all__ = ["Units"]


class Units(NamedTuple):
    """Names of the units of a model, which tables, figures and notebooks show. Any consistent set is right: no number is converted
    or checked.

    length, force, time   names such as "mm", "N", "s"; an empty one is not shown.

    >>> import hbvib
    >>> units = hbvib.Units("mm", "N", "s")
    >>> units.speed
    'rad/s'
    """
    length: str = ""
    force: str = ""
    time: str = ""

    @property
    def speed(self) -> str:
        """The unit of angular frequencies, or nothing.

        >>> import hbvib
        >>> hbvib.Units(time="ms").speed
        'rad/ms'
        """
        return f"rad/{self.time}" if self.time else ""

    @property
    def work(self) -> str:
        """The unit of works and energies, or nothing.

        >>> import hbvib
        >>> hbvib.Units("mm", "N").work
        'N mm'
        """
        return f"{self.force} {self.length}" if self.force and self.length else ""


def after(number: str, unit: str) -> str:
    """A number with its unit: "0.5 mm", "0.5" where there is none."""
    return f"{number} {unit}" if unit else number


def label(name: str, unit: str) -> str:
    """A label of an axis: "amplitude / mm", "amplitude" where there is none."""
    return f"{name} / {unit}" if unit else name


def of_field(field: str, units: Units) -> str:
    """The unit of a field of a branch, or nothing."""
    if field == "omega":
        return units.speed
    if field == "amplitude":
        return units.length
    return units.work if field in ("mode_energy", "energy", "dissipation", "structural_loss") else ""


def named(units: Sequence[str]) -> Units:
    """Units from a Units or a sequence of names. TypeError for anything else."""
    names = (units,) if isinstance(units, str) else tuple(units)
    if isinstance(units, str) or len(names) > 3 or not all(isinstance(name, str) for name in names):
        raise TypeError(f"units = {units!r}, needs up to three names: length, force, time, as hbvib.Units('mm', 'N', 's')")
    return Units(*names)


class _HasUnits(_Owner):
    """The units of a model, and of what was computed from it."""

    _units: Units = Units()

    @property
    def units(self) -> Units:
        """Names of the units, for what is shown: those of the model, of a branch those that its model had at the solve. Given as
        a Units or as up to three names.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> model.units = "mm", "N", "s"
        >>> model.forced_response((0.8, 1.2), harmonics=1)
        <hbvib.Branch: 44 points, omega 0.8 to 1.2 rad/s, peak 2.0025 mm at omega = 0.997497 rad/s, OK>
        """
        return self._units

    @units.setter
    def units(self, units: Sequence[str]) -> None:
        self._units = named(units)
