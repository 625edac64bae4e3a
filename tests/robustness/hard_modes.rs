//! Nonlinear modes and cold starts on which programs for harmonic balance fail: from contacts that stick to
//! contacts that slide, from any amplitude, at any frequency.

use crate::common::peers::{RANGE, blade_and_ring};
use crate::common::{amplitude_range, at_dof, harmonics, solve_at, sweep};
use hbvib::{Branch, Hooks, ModeField, ModeOptions, Status, nonlinear_mode};

fn mode(highest: usize, log10: (f64, f64), at: &[f64]) -> Branch {
    let range = ModeOptions {
        at,
        ..amplitude_range(log10.0, log10.1)
    };
    nonlinear_mode(
        &blade_and_ring(0.0, false),
        &harmonics(highest),
        &range,
        &mut Hooks::default(),
    )
    .unwrap()
}

const AMPLITUDES: (f64, f64) = (-5.5, -2.0);

#[test]
fn the_mode_of_blade_and_ring_is_followed_whole_at_every_harmonic() {
    let wanted: Vec<f64> = (0..=70).map(|i| -5.5 + 0.05 * f64::from(i)).collect();
    let damping = |branch: &Branch| -> Vec<f64> {
        let of = |i: usize| branch.mode_at(branch.at(i)[0].point).unwrap().damping_ratio;
        (0..wanted.len()).map(of).collect()
    };
    // The error of few harmonics is told, not asserted: the onset of slip is steep.
    let truth = mode(127, AMPLITUDES, &wanted);
    let truth = damping(&truth);
    let largest = truth.iter().fold(0.0_f64, |m, d| m.max(*d));
    for highest in [1, 3, 9, 15, 63] {
        let branch = mode(highest, AMPLITUDES, &wanted);
        assert_eq!(branch.status(), Status::Ok, "H = {highest}");
        assert!(branch.points() < 200, "H = {highest}: {} points", branch.points());
        let log10 = branch.mode_field(ModeField::Log10Amplitude).unwrap();
        // With many harmonics an internal resonance of the ring folds the mode.
        let turns = log10.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
        assert!(turns <= branch.folds().len(), "H = {highest}: walks back");
        let error = damping(&branch)
            .iter()
            .zip(&truth)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
            / largest;
        let most = branch.newton_iterations().iter().fold(0.0_f64, |m, n| m.max(*n));
        println!(
            "H = {highest}: {} points, {most} iterations at most, error of the damping ratio {:.2} % of its largest",
            branch.points(),
            100.0 * error
        );
    }
}

#[test]
fn a_mode_starts_at_any_amplitude() {
    let whole: Vec<f64> = (0..20).map(|i| -5.4 + 0.17 * f64::from(i)).collect();
    let branch = mode(9, AMPLITUDES, &whole);
    for (i, &start) in whole.iter().enumerate() {
        let alone = mode(9, (start, start + 1e-3), &[]);
        let point = branch.at(i)[0].point;
        let (a, b) = (alone.omega()[0], branch.omega_at(point).unwrap());
        assert!((a / b - 1.0).abs() < 1e-9, "{start}: {a} {b}");
        let (a, b) = (alone.mode_at(0).unwrap(), branch.mode_at(point).unwrap());
        assert!((a.damping_ratio - b.damping_ratio).abs() < 1e-9, "{start}");
    }
}

#[test]
fn every_frequency_is_a_start_where_newton_cycles_from_the_linear_solutions() {
    let model = blade_and_ring(20.0, true);
    let solver = at_dof(0, harmonics(9));
    let at: Vec<f64> = (0..=200)
        .map(|i| RANGE.0 + (RANGE.1 - RANGE.0) * f64::from(i) / 200.0)
        .collect();
    let branch = sweep(&model, &solver, RANGE.0, RANGE.1, &at);
    let mut most = 0.0_f64;
    for (i, &omega) in at.iter().enumerate() {
        let cold = solve_at(&model, &solver, omega);
        assert_eq!((cold.status(), branch.at(i).len()), (Status::Ok, 1));
        most = most.max(cold.newton_iterations()[0]);
        let gap = (cold.amplitude()[0] / branch.at(i)[0].amplitude - 1.0).abs();
        assert!(gap < 1e-8, "{omega}: {gap:e}");
    }
    println!("{} cold starts, {most} iterations at most", at.len());
}
