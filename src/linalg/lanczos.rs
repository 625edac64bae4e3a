//! The lowest eigenpairs of a large sparse pencil K φ = λ M φ by shift-invert Lanczos.
//!
//! The operator (K + σM)⁻¹ M is self-adjoint in the M-inner product; its largest eigenvalues 1/(λ + σ) belong to
//! the lowest λ (Ericsson & Ruhe 1980, doi:10.1090/S0025-5718-1980-0583502-2). The basis is kept orthogonal in
//! full. Repeated eigenvalues need a starting vector for each copy: after convergence the search starts again,
//! orthogonal to the vectors found, until it finds no larger eigenvalue.

use crate::error::{Result, check_memory, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::cholesky::Definite;
use crate::linalg::eigen::{self, Pairs};
use crate::linalg::factor::Factor;
use crate::linalg::hermitian;
use crate::linalg::sparse::{Csc, Form};
use crate::linalg::{inner, remove};
use nalgebra::{DMatrix, SymmetricEigen};
use num_complex::Complex64;

/// Relative residual of an eigenvalue of the operator that counts as converged.
const TOLERANCE: f64 = 1e-13;

/// Share of a vector outside the space of the others below which it is rounding only.
const EXHAUSTED: f64 = 1e-12;

/// Value of the operator below zero, relative to the largest, that is no rounding.
const NEGATIVE: f64 = 1e-12;

/// Lanczos steps per search, besides twice the number of eigenvalues.
const EXTRA_STEPS: usize = 120;

/// The `count` lowest eigenpairs of Hermitian K and positive semidefinite M, mass-normalised.
///
/// # Errors
/// `Singular` when K + σM is singular, `NotPositiveDefinite` when M is negative in some direction, `NoConvergence`,
/// `OutOfMemory`; `StoppedByCaller`.
pub fn lowest(k: &Csc, m: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    interrupt.check()?;
    let n = k.rows;
    let stiff: f64 = (0..n).map(|i| k.get(i, i).re.abs()).sum();
    let heavy: f64 = (0..n).map(|i| m.get(i, i).re).sum();
    if heavy <= 0.0 {
        return fail!(NotPositiveDefinite, "mass matrix is zero: there is no vibration mode");
    }
    // A shift far below the typical stiffness per mass makes K + σM regular for rigid bodies and leaves the lowest
    // eigenvalues well separated from the rest.
    let BelowAll { inverse, shift, place } = below_all(k, m, 1e-7 * stiff / heavy, interrupt)?;
    if place == Place::Further && n <= DENSE_IF_NEGATIVE {
        return all_of(k, m, count, interrupt);
    }
    let mut search = Search {
        inverse,
        place,
        mass: m,
        found: Vec::new(),
        interrupt,
    };
    for round in 0..=count {
        let before = search.smallest(count);
        let new = search.run(count, round)?;
        // The search ends when the last run found nothing that belongs among the lowest.
        if search.found.len() >= count && new <= before * (1.0 + 1e-9) {
            break;
        }
    }
    if place == Place::Further && search.found.len() < count {
        return fail!(
            NoConvergence,
            "the stiffness is negative in some direction, where a motion grows as {:e} per time unit or less; of {count} natural \
             modes, {} were found",
            shift.sqrt(),
            search.found.len()
        );
    }
    search.found.sort_by(|a, b| b.0.total_cmp(&a.0));
    search.found.truncate(count);
    let mut vectors = DMatrix::zeros(n, search.found.len());
    for (mut column, (_, v, _)) in vectors.column_iter_mut().zip(&search.found) {
        column.as_mut_slice().copy_from_slice(v);
    }
    Ok(Pairs {
        values: search.found.iter().map(|(mu, ..)| 1.0 / mu - shift).collect(),
        vectors,
    })
}

/// Growth of the shift from one attempt to the next, number of attempts, and of halvings of the last growth.
const FURTHER: f64 = 100.0;
const ATTEMPTS: i32 = 9;
const HALVINGS: u32 = 5;

/// The inverse of K + σM at a shift −σ below all eigenvalues.
struct BelowAll {
    inverse: Inverse,
    shift: f64,
    place: Place,
}

/// Where the shift is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Next to zero, below all eigenvalues.
    First,
    /// Below an eigenvalue below zero.
    Further,
    /// Next to zero, and not below all eigenvalues: K is negative on motions without mass, too.
    Within,
}

