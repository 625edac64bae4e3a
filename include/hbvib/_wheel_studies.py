"""Studies of mistuned wheels: peaks of all blades, distributions over random patterns, the worst pattern in a box."""
from __future__ import annotations

import ctypes
import importlib
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Union, cast

import numpy as np

from ._analyses import _solver_options
from ._branch import Branch
from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _range
from ._errors import ArgumentError, _sentence
from ._responses import Response, structures
from ._sensitivity import Parameter
from ._structs import _new, _with_options
from ._types import SolverOptions

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._choices import Mistunings
    from ._model import Model
    from ._results import FloatArray


class WheelPeaks(NamedTuple):
    """Highest peak of each blade; made by Model.wheel_peaks.

    amplitude, omega, error   of each blade, NaN where it has none (error: where no tolerance asked for it).
    blade          with the highest one, -1 without any.
    tuned          peak of the tuned wheel; amplification is the highest peak over it.
    branch         the response of the wheel, whose response s is that of blade s.

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
    1.95
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
    status         numbers of Status, one a wheel: OK, or why it has no result.
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
        return f"<hbvib.WheelStudy: {len(self)} wheels, amplification up to {np.nanmax(self.amplification):.4g}>"

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
        whatever their distribution: the number of wheels below a quantile is binomial.

        >>> import hbvib
        >>> import numpy as np
        >>> study = hbvib.WheelStudy(1 + np.arange(100) / 100, *np.zeros((3, 100)), 1.0, np.zeros(100))
        >>> study.quantile(0.5)
        Quantile(value=1.495, lower=1.39, upper=1.6)
        """
        if not (0 < probability < 1 and 0 < confidence < 1):
            raise ValueError(f"probability = {probability} and confidence = {confidence}, need numbers between 0 and 1")
        values = np.sort(self.amplification[np.isfinite(self.largest)])
        n = len(values)
        if n == 0:
            raise ValueError("no wheel has a result")
        tail = (1 - confidence) / 2
        below = _binomial(n, probability)
        # The r-th of the ordered values lies below the quantile with the probability that at least r wheels do.
        low = int(np.searchsorted(below, tail, side="right"))
        high = int(np.searchsorted(below, 1 - tail, side="left")) + 1
        return Quantile(float(np.quantile(values, probability)), float(values[low - 1]) if low >= 1 else -np.inf,
                        float(values[high - 1]) if high <= n else np.inf)

    def weibull(self) -> WheelWeibull:
        """The Weibull distribution of maxima of the greatest likelihood for the amplification, whose bound is sought up to
        Whitehead's (Castanier & Pierre 2006, doi:10.2514/1.16345).

        >>> import hbvib
        >>> import numpy as np
        >>> u = (np.arange(2000) + 0.5) / 2000
        >>> study = hbvib.WheelStudy(1.5 - 0.4 * (-np.log(u))**(1 / 3), *np.zeros((3, 2000)), 1.0, np.zeros(2000))
        >>> np.array(study.weibull()).round(1).tolist()
        [1.5, 0.4, 3.0]
        """
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


def _binomial(n: int, p: float) -> FloatArray:
    """P(X <= k) of a binomial distribution for k = 0 .. n."""
    k = np.arange(n + 1)
    logs = np.concatenate([[0.0], np.cumsum(np.log(np.arange(1, n + 1)))])
    weights = logs[n] - logs[k] - logs[n - k] + k * np.log(p) + (n - k) * np.log1p(-p)
    return cast("FloatArray", np.cumsum(np.exp(weights)))


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


#: A blade as a degree of freedom of a sector, or a Response.
Blade = Union[int, Response]


