//! Tests of products of nonlinear modes.

use super::*;
use crate::condense::Condensed;
use crate::condense::test_chains::chain;
use crate::contact::Contact;
use crate::interrupt::Interrupt;
use crate::options::{DampingForm, SolverOptions};
use crate::problem::epmc::{Gauge, LinearMode};
use crate::problem::static_state::StaticState;
use crate::problem::{Problem, Residual};

/// A chain with sliders, and with a stop too, whose mean is carried: the filled matrix is compared with differences elsewhere.
#[test]
fn products_and_blocks_are_those_of_the_filled_matrix() {
    let none = Interrupt::none();
    for (has_stop, form) in [(false, DampingForm::Mass), (true, DampingForm::Stiffness)] {
        let mut model = chain(1, (0.0, 1e-3));
        if has_stop {
            model
                .add_contact(&Contact::unilateral(None, Some(2), 3.0, 0.1))
                .unwrap();
        }
        let options = SolverOptions {
            harmonics: 5,
            ..SolverOptions::default()
        };
        let linear = LinearMode {
            omega: 1.1,
            damping: 1e-3,
            shape: (0..model.ndof()).map(|k| Complex64::new(1.0 + k as f64, 0.2)).collect(),
            rest: StaticState::default(),
        };
        let gauge = Gauge {
            contact: None,
            reference_dof: 3,
        };
        let (condensed, _) = Condensed::for_mode(&model, &options, (form, false), &linear.shape, &none).unwrap();
        let mut problem = Epmc::new(&condensed, &gauge, &linear, 0, &none).unwrap();
        let n = problem.size();
        let (m, groups) = (problem.group(), condensed.coordinates());
        assert_eq!((n, has_stop), (groups * m + BEHIND, m % 2 == 1));
        let point = |seed: f64| (0..n).map(|k| (1.7 * k as f64 + seed).sin()).collect::<Vec<f64>>();
        let mut at = Residual::new(n).unwrap();
        problem.evaluate(&point(0.0), 0.3, &mut at).unwrap();
        let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
        problem.fill(&mut matrix, &mut active).unwrap();
        let size = matrix.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        for part in [m % 2 + 2, m] {
            let order = groups * part + BEHIND;
            let (mut block, mut active) = (vec![0.0; order * order], vec![true; order]);
            problem.fill_block(part, &mut block, &mut active).unwrap();
            let inner: Vec<usize> = (0..n).filter(|k| *k >= groups * m || k % m < part).collect();
            for (q, &column) in inner.iter().enumerate() {
                for (p, &row) in inner.iter().enumerate() {
                    let (a, b) = (block[q * order + p], matrix[column * n + row]);
                    assert!((a - b).abs() < 1e-13 * size, "{part}: {row}, {column}: {a} {b}");
                }
            }
        }
        for at in (m % 2..m).step_by(2) {
            let mut pair = vec![Complex64::ZERO; groups * groups];
            problem.fill_pair(at, &mut pair);
            for (k, z) in pair.iter().enumerate() {
                let (row, column) = (k % groups * m + at, k / groups * m + at);
                let a = |i: usize, j: usize| matrix[(column + j) * n + row + i];
                let mean = 0.5 * Complex64::new(a(0, 0) + a(1, 1), a(1, 0) - a(0, 1));
                assert!((z - mean).norm() < 1e-13 * size, "pair at {at}: {z} {mean}");
            }
        }
        // The matrix that was kept serves after an evaluation elsewhere.
        problem.keep().unwrap();
        problem.evaluate(&point(0.7), 0.4, &mut at).unwrap();
        let (d, mut product) = (point(2.0), vec![0.0; n]);
        problem.multiply(&d, &mut product).unwrap();
        for (row, product) in product.iter().enumerate() {
            let sum: f64 = (0..n).map(|k| matrix[k * n + row] * d[k]).sum();
            assert!((product - sum).abs() < 1e-12 * size, "{row}: {product} {sum}");
        }
        let mut other = vec![0.0; n * n];
        problem.fill(&mut other, &mut active).unwrap();
        let moved = matrix.iter().zip(&other).any(|(a, b)| (a - b).abs() > 1e-6 * size);
        assert!(moved, "both points have one matrix");
    }
}
