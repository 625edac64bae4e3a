"""Natural modes of the linear model, and Campbell diagrams."""
from __future__ import annotations

import copy
import ctypes
import warnings
from typing import TYPE_CHECKING, Any, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._c import ContactState
from ._calls import _stoppable
from ._convert import _array, _diameter, _member, _whole
from ._matrices import _Matrices
from ._results import Campbell, Crossings, DampedModes, Interference, Modes

if TYPE_CHECKING:
    from ._calls import CancelFlag, Hook
    from ._choices import ContactStates


_GROWS = -1e-12  # damping ratio below which a mode grows; above it is rounding


def _warn_of_growth(ratio: Any, speeds: Any) -> None:
    rows, modes = np.nonzero(ratio < _GROWS)
    if rows.size:
        at = "" if speeds is None else f" at the speed {speeds[rows[0]]:.9g}"
        warnings.warn(f"mode {modes[0]} has the damping ratio {ratio[rows[0], modes[0]]:.3e}{at}: its motion grows",
                      RuntimeWarning, stacklevel=3)


class _LinearModes(_Matrices):
    """Methods of Model for its linear modes."""

    def linear_modes(self, count: int, diameter: Optional[int] = 0, contacts: ContactStates = ContactState.STUCK, *,
                     phase: Hook = None,
                     cancel: Optional[CancelFlag] = None) -> Modes:
        """Undamped natural modes: omega (count), ascending, and shapes (count, ndof), complex, phi^H M phi = 1. A motion that
        grows, where the stiffness is negative, has an omega below zero, minus the rate of its growth, and a RuntimeWarning.
        Degrees of freedom under a penalty as 1e36 on the diagonal of the stiffness are fixed: they have no mode.

        diameter   signed nodal diameter d, modulo the sectors: sector s + 1 lags by 2 pi d / sectors; None: that of the
                   engine order of the model. With gyroscopic forces the waves d and -d have other modes.
        contacts   "stuck", "free" or "static".
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> modes = model.linear_modes(2)
        >>> modes.omega.round(12), modes.shapes.shape
        (array([1.        , 1.73205081]), (2, 2))
        """
        count = _whole(count, name="count")
        omega, shapes = np.empty(count), np.empty((count, self.ndof), complex)
        _stoppable("hbvib_linear_modes", self.handle, _diameter(diameter), _member(ContactState, contacts), count, omega,
                   shapes, phase=phase, cancel=cancel)
        if omega.size and omega[0] < 0:
            warnings.warn(f"the stiffness is negative in some direction: a motion grows as {-omega[0]:.9g} per time unit",
                          RuntimeWarning, stacklevel=2)
        return Modes(omega, shapes)

    def damped_modes(self, count: int, diameter: Optional[int] = 0,
                     contacts: ContactStates = ContactState.STUCK) -> DampedModes:
        """Damped natural modes at the speed of the model, by rising frequency: eigenvalue (upper half plane), omega
        (its imaginary part), damping_ratio (minus its real part over its modulus; negative: the motion grows), shape
        (count, ndof), phi^H M phi = 1, and direction: 1 forward, -1 backward, 0 undefined, the sign of the change of
        omega with the speed at fixed K1. Motions that do not oscillate are not counted unless they grow: these come first,
        with omega 0 and the damping ratio -1. diameter and contacts are those of linear_modes; `interference` has all
        diameters of both senses at once.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_rayleigh(0.02, 0)
        >>> model.damped_modes(2).damping_ratio.round(6)
        array([0.01    , 0.005774])
        """
        count = _whole(count, name="count")
        eigenvalue, shape = np.empty(count, complex), np.empty((count, self.ndof), complex)
        direction = np.empty(count, np.int64)
        self._call("hbvib_damped_modes", _diameter(diameter), _member(ContactState, contacts), count, eigenvalue, shape,
                   direction, None)
        ratio = -eigenvalue.real / np.abs(eigenvalue)
        _warn_of_growth(ratio[None, :], None)
        return DampedModes(eigenvalue, eigenvalue.imag.copy(), ratio, shape, direction)

    def campbell(self, speeds: ArrayLike, count: int, engine_orders: Sequence[int] = (1,),
                 diameter: Optional[int] = None, contacts: ContactStates = ContactState.STUCK) -> Campbell:
        """Campbell diagram: omega, damping_ratio and direction (speeds, count) of the damped modes at rising speeds, NaN
        where fewer motions oscillate, and the crossings with engine orders, omega = engine_order Omega.

        An engine order meets the modes of the wave that it excites, whichever sense of its diameter is drawn: 9 of 10
        sectors those of the wave -1, which is the `diameter` of its crossings. It meets none of another diameter.

        diameter   signed nodal diameter of omega, modulo the sectors; None: that of the first engine order.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> model.campbell([0.0, 0.5, 1.0, 1.5], 2).crossings.speed.round(4)  # critical speeds
        array([0.9129, 1.118 ])
        """
        speeds, state = _array("speeds", speeds, np.float64).ravel(), _member(ContactState, contacts)
        count = _whole(count, name="count")
        orders = [_whole(order, name="engine_order") for order in engine_orders]
        if diameter is None:
            diameter = self._signed(orders[0]) if orders else 0
        diameter = _whole(diameter, name="diameter")
        omega, ratio = np.empty((speeds.size, count)), np.empty((speeds.size, count))
        direction = np.empty((speeds.size, count), np.int64)
        self._call("hbvib_campbell", speeds.size, speeds, diameter, state, count, omega, ratio, direction, None)
        room, found, rows = speeds.size * count, ctypes.c_int64(), []
        at, frequency, sense = np.empty(room), np.empty(room), np.empty(room, np.int64)
        for order in orders:
            self._call("hbvib_campbell_crossings", speeds.size, speeds, diameter, state, count, order, room, at,
                       frequency, sense, found, None)
            wave = self._signed(order)
            rows += [(order, *row, wave) for row in zip(at[:found.value], frequency, sense)]
        crossed, critical, frequencies, senses, waves = zip(*rows) if rows else ((), (), (), (), ())
        crossings = Crossings(np.array(crossed, np.int64), np.array(critical, float), np.array(frequencies, float),
                              np.array(senses, np.int64), np.array(waves, np.int64))
        _warn_of_growth(ratio, speeds)
        return Campbell(speeds, omega, ratio, direction, crossings, self._signed(diameter))

    def _signed(self, waves: int) -> int:
        found = ctypes.c_int64()
        self._call("hbvib_cyclic_signed_diameter", waves, found)
        return int(found.value)

    def interference(self, count: int, contacts: ContactStates = ContactState.STUCK) -> Interference:
        """Damped modes of all waves of a wheel at the speed of the model, those of both senses of each nodal diameter:
        diameters (sectors), signed and rising, and omega, damping_ratio and direction (sectors, count) as in damped_modes,
        NaN where fewer motions oscillate. Together they are all modes of the wheel, each once.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, mass=1, stiffness=1, damping=0.01)
        >>> model.set_aero(0, [-0.02, 0.02], [1, -1])  # per displacement: drives waves of one sense
        >>> import warnings; warnings.simplefilter("ignore")  # "modes grow in 3 of 8 waves"
        >>> found = model.interference(1)
        >>> found.diameters[found.damping_ratio[:, 0] < 0]
        array([1, 2, 3])
        """
        waves, equal = self.sectors, ctypes.c_int64()
        diameters, omega, ratio = np.empty(waves, np.int64), np.empty((waves, count)), np.empty((waves, count))
        direction = np.empty((waves, count), np.int64)
        self._call("hbvib_interference", _member(ContactState, contacts), count, waves, diameters, omega, ratio,
                   direction, equal, None)
        grows = (ratio < _GROWS).any(1)
        if grows.any():
            row, mode = np.unravel_index(np.nanargmin(ratio), ratio.shape)
            warnings.warn(f"modes grow in {grows.sum()} of {waves} waves: mode {mode} of the nodal diameter {diameters[row]} "
                          f"has the damping ratio {ratio[row, mode]:.3e}", RuntimeWarning, stacklevel=2)
        return Interference(diameters, omega, ratio, direction, bool(equal.value))

    def plot_campbell(self, speeds: ArrayLike, count: int, engine_orders: Sequence[int] = (1,),
                      diameter: Optional[int] = None, contacts: ContactStates = ContactState.STUCK, *, ax: Any = None,
                      hertz: bool = False, **line: Any) -> Any:
        """Draws the Campbell diagram with matplotlib: natural frequencies over the speed of rotation, lines of engine
        orders, crossings as dots, and pale the curves of the other sense of the diameter where an engine order meets them.
        Returns the axes. ImportError without matplotlib.

        speeds, count, engine_orders, diameter, contacts   as in campbell, in rad per time unit.
        ax      axes to draw into; None: new ones.    hertz   True: axes in 1 / time unit.    line   options of ax.plot.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> axes = model.plot_campbell([0.0, 0.5, 1.0, 1.5], 2, engine_orders=(1, 2))
        >>> axes.get_ylabel()
        'angular frequency omega'
        """
        from . import _plots
        diagram = self.campbell(speeds, count, engine_orders, diameter, contacts)
        opposite = None
        if (diagram.crossings.diameter != diagram.diameter).any():
            opposite = self.campbell(speeds, count, (), -diagram.diameter, contacts)
        return _plots.campbell(diagram, opposite, engine_orders, ax, hertz, line)

    def plot_interference(self, speed: float, count: int, engine_orders: Sequence[int] = (),
                          contacts: ContactStates = ContactState.STUCK, *, ax: Any = None, hertz: bool = False,
                          **line: Any) -> Any:
        """Draws the interference (SAFE) diagram of a wheel with matplotlib: frequencies of the damped modes over the nodal
        diameter at one speed, and the frequency of each engine order at the diameter that it excites. Diameters are signed
        where both senses differ, else folded onto 0 .. sectors / 2. A dot on the line is a resonance. Returns the axes. ValueError for a structure that is not cyclic, ImportError without
        matplotlib.

        speed           in rad per time unit.    count, contacts   as in damped_modes, for each nodal diameter.
        engine_orders   marked on the line; none: the line alone.
        ax              axes to draw into; None: new ones.    hertz   True: 1 / time unit.    line   options of the dots.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> axes = model.plot_interference(0.5, 1, engine_orders=(2, 3))
        >>> axes.get_xlabel()
        'nodal diameter'
        """
        from . import _plots
        if self.sectors == 1:
            raise ValueError("plot_interference needs a cyclic structure: a plain one has no nodal diameters")
        rotating = copy.copy(self)
        rotating.set_speed(speed)
        return _plots.interference(rotating.interference(count, contacts), speed, engine_orders, ax, hertz, line)
