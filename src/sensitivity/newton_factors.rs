//! Factors of Newton's matrix of a forced response, in which motions of contacts that stick have columns of the identity.
//!
//! With the stuck contacts as reference stiffness the force of such a contact is that of the reference but for a constant, so that its
//! motion follows from the others. In the order of the active and the other unknowns the matrix is (A 0; B I), and A alone is factorised.

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dot;
use crate::linalg::factors::lu::Lu;

/// Entry beside the diagonal, which is 1, up to which a column is that of the identity. Rounding of the stiffness of a contact that sticks.
/// Kind: rounding.
const NEWTON_FACTORS_ROUNDING: f64 = 64.0 * f64::EPSILON;

const CONTEXT: &str = "the factors of Newton's matrix";

/// Newton's matrix, column-major, with its factors.
pub(super) struct NewtonFactors {
    lu: Lu<f64>,
    /// The whole matrix, column-major.
    pub matrix: Vec<f64>,
    /// For each column, whether it differs from that of the identity.
    pub active: Vec<bool>,
    /// Indices of the active unknowns, to which the factors belong; and memory for their values.
    numbers: Vec<usize>,
    values: Vec<f64>,
}

impl NewtonFactors {
    /// Memory for n unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self {
            lu: Lu::new(n, 1)?,
            matrix: try_vec(n.saturating_mul(n), 0.0, CONTEXT)?,
            active: try_vec(n, true, CONTEXT)?,
            numbers: try_vec(n, 0, CONTEXT)?,
            values: try_vec(n, 0.0, CONTEXT)?,
        })
    }

    /// Factors the matrix that was filled in.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    pub fn factor(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.active.len();
        let mut order = 0;
        for (k, column) in self.matrix.chunks_exact(n.max(1)).enumerate() {
            if self.active[k] && !is_identity(column, k) {
                self.numbers[order] = k;
                order += 1;
            }
        }
        self.lu.set_order(order);
        let numbers = &self.numbers[..order];
        for (to, &k) in self.lu.matrix().chunks_exact_mut(order.max(1)).zip(numbers) {
            let from = &self.matrix[k * n..(k + 1) * n];
            if order == n {
                to.copy_from_slice(from);
                continue;
            }
            for (to, &i) in to.iter_mut().zip(numbers) {
                *to = from[i];
            }
        }
        self.lu.factor(interrupt)
    }

    /// Replaces b by the solution of J x = b.
    pub fn solve(&mut self, b: &mut [f64]) {
        let (n, order) = (b.len(), self.lu.order());
        if order == n {
            self.lu.solve(b);
            return;
        }
        let (numbers, values) = (&self.numbers[..order], &mut self.values[..order]);
        for (x, &k) in values.iter_mut().zip(numbers) {
            *x = b[k];
        }
        self.lu.solve(values);
        for &k in numbers {
            b[k] = 0.0;
        }
        for (&x, &k) in values.iter().zip(numbers) {
            for (b, a) in b.iter_mut().zip(&self.matrix[k * n..(k + 1) * n]) {
                *b -= a * x;
            }
        }
        for (&x, &k) in values.iter().zip(numbers) {
            b[k] = x;
        }
    }

    /// Replaces b by the solution of Jᵀ x = b.
    pub fn solve_transposed(&mut self, b: &mut [f64]) {
        let (n, order) = (b.len(), self.lu.order());
        if order == n {
            self.lu.solve_transposed(b);
            return;
        }
        let (numbers, values) = (&self.numbers[..order], &mut self.values[..order]);
        for (x, &k) in values.iter_mut().zip(numbers) {
            *x = core::mem::take(&mut b[k]);
        }
        for (x, &k) in values.iter_mut().zip(numbers) {
            *x -= dot(&self.matrix[k * n..(k + 1) * n], b);
        }
        self.lu.solve_transposed(values);
        for (x, &k) in values.iter().zip(numbers) {
            b[k] = *x;
        }
    }
}

/// Whether the k-th column is that of the identity up to rounding.
fn is_identity(column: &[f64], k: usize) -> bool {
    let is_small = |(i, a): (usize, &f64)| (a - f64::from(u8::from(i == k))).abs() <= NEWTON_FACTORS_ROUNDING;
    column.iter().enumerate().all(is_small)
}
