//! The contacts of a solution that stick through the period: each keeps any force within its limit, so that the place of its slider
//! is free.

use crate::aft::{Evaluation, Evaluator};
use crate::contact::forms::constants::Constant;
use crate::contact::{Contact, Role};
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::sensitivity::SampledModel;

const CONTEXT: &str = "the contacts that stick";

/// A slider that sticks through the period, along one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StuckSlider {
    /// Index of the contact in the model.
    pub contact: usize,
    /// Direction of the slider, t1 (0) or t2 (1).
    pub direction: usize,
    /// Relative coordinate of the motion along it.
    pub coordinate: usize,
    /// Relative coordinate along the normal, where the load varies.
    pub normal: Option<usize>,
    /// Stiffness of the slider's spring.
    pub stiffness: f64,
    /// Place of the slider, in the caller's unit.
    pub place: f64,
}

/// The sliders that stick through the period at a solution.
pub(crate) struct Stuck {
    pub sliders: Vec<StuckSlider>,
    /// Whether some other law is nonlinear near the solution. Without one, a constant force does not change the
    /// vibration.
    pub others_vibrate: bool,
}

/// Whether a contact may keep a residual force while it sticks.
pub(crate) fn keeps_force(contact: &Contact) -> bool {
    let has_friction = [Constant::Kt, Constant::Mu]
        .iter()
        .all(|constant| contact.constant(*constant) > 0.0);
    contact.sliders() > 0 && contact.role() == Role::Active && has_friction
}

/// The sliders that stick at a packed motion in the solver's units. `model` is the model at the frequency of the solution.
///
/// # Errors
/// Those of the laws; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn stuck_contacts(
    model: &Model,
    SampledModel { condensed, samples }: SampledModel<'_>,
    motion: &[f64],
    omega: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Stuck> {
    let mut stuck = Stuck {
        sliders: Vec::new(),
        others_vibrate: false,
    };
    let (set, length) = (condensed.set(), condensed.length());
    let m = set.packed_len();
    // Without a candidate no law is evaluated.
    if !condensed
        .laws()
        .iter()
        .any(|law| keeps_force(&model.contacts()[law.contact]))
    {
        return Ok(stuck);
    }
    let laws = || condensed.laws().iter().map(|assembled| &*assembled.law);
    let mut evaluator = Evaluator::force_alone(set, (samples, 1), laws())?;
    let most = laws().map(crate::contact::Law::directions).max().unwrap_or(0);
    let mut found = Vec::new();
    for d in 1..=most {
        try_push(&mut found, Evaluation::force_alone(set, d)?, CONTEXT)?;
    }
    let mut packed = try_vec(most.saturating_mul(m), 0.0, CONTEXT)?;
    for assembled in condensed.laws() {
        interrupt.check()?;
        let contact = &model.contacts()[assembled.contact];
        let at = assembled.at(omega);
        let (d, factor) = (assembled.coordinates.len(), at.of_motion.unwrap_or(1.0));
        let own = &mut packed[..d * m];
        for (own, &c) in own.chunks_exact_mut(m.max(1)).zip(&assembled.coordinates) {
            for (y, x) in own.iter_mut().zip(&motion[c * m..(c + 1) * m]) {
                *y = x / factor;
            }
        }
        if d == 1 {
            evaluator.prepare(set, own, interrupt)?;
        }
        let found = &mut found[d - 1];
        evaluator
            .evaluate(at.law, set, own, omega, found, interrupt)
            .map_err(|e| e.at(format_args!("contact {}", assembled.contact)))?;
        let sticks = found.slip_fraction == 0.0 && found.open_fraction == 0.0;
        if !(sticks && keeps_force(contact)) {
            stuck.others_vibrate |= !found.linear;
            continue;
        }
        let normal = contact.normal_direction().and_then(|k| assembled.coordinates.get(k));
        for (k, &coordinate) in assembled.coordinates.iter().enumerate().take(contact.sliders()) {
            let stiffness = contact.stiffness(k);
            let mean = |signal: &[f64]| if set.has_mean() { signal[k * m] } else { 0.0 };
            let place = factor * (mean(own) - mean(&found.force) / stiffness);
            let slider = StuckSlider {
                contact: assembled.contact,
                direction: k,
                coordinate,
                normal: normal.copied(),
                stiffness,
                place: place * length,
            };
            try_push(&mut stuck.sliders, slider, CONTEXT)?;
        }
    }
    Ok(stuck)
}
