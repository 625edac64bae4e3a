//! The nonlinear mode of the blisk where its damping is highest.

use super::Case;
use super::blisk::{plain, unforced};
use crate::common::{amplitude_range, harmonics};
use hbvib::{Hooks, ModeOptions, ModePoint, SolverOptions, Status, nonlinear_mode};
use std::f64::consts::TAU;

/// Frequency in Hz and numbers of the mode at the case's amplitude.
fn at_amplitude(case: &Case, solver: &SolverOptions) -> (f64, ModePoint) {
    let wanted = [case.number("log10_a")];
    let range = ModeOptions {
        at: &wanted,
        ..amplitude_range(wanted[0] - 1.5, wanted[0] + 0.5)
    };
    let model = unforced(case, plain(case));
    let branch = nonlinear_mode(&model, solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    let [found] = branch.at(0) else {
        panic!("{} solutions at the amplitude", branch.at(0).len());
    };
    (found.omega / TAU, branch.mode_at(found.point).unwrap())
}

pub fn peak_damping(case: &Case) {
    assert_eq!(case.number("C").to_bits(), 0);
    assert_eq!(case.param("forcing").as_str(), Some("none"));
    for h in case.numbers("H") {
        let (f, point) = at_amplitude(case, &harmonics(h as usize));
        let wanted = |name: &str| crate::common::number(case.reference(&[name, &format!("H{h}")]));
        case.meets("damping ratio", h as usize, point.damping_ratio, wanted("zeta"));
        case.meets("frequency", h as usize, f, wanted("f_Hz"));
        case.within(
            "damping ratio from the losses",
            Some(h as usize),
            point.energy_damping_ratio(),
            point.damping_ratio,
            1e-9,
        );
    }
    // The truth of a mode is that of many harmonics.
    let (truth, default) = (
        at_amplitude(case, &harmonics(127)),
        at_amplitude(case, &SolverOptions::default()),
    );
    case.near(
        "damping ratio, the truth by H = 127",
        default.1.damping_ratio,
        truth.1.damping_ratio,
    );
    case.near("frequency, the truth by H = 127", default.0, truth.0);
}
