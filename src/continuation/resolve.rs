//! Solution of a point once more near a known one: with other harmonics, or by a more accurate evaluation.

use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;

/// Distance, relative to the unknowns, beyond which a solution is another one than requested.
/// Kind: tuned; measured on: not recorded.
const RESOLVE_NEAR: f64 = 0.3;

/// Cosine of the angle between two lines that are one.
/// Kind: tuned; measured on: not recorded.
const PARALLEL: f64 = 0.99;

/// Solves again from `near`, at its parameter or in the plane across its tangent. The found point is followed in the
/// sense of `near`, see `in_sense_of`. `None` where Newton's method fails or converges to another solution.
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
    if moved > RESOLVE_NEAR * norm(near.unknowns()) {
        return Ok(None);
    }
    let mut point = Point::new(v, corrected, near.step);
    in_sense_of(near, &mut point, metric);
    Ok(Some(point))
}

/// Bounds of the Newton iterations of a linear problem. One solves it, however small the residual before it: near a
/// resonance a residual within the tolerance may leave an error of the motion, and with it of the tangent, that is far
/// above rounding. The others remove rounding.
/// Kind: cap.
const LINEAR_ITERATIONS: (usize, usize) = (1, 4);

/// Solves a problem that is linear around `near` at a parameter value. The found point is followed in the same sense of
/// the parameter. `None` where the problem turns out to be nonlinear, or has no solution.
///
/// # Errors
/// Those of the problem; `StoppedByCaller`.
pub fn solve_linear(
    problem: &mut dyn Problem,
    corrector: &mut Corrector,
    settings: &Settings,
    near: &Point,
    parameter: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Point>> {
    let n = near.unknowns().len();
    let metric = Metric::along(norm(near.unknowns()), settings);
    let mut row = try_vec(n + 1, 0.0, "a point of the branch")?;
    row[n] = 1.0;
    let mut v = try_copy(&near.v, "a point of the branch")?;
    v[n] = parameter;
    let most = corrector.limit(LINEAR_ITERATIONS);
    let outcome = corrector.correct(problem, &mut v, &row, metric, false, interrupt);
    corrector.limit(most);
    let Outcome::Converged(corrected) = outcome? else {
        return Ok(None);
    };
    v[n] = parameter;
    let mut point = Point::new(v, corrected, 0.0);
    if point.tangent[n] * near.tangent[n] < 0.0 {
        point.reverse();
    }
    Ok(Some(point))
}

/// Orients the tangent of a point like the branch through `near`, which may have other harmonics.
///
/// The sense is the sign of det [J r; tangentᵀ], not the angle between the tangents: those may differ in harmonics that
/// only one of them has, as where such a harmonic resonates. With R = y − y_lin + G(f(y) − κy), a factor s on the rows
/// of G of the added harmonics leads from the equations without them (s = 0, where their block of J is the identity, and
/// the determinant is that of the others) to those with them (s = 1). The sign of the bordered determinant is constant
/// along regular solution curves and under such a change of the equations, so that both branches run from the same end
/// to the same end. Where both tangents lie on one line nothing is left to decide: their angle tells the sense, also where the
/// equations are singular on the way to the added harmonics.
fn in_sense_of(near: &Point, point: &mut Point, metric: Metric) {
    let sizes = metric.norm(&near.tangent) * metric.norm(&point.tangent);
    let cosine = metric.dot(&near.tangent, &point.tangent) / sizes;
    let is_opposed = if cosine.abs() > PARALLEL {
        cosine < 0.0
    } else {
        point.positive != near.positive
    };
    if is_opposed {
        point.reverse();
    }
}
