//! One mass on a spring that rubs on the ground: limits of the friction, loads and scales.

use super::Case;
use crate::common::models::oscillator;
use crate::common::omega_range;
use hbvib::{Contact, Hooks, Model, Result, SolverOptions, Status, TimeOptions, forced_response, time_response};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// H of cases whose answer is that of every H.
pub const EVERY_H: [usize; 4] = [1, 2, 7, 31];

/// Mass, damping and stiffness of a case, without contact and force.
pub fn structure(case: &Case) -> Model {
    oscillator(case.number("m"), case.number("k"))
        .damping(&[case.number("c")])
        .build()
}

/// The same with a Jenkins contact to the ground and forces (harmonic, value).
pub fn rubbing(case: &Case, limit: f64, forces: &[(usize, f64)]) -> Model {
    let mut model = structure(case);
    model
        .add_contact(&Contact::jenkins(0, None, case.number("kt"), 1.0, limit))
        .unwrap();
    for &(harmonic, value) in forces {
        model.add_force(0, harmonic, value.into()).unwrap();
    }
    model
}

/// Harmonics 0 ..= H of all degrees of freedom from a cold start at one frequency.
pub fn answer(model: &Model, omega: f64, solver: &SolverOptions) -> Result<Vec<Complex64>> {
    let range = omega_range(omega, omega);
    let branch = forced_response(model, solver, &range, &mut Hooks::default())?;
    assert_eq!(branch.status(), Status::Ok);
    assert!(branch.residual()[0] <= solver.tol_residual);
    Ok(crate::common::all_harmonics(&branch, 0))
}

/// The same at an H.
pub fn at(model: &Model, omega: f64, harmonics: usize) -> Vec<Complex64> {
    answer(model, omega, &crate::common::harmonics(harmonics)).unwrap()
}

/// The same by default options.
pub fn by_default(model: &Model, omega: f64) -> Vec<Complex64> {
    answer(model, omega, &SolverOptions::default()).unwrap()
}

/// The motion in time: harmonics of all degrees of freedom without truncation.
pub fn in_time(model: &Model, omega: f64) -> Vec<Complex64> {
    let options = TimeOptions {
        omega,
        ..TimeOptions::default()
    };
    let found = time_response(model, &options, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok);
    found.harmonics
}

/// F/(k + kt − mω² + icω), the linear response at a contact stiffness.
fn linear(case: &Case, kt: f64) -> Complex64 {
    let (m, c, k, w) = (case.number("m"), case.number("c"), case.number("k"), case.number("w"));
    case.number("F") / Complex64::new(k + kt - m * w * w, c * w)
}

/// A case that is linear, at every H, with all harmonics but the first zero.
fn is_linear(case: &Case, limit: f64, kt: f64) {
    is_linear_model(case, &rubbing(case, limit, &[(1, case.number("F"))]), kt);
}

fn is_linear_model(case: &Case, model: &Model, kt: f64) {
    let wanted = case.wanted("absx1");
    let truth = linear(case, kt);
    case.within(
        "the stored closed form is the formula",
        None,
        truth.norm(),
        wanted,
        1e-15,
    );
    let others = |x: &[Complex64]| x.iter().enumerate().all(|(h, x)| h == 1 || *x == Complex64::ZERO);
    for h in EVERY_H {
        let x = at(model, case.number("w"), h);
        case.meets("|X_1|", h, x[1].norm(), wanted);
        case.meets("phase of X_1", h, (x[1] / truth).arg(), 0.0);
        case.holds("the other harmonics are exactly zero", others(&x));
    }
    let x = by_default(model, case.number("w"));
    case.near("|X_1|", x[1].norm(), wanted);
}

pub fn no_friction(case: &Case) {
    is_linear(case, case.number("fc"), 0.0);
    let (force, jacobian) = super::laws::evaluated(&super::laws::jenkins(case.number("kt"), 0.0), 3, 0, &[0.3; 8]);
    case.holds(
        "force and Jacobian of the law are exactly zero",
        force.iter().chain(&jacobian).all(|v| *v == 0.0),
    );
}

pub fn endless_friction(case: &Case) {
    is_linear(case, case.number("fc"), case.number("kt"));
}

pub fn no_stiffness(case: &Case) {
    // The contact is refused by the name of its constant; the answer is that of the structure alone.
    let contact = Contact::jenkins(0, None, case.number("kt"), 1.0, case.number("fc"));
    let refused = Model::new(1).unwrap().add_contact(&contact).unwrap_err();
    assert_eq!(refused.status, Status::Argument);
    assert!(refused.to_string().contains("kt = 0"), "{refused}");
    let mut model = structure(case);
    model.add_force(0, 1, case.number("F").into()).unwrap();
    is_linear_model(case, &model, 0.0);
}

