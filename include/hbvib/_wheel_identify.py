"""Patterns of mistuned wheels from frequencies of single blades and from modes of the wheel."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union, cast

import numpy as np

from ._c import ContactState, LogLevel, Mistuning, Part, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _member, _whole
from ._errors import ArgumentError, Stopped, _sentence
from ._structs import _matrix

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._calls import CancelFlag, Hook
    from ._choices import ContactStates, Mistunings
    from ._model import Model
    from ._results import FloatArray

#: Powers of the factor of a blade's frequency by which each quantity is multiplied.
_POWERS = {Mistuning.STIFFNESS: 2, Mistuning.FREQUENCY: 1, Mistuning.MASS: -2}


class IdentifiedPattern(NamedTuple):
    """A pattern from measured modes; made by Model.identify_pattern.

    delta, covariance   of the sectors, as `mistune` takes delta.
    chi2, degrees  sum of the squares of residuals over their standard deviations, and the number of data less that of unknowns: about
                   equal where noise is all that is left.
    left_out       largest change of delta with one family more; NaN where there is none.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.IdentifiedPattern(np.zeros(2), np.diag([1e-6, 4e-6]), 3.0, 4, 0.0).sd
    array([0.001, 0.002])
    """
    delta: FloatArray
    covariance: FloatArray
    chi2: float
    degrees: int
    left_out: float

    @property
    def sd(self) -> FloatArray:
        """Standard deviations of delta.

        >>> import hbvib
        >>> import numpy as np
        >>> hbvib.IdentifiedPattern(np.zeros(1), np.diag([1e-4]), 0.0, 0, 0.0).sd
        array([0.01])
        """
        return np.sqrt(np.diag(self.covariance))


class _WheelIdentifications(_Owner):
    """Methods of Model for patterns from measurements."""

    def blade_frequencies(self, dofs: ArrayLike, count: int = 1) -> FloatArray:
        """Angular frequencies of the blade of a sector, clamped where it is attached: those that a pattern of `frequency` moves.

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(2, sectors=8, engine_order=2, mass=[[1, 0], [0, 2]], stiffness=[[4, -4], [-4, 9]],
        ...                             coupling=dict(stiffness=[[0, 0], [0, -2]]))
        >>> sector.blade_frequencies([0])
        array([2.])
        """
        sector = cast("Model", self)
        numbers = _array("dofs", dofs, np.int64).ravel()
        wheel = sector.wheel() if sector.sectors > 1 else sector
        blade = type(sector)(len(numbers))
        for kind in ("mass", "stiffness"):
            of_wheel = wheel.matrix(cast(Any, kind))
            blade.set_matrix(cast(Any, kind), of_wheel[np.ix_(numbers, numbers)])
        return blade.linear_modes(count).omega

    def pattern_of_blades(self, omega: ArrayLike, dofs: ArrayLike, *, kind: Mistunings = "frequency", mode: int = 0) -> FloatArray:
        """The pattern of a wheel from the angular frequencies of its blades, measured one by one as clamped: relative to those of
        the blade of this model.

        omega   of each blade, in one mode of the clamped blade.
        dofs    degrees of freedom of the blade of a sector.
        kind    "stiffness", "frequency" or "mass".
        mode    number of that mode, from 0.

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(2, sectors=4, engine_order=1, mass=[[1, 0], [0, 2]], stiffness=[[4, -4], [-4, 9]],
        ...                             coupling=dict(stiffness=[[0, 0], [0, -2]]))
        >>> sector.pattern_of_blades([2.02, 1.98, 2.0, 2.01], [0]).round(6)
        array([ 0.01 , -0.01 ,  0.   ,  0.005])
        """
        sector = cast("Model", self)
        measured = _array("omega", omega, np.float64, (sector.sectors,))
        power = _POWERS.get(_member(Mistuning, kind))
        if power is None:
            raise ValueError(f"kind = {kind!r}, needs stiffness, frequency or mass")
        if not (measured > 0).all():
            raise ValueError(f"omega has {measured.min()}, needs numbers above 0")
        number = _whole(mode, name="mode")
        factors = measured / self.blade_frequencies(dofs, number + 1)[number]
        return cast("FloatArray", factors**power - 1)

    def identify_pattern(self, omega: ArrayLike, shapes: ArrayLike, *, sigma_omega: Union[float, ArrayLike],
                         sigma_shape: Union[float, ArrayLike], points: ArrayLike = 0, kind: Mistunings = "stiffness",
                         dofs: Optional[ArrayLike] = None, direction: Any = None, families: int = 3,
                         contacts: ContactStates = "stuck", phase: Hook = None,
                         cancel: Optional[CancelFlag] = None) -> IdentifiedPattern:
        """The pattern of a wheel from measured modes of it, with its covariance: that of the greatest likelihood under normal noise
        of frequencies and shapes. A few modes are enough; the modes of a whole family tell most.

        omega        angular frequencies of the modes.
        shapes       modes x sectors, or modes x sectors x points: real or complex, of any scale and phase.
        sigma_omega  standard deviation of the frequencies: one number, or one for each mode.
        sigma_shape  that of each part of a number of a shape, in its scale; or one for each mode.
        points       degrees of freedom of each sector that were measured.
        kind, dofs, direction   as in `mistune`: "stiffness", "frequency" or "mass".
        families     tuned modes of each nodal diameter, from the lowest, that span those of the wheel: up to the measured ones, and
                     some more; `left_out` tells what one more changes.
        contacts     "stuck", "free" or "static" in the measurement.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(2, sectors=8, engine_order=2, mass=[[1, 0], [0, 2]], stiffness=[[4, -4], [-4, 9]],
        ...                             coupling=dict(stiffness=[[0, 0], [0, -2]]))
        >>> wheel = sector.wheel()
        >>> wheel.mistune(sector, "stiffness", 0.01 * np.cos(np.arange(8) ** 2), dofs=[0])
        >>> modes = wheel.linear_modes(8)
        >>> found = sector.identify_pattern(modes.omega, modes.shapes[:, ::2], sigma_omega=1e-4, sigma_shape=1e-3, dofs=[0], families=2)
        >>> bool(abs(found.delta - 0.01 * np.cos(np.arange(8) ** 2)).max() < 1e-9)
        True
        """
        sector = cast("Model", self)
        at = _array("points", np.atleast_1d(np.asarray(points)), np.int64, (None,))
        frequencies = _array("omega", np.atleast_1d(np.asarray(omega, float)), np.float64, (None,))
        n, sectors = len(frequencies), sector.sectors
        numbers = np.asarray(shapes)
        if numbers.shape == (n, sectors) and len(at) == 1:
            numbers = numbers[:, :, None]
        complex_shapes = _array("shapes", numbers, np.complex128, (n, sectors, len(at)))
        deviations = [_array(name, np.broadcast_to(np.asarray(value, float), (n,)).copy(), np.float64, (n,))
                      for name, value in (("sigma_omega", sigma_omega), ("sigma_shape", sigma_shape))]
        blade = _array("dofs", [] if dofs is None else dofs, np.int64).ravel()
        given = None if direction is None else _matrix(direction, Part.FULL, "direction")
        data = (len(at), at, n, frequencies, deviations[0], complex_shapes, deviations[1])

        def found(of: int) -> IdentifiedPattern:
            delta, covariance = np.empty(sectors), np.empty((sectors, sectors))
            chi2, degrees = ctypes.c_double(), ctypes.c_int64()
            with _Guard() as guard:
                hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
                status = _call("hbvib_wheel_identify", self.handle, _member(Mistuning, kind), blade.size, blade, given,
                               _member(ContactState, contacts), of, *data, hooks, sectors, delta, covariance, chi2, degrees, guard=guard)
            if status == Status.STOPPED_BY_CALLER:
                raise Stopped(_sentence(status), Status(status), 0)
            return IdentifiedPattern(delta, covariance, chi2.value, degrees.value, np.nan)

        number = _whole(families, name="families")
        best = found(number)
        if number >= sector.ndof:
            return best
        try:
            more = found(number + 1)
        except ArgumentError:  # one more has no mass
            return best
        return best._replace(left_out=float(abs(more.delta - best.delta).max()))
