//! The error estimate of motions about equilibria of structures that are unstable by themselves: a mass in one of two wells. The
//! force is the same wherever its negative stiffness stands, in the structure or in the law, so that a stable structure with the
//! rest of it in the law has the truth.

use crate::common::models::oscillator;
use crate::common::{all_harmonics, harmonics, omega_range};
use hbvib::{
    Branch, Contact, ContactKind, ForcedOptions, Hooks, Model, Polynomial, SolverOptions, Status, forced_response,
};
use num_complex::Complex64;

const OMEGA: f64 = 0.8;

/// x'' + 0.2 x' − x + x³ = 0.1 cos ωt + mean, with the stiffness k of the structure and −1 − k of the law.
fn well(k: f64, mean: f64) -> Model {
    let law = if k <= -1.0 {
        Contact::cubic(0, None, 0.0, 1.0)
    } else {
        let law = Polynomial::scalar(&[-1.0 - k, 0.0, 1.0], &[]).unwrap();
        Contact::between(0, None, ContactKind::Polynomial(law))
    };
    let mut model = oscillator(1.0, k)
        .damping(&[0.2])
        .contact(&law)
        .force(0, 1, 0.1)
        .build();
    if mean != 0.0 {
        model.add_force(0, 0, mean.into()).unwrap();
    }
    model
}

/// The response at one frequency, or in a sweep from it, in the well on a side.
fn solve(model: &Model, options: &SolverOptions, side: f64, until: f64) -> Branch {
    let guess = [side, 0.05].map(Complex64::from);
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(OMEGA, until)
    };
    forced_response(model, options, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn an_estimate_in_a_well_is_near_the_true_error_wherever_its_stiffness_stands() {
    for mean in [0.0, 0.05] {
        for side in [1.0, -1.0] {
            let truth = all_harmonics(&solve(&well(1.0, mean), &harmonics(31), side, OMEGA), 0)[1];
            for k in [-1.0, -0.5, -1e-3, 1e-9] {
                let model = well(k, mean);
                for highest in [1, 2, 3, 7, 15, 31, 63] {
                    let options = SolverOptions {
                        estimate_error: true,
                        ..harmonics(highest)
                    };
                    let branch = solve(&model, &options, side, OMEGA);
                    let error = (all_harmonics(&branch, 0)[1] - truth).norm() / truth.norm();
                    let told = branch.error_estimate_at(0).unwrap();
                    let claim = format!("k = {k}, mean {mean}, side {side}, H = {highest}: {told:e} for {error:e}");
                    assert!((told - error).abs() <= 0.3 * error + 1e-12, "{claim}");
                }
            }
        }
    }
}

#[test]
fn a_tolerance_is_met_in_a_well_with_few_harmonics() {
    for k in [-1.0, -0.5, 1e-9] {
        let model = well(k, 0.0);
        for (tolerance, until) in [(1e-3, OMEGA), (1e-5, OMEGA), (1e-5, 1.2)] {
            let options = SolverOptions {
                tolerance,
                ..SolverOptions::default()
            };
            let branch = solve(&model, &options, 1.0, until);
            assert_eq!(branch.status(), Status::Ok, "{k}, {tolerance}, until {until}");
            assert!(branch.error_estimate().iter().all(|error| *error <= tolerance));
            let most = branch.harmonics_used().iter().fold(0.0_f64, |most, h| most.max(*h));
            assert!(most <= 15.0, "{k}, {tolerance}: H = {most}");
        }
    }
}