pub fn force_scaling(case: &Case) {
    // The texts of F and fc are multiples of s: .2*s and .3*s.
    let multiple = |name: &str| -> f64 {
        let text = case.param(name).as_str().unwrap();
        text.strip_suffix("*s").unwrap().parse().unwrap()
    };
    let wanted = case.wanted("absx1_over_s");
    let scaled = |s: f64| rubbing(case, multiple("fc") * s, &[(1, multiple("F") * s)]);
    let w = case.number("w");
    for s in case.numbers("scales") {
        let x = at(&scaled(s), w, case.harmonics());
        case.meets(
            &format!("|X_1|/s at s = {s:e}"),
            case.harmonics(),
            x[1].norm() / s,
            wanted,
        );
    }
    let truth = in_time(&scaled(1.0), w)[1].norm();
    for s in case.numbers("scales") {
        case.near(
            &format!("|X_1|/s at s = {s:e}"),
            by_default(&scaled(s), w)[1].norm() / s,
            truth,
        );
    }
}

pub fn static_load(case: &Case) {
    let names = ["x_F05", "x_F10"];
    for (load, name) in case.numbers("F0").into_iter().zip(names) {
        let model = rubbing(case, case.number("fc"), &[(0, load)]);
        let wanted = case.wanted(name);
        // A static problem has no period: any frequency gives it.
        for omega in [1e-3, 1.25, 40.0] {
            let x = at(&model, omega, 0);
            case.meets(&format!("X_0 at F0 = {load}, omega = {omega}"), 0, x[0].re, wanted);
        }
        case.near(&format!("X_0 at F0 = {load}"), by_default(&model, 1.25)[0].re, wanted);
    }
}

pub fn mean_of_a_slider(case: &Case) {
    let load = case.number("F0");
    let slipping = rubbing(case, case.number("fc"), &[(0, load), (1, case.number("F"))]);
    let w = case.number("w");
    let x = at(&slipping, w, case.harmonics());
    case.meets("X_0 slipping", case.harmonics(), x[0].re, case.wanted("x0_HB"));
    case.meets("|X_1| slipping", case.harmonics(), x[1].norm(), case.wanted("x1_HB"));
    let x = by_default(&slipping, w);
    case.near("X_0 slipping", x[0].re, case.wanted("x0_time"));
    case.near("|X_1| slipping", x[1].norm(), case.wanted("x1_time"));
    let stuck = rubbing(case, case.number("fc"), &[(0, load), (1, case.number("second_F"))]);
    let w = case.number("second_w");
    let wanted = case.wanted("x0_stuck");
    case.meets(
        "X_0 stuck",
        case.harmonics(),
        at(&stuck, w, case.harmonics())[0].re,
        wanted,
    );
    case.near("X_0 stuck", by_default(&stuck, w)[0].re, wanted);
}

pub fn third_harmonic_alone(case: &Case) {
    let (h, w) = (case.harmonics(), case.number("w"));
    let model = rubbing(case, case.number("fc"), &[(3, case.number("F3"))]);
    let x = at(&model, w, h);
    case.meets("|X_3|", h, x[3].norm(), case.wanted("absx3"));
    case.meets(
        "|X_3|, the problem at H = 3 and 3 omega",
        h,
        x[3].norm(),
        case.wanted("ref"),
    );
    case.meets("|X_1|", h, x[1].norm(), 0.0);
    case.holds(
        "the stored |X_1| is zero but for rounding",
        case.wanted("absx1") < 1e-16,
    );
    let first = at(
        &rubbing(case, case.number("fc"), &[(1, case.number("F3"))]),
        3.0 * w,
        h / 3,
    );
    case.meets(
        "|X_3 − X_1 of the problem at 3 omega|",
        h,
        (x[3] - first[1]).norm(),
        0.0,
    );
    let others = [0, 1, 2, 4, 5, 6, 7, 8];
    case.holds(
        "harmonics that 3 does not divide are exactly zero",
        others.iter().all(|&h| x[h] == Complex64::ZERO),
    );
    case.near("|X_3|", by_default(&model, w)[3].norm(), in_time(&model, w)[3].norm());
}

pub fn quasi_static(case: &Case) {
    let model = rubbing(case, case.number("fc"), &[(1, case.number("F"))]);
    let w = case.number("w");
    let largest = |x: &[Complex64]| {
        let n = 1 << 14;
        let value = |j: usize| -> f64 {
            let turn = |h: usize| Complex64::cis(TAU * ((h * j) % n) as f64 / n as f64);
            x.iter().enumerate().map(|(h, x)| (x * turn(h)).re).sum()
        };
        (0..n).map(value).fold(f64::NEG_INFINITY, f64::max)
    };
    let x = at(&model, w, case.harmonics());
    case.meets("|X_1|", case.harmonics(), x[1].norm(), case.wanted("absx1_HB31"));
    case.meets("largest x", case.harmonics(), largest(&x), case.wanted("xmax_HB"));
    case.meets(
        "largest x, closed form",
        case.harmonics(),
        largest(&x),
        case.wanted("xmax_exact"),
    );
    case.near("largest x", largest(&by_default(&model, w)), case.wanted("xmax_exact"));
    case.tells_of_the_reference(&["ok"]);
}
