"""Statuses of the library as exceptions."""
from __future__ import annotations

from ._c import Status
from ._library import lib


class Error(Exception):
    """An error of the library. `sentence` says what is wrong, where, and what is accepted; `status` is the
    Status; `argument` counts the arguments of the C function from 1, 0 where no single one is to blame.

    >>> import hbvib
    >>> try:
    ...     hbvib.Model(mass=1, stiffness=float("nan"))
    ... except hbvib.Error as error:
    ...     print(error.status.name)
    E_NOT_FINITE
    """

    def __init__(self, sentence: str, status: int = Status.E_INTERNAL, argument: int = 0) -> None:
        super().__init__(sentence)
        self.sentence, self.status, self.argument = sentence, status, argument


class ArgumentError(Error, ValueError):
    """A value, count, number, matrix or combination that is not accepted.

    >>> import hbvib
    >>> try:
    ...     hbvib.Model(mass=1, stiffness=1).linear_modes(0)
    ... except ValueError as error:
    ...     print(type(error).__name__)
    ArgumentError
    """


class OutOfRangeError(Error, IndexError):
    """An index lies outside its range.

    >>> import hbvib
    >>> try:
    ...     hbvib.Model(mass=1, stiffness=1).add_force(1, 0.2)
    ... except IndexError as error:
    ...     print(type(error).__name__)
    OutOfRangeError
    """


class FreedError(Error, ValueError):
    """The object was freed.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1)
    >>> model.free()
    >>> try:
    ...     model.add_force(0, 0.2)
    ... except hbvib.FreedError:
    ...     print(model)
    <hbvib.Model, freed>
    """


class BusyError(Error, RuntimeError):
    """The object is in use by a running call.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> def change(now: hbvib.Progress) -> None:
    ...     model.add_force(0, 0.1)  # of the model that is being solved
    >>> try:
    ...     model.forced_response((0.8, 1.2), progress=change)
    ... except hbvib.BusyError:
    ...     print("in use")
    in use
    """


class NumericalError(Error, ArithmeticError):
    """No solution: singular, not converged, unbounded, a matrix that is not positive definite.

    >>> import hbvib
    >>> try:
    ...     hbvib.Model(mass=-1, stiffness=1).linear_modes(1)
    ... except ArithmeticError as error:
    ...     print(type(error).__name__)
    NumericalError
    """


class UnsupportedError(Error, NotImplementedError):
    """The requested combination is not provided.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> try:
    ...     model.forced_response((0.8, 1.2)).mode_info
    ... except NotImplementedError as error:
    ...     print(type(error).__name__)
    UnsupportedError
    """


class OutOfMemoryError(Error, MemoryError):
    """Memory could not be had.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> issubclass(hbvib.OutOfMemoryError, MemoryError)  # of requests beyond memory_limit= as well
    True
    """


class CallbackError(Error, RuntimeError):
    """A force callback refused, or wrote numbers that are not finite.

    >>> import hbvib
    >>> issubclass(hbvib.CallbackError, RuntimeError)  # an exception of the callback itself comes out as it is
    True
    """


class Stopped(Error):
    """A phase callback or the cancel flag stopped a call that has no points to keep.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1)
    >>> flag = hbvib.CancelFlag()
    >>> flag.set()
    >>> try:
    ...     model.forced_residual(1.0, [[0], [1]], cancel=flag)
    ... except hbvib.Stopped:
    ...     print("stopped")
    stopped
    """


class StoppedEarly(RuntimeWarning):
    """A solve ended before its range did; `status` is the Status. Turned into an error by a warning filter, its
    attribute `branch` holds the branch.

    >>> import hbvib, warnings
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     branch = model.forced_response((0.8, 1.2), max_points=3)
    >>> told[0].category.__name__, branch.status.name
    ('StoppedEarly', 'STOPPED_MAX_POINTS')
    """

    def __init__(self, sentence: str, status: int = Status.OK) -> None:
        super().__init__(sentence)
        self.status = status


_ERRORS = {getattr(Status, "E_" + name): kind for kind, names in (
    (ArgumentError, "NULL ARGUMENT DIMENSION NOT_FINITE NOT_HERMITIAN STRUCT_SIZE"), (OutOfRangeError, "INDEX"),
    (FreedError, "HANDLE"), (BusyError, "BUSY"), (UnsupportedError, "UNSUPPORTED"), (CallbackError, "CALLBACK"),
    (NumericalError, "SINGULAR NO_CONVERGENCE NO_BOUNDED_SOLUTION NOT_POSITIVE_DEFINITE"),
    (OutOfMemoryError, "OUT_OF_MEMORY")) for name in names.split()}


def _sentence(status: int) -> str:
    return (lib.hbvib_last_error() or lib.hbvib_status_name(status)).decode(errors="replace")
