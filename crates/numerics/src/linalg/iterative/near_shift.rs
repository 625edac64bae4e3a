//! Eigenvalues λ of (λ²M + λC + K) x = 0 next to a shift σ, by Arnoldi's method on the linearisation, inverted at the shift.
//!
//! On states z = (x, v), v = λx/u, the operator
//!
//! > S (x, v) = (p, (x + σp)/u),  p = −(σ²M + σC + K)⁻¹ (u M v + (C + σM) x)
//!
//! has the eigenvalues μ = 1/(λ − σ) (Tisseur & Meerbergen 2001, doi:10.1137/S0036144500381988): those of largest modulus are next to
//! the shift. Vectors that have converged are kept as orthonormal Schur vectors Q, and the search goes on with (I − QQᴴ)S, so that it
//! finds further copies of a repeated eigenvalue. It ends when a run from a new vector finds nothing that belongs to the others.

use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::dense::general_eigen;
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::low_rank_term::{LowRankTerm, Sides, add_term_product};
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::iterative::lanczos;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::linalg::{ENOUGH_LEFT, inner, inner_in_parts, remove};
use num_complex::Complex64;

/// Residual of an eigenvalue of the operator, relative to it, that counts as converged.
/// Kind: rounding.
const NEAR_SHIFT_CONVERGED: f64 = 1e-12;

/// Multiple of the residual by which an eigenvalue that is not wanted must be away from those that are.
/// Kind: tuned; measured on: not recorded.
const CLEAR: f64 = 10.0;

/// Part of a vector outside the space of the others below which it is rounding only.
/// Kind: rounding.
const NO_MORE: f64 = 1e-13;

/// Part of the coefficients of an eigenvector outside those of the others below which it is no other vector.
/// Kind: rounding.
const NEAR_SHIFT_DEPENDENT: f64 = 1e-6;

/// Steps of a run beyond twice the number of eigenvalues that it is for.
/// Kind: tuned; measured on: not recorded.
const MORE_STEPS: usize = 50;

/// Most of these steps, to which runs grow that find nothing: as many families of modes of a wheel need, each of which lies within a share
/// of its distance from the shift.
/// Kind: cap.
const MOST_MORE_STEPS: usize = 400;

/// Largest number of runs for a goal.
/// Kind: cap.
const RUNS: usize = 80;

/// Two moduli that count as one, relatively.
/// Kind: rounding.
const NEAR_SHIFT_ALIKE: f64 = 1e-9;

/// Error of an eigenvalue of the operator, relative to it, from which on those farther away do not count as found.
/// Kind: rounding.
const POOR: f64 = 1e-7;

const CONTEXT: &str = "the damped modes";

/// Eigenvalues that a search must find.
#[derive(Clone, Copy, Debug)]
pub enum Goal {
    /// The given number of eigenvalues nearest to the shift.
    Nearest(usize),
    /// All eigenvalues within a radius of the shift, if there are at most the given number.
    Within(f64, usize),
}

/// Eigenvalues next to a shift.
#[derive(Debug)]
pub struct Near {
    /// λ and x of the eigenvalues found, by rising distance from the shift.
    pub pairs: Vec<(Complex64, Vec<Complex64>)>,
    /// Distance from the shift up to which all eigenvalues are found.
    pub radius: f64,
}

/// The operator with the Schur vectors found so far.
pub struct NearShift<'a> {
    mass: &'a Csc,
    damping: &'a Csc,
    /// Columns of L of further damping L Lᴴ; with the term beside the factors, and the matrix of these.
    directions: &'a [SparseVector],
    term: Option<(LowRankTerm, Csc)>,
    shift: Complex64,
    unit: f64,
    factor: Factor,
    /// Orthonormal Schur vectors of the states, each with |μ|.
    kept: Vec<(f64, Vec<Complex64>)>,
    runs: usize,
    interrupt: &'a Interrupt<'a>,
}

/// Orthonormal vectors of a run; and the columns of the Hessenberg matrix with the entry below the diagonal.
#[derive(Default)]
struct Run {
    basis: Vec<Vec<Complex64>>,
    columns: Vec<Vec<Complex64>>,
}

/// Ritz values of a run, the largest first: μ, residual and coefficients.
type Ritz = Vec<(Complex64, f64, Vec<Complex64>)>;

/// Outcome of a run.
struct End {
    /// Largest modulus of a new eigenvalue that was kept.
    largest: f64,
    /// Whether the run settled its goal.
    is_settled: bool,
    /// Sum of the vectors that did not converge; `None` if all did.
    rest: Option<Vec<Complex64>>,
    /// Whether no further motion is left.
    is_empty: bool,
}

