//! Factors of a complex matrix in sparse storage: dense factors for small or full matrices, sparse ones for large
//! matrices, with a solution of their own where they have few entries in a column.

use crate::error::{Error, Result, Status, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::cholesky;
use crate::linalg::factors::lu::Lu;
use crate::linalg::factors::slender_lu::SlenderLu;
use crate::linalg::sparse_storage::sparse::Csc;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use num_complex::Complex64;

/// Order up to which a dense factorisation is quicker, whatever the pattern, and up to which the fill decides.
/// Kind: tuned; measured on: not recorded.
const FACTOR_DENSE_UP_TO: usize = 24;
const BY_FILL_UP_TO: usize = 200;

/// Share of the entries of a factor up to that order, or of the stored ones of a larger matrix, above which it is treated as dense.
/// Kind: tuned; measured on: not recorded.
const DENSE_FILL: f64 = 0.1;

/// Entries in a column of a triangular factor, on average, up to which there are no panels worth a blocked product.
/// Kind: tuned; measured on: a rod of 1,000 with 300 sliders, this number alone.
const SLENDER: usize = 16;

/// Right-hand sides of a sparse matrix that are solved between two checks of the interrupt.
/// Kind: block.
const FACTOR_BETWEEN_CHECKS: usize = 8;

/// Operations per unknown of a solution with sparse factors, roughly.
/// Kind: block.
const OF_ONE_SOLUTION: u64 = 200;

/// Factors of one matrix at a time, all matrices of the same order.
pub struct Factor {
    kind: Kind,
}

enum Kind {
    Dense(Lu<Complex64>),
    Slender(Box<SlenderLu>),
    Sparse(Box<Sparse>),
}

struct Sparse {
    n: usize,
    columns: usize,
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    symbolic: Option<SymbolicLu<usize>>,
    factored: bool,
    numeric: NumericLu<usize, Complex64>,
    scratch: MemBuffer,
}

impl Factor {
    /// Memory for matrices like `a`, and for solving up to `columns` right-hand sides at a time.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(a: &Csc, columns: usize) -> Result<Self> {
        let n = a.rows;
        let kind = if is_dense(a)? {
            Kind::Dense(Lu::new(n, columns)?)
        } else if is_slender(a)? {
            Kind::Slender(Box::new(SlenderLu::new(n)?))
        } else {
            Kind::Sparse(Box::new(Sparse {
                n,
                columns,
                col_ptr: Vec::new(),
                row_idx: Vec::new(),
                symbolic: None,
                factored: false,
                numeric: NumericLu::new(),
                scratch: MemBuffer::try_new(faer::dyn_stack::StackReq::EMPTY)
                    .map_err(|_| Error::out_of_memory("a sparse factorisation"))?,
            }))
        };
        Ok(Self { kind })
    }

    /// Approximate number of bytes of the factors of a matrix with the pattern of `a`, which should be symmetric;
    /// pivoting may add some.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn bytes(a: &Csc) -> Result<usize> {
        let entries = if is_dense(a)? {
            a.rows * a.rows
        } else {
            2 * cholesky::entries_by_degrees(a)?
        };
        Ok(entries * size_of::<Complex64>())
    }

    /// Factors the matrix `a`.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(&mut self, a: &Csc, interrupt: &Interrupt<'_>) -> Result<()> {
        match &mut self.kind {
            Kind::Dense(lu) => {
                interrupt.check()?;
                let dense = lu.matrix();
                dense.fill(Complex64::ZERO);
                a.add_to_dense(Complex64::ONE, dense);
                interrupt.check()?;
                lu.factor(interrupt)
            }
            Kind::Slender(slender) => {
                interrupt.announce_factorisation()?;
                slender.factor(a)
            }
            Kind::Sparse(sparse) => {
                interrupt.announce_factorisation()?;
                sparse.factor(a)
            }
        }
    }

    /// Solves A X = B (or Aᵀ X = B) in place for the columns of `b`.
    ///
    /// # Errors
    /// `Singular` when the solution is not finite; `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [Complex64], transposed: bool, interrupt: &Interrupt<'_>) -> Result<()> {
        match &mut self.kind {
            Kind::Dense(lu) => lu.solve_columns(b, transposed, interrupt)?,
            Kind::Slender(slender) => {
                for b in b.chunks_exact_mut(slender.order()) {
                    interrupt.check_before(OF_ONE_SOLUTION * b.len() as u64)?;
                    slender.solve(b, transposed)?;
                }
            }
            Kind::Sparse(sparse) => {
                for b in b.chunks_mut(FACTOR_BETWEEN_CHECKS * sparse.n) {
                    interrupt.check_before(OF_ONE_SOLUTION * b.len() as u64)?;
                    sparse.solve(b, transposed)?;
                }
            }
        }
        if b.iter().any(|x| !x.is_finite()) {
            return fail!(Singular, "a linear system has no finite solution");
        }
        Ok(())
    }

    /// Solves A X = B in place for the columns of `b`, side by side where the factors have few entries in a column.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_side_by_side(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        match &mut self.kind {
            Kind::Slender(slender) => slender.solve_side_by_side(b, interrupt),
            Kind::Dense(_) | Kind::Sparse(_) => self.solve(b, false, interrupt),
        }
    }
}

