//! Refusal of a forced response without bounded solution: an undamped resonance forced beyond its slip capacity,
//! which [`crate::model::slip_capacity`] proves of the model. The check runs if no solution was found, and if a
//! branch ends on its way to infinity.

use crate::error::{Error, Status};
use crate::model::Model;

/// Reason why there is no solution at an angular frequency, if it is known. An error in the search for it is
/// ignored.
pub(super) fn reason(model: &Model, omega: f64) -> Option<Error> {
    let resonance = model.overload(omega).ok()??;
    Some(Error::new(
        Status::NoBoundedSolution,
        format_args!(
            "no bounded solution at {omega}: harmonic {} meets an undamped resonance, whose force {:.6e} is above \
             the {:.6e} that the contacts can take; add damping, or lower the force",
            resonance.harmonic, resonance.force, resonance.slip_capacity
        ),
    ))
}
