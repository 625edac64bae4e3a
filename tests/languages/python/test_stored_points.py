"""Every stored point has its fields: peaks, folds and requested solutions beside the curve, of a branch in memory, in a file and in a
pickle; loops and summaries of contacts of loaded branches are those of the branch."""

import os
import pickle
import tempfile
import warnings

import numpy as np

from common import check, close, finish, hbvib, oscillator, raises, ring_damper, solve


warnings.simplefilter("ignore", hbvib.StoppedEarly)


def signal(x, n):
    """The motion of one degree of freedom at n times of a period, from its harmonics."""
    tau = 2 * np.pi * np.arange(n) / n
    return (x[:, None] * np.exp(1j * np.arange(len(x))[:, None] * tau)).sum(0).real


# A small trap of a first week: numbers of points beyond the fields of the curve.
model = hbvib.Model(mass=1, stiffness=1, damping=0.05)
model.add_contact("unilateral", 0, kn=20, gap=0.5)
model.add_force(0, 0.2)
branch = model.forced_response((0.6, 1.8), at=[1.2])
peak, wanted = (branch.point(points.point[0]) for points in (branch.peaks(), branch.at(0)))
check("they lie beside the curve", not peak.on_curve and not wanted.on_curve and len(branch) <= wanted.number < branch.stored)
check("a peak has the frequency of the list", peak.omega == branch.peaks().omega[0])
check("and its amplitude", peak.amplitude == branch.peaks().amplitude[0] == peak.field("amplitude"))
check("a requested solution has its frequency", wanted.omega == branch.at(0).omega[0] == 1.2)
check("and its amplitude", wanted.amplitude == branch.at(0).amplitude[0])
for name, at in (("peak", peak), ("requested solution", wanted)):
    close(f"amplitude of the {name} is that of its motion", at.amplitude, abs(at.harmonics[1, 0]), 1e-12)
    close(f"the motion of the {name} is its harmonics", at.time_history(0, 64), signal(at.harmonics[:, 0], 64), 1e-12)
    x, omega = at.harmonics, at.omega
    x = x[: np.flatnonzero(x[:, 0])[-1] + 1]  # those that this point carries
    residual = model.forced_residual(omega, x).residual  # of the equations at this very frequency
    check(f"it solves the equations at its frequency: {name}", abs(residual).max() < 1e-7, abs(residual).max())
    # In a steady motion all work of the force goes into the damper.
    loss = np.pi * omega * 0.05 * (np.arange(len(x)) ** 2 * abs(x[:, 0]) ** 2).sum()
    close(f"the loss of the {name} is that of the damper", at.energy.structural_loss, loss, 1e-12)
    work = np.pi * 0.2 * -x[1, 0].imag
    close(f"which is the work of the force: {name}", loss, work, 1e-3)
    check(f"the stop of the {name} does not slip", at.slip.tolist() == [0.0] and at.field("slip_fraction").tolist() == [0.0])
motion = signal(peak.harmonics[:, 0], 4096)
check("the amplitude is that of the fundamental, not the largest excursion", abs(motion).max() > 1.005 * peak.amplitude)
first = branch.point(0)
check("a point of the curve has all of its fields", first.on_curve and first.omega == branch.omega[0] and all(
    np.array_equal(first.field(name), branch.field(name)[0])
    for name in ("omega", "amplitude", "residual", "newton_iterations", "harmonics_used", "error_estimate", "slip_fraction")))
check("numbers of numpy are numbers", branch.point(np.int64(3)).number == 3 and repr(first).startswith("<hbvib.StoredPoint 0: omega 0.6"))
raises("a point that is not there", IndexError, branch.point, branch.stored, words=f"0 .. {branch.stored - 1}")
raises("a negative one", IndexError, branch.point, -1)
raises("no number", TypeError, branch.point, 0.5, words="point = 0.5")
raises("a field that the branch does not have", ValueError, peak.field, "damping_ratio")
check("a peak has the residual of its solution", 0 <= peak.field("residual") < 1e-9, peak.field("residual"))
loaded = pickle.loads(pickle.dumps(branch)).point(peak.number)
raises("that a loaded branch has of the curve alone", NotImplementedError, loaded.field, "newton_iterations",
       words="newton_iterations")