impl Factor {
    /// The factors that solve many right sides side by side, if they are such.
    pub fn slender(&mut self) -> Option<&mut SlenderLu> {
        match &mut self.kind {
            Kind::Slender(slender) => Some(slender),
            Kind::Dense(_) | Kind::Sparse(_) => None,
        }
    }
}

/// Whether the factors of a matrix that is not dense have few entries in a column.
fn is_slender(a: &Csc) -> Result<bool> {
    let most = SLENDER * a.rows;
    // The factors have the entries of the matrix at least.
    Ok(a.values.len() / 2 <= most && cholesky::entries_by_degrees(a)? <= most)
}

/// Whether a matrix is treated as dense.
///
/// # Errors
/// `OutOfMemory`.
pub fn is_dense(a: &Csc) -> Result<bool> {
    let most = DENSE_FILL * (a.rows as f64).powi(2);
    if a.rows <= FACTOR_DENSE_UP_TO || a.values.len() as f64 > most {
        return Ok(true);
    }
    Ok(a.rows <= BY_FILL_UP_TO && cholesky::entries_by_degrees(a)? as f64 > most)
}

impl Sparse {
    fn factor(&mut self, a: &Csc) -> Result<()> {
        self.factored = false;
        if a.values.iter().any(|x| !x.is_finite()) {
            return fail!(Singular, "a sparse matrix of order {} is not finite", self.n);
        }
        if self.symbolic.is_none() || self.col_ptr != a.col_ptr || self.row_idx != a.row_idx {
            self.analyse(a)?;
        }
        let pattern = SymbolicSparseColMatRef::new_checked(self.n, self.n, &a.col_ptr, None, &a.row_idx);
        let Some(symbolic) = &self.symbolic else {
            return fail!(Internal, "a sparse matrix was not analysed");
        };
        symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                SparseColMatRef::new(pattern, &a.values),
                Par::Seq,
                MemStack::new(&mut self.scratch),
                faer::Spec::default(),
            )
            .map_err(|e| describe(&e, self.n))?;
        self.factored = true;
        Ok(())
    }

    /// Finds the order of elimination and the structure of the factors, which matrices of one pattern share.
    fn analyse(&mut self, a: &Csc) -> Result<()> {
        const CONTEXT: &str = "a sparse factorisation";
        self.col_ptr = try_vec(a.col_ptr.len(), 0, CONTEXT)?;
        self.col_ptr.copy_from_slice(&a.col_ptr);
        self.row_idx = try_vec(a.row_idx.len(), 0, CONTEXT)?;
        self.row_idx.copy_from_slice(&a.row_idx);
        let pattern = SymbolicSparseColMatRef::new_checked(self.n, self.n, &self.col_ptr, None, &self.row_idx);
        let symbolic =
            factorize_symbolic_lu(pattern, LuSymbolicParams::default()).map_err(|_| Error::out_of_memory(CONTEXT))?;
        let need = symbolic
            .factorize_numeric_lu_scratch::<Complex64>(Par::Seq, faer::Spec::default())
            .or(symbolic.solve_in_place_scratch::<Complex64>(self.columns, Par::Seq))
            .or(symbolic.solve_transpose_in_place_scratch::<Complex64>(self.columns, Par::Seq));
        self.scratch = MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn solve(&mut self, b: &mut [Complex64], transposed: bool) -> Result<()> {
        let (Some(symbolic), true) = (&self.symbolic, self.factored) else {
            return fail!(Internal, "a sparse matrix was not factored");
        };
        let columns = b.len() / self.n;
        let b = MatMut::from_column_major_slice_mut(b, self.n, columns);
        let factors = LuRef::new_unchecked(symbolic, &self.numeric);
        let scratch = MemStack::new(&mut self.scratch);
        if transposed {
            factors.solve_transpose_in_place_with_conj(Conj::No, b, Par::Seq, scratch);
        } else {
            factors.solve_in_place_with_conj(Conj::No, b, Par::Seq, scratch);
        }
        Ok(())
    }
}

fn describe(e: &LuError, n: usize) -> Error {
    match e {
        LuError::SymbolicSingular { index } => Error::new(
            Status::Singular,
            format_args!("a linear system of {n} unknowns is singular: row {index} is empty"),
        ),
        LuError::Generic(_) => Error::out_of_memory("a sparse factorisation"),
    }
}
