//! Newton's matrix by forces and flexibility against the matrix that is filled.

use crate::condense::Condensed;
use crate::condense::test_chains::{chain, structure};
use crate::contact::Contact;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::krylov::{KrylovSystem, Lengths};
use crate::linalg::newton::linear_system::{Border, Forces, Jacobian, LinearSystem};
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
        assert!(problem.begin(&none).unwrap());
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
        // D⁻¹ J d = d + D⁻¹ G F d, and its opposite the other way.
        let mut exact: Vec<f64> = (0..n).map(|r| (0..n).map(|k| matrix[k * n + r] * d[k]).sum()).collect();
        problem.divide(&mut exact);
        let mut at_once: Vec<f64> = d.iter().map(|d| -d).collect();
        problem.subtract_response(&w, &mut at_once).unwrap();
        for (r, exact) in exact.iter().enumerate() {
            assert!((d[r] + by_groups[r] - exact).abs() < 1e-10, "{r}");
            assert!((at_once[r] + exact).abs() < 1e-10, "{r}");
        }
        assert!(w.iter().any(|w| w.abs() > 0.1));
    }
}

#[test]
fn sliders_in_gross_slip_are_solved_by_few_products_with_terms_of_low_rank() {
    let none = Interrupt::none();
    let model = chain(1, (0.01, 1e-3));
    // Motions of hundreds of times the range of a slider, and of about that range; too few unknowns for the terms, and enough.
    for size in [20.0, 0.2] {
        let products = [300, 330].map(|harmonics| {
            let options = SolverOptions {
                harmonics,
                ..SolverOptions::default()
            };
            let condensed = Condensed::new(&model, &options, (0.6, 0.9), &none).unwrap();
            let mut problem = HarmonicBalance::new(&condensed, 8, (0.6, 0.9).into(), 0, None, &none).unwrap();
            let (n, m) = (problem.unknowns(), condensed.set().packed_len());
            let u: Vec<f64> = (0..n)
                .map(|k| size * (1.7 * k as f64).sin() / (1 + k % m).pow(3) as f64)
                .collect();
            let mut at = Residual::new(n).unwrap();
            problem.evaluate(&u, 0.7, &mut at).unwrap();
            let column: Vec<f64> = (0..n).map(|k| (k as f64 * 0.9).cos()).collect();
            let row: Vec<f64> = (0..=n).map(|k| (k as f64 * 0.7 + 0.2).sin()).collect();
            let border = Border {
                column: &column,
                scales: (0.7, 3.0),
                row: &row,
            };
            let b: Vec<f64> = (0..=n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect();
            let lengths = Lengths {
                group: m,
                part: 3,
                middle: m,
                behind: 0,
            };
            let mut dense = DenseSystem::new(n).unwrap();
            let mut krylov = KrylovSystem::new(n, lengths, 400).unwrap();
            let mut found = Vec::new();
            for system in [&mut dense as &mut dyn LinearSystem, &mut krylov] {
                let mut x = b.clone();
                system.update(&mut problem, border, &none).unwrap();
                system.factor(&mut problem, &none).unwrap();
                assert!(system.solve(&mut problem, 1e-10, &mut x, &none).unwrap());
                found.push(x);
            }
            let largest = found[0].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let gap = found[0]
                .iter()
                .zip(&found[1])
                .fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
            assert!(gap < 1e-6 * largest, "{size}: {gap:e} of {largest:e}");
            assert_eq!(krylov.is_positive(), dense.is_positive(), "{size}");
            let mut x = b.clone();
            assert!(krylov.solve(&mut problem, 1e-4, &mut x, &none).unwrap());
            krylov.products()
        });
        assert!(3 * products[1] <= products[0], "{size}: {products:?} products");
    }
}
