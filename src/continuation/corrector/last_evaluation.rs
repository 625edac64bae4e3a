//! The end of a correction with the factors of the iteration before it.
//!
//! Where the residual after a Newton step is within the tolerance, the matrix K there hardly differs from the factored K₀ of
//! the iteration before. Its products are enough: the last step takes K₀, whose error is that of the matrix times a residual
//! within the tolerance, and the tangent is found by x ← x + K₀⁻¹(b − K x). Fast convergence shows that det K has the sign of
//! det K₀, as in [`crate::linalg::newton::bordered`].

use crate::continuation::Metric;
use crate::continuation::corrector::{Corrector, Factors, NEAR, TANGENT_ERROR};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::LinearSystem;
use crate::linalg::norm;
use crate::problem::Problem;

/// Largest change of a tangent by the first round, over its size: of a larger one the matrices differ too much.
/// Kind: tuned; measured on: not recorded.
const LARGEST_CHANGE: f64 = 1e-3;

/// Largest Newton step to the point, over the motion: after a longer one the matrices may differ too much.
/// Kind: tuned; measured on: not recorded.
const LAST_EVALUATION_SMALL: f64 = 1e-5;

/// Rounds that take less time than new factors.
/// Kind: tuned; measured on: not recorded.
const LAST_EVALUATION_MOST_ROUNDS: usize = 3;

impl Corrector {
    /// Solves for the last Newton step, in `step`, and the tangent, in `next`, with the factors of the iteration
    /// before, whose step had this length over the motion. `false` where new factors are needed.
    pub(super) fn ends_by_earlier_factors(
        &mut self,
        problem: &mut dyn Problem,
        v: &[f64],
        last_step: f64,
        (metric, row): (Metric, &[f64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = v.len() - 1;
        if last_step.is_nan() || last_step > LAST_EVALUATION_SMALL {
            return Ok(false);
        }
        // Near-rigid contacts leave residuals that are rounding, to which a matrix that is not exact would add.
        if self.factors != Factors::Own || !self.system.is_direct() || self.at.rounding > 0.0 {
            return Ok(false);
        }
        self.negate_residual();
        if !self
            .system
            .solve(problem, TANGENT_ERROR, &mut self.memory.step, interrupt)?
        {
            return Ok(false);
        }
        let is_near = norm(&self.memory.step[..n]) * metric.u <= NEAR * norm(&v[..n]);
        Ok(is_near && self.refine_tangent(problem, metric, row, interrupt)?)
    }

    /// Computes the tangent of the current matrix in `next` by iteration with the factors of an earlier one; `false`
    /// where that does not converge.
    fn refine_tangent(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        row: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = self.memory.next.len() - 1;
        self.memory.next.fill(0.0);
        self.memory.next[n] = 1.0;
        if !self
            .system
            .solve(problem, TANGENT_ERROR, &mut self.memory.next, interrupt)?
        {
            return Ok(false);
        }
        let size = norm(&self.memory.next);
        let mut last = size;
        for round in 0..LAST_EVALUATION_MOST_ROUNDS {
            let (unknowns, along) = (&mut self.memory.trial[..n], metric.p * self.memory.next[n]);
            for (scaled, x) in unknowns.iter_mut().zip(&self.memory.next) {
                *scaled = metric.u * x;
            }
            if !problem.multiply_here(unknowns, &mut self.memory.change[..n])? {
                return Ok(false);
            }
            for (change, r) in self.memory.change.iter_mut().zip(&self.at.d_parameter) {
                *change = -(*change + r * along);
            }
            let on_row: f64 = row.iter().zip(&self.memory.next).map(|(t, x)| t * x).sum();
            self.memory.change[n] = 1.0 - on_row;
            if !self
                .system
                .solve(problem, TANGENT_ERROR, &mut self.memory.change, interrupt)?
            {
                return Ok(false);
            }
            let change = norm(&self.memory.change);
            let largest = if round == 0 { LARGEST_CHANGE * size } else { 0.2 * last };
            // A comparison with NaN is false.
            let shrinks = change <= largest || change <= TANGENT_ERROR * size;
            if !shrinks {
                return Ok(false);
            }
            for (x, change) in self.memory.next.iter_mut().zip(&self.memory.change) {
                *x += change;
            }
            // The remaining error is the change times the shrinkage once more.
            if change * (change / last) <= TANGENT_ERROR * size {
                return Ok(true);
            }
            last = change;
        }
        Ok(false)
    }
}

#[cfg(test)]
#[path = "last_evaluation_tests.rs"]
mod tests;
