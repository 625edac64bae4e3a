//! Motion in time while the frequency of the forces changes, as in a run-up through a resonance.

use crate::error::Result;
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::SweepOptions;
use crate::time_integration::run_through;

pub use crate::time_integration::FrequencySweep;

/// Integrates the motion of a plain model from its periodic motion at the first frequency on, while the frequency changes at a constant
/// rate.
///
/// # Errors
/// Those of [`SweepOptions::check`]; `Unsupported` for a cyclic model, an unbalance or a speed that follows the frequency, and what
/// integration in time refuses; `NoConvergence` without a periodic motion at the first frequency; `OutOfMemory`.
pub fn sweep(model: &Model, options: &SweepOptions<'_>, hooks: &mut Hooks<'_>) -> Result<FrequencySweep> {
    options.check(model.ndof())?;
    model.check_matrices(false)?;
    run_through(model, options, hooks)
}
