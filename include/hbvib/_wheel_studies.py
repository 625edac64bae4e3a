"""Studies of mistuned wheels: peaks of all blades, distributions over random patterns, the worst pattern in a box."""
from __future__ import annotations

import ctypes
import importlib
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union, cast

import numpy as np

from ._analyses import _solver_options
from ._ascent import ascend, foretold
from ._branch import Branch
from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks
from ._convert import _array, _range
from ._errors import ArgumentError, Stopped, UnsupportedError, _sentence
from ._responses import Response, structures
from ._sensitivity import Parameter
from ._structs import _new, _with_options
from ._types import SolverOptions
from ._units import _HasUnits
from ._wheel_results import WheelPeaks, WheelStudy, WorstPattern

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._choices import Mistunings
    from ._model import Model
    from ._results import FloatArray


#: Step of delta in differences: its square is far below what a gradient needs, a peak by its rounding far above.
_DIFFERENCE = 1e-5
#: Most evaluations of an ascent to the worst pattern.
_MOST_SWEEPS = 300
#: Numbers of patterns whose largest blades are predicted at a time.
_NUMBERS_AT_ONCE = 2_000_000
#: A blade as a degree of freedom of a sector, or a Response.
Blade = Union[int, Response]


def _patterns(patterns: ArrayLike, sectors: int, direction: Any) -> FloatArray:
    """Patterns of wheels as `mistune` takes them; ArgumentError that names the first that it does not."""
    given = _array("patterns", patterns, np.float64, (None, sectors))
    needs = "a finite number"
    bad = ~np.isfinite(given)
    if direction is None and not bad.any():
        needs = "at least -1: a share, not a per cent"
        bad = given < -1
    if bad.any():
        wheel, s = np.argwhere(bad)[0]
        raise ArgumentError(f"patterns[{wheel}, {s}] = {given[wheel, s]}, needs {needs}", Status.E_ARGUMENT, 3)
    return cast("FloatArray", given)


