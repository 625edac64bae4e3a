//! The two senses of a nodal diameter: in the wave d sector s + 1 lags by 2πd/N, in the wave −d it leads. Their matrices are
//! conjugate where all blocks between sectors are real, and their modes differ where something distinguishes the senses.

use crate::error::{Result, fail};
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::matrices::blocks::Blocks;
use crate::model::matrices::influence::AeroInfluence;
use crate::model::matrices::structure::{MatrixKind, Structure};
use num_complex::Complex64;
use std::sync::Arc;

/// Difference of conjugate matrices of a diameter, relative to their largest entry, that is rounding.
/// Kind: rounding.
const CONJUGATE: f64 = 1e-13;

/// The signed nodal diameter −N/2 < d ≤ N/2 of a wave of `waves` waves per turn, in which sector s + 1 lags by 2πd/N.
pub(crate) fn signed_diameter(structure: &Structure, waves: i64) -> i64 {
    let (diameter, backward) = structure.fold(waves);
    if backward { -(diameter as i64) } else { diameter as i64 }
}

/// The signed nodal diameters −N/2 < d ≤ N/2 of all waves, rising.
pub(crate) fn all_diameters(structure: &Structure) -> impl Iterator<Item = i64> + use<> {
    let n = structure.sectors() as i64;
    (1 - n) / 2..=n / 2
}

/// Refuses nodal diameters other than 0 for a plain structure.
pub(crate) fn check_diameter(structure: &Structure, diameter: i64) -> Result<()> {
    if structure.sectors() == 1 && diameter != 0 {
        return fail!(
            Argument,
            "diameter = {diameter}, needs 0 .. 0: a plain structure has no nodal diameters"
        );
    }
    Ok(())
}

/// The nodal diameter 0 ..= N/2 of a wave of `waves` waves per turn.
pub(crate) fn fold(structure: &Structure, waves: i64) -> (usize, bool) {
    let n = structure.sectors();
    let residue = i128::from(waves).rem_euclid(n as i128) as usize;
    if 2 * residue <= n {
        (residue, false)
    } else {
        (n - residue, true)
    }
}

/// Whether the matrices of the wave −d are the conjugates of those of the wave d.
pub(crate) fn has_conjugate_waves(structure: &Structure) -> bool {
    let aero = structure.aero().iter().flatten();
    let given = |b: &Blocks| {
        let mut all = [&b.own, &b.next, &b.previous].into_iter().chain(&b.diameters).flatten();
        all.all(KeptMatrix::is_real) && b.diameters.len() <= structure.sectors / 2 + 1
    };
    structure.blocks.iter().all(given) && aero.map(Arc::as_ref).all(AeroInfluence::is_real)
}

/// Whether the matrices of a nodal diameter, given by its residue, follow from what the caller gave.
pub(crate) fn has_diameter(structure: &Structure, residue: usize) -> bool {
    let other = (structure.sectors - residue) % structure.sectors;
    let has = |b: &Blocks, d: usize| b.diameters.get(d).is_some_and(Option::is_some);
    let given = |b: &Blocks| b.diameters.is_empty() || has(b, residue) || has(b, other);
    structure.blocks.iter().all(given)
}

/// Whether the modes of a wave −d, given by its residue, do not follow from those of d.
pub(crate) fn has_own_sense(structure: &Structure, residue: usize) -> bool {
    [MatrixKind::Mass, MatrixKind::Stiffness].into_iter().any(|kind| {
        let b = &structure.blocks[kind as usize];
        let own = b.diameters.get(residue).is_some_and(Option::is_some);
        own || (b.diameters.is_empty() && !structure.parts(kind).all(KeptMatrix::is_real))
    })
}

/// Refuses matrices of d and −d that are not conjugate, since no real structure has such.
pub(crate) fn check_senses(structure: &Structure) -> Result<()> {
    let sectors = structure.sectors();
    for blocks in structure.blocks.iter() {
        for residue in sectors / 2 + 1..blocks.diameters.len() {
            let (Some(a), Some(b)) = (&blocks.diameters[residue], &blocks.diameters[sectors - residue]) else {
                continue;
            };
            let terms = [(Complex64::ONE, a, Form::Plain), ((-1.0).into(), b, Form::Conjugated)];
            if Csc::sum(a.order(), &terms)?.max_abs() > CONJUGATE * a.max_abs() {
                return fail!(
                    Unsupported,
                    "the matrices of the nodal diameters {} and {} are not conjugate: complex matrices between sectors mean nothing in time",
                    sectors - residue,
                    structure.signed_diameter(residue as i64)
                );
            }
        }
    }
    Ok(())
}
