"""Quantiles of many values of which few are known: order statistics, and a screen by predictions."""
from __future__ import annotations

from typing import TYPE_CHECKING, Callable, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Values = NDArray[np.float64]
    Numbers = NDArray[np.int64]

#: Known values at least in a group of neighbours by prediction, whose errors of prediction are taken as alike.
_IN_GROUP = 50
#: Share of a group beyond which the errors are taken to fall exponentially, and by how many standard errors of their mean excess
#: that is lengthened.
_TAIL, _LONGER = 0.2, 2.0
#: Share of the probability of an error that is left to values judged by their prediction alone.
_OF_SCREEN = 0.1
#: Values that are found at a time.
_AT_ONCE = 100


class Screened(NamedTuple):
    """A quantile and its interval; made by `screened`."""

    value: float
    lower: float
    upper: float
    #: The values, NaN where they were not found.
    known: Values
    #: Places of the values that were found first, equally spaced by their predictions.
    pilot: Numbers
    #: Number of values that are expected to lie beyond an end of the interval against their prediction.
    misjudged: float


def binomial(n: int, p: float) -> Values:
    """P(X <= k) of a binomial distribution for k = 0 .. n."""
    k = np.arange(n + 1)
    logs = np.concatenate([[0.0], np.cumsum(np.log(np.arange(1, n + 1)))])
    weights = logs[n] - logs[k] - logs[n - k] + k * np.log(p) + (n - k) * np.log1p(-p)
    found: Values = np.cumsum(np.exp(weights))
    return found


def ends(n: int, p: float, tail: float) -> tuple[int, int]:
    """Ranks from 1 of two of n ordered values, each beyond the quantile with at most the probability `tail`: 0 and n + 1 where there
    is none."""
    below = binomial(n, p)
    # The r-th of the ordered values lies below the quantile with the probability that at least r values do.
    return int(np.searchsorted(below, tail, side="right")), int(np.searchsorted(below, 1 - tail, side="left")) + 1


def at_rank(ordered: Values, rank: int) -> float:
    """The value of a rank from 1; infinite beyond the first or the last."""
    if rank < 1:
        return -np.inf
    return float(ordered[rank - 1]) if rank <= len(ordered) else np.inf


def screened(predicted: Values, find: Callable[[Numbers], Values], p: float, alpha: float, first: int, most: int,
             random: np.random.Generator) -> Screened:
    """The quantile p of values, and an interval that has that of their distribution but for the probability alpha.

    predicted   a prediction of each value, drawn independently of each other.
    find        the values at places, NaN where one cannot be had.
    first       values that are found first, equally spaced by their predictions.
    most        values that are found in all.

    The interval is that of the order statistics of all values. Whether a value lies beyond an end is judged by its prediction where
    that is sure: the errors of neighbours by prediction, about the line through their values, are known from those that were found,
    and fall exponentially beyond the largest fifth. Values are found in the order of their probability to be misjudged, until that of a single error is a tenth of alpha.
    Where `most` ends the search before, the ranks of the ends move outwards by the number of errors that must be allowed for.
    """
    n = len(predicted)
    order = np.argsort(predicted, kind="stable")
    pilot = order[np.unique(((np.arange(first) + random.random()) * n / first).astype(np.int64))]
    known, is_found = np.full(n, np.nan), np.zeros(n, bool)
    low, high = ends(n, p, (1 - _OF_SCREEN) * alpha / 2)
    allowed = _OF_SCREEN * alpha / 2
    wanted = pilot
    while True:
        known[wanted] = find(wanted)
        is_found[wanted] = True
        # A value that cannot be had may lie anywhere.
        failed = is_found & np.isnan(known)
        middle, above, below = _errors(predicted, known, order)
        values = np.where(is_found, known, middle)
        at_least, at_most = np.where(failed, -np.inf, values), np.where(failed, np.inf, values)
        start, stop = at_rank(np.sort(at_least), low), at_rank(np.sort(at_most), high)
        # An end among values that were not found is not known, nor is what lies between the ends.
        between = ~is_found & (values >= start) & (values <= stop)
        rises = np.where(is_found | (values > stop), 0.0, np.where(between, 1.0, above(stop)))
        falls = np.where(is_found | (values < start), 0.0, np.where(between, 1.0, below(start)))
        worst = np.maximum(rises, falls)
        left = min(most, n) - int(is_found.sum())
        if left <= 0 or (rises.sum() <= allowed and falls.sum() <= allowed):
            break
        many = min(_AT_ONCE, left, int(np.count_nonzero(worst)))
        wanted = np.argsort(-worst, kind="stable")[:many]
    more, less = _most_of(float(rises.sum()), allowed), _most_of(float(falls.sum()), allowed)
    lower, upper = at_rank(np.sort(at_least), low - less), at_rank(np.sort(at_most), high + more)
    if more or less:
        value = _expected(p, known, is_found, above)
    else:
        value = float(np.quantile(np.where(failed, middle, values), p))
    value = float(np.clip(value, lower, upper))
    return Screened(value, lower, upper, known, pilot, float(rises.sum() + falls.sum()))


