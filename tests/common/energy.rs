//! Shared code of the tests of energies: comparisons, and means and maxima of time signals.

use crate::common::{all_harmonics, harmonics};
use hbvib::{Branch, Energy, SolverOptions};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// Asserts a relative error, and prints it.
pub fn close(name: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    println!("{name}: {found:e}, error {error:.1e}");
    assert!(error < tolerance, "{name}: {found:e}, needs {expected:e}: {error:.1e}");
}

/// Options that solve as accurately as round-off allows.
pub fn exactly(highest: usize) -> SolverOptions {
    SolverOptions {
        tol_residual: 1e-14,
        ..harmonics(highest)
    }
}

/// Energies of the first point.
pub fn energy(branch: &Branch) -> Energy {
    branch.energy_at(0).unwrap()
}

/// Largest value of a function of the phase of the fundamental, up to round-off.
pub fn maximum(f: impl Fn(f64) -> f64) -> f64 {
    let n = 2000;
    let width = TAU / f64::from(n);
    let best = (0..n).map(|j| f64::from(j) * width);
    let best = best.max_by(|a, b| f(*a).total_cmp(&f(*b))).unwrap();
    let (mut low, mut high) = (best - width, best + width);
    for _ in 0..80 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { low = a } else { high = b }
    }
    f(0.5 * (low + high))
}

/// Mean over a period of a trigonometric polynomial of less than 200 harmonics.
pub fn mean(f: impl Fn(f64) -> f64) -> f64 {
    (0..200).map(|j| f(TAU * f64::from(j) / 200.0)).sum::<f64>() / 200.0
}

/// Work per cycle of the forces (degree of freedom, harmonic, value) on the motion of a point.
pub fn work(branch: &Branch, forces: &[(usize, usize, Complex64)]) -> f64 {
    let x = all_harmonics(branch, 0);
    let n = branch.ndof();
    let part = |&(dof, h, f): &(usize, usize, Complex64)| PI * h as f64 * (f * x[h * n + dof].conj()).im;
    forces.iter().map(part).sum()
}
