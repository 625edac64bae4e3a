//! Uncertainty of fits: predictions, intervals that contain the truth, and many data on a sector.

use crate::fit_of_responses::{Measured, PARAMETERS, chain, from_start, nine_harmonics, reference};
use hbvib::{DataKind, FitData, FitOptions, Hooks, Response, fit, predict};

#[test]
fn of_a_peak_is_that_of_differences() {
    let (sets, _) = reference();
    let data: Vec<_> = sets.iter().map(Measured::set).collect();
    let (model, solver) = (chain(), nine_harmonics());
    let start = from_start([0.3, 0.15, 1.0, 1.0]);
    let found = fit(
        &model,
        (&PARAMETERS, &start),
        &data,
        &solver,
        &FitOptions::default(),
        &mut Hooks::default(),
    )
    .unwrap();
    let wanted = FitData {
        kind: DataKind::Peak,
        force_factor: 0.1,
        response: Response {
            dofs: &[1],
            ..Response::default()
        },
        range: Some((0.6, 0.9)),
        x: &[0.72],
        ..FitData::default()
    };
    let peak = |theta: &[f64]| {
        let nothing = [0.0; 16];
        predict(
            &model,
            &PARAMETERS,
            (theta, &nothing),
            &wanted,
            &solver,
            &mut Hooks::default(),
        )
        .unwrap()
        .values
    };
    let told = predict(
        &model,
        &PARAMETERS,
        (&found.theta, &found.covariance),
        &wanted,
        &solver,
        &mut Hooks::default(),
    )
    .unwrap();
    println!("peak {:?} +- {:?}, shift {:?}", told.values, told.sigma, told.shift);
    for row in 0..2 {
        let slopes: Vec<f64> = (0..4)
            .map(|k| {
                let central = |h: f64| {
                    let moved = |sign: f64| {
                        let mut theta = found.theta.clone();
                        theta[k] *= 1.0 + sign * h;
                        peak(&theta)[row]
                    };
                    (moved(1.0) - moved(-1.0)) / (2.0 * h * found.theta[k])
                };
                (4.0 * central(1e-4) - central(2e-4)) / 3.0
            })
            .collect();
        let variance: f64 = (0..16)
            .map(|i| slopes[i / 4] * found.covariance[i] * slopes[i % 4])
            .sum();
        assert!(
            (told.sigma[row] / variance.sqrt() - 1.0).abs() < 1e-4,
            "{} {}",
            told.sigma[row],
            variance.sqrt()
        );
        assert!(told.shift[row].abs() < 0.1 * told.sigma[row]);
    }
}
