//! The relative coordinates: contacts between the same two degrees of freedom share one.

use crate::error::{Result, try_push, try_room, try_vec};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::spring::along;
use num_complex::Complex64;

/// Keys between two checks of a stop, and operations of one of them.
/// Kind: block.
const RELATIVE_COORDINATES_BETWEEN_CHECKS: usize = 1024;
const OF_ONE_KEY: usize = 100;

/// A direction of an active contact, and its relative coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AssembledDirection {
    pub contact: usize,
    pub direction: usize,
    pub coordinate: usize,
}

/// A contact and one of its directions, as a pair of indices.
pub(crate) type ContactDirection = (usize, usize);

/// Assigns the directions of active contacts to unique relative coordinates. Returns the directions, contact after
/// contact, and for each coordinate the (contact, direction) that represents it.
pub(crate) fn assign_coordinates(
    model: &Model,
    active: &[usize],
    interrupt: &Interrupt<'_>,
) -> Result<(Vec<AssembledDirection>, Vec<ContactDirection>)> {
    const CONTEXT: &str = "the contacts";
    let structure = model.structure();
    let mut assembled = Vec::new();
    for &contact in active {
        for direction in 0..model.contacts()[contact].directions() {
            let new = AssembledDirection {
                contact,
                direction,
                coordinate: 0,
            };
            try_push(&mut assembled, new, CONTEXT)?;
        }
    }
    // Each key once: a comparison takes less time than a key.
    let mut keys = try_room(assembled.len(), CONTEXT)?;
    for (i, p) in assembled.iter().enumerate() {
        if i.is_multiple_of(RELATIVE_COORDINATES_BETWEEN_CHECKS) {
            interrupt.check_before((RELATIVE_COORDINATES_BETWEEN_CHECKS * OF_ONE_KEY) as u64)?;
        }
        keys.push(structure.key(&structure.contact_motion(&model.contacts()[p.contact], p.direction)));
    }
    let mut order = try_vec(assembled.len(), 0, CONTEXT)?;
    for (i, o) in order.iter_mut().enumerate() {
        *o = i;
    }
    order.sort_unstable_by(|&i, &j| keys[i].cmp(&keys[j]).then(i.cmp(&j)));
    let mut representatives = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        if k == 0 || keys[i] != keys[order[k - 1]] {
            try_push(
                &mut representatives,
                (assembled[i].contact, assembled[i].direction),
                CONTEXT,
            )?;
        }
        assembled[i].coordinate = representatives.len() - 1;
    }
    Ok((assembled, representatives))
}

/// Relative motion at a contact over the motions of its sides, 0 .. 1.
///
/// A mode that hardly moves a contact hardly depends on its stiffness, nor on κ in its place, so that the structure
/// with κ would still resonate in the mode. With κ reduced to this share, about the dynamic stiffness of the
/// structure at the contact, the relative motion is no longer small and the resonance is damped.
pub(crate) fn relative_share(model: &Model, (contact, direction): ContactDirection, shape: &[Complex64]) -> f64 {
    let contact = &model.contacts()[contact];
    let row = model.structure().contact_row(contact, direction, 1);
    let sides: f64 = row.iter().flatten().map(|&(p, a)| (a * shape[p]).norm()).sum();
    let relative = along(&row, shape).norm();
    if relative > 1e-9 * sides { relative / sides } else { 1.0 }
}
