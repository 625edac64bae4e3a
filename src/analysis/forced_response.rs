//! Forced response over a range of frequency.

use crate::analysis::forced::forced_curve::alone;
use crate::analysis::other_solutions::all_solutions;
use crate::analysis::residual_states::freedom_columns::record_freedom;
use crate::analysis::residual_states::freedom_warning::warn_of_freedom;
use crate::error::Result;
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::results::Branch;

/// Follows the periodic response of `model` to its forces from `range.omega_start` to `range.omega_stop` by harmonic
/// balance and arc-length continuation.
///
/// A branch that ends early is returned with a positive [`Branch::status`] and every point found. A caller with a log is told where
/// contacts that stick make the response one of a band (see [`crate::band()`]).
///
/// # Errors
/// Bad options and models (see [`SolverOptions::check`], [`ForcedOptions::check`], [`crate::condense::Condensed::new`]),
/// `NoConvergence` if no first point was found, `NoBoundedSolution` if none is known to exist (see
/// [`Model::overload`]), `Callback` if a callback caused that.
pub fn forced_response(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    // One result, made where the caller wants it: copies would lie on the stack under every response.
    let mut found = if range.branches == 0 {
        alone(model, solver, range, hooks)
    } else {
        all_solutions::forced_response(model, solver, range, hooks)
    };
    if let Ok(branch) = &mut found {
        if solver.freedom {
            record_freedom(model, branch, (solver, range), hooks)?;
        }
        warn_of_freedom(model, branch, hooks);
    }
    found
}
