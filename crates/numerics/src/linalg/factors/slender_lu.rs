//! LU factors of a matrix whose factors have few entries in a column, as those of chains, frames and beams: with so few, the time of a
//! solution is that of passing its numbers on, and many right sides are solved side by side in the lanes of vector instructions.
//!
//! P A Q = L U with the ordering Q of the columns by COLAMD, and rows P by partial pivoting, so that x = Q U⁻¹ L⁻¹ P b.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Error, Result, Status, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::lu::simplicial::{
    SimplicialLu, factorize_simplicial_numeric_lu, factorize_simplicial_numeric_lu_scratch,
};
use faer::sparse::linalg::lu::{LuSymbolicParams, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Right sides that are solved side by side.
/// Kind: block.
const SIDES: usize = 16;

/// Operations with an entry of the factors for each right side.
/// Kind: block.
const OPERATIONS_OF_AN_ENTRY: u64 = 8;

const CONTEXT: &str = "a sparse factorisation";

/// An unknown of all right sides that are solved side by side: real parts, then imaginary ones.
type Lanes = [[f64; SIDES]; 2];

/// A vector by its entries.
pub type Entries<'a> = &'a [(usize, Complex64)];

/// Factors of one matrix at a time, all of the same order.
pub struct SlenderLu {
    arch: Arch,
    n: usize,
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    symbolic: Option<SymbolicLu<usize>>,
    factors: SimplicialLu<usize, Complex64>,
    is_factored: bool,
    /// Row of the matrix at each position, and position of each row.
    rows: Vec<usize>,
    positions: Vec<usize>,
    scratch: MemBuffer,
    solved: Vec<Complex64>,
    lanes: Vec<Lanes>,
}

impl SlenderLu {
    /// Memory for matrices of order `n`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self {
            arch: Arch::new(),
            n,
            col_ptr: Vec::new(),
            row_idx: Vec::new(),
            symbolic: None,
            factors: SimplicialLu::new(),
            is_factored: false,
            rows: try_vec(n, 0, CONTEXT)?,
            positions: try_vec(n, 0, CONTEXT)?,
            scratch: MemBuffer::try_new(StackReq::EMPTY).map_err(|_| Error::out_of_memory(CONTEXT))?,
            solved: try_vec(n, Complex64::ZERO, CONTEXT)?,
            lanes: Vec::new(),
        })
    }

    /// Order of the matrices.
    #[must_use]
    pub fn order(&self) -> usize {
        self.n
    }

    /// Factors `a`.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`.
    pub fn factor(&mut self, a: &Csc) -> Result<()> {
        self.is_factored = false;
        if a.values.iter().any(|x| !x.is_finite()) {
            return fail!(Singular, "a sparse matrix of order {} is not finite", self.n);
        }
        if self.symbolic.is_none() || self.col_ptr != a.col_ptr || self.row_idx != a.row_idx {
            self.analyse(a)?;
        }
        let Some(symbolic) = &self.symbolic else {
            return fail!(Internal, "a sparse matrix was not analysed");
        };
        let pattern = SymbolicSparseColMatRef::new_checked(self.n, self.n, &a.col_ptr, None, &a.row_idx);
        let factored = factorize_simplicial_numeric_lu(
            &mut self.rows,
            &mut self.positions,
            &mut self.factors,
            SparseColMatRef::new(pattern, &a.values),
            symbolic.col_perm(),
            MemStack::new(&mut self.scratch),
        );
        factored.map_err(|e| described(&e, self.n))?;
        self.is_factored = true;
        Ok(())
    }

    /// Ordering of the columns, which matrices of one pattern share.
    fn analyse(&mut self, a: &Csc) -> Result<()> {
        self.symbolic = None;
        self.col_ptr = try_vec(a.col_ptr.len(), 0, CONTEXT)?;
        self.col_ptr.copy_from_slice(&a.col_ptr);
        self.row_idx = try_vec(a.row_idx.len(), 0, CONTEXT)?;
        self.row_idx.copy_from_slice(&a.row_idx);
        let pattern = SymbolicSparseColMatRef::new_checked(self.n, self.n, &self.col_ptr, None, &self.row_idx);
        let ordering_alone = LuSymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..LuSymbolicParams::default()
        };
        let symbolic = factorize_symbolic_lu(pattern, ordering_alone).map_err(|_| Error::out_of_memory(CONTEXT))?;
        let need = factorize_simplicial_numeric_lu_scratch::<usize, Complex64>(self.n, self.n);
        self.scratch = MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn order_of_columns(&self) -> Result<&[usize]> {
        match &self.symbolic {
            Some(symbolic) if self.is_factored => Ok(symbolic.col_perm().arrays().0),
            _ => fail!(Internal, "a sparse matrix was not factored"),
        }
    }

    /// Solves A x = b (or Aᵀ x = b) in place.
    ///
    /// # Errors
    /// `Internal` without factors.
    pub fn solve(&mut self, b: &mut [Complex64], transposed: bool) -> Result<()> {
        let mut x = core::mem::take(&mut self.solved);
        let solved = self.solve_with(b, transposed, &mut x);
        self.solved = x;
        solved
    }

    fn solve_with(&self, b: &mut [Complex64], transposed: bool, x: &mut [Complex64]) -> Result<()> {
        let columns = self.order_of_columns()?;
        let (lower, upper) = (self.factors.l_factor_unsorted(), self.factors.u_factor_unsorted());
        let column = |of: SparseColMatRef<'_, usize, Complex64>, j: usize| {
            let range = of.col_ptr()[j]..of.col_ptr()[j + 1];
            (range.start, range.end)
        };
        let (l_rows, l_values) = (lower.row_idx(), lower.val());
        let (u_rows, u_values) = (upper.row_idx(), upper.val());
        let (from, to) = if transposed {
            (columns, &self.rows[..])
        } else {
            (&self.rows[..], columns)
        };
        for (x, &at) in x.iter_mut().zip(from) {
            *x = b[at];
        }
        // The first entry of a column of L is 1, the last one of a column of U that of the diagonal.
        if transposed {
            for j in 0..self.n {
                let (begin, end) = column(upper, j);
                let mut sum = x[j];
                for (&i, u) in u_rows[begin..end - 1].iter().zip(&u_values[begin..end - 1]) {
                    sum -= u * x[i];
                }
                x[j] = sum / u_values[end - 1];
            }
            for j in (0..self.n).rev() {
                let (begin, end) = column(lower, j);
                let mut sum = x[j];
                for (&i, l) in l_rows[begin + 1..end].iter().zip(&l_values[begin + 1..end]) {
                    sum -= l * x[i];
                }
                x[j] = sum;
            }
        } else {
            for j in 0..self.n {
                let (begin, end) = column(lower, j);
                let own = x[j];
                for (&i, l) in l_rows[begin + 1..end].iter().zip(&l_values[begin + 1..end]) {
                    x[i] -= l * own;
                }
            }
            for j in (0..self.n).rev() {
                let (begin, end) = column(upper, j);
                let own = x[j] / u_values[end - 1];
                x[j] = own;
                for (&i, u) in u_rows[begin..end - 1].iter().zip(&u_values[begin..end - 1]) {
                    x[i] -= u * own;
                }
            }
        }
        for (x, &at) in x.iter().zip(to) {
            b[at] = *x;
        }
        Ok(())
    }

    /// Solves A X = B in place for the columns of `b`, side by side.
    ///
    /// # Errors
    /// `Singular` where a solution is not finite; `OutOfMemory`; `StoppedByCaller`.
    pub fn solve_side_by_side(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        if self.lanes.is_empty() {
            self.lanes = try_vec(self.n, [[0.0; SIDES]; 2], CONTEXT)?;
        }
        let mut lanes = core::mem::take(&mut self.lanes);
        let solved = self.solve_in_lanes(&mut lanes, b, interrupt);
        self.lanes = lanes;
        solved
    }

    fn solve_in_lanes(&self, lanes: &mut [Lanes], b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let columns = self.order_of_columns()?;
        let (lower, upper) = (self.factors.l_factor_unsorted(), self.factors.u_factor_unsorted());
        let entries = lower.col_ptr()[self.n] + upper.col_ptr()[self.n];
        for b in b.chunks_mut(SIDES * self.n.max(1)) {
            interrupt.check_before(OPERATIONS_OF_AN_ENTRY * (entries * SIDES) as u64)?;
            lanes.fill([[0.0; SIDES]; 2]);
            for (lane, b) in b.chunks_exact(self.n).enumerate() {
                for ([re, im], &at) in lanes.iter_mut().zip(&self.rows) {
                    (re[lane], im[lane]) = (b[at].re, b[at].im);
                }
            }
            self.arch.dispatch(SideBySide { lower, upper, lanes });
            for (lane, b) in b.chunks_exact_mut(self.n).enumerate() {
                for ([re, im], &at) in lanes.iter().zip(columns) {
                    b[at] = Complex64::new(re[lane], im[lane]);
                }
            }
            if b.iter().any(|x| !x.is_finite()) {
                return fail!(Singular, "a linear system has no finite solution");
            }
        }
        Ok(())
    }

    /// The flexibility R A⁻¹ Rᴴ between `count` ports R, column after column into `table`, whose columns begin `stride` apart, and
    /// into `moved.1` the products qᵀ A⁻¹ Rᴴ with a vector q = `moved.0`, unless that is empty. Returns the largest real or imaginary
    /// part of A⁻¹ Rᴴ.
    ///
    /// # Errors
    /// `Singular` where a solution is not finite; `OutOfMemory`; `StoppedByCaller`.
    pub fn flexibility<'p>(
        &mut self,
        count: usize,
        port: impl Fn(usize) -> Entries<'p>,
        (table, stride): (&mut [Complex64], usize),
        moved: (&[Complex64], &mut [Complex64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        if self.lanes.is_empty() {
            self.lanes = try_vec(self.n, [[0.0; SIDES]; 2], CONTEXT)?;
        }
        let mut lanes = core::mem::take(&mut self.lanes);
        let found = self.flexibility_with(&mut lanes, count, port, (table, stride), moved, interrupt);
        self.lanes = lanes;
        found
    }

    fn flexibility_with<'p>(
        &self,
        lanes: &mut [Lanes],
        count: usize,
        port: impl Fn(usize) -> Entries<'p>,
        (table, stride): (&mut [Complex64], usize),
        (weights, products): (&[Complex64], &mut [Complex64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        let columns = self.order_of_columns()?;
        let Some(symbolic) = &self.symbolic else {
            return fail!(Internal, "a sparse matrix was not factored");
        };
        let places = symbolic.col_perm().arrays().1;
        let stored = |of: SparseColMatRef<'_, usize, Complex64>| of.col_ptr()[self.n];
        let entries = stored(self.factors.l_factor_unsorted()) + stored(self.factors.u_factor_unsorted());
        let tables = table.chunks_mut(SIDES * stride.max(1));
        let mut largest = 0.0_f64;
        for (first, table) in (0..count).step_by(SIDES).zip(tables) {
            let sides = SIDES.min(count - first);
            interrupt.check_before(OPERATIONS_OF_AN_ENTRY * (entries * sides) as u64)?;
            lanes.fill([[0.0; SIDES]; 2]);
            for lane in 0..sides {
                for &(p, a) in port(first + lane) {
                    let [re, im] = &mut lanes[self.positions[p]];
                    re[lane] += a.re;
                    im[lane] -= a.im;
                }
            }
            self.arch.dispatch(SideBySide {
                lower: self.factors.l_factor_unsorted(),
                upper: self.factors.u_factor_unsorted(),
                lanes,
            });
            largest = largest.max(self.arch.dispatch(Largest(lanes)));
            for row in 0..count {
                let terms = port(row).iter().map(|&(p, a)| (a, &lanes[places[p]]));
                let sum = self.arch.dispatch(Weighted(terms));
                for (lane, column) in table.chunks_mut(stride.max(1)).enumerate() {
                    column[row] = Complex64::new(sum[0][lane], sum[1][lane]);
                }
            }
            if !weights.is_empty() {
                let terms = columns.iter().zip(&*lanes).map(|(&p, x)| (weights[p], x));
                let sum = self.arch.dispatch(Weighted(terms));
                for (lane, product) in products[first..].iter_mut().take(sides).enumerate() {
                    *product = Complex64::new(sum[0][lane], sum[1][lane]);
                }
            }
            let is_finite = table.iter().fold(true, |all, z| all & z.is_finite());
            if !is_finite {
                return fail!(Singular, "a linear system has no finite solution");
            }
        }
        Ok(largest)
    }
}

/// Σ a x over pairs of a factor and an unknown of all sides.
struct Weighted<I>(I);

impl<'l, I: Iterator<Item = (Complex64, &'l Lanes)>> WithSimd for Weighted<I> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Lanes {
        let mut sum = [[0.0; SIDES]; 2];
        for (a, x) in self.0 {
            for lane in 0..SIDES {
                sum[0][lane] += a.re * x[0][lane] - a.im * x[1][lane];
                sum[1][lane] += a.re * x[1][lane] + a.im * x[0][lane];
            }
        }
        sum
    }
}

