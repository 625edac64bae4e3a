//! Blocks of columns that are orthonormal in the inner product of a definite matrix A.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::COPIED_UP_TO;
use crate::linalg::dense::hermitian;
use crate::linalg::sparse_storage::triangle::Entry;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

const CONTEXT: &str = "the reduced structure";

/// Size of a new direction, relative to the image that it comes from, below which it is rounding.
/// Kind: rounding.
const ORTHONORMAL_BLOCK_EXHAUSTED: f64 = 1e-12;

/// out ← Vᴴ X for columns of n numbers.
pub fn adjoint_product<T: Entry>(v: &[T], x: &[T], n: usize, out: &mut [T]) {
    let (rows, columns) = (v.len() / n.max(1), x.len() / n.max(1));
    if rows == 0 || columns == 0 {
        return;
    }
    if rows * columns * n <= COPIED_UP_TO {
        for (out, x) in out.chunks_exact_mut(rows).zip(x.chunks_exact(n)) {
            for (out, v) in out.iter_mut().zip(v.chunks_exact(n)) {
                *out = conjugate_sum(v, x);
            }
        }
        return;
    }
    matmul(
        MatMut::from_column_major_slice_mut(out, rows, columns),
        Accum::Replace,
        MatRef::from_column_major_slice(v, n, rows).adjoint(),
        MatRef::from_column_major_slice(x, n, columns),
        T::of(Complex64::ONE),
        Par::Seq,
    );
}

/// Norms of columns in the inner product of A; `weighted` holds their products with A.
pub fn norms<T: Entry>(block: &[T], weighted: &[T], n: usize) -> Vec<f64> {
    let columns = block.chunks_exact(n.max(1)).zip(weighted.chunks_exact(n.max(1)));
    columns.map(|(u, w)| dot(u, w).re.max(0.0).sqrt()).collect()
}

fn dot<T: Entry>(u: &[T], w: &[T]) -> Complex64 {
    conjugate_sum(u, w).complex()
}

/// Product uᴴ w of two columns.
fn conjugate_sum<T: Entry>(u: &[T], w: &[T]) -> T {
    let mut sum = T::NONE;
    for (&u, &w) in u.iter().zip(w) {
        sum.add_conjugate_product(u, w);
    }
    sum
}

/// Orthonormalises columns B that nearly are orthonormal: they become B L⁻ᴴ with Bᴴ A B = L Lᴴ. `false` where they
/// are not independent.
///
/// # Errors
/// Out of memory, or a requested stop.
pub fn orthonormalise_again<T: Entry>(
    block: &mut Vec<T>,
    weighted: &[T],
    n: usize,
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let columns = block.len() / n.max(1);
    if columns == 0 {
        return Ok(true);
    }
    let mut gram = try_vec(columns * columns, T::NONE, CONTEXT)?;
    interrupt.check_before((4 * columns * block.len()) as u64)?;
    adjoint_product(block, weighted, n, &mut gram);
    let mut l = try_vec(columns * columns, Complex64::ZERO, CONTEXT)?;
    let mut turn = try_vec(columns * columns, Complex64::ZERO, CONTEXT)?;
    for (to, from) in l.iter_mut().zip(&gram) {
        *to = from.complex();
    }
    for k in 0..columns {
        turn[k * columns + k] = Complex64::ONE;
    }
    if !hermitian::cholesky(&mut l, columns, interrupt)? {
        return Ok(false);
    }
    hermitian::solve_triangular(&l, columns, true, &mut turn, interrupt)?;
    for (to, from) in gram.iter_mut().zip(&turn) {
        *to = T::of(*from);
    }
    let mut turned = try_vec(block.len(), T::NONE, CONTEXT)?;
    interrupt.check_before((4 * columns * block.len()) as u64)?;
    matmul(
        MatMut::from_column_major_slice_mut(&mut turned, n, columns),
        Accum::Replace,
        MatRef::from_column_major_slice(block, n, columns),
        MatRef::from_column_major_slice(&gram, columns, columns),
        T::of(Complex64::ONE),
        Par::Seq,
    );
    *block = turned;
    Ok(true)
}

/// Share of the square of a norm that is left, below which the square is computed anew.
/// Kind: tuned; measured on: not recorded.
const DOWNDATED: f64 = 1e-4;

