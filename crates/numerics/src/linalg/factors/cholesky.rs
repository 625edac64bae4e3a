//! L Lᴴ factors of a large sparse Hermitian positive definite matrix: a tenth of the memory of its LU factors, and their
//! size is known before they are computed.

use crate::error::{Error, Result, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::elimination_order::nested_dissection;
use crate::linalg::sparse_storage::row_index::widened;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use num_complex::Complex64;

const CONTEXT: &str = "a Cholesky factorisation";

/// Right-hand sides that are solved between two checks of the interrupt.
/// Kind: block.
const CHOLESKY_AT_ONCE: usize = 8;

/// Operations per entry of the factors and right-hand side.
/// Kind: block.
const OF_ONE_ENTRY: u64 = 4;

/// Entries of L by minimum degrees from which nested dissection is tried, too: below, either is a small part of the memory of
/// a call.
/// Kind: tuned; measured on: not recorded.
const DISSECTED_FROM: usize = 10_000_000;

/// Entries of L over those of the lower triangle from which it is tried: below, the factor costs less than the search.
/// Kind: tuned; measured on: not recorded.
const FILLED: usize = 4;

/// Share of the entries by minimum degrees below which it is taken: a wide factor that saves little costs more operations.
/// Kind: tuned; measured on: not recorded.
const SAVED: f64 = 0.9;

/// Choice of the order of elimination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// Order of approximate minimum degrees.
    Degrees,
    /// Order of nested dissection.
    Dissection,
    /// Nested dissection where L has many entries, and clearly fewer by it; else minimum degrees.
    Smaller,
}

fn analysed(
    pattern: SymbolicSparseColMatRef<'_, usize>,
    order: Order,
    interrupt: &Interrupt<'_>,
) -> Result<SymbolicCholesky<usize>> {
    let n = pattern.nrows();
    let by = |ordering: SymmetricOrdering<'_, usize>| {
        let parameters = CholeskySymbolicParams::default();
        factorize_symbolic_cholesky(pattern, Side::Lower, ordering, parameters)
            .map_err(|_| Error::out_of_memory(CONTEXT))
    };
    let dissected = || {
        let rows = nested_dissection(pattern.col_ptr(), pattern.row_idx(), interrupt)?;
        let mut places = try_vec(n, 0, CONTEXT)?;
        for (place, &row) in rows.iter().enumerate() {
            places[row] = place;
        }
        by(SymmetricOrdering::Custom(PermRef::new_checked(&rows, &places, n)))
    };
    if order == Order::Dissection {
        return dissected();
    }
    let symbolic = by(SymmetricOrdering::Amd)?;
    let entries = symbolic.len_val();
    let lower = |j: usize| pattern.row_idx_of_col_raw(j).iter().filter(|&&i| i >= j).count();
    let filled = || entries / FILLED >= (0..n).map(lower).sum();
    if order == Order::Degrees || entries < DISSECTED_FROM || !filled() {
        return Ok(symbolic);
    }
    // Dissection has its memory.
    drop(symbolic);
    let symbolic = dissected()?;
    if (symbolic.len_val() as f64) < SAVED * entries as f64 {
        return Ok(symbolic);
    }
    drop(symbolic);
    by(SymmetricOrdering::Amd)
}

/// Structure of the factors in the order of minimum degrees.
pub(crate) fn analysed_by_degrees(
    pattern: SymbolicSparseColMatRef<'_, usize>,
    interrupt: &Interrupt<'_>,
) -> Result<SymbolicCholesky<usize>> {
    analysed(pattern, Order::Degrees, interrupt)
}

/// Number of entries of L for a matrix with the pattern of `a`, in the order that [`Cholesky`] takes.
///
/// # Errors
/// `OutOfMemory`.
pub fn entries_of_factor(a: &Csc) -> Result<usize> {
    entries(a, Order::Smaller)
}

/// Number of entries of L for a matrix with the pattern of `a`, in the order of minimum degrees.
///
/// # Errors
/// `OutOfMemory`.
pub fn entries_by_degrees(a: &Csc) -> Result<usize> {
    entries(a, Order::Degrees)
}

fn entries(a: &Csc, order: Order) -> Result<usize> {
    let pattern = SymbolicSparseColMatRef::new_checked(a.rows, a.rows, &a.col_ptr, None, &a.row_idx);
    Ok(analysed(pattern, order, &Interrupt::none())?.len_val())
}

/// Factors of one matrix.
pub struct Cholesky<T> {
    n: usize,
    pub(super) symbolic: SymbolicCholesky<usize>,
    pub(super) values: Vec<T>,
    scratch: MemBuffer,
}

impl<T: Entry> Cholesky<T> {
    /// Factors A; `None` if it is not positive definite. `allow` is called with the number of bytes needed before
    /// they are allocated.
    ///
    /// # Errors
    /// `OutOfMemory`, that of `allow`; `StoppedByCaller`.
    pub fn new(
        a: &Triangle<T>,
        allow: impl FnOnce(usize) -> Result<()>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Self>> {
        Ok(Self::or_bad_pivot(a, allow, interrupt)?.ok())
    }

    /// Factors A as `new` does; the inner error is the index of a pivot that is not positive.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn or_bad_pivot(
        a: &Triangle<T>,
        allow: impl FnOnce(usize) -> Result<()>,
        interrupt: &Interrupt<'_>,
    ) -> Result<core::result::Result<Self, usize>> {
        Self::by_order(a, Order::Smaller, allow, interrupt)
    }

