"""Results of a fit: values with their uncertainty, residuals, predictions, profiles, a report."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Sequence, Union

import numpy as np

from ._analyses import _solver_options
from ._c import DataKind, LogLevel, Scaling, Status
from ._calls import _call, _Guard, _hooks
from ._convert import _array, _whole
from ._errors import Stopped, _sentence
from ._library import structs
from ._measured import Measured, Unknown
from ._responses import Response
from ._structs import _new

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._c import Suspicion
    from ._calls import CancelFlag, Hook
    from ._choices import DataKinds
    from ._model import Model
    from ._results import ComplexArray, FloatArray, Progress
    from ._sensitivity import Parameter

#: Options of Model.fit that are none of the solver.
_OF_FIT = ("huber", "starts", "max_iterations", "end_step", "scale_covariance")


class SuspiciousUnits(UserWarning):
    """Data of a fit whose units seem to differ from those of the model.

    >>> import hbvib
    >>> issubclass(hbvib.SuspiciousUnits, UserWarning)
    True
    """


class Predicted(NamedTuple):
    """Numbers that a fitted model predicts; made by Fit.predict. Complex for a response; of a peak, a backbone or a linear mode
    the second ones are the angular frequency or the damping ratio.

    value, sigma   and their standard deviations by the delta method; of a complex value those of its parts as a complex number.
    shift          of the mean by the second order: where it is not small against sigma, the delta method is not enough.
    second, second_sigma, second_shift   likewise.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.Predicted(*np.ones((6, 1))).sigma
    array([1.])
    """
    value: Union[FloatArray, ComplexArray]
    sigma: Union[FloatArray, ComplexArray]
    shift: Union[FloatArray, ComplexArray]
    second: FloatArray
    second_sigma: FloatArray
    second_shift: FloatArray


class Profile(NamedTuple):
    """Least chi2 over one parameter, all others fitted again; made by Fit.profile.

    value, chi2    of the scanned parameter; NaN where no fit was found. Of a robust fit its loss, which is what is least.
    best           least chi2 (loss) of the fit.
    unit           rise of chi2 that is one standard deviation: 1, or chi2 by degree of freedom where the fit scaled the
                   covariance by it.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.Profile(np.array([0.0, 1, 2, 3, 4]), np.array([9.0, 1, 0, 1, 9]), 0.0).interval(4.0)
    (0.5, 3.5)
    """
    value: FloatArray
    chi2: FloatArray
    best: float
    unit: float = 1.0

    def interval(self, rise: float = 3.841) -> tuple[float, float]:
        """The interval in which chi2 is below the least one plus `rise` units: 3.841 for 95 %, 1 for one standard deviation. An
        end is infinite where the scan does not reach it.

        >>> import hbvib
        >>> import numpy as np
        >>> hbvib.Profile(np.array([0.0, 1, 2]), np.array([1.0, 0, 1]), 0.0).interval()
        (-inf, inf)
        """
        # The root is a line where chi2 is a parabola.
        above = np.sqrt(np.maximum(self.chi2 - self.best, 0)) - np.sqrt(rise * self.unit)
        least = int(np.nanargmin(self.chi2))
        ends = []
        for step, missing in ((-1, -np.inf), (1, np.inf)):
            end, i = missing, least
            while 0 <= i + step < len(above):
                if above[i] <= 0 < above[i + step]:
                    share = above[i] / (above[i] - above[i + step])
                    end = self.value[i] + share * (self.value[i + step] - self.value[i])
                    break
                i += step
            ends.append(float(end))
        return ends[0], ends[1]


class Fit:
    """Parameters fitted to data; made by Model.fit.

    theta, sd, names   values of the parameters, their standard deviations, 0 for fixed ones, and a name of each.
    covariance, correlation   of them, NaN for fixed ones.
    chi2, degrees_of_freedom   the sum of squares in standard deviations; near each other for a model that explains the data.
    residuals, values  for each data set an array (points, 2): of complex data the real and the imaginary part.
    model              the model with the values.
    status, suspicion  a Status, a Suspicion.
    info               further numbers: loss, data, free, iterations, starts, at_bound, slipping, aic, bic, condition,
                       harmonic_error, suspected_factor.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
    >>> model.add_force(0, 0.2)
    >>> omega = [0.9, 1.0, 1.1]
    >>> x = [0.2 / (1.1 - w * w + 0.1j * w) for w in omega]
    >>> fit = model.fit({"stiffness": "factor"}, hbvib.Measured("response", omega, x, 0.01))
    >>> fit.theta.round(6), bool(fit.chi2 < 1e-9)
    (array([1.1]), True)
    """

    def __init__(self, original: Model, model: Model, unknowns: tuple[Unknown, ...], data: tuple[Measured, ...],
                 options: dict[str, Any], theta: FloatArray, covariance: FloatArray, residuals: FloatArray, values: FloatArray,
                 info: Any, status: Status, suspicion: Suspicion, early: str) -> None:
        self._original, self.model, self.unknowns, self.data, self._options = original, model, unknowns, data, options
        self.theta, self.covariance = theta, covariance
        ends = np.cumsum([2 * len(one) for one in data])[:-1]
        self.residuals = [part.reshape(-1, 2) for part in np.split(residuals, ends)]
        self.values = [part.reshape(-1, 2) for part in np.split(values, ends)]
        self.info, self.status, self.suspicion, self._early = info, status, suspicion, early
        self.sd: FloatArray = np.sqrt(np.diag(covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            self.correlation: FloatArray = np.asarray(covariance / np.outer(self.sd, self.sd))
        self.chi2, self.degrees_of_freedom = float(info.chi2), int(info.degrees_of_freedom)
        self.names = [_name(one.parameter) + (f" set {one.data_set}" if one.data_set >= 0 else "") for one in unknowns]

    def __repr__(self) -> str:
        told = ", ".join(f"{name} = {value:.5g} +- {sd:.2g}" for name, value, sd in zip(self.names, self.theta, self.sd))
        return f"<hbvib.Fit: {told}; chi2 {self.chi2:.4g} on {self.degrees_of_freedom}>"

    def report(self) -> str:
        """The values with standard deviations and correlations, chi2, criteria, the largest residuals, as text.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> data = hbvib.Measured("response", [0.9, 1.1], [0.2 / (1.1 - w * w + 0.1j * w) for w in (0.9, 1.1)], 0.01)
        >>> model.fit({"stiffness": "factor"}, data).report().splitlines()[0]
        'parameter             value    deviation  correlations'
        """
        lines = ["parameter             value    deviation  correlations"]
        for name, value, sd, row in zip(self.names, self.theta, self.sd, self.correlation):
            lines.append(f"{name:<16} {value:>10.6g} {sd:>12.3g}  " + " ".join(f"{c:>6.3f}" for c in row))
        info = self.info
        lines.append(f"chi2 {info.chi2:.6g} on {info.degrees_of_freedom} degrees of freedom, {info.data} data")
        lines.append(f"AIC {info.aic:.6g}, BIC {info.bic:.6g}, condition {info.condition:.3g}, {info.iterations} iterations from "
                     f"{info.starts} starts, {info.slipping} contacts slip")
        if np.isfinite(info.harmonic_error):
            lines.append(f"errors by harmonics are below {info.harmonic_error:.2g} standard deviations")
        if self._early:
            lines.append(f"the search ended early: {self._early}")
        for number, (one, residual) in enumerate(zip(self.data, self.residuals)):
            # NaN where the fit was stopped before all data were evaluated.
            size = np.nan_to_num(np.abs(residual)).max(axis=1)
            worst = int(size.argmax())
            lines.append(f"data set {number}: {one!r}, largest residual {size[worst]:.2g} at x = {one.x[worst]:g}")
        return "\n".join(lines)

    def predict(self, kind: DataKinds, x: ArrayLike, *, force: float = 1.0, response: Union[int, Response, None] = None,
                mode: int = 0, omega: Optional[Sequence[float]] = None, data_set: int = -1) -> Predicted:
        """Predicts numbers with their standard deviations; the arguments are those of Measured. Unknowns of one data set act where
        `data_set` is its number; -1: none of them.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> data = hbvib.Measured("response", [0.9, 1.1], [0.2 / (1.1 - w * w + 0.1j * w) for w in (0.9, 1.1)], 0.01)
        >>> peak = model.fit({"stiffness": "factor"}, data).predict("peak", 1.05, omega=(0.9, 1.2))
        >>> peak.second.round(3)
        array([1.046])
        """
        at = np.atleast_1d(np.asarray(x, float))
        wanted = Measured(kind, at, np.zeros(len(at)), 1.0, force=force, response=response, mode=mode, omega=omega)
        solver = _solver_options("predict", {name: value for name, value in self._options.items() if name not in _OF_FIT})
        own = [k for k, one in enumerate(self.unknowns) if one.data_set in (-1, data_set)]
        parameters = [self.unknowns[k].parameter._description() for k in own]
        theta, covariance = self.theta[own], np.ascontiguousarray(self.covariance[np.ix_(own, own)])
        p, rows = len(parameters), 2 * len(at)
        values, sigma, shift = np.zeros((3, rows))
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, None, None)
            _call("hbvib_predict", self._original.handle, solver, wanted._description(), hooks,
                  (structs["hbvib_parameter"] * p)(*parameters), p, theta, covariance, rows, values, sigma, shift,
                  guard=guard)
        first, second = [part[0::2] for part in (values, sigma, shift)], [part[1::2] for part in (values, sigma, shift)]
        if wanted.kind == DataKind.RESPONSE:
            first = [a + 1j * b for a, b in zip(first, second)]
        return Predicted(*first, *second)

    def profile(self, number: int, values: Optional[ArrayLike] = None, *, progress: Optional[Callable[[Progress], Any]] = None,
                log: Optional[Callable[[LogLevel, str], Any]] = None, phase: Hook = None,
                cancel: Optional[CancelFlag] = None) -> Profile:
        """Least chi2 at fixed values of one parameter, all others fitted again; None: 9 values within three standard deviations,
        on the logarithm of what is positive. Parameters that are tied to it go with it. Hooks are those of Model.fit; the values so
        far are kept where progress stops it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> data = hbvib.Measured("response", [0.9, 1.1], [0.2 / (1.1 - w * w + 0.1j * w) for w in (0.9, 1.1)], 0.01)
        >>> fit = model.fit({"stiffness": "factor", "damping": "factor"}, data)
        >>> low, high = fit.profile(0).interval(1)
        >>> bool(abs((high - low) / (2 * fit.sd[0]) - 1) < 0.05)
        True
        """
        number = _whole(number, name="number")
        if not -len(self.theta) <= number < len(self.theta):
            raise IndexError(f"number = {number}, needs 0 .. {len(self.theta) - 1}")
        number %= len(self.theta)
        if values is None:
            value, sd = float(self.theta[number]), float(self.sd[number])
            steps = np.linspace(-3, 3, 9)
            values = value * np.exp(steps * sd / value) if value > 0 else value + steps * sd
        at = _array("values", np.atleast_1d(values), np.float64, [None])
        order = np.argsort(at, kind="stable")
        ascending, (p, sets) = np.ascontiguousarray(at[order]), (len(self.theta), len(self.data))
        given = {name: value for name, value in self._options.items() if name not in _OF_FIT}
        solver = _solver_options("profile", given)
        options = _new("hbvib_fit_options", huber=self._options["huber"], starts=self._options["starts"],
                       max_iterations=self._options["max_iterations"], step=self._options["end_step"],
                       scale_covariance=int(self._options["scale_covariance"]))
        parameters = [one.parameter._description() for one in self.unknowns]
        unknowns, measured = [one._description() for one in self.unknowns], [one._description() for one in self.data]
        info, loss = _new("hbvib_fit_profile_info", best=np.nan), np.full(len(at), np.nan)
        with _Guard() as guard:
            hooks = _hooks(guard, progress, log, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_fit_profile", self._original.handle, solver, options, hooks,
                           (structs["hbvib_parameter"] * p)(*parameters), p, (structs["hbvib_unknown"] * p)(*unknowns),
                           (structs["hbvib_data"] * sets)(*measured), sets, self.theta, number, len(at), ascending, 1.0, info, loss,
                           None, guard=guard)
        if np.isnan(info.best):
            raise Stopped(_sentence(status), Status(status), 0)
        chi2 = np.empty(len(at))
        chi2[order] = loss
        return Profile(at, chi2, float(info.best), float(info.unit))


def _name(parameter: Parameter) -> str:
    name = parameter.kind.name.lower()
    if parameter.contact >= 0:
        return f"{name} {parameter.contact}"
    return name + " factor" if parameter.scaling == Scaling.FACTOR else name