/// Orthonormalises columns among themselves, the largest first, and moves those that are kept to the front. Returns
/// the number of kept ones.
///
/// # Errors
/// Out of memory, or a requested stop.
pub fn orthonormalise<T: Entry>(
    block: &mut [T],
    weighted: &mut [T],
    n: usize,
    sizes: &[f64],
    interrupt: &Interrupt<'_>,
) -> Result<usize> {
    let n = n.max(1);
    let columns = block.len() / n;
    let mut sizes = try_copy(sizes, CONTEXT)?;
    // Squares of the norms, and what they were when they were computed.
    let mut squares = try_vec(columns, (0.0, 0.0), CONTEXT)?;
    for ((square, u), w) in squares
        .iter_mut()
        .zip(block.chunks_exact(n))
        .zip(weighted.chunks_exact(n))
    {
        let own = dot(u, w).re.max(0.0);
        *square = (own, own);
    }
    for k in 0..columns {
        interrupt.check_before((6 * (columns - k) * n) as u64)?;
        // The largest share that is still new.
        let share = |j: usize| squares[j].0.sqrt() / sizes[j].max(f64::MIN_POSITIVE);
        let best = (k..columns).fold(k, |best, j| if share(j) > share(best) { j } else { best });
        if share(best) <= ORTHONORMAL_BLOCK_EXHAUSTED {
            return Ok(k);
        }
        if best != k {
            for x in [&mut *block, &mut *weighted] {
                let (left, right) = x.split_at_mut(best * n);
                left[k * n..(k + 1) * n].swap_with_slice(&mut right[..n]);
            }
            sizes.swap(k, best);
            squares.swap(k, best);
        }
        let (u, later) = block[k * n..].split_at_mut(n);
        let (w, later_weighted) = weighted[k * n..].split_at_mut(n);
        let norm = dot(u, w).re.max(0.0).sqrt();
        if norm <= ORTHONORMAL_BLOCK_EXHAUSTED * sizes[k] {
            return Ok(k);
        }
        for x in u.iter_mut().chain(w.iter_mut()) {
            *x = x.scaled(1.0 / norm);
        }
        let columns = later.chunks_exact_mut(n).zip(later_weighted.chunks_exact_mut(n));
        for (later, square) in columns.zip(&mut squares[k + 1..]) {
            Arch::new().dispatch(Removal {
                unit: (u, w),
                later,
                square,
            });
        }
    }
    Ok(columns)
}

/// Removes the component of a column x along u, where w = A u and y = A x, and updates the square of its norm.
struct Removal<'a, T> {
    unit: (&'a [T], &'a [T]),
    later: (&'a mut [T], &'a mut [T]),
    square: &'a mut (f64, f64),
}

impl<T: Entry> WithSimd for Removal<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let ((u, w), (x, y)) = (self.unit, self.later);
        let part = partial_sums(u, y);
        let c = T::of(-part.complex());
        for ((x, &u), (y, &w)) in x.iter_mut().zip(u).zip(y.iter_mut().zip(w)) {
            x.add_product(c, u);
            y.add_product(c, w);
        }
        self.square.0 -= part.complex().norm_sqr();
        if self.square.0 <= DOWNDATED * self.square.1 {
            let own = partial_sums(x, y).complex().re.max(0.0);
            *self.square = (own, own);
        }
    }
}

/// Sums of a product that are made side by side: registers of the processor.
/// Kind: block.
const PARTIAL_SUMS: usize = 8;

/// Product uᴴ w, in several partial sums side by side.
#[inline(always)]
fn partial_sums<T: Entry>(u: &[T], w: &[T]) -> T {
    let ((u, u_rest), (w, w_rest)) = (u.as_chunks::<PARTIAL_SUMS>(), w.as_chunks::<PARTIAL_SUMS>());
    let mut sums = [T::NONE; PARTIAL_SUMS];
    for (u, w) in u.iter().zip(w) {
        for (sum, (&u, &w)) in sums.iter_mut().zip(u.iter().zip(w)) {
            sum.add_conjugate_product(u, w);
        }
    }
    for (sum, (&u, &w)) in sums.iter_mut().zip(u_rest.iter().zip(w_rest)) {
        sum.add_conjugate_product(u, w);
    }
    let mut whole = T::NONE;
    for sum in sums {
        whole += sum;
    }
    whole
}
