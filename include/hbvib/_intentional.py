"""Deliberate patterns of two kinds of blades whose worst case is the least: the search for the worst pattern turned round."""
from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, cast

import numpy as np

from ._ascent import Place, ascend, foretold
from ._c import Status
from ._convert import _array, _whole
from ._errors import ArgumentError, Stopped
from ._structs import _with_options
from ._types import SolverOptions
from ._wheel_studies import _MOST_SWEEPS, Blade, _blade, _of_sector, _WheelStudies

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._choices import Mistunings
    from ._model import Model
    from ._results import FloatArray


class WorstCase(NamedTuple):
    """The worst case of a deliberate pattern with any further one in a box on top of it; made by Model.intentional_pattern.

    word           the kinds of the blades of one period, "AABB"; empty for equal blades.
    pattern        delta of the deliberate pattern, and `addition` that of the worst one on top of it.
    amplification  peak of `blade` over that of the tuned wheel: the highest that was found.
    nominal        amplification of the deliberate pattern alone.
    foretold       amplification of the worst case by the derivatives of the deliberate pattern.
    kkt            gain, relative to the amplitude, that the derivatives at the worst case still foretell; NaN where it was not sought.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.WorstCase("AB", np.zeros(2), np.zeros(2), 0, 1.2, 1.1, 1.19, 0.0).word
    'AB'
    """
    word: str
    pattern: FloatArray
    addition: FloatArray
    blade: int
    amplification: float
    nominal: float
    foretold: float
    kkt: float


class IntentionalPattern(NamedTuple):
    """Deliberate patterns by their worst cases; made by Model.intentional_pattern.

    best       the pattern whose worst case is the least of those that were sought.
    equal      the worst case of equal blades, sought in the same way.
    cases      all patterns: those whose worst case was sought first, from the least; then the others as foretold.
    starts     ascents for each watched blade of each pattern: the worst cases are the best of so many.
    sweeps     responses that were computed.
    whitehead  the bound (1 + sqrt(N)) / 2 of linear wheels of equal blades.

    >>> import hbvib
    >>> import numpy as np
    >>> case = hbvib.WorstCase("AB", np.zeros(2), np.zeros(2), 0, 1.2, 1.1, 1.19, 0.0)
    >>> hbvib.IntentionalPattern(case, case, (case,), 2, 10, 1.2).best.amplification
    1.2
    """
    best: WorstCase
    equal: WorstCase
    cases: tuple[WorstCase, ...]
    starts: int
    sweeps: int
    whitehead: float


class _Intentional(_WheelStudies):
    """Methods of Model for deliberate patterns."""

    @_with_options("hbvib_solver_options", SolverOptions)
    def intentional_pattern(self, omega: ArrayLike, levels: ArrayLike, box: float, *, kind: Mistunings = "stiffness",
                            dofs: Optional[ArrayLike] = None, direction: Any = None, blade: Blade = 0, longest: int = 4,
                            tries: int = 3, starts: int = 4, seed: int = 0, **solver: Unpack[SolverOptions]) -> IntentionalPattern:
        """Patterns of two kinds of blades, A and B, by their worst cases with any further pattern within -box .. box on top. All
        periodic patterns are compared by the derivatives of the response of each; for the best ones and for equal blades the worst
        case is sought as in worst_pattern, for each blade of a period, from the corner of the box that the derivatives foretell and
        from random patterns.

        omega      (start, stop) of each response; it must have the peaks of all patterns.
        levels     delta of the blades A and B, (-0.02, 0.02).
        box        largest delta on top of the deliberate pattern.
        kind, dofs, direction, blade   as in wheel_study.
        longest    period of the patterns, in blades; only those that divide the number of sectors are tried.
        tries      patterns whose worst case is sought.
        starts, seed   ascents for each blade, and the seed of all but the first. Options of the solver; harmonics without tolerance
                   means tolerance = 0:

        {options}

        >>> import hbvib
        >>> sector = hbvib.Model.cyclic(1, sectors=6, engine_order=1, mass=1, stiffness=3, coupling=dict(stiffness=-0.1),
        ...                             damping=0.05)
        >>> sector.add_force(0, 0.1)
        >>> found = sector.intentional_pattern((1.3, 2.1), (-0.1, 0.1), 0.01, kind="mass", dofs=[0], longest=3, tries=1, harmonics=1)
        >>> len(found.cases), found.equal.amplification > 1
        (3, True)
        """
        sector = cast("Model", self)
        given = _array("levels", levels, np.float64, (2,))
        if not (np.isfinite(box) and box > 0):
            raise ValueError(f"box = {box!r}, needs a number above 0")
        if not np.isfinite(given).all():
            raise ValueError(f"levels = {given}, need finite numbers")
        if direction is None and np.min(levels) - box < -1:
            raise ValueError(f"levels down to {np.min(levels)} less box = {box}, need at least -1: shares, not per cent")
        counts = [_whole(value, name=name) for name, value in (("longest", longest), ("tries", tries), ("starts", starts))]
        for name, count, least in zip(("longest", "tries", "starts"), counts, (2, 1, 1)):
            if count < least:
                raise ValueError(f"{name} = {count}, needs at least {least}")
        wheel, parameters, transform = self._directions(kind, dofs, direction)
        search = _Search(self, omega, box, (kind, dofs, direction), parameters, transform, _blade(blade), solver)
        tuned = self._peak_of_blade(wheel, (), _of_sector(_blade(blade), 0), omega, solver)[0]
        search.sweeps += 1
        words = [""] + _words(sector.sectors, longest)
        cases = [search.foretold(word, given) for word in words]
        equal, *others = cases
        others.sort(key=lambda case: case.foretold)
        random = np.random.default_rng(seed)
        sought = [search.worst(case, starts, random) for case in [equal, *others[:tries]]]
        found = [case._replace(amplification=case.amplification / tuned, nominal=case.nominal / tuned, foretold=case.foretold / tuned)
                 for case in sought + others[tries:]]
        equal, *cases = found
        cases[:tries] = sorted(cases[:tries], key=lambda case: case.amplification)
        if not cases:
            raise ValueError(f"no period up to longest = {longest} divides {sector.sectors} sectors")
        return IntentionalPattern(cases[0], equal, tuple(cases), starts, search.sweeps, float((1 + np.sqrt(sector.sectors)) / 2))


