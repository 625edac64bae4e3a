//! A log line where a forced response is one of a band: contacts stick through the period at its largest amplitude, and change the
//! vibration there.

use crate::analysis::residual_states::freedom::free_sliders;
use crate::error::Status;
use crate::hooks::{Hooks, LogLevel};
use crate::model::Model;
use crate::results::Branch;

/// Warns a caller who has a log that the response depends on residual forces. Without a log nothing is computed, and the branch is
/// complete whether or not the line can be written.
// Inlined, its variables would lie on the stack under every response.
#[inline(never)]
pub(crate) fn warn_of_freedom(model: &Model, branch: &Branch, hooks: &mut Hooks<'_>) {
    if hooks.log.is_none() || branch.status() != Status::Ok {
        return;
    }
    let amplitude = branch.amplitude();
    let Some(highest) = (0..amplitude.len()).max_by(|&a, &b| amplitude[a].total_cmp(&amplitude[b])) else {
        return;
    };
    let free = free_sliders(model, branch, highest, &hooks.interrupt()).unwrap_or_default();
    let contacts = free.chunk_by(|a, b| a.0.contact == b.0.contact).count();
    if contacts == 0 {
        return;
    }
    let omega = branch.omega_at(highest).unwrap_or(f64::NAN);
    let text = format!(
        "at the largest amplitude, omega = {omega:.6}, the vibration depends on forces that contacts keep which stick through the \
         period ({contacts} of them): the response is one of a band, whose ends hbvib_band computes, [band] in a job"
    );
    hooks.log(LogLevel::Warn, &text);
}
