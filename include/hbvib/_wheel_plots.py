"""Figures of mistuned wheels on matplotlib: blades and their envelope, distributions over patterns, the worst pattern as bars."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._plots import axes, frequency
from ._units import label

if TYPE_CHECKING:
    from ._wheel_quantile import WheelQuantile
    from ._wheel_results import WheelPeaks, WheelStudy, WorstPattern


def blades(peaks: WheelPeaks, ax: Any, hertz: bool) -> Any:
    """See WheelPeaks.plot."""
    ax = axes() if ax is None else ax
    units = peaks.branch.units
    unit, name = frequency(hertz, units)
    omega, envelope = peaks.envelope()
    for number, one in enumerate(peaks.branch.responses):
        ax.plot(omega / unit, one.amplitude, color="0.7", linewidth=0.8, label=None if number else "blades")
    ax.plot(omega / unit, envelope, color="tab:red", label="largest blade")
    if np.isfinite(peaks.tuned):
        ax.axhline(peaks.tuned, color="black", linestyle="--", label="peak of the tuned wheel")
    ax.set(xlabel=name, ylabel=label("amplitude", units.length))
    ax.legend()
    return ax


def distribution(study: WheelStudy, ax: Any) -> Any:
    """See WheelStudy.plot."""
    ax = axes() if ax is None else ax
    values = np.sort(study.amplification[np.isfinite(study.largest)])
    ax.plot(values, np.arange(1, len(values) + 1) / len(values), drawstyle="steps-post", label=f"{len(values)} wheels")
    try:
        fit = study.weibull()
    except ValueError:  # too few wheels
        fit = None
    if fit is not None:
        levels = np.linspace(0.5 / len(values), 0.999, 400)
        ax.plot([fit.quantile(level) for level in levels], levels, label="Weibull")
    ax.set(xlabel="amplification", ylabel="share of the wheels")
    ax.legend()
    return ax


def patterns(study: WheelStudy, ax: Any) -> Any:
    """See WheelStudy.plot_patterns."""
    ax = axes() if ax is None else ax
    ax.plot(np.arange(len(study)), study.amplification, ".", label="solved")
    ax.plot(np.arange(len(study)), study.predicted / study.tuned, "x", color="0.5", markersize=4, label="foretold by the tuned wheel")
    ax.set(xlabel="pattern", ylabel="amplification")
    ax.legend()
    return ax


def quantile(found: WheelQuantile, ax: Any) -> Any:
    """See WheelQuantile.plot."""
    ax = axes() if ax is None else ax
    # Predictions and solved wheels as the first level has them; the interval before the correction.
    before = found.tuned * found.value / (found.coarse.value * found.ratio)
    low, high = before * found.coarse.lower, before * found.coarse.upper
    ax.plot(found.predicted[found.wheels], found.largest[found.wheels], ".", label=f"{len(found.wheels)} wheels solved")
    ends = np.array([found.predicted.min(), found.predicted.max()])
    ax.plot(ends, ends, color="0.5", linewidth=0.8, label="as foretold")
    ax.axhspan(low, high, color="tab:red", alpha=0.3, label="interval of the quantile")
    ax.set(xlabel="largest blade as foretold", ylabel="largest blade")
    ax.legend()
    return ax


def bars(worst: WorstPattern, ax: Any) -> Any:
    """See WorstPattern.plot."""
    ax = axes() if ax is None else ax
    colors = ["tab:red" if value > 0 else "tab:blue" for value in worst.pattern]
    ax.bar(np.arange(len(worst.pattern)), 100 * worst.pattern, color=colors)
    ax.axhline(0, color="black", linewidth=0.8)
    ax.set(xlabel="blade", ylabel="delta / %", title=f"amplification {worst.amplification:.4g} of blade 0")
    return ax
