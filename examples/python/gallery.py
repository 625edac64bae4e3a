"""The figures of the gallery in the book: loops of contact laws, responses, a nonlinear mode, a Campbell diagram.

    cargo build --release
    PYTHONPATH=include python examples/python/gallery.py FOLDER [NAME ...]

Needs matplotlib. Each function draws one figure and is a program of its own."""
import os
import sys
from typing import Any, Callable, Dict, List

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot

import hbvib


def contact_laws() -> Any:
    """Force over motion of nine laws: seven under 0.5 cos(t), the others at the resonance of an oscillator."""
    figure, places = pyplot.subplots(3, 3, figsize=(9, 8), layout="constrained")
    turn = 2 * np.pi * np.arange(401) / 400
    waves: Any = np.exp(1j * np.outer(turn, np.arange(64)))
    free = iter(places.flat)

    def draw(title: str, motion: Any, force: Any) -> None:
        ax = next(free)
        ax.plot(motion, force)
        ax.set(title=title, xlabel="motion", ylabel="force")

    def prescribed(title: str, harmonics: Any, force: Any) -> None:
        draw(title, (waves @ harmonics).real, (waves @ force).real)

    y = np.zeros(64, complex)
    y[1] = 0.5
    prescribed("jenkins", y, hbvib.evaluate_contact("jenkins", y, kt=1, mu=0.3, preload=1).force)
    normal = np.zeros(64, complex)
    normal[0], normal[1] = -0.5, 0.4j  # pressed by 0.5 at rest, more and less in quadrature
    prescribed("friction_2d", y, hbvib.evaluate_contact("friction_2d", np.array([y, normal]), kt=1, kn=2, mu=0.4).force[0])
    across = 0.7j * y  # an ellipse
    prescribed("friction_3d", y, hbvib.evaluate_contact("friction_3d", np.array([y, across]), kt=1, mu=0.3, preload=1).force[0])
    prescribed("unilateral", y, hbvib.evaluate_contact("unilateral", y, kn=1, gap=0.1).force)
    prescribed("cubic", y, hbvib.evaluate_contact("cubic", y, kt=0.5, cubic=3).force)
    prescribed("regularised", y, hbvib.evaluate_contact("regularised", y, mu=0.3, preload=1, velocity=0.05).force)
    joint = hbvib.Model(mass=1, stiffness=1)
    total = np.zeros(64, complex)
    for number in joint.add_iwan(0, slip_force=0.3, stiffness=1, chi=-0.5, beta=1, elements=100):
        given = joint.contact(number).constants
        total += hbvib.evaluate_contact("jenkins", y, kt=given["kt"], mu=given["mu"], preload=given["preload"]).force
    prescribed("Iwan joint, 100 elements", y, total)

    spring, damper = (hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.05)) for _ in range(2))
    spring.add_table(0, displacement=[-1, -0.3, 0.3, 1], force=[-1, -0.05, 0.05, 1])
    damper.add_spring_damper(0, damper=[0, 0, 0.5])
    for model, title in ((spring, "table"), (damper, "polynomial damper, 0.5 v\N{SUPERSCRIPT THREE}")):
        model.add_force(0, 0.05 if model is spring else 0.3)
        branch = model.forced_response((0.5, 2))
        loop = branch.loop(int(branch.peaks().point[0]), 0)
        draw(title, np.append(loop.motion, loop.motion[0]), np.append(loop.force, loop.force[0]))
    return figure


def oscillator(force: float) -> hbvib.Model:
    """A mass on a spring that rubs on the ground."""
    model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, force)
    return model


def friction_damper() -> Any:
    """Amplitude per force: stuck under small forces, damped most in between, free under large ones."""
    figure, ax = pyplot.subplots(layout="constrained")
    for force in (0.01, 0.05, 0.1, 0.2, 0.35, 0.6, 2.0):
        branch = oscillator(force).forced_response((0.7, 1.7), step_max=0.02)
        ax.semilogy(branch.omega, branch.amplitude / force, label=f"{force:g}")
    ax.set(xlabel="angular frequency omega", ylabel="peak amplitude of harmonic 1 / force")
    ax.legend(title="force")
    return figure


def hysteresis() -> Any:
    """The loop of the contact at the resonance under three forces: the area is the work per cycle."""
    figure, ax = pyplot.subplots(layout="constrained")
    for force in (0.1, 0.2, 0.4):
        branch = oscillator(force).forced_response((0.7, 1.7))
        point = int(branch.peaks().point[0])
        branch.plot_loop(point, 0, ax=ax, label=f"{force:g}, work {branch.summary(point, 0).work:.3f}")
    ax.legend(title="force")
    return figure


