"""Results that are arrays, as named tuples."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional

from ._c import ContactKind, Status
from ._types import TimeInfo, VerificationInfo

if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    ComplexArray = NDArray[np.complex128]
    IntArray = NDArray[np.int64]
    StringArray = NDArray[np.str_]

__all__ = [
    "AeroEntries", "Bifurcations", "Campbell", "ContactForce", "Contact", "Crossings", "DampedModes", "Floquet", "Forces", "HigherPeaks",
    "LimitCycles", "Loop", "Modes",
    "Optima", "Points", "Progress", "Residual", "Springs", "Synthesis", "SynthesisPeaks", "TimeResponse", "Verification", "Wanted",
]


class Progress(NamedTuple):
    """State of a solve at an accepted point, as a progress callback gets it. `parameter` is the angular
    frequency, in a nonlinear mode log10 of the amplitude; `fraction_done` runs from 0 to 1."""
    point: int
    parameter: float
    amplitude: float
    residual: float
    step: float
    newton_iterations: int
    fraction_done: float


class Contact(NamedTuple):
    """A contact of a model, read back.

    kind            ContactKind; TABLE, POLYNOMIAL and CALLER_LAW have no constants.
    a, b            degrees of freedom of the sides along t1, t2 and n, or GROUND.
    sector_offset   side b lies in sector s + sector_offset.
    constants       kt, kn, mu, preload, gap, cubic, velocity, normal and tangent, those that are not zero.
    per_speed2      the normal load is preload + per_speed2 Omega^2 at the speed of rotation Omega."""
    kind: ContactKind
    a: tuple[int, int, int]
    b: tuple[int, int, int]
    sector_offset: int
    constants: dict[str, Any]
    per_speed2: float


class Forces(NamedTuple):
    """Forces of a model: degree of freedom, harmonic, complex peak value; over omega^2 where `unbalance` is True."""
    dof: IntArray
    harmonic: IntArray
    force: ComplexArray
    unbalance: NDArray[np.bool_]


class AeroEntries(NamedTuple):
    """Aerodynamic forces of a model: degrees of freedom of force and motion, sector of the motion, complex coefficient."""
    dof_force: IntArray
    dof_motion: IntArray
    offset: IntArray
    coefficient: ComplexArray


class Springs(NamedTuple):
    """Linear springs of a model: sides a and b (GROUND is -1), sector_offset, stiffness."""
    a: IntArray
    b: IntArray
    sector_offset: IntArray
    stiffness: FloatArray


class Modes(NamedTuple):
    """Undamped natural modes: omega (count), ascending, in rad per time unit; shapes (count, ndof), phi^H M phi = 1."""
    omega: FloatArray
    shapes: ComplexArray


class DampedModes(NamedTuple):
    """Damped natural modes by rising frequency: eigenvalue, its imaginary part omega, damping_ratio (negative: the motion
    grows), shape (count, ndof) with phi^H M phi = 1, direction of whirl (1 forward, -1 backward, 0 undefined)."""
    eigenvalue: ComplexArray
    omega: FloatArray
    damping_ratio: FloatArray
    shape: ComplexArray
    direction: IntArray


class Crossings(NamedTuple):
    """Crossings of natural frequencies with engine orders: omega = engine_order * speed."""
    engine_order: IntArray
    speed: FloatArray
    omega: FloatArray
    direction: IntArray


class Campbell(NamedTuple):
    """A Campbell diagram: omega, damping_ratio and direction (speeds, count), NaN where fewer motions oscillate."""
    speeds: FloatArray
    omega: FloatArray
    damping_ratio: FloatArray
    direction: IntArray
    crossings: Crossings


class Points(NamedTuple):
    """Special points of a branch: angular frequency, peak amplitude, number of the point for other methods."""
    omega: FloatArray
    amplitude: FloatArray
    point: IntArray


class Wanted(NamedTuple):
    """Solutions at one requested frequency (in a mode: amplitude): peak amplitude, number of the point."""
    amplitude: FloatArray
    point: IntArray


class Bifurcations(NamedTuple):
    """Points of a forced response where a multiplier passes the unit circle, with their kinds, and the numbers of unstable
    directions before and after them along the branch, -1 where unknown."""
    omega: FloatArray
    amplitude: FloatArray
    kind: StringArray
    point: IntArray
    unstable_before: IntArray
    unstable_after: IntArray


class LimitCycles(NamedTuple):
    """Points of a nonlinear mode with damping ratio zero; slope is that of the damping ratio by log10_amplitude."""
    omega: FloatArray
    log10_amplitude: FloatArray
    slope: FloatArray
    point: IntArray


class Loop(NamedTuple):
    """Hysteresis loop of a contact over one period: relative motion, force, and State of each time."""
    motion: FloatArray
    force: FloatArray
    state: NDArray[np.int32]


class Synthesis(NamedTuple):
    """A response synthesised from a nonlinear mode; response is the complex fundamental of the response degree of freedom."""
    omega: FloatArray
    response: ComplexArray
    modal_amplitude: FloatArray


class SynthesisPeaks(NamedTuple):
    """Resonances of a synthesised response; flags are sums of SynthesisFlag."""
    omega: FloatArray
    amplitude: FloatArray
    log10_amplitude: FloatArray
    damping_ratio: FloatArray
    other_mode: FloatArray
    error: FloatArray
    flags: NDArray[np.int32]


class Residual(NamedTuple):
    """Residual of harmonic balance, and the derivatives that were requested."""
    residual: ComplexArray
    jacobian: Optional[FloatArray]
    d_omega: Optional[ComplexArray]


class ContactForce(NamedTuple):
    """Harmonics of the force of a contact law, and their derivative where it was requested."""
    force: ComplexArray
    jacobian: Optional[FloatArray]


class TimeResponse(NamedTuple):
    """A periodic response in time: harmonics (H + 1, ndof), samples (samples, ndof), TimeInfo, Status."""
    harmonics: ComplexArray
    samples: FloatArray
    info: TimeInfo
    status: Status


class Verification(NamedTuple):
    """A point compared with integration in time: harmonics in time (H + 1, ndof), relative errors (H + 1)."""
    harmonics: ComplexArray
    errors: FloatArray
    info: VerificationInfo
    status: Status


class Optima(NamedTuple):
    """Optima of a parameter response: value of the parameter, amplitude or damping ratio, kind, point number."""
    parameter: FloatArray
    value: FloatArray
    kind: StringArray
    point: IntArray


class HigherPeaks(NamedTuple):
    """Peaks higher than a followed one: value of the parameter, omega, amplitude, point number of the followed one."""
    parameter: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    point: IntArray


class Floquet(NamedTuple):
    """Stability of a motion: multipliers of one period by falling modulus, their classes ("ordinary", "memory",
    "neutral_stuck", "neutral_rigid", "trivial"), the largest modulus of the ordinary ones, and how many of them lie
    outside the unit circle. `neutral` of the others are 1 by construction. `orbit_change` is the distance that shooting
    moved the point, `omega` the angular frequency of the motion. `reason` tells why the radius is NaN, or is empty."""
    multipliers: ComplexArray
    classes: StringArray
    radius: float
    unstable: int
    neutral: int
    orbit_change: float
    omega: float
    residual: float
    reason: str
    status: Status
