"""Modes about the static state, structural damping given as one triangle, terms of the speed: closed forms, and misuse."""

import math

import numpy as np

from common import bits, check, close, finish, hbvib, raises, ring_damper, solve

ETA = 0.02

# A stop that presses at rest, then one that only touches; friction under a constant force.
model = hbvib.Model(mass=1, stiffness=1)
stop = model.add_contact("unilateral", 0, kn=2, preload=0.5)
mode = model.nonlinear_mode((-2, 1), harmonics=9)
info = mode.mode_info
close("a pressed stop is closed at small amplitudes", info.omega, math.sqrt(3), 1e-12)
close("it lifts off", info.lift_off_from, math.log10(1 / 12), 1e-9)
check("nothing slips", info.slip_from == math.inf)
x = mode.harmonics(0)[:, 0]
close("motions are total", x[0].real, 1 / 6, 1e-12)
close("potential energy counts from the static state", mode.energy(0).potential_mean, 0.25 * abs(x[1]) ** 2, 1e-10)
close("twice the mean kinetic energy", mode.mode_energy[0], 1.5 * abs(x[1]) ** 2, 1e-10)
model.set_preload(stop, 0)
touching = model.nonlinear_mode((-2, 1), harmonics=63)
close("a touching stop has one frequency", touching.omega, np.full(len(touching), 2 * math.sqrt(3) / (1 + math.sqrt(3))), 1e-9)
check("it lifts off at every amplitude", touching.mode_info.lift_off_from == -math.inf)
rubbing = hbvib.Model(mass=1, stiffness=1)
rubbing.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
rubbing.add_force(0, 0.2, harmonic=0)
loaded = rubbing.nonlinear_mode((-2, 0.5), harmonics=5)
close("a loaded slider is dragged along", loaded.mode_info.linear_up_to, math.log10(0.2), 1e-8)
close("then it slips", loaded.mode_info.slip_from, math.log10(0.3), 1e-6)
close("about the static state", loaded.harmonics(0)[0, 0].real, 0.1, 1e-12)

# Two masses of 1 between three springs of 1 + i eta.
chain = np.array([[2.0, -1.0], [-1.0, 2.0]])
lossy = chain * (1 + 1j * ETA)
lower, upper = lossy.copy(), lossy.copy()
lower[0, 1] = upper[1, 0] = complex(math.nan, math.nan)
one, other = 1 / (1j * ETA), 1 / (2 + 3j * ETA)


def plain(stiffness=chain, part="full"):
    model = hbvib.Model(2)
    model.set_matrix("mass", np.eye(2))
    model.set_matrix("stiffness", stiffness, part=part)
    model.add_force(0, 1)
    return model


def has_the_response(claim, model):
    branch = model.forced_response(1.0, harmonics=1)
    close(claim, branch.harmonics(0)[1], [0.5 * (one + other), 0.5 * (one - other)], 1e-12)
    raises(f"{claim}: no response in time", NotImplementedError, model.time_response, 1.0, words="viscous equivalent")
    raises(f"{claim}: no check in time", NotImplementedError, model.verify, branch, 0, words="no causal law")


has_the_response("a complex symmetric stiffness", plain(lossy, "symmetric"))
has_the_response("its lower triangle", plain(lower, "symmetric_lower"))
has_the_response("its upper triangle", plain(upper, "symmetric_upper"))
factor, matrix = plain(), plain()
factor.set_loss_factor(ETA)
matrix.set_matrix("structural", ETA * chain)
half = math.sin(0.5 * math.atan(ETA))
close("half the loss factor", factor.damped_modes(2).damping_ratio, [half, half], 1e-12)
close("the same of a matrix", matrix.damped_modes(2).damping_ratio, [half, half], 1e-12)
has_the_response("a loss factor", factor)
has_the_response("a structural matrix", matrix)
raises("a lower triangle with a complex diagonal", ValueError, plain, lower, "lower", words="SYMMETRIC_LOWER")
raises("an upper triangle with a complex diagonal", ValueError, plain, upper, "upper", words="SYMMETRIC_UPPER")
raises("a stiffness that is not Hermitian", ValueError, plain, lossy, words="SYMMETRIC")
raises("the wrong triangle", ValueError, plain, lower, "symmetric_upper", words="stiffness[0,1]")
raises("a part that is none", ValueError, plain, lossy, "complex", words="symmetric_lower")

