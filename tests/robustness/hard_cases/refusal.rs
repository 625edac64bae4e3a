//! An undamped resonance forced beyond what its contacts can take: no answer, and the reason.

use super::Case;
use super::one_mass::{answer, rubbing};
use hbvib::{Interrupt, SolverOptions, Status};
use std::f64::consts::PI;

pub fn beyond_capacity(case: &Case) {
    let w = case.number("w");
    let limit = case.wanted("F_limit");
    case.meets("the stored limit of the parameters", 0, case.number("F_limit"), limit);
    let forced = |force: f64| rubbing(case, case.number("fc"), &[(1, force)]);
    let model = forced(case.number("F"));
    let resonance = model.resonance(w, 1, &Interrupt::none()).unwrap().unwrap();
    case.meets("what the contact can take, 4 fc/pi", 1, resonance.slip_capacity, limit);
    case.meets("the force on the motion", 1, resonance.force, case.number("F"));
    let of = |force: f64, solver: &SolverOptions| match answer(&forced(force), w, solver) {
        Ok(x) => (Status::Ok, format!("|X_1| = {}", x[1].norm())),
        Err(e) => (e.status, e.message().to_owned()),
    };
    for h in [1, 3, 9, 31, 63] {
        let (status, sentence) = of(case.number("F"), &crate::common::harmonics(h));
        case.status(
            &format!("F = {}, H {h}: {sentence}", case.number("F")),
            status,
            Status::NoBoundedSolution,
        );
    }
    let (status, sentence) = of(case.number("F"), &SolverOptions::default());
    case.status(
        &format!("default options: {sentence}"),
        status,
        Status::NoBoundedSolution,
    );
    let reported = sentence.contains("4.000000e-1") && sentence.contains("3.819719e-1");
    case.holds("the sentence names force and capacity", reported);
    // Just above the limit nothing is made up either.
    for excess in [1e-9, 1e-6, 1e-3, 1.0, 1e6] {
        for h in [1, 9, 31] {
            let (status, _) = of(limit * (1.0 + excess), &crate::common::harmonics(h));
            let what = format!("F = {excess:e} above the limit, H {h}");
            case.status(&what, status, Status::NoBoundedSolution);
        }
    }
    // Below it the answer of one harmonic is known: the mass rests on nothing but the contact, whose harmonic |f_1|
    // at amplitude A is the force.
    for share in [0.5, 0.9, 0.99, 0.9999, 0.999_999] {
        let force = share * limit;
        let x = answer(&forced(force), w, &crate::common::harmonics(1)).unwrap();
        let carried = fundamental(case.number("kt"), case.number("fc"), x[1].norm());
        case.within(
            &format!("F = {share} of the limit, |f_1| of the found motion"),
            Some(1),
            carried,
            force,
            1e-7,
        );
        let (status, sentence) = of(force, &crate::common::harmonics(9));
        case.status(&format!("F = {share} of the limit: {sentence}"), status, Status::Ok);
    }
    // So near the limit that the amplitude follows the force 1e7 times and more, and rounding beside such a motion
    // is 1e-9 of the force: a motion that carries the force so far, and farther off the right amplitude, or none.
    for below in [1e-7, 1e-8, 1e-10, 1e-13, 0.0] {
        let force = limit * (1.0 - below);
        let found = answer(&forced(force), w, &crate::common::harmonics(1));
        let right = match &found {
            Ok(x) => {
                let carried = fundamental(case.number("kt"), case.number("fc"), x[1].norm());
                let near = (x[1].norm() / amplitude(case, force) - 1.0).abs() < 1e-3;
                below > 0.0 && (carried / force - 1.0).abs() < 1e-9 && (near || below < 1e-7)
            }
            Err(e) => e.status == Status::NoConvergence,
        };
        let reported = found.map(|x| x[1].norm()).map_err(|e| e.status);
        case.holds(&format!("F = {below:e} below the limit: {reported:?}"), right);
    }
}

/// The amplitude at which the contact carries a force: |f_1| rises with it up to 4 fc/π.
fn amplitude(case: &Case, force: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1e12);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let carried = fundamental(case.number("kt"), case.number("fc"), middle);
        *(if carried < force { &mut low } else { &mut high }) = middle;
    }
    low
}

/// |f_1| of a Jenkins contact on x = A cos t: sticks for the angle θ from each turning point, cos θ = 1 − 2δ/A.
fn fundamental(kt: f64, limit: f64, amplitude: f64) -> f64 {
    let delta = limit / kt;
    if amplitude <= delta {
        return kt * amplitude;
    }
    let theta = (1.0 - 2.0 * delta / amplitude).acos();
    let in_phase = kt * amplitude / PI * (theta - 0.5 * (2.0 * theta).sin());
    let out_of_phase = 4.0 * limit / PI * (1.0 - delta / amplitude);
    in_phase.hypot(out_of_phase)
}
