"""Motion in time while the frequency of the forces changes."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Union, cast

import numpy as np
from numpy.typing import ArrayLike

from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _range
from ._structs import _new

if TYPE_CHECKING:
    from ._calls import CancelFlag, Hook
    from ._choices import LogLevels
    from ._model import Model
    from ._results import FloatArray, Progress


class TimeSweep(NamedTuple):
    """A run through a range of frequency; made by Model.time_sweep.

    time, omega    at the begin of each turn of the forces, arrays.
    amplitude      the largest displacement within it.
    largest        of the whole sweep, at the angular frequency largest_omega and the time largest_time.
    events         changes between stick, slip, open and closed.
    status         OK, or STOPPED_BY_CALLER with the turns so far.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    >>> model.add_force(0, 0.05)
    >>> sweep = model.time_sweep((0.8, 1.2), rate=1e-2)
    >>> round(sweep.largest, 6), sweep.status
    (0.585358, <Status.OK: 0>)
    """
    time: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    largest: float
    largest_omega: float
    largest_time: float
    events: int
    status: Status


class _TimeSweeps(_Owner):
    """Methods of Model for runs through a range of frequency."""

    def time_sweep(self, omega: ArrayLike, rate: float, *, dof: int = 0, tolerance: float = 1e-11, max_periods: int = 10_000,
                   start: Optional[ArrayLike] = None, progress: Union[bool, Callable[[Progress], Any], None] = None,
                   log: Optional[Callable[[LogLevel, str], Any]] = None, log_level: LogLevels = LogLevel.INFO,
                   cancel: Optional[CancelFlag] = None, phase: Hook = None) -> TimeSweep:
        """Integrates the motion in time while the frequency of the forces changes at a constant rate, as in a run-up, from the
        periodic motion at the first frequency on.

        omega        (start, stop), angular frequencies; stop < start runs down.
        rate         change of the angular frequency per time, > 0 in both senses.
        dof          degree of freedom whose displacement is observed.
        tolerance    of the first periodic motion, and of the steps of smooth laws.
        max_periods  that the first periodic motion takes at most.
        start        harmonics (H + 1, ndof) to find it from; None: rest.
        progress     after each turn; the rest as in forced_response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.05)
        >>> up, down = model.time_sweep((0.85, 1.3), 1e-2), model.time_sweep((1.3, 0.85), 1e-2)
        >>> round(up.largest, 6), round(down.largest, 6), up.events
        (0.543586, 0.550954, 6)
        """
        model = cast("Model", self)
        begin, end = _range("omega", omega, "time_sweep((0.85, 1.3), rate=1e-3)")
        options = _new("hbvib_sweep_options", omega_start=begin, omega_stop=end, rate=rate, dof=dof, tolerance=tolerance,
                       max_periods=max_periods)
        if start is not None:
            harmonics = _array("start", start, complex)
            if harmonics.ndim != 2 or harmonics.shape[1] != model.ndof:
                raise ValueError(f"start has shape {harmonics.shape}, needs (H + 1, {model.ndof})")
            options.start, options.start_len = harmonics.ctypes.data, harmonics.size
        # Turns of the phase; refused rates have none.
        turns = abs(end * end - begin * begin) / (4 * np.pi * abs(rate)) if rate else 0.0
        room = int(min(turns, 1e8)) + 2 if turns == turns else 2
        time, frequency, amplitude = np.empty(room), np.empty(room), np.empty(room)
        count, info = ctypes.c_int64(), _new("hbvib_sweep_info")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, log_level, cancel, phase)
            status = _call("hbvib_time_sweep", self.handle, options, hooks, room, time, frequency, amplitude, count, info, guard=guard)
        n = count.value
        return TimeSweep(time[:n].copy(), frequency[:n].copy(), amplitude[:n].copy(), info.largest, info.largest_omega,
                         info.largest_time, info.events, Status(status))
