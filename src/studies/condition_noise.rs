//! Noise of the conditions of a measured mode: the products of errors that linear conditions leave out.
//!
//! The conditions g = (diag λ + K(δ) − ω²) p = 0 hold exactly. Around an estimate with the errors dδ, dω and dp, the linear conditions
//! miss r = (K(dδ) − 2ω dω) dp. With dδ = L t of independent t, L Lᵀ the covariance of the pattern, dω = wᵀt beside a part of the variance
//! v that the mode has for itself, and the covariance Q of dp, the covariance of r is
//!
//! ```text
//! R = Σ_k B_k Q B_kᵀ + 4ω² v Q,   B_k = Σ_s L_sk A_s − 2ω w_k
//! ```
//!
//! as for independent errors. At first nothing is known but the noise of the data, and R is that of the product of both alone, 2σ s: it
//! is too large where many modes tell the pattern better than each of them, and too small where few modes leave it free.

use crate::error::{Result, try_vec};

const CONTEXT: &str = "the noise of conditions";

/// Variance, relative to the mean one, that is added to that of each condition. Kind: rounding; conditions that no error moves would
/// make the matrix singular, and rounding of the others' negative.
const LEAST_CONDITION_VARIANCE: f64 = 1e-6;

/// Covariance of the residuals of the conditions, with its Cholesky factor; both column-major.
pub(crate) struct ConditionNoise {
    covariance: Vec<f64>,
    factor: Vec<f64>,
    modes: usize,
}

/// Errors of the estimate of a mode, for the covariance of its conditions.
pub(crate) struct ModeErrors<'a> {
    /// Covariance Q of the errors dp of the shape, column-major.
    pub shape: &'a [f64],
    /// Change 2ω wₖ of the squared frequency by each independent part k of the pattern.
    pub by_pattern: &'a [f64],
    /// Variance 4ω² v of the squared frequency that does not stem from the pattern.
    pub own: f64,
}

impl ConditionNoise {
    /// Independent residuals, all of the same standard deviation.
    pub fn equal(modes: usize, deviation: f64) -> Result<Self> {
        let mut noise = Self {
            covariance: try_vec(modes * modes, 0.0, CONTEXT)?,
            factor: try_vec(modes * modes, 0.0, CONTEXT)?,
            modes,
        };
        for i in 0..modes {
            noise.covariance[(modes + 1) * i] = deviation * deviation;
            noise.factor[(modes + 1) * i] = deviation;
        }
        Ok(noise)
    }

    /// Covariance R of the residuals that the errors of a mode cause; `matrices` are Σ L_sk A_s, one after the other.
    pub fn of_products(modes: usize, matrices: &[f64], errors: &ModeErrors<'_>) -> Result<Self> {
        let mut noise = Self::equal(modes, 0.0)?;
        for (sum, q) in noise.covariance.iter_mut().zip(errors.shape) {
            *sum = errors.own * q;
        }
        let mut b = try_vec(modes * modes, 0.0, CONTEXT)?;
        let mut product = try_vec(modes * modes, 0.0, CONTEXT)?;
        for (a, shift) in matrices.chunks_exact(modes * modes).zip(errors.by_pattern) {
            b.copy_from_slice(a);
            for i in 0..modes {
                b[(modes + 1) * i] -= shift;
            }
            product.fill(0.0);
            add_product(&b, errors.shape, &mut product, modes);
            // B is symmetric.
            add_product(&product, &b, &mut noise.covariance, modes);
        }
        let mean = (0..modes).map(|i| noise.covariance[(modes + 1) * i]).sum::<f64>() / modes as f64;
        for i in 0..modes {
            noise.covariance[(modes + 1) * i] += LEAST_CONDITION_VARIANCE * mean;
        }
        noise.factor = lower_factor(&noise.covariance, modes)?;
        Ok(noise)
    }

    /// Multiplies the residuals by a factor, and thus the covariance by its square.
    pub fn scale(&mut self, factor: f64) {
        for v in &mut self.covariance {
            *v *= factor * factor;
        }
        for v in &mut self.factor {
            *v *= factor;
        }
    }

    /// Subtracts the covariance from the last block of a column-major matrix.
    pub fn subtract_from(&self, matrix: &mut [f64], order: usize) {
        let first = order - self.modes;
        for (j, column) in self.covariance.chunks_exact(self.modes).enumerate() {
            for (i, v) in column.iter().enumerate() {
                matrix[order * (first + j) + first + i] -= v;
            }
        }
    }

    /// Products Lᵀ μ of the multipliers μ: residuals over their standard deviations.
    pub fn weighted(&self, multipliers: &[f64], out: &mut [f64]) {
        for (column, out) in self.factor.chunks_exact(self.modes).zip(out) {
            *out = column.iter().zip(multipliers).map(|(l, m)| l * m).sum();
        }
    }
}

/// Adds the product A B of square column-major matrices to `out`.
fn add_product(a: &[f64], b: &[f64], out: &mut [f64], n: usize) {
    for (of_b, out) in b.chunks_exact(n).zip(out.chunks_exact_mut(n)) {
        for (column, b) in a.chunks_exact(n).zip(of_b) {
            for (out, a) in out.iter_mut().zip(column) {
                *out += a * b;
            }
        }
    }
}

/// Cholesky factor L of a covariance L Lᵀ, column-major with zeros above the diagonal. Columns whose pivot is lost in
/// rounding are zero.
pub(crate) fn lower_factor(covariance: &[f64], n: usize) -> Result<Vec<f64>> {
    let mut l = try_vec(n * n, 0.0, CONTEXT)?;
    l.copy_from_slice(covariance);
    for j in 0..n {
        let least = f64::EPSILON * covariance[(n + 1) * j].abs();
        let (before, from_j) = l.split_at_mut(n * j);
        let column = &mut from_j[..n];
        for k in before.chunks_exact(n) {
            for i in j..n {
                column[i] -= k[i] * k[j];
            }
        }
        column[..j].fill(0.0);
        if column[j] > least {
            let pivot = column[j].sqrt();
            for v in &mut column[j..] {
                *v /= pivot;
            }
        } else {
            column[j..].fill(0.0);
            column[j] = least.max(f64::MIN_POSITIVE).sqrt();
        }
    }
    Ok(l)
}
