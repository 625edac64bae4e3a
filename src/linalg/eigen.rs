//! The Hermitian eigenproblem K φ = λ M φ with a mass matrix that may be singular.

use crate::error::{Result, fail};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use num_complex::Complex64;

/// Eigenvalues in ascending order and the matching mass-normalised vectors as columns.
/// Infinite eigenvalues (motion without mass) are left out.
pub struct Pairs {
    /// λ, ascending.
    pub values: Vec<f64>,
    /// φ with φᴴ M φ = 1; one column per eigenvalue.
    pub vectors: DMatrix<Complex64>,
}

/// Iteration cap of the dense eigensolver, far above what converging cases need.
const MAX_ITERATIONS: usize = 100_000;

/// Relative size below which an eigenvalue of the mass matrix counts as zero.
const MASSLESS: f64 = 1e-12;

/// All finite eigenpairs of Hermitian K and positive semidefinite Hermitian M.
///
/// M is diagonalised first, M = U Λ Uᴴ; massless directions are condensed statically onto the
/// others (their rows carry K only), and the rest is scaled by Λ^(-1/2).
///
/// # Errors
/// `NotPositiveDefinite` when M has a negative eigenvalue, `Singular` when K cannot be condensed
/// onto the directions with mass, `NoConvergence` from the eigensolver.
pub fn generalised(k: &DMatrix<Complex64>, m: &DMatrix<Complex64>) -> Result<Pairs> {
    let n = k.nrows();
    // The common case, M positive definite: L⁻¹ K L⁻ᴴ has the smallest rounding error.
    if let Some(cholesky) = Cholesky::new(m.clone()) {
        let l = cholesky.l();
        let diagonal = l.diagonal().map(|x| x.re);
        if diagonal.min() > 1e-5 * diagonal.max() {
            let (Some(left), true) = (l.solve_lower_triangular(k), n > 0) else {
                return fail!(NotPositiveDefinite, "mass matrix is not positive definite");
            };
            let Some(a) = l.solve_lower_triangular(&left.adjoint()) else {
                return fail!(NotPositiveDefinite, "mass matrix is not positive definite");
            };
            let (values, vectors) = hermitian(&a)?;
            let Some(vectors) = l.adjoint().solve_upper_triangular(&vectors) else {
                return fail!(NotPositiveDefinite, "mass matrix is not positive definite");
            };
            return Ok(Pairs { values, vectors });
        }
    }
    let (mass, u) = hermitian(m)?;
    let largest = mass.last().copied().unwrap_or(0.0);
    if let Some(pivot) = mass
        .iter()
        .position(|&x| x < -MASSLESS * largest.abs().max(f64::MIN_POSITIVE))
    {
        return fail!(
            NotPositiveDefinite,
            "mass matrix is not positive semidefinite: eigenvalue {pivot} is {}",
            mass[pivot]
        );
    }
    let massless = mass.iter().take_while(|&&x| x <= MASSLESS * largest).count();
    let heavy = n - massless;
    if heavy == 0 {
        return fail!(NotPositiveDefinite, "mass matrix is zero: there is no vibration mode");
    }
    let k = u.adjoint() * k * &u;
    let kss = k.view((0, 0), (massless, massless)).into_owned();
    let ksh = k.view((0, massless), (massless, heavy)).into_owned();
    let khh = k.view((massless, massless), (heavy, heavy)).into_owned();
    let (condensed, static_part) = if massless == 0 {
        (khh, DMatrix::zeros(0, heavy))
    } else {
        let Some(x) = kss.lu().solve(&ksh) else {
            return fail!(Singular, "stiffness of the massless degrees of freedom is singular");
        };
        (khh - ksh.adjoint() * &x, -x)
    };
    let scale: Vec<f64> = mass[massless..].iter().map(|x| 1.0 / x.sqrt()).collect();
    let a = DMatrix::from_fn(heavy, heavy, |i, j| condensed[(i, j)] * scale[i] * scale[j]);
    let (values, reduced) = hermitian(&a)?;
    let heavy_part = DMatrix::from_fn(heavy, heavy, |i, j| reduced[(i, j)] * scale[i]);
    let light_part = static_part * &heavy_part;
    let mut stacked = DMatrix::zeros(n, heavy);
    stacked.view_mut((0, 0), (massless, heavy)).copy_from(&light_part);
    stacked.view_mut((massless, 0), (heavy, heavy)).copy_from(&heavy_part);
    Ok(Pairs {
        values,
        vectors: u * stacked,
    })
}

/// Eigenvalues in ascending order and orthonormal eigenvectors of a Hermitian matrix.
fn hermitian(a: &DMatrix<Complex64>) -> Result<(Vec<f64>, DMatrix<Complex64>)> {
    let n = a.nrows();
    let symmetric = (a + a.adjoint()) * Complex64::new(0.5, 0.0);
    let Some(eigen) = SymmetricEigen::try_new(symmetric, f64::EPSILON, MAX_ITERATIONS) else {
        return fail!(NoConvergence, "the eigenvalues of a matrix of order {n} were not found");
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    let vectors = DMatrix::from_fn(n, n, |i, j| eigen.eigenvectors[(i, order[j])]);
    Ok((values, vectors))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(n: usize, v: &[f64]) -> DMatrix<Complex64> {
        DMatrix::from_fn(n, n, |i, j| v[j * n + i].into())
    }

    #[test]
    fn a_massless_dof_is_condensed() {
        // Two springs in series between ground and a unit mass, massless joint: 1/(1/2 + 1/2) = 1.
        let k = real(2, &[4.0, -2.0, -2.0, 2.0]);
        let m = real(2, &[0.0, 0.0, 0.0, 1.0]);
        let pairs = generalised(&k, &m).unwrap();
        assert_eq!(pairs.values.len(), 1);
        assert!((pairs.values[0] - 1.0).abs() < 1e-14);
        assert!((pairs.vectors[(0, 0)] - pairs.vectors[(1, 0)] * 0.5).norm() < 1e-14);
    }

    #[test]
    fn an_indefinite_mass_is_an_error() {
        let pairs = generalised(&real(2, &[1.0, 0.0, 0.0, 1.0]), &real(2, &[1.0, 0.0, 0.0, -1.0]));
        assert!(pairs.is_err_and(|e| e.status == crate::error::Status::NotPositiveDefinite));
    }
}
