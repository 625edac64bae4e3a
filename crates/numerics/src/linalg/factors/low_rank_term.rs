//! A Hermitian term of low rank beside sparse factors, Z = Z₀ + c L Lᴴ, as the damping of few modes (Woodbury's identity; Hager 1989,
//! doi:10.1137/1031049). With W = Z⁻¹L = Z₀⁻¹L (1 + c Lᴴ Z₀⁻¹L)⁻¹
//!
//! > Z⁻¹ = (1 − c W Lᴴ) Z₀⁻¹.
//!
//! Next to a resonance of Z₀, which lacks that damping, solutions by Z₀ are far larger than those by Z and lose as many digits, which
//! steps with the residual of Z bring back.

use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products;
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::lu::Lu;
use crate::linalg::factors::slender_lu::Entries;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;

const CONTEXT: &str = "a term of low rank";

/// Ratio of solutions by Z₀ and by Z beyond which residuals are worth their time.
/// Kind: rounding.
const LOSES_DIGITS: f64 = 10.0;

/// The same ratio beyond which Z₀ is singular, so that no step would converge.
/// Kind: rounding.
const NEARLY_SINGULAR: f64 = 1e7;

/// Relative change by a step beyond which another one follows: each leaves the change of the last as a share.
/// Kind: rounding.
const LEFT_BY_A_STEP: f64 = 1e-8;

/// Largest number of steps.
/// Kind: cap.
const STEPS_WITH_TERM: usize = 6;

/// Memory for the term of one harmonic at a time.
pub struct LowRankTerm {
    n: usize,
    factor: Complex64,
    /// L and W, column after column.
    columns: Vec<Complex64>,
    solved: Vec<Complex64>,
    /// Z₀⁻¹L, and 1 + c Lᴴ Z₀⁻¹L with its inverse.
    undamped: Vec<Complex64>,
    small: Lu<Complex64>,
    inverse: Vec<Complex64>,
    seen: Vec<Complex64>,
    loses_digits: bool,
    load: Vec<Complex64>,
    change: Vec<Complex64>,
}

/// The parts of Z.
pub struct Sides<'a> {
    /// Factors of Z₀.
    pub factor: &'a mut Factor,
    /// Z₀ itself.
    pub matrix: &'a Csc,
    /// Columns of L.
    pub directions: &'a [SparseVector],
}

