//! LU factorisation with partial pivoting of up to 32 unknowns, as it is repeated in every Newton iteration of a small model.
//!
//! Columns are padded to blocks of four rows with zeros, so that the loops over a column have no remainder, and are compiled for
//! each number of blocks and for the vector instructions of the processor. Numbers are combined in the order of
//! [`crate::linalg::factors::lu`]: both give the same digits, on every processor.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, fail, try_vec};
use pulp::{Arch, Simd, WithSimd};

/// Blocks of a column.
/// Kind: block.
const SMALL_LU_BLOCKS: usize = 8;

/// Numbers of a block.
/// Kind: block.
const SMALL_LU_WIDTH: usize = 4;

/// Largest order of a matrix.
/// Kind: fixed.
pub const SMALL_LU_LARGEST: usize = SMALL_LU_BLOCKS * SMALL_LU_WIDTH;

type Column = [[f64; SMALL_LU_WIDTH]; SMALL_LU_BLOCKS];

const ZERO: Column = [[0.0; SMALL_LU_WIDTH]; SMALL_LU_BLOCKS];

/// Factors P A = L U of a small real matrix.
pub struct SmallLu {
    arch: Arch,
    n: usize,
    /// Columns of A before, and of U after the factorisation, with the part of A that is left below.
    upper: Vec<Column>,
    /// Columns of L without its diagonal.
    lower: Vec<Column>,
    pivots: [usize; SMALL_LU_LARGEST],
    /// Reciprocals of the diagonal of U.
    inverses: [f64; SMALL_LU_LARGEST],
    /// Row of A that is in each row of P A.
    order: [usize; SMALL_LU_LARGEST],
}

impl SmallLu {
    /// Memory for matrices of up to `n` rows.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        const CONTEXT: &str = "a factorisation";
        Ok(Self {
            arch: Arch::new(),
            n: 0,
            upper: try_vec(n.min(SMALL_LU_LARGEST), ZERO, CONTEXT)?,
            lower: try_vec(n.min(SMALL_LU_LARGEST), ZERO, CONTEXT)?,
            pivots: [0; SMALL_LU_LARGEST],
            inverses: [0.0; SMALL_LU_LARGEST],
            order: [0; SMALL_LU_LARGEST],
        })
    }

    /// Prepares a matrix of `n` rows, up to the order given to [`Self::new`], to be filled column by column.
    pub fn set_order(&mut self, n: usize) {
        self.n = n.min(self.upper.len());
        let padded = self.n.next_multiple_of(SMALL_LU_WIDTH);
        for column in &mut self.upper[..self.n] {
            for x in &mut column.as_flattened_mut()[self.n..padded] {
                *x = 0.0;
            }
        }
    }

    /// Column j of the matrix, to be filled.
    pub fn column(&mut self, j: usize) -> &mut [f64] {
        &mut self.upper[j].as_flattened_mut()[..self.n]
    }

    /// Fills in the bordered matrix [A·a, c·b; row], of the order set last, from the columns of A and c, one after
    /// the other.
    pub fn fill_bordered(&mut self, matrix: &[f64], a: f64, b: f64, column: &[f64], row: &[f64]) {
        let upper = &mut self.upper[..self.n];
        self.arch.dispatch(Fill(upper, matrix, (a, b), column, row));
    }

    /// Factors the matrix that was filled in.
    ///
    /// # Errors
    /// `Singular` naming the pivot that is exactly zero or not finite.
    pub fn factor(&mut self) -> Result<()> {
        let n = self.n;
        let (upper, lower, pivots) = (&mut self.upper[..n], &mut self.lower[..n], &mut self.pivots[..n]);
        let inverses = &mut self.inverses[..n];
        let arch = self.arch;
        let broken = match n.div_ceil(SMALL_LU_WIDTH) {
            0 | 1 => arch.dispatch(Factor::<1>(upper, lower, pivots, inverses)),
            2 => arch.dispatch(Factor::<2>(upper, lower, pivots, inverses)),
            3 => arch.dispatch(Factor::<3>(upper, lower, pivots, inverses)),
            4 => arch.dispatch(Factor::<4>(upper, lower, pivots, inverses)),
            5 => arch.dispatch(Factor::<5>(upper, lower, pivots, inverses)),
            6 => arch.dispatch(Factor::<6>(upper, lower, pivots, inverses)),
            7 => arch.dispatch(Factor::<7>(upper, lower, pivots, inverses)),
            _ => arch.dispatch(Factor::<8>(upper, lower, pivots, inverses)),
        };
        for (k, row) in self.order[..n].iter_mut().enumerate() {
            *row = k;
        }
        for (k, pivot) in self.pivots[..n].iter().enumerate() {
            self.order.swap(k, *pivot);
        }
        match broken {
            None => Ok(()),
            Some((pivot, size)) => fail!(
                Singular,
                "a linear system of {n} unknowns is singular: pivot {pivot} is {size}"
            ),
        }
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        let (upper, lower, order) = (
            &self.upper[..n],
            &self.lower[..n],
            (&self.order[..n], &self.inverses[..n]),
        );
        let arch = self.arch;
        match n.div_ceil(SMALL_LU_WIDTH) {
            0 | 1 => arch.dispatch(Solve::<1>(upper, lower, order, b)),
            2 => arch.dispatch(Solve::<2>(upper, lower, order, b)),
            3 => arch.dispatch(Solve::<3>(upper, lower, order, b)),
            4 => arch.dispatch(Solve::<4>(upper, lower, order, b)),
            5 => arch.dispatch(Solve::<5>(upper, lower, order, b)),
            6 => arch.dispatch(Solve::<6>(upper, lower, order, b)),
            7 => arch.dispatch(Solve::<7>(upper, lower, order, b)),
            _ => arch.dispatch(Solve::<8>(upper, lower, order, b)),
        }
    }

    /// Whether the determinant of the factored matrix is positive.
    #[must_use]
    pub fn is_positive(&self) -> bool {
        let pivots = self.pivots[..self.n].iter().enumerate();
        let swaps = pivots.filter(|&(k, &p)| k != p).count();
        let diagonal = self.upper[..self.n].iter().enumerate();
        let negative = diagonal.filter(|(k, column)| column.as_flattened()[*k] < 0.0).count();
        (swaps + negative) % 2 == 0
    }
}

