//! Dense matrices whose memory is asked for by requests that may fail, and products and inverses that a caller may interrupt.
//!
//! The functions of nalgebra that return a matrix end the process where memory is short; those that fill one ask for none but a fixed
//! memory of products.

use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Scalar;
use nalgebra::{DMatrix, DVector};

/// Operations between two checks of the interrupt, some milliseconds.
/// Kind: block.
const FALLIBLE_MATRIX_AT_ONCE: usize = 10_000_000;

/// Least columns of a part of a product: with fewer the left factor would be brought into order for each of them.
/// Kind: tuned; measured on: not recorded.
const FALLIBLE_MATRIX_LEAST_COLUMNS: usize = 8;

/// A matrix of zeros.
///
/// # Errors
/// `OutOfMemory` naming `what`.
pub fn zeros<T: Scalar>(rows: usize, columns: usize, what: &str) -> Result<DMatrix<T>> {
    let values = try_vec(rows.saturating_mul(columns), T::zero(), what)?;
    Ok(DMatrix::from_vec(rows, columns, values))
}

/// A vector of zeros.
///
/// # Errors
/// `OutOfMemory` naming `what`.
pub fn zero_vector<T: Scalar>(rows: usize, what: &str) -> Result<DVector<T>> {
    Ok(DVector::from_vec(try_vec(rows, T::zero(), what)?))
}

/// A copy of a vector.
///
/// # Errors
/// `OutOfMemory` naming `what`.
pub fn copy_of_vector<T: Scalar>(x: &DVector<T>, what: &str) -> Result<DVector<T>> {
    Ok(DVector::from_vec(try_copy(x.as_slice(), what)?))
}

/// A matrix with given entries.
///
/// # Errors
/// `OutOfMemory` naming `what`.
pub fn filled<T: Scalar>(
    rows: usize,
    columns: usize,
    what: &str,
    entry: impl Fn(usize, usize) -> T,
) -> Result<DMatrix<T>> {
    let mut a = zeros(rows, columns, what)?;
    for (j, mut column) in a.column_iter_mut().enumerate() {
        for (i, value) in column.iter_mut().enumerate() {
            *value = entry(i, j);
        }
    }
    Ok(a)
}

/// The conjugate transpose of a matrix.
///
/// # Errors
/// `OutOfMemory` naming `what`.
pub fn adjoint<T: Scalar>(a: &DMatrix<T>, what: &str) -> Result<DMatrix<T>> {
    filled(a.ncols(), a.nrows(), what, |i, j| {
        nalgebra::ComplexField::conjugate(a[(j, i)])
    })
}

/// C ← C + factor A B, computed some columns at a time.
///
/// # Errors
/// `StoppedByCaller`.
pub fn add_product<T: Scalar>(
    c: &mut DMatrix<T>,
    factor: T,
    (a, b): (&DMatrix<T>, &DMatrix<T>),
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let of_column = 2 * a.len();
    if of_column == 0 {
        return Ok(());
    }
    let together = (FALLIBLE_MATRIX_AT_ONCE / of_column).max(FALLIBLE_MATRIX_LEAST_COLUMNS);
    for first in (0..b.ncols()).step_by(together) {
        let count = together.min(b.ncols() - first);
        interrupt.check_before((of_column * count) as u64)?;
        c.columns_mut(first, count)
            .gemm(factor, a, &b.columns(first, count), T::one());
    }
    Ok(())
}

/// The product A B.
///
/// # Errors
/// `OutOfMemory` naming `what`; `StoppedByCaller`.
pub fn product<T: Scalar>(a: &DMatrix<T>, b: &DMatrix<T>, what: &str, interrupt: &Interrupt<'_>) -> Result<DMatrix<T>> {
    let mut c = zeros(a.nrows(), b.ncols(), what)?;
    add_product(&mut c, T::one(), (a, b), interrupt)?;
    Ok(c)
}