/// Finds a shift below all eigenvalues, from `shift` on, so that the lowest eigenvalues belong to the largest of the operator
/// also where K is negative in some direction.
fn below_all(k: &Csc, m: &Csc, shift: f64, interrupt: &Interrupt<'_>) -> Result<BelowAll> {
    let factors = |sigma: f64| definite_inverse(k, (sigma, m), interrupt);
    if let Some(inverse) = factors(shift)? {
        let place = Place::First;
        return Ok(BelowAll { inverse, shift, place });
    }
    for attempt in 1..ATTEMPTS {
        let mut high = shift * FURTHER.powi(attempt);
        let Some(mut inverse) = factors(high)? else { continue };
        // Next to the lowest eigenvalue, the others are far apart.
        let mut low = high / FURTHER;
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            match factors(middle)? {
                Some(better) => (inverse, high) = (better, middle),
                None => low = middle,
            }
        }
        return Ok(BelowAll {
            inverse,
            shift: high,
            place: Place::Further,
        });
    }
    let inverse = Inverse::new(k, (shift, m), interrupt)?;
    Ok(BelowAll {
        inverse,
        shift,
        place: Place::Within,
    })
}

/// The inverse of K + σM; `None` where that is not positive definite.
fn definite_inverse(k: &Csc, (shift, m): (f64, &Csc), interrupt: &Interrupt<'_>) -> Result<Option<Inverse>> {
    let n = k.rows;
    if n > DENSE_UP_TO {
        return Ok(Definite::new(k, (shift, m), interrupt)?.map(Inverse::Definite));
    }
    let mut dense = try_vec(n * n, Complex64::ZERO, "the natural modes")?;
    k.add_to_dense(Complex64::ONE, &mut dense);
    m.add_to_dense(shift.into(), &mut dense);
    if hermitian::cholesky(&mut dense, n, interrupt)? {
        return Inverse::new(k, (shift, m), interrupt).map(Some);
    }
    Ok(None)
}

/// Order up to which dense algebra finds the modes of a stiffness that is negative in some direction.
const DENSE_IF_NEGATIVE: usize = 400;

/// Largest number of square matrices that [`eigen::generalised`] holds at a time.
const EIGEN_COPIES: usize = 8;

/// The lowest of all pairs, by dense algebra.
fn all_of(k: &Csc, m: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    let n = k.rows;
    check_memory::<Complex64>(n.saturating_mul(n).saturating_mul(EIGEN_COPIES), "the natural modes")?;
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

/// Order up to which dense factors are quicker.
const DENSE_UP_TO: usize = 200;

/// Factors of K + σM.
pub enum Inverse {
    /// Definite, in half the memory and less.
    Definite(Definite),
    /// Small, or indefinite as with springs of negative stiffness.
    General(Factor),
}

impl Inverse {
    /// Factors K + σM.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn new(k: &Csc, (shift, m): (f64, &Csc), interrupt: &Interrupt<'_>) -> Result<Self> {
        if k.rows > DENSE_UP_TO
            && let Some(definite) = Definite::new(k, (shift, m), interrupt)?
        {
            return Ok(Self::Definite(definite));
        }
        let shifted = Csc::sum(
            k.rows,
            &[(Complex64::ONE, k, Form::Plain), (shift.into(), m, Form::Plain)],
        )?;
        interrupt.check()?;
        let mut factor = Factor::new(&shifted, 1)?;
        factor.factor(&shifted, interrupt)?;
        Ok(Self::General(factor))
    }

    /// Solves (K + σM) x = b in place.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        match self {
            Self::Definite(factor) => factor.solve(b, interrupt),
            Self::General(factor) => factor.solve(b, false, interrupt),
        }
    }
}

struct Search<'a> {
    inverse: Inverse,
    place: Place,
    mass: &'a Csc,
    interrupt: &'a Interrupt<'a>,
    /// Eigenvalues 1/(λ + σ) of the operator, their vectors φ, and M φ.
    found: Vec<(f64, Vec<Complex64>, Vec<Complex64>)>,
}

