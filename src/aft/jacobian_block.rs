//! Blocks of a Jacobian: contributions of the Fourier coefficients of a piece or of a tangent stiffness to the
//! derivative of one direction's force by one direction's motion.

use crate::aft::toeplitz::Toeplitz;
use crate::fourier::HarmonicSet;
use crate::linalg::add_product;
use num_complex::Complex64;

/// A square block of a column-major matrix.
pub(super) struct Block<'a> {
    matrix: &'a mut [f64],
    /// Number of rows of the whole matrix.
    rows: usize,
    /// Index of the block's first entry.
    first: usize,
    /// Number of rows of the block.
    size: usize,
}

impl<'a> Block<'a> {
    /// Block ∂F_i/∂X_j of a matrix over `directions` directions, each with `size` numbers.
    pub(super) fn new(matrix: &'a mut [f64], directions: usize, size: usize, [i, j]: [usize; 2]) -> Self {
        let rows = directions * size;
        Self {
            matrix,
            rows,
            first: j * size * rows + i * size,
            size,
        }
    }

    /// Adds the outer product factor·g ⊗ c.
    pub(super) fn add_product(&mut self, factor: f64, g: &[f64], c: &[f64]) {
        for (j, c) in c.iter().enumerate() {
            let from = self.first + j * self.rows;
            let factor = factor * c;
            for (entry, g) in self.matrix[from..from + self.size].iter_mut().zip(g) {
                *entry += factor * g;
            }
        }
    }

    /// Adds the operator T(S) of a stiffness spectrum S.
    pub(super) fn add_toeplitz(&mut self, toeplitz: &Toeplitz) {
        toeplitz.add(&mut self.matrix[self.first..], self.rows);
    }
}

/// Packed g of a piece, gₕ = (2 − δ₀ₕ)·tₕ, from its transforms tₙ = (1/2π)∫ e^{−inτ} dτ.
pub(super) fn pack(set: &HarmonicSet, transform: &[Complex64], g: &mut [f64]) {
    let mean = usize::from(set.has_mean());
    if mean == 1 {
        g[0] = transform[0].re;
    }
    // The reduced numbers begin at 1.
    let pairs = g[mean..].as_chunks_mut::<2>().0.iter_mut();
    if set.stride() == 2 {
        for (pair, [_, t]) in pairs.zip(transform.as_chunks::<2>().0) {
            *pair = [2.0 * t.re, 2.0 * t.im];
        }
    } else {
        for (pair, t) in pairs.zip(transform[1..].iter().step_by(set.stride())) {
            *pair = [2.0 * t.re, 2.0 * t.im];
        }
    }
}

/// force ← offset + jacobian · motion.
pub(super) fn apply(jacobian: &[f64], motion: &[f64], offset: &[f64], force: &mut [f64]) {
    force.copy_from_slice(offset);
    add_product(1.0, jacobian, motion, force);
}

/// Adds s·tₙ, the share of a piece of tangent stiffness s, to the spectrum of the stiffness for every `stride`-th n.
pub(super) fn add_stiffness(spectrum: &mut [Complex64], stiffness: f64, transform: &[Complex64], stride: usize) {
    if stiffness != 0.0 && stride == 2 {
        // Their number is odd.
        let (pairs, last) = spectrum.as_chunks_mut::<2>();
        let (terms, of_last) = transform.as_chunks::<2>();
        for ([s, _], [t, _]) in pairs.iter_mut().zip(terms) {
            *s += stiffness * t;
        }
        for (s, t) in last.iter_mut().zip(of_last) {
            *s += stiffness * t;
        }
    } else if stiffness != 0.0 {
        for (s, t) in spectrum.iter_mut().zip(transform).step_by(stride) {
            *s += stiffness * t;
        }
    }
}
