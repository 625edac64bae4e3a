//! The condition of a peak over the frequency, dA/dω = g(u, ω) = ∂A/∂ω − λᵀ ∂R/∂ω = 0, with the adjoint λ of the amplitude.

use crate::error::{Result, try_copy, try_vec};
use crate::linalg::{dot, norm};
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::central_differences::central_differences;
use crate::sensitivity::forced_point::ForcedPoint;

/// The derivatives of g = ∂A/∂ω − λᵀ ∂R/∂ω by the motions and by ω, at fixed p, and d²A/dω².
pub(crate) fn peak_row(
    point: &mut ForcedPoint<'_>,
    u: &[f64],
    omega: f64,
    adjoint: &Adjoint,
) -> Result<(Vec<f64>, f64)> {
    let tangent = point.tangent(omega)?;
    let speed = norm(&tangent);
    let width = if speed > 0.0 { norm(u) / speed } else { omega };
    let mut row = try_vec(u.len() + 1, 0.0, CONTEXT)?;
    for (step, weight) in central_differences(width) {
        let mut moved = try_copy(u, CONTEXT)?;
        for (y, t) in moved.iter_mut().zip(&tangent) {
            *y += step * t;
        }
        let gradient = point.gradient(&moved, omega + step, &adjoint.lambda)?;
        for (x, g) in row.iter_mut().zip(&gradient) {
            *x += weight * g;
        }
    }
    let curvature = dot(&row[..u.len()], &tangent) + row[u.len()];
    Ok((row, curvature))
}
