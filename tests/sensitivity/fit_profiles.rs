//! Profiles of the likelihood against fits with a held unknown and against the covariance, and fits that are stopped early.

use crate::fit_of_responses::{Measured, PARAMETERS, chain, from_start, nine_harmonics, reference};
use hbvib::{
    Constant, FitData, FitOptions, FitProfile, Hooks, Loss, Parameter, Profiled, Progress, Status, Unknown, fit,
    fit_profile,
};
use std::cell::Cell;

fn profiled(
    (parameters, unknowns): (&[Parameter<'_>], &[Unknown]),
    data: &[FitData<'_>],
    options: &FitOptions,
    of: &Profiled<'_>,
) -> hbvib::Result<FitProfile> {
    let solver = nine_harmonics();
    fit_profile(
        &chain(),
        (parameters, unknowns),
        data,
        (&solver, options),
        of,
        &mut Hooks::default(),
    )
}

fn fitted(unknowns: &[Unknown], data: &[FitData<'_>], options: &FitOptions) -> hbvib::Fit {
    let given = (&PARAMETERS[..unknowns.len()], unknowns);
    fit(&chain(), given, data, &nine_harmonics(), options, &mut Hooks::default()).unwrap()
}

#[test]
fn each_value_is_a_fit_with_that_unknown_held() {
    let (sets, chi2) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let mut unknowns = from_start([0.3, 0.15, 1.0, 1.0]);
    unknowns[1].prior = Some((0.149, 0.002));
    for options in [
        FitOptions::default(),
        FitOptions {
            loss: Loss::Huber(1.345),
            scale_covariance: true,
            ..FitOptions::default()
        },
    ] {
        let found = fitted(&unknowns, &data, &options);
        let (mu, sd) = (found.theta[1], found.covariance[5].sqrt());
        let values = [mu - 2.5 * sd, mu - sd, mu, mu + 2.0 * sd, mu + 2.5 * sd];
        let of = Profiled {
            theta: &found.theta,
            number: 1,
            values: &values,
        };
        let profile = profiled((&PARAMETERS, &unknowns), &data, &options, &of).unwrap();
        assert_eq!(profile.status, Status::Ok);
        assert!((profile.best / found.loss - 1.0).abs() < 1e-12 && profile.best > 0.9 * chi2);
        for (i, value) in values.into_iter().enumerate() {
            let mut held = unknowns;
            held[1] = Unknown {
                start: Some(value),
                lower: Some(value),
                upper: Some(value),
                ..Unknown::default()
            };
            let other = fitted(&held, &data, &options);
            let wanted = other.loss + ((value - 0.149) / 0.002_f64).powi(2);
            assert!(
                (profile.loss[i] / wanted - 1.0).abs() < 1e-9,
                "{i}: {} {wanted}",
                profile.loss[i]
            );
            for k in 0..4 {
                let off = (profile.theta[4 * i + k] - other.theta[k]).abs();
                assert!(off <= 1e-4 * found.covariance[5 * k].sqrt(), "{i} {k}: {off}");
            }
        }
        let degrees = found.degrees_of_freedom as f64;
        let unit = if options.scale_covariance {
            found.chi2 / degrees
        } else {
            1.0
        };
        assert!((profile.unit / unit - 1.0).abs() < 1e-12);
        // So well known a parameter has the interval of the covariance; the loss of outliers that Huber's has is narrower.
        let (low, high) = profile.interval(1.0);
        let width = (high - low) / (2.0 * sd);
        assert!((width - 1.0).abs() < 0.1, "{width}");
    }
}

/// Two springs in parallel, the second half of the first: the profile of either is that of their sum.
#[test]
fn what_is_tied_goes_with_the_scanned_one() {
    let (sets, _) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let tied = [
        Parameter::Contact {
            constant: Constant::Mu,
            contact: Some(0),
        },
        Parameter::Factor {
            which: hbvib::MatrixKind::Stiffness,
        },
        Parameter::Factor {
            which: hbvib::MatrixKind::Mass,
        },
    ];
    // Stiffness and mass by one factor: the second follows the first.
    let unknowns = [
        Unknown {
            start: Some(0.15),
            ..Unknown::default()
        },
        Unknown::default(),
        Unknown {
            tied_to: Some(1),
            ..Unknown::default()
        },
    ];
    let options = FitOptions::default();
    let found = fit(
        &chain(),
        (&tied, &unknowns),
        &data,
        &nine_harmonics(),
        &options,
        &mut Hooks::default(),
    )
    .unwrap();
    let (value, sd) = (found.theta[1], found.covariance[4].sqrt());
    let values = [value - 2.0 * sd, value + 2.0 * sd];
    let scan = |number| {
        let of = Profiled {
            theta: &found.theta,
            number,
            values: &values,
        };
        profiled((&tied, &unknowns), &data, &options, &of).unwrap()
    };
    let (leader, follower) = (scan(1), scan(2));
    for i in 0..2 {
        assert!((leader.loss[i] / follower.loss[i] - 1.0).abs() < 1e-9);
        assert!(
            leader.loss[i] > leader.best + 3.5 && leader.loss[i] < leader.best + 4.5,
            "{leader:?}"
        );
        assert!((leader.theta[3 * i + 2] - leader.theta[3 * i + 1]).abs() < 1e-12);
    }
    // With one unknown left in all, nothing is free at a value.
    let alone = from_start([0.3; 4]);
    let of = Profiled {
        theta: &[0.3],
        number: 0,
        values: &[0.29, 0.31],
    };
    let profile = profiled((&PARAMETERS[..1], &alone[..1]), &data, &options, &of).unwrap();
    assert!(profile.loss.iter().all(|loss| loss.is_finite()) && profile.theta == [0.29, 0.31]);
}

#[test]
fn a_scan_that_makes_no_sense_is_refused_by_name() {
    let (sets, _) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let unknowns = from_start([0.3, 0.15, 1.0, 1.0]);
    let theta = [0.3, 0.15, 1.0, 1.0];
    let refused = |theta: &[f64], number, values: &[f64], words: &str| {
        let of = Profiled { theta, number, values };
        let e = profiled((&PARAMETERS, &unknowns), &data, &FitOptions::default(), &of)
            .err()
            .unwrap();
        assert!(e.to_string().contains(words), "{e}, not {words}");
    };
    refused(&theta[..3], 0, &[1.0], "theta has 3 numbers, needs 4");
    refused(&theta, 4, &[1.0], "number = 4, needs 0 .. 3");
    refused(&theta, 0, &[], "values is empty");
    refused(&theta, 0, &[0.3, 0.2], "values[1] = 0.2 after 0.3");
    refused(&theta, 0, &[f64::NAN], "values[0] = NaN");
    refused(&theta, 0, &[-1.0], "values[0] = -1");
}

/// The interval by hand: roots of the loss are lines between the values.
#[test]
fn an_interval_ends_where_the_root_of_the_loss_does() {
    let profile = FitProfile {
        status: Status::Ok,
        values: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        loss: vec![9.0, 1.0, 0.0, 1.0, f64::NAN],
        theta: Vec::new(),
        best: 0.0,
        unit: 1.0,
    };
    assert_eq!(profile.interval(4.0), (0.5, f64::INFINITY));
    assert_eq!(profile.interval(0.25), (1.5, 2.5));
}

/// Polls of the caller's flag after a stop by progress: those of a full evaluation are a hundred and more.
#[test]
fn a_fit_that_is_stopped_on_a_share_evaluates_nothing_more() {
    let (sets, _) = reference();
    let once: Vec<_> = sets.iter().map(Measured::set).collect();
    let thrice = [&once[..], &once[..], &once[..]].concat();
    let unknowns = from_start([0.33, 0.14, 1.2, 1.01]);
    let (stopped, before, after) = (Cell::new(false), Cell::new(0), Cell::new(0));
    let mut progress = |state: &Progress| {
        stopped.set(state.point == 2);
        stopped.get()
    };
    let cancelled = || {
        let polls = if stopped.get() { &after } else { &before };
        polls.set(polls.get() + 1);
        false
    };
    let mut hooks = Hooks {
        progress: Some(&mut progress),
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    let given = (&PARAMETERS[..], &unknowns[..]);
    let found = fit(
        &chain(),
        given,
        &thrice,
        &nine_harmonics(),
        &FitOptions::default(),
        &mut hooks,
    )
    .unwrap();
    println!(
        "{} polls before, {} after, {} numbers",
        before.get(),
        after.get(),
        found.data
    );
    assert_eq!(found.status, Status::StoppedByCaller);
    assert!(after.get() < before.get() / 20, "{} of {}", after.get(), before.get());
    assert_eq!(found.residuals.len(), 270);
    let told = found.residuals.iter().filter(|r| r.is_finite()).count();
    assert!(told == found.data && told < 270, "{told} {}", found.data);
    let sum: f64 = found.residuals.iter().filter(|r| r.is_finite()).map(|r| r * r).sum();
    assert!((sum / found.chi2 - 1.0).abs() < 1e-12);
}
