//! Friction in a plane, exactly: its tangential force along the path from event to event, its normal force from the normal motion at the
//! time.

use crate::aft::Evaluation;
use crate::aft::plane_friction::PlaneFrictionEvaluator;
use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::PlaneFriction;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::results::motions::contact_loops::period::PeriodicMotion;

/// Friction in a plane under a packed motion, followed over the period.
pub(super) struct PlaneOrbit<'a> {
    law: &'a dyn PlaneFriction,
    evaluator: PlaneFrictionEvaluator,
}

impl<'a> PlaneOrbit<'a> {
    /// Follows the force from event to event over the period.
    ///
    /// # Errors
    /// `OutOfMemory`; `NoConvergence` for a motion that cannot be followed; `StoppedByCaller`.
    pub fn new(motion: &PeriodicMotion<'_>, law: &'a dyn PlaneFriction, interrupt: &Interrupt<'_>) -> Result<Self> {
        let mut evaluator = PlaneFrictionEvaluator::force_alone(motion.set, law)?;
        let mut harmonics = Evaluation::force_alone(motion.set, motion.directions)?;
        evaluator.evaluate(law, motion.set, motion.packed, &mut harmonics, interrupt)?;
        Ok(Self { law, evaluator })
    }

    /// Writes the force at τ in [0, 2π), where the motions are x, and returns the state; `force` must hold zeros.
    pub fn at(&self, tau: f64, x: &[f64], force: &mut [f64]) -> State {
        let path = self.evaluator.path();
        let load = self.law.normal().map_or(f64::INFINITY, |normal| normal.load_at(x[2]));
        let state = if path.pieces.is_empty() {
            if load > 0.0 { State::Stick } else { State::Open }
        } else {
            let (tangential, found) = path.force(tau);
            force[..2].copy_from_slice(&tangential);
            found
        };
        if let Some(normal) = force.get_mut(2) {
            *normal = if load > 0.0 { -load } else { 0.0 };
        }
        state
    }
}
