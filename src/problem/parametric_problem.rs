//! The interface between a mechanical problem and the continuation: R(u, p) = 0 with one parameter p.

use crate::error::{Result, try_vec};
use crate::linalg::newton::linear_system::Jacobian;
use num_complex::Complex64;

/// Residual at one point and its derivative by the parameter. The derivative by the unknowns is the problem's
/// [`Jacobian`], which a linear system requests.
#[derive(Clone, Debug)]
pub struct Residual {
    /// R, one number per equation.
    pub values: Vec<f64>,
    /// ∂R/∂p, one number per equation.
    pub d_parameter: Vec<f64>,
    /// Size of motions with which the residual is compared.
    pub scale: f64,
    /// Size of residual that rounding alone may cause, where stiff contacts make it large; otherwise 0.
    pub rounding: f64,
}

impl Residual {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self {
            values: try_vec(n, 0.0, "the residual")?,
            d_parameter: try_vec(n, 0.0, "the residual")?,
            scale: 0.0,
            rounding: 0.0,
        })
    }
}

/// Initial guesses of the first point, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialGuess {
    /// The caller's guess, if there is one.
    Given,
    /// All contacts in the linear state that they have at small motion: stuck, or open.
    Stuck,
    /// All contacts replaced by their reference stiffness: bounded even where the stuck structure resonates without
    /// damping.
    Reference,
}

/// A homotopy to a problem at a fixed parameter.
pub struct Homotopy<'a> {
    /// The homotopy as a problem with a parameter of its own.
    pub problem: Box<dyn Problem + 'a>,
    /// Parameter at which the homotopy is easy to solve from the initial guess.
    pub start: f64,
    /// Parameter at which the homotopy equals the given problem.
    pub end: f64,
    /// Number of points without progress after which the homotopy is given up: it then follows a motion that grows
    /// without bound.
    pub patience: usize,
}

/// One of the two ends of a step along the branch.
pub struct End<'a> {
    /// Unknowns u of the end, and their norm.
    pub unknowns: &'a [f64],
    pub size: f64,
    /// Direction of the branch in (u, p).
    pub tangent: &'a [f64],
    /// Factor that turns the tangent into the derivative by the arc length.
    pub unit: f64,
}

/// A problem R(u, p) = 0 with one parameter. Its Jacobian belongs to the point last evaluated.
pub trait Problem: Jacobian {
    /// Residual and its derivative by the parameter at (u, p).
    ///
    /// # Errors
    /// Those of the linear algebra and of callbacks.
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()>;

    /// The observed complex amplitude at the point last evaluated, and its derivative along `direction` (n + 1
    /// numbers, the parameter last).
    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64);

    /// A further response at a solved point v = (u, p) and its derivative along `direction`; `None` if the problem
    /// has none. The state of the last evaluation is not changed.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    fn see(&mut self, _response: usize, _v: &[f64], _direction: &[f64]) -> Result<Option<(Complex64, Complex64)>> {
        Ok(None)
    }

    /// Fills an initial guess; `false` where the problem has none of this kind.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    fn initial_guess(&mut self, kind: InitialGuess, p: f64, u: &mut [f64]) -> Result<bool>;

    /// A homotopy that ends at this problem at fixed `p`, and is easy to solve at its start from `u`: from the stuck
    /// guess, or from zero if there is none. `None`: the problem has no homotopy.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn homotopy(&mut self, p: f64, u: &[f64]) -> Result<Option<Homotopy<'_>>>;

    /// ln σ of contacts as soft as σ times theirs with which a first point is easily found, where contacts are near-rigid.
    fn softened_by(&self) -> Option<f64> {
        None
    }

    /// Makes the contacts as soft as that in the following evaluations; 0: as they are.
    fn soften(&mut self, _ln_factor: f64) {}

    /// A homotopy over ln σ that ends at this problem at fixed `p` with its contacts as they are.
    fn stiffening(&mut self, _ln_factor: f64, _p: f64) -> Option<Homotopy<'_>> {
        None
    }

    /// Whether λ R(u) + (1 − λ)(u − a) = 0 has bounded solutions for any a, so that a homotopy can lead from u = a to
    /// a solution.
    fn is_bounded(&self) -> bool {
        false
    }

    /// Whether a solution u at p with this relative residual is so large that its forces are lost in the rounding of the residual:
    /// nothing is then known of their balance. An undamped structure at its resonance ends here if friction does not limit its
    /// motion.
    ///
    /// # Errors
    /// Those of [`Self::evaluate`].
    fn is_far(&mut self, _u: &[f64], _p: f64, _residual: f64) -> Result<bool> {
        Ok(false)
    }

    /// Whether the Jacobian jumps along the branch, wherever an event of a sampled law passes a sample.
    fn has_kinks(&self) -> bool {
        false
    }

    /// Position of a resonance within a step along the branch, as a share of its length, that the two ends alone do
    /// not show; `None` where there is none.
    fn resonance_between(&self, _a: &End<'_>, _b: &End<'_>, _length: f64) -> Option<f64> {
        None
    }
}

/// Adds a complex number (the real part alone for the mean) at position `r` of a packed vector.
pub(super) fn put(packed: &mut [f64], r: usize, mean: bool, z: Complex64) {
    packed[r] += z.re;
    if !mean {
        packed[r + 1] += z.im;
    }
}
