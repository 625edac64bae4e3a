"""Fit of parameters to data of tests, with their uncertainty."""
from __future__ import annotations

import ctypes
import warnings
from typing import TYPE_CHECKING, Any, Callable, Optional, Sequence, Union, cast

import numpy as np

from ._analyses import _solver_options
from ._c import LogLevel, Status, Suspicion
from ._calls import _call, _Guard, _hooks, _Owner
from ._errors import Stopped, StoppedEarly, _sentence
from ._fit_results import Fit, SuspiciousUnits
from ._library import structs
from ._measured import Measured, Unknowns, listed_unknowns
from ._structs import _new, _with_options
from ._types import SolverOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._calls import CancelFlag, Hook
    from ._model import Model
    from ._results import Progress


class _Fits(_Owner):
    """Methods of Model for fits."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def fit(self, unknowns: Unknowns, data: Union[Measured, Sequence[Measured]], *, huber: float = 0, starts: int = 1,
            max_iterations: int = 60, end_step: float = 1e-6, scale_covariance: bool = False,
            progress: Optional[Callable[[Progress], Any]] = None, log: Optional[Callable[[LogLevel, str], Any]] = None,
            phase: Hook = None, cancel: Optional[CancelFlag] = None, **solver: Unpack[SolverOptions]) -> Fit:
        """Fits parameters of this model to data of tests: the values of least loss, with their covariance. Derivatives are exact.

        unknowns   a list of Unknown or Parameter; or a dict such as {"kt": 0, "mu": 0, "damping": "factor"}: constants of contact
                   0, or of "all" contacts, and factors on matrices.
        data       one Measured or several, of any kinds.
        huber      standard deviations beyond which a residual counts by its magnitude, 1.345 for example; 0: by its square.
        starts     points from which is searched; others are tried where the given one fits poorly.
        max_iterations   from each start; end_step: in standard deviations, at which the search ends;
                         with 200 numbers of data and more at an estimated error of 1e-5, unless it is
                         smaller than 1e-6; a complex point has two numbers.
        scale_covariance   by chi2 over the degrees of freedom, where standard deviations are known up to a factor.
        progress, log, phase, cancel   as in forced_response; the parameter of a point is the loss. Options of the solver;
                   harmonics without tolerance means tolerance = 0:

        {options}

        NumericalError tells where the data do not tell an unknown, and why; SuspiciousUnits is warned of where data look like
        hertz or millimetres.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> omega = [1.1, 1.15, 1.2, 1.25, 1.3]
        >>> branch = model.forced_response((1.1, 1.3), at=omega, harmonics=9)
        >>> x = [complex(branch.harmonics(branch.at(i).point[0])[1, 0]) for i in range(5)]
        >>> start = [hbvib.Unknown(hbvib.Parameter("kt", 0), 0.8), hbvib.Unknown(hbvib.Parameter("mu", 0), 0.4)]
        >>> fit = model.fit(start, hbvib.Measured("response", omega, x, 0.01), harmonics=9)
        >>> fit.theta.round(6)
        array([1. , 0.3])
        """
        model = cast("Model", self)
        listed, sets = listed_unknowns(unknowns), [data] if isinstance(data, Measured) else list(data)
        settings = _solver_options("fit", solver)
        options = _new("hbvib_fit_options", huber=huber, starts=starts, max_iterations=max_iterations, step=end_step,
                       scale_covariance=int(scale_covariance))
        p, rows = len(listed), 2 * sum(map(len, sets))
        parameters = [one.parameter._description() for one in listed]
        described, measured = [one._description() for one in listed], [one._description() for one in sets]
        info, handle = _new("hbvib_fit_info"), ctypes.c_void_p()
        theta, covariance = np.zeros(p), np.zeros((p, p))
        residuals, values = np.zeros(rows), np.zeros(rows)
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_fit", model.handle, settings, options, hooks, (structs["hbvib_parameter"] * p)(*parameters), p,
                           (structs["hbvib_unknown"] * p)(*described), (structs["hbvib_data"] * len(sets))(*measured), len(sets),
                           info, theta, covariance, rows, residuals, values, handle, guard=guard)
        if handle.value is None:
            raise Stopped(_sentence(status), Status(status), 0)
        fitted = type(model).__new__(type(model))
        fitted._handle, fitted._kept, fitted._units = handle.value, list(model._kept), model._units
        suspicion = Suspicion(info.suspicion)
        if suspicion == Suspicion.RESPONSE:
            warnings.warn(SuspiciousUnits(f"responses of the data are about {info.suspected_factor:g} times those of the model: "
                                          "check units"), stacklevel=2)
        elif suspicion == Suspicion.FREQUENCY:
            warnings.warn(SuspiciousUnits("angular frequencies of the data differ from those of the model by 2 pi: check whether "
                                          "they are hertz"), stacklevel=2)
        early = _sentence(status) if status else ""
        if status > Status.STOPPED_BY_CALLER:
            warnings.warn(StoppedEarly(early, Status(status)), stacklevel=2)
        kept: dict[str, Any] = dict(huber=huber, starts=starts, max_iterations=max_iterations, end_step=end_step,
                                    scale_covariance=scale_covariance, **solver)
        return Fit(model.clone(), fitted, tuple(listed), tuple(sets), kept, theta, covariance, residuals, values, info,
                   Status(status), suspicion, early)
