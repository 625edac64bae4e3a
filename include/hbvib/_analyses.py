"""Branches of a model: forced responses, nonlinear modes, responses over a parameter."""
from __future__ import annotations

import ctypes
import warnings
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from ._branch import Branch
from ._c import DampingForm, Flexibility, Follow, LogLevel, Stability, Status
from ._calls import _call, _Guard, _hooks, _stoppable
from ._convert import _array, _counted_array, _diameter, _member, _range
from ._errors import StoppedEarly, _sentence
from ._matrices import _Matrices
from ._origin import Origin
from ._responses import Response, Responses, described, listed
from ._results import Progress, Residual
from ._structs import _new, _options, _with_options
from ._types import SolverOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._choices import DampingForms, Follows, LogLevels
    from ._sensitivity import Parameter


def _solver_options(caller: str, given: Mapping[str, Any]) -> Any:
    """The struct of the options of the solver."""
    chosen = dict(given)
    if "harmonics" in chosen:
        chosen.setdefault("tolerance", 0.0)  # so many and no other, unless a tolerance is named as well
    for name, kind in (("flexibility", Flexibility), ("stability", Stability)):
        if name in chosen:
            chosen[name] = _member(kind, chosen[name])
    return _options(caller, "hbvib_solver_options", chosen)


class _Analyses(_Matrices):
    """Methods of Model that follow branches."""

    def _solve(self, name: str, solver: Any, options: Any, at: Optional[ArrayLike], hooks: tuple[Any, ...],
               responses: Sequence[Response] = ()) -> Branch:
        settings = _solver_options(name[6:], solver)
        handle, kept = ctypes.c_void_p(), self._kept
        origin = None if name == "hbvib_parameter_response" else Origin.of(self.handle, settings.samples)
        with _Guard() as guard:
            status = _call(name, self.handle, settings, options, _hooks(guard, *hooks), handle, guard=guard)
            if handle.value:
                guard.branch = branch = Branch(handle.value, tuple(kept), _sentence(status) if status else "", self._units)
                branch._at = np.array([] if at is None else at, float, ndmin=1)
                branch._origin = origin
                branch._responses = tuple(responses)
        if status > Status.STOPPED_BY_CALLER:
            try:
                warnings.warn(StoppedEarly(branch.message, branch.status), stacklevel=3)
            except StoppedEarly as warning:
                warning.branch = branch  # type: ignore[attr-defined]
                raise
        return branch

    @_with_options("hbvib_solver_options", SolverOptions)
    def forced_response(self, omega: ArrayLike, *, at: Optional[ArrayLike] = None, guess: Optional[ArrayLike] = None,
                        responses: Optional[Responses] = None, together: bool = False, branches: int = 0,
                        branch_depth: int = 0, most_branches: int = 0,
                        progress: Union[bool, Callable[[Progress], Any], None] = None,
                        log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                        cancel: Optional[CancelFlag] = None,
                        phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows the periodic response over a range of frequency.

        omega     (start, stop) in rad per time unit, downward where stop is the lower; or one frequency.
        at        frequencies within the range at which every solution is computed exactly: Branch.at.
        guess     start values, (H + 1, ndof) complex with an H of their own, such as Branch.harmonics gives. Harmonics that
                  forces and laws do not excite by themselves (a subharmonic, a mean) are carried where the guess has them.
        responses what is watched, a list of Response or of degrees of freedom: Branch.responses. The first one leads
                  amplitude and peaks of the branch, and a tolerance holds for each.
        together  the tolerance holds for all responses in one norm, instead of for each.
        branches  1: seek branches of the double period, of broken symmetry and at simple branch points, 2: detached curves,
                  too, 3: those over the force and subharmonic curves, too, 4: those that deflation finds, too, with stability
                  along all of them: Branch.children. branch_depth: most generations, 0: 3. most_branches: 0: 32.
        progress  progress(Progress) after each point: False, or raising StopIteration, stops and keeps the points. True
                  shows a bar of tqdm, or a line on stderr where that is not installed.
        log       log(LogLevel, text), lines up to log_level.
        phase     phase(Phase, share) in all phases from the set-up on: False, or raising StopIteration, stops.
        cancel    a CancelFlag.
        Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        Warns of StoppedEarly where the range was not covered. NumericalError where no solution was found, ArgumentError
        or OutOfRangeError for wrong options. `Branch.reduction` has the size of the problem that was solved.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6), at=[1.0])
        >>> print("%.4f" % branch.amplitude.max(), branch.at(0).amplitude.round(4))
        0.5835 [0.2]
        """
        start, stop = _range("omega", omega, "forced_response((0.8, 1.6), at=omega)", single=True)
        options = _new("hbvib_forced_options", omega_start=start, omega_stop=stop, together=int(bool(together)),
                       branches=branches, branch_depth=branch_depth, most_branches=most_branches, **_counted_array("at", at),
                       **_counted_array("guess", guess, np.complex128, [None, self.ndof]))
        watched = listed(responses)
        described(options, watched)
        return self._solve("hbvib_forced_response", solver, options, at, (progress, log, log_level, cancel, phase), watched)

    @_with_options("hbvib_solver_options", SolverOptions)
    def nonlinear_mode(self, log10_amplitude: Sequence[float], *, at: Optional[ArrayLike] = None,
                       shape: Optional[ArrayLike] = None, damping_form: DampingForms = DampingForm.MASS,
                       diameter: Optional[int] = None, mode_index: int = 0, near_omega: float = 0, amplitude_contact: int = -1,
                       reference_dof: int = -1, guess: Optional[ArrayLike] = None, guess_omega: float = 0,
                       guess_damping: float = 0, branches: int = 0, branch_depth: int = 0, most_branches: int = 0,
                       progress: Union[bool, Callable[[Progress], Any], None] = None,
                       log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                       cancel: Optional[CancelFlag] = None,
                       phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows a nonlinear mode over a range of amplitude: frequency and damping ratio against it.

        log10_amplitude   (start, stop), rising: of sqrt(X_1^H M X_1), or with amplitude_contact of |Y_1| of a contact.
        at                log10 of amplitudes at which every solution is computed exactly.
        mode_index, near_omega, shape   the linear mode to start from: by number, frequency or likeness (ndof complex).
        guess, guess_omega, guess_damping   a motion near the first point with its frequency and damping ratio, such as a
                          point of another mode: branch.harmonics(p), branch.omega[p], branch.damping_ratio[p].
        branches          1: seek the curves of its branch points (Branch.bifurcations) and the one beyond a tongue of internal
                          resonance: Branch.children. branch_depth: most generations, 0: 3. most_branches: 0: 32.
        damping_form      "mass" or "stiffness".     reference_dof   -1: chosen by the library.
        diameter          signed nodal diameter of the wave, modulo the sectors; None: that of the engine order.
        progress, log, log_level, cancel, phase   as in forced_response.
        Options of the solver, as there:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> print("%.4f %.4f" % (mode.omega[0], mode.omega[-1]))  # stuck: sqrt(2), free: 1
        1.4142 1.0043
        """
        start, stop = _range("log10_amplitude", log10_amplitude, "nonlinear_mode((-6, -2), at=log10_amplitude)")
        options = _new("hbvib_mode_options", log10_start=start, log10_stop=stop, diameter=_diameter(diameter),
                       damping_form=_member(DampingForm, damping_form), mode_index=mode_index, near_omega=near_omega,
                       amplitude_contact=amplitude_contact, reference_dof=reference_dof, **_counted_array("at", at),
                       guess_omega=guess_omega, guess_damping=guess_damping, branches=branches, branch_depth=branch_depth,
                       most_branches=most_branches, **_counted_array("guess", guess, np.complex128, [None, self.ndof]),
                       **_counted_array("shape", shape, np.complex128, [self.ndof]))
        return self._solve("hbvib_nonlinear_mode", solver, options, at, (progress, log, log_level, cancel, phase))

    @_with_options("hbvib_solver_options", SolverOptions)
    def parameter_response(self, parameter: Parameter, values: Sequence[float], *, omega: float,
                           follow: Follows = Follow.OMEGA, at: Optional[ArrayLike] = None,
                           response: Union[Response, int, None] = None, log10_amplitude: Sequence[float] = (0, 0),
                           progress: Union[bool, Callable[[Progress], Any], None] = None,
                           log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                           cancel: Optional[CancelFlag] = None,
                           phase: Hook = None, **solver: Unpack[SolverOptions]) -> Branch:
        """Follows a result over a parameter: Branch.parameter_values, .amplitude, .d_amplitude (of a mode .damping_ratio
        and .d_damping), .optima, .turns and .higher_peaks.

        values    (start, stop), downward where stop is the lower: of a constant or of the speed the value itself, of a
                  factor 1 as at present, of a direction its coefficient.
        omega     the frequency held, or one within a tenth of which the peak or fold next to it is sought at the start,
                  or one near the linear mode with stuck contacts.
        follow    "omega": the response at this frequency; "peak": the peak; "fold": a fold over the frequency;
                  "peak_through_folds": the peak, and beyond the value at which it vanishes the minimum that it meets;
                  "mode_max_damping": the largest damping ratio along a nonlinear mode.
        at        values within the range at which every solution is computed exactly: Branch.at.
        response  the Response that is followed, or a degree of freedom; None: the amplitude of the response dof.
        log10_amplitude   of the modal amplitudes between which the maximum of damping is sought at the start; equal ones:
                  from the onset of slip to a thousand times its amplitude.
        The rest as in forced_response. Options of the solver:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("preload"), (0.3, 2), omega=1.0, follow="peak", harmonics=9)
        >>> optima = found.optima()
        >>> optima.kind.tolist()
        ['minimum']
        """
        start, stop = _range("values", values, "parameter_response(parameter, (1, 2), at=values)")
        changed = parameter._description()
        options = _new("hbvib_parameter_options", start=start, stop=stop, omega=omega, follow=_member(Follow, follow),
                       log10_start=log10_amplitude[0], log10_stop=log10_amplitude[1],
                       **_counted_array("at", at))
        options.changed = changed  # kept as long as the struct
        options.parameter = ctypes.addressof(changed)
        described(options, listed(None if response is None else [response]), single=True)
        return self._solve("hbvib_parameter_response", solver, options, at, (progress, log, log_level, cancel, phase))

    def forced_residual(self, omega: float, x: ArrayLike, *, jacobian: bool = False, d_omega: bool = False,
                        samples: int = 0, phase: Hook = None,
                        cancel: Optional[CancelFlag] = None) -> Residual:
        """Residual of harmonic balance at x, (H + 1, ndof) complex: an array like x; with jacobian the real matrix
        d R / d X over the pairs (re, im), of order 2 x.size; with d_omega an array like x; else None.

        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import numpy as np
        >>> x = np.zeros((2, 1), complex)  # harmonics 0 and 1 of one degree of freedom, at rest
        >>> model.forced_residual(1.0, x).residual[1]
        array([-0.2+0.j])
        """
        x = _array("x", x, np.complex128, [None, self.ndof])
        solver = _new("hbvib_solver_options", harmonics=len(x) - 1, samples=samples)
        residual = np.empty_like(x)
        matrix = np.empty((2 * x.size,) * 2, order="F") if jacobian else None
        slope = np.empty_like(x) if d_omega else None
        _stoppable("hbvib_forced_residual", self.handle, solver, omega, x, x.size, residual, x.size, matrix,
                   0 if matrix is None else matrix.size, slope, x.size if d_omega else 0, phase=phase, cancel=cancel)
        return Residual(residual, matrix, slope)
