//! Solution of a point once more near a known one: with other harmonics, or by a more accurate evaluation.

use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;

/// Distance, relative to the unknowns, beyond which a solution is another one than requested.
const NEAR: f64 = 0.3;

/// Solves from `near`, at its parameter or in the plane across its tangent, along which the found point's own tangent
/// points. `None` where Newton's method fails or converges to another solution.
///
/// # Errors
/// Those of the problem; `StoppedByCaller`.
pub fn resolve(
    problem: &mut dyn Problem,
    corrector: &mut Corrector,
    settings: &Settings,
    near: &Point,
    keep_parameter: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Point>> {
    let n = near.unknowns().len();
    let metric = Metric::along(norm(near.unknowns()), settings);
    let mut row = try_vec(n + 1, 0.0, "a point of the branch")?;
    if keep_parameter {
        row[n] = 1.0;
    } else {
        metric.unit(&near.tangent, &mut row);
    }
    let mut v = try_copy(&near.v, "a point of the branch")?;
    let outcome = corrector.correct(problem, &mut v, &row, metric, true, interrupt)?;
    let Outcome::Converged(corrected) = outcome else {
        return Ok(None);
    };
    if keep_parameter {
        v[n] = near.parameter();
    }
    let moved = v[..n].iter().zip(&near.v).fold(0.0_f64, |s, (a, b)| s.hypot(a - b));
    if moved > NEAR * norm(near.unknowns()) {
        return Ok(None);
    }
    let mut point = Point::new(v, corrected, near.step);
    if metric.dot(&point.tangent, &near.tangent) < 0.0 {
        point.reverse();
    }
    Ok(Some(point))
}
