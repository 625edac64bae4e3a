//! Factors of small matrices and solutions for many right sides, compiled for the vector instructions of the processor.
//!
//! The digits are those of plain loops: the order of operations is the same.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::linalg::factors::lu::scalar::Scalar;
use nalgebra::ComplexField;
use pulp::{Simd, WithSimd};

/// Factors P A = L U, in place of a column-major matrix of order `n`; `turned` is memory for a column.
pub(super) struct Factorisation<'a, T> {
    pub n: usize,
    pub a: &'a mut [T],
    pub pivots: &'a mut [usize],
    pub turned: &'a mut [T],
}

impl<T: Scalar> WithSimd for Factorisation<'_, T> {
    /// The pivot that is zero or not finite, with its size.
    type Output = Result<(), (usize, f64)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Self::Output {
        let Self { n, a, pivots, turned } = self;
        for k in 0..n {
            let (left, right) = a.split_at_mut((k + 1) * n);
            let column = &mut left[k * n..];
            let mut pivot = k;
            for i in k + 1..n {
                if column[i].size() > column[pivot].size() {
                    pivot = i;
                }
            }
            let size = column[pivot].size();
            if size == 0.0 || !size.is_finite() {
                return Err((k, size));
            }
            pivots[k] = pivot;
            let inverse = <T as ComplexField>::from_real(1.0) / column[pivot];
            column.swap(k, pivot);
            let turned = &mut turned[k + 1..n];
            for (c, turned) in column[k + 1..].iter_mut().zip(&mut *turned) {
                *c *= inverse;
                *turned = c.turned();
            }
            let l = &column[k + 1..];
            for column in right.chunks_exact_mut(n) {
                column.swap(k, pivot);
                let factor = column[k];
                if factor.size() != 0.0 {
                    T::subtract(&mut column[k + 1..], l, turned, factor);
                }
            }
            if pivot != k {
                for column in left[..k * n].chunks_exact_mut(n) {
                    column.swap(k, pivot);
                }
            }
        }
        Ok(())
    }
}

/// Solves L U X = P B in place for the columns of B, row after row; each step is a sum of rows, as long as there are
/// columns. `memory` holds one number more than B for each column.
pub(super) struct Columns<'a, T> {
    pub n: usize,
    pub factors: &'a [T],
    pub pivots: &'a [usize],
    pub b: &'a mut [T],
    pub memory: &'a mut [T],
}

impl<T: Scalar> WithSimd for Columns<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self {
            n,
            factors,
            pivots,
            b,
            memory,
        } = self;
        let columns = b.len() / n;
        let (rows, turned) = memory.split_at_mut(n * columns);
        let turned = &mut turned[..columns];
        for (j, column) in b.chunks_exact_mut(n).enumerate() {
            for (k, &pivot) in pivots[..n].iter().enumerate() {
                column.swap(k, pivot);
            }
            for (k, x) in column.iter().enumerate() {
                rows[k * columns + j] = *x;
            }
        }
        for k in 0..n {
            let (above, below) = rows.split_at_mut((k + 1) * columns);
            let x = &above[k * columns..];
            turn(x, turned);
            let l = &factors[k * n + k + 1..(k + 1) * n];
            for (y, &l) in below.chunks_exact_mut(columns).zip(l) {
                T::subtract(y, x, turned, l);
            }
        }
        for k in (0..n).rev() {
            let (above, x) = rows[..(k + 1) * columns].split_at_mut(k * columns);
            // The product with the reciprocal is the digits of `small_lu`.
            let inverse = T::one() / factors[k * n + k];
            for x in x.iter_mut() {
                *x *= inverse;
            }
            turn(x, turned);
            for (y, &u) in above.chunks_exact_mut(columns).zip(&factors[k * n..k * n + k]) {
                T::subtract(y, x, turned, u);
            }
        }
        for (j, column) in b.chunks_exact_mut(n).enumerate() {
            for (k, x) in column.iter_mut().enumerate() {
                *x = rows[k * columns + j];
            }
        }
    }
}

#[inline(always)]
fn turn<T: Scalar>(x: &[T], turned: &mut [T]) {
    for (turned, x) in turned.iter_mut().zip(x) {
        *turned = x.turned();
    }
}
