//! The border of a matrix [B s_u, r s_p; tᵀ], eliminated with factors of B.

use crate::error::{Result, try_vec};
use crate::linalg::dot;
use crate::linalg::newton::linear_system::Border;

/// Solved column z = B⁻¹ r, row t, units, and pivot t_p − s_p/s_u t_u z.
pub(super) struct EliminatedBorder {
    column: Vec<f64>,
    row: Vec<f64>,
    scales: (f64, f64),
    rest: f64,
}

impl EliminatedBorder {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        const CONTEXT: &str = "the border of a linear system";
        Ok(Self {
            column: try_vec(n, 0.0, CONTEXT)?,
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            scales: (1.0, 1.0),
            rest: 1.0,
        })
    }

    /// The column r. The caller must solve for B⁻¹ r in the same memory, and pass it to [`Self::set`].
    pub fn column(&mut self, border: Border<'_>) -> Vec<f64> {
        let mut column = core::mem::take(&mut self.column);
        column.copy_from_slice(border.column);
        column
    }

    /// Stores a border with its solved column.
    pub fn set(&mut self, border: Border<'_>, solved: Vec<f64>) {
        self.column = solved;
        self.row.copy_from_slice(border.row);
        self.scales = border.scales;
        let n = self.column.len();
        self.rest = self.row[n] - self.scales.1 / self.scales.0 * dot(&self.row[..n], &self.column);
    }

    /// Solves with the whole matrix, for a v whose first numbers already hold the solution with B.
    pub fn solve(&self, v: &mut [f64]) {
        let n = self.column.len();
        let (unit, of_parameter) = self.scales;
        let left = v[n] - dot(&self.row[..n], &v[..n]) / unit;
        let along = if self.rest == 0.0 { left } else { left / self.rest };
        for (x, z) in v[..n].iter_mut().zip(&self.column) {
            *x = (*x - z * (of_parameter * along)) / unit;
        }
        v[n] = along;
    }

    /// Whether the determinants of the whole matrix and of B have the same sign.
    pub fn keeps_sign(&self) -> bool {
        self.rest >= 0.0
    }
}
