//! Homotopies that wrap a mechanical problem at a fixed parameter, and are problems themselves.
//!
//! Scaled laws: every law is replaced by s·f(y/s), with ln s as the parameter. A large s selects the laws at small
//! motion, where contacts stick; s = 1 selects the laws themselves. Growing load: a factor on the forces that
//! vibrate, from the static solution under constant loads, for preloaded contacts. Share of the laws: from springs of
//! their tangent stiffness at the static state to the laws, for contacts that are linear at no amplitude.

use crate::error::Result;
use crate::linalg::newton::linear_system::{Jacobian, MatrixFree};
use crate::problem::parametric_problem::{Homotopy, InitialGuess, Problem, Residual};
use num_complex::Complex64;

/// Points without progress towards the laws after which a mode about a static state is given up: a body that friction
/// alone holds, and whose mean friction has no balance, moves ever further there.
/// Kind: tuned; measured on: not recorded.
const HOMOTOPY_PATIENCE: usize = 60;

/// The meaning of the parameter of a homotopy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Parameter ln s, where s is the factor by which the motion in the laws is reduced.
    ScaledLaws,
    /// Factor on the forces that vibrate; constant ones act in full.
    GrowingLoad,
    /// Parameter ln σ, where σ is the factor on the motion in the laws, hence on their stiffness: loads and limits stay.
    Stiffening,
    /// Share α of the laws in α f + (1 − α) T y, with their tangents T at the static state; for nonlinear modes only.
    FromTangents,
}

/// A problem that can be evaluated along a path at a fixed parameter of its own.
pub trait AlongPath: Jacobian {
    /// Residual at (u, p), where p is the parameter of the path, and its derivative by p.
    ///
    /// # Errors
    /// Those of [`Problem::evaluate`].
    fn evaluate_along(&mut self, path: Path, fixed: f64, u: &[f64], p: f64, out: &mut Residual) -> Result<()>;

    /// The observed amplitude and its derivative along the path, see [`Problem::observe`].
    fn observe_along(&self, path: Path, u: &[f64], direction: &[f64]) -> (Complex64, Complex64);
}

/// A problem at a fixed parameter as the end of a path from an easier one.
pub struct PathHomotopy<'p> {
    problem: &'p mut (dyn AlongPath + 'p),
    path: Path,
    fixed: f64,
}

impl<'p> PathHomotopy<'p> {
    /// A homotopy along `path` between two parameters, which ends at `problem` with its own parameter `fixed`.
    #[must_use]
    pub fn between(
        (start, end): (f64, f64),
        problem: &'p mut (dyn AlongPath + 'p),
        path: Path,
        fixed: f64,
    ) -> Homotopy<'p> {
        Homotopy {
            problem: Box::new(Self { problem, path, fixed }),
            start,
            end,
            patience: if path == Path::FromTangents {
                HOMOTOPY_PATIENCE
            } else {
                usize::MAX
            },
        }
    }
}

impl Jacobian for PathHomotopy<'_> {
    fn size(&self) -> usize {
        self.problem.size()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.problem.fill(matrix, active)
    }

    fn has_continuum(&self) -> bool {
        self.problem.has_continuum()
    }

    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        self.problem.matrix_free()
    }
}

impl Problem for PathHomotopy<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.problem.evaluate_along(self.path, self.fixed, u, p, out)
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        self.problem.observe_along(self.path, u, direction)
    }

    fn initial_guess(&mut self, _kind: InitialGuess, _p: f64, _u: &mut [f64]) -> Result<bool> {
        Ok(false)
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}
