//! The eigenproblem K φ = λ M φ of real symmetric matrices with M positive definite, in real arithmetic: a quarter of the work of
//! complex matrices.

use crate::error::{Error, Result, try_vec};
use crate::interrupt::Interrupt;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par, Spec};
use nalgebra::DMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// Residual of the pairs of a matrix over its largest entry and its order that is more than rounding.
/// Kind: rounding.
const WRONG: f64 = 1e-13;

/// Eigenvalues λ, rising; and vectors φ with φᵀ M φ = 1, column after column.
type Found = (Vec<f64>, DMatrix<Complex64>);

/// The eigenpairs by M = L Lᵀ; `None` where a matrix is not real, M is not definite, its smallest pivot is below a
/// share `regular` of the largest, or the pairs are not accurate. The interrupt is checked before each step, not
/// within.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn with_definite_mass(
    k: &DMatrix<Complex64>,
    m: &DMatrix<Complex64>,
    regular: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Found>> {
    let n = k.nrows();
    let is_real = |a: &DMatrix<Complex64>| a.iter().all(|z| z.im == 0.0 && z.re.is_finite());
    if n == 0 || !is_real(k) || !is_real(m) {
        return Ok(None);
    }
    let operations = (n * n * n) as u64;
    interrupt.check_before(operations / 3)?;
    let mut l = real(m)?;
    let mut scratch = memory(cholesky_in_place_scratch::<f64>(n, Par::Seq, Spec::default()))?;
    let stack = MemStack::new(&mut scratch);
    let factored = cholesky_in_place(
        square_mut(&mut l, n),
        LltRegularization::default(),
        Par::Seq,
        stack,
        Spec::default(),
    );
    let (low, high) = (0..n).fold((f64::INFINITY, 0.0_f64), |(low, high), i| {
        let pivot = l[i * n + i];
        (low.min(pivot), high.max(pivot))
    });
    if factored.is_err() || low <= regular * high || low.is_nan() {
        return Ok(None);
    }
    // A = L⁻¹ K L⁻ᵀ
    let mut a = real(k)?;
    interrupt.check_before(operations)?;
    solve_lower_triangular_in_place(square(&l, n), square_mut(&mut a, n), Par::Seq);
    interrupt.check_before(operations)?;
    solve_lower_triangular_in_place(square(&l, n), square_mut(&mut a, n).transpose_mut(), Par::Seq);
    for j in 0..n {
        for i in 0..j {
            let mean = 0.5 * (a[j * n + i] + a[i * n + j]);
            a[j * n + i] = mean;
            a[i * n + j] = mean;
        }
    }
    let (mut values, mut x) = (try_vec(n, 0.0, CONTEXT)?, try_vec(n * n, 0.0, CONTEXT)?);
    interrupt.check_before(9 * operations)?;
    let (yes, by_default) = (ComputeEigenvectors::Yes, Spec::default());
    let mut scratch = memory(self_adjoint_evd_scratch::<f64>(n, yes, Par::Seq, by_default))?;
    let found = self_adjoint_evd(
        square(&a, n),
        DiagMut::from_slice_mut(&mut values),
        Some(square_mut(&mut x, n)),
        Par::Seq,
        MemStack::new(&mut scratch),
        by_default,
    );
    interrupt.check_before(2 * operations)?;
    if found.is_err() || residual(&a, &values, &x, n)? > WRONG * n as f64 {
        return Ok(None);
    }
    interrupt.check_before(operations)?;
    solve_upper_triangular_in_place(square(&l, n).transpose(), square_mut(&mut x, n), Par::Seq);
    let mut vectors = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for (to, x) in vectors.iter_mut().zip(&x) {
        *to = (*x).into();
    }
    Ok(Some((values, DMatrix::from_vec(n, n, vectors))))
}

/// Error of eigenpairs: largest entry of A X − X Λ over that of A; infinite where a value is not above the one
/// before.
fn residual(a: &[f64], values: &[f64], x: &[f64], n: usize) -> Result<f64> {
    let mut product = try_vec(n * n, 0.0, CONTEXT)?;
    matmul(
        square_mut(&mut product, n),
        Accum::Replace,
        square(a, n),
        square(x, n),
        1.0,
        Par::Seq,
    );
    let largest = a.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let mut worst = 0.0_f64;
    for ((y, x), value) in product.chunks_exact(n).zip(x.chunks_exact(n)).zip(values) {
        for (y, x) in y.iter().zip(x) {
            let off = (y - value * x).abs();
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
        }
    }
    let rises = values.windows(2).all(|pair| pair[0] <= pair[1]);
    Ok(if rises { worst / largest } else { f64::INFINITY })
}

fn real(a: &DMatrix<Complex64>) -> Result<Vec<f64>> {
    let mut found = try_vec(a.len(), 0.0, CONTEXT)?;
    for (to, z) in found.iter_mut().zip(a.iter()) {
        *to = z.re;
    }
    Ok(found)
}

fn square(a: &[f64], n: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a, n, n)
}

fn square_mut(a: &mut [f64], n: usize) -> MatMut<'_, f64> {
    MatMut::from_column_major_slice_mut(a, n, n)
}

fn memory(need: StackReq) -> Result<MemBuffer> {
    MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A chain of unit springs between walls with masses of `mass`, every frequency `copies` times.
    fn chains(length: usize, copies: usize, mass: f64) -> (DMatrix<Complex64>, DMatrix<Complex64>) {
        let n = length * copies;
        let k = DMatrix::from_fn(n, n, |i, j| {
            let apart = [2.0, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0);
            Complex64::from(if i / length == j / length { apart } else { 0.0 })
        });
        (k, DMatrix::from_diagonal_element(n, n, mass.into()))
    }

    #[test]
    fn chains_have_their_frequencies_in_closed_form_each_as_often_as_it_occurs() {
        for (length, copies) in [(130, 1), (60, 3), (2, 90)] {
            let (k, m) = chains(length, copies, 4.0);
            let (values, vectors) = with_definite_mass(&k, &m, 0.0, &Interrupt::none()).unwrap().unwrap();
            for (i, value) in values.iter().enumerate() {
                let half = 0.5 * PI * (i / copies + 1) as f64 / (length + 1) as f64;
                assert!(
                    (value - half.sin().powi(2)).abs() < 1e-14 * length as f64,
                    "{length}, {i}"
                );
            }
            let gram = vectors.adjoint() * &m * &vectors;
            let off = gram - DMatrix::identity(k.nrows(), k.nrows());
            assert!(off.iter().all(|z| z.norm() < 1e-12), "{length}");
        }
    }

    #[test]
    fn complex_matrices_and_a_mass_that_is_not_definite_are_left_to_others() {
        let (mut k, mut m) = chains(120, 1, 1.0);
        m[(7, 7)] = (-1.0).into();
        assert!(with_definite_mass(&k, &m, 0.0, &Interrupt::none()).unwrap().is_none());
        m[(7, 7)] = 1e-9.into();
        assert!(with_definite_mass(&k, &m, 1e-3, &Interrupt::none()).unwrap().is_none());
        m[(7, 7)] = 1.0.into();
        k[(3, 4)] += Complex64::I;
        assert!(with_definite_mass(&k, &m, 0.0, &Interrupt::none()).unwrap().is_none());
    }
}
