//! Factors of a bordered matrix that is a complex diagonal but for terms of low rank, without its n³ operations.
//!
//! A contact that slips for most of the period has a stiffness in a small part of it, so that the columns of its Jacobian in all
//! harmonics lie in a space whose dimension is little more than the harmonics of that part. With J = D + U Vᵀ of rank r, D made of
//! 2 × 2 blocks that act as complex numbers, and the border as two more terms,
//!
//! > K = Δ + Û V̂ᵀ,  Δ = diag(s D, 1),  K⁻¹ = (1 − W C⁻¹ V̂ᵀ) Δ⁻¹,  W = Δ⁻¹ Û,  C = 1 + V̂ᵀ W,  det K = det Δ · det C,
//!
//! where det Δ is positive. The terms are rows and columns of J − D, each through the largest number of the one before (adaptive
//! cross approximation, Bebendorf, Numerische Mathematik 86 (2000) 565, doi:10.1007/PL00005410): r of them cost n r² operations. The rest is
//! not bounded: the caller refines solutions with the whole matrix, and factors that where they do not converge.

use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::bordered::bordered_parts::Parts;
use crate::linalg::{add_product, dot};
use num_complex::Complex64;

/// Size of a term, over that of the largest, below which the rest is left to refinement.
/// Kind: tuned; measured on: one slider with 64 harmonics that sticks for 0.8 to 25 % of the period, for whose matrix these factors
/// shrink errors by 1e-5 to 1e-11.
const SMALLEST_TERM: f64 = 1e-8;

/// Numbers of unknowns for each term: more terms take as long as factors of the whole matrix.
/// Kind: tuned; measured on: matrices of 80 to 128 unknowns with a sixteenth to a third as many terms.
const UNKNOWNS_OF_A_TERM: usize = 4;

/// Numbers that are compared side by side.
/// Kind: block.
const SEARCHED_TOGETHER: usize = 8;

/// Terms of the border.
/// Kind: fixed.
const BORDER_TERMS: usize = 2;

/// Factors by terms, with their memory.
pub(super) struct NearDiagonal {
    n: usize,
    /// Columns u and rows v of the terms, one after the other.
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// Per row of J 0 where it belongs to a term, otherwise 1.
    free: Vec<f64>,
    /// Row or column that is sought, and its numbers in the terms before.
    sought: Vec<f64>,
    weights: Vec<f64>,
    /// D⁻¹, and the unit of the unknowns.
    inverse: Vec<Complex64>,
    unit: f64,
    /// W, V̂ᵀ, and the factors of C.
    left: Vec<f64>,
    right: Vec<f64>,
    order: usize,
    lu: Lu<f64>,
}

