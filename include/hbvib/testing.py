"""For tests of programs that use hbvib: small models with known answers, and assertions that say what differs."""
from __future__ import annotations

from typing import TYPE_CHECKING, Optional

import numpy as np

from ._model import Model

if TYPE_CHECKING:
    from ._branch import Branch

__all__ = ["friction_oscillator", "duffing_oscillator", "assert_same_curve", "assert_verified"]


def friction_oscillator(force: float = 0.2) -> Model:
    """A mass of 1 on a spring of 1 with C = 0.02, on an elastic slider of stiffness 1 and limit 0.3. Under small forces its resonance
    is sqrt(2), under large ones 1; under 0.2 it is 1.23202.

    >>> import hbvib.testing
    >>> branch = hbvib.testing.friction_oscillator().forced_response((0.8, 1.6))
    >>> print("%.5f" % branch.peaks().omega[0])
    1.23202
    """
    model = Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, force)
    return model


def duffing_oscillator(force: float = 0.3) -> Model:
    """A mass of 1 on a spring of 1 and a cubic spring of 1, with C = 0.1. Under 0.3 it has three motions at a frequency of 1.5.

    >>> import hbvib.testing
    >>> branch = hbvib.testing.duffing_oscillator().forced_response((0.3, 2.2), at=[1.5])
    >>> len(branch.at(0).amplitude)
    3
    """
    model = Model(mass=1, damping=0.1, stiffness=1)
    model.add_contact("cubic", 0, cubic=1)
    model.add_force(0, force)
    return model


def assert_same_curve(found: Branch, wanted: Branch, rtol: float = 1e-3, samples: int = 50) -> None:
    """AssertionError where two branches are different curves of amplitude over frequency: ranges, peaks, and the amplitudes in
    between, read along the curves by their frequency and amplitude, whatever points each of them has.

    rtol     of the largest amplitude, and of frequencies; not below the tolerance of the solves.
    samples  points of `found` that are sought on the curve of `wanted`.

    >>> import hbvib.testing
    >>> model = hbvib.testing.friction_oscillator()
    >>> fine, coarse = model.forced_response((0.8, 1.6), step_max=0.02), model.forced_response((0.8, 1.6))
    >>> hbvib.testing.assert_same_curve(coarse, fine, rtol=1e-2)
    >>> model.set_preload(0, 1.1)
    >>> try:
    ...     hbvib.testing.assert_same_curve(model.forced_response((0.8, 1.6)), fine, rtol=1e-2)
    ... except AssertionError as error:
    ...     print(str(error).split(":")[0])
    peak 0
    """
    for name, a, b in (("first", 0, 0), ("last", -1, -1)):
        _close(f"{name} frequency", found.omega[a], wanted.omega[b], rtol, wanted.omega[b])
    largest = float(np.max(wanted.amplitude))
    peaks, others = found.peaks(), wanted.peaks()
    if len(peaks.omega) != len(others.omega):
        raise AssertionError(f"{len(peaks.omega)} peaks, needs {len(others.omega)}")
    for k in range(len(peaks.omega)):
        _close(f"peak {k}: frequency", peaks.omega[k], others.omega[k], rtol, others.omega[k])
        _close(f"peak {k}: amplitude", peaks.amplitude[k], others.amplitude[k], rtol, largest)
    # Distance of points from the broken line of the other curve, in scaled coordinates.
    span = max(float(np.ptp(wanted.omega)), 1e-300)
    line = np.column_stack([wanted.omega / span, wanted.amplitude / largest])
    chosen = np.unique(np.linspace(0, len(found) - 1, samples).astype(int))
    for point in chosen:
        place = np.array([found.omega[point] / span, found.amplitude[point] / largest])
        start, along = line[:-1], np.diff(line, axis=0)
        length = np.maximum(np.sum(along**2, axis=1), 1e-300)
        share = np.clip(np.sum((place - start) * along, axis=1) / length, 0, 1)
        distance = float(np.sqrt(np.min(np.sum((start + share[:, None] * along - place)**2, axis=1))))
        # A chord between points of a curve leaves it by about an eighth of the square of its length.
        chord = float(np.sqrt(np.max(length))) ** 2
        if distance > rtol + chord:
            raise AssertionError(f"point {point} at omega = {found.omega[point]:.6g} is {distance:.2g} of the largest amplitude off "
                                 f"the other curve, needs at most {rtol + chord:.2g}")


def assert_verified(model: Model, branch: Branch, point: Optional[int] = None, tolerance: float = 1e-2) -> None:
    """AssertionError where integration in time finds another motion than a point of a forced response: the first peak, where none
    is named.

    tolerance   of the response, relative.

    >>> import hbvib.testing
    >>> model = hbvib.testing.friction_oscillator()
    >>> hbvib.testing.assert_verified(model, model.forced_response((0.8, 1.6)))
    """
    if point is None:
        peaks = branch.peaks().point
        if not len(peaks):
            raise AssertionError("the branch has no peak: name a point")
        point = int(peaks[0])
    info = model.verify(branch, point).info
    if not info.same_solution or not info.response_error <= tolerance:
        raise AssertionError(f"point {point}: integration in time differs by {info.response_error:.2g}, needs at most {tolerance:.2g}"
                             + ("" if info.same_solution else "; it ended at another motion"))


def _close(name: str, found: float, wanted: float, rtol: float, scale: float) -> None:
    if not abs(found - wanted) <= rtol * abs(scale):
        raise AssertionError(f"{name}: {found:.9g}, needs {wanted:.9g} within {rtol * abs(scale):.2g}")
