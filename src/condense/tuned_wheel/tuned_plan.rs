//! The wheel as a tuned one plus terms of low rank: entries that are alike around the ring, and the motions that the others feel.
//!
//! The matrices of a wheel are made of blocks A_st between sectors s and t. Their means around the ring, g_d = 1/N Σ_t A_(t+d, t), are
//! those of a tuned wheel. A Fourier transform F over the sectors makes them a matrix for each wave, and the differences act on few
//! motions b_p of each wave p,
//!
//! > A = F (diag A_p + b D bᴴ) Fᴴ.
//!
//! A pattern of blade stiffnesses has the rank of the blade's matrix, a mode of it alone rank 1. The matrices themselves tell the basis,
//! whatever changed them: products of the differences with random vectors span it (Halko, Martinsson & Tropp 2011,
//! doi:10.1137/090771806), to rounding, or there is none.

use crate::condense::HarmonicBlock;
use crate::condense::blocks::harmonic_block::Artificial;
use crate::condense::tuned_wheel::tuned_basis::TunedBasis;
use crate::condense::tuned_wheel::tuned_ring::TunedRing;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;

const CONTEXT: &str = "the tuned wheel";

/// Difference of entries around the ring, over the stiffness of their degrees of freedom, that is rounding.
/// Kind: rounding.
const ALIKE_AROUND_RING: f64 = 1e-14;

/// Gap of yᵀAx and xᵀAy, over the root of the sum of squares of A, up to which waves that travel the other way have the transposed
/// matrices.
/// Kind: rounding.
const MIRRORED: f64 = 1e-13;

/// Largest gap of two matrices that are proportional, over the largest entry.
/// Kind: rounding.
const PROPORTIONAL_DIFFERENCES: f64 = 1e-13;

/// Matrices of which that of a harmonic is a sum.
/// Kind: fixed.
pub const TUNED_TERMS: usize = 6;

/// The split of a wheel into a tuned one and differences of low rank.
#[derive(Debug)]
pub struct TunedPlan {
    rings: Vec<TunedRing>,
    pub(crate) basis: TunedBasis,
    matrices: Vec<Matrix>,
    /// For each block, the index of its ring and the indices of the matrices of its terms.
    blocks: Vec<(usize, [Option<usize>; TUNED_TERMS])>,
}

/// A matrix of the wheel: its means around the ring, and its differences D.
#[derive(Debug)]
struct Matrix {
    means: Vec<Complex64>,
    differences: Vec<Complex64>,
}

