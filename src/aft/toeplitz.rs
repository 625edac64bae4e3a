//! The operator T(S) of a stiffness spectrum: product of a periodic stiffness s(τ) with a motion.
//!
//! With s = Σ Sₙ e^{inτ} the harmonics of s·x are Fₕ = Σₘ Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ), Toeplitz plus Hankel, and for the
//! mean F₀ = S₀ X₀ + Re Σₘ conj(Sₘ) Xₘ. In packed form T is a real matrix. Along a column h varies while m is fixed,
//! so that every column is the sum of two sections of four lists of O(H) numbers: (Sₖ) and (i Sₖ) for the
//! differences, (Sₖ) and (−i Sₖ) for the sums of harmonics.

use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// Numbers of columns between two checks.
/// Kind: block.
const TOEPLITZ_NUMBERS_TOGETHER: usize = 1 << 22;

/// Lists of numbers from which the columns of T(S) are read.
pub(super) struct Toeplitz {
    /// Number of harmonics above the mean.
    order: usize,
    has_mean: bool,
    /// Entries Sₕ₋ₘ from the most negative difference on; and these times i.
    differences: [Vec<f64>; 2],
    /// Entries Sₕ₊ₘ from the smallest sum on; and these times −i.
    sums: [Vec<f64>; 2],
    /// Row of the mean.
    row: Vec<f64>,
    /// Column of the mean: 2·Sₕ; and zeros as its second part.
    column: [Vec<f64>; 2],
}

/// A column of T(S): the entry in the row of the mean, and two sections whose sum is the rest of the column.
#[derive(Clone, Copy)]
pub(super) struct Column<'a> {
    pub(super) mean: f64,
    pub(super) parts: [&'a [f64]; 2],
}

impl Toeplitz {
    /// Memory for the harmonics of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub(super) fn new(set: &HarmonicSet) -> Result<Self> {
        const CONTEXT: &str = "a contact Jacobian";
        let order = set.oscillating();
        let list = || try_vec((4 * order).saturating_sub(2), 0.0, CONTEXT);
        let mean = if set.has_mean() { 2 * order } else { 0 };
        Ok(Self {
            order,
            has_mean: set.has_mean(),
            differences: [list()?, list()?],
            sums: [list()?, list()?],
            row: try_vec(set.packed_len(), 0.0, CONTEXT)?,
            column: [try_vec(mean, 0.0, CONTEXT)?, try_vec(mean, 0.0, CONTEXT)?],
        })
    }

    /// Sets the spectrum S, given for n from 0 to twice the highest reduced harmonic.
    pub(super) fn set(&mut self, set: &HarmonicSet, s: &[Complex64]) {
        let stride = set.stride();
        // S from the most negative difference on, and the same times i; S of the sums, and the same times −i.
        let [differences, d_turned] = &mut self.differences;
        let numbers = pairs(differences).zip(pairs(d_turned));
        for (k, (to, turned)) in numbers.enumerate() {
            let n = stride * (k + 1).abs_diff(self.order);
            let minus = if k + 1 < self.order { s[n].conj() } else { s[n] };
            (*to, *turned) = ([minus.re, minus.im], [-minus.im, minus.re]);
        }
        let [sums, s_turned] = &mut self.sums;
        let spectrum = s[2 * set.reduced(0).min(s.len() / 2)..].iter().step_by(stride);
        for ((to, turned), plus) in pairs(sums).zip(pairs(s_turned)).zip(spectrum) {
            (*to, *turned) = ([plus.re, plus.im], [plus.im, -plus.re]);
        }
        if self.has_mean {
            self.row[0] = s[0].re;
            let [column, zeros] = &mut self.column;
            for (k, (to, zero)) in pairs(column).zip(pairs(zeros)).enumerate() {
                let z = s[set.reduced(k)];
                (self.row[1 + 2 * k], self.row[2 + 2 * k]) = (z.re, z.im);
                (*to, *zero) = ([2.0 * z.re, 2.0 * z.im], [0.0; 2]);
            }
        }
    }

    /// The column of T(S) that belongs to number `j` of a packed motion.
    #[inline]
    pub(super) fn column(&self, j: usize) -> Column<'_> {
        let mean = if self.has_mean { self.row[j] } else { 0.0 };
        let Some(j) = j.checked_sub(usize::from(self.has_mean)) else {
            return Column {
                mean,
                parts: [&self.column[0], &self.column[1]],
            };
        };
        let (c, part) = (j / 2, j % 2);
        let length = 2 * self.order;
        let from = 2 * (self.order - 1 - c);
        Column {
            mean,
            parts: [
                &self.differences[part][from..from + length],
                &self.sums[part][2 * c..2 * c + length],
            ],
        }
    }

    /// Adds T(S) to a column-major block, whose columns begin `leading` numbers apart. `block` begins with the first
    /// entry of the block and may be part of a larger matrix.
    pub(super) fn add(&self, block: &mut [f64], leading: usize) {
        let m = self.row.len();
        for (j, to) in block.chunks_mut(leading.max(1)).take(m).enumerate() {
            let column = self.column(j);
            let (mean, rest) = to[..m].split_at_mut(usize::from(self.has_mean));
            for x in mean {
                *x += column.mean;
            }
            let [a, b] = column.parts;
            for ((x, a), b) in rest.iter_mut().zip(a).zip(b) {
                *x += a + b;
            }
        }
    }

    /// Adds T(S) x to a packed force, column by column, without a matrix.
    pub(super) fn add_product(&self, x: &[f64], force: &mut [f64], interrupt: &Interrupt<'_>) -> Result<()> {
        let m = self.row.len();
        let together = (TOEPLITZ_NUMBERS_TOGETHER / m.max(1)).max(1);
        let (mean, rest) = force[..m].split_at_mut(usize::from(self.has_mean));
        for (j, x) in x[..m].iter().enumerate() {
            if j % together == together - 1 {
                interrupt.check_before((together * m) as u64)?;
            }
            let column = self.column(j);
            for f in &mut *mean {
                *f += x * column.mean;
            }
            let [a, b] = column.parts;
            for ((f, a), b) in rest.iter_mut().zip(a).zip(b) {
                *f += x * (a + b);
            }
        }
        Ok(())
    }
}

