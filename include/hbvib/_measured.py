"""Data of tests for a fit: what was measured, and unknowns of the model."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from ._c import DataKind, Scale
from ._convert import _array, _member, _whole
from ._responses import Response
from ._sensitivity import Parameter
from ._structs import _new

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._choices import DataKinds, Scales
    from ._results import ComplexArray, FloatArray


class Measured:
    """Data of one kind at one level of the force, for Model.fit.

    kind       "response": complex amplitudes at angular frequencies; "amplitude": measures there; "peak": the measure at a peak
               near each frequency; "backbone": angular frequency of a nonlinear mode at log10 of its modal amplitude;
               "linear_mode": angular frequency of the mode in which all contacts stick; or a DataKind.
    x          angular frequencies, or log10 of modal amplitudes; a linear mode does not use them.
    value      the values.
    sigma      standard deviations, one or one for each value: of a complex amplitude that of |X|, sqrt(2) times that of its
               parts.
    second, second_sigma   angular frequencies of peaks, or damping ratios of modes, with their standard deviations; None: these
               are not data.
    force      factor on the forces of the model.
    response   a Response or a degree of freedom; None: the response degree of freedom of the solver.
    mode       number of the linear mode with stuck contacts.
    omega      (start, stop) that is followed; None: as far as the data need.

    >>> import hbvib
    >>> hbvib.Measured("response", [0.9, 1.1], [1 + 0.1j, -0.8 - 0.2j], 0.02, force=0.1)
    <hbvib.Measured: 2 of response, force 0.1>
    """

    def __init__(self, kind: DataKinds, x: ArrayLike, value: ArrayLike, sigma: ArrayLike, *, second: Optional[ArrayLike] = None,
                 second_sigma: Optional[ArrayLike] = None, force: float = 1.0, response: Union[int, Response, None] = None,
                 mode: int = 0, omega: Optional[Sequence[float]] = None) -> None:
        self.kind: DataKind = _member(DataKind, kind)
        self.x: FloatArray = _array("x", np.atleast_1d(x), np.float64, [None])
        n = len(self.x)
        number = np.array(np.broadcast_to(_array("value", np.atleast_1d(value), np.complex128, [None]), n))
        if self.kind != DataKind.RESPONSE and np.iscomplexobj(value):
            raise TypeError(f"value is complex, needs real numbers for {self.kind.name.lower()}")
        if second is not None:
            number.imag = np.broadcast_to(_array("second", np.atleast_1d(second), np.float64, [None]), n)
        self.value: ComplexArray = number
        self.sigma = _spread("sigma", sigma, n)
        self.second_sigma = None if second_sigma is None else _spread("second_sigma", second_sigma, n)
        self.force, self.mode = float(force), _whole(mode, name="mode")
        self.response = response if isinstance(response, Response) or response is None else Response(response)
        self.omega = (0.0, 0.0) if omega is None else (float(omega[0]), float(omega[1]))

    def __len__(self) -> int:
        return len(self.x)

    def __repr__(self) -> str:
        return f"<hbvib.Measured: {len(self)} of {self.kind.name.lower()}, force {self.force:g}>"

    def _description(self) -> Any:
        described = _new("hbvib_data", kind=self.kind, force_factor=self.force, mode=self.mode, omega_start=self.omega[0],
                         omega_stop=self.omega[1], n=len(self), x=self.x, value=self.value, sigma=self.sigma,
                         second_sigma=self.second_sigma)
        if self.response is not None:
            described.kept = self.response._description()  # as long as the struct
            described.response = ctypes.addressof(described.kept)
        return described


def _spread(name: str, value: ArrayLike, n: int) -> FloatArray:
    return np.array(np.broadcast_to(_array(name, np.atleast_1d(value), np.float64, [None]), n))


class Unknown(NamedTuple):
    """A parameter as an unknown of a fit.

    parameter      a Parameter.
    start          first value; None: that of the model. Constants are values, factors multiply the matrices of the model.
    lower, upper   bounds, None: none; equal ones fix it.
    prior          (mean, standard deviation) of what is known of it beside the data, or None.
    scale          "automatic": logarithmic for what is positive; "linear", "log"; or a Scale.
    tied_to        number of an earlier unknown, which it follows in the ratio of their starts; -1: none.
    data_set       number of the data set that alone has it, as each test its residual state; -1: all have it.

    >>> import hbvib
    >>> hbvib.Unknown(hbvib.Parameter("kt", 0), 0.5, lower=0.1).start
    0.5
    """
    parameter: Parameter
    start: Optional[float] = None
    lower: Optional[float] = None
    upper: Optional[float] = None
    prior: Optional[tuple[float, float]] = None
    scale: Scales = Scale.AUTOMATIC
    tied_to: int = -1
    data_set: int = -1

    def _description(self) -> Any:
        given: dict[str, Any] = {}
        for name in ("start", "lower", "upper"):
            value = getattr(self, name)
            if value is not None:
                given[name], given["has_" + name] = value, 1
        if self.prior is not None:
            given["prior_mean"], given["prior_sigma"] = self.prior
        return _new("hbvib_unknown", scale=_member(Scale, self.scale), tied_to=self.tied_to,
                    data_set=self.data_set, **given)


#: What Model.fit takes as unknowns: each an Unknown or a Parameter; or names with the number of a contact, "all" or "factor".
Unknowns = Union[Sequence[Union[Unknown, Parameter]], Mapping[Any, Union[int, str]]]


def listed_unknowns(given: Unknowns) -> list[Unknown]:
    """The unknowns of a caller."""
    if isinstance(given, Mapping):
        found = []
        for name, of in given.items():
            if of == "factor":
                found.append(Unknown(Parameter(name, scaling="factor")))
            elif of == "all":
                found.append(Unknown(Parameter(name)))
            else:
                found.append(Unknown(Parameter(name, contact=_whole(of, name=str(name)))))
        return found
    return [one if isinstance(one, Unknown) else Unknown(one) for one in given]
