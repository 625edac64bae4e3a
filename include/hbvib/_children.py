"""Children of a branch: branches that branch off from it, and detached curves beside it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

from ._calls import _call, _Owner
from ._errors import _sentence
from ._structs import _new, _record
from ._types import Descent, Searched

if TYPE_CHECKING:
    from ._branch import Branch
    from ._results import FloatArray


class _BranchChildren(_Owner):
    """Methods of Branch for solutions that a sweep does not show."""

    _at: FloatArray
    _origin: Any
    _responses: Any
    _leases: Any
    _living: Any
    _units: Any
    _parent: Optional[Branch] = None  # a child's, which frees it
    message: str

    @property
    def children(self) -> list[Branch]:
        """The branches that branch off from this one, and the detached curves beside it, as far as the option branches of
        forced_response or nonlinear_mode sought them. Each is a branch with children of its own and keeps its parent. Those of the double
        period have half the frequencies, and Model.longer_period(2) is their model.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> contact = model.add_contact("cubic", 0, cubic=1)
        >>> model.add_force(0, 10)
        >>> branch = model.forced_response((1.5, 1.7), harmonics=11, branches=1)
        >>> child, = branch.children
        >>> child.descent.periods, "%.4f" % branch.bifurcations().omega[child.descent.bifurcation]
        (1, '1.6206')
        """
        found: list[Branch] = []
        for number in range(_call("hbvib_branch_children", self.handle)):
            handle = ctypes.c_void_p()
            self._call("hbvib_branch_child", number, handle)
            assert handle.value is not None
            child = type(self)(handle.value, self._kept, "", self._units)  # type: ignore[call-arg]
            child._parent = cast("Branch", self)
            self._living.add(child)
            found.append(child)  # type: ignore[arg-type]
            descent = child.descent
            status = _call("hbvib_branch_status", child.handle)
            child.message = _sentence(status) if status else ""
            child._at = np.asarray(self._at) / descent.periods
            # The model of another period is that of longer_period.
            child._origin = self._origin if descent.periods == 1 else None
            child._responses = self._responses
        return found

    @property
    def descent(self) -> Descent:
        """Where a child comes from.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 1)
        >>> model.forced_response(0.5).descent.bifurcation  # asked for
        -1
        """
        descent = _new("hbvib_descent")
        self._call("hbvib_branch_descent", descent)
        return _record(Descent, descent)

    @property
    def searched(self) -> Searched:
        """The solutions that were sought beside a branch. That list is never complete.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 1)
        >>> model.forced_response(0.5).searched.bifurcations
        0
        """
        searched = _new("hbvib_searched")
        self._call("hbvib_branch_searched", searched)
        return _record(Searched, searched)

    def _leased(self) -> int:
        """Arrays that look into the memory of the branch or of a child."""
        living: list[Branch] = [child for child in self._living if child._handle is not None]
        return len(self._leases) + sum(child._leased() for child in living)

    def _forget(self) -> None:
        """The library has freed the branch with its children."""
        self._handle = None
        for child in list(self._living):
            child._forget()
