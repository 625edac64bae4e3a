//! Tests of factors by terms against factors of the whole matrix.

use crate::interrupt::Interrupt;
use crate::linalg::newton::bordered::{Bordered, Parts};
use crate::linalg::norm;
use num_complex::Complex64;

/// A complex diagonal with terms, and its border.
struct Case {
    n: usize,
    diagonal: Vec<Complex64>,
    jacobian: Vec<f64>,
    active: Vec<bool>,
    column: Vec<f64>,
    row: Vec<f64>,
}

fn wave(k: usize, phase: f64) -> f64 {
    (k as f64 * 0.37 + phase).sin()
}

impl Case {
    /// With so many terms, each a tenth of the one before, after `equal` of the same size.
    fn new(n: usize, terms: usize, equal: usize) -> Self {
        let diagonal: Vec<Complex64> = (0..n / 2)
            .map(|k| Complex64::new(1.0 + 0.5 * wave(k, 0.1), 0.3 * wave(k, 0.8)))
            .collect();
        let mut jacobian = vec![0.0; n * n];
        for (k, d) in diagonal.iter().enumerate() {
            let at = 2 * k * n + 2 * k;
            (jacobian[at], jacobian[at + 1]) = (d.re, d.im);
            (jacobian[at + n], jacobian[at + n + 1]) = (-d.im, d.re);
        }
        for term in 0..terms {
            let size = 0.1_f64.powi(term.saturating_sub(equal) as i32) / (n as f64).sqrt();
            for j in 0..n {
                for i in 0..n {
                    jacobian[j * n + i] += size * wave(i * (term + 1), 0.3) * wave(j * (2 * term + 1), 1.1);
                }
            }
        }
        Self {
            n,
            diagonal,
            jacobian,
            active: vec![true; n],
            column: (0..n).map(|k| wave(k, 0.5)).collect(),
            row: (0..=n).map(|k| wave(k, 0.2)).collect(),
        }
    }

    fn parts(&self) -> Parts<'_> {
        Parts {
            jacobian: &self.jacobian,
            column: &self.column,
            active: &self.active,
            scales: (0.7, 3.0),
            row: &self.row,
        }
    }

    fn factored_whole(&self) -> Bordered {
        let mut whole = Bordered::new(self.n).unwrap();
        let k = self.parts();
        let border = (k.scales, k.row);
        whole
            .factor(k.jacobian, k.column, k.active, border.0, border.1, &Interrupt::none())
            .unwrap();
        whole
    }

    fn factored_by_terms(&self) -> Option<Bordered> {
        let mut by_terms = Bordered::new(self.n).unwrap();
        let found = by_terms.factor_near(&self.parts(), &self.diagonal, &Interrupt::none());
        found.unwrap().then_some(by_terms)
    }
}

#[test]
fn terms_solve_as_factors_of_the_whole_matrix_do() {
    for (n, terms, equal) in [(80, 1, 0), (96, 20, 3), (128, 24, 12), (128, 0, 0)] {
        let mut case = Case::new(n, terms, equal);
        // Near a fold J alone is singular: a term takes the first pair of the diagonal away.
        for is_fold in [false, true] {
            if is_fold && terms > 0 {
                for i in 0..n {
                    case.jacobian[i] = if i == 7 { 1e-13 } else { 0.0 };
                }
            }
            let Some(mut by_terms) = case.factored_by_terms() else {
                assert_eq!(terms, 0, "{n}, {terms}");
                continue;
            };
            assert!(by_terms.is_near());
            let mut whole = case.factored_whole();
            assert!(!whole.is_near());
            for phase in 0..4 {
                let b: Vec<f64> = (0..=n).map(|k| wave(3 * k, f64::from(phase))).collect();
                let (mut x, mut expected) = (b.clone(), b);
                assert!(by_terms.refine(&case.parts(), 1e-13, &mut x));
                whole.solve(&mut expected);
                for (a, b) in x.iter().zip(&expected) {
                    assert!((a - b).abs() < 1e-11 * norm(&expected), "{n}, {terms}: {a} {b}");
                }
            }
            assert_eq!(by_terms.is_positive(), whole.is_positive());
        }
    }
}

#[test]
fn the_sign_of_the_determinant_is_that_of_the_whole_matrix() {
    let mut signs = [0, 0];
    for k in 0..40 {
        let mut case = Case::new(80, 8, 4);
        case.row[80] = 5.0 * wave(k, 0.0);
        case.column[3] = 20.0 * wave(7 * k, 0.4);
        let by_terms = case.factored_by_terms().unwrap();
        let is_positive = case.factored_whole().is_positive();
        assert_eq!(by_terms.is_positive(), is_positive, "{k}");
        signs[usize::from(is_positive)] += 1;
    }
    assert!(signs.iter().all(|count| *count > 4), "{signs:?}");
}

#[test]
fn too_many_terms_and_broken_numbers_are_left_to_the_whole_matrix() {
    assert!(Case::new(96, 60, 60).factored_by_terms().is_none());
    let mut broken = Case::new(96, 4, 0);
    broken.jacobian.fill(f64::NAN);
    assert!(broken.factored_by_terms().is_none());
    let mut singular = Case::new(96, 4, 0);
    singular.diagonal[5] = Complex64::ZERO;
    assert!(singular.factored_by_terms().is_none());
}
