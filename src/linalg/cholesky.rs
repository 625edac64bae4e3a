//! L Lᴴ factors of a large sparse Hermitian positive definite matrix: a tenth of the memory of its LU factors, and their
//! size is known before they are computed.

use crate::error::{Error, Result, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::nested_dissection;
use crate::linalg::row_index::widened;
use crate::linalg::sparse::Csc;
use crate::linalg::triangle::{Entry, Triangle};
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
const AT_ONCE: usize = 8;

/// Operations per entry of the factors and right-hand side.
const OF_ONE_ENTRY: u64 = 4;

/// Entries of L by minimum degrees from which nested dissection is tried, too: below, either is a small part of the memory of
/// a call.
const DISSECTED_FROM: usize = 10_000_000;

/// Entries of L over those of the lower triangle from which it is tried: below, the factor costs less than the search.
const FILLED: usize = 4;

/// Share of the entries by minimum degrees below which it is taken: a wide factor that saves little costs more operations.
const SAVED: f64 = 0.9;

/// An order of elimination, and the shape of its factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// By approximate minimum degrees.
    Degrees,
    /// By nested dissection.
    Dissection,
    /// By dissection where L has many entries and clearly fewer by it, by degrees elsewhere.
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
        let rows = nested_dissection::order(pattern.col_ptr(), pattern.row_idx(), interrupt)?;
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

/// Number of entries of L for a matrix with the pattern of `a`, in the order that [`Cholesky`] takes.
///
/// # Errors
/// `OutOfMemory`.
pub fn entries_of_factor(a: &Csc) -> Result<usize> {
    entries(a, Order::Smaller)
}

/// The same by minimum degrees.
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
    symbolic: SymbolicCholesky<usize>,
    values: Vec<T>,
    scratch: MemBuffer,
}

impl<T: Entry> Cholesky<T> {
    /// Factors A; `None` if it is not positive definite. `allow` is asked with the bytes that are needed before they
    /// are allocated.
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

    /// The same; the inner error is the number of a pivot that is not positive.
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
        let no_memory = || Error::out_of_memory(CONTEXT);
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
        let mut scratch = MemBuffer::try_new(need).map_err(|_| no_memory())?;
        let factored = symbolic.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &a.values),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut scratch),
            faer::Spec::default(),
        );
        drop(scratch);
        if let Err(LltError::NonPositivePivot { index }) = factored {
            return Ok(Err(index));
        }
        let need = symbolic.solve_in_place_scratch::<T>(AT_ONCE, Par::Seq);
        let scratch = MemBuffer::try_new(need).map_err(|_| no_memory())?;
        interrupt.check()?;
        Ok(Ok(Self {
            n,
            symbolic,
            values,
            scratch,
        }))
    }

    /// Solves A X = B in place for the columns of `b`.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [T], interrupt: &Interrupt<'_>) -> Result<()> {
        let factors = LltRef::new(&self.symbolic, &self.values);
        for b in b.chunks_mut(AT_ONCE * self.n) {
            let columns = b.len() / self.n;
            interrupt.check_before(OF_ONE_ENTRY * (columns * self.values.len()) as u64)?;
            let b = MatMut::from_column_major_slice_mut(b, self.n, columns);
            factors.solve_in_place_with_conj(Conj::No, b, Par::Seq, MemStack::new(&mut self.scratch));
        }
        Ok(())
    }
}

/// Factors of a definite matrix in the numbers that it has.
pub enum Definite {
    /// A real symmetric matrix.
    Real(Cholesky<f64>),
    /// A complex Hermitian one.
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
mod tests {
    use super::*;

    /// A Hermitian chain in the plane with random couplings.
    fn matrix(n: usize, complex: bool, shift: f64) -> Csc {
        let mut entries = Vec::new();
        for i in 0..n {
            entries.push((i, i, Complex64::from(4.0 + shift + (i as f64).sin())));
            for (step, size) in [(1, 0.9), (17, 0.7)] {
                if i >= step {
                    let im = if complex { (3.0 * i as f64).cos() } else { 0.0 };
                    let z = size * Complex64::new((2.0 * i as f64).cos(), im);
                    entries.extend([(i, i - step, z), (i - step, i, z.conj())]);
                }
            }
        }
        Csc::from_triplets(n, n, entries).unwrap()
    }

