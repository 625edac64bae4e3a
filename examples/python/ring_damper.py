"""A bladed disk with a friction ring damper, in Python: one of 24 sectors, engine order 2, friction between disk and ring.
Prints the resonance of the blade tip under three forces.

    cargo build --release
    PYTHONPATH=include python examples/python/ring_damper.py [--figures FOLDER]

With --figures (needs matplotlib) also draws the three responses, and frequency and damping of the nonlinear mode.
"""
import argparse
import math
import os
import sys
from typing import Iterable, Iterator, List, Tuple

import numpy as np

import hbvib

B2, B1, D, R = range(4)  # blade tip, blade root, disk, ring
FORCES = (1, 5, 20)  # N
HZ = 2 * math.pi


def ring_damper(force: float, ring_mass: float = 0.03, rpm: float = 3000) -> hbvib.Model:
    kb2, kb1, kd, kg, kr, radius = 2e6, 1e6, 5e7, 6e5, 2e7, 0.165
    spin = rpm * 2 * math.pi / 60
    stiffness = np.array([[kb2, -kb2, 0, 0],
                          [-kb2, kb2 + kb1, -kb1, 0],
                          [0, -kb1, kb1 + kg + 2 * kd, 0],
                          [0, 0, 0, 2 * kr]])
    model = hbvib.Model.cyclic(sectors=24, engine_order=2,
                               mass=np.diag([0.2, 0.3, 1.2, ring_mass]), stiffness=stiffness,
                               coupling=dict(stiffness=np.diag([0, 0, -kd, -kr])),
                               rayleigh=(0, 1.5e-6))  # C = 1.5e-6 s * K
    model.add_contact("jenkins", D, R, kt=5e7, mu=0.3, preload=ring_mass * radius * spin * spin)
    set_force(model, force)
    return model


def set_force(model: hbvib.Model, force: float) -> None:
    model.clear_forces()
    model.add_force(B2, force)
    model.add_force(B1, force)


def responses(model: hbvib.Model) -> Iterator[Tuple[float, hbvib.Branch]]:
    """A branch for each force."""
    for force in FORCES:
        set_force(model, force)
        yield force, model.forced_response((HZ * 207, HZ * 211), harmonics=63, response_dof=B2)


def table(branches: Iterable[Tuple[float, hbvib.Branch]]) -> None:
    print("   F/N              f/Hz            |X1|/m")
    for force, branch in branches:
        peaks = branch.peaks()
        best = peaks.amplitude.argmax()
        print(f"{force:6.1f}  {peaks.omega[best] / HZ:16.11f}  {peaks.amplitude[best]:19.12E}")


def figures(model: hbvib.Model, branches: List[Tuple[float, hbvib.Branch]], folder: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    mode = model.nonlinear_mode((-6, -2), harmonics=9, response_dof=B2, step_max=0.005)  # small steps draw a smooth curve
    figure, axes = pyplot.subplots()
    for force, branch in branches:
        axes.semilogy(branch.omega / HZ, branch.amplitude, label=f"{force} N")
    axes.semilogy(mode.omega / HZ, mode.amplitude, "k--", label="nonlinear mode")
    axes.set(xlabel="frequency / Hz", ylabel="blade tip |X1| / m", xlim=(207, 211), ylim=(1e-5, 3e-2))
    axes.legend()
    figure.savefig(os.path.join(folder, "response.png"), dpi=150)

    figure, (above, below) = pyplot.subplots(2, sharex=True)
    above.semilogx(mode.amplitude, mode.omega / HZ)
    above.set(ylabel="frequency / Hz")
    below.semilogx(mode.amplitude, 100 * mode.damping_ratio)
    below.set(xlabel="blade tip |X1| / m", ylabel="damping ratio / %")
    figure.savefig(os.path.join(folder, "mode.png"), dpi=150)


def main() -> None:
    parser = argparse.ArgumentParser(description="Resonances of a bladed disk with a friction ring damper.")
    parser.add_argument("--figures", metavar="FOLDER", help="draw figures into this folder")
    folder = parser.parse_args().figures
    model = ring_damper(FORCES[0])
    branches = list(responses(model))
    table(branches)
    if folder:
        os.makedirs(folder, exist_ok=True)
        figures(model, branches, folder)


if __name__ == "__main__":
    try:
        main()
    except hbvib.Error as error:
        sys.exit(str(error))
