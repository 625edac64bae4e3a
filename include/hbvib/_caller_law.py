"""Forces that a Python function computes."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike

from ._calls import _Guard, _refused, _running
from ._contacts import _Contacts
from ._convert import _array
from ._library import _TYPES
from ._structs import _new, _record
from ._types import JacobianGap

if TYPE_CHECKING:
    from ._results import FloatArray


class ForceCall:
    """One period for which a user force is computed, in the names of hbvib_force_call: omega, samples N, n, states s,
    and arrays in the library's own memory, valid during the callback only (copy what you keep):

    in   u (N, n), v (N, n), z0 (s);                                       read-only
    out  f (N, n), df_du and df_dv (N, n, n), z (N, s), dz_dz (N, s, s), dz_du_before, dz_du, dz_dv_before and
         dz_dv (N, s, n), dz_domega (N, s), df_dz (N, n, s).

    v, df_dv, dz_dv and dz_dv_before are None unless uses_velocity, all with a z unless there are states.

    >>> import hbvib
    >>> def damper(call: hbvib.ForceCall) -> None:
    ...     call.f[:] = 0.1 * call.v
    ...     call.df_dv[:, 0, 0] = 0.1
    ...
    >>> model = hbvib.Model(mass=1, stiffness=1)
    >>> model.add_user_force([0], damper, uses_velocity=True, is_odd=True)
    0
    """

    omega: float
    samples: int
    n: int
    states: int
    u: FloatArray
    v: FloatArray
    z0: FloatArray
    f: FloatArray
    df_du: FloatArray
    df_dv: FloatArray
    z: FloatArray
    dz_dz: FloatArray
    dz_du_before: FloatArray
    dz_du: FloatArray
    dz_dv_before: FloatArray
    dz_dv: FloatArray
    dz_domega: FloatArray
    df_dz: FloatArray

    _SHAPES = dict(u="Nn", v="Nn", z0="s", f="Nn", df_du="Nnn", df_dv="Nnn", z="Ns", dz_dz="Nss", dz_du_before="Nsn",
                   dz_du="Nsn", dz_dv_before="Nsn", dz_dv="Nsn", dz_domega="Ns", df_dz="Nns")

    def __init__(self, call: Any) -> None:
        self._call = call
        self.omega, self.samples, self.n, self.states = call.omega, call.samples, call.n, call.states

    def __getattr__(self, name: str) -> Optional[FloatArray]:
        if name not in self._SHAPES:  # each array is made at its first use
            raise AttributeError(name)
        address, lengths, array = getattr(self._call, name), dict(N=self.samples, n=self.n, s=self.states), None
        if address:
            shape = [lengths[letter] for letter in self._SHAPES[name]]
            count = int(np.prod(shape))
            array = np.frombuffer((ctypes.c_double * count).from_address(address)).reshape(shape)  # type: ignore[call-overload]
            array.flags.writeable = name not in ("u", "v", "z0")
        setattr(self, name, array)
        return array


class _CallerLaws(_Contacts):
    """Methods of Model for forces of the caller."""

    def add_user_force(self, dofs: ArrayLike, function: Callable[[ForceCall], Any], *, states: int = 0,
                       samples: int = 0, uses_velocity: bool = False, is_odd: bool = False) -> int:
        """Adds a force of your own on some degrees of freedom, each over the ground; returns its number.

        function(call) writes call.f and the derivatives that are not zero, see ForceCall. It returns nothing, or False
        where it cannot at this motion: shorter steps are tried. An exception ends the solve and leaves it.
        The model, its copies and all branches keep it alive, because results call it again.

        >>> import hbvib
        >>> def cubic(call):
        ...     call.f[:] = 0.5 * call.u**3
        ...     call.df_du[:, 0, 0] = 1.5 * call.u[:, 0]**2
        ...
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_user_force([0], cubic, is_odd=True)
        0
        """
        if not callable(function):
            raise TypeError("function is not callable")

        def trampoline(_: Any, call: Any) -> int:
            guard = getattr(_running, "guard", None) or _Guard()
            answer = guard.run(function, ForceCall(call.contents)) if guard.held is None else None
            return -1 if guard.held is not None else int(_refused(answer))

        dofs = _array("dofs", dofs, np.int64, [None])
        callback = _TYPES["force_fn"](trampoline)
        force = _new("hbvib_user_force", dofs=dofs, n=len(dofs), states=states, samples=samples, force=callback,
                     uses_velocity=uses_velocity, is_odd=is_odd)
        kept = self._kept
        kept.append(callback)  # before another thread can solve with it
        try:
            return self._identified("hbvib_model_add_user_force", force)
        except BaseException:
            kept.remove(callback)
            raise

    def check_jacobian(self, contact: int, omega: float, amplitude: ArrayLike) -> JacobianGap:
        """The derivative of a user force that lies farthest from its difference quotient; `gap` below 1e-6 is right.

        amplitude   about the largest motion of each degree of freedom of the force, n numbers.

        >>> import hbvib
        >>> def cubic(call):
        ...     call.f[:] = 0.5 * call.u**3
        ...     call.df_du[:, 0, 0] = 1.5 * call.u[:, 0]**2
        ...
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> number = model.add_user_force([0], cubic, is_odd=True)
        >>> model.check_jacobian(number, omega=1, amplitude=0.3).gap < 1e-6
        True
        """
        amplitude = _array("amplitude", np.atleast_1d(amplitude), shape=[None])
        gap = _new("hbvib_jacobian_gap")
        self._call("hbvib_check_jacobian", contact, omega, amplitude, len(amplitude), gap)
        return _record(JacobianGap, gap)
