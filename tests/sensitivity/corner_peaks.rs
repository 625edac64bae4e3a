//! Derivatives of the amplitude of peaks that are corners: the branch rises on one side and falls on the other, where a slider
//! begins to slip a second time within a period.
//!
//! A loss factor and friction do not know the frequency, so that a factor on the mass stretches the axis of the frequency alone: the
//! amplitude of a peak stays, and its frequency falls by half the factor. Other parameters are compared with differences of peaks.

use crate::common::models::oscillator;
use crate::common::{harmonics, omega_range};
use hbvib::{
    Branch, Constant, Follow, ForcedOptions, Hooks, MatrixKind, Model, Parameter, ParameterRange, Quantity,
    SolverOptions, Status, forced_response, parameter_response, sensitivity,
};

const KT: f64 = 2.079_307_097_052_009;
const PRELOAD: f64 = 0.850_443_211_805_379_4;

/// The oscillator with factors on its force, kt and preload.
fn model([force, kt, preload]: [f64; 3]) -> Model {
    oscillator(1.253_138_74, 1.976_072_438_142_4)
        .loss_factor(0.02)
        .slider(0, KT * kt, 0.5, PRELOAD * preload)
        .force(0, 1, force)
        .build()
}

fn sweep(model: &Model, solver: &SolverOptions) -> Branch {
    let range: ForcedOptions<'_> = omega_range(0.377, 2.26);
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Point, frequency and amplitude of the peak next to a frequency.
fn peak(branch: &Branch, near: f64) -> (usize, f64, f64) {
    let peaks = branch.peaks().iter();
    let found = peaks.min_by(|a, b| (a.omega - near).abs().total_cmp(&(b.omega - near).abs()));
    found.map(|p| (p.point, p.omega, p.amplitude)).unwrap()
}

#[test]
fn the_amplitude_of_a_corner_has_the_derivative_of_the_corner() {
    let parameters = [
        Parameter::Factor {
            which: MatrixKind::Mass,
        },
        Parameter::Force,
        Parameter::Contact {
            constant: Constant::Kt,
            contact: Some(0),
        },
        Parameter::Contact {
            constant: Constant::Preload,
            contact: Some(0),
        },
    ];
    for (highest, near) in [(7, 0.4971), (9, 0.4971)] {
        let solver = SolverOptions {
            tol_residual: 1e-11,
            ..harmonics(highest)
        };
        let own = model([1.0; 3]);
        let branch = sweep(&own, &solver);
        let (point, omega, amplitude) = peak(&branch, near);
        let found = sensitivity(&own, &branch, point, &parameters, Quantity::PeakAmplitude).unwrap();
        let at_fixed = sensitivity(&own, &branch, point, &parameters, Quantity::Amplitude).unwrap();
        let slope = 2.0 * at_fixed.values[0] / omega;
        assert!(slope.abs() > amplitude, "H = {highest}: no corner, {slope}");
        assert!(found.values[0].abs() < 1e-4 * amplitude, "mass: {}", found.values[0]);
        for (k, unit) in [(0, 1.0), (1, KT), (2, PRELOAD)] {
            const STEP: f64 = 1e-5;
            let beside = |sign: f64| {
                let mut factors = [1.0; 3];
                factors[k] += sign * STEP;
                peak(&sweep(&model(factors), &solver), omega).2
            };
            let difference = (beside(1.0) - beside(-1.0)) / (2.0 * STEP * unit);
            let value = found.values[k + 1];
            assert!(
                (value - difference).abs() < 1e-3 * difference.abs(),
                "{k}: {value} {difference}"
            );
        }
    }
}

/// Such a peak does not solve the equation by which peaks are followed; a smooth one of the same model does.
#[test]
fn a_corner_is_not_followed_over_a_parameter() {
    let solver = harmonics(7);
    let own = model([1.0; 3]);
    let branch = sweep(&own, &solver);
    let kt = Parameter::Contact {
        constant: Constant::Kt,
        contact: Some(0),
    };
    let follow = |near: f64| {
        let range = ParameterRange {
            start: KT,
            stop: 1.1 * KT,
            at: &[],
            follow: Follow::Peak(near),
            response: None,
        };
        parameter_response(&own, &solver, kt, &range, &mut Hooks::default())
    };
    let refused = follow(peak(&branch, 0.4971).1).unwrap_err();
    assert_eq!(refused.status, Status::NoConvergence);
    assert!(refused.to_string().contains("is a corner"), "{refused}");
    assert_eq!(follow(peak(&branch, 1.258).1).unwrap().status(), Status::Ok);
}
