//! One point of the paper's blisk in full, F = 5 N at 208.85 Hz: every stored harmonic of every
//! degree of freedom.

use crate::common::{self, BASE, Blisk, NDOF, all_harmonics, complex, data, harmonics, number, slip, solve_at};
use hbvib::SolverOptions;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Largest difference from the stored harmonics, relative to the largest of them and, harmonic by
/// harmonic, to the largest of each.
fn errors(x: &[Complex64], stored: &serde_json::Value) -> (f64, f64) {
    let (mut largest, mut gap, mut own) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (h, dofs) in stored.as_object().unwrap() {
        let h: usize = h.parse().unwrap();
        let expected: Vec<Complex64> = dofs.as_array().unwrap().iter().map(complex).collect();
        assert_eq!(expected.len(), NDOF);
        let here = common::largest(&expected);
        let difference = expected
            .iter()
            .zip(&x[h * NDOF..])
            .fold(0.0_f64, |m, (e, x)| m.max((x - e).norm()));
        largest = largest.max(here);
        gap = gap.max(difference);
        own = own.max(difference / here);
    }
    (gap / largest, own)
}

fn omega() -> f64 {
    TAU * number(&data("point_F5_208p85.json")["hbm"]["f_Hz"])
}

#[test]
fn exact_events_give_the_same_h_solution_at_every_h() {
    let reference = data("point_F5_208p85.json");
    let stored = reference["hbm"]["hbm_exactN"].as_object().unwrap();
    assert_eq!(stored.len(), 8);
    for (highest, point) in stored {
        let highest: usize = highest.parse().unwrap();
        let branch = solve_at(&BASE.sector(), &harmonics(highest), omega());
        let (error, own) = errors(&all_harmonics(&branch, 0), &point["X"]);
        println!("H = {highest}: {error:.1e} of the largest, {own:.1e} of the largest in its own harmonic");
        assert!(slip(&branch, 0) > 0.0);
        assert!(error < 1e-8, "H = {highest}: {error:.1e}");
        assert!(own < 1e-6, "H = {highest}: {own:.1e} in one harmonic");
    }
}

#[test]
fn the_same_h_solution_approaches_the_truth_as_h_grows() {
    let reference = data("point_F5_208p85.json");
    let truth = complex(&reference["td"]["X"]["1"][0]);
    let error = |highest: usize| {
        let branch = solve_at(&BASE.sector(), &harmonics(highest), omega());
        (all_harmonics(&branch, 0)[NDOF] - truth).norm() / truth.norm()
    };
    // The truncation error is stored too, but only these trends are the claim here.
    let (coarse, fine, finest) = (error(7), error(63), error(255));
    println!("error against the truth: H = 7 {coarse:.1e}, H = 63 {fine:.1e}, H = 255 {finest:.1e}");
    assert!(coarse > 1e-2 && fine < 1e-4 && finest < 1e-5);
}

#[test]
fn sampled_evaluation_converges_to_exact_events_of_the_same_h() {
    for highest in [1, 7, 15] {
        let model = Blisk { ..BASE }.sector();
        let exact = all_harmonics(&solve_at(&model, &harmonics(highest), omega()), 0);
        let counts = [256, 1024, 4096, 16384];
        let errors: Vec<f64> = counts
            .iter()
            .map(|&samples| {
                let options = SolverOptions {
                    samples,
                    ..harmonics(highest)
                };
                let sampled = all_harmonics(&solve_at(&model, &options, omega()), 0);
                common::relative_gap(&sampled, &exact)
            })
            .collect();
        let order = (errors[0] / errors[3]).log2() / 6.0;
        println!("H = {highest}: N = {counts:?}: {errors:?}, order {order:.2}");
        assert!(errors[2] < 1e-4);
        // A single step can be lucky (an event close to a sample), the trend over 64 times as
        // many samples cannot.
        assert!(errors[3] < 0.1 * errors[0].min(errors[1]) || errors[3] < 1e-7);
        assert!(order > 1.0, "H = {highest}: order {order:.2}");
    }
}

#[test]
fn sampled_evaluation_agrees_with_the_same_n_solution() {
    let reference = data("point_F5_208p85.json");
    for (key, point) in reference["hbm"]["hbm_sampled"].as_object().unwrap() {
        let (highest, samples) = key.strip_prefix('H').unwrap().split_once("_N").unwrap();
        let options = SolverOptions {
            samples: samples.parse().unwrap(),
            ..harmonics(highest.parse().unwrap())
        };
        let found = all_harmonics(&solve_at(&BASE.sector(), &options, omega()), 0)[NDOF];
        let expected = complex(&point["b2"]);
        let error = (found - expected).norm() / expected.norm();
        println!("{key}: {error:.1e}");
        assert!(error < 1e-8, "{key}: {error:.1e}");
    }
}
