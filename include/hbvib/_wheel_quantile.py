"""A far quantile of the largest blade of random wheels, from a few of them that are solved."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional, cast

import numpy as np

from ._c import Status
from ._convert import _array, _range
from ._errors import ArgumentError
from ._order_statistics import screened
from ._structs import _with_options
from ._types import SolverOptions
from ._wheel_results import Quantile
from ._wheel_studies import Blade, _blade, _patterns, _WheelStudies

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._choices import Mistunings
    from ._model import Model
    from ._results import FloatArray, IntArray

#: Share of the range of frequency, on both sides of a peak, in which it is sought again with other options.
_AROUND = 0.03
#: Share of the probability of an error that is left to the correction by other options.
_OF_CORRECTION = 1 / 3


@dataclasses.dataclass(frozen=True)
class WheelQuantile:
    """A quantile of the largest blade of random wheels as amplification; made by Model.wheel_quantile.

    value, lower, upper   the quantile, and an interval that has it with the confidence that was asked for.
    coarse         the quantile and its interval before the correction by `fine`; the same without one.
    ratio, spread  mean of the ratio of the corrected peaks to the others, and half of the interval of another wheel's.
    tuned          peak of the tuned wheel, with `fine` where it was given.
    correlation    of the predictions with the solved wheels that are a fair sample.
    gain           1 / (1 - correlation^2): so many solved wheels alone tell the mean as well as one beside predictions.
    mean, mean_error   amplification of the mean wheel by predictions as control variate, and its standard error.
    wheels         numbers of the patterns that were solved.
    largest        peaks of all wheels, NaN where they were not solved.
    predicted      largest blade of each wheel by the derivatives of the tuned wheel.
    misjudged      wheels that are expected beyond an end of the interval against their prediction.
    corrected      numbers of the wheels that were solved again with `fine`.

    >>> import hbvib
    >>> {field.name for field in __import__("dataclasses").fields(hbvib.WheelQuantile)} >= {"value", "lower", "upper"}
    True
    """
    value: float
    lower: float
    upper: float
    coarse: Quantile
    ratio: float
    spread: float
    tuned: float
    correlation: float
    gain: float
    mean: float
    mean_error: float
    wheels: IntArray
    largest: FloatArray
    predicted: FloatArray
    misjudged: float
    corrected: IntArray

    def __repr__(self) -> str:
        return (f"<hbvib.WheelQuantile: {self.value:.5g}, {self.lower:.5g} to {self.upper:.5g}, "
                f"{len(self.wheels)} of {len(self.predicted)} wheels solved>")

    def plot(self, ax: Any = None) -> Any:
        """Draws the solved wheels over their predictions, and the interval before the correction, with matplotlib. Returns the axes.
        ImportError without matplotlib.

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> patterns = 0.005 * np.random.default_rng(1).standard_normal((500, 8))
        >>> found = sector.wheel_quantile((1.4, 2.0), 0.9, patterns, kind="mass", dofs=[0], first=40, most=100, harmonics=1)
        >>> found.plot().get_ylabel()
        'largest blade'
        """
        from . import _wheel_plots
        return _wheel_plots.quantile(self, ax)


class _Correction(NamedTuple):
    ratio: float
    spread: float
    tuned: float
    wheels: IntArray


class _WheelQuantiles(_WheelStudies):
    """Methods of Model for far quantiles of mistuned wheels."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def wheel_quantile(self, omega: ArrayLike, probability: float, patterns: ArrayLike, *, kind: Mistunings = "stiffness",
                       dofs: Optional[ArrayLike] = None, direction: Any = None, blade: Blade = 0, confidence: float = 0.95,
                       first: int = 200, most: int = 2500, fine: Optional[Mapping[str, Any]] = None, corrected: int = 6,
                       seed: int = 0, threads: int = 1, **solver: Unpack[SolverOptions]) -> WheelQuantile:
        """A quantile of the largest blade of random wheels, with its confidence, of which only those are solved whose predictions by
        the tuned wheel do not tell on which side of the interval they lie. The interval is that of the order of all wheels; how far
        predictions err is known from the solved ones, and their errors are taken to fall exponentially beyond the largest fifth of
        their neighbours. Where predictions are poor, more wheels are solved, and beyond `most` the interval widens.

        omega        (start, stop) of each response.
        probability  that a wheel does not exceed the quantile, 0.999.
        patterns     wheels x sectors: random patterns, drawn independently of each other. More of them cost little.
        kind, dofs, direction, blade, threads   as in wheel_study.
        confidence   of the interval.
        first, most  wheels that are solved first, equally spaced by prediction, and in all.
        fine         options of the solver for a second level, dict(tolerance=1e-2): `corrected` wheels at the quantile are solved
                     again around their peaks. The interval then covers the correction too, with the scatter of its ratio over these
                     wheels (Student's distribution) and the estimated errors of their peaks.
        seed         of the choice of the first wheels. Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> patterns = 0.005 * np.random.default_rng(1).standard_normal((1000, 8))
        >>> found = sector.wheel_quantile((1.4, 2.0), 0.9, patterns, kind="mass", dofs=[0], first=50, most=300, harmonics=1)
        >>> found.lower < found.value < found.upper, len(found.wheels) <= 300
        (True, True)
        """
        sector = cast("Model", self)
        given = _patterns(patterns, sector.sectors, direction)
        _check(probability, confidence, len(given), (first, most), corrected)
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        watched, mistuning = _blade(blade), (kind, dofs, direction)
        tuned, predicted = self._predicted(wheel, parameters, transform, given, mistuning, watched, omega, solver)
        at = np.full(len(given), np.nan)

        def find(wanted: IntArray) -> FloatArray:
            largest, _, at[wanted], status = self._largest_blades(wheel, parameters, transform(given[wanted]), omega, watched,
                                                                  threads=threads, **solver)
            # A response that ended early may lack its highest peak.
            return cast("FloatArray", np.where(status == Status.OK, largest, np.nan))

        alpha = 1 - confidence
        found = screened(predicted, find, probability, alpha * (1 if fine is None else 1 - _OF_CORRECTION), first, most,
                         np.random.default_rng(seed))
        coarse = Quantile(found.value / tuned, found.lower / tuned, found.upper / tuned)
        correction = _Correction(1.0, 0.0, tuned, np.empty(0, np.int64))
        if fine is not None:
            near = np.argsort(np.where(np.isfinite(found.known), abs(found.known - found.value), np.inf), kind="stable")[:corrected]
            correction = self._corrected(near, given, found.known, at, mistuning, watched, omega, dict(fine), alpha * _OF_CORRECTION)
        factor = tuned / correction.tuned
        low, high = (factor * (correction.ratio + sign * correction.spread) for sign in (-1, 1))
        return WheelQuantile(
            coarse.value * factor * correction.ratio, coarse.lower * low, coarse.upper * high, coarse, correction.ratio,
            correction.spread, correction.tuned, *_with_control(found.known, predicted, found.pilot, tuned),
            np.flatnonzero(np.isfinite(found.known)), found.known, predicted, found.misjudged, correction.wheels)

    def _corrected(self, near: IntArray, patterns: FloatArray, known: FloatArray, at: FloatArray, mistuning: Any, blade: Any,
                   omega: ArrayLike, fine: dict[str, Any], alpha: float) -> _Correction:
        """Ratio of the peaks with other options to those before, of wheels at the quantile."""
        sector, (kind, dofs, direction) = cast("Model", self), mistuning
        start, stop = _range("omega", omega, "wheel_quantile((0.8, 1.6), 0.999, patterns)")
        ratios, errors = [], []
        for number in near:
            wheel = sector.wheel()
            wheel.mistune(sector, kind, patterns[number], dofs=dofs, direction=direction)
            width = _AROUND * abs(stop - start)
            while True:
                around = max(at[number] - width, min(start, stop)), min(at[number] + width, max(start, stop))
                peaks = wheel.wheel_peaks(sector, around, blade, **fine)
                highest = np.array([one.amplitude.max() for one in peaks.branch.responses])
                # The highest motion is at a peak within the range, unless that ends on a slope.
                if peaks.blade >= 0 and peaks.amplitude[peaks.blade] >= highest.max() * (1 - 1e-9):
                    break
                if width > abs(stop - start):
                    raise ArgumentError(f"wheel {number} has no peak within omega with the options of fine", Status.E_ARGUMENT, 2)
                width *= 2
            ratios.append(peaks.amplitude[peaks.blade] / known[number])
            errors.append(peaks.error[peaks.blade])
        tuned = self._peak_of_blade(sector, (), blade, omega, fine)[0]
        n, mean = len(ratios), float(np.mean(ratios))
        scatter = float(np.std(ratios, ddof=1)) * np.sqrt(1 + 1 / n)
        told = float(np.nanmax(np.append(errors, 0.0)))
        return _Correction(mean, student(n - 1, 1 - alpha / 2) * scatter + mean * told, tuned, near)