/// Fills in the bordered matrix of `fill_bordered`.
struct Fill<'a>(&'a mut [Column], &'a [f64], (f64, f64), &'a [f64], &'a [f64]);

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self(upper, matrix, (a, b), column, row) = self;
        let n = column.len();
        for (j, to) in upper.iter_mut().enumerate() {
            let (from, factor) = match matrix.get(j * n..(j + 1) * n) {
                Some(from) if j < n => (from, a),
                _ => (column, b),
            };
            let (blocks, rest) = from.as_chunks::<SMALL_LU_WIDTH>();
            for (to, from) in to.iter_mut().zip(blocks) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = factor * from;
                }
            }
            let numbers = to.as_flattened_mut();
            let first = n - rest.len();
            for (to, from) in numbers[first..].iter_mut().zip(rest) {
                *to = factor * from;
            }
            numbers[n] = row[j];
        }
    }
}

/// Factors a matrix whose columns have B blocks. The error is a pivot that is zero or not finite, with its size.
struct Factor<'a, const B: usize>(&'a mut [Column], &'a mut [Column], &'a mut [usize], &'a mut [f64]);

impl<const B: usize> WithSimd for Factor<'_, B> {
    type Output = Option<(usize, f64)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(upper, lower, pivots, inverses) = self;
        let n = upper.len();
        for k in 0..n {
            let (left, right) = upper.split_at_mut(k + 1);
            let column = &mut left[k];
            let numbers = column.as_flattened_mut();
            let (mut pivot, mut size) = (k, numbers[k].abs());
            for (i, x) in numbers[k + 1..n].iter().enumerate() {
                if x.abs() > size {
                    (pivot, size) = (k + 1 + i, x.abs());
                }
            }
            if size == 0.0 || !size.is_finite() {
                return Some((k, size));
            }
            pivots[k] = pivot;
            let inverse = 1.0 / numbers[pivot];
            inverses[k] = inverse;
            numbers.swap(k, pivot);
            // Blocks above the row of the pivot are not used.
            let first = k / SMALL_LU_WIDTH;
            let mut l = [[0.0; SMALL_LU_WIDTH]; B];
            for (l, c) in l[first..].iter_mut().zip(&column[first..]) {
                for (l, c) in l.iter_mut().zip(c) {
                    *l = c * inverse;
                }
            }
            for (i, l) in l[first].iter_mut().enumerate() {
                *l = if i <= k % SMALL_LU_WIDTH { 0.0 } else { *l };
            }
            lower[k][..B].copy_from_slice(&l);
            if pivot != k {
                for column in &mut *right {
                    column.as_flattened_mut().swap(k, pivot);
                }
                for column in &mut lower[..k] {
                    column.as_flattened_mut().swap(k, pivot);
                }
            }
            match B - first {
                1 => eliminate::<S, 1>(simd, right, &l, k),
                2 => eliminate::<S, 2>(simd, right, &l, k),
                3 => eliminate::<S, 3>(simd, right, &l, k),
                4 => eliminate::<S, 4>(simd, right, &l, k),
                _ => eliminate::<S, B>(simd, right, &l, k),
            }
        }
        None
    }
}

