"""Backbones from decays: frequency and damping against amplitude of a signal that one mode leads."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ._measured import Measured

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._results import FloatArray

#: Difference of two steps of time, relative, that is rounding.
_EVEN = 1e-3


class Decay(NamedTuple):
    """Frequency and damping of a decay against its amplitude, one number for each window; made by decay_backbone.

    amplitude                of the displacement at the middle of the window.
    omega, sigma             natural angular frequency omega0, as modes have it, and its standard deviation. The motion crosses zero
                             omega0 (1 - zeta^2)^1/2 / pi times in a unit of time.
    damping, damping_sigma   damping ratio zeta and its standard deviation: the logarithm of the amplitude falls at the rate zeta omega0.

    >>> import hbvib
    >>> import numpy as np
    >>> hbvib.Decay(*np.ones((5, 2))).measured().kind
    <DataKind.BACKBONE: 3>
    """
    amplitude: FloatArray
    omega: FloatArray
    sigma: FloatArray
    damping: FloatArray
    damping_sigma: FloatArray

    def measured(self, shape: float = 1.0, mode: int = 0) -> Measured:
        """The data of a fit.

        shape   motion of the sensor in the linear mode of modal mass 1: the modal amplitude is that of the sensor over it.
        mode    number of the linear mode with stuck contacts.

        >>> import hbvib
        >>> import numpy as np
        >>> hbvib.Decay(*np.ones((5, 2))).measured(shape=0.1).x
        array([1., 1.])
        """
        return Measured("backbone", np.log10(self.amplitude / abs(shape)), self.omega, self.sigma, second=self.damping,
                        second_sigma=self.damping_sigma, mode=mode)


def decay_backbone(time: ArrayLike, signal: ArrayLike, *, cycles: int = 5, component: int = 0) -> Decay:
    """Frequency and damping against amplitude from zero crossings and extremes of a decay in which one mode is left: filter other
    modes away before (the method of zero crossings, Londono, Neild & Cooper 2015, doi:10.1016/j.jsv.2014.12.019).

    Zero crossings are those of lines through both samples, extremes those of parabolas through the samples around the largest, a sixth
    of half a period to both sides: single samples would add their noise, the more so the smaller the motion is.
    In each window of `cycles` periods lines are fitted to the instants of the crossings, whose slope is half a period 2 pi / w, and to
    the logarithms of the extremes, whose slope is -d, both as means of two neighbours; what is left of both gives the standard
    deviations, right for errors that are independent from one crossing or extreme to the next. Frequency and damping ratio are those of
    modes, omega0 = (w^2 + d^2)^1/2 and zeta = d / omega0.

    time, signal   finite samples at equal distances, to a thousandth of them; ten a period or more.
    component      0: displacement, 1: velocity, 2: acceleration, whose amplitudes are divided by omega once or twice.

    >>> import hbvib
    >>> import numpy as np
    >>> t = np.arange(0, 60, 0.01)
    >>> found = hbvib.decay_backbone(t, np.exp(-0.02 * t) * np.cos(2 * t))
    >>> found.omega[:1].round(4), found.damping[:1].round(4)
    (array([2.0001]), array([0.01]))
    """
    t, x = np.asarray(time, float), np.asarray(signal, float)
    if t.ndim != 1 or t.shape != x.shape or len(t) < 10:
        raise ValueError(f"time and signal have shapes {t.shape} and {x.shape}, need one dimension, equal lengths, 10 samples")
    if cycles < 2:
        raise ValueError(f"cycles = {cycles}, needs at least 2")
    for name, values in (("time", t), ("signal", x)):
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise ValueError(f"{name}[{bad[0]}] = {values[bad[0]]}, needs finite numbers: cut the signal, or fill its gaps")
    steps = np.diff(t)
    uneven = np.flatnonzero(~((abs(steps - steps[0]) <= _EVEN * steps[0]) & (steps > 0)))
    if len(uneven):
        k = int(uneven[0])
        raise ValueError(f"time[{k + 1}] - time[{k}] = {steps[k]:.6g} after steps of {steps[0]:.6g}, needs equal distances that rise: "
                         "interpolate the signal, or make times that were rounded from the sampling rate")
    before = np.flatnonzero(x[:-1] * x[1:] < 0)
    crossing = t[before] - x[before] * (t[before + 1] - t[before]) / (x[before + 1] - x[before])
    instants, extremes = [], []
    for a, b in zip(before[:-1] + 1, before[1:] + 1):
        k = a + int(np.argmax(np.abs(x[a:b])))
        if not 0 < k < len(x) - 1:
            continue
        reach = max((b - a) // 6, 1)
        first, last = max(k - reach, 0), min(k + reach + 1, len(x))
        bend, rise, height = np.polyfit(np.arange(first - k, last - k), np.abs(x[first:last]), 2)
        shift = float(np.clip(-0.5 * rise / bend, -reach, reach)) if bend < 0 else 0.0
        instants.append(t[k] + shift * (t[1] - t[0]))
        extremes.append(height + (rise + bend * shift) * shift)
    # Where sliders came to rest beside their place the motion has a mean: half of what lies between two extremes is the amplitude, and
    # the mean of two crossings is free of it.
    at = 0.5 * (np.array(instants[:-1]) + np.array(instants[1:]))
    size = 0.5 * (np.array(extremes[:-1]) + np.array(extremes[1:]))
    crossing = 0.5 * (crossing[:-1] + crossing[1:])
    rows = []
    for begin in range(0, len(crossing) - 2 * cycles, 2 * cycles):
        own = crossing[begin:begin + 2 * cycles + 1]
        half, of_half, _ = _line(np.arange(len(own), dtype=float), own)
        within = (at > own[0]) & (at < own[-1])
        if within.sum() < 4:
            continue
        middle = 0.5 * (own[0] + own[-1])
        rate, of_rate, height = _line(at[within] - middle, np.log(size[within]))
        turning = np.pi / half
        of_turning = turning * of_half / half
        # Both of modes, with their deviations; velocity and displacement of x = exp((-d + iw) t) have the ratio omega0.
        omega = float(np.hypot(turning, rate))
        cosine, zeta = turning / omega, -rate / omega
        sigma = float(np.hypot(cosine * of_turning, zeta * of_rate))
        of_zeta = cosine / omega * float(np.hypot(cosine * of_rate, zeta * of_turning))
        amplitude = np.exp(height) / omega ** component
        rows.append((amplitude, omega, max(sigma, 1e-9 * omega), zeta, max(of_zeta, 1e-9)))
    if not rows:
        raise ValueError("the signal has too few zero crossings for a window: give a longer signal, or fewer cycles")
    return Decay(*np.array(rows).T)


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float, float]:
    """Slope of the line through means of neighbours, its standard deviation, and the height of the line at x = 0.

    Means of two have an error in common with each neighbour: the deviations are those of independent numbers before, s, with
    s^2 tr((I - H) V) the expected sum of the squares that are left, V the covariance of the means over s^2."""
    middle = x.mean()
    spread = float(((x - middle) ** 2).sum())
    weights = (x - middle) / spread
    slope = float((weights * y).sum())
    left = y - y.mean() - slope * (x - middle)
    n = len(x)
    common = 0.5 * np.eye(n) + 0.25 * (np.eye(n, k=1) + np.eye(n, k=-1))
    hat = 1 / n + spread * np.outer(weights, weights)
    variance = (left ** 2).sum() / np.trace((np.eye(n) - hat) @ common)
    return slope, float(np.sqrt(variance * (weights @ common @ weights))), float(y.mean() - slope * middle)