def _check(probability: float, confidence: float, wheels: int, solved: tuple[int, int], corrected: int) -> None:
    first, most = solved
    if not (0 < probability < 1 and 0 < confidence < 1):
        raise ValueError(f"probability = {probability} and confidence = {confidence}, need numbers between 0 and 1")
    if not 10 <= first <= min(most, wheels):
        raise ValueError(f"first = {first}, needs 10 .. {min(most, wheels)}: at most `most` and the number of patterns")
    if not 2 <= corrected <= first:
        raise ValueError(f"corrected = {corrected}, needs 2 .. first = {first}")


def _with_control(known: FloatArray, predicted: FloatArray, sample: IntArray, tuned: float) -> tuple[float, float, float, float]:
    """Correlation of predictions with solved wheels, the gain by it, the mean amplification and its standard error."""
    sample = sample[np.isfinite(known[sample])]
    y, x = known[sample], predicted[sample]
    correlation = float(np.corrcoef(x, y)[0, 1])
    slope = float(np.cov(x, y)[0, 1] / np.var(x, ddof=1))
    left = y - y.mean() - slope * (x - x.mean())
    mean = y.mean() + slope * (predicted.mean() - x.mean())
    variance = left @ left / (len(y) - 2) / len(y) + slope**2 * np.var(predicted) / len(predicted)
    return correlation, 1 / max(1 - correlation**2, 1e-15), float(mean / tuned), float(np.sqrt(variance) / tuned)


def student(degrees: int, probability: float) -> float:
    """Quantile above one half of Student's distribution."""
    # t = tan(a) sqrt(n) has the density cos(a)^(n - 1) over a.
    angle = np.linspace(0, np.pi / 2, 200_001)
    density = np.cos(angle) ** (degrees - 1)
    share = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2)])
    at = float(np.interp(2 * probability - 1, share / share[-1], angle))
    return float(np.tan(at) * np.sqrt(degrees))