/// Solves with the factors of B blocks a column.
struct Solve<'a, const B: usize>(&'a [Column], &'a [Column], (&'a [usize], &'a [f64]), &'a mut [f64]);

impl<const B: usize> WithSimd for Solve<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(upper, lower, (order, inverses), b) = self;
        let mut x = [[0.0; SMALL_LU_WIDTH]; B];
        for (x, &row) in x.as_flattened_mut().iter_mut().zip(order) {
            *x = b[row];
        }
        // With places known to the compiler, the numbers stay in registers, each of which depends on the one before.
        for block in 0..B {
            for k in 0..SMALL_LU_WIDTH {
                let Some(l) = lower.get(block * SMALL_LU_WIDTH + k) else {
                    break;
                };
                let value = x[block][k];
                for i in block..B {
                    subtract(simd, &mut x[i], value, &l[i]);
                }
            }
        }
        for block in 0..B {
            let block = B - 1 - block;
            for k in 0..SMALL_LU_WIDTH {
                let k = SMALL_LU_WIDTH - 1 - k;
                let Some(u) = upper.get(block * SMALL_LU_WIDTH + k) else {
                    continue;
                };
                let value = x[block][k] * inverses[block * SMALL_LU_WIDTH + k];
                b[block * SMALL_LU_WIDTH + k] = value;
                for i in 0..B {
                    // This also changes rows from k on, which are not read again.
                    if i <= block {
                        subtract(simd, &mut x[i], value, &u[i]);
                    }
                }
            }
        }
    }
}

/// x ← x − factor·column, for one block of a column.
#[inline(always)]
fn subtract<S: Simd>(simd: S, x: &mut [f64; SMALL_LU_WIDTH], factor: f64, column: &[f64; SMALL_LU_WIDTH]) {
    let ((x, x_rest), (column, rest)) = (S::as_mut_simd_f64s(x), S::as_simd_f64s(column));
    let vector = simd.splat_f64s(factor);
    for (x, c) in x.iter_mut().zip(column) {
        *x = simd.sub_f64s(*x, simd.mul_f64s(vector, *c));
    }
    for (x, c) in x_rest.iter_mut().zip(rest) {
        *x -= factor * c;
    }
}

/// Subtracts multiples of l, the column of pivot k, from the last R blocks of the later columns; from all blocks
/// where R is B.
#[inline(always)]
fn eliminate<S: Simd, const R: usize>(simd: S, columns: &mut [Column], l: &[[f64; SMALL_LU_WIDTH]], k: usize) {
    let first = l.len().saturating_sub(R);
    let Some(l) = l[first..].first_chunk::<R>() else { return };
    for column in columns {
        let factor = column[k / SMALL_LU_WIDTH][k % SMALL_LU_WIDTH];
        let Some(rows) = column[first..].first_chunk_mut::<R>() else {
            return;
        };
        for (rows, l) in rows.iter_mut().zip(l) {
            subtract(simd, rows, factor, l);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::Interrupt;
    use crate::linalg::factors::lu::Lu;

    #[test]
    fn factors_and_solutions_are_those_of_the_general_factorisation() {
        for n in 1..=SMALL_LU_LARGEST {
            let entry = |i: usize, j: usize| ((i * i + 3 * j + i * j + 2) as f64 * 0.37).sin();
            let mut small = SmallLu::new(SMALL_LU_LARGEST).unwrap();
            let mut general = Lu::<f64>::new(n, 1).unwrap();
            // The second matrix finds the numbers of the first in its memory.
            for shift in [40, 0] {
                small.set_order(n);
                for j in 0..n {
                    for i in 0..n {
                        small.column(j)[i] = entry(i + shift, j);
                        general.matrix()[j * n + i] = entry(i + shift, j);
                    }
                }
                small.factor().unwrap();
                general.factor(&Interrupt::none()).unwrap();
                assert_eq!(small.is_positive(), general.is_positive(), "{n}");
                let mut a: Vec<f64> = (0..n).map(|i| (i as f64 * 2.1).cos()).collect();
                let mut b = a.clone();
                small.solve(&mut a);
                general.solve(&mut b);
                assert_eq!(a, b, "{n}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_and_numbers_that_are_not_finite_are_refused() {
        let refused = |numbers: [[f64; 3]; 3]| {
            let mut lu = SmallLu::new(3).unwrap();
            lu.set_order(3);
            for (j, column) in numbers.iter().enumerate() {
                lu.column(j).copy_from_slice(column);
            }
            lu.factor().unwrap_err().to_string()
        };
        let found = refused([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 1.0, 0.0]]);
        assert!(
            found.contains("pivot 2 is 0") || found.contains("pivot 1 is 0"),
            "{found}"
        );
        let found = refused([[f64::INFINITY, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!(found.contains("pivot 0 is inf"), "{found}");
    }
}
