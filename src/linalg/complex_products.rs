//! Products of dense complex matrices, column after column. Small ones are made by plain loops: the blocked product needs more of the
//! stack than a small thread has.

use crate::linalg::inner;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;

/// Rows up to which plain loops make a product.
const LOOPS_UP_TO: usize = 48;

/// c ← A B for matrices A and C of so many rows.
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
    c.fill(Complex64::ZERO);
    for (c, b) in c.chunks_exact_mut(rows).zip(b.chunks_exact(middle)) {
        for (a, b) in a.chunks_exact(rows).zip(b) {
            for (c, a) in c.iter_mut().zip(a) {
                *c += a * b;
            }
        }
    }
}

/// c ← Aᴴ B for matrices A and B of so many rows.
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
        for (rows, middle, columns) in [(3, 5, 2), (48, 7, 9), (49, 7, 9), (60, 80, 3)] {
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
