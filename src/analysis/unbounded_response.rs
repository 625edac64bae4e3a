//! Refusal of a forced response that no bounded motion has: an undamped resonance forced beyond its contacts, which
//! [`crate::model::slip_capacity`] proves of the model. It is asked where no solution was found, and where a
//! branch ends on its way to infinity.

use crate::error::{Error, Status};
use crate::model::Model;

/// Why there is no solution at an angular frequency, where that is known. What fails in the search for a reason is no
/// reason.
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
