//! The bordered system [J r; tᵀ] of arc-length continuation: one factorisation serves the Newton
//! step and the next tangent.

use super::lu::Lu;
use crate::error::Result;

/// LU factors of the (n + 1) × (n + 1) matrix [J r; tᵀ].
#[derive(Clone, Debug)]
pub struct Bordered {
    lu: Lu<f64>,
}

impl Bordered {
    /// Memory for `n` unknowns and one parameter.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self { lu: Lu::new(n + 1)? })
    }

    /// Factors [J·u_scale, r·p_scale; row] with J (n × n, column-major) and the column r.
    ///
    /// # Errors
    /// `Singular`.
    pub fn factor(&mut self, jacobian: &[f64], column: &[f64], u_scale: f64, p_scale: f64, row: &[f64]) -> Result<()> {
        let m = self.lu.order();
        let n = m - 1;
        let a = self.lu.matrix();
        for j in 0..n {
            for i in 0..n {
                a[j * m + i] = jacobian[j * n + i] * u_scale;
            }
            a[j * m + n] = row[j];
        }
        for i in 0..n {
            a[n * m + i] = column[i] * p_scale;
        }
        a[n * m + n] = row[n];
        self.lu.factor()
    }

    /// Solves in place for a right-hand side of n + 1 numbers.
    pub fn solve(&self, b: &mut [f64]) {
        self.lu.solve(b);
    }
}
