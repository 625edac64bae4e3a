//! Values of the responses at every stored point of a branch, against its own harmonics, sampled in time.

use crate::common::chains::chain;
use crate::common::models::{self, Structure};
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{
    Branch, Component, Contact, ForcedOptions, Hooks, Measure, Model, Response, SolverOptions, forced_response,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Values of a gauge over a period, from the harmonics of all degrees of freedom.
fn history(branch: &Branch, point: usize, response: &Response<'_>, n: usize) -> Vec<f64> {
    let (ndof, highest) = (branch.ndof(), branch.harmonics());
    let omega = branch.omega_at(point).unwrap();
    let mut x = vec![Complex64::ZERO; (highest + 1) * ndof];
    branch.harmonics_at(point, &mut x).unwrap();
    let gauge: Vec<Complex64> = (0..=highest)
        .map(|h| {
            let weight = |k: usize| response.weights.get(k).copied().unwrap_or(1.0);
            let sum: Complex64 = response
                .dofs
                .iter()
                .enumerate()
                .map(|(k, dof)| x[h * ndof + dof] * weight(k))
                .sum();
            sum * Complex64::new(0.0, h as f64 * omega).powi(response.component.order())
        })
        .collect();
    let at = |j: usize| {
        let tau = TAU * j as f64 / n as f64;
        let terms = gauge.iter().enumerate();
        terms.map(|(h, z)| (z * Complex64::cis(h as f64 * tau)).re).sum()
    };
    (0..n).map(at).collect()
}

/// The largest value near the largest sample, by the parabola through its neighbours.
fn largest(values: &[f64]) -> f64 {
    let n = values.len();
    let k = (0..n).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap();
    let [a, b, c] = [values[(k + n - 1) % n], values[k], values[(k + 1) % n]];
    let bend = a - 2.0 * b + c;
    if bend == 0.0 {
        b
    } else {
        b - (c - a).powi(2) / (8.0 * bend)
    }
}

fn expected(measure: Measure, values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let harmonic = |h: usize| {
        let sum: Complex64 = values
            .iter()
            .enumerate()
            .map(|(j, x)| x * Complex64::cis(-TAU * (h * j) as f64 / n))
            .sum();
        sum.norm() / n * if h == 0 { 1.0 } else { 2.0 }
    };
    let opposite: Vec<f64> = values.iter().map(|x| -x).collect();
    match measure {
        Measure::Fundamental => harmonic(1),
        Measure::Harmonic(h) => harmonic(h),
        Measure::Peak => largest(values).max(largest(&opposite)),
        Measure::Range => largest(values) + largest(&opposite),
        Measure::Rms => (values.iter().map(|x| x * x).sum::<f64>() / n).sqrt(),
    }
}

const MEASURES: [Measure; 7] = [
    Measure::Fundamental,
    Measure::Harmonic(0),
    Measure::Harmonic(2),
    Measure::Harmonic(3),
    Measure::Peak,
    Measure::Rms,
    Measure::Range,
];

const COMPONENTS: [Component; 3] = [Component::Displacement, Component::Velocity, Component::Acceleration];

fn all_responses() -> Vec<Response<'static>> {
    let mut all = Vec::new();
    for measure in MEASURES {
        for component in COMPONENTS {
            if measure == Measure::Harmonic(0) && component != Component::Displacement {
                continue;
            }
            for (dofs, weights) in [(&[4][..], &[][..]), (&[0, 2, 5], &[0.5, -2.0, 1.0])] {
                all.push(Response {
                    measure,
                    dofs,
                    weights,
                    component,
                    ..Response::default()
                });
            }
        }
    }
    all
}