def duffing() -> Any:
    """A hardening spring: the branch turns back at its folds; dots: the same amplitudes by marching in time."""
    model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
    model.add_contact("cubic", 0, cubic=1)
    model.add_force(0, 0.3)
    branch = model.forced_response((0.3, 2.2), step_max=0.02)
    ax = branch.plot(label="harmonic balance")
    folds = branch.folds()
    ax.plot(folds.omega, folds.amplitude, "s", color="0.4", label="folds")
    for omega in (0.5, 0.8, 1.1, 1.4):
        found = model.time_response(omega, method="marching")
        ax.plot(omega, abs(found.harmonics[1, 0]), ".", color="black")
    ax.legend()
    return ax.figure


def nonlinear_mode() -> Any:
    """Frequency and damping of the friction damper over the amplitude, without any force."""
    above, _ = oscillator(0).nonlinear_mode((-1.5, 1), step_max=0.05).plot()
    return above.figure


def rotor() -> Any:
    """A disk on a flexible shaft: forward and backward whirl part with the speed; dots are critical speeds."""
    model = hbvib.Model(mass=np.diag([1.0, 1.0, 0.3, 0.3]), stiffness=np.array(
        [[2.0, 0, 0, 0.5], [0, 2.0, -0.5, 0], [0, -0.5, 1.0, 0], [0.5, 0, 0, 1.0]]))
    gyroscopic = np.zeros((4, 4))
    gyroscopic[2, 3], gyroscopic[3, 2] = 0.4, -0.4
    model.set_matrix("gyroscopic", gyroscopic)
    ax = model.plot_campbell(np.linspace(0, 2.5, 26), 4, engine_orders=(1, 2))
    return ax.figure


def underplatform_damper() -> Any:
    """A cylinder under the platforms of two blades: its response under three speeds, and the band over its residual force."""
    ax: Any = None
    for speed, color in ((1.4, "tab:green"), (2.0, "tab:blue"), (2.8, "tab:purple")):
        sector = hbvib.Model.cyclic(sectors=24, engine_order=3, mass=1, stiffness=1, damping=0.02)
        faces = [dict(dofs=[0, -1, -1], angle=angle, kt=1, kn=1.5, mu=mu, sector_offset=offset)
                 for angle, mu, offset in ((-np.pi / 4, 0.6, 0), (np.pi / 4, 0.15, 1))]
        sector.add_damper(faces, mass=0.01, radius=0.05, length=0.2, orbit=25, support=(1e-3, 1e-4), support_damping=(4e-3, 1e-5))
        sector.set_speed(speed)
        sector.add_force(0, 0.06)
        branch = sector.forced_response((1.0, 1.4), harmonics=5, tolerance=0, response_dof=0)
        ax = sector.band_curve(branch).plot(ax, color=color, label=f"speed {speed:g}")
        ax.plot(branch.omega, branch.amplitude, color=color)
    ax.set(xlabel="angular frequency", ylabel="amplitude of the blade")
    ax.legend()
    return ax.figure


def mistuned_wheel() -> Any:
    """Blades of a wheel of 12 with friction: all responses of a random pattern, and the largest blade of 40 patterns."""
    sector = hbvib.Model.cyclic(sectors=12, engine_order=2, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 5.2]],
                                coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
    sector.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=0.1)
    sector.add_force(0, 0.02)
    patterns = 0.01 * np.random.default_rng(3).standard_normal((40, 12))
    options: Any = dict(harmonics=3, tolerance=0)
    wheel = sector.wheel()
    wheel.mistune(sector, "frequency", patterns[0], dofs=[0])
    peaks = wheel.wheel_peaks(sector, (0.7, 0.95), **options)
    study = sector.wheel_study((0.7, 0.95), patterns, kind="frequency", dofs=[0], **options)
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 4), layout="constrained")
    for one in peaks.branch.responses:
        left.plot(peaks.branch.omega, one.amplitude, color="0.7", linewidth=0.8)
    left.plot(*peaks.envelope(), color="tab:red", label="largest blade")
    left.axhline(peaks.tuned, color="black", linestyle="--", label="tuned")
    left.set(xlabel="angular frequency", ylabel="amplitude")
    left.legend()
    right.plot(np.sort(study.amplification), np.arange(1, 41) / 40, drawstyle="steps-post", label="40 wheels")
    levels = np.linspace(0.002, 0.999, 400)
    fit = study.weibull()
    right.plot([fit.quantile(level) for level in levels], levels, label="Weibull")
    right.set(xlabel="amplification", ylabel="share of the wheels")
    right.legend()
    return figure


FIGURES: Dict[str, Callable[[], Any]] = dict(
    contact_laws=contact_laws, friction_damper=friction_damper, hysteresis=hysteresis, duffing=duffing,
    nonlinear_mode=nonlinear_mode, rotor=rotor, underplatform_damper=underplatform_damper, mistuned_wheel=mistuned_wheel)


def main(arguments: List[str]) -> None:
    if not arguments:
        sys.exit(f"usage: gallery.py FOLDER [{' | '.join(FIGURES)}] ...")
    os.makedirs(arguments[0], exist_ok=True)
    for name in arguments[1:] or FIGURES:
        figure = FIGURES[name]()
        figure.savefig(os.path.join(arguments[0], name + ".png"), dpi=80)
        pyplot.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])