impl LowRankTerm {
    /// Memory for matrices of order `n` with up to `most` directions.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, most: usize) -> Result<Self> {
        let zeros = |count: usize| try_vec(count, Complex64::ZERO, CONTEXT);
        Ok(Self {
            n,
            factor: Complex64::ZERO,
            columns: zeros(n.saturating_mul(most))?,
            solved: zeros(n.saturating_mul(most))?,
            undamped: zeros(n.saturating_mul(most))?,
            small: Lu::new(most, most)?,
            inverse: zeros(most * most)?,
            seen: zeros(most)?,
            loses_digits: false,
            load: zeros(n)?,
            change: zeros(n)?,
        })
    }

    /// Prepares solutions with the term c L Lᴴ beside new factors. Where Z₀ is singular but for rounding, its factors are made again with a
    /// damping of all motions that is small beside the term: steps by residuals remove it.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn renew(&mut self, c: Complex64, sides: &mut Sides<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        let count = self.n * sides.directions.len();
        let loads = |term: &Self| largest(&term.columns[..count]);
        let added = match self.prepare(c, sides, interrupt) {
            Ok(()) => {
                let (undamped, solved) = (largest(&self.undamped[..count]), largest(&self.solved[..count]));
                if undamped <= NEARLY_SINGULAR * solved {
                    return Ok(());
                }
                loads(self) / solved
            }
            Err(e) if e.status == Status::Singular => c.norm() * loads(self).powi(2),
            Err(e) => return Err(e),
        };
        let mut matrix = sides.matrix.try_clone()?;
        for j in 0..self.n {
            matrix.add_stored(j, j, Complex64::new(0.0, f64::EPSILON.sqrt() * added));
        }
        sides.factor.factor(&matrix, interrupt)?;
        self.prepare(c, sides, interrupt)?;
        self.loses_digits = true;
        Ok(())
    }

    /// W and what it takes, with the current factors.
    fn prepare(&mut self, c: Complex64, sides: &mut Sides<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        let (n, count) = (self.n, sides.directions.len());
        (self.factor, self.loses_digits) = (c, false);
        let (columns, undamped, small) = (
            &mut self.columns[..n * count],
            &mut self.undamped[..n * count],
            count * count,
        );
        columns.fill(Complex64::ZERO);
        for (column, direction) in columns.chunks_exact_mut(n).zip(sides.directions) {
            for &(p, z) in direction {
                column[p] = z;
            }
        }
        undamped.copy_from_slice(columns);
        sides.factor.solve_side_by_side(undamped, interrupt)?;
        self.small.set_order(count);
        let matrix = self.small.matrix();
        interrupt.check_before((8 * n * small) as u64)?;
        complex_products::multiply_adjoint(columns, undamped, matrix, n);
        for (at, z) in matrix.iter_mut().enumerate() {
            *z = self.factor * *z + f64::from(u8::from(at % (count + 1) == 0));
        }
        self.small.factor(interrupt)?;
        let inverse = &mut self.inverse[..small];
        inverse.fill(Complex64::ZERO);
        for k in 0..count {
            inverse[k * count + k] = Complex64::ONE;
        }
        self.small.solve_columns(inverse, false, interrupt)?;
        let solved = &mut self.solved[..n * count];
        interrupt.check_before((8 * n * small) as u64)?;
        complex_products::multiply(undamped, inverse, solved, n);
        self.loses_digits = largest(undamped) > LOSES_DIGITS * largest(solved);
        Ok(())
    }

    /// Whether solutions by Z₀ are so much larger than those by Z that residuals are needed.
    #[must_use]
    pub fn loses_digits(&self) -> bool {
        self.loses_digits
    }

    /// Takes a table R Z₀⁻¹ Rᴴ between ports R, column after column, to R Z⁻¹ Rᴴ, and the `products` qᵀ Z₀⁻¹ Rᴴ of a `vector` q to
    /// qᵀ Z⁻¹ Rᴴ, unless that is empty.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn add_to_flexibility<'p>(
        &mut self,
        sides: &mut Sides<'_>,
        port: impl Fn(usize) -> Entries<'p>,
        table: &mut [Complex64],
        vector: &[Complex64],
        products: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = self.n;
        let count = table.len().isqrt();
        let mut adjoint = core::mem::take(&mut self.load);
        for k in 0..sides.directions.len() {
            // Lᴴ Z₀⁻¹ Rᴴ by Z₀⁻ᵀ conj(L).
            for (to, z) in adjoint.iter_mut().zip(&self.columns[k * n..(k + 1) * n]) {
                *to = z.conj();
            }
            sides.factor.solve(&mut adjoint, true, interrupt)?;
            let solved = &self.solved[k * n..(k + 1) * n];
            let by_vector = vector.iter().zip(solved).map(|(q, w)| q * w).sum::<Complex64>();
            for (j, column) in table.chunks_exact_mut(count).enumerate() {
                let seen = port(j).iter().map(|&(p, a)| a.conj() * adjoint[p]).sum::<Complex64>();
                let share = self.factor * seen;
                for (i, to) in column.iter_mut().enumerate() {
                    *to -= share * port(i).iter().map(|&(p, a)| a * solved[p]).sum::<Complex64>();
                }
                if !vector.is_empty() {
                    products[j] -= share * by_vector;
                }
            }
        }
        self.load = adjoint;
        Ok(())
    }

    /// Solves Z X = B (or Zᵀ X = B) in place.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    pub fn solve(
        &mut self,
        sides: &mut Sides<'_>,
        b: &mut [Complex64],
        transposed: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if !self.loses_digits {
            return self.solve_once(sides, b, transposed, interrupt);
        }
        for b in b.chunks_exact_mut(self.n) {
            self.solve_with_residuals(sides, b, transposed, interrupt)?;
        }
        Ok(())
    }

    /// Solves with the factors and the term, without steps.
    fn solve_once(
        &mut self,
        sides: &mut Sides<'_>,
        b: &mut [Complex64],
        transposed: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if !transposed {
            sides.factor.solve(b, false, interrupt)?;
        }
        let (n, seen) = (self.n, &mut self.seen[..sides.directions.len()]);
        for b in b.chunks_exact_mut(n) {
            let columns = || self.solved.chunks_exact(n).zip(sides.directions);
            if transposed {
                // Z⁻ᵀ = Z₀⁻ᵀ (1 − c conj(L) Wᵀ)
                for (seen, (column, _)) in seen.iter_mut().zip(columns()) {
                    *seen = self.factor * column.iter().zip(&*b).map(|(w, b)| w * b).sum::<Complex64>();
                }
                for (seen, direction) in seen.iter().zip(sides.directions) {
                    for &(p, z) in direction {
                        b[p] -= z.conj() * seen;
                    }
                }
            } else {
                for (seen, direction) in seen.iter_mut().zip(sides.directions) {
                    *seen = self.factor * along(direction, b);
                }
                for (seen, (column, _)) in seen.iter().zip(columns()) {
                    for (b, w) in b.iter_mut().zip(column) {
                        *b -= w * seen;
                    }
                }
            }
        }
        if transposed {
            sides.factor.solve(b, true, interrupt)?;
        }
        Ok(())
    }

    /// Solves for one column with steps x += Z⁻¹(b − Z x).
    fn solve_with_residuals(
        &mut self,
        sides: &mut Sides<'_>,
        b: &mut [Complex64],
        transposed: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (mut load, mut change) = (core::mem::take(&mut self.load), core::mem::take(&mut self.change));
        load.copy_from_slice(b);
        let mut solved = self.solve_once(sides, b, transposed, interrupt);
        for _ in 0..STEPS_WITH_TERM {
            if solved.is_err() {
                break;
            }
            change.copy_from_slice(&load);
            subtract_product(sides.matrix, transposed, b, &mut change);
            add_term_product(sides.directions, -self.factor, transposed, b, &mut change);
            solved = self.solve_once(sides, &mut change, transposed, interrupt);
            for (x, d) in b.iter_mut().zip(&change) {
                *x += d;
            }
            if largest(&change) <= LEFT_BY_A_STEP * largest(b) {
                break;
            }
        }
        (self.load, self.change) = (load, change);
        solved
    }
}

