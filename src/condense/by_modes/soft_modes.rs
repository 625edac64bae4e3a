//! The flexibility of a wave at many contacts by its soft modes, where a term of low rank stands beside the modes.
//!
//! Few modes, s, are not far stiffer than the harmonics of a sweep. Elimination of the others, t, from A = d − R_Bᴴ e L_B, see
//! [`crate::condense::by_modes::modal_slopes`], leaves
//!
//! > T = Q + V S⁻¹ W,  Q = L A_t⁻¹ Rᴴ,  V = L_s + L A_t⁻¹ R_Bᴴ e L_sB,  W = R_sᴴ + R_sBᴴ e L_B A_t⁻¹ Rᴴ,  S = d_s − R_sBᴴ e V_B,
//!
//! where A_t is A between the modes t. Q, V, W and S − d_s have no poles near the range, so that short sums of Chebyshev polynomials in
//! ν have their digits. A table takes factors of S alone.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_columns;
use crate::linalg::factors::lu::Lu;
use crate::linalg::libraries::{Accum, Arch, MatMut, MatRef, Par, Simd, WithSimd, cast_slice, matmul};
use num_complex::Complex64;

const CONTEXT: &str = "the flexibility from soft modes";

/// Frequencies at which Q, V, W and S are computed, and terms of their sums: with poles beyond five times the range these leave 18⁻¹¹,
/// as 2e-14.
/// Kind: fixed.
pub(super) const SOFT_MODES_NODES: usize = 11;

/// Numbers that are summed at a time: those of each polynomial follow each other, polynomial after polynomial.
/// Kind: block.
pub(super) const SOFT_MODES_ENTRIES: usize = 8;

/// Q, V, W and S − d_s as sums of polynomials.
pub(crate) struct SoftModes {
    /// Index of the first soft mode.
    pub first: usize,
    /// Range of ν.
    pub range: (f64, f64),
    pub sizes: SoftSizes,
    /// Coefficients of Q, V, W and S − d_s, column after column, [`SOFT_MODES_ENTRIES`] of each polynomial at a time.
    pub terms: Vec<Complex64>,
}

/// Numbers of motions (contacts, and response or excitation) and of soft modes.
#[derive(Clone, Copy)]
pub(crate) struct SoftSizes {
    pub outputs: usize,
    pub soft: usize,
}

/// The parts of the numbers at a frequency.
struct SoftParts<'a> {
    q: &'a [Complex64],
    v: &'a [Complex64],
    w: &'a [Complex64],
    s: &'a [Complex64],
}

impl SoftSizes {
    /// Count of the numbers of Q, V, W and S.
    pub fn numbers(self) -> usize {
        (self.outputs + self.soft) * (self.outputs + self.soft)
    }

    fn split(self, of: &[Complex64]) -> SoftParts<'_> {
        let Self { outputs, soft } = self;
        let (q, of) = of.split_at(outputs * outputs);
        let (v, of) = of.split_at(outputs * soft);
        let (w, s) = of.split_at(soft * outputs);
        SoftParts { q, v, w, s }
    }
}

/// Work space of the tables of one harmonic.
pub(crate) struct SoftWork {
    sizes: SoftSizes,
    /// Q, V, W and S − d_s, and their slopes by the angular frequency.
    values: Vec<Complex64>,
    slopes: Vec<Complex64>,
    lu: Lu<Complex64>,
    /// S⁻¹ W.
    motions: Vec<Complex64>,
    /// Forces; motions of the soft modes and their slopes; and memory for products.
    forces: Vec<Complex64>,
    of_modes: [Vec<Complex64>; 2],
    memory: [Vec<Complex64>; 2],
}

impl SoftWork {
    /// Work space for so many motions and modes.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(sizes: SoftSizes) -> Result<Self> {
        let SoftSizes { outputs, soft } = sizes;
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            sizes,
            values: zeros(sizes.numbers())?,
            slopes: zeros(sizes.numbers())?,
            lu: Lu::new(soft, outputs)?,
            motions: zeros(soft * outputs)?,
            forces: zeros(outputs)?,
            of_modes: [zeros(soft)?, zeros(soft)?],
            memory: [zeros(outputs.max(soft))?, zeros(outputs.max(soft))?],
        })
    }

    /// Whether the work space fits so many motions and modes.
    pub fn fits(&self, of: &SoftModes) -> bool {
        (self.sizes.outputs, self.sizes.soft) == (of.sizes.outputs, of.sizes.soft)
    }
}

impl SoftModes {
    /// Whether ν lies in the range.
    pub fn covers(&self, nu: f64) -> bool {
        (self.range.0..=self.range.1).contains(&nu)
    }

