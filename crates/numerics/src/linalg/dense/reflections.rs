//! Products of Householder's reflections with many columns, in blocks (Schreiber & Van Loan 1989, doi:10.1137/0910005).
//!
//! A block of reflections is one change of low rank,
//!
//! > H₀ H₁ … = I − V T Vᴴ,  T_kk = τ_k,  T_{:k,k} = −τ_k T_{:k,:k} V_{:k}ᴴ v_k.

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::inner;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;

/// Reflections of a block.
/// Kind: block.
const REFLECTIONS_BLOCK: usize = 32;

/// Columns that are changed at a time, between two checks of the interrupt.
/// Kind: block.
const COLUMNS: usize = 64;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// X ← H₀ H₁ … H_{n−2} X with H_j = I − τ_j v_j v_jᴴ. The vector v_j is column j of the column-major `a` of order n
/// below its diagonal; X has n rows. `progress` receives the completed share of the work.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn apply(
    (a, factors, n): (&[Complex64], &[Complex64], usize),
    x: &mut [Complex64],
    interrupt: &Interrupt<'_>,
    progress: impl Fn(f64) -> Result<()>,
) -> Result<()> {
    let (count, columns) = (n.saturating_sub(1), x.len() / n.max(1));
    let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
    let (mut v, mut adjoint, mut t) = (
        zeros(n * REFLECTIONS_BLOCK)?,
        zeros(n * REFLECTIONS_BLOCK)?,
        zeros(REFLECTIONS_BLOCK * REFLECTIONS_BLOCK)?,
    );
    let (mut along, mut turned) = (zeros(REFLECTIONS_BLOCK * COLUMNS)?, zeros(REFLECTIONS_BLOCK * COLUMNS)?);
    for first in (0..count).step_by(REFLECTIONS_BLOCK).rev() {
        let width = REFLECTIONS_BLOCK.min(count - first);
        let rows = n - first - 1;
        for (k, column) in v[..rows * width].chunks_exact_mut(rows).enumerate() {
            column[..k].fill(Complex64::ZERO);
            column[k..].copy_from_slice(&a[(first + k) * n + first + k + 1..(first + k + 1) * n]);
        }
        // Where the left factor of a product is not by columns, faer copies it to the stack, which may be small.
        for (i, row) in adjoint[..rows * width].chunks_exact_mut(width).enumerate() {
            for (k, to) in row.iter_mut().enumerate() {
                *to = v[k * rows + i].conj();
            }
        }
        triangle(&v[..rows * width], &factors[first..first + width], &mut t);
        let v = MatRef::from_column_major_slice(&v[..rows * width], rows, width);
        let adjoint = MatRef::from_column_major_slice(&adjoint[..rows * width], width, rows);
        let t = MatRef::from_column_major_slice(&t[..width * width], width, width);
        for from in (0..columns).step_by(COLUMNS) {
            let done = (count - first - width) as f64 / count as f64;
            progress(done * (2.0 - done))?;
            let some = COLUMNS.min(columns - from);
            interrupt.check_before((16 * rows * width * some) as u64)?;
            let x = MatMut::from_column_major_slice_mut(&mut x[from * n..(from + some) * n], n, some);
            let mut x = x.subrows_mut(first + 1, rows);
            let mut along = MatMut::from_column_major_slice_mut(&mut along[..width * some], width, some);
            let mut turned = MatMut::from_column_major_slice_mut(&mut turned[..width * some], width, some);
            let one = Complex64::ONE;
            matmul(along.as_mut(), Accum::Replace, adjoint, x.as_ref(), one, Par::Seq);
            matmul(turned.as_mut(), Accum::Replace, t, along.as_ref(), one, Par::Seq);
            matmul(x.as_mut(), Accum::Add, v, turned.as_ref(), -one, Par::Seq);
        }
    }
    Ok(())
}

/// Triangle T of a block of reflections with the vectors v, column after column.
fn triangle(v: &[Complex64], factors: &[Complex64], t: &mut [Complex64]) {
    let width = factors.len();
    let rows = v.len() / width;
    let column = |k: usize| &v[k * rows..(k + 1) * rows];
    for (k, &tau) in factors.iter().enumerate() {
        let (before, rest) = t.split_at_mut(k * width);
        let to = &mut rest[..width];
        to.fill(Complex64::ZERO);
        to[k] = tau;
        for j in 0..k {
            let share = tau * inner(column(j), column(k));
            for (to, t) in to[..=j].iter_mut().zip(&before[j * width..]) {
                *to -= t * share;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::remove;

    #[test]
    fn reflections_in_blocks_are_those_one_after_the_other() {
        for n in [1, 2, 30, 33, 34, 100] {
            let number = |k: usize| Complex64::new((0.37 * k as f64).sin(), (0.71 * k as f64).cos());
            let a: Vec<Complex64> = (0..n * n).map(number).collect();
            let factors: Vec<Complex64> = (0..n).map(|k| 0.01 * number(7 * k + 3)).collect();
            let columns = 70;
            let mut x: Vec<Complex64> = (0..n * columns).map(|k| number(k + 5)).collect();
            let mut exact = x.clone();
            for x in exact.chunks_exact_mut(n) {
                for j in (0..n - 1).rev() {
                    let v = &a[j * n + j + 1..(j + 1) * n];
                    let x = &mut x[j + 1..];
                    let along = factors[j] * inner(v, x);
                    remove(x, v, along);
                }
            }
            apply((&a, &factors, n), &mut x, &Interrupt::none(), |_| Ok(())).unwrap();
            for (x, exact) in x.iter().zip(&exact) {
                assert!((x - exact).norm() <= 1e-12 * (1.0 + exact.norm()), "{n}: {x} {exact}");
            }
        }
    }
}