/// The largest modulus of a number in the lanes.
struct Largest<'a>(&'a [Lanes]);

impl WithSimd for Largest<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> f64 {
        let mut largest = [0.0_f64; SIDES];
        for part in self.0.iter().flatten() {
            for (largest, x) in largest.iter_mut().zip(part) {
                *largest = largest.max(x.abs());
            }
        }
        largest.into_iter().fold(0.0, f64::max)
    }
}

/// L U x = b for all right sides in the lanes, in place.
struct SideBySide<'a> {
    lower: SparseColMatRef<'a, usize, Complex64>,
    upper: SparseColMatRef<'a, usize, Complex64>,
    lanes: &'a mut [Lanes],
}

impl WithSimd for SideBySide<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { lower, upper, lanes } = self;
        let ends = lower.col_ptr().windows(2);
        for (j, ends) in ends.enumerate() {
            // The first entry is 1.
            let inner = ends[0] + 1..ends[1];
            let own = lanes[j];
            subtract(lanes, &lower.row_idx()[inner.clone()], &lower.val()[inner], &own);
        }
        let ends = upper.col_ptr().windows(2);
        for (j, ends) in ends.enumerate().rev() {
            // The last entry is that of the diagonal.
            let inner = ends[0]..ends[1] - 1;
            let by = upper.val()[ends[1] - 1].inv();
            let mut own = lanes[j];
            let [re, im] = &mut own;
            for (re, im) in re.iter_mut().zip(im) {
                (*re, *im) = (by.re * *re - by.im * *im, by.re * *im + by.im * *re);
            }
            lanes[j] = own;
            subtract(lanes, &upper.row_idx()[inner.clone()], &upper.val()[inner], &own);
        }
    }
}

/// Takes the products of a column with its unknown off the others.
#[inline(always)]
fn subtract(lanes: &mut [Lanes], rows: &[usize], values: &[Complex64], own: &Lanes) {
    for (&i, a) in rows.iter().zip(values) {
        let [re, im] = &mut lanes[i];
        for lane in 0..SIDES {
            re[lane] -= a.re * own[0][lane] - a.im * own[1][lane];
            im[lane] -= a.re * own[1][lane] + a.im * own[0][lane];
        }
    }
}

fn described(e: &LuError, n: usize) -> Error {
    match e {
        LuError::SymbolicSingular { index } => Error::new(
            Status::Singular,
            format_args!("a linear system of {n} unknowns is singular: row {index} is empty"),
        ),
        LuError::Generic(_) => Error::out_of_memory(CONTEXT),
    }
}

#[cfg(test)]
#[path = "slender_lu_tests.rs"]
mod tests;
