//! Refusal of a forced response without bounded solution: an undamped resonance forced beyond its slip capacity,
//! which [`crate::model::natural_modes::slip_capacity`] proves of the model. The check runs if no solution was found, and if a
//! branch ends on its way to infinity.

use crate::error::{Error, Result, Status};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::results::Branch;

/// Amplitude, over the size of the linear motion at the start of the range, above which it is the round-off of an
/// undamped resonance: a damping ratio of 1e-12 reaches half of this.
/// Kind: rounding.
const UNBOUNDED: f64 = 1e12;

/// Reason why the response on a branch has no bound: its highest point is an undamped resonance. `length` is the size
/// of the linear motion at the start of the range.
#[inline(never)]
pub(crate) fn in_branch(branch: &Branch, length: f64) -> Option<Error> {
    let peaks = branch.peaks();
    let highest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))?;
    let (omega, amplitude) = (highest.omega, highest.amplitude);
    if amplitude / length <= UNBOUNDED {
        return None;
    }
    Some(Error::new(
        Status::NoBoundedSolution,
        format_args!(
            "the response has no bound at {omega}: an undamped resonance, whose amplitude {amplitude:.6e} is what \
             round-off makes of it; all points are kept; add damping"
        ),
    ))
}

/// Reason why a response that passes an undamped resonance has no bound.
pub(crate) fn at(omega: f64) -> Error {
    Error::new(
        Status::NoBoundedSolution,
        format_args!(
            "the response has no bound at {omega}: an undamped resonance, at which no peak is recorded; all points are \
             kept; add damping"
        ),
    )
}

/// Reason why there is no solution at an angular frequency, if it is known. An error while searching for the reason
/// is ignored.
///
/// # Errors
/// `StoppedByCaller`.
#[inline(never)]
pub(crate) fn reason(model: &Model, omega: f64, interrupt: &Interrupt<'_>) -> Result<Option<Error>> {
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