/// The numbers of a list as complex numbers.
#[inline]
fn pairs(list: &mut [f64]) -> core::slice::IterMut<'_, [f64; 2]> {
    list.as_chunks_mut::<2>().0.iter_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_product_of_a_stiffness_and_a_motion() {
        // Column by column against sums over many times, exact for such short series.
        for (highest, odd) in [(0, false), (1, false), (4, false), (5, true), (9, true)] {
            let set = if highest == 0 {
                HarmonicSet::all(0).unwrap()
            } else {
                HarmonicSet::excited(&[1], highest, true, odd, false).unwrap()
            };
            let m = set.packed_len();
            let last = 2 * set.highest_reduced();
            let s: Vec<Complex64> = (0..=last)
                .map(|n| match n {
                    0 => Complex64::ONE,
                    n if odd && n % 2 == 1 => Complex64::ZERO,
                    n => Complex64::cis(n as f64) / n as f64,
                })
                .collect();
            let mut toeplitz = Toeplitz::new(&set).unwrap();
            toeplitz.set(&set, &s);
            let leading = m + 3;
            let mut found = vec![0.0; m * leading];
            toeplitz.add(&mut found, leading);
            let (count, mut basis) = (64, vec![0.0; m]);
            let mut expected = vec![0.0; m * m];
            for t in 0..count {
                let tau = std::f64::consts::TAU * f64::from(t) / f64::from(count);
                set.basis(tau, &mut basis);
                let stiffness = s[0].re
                    + (1..=last)
                        .map(|n| 2.0 * (s[n] * Complex64::cis(n as f64 * tau)).re)
                        .sum::<f64>();
                for (j, x) in basis.iter().enumerate() {
                    for (i, c) in basis.iter().enumerate() {
                        let weight = if set.has_mean() && i == 0 { 1.0 } else { 2.0 };
                        expected[j * m + i] += weight / f64::from(count) * c * stiffness * x;
                    }
                }
            }
            for j in 0..m {
                for i in 0..m {
                    let gap = (found[j * leading + i] - expected[j * m + i]).abs();
                    assert!(gap < 1e-13, "H {highest}, ({i}, {j}): {gap:e}");
                }
                assert!(found[j * leading + m..(j + 1) * leading].iter().all(|x| *x == 0.0));
            }
            let x: Vec<f64> = (0..m).map(|j| (1.0 + j as f64).sin()).collect();
            let mut force = vec![0.5; m];
            toeplitz.add_product(&x, &mut force, &Interrupt::none()).unwrap();
            for (i, force) in force.iter().enumerate() {
                let product = (0..m).map(|j| expected[j * m + i] * x[j]).sum::<f64>();
                assert!(
                    (force - 0.5 - product).abs() < 1e-13 * (1.0 + m as f64),
                    "H {highest}, {i}"
                );
            }
        }
    }
}
