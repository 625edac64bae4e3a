//! Checks of points in time that are refused, or that the caller stops.

use crate::common::models::dense;
use crate::common::{BASE, Blisk, amplitude_range, harmonics, sweep};
use hbvib::{Branch, Error, Hooks, Model, SolverOptions, Status, SteadyMethod, VerifyOptions, nonlinear_mode, verify};
use std::f64::consts::TAU;

/// Where the blisk slips.
const OMEGA: f64 = TAU * 208.85;

fn options() -> SolverOptions {
    harmonics(3)
}

fn at(model: &Model, omega: f64) -> Branch {
    sweep(model, &options(), omega, omega, &[])
}

fn refusal(model: &Model, branch: &Branch, point: usize, options: VerifyOptions) -> Error {
    verify(model, branch, point, &options, &mut Hooks::default()).unwrap_err()
}

#[test]
fn what_cannot_be_checked_is_refused_with_the_reason() {
    let model = BASE.sector();
    let defaults = VerifyOptions::default();
    let branch = at(&model, OMEGA);
    let says = |e: Error, status: Status, words: &str| {
        assert!(e.status == status && e.message().contains(words), "{e:?}");
    };
    says(refusal(&model, &branch, 1, defaults), Status::Index, "point = 1");
    for other in [
        Model::new(4).unwrap(),
        BASE.sector_without_contact(),
        Blisk {
            ring_mass: None,
            ..BASE
        }
        .sector(),
    ] {
        says(refusal(&other, &branch, 0, defaults), Status::Argument, "another one");
    }
    let mode = amplitude_range(-8.0, -7.0);
    let mode = nonlinear_mode(&model, &options(), &mode, &mut Hooks::default()).unwrap();
    says(
        refusal(&model, &mode, 0, defaults),
        Status::Unsupported,
        "no force drives it",
    );
    for (bad, status, words) in [
        (
            VerifyOptions {
                tolerance: 0.0,
                ..defaults
            },
            Status::Argument,
            "tolerance = 0",
        ),
        (
            VerifyOptions {
                max_periods: 0,
                ..defaults
            },
            Status::Argument,
            "max_periods = 0",
        ),
        (
            VerifyOptions {
                same_within: 0.0,
                ..defaults
            },
            Status::Argument,
            "same_within = 0",
        ),
        (
            VerifyOptions {
                same_within: f64::NAN,
                ..defaults
            },
            Status::NotFinite,
            "same_within",
        ),
    ] {
        says(refusal(&model, &branch, 0, bad), status, words);
    }
    let few = VerifyOptions {
        max_periods: 1,
        method: SteadyMethod::Marching,
        ..defaults
    };
    says(
        refusal(&model, &branch, 0, few),
        Status::NoConvergence,
        "max_periods = 1",
    );
}

#[test]
fn what_the_integration_does_not_know_is_refused_by_it() {
    let model = dense(&[1.0, 0.0, 0.0, 0.0], &[2.0, -1.0, -1.0, 2.0])
        .damping(&[0.1, 0.0, 0.0, 0.1])
        .slider(1, 1.0, 1.0, 0.1)
        .force(0, 1, 0.3)
        .build();
    let branch = at(&model, 1.0);
    let e = refusal(&model, &branch, 0, VerifyOptions::default());
    assert!(e.status == Status::Unsupported && e.message().contains("freedom 1 has no mass"));
}

#[test]
fn a_caller_may_stop_the_check() {
    let model = BASE.sector();
    let branch = at(&model, OMEGA);
    let mut stop = |_: &_| true;
    let mut hooks = Hooks {
        progress: Some(&mut stop),
        ..Hooks::default()
    };
    let v = verify(&model, &branch, 0, &VerifyOptions::default(), &mut hooks).unwrap();
    assert_eq!((v.status, v.periods), (Status::StoppedByCaller, 1));
    assert!(v.residual > 1e-6 && v.harmonics.len() == 16);
}
