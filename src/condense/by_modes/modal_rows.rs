//! The modes of a wave as contacts, response and springs see them, for all harmonics of the wave, and the sums over them.
//!
//! A structure with many modes has few that are not far stiffer than the harmonics that matter. With l the rows in a shape, r those
//! in its adjoint (r = l for modes), and d = a − b μ, see `sum_terms`, the sum over the stiff ones is a series with the same matrices
//! at each frequency,
//!
//! > Σ l rᴴ/(a − b μ) = Σ_j zʲ S_j/a,  z = b/a,  S_j = Σ μʲ l rᴴ,  |z μ| ≤ 1/8,
//!
//! so that a sum takes the other modes alone. The matrices are made when a sum first needs them.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::condense::by_modes::sum_terms::{Denominator, Source};
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, try_push, try_vec};
use crate::linalg::libraries::{Accum, Arch, MatMut, MatRef, Par, Simd, WithSimd, cast_slice, matmul};
use crate::model::few_motions::reduced_wave::MotionRow;
use num_complex::Complex64;
use std::sync::{Arc, OnceLock};

const CONTEXT: &str = "the flexibility from modes";

/// Multiplications up to which plain loops are quicker than the blocked product.
/// Kind: tuned; measured on: not recorded.
const SMALL_PRODUCT: usize = 4096;

/// Numbers of modes that are not summed by series; the least that suffices is taken.
/// Kind: tuned; measured on: not recorded.
const SOFT: [usize; 2] = [36, 108];

/// Modes of a structure, over those, above which a series is quicker.
/// Kind: tuned; measured on: not recorded.
const MANY: usize = 2;

/// Rows from which a series takes less time than its modes one by one.
/// Kind: tuned; measured on: not recorded.
const SERIES_FROM: usize = 8;

/// Rows up to which a series is used: the matrices of more would take too much memory.
/// Kind: cap.
const MOST_ROWS: usize = 200;

/// |σ μ| of the stiff modes.
/// Kind: tuned; measured on: not recorded.
const STIFF: f64 = 0.125;

/// Most terms of a series: with them it has the digits of a number.
/// Kind: cap.
const MOST_TERMS: usize = 18;

/// Rows of a sum over stiff modes that are made at a time: those above them follow from its symmetry.
/// Kind: block.
const MODAL_ROWS_AT_ONCE: usize = 24;

/// Entries of a table to which the terms of a series are added at a time.
/// Kind: block.
const MODAL_ROWS_ENTRIES: usize = 256;

/// Rows of contacts, response, springs and dampers of one wave, multiplied with its modes or poles.
pub struct ModalRows {
    source: Source,
    /// Motion of the next sector over that of this sector. Waves of real matrices may share their modes and differ in
    /// this factor.
    next: Complex64,
    coordinates: usize,
    /// Number of rows: contacts, response, springs and dampers.
    rows: usize,
    /// Whether some of the rows belong to springs.
    has_springs: bool,
    /// Row products with Φ, mode after mode, the stiffest mode first.
    left: Arc<Vec<Complex64>>,
    /// Row products with the adjoint shapes; empty where these equal the shapes.
    adjoint: Vec<Complex64>,
    /// Sums S_j of the series over stiff modes, for each number of soft modes that stay outside of it.
    stiff: [[OnceLock<Vec<Complex64>>; MOST_TERMS]; SOFT.len()],
}

