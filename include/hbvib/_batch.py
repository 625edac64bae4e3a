"""Many designs of a model in one call."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from ._analyses import _solver_options
from ._branch import Branch
from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks
from ._convert import _array, _range
from ._errors import ArgumentError, _sentence
from ._library import lib, structs
from ._responses import Response, Responses, described, listed
from ._results import Progress
from ._sensitivity import Parameter
from ._structs import _new, _with_options
from ._types import SolverOptions
from ._units import Units, _HasUnits

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._results import FloatArray, IntArray


class DesignPeaks(NamedTuple):
    """The highest peak of a response in each design; NaN where there is none. Made by Batch.responses.

    end_amplitude, end_omega   the larger response at the two ends of the range, and that end: above the highest peak, that lies beyond.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> watched = [0, hbvib.Response(0, "rms", component="velocity")]
    >>> batch = model.batch((0.8, 1.6), hbvib.Parameter("preload"), [0.5, 1.0], responses=watched, harmonics=9)
    >>> [peaks.amplitude.round(2).tolist() for peaks in batch.responses]
    [[1.39, 0.58], [1.01, 0.51]]
    """
    response: Response
    amplitude: FloatArray
    omega: FloatArray
    end_amplitude: FloatArray
    end_omega: FloatArray


class Batch:
    """The highest peaks of many designs, read-only arrays in the order of their values; made by Model.batch.

    peak_amplitude, peak_omega   NaN where the amplitude has no maximum within the range, or the design failed.
    status                       numbers of Status: OK, STOPPED_NO_PEAK, or why the design has no result or a part of one.
    points                       points of each curve.
    responses                    the highest peak of each response that was asked for: response, amplitude, omega.
    Batches are pickled without their branches.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> model.batch((0.8, 1.6), hbvib.Parameter("preload"), [0.5, 1.0, 1.5], harmonics=9)
    <hbvib.Batch: 3 designs, 0 without a complete result>
    """

    peak_amplitude: FloatArray
    peak_omega: FloatArray
    status: IntArray
    points: IntArray
    responses: tuple[DesignPeaks, ...]

    def __init__(self, peak_amplitude: ArrayLike, peak_omega: ArrayLike, status: ArrayLike, points: ArrayLike,
                 reasons: Optional[Mapping[int, str]] = None, responses: Sequence[DesignPeaks] = ()) -> None:
        self.peak_amplitude, self.peak_omega = np.array(peak_amplitude, float), np.array(peak_omega, float)
        self.status, self.points = np.array(status, np.int64), np.array(points, np.int64)
        for array in (self.peak_amplitude, self.peak_omega, self.status, self.points):
            array.flags.writeable = False
        self.responses = tuple(responses)
        self._reasons = dict(reasons or {})
        self._branches: dict[int, Branch] = {}
        self._owner: Optional[_BatchHandle] = None
        self._kept: tuple[Any, ...] = ()
        self._units = Units()

    @classmethod
    def _of(cls, handle: int, designs: int, kept: tuple[Any, ...], watched: Sequence[Response] = ()) -> Batch:
        owner = _BatchHandle(handle)
        amplitude, omega = np.empty(designs), np.empty(designs)
        status, points = np.empty(designs, np.int64), np.empty(designs, np.int64)
        _call("hbvib_batch_peaks", handle, designs, amplitude, omega, status, points)
        reasons = {}
        for i in np.flatnonzero(status):
            lib.hbvib_batch_status(handle, int(i))
            reasons[int(i)] = _sentence(int(status[i]))
        peaks = [DesignPeaks(one, *np.empty((4, designs))) for one in watched]
        for r, of in enumerate(peaks):
            _call("hbvib_batch_response_peaks", handle, r, designs, of.amplitude, of.omega)
            _call("hbvib_batch_response_ends", handle, r, designs, of.end_amplitude, of.end_omega)
        batch = cls(amplitude, omega, status, points, reasons, peaks)
        batch._owner, batch._kept = owner, kept
        return batch

    def __len__(self) -> int:
        """Number of designs."""
        return len(self.status)

    def __repr__(self) -> str:
        from ._summary import counted
        return f"<hbvib.Batch: {counted(len(self), 'design')}, {np.count_nonzero(self.status)} without a complete result>"

    def reason(self, design: int) -> str:
        """The sentence of a status other than OK; empty for OK. IndexError for a design that is not there.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> batch = model.batch((0.8, 1.6), hbvib.Parameter("mu"), [0.3, -1.0], harmonics=3)
        >>> batch.reason(0), batch.reason(1) != ""
        ('', True)
        """
        return self._reasons.get(range(len(self))[design], "")

    def branch(self, design: int) -> Branch:
        """The branch of a design, where keep was set. ArgumentError where there is none, IndexError for a design that is
        not there.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> batch = model.batch((0.8, 1.6), hbvib.Parameter("preload"), [0.5, 1.0], keep=True, harmonics=9)
        >>> batch.branch(1).peaks().amplitude.round(4)
        array([0.5836])
        """
        design = range(len(self))[design]
        if design not in self._branches:
            if self._owner is None:
                raise ArgumentError(f"design {design} has no branch: this batch was made elsewhere", Status.E_ARGUMENT, 2)
            handle = ctypes.c_void_p()
            _call("hbvib_batch_branch", self._owner.value, design, handle)
            assert handle.value is not None
            self._branches[design] = Branch(handle.value, self._kept, self.reason(design), self._units)
        return self._branches[design]

    @staticmethod
    def concatenate(batches: Sequence[Batch]) -> Batch:
        """One batch of the designs of several, without their branches.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> parts = [model.batch((0.8, 1.6), hbvib.Parameter("preload"), values, harmonics=9) for values in ([0.5], [1.0, 1.5])]
        >>> hbvib.Batch.concatenate(parts).peak_amplitude.round(4)
        array([1.3914, 0.5836, 0.6641])
        """
        reasons: dict[int, str] = {}
        first = 0
        for batch in batches:
            reasons.update({first + i: text for i, text in batch._reasons.items()})
            first += len(batch)
        names = ("peak_amplitude", "peak_omega", "status", "points")
        amplitude, omega, status, points = (np.concatenate([getattr(batch, name) for batch in batches]) for name in names)
        lists = [batch.responses for batch in batches]
        fields = DesignPeaks._fields[1:]
        peaks = [DesignPeaks(of[0].response, *(np.concatenate([getattr(one, name) for one in of]) for name in fields))
                 for of in zip(*lists)]
        return Batch(amplitude, omega, status, points, reasons, peaks)

    def __reduce__(self) -> Any:
        """A pickle holds the peaks, not the branches."""
        return Batch, (self.peak_amplitude, self.peak_omega, self.status, self.points, self._reasons, self.responses)


class _BatchHandle:
    """Owns the handle of a batch."""

    def __init__(self, value: int) -> None:
        self.value = value

    def __del__(self, free: Any = lib.hbvib_batch_free) -> None:
        free(self.value)


class _Batches(_HasUnits):
    """Methods of Model for many designs."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def batch(self, omega: ArrayLike, parameters: Union[Parameter, Sequence[Parameter]], values: ArrayLike, *,
              threads: int = 1, keep: bool = False, responses: Optional[Responses] = None,
              progress: Union[bool, Callable[[Progress], Any], None] = None, phase: Hook = None,
              cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> Batch:
        """The highest peak of each of many designs: this model with other values of parameters.

        omega       (start, stop) of each response.
        values      designs x parameters: constants of contacts and the speed are set, factors multiply, directions are
                    added times the value; one dimension where there is one parameter.
        threads     of this call, which releases the GIL; their number changes no bit of a result.
        keep        whether Batch.branch(i) gives the branch of a design.
        responses   what is watched, as in forced_response: the first leads the peaks, Batch.responses has those of each.
        progress    progress(Progress) after designs of the calling thread: `point` counts the designs done. True shows a
                    bar.
        phase, cancel, progress   stop as in forced_response: designs that were not solved have STOPPED_BY_CALLER.
        A design that fails has a status of its own. Options of the solver; harmonics without tolerance means
        tolerance = 0:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> batch = model.batch((0.8, 1.6), hbvib.Parameter("preload"), [0.5, 1.0, 1.5], harmonics=9)
        >>> batch.peak_amplitude.round(4)
        array([1.3914, 0.5836, 0.6641])
        """
        several = [parameters] if isinstance(parameters, Parameter) else list(parameters)
        given = [parameter._description() for parameter in several]
        array = (structs["hbvib_parameter"] * len(given))(*given)
        table = _array("values", values)
        if table.ndim == 1 and len(given) == 1:
            table = table.reshape(-1, 1)
        if table.ndim != 2 or table.shape[1] != len(given):
            raise ValueError(f"values has shape {table.shape}, needs (designs, {len(given)})")
        start, stop = _range("omega", omega, "batch((0.8, 1.6), parameters, values)")
        options = _new("hbvib_batch_options", threads=threads, omega_start=start, omega_stop=stop, keep=int(bool(keep)))
        watched = listed(responses)
        described(options, watched)
        chosen = _solver_options("batch", solver)
        handle, found = ctypes.c_void_p(), None
        with _Guard() as guard:
            hooks = _hooks(guard, progress, None, LogLevel.INFO, cancel, phase)
            _call("hbvib_batch_solve", self.handle, chosen, options, hooks, array, len(given), len(table), table, handle,
                  guard=guard)
            if handle.value is not None:
                found = guard.batch = Batch._of(handle.value, len(table), tuple(self._kept), watched)
                found._units = self._units
        assert found is not None
        return found
