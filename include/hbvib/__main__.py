"""python -m hbvib demo [FOLDER]: the response of a bladed disk with a friction ring, as a table, CSV and SVG, with numpy alone."""
from __future__ import annotations

import argparse
import os
import sys
import webbrowser
from pathlib import Path
from typing import Sequence

import numpy as np

from . import Branch, Model
from ._library import __version__

HZ = 2 * np.pi
FORCES = (0.1, 1.0, 5.0, 20.0, 100.0)  # N at the tip of each blade


def ring_damper(force: float) -> Model:
    """One of 24 sectors: 0 blade tip, 1 blade root, 2 disk, 3 ring, which rubs under the rim. SI units."""
    mass = np.diag([0.2, 0.3, 1.2, 0.03])
    stiffness = np.array([[2e6, -2e6, 0, 0], [-2e6, 3e6, -1e6, 0], [0, -1e6, 101.6e6, 0], [0, 0, 0, 4e7]])
    to_next = np.diag([0, 0, -5e7, -2e7])
    model = Model.cyclic(sectors=24, engine_order=2, mass=mass, stiffness=stiffness, coupling=dict(stiffness=to_next), rayleigh=(0, 1.5e-6))
    model.add_contact("jenkins", 2, 3, kt=5e7, mu=0.3, preload=0.03 * 0.165 * (100 * np.pi) ** 2)
    model.add_force(0, force)
    model.units = "m", "N", "s"
    return model


def drawing(curves: Sequence[tuple[float, Branch]]) -> str:
    """The curves as SVG: amplitude per force over the frequency, the former logarithmic."""
    width, height, left, top = 760, 480, 80, 30
    low = min(float((curve.amplitude / force).min()) for force, curve in curves)
    high = max(float((curve.amplitude / force).max()) for force, curve in curves)
    begin, end = (curves[0][1].omega[[0, -1]] / HZ).tolist()

    def place(hertz: float, ratio: float) -> str:
        x = left + (width - left - 130) * (hertz - begin) / (end - begin)
        y = top + (height - top - 60) * np.log(high / ratio) / np.log(high / low)
        return f"{x:.1f},{y:.1f}"

    colours = ("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd")
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
             f'<rect width="{width}" height="{height}" fill="white"/>',
             f'<rect x="{left}" y="{top}" width="{width - left - 130}" height="{height - top - 60}" fill="none" stroke="black"/>']
    for hertz in np.arange(np.ceil(begin), end + 1e-9):
        x, y = place(float(hertz), low).split(",")
        lines.append(f'<text x="{x}" y="{float(y) + 18}" text-anchor="middle">{hertz:g}</text>')
    ticks = [step * 10.0**power for power in range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high)))) for step in (1, 2, 5)]
    for tick in ticks:
        if low <= tick <= high:
            lines.append(f'<text x="{left - 8}" y="{float(place(begin, tick).split(",")[1]) + 4}" text-anchor="end">{tick:.0e}</text>')
    for k, (force, curve) in enumerate(curves):
        points = " ".join(place(float(at) / HZ, float(value) / force) for at, value in zip(curve.omega, curve.amplitude))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colours[k % len(colours)]}" stroke-width="1.5"/>')
        row = top + 16 + 20 * k
        lines.append(f'<text x="{width - 115}" y="{row}" fill="{colours[k % len(colours)]}">{force:g} N</text>')
    lines.append(f'<text x="{(left + width - 130) / 2}" y="{height - 12}" text-anchor="middle">frequency / Hz</text>')
    lines.append(f'<text transform="translate(20 {height / 2}) rotate(-90)" text-anchor="middle">amplitude / force in m/N</text>')
    return "\n".join([*lines, "</svg>", ""])


def demo(folder: Path, show: bool) -> int:
    """Solves, prints the peaks, and writes the curves. Returns the exit code."""
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        print(f"{folder}: no new folder can be made there: {error.strerror}; name another one", file=sys.stderr)
        return 1
    curves = [(force, ring_damper(force).forced_response((207 * HZ, 211 * HZ), response_dof=0, step_max=0.02)) for force in FORCES]
    print(curves[0][1])
    print("  force   peak at       amplitude")
    rows = []
    for force, curve in curves:
        peaks = curve.peaks()
        highest = int(np.argmax(peaks.amplitude))
        print(f"{force:5g} N   {peaks.omega[highest] / HZ:.4f} Hz   {peaks.amplitude[highest]:.4e} m")
        rows += [f"{force:g},{at / HZ:.9g},{value:.9g}" for at, value in zip(curve.omega, curve.amplitude)]
    (folder / "response.csv").write_text("\n".join(["force,frequency,amplitude", *rows, ""]), encoding="utf-8")
    picture = folder / "response.svg"
    picture.write_text(drawing(curves), encoding="utf-8")
    print(f"{picture} and {folder / 'response.csv'} are written")
    if show:
        webbrowser.open(picture.resolve().as_uri())
    return 0


def main(arguments: Sequence[str]) -> int:
    """Reads the arguments and runs."""
    parser = argparse.ArgumentParser(prog="python -m hbvib", description="Steady-state vibration of structures with friction contacts.")
    parser.add_argument("--version", action="version", version=f"hbvib {__version__}")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("demo", help="solves a bladed disk with a friction ring, writes a picture and a table")
    run.add_argument("folder", nargs="?", default="hbvib-demo", help="a new folder (hbvib-demo)")
    run.add_argument("--open", action="store_true", help="shows the picture")
    given = parser.parse_args(arguments)
    return demo(Path(os.path.expanduser(given.folder)), given.open)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
