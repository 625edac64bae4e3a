//! Sampled laws over a parameter: the error of sampling is that of responses at single values, and where it misses
//! the tolerance the status tells it.

use crate::common::{BASE, omega_range};
use crate::design::{Design, tight};
use hbvib::{
    BatchOptions, Branch, Constant, Follow, Hooks, Parameter, ParameterRange, SolverOptions, Status, batch,
    forced_response, parameter_response,
};
use std::f64::consts::TAU;

const PRELOAD: Parameter<'static> = Parameter::Contact {
    constant: Constant::Preload,
    contact: Some(0),
};

fn sampled(samples: usize) -> SolverOptions {
    SolverOptions { samples, ..tight(9) }
}

/// The curve over the normal load from 300 to 400 N.
fn curve(follow: Follow, solver: &SolverOptions) -> Branch {
    let range = ParameterRange {
        start: 300.0,
        stop: 400.0,
        at: &[350.0],
        follow,
        response: None,
    };
    let model = Design::ring_damper(&BASE, 300.0).model();
    parameter_response(&model, solver, PRELOAD, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn the_error_of_sampling_is_that_of_responses_at_single_values() {
    let omega = 208.5 * TAU;
    for samples in [64, 256] {
        let solver = sampled(samples);
        let found = curve(Follow::Omega(omega), &solver);
        let errors = found.sampling_error();
        assert_eq!(errors.len(), found.points());
        for i in [0, found.points() / 2, found.points() - 1] {
            let load = found.parameter().unwrap()[i];
            let range = omega_range(omega, omega);
            let model = Design::ring_damper(&BASE, load).model();
            let single = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
            let exact = single.sampling_error()[0];
            assert!(exact > 1e-7 && exact < 0.1, "{exact:e}");
            assert!(
                (errors[i] / exact - 1.0).abs() < 1e-6,
                "{load} N: {:e} {exact:e}",
                errors[i]
            );
        }
    }
    let exact = curve(Follow::Omega(omega), &sampled(0));
    assert!(exact.sampling_error().iter().all(|e| *e == 0.0));
}

#[test]
fn the_largest_damping_of_exact_laws_has_no_error_of_sampling() {
    let follow = Follow::ModeMaxDamping {
        omega: 209.9 * TAU,
        log10_range: None,
    };
    let found = curve(follow, &tight(3));
    assert!(found.points() > 1 && found.sampling_error().iter().all(|e| *e == 0.0));
}

#[test]
fn a_missed_tolerance_of_sampled_forces_is_told() {
    let omega = 208.5 * TAU;
    let with = |tolerance, samples| {
        let solver = SolverOptions {
            tolerance,
            ..sampled(samples)
        };
        let found = curve(Follow::Omega(omega), &solver);
        let worst = found.sampling_error().iter().fold(0.0_f64, |m, e| m.max(*e));
        (found.status(), worst / 3.0)
    };
    let (status, error) = with(1e-3, 1024);
    assert!(status == Status::Ok && error < 5e-4, "{status:?} {error:e}");
    let (status, error) = with(1e-3, 32);
    assert!(
        status == Status::StoppedMaxHarmonics && error > 5e-4,
        "{status:?} {error:e}"
    );
}

#[test]
fn branches_of_a_batch_have_the_error_of_sampling() {
    let options = BatchOptions {
        omega_start: 207.0 * TAU,
        omega_stop: 211.0 * TAU,
        keep: true,
        ..BatchOptions::default()
    };
    let found = batch(
        &Design::ring_damper(&BASE, 300.0).model(),
        &sampled(64),
        &options,
        (&[PRELOAD], &[300.0, 400.0]),
        &mut Hooks::default(),
    )
    .unwrap();
    for design in 0..2 {
        let errors = found.branch(design).unwrap().sampling_error();
        assert!(
            !errors.is_empty() && errors.iter().all(|e| e.is_finite() && *e > 0.0),
            "{errors:?}"
        );
    }
}
