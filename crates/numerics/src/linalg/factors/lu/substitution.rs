//! Forward and back substitution with large factors, two columns at a time: the right side is read and written half as often.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use pulp::{Simd, WithSimd};
use std::ops::{Div, Mul, Sub};

/// Real or complex number with the four operations that substitution needs.
pub(super) trait Number: Copy + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {}

impl<T: Copy + Sub<Output = T> + Mul<Output = T> + Div<Output = T>> Number for T {}

/// Solves L U x = b in place, L and U column-major in one matrix of order `n`.
pub(super) struct Substitution<'a, T> {
    pub n: usize,
    pub factors: &'a [T],
    pub b: &'a mut [T],
}

impl<T: Number> WithSimd for Substitution<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { n, factors, b } = self;
        let column = |k: usize| &factors[k * n..(k + 1) * n];
        for k in (0..n).step_by(2) {
            let first = column(k);
            let x = b[k];
            if k + 1 < n {
                let second = column(k + 1);
                b[k + 1] = b[k + 1] - x * first[k + 1];
                let y = b[k + 1];
                subtract(&mut b[k + 2..], x, &first[k + 2..], y, &second[k + 2..]);
            }
        }
        let mut k = n;
        while k >= 2 {
            let (first, second) = (column(k - 1), column(k - 2));
            let x = b[k - 1] / first[k - 1];
            let y = (b[k - 2] - x * first[k - 2]) / second[k - 2];
            (b[k - 1], b[k - 2]) = (x, y);
            k -= 2;
            subtract(&mut b[..k], x, &first[..k], y, &second[..k]);
        }
        if k == 1 {
            b[0] = b[0] / factors[0];
        }
    }
}

/// b ← b − x p − y q.
#[inline(always)]
fn subtract<T: Number>(b: &mut [T], x: T, p: &[T], y: T, q: &[T]) {
    for ((b, &p), &q) in b.iter_mut().zip(p).zip(q) {
        *b = *b - x * p - y * q;
    }
}
