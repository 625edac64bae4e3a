//! Derivative of the frequency of a peak by parameters.
//!
//! At a peak dA/dω = 0 for every p, so that dω*/dp = −(∂/∂ω dA/dp)/(d²A/dω²): the mixed derivative is that of the
//! sensitivities along the branch, by differences of the exact ones.

use crate::error::{Result, try_vec};
use crate::linalg::norm;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::central_differences::central_differences;
use crate::sensitivity::forced_point::ForcedPoint;

/// Change of the frequency relative to itself that tells the width of the peak where no contact moves.
/// Kind: tuned; measured on: not recorded.
const PROBE: f64 = 1e-7;

/// Derivatives dω*/dp of a peak at (u, ω), whose amplitude is `amplitude`, by `count` parameters; `sensitivities`
/// computes the derivatives of the amplitude by these from an adjoint. All are NaN where the branch cannot be
/// linearised at the peak.
///
/// # Errors
/// Those of [`ForcedPoint::adjoint`] and of `sensitivities`.
pub(crate) fn peak_shift(
    point: &mut ForcedPoint<'_>,
    u: &[f64],
    omega: f64,
    amplitude: f64,
    count: usize,
    mut sensitivities: impl FnMut(&Adjoint, &mut [f64]) -> Result<()>,
) -> Result<Vec<f64>> {
    let mut along = |point: &mut ForcedPoint<'_>, tangent: &[f64], step: f64| -> Result<Option<Vec<f64>>> {
        let mut u = crate::error::try_copy(u, CONTEXT)?;
        for (u, t) in u.iter_mut().zip(tangent) {
            *u += step * t;
        }
        let Some(adjoint) = point.adjoint(&u, omega + step)? else {
            return Ok(None);
        };
        let mut values = try_vec(count + 1, 0.0, CONTEXT)?;
        values[count] = adjoint.by_omega;
        sensitivities(&adjoint, &mut values[..count])?;
        Ok(Some(values))
    };
    let mut shift = try_vec(count, f64::NAN, CONTEXT)?;
    if point.adjoint(u, omega)?.is_none() {
        return Ok(shift);
    }
    let tangent = point.tangent(omega)?;
    // The derivatives by ω of all values, from differences along the branch.
    let mut slopes = |places: &[(f64, f64)]| -> Result<Option<Vec<f64>>> {
        let mut sum = try_vec(count + 1, 0.0, CONTEXT)?;
        for (step, weight) in places {
            let Some(values) = along(point, &tangent, *step)? else {
                return Ok(None);
            };
            for (to, value) in sum.iter_mut().zip(&values) {
                *to += weight * value;
            }
        }
        Ok(Some(sum))
    };
    let speed = norm(&tangent);
    let width = if speed > 0.0 {
        norm(u) / speed
    } else {
        let step = PROBE * omega;
        let Some(probed) = slopes(&[(step, 0.5 / step), (-step, -0.5 / step)])? else {
            return Ok(shift);
        };
        (amplitude / probed[count].abs()).sqrt()
    };
    let Some(slope) = slopes(&central_differences(width))? else {
        return Ok(shift);
    };
    for (shift, by_parameter) in shift.iter_mut().zip(&slope) {
        *shift = -by_parameter / slope[count];
    }
    Ok(shift)
}
