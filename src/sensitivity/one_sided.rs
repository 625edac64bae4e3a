//! Contacts at the onset of slip, where derivatives on the two sides differ: a slider that just does not slip has the
//! stiffness of its spring, and one that just slips has less.

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::sensitivity::adjoint::Adjoint;
use crate::sensitivity::contact_products::{ContactMotion, evaluate};
use crate::sensitivity::sampled_model::SampledModel;

/// Relative change of the vibration within which a contact begins to slip that is at the onset: a solution is not known
/// better.
/// Kind: rounding.
const ONE_SIDED_NEAR: f64 = 1e-8;

/// The first contact at the onset of slip, if there is one. `model` is the model at the frequency of the solution.
///
/// # Errors
/// Those of the laws; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn contact_at_onset(
    model: &Model,
    solution: SampledModel<'_>,
    adjoint: &Adjoint,
    interrupt: &Interrupt<'_>,
) -> Result<Option<usize>> {
    let set = solution.condensed.set();
    let mean = usize::from(set.has_mean());
    for (number, contact) in model.contacts().iter().enumerate() {
        if !contact.may_stick() {
            continue;
        }
        let mut at = ContactMotion::new(model, number, solution.condensed, adjoint)?;
        let Some(law) = at.law.take() else { continue };
        let sticks = |factor: f64| -> Result<bool> {
            let mut motion = crate::error::try_copy(&at.motion, "the sensitivities")?;
            for y in motion.chunks_exact_mut(set.packed_len()) {
                for y in &mut y[mean..] {
                    *y *= factor;
                }
            }
            let found = evaluate(&*law, solution, adjoint.omega, &motion, interrupt)?;
            Ok(found.linear && found.slip_fraction == 0.0 && found.open_fraction == 0.0)
        };
        if sticks(1.0 - ONE_SIDED_NEAR)? && !sticks(1.0 + ONE_SIDED_NEAR)? {
            return Ok(Some(number));
        }
    }
    Ok(None)
}
