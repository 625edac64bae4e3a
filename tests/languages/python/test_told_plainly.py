"""Answers that were told wrongly or not at all: unstable motions with a symmetric start, closed curves, peaks that vanish, laws that claim
to be odd, parameters that set one constant twice, resonances at rest, directions of modes that do not whirl."""

import warnings

import numpy as np

from common import check, close, finish, hbvib, raises

warnings.simplefilter("ignore", hbvib.StoppedEarly)

# A body over two wells that moves symmetrically across both where that is unstable: marching leaves it, as its multipliers say.


def swinging(stiffness):
    model = hbvib.Model(mass=1, stiffness=stiffness, damping=0.1)
    model.add_contact("cubic", 0, cubic=1.0)
    model.add_force(0, 0.3)
    return model


told = {True: 0, False: 0}
for stiffness in (-0.2, 0.5, 1.0):
    model = swinging(stiffness)
    branch = model.forced_response((1.4, 2.2), harmonics=9)
    for point in np.linspace(0, len(branch) - 1, 5).astype(int):
        radius = model.floquet(branch, point).radius
        if 0.9 < radius < 1.1:
            continue  # the motion hardly moves away
        try:
            same = model.verify(branch, point, method="marching", max_periods=300).info.same_solution
        except hbvib.NumericalError:
            same = False  # it has not come to rest, on another motion or none
        told[radius < 1] += 1
        check(f"marching from point {point} of {stiffness} agrees with the radius {radius:.3f}", same == (radius < 1), same)
        check(f"shooting finds point {point} of {stiffness}, stable or not", model.verify(branch, point).info.same_solution)
check("stable and unstable motions were marched", min(told.values()) >= 3, told)

# An isolated branch: x'' + 0.1 x' - 0.16 x'^3 + 0.08 x'^5 + x = F cos(omega t).


def isola(force):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
    model.add_spring_damper(0, damper=[0, 0, -0.16, 0, 0.08])
    model.add_force(0, force)
    return model


guess = np.array([[0], [-1.16j], [0], [0]])
for ends in ((1.0, 1.3), (0.995, 1.3), (1.0, 0.7), (0.993, 1.3)):
    closed = isola(0.034).forced_response(ends, guess=guess, harmonics=3)
    check(f"a closed curve from {ends[0]} to {ends[1]} is told", closed.status is hbvib.Status.STOPPED_CLOSED, closed.status)
    check("all of it within the range is kept", len(closed) > 5 and closed.amplitude.min() > 0.6 and min(ends) <= closed.omega.min(),
          closed.amplitude.min())
    check("and its points solve the equations", closed.residual.max() < 1e-8, closed.residual.max())
    lowest = closed.amplitude[np.argmin(closed.amplitude)]
    check("on both sides of its folds", closed.amplitude.max() > 1.05 * lowest)
check("an open one is complete", isola(0.034).forced_response((0.7, 1.3), harmonics=3).complete)

# Its merging with the main branch: the peak of that vanishes, and the sentence says where the higher one is.
force = hbvib.Parameter("force")
merged = isola(0.034).parameter_response(force, (0.5, 1.6), omega=1.0, follow="peak", harmonics=3)
check("the peak vanishes", merged.status is hbvib.Status.STOPPED_PEAK_VANISHED, merged.status)
words = merged.message.replace(",", " ").replace(":", " ").split()
numbers = {}
for key in ("amplitude", "omega"):
    place = words.index(key) if key in words else None
    check(f"the sentence has the {key} of the next peak", place is not None, merged.message)
    if place is not None:
        numbers[key] = float(next(word for word in words[place + 1:] if word[:1].isdigit()).rstrip(".;"))
if "start = " in merged.message and len(numbers) == 2:
    start = float(merged.message.split("start = ")[1].split()[0])
    further = isola(0.034).parameter_response(force, (start, 1.6), omega=numbers["omega"], follow="peak", harmonics=3)
    check("from there the peak is followed to the end", further.complete and abs(further.parameter_values[-1] - 1.6) < 1e-12,
          further.status)
    close("at the amplitude told", further.amplitude[0], numbers["amplitude"], 1e-6)
    check("which is that of the upper branch", further.amplitude[0] > 1.3 * merged.amplitude[-1])
else:
    check("the sentence says where to go on", False, merged.message)


# A law that claims to be odd and is not.
def lopsided(call):
    call.f[:], call.df_du[:, 0, 0] = 0.5 * call.u**2, call.u[:, 0]


def cubic(call):
    call.f[:], call.df_du[:, 0, 0] = 0.5 * call.u**3, 1.5 * call.u[:, 0] ** 2


def with_law(law, is_odd):
    model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
    model.add_user_force([0], law, is_odd=is_odd)
    model.add_force(0, 0.1)
    return model


for name, solve in (
    ("response", lambda m: m.forced_response((0.7, 1.2), harmonics=7)),
    ("one frequency", lambda m: m.forced_response(0.9, tolerance=1e-4)),
    ("mode", lambda m: m.nonlinear_mode((-1, 0), harmonics=7)),
    ("response over a parameter", lambda m: m.parameter_response(force, (0.5, 1.5), omega=0.9, harmonics=7)),
):
    raises(f"a law that is not odd: {name}", hbvib.Error, solve, with_law(lopsided, True), words="is_odd")
    check(f"without the claim: {name}", solve(with_law(lopsided, False)).complete)
    check(f"a law that is odd: {name}", solve(with_law(cubic, True)).complete)
