//! Eigenvalues alone of a dense matrix without symmetry: Hessenberg form by reflections, and the QR iteration with two implicit
//! shifts on the rows and columns that are still open (Francis 1961, doi:10.1093/comjnl/4.3.265; Golub & Van Loan, Matrix
//! Computations, 2013, §7.5). Without vectors and without the closed part of the triangle it takes a third of the time of a Schur
//! form.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Iterations for one eigenvalue; two or three suffice.
/// Kind: cap.
const EIGENVALUES_MOST_ITERATIONS: usize = 60;

/// Iterations without success after which a shift is chosen otherwise.
/// Kind: cap.
const EXCEPTIONAL: usize = 10;

/// Computes the eigenvalues of the column-major matrix `a` of order n, which is overwritten, and passes each to
/// `found`.
///
/// # Errors
/// `NoConvergence`; `StoppedByCaller`; those of `found`.
pub fn of_real(
    a: &mut [f64],
    n: usize,
    interrupt: &Interrupt<'_>,
    mut found: impl FnMut(Complex64) -> Result<()>,
) -> Result<()> {
    let arch = Arch::new();
    for k in 0..n.saturating_sub(2) {
        interrupt.check_before((4 * n * (n - k)) as u64)?;
        arch.dispatch(Reduce { a, n, k });
    }
    // Rows and columns from `open` on are closed.
    let mut open = n;
    let mut iterations = 0;
    while open > 0 {
        interrupt.check_before((20 * n) as u64)?;
        let first = first_of_block(a, n, open);
        if open - first <= 2 {
            if open - first == 1 {
                found(a[(open - 1) * n + open - 1].into())?;
            } else {
                for value in pair(a, n, open) {
                    found(value)?;
                }
            }
            open = first;
            iterations = 0;
            continue;
        }
        iterations += 1;
        if iterations > EIGENVALUES_MOST_ITERATIONS || !a[(open - 1) * n + open - 1].is_finite() {
            return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
        }
        let shifts = shifts(a, n, open, iterations);
        arch.dispatch(Sweep {
            a,
            n,
            first,
            open,
            shifts,
        });
    }
    Ok(())
}

/// First row of the last block that is not divided by a zero below the diagonal; negligible numbers are set to zero.
fn first_of_block(a: &mut [f64], n: usize, open: usize) -> usize {
    for i in (1..open).rev() {
        let near = a[(i - 1) * n + i - 1].abs() + a[i * n + i].abs();
        let below = &mut a[(i - 1) * n + i];
        if below.abs() <= f64::EPSILON * near || *below == 0.0 {
            *below = 0.0;
            return i;
        }
    }
    0
}

/// The eigenvalues of the last 2 × 2 block, without cancellation.
fn pair(a: &[f64], n: usize, open: usize) -> [Complex64; 2] {
    let at = |i: usize, j: usize| a[(open - 2 + j) * n + open - 2 + i];
    let half = 0.5 * (at(0, 0) - at(1, 1));
    let middle = 0.5 * (at(0, 0) + at(1, 1));
    let product = at(0, 1) * at(1, 0);
    let square = half * half + product;
    if square < 0.0 {
        let im = (-square).sqrt();
        return [Complex64::new(middle, im), Complex64::new(middle, -im)];
    }
    let root = half.abs() + square.sqrt();
    // λ − a₂₂ = ±root and −product/±root.
    let signed = if half < 0.0 { -root } else { root };
    let other = if signed == 0.0 { 0.0 } else { -product / signed };
    [(at(1, 1) + signed).into(), (at(1, 1) + other).into()]
}

/// Sum and product of the two shifts: of the eigenvalues of the last block or, where these did not lead to
/// convergence, of other numbers.
fn shifts(a: &[f64], n: usize, open: usize, iterations: usize) -> (f64, f64) {
    let at = |i: usize, j: usize| a[(open - 2 + j) * n + open - 2 + i];
    if iterations.is_multiple_of(EXCEPTIONAL) {
        let size = at(1, 0).abs() + a[(open - 3) * n + open - 2].abs();
        let shift = at(1, 1) + 0.75 * size;
        return (2.0 * shift, shift * shift + 0.4375 * size * size);
    }
    (at(0, 0) + at(1, 1), at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0))
}

/// Reflection of rows and columns from k + 1 on that clears column k below row k + 1.
struct Reduce<'a> {
    a: &'a mut [f64],
    n: usize,
    k: usize,
}

