"""The band of a nonlinear mode over residual forces of contacts that stick."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, cast

import numpy as np

from ._c import LogLevel, ModeBandOf, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _member
from ._errors import Stopped, _sentence
from ._structs import _new

if TYPE_CHECKING:
    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._choices import ModeBandOfs
    from ._model import Model
    from ._results import FloatArray


class ModeBandEnd(NamedTuple):
    """An end of the band of a mode; made by Model.mode_band.

    value          the result; omega and damping_ratio are those of the state.
    places         of the free sliders, in the order of ModeBand.sliders.
    model          the model with its sliders at these places, whose mode has the result.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.ModeBandEnd(0.1, 2.0, 0.1, np.zeros(1), hbvib.Model(1)).value
    0.1
    """
    value: float
    omega: float
    damping_ratio: float
    places: FloatArray
    model: Model


class ModeBand(NamedTuple):
    """The band of a point of a nonlinear mode; made by Model.mode_band.

    lower, upper   the ends, each a ModeBandEnd.
    sliders        (contact, direction) of each free slider; empty where there is no band.
    place, omega, damping_ratio   of the states that were scanned with one slider.
    complete       whether every solution was found, and both ends of each slider were dragged by its limit.
    solved         number of solutions that were computed.

    >>> import hbvib
    >>> import numpy as np
    >>> end = hbvib.ModeBandEnd(0.1, 2.0, 0.1, np.zeros(0), hbvib.Model(1))
    >>> hbvib.ModeBand(end, end, (), np.zeros(0), np.zeros(0), np.zeros(0), True, 0).sliders
    ()
    """
    lower: ModeBandEnd
    upper: ModeBandEnd
    sliders: tuple[tuple[int, int], ...]
    place: FloatArray
    omega: FloatArray
    damping_ratio: FloatArray
    complete: bool
    solved: int


class _ModeBands(_Owner):
    """Methods of Model for bands of modes."""

    def mode_band(self, branch: Branch, point: int, of: ModeBandOfs = ModeBandOf.DAMPING, *, contacts: Optional[Sequence[int]] = None,
                  diameter: Optional[int] = None, phase: Hook = None, cancel: Optional[CancelFlag] = None) -> ModeBand:
        """The band of a stored point of a nonlinear mode of this model: the least and the largest result at its amplitude, over
        all places of the sliders that stick through its period, with the states that attain them.

        of        "damping": the damping ratio; "omega": the angular frequency.
        contacts  whose sliders are free; None: all that stick.
        diameter  of the mode, where it was not that of the engine order.
        phase, cancel   as in nonlinear_mode; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> mode = model.nonlinear_mode((-1, 1), harmonics=3)
        >>> model.mode_band(mode, len(mode) - 1).sliders  # the one contact slips
        ()
        """
        model = cast("Model", self)
        mode = _new("hbvib_mode_options") if diameter is None else _new("hbvib_mode_options", diameter=diameter)
        free = np.zeros(0, np.int64) if contacts is None else np.ascontiguousarray(contacts, np.int64)
        info, room, most = _new("hbvib_band_info"), 2 * model.contacts, 64
        contact, direction = np.zeros(room, np.int64), np.zeros(room, np.int64)
        ends, states = np.zeros((2, room + 2)), np.zeros((most, 3))
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_mode_band", self.handle, branch.handle, point, None, mode, int(_member(ModeBandOf, of)), free.size,
                           free, hooks, info, room, contact, direction, ends, most, states, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        sliders = tuple((int(contact[i]), int(direction[i])) for i in range(info.sliders))
        found: list[Any] = []
        for value, row in zip((info.lower, info.upper), ends):
            placed = model.clone()
            for slider, place in zip(sliders, row):
                placed.set_slider(slider[0], float(place), direction=slider[1])
            found.append(ModeBandEnd(value, float(row[room]), float(row[room + 1]), row[:len(sliders)].copy(), placed))
        place, omega, damping_ratio = states[:min(info.states, most)].T.copy()
        return ModeBand(found[0], found[1], sliders, place, omega, damping_ratio, bool(info.complete), info.solved)
