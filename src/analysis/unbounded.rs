//! Refusal of a forced response that no bounded motion has: an undamped resonance forced beyond its contacts, which
//! [`crate::model::capacity`] proves of the model. It is asked where no solution was found, where one was found that
//! moves as if nothing bounded it, and where a branch ends on its way to infinity.

use crate::continuation::Point;
use crate::error::{Error, Result, Status, fail, try_vec};
use crate::linalg::norm;
use crate::model::Model;
use crate::problem::forced::Forced;
use crate::problem::{Problem, Start};

/// Motion, relative to that with contacts at their reference stiffness, from which on a point is suspected of being
/// no solution: a residual that is small beside the motion need not be small beside the forces.
const SUSPECT: f64 = 1e4;

/// Refuses a point whose motion only a resonance without damping explains, where there is such a resonance.
pub(super) fn refuse_growth(model: &Model, problem: &mut Forced<'_>, point: &Point) -> Result<()> {
    let mut reference = try_vec(point.unknowns().len(), 0.0, "the first point")?;
    problem.start(Start::Reference, point.parameter(), &mut reference)?;
    if norm(point.unknowns()) > SUSPECT * norm(&reference) {
        return refuse_overload(model, point.parameter());
    }
    Ok(())
}

/// Why there is no solution at an angular frequency, where that is known. What fails in the search for a reason is no
/// reason.
pub(super) fn reason(model: &Model, omega: f64) -> Option<Error> {
    let refusal = refuse_overload(model, omega).err()?;
    (refusal.status == Status::NoBoundedSolution).then_some(refusal)
}

/// `NoBoundedSolution` where that is known of an angular frequency.
fn refuse_overload(model: &Model, omega: f64) -> Result<()> {
    let Some(resonance) = model.overload(omega)? else {
        return Ok(());
    };
    fail!(
        NoBoundedSolution,
        "no bounded solution at {omega}: harmonic {} meets an undamped resonance, whose force {:.6e} is above the \
         {:.6e} that the contacts can take; add damping, or lower the force",
        resonance.harmonic,
        resonance.force,
        resonance.capacity
    )
}
