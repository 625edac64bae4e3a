"""A stored motion as the solution of a problem of its own, for what the library computes of a solution in memory."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Optional

import numpy as np

from ._c import Status
from ._errors import Error, StoppedEarly, UnsupportedError

if TYPE_CHECKING:
    from ._branch import Branch
    from ._model import Model
    from ._results import ComplexArray, FloatArray
    from ._types import Energy

#: Relative distance of motions that are the same, and of slip shares and losses that follow from them.
_SAME = 1e-9
_SAME_SLIP = 1e-6

#: Share of the energy below which a loss is rounding.
_ROUNDING = 1e-12


def recomputed(model: Model, omega: float, harmonics: ComplexArray, engine_order: Optional[int],
               samples: int) -> Branch:
    """A branch of one point with the motion of these harmonics; the model is changed.

    The forces are those that the motion needs, so that it solves the equations of the model exactly. The damping is one
    that makes the solution simple also where the branch turns, or where a nonlinear mode has no damping: forces and
    motions of contacts follow from the motion alone. UnsupportedError where the motion is not found again.
    """
    size = np.abs(harmonics).max()
    moves = np.flatnonzero(np.abs(harmonics).max(axis=1))
    x = harmonics[:max(moves[-1] if moves.size else 0, 1) + 1]
    model.clear_forces()
    if engine_order is not None:
        model.set_wave(engine_order)
    model.set_rayleigh(omega, 0.0)
    if samples:
        samples = max(samples, 8 * (len(x) - 1))  # as where a tolerance chose the harmonics
    needed = model.forced_residual(omega, x, samples=samples).residual
    for harmonic, dof in zip(*np.nonzero(needed)):
        force = needed[harmonic, dof]
        model.add_force(int(dof), force if harmonic else force.real, int(harmonic))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", StoppedEarly)
            found = model.forced_response(omega, guess=x, harmonics=len(x) - 1, samples=samples)
    except Error as error:
        raise UnsupportedError(f"the motion was not found again: {error}", Status.E_UNSUPPORTED) from error
    if len(found) != 1 or not np.abs(found.harmonics(0) - x).max() <= _SAME * size:
        raise UnsupportedError("the motion was not found again", Status.E_UNSUPPORTED)
    return found


def check(found: Branch, slip: FloatArray, energy: Energy, samples: int) -> None:
    """Compares slip and loss with those that were saved: UnsupportedError where they are of another model. Those of sampled
    laws have the accuracy of the samples, whose number may be another one."""
    loss = found.energy(0).friction_loss
    same = max(_SAME_SLIP, 4 / samples if samples else 0.0)
    rounding = _ROUNDING * (abs(energy.kinetic_mean) + abs(energy.potential_mean))
    allowed = same * max(abs(loss), abs(energy.friction_loss)) + rounding
    if np.any(np.abs(found.slip(0) - slip) > same) or abs(loss - energy.friction_loss) > allowed:
        raise UnsupportedError("the contacts of the saved model do not slip as those of the branch; near-rigid ones that "
                               "were solved with a tolerance are not computed again: use the branch in memory",
                               Status.E_UNSUPPORTED)