    #[test]
    fn solutions_leave_no_residual_and_an_indefinite_matrix_is_refused() {
        let n = 300;
        let none = Csc::from_triplets(n, n, Vec::new()).unwrap();
        for complex in [false, true] {
            let a = matrix(n, complex, 0.0);
            let x: Vec<Complex64> = (0..n).map(|k| Complex64::cis(k as f64)).collect();
            let mut b = a.times(&x, "a test").unwrap();
            let interrupt = Interrupt::none();
            let mut factor = Definite::new(&a, (0.0, &none), &interrupt).unwrap().unwrap();
            assert_eq!(matches!(factor, Definite::Complex(_)), complex);
            factor.solve(&mut b, &interrupt).unwrap();
            assert!(x.iter().zip(&b).all(|(x, b)| (x - b).norm() < 1e-12));
            let indefinite = matrix(n, complex, -4.0);
            assert!(Definite::new(&indefinite, (0.0, &none), &interrupt).unwrap().is_none());
        }
    }

    /// A box of finite elements with three rows at each node, and random couplings.
    fn box_of_elements<T: Entry>(side: usize) -> Triangle<T> {
        let place = |k: usize| [k / 3 % side, k / 3 / side % side, k / 3 / side / side];
        let n = 3 * side * side * side;
        let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            let beside = |i: &usize| (0..3).all(|d| place(*i)[d].abs_diff(place(j)[d]) <= 1);
            for i in (j..n.min(j + 3 * (side * side + side + 2))).filter(beside) {
                let z = Complex64::new((3.0 * i as f64 + j as f64).cos(), (i as f64 - 2.0 * j as f64).sin());
                row_idx.push(crate::linalg::row_index::narrow(i));
                values.push(T::of(if i == j { 100.0.into() } else { z }));
            }
            col_ptr.push(values.len());
        }
        Triangle {
            n,
            col_ptr,
            row_idx,
            values,
        }
    }

    fn solutions_by_both_orders<T: Entry>(side: usize) {
        let interrupt = Interrupt::none();
        let a = box_of_elements::<T>(side);
        let x: Vec<T> = (0..a.n).map(|k| T::of(Complex64::cis(k as f64))).collect();
        let [first, second] = [Order::Degrees, Order::Dissection].map(|order| {
            let mut b = vec![T::NONE; a.n];
            a.multiply(&x, &mut b, &interrupt).unwrap();
            let factor = Cholesky::by_order(&a, order, |_| Ok(()), &interrupt).unwrap();
            factor.unwrap().solve(&mut b, &interrupt).unwrap();
            b
        });
        for (x, (a, b)) in x.iter().zip(first.iter().zip(&second)) {
            assert!((a.complex() - b.complex()).norm() < 1e-13);
            assert!((a.complex() - x.complex()).norm() < 1e-13);
        }
    }

    #[test]
    fn both_orders_of_elimination_give_the_same_solutions() {
        for side in [1, 2, 6] {
            solutions_by_both_orders::<f64>(side);
            solutions_by_both_orders::<Complex64>(side);
        }
    }

    #[test]
    fn dissection_has_the_smaller_factor_of_a_box_and_is_taken_where_it_is_large() {
        let a = box_of_elements::<f64>(17);
        let rows = widened(&a.row_idx, "a test").unwrap();
        let pattern = SymbolicSparseColMatRef::new_checked(a.n, a.n, &a.col_ptr, None, &rows);
        let [degrees, dissection, smaller] = [Order::Degrees, Order::Dissection, Order::Smaller]
            .map(|order| analysed(pattern, order, &Interrupt::none()).unwrap().len_val());
        println!("{degrees} entries by degrees, {dissection} by dissection");
        assert!((dissection as f64) < 0.85 * degrees as f64);
        assert_eq!(smaller, if degrees < DISSECTED_FROM { degrees } else { dissection });
    }

    #[test]
    fn memory_is_counted_before_it_is_asked_for() {
        let n = 300;
        let none = Csc::from_triplets(n, n, Vec::new()).unwrap();
        let interrupt = Interrupt::none();
        let a = Triangle::<f64>::sum(&matrix(n, false, 0.0), (0.0, &none), &interrupt).unwrap();
        let mut told = 0;
        let refused = Cholesky::new(
            &a,
            |need| {
                told = need;
                fail!(OutOfMemory, "too much")
            },
            &interrupt,
        );
        assert!(refused.is_err() && told > 8 * a.values.len());
    }

    #[test]
    fn products_by_the_triangle_are_those_of_the_matrix() {
        let n = 60;
        let a = matrix(n, true, 0.0);
        let m = matrix(n, true, 2.0);
        let interrupt = Interrupt::none();
        let triangle = Triangle::<Complex64>::sum(&a, (0.5, &m), &interrupt).unwrap();
        let x: Vec<Complex64> = (0..n).map(|k| Complex64::cis(k as f64)).collect();
        let mut y = vec![Complex64::ZERO; n];
        triangle.multiply(&x, &mut y, &interrupt).unwrap();
        let mut exact = a.times(&x, "a test").unwrap();
        m.multiply_add(0.5.into(), &x, &mut exact);
        assert!(y.iter().zip(&exact).all(|(y, e)| (y - e).norm() < 1e-12));
    }
}
