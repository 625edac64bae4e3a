//! The freedom of a solution: the places of sliders that stick through the period and change the vibration.
//!
//! A contact that sticks through the period keeps any force within its limit. The force has no part in the vibration by itself; it loads
//! the other contacts through the structure, and where one of those slips or opens, the vibration changes. Every such slider is a
//! parameter of a continuum of solutions, of which a branch has one.

use crate::analysis::residual_states::free_points::FreePoints;
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::error::{Result, fail, try_push};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::results::Branch;

const CONTEXT: &str = "the freedom of a solution";

/// A slider whose place is free at a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeSlider {
    /// Index of the contact in the model.
    pub contact: usize,
    /// Direction of the slider, t1 (0) or t2 (1).
    pub direction: usize,
    /// Place of the slider in the solution.
    pub place: f64,
    /// Derivative of the amplitude by the place at a fixed frequency, while the contact sticks.
    pub derivative: f64,
}

/// The free sliders of a stored point of a forced response: they stick through the period, and their places change
/// its vibration. Empty where no contact sticks all the time, or none of the others slips or opens. `model` is the
/// one with which the branch was computed.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch, `Unsupported` for a nonlinear mode; those of
/// callbacks; `OutOfMemory`.
pub fn freedom(model: &Model, branch: &Branch, point: usize) -> Result<Vec<FreeSlider>> {
    freedom_with(model, branch, point, &Interrupt::none())
}

/// The free sliders of a stored point as [`freedom`], and the caller may stop it.
///
/// # Errors
/// As [`freedom`]; `StoppedByCaller`.
pub fn freedom_with(
    model: &Model,
    branch: &Branch,
    point: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<FreeSlider>> {
    let found = free_sliders(model, branch, point, interrupt)?;
    let mut free = Vec::new();
    for (slider, derivative) in found {
        let one = FreeSlider {
            contact: slider.contact,
            direction: slider.direction,
            place: slider.place,
            derivative,
        };
        try_push(&mut free, one, CONTEXT)?;
    }
    Ok(free)
}

/// The free sliders with their data in the solver, and the derivatives of the amplitude by their places.
pub(crate) fn free_sliders(
    model: &Model,
    branch: &Branch,
    point: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<(StuckSlider, f64)>> {
    if point >= branch.stored() {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    }
    if branch.mode_data().is_some() {
        return fail!(
            Unsupported,
            "the branch is a nonlinear mode; the freedom of its contacts is not computed, take a point of a forced response"
        );
    }
    branch.check_model(model)?;
    interrupt.phase(Phase::Results, 0.0)?;
    FreePoints::single(model, branch, interrupt).at(point)
}