class _WheelStudies(_HasUnits):
    """Methods of Model for studies of mistuned wheels."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def wheel_peaks(self, sector: Model, omega: ArrayLike, blade: Blade = 0, *, progress: Any = None, phase: Hook = None,
                    cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> WheelPeaks:
        """The highest peak of each blade of this wheel, which `sector.wheel()` made, and the amplification against the tuned
        one. All blades are watched, so that a tolerance holds for each.

        omega      (start, stop) of the response. Where the highest peak lies beyond an end, so that a blade moves more there than at
                   every peak, the amplification is NaN and branch.message names the end.
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
        # The next call empties it.
        message = _sentence(int(status)) if status else ""
        assert handle.value is not None and kept
        n = sector.ndof
        branch = Branch(handle.value, tuple(self._kept), message, self._units)
        branch._responses = tuple(_of_sector(_blade(blade), s * n) for s in range(sectors))
        ends = np.array([np.max(one.amplitude[[0, -1]]) for one in branch.responses])
        beyond = ends > np.where(np.isfinite(amplitude), amplitude, 0.0)
        return WheelPeaks(amplitude, frequency, error, info.blade, info.tuned, info.amplification, branch, beyond)

    @_with_options("hbvib_solver_options", SolverOptions)
    def wheel_study(self, omega: ArrayLike, patterns: ArrayLike, *, kind: Mistunings = "stiffness",
                    dofs: Optional[ArrayLike] = None, direction: Any = None, blade: Blade = 0, threads: int = 1,
                    progress: Any = None, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                    **solver: Unpack[SolverOptions]) -> WheelStudy:
        """The largest blade of each of many wheels of this sector.

        omega      (start, stop) of each response. A wheel that moves more at an end than at every peak has its highest peak beyond: it
                   has no result, and the status STOPPED_NO_PEAK.
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
        given = _patterns(patterns, sector.sectors, direction)
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        largest, of, at, status = self._largest_blades(
            wheel, parameters, transform(given), omega, _blade(blade), threads=threads, progress=progress, phase=phase, cancel=cancel,
            **solver)
        tuned, predicted = self._predicted(wheel, parameters, transform, given, (kind, dofs, direction), _blade(blade), omega, solver)
        return WheelStudy(largest, of, at, status, tuned, predicted)

    @_with_options("hbvib_solver_options", SolverOptions)
    def worst_pattern(self, omega: ArrayLike, box: float, *, kind: Mistunings = "stiffness", dofs: Optional[ArrayLike] = None,
                      direction: Any = None, blade: Blade = 0, starts: int = 3, seed: int = 0,
                      **solver: Unpack[SolverOptions]) -> WorstPattern:
        """The pattern within -box .. box whose peak of blade 0 is the highest that ascents by exact derivatives find; by the
        symmetry of the wheel the same pattern shifted is as bad for the other blades. First steps go to the bounds along the
        signs of the derivatives, further ones are those of BFGS. An ascent ends where no derivative points into the box (Karush,
        Kuhn and Tucker), or after 300 sweeps: `kkt` tells the gain that is left.

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
        if not (isinstance(box, (int, float, np.number)) and np.isfinite(box) and box > 0):
            raise ValueError(f"box = {box!r}, needs a number above 0")
        if direction is None and box > 1:
            raise ValueError(f"box = {box!r}, needs at most 1: a share, not a per cent")
        if starts < 1:
            raise ValueError(f"starts = {starts}, needs at least 1")
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        watched = _of_sector(_blade(blade), 0)
        tuned = self._peak_of_blade(wheel, parameters, watched, omega, solver)[0]
        random, sweeps, ends = np.random.default_rng(seed), 1, []

        def at(pattern: FloatArray) -> tuple[float, FloatArray, float]:
            nonlocal sweeps
            *found, more = self._with_slope(pattern, (kind, dofs, direction), parameters, transform, watched, omega, solver)
            sweeps += more
            return cast("tuple[float, FloatArray, float]", tuple(found))

        for _ in range(starts):
            ends.append(ascend(at, random.uniform(-box, box, sector.sectors), box, _MOST_SWEEPS))
        pattern, value, gradient, frequency = max(ends, key=lambda end: end.value)
        whitehead = (1 + np.sqrt(sector.sectors)) / 2
        return WorstPattern(pattern, value, frequency, gradient, foretold(pattern, gradient, box) / value, value / tuned,
                            float(whitehead), np.array([end.value for end in ends]), sweeps)

    def _with_slope(self, pattern: FloatArray, mistuning: Any, parameters: Sequence[Parameter], transform: Any, watched: Response,
                    omega: ArrayLike, solver: Any) -> tuple[float, FloatArray, float, int]:
        """Highest peak of a blade of a pattern, its derivatives by delta, its frequency, and the sweeps they took."""
        sector, (kind, dofs, direction) = cast("Model", self), mistuning
        other = sector.wheel()
        other.mistune(sector, kind, pattern, dofs=dofs, direction=direction)
        amplitude, gradient, frequency = self._peak_of_blade(other, parameters, watched, omega, solver)
        if not np.isfinite(gradient).all():
            gradient, more = self._by_differences(pattern, mistuning, watched, omega, solver)
            return amplitude, gradient, frequency, 1 + more
        # By delta instead of the factor on the direction.
        slope = (transform(pattern + 1e-6) - transform(pattern - 1e-6)) / 2e-6
        return amplitude, gradient * slope, frequency, 1

    def _largest_blades(self, wheel: Model, parameters: Sequence[Parameter], values: FloatArray, omega: ArrayLike, blade: Response,
                        **options: Any) -> Any:
        """Highest peak of each wheel, its blade and frequency, and the status of the wheel: STOPPED_NO_PEAK and no peak where that
        lies beyond the range."""
        sector = cast("Model", self)
        watched = [_of_sector(blade, s * sector.ndof) for s in range(sector.sectors)]
        found = wheel.batch(omega, parameters, values, responses=watched, **options)
        of_blades = np.array([peaks.amplitude for peaks in found.responses])
        at = np.array([peaks.omega for peaks in found.responses])
        known = np.where(np.isfinite(of_blades), of_blades, -np.inf)
        largest, each = known.argmax(axis=0), np.arange(len(values))
        ends = np.fmax.reduce([peaks.end_amplitude for peaks in found.responses])
        # The status of a design is that of blade 0.
        solved = (found.status == Status.OK) | (found.status == Status.STOPPED_NO_PEAK)
        beyond = solved & ~(known[largest, each] >= ends)
        status = np.where(beyond, Status.STOPPED_NO_PEAK, np.where(solved, Status.OK, found.status))
        hidden = np.where(beyond, np.nan, 1.0)
        return of_blades[largest, each] * hidden, largest, at[largest, each] * hidden, status

    def _predicted(self, wheel: Model, parameters: Sequence[Parameter], transform: Any, patterns: FloatArray, mistuning: Any,
                   blade: Response, omega: ArrayLike, solver: Any) -> tuple[float, FloatArray]:
        """The peak of the tuned wheel, and the largest blade of each pattern by its derivatives."""
        watched, sectors = _of_sector(blade, 0), patterns.shape[1]
        tuned, gradient, _ = self._peak_of_blade(wheel, parameters, watched, omega, solver)
        if not np.isfinite(gradient).all():
            gradient, _ = self._by_differences(np.zeros(sectors), mistuning, watched, omega, solver)
            # By the parameter instead of delta.
            gradient = gradient * 2e-6 / float(transform(1e-6) - transform(-1e-6))
        # Blade s of a pattern is blade 0 of the pattern that is shifted by s.
        shifted = np.stack([np.roll(gradient, s) for s in range(sectors)])
        parts = np.array_split(patterns, max(1, patterns.size // _NUMBERS_AT_ONCE))
        return tuned, tuned + np.concatenate([(transform(part) @ shifted.T).max(axis=1) for part in parts])

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

    def _by_differences(self, pattern: FloatArray, mistuning: Any, watched: Response, omega: ArrayLike,
                        solver: Any) -> tuple[FloatArray, int]:
        """Derivatives of the highest peak of a blade by delta of each sector, and the sweeps they took: central differences, for
        a peak at which a contact begins to slip or touch, where the exact ones do not exist while those of the peak do."""
        (kind, dofs, direction), sector, gradient = mistuning, cast("Model", self), np.empty(len(pattern))
        for s in range(len(pattern)):
            ends = []
            for sign in (1, -1):
                moved = pattern.copy()
                moved[s] += sign * _DIFFERENCE
                other = sector.wheel()
                other.mistune(sector, kind, moved, dofs=dofs, direction=direction)
                ends.append(self._peak_of_blade(other, (), watched, omega, solver)[0])
            gradient[s] = (ends[0] - ends[1]) / (2 * _DIFFERENCE)
        return gradient, 2 * len(pattern)

    def _peak_of_blade(self, wheel: Model, parameters: Sequence[Parameter], watched: Response, omega: ArrayLike,
                       solver: Any) -> tuple[float, FloatArray, float]:
        """Highest peak of a blade of a wheel, its derivatives by the parameters and its frequency."""
        branch = wheel.forced_response(omega, responses=[watched], **solver)
        if branch.status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(branch.status), branch.status, 0)
        peaks, curve = branch.responses[0].peaks(), branch.responses[0].amplitude
        start, stop = _range("omega", omega, "(0.8, 1.6)")
        if len(peaks.point) == 0:
            why = "widen it" if branch.status == Status.OK else f"the sweep ended early: {_sentence(branch.status)}"
            raise ArgumentError(f"no peak of the watched blade lies within omega = {start} .. {stop}; {why}", Status.E_ARGUMENT, 2)
        best = int(np.argmax(peaks.amplitude))
        if branch.status == Status.OK and max(curve[0], curve[-1]) > peaks.amplitude[best]:
            raise ArgumentError(f"the watched blade moves more at an end of omega = {start} .. {stop}, {max(curve[0], curve[-1]):.6g}, "
                                f"than at its highest peak within, {peaks.amplitude[best]:.6g}: that lies beyond; widen omega",
                                Status.E_ARGUMENT, 2)
        point = int(peaks.point[best])
        try:
            gradient = np.array(wheel.sensitivity(branch, point, parameters, response=0)) if parameters else np.empty(0)
        except UnsupportedError:
            # As of rigid sliders: differences take its place.
            gradient = np.full(len(parameters), np.nan)
        return float(peaks.amplitude[best]), gradient, float(peaks.omega[best])


def _difference(changed: Any, before: Any) -> Any:
    """The difference of two matrices, sparse where scipy is there."""
    found = np.asarray(changed) - np.asarray(before)
    try:
        sparse: Any = importlib.import_module("scipy.sparse")
    except ImportError:
        return found
    return sparse.csc_matrix(found)


def _blade(blade: Blade) -> Response:
    return blade if isinstance(blade, Response) else Response(blade)


def _of_sector(blade: Response, first: int) -> Response:
    """The response of a sector whose degrees of freedom begin at a number."""
    if blade.dofs is None or blade.sector != 0:
        raise ValueError("blade needs dofs of a sector, and sector 0")
    return Response(blade.dofs + first, cast(Any, blade.measure), weights=blade.weights, harmonic=blade.harmonic,
                    component=cast(Any, blade.component))
