//! Solutions that lie in a continuum. The bordered matrix K is singular at each of them: there are motions besides the branch that do
//! not change the residual, such as the phase between two bodies that nothing couples. A step along them would be rounding over a
//! pivot that is rounding.
//!
//! With z = K⁻¹ b for a generic b and v = z/|z|, K v = b/|z| is nearly zero. The matrix K + s b vᵀ is regular. The right side has no
//! more than the square of a residual along the left null vector, so that the solution x has vᵀ x = 0: it is the shortest one.

use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::newton::bordered::{Bordered, Parts};
use crate::linalg::{norm, vectors::dot};

/// Singular value, relative to the unknowns' unit, below which a motion belongs to a continuum. Off the solutions it is as large as the
/// residual, which predictions leave as large as 1e-6.
/// Kind: tuned; measured on: not recorded.
const CONTINUUM: f64 = 1e-5;

/// Most motions besides the branch: phase and amplitude of each of two further bodies.
/// Kind: cap.
const MOST_MOTIONS: usize = 4;

const CONTEXT: &str = "the linear system";

/// A singular matrix completed to a regular one.
#[derive(Default)]
pub(super) struct Completed {
    matrix: Vec<f64>,
    column: Vec<f64>,
    active: Vec<bool>,
    /// Generic vector b.
    generic: Vec<f64>,
    is_copied: bool,
    /// Motions v found last. Determinants keep their sign as long as these keep their sense.
    found: Vec<Vec<f64>>,
}

impl Completed {
    /// Completes the matrix `k` and factors it; `factored`: `factors` already holds the factors of `k`.
    ///
    /// # Errors
    /// `Singular`; `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(
        &mut self,
        factors: &mut Bordered,
        k: &Parts<'_>,
        factored: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = k.column.len();
        self.is_copied = false;
        if !factored {
            // A pivot of zero instead of one that is rounding.
            self.copy(k)?;
            let size = f64::EPSILON * norm(k.jacobian) / (n.max(1) as f64).sqrt();
            for (j, column) in self.matrix.chunks_exact_mut(n.max(1)).enumerate() {
                column[j] += size;
            }
            self.factor_copy(factors, k, interrupt)?;
        }
        for round in 0..MOST_MOTIONS {
            let Some(v) = self.motion(factors, k, round)? else {
                self.found.truncate(round);
                break;
            };
            self.copy(k)?;
            for (column, v) in self.matrix.chunks_exact_mut(n.max(1)).zip(&v) {
                for (a, b) in column.iter_mut().zip(&self.generic) {
                    *a += b * v;
                }
            }
            let in_units = v[n] * (k.scales.0 / k.scales.1);
            for (a, b) in self.column.iter_mut().zip(&self.generic) {
                *a += b * in_units;
            }
            if let Some(known) = self.found.get_mut(round) {
                *known = v;
            } else {
                try_push(&mut self.found, v, CONTEXT)?;
            }
            self.factor_copy(factors, k, interrupt)?;
        }
        Ok(())
    }

    /// Unit motion v that a factored matrix maps to nearly zero; `None` where the matrix is regular.
    fn motion(&mut self, factors: &mut Bordered, k: &Parts<'_>, round: usize) -> Result<Option<Vec<f64>>> {
        let n = k.column.len();
        if self.generic.len() != n {
            self.generic = try_vec(n, 0.0, CONTEXT)?;
            self.found.clear();
        }
        for (i, b) in self.generic.iter_mut().enumerate() {
            *b = (1.0 + (1.7 + 0.9 * round as f64) * i as f64).sin();
        }
        let size = norm(&self.generic);
        let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
        for (v, b) in v.iter_mut().zip(&mut self.generic) {
            *b /= size;
            *v = *b;
        }
        factors.solve(&mut v);
        let size = norm(&v);
        if size * k.scales.0 * CONTINUUM < 1.0 || !size.is_finite() {
            return Ok(None);
        }
        let turns = self.found.get(round).is_some_and(|before| dot(before, &v) < 0.0);
        for v in &mut v {
            *v *= if turns { -1.0 } else { 1.0 } / size;
        }
        Ok(Some(v))
    }

    /// Copies the matrix, unless a copy exists.
    fn copy(&mut self, k: &Parts<'_>) -> Result<()> {
        if core::mem::replace(&mut self.is_copied, true) {
            return Ok(());
        }
        if self.matrix.len() != k.jacobian.len() {
            self.matrix = try_vec(k.jacobian.len(), 0.0, CONTEXT)?;
            self.column = try_vec(k.column.len(), 0.0, CONTEXT)?;
            self.active = try_vec(k.column.len(), true, CONTEXT)?;
        }
        self.matrix.copy_from_slice(k.jacobian);
        self.column.copy_from_slice(k.column);
        Ok(())
    }

    /// Factors the copy, none of whose columns counts as that of the identity any more.
    fn factor_copy(&self, factors: &mut Bordered, k: &Parts<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        factors.factor(&self.matrix, &self.column, &self.active, k.scales, k.row, interrupt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J = A B with few columns in A is singular along several motions; the solution has no part in them.
    #[test]
    fn the_solution_of_a_singular_matrix_is_the_shortest_one() {
        const N: usize = 9;
        for (rank, scales) in [(9, (1.0, 1.0)), (8, (1.0, 1.0)), (7, (0.6, 3.0)), (5, (1.0, 1.0))] {
            let a = |i: usize, k: usize| (1.0 + 0.7 * i as f64 + 2.1 * (i * k) as f64 + 0.9 * (k * k) as f64).sin();
            let b = |k: usize, j: usize| (2.0 + 1.9 * j as f64 + 2.3 * (j * k) as f64 + 0.4 * (k * k) as f64).cos();
            let product = |i: usize, j: usize| (0..rank).map(|k| a(i, k) * b(k, j)).sum::<f64>();
            let jacobian: Vec<f64> = (0..N * N).map(|at| product(at % N, at / N)).collect();
            // The parameter changes the residual within the range of J, as along a branch.
            let column: Vec<f64> = (0..N).map(|i| product(i, 2) + 0.5 * product(i, 7)).collect();
            let row: Vec<f64> = (0..=N).map(|j| (0.4 * j as f64 + 0.1).sin()).collect();
            let k = Parts {
                jacobian: &jacobian,
                column: &column,
                active: &[true; N],
                scales,
                row: &row,
            };
            let mut factors = Bordered::new(N).unwrap();
            let factored = factors.factor(&jacobian, &column, &[true; N], scales, &row, &Interrupt::none());
            let mut completed = Completed::default();
            let none = Interrupt::none();
            completed.factor(&mut factors, &k, factored.is_ok(), &none).unwrap();
            // K has one column more than J, so that as many motions are left as J lacks in rank.
            assert_eq!(completed.found.len(), N - rank, "{rank}");
            let mut x = vec![0.0; N + 1];
            x[N] = 1.0;
            factors.solve(&mut x);
            let size = norm(&x);
            for (i, column) in column.iter().enumerate() {
                let moved: f64 = (0..N).map(|j| product(i, j) * scales.0 * x[j]).sum();
                let residual = moved + column * scales.1 * x[N];
                assert!(residual.abs() < 1e-9 * size, "{rank}: row {i}, {residual:e}");
            }
            assert!((dot(&row, &x) - 1.0).abs() < 1e-9, "{rank}");
            for v in &completed.found {
                assert!(dot(v, &x).abs() < 1e-5 * size, "{rank}: {:e}", dot(v, &x));
            }
        }
    }
}