impl Search<'_> {
    /// The `count`-th largest eigenvalue found so far, 0 if there are fewer.
    fn smallest(&self, count: usize) -> f64 {
        let mut values: Vec<f64> = self.found.iter().map(|f| f.0).collect();
        values.sort_by(|a, b| b.total_cmp(a));
        values.get(count - 1).copied().unwrap_or(0.0)
    }

    /// One Lanczos run orthogonal to the vectors found; it stores its converged pairs and returns the largest new
    /// eigenvalue.
    fn run(&mut self, count: usize, round: usize) -> Result<f64> {
        let n = self.mass.rows;
        let extra = match self.place {
            Place::Further if n <= 20_000 => 5 * EXTRA_STEPS,
            _ => EXTRA_STEPS,
        };
        let steps = (2 * count + extra).min(n - self.found.len());
        if steps == 0 {
            return Ok(0.0);
        }
        let mut basis: Vec<Vec<Complex64>> = Vec::new();
        let mut weighted: Vec<Vec<Complex64>> = Vec::new();
        let (mut alpha, mut beta) = (Vec::new(), Vec::new());
        let mut v = start(n, round)?;
        // One application moves the starting vector into the range of the operator, free of massless motion.
        self.apply(&mut v)?;
        for step in 0..steps {
            self.interrupt.part(Phase::Modes, step, steps)?;
            let before = inner(&v, &self.times_mass(&v)?).re.max(0.0).sqrt();
            self.orthogonalise(&mut v, &basis, &weighted);
            let mut mv = self.times_mass(&v)?;
            let square = inner(&v, &mv).re;
            if square < -(EXHAUSTED * before).powi(2) {
                return fail!(NotPositiveDefinite, "mass matrix is not positive semidefinite");
            }
            let norm = square.max(0.0).sqrt();
            // A structure with few masses has few modes: the remaining vector is rounding then.
            if norm <= EXHAUSTED * before || norm <= 1e-14 * beta.first().copied().unwrap_or(0.0) {
                break;
            }
            for x in v.iter_mut().chain(&mut mv) {
                *x /= norm;
            }
            beta.push(norm);
            let mut next = mv.clone();
            self.inverse.solve(&mut next, self.interrupt)?;
            alpha.push(inner(&mv, &next).re);
            try_push(&mut basis, v, "the eigenvectors")?;
            try_push(&mut weighted, mv, "the eigenvectors")?;
            v = next;
            if basis.len() > count
                && basis.len().is_multiple_of(10)
                && self.converged(&alpha, &beta, count, &v, &basis, &weighted)?
            {
                break;
            }
        }
        self.keep(&alpha, &beta, count, &v, &basis, &weighted)
    }

    /// Ritz values in descending order with their coefficients and residual bounds.
    fn ritz(
        &self,
        alpha: &[f64],
        beta: &[f64],
        v: &[Complex64],
        basis: &[Vec<Complex64>],
        weighted: &[Vec<Complex64>],
    ) -> Result<Vec<(f64, f64, Vec<f64>)>> {
        let k = alpha.len();
        let t = DMatrix::from_fn(k, k, |i, j| match i.abs_diff(j) {
            0 => alpha[i],
            1 => beta[i.max(j)],
            _ => 0.0,
        });
        let Some(eigen) = SymmetricEigen::try_new(t, f64::EPSILON, 10_000) else {
            return fail!(NoConvergence, "the eigenvalues of a tridiagonal matrix were not found");
        };
        let mut rest = v.to_vec();
        self.orthogonalise(&mut rest, basis, weighted);
        let after = inner(&rest, &self.times_mass(&rest)?).re.max(0.0).sqrt();
        let mut ritz: Vec<_> = (0..k)
            .map(|c| {
                let s = eigen.eigenvectors.column(c);
                (
                    eigen.eigenvalues[c],
                    after * s[k - 1].abs(),
                    s.iter().copied().collect(),
                )
            })
            .collect();
        ritz.sort_by(|a: &(f64, f64, Vec<f64>), b| b.0.total_cmp(&a.0));
        Ok(ritz)
    }

    fn converged(
        &self,
        alpha: &[f64],
        beta: &[f64],
        count: usize,
        v: &[Complex64],
        basis: &[Vec<Complex64>],
        weighted: &[Vec<Complex64>],
    ) -> Result<bool> {
        let ritz = self.ritz(alpha, beta, v, basis, weighted)?;
        Ok(ritz
            .iter()
            .take(count)
            .all(|(mu, bound, _)| *bound <= TOLERANCE * mu.abs()))
    }

    fn keep(
        &mut self,
        alpha: &[f64],
        beta: &[f64],
        count: usize,
        v: &[Complex64],
        basis: &[Vec<Complex64>],
        weighted: &[Vec<Complex64>],
    ) -> Result<f64> {
        if alpha.is_empty() {
            return Ok(0.0);
        }
        let mut largest = 0.0_f64;
        let ritz = self.ritz(alpha, beta, v, basis, weighted)?;
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
        for (mu, bound, s) in ritz.into_iter().take(count) {
            self.interrupt.check()?;
            // The error of the eigenvalue is the square of the bound; vectors need a small bound too.
            if mu <= 0.0 || bound > 1e-8 * mu {
                break;
            }
            let mut x = try_vec(basis[0].len(), Complex64::ZERO, "the eigenvectors")?;
            for (q, c) in basis.iter().zip(&s) {
                for (x, q) in x.iter_mut().zip(q) {
                    *x += q * c;
                }
            }
            largest = largest.max(mu);
            let mx = self.times_mass(&x)?;
            try_push(&mut self.found, (mu, x, mx), "the eigenvectors")?;
        }
        if largest == 0.0 && self.found.is_empty() {
            return fail!(
                NoConvergence,
                "no eigenvalue converged in {} Lanczos steps",
                alpha.len()
            );
        }
        Ok(largest)
    }

    /// v ← (K + σM)⁻¹ M v
    fn apply(&mut self, v: &mut Vec<Complex64>) -> Result<()> {
        *v = self.times_mass(v)?;
        self.inverse.solve(v, self.interrupt)
    }

    fn times_mass(&self, v: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut mv = try_vec(v.len(), Complex64::ZERO, "the eigenvectors")?;
        self.mass.multiply_add(Complex64::ONE, v, &mut mv);
        Ok(mv)
    }

    /// Removes from v, twice, its components along the basis and along the vectors found.
    fn orthogonalise(&self, v: &mut [Complex64], basis: &[Vec<Complex64>], weighted: &[Vec<Complex64>]) {
        for _ in 0..2 {
            for (q, mq) in basis.iter().zip(weighted) {
                remove(v, q, inner(mq, v));
            }
            for (_, q, mq) in &self.found {
                remove(v, q, inner(mq, v));
            }
        }
    }
}

