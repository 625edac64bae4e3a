//! Newton homotopy, the last method for a first point: λ R(u) + (1 − λ)(u − a) = 0 at a fixed parameter of R, from u
//! = a at λ = 0 to R(u) = 0 at λ = 1.
//!
//! At λ = 0 there is one solution, and it is regular; for almost every anchor a the path from it ends at
//! λ = 1 unless it runs to infinity (Chow, Mallet-Paret & Yorke, Math. Comput. 32 (1978) 887–899,
//! doi:10.2307/2006342). A forced response whose residual is in units of the motion, R = y − y_lin + G(f − κy),
//! cannot: with Z = 1/G and μ = (1 − λ)/λ the path solves
//!
//! > (1 + μ) Z y − κ y + f(y) = Z(y_lin + μ a),
//!
//! where damping is that of the structure, (1 + μ) Im(Z − κ) + μ Im κ ≥ Im(Z − κ), and contacts do no work on the
//! motion over a period; so that the power of the right side bounds the motion. Arc-length continuation follows the
//! turning points of the path like those of any branch.

use crate::error::{Result, try_copy};
use crate::linalg::newton::linear_system::Jacobian;
use crate::problem::{Homotopy, InitialGuess, Problem, Residual};
use num_complex::Complex64;

/// A problem at a fixed parameter in a homotopy from an anchor; its parameter is λ.
pub struct NewtonHomotopy<'a> {
    problem: &'a mut dyn Problem,
    parameter: f64,
    anchor: Vec<f64>,
    /// Parameter λ of the point last evaluated.
    share: f64,
}

impl<'a> NewtonHomotopy<'a> {
    /// The homotopy from `anchor` to the solution of `problem` at `parameter`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(problem: &'a mut dyn Problem, parameter: f64, anchor: &[f64]) -> Result<Self> {
        Ok(Self {
            problem,
            parameter,
            anchor: try_copy(anchor, "the first point")?,
            share: 0.0,
        })
    }
}

impl Jacobian for NewtonHomotopy<'_> {
    fn size(&self) -> usize {
        self.problem.size()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.problem.fill(matrix, active)?;
        let n = active.len();
        // A column of the identity remains one.
        for (i, column) in matrix.chunks_exact_mut(n.max(1)).enumerate() {
            if active[i] {
                for j in &mut *column {
                    *j *= self.share;
                }
                column[i] += 1.0 - self.share;
            }
        }
        Ok(())
    }
}

impl Problem for NewtonHomotopy<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.problem.evaluate(u, self.parameter, out)?;
        self.share = p;
        let slopes = out.values.iter_mut().zip(&mut out.d_parameter);
        for ((r, d), (u, a)) in slopes.zip(u.iter().zip(&self.anchor)) {
            let free = u - a;
            *d = *r - free;
            *r = p * *r + (1.0 - p) * free;
        }
        Ok(())
    }

    /// Observes zero: only the end of the path matters.
    fn observe(&self, _u: &[f64], _direction: &[f64]) -> (Complex64, Complex64) {
        (Complex64::ZERO, Complex64::ZERO)
    }

    fn initial_guess(&mut self, _kind: InitialGuess, _p: f64, _u: &mut [f64]) -> Result<bool> {
        Ok(false)
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}
