"""Every option of the solver, perturbed alone in every analysis: the result changes, or the call is refused by name, or the header
says that it has no effect there."""

import warnings

import numpy as np
import scipy.sparse as sparse

from common import check, finish, hbvib
from options import CHANGES, bits, hold, of_branch, outcome, refused, same

warnings.simplefilter("ignore", hbvib.StoppedEarly)


def chain(law="jenkins"):
    model = hbvib.Model(mass=np.eye(3), stiffness=2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1), rayleigh=(0, 0.02))
    if law == "jenkins":
        model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    elif law == "regularised":
        model.add_contact("regularised", 0, mu=0.3, preload=1, velocity=0.1)
    elif law == "cubic":
        model.add_contact("cubic", 0, cubic=0.5)
    elif law == "unilateral":
        model.add_contact("unilateral", 0, kn=2, gap=0.1)
    model.add_force(0, 0.3)
    return model


def large():
    """Masses in a cube, each joined to its neighbours by springs."""
    line, one = sparse.diags([-np.ones(9), 2 * np.ones(10), -np.ones(9)], [-1, 0, 1]), sparse.identity(10)
    model = hbvib.Model(1000)
    model.set_matrix("mass", sparse.identity(1000, format="csc"))
    ways = ((line, one, one), (one, line, one), (one, one, line))
    model.set_matrix("stiffness", sum(sparse.kron(sparse.kron(a, b), c) for a, b, c in ways).tocsc())
    model.set_rayleigh(0.001, 0.01)
    model.add_contact("jenkins", 3, kt=1, mu=0.3, preload=0.2)
    model.add_force(10, 0.5)
    return model


friction, cubic, sampled, stop, linear, big = chain(), chain("cubic"), chain("regularised"), chain("unilateral"), chain(""), large()
PRELOAD = hbvib.Parameter("preload")


def of_batch(batch):
    found = [batch.reason(design) for design in range(len(batch))]
    for design in range(len(batch)):
        try:
            found.append(of_branch(batch.branch(design)))
        except hbvib.Error:
            found.append("")
    return bits(batch.peak_amplitude, batch.peak_omega, batch.status, batch.points), found


SITUATIONS = {
    "response": lambda **o: of_branch(friction.forced_response((0.5, 1.5), **o)),
    "fixed": lambda **o: of_branch(friction.forced_response((0.5, 1.5), **{"harmonics": 9, **o})),
    "point": lambda **o: of_branch(friction.forced_response(0.85, **o)),
    "linear": lambda **o: of_branch(linear.forced_response((0.5, 1.5), **o)),
    "cubic": lambda **o: of_branch(cubic.forced_response((0.5, 1.0), **o)),
    "sampled": lambda **o: of_branch(sampled.forced_response((0.7, 0.9), **o)),
    "stop": lambda **o: of_branch(stop.forced_response((0.7, 0.75), **o)),
    "mode": lambda **o: of_branch(friction.nonlinear_mode((-2, 1), **o)),
    "fixed_mode": lambda **o: of_branch(friction.nonlinear_mode((-2, 1), **{"harmonics": 9, **o})),
    "parameter": lambda **o: of_branch(friction.parameter_response(PRELOAD, (0.3, 2.0), omega=0.85, **o)),
    "fixed_parameter": lambda **o: of_branch(friction.parameter_response(PRELOAD, (0.3, 2.0), omega=0.85, **{"harmonics": 9, **o})),
    "peak": lambda **o: of_branch(friction.parameter_response(PRELOAD, (0.95, 1.0), omega=0.82, follow="peak",
        **{"harmonics": 9, "max_points": 60, **o})),
    "damping": lambda **o: of_branch(friction.parameter_response(PRELOAD, (0.8, 1.2), omega=1.0, follow="mode_max_damping",
        **{"harmonics": 5, **o})),
    "batch": lambda **o: of_batch(friction.batch((0.6, 1.6), PRELOAD, [0.5, 1.0], **o)),
    "kept": lambda **o: of_batch(friction.batch((0.6, 1.6), PRELOAD, [0.5], keep=True, **o)),
}


def row(value, **claims):
    return value, claims


LINEAR = same("have no effect on its response")
ONE = same("A single frequency needs no step: the steps and max_points have no effect there.")
SMALL = same("A basis for large structures where it holds, factors otherwise.")
NOT_OF_MODES = refused("flexibility: only a forced response has a choice of it")
NO_FREEDOM = refused("freedom: only a forced response has it along its curve")
NO_STABILITY = refused("stability: only a forced response has it along its curve")
NO_ESTIMATE = refused("estimate_error with tolerance = 0")
BELOW = refused("max_harmonics = 3 is below harmonics")
MEMORY = refused("memory_limit = 1 bytes")
TOLERANCE_CHOOSES = same("with a tolerance it has no effect in forced and parameter responses")
FIXED = ("fixed", "fixed_mode", "fixed_parameter", "peak", "damping")  # situations with a number of harmonics

