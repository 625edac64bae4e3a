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

/// The jumps of the force of a law.
pub struct LateJumps {
    /// Packed change of the force with a delay of all jumps.
    pub by_delay: Vec<f64>,
    /// Time by which the motion of the slider does not repeat itself after half a turn: its jumps are as doubtful.
    pub apart: f64,
}

/// The jumps of the force of `law` at a packed motion and an angular frequency; `None` where the law has none, or the slider sticks.
///
/// # Errors
/// `OutOfMemory`, `StoppedByCaller`.
pub fn late_jumps(
    PackedMotion { set, motion, omega }: PackedMotion<'_>,
    law: &dyn Law,
    interrupt: &Interrupt<'_>,
) -> Result<Option<LateJumps>> {
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
        impulse(set, piece.end, piece.offset - after, &mut one);
        for (sum, one) in sum.iter_mut().zip(&one) {
            *sum += one;
        }
        slips = true;
    }
    Ok(slips.then_some(LateJumps { by_delay: sum, apart }))
}