impl TunedPlan {
    /// The plan for the blocks of a wheel; `None` where the differences have no low rank, or a matrix is not symmetric.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(blocks: &[HarmonicBlock], sectors: usize, interrupt: &Interrupt<'_>) -> Result<Option<Self>> {
        let Some(first) = blocks.first() else { return Ok(None) };
        let all = first.matrices.reference.rows;
        if sectors < 2 || !all.is_multiple_of(sectors) || blocks.iter().any(|block| block.view.is_some()) {
            return Ok(None);
        }
        let mut rings: Vec<TunedRing> = Vec::new();
        let mut matrices: Vec<(usize, &[Complex64])> = Vec::new();
        let mut of_blocks = Vec::new();
        for block in blocks {
            interrupt.check_before(block.matrices.reference.values.len() as u64)?;
            let known = rings.iter().position(|ring| ring.is_of(&block.matrices.reference));
            let ring = known.unwrap_or(rings.len());
            if known.is_none() {
                let Some(new) = TunedRing::new(&block.matrices.reference, sectors)? else {
                    return Ok(None);
                };
                try_push(&mut rings, new, CONTEXT)?;
            }
            let mut terms = [None; TUNED_TERMS];
            for (term, values) in terms.iter_mut().zip(values_of(block)) {
                let Some(values) = values else { continue };
                let known = matrices.iter().position(|(_, known)| core::ptr::eq(*known, values));
                *term = Some(known.unwrap_or(matrices.len()));
                if known.is_none() {
                    try_push(&mut matrices, (ring, values), CONTEXT)?;
                }
            }
            try_push(&mut of_blocks, (ring, terms), CONTEXT)?;
        }
        for &(ring, values) in &matrices {
            interrupt.check_before(10 * values.len() as u64)?;
            if !rings[ring].is_symmetric(values, MIRRORED)? {
                return Ok(None);
            }
        }
        let scale = scale_of(&rings, &matrices, all / sectors)?;
        let mut differing = Vec::new();
        for &(ring, values) in &matrices {
            interrupt.check_before(values.len() as u64)?;
            let ratio = rings[ring].largest_ratio(values, &scale)?;
            let noise = |i: usize, j: usize| ALIKE_AROUND_RING * ratio * (scale[i] * scale[j]).sqrt();
            try_push(
                &mut differing,
                rings[ring].differences(values, (noise, ALIKE_AROUND_RING))?,
                CONTEXT,
            )?;
        }
        let Some(basis) = TunedBasis::new(&differing, sectors, &scale, interrupt)? else {
            return Ok(None);
        };
        let mut found: Vec<Matrix> = Vec::new();
        for (k, (a, &(ring, values))) in differing.iter().zip(&matrices).enumerate() {
            let known = (0..k).find_map(|known| Some((known, multiple(a, &differing[known])?)));
            let differences = match known {
                Some((known, factor)) => {
                    let mut d = try_copy(&found[known].differences, CONTEXT)?;
                    for d in &mut d {
                        *d *= factor;
                    }
                    d
                }
                None => basis.of(a, interrupt)?,
            };
            let means = rings[ring].means(values)?;
            try_push(&mut found, Matrix { means, differences }, CONTEXT)?;
        }
        Ok(Some(Self {
            rings,
            basis,
            matrices: found,
            blocks: of_blocks,
        }))
    }

    /// Pattern of the i-th block, sector by sector.
    pub fn ring(&self, i: usize) -> &TunedRing {
        &self.rings[self.blocks[i].0]
    }

    /// Means around the ring of the i-th block's matrix: the sum of its terms, each times its factor.
    pub fn means(&self, i: usize, factors: &[Complex64; TUNED_TERMS]) -> Result<Vec<Complex64>> {
        let mut sum = try_vec(self.ring(i).kinds(), Complex64::ZERO, CONTEXT)?;
        self.add_terms((i, factors), |matrix| &matrix.means, &mut sum);
        Ok(sum)
    }

    /// Differences D of the i-th block's matrix: the sum of its terms, each times its factor.
    pub fn differences(&self, i: usize, factors: &[Complex64; TUNED_TERMS], sum: &mut [Complex64]) {
        sum.fill(Complex64::ZERO);
        self.add_terms((i, factors), |matrix| &matrix.differences, sum);
    }

    fn add_terms(
        &self,
        (i, factors): (usize, &[Complex64; TUNED_TERMS]),
        of: impl Fn(&Matrix) -> &[Complex64],
        sum: &mut [Complex64],
    ) {
        for (term, factor) in self.blocks[i].1.iter().zip(factors) {
            let Some(term) = term.filter(|_| *factor != Complex64::ZERO) else {
                continue;
            };
            for (sum, x) in sum.iter_mut().zip(of(&self.matrices[term])) {
                *sum += factor * x;
            }
        }
    }
}

/// Size of the stiffness at each degree of freedom of a sector; the first of the matrices is a stiffness.
fn scale_of(rings: &[TunedRing], matrices: &[(usize, &[Complex64])], order: usize) -> Result<Vec<f64>> {
    let mut scale = try_vec(order, 0.0_f64, CONTEXT)?;
    for &(ring, values) in matrices.iter().take(1) {
        for (scale, diagonal) in scale.iter_mut().zip(rings[ring].diagonal(values)?) {
            *scale = diagonal.norm();
        }
    }
    let largest = scale.iter().fold(0.0_f64, |m, s| m.max(*s));
    for scale in scale.iter_mut().filter(|scale| **scale == 0.0) {
        *scale = if largest > 0.0 { largest } else { 1.0 };
    }
    Ok(scale)
}

/// Values of the matrices whose sum is the dynamic stiffness of a block, in the order of the factors of
/// [`TunedPlan::differences`].
fn values_of(block: &HarmonicBlock) -> [Option<&[Complex64]>; TUNED_TERMS] {
    let own = match &block.matrices.artificial {
        Artificial::Stiffness(own) => Some(&own[..]),
        Artificial::None | Artificial::Mass => None,
    };
    [
        Some(&block.matrices.reference.values[..]),
        Some(&block.matrices.damping[..]),
        Some(&block.matrices.mass[..]),
        block.matrices.tied.as_ref().map(|tied| &tied.stiffness[..]),
        block.matrices.tied.as_ref().map(|tied| &tied.gyroscopic[..]),
        own,
    ]
}

/// The factor a/b of a matrix `a` that is a multiple of another one up to rounding, as with damping by stiffness;
/// else `None`.
fn multiple(a: &Csc, of: &Csc) -> Option<Complex64> {
    if a.values.is_empty() || a.col_ptr != of.col_ptr || a.row_idx != of.row_idx {
        return None;
    }
    let largest = |a: &Csc| a.max_abs();
    let product: Complex64 = a.values.iter().zip(&of.values).map(|(a, of)| a * of.conj()).sum();
    let factor = product / of.values.iter().map(Complex64::norm_sqr).sum::<f64>();
    let gap = a.values.iter().zip(&of.values).map(|(a, of)| (a - factor * of).norm());
    // A factor that is no number, of a matrix of zeros, is none.
    (factor.is_finite() && gap.fold(0.0, f64::max) <= PROPORTIONAL_DIFFERENCES * largest(a)).then_some(factor)
}
