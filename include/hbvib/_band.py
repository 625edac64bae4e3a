"""Residual forces of contacts that stick: their freedom, and the band of a response over it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, cast

import numpy as np

from ._branch import Branch
from ._c import BandOf, LogLevel, Status
from ._calls import _call, _Guard, _hooks
from ._convert import _member
from ._errors import Stopped, _sentence
from ._structs import _new
from ._units import _HasUnits

if TYPE_CHECKING:
    from ._calls import CancelFlag, Hook
    from ._choices import BandOfs
    from ._model import Model
    from ._results import FloatArray


class FreeSlider(NamedTuple):
    """A slider that sticks through the period and changes the vibration; made by Model.freedom.

    direction   0 for t1, 1 for t2.
    place       place of the slider in the solution.
    derivative  of the amplitude by the place at a fixed frequency, while the contact sticks.

    >>> import hbvib
    >>> hbvib.FreeSlider(contact=0, direction=0, place=0.5, derivative=0.1).contact
    0
    """
    contact: int
    direction: int
    place: float
    derivative: float


class BandEnd(NamedTuple):
    """An end of a band; made by Model.band.

    value     the result, at the angular frequency omega.
    places    of the free sliders, in the order of Band.sliders.
    at_limit  number of contacts that are at the limit of their friction.
    gain      relative gain that the linearised problem still foretells nearby; 0 with one slider.
    error     relative change of the value by the last doubling of its harmonics, which bounds its error; NaN where it is
              unknown, as with fixed harmonics.
    model     the model with its sliders at these places, of which branch is the solution, a branch of one point: give both to
              verify. Without a band the model itself, and None.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.BandEnd(1.0, 2.0, np.zeros(1), 0, 0.0, 1e-4, hbvib.Model(1), None).value
    1.0
    """
    value: float
    omega: float
    places: FloatArray
    at_limit: int
    gain: float
    error: float
    model: Model
    branch: Optional[Branch]


class BandStates(NamedTuple):
    """The states between the limits of one free slider, arrays in the order of its place; empty with several.

    >>> import hbvib
    >>> import numpy as np
    >>> len(hbvib.BandStates(*np.zeros((4, 3))).place)
    3
    """
    place: FloatArray
    value: FloatArray
    derivative: FloatArray
    omega: FloatArray


class Band:
    """The least and the largest result over the residual forces of contacts that stick; made by Model.band.

    lower, upper   the ends, each a BandEnd.
    sliders        (contact, direction) of each free slider, those of the point and then those that stick at an end; empty
                   where there is no band.
    states         with one free slider at the point the states from one limit to the other, a BandStates.
    complete       whether one slider was followed to both limits, or each search of several ended at an extremum. False where
                   every contact is linear at the point and some stick: then states far from it were sampled.
    solved         number of solutions that were computed.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> model.band(branch, branch.peaks().point[0])  # the one contact slips
    <hbvib.Band: no free slider, 0.5836>
    """

    def __init__(self, lower: BandEnd, upper: BandEnd, sliders: Sequence[tuple[int, int]], states: BandStates,
                 complete: bool, solved: int) -> None:
        self.lower, self.upper, self.sliders, self.states = lower, upper, tuple(sliders), states
        self.complete, self.solved = complete, solved

    def __repr__(self) -> str:
        if not self.sliders:
            return f"<hbvib.Band: no free slider, {self.lower.value:.4g}>"
        free = "1 free slider" if len(self.sliders) == 1 else f"{len(self.sliders)} free sliders"
        return f"<hbvib.Band: {free}, {self.lower.value:.4g} to {self.upper.value:.4g}>"


class BandCurve(NamedTuple):
    """Lower and upper curve of a response; made by Model.band_curve.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.BandCurve(np.array([1.0]), np.array([0.1]), np.array([0.2]), ()).upper
    array([0.2])
    """
    omega: FloatArray
    lower: FloatArray
    upper: FloatArray
    bands: tuple[Band, ...]

    def plot(self, ax: Any = None, *, color: Any = "tab:blue", label: str = "") -> Any:
        """Draws the band as a shaded area between both curves; needs matplotlib. Returns the axes.

        >>> import hbvib
        >>> import numpy as np
        >>> curve = hbvib.BandCurve(np.array([1.0, 1.1]), np.array([0.1, 0.2]), np.array([0.2, 0.4]), ())
        >>> curve.plot()  # doctest: +SKIP
        """
        if ax is None:
            import matplotlib.pyplot as plt
            ax = plt.gca()
        ax.fill_between(self.omega, self.lower, self.upper, color=color, alpha=0.3, linewidth=0, label=label or None)
        for line in (self.lower, self.upper):
            ax.plot(self.omega, line, color=color, linewidth=1)
        ax.set_xlabel("omega")
        ax.set_ylabel("amplitude")
        return ax


class _Bands(_HasUnits):
    """Methods of Model for residual forces."""

    def freedom(self, branch: Branch, point: int, *, phase: Hook = None,
                cancel: Optional[CancelFlag] = None) -> list[FreeSlider]:
        """The sliders of a point of a forced response of this model that stick through the period and change its
        vibration. Each may lie anywhere within the limit of its friction: the point is one of a continuum of solutions,
        of which `band` has the ends. Empty where there is none.

        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> model.freedom(branch, branch.peaks().point[0])
        []
        """
        room = 2 * cast("Model", self).contacts
        contact, direction = np.zeros(room, np.int64), np.zeros(room, np.int64)
        place, derivative, count = np.zeros(room), np.zeros(room), ctypes.c_int64()
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_branch_freedom", self.handle, branch.handle, point, room, contact, direction, place,
                           derivative, count, hooks, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        return [FreeSlider(int(contact[i]), int(direction[i]), float(place[i]), float(derivative[i]))
                for i in range(count.value)]

    def band(self, branch: Branch, point: int, of: BandOfs = "amplitude", *, contacts: Optional[Sequence[int]] = None,
             starts: int = 3, phase: Hook = None, cancel: Optional[CancelFlag] = None) -> Band:
        """The least and the largest result at a point of a forced response of this model, over all residual forces that
        its sticking contacts may keep, with the states that attain them. The harmonics are those of the point. Where a
        tolerance has chosen these, the ends have twice as many, or more, until they change by less than 1e-3.

        of        "amplitude": at the frequency of the point; "peak_amplitude", "peak_omega": of a peak, which moves.
        contacts  whose sliders are free; None: all of `freedom`.
        starts    of the search with several free sliders, which finds attained bounds, beyond which others may lie; with
                  one it has no effect.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> found = model.band(branch, branch.peaks().point[0])
        >>> found.sliders, found.lower.value == found.upper.value
        ((), True)
        """
        options = _new("hbvib_band_options", of=_member(BandOf, of), starts=starts)
        if contacts is not None:
            listed = np.ascontiguousarray(contacts, np.int64)
            options.listed = listed  # kept as long as the struct
            options.contacts, options.contacts_len = listed.ctypes.data, listed.size
        info = _new("hbvib_band_info")
        model = cast("Model", self)
        room, most = 2 * model.contacts, 1024
        contact, direction = np.zeros(room, np.int64), np.zeros(room, np.int64)
        places = [np.zeros(room), np.zeros(room)]
        states = np.zeros((most, 4))
        handles = [ctypes.c_void_p(), ctypes.c_void_p()]
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_band", self.handle, branch.handle, point, None, options, hooks, info, room, contact,
                           direction, *places, most, states, *handles, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        sliders = [(int(contact[i]), int(direction[i])) for i in range(info.sliders)]
        ends = []
        for name, place, handle in zip(("lower", "upper"), places, handles):
            placed, found = model, None
            if handle.value is not None:
                placed = model.clone()
                for slider, at in zip(sliders, place):
                    placed.set_slider(slider[0], at, direction=slider[1])
                found = Branch(handle.value, tuple(self._kept), "", self._units)
            ends.append(BandEnd(getattr(info, name), getattr(info, name + "_omega"), place[:len(sliders)].copy(),
                                getattr(info, name + "_at_limit"), getattr(info, name + "_gain"), getattr(info, name + "_error"),
                                placed, found))
        followed = states[:min(info.states, most)].T.copy()
        return Band(ends[0], ends[1], sliders, BandStates(*followed), bool(info.complete), info.solved)

    def band_curve(self, branch: Branch, points: Optional[Sequence[int]] = None, *,
                   contacts: Optional[Sequence[int]] = None, starts: int = 3, phase: Hook = None,
                   cancel: Optional[CancelFlag] = None) -> BandCurve:
        """Lower and upper curve of a forced response of this model: `band` of the amplitude at points of a branch.

        points    numbers of points; None: all of the curve, in its order.
        contacts, starts, phase, cancel   as in `band`.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> curve = model.band_curve(model.forced_response((0.8, 1.6)), [0, 1])
        >>> bool((curve.lower == curve.upper).all())
        True
        """
        numbers = range(len(branch)) if points is None else points
        bands = [self.band(branch, int(point), contacts=contacts, starts=starts, phase=phase, cancel=cancel)
                 for point in numbers]
        column: Any = lambda name, of: np.array([getattr(getattr(band, name), of) for band in bands])
        return BandCurve(column("lower", "omega"), column("lower", "value"), column("upper", "value"), tuple(bands))
