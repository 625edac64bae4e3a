//! The eigenproblems of small Hermitian matrices, in real arithmetic where they are real: a quarter of the operations.
//!
//! The eigensolver of nalgebra has no blocks, and room on a small stack.

use crate::error::{Result, fail, try_vec};
use nalgebra::{Cholesky, ComplexField, DMatrix, SymmetricEigen};
use num_complex::Complex64;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// Most iterations of the eigensolver.
/// Kind: cap.
const SMALL_MAX_ITERATIONS: usize = 100_000;

/// Eigenvalues, rising, and eigenvectors.
type Found<T> = (Vec<f64>, DMatrix<T>);

/// Eigenvalues in ascending order and orthonormal eigenvectors of the Hermitian part of a matrix.
///
/// # Errors
/// `NoConvergence`, `OutOfMemory`.
pub(super) fn hermitian(a: &DMatrix<Complex64>) -> Result<Found<Complex64>> {
    match real(a)? {
        Some(a) => complex(pairs_of(&a)?),
        None => pairs_of(a),
    }
}

/// The eigenpairs of K φ = λ M φ by M = L Lᴴ, with φᴴ M φ = 1; `None` where the smallest pivot of M is not above a share `regular` of the
/// largest. L⁻¹ K L⁻ᴴ has the smallest rounding error.
///
/// # Errors
/// `NoConvergence`, `NotPositiveDefinite`, `OutOfMemory`.
pub(super) fn with_definite_mass(
    k: &DMatrix<Complex64>,
    m: &DMatrix<Complex64>,
    regular: f64,
) -> Result<Option<Found<Complex64>>> {
    if let (Some(k), Some(m)) = (real(k)?, real(m)?) {
        return by_cholesky(&k, &m, regular)?.map(complex).transpose();
    }
    by_cholesky(k, m, regular)
}

fn by_cholesky<T: ComplexField<RealField = f64>>(
    k: &DMatrix<T>,
    m: &DMatrix<T>,
    regular: f64,
) -> Result<Option<Found<T>>> {
    let Some(cholesky) = Cholesky::new(m.clone()) else {
        return Ok(None);
    };
    let l = cholesky.l();
    // The complex root of a negative pivot exists: it is imaginary, and its real part is rounding.
    let is_definite = l
        .diagonal()
        .iter()
        .all(|x| x.clone().imaginary().abs() <= regular * x.clone().real());
    let diagonal = l.diagonal().map(ComplexField::real);
    if !is_definite || diagonal.min() <= regular * diagonal.max() {
        return Ok(None);
    }
    let solved = l.solve_lower_triangular(k).filter(|_| k.nrows() > 0);
    let Some(a) = solved.and_then(|left| l.solve_lower_triangular(&left.adjoint())) else {
        return fail!(NotPositiveDefinite, "mass matrix is not positive definite");
    };
    let (values, vectors) = pairs_of(&a)?;
    let Some(vectors) = l.adjoint().solve_upper_triangular(&vectors) else {
        return fail!(NotPositiveDefinite, "mass matrix is not positive definite");
    };
    Ok(Some((values, vectors)))
}

fn pairs_of<T: ComplexField<RealField = f64>>(a: &DMatrix<T>) -> Result<Found<T>> {
    let n = a.nrows();
    if n == 0 {
        return Ok((Vec::new(), filled(0, |_, _| T::zero())?));
    }
    let half = T::from_real(0.5);
    let symmetric = filled(n, |i, j| {
        (a[(i, j)].clone() + a[(j, i)].clone().conjugate()) * half.clone()
    })?;
    let Some(eigen) = SymmetricEigen::try_new(symmetric, f64::EPSILON, SMALL_MAX_ITERATIONS) else {
        return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    let vectors = filled(n, |i, j| eigen.eigenvectors[(i, order[j])].clone())?;
    Ok((values, vectors))
}

/// The matrix in real numbers; `None` where it has imaginary parts.
fn real(a: &DMatrix<Complex64>) -> Result<Option<DMatrix<f64>>> {
    if a.iter().any(|z| z.im != 0.0) {
        return Ok(None);
    }
    filled(a.nrows(), |i, j| a[(i, j)].re).map(Some)
}

fn complex((values, vectors): Found<f64>) -> Result<Found<Complex64>> {
    let vectors = filled(vectors.nrows(), |i, j| vectors[(i, j)].into())?;
    Ok((values, vectors))
}

fn filled<T: ComplexField>(n: usize, entry: impl Fn(usize, usize) -> T) -> Result<DMatrix<T>> {
    let mut numbers = try_vec(n.saturating_mul(n), T::zero(), CONTEXT)?;
    for (at, number) in numbers.iter_mut().enumerate() {
        *number = entry(at % n, at / n);
    }
    Ok(DMatrix::from_vec(n, n, numbers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_matrices_have_the_pairs_that_complex_arithmetic_finds() {
        for n in [0, 1, 2, 7, 40] {
            let wave = |i: usize, j: usize| ((i * 5 + j * 3) as f64 * 0.7).sin();
            let symmetric = |shift: f64| {
                DMatrix::from_fn(n, n, |i, j| {
                    Complex64::from(wave(i, j) + wave(j, i) + if i == j { shift } else { 0.0 })
                })
            };
            let (k, m) = (symmetric(3.0), symmetric(2.0 * n as f64 + 3.0));
            let (values, vectors) = hermitian(&k).unwrap();
            let (expected, _) = pairs_of(&k).unwrap();
            let size = values.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            assert!(values.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-13 * size));
            for (j, value) in values.iter().enumerate() {
                let x = vectors.column(j);
                assert!((&k * x - x * Complex64::from(*value)).norm() < 1e-13 * size);
            }
            if n == 0 {
                continue;
            }
            let (values, vectors) = with_definite_mass(&k, &m, 1e-5).unwrap().unwrap();
            let (expected, _) = by_cholesky(&k, &m, 1e-5).unwrap().unwrap();
            for (j, (value, expected)) in values.iter().zip(&expected).enumerate() {
                let x = vectors.column(j);
                assert!((value - expected).abs() < 1e-13);
                assert!((&k * x - &m * x * Complex64::from(*value)).norm() < 1e-12);
                assert!(((x.adjoint() * &m * x)[(0, 0)] - 1.0).norm() < 1e-13);
            }
        }
    }

    #[test]
    fn a_mass_that_is_not_definite_is_left_to_others() {
        let diagonal = |a: f64, b: f64| DMatrix::from_fn(2, 2, |i, j| [[a, 0.0], [0.0, b]][i][j].into());
        let k = diagonal(1.0, 2.0);
        for (a, b) in [(1.0, 0.0), (1.0, -1.0), (1.0, 1e-12)] {
            assert!(with_definite_mass(&k, &diagonal(a, b), 1e-5).unwrap().is_none());
        }
    }
}
