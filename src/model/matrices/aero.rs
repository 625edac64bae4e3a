//! Aerodynamic influence of a model: its coefficients, and its matrices in a wave and around the wheel.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::error::{Result, fail, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::degree_map::DegreeMap;
pub use crate::model::matrices::influence::{AeroEntry, AeroForm, AeroInfluence};
use crate::model::matrices::influence::{CONTEXT, FORMS};
use crate::model::matrices::structure::Structure;
use num_complex::Complex64;
use std::sync::Arc;

/// Sets forces on a sector that follow the motion of its neighbours.
pub(crate) fn set_aero(
    model: &mut Model,
    dofs: &[usize],
    coefficients: &[Complex64],
    offsets: &[i64],
    form: AeroForm,
) -> Result<()> {
    let given = AeroInfluence::new(wheel(model.structure()), dofs, offsets, coefficients)?;
    model.changed_structure().aero_mut()[form as usize] = given.map(Arc::new);
    Ok(())
}

/// .
pub(crate) fn save_aero(model: &Model, out: &mut ByteWriter<'_>) {
    for influence in model.structure().aero() {
        out.bool(influence.is_some());
        if let Some(influence) = influence {
            influence.save_to(out);
        }
    }
}

/// .
pub(crate) fn load_aero(model: &mut Model, input: &mut ByteReader<'_>) -> Result<()> {
    for form in 0..FORMS {
        if input.bool()? {
            let loaded = AeroInfluence::load_from(wheel(model.structure()), input)?;
            model.structure_mut().aero_mut()[form] = loaded.map(Arc::new);
        }
    }
    Ok(())
}

/// Map of the degrees of freedom, and number of sectors.
fn wheel(structure: &Structure) -> (&DegreeMap, usize) {
    (structure.degrees(), structure.sectors())
}

/// The matrix −A(d) of the influence on the left-hand side, for the residue d of a wave.
pub(crate) fn aero_matrix(structure: &Structure, form: AeroForm, residue: usize, real: bool) -> Result<Option<Csc>> {
    let Some(influence) = &structure.aero()[form as usize] else {
        return Ok(None);
    };
    let mut entries = Vec::new();
    influence.visit(wheel(structure), |offset, p, q, c| {
        try_push(
            &mut entries,
            (p, q, -c * structure.wave_phase(residue as i64, offset)),
            CONTEXT,
        )
    })?;
    let mut matrix = Csc::from_triplets(structure.ndof(), structure.ndof(), entries)?;
    if real {
        for v in &mut matrix.values {
            v.im = 0.0;
        }
    }
    Ok(Some(matrix))
}

/// The influence between the sectors of [`Structure::repeating_sectors`], on the left-hand side.
pub(crate) fn aero_around(structure: &Structure, form: AeroForm, interrupt: &Interrupt<'_>) -> Result<Option<Csc>> {
    let Some(influence) = &structure.aero()[form as usize] else {
        return Ok(None);
    };
    if !influence.is_real() {
        return fail!(
            Unsupported,
            "the coefficients of the aerodynamic influence are complex, which means nothing in time: at the angular \
             frequency omega, c' + i c'' is c' per displacement and c''/omega per velocity"
        );
    }
    let (ndof, sectors) = (structure.ndof(), structure.repeating_sectors());
    let mut entries = Vec::new();
    influence.visit(wheel(structure), |offset, p, q, c| {
        interrupt.check_before(sectors as u64)?;
        for s in 0..sectors {
            let to = (s as i64 + offset).rem_euclid(sectors as i64) as usize;
            try_push(&mut entries, (s * ndof + p, to * ndof + q, -c), CONTEXT)?;
        }
        Ok(())
    })?;
    Ok(Some(Csc::from_triplets(ndof * sectors, ndof * sectors, entries)?))
}
