//! Factors of λ²M + λ(C + L Lᴴ) + K next to an eigenvalue, with the damping of few modes as a term of low rank.

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::low_rank_term::{LowRankTerm, Sides};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::natural_modes::quadratic_problem::Quadratic;
use num_complex::Complex64;

/// Factors of the matrix of a problem at the shift that was factored last.
pub(crate) struct ShiftedFactors<'p> {
    problem: &'p Quadratic<'p>,
    factor: Factor,
    matrix: Csc,
    term: Option<LowRankTerm>,
}

impl<'p> ShiftedFactors<'p> {
    /// Factors at the shift λ, for solutions of up to `columns` right sides at a time.
    ///
    /// # Errors
    /// `Singular`, `OutOfMemory`; `StoppedByCaller`.
    pub fn new(
        problem: &'p Quadratic<'p>,
        shift: Complex64,
        columns: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let matrix = problem.matrix(shift)?;
        let count = problem.modal.len();
        let term = (count > 0).then(|| LowRankTerm::new(matrix.rows, count)).transpose()?;
        let mut factors = Self {
            problem,
            factor: Factor::new(&matrix, columns)?,
            matrix,
            term,
        };
        factors.renew(shift, interrupt)?;
        Ok(factors)
    }

    /// Factors the matrix at another shift.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn renew(&mut self, shift: Complex64, interrupt: &Interrupt<'_>) -> Result<()> {
        self.matrix = self.problem.matrix(shift)?;
        self.factor.factor(&self.matrix, interrupt)?;
        let Some(term) = &mut self.term else { return Ok(()) };
        let mut sides = Sides {
            factor: &mut self.factor,
            matrix: &self.matrix,
            directions: self.problem.modal,
        };
        term.renew(shift, &mut sides, interrupt)
    }

    /// Solves A X = B (or Aᵀ X = B) in place.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn solve(&mut self, b: &mut [Complex64], transposed: bool, interrupt: &Interrupt<'_>) -> Result<()> {
        let Some(term) = &mut self.term else {
            return self.factor.solve(b, transposed, interrupt);
        };
        let mut sides = Sides {
            factor: &mut self.factor,
            matrix: &self.matrix,
            directions: self.problem.modal,
        };
        term.solve(&mut sides, b, transposed, interrupt)
    }
}
