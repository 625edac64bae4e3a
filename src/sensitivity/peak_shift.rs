//! Derivative of the frequency of a peak by parameters.
//!
//! At a peak dA/dω = 0 for every p, so that dω*/dp = −(∂/∂ω dA/dp)/(d²A/dω²): the mixed derivative is that of the
//! sensitivities along the branch, by differences of the exact ones.

use crate::error::{Result, try_vec};
use crate::linalg::norm;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::forced_point::ForcedPoint;

/// Distance of the differences over the width of the peak.
/// Kind: tuned; measured on: not recorded.
const PEAK_SHIFT_STEP: f64 = 5e-4;

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
    (u, omega, amplitude): (&[f64], f64, f64),
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
    // The derivatives by ω of all values, from a pair of points at a distance.
    let mut slopes = |step: f64| -> Result<Option<Vec<f64>>> {
        let Some((mut above, below)) = along(point, &tangent, step)?.zip(along(point, &tangent, -step)?) else {
            return Ok(None);
        };
        for (a, b) in above.iter_mut().zip(&below) {
            *a = (*a - b) / (2.0 * step);
        }
        Ok(Some(above))
    };
    let speed = norm(&tangent);
    let width = if speed > 0.0 {
        norm(u) / speed
    } else {
        let Some(probed) = slopes(PROBE * omega)? else {
            return Ok(shift);
        };
        (amplitude / probed[count].abs()).sqrt()
    };
    let step = PEAK_SHIFT_STEP * width;
    let Some((far, near)) = slopes(2.0 * step)?.zip(slopes(step)?) else {
        return Ok(shift);
    };
    // The errors of both are even in the distance.
    let slope = |k: usize| (4.0 * near[k] - far[k]) / 3.0;
    let curvature = slope(count);
    for (k, shift) in shift.iter_mut().enumerate() {
        *shift = -slope(k) / curvature;
    }
    Ok(shift)
}
