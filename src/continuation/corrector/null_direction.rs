//! The direction in which a solution is not isolated: the null vector of the Jacobian at a bifurcation, by inverse iteration.
//!
//! With the row (0, …, 0, 1) the bordered matrix [J r; 0 1] maps (φ, 0) to (J φ, 0). Near a bifurcation J has one eigenvalue
//! close to zero, and inverse iteration converges by its ratio to the next one. The directions of a symmetry remain: J maps
//! harmonics that a motion does not have to such harmonics, so that a start among them stays among them.

use crate::continuation::Metric;
use crate::continuation::corrector::{Corrector, Factors, TANGENT_ERROR};
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::{dot, norm};
use crate::problem::Problem;

/// Largest number of iterations, and the sine of the angle between the last two directions that ends them.
/// Kind: cap.
const NULL_DIRECTION_MAX_ITERATIONS: usize = 40;
/// Sine of the angle between the last two directions that ends the iterations.
/// Kind: rounding.
const CONVERGED: f64 = 1e-9;

/// Relative shift of the motion where the matrix is singular to rounding.
/// Kind: rounding.
const NULL_DIRECTION_SHIFT: f64 = 1e-9;

/// The null vector φ of the Jacobian at `v` = (u, p), from a start in u, as a direction (φ, 0) of length 1, with the size of its
/// eigenvalue; `None` where the iteration does not converge to a real vector.
///
/// # Errors
/// Those of the problem; `StoppedByCaller`; `OutOfMemory`.
pub(crate) fn null_direction(
    corrector: &mut Corrector,
    problem: &mut dyn Problem,
    v: &[f64],
    start: &[f64],
    metric: Metric,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Vec<f64>, f64)>> {
    const CONTEXT: &str = "the direction of a bifurcation";
    let n = v.len() - 1;
    let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
    row[n] = 1.0;
    let mut at = try_copy(v, CONTEXT)?;
    for shift in [0.0, NULL_DIRECTION_SHIFT] {
        for (x, start) in at[..n].iter_mut().zip(start) {
            *x += shift * metric.u * start;
        }
        if !corrector.evaluates(problem, &at)? {
            return Ok(None);
        }
        corrector.factors = Factors::None;
        corrector.update(problem, metric, &row, interrupt)?;
        if corrector.factor(problem, interrupt)? {
            return inverse_iteration(corrector, problem, start, &row, metric, interrupt);
        }
    }
    Ok(None)
}

fn inverse_iteration(
    corrector: &mut Corrector,
    problem: &mut dyn Problem,
    start: &[f64],
    row: &[f64],
    metric: Metric,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Vec<f64>, f64)>> {
    let n = start.len();
    let mut last = try_vec(n + 1, 0.0, "the direction of a bifurcation")?;
    let inverse = 1.0 / norm(start);
    for (x, s) in last.iter_mut().zip(start) {
        *x = s * inverse;
    }
    for _ in 0..NULL_DIRECTION_MAX_ITERATIONS {
        interrupt.check()?;
        corrector.memory.step.copy_from_slice(&last);
        if !corrector.solve(problem, (metric, row), TANGENT_ERROR, interrupt)? {
            return Ok(None);
        }
        corrector.memory.step[n] = 0.0;
        let size = norm(&corrector.memory.step);
        if !(size > 0.0 && size.is_finite()) {
            return Ok(None);
        }
        let cosine = dot(&corrector.memory.step, &last) / size;
        let scale = 1.0 / size.copysign(cosine);
        let mut change = 0.0_f64;
        for (x, s) in last.iter_mut().zip(&corrector.memory.step) {
            let next = s * scale;
            change = change.hypot(next - *x);
            *x = next;
        }
        if change <= CONVERGED {
            return Ok(Some((last, 1.0 / size)));
        }
    }
    Ok(None)
}
