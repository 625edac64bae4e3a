"""A sector on the cantilever modes of its blade."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, NamedTuple, Optional, cast

import numpy as np

from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _whole
from ._errors import Stopped, _sentence
from ._responses import Response

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._calls import CancelFlag, Hook
    from ._model import Model
    from ._results import FloatArray, IntArray


class BladeModes(NamedTuple):
    """A sector on the cantilever modes of its blade; made by Model.on_blade_modes.

    model      the new sector: the degrees of freedom that are left, in their order, then the modes.
    modes      numbers of the modes there, the `dofs` of a pattern.
    numbers    new number of each degree of freedom of the given sector, -1 where it has none.
    left_out   largest relative error of a frequency of the tuned modes that were asked for by the modes of the blade that are left
               out, as estimated, with all contacts stuck and with all of them free; infinity where one lies above the first of these;
               NaN, unknown, where matrices of a speed act: there compare `linear_modes` of both sectors.
    points     degrees of freedom of the given sector whose motion was asked for, and `weights` of the new ones that make it.

    >>> import hbvib
    >>> import numpy as np
    >>> sector = hbvib.Model.cyclic(1, sectors=3, engine_order=1, mass=1, stiffness=3, coupling=dict(stiffness=-1))
    >>> hbvib.BladeModes(sector, np.array([0]), np.array([-1]), 0.0, np.array([0]), np.array([[2.0]])).response(0).weights
    array([2.])
    """
    model: Model
    modes: IntArray
    numbers: IntArray
    left_out: float
    points: IntArray
    weights: FloatArray

    def response(self, dof: int) -> Response:
        """The motion of a degree of freedom of the given sector, one of `points`, as a response of the new one.

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(1, sectors=3, engine_order=1, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> hbvib.BladeModes(sector, np.array([0]), np.array([-1]), 0.0, np.array([7]), np.array([[0.5]])).response(7).dofs
        array([0])
        """
        found = np.flatnonzero(self.points == dof)
        if len(found) == 0:
            raise ValueError(f"dof = {dof}, needs one of points = {self.points.tolist()}")
        weights = self.weights[found[0]]
        return Response(np.flatnonzero(weights), weights=weights[weights != 0])


class _BladeModes(_Owner):
    """Methods of Model for sectors on modes of their blades."""

    def on_blade_modes(self, dofs: ArrayLike, modes: int, *, families: int = 1, points: ArrayLike = (), phase: Hook = None,
                       cancel: Optional[CancelFlag] = None) -> BladeModes:
        """This sector with its blade on the lowest cantilever modes, with everything else held, and as the rest carries it along
        (Craig and Bampton). In the wheel of it a pattern of the modes is exactly one of the stiffness of the blade, with as many
        terms a blade as modes, 10 to 20 for finite elements.

        dofs       all degrees of freedom of the blade but those of its root and those with contacts and springs; forces may act on
                   them.
        modes      number of modes, below that of dofs.
        families   tuned modes of each nodal diameter whose error is told.
        points     degrees of freedom whose motion is wanted, as tips of blades.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> import numpy as np
        >>> chain = 4 * np.eye(5) - 2 * np.eye(5, k=1) - 2 * np.eye(5, k=-1)
        >>> sector = hbvib.Model.cyclic(sectors=6, engine_order=2, mass=np.eye(5), stiffness=chain,
        ...                             coupling=dict(stiffness=np.diag([-1.0, 0, 0, 0, 0])))
        >>> sector.add_force(4, 1.0)
        >>> blade = sector.on_blade_modes([1, 2, 3, 4], 2, points=[4])
        >>> blade.model.ndof, blade.modes.tolist(), blade.left_out < 0.01
        (3, [1, 2], True)
        >>> wheel = blade.model.wheel()
        >>> wheel.mistune(blade.model, "frequency", 0.01 * np.cos(np.arange(6)), dofs=blade.modes)
        """
        sector = cast("Model", self)
        blade = _array("dofs", dofs, np.int64).ravel()
        at = _array("points", np.asarray(points, np.int64).ravel(), np.int64, (None,))
        count, n = _whole(modes, name="modes"), sector.ndof
        room = max(len(at) * (n - len(blade) + count), 0)
        weights, numbers = np.zeros(room), np.empty(n, np.int64)
        first, left_out, handle = ctypes.c_int64(), ctypes.c_double(), ctypes.c_void_p()
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_wheel_blade_modes", self.handle, blade.size, blade, count, _whole(families, name="families"), hooks,
                           at.size, at, room, weights, n, numbers, first, left_out, handle, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        model = cast("Model", self)
        made = type(model).__new__(type(model))
        made._handle, made._kept, made._units = handle.value, list(model._kept), model._units
        return BladeModes(made, first.value + np.arange(count), numbers, left_out.value, at,
                          weights[:len(at) * made.ndof].reshape(len(at), made.ndof))
