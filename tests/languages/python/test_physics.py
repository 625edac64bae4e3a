"""Each analysis against something independent: closed forms, or another analysis."""

import math

import numpy as np

from common import HZ, check, close, finish, hbvib, oscillator, ring_damper, solve

# Linear modes: a chain between walls, a ring of masses.
n = 12
chain = hbvib.Model(mass=np.eye(n), stiffness=2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
modes = chain.linear_modes(n)
number = np.arange(1, n + 1)
close("a chain's frequencies in closed form", modes.omega, 2 * np.sin(number * np.pi / (2 * (n + 1))), 1e-13)
close("its shapes are orthonormal", modes.shapes.conj() @ modes.shapes.T, np.eye(n), 1e-12)
close("and sines", np.abs(modes.shapes[2]), np.abs(np.sqrt(2 / (n + 1)) * np.sin(3 * number * np.pi / (n + 1))), 1e-12)
ring = hbvib.Model.cyclic(sectors=24, mass=1, stiffness=2 + 0.1, coupling=dict(stiffness=-1))
for diameter in (0, 1, 5, 12):
    close(
        "a ring's frequencies by nodal diameter",
        ring.linear_modes(1, diameter).omega,
        [math.sqrt(0.1 + 2 - 2 * math.cos(diameter * HZ / 24))],
        1e-13,
    )
rotor = hbvib.Model(mass=np.diag([1, 1, 0.3, 0.3]), stiffness=np.kron([[1, 0.4], [0.4, 0.8]], np.eye(2)))
gyroscopic = np.zeros((4, 4))
gyroscopic[2, 3], gyroscopic[3, 2] = 0.5, -0.5
rotor.set_matrix("gyroscopic", gyroscopic)
rotor.set_matrix("stiffness_speed2", np.zeros((4, 4)))
rotor.set_speed(1.0)
stodola = [0.693911507, 0.917055456, 1.246325060, 2.689847777]
whirl = rotor.damped_modes(4)
close("Stodola's rotor", whirl.omega, stodola, 1e-9)
close("the same as linear modes", rotor.linear_modes(4, contacts="free").omega, stodola, 1e-9)
check("backward and forward", list(whirl.direction) == [-1, 1, -1, 1])
diagram = rotor.campbell([0.5, 1.0, 1.5], 4, engine_orders=[1])
close("a row of its Campbell diagram", diagram.omega[1], stodola, 1e-9)
close(
    "its forward critical speed",
    diagram.crossings.speed[diagram.crossings.direction == 1],
    [0.9135225809938965],
    1e-12,
)
rotor.set_rayleigh(0, 0.02)
rotor.add_unbalance(0, 1, 0.1, phase=0.3)
rotor.set_speed(per_omega=1)
tied = rotor.forced_response(0.8).harmonics(0)
rotor.set_speed(0.8)
close("a speed of the frequency is that speed", rotor.forced_response(0.8).harmonics(0), tied, 1e-12)
damped = hbvib.Model(mass=2, stiffness=50)
damped.set_loss_factor(0.02)
close("half the loss factor", damped.damped_modes(1).damping_ratio, [math.sin(0.5 * math.atan(0.02))], 1e-12)
damped.set_loss_factor(0)
damped.set_matrix("structural", [[1.0]], part="symmetric_lower")
close("the same by a matrix", damped.damped_modes(1).damping_ratio, [math.sin(0.5 * math.atan(0.02))], 1e-12)
damped.set_matrix("structural", [[0.0]])
damped.set_modal_damping([0.03])
close("a modal ratio", damped.damped_modes(1).damping_ratio, [0.03], 1e-12)
ring_load = hbvib.Model(mass=1, stiffness=1)
friction = ring_load.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
ring_load.add_force(0, 0.4)
slipping = ring_load.forced_response(1.2, harmonics=5).harmonics(0)
ring_load.set_preload(friction, 0.75, per_speed2=0.0625)
ring_load.set_speed(2.0)
close("a load of the speed", ring_load.forced_response(1.2, harmonics=5).harmonics(0), slipping, 1e-12)
waves = hbvib.Model.cyclic(1, sectors=24, mass=1)
waves.set_diameter("stiffness", 5, ring.linear_modes(1, 5).omega[0] ** 2)
close("the same by the matrix of a diameter", waves.linear_modes(1, 5).omega, ring.linear_modes(1, 5).omega, 1e-14)
halves = dict(
    mass=np.diag([0.5, 0.5, 1.0]),
    stiffness=np.array([[1.05, -1, -0.05], [-1, 1.05, -0.05], [-0.05, -0.05, 0.1]]),
    sectors=24,
    engine_order=2,
    left=[0],
    right=[1],
    frame="cylindrical",
)
faces = hbvib.Model.sector(**halves, fixed=[2], coordinates=([[1, 0, 0]], [[math.cos(HZ / 24), math.sin(HZ / 24), 0]]))
for diameter in (0, 1, 5, 12):
    own = faces.linear_modes(1, diameter)
    close("a ring from the faces of a sector", own.omega, ring.linear_modes(1, diameter).omega, 1e-13)
    lag = np.exp(-1j * HZ * diameter / 24)
    close("its shape on both faces", own.shapes[0], own.shapes[0, 0] * np.array([1, lag, 0]), 1e-13)
late = hbvib.Model.sector(**halves)
late.fix([2])
close("fixed later", late.linear_modes(1, 5).omega, faces.linear_modes(1, 5).omega, 1e-14)
for wrong, words in (
    (dict(direction=-1, coordinates=([[1, 0, 0]], [[0.9659, 0.2588, 0]])), "15.0"),
    (dict(right=[1, 2]), "left face has 1"),
    (dict(right=[0]), "in both faces"),
    (dict(fixed=[0]), "one side only"),
    (dict(left=[[0, 1]], right=[[2]]), "equal shapes"),
    (dict(frame="polar"), "polar"),
):
    try:
        hbvib.Model.sector(**{**halves, **wrong})
    except (ValueError, hbvib.Error) as error:
        check(f"the sentence says {words}", words in str(error))
    else:
        check(f"{wrong} is refused", False)

# Jenkins under a harmonic motion of amplitude a: secant stiffness and loss by integrals of the loop.
KT, LIMIT = 1.0, 0.3


def jenkins(a):
    turn = np.arccos(1 - 2 * LIMIT / (KT * a))
    return KT / np.pi * (turn - 0.5 * np.sin(2 * turn)), 4 * LIMIT * (a - LIMIT / KT)


a = 0.8
secant, loss = jenkins(a)
force = hbvib.evaluate_contact("jenkins", [0, a], kt=KT, mu=0.3, preload=1, jacobian=True)
close("describing function of friction", force.force[1], a * secant + 1j * loss / (np.pi * a), 1e-13)
step = 1e-6
moved = hbvib.evaluate_contact("jenkins", [0, a + step], kt=KT, mu=0.3, preload=1).force
less = hbvib.evaluate_contact("jenkins", [0, a - step], kt=KT, mu=0.3, preload=1).force
close("its Jacobian is the slope", force.jacobian[:, 2], ((moved - less) / (2 * step)).view(float), 1e-8)

# Nonlinear mode with one harmonic: frequency and damping follow from secant and loss.
free = hbvib.Model(mass=1, stiffness=1)
free.add_contact("jenkins", 0, kt=KT, mu=0.3, preload=1)
mode = free.nonlinear_mode((-2, 1), harmonics=1, at=np.log10([0.5, 2.0]))
slips = mode.modal_amplitude > LIMIT / KT
secant, loss = jenkins(mode.modal_amplitude[slips])
close("the backbone of a slider", mode.omega[slips], np.sqrt(1 + secant), 1e-8)
close(
    "its damping ratio",
    mode.damping_ratio[slips],
    loss / (2 * np.pi * (1 + secant) * mode.modal_amplitude[slips] ** 2),
    1e-7,
)
close("stuck, it is linear", mode.omega[~slips], np.full((~slips).sum(), math.sqrt(2)), 1e-9)
close("its parameter", mode.log10_amplitude, np.log10(mode.modal_amplitude), 1e-9)
check("its linear range ends at the slip limit", abs(mode.mode_info.linear_up_to - math.log10(LIMIT / KT)) < 1e-9)
check(
    "there was one mode to choose",
    mode.mode_info.multiple is hbvib.ModeMultiple.SINGLE and mode.mode_info.mode_index == 0,
)
best = mode.peaks()
grid = np.linspace(0.31, 2, 200001)
secant, loss = jenkins(grid)
ratio = loss / (2 * np.pi * (1 + secant) * grid**2)
close("the largest damping", [mode.mode_point(int(best.point[0])).damping_ratio], [ratio.max()], 1e-7)
for i, wanted in enumerate((0.5, 2.0)):
    point = mode.mode_point(int(mode.at(i).point[0]))
    close("wanted amplitudes", point.modal_amplitude, wanted, 1e-9)
    close("the work of a point makes its damping ratio", point.energy_damping_ratio, point.damping_ratio, 1e-7)
    close("friction loss of a point", point.friction_loss, jenkins(wanted)[1], 1e-8)

# A loop against its rectangle with slanting sides, and the works of a forced response.
where = int(mode.at(1).point[0])
loop, summary = mode.loop(where, 0, n=4096), mode.summary(where, 0)
close(
    "the area of a loop is its work",
    -np.sum(loop.force * (np.roll(loop.motion, -1) - np.roll(loop.motion, 1))) / -2,
    summary.work,
    1e-5,
)
check("the force stays below its limit", np.abs(loop.force).max() <= LIMIT * (1 + 1e-14))
close(
    "and is there where it slips",
    np.abs(loop.force[loop.state == hbvib.State.SLIP]),
    np.full((loop.state == 1).sum(), LIMIT),
    1e-12,
)
check("the share of slip", abs((loop.state == hbvib.State.SLIP).mean() - summary.slip_share) < 2 / 4096 * 2)
close("ranges of motion", [summary.motion_max, summary.half_range], [loop.motion.max(), np.ptp(loop.motion) / 2], 1e-6)
close("time history and loop tell one motion", mode.time_history(where, 0, 4096), loop.motion, 1e-12)
close("slip at a point", mode.slip(where), [summary.slip_share], 1e-12)

model = ring_damper(20.0)
branch = solve(model, harmonics=31)
for point in (0, len(branch) // 2, int(branch.peaks().point[0])):
    energy, x = branch.energy(point), branch.harmonics(point)
    close(
        "forced work is structural and friction loss",
        -np.pi * 20.0 * (x[1, 0].imag + x[1, 1].imag),
        energy.structural_loss + energy.friction_loss,
        1e-6,
    )
    close("friction loss is the work of the contact", energy.friction_loss, branch.summary(point, 0).work, 1e-9)
close(
    "the amplitude is that of the harmonics",
    [abs(branch.harmonics(i, 0, 1)[1, 0]) for i in range(len(branch))],
    branch.amplitude,
    1e-12,
)
close(
    "residual of harmonic balance at a point",
    1 + np.abs(model.forced_residual(branch.omega[3], branch.harmonics(3)).residual).max() / 20,
    1,
    1e-6,
)
check(
    "what was removed",
    branch.reduction.sectors == 24 and branch.reduction.coordinates == 1 and branch.reduction.even_removed,
)

# Time: a linear structure in closed form, friction against harmonic balance that converges to it.
linear = hbvib.Model(mass=1, stiffness=1, damping=0.02)
linear.add_force(0, 0.2 + 0.1j)
time = linear.time_response(1.1, harmonics=3, samples=64)
x = (0.2 + 0.1j) / (1 - 1.21 + 0.022j)
close("linear motion in time", time.harmonics[:, 0], [0, x, 0, 0], 1e-10)
close("its samples", time.samples[:, 0], (x * np.exp(1j * HZ * np.arange(64) / 64)).real, 1e-9)
check("a period", time.info.period == HZ / 1.1 and time.info.events == 0 and time.status == hbvib.Status.OK)
rubbing = oscillator()
rubbing.set_rayleigh(0, 0.01)
truth = rubbing.time_response(1.3, harmonics=3).harmonics
errors = []
for harmonics in (3, 9, 31):
    point = rubbing.forced_response(1.3, harmonics=harmonics)
    errors.append(abs(point.harmonics(0)[1, 0] - truth[1, 0]) / abs(truth[1, 0]))
check("harmonic balance tends to the response in time", errors[0] > errors[1] > errors[2] and errors[2] < 1e-4, errors)
checked = rubbing.verify(point, 0)
check("the check of a point finds the same solution", checked.info.same_solution and not checked.info.marched)
close("and the motion in time", checked.harmonics[1, 0], truth[1, 0], 1e-9)
close("its error is the distance of both", checked.info.response_error, errors[2], 1e-3)
close("the harmonics make up the error", np.sqrt(np.sum(checked.errors**2)), checked.info.motion_error, 1e-12)
check("the response in time is a complex number", checked.info.response == checked.harmonics[1, 0])
stability = rubbing.floquet(point, 0)
check("a slider that slips forgets", list(stability.classes) == ["ordinary", "ordinary", "memory"])
check("a motion with friction is stable", stability.radius < 1 and stability.unstable == stability.neutral == 0)
close("shooting moves the point by its error", stability.orbit_change, checked.info.motion_error, 1e-3)
check("nothing is touched", stability.reason == "" and stability.status == hbvib.Status.OK)
still = linear.floquet(linear.forced_response(1.1, harmonics=1), 0, refine=False)
close("a linear structure loses what its damping takes", np.prod(still.multipliers).real, np.exp(-0.02 * HZ / 1.1), 1e-9)
hardening = hbvib.Model(mass=1, stiffness=1, damping=0.1)
hardening.add_spring_damper(0, spring=[0, 0, 0.1])
hardening.add_force(0, 0.18)
folded = hardening.forced_response((0.9, 1.3), harmonics=15, stability="wave")
turns = folded.bifurcations()
check("two folds", list(turns.kind) == ["fold", "fold"] and list(turns.point) == list(folded.folds().point))
check("between them it is unstable", list(turns.unstable_before) == [0, 1] and list(turns.unstable_after) == [1, 0])
check("as its field says", np.array_equal(folded.floquet_radius > 1, folded.unstable_directions > 0)
      and folded.unstable_directions.max() == 1)
try:
    hardening.forced_response(1.0).floquet_radius
except hbvib.ArgumentError as e:
    check("without the option there is no such field", "stability" in str(e))
else:
    check("without the option there is no such field", False)
flutter = hbvib.Model(mass=[[1, 0], [0, 0.5]], stiffness=[[1.1, -0.1], [-0.1, 0.5]], damping=[[-0.02, 0], [0, 0.01]])
flutter.add_jenkins(0, 1, kt=0.5, mu=0.5, preload=0.2)
backbone = flutter.nonlinear_mode((-2, 2), harmonics=31)
cycles = backbone.limit_cycles()
check("one limit cycle", len(cycles.omega) == 1 and cycles.slope[0] > 0)
cycle = flutter.floquet(backbone, cycles.point[0])
close("its frequency", cycle.omega, 0.9631643411221, 1e-10)
check("its first multiplier is trivial", cycle.classes[0] == "trivial" and cycle.unstable == 0)
parameters = [hbvib.Parameter("preload"), hbvib.Parameter("force"), hbvib.Parameter("stiffness", direction=[[1]])]
derivative = rubbing.sensitivity(point, 0, parameters)
check("derivatives are an array with reasons", derivative.shape == (3,) and derivative.reasons == ("", "", ""))


def stiffened(step):
    made = rubbing.clone()
    made.set_matrix("stiffness", [[1 + step]])
    return made.forced_response(1.3, harmonics=31, tolerance=0, tol_residual=1e-12).amplitude[0]


step = 1e-4
close("that by the stiffness is a difference", derivative[2], (stiffened(step) - stiffened(-step)) / (2 * step), 1e-5)
factor = rubbing.sensitivity(point, 0, hbvib.Parameter("mass", scaling="factor"))
check("one parameter is a list of one", factor.shape == (1,) and factor[0] < 0)
try:
    rubbing.sensitivity(point, 0, [hbvib.Parameter("gap", 0)])
    check("a constant that the law does not have is refused", False)
except hbvib.UnsupportedError as error:
    check("a constant that the law does not have is refused", "gap of contact 0" in str(error))
study = rubbing.parameter_response(hbvib.Parameter("preload"), (0.3, 2), omega=1.0, follow="peak", at=[1], harmonics=9)
optima = study.optima()
check("a study has its range", study.parameter_values[0] == 0.3 and study.parameter_values[-1] == 2)
check("and an optimum", list(optima.kind) == ["minimum"] and optima.value[0] <= study.amplitude.min())
sweep = rubbing.forced_response((1, 1.5), harmonics=9)
close("a point of it is the peak of the model", study.at(0).amplitude, sweep.peaks().amplitude, 1e-8)
check("the only peak is the highest", len(study.higher_peaks().omega) == 0)
damped = rubbing.parameter_response(hbvib.Parameter("preload"), (0.5, 1), omega=1.4, follow="mode_max_damping")
close("the largest damping does not depend on the load", damped.damping_ratio, np.full(len(damped), damped.damping_ratio[0]), 1e-6)
check("nor has it a derivative by it", abs(damped.d_damping).max() < 1e-9)
chosen = rubbing.parameter_response(hbvib.Parameter("preload"), (0.3, 2), omega=1.0, follow="peak")
check("a tolerance chooses the harmonics", chosen.status == hbvib.Status.OK and chosen.error_estimate.max() < 1e-3)
started = rubbing.time_response(1.3, harmonics=3, start=point.harmonics(0), method="marching")
close("marching from a point of a branch finds the same", started.harmonics, truth, 1e-6)

# Synthesis from the mode against the response itself.
wave = ring_damper(20.0)
backbone = wave.nonlinear_mode((-6, -1), harmonics=31, response_dof=0)
foretold = backbone.synthesis_peaks(wave)
peaks = branch.peaks()
close("the mode foretells the resonance", foretold.amplitude, [peaks.amplitude.max()], 1e-4)
close("and its frequency", foretold.omega, [peaks.omega[peaks.amplitude.argmax()]], 1e-5)
curve = backbone.synthesis(wave, force_factor=0.5)
check(
    "a synthesised response is a curve of complex numbers",
    curve.response.dtype == complex and len(curve.omega) == len(curve.response) > 10,
)
check("half the force stays below the whole", np.abs(curve.response).max() < foretold.amplitude.max())

# Laws in other words: tables, polynomials, tensors and patches against the plain kinds.


def response(add):
    made = hbvib.Model(mass=1, stiffness=1, damping=0.05)
    made.add_force(0, 0.2)
    add(made)
    return made.forced_response((0.7, 2), at=[1.2], harmonics=7).at(0).amplitude


cubic = response(lambda made: made.add_contact("cubic", 0, kt=0.3, cubic=0.7))
for name, add in dict(
    spring_damper=lambda made: made.add_spring_damper(0, spring=[0.3, 0, 0.7]),
    polynomial=lambda made: made.add_polynomial([0], [0, 0], [0.3, 0.7], [[1], [3]]),
    tensors=lambda made: (made.add_springs(0, -1, 0.3), made.add_stiffness_tensors([0], cubic=[[[[0.7]]]])),
).items():
    close(f"a cubic spring as {name}", response(add), cubic, 1e-9)
stuck = response(lambda made: made.add_springs(0, hbvib.GROUND, 0.4))
for name, add in dict(
    table=lambda made: made.add_table(0, displacement=[-1, 1], force=[-0.4, 0.4]),
    jenkins=lambda made: made.add_jenkins(0, hbvib.GROUND, 0.4, 1, np.inf),
    iwan=lambda made: made.add_iwan(0, slip_force=1e9, stiffness=0.4, chi=-0.5, beta=0.1),
    damper=lambda made: (made.add_springs(0, -1, 0.4), made.add_spring_damper(0, damper=[0.0, 0.0])),
).items():
    close(f"a linear spring as {name}", response(add), stuck, 1e-9)
block = hbvib.Model(3, mass=np.eye(3), stiffness=np.eye(3), damping=0.05 * np.eye(3))
one = block.clone()
one.add_contact("friction_2d", [0, 2], kt=0.5, kn=0.5, mu=0.3, preload=0.2)
patch = block.clone()
ids = patch.add_patch(
    "friction_2d", [[0, 1, 2]] * 4, None, [0, 0, 1], 0.25, tangent=[1, 0, 0], pressure=0.2, kt=0.5, kn=0.5, mu=0.3
)
check("a patch numbers its pairs", ids == range(4) and patch.contacts == 4)
for made in (one, patch):
    made.add_force(0, 0.2)
close(
    "a patch of four is one contact of its area",
    patch.forced_response(1.1, harmonics=3).amplitude,
    one.forced_response(1.1, harmonics=3).amplitude,
    1e-9,
)

finish(64)
