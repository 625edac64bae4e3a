"""Points of a branch: motions, loops, energies, special points, synthesised responses."""
from __future__ import annotations

import contextlib
import ctypes
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, cast

import numpy as np

from ._c import Bifurcation, Field
from ._calls import _call, _Owner, _stoppable
from ._convert import _whole
from ._errors import ArgumentError
from ._results import Bifurcations, HigherPeaks, LimitCycles, Loop, Optima, Points, Synthesis, SynthesisPeaks, Turns, Wanted
from ._stored_point import StoredPoint
from ._structs import _new, _options, _record, _Record, _with_options
from ._types import ContactSummary, Energy, ModeInfo, ModePoint, Reduction, SynthesisOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._model import Model
    from ._results import ComplexArray, FloatArray, IntArray


class _BranchPoints(_Owner):
    """Methods of Branch for one point, and for lists of special points."""

    _at: FloatArray = np.empty(0)  # entries of the solve's `at`

    def _filled(self, record: type[_Record], *arguments: Any, name: str) -> _Record:
        """The record that a function of the branch fills."""
        struct = _new("hbvib_" + name)
        self._call("hbvib_branch_" + name, *arguments, struct)
        return _record(record, struct)

    @property
    def reduction(self) -> Reduction:
        """Size of the problem that was solved, and the parts that were removed from it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.reduction.unknowns > 0, branch.reduction.contacts
        (True, 1)
        """
        return self._filled(Reduction, name="reduction")

    @property
    def mode_info(self) -> ModeInfo:
        """Where a nonlinear mode started. UnsupportedError for a forced response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> print("%.4f" % model.nonlinear_mode((-2, 1)).mode_info.omega)  # sqrt(2)
        1.4142
        """
        return self._filled(ModeInfo, name="mode_info")

    def mode_point(self, point: int) -> ModePoint:
        """Numbers of a point of a nonlinear mode.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> peak = mode.peaks().point[0]
        >>> print("%.3f" % mode.mode_point(peak).damping_ratio)
        0.120
        """
        return self._filled(ModePoint, point, name="mode_point")

    def energy(self, point: int, *, phase: Hook = None,
               cancel: Optional[CancelFlag] = None) -> Energy:
        """Energies and losses of a point.

        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> energy = branch.energy(branch.peaks().point[0])
        >>> print("%.3f" % energy.friction_loss)
        0.340
        """
        energy = _new("hbvib_energy")
        _stoppable("hbvib_branch_energy", self.handle, point, energy, phase=phase, cancel=cancel)
        return _record(Energy, energy)

    def summary(self, point: int, contact: int, *, phase: Hook = None,
                cancel: Optional[CancelFlag] = None) -> ContactSummary:
        """Work, shares of the period, ranges and loads of a contact at a point. phase, cancel: as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> summary = branch.summary(branch.peaks().point[0], 0)
        >>> print("%.3f %.3f" % (summary.work, summary.slip_share))
        0.340 0.501
        """
        summary = _new("hbvib_contact_summary")
        _stoppable("hbvib_branch_contact_summary", self.handle, point, contact, summary, phase=phase, cancel=cancel)
        return _record(ContactSummary, summary)

    def harmonics(self, point: int, first_dof: int = 0, n_dof: Optional[int] = None, *,
                  phase: Hook = None,
                  cancel: Optional[CancelFlag] = None) -> ComplexArray:
        """Harmonics 0 .. H at a point, (H + 1, n_dof) complex, a copy; n_dof None: all from first_dof on.

        phase, cancel   as in forced_response; Stopped is raised where they stop it. So in the methods below.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> x = branch.harmonics(branch.peaks().point[0])
        >>> print("%.4f" % abs(x[1, 0]))
        0.5836
        """
        reduction = self.reduction
        if n_dof is None:
            n_dof = max(reduction.degrees_of_freedom - _whole(first_dof), 1)
        x = np.empty((reduction.harmonics_asked + 1, n_dof), complex)
        _stoppable("hbvib_branch_harmonics", self.handle, point, first_dof, n_dof, x, x.size, phase=phase,
                   cancel=cancel)
        return x

    def slip(self, point: int) -> FloatArray:
        """Shares of the period that each contact slips at any stored point, (contacts).

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.slip(branch.peaks().point[0]).round(3)
        array([0.501])
        """
        shares = np.empty(self.reduction.contacts)
        self._call("hbvib_branch_slip_fraction", point, shares, shares.size)
        return shares

    def time_history(self, point: int, dof: int, n: int = 256, *,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> FloatArray:
        """Motion of a degree of freedom over one period at a point, n equidistant times.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.time_history(branch.peaks().point[0], 0, 4).round(3)
        array([ 0.01 ,  0.584, -0.01 , -0.584])
        """
        x = np.empty(n)
        _stoppable("hbvib_branch_time_history", self.handle, point, dof, n, x, phase=phase, cancel=cancel)
        return x

    def loop(self, point: int, contact: int, direction: int = 0, n: int = 256, *,
             phase: Hook = None,
             cancel: Optional[CancelFlag] = None) -> Loop:
        """Hysteresis loop of a contact over one period at a point: motion, force and state (State), n each.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> loop = branch.loop(branch.peaks().point[0], 0)
        >>> print("%.2f" % loop.force.max())  # mu preload
        0.30
        """
        motion, force, state = np.empty(n), np.empty(n), np.empty(n, np.int32)
        _stoppable("hbvib_branch_contact_loop", self.handle, point, contact, direction, n, motion, force, state,
                   phase=phase, cancel=cancel)
        return Loop(motion, force, state)

    def peaks(self) -> Points:
        """Maxima of the amplitude, in a nonlinear mode of the damping ratio: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.peaks().omega.round(4)
        array([1.232])
        """
        return Points(*self._listed("hbvib_branch_peaks", (), [float, float, np.int64]))

    def folds(self) -> Points:
        """Turning points in frequency, in a nonlinear mode in amplitude: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> len(branch.folds().omega)
        0
        """
        return Points(*self._listed("hbvib_branch_folds", (), [float, float, np.int64]))

    def bifurcations(self) -> Bifurcations:
        """Folds of a forced response and, with its option `stability`, the other points where a multiplier passes the
        unit circle: omega, amplitude, kind ("fold", "period_doubling", "neimark_sacker" or "branch_point"), point
        number, numbers of unstable directions before and after it along the branch, -1 where unknown.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> contact = model.add_spring_damper(0, spring=[0, 0, 0.1])
        >>> model.add_force(0, 0.18)
        >>> branch = model.forced_response((0.9, 1.3), stability="wave")
        >>> branch.bifurcations().kind.tolist(), branch.bifurcations().unstable_after.tolist()
        (['fold', 'fold'], [1, 0])
        """
        omega, amplitude, kind, *rest = self._listed("hbvib_branch_bifurcations", (),
                                                     [float, float, np.int64, np.int64, np.int64, np.int64])
        names = np.array([Bifurcation(k).name.lower() for k in kind], dtype="U15")
        return Bifurcations(omega, amplitude, names, *rest)

    def optima(self) -> Optima:
        """Minima and maxima over the parameter of a parameter response: value of the parameter, amplitude (of a mode the
        damping ratio), kind ("minimum" or "maximum"), point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, harmonics=1)
        >>> found.optima().kind.tolist()  # the amplitude only rises
        []
        """
        found = self._listed("hbvib_branch_optima", (), [float, float, np.int64, np.int64])
        return Optima(found[0], found[1], np.where(found[2] == 1, "maximum", "minimum"), found[3])

    def turns(self) -> Turns:
        """Points at which a parameter response turns, beyond whose values its result does not exist: value of the parameter,
        omega, amplitude, kind ("minimum" or "maximum" of the parameter), point number. Over the force, with follow
        "peak_through_folds" or "fold": forces at which a detached curve is born, or merges with another one.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
        >>> contact = model.add_spring_damper(0, damper=[0, 0, -0.05, 0, 0.012])
        >>> model.add_force(0, 0.015)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (0.3, 2), omega=1.0, follow="peak_through_folds", harmonics=1)
        >>> found.turns().kind.tolist(), (0.015 * found.turns().parameter).round(8).tolist()
        (['maximum', 'minimum'], [0.02346897, 0.00492012])
        """
        found = self._listed("hbvib_branch_turns", (), [float, float, float, np.int64, np.int64])
        return Turns(found[0], found[1], found[2], np.where(found[3] == 1, "maximum", "minimum"), found[4])

    def higher_peaks(self) -> HigherPeaks:
        """Peaks that are higher than the one that a parameter response follows: value of the parameter, omega, amplitude,
        point number of the followed peak. They are sought at the first and the last point and at the optima, within a
        tenth of the frequency.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, follow="peak")
        >>> len(found.higher_peaks().omega)  # there is one peak
        0
        """
        return HigherPeaks(*self._listed("hbvib_branch_higher_peaks", (), [float, float, float, np.int64]))

    def limit_cycles(self) -> LimitCycles:
        """Points of a nonlinear mode where its damping ratio is zero, motions of the model without forces: omega, log10
        of the amplitude, slope of the damping ratio by it, point number for Model.floquet and others.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=-0.02)  # grows by itself
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> len(mode.limit_cycles().omega)  # where friction takes what negative damping gives
        1
        """
        return LimitCycles(*self._listed("hbvib_branch_limit_cycles", (), [float, float, float, np.int64]))

    def at(self, wanted: int) -> Wanted:
        """Every solution at one entry of the solve's `at`: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6), at=[1.0, 1.2])
        >>> branch.at(1).amplitude.round(4)
        array([0.5599])
        """
        amplitude, point = self._listed("hbvib_branch_at", (wanted,), [float, np.int64])
        return Wanted(self._omega_at(wanted, point), amplitude, point)

    def _omega_at(self, wanted: int, points: IntArray) -> FloatArray:
        """Angular frequencies of the solutions at an entry of `at`; NaN where the library does not tell them."""
        curve: Branch = cast("Branch", self)
        stored = curve._stored_field(Field.OMEGA)
        if stored is not None:
            return np.array(stored[points], float)
        if curve.is_mode:
            return np.array([self.mode_point(int(point)).omega for point in points], float)
        omega = self._at[wanted] if self._at.size else np.nan
        with contextlib.suppress(ArgumentError):
            over_parameter = curve.parameter_values.size > 0  # where the frequency may be held
            omega = curve.omega[0] if over_parameter and np.ptp(curve.omega) == 0 else np.nan
        return np.full(len(points), omega)

    def point(self, number: int) -> StoredPoint:
        """A stored point by its number, on the curve or beside it: its omega, amplitude and other fields, motion, loops,
        energies.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.point(branch.peaks().point[0])
        <hbvib.StoredPoint 45: omega 1.23202, amplitude 0.583649>
        """
        return StoredPoint(cast("Branch", self), _whole(number, name="point"))

    @_with_options("hbvib_synthesis_options", SynthesisOptions)
    def synthesis(self, model: Model, *, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                  **options: Unpack[SynthesisOptions]) -> Synthesis:
        """The response to the forces of a model, from this nonlinear mode: omega, response (complex fundamental of
        the response degree of freedom), modal_amplitude.

        {options}
        phase, cancel   as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> found = mode.synthesis(model)
        >>> print("%.3f" % abs(found.response).max())
        0.569
        """
        stop = dict(phase=phase, cancel=cancel)
        return Synthesis(*self._synthesis("synthesis", model, options, [float, complex, float], stop))

    @_with_options("hbvib_synthesis_options", SynthesisOptions)
    def synthesis_peaks(self, model: Model, *, phase: Hook = None, cancel: Optional[CancelFlag] = None,
                        **options: Unpack[SynthesisOptions]) -> SynthesisPeaks:
        """The resonances of a synthesised response; `flags` are sums of SynthesisFlag, other_mode the distance of the
        nearest other mode over the half-power bandwidth, error the amplitude over that of the computed resonance next
        to it, minus 1.

        {options}
        phase, cancel   as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> mode.synthesis_peaks(model).omega.round(3)
        array([1.215])
        """
        stop = dict(phase=phase, cancel=cancel)
        return SynthesisPeaks(*self._synthesis("synthesis_peaks", model, options, [float] * 6 + [np.int32], stop))

    def _synthesis(self, name: str, model: Model, options: Mapping[str, Any], dtypes: Sequence[Any],
                   stop: dict[str, Any]) -> list[Any]:
        settings = _options(name, "hbvib_synthesis_options", options)
        return self._listed("hbvib_branch_" + name, (model.handle, settings), dtypes, stop)
