"""Vibration over a life: contacts that wear, and the loads that are best for it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._analyses import _solver_options
from ._c import LifeFollow, LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _range
from ._errors import Stopped, _sentence
from ._structs import _new, _record, _with_options
from ._types import BestLoad, SolverOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._results import FloatArray, IntArray, Progress


class LifeEvents(NamedTuple):
    """Events of a life, arrays in their order; made by Model.life.

    kind     numbers of LifeEvent: SLIPS, STICKS, LOST, PRESSED, LIMIT, JUMPS.
    contact  numbers of contacts, -1 for the amplitude that passes the limit or jumps.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.LifeEvents(np.array([3.0]), np.array([0]), np.array([1])).contact.tolist()
    [1]
    """
    cycles: FloatArray
    kind: IntArray
    contact: IntArray


class Life(NamedTuple):
    """States at the wanted cycles of a life; made by Model.life. NaN where it did not come.

    depths, loads, works   (cycles, contacts): worn depths, normal loads at rest, works of friction of a cycle.
    amplitude, omega       of the vibration, the largest of several duties.
    contacts               those that wear, in the order of the columns.
    events                 a LifeEvents.
    status, message        OK, or why the life ended early.
    largest, largest_at    the largest amplitude and its cycles.
    steps, solutions       of the integration, and steady vibrations that were solved.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=0.6)
    >>> model.add_force(0, 0.3)
    >>> life = model.life(contact, 0.05, cycles=[0, 10, 40], omega=1.1, stiffness=1, harmonics=9)
    >>> life.loads[:, 0].round(3).tolist()
    [0.6, 0.3, 0.028]
    """
    cycles: FloatArray
    depths: FloatArray
    loads: FloatArray
    works: FloatArray
    amplitude: FloatArray
    omega: FloatArray
    contacts: IntArray
    events: LifeEvents
    status: Status
    message: str
    largest: float
    largest_at: float
    steps: int
    solutions: int

    def plot(self, ax: Any = None) -> Any:
        """Draws loads over cycles, and the amplitude on a second axis; needs matplotlib. Returns both axes.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=0.6)
        >>> model.add_force(0, 0.3)
        >>> life = model.life(contact, 0.05, cycles=range(41), omega=1.1, stiffness=1, harmonics=3)
        >>> life.plot()  # doctest: +SKIP
        """
        if ax is None:
            import matplotlib.pyplot as plt
            ax = plt.gca()
        for contact, load in zip(self.contacts, self.loads.T):
            ax.plot(self.cycles, load, label=f"load of contact {contact}")
        for n in self.events.cycles:
            ax.axvline(n, color="0.8", linewidth=0.8, zorder=0)
        ax.set_xlabel("cycles")
        ax.set_ylabel("load")
        other = ax.twinx()
        other.plot(self.cycles, self.amplitude, color="black", linestyle="--", label="amplitude")
        other.set_ylabel("amplitude")
        return ax, other


class _Lives(_Owner):
    """Methods of Model for lives."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def life(self, contacts: ArrayLike, rates: ArrayLike, *, cycles: ArrayLike, omega: Optional[ArrayLike] = None,
             force: Optional[ArrayLike] = None, share: Optional[ArrayLike] = None,
             peak: Optional[ArrayLike] = None, areas: ArrayLike = 1.0, stiffness: Optional[ArrayLike] = None,
             worn: Optional[ArrayLike] = None, accuracy: float = 1e-4, limit: float = 0.0, most_steps: int = 10_000,
             progress: Union[bool, Callable[[Progress], Any], None] = None, phase: Hook = None,
             cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> Life:
        """Wear of contacts over the cycles of a life: depths grow per cycle by rate x work / area, and loads fall by
        stiffness x depths.

        contacts    numbers of those that wear, or one.
        rates       worn volume per work of friction, one for each or one for all.
        cycles      at which the state is wanted, in ascending order; the last is the end of the life.
        omega       angular frequency of the vibration, or several; with force (factors on the forces) and share (of the
                    time) one each.
        peak        instead: (start, stop) of the range whose highest peak is followed as it moves.
        areas       of the contacts.
        stiffness   static stiffness between their normals, n x n, or a number for one contact; None: the normal stiffness of each
                    by itself, which its law then has.
        worn        depths at the beginning: `depths[-1]` of an earlier life goes on.
        accuracy    error allowed of the loads, relative to the largest one, and of the amplitude.
        limit       amplitude whose crossing is an event; 0: none.
        most_steps  after which the life ends early.
        progress, phase, cancel   as in forced_response, progress at each step with its cycles as `parameter`.
        Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=0.6)
        >>> model.add_force(0, 0.3)
        >>> life = model.life(contact, 0.05, cycles=20, peak=(0.8, 1.8), stiffness=1, harmonics=3)
        >>> bool(life.amplitude[-1] > 1.2), life.status
        (True, <Status.OK: 0>)
        """
        wanted = np.atleast_1d(_array("cycles", cycles))
        options, numbers = _life_options((contacts, rates, areas), (omega, force, share, peak), stiffness, worn, accuracy, limit,
                                         most_steps)
        n, c = len(wanted), len(numbers)
        depths, loads, works = (np.full((n, c), np.nan) for _ in range(3))
        amplitude, at = np.full(n, np.nan), np.full(n, np.nan)
        room = max(64, 8 * c)
        told, kinds, whose = np.empty(room), np.empty(room, np.int64), np.empty(room, np.int64)
        count, info = ctypes.c_int64(), _new("hbvib_life_info")
        settings = _solver_options("life", solver)
        with _Guard() as guard:
            hooks = _hooks(guard, progress, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_life", self.handle, settings, options, hooks, n, wanted, depths, loads, works, amplitude, at,
                           room, told, kinds, whose, count, info, guard=guard)
        known = min(count.value, room)
        events = LifeEvents(told[:known].copy(), kinds[:known].copy(), whose[:known].copy())
        return Life(wanted, depths, loads, works, amplitude, at, numbers, events, Status(status),
                    _sentence(status) if status else "", info.largest, info.largest_at, info.steps, info.solutions)

    @_with_options("hbvib_solver_options", SolverOptions)
    def best_load_for_life(self, contacts: ArrayLike, rates: ArrayLike, *, cycles: float, factors: ArrayLike = (0.1, 10.0),
                           omega: Optional[ArrayLike] = None, force: Optional[ArrayLike] = None,
                           share: Optional[ArrayLike] = None, peak: Optional[ArrayLike] = None, areas: ArrayLike = 1.0,
                           stiffness: Optional[ArrayLike] = None, worn: Optional[ArrayLike] = None, accuracy: float = 1e-4,
                           most_steps: int = 10_000,
                           progress: Union[bool, Callable[[Progress], Any], None] = None, phase: Hook = None,
                           cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> BestLoad:
        """The factor on the loads of the contacts that wear with which the largest amplitude over a life is least.

        factors     (low, high) of the search.
        cycles      end of the life.
        The rest as in life, progress after each life with its factor as `parameter`. Stopped is raised where the search
        is stopped, NumericalError where a life has no peak or ends early. Options of the solver; harmonics without tolerance means tolerance = 0:

        {options}

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.3)
        >>> best = model.best_load_for_life(contact, 0.02, cycles=8, peak=(0.8, 1.8), stiffness=1, harmonics=3)
        >>> float(round(best.amplitude / best.amplitude_new, 2))  # new and worn alike
        1.0
        """
        low, high = _range("factors", factors, "best_load_for_life(0, 1e-9, cycles=1e8, factors=(0.1, 10))")
        options, _ = _life_options((contacts, rates, areas), (omega, force, share, peak), stiffness, worn, accuracy, 0.0, most_steps)
        settings, found = _solver_options("best_load_for_life", solver), _new("hbvib_best_load")
        with _Guard() as guard:
            hooks = _hooks(guard, progress, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_best_load_for_life", self.handle, settings, options, float(cycles), low, high, hooks, found,
                           guard=guard)
        if status != Status.OK:  # without a result
            raise Stopped(_sentence(status), Status(status), 0)
        return _record(BestLoad, found)


def _life_options(wear: tuple[Any, Any, Any], duty: tuple[Any, Any, Any, Any], stiffness: Any, worn: Any, accuracy: float,
                  limit: float, most_steps: int) -> tuple[Any, IntArray]:
    """The struct of the options of a life, and the numbers of the contacts."""
    contacts = np.atleast_1d(np.asarray(wear[0]))
    if contacts.ndim != 1 or not np.issubdtype(contacts.dtype, np.integer):
        raise TypeError("contacts needs whole numbers, or one")
    numbers = np.ascontiguousarray(contacts, np.int64)
    count = len(numbers)

    def each(name: str, values: Any, length: int) -> FloatArray:
        array = np.atleast_1d(_array(name, values))
        if array.shape not in ((1,), (length,)):
            raise ValueError(f"{name} has shape {array.shape}, needs one number or {length}")
        return np.ascontiguousarray(np.broadcast_to(array, (length,)))

    lists: dict[str, Any] = dict(contacts=numbers, rates=each("rates", wear[1], count), areas=each("areas", wear[2], count))
    fields: dict[str, Any] = dict(contacts_len=count, tolerance=accuracy, limit=limit, most_steps=most_steps)
    if stiffness is not None:
        matrix = _array("stiffness", stiffness)
        if matrix.shape != (count, count) and not (count == 1 and matrix.size == 1):
            raise ValueError(f"stiffness has shape {matrix.shape}, needs ({count}, {count})")
        lists["stiffness"] = np.ascontiguousarray(matrix.T).reshape(-1)
    if worn is not None:
        lists["worn"] = each("worn", worn, count)
    omega, force, share, peak = duty
    if (omega is None) == (peak is None):
        raise TypeError("needs either omega or peak")
    if peak is not None:
        if force is not None or share is not None:
            raise TypeError("force and share go with omega, not with peak")
        fields["omega_start"], fields["omega_stop"] = _range("peak", peak, "life(0, 1e-9, cycles=1e8, peak=(0.8, 1.6))")
        fields["follow"] = int(LifeFollow.PEAK)
    else:
        frequencies = np.atleast_1d(_array("omega", omega))
        lists["duty_omega"], fields["duties_len"] = frequencies, len(frequencies)
        if force is not None:
            lists["duty_force"] = each("force", force, len(frequencies))
        if share is not None:
            lists["duty_share"] = each("share", share, len(frequencies))
    return _new("hbvib_life_options", **fields, **lists), numbers
