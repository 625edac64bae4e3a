//! Products of dense complex matrices, column after column. Small ones are made by plain loops: the blocked product needs more of the
//! stack than a small thread has.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::linalg::inner;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use pulp::bytemuck::cast_slice;
use pulp::{Arch, Simd, WithSimd};

/// Rows up to which plain loops make a product: blocked ones have no room on the small stack of a small model.
/// Kind: tuned; measured on: not recorded.
pub const LOOPS_UP_TO: usize = 48;

/// c ← A B for matrices A and C with `rows` rows.
pub fn multiply(a: &[Complex64], b: &[Complex64], c: &mut [Complex64], rows: usize) {
    if rows == 0 || a.is_empty() {
        c.fill(Complex64::ZERO);
        return;
    }
    let (middle, columns) = (a.len() / rows, c.len() / rows);
    if rows > LOOPS_UP_TO {
        matmul(
            MatMut::from_column_major_slice_mut(c, rows, columns),
            Accum::Replace,
            MatRef::from_column_major_slice(a, rows, middle),
            MatRef::from_column_major_slice(b, middle, columns),
            Complex64::ONE,
            Par::Seq,
        );
        return;
    }
    Arch::new().dispatch(Loops { a, b, c, rows });
}

/// Product of small matrices, compiled for the vector instructions of the processor. As in `complex_columns`, Re b
/// and Im b multiply the numbers of a column as they lie in memory, each into its own sum, for as many numbers as
/// registers hold.
struct Loops<'a> {
    a: &'a [Complex64],
    b: &'a [Complex64],
    c: &'a mut [Complex64],
    rows: usize,
}

/// Rows whose sums are made at a time.
/// Kind: block.
const ROWS_AT_ONCE: usize = 8;

impl WithSimd for Loops<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { a, b, c, rows } = self;
        let middle = a.len() / rows;
        let mut pairs = c.chunks_exact_mut(2 * rows);
        for (c, b) in pairs.by_ref().zip(b.chunks_exact(2 * middle)) {
            let (c0, c1) = c.split_at_mut(rows);
            let (b0, b1) = b.split_at(middle);
            all_rows([c0, c1], a, [b0, b1]);
        }
        let c = pairs.into_remainder();
        if !c.is_empty() {
            all_rows([c], a, [&b[b.len() - middle..]]);
        }
    }
}

#[inline(always)]
fn all_rows<const COLUMNS: usize>(mut c: [&mut [Complex64]; COLUMNS], a: &[Complex64], b: [&[Complex64]; COLUMNS]) {
    let rows = c[0].len();
    let mut first = 0;
    while first + ROWS_AT_ONCE <= rows {
        some_rows::<COLUMNS, { 2 * ROWS_AT_ONCE }>(&mut c, a, first, &b);
        first += ROWS_AT_ONCE;
    }
    while first + 2 <= rows {
        some_rows::<COLUMNS, 4>(&mut c, a, first, &b);
        first += 2;
    }
    if first < rows {
        some_rows::<COLUMNS, 2>(&mut c, a, first, &b);
    }
}

/// Computes the rows of C from `first` on that have NUMBERS real numbers in all.
#[inline(always)]
fn some_rows<const COLUMNS: usize, const NUMBERS: usize>(
    c: &mut [&mut [Complex64]; COLUMNS],
    a: &[Complex64],
    first: usize,
    b: &[&[Complex64]; COLUMNS],
) {
    let rows = c[0].len();
    let a: &[f64] = cast_slice(a);
    let (mut by_re, mut by_im) = ([[0.0; NUMBERS]; COLUMNS], [[0.0; NUMBERS]; COLUMNS]);
    for (k, a) in a.chunks_exact(2 * rows).enumerate() {
        let a = &a[2 * first..2 * first + NUMBERS];
        for (j, b) in b.iter().enumerate() {
            let b = b[k];
            for i in 0..NUMBERS {
                by_re[j][i] += a[i] * b.re;
                by_im[j][i] += a[i] * b.im;
            }
        }
    }
    for (c, (by_re, by_im)) in c.iter_mut().zip(by_re.iter().zip(&by_im)) {
        for (i, c) in c[first..first + NUMBERS / 2].iter_mut().enumerate() {
            *c = Complex64::new(by_re[2 * i] - by_im[2 * i + 1], by_re[2 * i + 1] + by_im[2 * i]);
        }
    }
}

/// c ← Aᴴ B for matrices A and B with `rows` rows.
pub fn multiply_adjoint(a: &[Complex64], b: &[Complex64], c: &mut [Complex64], rows: usize) {
    if rows == 0 || c.is_empty() {
        return;
    }
    let (own, columns) = (a.len() / rows, b.len() / rows);
    if rows > LOOPS_UP_TO {
        matmul(
            MatMut::from_column_major_slice_mut(c, own, columns),
            Accum::Replace,
            MatRef::from_column_major_slice(a, rows, own).adjoint(),
            MatRef::from_column_major_slice(b, rows, columns),
            Complex64::ONE,
            Par::Seq,
        );
        return;
    }
    for (c, b) in c.chunks_exact_mut(own).zip(b.chunks_exact(rows)) {
        for (c, a) in c.iter_mut().zip(a.chunks_exact(rows)) {
            *c = inner(a, b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_their_sums_by_loops_and_by_blocks() {
        let entry = |k: usize| Complex64::new((1.3 * k as f64).sin(), (0.7 * k as f64).cos());
        for (rows, middle, columns) in [(3, 5, 2), (11, 4, 1), (24, 24, 25), (48, 7, 9), (49, 7, 9), (60, 80, 3)] {
            let a: Vec<Complex64> = (0..rows * middle).map(entry).collect();
            let b: Vec<Complex64> = (0..middle * columns).map(|k| entry(k + 1000)).collect();
            let mut c = vec![Complex64::ONE; rows * columns];
            multiply(&a, &b, &mut c, rows);
            let mut back = vec![Complex64::ONE; middle * columns];
            multiply_adjoint(&a, &c, &mut back, rows);
            for j in 0..columns {
                for i in 0..rows {
                    let sum: Complex64 = (0..middle).map(|k| a[k * rows + i] * b[j * middle + k]).sum();
                    assert!((c[j * rows + i] - sum).norm() < 1e-12, "{rows}");
                }
                for i in 0..middle {
                    let sum: Complex64 = (0..rows).map(|k| a[i * rows + k].conj() * c[j * rows + k]).sum();
                    assert!((back[j * middle + i] - sum).norm() < 1e-10, "{rows}");
                }
            }
        }
    }
}
