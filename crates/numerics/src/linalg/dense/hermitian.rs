//! Eigenvalues and eigenvectors of a large dense Hermitian matrix, column by column, so that the caller may interrupt.
//!
//! Householder's reflections make the matrix real and tridiagonal, A = Q T Qᴴ; implicit QL iteration diagonalises T; the
//! reflections turn its vectors into those of A (Golub & Van Loan, Matrix Computations, 2013, §8.3).

use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::dense::complex_columns;
use crate::linalg::dense::reflections;
use crate::linalg::dense::tridiagonal;
use crate::linalg::inner;
use faer::linalg::matmul::matmul;
use faer::reborrow::Reborrow;
use faer::{Accum, MatMut, MatRef, Par};
use num_complex::Complex64;
use std::ops::Range;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// Rows of a triangular system up to which plain loops solve it, and its columns between two checks of the interrupt.
/// Kind: block.
const HERMITIAN_BLOCK: usize = 16;
const HERMITIAN_AT_ONCE: usize = 64;

/// Shares of the work in the reduction, the iteration and the vectors, for the progress.
/// Kind: block.
const HERMITIAN_REDUCED: f64 = 0.4;
const ITERATED: f64 = 0.8;

/// Eigenvalues in ascending order and orthonormal eigenvectors, column after column, of the Hermitian column-major
/// matrix `a` of order n, which is overwritten.
///
/// # Errors
/// `NoConvergence`, `OutOfMemory`; `StoppedByCaller`.
pub fn eigen(a: &mut [Complex64], n: usize, interrupt: &Interrupt<'_>) -> Result<(Vec<f64>, Vec<Complex64>)> {
    let mut values = try_vec(n, 0.0, CONTEXT)?;
    let mut beside = try_vec(n, 0.0, CONTEXT)?;
    let mut factors = try_vec(n, Complex64::ZERO, CONTEXT)?;
    tridiagonalise(a, n, &mut values, &mut beside, &mut factors, interrupt)?;
    let mut z = try_vec(n * n, 0.0, CONTEXT)?;
    for i in 0..n {
        z[i * n + i] = 1.0;
    }
    let between = |low: f64, high: f64| move |share: f64| interrupt.phase(Phase::Modes, low + (high - low) * share);
    tridiagonal::diagonalise(
        &mut values,
        &mut beside,
        &mut z,
        interrupt,
        between(HERMITIAN_REDUCED, ITERATED),
    )?;
    let mut order = try_vec(n, 0, CONTEXT)?;
    for (i, o) in order.iter_mut().enumerate() {
        *o = i;
    }
    order.sort_unstable_by(|&i, &j| values[i].total_cmp(&values[j]));
    let mut vectors = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    let mut sorted = try_vec(n, 0.0, CONTEXT)?;
    for ((x, sorted), &i) in vectors.chunks_exact_mut(n.max(1)).zip(&mut sorted).zip(&order) {
        *sorted = values[i];
        for (x, z) in x.iter_mut().zip(&z[i * n..(i + 1) * n]) {
            *x = (*z).into();
        }
    }
    reflections::apply((a, &factors, n), &mut vectors, interrupt, between(ITERATED, 1.0))?;
    Ok((sorted, vectors))
}