    fn by_order(
        a: &Triangle<T>,
        order: Order,
        allow: impl FnOnce(usize) -> Result<()>,
        interrupt: &Interrupt<'_>,
    ) -> Result<core::result::Result<Self, usize>> {
        let n = a.n;
        if a.values.iter().any(|x| !x.complex().is_finite()) {
            return fail!(Singular, "a sparse matrix of order {n} is not finite");
        }
        interrupt.announce_factorisation()?;
        let rows = widened(&a.row_idx, CONTEXT)?;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &a.col_ptr, None, &rows);
        let symbolic = analysed(pattern, order, interrupt)?;
        let need = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, faer::Spec::default());
        allow(symbolic.len_val() * size_of::<T>() + need.unaligned_bytes_required())?;
        let mut values = try_vec(symbolic.len_val(), T::NONE, CONTEXT)?;
        if let Err(index) = numeric(&symbolic, SparseColMatRef::new(pattern, &a.values), &mut values)? {
            return Ok(Err(index));
        }
        let need = symbolic.solve_in_place_scratch::<T>(CHOLESKY_AT_ONCE, Par::Seq);
        let scratch = MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?;
        interrupt.check()?;
        Ok(Ok(Self {
            n,
            symbolic,
            values,
            scratch,
        }))
    }

    /// Factors A once more, in the memory and the order of the first time.
    ///
    /// # Errors
    /// `OutOfMemory`; `Singular` if A is not positive definite; `StoppedByCaller`.
    pub fn make_again(&mut self, a: &Triangle<T>, interrupt: &Interrupt<'_>) -> Result<()> {
        interrupt.announce_factorisation()?;
        let rows = widened(&a.row_idx, CONTEXT)?;
        let pattern = SymbolicSparseColMatRef::new_checked(self.n, self.n, &a.col_ptr, None, &rows);
        let matrix = SparseColMatRef::new(pattern, &a.values);
        if let Err(index) = numeric(&self.symbolic, matrix, &mut self.values)? {
            return fail!(Singular, "pivot {index} of a factor that is made again is not positive");
        }
        interrupt.check()
    }

    /// Solves A X = B in place for the columns of `b`.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [T], interrupt: &Interrupt<'_>) -> Result<()> {
        let factors = LltRef::new(&self.symbolic, &self.values);
        for b in b.chunks_mut(CHOLESKY_AT_ONCE * self.n) {
            let columns = b.len() / self.n;
            interrupt.check_before(OF_ONE_ENTRY * (columns * self.values.len()) as u64)?;
            let b = MatMut::from_column_major_slice_mut(b, self.n, columns);
            factors.solve_in_place_with_conj(Conj::No, b, Par::Seq, MemStack::new(&mut self.scratch));
        }
        Ok(())
    }
}

/// Writes the values of L in a given order of elimination; the inner error is the index of a pivot that is not positive.
fn numeric<T: Entry>(
    symbolic: &SymbolicCholesky<usize>,
    a: SparseColMatRef<'_, usize, T>,
    values: &mut [T],
) -> Result<core::result::Result<(), usize>> {
    let need = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, faer::Spec::default());
    let mut scratch = MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?;
    let factored = symbolic.factorize_numeric_llt(
        values,
        a,
        Side::Lower,
        LltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut scratch),
        faer::Spec::default(),
    );
    Ok(match factored {
        Err(LltError::NonPositivePivot { index }) => Err(index),
        Ok(_) => Ok(()),
    })
}

/// Factors of a definite matrix, real or complex.
pub enum Definite {
    /// Factors of a real symmetric matrix.
    Real(Cholesky<f64>),
    /// Factors of a complex Hermitian matrix.
    Complex(Cholesky<Complex64>),
}

impl Definite {
    /// Factors the Hermitian matrix K + σM, of which the lower triangle is used; `None` if it is not positive definite.
    ///
    /// # Errors
    /// As [`Cholesky::new`].
    pub fn new(k: &Csc, shifted: (f64, &Csc), interrupt: &Interrupt<'_>) -> Result<Option<Self>> {
        let allowed = |_| Ok(());
        if k.is_real() && shifted.1.is_real() {
            let a = Triangle::sum(k, shifted, interrupt)?;
            return Ok(Cholesky::new(&a, allowed, interrupt)?.map(Self::Real));
        }
        let a = Triangle::sum(k, shifted, interrupt)?;
        Ok(Cholesky::new(&a, allowed, interrupt)?.map(Self::Complex))
    }

    /// Solves A x = b in place for one complex column.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        match self {
            Self::Complex(factor) => factor.solve(b, interrupt),
            Self::Real(factor) => {
                let n = b.len();
                let mut parts = try_vec(2 * n, 0.0, CONTEXT)?;
                let (re, im) = parts.split_at_mut(n);
                for ((re, im), b) in re.iter_mut().zip(im).zip(&*b) {
                    (*re, *im) = (b.re, b.im);
                }
                factor.solve(&mut parts, interrupt)?;
                let (re, im) = parts.split_at(n);
                for ((re, im), b) in re.iter().zip(im).zip(b) {
                    *b = Complex64::new(*re, *im);
                }
                Ok(())
            }
        }
    }
}

#[cfg(test)]
#[path = "cholesky_tests.rs"]
mod tests;
