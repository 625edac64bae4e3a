"""The highest value of a function of many variables within a box, by its derivatives."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Vector = NDArray[np.float64]

#: Gain that the gradient foretells, relative to the value, at which an ascent ends.
_NO_GAIN = 1e-9
#: Share of the box below which a step ends it.
_NO_STEP = 1e-9
#: Share of the foretold gain that a step must reach (Armijo), and a loss by rounding that is none.
_ARMIJO, _ROUNDING = 1e-4, 1e-12


class Place(NamedTuple):
    """A point of an ascent: its variables, the value and its gradient, and what else the function told."""

    at: Vector
    value: float
    gradient: Vector
    more: Any


def foretold(at: Vector, gradient: Vector, box: float) -> float:
    """Gain that the gradient foretells within -box .. box; zero where Karush, Kuhn and Tucker's conditions hold."""
    return float(np.sum(np.where(gradient > 0, gradient * (box - at), -gradient * (box + at))))


def ascend(function: Callable[[Vector], tuple[float, Vector, Any]], start: Vector, box: float, most: int) -> Place:
    """Climbs from a start, with at most so many evaluations.

    Steps along the signs of the gradient come first: they reach a corner of the box within a few, where the highest value often
    lies. Where one fails, BFGS goes on along the variables that are not held by a bound (Bertsekas 1982, doi:10.1137/0320018).
    """
    here = Place(start, *function(start))
    left, radius = most - 1, box
    while left > 0 and radius > box / 9 and not _has_ended(here, box):
        trial = np.clip(here.at + radius * np.sign(here.gradient), -box, box)
        there = Place(trial, *function(trial))
        left -= 1
        if there.value > here.value:
            here, radius = there, min(1.5 * radius, 2 * box)
        else:
            radius /= 3
    inverse: Optional[NDArray[np.float64]] = None
    held = _held(here, box)
    while left > 0 and not _has_ended(here, box):
        free = ~held
        slope = here.gradient[free]
        step = slope * (radius / np.abs(slope).max()) if inverse is None else inverse @ slope
        if step @ slope <= 0:
            inverse = None
            continue
        higher, left = _along(function, here, (free, step), box, left)
        if higher is None:
            if inverse is None:
                break
            inverse = None
            continue
        there = higher
        now = _held(there, box)
        if (now == held).all():
            inverse = _updated(inverse, (there.at - here.at)[free], (here.gradient - there.gradient)[free])
        else:
            inverse = None
        radius = max(float(np.abs(there.at - here.at).max()), _NO_STEP * box)
        here, held = there, now
    return here


def _has_ended(here: Place, box: float) -> bool:
    return foretold(here.at, here.gradient, box) <= _NO_GAIN * here.value


def _held(here: Place, box: float) -> NDArray[np.bool_]:
    """Variables at a bound beyond which the gradient points."""
    return ((here.at >= box) & (here.gradient >= 0)) | ((here.at <= -box) & (here.gradient <= 0))


def _along(function: Callable[[Vector], tuple[float, Vector, Any]], here: Place, way: tuple[NDArray[np.bool_], Vector], box: float,
           left: int) -> tuple[Optional[Place], int]:
    """The first place along a step and its halves that is higher, and how many evaluations are left."""
    free, step = way
    share = min(1.0, 2 * box / float(np.abs(step).max()))
    while left > 0 and share * float(np.abs(step).max()) > _NO_STEP * box:
        trial = here.at.copy()
        trial[free] = np.clip(trial[free] + share * step, -box, box)
        there = Place(trial, *function(trial))
        left -= 1
        gain = float(here.gradient @ (trial - here.at))
        is_flatter = foretold(trial, there.gradient, box) < foretold(here.at, here.gradient, box)
        if there.value >= here.value + _ARMIJO * gain or (is_flatter and there.value >= here.value * (1 - _ROUNDING)):
            return there, left
        # The top of the parabola through both values, not too far from half.
        bend = here.value + gain - there.value
        share *= min(max(0.5 * gain / bend if bend > 0 else 0.5, 0.1), 0.5)
    return None, left


def _updated(inverse: Optional[NDArray[np.float64]], step: Vector, change: Vector) -> Optional[NDArray[np.float64]]:
    """The inverse of minus the second derivatives after a step, by BFGS; unchanged where they do not fall along it."""
    bend = float(step @ change)
    if bend <= 1e-12 * float(np.linalg.norm(step) * np.linalg.norm(change)):
        return inverse
    if inverse is None:
        inverse = np.eye(len(step)) * (bend / float(change @ change))
    along = inverse @ change
    return (inverse + np.outer(step, step) * ((bend + float(change @ along)) / bend**2)
            - (np.outer(along, step) + np.outer(step, along)) / bend)