impl WithSimd for Reduce<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { a, n, k } = self;
        let (done, rest) = a.split_at_mut((k + 1) * n);
        let v = &mut done[k * n + k + 1..];
        let below = v[1..].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if below == 0.0 {
            return;
        }
        let size = v[0].abs().max(below);
        let length = size * v.iter().map(|x| (x / size).powi(2)).sum::<f64>().sqrt();
        let pivot = if v[0] > 0.0 { -length } else { length };
        // I − v vᵀ/s with s = −pivot·v₁
        v[0] -= pivot;
        let s = -pivot * v[0];
        for column in rest.chunks_exact_mut(n) {
            let column = &mut column[k + 1..];
            let share = dot(v, column) / s;
            subtract(column, share, v);
        }
        // The columns of A v, then A − (A v) vᵀ/s: four columns at a time would not be quicker, the rows fit.
        let count = v.len();
        for rows in 0..n.div_ceil(REFLECTED_ROWS) {
            let (from, to) = (rows * REFLECTED_ROWS, ((rows + 1) * REFLECTED_ROWS).min(n));
            let mut sum = [0.0; REFLECTED_ROWS];
            for (column, v) in rest.chunks_exact(n).zip(v.iter()) {
                for (sum, x) in sum.iter_mut().zip(&column[from..to]) {
                    *sum += v * x;
                }
            }
            for (column, v) in rest.chunks_exact_mut(n).zip(v.iter()).take(count) {
                let share = v / s;
                for (x, sum) in column[from..to].iter_mut().zip(&sum) {
                    *x -= share * sum;
                }
            }
        }
        v.fill(0.0);
        v[0] = pivot;
    }
}

/// Rows to which a reflection is applied from the right at a time.
/// Kind: block.
const REFLECTED_ROWS: usize = 64;

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a8, a_rest) = a.as_chunks::<8>();
    let (b8, b_rest) = b.as_chunks::<8>();
    for (a, b) in a8.iter().zip(b8) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[inline(always)]
fn subtract(y: &mut [f64], share: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= share * x;
    }
}

/// One sweep with two shifts over the block of rows `first` to `open` − 1.
struct Sweep<'a> {
    a: &'a mut [f64],
    n: usize,
    first: usize,
    open: usize,
    shifts: (f64, f64),
}