/// Reduces A to the tridiagonal T, given by its diagonal and the entries beside it. The vectors v of the reflections
/// I − τ v vᴴ are stored below the diagonal of A, their τ in `factors`.
fn tridiagonalise(
    a: &mut [Complex64],
    n: usize,
    diagonal: &mut [f64],
    beside: &mut [f64],
    factors: &mut [Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let mut w = try_vec(n, Complex64::ZERO, CONTEXT)?;
    let mut memory = [
        try_vec(n, Complex64::ZERO, CONTEXT)?,
        try_vec(n, Complex64::ZERO, CONTEXT)?,
    ];
    for k in 0..n.saturating_sub(1) {
        let left = (n - k) as f64 / n as f64;
        interrupt.phase(Phase::Modes, HERMITIAN_REDUCED * (1.0 - left * left * left))?;
        interrupt.check_before((16 * (n - k) * (n - k)) as u64)?;
        let (done, rest) = a.split_at_mut((k + 1) * n);
        let v = &mut done[k * n + k + 1..];
        let (head, below) = (v[0], v[1..].iter().fold(0.0, |s, z| f64::hypot(s, z.norm())));
        let tau = if below == 0.0 && head.im == 0.0 {
            beside[k] = head.re;
            Complex64::ZERO
        } else {
            let beta = -head.norm().hypot(below).copysign(head.re);
            let scale = (head - beta).inv();
            for z in &mut v[1..] {
                *z *= scale;
            }
            beside[k] = beta;
            Complex64::new((beta - head.re) / beta, -head.im / beta)
        };
        v[0] = Complex64::ONE;
        factors[k] = tau;
        if tau == Complex64::ZERO {
            continue;
        }
        // w = τ A v − ½ τ (wᴴ v) v,  A ← A − v wᴴ − w vᴴ
        let w = &mut w[..v.len()];
        let [factors, memory] = memory.each_mut().map(|x| &mut x[..w.len()]);
        for (factor, v) in factors.iter_mut().zip(&*v) {
            *factor = tau * v;
        }
        let trailing = &mut rest[k + 1..];
        complex_columns::multiply(trailing, n, factors, w, memory);
        let along = inner(w, v);
        let half = -0.5 * tau * along;
        for (w, v) in w.iter_mut().zip(&*v) {
            *w += half * v;
        }
        complex_columns::subtract_dyads(trailing, n, v, w);
    }
    for (k, d) in diagonal.iter_mut().enumerate() {
        *d = a[k * n + k].re;
    }
    Ok(())
}

/// A ← Aᴴ of order n.
pub fn adjoint_in_place(a: &mut [Complex64], n: usize) {
    for j in 0..n {
        for i in 0..=j {
            let (x, y) = (a[j * n + i], a[i * n + j]);
            a[j * n + i] = y.conj();
            a[i * n + j] = x.conj();
        }
    }
}

/// Replaces the lower triangle of the Hermitian column-major A by L of A = L Lᴴ; `false` where A is not positive
/// definite.
///
/// # Errors
/// `StoppedByCaller`.
pub fn cholesky(a: &mut [Complex64], n: usize, interrupt: &Interrupt<'_>) -> Result<bool> {
    for j in 0..n {
        interrupt.check_before((8 * j * (n - j)) as u64)?;
        let (left, right) = a.split_at_mut(j * n);
        let column = &mut right[j..n];
        for l in left.chunks_exact(n) {
            let factor = l[j].conj();
            for (c, l) in column.iter_mut().zip(&l[j..]) {
                *c -= l * factor;
            }
        }
        let pivot = column[0].re;
        if pivot.is_nan() || pivot <= 0.0 {
            return Ok(false);
        }
        let root = pivot.sqrt();
        column[0] = root.into();
        for c in &mut column[1..] {
            *c /= root;
        }
    }
    Ok(true)
}

/// B ← L⁻¹ B, or B ← L⁻ᴴ B if `adjoint`.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn solve_triangular(
    l: &[Complex64],
    n: usize,
    adjoint: bool,
    b: &mut [Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    // Where the left factor of a product is not by columns, faer copies it to the stack, which may be small.
    let mut by_columns = Vec::new();
    if adjoint {
        by_columns = try_copy(l, CONTEXT)?;
        adjoint_in_place(&mut by_columns, n);
    }
    let triangle = if adjoint { &by_columns } else { l };
    for b in b.chunks_mut(HERMITIAN_AT_ONCE * n.max(1)) {
        interrupt.check_before((4 * n * b.len()) as u64)?;
        solve_rows(triangle, n, adjoint, 0..n, b);
    }
    Ok(())
}

/// Solves for some rows of B: one half of them, then the other half after the product with the triangle between;
/// lower triangles begin with the first half, upper ones with the last.
fn solve_rows(a: &[Complex64], n: usize, upper: bool, rows: Range<usize>, b: &mut [Complex64]) {
    if rows.len() <= HERMITIAN_BLOCK {
        for x in b.chunks_exact_mut(n) {
            solve_column(a, n, upper, rows.clone(), x);
        }
        return;
    }
    let middle = rows.start + rows.len() / 2;
    let (head, rest) = (rows.start..middle, middle..rows.end);
    let (first, last) = if upper { (rest, head) } else { (head, rest) };
    solve_rows(a, n, upper, first.clone(), b);
    let between = MatRef::from_column_major_slice(a, n, n).submatrix(last.start, first.start, last.len(), first.len());
    let columns = b.len() / n;
    let b_rows = MatMut::from_column_major_slice_mut(b, n, columns).subrows_mut(rows.start, rows.len());
    let (above, below) = b_rows.split_at_row_mut(middle - rows.start);
    let (known, to) = if upper { (below, above) } else { (above, below) };
    matmul(to, Accum::Add, between, known.rb(), -Complex64::ONE, Par::Seq);
    solve_rows(a, n, upper, last, b);
}

/// Solves for some rows of one column, entry after entry.
fn solve_column(a: &[Complex64], n: usize, upper: bool, rows: Range<usize>, x: &mut [Complex64]) {
    for i in 0..rows.len() {
        let k = if upper { rows.end - 1 - i } else { rows.start + i };
        let others = if upper { rows.start..k } else { k + 1..rows.end };
        let column = &a[k * n..(k + 1) * n];
        x[k] /= column[k].re;
        let known = x[k];
        for (x, a) in x[others.clone()].iter_mut().zip(&column[others]) {
            *x -= known * a;
        }
    }
}

#[cfg(test)]
#[path = "hermitian_tests.rs"]
mod tests;