# Stiffness 1 - 0.2 Omega^2, an unbalance, and engine orders that meet it.
model = hbvib.Model(mass=1, stiffness=1)
model.set_matrix("stiffness_speed2", [[-0.2]])
model.add_force(0, 1)
model.set_speed(1.0)
close("a frequency at speed", model.damped_modes(1, contacts="free").omega, [math.sqrt(0.8)], 1e-13)
diagram = model.campbell([0.2, 0.5, 1.0], 1, engine_orders=(1, 2, 3), contacts="free")
close("a Campbell diagram", diagram.omega[:, 0], np.sqrt(1 - 0.2 * diagram.speeds**2), 1e-13)
order = diagram.crossings.engine_order
close("its crossings", diagram.crossings.speed, np.sqrt(1 / (np.array([1, 2, 3]) ** 2 + 0.2)), 1e-12)
close("their frequencies", diagram.crossings.omega, order * diagram.crossings.speed, 1e-12)
model.set_speed(per_omega=0.5)
w = 0.7
tied = model.forced_response(w, harmonics=1).harmonics(0)[1]
close("a speed of the frequency", tied, [1 / (1 - 0.2 * (0.5 * w) ** 2 - w**2)], 1e-12)
raises("modes at no one speed", ValueError, model.damped_modes, 1, words="fixed speed")
stop = model.add_contact("unilateral", 0, kn=2, preload=0.5)
raises("a static state of no one speed", NotImplementedError, model.nonlinear_mode, (-2, 1), words="set a fixed speed")
model.set_speed(0.0)
close("a closed stop", model.damped_modes(1, contacts="static").omega, [math.sqrt(3)], 1e-12)
model.set_preload(stop, 0.5, per_speed2=-0.5)
model.set_speed(2.0)
close("its load is gone at speed", model.damped_modes(1, contacts="static").omega, [math.sqrt(0.2)], 1e-12)
rotor = hbvib.Model(mass=np.eye(2), stiffness=np.eye(2))
rotor.add_unbalance(0, 1, 0.3, phase=0.4)
wanted = 0.3 * w**2 / (1 - w**2) * np.exp(0.4j)
close("an unbalance", rotor.forced_response(w, harmonics=1).harmonics(0)[1], [wanted, -1j * wanted], 1e-12)

# Misuse leaves the model as it was.
model = ring_damper()
reference = bits(solve(model))


def refused(claim, kind, function, *arguments, words="", **options):
    raises(claim, kind, function, *arguments, words=words, **options)
    check(f"{claim}: the model solves to the same bits", bits(solve(model)) == reference)


refused("a loss factor below 0", ValueError, model.set_loss_factor, -1, words="loss_factor = -1")
refused("a loss factor of no number", ValueError, model.set_loss_factor, math.nan, words="loss_factor = NaN")
refused("a modal ratio below 0", ValueError, model.set_modal_damping, [0.01, -0.01], words="ratios[1] = -0.01")
refused("a gyroscopic matrix without its symmetry", ValueError, model.set_matrix, "gyroscopic", np.eye(4), words="skew-symmetric")
refused("a structural matrix of no number", ValueError, model.set_matrix, "structural", np.full((4, 4), math.nan), words="NaN")
refused("no speed", ValueError, model.set_speed, math.nan, words="speed = NaN")
refused("a speed of no frequency", ValueError, model.set_speed, per_omega=math.inf, words="per_omega = inf")
refused("two speeds", TypeError, model.set_speed, 1.0, per_omega=1.0)
refused("a load of no number", ValueError, model.set_preload, 0, 1.0, per_speed2=math.nan, words="per_speed2 = NaN")
refused("a load of no contact", IndexError, model.set_preload, 1, 1.0, per_speed2=1.0)
refused("an unbalance of one direction", ValueError, model.add_unbalance, 1, 1, 1.0, words="both 1")
refused("an unbalance beside the structure", IndexError, model.add_unbalance, 4, 1, 1.0, words="dof_x = 4")
refused("an unbalance of no number", ValueError, model.add_unbalance, 0, 1, math.nan, words="m_e = NaN")
refused("a diameter of no wheel", ValueError, hbvib.Model(mass=1, stiffness=1).damped_modes, 1, diameter=13,
        words="diameter = 13, needs 0 .. 0")
refused("no mode", ValueError, model.damped_modes, 0, words="count = 0")
refused("contacts in no state", ValueError, model.damped_modes, 1, contacts="slipping", words="stuck")
refused("falling speeds", ValueError, model.campbell, [0.5, 0.2], 1, words="speeds[1] = 0.2")
refused("a speed of no number", ValueError, model.campbell, [0.5, math.nan], 1, words="speeds[1] = NaN")
refused("no speeds", ValueError, model.campbell, [], 1, words="no speeds")
refused("engine order 0", ValueError, model.campbell, [0.2, 0.5], 1, engine_orders=[0], words="engine_order = 0")
refused("half an engine order", TypeError, model.campbell, [0.2, 0.5], 1, engine_orders=[0.5])

finish(85)
