//! Blocks of a Jacobian: what Fourier coefficients of a piece or of a tangent stiffness add to the
//! derivative of one direction's force by one direction's motion.

use crate::harmonics::HarmonicSet;
use num_complex::Complex64;

/// A square block of a column-major matrix.
pub(super) struct Block<'a> {
    matrix: &'a mut [f64],
    /// Rows of the matrix.
    rows: usize,
    /// Place of the block's first entry.
    first: usize,
    /// Rows of the block.
    size: usize,
}

impl<'a> Block<'a> {
    /// ∂F_i/∂X_j of a matrix over `directions` directions.
    pub(super) fn new(matrix: &'a mut [f64], directions: usize, size: usize, [i, j]: [usize; 2]) -> Self {
        let rows = directions * size;
        Self {
            matrix,
            rows,
            first: j * size * rows + i * size,
            size,
        }
    }

    /// Adds factor·g ⊗ c.
    pub(super) fn add_product(&mut self, factor: f64, g: &[f64], c: &[f64]) {
        for (j, c) in c.iter().enumerate() {
            let from = self.first + j * self.rows;
            let factor = factor * c;
            for (entry, g) in self.matrix[from..from + self.size].iter_mut().zip(g) {
                *entry += factor * g;
            }
        }
    }

    /// Adds T(S), which maps Xₘ to Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ).
    pub(super) fn add_toeplitz(&mut self, set: &HarmonicSet, s: &[Complex64]) {
        let mean = usize::from(set.has_mean());
        let (rows, first) = (self.rows, self.first);
        let mut add = |row: usize, column: usize, value: f64| self.matrix[first + column * rows + row] += value;
        if mean == 1 {
            add(0, 0, s[0].re);
            for k in 0..set.oscillating() {
                let sp = s[set.reduced(k)];
                let at = 1 + 2 * k;
                // Row 0: F₀ = Re Σ conj(Sₘ)·Xₘ; column 0: Fₕ = 2 Sₕ X₀.
                add(0, at, sp.re);
                add(0, at + 1, sp.im);
                add(at, 0, 2.0 * sp.re);
                add(at + 1, 0, 2.0 * sp.im);
            }
        }
        for c in 0..set.oscillating() {
            let pc = set.reduced(c);
            let (re_column, im_column) = (mean + 2 * c, mean + 2 * c + 1);
            for r in 0..set.oscillating() {
                let pr = set.reduced(r);
                let minus = if pr >= pc { s[pr - pc] } else { s[pc - pr].conj() };
                let plus = s[pr + pc];
                let row = mean + 2 * r;
                add(row, re_column, minus.re + plus.re);
                add(row + 1, re_column, minus.im + plus.im);
                add(row, im_column, plus.im - minus.im);
                add(row + 1, im_column, minus.re - plus.re);
            }
        }
    }
}

/// Packed g of a piece, gₕ = (2 − δ₀ₕ)·tₕ, from its transforms tₙ = (1/2π)∫ e^{−inτ} dτ.
pub(super) fn pack(set: &HarmonicSet, transform: &[Complex64], g: &mut [f64]) {
    let mean = usize::from(set.has_mean());
    if mean == 1 {
        g[0] = transform[0].re;
    }
    for (k, pair) in g[mean..].chunks_exact_mut(2).enumerate() {
        let t = 2.0 * transform[set.reduced(k)];
        pair[0] = t.re;
        pair[1] = t.im;
    }
}

/// force = offset + jacobian · motion.
pub(super) fn apply(jacobian: &[f64], motion: &[f64], offset: &[f64], force: &mut [f64]) {
    force.copy_from_slice(offset);
    for (column, x) in jacobian.chunks_exact(force.len()).zip(motion) {
        for (f, j) in force.iter_mut().zip(column) {
            *f += j * x;
        }
    }
}

/// Adds s·tₙ, the share of a piece of tangent stiffness s, to the spectrum of the stiffness.
pub(super) fn add_stiffness(spectrum: &mut [Complex64], stiffness: f64, transform: &[Complex64]) {
    if stiffness != 0.0 {
        for (s, t) in spectrum.iter_mut().zip(transform) {
            *s += stiffness * t;
        }
    }
}
