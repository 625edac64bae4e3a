//! Peaks of a forced response that are smooth, and those that are corners, where the slope of neither side vanishes: a contact begins to
//! slip or to part there.

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::results::{Branch, ResponseSeries};
use crate::sensitivity::{ForcedPoint, SampledModel};

/// Relative change of the amplitude over that of the frequency below which a peak is smooth and found to rounding.
/// Kind: rounding.
const SMOOTH_PEAK: f64 = 1e-6;

/// Whether a slope at a frequency is too large for a peak that is smooth.
pub fn is_steep(omega: f64, slope: f64, amplitude: f64) -> bool {
    (omega * slope).abs() > SMOOTH_PEAK * amplitude
}

/// A stored point of a forced response, at its frequency, with the response that is differentiated in place of the amplitude, if one is given.
///
/// # Errors
/// `OutOfMemory`; those of callbacks; `StoppedByCaller`.
pub fn stored_point<'a>(
    branch: &'a Branch,
    point: usize,
    omega: f64,
    watched: Option<&ResponseSeries>,
    interrupt: &'a Interrupt<'a>,
) -> Result<ForcedPoint<'a>> {
    let SampledModel { condensed, samples } = SampledModel::at(branch, point);
    let at = ForcedPoint::new(condensed, branch.response_dof(), samples, omega, interrupt)?;
    match watched {
        Some(series) => at.watching(&series.response(), branch.response_dof(), samples),
        None => Ok(at),
    }
}

/// Whether a peak of the amplitude is a corner.
///
/// # Errors
/// Those of [`stored_point`].
pub fn is_corner(branch: &Branch, point: usize, interrupt: &Interrupt<'_>) -> Result<bool> {
    let peak = branch.peaks().iter().find(|peak| peak.point == point);
    let (Some((omega, motion)), Some(peak)) = (branch.omega_at(point).zip(branch.motion_at(point)), peak) else {
        return Ok(false);
    };
    // The first response leads the peaks of the branch.
    let first = branch.responses().first().filter(|first| !first.response().is_plain());
    let adjoint = stored_point(branch, point, omega, first, interrupt)?.adjoint(motion, omega)?;
    Ok(adjoint.is_some_and(|adjoint| is_steep(omega, adjoint.by_omega, peak.amplitude)))
}
