//! The freedom of a solution: the places of sliders that stick through the period and change the vibration.
//!
//! A contact that sticks through the period keeps any force within its limit. The force has no part in the vibration by itself; it loads
//! the other contacts through the structure, and where one of those slips or opens, the vibration changes. Every such slider is a
//! parameter of a continuum of solutions, of which a branch has one.

use crate::analysis::held_sliders::HELD;
use crate::analysis::stuck_contacts::{StuckSlider, stuck_contacts};
use crate::condense::{Condensed, Reference};
use crate::contact::force_derivative::Constant;
use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::norm;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::results::Branch;
use crate::sensitivity::{ForcedPoint, Parameter, TotalDerivative};

const CONTEXT: &str = "the freedom of a solution";

/// Vibration that a change of the place makes, over that change, which is rounding.
const FREEDOM_ROUNDING: f64 = 1e-11;

/// A slider whose place is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeSlider {
    /// Number of the contact.
    pub contact: usize,
    /// Direction of the slider, t1 (0) or t2 (1).
    pub direction: usize,
    /// Place of the slider in the solution.
    pub place: f64,
    /// Derivative of the amplitude by the place at a fixed frequency, while the contact sticks.
    pub derivative: f64,
}

/// The sliders of a stored point of a forced response that stick through the period and change its vibration; none where no contact
/// sticks all the time, or none of the others slips or opens. `model` is the one that the branch was computed with.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch, `Unsupported` for a nonlinear mode; those of
/// callbacks; `OutOfMemory`.
pub fn freedom(model: &Model, branch: &Branch, point: usize) -> Result<Vec<FreeSlider>> {
    freedom_with(model, branch, point, &Interrupt::none())
}

/// The same as [`freedom`], and the caller may stop it.
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

/// The same with what the solution knows of the sliders.
pub(super) fn free_sliders(
    model: &Model,
    branch: &Branch,
    point: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<(StuckSlider, f64)>> {
    let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    if branch.mode_data().is_some() {
        return fail!(
            Unsupported,
            "the branch is a nonlinear mode; the freedom of its contacts is not computed, take a point of a forced response"
        );
    }
    branch.check_model(model)?;
    interrupt.phase(Phase::Results, 0.0)?;
    let (condensed, samples) = (branch.condensed_at(point), branch.samples_at(point));
    let mut free = Vec::new();
    let at_frequency = model.at_frequency(omega)?;
    let stuck = stuck_contacts(&at_frequency, (condensed, samples), (motion, omega), interrupt)?;
    if !stuck.others_vibrate || stuck.sliders.is_empty() || condensed.has_exchanges() {
        return Ok(free);
    }
    // With the contacts held the motion is the same, and its derivatives are those on the side within the limits.
    let mut held = model.separate_clone()?;
    for slider in &stuck.sliders {
        if slider.direction == 0 {
            let mu = HELD * model.contacts()[slider.contact].mu;
            held.set_constant(slider.contact, Constant::Mu, mu)?;
        }
        held.set_slider(slider.contact, slider.direction, slider.place)?;
    }
    // The mean that a residual force moves may not be carried where the motion is symmetric.
    let options = SolverOptions {
        harmonics: condensed.set().numbers().last().copied().unwrap_or(1),
        keep_even_harmonics: true,
        samples,
        response_dof: Some(branch.response_dof()),
        ..SolverOptions::default().fixed()
    };
    let reference = Some(Reference::Complex);
    let own = Condensed::with_reference(&held, &options, (omega, omega), reference, interrupt)?;
    let mut u = try_vec(own.unknowns(), 0.0, CONTEXT)?;
    own.set()
        .transfer(condensed.set(), motion, condensed.length() / own.length(), &mut u);
    let mut at = ForcedPoint::new(&own, (branch.response_dof(), samples), omega, interrupt)?;
    if let Some(first) = branch.responses().first().filter(|first| !first.response().is_plain()) {
        at = at.watching((&first.response(), branch.response_dof()), samples)?;
    }
    let Some(adjoint) = at.adjoint(&u, omega)? else {
        return Ok(free);
    };
    let held_at = held.at_frequency(omega)?;
    let (m, mean) = (own.set().packed_len(), usize::from(own.set().has_mean()));
    let mut total = TotalDerivative::new((&held, &*held_at), (&own, samples), &adjoint, interrupt)?;
    for of_contact in stuck.sliders.chunk_by(|a, b| a.contact == b.contact) {
        let mut changes = false;
        for slider in of_contact {
            let change = at.by_slider((slider.coordinate, slider.stiffness), omega)?;
            let mut vibrations = change.chunks_exact(m.max(1)).map(|y| norm(&y[mean..]));
            changes |= vibrations.any(|y| y > FREEDOM_ROUNDING);
        }
        // In a plane the limit couples both directions.
        for slider in of_contact.iter().filter(|_| changes) {
            let parameter = Parameter::Contact {
                constant: Constant::Slider(slider.direction),
                contact: Some(slider.contact),
            };
            try_push(&mut free, (*slider, total.by(&parameter)?.0), CONTEXT)?;
        }
    }
    Ok(free)
}