impl<'a> NearShift<'a> {
    /// The operator at `shift` for M, C and K.
    ///
    /// # Errors
    /// `Singular` at an eigenvalue, `OutOfMemory`; `StoppedByCaller`.
    pub fn new(matrices: [&'a Csc; 3], shift: Complex64, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        Self::with_directions(matrices, &[], shift, interrupt)
    }

    /// The same for M, C + L Lᴴ and K with the columns of L.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_directions(
        [mass, damping, stiffness]: [&'a Csc; 3],
        directions: &'a [SparseVector],
        shift: Complex64,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let terms = [
            (Complex64::ONE, stiffness, Form::Plain),
            (shift, damping, Form::Plain),
            (shift * shift, mass, Form::Plain),
        ];
        let matrix = Csc::sum(mass.rows, &terms)?;
        let mut factor = Factor::new(&matrix, 1)?;
        factor.factor(&matrix, interrupt)?;
        let term = if directions.is_empty() {
            None
        } else {
            let mut term = LowRankTerm::new(mass.rows, directions.len())?;
            let mut sides = Sides {
                factor: &mut factor,
                matrix: &matrix,
                directions,
            };
            term.renew(shift, &mut sides, interrupt)?;
            Some((term, matrix))
        };
        Ok(Self {
            mass,
            damping,
            directions,
            term,
            shift,
            unit: shift.norm(),
            factor,
            kept: Vec::new(),
            runs: 0,
            interrupt,
        })
    }

    /// The shift σ.
    #[must_use]
    pub fn shift(&self) -> Complex64 {
        self.shift
    }

    /// Finds the eigenvalues of the goal, in addition to those of earlier searches.
    ///
    /// # Errors
    /// `NoConvergence`, `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn search(&mut self, goal: Goal) -> Result<Near> {
        let order = 2 * self.mass.rows;
        let (mut start, mut more) = (None, MORE_STEPS);
        for _ in 0..RUNS {
            if self.kept.len() >= order {
                return self.near(f64::INFINITY);
            }
            let level = self.level(goal);
            let is_full = match goal {
                Goal::Nearest(count) => self.kept.len() >= count,
                Goal::Within(_, most) if self.kept.len() > most => return self.near(0.0),
                Goal::Within(..) => true,
            };
            let is_new = start.is_none();
            let end = self.run(goal, start, more)?;
            if !end.is_settled && end.largest == 0.0 {
                more = (more + more / 2).min(MOST_MORE_STEPS);
            }
            if end.is_empty && is_new {
                return self.near(f64::INFINITY);
            }
            if end.is_settled && is_full && is_new && end.largest <= level * (1.0 + NEAR_SHIFT_ALIKE) {
                return self.near((1.0 - NEAR_SHIFT_ALIKE) / level);
            }
            start = end.rest.filter(|_| !end.is_settled);
        }
        fail!(
            NoConvergence,
            "of the damped modes next to {} + {}i only {} were found in {RUNS} runs",
            self.shift.re,
            self.shift.im,
            self.kept.len()
        )
    }

    /// Level of |μ| above which all eigenvalues are requested.
    fn level(&self, goal: Goal) -> f64 {
        match goal {
            Goal::Within(radius, _) => radius.recip(),
            Goal::Nearest(count) => {
                let mut sizes: Vec<f64> = self.kept.iter().map(|kept| kept.0).collect();
                sizes.sort_by(|a, b| b.total_cmp(a));
                sizes.get(count - 1).copied().unwrap_or(0.0)
            }
        }
    }

