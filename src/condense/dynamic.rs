//! The dynamic stiffness Z_κ of one harmonic after the other, factorised.
//!
//! Z_κ = K + Wᴴ κ W − h²ω²M + ihωC, and in a nonlinear mode of damping ratio D the artificial
//! damping −2DωM ẋ (mass type) or −ζK ẋ with D = ζω/2 (stiffness type), which adds −2ihDω²M or
//! −2ihDK.

use super::{Artificial, Condensed, HarmonicBlock};
use crate::error::{Error, Result, fail, try_push};
use crate::linalg::factor::Factor;
use crate::linalg::sparse::Csc;
use num_complex::Complex64;

/// By what a derivative of Z_κ is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    Omega,
    Damping,
}

/// Memory for factorising Z_κ of one harmonic after the other.
pub struct DynamicStiffness {
    factor: Factor,
    /// Z_κ per harmonic.
    z: Vec<Csc>,
}

impl DynamicStiffness {
    /// Memory for a condensed model, solving up to `columns` right-hand sides at a time.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, columns: usize) -> Result<Self> {
        let mut z = Vec::new();
        for block in condensed.blocks() {
            try_push(&mut z, block.reference.try_clone()?, "the dynamic stiffness")?;
        }
        let Some(first) = condensed.blocks().first() else {
            return fail!(Internal, "no harmonic is carried");
        };
        Ok(Self {
            factor: Factor::new(&first.reference, columns)?,
            z,
        })
    }

    /// Factors Z_κ of the i-th carried harmonic at a frequency, which may be complex, and a damping
    /// ratio.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that no contact feels.
    pub fn factor(&mut self, condensed: &Condensed, i: usize, omega: Complex64, damping: f64) -> Result<()> {
        let block = &condensed.blocks()[i];
        let z = &mut self.z[i];
        for (at, z) in z.values.iter_mut().enumerate() {
            *z = entry(block, at, omega, damping);
        }
        self.factor.factor(z).map_err(|e| at_harmonic(e, block, omega.re))
    }

    /// Solves Z B = B (or Zᵀ) in place with the factors at hand, those of the i-th harmonic at
    /// `omega`.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub fn solve(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        b: &mut [Complex64],
        transposed: bool,
    ) -> Result<()> {
        self.factor
            .solve(b, transposed)
            .map_err(|e| at_harmonic(e, &condensed.blocks()[i], omega))
    }
}

/// An entry of Z_κ.
fn entry(block: &HarmonicBlock, at: usize, omega: Complex64, damping: f64) -> Complex64 {
    let hw = block.number as f64 * omega;
    let z = block.reference.values[at] + Complex64::I * hw * block.damping[at] - hw * hw * block.mass[at];
    if damping == 0.0 {
        return z;
    }
    z + damping * slope(block, at, omega, damping, By::Damping)
}

/// An entry of ∂Z/∂ω or ∂Z/∂D.
fn slope(block: &HarmonicBlock, at: usize, omega: Complex64, damping: f64, by: By) -> Complex64 {
    let h = block.number as f64;
    let (c, m) = (block.damping[at], block.mass[at]);
    match (by, &block.artificial) {
        (By::Omega, Artificial::Mass) => {
            Complex64::I * h * c - 2.0 * h * h * omega * m - Complex64::I * (4.0 * h * damping) * omega * m
        }
        (By::Omega, _) => Complex64::I * h * c - 2.0 * h * h * omega * m,
        (By::Damping, Artificial::None) => Complex64::ZERO,
        (By::Damping, Artificial::Mass) => -2.0 * h * Complex64::I * omega * omega * m,
        (By::Damping, Artificial::Stiffness(k)) => -2.0 * h * Complex64::I * k[at],
    }
}

/// y += ∂Z x or y += ∂Zᵀ x for the i-th carried harmonic.
#[allow(clippy::too_many_arguments)]
pub(super) fn add_slope_product(
    condensed: &Condensed,
    i: usize,
    (omega, damping): (Complex64, f64),
    by: By,
    transposed: bool,
    x: &[Complex64],
    y: &mut [Complex64],
) {
    let block = &condensed.blocks()[i];
    let pattern = &block.reference;
    for j in 0..x.len() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            let k = pattern.row_idx[at];
            let (to, from) = if transposed { (j, k) } else { (k, j) };
            y[to] += slope(block, at, omega, damping, by) * x[from];
        }
    }
}

/// left·Z right at a complex frequency; nothing is conjugated.
pub(super) fn product(
    condensed: &Condensed,
    i: usize,
    omega: Complex64,
    left: &[Complex64],
    right: &[Complex64],
) -> Complex64 {
    let block = &condensed.blocks()[i];
    let pattern = &block.reference;
    let mut sum = Complex64::ZERO;
    for (j, x) in right.iter().enumerate() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            sum += left[pattern.row_idx[at]] * entry(block, at, omega, 0.0) * x;
        }
    }
    sum
}

fn at_harmonic(e: Error, block: &HarmonicBlock, omega: f64) -> Error {
    e.at(format_args!("harmonic {} at angular frequency {omega}", block.number))
}
