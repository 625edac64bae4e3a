"""Both senses of a nodal diameter: crossings of a rotating wheel, its waves, flutter of one sense, and axial modes without whirl."""

import warnings

import numpy as np

from common import check, close, finish, hbvib, raises

SECTORS = 10
OWN, NEXT = np.diag([1500.0, 1900.0]), np.array([[-200.0, 250.0], [-250.0, -350.0]])
CORIOLIS = 2 * np.array([[0.0, -1.0], [1.0, 0.0]])


def wheel_frequencies(speed):
    n = 2 * SECTORS
    stiffness, gyroscopic = np.zeros((n, n)), np.kron(np.eye(SECTORS), CORIOLIS)
    for s in range(SECTORS):
        here, after = slice(2 * s, 2 * s + 2), slice((s + 1) % SECTORS * 2, (s + 1) % SECTORS * 2 + 2)
        stiffness[here, here] += OWN
        stiffness[here, after] += NEXT
        stiffness[after, here] += NEXT.T
    values = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -speed * gyroscopic]]))
    return np.sort(values.imag[values.imag > 0])


model = hbvib.Model.cyclic(2, sectors=SECTORS, engine_order=1, mass=np.eye(2), stiffness=OWN, coupling=dict(stiffness=NEXT))
model.set_matrix("gyroscopic", CORIOLIS)
speeds = np.linspace(0.2, 45, 181)
for order, known in ((9, [3.7995179098748477, 4.05780386908863]), (19, [1.710413476178725, 1.9829812203464108])):
    for given in (dict(), dict(diameter=1), dict(diameter=-1), dict(diameter=11)):
        found = model.campbell(speeds, 2, engine_orders=(order,), **given)
        close(f"engine order {order}, {given}", found.crossings.speed, known, 1e-11)
        check("crossings carry their wave", found.crossings.diameter.tolist() == [-1, -1], found.crossings)
        check("the curves are those asked for", found.diameter == {1: 1, 11: 1}.get(given.get("diameter"), -1), found.diameter)
    # The forced response resonates there.
    test = model.clone()
    test.set_wave(order)
    test.set_rayleigh(0, 2e-6)
    test.set_speed(per_omega=1 / order)
    test.add_force(0, 1.0)
    test.add_force(1, 0.5j)
    peaks = test.forced_response((order * 0.3, order * 44.0)).peaks().omega / order
    close("peaks of the response", peaks[:2], known, 1e-4)
check("another diameter meets none", model.campbell(speeds, 2, (2,), diameter=1).crossings.speed.size == 0)

model.set_speed(5.0)
all_waves = model.interference(2)
check("signed diameters", all_waves.diameters.tolist() == list(range(-4, 6)))
close("all frequencies of the wheel, each once", np.sort(all_waves.omega.ravel()), wheel_frequencies(5.0), 1e-11)
check("the senses differ", not all_waves.equal_senses)
for d, omega in zip(all_waves.diameters, all_waves.omega):
    close("a damped wave", model.damped_modes(2, diameter=int(d) - 20).omega, omega, 1e-12)
    close("an undamped wave", model.linear_modes(2, diameter=int(d) + 10).omega, omega, 1e-12)
close("the wave of the engine order", model.damped_modes(2, diameter=None).omega, all_waves.omega[5], 1e-12)
per_diameter = hbvib.Model.cyclic(2, sectors=SECTORS, engine_order=-1)
for d in range(-4, 6):
    turn = np.exp(-2j * np.pi * d / SECTORS)
    per_diameter.set_diameter("mass", d, np.eye(2))
    per_diameter.set_diameter("stiffness", d, OWN + NEXT * turn + NEXT.T * np.conj(turn))
    per_diameter.set_diameter("gyroscopic", d, CORIOLIS)
per_diameter.set_speed(5.0)
again = hbvib.Model.from_bytes(per_diameter.to_bytes())
close("matrices of signed diameters, saved", again.interference(2).omega, all_waves.omega, 1e-12)
model.set_speed(0.0)
check("at rest the senses are equal", model.interference(2).equal_senses)

flutter = hbvib.Model.cyclic(1, sectors=24, mass=1, stiffness=1, damping=0.005, coupling=dict(stiffness=-0.1))
flutter.set_aero(0, [0.01, -0.01], [1, -1])
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    found = flutter.interference(1)
check("flutter is told", len(caught) == 1 and "grow in 10 of 24 waves" in str(caught[0].message), caught)
grows = found.diameters[found.damping_ratio[:, 0] < 0]
check("ten waves of one sense", grows.size == 10 and (grows < 0).all(), grows)
matrix = np.eye(24) - 0.1 * (np.roll(np.eye(24), 1, 1) + np.roll(np.eye(24), -1, 1))
matrix -= 0.01 * np.roll(np.eye(24), 1, 1) - 0.01 * np.roll(np.eye(24), -1, 1)
values = np.linalg.eigvals(np.block([[np.zeros((24, 24)), np.eye(24)], [-matrix, -0.005 * np.eye(24)]]))
values = values[values.imag > 0]
close("the ratios of the whole wheel", np.sort(found.damping_ratio[:, 0]), np.sort(-values.real / abs(values)), 1e-11)
close("the least of them", found.damping_ratio.min(), -0.007618136725428, 1e-10)

# Modes that gyroscopic forces do not touch.
rng = np.random.default_rng(2)
wrong = []
for trial in range(40):
    jd, jp = rng.uniform(0.2, 0.5), rng.uniform(0.1, 0.9)
    lateral, axial, m = rng.uniform(500, 3000, 3)
    stiffness = np.diag([lateral, lateral, axial])
    gyroscopic = np.zeros((3, 3))
    gyroscopic[0, 1], gyroscopic[1, 0] = jp, -jp
    rotor = hbvib.Model(mass=np.diag([jd, jd, m]), stiffness=stiffness, damping=rng.choice([0, 1e-4]) * stiffness)
    rotor.set_matrix("gyroscopic", gyroscopic)
    rotor.set_speed(rng.uniform(0, 50))
    modes = rotor.damped_modes(3)
    direction = modes.direction.tolist()
    if direction.pop(int(np.argmin(abs(modes.omega - np.sqrt(axial / m))))) != 0 or direction != [-1, 1]:
        wrong.append(trial)
check("axial modes have no whirl, the others have", not wrong, wrong)
rotor = hbvib.Model(mass=np.diag([0.3, 0.3, 1.0]), stiffness=np.diag([900.0, 900.0, 2600.0]))
rotor.set_matrix("gyroscopic", [[0, 0.5, 0], [-0.5, 0, 0], [0, 0, 0]])
crossings = rotor.campbell(np.linspace(0, 120, 25), 3).crossings
close("critical speeds", crossings.speed, [np.sqrt(900 / 0.8), np.sqrt(2600)], 1e-11)
check("backward and axial", crossings.direction.tolist() == [-1, 0], crossings)

raises("a plain structure", NotImplementedError, rotor.interference, 1, words="no nodal diameters")
raises("a sense of a plain structure", ValueError, rotor.damped_modes, 1, diameter=-1, words="diameter = -1, needs 0 .. 0")
raises("half a diameter", TypeError, model.damped_modes, 1, diameter=0.5)

finish(60)
