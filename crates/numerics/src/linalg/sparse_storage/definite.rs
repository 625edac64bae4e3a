//! Test of a large sparse matrix for positive definiteness, by a Cholesky factorisation. Lanczos iteration would
//! find a negative direction by chance only.

use crate::error::{Result, fail, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::factors::cholesky::Cholesky;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use num_complex::Complex64;

/// Relative addition to the diagonal, so that rounding does not make a singular matrix fail.
/// Kind: rounding.
const DEFINITE_MARGIN: f64 = 1e-10;

const CONTEXT: &str = "a Cholesky factorisation";

/// Refuses a Hermitian mass matrix that is negative in some direction, by a Cholesky
/// factorisation of M + 1e-10 diag(M).
///
/// # Errors
/// `NotPositiveDefinite` with a sentence about the mass matrix, `OutOfMemory`; `StoppedByCaller`.
pub fn check_mass(m: &Csc, interrupt: &Interrupt<'_>) -> Result<()> {
    let n = m.rows;
    let mut margin = Vec::new();
    for j in 0..n {
        let diagonal = m.get(j, j).re;
        let alone = diagonal == 0.0 && m.column(j).all(|(_, v)| v == Complex64::ZERO);
        if diagonal < 0.0 || (diagonal == 0.0 && !alone) {
            return negative(j);
        }
        // A row without mass is decoupled by a unit entry on the diagonal.
        let added = if alone { 1.0 } else { DEFINITE_MARGIN * diagonal };
        try_push(&mut margin, (j, j, added.into()), CONTEXT)?;
    }
    first_bad_pivot(m, margin, interrupt)?.map_or(Ok(()), negative)
}

/// Whether a Hermitian stiffness matrix resists every motion.
///
/// The test is a Cholesky factorisation of K − 1e-10 diag(K).
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn resists_all_motion(k: &Csc, interrupt: &Interrupt<'_>) -> Result<bool> {
    let mut margin = Vec::new();
    for j in 0..k.rows {
        try_push(&mut margin, (j, j, (-DEFINITE_MARGIN * k.get(j, j).re).into()), CONTEXT)?;
    }
    Ok(first_bad_pivot(k, margin, interrupt)?.is_none())
}

/// Pivot at which a Cholesky factorisation of a + margin breaks down; `None` where it succeeds.
fn first_bad_pivot(
    a: &Csc,
    margin: Vec<(usize, usize, Complex64)>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<usize>> {
    interrupt.check()?;
    let n = a.rows;
    let margin = Csc::from_triplets(n, n, margin)?;
    if a.is_real() {
        return bad_pivot_of::<f64>(a, &margin, interrupt);
    }
    bad_pivot_of::<Complex64>(a, &margin, interrupt)
}

fn bad_pivot_of<T: Entry>(a: &Csc, margin: &Csc, interrupt: &Interrupt<'_>) -> Result<Option<usize>> {
    let a = Triangle::<T>::sum(a, (1.0, margin), interrupt)?;
    Ok(Cholesky::or_bad_pivot(&a, |_| Ok(()), interrupt)?.err())
}

fn negative(pivot: usize) -> Result<()> {
    fail!(
        NotPositiveDefinite,
        "mass matrix is not positive semidefinite: pivot {pivot} is negative"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Status;

    /// A chain of consistent masses with the last `light` degrees of freedom massless.
    fn chain(n: usize, light: usize) -> Vec<(usize, usize, Complex64)> {
        let mut entries = Vec::new();
        for i in 0..n - light - 1 {
            for (p, q, v) in [(0, 0, 2.0), (1, 1, 2.0), (0, 1, 1.0), (1, 0, 1.0)] {
                entries.push((i + p, i + q, Complex64::from(v)));
            }
        }
        entries
    }

    #[test]
    fn a_semidefinite_mass_passes_and_a_negative_direction_does_not() {
        let n = 300;
        let check = |entries| check_mass(&Csc::from_triplets(n, n, entries).unwrap(), &Interrupt::none());
        check(chain(n, 0)).unwrap();
        check(chain(n, 40)).unwrap();
        // One mass on the difference of two motions: singular, not negative.
        let singular = [(0, 0, 1.0), (1, 1, 1.0), (0, 1, -1.0), (1, 0, -1.0)];
        check(singular.map(|(i, j, v)| (i, j, Complex64::from(v))).to_vec()).unwrap();
        // Positive on the diagonal, negative beside it.
        let mut entries = chain(n, 0);
        entries.extend([(7, 150, Complex64::new(0.0, 5.0)), (150, 7, Complex64::new(0.0, -5.0))]);
        assert!(check(entries).is_err_and(|e| e.status == Status::NotPositiveDefinite));
        let mut entries = chain(n, 40);
        entries.extend([(3, 290, Complex64::ONE), (290, 3, Complex64::ONE)]);
        assert!(check(entries).is_err_and(|e| e.status == Status::NotPositiveDefinite));
    }
}
