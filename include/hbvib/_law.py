"""A contact law: its constants, its directions, and its force on given motions."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Mapping, overload

import numpy as np
from numpy.typing import ArrayLike

from ._c import GROUND, ContactKind
from ._calls import _stoppable
from ._convert import _array, _member, _whole
from ._results import ContactForce
from ._structs import _options
from ._types import ContactConstants

if TYPE_CHECKING:
    from typing import Optional

    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook


# Places of the directions t1, t2, n in which a law acts.
_PLACES = {ContactKind.FRICTION_2D: (0, 2), ContactKind.FRICTION_3D: (0, 1, 2), ContactKind.UNILATERAL: (2,)}


def _side(kind: Any, dofs: Any) -> list[Any]:
    """The three places of one side: given as three, or as the directions of the law in their order."""
    given = [_whole(dof) for dof in ([dofs] if np.ndim(dofs) == 0 else dofs)]
    if len(given) == 3:
        return given
    places = _PLACES.get(kind, (0,))
    if not 0 < len(given) <= len(places):
        raise ValueError(f"{len(given)} degrees of freedom on a side, {kind.name} has {len(places)} or three places")
    side = [GROUND] * 3
    for place, dof in zip(places, given):
        side[place] = dof
    return side


# Constants without which a law has no force, or another one than its name says.
_REQUIRED = {
    ContactKind.JENKINS: ("kt", "mu", "preload"), ContactKind.FRICTION_2D: ("kt", "kn", "mu"),
    ContactKind.FRICTION_3D: ("kt", "mu"), ContactKind.UNILATERAL: ("kn",), ContactKind.CUBIC: ("cubic",),
    ContactKind.REGULARISED: ("mu", "preload", "velocity")}


def _law(caller: str, kind: Any, constants: Mapping[str, Any]) -> Any:
    law = _member(ContactKind, kind)
    missing = [name for name in _REQUIRED.get(law, ()) if name not in constants]
    if missing:
        raise TypeError(f"{caller}() of {law.name.lower()!r} misses {', '.join(missing)}")
    return _options(caller, "hbvib_contact", constants, "kind dof_a dof_b", kind=law)


@overload
def evaluate_contact(kind: Literal["jenkins", ContactKind.JENKINS], motion: ArrayLike, *, kt: float, mu: float,
                     preload: float, omega: float = 1, samples: int = 0, jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["friction_2d", ContactKind.FRICTION_2D], motion: ArrayLike, *, kt: float,
                     kn: float, mu: float, preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["friction_3d", ContactKind.FRICTION_3D], motion: ArrayLike, *, kt: float,
                     mu: float, kn: float = 0, preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["unilateral", ContactKind.UNILATERAL], motion: ArrayLike, *, kn: float,
                     preload: float = 0, gap: float = 0, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None, cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["cubic", ContactKind.CUBIC], motion: ArrayLike, *, cubic: float, kt: float = 0,
                     omega: float = 1, samples: int = 0, jacobian: bool = False, phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: Literal["regularised", ContactKind.REGULARISED], motion: ArrayLike, *, mu: float,
                     preload: float, velocity: float, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None, cancel: Optional[CancelFlag] = None) -> ContactForce: ...


@overload
def evaluate_contact(kind: ContactKind, motion: ArrayLike, *, omega: float = 1, samples: int = 0,
                     jacobian: bool = False, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                     **constants: Unpack[ContactConstants]) -> ContactForce: ...


def evaluate_contact(kind: Any, motion: ArrayLike, *, omega: float = 1, samples: int = 0, jacobian: bool = False,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None,
                     **constants: Any) -> ContactForce:
    """Force of one contact law on prescribed harmonics of its motions, (H + 1) or (d, H + 1) complex: an array like
    it, and with jacobian the real d F / d Y over the pairs (re, im), of order 2 d (H + 1), else None.

    omega     angular frequency; it has an effect on laws that depend on velocities alone.
    samples   per period; 0: exact events. No effect on friction_2d, friction_3d and cubic, which are always exact.
    phase, cancel   as in forced_response; Stopped is raised where they stop it.

    >>> import hbvib
    >>> import numpy as np
    >>> force = hbvib.evaluate_contact("cubic", [0, 1], kt=1, cubic=0.5).force
    >>> force.real.round(6)  # 1 + 0.5 * 3 / 4
    array([0.   , 1.375])
    """
    law = _law("evaluate_contact", kind, constants)
    motion = _array("motion", motion, np.complex128, [None] * (2 if np.ndim(motion) == 2 else 1))
    force = np.empty_like(motion)
    matrix = np.empty((2 * motion.size,) * 2, order="F") if jacobian else None
    _stoppable("hbvib_contact_evaluate", law, motion.shape[-1] - 1, samples, omega, motion, motion.size, force,
               force.size, matrix, 0 if matrix is None else matrix.size, phase=phase, cancel=cancel)
    return ContactForce(force, matrix)
