"""Calls of the library: callbacks, their exceptions, Ctrl-C, and the owner of a handle."""
from __future__ import annotations

import contextlib
import ctypes
import signal
import threading
from typing import TYPE_CHECKING, Any, Callable, Optional, Sequence, TypeVar

import numpy as np

from ._c import LogLevel, Phase, Status
from ._convert import _CONVERTERS, _member
from ._errors import _ERRORS, BusyError, Error, FreedError, Stopped, _sentence
from ._library import _TYPES, lib
from ._results import Progress
from ._structs import _new

if TYPE_CHECKING:
    from ._batch import Batch
    from ._branch import Branch

    Hook = Optional[Callable[[Phase, float], Any]]


_OwnerType = TypeVar("_OwnerType", bound="_Owner")

_running = threading.local()  # .guard: the guard of the innermost call of this thread


class _Guard:
    """Surrounds one call of the library that may run callbacks: holds what they raise and raises it, whole, when
    the call is over. The handler of SIGINT must not raise where a callback is entered, outside of any try, where
    ctypes would drop the exception: there it is run by the guard."""

    def __init__(self) -> None:
        self.held: Optional[BaseException] = None
        self.branch: Optional[Branch] = None
        self.batch: Optional[Batch] = None
        self.inside = False  # a callback is running
        self.ended: Optional[Callable[[], Any]] = None  # run at the end
        self.wrapped = False  # the handler of SIGINT is this one

    def __enter__(self) -> _Guard:
        self.before: Any = signal.getsignal(signal.SIGINT)
        outer = getattr(self.before, "__self__", None)
        self.handler: Any = outer.handler if isinstance(outer, _Guard) else self.before
        if callable(self.handler):
            with contextlib.suppress(ValueError):  # not the main thread, which alone handles signals
                signal.signal(signal.SIGINT, self.interrupted)
                self.wrapped = True
        self.outer, _running.guard = getattr(_running, "guard", None), self
        return self

    def __exit__(self, *_: Any) -> None:
        _running.guard = self.outer
        if self.ended is not None:
            self.ended()
        if self.wrapped and signal.getsignal(signal.SIGINT) == self.interrupted:  # else a callback set its own
            signal.signal(signal.SIGINT, self.before)
        held, self.held = self.held, None
        if held is not None:
            if self.branch is not None:
                with contextlib.suppress(AttributeError, TypeError):  # an exception without room for it
                    held.branch = self.branch  # type: ignore[attr-defined]
            if self.batch is not None:
                with contextlib.suppress(AttributeError, TypeError):
                    held.batch = self.batch  # type: ignore[attr-defined]
            try:
                raise held
            finally:
                del held  # else it would hold this frame, and this frame it

    def interrupted(self, number: int, frame: Any) -> None:
        if self.inside:
            self.handler(number, frame)
        else:
            self.run(self.handler, number, frame)

    def run(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Result of a callback, None where it raised."""
        try:
            self.inside = True
            result = function(*arguments)
            self.inside = False
            return result
        except BaseException as error:  # goes through C and is raised on the other side
            self.inside = False
            self.held = error if self.held is None else self.held
            return None


def _call(name: str, *arguments: Any, guard: Optional[_Guard] = None) -> int:
    """Calls a function of the library with Python's numbers and arrays. Raises Error below zero, unless a guard
    holds what a callback raised, which comes first."""
    status: int = getattr(lib, name)(*[convert(value) for convert, value in zip(_CONVERTERS[name], arguments)])
    if status < 0 and (guard is None or guard.held is None):
        known = Status(status) if status in Status.__members__.values() else status
        raise _ERRORS.get(known, Error)(_sentence(status), known, lib.hbvib_last_error_argument())
    return status


class CancelFlag:
    """Stops a call from another thread: `set()` is looked at in every long loop. Hand it in as cancel=.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> cancel = hbvib.CancelFlag()
    >>> cancel.set()  # another thread would do it
    >>> branch = model.forced_response((0.8, 1.6), cancel=cancel)
    >>> branch.status
    <Status.STOPPED_BY_CALLER: 1>
    """

    def __init__(self) -> None:
        self.value = ctypes.c_int32(0)

    def set(self) -> None:
        """Stops the calls that have this flag.

        >>> import hbvib
        >>> cancel = hbvib.CancelFlag()
        >>> cancel.set()
        >>> cancel.is_set()
        True
        """
        self.value.value = 1

    def clear(self) -> None:
        """Makes the flag ready for the next call.

        >>> import hbvib
        >>> cancel = hbvib.CancelFlag()
        >>> cancel.set()
        >>> cancel.clear()
        >>> cancel.is_set()
        False
        """
        self.value.value = 0

    def is_set(self) -> bool:
        """Whether `set` was called since the flag was made or cleared.

        >>> import hbvib
        >>> hbvib.CancelFlag().is_set()
        False
        """
        return self.value.value != 0


def _refused(answer: Any) -> bool:
    return isinstance(answer, (bool, np.bool_)) and not answer


def _progress_bar(guard: _Guard) -> Callable[..., Any]:
    """A callback that shows a bar, which ends with the call."""
    from ._progress import Bar
    bar = Bar()
    guard.ended = bar.close
    return bar


def _hooks(guard: _Guard, progress: Any, log: Any, log_level: Any, cancel: Optional[CancelFlag],
           phase: Any = None) -> Any:
    """The hooks of one call. Ctrl-C and failures of `log` need the callback of phases, too."""
    if progress is True or progress is False:
        progress = _progress_bar(guard) if progress else None
    for name, function in (("progress", progress), ("log", log), ("phase", phase)):
        if function is not None and not callable(function):
            raise TypeError(f"{name} is not callable")
    if cancel is not None and not isinstance(cancel, CancelFlag):
        raise TypeError("cancel needs a CancelFlag")

    def stops(state: Any) -> bool:
        try:
            return _refused(progress(Progress(*(getattr(state, name) for name in Progress._fields))))
        except StopIteration:
            return True

    def on_progress(_: Any, state: Any) -> int:
        stop = progress is not None and guard.held is None and guard.run(stops, state.contents)
        return int(stop or guard.held is not None)

    def refuses(report: Any) -> bool:
        known = Phase(report.phase) if report.phase in Phase.__members__.values() else report.phase
        try:
            return _refused(phase(known, report.share))
        except StopIteration:
            return True

    def on_phase(_: Any, report: Any) -> int:
        stop = phase is not None and guard.held is None and guard.run(refuses, report.contents)
        return int(stop or guard.held is not None)

    def on_log(_: Any, level: int, text: bytes) -> None:
        guard.run(log, LogLevel(level), text.decode(errors="replace"))

    hooks = _new("hbvib_hooks")
    if progress is not None or phase is not None or log is not None or guard.wrapped:
        hooks.progress = _TYPES["progress_fn"](on_progress)
        hooks.phase = _TYPES["phase_fn"](on_phase)
    if log is not None:
        hooks.log, hooks.log_level = _TYPES["log_fn"](on_log), _member(LogLevel, log_level)
    if cancel is not None:
        hooks.cancel = ctypes.addressof(cancel.value)
    return hooks


def _stoppable(name: str, *arguments: Any, phase: Optional[Callable[..., Any]] = None,
               cancel: Optional[CancelFlag] = None, variant: str = "_with_hooks") -> int:
    """Calls a function that has no points to keep by its variant with hooks, so that Ctrl-C stops it as well."""
    with _Guard() as guard:
        hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
        status = _call(name + variant, *arguments, hooks, guard=guard)
    if status == Status.STOPPED_BY_CALLER:
        raise Stopped(_sentence(status), Status(status), 0)
    return status


class _Owner:
    """Owns a handle of the library, and the callables that the library may call on its behalf."""

    _handle: Optional[int] = None
    _kept: Any = ()
    _release: Any  # the function of the library that frees the handle

    @property
    def handle(self) -> int:
        """The handle, for functions of `hbvib.lib`. FreedError once the object was freed.

        >>> import hbvib
        >>> model = hbvib.Model(3)
        >>> hbvib.lib.hbvib_model_dofs(model.handle)
        3
        """
        if self._handle is None:
            raise FreedError(f"this {type(self).__name__} was freed", Status.E_HANDLE, 1)
        return self._handle

    def _call(self, name: str, *arguments: Any) -> int:
        """Calls a function whose first argument is the handle."""
        if not self._kept:
            return _call(name, self.handle, *arguments)
        with _Guard() as guard:
            return _call(name, self.handle, *arguments, guard=guard)

    def _listed(self, name: str, arguments: tuple[Any, ...], dtypes: Sequence[Any],
                stop: Optional[dict[str, Any]] = None) -> list[Any]:
        """Arrays as long as the library says: a first call gets the count, a second one the numbers."""

        def run(*more: Any) -> int:
            if stop is None:
                return self._call(name, *arguments, *more)
            return _stoppable(name, self.handle, *arguments, *more, **stop)

        count = ctypes.c_int64()
        run(0, *[None] * len(dtypes), count)
        arrays = [np.empty(count.value, dtype) for dtype in dtypes]
        run(count.value, *arrays, count)
        return arrays

    def __enter__(self: _OwnerType) -> _OwnerType:
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        """Frees the object, unless that was done inside."""
        try:
            if self._handle is not None:
                self.free()
        except (BufferError, BusyError):
            if kind is None:  # else another exception is on its way, whose traceback may hold the arrays
                raise

    @property
    def is_freed(self) -> bool:
        """Whether `free` was called.

        >>> import hbvib
        >>> with hbvib.Model(3) as model:
        ...     model.is_freed
        ...
        False
        >>> model.is_freed
        True
        """
        return self._handle is None

    def free(self) -> None:
        raise NotImplementedError

    def __del__(self) -> None:
        if self._handle is not None:
            self._release(self._handle)

    def __repr__(self) -> str:
        from ._summary import line
        return line(self)

    def _repr_html_(self) -> str:
        from ._summary import table
        return table(self)
