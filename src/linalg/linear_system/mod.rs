//! Newton's matrix behind one trait: who solves with it keeps it, and nobody else holds n × n numbers.
//!
//! A step of arc-length continuation solves K x = b with the bordered matrix
//!
//! > K = [J·s_u, r·s_p; tᵀ],
//!
//! where J = ∂R/∂u belongs to a problem, r = ∂R/∂p is its derivative by the parameter, s_u and s_p are the units of
//! unknowns and parameter, and t is the row of one further condition. One file a backend: [`dense`] factors the whole
//! matrix, [`krylov`] iterates with products and factors the block of the strongly coupled unknowns.

pub mod dense;
pub mod krylov;

use crate::error::Result;

/// The Jacobian J of a problem at the point evaluated last.
pub trait Jacobian {
    /// Number n of unknowns.
    fn size(&self) -> usize;

    /// Fills J, column-major, and tells of each column whether it differs from that of the identity.
    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]);

    /// The same Jacobian by products, where the problem has them.
    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        None
    }
}

/// A Jacobian J by products. The unknowns are groups of equal length, packed signals, whose first numbers couple most.
pub trait MatrixFree {
    /// Length of one group.
    fn group(&self) -> usize;

    /// Fills the block of J between the first `part` numbers of each group, column-major, and tells of each of its
    /// columns whether it differs from that of the identity.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn fill_block(&mut self, part: usize, matrix: &mut [f64], active: &mut [bool]) -> Result<()>;

    /// Keeps J as it is at the point evaluated last, for [`Self::multiply`]; the problem may then be evaluated
    /// elsewhere.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn keep(&mut self) -> Result<()>;

    /// out = J d with the J that was kept last.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()>;
}

/// The rest of the bordered matrix K.
#[derive(Clone, Copy, Debug)]
pub struct Border<'a> {
    /// r = ∂R/∂p
    pub column: &'a [f64],
    /// Units of the unknowns and of the parameter.
    pub scales: (f64, f64),
    /// The row t, n + 1 numbers.
    pub row: &'a [f64],
}

/// A bordered system K x = b with its memory.
pub trait LinearSystem {
    /// Takes over the matrix of the point that the problem was evaluated at last; factors made before stay.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>) -> Result<()>;

    /// Factors the matrix that was taken over last.
    ///
    /// # Errors
    /// `Singular`.
    fn factor(&mut self) -> Result<()>;

    /// Solves in place for n + 1 numbers with the matrix that was factored last; `false` where an iteration did not
    /// converge. `jacobian` is that of the problem of [`Self::update`], which may have been evaluated elsewhere since.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of products.
    fn solve(&mut self, jacobian: &mut dyn Jacobian, b: &mut [f64]) -> Result<bool>;

    /// out = K x with the matrix that was taken over last.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of products.
    fn apply(&mut self, jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()>;

    /// Solves in place with the matrix that was taken over last by the factors of an earlier one, to a relative error
    /// of `tolerance`. `false`, with `b` as it was, where new factors are needed or are quicker.
    fn solve_by_earlier_factors(&mut self, tolerance: f64, b: &mut [f64]) -> bool {
        let _ = (tolerance, b);
        false
    }

    /// Whether the determinant of the factored matrix is positive: that of K for a dense backend, that of its block for
    /// an iteration.
    fn is_positive(&self) -> bool;
}