impl NearDiagonal {
    /// Memory for `n` unknowns, an even number.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        let most = n / UNKNOWNS_OF_A_TERM;
        let order = most + BORDER_TERMS;
        let numbers = |count: usize| try_vec(count, 0.0, "a matrix of low rank");
        Ok(Self {
            n,
            columns: numbers(most * n)?,
            rows: numbers(most * n)?,
            free: numbers(n)?,
            sought: numbers(n)?,
            weights: numbers(order)?,
            inverse: try_vec(n / 2, Complex64::ZERO, "a matrix of low rank")?,
            unit: 1.0,
            left: numbers(order * (n + 1))?,
            right: numbers(order * (n + 1))?,
            order: 0,
            lu: Lu::new(order, 1)?,
        })
    }

    /// Factors the matrix with the diagonal D; `false` where its terms are too many, or it is singular.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn factor(&mut self, k: &Parts<'_>, diagonal: &[Complex64], interrupt: &Interrupt<'_>) -> Result<bool> {
        for (to, d) in self.inverse.iter_mut().zip(diagonal) {
            *to = d.inv();
        }
        if !self.inverse.iter().all(|d| d.is_finite() && *d != Complex64::ZERO) {
            return Ok(false);
        }
        let Some(rank) = self.find_terms(k.jacobian, diagonal, interrupt)? else {
            return Ok(false);
        };
        self.unit = k.scales.0;
        self.order = rank + BORDER_TERMS;
        self.fill_sides(k, rank);
        interrupt.check_before((self.order * self.order * self.n) as u64)?;
        self.lu.set_order(self.order);
        let (order, across) = (self.order, &self.right[..self.order * (self.n + 1)]);
        let columns = self.lu.matrix()[..order * order].chunks_exact_mut(order);
        for (j, (to, w)) in columns.zip(self.left.chunks_exact(self.n + 1)).enumerate() {
            to.fill(0.0);
            to[j] = 1.0;
            add_product(1.0, across, w, to);
        }
        match self.lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// Finds terms of J − D; `None` where they are too many.
    fn find_terms(
        &mut self,
        jacobian: &[f64],
        diagonal: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<usize>> {
        let n = self.n;
        self.free.fill(1.0);
        let (mut row, mut largest) = (0, 0.0_f64);
        for term in 0..n / UNKNOWNS_OF_A_TERM {
            interrupt.check_before((4 * n * (term + 1)) as u64)?;
            self.free[row] = 0.0;
            // The row of J − D, less its part in the terms before.
            for (to, from) in self.sought.iter_mut().zip(jacobian[row..].iter().step_by(n)) {
                *to = *from;
            }
            let (pair, d) = (row & !1, diagonal[row / 2]);
            let of_row = if row == pair { [d.re, -d.im] } else { [d.im, d.re] };
            self.sought[pair] -= of_row[0];
            self.sought[pair + 1] -= of_row[1];
            self.subtract_terms(term, row, true);
            let column = largest_of(&self.sought);
            let pivot = self.sought[column];
            if pivot == 0.0 && term > 0 {
                return Ok(Some(term));
            }
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return Ok(None);
            }
            self.rows[term * n..(term + 1) * n].copy_from_slice(&self.sought);
            // The column through its largest number.
            self.sought.copy_from_slice(&jacobian[column * n..(column + 1) * n]);
            let (pair, d) = (column & !1, diagonal[column / 2]);
            let of_column = if column == pair { [d.re, d.im] } else { [-d.im, d.re] };
            self.sought[pair] -= of_column[0];
            self.sought[pair + 1] -= of_column[1];
            self.subtract_terms(term, column, false);
            let to = &mut self.columns[term * n..(term + 1) * n];
            for (to, x) in to.iter_mut().zip(&self.sought) {
                *to = x / pivot;
            }
            let own = &self.rows[term * n..(term + 1) * n];
            let size = (dot(to, to) * dot(own, own)).sqrt();
            largest = largest.max(size);
            if size <= SMALLEST_TERM * largest {
                return Ok(Some(term + 1));
            }
            for ((left, x), free) in self.sought.iter_mut().zip(to).zip(&self.free) {
                *left = *x * free;
            }
            row = largest_of(&self.sought);
        }
        Ok(None)
    }

    /// Subtracts from the row sought the rows of the terms before, times the numbers of their columns there; or the other way round.
    fn subtract_terms(&mut self, terms: usize, at: usize, is_row: bool) {
        let numbers = terms * self.n;
        let (own, others) = if is_row {
            (&self.rows[..numbers], &self.columns[..numbers])
        } else {
            (&self.columns[..numbers], &self.rows[..numbers])
        };
        let weights = &mut self.weights[..terms];
        for (weight, other) in weights.iter_mut().zip(others.chunks_exact(self.n)) {
            *weight = other[at];
        }
        add_product(-1.0, own, weights, &mut self.sought);
    }

    /// Fills in W and V̂ᵀ.
    fn fill_sides(&mut self, k: &Parts<'_>, rank: usize) {
        let (n, order) = (self.n, self.order);
        let terms = self.columns.chunks_exact(n).take(rank).chain([k.column]);
        for (term, (to, from)) in self.left.chunks_exact_mut(n + 1).zip(terms).enumerate() {
            let (factor, last) = if term < rank {
                (1.0, 0.0)
            } else {
                (k.scales.1 / self.unit, k.row[n] - 1.0)
            };
            divide(&self.inverse, factor, from, &mut to[..n]);
            to[n] = last;
        }
        let of_row = &mut self.left[(rank + 1) * (n + 1)..(rank + 2) * (n + 1)];
        of_row.fill(0.0);
        of_row[n] = 1.0;
        let columns = self.right.chunks_exact_mut(order).take(n + 1).zip(k.row);
        for (i, (to, t)) in columns.enumerate() {
            if i == n {
                to.fill(0.0);
                to[rank] = 1.0;
                continue;
            }
            for (to, v) in to.iter_mut().zip(self.rows[i..].iter().step_by(n)).take(rank) {
                *to = *v;
            }
            (to[rank], to[rank + 1]) = (0.0, *t);
        }
    }

    /// Solves in place for n + 1 numbers, but for the error of the terms.
    pub fn solve(&mut self, b: &mut [f64]) {
        let (n, order) = (self.n, self.order);
        self.sought.copy_from_slice(&b[..n]);
        divide(&self.inverse, 1.0 / self.unit, &self.sought, &mut b[..n]);
        let sums = &mut self.weights[..order];
        sums.fill(0.0);
        add_product(1.0, &self.right[..order * (n + 1)], b, sums);
        self.lu.solve(sums);
        add_product(-1.0, &self.left[..order * (n + 1)], sums, b);
    }

    /// Whether the determinant is positive.
    pub fn is_positive(&self) -> bool {
        self.lu.is_positive()
    }
}

/// to = factor·D⁻¹ from
fn divide(inverse: &[Complex64], factor: f64, from: &[f64], to: &mut [f64]) {
    let pairs = to.as_chunks_mut::<2>().0.iter_mut().zip(from.as_chunks::<2>().0);
    for ((to, x), d) in pairs.zip(inverse) {
        let z = d * Complex64::new(x[0], x[1]) * factor;
        *to = [z.re, z.im];
    }
}

/// Place of the number of the largest size.
fn largest_of(numbers: &[f64]) -> usize {
    let mut largest = [0.0_f64; SEARCHED_TOGETHER];
    let (blocks, rest) = numbers.as_chunks::<SEARCHED_TOGETHER>();
    for block in blocks {
        for (own, x) in largest.iter_mut().zip(block) {
            let size = x.abs();
            *own = if size > *own { size } else { *own };
        }
    }
    let largest = largest.iter().chain(rest).fold(0.0_f64, |m, x| m.max(x.abs()));
    numbers.iter().position(|x| x.abs() >= largest).unwrap_or(0)
}

#[cfg(test)]
#[path = "near_diagonal_tests.rs"]
mod tests;
