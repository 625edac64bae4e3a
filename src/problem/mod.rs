//! The vocabulary between a mechanical problem and the continuation: R(u, p) = 0 with one
//! parameter p. The continuation sees this trait and nothing else of mechanics.

pub mod contact_forces;
mod contact_jacobian;
pub mod epmc;
pub mod harmonic_balance;
pub mod static_force;

use crate::error::{Result, try_vec};
use num_complex::Complex64;

/// Residual and derivatives at one point.
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// R
    pub residual: Vec<f64>,
    /// ∂R/∂u, column-major.
    pub jacobian: Vec<f64>,
    /// ∂R/∂p
    pub d_parameter: Vec<f64>,
    /// Per unknown: whether its column of the Jacobian differs from that of the identity.
    pub active: Vec<bool>,
    /// Size against which the residual is measured.
    pub scale: f64,
}

impl Linearisation {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self {
            jacobian: try_vec(n.saturating_mul(n), 0.0, "the Jacobian")?,
            ..Self::without_jacobian(n)?
        })
    }

    /// Memory for the same without ∂R/∂u.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn without_jacobian(n: usize) -> Result<Self> {
        Ok(Self {
            residual: try_vec(n, 0.0, "the residual")?,
            jacobian: Vec::new(),
            d_parameter: try_vec(n, 0.0, "the residual")?,
            active: try_vec(n, true, "the residual")?,
            scale: 0.0,
        })
    }
}

/// Start values for the first point, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialGuess {
    /// The caller's guess, where there is one.
    Given,
    /// All contacts as at small motion: stuck, or open.
    Stuck,
    /// All contacts replaced by their reference stiffness: bounded also where the stuck
    /// structure resonates without damping.
    Reference,
}

/// A problem R(u, p) = 0 with one parameter.
pub trait Problem {
    /// Number of unknowns.
    fn size(&self) -> usize;

    /// Residual and derivatives at (u, p).
    ///
    /// # Errors
    /// Those of the linear algebra and of callbacks.
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Linearisation) -> Result<()>;

    /// The observed complex amplitude at the point last evaluated, and its derivative along
    /// `direction` (n + 1 numbers, the parameter last).
    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64);

    /// Fills start values; `false` where this start does not exist.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    fn start(&mut self, kind: InitialGuess, p: f64, u: &mut [f64]) -> Result<bool>;

    /// Turns the problem at fixed `p` into a homotopy whose parameter runs between the returned
    /// values: at the first the problem is easy to solve from `u`, the stuck start or rest where
    /// there is none, at the second it is the given one. `None`: there is nothing to ease.
    /// [`Self::end_homotopy`] turns it back.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn begin_homotopy(&mut self, p: f64, u: &[f64]) -> Result<Option<(f64, f64)>>;

    /// Ends the homotopy.
    fn end_homotopy(&mut self);

    /// Whether λ R(u) + (1 − λ)(u − a) = 0 has bounded solutions for any a, so that a homotopy can lead from
    /// u = a to a solution.
    fn is_bounded(&self) -> bool {
        false
    }

    /// Asks for the most accurate evaluation there is, at the parameter values that follow, rather
    /// than the one that is quick along a branch. Derivatives by the parameter may then be zero.
    fn set_pointwise(&mut self, _pointwise: bool) {}
}

/// Adds a complex number (the real part alone for the mean) at position `r` of a packed vector.
fn put(packed: &mut [f64], r: usize, mean: bool, z: Complex64) {
    packed[r] += z.re;
    if !mean {
        packed[r + 1] += z.im;
    }
}