class _WheelStudies(_Owner):
    """Methods of Model for studies of mistuned wheels."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def wheel_peaks(self, sector: Model, omega: ArrayLike, blade: Blade = 0, *, progress: Any = None, phase: Hook = None,
                    cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> WheelPeaks:
        """The highest peak of each blade of this wheel, which `sector.wheel()` made, and the amplification against the tuned
        one. All blades are watched, so that a tolerance holds for each.

        omega      (start, stop) of the response.
        blade      what is watched of each sector: a degree of freedom of the sector, or a Response.
        progress, phase, cancel   as in forced_response. Options of the solver; harmonics without tolerance means
        tolerance = 0:

        {options}

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> wheel = sector.wheel()
        >>> wheel.mistune(sector, "mass", [0.02, -0.01, 0.01, 0, -0.02, 0.01, 0, -0.01], dofs=[0])
        >>> wheel.wheel_peaks(sector, (1.4, 2.0), harmonics=1).amplification > 1.05
        True
        """
        start, stop = _range("omega", omega, "wheel_peaks(sector, (0.8, 1.6))")
        chosen = _solver_options("wheel_peaks", solver)
        array, kept = structures([_blade(blade)])
        sectors = sector.sectors
        amplitude, frequency, error = np.empty((3, sectors))
        count, info, handle = ctypes.c_int64(), _new("hbvib_wheel_info"), ctypes.c_void_p()
        with _Guard() as guard:
            hooks = _hooks(guard, progress, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_wheel_peaks", self.handle, sector.handle, array, chosen, start, stop, hooks, sectors, amplitude,
                           frequency, error, count, info, handle, guard=guard)
        assert handle.value is not None and kept
        n = sector.ndof
        branch = Branch(handle.value, tuple(self._kept), _sentence(int(status)) if status else "")
        branch._responses = tuple(_of_sector(_blade(blade), s * n) for s in range(sectors))
        return WheelPeaks(amplitude, frequency, error, info.blade, info.tuned, info.amplification, branch)

    @_with_options("hbvib_solver_options", SolverOptions)
    def wheel_study(self, omega: ArrayLike, patterns: ArrayLike, *, kind: Mistunings = "stiffness",
                    dofs: Optional[ArrayLike] = None, direction: Any = None, blade: Blade = 0, threads: int = 1,
                    progress: Any = None, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                    **solver: Unpack[SolverOptions]) -> WheelStudy:
        """The largest blade of each of many wheels of this sector.

        omega      (start, stop) of each response.
        patterns   wheels x sectors: delta of each sector of each wheel, as `mistune` takes it.
        kind       "stiffness", "frequency", "mass" or "damping", of `dofs` or by `direction`, as in `mistune`.
        blade      what is watched of each sector: a degree of freedom of the sector, or a Response.
        threads    of this call; their number changes no bit of a result.
        progress, phase, cancel   as in `batch`. Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        >>> import hbvib
        >>> import numpy as np
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> patterns = 0.01 * np.random.default_rng(1).standard_normal((20, 8))
        >>> study = sector.wheel_study((1.4, 2.0), patterns, kind="mass", dofs=[0], harmonics=1)
        >>> bool(study.largest.max() > study.tuned), study.quantile(0.5).value > 1
        (True, True)
        """
        sector = cast("Model", self)
        given = _array("patterns", patterns, np.float64, (None, sector.sectors))
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        watched = [_of_sector(_blade(blade), s * sector.ndof) for s in range(sector.sectors)]
        found = wheel.batch(omega, parameters, transform(given), threads=threads, responses=watched, progress=progress, phase=phase,
                            cancel=cancel, **solver)
        of_blades = np.array([peaks.amplitude for peaks in found.responses])
        at = np.array([peaks.omega for peaks in found.responses])
        largest = np.where(np.isfinite(of_blades), of_blades, -np.inf).argmax(axis=0)
        each = np.arange(len(given))
        tuned, gradient, _, _ = self._peak_of_blade(wheel, parameters, watched[0], omega, solver)
        # Blade s of a pattern is blade 0 of the pattern that is shifted by s.
        shifted = np.stack([np.roll(gradient, s) for s in range(sector.sectors)])
        predicted = tuned + (transform(given) @ shifted.T).max(axis=1)
        return WheelStudy(of_blades[largest, each], largest, at[largest, each], found.status, tuned, predicted)

    @_with_options("hbvib_solver_options", SolverOptions)
    def worst_pattern(self, omega: ArrayLike, box: float, *, kind: Mistunings = "stiffness", dofs: Optional[ArrayLike] = None,
                      direction: Any = None, blade: Blade = 0, starts: int = 3, seed: int = 0,
                      **solver: Unpack[SolverOptions]) -> WorstPattern:
        """The pattern within -box .. box whose peak of blade 0 is the highest that ascents by exact derivatives find; by the
        symmetry of the wheel the same pattern shifted is as bad for the other blades. A step goes to the bounds along the
        signs of the derivatives; it ends where no derivative points into the box (Karush, Kuhn and Tucker).

        omega      (start, stop) of each response.
        kind, dofs, direction, blade   as in wheel_study.
        starts     random patterns within the box, from the seed; the best end is returned. Options of the solver; harmonics
                   without tolerance means tolerance = 0:

        {options}

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> worst = sector.worst_pattern((1.4, 2.0), 0.02, kind="mass", dofs=[0], starts=2, harmonics=1)
        >>> worst.kkt < 1e-6, worst.amplification < worst.whitehead
        (True, True)
        """
        sector = cast("Model", self)
        if not (np.isfinite(box) and box > 0):
            raise ValueError(f"box = {box}, needs a number above 0")
        if starts < 1:
            raise ValueError(f"starts = {starts}, needs at least 1")
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        watched = _of_sector(_blade(blade), 0)
        tuned = self._peak_of_blade(wheel, parameters, watched, omega, solver)[0]
        random, sweeps, ends = np.random.default_rng(seed), 1, []

        def at(pattern: FloatArray) -> tuple[float, FloatArray, float]:
            nonlocal sweeps
            sweeps += 1
            other = sector.wheel()
            other.mistune(sector, kind, pattern, dofs=dofs, direction=direction)
            amplitude, gradient, frequency, _ = self._peak_of_blade(other, parameters, watched, omega, solver)
            # By delta instead of the factor on the direction.
            slope = (transform(pattern + 1e-6) - transform(pattern - 1e-6)) / 2e-6
            return amplitude, gradient * slope, frequency

        for _ in range(starts):
            pattern = random.uniform(-box, box, sector.sectors)
            value, gradient, frequency = at(pattern)
            radius = box
            while radius > 1e-9 * box:
                gain = _foretold(pattern, gradient, box)
                if gain <= 1e-9 * value:
                    break
                trial = np.clip(pattern + radius * np.sign(gradient), -box, box)
                found = at(trial)
                if found[0] > value:
                    pattern, (value, gradient, frequency) = trial, found
                    radius = min(1.5 * radius, 2 * box)
                else:
                    radius /= 3
            ends.append((value, pattern, gradient, frequency))
        value, pattern, gradient, frequency = max(ends, key=lambda end: end[0])
        whitehead = (1 + np.sqrt(sector.sectors)) / 2
        return WorstPattern(pattern, value, frequency, gradient, _foretold(pattern, gradient, box) / value, value / tuned,
                            float(whitehead), np.array([end[0] for end in ends]), sweeps)

    def _directions(self, kind: Mistunings, dofs: Optional[ArrayLike], direction: Any) -> Any:
        """The tuned wheel, one parameter a sector, and the values of the parameters for a pattern."""
        sector = cast("Model", self)
        names = {"stiffness": "stiffness", "frequency": "stiffness", "mass": "mass", "damping": "damping"}
        if kind not in names:
            raise ArgumentError(f"kind = {kind!r}, needs stiffness, frequency, mass or damping", Status.E_ARGUMENT, 3)
        name = names[cast(str, kind)]
        wheel, parameters = sector.wheel(), []
        before = wheel.matrix(cast(Any, name))
        for s in range(sector.sectors):
            pattern = np.zeros(sector.sectors)
            pattern[s] = 1.0
            one = sector.wheel()
            one.mistune(sector, cast(Any, name), pattern, dofs=dofs, direction=direction)
            parameters.append(Parameter(cast(Any, name), direction=_difference(one.matrix(cast(Any, name)), before)))
        return wheel, parameters, (lambda x: (1 + x) ** 2 - 1) if kind == "frequency" else (lambda x: x)

    def _peak_of_blade(self, wheel: Model, parameters: Sequence[Parameter], watched: Response, omega: ArrayLike,
                       solver: Any) -> tuple[float, FloatArray, float, Branch]:
        """Highest peak of a blade of a wheel, its derivatives by the parameters and its frequency."""
        branch = wheel.forced_response(omega, responses=[watched], **solver)
        peaks = branch.responses[0].peaks()
        if len(peaks.point) == 0:
            raise ArgumentError("no peak of the watched blade lies within omega", Status.E_ARGUMENT, 2)
        best = int(np.argmax(peaks.amplitude))
        point = int(peaks.point[best])
        gradient = wheel.sensitivity(branch, point, parameters, response=0)
        return float(peaks.amplitude[best]), np.array(gradient), float(peaks.omega[best]), branch


def _difference(changed: Any, before: Any) -> Any:
    """The difference of two matrices, sparse where scipy is there."""
    found = np.asarray(changed) - np.asarray(before)
    try:
        sparse: Any = importlib.import_module("scipy.sparse")
    except ImportError:
        return found
    return sparse.csc_matrix(found)


def _foretold(pattern: FloatArray, gradient: FloatArray, box: float) -> float:
    """Gain that the gradient foretells within the box."""
    return float(np.sum(np.where(gradient > 0, gradient * (box - pattern), -gradient * (box + pattern))))


def _blade(blade: Blade) -> Response:
    return blade if isinstance(blade, Response) else Response(blade)


def _of_sector(blade: Response, first: int) -> Response:
    """The response of a sector whose degrees of freedom begin at a number."""
    if blade.dofs is None or blade.sector != 0:
        raise ValueError("blade needs dofs of a sector, and sector 0")
    return Response(blade.dofs + first, cast(Any, blade.measure), weights=blade.weights, harmonic=blade.harmonic,
                    component=cast(Any, blade.component))