Tail = Callable[[float], "Values"]


def _expected(p: float, known: Values, is_found: NDArray[np.bool_], above: Tail) -> float:
    """The level that a share p of values is expected not to exceed, where many are known by the errors of their predictions alone: at the
    middle of each, they would scatter too little."""
    finite = known[np.isfinite(known)]
    allowed = (1 - p) * (len(finite) + np.count_nonzero(~is_found))
    low, high = float(finite.min()), float(finite.max())
    for _ in range(60):
        level = (low + high) / 2
        if np.count_nonzero(finite > level) + above(level)[~is_found].sum() > allowed:
            low = level
        else:
            high = level
    return (low + high) / 2


def _errors(predicted: Values, known: Values, order: Numbers) -> tuple[Values, Tail, Tail]:
    """The middle of each value by its prediction, and the probabilities that it lies above a level, and below one."""
    at = order[np.isfinite(known[order])]
    if len(at) < 3:
        raise ValueError(f"{len(at)} of the first values can be had, needs at least 3")
    groups = np.array_split(at, max(1, len(at) // _IN_GROUP))
    edges = np.array([predicted[group[-1]] for group in groups[:-1]])
    of = np.searchsorted(edges, predicted, side="left")
    # Predictions that tell little scatter by themselves: what they say of a group is the line through its values.
    slopes = np.array([_slope(predicted[group], known[group]) for group in groups])
    errors = [np.sort(known[group] - slope * predicted[group]) for slope, group in zip(slopes, groups)]
    told = slopes[of] * predicted
    middle = told + np.array([np.median(error) for error in errors])[of]

    def beyond(sign: float) -> Tail:
        sides = [np.sort(sign * error) for error in errors]

        def tail(level: float) -> Values:
            found = np.zeros(len(predicted))
            for number, side in enumerate(sides):
                here = of == number
                found[here] = _exceeds(side, sign * (level - told[here]))
            return found
        return tail
    return middle, beyond(1.0), beyond(-1.0)


def _slope(predicted: Values, known: Values) -> float:
    """Slope of the line through values over their predictions, by least squares; 1 for predictions that are all alike."""
    away = predicted - predicted.mean()
    square = float(away @ away)
    return float(away @ known) / square if square > 0 else 1.0


def _exceeds(errors: Values, x: Values) -> Values:
    """The probability that an error exceeds each x: the share of those that do, and an exponential beyond the largest fifth."""
    n = len(errors)
    many = max(int(_TAIL * n), 1)
    start = errors[n - many]
    length = float(np.mean(errors[n - many:] - start)) * (1 + _LONGER / np.sqrt(many))
    inside = (n - np.searchsorted(errors, x, side="right") + 1) / (n + 1)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        outside = (many + 1) / (n + 1) * np.exp(-(x - start) / length) if length > 0 else np.where(x > start, 0.0, 1.0)
    found: Values = np.where(x <= start, inside, np.minimum(outside, 1.0))
    return found


def _most_of(mean: float, probability: float) -> int:
    """Number of independent events that is exceeded with at most a probability, from their mean number: Markov for a single one,
    Chernoff's bound for more."""
    if mean <= probability:
        return 0
    count = int(np.floor(mean)) + 1
    while count - mean - count * np.log(count / mean) > np.log(probability):
        count += 1
    return count - 1