    /// A run from a vector, or a new one, with `more` steps beyond those for the number of eigenvalues.
    fn run(&mut self, goal: Goal, start: Option<Vec<Complex64>>, more: usize) -> Result<End> {
        let order = 2 * self.mass.rows;
        let (level, wanted) = match goal {
            Goal::Nearest(count) => (self.level(goal), count.saturating_sub(self.kept.len()).max(1)),
            Goal::Within(..) => (self.level(goal), 1),
        };
        let mut v = match start {
            Some(v) => v,
            // One application moves the vector into the range of the operator, free of massless motion.
            None => self.applied(&lanczos::start(order, self.runs)?)?,
        };
        self.runs += 1;
        let before = size(&v);
        let mut run = Run::default();
        self.orthogonalise(&mut v, &run, &mut [])?;
        let settled = End {
            largest: 0.0,
            is_settled: true,
            rest: None,
            is_empty: true,
        };
        if size(&v) <= NO_MORE * before || before == 0.0 {
            return Ok(settled);
        }
        let steps = (2 * wanted + more).min(order - self.kept.len());
        let mut next_look = (wanted + 10).min(steps);
        for step in 1..=steps {
            self.interrupt.part(Phase::Modes, step, steps)?;
            let norm = size(&v);
            for z in &mut v {
                *z /= norm;
            }
            let mut next = self.applied(&v)?;
            try_push(&mut run.basis, v, CONTEXT)?;
            let before = size(&next);
            let mut column = try_vec(step + 1, Complex64::ZERO, CONTEXT)?;
            self.orthogonalise(&mut next, &run, &mut column)?;
            let after = size(&next);
            let is_closed = after <= NO_MORE * before;
            column[step] = if is_closed { 0.0 } else { after }.into();
            try_push(&mut run.columns, column, CONTEXT)?;
            if is_closed || step == next_look || step == steps {
                let ritz = run.ritz(self.interrupt)?;
                let is_settled = is_closed || are_settled(&ritz, level, wanted);
                if is_settled || step == steps {
                    return self.keep(&run, &ritz, level, wanted, is_settled);
                }
                next_look = (step + 10 + step / 5).min(steps);
            }
            v = next;
        }
        Ok(settled)
    }

    /// Keeps those vectors of a run that have converged and are requested.
    fn keep(&mut self, run: &Run, ritz: &Ritz, level: f64, wanted: usize, is_settled: bool) -> Result<End> {
        let mut end = End {
            largest: 0.0,
            is_settled,
            rest: None,
            is_empty: false,
        };
        let mut rest: Vec<Complex64> = Vec::new();
        let mut chosen: Vec<Vec<Complex64>> = Vec::new();
        for (i, (mu, residual, coefficients)) in ritz.iter().enumerate() {
            let modulus = mu.norm();
            let is_wanted = if level > 0.0 {
                modulus > level * (1.0 + NEAR_SHIFT_ALIKE)
            } else {
                i < wanted
            };
            if !is_wanted || modulus == 0.0 {
                break;
            }
            self.interrupt.check()?;
            if *residual > NEAR_SHIFT_CONVERGED * modulus {
                let part = run.combined(coefficients)?;
                if rest.is_empty() {
                    rest = part;
                } else {
                    remove(&mut rest, &part, -Complex64::ONE);
                }
                continue;
            }
            let mut y = try_vec(coefficients.len(), Complex64::ZERO, CONTEXT)?;
            y.copy_from_slice(coefficients);
            for _ in 0..2 {
                for other in &chosen {
                    let part = inner(other, &y);
                    remove(&mut y, other, part);
                }
            }
            let norm = size(&y);
            if norm <= NEAR_SHIFT_DEPENDENT {
                continue;
            }
            for z in &mut y {
                *z /= norm;
            }
            let mut state = run.combined(&y)?;
            self.orthogonalise(&mut state, &Run::default(), &mut [])?;
            let norm = size(&state);
            for z in &mut state {
                *z /= norm;
            }
            try_push(&mut chosen, y, CONTEXT)?;
            try_push(&mut self.kept, (modulus, state), CONTEXT)?;
            end.largest = end.largest.max(modulus);
        }
        if !rest.is_empty() {
            end.rest = Some(rest);
        }
        Ok(end)
    }

    /// Eigenvalues of the operator on the space of the vectors kept.
    fn near(&mut self, mut radius: f64) -> Result<Near> {
        let (n, count) = (self.mass.rows, self.kept.len());
        let mut moved = Vec::new();
        for i in 0..count {
            let state = core::mem::take(&mut self.kept[i].1);
            let image = self.applied(&state);
            self.kept[i].1 = state;
            try_push(&mut moved, image?, CONTEXT)?;
        }
        let mut small = try_vec(count * count, Complex64::ZERO, CONTEXT)?;
        for (column, image) in small.chunks_exact_mut(count.max(1)).zip(&moved) {
            self.interrupt.check()?;
            for (to, (_, q)) in column.iter_mut().zip(&self.kept) {
                *to = inner(q, image);
            }
        }
        let found = general_eigen::eigen(&small, count, self.interrupt)?;
        let mut pairs = Vec::new();
        for (mu, y) in found.values.iter().zip(found.vectors.chunks_exact(count.max(1))) {
            self.interrupt.check()?;
            let mut state = try_vec(2 * n, Complex64::ZERO, CONTEXT)?;
            let mut off = try_vec(2 * n, Complex64::ZERO, CONTEXT)?;
            for (c, ((_, q), image)) in y.iter().zip(self.kept.iter().zip(&moved)) {
                remove(&mut state, q, -c);
                remove(&mut off, image, -c);
            }
            remove(&mut off, &state, *mu);
            let distance = mu.norm().recip();
            if size(&off) > POOR * mu.norm() * size(&state) {
                radius = radius.min(distance * (1.0 - NEAR_SHIFT_ALIKE));
            }
            state.truncate(n);
            try_push(&mut pairs, (self.shift + mu.inv(), state), CONTEXT)?;
        }
        pairs.sort_by(|a, b| (a.0 - self.shift).norm().total_cmp(&(b.0 - self.shift).norm()));
        Ok(Near { pairs, radius })
    }

