//! Periodic response by integration in time: the check of any point of harmonic balance.

use crate::error::Result;
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::TimeOptions;
use crate::time_integration::solve;

pub use crate::time_integration::TimeResponse;

/// Finds the periodic response of `model` to its forces at one angular frequency by event-driven
/// integration in time: exact between events where the contacts are linear between them, by adaptive
/// implicit steps where a law is smooth.
///
/// Nothing is truncated, so that the result is the truth that harmonic balance tends to with the number
/// of its harmonics. It is one of the solutions where several coexist: shooting may find an unstable one,
/// marching does not. Every law is known but friction in a plane and laws of the caller with states; a
/// callback is asked about one time per call (`samples` is 1). A cyclic model moves in the wave of its engine order.
///
/// The progress hook is called after each integrated part of a period, `amplitude` being the largest
/// displacement.
///
/// # Errors
/// Bad options (see [`TimeOptions::check`]); `Unsupported` for degrees of freedom without mass, for complex
/// matrices, for friction in a plane and for laws of the caller with states; `Callback` where a callback
/// refuses; `NoConvergence` where no steady state was found, `NoBoundedSolution` where the motion grows without end; `OutOfMemory`.
pub fn time_response(model: &Model, options: &TimeOptions<'_>, hooks: &mut Hooks<'_>) -> Result<TimeResponse> {
    options.check(model.ndof())?;
    solve(model, options, hooks)
}
