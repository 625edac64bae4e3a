//! Options of the solver from the keys that all analyses have.

use crate::building::built::Built;
use crate::job_file::job_words::DofName;
use crate::texts::outcome::Outcome;
use hbvib::SolverOptions;

/// A number of harmonics is that number and no other, unless a tolerance is named as well.
///
/// # Errors
/// A sentence: an unknown degree of freedom of the response.
pub fn solver(
    (harmonics, tolerance): (Option<usize>, Option<f64>),
    response_dof: Option<&DofName>,
    built: &Built,
) -> Outcome<SolverOptions> {
    let defaults = SolverOptions::default();
    let automatic = if harmonics.is_some() { 0.0 } else { defaults.tolerance };
    let named = response_dof.map(|name| built.nodes.dof(name).map_err(|e| format!("response_dof: {e}")));
    Ok(SolverOptions {
        harmonics: harmonics.unwrap_or(defaults.harmonics),
        tolerance: tolerance.unwrap_or(automatic),
        response_dof: named.transpose()?,
        ..defaults
    })
}