    /// Operator product S z.
    fn applied(&mut self, z: &[Complex64]) -> Result<Vec<Complex64>> {
        let n = self.mass.rows;
        let (x, v) = z.split_at(n);
        let mut state = try_vec(2 * n, Complex64::ZERO, CONTEXT)?;
        let (p, q) = state.split_at_mut(n);
        self.mass.multiply_add((-self.unit).into(), v, p);
        self.mass.multiply_add(-self.shift, x, p);
        self.damping.multiply_add(-Complex64::ONE, x, p);
        if let Some((term, matrix)) = &mut self.term {
            add_term_product(self.directions, -Complex64::ONE, false, x, p);
            let mut sides = Sides {
                factor: &mut self.factor,
                matrix,
                directions: self.directions,
            };
            term.solve(&mut sides, p, false, self.interrupt)?;
        } else {
            self.factor.solve(p, false, self.interrupt)?;
        }
        for ((q, p), x) in q.iter_mut().zip(p.iter()).zip(x) {
            *q = (x + self.shift * p) / self.unit;
        }
        Ok(state)
    }

    /// Removes from v its components along the kept vectors and those of the run, again where little of it is left; those along the run
    /// are added to `column`.
    fn orthogonalise(&self, v: &mut [Complex64], run: &Run, column: &mut [Complex64]) -> Result<()> {
        for _ in 0..2 {
            self.interrupt.check()?;
            let before = size(v);
            for (_, q) in &self.kept {
                remove(v, q, inner_in_parts(q, v));
            }
            for (q, h) in run.basis.iter().zip(column.iter_mut()) {
                let part = inner_in_parts(q, v);
                remove(v, q, part);
                *h += part;
            }
            if size(v) >= ENOUGH_LEFT * before {
                break;
            }
        }
        Ok(())
    }
}

impl Run {
    /// Ritz values, the largest first.
    fn ritz(&self, interrupt: &Interrupt<'_>) -> Result<Ritz> {
        let m = self.columns.len();
        let mut h = try_vec(m * m, Complex64::ZERO, CONTEXT)?;
        for (j, column) in self.columns.iter().enumerate() {
            let rows = (j + 2).min(m);
            h[j * m..j * m + rows].copy_from_slice(&column[..rows]);
        }
        let after = self.columns[m - 1][m].norm();
        let found = general_eigen::eigen(&h, m, interrupt)?;
        let mut ritz = Vec::new();
        for (mu, y) in found.values.iter().zip(found.vectors.chunks_exact(m)) {
            let mut coefficients = try_vec(m, Complex64::ZERO, CONTEXT)?;
            coefficients.copy_from_slice(y);
            try_push(&mut ritz, (*mu, after * y[m - 1].norm(), coefficients), CONTEXT)?;
        }
        ritz.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
        Ok(ritz)
    }

    fn combined(&self, coefficients: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut sum = try_vec(self.basis[0].len(), Complex64::ZERO, CONTEXT)?;
        for (q, c) in self.basis.iter().zip(coefficients) {
            remove(&mut sum, q, -c);
        }
        Ok(sum)
    }
}

/// Whether the requested values have converged: all above the level, and one that is clearly below it; or without a
/// level the first ones.
fn are_settled(ritz: &Ritz, level: f64, wanted: usize) -> bool {
    let converged =
        |(mu, residual, _): &(Complex64, f64, Vec<Complex64>)| *residual <= NEAR_SHIFT_CONVERGED * mu.norm();
    if level == 0.0 {
        return ritz.iter().take(wanted).all(converged);
    }
    for found in ritz {
        if found.0.norm() + CLEAR * found.1 <= level {
            return true;
        }
        if !converged(found) {
            return false;
        }
        if found.0.norm() <= level {
            return true;
        }
    }
    true
}

fn size(v: &[Complex64]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

#[cfg(test)]
#[path = "near_shift_tests.rs"]
mod tests;
