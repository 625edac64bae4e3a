//! Python: the example of each class of options and results, which tests run.

use crate::declarations::Result;

/// A mass on a spring.
const MODEL: &str = ">>> import hbvib
>>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
";

/// With a friction contact and a force.
const CONTACT: &str = r#">>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
>>> model.add_force(0, 0.2)
"#;

const BRANCH: &str = ">>> branch = model.forced_response((0.8, 1.6))\n";

const PEAK: &str = ">>> peak = branch.peaks().point[0]\n";

const MODE: &str = ">>> mode = model.nonlinear_mode((-2, 1))\n";

/// Classes, the parts that come before, and the lines of the example itself.
const EXAMPLES: [(&str, &[&str], &str); 18] = [
    (
        "SolverOptions",
        &[MODEL, CONTACT],
        ">>> options: hbvib.SolverOptions = dict(harmonics=5, tolerance=0)
>>> model.forced_response((0.8, 1.6), **options).harmonics(0).shape
(6, 1)
",
    ),
    (
        "TimeOptions",
        &[MODEL, CONTACT],
        ">>> options: hbvib.TimeOptions = dict(max_periods=100)
>>> model.time_response(1.0, **options).info.periods < 100
True
",
    ),
    (
        "VerifyOptions",
        &[MODEL, CONTACT, BRANCH, PEAK],
        ">>> options: hbvib.VerifyOptions = dict(max_periods=100)
>>> model.verify(branch, peak, **options).info.same_solution
True
",
    ),
    (
        "FloquetOptions",
        &[MODEL, CONTACT, BRANCH, PEAK],
        ">>> options: hbvib.FloquetOptions = dict(tolerance=1e-9)
>>> model.floquet(branch, peak, **options).unstable
0
",
    ),
    (
        "SynthesisOptions",
        &[MODEL, CONTACT, MODE],
        ">>> options: hbvib.SynthesisOptions = dict(force_factor=1.5)
>>> len(mode.synthesis_peaks(model, **options).omega)
1
",
    ),
    (
        "ContactConstants",
        &[MODEL],
        r#">>> constants: hbvib.ContactConstants = dict(kt=1, mu=0.3, preload=1)
>>> model.add_contact("jenkins", 0, **constants)
0
"#,
    ),
    (
        "Energy",
        &[MODEL, CONTACT, BRANCH, PEAK],
        ">>> branch.energy(peak).friction_loss > 0
True
",
    ),
    (
        "ContactSummary",
        &[MODEL, CONTACT, BRANCH, PEAK],
        ">>> branch.summary(peak, contact).slip_share > 0
True
",
    ),
    (
        "ModePoint",
        &[MODEL, CONTACT, MODE],
        ">>> mode.mode_point(0).damping_ratio > 0
True
",
    ),
    (
        "ModeInfo",
        &[MODEL, CONTACT, MODE],
        r#">>> print("%.4f" % mode.mode_info.omega)  # the slider sticks
1.4142
"#,
    ),
    (
        "Reduction",
        &[MODEL, CONTACT, BRANCH],
        ">>> branch.reduction.contacts
1
",
    ),
    (
        "Descent",
        &[MODEL, CONTACT, BRANCH],
        ">>> branch.descent.bifurcation, branch.descent.periods  # asked for
(-1, 1)
",
    ),
    (
        "Searched",
        &[MODEL, CONTACT],
        ">>> model.forced_response((0.8, 1.6), harmonics=3, branches=1).searched.bifurcations
0
",
    ),
    (
        "Kick",
        &[],
        ">>> import hbvib
>>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
>>> contact = model.add_spring_damper(0, spring=[0, 0, 0.1])
>>> model.add_force(0, 0.18)
>>> branch = model.forced_response((0.9, 1.3), at=[1.1017664364])
>>> upper, saddle, lower = branch.at(0).point
>>> model.smallest_kick(branch, int(lower), int(saddle), dof=0, phases=4).verified
True
",
    ),
    (
        "BestLoad",
        &[MODEL, CONTACT],
        ">>> best = model.best_load_for_life(0, 0.02, cycles=5, peak=(0.8, 1.6), stiffness=1, harmonics=3)
>>> abs(best.amplitude_new / best.amplitude_worn - 1) < 1e-5
True
",
    ),
    (
        "JacobianGap",
        &[],
        ">>> import hbvib
>>> def damper(call: hbvib.ForceCall) -> None:
...     call.f[:] = 0.1 * call.v
...     call.df_dv[:, 0, 0] = 0.1
>>> model = hbvib.Model(mass=1, stiffness=1)
>>> number = model.add_user_force([0], damper, uses_velocity=True, is_odd=True)
>>> model.check_jacobian(number, omega=1, amplitude=0.3).gap < 1e-6
True
",
    ),
    (
        "TimeInfo",
        &[MODEL, CONTACT],
        ">>> model.time_response(1.0).info.residual < 1e-9
True
",
    ),
    (
        "VerificationInfo",
        &[MODEL, CONTACT, BRANCH, PEAK],
        ">>> model.verify(branch, peak).info.response_error < 1e-3
True
",
    ),
];

/// The example of a class, indented as its explanation is.
pub fn example(class: &str) -> Result<String> {
    let (_, before, own) = EXAMPLES
        .iter()
        .find(|(name, ..)| *name == class)
        .ok_or_else(|| format!("no example of {class}"))?;
    let mut text = String::new();
    for line in before.iter().chain([own]).flat_map(|part| part.lines()) {
        text += "    ";
        text += line;
        text.push('\n');
    }
    Ok(text)
}
