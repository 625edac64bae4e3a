"""Branches in files and in pickles: everything that was computed, as arrays."""
from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Callable, NoReturn, Optional, TypeVar

import numpy as np

from ._branch import Branch
from ._c import Field, FlexibilityWay, ModeMultiple, Reading, Status
from ._errors import ArgumentError, OutOfRangeError, UnsupportedError
from ._library import __version__
from ._model import Model
from ._recomputed import check, recomputed
from ._responses import Response, WatchedResponse
from ._responses import contents as response_contents
from ._results import Bifurcations, HigherPeaks, Kinks, LimitCycles, Loop, Optima, Points, Turns, Wanted
from ._stored_point import requests
from ._tables import FORMAT, fields
from ._types import ContactSummary, Energy, ModeInfo, ModePoint, Reduction
from ._units import Units

if TYPE_CHECKING:
    from ._choices import Fields
    from ._results import ComplexArray, FloatArray

_FORMAT = FORMAT
_List = TypeVar("_List", bound="tuple[Any, ...]")


def contents(branch: Branch, harmonics: bool = True) -> dict[str, np.ndarray]:
    """All that a file holds of a branch."""
    if isinstance(branch, SavedBranch):
        known = dict(branch._about, units=list(branch.units))
        kept = {name: values for name, values in branch._arrays.items() if harmonics or name not in ("harmonics", "model")}
        return {**kept, "about": np.array(json.dumps(known))}
    stored = branch.stored
    about: dict[str, Any] = dict(
        format=_FORMAT, version=__version__, status=int(branch.status), message=branch.message, points=len(branch),
        stored=stored, is_mode=branch.is_mode, reduction=branch.reduction._asdict(), at=0, units=list(branch.units))
    arrays: dict[str, np.ndarray] = {"field/" + name: values for name, values in fields(branch).items()}
    lists: dict[str, Any] = dict(peaks=branch.peaks(), folds=branch.folds(), bifurcations=branch.bifurcations(),
                                 optima=branch.optima(), turns=branch.turns(), higher_peaks=branch.higher_peaks())
    if branch.is_mode:
        lists["limit_cycles"] = branch.limit_cycles()
        about["mode_info"] = branch.mode_info._asdict()
        arrays["mode_point"] = np.array([branch.mode_point(point) for point in range(stored)], float)
    for found in requests(branch):
        lists[f"at/{about['at']}"] = found
        about["at"] += 1
    about["responses"] = [response_contents(watched.response) for watched in branch.responses]
    for r, watched in enumerate(branch.responses):
        lists[f"response/{r}/peaks"] = watched.peaks()
        lists[f"response/{r}/kinks"] = watched.kinks()
        for reading, values in zip(Reading, watched._readings):
            arrays[f"response/{r}/{reading.name.lower()}"] = values
    arrays["at_values"] = branch._at
    for name, values in lists.items():
        arrays.update({f"{name}/{key}": column for key, column in values._asdict().items()})
    arrays["slip"] = np.array([branch.slip(point) for point in range(stored)]).reshape(stored, -1)
    arrays["energy"] = np.array([branch.energy(point) for point in range(stored)])
    if harmonics:
        arrays["harmonics"] = np.array([branch.harmonics(point) for point in range(stored)])
        about["samples"], about["no_model"], model = _model_of(branch)
        if model is not None:
            arrays["model"] = model
    return dict(about=np.array(json.dumps(about)), **arrays)


def _model_of(branch: Branch) -> tuple[int, str, Optional[np.ndarray]]:
    """Samples of the solve, the reason why there is no model, and the bytes of the model."""
    if branch._origin is None:
        return 0, "each point of this branch has a model of its own", None
    try:
        return branch._origin.samples, "", branch._origin.saved()
    except UnsupportedError as error:
        return 0, str(error), None


def save(branch: Branch, path: Any, harmonics: bool) -> None:
    """See Branch.save."""
    name = os.fspath(path)
    part = f"{name}.{os.getpid()}.part"
    try:
        with open(part, "wb") as file:
            np.savez(file, **contents(branch, harmonics))  # type: ignore[arg-type]
        os.replace(part, name)  # a file is complete or not there
    except BaseException:
        if os.path.exists(part):
            os.remove(part)
        raise


