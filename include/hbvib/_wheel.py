"""The whole wheel of a cyclic model, and patterns of mistuning."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

from ._c import Mistuning, Part
from ._calls import _Owner
from ._convert import _array, _member, _whole
from ._structs import _matrix

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._choices import Mistunings
    from ._model import Model


class _Wheels(_Owner):
    """Methods of Model for the whole wheel."""

    def wheel(self) -> Model:
        """The whole wheel of a cyclic model, a plain model for every analysis. Degree of freedom i of sector s is s * ndof + i
        and contact c is s * contacts + c; sectors count from 0. The phases of the engine order are in the forces.

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> sector.wheel()
        <hbvib.Model: 8 degrees of freedom, 0 contacts>
        """
        handle = ctypes.c_void_p()
        self._call("hbvib_wheel_new", handle)
        model = cast("Model", self)
        wheel = type(model).__new__(type(model))
        wheel._handle, wheel._kept, wheel._units = handle.value, list(model._kept), model._units
        return wheel

    def mistune(self, sector: Model, kind: Mistunings, delta: ArrayLike, *, dofs: Optional[ArrayLike] = None,
                direction: Any = None, contact: int = -1) -> None:
        """Mistunes the wheel that `sector.wheel()` made. Matrices refer to those of the sector and several calls add up; loads
        and forces are multiplied.

        kind       "stiffness", "frequency" (clamped blades), "mass" or "damping" of blades, "preload" of contacts, "force".
        delta      of each sector: the quantity times 1 + delta, with dofs at least -1.
        dofs       degrees of freedom of the blade of a sector. Its stiffness is that of its motion relative to the one that
                   its attachment carries along.
        direction  matrix of a sector instead of dofs: delta times it is added to stiffness, mass or damping.
        contact    of the sector, for "preload"; -1: all with a normal load.

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> wheel = sector.wheel()
        >>> wheel.mistune(sector, "mass", 0.02 * np.cos(np.arange(8)), dofs=[0])
        >>> round(float(wheel.matrix("mass")[1, 1]), 6)
        1.010806
        """
        numbers = _array("dofs", [] if dofs is None else dofs, np.int64).ravel()
        given = None if direction is None else _matrix(direction, Part.FULL, "direction")
        pattern = _array("delta", delta, np.float64, (None,))
        self._call("hbvib_wheel_mistune", sector.handle, _member(Mistuning, kind), numbers.size, numbers, given,
                   _whole(contact, name="contact"), pattern.size, pattern)
