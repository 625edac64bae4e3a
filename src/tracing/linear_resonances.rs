//! Resonances of a structure with all contacts stuck, and with none: the places where the steps of a sweep may pass a peak.

use crate::contact::Role;
use crate::continuation::LinearResonance;
use crate::error::{Result, try_push};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::options::Range;

/// Degrees of freedom up to which all natural frequencies cost little beside a sweep.
/// Kind: tuned; measured on: random chains.
const LINEAR_RESONANCES_UP_TO: usize = 100;

/// Distance from an undamped resonance, over its frequency, at which a step is compared with the solution.
/// Kind: tuned; measured on: random chains.
const ASIDE: f64 = 1e-4;

/// The resonances of a sweep over `range`, ascending; none where they are not known.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn linear_resonances(
    model: &Model,
    range: Range,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<LinearResonance>> {
    let mut found: Vec<LinearResonance> = Vec::new();
    if model.ndof() > LINEAR_RESONANCES_UP_TO {
        return Ok(found);
    }
    // Contacts without stiffness at small motion leave both the same.
    let without = model.contacts().iter().any(|contact| contact.role() != Role::Inert);
    let states = [ContactState::Stuck, ContactState::Free];
    for contacts in states.into_iter().take(1 + usize::from(without)) {
        for pole in model.forced_resonances(range, contacts, interrupt)?.unwrap_or_default() {
            let aside = if pole.is_undamped() { ASIDE * pole.omega } else { 0.0 };
            let resonance = LinearResonance {
                at: pole.omega,
                half_width: pole.half_width.max(aside),
                aside,
            };
            try_push(&mut found, resonance, "the resonances of the linear structure")?;
        }
    }
    found.sort_by(|a, b| a.at.total_cmp(&b.at));
    // A resonance that the contacts hardly feel lies at one frequency with and without them.
    found.dedup_by(|b, a| b.at - a.at <= a.half_width.min(b.half_width));
    Ok(found)
}