/// A starting vector without structure, the same on every run.
fn start(n: usize, round: usize) -> Result<Vec<Complex64>> {
    let mut v = try_vec(n, Complex64::ZERO, "the eigenvectors")?;
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
mod tests {
    use super::*;

    #[test]
    fn repeated_and_zero_eigenvalues_are_all_found() {
        // Three equal free chains of 100 unit masses: every eigenvalue 2 − 2 cos(jπ/100) thrice.
        let (chains, length) = (3, 100);
        let n = chains * length;
        let mut k = Vec::new();
        for c in 0..chains {
            for i in 0..length - 1 {
                let (p, q) = (c * length + i, c * length + i + 1);
                for (r, s, v) in [(p, p, 1.0), (q, q, 1.0), (p, q, -1.0), (q, p, -1.0)] {
                    k.push((r, s, Complex64::from(v)));
                }
            }
        }
        let k = Csc::from_triplets(n, n, k).unwrap();
        let m = Csc::from_triplets(n, n, (0..n).map(|i| (i, i, Complex64::ONE)).collect()).unwrap();
        let pairs = lowest(&k, &m, 8, &Interrupt::none()).unwrap();
        for (i, value) in pairs.values.iter().enumerate() {
            let exact = 2.0 - 2.0 * ((i / 3) as f64 * std::f64::consts::PI / length as f64).cos();
            assert!((value - exact).abs() < 1e-12, "{i}: {value} against {exact}");
        }
    }
}