/// Replaces a Hermitian matrix by its inverse, by Gauss–Jordan elimination without interchanges, which is stable
/// where the matrix is positive definite (Higham, Accuracy and Stability of Numerical Algorithms, 2002, §14.4).
/// Returns `false` if it is not definite; its entries are then lost.
///
/// # Errors
/// `OutOfMemory` naming `what`; `StoppedByCaller`.
pub fn invert_definite<T: Scalar>(a: &mut DMatrix<T>, what: &str, interrupt: &Interrupt<'_>) -> Result<bool> {
    let n = a.nrows();
    let mut pivotal = zero_vector::<T>(n, what)?;
    for k in 0..n {
        interrupt.check_before((2 * n * n) as u64)?;
        let pivot = a[(k, k)].real();
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Ok(false);
        }
        pivotal.copy_from(&a.column(k));
        pivotal[k] = T::zero();
        for j in (0..n).filter(|&j| j != k) {
            let share = a[(k, j)].unscale(pivot);
            a.column_mut(j).axpy(-share, &pivotal, T::one());
            a[(k, j)] = share;
        }
        a.column_mut(k).copy_from(&pivotal);
        a.column_mut(k).unscale_mut(-pivot);
        a[(k, k)] = T::from_real(1.0 / pivot);
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Status;
    use num_complex::Complex64;

    /// A positive definite matrix, with phases.
    fn definite(n: usize) -> DMatrix<Complex64> {
        let root = DMatrix::from_fn(n, n, |i, j| {
            let at = (i * 7 + j * 13 + 1) as f64;
            Complex64::new((1.7 * at).sin(), (2.3 * at).cos()) / n as f64
        });
        &root * root.adjoint() + DMatrix::identity(n, n) * Complex64::from(0.1)
    }

    #[test]
    fn the_inverse_of_a_definite_matrix_is_that_of_its_equations() {
        for n in [0, 1, 2, 17] {
            let a = definite(n);
            let mut inverse = a.clone();
            assert!(invert_definite(&mut inverse, "a test", &Interrupt::none()).unwrap());
            let gap = &a * &inverse - DMatrix::identity(n, n);
            assert!(gap.iter().all(|z| z.norm() < 1e-13), "order {n}");
            let real = a.map(|z| z.re);
            let mut inverse = real.clone();
            assert!(invert_definite(&mut inverse, "a test", &Interrupt::none()).unwrap());
            let gap = &real * &inverse - DMatrix::identity(n, n);
            assert!(gap.iter().all(|x| x.abs() < 1e-13), "order {n}");
        }
    }

    /// A complex root of a negative pivot exists, so that nalgebra's factors do not tell.
    #[test]
    fn a_matrix_that_is_not_definite_is_told() {
        let mut a = definite(5);
        a[(3, 3)] -= Complex64::from(10.0);
        assert!(!invert_definite(&mut a, "a test", &Interrupt::none()).unwrap());
    }

    #[test]
    fn products_in_parts_are_products() {
        let a = DMatrix::from_fn(700, 300, |i, j| ((i * 3 + j) as f64).sin());
        let b = DMatrix::from_fn(300, 90, |i, j| ((i + j * 5) as f64).cos());
        let none = Interrupt::none();
        let parts = product(&a, &b, "a test", &none).unwrap();
        assert!(none.checks() > 1);
        assert!((&a * &b - parts).amax() < 1e-12);
        let adjoint = adjoint(&definite(4).columns(0, 3).into_owned(), "a test").unwrap();
        assert_eq!(adjoint, definite(4).columns(0, 3).adjoint());
    }

    #[test]
    fn more_entries_than_memory_are_an_error() {
        assert_eq!(
            zeros::<f64>(usize::MAX, 2, "a test").unwrap_err().status,
            Status::OutOfMemory
        );
        assert_eq!(
            zero_vector::<f64>(1 << 60, "a test").unwrap_err().status,
            Status::OutOfMemory
        );
    }
}
