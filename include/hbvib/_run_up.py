"""Run-ups and missions by the slow flow of a nonlinear mode, and the Campbell diagram of what they give."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array, _range
from ._errors import Stopped, _sentence
from ._structs import _new

if TYPE_CHECKING:
    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._model import Model
    from ._results import Campbell, FloatArray


def _of(kind: str, name: str, value: Any) -> Any:
    """The handle of a Model or a Branch; TypeError where `value` is none."""
    if not isinstance(value, _Owner) or kind not in (base.__name__ for base in type(value).__mro__):
        raise TypeError(f"{name} is of type {type(value).__name__}, needs a {kind}")
    return value.handle


class RunUp(NamedTuple):
    """A run-up by the slow flow of a mode; made by Branch.run_up.

    time, omega    at the begin of each turn of the forces, arrays; modal_amplitude there.
    amplitude      the largest displacement within the turn: one cycle each.
    largest        of the run-up, at the angular frequency largest_omega and the time largest_time.
    error          relative error of it, from three leads of the integration in time. Where integrated is 0 it is an estimate that may be
                   too small, NaN where the mode has no steady resonance to compare with.
    without_memory the largest displacement by the slow flow without the memory of sliders.
    steady         largest displacement of the highest steady resonance, with the mean and all harmonics; factor is largest over it.
    slow_flow      the largest displacement by the slow flow alone.
    integrated     turns that were integrated in time; 0: none.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
    >>> model.add_force(0, 0.12)
    >>> up = model.nonlinear_mode((-2, 0.8), harmonics=5).run_up(model, (0.8, 1.3), rate=1e-3)
    >>> round(up.factor, 2)
    0.81
    """
    time: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    modal_amplitude: FloatArray
    largest: float
    largest_omega: float
    largest_time: float
    error: float
    without_memory: float
    steady: float
    slow_flow: float
    integrated: int

    @property
    def factor(self) -> float:
        """Largest displacement over that of the steady resonance; what constant forces displace is in both.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.12)
        >>> up = model.nonlinear_mode((-2, 0.8), harmonics=5).run_up(model, (0.8, 1.3), rate=1e-3)
        >>> up.factor == up.largest / up.steady
        True
        """
        return self.largest / self.steady


class Mission(NamedTuple):
    """A resonance over a mission; made by Branch.mission.

    amplitude      at each time, of the degree of freedom in the fundamental.
    cycles         below the first edge, between edges, and above the last one.
    damage         sum of Miner of each stress; those of several resonances add. No error is told: the memory of sliders is left out, by
                   which damage is too small in quick passages (docs/life.md has figures); there sum the turns of a time sweep.
    passage_time, passage_omega, passage_rate, passage_amplitude, passage_steady, passage_cycles   of each passage through the resonance:
                   time, angular frequency, its change per time and size of the largest amplitude, the steady one, and the cycles with
                   at least 1/sqrt(2) of the largest.
    error          amplitude of the highest steady resonance over the computed one, minus 1.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
    >>> model.add_force(0, 0.12)
    >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=5)
    >>> flight = mode.mission(model, [0, 1e4, 2e4], [0.4, 0.7, 0.4], engine_order=2)
    >>> len(flight.passage_time)
    2
    """
    amplitude: FloatArray
    cycles: FloatArray
    damage: FloatArray
    passage_time: FloatArray
    passage_omega: FloatArray
    passage_rate: FloatArray
    passage_amplitude: FloatArray
    passage_steady: FloatArray
    passage_cycles: FloatArray
    error: float


class CampbellResponse(NamedTuple):
    """Resonances of a Campbell diagram with their amplitudes; made by campbell_response.

    engine_order, force_factor, speed, omega   of each resonance: omega = engine_order speed.
    amplitude      steady peak of the mode under its force, of the fundamental of its response degree of freedom.
    damping_ratio  there.
    passed         largest amplitude of a passage at the acceleration; factor is passed over amplitude, NaN without acceleration. It has no
                   error told: it leaves out the memory of sliders, an error of the first order in the acceleration. Branch.run_up
                   tells the error for one rate.
    error          of the steady peak: its amplitude over the computed one, minus 1.

    >>> import hbvib
    >>> import numpy as np
    >>> one = np.ones(1)
    >>> hbvib.CampbellResponse(one, one, one, one, one, one, 0.5 * one, one).factor
    array([0.5])
    """
    engine_order: FloatArray
    force_factor: FloatArray
    speed: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    damping_ratio: FloatArray
    passed: FloatArray
    error: FloatArray

    @property
    def factor(self) -> FloatArray:
        """Amplitude of the passage over the steady one, of each resonance.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.12)
        >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=5)
        >>> picture = hbvib.campbell_response([(mode, model, 2)], 5e-4)
        >>> bool(picture.factor[0] < 1)
        True
        """
        ratio: FloatArray = self.passed / self.amplitude
        return ratio

    def plot(self, diagram: Optional[Campbell] = None, ax: Any = None, *, hertz: bool = False) -> Any:
        """One picture: resonances on their engine orders, coloured by the steady amplitude, the size of a point by its damping ratio, with
        the run-up factor beside it; needs matplotlib.

        diagram  lines of the linear modes, from Model.campbell.
        ax       axes; None: new ones.
        hertz    in Hz.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.12)
        >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=3)
        >>> hbvib.campbell_response([(mode, model, 2)], 1e-4).plot().get_ylabel()
        'angular frequency omega'
        """
        from . import _plots
        return _plots.campbell_response(self, diagram, ax, hertz)


def campbell_response(resonances: Sequence[tuple[Branch, Model, float]], acceleration: float = 0.0, *,
                      force_factors: ArrayLike = (1.0,), damping_ratio: float = 0.0, model_damping: int = 0) -> CampbellResponse:
    """The highest resonance of each nonlinear mode under its forces, and how much of it a passage at an acceleration reaches.

    resonances     (mode, model with the forces, engine order) of each.
    acceleration   change of the speed per time, either sign; 0: none.
    force_factors  factors on the forces of the models, each with resonances of its own.
    damping_ratio, model_damping   as in synthesis.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
    >>> model.add_force(0, 0.12)
    >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=3)
    >>> found = hbvib.campbell_response([(mode, model, 2)], 5e-4)
    >>> found.speed.round(2), found.damping_ratio.round(3), found.factor.round(2)
    (array([0.51]), array([0.036]), array([0.8]))
    """
    factors = _array("force_factors", force_factors, np.float64, [None])
    blocks = []
    if not isinstance(resonances, Iterable):
        raise TypeError(f"resonances is of type {type(resonances).__name__}, needs a list of (mode, model, engine order)")
    for number, one in enumerate(resonances):
        try:
            mode, model, order = one
        except (TypeError, ValueError):
            raise ValueError(f"resonances[{number}] is not (mode, model, engine order)") from None
        branch, loaded = _of("Branch", f"resonances[{number}][0]", mode), _of("Model", f"resonances[{number}][1]", model)
        options = _new("hbvib_campbell_options", engine_order=order, acceleration=acceleration, damping_ratio=damping_ratio,
                       model_damping=model_damping)
        rows = np.empty((8, factors.size))
        rows[0], rows[1] = order, factors
        _call("hbvib_campbell_response", branch, loaded, options, None, factors.size, factors, *rows[2:])
        blocks.append(rows)
    columns: Any = np.concatenate(blocks, axis=1) if blocks else np.empty((8, 0))
    return CampbellResponse(*columns)


class _RunUps(_Owner):
    """Methods of Branch for run-ups and missions."""

    def run_up(self, model: Model, omega: ArrayLike, rate: float, *, dof: int = -1, force_factor: float = 1.0,
               damping_ratio: float = 0.0, model_damping: int = 0, integrated_turns: int = 10_000, phase: Hook = None,
               cancel: Optional[CancelFlag] = None) -> RunUp:
        """The amplitude while the frequency of the forces of a plain model changes at a constant rate, from the steady motion at the
        first frequency on, by the slow flow of this nonlinear mode with the memory of sliders. Turns around the largest displacement are
        integrated in time, which corrects it and tells its error. Model.time_sweep integrates all.

        omega        (start, stop), angular frequencies; stop < start runs down.
        rate         change of the angular frequency per time, > 0 in both senses.
        dof          degree of freedom whose displacement is observed; -1: that of the mode.
        force_factor, damping_ratio, model_damping   as in synthesis; with a damping_ratio nothing is integrated.
        integrated_turns   most turns that are integrated in time; 0: none.
        phase, cancel   as in nonlinear_mode; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.12)
        >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=5)
        >>> up = mode.run_up(model, (0.8, 1.3), rate=1e-3)
        >>> truth = model.time_sweep((0.8, 1.3), rate=1e-3)
        >>> abs(up.largest / truth.largest - 1) < up.error < 0.01
        True
        """
        loaded = _of("Model", "model", model)
        begin, end = _range("omega", omega, "run_up(model, (0.8, 1.3), rate=1e-3)")
        options = _new("hbvib_run_up_options", omega_start=begin, omega_stop=end, rate=rate, dof=dof, force_factor=force_factor,
                       damping_ratio=damping_ratio, model_damping=model_damping, integrated_turns=integrated_turns)
        turns = abs(end * end - begin * begin) / (4 * np.pi * abs(rate)) if rate else 0.0
        room = int(min(turns, 2e5)) + 2 if turns == turns else 2
        lists = [np.empty(room) for _ in range(4)]
        count, info = ctypes.c_int64(), _new("hbvib_run_up_info")
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_branch_run_up", self.handle, loaded, options, hooks, room, *lists, count, info, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        time, frequency, amplitude, modal = (values[:count.value].copy() for values in lists)
        return RunUp(time, frequency, amplitude, modal, info.largest, info.largest_omega, info.largest_time, info.error,
                     info.without_memory, info.steady, info.slow_flow, info.integrated)

    def mission(self, model: Model, time: ArrayLike, speed: ArrayLike, *, engine_order: float = 1.0, dof: int = -1,
                edges: ArrayLike = (), stresses: ArrayLike = (), woehler: Optional[Sequence[float]] = None, force_factor: float = 1.0,
                damping_ratio: float = 0.0, model_damping: int = 0, phase: Hook = None, cancel: Optional[CancelFlag] = None) -> Mission:
        """This nonlinear mode over a mission: amplitudes, cycles of each amplitude, and the sum of Miner, by its slow flow.

        time, speed  of rotation, straight between the times; forces have the angular frequency engine_order times speed.
        dof          degree of freedom whose amplitude is read; -1: that of the mode.
        edges        rising amplitudes between which cycles are counted.
        stresses     stress amplitude per modal amplitude of each place, >= 0.
        woehler      (stress, cycles, slope[, slope below]) of the knee: N = cycles (stress/s)^slope; without a slope below it, stresses
                     there do no damage.
        force_factor, damping_ratio, model_damping   as in synthesis.
        phase, cancel   as in nonlinear_mode; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
        >>> contact = model.add_contact("jenkins", 0, kt=0.2, mu=0.1, preload=1)
        >>> model.add_force(0, 0.12)
        >>> mode = model.nonlinear_mode((-2, 0.8), harmonics=5)
        >>> flight = mode.mission(model, [0, 1e4], [0.8, 1.3], edges=[0.5, 1.0], stresses=[80], woehler=(100, 2e6, 5))
        >>> flight.cycles.round(), bool(flight.damage[0] > 0)
        (array([910., 501., 260.]), True)
        """
        loaded = _of("Model", "model", model)
        times, speeds = _array("time", time, np.float64, [None]), _array("speed", speed, np.float64, [None])
        if times.size != speeds.size:
            raise ValueError(f"speed has {speeds.size} numbers, needs {times.size} as time has")
        bounds, factors = _array("edges", edges, np.float64, [None]), _array("stresses", stresses, np.float64, [None])
        line = [0.0] * 4 if woehler is None else [float(x) for x in woehler] + [0.0] * (4 - len(woehler))
        if len(line) != 4 or (woehler is not None and len(woehler) < 3):
            raise ValueError("woehler needs (stress, cycles, slope) or (stress, cycles, slope, slope below)")
        options = _new("hbvib_mission_options", times=times, speeds=speeds, points_len=times.size, engine_order=engine_order, dof=dof,
                       edges=bounds, edges_len=bounds.size, stresses=factors, stresses_len=factors.size, woehler_stress=line[0],
                       woehler_cycles=line[1], woehler_slope=line[2], woehler_slope_below=line[3], force_factor=force_factor,
                       damping_ratio=damping_ratio, model_damping=model_damping)
        amplitude, cycles, damage = np.empty(times.size), np.empty(bounds.size + 1), np.empty(factors.size)
        # A passage in each interval at most, and those within.
        room = 2 * times.size + 16
        passages, count, error = np.empty((room, 6)), ctypes.c_int64(), ctypes.c_double()
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_branch_mission", self.handle, loaded, options, hooks, amplitude, cycles, damage, room, passages,
                           count, error, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        rows: FloatArray = passages[:count.value].T.copy()
        return Mission(amplitude, cycles, damage, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], error.value)
