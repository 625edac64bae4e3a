//! Folds: Jenkins contacts alone make none (their force is incrementally dissipative, and 6000
//! random models showed none), so the continuation is shown one on a problem of its own, the
//! one-harmonic Duffing oscillator, whose folds have a closed form.

use crate::common::models::{dense, diagonal};
use hbvib::internals::Jacobian;
use hbvib::internals::StepControl;
use hbvib::internals::{Advance, Continuation, Metric, Point, Settings};
use hbvib::internals::{Corrector, Outcome};
use hbvib::internals::{Homotopy, InitialGuess, Problem, Residual};
use hbvib::internals::{Locator, SpecialPoint};
use hbvib::{Constant, Contact, ForcedOptions, Hooks, Interrupt, Result, SolverOptions};
use num_complex::Complex64;

const DAMPING: f64 = 0.05;
const CUBIC: f64 = 0.1;
const FORCE: f64 = 0.18;

/// (1 − ω² + iωd + ¾γ|X|²) X = F
#[derive(Default)]
struct Duffing {
    jacobian: [f64; 4],
}

impl Jacobian for Duffing {
    fn size(&self) -> usize {
        2
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        matrix.copy_from_slice(&self.jacobian);
        active.fill(true);
        Ok(())
    }
}

impl Problem for Duffing {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        let (a, b) = (u[0], u[1]);
        let cubic = 0.75 * CUBIC;
        let linear = 1.0 - p * p;
        let stiffness = linear + cubic * (a * a + b * b);
        let quadrature = DAMPING * p;
        out.values
            .copy_from_slice(&[stiffness * a - quadrature * b - FORCE, stiffness * b + quadrature * a]);
        let cross = 2.0 * cubic * a * b;
        self.jacobian = [
            stiffness + 2.0 * cubic * a * a,
            cross + quadrature,
            cross - quadrature,
            stiffness + 2.0 * cubic * b * b,
        ];
        out.d_parameter
            .copy_from_slice(&[-2.0 * p * a - DAMPING * b, -2.0 * p * b + DAMPING * a]);
        out.scale = a.hypot(b) + FORCE;
        Ok(())
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        (Complex64::new(u[0], u[1]), Complex64::new(direction[0], direction[1]))
    }

    fn initial_guess(&mut self, _: InitialGuess, _: f64, u: &mut [f64]) -> Result<bool> {
        u.fill(0.0);
        Ok(true)
    }

    fn homotopy(&mut self, _: f64, _: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}

/// ω² on the upper (+1) or lower (−1) flank of the resonance at an amplitude, from
/// (1 + ¾γA² − s)² + d²s = (F/A)².
fn squared_frequency(amplitude: f64, flank: f64) -> f64 {
    let backbone = 1.0 + 0.75 * CUBIC * amplitude * amplitude;
    let d2 = DAMPING * DAMPING;
    let force = FORCE / amplitude;
    let middle = backbone - 0.5 * d2;
    middle + flank * (force * force - d2 * backbone + 0.25 * d2 * d2).sqrt()
}

/// Extremum of ω over the amplitude by golden sections: frequency and amplitude of a fold.
fn fold(flank: f64, maximum: bool, mut low: f64, mut high: f64) -> (f64, f64) {
    let sign = if maximum { -1.0 } else { 1.0 };
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..80 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if sign * squared_frequency(a, flank) < sign * squared_frequency(b, flank) {
            high = b;
        } else {
            low = a;
        }
    }
    let amplitude = 0.5 * (low + high);
    (squared_frequency(amplitude, flank).sqrt(), amplitude)
}

/// Follows the branch; all points, the last one at the end of the range.
fn follow(from: f64, to: f64) -> (Vec<Point>, Settings) {
    let settings = Settings {
        start: from,
        end: to,
        tolerance: 1e-10,
        max_iterations: 25,
        steps: StepControl::new(0.0, 0.0, 0.0),
    };
    let mut v = vec![0.0, 0.0, from];
    let metric = Metric::along(1.0, &settings);
    let mut corrector = Corrector::new(2, settings.tolerance, settings.max_iterations).unwrap();
    let outcome = corrector.correct(
        &mut Duffing::default(),
        &mut v,
        &[0.0, 0.0, 1.0],
        metric,
        true,
        &Interrupt::none(),
    );
    let Outcome::Converged(corrected) = outcome.unwrap() else {
        panic!("no first point");
    };
    let mut continuation = Continuation::new(settings, Point::new(v, corrected, 0.0)).unwrap();
    // As the continuation has turned it, into the range.
    let mut points = vec![continuation.current().clone()];
    while points.len() < 1000 {
        match continuation
            .advance(&mut Duffing::default(), &Interrupt::none())
            .unwrap()
        {
            Advance::Accepted { point, last } => {
                points.push(point);
                if last {
                    return (points, settings);
                }
            }
            other => panic!("ended early: {other:?}"),
        }
    }
    panic!("the end was not reached");
}

