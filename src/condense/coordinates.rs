//! The relative coordinates: contacts between the same two places share one.

use crate::contact::ContactKind;
use crate::error::{Result, try_push, try_vec};
use crate::harmonics::HarmonicSet;
use crate::model::Model;
use crate::model::spring::{Wave, along, relative_row};
use crate::model::structure::MatrixKind;
use num_complex::Complex64;

/// Gathers active contacts on unique relative coordinates: per active contact its coordinate, and
/// per coordinate one contact that stands for it.
pub(super) fn gather(model: &Model, active: &[usize]) -> Result<(Vec<usize>, Vec<usize>)> {
    let sectors = model.structure().sectors() as i128;
    let key = |position: usize| {
        let c = &model.contacts()[active[position]];
        (c.dof_a, c.dof_b, i128::from(c.sector_offset).rem_euclid(sectors))
    };
    let mut order = try_vec(active.len(), 0, "the contacts")?;
    for (i, o) in order.iter_mut().enumerate() {
        *o = i;
    }
    order.sort_by_key(|&i| key(i));
    let mut coordinate_of = try_vec(active.len(), 0, "the contacts")?;
    let mut representatives = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        if k == 0 || key(i) != key(order[k - 1]) {
            try_push(&mut representatives, active[i], "the contacts")?;
        }
        coordinate_of[i] = representatives.len() - 1;
    }
    Ok((coordinate_of, representatives))
}

/// Raises the stiffness of coordinates with cubic springs, whose kt may be zero, to that of the
/// structure where they act, so that κ moves the poles whatever kt is. For a structure without
/// stiffness of its own the inertia at `omega` tells the size.
pub(super) fn raise_for_springs(
    model: &Model,
    omega: f64,
    set: &HarmonicSet,
    never_slipping: &[usize],
    (active, coordinate_of): (&[usize], &[usize]),
    stiffness: &mut [f64],
) -> Result<()> {
    let is_cubic = |i: usize| model.contacts()[i].kind == ContactKind::Cubic;
    if !active.iter().any(|&i| is_cubic(i)) {
        return Ok(());
    }
    let lowest = set.numbers().first().copied().unwrap_or(0);
    let stuck = never_slipping.iter().map(|&i| &model.contacts()[i]);
    let k = model.sprung_stiffness(Wave::Harmonic(lowest), stuck)?;
    let m = model.structure().wave_matrix(MatrixKind::Mass, lowest)?;
    for (&i, &coordinate) in active.iter().zip(coordinate_of).filter(|&(&i, _)| is_cubic(i)) {
        let contact = &model.contacts()[i];
        for p in [contact.dof_a, contact.dof_b].into_iter().flatten() {
            let size = k.get(p, p).norm().max(omega * omega * m.get(p, p).norm());
            stiffness[coordinate] = stiffness[coordinate].max(size);
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
pub(super) fn give(model: &Model, contact: usize, shape: &[Complex64]) -> f64 {
    let contact = &model.contacts()[contact];
    let phase = model.structure().phase(1, contact.sector_offset);
    let row = relative_row(contact.dof_a, contact.dof_b, phase);
    let sides: f64 = row.iter().flatten().map(|&(p, a)| (a * shape[p]).norm()).sum();
    let relative = along(&row, shape).norm();
    if relative > 1e-9 * sides { relative / sides } else { 1.0 }
}
