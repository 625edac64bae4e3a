//! The homotopy that a start falls back on: λ R(u) + (1 − λ)(u − a) = 0 at a fixed parameter of R, from
//! u = a at λ = 0 to R(u) = 0 at λ = 1.
//!
//! At λ = 0 there is one solution, and it is regular; for almost every anchor a the path from it ends at
//! λ = 1 unless it runs to infinity (Chow, Mallet-Paret & Yorke, Math. Comput. 32 (1978) 887–899,
//! doi:10.2307/2006342). A forced response whose residual is in units of the motion, R = y − y_lin + G(f − κy),
//! cannot: with Z = 1/G and μ = (1 − λ)/λ the path solves
//!
//! > (1 + μ) Z y − κ y + f(y) = Z(y_lin + μ a),
//!
//! where damping is that of the structure, (1 + μ) Im(Z − κ) + μ Im κ ≥ Im(Z − κ), and contacts do no work on
//! the motion over a period; so that the power of the right side bounds the motion. Turns of the path are met by
//! arc-length continuation like those of any branch.

use crate::error::{Result, try_copy};
use crate::problem::{InitialGuess, Linearisation, Problem};
use num_complex::Complex64;

/// A problem at a fixed parameter, tied to an anchor; its parameter is λ.
pub struct NewtonHomotopy<'a> {
    problem: &'a mut dyn Problem,
    parameter: f64,
    anchor: Vec<f64>,
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
            anchor: try_copy(anchor, "the start")?,
        })
    }
}

impl Problem for NewtonHomotopy<'_> {
    fn size(&self) -> usize {
        self.problem.size()
    }

    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Linearisation) -> Result<()> {
        self.problem.evaluate(u, self.parameter, out)?;
        let n = u.len();
        let slopes = out.residual.iter_mut().zip(&mut out.d_parameter);
        for ((r, d), (u, a)) in slopes.zip(u.iter().zip(&self.anchor)) {
            let free = u - a;
            *d = *r - free;
            *r = p * *r + (1.0 - p) * free;
        }
        // A column of the identity stays one.
        for (i, column) in out.jacobian.chunks_exact_mut(n.max(1)).enumerate() {
            if out.active[i] {
                for j in &mut *column {
                    *j *= p;
                }
                column[i] += 1.0 - p;
            }
        }
        Ok(())
    }

    /// Nothing: the way matters only for its end.
    fn observe(&self, _u: &[f64], _direction: &[f64]) -> (Complex64, Complex64) {
        (Complex64::ZERO, Complex64::ZERO)
    }

    fn start(&mut self, _kind: InitialGuess, _p: f64, _u: &mut [f64]) -> Result<bool> {
        Ok(false)
    }

    fn begin_homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<(f64, f64)>> {
        Ok(None)
    }

    fn end_homotopy(&mut self) {}
}
