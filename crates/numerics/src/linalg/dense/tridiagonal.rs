//! Eigenvalues and eigenvectors of a real symmetric tridiagonal matrix by implicit QL iteration (Bowdler, Martin, Reinsch &
//! Wilkinson 1968, doi:10.1007/BF02219771).
//!
//! The rotations of an iteration are found first, and then applied to the vectors, compiled for the vector instructions of the
//! processor, some rows at a time: these stay in the memory close to it.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, fail, try_vec};
use crate::interrupt::Interrupt;
use pulp::{Arch, Simd, WithSimd};

/// Iterations for one eigenvalue; two or three suffice.
/// Kind: cap.
const MOST_ITERATIONS: usize = 60;

/// Rows to which the rotations of an iteration are applied at a time.
/// Kind: block.
const ROWS: usize = 128;

/// Replaces the diagonal d by the eigenvalues. `e` holds the entries beside the diagonal, and one more number of
/// memory. The rotations are applied to the columns of z, which holds some rows of the identity, or all. `progress`
/// receives the completed share of the work.
///
/// # Errors
/// `NoConvergence`, `OutOfMemory`; `StoppedByCaller`.
pub fn diagonalise(
    d: &mut [f64],
    e: &mut [f64],
    z: &mut [f64],
    interrupt: &Interrupt<'_>,
    progress: impl Fn(f64) -> Result<()>,
) -> Result<()> {
    let n = d.len();
    let rows = z.len() / n.max(1);
    let mut rotations = try_vec(n, (1.0, 0.0), "the eigenvalues of a matrix")?;
    for l in 0..n {
        for iteration in 0.. {
            progress(l as f64 / n as f64)?;
            interrupt.check_before((6 * (rows + 1) * (n - l)) as u64)?;
            let negligible = |m: &usize| e[*m].abs() <= f64::EPSILON * (d[*m].abs() + d[*m + 1].abs());
            let m = (l..n - 1).find(negligible).unwrap_or(n - 1);
            if m == l {
                break;
            }
            if iteration == MOST_ITERATIONS || !e[l].is_finite() {
                return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
            }
            let from = iterate(d, e, l, m, &mut rotations);
            Arch::new().dispatch(Rotate {
                rotations: &rotations,
                range: (from, m),
                rows,
                z,
            });
        }
    }
    Ok(())
}

/// One QL iteration on rows l to m. `rotations` receives (c, s) of the rotations of columns i and i + 1, for i from
/// the last one down to the returned index.
fn iterate(d: &mut [f64], e: &mut [f64], l: usize, m: usize, rotations: &mut [(f64, f64)]) -> usize {
    let g = (d[l + 1] - d[l]) / (2.0 * e[l]);
    let r = g.hypot(1.0);
    let mut g = d[m] - d[l] + e[l] / (g + r.copysign(g));
    let (mut s, mut c, mut p) = (1.0, 1.0, 0.0);
    for i in (l..m).rev() {
        let (f, b) = (s * e[i], c * e[i]);
        let r = f.hypot(g);
        e[i + 1] = r;
        if r == 0.0 {
            // The matrix has split.
            d[i + 1] -= p;
            e[m] = 0.0;
            return i + 1;
        }
        (s, c) = (f / r, g / r);
        g = d[i + 1] - p;
        let r = (d[i] - g) * s + 2.0 * c * b;
        p = s * r;
        d[i + 1] = g + p;
        g = c * r - b;
        rotations[i] = (c, s);
    }
    d[l] -= p;
    e[l] = g;
    e[m] = 0.0;
    l
}

/// Applies rotations of columns i and i + 1, for i from `range.1` − 1 down to `range.0`.
struct Rotate<'a> {
    rotations: &'a [(f64, f64)],
    range: (usize, usize),
    rows: usize,
    z: &'a mut [f64],
}

impl WithSimd for Rotate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let n = self.rows;
        for first in (0..n).step_by(ROWS) {
            let count = ROWS.min(n - first);
            for i in (self.range.0..self.range.1).rev() {
                let (c, s) = self.rotations[i];
                let (left, right) = self.z.split_at_mut((i + 1) * n);
                let (left, right) = (&mut left[i * n + first..][..count], &mut right[first..][..count]);
                for (x, y) in left.iter_mut().zip(right) {
                    let f = *y;
                    *y = s * *x + c * f;
                    *x = c * *x - s * f;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_chain_has_its_frequencies_and_shapes_in_closed_form() {
        for n in [1, 2, 9, 150] {
            let (mut d, mut e) = (vec![2.0; n], vec![-1.0; n]);
            e[n - 1] = 0.0;
            let mut z = vec![0.0; n * n];
            for i in 0..n {
                z[i * n + i] = 1.0;
            }
            diagonalise(&mut d, &mut e, &mut z, &Interrupt::none(), |_| Ok(())).unwrap();
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by(|&i, &j| d[i].total_cmp(&d[j]));
            for (k, &at) in order.iter().enumerate() {
                let angle = (k + 1) as f64 * PI / (n + 1) as f64;
                assert!((d[at] - (2.0 - 2.0 * angle.cos())).abs() < 1e-14 * n as f64, "{n}, {k}");
                let x = &z[at * n..(at + 1) * n];
                let exact = |i: usize| ((i + 1) as f64 * angle).sin() * (2.0 / (n + 1) as f64).sqrt();
                let sign = exact(0).signum() * x[0].signum();
                for (i, x) in x.iter().enumerate() {
                    assert!((sign * x - exact(i)).abs() < 1e-11, "{n}, {k}, {i}");
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_splits_keeps_its_parts() {
        let (mut d, mut e) = (vec![1.0, 1.0, 5.0, 5.0], vec![0.5, 0.0, -2.0, 0.0]);
        let mut z = vec![0.0; 16];
        for i in 0..4 {
            z[i * 4 + i] = 1.0;
        }
        diagonalise(&mut d, &mut e, &mut z, &Interrupt::none(), |_| Ok(())).unwrap();
        d.sort_by(f64::total_cmp);
        for (value, exact) in d.iter().zip([0.5, 1.5, 3.0, 7.0]) {
            assert!((value - exact).abs() < 1e-14);
        }
    }
}
