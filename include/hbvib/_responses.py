"""Responses: what of the motion is watched, and what a branch tells of it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Iterable, Optional, Sequence, Union

import numpy as np

from ._c import Component, Measure
from ._calls import _call
from ._convert import _array, _member, _whole
from ._library import structs
from ._structs import _new

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._choices import Components, Measures
    from ._results import ComplexArray, FloatArray, Kinks, Points


class Response:
    """A gauge, the weighted sum of degrees of freedom of one sector, and what is read from it over a period.

    dofs       degrees of freedom, one or several; None: the response degree of freedom of the solver.
    measure    "fundamental" or "harmonic": amplitude and phase of one harmonic; "peak": the largest magnitude over the
               period; "rms": root of the mean square, mean included; "range": largest value minus smallest one.
    weights    one number for each degree of freedom; None: 1 each.
    harmonic   number of the harmonic of "harmonic".
    sector     sector of the wheel, from 0.
    component  "displacement", "velocity" or "acceleration".

    >>> import hbvib
    >>> hbvib.Response([0, 1], "peak", weights=[1, -1], component="velocity")
    Response([0, 1], 'peak', weights=[1.0, -1.0], component='velocity')
    """

    def __init__(self, dofs: Optional[ArrayLike] = None, measure: Measures = "fundamental", *,
                 weights: Optional[ArrayLike] = None, harmonic: int = 1, sector: int = 0,
                 component: Components = "displacement") -> None:
        self.dofs = None if dofs is None else _array("dofs", np.atleast_1d(dofs), np.int64, [None])
        self.measure = _member(Measure, measure)
        self.weights = None if weights is None else _array("weights", np.atleast_1d(weights), shape=[None])
        self.harmonic, self.sector = _whole(harmonic, name="harmonic"), _whole(sector, name="sector")
        self.component = _member(Component, component)
        if self.weights is not None and len(self.weights) != (0 if self.dofs is None else len(self.dofs)):
            raise ValueError(f"weights has {len(self.weights)} numbers, needs one for each of the dofs")

    def __repr__(self) -> str:
        text = f"Response({None if self.dofs is None else self.dofs.tolist()}, {self.measure.name.lower()!r}"
        if self.weights is not None:
            text += f", weights={self.weights.tolist()}"
        if self.measure == Measure.HARMONIC:
            text += f", harmonic={self.harmonic}"
        if self.sector:
            text += f", sector={self.sector}"
        if self.component != Component.DISPLACEMENT:
            text += f", component={self.component.name.lower()!r}"
        return text + ")"

    def of(self, harmonics: ArrayLike, omega: float = 0) -> float:
        """The measure of any motion: of a nonlinear mode, a synthesis, an integration in time.

        harmonics  (H + 1, ndof) complex, such as Branch.harmonics and TimeResponse.harmonics are; sector 0 alone.
        omega      angular frequency, for velocities and accelerations.

        >>> import hbvib
        >>> hbvib.Response(0, "rms").of([[3], [4j]])  # 3 + 4 cos(omega t + pi/2)
        4.123105625617661
        """
        return self._of(harmonics, omega)[0]

    def _of(self, harmonics: ArrayLike, omega: float) -> tuple[float, complex, float]:
        """Value, complex amplitude and instant."""
        x = _array("harmonics", harmonics, np.complex128, [None, None])
        value, number, instant = ctypes.c_double(), np.empty(1, complex), ctypes.c_double()
        _call("hbvib_response_of", self._description(), x.shape[1], omega, x, x.size, value, number, instant)
        return value.value, complex(number[0]), instant.value

    def _description(self) -> Any:
        count = 0 if self.dofs is None else len(self.dofs)
        return _new("hbvib_response", measure=self.measure, harmonic=self.harmonic, n=count, dofs=self.dofs,
                    weights=self.weights, sector=self.sector, component=self.component)


#: What forced_response takes as responses: each a Response, or a degree of freedom, whose fundamental is watched.
Responses = Iterable[Union[Response, int]]


def contents(response: Response) -> dict[str, Any]:
    """A response as a file holds it."""
    return dict(dofs=None if response.dofs is None else response.dofs.tolist(), measure=int(response.measure),
                weights=None if response.weights is None else response.weights.tolist(), harmonic=response.harmonic,
                sector=response.sector, component=int(response.component))


def listed(given: Optional[Responses]) -> list[Response]:
    """The responses of a caller."""
    found = [] if given is None else list(given)
    return [one if isinstance(one, Response) else Response(_whole(one, name="responses")) for one in found]


def structures(given: Sequence[Response]) -> tuple[Any, Any]:
    """An array of structs of responses, and what it points to."""
    each = [one._description() for one in given]
    return (structs["hbvib_response"] * len(given))(*each), each


def described(options: Any, given: list[Response], single: bool = False) -> None:
    """Writes responses into options, which keep them."""
    if given:
        array, each = structures(given)
        options.__dict__.setdefault("arrays", []).extend([array, each])
        if single:
            options.response = ctypes.addressof(array)
        else:
            options.responses, options.responses_len = ctypes.addressof(array), len(given)


class WatchedResponse:
    """A response over the points of a branch; arrays are over the points of the curve. Made by Branch.responses.

    response    what was asked for.
    amplitude   the measure.
    complex     complex amplitude of a harmonic, NaN for other measures.
    error       estimated relative error, NaN where unknown.
    instant     phase omega t of the largest magnitude of a peak, or of the largest value of a range; else NaN.
    stored      the measure at all stored points: place in it = number of the point.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.06, stiffness=1)
    >>> contact = model.add_spring_damper(0, spring=[0, 0, 0.3])
    >>> model.add_force(0, 0.6)
    >>> branch = model.forced_response((0.3, 0.6), harmonics=7, responses=[0, hbvib.Response(0, "harmonic", harmonic=3)])
    >>> branch.responses[1].peaks().omega.round(3)  # a third of the resonance
    array([0.362])
    """

    def __init__(self, response: Response, points: int, readings: Sequence[Any], peaks: Points, kinks: Kinks) -> None:
        value, number, error, instant = readings
        self.response: Response = response
        self.stored: FloatArray = value
        self.amplitude: FloatArray = value[:points]
        self.complex: ComplexArray = number[:points]
        self.error: FloatArray = error[:points]
        self.instant: FloatArray = instant[:points]
        self._readings, self._peaks, self._kinks = readings, peaks, kinks

    def __repr__(self) -> str:
        return f"<hbvib.WatchedResponse of {self.response!r}: {len(self.amplitude)} points, {len(self._peaks.omega)} peaks>"

    def peaks(self) -> Points:
        """Maxima of the measure within the range, refined on the solution: omega, amplitude, point number.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.2), responses=[hbvib.Response(0, "rms")])
        >>> branch.responses[0].peaks().amplitude.round(3)
        array([1.416])
        """
        return self._peaks

    def kinks(self) -> Kinks:
        """Where another instant of the period takes the lead of a peak or a range: omega, amplitude, and the numbers of the
        points on both sides, at which derivatives are those of the sides.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> model.add_force(0, 0.3j, harmonic=2)
        >>> branch = model.forced_response((0.6, 0.9), responses=[hbvib.Response(0, "peak")])
        >>> branch.responses[0].kinks().omega.round(3)
        array([])
        """
        return self._kinks
