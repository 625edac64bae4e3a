//! Size of the reference stiffness κ of each relative coordinate.
//!
//! Solutions do not depend on κ, but their rounding does. With κ far above the stiffness of the structure the entries
//! of Z_κ lose those of K − h²ω²M in their last digits, and the residual y − y_lin + G (f − κ y), G ≈ 1/κ, is the
//! imbalance of forces over κ: a small number for motions that are far from balance. With κ of the size of the
//! structure both are measured in their own units, whatever the stiffness of the contact.

use crate::condense::blocks::relative_coordinates::AssembledDirection;
use crate::error::{Result, try_copy, try_vec};
use crate::fourier::HarmonicSet;
use crate::model::Model;
use crate::model::matrices::spring::Row;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;

/// Stiffness of a contact over that of the structure above which it is near-rigid.
/// Kind: tuned; measured on: not recorded.
const NEAR_RIGID: f64 = 1e3;

/// Reference stiffness of a near-rigid contact over the stiffness of the structure.
/// Kind: tuned; measured on: not recorded.
const REFERENCE_STIFFNESS_REDUCED: f64 = 10.0;

/// Stiffness of a spring over that of the structure where that is negative: then neither κ nor κ/2 makes their sum zero.
/// Kind: tuned; measured on: not recorded.
const ABOVE_NEGATIVE: f64 = 4.0;

/// Stiffness of the structure at each of `coordinates` relative coordinates: the largest diagonal entry of K with its
/// linear contacts, or of ω²M, among the degrees of freedom of its sides.
pub(crate) fn structural_stiffness(
    model: &Model,
    omega: f64,
    set: &HarmonicSet,
    never_slipping: &[usize],
    assembled: &[AssembledDirection],
    coordinates: usize,
) -> Result<Vec<f64>> {
    let mut structural = try_vec(coordinates, 0.0_f64, "the contacts")?;
    if coordinates == 0 {
        return Ok(structural);
    }
    let lowest = set.numbers().first().copied().unwrap_or(0);
    let stuck = never_slipping.iter().map(|&i| &model.contacts()[i]);
    let structure = model.structure();
    let springs = model.spring_rows(Wave::Harmonic(lowest), stuck)?;
    let entry = |row: &Row, p: usize| {
        row.iter()
            .flatten()
            .filter(|t| t.0 == p)
            .map(|t| t.1)
            .sum::<Complex64>()
    };
    let sprung = |p: usize| {
        let own = structure.wave_diagonal(MatrixKind::Stiffness, lowest, p);
        let added = springs
            .iter()
            .map(|(force, motion, k)| entry(force, p).conj() * entry(motion, p) * k);
        own + added.sum::<Complex64>()
    };
    for at in assembled {
        let motion = model
            .structure()
            .contact_motion(&model.contacts()[at.contact], at.direction);
        for p in motion.terms().map(|term| term.dof) {
            let mass = structure.wave_diagonal(MatrixKind::Mass, lowest, p);
            let size = sprung(p).norm().max(omega * omega * mass.norm());
            structural[at.coordinate] = structural[at.coordinate].max(size);
        }
    }
    Ok(structural)
}

/// Raises the stiffness of coordinates with springs whose stiffness grows and may be zero at zero motion. It becomes
/// the stiffness of the structure, or some times that where the structure itself is unstable, so that κ moves the
/// poles whatever kt is.
pub(crate) fn raise_for_springs(
    model: &Model,
    assembled: &[AssembledDirection],
    structural: &[f64],
    stiffness: &mut [f64],
) {
    for at in assembled.iter().filter(|at| model.contacts()[at.contact].is_spring()) {
        let c = at.coordinate;
        let motion = model
            .structure()
            .contact_motion(&model.contacts()[at.contact], at.direction);
        let own = |p| model.structure().wave_diagonal(MatrixKind::Stiffness, 0, p).re;
        let is_negative = motion.terms().any(|term| own(term.dof) < 0.0);
        let factor = if is_negative { ABOVE_NEGATIVE } else { 1.0 };
        stiffness[c] = stiffness[c].max(factor * structural[c]);
    }
}

/// Stiffness of each coordinate that defines κ: the stiffness of its contacts unless they are near-rigid.
pub(crate) fn reference_stiffness(stiffness: &[f64], structural: &[f64]) -> Result<Vec<f64>> {
    let mut reference = try_copy(stiffness, "the contacts")?;
    for (r, &structural) in reference.iter_mut().zip(structural) {
        if structural > 0.0 && *r > NEAR_RIGID * structural {
            *r = REFERENCE_STIFFNESS_REDUCED * structural;
        }
    }
    Ok(reference)
}