impl WithSimd for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self {
            a,
            n,
            first,
            open,
            shifts: (sum, product),
        } = self;
        let at = |a: &[f64], i: usize, j: usize| a[j * n + i];
        // First column of H² − sum·H + product, but for a factor.
        let (h00, h10) = (at(a, first, first), at(a, first + 1, first));
        let (h01, h11) = (at(a, first, first + 1), at(a, first + 1, first + 1));
        let h21 = at(a, first + 2, first + 1);
        let mut x = [(h00 * (h00 - sum) + product) / h10 + h01, h00 + h11 - sum, h21];
        for k in first..open - 1 {
            let count = 3.min(open - k);
            if k > first {
                x = [
                    at(a, k, k - 1),
                    at(a, k + 1, k - 1),
                    if count == 3 { at(a, k + 2, k - 1) } else { 0.0 },
                ];
            } else if count == 2 {
                x[2] = 0.0;
            }
            let size = x[0].abs().max(x[1].abs()).max(x[2].abs());
            if size == 0.0 {
                continue;
            }
            let length = size * ((x[0] / size).powi(2) + (x[1] / size).powi(2) + (x[2] / size).powi(2)).sqrt();
            let pivot = if x[0] > 0.0 { -length } else { length };
            let head = x[0] - pivot;
            // I − u vᵀ with v = (1, v₁, v₂) and u = v·(−head/pivot)
            let v = [x[1] / head, x[2] / head];
            let u = -head / pivot;
            if k > first {
                a[(k - 1) * n + k] = pivot;
                a[(k - 1) * n + k + 1] = 0.0;
                if count == 3 {
                    a[(k - 1) * n + k + 2] = 0.0;
                }
            }
            for column in a[k * n..open * n].chunks_exact_mut(n) {
                let rows = &mut column[k..k + count];
                if count == 3 {
                    let share = u * (rows[0] + v[0] * rows[1] + v[1] * rows[2]);
                    rows[0] -= share;
                    rows[1] -= share * v[0];
                    rows[2] -= share * v[1];
                } else {
                    let share = u * (rows[0] + v[0] * rows[1]);
                    rows[0] -= share;
                    rows[1] -= share * v[0];
                }
            }
            let last = (k + 4).min(open);
            let (left, right) = a[k * n..(k + count) * n].split_at_mut(n);
            let left = &mut left[first..last];
            if count == 3 {
                let (middle, right) = right.split_at_mut(n);
                for ((x, y), z) in left
                    .iter_mut()
                    .zip(&mut middle[first..last])
                    .zip(&mut right[first..last])
                {
                    let share = u * (*x + v[0] * *y + v[1] * *z);
                    *x -= share;
                    *y -= share * v[0];
                    *z -= share * v[1];
                }
            } else {
                for (x, y) in left.iter_mut().zip(&mut right[first..last]) {
                    let share = u * (*x + v[0] * *y);
                    *x -= share;
                    *y -= share * v[0];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::general_eigen;

    fn all(a: &[f64], n: usize) -> Vec<Complex64> {
        let (mut a, mut found) = (a.to_vec(), Vec::new());
        let push = |value| {
            found.push(value);
            Ok(())
        };
        of_real(&mut a, n, &Interrupt::none(), push).unwrap();
        assert_eq!(found.len(), n);
        found
    }

    /// Largest distance of two lists, each number with its nearest one that is left.
    fn distance(a: &[Complex64], b: &[Complex64]) -> f64 {
        let mut left = b.to_vec();
        a.iter().fold(0.0, |worst: f64, z| {
            let gap = |w: &Complex64| (w - z).norm();
            let at = (0..left.len()).min_by(|&i, &j| gap(&left[i]).total_cmp(&gap(&left[j])));
            worst.max(gap(&left.swap_remove(at.unwrap())))
        })
    }

    #[test]
    fn eigenvalues_are_those_of_another_algorithm() {
        for n in [1, 2, 3, 4, 5, 8, 17, 48, 70, 131] {
            let a: Vec<f64> = (0..n * n).map(|k| ((k * k + 3 * k) as f64 * 0.71).sin()).collect();
            let complex: Vec<Complex64> = a.iter().map(|x| (*x).into()).collect();
            let pairs = general_eigen::eigen(&complex, n, &Interrupt::none()).unwrap();
            let off = distance(&all(&a, n), &pairs.values);
            assert!(off < 1e-12 * n as f64, "{n}: {off:e}");
        }
    }

    #[test]
    fn matrices_with_known_eigenvalues() {
        // Permutation of n: roots of unity, which no shift from the last block tells.
        for n in [2, 3, 4, 7, 12] {
            let mut a = vec![0.0; n * n];
            (0..n).for_each(|i| a[i * n + (i + 1) % n] = 1.0);
            let roots: Vec<Complex64> = (0..n)
                .map(|k| Complex64::cis(core::f64::consts::TAU * k as f64 / n as f64))
                .collect();
            assert!(distance(&all(&a, n), &roots) < 1e-13, "{n}");
        }
        // A diagonal that is hidden by a reflection, with equal and with tiny numbers.
        let values = [3.0, 3.0, -1.0, 1e-3, 0.0, 0.0, 2.0, 1e-9];
        let n = values.len();
        let v: Vec<f64> = (0..n).map(|k| (1.3 * k as f64).sin() + 0.2).collect();
        let square: f64 = v.iter().map(|v| v * v).sum();
        let mirror = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j] / square;
        let entry = |i: usize, j: usize| (0..n).map(|k| mirror(i, k) * values[k] * mirror(k, j)).sum();
        let a: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
        let known: Vec<Complex64> = values.iter().map(|x| (*x).into()).collect();
        assert!(distance(&all(&a, n), &known) < 1e-14);
        // A block that is defective, beside one that the others do not reach.
        let a = [2.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, -4.0];
        let known = [2.0, 2.0, -4.0].map(Complex64::from);
        assert!(distance(&all(&a, 3), &known) < 1e-14);
        assert!(all(&[0.0; 9], 3).iter().all(|z| z.norm() == 0.0));
    }

    #[test]
    fn a_number_that_is_none_is_an_error() {
        let mut a = [1.0, f64::NAN, 2.0, 3.0, 1.0, 0.5, 2.0, 0.1, 7.0];
        assert!(of_real(&mut a, 3, &Interrupt::none(), |_| Ok(())).is_err());
    }
}
