//! The relative coordinates: contacts between the same two places share one.

use crate::error::{Result, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::model::Model;
use crate::model::spring::{along, relative_row};
use crate::model::spring_stiffness::Wave;
use crate::model::structure::MatrixKind;
use num_complex::Complex64;

/// A direction of an active contact, and its relative coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct AssembledDirection {
    pub contact: usize,
    pub direction: usize,
    pub coordinate: usize,
}

/// A contact and one of its directions.
pub(super) type Pick = (usize, usize);

/// Gathers the directions of active contacts on unique relative coordinates. They are returned contact
/// after contact, then per coordinate the (contact, direction) that stands for it.
pub(super) fn gather(model: &Model, active: &[usize]) -> Result<(Vec<AssembledDirection>, Vec<Pick>)> {
    const CONTEXT: &str = "the contacts";
    let sectors = model.structure().sectors() as i128;
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
    let key = |p: AssembledDirection| {
        let c = &model.contacts()[p.contact];
        let sector = i128::from(c.sector_offset).rem_euclid(sectors);
        (c.direction(p.direction).key(), sector)
    };
    let mut order = try_vec(assembled.len(), 0, CONTEXT)?;
    for (i, o) in order.iter_mut().enumerate() {
        *o = i;
    }
    order.sort_unstable_by_key(|&i| (key(assembled[i]), i));
    let mut representatives = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        if k == 0 || key(assembled[i]) != key(assembled[order[k - 1]]) {
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

/// Raises the stiffness of coordinates with springs whose stiffness grows and may be zero at rest, to that of the
/// structure where they act, so that κ moves the poles whatever kt is. For a structure without
/// stiffness of its own the inertia at `omega` tells the size.
pub(super) fn raise_for_springs(
    model: &Model,
    omega: f64,
    set: &HarmonicSet,
    never_slipping: &[usize],
    assembled: &[AssembledDirection],
    stiffness: &mut [f64],
) -> Result<()> {
    let is_spring = |p: &&AssembledDirection| model.contacts()[p.contact].is_spring();
    if !assembled.iter().any(|p| is_spring(&p)) {
        return Ok(());
    }
    let lowest = set.numbers().first().copied().unwrap_or(0);
    let stuck = never_slipping.iter().map(|&i| &model.contacts()[i]);
    let k = model.sprung_stiffness(Wave::Harmonic(lowest), stuck)?;
    let m = model.structure().wave_matrix(MatrixKind::Mass, lowest)?;
    for at in assembled.iter().filter(is_spring) {
        let direction = model.contacts()[at.contact].direction(at.direction);
        for &(p, _) in direction.a.iter().chain(&direction.b).flatten() {
            let size = k.get(p, p).norm().max(omega * omega * m.get(p, p).norm());
            stiffness[at.coordinate] = stiffness[at.coordinate].max(size);
        }
    }
    Ok(())
}

/// Relative motion at a contact over the motions of its sides, 0 .. 1: how much the contact gives.
///
/// A mode that hardly moves a contact hardly feels its stiffness, κ in its place neither, and the
/// structure with κ would still resonate in the mode. With κ reduced to this share, about the
/// dynamic stiffness of what hangs on the contact, the relative motion is no longer small and the
/// resonance is damped.
pub(super) fn give(model: &Model, (contact, direction): Pick, shape: &[Complex64]) -> f64 {
    let contact = &model.contacts()[contact];
    let phase = model.structure().phase(1, contact.sector_offset);
    let row = relative_row(&contact.direction(direction), phase);
    let sides: f64 = row.iter().flatten().map(|&(p, a)| (a * shape[p]).norm()).sum();
    let relative = along(&row, shape).norm();
    if relative > 1e-9 * sides { relative / sides } else { 1.0 }
}
