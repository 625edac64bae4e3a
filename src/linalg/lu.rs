//! LU factorisation with partial pivoting, in place and without allocation, real or complex.

use crate::error::{Result, fail, try_vec};
use nalgebra::ComplexField;
use num_complex::Complex64;

/// Scalars that occur: `f64` and [`Complex64`].
pub trait Scalar: ComplexField<RealField = f64> + Copy {
    /// |re| + |im|: as good as the modulus for choosing a pivot, and cheaper.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for Complex64 {
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}

/// Factors P A = L U of a square column-major matrix, with the memory to hold them.
#[derive(Clone, Debug)]
pub struct Lu<T> {
    n: usize,
    a: Vec<T>,
    pivots: Vec<usize>,
}

impl<T: Scalar> Lu<T> {
    /// Memory for factors of n × n matrices.
    ///
    /// # Errors
    /// `OutOfMemory`, also when n² overflows.
    pub fn new(n: usize) -> Result<Self> {
        let Some(nn) = n.checked_mul(n) else {
            return fail!(OutOfMemory, "a dense factorisation of {n} unknowns cannot be stored");
        };
        Ok(Self {
            n,
            a: try_vec(nn, T::zero(), "an LU factorisation")?,
            pivots: try_vec(n, 0, "an LU factorisation")?,
        })
    }

    /// Order of the matrix.
    #[must_use]
    pub fn order(&self) -> usize {
        self.n
    }

    /// The matrix to fill, column-major, before [`Self::factor`].
    pub fn matrix(&mut self) -> &mut [T] {
        &mut self.a
    }

    /// Factors the matrix that was filled in.
    ///
    /// # Errors
    /// `Singular` naming the pivot that is exactly zero or not finite.
    pub fn factor(&mut self) -> Result<()> {
        let n = self.n;
        for j in 0..n {
            let (left, right) = self.a.split_at_mut(j * n);
            let column = &mut right[..n];
            // Left-looking: bring column j up to date with the columns already factored, whose
            // rows carry every interchange so far.
            for k in 0..j {
                column.swap(k, self.pivots[k]);
            }
            for k in 0..j {
                let factor = column[k];
                if !factor.is_zero() {
                    let l = &left[k * n + k + 1..(k + 1) * n];
                    for (c, &l) in column[k + 1..].iter_mut().zip(l) {
                        *c -= factor * l;
                    }
                }
            }
            let mut pivot = j;
            for i in j + 1..n {
                if column[i].size() > column[pivot].size() {
                    pivot = i;
                }
            }
            let size = column[pivot].size();
            if size == 0.0 || !size.is_finite() {
                return fail!(
                    Singular,
                    "a linear system of {n} unknowns is singular: pivot {j} is {size}"
                );
            }
            self.pivots[j] = pivot;
            column.swap(j, pivot);
            let inverse = T::one() / column[j];
            for c in &mut column[j + 1..] {
                *c *= inverse;
            }
            if pivot != j {
                for k in 0..j {
                    left.swap(k * n + j, k * n + pivot);
                }
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        for k in 0..n {
            let x = b[k];
            for (b, &l) in b[k + 1..].iter_mut().zip(&self.a[k * n + k + 1..(k + 1) * n]) {
                *b -= x * l;
            }
        }
        for k in (0..n).rev() {
            let x = b[k] / self.a[k * n + k];
            b[k] = x;
            for (b, &u) in b[..k].iter_mut().zip(&self.a[k * n..k * n + k]) {
                *b -= x * u;
            }
        }
    }

    /// Solves Aᵀ x = b in place (transposed, not conjugated).
    pub fn solve_transposed(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            let column = &self.a[k * n..k * n + k];
            let sum = column.iter().zip(&b[..k]).fold(b[k], |s, (&u, &x)| s - u * x);
            b[k] = sum / self.a[k * n + k];
        }
        for k in (0..n).rev() {
            let column = &self.a[k * n + k + 1..(k + 1) * n];
            b[k] = column.iter().zip(&b[k + 1..]).fold(b[k], |s, (&l, &x)| s - l * x);
        }
        for k in (0..n).rev() {
            b.swap(k, self.pivots[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system_and_its_transpose() {
        let n = 7;
        let a: Vec<f64> = (0..n * n).map(|k| ((k * k + 3 * k) as f64 * 0.37).sin()).collect();
        let mut lu = Lu::<f64>::new(n).unwrap();
        lu.matrix().copy_from_slice(&a);
        lu.factor().unwrap();
        let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
        let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum()).collect();
        lu.solve(&mut b);
        let mut bt: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[i * n + j] * x[j]).sum()).collect();
        lu.solve_transposed(&mut bt);
        for i in 0..n {
            assert!((b[i] - x[i]).abs() < 1e-13 && (bt[i] - x[i]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_singular_matrix_is_an_error() {
        let mut lu = Lu::<f64>::new(2).unwrap();
        lu.matrix().copy_from_slice(&[1.0, 1.0, 1.0, 1.0]);
        assert!(lu.factor().is_err());
    }
}
