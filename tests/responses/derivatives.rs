//! Derivatives of responses by parameters, against differences of solutions.

use crate::common::chains::chain_with;
use crate::common::{harmonics, omega_range};
use hbvib::{
    Branch, Component, Constant, ForcedOptions, Hooks, Measure, Parameter, Quantity, Response, forced_response,
    sensitivity,
};

const AT: [f64; 3] = [1.5, 0.3, 1.0];

const PARAMETERS: [Parameter<'static>; 3] = [
    Parameter::Contact {
        constant: Constant::Kt,
        contact: Some(0),
    },
    Parameter::Contact {
        constant: Constant::Mu,
        contact: Some(0),
    },
    Parameter::Force,
];

fn responses() -> Vec<Response<'static>> {
    let mut all = Vec::new();
    for measure in [
        Measure::Fundamental,
        Measure::Harmonic(3),
        Measure::Peak,
        Measure::Rms,
        Measure::Range,
    ] {
        for component in [Component::Displacement, Component::Velocity, Component::Acceleration] {
            all.push(Response {
                measure,
                dofs: &[0],
                component,
                ..Response::default()
            });
            let (dofs, weights) = (&[1, 3, 4], &[1.0, -0.5, 2.0]);
            all.push(Response {
                measure,
                dofs,
                weights,
                component,
                ..Response::default()
            });
        }
    }
    all
}

fn solve(preload: f64, at: [f64; 3], (start, stop): (f64, f64), responses: &[Response<'_>]) -> Branch {
    let solver = harmonics(5);
    let range = ForcedOptions {
        responses,
        ..omega_range(start, stop)
    };
    // A factor on the forces is one on the constant force, too.
    let model = chain_with(6, preload * at[2], at);
    forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap()
}

fn moved(parameter: usize, by: f64) -> [f64; 3] {
    let mut at = AT;
    at[parameter] *= 1.0 + by;
    at
}

/// The derivative by a relative change of a parameter, from both sides at two distances.
fn difference(value: impl Fn(f64) -> f64, step: f64) -> f64 {
    let central = |step: f64| (value(step) - value(-step)) / (2.0 * step);
    (4.0 * central(step) - central(2.0 * step)) / 3.0
}

#[test]
fn derivatives_at_a_frequency_are_those_of_differences() {
    let all = responses();
    for preload in [0.0, 0.4] {
        for omega in [0.43, 0.61, 0.78] {
            let model = chain_with(6, preload, AT);
            let branch = solve(preload, AT, (omega, omega), &all);
            for (parameter, value) in AT.iter().enumerate() {
                let scale = if parameter == 2 { 1.0 } else { *value };
                // Short, so that no event of another contact lies within.
                let step = 2e-5;
                let steps = [step, -step, 2.0 * step, -2.0 * step];
                let found = steps.map(|by| solve(preload, moved(parameter, by), (omega, omega), &all));
                for (r, response) in all.iter().enumerate() {
                    let exact = sensitivity(&model, &branch, 0, &PARAMETERS, Quantity::Response(r)).unwrap();
                    let exact = exact.values[parameter] * scale;
                    let values: Vec<f64> = found.iter().map(|b| b.responses()[r].values()[0]).collect();
                    let near = (values[0] - values[1]) / (2.0 * step);
                    let far = (values[2] - values[3]) / (4.0 * step);
                    let expected = (4.0 * near - far) / 3.0;
                    let size = branch.responses()[r].values()[0];
                    assert!(
                        (exact - expected).abs() <= 1e-7 * (size + expected.abs()) + 1e-10,
                        "{response:?} at {omega} by parameter {parameter}: {exact} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn peaks_move_as_their_derivatives_tell() {
    let all: Vec<Response<'_>> = responses().into_iter().filter(|r| r.dofs.len() == 1).collect();
    let range = (0.7, 0.86);
    let model = chain_with(6, 0.0, AT);
    let branch = solve(0.0, AT, range, &all);
    let mut compared = 0;
    for (r, response) in all.iter().enumerate() {
        let Some(peak) = branch.responses()[r]
            .peaks()
            .iter()
            .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        else {
            continue;
        };
        let amplitude = sensitivity(&model, &branch, peak.point, &PARAMETERS, Quantity::Response(r)).unwrap();
        let omega = sensitivity(&model, &branch, peak.point, &PARAMETERS, Quantity::ResponsePeakOmega(r)).unwrap();
        for (parameter, value) in AT.iter().enumerate() {
            let scale = if parameter == 2 { 1.0 } else { *value };
            let largest = |by: f64| {
                let found = solve(0.0, moved(parameter, by), range, core::slice::from_ref(response));
                let peaks = found.responses()[0].peaks().to_vec();
                peaks
                    .into_iter()
                    .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
                    .unwrap()
            };
            let expected = difference(|by| largest(by).amplitude, 1e-3);
            let exact = amplitude.values[parameter] * scale;
            let size = peak.amplitude + expected.abs();
            assert!(
                (exact - expected).abs() < 1e-6 * size,
                "{response:?} by {parameter}: {exact} {expected}"
            );
            let expected = difference(|by| largest(by).omega, 1e-3);
            let exact = omega.values[parameter] * scale;
            assert!(
                (exact - expected).abs() < 1e-5,
                "{response:?} by {parameter}: {exact} {expected}"
            );
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}