    /// Fills in the values of a table at ν of a harmonic, from the denominators d of the soft modes.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    pub fn evaluate(
        &self,
        number: f64,
        nu: f64,
        denominators: impl Iterator<Item = Complex64>,
        work: &mut SoftWork,
        value: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let SoftSizes { outputs, soft } = self.sizes;
        self.sum(number, nu, work);
        let parts = self.sizes.split(&work.values);
        work.lu.matrix().copy_from_slice(parts.s);
        for (pivot, d) in work.lu.matrix().iter_mut().step_by(soft + 1).zip(denominators) {
            *pivot += d;
        }
        work.motions.copy_from_slice(parts.w);
        work.lu.factor(interrupt)?;
        work.lu.solve_columns(&mut work.motions, false, interrupt)?;
        value.copy_from_slice(parts.q);
        matmul(
            MatMut::from_column_major_slice_mut(value, outputs, outputs),
            Accum::Add,
            MatRef::from_column_major_slice(parts.v, outputs, soft),
            MatRef::from_column_major_slice(&work.motions, soft, outputs),
            Complex64::ONE,
            Par::Seq,
        );
        Ok(())
    }

    /// Sums the polynomials and their slopes by the angular frequency.
    fn sum(&self, number: f64, nu: f64, work: &mut SoftWork) {
        let (from, to) = self.range;
        let x = (2.0 * nu - from - to) / (to - from);
        // Tₖ of the first kind and Uₖ of the second, Tₖ′ = k Uₖ₋₁.
        let mut factors = [[0.0; 2]; SOFT_MODES_NODES];
        let mut first = [1.0, x];
        let mut second = [0.0, 1.0];
        for (k, factor) in factors.iter_mut().enumerate() {
            *factor = [first[0], 2.0 * number / (to - from) * k as f64 * second[0]];
            first = [first[1], 2.0 * x * first[1] - first[0]];
            second = [second[1], 2.0 * x * second[1] - second[0]];
        }
        Arch::new().dispatch(Polynomials {
            terms: &self.terms,
            factors: &factors,
            value: &mut work.values,
            slope: &mut work.slopes,
        });
    }

    /// ∂x/∂ω of the motions x = H (excitation − w) under contact forces w that do not change, after [`Self::evaluate`], from the
    /// derivatives ∂d of the denominators.
    pub fn slope_along(
        &self,
        d_denominators: impl Iterator<Item = Complex64>,
        w: &[Complex64],
        work: &mut SoftWork,
        change: &mut [Complex64],
    ) {
        let SoftSizes { outputs, soft } = self.sizes;
        let (parts, slopes) = (self.sizes.split(&work.values), self.sizes.split(&work.slopes));
        let (forces, [xi, rate]) = (&mut work.forces, &mut work.of_modes);
        let [sum, memory] = &mut work.memory;
        forces.fill(Complex64::ZERO);
        for (force, w) in forces.iter_mut().zip(w) {
            *force = -w;
        }
        forces[outputs - 1] = Complex64::ONE;
        complex_columns::multiply(&work.motions, soft, forces, xi, &mut memory[..soft]);
        // S ∂ξ = ∂W f − ∂S ξ.
        complex_columns::multiply(slopes.w, soft, forces, rate, &mut memory[..soft]);
        complex_columns::multiply(slopes.s, soft, xi, &mut sum[..soft], &mut memory[..soft]);
        for ((rate, (sum, xi)), d) in rate.iter_mut().zip(sum.iter().zip(&*xi)).zip(d_denominators) {
            *rate -= sum + d * xi;
        }
        work.lu.solve(rate);
        complex_columns::multiply(slopes.q, outputs, forces, change, &mut memory[..outputs]);
        for (columns, z) in [(slopes.v, &*xi), (parts.v, &*rate)] {
            complex_columns::multiply(columns, outputs, z, &mut sum[..outputs], &mut memory[..outputs]);
            for (change, sum) in change.iter_mut().zip(&*sum) {
                *change += sum;
            }
        }
    }
}

/// Σ f c and Σ f′ c of the coefficients c, by a factor f and its slope for each polynomial. The sums of a few numbers stay in registers
/// while the coefficients are read in the order of memory.
struct Polynomials<'a> {
    terms: &'a [Complex64],
    factors: &'a [[f64; 2]],
    value: &'a mut [Complex64],
    slope: &'a mut [Complex64],
}

impl WithSimd for Polynomials<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let blocks = self.terms.chunks_exact(SOFT_MODES_ENTRIES * SOFT_MODES_NODES);
        let values = self.value.chunks_mut(SOFT_MODES_ENTRIES);
        for ((value, slope), block) in values.zip(self.slope.chunks_mut(SOFT_MODES_ENTRIES)).zip(blocks) {
            let [mut sum, mut d_sum] = [[0.0; 2 * SOFT_MODES_ENTRIES]; 2];
            let (terms, _) = cast_slice::<Complex64, f64>(block).as_chunks::<{ 2 * SOFT_MODES_ENTRIES }>();
            for (term, [factor, d_factor]) in terms.iter().zip(self.factors) {
                for i in 0..2 * SOFT_MODES_ENTRIES {
                    sum[i] += factor * term[i];
                    d_sum[i] += d_factor * term[i];
                }
            }
            for (k, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
                *value = Complex64::new(sum[2 * k], sum[2 * k + 1]);
                *slope = Complex64::new(d_sum[2 * k], d_sum[2 * k + 1]);
            }
        }
    }
}
