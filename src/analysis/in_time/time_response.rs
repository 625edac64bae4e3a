//! Periodic response by integration in time, which can check any point of harmonic balance.

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
/// The motion is not truncated to harmonics, so that the result is the limit of harmonic balance for many
/// harmonics. Where several solutions coexist it is one of them: shooting may find an unstable one, marching does
/// not. All laws are supported except friction in a plane and laws of the caller with states; each call of a
/// callback evaluates one time (`samples` is 1). A cyclic model moves in the wave of its engine order.
///
/// The progress hook is called after each integrated part of a period, `amplitude` being the largest
/// displacement.
///
/// # Errors
/// Bad options (see [`TimeOptions::check`]); `Unsupported` for degrees of freedom without mass, for complex
/// matrices, for friction in a plane and for laws of the caller with states; `Callback` if a callback fails;
/// `NoConvergence` if no steady state was found, `NoBoundedSolution` if the motion grows without bound;
/// `OutOfMemory`.
///
/// # Example
/// ```
/// # use hbvib::{Contact, MatrixKind, MatrixView, Model};
/// use hbvib::{Hooks, TimeOptions, time_response};
///
/// # let mut model = Model::new(1)?;
/// # model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_rayleigh(0.0, 0.02)?;
/// # model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?;
/// # model.add_force(0, 1, 0.2.into())?;
/// let options = TimeOptions { omega: 1.0, harmonics: 3, ..TimeOptions::default() };
/// let found = time_response(&model, &options, &mut Hooks::default())?;
/// assert!((found.harmonics[1].norm() - 0.2).abs() < 1e-3); // harmonic 1 of the only degree of freedom
/// # Ok::<(), hbvib::Error>(())
/// ```
pub fn time_response(model: &Model, options: &TimeOptions<'_>, hooks: &mut Hooks<'_>) -> Result<TimeResponse> {
    options.check(model.ndof())?;
    model.check_matrices(false)?;
    solve(model, options, hooks)
}
