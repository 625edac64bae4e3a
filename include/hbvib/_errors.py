"""Statuses of the library as exceptions."""
from __future__ import annotations

from ._c import Status
from ._library import lib


class Error(Exception):
    """An error of the library. `sentence` says what is wrong, where, and what is accepted; `status` is the
    Status; `argument` counts the arguments of the C function from 1, 0 where no single one is to blame."""

    def __init__(self, sentence: str, status: int = Status.E_INTERNAL, argument: int = 0) -> None:
        super().__init__(sentence)
        self.sentence, self.status, self.argument = sentence, status, argument


class ArgumentError(Error, ValueError):
    """A value, count, number, matrix or combination that is not accepted."""


class OutOfRangeError(Error, IndexError):
    """An index lies outside its range."""


class FreedError(Error, ValueError):
    """The object was freed."""


class BusyError(Error, RuntimeError):
    """The object is in use by a running call."""


class NumericalError(Error, ArithmeticError):
    """No solution: singular, not converged, unbounded, a matrix that is not positive definite."""


class UnsupportedError(Error, NotImplementedError):
    """The requested combination is not provided."""


class OutOfMemoryError(Error, MemoryError):
    """Memory could not be had."""


class CallbackError(Error, RuntimeError):
    """A force callback refused, or wrote numbers that are not finite."""


class Stopped(Error):
    """A phase callback or the cancel flag stopped a call that has no points to keep."""


class StoppedEarly(RuntimeWarning):
    """A solve ended before its range did; `status` is the Status. Turned into an error by a warning filter, its
    attribute `branch` holds the branch."""

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
