//! Chains with so many sliding contacts that Newton's matrix is solved by iteration. The truth is the same-H residual,
//! evaluated without condensation, and the other direction of the sweep.

use crate::common::models;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{Contact, Hooks, Model, Status, forced_residual, forced_response};
use num_complex::Complex64;

const N: usize = 36;
const HARMONICS: usize = 15;

/// A chain fixed at both ends, each mass on the ground through a slider with a limit of its own; a contact between
/// masses here and there.
fn chain(beta: f64) -> Model {
    let mass: Vec<f64> = (0..N).map(|i| 0.1 + 0.02 * (i as f64).cos()).collect();
    let slider = |i: usize| {
        let limit = 0.012 + 0.008 * (0.7 * i as f64).sin();
        let to = (i % 5 == 2).then_some((i + 3) % N);
        Contact::jenkins(i, to, 40.0, limit, 1.0)
    };
    let forces = [(3, 0.0), (17, 0.4), (30, 1.1)];
    models::chain(&mass, &[1.0e3; N + 1])
        .rayleigh(0.0, beta)
        .contacts((0..N).map(slider))
        .forces(forces.map(|(i, phase)| (i, 1, Complex64::from_polar(0.15, phase))))
        .build()
}

#[test]
fn points_solve_the_uncondensed_equations_and_both_directions_agree() {
    let lowest = 2.0 * (1e3_f64 / 0.1).sqrt() * (0.5 * std::f64::consts::PI / (N + 1) as f64).sin();
    for beta in [2e-3, 2e-4] {
        let model = chain(beta);
        let options = at_dof(17, harmonics(HARMONICS));
        let mut peaks = Vec::new();
        for (start, stop) in [(0.95, 1.15), (1.15, 0.95)] {
            let range = omega_range(start * lowest, stop * lowest);
            let branch = forced_response(&model, &options, &range, &mut Hooks::default()).unwrap();
            assert_eq!(branch.status(), Status::Ok);
            assert!(branch.reduction().unknowns > 500, "solved by iteration");
            peaks.push(branch.amplitude().iter().copied().fold(0.0, f64::max));
            for k in (0..branch.points()).step_by(7) {
                let mut x = vec![Complex64::ZERO; (HARMONICS + 1) * N];
                branch.harmonics_at(k, &mut x).unwrap();
                let mut r = x.clone();
                forced_residual(&model, &options, branch.omega()[k], &x, &mut r, None, None).unwrap();
                let largest = r.iter().fold(0.0_f64, |s, z| s.max(z.norm()));
                assert!(largest < 1e-9 * 0.15, "{beta:e}, point {k}: {largest:e}");
            }
        }
        let [up, down] = peaks[..] else { panic!() };
        assert!((up / down - 1.0).abs() < 1e-6, "{up} {down}");
    }
}
