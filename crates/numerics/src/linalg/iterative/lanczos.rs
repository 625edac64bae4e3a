//! The lowest eigenpairs of a large sparse pencil K φ = λ M φ, or those of an interval, by shift-invert Lanczos.
//!
//! The operator (K + σM)⁻¹ M is self-adjoint in the M-inner product; its largest eigenvalues 1/(λ + σ) belong to
//! the lowest λ, or those largest by modulus to the λ next to a shift −σ among them (Ericsson & Ruhe 1980,
//! doi:10.1090/S0025-5718-1980-0583502-2). The basis is kept orthogonal in full. Repeated eigenvalues need a starting
//! vector for each copy: after convergence the search starts again, orthogonal to the vectors found, until it finds no
//! larger eigenvalue. Where the lowest are close to each other and far from the shift, as those of a family of equal blades, a run
//! does not tell them apart: then the shift moves up to just below them.

use crate::error::{Result, check_memory, fail, try_copy, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::dense::eigen::{self, Pairs};
use crate::linalg::dense::tridiagonal;
use crate::linalg::factors::shifted_inverse::{BelowAll, Inverse, Place, below_all, definite_inverse};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::{ENOUGH_LEFT, inner, inner_in_parts, remove};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Relative residual of an eigenvalue of the operator that counts as converged, and of one of an interval; an eigenvalue errs by the
/// square.
/// Kind: rounding.
const LANCZOS_TOLERANCE: f64 = 1e-13;
const OF_INTERVAL: f64 = 1e-9;

/// The same of a vector that is kept.
/// Kind: rounding.
const VECTOR: f64 = 1e-8;

/// Share of a vector outside the space of the others below which it is rounding only.
/// Kind: rounding.
const LANCZOS_EXHAUSTED: f64 = 1e-12;

/// Value of the operator below zero, relative to the largest, that is no rounding.
/// Kind: rounding.
const NEGATIVE: f64 = 1e-12;

/// Lanczos steps per search, besides twice the number of eigenvalues.
/// Kind: tuned; measured on: not recorded.
const EXTRA_STEPS: usize = 120;

const CONTEXT: &str = "the eigenvectors";

/// The `count` lowest eigenpairs of Hermitian K and positive semidefinite M, mass-normalised.
///
/// # Errors
/// `Singular` when K + σM is singular, `NotPositiveDefinite` when M is negative in some direction, `NoConvergence`,
/// `OutOfMemory`; `StoppedByCaller`.
pub fn lowest(k: &Csc, m: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    interrupt.check()?;
    let n = k.rows;
    if (0..n).map(|i| m.get(i, i).re).sum::<f64>() <= 0.0 {
        return fail!(NotPositiveDefinite, "mass matrix is zero: there is no vibration mode");
    }
    // A shift far below the typical stiffness per mass makes K + σM regular for rigid bodies and leaves the lowest
    // eigenvalues well separated from the rest.
    let BelowAll { inverse, shift, place } = below_all(k, m, 1e-7 * typical_stiffness(k, m), interrupt)?;
    if place == Place::Further && n <= DENSE_IF_HARD {
        return all_of(k, m, count, interrupt);
    }
    let mut search = LanczosSearch {
        inverse,
        place,
        mass: m,
        found: Vec::new(),
        is_complete: false,
        open: None,
        interrupt,
    };
    let mut shift = shift;
    for moves in 0..=MOVES {
        search.found.clear();
        search.all_lowest(count)?;
        if search.open.is_none() || moves == MOVES {
            break;
        }
        let Some(nearer) = search.nearer(k, m, shift, interrupt)? else {
            break;
        };
        (search.inverse, shift) = nearer;
    }
    if search.found.is_empty() {
        return fail!(
            NoConvergence,
            "no eigenvalue converged in {} Lanczos steps",
            search.steps(count)
        );
    }
    if search.found.len() < count && (place == Place::Further || search.open.is_some()) {
        let why = if place == Place::Further {
            format!(
                "the stiffness is negative in some direction, where a motion grows as {:e} per time unit or less; ",
                shift.max(0.0).sqrt()
            )
        } else {
            String::new()
        };
        return fail!(
            NoConvergence,
            "{why}of {count} natural modes, {} were found",
            search.found.len()
        );
    }
    search.found.sort_by(|a, b| b.0.total_cmp(&a.0));
    search.found.truncate(count);
    search.pairs(shift)
}

/// Typical stiffness of a degree of freedom over its mass: that of all together, or their geometric mean, which a few under a
/// penalty hardly change.
fn typical_stiffness(k: &Csc, m: &Csc) -> f64 {
    let (mut stiff, mut heavy, mut logarithms, mut count) = (0.0, 0.0, 0.0, 0.0);
    for (stiffness, mass) in (0..k.rows).map(|i| (k.get(i, i).re.abs(), m.get(i, i).re)) {
        stiff += stiffness;
        heavy += mass;
        if stiffness > 0.0 && mass > 0.0 {
            logarithms += (stiffness / mass).ln();
            count += 1.0;
        }
    }
    let together: f64 = stiff / heavy;
    if count > 0.0 {
        together.min((logarithms / count).exp())
    } else {
        together
    }
}

/// Most moves of the shift, and growth of its distance from the lowest eigenvalue where that is estimated too high.
/// Kind: cap.
const MOVES: usize = 8;
/// Growth of the distance of the shift from the lowest eigenvalue where that is estimated too high.
/// Kind: tuned; measured on: not recorded.
const BACK: f64 = 4.0;

/// All eigenpairs with λ in an interval (low, high) by one search, mass-normalised and ascending; `None` if they are more than `most`.
///
/// # Errors
/// As [`lowest`].
pub(super) fn within_at_once(
    (k, m): (&Csc, &Csc),
    (low, high): (f64, f64),
    most: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Pairs>> {
    interrupt.check()?;
    // Not in the very middle, where a symmetric structure may have an eigenvalue.
    let shift = -(low + INSIDE * (high - low));
    let farthest = (high + shift).max(-shift - low);
    let mut search = LanczosSearch {
        inverse: Inverse::new(k, (shift, m), interrupt)?,
        place: Place::Inside,
        mass: m,
        found: Vec::new(),
        is_complete: false,
        open: None,
        interrupt,
    };
    let mut round = 0;
    // The search ends when a run orthogonal to the vectors found finds no other.
    while search.run(Goal::Above(farthest.recip(), most), round)? > 0.0 {
        if !search.is_complete || search.found.len() > most {
            return Ok(None);
        }
        round += 1;
    }
    if !search.is_complete {
        return Ok(None);
    }
    search
        .found
        .retain(|(mu, ..)| (low..=high).contains(&(1.0 / mu - shift)));
    search.found.sort_by(|a, b| (1.0 / a.0).total_cmp(&(1.0 / b.0)));
    search.pairs(shift).map(Some)
}

/// Place of the shift in an interval.
/// Kind: tuned; measured on: not recorded.
const INSIDE: f64 = 0.4873;

/// Eigenvalues of the operator that a search must find.
#[derive(Clone, Copy)]
enum Goal {
    /// The given number of the largest eigenvalues.
    Largest(usize),
    /// All eigenvalues whose modulus is at least the first number, if there are at most as many as the second.
    Above(f64, usize),
}

/// Order up to which dense algebra, some seconds for all modes, takes over where a search is hard: of a stiffness that is negative in some
/// direction, or of eigenvalues that are too many or too close to be told apart.
/// Kind: tuned; measured on: not recorded.
pub const DENSE_IF_HARD: usize = 400;

/// Largest number of square matrices that [`eigen::generalised`] holds at a time.
/// Kind: fixed.
const LANCZOS_EIGEN_COPIES: usize = 8;

/// The lowest pairs, by dense algebra, which finds all.
fn all_of(k: &Csc, m: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    let n = k.rows;
    check_memory::<Complex64>(
        n.saturating_mul(n).saturating_mul(LANCZOS_EIGEN_COPIES),
        "the natural modes",
    )?;
    let dense = |a: &Csc| {
        let mut d = DMatrix::<Complex64>::zeros(n, n);
        a.add_to_dense(Complex64::ONE, d.as_mut_slice());
        d
    };
    let mut pairs = eigen::generalised(&dense(k), &dense(m), interrupt)?;
    pairs.values.truncate(count);
    let kept = pairs.values.len();
    pairs.vectors = pairs.vectors.columns(0, kept).into_owned();
    Ok(pairs)
}

struct LanczosSearch<'a> {
    inverse: Inverse,
    place: Place,
    mass: &'a Csc,
    interrupt: &'a Interrupt<'a>,
    /// Eigenvalues 1/(λ + σ) of the operator, with their vectors φ, and M φ.
    found: Vec<(f64, Vec<Complex64>, Vec<Complex64>)>,
    /// Whether the last run reached its goal.
    is_complete: bool,
    /// Largest Ritz values that the last run for the largest eigenvalues left unconverged; `None` if it left none.
    open: Option<Open>,
}

/// Largest Ritz values that have not converged: the first one, its largest distance from an eigenvalue, and the last
/// requested one.
#[derive(Clone, Copy)]
struct Open {
    first: f64,
    bound: f64,
    last: f64,
}

/// Basis q of a run, M q, and the Lanczos matrix by its diagonal and the entries beside it.
#[derive(Default)]
struct Run {
    basis: Vec<Vec<Complex64>>,
    weighted: Vec<Vec<Complex64>>,
    alpha: Vec<f64>,
    /// Entries beside the diagonal, beginning with the size of the first vector.
    beta: Vec<f64>,
}

impl Run {
    /// Ritz values; and the last `rows` coefficients of their vectors, vector after vector.
    fn ritz(&self, rows: usize, interrupt: &Interrupt<'_>) -> Result<(Vec<f64>, Vec<f64>)> {
        let size = self.alpha.len();
        let (mut values, mut beside) = (try_copy(&self.alpha, CONTEXT)?, try_vec(size, 0.0, CONTEXT)?);
        for (to, beta) in beside.iter_mut().zip(&self.beta[1..]) {
            *to = *beta;
        }
        let mut last = try_vec(rows * size, 0.0, CONTEXT)?;
        for row in 0..rows {
            last[(size - rows + row) * rows + row] = 1.0;
        }
        tridiagonal::diagonalise(&mut values, &mut beside, &mut last, interrupt, |_| Ok(()))?;
        Ok((values, last))
    }
}

impl LanczosSearch<'_> {
    /// Finds the `count` largest eigenvalues of the operator at this shift; `open` shows whether some may be missing.
    fn all_lowest(&mut self, count: usize) -> Result<()> {
        for round in 0..=count {
            let before = self.smallest(count);
            let new = self.run(Goal::Largest(count), round)?;
            let is_full = self.found.len() >= count;
            // Eigenvalues below those found are not wanted, whether they have converged or not.
            if is_full && self.open.is_some_and(|open| open.first + open.bound <= before) {
                self.open = None;
            }
            // The search ends when the last run found nothing that belongs among the lowest.
            if self.open.is_some() || is_full && new <= before * (1.0 + 1e-9) {
                break;
            }
        }
        Ok(())
    }

    /// A shift closer below the lowest eigenvalues, with the inverse at it; `None` if there is none.
    fn nearer(&self, k: &Csc, m: &Csc, shift: f64, interrupt: &Interrupt<'_>) -> Result<Option<(Inverse, f64)>> {
        let Some(open) = self.open.filter(|_| self.place != Place::Within) else {
            return Ok(None);
        };
        let found = self.found.iter().map(|found| found.0);
        let top = found.fold(open.first, f64::max);
        if open.last <= 0.0 {
            return Ok(None);
        }
        // Distances of eigenvalues λ from the present shift −σ.
        let (lowest, highest) = (top.recip(), open.last.recip());
        let mut below = (highest - lowest + open.bound / open.first.powi(2)).min(0.5 * lowest);
        while below < 0.9 * lowest {
            let sigma = shift - (lowest - below);
            if let Some(inverse) = definite_inverse(k, sigma, m, interrupt)? {
                return Ok(Some((inverse, sigma)));
            }
            below *= BACK;
        }
        Ok(None)
    }

    /// Number of Lanczos steps in a run for up to `most` eigenvalues.
    fn steps(&self, most: usize) -> usize {
        let n = self.mass.rows;
        let extra = match self.place {
            Place::Further if n <= 20_000 => 5 * EXTRA_STEPS,
            _ => EXTRA_STEPS,
        };
        (2 * most + extra).min(n - self.found.len())
    }

    /// The `count`-th largest eigenvalue found so far, 0 if there are fewer.
    fn smallest(&self, count: usize) -> f64 {
        let mut values: Vec<f64> = self.found.iter().map(|f| f.0).collect();
        values.sort_by(|a, b| b.total_cmp(a));
        values.get(count - 1).copied().unwrap_or(0.0)
    }

    /// The eigenpairs found, in the order of λ.
    fn pairs(&self, shift: f64) -> Result<Pairs> {
        let n = self.mass.rows;
        let values = try_vec(n.saturating_mul(self.found.len()), Complex64::ZERO, CONTEXT)?;
        let mut vectors = DMatrix::from_vec(n, self.found.len(), values);
        for (mut column, (_, v, _)) in vectors.column_iter_mut().zip(&self.found) {
            column.as_mut_slice().copy_from_slice(v);
        }
        Ok(Pairs {
            values: self.found.iter().map(|(mu, ..)| 1.0 / mu - shift).collect(),
            vectors,
        })
    }

    /// One Lanczos run, orthogonal to the vectors found before. It stores its converged pairs, and returns the
    /// largest new eigenvalue by modulus.
    fn run(&mut self, goal: Goal, round: usize) -> Result<f64> {
        let n = self.mass.rows;
        let (Goal::Largest(most) | Goal::Above(_, most)) = goal;
        let steps = self.steps(most);
        self.is_complete = true;
        self.open = None;
        if steps == 0 {
            return Ok(0.0);
        }
        let mut run = Run::default();
        let mut v = start(n, round)?;
        // One application moves the starting vector into the range of the operator, free of massless motion.
        self.apply(&mut v)?;
        for step in 0..steps {
            self.interrupt.part(Phase::Modes, step, steps)?;
            let before = inner(&v, &self.times_mass(&v)?).re.max(0.0).sqrt();
            self.orthogonalise(&mut v, &run)?;
            let mut mv = self.times_mass(&v)?;
            let square = inner(&v, &mv).re;
            if square < -(LANCZOS_EXHAUSTED * before).powi(2) {
                return fail!(NotPositiveDefinite, "mass matrix is not positive semidefinite");
            }
            let norm = square.max(0.0).sqrt();
            // A structure with few masses has few modes: the remaining vector is rounding then.
            if norm <= LANCZOS_EXHAUSTED * before || norm <= 1e-14 * run.beta.first().copied().unwrap_or(0.0) {
                break;
            }
            for x in v.iter_mut().chain(&mut mv) {
                *x /= norm;
            }
            run.beta.push(norm);
            let mut next = mv.clone();
            self.inverse.solve(&mut next, self.interrupt)?;
            run.alpha.push(inner(&mv, &next).re);
            try_push(&mut run.basis, v, CONTEXT)?;
            try_push(&mut run.weighted, mv, CONTEXT)?;
            v = next;
            let done = run.basis.len();
            let may_end = done > most || matches!(goal, Goal::Above(..));
            if may_end && done.is_multiple_of(10) && self.converged(&run, goal, &v)? {
                break;
            }
            self.is_complete = step + 1 < steps || steps + self.found.len() == n;
        }
        self.keep(&run, goal, &v)
    }

    /// Size of the part of the next vector that the basis does not hold.
    fn after(&self, run: &Run, v: &[Complex64]) -> Result<f64> {
        let mut rest = v.to_vec();
        self.orthogonalise(&mut rest, run)?;
        Ok(inner(&rest, &self.times_mass(&rest)?).re.max(0.0).sqrt())
    }

    /// Whether the goal is reached, or cannot be reached.
    fn converged(&self, run: &Run, goal: Goal, v: &[Complex64]) -> Result<bool> {
        let after = self.after(run, v)?;
        let (values, last) = run.ritz(1, self.interrupt)?;
        let mut ritz: Vec<(f64, f64)> = values.into_iter().zip(last).collect();
        let small = |(mu, last): &(f64, f64), tolerance: f64| after * last.abs() <= tolerance * mu.abs();
        Ok(match goal {
            Goal::Largest(count) => {
                ritz.sort_by(|a, b| b.0.total_cmp(&a.0));
                ritz.iter().take(count).all(|found| small(found, LANCZOS_TOLERANCE))
            }
            // With one beyond, none is missed.
            Goal::Above(least, most) => {
                ritz.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
                let above = ritz.iter().take_while(|found| found.0.abs() >= least).count();
                above > most || above < ritz.len() && ritz.iter().take(above + 1).all(|found| small(found, OF_INTERVAL))
            }
        })
    }

    /// Stores the converged pairs that belong to the goal; returns the largest of their eigenvalues, by modulus.
    fn keep(&mut self, run: &Run, goal: Goal, v: &[Complex64]) -> Result<f64> {
        if run.alpha.is_empty() {
            return Ok(0.0);
        }
        let mut largest = 0.0_f64;
        let after = self.after(run, v)?;
        let size = run.alpha.len();
        let (values, vectors) = run.ritz(size, self.interrupt)?;
        let mut ritz: Vec<(f64, f64, &[f64])> = (values.iter().zip(vectors.chunks_exact(size)))
            .map(|(&mu, s)| (mu, after * s[size - 1].abs(), s))
            .collect();
        ritz.sort_by(|a, b| b.0.total_cmp(&a.0));
        // The least value of the operator shows an eigenvalue below the shift.
        let ends = ritz.first().zip(ritz.last());
        if self.place == Place::Within
            && ends.is_some_and(|(first, last)| last.0 < -NEGATIVE * first.0.abs() && last.1 < 0.5 * last.0.abs())
        {
            return fail!(
                NotPositiveDefinite,
                "the stiffness is negative in some direction with mass, and in one without mass: the lowest natural modes are not \
                 known"
            );
        }
        match goal {
            Goal::Largest(count) => {
                ritz.truncate(count);
                let good = ritz
                    .iter()
                    .take_while(|(mu, bound, _)| *mu > 0.0 && *bound <= VECTOR * mu);
                let good = good.count();
                if let Some(&(first, bound, _)) = ritz.get(good).filter(|(mu, ..)| !self.is_complete && *mu > 0.0) {
                    let last = ritz
                        .iter()
                        .rev()
                        .find(|(mu, ..)| *mu > 0.0)
                        .map_or(first, |found| found.0);
                    self.open = Some(Open { first, bound, last });
                }
                ritz.truncate(good);
            }
            Goal::Above(least, _) => ritz.retain(|(mu, bound, _)| mu.abs() >= least && *bound <= VECTOR * mu.abs()),
        }
        for (mu, _, s) in ritz {
            self.interrupt.check()?;
            let mut x = try_vec(run.basis[0].len(), Complex64::ZERO, CONTEXT)?;
            for (q, c) in run.basis.iter().zip(s) {
                for (x, q) in x.iter_mut().zip(q) {
                    *x += q * c;
                }
            }
            largest = largest.max(mu.abs());
            let mx = self.times_mass(&x)?;
            try_push(&mut self.found, (mu, x, mx), CONTEXT)?;
        }
        Ok(largest)
    }

    /// v ← (K + σM)⁻¹ M v.
    fn apply(&mut self, v: &mut Vec<Complex64>) -> Result<()> {
        *v = self.times_mass(v)?;
        self.inverse.solve(v, self.interrupt)
    }

    fn times_mass(&self, v: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut mv = try_vec(v.len(), Complex64::ZERO, CONTEXT)?;
        self.mass.multiply_add(Complex64::ONE, v, &mut mv);
        Ok(mv)
    }

    /// Removes from v its components along the basis and along the vectors found, again where little of it is left: once leaves rounding
    /// of the size of v before, relative to v after (Giraud & Langou 2002, doi:10.1093/imanum/22.4.521).
    fn orthogonalise(&self, v: &mut [Complex64], run: &Run) -> Result<()> {
        let square = |v: &[Complex64]| -> Result<f64> { Ok(inner_in_parts(v, &self.times_mass(v)?).re.max(0.0)) };
        // By Lanczos' recurrence the components along the last two are all that is not rounding.
        let last = run.basis.len().saturating_sub(2);
        for (q, mq) in run.basis[last..].iter().zip(&run.weighted[last..]) {
            remove(v, q, inner_in_parts(mq, v));
        }
        for _ in 0..2 {
            let before = square(v)?;
            for (q, mq) in run.basis.iter().zip(&run.weighted) {
                remove(v, q, inner_in_parts(mq, v));
            }
            for (_, q, mq) in &self.found {
                remove(v, q, inner_in_parts(mq, v));
            }
            if square(v)? >= ENOUGH_LEFT.powi(2) * before {
                break;
            }
        }
        Ok(())
    }
}

/// A starting vector without structure, the same on every run.
pub(crate) fn start(n: usize, round: usize) -> Result<Vec<Complex64>> {
    let mut v = try_vec(n, Complex64::ZERO, CONTEXT)?;
    let mut state = 0x9e37_79b9_7f4a_7c15_u64 ^ (round as u64 + 1);
    let mut draw = || {
        // xorshift (Marsaglia 2003, doi:10.18637/jss.v008.i14)
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for x in &mut v {
        *x = Complex64::new(draw(), draw());
    }
    Ok(v)
}

#[cfg(test)]
#[path = "lanczos_tests.rs"]
mod tests;
