//! Peak and folds of a forced Duffing oscillator, ẍ + 0.05 ẋ + x + 0.1 x³ = 0.18 cos ωt: with one
//! harmonic against the closed form of its describing function, with many against converged values of
//! the truth (two independent methods each: collocation and time integration).

use crate::common::chains::duffing;
use crate::common::{harmonics, sweep};
use hbvib::Branch;

const C: f64 = 0.05;
const CUBIC: f64 = 0.1;
const F: f64 = 0.18;

fn response(highest: usize, at: &[f64]) -> Branch {
    sweep(&duffing(C, CUBIC, F), &harmonics(highest), 0.5, 1.6, at)
}

fn close(what: &str, found: f64, wanted: f64, tolerance: f64) {
    println!("{what}: {found:.12} against {wanted:.12}");
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{what}");
}

/// s·(detuning² + (cω)²) − F² of the describing function at s = a², and its derivative by s.
fn describing(omega: f64, s: f64) -> (f64, f64) {
    let detuning = 1.0 - omega * omega + 0.75 * CUBIC * s;
    let squares = detuning * detuning + C * C * omega * omega;
    (s * squares - F * F, squares + 1.5 * CUBIC * s * detuning)
}

#[test]
fn with_one_harmonic_peak_and_folds_are_those_of_the_describing_function() {
    let branch = response(1, &[]);
    // On the backbone ω² = 1 + ¾·cubic·a², with a·c·ω = F at the top but for damping, where the
    // slope by ω vanishes: s·(−4ω·detuning + 2c²ω) = 0.
    let [peak] = branch.peaks() else {
        panic!("one peak, found {}", branch.peaks().len());
    };
    close("peak amplitude", peak.amplitude, 2.841_625, 1e-6);
    close("peak frequency", peak.omega, 1.266_634, 1e-6);
    let s = peak.amplitude * peak.amplitude;
    assert!(describing(peak.omega, s).0.abs() < 1e-12);
    let slope = 1.0 - peak.omega * peak.omega + 0.75 * CUBIC * s - 0.5 * C * C;
    assert!(slope.abs() < 1e-9, "{slope:e}");
    assert_eq!(branch.folds().len(), 2);
    for fold in branch.folds() {
        let (surplus, slope) = describing(fold.omega, fold.amplitude * fold.amplitude);
        println!("fold at {}: {surplus:.1e} {slope:.1e}", fold.omega);
        assert!(surplus.abs() < 1e-9 && slope.abs() < 1e-6);
    }
    // Both branches between the folds, and the middle one.
    let branch = response(1, &[1.2]);
    let mut found: Vec<f64> = branch.at(0).iter().map(|point| point.amplitude).collect();
    found.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 3);
    for a in found {
        assert!(describing(1.2, a * a).0.abs() < 1e-12);
    }
}

#[test]
fn with_many_harmonics_peak_and_folds_are_the_true_ones() {
    let branch = response(15, &[]);
    let [peak] = branch.peaks() else {
        panic!("one peak, found {}", branch.peaks().len());
    };
    close("peak amplitude", peak.amplitude, 2.830_198_059_4, 1e-10);
    close("peak frequency", peak.omega, 1.268_716_736_0, 1e-9);
    let [upper, lower] = branch.folds() else {
        panic!("two folds, found {}", branch.folds().len());
    };
    close("upper fold", upper.omega, 1.269_601_956, 1e-9);
    close("lower fold", lower.omega, 1.115_700_252, 1e-9);
}
