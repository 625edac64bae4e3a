"""Solutions that a sweep does not show: known cases, and the cost of the search beside chains that have none.

    PYTHONPATH=include python examples/python/all_solutions.py [--chains 100]

Prints each figure beside the known one, and ends with 1 where one differs. Times are CPU times of this process: of the responses alone,
with stability, and with branches = 2 and 3. Takes a minute.
"""
import argparse
import resource
import sys
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

import hbvib

FAILED: List[str] = []
ENOUGH = 20  # chains whose times tell a ratio


def row(name: str, found: float, right: float, within: float) -> None:
    """One figure beside the known one."""
    meets = abs(found - right) <= within
    if not meets:
        FAILED.append(name)
    print(f"{name:66} {found:14.9f} {right:14.9f}  {'' if meets else 'DIFFERS'}")


def one_mass(damping: float, force: float, **spring_damper: Any) -> hbvib.Model:
    model = hbvib.Model(mass=1, stiffness=1, damping=damping)
    if spring_damper:
        model.add_spring_damper(0, **spring_damper)
    model.add_force(0, force)
    return model


def falling_damping() -> None:
    """x'' + 0.05 x' - 0.05 x'^3 + 0.012 x'^5 + x = 0.015 cos(omega t); motions by shooting, forces by the closed form of one harmonic."""
    model = one_mass(0.05, 0.015, damper=[0, 0, -0.05, 0, 0.012])
    branch = model.forced_response((0.9, 1.1), harmonics=9, branches=2, at=[1.0])
    amplitudes = sorted([*branch.at(0).amplitude, *branch.children[0].at(0).amplitude])
    for number, right in enumerate((0.325262681622, 1.166534482078, 1.823423529577)):
        row(f"falling damping, motion {number + 1} at omega = 1", amplitudes[number], right, 1e-6)
    for branches in (2, 3):
        descent = model.forced_response((0.9, 1.1), harmonics=1, branches=branches).children[0].descent
        row(f"    force of birth, branches = {branches}", 0.015 * descent.born_at_force, 0.00492012, 1e-8)
        row(f"    force of merging, branches = {branches}", 0.015 * descent.merges_at_force, 0.02346897, 1e-8)


def doubled_periods() -> None:
    """A mass against a stop under cos(omega t), by exact events; a cascade down to eight periods."""
    model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    model.add_contact("unilateral", 0, kn=10)
    model.add_force(0, 1)
    branch = model.forced_response((2.3, 2.5), harmonics=50, branches=1, at=[2.38, 2.43])
    child, = branch.children
    for number, rights in enumerate(((0.183236054604, 0.292415649854), (0.321722447220, 0.268737925605))):
        x = child.harmonics(int(child.at(number).point[0]))[:, 0]
        for harmonic, right in zip((1, 2), rights):
            row(f"stop, omega = {(2.38, 2.43)[number]}, harmonic {harmonic}/2", abs(x[harmonic]), right, 1e-6)
    curve = one_mass(0.1, 0.11, spring=[0, -1]).forced_response((0.95, 0.84), harmonics=10, branches=1)
    doublings, periods = [], 1
    while True:
        doublings.append(periods * curve.bifurcations().omega[0])
        if not curve.children:
            break
        curve, periods = curve.children[0], 2 * periods
        row(f"cascade, unstable directions of {periods} periods where they begin", curve.unstable_directions[0], 0, 0.5)
    row("cascade, children in line", len(doublings) - 1, 3, 0)
    steps = -np.diff(doublings)
    row("cascade, ratio of the last two steps (Feigenbaum 4.669)", float(steps[-2] / steps[-1]), 4.669, 0.5)


def other_motions() -> None:
    """A subharmonic of order 3 and a broken symmetry of hardening springs without a guess; a forced self-excited oscillator."""
    model = one_mass(0.01, 8, spring=[0, 0, 0.4], damper=[0, 0, 0.002])
    branch = model.forced_response((3.5, 3.7), harmonics=7, branches=3, at=[3.6])
    thirds = [child for child in branch.children if child.descent.periods == 3]
    x = max((child.harmonics(int(point)) for child in thirds for point in child.at(0).point), key=lambda x: abs(x[1, 0]))
    row("subharmonic of order 3 at 3.6, harmonic 1/3 (scipy)", abs(x[1, 0]), 1.10973, 1e-5)
    row("    harmonic 1", abs(x[3, 0]), 0.71062, 1e-5)
    model = one_mass(0.1, 10, spring=[0, 0, 1])
    branch = model.forced_response((0.9, 2.0), harmonics=21, branches=1)
    points = branch.bifurcations().omega[branch.bifurcations().kind == "branch_point"]
    row("broken symmetry, children", len(branch.children), 1, 0)
    row("    merges where the other branch point is", branch.children[0].descent.merges_at, float(points[1]), 1e-6)
    model = one_mass(-0.2, 0.2, damper=[0, 0, 0.2])
    branch = model.forced_response((0.9, 1.3), harmonics=9, branches=2)
    kinds = [str(kind) for kind in branch.bifurcations().kind]
    row("van der Pol, second frequencies located", float(kinds.count("neimark_sacker") > 0), 1, 0)
    row("    children (none has one frequency)", len(branch.children), 0, 0)