def load(path: Any) -> SavedBranch:
    """Reads a branch that `Branch.save` has written. ValueError for another file, naming it.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "branch.npz")
    >>> branch.save(path)
    >>> bool((hbvib.load(path).amplitude == branch.amplitude).all())
    True
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            return SavedBranch(dict(file))
    except (KeyError, ValueError, EOFError) as error:
        raise ValueError(f"{path} is no branch that hbvib has saved: {error}") from None


class SavedBranch(Branch):
    """A branch from a file or a pickle: fields, special points, harmonics, energies and slip fractions to the last bit.

    Loops and summaries of contacts are computed from the model and the harmonics that were saved, and differ from those of
    the branch by rounding, where laws were sampled by the accuracy of the samples. UnsupportedError for a branch without
    them, as one over a parameter, of a batch or of a model with a force of the caller. Syntheses need the solution
    itself: solve again, from `harmonics(point)` as guess= where that helps.

    >>> import hbvib, pickle
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.2))
    >>> saved = pickle.loads(pickle.dumps(branch))
    >>> type(saved).__name__, bool((saved.amplitude == branch.amplitude).all())
    ('SavedBranch', True)
    """

    def __init__(self, arrays: dict[str, np.ndarray]) -> None:
        about = json.loads(str(arrays["about"]))
        if about["format"] != _FORMAT:
            raise ValueError(f"format {about['format']}, needs {_FORMAT}: saved by hbvib {about['version']}")
        super().__init__(0, (), about["message"], Units(*about.get("units", ())))
        self._arrays, self._about, self._handle = arrays, about, None
        self._at = arrays["at_values"]
        self._solved: Optional[tuple[int, Branch]] = None
        for name, values in arrays.items():
            values.flags.writeable = False

    def _stored_field(self, field: Fields) -> None:
        return None

    def __reduce__(self) -> tuple[Callable[..., SavedBranch], tuple[Any, ...]]:
        return SavedBranch, (contents(self),)

    @property
    def handle(self) -> NoReturn:
        """There is none: UnsupportedError.

        >>> import hbvib, pickle
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> saved = pickle.loads(pickle.dumps(model.forced_response((0.8, 1.2))))
        >>> try:
        ...     saved.handle
        ... except hbvib.UnsupportedError as error:
        ...     print(error)
        a branch from a file has no solution in memory: solve again for this
        """
        raise UnsupportedError("a branch from a file has no solution in memory: solve again for this", Status.E_UNSUPPORTED)

    @property
    def is_freed(self) -> bool:
        """False: there is nothing to free.

        >>> import hbvib, pickle
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> saved = pickle.loads(pickle.dumps(model.forced_response((0.8, 1.2))))
        >>> saved.is_freed
        False
        """
        return False

    def free(self) -> None:
        """Does nothing: the memory is that of arrays.

        >>> import hbvib, pickle
        >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> saved = pickle.loads(pickle.dumps(model.forced_response((0.8, 1.2))))
        >>> saved.free()
        >>> len(saved.omega) == len(saved)
        True
        """

    def __len__(self) -> int:
        """Number of points on the curve."""
        return int(self._about["points"])

    @property
    def stored(self) -> int:
        return int(self._about["stored"])

    @property
    def status(self) -> Status:
        return Status(self._about["status"])

    @property
    def is_mode(self) -> bool:
        return bool(self._about["is_mode"])

    def field(self, field: Fields) -> FloatArray:
        name = (field if isinstance(field, str) else Field(field).name).lower()
        if "field/" + name not in self._arrays:
            Field[name.upper()]
            raise ArgumentError(f"this branch has no field {name}", Status.E_ARGUMENT)
        return self._arrays["field/" + name]

    @property
    def reduction(self) -> Reduction:
        if "reduction" not in self._about:
            raise UnsupportedError("a branch from a table does not tell the size of its problem", Status.E_UNSUPPORTED)
        values = dict(self._about["reduction"])
        # Earlier files do not know it.
        way = FlexibilityWay(values.pop("flexibility_way", values.pop("reserved2", 0)))
        return Reduction(**values, flexibility_way=way)

    @property
    def mode_info(self) -> ModeInfo:
        if not self.is_mode:
            raise UnsupportedError("a forced response has no mode_info", Status.E_UNSUPPORTED)
        if "mode_info" not in self._about:
            raise UnsupportedError("a branch from a table has no mode_info", Status.E_UNSUPPORTED)
        values = dict(self._about["mode_info"])
        return ModeInfo(**dict(values, multiple=ModeMultiple(values["multiple"])))

    def _row(self, name: str, point: int) -> np.ndarray:
        """The row of a point. IndexError where there is none."""
        if name not in self._arrays:
            raise UnsupportedError(f"this file has no {name}", Status.E_UNSUPPORTED)
        if not 0 <= point < self.stored:
            raise OutOfRangeError(f"point = {point}, needs 0 .. {self.stored - 1}", Status.E_INDEX, 2)
        row: np.ndarray = self._arrays[name][point]
        return row

    def mode_point(self, point: int) -> ModePoint:
        return ModePoint(*self._row("mode_point", point).tolist())

    def energy(self, point: int, **_: Any) -> Energy:
        return Energy(*self._row("energy", point).tolist())

    def slip(self, point: int) -> FloatArray:
        return self._row("slip", point)

    def harmonics(self, point: int, first_dof: int = 0, n_dof: Optional[int] = None, **_: Any) -> ComplexArray:
        row = self._row("harmonics", point)
        if not 0 <= first_dof < row.shape[1] or not 0 < (n_dof or 1) <= row.shape[1] - first_dof:
            raise OutOfRangeError(f"first_dof = {first_dof}, n_dof = {n_dof}, but there are {row.shape[1]}", Status.E_INDEX)
        return row[:, first_dof:][:, :n_dof].copy()

    def time_history(self, point: int, dof: int, n: int = 256, **_: Any) -> FloatArray:
        x = self.harmonics(point, dof, 1)[:, 0]
        phase = 2j * np.pi / n * (np.outer(np.arange(n), np.arange(len(x))) % n)
        return np.asarray((np.exp(phase) @ x).real)

    def _list(self, kind: type[_List], name: str) -> _List:
        if f"{name}/{kind._fields[0]}" not in self._arrays:  # type: ignore[attr-defined]
            raise UnsupportedError(f"this branch has no {name}: it comes from a table that has fields alone; save and hbvib.load keep all",
                                   Status.E_UNSUPPORTED)
        return kind(*(self._arrays[f"{name}/{key}"].copy() for key in kind._fields))  # type: ignore[attr-defined]

    def _again(self, point: int) -> Branch:
        """A branch of one point in memory with the motion of a point."""
        if self._solved is not None and self._solved[0] == point:
            return self._solved[1]
        slip, energy, harmonics = self.slip(point), self.energy(point), self._row("harmonics", point)
        if "model" not in self._arrays:
            raise UnsupportedError(f"this file has no model: {self._about['no_model']}", Status.E_UNSUPPORTED)
        order = self.mode_info.engine_order if self.is_mode else None
        model = Model.from_bytes(self._arrays["model"])
        found = recomputed(model, self.point(point).omega, harmonics, order, self._about["samples"])
        check(found, slip, energy, self._about["samples"])
        self._solved = (point, found)
        return found

    def loop(self, point: int, contact: int, direction: int = 0, n: int = 256, **stop: Any) -> Loop:
        return self._again(point).loop(0, contact, direction, n, **stop)

    def summary(self, point: int, contact: int, **stop: Any) -> ContactSummary:
        return self._again(point).summary(0, contact, **stop)

    def peaks(self) -> Points:
        return self._list(Points, "peaks")

    @property
    def responses(self) -> tuple[WatchedResponse, ...]:
        found = []
        for r, about in enumerate(self._about.get("responses", [])):
            readings = [self._arrays[f"response/{r}/{reading.name.lower()}"] for reading in Reading]
            place = f"response/{r}/kinks"
            # Earlier files do not know them.
            none, nowhere = np.empty(0), np.empty(0, np.int64)
            known = f"{place}/omega" in self._arrays
            kinks = self._list(Kinks, place) if known else Kinks(none, none, nowhere, nowhere)
            found.append(WatchedResponse(Response(**about), len(self), readings, self._list(Points, f"response/{r}/peaks"), kinks))
        return tuple(found)

    def _read(self, asked: list[Response], stored: int,
              stop: dict[str, Any]) -> tuple[FloatArray, ComplexArray, FloatArray]:
        """Of the harmonics of the file, of sector 0."""
        shape = len(asked), stored
        value, number, instant = np.empty(shape), np.empty(shape, complex), np.empty(shape)
        for point in range(stored):
            x, omega = self.harmonics(point), self.point(point).omega
            for r, one in enumerate(asked):
                value[r, point], number[r, point], instant[r, point] = one._of(x, omega)
        return value, number, instant

    def leading_response(self, point: int) -> int:
        raise UnsupportedError("a file does not tell the norm of its tolerance: compare the errors of its responses",
                               Status.E_UNSUPPORTED)

    def optima(self) -> Optima:
        return self._list(Optima, "optima")

    def turns(self) -> Turns:
        if "turns/parameter" not in self._arrays and "peaks/point" in self._arrays:  # a file of version 0.1
            none = np.empty(0)
            return Turns(none, none, none, np.empty(0, "U7"), np.empty(0, np.int64))
        return self._list(Turns, "turns")

    def higher_peaks(self) -> HigherPeaks:
        return self._list(HigherPeaks, "higher_peaks")

    def folds(self) -> Points:
        return self._list(Points, "folds")

    def bifurcations(self) -> Bifurcations:
        return self._list(Bifurcations, "bifurcations")

    def limit_cycles(self) -> LimitCycles:
        if not self.is_mode:
            raise UnsupportedError("a forced response has no limit cycles", Status.E_UNSUPPORTED)
        return self._list(LimitCycles, "limit_cycles")

    def at(self, wanted: int) -> Wanted:
        if not 0 <= wanted < self._about["at"]:
            raise OutOfRangeError(f"wanted = {wanted}, but {self._about['at']} were requested", Status.E_INDEX, 2)
        return self._list(Wanted, f"at/{wanted}")
