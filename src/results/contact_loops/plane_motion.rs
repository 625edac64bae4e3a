//! Friction in a plane, exactly: its tangential force along the path from event to event, its normal force from the normal motion at the
//! time.

use crate::aft::Evaluation;
use crate::aft::plane_friction::PlaneFrictionEvaluator;
use crate::contact::contact_state::State;
use crate::contact::law::PlaneFriction;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::results::contact_loops::period::{PeriodicMotion, Times, time};

/// Forces and states at the times in `out`.
///
/// # Errors
/// `OutOfMemory`; `NoConvergence` for a motion that cannot be followed; `StoppedByCaller`.
pub(super) fn followed(
    motion: &PeriodicMotion<'_>,
    law: &dyn PlaneFriction,
    out: &mut Times,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let (n, d) = (out.state.len(), motion.directions);
    let mut evaluator = PlaneFrictionEvaluator::new(motion.set, law)?;
    let mut harmonics = Evaluation::new(motion.set, d)?;
    evaluator.evaluate(law, motion.set, motion.packed, &mut harmonics, interrupt)?;
    let path = evaluator.path();
    let rows = out
        .force
        .chunks_exact_mut(d)
        .zip(out.motion.chunks_exact(d))
        .zip(&mut out.state);
    for (j, ((force, x), state)) in rows.enumerate() {
        let load = law.normal().map_or(f64::INFINITY, |normal| normal.load_at(x[2]));
        if path.pieces.is_empty() {
            *state = if load > 0.0 { State::Stick } else { State::Open };
        } else {
            let (tangential, found) = path.force(time(motion.set, j, n));
            force[..2].copy_from_slice(&tangential);
            *state = found;
        }
        if d == 3 {
            force[2] = if load > 0.0 { -load } else { 0.0 };
        }
    }
    Ok(())
}
