//! The generalised minimal residual method (Saad & Schultz 1986, doi:10.1137/0907058) for a matrix that is known
//! only by its products with vectors.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::linalg::norm;

const CONTEXT: &str = "an iterative linear solution";

/// Solves A x = b from x = 0 until ‖b − A x‖ ≤ tolerance·‖b‖; `product` computes A v. Returns `true` if that took
/// at most `most` products; b then holds x.
///
/// # Errors
/// `OutOfMemory`, and those of the products.
pub fn gmres(
    b: &mut [f64],
    tolerance: f64,
    most: usize,
    mut product: impl FnMut(&[f64], &mut [f64]) -> Result<()>,
) -> Result<bool> {
    let size = norm(b);
    if size == 0.0 {
        return Ok(true);
    }
    if !size.is_finite() {
        return Ok(false);
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut first = try_copy(b, CONTEXT)?;
    scale(&mut first, 1.0 / size);
    try_push(&mut basis, first, CONTEXT)?;
    // Columns of the triangular factor of Hessenberg's matrix, and the rotations that made it.
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut rest: Vec<f64> = Vec::new();
    try_push(&mut rest, size, CONTEXT)?;
    for k in 0..most {
        let mut v = try_vec(b.len(), 0.0, CONTEXT)?;
        product(&basis[k], &mut v)?;
        let mut column = try_vec(k + 1, 0.0, CONTEXT)?;
        // Twice, because of rounding.
        for _ in 0..2 {
            for (h, q) in column.iter_mut().zip(&basis) {
                let along: f64 = q.iter().zip(&v).map(|(q, v)| q * v).sum();
                *h += along;
                for (v, q) in v.iter_mut().zip(q) {
                    *v -= along * q;
                }
            }
        }
        let below = norm(&v);
        for (i, &(c, s)) in rotations.iter().enumerate() {
            let (x, y) = (column[i], column[i + 1]);
            column[i] = c * x + s * y;
            column[i + 1] = c * y - s * x;
        }
        let length = column[k].hypot(below);
        if length == 0.0 || !length.is_finite() {
            return Ok(false);
        }
        let (c, s) = (column[k] / length, below / length);
        column[k] = length;
        try_push(&mut rotations, (c, s), CONTEXT)?;
        try_push(&mut triangle, column, CONTEXT)?;
        let last = rest[k];
        rest[k] = c * last;
        try_push(&mut rest, -s * last, CONTEXT)?;
        if rest[k + 1].abs() <= tolerance * size {
            combine(&basis, &triangle, &mut rest, b);
            return Ok(true);
        }
        scale(&mut v, 1.0 / below);
        try_push(&mut basis, v, CONTEXT)?;
    }
    Ok(false)
}

/// x = Q R⁻¹ g
fn combine(basis: &[Vec<f64>], triangle: &[Vec<f64>], g: &mut [f64], x: &mut [f64]) {
    for k in (0..triangle.len()).rev() {
        g[k] /= triangle[k][k];
        for i in 0..k {
            g[i] -= triangle[k][i] * g[k];
        }
    }
    x.fill(0.0);
    for (q, g) in basis.iter().zip(&*g).take(triangle.len()) {
        for (x, q) in x.iter_mut().zip(q) {
            *x += g * q;
        }
    }
}

fn scale(v: &mut [f64], factor: f64) {
    for v in v {
        *v *= factor;
    }
}

#[cfg(test)]
mod tests {
    use super::gmres;

    #[test]
    fn a_system_near_the_identity_takes_few_products_and_any_system_as_many_as_unknowns() {
        let n = 30;
        for (size, most) in [(0.02, 12), (1.0, n)] {
            let a = |i: usize, j: usize| f64::from(u8::from(i == j)) + size * ((i * 7 + j * 3) as f64 * 0.61).sin();
            let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
            let times = |v: &[f64], out: &mut [f64]| {
                for (i, out) in out.iter_mut().enumerate() {
                    *out = v.iter().enumerate().map(|(j, v)| a(i, j) * v).sum();
                }
            };
            let mut b = vec![0.0; n];
            times(&x, &mut b);
            let mut products = 0;
            let done = gmres(&mut b, 1e-12, most, |v, out| {
                products += 1;
                times(v, out);
                Ok(())
            });
            assert!(done.unwrap() && products <= most);
            for (b, x) in b.iter().zip(&x) {
                assert!((b - x).abs() < 1e-9, "{products} products");
            }
        }
    }

    #[test]
    fn an_unfinished_solution_is_reported() {
        let mut b = [1.0, 0.0, 0.0, 0.0];
        let turn = |v: &[f64], out: &mut [f64]| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = v[(i + 1) % 4];
            }
            Ok(())
        };
        assert!(!gmres(&mut b, 1e-10, 3, turn).unwrap());
        assert!(gmres(&mut b, 1e-10, 4, turn).unwrap());
    }
}
