"""Parameters of a model, and derivatives of results by them."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from ._c import Derivative, LogLevel, ParameterKind, Part, Quantity, Scaling, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _member
from ._errors import Stopped, _sentence
from ._library import structs
from ._responses import Response
from ._structs import _matrix, _new

if TYPE_CHECKING:
    from ._branch import Branch
    from ._calls import CancelFlag, Hook
    from ._choices import ParameterKinds, Quantities, Scalings


class Parameter:
    """A parameter of a model, by which results are differentiated.

    kind       "force": a factor on all forces; "preload", "mu", "kt", "kn", "gap", "slider_t1", "slider_t2": a constant
               of a contact; "mass", "damping", "stiffness"; "speed": the fixed speed of rotation; or a ParameterKind.
    contact    number of the contact; -1: the constant of all contacts that have it, changed together.
    direction  of mass, damping and stiffness, ndof x ndof: the parameter is the coefficient, 0 at present, of this
               matrix, which is added; in a cyclic model to the block of the sector itself.
    scaling    "additive", or "factor": a factor, 1 at present, on the whole matrix with its couplings.

    >>> import hbvib
    >>> hbvib.Parameter("kt", contact=0)
    hbvib.Parameter('kt', contact=0)
    """

    def __init__(self, kind: ParameterKinds, contact: int = -1, direction: Any = None,
                 scaling: Scalings = "additive") -> None:
        self.kind: ParameterKind = _member(ParameterKind, kind)
        self.contact, self.direction = contact, direction
        self.scaling: Scaling = _member(Scaling, scaling)

    def __repr__(self) -> str:
        text = f"hbvib.Parameter({self.kind.name.lower()!r}"
        if self.contact != -1:
            text += f", contact={self.contact}"
        if self.direction is not None:
            text += ", direction=..."
        return text + (", scaling='factor')" if self.scaling == Scaling.FACTOR else ")")

    def _description(self) -> Any:
        described = _new("hbvib_parameter", kind=self.kind, contact=self.contact, scaling=self.scaling)
        if self.direction is not None:
            described.matrix = _matrix(self.direction, Part.GENERAL)  # kept as long as the struct
            described.direction = ctypes.addressof(described.matrix)
        return described


class Sensitivities(np.ndarray[Any, np.dtype[np.float64]]):
    """Derivatives of a result by parameters, an array in their order; `reasons` has for each the reason why it is NaN,
    or an empty text.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> found = model.sensitivity(branch, branch.peaks().point[0], [hbvib.Parameter("kt"), hbvib.Parameter("mu")])
    >>> found.shape, found.reasons
    ((2,), ('', ''))
    """
    reasons: tuple[str, ...]

    def __array_finalize__(self, other: Any) -> None:
        self.reasons = getattr(other, "reasons", ())


class ComplexSensitivities(np.ndarray[Any, np.dtype[np.complex128]]):
    """Derivatives of a complex amplitude by parameters at a fixed frequency, an array in their order. `value` is the amplitude,
    `by_omega` its derivative by the angular frequency along the branch, and `reasons` as of Sensitivities.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response(1.0)
    >>> found = model.response_sensitivity(branch, 0, hbvib.Parameter("damping", scaling="factor"))
    >>> bool(abs(found.value + 2j) < 1e-12 and abs(found[0] - 2j) < 1e-12)  # X = 0.2 / 0.1i
    True
    """
    value: complex
    by_omega: complex
    reasons: tuple[str, ...]

    def __array_finalize__(self, other: Any) -> None:
        self.value, self.by_omega = getattr(other, "value", 0j), getattr(other, "by_omega", 0j)
        self.reasons = getattr(other, "reasons", ())


class _Sensitivity(_Owner):
    """Methods of Model for derivatives."""

    def sensitivity(self, branch: Branch, point: int, parameters: Union[Parameter, Sequence[Parameter]],
                    of: Quantities = "amplitude", *, response: Optional[int] = None, phase: Hook = None,
                    cancel: Optional[CancelFlag] = None) -> Sensitivities:
        """Exact derivatives of a result at a point of this model by parameters, from one adjoint solution for all.

        of      "amplitude": of a forced response at fixed frequency; "peak_amplitude", "peak_omega": of a peak, which
                moves; "mode_omega", "mode_damping": of a nonlinear mode at fixed amplitude; or a Quantity.
        response  number of a response of the branch, which "amplitude" and "peak_omega" are then those of.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.
        NaN where a derivative does not exist, as at the onset of slip: `reasons` tells why.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> by_preload, by_force = model.sensitivity(
        ...     branch, branch.peaks().point[0], [hbvib.Parameter("preload"), hbvib.Parameter("force")], "peak_amplitude")
        >>> bool(abs(by_preload + by_force - branch.peaks().amplitude[0]) < 1e-8)  # both together scale the motion
        True
        """
        listed = [parameters] if isinstance(parameters, Parameter) else parameters
        given = [parameter._description() for parameter in listed]
        array = (structs["hbvib_parameter"] * len(given))(*given)
        values, reasons, onset = np.empty(len(given)), np.empty(len(given), np.int64), ctypes.c_int64()
        quantity = _member(Quantity, of)
        if response is not None:
            of_peak = quantity in (Quantity.PEAK_OMEGA, Quantity.RESPONSE_PEAK_OMEGA)
            quantity = (Quantity.RESPONSE_PEAK_OMEGA if of_peak else Quantity.RESPONSE) + response
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_sensitivity", self.handle, branch.handle, point, int(quantity), array,
                           len(given), values, values.size, reasons, onset, hooks, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        found = values.view(Sensitivities)
        found.reasons = _reasons(reasons, onset.value)
        return found

    def response_sensitivity(self, branch: Branch, point: int, parameters: Union[Parameter, Sequence[Parameter]],
                             response: Union[int, Response, None] = None, *, phase: Hook = None,
                             cancel: Optional[CancelFlag] = None) -> ComplexSensitivities:
        """Exact derivatives of a complex amplitude at a stored point of a forced response of this model by parameters.

        response   a Response with the measure "fundamental" or "harmonic", or a degree of freedom; None: the response degree of
                   freedom of the branch. The branch need not have watched it.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.
        NaN where a derivative does not exist, as at the onset of slip: `reasons` tells why.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> by_preload, by_force = found = model.response_sensitivity(
        ...     branch, branch.peaks().point[0], [hbvib.Parameter("preload"), hbvib.Parameter("force")])
        >>> bool(abs(by_preload + by_force - found.value) < 1e-8)  # both together scale the motion
        True
        """
        listed = [parameters] if isinstance(parameters, Parameter) else parameters
        given = [parameter._description() for parameter in listed]
        array = (structs["hbvib_parameter"] * len(given))(*given)
        watched = response if isinstance(response, Response) or response is None else Response(response)
        values, reasons, onset = np.empty(len(given), complex), np.empty(len(given), np.int64), ctypes.c_int64()
        numbers = np.empty((2, 2))
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_response_sensitivity", self.handle, branch.handle, point,
                           None if watched is None else watched._description(), array, len(given), values, values.size, reasons, onset,
                           numbers[0], numbers[1], hooks, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        found = values.view(ComplexSensitivities)
        found.value, found.by_omega = complex(*numbers[0]), complex(*numbers[1])
        found.reasons = _reasons(reasons, onset.value)
        return found


def _reasons(reasons: Any, onset: int) -> tuple[str, ...]:
    texts = {Derivative.EXISTS: "", Derivative.ONSET_OF_SLIP: f"contact {onset} is at the onset of slip",
             Derivative.ONE_SIDED: "the constant is 0, and a derivative exists on one side only",
             Derivative.FOLD: "the point is a fold"}
    return tuple(texts[Derivative(int(reason))] for reason in reasons)
