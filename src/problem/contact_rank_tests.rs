//! Newton's matrix by forces and flexibility against the matrix that is filled.

use crate::condense::Condensed;
use crate::condense::test_chains::{chain, structure};
use crate::contact::Contact;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::{Forces, Jacobian};
use crate::options::SolverOptions;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::{Problem, Residual};

#[test]
fn forces_and_flexibility_are_the_matrix_of_sliders_and_of_friction_with_its_normal_motion() {
    let none = Interrupt::none();
    let mut plane = structure(1, (0.01, 1e-3));
    plane
        .add_contact(&Contact::friction_2d(
            [Some(1), Some(2)],
            [None, None],
            (9.0, 12.0),
            0.4,
            1.0,
        ))
        .unwrap();
    for (model, coupled) in [(chain(1, (0.01, 1e-3)), false), (plane, true)] {
        let options = SolverOptions {
            harmonics: 6,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, (0.6, 0.9), &none).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 8, (0.6, 0.9).into(), 0, None, &none).unwrap();
        let (n, m) = (problem.unknowns(), condensed.set().packed_len());
        let u: Vec<f64> = (0..n)
            .map(|k| 0.9 * (1.7 * k as f64).sin() / (1 + k % m) as f64)
            .collect();
        let mut at = Residual::new(n).unwrap();
        problem.evaluate(&u, 0.7, &mut at).unwrap();
        let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
        problem.fill(&mut matrix, &mut active).unwrap();
        let d: Vec<f64> = (0..n).map(|k| (2.3 * k as f64 + 0.4).cos()).collect();
        let (mut rows, mut w, mut largest, mut blocks) = (Vec::new(), vec![0.0; n], 0.0_f64, 0);
        let mut by_groups = vec![0.0; n];
        for force in 0..problem.groups() {
            let mut motions = Vec::new();
            largest = largest.max(problem.rows(force, &mut rows, &mut motions).unwrap());
            blocks = blocks.max(motions.len());
            let w = &mut w[force * m..(force + 1) * m];
            for (by, block) in motions.iter().zip(rows.chunks_exact(m * m)) {
                for (k, a) in block.iter().enumerate() {
                    w[k % m] += a * d[by * m + k / m];
                }
            }
            let mut response = vec![0.0; n];
            problem.response_of(force, w, &mut response).unwrap();
            by_groups.iter_mut().zip(&response).for_each(|(sum, r)| *sum += r);
        }
        assert!(largest >= 9.0 && (blocks > 1) == coupled, "{largest}, {blocks}");
        // J d = D d + G F d, and D⁻¹ J d the other way.
        let mut units = vec![1.0; n];
        problem.divide(&mut units);
        let mut at_once: Vec<f64> = d.iter().map(|d| -d).collect();
        problem.subtract_response(&w, &mut at_once).unwrap();
        for (r, by_groups) in by_groups.iter().enumerate() {
            let exact: f64 = (0..n).map(|k| matrix[k * n + r] * d[k]).sum();
            assert!((d[r] / units[r] + by_groups - exact).abs() < 1e-10, "{r}");
            assert!((at_once[r] / units[r] + exact).abs() < 1e-10, "{r}");
        }
        assert!(w.iter().any(|w| w.abs() > 0.1));
    }
}