class _Search:
    """Worst cases of deliberate patterns, as amplitudes."""

    def __init__(self, model: _WheelStudies, omega: ArrayLike, box: float, mistuning: Any, parameters: Any, transform: Any, blade: Any,
                 solver: Any) -> None:
        self.model, self.omega, self.box, self.mistuning = model, omega, box, mistuning
        self.parameters, self.transform, self.blade, self.solver = parameters, transform, blade, solver
        self.sectors, self.dofs = cast("Model", model).sectors, cast("Model", model).ndof
        self.sweeps = 0

    def at(self, pattern: FloatArray, number: int) -> tuple[float, FloatArray, float]:
        """Peak of a blade, its derivatives by delta and its frequency."""
        amplitude, gradient, frequency, more = self.model._with_slope(
            pattern, self.mistuning, self.parameters, self.transform, _of_sector(self.blade, number * self.dofs), self.omega, self.solver)
        self.sweeps += more
        return amplitude, gradient, frequency

    def foretold(self, word: str, levels: FloatArray) -> WorstCase:
        """The worst case by the derivatives of the deliberate pattern."""
        kinds = [levels["AB".index(kind)] for kind in word] or [0.0]
        pattern = np.tile(np.array(kinds), self.sectors // len(kinds))
        found = []
        # Blades a period apart move alike.
        for number in range(len(kinds)):
            try:
                amplitude, gradient, _ = self.at(pattern, number)
            except Stopped:
                raise
            except ArgumentError:  # no peak within the range
                continue
            found.append((amplitude + self.box * float(abs(gradient).sum()), amplitude, number, self.box * np.sign(gradient)))
        if not found:
            raise ArgumentError(f"no blade of the pattern {word or 'of equal blades'} has a peak within omega", Status.E_ARGUMENT, 2)
        worst, _, number, addition = max(found, key=lambda one: one[0])
        return WorstCase(word, pattern, addition, number, worst, max(one[1] for one in found), worst, np.nan)

    def worst(self, case: WorstCase, starts: int, random: np.random.Generator) -> WorstCase:
        """The worst case by ascents for each blade of a period."""
        best: Optional[tuple[Place, int]] = None
        for number in range(max(len(case.word), 1)):
            def value(addition: FloatArray, number: int = number) -> tuple[float, FloatArray, float]:
                return self.at(case.pattern + addition, number)

            for start in range(starts):
                try:
                    first = (self.box * np.sign(self.at(case.pattern, number)[1]) if start == 0
                             else random.uniform(-self.box, self.box, self.sectors))
                    end = ascend(value, first, self.box, _MOST_SWEEPS)
                except Stopped:
                    raise
                except ArgumentError:
                    continue
                if best is None or end.value > best[0].value:
                    best = end, number
        if best is None:
            raise ArgumentError(f"no blade of the pattern {case.word} has a peak within omega with mistuning in the box",
                                Status.E_ARGUMENT, 2)
        place, number = best
        return case._replace(addition=place.at, blade=number, amplification=place.value,
                             kkt=foretold(place.at, place.gradient, self.box) / place.value)


def _words(sectors: int, longest: int) -> list[str]:
    """Words of A and B of periods that divide the number of sectors, one of each set of rotations and without shorter periods."""
    found = []
    for period in range(2, longest + 1):
        if sectors % period:
            continue
        for letters in itertools.product("AB", repeat=period):
            word = "".join(letters)
            turned = [word[k:] + word[:k] for k in range(period)]
            if word == min(turned) and turned.count(word) == 1:
                found.append(word)
    return found