fn solve(model: &Model, responses: &[Response<'_>], tolerance: f64) -> Branch {
    let solver = SolverOptions {
        harmonics: 7,
        tolerance,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        at: &[0.61],
        responses,
        ..omega_range(0.2, 1.3)
    };
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn every_response_is_that_of_the_harmonics_in_time() {
    let responses = all_responses();
    let mut compared = 0;
    for preload in [0.0, 0.4] {
        let model = chain(6, preload);
        let branch = solve(&model, &responses, 0.0);
        assert_eq!(branch.responses().len(), responses.len());
        for point in (0..branch.stored())
            .step_by(branch.stored() / 6)
            .chain([branch.stored() - 1])
        {
            for (response, found) in responses.iter().zip(branch.responses()) {
                let expected = expected(response.measure, &history(&branch, point, response, 4096));
                let value = found.values()[point];
                let size = found.values().iter().fold(0.0_f64, |m, x| m.max(*x));
                assert!(
                    (value - expected).abs() <= 1e-9 * size + 1e-13,
                    "{response:?} at point {point}: {value}, in time {expected}"
                );
                if found.complex()[point].re.is_finite() {
                    assert!((found.complex()[point].norm() - value).abs() < 1e-14 * (1.0 + value));
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 300, "{compared}");
}

/// The mean of this sector is zero in all of its motions, so that none is known by its frequency and its first unknown.
#[test]
fn solutions_at_one_frequency_have_readings_of_their_own() {
    let mut model = Structure::cyclic(1, 10)
        .mass(&[1.0])
        .stiffness(&[2.2])
        .rayleigh(0.0, 0.01)
        .wave(7)
        .build();
    let mut between = Contact::cubic(0, Some(0), 0.1, 0.06);
    between.sector_offset = 1;
    model.add_contact(&between).unwrap();
    model.add_force(0, 1, 0.9.into()).unwrap();
    model.add_force(0, 2, Complex64::new(0.0, 0.3)).unwrap();
    let solver = harmonics(5);
    let responses = [Measure::Rms, Measure::Peak].map(|measure| Response {
        measure,
        dofs: &[0],
        ..Response::default()
    });
    let range = ForcedOptions {
        at: &[1.5],
        responses: &responses,
        ..omega_range(0.7, 2.6)
    };
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    let found = branch.at(0);
    assert_eq!(found.len(), 3);
    for solution in found {
        for (response, series) in responses.iter().zip(branch.responses()) {
            let expected = expected(response.measure, &history(&branch, solution.point, response, 4096));
            let told = series.values()[solution.point];
            assert!((told - expected).abs() < 1e-8 * expected, "{told}, in time {expected}");
        }
        assert_eq!(
            solution.amplitude.to_bits(),
            branch.responses()[0].values()[solution.point].to_bits()
        );
    }
}

#[test]
fn the_first_response_leads_the_amplitude_and_the_peaks() {
    let model = chain(6, 0.0);
    let plain = solve(&model, &[], 0.0);
    for response in all_responses() {
        let branch = solve(&model, &[response], 0.0);
        let (peaks, own) = (branch.peaks(), branch.responses()[0].peaks());
        assert_eq!(peaks.len(), own.len());
        for (peak, own) in peaks.iter().zip(own) {
            assert_eq!(
                (peak.point, peak.amplitude.to_bits()),
                (own.point, own.amplitude.to_bits())
            );
        }
        for (point, amplitude) in branch.amplitude().iter().enumerate() {
            assert!((amplitude - branch.responses()[0].values()[point]).abs() <= 1e-9 * amplitude.max(1e-9));
        }
    }
    // The plain response of the same degree of freedom changes nothing.
    let named = at_dof(4, harmonics(7));
    let range = ForcedOptions {
        at: &[0.61],
        ..omega_range(0.2, 1.3)
    };
    let by_dof = forced_response(&model, &named, &range, &mut Hooks::default()).unwrap();
    let by_response = solve(
        &model,
        &[Response {
            dofs: &[4],
            ..Response::default()
        }],
        0.0,
    );
    assert_eq!(by_dof.amplitude(), by_response.amplitude());
    assert_eq!(by_dof.peaks().len(), by_response.peaks().len());
    for (a, b) in by_dof.peaks().iter().zip(by_response.peaks()) {
        assert_eq!(
            (a.omega.to_bits(), a.amplitude.to_bits()),
            (b.omega.to_bits(), b.amplitude.to_bits())
        );
    }
    assert!(!plain.peaks().is_empty());
}

/// A linear structure moves in the harmonics of its forces alone, which may leave some out.
#[test]
fn measures_of_a_linear_structure_are_those_of_its_closed_form() {
    for forced in [&[1, 4][..], &[1, 5], &[3, 5], &[0, 1, 3], &[2, 3], &[1, 2]] {
        let mut model = models::oscillator(1.0, 1.0).damping(&[0.1]).build();
        let force = |h: usize| Complex64::new(1.0, if h == 0 { 0.0 } else { -0.7 * h as f64 });
        for &h in forced {
            model.add_force(0, h, force(h)).unwrap();
        }
        let responses = [Measure::Peak, Measure::Range].map(|measure| Response {
            dofs: &[0],
            measure,
            ..Response::default()
        });
        let omega = 0.9;
        let range = ForcedOptions {
            responses: &responses,
            ..omega_range(omega, omega)
        };
        let branch = forced_response(&model, &harmonics(9), &range, &mut Hooks::default()).unwrap();
        let n = 20_000;
        let motion = |j: i32| -> f64 {
            let tau = TAU * f64::from(j) / f64::from(n);
            let of = |&h: &usize| {
                let w = h as f64 * omega;
                (force(h) / Complex64::new(1.0 - w * w, 0.1 * w) * Complex64::cis(h as f64 * tau)).re
            };
            forced.iter().map(of).sum()
        };
        let values: Vec<f64> = (0..n).map(motion).collect();
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        for (found, exact) in branch.responses().iter().zip([high.max(-low), high - low]) {
            let off = found.values()[0] / exact - 1.0;
            assert!((-1e-12..1e-6).contains(&off), "{forced:?}: {off:e}");
        }
    }
}