batch = with_law(lopsided, True).batch((0.7, 1.2), force, [1.0], harmonics=7)
check("a law that is not odd: designs", batch.status[0] < 0 and "is_odd" in batch.reason(0), batch.reason(0))

# Two parameters of a batch that set one constant.
slider = hbvib.Model(mass=1, stiffness=1, damping=0.05)
slider.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
slider.add_force(0, 0.3)
for kind in ("mu", "preload", "kt"):
    for first, second in ((-1, -1), (0, -1), (-1, 0), (0, 0)):
        given = [hbvib.Parameter(kind, contact=first), hbvib.Parameter(kind, contact=second)]
        raises(f"{kind} of {first} and of {second}", hbvib.Error, slider.batch, (0.8, 1.5), given, [[0.3, 0.5]], harmonics=5,
               words="parameters 0 and 1")
both = [hbvib.Parameter("mu"), hbvib.Parameter("preload")]
check("two constants", slider.batch((0.8, 1.5), both, [[0.3, 1.0]], harmonics=5).status[0] == 0)
twice = [hbvib.Parameter("mass", scaling="factor"), hbvib.Parameter("mass", scaling="factor")]
one = slider.batch((0.8, 1.6), twice[:1], [[1.0]], harmonics=5).peak_amplitude
check("factors multiply", slider.batch((0.8, 1.6), twice, [[2.0, 0.5]], harmonics=5).peak_amplitude == one)

# A synthesis has no resonance at rest, and its resonances have an error.
for damping in (-0.02, 0.0, 0.02):
    for stiffness in (0.0, 1.0):
        model = hbvib.Model(mass=1, stiffness=stiffness, damping=damping)
        model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        model.add_force(0, 0.2)
        mode = model.nonlinear_mode((-2, 2), harmonics=5)
        peaks = mode.synthesis_peaks(model)
        check(f"resonances move: damping {damping}, stiffness {stiffness}", (peaks.omega > 1e-6).all(), peaks)
        check("and lie on the mode", ((peaks.omega >= 0.99 * mode.omega.min()) & (peaks.omega <= 1.01 * mode.omega.max())).all(),
              peaks.omega)

# Modes that no gyroscopic force touches have no direction.
rng = np.random.default_rng(2)
for trial in range(40):
    across, polar, stiff, axial, mass = *rng.uniform([0.2, 0.1], [0.5, 0.9]), *rng.uniform(500, 3000, 2), rng.uniform(0.5, 2)
    k, g = np.diag([stiff, stiff, axial]), np.zeros((3, 3))
    g[0, 1], g[1, 0] = polar, -polar
    rotor = hbvib.Model(mass=np.diag([across, across, mass]), stiffness=k, damping=rng.choice([0, 1e-4]) * k)
    rotor.set_matrix("gyroscopic", g)
    rotor.set_speed(rng.uniform(1, 50))
    found = rotor.damped_modes(3)
    along = int(np.argmin(abs(found.omega - np.sqrt(axial / mass))))
    others = sorted(set(range(3)) - {along}, key=lambda i: found.omega[i])
    check(f"the axial mode of rotor {trial} has no direction", found.direction[along] == 0, found.direction)
    check(f"and the others have theirs: rotor {trial}", found.direction[others].tolist() == [-1, 1], (found.omega, found.direction))

# The way to the flexibility of the contacts, and the reason, in the reduction and in the log.
Way = hbvib.FlexibilityWay


def way_of(n, dampers=0.0, full=False, kt=0.3, range=(0.5, 0.55)):
    k, m = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1), np.eye(n)
    if full:
        turned = np.linalg.qr(np.random.default_rng(n).normal(size=(n, n)))[0]
        k = turned @ k @ turned.T
        k = 0.5 * (k + k.T)
    chain = hbvib.Model(mass=m, stiffness=k, damping=1e-3 * m + np.diag(dampers * (np.arange(n) % 3)))
    chain.add_contact("jenkins", 1, kt=kt, mu=0.3, preload=1)
    chain.add_force(n - 2, 0.1)
    lines = []
    branch = chain.forced_response(range, harmonics=3, tolerance=0, max_points=4, log=lambda _, text: lines.append(text))
    told = [text for text in lines if text.startswith("flexibility of the contacts")]
    check(f"one line tells of {n} masses", len(told) == 1, lines)
    return branch, told[0]


for expected, word, given in (
        (Way.SINGLE_FREQUENCY, "single frequency", dict(n=30, range=0.5)), (Way.MODES, "all modes", dict(n=30)),
        (Way.MODES, "all modes", dict(n=300)), (Way.POLES, "all poles", dict(n=60, dampers=0.01, full=True)),
        (Way.NEAR_RIGID, "near-rigid", dict(n=30, kt=1e9)), (Way.FEW, "few", dict(n=30, dampers=0.01)),
        (Way.SPARSE, "sparse", dict(n=150, dampers=0.01)), (Way.MANY, "too many", dict(n=700))):
    branch, line = way_of(**given)
    check(f"the way with {given}", branch.reduction.flexibility_way is expected, branch.reduction.flexibility_way)
    check(f"its reason in the log with {given}", word in line, line)

finish(174)
