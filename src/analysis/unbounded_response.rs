//! Refusal of a forced response without bounded solution: an undamped resonance forced beyond its slip capacity,
//! which [`crate::model::slip_capacity`] proves of the model. The check runs if no solution was found, and if a
//! branch ends on its way to infinity.

use crate::error::{Error, Result, Status};
use crate::interrupt::Interrupt;
use crate::model::Model;

/// Reason why there is no solution at an angular frequency, if it is known. An error in the search for it is
/// ignored.
///
/// # Errors
/// `StoppedByCaller`.
pub(super) fn reason(model: &Model, omega: f64, interrupt: &Interrupt<'_>) -> Result<Option<Error>> {
    let resonance = match model.overload(omega, interrupt) {
        Err(e) if e.status == Status::StoppedByCaller => return Err(e),
        Ok(Some(resonance)) => resonance,
        Ok(None) | Err(_) => return Ok(None),
    };
    Ok(Some(Error::new(
        Status::NoBoundedSolution,
        format_args!(
            "no bounded solution at {omega}: harmonic {} meets an undamped resonance, whose force {:.6e} is above \
             the {:.6e} that the contacts can take; add damping, or lower the force",
            resonance.harmonic, resonance.force, resonance.slip_capacity
        ),
    )))
}