raises("a forced response is no mode", NotImplementedError, lambda: peak.mode)

# Modes, folds and parameters.
mode = oscillator().nonlinear_mode((-2, 1), at=[-1.0, 0.3])
for points, name in ((mode.peaks(), "largest damping"), (mode.at(0), "stuck"), (mode.at(1), "slipping")):
    at = mode.point(points.point[0])
    told = mode.mode_point(at.number)
    check(f"the point of {name} has its frequency", at.omega == told.omega == points.omega[0])
    check(f"and the fields of a mode: {name}", (at.field("damping_ratio"), at.field("log10_amplitude"), at.field("energy")) == (
        told.damping_ratio, told.log10_amplitude, told.energy))
    close(f"and the amplitude of its motion: {name}", at.amplitude, abs(at.harmonics[1, 0]), 1e-12)
check("a requested amplitude is that", abs(mode.point(mode.at(1).point[0]).field("log10_amplitude") - 0.3) < 1e-12)
duffing = hbvib.Model(mass=1, stiffness=1, damping=0.05)
duffing.add_contact("cubic", 0, cubic=0.5)
duffing.add_force(0, 0.2)
folded = duffing.forced_response((0.6, 2.2), at=[1.3], harmonics=7)
check("it is folded", len(folded.folds().point) == 2 and len(folded.at(0).point) == 3)
check("all solutions at a frequency have it", (folded.at(0).omega == 1.3).all())
for number, omega in zip(folded.folds().point, folded.folds().omega):
    check("a fold has its frequency", folded.point(number).omega == omega)
held = duffing.parameter_response(hbvib.Parameter("force"), (0.5, 2), omega=1.0, at=[1.0], harmonics=7)
check("a frequency that is held is told", held.at(0).omega.tolist() == [1.0] and held.point(held.at(0).point[0]).omega == 1.0)
check("and the value of the parameter", held.point(held.at(0).point[0]).field("parameter_value") == 1.0)
close("the solution is that of the model", held.at(0).amplitude, duffing.forced_response(1.0, harmonics=7).amplitude, 1e-9)
mild = hbvib.Model(mass=1, stiffness=1, damping=0.1)
mild.add_contact("cubic", 0, cubic=0.01)
mild.add_force(0, 0.1)
moving = mild.parameter_response(hbvib.Parameter("force"), (0.5, 1.2), omega=1.0, follow="peak", at=[1.0], harmonics=7)
wanted, at = moving.at(0), moving.point(moving.at(0).point[0])
slope = np.interp(1.0, moving.parameter_values, moving.d_amplitude)
check("one that moves has its frequency", moving.omega.min() <= wanted.omega[0] <= moving.omega.max(), wanted.omega)
check("by its number, too, with the parameter", (at.omega, at.field("parameter_value")) == (wanted.omega[0], 1.0))
check("and its derivative by the parameter", abs(at.field("d_amplitude") / slope - 1) < 1e-2, at.field("d_amplitude"))

# Loaded branches compute loops and summaries again, for every law, on curve and beside it.
space = hbvib.Model(mass=np.eye(3), stiffness=np.diag([1.0, 1.2, 2.0]), rayleigh=(0.02, 0.02))
space.add_contact("friction_3d", [0, 1, 2], kt=1, kn=2, mu=0.3, preload=0.5)
space.add_table(0, displacement=[-1, 0, 1], force=[-1, 0, 0.5])
space.add_contact("regularised", 1, mu=0.2, preload=0.5, velocity=0.1)
for dof, force in enumerate((0.3, 0.2j, 0.3)):
    space.add_force(dof, force)
undamped = hbvib.Model(mass=np.eye(3), stiffness=np.diag([1.0, 1.2, 2.0]))
undamped.add_contact("friction_3d", [0, 1, 2], kt=1, kn=2, mu=0.3, preload=0.5)
wheel = ring_damper()
wheel.add_contact("jenkins", 2, 2, kt=2e7, mu=0.3, preload=10, sector_offset=1)
cases = dict(
    stop=(branch, model), fold=(folded, duffing), wheel=(solve(wheel, at=[1310.0]), wheel),
    space=(space.forced_response((0.8, 1.2)), space),
    mode=(mode, oscillator()), undamped=(undamped.nonlinear_mode((-1, 0.5)), undamped),
    wave=(wheel.nonlinear_mode((-6, -3)), wheel), sampled=(oscillator().forced_response((0.8, 1.6), samples=128), oscillator()))
