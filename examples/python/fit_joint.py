"""Stiffness and friction of a joint from measured responses, in Python: complex amplitudes of a chain of two masses under three
forces, of which the first mass rubs on the ground. Prints the parameters with their standard deviations, the resonance predicted at
another force, and the interval of the friction limit by the profile of the likelihood.

    cargo build --release
    PYTHONPATH=include python examples/python/fit_joint.py [examples/data/joint.csv]
"""
import sys

import numpy as np

import hbvib


def chain() -> hbvib.Model:
    model = hbvib.Model(mass=np.diag([1, 0.5]), stiffness=np.array([[1.5, -0.5], [-0.5, 0.5]]), rayleigh=(0, 0.01))
    model.add_contact("jenkins", 0, kt=0.5, mu=0.08, preload=1)  # guesses
    model.add_force(1, 1)
    return model


def main() -> None:
    rows = np.loadtxt(sys.argv[1] if len(sys.argv) > 1 else "examples/data/joint.csv", delimiter=",", skiprows=1)
    data = []
    for force in np.unique(rows[:, 0]):
        _, omega, re, im, sigma = rows[rows[:, 0] == force].T
        data.append(hbvib.Measured("response", omega, re + 1j * im, sigma, force=force, response=1))
    unknowns = [hbvib.Unknown(hbvib.Parameter("kt", 0)), hbvib.Unknown(hbvib.Parameter("mu", 0)),
                hbvib.Unknown(hbvib.Parameter("damping", scaling="factor"), 2), hbvib.Unknown(hbvib.Parameter("stiffness", scaling="factor"))]
    fit = chain().fit(unknowns, data, harmonics=9)
    names = ("kt", "friction limit", "damping factor", "stiffness factor")
    for name, value, sd in zip(names, fit.theta, fit.sd):
        print(f"{name:<16}  {value:19.12E}  +- {sd:16.9E}")
    print(f"{'chi2':<16}  {fit.chi2:19.12E}  on {fit.degrees_of_freedom}")
    peak = fit.predict("peak", 0.72, force=0.1, response=1, omega=(0.6, 0.9))
    print(f"{'peak at 0.1':<16}  {peak.value[0]:19.12E}  +- {peak.sigma[0]:16.9E}")
    low, high = fit.profile(1, fit.theta[1] + np.linspace(-3, 3, 9) * fit.sd[1]).interval(3.841)
    print(f"{'95 % of friction':<16}  {low:16.9E} .. {high:16.9E}")


if __name__ == "__main__":
    main()