def nonlinear_modes() -> None:
    """Localised modes of a weakly coupled pair, by one harmonic in closed form; the curve above a 3:1 tongue, by a guess."""
    coupling = 0.1
    stiffness = [[1 + coupling, -coupling], [-coupling, 1 + coupling]]
    model = hbvib.Model(mass=np.eye(2), stiffness=stiffness)
    for dof in (0, 1):
        model.add_contact("cubic", dof, cubic=1)
    mode = model.nonlinear_mode((-2, 1), harmonics=1, mode_index=1, branches=1)
    point = mode.mode_point(int(mode.bifurcations().point[0]))
    row("localised modes, modal amplitude of their birth", 10 ** point.log10_amplitude, (8 * coupling / 3) ** 0.5, 1e-8)
    row("    children", len(mode.children), 2, 0)
    model = hbvib.Model(mass=np.eye(2), stiffness=[[2, -1], [-1, 2]])
    model.add_spring_damper(0, spring=[0, 0, 0.5])
    mode = model.nonlinear_mode((0, 2.2), at=[2.0], harmonics=31, branches=1, branch_depth=1)
    upper, = [child for child in mode.children if child.descent.internal_resonance == 3]
    guess = np.array([[0, 0], [6, 100]], dtype=complex)
    right = model.nonlinear_mode((2.0, 2.2), harmonics=31, guess=guess, guess_omega=1.39).omega[0]
    row("3:1 tongue, the curve above at an amplitude of 100", float(min(upper.at(0).omega, key=lambda w: abs(w - right))), right, 1e-9)


def chain(random: np.random.Generator) -> Tuple[hbvib.Model, float]:
    """Two to five masses with one or two sliders against the ground, and the lowest frequency."""
    n = int(random.integers(2, 6))
    mass = np.diag(random.uniform(0.5, 2, n))
    stiffness = np.diag(random.uniform(0.2, 1, n))
    for i in range(1, n):
        stiffness[i - 1:i + 1, i - 1:i + 1] += random.uniform(0.3, 1.5) * np.array([[1, -1], [-1, 1]])
    model = hbvib.Model(mass=mass, stiffness=stiffness, rayleigh=(0.01, 0.01))
    omega = float(model.linear_modes(1, contacts="free").omega[0])
    for _ in range(int(random.integers(1, 3))):
        kt, load = random.uniform(0.1, 0.6), random.uniform(0.05, 0.5)
        model.add_contact("jenkins", int(random.integers(n)), kt=kt, mu=0.5, preload=load)
    model.add_force(int(random.integers(n)), random.uniform(0.02, 0.3))
    return model, omega


def cost(chains: int) -> None:
    """CPU times of all chains: as children are none, all of it is the cost of the search."""
    ways: Sequence[Tuple[str, Dict[str, Any]]] = (
        ("alone", {}), ("with stability", dict(stability="wave")), ("branches = 1", dict(branches=1)),
        ("branches = 2", dict(branches=2)), ("branches = 3", dict(branches=3)))
    times, reported = [0.0] * len(ways), 0
    for seed in range(chains):
        model, omega = chain(np.random.default_rng(seed))
        for number, (_, options) in enumerate(ways):
            begin = resource.getrusage(resource.RUSAGE_SELF).ru_utime
            branch = model.forced_response((0.7 * omega, 1.6 * omega), harmonics=5, **options)
            times[number] += resource.getrusage(resource.RUSAGE_SELF).ru_utime - begin
            reported += len(branch.children)
    row(f"curves reported beside {chains} chains without one", reported, 0, 0)
    for (name, _), seconds in zip(ways, times):
        print(f"{name:16} {seconds:8.3f} s  {seconds / times[0]:6.2f} x alone  {seconds / times[1]:6.2f} x with stability")
    if chains >= ENOUGH and times[3] > 1.5 * times[1]:
        FAILED.append("the cost of branches = 2")


def main(arguments: Optional[Sequence[str]] = None) -> None:
    parser = argparse.ArgumentParser(description="Solutions that a sweep does not show.")
    parser.add_argument("--chains", type=int, default=100)
    given = parser.parse_args(arguments)
    falling_damping()
    doubled_periods()
    other_motions()
    nonlinear_modes()
    cost(given.chains)
    if FAILED:
        print("differs:", *FAILED, sep="\n    ")
        sys.exit(1)


if __name__ == "__main__":
    main()
