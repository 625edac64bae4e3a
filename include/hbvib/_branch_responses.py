"""Responses of a branch: those that it was asked for, and those that are read afterwards."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

from ._c import Reading
from ._calls import _call, _Owner, _stoppable
from ._convert import _whole
from ._responses import Response, Responses, WatchedResponse, listed, structures
from ._results import Kinks, Points
from ._structs import _new

if TYPE_CHECKING:
    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._results import ComplexArray, FloatArray


class _BranchResponses(_Owner):
    """Methods of Branch for responses."""

    @property
    def responses(self) -> tuple[WatchedResponse, ...]:
        """The responses that were asked for, in their order.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6), responses=[hbvib.Response(0, "rms"), hbvib.Response(0, "peak")])
        >>> [len(found.peaks().omega) for found in branch.responses]
        [1, 1]
        """
        curve: Branch = cast("Branch", self)
        asked = curve._responses
        if not asked and self._call("hbvib_branch_responses"):
            asked = (Response(None, "rms"),)  # where forces act in several harmonics and none in the first
        return tuple(self._watched(r, response, len(curve)) for r, response in enumerate(asked))

    def leading_response(self, point: int) -> int:
        """Number of the response with the largest error at a stored point. ArgumentError where no error is known.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response(1.2, responses=[0, hbvib.Response(0, "peak", component="acceleration")])
        >>> branch.leading_response(0)
        1
        """
        return self._call("hbvib_branch_leading_response", _whole(point, name="point"))

    def read(self, responses: Responses, *, phase: Hook = None,
             cancel: Optional[CancelFlag] = None) -> tuple[WatchedResponse, ...]:
        """Responses at all points of any branch, whatever it was asked for: of a nonlinear mode, of a result over a
        parameter, or further gauges of a forced response. They have no peaks and no errors.

        responses       a list of Response or of degrees of freedom.
        phase, cancel   as in energy.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> mode = model.nonlinear_mode((-2, 1))
        >>> rms, top = mode.read([hbvib.Response(0, "rms"), hbvib.Response(0, "peak")])
        >>> print("%.3f" % (top.amplitude / rms.amplitude)[0])  # of a cosine the root of 2
        1.414
        """
        curve: Branch = cast("Branch", self)
        asked = listed(responses)
        value, number, instant = self._read(asked, curve.stored, dict(phase=phase, cancel=cancel))
        none, place, no_number = np.full(curve.stored, np.nan), np.empty(0), np.empty(0, np.int64)
        beside = Points(place, place, no_number), Kinks(place, place, no_number, no_number)
        return tuple(WatchedResponse(one, len(curve), (value[r], number[r], none, instant[r]), *beside)
                     for r, one in enumerate(asked))

    def _read(self, asked: list[Response], stored: int,
              stop: dict[str, Any]) -> tuple[FloatArray, ComplexArray, FloatArray]:
        """Values, complex amplitudes and instants, responses x stored points."""
        array, kept = structures(asked)
        shape = len(asked), stored
        value, number, instant = np.empty(shape), np.empty(shape, complex), np.empty(shape)
        _stoppable("hbvib_branch_read_responses", self.handle, array, len(asked), value, value.size, number, number.size,
                   instant, instant.size, **stop, variant="")
        del kept
        return value, number, instant

    def _watched(self, r: int, response: Response, points: int) -> WatchedResponse:
        readings = [self._reading(r, reading) for reading in Reading]
        peaks = Points(*self._listed("hbvib_branch_response_peaks", (r,), [float, float, np.int64]))
        kinks = Kinks(*self._listed("hbvib_branch_response_kinks", (r,), [float, float, np.int64, np.int64]))
        return WatchedResponse(response, points, readings, peaks, kinks)

    def _reading(self, r: int, reading: Reading) -> Any:
        """A copy of a result of a response at all stored points."""
        view = _new("hbvib_view")
        _call("hbvib_branch_response", self.handle, r, reading, view)
        dtype, count = (complex if reading == Reading.COMPLEX else float), view.shape[0]
        if not view.data:
            return np.empty(count, dtype)
        numbers = (ctypes.c_double * (count * np.dtype(dtype).itemsize // 8)).from_address(view.data)
        return np.frombuffer(numbers, dtype, count).copy()
