//! Newton's method that leaves known solutions out (Farrell, Birkisson & Funke 2015, doi:10.1137/140984798).
//!
//! With η(u) = Π (L²/|u − uᵢ|² + 1) over the known solutions uᵢ the equations η R = 0 have the other solutions alone. By the formula
//! of Sherman and Morrison their Newton step is the one of R times τ = 1/(1 − ∇ln η·δ): no matrix changes. A step is bounded, since
//! τ has poles.

use crate::continuation::Metric;
use crate::continuation::corrector::Corrector;
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;

/// Most iterations: deflated steps wander before they converge.
/// Kind: cap.
const DEFLATED_MOST_ITERATIONS: usize = 60;

/// Largest step over the size of the unknowns, or of the known solutions where these are larger.
/// Kind: tuned; measured on: not recorded.
const DEFLATED_LARGEST_STEP: f64 = 1.0;

/// Relative residual at which the equations alone lead to the solution that is near.
/// Kind: tuned; measured on: not recorded.
const DEFLATED_NEAR: f64 = 1e-3;

/// Leads `v` = (u, p) at a fixed p to where the residual is small, away from known solutions; `false` where it does not.
///
/// # Errors
/// Those of the problem, except for singular matrices and laws that another motion may not fail; `StoppedByCaller`;
/// `OutOfMemory`.
pub(crate) fn leave_known(
    corrector: &mut Corrector,
    problem: &mut dyn Problem,
    v: &mut [f64],
    known: &[Vec<f64>],
    metric: Metric,
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let n = v.len() - 1;
    let mut row = try_vec(n + 1, 0.0, "deflation")?;
    row[n] = 1.0;
    let unit = known.iter().map(|u| norm(u)).fold(0.0, f64::max);
    for _ in 0..DEFLATED_MOST_ITERATIONS {
        interrupt.check()?;
        if !corrector.evaluates(problem, v)? || !corrector.relative_residual().is_finite() {
            return Ok(false);
        }
        if corrector.relative_residual() <= DEFLATED_NEAR {
            return Ok(true);
        }
        if !corrector.newton_step(problem, metric, &row, false, interrupt)? {
            return Ok(false);
        }
        let length = corrector.step_length(metric);
        if !(length.is_finite() && length > 0.0) {
            return Ok(false);
        }
        let mut along = 0.0;
        for u in known {
            let (mut square, mut dot) = (0.0, 0.0);
            for ((v, u), step) in v[..n].iter().zip(u).zip(&corrector.memory.step) {
                square += (v - u) * (v - u);
                dot += (v - u) * step * metric.u;
            }
            let ratio = unit * unit / square;
            along -= 2.0 * ratio * dot / (square * (ratio + 1.0));
        }
        let bound = DEFLATED_LARGEST_STEP * norm(&v[..n]).max(unit) / length;
        let factor = 1.0 / (1.0 - along);
        let factor = if factor.is_finite() {
            factor.clamp(-bound, bound)
        } else {
            bound
        };
        corrector.steps_taken += 1;
        metric.add(v, factor, &corrector.memory.step);
    }
    Ok(false)
}
