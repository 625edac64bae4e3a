"""Aerodynamic influence of a model."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._c import AeroForm
from ._calls import _Owner
from ._convert import _array, _member
from ._results import AeroEntries

if TYPE_CHECKING:
    from ._choices import AeroForms


class _Aero(_Owner):
    """Methods of Model for forces that follow the motion of neighbouring sectors."""

    def set_aero(self, dofs: Any, coefficients: Any, offsets: Any, form: AeroForms = "displacement") -> None:
        """Aerodynamic forces on a sector that follow the motion of sectors at the distances `offsets`, on the right-hand
        side; they take the place of those of the same form. [] removes them.

        dofs          degree of freedom, or several (n).
        coefficients  (len(offsets),) for one degree of freedom, else (len(offsets), n, n): row force, column motion; real or
                      complex. Complex ones have no meaning in time.
        offsets       sector of the motion counted from that of the force, each sector once.
        form          "displacement" (force per displacement) or "velocity".

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3)
        >>> model.set_aero(0, [-0.1, 0.05, -0.05], [0, 1, -1])  # per displacement: damps waves of one sense
        >>> model.damped_modes(1, diameter=2).damping_ratio.round(6)
        array([0.016123])
        """
        dofs, offsets = (_array(name, value, np.int64).ravel() for name, value in (("dofs", dofs), ("offsets", offsets)))
        given = _array("coefficients", coefficients, np.complex128)
        if given.ndim == 1 and dofs.size == 1:
            given = given.reshape(-1, 1, 1)
        if given.size and given.shape != (offsets.size, dofs.size, dofs.size):
            raise ValueError(f"coefficients have the shape {given.shape}, need {(offsets.size, dofs.size, dofs.size)}")
        if not given.size:
            dofs = offsets = np.empty(0, np.int64)
        self._call("hbvib_cyclic_set_aero", dofs.size, dofs, offsets.size, given, offsets, _member(AeroForm, form))

    def aero(self, form: AeroForms = "displacement") -> AeroEntries:
        """The aerodynamic forces of `set_aero`, read back, one coefficient after another.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3)
        >>> model.set_aero(0, [-0.1, 0.05], [0, 1])
        >>> model.aero().coefficient
        array([-0.1 +0.j,  0.05+0.j])
        """
        kinds = [np.int64] * 3 + [complex]
        return AeroEntries(*self._listed("hbvib_cyclic_aero", (_member(AeroForm, form),), kinds))
