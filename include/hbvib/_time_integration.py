"""Periodic motions by integration in time: responses, checks of points, Floquet multipliers."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._c import Grazing, LogLevel, MultiplierClass, Status, SteadyMethod, Waves
from ._calls import _call, _Guard, _hooks
from ._contacts import _Contacts
from ._convert import _counted_array, _member
from ._matrices import _Matrices
from ._results import Floquet, Progress, TimeResponse, Verification
from ._structs import _new, _options, _record, _with_options
from ._types import FloquetOptions, Kick, TimeInfo, TimeOptions, VerificationInfo, VerifyOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._choices import LogLevels, SteadyMethods, WaveSets


class _TimeIntegration(_Matrices, _Contacts):
    """Methods of Model that integrate in time."""

    @_with_options("hbvib_time_options", TimeOptions)
    def time_response(self, omega: float, *, harmonics: int = 9, samples: int = 0,
                      method: SteadyMethods = SteadyMethod.SHOOTING, start: Optional[ArrayLike] = None,
                      progress: Union[bool, Callable[[Progress], Any], None] = None,
                      log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                      cancel: Optional[CancelFlag] = None,
                      phase: Hook = None, **options: Unpack[TimeOptions]) -> TimeResponse:
        """The periodic response at one frequency by integration in time: a check of any point of a branch.

        start      (H + 1, ndof) complex motion to start from, such as Branch.harmonics gives; None: rest.
        method     "shooting" or "marching".
        harmonics, samples   highest harmonic of the result; equidistant times a period at which the motion is returned.
        {options}
        progress   after each period; log, log_level, cancel and phase as in forced_response.
        Returns harmonics (harmonics + 1, ndof) complex, samples (samples, ndof) at equidistant times, info, places of the
        sliders of all contacts at the end (for set_slider), and status:
        STOPPED_BY_CALLER where the results are those of the last period, not steady, or NaN after cancel.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> found = model.time_response(1.0)
        >>> print("%.4f" % abs(found.harmonics[1, 0]))
        0.2000
        """
        settings = _options(
            "time_response", "hbvib_time_options", options, "start start_len places places_len", omega=omega, harmonics=harmonics,
            samples=samples, method=_member(SteadyMethod, method),
            **_counted_array("start", start, np.complex128, [None, self.ndof]))
        shapes = (max(settings.harmonics, -1) + 1, self.ndof), (max(settings.samples, 0), self.ndof)
        x, times, info = np.empty(shapes[0], complex), np.empty(shapes[1]), _new("hbvib_time_info")
        places = np.empty(self.contacts)
        if places.size:
            settings.places, settings.places_len = places.ctypes.data, places.size
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_time_response", self.handle, settings, hooks, x, x.size,
                           times if times.size else None, times.size, info, guard=guard)
        return TimeResponse(x, times, _record(TimeInfo, info), Status(status), places)

    @_with_options("hbvib_verify_options", VerifyOptions)
    def verify(self, branch: Branch, point: int, *, method: SteadyMethods = SteadyMethod.SHOOTING,
               progress: Union[bool, Callable[[Progress], Any], None] = None,
               log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
               cancel: Optional[CancelFlag] = None,
               phase: Hook = None, **options: Unpack[VerifyOptions]) -> Verification:
        """How far a point of a forced response of this model is from the motion that integration in time finds from it.

        method     "shooting" or "marching".
        {options}
        progress   after each period; the rest as in forced_response.
        Returns harmonics (H + 1, ndof) complex in time, errors (H + 1), info, whose response_error is that of the
        response and whose same_solution is False where the integration ended far from the point, and status:
        STOPPED_BY_CALLER where all of it compares with the last period, not steady, or is NaN after cancel.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> peak = branch.peaks().point[0]
        >>> found = model.verify(branch, peak)
        >>> found.info.same_solution, found.info.response_error < 1e-3
        (True, True)
        """
        settings = _options("verify", "hbvib_verify_options", options, method=_member(SteadyMethod, method))
        rows = branch.reduction.harmonics_asked + 1
        x, errors, info = np.empty((rows, self.ndof), complex), np.empty(rows), _new("hbvib_verification")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_verify", self.handle, branch.handle, point, settings, hooks, x, x.size, errors,
                           errors.size, info, guard=guard)
        return Verification(x, errors, _record(VerificationInfo, info), Status(status))

    def smallest_kick(self, branch: Branch, point: int, saddle: int, *, saddle_branch: Optional[Branch] = None,
                      dof: int, phases: int = 16, phase: Hook = None,
                      cancel: Optional[CancelFlag] = None) -> Kick:
        """The smallest impulse at a degree of freedom that leads from a stable point to another motion: an estimate from the
        saddle between, and a bracket by integration in time. Smaller kicks at other times or in other directions may exist.

        point          the stable point; saddle: an unstable one at the same frequency with one unstable direction.
        saddle_branch  the branch of the saddle, such as a child; None: the same one.
        dof            of the impulse.     phases: times of a period that are examined.
        phase, cancel  as in forced_response; where they stop it the kick is the smallest until then, and not verified.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> contact = model.add_spring_damper(0, spring=[0, 0, 0.1])
        >>> model.add_force(0, 0.18)
        >>> branch = model.forced_response((0.9, 1.3), at=[1.1017664364])
        >>> upper, saddle, lower = branch.at(0).point
        >>> kick = model.smallest_kick(branch, int(lower), int(saddle), dof=0, phases=4)
        >>> kick.verified, kick.returning / kick.impulse > 0.998
        (True, True)
        """
        other = branch if saddle_branch is None else saddle_branch
        found = _new("hbvib_kick")
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            _call("hbvib_smallest_kick", self.handle, branch.handle, point, other.handle, saddle, dof, phases, hooks, found,
                  guard=guard)
        return _record(Kick, found)

    @_with_options("hbvib_floquet_options", FloquetOptions)
    def floquet(self, branch: Branch, point: int, *, waves: WaveSets = Waves.WAVE, refine: bool = True,
                progress: Union[bool, Callable[[Progress], Any], None] = None,
                log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                cancel: Optional[CancelFlag] = None,
                phase: Hook = None, **options: Unpack[FloquetOptions]) -> Floquet:
        """The Floquet multipliers of a point of this model: the motion is unstable where radius > 1.

        waves      "wave": perturbations of the kind of the wave itself; "wheel": all of the wheel.
        refine     move the point to the periodic motion in time first.
        {options}
        progress   after each period of shooting; the rest as in forced_response.
        A point of a nonlinear mode must be a limit cycle, damping ratio zero.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> found = model.floquet(branch, branch.peaks().point[0])
        >>> found.radius < 1  # stable
        True
        """
        settings = _options("floquet", "hbvib_floquet_options", options, waves=_member(Waves, waves), refine=int(refine))
        most = self.sectors * (2 * self.ndof + self.contacts)
        mu, classes, info = np.empty(most, complex), np.empty(most, np.int64), _new("hbvib_floquet_info")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_floquet", self.handle, branch.handle, point, settings, hooks, mu, mu.size, classes,
                           classes.size, info, guard=guard)
        names = np.array([MultiplierClass(number).name.lower() for number in classes[:info.count]], dtype="U13")
        reasons = {Grazing.NONE: "", Grazing.SLIP_LIMIT: "the force of contact {} touches its slip limit",
                   Grazing.LANDING: "contact {} closes without normal speed"}
        reason = reasons[Grazing(info.grazing)].format(info.grazing_contact)
        return Floquet(mu[:info.count], names, info.radius, info.unstable, info.neutral, info.orbit_change, info.omega,
                       info.residual, reason, info.modes, info.modes_change, Status(status), info.radius_error)
