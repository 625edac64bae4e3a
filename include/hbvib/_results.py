"""Results that are arrays, as named tuples."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional

from ._c import Status
from ._model_parts import AeroEntries, Contact, Forces, Springs
from ._parameter_results import HigherPeaks, Optima, Turns
from ._types import TimeInfo, VerificationInfo

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    BoolArray = NDArray[np.bool_]
    FloatArray = NDArray[np.float64]
    ComplexArray = NDArray[np.complex128]
    IntArray = NDArray[np.int64]
    StringArray = NDArray[np.str_]

__all__ = [
    "AeroEntries", "Bifurcations", "Campbell", "ContactForce", "Contact", "Crossings", "DampedModes", "Floquet", "Forces", "HigherPeaks",
    "LimitCycles", "Loop", "ModalCoordinates", "Modes",
    "Optima", "Points", "Progress", "Residual", "Springs", "Synthesis", "SynthesisPeaks", "TimeResponse", "Turns", "Verification", "Wanted",
]


class Progress(NamedTuple):
    """State of a solve at an accepted point, as a progress callback gets it. `parameter` is the angular
    frequency, in a nonlinear mode log10 of the amplitude; `fraction_done` runs from 0 to 1.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> def shown(now: hbvib.Progress) -> bool:
    ...     return now.parameter > 1.2  # True stops the solve
    >>> len(model.forced_response((0.8, 1.6), progress=shown)) < len(model.forced_response((0.8, 1.6)))
    True
    """
    point: int
    parameter: float
    amplitude: float
    residual: float
    step: float
    newton_iterations: int
    fraction_done: float


class Modes(NamedTuple):
    """Undamped natural modes: omega (count), ascending, in rad per time unit, below zero minus a rate of growth; shapes
    (count, ndof), phi^H M phi = 1.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.linear_modes(1).omega
    array([1.])
    """
    omega: FloatArray
    shapes: ComplexArray


class DampedModes(NamedTuple):
    """Damped natural modes by rising frequency: eigenvalue, its imaginary part omega, damping_ratio (negative: the motion
    grows), shape (count, ndof) with phi^H M phi = 1, direction of whirl (1 forward, -1 backward, 0 undefined).

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> modes = model.damped_modes(1)
    >>> print("%.3f" % modes.damping_ratio[0])
    0.050
    """
    eigenvalue: ComplexArray
    omega: FloatArray
    damping_ratio: FloatArray
    shape: ComplexArray
    direction: IntArray


class Crossings(NamedTuple):
    """Crossings of natural frequencies with engine orders: omega = engine_order * speed. diameter is the signed nodal
    diameter of the wave that the engine order excites.

    >>> import hbvib
    >>> rotor = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
    >>> rotor.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
    >>> diagram = rotor.campbell([0.0, 0.5, 1.0, 1.5], 2)
    >>> (diagram.crossings.omega / diagram.crossings.speed).round(6).tolist()  # engine order 1
    [1.0, 1.0]
    """
    engine_order: IntArray
    speed: FloatArray
    omega: FloatArray
    direction: IntArray
    diameter: IntArray


class Campbell(NamedTuple):
    """A Campbell diagram: omega, damping_ratio and direction (speeds, count), NaN where fewer motions oscillate, of the
    signed nodal diameter `diameter`.

    >>> import hbvib
    >>> rotor = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
    >>> rotor.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
    >>> diagram = rotor.campbell([0.0, 0.5, 1.0, 1.5], 2)
    >>> diagram.omega.shape  # speeds, modes
    (4, 2)
    """
    speeds: FloatArray
    omega: FloatArray
    damping_ratio: FloatArray
    direction: IntArray
    crossings: Crossings
    diameter: int


class Interference(NamedTuple):
    """Damped modes of all waves of a wheel: signed diameters (sectors), rising, and omega, damping_ratio and direction
    (sectors, count), NaN where fewer motions oscillate. equal_senses: the waves d and -d have the same omega and
    damping_ratio.

    >>> import hbvib
    >>> wheel = hbvib.Model.cyclic(1, sectors=4, mass=1, stiffness=3, coupling=dict(stiffness=-1))
    >>> found = wheel.interference(1)
    >>> found.diameters.tolist(), found.omega[:, 0].round(6).tolist(), found.equal_senses
    ([-1, 0, 1, 2], [1.732051, 1.0, 1.732051, 2.236068], True)
    """
    diameters: IntArray
    omega: FloatArray
    damping_ratio: FloatArray
    direction: IntArray
    equal_senses: bool


class Points(NamedTuple):
    """Special points of a branch: angular frequency, peak amplitude, number of the point for other methods.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> peaks = branch.peaks()
    >>> len(peaks.omega) == len(peaks.amplitude) == len(peaks.point) == 1
    True
    """
    omega: FloatArray
    amplitude: FloatArray
    point: IntArray


class Wanted(NamedTuple):
    """Solutions at one entry of a solve's `at`: angular frequency, peak amplitude, number of the point. The frequency is NaN in a
    parameter response that follows a peak or a fold.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6), at=[1.0])
    >>> branch.at(0).amplitude.shape, branch.at(0).omega
    ((1,), array([1.]))
    """
    omega: FloatArray
    amplitude: FloatArray
    point: IntArray


class Bifurcations(NamedTuple):
    """Points of a forced response where a multiplier passes the unit circle, with their kinds, and the numbers of unstable
    directions before and after them along the branch, -1 where unknown.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.9, 1.3), stability="wave")
    >>> len(branch.bifurcations().omega)  # a linear motion is stable
    0
    """
    omega: FloatArray
    amplitude: FloatArray
    kind: StringArray
    point: IntArray
    unstable_before: IntArray
    unstable_after: IntArray


class LimitCycles(NamedTuple):
    """Points of a nonlinear mode with damping ratio zero; slope is that of the damping ratio by log10_amplitude.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=-0.02)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> cycles = model.nonlinear_mode((-2, 1)).limit_cycles()
    >>> len(cycles.omega) == len(cycles.slope)
    True
    """
    omega: FloatArray
    log10_amplitude: FloatArray
    slope: FloatArray
    point: IntArray


class Loop(NamedTuple):
    """Hysteresis loop of a contact over one period: relative motion, force, and State of each time.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> loop = branch.loop(branch.peaks().point[0], contact)
    >>> print("%.3f" % abs(loop.force).max())  # mu * preload
    0.300
    """
    motion: FloatArray
    force: FloatArray
    state: NDArray[np.int32]


class ModalCoordinates(NamedTuple):
    """A motion in coordinates of modes: coordinates (harmonics, modes), and the share of the motion that the modes lack, of the mass and
    then of the stiffness, where that is given: (1 or 2, harmonics).

    >>> import hbvib
    >>> model = hbvib.Model(mass=2, stiffness=1, rayleigh=(0, 0.02))
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response(0.5, harmonics=1)
    >>> found = branch.modal_coordinates(0, [[1]], [[2]])
    >>> bool(abs(found.coordinates[1, 0] / branch.harmonics(0)[1, 0] - 1) < 1e-12), bool(found.lacking.max() < 1e-12)
    (True, True)
    """
    coordinates: ComplexArray
    lacking: FloatArray


class Synthesis(NamedTuple):
    """A response synthesised from a nonlinear mode; response is the complex fundamental of the response degree of freedom.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> mode = model.nonlinear_mode((-2, 1))
    >>> found = mode.synthesis(model)
    >>> found.omega.shape == found.response.shape
    True
    """
    omega: FloatArray
    response: ComplexArray
    modal_amplitude: FloatArray


class SynthesisPeaks(NamedTuple):
    """Resonances of a synthesised response; flags are sums of SynthesisFlag.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> mode = model.nonlinear_mode((-2, 1))
    >>> peaks = mode.synthesis_peaks(model)
    >>> peaks.flags.tolist()  # no SynthesisFlag: the resonance is that of the response
    [0]
    """
    omega: FloatArray
    amplitude: FloatArray
    log10_amplitude: FloatArray
    damping_ratio: FloatArray
    other_mode: FloatArray
    error: FloatArray
    flags: NDArray[np.int32]


class Residual(NamedTuple):
    """Residual of harmonic balance, and the derivatives that were requested.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> found = model.forced_residual(1.0, [[0], [2]])
    >>> found.residual.shape
    (2, 1)
    """
    residual: ComplexArray
    jacobian: Optional[FloatArray]
    d_omega: Optional[ComplexArray]


class ContactForce(NamedTuple):
    """Harmonics of the force of a contact law, and their derivative where it was requested.

    >>> import hbvib
    >>> found = hbvib.evaluate_contact("cubic", [0, 1], kt=1, cubic=0.5, jacobian=True)
    >>> found.force.shape == (2,), found.jacobian is not None
    (True, True)
    """
    force: ComplexArray
    jacobian: Optional[FloatArray]


class TimeResponse(NamedTuple):
    """A periodic response in time: harmonics (H + 1, ndof), samples (samples, ndof), TimeInfo, Status; places of the slider
    along t1 of each contact at the end, the residual state for Model.set_slider.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> found = model.time_response(1.0)
    >>> found.harmonics.shape, found.status
    ((10, 1), <Status.OK: 0>)
    """
    harmonics: ComplexArray
    samples: FloatArray
    info: TimeInfo
    status: Status
    places: FloatArray


class Verification(NamedTuple):
    """A point compared with integration in time: harmonics in time (H + 1, ndof), relative errors (H + 1).

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> found = model.verify(branch, branch.peaks().point[0])
    >>> found.info.same_solution
    True
    """
    harmonics: ComplexArray
    errors: FloatArray
    info: VerificationInfo
    status: Status


class Kinks(NamedTuple):
    """Kinks of a response: omega, amplitude, numbers of the points before and behind them.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.2), responses=[hbvib.Response(0, "peak")])
    >>> len(branch.responses[0].kinks().omega)  # one harmonic has one largest instant
    0
    """
    omega: FloatArray
    amplitude: FloatArray
    before: IntArray
    after: IntArray


class Floquet(NamedTuple):
    """Stability of a motion: multipliers of one period by falling modulus, their classes ("ordinary", "memory",
    "neutral_stuck", "neutral_rigid", "trivial"), the largest modulus of the ordinary ones, and how many of them lie
    outside the unit circle. `neutral` of the others are 1 by construction. `orbit_change` is the distance that shooting
    moved the point, `omega` the angular frequency of the motion. `reason` tells why the radius is NaN, or is empty.
    A large structure is computed on `modes` modes of each nodal diameter, not on all degrees of freedom (0);
    `modes_change` is the largest change of a multiplier above half the radius from half as many, NaN where
    `orbit_change` is above 0.2; `radius_error` estimates the error of the radius that the other modes make.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> found = model.floquet(branch, branch.peaks().point[0])
    >>> found.radius < 1, found.unstable
    (True, 0)
    """
    multipliers: ComplexArray
    classes: StringArray
    radius: float
    unstable: int
    neutral: int
    orbit_change: float
    omega: float
    residual: float
    reason: str
    modes: int
    modes_change: float
    status: Status
    radius_error: float = 0.0
