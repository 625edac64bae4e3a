//! The modes of a wave as contacts, response and springs see them, for all harmonics of the wave, and the sums over them.
//!
//! A structure with many modes has few that are not far stiffer than the harmonics that matter. With σ = s/(1 + c) the sum over
//! the stiff ones is a series with the same matrices at each frequency,
//!
//! > Σ l lᴴ/(1 + c − s μ) = Σ_j σʲ S_j/(1 + c),  S_j = Σ μʲ l lᴴ,  |σ μ| ≤ 1/8,
//!
//! so that a sum within a tolerance takes the other modes alone.

use crate::condense::wave_modes::WaveModes;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, try_push, try_vec};
use crate::linalg::sparse::Csc;
use crate::model::reduced_wave::MotionRow;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::sync::{Arc, OnceLock};

const CONTEXT: &str = "the flexibility from modes";

/// Multiplications up to which plain loops are quicker than the blocked product.
const SMALL_PRODUCT: usize = 4096;

/// Numbers of modes that are not summed by series; the least that suffices is taken.
const SOFT: [usize; 3] = [12, 36, 108];

/// Modes of a structure, over those, above which a series is quicker.
const MANY: usize = 2;

/// |σ μ| of the stiff modes.
const STIFF: f64 = 0.125;

/// Error of a series over the tolerance.
const SHARE: f64 = 0.1;

/// The rows of a wave in its modes.
pub struct ModalRows {
    modes: Arc<WaveModes>,
    /// Z_κ at rest and M of the block for which they were made.
    matrices: (Arc<Csc>, Arc<Vec<Complex64>>),
    coordinates: usize,
    /// Rows of contacts, response and springs.
    rows: usize,
    /// Φ seen by them, mode after mode, the stiffest first.
    left: Vec<Complex64>,
    /// Terms of a series; none where sums are to be exact.
    terms: usize,
    /// S_j for each number of modes that are not in it.
    stiff: [OnceLock<Vec<Vec<Complex64>>>; SOFT.len()],
}