impl ModalRows {
    /// The rows of the i-th carried harmonic, with degree of freedom `response`, in the modes or poles of `source`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new((condensed, i, response): (&Condensed, usize, usize), source: Source) -> Result<Self> {
        let observed = condensed.motion_row(i, response)?;
        // Without damping by stiffness their part of the low-rank term vanishes.
        let has_springs = source.is_damped_by_stiffness();
        Self::with_rows((condensed, i), &observed, source, has_springs)
    }

    /// The rows of the i-th carried harmonic with the row `observed` for the response, and with the rows of the
    /// springs or without.
    pub fn with_rows(
        (condensed, i): (&Condensed, usize),
        observed: &MotionRow,
        source: Source,
        has_springs: bool,
    ) -> Result<Self> {
        let block = &condensed.blocks()[i];
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        let springs = if has_springs { all_springs(&source) } else { &[] };
        let dampers = all_dampers(&source);
        let rows = coordinates + 1 + springs.len() + dampers.len();
        let seen = |shapes: &[Complex64]| -> Result<Vec<Complex64>> {
            let mut seen = try_vec(rows * source.len(), Complex64::ZERO, CONTEXT)?;
            for (column, shape) in seen.chunks_exact_mut(rows).zip(shapes.chunks_exact(n)) {
                for (to, row) in column.iter_mut().zip(&block.motions.rows) {
                    *to = row.along(shape);
                }
                column[coordinates] = observed.along(shape);
                let beside = springs.iter().map(|(row, _)| row).chain(dampers);
                for (to, row) in column[coordinates + 1..].iter_mut().zip(beside) {
                    *to = row.along(shape);
                }
            }
            Ok(seen)
        };
        let (shapes, adjoints) = source.shapes();
        let left = seen(shapes)?;
        let adjoint = match &source {
            Source::Modes(_) => Vec::new(),
            Source::Poles(_) => seen(adjoints)?,
        };
        Ok(Self {
            next: block.next,
            coordinates,
            rows,
            has_springs,
            left: Arc::new(left),
            adjoint,
            stiff: [const { [const { OnceLock::new() }; MOST_TERMS] }; SOFT.len()],
            source,
        })
    }

    /// Finds the rows for a source among the `known` ones, or makes them and adds them to `known`.
    pub fn shared(at: (&Condensed, usize, usize), source: Source, known: &mut Vec<Arc<Self>>) -> Result<Arc<Self>> {
        if let Some(rows) = known.iter().find(|rows| rows.are_of(&at.0.blocks()[at.1], &source)) {
            return Ok(Arc::clone(rows));
        }
        let rows = Arc::new(Self::new(at, source)?);
        try_push(known, Arc::clone(&rows), CONTEXT)?;
        Ok(rows)
    }

    /// Whether these rows belong to a block and a source of modes or poles.
    pub fn are_of(&self, block: &HarmonicBlock, source: &Source) -> bool {
        self.source.is(source) && self.next == block.next
    }

    /// Modes or poles in which the rows are expressed.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Springs with rows of their own.
    pub fn springs(&self) -> &[(MotionRow, f64)] {
        if self.has_springs {
            all_springs(&self.source)
        } else {
            &[]
        }
    }

    /// Rows of the damping beside αM + βK.
    pub fn dampers(&self) -> &[MotionRow] {
        all_dampers(&self.source)
    }

    /// Number of relative motions. Their rows come first, then the row of the response.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of rows: relative motions, response, springs and dampers.
    pub fn count(&self) -> usize {
        self.rows
    }

    /// Number of modes or poles.
    pub fn terms(&self) -> usize {
        self.source.len()
    }

    /// Row products L with the shapes, mode after mode.
    pub fn left(&self) -> &[Complex64] {
        &self.left
    }

    /// The same in shared memory.
    pub(super) fn shared_left(&self) -> Arc<Vec<Complex64>> {
        Arc::clone(&self.left)
    }

    /// Product of a force with the adjoint shape of each mode or pole.
    pub fn forced(&self, force: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut found = Vec::new();
        if force.iter().any(|f| *f != Complex64::ZERO) {
            for adjoint in self.source.shapes().1.chunks_exact(force.len()) {
                try_push(&mut found, crate::linalg::inner(adjoint, force), CONTEXT)?;
            }
        }
        Ok(found)
    }

    /// Row products with the adjoint shapes, mode after mode.
    pub(crate) fn adjoint(&self) -> &[Complex64] {
        if self.adjoint.is_empty() {
            &self.left
        } else {
            &self.adjoint
        }
    }

    /// out ← the sum over the stiff modes by a series with the digits of a number, where that is quicker, and slope ← its derivative
    /// if there is memory for it. Returns the index of the first mode outside the series.
    pub fn add_stiff(&self, at: Denominator, out: &mut [Complex64], slope: Option<&mut [Complex64]>) -> Result<usize> {
        out.fill(Complex64::ZERO);
        let mut slope = slope;
        if let Some(slope) = &mut slope {
            slope.fill(Complex64::ZERO);
        }
        let z = at.b / at.a;
        let (n, size) = (self.source.len(), z.norm());
        if !(SERIES_FROM..=MOST_ROWS).contains(&self.rows) {
            return Ok(0);
        }
        // |μ| rises.
        let suffices = |soft: usize| MANY * soft <= n && size * self.source.value(n - soft - 1).norm() <= STIFF;
        let Some(split) = SOFT.iter().position(|&soft| suffices(soft)) else {
            return Ok(0);
        };
        let first = n - SOFT[split];
        // So many terms suffice at the end of the range of a series.
        let ratio = size * self.source.value(first - 1).norm();
        let enough = (MOST_TERMS as f64 * (STIFF.ln() / ratio.max(f64::MIN_POSITIVE).ln())).ceil() as usize;
        let terms = enough.clamp(1, MOST_TERMS);
        let mut sums = [&[][..]; MOST_TERMS];
        let (mut factors, mut slopes) = ([Complex64::ZERO; MOST_TERMS], [Complex64::ZERO; MOST_TERMS]);
        // zʲ/a and its derivative, with ∂z = (∂b − z ∂a)/a.
        let d_z = (at.d_b - z * at.d_a) / at.a;
        let (mut factor, mut before) = (at.a.inv(), Complex64::ZERO);
        for (power, sum) in sums.iter_mut().enumerate().take(terms) {
            let known = &self.stiff[split][power];
            *sum = if let Some(known) = known.get() {
                known
            } else {
                let made = self.stiff_sum(first, power)?;
                known.get_or_init(|| made)
            };
            factors[power] = factor;
            slopes[power] = power as f64 * before * d_z - factor * at.d_a / at.a;
            (before, factor) = (factor, factor * z);
        }
        let arch = Arch::new();
        let add = |factors: &[Complex64], out: &mut [Complex64]| {
            arch.dispatch(Series {
                sums: &sums[..terms],
                factors,
                out,
            });
        };
        add(&factors[..terms], out);
        if let Some(slope) = slope {
            add(&slopes[..terms], slope);
        }
        Ok(first)
    }

    /// S_j, the coefficient of a power in the series over the modes before `end`.
    fn stiff_sum(&self, end: usize, power: usize) -> Result<Vec<Complex64>> {
        let rows = self.rows;
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        let (mut weighted, mut sum) = (zeros(end * rows)?, zeros(rows * rows)?);
        let left = &self.left[..end * rows];
        for (k, (to, adjoint)) in weighted
            .chunks_exact_mut(rows)
            .zip(self.adjoint().chunks_exact(rows))
            .enumerate()
        {
            let factor = self.source.value(k).powi(power as i32);
            for (to, adjoint) in to.iter_mut().zip(adjoint) {
                *to = adjoint.conj() * factor;
            }
        }
        let left = MatRef::from_column_major_slice(left, rows, end);
        let weighted = MatRef::from_row_major_slice(&weighted, end, rows);
        // That of modes is its own adjoint.
        let is_hermitian = self.adjoint.is_empty();
        for from in (0..rows).step_by(MODAL_ROWS_AT_ONCE) {
            let columns = MODAL_ROWS_AT_ONCE.min(rows - from);
            let above = if is_hermitian { from } else { 0 };
            matmul(
                MatMut::from_column_major_slice_mut(&mut sum, rows, rows).submatrix_mut(
                    above,
                    from,
                    rows - above,
                    columns,
                ),
                Accum::Replace,
                left.subrows(above, rows - above),
                weighted.subcols(from, columns),
                Complex64::ONE,
                Par::Seq,
            );
        }
        for j in 0..if is_hermitian { rows } else { 0 } {
            for i in 0..j {
                sum[j * rows + i] = sum[i * rows + j].conj();
            }
        }
        Ok(sum)
    }

    /// out ← out + Σ f l rᴴ over the modes from index `from` on, one factor f each; `weighted` is memory for f rᴴ.
    pub fn add(&self, from: usize, factors: &[Complex64], weighted: &mut [Complex64], out: &mut [Complex64]) {
        let rows = self.rows;
        let factors = &factors[from..];
        let within = from * rows..(from + factors.len()) * rows;
        let (left, adjoint) = (&self.left[within.clone()], &self.adjoint()[within]);
        if out.len() * factors.len() <= SMALL_PRODUCT {
            for ((left, adjoint), factor) in left.chunks_exact(rows).zip(adjoint.chunks_exact(rows)).zip(factors) {
                for (out, right) in out.chunks_exact_mut(rows).zip(adjoint) {
                    let weighted = right.conj() * factor;
                    for (out, left) in out.iter_mut().zip(left) {
                        *out += left * weighted;
                    }
                }
            }
            return;
        }
        let weighted = &mut weighted[..left.len()];
        for ((to, adjoint), factor) in weighted
            .chunks_exact_mut(rows)
            .zip(adjoint.chunks_exact(rows))
            .zip(factors)
        {
            for (to, adjoint) in to.iter_mut().zip(adjoint) {
                *to = adjoint.conj() * factor;
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

/// out ← out + Σ f S, the sum of a series with the factors f and the matrices S.
struct Series<'a> {
    sums: &'a [&'a [Complex64]],
    factors: &'a [Complex64],
    out: &'a mut [Complex64],
}

impl WithSimd for Series<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut from = 0;
        for out in self.out.chunks_mut(MODAL_ROWS_ENTRIES) {
            let [mut by_re, mut by_im] = [[0.0; 2 * MODAL_ROWS_ENTRIES]; 2];
            let numbers = 2 * out.len();
            for (sum, factor) in self.sums.iter().zip(self.factors) {
                let sum = cast_slice::<Complex64, f64>(&sum[from..from + out.len()]);
                for ((a, b), s) in by_re[..numbers].iter_mut().zip(&mut by_im[..numbers]).zip(sum) {
                    *a += factor.re * s;
                    *b += factor.im * s;
                }
            }
            for (k, out) in out.iter_mut().enumerate() {
                *out += Complex64::new(by_re[2 * k] - by_im[2 * k + 1], by_re[2 * k + 1] + by_im[2 * k]);
            }
            from += out.len();
        }
    }
}

/// Springs that the modes leave out; each has a row of its own.
fn all_springs(source: &Source) -> &[(MotionRow, f64)] {
    match source {
        Source::Modes(modes) => &modes.springs,
        Source::Poles(_) => &[],
    }
}

/// Directions of damping that the modes leave out; each has a row of its own.
fn all_dampers(source: &Source) -> &[MotionRow] {
    match source {
        Source::Modes(modes) => &modes.dampers,
        Source::Poles(_) => &[],
    }
}

#[cfg(test)]
#[path = "modal_rows_tests.rs"]
mod tests;
