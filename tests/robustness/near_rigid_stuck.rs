//! Near-rigid contacts that stick, which is a linear problem, and those that hardly slip, with a tolerance.

use crate::common::models::{chain_stiffness, unit_chain};
use crate::common::{all_harmonics, at_dof, sweep};
use hbvib::{Hooks, Model, SolverOptions, Status, VerifyOptions, verify};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Loads of the mass before that of the slider, by harmonic.
const LOADS: [(usize, f64); 2] = [(1, 0.2), (3, 0.1)];

fn loaded(n: usize) -> usize {
    (n / 2).saturating_sub(1)
}

/// Masses 1 between springs 1, held at both ends, with a slider in the middle that never slips.
fn stuck(n: usize, kt: f64) -> Model {
    let mut model = unit_chain(n).rayleigh(0.02, 0.0).slider(n / 2, kt, 0.3, 1e3).build();
    for (harmonic, load) in LOADS {
        model.add_force(loaded(n), harmonic, load.into()).unwrap();
    }
    model
}

/// The motion of all masses in a harmonic while the slider sticks, from its own equations.
fn solved(n: usize, kt: f64, omega: f64, (harmonic, load): (usize, f64)) -> DVector<Complex64> {
    let stiffness = DMatrix::from_vec(n, n, chain_stiffness(&vec![1.0; n + 1]));
    let turn = harmonic as f64 * omega;
    let mut dynamic =
        stiffness.map(Complex64::from) + DMatrix::identity(n, n) * Complex64::new(-turn * turn, 0.02 * turn);
    dynamic[(n / 2, n / 2)] += kt;
    let mut force = DVector::zeros(n);
    force[loaded(n)] = load.into();
    dynamic.lu().solve(&force).unwrap()
}

/// The contact moved by up to 2 % too little, beside an error estimate of zero.
#[test]
fn a_near_rigid_contact_that_sticks_is_linear() {
    let mut worst = 0.0_f64;
    for n in [1, 2, 8, 33, 101] {
        for kt in [3e3, 1.2e4, 1e5, 1e6, 1e8] {
            for (start, stop, omega) in [(0.5, 0.5, 0.5), (1.3, 1.3, 1.3), (0.98, 1.02, 1.01), (0.2, 1.5, 0.45)] {
                let single = start == stop;
                let requested = [omega];
                let solver = at_dof(n / 2, SolverOptions::default());
                let branch = sweep(
                    &stuck(n, kt),
                    &solver,
                    start,
                    stop,
                    if single { &[] } else { &requested },
                );
                let name = format!("{n} masses, kt {kt:e}, {start} to {stop}");
                assert_eq!(branch.status(), Status::Ok, "{name}");
                let point = if single { 0 } else { branch.at(0)[0].point };
                let x = all_harmonics(&branch, point);
                for load in LOADS {
                    let exact = solved(n, kt, omega, load);
                    let found = &x[load.0 * n..(load.0 + 1) * n];
                    let off = |i: usize| (found[i] - exact[i]).norm() / exact[i].norm();
                    let error = off(n / 2).max(off(loaded(n)));
                    // A motion that is kt times smaller than its parts has their rounding.
                    assert!(error <= 1e-10 + 1e-14 * kt, "{name}, harmonic {}: {error:e}", load.0);
                    worst = worst.max(error);
                }
            }
        }
    }
    println!("worst {worst:.1e}");
}

/// One mass at the onset of slip and beyond: an estimate has the error of the contact's own motion, and a point that misses the tolerance
/// is said to.
#[test]
fn a_mass_that_hardly_slips_knows_its_error() {
    for kt in [1.2e4, 2e4, 5e4, 1e6] {
        for share in [0.99, 0.97, 0.95, 0.9, 0.5] {
            for (start, stop) in [(1.02, 1.02), (0.98, 1.05)] {
                let force = 0.2;
                let model = unit_chain(1)
                    .rayleigh(0.02, 0.0)
                    .slider(0, kt, 1.0, share * force)
                    .force(0, 1, force)
                    .build();
                let branch = sweep(&model, &SolverOptions::default(), start, stop, &[]);
                let name = format!("kt {kt:e}, limit {share}, {start} to {stop}");
                let last = branch.points() - 1;
                let found = verify(&model, &branch, last, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
                let (error, estimate) = (found.response_error, branch.error_estimate_at(last).unwrap());
                println!(
                    "{name}: H {}, error {error:.1e}, estimate {estimate:.1e}",
                    branch.harmonics()
                );
                assert!(error <= 1e-5 + 1.5 * estimate, "{name}: {error:e}, {estimate:e}");
                assert!(estimate > 1e-3 || error <= 1e-3, "{name}: {error:e}");
            }
        }
    }
}
