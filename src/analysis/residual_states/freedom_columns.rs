//! The freedom of every stored point of a forced response, as columns of its branch.

use crate::analysis::residual_states::free_points::FreePoints;
use crate::error::{Result, Status, boxed};
use crate::hooks::Hooks;
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::Range;
use crate::options::{ForcedOptions, SolverOptions};
use crate::results::{Branch, FreedomOfPoints};

/// Computes the free sliders of all stored points of a branch and of its children (except those with another period),
/// where they are unknown. If the caller stops it, the branch ends early, with the free sliders of the points before.
///
/// # Errors
/// Those of the model; `OutOfMemory`.
// Inlined, its variables would lie on the stack under every response.
#[inline(never)]
pub(crate) fn record_freedom(
    model: &Model,
    branch: &mut Branch,
    options: (&SolverOptions, &ForcedOptions<'_>),
    hooks: &mut Hooks<'_>,
) -> Result<()> {
    let stored = branch.stored();
    let mut found = boxed(|| FreedomOfPoints::unknown(stored, branch.contacts()))?;
    let mut stopped = false;
    if branch.periods() == 1 {
        let interrupt = hooks.interrupt();
        let sweep = Range::new(options.1.omega_start, options.1.omega_stop);
        let mut points = FreePoints::along(model, branch, options.0, sweep, &interrupt);
        for point in 0..stored {
            let free = match interrupt.part(Phase::Results, point, stored) {
                Ok(()) => points.at(point),
                Err(e) => Err(e),
            };
            match free {
                Ok(free) => {
                    let sliders = free
                        .iter()
                        .map(|(s, derivative)| ((s.contact, s.direction), *derivative));
                    found.set(point, sliders);
                }
                Err(e) if e.status == Status::StoppedByCaller => {
                    stopped = true;
                    break;
                }
                // The motion is there, its derivatives are not.
                Err(e) if matches!(e.status, Status::Singular | Status::NoConvergence | Status::Callback) => {}
                Err(e) => return Err(e),
            }
        }
    }
    branch.set_freedom(found, stopped);
    for mut child in branch.take_children() {
        record_freedom(model, &mut child, options, hooks)?;
        branch.push_child(child)?;
    }
    Ok(())
}
