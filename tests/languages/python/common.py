"""Shared parts of the tests: checks that name their claim, and the ring damper as reference model."""

import math
import os
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../include"))

import numpy as np

import hbvib

_checks = 0
_failed = 0


def check(claim, holds, told=""):
    global _checks, _failed
    _checks += 1
    if not holds:
        _failed += 1
        print(f"failed: {claim} {told}", file=sys.stderr)


def close(claim, value, wanted, tolerance):
    """Largest difference over the largest number wanted."""
    value, wanted = np.asarray(value), np.asarray(wanted)
    error = np.max(np.abs(value - wanted)) / np.max(np.abs(wanted)) if value.shape == wanted.shape else math.inf
    check(claim, error <= tolerance, f"(error {error:.3g}, allowed {tolerance:.3g})")


def raises(claim, kind, function, *arguments, words="", **keywords):
    """The call raises exactly what the language's user expects; returns the exception."""
    try:
        function(*arguments, **keywords)
    except BaseException as error:
        check(claim, isinstance(error, kind) and words in str(error), f"({type(error).__name__}: {error})")
        return error
    check(claim, False, "(nothing was raised)")
    return None


# All cases are asked for, and the tools that take long: tests/deep.sh.
THOROUGH = "HBVIB_THOROUGH" in os.environ


def finish(least):
    """Ends the program: 1 if a check failed or fewer ran than there are."""
    if _checks < least:
        print(f"failed: only {_checks} of {least} checks ran", file=sys.stderr)
    sys.exit(1 if _failed or _checks < least else 0)


HZ = 2 * math.pi
STIFFNESS = np.array([[2e6, -2e6, 0, 0], [-2e6, 3e6, -1e6, 0], [0, -1e6, 101.6e6, 0], [0, 0, 0, 4e7]])
MASS = np.diag([0.2, 0.3, 1.2, 0.03])
COUPLING = np.diag([0, 0, -5e7, -2e7])


def ring_damper(force=5.0):
    model = hbvib.Model.cyclic(
        sectors=24,
        engine_order=2,
        mass=MASS,
        stiffness=STIFFNESS,
        coupling=dict(stiffness=COUPLING),
        rayleigh=(0, 1.5e-6),
    )
    model.add_contact("jenkins", 2, 3, kt=5e7, mu=0.3, preload=0.03 * 0.165 * (3000 * HZ / 60) ** 2)
    for dof in (0, 1):
        model.add_force(dof, force)
    return model


def solve(model, **options):
    return model.forced_response((HZ * 207, HZ * 211), response_dof=0, **options)


def bits(branch):
    """All that a branch says of its curve, to the bit."""
    return b"".join(
        [
            branch.omega.tobytes(),
            branch.amplitude.tobytes(),
            branch.slip_fraction.tobytes(),
            branch.harmonics(len(branch) // 2).tobytes(),
            branch.peaks().amplitude.tobytes(),
        ]
    )


def oscillator(force=0.2):
    """A mass on a spring that rubs on the ground: m = 1, k = 1, kt = 1, slip limit 0.3."""
    model = hbvib.Model(mass=1, stiffness=1, damping=0.02)
    model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    model.add_force(0, force)
    return model