/// Lᴴ x for one column of L.
fn along(direction: &SparseVector, x: &[Complex64]) -> Complex64 {
    direction.iter().map(|&(p, z)| z.conj() * x[p]).sum()
}

/// y ← y − A x, or with Aᵀ.
fn subtract_product(a: &Csc, transposed: bool, x: &[Complex64], y: &mut [Complex64]) {
    for j in 0..a.cols {
        for (i, v) in a.column(j) {
            let (to, from) = if transposed { (j, i) } else { (i, j) };
            y[to] -= v * x[from];
        }
    }
}

/// y ← y + c L Lᴴ x, or with the transposed matrix.
pub fn add_term_product(
    directions: &[SparseVector],
    c: Complex64,
    transposed: bool,
    x: &[Complex64],
    y: &mut [Complex64],
) {
    for direction in directions {
        if transposed {
            let seen = c * direction.iter().map(|&(p, z)| z * x[p]).sum::<Complex64>();
            for &(p, z) in direction {
                y[p] += z.conj() * seen;
            }
        } else {
            let seen = c * along(direction, x);
            for &(p, z) in direction {
                y[p] += z * seen;
            }
        }
    }
}

/// Largest modulus of the numbers of some columns.
fn largest(x: &[Complex64]) -> f64 {
    x.iter().map(Complex64::norm_sqr).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
#[path = "low_rank_term_tests.rs"]
mod tests;