#[test]
fn folds_pass_without_help_and_are_found_where_the_closed_form_has_them() {
    // The upper fold is the end of the upper branch, close to the peak; the lower one lies on the
    // flank above the backbone.
    let lower = fold(1.0, false, 0.5, 2.0);
    for (from, to) in [(0.5, 1.8), (1.8, 0.5)] {
        let (points, settings) = follow(from, to);
        assert_eq!(points.last().unwrap().parameter().to_bits(), f64::to_bits(to));
        let mut locator = Locator::new(2, settings).unwrap();
        let (mut folds, mut peaks) = (Vec::new(), Vec::new());
        for pair in points.windows(2) {
            for (event, list) in [(SpecialPoint::Fold, &mut folds), (SpecialPoint::Peak, &mut peaks)] {
                if event.between(&pair[0], &pair[1]) {
                    let found = locator
                        .locate(&mut Duffing::default(), event, &pair[0], &pair[1], &Interrupt::none())
                        .unwrap();
                    list.push(found.unwrap());
                }
            }
        }
        println!("{} points", points.len());
        assert_eq!((folds.len(), peaks.len()), (2, 1));
        folds.sort_by(|a, b| a.parameter().total_cmp(&b.parameter()));
        let gap = |point: &Point, omega: f64| (point.parameter() / omega - 1.0).abs();
        assert!(gap(&folds[0], lower.0) < 1e-10, "{}", folds[0].parameter());
        assert!((folds[0].amplitude.norm() / lower.1 - 1.0).abs() < 1e-6);
        // At the peak the force only meets the damping: A·d·ω = F on the backbone, up to d².
        let peak = peaks[0].amplitude.norm();
        let omega = peaks[0].parameter();
        let backbone = 1.0 + 0.75 * CUBIC * peak * peak;
        assert!((omega * omega - (backbone - 0.5 * DAMPING * DAMPING)).abs() < 1e-8);
        let closed = (DAMPING * DAMPING * (backbone - 0.25 * DAMPING * DAMPING)).sqrt();
        assert!((FORCE / peak / closed - 1.0).abs() < 1e-9);
        // The upper fold, on the same flank: a maximum of ω just below the largest amplitude.
        let upper = fold(1.0, true, 0.97 * peak, peak * (1.0 - 1e-12));
        assert!(gap(&folds[1], upper.0) < 1e-10, "{} {}", folds[1].parameter(), upper.0);
        assert!(upper.0 > omega);
    }
}

#[test]
fn between_the_folds_every_one_of_three_solutions_is_found() {
    let wanted = 1.2;
    let (points, settings) = follow(0.5, 1.8);
    let mut locator = Locator::new(2, settings).unwrap();
    let mut found = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0].parameter(), pair[1].parameter());
        if (a - wanted) * (b - wanted) < 0.0 {
            let point = locator
                .at_parameter(&mut Duffing::default(), &pair[0], &pair[1], wanted, &Interrupt::none())
                .unwrap()
                .unwrap();
            assert_eq!(point.parameter().to_bits(), f64::to_bits(wanted));
            found.push(point.amplitude.norm());
        }
    }
    assert_eq!(found.len(), 3);
    for amplitude in found {
        let flanks = [1.0, -1.0].map(|flank| squared_frequency(amplitude, flank).sqrt());
        assert!(
            flanks.iter().any(|w| (w / wanted - 1.0).abs() < 1e-10),
            "{amplitude}: {flanks:?}"
        );
    }
}

#[test]
fn a_small_loop_with_a_peak_is_not_passed_in_one_step() {
    // A pressed stop at the end of a chain makes a loop of two folds with a small peak between them, whose height and place are
    // those of a sweep with 20 times shorter steps.
    let stiffness = [2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0];
    let mut stop = Contact::unilateral(Some(2), None, 2.0, 0.0);
    stop.set(Constant::Preload, 0.2).unwrap();
    let model = dense(&diagonal(&[1.0; 3]), &stiffness)
        .rayleigh(0.0, 0.02)
        .force(2, 1, 0.4)
        .contact(stop)
        .build();
    let mut missed = Vec::new();
    for k in 0..40 {
        let step_max = 0.034 + 0.0003 * f64::from(k);
        let solver = SolverOptions {
            harmonics: 4,
            tolerance: 0.0,
            step_max,
            ..SolverOptions::default()
        };
        let range = ForcedOptions {
            omega_start: 0.2,
            omega_stop: 0.4,
            ..ForcedOptions::default()
        };
        let branch = hbvib::forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
        let found = branch
            .peaks()
            .iter()
            .any(|p| (p.omega - 0.331_665_023).abs() < 1e-7 && (p.amplitude - 0.684_162_589).abs() < 1e-7);
        if !found {
            missed.push(step_max);
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
