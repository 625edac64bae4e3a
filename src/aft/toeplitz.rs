//! The operator T(S) of a stiffness spectrum: product of a periodic stiffness s(τ) with a motion.
//!
//! With s = Σ Sₙ e^{inτ} the harmonics of s·x are Fₕ = Σₘ Sₕ₋ₘ Xₘ + Sₕ₊ₘ conj(Xₘ), Toeplitz plus
//! Hankel, and for the mean F₀ = S₀ X₀ + Re Σₘ conj(Sₘ) Xₘ. In packed form T is a real matrix.

use crate::harmonics::HarmonicSet;
use num_complex::Complex64;

/// Adds T(S) to a column-major block, whose columns begin `leading` numbers apart. `block` begins
/// with the first entry of the block and may be part of a larger matrix. S is given for n from 0
/// to twice the highest reduced harmonic.
pub(super) fn add(set: &HarmonicSet, s: &[Complex64], block: &mut [f64], leading: usize) {
    let mean = usize::from(set.has_mean());
    if mean == 1 {
        block[0] += s[0].re;
        for k in 0..set.oscillating() {
            let sp = s[set.reduced(k)];
            let at = 1 + 2 * k;
            // Row 0: F₀ = Re Σ conj(Sₘ)·Xₘ; column 0: Fₕ = 2 Sₕ X₀.
            block[at * leading] += sp.re;
            block[(at + 1) * leading] += sp.im;
            block[at] += 2.0 * sp.re;
            block[at + 1] += 2.0 * sp.im;
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
            block[re_column * leading + row] += minus.re + plus.re;
            block[re_column * leading + row + 1] += minus.im + plus.im;
            block[im_column * leading + row] += plus.im - minus.im;
            block[im_column * leading + row + 1] += minus.re - plus.re;
        }
    }
}
