//! Modes of one wave of the structure with its contacts stuck, by which the flexibility at any frequency is a sum.
//!
//! With M φ = μ K_κ φ, φᴴ K_κ φ = 1, and damping C = αM + βK and loss factor η of the structure alone,
//!
//! > Z_κ = (1 + c) K_κ − (ν² − iνα) M − c Bᴴ k B,  c = i(νβ + η),  ν = hω,
//!
//! where Bᴴ k B is the part of K_κ that belongs to no structure: springs, stuck contacts and κ. Without the last term
//! Z⁻¹ = Σ φ φᴴ/(1 + c − (ν² − iνα) μ); the term itself is of low rank, see [`crate::condense::by_modes::modal_table`]. A complex κ
//! enters K_κ with its real part; its imaginary part adds to the low rank, and so does damping L Lᴴ of few directions beside
//! αM + βK, see `condense::few_directions`.

use crate::condense::by_modes::soft_store::SoftStore;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::few_motions::reduced_wave::MotionRow;
use num_complex::Complex64;

/// Relative deviation of a damping matrix from αM + βK that is rounding.
/// Kind: rounding.
const PROPORTIONAL: f64 = 1e-12;

/// Modes of one wave of the structure with its contacts stuck.
#[derive(Debug)]
pub struct WaveModes {
    /// K_κ, M and the motion of the next sector over that of this sector, by which the wave is recognised. Without
    /// the last one, a wave of real matrices would be confused with the wave that travels the other way, whose
    /// springs have other rows.
    pub(crate) reference: Csc,
    pub(crate) mass: Vec<Complex64>,
    pub(crate) next: Complex64,
    /// Eigenvalues μ of the modes.
    pub(crate) values: Vec<f64>,
    /// Shapes φ, column after column.
    pub(crate) vectors: Vec<Complex64>,
    /// Factors α and β of proportional damping αM + βK.
    pub(crate) proportional: (f64, f64),
    /// Loss factor η of the structure.
    pub(crate) loss_factor: f64,
    /// Rows of B beyond the relative coordinates (springs), with their stiffness.
    pub(crate) springs: Vec<(MotionRow, f64)>,
    /// Rows Lᴴ of the damping αM + βK + L Lᴴ.
    pub(crate) dampers: Vec<MotionRow>,
    /// Soft modes for tables along a sweep.
    pub(crate) soft: SoftStore,
}

/// Relative size of a denominator below which a mode hides the others: a sum over modes then has so many digits less.
/// Kind: rounding.
pub(crate) const NEAR_RESONANCE: f64 = 1e-6;

/// The same of a response without contacts: the mode hides no flexibility that acts on a contact, and a factorisation has no more
/// digits of its response.
/// Kind: rounding.
pub(crate) const NEAR_ALONE: f64 = 1e-10;

/// The same for a nonlinear mode, which is a resonance of the stuck structure while its contacts stick.
/// Kind: rounding.
pub(crate) const NEAR_MODE: f64 = 1e-4;

impl WaveModes {
    /// Computes 1/(1 + c − s μ) of all modes at ν, where s is ν² and its damping terms. Returns `false` where a
    /// denominator is below `near`.
    pub(crate) fn invert(
        &self,
        (c, s): (Complex64, Complex64),
        (nu, near): (f64, f64),
        inverse: &mut [Complex64],
    ) -> bool {
        let mut least = f64::INFINITY;
        for (inverse, mu) in inverse.iter_mut().zip(&self.values) {
            let d = 1.0 + c - s * mu;
            let size = 1.0 + nu * nu * mu.abs();
            least = least.min(d.norm_sqr() / (size * size));
            *inverse = d.inv();
        }
        least > near * near
    }

    /// Whether no denominator a − b μ of a mode from `first` on is so small at ν that digits would be lost, as [`Self::invert`] has it.
    pub(crate) fn is_clear(&self, first: usize, nu: f64, a: Complex64, b: Complex64) -> bool {
        self.values[first..].iter().all(|mu| {
            let least = NEAR_RESONANCE * (1.0 + nu * nu * mu.abs());
            (a - b * mu).norm_sqr() > least * least
        })
    }

    /// Whether stiffness damps the wave, so that the part of K_κ that belongs to no structure counts.
    pub(crate) fn is_damped_by_stiffness(&self) -> bool {
        self.proportional.1 != 0.0 || self.loss_factor != 0.0
    }

    /// Whether these modes belong to a wave with this K_κ and M, and this motion of the next sector.
    pub(crate) fn is_of(&self, reference: &Csc, mass: &[Complex64], next: Complex64) -> bool {
        self.next == next
            && self.has_pattern(reference)
            && self.reference.values == reference.values
            && self.mass == mass
    }

    /// Whether the wave with this K_κ and M travels the other way, so that its shapes are the conjugate ones.
    pub(crate) fn is_conjugate_of(&self, reference: &Csc, mass: &[Complex64]) -> bool {
        let are_conjugate =
            |a: &[Complex64], b: &[Complex64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| *a == b.conj());
        self.has_pattern(reference)
            && are_conjugate(&self.reference.values, &reference.values)
            && are_conjugate(&self.mass, mass)
    }

    fn has_pattern(&self, reference: &Csc) -> bool {
        self.reference.col_ptr == reference.col_ptr && self.reference.row_idx == reference.row_idx
    }
}

/// Largest terms αM + βK over C: beyond, both cancel, and digits are lost.
/// Kind: tuned; measured on: structures whose K is nearly a multiple of M.
const LARGEST_TERMS: f64 = 1e3;

/// α and β of C = αM + βK, the matrices M, K and C on one pattern, by least squares; `None` where C is not of this form.
pub(crate) fn proportional([m, k, c]: [&[Complex64]; 3]) -> Option<(f64, f64)> {
    let inner = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
    let size = |z: Complex64| z.re.abs().max(z.im.abs());
    let largest = |a: &[Complex64]| a.iter().fold(0.0_f64, |s, z| s.max(size(*z)));
    let (size_m, size_k, size_c) = (largest(m), largest(k), largest(c));
    if size_c == 0.0 {
        return Some((0.0, 0.0));
    }
    if size_m == 0.0 || size_k == 0.0 {
        return None;
    }
    // One matrix alone is the usual form, and two nearly parallel matrices would lose digits. Where both do, as for one mass, a
    // soft structure under a stiff contact would lose them by βK.
    let candidates = [(inner(m, c) / inner(m, m), 0.0), (0.0, inner(k, c) / inner(k, k)), {
        let (mm, kk, mk) = (inner(m, m), inner(k, k), inner(m, k));
        let (mc, kc) = (inner(m, c), inner(k, c));
        let determinant = mm * kk - mk * mk;
        ((kk * mc - mk * kc) / determinant, (mm * kc - mk * mc) / determinant)
    }];
    candidates.into_iter().find(|&(alpha, beta): &(f64, f64)| {
        let is_off = |((m, k), c): ((&Complex64, &Complex64), &Complex64)| {
            size(c - alpha * m - beta * k) > PROPORTIONAL * size_c
        };
        // Where K is a multiple of M the factors are none, or what rounding makes of it.
        alpha.abs() * size_m + beta.abs() * size_k <= LARGEST_TERMS * size_c && !m.iter().zip(k).zip(c).any(is_off)
    })
}