for name, (solved, of) in cases.items():
    of.clear_forces()  # that the model has changed since must not show
    back = pickle.loads(pickle.dumps(solved))
    numbers = sorted({0, len(solved) // 3, 2 * len(solved) // 3, len(solved) - 1, *range(len(solved), solved.stored)})
    worst = 0.0
    for number in numbers:
        check(f"{name}: a point has its frequency", back.point(number).omega == solved.point(number).omega)
        check(f"{name}: and its energies", back.point(number).energy == solved.point(number).energy)
        for contact in range(solved.reduction.contacts):
            summary, again = solved.summary(number, contact), back.summary(number, contact)
            for key in ("work", "slip_share", "open_share", "half_range", "load_max"):
                a, b = getattr(summary, key), getattr(again, key)
                scale = abs(a) + solved.energy(number).kinetic_mean * (key == "work") + (key.endswith("share"))
                worst = max(worst, abs(a - b) / scale if a != b else 0.0)
            directions = range(summary.directions)
            ours, theirs = (np.array([b.loop(number, contact, d, 64)[:2] for d in directions]) for b in (solved, back))
            for a, b in zip(ours.swapaxes(0, 1), theirs.swapaxes(0, 1)):  # motions in all directions, then forces
                worst = max(worst, abs(a - b).max() / max(abs(a).max(), 1e-300))
    allowed = 4 / 128 if name == "sampled" else 1e-8  # shares of slip are multiples of the samples
    check(f"{name}: loops and summaries are those of the branch", worst < allowed, worst)
stiff = hbvib.Model(mass=1, stiffness=1, rayleigh=(0.02, 0))
stiff.add_contact("jenkins", 0, kt=1e6, mu=0.3, preload=1)
stiff.add_force(0, 0.5)
slides = stiff.forced_response(1.1)
check("a near-rigid slider has a loop in memory", np.ptp(slides.loop(0, 0).motion) > 0.1 and slides.slip(0)[0] > 0.1)
raises("not of a saved branch, whose motion is cut off", NotImplementedError, pickle.loads(pickle.dumps(slides)).loop, 0, 0,
       words="use the branch in memory")
twice = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(branch))))
check("also when it was pickled twice", np.allclose(twice.loop(0, 0).force, branch.loop(0, 0).force, atol=1e-12))

with tempfile.TemporaryDirectory() as folder:
    name = os.path.join(folder, "branch.npz")
    branch.save(name)
    close("of a file, too", hbvib.load(name).loop(peak.number, 0).force, branch.loop(peak.number, 0).force, 1e-10)
    check("and requested frequencies", hbvib.load(name).at(0).omega.tolist() == branch.at(0).omega.tolist())
    branch.save(name, harmonics=False)
    raises("not without harmonics", NotImplementedError, hbvib.load(name).loop, 0, 0, words="no harmonics")
own = hbvib.Model(mass=1, stiffness=1, damping=0.1)


def cubic(call):
    call.f[:] = 0.5 * call.u**3
    call.df_du[:, 0, 0] = 1.5 * call.u[:, 0] ** 2


own.add_user_force([0], cubic, is_odd=True)
own.add_force(0, 0.2)
back = pickle.loads(pickle.dumps(own.forced_response((0.8, 1.2), harmonics=5)))
raises("a force of the caller cannot be saved", NotImplementedError, back.loop, 0, 0, words="force of the caller")
back = pickle.loads(pickle.dumps(held))
raises("points over a parameter have models of their own", NotImplementedError, back.loop, 0, 0, words="a model of its own")
check("their optima are saved", back.optima().kind.tolist() == held.optima().kind.tolist())
check("their turns are saved", back.turns().kind.tolist() == held.turns().kind.tolist())

# A file whose model is another one is not believed.
broken = pickle.loads(pickle.dumps(mode))
other = oscillator()
other.set_preload(0, 2.0)
broken._arrays["model"] = np.frombuffer(other.to_bytes(), np.uint8)
raises("contacts of another model", NotImplementedError, broken.loop, len(mode) - 1, 0, words="do not slip")

finish(165)
