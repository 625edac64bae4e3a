"""Figures of branches and models on matplotlib, which is imported on first use."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Sequence

import numpy as np

from ._errors import ArgumentError, UnsupportedError
from ._results import Campbell, Interference, Points
from ._units import Units, label

if TYPE_CHECKING:
    from ._branch import Branch
    from ._run_up import CampbellResponse


def axes(count: int = 1) -> Any:
    """New axes above each other, one object if it is one."""
    try:
        from matplotlib import pyplot  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("plots need matplotlib: pip install matplotlib") from None
    return pyplot.subplots(count, sharex=True, layout="constrained")[1]


def through(x: Any, y: Any, peak_x: Any, peak_y: Any) -> tuple[Any, Any]:
    """A curve through its peaks, which lie between its points: each is put into the segment that it lengthens least."""
    for px, py in zip(peak_x, peak_y) if len(x) > 1 else ():
        wide, high = max(np.ptp(x), 1e-300), max(np.ptp(y), 1e-300)
        distance = np.hypot((x - px) / wide, (y - py) / high)
        longer = distance[:-1] + distance[1:] - np.hypot(np.diff(x) / wide, np.diff(y) / high)
        place = int(np.argmin(longer)) + 1
        x, y = np.insert(x, place, px), np.insert(y, place, py)
    return x, y


def frequency(hertz: bool, units: Units) -> tuple[float, str]:
    """What angular frequencies are divided by, and their label."""
    return (2 * np.pi, "frequency / Hz") if hertz else (1.0, label("angular frequency omega", units.speed))


def peaks_of(branch: Branch) -> Points:
    """The peaks, none where the branch comes from a table that has fields alone."""
    try:
        return branch.peaks()
    except UnsupportedError:
        return Points(np.empty(0), np.empty(0), np.empty(0, np.int64))


def plot(branch: Branch, ax: Any, hertz: bool, line: dict[str, Any], periods: int = 1) -> Any:
    """See Branch.plot. Frequencies are those of the forces, of which one period of the branch has several."""
    ax = curve(branch, ax, hertz, line, periods)
    try:
        children = branch.children
    except UnsupportedError:  # a table that has fields alone
        return ax
    without_label = {name: value for name, value in line.items() if name != "label"}
    for child in children:
        plot(child, ax, hertz, without_label, periods * child.descent.periods)
    return ax


def curve(branch: Branch, ax: Any, hertz: bool, line: dict[str, Any], periods: int) -> Any:
    """The branch without its children."""
    unit, name = frequency(hertz, branch.units)
    unit /= periods
    if branch.is_mode:
        above, below = axes(2) if ax is None else ax
        largest = [branch.mode_point(int(point)) for point in peaks_of(branch).point]
        place, ratio = np.log10([p.modal_amplitude for p in largest]), [p.damping_ratio for p in largest]
        x, y = through(np.log10(branch.modal_amplitude), branch.damping_ratio, place, ratio)
        above.semilogx(branch.modal_amplitude, branch.omega / unit, **line)
        above.set(ylabel=name)
        below.semilogx(10**x, 100 * y, **line)
        below.set(xlabel="modal amplitude", ylabel="damping ratio / %")
        return above, below
    ax = axes() if ax is None else ax
    peaks = peaks_of(branch)
    drawn: Any = None
    for unstable, omega, amplitude in stretches(branch):
        if drawn is not None:
            line = {**line, "color": drawn.get_color(), "label": None}
        style = {"linestyle": "--"} if unstable else {}
        x, y = through(omega, amplitude, peaks.omega, peaks.amplitude) if len(omega) == len(branch) else (omega, amplitude)
        (drawn,) = ax.plot(x / unit, y, **{**line, **style})
    ax.plot(peaks.omega / unit, peaks.amplitude, "o", color=drawn.get_color(), markersize=4)
    ax.set(xlabel=name, ylabel=label("peak amplitude of harmonic 1", branch.units.length))
    return ax


def stretches(branch: Branch) -> list[tuple[bool, Any, Any]]:
    """The curve in parts, each with True where it is unstable; they meet at the bifurcations."""
    try:
        unstable = branch.unstable_directions > 0
        turns = branch.bifurcations()
    except (ArgumentError, UnsupportedError):  # no stability, or a table that has fields alone
        return [(False, branch.omega, branch.amplitude)]
    found, first = [], 0
    changes = (turns.unstable_before > 0) != (turns.unstable_after > 0)
    joints = iter(zip(turns.omega[changes], turns.amplitude[changes]))
    head: list[tuple[float, float]] = []
    for end in [*np.flatnonzero(np.diff(unstable)) + 1, len(unstable)]:
        joint = [next(joints, (branch.omega[end - 1], branch.amplitude[end - 1]))] if end < len(unstable) else []
        part = [*head, *zip(branch.omega[first:end], branch.amplitude[first:end]), *joint]
        found.append((bool(unstable[first]), *np.array(part).T))
        first, head = end, joint
    return found


def loop(branch: Branch, point: int, contact: int, direction: int, n: int, ax: Any, line: dict[str, Any]) -> Any:
    """See Branch.plot_loop."""
    ax = axes() if ax is None else ax
    motion, force, _ = branch.loop(point, contact, direction, n)
    ax.plot(np.append(motion, motion[0]), np.append(force, force[0]), **line)
    units = branch.units
    ax.set(xlabel=label("relative motion", units.length), ylabel=label(f"force of contact {contact}", units.force))
    return ax


def campbell(diagram: Campbell, opposite: Optional[Campbell], orders: Sequence[int], ax: Any, hertz: bool,
             line: dict[str, Any]) -> Any:
    """See Model.plot_campbell."""
    ax = axes() if ax is None else ax
    unit, name = (2 * np.pi, "frequency / Hz") if hertz else (1.0, "angular frequency omega")
    speeds = diagram.speeds / unit
    ax.plot(speeds, diagram.omega / unit, **line)
    if opposite is not None:
        ax.set_prop_cycle(None)
        ax.plot(speeds, opposite.omega / unit, **{**line, "alpha": 0.4})
    top = ax.get_ylim()[1]
    for order in orders:
        ax.plot(speeds, order * speeds, "--", color="0.6", linewidth=1)
        at = min(speeds[-1], top / max(abs(order), 1))
        ax.annotate(f"EO {order}", (at, order * at), ha="right")
    ax.plot(diagram.crossings.speed / unit, diagram.crossings.omega / unit, "o", color="0.2", markersize=4)
    ax.set(xlabel=name.replace("angular frequency omega", "speed Omega").replace("frequency", "speed"), ylabel=name,
           ylim=(0, top))
    return ax


def campbell_response(found: CampbellResponse, diagram: Optional[Campbell], ax: Any, hertz: bool) -> Any:
    """See CampbellResponse.plot."""
    unit = 2 * np.pi if hertz else 1.0
    if diagram is not None:
        ax = campbell(diagram, None, (), ax, hertz, {"color": "0.5", "linewidth": 1})
    ax = axes() if ax is None else ax
    fastest = 1.2 * np.nanmax(found.speed, initial=0.0) / unit
    for order in np.unique(found.engine_order):
        ax.plot([0, fastest], [0, order * fastest], "--", color="0.6", linewidth=1)
        ax.annotate(f"EO {order:g}", (fastest, order * fastest), ha="right")
    size = 30 + 3000 * np.nan_to_num(found.damping_ratio)
    points = ax.scatter(found.speed / unit, found.omega / unit, c=found.amplitude, s=size, cmap="viridis", zorder=3)
    ax.figure.colorbar(points, ax=ax, label="peak amplitude")
    several = np.unique(found.force_factor).size > 1
    labels = []
    for speed, omega, damping, factor, force in zip(found.speed / unit, found.omega / unit, found.damping_ratio, found.factor,
                                                    found.force_factor):
        if np.isfinite(omega):
            text = (f"F x {force:.3g}: " if several else "") + f"D {100 * damping:.2g} %"
            labels.append((speed, omega, text + (f", run-up {factor:.2f}" if np.isfinite(factor) else "")))
    ax.set(xlabel="speed / Hz" if hertz else "speed Omega", ylabel="frequency / Hz" if hertz else "angular frequency omega")
    _label_apart(ax, labels)
    return ax


def _label_apart(ax: Any, labels: Sequence[tuple[float, float, str]], size: float = 8) -> None:
    """Writes labels (x, y, text) beside their points, below each other where they would overlap, and left of points near the edge."""
    if not labels:
        return
    points, step = 72 / ax.figure.dpi, 1.3 * size
    places = ax.transData.transform([label[:2] for label in labels]) * points
    edge = ax.bbox.x1 * points
    taken: list[tuple[float, float, float]] = []  # left, right and height of each label, in points of the page
    for at in np.lexsort((places[:, 0], -places[:, 1])):
        (x, y), (*of, text) = places[at], labels[at]
        width = 0.6 * size * len(text)
        left = x + size if x + size + width <= edge else x - size - width
        height = y - step
        while any(left < right and begin < left + width and abs(height - other) < step for begin, right, other in taken):
            height -= 0.25 * step
        taken.append((left, left + width, height))
        line = dict(arrowstyle="-", color="0.7", linewidth=0.5) if height < y - 1.5 * step else None
        ax.annotate(text, of, textcoords="offset points", xytext=(left - x, height - y), fontsize=size, arrowprops=line)


def interference(waves: Interference, speed: float, orders: Sequence[int], ax: Any, hertz: bool,
                 line: dict[str, Any]) -> Any:
    """See Model.plot_interference."""
    ax = axes() if ax is None else ax
    unit, name = (2 * np.pi, "frequency / Hz") if hertz else (1.0, "angular frequency omega")
    sectors, folded = len(waves.diameters), waves.equal_senses

    def wave(order: Any) -> Any:
        signed = (order + (sectors - 1) // 2) % sectors - (sectors - 1) // 2
        return np.abs(signed) if folded else signed

    shown = waves.diameters >= (0 if folded else waves.diameters[0])
    diameters, omega = waves.diameters[shown], waves.omega[shown]
    top = 1.05 * np.nanmax(omega) / unit
    for mode in omega.T:
        ax.plot(diameters, mode / unit, **{"linestyle": "none", "marker": "o", "markersize": 4, **line})
    highest = min(int(top * unit / abs(speed)), 100 * sectors) + 1 if speed else 0
    zigzag = np.arange(highest + 1)
    # A line of signed waves begins again where it leaves the diagram.
    turns: Any = [] if folded else np.flatnonzero(np.diff(wave(zigzag)) < 0) + 1
    for ray in np.split(zigzag, turns):
        ax.plot(wave(ray), ray * abs(speed) / unit, "--", color="0.6", linewidth=1)
    for order in orders:
        at = (wave(order), abs(order * speed) / unit)
        if at[1] <= top:
            ax.plot(*at, "s", color="0.2", markersize=4)
            ax.annotate(f"EO {order}", at, textcoords="offset points", xytext=(6, 0), va="center")
    ax.set(xlabel="nodal diameter", ylabel=name, xlim=(diameters[0] - 0.5, sectors // 2 + 0.5), ylim=(0, top))
    return ax
