//! Residual states far from a point, as a load leaves that was much larger: sliders at the corners of a box beyond their limits, from
//! which they are dragged back. Where every contact is linear at the point, no small change of a place changes the vibration, but such a
//! state may make a contact slip, open or close.
//!
//! With a few sliders all corners are tried. With more, those at which the margin of some contact is least: while all contacts stick, the
//! margins of [`slip_margins`](crate::analysis::residual_states::slip_margins) are linear functions of the places, so that the signs of their derivatives
//! tell the corner.

use crate::analysis::residual_states::held_sliders::HeldState;
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::error::{Result, try_push, try_vec};

const CONTEXT: &str = "the corners of a band";

/// Sliders up to which all corners are tried.
/// Kind: tuned; measured on: not recorded.
const BAND_CORNERS_ALL_UP_TO: usize = 5;

/// Corners for each start with more sliders, at most.
/// Kind: cap.
const BAND_CORNERS_PER_START: usize = 8;

/// Distances of the corners from the middle of the motion, over the reach of the limits at the point: loads of contacts change from state
/// to state, and a place beyond the limit is dragged back.
/// Kind: tuned; measured on: 22 random models, of those whose contacts stick or are open and have other
/// states, 3 shows 20 and 10 one more.
pub(crate) const BAND_CORNERS_DISTANCES: [f64; 2] = [3.0, 10.0];

/// Corners to try: for each slider a sign 1 or −1, or 0 for a slider in the middle of its motion.
///
/// `places` are contact and direction of each slider and whether it has a limit, in the order of the signs. `of_point` are the sliders
/// that stick at the point, with the state there, where all contacts are linear; with others and many sliders there are no corners.
pub(crate) fn corners(
    places: &[((usize, usize), bool)],
    of_point: Option<(&HeldState, &[StuckSlider])>,
    starts: usize,
) -> Result<Vec<Vec<f64>>> {
    let count = places.iter().filter(|place| place.1).count();
    let mut found: Vec<Vec<f64>> = Vec::new();
    if count <= BAND_CORNERS_ALL_UP_TO {
        for number in 0..1_usize << count {
            let mut signs = try_vec(places.len(), 0.0, CONTEXT)?;
            let limited = signs.iter_mut().zip(places).filter(|(_, place)| place.1);
            for (k, (sign, _)) in limited.enumerate() {
                *sign = if number >> k & 1 == 0 { 1.0 } else { -1.0 };
            }
            try_push(&mut found, signs, CONTEXT)?;
        }
        return Ok(found);
    }
    let Some((state, sliders)) = of_point else {
        return Ok(found);
    };
    for margin in &state.margins {
        if found.len() == BAND_CORNERS_PER_START * starts {
            break;
        }
        let mut signs = try_vec(places.len(), 0.0, CONTEXT)?;
        for (sign, place) in signs.iter_mut().zip(places) {
            let own = sliders.iter().position(|s| (s.contact, s.direction) == place.0);
            if let Some(j) = own.filter(|_| place.1) {
                *sign = if margin.gradient[j] > 0.0 { -1.0 } else { 1.0 };
            }
        }
        if !found.contains(&signs) {
            try_push(&mut found, signs, CONTEXT)?;
        }
    }
    Ok(found)
}
