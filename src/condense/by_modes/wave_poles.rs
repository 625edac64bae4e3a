//! Poles of one wave of the structure under any damping, of which the flexibility at any frequency is a sum; see
//! [`crate::condense::by_modes::quadratic_poles`], which computes them.

use crate::condense::by_modes::wave_modes::NEAR_RESONANCE;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;
use std::sync::Arc;

/// Poles of one wave under any damping.
#[derive(Debug)]
pub struct WavePoles {
    /// Data by which the wave is recognised: Z_κ at zero frequency with its κ, M, C, and the harmonic where a speed
    /// is tied to the frequency.
    pub(crate) key: Key,
    /// μ = 1/λ, rising in modulus; 0 for a motion without mass.
    pub(crate) values: Vec<Complex64>,
    /// Vectors −x/λ and l̄ of each pole, n numbers each: the flexibility is Σ (−x/λ) l/(1 − s μ).
    pub(crate) shapes: Vec<Complex64>,
    pub(crate) adjoints: Vec<Complex64>,
}

#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) modal: Option<Arc<Vec<SparseVector>>>,
    pub(crate) matrices: (Arc<Csc>, Arc<Vec<Complex64>>, Arc<Vec<Complex64>>),
    pub(crate) tied: Option<usize>,
}

impl WavePoles {
    /// Computes 1/(1 − iν μ) of all poles; `false` where a denominator is small.
    pub(crate) fn invert(&self, nu: f64, inverse: &mut [Complex64]) -> bool {
        let mut least = f64::INFINITY;
        for (inverse, mu) in inverse.iter_mut().zip(&self.values) {
            let d = 1.0 - Complex64::new(0.0, nu) * mu;
            let size = 1.0 + nu.abs() * mu.norm();
            least = least.min(d.norm_sqr() / (size * size));
            *inverse = d.inv();
        }
        least > NEAR_RESONANCE * NEAR_RESONANCE
    }
}