# Value of each option, and what it does where it does not change the result.
OPTIONS = {
    "num_threads": row(1, **dict.fromkeys(SITUATIONS, same("Reserved: must be 0 or 1."))),
    "tolerance": row(1e-5, linear=LINEAR),
    "harmonics": row(7, **{name: TOLERANCE_CHOOSES for name in SITUATIONS if name not in (*FIXED, "mode")}),
    "max_harmonics": row(3, linear=LINEAR, **dict.fromkeys(FIXED, BELOW)),
    "samples": row(256, linear=LINEAR, cubic=same("polynomials are exact in both cases"), peak=refused("samples"),
                   damping=refused("samples")),
    "step": row(0.003, linear=LINEAR, point=ONE),
    "step_min": row(0.02, linear=LINEAR, point=ONE),
    "step_max": row(0.01, point=ONE),
    "tol_residual": row(1e-5, linear=LINEAR),
    "max_newton": row(1, linear=LINEAR),
    "max_points": row(4, point=ONE),
    "response_dof": row(2),
    "keep_even_harmonics": row(1, stop=same("carry the mean and the even harmonics also where symmetry makes them zero")),
    "estimate_error": row(1, linear=LINEAR, point=same("do so only with a tolerance"), fixed_parameter=NO_ESTIMATE, peak=NO_ESTIMATE,
                          damping=NO_ESTIMATE, parameter=same("do so only with a tolerance"),
                          batch=same("the solver options estimate_error, stability and freedom have no effect")),
    "memory_limit": row(1, **{name: MEMORY for name in SITUATIONS if name not in ("batch", "kept")}),
    "flexibility": row("direct", **{**dict.fromkeys(SITUATIONS, SMALL),
                                    **dict.fromkeys(("mode", "fixed_mode", "damping"), NOT_OF_MODES)}),
    "freedom": row(1, batch=same("the solver options estimate_error, stability and freedom have no effect"),
                   **dict.fromkeys(("mode", "fixed_mode", "parameter", "fixed_parameter", "peak", "damping"), NO_FREEDOM)),
    "stability": row("wave", batch=same("the solver options estimate_error, stability and freedom have no effect"),
                     **dict.fromkeys(("mode", "fixed_mode", "parameter", "fixed_parameter", "peak", "damping"), NO_STABILITY)),
}
fields = {name for name, _ in hbvib.structs["hbvib_solver_options"]._fields_} - {"struct_size", "reserved"}
check("the table has every option of the solver, and no other", fields == set(OPTIONS), fields ^ set(OPTIONS))
references = {situation: outcome(call) for situation, call in SITUATIONS.items()}
for situation, call in SITUATIONS.items():
    for option, (value, claims) in OPTIONS.items():
        claim = claims.get(situation, CHANGES)
        given = {option: value}
        if option == "harmonics" and situation not in FIXED:
            given["tolerance"] = 1e-3  # Python takes harmonics alone as tolerance = 0
        hold(claim, f"{option} = {value} in {situation}", call, references[situation], **given)

# Ways to the flexibility of a large structure.
ways = {way: outcome(big.forced_response, omega=0.3, harmonics=3, flexibility=way) for way in ("automatic", "direct", "krylov")}
found = {way: branch.harmonics(0).tobytes() for way, branch in ways.items()}
check("a basis for large structures where it holds", found["automatic"] == found["krylov"] != found["direct"])
check("which is told", [ways[way].reduction.basis > 0 for way in ways] == [True, False, True])
basis_of_small = outcome(friction.forced_response, omega=(0.5, 1.5), flexibility="krylov")
check("a basis of a small structure", basis_of_small.reduction.basis > 0 and of_branch(basis_of_small) != references["response"])

# A value that is none is refused by name, whatever the analysis.
WRONG = {
    "num_threads": 2, "tolerance": 1.0, "harmonics": -1, "max_harmonics": -1, "samples": 3, "step": -1.0, "step_min": -1.0,
    "step_max": -1.0,
    "tol_residual": 0.0, "max_newton": 0, "max_points": 0, "response_dof": 3, "keep_even_harmonics": 2, "estimate_error": 2,
    "memory_limit": -1, "flexibility": 3, "stability": 3, "freedom": 2,
}
check("each option has a value that is none", set(WRONG) == set(OPTIONS))
for option, value in WRONG.items():
    for situation, call in SITUATIONS.items():
        hold(refused(option), f"{option} = {value} in {situation}", call, references[situation], **{option: value})
for pair in (dict(step=0.1, step_max=0.01), dict(step=0.001, step_min=0.01), dict(step_min=0.1, step_max=0.01)):
    for situation, call in SITUATIONS.items():
        hold(refused(list(pair)[0]), f"{pair} in {situation}", call, references[situation], **pair)

finish(550)
