//! The unilateral spring against quadrature, closed forms and the reference values of an oscillator
//! with a stop: the law, static preload, coexisting solutions.

use crate::common::models::oscillator;
use crate::common::{all_harmonics, amplitude_range, harmonics, omega_range, solve_at};
use hbvib::{
    Branch, Constant, Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Status, contact_evaluate,
    forced_response, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// m ẍ + c ẋ + k x with m = k = 1, c = 0.02, and a stop kn·max(x − gap, 0).
fn stopped(kn: f64, gap: f64, force: f64) -> Model {
    let mut model = oscillator(1.0, 1.0).damping(&[0.02]).force(0, 1, force).build();
    model.add_contact(&Contact::unilateral(None, Some(0), kn, gap)).unwrap();
    model
}

fn value(x: &[Complex64], tau: f64) -> f64 {
    x.iter()
        .enumerate()
        .map(|(h, x)| (x * Complex64::cis(h as f64 * tau)).re)
        .sum()
}

#[test]
fn harmonics_of_the_force_are_those_of_quadrature() {
    let x = [0.1, 0.8, -0.3, 0.2, 0.05].map(|r| Complex64::new(r, 0.4 * r));
    let x: Vec<Complex64> = x
        .iter()
        .enumerate()
        .map(|(h, z)| if h == 0 { z.re.into() } else { *z })
        .collect();
    for (kn, gap) in [(2.0, 0.3), (2.0, -0.2), (0.7, 0.0), (1.0, 5.0), (1.0, -5.0)] {
        // On the ground's side: the closing is −x, so that a positive x opens.
        let contact = Contact::unilateral(Some(0), None, kn, gap);
        let mut force = vec![Complex64::ZERO; x.len()];
        contact_evaluate(&contact, x.len() - 1, 0, 1.0, &x, &mut force, None).unwrap();
        let n = 1 << 18;
        let mut exact = vec![Complex64::ZERO; x.len()];
        for j in 0..n {
            let tau = TAU * f64::from(j) / f64::from(n);
            let f = -kn * (-value(&x, tau) - gap).max(0.0);
            for (h, e) in exact.iter_mut().enumerate() {
                let share = if h == 0 { 1.0 } else { 2.0 } / f64::from(n);
                *e += share * f * Complex64::cis(-(h as f64) * tau);
            }
        }
        for (a, b) in force.iter().zip(&exact) {
            // The error of 2^18 samples at two kinks.
            assert!((a - b).norm() < 1e-9 * kn, "gap {gap}: {a} {b}");
        }
    }
}

#[test]
fn a_stop_that_never_opens_is_a_spring_about_the_static_position() {
    let model = stopped(1000.0, -0.5, 0.2);
    for h in [1, 2, 7] {
        let branch = solve_at(&model, &harmonics(h), 1.1);
        let x = all_harmonics(&branch, 0);
        assert!((x[0].re / -0.499_500_499_500_499_5 - 1.0).abs() < 1e-12, "{}", x[0]);
        assert!(
            (x[1].norm() / 0.000_200_042_008_773_422_09 - 1.0).abs() < 1e-10,
            "{}",
            x[1]
        );
    }
    // The same by a preload: gap = −preload/kn.
    let mut other = oscillator(1.0, 1.0).damping(&[0.02]).force(0, 1, 0.2).build();
    other
        .add_contact(
            &Contact::unilateral(None, Some(0), 1000.0, 0.0)
                .with(Constant::Preload, 500.0)
                .unwrap(),
        )
        .unwrap();
    let (a, b) = (
        solve_at(&model, &harmonics(3), 1.1),
        solve_at(&other, &harmonics(3), 1.1),
    );
    assert_eq!(all_harmonics(&a, 0), all_harmonics(&b, 0));
}

#[test]
fn a_gap_that_never_closes_is_not_felt() {
    let branch = solve_at(&stopped(3.0, 10.0, 0.2), &harmonics(9), 1.1);
    let x = all_harmonics(&branch, 0);
    assert!((x[1].norm() / 0.947_197_363_733_654_8 - 1.0).abs() < 1e-12);
    assert!(x[0].norm() < 1e-15 && x[2].norm() < 1e-15);
}

fn sweep(model: &Model, h: usize, from: f64, to: f64, at: &[f64]) -> Branch {
    let range = ForcedOptions {
        at,
        ..omega_range(from, to)
    };
    let branch = forced_response(model, &harmonics(h), &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    branch
}

/// Values of time integration and of H = 15; both stable solutions lie on the branch, between folds.
#[test]
fn coexisting_solutions_of_a_stop_lie_on_one_branch() {
    for (from, to) in [(0.9, 1.5), (1.5, 0.9)] {
        let branch = sweep(&stopped(3.0, 0.2, 0.02), 15, from, to, &[1.15]);
        let mut amplitudes: Vec<f64> = branch.at(0).iter().map(|s| s.amplitude).collect();
        amplitudes.sort_by(f64::total_cmp);
        println!(
            "{amplitudes:?} folds {:?}",
            branch.folds().iter().map(|f| f.omega).collect::<Vec<_>>()
        );
        assert_eq!(amplitudes.len(), 3);
        assert!((amplitudes[0] / 0.061_858_390_314_775_01 - 1.0).abs() < 1e-9);
        assert!((amplitudes[2] / 0.401_335_562_066_940_65 - 1.0).abs() < 1e-9);
        assert!(
            (amplitudes[2] / 0.401_335_298_902_405_2 - 1.0).abs() < 1e-6,
            "against time integration"
        );
        assert_eq!(branch.folds().len(), 2);
    }
}

/// Free of damping, the mass swings a time on its spring and a time on spring and stop, each a piece
/// of a sine: the truth at any amplitude.
#[test]
fn the_mode_of_a_mass_with_a_stop_has_the_period_of_its_two_springs() {
    let (kn, gap) = (3.0, 0.2);
    let mut model = stopped(kn, gap, 0.0);
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(1, &[0.0]))
        .unwrap();
    let range = amplitude_range(-2.0, 1.0);
    let branch = nonlinear_mode(&model, &harmonics(63), &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    let mut slipped = 0;
    for point in 0..branch.points() {
        let x = all_harmonics(&branch, point);
        // The largest motion away from the stop, on a fine grid: it is flat there.
        let n = 1 << 14;
        let away = (0..n).map(|j| -value(&x, TAU * f64::from(j) / f64::from(n)));
        let a = away.fold(f64::NEG_INFINITY, f64::max);
        let period = if a <= gap {
            TAU
        } else {
            slipped += 1;
            let (w, v) = ((1.0 + kn).sqrt(), (a * a - gap * gap).sqrt());
            let (rest, swing) = (gap / (1.0 + kn), (gap / (1.0 + kn)).hypot(v / (1.0 + kn).sqrt()));
            TAU / 2.0 + 2.0 * (gap / a).asin() + 2.0 / w * (rest / swing).acos()
        };
        let error = branch.omega()[point] * period / TAU - 1.0;
        assert!(error.abs() < 3e-6, "amplitude {a}: {error:e}");
        assert!(branch.mode_at(point).unwrap().damping_ratio.abs() < 1e-12);
    }
    assert!(slipped > 10);
}
