//! Solutions that lie in a continuum: the bordered matrix K then has motions without change of the residual besides the branch,
//! such as the phase between two bodies that nothing couples. Rounding over a pivot that is rounding, too, would set the step
//! along them.
//!
//! With z = K⁻¹ b for a generic b and v = z/|z|, K v is b/|z|, which is rounding. The matrix K + s b vᵀ is regular; where the right
//! side has no more than rounding along the left null vector, its solution solves K x = r with vᵀ x = 0: the shortest one.

use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::bordered::Bordered;
use crate::linalg::{norm, vectors::dot};

/// Singular value, over those of a regular matrix, below which a motion belongs to a continuum. Newton's method ends with a relative
/// residual of 1e-10 or less, and off the solution the singular value is as large as the residual.
const SINGULAR: f64 = 1e-5;

/// Most motions besides the branch: two unknowns of phase and amplitude of each of two further bodies.
const MOST: usize = 4;

const CONTEXT: &str = "the linear system";

/// A matrix completed to a regular one.
#[derive(Default)]
pub(super) struct Completed {
    matrix: Vec<f64>,
    column: Vec<f64>,
    active: Vec<bool>,
    generic: Vec<f64>,
    /// The motions v that were found last: determinants keep their sign where these keep their sense.
    found: Vec<Vec<f64>>,
}

/// The parts of K, as in [`crate::linalg::bordered::Parts`].
pub(super) type Matrix<'a> = crate::linalg::bordered::Parts<'a>;

impl Completed {
    /// Completes the matrix `k`, whose factors are at hand if `factored`, and factors it.
    ///
    /// # Errors
    /// `Singular`; `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(
        &mut self,
        factors: &mut Bordered,
        k: &Matrix<'_>,
        factored: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = k.column.len();
        let (u, p) = k.scales;
        let mut copied = false;
        if !factored {
            // A pivot of zero instead of one that is rounding.
            self.copy(k)?;
            copied = true;
            let size = f64::EPSILON * norm(k.jacobian) / (n.max(1) as f64).sqrt();
            self.active.fill(true);
            for (j, column) in self.matrix.chunks_exact_mut(n.max(1)).enumerate() {
                column[j] += size;
            }
            factors.factor(&self.matrix, &self.column, &self.active, k.scales, k.row, interrupt)?;
        }
        for round in 0..MOST {
            let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
            self.generic.clear();
            for i in 0..n {
                try_push(
                    &mut self.generic,
                    (1.0 + 1.7 * i as f64 + 2.3 * round as f64).sin(),
                    CONTEXT,
                )?;
            }
            let size = norm(&self.generic);
            for (v, b) in v.iter_mut().zip(&mut self.generic) {
                *b /= size;
                *v = *b;
            }
            factors.solve(&mut v);
            let size = norm(&v);
            if size * u * SINGULAR < 1.0 || !size.is_finite() {
                self.found.truncate(round);
                return Ok(());
            }
            let sense = match self.found.get(round) {
                Some(before) if before.len() == v.len() && dot(before, &v) < 0.0 => -1.0,
                _ => 1.0,
            };
            for v in &mut v {
                *v *= sense / size;
            }
            if !copied {
                self.copy(k)?;
                copied = true;
            }
            self.active.fill(true);
            for (column, v) in self.matrix.chunks_exact_mut(n.max(1)).zip(&v) {
                for (a, b) in column.iter_mut().zip(&self.generic) {
                    *a += b * v;
                }
            }
            for (a, b) in self.column.iter_mut().zip(&self.generic) {
                *a += b * v[n] * (u / p);
            }
            if let Some(known) = self.found.get_mut(round) {
                *known = v;
            } else {
                try_push(&mut self.found, v, CONTEXT)?;
            }
            factors.factor(&self.matrix, &self.column, &self.active, k.scales, k.row, interrupt)?;
        }
        Ok(())
    }

    fn copy(&mut self, k: &Matrix<'_>) -> Result<()> {
        if self.matrix.len() != k.jacobian.len() {
            self.matrix = try_vec(k.jacobian.len(), 0.0, CONTEXT)?;
            self.column = try_vec(k.column.len(), 0.0, CONTEXT)?;
            self.active = try_vec(k.column.len(), true, CONTEXT)?;
        }
        self.matrix.copy_from_slice(k.jacobian);
        self.column.copy_from_slice(k.column);
        self.active.copy_from_slice(k.active);
        Ok(())
    }
}
