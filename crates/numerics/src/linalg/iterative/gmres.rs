//! The generalised minimal residual method (Saad & Schultz 1986, doi:10.1137/0907058) for a matrix that is known
//! only by its products with vectors. Each vector is made orthogonal to those before one after the other and once: what that
//! loses by rounding does no harm (Paige, Rozložník & Strakoš 2006, doi:10.1137/050630416).

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_push, try_vec};
use crate::linalg::{dot, norm};
use pulp::{Arch, Simd, WithSimd};

const CONTEXT: &str = "an iterative linear solution";

/// Outcome of an iteration that converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Converged {
    /// Number of products with the matrix.
    pub products: usize,
    /// Whether the determinant of the Hessenberg matrix is positive. Its eigenvalues approximate those of A that
    /// matter to b and lie apart from the others. Since pairs of complex ones and the eigenvalue 1 leave the sign
    /// unchanged, this is the sign of det A where A is the identity but for few eigenvalues.
    pub positive: bool,
}

/// The method with its memory, which grows with the number of products and is used again by later solutions.
#[derive(Default)]
pub struct Gmres {
    basis: Vec<Vec<f64>>,
    /// Columns of the Hessenberg matrix' triangular factor; and the rotations that made it.
    triangle: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    rest: Vec<f64>,
}

impl Gmres {
    /// Solves A x = b from x = 0 until ‖b − A x‖ ≤ tolerance·‖b‖, where `product` computes A v; b is replaced by x.
    /// Returns `None`, with b unchanged, if this takes more than `most` products.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of the products.
    pub fn solve(
        &mut self,
        b: &mut [f64],
        tolerance: f64,
        most: usize,
        mut product: impl FnMut(&[f64], &mut [f64]) -> Result<()>,
    ) -> Result<Option<Converged>> {
        let size = norm(b);
        let mut found = Converged {
            products: 0,
            positive: true,
        };
        if size == 0.0 {
            return Ok(Some(found));
        }
        if !size.is_finite() {
            return Ok(None);
        }
        self.rotations.clear();
        self.rest.clear();
        try_push(&mut self.rest, size, CONTEXT)?;
        self.reserve(0, b.len())?;
        for (q, b) in self.basis[0].iter_mut().zip(&*b) {
            *q = b / size;
        }
        let arch = Arch::new();
        for k in 0..most {
            self.reserve(k + 1, b.len())?;
            let (known, next) = self.basis.split_at_mut(k + 1);
            let v = &mut next[0];
            product(&known[k], v)?;
            found.products += 1;
            let column = &mut self.triangle[k];
            let part = Orthogonalise { v, known, column };
            arch.dispatch(part);
            let below = norm(v);
            for (i, &(c, s)) in self.rotations.iter().enumerate() {
                let (x, y) = (column[i], column[i + 1]);
                column[i] = c * x + s * y;
                column[i + 1] = c * y - s * x;
            }
            let length = column[k].hypot(below);
            if length == 0.0 || !length.is_finite() {
                return Ok(None);
            }
            let (c, s) = (column[k] / length, below / length);
            // The other numbers on the diagonal are lengths.
            found.positive = c >= 0.0;
            column[k] = length;
            try_push(&mut self.rotations, (c, s), CONTEXT)?;
            let last = self.rest[k];
            self.rest[k] = c * last;
            try_push(&mut self.rest, -s * last, CONTEXT)?;
            if self.rest[k + 1].abs() <= tolerance * size {
                combine(&self.basis, &self.triangle[..=k], &mut self.rest, b);
                return Ok(Some(found));
            }
            for v in v {
                *v /= below;
            }
        }
        Ok(None)
    }

    /// Memory for vector `k` of the basis, with `n` numbers, and for the column before it.
    fn reserve(&mut self, k: usize, n: usize) -> Result<()> {
        if self.basis.first().is_some_and(|first| first.len() != n) {
            self.basis.clear();
        }
        while self.basis.len() <= k {
            let vector = try_vec(n, 0.0, CONTEXT)?;
            try_push(&mut self.basis, vector, CONTEXT)?;
        }
        while self.triangle.len() < k {
            let column = try_vec(self.triangle.len() + 1, 0.0, CONTEXT)?;
            try_push(&mut self.triangle, column, CONTEXT)?;
        }
        Ok(())
    }
}

/// Removes from v its components along known vectors, one after the other, and stores them; compiled for the vector
/// instructions of the processor.
struct Orthogonalise<'a> {
    v: &'a mut [f64],
    known: &'a [Vec<f64>],
    column: &'a mut [f64],
}

impl WithSimd for Orthogonalise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { v, known, column } = self;
        for (h, q) in column.iter_mut().zip(known) {
            let along = dot(q, v);
            *h = along;
            for (v, q) in v.iter_mut().zip(q) {
                *v -= along * q;
            }
        }
    }
}

/// x ← Q R⁻¹ g, the combination of basis vectors that solves the system.
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

#[cfg(test)]
mod tests {
    use super::Gmres;

    #[test]
    fn a_system_near_the_identity_takes_few_products_and_any_system_as_many_as_unknowns() {
        let n = 30;
        let mut memory = Gmres::default();
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
            let done = memory.solve(&mut b, 1e-12, most, |v, out| {
                products += 1;
                times(v, out);
                Ok(())
            });
            assert_eq!(done.unwrap().unwrap().products, products);
            assert!(products <= most);
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
        let mut memory = Gmres::default();
        assert!(memory.solve(&mut b, 1e-10, 3, turn).unwrap().is_none());
        assert_eq!(b.map(f64::to_bits), [1.0_f64, 0.0, 0.0, 0.0].map(f64::to_bits));
        assert!(memory.solve(&mut b, 1e-10, 4, turn).unwrap().is_some());
    }

    #[test]
    fn sign_of_the_determinant_of_a_matrix_near_the_identity() {
        let n = 24;
        for (few, positive) in [
            (vec![], true),
            (vec![-0.3], false),
            (vec![-4.0, -0.2], true),
            (vec![-2.0, 0.1], false),
        ] {
            let mut b: Vec<f64> = (0..n).map(|k| 1.0 + (k as f64).cos()).collect();
            // Q D Qᵀ with a reflection Q along a vector of equal numbers.
            let product = |v: &[f64], out: &mut [f64]| {
                let reflect = |x: &mut [f64]| {
                    let mean = 2.0 * x.iter().sum::<f64>() / n as f64;
                    for x in x {
                        *x -= mean;
                    }
                };
                out.copy_from_slice(v);
                reflect(out);
                for (k, x) in out.iter_mut().enumerate() {
                    *x *= few.get(k).copied().unwrap_or(1.0 + 0.05 * (k as f64).sin());
                }
                reflect(out);
                Ok(())
            };
            let found = Gmres::default().solve(&mut b, 1e-10, n, product).unwrap().unwrap();
            assert_eq!(found.positive, positive, "{few:?}");
        }
    }
}
