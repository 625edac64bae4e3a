"""Results of studies of mistuned wheels: peaks of all blades, distributions over patterns, the worst pattern."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._c import Status
from ._order_statistics import at_rank, ends

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._branch import Branch
    from ._results import BoolArray, FloatArray


class WheelPeaks(NamedTuple):
    """Highest peak of each blade; made by Model.wheel_peaks.

    amplitude, omega, error   of each blade, NaN where it has none (error: where no tolerance asked for it).
    blade          with the highest one, -1 without any.
    tuned          peak of the tuned wheel; amplification is the highest peak over it, NaN where one of both lies beyond the range.
    branch         the response of the wheel, whose response s is that of blade s.
    beyond         whether a blade moves more at an end of the range than at each of its peaks.

    >>> import hbvib
    >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
    ...                             damping=0.05)
    >>> sector.add_force(0, 0.1)
    >>> peaks = sector.wheel().wheel_peaks(sector, (1.4, 2.0), harmonics=1)
    >>> round(peaks.amplification, 6)
    1.0
    """
    amplitude: FloatArray
    omega: FloatArray
    error: FloatArray
    blade: int
    tuned: float
    amplification: float
    branch: Branch
    beyond: BoolArray

    def envelope(self) -> tuple[FloatArray, FloatArray]:
        """Frequencies of the curve, and the largest response over all blades at each.

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> omega, largest = sector.wheel().wheel_peaks(sector, (1.4, 2.0), harmonics=1).envelope()
        >>> len(omega) == len(largest)
        True
        """
        of_all = np.array([one.amplitude for one in self.branch.responses])
        return np.array(self.branch.omega), of_all.max(axis=0)

    def plot(self, ax: Any = None, *, hertz: bool = False) -> Any:
        """Draws the responses of all blades, the largest at each frequency and the peak of the tuned wheel with matplotlib.
        Returns the axes. ImportError without matplotlib.

        ax, hertz   as in Branch.plot.

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> axes = sector.wheel().wheel_peaks(sector, (1.4, 2.0), harmonics=1).plot()
        >>> axes.get_ylabel()
        'amplitude'
        """
        from . import _wheel_plots
        return _wheel_plots.blades(self, ax, hertz)


class Quantile(NamedTuple):
    """A quantile and an interval that has it with the confidence that was asked for; made by WheelStudy.quantile. An end is
    infinite where there are too few wheels for it.

    >>> import hbvib
    >>> hbvib.Quantile(1.0, 0.9, 1.1).upper
    1.1
    """
    value: float
    lower: float
    upper: float


class WheelWeibull(NamedTuple):
    """A Weibull distribution of maxima with an upper bound, P(A <= x) = exp(-((bound - x) / scale)^shape); made by
    WheelStudy.weibull.

    >>> import hbvib
    >>> round(hbvib.WheelWeibull(bound=2.0, scale=0.5, shape=3.0).quantile(0.999), 6)
    1.949992
    """
    bound: float
    scale: float
    shape: float

    def quantile(self, probability: float) -> float:
        """The value that is not exceeded with a probability.

        >>> import hbvib
        >>> round(hbvib.WheelWeibull(2.0, 0.5, 1.0).quantile(0.5), 6)
        1.653426
        """
        return float(self.bound - self.scale * (-np.log(probability)) ** (1 / self.shape))


class WheelStudy:
    """The largest blade of each of many wheels; made by Model.wheel_study.

    largest, blade, omega   highest peak of each wheel, its blade and its angular frequency.
    status         numbers of Status, one a wheel: OK, or why it has no result; STOPPED_NO_PEAK where its highest peak is beyond the range.
    tuned          peak of the tuned wheel.
    predicted      largest blade of each wheel by the derivatives of the tuned wheel.

    >>> import hbvib
    >>> study = hbvib.WheelStudy([1.1, 1.2, 1.3], [0, 1, 2], [1, 1, 1], [0, 0, 0], 1.0, [1.1, 1.2, 1.29])
    >>> study.amplification.round(2).tolist()
    [1.1, 1.2, 1.3]
    """

    def __init__(self, largest: ArrayLike, blade: ArrayLike, omega: ArrayLike, status: ArrayLike, tuned: float,
                 predicted: ArrayLike) -> None:
        self.largest, self.omega, self.predicted = (np.array(x, float) for x in (largest, omega, predicted))
        self.blade, self.status = np.array(blade, np.int64), np.array(status, np.int64)
        self.tuned = float(tuned)

    def __len__(self) -> int:
        """Number of wheels."""
        return len(self.largest)

    def __repr__(self) -> str:
        known = np.isfinite(self.largest)
        largest = f", amplification up to {self.amplification[known].max():.4g}" if known.any() else ""
        missing = "" if known.all() else f", {np.count_nonzero(~known)} without result"
        beyond = f", {self.beyond} of them with the highest peak beyond the range" if self.beyond else ""
        return f"<hbvib.WheelStudy: {len(self)} wheels{largest}{missing}{beyond}>"

    @property
    def beyond(self) -> int:
        """Number of wheels whose highest peak lies beyond an end of the range: they have no result, and widen the intervals of
        quantiles.

        >>> import hbvib
        >>> import numpy as np
        >>> hbvib.WheelStudy([1.1, np.nan], [0, 0], [1, 1], [0, hbvib.Status.STOPPED_NO_PEAK], 1.0, [1.1, 1.2]).beyond
        1
        """
        return int(np.count_nonzero(self.status == Status.STOPPED_NO_PEAK))

    @property
    def amplification(self) -> FloatArray:
        """Amplification factor of each wheel.

        >>> import hbvib
        >>> hbvib.WheelStudy([1.1], [0], [1], [0], 1.0, [1.1]).amplification
        array([1.1])
        """
        return self.largest / self.tuned

    @property
    def correlation(self) -> float:
        """Correlation of `predicted` with the solved wheels.

        >>> import hbvib
        >>> round(hbvib.WheelStudy([1.1, 1.2], [0, 0], [1, 1], [0, 0], 1.0, [1.1, 1.3]).correlation, 6)
        1.0
        """
        known = np.isfinite(self.largest)
        return float(np.corrcoef(self.predicted[known], self.largest[known])[0, 1])

    def quantile(self, probability: float, confidence: float = 0.95) -> Quantile:
        """The amplification that a wheel does not exceed with a probability, and an interval from the order of the wheels,
        whatever their distribution: the number of wheels below a quantile is binomial. A wheel without result may lie anywhere, so
        that it widens the interval; the value is that of the others.

        >>> import hbvib
        >>> import numpy as np
        >>> study = hbvib.WheelStudy(1 + np.arange(100) / 100, *np.zeros((3, 100)), 1.0, np.zeros(100))
        >>> middle = study.quantile(0.5)
        >>> round(middle.value, 6), round(middle.lower, 6), round(middle.upper, 6)
        (1.495, 1.39, 1.6)
        """
        if not (0 < probability < 1 and 0 < confidence < 1):
            raise ValueError(f"probability = {probability} and confidence = {confidence}, need numbers between 0 and 1")
        values = np.sort(self.amplification[np.isfinite(self.largest)])
        n = len(values)
        if n == 0:
            raise ValueError("no wheel has a result")
        low, high = ends(len(self), probability, (1 - confidence) / 2)
        lower, upper = at_rank(values, low - (len(self) - n)), at_rank(values, high)
        # Beyond the last of few wheels the quantile is not among them.
        return Quantile(float(np.clip(np.quantile(values, probability), lower, upper)), lower, upper)

    def plot(self, ax: Any = None) -> Any:
        """Draws the cumulative distribution of the amplification, and its Weibull distribution, with matplotlib. Returns the axes.
        ImportError without matplotlib.

        >>> import hbvib
        >>> axes = hbvib.WheelStudy([1.1, 1.2, 1.3], [0, 1, 2], [1, 1, 1], [0, 0, 0], 1.0, [1.1, 1.2, 1.29]).plot()
        >>> axes.get_xlabel()
        'amplification'
        """
        from . import _wheel_plots
        return _wheel_plots.distribution(self, ax)

    def plot_patterns(self, ax: Any = None) -> Any:
        """Draws the amplification over the number of the pattern, solved and foretold, with matplotlib. Returns the axes.
        ImportError without matplotlib.

        >>> import hbvib
        >>> axes = hbvib.WheelStudy([1.1, 1.2, 1.3], [0, 1, 2], [1, 1, 1], [0, 0, 0], 1.0, [1.1, 1.2, 1.29]).plot_patterns()
        >>> axes.get_xlabel()
        'pattern'
        """
        from . import _wheel_plots
        return _wheel_plots.patterns(self, ax)

    def weibull(self) -> WheelWeibull:
        """The Weibull distribution of maxima of the greatest likelihood for the amplification (Castanier & Pierre 2006,
        doi:10.2514/1.16345) of the wheels with a result. The bound is sought up to a hundred times the span of the values above
        the largest of them. ValueError with wheels beyond the range, which may be the largest.

        >>> import hbvib
        >>> import numpy as np
        >>> u = (np.arange(2000) + 0.5) / 2000
        >>> study = hbvib.WheelStudy(1.5 - 0.4 * (-np.log(u))**(1 / 3), *np.zeros((3, 2000)), 1.0, np.zeros(2000))
        >>> np.array(study.weibull()).round(1).tolist()
        [1.5, 0.4, 3.0]
        """
        if self.beyond:
            raise ValueError(f"{self.beyond} of {len(self)} wheels have their highest peak beyond the range; widen omega")
        values = np.sort(self.amplification[np.isfinite(self.largest)])
        if len(values) < 3 or values[0] == values[-1]:
            raise ValueError(f"{len(values)} different wheels, needs at least 3")
        span = values[-1] - values[0]
        # Distances of the bound from the largest value, over the span, in logarithms: a coarse search, then a fine one.
        ends = np.log(1e-3), np.log(1e2)
        for _ in range(6):
            trials = np.linspace(*ends, 41)
            fits = [_of_bound(values, values[-1] + span * np.exp(trial)) for trial in trials]
            best = int(np.argmax([fit[0] for fit in fits]))
            ends = trials[max(best - 1, 0)], trials[min(best + 1, 40)]
        return WheelWeibull(float(values[-1] + span * np.exp(trials[best])), *fits[best][1:])


def _of_bound(values: FloatArray, bound: float) -> tuple[float, float, float]:
    """Likelihood, scale and shape of the Weibull distribution of bound - values of the greatest likelihood."""
    y = np.log(bound - values)
    low, high = 1e-2, 1e4
    for _ in range(200):
        shape = np.sqrt(low * high)
        weights = np.exp(shape * (y - y.max()))
        slope = 1 / shape + y.mean() - (weights * y).sum() / weights.sum()
        low, high = (shape, high) if slope > 0 else (low, shape)
    log_scale = y.max() + np.log(np.mean(np.exp(shape * (y - y.max())))) / shape
    z = shape * (y - log_scale)
    return float(np.sum(np.log(shape) - log_scale + (shape - 1) * (y - log_scale) - np.exp(z))), float(np.exp(log_scale)), float(shape)


class WorstPattern(NamedTuple):
    """The worst pattern in a box; made by Model.worst_pattern.

    pattern        delta of each sector, that of the watched blade first.
    amplitude, omega   peak of the watched blade, blade 0.
    gradient       derivatives of that peak by delta.
    kkt            gain, relative to the amplitude, that the gradient still foretells within the box.
    amplification  over the peak of the tuned wheel; `whitehead` is the bound (1 + sqrt(N)) / 2 of linear wheels.
    found          amplitudes that the starts ended at.
    sweeps         responses that were computed.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.WorstPattern(np.zeros(2), 1.0, 1.0, np.zeros(2), 0.0, 1.0, 1.2, np.ones(1), 1).kkt
    0.0
    """
    pattern: FloatArray
    amplitude: float
    omega: float
    gradient: FloatArray
    kkt: float
    amplification: float
    whitehead: float
    found: FloatArray
    sweeps: int

    def plot(self, ax: Any = None) -> Any:
        """Draws the pattern as bars, one a blade, with matplotlib. Returns the axes. ImportError without matplotlib.

        >>> import hbvib
        >>> import numpy as np
        >>> axes = hbvib.WorstPattern(np.array([0.01, -0.01]), 1.0, 1.0, np.zeros(2), 0.0, 1.1, 1.2, np.ones(1), 1).plot()
        >>> axes.get_ylabel()
        'delta / %'
        """
        from . import _wheel_plots
        return _wheel_plots.bars(self, ax)