impl ModalRows {
    /// The rows of the i-th carried harmonic with degree of freedom `response` in these modes; sums within a relative
    /// tolerance, 0: exact.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        condensed: &Condensed,
        i: usize,
        response: usize,
        (modes, tolerance): (Arc<WaveModes>, f64),
    ) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        let springs = springs(&modes);
        let rows = coordinates + 1 + springs.len();
        let mut left = try_vec(rows * n, Complex64::ZERO, CONTEXT)?;
        let observed = condensed.motion_row(i, response)?;
        for (column, shape) in left.chunks_exact_mut(rows).zip(modes.vectors.chunks_exact(n)) {
            for (to, row) in column.iter_mut().zip(&block.rows) {
                *to = row.along(shape);
            }
            column[coordinates] = observed.along(shape);
            for (to, (row, _)) in column[coordinates + 1..].iter_mut().zip(springs) {
                *to = row.along(shape);
            }
        }
        let terms = if tolerance > 0.0 {
            ((SHARE * tolerance).ln() / STIFF.ln()).ceil() as usize
        } else {
            0
        };
        Ok(Self {
            modes,
            matrices: (Arc::clone(&block.reference), Arc::clone(&block.mass)),
            coordinates,
            rows,
            left,
            terms,
            stiff: Default::default(),
        })
    }

    /// The rows of these modes among those known, or new ones, which are then known.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn shared(
        (condensed, i, response): (&Condensed, usize, usize),
        (modes, tolerance): (&Arc<WaveModes>, f64),
        known: &mut Vec<Arc<Self>>,
    ) -> Result<Arc<Self>> {
        if let Some(rows) = known.iter().find(|rows| rows.are_of(modes)) {
            return Ok(Arc::clone(rows));
        }
        let rows = Arc::new(Self::new(condensed, i, response, (Arc::clone(modes), tolerance))?);
        try_push(known, Arc::clone(&rows), CONTEXT)?;
        Ok(rows)
    }

    /// The modes.
    pub fn modes(&self) -> &WaveModes {
        &self.modes
    }

    /// Whether these are the rows of some modes.
    pub fn are_of(&self, modes: &Arc<WaveModes>) -> bool {
        Arc::ptr_eq(&self.modes, modes)
    }

    /// Whether the matrices of a block are those for which these rows were made, in the same memory.
    pub fn are_of_block(&self, block: &HarmonicBlock) -> bool {
        Arc::ptr_eq(&self.matrices.0, &block.reference) && Arc::ptr_eq(&self.matrices.1, &block.mass)
    }

    /// Springs that count: without damping by stiffness their part of the low-rank term vanishes.
    pub fn springs(&self) -> &[(MotionRow, f64)] {
        springs(&self.modes)
    }

    /// Relative motions, whose rows come first, then that of the response.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.rows
    }

    /// L, mode after mode.
    pub fn left(&self) -> &[Complex64] {
        &self.left
    }

    /// The rows in one mode.
    pub fn of_mode(&self, mode: usize) -> &[Complex64] {
        &self.left[mode * self.rows..(mode + 1) * self.rows]
    }

    /// out ← the sum over the stiff modes by series, 0 where all modes are to be summed; returns the first that is not in it.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn add_stiff(&self, sigma: Complex64, stiffness: Complex64, out: &mut [Complex64]) -> Result<usize> {
        out.fill(Complex64::ZERO);
        let (n, size) = (self.modes.values.len(), sigma.norm());
        if self.terms == 0 {
            return Ok(0);
        }
        // μ rises.
        let suffices = |soft: usize| MANY * soft <= n && size * self.modes.values[n - soft - 1].abs() <= STIFF;
        let Some(split) = SOFT.iter().position(|&soft| suffices(soft)) else {
            return Ok(0);
        };
        let first = n - SOFT[split];
        let sums = match self.stiff[split].get() {
            Some(known) => known,
            None => {
                let made = self.stiff_sums(first)?;
                self.stiff[split].get_or_init(|| made)
            }
        };
        let mut factor = stiffness.inv();
        for sum in sums {
            for (out, s) in out.iter_mut().zip(sum) {
                *out += factor * s;
            }
            factor *= sigma;
        }
        Ok(first)
    }

    /// S_j of the modes before one.
    fn stiff_sums(&self, end: usize) -> Result<Vec<Vec<Complex64>>> {
        let mut factors = try_vec(end, Complex64::ONE, CONTEXT)?;
        let mut weighted = try_vec(end * self.rows, Complex64::ZERO, CONTEXT)?;
        let mut sums = Vec::new();
        for _ in 0..self.terms {
            let mut sum = try_vec(self.rows * self.rows, Complex64::ZERO, CONTEXT)?;
            self.add(0, &factors, &mut weighted, &mut sum);
            try_push(&mut sums, sum, CONTEXT)?;
            for (factor, mu) in factors.iter_mut().zip(&self.modes.values) {
                *factor *= mu;
            }
        }
        Ok(sums)
    }

    /// out ← out + Σ f l lᴴ over the modes from one on that have a factor f; `weighted` is memory for f lᴴ.
    pub fn add(&self, from: usize, factors: &[Complex64], weighted: &mut [Complex64], out: &mut [Complex64]) {
        let rows = self.rows;
        let (factors, left) = (&factors[from..], &self.left[from * rows..factors.len() * rows]);
        let modes = left.chunks_exact(rows).zip(factors);
        if out.len() * factors.len() <= SMALL_PRODUCT {
            for (left, factor) in modes {
                for (out, right) in out.chunks_exact_mut(rows).zip(left) {
                    let weighted = right.conj() * factor;
                    for (out, left) in out.iter_mut().zip(left) {
                        *out += left * weighted;
                    }
                }
            }
            return;
        }
        let weighted = &mut weighted[..left.len()];
        for (to, (left, factor)) in weighted.chunks_exact_mut(rows).zip(modes) {
            for (to, left) in to.iter_mut().zip(left) {
                *to = left.conj() * factor;
            }
        }
        matmul(
            MatMut::from_column_major_slice_mut(out, rows, rows),
            Accum::Add,
            MatRef::from_column_major_slice(left, rows, factors.len()),
            MatRef::from_row_major_slice(weighted, factors.len(), rows),
            Complex64::ONE,
            Par::Seq,
        );
    }
}

/// Springs of modes that count.
fn springs(modes: &WaveModes) -> &[(MotionRow, f64)] {
    if modes.is_damped_by_stiffness() {
        &modes.springs
    } else {
        &[]
    }
}
