//! How many eigenvalues of a Hermitian pencil lie below a value, without any of them: K − σM = L D Lᴴ has as many negative entries of D
//! as the pencil has eigenvalues below σ (Sylvester's law of inertia).
//!
//! Nothing is pivoted, so that an entry of D may be large against the matrix where a leading block is nearly singular. The number is then
//! still that of a matrix near K − σM.

use crate::error::{Error, Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::cholesky::{Cholesky, analysed_by_degrees};
use crate::linalg::sparse_storage::row_index::widened;
use crate::linalg::sparse_storage::sparse::Columns;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side};
use num_complex::Complex64;

const CONTEXT: &str = "a count of eigenvalues";

/// Number of eigenvalues of a pencil below a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Below {
    /// Number of eigenvalues below the value.
    pub count: usize,
    /// Number of entries of the factor L that was computed.
    pub entries: usize,
}

/// Number of eigenvalues of K x = λ M x below σ, from the lower triangles of K and M, where M is positive definite;
/// `None` where a pivot is zero.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn eigenvalues_below(
    k: &impl Columns,
    (sigma, m): (f64, &impl Columns),
    real: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Below>> {
    if real {
        negative_pivots_alone::<f64>(&Triangle::sum(k, (-sigma, m), interrupt)?, interrupt)
    } else {
        negative_pivots_alone::<Complex64>(&Triangle::sum(k, (-sigma, m), interrupt)?, interrupt)
    }
}

impl<T: Entry> Cholesky<T> {
    /// Number of negative pivots of another matrix with the pattern of A, in the memory of the factor, which [`Self::make_again`] must
    /// restore before anything is solved; `None` where a pivot is zero or not finite.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn negative_pivots(&mut self, a: &Triangle<T>, interrupt: &Interrupt<'_>) -> Result<Option<Below>> {
        negative_pivots(&self.symbolic, &mut self.values, a, interrupt)
    }
}

fn negative_pivots_alone<T: Entry>(a: &Triangle<T>, interrupt: &Interrupt<'_>) -> Result<Option<Below>> {
    let symbolic = {
        let rows = widened(&a.row_idx, CONTEXT)?;
        let pattern = SymbolicSparseColMatRef::new_checked(a.n, a.n, &a.col_ptr, None, &rows);
        analysed_by_degrees(pattern, interrupt)?
    };
    let mut values = try_vec(symbolic.len_val(), T::NONE, CONTEXT)?;
    negative_pivots(&symbolic, &mut values, a, interrupt)
}

/// Number of negative pivots of a matrix in a given order of elimination, with the memory of its factor.
fn negative_pivots<T: Entry>(
    symbolic: &SymbolicCholesky<usize>,
    values: &mut [T],
    a: &Triangle<T>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Below>> {
    if a.values.iter().any(|x| !x.complex().is_finite()) {
        return Ok(None);
    }
    interrupt.announce_factorisation()?;
    let rows = widened(&a.row_idx, CONTEXT)?;
    let pattern = SymbolicSparseColMatRef::new_checked(a.n, a.n, &a.col_ptr, None, &rows);
    let need = symbolic.factorize_numeric_ldlt_scratch::<T>(Par::Seq, faer::Spec::default());
    let mut scratch = MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?;
    let factored = symbolic.factorize_numeric_ldlt(
        values,
        SparseColMatRef::new(pattern, &a.values),
        Side::Lower,
        LdltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut scratch),
        faer::Spec::default(),
    );
    if factored.is_err() {
        return Ok(None);
    }
    interrupt.check()?;
    let entries = values.len();
    Ok(signs(symbolic, values).map(|count| Below { count, entries }))
}

/// Number of negative entries of D, which are the diagonals of the factor's columns; `None` where one is not finite.
fn signs<T: Entry>(symbolic: &SymbolicCholesky<usize>, values: &[T]) -> Option<usize> {
    let mut negative = 0;
    let mut see = |d: f64| {
        negative += usize::from(d < 0.0);
        d.is_finite()
    };
    let all_finite = match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(simplicial) => {
            let starts = &simplicial.col_ptr()[..simplicial.ncols()];
            starts.iter().all(|&start| see(values[start].complex().re))
        }
        SymbolicCholeskyRaw::Supernodal(supernodal) => {
            let factor = SupernodalLdltRef::new(supernodal, values);
            (0..supernodal.n_supernodes()).all(|s| {
                let block = factor.supernode(s).val();
                (0..block.ncols()).all(|j| see(block[(j, j)].complex().re))
            })
        }
    };
    all_finite.then_some(negative)
}

#[cfg(test)]
#[path = "inertia_tests.rs"]
mod tests;
