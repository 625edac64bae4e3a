//! Flexibility table from modes of a single relative motion without springs: the inner loop of every response with one
//! contact. The formulas are those of [`crate::condense::by_modes::modal_table`], written out for two inputs and two outputs.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::sum_terms::Frequency;
use crate::error::{Result, try_room};
use crate::linalg::libraries::{Arch, Simd, WithSimd};
use num_complex::Complex64;

/// Entries of the table: of the contact and the response by the contact, of both by the excitation.
/// Kind: fixed.
const SINGLE_CONTACT_ENTRIES: usize = 4;

/// A complex number for each entry of the table: all real parts, then all imaginary parts.
type Entries = [[f64; SINGLE_CONTACT_ENTRIES]; 2];

/// A mode as one contact and the response see it.
struct Mode {
    /// Eigenvalue μ of the mode.
    value: f64,
    /// For each entry of the table, the product of output and input of the mode.
    products: Entries,
}

/// The modes of a wave as one contact and the response see them.
pub struct SingleContact {
    arch: Arch,
    modes: Vec<Mode>,
    /// Whether the excitation moves some mode.
    is_forced: bool,
}

/// Numbers of one frequency: c and s of the denominators 1 + c − s μ, their derivatives by ω, and ν.
#[derive(Clone, Copy)]
pub struct Denominators {
    pub at: Frequency,
    pub s: Complex64,
    pub d_s: Complex64,
    pub nu: f64,
    /// Smallest modulus that is allowed for a denominator, over 1 + ν² |μ|.
    pub least: f64,
}

impl SingleContact {
    /// Makes the modes from μ, from the motions `left` of contact and response in each mode, and from the excitation
    /// along each mode, if there is one.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(values: &[f64], left: &[Complex64], force: &[Complex64]) -> Result<Self> {
        let mut modes = try_room(values.len(), "the flexibility from modes")?;
        for (k, (value, l)) in values.iter().zip(left.chunks_exact(2)).enumerate() {
            let r = [l[0].conj(), force.get(k).copied().unwrap_or_default()];
            let products = [l[0] * r[0], l[1] * r[0], l[0] * r[1], l[1] * r[1]];
            let mode = Mode {
                value: *value,
                products: [products.map(|z| z.re), products.map(|z| z.im)],
            };
            modes.push(mode);
        }
        Ok(Self {
            arch: Arch::new(),
            modes,
            is_forced: force.iter().any(|f| *f != Complex64::ZERO),
        })
    }

    /// Computes the table and its slope with the low-rank term, whose coefficient is e with derivative ∂e. Returns
    /// `false` where a denominator is small.
    pub fn evaluate(&self, by: Denominators, (e, d_e): (Complex64, Complex64), table: &mut Table) -> bool {
        let sums = if self.is_forced {
            self.arch.dispatch(Sum::<SINGLE_CONTACT_ENTRIES>(&self.modes, by))
        } else {
            self.arch.dispatch(Sum::<2>(&self.modes, by))
        };
        let Some([t, d_t]) = sums else {
            return false;
        };
        let (own, d_own) = (entry(&t, 0), entry(&d_t, 0));
        let (to, d_to) = (entry(&t, 1), entry(&d_t, 1));
        // p = 1/(1 − own·e) scales all but the direct response, which gains to·e p·from.
        let p = (1.0 - own * e).inv();
        let d_p = p * p * (d_own * e + own * d_e);
        table.value[..2].copy_from_slice(&[own * p, to * p]);
        table.slope[..2].copy_from_slice(&[d_own * p + own * d_p, d_to * p + to * d_p]);
        if !self.is_forced {
            table.value[2..].fill(Complex64::ZERO);
            table.slope[2..].fill(Complex64::ZERO);
            return true;
        }
        let (from, d_from) = (entry(&t, 2), entry(&d_t, 2));
        let (direct, d_direct) = (entry(&t, 3), entry(&d_t, 3));
        let (force, d_force) = (e * p * from, (d_e * p + e * d_p) * from + e * p * d_from);
        table.value[2..].copy_from_slice(&[from * p, direct + to * force]);
        table.slope[2..].copy_from_slice(&[d_from * p + from * d_p, d_direct + d_to * force + to * d_force]);
        true
    }
}

/// An entry of the table.
#[inline(always)]
fn entry([re, im]: &Entries, k: usize) -> Complex64 {
    Complex64::new(re[k], im[k])
}

/// Sums over the modes of the first N entries and their derivatives; the result is `None` where a denominator is small.
struct Sum<'a, const N: usize>(&'a [Mode], Denominators);

impl<const N: usize> WithSimd for Sum<'_, N> {
    type Output = Option<[Entries; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Self::Output {
        let Self(modes, by) = self;
        let (c, d_c) = (by.at.at.c, by.at.slope.c);
        let mut sums = [[[0.0; SINGLE_CONTACT_ENTRIES]; 2]; 2];
        let mut is_clear = true;
        for mode in modes {
            let (re, im) = (1.0 + c.re - by.s.re * mode.value, c.im - by.s.im * mode.value);
            let squared = re * re + im * im;
            let size = by.least * (1.0 + by.nu * by.nu * mode.value.abs());
            is_clear &= squared > size * size;
            let reciprocal = 1.0 / squared;
            let inverse = Complex64::new(re * reciprocal, -im * reciprocal);
            let slope = -(d_c - by.d_s * mode.value) * (inverse * inverse);
            for (sum, factor) in sums.iter_mut().zip([inverse, slope]) {
                let [p_re, p_im] = &mode.products;
                let [re, im] = sum;
                for i in 0..N {
                    re[i] += p_re[i] * factor.re - p_im[i] * factor.im;
                    im[i] += p_re[i] * factor.im + p_im[i] * factor.re;
                }
            }
        }
        is_clear.then_some(sums)
    }
}
