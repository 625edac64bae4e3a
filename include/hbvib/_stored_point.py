"""One stored point of a branch, on its curve or beside it."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator, Union

import numpy as np

from ._c import Field, Status
from ._convert import _member
from ._errors import OutOfRangeError, UnsupportedError

if TYPE_CHECKING:
    from ._branch import Branch
    from ._choices import Fields
    from ._results import ComplexArray, FloatArray, Loop, Wanted
    from ._types import ContactSummary, Energy, ModePoint

# Fields of a nonlinear mode by their names in ModePoint.
_OF_MODE = {
    Field.OMEGA: "omega", Field.DAMPING_RATIO: "damping_ratio", Field.ENERGY: "energy",
    Field.DISSIPATION: "friction_loss", Field.LOG10_AMPLITUDE: "log10_amplitude",
    Field.MODAL_AMPLITUDE: "modal_amplitude", Field.STRUCTURAL_LOSS: "structural_loss", Field.MODAL_ASSURANCE: "assurance"}


class StoredPoint:
    """A stored point of a branch by its number: a point of the curve, or a peak, a fold or a requested solution, which lie
    beside the curve and whose numbers follow those of the curve. Made by Branch.point.

    number    the number that other methods of the branch take.
    on_curve  whether it is a point of the curve, at this place in the fields of the branch.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> peak = branch.point(branch.peaks().point[0])
    >>> print("%.4f %.4f" % (peak.omega, peak.amplitude), peak.on_curve)
    1.2865 0.4735 False
    """

    def __init__(self, branch: Branch, number: int) -> None:
        stored = branch.stored
        if not 0 <= number < stored:
            raise OutOfRangeError(f"point = {number}, needs 0 .. {stored - 1}", Status.E_INDEX, 2)
        self._branch = branch
        self.number: int = number
        self.on_curve: bool = number < len(branch)

    def __repr__(self) -> str:
        return f"<hbvib.StoredPoint {self.number}: omega {self.omega:.6g}, amplitude {self.amplitude:.6g}>"

    def field(self, field: Fields) -> Union[float, FloatArray]:
        """A field of the branch at this point, by Field or name: a number, shares of the contacts for slip_fraction.

        The fields of stability are NaN beside the curve. ArgumentError for a field that the branch does not have. A loaded
        branch has beside the curve omega, amplitude, slip_fraction, those of a nonlinear mode and parameter_value:
        UnsupportedError for others.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> peak = mode.point(mode.peaks().point[0])
        >>> bool(peak.field("damping_ratio") == peak.mode.damping_ratio > mode.damping_ratio.max())
        True
        """
        which = _member(Field, field)
        stored = self._branch._stored_field(which)
        if stored is not None:
            value = stored[self.number]
            return np.array(value) if value.ndim else float(value)
        whole = self._branch.field(which)
        if self.on_curve:
            value = whole[self.number]
            return np.array(value) if value.ndim else float(value)
        if which == Field.SLIP_FRACTION:
            return self._branch.slip(self.number)
        if which in _OF_MODE and self._branch.is_mode:
            return float(getattr(self.mode, _OF_MODE[which]))
        if which in (Field.OMEGA, Field.AMPLITUDE, Field.PARAMETER_VALUE):
            for value in _listed(self._branch, self.number, which.name.lower().replace("_value", "")):
                return value
            if which == Field.AMPLITUDE:
                dof = self._branch.reduction.response_dof
                return float(abs(self._branch.harmonics(self.number, dof, 1)[1, 0]))
        raise UnsupportedError(f"{which.name.lower()} of point {self.number}, which lies beside the curve, is not told",
                               Status.E_UNSUPPORTED)

    @property
    def omega(self) -> float:
        """Angular frequency.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), at=[1.0])
        >>> branch.point(branch.at(0).point[0]).omega
        1.0
        """
        return float(self.field(Field.OMEGA))

    @property
    def amplitude(self) -> float:
        """Peak amplitude of the fundamental of the response degree of freedom.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), at=[1.0])
        >>> print("%.6f" % branch.point(branch.at(0).point[0]).amplitude)  # 0.2 / 0.1
        2.000000
        """
        return float(self.field(Field.AMPLITUDE))

    @property
    def harmonics(self) -> ComplexArray:
        """Harmonics 0 .. H of all degrees of freedom, (H + 1, ndof) complex, see Branch.harmonics.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), at=[1.0])
        >>> branch.point(branch.at(0).point[0]).harmonics[1].round(6)  # 0.2 / 0.1i
        array([0.-2.j])
        """
        return self._branch.harmonics(self.number)

    @property
    def slip(self) -> FloatArray:
        """Shares of the period that each contact slips, see Branch.slip.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.point(0).slip
        array([0.])
        """
        return self._branch.slip(self.number)

    @property
    def energy(self) -> Energy:
        """Energies and losses, see Branch.energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), at=[1.0])
        >>> print("%.4f" % branch.point(branch.at(0).point[0]).energy.structural_loss)  # pi 0.1 omega 2^2
        1.2566
        """
        return self._branch.energy(self.number)

    @property
    def mode(self) -> ModePoint:
        """Numbers of a point of a nonlinear mode, see Branch.mode_point. UnsupportedError for a forced response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> print("%.4f" % model.nonlinear_mode((-2, 1)).point(0).mode.omega)  # sqrt(2)
        1.4142
        """
        return self._branch.mode_point(self.number)

    def loop(self, contact: int, direction: int = 0, n: int = 256) -> Loop:
        """Hysteresis loop of a contact, see Branch.loop.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> print("%.2f" % branch.point(branch.peaks().point[0]).loop(0).force.max())  # mu preload
        0.30
        """
        return self._branch.loop(self.number, contact, direction, n)

    def summary(self, contact: int) -> ContactSummary:
        """Work, shares of the period, ranges and loads of a contact, see Branch.summary.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.point(0).summary(0).work  # it sticks
        0.0
        """
        return self._branch.summary(self.number, contact)

    def time_history(self, dof: int, n: int = 256) -> FloatArray:
        """Motion of a degree of freedom over one period, see Branch.time_history.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), at=[1.0])
        >>> branch.point(branch.at(0).point[0]).time_history(0, 4).round(6) + 0.0  # 2 sin(omega t)
        array([ 0.,  2.,  0., -2.])
        """
        return self._branch.time_history(self.number, dof, n)


def requests(branch: Branch) -> Iterator[Wanted]:
    """What was found at each entry of the solve's `at`."""
    for wanted in range(1 << 62):
        try:
            yield branch.at(wanted)
        except OutOfRangeError:
            return


def _listed(branch: Branch, number: int, name: str) -> Iterator[float]:
    """A number of a point beside the curve, from the lists that have the point."""
    lists: list[Any] = [branch.peaks(), branch.folds(), branch.bifurcations(), branch.optima(), branch.turns(),
                        *requests(branch)]
    for entries in lists:
        values = getattr(entries, name, None)
        if values is not None:
            yield from (float(value) for value in values[entries.point == number] if not np.isnan(value))
    if name == "parameter":
        yield from (float(value) for value, entries in zip(branch._at, requests(branch)) if number in entries.point)
