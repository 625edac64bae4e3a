"""The whole wheel from Python: matrices, loads and forces of each pattern; what is refused."""

import numpy as np

from common import check, close, finish, hbvib, raises

N = 6
sector = hbvib.Model.cyclic(sectors=N, engine_order=1, mass=np.diag([1.0, 2.0]), stiffness=[[1.0, -1.0], [-1.0, 5.0]],
                            coupling=dict(stiffness=np.diag([0, -2.0])), rayleigh=(0, 0.01))
sector.add_contact("jenkins", 1, kt=0.5, mu=0.3, preload=0.1)
sector.add_force(0, 0.02)
delta = 0.02 * np.cos(2.1 * np.arange(N)**2)


def mistuned(*given, **more):
    wheel = sector.wheel()
    wheel.mistune(sector, *given, **more)
    return wheel


tuned = sector.wheel()
spring = np.kron(np.diag(delta), [[1.0, -1.0], [-1.0, 1.0]])
stiffness = tuned.matrix("stiffness")
close("stiffness of a blade", mistuned("stiffness", delta, dofs=[0]).matrix("stiffness"), stiffness + spring, 1e-14)
close("a direction", mistuned("stiffness", delta, direction=[[1, -1], [-1, 1]]).matrix("stiffness"), stiffness + spring, 1e-14)
close("mass", mistuned("mass", delta, dofs=[0]).matrix("mass"), tuned.matrix("mass") + np.kron(np.diag(delta), np.diag([1, 0])), 1e-14)
close("damping", mistuned("damping", delta, dofs=[0]).matrix("damping"), 0.01 * spring, 1e-15)
for contact in (-1, 0):
    wheel = mistuned("preload", delta, contact=contact)
    close("preload", np.array([wheel.contact(s).constants["preload"] for s in range(N)]), 0.1 * (1 + delta), 1e-15)
forces = mistuned("force", delta).forces
close("force", forces.force, 0.02 * (1 + delta) * np.exp(-2j * np.pi * np.arange(N) / N), 2e-15)
raises("a kind", ValueError, lambda: mistuned("stiff", delta, dofs=[0]))
raises("a length", hbvib.Error, lambda: mistuned("force", delta[1:]))
raises("a plain model", hbvib.Error, tuned.wheel)
x = tuned.forced_response(0.9, harmonics=3, tolerance=0).harmonics(0)[1]
wave = sector.forced_response(0.9, harmonics=3, tolerance=0).harmonics(0)[1]
close("the wave", x[:2], wave, 1e-12)
finish(11)
