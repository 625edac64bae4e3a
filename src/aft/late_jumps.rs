//! The change of the force of a slider that is a mass where its jumps come later: at the end of a slip from ±fc to a later time by δτ,
//!
//! > δf = (±fc − f₊) δτ δ(τ − c),
//!
//! with the force f₊ after the jump: α x(c) of a stick, ∓fc of a slip backwards.

use crate::aft::moved_ends::impulse;
use crate::contact::forms::law::{Form, Law, PackedMotion};
use crate::error::{Error, Result, try_vec};
use crate::fourier::{TurningPoints, jet};
use crate::interrupt::Interrupt;

const CONTEXT: &str = "the jumps of a contact force";

/// Packed change of the force of `law`, at a packed motion and an angular frequency, where its jumps come late; `None` where the law has
/// none, or the slider sticks. Each is late by `late` of the rise of the force before the slip, over the jump, which is 0 where no stick is
/// before, and by the time by which the motion of the slider does not repeat itself after half a turn.
///
/// # Errors
/// `OutOfMemory`, `StoppedByCaller`.
pub fn late_jumps(
    PackedMotion { set, motion, omega }: PackedMotion<'_>,
    law: &dyn Law,
    late: impl Fn(f64) -> f64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<f64>>> {
    let Form::PiecewiseLinear(law) = law.form() else {
        return Ok(None);
    };
    let Some(ends) = law.sliding_ends() else {
        return Ok(None);
    };
    let highest = set.highest_reduced();
    let (mut extrema, mut pieces) = (Vec::new(), Vec::new());
    extrema
        .try_reserve_exact(2 * highest + 4)
        .and_then(|()| pieces.try_reserve_exact(law.most_pieces(highest)))
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    TurningPoints::new(set)?.find(set, motion, &mut extrema, interrupt)?;
    let apart = ends.follow(PackedMotion { set, motion, omega }, &extrema, &mut pieces, interrupt)?;
    let (mut sum, mut one) = (
        try_vec(set.packed_len(), 0.0, CONTEXT)?,
        try_vec(set.packed_len(), 0.0, CONTEXT)?,
    );
    let mut slips = false;
    for (k, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.slope == 0.0) {
        interrupt.check_before(motion.len() as u64)?;
        // Half a turn later the mirror image follows.
        let (next, sign) = pieces.get(k + 1).map_or((&pieces[0], -1.0), |next| (next, 1.0));
        let after = next.slope * jet(set, motion, piece.end).x + sign * next.offset;
        let jump = piece.offset - after;
        let before = if k > 0 {
            &pieces[k - 1]
        } else {
            &pieces[pieces.len() - 1]
        };
        let rise = (before.slope * jet(set, motion, piece.start).dx).abs() / jump.abs();
        if !rise.is_finite() {
            continue; // no jump
        }
        impulse(set, piece.end, jump, &mut one);
        let late = late(rise) + apart;
        for (sum, one) in sum.iter_mut().zip(&one) {
            *sum += late * one;
        }
        slips = true;
    }
    Ok(slips.then_some(sum))
}
